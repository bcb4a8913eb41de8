#!/bin/sh
# check_install.sh: the library installed into a clean prefix.
#   - make install, install-lib (without a C++ compiler) and uninstall, DESTDIR, a moved prefix
#   - every header alone
#   - the README's program and the examples by pkg-config, by CMake and from the amalgam, as C99, C11 and C++17
#   - the size of the smallest program that morphs
#   - the user's flags are added to the library's required flags
. tests/cli/lib.sh
if [ -n "${NOH_SAN:-}" ]; then
    skip 'installing' 'checked in the build without sanitizers'
    finish
fi

has() {
    command -v "$1" >/dev/null 2>&1
}
make_noh() {
    make --no-print-directory BUILD="$build" DEPS=0 "$@" >"$work/made" 2>&1
}
installs() { # NAME ARGUMENTS
    installed=$1
    shift
    if make_noh "$@"; then ok "$installed"; else not_ok "$installed"; tail -n 20 "$work/made" | sed 's/^/#   /'; fi
}

# ---- install, move, uninstall ----

prefix=$work/prefix
installs 'make install-lib without a C++ compiler' install-lib PREFIX="$prefix" CXX=false
check 'the library alone: no program' test ! -e "$prefix/bin" -a -f "$prefix/lib/libnoh.a"
installs 'make install over it' install PREFIX="$prefix"
for file in bin/noh bin/noh-embed lib/libnoh.a lib/libnohconvert.a lib/pkgconfig/nohconvert.pc include/noh_convert.h lib/pkgconfig/noh.pc lib/cmake/noh/nohConfig.cmake lib/cmake/noh/nohConfigVersion.cmake \
    include/noh/noh.h share/noh/shaders/common_layers.glsl share/noh/examples/walker.c share/noh/platform/template.c share/noh/guide/index.md share/noh/guide/figures.md; do
    check "$file" test -s "$prefix/$file"
done
[ ! -f "$build/noh.1" ] || check 'the man page' test -s "$prefix/share/man/man1/noh.1"
[ ! -f tools/completion/noh.bash ] || check 'bash completion' test -s "$prefix/share/bash-completion/completions/noh"
(cd "$prefix/include" && find . -name '*.h') | sed 's|^\./||' | sort >"$work/headers"
{ (cd runtime && find noh -name '*.h') && echo noh_convert.h; } | sort >"$work/public"
check 'the public headers and no other' cmp "$work/public" "$work/headers"
# A folder of the source is share/noh/FOLDER there. A header that is named is public.
(cd "$prefix/include/noh" && grep -rhoE '\<(runtime|tools|tests|platform|shaders_es|core|motion|deform|life|stage|gl)/[A-Za-z0-9_./]*[A-Za-z0-9*_]' .) | sort -u >"$work/paths"
(cd "$prefix/include/noh" && grep -rhoE '\<[a-z0-9_]+\.(h|c)\>' .) | sort -u >"$work/files"
{
    while read -r path; do
        ls "$prefix/share/noh/"$(echo "$path" | sed 's|^shaders_es|shaders|') >/dev/null 2>&1 || echo "$path"
    done <"$work/paths"
    while read -r file; do
        [ -f "$prefix/include/noh/$file" ] || [ "$file" = stddef.h ] || [ "$file" = stdint.h ] || echo "$file"
    done <"$work/files"
} >"$work/nowhere"
check 'headers point to files that are installed' sh -c 'test -s "$1" && ! grep . "$2"' - "$work/files" "$work/nowhere"
for page in "$prefix"/share/noh/guide/*.md; do
    grep -o ']([^)]*)' "$page" | sed 's/^](//; s/)$//; s/#.*//' | grep -v '^https*:\|^$' | while read -r link; do
        [ -e "$prefix/share/noh/guide/$link" ] || echo "${page##*/}: $link"
    done
