#!/bin/sh
# web_bench.sh ASSET: compares frames of the page, three.js and Babylon.js in one browser and one run. Prints their
# cost, and saves and compares the pictures. `make web-bench` runs it; NOH_PATHS=cpu measures one path. It is not a
# test: slowness is no failure.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
asset=$1
out=$build/web-bench

leave_out() {
    echo "skipped: $1"
    exit 0
}
. tests/web/find_browser.sh
find_browser "$out" playwright-core three @babylonjs/core @babylonjs/loaders esbuild
for side in three babylon; do # as a page would be shipped: what it uses, without the rest
    "$(node -p 'require("path").resolve(require.resolve("esbuild"), "../../bin/esbuild")')" tests/web/compare_$side.js --bundle --minify \
        --format=esm --log-level=warning --outfile="$out/$side.js" || exit 1
done

node tests/web/compare.js "$build/web/$(basename "$asset" .glb)" "$asset" "$chromium" "$out" || exit 1
for picture in "$out"/noh_*.png "$out"/babylon.png; do
    echo "$(basename "$picture") beside three.png: $("$build/tests/gl/picture_diff" "$picture" "$out/three.png" 255 1)"
done
echo "pictures: $out/side_by_side.png"
