#!/bin/sh
# framac.sh: proofs by Frama-C's Eva that chunk checkers never read out of bounds or divide by zero, for any content of
# any length up to 512 bytes. It proves the checkers that read only their own chunk and the names. Checkers that follow
# references to other chunks (meshes, skins, clips, graphs, springs, transfers, wrinkles, influences) or read several
# arrays (hair, nodes, skeletons, textures) need annotations, because intervals lose the relations between numbers;
# fuzzers and the bit flips of the tests cover these. Ends like run.sh. Part of `make check-long`.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
work=$build/framac
if ! command -v frama-c >/dev/null 2>&1; then
    echo 'Frama-C skipped: it is not installed (Debian: frama-c-base)'
    echo '0 passed, 0 failed, 1 skipped'
    exit 0
fi
mkdir -p "$work"
passed=0 failed=0

# A count takes each value up to 69 separately, and all others together; likewise an array's offset at, before and after
# the only valid one. Eva keeps no relation between two fields in memory.
count_of() { # TYPE FIELD
    cat <<END
    uint32_t $2 = Frama_C_unsigned_int_interval(0, 0xffffffffu);
    if ($2 < 70) {
        //@ split $2;
        (($1 *)bytes)->$2 = $2;
    } else {
        (($1 *)bytes)->$2 = $2;
    }
END
}
offset_of() { # TYPE FIELD PLACE
    cat <<END
    int way_$2 = Frama_C_interval(0, 2);
    //@ split way_$2;
    if (way_$2 == 0) (($1 *)bytes)->$2 = Frama_C_unsigned_int_interval(0, $3 - 1);
    if (way_$2 == 1) (($1 *)bytes)->$2 = Frama_C_unsigned_int_interval($3 + 1, 0xffffffffu);
    if (way_$2 == 2) (($1 *)bytes)->$2 = $3;
END
}

# FUNCTION FILE, and on standard input the known values of the header.
prove() {
    {
        cat <<'END'
#include "core/pack/check_internal.h"
#include "__fc_builtin.h"
#define SIZE 512
static unsigned char bytes[SIZE] __attribute__((aligned(64)));
static noh_pack_chunk chunks[4];
static char strings[64];
int main(void)
{
    noh_pack pack = { 0 };
    noh_error error;
    Frama_C_make_unknown((char *)bytes, SIZE);
    Frama_C_make_unknown(strings, 63);
    pack.bytes = bytes;
    pack.byte_count = SIZE;
    pack.chunks = chunks;
    pack.chunk_count = 4;
    pack.strings = strings;
    pack.string_bytes = 64;
END
        cat
        echo "    noh_check check = { &pack, bytes, Frama_C_unsigned_int_interval(0, SIZE), 0, 0, &error };"
        echo "    return $1(&check);"
        echo '}'
    } >"$work/$1.c"
    timeout 600 frama-c -eva -eva-precision 5 -eva-auto-loop-unroll 64 -eva-min-loop-unroll 30 -warn-special-float none \
        -cpp-extra-args='-Iruntime -U__SSE2__ -U__AVX2__ -U__SSE__' \
        "$work/$1.c" "$2" runtime/core/pack/check.c runtime/core/base/result.c runtime/core/base/hash.c >"$work/$1.txt" 2>&1
    if grep -q '^  0 alarms generated' "$work/$1.txt"; then
        passed=$((passed + 1))
        echo "$1: proven, $(sed -n 's/.*, \([0-9]* statements reached (out of [0-9]*)\).*/\1/p' "$work/$1.txt")"
    else
        failed=$((failed + 1))
        echo "$1: not proven"
        grep -A1 -e 'rror:' -e '\[eva:alarm\]' "$work/$1.txt" | head -n 20 | sed 's/^/    | /'
    fi
}

{
    count_of noh_recipe_header row_count
    offset_of noh_recipe_header rows_offset 16
} >"$work/recipe"
{
    count_of noh_pack_ragdoll_header row_count
    offset_of noh_pack_ragdoll_header rows_offset 16
} >"$work/ragdoll"
prove noh_check_recipe runtime/core/pack/check_recipe.c <"$work/recipe"
prove noh_check_ragdoll runtime/core/pack/check_ragdoll.c <"$work/ragdoll"
prove noh_check_terrain runtime/core/pack/check_terrain.c </dev/null
prove noh_check_materials runtime/core/pack/check_materials.c </dev/null
echo "$passed passed, $failed failed, 0 skipped"
[ $failed = 0 ]
