/* crowd.h: a thousand bodies, each at the LOD level that its size in pixels needs: an example of character/ and gl/
 * together, to copy into a game.
 *
 *   crowd_plan_make   every byte, CPU and GPU, before anything is loaded
 *   crowd_open        make everything in one block of memory of exactly that size
 *   a frame:
 *     crowd_step      advance all clocks, fire all callback keys
 *     crowd_look      cull; choose LOD levels, slots and draw order
 *     crowd_show      pose the bodies that are due, within a budget; upload palettes and weights of visible bodies
 *     crowd_send      accumulate and upload
 *     crowd_draw      one draw per submesh and level; a body that fades between two levels is drawn by itself,
 * dithered, once at each
 *
 * Every body is the same skinned mesh of a pack (of several, the one with the most pairs) and has a clip, phase and
 * playback speed of its own, and a second track with a clip of the face. One unit of the pack is a metre; y is up.
 *
 * The baseline, without LOD (options.plain), poses the same bodies in every frame and draws them at the full level with
 * all targets.
 *
 *   crowd_plan.c   bytes
 *   crowd.c        opening and closing
 *   crowd_place.c  the errors that the pack states; places and clips of the bodies
 *   crowd_frame.c  a frame on the CPU
 *   crowd_draw.c   a frame on the GPU; the camera */
#ifndef NOH_NOH_CROWD_CROWD_H
#define NOH_NOH_CROWD_CROWD_H

#include "gpu/gpu.h"
#include "file/pack_file.h"

#define CROWD_RUNS_MAX (NOH_LOD_LEVELS_MAX * NOH_LOD_LEVELS_MAX)
#define CROWD_FIELD_M 100.0f /* radius of the field around the first camera */

typedef struct crowd_options {
    uint32_t count;                     /* bodies; 1..NOH_MORPH_INSTANCES_MAX */
    int plain;                          /* 1: without LOD */
    int unculled;                       /* 1: treat all as visible */
    float pixels;                       /* the largest error on screen; default (0) 1 */
    uint64_t budget_ns;                 /* of pose updates per frame; default (0) no limit */
    float field_of_view_rad;            /* of the view, vertical; default (0) 40 degrees */
    uint32_t width, height;             /* of the view, pixels; default (0) 1280 x 720 */
    uint32_t slots[NOH_LOD_LEVELS_MAX]; /* of each level's pool, the coarsest last; default (all 0) estimated from the
                                           density of bodies */
    noh_debug_view view;
} crowd_options;

/* Every byte, and the parts of the pack on which it depends. */
typedef struct crowd_plan {
    crowd_options options; /* with the defaults filled in */
    noh_mesh mesh;         /* the full level */
    uint32_t mesh_index;   /* in the pack */
    noh_skin skin;
    uint32_t level_count;
    noh_mesh views[NOH_LOD_LEVELS_MAX]; /* the mesh at each level that has a pool */
    uint32_t pool_levels[NOH_LOD_LEVELS_MAX], slots[NOH_LOD_LEVELS_MAX], pool_count;
    noh_clip_bank_desc bank_desc;
    noh_clip_bank_needs bank_needs;
    noh_gl_morph_desc morph_desc; /* of views and slots */
    noh_gl_morph_plan morph;
    noh_gl_skin_plan skin_plan;
    size_t character_bytes, scratch_bytes, pools_bytes, schedule_bytes, lod_bytes;
    uint64_t cpu_bytes, gpu_bytes;
} crowd_plan;

/* *plan keeps pointers into itself: do not move it. caps: of the GPU that will draw.
 * Prints an error and returns an exit code; 0 on success. */
int crowd_plan_make(crowd_plan *plan, const pack_file *file, const noh_gl_caps *caps, const crowd_options *options);

/* A body beside its noh_character. */
typedef struct crowd_body {
    float world[12]; /* its place: 3 rows of 4 */
    float centre[3]; /* of its bounding sphere over all clips; the radius is the crowd's */
    float scale;     /* pixels per metre at its nearest point */
    int seen, was_seen, shown;
    noh_lod_slot slot;
    uint32_t level, level_before; /* drawn: no finer than the slot's level; the two differ while the body fades */
    uint32_t place;               /* of its palette, in draw order */
} crowd_body;

typedef struct crowd_camera {
    float eye[3], forward[3], right[3], up[3]; /* unit axes */
    float sine[2], cosine[2];                  /* of half the angle of view, across and up */
    noh_gl_camera gl;
} crowd_camera;

typedef struct crowd_events {
    uint64_t count, sum; /* sum of hashes of body, key and time: equal for the same events in any order */
} crowd_events;

