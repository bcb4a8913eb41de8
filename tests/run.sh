#!/bin/sh
# run.sh: runs every test and ends with the line "N passed, N failed, N skipped".
#
#   NOH_BUILD   folder of the programs (build)
#   NOH_ASSETS  folder of models that may not be shipped; tests that need them are skipped without it
#   NOH_ANGLE   folder of ANGLE's libraries (NOH_BUILD/angle, filled by tools/angle.sh)
#   NOH_SAN     the sanitizers of the build, if any
#   NOH_TEST    only programs and scripts whose names contain this: NOH_TEST=morph
#   NOH_JOBS    programs run in parallel (default: number of processors); they share no output files
#   NOH_LONG    1: also long tests (make check-long)
#   NOH_LIMIT_S processor seconds of one process of a test (900; 1800 with sanitizers); the whole test may take four
#               times as long by the clock, so that a busy machine fails nothing
#
# C programs are build/tests/**/test_*, scripts are tests/check_*.sh and tests/*/*.sh. All print TAP ("ok 1 - name",
# "not ok 2 - name", "ok 3 - name # SKIP reason", "1..3"). A program that reports fewer results than planned, or exits
# with an error but reports no failure, counts as one failure.
set -u
cd "$(dirname "$0")/.." || exit 1

build=${NOH_BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
case ${NOH_ASSETS:-} in ''|/*) ;; *) NOH_ASSETS=$PWD/$NOH_ASSETS ;; esac
export NOH_BUILD="$build" NOH_ASSETS="${NOH_ASSETS:-}" NOH_SAN="${NOH_SAN:-}" CC="${CC:-gcc}" NOH_EMBED="$build/embed"
export CMOCKA_MESSAGE_OUTPUT=TAP
[ -n "${NOH_ANGLE:-}" ] || [ ! -f "$build/angle/libGLESv2.so" ] || export NOH_ANGLE="$build/angle"
logs=$build/tests/log
limit=${NOH_LIMIT_S:-$([ -n "$NOH_SAN" ] && echo 1800 || echo 900)}
jobs=${NOH_JOBS:-$(nproc 2>/dev/null || echo 2)}
mkdir -p "$logs"
# The reader's tests write hundreds of small files: use a memory file system, if there is one that allows programs to
# run.
if [ -z "${TMPDIR:-}" ] && [ -w /dev/shm ] && [ "$(df -Pk /dev/shm | awk 'NR == 2 { print $4 }')" -gt 1000000 ]; then
    try=/dev/shm/noh_try_$$
    printf '#!/bin/sh\n' >"$try" && chmod +x "$try" && "$try" 2>/dev/null && export TMPDIR=/dev/shm
    rm -f "$try"
fi

# Graphics drivers free some memory only when the process ends. Their leaks are suppressed by name, so that noh's leaks
# are still reported. A failed allocation returns NULL, as without sanitizers.
export LSAN_OPTIONS="suppressions=$PWD/tests/leaks.supp:print_suppressions=0:${LSAN_OPTIONS:-}"
export ASAN_OPTIONS="allocator_may_return_null=1:${ASAN_OPTIONS:-}"
export UBSAN_OPTIONS="print_stacktrace=1:${UBSAN_OPTIONS:-}"
# LLVM compiles the shaders of Mesa's software rasteriser in half the time without optimisation, and the pictures that tests
# draw are small. The bits are equal.
export GALLIVM_PERF="${GALLIVM_PERF-nopt}"
# The first GL error reported by a driver ends the program (tools/noh/gpu/gpu.c).
export NOH_GL_DEBUG=1

# Reads one program's output; prints its counts and a line for each skip.
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
        reported = passed + failed + skipped
        if (!planned || reported < planned) failed++      # it died before it was done
        else if (status != 0 && !failed) failed++         # it died after
        printf "C %d %d %d %d\n", passed, failed, skipped, seconds
    }'

# These start first if no times are known: they took longest.
long='check_install gl/verify gl/matrix gl/test_gl_load gl/view gl/view_figure gl/view_tools check_plain_c cli/crowd cli/examples
    cli/zoom cli/light cli/lighting unit/motion/test_clip_codec check_amalgam cli/strip cli/springs cli/wrinkles cli/graph cli/puppet
    unit/deform/test_bounds_pick cli/drop'
left_out_by_sanitizers() { # NAME
    [ -n "$NOH_SAN" ] && [ -z "${NOH_LONG:-}" ] || return 1
    case $1 in cli/* | gl/*) ! grep -qx -e "$1" tests/sanitized.txt ;; *) grep -qx -e "-$1" tests/sanitized.txt ;; esac
}

# ---- one program: run.sh --one NAME COMMAND..., called by the loop below ----

# Its log is NAME.txt; NAME.told has "C passed failed skipped seconds" (processor seconds) and an S line for each skip.
if [ "${1:-}" = --one ]; then
    name=$2
    shift 2
    log=$logs/$(echo "$name" | tr / _)
    left_out_by_sanitizers "$name" &&
        set -- printf 'ok 1 - %s # SKIP %s\n1..1\n' "$name" 'under sanitizers only in make check-long'
    # A pack that the script reads and nothing builds would be seen on a clean checkout alone.
    case ${2:-} in tests/*.sh)
        for file in $(grep -ohE '\$build/[a-z_/]+\.(noh|glb)' "$2" | grep -v none | sort -u); do
            [ -e "$build/${file#*/}" ] || set -- printf 'not ok 1 - %s: name it in TEST_PACKS (tools/mk/checks.mk)\n1..1\n' "$file"
        done ;;
    esac
    (ulimit -S -t "$limit" && exec timeout -k 10 "$((4 * limit))" "$@") >"$log.txt" 2>&1 </dev/null
    status=$?
    times >"$log.times" # not in a subshell: it counts the children of the shell that calls it
    seconds=$(awk -f tests/support/processor_seconds.awk "$log.times")
    awk -v status=$status -v seconds=$seconds "$count" "$log.txt" >"$log.told"
    echo $status >"$log.status"
    # shellcheck disable=SC2046
    set -- $(sed -n 's/^C //p' "$log.told")
    line="$1 passed"
    [ "$2" = 0 ] || line="$line, $2 FAILED"
    [ "$3" = 0 ] || line="$line, $3 skipped"
    [ $seconds -lt 10 ] || line="$line ($seconds s)"
    printf '  %-28s %s\n' "$name" "$line"
    exit 0
