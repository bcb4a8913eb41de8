#!/bin/sh
# lint.sh: clang-tidy (.clang-tidy) and cppcheck over the C of runtime/, platform/ and tools/. `make lint` calls it.
#
# False positives are in accepted.txt, one a line: FILE CHECK REASON. A finding is fixed, or it gets a line there
# with the reason; what the list does not hold is a failure. Lines that no longer match anything are named, so that the
# list does not grow stale. With NOH_LONG set, the paths through what games link are followed too, by clang and by gcc
# -fanalyzer (make check-long). Closes with "N passed, N failed, N skipped": a file that a tool has nothing to say about is
# one passed.
set -u
cd "$(dirname "$0")/../.." || exit 1
build=${NOH_BUILD:-build}
work=$build/lint
accepted=tools/lint/accepted.txt
jobs=${JOBS:-$(nproc 2>/dev/null || echo 2)}
NOH_LONG=${NOH_LONG:-}
export NOH_LONG
mkdir -p "$work"
includes="-Iruntime -Iplatform -Itools -Itools/noh -Itools/demo_assets -I$build/gen"
# Not the page (emscripten's headers), the template for porters, and what a build without windows has instead of view/.
find runtime platform tools -name '*.c' ! -path 'platform/web/*' ! -name template.c ! -name view_without.c ! -path 'tools/examples/window/*' | sort >"$work/files"
if [ ! -f /usr/include/espeak-ng/speak_lib.h ]; then
    sed -i '/train_ear\/voices\.c$/d' "$work/files"
    echo 'without tools/train_ear/voices.c: no libespeak-ng-dev here'
fi
total=$(wc -l <"$work/files")
passed=0 failed=0 skipped=0

# FILE CHECK of each finding in "PATH:LINE:COLUMN: kind: text [check]" lines, without what is accepted.
findings() { # TOOL
    grep -E '^[^ ]*:[0-9]+:[0-9]+: [a-z]+: .*\[[-a-zA-Z.,]+\]$' "$work/$1.txt" | grep -v ': note: ' | sort -u |
        sed 's/,-warnings-as-errors\]$/]/' | while IFS= read -r line; do
        file=$(echo "${line%%:*}" | sed 's|.*/||')
        check=$(echo "$line" | sed 's/.*\[\([^]]*\)\]$/\1/')
        if grep -q "^$file $check " "$accepted"; then
            echo "$file $check " >>"$work/$1.used"
        else
            echo "$line"
        fi
    done
}

tell() { # TOOL
    : >"$work/$1.used"
    findings "$1" >"$work/$1.findings"
    found=$(wc -l <"$work/$1.findings")
    cat "$work/$1.findings"
    echo "$1: $total files, $(sort -u "$work/$1.used" | wc -l) accepted findings, $found others"
    failed=$((failed + found))
    passed=$((passed + total - $(cut -d: -f1 "$work/$1.findings" | sort -u | wc -l)))
}

if command -v clang-tidy >/dev/null 2>&1; then
    # A process for 16 files reads what they share once, in half the time of a process a file.
    tidy() { # CHECKS, for the files of standard input
        # shellcheck disable=SC2016
        xargs -r -P "$jobs" -n 16 sh -c '
            checks=$1 includes=$2
            shift 2
            clang-tidy --quiet "--checks=$checks" "$@" -- -std=c99 -Wall -Wextra $includes 2>/dev/null
            [ $? -lt 128 ] || echo "$1:1:1: error: clang-tidy crashed on this file, or on one of the next 15 [crash]"' sh "$1" "$includes"
    }
    # Clang's path analysis takes most of the time: it is for what games link, in the long form. tools/ has cppcheck's.
    {
        grep '^tools/' "$work/files" | tidy '-clang-analyzer-*'
        grep -v '^tools/' "$work/files" | tidy "$([ -n "$NOH_LONG" ] || echo '-clang-analyzer-*')"
    } >"$work/clang-tidy.txt"
    tell clang-tidy
else
    echo 'clang-tidy skipped: it is not installed'
    skipped=$((skipped + 1))
fi
if [ -n "$NOH_LONG" ]; then
    # Without its uninitialised values, which in gcc 12 are mostly arrays that loops and called functions fill.
    # shellcheck disable=SC2016
    grep '^runtime/' "$work/files" | grep -v '/result\.c$' | xargs -P "$jobs" -I '{}' sh -c '
        timeout 300 ${CC:-gcc} -std=c99 -O1 -ffp-contract=off -fno-math-errno $2 -include tools/lint/analyzer.h -fanalyzer \
            -Wno-analyzer-use-of-uninitialized-value -Wno-analyzer-too-complex -fdiagnostics-plain-output -c "$1" -o /dev/null 2>&1' \
        sh '{}' "$includes" >"$work/gcc-analyzer.txt"
    tell gcc-analyzer
fi
if command -v cppcheck >/dev/null 2>&1; then
    # Its uninitialised variables are arrays that a called function fills; the compilers and clang-tidy see those. Every
    # combination of #if is for the long form: it takes seven times as long as one.
    # shellcheck disable=SC2046,SC2086
    cppcheck -q -j "$jobs" $([ -n "$NOH_LONG" ] || echo --max-configs=1) --suppress=toomanyconfigs --std=c99 --enable=warning,performance,portability --suppress=missingIncludeSystem --suppress=uninitvar \
        --suppress=legacyUninitvar --suppress=uninitStructMember $includes \
        --template='{file}:{line}:{column}: {severity}: {message} [{id}]' --template-location= --file-list="$work/files" 2>"$work/cppcheck.txt" ||
        { tail -n 20 "$work/cppcheck.txt"; failed=$((failed + 1)); }
    tell cppcheck
else
    echo 'cppcheck skipped: it is not installed'
    skipped=$((skipped + 1))
fi

# The short form does not look for all of them.
[ -z "$NOH_LONG" ] || [ ! -f "$work/clang-tidy.used" ] || [ ! -f "$work/cppcheck.used" ] ||
    sed '/^#/d; /^$/d' "$accepted" | cut -d' ' -f1,2 | while read -r line; do
        cat "$work"/*.used | grep -q "^$line " || echo "no longer found, remove it from $accepted: $line"
    done
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed = 0 ]
