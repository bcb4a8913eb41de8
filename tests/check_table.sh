#!/bin/sh
# check_table.sh: the table of techniques in tests/README.md tells the truth: every file, test and verb in it exists.
# A row is `| source | technique | code | test | command |`. Names in backquotes are looked up:
#   code     a file
#   test     `test_NAME` `function`: a program's source below tests/ that lists this function; or a script, `DIR/NAME.sh`
#   command  `noh VERB [--OPTION [VALUE]]`: the verb has a help, and the option in it; or `make TARGET`
# A row whose code is "not yet" names neither a test nor a command.
set -u
. tests/cli/lib.sh
table=${1:-tests/README.md}

# The rows of tables with five columns, without head and rule: code, test and command, one a line, by tabs.
awk -F ' *[|] *' 'NF == 7 && $2 != "source" && $2 !~ /^-+$/ { print $4 "\t" $5 "\t" $6 "\t" $2 ": " $3 }' "$table" >"$work/rows"

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
    make) grep -q "^$2:" Makefile || missing "no target $2" ;;
    noh)
        "$build/noh" "$2" --help >"$work/verb" 2>/dev/null || missing "no verb $2"
        case ${3:-} in ''|[!-]*) ;; *) grep -q -e "$3\\b" "$work/verb" || missing "noh $2 has no $3" ;; esac ;;
    *) missing "a command that is neither noh nor make: $1" ;;
    esac
}

tab=$(printf '\t')
: >"$work/missing"
built=0 unbuilt=0
while IFS="$tab" read -r code test command row; do
    if [ "$code" = 'not yet' ]; then
        unbuilt=$((unbuilt + 1))
        [ "$test$command" = -- ] || missing 'not built, yet it has a test or a command'
        continue
    fi
    built=$((built + 1))
    for file in $(echo "$code" | tr -d '`'); do
        [ -f "$file" ] || missing "no file $file"
    done
    # shellcheck disable=SC2046 # words
    set -- $(echo "$test" | tr -d '`')
    case $#:${1:-} in
    2:test_*) has_test "$1" "$2" ;;
    1:*.sh) [ -f "tests/$1" ] || missing "no script tests/$1" ;;
    *) missing "not a test: $test" ;;
    esac
    [ "$command" = - ] || has_command "$(echo "$command" | tr -d '`')"
done <"$work/rows"

echo "# $built techniques built, $unbuilt not yet"
sed 's/^/# /' "$work/missing"
check 'the table was read' test $((built + unbuilt)) -gt 100
check 'every file, test and verb of the table exists' test ! -s "$work/missing"
check 'no comment points at a row outside the repository' sh -c \
    '! grep -rnE "[Rr]ows? [A-E][0-9]" tests --include=*.c --include=*.h --include=*.sh --exclude=check_table.sh'
finish