done >"$work/dead"
check 'no link of the guide is dead there' sh -c '! grep . "$1"' - "$work/dead"
check 'the template compiles there' gcc -std=c99 -fsyntax-only "-I$prefix/include" "$prefix/share/noh/platform/template.c"
version=$(sed -n 's/^#define NOH_VERSION "\(.*\)"/\1/p' runtime/noh/base.h)
(cd "$prefix" && find . -type f | sort) >"$work/before"
mv "$prefix" "$work/moved"
cp -r "$work/moved" "$prefix"

installs 'uninstall' uninstall PREFIX="$prefix"
check 'leaves nothing' test ! -e "$prefix"
mkdir -p "$prefix/lib" "$prefix/include/noh"
echo 'not ours' >"$prefix/include/noh/other.h"
installs 'install into folders that are there' install-lib PREFIX="$prefix"
installs 'and uninstall' uninstall PREFIX="$prefix"
(cd "$prefix" && find . | sort | tr '\n' ' ') >"$work/rest"
check 'leaves what is not ours' grep -qx '. ./include ./include/noh ./include/noh/other.h ./lib ' "$work/rest"
if make_noh uninstall PREFIX="$prefix"; then not_ok 'nothing to uninstall is an error'; else ok 'nothing to uninstall is an error'; fi
installs 'DESTDIR' install PREFIX=/opt/noh DESTDIR="$work/stage"
(cd "$work/stage/opt/noh" && find . -type f | sort) >"$work/staged"
check 'has the same files' cmp "$work/before" "$work/staged"
check 'and does not know it' sh -c '! grep -rq "$1" "$1/opt/noh/lib/pkgconfig" "$1/opt/noh/lib/cmake" "$1/opt/noh/share"' - "$work/stage"
installs 'uninstall with DESTDIR' uninstall PREFIX=/opt/noh DESTDIR="$work/stage"
check 'leaves nothing there' sh -c '! find "$1" -type f | grep .' - "$work/stage"
prefix=$work/moved

# ---- headers ----

# alone NAME COMPILER...: each header is a program
alone() {
    name=$1
    shift
    while read -r header; do
        printf '#include "%s"\nint main(void) { return 0; }\n' "$header" >"$work/alone.c"
        "$@" -Wall -Wextra -Wpedantic -Werror "-I$prefix/include" -fsyntax-only "$work/alone.c" || return 1
    done <"$work/headers" >"$work/err" 2>&1
}
headers() {
    if alone "$@"; then ok "each of $(wc -l <"$work/headers") headers alone: $1"; else not_ok "headers alone: $1"; head -n 10 "$work/err" | sed 's/^/#   /'; fi
}
# check_headers.sh tests other compilers.
headers 'gcc, C99' gcc -std=c99

# ---- programs ----

