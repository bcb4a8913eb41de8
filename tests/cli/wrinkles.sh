#!/bin/sh
# noh build --wrinkles, --wrinkle-map, --region-mask: deterministic bytes, painted files in place of generated ones, what
# is refused.
. "$(dirname "$0")/lib.sh"

noh build "$build/mask.glb" -o "$work/auto.noh" --wrinkles auto --only mesh
expect 0 'build --wrinkles auto'
check 'reports size and regions' grep -q "^wrinkles of mesh 'mask', material 'paint': normals 256 x 256, weights 64 x 64, 12 regions" "$work/out"
noh build "$build/mask.glb" -o "$work/again.noh" --wrinkles auto --only mesh --quiet
check 'the same bytes again' cmp "$work/auto.noh" "$work/again.noh"
noh verify "$work/auto.noh"
expect 0 'verify'
noh strip "$work/auto.noh" -o "$work/again.noh" --from-level 0 --quiet
check 'strip keeps them' cmp "$work/auto.noh" "$work/again.noh"

noh build "$build/mask.glb" -o "$work/small.noh" --wrinkles auto --wrinkle-size 64 --only mesh
check 'a size that is asked for' grep -q 'normals 64 x 64, weights 16 x 16' "$work/out"
check 'takes fewer bytes' test "$(wc -c <"$work/small.noh")" -lt "$(wc -c <"$work/auto.noh")"
for size in 100 32 4096 -64; do
    noh build "$build/mask.glb" -o "$work/no.noh" --wrinkles auto --wrinkle-size $size
    expect 2 "a size of $size"
done
noh build "$build/mask.glb" -o "$work/no.noh" --wrinkles all
expect 2 'an unknown way'
noh build "$build/mask.glb" -o "$work/no.noh" --region-mask "$work/none.png"
check 'a mask that is not there is refused' test "$code" != 0
png_is() { # FILE WIDTH HEIGHT, below 256
    [ "$(od -An -tu1 -j16 -N8 "$1" | tr -s ' ')" = " 0 0 0 $2 0 0 0 $3" ]
}
noh sheet "$work/auto.noh" -o "$work/sheet.png" --wrinkles --tile 48
expect 0 'sheet --wrinkles'
check 'five emotions, five rows' png_is "$work/sheet.png" 240 240
noh sheet "$work/auto.noh" -o "$work/sheet.png" --wrinkles --tile 48 --target anger --target smile,browInnerUp=0.5
expect 0 'sheet --wrinkles --target'
check 'a column each' png_is "$work/sheet.png" 96 240
noh sheet "$build/mask_levels.noh" -o "$work/no.png" --wrinkles
expect 1 'a pack without wrinkles'
says 'no mesh has wrinkles'

printf 'no picture' >"$work/bad.png"
noh build "$build/mask.glb" -o "$work/no.noh" --wrinkle-map "$work/bad.png"
expect 1 'a map that is no picture'
says 'neither PNG nor JPEG'
check 'names the file' grep -q 'bad.png' "$work/err"
noh build "$build/demo/arm.glb" -o "$work/no.noh" --wrinkles auto
expect 1 'a model without targets'
says 'no mesh can have wrinkles'
check 'writes nothing' test ! -e "$work/no.noh"

noh render "$build/mask.noh" -o "$work/map.png" --size 64x64
noh build "$build/mask.glb" -o "$work/painted.noh" --wrinkle-map "$work/map.png" --region-mask "$work/map.png" --only mesh
expect 0 'painted files'
check 'says so' grep -q 'normals 64 x 64 painted, weights 64 x 64 painted' "$work/out"
noh verify "$work/painted.noh"
expect 0 'verify'
finish
