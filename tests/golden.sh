#!/bin/sh
# golden.sh: the same ten seconds on every available compiler, optimisation and processor: tests/golden/golden.c prints
# hashes of states, callback keys, places, weights, joints, palettes, vertices and a crowd, which must equal
# tests/golden/golden.txt. Then a stage is played for five simulated minutes of random commands, and with NOH_LONG=1 for
# 24 hours with each of three seeds: equal hashes too, joints stay rotations, and in the end the stage does what a new
# one does.
#
#   golden.sh            all of them (`make golden`)
#   golden.sh short      what `make check` runs: gcc without and with optimisation; the long play with it only
#   golden.sh day        24 hours (NOH_DAY_S seconds) with each of three seeds on four processors: gcc's here, aarch64, armv7 and
#                        wasm; nothing else
#   golden.sh cross      the libraries that tests/cross.sh made for other processors, compared with gcc's here; the same
#   golden.sh update     write golden.txt again, after a change that is meant to change results (NOH_LONG=1: the rows of
#                        24 hours, too; without it they are left out)
#
# The table applies to packs with the checksums in it; if the demo's packs differ, builds are only compared with the
# first build, with a message. Prints TAP.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
work=$build/golden # not of a day, which takes hours
[ "${1:-}" != day ] || work=$build/golden_day
packs="$build/mask_levels.noh $build/demo/puppet_levels.noh $build/demo/puppet.noh"
table=tests/golden/golden.txt
sources="tests/golden/golden.c tools/noh/replay/session.c tools/noh/replay/session_input.c
    tools/noh/replay/session_stage.c tools/noh/replay/session_draw.c platform/file.c"
flags='-std=c99 -ffp-contract=off -fno-math-errno -DNOH_WITHOUT_GL -Iruntime -Iplatform -Itools -Itools/noh -w'
tests=0 failures=0
mkdir -p "$work"

report() { # ok|not ok, NAME
    tests=$((tests + 1))
    [ "$1" = ok ] || failures=$((failures + 1))
    echo "$1 $tests - $2"
}

has() { command -v "$1" >/dev/null 2>&1; }

# COMPILER-AND-FLAGS PROGRAM ARCHIVE: the library is compiled as one file, where there is no archive. Objects first,
# because emcc wants more tools to optimise while it links.
compile() {
    rm -rf "$work/objects"
    mkdir -p "$work/objects"
    # shellcheck disable=SC2086
    for source in $sources $([ -n "$3" ] || echo "$build/amalgam/noh.c"); do
        $1 $flags -c "$source" -o "$work/objects/$(basename "$source").o" || return
    done
    $1 -O0 "$work"/objects/*.o $3 -o "$2" -lm
}

# PROGRAM RUNNER: a long time of random commands. Prints nothing where only the first build plays it.
play_long() {
    case $how,$first in
    short,?* | cross,?*) return 0 ;;
    day,*) ${2:-} "$1" "${NOH_DAY_S:-86400}" 3 "$build/demo/puppet.noh"; return ;;
    esac
    ${2:-} "$1" 300 1 "$build/demo/puppet.noh" && { [ -z "${NOH_LONG:-}" ] || ${2:-} "$1" 86400 3 "$build/demo/puppet.noh"; }
}

# NAME COMPILER-AND-FLAGS [RUNNER [ARCHIVE]]: build, run, compare with the first.
variant() {
    if ! has "${2%% *}" || { [ -n "${3:-}" ] && ! has "${3%% *}"; }; then
        report ok "$1 # SKIP no ${2%% *}${3:+ or ${3%% *}} here"
        return
    fi
    # shellcheck disable=SC2086
    if ! printf '#include <errno.h>\n#include <stdlib.h>\n' | $2 -xc -fsyntax-only - 2>/dev/null; then
        report ok "$1 # SKIP no headers for $2 here"
        return
    fi
    # shellcheck disable=SC2086
    if ! compile "$2" "$work/$1" "${4:-}" >"$work/$1.log" 2>&1 || ! ${3:-} "$work/$1" $packs >"$work/$1.txt" 2>"$work/$1.err" ||
        ! play_long "$work/$1" "${3:-}" >"$work/$1.long" 2>>"$work/$1.err"; then
        report 'not ok' "$1"
        tail -n 5 "$work/$1.log" "$work/$1.err" 2>/dev/null | sed 's/^/# /'
        return
    fi
    if [ -z "$first" ]; then
        first=$1
        cat "$work/$1.txt" "$work/$1.long" >"$work/$1.all"
        report ok "$1: runs; the others are compared with it"
        return
    fi
    if cmp -s "$work/$first.txt" "$work/$1.txt" && { [ ! -s "$work/$1.long" ] || cmp -s "$work/$first.long" "$work/$1.long"; }; then
        report ok "$1: as $first"
    else
        report 'not ok' "$1: as $first"
        cat "$work/$1.txt" "$work/$1.long" | diff "$work/$first.all" - | head -n 8 | sed 's/^/# /'
    fi
}

# Lines of the table for the packs here must be equal.
against_table() {
    awk 'NR == FNR { known[$1 " " $2 " " $3] = $4; next }
        { key = $1 " " $2 " " $3
          if (!(key in known)) print "pack " $1 " " $2
          else if (known[key] != $4) print "differs " key }' "$table" "$work/$first.all" | sort -u >"$work/table.txt"
    if grep -q '^differs' "$work/table.txt"; then
        report 'not ok' "as $table"
        sed 's/^/# /' "$work/table.txt"
        echo "# if that is meant: tests/golden.sh update"
    elif grep -q '^pack' "$work/table.txt"; then
        report ok "as $table # SKIP $(sed -n 's/^pack \(.*\) .*/\1/p' "$work/table.txt" | tr '\n' ' ')came out with other bytes here"
    else
        report ok "as $table"
    fi
}

# TARGET: the library of tests/cross.sh for it.
archive() {
    [ "$how" != cross ] || ls "$build/$1/libnoh.a" 2>/dev/null
}

how=${1:-}
first=
[ "$how" != day ] || packs=
case $how in
short) made=$(ls "$build/amalgam/noh.o" 2>/dev/null) ;; # -O2, too
*) made=$(archive .) ;;
esac
variant gcc-O2 'gcc -O2' '' "$made"
if [ "${1:-}" = update ]; then
    [ $failures = 0 ] && cp "$work/gcc-O2.all" "$table" && echo "# $table is written"
    exit $failures
fi
[ "$how" = day ] || against_table
if [ "$how" != cross ] && [ "$how" != day ]; then
    variant gcc-O0 'gcc -O0'
fi
if [ -z "${1:-}" ]; then
    variant gcc-O3-native 'gcc -O3 -march=native'
    variant gcc-Os 'gcc -Os'
    variant gcc-i386-sse2 'gcc -m32 -msse2 -mfpmath=sse -O2'
    variant clang-O0 'clang -O0'
    variant clang-O2 'clang -O2'
    variant clang-O3-native 'clang -O3 -march=native'
fi
if [ "${1:-}" != short ]; then
    variant wasm.js 'emcc -O2 -s NODERAWFS=1 -s EXIT_RUNTIME=1 -s ALLOW_MEMORY_GROWTH=1 -s TOTAL_STACK=1MB' 'node --no-experimental-fetch' "$(archive wasm)"
    variant aarch64 'aarch64-linux-gnu-gcc -O2 -static' qemu-aarch64-static "$(archive aarch64)"
    variant armv7 'arm-linux-gnueabihf-gcc -O2 -mfpu=neon -static' qemu-arm-static "$(archive armv7)"
fi
echo "1..$tests"
exit $failures
