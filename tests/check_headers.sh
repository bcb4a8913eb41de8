#!/bin/sh
# check_headers.sh: what a program sees of the library: the headers in runtime/noh.
#   - they include each other and the compiler's own headers alone; without GL there are fewer
#   - noh.h declares at most 120 functions with what it includes of its own room
#   - base.h holds every limit
#   - each public header compiles alone, without a warning: C99, C11 and C++17, gcc and clang, for 32 bits too (NOH_LONG:
#     each compiler with each)
#   - noh_gl.h stands before, behind and between the headers of GL and of its loaders, in C and C++; no macro and no type of
#     GL's comes from it
#   - all functions that they declare link, from C and from C++
# NOH_HEADERS is where the folder noh lies: runtime, or PREFIX/include of an installed library.
. "$(dirname "$0")/cli/lib.sh"
if [ -n "${NOH_SAN:-}" ]; then
    skip 'headers' 'the build without sanitizers says it'
    finish
fi
headers=${NOH_HEADERS:-runtime}

# The headers that one reaches by #include "...", one a line.
reached() {
    echo "$1" >"$work/reached"
    while :; do
        before=$(wc -l <"$work/reached")
        while read -r header; do
            sed -n 's/^ *# *include *"\([^"]*\)".*/noh\/\1/p' "$headers/$header"
        done <"$work/reached" | cat "$work/reached" - | sort -u >"$work/more"
        mv "$work/more" "$work/reached"
        [ "$before" != "$(wc -l <"$work/reached")" ] || break
    done
    cat "$work/reached"
}
functions() { # HEADER: how many it declares itself
    printf '#include "%s"\n' "$1" | gcc -std=c99 "-I$headers" -fsyntax-only -aux-info /dev/stdout -x c - 2>/dev/null |
        grep -c "^/\* $headers/$1:[0-9]*:[A-Z]* \*/ .*[ *(]noh_[a-z0-9_]* ("
}

(cd "$headers" && find noh -name '*.h' | sort) >"$work/public"
reached noh/noh.h >"$work/plain"
echo "# $(wc -l <"$work/public") headers; noh.h reaches $(wc -l <"$work/plain")"
check 'the headers were read' test "$(wc -l <"$work/public")" -gt 10
check 'they are few' test "$(wc -l <"$work/public")" -le 24
while read -r header; do
    case $header in noh/noh_gl.h | noh/gl_device.h | noh/low_gl.h | noh/noh_low.h) continue ;; esac
    reached "$header" | grep -E '^noh/(noh_gl|gl_device|low_gl)\.h$' | sed "s|^|$header reaches |"
done <"$work/public" >"$work/reach_gl"
check 'only GL headers include GL headers' sh -c '! grep . "$1"' - "$work/reach_gl"
while read -r header; do
    grep -Hn '^ *# *include *<' "$headers/$header" | grep -v '<std\(int\|def\)\.h>'
    sed -n 's/^ *# *include *"\([^"]*\)".*/\1/p' "$headers/$header" | while read -r included; do
        [ -f "$headers/noh/$included" ] || echo "$header: $included"
    done
done <"$work/public" >"$work/foreign"
check 'they include each other, stddef.h and stdint.h' sh -c '! grep . "$1"' - "$work/foreign"
if command -v gcc >/dev/null 2>&1; then
    while read -r header; do
        echo "$(functions "$header") $header"
    done <"$work/public" >"$work/function_counts"
    sed 's/^/# functions: /' "$work/function_counts"
    check 'noh.h declares at most 120 functions' awk '$2 == "noh/noh.h" && $1 > 40 && $1 <= 120 { good = 1 } END { exit !good }' "$work/function_counts"
fi

# Each limit is defined once, in base.h; clips and time describe theirs.
while read -r header; do
    case $header in noh/base.h | noh/clip.h | noh/low_motion.h) continue ;; esac
    grep -Hn '^ *# *define NOH_[A-Z0-9_]*_\(MAX\|MIN\)\>' "$headers/$header"
done <"$work/public" >"$work/limits"
check 'base.h holds the limits' sh -c '! grep . "$1"' - "$work/limits"

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

# ---- other headers of GL ----

