#!/bin/sh
# check_headers.sh: what a program sees of the library. Public is what noh.h and noh_gl.h reach.
#   - noh.h reaches no header of gl/ and includes no GL header; nothing private (*_internal.h) is reached
#   - limits.h holds every limit
#   - each public header compiles alone, without a warning: C99, C11 and C++17, gcc and clang, for 32 bits too (NOH_LONG:
#     each compiler with each)
#   - all functions that they declare link, from C and from C++
# NOH_HEADERS is where they lie: runtime, or PREFIX/include/noh of an installed library.
. "$(dirname "$0")/cli/lib.sh"
if [ -n "${NOH_SAN:-}" ]; then
    skip 'headers' 'the build without sanitizers says it'
    finish
fi
headers=${NOH_HEADERS:-runtime}

# The headers that these reach by #include "...", one a line.
reached() {
    printf '%s\n' "$@" >"$work/reached"
    while :; do
        before=$(wc -l <"$work/reached")
        while read -r header; do
            sed -n 's/^ *# *include *"\([^"]*\)".*/\1/p' "$headers/$header"
        done <"$work/reached" | cat "$work/reached" - | sort -u >"$work/more"
        mv "$work/more" "$work/reached"
        [ "$before" != "$(wc -l <"$work/reached")" ] || break
    done
    cat "$work/reached"
}

reached noh.h >"$work/plain"
reached noh_gl.h >"$work/public"
echo "# $(wc -l <"$work/plain") headers without GL, $(wc -l <"$work/public") in all"
check 'the headers were read' test "$(wc -l <"$work/plain")" -gt 40
check 'noh.h reaches nothing of gl/' sh -c '! grep "^gl/\|^noh_gl" "$1"' - "$work/plain"
while read -r header; do
    grep -Hn '^ *# *include *<\(GL\|EGL\)' "$headers/$header"
done <"$work/plain" >"$work/with_gl"
check 'noh.h includes no GL header' sh -c '! grep . "$1"' - "$work/with_gl"
check 'nothing private is reached' sh -c '! grep "_internal\.h" "$1"' - "$work/public"

# Each limit is defined once, in limits.h; clips and time describe theirs.
while read -r header; do
    case $header in */limits.h | */clip_format.h | */time.h) continue ;; esac
    grep -Hn '^ *# *define NOH_[A-Z0-9_]*_\(MAX\|MIN\)\>' "$headers/$header"
done <"$work/public" >"$work/limits"
check 'limits.h holds the limits' sh -c '! grep . "$1"' - "$work/limits"

# COMPILER... : every public header alone.
alone() {
    name=$*
    tool=$1
    case $tool in *++) language=c++ ;; *) language=c ;; esac
    if ! command -v "$tool" >/dev/null 2>&1 || ! echo '#include <stdint.h>' | "$@" -x $language -E - >/dev/null 2>&1; then
        skip "each header alone: $name" "$tool does not do that here"
        return
    fi
    : >"$work/failed"
    while read -r header; do
        printf '#include "%s"\nint noh_header_alone;\n' "$header" >"$work/alone.$language"
        "$@" -x $language -Wall -Wextra -Wpedantic -Werror -fsyntax-only "-I$headers" "$work/alone.$language" >"$work/said" 2>&1 ||
            { echo "$header:"; head -n 4 "$work/said"; } >>"$work/failed"
    done <"$work/public"
    check "each header alone: $name" sh -c '! grep . "$1"' - "$work/failed"
}
alone gcc -std=c99
alone clang -std=c11
for compiler in g++ clang++; do
    alone $compiler -std=c++17
done
alone gcc -std=c99 -m32
if [ -n "${NOH_LONG:-}" ]; then
    alone gcc -std=c11
    alone clang -std=c99
    alone g++ -std=c++17 -m32
fi

# Every function that is declared, by gcc's own list, in one table.
if ! printf '#include "noh_gl.h"\n' | gcc -std=c99 "-I$headers" -fsyntax-only -aux-info "$work/functions" -x c - 2>/dev/null; then
    skip 'functions link' 'gcc is not here'
    finish
fi
sed -n 's|^/\* \([^:]*\):[0-9]*:[A-Z]* \*/ extern .*[ *(]\(noh_[a-z0-9_]*\) (.*|\2|p' "$work/functions" | sort -u >"$work/names"
sed -n 's|^/\* \([^:]*\):[0-9]*:[A-Z]* \*/ .*[ *(]noh_[a-z0-9_]* (.*|\1|p' "$work/functions" | grep -v '^/usr' | sort | uniq -c >"$work/counts"
echo "# $(awk '{ n += $1 } END { print n }' "$work/counts") public functions, $(awk '!/\/gl\// { n += $1 } END { print n }' "$work/counts") of them without GL; $(wc -l <"$work/names") are linked"
check 'the functions were read' test "$(wc -l <"$work/names")" -gt 200
{
    echo '#include "noh_gl.h"'
    echo '#include <stdio.h>'
    echo 'typedef void (*function)(void);'
    echo 'static const function functions[] = {'
    sed 's/.*/    (function)&,/' "$work/names"
    cat <<'END'
};
int main(void)
{
    size_t there = 0;
    for (size_t i = 0; i < sizeof functions / sizeof functions[0]; i++) there += functions[i] != NULL;
    printf("%lu %s\n", (unsigned long)there, noh_version());
    return 0;
}
END
} >"$work/all.c"
links() { # NAME COMPILER...
    name=$1
    shift
    if ! command -v "$1" >/dev/null 2>&1; then
        skip "all functions link: $name" "no $1 here"
        return
    fi
    # shellcheck disable=SC2086
    check "all functions link: $name" sh -c '
        table=$1 library=$2 program=$3
        shift 3
        "$@" "$table" -x none "$library" -o "$program" 2>"$program.log" || { grep "undefined\|error" "$program.log" | head -n 10; exit 1; }
        "$program" | grep -q "^[0-9]* [0-9.]*$"' - "$work/all.c" "$build/libnoh.a" "$work/all" "$@" "-I$headers"
}
links 'gcc, C99' gcc -std=c99 -x c
links 'clang, C11' clang -std=c11 -x c
links 'gcc, C++17' g++ -std=c++17 -x c++
links 'clang, C++17' clang++ -std=c++17 -x c++
finish
