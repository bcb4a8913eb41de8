/* stage_internal.h: what a stage is made of.
 *
 *   stage_desc.c     a desc with its defaults filled in; what is wrong with one
 *   stage_levels.c   the levels of an actor, and how many slots each has
 *   stage_carve.c    the block laid out
 *   stage_plan.c     bytes, and what is given up to keep a bound
 *   stage.c          made in its block, and deleted
 *   stage_kind.c     what the actors of a kind share
 *   stage_slot.c     kinds that come and go
 *   stage_layers.c   layers and their masks
 *   stage_names.c    clips, layers, floats and joints by name
 *   stage_actor.c    actors come and go, and stand somewhere
 *   stage_play.c     layers
 *   stage_module.c   the slots of a kind's modules (module_internal.h)
 *   stage_wear.c     garments
 *   stage_modifier.c what changes a pose before it is shown
 *   stage_step.c     time, callback keys, root motion
 *   stage_bounds.c   possible and present bounds of an actor, and its distance
 *   stage_look.c     phase 1: which actors are visible, at which level
 *   stage_share.c    between the phases: slots, updates, decoding, order
 *   stage_pose.c     phase 2: poses and floats
 *   stage_frame.c    the phases of a frame
 *   stage_ask.c      joints, spheres, floats
 *   stage_pick.c     a ray
 *   stage_load.c     levels that come later
 *   stage_state.c    state out and in
 *   view.c           cameras
 *
 * None of these names a module: stage_graph*.c, stage_face*.c and stage_person.c, stage_ragdoll.c, stage_get_up.c and
 * fall.c, springs.c, stage_match.c; nor stage_feet.c and stage_gaze.c (tests/check_modules.sh).
 *
 * The block has three parts. The state comes first: all that time or the game changes, without pointers. What is
 * derived from desc and packs follows, then what a frame writes for its own use. */
#ifndef NOH_STAGE_STAGE_INTERNAL_H
#define NOH_STAGE_STAGE_INTERNAL_H

#include "core/base/compiler_internal.h"
#include "core/base/assert_internal.h"
#include "motion/anim/clip_set_internal.h"
#include "stage/character/lod_pools_internal.h"
#include "stage/character/scheduler_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/low_stage.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "stage/cast/module_internal.h"
#include "life/reach/feet_internal.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- state ---- */

typedef struct noh_stage_held {
    uint32_t index;      /* of the float */
    float value, amount; /* amount 0: free */
} noh_stage_held;

typedef struct noh_stage_actor {
    noh_root_pose moved; /* by the last step */
    noh_place place;     /* normalised */
    noh_place before;    /* at the end of the step before the last one */
    noh_appearance look;
    uint32_t generation;
    uint32_t alive;
    uint32_t next_free;  /* index + 1; 0: the last */
    uint32_t parent;     /* id; 0: not attached */
    uint32_t joint;      /* of the parent; NOH_STAGE_WORN: the actor is worn, and has no joint of it */
    uint16_t was_seen;   /* in how many of the last frames, at most 3 */
    uint16_t on_its_way; /* 1: `before` belongs to the current or the next step */
    uint32_t started[2]; /* for each layer four bits: the track that was started last, of the layer's own */
    uint32_t reserved;
    /* What the floats of `place` and `before` are short of: without it an actor a million units out stands still */
    float rest[3], rest_before[3], rotation_rest[4];
    double home[3]; /* near it: what its parts keep of the world counts from there */
} noh_stage_actor;

#define NOH_STAGE_WORN NOH_NONE

/* Such that it, its inverse and their cubes are floats in full precision. */
static inline int noh_is_scale(float scale)
{
    return scale >= 1.0f / NOH_NUMBER_MAX && scale <= NOH_NUMBER_MAX;
}

/* Keep a place that has moved, or that comes from other places, within what states may have. */
void noh_stage_keep_within(noh_place *place, float rest[3]);

/* [4] as it is drawn; NULL: white. */
static inline const uint8_t *noh_stage_tint_of(const noh_stage_actor *a)
{
    const uint8_t *t = a->look.tint;
    return t[0] | t[1] | t[2] | t[3] ? t : NULL;
}

/* Before the states of the modules that change an actor's poses. */
typedef struct noh_stage_modifier_head {
    int64_t posed_clock; /* of the pose that they are at */
    uint32_t was_posed;
    uint32_t reserved;
} noh_stage_modifier_head;

typedef struct noh_stage_free {
    uint32_t first, last; /* actor index + 1; 0: none. Taken at the front, given back at the end */
    uint32_t count;       /* actors that are there */
    uint32_t reserved;
} noh_stage_free;

typedef struct noh_stage_head {
    uint32_t magic, hash;
    int64_t clock;
    uint32_t step_ticks;   /* of the last step */
    uint32_t behind_ticks; /* what the last frame shows lies so far behind the clock */
    noh_stage_free kinds[NOH_STAGE_KINDS_MAX];
} noh_stage_head;

NOH_STATIC_ASSERT(sizeof(noh_place) == 32, place);
NOH_STATIC_ASSERT(sizeof(noh_appearance) == 44, look);
NOH_STATIC_ASSERT(sizeof(noh_stage_actor) == 240, stage_actor);
NOH_STATIC_ASSERT(sizeof(noh_stage_modifier_head) == 16, stage_modifier_head);
NOH_STATIC_ASSERT(sizeof(noh_stage_head) == 24 + 16 * NOH_STAGE_KINDS_MAX, stage_head);

