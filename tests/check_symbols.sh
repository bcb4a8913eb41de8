#!/bin/sh
# check_symbols.sh: what the archive asks of the outside, and what keeps state.
#   - undefined symbols: memcpy, memset, memcmp and nothing else
#   - no writable data, no uninitialised data: nothing mutable is global
#   - every global symbol begins with noh_
#   - a folder of runtime/ includes only from those before it, and only gl/ includes GL headers
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
        size -A "$1" | awk "(\$1 == \".data\" || \$1 == \".bss\" || \$1 ~ /^\\.(data|bss)\\.[^r]/) && \$2 > 0 { print; bad = 1 } END { exit bad }"' - "$archive"

    nm --defined-only -g "$archive" | awk 'NF == 3 && $3 !~ /^noh_/ { print $3 }' >"$work/foreign"
    check 'every global name begins with noh_' sh -c '! grep . "$1"' - "$work/foreign"
fi

# ---- folders ----

# Prints each include that is not allowed: FOLDER ALLOWED...
foreign_includes() {
    folder=$1
    shift
    grep -Hn '^ *# *include *"' runtime/"$folder"/*.[ch] | while IFS= read -r line; do
        path=$(echo "$line" | sed 's/.*"\(.*\)".*/\1/')
        from=${path%%/*}
        fine=0
        for allowed in "$folder" "$@"; do
            [ "$from" = "$allowed" ] && fine=1
        done
        [ $fine = 1 ] || [ "$folder $path" = 'gl shaders.gen.h' ] || echo "$line"
    done
}
allowed=
for folder in base pack mesh anim deform gl character; do
    foreign_includes $folder $allowed >"$work/includes"
    check "$folder includes only from:${allowed:- nothing}" sh -c '! grep . "$1"' - "$work/includes"
    [ $folder = gl ] || allowed="$allowed $folder" # what comes after gl/ runs without a GL
done
check 'no other folder is in runtime/' sh -c 'test "$(cd runtime && ls -d */ | tr -d "/\n")" = animbasecharacterdeformglmeshpack'
# the compiler's own headers, memcpy's, and SIMD intrinsics
grep -Hn '^ *# *include *<' runtime/*.h runtime/*/*.[ch] |
    grep -v '<\(stddef\|stdint\|string\|emmintrin\|immintrin\|arm_neon\)\.h>' >"$work/system"
check 'only gl/ includes GL headers, nothing else is included' sh -c '! grep -v "^runtime/gl/.*<GLES[23]*/" "$1"' - "$work/system"
finish
