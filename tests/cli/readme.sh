#!/bin/sh
# The README's table of bytes equals the output of `noh budget`, as `make demo` prints it. Its program compiles, links only the library, and runs;
# with an unsuitable pack it prints an error.
. "$(dirname "$0")/lib.sh"
flags=
[ -z "${NOH_SAN:-}" ] || flags="-fsanitize=$NOH_SAN"

# The table's rows, without the head, whose width follows the pack's path; the tool also prints rows of zeros.
awk '/^build\/mask.noh .*CPU bytes/ { inside = 1; next } inside && /^```/ { exit } inside' README.md >"$work/table"
noh budget "$build/mask.noh" --path layered --nominal
expect 0 'the budget of the mask'
awk 'NR == 1 { next } /^[^ ]/ { exit } !($NF == "0" && $(NF - 1) == "0")' "$work/out" >"$work/rows"
check 'the README has its rows' diff "$work/table" "$work/rows"
check 'and there are some' grep -q '^  sum ' "$work/table"

awk '/^```c$/ { inside = 1; next } /^```$/ { inside = 0 } inside' README.md >"$work/smile.c"
# shellcheck disable=SC2086
check "the README's program compiles and links" ${CC:-gcc} -std=gnu99 -Wall -Wextra $flags -Iruntime "$work/smile.c" "$build/libnoh.a" \
    -o "$work/smile"

# NAME EXIT_CODE WORDS FILE
runs() {
    "$work/smile" "$4" >"$work/said" 2>&1
    code=$?
    check "$1" sh -c '[ "$1" = "$2" ] && grep -q -- "$3" "$4" || { echo "exit code $1"; cat "$4"; exit 1; }' - $code "$2" "$3" "$work/said"
}
runs 'it smiles' 0 'vertex 0 smiles at' "$build/mask.noh"
runs 'a file that is no pack is named' 1 NOHP README.md

cat >"$work/nod.bvh" <<'END'
HIERARCHY
ROOT neck
{
    OFFSET 0 0 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
        OFFSET 0 10 0
    }
}
MOTION
Frames: 2
Frame Time: 0.0333333
0 0 0
0 30 0
END
noh build "$work/nod.bvh" -o "$work/nod.noh" --quiet
expect 0 'a pack of clips alone is built'
runs 'a pack of clips alone has no mesh, and is said to' 1 'holds no mesh' "$work/nod.noh"
noh build "$build/demo/arm.glb" -o "$work/arm.noh" --quiet
expect 0 'a pack without targets is built'
runs 'a mesh without the target is named' 1 "no target 'smile'" "$work/arm.noh"
finish
