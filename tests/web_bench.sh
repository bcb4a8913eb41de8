#!/bin/sh
# web_bench.sh ASSET: a frame of the page beside one of three.js, in one browser and one run. Prints what they cost, and
# keeps and compares both pictures. `make web-bench` runs it. It is no test: slowness is no failure.
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
