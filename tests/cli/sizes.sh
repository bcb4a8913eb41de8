#!/bin/sh
# build of clips of objects of all sizes: a warning if the tolerance does not fit the size, and for a common unit
# mistake.
. "$(dirname "$0")/lib.sh"

cat >"$work/leg.bvh" <<BVH
HIERARCHY
ROOT hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT knee
  {
    OFFSET 0 -50 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    JOINT foot
    {
      OFFSET 0 -50 0
      CHANNELS 3 Zrotation Xrotation Yrotation
      End Site
      {
        OFFSET 0 0 4
      }
    }
  }
}
MOTION
Frames: 3
Frame Time: 0.0333333
0 100 0 0 0 0 0 0 0 0 0 0
0 100 0 0 0 0 10 0 0 0 0 0
0 100 0 0 0 0 20 0 0 0 0 0
BVH

warns() { # NAME UNIT TEXT OPTIONS...: what a build with this unit warns of; TEXT none: nothing
    name=$1 unit=$2 text=$3
    shift 3
    noh build "$work/leg.bvh" -o "$work/leg.noh" --unit-cm "$unit" "$@"
    expect 0 "build $name"
    if [ "$text" = none ]; then
        check "$name: no warning" sh -c '! grep -q "for which --error-cm" "$1" "$2"' - "$work/out" "$work/err"
    else
        check "$name: '$text'" grep -q -e "$text" "$work/out" "$work/err"
    fi
}

warns 'a leg' 1 none
warns 'a leg of 10 m' 10 none
warns 'a leg of 1 cm' 0.01 'visibly coarse: --error-cm 6e-05 --shell-cm 0.02 were used'
warns 'a leg of 1 cm' 0.01 'if it should be 100 cm large, its unit is wrong: export it scaled by 100'
warns 'a leg of 1 cm, as suggested' 0.01 none --error-cm 6e-05 --shell-cm 0.02
warns 'a leg of 100 m' 100 'finer than visible: --error-cm 0.6 --shell-cm 200'
warns 'a leg of 100 m' 100 'if it should be 100 cm large, its unit is wrong: export it scaled by 0.01'
warns 'a leg of 100 m, as suggested' 100 none --error-cm 0.6 --shell-cm 200
warns 'a leg of 1 cm, coarser' 0.01 'visibly coarse' --error-cm 0.1

finish
