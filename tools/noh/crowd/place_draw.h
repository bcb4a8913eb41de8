/* place_draw.h: draws a place (place_file.h) with its agents as characters of a pack, on its ground and steps. */
#ifndef NOH_NOH_CROWD_PLACE_DRAW_H
#define NOH_NOH_CROWD_PLACE_DRAW_H

#include "place_scene.h"
#include "noh/noh.h"

/* Counts of the picture. */
typedef struct place_drawn {
    noh_stage_stats stats;
    uint32_t agents, level_count, near_count, fell, down; /* by the hit; still at the end */
    uint64_t cpu_bytes, gpu_bytes, walkers_bytes, crowd_bytes;
    uint64_t terrain_bytes, terrain_gpu_bytes;  /* 0: there is none */
    uint32_t terrain_blocks, terrain_triangles; /* as drawn */
} place_drawn;

/* Into rgba[height][count][width][4]: pictures side by side. The report is of the last one. Prints an error and returns
 * an exit code; 0 on success. */
int place_draw(gpu *g, const pack_file *file, const place_file *place, const place_draw_options *o, uint8_t *rgba,
               place_drawn *drawn);

#endif
