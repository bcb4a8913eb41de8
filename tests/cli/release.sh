#!/bin/sh
# The source archive of a release: the same bytes from two folders, complete, and the list of its files (SPDX), the port
# and the recipe agree with it. With NOH_LONG the Debian packages too: built, clean by lintian, installed into a folder.
. "$(dirname "$0")/lib.sh"
version=$(sed -n 's/^#define NOH_VERSION "\(.*\)"/\1/p' runtime/noh/base.h)
name=noh-$version
release() { # FOLDER OUT PART...
    release_in=$1
    shift
    (cd "$release_in" && VERSION=$version NOH_BUILD=$work/none sh tools/release/release.sh "$@")
}

# A source archive gives itself again: from the repository, or from what was unpacked.
release . "$work/first" source ports spdx sums >"$work/out" 2>"$work/err"
code=$?
expect 0 'source archive, port, recipe, list of files and checksums'
mkdir "$work/unpacked"
tar -C "$work/unpacked" -xzf "$work/first/$name.tar.gz"
release "$work/unpacked/$name" "$work/second" source ports spdx sums >"$work/out" 2>"$work/err"
code=$?
expect 0 'from the unpacked archive'
check 'the same bytes' diff -r "$work/first" "$work/second"
check 'the checksums' sh -c 'cd "$1" && sha256sum --quiet -c SHA256SUMS' - "$work/first"
check 'no file of the repository is missing' sh -c '
    [ -d .git ] || exit 0
    git ls-files | sort >"$2/listed" && (cd "$1" && find . -type f | sed "s|^\./||" | LC_ALL=C sort) >"$2/there"
    LC_ALL=C sort "$2/listed" | diff - "$2/there"' - "$work/unpacked/$name" "$work"
check 'the list has each file with its checksum' sh -c '
    sed -n "s/^FileName: //p" "$1" >"$3/names" && sed -n "s/^FileChecksum: SHA1: //p" "$1" | paste -d" " - "$3/names" |
        sed "s/ /  /" | (cd "$2" && sha1sum --quiet -c) && [ "$(wc -l <"$3/names")" = "$(find "$2" -type f | wc -l)" ]' - "$work/first/$name.spdx" "$work/unpacked/$name" "$work"

mkdir "$work/ports"
for port in vcpkg conan; do tar -C "$work/ports" -xzf "$work/first/$name-$port.tar.gz"; done
check 'nothing is left to fill in' sh -c '! grep -r "@[A-Z0-9]*@" "$1"' - "$work/ports"
check 'the port names the archive' grep -q "$(sha512sum "$work/first/$name.tar.gz" | cut -d' ' -f1)" "$work/ports/vcpkg/portfile.cmake"
check 'the recipe names it too' grep -q "$(sha256sum "$work/first/$name.tar.gz" | cut -d' ' -f1)" "$work/ports/conan/conanfile.py"
if command -v python3 >/dev/null 2>&1; then
    check 'the recipe is valid Python' python3 -c 'import ast, sys; ast.parse(open(sys.argv[1]).read())' "$work/ports/conan/conanfile.py"
    check 'the port is valid JSON' python3 -m json.tool "$work/ports/vcpkg/vcpkg.json" "$work/json"
fi

if [ -z "${NOH_LONG:-}" ]; then
    skip 'Debian packages' 'make check-long: they are a whole build'
elif ! command -v dh >/dev/null 2>&1; then
    skip 'Debian packages' 'no debhelper here'
else
    release . "$work/first" debian sums >"$work/out" 2>"$work/err"
    code=$?
    expect 0 'Debian packages'
    for package in libnoh-dev noh-tools noh-doc; do
        check "$package" sh -c 'dpkg-deb -x "$1"/"$2"_*.deb "$3"' - "$work/first" "$package" "$work/root"
    done
    check 'the tool runs' sh -c '"$1/usr/bin/noh" --version | grep -q "$2"' - "$work/root" "$version"
    if command -v lintian >/dev/null 2>&1; then
        check 'lintian has nothing to say' sh -c '! lintian --no-cfg --allow-root --suppress-tags no-copyright-file,initial-upload-closes-no-bugs "$1"/*.deb | grep .' - "$work/first"
    else
        skip 'lintian' 'not here'
    fi
fi
finish
