#!/bin/sh
# api.sh: print the API of the public headers, a line for each function, type, member, enumerator and macro (api.pl).
# `make api-update` writes it to api.txt when a version is released; tests/check_api.sh compares.
set -eu
cd "$(dirname "$0")/../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Empty system headers: only noh's own declarations are wanted.
for header in stddef.h stdint.h float.h string.h; do : >"$work/$header"; done
for header in runtime/noh/*.h; do echo "#include \"noh/${header##*/}\""; done >"$work/all.c"
flags='-E -P -nostdinc -std=c99 -DUINT32_MAX=0xffffffffu'
# shellcheck disable=SC2086 # words
{
    ${CC:-gcc} $flags -dD -I"$work" -Iruntime "$work/all.c" | grep '^#define NOH_'
    ${CC:-gcc} $flags -I"$work" -Iruntime "$work/all.c"
} | LC_ALL=C perl tools/release/api.pl
