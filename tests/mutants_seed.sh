#!/bin/sh
# mutants_seed.sh SEED COUNT: at least 95 % of COUNT errors, planted anywhere in runtime/, fail a test.
#
# SEED chooses the mutants in equal shares from arithmetic (+ - * /), comparisons (< <= > >= == != && ||), integers and
# indices (one more or one less) and the order of calls (two swapped, or one removed). The unit tests, the tests of
# memory and of GL, and the short form of golden.sh were run once with line counts. A mutant compiles one object and
# links the library; then the programs that run its line are run until one fails, those first that take least time for
# the lines that they run. It is killed by a failed test, a crash, or a program that takes five times its seconds of the
# processor. A mutant that does not compile, or compiles to the same object, is replaced by another. A line that no
# program runs is a survivor. Headers that more than 12 files include are left out, because a mutant there compiles them
# all (NOH_LONG=1: they are not).
#
# A mutant's place in the draw follows from the seed, its function and its line: an edit elsewhere draws the same
# mutants. What is killed is kept in NOH_BUILD/mutants_seed/judged until its file or the test that killed it changes, so
# that a run that was interrupted goes on, and after new tests only survivors are run again (to judge all: remove the
# file).
#
# tests/survivors.txt lists survivors that were looked at, with the reason: they are run with NOH_LONG=1 alone. Prints a
# table by room and operator, survivors, the largest functions that no test runs, and "N passed, N failed, N skipped".
# `make mutants-seed SEED=1 COUNT=200` builds what it needs, and runs it.
#
#   NOH_BUILD, NOH_ASSETS  as for tests/run.sh
#   JOBS                   copies of the tree used in parallel (default: number of processors)
#   SEEDED_*               how the library is compiled and linked as a shared object (tools/mk/mutants.mk sets them)
#   NOH_QUICK_S            seconds of programs for a mutant (of each, one more than it takes): a first look at survivors
#   NOH_TEST               only mutants of files whose path has one of these words in it: NOH_TEST='life/ springs'
#
#   mutants_seed.sh --lines NAME  runs a program with line counts and keeps which lines it runs (tools/mk/mutants.mk)
#
# Mutants are in copies of the tree in a temporary folder, which is always removed.
set -u
cd "$(dirname "$0")/.." || exit 1
. tests/support/mutants.sh
seeded=$PWD/$build/mutants_seed
work=$(mktemp -d "${TMPDIR:-/tmp}/noh_mutants.XXXXXX") || exit 1

