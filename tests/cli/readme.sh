#!/bin/sh
# The program on the README's page compiles, links against the library alone, and runs.
set -u
build=${NOH_BUILD:-build}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
flags=
[ -z "${NOH_SAN:-}" ] || flags="-fsanitize=$NOH_SAN"

awk '/^```c$/ { inside = 1; next } /^```$/ { inside = 0 } inside' README.md >"$work/smile.c"
if ${CC:-gcc} -std=gnu99 -Wall -Wextra $flags -Iruntime "$work/smile.c" "$build/libnoh.a" -o "$work/smile" &&
    "$work/smile" "$build/mask.noh" | grep -q 'vertex 0 smiles at' && ! "$work/smile" README.md >"$work/bad.txt" &&
    grep -q 'NOHP' "$work/bad.txt"; then
    echo "ok 1 - the README's program runs, and refuses a file that is no pack"
else
    echo "not ok 1 - the README's program runs, and refuses a file that is no pack"
fi
echo 1..1
