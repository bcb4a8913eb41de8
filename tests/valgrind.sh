#!/bin/sh
# valgrind.sh: the CPU tests of the library under memcheck, which finds what these sanitizers miss: uninitialised bits.
# Uses only packs and clips made by the tests. Ends like run.sh. Part of `make check-long`.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
jobs=${JOBS:-$(nproc 2>/dev/null || echo 2)}
work=$build/valgrind
if ! command -v valgrind >/dev/null 2>&1; then
    echo 'valgrind skipped: it is not installed'
    echo '0 passed, 0 failed, 1 skipped'
    exit 0
fi
rm -rf "$work"
mkdir -p "$work"
export NOH_ASSETS=none NOH_EMULATED=1 NOH_BUILD="$build" CMOCKA_MESSAGE_OUTPUT=TAP

# Excluded: tests that play or encode for minutes; test_root_motion, whose reference is long double, which has only 64
# bits in valgrind; and the bank's test_threads, which compares all bytes of a block with a copy, written or not.
find tests/unit -name 'test_*.c' ! -path 'tests/unit/tools/*' ! -path 'tests/unit/convert/*' | sort |
    grep -v -e test_crowd_long -e test_stage_day -e test_clip_codec -e test_clip_bounds -e test_clip_packs -e test_ear -e test_root_motion -e 'bank/test_threads' |
    sed 's|^tests/\(.*\)\.c$|\1|' >"$work/programs"
# shellcheck disable=SC2016
xargs -P "$jobs" -I '{}' sh -c '
    log=$1/$(echo "$2" | tr / _)
    (ulimit -S -t 1200 && exec timeout 4800 valgrind -q --error-exitcode=99 --leak-check=full --errors-for-leak-kinds=definite --child-silent-after-fork=yes --suppressions=tests/memcheck.supp \
        "$3/tests/$2") >"$log.tap" 2>"$log.txt" </dev/null
    echo $? >"$log.code"' sh "$work" '{}' "$build" <"$work/programs"

passed=0 failed=0 skipped=0
while read -r program; do
    log=$work/$(echo "$program" | tr / _)
    code=$(cat "$log.code")
    passed=$((passed + $(grep -c '^ok [0-9]* - [^#]*$' "$log.tap")))
    skipped=$((skipped + $(grep -c '^ok .*# SKIP' "$log.tap")))
    [ "$code" = 0 ] && continue
    failed=$((failed + 1))
    echo "$program: exit code $code"
    grep -v '^ok ' "$log.tap" | tail -n 5 | sed 's/^/    | /'
    grep -a '^==' "$log.txt" | head -n 25 | sed 's/^/    | /'
done <"$work/programs"
echo "$(wc -l <"$work/programs") programs"
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed = 0 ]
