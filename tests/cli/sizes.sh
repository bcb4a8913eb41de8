#!/bin/sh
# build of clips of objects of all sizes: a warning if the tolerance does not fit the size, and for a common unit
# mistake; and of what is too small or too far to be seen.
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

# A triangle of 1 m with a target, whose weight a clip takes to 10^9, on a node with these properties.
sees() { # NODE TEXT: what a build warns of
    cat >"$work/one.gltf" <<GLTF
{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"name":"body"$1}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":1}]}]}],
"animations":[{"name":"go","samplers":[{"input":2,"output":3}],
"channels":[{"sampler":0,"target":{"node":0,"path":"weights"}}]}],
"buffers":[{"byteLength":88,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAM3MzD0AAAAAAAAAAM3MzD0AAAAAAAAAAM3MzD0AAAAAAAAAAAAAgD8AAAAAKGtuTg=="}],
"bufferViews":[{"buffer":0,"byteLength":88}],"accessors":[
{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":0,"byteOffset":36,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":0,"byteOffset":72,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]},
{"bufferView":0,"byteOffset":80,"componentType":5126,"count":2,"type":"SCALAR"}]}
GLTF
    noh build "$work/one.gltf" -o "$work/one.noh"
    expect 0 "build of a node${1:+ with $1}"
    check "'$2'" grep -q -e "^warning: .*$2" "$work/out" "$work/err"
}
sees '' "clip 'go': a target's weight reaches 1e+09"
check 'and of nothing else' sh -c '! cat "$@" | grep "^warning" | grep -v "weight reaches"' - "$work/out" "$work/err"
sees ',"scale":[0,0,0]' "node 'body': a scale of 0 hides its mesh"
sees ',"scale":[1e-9,1e-9,1e-9]' 'too small to be seen: export them scaled by 2e+09'
sees ',"translation":[1e9,0,0]' 'lie 1e+11 cm from the origin, where floats are too coarse'

finish
