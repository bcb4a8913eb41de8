#!/bin/sh
# noh build --surface: surface types of materials by name, extras and option; refused input; pictures.
. "$(dirname "$0")/lib.sh"

mask=$build/mask.glb
noh build "$mask" -o "$work/named.noh"
expect 0 'build by names'
check 'the report tells of irises' grep -q "material 'eyes': 2 eyes, an iris" "$work/out"
noh info "$work/named.noh"
for line in "material 'eyes': eye" "material 'teeth': teeth" "material 'paint': plain"; do
    check "info: $line" grep -q "$line" "$work/out"
done
noh info "$work/named.noh" --json
check 'info --json: eye' grep -q '"surface": "eye"' "$work/out"

noh build "$mask" -o "$work/told.noh" --surface eyes=plain --surface paint=skin --quiet
expect 0 'build by options'
noh info "$work/told.noh"
check 'an option outdoes a name' grep -q "material 'eyes': plain" "$work/out"
check 'and makes skin' grep -q "material 'paint': skin" "$work/out"
for option in eyes=wet eyes nose=eye; do
    noh build "$mask" -o "$work/none.noh" --surface $option
    expect 1 "--surface $option"
    says '--surface'
    check 'no pack of it' test ! -e "$work/none.noh"
done

# A figure of toons is lit by the low sun of the sky.
noh build "$mask" -o "$work/toon.noh" --surface paint=toon --plain --quiet
noh render "$work/toon.noh" -o "$work/auto.png" --size 64x64
noh render "$work/toon.noh" -o "$work/sky.png" --size 64x64 --light sky
check 'toons are lit by the sky' cmp -s "$work/auto.png" "$work/sky.png"

# Tints: by surface, by extras, by option.
noh info "$work/named.noh"
for line in "material 'eyes': eye, opaque, without tint" "material 'paint': plain, opaque, without tint"; do
    check "info: $line" grep -q "$line" "$work/out"
done
noh build "$mask" -o "$work/tinted.noh" --tint paint=on --tint eyes=on --quiet
expect 0 'build --tint'
noh info "$work/tinted.noh"
check 'an option outdoes extras' sh -c 'grep "material .paint.: plain, opaque" "$1" | grep -vq "without tint"' - "$work/out"
check 'and a surface' grep -q "material 'eyes': eye, opaque$" "$work/out"
check 'what is not named stays' grep -q "material 'wood': plain, opaque, without tint" "$work/out"
noh info "$work/tinted.noh" --json
check 'info --json: tint' grep -q '"tint": true' "$work/out"
for option in paint paint=red nose=on; do
    noh build "$mask" -o "$work/none.noh" --tint $option
    expect 1 "--tint $option"
    says '--tint'
    check 'no pack of that' test ! -e "$work/none.noh"
done

# Extras of a material, without a mesh that has it.
gltf() {
    printf '{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],"materials":[{"name":"%s","extras":%s}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}' "$1" "$2" >"$work/extras.gltf"
}
gltf leather '{"surface":"skin","unitMm":10}'
noh build "$work/extras.gltf" -o "$work/extras.noh"
expect 0 'extras'
noh info "$work/extras.noh"
check 'extras outdo a name' grep -q "material 'leather': skin" "$work/out"
gltf Std_Tearline '{}'
noh build "$work/extras.gltf" -o "$work/extras.noh"
check 'an opaque tear line is left out' grep -q "material 'Std_Tearline': an opaque shell would hide its eye" "$work/out"
noh build "$work/extras.gltf" -o "$work/extras.noh" --surface Std_Tearline=plain
expect 0 'with a surface that is given'
check 'it stays' sh -c '! grep -q "opaque shell" "$1"' - "$work/out"
gltf Std_Tearline '{"surface":"plain"}'
noh build "$work/extras.gltf" -o "$work/extras.noh"
expect 0 'and with one in extras'
check 'it stays, too' sh -c '! grep -q "opaque shell" "$1"' - "$work/out"
gltf robe '{"tint":false}'
noh build "$work/extras.gltf" -o "$work/extras.noh" --quiet
expect 0 'extras of tint'
noh info "$work/extras.noh"
check 'take a tint away' grep -q "material 'robe': plain, opaque, without tint" "$work/out"
gltf skin '{"surface":"wood","unitMm":-1,"tint":"no"}'
noh build "$work/extras.gltf" -o "$work/extras.noh"
expect 0 'extras that say nothing'
check 'are named' grep -q "the extra 'surface' must be plain, skin, eye, teeth, hair or toon" "$work/out"
check 'each of them' grep -q "the extra 'unitMm' must be" "$work/out"
check 'tint, too' grep -q "the extra 'tint' must be true or false" "$work/out"
noh info "$work/extras.noh"
check 'and the name counts' grep -q "material 'skin': skin" "$work/out"

