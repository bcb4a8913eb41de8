/* stage.h: a cast of characters out of one block of memory.
 *
 * A stage owns what its characters need: clips and their caches, poses, morph targets and palettes on the GPU. A game
 * says what it wants (noh_stage_desc) and is told every byte (noh_stage_plan_make), before anything is loaded. It
 * brings the block, and from then on spawns, plays, steps and draws. Nothing is allocated after init.
 *
 *   plan     noh_stage_plan_make, noh_stage_plan_parts, noh_stage_init, noh_stage_delete, noh_stage_restore,
 *            noh_stage_plan_of, noh_stage_stats_of
 *   names    noh_stage_find, noh_stage_name
 *   actors   noh_stage_spawn, noh_stage_despawn, noh_stage_actor_at, noh_actor_set_place, noh_actor_place,
 *            noh_actor_place_between, noh_actor_cut, noh_actor_set_look, noh_actor_attach
 *   play     noh_actor_play, noh_actor_stop, noh_actor_track, noh_actor_controller, noh_actor_hold_float
 *   graphs   noh_actor_play_graph, noh_actor_set_parameter, noh_actor_parameter, noh_actor_state, noh_stage_find_value,
 *            noh_actor_graph
 *   ask      noh_actor_floats, noh_actor_joint, noh_actor_root, noh_actor_sphere, noh_actor_mesh_at,
 *            noh_actor_detail_of, noh_stage_pick
 *   frame    noh_stage_frame; or its pieces noh_stage_step, noh_stage_frame_begin or noh_stage_frame_between,
 *            noh_stage_jobs, noh_stage_job, noh_stage_frame_end; noh_stage_events
 *   levels   noh_stage_load_level, noh_stage_drop_level
 *   state    noh_stage_state, noh_stage_set_state, noh_stage_hash
 *
 * Drawing is stage_gl.h. A program that does not name noh_stage_on_gl links no GL code: a server steps and poses.
 *
 * Space     a place is in the game's units, and a model unit is one of them at scale 1. LOD counts a unit as a metre.
 *           y is up unless a kind says otherwise. Matrices are 3 rows of 4, position = rows * (x, y, z, 1).
 * Time      ticks of 1/48,000 s (NOH_TICKS_PER_SECOND).
 * Threads   a stage belongs to one thread at a time; noh_stage_job alone may be called from several at once. Stages
 *           that share packs share nothing that changes.
 * Errors    a failed call changes nothing. An actor that is gone is NOH_ERR_NOT_FOUND, never another actor. */
#ifndef NOH_STAGE_STAGE_H
#define NOH_STAGE_STAGE_H

#include "motion/anim/controller.h"
#include "motion/anim/root_motion.h"
#include "core/base/limits.h"
#include "stage/character/lod.h"
#include "core/pack/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- what is wanted ---- */

typedef enum noh_layer_mode {
    NOH_LAYER_BASE = 0, /* blended with the other base layers by weight, joint by joint */
    NOH_LAYER_OVER,     /* covers the base layers where its mask lets it, by its weight; layers over the same joints
                         * are blended with each other */
    NOH_LAYER_ADD       /* adds its difference from the clip's first frame, or from another pose (noh_play) */
} noh_layer_mode;

/* One thing that an actor can do at a time: walk, wave, talk. */
typedef struct noh_layer_desc {
    const char *name; /* required; borrowed */
    noh_layer_mode mode;
    const char *joints;   /* names of joints, each with all below it, separated by blanks; '-' before one takes it and
                           * all below out again: "spine_02 -clavicle_l". "": none; default (NULL) all. Read at init */
    const char *floats;   /* names of floats; '*' at the end matches any rest, '-' takes out again. "": none; default
                           * (NULL) all. Read at init */
    uint32_t track_count; /* clips at one time, 1..8; default (0) 2, so that one fades into another */
} noh_layer_desc;

/* Textures in place of those of a kind's mesh pack: of each the one in `pack` that has its name with `suffix` behind. A
 * texture without such a namesake stays. One of `mesh` takes no bytes; one of another pack is on the GPU once. */
typedef struct noh_texture_set {
    const char *name;     /* for noh_stage_find; default (NULL) "" */
    const noh_pack *pack; /* default (NULL) the kind's mesh. Its bytes must outlive the stage */
    const char *suffix;   /* "_red"; default (NULL) "" */
} noh_texture_set;

struct noh_stage_part;
struct noh_kind_face;
struct noh_kind_ragdoll;

/* A kind of character: the meshes of one skeleton and the clips that move them. Zero is a good value for all but mesh
 * and actor_count. */
