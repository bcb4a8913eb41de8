#!/bin/sh
# web_bench.sh ASSET: compares frames of the page, three.js and Babylon.js in one browser and one run, and the same head as
# these, model-viewer and TalkingHead draw it by themselves (tests/web/compare_elements.js). Prints their cost, and saves and
# compares the pictures. `make web-bench` runs it; NOH_PATHS=cpu measures one path, NOH_PATHS=none only the second part. It
# is not a test: slowness is no failure.
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
find_browser "$out" playwright-core three @babylonjs/core @babylonjs/loaders @google/model-viewer @met4citizen/talkinghead esbuild
bundle() { # as a page would be shipped: what it uses, without the rest
    "$(node -p 'require("path").resolve(require.resolve("esbuild"), "../../bin/esbuild")')" "tests/web/compare_$1.js" --bundle --minify \
        --format=esm --log-level=warning --outfile="$out/$2.js" || exit 1
}
for side in three babylon model_viewer talkinghead; do bundle element_$side element_$side; done
node tests/web/compare_elements.js "$build/web/$(basename "$asset" .glb)" "$asset" "$chromium" "$out" || exit 1
[ "${NOH_PATHS:-}" != none ] || exit 0

for side in three babylon; do bundle $side $side; done
node tests/web/compare.js "$build/web/$(basename "$asset" .glb)" "$asset" "$chromium" "$out" || exit 1
for picture in "$out"/noh_*.png "$out"/babylon.png; do
    echo "$(basename "$picture") beside three.png: $("$build/tests/gl/picture_diff" "$picture" "$out/three.png" 255 1)"
done
echo "pictures: $out/side_by_side.png"