# Blank eyes and a grey head: what a person says of them counts.
printf 'newmtl Eyes\nKd 0.9 0.9 0.9\nnewmtl Head\nKd 0.8 0.8 0.8\n' >"$work/blank.mtl"
awk 'BEGIN {
    print "mtllib blank.mtl\nvt 0 0\nusemtl Eyes"
    for (e = 0; e < 2; e++) for (i = 0; i < 12; i++) for (k = 0; k < 16; k++) {
        d = 3.14159265 * (i + 0.1) / 11.2; a = 3.14159265 * k / 8
        print "v", 0.012 * sin(d) * cos(a) + 0.062 * e - 0.031, 0.012 * sin(d) * sin(a) + 1.6, 0.012 * cos(d) + 0.1
    }
    for (v = 1; v <= 384; v++) if (v % 192 && v % 192 <= 176) {
        n = v % 16 ? v + 1 : v - 15
        print "f " v "/1 " v + 16 "/1 " n + 16 "/1 " n "/1"
    }
    print "v 0 0 0\nv 0.1 0 0\nv 0 1.7 0\nusemtl Head\nf 385/1 386/1 387/1"
}' >"$work/blank.obj"
# shellcheck disable=SC2086 # words
for row in skin 'plain --surface Head=plain' 'plain --plain' 'skin --surface Head=skin'; do
    set -- $row
    head=$1
    shift
    noh build "$work/blank.obj" -o "$work/blank.noh" "$@"
    expect 0 "build blank eyes $*"
    check "irises: $row" test "$(grep -c 'iris was painted' "$work/out")" = "$(test "${1:-}" = --plain && echo 0 || echo 1)"
    check "skin: $row" test "$(grep -c 'became skin' "$work/out")" = "$(test $# = 0 && echo 1 || echo 0)"
    noh info "$work/blank.noh"
    check "head: $row" grep -q "material 'Head': $head" "$work/out"
done

# A pit in skin that no texture shades.
awk 'BEGIN {
    n = 25
    print "usemtl Face_skin"
    for (i = 0; i < n * n; i++) {
        x = i % n - 12; y = int(i / n) - 12
        print "v", x / 100, y / 100, x * x < 12.5 && y * y < 12.5 ? -0.18 : 0
    }
    for (i = 1; i <= n * (n - 1); i++) if (i % n) print "f", i, i + 1, i + n + 1, i + n
}' >"$work/pit.obj"
for row in 1 '0 --plain' '0 --transfer 4' '0 --surface Face_skin=skin'; do
    # shellcheck disable=SC2086 # words
    set -- $row
    dark=$1
    shift
    noh build "$work/pit.obj" -o "$work/pit.noh" "$@" --warnings
    expect 0 "build a pit $*"
    check "hollows of skin: $row" test "$(cat "$work/out" "$work/err" | grep -c 'hollows of its skin')" = "$dark"
done

for name in named told; do
    noh render "$work/$name.noh" -o "$work/$name.png" --camera face --size 128x128
    expect 0 "render $name"
    noh render "$work/$name.noh" -o "$work/${name}_lit.png" --camera face --size 128x128 --light room
    expect 0 "render $name --light room"
done
check 'surfaces change the picture' sh -c '! cmp -s "$1" "$2"' - "$work/named.png" "$work/told.png"
check 'in a light, too' sh -c '! cmp -s "$1" "$2"' - "$work/named_lit.png" "$work/told_lit.png"
noh verify "$work/told.noh"
expect 0 'verify'
finish
