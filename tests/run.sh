#!/bin/sh
# run.sh: run every test and close with one line, "N passed, N failed, N skipped".
#
#   NOH_BUILD   where the programs are (build)
#   NOH_ASSETS  models that are not ours to ship; tests that want them skip without
#   NOH_ANGLE   where ANGLE's libraries are (NOH_BUILD/angle, where tools/angle.sh puts them)
#   NOH_SAN     the sanitizers that the build has, if any
#   NOH_TEST    only programs and scripts whose name holds this: NOH_TEST=morph
#   NOH_LIMIT_S seconds that one program may take (900)
#
# C programs are build/tests/{unit,memory,gl,fuzz}/test_*, scripts are tests/check_*.sh and
# tests/{cli,gl}/*.sh. All print TAP ("ok 1 - name", "not ok 2 - name", "ok 3 - name # SKIP
# reason", "1..3"); a program that tells less than it planned, or fails without saying, is
# counted as a failure.
set -u
cd "$(dirname "$0")/.." || exit 1

build=${NOH_BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
case ${NOH_ASSETS:-} in ''|/*) ;; *) NOH_ASSETS=$PWD/$NOH_ASSETS ;; esac
export NOH_BUILD="$build" NOH_ASSETS="${NOH_ASSETS:-}" NOH_SAN="${NOH_SAN:-}" CC="${CC:-gcc}" NOH_EMBED="$build/embed"
export CMOCKA_MESSAGE_OUTPUT=TAP
[ -n "${NOH_ANGLE:-}" ] || [ ! -f "$build/angle/libGLESv2.so" ] || export NOH_ANGLE="$build/angle"
logs=$build/tests/log
mkdir -p "$logs"

# Graphics drivers keep what they allocate until the process ends: suppressed by name, so that
# our own leaks still show. A failed allocation has to come back as NULL, as it does unsanitized.
export LSAN_OPTIONS="suppressions=$PWD/tests/leaks.supp:print_suppressions=0:${LSAN_OPTIONS:-}"
export ASAN_OPTIONS="allocator_may_return_null=1:${ASAN_OPTIONS:-}"
export UBSAN_OPTIONS="print_stacktrace=1:${UBSAN_OPTIONS:-}"
# The first GL error that a driver reports ends the program (tools/noh/gpu.c).
export NOH_GL_DEBUG=1

# Reads one program's output; prints "passed failed skipped" and a line for each skip.
count='
    /^1\.\.[0-9]+/ { planned += substr($1, 4); next }
    /^(SKIP|skipped): / { reason = $0; sub(/^[^:]*: /, "", reason); next }
    /^(not )?ok [0-9]+ .*# SKIP/ {
        skipped++
        name = $0
        sub(/^(not )?ok [0-9]+ (- )?/, "", name)
        sub(/ # SKIP.*/, "", name)
        sub(/^# SKIP /, "", name)
        if (reason == "" && $0 ~ / - .*# SKIP ./) { reason = $0; sub(/.*# SKIP /, "", reason) }
        sub("^" name ": ", "", reason)
        printf "S %s: %s\n", name, reason == "" ? "no reason given" : reason
        reason = ""
        next
    }
    /^ok [0-9]/     { passed++; next }
    /^not ok [0-9]/ { failed++; next }
    END {
        told = passed + failed + skipped
        if (!planned || told < planned) failed++          # it died before it was done
        else if (status != 0 && !failed) failed++         # it died after
        printf "C %d %d %d\n", passed, failed, skipped
    }'

passed=0 failed=0 skipped=0
all_skips=

run_one() {
    name=$1
    shift
    case $name in *"${NOH_TEST:-}"*) ;; *) return ;; esac
    log=$logs/$(echo "$name" | tr / _).txt
    timeout -k 10 "${NOH_LIMIT_S:-900}" "$@" >"$log" 2>&1 </dev/null
    status=$?
    told=$(awk -v status=$status "$count" "$log")
    set -- $(echo "$told" | sed -n 's/^C //p')
    passed=$((passed + $1)) failed=$((failed + $2)) skipped=$((skipped + $3))
    line="$1 passed"
    [ "$2" = 0 ] || line="$line, $2 FAILED"
    [ "$3" = 0 ] || line="$line, $3 skipped"
    printf '  %-28s %s\n' "$name" "$line"
    skips=$(echo "$told" | sed -n 's/^S //p')
    if [ -n "$skips" ]; then
        all_skips="$all_skips$(echo "$skips" | sed "s|^|  $name: |")
"
    fi
    if [ "$2" != 0 ]; then
        [ $status != 124 ] && [ $status != 137 ] || echo "    it took more than ${NOH_LIMIT_S:-900} s, or was killed"
        echo "    its output (exit code $status), all of it in $log:"
        grep -v '^ok ' "$log" | tail -n 60 | sed 's/^/    | /'
    fi
}

for source in tests/unit/test_*.c tests/memory/test_*.c tests/gl/test_*.c; do
    name=${source#tests/}
    run_one "${name%.c}" "$build/tests/${name%.c}"
done
for script in tests/check_*.sh tests/cli/*.sh tests/gl/*.sh tests/fuzz/*.sh; do
    [ -f "$script" ] || continue
    name=${script#tests/}
    case $name in */lib.sh) continue ;; esac
    run_one "${name%.sh}" sh "$script"
done

if [ -n "$all_skips" ]; then
    echo 'skipped, and why:'
    printf '%s' "$all_skips"
fi
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed = 0 ] && [ $passed != 0 ]
