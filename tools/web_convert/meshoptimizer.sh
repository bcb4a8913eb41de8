#!/bin/sh
# meshoptimizer.sh FOLDER: the source of Debian's meshoptimizer, unpacked as FOLDER/meshoptimizer: the library itself is for
# this machine's processor alone. It is the same version, so that a page converts to the same bytes as `noh build`.
# Fails with the reason where it cannot be had.
set -eu
mkdir -p "$1"
cd "$1"
[ ! -f meshoptimizer/src/meshoptimizer.h ] || exit 0
command -v dpkg-source >/dev/null 2>&1 || { echo 'the source of meshoptimizer needs dpkg-source (Debian: apt install dpkg-dev)' >&2; exit 1; }

# The archives of binaries that apt knows, asked for sources; its own lists stay as they are.
mkdir -p lists/partial cache/archives/partial
apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 2>/dev/null |
    sort -u | sed 's/^/deb-src /' >sources.list
apt() { apt-get -qq -o Dir::Etc::sourcelist="$PWD/sources.list" -o Dir::Etc::sourceparts=- -o Dir::State::Lists="$PWD/lists" -o Dir::Cache="$PWD/cache" "$@"; }
{ apt update && apt source --download-only meshoptimizer; } >/dev/null 2>&1 || { echo 'apt has no source of meshoptimizer here' >&2; exit 1; }
rm -rf unpacked meshoptimizer
dpkg-source -x meshoptimizer_*.dsc unpacked >/dev/null
mv unpacked meshoptimizer
rm -rf lists cache
