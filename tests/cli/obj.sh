#!/bin/sh
# noh build of an .obj model with a folder of targets: a demo face written out and read back.
. "$(dirname "$0")/lib.sh"

mkdir "$work/shapes"
noh dump "$build/mask.noh" -o "$work/mask.obj"
expect 0 'the mask as an .obj file'
for target in smile anger; do
    noh dump "$build/mask.noh" -o "$work/shapes/$target.obj" --weight $target=1
    expect 0 "its $target"
done
noh build "$work/mask.obj" --targets "$work/shapes" -o "$work/back.noh"
expect 0 'built from the folder'
check 'it has the two targets' grep -q ' 2 targets' "$work/out"
noh verify "$work/back.noh"
expect 0 'verified'
noh dump "$work/back.noh" -o "$work/again.obj" --weight smile=1
expect 0 'its smile'

# The same positions, whatever their order.
positions() {
    awk '/^v / { printf "%.4f %.4f %.4f\n", $2 + 1, $3 + 1, $4 + 1 }' "$1" | sort -u
}
positions "$work/shapes/smile.obj" >"$work/one"
positions "$work/again.obj" >"$work/two"
same=$(comm -12 "$work/one" "$work/two" | wc -l)
all=$(wc -l <"$work/one")
check "to a tenth of a millimetre ($same of $all positions are equal)" test $((same * 100)) -ge $((all * 80))

# ---- what is refused ----

noh build "$build/mask.glb" --targets "$work/shapes" -o "$work/x.noh"
expect 2 '--targets of a glTF file'
says 'needs an .obj model'
noh build "$work/mask.obj" --targets "$work/nowhere" -o "$work/x.noh"
expect 1 'a folder that is not there'
says 'cannot be read'
head -n 3 "$work/mask.obj" >"$work/shapes/short.obj"
noh build "$work/mask.obj" --targets "$work/shapes" -o "$work/x.noh"
expect 1 'a target of fewer positions'
says 'target short.obj'
check 'and no pack' test ! -f "$work/x.noh"
printf 'v 0 0 0\nv 1 0 0\nf 1 2 3\n' >"$work/bad.obj"
noh build "$work/bad.obj" -o "$work/x.noh"
expect 1 'a corner that is not there'
says 'line 3'
finish
