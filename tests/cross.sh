#!/bin/sh
# cross.sh: builds the library for other processors and systems without a warning, and runs the tests there that
# tests/cross_tests.sh lists: aarch64 (NEON) and armv7 (scalar; NOH_LONG) under qemu-user, wasm (scalar) under node,
# Windows under Wine. The library is -O2 everywhere (NOH_LONG: more levels, and x86 with i386, whose amalgam
# check_install.sh builds; warnings of clang, which is also emcc's, do not depend on the level). A target whose tools
# are missing is skipped and says why. Closes with "N passed, N failed, N skipped", as tests/run.sh does.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
passed=0 failed=0 skipped=0
# Encoding the large clips takes minutes under an emulator: the tests run on the clips that they make themselves.
NOH_ASSETS=none NOH_EMULATED=1 WINEDEBUG=-all
export NOH_ASSETS NOH_EMULATED WINEDEBUG

has() { # prints the first of these commands that is missing
    for tool in "$@"; do
        command -v "$tool" >/dev/null 2>&1 || { echo "no $tool here"; return 1; }
    done
}

# Adds up a test's TAP; a program that stops early has one failure.
count() { # NAME LOG EXIT_CODE
    right=$(grep -c '^ok ' "$2")
    left_out=$(grep -c '^ok .*# SKIP' "$2")
    wrong=$(grep -c '^not ok ' "$2")
    [ "$3" = 0 ] || [ "$wrong" != 0 ] || wrong=1
    grep -q "^1\.\.$((right + wrong))" "$2" || wrong=$((wrong + 1))
    passed=$((passed + right - left_out)) failed=$((failed + wrong)) skipped=$((skipped + left_out))
    if [ "$wrong" != 0 ]; then
        echo "    $1: $wrong FAILED, its output is in $2:"
        grep -v '^ok ' "$2" | tail -n 20 | sed 's/^/    | /'
    fi
}

# TARGET CC AR OPT...: the library without a warning; other flags find other ones.
at_levels() {
    at_name=$1 at_cc=$2 at_ar=$3
    shift 3
    for opt in "$@"; do
        at=$build/$at_name-lib$opt
        if make --no-print-directory -j"${JOBS:-2}" BUILD="$at" CC="$at_cc" AR="$at_ar" OPT="$opt" WERROR=-Werror LDFLAGS= CFLAGS= CPPFLAGS= \
            DEPS=0 lib >"$at.log" 2>&1; then
            passed=$((passed + 1))
        else
            failed=$((failed + 1))
            echo "    $at_name $opt: it does not build:"
            tail -n 20 "$at.log" | sed 's/^/    | /'
        fi
        rm -rf "$at"
    done
}

# CC AR: the library installs as what is built for another processor, without a C++ compiler.
installs() {
    if make --no-print-directory BUILD="$folder" CC="$1" AR="$2" LDFLAGS= CFLAGS= CPPFLAGS= CXX=false DEPS=0 PREFIX=/usr DESTDIR="$folder/installed" \
        install-lib >"$folder.install.log" 2>&1 && readelf -h "$folder/installed/usr/lib/libnoh.a" | grep -q 'Machine:.*ARM'; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "    $name: it does not install:"
        tail -n 20 "$folder.install.log" | sed 's/^/    | /'
    fi
    rm -rf "$folder/installed"
}

# RUNNER...: runs the programs of standard input.
run_all() {
    # shellcheck disable=SC2016
    xargs -P "${JOBS:-2}" -I '{}' sh -c \
        'test=$1; shift; (ulimit -S -t 900; exec timeout -k 5 3600 "$@" "$test") >"$test.tap" 2>&1 </dev/null; echo $? >"$test.code"; times >"$test.times"' sh '{}' "$@"
}

