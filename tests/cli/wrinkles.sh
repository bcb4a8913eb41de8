#!/bin/sh
# noh build --wrinkles, --wrinkle-map, --region-mask: deterministic bytes, painted files instead of generated ones,
# refused input; --color-map: colours that fade in with targets.
. "$(dirname "$0")/lib.sh"

noh build "$build/mask.glb" -o "$work/auto.noh" --wrinkles auto --only mesh
expect 0 'build --wrinkles auto'
check 'reports size and regions' grep -q "^wrinkles of mesh 'mask', material 'paint': normals 512 x 512, weights 64 x 64, 9 regions" "$work/out"
noh verify "$work/auto.noh"
expect 0 'verify'
noh strip "$work/auto.noh" -o "$work/again.noh" --from-level 0 --quiet
check 'strip keeps them' cmp "$work/auto.noh" "$work/again.noh"

noh build "$build/mask.glb" -o "$work/small.noh" --wrinkles auto --wrinkle-size 64 --only mesh
check 'a size that is asked for' grep -q 'normals 64 x 64, weights 8 x 8' "$work/out"
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
says 'not a PNG, JPEG, WebP, TGA, BMP or Photoshop picture'
check 'names the file' grep -q 'bad.png' "$work/err"
noh build "$build/mask.glb" -o "$work/default.noh" --only mesh --quiet
check 'a face has folds without asking, of the same bytes' cmp "$work/auto.noh" "$work/default.noh"
noh build "$build/mask.glb" -o "$work/plain.noh" --wrinkles off --only mesh --quiet
check 'and none if they are not wanted' sh -c "! '$build/noh' info '$work/plain.noh' | grep -q wrinkle"
noh build "$build/demo/nell.glb" -o "$work/nell.noh" --only mesh
check 'what cannot have them is built without a word of it' sh -c "! grep -qi wrinkle '$work/out' '$work/err'"
noh build "$build/demo/arm.glb" -o "$work/no.noh" --wrinkles auto
expect 1 'a model without targets'
says 'no mesh can have wrinkles'
check 'writes nothing' test ! -e "$work/no.noh"

noh mask "$build/mask.glb" --export "$work/regions.png"
expect 0 'mask --export of a model'
check 'no code of it is illegal' grep -q ' 0 illegal codes' "$work/out"
noh build "$build/mask.glb" -o "$work/again.noh" --wrinkles auto --region-mask "$work/regions.png" --only mesh --quiet
check 'read back, it gives the same regions' cmp "$work/auto.noh" "$work/again.noh"
noh build "$build/mask.glb" -o "$work/raw.noh" --wrinkles auto --textures raw --only mesh --quiet
noh mask "$work/raw.noh" --export "$work/of_pack.png" --quiet
expect 0 'mask --export of a pack'
check 'the same mask' cmp "$work/regions.png" "$work/of_pack.png"
noh mask "$build/mask.glb" --export "$work/large.png" --size 200 --quiet
check 'of a size that is asked for' png_is "$work/large.png" 200 200
noh mask "$build/mask_levels.noh" --export "$work/no.png"
expect 1 'mask --export of a pack without regions'
noh mask "$work/auto.noh"
expect 2 'a pack without --export'

noh build "$build/mask.glb" -o "$work/pixel.noh" --wrinkles auto --region-mask "$work/regions.png" --wrinkle-lookup pixel --whole-textures --only mesh --quiet
expect 0 'build --wrinkle-lookup pixel'
noh mask "$work/pixel.noh" --export "$work/of_pack.png" --quiet
check 'the pack has the painted texels' cmp "$work/regions.png" "$work/of_pack.png"
noh info "$work/pixel.noh"
check 'one mask in place of three maps' grep -q "wrinkle regions by pixel 'mask wrinkle regions'" "$work/out"
noh verify "$work/pixel.noh"
expect 0 'verify'
noh render "$work/pixel.noh" -o "$work/shown.png" --size 64x64 --weight anger=1
expect 0 'render'
noh build "$build/mask.glb" -o "$work/no.noh" --wrinkles auto --wrinkle-lookup texel
expect 2 'an unknown lookup'
printf 'wrinkle anger 4 0.5\nwrinkle nobody 1\n' >"$work/rows.recipe"
noh build "$build/mask.glb" -o "$work/rows.noh" --wrinkles auto --recipe "$work/rows.recipe" --only mesh
expect 0 'rows of wrinkles in a recipe'
check 'warns of a target that is not there' grep -q "rows.recipe:2: no mesh has the target 'nobody'" "$work/out"
check 'they change the table' test "$(cmp -l "$work/auto.noh" "$work/rows.noh" | wc -l)" -gt 2

flush=$build/demo/flush.png
printf 'tint r b02020\ncolor smile r 0.5\ncolor anger r\ncolor nobody r\n' >"$work/blush.recipe"
noh build "$build/mask.glb" -o "$work/blush.noh" --wrinkles off --color-map "$flush" --recipe "$work/blush.recipe" --only mesh
expect 0 'build --color-map'
check 'reports size and rows' grep -q "^colours of mesh 'mask', material 'paint': 64 x 64, 2 rows of the recipe" "$work/out"
check 'warns of a target that is not there' grep -q "blush.recipe:4: no mesh has the target 'nobody'" "$work/out"
noh verify "$work/blush.noh"
expect 0 'verify'
noh info "$work/blush.noh"
check 'info names the map' grep -q "^material 'paint'.* colours by target 'mask colours'" "$work/out"
noh strip "$work/blush.noh" -o "$work/again.noh" --from-level 0 --quiet
check 'strip keeps the colours' cmp "$work/blush.noh" "$work/again.noh"
for weight in 0 1; do
    for pack in blush plain; do
        noh render "$work/$pack.noh" -o "$work/$pack$weight.png" --size 64x64 --weight smile=$weight
        expect 0 "render, $pack, smile $weight"
    done
done
check 'at rest the mask has no colours' cmp "$work/blush0.png" "$work/plain0.png"
check 'it blushes with its smile' sh -c "! cmp -s '$work/blush1.png' '$work/plain1.png'"
noh build "$build/mask.glb" -o "$work/no.noh" --color-map "$flush"
expect 1 'a map without rows'
says 'color TARGET CHANNEL'
noh build "$build/mask.glb" -o "$work/no.noh" --color-map "$flush" --color-material nothing --recipe "$work/blush.recipe"
expect 1 'a material that is not there'
says 'it has no such material'
printf 'tint a b02020\ncolor smile a\n' >"$work/alpha.recipe"
noh build "$build/mask.glb" -o "$work/no.noh" --color-map "$flush" --recipe "$work/alpha.recipe"
expect 1 'a channel that the map does not have'
says 'it has no alpha channel'
noh build "$build/mask.glb" -o "$work/no.noh" --recipe "$work/blush.recipe" --only mesh
check 'rows without a map are said' grep -q 'color rows have no effect without --color-map' "$work/out"
noh build "$build/mask.glb" -o "$work/no.noh" --color-material paint
expect 2 '--color-material without --color-map'

noh render "$build/mask.noh" -o "$work/map.png" --size 64x64
noh build "$build/mask.glb" -o "$work/painted.noh" --wrinkle-map "$work/map.png" --region-mask "$work/map.png" --only mesh
expect 0 'painted files'
check 'says so' grep -q 'normals 64 x 64 painted, weights 64 x 64 painted' "$work/out"
noh verify "$work/painted.noh"
expect 0 'verify'
finish
