#!/bin/sh
# check_table.sh: checks the table of techniques in tests/README.md: every file, test, mutant and verb exists, and every
# mutant still applies. `make mutants` (tests/mutants.sh) shows that the tests detect the mutants. A row is `| source |
# technique | code | test | mutant | command |`. Names in backquotes are checked:
#   code     a file
#   test     `test_NAME` `function`: a program's source below tests/ that lists this function; or a script, `DIR/NAME.sh`
#   mutant   `NAME`: tests/mutants/NAME.patch, which edits this code and no test; or the reason why there is none
#   command  `noh VERB [--OPTION [VALUE]]`: the verb has a help text with this option; or `make TARGET`
# A row with code "not yet" names no test, mutant or command.
set -u
. tests/cli/lib.sh
table=${1:-tests/README.md}

awk -f tests/support/techniques.awk "$table" >"$work/rows"

missing() {
    echo "$1 (row: $row)" >>"$work/missing"
}

has_test() { # PROGRAM FUNCTION
    source=$(find tests -name "$1.c" | head -n 1)
    if [ -z "$source" ]; then
        missing "no program $1"
    elif ! grep -q "^static void $2(void \*\*state)" "$source" || ! grep -q "cmocka_unit_test[a-z_]*($2\\b" "$source"; then
        missing "$source has no test $2"
    fi
}

has_command() {
    # shellcheck disable=SC2086 # words
    set -- $1
    case $1 in
    make) grep -q "^$2:" Makefile tools/mk/*.mk || missing "no target $2" ;;
    noh)
        "$build/noh" "$2" --help >"$work/verb" 2>/dev/null || missing "no verb $2"
        case ${3:-} in ''|[!-]*) ;; *) grep -q -e "$3\\b" "$work/verb" || missing "noh $2 has no $3" ;; esac ;;
    *) missing "a command that is neither noh nor make: $1" ;;
    esac
}

has_mutant() { # NAME CODE
    patch=tests/mutants/$1.patch
    [ -f "$patch" ] || { missing "no mutant $1"; return; }
    echo "$patch" >>"$work/patches"
    edited=$(sed -n 's|^+++ b/||p' "$patch")
    # shellcheck disable=SC2086,SC2116 # lines become words
    case " $(echo $edited) " in *" $2 "*) ;; *) missing "$patch does not edit $2" ;; esac
    case " $edited" in *[!a-z/]tests/*) missing "$patch edits a test" ;; esac
    patch -p1 -F0 -s -f --dry-run <"$patch" >/dev/null 2>&1 || missing "$patch does not apply any more"
}

tab=$(printf '\t')
: >"$work/missing"
: >"$work/patches"
built=0 unbuilt=0
while IFS="$tab" read -r code test mutant command row; do
    if [ "$code" = 'not yet' ]; then
        unbuilt=$((unbuilt + 1))
        [ "$test$mutant$command" = --- ] || missing 'not built, yet it has a test, a mutant or a command'
        continue
    fi
    built=$((built + 1))
    [ -f "$code" ] || missing "no file $code"
    case $mutant in 'none: '?*) ;; *) has_mutant "$mutant" "$code" ;; esac
    # shellcheck disable=SC2086 # words
    set -- $test
    case $#:${1:-} in
    2:test_*) has_test "$1" "$2" ;;
    1:*.sh) [ -f "tests/$1" ] || missing "no script tests/$1" ;;
    *) missing "not a test: $test" ;;
    esac
    [ "$command" = - ] || has_command "$command"
done <"$work/rows"

for patch in tests/mutants/*; do
    row=$patch
    case $(grep -cxF "$patch" "$work/patches") in 0) missing 'no row names it' ;; 1) ;; *) missing 'more than one row names it' ;; esac
done

echo "# $built techniques built, $unbuilt not yet"
sed 's/^/# /' "$work/missing"
check 'the table was read' test $((built + unbuilt)) -gt 100
check 'every file, test, mutant and verb of the table exists' test ! -s "$work/missing"
check 'no comment points at a row outside the repository' sh -c \
    '! grep -rnE "[Rr]ows? [A-E][0-9]" tests --include=*.c --include=*.h --include=*.sh --exclude=check_table.sh'
finish
