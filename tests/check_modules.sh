#!/bin/sh
# check_modules.sh: what a kind does not name is not linked.
#   - the objects of the stage's core ask for nothing that its modules, or what these are built on, define
#   - the example walker and a walker without a GPU have no function of a module
#   - such a walker takes at most two thirds of the bytes of one that names all modules, and runs
#   - no struct of stage/ has more than forty fields
. "$(dirname "$0")/cli/lib.sh"

# ---- fields ----

# Of the outermost struct, by its semicolons and commas, without comments and what is in brackets.
cat runtime/stage/*/*.h | awk '
    { line = line $0 "\n" }
    END {
        while (match(line, /\/\*([^*]|\*+[^*\/])*\*+\//)) line = substr(line, 1, RSTART - 1) substr(line, RSTART + RLENGTH)
        gsub(/\([^()]*\)|\[[^\]]*\]/, "", line)
        n = split(line, part, /struct [a-z_0-9]+ \{/)
        for (i = 2; i <= n; i++) {
            body = part[i]
            sub(/\n\}.*/, "", body)
            name = part[i]
            sub(/^[^}]*\n\} */, "", name)
            sub(/;.*/, "", name)
            fields = gsub(/[;,]/, "", body)
            structs++
            if (fields > 40) print name ": " fields " fields"
        }
        if (structs < 50) print "only " structs " structs were read"
    }' >"$work/wide"
sed 's/^/# /' "$work/wide"
check 'no struct of stage/ has more than forty fields' test ! -s "$work/wide"

# ---- symbols ----

if [ -n "${NOH_SAN:-}" ] || ! command -v nm >/dev/null 2>&1; then
    skip 'no module is linked that nobody names' 'needs nm, and a build without sanitizers'
    finish
fi
objects() { # FOLDERS: of the sources that are there
    find "$@" -name '*.c' | sed "s|.*|$build/&|; s|c\$|o|"
}
objects runtime/stage/modules >"$work/modules"
objects runtime/stage/cast >"$work/core"
objects runtime/motion/graph runtime/motion/match runtime/life | grep -vE '/face/(corrective|weight_rule)\.o$' >"$work/beneath"
check 'the modules are there' test "$(wc -l <"$work/modules")" -ge 17
cat "$work/modules" "$work/beneath" | xargs nm --defined-only -g | awk 'NF == 3 { print $3 }' | sort -u >"$work/given"
xargs nm -u <"$work/core" | awk 'NF == 2 { print $2 }' | sort -u >"$work/asked"
check 'the core of the stage asks for no module' sh -c '! comm -12 "$1" "$2" | grep .' - "$work/asked" "$work/given"

# ---- programs ----

# A walker without a GPU; with -DALL it names all modules.
cat >"$work/walk.c" <<'END'
#include <stdio.h>
#include <stdlib.h>

#include "noh/modules.h"

static unsigned char file[32u << 20] __attribute__((aligned(64)));

int main(int argc, char **argv)
{
    static noh_pack pack;
    static noh_stage_plan plan;
    noh_kind_desc kind = { .mesh = &pack, .actor_count = 1, .root_axes = NOH_ROOT_GROUND };
    const noh_stage_desc desc = { .kinds = &kind, .kind_count = 1 };
    const noh_appearance look = { .posed = 1 };
    noh_stage *stage;
    noh_actor actor;
    noh_place place;
    float head[12];
    FILE *in = argc > 1 ? fopen(argv[1], "rb") : NULL;
    void *memory;
#ifdef ALL
    static const noh_kind_face face;
    static const noh_kind_ragdoll ragdoll = { .count = 1 };
    kind.graphs = noh_graph_module("*");
    kind.face = noh_face_module(&face);
    kind.ragdoll = noh_ragdoll_module(&ragdoll);
    kind.springs = noh_springs_module(NULL);
#endif
    if (!in || noh_pack_open(file, fread(file, 1, sizeof file, in), &pack, NULL)) return 1;
    if (noh_stage_plan_make(&desc, NULL, &plan, NULL)) return 1;
    memory = malloc((size_t)plan.cpu_bytes);
    if (noh_stage_init(memory, (size_t)plan.cpu_bytes, NULL, &desc, &plan, &stage, NULL)) return 1;
    if (noh_stage_spawn(stage, 0, NULL, &actor, NULL) || noh_actor_set_appearance(stage, actor, &look, NULL)) return 1;
    if (noh_actor_play(stage, actor, 0, "walk", NULL, NULL)) return 1;
    for (int i = 0; i < 60; i++) {
        if (noh_stage_frame(stage, NOH_TICKS_PER_SECOND / 60, NULL, NULL, NULL, NULL)) return 1;
    }
    if (noh_actor_place(stage, actor, &place, NULL) || noh_actor_joint(stage, actor, 3, head, NULL)) return 1;
    return place.position[2] > 0.3f && head[7] > 0.3f ? 0 : 1;
}
END
links() { # NAME SOURCE FLAGS
    name=$1 source=$2
    shift 2
    # shellcheck disable=SC2086
    ${CC:-gcc} -std=gnu99 -O2 -Iruntime "-I$build/gen" -Itools/examples "$source" \
        -o "$work/$name" "$build/libnoh.a" -Wl,--gc-sections "$@" -lm
}
check 'a walker without a GPU links' links walk "$work/walk.c"
check 'and one that names all modules' links all "$work/walk.c" -DALL
nm --defined-only "$work/walk" | awk 'NF == 3 { print $3 }' | sort -u | comm -12 - "$work/given" >"$work/linked"
sed 's/^/# /' "$work/linked"
check 'a walker has no function of a module' test ! -s "$work/linked"
check 'one that names them has' sh -c 'nm --defined-only "$1" | grep -q " noh_ragdolls_step_once"' - "$work/all"
bytes_of() { # PROGRAM: the library's code and constants
    nm -S -t d "$work/$1" | awk '$3 ~ /^[tTrRdD]$/ && $4 ~ /^noh_|^[a-z]/ && $4 != "main" { sum += $2 } END { print sum + 0 }'
}
walk=$(bytes_of walk) all=$(bytes_of all)
echo "# a walker takes $walk bytes of the library, one that names all modules $all"
check 'a walker takes at most two thirds of these bytes' test "$walk" -gt 4096 -a $((3 * walk)) -le $((2 * all))
if [ -f "$build/demo/puppet_levels.noh" ]; then
    check 'and walks' "$work/walk" "$build/demo/puppet_levels.noh"
else
    skip 'and walks' 'no puppet_levels.noh here'
fi
if links walker tools/examples/walker.c -lEGL >"$work/log" 2>&1; then
    nm --defined-only "$work/walker" | awk 'NF == 3 { print $3 }' | sort -u | comm -12 - "$work/given" >"$work/linked"
    sed 's/^/# /' "$work/linked"
    check 'the example walker has no function of a module' test ! -s "$work/linked"
else
    skip 'the example walker has no function of a module' 'no EGL here'
fi
finish
