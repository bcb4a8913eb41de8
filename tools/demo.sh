#!/bin/sh
# demo.sh BUILD: convert Nell and the mask, draw them, and print what the mask costs.
set -eu
build=$1
noh=$build/noh

echo
"$noh" build "$build/demo/nell.glb" -o "$build/demo/nell.noh" --plain --wrinkles face
"$noh" render "$build/demo/nell.noh" -o "$build/nell.png"
"$noh" sheet "$build/demo/nell.noh" -o "$build/nell_greet.png" --clip greet --tiles 8 --columns 4 --tile 256
"$noh" sheet "$build/demo/nell.noh" -o "$build/nell_faces.png" --target smile --target surprise --target blink \
    --target viseme_aa --columns 5 --tile 288
echo
"$noh" build "$build/mask.glb" -o "$build/mask.noh" --plain --wrinkles face
echo
way=$(sh tools/demo_path.sh "$noh" "$build/mask.noh")
path=$(echo "$way" | sed -n 1p)
echo "$way" | sed -n 2p
echo
"$noh" render "$build/mask.noh" -o "$build/mask.png" --size 640x720 --path "$path"
"$noh" render "$build/mask.noh" -o "$build/mask_smile.png" --size 640x720 --weight smile=1 --camera 18,4 --path "$path"
"$noh" sheet "$build/mask.noh" -o "$build/mask_targets.png" --path "$path"
"$noh" sheet "$build/mask.noh" -o "$build/mask_faces.png" --target smile --target surprise --target anger --target blink \
    --columns 5 --tile 288 --camera 14,4 --path "$path"
"$noh" sheet "$build/demo/flush.noh" -o "$build/mask_colors.png" --target smile --target surprise --target anger --columns 4 \
    --tile 256 --light room
"$noh" budget "$build/mask.noh" --path layered --nominal
echo
echo 'LOD levels (--lod-fast; without it their errors are smaller, and the build takes a minute):'
"$noh" sheet "$build/mask_levels.noh" -o "$build/mask_levels.png" --lods --tile 256 --target smile --target eyeBlinkLeft,eyeBlinkRight \
    --path "$path"
"$noh" budget "$build/mask_levels.noh" --path "$path" | sed -n '/^level/,$p'
echo
echo 'Pictures:'
echo "  $build/nell.png           Nell, a head modelled by code"
echo "  $build/nell_greet.png     --clip greet: she says hello and smiles"
echo "  $build/nell_faces.png     the picture in the README"
echo "  $build/mask.png           a mask at rest"
echo "  $build/mask_smile.png     --weight smile=1"
echo "  $build/mask_targets.png   every target"
echo "  $build/mask_faces.png     a Noh mask's faces"
echo "  $build/mask_colors.png    --color-map: it blushes, pales, reddens"
echo "  $build/mask_levels.png    every LOD level: at rest, smiling, eyes shut, and at the size at which it is used"