typedef struct noh_kind_desc {
    const char *name;     /* for messages and plans; default (NULL) "". Borrowed */
    const noh_pack *mesh; /* its skeleton, meshes and nodes; required. Its bytes must outlive the stage */
    /* Where `mesh` has coarse levels alone (noh strip): the pack that it was made from, or one with more of its levels.
     * The plan then has room for these, and noh_stage_load_level brings them. Read by plans and by init, not kept.
     * Default (NULL) only the levels of `mesh` are ever shown */
    const noh_pack *finer;
    const noh_pack *clips;             /* default (NULL) `mesh`. Clips of other skeletons are left out */
    const noh_pack *const *clip_packs; /* [clip_pack_count] instead of `clips`, where there are several: a later one's
                                        * clip replaces an earlier one's of the same name. Must outlive the stage */
    uint32_t clip_pack_count;          /* 0 with `clips`; 0 with clip_packs: no clips at all */
    const uint32_t *nodes; /* [node_count] only these nodes of `mesh` are drawn; in a pack without nodes: these meshes.
                            * Default (NULL) all. Read by plans and by init */
    uint32_t node_count;
    uint32_t skeleton;     /* in `mesh`; default 0; NOH_NONE: only what no joint moves. A node's mesh that another
                            * skeleton moves is left out */
    uint32_t actor_count;  /* of this kind at one time; required */
    uint32_t seen_max;     /* of these, how many are drawn in one frame: slots and palettes are for so many, and
                            * of more the farthest are left out (noh_stage_stats.left_out). Default (0) actor_count */
    uint32_t near_count;   /* of these, how many may be at the finest level at once, */
    uint32_t middle_count; /* and how many at the next one. Both 0: 16, or more by an even
                            * spread over 100 m; a bound takes some back */
    uint32_t finest_level; /* the finest level that may be used (noh_stage_plan.kinds[].levels); default 0 */
    int levels_by_number;  /* 1: level k of an actor is level k of each of its meshes, or their coarsest; 0: each mesh
                            * takes its coarsest level that is off by no more than the others */
    const noh_layer_desc *layers; /* [layer_count] default (NULL) three: "body" (base), "face" (over, floats alone),
                                   * "add" (add) */
    uint32_t layer_count;         /* 0..NOH_LAYERS_MAX */
    /* Names of graphs in the packs of clips (noh build --graph) that its actors may play, one at a time, separated by
     * blanks; '*' at the end matches any rest. Default (NULL) none, at no cost. Read at init */
    const char *graphs;
    const struct noh_kind_face *face;       /* faces that live (stage_face.h); default (NULL) none, at no cost */
    const struct noh_kind_ragdoll *ragdoll; /* actors that fall (stage_ragdoll.h); default (NULL) none, at no cost */
    /* What changes its poses before they are shown (part.h), in this order; default (NULL) nothing, at no cost */
    const struct noh_stage_part *parts; /* [part_count] what they point to must outlive the stage */
    uint32_t part_count;                /* 0..NOH_STAGE_PARTS_MAX */
    int without_springs;                /* 1: what springs of the mesh's pack (springs.h) would swing is left to
                                         * clips */
    int weight_rules;                   /* 1: how far its targets go, and which exclude each other, is kept as the
                                         * mesh's pack tells it (weight_rule.h), whoever says the weights */
    uint32_t change_count;              /* fades and other changes over time at once; default (0) 3 for each track */
    uint32_t held_float_count; /* floats that the game may hold at once (noh_actor_hold_float); default (0) 8; NOH_NONE:
                                * none */
    uint32_t root_axes;        /* NOH_ROOT_* that clips move the actor by; default (0) none */
    uint32_t root_up;          /* axis of the heading: 0 x, 1 y, 2 z; not used without root_axes */
    uint32_t sample_rate_enough; /* frames per second of clips that are enough: of clips that have twice as many half
                                  * are decoded, into half of the bytes (clip_codec.h); default (0) all */
    int root_told;               /* 1: root motion does not move the actor, it is only told (noh_actor_root) */
    int inertia;                 /* 1: room for NOH_PLAY_INERTIA: 48 bytes a joint and 8 a float for each actor */
    int unpickable;              /* 1: noh_stage_pick passes through */
    const noh_texture_set *texture_sets; /* [texture_set_count] that its actors may wear (noh_look); borrowed */
    uint32_t texture_set_count;          /* 0..NOH_TEXTURE_SETS_MAX */
} noh_kind_desc;

struct noh_gl_light_desc;
typedef struct noh_stage_gpu noh_stage_gpu; /* stage_gl.h has the one there is */

/* Zero is a good value for all but kinds. */
typedef struct noh_stage_desc {
    const noh_kind_desc *kinds; /* [kind_count]; required */
    uint32_t kind_count;        /* 1..NOH_STAGE_KINDS_MAX */
    uint64_t cpu_bytes_max;     /* bounds that the plan has to keep; default (0) none */
    uint64_t gpu_bytes_max;
    uint64_t bytes_max;   /* of both together, where memory is shared */
    noh_lod_settings lod; /* `pixels` is the largest error that may show; zeros: as lod.h has them */
    uint32_t height_px;   /* of the view that slots are counted for; default (0) 1,080 */
    uint32_t job_count;   /* noh_stage_job may run this many at once; default (0) 1 */
    uint32_t event_count; /* callback keys that one step may deliver to noh_stage_events; default (0) 64 and one
                           * for each actor */
    uint32_t load_bytes;  /* of levels that are loaded (noh_stage_load_level), so many are uploaded in a frame at most;
                           * below 256 counts as 256; default (0) 65,536 */
    uint64_t update_budget_ns; /* of posing in a frame, by noh_cost_ns; default (0) no bound */
    uint32_t slot_moves;       /* slots that may change hands in a frame, each of which is accumulated afresh:
                                * actors that wait are drawn coarser, or without targets until they have a slot. 1
                                * counts as 2; default (0) no bound. A frame with a cut has none */
    int tangents;         /* 1: accumulators with a layer of tangents, for shaders of yours that read them morphed; the
                           * library's do not */
    int halves;           /* 1: 16-bit accumulators; -1: 32-bit ones, which are not given up either */
    int encode_srgb;      /* 1: shaders encode to sRGB, for targets that do not, such as WebGL's canvas */
    int full_detail;      /* 1: each actor is shown at its kind's finest level, or at noh_look.level, with everything
                           * else in full: no tables of LOD, no programs that fade or take fewer influences */
    int without_depth;    /* 1: NOH_PASS_DEPTH is never drawn: its programs are not compiled */
    int user_values;      /* 1: shaders of your own read noh_look.user: 16 bytes more on the CPU and on the GPU for each
                           * mesh of an actor that is seen */
    int without_shader;   /* 1: every noh_stage_draw names a shader: the library's programs are not compiled */
    int without_transfer; /* 1: meshes with a transfer (transfer.h) are lit as those without, and their records
                           * are not on the GPU; without `light` they are not either */
    uint32_t morph_path;  /* noh_morph_path of gl_morph.h; default (0) the cheapest */
    /* 1: the path cpu keeps sums in a texture, for renderers of yours that read it, or shaders that take noh_a_position
     * for the bind pose. Default (0) it writes finished vertices (noh_gl_morph_desc.vertices) unless halves, a transfer,
     * levels that come later, or a kind of several actors need sums */
    int morph_sums;
    /* gl_light.h: what is mirrored, and the shadow map. Shaders are then lit by noh_stage_set_lighting. Must outlive
     * the stage. Default (NULL) a plain light that needs neither */
    const struct noh_gl_light_desc *light;
    const noh_stage_gpu *gpu; /* &noh_stage_on_gl of stage_gl.h; default (NULL) nothing is drawn */
} noh_stage_desc;

