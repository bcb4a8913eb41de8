#!/bin/sh
# web_firefox.sh FOLDER: the page of FOLDER, with its pack, in a stock Firefox (tests/web/firefox.js), driven by
# puppeteer-core on a virtual display. Part of tests/web.sh with NOH_LONG=1; ends like tests/run.sh. Skipped with the
# reason if Firefox, Xvfb or puppeteer-core is not available.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
out=$build/web-check/firefox

leave_out() {
    echo "skipped: $1"
    echo '0 passed, 0 failed, 1 skipped'
    exit 0
}
firefox=$(command -v firefox-esr || command -v firefox) || leave_out 'no firefox here (firefox-esr)'
command -v Xvfb >/dev/null 2>&1 || leave_out 'no display for Firefox (xvfb)'
. tests/web/find_browser.sh
mkdir -p "$out"
find_packages "$out" puppeteer-core

# Without a display Firefox finds no software GL.
Xvfb -displayfd 3 -screen 0 1280x900x24 3>"$out/display" >"$out/xvfb.txt" 2>&1 &
xvfb=$!
trap 'kill $xvfb 2>/dev/null' EXIT
tries=0
while [ ! -s "$out/display" ] && [ $tries -lt 150 ]; do sleep 0.2; tries=$((tries + 1)); done
[ -s "$out/display" ] || leave_out 'Xvfb does not start here'
DISPLAY=:$(cat "$out/display") timeout -k 5 900 node tests/web/firefox.js "$1" "$firefox" "$out" >"$out/log.txt" 2>&1
code=$?
passed=$(grep -c '^ok ' "$out/log.txt") failed=$(grep -c '^not ok ' "$out/log.txt")
[ "$code" = 0 ] || [ "$failed" != 0 ] || failed=1
grep -v '^ok \|^1\.\.' "$out/log.txt"
echo "$passed passed, $failed failed, 0 skipped"
[ "$failed" = 0 ] && [ "$passed" != 0 ]