NOH_STATIC_ASSERT(sizeof(noh_kind_clips) == 48, kind_clips); /* compared as bytes */

#define NOH_STAGE_MAGIC 0x53484f4eu /* "NOHS" */

/* ---- kinds ---- */

/* A mesh that a kind draws, and the node that places it. */
typedef struct noh_stage_item {
    uint32_t node, mesh; /* node: NOH_NONE in a pack without nodes */
} noh_stage_item;

typedef struct noh_stage_mesh {
    noh_mesh mesh; /* the full one */
    noh_skin skin; /* where `skinned` */
    noh_stage_item item;
    float bind_stretch;      /* where `skinned`: the most that an inverse bind matrix stretches what a target adds */
    uint32_t finer_hash;     /* of the levels of noh_kind_desc.finer that the plan has: see noh_stage_hash_levels */
    const float *node_world; /* [12] of a rigid mesh */
    const float *defaults;   /* [target_count] weights */
    uint32_t first_float;    /* of its targets, among the kind's floats */
    uint32_t first_weight;   /* of its targets, among the kind's weights */
    int skinned;
} noh_stage_mesh;

typedef struct noh_stage_layer {
    const char *name;
    uint32_t mode, first_track, track_count;
    uint32_t mask;    /* 1 + index in the set; 0: none */
    int moves_joints; /* 0: its mask has no joint */
} noh_stage_layer;

typedef enum noh_stage_load {
    NOH_STAGE_DROPPED = 0, /* or never brought */
    NOH_STAGE_LOADING,
    NOH_STAGE_LOADED
} noh_stage_load;

/* Floats of a kind: the floats of the set, then, if the pack has no nodes, one for each target. */
typedef struct noh_stage_floats {
    uint32_t *sources;      /* [float_count] the float whose value it takes: itself, or one of the same name that a clip
                             * moves */
    uint32_t first_renamed; /* the first whose source is another; float_count: none */
    uint32_t *name_hashes;  /* [float_count] */
    float *defaults;        /* [float_count] */
} noh_stage_floats;

/* What the meshes of a kind say of their targets, bound to the kind's floats. */
typedef struct noh_stage_targets {
    noh_corrective_term *correctives; /* [corrective_count] */
    noh_weight_rule *weight_rules;    /* [weight_rule_count] */
    uint32_t corrective_count, weight_rule_count;
} noh_stage_targets;

/* What comes later: levels or, in a slot, all of the kind. */
typedef struct noh_stage_finer {
    uint32_t kind;        /* the kind whose finer levels it shares: itself, or an earlier one; NOH_NONE: none come */
    noh_stage_load state; /* of `kind` */
    const noh_pack *from; /* NULL: none */
    int hidden;           /* 1: until all of the kind is uploaded to its slot */
} noh_stage_finer;

/* Where no clip fits: a set of one clip that is the bind pose. */
typedef struct noh_stage_still {
    noh_clip_entry clip;
    noh_transform pose; /* of a kind without joints */
} noh_stage_still;

typedef struct noh_stage_kind {
    /* Defaults filled in; `layers`, `modifiers` and modules are empty afterwards. actor_count 0: an empty slot */
    noh_kind_desc *desc;
    const noh_kind_plan *plan;
    uint32_t first_actor;
    uint32_t bank_kind; /* the kind whose bank it shares: itself, or an earlier one */
    noh_clip_bank_desc bank_desc;
    noh_clip_bank *bank;   /* NULL: no clip fits */
    int holds_all;         /* of bank_kind: 1: its cache has all segments of all clips decoded */
    noh_clip_set set;      /* with the kind's masks; samples through the bank's own cache */
    noh_stage_still still; /* without a bank: its clip */
    noh_skeleton skeleton;
    noh_stage_layer *layers; /* [layer_count] */
    uint32_t layer_count;
    noh_stage_mesh *meshes;             /* [plan->mesh_count] */
    uint32_t float_count, weight_count; /* weights: targets of all meshes */
    noh_stage_floats named;
    noh_stage_targets targets;
    float *target_radii; /* [weight_count] */
    uint8_t *masks;      /* [set.mask_count][joints + floats of the set] */
    /* [kinds in desc->worn_by][joints, then floats]: what each follows of the wearer, or NOH_JOINT_ROOT */
    uint16_t *worn_maps;
    noh_lod_pack lod;     /* of the first skinned mesh */
    noh_lod_mesh *levels; /* [plan->level_count] */
    noh_lod_table table;
    uint32_t first_there; /* the finest level that `desc.mesh` has, and the plan */
    noh_stage_finer finer;
    float *joint_radii; /* [joint_count] with all weights 0; NULL: rigid */
    float reach[4];     /* centre and radius in model space: holds the actor in any pose of its clips, with their
                         * weights, and all of 0..1 */
    float rest[6];      /* what joints move in the bind pose; its smallest above its largest: nothing */
    uint32_t character_bytes;
    noh_stage_module modules[NOH_SLOT_COUNT];
    size_t modifier_bytes; /* of the states of an actor's modules but the source, with their head; 0: none */
    /* state */
    uint8_t *characters; /* [actor_count][character_bytes] */
    noh_stage_actor *actors;
    noh_stage_held *held;     /* [actor_count][held_float_count] */
    uint8_t *modifier_states; /* [actor_count][modifier_bytes] */
    noh_lod_pools *pools;     /* NULL: nothing is drawn */
    /* a frame's own */
    float *floats;   /* [actor_count][float_count] as shown, or as they would be */
    float *weights;  /* [actor_count][weight_count] the same, without targets too small to see */
    uint32_t *order; /* [visible_max] seen actors by run; fading ones last */
    /* where each run begins in `order`. A run has one level and one number of influences; the last one fades */
    uint32_t runs[NOH_LOD_LEVELS_MAX * 4u + 2u];
} noh_stage_kind;

