#!/bin/sh
# web_bench.sh ASSET: a frame of the page beside three.js's, in one browser, in one run; what they cost is printed, both
# pictures are kept and compared. `make web-bench` runs it. No test: nothing fails for being slow.
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
find_browser "$out" playwright-core three
three=$(node -p 'require("path").resolve(require.resolve("three"), "../..")')

node tests/web/compare.js "$build/web/$(basename "$asset" .glb)" "$asset" "$three" "$chromium" "$out" || exit 1
for picture in "$out"/noh_*.png; do
    echo "$(basename "$picture") beside three.png: $("$build/tests/gl/picture_diff" "$picture" "$out/three.png" 255 1)"
done
echo "pictures: $out/side_by_side.png"
