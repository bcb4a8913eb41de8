#!/bin/sh
# demo.sh BUILD: convert the mask, draw it by additive blending into three render targets, and print what it costs.
set -eu
build=$1
noh=$build/noh

echo
"$noh" build "$build/mask.glb" -o "$build/mask.noh" --wrinkles auto
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
"$noh" budget "$build/mask.noh" --path layered --nominal
echo
echo 'LOD levels (--lod-fast; without it their errors are smaller, and the build takes a minute):'
"$noh" build "$build/mask.glb" -o "$build/mask_levels.noh" --lod 4 --lod-fast --quiet
"$noh" sheet "$build/mask_levels.noh" -o "$build/mask_levels.png" --lods --tile 256 --target smile --target eyeBlinkLeft,eyeBlinkRight \
    --path "$path"
"$noh" budget "$build/mask_levels.noh" --path "$path" | sed -n '/^level/,$p'
echo
echo 'Pictures:'
echo "  $build/mask.png           at rest"
echo "  $build/mask_smile.png     --weight smile=1"
echo "  $build/mask_targets.png   every target"
echo "  $build/mask_faces.png     the picture in the README"
echo "  $build/mask_levels.png    every LOD level: at rest, smiling, eyes shut, and at the size at which it is used"