typedef struct crowd_stats {
    uint32_t seen, updated, fading;      /* in the last frame */
    uint32_t levels[NOH_LOD_LEVELS_MAX]; /* visible at each level; a fading body counts at its new level */
    noh_gl_morph_stats morph;
} crowd_stats;

typedef struct crowd {
    const crowd_plan *plan;
    gpu *g;
    const pack_file *file;
    noh_gl_ledger ledger; /* of all below */
    size_t used_bytes;    /* of the block */
    /* shared */
    noh_clip_bank *bank;
    noh_clip_set set; /* of the bank, with callback keys where the pack has none; what does not loop plays ping-pong */
    noh_clip_entry *clips;
    noh_event_key *keys;
    noh_skeleton skeleton;                /* with the skin's inverse bind matrices */
    float *inverse_bind, *update_error_m; /* [joint], [clip][NOH_UPDATE_RATE_COUNT] */
    uint32_t first_weight; /* of the mesh, among the floats of the set; NOH_NONE: no clip animates them */
    noh_lod_pack lod;      /* the errors that the pack states */
    noh_lod_table table;   /* the same, with the update rate errors of clips as the crowd plays them */
    noh_lod_settings settings;
    noh_character_scratch scratch;
    noh_schedule schedule;
    noh_lod_pools *pools;
    float sphere[4];         /* of every body, relative to its place */
    float *matrices;         /* [the skin's joint][12] */
    float *floats, *weights; /* [float], [target] */
    /* each */
    uint8_t *characters; /* [count][character_bytes] */
    crowd_body *bodies;  /* [count] */
    uint32_t *order;     /* [count] visible bodies, run by run; fading ones last */
    /* Where each run begins in `order`. A run is the bodies of one mesh level and one number of joints per vertex:
     * level by level, most joints first; the last run is the fading bodies. */
    uint32_t runs[CROWD_RUNS_MAX + 1u];
    int unculled;
    uint32_t frame_ticks;
    crowd_events events;
    crowd_stats stats;
    /* on the GPU */
    noh_gl_mesh gl_mesh;
    noh_gl_texture *pictures; /* [texture_count] */
    noh_gl_morph *morph;
    noh_gl_skin *palettes;
    noh_gl_renderer renderer;
} crowd;

/* memory[bytes]: 16-byte aligned, at least plan->cpu_bytes. Plan, pack and memory must outlive the crowd. Prints an
 * error and returns an exit code, with nothing left open; 0 on success. */
int crowd_open(crowd *c, const crowd_plan *plan, void *memory, size_t bytes, gpu *g, const pack_file *file);
void crowd_close(crowd *c);

noh_character *crowd_character(const crowd *c, uint32_t body);
/* The estimated cost of an update, counted against budget_ns. */
uint32_t crowd_update_cost(const noh_character *ch);

/* Put a body on the ground at x, z, metres, turned about the vertical axis. */
void crowd_move(crowd *c, uint32_t body, float x, float z, float heading_rad);

/* A camera at `eye`; heading 0 looks along -z, down_rad tilts it down. */
crowd_camera crowd_camera_at(const crowd *c, const float eye[3], float heading_rad, float down_rad);
/* 4 m above the middle of the field. */
crowd_camera crowd_camera_start(const crowd *c);

/* The parts of a frame, in this order. */
void crowd_step(crowd *c, uint32_t ticks);
void crowd_look(crowd *c, const crowd_camera *camera);
void crowd_show(crowd *c);
void crowd_send(crowd *c);
/* Draw into the current framebuffer and viewport. */
void crowd_draw(crowd *c, const crowd_camera *camera);

/* ---- private to crowd*.c ---- */

/* Where the library's objects lie in the block. */
typedef struct crowd_parts {
    void *bank, *scratch, *pools, *schedule, *lod, *morph, *palettes;
} crowd_parts;

noh_character_desc crowd_character_desc(const noh_clip_set *set);
noh_lod_pools_desc crowd_pools_desc(const crowd_plan *plan);
/* Lay everything out in the arena; one that only measures (noh_arena_measure) gives the size. */
void crowd_carve(noh_arena *arena, const crowd_plan *plan, crowd *c, crowd_parts *parts);
/* The desc of the LOD table; of a bank that is not made yet, only the counts are needed. */
noh_lod_pack_desc crowd_lod_desc(const crowd_plan *plan, const noh_clip_bank *bank);
/* The number of runs, without that of fading bodies. */
uint32_t crowd_run_count(const crowd *c);
/* Read the pack's LOD errors into memory[plan->lod_bytes], then place the bodies. Prints an error and returns an exit
 * code; 0 on success. */
int crowd_place(crowd *c, void *memory);

#endif
