#!/bin/sh
# check_plain_c.sh: the library needs only a C99 compiler.
#   - no builtin, attribute, pragma or compiler's macro outside three headers of base/
#   - built without them (NOH_PLAIN_C) it passes the tests of bits: hashes, square roots, quaternions,
#     trigonometry, meshes, bounds, poses, clips
#   - on i386 without SSE it needs nothing from libm
. "$(dirname "$0")/cli/lib.sh"

grep -rnE '__builtin_|__attribute__|_Pragma|^ *# *pragma|__GNUC__|__clang__|__SSE|__AVX|__ARM|__has_' runtime |
    grep -v '^runtime/core/base/\(compiler_internal\|math_internal\|processor_internal\)\.h:' >"$work/words"
check 'what depends on the compiler is in compiler_internal.h, math_internal.h and processor_internal.h' sh -c '! grep . "$1"' - "$work/words"

if [ -n "${NOH_SAN:-}" ]; then
    skip 'plain C gives the same bits' 'the build without sanitizers says it'
    finish
fi
plain=$build/plain
plain_make() {
    make --no-print-directory -j"${JOBS:-2}" CC="${CC:-gcc}" DEPS=0 SAN= "$@" >"$work/log" 2>&1
}
# The tests below compare bits of these rooms; the rest is only compiled. Tests and tools are as they are.
check 'the library compiles as plain C' "${CC:-gcc}" -std=c99 -w -DNOH_PLAIN_C -fsyntax-only "$build/amalgam/noh.c"
check 'core, motion and deform build as plain C' plain_make BUILD="$plain" OPT='-O1 -DNOH_PLAIN_C' ROOMS='core motion deform' lib
names=
for name in hash math quat trig mesh bounds blend clip_codec; do
    names="$names $(echo "$build"/tests/unit/*/test_$name.o | sed "s|^$build/tests/unit/|$plain/tests/|; s|\.o$||")"
done
# shellcheck disable=SC2086
check 'and their tests link' plain_make BUILD="$build" $names
for name in $names; do
    check "plain C: ${name##*/}" sh -c 'NOH_ASSETS=none "$1" >"$2" 2>&1 || { grep -v "^ok" "$2" | tail -n 20; exit 1; }' - \
        "$name" "$work/log"
done

if ! echo '#include <stddef.h>' | ${CC:-gcc} -m32 -E - >/dev/null 2>&1 || ! command -v nm >/dev/null 2>&1; then
    skip 'i386 without SSE needs no libm' "${CC:-gcc} does not build for i386 here, or nm is missing"
else
    # Unoptimised, a call of libm stays a call.
    ${CC:-gcc} -std=c99 -O0 -w -m32 -march=i386 -mno-sse -DNOH_ALLOW_X87 -DNOH_WITHOUT_GL -c "$build/amalgam/noh.c" -o "$work/noh32.o" || exit 1
    nm -u "$work/noh32.o" | awk 'NF == 2 { print $2 }' | sort -u >"$work/asked"
    # the compiler's own: 64-bit arithmetic, and where the program lies
    grep -vE '^(memcpy|memset|memcmp|__u?(div|mod)di3|__udivmoddi4|__divmoddi4|__fixunssfdi|__c[lt]z[sd]i2|__fixunsdfdi|_GLOBAL_OFFSET_TABLE_|__x86\..*)$' \
        "$work/asked" >"$work/foreign"
    check 'i386 without SSE needs no libm' sh -c '! grep . "$1"' - "$work/foreign"
    check 'the list was read' grep -qx __udivdi3 "$work/asked"
    check 'x87 without that word is refused' sh -c '! "$1" -std=c99 -m32 -march=i386 -mno-sse -Iruntime -fsyntax-only runtime/core/base/trig.c 2>"$2" && grep -q "mfpmath=sse" "$2"' - \
        "${CC:-gcc}" "$work/refused"
fi
finish
