#!/bin/sh
# check_contraction.sh: built for a processor with fused multiply-add, the library uses none. gcc 12 fuses alternating
# sums and differences of products in spite of -ffp-contract=off, and the bits of the results then differ between
# processors.
. "$(dirname "$0")/cli/lib.sh"

if [ -n "${NOH_SAN:-}" ]; then
    skip 'no fused multiply-add' 'checked in the build without sanitizers'
elif [ -z "${NOH_LONG:-}" ]; then
    skip 'no fused multiply-add' 'it compiles the library once more: make check-long; tests/cross.sh looks at aarch64'
elif ! ${CC:-gcc} -mfma -E - </dev/null >/dev/null 2>&1 || ! command -v objdump >/dev/null 2>&1; then
    skip 'no fused multiply-add' "${CC:-gcc} does not build for x86-64 with -mfma, or objdump is missing"
else
    for source in $(find runtime -name "*.c"); do
        object=$work/$(echo "$source" | tr / _).o
        ${CC:-gcc} -std=c99 -O2 -ffp-contract=off -fno-math-errno -mavx2 -mfma -Iruntime "-I$build/gen" -c "$source" -o "$object" || exit 1
        objdump -d "$object" | grep 'vfn\?m\(add\|sub\|addsub\|subadd\)' | sed "s|^|$source: |" >>"$work/fused"
    done
    check 'the objects were read' sh -c 'objdump -d "$1"/*.o | grep -q vmulps' - "$work"
    check 'no fused multiply-add' sh -c '! grep . "$1" | head -n 20 | grep .' - "$work/fused"
fi
finish
