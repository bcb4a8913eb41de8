#!/bin/sh
# cross_tests.sh TARGET SOURCE...: the tests in tests/unit that run on another processor (tests/cross.sh), one a line.
#
# A test runs there if it links with these sources, which is read as a linker reads objects: a file needs the file that
# defines a function it calls. Tests that call C++, GL, the tool or another library do not link.
#
# Left out, too: tests of packs that `make check` makes (support/stage_fixture.h; tests/golden.sh compares bits of the
# same packs), programs with threads on wasm, and tests with one of these lines in the comment at their head:
#   cross: never, REASON
#   cross: long, REASON     unless NOH_LONG is set
#   cross: slow, REASON     on Windows, unless NOH_LONG is set: `make check` has x86
# On armv7 all tests need NOH_LONG: wasm runs the same plain C with 32 bits, and tests/golden.sh compares its bits.
set -eu
cd "$(dirname "$0")/.."
target=$1
shift
[ "$target" != armv7 ] || [ -n "${NOH_LONG:-}" ] || exit 0

tests=$(find tests/unit -name 'test_*.c' ! -path '*/tools/*' | sort | while read -r test; do
    mark=$(sed -n 's/^ \* cross: \([a-z]*\), .*/\1/p; /\*\//q' "$test")
    case $target,$mark in
    *,) ;;
    *,never) continue ;;
    *,long | windows,slow) [ -n "${NOH_LONG:-}" ] || continue ;;
    *,slow) ;;
    *) echo "$test: cross: $mark?" >&2; exit 1 ;;
    esac
    ! grep -q 'stage_fixture\.h"' "$test" || continue
    [ "$target" != wasm ] || ! grep -q '<pthread\.h>' "$test" || continue
    echo "$test"
done)

# shellcheck disable=SC2046,SC2086
awk -v foreign='^(stbi_|meshopt_|WebP|egl[A-Z]|gl[A-Z])' '
    FNR == 1 { comment = 0; if (part == "test") test[++tests] = FILENAME }
    {
        # without texts and comments
        gsub(/"([^"\\]|\\.)*"/, "")
        while (1) {
            if (comment) { if (!(end = index($0, "*/"))) { $0 = ""; break } $0 = " " substr($0, end + 2); comment = 0 }
            if (!(begin = index($0, "/*"))) break
            rest = substr($0, begin + 2)
            end = index(rest, "*/")
            $0 = substr($0, 1, begin - 1) (end ? " " substr(rest, end + 2) : "")
            comment = !end
        }
        if (match($0, /^[a-z_#].*[ *][a-z][A-Za-z0-9_]*\(/)) { # a function, or a macro
            name = $0
            sub(/\(.*/, "", name)
            sub(/.*[ *]/, "", name)
            if (part == "test" || /^(static|#)/ && FILENAME ~ /[.]c/) seen[FILENAME, name] = 1 # its own
            else if (!/;$/ && !(name in owner) && (/^(extern|static)/ || FILENAME ~ /[.]c$/)) {
                owner[name] = FILENAME
                outside[name] = part == "other" || FILENAME == "tests/cross/files.c" # those only fail
            }
        }
        while (match($0, /[A-Za-z_][A-Za-z0-9_]*\(/)) {
            name = substr($0, RSTART, RLENGTH - 1)
            $0 = substr($0, RSTART + RLENGTH)
            if (!seen[FILENAME, name]++) calls[FILENAME] = calls[FILENAME] " " name
        }
    }
    function links(test,  queue, count, needed, i, j, n, name) {
        queue[count = 1] = test
        for (i = 1; i <= count; i++) {
            n = split(calls[queue[i]], name, " ")
            for (j = 1; j <= n; j++)
                if (!(name[j] in owner)) { if (name[j] ~ foreign) return 0 }
                else if (outside[name[j]]) return 0
                else if (!needed[owner[name[j]]]++) queue[++count] = owner[name[j]]
        }
        return 1
    }
    END { for (i = 1; i <= tests; i++) if (links(test[i])) print test[i] }' \
    part=archive "$@" tests/support/*.h part=other tests/support/*.c $(find tools platform -name '*.c' -o -name '*.cpp') part=test $tests