/* Where kinds that change lie. */
typedef struct noh_stage_slot {
    uint8_t *state, *own; /* [room.state_bytes], [room.kind_bytes] of the plan; NULL: the kind stays */
    uint8_t *views;       /* of the first job */
    uint32_t hash;        /* of the kind that is there; 0: none */
    uint32_t used;        /* bytes of `state` that are the kind's */
} noh_stage_slot;

/* Of a stage in which a kind changes. */
typedef struct noh_stage_slots {
    noh_stage_plan plan; /* of the kinds that are there */
    size_t views_bytes;  /* from the views of a job to the next job's */
    noh_stage_slot of[NOH_STAGE_KINDS_MAX];
} noh_stage_slots;

/* ---- a frame ---- */

typedef struct noh_stage_shown {
    float world[12];
    float scale;    /* pixels per unit of the world, at its nearest point, in the view that is nearest */
    float distance; /* of its sphere's centre from the eye, in the view in which that is nearest */
    uint16_t views; /* a bit for each view that sees it */
    uint16_t place; /* in its kind's order */
    uint32_t frame; /* the number of the last frame in which it was shown: its floats and pose are of then */
    noh_lod_slot slot;
    uint8_t due;                 /* noh_due, or NOH_STAGE_DUE_LONG */
    uint8_t updates;             /* 1: is posed in this frame; NOH_STAGE_MOVED: its palettes changed */
    uint8_t level, level_before; /* drawn */
    uint16_t worn;               /* 1 + the first garment on it that is posed or shown in this frame; 0: none */
    uint16_t next_worn;          /* of a garment: 1 + the next one on its wearer; 0: the last */
    uint8_t cover;               /* what draws: 1 + the set of garments that hides parts of it; 0: none */
    uint8_t look;                /* while places are given: the number of its look */
} noh_stage_shown;

#define NOH_STAGE_MOVED 2u
#define NOH_STAGE_DUE_LONG 3u /* at once, as the frame was long; it was in view in the one before, so parts go on */
#define NOH_STAGE_CARRIES 4u  /* something is attached to it: from the beginning of a frame until updates are chosen */

typedef struct noh_stage_job_part {
    noh_clip_bank_view *views[NOH_STAGE_KINDS_MAX]; /* of the kinds that have a bank of their own */
    void *scratch, *module_scratch;
    float *matrices;       /* [joints of the largest skin][12] */
    noh_transform *wearer; /* [joints of the largest kind that wears something] the local pose of a wearer */
    uint64_t decoded_late;
    uint32_t updated;
    float error_pixels;
} noh_stage_job_part;

/* An actor of a blended pass. */
typedef struct noh_stage_far {
    float distance; /* squared */
    uint32_t actor;
} noh_stage_far;

typedef enum noh_stage_phase {
    NOH_STAGE_IDLE = 0,
    NOH_STAGE_STEPPING,
    NOH_STAGE_BEGUN, /* the look phase is next */
    NOH_STAGE_LOOKING,
    NOH_STAGE_POSING,
    NOH_STAGE_POSED /* no phase is left */
} noh_stage_phase;

typedef struct noh_view_planes {
    float planes[4]
                [4]; /* left, right, bottom, top: inside where the dot product with (x, y, z, 1) is at least 0; unit */
    float eye_plane[4];   /* w of clip space, its gradient's length in `w_slope` */
    float w_slope, scale; /* scale / w is pixels per unit */
    float eye[3];         /* of a parallel view the game's */
    float near_w;         /* w of the near plane, above 0: nothing nearer is drawn */
    float corner;         /* the cosine of the angle between the middle of the picture and its farthest corner */
    int is_light;
} noh_view_planes;