awk '/^```c$/ { inside = 1; next } /^```$/ { inside = 0 } inside' README.md >"$work/smile.c"
cp tools/examples/*.[ch] "$work"
programs=$(cd "$work" && ls ./*.c | sed 's|^\./||; s|\.c$||' | grep -v '^alone$')
libraries() { # PROGRAM: a program that makes its own context links EGL
    sed -n 's|^ *# *include <EGL/.*|-lEGL|p; s|^ *# *include "start.h".*|-lEGL|p' "$work/$1.c" | head -n 1
    ! grep -q '"measure.h"' "$work/$1.c" || echo -Wl,--wrap=malloc,--wrap=calloc,--wrap=realloc
}
is_c_alone() { # PROGRAM: it has designated initialisers of C99
    grep -q '"start.h"' "$work/$1.c"
}
# The same lines with every compiler, language and way to build. A program that draws runs once: rasterising takes most
# of its time, and it is the same library that draws.
runs() { # WHAT PROGRAM EXECUTABLE
    [ ! -f "$work/$2.told" ] || [ -z "$(libraries "$2")" ] || return 0
    (cd "$work" && "$3" "$build/mask.noh" >told.txt 2>&1; echo "exit code $?" >>told.txt)
    if [ ! -f "$work/$2.told" ]; then
        check "$1: $2 ends by itself" grep -q '^exit code [0-2]$' "$work/told.txt"
        cp "$work/told.txt" "$work/$2.told"
    fi
    check "$1: $2 runs and prints the same" cmp "$work/$2.told" "$work/told.txt"
}
by_pkg_config() { # NAME COMPILER...
    name=$1
    shift
    for program in $programs; do
        [ "$language" = c ] || ! is_c_alone "$program" || continue
        # shellcheck disable=SC2046
        check "pkg-config, $name: $program builds" "$@" -x "$language" "$work/$program.c" -x none -o "$work/program" \
            $(PKG_CONFIG_PATH="$prefix/lib/pkgconfig" pkg-config --define-variable=prefix="$prefix" --cflags --libs noh) $(libraries "$program") -lm
        runs "pkg-config, $name" "$program" "$work/program"
    done
}
if has pkg-config; then
    check 'pkg-config says the version' test "$(PKG_CONFIG_PATH="$prefix/lib/pkgconfig" pkg-config --modversion noh)" = "$version"
    language=c
    by_pkg_config 'gcc, C99' gcc -std=gnu99 -O2
    ! has clang || by_pkg_config 'clang, C11' clang -std=gnu11 -O1
    language=c++
    ! has g++ || by_pkg_config 'g++, C++17' g++ -std=gnu++17 -O1
else
    skip 'pkg-config' 'no pkg-config here'
fi
check 'the README'"'"'s program does what it says' grep -q 'vertex 0 smiles' "$work/smile.told"

if has cmake; then
    # One project builds the programs: CMake's look at the compilers takes longer than they do. Its package gives each the
    # same flags, and pkg-config's built them all.
    programs='smile walker_cpu walker'
    mkdir "$work/cmake" "$work/cmake_new"
    cp "$work"/*.h "$work/cmake"
    {
        cat <<END
cmake_minimum_required(VERSION 3.13)
project(user C CXX)
find_package(noh ${version%.*} REQUIRED)
if(NOT EXISTS "\${noh_SHADERS_DIR}/common_layers.glsl")
    message(FATAL_ERROR "no shaders in \${noh_SHADERS_DIR}")
endif()
END
        for program in $programs; do
            languages='C CXX'
            ! is_c_alone "$program" || languages=C
            for language in $languages; do
                case $language in C) file=$program.c standard=99 ;; *) file=$program.cpp standard=17 ;; esac
                cp "$work/$program.c" "$work/cmake/$file"
                echo "add_executable(${program}_$language $file)"
                echo "set_target_properties(${program}_$language PROPERTIES ${language}_STANDARD $standard)"
                echo "target_link_libraries(${program}_$language noh::noh m $(libraries "$program" | tr '\n' ' '))"
            done
        done
    } >"$work/cmake/CMakeLists.txt"
    check 'CMake: the programs build' sh -c 'cmake -S "$1" -B "$1/build" -DCMAKE_PREFIX_PATH="$2" && cmake --build "$1/build" -j2' - "$work/cmake" "$prefix"
    for program in $programs; do
        runs 'CMake, C99' "$program" "$work/cmake/build/${program}_C"
        is_c_alone "$program" || runs 'CMake, C++17' "$program" "$work/cmake/build/${program}_CXX"
    done
    # By its version alone: no compiler.
    printf 'cmake_minimum_required(VERSION 3.13)\nproject(user NONE)\nfind_package(noh 99.0 REQUIRED)\n' >"$work/cmake_new/CMakeLists.txt"
    check 'CMake: another version is refused' sh -c '! cmake -S "$1" -B "$1/build" -DCMAKE_PREFIX_PATH="$2" >"$1/said" 2>&1 && grep -q "not accepted" "$1/said"' - "$work/cmake_new" "$prefix"

    # Packs: noh_add_pack of the installed tool.
    mkdir "$work/packs"
    printf '\000\000\200\077%032d' 0 | tr 0 '\000' >"$work/packs/a b.bin"
    cat >"$work/packs/a.gltf" <<END
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"buffers":[{"uri":"a%20b.bin","byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]}
END
    sed 's/a%20b/b/' "$work/packs/a.gltf" >"$work/packs/b.gltf"
    cp "$work/packs/a b.bin" "$work/packs/b.bin"
    echo 'aa smile' >"$work/packs/face.recipe"
    cat >"$work/packs/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.20)
project(packs NONE)
find_package(noh ${version%.*} REQUIRED)
noh_add_pack(first SOURCES a.gltf OPTIONS --recipe \${CMAKE_CURRENT_SOURCE_DIR}/face.recipe)
noh_add_pack(second SOURCES b.gltf OUTPUT "data/the second.noh")
END
    built() { # NAME EXPECTED: which packs the build makes again, by their folder's names
        touch "$work/packs/mark"
        sleep 1.1
        [ -z "$3" ] || touch "$work/packs/$3"
        cmake --build "$work/packs/build" >"$work/made" 2>&1 || { not_ok "$1"; tail -n 20 "$work/made" | sed 's/^/#   /'; return; }
        check "$1" test "$(cd "$work/packs/build" && find . -name '*.noh' -newer ../mark | sort | tr '\n' ' ')" = "$2"
    }
    for generator in Ninja 'Unix Makefiles'; do
        if [ "$generator" = Ninja ] && ! has ninja; then
            skip 'noh_add_pack, Ninja' 'no ninja here'
            continue
        fi
        rm -rf "$work/packs/build"
        check "noh_add_pack, $generator: configures" cmake -G "$generator" -S "$work/packs" -B "$work/packs/build" "-DCMAKE_PREFIX_PATH=$prefix"
        built "noh_add_pack, $generator: two packs" './data/the second.noh ./first.noh ' ''
        built "noh_add_pack, $generator: nothing to do" '' ''
        built "noh_add_pack, $generator: a .bin" './first.noh ' 'a b.bin'
        built "noh_add_pack, $generator: a text" './first.noh ' face.recipe
        built "noh_add_pack, $generator: a model" './data/the second.noh ' b.gltf
        built "noh_add_pack, $generator: nothing to do then" '' ''
    done
    printf 'noh_add_pack(third OUTPUT x.noh)\n' >>"$work/packs/CMakeLists.txt"
    check 'noh_add_pack without sources is an error' sh -c '! cmake -S "$1" -B "$1/build" 2>"$1/said" && grep -q "noh_add_pack(NAME SOURCES" "$1/said"' - "$work/packs"

    # From source, inside a game's own build: with the flags that make gives, which are seen in its commands. make
    # compiled each file with them, so the object is taken from there, and the preprocessor finds the headers by CMake's
    # flags.
    export sources_of="$PWD" objects_of="$(cd "$build" && pwd)"
    cat >"$work/quickly" <<'END'
#!/bin/sh
source= object= before=
for word in "$@"; do
    case $before in -o) object=$word ;; -c) source=$word ;; esac
    before=$word
done
file=${source#"$sources_of"/}
case $file in
runtime/*.c) ;;
*) exec "$@" ;;
esac
for word in "$@"; do
    shift
    case $word in -o | -c | "$object") ;; *) set -- "$@" "$word" ;; esac
done
"$@" -E -o /dev/null && cp "$objects_of/${file%.c}.o" "$object"
END
    chmod +x "$work/quickly"
    find runtime -name '*.c' | sort >"$work/sources"
    from_source() { # WHAT FOLDER LINES OPTIONS...
        what=$1 folder=$work/$2
        mkdir "$folder"
        cp "$work/smile.c" "$folder"
        printf 'cmake_minimum_required(VERSION 3.18)\nproject(game C)\n%s\nadd_executable(smile smile.c)\ntarget_link_libraries(smile noh::noh)\n' \
            "$3" >"$folder/CMakeLists.txt"
        shift 3
        check "CMake from source: $what configures" cmake -S "$folder" -B "$folder/build" \
            -DCMAKE_EXPORT_COMPILE_COMMANDS=ON "-DCMAKE_C_COMPILER_LAUNCHER=$work/quickly" "$@"
        sed -n 's|^ *"command": "\(.*\)",*$|\1|p' "$folder/build/compile_commands.json" | grep -F " $PWD/runtime/" >"$work/commands"
        sed "s|.* $PWD/\(runtime/[^ ]*\).*|\1|" "$work/commands" | sort | comm -13 - "$work/sources" >"$work/absent"
        check "CMake from source, $what: all flags for each file" sh -c '
            for flag in -O2 -std=c99 -ffp-contract=off -fno-math-errno -ffunction-sections -fdata-sections; do
                ! grep -v -e " $flag " "$1" || exit 1
            done
            ! grep -e " -D" "$1"' - "$work/commands"
    }
    builds() { # WHAT FOLDER
        check "CMake from source: $1 builds" cmake --build "$work/$2/build" -j2
        runs "CMake from source, $1" smile "$work/$2/build/smile"
    }
    from_source 'add_subdirectory' cmake_subdirectory "add_subdirectory($PWD/runtime noh)" -DNOH_INSTALL=ON
    check 'CMake from source: every file' cmp /dev/null "$work/absent"
    builds 'add_subdirectory' cmake_subdirectory
    # What a package manager's port and recipe do: install; then a game finds the package.
    mkdir "$work/cmake_package"
    cat >"$work/cmake_package/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.13)
project(game C)
find_package(noh $version REQUIRED)
add_executable(game game.c)
target_link_libraries(game noh::noh)
END
    cat >"$work/cmake_package/game.c" <<END
#include <string.h>
#include <noh/base.h>
int main(void) { return strcmp(noh_version(), NOH_VERSION); }
END
    check 'CMake from source: installs' cmake --install "$work/cmake_subdirectory/build" --prefix "$work/cmake_installed"
    check 'CMake from source: a game finds it and runs' sh -c \
        'cmake -S "$1" -B "$1/build" -DCMAKE_PREFIX_PATH="$2" && cmake --build "$1/build" && "$1/build/game"' - "$work/cmake_package" "$work/cmake_installed"
    from_source 'FetchContent, without GL' cmake_fetch "include(FetchContent)
FetchContent_Declare(noh SOURCE_DIR $PWD SOURCE_SUBDIR runtime)
FetchContent_MakeAvailable(noh)" -DNOH_GL=OFF
    check 'CMake from source: without what draws alone' sh -c 'test -s "$1" && ! grep -v "^runtime/gl/" "$1"' - "$work/absent"
    # Files of gl/ that stay compile without the shaders.
    grep -F " $PWD/runtime/gl/" "$work/commands" | sed 's/$/ -fsyntax-only/' >"$work/beside"
    check 'CMake from source: without GL, files of gl/ compile' sh -c 'test -s "$1" && sh -e "$1"' - "$work/beside"
    [ -z "${NOH_LONG:-}" ] || builds 'FetchContent, without GL' cmake_fetch
else
    skip 'CMake' 'no cmake here'
fi

# ---- 32 bits ----

echo '#include <stdio.h>
int main(void) { return 0; }' >"$work/alone.c"
if gcc -m32 "$work/alone.c" -o "$work/alone32" >/dev/null 2>&1; then
    check '-m32: the amalgam builds' gcc -m32 -msse2 -mfpmath=sse -std=c99 -O0 -ffp-contract=off -fno-math-errno -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wvla -Werror \
        -Wno-misleading-indentation -c "$build/amalgam/noh.c" -o "$work/noh32.o"
    check '-m32: the program links, without libm' gcc -m32 -std=gnu99 -O2 "-I$build/amalgam" "$work/smile.c" "$work/noh32.o" -o "$work/smile32"
    if "$work/alone32" 2>/dev/null; then runs '-m32' smile "$work/smile32"; else skip '-m32: the program runs' 'no 32-bit programs run here'; fi
else
    skip '-m32' 'no 32-bit C library here (gcc-multilib)'
fi

# ---- the size in a program ----

readelf -sW "$prefix/lib/libnoh.a" | awk '$7 == "UND" && $8 != "" { print $8 }' | sort -u >"$work/asked"
readelf -sW "$prefix/lib/libnoh.a" | awk '$7 != "UND" && $5 == "GLOBAL" { print $8 }' | sort -u >"$work/given"
comm -23 "$work/asked" "$work/given" | tr '\n' ' ' >"$work/undefined"
check 'the installed library asks for memcmp, memcpy and memset only' grep -qx '\(_GLOBAL_OFFSET_TABLE_ \)\?memcmp memcpy memset ' "$work/undefined"

# The library's code and constants linked into the README's program, which opens a pack and morphs.
largest=32768
gcc -std=gnu99 -O2 "$work/smile.c" "-I$prefix/include" "-L$prefix/lib" -lnoh -Wl,--gc-sections -Wl,-Map="$work/map" -o "$work/smallest"
bytes=$(nm -S -t d "$work/smallest" | awk '$3 ~ /^[tTrRdD]$/ && $4 != "main" && $4 !~ /^_/ { sum += $2 } END { print sum + 0 }')
whole=$(size "$build/libnoh.a" | awk 'NR > 1 { sum += $1 + $2 } END { print sum }')
echo "# the smallest program that morphs takes $bytes bytes of the library's $whole"
check "the smallest program that morphs takes at most $largest bytes" test "$bytes" -gt 4096 -a "$bytes" -le $largest
gcc -std=gnu99 -O2 "$work/smile.c" "-I$build/amalgam" "$build/amalgam/noh.o" \
    -Wl,--gc-sections -o "$work/smallest" && bytes=$(nm -S -t d "$work/smallest" | awk '$3 ~ /^[tTrRdD]$/ && $4 != "main" && $4 !~ /^_/ { sum += $2 } END { print sum + 0 }')
echo "# from the amalgam: $bytes bytes"
# as one source it is inlined more
check 'and hardly more from the amalgam' test "$bytes" -gt 4096 -a "$bytes" -le $((largest + 1024))

# ---- the user's flags ----

make --no-print-directory -B -n BUILD="$work/flags" DEPS=0 V=1 lib CFLAGS=-Os CXXFLAGS=-Os LDFLAGS=-s CPPFLAGS=-DX OPT=-O1 2>/dev/null |
    grep ' -c runtime/' >"$work/commands"
check 'CFLAGS=-Os is appended' sh -c 'grep -q . "$1" && ! grep -v -- "-std=c99.*-ffp-contract=off.* -DX -Os" "$1"' - "$work/commands"
check 'and OPT is replaced' sh -c '! grep -e "-O2" "$1"' - "$work/commands"
env -u WERROR -u MAKEFLAGS make --no-print-directory -B -n BUILD="$work/flags" DEPS=0 V=1 lib CFLAGS= CPPFLAGS= 2>/dev/null | grep ' -c runtime/' >"$work/commands"
check 'warnings are no errors in a user'"'"'s build' sh -c 'test -s "$1" && ! grep -e "-Werror" "$1"' - "$work/commands"
check 'a BUILD with a space is refused' sh -c '! make -n BUILD="a b" DEPS=0 lib 2>"$1" && grep -q "without spaces" "$1"' - "$work/refused"
finish
