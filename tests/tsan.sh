#!/bin/sh
# tsan.sh [COMPILER...]: the library, tests/unit/motion/test_threads.c, tests/unit/stage/test_stage_threads.c and
# tests/unit/stage/test_crowd_threads.c built with ThreadSanitizer by clang (with NOH_LONG set, by gcc, too), and run:
# four threads pose the controllers of one clip bank, and run the jobs of one stage and of one crowd. Passes if every
# test passes and nothing is reported. A compiler that is missing, or whose ThreadSanitizer does not run here, is
# skipped. Ends like tests/run.sh.
#
# Asserts of both tiers are on. Built like the cross tests, without C++ and GL. The converter, which runs before any
# thread, comes from the build that made the packs.
set -u
cd "$(dirname "$0")/.." || exit 1
passed=0 failed=0 skipped=0

programs='motion/test_threads stage/test_stage_threads stage/test_crowd_threads'
packs=${NOH_BUILD:-build} # test_stage_threads reads mask_levels.noh and demo/puppet_levels.noh there
own="$(echo tests/cross/*.c) platform/file.c platform/file_write.c tests/support/support.c tests/support/support_model.c"
converter=$(find tools/convert -name '*.c' ! -name webp_file.c | sed "s|.*|$packs/&|; s|c\$|o|")

compiler() {
    cc=$1 build=${NOH_BUILD:-build}/tsan/$1
    mkdir -p "$build"
    echo 'int main(void) { return 0; }' >"$build/try.c"
    if ! "$cc" -fsanitize=thread "$build/try.c" -o "$build/try" >"$build/try.txt" 2>&1 || ! "$build/try" 2>>"$build/try.txt"; then
        echo "$cc skipped: it has no ThreadSanitizer that runs here"
        sed 's/^/    | /' "$build/try.txt" | tail -n 3
        skipped=$((skipped + 1))
        return
    fi
    # Optimised only a little: fewer accesses disappear before the sanitizer sees them.
    # shellcheck disable=SC2046 # words
    if ! make --no-print-directory -j"${JOBS:-2}" DEPS=0 CROSS=tsan SAN=thread BUILD="$build" CC="$cc" OPT='-O1 -g1 -DNOH_ASSERT_LEVEL=2' \
        CFLAGS= CPPFLAGS= LDFLAGS=-pthread CROSS_O="$(printf "$build/%s " $own | sed 's|\.c |.o |g')$(echo $converter)" \
        $(printf "$build/cross/unit/%s " $programs) >"$build/make.txt" 2>&1; then
        echo "$cc: it does not build"
        tail -n 20 "$build/make.txt" | sed 's/^/    | /'
        failed=$((failed + 1))
        return
    fi
    status=0
    for program in $programs; do
        NOH_BUILD=$packs TSAN_OPTIONS="halt_on_error=0 exitcode=66 ${TSAN_OPTIONS:-}" "$build/cross/unit/$program" || status=$?
    done >"$build/tsan.txt" 2>&1
    reports=$(grep -c 'WARNING: ThreadSanitizer' "$build/tsan.txt")
    right=$(grep -c '^ok ' "$build/tsan.txt") wrong=$(grep -c '^not ok ' "$build/tsan.txt")
    # It reported a race, stopped early, or ran no test.
    [ "$wrong" != 0 ] || { [ "$status$reports" = 00 ] && [ "$right" -gt 1 ]; } || wrong=1
    echo "$cc: $right tests passed, $wrong failed, $reports reports of races"
    [ "$wrong" = 0 ] || grep -v '^ok' "$build/tsan.txt" | head -n 60 | sed 's/^/    | /'
    passed=$((passed + right)) failed=$((failed + wrong))
}

# clang compiles in half of gcc's time
[ $# != 0 ] || if [ -z "${NOH_LONG:-}" ] && command -v clang >/dev/null 2>&1; then set -- clang; else set -- gcc clang; fi
for one in "$@"; do
    compiler "$one"
done
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed = 0 ]