struct noh_stage {
    noh_stage_desc desc;        /* defaults filled in; `kinds` are those below */
    noh_kind_desc *kind_descs;  /* [desc.kind_count] */
    const noh_stage_plan *plan; /* with slots: slots->plan */
    noh_stage_slots *slots;     /* NULL: no kind changes */
    noh_stage_kind *kinds;      /* [desc.kind_count] */
    uint32_t actor_count;       /* of all kinds */
    uint32_t wearer_joints;     /* of the largest kind that wears something; 0: none does */
    /* state */
    noh_stage_head *head;
    uint8_t *state;
    size_t state_bytes;
    noh_stage_actor *actors; /* [actor_count], kind after kind */
    /* a frame's own */
    noh_stage_shown *shown; /* [actor_count] */
    uint32_t *todo;         /* [actor_count] those that a pose job looks at */
    uint32_t todo_count;
    noh_stage_event *events;
    uint32_t events_held;
    noh_schedule schedule;
    noh_stage_job_part *jobs; /* [job_count] */
    size_t scratch_bytes, module_scratch_bytes;
    uint32_t phase, frame, callback_actor; /* id while on_key runs, else 0 */
    int callback_of_source;                /* the key is one of what the actor's source plays */
    int source_begun;                      /* by a callback of this step */
    noh_stage_event_fn on_key;
    void *on_key_user;
    noh_stage_far *by_distance;                /* [actor_count] with desc.sort_blended: while a pass is sorted */
    noh_stage_view views[NOH_STAGE_VIEWS_MAX]; /* less `origin`, as everything is that a frame makes */
    float origin[3];                           /* of the last frame: noh_view_origin */
    double shifted[3];                         /* by all noh_stage_shift_origin so far */
    noh_view_planes planes[NOH_STAGE_VIEWS_MAX];
    uint32_t view_count;
    int cut;
    noh_stage_stats stats;
    void *pick_scratch, *inertia_scratch;
    size_t pick_bytes, inertia_bytes;
    void *gpu; /* of desc.gpu; NULL without */
};

/* Whether an actor's level is given, not chosen, and all else is in full. */
static inline int noh_stage_is_full(const noh_stage *s, const noh_stage_actor *a)
{
    return s->desc.full_detail || a->look.level;
}

typedef struct noh_stage_list noh_stage_list;

/* ---- what draws ---- */

/* The functions that make a stage drawable. There is one such table, noh_stage_on_gl; a program that does not name it
 * links no GL code. */
struct noh_stage_gpu {
    noh_result (*measure)(const noh_stage_desc *desc, const struct noh_gl_caps *caps, noh_stage_plan *plan,
                          uint64_t *cpu_bytes, uint64_t *gpu_bytes, noh_error *error); /* writes plan->morph_path */
    void (*parts)(const noh_stage_desc *desc, const struct noh_gl_caps *caps, const noh_stage_plan *plan,
                  noh_stage_list *list);
    /* desc: with `others` */
    noh_result (*init)(void *memory, size_t bytes, const void *device, const noh_stage_desc *desc, noh_stage *stage,
                       noh_error *error);
    void (*destroy)(noh_stage *stage);
    noh_result (*restore)(noh_stage *stage, noh_error *error);
    void (*pose)(noh_stage *stage, noh_stage_kind *kind, uint32_t index,
                 float *matrices); /* of an actor that is seen, in a job: its palettes into memory of its own */
    void (*upload)(noh_stage *stage);
    /* Levels that are loaded later, of all meshes of the kinds with this load_kind. `load` uploads a piece, from the
     * start if `restart`, subtracts the bytes sent and returns 1 once all are there. `use` draws with or without them.
     */
    int (*load)(noh_stage *stage, uint32_t load_kind, int restart, uint32_t *bytes);
    void (*use)(noh_stage *stage, uint32_t load_kind, int loaded);
    /* Slots. `room` writes what draws the only kind of a desc; where plan->morph_path is 0, the one that its targets take
     * becomes the stage's. `open` makes what draws a kind that came into its slot, `fill` uploads a piece as `load` does,
     * `close` deletes all. */
    noh_result (*room)(const noh_stage_desc *desc, const struct noh_gl_caps *caps, noh_stage_plan *plan,
                       noh_kind_room *room, noh_error *error);
    noh_result (*open)(noh_stage *stage, uint32_t kind, noh_error *error);
    int (*fill)(noh_stage *stage, uint32_t kind, uint32_t *bytes);
    void (*close)(noh_stage *stage, uint32_t kind);
    /* After a frame: a piece of the levels of textures that it needs; subtracts the bytes sent. */
    void (*stream)(noh_stage *stage, uint32_t *bytes);
};

/* ---- private calls ---- */

/* A desc's kind with its defaults filled in; the number of its drawn meshes into items[NOH_STAGE_MESHES_MAX] (NULL:
 * only count). */
noh_kind_desc noh_stage_kind_desc(const noh_stage_desc *desc, uint32_t kind);
uint32_t noh_stage_items(const noh_kind_desc *kind, noh_stage_item *items);
/* The axes of a kind's root motion: root_axes without NOH_ROOT_BY_GAME. */
static inline uint32_t noh_stage_root_axes(const noh_kind_desc *kind)
{
    return kind->root_axes & ~NOH_ROOT_BY_GAME;
}
/* The texture that stands for one of the kind's mesh pack in a set, 0 its own: its pack, and its index there. */
uint32_t noh_stage_worn(const noh_kind_desc *kind, uint32_t set, uint32_t texture, const noh_pack **pack);
/* Of a pack's mesh, with the levels that the plan may have: noh_kind_desc.finer, else `mesh`. */
noh_mesh noh_stage_whole_mesh(const noh_kind_desc *kind, uint32_t mesh);
/* What is wrong with the `finer` of a kind; NULL: nothing. */
const char *noh_stage_bad_finer(const noh_kind_desc *kind);
/* The kind whose finer levels a kind shares, itself or an earlier one. */
uint32_t noh_stage_load_kind(const noh_stage_desc *desc, uint32_t kind);
/* A hash of what sizes depend on in a level of a mesh and all coarser ones: equal wherever they lie. */
uint32_t noh_stage_hash_levels(const noh_mesh *mesh, uint32_t level);
void noh_stage_open_load(const noh_stage *s, const noh_stage_desc *desc, uint32_t kind);
void noh_stage_load_piece(noh_stage *s); /* in a frame, after all else was handed over */
noh_result noh_stage_check_desc(const noh_stage_desc *desc, noh_error *error);
/* As the kind with this number. */
noh_result noh_stage_check_kind(const noh_stage_desc *desc, const noh_kind_desc *d, uint32_t number, noh_error *error);
/* The most actors that a kind, or what takes its slot, has by its desc. */
uint32_t noh_stage_slot_actors(const noh_kind_desc *kind);
noh_stage_desc noh_stage_desc_filled(const noh_stage_desc *desc);
uint32_t noh_stage_layer_tracks(const noh_layer_desc *layer);
uint32_t noh_stage_track_count(const noh_kind_desc *kind);
uint32_t noh_stage_controller_flags(const noh_kind_desc *kind);
extern const noh_layer_desc noh_stage_default_layers[3];

