#!/bin/sh
# noh build --springs and --spring, info and budget of springs, render and sheet with --springs on and off; refused
# input.
. "$(dirname "$0")/lib.sh"

puppet=$build/demo/puppet.glb
text=tools/demo_assets/puppet/puppet.springs

noh build "$puppet" -o "$work/a.noh" --plain --wrinkles face --springs $text --effort 1 --quiet
expect 0 'build --springs'
noh build "$puppet" -o "$work/plain.noh" --plain --wrinkles face --effort 1 --quiet
noh info "$work/a.noh"
expect 0 'info'
check 'tells how many swing' grep -q '^  springs: 4 joints in 4 chains, 4 colliders, ' "$work/out"
check 'and each chain' grep -q '^    sleeve.L  *1 joint, stiffness 0.3, drag 0.22, gravity 0 -0.75 0, ' "$work/out"
noh info "$work/a.noh" --json
check 'and as JSON' grep -q '"chains": *\[' "$work/out"
noh info "$work/plain.noh" --json
check 'null without' grep -q '"springs": *null' "$work/out"
noh budget "$work/a.noh"
expect 0 'budget'
check 'has their bytes' grep -q 'springs' "$work/out"
noh verify "$work/a.noh"
expect 0 'verify: plans are what is used'
noh strip "$work/a.noh" -o "$work/b.noh" --from-level 0 --quiet
check 'strip keeps them' cmp "$work/a.noh" "$work/b.noh"

for on in on off; do
    noh render "$work/a.noh" -o "$work/$on.png" --size 96x112 --clip dance --time 5.9 --springs $on
    expect 0 "render --springs $on"
done
noh render "$work/plain.noh" -o "$work/plain.png" --size 96x112 --clip dance --time 5.9
check 'off is a pack without springs' cmp "$work/off.png" "$work/plain.png"
check 'on is not' sh -c "! cmp -s '$work/on.png' '$work/off.png'"
noh render "$work/a.noh" -o "$work/again.png" --size 96x112 --clip dance --time 5.9
check 'on is the default, and the same each time' cmp "$work/on.png" "$work/again.png"
noh sheet "$work/a.noh" -o "$work/sheet.png" --clip walk --tiles 2 --tile 48 --springs off
expect 0 'sheet --springs off'
noh render "$work/a.noh" -o "$work/x.png" --springs maybe
expect 2 'neither on nor off'

noh build "$puppet" -o "$work/x.noh" --plain --wrinkles face --only mesh --spring 'chain sleeve* stiffness 0.5' --spring 'collider chest 0.1' --quiet
expect 0 'lines of the command line'
bones=$build/demo/get_up.glb # the same skeleton, without meshes
noh build "$bones" -o "$work/x.noh" --spring 'chain sleve*'
expect 1 'a joint that is not there'
says "'sleve*': no skeleton has this joint"
printf 'chain sleeve*\nchain sleeve.L\n' >"$work/twice.springs"
noh build "$bones" -o "$work/x.noh" --springs "$work/twice.springs"
expect 1 'a joint that swings twice'
says 'twice.springs:2: '
noh build "$bones" -o "$work/x.noh" --springs "$work/none.springs"
check 'a file that is not there' test "$code" != 0
noh build "$puppet" -o "$work/x.noh" --plain --springs $text --only anim
expect 2 'clips alone have none'
noh build "$puppet" -o "$work/x.noh" --plain --wrinkles face --springs $text --only mesh --quiet
expect 0 'meshes alone have them'

# 1100 chains that may touch 32 colliders each: 1060 bytes for each chain of an actor
awk -v n=1100 -v weights=AACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAA 'BEGIN {
    printf "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":96,\"uri\":\"data:;base64,"
    printf "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAAAA%s\"}],", weights
    printf "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":12},"
    printf "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":48}],\"accessors\":["
    printf "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
    printf "{\"bufferView\":1,\"componentType\":5121,\"count\":3,\"type\":\"VEC4\"},"
    printf "{\"bufferView\":2,\"componentType\":5126,\"count\":3,\"type\":\"VEC4\"}],\"meshes\":[{\"primitives\":["
    printf "{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":2}}]}],\"skins\":[{\"joints\":[0"
    for (i = 1; i <= 2 * n; i++) printf ",%d", i
    printf "]}],\"nodes\":[{\"name\":\"root\",\"children\":[1"
    for (i = 2; i <= n; i++) printf ",%d", i
    printf "]}"
    for (i = 1; i <= n; i++) printf ",{\"name\":\"j%d\",\"translation\":[0,1,0],\"children\":[%d]}", i, n + i
    for (i = 1; i <= n; i++) printf ",{\"name\":\"e%d\",\"translation\":[0,1,0]}", i
    print ",{\"mesh\":0,\"skin\":0}]}"
}' >"$work/many.gltf"
awk 'BEGIN { print "chain j*"; for (i = 1; i <= 32; i++) print "collider e" i " 0.1" }' >"$work/many.springs"
noh build "$work/many.gltf" -o "$work/many.noh" --springs "$work/many.springs" --warnings
expect 0 'more springs than a stage takes'
check 'with a warning' grep -q '^warning: springs of a skeleton take .* at most 1048576: give it fewer' "$work/err"
noh render "$work/many.noh" -o "$work/x.png" --size 64x64
expect 1 'which a picture refuses'
finish
