#!/bin/sh
# mutants.sh: each test named for a technique in tests/README.md fails if the technique's error is in the code.
#
# A row of the tables names a mutant: tests/mutants/NAME.patch, an edit that puts the source's error into the code or,
# if the source has no error, breaks the technique. This script applies each mutant to a copy of the tree and builds the
# row's test there. The test must fail by one of its own assertions: a mutant that does not compile, crashes or takes
# too long proves nothing. Without the mutant, the same test must pass in the copy. Ends with "N passed, N failed, N
# skipped"; a test skipped for lack of a model or a driver skips its mutant.
#
#   NOH_BUILD   a build folder inside the tree (build); the tests are built there first
#   NOH_ASSETS  as for tests/run.sh
#   NOH_TEST    only rows whose mutant, test or code contains one of these words: NOH_TEST='ragdoll hair'
#   JOBS        copies of the tree used in parallel (default: number of processors)
#   NOH_LIMIT_S processor seconds of one process of a test (300)
#
# Copies are in NOH_BUILD/mutants and are always removed at the end. A mutant rebuilds only the objects that depend on
# it and one program, and runs one function of this program: other outputs are restored from NOH_BUILD, with their
# times.
set -u
cd "$(dirname "$0")/.." || exit 1

. tests/support/mutants.sh
limit=${NOH_LIMIT_S:-300}
work=$PWD/$build/mutants

# ---- one row ----

# Runs a row's test of the build in a folder and sets told: `passes`, `skips: REASON`, `fails`, or another result.
verdict() { # FOLDER PROGRAM FUNCTION LOG
    case $2 in *.sh) set -- "$1" "tests/$2" '.*' "$4" sh ;; *) set -- "$1" "$2" "$3" "$4" ;; esac
    # shellcheck disable=SC2086 # a word or none
    limited "$limit" env -C "$1" NOH_BUILD="$1/$build" NOH_EMBED="$1/$build/embed" NOH_FUNCTION="${3#.\*}" ${5:-} "$2" \
        >"$4" 2>&1 </dev/null
    status=$?
    if [ $status = 124 ] || [ $status = 137 ] || [ $status = 152 ]; then
        told="takes more than $limit s"
    elif grep -q 'exception: ' "$4"; then
        told=crashes
    elif grep -q "^not ok [0-9]* - $3\$" "$4"; then
        told=fails
    elif [ $status != 0 ]; then
        told="ends with $status"
    elif grep -q '^SKIP: ' "$4"; then
        told=$(sed -n 's/^SKIP: /skips: /p' "$4" | head -n 1)
    elif grep -q "^ok [0-9]* - $3\$" "$4"; then
        told=passes
    else
        told='runs no such test'
    fi
}

# The files that a patch edits.
edited() { # PATCH
    sed -n 's|^+++ b/||p' "$1"
}

goal() { # PROGRAM
    case $1 in *.sh) echo "$build/noh" ;; *) echo "$1" ;; esac
}