/* The kind whose bank, or whose meshes on the GPU, a kind shares: itself or an earlier one. */
uint32_t noh_stage_bank_kind(const noh_stage_desc *desc, uint32_t kind);
noh_clip_bank_desc noh_stage_bank_desc(const noh_stage_desc *desc, const noh_stage_plan *plan, uint32_t kind);

#define NOH_STAGE_UP 1u             /* y: the axis of an actor's heading */
#define NOH_STAGE_VIEW_RAD 0.69813f /* of the view that plans count for: 40 degrees */

/* The levels of a kind's actors, and their slots by an even spread. */
noh_result noh_stage_find_levels(const noh_stage_desc *desc, uint32_t kind, noh_kind_plan *plan, noh_error *error);
void noh_stage_share_slots(const noh_stage_desc *desc, uint32_t kind, noh_kind_plan *plan);
float noh_stage_mesh_error(const noh_mesh *mesh, uint32_t level);

/* What a kind's objects need, by the counts of its clips. */
typedef struct noh_stage_needs {
    uint32_t kind;
    noh_clip_set shape; /* counts only */
    size_t bank_bytes;  /* 0: it shares another kind's, or no clip fits */
    size_t view_bytes;  /* of that bank */
    size_t character_bytes, scratch_bytes, lod_bytes, pools_bytes, inertia_bytes;
    noh_module_needs modules[NOH_SLOT_COUNT];
    size_t modifier_bytes, module_scratch_bytes;
    uint32_t corrective_count, weight_rule_count;
    uint32_t cached_segment_count, segment_count;
    uint32_t mesh_count, float_count, weight_count, mask_count;
    uint32_t skin_joints; /* of its largest skin */
    size_t pick_bytes;
    int has_clips;
} noh_stage_needs;

/* Read the clips of a kind that has a bank of its own. */
noh_result noh_stage_measure_clips(const noh_stage_desc *desc, const noh_stage_plan *plan, uint32_t kind,
                                   noh_kind_clips *clips, noh_error *error);
/* By what the plan says of its clips. */
noh_result noh_stage_measure_kind(const noh_stage_desc *desc, const noh_stage_plan *plan, uint32_t kind,
                                  noh_stage_needs *needs, noh_error *error);

/* The plan of a kind before anything is given up; with `needs`. */
noh_result noh_stage_plan_kind(const noh_stage_desc *desc, uint32_t kind, noh_stage_plan *plan, noh_stage_needs *needs,
                               noh_error *error);
uint32_t noh_stage_mix(uint32_t hash, uint64_t value);
/* Of what the meaning of a kind's state depends on, continued. */
uint32_t noh_stage_hash_kind(uint32_t hash, const noh_stage_desc *desc, const noh_stage_plan *plan, uint32_t kind);

/* Where everything lies; what an arena that only measures gives is NULL. */
typedef struct noh_stage_blocks {
    noh_stage *stage;
    noh_stage_kind *kinds;
    noh_kind_desc *kind_descs;
    noh_stage_slots *slots;
    noh_stage_head *head;
    size_t state_bytes;
    noh_stage_actor *actors;
    noh_stage_shown *shown;
    uint32_t *todo;
    noh_stage_far *by_distance;
    noh_wanted_clip *wanted;
    noh_stage_event *events;
    noh_stage_job_part *jobs;
    uint8_t *views;   /* of all jobs, of all banks, one after another */
    uint8_t *scratch; /* of all jobs */
    uint8_t *module_scratch;
    size_t module_scratch_bytes, scratch_bytes, views_bytes, pick_bytes, inertia_bytes;
    float *matrices; /* of all jobs */
    size_t matrices_floats;
    noh_transform *wearers; /* of all jobs */
    uint32_t wearer_joints;
    void *pick_scratch, *inertia_scratch, *schedule;
    struct noh_stage_kind_blocks {
        void *bank, *lod, *pools;
    } of[NOH_STAGE_KINDS_MAX];
} noh_stage_blocks;

typedef struct noh_stage_kind_blocks noh_stage_kind_blocks;

