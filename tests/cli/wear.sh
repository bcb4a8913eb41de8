#!/bin/sh
# noh build --wear: what a garment hides of a figure, and where the figure comes through it; refused input.
. "$(dirname "$0")/lib.sh"

body=$build/demo/puppet_levels.noh
noh build "$build/demo/coat.glb" -o "$work/coat.noh" --wear "$body"
expect 0 'build --wear'
hidden=$(sed -n "s/^'coat' is worn over 'body': it hides \([0-9]*\) of .*/\1/p" "$work/out" "$work/err")
check "the coat hides triangles of the body (${hidden:-none})" test "${hidden:-0}" -gt 5000
check 'and the report says where the rest comes through' grep -q "^  the rest comes through by [0-9.]* mm at most: in clip '" "$work/out" "$work/err"
noh info "$work/coat.noh"
expect 0 'info'
noh verify "$work/coat.noh"
expect 0 'verify'
noh strip "$work/coat.noh" -o "$work/same.noh" --from-level 0 --quiet
check 'strip keeps it' cmp "$work/coat.noh" "$work/same.noh"
noh pack "$work/coat.noh" -o "$work/coat.nohz"
expect 0 'pack'
noh build "$build/demo/coat.glb" -o "$work/no.noh" --wear README.md
expect 1 'a figure that is no pack is refused'
check 'by name' grep -q 'README.md' "$work/err"
noh build "$build/demo/coat.glb" -o "$work/no.noh" --wear "$build/demo/none.noh"
expect 1 'and one that is missing'
finish
