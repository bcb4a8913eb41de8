#!/bin/sh
# noh build --terrain: pictures and models as terrain, in packs of their own and with others; refused input.
. "$(dirname "$0")/lib.sh"

# 5 x 3 heights, 16 bits of grey: 0, 16384, 32768, 49152, 65535 in each row.
png=$work/hill.png
{
    printf '\211\120\116\107\015\012\032\012\000\000\000\015\111\110\104\122\000\000\000\005\000\000\000\003'
    printf '\020\000\000\000\000\056\315\106\147\000\000\000\026\111\104\101\124\170\332\143\140\140\160\140'
    printf '\150\140\070\300\360\377\077\003\126\046\000\224\126\012\173\230\231\237\024\000\000\000\000\111'
    printf '\105\116\104\256\102\140\202'
} >"$png"

noh build
expect 2 'nothing to build'
says '--terrain'
noh build -o "$work/out.noh" --terrain "$work/none.png"
expect 1 'a picture that is not there'
noh build -o "$work/out.noh" --terrain "$0"
expect 1 'a ground that is neither picture nor model'
says 'a .png, .glb or .gltf'
head -c 60 "$png" >"$work/cut.png"
noh build -o "$work/out.noh" --terrain "$work/cut.png"
expect 1 'a picture that is cut'
says 'cut.png'
for refused in '--terrain-size -1' '--terrain-height nan' '--terrain-points 1' '--terrain-points 5000' '--terrain-points 2.5'; do
    # shellcheck disable=SC2086 # words
    noh build -o "$work/out.noh" --terrain "$png" $refused
    expect 2 "$refused"
done
check 'nothing was written' test ! -e "$work/out.noh"

noh build -o "$work/hill.noh" --terrain "$png" --terrain-size 8 --terrain-height 4
expect 0 'a pack of the ground alone'
noh info "$work/hill.noh"
expect 0 'what is in it'
check 'its heights and sizes' grep -q '^terrain: 5 x 3 heights, 2.000 m apart: 8.00 x 4.00 m, 0.000 to 4.000 m high' "$work/out"
noh info "$work/hill.noh" --json
check 'the same as JSON' grep -q '"wide_m": 8' "$work/out"
noh build -o "$work/again.noh" --terrain "$png" --terrain-size 8 --terrain-height 4
check 'the same bytes again' cmp "$work/hill.noh" "$work/again.noh"
noh info "$build/mask.noh" --json
check 'a pack without has none' grep -q '"terrain": null' "$work/out"

head -c 200 "$work/hill.noh" >"$work/cut.noh"
noh info "$work/cut.noh"
expect 1 'a pack that is cut'

# ---- a place on it ----

printf 'area -3.5 -1.5 3.5 1.5\nspawn -3 -1 3 1\ngoal -2 0\ngoal 2 0\n' >"$work/hill.place"
noh crowd --place "$work/hill.place" --agents 4 --seconds 4 --ground "$work/hill.noh" --json
expect 0 'agents on a slope'
cp "$work/out" "$work/slope"
noh crowd --place "$work/hill.place" --agents 4 --seconds 4 --json
check 'go otherwise than on level ground' sh -c '! cmp -s "$1" "$2"' - "$work/out" "$work/slope"
noh crowd --place "$work/hill.place" --agents 4 --seconds 4 --ground "$png" --json
expect 0 'on a picture'
noh crowd --place "$work/hill.place" --ground "$build/mask.noh"
expect 1 'on a pack without a terrain'
says 'no terrain'
noh crowd --place door --ground "$work/hill.noh"
expect 2 'a scene lies on none'
noh budget "$build/demo/puppet_levels.noh" --nominal --actors 4 --place "$work/hill.place" --ground "$work/hill.noh"
expect 0 'the budget of all of it'
check 'has the terrain' grep -q '^  terrain  *65  *30$' "$work/out"
noh crowd "$build/demo/puppet_levels.noh" --place "$work/hill.place" --agents 4 --time 1 --ground "$work/hill.noh" --size 96x64 -o "$work/drawn.png"
if grep -q 'no GL context' "$work/err"; then
    skip 'a terrain drawn' 'no GL context here'
else
    expect 0 'the same drawn'
    check 'in as many bytes' grep -q '^terrain: CPU 65 bytes, GPU 30; [1-9][0-9]* triangles in 1 block' "$work/out"
    noh crowd "$build/demo/puppet_levels.noh" --place "$work/hill.place" --agents 4 --time 1 --size 96x64 -o "$work/level.png"
    check 'and is another picture' sh -c '! cmp -s "$1" "$2"' - "$work/drawn.png" "$work/level.png"
    noh render "$build/demo/puppet_levels.noh" -o "$work/stands.png" --size 96x96 --clip walk --ground "$work/hill.noh"
    expect 0 'a figure stands on it'
fi

if [ -f "$assets/khronos/RobotExpressive.glb" ]; then
    noh build "$assets/khronos/RobotExpressive.glb" -o "$work/robot.noh" --only mesh --terrain "$png" --quiet
    expect 0 'a model on its ground'
    noh info "$work/robot.noh"
    check 'both are there' awk '/^mesh/ { mesh = 1 } /^terrain: 5 x 3/ { ground = 1 } END { exit !(mesh && ground) }' "$work/out"
    noh budget "$work/robot.noh" --nominal --json
    expect 0 'its budget'
    check 'has the ground: 48 bytes and 2 a height' grep -q '"terrain_bytes": 78' "$work/out"
    noh build -o "$work/hill.noh" --terrain "$assets/khronos/RobotExpressive.glb" --terrain-points 33
    expect 0 'a ground out of any model'
else
    skip 'a model on its ground' 'no khronos/RobotExpressive.glb in NOH_ASSETS'
fi
finish
