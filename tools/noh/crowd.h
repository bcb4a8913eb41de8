/* crowd.h: a thousand bodies, with and without detail: how character/ and gl/ go together. Copy it into your game.
 *
 *   crowd_plan_make   every byte, CPU and GPU, before any load
 *   crowd_open        everything, in one block of memory of exactly that size; it never asks for another byte
 *   a frame:
 *     crowd_step      all clocks move on, all callback keys fire
 *     crowd_look      who is seen? how much detail, which memory, in which order?
 *     crowd_show      who is due is posed, within a budget; palettes and weights of who is seen go to the library's GL objects
 *     crowd_send      accumulate and upload
 *     crowd_draw      one draw a submesh and level; whoever changes its level alone, twice, each half its pixels
 *
 * The bodies are a pack's skinned mesh (of several that which targets move most), each with a clip of its own, phase and speed, and a second
 * track that plays a clip of the face. One unit of the pack is a metre, y is up.
 *
 * Without detail (options.plain) the same bodies are posed in every frame, drawn at the full level and with all targets:
 * what detail is held against.
 *
 *   crowd_plan.c   bytes
 *   crowd.c        opening and closing
 *   crowd_place.c  what the pack says of detail; places and clips
 *   crowd_frame.c  a frame on the CPU
 *   crowd_draw.c   a frame on the GPU; the camera */
#ifndef NOH_TOOL_CROWD_H
#define NOH_TOOL_CROWD_H

#include "gpu.h"
#include "pack_file.h"

#define CROWD_RUNS_MAX (NOH_LEVELS_MAX * NOH_DETAIL_LEVELS_MAX)
#define CROWD_FIELD_M 100.0f /* they stand within this of the place where the camera starts */

typedef struct crowd_options {
    uint32_t count;            /* bodies; 1..NOH_MORPH_INSTANCES_MAX */
    int plain;                 /* 1: without detail */
    int unculled;              /* 1: as if all were seen */
    float pixels;              /* the knob; default (0) 1 */
    uint64_t budget_ns;        /* for updates, in each frame; default (0) as much as they take */
    float field_of_view_rad;   /* of the view, vertical; default (0) 40 degrees */
    uint32_t width, height;    /* of the view, pixels; default (0) 1280 x 720 */
    uint32_t slots[NOH_LEVELS_MAX]; /* of each level's pool, the coarsest's last; default (all 0) by how many will stand so near */
    noh_debug_view view;
} crowd_options;

/* The whole of it in bytes; what a plan needs of the pack. */
typedef struct crowd_plan {
    crowd_options options;     /* with the defaults filled in */
    noh_mesh mesh;             /* the full level */
    uint32_t mesh_index;       /* in the pack */
    noh_skin skin;
    uint32_t level_count;
    noh_mesh views[NOH_LEVELS_MAX]; /* the mesh at each level that has a pool */
    uint32_t pool_levels[NOH_LEVELS_MAX], slots[NOH_LEVELS_MAX], pool_count;
    noh_motion_set_desc set_desc;
    noh_motion_set_needs set_needs;
    noh_gl_morph_desc morph_desc; /* of views and slots */
    noh_gl_morph_plan morph;
    noh_gl_skin_plan skin_plan;
    size_t character_bytes, scratch_bytes, pools_bytes, schedule_bytes, detail_bytes;
    uint64_t cpu_bytes, gpu_bytes;
} crowd_plan;

/* *plan keeps pointers into itself: it must stay where it is. caps of the GPU to be.
 * Prints an error and returns an exit code; 0 on success. */
int crowd_plan_make(crowd_plan *plan, const pack_file *file, const noh_gl_caps *caps, const crowd_options *options);

/* A body beside its noh_character. */
typedef struct crowd_body {
    float world[12];   /* where it stands */
    float centre[3];   /* of a sphere that it never leaves; its radius is the crowd's */
    float scale;       /* pixels that a metre of it is high, at its nearest */
    int seen, was_seen, shown;
    noh_level_slot slot;
    uint32_t level, level_before; /* drawn: levels that the slot has room for; two while it fades */
    uint32_t place;    /* its number among the palettes: in the order of drawing */
} crowd_body;

typedef struct crowd_camera {
    float eye[3], forward[3], right[3], up[3]; /* unit axes */
    float sine[2], cosine[2];                  /* of half the angle of view, across and up */
    noh_gl_camera gl;
} crowd_camera;

typedef struct crowd_events {
    uint64_t count, sum; /* sum: of a hash of who, what and when: equal for equal events in any order */
} crowd_events;