# A program of the build in FOLDER with the library in LIBRARY, until one of its tests fails: then nobody reads what it
# prints next, which ends it. golden has no asserts: its hashes have to be as before.
play() { # FOLDER LIBRARY NAME SECONDS LOG
    set -- "$@" env -C "$1" LD_LIBRARY_PATH="$2" TMPDIR="$scratch" NOH_BUILD="$1/$build" NOH_EMBED="$1/$build/embed"
    folder=$1 name=$3 seconds=$4 log=$5
    binary=$seeded/tests/$name
    # A test that includes a file of the library was compiled with the mutant.
    [ "$2" = "$seeded/plain" ] || [ ! -x "$folder/programs/$name" ] || binary=$folder/programs/$name
    shift 5
    case $name in
    golden/*)
        limited "$seconds" "$@" "$binary" "$build/mask_levels.noh" "$build/demo/puppet_levels.noh" \
            "$build/demo/puppet.noh" >"$log" 2>&1 </dev/null &&
            limited "$seconds" "$@" "$binary" 300 1 "$build/demo/puppet.noh" >>"$log" 2>&1 </dev/null &&
            { [ ! -f "$seeded/map/golden.txt" ] || cmp -s "$log" "$seeded/map/golden.txt"; }
        ;;
    *)
        [ -p "$scratch/said" ] || mkfifo "$scratch/said"
        sed '/^not ok [0-9]* - /q' "$scratch/said" >"$log" &
        reader=$!
        limited "$seconds" "$@" "$binary" >"$scratch/said" 2>&1 </dev/null
        wait "$reader"
        return "$status"
        ;;
    esac
}

# ---- which lines a program runs ----

if [ "${1:-}" = --lines ]; then
    name=$2 out=$seeded/map/$2 scratch=$work/tmp
    mkdir "$scratch"
    case $name in golden/*) rm -f "$seeded/map/golden.txt" ;; esac
    export GCOV_PREFIX="$work/data"
    play "$tree" "$seeded/lines" "$name" 900 "$out.log"
    passed=$?
    times >"$work/times"
    seconds=$(awk -f tests/support/processor_seconds.awk "$work/times")
    if [ -n "$(find "$work/data" -name '*.gcda' ! -path "$work/data$seeded/*" -print -quit)" ]; then
        echo "mutants_seed.sh: $seeded/lines was built in another folder: remove it, then run this again"
        exit 1
    fi
    if [ $passed = 0 ]; then
        case $name in golden/*) cp "$out.log" "$seeded/map/golden.txt" ;; esac
        echo "$name $seconds" >"$work/lines"
        perl tests/support/mutants_seed.pl lines "$work/data" "$seeded/lines" >>"$work/lines" || exit 1
    else
        echo "$name fails" >"$work/lines"
    fi
    mv "$work/lines" "$out.lines"
    exit
fi

# ---- one mutant ----

# A program that passes in a copy, whatever the library, has there what it needs: its failure tells of the mutant. A note
# of it is kept until the program changes.
note_of() { # PROGRAM
    echo "$seeded/sound/$(echo "$1" | tr / _)"
}

# Fails if PROGRAM fails in the copy without a mutant, too: then it shows nothing.
is_sound() { # NUMBER PROGRAM SECONDS
    [ "$(note_of "$2")" -nt "$seeded/tests/$2" ] && return
    if play "$work/$1" "$seeded/plain" "$2" "$3" "$work/$1/log"; then
        : >"$(note_of "$2")"
    else
        echo "$2" >>"$work/unsound"
        return 1
    fi
}

# Compiles what the mutant changes and links the library. Fails if there is nothing to run; sets why.
make_library() { # NUMBER FILE
    copy=$work/$1
    case $2 in
    *.c) objects=$build/assert/${2%.c}.o ;;
    *) objects=$(grep -lrF --include='*.d' " $2" "$build/assert/runtime" | sed 's|\.d$|.o|') ;;
    esac
    rm -rf "$copy/$build/assert" "$copy/programs"
    same=y
    for object in $objects; do
        source=${object#"$build"/assert/}
        mkdir -p "$copy/$(dirname "$object")"
        # shellcheck disable=SC2086 # a command
        (cd "$copy" && $SEEDED_CC -w -c "${source%.o}.c" -o "$object") >"$copy/log" 2>&1 </dev/null ||
            { why='does not compile' && return 1; }
        objcopy --strip-debug "$object" "$copy/before.o" && objcopy --strip-debug "$copy/$object" "$copy/after.o" &&
            cmp -s "$copy/before.o" "$copy/after.o" || same=n
    done
    [ $same = n ] || { why='the same object' && return 1; }
    for object in $SEEDED_O; do
        [ ! -f "$copy/$object" ] || object=$copy/$object
        echo "$object"
    done >"$copy/list"
    mkdir -p "$copy/library"
    # shellcheck disable=SC2086 # a command
    $SEEDED_LD "@$copy/list" -o "$copy/library/libnoh.so" >"$copy/log" 2>&1 || { why='does not link' && return 1; }
}

# Tests that include a source file of the library have a copy of its code.
remake_tests() { # NUMBER FILE
    case $2 in *.h) return ;; esac
    for test in $(grep -lrF --include='test_*.c' "#include \"${2#runtime/}\"" tests/unit); do
        name=${test#tests/} name=${name%.c}
        mkdir -p "$work/$1/programs/$(dirname "$name")"
        # shellcheck disable=SC2086 # commands
        (cd "$work/$1" && $SEEDED_CC -w -Itests -Itests/support -c "$test" -o "programs/$name.o") >/dev/null 2>&1 &&
            $SEEDED_CXX "$work/$1/programs/$name.o" "$work/$1/library/libnoh.so" $SEEDED_LIBS \
                -o "$work/$1/programs/$name" >/dev/null 2>&1
        programs="$name:2 $programs"
    done
}

# Of the source of a test, which has killed a mutant until it changes.
sum_of() { # PROGRAM
    cksum <"tests/$1.c" | tr ' ' -
}

# Tries the mutant on a line of the plan; fails if it has to be replaced.
try() { # NUMBER LINE-OF-THE-PLAN
    IFS="$tab" read -r key operator file line _ _ _ change programs <<END
$(sed -n "$2p" "$work/plan")
END
    [ -n "$operator" ] || return 0
    [ "$programs" != - ] || programs=
    why='' killer=''
    before=$(grep "^$key$tab" "$seeded/judged" | tail -n 1 | cut -f2-)
    [ "$before" != replaced ] || return 1
    killed_by=${before%%"$tab"*}
    if [ -n "$before" ] && [ "$before" = "$killed_by$tab$(sum_of "$killed_by")" ]; then
        killer=$killed_by
    elif [ -n "${NOH_LONG:-}" ] || ! grep -qxF "$file: $change" tests/survivors.txt; then
        # shellcheck disable=SC2086 # words
        [ -z "$killed_by" ] || programs="$(printf '%s\n' $programs | grep "^$killed_by:") $programs"
        judge "$@"
        [ -z "$killer" ] || echo "$key$tab$killer$tab$(sum_of "$killer")" >>"$seeded/judged"
    fi
    [ -z "$why" ] || { echo "$key${tab}replaced" >>"$seeded/judged" && return 1; }
    [ -n "$killer$programs" ] || killer='?'
    printf '%s\t%s\t%s\t%s\t%s\n' "${killer:--}" "$operator" "$file" "$line" "$change"
}

# Sets killer, or why there is nothing to run.
judge() { # NUMBER LINE-OF-THE-PLAN
    perl tests/support/mutants_seed.pl plant "$work/plan" "$2" "$work/$1" || { why='no such place' && return; }
    if make_library "$1" "$file"; then
        remake_tests "$1" "$file"
        left=${NOH_QUICK_S:-100000}
        for program in $programs; do
            left=$((left - ${program#*:} - 1)) seconds=$((5 * ${program#*:} + 5)) program=${program%:*}
            [ $left -ge 0 ] || continue
            if play "$work/$1" "$work/$1/library" "$program" "$seconds" "$work/$1/log"; then
                : >"$(note_of "$program")"
                continue
            fi
            [ "$status" != 124 ] || continue # by the clock: that tells of a busy machine
            is_sound "$1" "$program" "$seconds" && killer=$program && break
        done
    fi
    cp -p "$file" "$work/$1/$file"
}

# ---- a copy of the tree, which takes every JOBS-th mutant ----

copy() { # FOLDER
    copy_sources "$1"
    mkdir -p "$1/$build/demo" "$1/tmp"
    cp -pR "$build/gen" "$build/embed" "$build/noh" "$build"/*.noh "$build"/*.glb "$1/$build/"
    cp -p "$build"/demo/*.noh "$build"/demo/*.glb "$1/$build/demo/"
}

mutants_of() { # NUMBER
    mutant=$1 scratch=$work/$1/tmp
    while [ "$mutant" -le "$count" ]; do
        place=$mutant
        until try "$1" "$place"; do
            place=$((place + count))
        done
        mutant=$((mutant + jobs))
    done
}

# ---- all ----

[ $# = 2 ] || { echo 'usage: mutants_seed.sh SEED COUNT'; exit 1; }
seed=$1 count=$2
[ -n "${SEEDED_CC:-}" ] && [ -f "$seeded/plain/libnoh.so" ] && [ -d "$seeded/map" ] ||
    { echo 'mutants_seed.sh: make mutants-seed builds what it needs'; exit 1; }
find runtime -name '*.[ch]' | sort >"$work/all"
[ -z "${NOH_LONG:-}" ] && most=12 || most=1000
find "$build/assert/runtime" -name '*.d' -exec cat {} + | tr ' ' '\n' | grep '^runtime/.*\.h$' | sort | uniq -c |
    awk -v most="$most" '$1 > most { print $2 }' >"$work/wide"
grep -vxFf "$work/wide" "$work/all" >"$work/files"
# shellcheck disable=SC2086 # words
printf '%s\n' ${NOH_TEST:-/} >"$work/words"
# shellcheck disable=SC2046 # file names
perl tests/support/mutants_seed.pl plan "$seeded/map" "$seed" $((8 * count)) \
    $(grep -Ff "$work/words" "$work/files") >"$work/plan" || exit 1

tell() { # A LINE OF A RESULT
    echo "$1" >>"$work/told"
    case $1 in [-?]"$tab"*) echo "$1" | awk -F "$tab" '{ print "survives: " $3 ":" $4 " " $5 }' ;; esac
}
: >>"$seeded/judged"
mkdir -p "$seeded/sound"
run_workers

{
    grep -h ' fails$' -r --include='*.lines' "$seeded/map" | sed 's/ fails$//'
    cat "$work/unsound" 2>/dev/null
} | sort -u | sed 's/$/ fails without a mutant: left out/'
# shellcheck disable=SC2046 # file names
perl tests/support/mutants_seed.pl uncovered "$seeded/map" 12 $(cat "$work/all")
awk -F "$tab" -f tests/support/mutants_seed.awk tests/survivors.txt "$work/told"