# TARGET CC AR CFLAGS LDFLAGS RUNNER...: builds the library and its tests, prints its size, runs each test.
target() {
    name=$1 cc=$2 ar=$3 cflags=$4 flags=$5
    shift 5
    folder=$build/$name
    echo "== $name"
    if ! why=$(has "${cc%% *}" "$ar" "$1"); then
        echo "    skipped: $why"
        skipped=$((skipped + 1))
        return
    fi
    if ! make --no-print-directory -j"${JOBS:-2}" BUILD="$folder" CC="$cc" AR="$ar" LDFLAGS="$flags" CFLAGS="$cflags" CXXFLAGS= CPPFLAGS= CROSS="$name" \
        WERROR=-Werror DEPS=0 lib cross-tests >"$folder.log" 2>&1; then
        failed=$((failed + 1))
        echo "    it does not build:"
        tail -n 20 "$folder.log" | sed 's/^/    | /'
        return
    fi
    passed=$((passed + 1))
    case $name in
    aarch64) [ -z "${NOH_LONG:-}" ] || at_levels "$name" "$cc" "$ar" -O0 -Os -O3 ;;
    armv7)
        [ -z "${NOH_LONG:-}" ] || at_levels "$name" "$cc" "$ar" -O0 -Os -O3
        installs "$cc" "$ar"
        ;;
    esac
    # Where multiply-add is fused by default: results would differ from other processors' results.
    if [ "$name" = aarch64 ]; then
        aarch64-linux-gnu-objdump -d "$folder/libnoh.a" >"$folder/code.txt"
        if grep -q '[[:space:]]fmul[[:space:]]' "$folder/code.txt" && ! grep '[[:space:]]\(fn\?m\(add\|sub\)\|fml[as]\)[[:space:]]' "$folder/code.txt"; then
            passed=$((passed + 1))
        else
            failed=$((failed + 1))
            echo '    it fuses multiplications and additions'
        fi
    fi
    if [ ! -s "$folder/cross/programs" ]; then
        if [ "$name" = armv7 ] && [ -z "${NOH_LONG:-}" ]; then
            echo "    libnoh.a builds ($(wc -c <"$folder/libnoh.a") bytes); NOH_LONG=1 runs its tests, and golden compares its bits"
        else
            failed=$((failed + 1))
            echo '    tests/cross_tests.sh lists no test for it'
        fi
        return
    fi
    before=$passed
    # Those that took long last time begin, as in tests/run.sh.
    tests=$(while read -r test; do
        echo "$(awk -f tests/support/processor_seconds.awk "$test.times" 2>/dev/null || echo 0) $test"
    done <"$folder/cross/programs" | sort -rn | cut -d' ' -f2)
    echo "$tests" | run_all "$@"
    # An emulator that crashes is no failure of a test: what stopped early, with no test failed, runs once more.
    stopped=$(for test in $tests; do
        [ "$(cat "$test.code")" = 0 ] || grep -q '^not ok ' "$test.tap" || echo "$test"
    done)
    if [ -n "$stopped" ]; then
        echo "    stopped early, run once more:" $stopped
        echo "$stopped" | run_all "$@"
    fi
    for test in $tests; do
        count "${test#"$folder"/cross/}" "$test.tap" "$(cat "$test.code")"
    done
    for test in $tests; do
        echo "$(awk -f tests/support/processor_seconds.awk "$test.times") ${test#"$folder"/cross/unit/}"
    done | sort -rn | awk -v most=6 -f tests/support/longest.awk | sed 's/^/    /'
    echo "    libnoh.a builds ($(wc -c <"$folder/libnoh.a") bytes), $((passed - before)) tests of $(wc -l <"$folder/cross/programs") programs passed there"
}

mkdir -p "$build"
# make check's is -O2.
if [ -n "${NOH_LONG:-}" ]; then
    echo '== x86'
    at_levels x86_64 gcc ar -O0 -Os -O3
    if echo '#include <stdint.h>' | gcc -m32 -E - >/dev/null 2>&1; then
        at_levels i386 'gcc -m32 -msse2 -mfpmath=sse' ar -O0 -Os -O2 -O3
    else
        echo '    skipped: no headers of 32 bits here (gcc-multilib)'
        skipped=$((skipped + 1))
    fi
fi
target aarch64 aarch64-linux-gnu-gcc aarch64-linux-gnu-ar '' -static qemu-aarch64-static
target armv7 'arm-linux-gnueabihf-gcc -mfpu=neon' arm-linux-gnueabihf-ar '' -static qemu-arm-static
# node's fetch does not read files, and emscripten's older loader asks it to
wasm_cc=emcc
! has emcc >/dev/null || ! sh tools/web_cc.sh "$build/wasm-cc" || wasm_cc=$build/wasm-cc
target wasm "$wasm_cc" emar '' '--pre-js tests/cross/environment.js -s NODERAWFS=1 -s EXIT_RUNTIME=1 -s ALLOW_MEMORY_GROWTH=1 -s TOTAL_STACK=1MB' node --no-experimental-fetch
# The tests' %zu is right there, and isfinite() of a double, but not to that compiler's warnings.
WINEPREFIX=$(cd "$build" && pwd)/wine
export WINEPREFIX
target windows x86_64-w64-mingw32-gcc x86_64-w64-mingw32-ar '-Wno-format -Wno-float-conversion' '-static -pthread' wine
! command -v wineserver >/dev/null 2>&1 || wineserver -k 2>/dev/null

# Ten seconds of the demo's packs, if `make check` has built them.
if [ -f "$build/demo/puppet_levels.noh" ] && [ -f "$build/demo/puppet.noh" ] && [ -f "$build/mask_levels.noh" ]; then
    echo '== golden'
    make --no-print-directory BUILD="$build" DEPS=0 lib >"$build/golden.log" 2>&1
    sh tests/golden.sh cross >"$build/golden.tap" 2>&1
    count golden "$build/golden.tap" $?
fi

echo "$passed passed, $failed failed, $skipped skipped"
[ $failed = 0 ] && [ $passed != 0 ]
