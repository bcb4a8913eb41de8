#!/bin/sh
# noh build --attributes: attributes of vertices for shaders of the game's own, from a file to info, budget and verify;
# strip and pack keep them; refused lists.
. "$(dirname "$0")/lib.sh"

# A strip of 16 vertices; each has an identity in _ID and three bytes in _MASK.
uri() { echo "data:application/octet-stream;base64,$(base64 -w0 <"$1")"; }
word() { # bytes of a number, little-endian: VALUE COUNT
    v=$1 c=$2
    while [ "$c" -gt 0 ]; do
        printf "\\$(printf %o $((v & 255)))"
        v=$((v >> 8)) c=$((c - 1))
    done
}
# floats of small multiples of a half, so that the shell can write them: 2 * VALUE from 0 to 31
half() {
    [ "$1" = 0 ] && word 0 4 && return
    e=0
    while [ $(($1 >> (e + 1))) -gt 0 ]; do e=$((e + 1)); done
    word $(((126 + e) << 23 | ($1 - (1 << e)) << (23 - e))) 4
}
n=16
for i in $(seq 0 $((n - 1))); do half "$i" && half $((i % 2)) && half $((i * i % 7)); done >"$work/positions"
for i in $(seq 0 $((n - 1))); do word $((i * 11)) 1 && word 255 1 && word "$i" 1 && word 0 1; done >"$work/mask"
for i in $(seq 0 $((n - 1))); do word $((60000 + i)) 2 && word 0 2; done >"$work/id"
for i in $(seq 0 $((n - 3))); do word "$i" 2 && word $((i + 1 + i % 2)) 2 && word $((i + 2 - i % 2)) 2; done >"$work/triangles"
cat >"$work/strip.gltf" <<END
{"asset":{"version":"2.0"},"buffers":[{"byteLength":192,"uri":"$(uri "$work/positions")"},{"byteLength":64,"uri":"$(uri "$work/mask")"},
{"byteLength":64,"uri":"$(uri "$work/id")"},{"byteLength":84,"uri":"$(uri "$work/triangles")"}],
"bufferViews":[{"buffer":0,"byteLength":192},{"buffer":1,"byteLength":64,"byteStride":4},{"buffer":2,"byteLength":64,"byteStride":4},{"buffer":3,"byteLength":84}],
"accessors":[{"bufferView":0,"componentType":5126,"count":16,"type":"VEC3"},{"bufferView":1,"componentType":5121,"normalized":true,"count":16,"type":"VEC3"},
{"bufferView":2,"componentType":5123,"count":16,"type":"SCALAR"},{"bufferView":3,"componentType":5123,"count":42,"type":"SCALAR"}],
"meshes":[{"name":"strip","primitives":[{"indices":3,"attributes":{"POSITION":0,"_MASK":1,"_ID":2}}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}]}
END

noh build "$work/strip.gltf" -o "$work/plain.noh"
expect 0 'without the option they are left out'
check 'which is said' grep -q 'the attribute _ID was left out; --attributes keeps it' "$work/out" "$work/err"
noh build "$work/strip.gltf" -o "$work/strip.noh" --attributes _MASK,_ID
expect 0 'build --attributes'
check 'then not' sh -c '! grep -q "was left out" "$1" "$2"' - "$work/out" "$work/err"
noh info "$work/strip.noh"
expect 0 'info'
check 'lists their bytes' grep -q '^  extra attributes, 8 bytes a vertex:$' "$work/out"
check 'the first' grep -q '^    0 _MASK: 3 x 8 bits, within [0-9.e-]*$' "$work/out"
check 'and the second, which is exact' grep -q '^    1 _ID: 1 x 16 bits, within 0$' "$work/out"
noh info "$work/strip.noh" --json
check 'as JSON too' grep -q '"name": "_ID"' "$work/out"
noh verify "$work/strip.noh"
expect 0 'verify draws it on every path, in the bytes of the budget'
bytes() { "$build/noh" budget "$1" --nominal | awk '/mesh buffers/ { print $NF }'; }
check 'the budget has 8 bytes a vertex more' test "$(($(bytes "$work/strip.noh") - $(bytes "$work/plain.noh")))" = 128
noh strip "$work/strip.noh" -o "$work/same.noh" --from-level 0 --quiet
check 'strip keeps them' cmp "$work/strip.noh" "$work/same.noh"
noh pack "$work/strip.noh" -o "$work/strip.nohz"
expect 0 'pack'
noh info "$work/strip.nohz"
check 'which keeps them' grep -q '_ID: 1 x 16 bits' "$work/out"
noh build "$work/strip.gltf" -o "$work/no.noh" --attributes ID
expect 2 'a wrong name is refused'
says '--attributes'
noh build "$work/strip.gltf" -o "$work/no.noh" --attributes _WIND
expect 1 'and one that no mesh has'
says "no mesh has '_WIND'"
finish
