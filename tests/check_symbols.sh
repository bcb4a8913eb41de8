#!/bin/sh
# check_symbols.sh: the external symbols of the archive, and absence of global state.
#   - undefined symbols: memcpy, memset, memcmp and nothing else
#   - no writable and no uninitialised data: nothing mutable is global
#   - asserts: none in libnoh.a, many in the library linked by the tests
#   - every global symbol begins with noh_
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
        objdump -t "$archive" | awk -v s="$symbol" '$NF == s && $0 !~ /\.data\.rel\.ro|\.rodata|\*UND\*/ { print s, $0 }' >>"$work/mutable"
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

finish
