#!/bin/sh
# install.sh lib|all|remove: what `make install-lib`, `make install` and `make uninstall` call, with BUILD, VERSION, CC,
# PREFIX, BINDIR, LIBDIR, INCLUDEDIR, DATADIR and DESTDIR set.
#
#   lib     libnoh.a, the public headers, noh.pc, the CMake package; in DATADIR/noh the GLSL for a
#           game's own shaders, the examples, the platform template and the guide
#   all     that, the programs noh and noh-embed (tools/embed), the man page, bash completion, and the converter as a
#           library: libnohconvert.a, noh_convert.h, nohconvert.pc
#   remove  what DATADIR/noh/installed.txt lists, and the folders that were made for it, where they are empty
#
# installed.txt has a line for each file and each folder made ("f PATH", "d PATH", without DESTDIR). What an earlier
# version installed at the same place and this one does not have is removed.
set -eu
cd "$(dirname "$0")/../.."
what=$1
root=${DESTDIR:-}
list=$root$DATADIR/noh/installed.txt
kept=
for folder in "$PREFIX" "$BINDIR" "$LIBDIR" "$INCLUDEDIR" "$DATADIR"; do
    case $folder in
    /*) ;;
    *) echo "install: '$folder' has to begin with /" >&2; exit 2 ;;
    esac
done

# remove_listed LIST: its files, then its folders from the deepest up.
remove_listed() {
    sed -n 's/^f //p' "$1" | while IFS= read -r path; do rm -f "$root$path"; done
    sed -n 's/^d //p' "$1" | sort -r | while IFS= read -r path; do rmdir "$root$path" 2>/dev/null || :; done
}

if [ "$what" = remove ]; then
    [ -f "$list" ] || { echo "uninstall: nothing is installed there (no $list)" >&2; exit 1; }
    copy=$(mktemp)
    cp "$list" "$copy"
    remove_listed "$copy"
    rm -f "$copy"
    exit 0
fi

new=$(mktemp)
trap 'rm -f "$new"' EXIT

# folder PATH: made with its parents; those that were not there are listed.
folder() {
    if [ ! -d "$root$1" ]; then
        [ "$1" = / ] || folder "$(dirname "$1")"
        mkdir "$root$1"
        echo "d $1" >>"$new"
    elif [ -f "$list" ]; then
        grep -Fx "d $1" "$list" >>"$new" || :
        case $1 in */*/*) folder "$(dirname "$1")" ;; esac
    fi
}

# put MODE FILE PATH
put() {
    folder "$(dirname "$3")"
    # Not into what is there: a program that runs, or a link, stays whole.
    rm -f "$root$3"
    cp "$2" "$root$3"
    chmod "$1" "$root$3"
    echo "f $3" >>"$new"
}

# From the CMake package's folder up to /, for paths that stay right when the whole prefix is moved.
up() {
    echo "$LIBDIR/cmake/noh" | sed "s|^$PREFIX/||; s|[^/][^/]*|..|g"
}
within() { # FOLDER: from the CMake package's folder
    case $1/ in
    "$PREFIX"/*) case $LIBDIR/ in "$PREFIX"/*) echo "$(up)/${1#"$PREFIX"/}"; return ;; esac ;;
    esac
    echo "$LIBDIR/cmake/noh" | sed "s|[^/][^/]*|..|g; s|^/||; s|\$|$1|"
}

# A linker that knows --gc-sections gets told to.
gc=
echo 'int main(void) { return 0; }' >"$new.c"
# shellcheck disable=SC2086
${CC:-cc} -Wl,--gc-sections "$new.c" -o "$new.out" >/dev/null 2>&1 && gc=' -Wl,--gc-sections'
rm -f "$new.c" "$new.out" "$new.wasm"

# fill TEMPLATE PATH
fill() {
    rest=${VERSION#*.}
    sed "s|@PREFIX@|$PREFIX|g; s|@INCLUDEDIR@|$(of_prefix "$INCLUDEDIR")|g; s|@LIBDIR@|$(of_prefix "$LIBDIR")|g
         s|@DATADIR@|$(of_prefix "$DATADIR")|g; s|@VERSION@|$VERSION|g; s|@MAJOR@|${VERSION%%.*}|g; s|@MINOR@|${rest%%.*}|g
         s|@TO_DATADIR@|$(within "$DATADIR")|g; s|@TO_INCLUDEDIR@|$(within "$INCLUDEDIR")|g; s|@TO_BINDIR@|$(within "$BINDIR")|g; s|@GC@|$gc|g; s|@TOOL_LIBS@|${TOOL_LIBS:-}|g; s|@HAS_GC@|${gc:+ON}|g" "$1" >"$new.filled"
    put 644 "$new.filled" "$2"
    rm -f "$new.filled"
}
of_prefix() {
    case $1/ in
    "$PREFIX"/*) echo "\${prefix}/${1#"$PREFIX"/}" ;;
    *) echo "$1" ;;
    esac
}

put 644 "$BUILD/libnoh.a" "$LIBDIR/libnoh.a"
for header in runtime/noh/*.h; do
    put 644 "$header" "$INCLUDEDIR/noh/${header##*/}"