/* ---- the plan ---- */

/* A level of an actor: a level for each of its meshes, chosen so that none is off by more than error_m. */
typedef struct noh_actor_level {
    float error_m; /* certified, of the mesh that is off the most */
    uint32_t triangle_count;
    uint32_t slot_count; /* actors that may be at this level or a finer one that is free, at one time */
    uint8_t mesh_levels[NOH_STAGE_MESHES_MAX];
} noh_actor_level;

/* What the clips of a kind take, read from its packs: a plan reads them once, however much it then gives up. */
typedef struct noh_kind_clips {
    uint64_t bank_bytes, view_bytes; /* 0: no clip fits */
    uint32_t clip_count, event_count, marker_count, joint_count, float_count;
    uint32_t cached_segment_count, segment_count;
    uint32_t asked; /* cached segments that it was read for */
} noh_kind_clips;

/* What a kind came to. */
typedef struct noh_kind_plan {
    uint32_t mesh_count, level_count, finest_level;
    uint32_t track_count, joint_count, float_count, graph_count;
    uint32_t cached_segment_count, segment_count; /* of its clips: held decoded at once; in all */
    noh_kind_clips clips;                         /* of the kind whose clips it shares: itself, or an earlier one */
    noh_actor_level levels[NOH_LOD_LEVELS_MAX];
} noh_kind_plan;

/* Something that was given up to keep a bound. */
typedef struct noh_concession {
    const char *what;  /* a constant: "half-float accumulators", "cached segments", "slots", "finest level" */
    uint32_t kind;     /* NOH_NONE: of all */
    uint32_t value;    /* what it is now */
    float loss_pixels; /* the error that it may show, at the distance where the level given up would begin; 0: none */
    uint64_t cpu_bytes, gpu_bytes; /* that it won */
} noh_concession;

/* Plain data, 8 KiB: print it, compare it, keep it with the build. */
typedef struct noh_stage_plan {
    uint64_t cpu_bytes;   /* of the block that noh_stage_init wants; exact */
    uint64_t gpu_bytes;   /* of what it makes on the GPU; exact, as the ledger counts */
    uint64_t state_bytes; /* of cpu_bytes: noh_stage_state */
    uint64_t pack_bytes;  /* of the packs, which are read where they lie and not counted above; without `finer` */
    uint32_t halves;      /* 1: 16-bit accumulators */
    uint32_t sums;        /* 1: finished vertices were given up, as by morph_sums */
    uint32_t morph_path;  /* noh_morph_path that was chosen; 0 without GPU */
    uint32_t hash;        /* of the desc and the plan: a state of another one is refused */
    uint32_t concession_count;
    noh_concession concessions[NOH_CONCESSIONS_MAX]; /* in the order in which they were given up */
    noh_kind_plan kinds[NOH_STAGE_KINDS_MAX];
} noh_stage_plan;

struct noh_gl_caps;

/* Decide and measure. Needs no driver and no memory; the same desc, packs and capabilities give the same plan
 * everywhere. Where a bound is not kept, things are given up in this order, the bound being checked after each: 32-bit
 * accumulators; cached segments, down to half; slots of finer levels, the finest first, unless near_count or
 * middle_count promise them; the finest level; cached segments, down to two for each bank. What then fits again is
 * given back: 32-bit accumulators, cached segments.
 *
 * caps    of gl_caps.h; NULL with desc->gpu NULL
 * errors  ARG a field of the desc (where: the kind); NOT_FOUND graphs of a kind name none of its packs; MEMORY no
 * choice keeps the bounds (need: bytes of the smallest); LIMIT; DATA a clip is broken. *plan is undefined then */
noh_result noh_stage_plan_make(const noh_stage_desc *desc, const struct noh_gl_caps *caps, noh_stage_plan *plan,
                               noh_error *error);

/* A part of the sum. */
typedef struct noh_stage_bytes {
    const char *what; /* a constant: "clips", "characters", "accumulators" */
    uint32_t kind;    /* NOH_NONE: of all */
    uint64_t cpu_bytes, gpu_bytes;
} noh_stage_bytes;

/* The parts that the plan's bytes are made of; their sums are cpu_bytes and gpu_bytes.
 * shapes   parts[capacity]
 * returns  how many there are; those past `capacity` are not written */