/* Lay a stage out, without what draws it. parts[capacity] receives the bytes by part (capacity 0: not wanted); *count
 * how many there are. */
struct noh_stage_list {
    noh_stage_bytes *parts;
    uint32_t capacity, count;
    uint64_t cpu_bytes; /* of all, those past the capacity too */
};

noh_result noh_stage_carve(noh_arena *arena, const noh_stage_desc *desc, const noh_stage_plan *plan,
                           noh_stage_blocks *blocks, noh_stage_list *list, noh_error *error);
void noh_stage_add_part(noh_stage_list *list, const char *what, uint32_t kind, uint64_t cpu_bytes, uint64_t gpu_bytes);
void noh_stage_desc_by_plan(noh_stage_desc *desc, const noh_stage_plan *plan); /* without what the plan gave up */
uint32_t noh_stage_pools(const noh_kind_plan *plan, uint32_t *levels, uint32_t *slots); /* returns how many */

/* ---- slots ---- */

/* What a kind takes, and where it lies in its slot. Not state: from `own`, state: from `state`. */
void noh_stage_room(const noh_stage_desc *desc, const noh_stage_plan *plan, uint32_t kind, const noh_stage_needs *needs,
                    noh_kind_room *room);
noh_result noh_stage_carve_slot(const noh_stage *s, uint32_t kind, noh_stage_kind_blocks *blocks, noh_error *error);
int noh_stage_has_slots(const noh_stage_desc *desc);
/* In plan->kinds: the room of each slot. kinds[0] is used meanwhile. caps: with desc->gpu */
noh_result noh_stage_plan_rooms(const noh_stage_desc *desc, const struct noh_gl_caps *caps, noh_stage_plan *plan,
                                noh_error *error);
/* At init, once all kinds that stay are there: all slots, with what is not absent. */
noh_result noh_stage_open_slots(noh_stage *s, const noh_stage_desc *desc, noh_error *error);
noh_result noh_stage_open_pools(noh_stage *s, uint32_t kind, void *memory, noh_error *error);
void noh_stage_open_actors(noh_stage *s, uint32_t kind);
/* at: of the first job, `stride` bytes before the next job's */
noh_result noh_stage_open_views(noh_stage *s, uint32_t kind, uint8_t *at, size_t stride, noh_error *error);

noh_character_desc noh_stage_character_desc(const noh_stage_kind *kind, uint32_t instance);
noh_result noh_stage_open_kind(noh_stage *s, const noh_stage_desc *desc, uint32_t kind,
                               const noh_stage_kind_blocks *blocks, noh_error *error);
noh_result noh_stage_open_layers(noh_stage_kind *k, uint32_t kind, noh_error *error);

/* An actor that is there, and its kind; NULL: gone. */
noh_stage_actor *noh_stage_actor_of(const noh_stage *s, noh_actor actor, noh_stage_kind **kind);
/* The same for a change: also refuses others within a callback. */
noh_result noh_stage_change(noh_stage *s, noh_actor actor, noh_stage_actor **a, noh_stage_kind **kind,
                            noh_error *error);
noh_stage_kind *noh_stage_kind_of(const noh_stage *s, uint32_t index); /* of an actor's index in the stage */
/* What an actor is attached to; NULL: nothing. From one to the next at most NOH_ATTACH_DEPTH_MAX times. */
noh_stage_actor *noh_stage_parent_of(const noh_stage *s, const noh_stage_actor *a, noh_stage_kind **kind);
/* The one at the end of its attachments: itself, where it has none. */
const noh_stage_actor *noh_stage_root_of(const noh_stage *s, const noh_stage_actor *a);
/* Attachments from an actor to another one that it is attached to, over others or not; 0: it is that one, NOH_NONE: it
 * is not attached to it. */
uint32_t noh_stage_steps_to(const noh_stage *s, const noh_stage_actor *a, const noh_stage_actor *to);
noh_result noh_stage_gone(noh_error *error, noh_actor actor);
/* Its own place as the last frame shows it, its position less `origin`; the place of an attached actor is relative to
 * the joint, and stays so. */
void noh_stage_shown_place(const noh_stage *s, const noh_stage_actor *a, const float origin[3], noh_place *out);
void noh_stage_keep_before(noh_stage_actor *a); /* where it is becomes where it was */
void noh_stage_shift_actor(noh_stage_actor *a, const float by[3]);
/* From an actor's model to what its place is relative to: its place, and what turns the model within it. */
void noh_stage_own_matrix(const noh_stage *s, const noh_stage_kind *k, const noh_stage_actor *a, float matrix[12]);
/* A matrix relative to what an actor is attached to, as its parents were posed last, becomes one of the world, less the
 * stage's origin. Without a parent it is one already. */
void noh_stage_carry(const noh_stage *s, const noh_stage_actor *a, float matrix[12]);
/* Where an actor is drawn: both. */
void noh_stage_world(const noh_stage *s, uint32_t index, float matrix[12]);
/* noh_actor_joint and noh_actor_sphere, less the stage's origin. */
noh_result noh_stage_joint(const noh_stage *stage, noh_actor actor, uint32_t joint, float matrix[12], noh_error *error);
noh_result noh_stage_actor_sphere(const noh_stage *stage, noh_actor actor, float sphere[4], noh_error *error);
/* ---- garments ---- */

