#!/bin/sh
# web_bundlers.sh PACK: the npm package of `make npm` in production builds of Vite, webpack, esbuild and Parcel, under a
# strict Content-Security-Policy, in Chromium (tests/web/bundlers.js). Part of tests/web.sh; ends like tests/run.sh.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
project=$build/web-check/bundlers

leave_out() {
    echo "skipped: $1"
    echo '0 passed, 0 failed, 1 skipped'
    exit 0
}
[ -f "$build/npm/package/convert/convert.wasm" ] || leave_out 'the package has no converter'
. tests/web/find_browser.sh
find_browser "$build/web-check" playwright-core axe-core typescript three @types/three @types/react # the same list as in web.sh
find_packages "$project" vite webpack webpack-cli esbuild parcel
echo '{ "private": true, "browserslist": "chrome >= 100" }' >"$project/package.json" # for newer ones Parcel writes an inline import map
rm -rf "$project/node_modules/noh-character"
cp -a "$build/npm/package" "$project/node_modules/noh-character"
cp "$build/demo/arm.glb" "$project"
cp "$1" "$project/face.noh"
timeout -k 5 6000 node tests/web/bundlers.js "$project" "$chromium" "$build/web-check" "$project" >"$project/log.txt" 2>&1
code=$?
passed=$(grep -c '^ok ' "$project/log.txt") failed=$(grep -c '^not ok ' "$project/log.txt")
[ "$code" = 0 ] || [ "$failed" != 0 ] || failed=1
grep -v '^ok \|^1\.\.' "$project/log.txt"
echo "$passed passed, $failed failed, 0 skipped"
[ "$failed" = 0 ] && [ "$passed" != 0 ]
