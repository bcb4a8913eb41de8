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

# A JPEG with all of its pixels and no end marker is a texture, with a warning.
quant=$(printf '%64s' '' | sed 's/ /\\001/g') zeros='\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000'
grey="\377\330\377\333\000\103\000$quant\377\300\000\013\010\000\010\000\010\001\001\021\000"
grey="$grey\377\304\000\024\000\001$zeros\000"
grey="$grey\377\304\000\024\020\001$zeros\000\377\332\000\010\001\001\000\000\077\000\077"
printf 'newmtl a\nmap_Kd grey.jpg\n' >"$work/grey.mtl"
printf 'mtllib grey.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n' >"$work/grey.obj"
printf "$grey\377\331" >"$work/grey.jpg"
noh build "$work/grey.obj" -o "$work/ends.noh"
expect 0 'a JPEG'
check 'has no warning' sh -c '! grep -q warning "$1"' - "$work/out"
printf "$grey" >"$work/grey.jpg"
noh build "$work/grey.obj" -o "$work/endless.noh"
expect 0 'and one without its end'
check 'has one' grep -q "warning: material 'a': grey.jpg: .* has no end marker" "$work/out"
check 'and the same texture' cmp "$work/ends.noh" "$work/endless.noh"
finish