typedef struct crowd_stats {
    uint32_t seen, updated, fading; /* of the frame shown last */
    uint32_t levels[NOH_LEVELS_MAX]; /* seen at each level; who fades, at the one that it goes to */
    noh_gl_morph_stats morph;
} crowd_stats;

typedef struct crowd {
    const crowd_plan *plan;
    gpu *g;
    const pack_file *file;
    noh_gl_ledger ledger;         /* of all below */
    size_t used_bytes;            /* of the block */
    /* shared */
    noh_motion_set *set;
    noh_anim_set anim;            /* the set's, with keys where the pack has none; what does not repeat itself goes to and fro */
    noh_motion *motions;
    noh_event_key *keys;
    noh_skeleton skeleton;        /* with the skin's inverse bind matrices */
    float *inverse_bind, *rate_error_m; /* [joint], [motion][NOH_RATE_COUNT] */
    uint32_t first_weight;        /* of the mesh, among the floats of the set; NOH_NONE: no clip knows them */
    noh_detail_pack detail;       /* what the pack says */
    noh_detail_table table;       /* the same, with the errors of rates as the motions are played here */
    noh_detail_settings settings;
    noh_character_scratch scratch;
    noh_schedule schedule;
    noh_level_pools *pools;
    float sphere[4];              /* of every body, from where it stands */
    float *matrices;              /* [the skin's joint][12] */
    float *floats, *weights;      /* [float], [target] */
    /* each */
    uint8_t *characters;          /* [count][character_bytes] */
    crowd_body *bodies;           /* [count] */
    uint32_t *order;              /* [count] who is seen, run by run; who fades behind them */
    uint32_t runs[CROWD_RUNS_MAX + 1u]; /* where each run begins in it: those of one mesh level and one number of joints per vertex,
                                         * level by level, within each the most joints first; the last: those who fade */
    int unculled;
    uint32_t frame_ticks;
    crowd_events events;
    crowd_stats stats;
    /* on the GPU */
    noh_gl_mesh gl_mesh;
    noh_gl_texture *pictures;     /* [texture_count] */
    noh_gl_morph *morph;
    noh_gl_skin *palettes;
    noh_gl_renderer renderer;
} crowd;

/* Open it in memory[bytes], 16-byte aligned, plan->cpu_bytes long. The plan, the pack and the memory stay with it.
 * Prints an error and returns an exit code; 0 on success, else nothing is left open. */
int crowd_open(crowd *c, const crowd_plan *plan, void *memory, size_t bytes, gpu *g, const pack_file *file);
void crowd_close(crowd *c);

noh_character *crowd_character(const crowd *c, uint32_t body);
/* What an update of it costs, of budget_ns. */
uint32_t crowd_update_cost(const noh_character *ch);

/* Put a body somewhere else: metres on the ground, a turn about the vertical. */
void crowd_move(crowd *c, uint32_t body, float x, float z, float heading_rad);

/* At `eye`, turned by so much from looking along -z, and down. */
crowd_camera crowd_camera_at(const crowd *c, const float eye[3], float heading_rad, float down_rad);
/* Over the heads, where the field begins. */
crowd_camera crowd_camera_start(const crowd *c);

void crowd_step(crowd *c, uint32_t ticks);
void crowd_look(crowd *c, const crowd_camera *camera);
void crowd_show(crowd *c);
void crowd_send(crowd *c);
/* Into the framebuffer and viewport that are set. */
void crowd_draw(const crowd *c, const crowd_camera *camera);

/* ---- private to crowd*.c ---- */

/* What the library builds in the block. */
typedef struct crowd_parts {
    void *set, *scratch, *pools, *schedule, *detail, *morph, *palettes;
} crowd_parts;

noh_character_desc crowd_character_desc(const noh_anim_set *set);
noh_level_pools_desc crowd_pools_desc(const crowd_plan *plan);
/* Where everything lies in the block; NULL: how much it takes. */
void crowd_carve(noh_arena *arena, const crowd_plan *plan, crowd *c, crowd_parts *parts);
/* What the pack says of a set's detail: of the one that is there, or will be. */
noh_detail_pack_desc crowd_detail_desc(const crowd_plan *plan, const noh_motion_set *set);
/* How many runs there may be, but for those who fade. */
uint32_t crowd_run_count(const crowd *c);
/* Detail out of the pack, in memory[plan->detail_bytes]; then everybody takes his place. Prints an error and returns an exit code. */
int crowd_place(crowd *c, void *memory);

#endif
