#!/bin/sh
# compare.sh BUILD: our LOD levels against meshoptimizer's, on the mask, and on hero/head.glb and
# hero/body.glb where $NOH_ASSETS has them. Pictures are left in BUILD.
set -eu

build=${1:?"compare.sh BUILD"}

"$build/lod_compare" "$build/mask.glb" --picture "$build/lod_mask.png"
for name in head body; do
    file=${NOH_ASSETS:-}/hero/$name.glb
    if [ -f "$file" ]; then
        "$build/lod_compare" "$file" --picture "$build/lod_$name.png"
    else
        echo "no hero/$name.glb in NOH_ASSETS: skipped" >&2
    fi
done