# NAME LANGUAGE FLAGS HEADER: a program that calls GL by that header, with noh_gl.h on each side of it. Warnings of the
# header itself are ignored.
with_header() {
    for order in before behind both; do
        {
            [ $order = behind ] || echo '#include "noh/noh_gl.h"'
            printf '#include %s\n' "$4"
            [ $order = before ] || echo '#include "noh/noh_gl.h"'
            echo 'static noh_gl_api table;'
            echo 'int main(void)'
            echo '{'
            echo '    unsigned name = 0;'
            echo '    GLuint same = name;'
            echo '    table.GenBuffers(1, &same);'
            echo '    glClear(GL_COLOR_BUFFER_BIT);'
            echo '    return table.GetError ? (int)table.GetError() : GL_NO_ERROR;'
            echo '}'
        } >"$work/order.$2"
        # shellcheck disable=SC2086
        check "$1, noh_gl.h $order, $3" "$(compiler_of "$2")" -x "$2" $3 -Wall -Wextra -Wpedantic -Werror "-I$headers" \
            -isystem "$work/glad/include" -isystem /usr/include/SDL2 -fsyntax-only "$work/order.$2"
    done
}
compiler_of() {
    if [ "$1" = c ]; then echo gcc; else echo g++; fi
}
in_orders() { # NAME HEADER FOUND
    if ! printf '#include %s\n' "$2" | gcc -isystem "$work/glad/include" -isystem /usr/include/SDL2 -E -x c - >/dev/null 2>&1; then
        skip "$1 and noh_gl.h" "$3 is not here"
        return
    fi
    with_header "$1" c -std=c99 "$2"
    with_header "$1" c++ -std=c++17 "$2"
}
if command -v glad >/dev/null 2>&1; then
    for api in gl:core=4.5 gles2=3.2; do
        glad --reproducible --quiet --out-path "$work/glad" --api $api c >/dev/null 2>&1
    done
fi
in_orders 'OpenGL ES 2' '<GLES2/gl2.h>' libgles-dev
in_orders 'OpenGL ES 3.0' '<GLES3/gl3.h>' libgles-dev
in_orders 'OpenGL ES 3.2' '<GLES3/gl32.h>' libgles-dev
in_orders 'desktop OpenGL' '<GL/gl.h>' libgl-dev
in_orders SDL '<SDL_opengl.h>' libsdl2-dev
in_orders 'SDL of OpenGL ES' '<SDL_opengles2.h>' libsdl2-dev
in_orders GLEW '<GL/glew.h>' libglew-dev
in_orders glad '<glad/gl.h>' python3-glad
in_orders 'glad of OpenGL ES' '<glad/gles2.h>' python3-glad

printf '#include "noh/noh_gl.h"\n' | gcc "-I$headers" -dM -E -x c - | grep -E '^#define (_*gl[a-z0-9]*_h_|GL_|GLAPI|APIENTRY|KHRONOS|gl[A-Z])' >"$work/macros"
check 'noh_gl.h defines no macro of GL'"'"'s' sh -c '! grep . "$1"' - "$work/macros"
printf '#include "noh/noh_gl.h"\ntypedef struct own { int own; } GLuint, GLenum, GLint, GLsizei, GLfloat, GLsync, GLboolean;\n' >"$work/own.c"
check 'and declares no type of GL'"'"'s' gcc "-I$headers" -fsyntax-only "$work/own.c"

# ---- functions ----

# Every function that is declared, by gcc's own list, in one table.
sed 's/.*/#include "&"/' "$work/public" >"$work/all_headers.h"
if ! gcc -std=c99 "-I$headers" -fsyntax-only -aux-info "$work/functions" -x c "$work/all_headers.h" 2>/dev/null; then
    skip 'functions link' 'gcc is not here'
    finish
fi
sed -n 's|^/\* \([^:]*\):[0-9]*:[A-Z]* \*/ extern .*[ *(]\(noh_[a-z0-9_]*\) (.*|\2|p' "$work/functions" | sort -u >"$work/names"
awk '$2 ~ /low_/ { low += $1; next } { stable += $1 } END { print "# public functions: " stable " stable, " low " of low_*.h" }' "$work/function_counts"
check 'the functions were read' test "$(wc -l <"$work/names")" -gt 200
{
    cat "$work/all_headers.h"
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
