#!/bin/sh
# --look-at and --ground of `noh render` and `noh sheet`: pictures differ with the point and the ground; models without
# eyes or feet are refused with a reason. test_stage_feet and test_stage_gaze test that soles meet the ground and gazes
# their points.
. "$(dirname "$0")/lib.sh"

puppet=$build/demo/puppet_levels.noh

# picture NAME ARGUMENTS...: the puppet walks for 0.9 s.
picture() {
    name=$1
    shift
    noh render "$puppet" -o "$work/$name.png" --size 96x96 --clip walk --time 0.9 --camera 70,8,5 "$@"
    expect 0 "$name is drawn"
}
picture plain
picture left --look-at 1,1.6,4
picture right --look-at -1,1.6,4
picture again --look-at 1,1.6,4
picture stairs --ground stairs
picture slope --ground slope
picture both --ground slope --look-at 1,1.6,4
picture alive --look-at 1,1.6,4 --face on
check 'the same each time' cmp "$work/left.png" "$work/again.png"
for pair in plain:left left:right plain:stairs stairs:slope slope:both left:alive; do
    check "pictures differ: $pair" sh -c '! cmp -s "$1" "$2"' - "$work/${pair%:*}.png" "$work/${pair#*:}.png"
done
# A plane that rises by 4 in 16.
cat >"$work/hill.gltf" <<'HILL'
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
 "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
 "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[-8,0,-8],"max":[8,4,8]},{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}],
 "bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],
 "buffers":[{"byteLength":60,"uri":"hill.bin"}]}
HILL
# (-8,0,-8) (-8,4,8) (8,4,8) (8,0,-8); 0 1 2, 0 2 3
printf '\000\000\000\301\000\000\000\000\000\000\000\301\000\000\000\301\000\000\200\100\000\000\000\101\000\000\000\101\000\000\200\100\000\000\000\101\000\000\000\101\000\000\000\000\000\000\000\301\000\000\001\000\002\000\000\000\002\000\003\000' >"$work/hill.bin"
picture hill --ground "$work/hill.gltf"
check 'a hill is another ground' sh -c '! cmp -s "$1" "$2"' - "$work/hill.png" "$work/slope.png"
noh render "$puppet" -o "$work/no.png" --clip walk --ground "$work/none.png"
expect 1 'terrain that is not there'
noh sheet "$puppet" -o "$work/sheet.png" --clip walk --tiles 3 --tile 48 --ground stairs --look-at 0,1,3
expect 0 'a sheet is drawn'

for wrong in 1,2 1,2,3,4 1,2,x 1,2,nan 1,2,3e9 ''; do
    noh render "$puppet" -o "$work/no.png" --clip walk --look-at "$wrong"
    expect 2 "no point: '$wrong'"
done
noh render "$puppet" -o "$work/no.png" --clip walk --ground lava
expect 2 'no such ground'
noh render "$puppet" -o "$work/no.png" --ground stairs
expect 2 'a ground without a clip'
noh sheet "$puppet" -o "$work/no.png" --clip walk --ground stairs --to bow
expect 2 'a ground in a transition'
sh "$(dirname "$0")/../support/small_glb.sh" >"$work/small.glb"
noh build "$work/small.glb" -o "$work/small.noh"
noh render "$work/small.noh" -o "$work/no.png" --look-at 1,2,3
expect 1 'two joints without a head look at nothing'
check 'and says so' grep -q 'look-at' "$work/err"
# A mask has no joints: targets turn its eyes, at once, to either side and as far as they go where the point is behind.
mask() {
    noh render "$build/mask.noh" -o "$work/mask_$1.png" --size 96x96 --camera face --look-at "$2"
    expect 0 "a mask looks $1"
}
mask ahead 0,0,2
mask left 2,0,0.5
mask behind 2,0,-1
mask right -2,0,0.5
for other in left right behind; do
    check "not ahead: $other" sh -c '! cmp -s "$1" "$2"' - "$work/mask_ahead.png" "$work/mask_$other.png"
done
check 'not the same side' sh -c '! cmp -s "$1" "$2"' - "$work/mask_left.png" "$work/mask_right.png"
noh render "$build/mask.noh" -o "$work/face.png" --size 64x64 --look-at 1,2,3 --face on
expect 0 'a face that lives looks'
finish