uint32_t noh_stage_plan_parts(const noh_stage_desc *desc, const struct noh_gl_caps *caps, const noh_stage_plan *plan,
                              noh_stage_bytes *parts, uint32_t capacity);

/* ---- a stage ---- */

typedef struct noh_stage noh_stage;

/* Build it in memory[bytes], aligned to NOH_MEMORY_ALIGN and at least plan->cpu_bytes long.
 * desc    as the plan was made for; its packs and names must outlive the stage, the rest is copied
 * plan    must outlive the stage
 * device  a noh_gl_device (gl_memory.h) with all fields set but the log; its table, caps and ledger must outlive the
 *         stage. NULL with desc->gpu NULL
 * errors  as noh_stage_plan_make; NOT_FOUND a joint or float of a layer (where: the kind); ARG memory is NULL or
 * misaligned; MEMORY it is too small (need: the bytes), or the driver's is; GL, DATA the driver refused an object or a
 * shader: nothing is left behind */
noh_result noh_stage_init(void *memory, size_t bytes, const void *device, const noh_stage_desc *desc,
                          const noh_stage_plan *plan, noh_stage **stage, noh_error *error);

/* Delete the GL objects. The memory is yours again. After a lost context gl_lost.h says how. */
void noh_stage_delete(noh_stage *stage);

/* Make the GL objects again in a new context (gl_lost.h): the next frame shows what it would have shown.
 * errors  GL, MEMORY, DATA: it then has no GL objects, and may be restored again */
noh_result noh_stage_restore(noh_stage *stage, noh_error *error);

const noh_stage_plan *noh_stage_plan_of(const noh_stage *stage);

/* Counts of the last frame, and high-water marks to plan the next build by. Not part of the state. */
typedef struct noh_stage_stats {
    uint32_t actors, seen, updated, fading, events;
    uint32_t at_level[NOH_LOD_LEVELS_MAX]; /* of those that are seen */
    uint32_t coarser;                      /* actors that are drawn coarser than they asked for: too few slots */
    uint32_t moved, waiting;               /* slots that changed hands; actors that wait for that (slot_moves) */
    uint32_t resting;                      /* actors without a slot yet: drawn without targets */
    uint32_t left_out;                     /* actors in view that are not drawn: seen_max is too small */
    uint32_t loading;                      /* kinds whose finer levels are on their way (noh_stage_load_level), */
    uint32_t load_bytes;                   /* and what was uploaded of them */
    uint64_t decoded;                      /* track-frames */
    uint64_t decoded_late;                 /* of these, those that a pose had to wait for: too few cached segments */
    uint32_t events_lost;                  /* since init: event_count is too small */
    uint32_t actors_high, events_high, coarser_high;
    float error_pixels; /* the largest of all that are seen */
} noh_stage_stats;

const noh_stage_stats *noh_stage_stats_of(const noh_stage *stage);

/* ---- names ---- */

typedef enum noh_name {
    NOH_NAME_CLIP,
    NOH_NAME_LAYER,
    NOH_NAME_FLOAT,
    NOH_NAME_JOINT,
    NOH_NAME_GRAPH,
    NOH_NAME_PARAMETER,  /* of the kind's graphs */
    NOH_NAME_MACHINE,    /* a machine, select or one-shot of its graphs */
    NOH_NAME_TEXTURE_SET /* 0: the kind's own, "" */
} noh_name;

/* The index of a name in a kind; NOH_NONE when there is none. Look names up once, not in every frame. Floats are the
 * morph targets of all meshes and the named floats of clips; meshes that have a target of the same name share it. */
uint32_t noh_stage_find(const noh_stage *stage, uint32_t kind, noh_name what, const char *name);

/* The name of an index; NULL past the last. */
const char *noh_stage_name(const noh_stage *stage, uint32_t kind, noh_name what, uint32_t index);

/* ---- actors ---- */

/* An actor, 0: nobody. 16 bits of index and 16 of generation: keep it, pass it by value, send it over a network. An
 * index is used again as late as possible, and its generation repeats after 65,535 times. */
typedef struct noh_actor {
    uint32_t id;
} noh_actor;

typedef struct noh_place {
    float position[3];
    float rotation[4]; /* quaternion x, y, z, w; all 0: the identity */
    float scale;       /* above 0; 0: 1 */
} noh_place;

/* A new actor of a kind: nothing plays.
 * place   NULL: the origin
 * errors  ARG kind, or a field of place; LIMIT all actors of the kind are there (need: their number) */
noh_result noh_stage_spawn(noh_stage *stage, uint32_t kind, const noh_place *place, noh_actor *actor, noh_error *error);

/* It is gone at once, and lets go of what hangs on it.
 * errors  NOT_FOUND it is gone already */
noh_result noh_stage_despawn(noh_stage *stage, noh_actor actor, noh_error *error);

/* The actor at an index below the sum of all actor_counts, kind after kind; id 0 where nobody is. */
noh_actor noh_stage_actor_at(const noh_stage *stage, uint32_t index);

/* Where it is after the next step, or, set after a step and before the next frame, after that one; before root motion.
 * Frames between two steps show it on its way (noh_stage_frame_between), other frames show it there.
 * errors  NOT_FOUND; ARG a value that is not finite or beyond NOH_NUMBER_MAX, a rotation without length, a scale below
 *         0 */
noh_result noh_actor_set_place(noh_stage *stage, noh_actor actor, const noh_place *place, noh_error *error);

