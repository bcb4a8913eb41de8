#!/bin/sh
# tsan.sh: the library and tests/unit/bank/test_threads.c built with ThreadSanitizer, and run: four threads pose the controllers
# of one clip set. Passes when every test does and nothing was reported. CC=clang or gcc; NOH_BUILD=build.
# Asserts of both tiers are on. Needs neither C++ nor GL: it is built as the cross tests are.
set -eu
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}/tsan
cc=${CC:-gcc}
mkdir -p "$build"
echo 'int main(void) { return 0; }' >"$build/try.c"
if ! "$cc" -fsanitize=thread "$build/try.c" -o "$build/try" 2>"$build/try.txt" || ! "$build/try" 2>>"$build/try.txt"; then
    echo "skipped: $cc has no ThreadSanitizer that runs here"
    sed 's/^/    | /' "$build/try.txt" | tail -n 3
    exit 0
fi
# shellcheck disable=SC2046
make --no-print-directory -j"${JOBS:-2}" DEPS=0 CROSS=1 SAN=thread BUILD="$build" CC="$cc" OPT='-O1 -g -DNOH_ASSERT_LEVEL=2' LDFLAGS='-pthread -fsanitize=thread' \
    "$build/cross/test_threads" >"$build/make.txt" 2>&1 || { tail -n 20 "$build/make.txt"; exit 1; }
status=0
TSAN_OPTIONS="halt_on_error=0 exitcode=66 ${TSAN_OPTIONS:-}" "$build/cross/test_threads" >"$build/tsan.txt" 2>&1 || status=$?
reports=$(grep -c 'WARNING: ThreadSanitizer' "$build/tsan.txt" || true)
grep '^ok\|^not ok' "$build/tsan.txt" || true
echo "$cc: $reports reports of races"
[ "$status" = 0 ] && [ "$reports" = 0 ] || { grep -v '^ok' "$build/tsan.txt" | head -n 60; exit 1; }
