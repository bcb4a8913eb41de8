#!/bin/sh
# check_amalgam.sh: the library as one file.
#   - noh.c compiles alone, as C99, with the project's warnings as errors, with gcc and clang, with and without GL
#   - it has exactly the global names of libnoh.a, and needs only memcpy, memset and memcmp
#   - tests linked with it instead of libnoh.a pass; the README's program and the examples print the same as with libnoh.a
. tests/cli/lib.sh
amalgam=$build/amalgam
flags='-std=c99 -O2 -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wvla -Werror -ffp-contract=off -fno-math-errno -ffunction-sections -fdata-sections'

if [ -n "${NOH_SAN:-}" ]; then
    skip 'the amalgam' 'checked in the build without sanitizers'
    finish
fi
check 'it is made' test -s "$amalgam/noh.c" -a -s "$amalgam/noh/noh.h"
mkdir "$work/alone"
cp -r "$amalgam/noh.c" "$amalgam/noh" "$work/alone"
cd "$work/alone" || exit 1
# With GL it compiled with these flags by gcc for the tests: noh.o. The indentation of the
# library's files is checked there: in one file of this length it takes gcc seconds.
# shellcheck disable=SC2086
check 'it compiles alone with gcc, without GL' gcc $flags -Wno-misleading-indentation -DNOH_WITHOUT_GL -fsyntax-only noh.c
if command -v clang >/dev/null 2>&1; then
    # shellcheck disable=SC2086
    check 'it compiles alone with clang' clang $flags -fsyntax-only noh.c
else
    # shellcheck disable=SC2086
    check 'it compiles alone with gcc' gcc $flags -Wno-misleading-indentation -fsyntax-only noh.c
fi
cp "$amalgam/noh.o" . # the tests' own
nm --defined-only -g noh.o | awk '{ print $3 }' | sort >names
nm --defined-only -g "$build/libnoh.a" | awk 'NF == 3 { print $3 }' | sort >library_names
check 'it has the names of libnoh.a' cmp names library_names
nm -u noh.o | awk '{ print $2 }' | sort | tr '\n' ' ' >asked
check 'it asks for memcpy, memset and memcmp only' grep -qx 'memcmp memcpy memset ' asked
cd "$OLDPWD" || exit 1

# ---- the tests, with it ----

for program in "$amalgam"/*/test_* "$amalgam"/*/*/test_*; do
    [ -x "$program" ] && [ -f "$program" ] || continue
    name=${program#"$amalgam"/}
    case " ${seen:-} " in *" $name "*) continue ;; esac
    seen="${seen:-} $name"
    CMOCKA_MESSAGE_OUTPUT=TAP "$program" >"$work/tap" 2>&1
    code=$?
    cp "$work/tap" "$work/err"
    expect 0 "$name passes ($(grep -c '^ok ' "$work/tap") tests)"
done
check 'tests were linked with it' test -n "${seen:-}"

# ---- programs, with it and with libnoh.a ----

awk '/^```c$/ { inside = 1; next } /^```$/ { inside = 0 } inside' README.md >"$work/smile.c"
sources="$work/smile.c"
for source in tools/examples/*.c; do
    [ ! -f "$source" ] || sources="$sources $source"
done
for source in $sources; do
    name=$(basename "$source" .c)
    libraries=$(sed -n 's|^ *# *include <EGL/.*|-lEGL|p; s|^ *# *include "start.h".*|-lEGL|p' "$source" | head -n 1)
    ! grep -q '"measure.h"' "$source" || libraries="$libraries -Wl,--wrap=malloc,--wrap=calloc,--wrap=realloc"
    # shellcheck disable=SC2086
    check "$name builds with it" gcc -std=gnu99 -O2 -Wl,--gc-sections "-I$work/alone" "$source" "$work/alone/noh.o" -o "$work/with_amalgam" $libraries -lm
    # shellcheck disable=SC2086
    check "and with libnoh.a" gcc -std=gnu99 -O2 -Wl,--gc-sections -Iruntime "$source" "$build/libnoh.a" -o "$work/with_archive" $libraries -lm
    (cd "$work" && ./with_amalgam "$build/mask.noh" >amalgam.txt 2>&1; echo "exit code $?" >>amalgam.txt)
    (cd "$work" && ./with_archive "$build/mask.noh" >archive.txt 2>&1; echo "exit code $?" >>archive.txt)
    check 'and prints the same' cmp "$work/amalgam.txt" "$work/archive.txt"
    if [ "$name" = smile ]; then
        check 'the README'"'"'s program does what it says' grep -q 'vertex 0 smiles' "$work/amalgam.txt"
    fi
done
finish
