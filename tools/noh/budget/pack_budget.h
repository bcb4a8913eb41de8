/* pack_budget.h: the bytes of a pack on a stage as the verbs make it (draw/figure.h), by part and by LOD level. */
#ifndef NOH_NOH_BUDGET_PACK_BUDGET_H
#define NOH_NOH_BUDGET_PACK_BUDGET_H

#include "draw/figure.h"
#include "noh/base.h"
#include "noh/noh.h"
#include "noh/gl_device.h"
#include "noh/noh_gl.h"

/* One level of everything: bytes to load it and all coarser ones, and the work of a frame at it. */
typedef struct level_cost {
    uint64_t vertices, triangles, texels, pairs; /* of one actor of each kind; pairs: with all targets active */
    uint64_t cpu_bytes, gpu_bytes;
} level_cost;

typedef struct pack_budget {
    figure planned;
    uint64_t cpu_bytes, gpu_bytes; /* of all parts */
    noh_gl_morph_plan morph;       /* zeros except for `reason` where nothing is drawn */
    noh_stage_bytes *parts;        /* [part_count] */
    uint32_t part_count;
    uint32_t cached_segment_count, segment_count; /* of all clips: held decoded at once; in all */
    level_cost levels[NOH_LOD_LEVELS_MAX];
    uint32_t level_first, level_count; /* the levels level_first to level_count - 1 are there */
} pack_budget;

/* caps  NULL: a pack without meshes
 * Prints an error and returns an exit code; 0 on success. */
int pack_budget_make(pack_budget *b, const figure_desc *desc, const noh_gl_caps *caps);
void pack_budget_free(pack_budget *b);

/* The name of a part: with the number of its kind, where there are several. */
void pack_budget_name(const pack_budget *b, uint32_t part, char *text, size_t bytes);

#endif
