#!/bin/sh
# web.sh: the page of `make web` in headless Chromium: loaded, moved, lost and restored, and its
# canvas compared with `noh render`. `make web-check` runs it. Closes as tests/run.sh does.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
out=$build/web-check
mkdir -p "$out"

leave_out() {
    echo "skipped: $1"
    echo '0 passed, 0 failed, 1 skipped'
    exit 0
}
command -v node >/dev/null 2>&1 || leave_out 'no node here'
chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || leave_out 'no chromium here'
export NODE_PATH="$out/node_modules${NODE_PATH:+:$NODE_PATH}"
if ! node -e 'require("playwright-core")' 2>/dev/null; then
    (cd "$out" && npm install --no-save --silent playwright-core >/dev/null 2>&1)
    node -e 'require("playwright-core")' 2>/dev/null || leave_out 'playwright-core cannot be had here'
fi

timeout -k 5 300 node tests/web/page.js "$build/web" "$chromium" "$out" >"$out/log.txt" 2>&1
code=$?
passed=$(grep -c '^ok ' "$out/log.txt") failed=$(grep -c '^not ok ' "$out/log.txt")
[ $code = 0 ] || [ "$failed" != 0 ] || failed=1
grep -v '^ok ' "$out/log.txt"

# Another rasteriser than llvmpipe: the limits of tests/gl/matrix.sh.
for face in rest:0 smile:1; do
    "$build/noh" render "$build/web/page.noh" -o "$out/native.png" --weight smile=${face#*:} >/dev/null || { failed=$((failed + 1)); break; }
    for path in auto mrt gather; do
        if said=$("$build/tests/gl/picture_diff" "$out/native.png" "$out/${path}_${face%:*}.png" 0.25 0.01); then
            passed=$((passed + 1))
        else
            failed=$((failed + 1))
            printf 'not the native picture: '
        fi
        echo "${path}_${face%:*}: $said"
    done
done
echo "$passed passed, $failed failed, 0 skipped"
[ "$failed" = 0 ] && [ "$passed" != 0 ]