/* What an actor is worn by; NULL: it is not worn. */
noh_stage_actor *noh_stage_wearer_of(const noh_stage *s, const noh_stage_actor *a, noh_stage_kind **kind);
const char *noh_stage_bad_worn(const noh_stage_desc *desc, const noh_kind_desc *kind);
size_t noh_stage_worn_maps(const noh_kind_desc *kind); /* how many maps it has */
void noh_stage_open_worn(noh_stage *s, uint32_t kind); /* once all kinds are there: for a kind, or NOH_NONE: for all */
int noh_stage_can_wear(const noh_stage_kind *garment, uint32_t wearer_kind);
/* Whether a joint of the garment follows one of the wearer. */
int noh_stage_fits(const noh_stage *s, const noh_stage_kind *garment, const noh_stage_kind *wearer);
/* What a garment's pack hides of a mesh, which has all levels of its pack; NULL: nothing. */
const noh_pack_cover_header *noh_stage_cover_of(const noh_pack *garment, const noh_mesh *mesh);
/* The kinds of the garments that are seen on an actor and may hide a part of it. */
uint32_t noh_stage_garments_on(const noh_stage *s, uint32_t index);
/* Before places are given: list the garments of each wearer that are posed or shown. */
void noh_stage_link_worn(noh_stage *s);
void noh_stage_update_worn(noh_stage *s); /* and after: they are updated when their wearers are */
/* In a job: the local pose of a garment from job->wearer; its floats after the wearer's. Actors that are not worn stay
 * as they are. */
void noh_stage_wear_pose(const noh_stage *s, const noh_stage_job_part *job, const noh_stage_kind *k, uint32_t index,
                         noh_transform *local);
void noh_stage_wear_palette(const noh_stage *s, const noh_stage_kind *k, uint32_t index);
void noh_stage_wear_floats(const noh_stage *s, const noh_stage_kind *k, uint32_t index);

/* ---- clips that come and go (stage_clips.c) ---- */

const noh_pack *noh_stage_clip_pack(const noh_stage_kind *k, uint32_t clip);
const noh_pack_chunk *noh_stage_clip_chunk(const noh_stage_kind *k, uint32_t clip);
/* From now on no clip is there: of a kind with a reserve, or NOH_NONE: of all. */
void noh_stage_empty_clips(noh_stage *s, uint32_t kind);
void noh_stage_forget_wanted(noh_stage *s, uint32_t kind);
/* After a step: what plays was used. */
void noh_stage_use_clips(noh_stage *s);
/* Whether clips[count] are there, and all that a source would play as one. Those that are not become wanted. NOH_NONE
 * is left out.
 * errors  NOT_FOUND some are absent (where: the kind, need: how many); MEMORY they are several, and too much together
 *         with what plays (where: the kind of the bank, need: bytes): none becomes wanted */
noh_result noh_stage_check_there(noh_stage *s, const noh_stage_kind *k, const uint32_t *clips, uint32_t count,
                                 noh_error *error);
/* Whether all is there that a checked state plays. */
noh_result noh_stage_check_state_clips(noh_stage *s, const uint8_t *state, noh_error *error);

noh_character *noh_stage_character(const noh_stage_kind *kind, uint32_t index);
uint32_t noh_stage_index(const noh_stage_kind *kind, const noh_stage_actor *a); /* in its kind */
void noh_place_matrix(const noh_place *place, float matrix[12]);

uint32_t noh_stage_behind(const noh_stage *s, float alpha); /* ticks behind the last step */

/* One word of a list of names. */
typedef struct noh_stage_word {
    const char *text;
    size_t length;
    int takes_out; /* began with '-' */
    int any_rest;  /* ended with '*' */
} noh_stage_word;

int noh_stage_next_word(const char **list, noh_stage_word *word); /* 0 at the end */
int noh_stage_word_matches(const noh_stage_word *word, const char *name);

uint32_t noh_stage_clip_count(const noh_stage_kind *k); /* of clips that have a name */

/* ---- playing ---- */

typedef struct noh_stage_player {
    noh_stage *s;
    noh_stage_kind *k;
    noh_stage_actor *a;
    const noh_stage_layer *layer;
    uint32_t layer_index;
    uint32_t reference; /* 1 + the clip that an additive one is a difference from; 0: as flags of the play say */
    noh_controller *c;
} noh_stage_player;

noh_result noh_stage_open_player(noh_stage *s, noh_actor actor, uint32_t layer, noh_stage_player *p, noh_error *error);
/* A clip of the set, those that a source plays among them, with a play that was checked. */
noh_result noh_stage_play_clip(noh_stage_player *p, uint32_t clip, const noh_play *play, noh_error *error);
/* A clip alone on a layer from now on; with room for inertia what leaps decays, but for some joints. */
noh_result noh_stage_leap_to(noh_stage *stage, noh_actor actor, uint32_t layer, uint32_t clip, uint32_t ticks,
                             const uint32_t *but, uint32_t but_count, noh_error *error);
/* user: a noh_stage_stepper */
void noh_stage_on_key(void *user, const noh_event *event);
/* `inner` is posed in the detail of `outer`, and as many joints are decoded ahead. */
void noh_stage_follow_lod(noh_controller *inner, const noh_controller *outer);

