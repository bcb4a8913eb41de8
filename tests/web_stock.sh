#!/bin/sh
# web_stock.sh FOLDER: the page of FOLDER, with its pack, in stock browsers (tests/web/stock.js), on a virtual display:
# Firefox, driven by puppeteer-core, and MiniBrowser of WebKitGTK, driven by WebKitWebDriver. Part of tests/web.sh with
# NOH_LONG=1; ends like tests/run.sh. A browser that is not available is skipped with the reason.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
out=$build/web-check/stock
passed=0 failed=0 skipped=0

leave_out() {
    echo "skipped: $1"
    echo "$passed passed, $failed failed, $((skipped + 1)) skipped"
    exit $((failed != 0))
}
command -v Xvfb >/dev/null 2>&1 || leave_out 'no display for Firefox and WebKit (xvfb)'
. tests/web/find_browser.sh
mkdir -p "$out"

# Without a display Firefox finds no software GL.
Xvfb -displayfd 3 -screen 0 1280x900x24 3>"$out/display" >"$out/xvfb.txt" 2>&1 &
xvfb=$!
trap 'kill $xvfb 2>/dev/null' EXIT
tries=0
while [ ! -s "$out/display" ] && [ $tries -lt 150 ]; do sleep 0.2; tries=$((tries + 1)); done
[ -s "$out/display" ] || leave_out 'Xvfb does not start here'
DISPLAY=:$(cat "$out/display")
export DISPLAY
try() { # NAME PROGRAM
    timeout -k 5 6000 node tests/web/stock.js "$folder" "$2" "$out" >"$out/$1.txt" 2>&1
    code=$?
    good=$(grep -c '^ok ' "$out/$1.txt") bad=$(grep -c '^not ok ' "$out/$1.txt")
    [ "$code" = 0 ] || [ "$bad" != 0 ] || bad=1
    passed=$((passed + good)) failed=$((failed + bad))
    grep -v '^ok \|^1\.\.' "$out/$1.txt"
}
lacks() {
    skipped=$((skipped + 1))
    echo "skipped: $1"
}

folder=$1
webkit=$(ls /usr/lib/*/webkit2gtk-4.*/MiniBrowser /usr/libexec/webkit2gtk-4.*/MiniBrowser 2>/dev/null | head -n 1)
if [ -n "$webkit" ] && command -v WebKitWebDriver >/dev/null 2>&1; then
    try webkit "$webkit"
else
    lacks 'no WebKit here (webkit2gtk-driver)'
fi
if firefox=$(command -v firefox-esr || command -v firefox); then
    find_packages "$out" puppeteer-core
    try firefox "$firefox"
else
    lacks 'no Firefox here (firefox-esr)'
fi
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" = 0 ] && [ "$passed" != 0 ]