# Removes the mutant: restores the tree's sources and outputs, with their times.
restore() { # NUMBER PATCH
    for file in $(edited "$2"); do
        cp -p "$file" "$work/$1/$file"
    done
    (cd "$work/$1" && find "$build" -type f -newer "$work/$1.stamp") >"$work/$1.new"
    while read -r file; do
        case $file in
        *.[oad] | */gen/* | "$build"/noh) cp -p "$file" "$work/$1/$file" 2>/dev/null || rm -f "$work/$1/$file" ;;
        *) rm -f "$work/$1/$file" ;;
        esac
    done <"$work/$1.new"
}

# The test passes or is skipped in the copy without the mutant: the copy has everything that it needs.
unmutated() { # NUMBER PROGRAM FUNCTION
    key=$work/log/$1.$(echo "$2 $3" | tr ' /' __)
    [ -f "$key.told" ] && told=$(cat "$key.told") && return
    mkdir -p "$(dirname "$work/$1/$(goal "$2")")"
    cp -p "$tree/$(goal "$2")" "$work/$1/$(goal "$2")"
    verdict "$work/$1" "$2" "$3" "$key"
    echo "$told" >"$key.told"
}

one() { # NUMBER NAME PROGRAM FUNCTION
    copy=$work/$1 patch=tests/mutants/$2.patch log=$work/log/$2
    unmutated "$1" "$3" "$4"
    case $told in
    passes) ;;
    skips:*) echo "skip - $2 # SKIP${told#skips:}" && return ;;
    *) echo "not ok - $2: without it, $3 $4 $told" && tail -n 12 "$key" | sed 's/^/#   /' && return ;;
    esac
    touch "$copy.stamp"
    sleep 0.02 # what is written from here on is newer
    if ! patch -d "$copy" -p1 -F0 -s -t --no-backup-if-mismatch -r - <"$patch" >"$log" 2>&1; then
        told='does not apply'
    elif ! limited 900 make -C "$copy" -j1 --no-print-directory DEPS=0 WERROR= BUILD="$build" "$(goal "$3")" \
        >"$log" 2>&1 </dev/null; then
        told='does not compile'
    else
        verdict "$copy" "$3" "$4" "$log"
    fi
    restore "$1" "$patch"
    case $told in
    fails) echo "ok - $2" ;;
    passes) echo "not ok - $2: $3 $4 passes" ;;
    *) echo "not ok - $2: $told" && tail -n 12 "$log" | sed 's/^/#   /' ;;
    esac
}

# ---- a copy of the tree, which takes every JOBS-th row ----

copy() { # FOLDER
    copy_sources "$1"
    (cd "$build" && find . \( -path './mutants*' -o -path ./web -o -path ./tests/log -o -path ./angle \) -prune -o -type f \
        \( -name '*.[oad]' -o -path './gen/*' -o -name embed -o -name noh -o -name '*.noh' -o -name '*.glb' \) -print) |
        tar -C "$build" -cf - -T - | tar -C "$1/$build" -xf -
}

# Remains of a mutant in a copy would make other tests fail, so outputs and sources are restored from the tree.
is_clean() { # NUMBER
    {
        diff -rq "$work/$1/$build" "$tree/$build" | grep ' differ$'
        for file in $(for patch in tests/mutants/*.patch; do edited "$patch"; done | sort -u); do
            cmp "$work/$1/$file" "$tree/$file" 2>&1
        done
    } >"$work/log/left.$1"
    [ ! -s "$work/log/left.$1" ]
}

mutants_of() { # NUMBER
    awk -v n="$1" -v jobs="$jobs" 'NR % jobs == n % jobs' "$work/rows" >"$work/$1.rows"
    while IFS="$tab" read -r name program function; do
        one "$1" "$name" "$program" "$function"
    done <"$work/$1.rows"
    is_clean "$1" || { echo 'not ok - every edit is taken back' && sed 's/^/#   /' "$work/log/left.$1"; }
}

# ---- all ----

rm -rf "$work"
mkdir -p "$work/log" || exit 1

is_wanted() {
    [ -n "${NOH_TEST:-}" ] || return 0
    for word in $NOH_TEST; do
        case $1 in *"$word"*) return 0 ;; esac
    done
    return 1
}

awk -f tests/support/techniques.awk tests/README.md | while IFS="$tab" read -r code test mutant _; do
    is_wanted "$code $test $mutant" || continue
    [ -f "tests/mutants/$mutant.patch" ] || continue
    program=${test%% *} function=${test#* }
    case $program in
    *.sh) ;;
    *) program=$(find tests -name "$program.c" | head -n 1) program=$build/${program%.c} ;;
    esac
    echo "$mutant$tab$program$tab$function"
done >"$work/rows"
[ -s "$work/rows" ] || { echo "no mutant is named ${NOH_TEST:-}"; exit 1; }

# shellcheck disable=SC2046 # words
limited 7200 make -j"$jobs" --no-print-directory DEPS=0 BUILD="$build" "$build/noh" \
    $(cut -f2 "$work/rows" | grep -v '\.sh$' | sort -u) >"$work/make" 2>&1 </dev/null ||
    { tail -n 20 "$work/make"; echo 'the tests cannot be built'; exit 1; }

number=0 passed=0 failed=0 skipped=0
tell() { # A LINE OF A RESULT
    case $1 in
    'ok '*) passed=$((passed + 1)) ;;
    'not ok '*) failed=$((failed + 1)) ;;
    'skip '*) skipped=$((skipped + 1)) ;;
    *) echo "$1"; return ;;
    esac
    number=$((number + 1))
    case $1 in skip*) line="ok ${1#skip }" ;; *) line=$1 ;; esac
    echo "${line%%ok - *}ok $number - ${line#*ok - }"
}

run_workers
[ $((passed + skipped + failed)) -ge "$(wc -l <"$work/rows")" ] || failed=$((failed + 1))
echo "1..$number"
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed = 0 ] && [ $passed != 0 ]
