#!/bin/sh
# check_symbols.sh: what the archive needs from outside, and that it has no state.
#   - undefined symbols: memcpy, memset, memcmp and nothing else
#   - no writable and no uninitialised data: nothing mutable is global
#   - asserts: none in libnoh.a, many in the library that the tests link
#   - every global symbol begins with noh_
#   - the folders of runtime/ have an order in which each includes only from those before it; only gl/ includes GL headers
set -u
. tests/cli/lib.sh
archive=$build/libnoh.a

if [ -n "${NOH_SAN:-}" ]; then
    skip 'undefined symbols' 'sanitizers add their own'
    skip 'no mutable globals' 'sanitizers add their own'
    skip 'global names' 'sanitizers add their own'
elif ! command -v nm >/dev/null 2>&1; then
    skip 'symbols' 'no nm here (binutils)'
else
    nm -u "$archive" | awk 'NF == 2 { print $2 }' | sort -u >"$work/asked"
    nm --defined-only "$archive" | awk 'NF == 3 { print $3 }' | sort -u >"$work/given"
    comm -23 "$work/asked" "$work/given" >"$work/undefined"
    printf 'memcmp\nmemcpy\nmemset\n' >"$work/allowed"
    check "only memcpy, memset and memcmp are asked for" sh -c '! comm -23 "$1" "$2" | grep .' - "$work/undefined" "$work/allowed"
    check 'the list was read' test "$(wc -l <"$work/given")" -gt 50

    # b B d D: data that can be written; C: common. Read-only after relocation (.data.rel.ro) is d too.
    nm --defined-only "$archive" | awk '$2 ~ /^[bBdDCsSgG]$/ { print $3 }' | sort -u >"$work/writable"
    : >"$work/mutable"
    while read -r symbol; do
        objdump -t "$archive" | awk -v s="$symbol" '$NF == s && $0 !~ /\.data\.rel\.ro|\*UND\*/ { print s, $0 }' >>"$work/mutable"
    done <"$work/writable"
    check 'nothing mutable is global' sh -c '! grep . "$1"' - "$work/mutable"
    check 'no section can be written' sh -c '
        size -A "$1" | awk "(\$1 == \".data\" || \$1 == \".bss\" || \$1 ~ /^\\.(data|bss)\\./ && \$1 !~ /^\\.data\\.rel\\.ro/) && \$2 > 0 { print; bad = 1 } END { exit bad }"' - "$archive"

    nm --defined-only -g "$archive" | awk 'NF == 3 && $3 !~ /^noh_/ { print $3 }' >"$work/foreign"
    check 'every global name begins with noh_' sh -c '! grep . "$1"' - "$work/foreign"
fi

# ---- asserts ----

# On x86 a failed one is an invalid instruction.
traps() {
    objdump -d "$1" | grep -c '\<ud2\>'
}
if [ -z "${NOH_SAN:-}" ] && command -v objdump >/dev/null 2>&1 && objdump -f "$archive" | grep -q x86-64; then
    shipped=$(traps "$archive") tested=$(traps "$build/assert/libnoh.a")
    echo "# asserts: $shipped in libnoh.a, $tested in the library that the tests link"
    check 'the library that ships has no asserts' test "$shipped" = 0
    check 'the one that the tests link has' test "$tested" -ge 20
else
    skip 'asserts' 'their instructions are counted on x86-64, without sanitizers'
fi

# ---- folders ----

# "FOLDER INCLUDED" for each include of another folder's header: a graph of folders, which has to have an order.
grep -n '^ *# *include *"' runtime/*/*.[ch] runtime/*/*/*.[ch] 2>/dev/null | sed 's|^runtime/\([^/]*\)/.*"\([^"]*\)".*|\1 \2|' | sort -u >"$work/includes"
awk '$2 !~ "/" && $2 != "shaders.gen.h"' "$work/includes" >"$work/unnamed"
check 'includes name their folder' sh -c '! grep . "$1"' - "$work/unnamed"
awk '$2 ~ "/" { sub("/.*", "", $2); if ($1 != $2) print $2, $1 }' "$work/includes" | sort -u >"$work/folders"
check 'the graph of folders was read' grep -q '^base gl$' "$work/folders"
tsort "$work/folders" >"$work/order" 2>"$work/circles"
check 'no folders include each other in a circle' sh -c '! grep . "$1"' - "$work/circles"
echo "# folders, each including only from those before it: $(tr '\n' ' ' <"$work/order")"
check 'base includes from no other folder' sh -c '! grep " base$" "$1"' - "$work/folders"
# What is above gl/ runs without a GL.
check 'only gl/ and stage_gl/ include from gl/' sh -c '! grep "^gl " "$1" | grep -v " stage_gl$"' - "$work/folders"
# the compiler's own headers, memcpy's, and SIMD intrinsics
grep -Hn '^ *# *include *<' runtime/*.h runtime/*/*.[ch] runtime/*/*/*.[ch] 2>/dev/null |
    grep -v '<\(stddef\|stdint\|float\|string\|emmintrin\|immintrin\|arm_neon\)\.h>' >"$work/system"
check 'only gl/ includes GL headers, nothing else is included' sh -c '! grep -v "^runtime/gl/.*<GLES[23]*/" "$1"' - "$work/system"
finish
