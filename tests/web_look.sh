#!/bin/sh
# web_look.sh ASSET...: draws each model with noh in the light of a room, and with three.js's standard materials in
# three.js's room light, with the same camera. `make look-compare` runs it. It is not a test: judge the pictures by eye.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
out=$build/look-compare

leave_out() {
    echo "skipped: $1"
    exit 0
}
. tests/web/find_browser.sh
find_browser "$out" playwright-core three
three=$(node -p 'require("path").resolve(require.resolve("three"), "../..")')

for asset in "$@"; do
    name=$(basename "$asset" .glb)
    if [ ! -f "$asset" ]; then
        echo "left out: no $asset"
        continue
    fi
    "$build/noh" build "$asset" -o "$out/$name.noh" --quiet || exit 1
    "$build/noh" render "$out/$name.noh" -o "$out/${name}_noh.png" --light room --size 1080x1080 >/dev/null || exit 1
    node tests/web/look.js "$asset" "$out/${name}_noh.png" "$three" "$chromium" "$out" "$name" || exit 1
done
