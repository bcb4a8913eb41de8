/* level_costs.h: what each LOD level of a scene costs. */
#ifndef NOH_NOH_BUDGET_LEVEL_COSTS_H
#define NOH_NOH_BUDGET_LEVEL_COSTS_H

#include "draw/load.h"
#include "scene/scene.h"

/* One level of the whole scene: bytes to load it and all coarser ones, and the work of a frame at it. */
typedef struct level_cost {
    uint64_t vertices, triangles, texels, pairs; /* of one copy of the scene; pairs: with all targets active */
    uint64_t cpu_bytes, gpu_bytes;
} level_cost;

typedef struct level_costs {
    level_cost levels[NOH_LOD_LEVELS_MAX];
    uint32_t first, count; /* the levels first to count - 1 are there */
} level_costs;

/* Leaves the scene at its finest level. Prints an error and returns an exit code; 0 on success. */
int level_costs_find(level_costs *out, const pack_file *file, scene *s, const noh_gl_caps *caps, const load_options *o);

#endif
