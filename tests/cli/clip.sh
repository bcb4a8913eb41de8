#!/bin/sh
# noh build and noh clip on motion: .bvh, .rcl, glTF; what is wrong with a file is said with its line.
. "$(dirname "$0")/lib.sh"

cat >"$work/walk.bvh" <<'BVH'
HIERARCHY
ROOT hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT knee
  {
    OFFSET 0 -10 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 -10 0
    }
  }
}
MOTION
Frames: 4
Frame Time: 0.0333333
0 20 0 0 0 0 0 0 0
1 20 0 5 0 0 10 0 0
2 21 0 10 0 0 25 0 0
0 20 0 0 0 0 0 0 0
BVH

noh build "$work/walk.bvh" -o "$work/walk.noh" --quiet
expect 0 'a .bvh becomes a pack'
noh clip "$work/walk.noh"
expect 0 'clip'
check 'and tells the certified error' grep -q 'certified at a 3 cm shell' "$work/out"
noh clip "$work/walk.noh" --dump "$work/walk.rcl"
expect 0 'the decoded frames as .rcl'
noh build "$work/walk.rcl" -o "$work/again.noh" --quiet
expect 0 'which is built again'
noh info "$work/walk.noh" --json
check 'info counts the skeleton' grep -q '"joints": 2' "$work/out"
noh clip "$work/walk.noh" --dump "$work/x.rcl" --clip wlak
expect 1 'a clip that is not there'
says "did you mean 'walk'"

for option in '--error-cm 0' '--shell-cm -1' '--rate -3' '--only legs' '--unit-cm 0'; do
    # shellcheck disable=SC2086
    noh build "$work/walk.bvh" -o "$work/x.noh" $option
    expect 2 "build $option is a usage error"
done

sed '$d' "$work/walk.bvh" >"$work/short.bvh"
noh build "$work/short.bvh" -o "$work/x.noh"
expect 1 'a frame too few'
says 'line'
sed 's/^1 20 0 5/1 20 x 5/' "$work/walk.bvh" >"$work/word.bvh"
noh build "$work/word.bvh" -o "$work/x.noh"
expect 1 'a word among the numbers'
says 'line 20'
printf 'walk 0.02 step\nwalk later step\n' >"$work/keys.txt"
noh build "$work/walk.bvh" -o "$work/x.noh" --events "$work/keys.txt"
expect 1 'a callback key without a time'
says 'line 2'
check 'no pack was left' test ! -e "$work/x.noh"

clip=$assets/clips/Knight__Walking_A.rcl
if [ -f "$clip" ]; then
    noh build "$clip" -o "$work/a.noh" --quiet
    expect 0 'a real clip'
    noh build "$clip" -o "$work/b.noh" --quiet --error-cm 0.1 --shell-cm 10
    check 'a looser bound is smaller' sh -c 'test "$(wc -c <"$1/b.noh")" -lt "$(wc -c <"$1/a.noh")"' - "$work"
    noh build "$clip" -o "$work/b.noh" --quiet
    check 'the same bytes every time' cmp "$work/a.noh" "$work/b.noh"
else
    skip 'a real clip' 'no clips/Knight__Walking_A.rcl in NOH_ASSETS'
fi
finish