/* What picking a mesh takes: dual quaternions, from *behind on where they draw it (NULL: not wanted), after what
 * noh_pick needs. */
size_t noh_stage_pick_bytes(const noh_mesh *mesh, size_t *behind);

/* Bind the correctives or the weight rules of all meshes. k->targets has room for them. */
void noh_stage_open_correctives(noh_stage_kind *k, uint32_t term_max);
void noh_stage_open_weight_rules(noh_stage_kind *k, uint32_t rule_max);
void noh_stage_correct(const noh_stage_kind *k, uint32_t index, float *floats);
/* A float of an actor as the game holds it; `value`: without the game. */
float noh_stage_keep_held(const noh_stage_kind *k, uint32_t index, uint32_t target, float value);

/* Where a joint of a local pose stands in model space. Scales are taken along, shear is not. */
void noh_stage_joint_in(const noh_skeleton *skeleton, const noh_transform *local, uint32_t joint, float rotation[4],
                        float at[3]);
static inline void noh_stage_joint_at(const noh_stage_kind *k, const noh_transform *local, uint32_t joint,
                                      float rotation[4], float at[3])
{
    noh_stage_joint_in(&k->skeleton, local, joint, rotation, at);
}
/* The work of an update of a character for a tick of the stage's clock, between its halves. */
void noh_stage_begin_modifiers(const noh_stage *s, const noh_stage_job_part *job, const noh_stage_kind *k,
                               uint32_t index, int64_t clock, noh_character_scratch *scratch, noh_modifier_work *work);
extern const noh_module_type noh_stage_modifiers_type;
/* [desc->modifier_count] NULL: none */
static inline const noh_modifier *noh_stage_modifiers_of(const noh_stage_kind *k)
{
    return k->modules[NOH_SLOT_MODIFIERS].shared;
}
struct noh_kind_feet;
struct noh_feet;
/* A pose is put on the ground: noh_feet_step, from the actor's home. */
void noh_modifier_feet(noh_modifier_work *w, struct noh_feet *feet, const struct noh_kind_feet *f, float seconds,
                       int cut);
/* noh_modifier.refuse of those that use a noh_kind_feet */
const char *noh_modifier_feet_refuse(const void *user, uint32_t job_count);
int noh_modifier_home_moved(const noh_modifier_work *w);

/* After the radii of joints, floats and meshes are there. */
void noh_stage_open_bounds(noh_stage_kind *k, noh_character_scratch *scratch);
/* In model space, of what an actor of the kind shows: its last pose and its floats; before it was posed, at rest. */
void noh_stage_sphere(const noh_stage_kind *k, uint32_t index, float sphere[4]);
/* In model space: where it may be, given its sphere. */
void noh_stage_reach(const noh_stage_kind *k, const float sphere[4], float reach[4]);
void noh_stage_widen(float reach[4], const float sphere[4]); /* about its centre, until it holds the sphere */
void noh_stage_sphere_in_world(const float world[12], const float own[4], float out[4]);
/* Set the scale and the distance of `shown` by its views, its matrix and the actor's sphere.
 * shapes  matrices as in a job */
void noh_stage_measure(const noh_stage *s, const noh_stage_kind *k, uint32_t index, const float own[4],
                       float *matrices);
/* The same from the pose that this frame shows, for queries. Visibility uses the pose of the previous frame. */
void noh_stage_measure_shown(const noh_stage *s, const noh_stage_kind *k, uint32_t index, float *matrices);
/* The error that an actor shows; 0 where no view sees it, or where it is posed for the game. */
float noh_stage_error_pixels(const noh_stage *s, const noh_stage_kind *k, uint32_t index);
/* Units of the world in one of the actor's model. */
float noh_stage_size(const noh_stage *s, const noh_stage_actor *a);
/* An actor's floats as its last pose, the game, the pack's rules and correctives have them. */
void noh_stage_take_floats(const noh_stage_kind *k, uint32_t index);
/* After noh_character_skin for the n-th mesh of an actor, whose weights are taken: noh_mesh_move_far_joints at one of the
 * actor's levels. */
void noh_stage_move_far_joints(const noh_stage_kind *k, uint32_t index, uint32_t mesh, uint32_t level, float *matrices);

void noh_stage_look_at(noh_stage *s, uint32_t job, uint32_t first, uint32_t end);
void noh_stage_share(noh_stage *s);
void noh_stage_pose_todo(noh_stage *s, uint32_t job, uint32_t first, uint32_t end);
uint32_t noh_stage_influence_levels(const noh_stage_kind *k); /* at least 1: a run is a level and one of these */
uint32_t noh_stage_run_count(const noh_stage_kind *k);        /* without the run of fading actors */
uint32_t noh_stage_seen(const noh_stage_kind *k);             /* entries in `order` */
void noh_view_planes_of(const noh_stage_view *view, noh_view_planes *out);
/* Where a frame with this camera reckons from, and what is relative to there. A shadow's view has no rest: its matrix
 * is what noh_lighting_shadow takes too. */
void noh_view_origin(const noh_stage_view *view, float origin[3]);
void noh_view_less(const noh_stage_view *view, const float origin[3], noh_stage_view *out);
void noh_projection_less(float view_projection[16], const float origin[3], const float rest[4]);

#ifdef __cplusplus
}
#endif

#endif