/* Where it is after the last step; one that hangs on another: relative to the joint.
 * errors  NOT_FOUND */
noh_result noh_actor_place(const noh_stage *stage, noh_actor actor, noh_place *place, noh_error *error);

/* Where a frame between the last two steps shows it: what a camera that follows it must follow. Positions and scales
 * are interpolated linearly, rotations as by noh_quat_nlerp.
 * ranges  alpha as in noh_stage_frame_between
 * errors  NOT_FOUND; ARG alpha */
noh_result noh_actor_place_between(const noh_stage *stage, noh_actor actor, float alpha, noh_place *place,
                                   noh_error *error);

/* It has leapt: what shows from the next frame on is where it is and as it is after the last step, even between two
 * steps; its detail is chosen afresh. Call it after noh_actor_set_place or noh_actor_play. Until that frame it counts
 * as never posed.
 * errors  NOT_FOUND */
noh_result noh_actor_cut(noh_stage *stage, noh_actor actor, noh_error *error);

/* How it is drawn. All zeros: seen, with a shadow, within the stage's error, in its own colours. */
typedef struct noh_look {
    uint32_t hidden;    /* 1: neither drawn nor picked; clocks and callback keys go on */
    uint32_t no_shadow; /* 1: not drawn in depth passes of views without height_px */
    uint32_t posed;     /* 1: posed in every frame in full detail, seen or not: for noh_actor_joint on a server */
    float pixels;       /* its own largest error; 0: that of the stage */
    uint32_t level;     /* 1 + the level to show whatever its error, with everything else in full; 0: chosen by error */
    uint8_t tint[4];    /* sRGB and alpha, multiplied with its colours, of materials that take one; alpha counts where
                         * a material blends. All 0: white */
    uint32_t texture_set;   /* 0: its kind's own textures; else noh_kind_desc.texture_sets[texture_set - 1] */
    uint8_t wrinkle_models; /* NOH_WRINKLE_BY_* of format.h, in place of those of its materials; 0: those */
    uint8_t smoothed;       /* how far its wrinkles are smoothed out; 255: nothing is left of them */
    uint8_t reserved[2];    /* 0 */
    float user[4];          /* noh_user() in vertex shaders of your own, where noh_stage_desc.user_values is 1 */
} noh_look;

/* errors  NOT_FOUND; ARG pixels is not in 0..NOH_PIXELS_MAX, the kind has no such texture_set, or wrinkle_models has
 *         unknown bits */
noh_result noh_actor_set_look(noh_stage *stage, noh_actor actor, const noh_look *look, noh_error *error);

/* Attach an actor to a joint of another one, which may be attached itself: a ring on a finger of a hand that a puppet
 * holds. Its place is then relative to the joint. The parent is posed wherever the actor is seen, and where the parent
 * is hidden, it is not seen. When a parent is despawned, what was attached to it stays where it was shown.
 * parent  id 0: let go, and stay where it is
 * errors  NOT_FOUND either is gone, or the parent has no such joint; ARG the parent is the actor itself, or is attached
 *         to it; LIMIT more than NOH_ATTACH_DEPTH_MAX attachments would follow on each other (need: how many) */
noh_result noh_actor_attach(noh_stage *stage, noh_actor actor, noh_actor parent, uint32_t joint, noh_error *error);

/* ---- play ---- */

#define NOH_PLAY_KEEP 1u    /* leave the layer alone where this clip plays on it already */
#define NOH_PLAY_PHASE 2u   /* begin at the phase of what it takes over from: walk into run */
#define NOH_PLAY_INERTIA 4u /* no cross-fade: the clip plays at once, and the leap decays within fade_ticks */
#define NOH_PLAY_BESIDE 8u  /* what plays on the layer plays on, blended with this clip by weight; not with INERTIA */
#define NOH_PLAY_FROM_BIND 16u /* on a layer that adds: the difference from the bind pose and the floats' defaults */

/* All zeros play the clip as it was made, faded in within a fifth of a second. */
typedef struct noh_play {
    uint32_t fade_ticks; /* default (0) 9,600; 1: at once */
    int32_t speed;       /* 1/65,536; default (0) 65,536; negative: backwards */
    int64_t start_ticks; /* default 0 */
    float weight;        /* default (0) 1 */
    noh_loop loop;       /* default NOH_LOOP_OF_CLIP: the clip's own */
    uint32_t sync_group; /* default (0) none; 1..NOH_SYNC_GROUPS_MAX */
    uint32_t flags;      /* NOH_PLAY_* */
    /* On a layer that adds: the clip from whose first frame the difference is taken. Default (NULL) this clip itself,
     * so that a clip of one pose adds nothing: give it a reference, or NOH_PLAY_FROM_BIND */
    const char *reference;
} noh_play;

/* Play a clip on a layer; what played there fades out. Where all tracks of the layer are in use, the lightest ends. A
 * base layer that moves joints and on which nothing plays is not faded in: there is nothing to fade from.
 * play    NULL: zeros
 * errors  NOT_FOUND the actor is gone, or the kind has no such clip or reference; ARG layer, a field of play, or
 *         NOH_PLAY_INERTIA without noh_kind_desc.inertia; LIMIT too many changes over time are under way (need: so
 *         many are wanted), or NOH_PLAY_BESIDE finds no free track (where: the layer, need: tracks) */
noh_result noh_actor_play(noh_stage *stage, noh_actor actor, uint32_t layer, const char *clip, const noh_play *play,
                          noh_error *error);

