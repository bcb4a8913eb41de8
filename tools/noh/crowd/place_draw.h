/* place_draw.h: a place (place_file.h) drawn: its inhabitants as characters of a pack, on its ground and steps. */
#ifndef NOH_NOH_CROWD_PLACE_DRAW_H
#define NOH_NOH_CROWD_PLACE_DRAW_H

#include "place_scene.h"
#include "noh/noh.h"

/* What was drawn. */
typedef struct place_drawn {
    noh_stage_stats stats;
    uint32_t agents, level_count, near_count, fell, down; /* by the hit; still at the end */
    uint64_t cpu_bytes, gpu_bytes, walkers_bytes, crowd_bytes;
    uint64_t terrain_bytes, terrain_gpu_bytes;  /* 0: there is none */
    uint32_t terrain_blocks, terrain_triangles; /* as drawn */
} place_drawn;

/* Into rgba[height][count][width][4]: one picture beside the other. What was drawn is that of the last. Prints an error
 * and returns an exit code; 0 on success. */
int place_draw(gpu *g, const pack_file *file, const place_file *place, const place_draw_options *o, uint8_t *rgba,
               place_drawn *drawn);

#endif
