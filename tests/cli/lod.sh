#!/bin/sh
# noh build --lod: LOD levels by number and by error, refused values, and that such packs verify.
. "$(dirname "$0")/lib.sh"

arm=$build/demo/arm.glb
head=$assets/hero/head.glb

# The reported levels: lines of "level N: ... triangles"; of one number, where it is given.
levels() {
    grep -c "^  level ${1:-[0-9]}:" "$work/out"
}

noh build "$arm" -o "$work/none.noh"
expect 0 'build'
check 'reports no levels' test "$(levels)" = 0
noh build "$arm" -o "$work/one.noh" --lod 1
expect 0 'build --lod 1'
check 'gives the same bytes' cmp "$work/none.noh" "$work/one.noh"

noh build "$arm" -o "$work/four.noh" --lod 4 --lod-fast
expect 0 'build --lod 4 --lod-fast'
meshes=$(grep -c '^mesh .* targets$' "$work/out")
check "reports a coarser level of each mesh ($meshes)" test "$meshes" -gt 0 -a "$(levels 1)" = "$meshes" -a "$(levels 2)" = "$meshes"
check 'is another pack' sh -c '! cmp -s "$1" "$2"' - "$work/none.noh" "$work/four.noh"
noh build "$arm" -o "$work/again.noh" --lod 4 --lod-fast --lod-color 0.24 --quiet
expect 0 'build it again, quietly, with the weight of colours that is its own'
check 'prints nothing' test ! -s "$work/out"
check 'gives the same bytes' cmp "$work/four.noh" "$work/again.noh"
noh build "$arm" -o "$work/painted.noh" --lod 4 --lod-fast --lod-color 20 --quiet
check 'with a larger one the levels are others' sh -c '! cmp -s "$1" "$2"' - "$work/four.noh" "$work/painted.noh"
noh verify "$work/four.noh"
expect 0 'verify of a pack with levels'
noh info "$work/four.noh"
expect 0 'info of a pack with levels'

noh build "$arm" -o "$work/auto.noh" --lod auto --lod-fast
expect 0 'build --lod auto --lod-fast'
check 'reports levels' test "$(levels)" -gt 0
noh verify "$work/auto.noh"
expect 0 'verify of levels by error'

# ---- vertices of their own ----

noh build "$arm" -o "$work/own.noh" --lod 3
expect 0 'build --lod 3'
noh build "$arm" -o "$work/shared.noh" --lod 3 --lod-own 0
expect 0 'build --lod 3 --lod-own 0'
check 'without vertices of their own the pack is smaller' test "$(wc -c <"$work/shared.noh")" -lt "$(wc -c <"$work/own.noh")"
noh verify "$work/own.noh"
expect 0 'verify of vertices of their own'
noh pack "$work/own.noh" -o "$work/own.nohz"
expect 0 'pack of them'
noh strip "$work/own.nohz" -o "$work/back.noh" --from-level 0 --quiet
expect 0 'unpack of them'
check 'gives the same bytes' cmp "$work/own.noh" "$work/back.noh"
noh strip "$work/own.noh" -o "$work/stripped.noh" --from-level 1
expect 0 'strip of them'
noh verify "$work/stripped.noh"
expect 0 'verify of what is left'

# ---- what is refused ----

for value in 0 9 -1 2.5 x '' 4x; do
    noh build "$arm" -o "$work/refused.noh" --lod "$value"
    expect 2 "build --lod '$value'"
    says "--lod must be auto or a whole number from 1 to 8, not '$value'"
done
for value in 0 -1 101 x; do
    noh build "$arm" -o "$work/refused.noh" --lod 4 --lod-color "$value"
    expect 2 "build --lod-color $value"
done
says '--lod-color'
noh build "$arm" -o "$work/refused.noh" --lod-color 1
expect 2 'build --lod-color without levels'
for value in -0.1 1.5 x; do
    noh build "$arm" -o "$work/refused.noh" --lod 4 --lod-own "$value"
    expect 2 "build --lod-own $value"
done
noh build "$arm" -o "$work/refused.noh" --lod-own 0.1
expect 2 'build --lod-own without levels'
for value in on joints: joints:0 joints:8 joints:22; do
    noh build "$arm" -o "$work/refused.noh" --lod 4 --lod-faces "$value"
    expect 2 "build --lod-faces $value"
done
says '--lod-faces must be targets, joints or joints:K'
noh build "$arm" -o "$work/refused.noh" --lod
expect 2 'build --lod without a value'
check 'no pack was written by any of these' test ! -e "$work/refused.noh"

# ---- nothing to simplify ----

cat >"$work/clip.bvh" <<'BVH'
HIERARCHY
ROOT a
{
OFFSET 0 0 0
CHANNELS 3 Zrotation Xrotation Yrotation
End Site
{
OFFSET 0 9 0
}
}
MOTION
Frames: 2
Frame Time: 0.05
0 0 0
5 0 0
BVH
noh build "$work/clip.bvh" -o "$work/clip.noh" --quiet
expect 0 'build of a clip only'
noh build "$work/clip.bvh" -o "$work/clip_lod.noh" --lod 4 --quiet
expect 0 'build of a clip only, with --lod 4'
check 'gives the same bytes' cmp "$work/clip.noh" "$work/clip_lod.noh"

# ---- a real face ----

if [ -n "${NOH_SAN:-}" ]; then
    skip 'head.glb with levels' 'takes long under a sanitizer'
elif [ -f "$head" ]; then
    noh build "$head" -o "$work/head.noh" --plain --wrinkles face --lod 4 --lod-fast
    expect 0 'build of head.glb with --lod 4 --lod-fast'
    check 'reports three levels' test "$(levels)" = 3
    noh verify "$work/head.noh"
    expect 0 'verify of it'
    noh build "$head" -o "$work/joints.noh" --plain --wrinkles face --lod 4 --lod-fast --lod-faces joints
    expect 0 'build of it with --lod-faces joints'
    check 'in one level' test "$(grep -c '^  level .* virtual joints' "$work/out")" = 1
    noh verify "$work/joints.noh" --lod 3
    expect 0 'verify of the level with virtual joints'
    for weight in 0 1; do
        noh dump "$work/joints.noh" -o "$work/mouth$weight.obj" --lod 3 --weight "mouth-open=$weight"
        expect 0 "dump of it with the mouth at $weight"
    done
    check 'targets move its vertices' sh -c '! cmp -s "$1" "$2"' - "$work/mouth0.obj" "$work/mouth1.obj"
    noh build "$head" -o "$work/joints.noh" --plain --wrinkles face --lod 4 --lod-fast --lod-faces joints:2 --quiet
    noh info "$work/joints.noh"
    check 'from level 2 on' test "$(grep -c '^  level .* 0 texels' "$work/out")" = 2
else
    skip 'head.glb with levels' 'no hero/head.glb in NOH_ASSETS'
fi
finish