/* Fade a layer out, its root motion too, to what else plays there, or to the bind pose; fade_ticks as above.
 * errors  as noh_actor_play */
noh_result noh_actor_stop(noh_stage *stage, noh_actor actor, uint32_t layer, uint32_t fade_ticks, noh_error *error);

/* The track of a layer that was started last; NULL: the actor is gone, or nothing plays there. */
const noh_track *noh_actor_track(const noh_stage *stage, noh_actor actor, uint32_t layer);

/* The whole controller, for what the calls above do not do; and the set that its calls take. NULL: the actor is gone.
 */
noh_controller *noh_actor_controller(noh_stage *stage, noh_actor actor, const noh_clip_set **set);

/* Hold a float: what shows is what the clips say, mixed with this value.
 * ranges  amount 0..1: 1 is this value alone; 0 lets go
 * errors  NOT_FOUND the actor is gone, or the kind has no such float; LIMIT held_float_count are held (need: it); ARG
 * not finite, or amount out of its range */
noh_result noh_actor_hold_float(noh_stage *stage, noh_actor actor, uint32_t index, float value, float amount,
                                noh_error *error);

/* ---- graphs ---- */

/* Play an animation graph (graph.h) on a base or over layer, from its beginning: all its parameters as the pack
 * has them. It fades in as a clip does, and what played on the layer fades out; noh_actor_play and noh_actor_stop fade
 * it out again. An actor plays one graph at a time: another one, or the same again, ends it at once, so give it
 * NOH_PLAY_INERTIA there. What the layer's mask lets through is the graph's; faces and additive layers play over it.
 * play    NULL: zeros; fade_ticks, weight, NOH_PLAY_KEEP and NOH_PLAY_INERTIA are used, all else is ARG
 * errors  NOT_FOUND the actor is gone, or the kind has no such graph; ARG layer, or one that adds; a field of play;
 *         within on_key of a key of a graph; LIMIT as noh_actor_play */
noh_result noh_actor_play_graph(noh_stage *stage, noh_actor actor, uint32_t layer, const char *graph,
                                const noh_play *play, noh_error *error);

/* Set a parameter of the graph that plays, by an index of noh_stage_find: a blend space follows at once, machines at
 * the start of the next step. It is held within its range; a trigger is 1 to fire; an enumerated one takes a number of
 * noh_stage_find_value. Where graphs of a kind have parameters of one name, one index serves all.
 * errors  NOT_FOUND the actor is gone, plays no graph, or one without such a parameter; ARG not finite */
noh_result noh_actor_set_parameter(noh_stage *stage, noh_actor actor, uint32_t parameter, float value,
                                   noh_error *error);

/* Its present value; 0 where noh_actor_set_parameter would be NOT_FOUND. */
float noh_actor_parameter(const noh_stage *stage, noh_actor actor, uint32_t parameter);

/* The number of a value of an enumerated parameter; NOH_NONE when it has none of that name. */
uint32_t noh_stage_find_value(const noh_stage *stage, uint32_t kind, uint32_t parameter, const char *name);

/* The name of the state that a machine, select or one-shot of the graph is in or fades to; NULL where
 * noh_actor_set_parameter would be NOT_FOUND.
 * ranges  machine  of NOH_NAME_MACHINE */
const char *noh_actor_state(const noh_stage *stage, noh_actor actor, uint32_t machine);

struct noh_graph_pack;
struct noh_graph_state;

/* The instance that an actor plays, for what the calls above do not do, and the graph that it is of (graph_pack.h).
 * Do not step it: the stage does. NULL: the actor is gone, or plays none. */
struct noh_graph_state *noh_actor_graph(noh_stage *stage, noh_actor actor, const struct noh_graph_pack **graph);

/* ---- ask ---- */

/* The floats as they showed in the last frame: [the kind's float_count], valid until the next frame; NULL: the actor is
 * gone, or was not shown. */
const float *noh_actor_floats(const noh_stage *stage, noh_actor actor);

/* A joint in the world, as it was shown last; a joint that LOD left out stands where its parent takes it.
 * errors  NOT_FOUND the actor is gone, was never posed, or has no such joint */
noh_result noh_actor_joint(const noh_stage *stage, noh_actor actor, uint32_t joint, float matrix[12], noh_error *error);

/* What the clips moved the root by in the last step, in the actor's own space, in model units.
 * errors  NOT_FOUND the actor is gone */
noh_result noh_actor_root(const noh_stage *stage, noh_actor actor, noh_root_pose *moved, noh_error *error);

/* Centre x, y, z and radius in the world of a sphere that holds every vertex as posed last, rigid meshes and targets of
 * any weight among them; before the first pose, every vertex in any pose of its clips. Vertices that dual quaternions
 * move may be outside by a little.
 * errors  NOT_FOUND the actor is gone */
noh_result noh_actor_sphere(const noh_stage *stage, noh_actor actor, float sphere[4], noh_error *error);

/* A mesh of an actor as it was shown last, for what deforms it on the CPU (noh_morph_accumulate, noh_skin_vertices):
 * exact bounds, decals, export. */
typedef struct noh_actor_mesh {
    uint32_t node, mesh;  /* of the kind's mesh pack; node NOH_NONE: a pack without nodes */
    uint32_t level;       /* of the mesh; in the pack that was loaded, where noh_kind_desc.mesh lacks it */
    uint32_t joint_count; /* of its skin; 0: rigid */
    const float *weights; /* [its target_count]; valid until the next frame */
    float world[12];      /* of its vertices, once they are deformed */
} noh_actor_mesh;