done
for shader in shaders_es/*.glsl; do
    put 644 "$shader" "$DATADIR/noh/shaders/${shader##*/}"
done
put 644 shaders_es/README.md "$DATADIR/noh/shaders/README.md"
for example in tools/examples/*.[ch] tools/examples/window/*.c; do
    put 644 "$example" "$DATADIR/noh/examples/${example#tools/examples/}"
done
for file in template.c platforms.h platform.h README.md; do
    put 644 "platform/$file" "$DATADIR/noh/platform/$file"
done
# The guide without its pages on changing noh. Links to what is not installed become plain text.
for page in tools/docs/guide/*.md tools/docs/*.md; do
    case $page in */find_your_way.md | */add_*.md) continue ;; esac
    sed 's|](../../examples/|](../examples/|g; s|](../figures.md)|](figures.md)|g; s|](guide/|](|g
        /^!\[.*\](\(\.\.\/\)*demo_assets\//d
        s/\[\([^]]*\)\](\(\.\.\/\.\.\/[^)]*\|find_your_way\.md\|add_[a-z_]*\.md\|\.\.\/[a-z_]*\/README\.md\|[.\/]*runtime\/[^)]*\))/\1/g' "$page" >"$new.page"
    put 644 "$new.page" "$DATADIR/noh/guide/${page##*/}"
    rm -f "$new.page"
done
for picture in tools/docs/guide/*.svg tools/docs/guide/pictures/*; do
    put 644 "$picture" "$DATADIR/noh/guide/${picture#tools/docs/guide/}"
done
fill tools/install/noh.pc.in "$LIBDIR/pkgconfig/noh.pc"
fill tools/install/nohConfig.cmake.in "$LIBDIR/cmake/noh/nohConfig.cmake"
fill tools/install/nohConfigVersion.cmake.in "$LIBDIR/cmake/noh/nohConfigVersion.cmake"

if [ "$what" = all ]; then
    put 755 "$BUILD/noh" "$BINDIR/noh"
    put 755 "$BUILD/embed" "$BINDIR/noh-embed"
    if [ -f "$BUILD/libnohconvert.a" ]; then
        put 644 "$BUILD/libnohconvert.a" "$LIBDIR/libnohconvert.a"
        put 644 tools/noh/build/noh_convert.h "$INCLUDEDIR/noh_convert.h"
        fill tools/install/nohconvert.pc.in "$LIBDIR/pkgconfig/nohconvert.pc"
    fi
    put 644 "$BUILD/noh.1" "$DATADIR/man/man1/noh.1"
    put 644 "$BUILD/noh.bash" "$DATADIR/bash-completion/completions/noh"
elif [ -f "$list" ]; then
    # The programs of an earlier `make install` stay, and stay listed.
    kept="^f $BINDIR/\|^f $DATADIR/man/\|^f $DATADIR/bash-completion/\|^f .*noh_\?convert[.]"
    grep "$kept\|^d " "$list" >>"$new" || :
fi

folder "$DATADIR/noh"
echo "f $DATADIR/noh/installed.txt" >>"$new"
if [ -f "$list" ]; then
    sed -n 's/^f //p' "$list" | while IFS= read -r path; do
        grep -Fxq "f $path" "$new" || rm -f "$root$path"
    done
    grep '^d ' "$list" >>"$new" || :
fi
sort -u "$new" >"$list"
echo "installed noh $VERSION ($(grep -c '^f ' "$list") files) in $root$PREFIX"