fi

# ---- all programs ----

# NAME and COMMAND of each, one per line; file names have no spaces.
programs() {
    find tests -name 'test_*.c' ! -path 'tests/cross/*' | sort | while read -r source; do
        name=${source#tests/}
        echo "${name%.c} $build/tests/${name%.c}"
    done
    for script in tests/check_*.sh tests/*/*.sh; do
        [ -f "$script" ] || continue
        name=${script#tests/}
        case $name in */lib.sh | web/* | support/*) continue ;; esac
        echo "${name%.sh} sh $script"
    done
}
# The slowest of the last run start first, then programs that have not run yet; the order only affects speed.
programs | while read -r name command; do
    case $name in *"${NOH_TEST:-}"*) ;; *) continue ;; esac
    log=$logs/$(echo "$name" | tr / _)
    seconds=$(sed -n 's/^C [0-9]* [0-9]* [0-9]* //p' "$log.told" 2>/dev/null)
    rm -f "$log.told" "$log.txt" "$log.times" "$log.status"
    [ -n "$seconds" ] || case " $(echo $long) " in *" $name "*) seconds=60 ;; esac
    echo "${seconds:-1} $name $command"
done | sort -s -k1,1nr | cut -d' ' -f2- >"$logs/programs"
[ -s "$logs/programs" ] || echo "no test is named ${NOH_TEST:-}"
xargs -r -P "$jobs" -L 1 sh tests/run.sh --one <"$logs/programs"

passed=0 failed=0 skipped=0
: >"$logs/skips" >"$logs/seconds"
while read -r name command; do
    log=$logs/$(echo "$name" | tr / _)
    # shellcheck disable=SC2046
    set -- $(sed -n 's/^C //p' "$log.told" 2>/dev/null)
    [ $# = 4 ] || set -- 0 1 0 0
    passed=$((passed + $1)) failed=$((failed + $2)) skipped=$((skipped + $3))
    sed -n "s|^S |  $name: |p" "$log.told" >>"$logs/skips"
    echo "$4 $name" >>"$logs/seconds"
    if [ "$2" != 0 ]; then
        status=$(cat "$log.status" 2>/dev/null)
        echo "$name FAILED (exit code ${status:-unknown}); the end of its output, which is in $log.txt:"
        case $status in
        124 | 137) echo "    it took more than $((4 * limit)) s by the clock, or was killed" ;;
        152) echo "    it took more than $limit s of the processor" ;;
        esac
        grep -v '^ok ' "$log.txt" | tail -n 60 | sed 's/^/    | /'
    fi
done <"$logs/programs"

if [ -s "$logs/skips" ]; then
    echo 'skipped, and why:'
    sort "$logs/skips"
fi
sort -rn "$logs/seconds" | awk -v most=12 -f tests/support/longest.awk
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed = 0 ] && [ $passed != 0 ]