/* The index-th mesh of an actor.
 * shapes  matrices[joint_count][12], its palette in model space; NULL: not wanted
 * errors  NOT_FOUND the actor is gone, was not shown in the last frame, or has no such mesh (need: how many) */
noh_result noh_actor_mesh_at(const noh_stage *stage, noh_actor actor, uint32_t index, noh_actor_mesh *out,
                             float *matrices, noh_error *error);

/* How finely an actor was shown in the last frame. */
typedef struct noh_actor_detail {
    uint32_t level;           /* of noh_kind_plan.levels */
    uint32_t level_before;    /* the one that fades into it; else `level` */
    float fade;               /* the share of its pixels that show `level`; 1: all */
    uint32_t joint_count;     /* that are posed; the others move with their parents */
    uint32_t influence_count; /* of a vertex, at most; 0: rigid */
    float error_m;            /* certified, of all of that, the update rate and targets left out; in model units */
    float pixels_per_metre;   /* of such a unit at its nearest point, in the view that is nearest; 0: no view sees it */
} noh_actor_detail;

/* The nearest point is that of the sphere of noh_actor_sphere or, where an eye is within that, of the boxes about what
 * each joint moves, but never nearer than the near plane. Levels are chosen by what the frame before showed; who comes
 * into view, or is cut, by the bind pose, and again in the next frame.
 * Its error on screen is error_m * pixels_per_metre; noh_stage_stats.error_pixels is the largest of all.
 * errors  NOT_FOUND the actor is gone, or was not shown in the last frame */
noh_result noh_actor_detail_of(const noh_stage *stage, noh_actor actor, noh_actor_detail *out, noh_error *error);

typedef struct noh_stage_hit {
    noh_actor actor;
    uint32_t mesh; /* in the kind's mesh pack */
    uint32_t submesh, triangle;
    uint32_t joint;      /* of the skeleton; NOH_NONE: rigid */
    float distance;      /* in lengths of the direction */
    float point[3];      /* world */
    float bind_point[3]; /* the same place of the bind pose */
    float barycentric[3];
} noh_stage_hit;

/* The nearest of the actors that were shown in the last frame along origin + distance * direction, as they are morphed
 * and posed; of one that was cut since then (noh_actor_cut) no skinned mesh is hit. What alpha cuts away is gone
 * through (pick.h), by the textures of the kind's own pack, whatever texture set an actor wears.
 * errors  NOT_FOUND nothing is hit; ARG direction has no length, or distance_max is not above 0 */
noh_result noh_stage_pick(noh_stage *stage, const float origin[3], const float direction[3], float distance_max,
                          noh_stage_hit *hit, noh_error *error);

/* ---- a frame ---- */

/* A callback key that play has passed. */
typedef struct noh_stage_event {
    noh_actor actor;
    uint32_t layer, clip;
    const char *name; /* of the key, in the pack */
    uint32_t name_hash;
    uint32_t index;    /* of the key in its clip */
    int64_t clock;     /* tick of the stage's clock */
    float weight;      /* of the track */
    uint32_t backward; /* 1: passed in backward play */
    uint8_t payload[8];
} noh_stage_event;

/* Called within a step, at the tick of a key. It may play, stop, hold and move the actor that the key belongs to, from
 * that tick on. Other actors it may not change, for the result would depend on the order of actors: such calls are
 * NOH_ERR_ARG. */
typedef void (*noh_stage_event_fn)(void *user, noh_stage *stage, const noh_stage_event *event);

/* Move time on: clocks, fades, callback keys, root motion; of all actors, seen or not. Any number of steps to a frame.
 * on_key  NULL: keys are in noh_stage_events alone
 * errors  ARG within on_key, or within a frame */
noh_result noh_stage_step(noh_stage *stage, uint32_t ticks, noh_stage_event_fn on_key, void *user, noh_error *error);

/* The keys of the last step: actor by actor, each in order of time. Valid until the next step. */
const noh_stage_event *noh_stage_events(const noh_stage *stage, uint32_t *count);

/* Move the world's origin to what is `by` now: every place becomes less by it, and nothing else changes. Moved are
 * actors, where they were before the last step, ragdolls, springs, feet and hair, points that faces, gazes and hands were
 * told, joints and spheres of the last frame. The game moves what is its own: cameras, lights, the world of ragdolls,
 * the ground, states of its own parts (noh_actor_part); crowds and walkers have calls of their own
 * (noh_crowd_shift_origin, noh_walkers_shift_origin). Multiples of 16 lose nothing.
 * errors  ARG not finite or beyond NOH_NUMBER_MAX; within a step or a frame */
noh_result noh_stage_shift_origin(noh_stage *stage, const float by[3], noh_error *error);

/* A camera or a light. noh_view_orbit and others of view.h make one. */
typedef struct noh_stage_view {
    float view_projection[16]; /* column-major, clip space of GL; perspective or parallel */
    float eye[3];
    float light[3];     /* unit vector towards the key light */
    uint32_t height_px; /* of the picture; 0: casts shadows only, and asks for no detail of its own */
    uint32_t cut;       /* 1: the camera has jumped: detail is chosen afresh, nothing fades */
    /* What the floats of the last column of view_projection and of `eye` are short of, far from the origin. 0: nothing;
     * then the picture as a whole is off by what they lose. noh_view_orbit fills them */
    float column_rest[4], eye_rest[3];
} noh_stage_view;

