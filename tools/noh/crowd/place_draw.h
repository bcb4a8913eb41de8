/* place_draw.h: a place (place_file.h) drawn: its inhabitants as characters of a pack, on its ground and steps. */
#ifndef NOH_NOH_CROWD_PLACE_DRAW_H
#define NOH_NOH_CROWD_PLACE_DRAW_H

#include "draw/camera.h"
#include "draw/lighting.h"
#include "file/pack_file.h"
#include "gpu/gpu.h"
#include "place_life.h"
#include "place_people.h"
#include "stage_gl/backdrop.h"
#include "stage_gl/stage_terrain.h"
#include "stage_gl/stage_gl.h"

/* A push: who is within `radius` metres of x, z then falls, away from there. */
typedef struct place_hit {
    int is_given;
    float time_s, at[2], radius, impulse; /* newton seconds */
} place_hit;

typedef struct place_draw_options {
    uint32_t agents, seed;
    float pixels;        /* the largest error of LOD levels */
    double time_s;       /* when the first picture is taken */
    uint32_t count;      /* of pictures, 1 or more, */
    double apart_s;      /* so many seconds apart */
    const char *camera;  /* "AZ,EL,DIST[,X,Z]": about the place's middle, or about X, Z; NULL: over the whole place */
    const char *scenery; /* a pack drawn where it is; NULL: none */
    light_options light;
    uint32_t width, height;
    place_hit hit;
} place_draw_options;

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