/* Far from the origin. Root motion, poses, bounds, culling and pictures are as exact 1,000,000 units from the origin as
 * there: to a tenth of a millimetre, where a unit is a metre (test_stage_far). An actor's place keeps what its floats
 * lose, and a frame reckons relative to a point near its first camera. What this interface takes and gives in floats is
 * rounded to them: to 0.5 mm at 8 km, 4 mm at 100 km, 32 mm at 1,000 km.
 * This is that point: what world matrices on the GPU, and cameras that shaders are given, are relative to. A shader that
 * wants a position of the world adds it. All 0 while the camera is within 512 units of the origin. */
void noh_stage_origin(const noh_stage *stage, float origin[3]);

/* What shows in this frame: views[view_count], 0..NOH_STAGE_VIEWS_MAX. An actor is shown if any of them sees it, in the
 * finest detail that one of them asks for.
 * errors  ARG a matrix is not finite, or a frame has begun */
noh_result noh_stage_frame_begin(noh_stage *stage, const noh_stage_view *views, uint32_t view_count, noh_error *error);

/* The same between the last two steps, for a game that steps at a fixed rate and draws at another one. Places and poses
 * are those of the two steps, mixed: a game that is `left` ticks behind its next step of `ticks` shows alpha = 1 -
 * left / ticks, and what shows lies up to a step behind callback keys. Places, matrices of joints and floats are mixed,
 * so that skinned vertices go straight from one step to the next, which at 30 steps a second is off by as much as poses
 * at 30 Hz (time_lod.h); an actor in full detail is posed once in a step. Actors that are posed less often need no mix
 * of steps. Held floats and looks show at once, and so does the place of an actor that was spawned, attached or cut.
 * noh_actor_joint, noh_actor_sphere and noh_stage_pick agree with what shows.
 * ranges  alpha 0..1: 0 the step before the last one, 1 the last; taken to a tick
 * errors  as noh_stage_frame_begin, which is alpha 1; ARG alpha */
noh_result noh_stage_frame_between(noh_stage *stage, const noh_stage_view *views, uint32_t view_count, float alpha,
                                   noh_error *error);

/* The next phase of a frame: how many jobs it has; 0: none is left. All jobs of a phase must have returned before the
 * next call.
 *   while ((count = noh_stage_jobs(stage)) > 0)
 *       noh_stage_job(stage, i) for each i below count, on any threads, in any order; wait for all */
uint32_t noh_stage_jobs(noh_stage *stage);

/* One job, each index once. It reads what no job of the phase writes and writes what no other one touches: nothing
 * locks, nothing is atomic, and the bits do not depend on the number of threads. */
void noh_stage_job(noh_stage *stage, uint32_t job);

/* Run what is left of the phases, and hand everything to the GPU: on the thread of the context. Faces that move are
 * drawn into textures meanwhile: bind your framebuffer and set the viewport afterwards.
 * errors  ARG no frame has begun */
noh_result noh_stage_frame_end(noh_stage *stage, noh_error *error);

/* All of it: one step, one frame, all jobs in turn.
 * view    NULL: none */
noh_result noh_stage_frame(noh_stage *stage, uint32_t ticks, const noh_stage_view *view, noh_stage_event_fn on_key,
                           void *user, noh_error *error);

/* ---- levels that come later ---- */

/* Bring the levels that a kind's `finer` has and its `mesh` lacks. Each noh_stage_frame_end uploads a piece of at most
 * desc->load_bytes; once all is there (noh_stage_stats.loading), the next frame chooses among all levels of the plan,
 * and they fade in. Room was made at init: nothing is made now. Kinds of the same `mesh` and `finer` share their
 * levels: what is brought for one is there for all. Picking stays at the levels of `mesh`. To bring again what is
 * there, or on its way from the same pack, is no error.
 * pack    `finer`, or any pack with the same levels, wherever it lies. It and its bytes must stay until the levels are
 *         dropped or the stage is deleted: faces read them, and so does noh_stage_restore
 * errors  ARG kind, or a frame or a step has begun; UNSUPPORTED the kind has no `finer`, or the plan none of its
 *         levels; DATA a mesh of `pack` is not the one that the kind's was stripped from, or too few levels are in it
 *         (where: the mesh); nothing has changed then */
noh_result noh_stage_load_level(noh_stage *stage, uint32_t kind, const noh_pack *pack, noh_error *error);

/* Let go of them again, at whatever stage of their upload: from the next frame on actors that show them are drawn
 * coarser at once. The pack is not read any more. What is on the GPU stays there, as planned. noh_actor_mesh_at tells
 * levels of them until the next frame.
 * errors  ARG kind, or a frame or a step has begun */
noh_result noh_stage_drop_level(noh_stage *stage, uint32_t kind, noh_error *error);

/* ---- state ---- */

/* Everything that time or the game changes: one stretch of plan->state_bytes without pointers. Copy it to save or fork
 * the stage; not within a frame or a step. */
const void *noh_stage_state(const noh_stage *stage, size_t *bytes);

/* Put a copy back, of this stage or of another one with the same plan, on any processor of the same byte order. The
 * frames that follow equal to the bit those that followed the copy, where the same levels are there
 * (noh_stage_load_level): which ones is no part of the state. Without them actors show the finest that is there.
 * errors  ARG within a frame or a step; DATA another plan's state, or a count or index in it is out of range (where:
 * the actor); nothing has changed then */
noh_result noh_stage_set_state(noh_stage *stage, const void *state, size_t bytes, noh_error *error);

/* A hash of the state: equal on every processor, for any number of jobs. */
uint64_t noh_stage_hash(const noh_stage *stage);

#ifdef __cplusplus
}
#endif

#endif
