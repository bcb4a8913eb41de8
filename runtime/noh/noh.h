/* noh.h: characters in fixed memory. This header is what a game calls first: a stage of actors that play clips.
 *
 *   noh.h        a stage and its actors: plan, spawn, play, step, ask, save
 *   noh_gl.h     drawing it with OpenGL ES 3
 *   base.h       results, errors, limits; pack.h: packs and their meshes (both are included here)
 *   modules.h    faces, gaze, feet, ragdolls, springs, hair, modifiers of your own
 *   graph.h      animation graphs            crowd.h  agents, walkers, objects that they use
 *   marks.h      decals and blob shadows     light.h  environments and how meshes receive light
 *   face.h       emotions, speech, identity  body.h   the ground, rigid bodies, inverse kinematics
 *   clip.h       clips without a stage       deform.h targets, skins and picking on the CPU
 *   noh_low.h    parts for engines that use no stage; less stable
 *
 * noh opens a pack of meshes, skeletons and compressed clips (made by `noh build`), plays the clips, morphs faces and
 * skins bodies, on the CPU or on OpenGL ES 3.x. It is C99, calls memcpy, memset and memcmp and nothing else, and never
 * allocates, prints, reads a clock or a file, or keeps a global.
 *
 * Memory. An object reports its exact size, is built in memory that you bring, and is never freed: drop the memory and
 * it is gone. Nothing asks for memory after init. Memory is aligned to NOH_MEMORY_ALIGN bytes (16; 8 on 32-bit ARM and
 * wasm), as malloc's is.
 *
 *     bytes = noh_x_size(&desc);                        0: the desc is impossible, init says why
 *     noh_x_init(memory, bytes, &desc, &x, &error)      builds it in place, writes not a byte past `bytes`
 *
 * A pack is read where it lies, and objects made from it refer to its bytes: keep them readable and unchanged.
 *
 * Names. noh_noun_verb() is a function, noh_noun a type, NOH_NOUN a constant. A desc is a struct of settings in which
 * zero means the documented default. x_count counts, x_bytes counts bytes, x_max is a limit. Times end in their unit:
 * _ticks, _s. Matrices are 3 rows of 4 floats that multiply columns, quaternions x y z w, triangles counter-clockwise.
 *
 * Errors. A function that can fail returns a noh_result, NOH_OK (0) or an error, and on error leaves its outputs
 * untouched. Its last parameter is a noh_error, which may be NULL: `what` is a sentence and never NULL after a failure,
 * `where` the byte or index at fault, `need` the size or count that was needed; 0 where that means nothing. Bad data,
 * short memory and a missing capability are errors: too little memory is NOH_ERR_MEMORY, with the bytes in `need`. A
 * caller's bug (a NULL, an index past its count) is an assert (base.h). A function that finds an index by name returns
 * NOH_NONE where there is none.
 *
 * Threads. Packs, meshes, clips and every desc are read-only: any number of threads may share them. An object that an
 * init made belongs to one thread at a time. GL objects belong to the thread of their context. The library takes no
 * lock. A line "Threads:" says where something else holds. */

#ifndef NOH_H
#define NOH_H

#include <stdint.h>

#include "base.h"
#include "pack.h"
#include "clip.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== level of detail ======== */

typedef enum noh_lod_kind {
    NOH_LOD_MESH = 0,
    NOH_LOD_JOINTS,
    NOH_LOD_INFLUENCES,
    NOH_LOD_TARGETS,
    NOH_LOD_UPDATES,
    NOH_LOD_KIND_COUNT
} noh_lod_kind;

typedef struct noh_lod_settings {
    float pixels;                     /* the quality setting: largest error in pixels; default (0) 1; at most 1e6 */
    float shares[NOH_LOD_KIND_COUNT]; /* of `pixels`, by kind; each 0..1, sum at most 1; default (all 0) 0.3, 0.1, 0.05,
                                         0.1, 0.45 */
    float hysteresis;                 /* default (0) 0.3; below 1 */
    float lead;                       /* default (0) half the hysteresis; below the hysteresis */
    uint32_t fade_ticks; /* duration of a mesh fade; default (0) 12,000: a quarter of a second; 1: at once */
} noh_lod_settings;

/* ======== a stage ========
 * A cast of characters in one block of memory.
 *
 * A stage owns what its characters need: clips and their caches, poses, morph targets and palettes on the GPU. A game
 * describes its cast in a noh_stage_desc, and noh_stage_plan_make returns the exact memory before anything is loaded.
 * The game provides the block, then spawns, plays, steps and draws. Nothing is allocated after init.
 *
 *   plan     noh_stage_plan_make, noh_stage_plan_parts, noh_stage_init, noh_stage_delete, noh_stage_restore,
 *            noh_stage_stats_of
 *   names    noh_stage_find, noh_stage_name
 *   actors   noh_stage_spawn, noh_stage_despawn, noh_stage_actor_at, noh_actor_set_place, noh_actor_place,
 *            noh_actor_place_between, noh_actor_cut, noh_actor_set_appearance, noh_actor_attach, noh_actor_wear
 *   play     noh_actor_play, noh_actor_stop, noh_actor_track, noh_actor_controller, noh_actor_hold_float
 *   graphs   noh_actor_play_graph, noh_actor_set_parameter, noh_actor_parameter, noh_actor_state, noh_stage_find_value,
 *            noh_actor_graph
 *   query    noh_actor_floats, noh_actor_joint, noh_actor_root, noh_actor_sphere, noh_actor_mesh_at,
 *            noh_stage_list_draws, noh_actor_detail_of, noh_stage_pick
 *   frame    noh_stage_frame; or its pieces noh_stage_step, noh_stage_frame_begin or noh_stage_frame_between,
 *            noh_stage_jobs, noh_stage_job, noh_stage_frame_end; noh_stage_events
 *   levels   noh_stage_load_level
 *   kinds    noh_stage_set_kind
 *   state    noh_stage_state, noh_stage_set_state, noh_stage_hash
 *
 * noh_gl.h draws a stage. A program that does not name noh_stage_on_gl links no GL code: a server can step and pose
 * without it.
 *
 * Space     places are in the game's units. At scale 1 a model unit is one game unit. LOD counts a unit as a metre. y
 *           is up. Matrices are 3 rows of 4, position = rows * (x, y, z, 1).
 * Time      ticks of 1/48,000 s (NOH_TICKS_PER_SECOND).
 * Threads   a stage belongs to one thread at a time; only noh_stage_job may be called from several at once. Stages may
 *           share packs, which are read-only.
 * Errors    a failed call changes nothing. An id of a despawned actor gives NOH_ERR_NOT_FOUND. */

/* ---- the description ---- */

typedef enum noh_layer_mode {
    NOH_LAYER_BASE = 0, /* blended with the other base layers by weight, per joint */
    NOH_LAYER_OVER,     /* covers the base layers within its mask, by its weight; layers over the same joints are
                         * blended with each other */
    NOH_LAYER_ADD       /* adds its difference from the clip's first frame, or from another pose (noh_play) */
} noh_layer_mode;

/* One activity of an actor: walk, wave, talk. */
typedef struct noh_layer_desc {
    const char *name; /* required; borrowed */
    noh_layer_mode mode;
    const char *joints;   /* names of joints, separated by blanks; each includes its descendants. '-' before a name
                           * excludes it and its descendants: "spine_02 -clavicle_l". "": none; default (NULL) all. Read
                           * at init */
    const char *floats;   /* names of floats; '*' at the end matches any ending, '-' before a name excludes it. "":
                           * none; default (NULL) all. Read at init */
    uint32_t track_count; /* clips that play at once, 1..8; default (0) 2, for cross-fades */
} noh_layer_desc;

/* Replacement textures for a kind. A texture of the kind's mesh pack is replaced by the texture in `pack` whose name is
 * the same plus `suffix`; if there is none, the original stays. Replacements from the mesh pack itself take no bytes;
 * those from another pack are uploaded once. */
typedef struct noh_texture_set {
    const char *name;     /* for noh_stage_find; default (NULL) "" */
    const noh_pack *pack; /* default (NULL) the kind's mesh. Its bytes must outlive the stage */
    const char *suffix;   /* "_red"; default (NULL) "" */
} noh_texture_set;

struct noh_modifier;
struct noh_module_type;

/* What actors of a kind can do beyond layers of clips. A function of the module makes it: noh_graph_module,
 * noh_face_module, noh_ragdoll_module, noh_springs_module, noh_match_module. A program that calls none of these links
 * none of their code. All zeros: none. */
typedef struct noh_module {
    const struct noh_module_type *type; /* private, as `desc` */
    const void *desc;
} noh_module;

/* A kind of character: the meshes of one skeleton and the clips that move them. Zero is a good default for every field
 * except mesh and actor_count. */
typedef struct noh_kind_desc {
    const char *name;     /* for messages and plans; default (NULL) "". Borrowed */
    const noh_pack *mesh; /* its skeleton, meshes and nodes; required. Its bytes must outlive the stage */
    /* If `mesh` has only coarse levels (noh strip): the pack it was made from, or one with more of its levels. The plan
     * reserves room for them, and noh_stage_load_level loads them. Read by plans and init, not kept. Default (NULL):
     * only the levels of `mesh` are shown */
    const noh_pack *finer;
    const noh_pack *clips;             /* default (NULL) `mesh`. Clips of other skeletons: see `map` */
    const noh_pack *const *clip_packs; /* [clip_pack_count] several packs instead of `clips`; a clip in a later pack
                                        * replaces one of the same name. Must outlive the stage */
    uint32_t clip_pack_count;          /* 0 with `clips`; 0 with clip_packs: no clips at all */
    /* Bytes of a reserve for clips that are in memory only while they are needed (noh_stage_load_clip), at least the
     * largest clip's. Plans and init then read the clips' chunks, and nothing reads them later: only the rest of the
     * packs must outlive the stage. Default (0): clips are read in place */
    uint32_t clip_reserve;
    /* Clips of another skeleton in its packs play, too, as poses of its own: &retarget.clips of a noh_retarget
     * (low_life.h), which must outlive the stage, unchanged. They play like the kind's own, on any layer, with their
     * keys, floats and root motion of joint 0: where only this skeleton has a root above the hips, they move the hips.
     * In one pack, a clip of this skeleton hides mapped ones of its name; clips of a later pack replace both kinds.
     * Distance does not make poses less frequent, and with a map no level of detail leaves out joints; actors out of
     * view, or over update_budget_ns, still keep older poses. Bytes: 40 for each joint of that skeleton, and where the
     * hips are joint 0 of this one, 40 for each joint up to the feet; as many for each job. Default (NULL): they are
     * ignored */
    const noh_clip_map *map;
    const uint32_t *nodes; /* [node_count] draws only these nodes of `mesh`; in a pack without nodes, these meshes.
                            * Default (NULL) all. Read by plans and init */
    uint32_t node_count;
    uint32_t skeleton;    /* in `mesh`; default 0; NOH_NONE: only rigid meshes. Meshes skinned to another skeleton are
                           * ignored */
    uint32_t actor_count; /* most actors of this kind at one time; required */
    uint32_t visible_max; /* most actors drawn per frame; the farthest are culled (noh_stage_stats.left_out), with what
                           * they wear and carry. Sizes slots and palettes. Default (0) actor_count */
    uint32_t near_count;  /* most actors at the finest level at once */
    uint32_t
        middle_count; /* most at the next level. Both 0: 16, or more for actors spread evenly over 100 m; a bound may
                       * reduce them */
    uint32_t finest_level; /* finest level used (noh_stage_plan.kinds[].levels); default 0 */
    int levels_by_number;  /* 1: level k of an actor is level k of each of its meshes, or their coarsest; 0: each mesh
                            * takes its coarsest level within the actor's error */
    const noh_layer_desc *layers; /* [layer_count] default (NULL) three: "body" (base), "face" (over, floats only),
                                   * "add" (add) */
    uint32_t layer_count;         /* 0..NOH_LAYERS_MAX */
    /* Modules; default none, at no cost */
    noh_module graphs;  /* noh_graph_module: animation graphs that its actors may play */
    noh_module face;    /* noh_face_module (modules.h): live faces */
    noh_module ragdoll; /* noh_ragdoll_module (modules.h): ragdolls */
    noh_module springs; /* noh_springs_module (modules.h): the springs of the mesh's pack */
    noh_module match;   /* noh_match_module (modules.h): motion matching */
    /* Modifiers of poses (modules.h), in the order in which they run; default (NULL) none, at no cost */
    const struct noh_modifier *modifiers; /* [modifier_count] what they point to must outlive the stage */
    uint32_t modifier_count;              /* 0..NOH_MODIFIERS_MAX */
    int weight_rules;                     /* 1: apply the weight rules of the mesh's pack (low_life.h) to all weights:
                                         * ranges of targets, and targets that exclude each other */
    uint32_t change_count;                /* fades and other changes over time at once; default (0) 3 for each track */
    uint32_t held_float_count; /* floats that the game may hold at once (noh_actor_hold_float); default (0) 8; NOH_NONE:
                                * 0 */
    uint32_t root_axes;        /* NOH_ROOT_* that clips move the actor by; default (0) none. With NOH_ROOT_BY_GAME
                                * they do not move it: noh_actor_root returns the motion */
    uint32_t sample_rate_needed; /* frames per second needed: of a clip with twice as many, half are decoded, into half
                                  * the bytes (low_motion.h); default (0) all frames */
    int inertia;                 /* 1: room for NOH_PLAY_INERTIA: 48 bytes a joint and 8 a float for each actor */
    int unpickable;              /* 1: noh_stage_pick passes through */
    const noh_texture_set *texture_sets; /* [texture_set_count] for noh_appearance.texture_set; borrowed */
    uint32_t texture_set_count;          /* 0..NOH_TEXTURE_SETS_MAX */
    uint32_t worn_by; /* bit k: actors of kind k may wear its actors (noh_actor_wear), at 2 bytes a joint and a float
                       * for each such kind; its own actors then wear nothing. Default (0) none */
    uint32_t cover_count; /* most sets of garments worn at one time, 0..255, whose hidden triangles (noh build --wear)
                           * are left out of its meshes, at the bytes of their indices for each. An actor with another
                           * set is drawn whole. Without GPU, and for meshes with `finer`, none. Default (0) none */
    /* 1: its index is a slot: noh_stage_set_kind takes the kind out while the stage runs, and puts others in. The plan
     * reserves room for the largest of this kind and `others`, keeps it whole under bounds, and the slot shares no clips
     * with other kinds. 2: the same, and the slot is empty after init: this kind only sizes it. Default (0): the kind
     * stays. With `gpu` such a stage has one morph path, not streams, and no finished vertices; bounds leave halves as
     * they are; and a slot's kinds have no `finer` */
    int changes;
    const struct noh_kind_desc *others; /* [other_count] with `changes`; their own changes and others are ignored.
                                         * Read by plans, with `gpu` also by init; not kept. With `gpu` the packs of
                                         * all kinds of the plan are read as long as the stage is: by new programs, and
                                         * by noh_stage_set_kind. Default (NULL) none */
    uint32_t other_count;
} noh_kind_desc;

struct noh_gl_light_desc;
typedef struct noh_stage_gpu noh_stage_gpu; /* noh_gl.h defines the only one, noh_stage_on_gl */

/* How much the library's shaders compute at each pixel. The phone tier approximates: ambient light comes from the
 * vertices, the shadow map is read once, and reflectance, highlights and the light in skin are simpler fits. On GPUs of
 * phones a lit pixel takes about 0.6 of the time. Shaders of your own that call noh_light get the same. */
typedef enum noh_shading { NOH_SHADING_FULL, NOH_SHADING_PHONE } noh_shading;

/* Another stage, planned earlier. */
typedef struct noh_stage_peer {
    const struct noh_stage_desc *desc;
    const struct noh_stage_plan *plan;
} noh_stage_peer;

/* Stages that share GL objects with this one, and that exist as long as it does: the plan counts only the objects that
 * they do not have. Only noh_stage_plan_make and noh_stage_plan_parts read it. Zeros: none */
typedef struct noh_stage_peers {
    const noh_stage_peer *peers; /* [peer_count] */
    uint32_t peer_count;
} noh_stage_peers;

/* Zero is a good default for every field except kinds and kind_count. */
typedef struct noh_stage_desc {
    const noh_kind_desc *kinds; /* [kind_count]; required */
    uint32_t kind_count;        /* 1..NOH_STAGE_KINDS_MAX */
    uint64_t cpu_bytes_max;     /* bounds for the plan; default (0) none */
    uint64_t gpu_bytes_max;
    uint64_t bytes_max;   /* bound for the sum, where CPU and GPU share memory */
    noh_lod_settings lod; /* `pixels` is the largest error on screen; zeros: the defaults above */
    uint32_t height_px;   /* view height that slots are planned for; default (0) 1,080 */
    uint32_t job_count;   /* jobs that may run at once (noh_stage_job); default (0) 1 */
    uint32_t event_count; /* most callback keys of one step in noh_stage_events; default (0) 64 plus one per actor */
    uint32_t load_bytes;  /* most bytes uploaded per frame after noh_stage_load_level and noh_stage_set_kind; below 256
                           * counts as 256; default (0) 65,536 */
    uint64_t update_budget_ns; /* bound on posing per frame, estimated from counts, not measured; default (0) none */
    uint32_t slot_moves;       /* most slots reassigned per frame; each is accumulated again. Waiting actors are drawn
                                * coarser, or without targets until they have a slot. 1 counts as 2; default (0) no
                                * bound. A frame with a cut has no bound */
    int tangents;    /* 1: accumulators also hold tangents, for your own shaders that read morphed tangents; the
                           * library's do not */
    int halves;      /* 1: 16-bit accumulators; -1: always 32-bit; default (0) 32-bit unless a bound needs
                           * 16-bit */
    int encode_srgb; /* 1: shaders encode to sRGB, for framebuffers that do not, such as WebGL's canvas */
    int full_detail; /* 1: shows each actor at its kind's finest level, or at noh_appearance.level, in full detail: no
                           * LOD tables, no programs that fade or use fewer influences */
    noh_shading shading; /* default (0) NOH_SHADING_FULL */
    int without_depth;   /* 1: NOH_PASS_DEPTH is never drawn, and its programs are not compiled */
    int user_values; /* 1: your own shaders read noh_appearance.user; NOH_USER_COMPLEXION: it is a complexion, which the
                           * library's shaders draw. Each mesh of a visible actor then takes 16 bytes more on the CPU
                           * and the GPU */
    int motion; /* 1: your own shaders read where a vertex was in the last frame (noh_clip_before), for motion vectors:
                           * palettes take twice the bytes on the GPU and three times on the CPU, accumulators twice */
    int sort_blended; /* 1: blended meshes of all actors are drawn from far to near, one actor after another, at 8 bytes
                           * for each actor; default (0) kind by kind, crowds in one draw */
    int without_shader;   /* 1: every noh_stage_draw names a shader, and the library's programs are not compiled */
    int without_transfer; /* 1: meshes with a transfer (light.h) are lit like those without one, and transfer records
                           * are not uploaded; without `light` they never are */
    uint32_t morph_path;  /* noh_morph_path (noh_gl.h); default (0) the cheapest */
    /* 1: the path cpu keeps sums in a texture, for your own renderers that read it, or shaders that use noh_a_position
     * as the bind pose. Default (0): it writes finished vertices (noh_gl_morph_desc.vertices) unless halves, a
     * transfer, levels loaded later, or a kind of several actors need sums */
    int morph_sums;
    /* Reflections and the shadow map (noh_gl.h). Shaders are then lit by noh_stage_set_lighting. Must outlive the
     * stage. Default (NULL) a plain light that needs neither */
    const struct noh_gl_light_desc *light;
    /* Bytes on the GPU for textures whose finer levels are loaded when their size on screen needs them, in pieces of
     * load_bytes, and dropped when others need the room. Until a level is loaded, coarser ones are shown. Levels up to
     * 64 x 64 are always loaded. Frames read the textures' packs. The least is all these small levels twice, and the
     * largest texture whole. Textures of kinds that change, masks at vertices and toons' ramps stay whole. Default (0)
     * all textures whole */
    uint64_t texture_reserve;
    const noh_stage_gpu *gpu; /* &noh_stage_on_gl of noh_gl.h; default (NULL) nothing is drawn */
    /* Not NULL: the GL objects of a pack exist once for all stages of the same ledger that set it (noh_gl.h). Default
     * (NULL) each stage has its own */
    const noh_stage_peers *share;
} noh_stage_desc;

/* ---- the plan ---- */

/* A level of an actor: a level for each of its meshes, all within error_m. */
typedef struct noh_actor_level {
    float error_m; /* certified, the largest of its meshes */
    uint32_t triangle_count;
    uint32_t slot_count; /* actors that may be at this level, or a finer one with a free slot, at one time */
    uint8_t mesh_levels[NOH_STAGE_MESHES_MAX];
} noh_actor_level;

/* Memory and counts of a kind's clips, read from its packs once per plan. */
typedef struct noh_kind_clips {
    uint64_t bank_bytes, view_bytes; /* 0: no clip fits */
    uint32_t clip_count, event_count, marker_count, joint_count, float_count;
    uint32_t cached_segment_count, segment_count;
    uint32_t asked; /* cached segments that it was computed for */
} noh_kind_clips;

/* What the slot of a kind that changes has room for: the largest of each, over all kinds that it was planned for. */
typedef struct noh_kind_room {
    uint64_t actor_count, joint_count, skin_joint_count; /* of the skeleton; of the largest skin */
    uint64_t state_bytes, kind_bytes;                    /* in the state; of the rest of the kind, with its clips */
    uint64_t view_bytes;                                 /* of its clips' views, for each job */
    uint64_t scratch_bytes, module_scratch_bytes;        /* for each job, shared by all kinds */
    uint64_t pick_bytes, inertia_bytes;                  /* shared by all kinds */
    uint64_t mesh_count, drawn_bytes, gpu_bytes;         /* with `gpu`: meshes; what draws them, on CPU and GPU */
} noh_kind_room;

/* The plan of a kind. */
typedef struct noh_kind_plan {
    uint32_t mesh_count, level_count, finest_level;
    uint32_t track_count, joint_count, float_count;
    uint32_t cached_segment_count, segment_count; /* of its clips: held decoded at once; in all */
    noh_kind_clips clips;                         /* of the kind whose clips it shares: itself, or an earlier one */
    noh_actor_level levels[NOH_LOD_LEVELS_MAX];
    uint32_t meshes[NOH_STAGE_MESHES_MAX]; /* [mesh_count] of its mesh pack, in the order of mesh_levels */
    noh_kind_room room;                    /* of a kind that changes; otherwise 0 */
} noh_kind_plan;

/* A reduction made to keep a bound. */
typedef struct noh_concession {
    const char *what;  /* a constant: "half-float accumulators", "cached segments", "slots", "finest level" */
    uint32_t kind;     /* NOH_NONE: all kinds */
    uint32_t value;    /* after the reduction */
    float loss_pixels; /* largest error it may show, at the distance where the dropped level would begin; 0: none */
    uint64_t cpu_bytes, gpu_bytes; /* bytes saved */
} noh_concession;

/* Plain data, 12 KiB, that can be printed, compared and stored with the build. */
typedef struct noh_stage_plan {
    uint64_t cpu_bytes; /* size of the block for noh_stage_init; exact */
    uint64_t gpu_bytes; /* of all its GL objects; exact, as the ledger counts. With slots or texture_reserve, at most.
                           * With peers, only while these are there */
    uint64_t shared_bytes; /* on the GPU, not in gpu_bytes: objects of its peers that it uses */
    uint64_t state_bytes;  /* size of noh_stage_state; included in cpu_bytes */
    uint64_t pack_bytes;   /* of the packs, which are read in place and not counted above; without `finer`,
                           * and without clips that only kinds with clip_reserve play */
    uint32_t halves;       /* 1: 16-bit accumulators */
    uint32_t sums;         /* 1: sums instead of finished vertices, as with morph_sums */
    uint32_t morph_path;   /* the chosen noh_morph_path; 0 without GPU */
    uint32_t hash;         /* of the desc and the plan; states of other plans are refused */
    uint32_t concession_count;
    noh_concession concessions[NOH_CONCESSIONS_MAX]; /* in the order they were made */
    noh_kind_plan kinds[NOH_STAGE_KINDS_MAX];
} noh_stage_plan;

struct noh_gl_caps;

/* Plan a stage and compute its exact memory. Needs no driver and allocates nothing; the same desc, packs and
 * capabilities give the same plan everywhere. If a bound is exceeded, the plan makes these reductions in order, until
 * the bound is met: 16-bit accumulators; cached segments, down to half; slots of finer levels, the finest first, unless
 * near_count or middle_count reserve them; the finest level; cached segments, down to two per bank. Then 32-bit
 * accumulators and cached segments are restored if they fit.
 *
 * caps    noh_gl_caps (gl_device.h), as noh_gl_open fills it in; NULL with desc->gpu NULL
 * errors  ARG a field of the desc is invalid (where: the kind), or caps are NULL or zeros; NOT_FOUND no pack of a kind
 *         has a graph that its `graphs` names; MEMORY no plan keeps the bounds (need: bytes of the smallest plan);
 *         LIMIT; DATA a clip is damaged. *plan is then undefined */
noh_result noh_stage_plan_make(const noh_stage_desc *desc, const struct noh_gl_caps *caps, noh_stage_plan *plan,
                               noh_error *error);

/* One entry of the plan's memory. */
typedef struct noh_stage_bytes {
    const char *what; /* a constant: "clips", "characters", "accumulators" */
    uint32_t kind;    /* NOH_NONE: all kinds */
    uint64_t cpu_bytes, gpu_bytes;
} noh_stage_bytes;

/* List the plan's memory by use; the entries add up to cpu_bytes and gpu_bytes.
 * shapes   parts[capacity]
 * returns  the number of entries; entries past `capacity` are not written */
uint32_t noh_stage_plan_parts(const noh_stage_desc *desc, const struct noh_gl_caps *caps, const noh_stage_plan *plan,
                              noh_stage_bytes *parts, uint32_t capacity);

/* ---- a stage ---- */

typedef struct noh_stage noh_stage;

/* Build a stage in memory[bytes], aligned to NOH_MEMORY_ALIGN and at least plan->cpu_bytes long.
 * desc    the desc that the plan was made from; its packs and names must outlive the stage, the rest is copied
 * plan    must outlive the stage
 * device  a noh_gl_device (gl_device.h) with all fields set but the log; its table, caps and ledger must outlive the
 *         stage. NULL with desc->gpu NULL
 * errors  as noh_stage_plan_make; NOT_FOUND a joint or float of a layer does not exist (where: the kind, plus 2^32
 *         times the layer; need: the byte of its name in the layer's list); ARG memory is NULL or misaligned, the
 *         plan is of another desc, or the device is NULL or lacks a field; MEMORY memory is too small (need: the
 *         bytes), or the driver is out of memory; GL, DATA the driver refused an object or a shader. All GL objects
 *         made so far are then deleted */
noh_result noh_stage_init(void *memory, size_t bytes, const void *device, const noh_stage_desc *desc,
                          const noh_stage_plan *plan, noh_stage **stage, noh_error *error);

/* Delete the GL objects. The block may then be reused. For a lost context see gl_device.h. */
void noh_stage_delete(noh_stage *stage);

/* Make the GL objects again in a new context (gl_device.h): the next frame shows what it would have shown.
 * errors  GL, MEMORY, DATA. The stage then has no GL objects; restore may be called again. ARG it shares, and
 *         noh_gl_ledger.contexts was not counted after the context was lost: nothing has changed */
noh_result noh_stage_restore(noh_stage *stage, noh_error *error);

/* A clip to be loaded: read these bytes of its pack's file and pass them to noh_stage_load_clip. */
typedef struct noh_wanted_clip {
    uint32_t kind, clip;    /* of the first kind that has these clips */
    uint32_t pack;          /* index in clip_packs; 0 with `clips` */
    uint32_t offset, bytes; /* its chunk */
} noh_wanted_clip;

/* Counts of the last frame, and the largest of them since noh_stage_init. Not part of the state. */
typedef struct noh_stage_stats {
    uint32_t actors, seen, updated, fading, events;
    uint32_t at_level[NOH_LOD_LEVELS_MAX]; /* visible actors by level */
    uint32_t coarser;                      /* actors drawn coarser than chosen: too few slots */
    uint32_t moved, waiting;               /* slots reassigned; actors waiting for one (slot_moves) */
    uint32_t resting;                      /* actors without a slot yet: drawn without targets */
    uint32_t left_out;                     /* actors in view but not drawn: visible_max is too small */
    uint32_t loading;                      /* kinds that are loading, or finer levels of them (noh_stage_load_level) */
    uint32_t coming;                       /* bit k: kind k was not drawn yet in the last frame (noh_stage_set_kind) */
    uint32_t load_bytes;                   /* bytes of them uploaded */
    uint64_t decoded;                      /* track-frames */
    uint64_t decoded_late;                 /* those among them that a pose had to wait for: too few cached segments */
    uint32_t events_lost;                  /* since init: event_count is too small */
    /* the largest `actors` of all frames, not of steps without one: the most at once. What actor_count needs is each
     * kind's own peak, and these may add up to more */
    uint32_t actors_high;
    /* the largest `events` of all steps, with frames or without: the event_count that a game needs */
    uint32_t events_high;
    /* the largest `coarser` of all frames: 0 if the slots of all kinds have been enough */
    uint32_t coarser_high;
    /* textures shown coarser than needed: finer levels are being loaded, or texture_reserve is too small */
    uint32_t textures_coarser;
    uint32_t wanted_count; /* clips that were needed while they were absent, and are still absent */
    /* [wanted_count] the longest wanted first; a full list drops its first. noh_stage_load_clip removes the clip that
     * it loads, and the clips after it move down: walk the list from its end */
    const noh_wanted_clip *wanted;
    float error_pixels; /* the largest of all visible actors */
} noh_stage_stats;

const noh_stage_stats *noh_stage_stats_of(const noh_stage *stage);

/* ---- names ---- */

typedef enum noh_name {
    NOH_NAME_CLIP,
    NOH_NAME_LAYER,
    NOH_NAME_FLOAT,
    NOH_NAME_JOINT,
    NOH_NAME_GRAPH,
    NOH_NAME_PARAMETER,   /* of the kind's graphs */
    NOH_NAME_MACHINE,     /* a machine, select or one-shot of its graphs */
    NOH_NAME_TEXTURE_SET, /* 0: the kind's own, "" */
    NOH_NAME_MESH         /* a drawn mesh: its bit in noh_appearance.hidden_meshes */
} noh_name;

/* Find the index of a name in a kind; NOH_NONE if there is none. Look names up once, not every frame. Floats are the
 * morph targets of all meshes and the named floats of clips; targets with the same name in several meshes share one
 * float. */
uint32_t noh_stage_find(const noh_stage *stage, uint32_t kind, noh_name what, const char *name);

/* The name of an index; NULL past the last. */
const char *noh_stage_name(const noh_stage *stage, uint32_t kind, noh_name what, uint32_t index);

/* ---- actors ---- */

/* An actor; id 0: none. 16 bits of index and 16 of generation: it may be stored, copied and sent over a network. An
 * index is reused as late as possible, and its generation repeats after 65,535 uses. */
typedef struct noh_actor {
    uint32_t id;
} noh_actor;

typedef struct noh_place {
    float position[3];
    float rotation[4]; /* quaternion x, y, z, w; all 0: the identity */
    float scale;       /* above 0; 0: 1 */
} noh_place;

/* Create an actor of a kind. It plays nothing yet.
 * place   NULL: the origin
 * errors  ARG kind, or a field of place; LIMIT all actors of the kind exist (need: their number) */
noh_result noh_stage_spawn(noh_stage *stage, uint32_t kind, const noh_place *place, noh_actor *actor, noh_error *error);

/* Despawn an actor immediately and detach its children.
 * errors  NOT_FOUND */
noh_result noh_stage_despawn(noh_stage *stage, noh_actor actor, noh_error *error);

/* The actor at an index below the sum of all actor_counts, kind after kind; id 0 if there is none. */
noh_actor noh_stage_actor_at(const noh_stage *stage, uint32_t index);

/* Set an actor's place, before root motion, as of the next step; if called after a step and before the next frame, as
 * of that step. Frames between two steps interpolate towards it (noh_stage_frame_between); other frames show it there.
 * errors  NOT_FOUND; ARG a value that is not finite or beyond NOH_NUMBER_MAX, a rotation without length, a scale that
 *         is neither 0 nor 10^-12..10^12 */
noh_result noh_actor_set_place(noh_stage *stage, noh_actor actor, const noh_place *place, noh_error *error);

/* An actor's place after the last step; relative to the joint if it is attached.
 * errors  NOT_FOUND */
noh_result noh_actor_place(const noh_stage *stage, noh_actor actor, noh_place *place, noh_error *error);

/* An actor's place as shown by a frame between the last two steps, for cameras that follow it. Positions and scales are
 * interpolated linearly, rotations by noh_quat_nlerp.
 * ranges  alpha as in noh_stage_frame_between
 * errors  NOT_FOUND; ARG alpha */
noh_result noh_actor_place_between(const noh_stage *stage, noh_actor actor, float alpha, noh_place *place,
                                   noh_error *error);

/* Teleport: do not interpolate from the previous step. From the next frame on the actor shows its place and pose after
 * the last step, even between two steps, and its detail is chosen again. Call it after noh_actor_set_place or
 * noh_actor_play. Until that frame the actor counts as never posed.
 * errors  NOT_FOUND */
noh_result noh_actor_cut(noh_stage *stage, noh_actor actor, noh_error *error);

#define NOH_USER_COMPLEXION 2 /* noh_stage_desc.user_values: of noh_complexion_random (face.h) */

/* An actor's appearance. All zeros: visible, with a shadow, within the stage's error, in its own colours. */
typedef struct noh_appearance {
    uint8_t hidden;         /* 1: neither drawn nor picked; clocks and callback keys go on */
    uint8_t no_shadow;      /* 1: not drawn in depth passes of views without height_px */
    uint8_t posed;          /* 1: posed every frame in full detail, visible or not: for noh_actor_joint on a server */
    uint8_t smoothed;       /* how far its wrinkles are smoothed out; 255: completely */
    uint32_t hidden_meshes; /* bit i: mesh i of its kind (NOH_NAME_MESH) is neither drawn nor picked */
    float pixels;           /* its own largest error; 0: the stage's */
    uint32_t level;         /* 1 + the level to show, in full detail otherwise; 0: chosen by error */
    uint8_t tint[4];      /* sRGB and alpha, multiplied with the colours of materials that accept a tint; alpha is used
                           * only by blended materials. All 0: white */
    uint32_t texture_set; /* 0: its kind's own textures; else noh_kind_desc.texture_sets[texture_set - 1] */
    uint8_t wrinkle_models; /* NOH_WRINKLE_BY_* (format.h); 0: as its materials have them */
    uint8_t reserved[3];    /* 0 */
    float user[4];          /* noh_user() in vertex shaders, with noh_stage_desc.user_values: yours, or a complexion */
} noh_appearance;

/* Set an actor's appearance.
 * errors  NOT_FOUND; ARG pixels is not in 0..NOH_PIXELS_MAX, the kind has no such texture_set, or wrinkle_models has
 *         unknown bits */
noh_result noh_actor_set_appearance(noh_stage *stage, noh_actor actor, const noh_appearance *look, noh_error *error);

/* Attach an actor to a joint of another actor, which may itself be attached. Its place is then relative to the joint.
 * The parent is posed whenever the actor is visible; a hidden parent hides the actor. When the parent is despawned, the
 * actor stays where it was shown.
 * parent  id 0: detach, and stay in place
 * errors  NOT_FOUND either actor is gone, or the parent has no such joint; ARG the parent is the actor itself, or is
 *         attached to it; LIMIT the chain of attachments would be longer than NOH_ATTACH_DEPTH_MAX (need: its
 *         length) */
noh_result noh_actor_attach(noh_stage *stage, noh_actor actor, noh_actor parent, uint32_t joint, noh_error *error);

/* Put a garment on: an actor of a kind whose worn_by has the wearer's kind. It stands where the wearer stands. Each of
 * its joints is posed as the wearer's joint of the same name, and each of its targets has the weight of the wearer's
 * target of the same name, unless the game holds it; other joints, as of a skirt, move by the garment's own clips and
 * springs. Model both packs in the same bind pose. It is posed with the wearer, in the same job. A hidden wearer hides
 * it. noh_actor_attach with parent id 0 takes it off. The next frame shows the change.
 * errors  NOT_FOUND either actor is gone, or no joint of the garment has the name of a joint of the wearer; ARG worn_by
 *         of the garment's kind lacks the wearer's kind; LIMIT as noh_actor_attach */
noh_result noh_actor_wear(noh_stage *stage, noh_actor garment, noh_actor wearer, noh_error *error);

/* ---- play ---- */

#define NOH_PLAY_KEEP 1u       /* do nothing if this clip already plays on the layer */
#define NOH_PLAY_PHASE 2u      /* begin at the phase of the clip it replaces: walk to run */
#define NOH_PLAY_INERTIA 4u    /* no cross-fade: the clip plays at once, and the difference decays within fade_ticks */
#define NOH_PLAY_BESIDE 8u     /* the layer's other clips continue, blended with this one by weight; not with INERTIA */
#define NOH_PLAY_FROM_BIND 16u /* on an additive layer: the difference from the bind pose and the floats' defaults */

/* All zeros: the clip plays at its own speed from its start, faded in within a fifth of a second. */
typedef struct noh_play {
    uint32_t fade_ticks; /* default (0) 9,600; 1: at once */
    int32_t speed;       /* 1/65,536; default (0) 65,536; negative: backwards */
    int64_t start_ticks; /* default 0 */
    float weight;        /* default (0) 1 */
    noh_loop loop;       /* default NOH_LOOP_OF_CLIP: the clip's own */
    uint32_t sync_group; /* default (0) none; 1..NOH_SYNC_GROUPS_MAX */
    uint32_t flags;      /* NOH_PLAY_* */
    /* On an additive layer: the clip whose first frame is the reference pose. Default (NULL) this clip itself, so a
     * clip of one pose adds nothing: give it a reference, or NOH_PLAY_FROM_BIND */
    const char *reference;
} noh_play;

/* Play a clip on a layer; clips that played there fade out. If all tracks of the layer are in use, the one with the
 * least weight ends. On a base layer that moves joints and plays nothing, the clip starts at full weight.
 * play    NULL: zeros
 * errors  NOT_FOUND the actor is gone, or the kind has no such clip or reference; ARG layer, a field of play, or
 *         NOH_PLAY_INERTIA without noh_kind_desc.inertia; LIMIT too many changes over time at once (need: the count
 *         wanted), or NOH_PLAY_BESIDE finds no free track (where: the layer, need: tracks); with clip_reserve as
 *         noh_stage_load_clip says */
noh_result noh_actor_play(noh_stage *stage, noh_actor actor, uint32_t layer, const char *clip, const noh_play *play,
                          noh_error *error);

/* Fade a layer out with its root motion, to the other layers or to the bind pose; fade_ticks as in noh_play.
 * errors  as noh_actor_play */
noh_result noh_actor_stop(noh_stage *stage, noh_actor actor, uint32_t layer, uint32_t fade_ticks, noh_error *error);

/* The newest track of a layer; NULL: the actor is gone, or nothing plays there. */
const noh_track *noh_actor_track(const noh_stage *stage, noh_actor actor, uint32_t layer);

/* The actor's controller, for operations that the calls above do not cover, and the clip set that its functions take.
 * NULL: the actor is gone. */
noh_controller *noh_actor_controller(noh_stage *stage, noh_actor actor, const noh_clip_set **set);

/* Hold a float: blend the value from the clips towards this one.
 * ranges  amount 0..1: 1 shows only this value; 0 releases the float
 * errors  NOT_FOUND the actor is gone, or the kind has no such float; LIMIT held_float_count floats are already held
 *         (need: held_float_count); ARG value is not finite or beyond NOH_NUMBER_MAX, or
 *         amount is not in 0..1 */
noh_result noh_actor_hold_float(noh_stage *stage, noh_actor actor, uint32_t index, float value, float amount,
                                noh_error *error);

/* ---- graphs ---- */

/* For noh_kind_desc.graphs.
 * names  of graphs in the kind's packs of clips (noh build --graph, noh_graph_init), separated by blanks; '*' at the
 *        end matches any rest. An actor plays one of them at a time. Read by plans and by init. NULL: none */
noh_module noh_graph_module(const char *names);

/* Play an animation graph (graph.h) on a base or over layer, from its beginning: all its parameters as the pack
 * has them. It fades in as a clip does, and what played on the layer fades out; noh_actor_play and noh_actor_stop fade
 * it out again. An actor plays one graph at a time: another one, or the same again, ends it at once, so give it
 * NOH_PLAY_INERTIA there. What the layer's mask lets through is the graph's; faces and additive layers play over it.
 * play    NULL: zeros; fade_ticks, weight, NOH_PLAY_KEEP and NOH_PLAY_INERTIA are used, all else is ARG
 * errors  NOT_FOUND the actor is gone, or the kind has no such graph; ARG layer, or one that adds; a field of play;
 *         within on_key of a key of a graph; LIMIT as noh_actor_play */
noh_result noh_actor_play_graph(noh_stage *stage, noh_actor actor, uint32_t layer, const char *graph,
                                const noh_play *play, noh_error *error);

/* Set a parameter of the playing graph, by its index from noh_stage_find: blend spaces react at once, machines at the
 * start of the next step. The value is clamped to the parameter's range; 1 fires a trigger; an enumerated parameter
 * takes a number from noh_stage_find_value. Parameters with the same name in several graphs of a kind have the same
 * index.
 * errors  NOT_FOUND the actor is gone, or plays no graph with this parameter; ARG value is not finite */
noh_result noh_actor_set_parameter(noh_stage *stage, noh_actor actor, uint32_t parameter, float value,
                                   noh_error *error);

/* The current value of a parameter; 0 where noh_actor_set_parameter would be NOT_FOUND. */
float noh_actor_parameter(const noh_stage *stage, noh_actor actor, uint32_t parameter);

/* The number of a named value of an enumerated parameter; NOH_NONE if there is none. */
uint32_t noh_stage_find_value(const noh_stage *stage, uint32_t kind, uint32_t parameter, const char *name);

/* The name of the state that a machine, select or one-shot of the graph is in or fading to; NULL where
 * noh_actor_set_parameter would be NOT_FOUND.
 * ranges  machine: an index of NOH_NAME_MACHINE */
const char *noh_actor_state(const noh_stage *stage, noh_actor actor, uint32_t machine);

struct noh_graph_pack;
struct noh_graph_state;

/* The graph instance that an actor plays, for operations that the calls above do not cover, and its graph
 * (graph.h). The stage steps it; do not step it yourself. NULL: the actor is gone, or plays none. */
struct noh_graph_state *noh_actor_graph(noh_stage *stage, noh_actor actor, const struct noh_graph_pack **graph);

/* ---- query ---- */

/* The floats as shown in the last frame: [float_count of the kind], valid until the next frame; NULL: the actor is
 * gone, or was not shown. */
const float *noh_actor_floats(const noh_stage *stage, noh_actor actor);

/* A joint's world matrix as last shown; a joint dropped by LOD moves rigidly with its parent.
 * errors  NOT_FOUND the actor is gone, was never posed, or has no such joint */
noh_result noh_actor_joint(const noh_stage *stage, noh_actor actor, uint32_t joint, float matrix[12], noh_error *error);

/* The root motion of the last step, in the actor's own space, in model units.
 * errors  NOT_FOUND the actor is gone */
noh_result noh_actor_root(const noh_stage *stage, noh_actor actor, noh_root_pose *moved, noh_error *error);

/* Bounding sphere in the world (centre x, y, z and radius) of every vertex as last posed, including rigid meshes and
 * targets of any weight; before the first pose, of every vertex in any pose of its clips. Vertices skinned by dual
 * quaternions may lie slightly outside.
 * errors  NOT_FOUND the actor is gone */
noh_result noh_actor_sphere(const noh_stage *stage, noh_actor actor, float sphere[4], noh_error *error);

/* A mesh of an actor as last shown, for deforming it on the CPU (noh_morph_accumulate, noh_skin_vertices): exact
 * bounds, decals, export. */
typedef struct noh_actor_mesh {
    uint32_t node, mesh;  /* of the kind's mesh pack; node NOH_NONE: a pack without nodes */
    uint32_t level;       /* of the mesh; a level that noh_kind_desc.mesh lacks is in the loaded pack */
    uint32_t joint_count; /* of its skin; 0: rigid */
    const float *weights; /* [target_count of the mesh]; valid until the next frame */
    float world[12];      /* of its deformed vertices */
} noh_actor_mesh;

/* Get a mesh of an actor as last shown.
 * shapes  matrices[joint_count][12] receives its palette in model space; may be NULL
 * errors  NOT_FOUND the actor is gone, was not shown in the last frame, or has no such mesh (need: how many) */
noh_result noh_actor_mesh_at(const noh_stage *stage, noh_actor actor, uint32_t index, noh_actor_mesh *out,
                             float *matrices, noh_error *error);

/* One draw of a view: the triangles of a submesh, once for each of `actor_count` actors. */
typedef struct noh_draw {
    uint32_t kind;
    uint32_t index;         /* of the mesh, as in noh_actor_mesh_at */
    uint32_t mesh, level;   /* in the kind's mesh pack, or, if that lacks the level, in the loaded pack */
    const uint32_t *actors; /* [actor_count] first_actor + each is an index for noh_stage_actor_at; until the next
                               * frame */
    uint32_t actor_count, first_actor;
    uint32_t influence_count;     /* joints per vertex that the level of detail takes, the strongest ones; 0: all */
    uint32_t texture_set;         /* of all of them (noh_appearance) */
    const noh_submesh *submesh;   /* indices, palette */
    const noh_material *material; /* never NULL */
    float alpha_cutoff;           /* pixels of a lower alpha are not drawn; -1: all are */
    float from, to; /* part of the pixels: all are 0 and 1. An actor that fades between two levels is drawn by two, the
                     * new level with (0, f), the old one with (f, 1) */
    int mirrored;   /* 1: its front faces are clockwise; actor_count is 1 */
} noh_draw;

/* List the draws of a view of the last frame, in the order in which noh_stage_draw makes them: for a renderer of your
 * own on any API, also of a stage without `gpu`. Matrices, weights and places come from noh_actor_mesh_at, vertices and
 * indices from the pack. A view without height_px has no actors with no_shadow.
 * blended   0: opaque surfaces, and the nearly opaque core of blended ones with a texture (alpha_cutoff); 1: blended
 *           ones, by priority, and within a priority each actor's meshes from far to near; with
 *           noh_stage_desc.sort_blended actor by actor
 * shapes    draws[capacity]
 * returns   how many draws there are, those past `capacity` too, which are not written; 0: the last frame had no such
 *           view, or a frame has begun and not ended. Outlines of toons and what garments cover are not listed */
uint32_t noh_stage_list_draws(const noh_stage *stage, uint32_t view, int blended, noh_draw *draws, uint32_t capacity);

/* The detail of an actor in the last frame. */
typedef struct noh_actor_detail {
    uint32_t level;           /* of noh_kind_plan.levels */
    uint32_t level_before;    /* the level that fades into it; otherwise `level` */
    float fade;               /* share of its pixels that show `level`; 1: all */
    uint32_t joint_count;     /* joints posed; the others move with their parents */
    uint32_t influence_count; /* most per vertex; 0: rigid */
    float error_m;            /* certified, including the update rate and dropped targets; in model units */
    float pixels_per_metre;   /* pixels per model unit at its nearest point, in the nearest view; 0: no view sees it */
} noh_actor_detail;

/* Get the detail of an actor in the last frame. Its error on screen is error_m * pixels_per_metre;
 * noh_stage_stats.error_pixels is the largest of all actors. The nearest point lies on the sphere of noh_actor_sphere
 * or, if a camera is inside the sphere, on the boxes of what each joint moves, but never nearer than the near plane.
 * Levels are chosen from the previous frame's bounds; an actor that has just come into view, or was cut, uses the bind
 * pose, and is chosen again in the next frame.
 * errors  NOT_FOUND the actor is gone, or was not shown in the last frame */
noh_result noh_actor_detail_of(const noh_stage *stage, noh_actor actor, noh_actor_detail *out, noh_error *error);

typedef struct noh_stage_hit {
    noh_actor actor;
    uint32_t mesh; /* in the kind's mesh pack */
    uint32_t submesh, triangle;
    uint32_t joint;      /* of the skeleton; NOH_NONE: rigid */
    float distance;      /* in multiples of the direction's length */
    float point[3];      /* world */
    float bind_point[3]; /* the same point in the bind pose */
    float barycentric[3];
} noh_stage_hit;

/* Find the nearest hit of a ray, origin + distance * direction, with the actors of the last frame, as morphed and
 * posed. Skinned meshes of an actor cut since then (noh_actor_cut) are not hit. The ray passes through texels that the
 * alpha test discards (deform.h); alpha is read from the kind's own textures, not from texture sets.
 * errors  NOT_FOUND nothing is hit; ARG direction has zero length, or distance_max is not above 0 */
noh_result noh_stage_pick(noh_stage *stage, const float origin[3], const float direction[3], float distance_max,
                          noh_stage_hit *hit, noh_error *error);

/* ---- a frame ---- */

/* A callback key that was passed. */
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

/* Called during a step, at the tick of a key. It may play, stop, hold and move the key's actor from that tick on. Calls
 * that change other actors return NOH_ERR_ARG, because the result would depend on the order of actors. */
typedef void (*noh_stage_event_fn)(void *user, noh_stage *stage, const noh_stage_event *event);

/* Advance time for all actors, visible or not: clocks, fades, callback keys, root motion. A frame may follow any number
 * of steps.
 * on_key  NULL: keys are only in noh_stage_events
 * errors  ARG called within on_key, or during a frame */
noh_result noh_stage_step(noh_stage *stage, uint32_t ticks, noh_stage_event_fn on_key, void *user, noh_error *error);

/* The keys of the last step: actor by actor, each in order of time. Valid until the next step. */
const noh_stage_event *noh_stage_events(const noh_stage *stage, uint32_t *count);

/* Move the world's origin to `by`: subtracts `by` from every position in the stage. This covers actors (also before the
 * last step), ragdolls, springs, feet and hair, the points that faces, gazes and hands aim at, and joints and spheres
 * of the last frame. The game moves its own data: cameras, lights, the world of ragdolls, the ground, the state of its
 * own modifiers (noh_actor_modifier). Crowds and walkers have their own calls (noh_crowd_shift_origin,
 * noh_walkers_shift_origin). Multiples of 16 are exact.
 * errors  ARG by is not finite or beyond NOH_NUMBER_MAX, or called during a step or a frame */
noh_result noh_stage_shift_origin(noh_stage *stage, const float by[3], noh_error *error);

/* A camera or a light; noh_view_orbit and noh_view_shadow fill one. */
typedef struct noh_stage_view {
    float view_projection[16]; /* column-major, clip space of GL; perspective or parallel */
    float eye[3];
    float light[3];     /* unit vector towards the key light */
    uint32_t height_px; /* of the picture; 0: for shadows only, does not affect detail */
    uint32_t cut;       /* 1: the camera jumped: detail is chosen again, nothing fades */
    /* Rounding errors of the last column of view_projection and of `eye`, which matter far from the origin;
     * noh_view_orbit fills them. 0: the whole picture is shifted by the rounding */
    float column_rest[4], eye_rest[3];
} noh_stage_view;

/* Get the point that world matrices on the GPU, and the cameras passed to shaders, are relative to. A shader that needs
 * a world position adds it. All 0 while the camera is within 512 units of the origin. Far from the origin: root motion,
 * poses, bounds, culling and pictures are as exact 1,000,000 units away as at the origin, to a tenth of a millimetre if
 * a unit is a metre. An actor's place also stores its rounding error, and a frame is computed relative to a point near
 * its first camera. Floats passed to and from this interface are rounded: to 0.5 mm at 8 km, 4 mm at 100 km, 32 mm at
 * 1,000 km. */
void noh_stage_origin(const noh_stage *stage, float origin[3]);

/* Begin a frame with views[view_count], 0..NOH_STAGE_VIEWS_MAX. An actor is shown if any view sees it, in the finest
 * detail that any view needs.
 * errors  ARG a number of a view is not finite or beyond NOH_VIEW_NUMBER_MAX (where: the view), or a frame has begun */
noh_result noh_stage_frame_begin(noh_stage *stage, const noh_stage_view *views, uint32_t view_count, noh_error *error);

/* Begin a frame between the last two steps, for a game that steps at a fixed rate and draws at another. The frame
 * interpolates the places and poses of the two steps: with `left` ticks until the next step of `ticks`, use alpha = 1 -
 * left / ticks; the frame is then up to a step behind callback keys. Places, joint matrices and floats are
 * interpolated, so skinned vertices move in straight lines between steps; at 30 steps a second this has the same error
 * as poses at 30 Hz. An actor in full detail is posed once per step. Actors posed less often are not
 * interpolated between steps. Held floats and appearances show at once, as does the place of an actor that was spawned,
 * attached or cut. noh_actor_joint, noh_actor_sphere and noh_stage_pick agree with the frame.
 * ranges  alpha 0..1: 0 the step before the last, 1 the last; rounded to a tick
 * errors  as noh_stage_frame_begin, which is alpha 1; ARG alpha */
noh_result noh_stage_frame_between(noh_stage *stage, const noh_stage_view *views, uint32_t view_count, float alpha,
                                   noh_error *error);

/* Begin the next phase of a frame and return its number of jobs; 0: no phase is left. All jobs of a phase must have
 * returned before the next call.
 *   while ((count = noh_stage_jobs(stage)) > 0)
 *       noh_stage_job(stage, i) for each i below count, on any threads, in any order; wait for all */
uint32_t noh_stage_jobs(noh_stage *stage);

/* Run one job of the phase; call it once for each index. No job touches memory that another job of the phase writes:
 * there are no locks and no atomics, and results have the same bits for any number of threads. */
void noh_stage_job(noh_stage *stage, uint32_t job);

/* Run the remaining phases and upload everything to the GPU, on the thread of the context. This draws moving faces into
 * textures: bind your framebuffer and set the viewport afterwards.
 * errors  ARG no frame has begun */
noh_result noh_stage_frame_end(noh_stage *stage, noh_error *error);

/* Run one step and one whole frame on this thread.
 * view    NULL: none */
noh_result noh_stage_frame(noh_stage *stage, uint32_t ticks, const noh_stage_view *view, noh_stage_event_fn on_key,
                           void *user, noh_error *error);

/* ---- levels loaded later ---- */

/* Load the levels that a kind's `finer` has and its `mesh` lacks. Each noh_stage_frame_end uploads at most
 * desc->load_bytes; once all are uploaded (noh_stage_stats.loading), the next frame chooses among all levels of the
 * plan, and they fade in. Memory was reserved at init. Kinds of the same `mesh` and `finer` share their levels: loading
 * them for one kind loads them for all. Picking uses the levels of `mesh`. Loading the same pack again is no error.
 * pack    `finer`, or any pack with the same levels. The pack and its bytes must stay valid until the levels are
 *         dropped or the stage is deleted: faces and noh_stage_restore read them. NULL: drop the levels that were
 *         loaded or are loading: from the next frame on their actors are drawn coarser, without a fade. The pack is no
 *         longer read; its GPU memory stays reserved, as planned. Until the next frame noh_actor_mesh_at may still
 *         return these levels
 * errors  ARG kind, or called during a frame or a step; UNSUPPORTED the kind has no `finer`, or the plan none of its
 *         levels; DATA a mesh of the kind was not stripped from its mesh in `pack`, or `pack` has too few levels
 *         (where: the mesh). Nothing has then changed */
noh_result noh_stage_load_level(noh_stage *stage, uint32_t kind, const noh_pack *pack, noh_error *error);

/* ---- clips loaded later ---- */

/* Load a clip of a kind with clip_reserve into the reserve, or ask for it. Clips that play stay loaded. Of the others,
 * the least recently used are dropped first where the new clip needs room. Kinds with the same clips share them.
 * A call that would start an absent clip fails with NOT_FOUND and leaves the actor as it was: noh_actor_play,
 * noh_actor_play_graph, calls of walkers. Motion matching goes on with what it plays, and getting up takes another
 * clip. The absent clip is then in noh_stage_stats.wanted. Durations, keys and names of absent clips are known. Clips
 * that are needed together (all of a graph or of walkers, an additive clip and its reference) fail with MEMORY if the
 * clips that play leave too little room for all (need: the bytes of clip_reserve), and are not in `wanted`. Which clips
 * are loaded depends only on the order of calls, not on jobs or time, and is not part of the state.
 * clip    as noh_stage_find has it
 * chunk   the whole chunk, as in the pack's file: noh_wanted_clip.bytes, copied. Any alignment. Bytes with the checksum
 *         that the pack gives are trusted as the pack is. NULL: ask for the clip, which puts it into
 *         noh_stage_stats.wanted if it is absent
 * errors  ARG kind, or called during a frame or a step; UNSUPPORTED the kind has no clip_reserve; NOT_FOUND no such
 *         clip (need: their count); DATA the bytes differ from those that the stage was made with; MEMORY what plays
 *         leaves too little of the reserve (where: bytes of clips that play, need: bytes). Nothing has then changed */
noh_result noh_stage_load_clip(noh_stage *stage, uint32_t kind, uint32_t clip, const void *chunk, noh_error *error);

/* ---- kinds that change ---- */

/* Put a kind into an empty slot (noh_kind_desc.changes), or empty the slot. Everything else stays where it is, and what
 * runs goes on with the same bits; the kind then equals one that was there from init. The state holds which kinds are
 * in the slots, and is restored only where they are the same. Ids of its former actors stay gone.
 * With `gpu` its GL objects are made now and filled in pieces by the frames that follow. Its actors move and are posed
 * and picked meanwhile, but nothing is drawn of them until all is there (noh_stage_stats.coming); an error of GL sends
 * a piece again. Programs are those that the kinds of the plan need: none is compiled.
 * kind    the index of the slot
 * desc    as in noh_stage_desc.kinds; any kind that fits, planned for or not. Its packs must stay readable until the
 *         slot is emptied. NULL: empty the slot. No actor may be of its kind; make hair, walkers, patches of decals and
 *         other objects that were made for it, or drawn on it, again before you use them
 * errors  ARG no such slot, it holds a kind, actors of the kind are there (need: how many), a field of desc, or called
 *         during a step or a frame; MEMORY the kind is larger than the slot (need: what it takes of noh_kind_room,
 *         where: what the slot has), or the driver is out of memory; UNSUPPORTED with `gpu`, it needs a program that no
 *         kind of the plan needs, or has `finer`; it has clip_reserve, and no kind of the plan has; GL the driver
 *         refused an object; as noh_stage_init. The slot is then as it was */
noh_result noh_stage_set_kind(noh_stage *stage, uint32_t kind, const noh_kind_desc *desc, noh_error *error);

/* ---- state ---- */

/* Everything that time or the game changes: one block of plan->state_bytes without pointers. Copy it to save or fork
 * the stage, but not during a frame or a step. */
const void *noh_stage_state(const noh_stage *stage, size_t *bytes);

/* Restore a copied state, of this stage or another with the same plan, on any processor of the same byte order. The
 * frames that follow have the same bits as those after the copy, if the same levels are loaded (noh_stage_load_level);
 * loaded levels are not part of the state. Without them actors show the finest level there is. A stage's own state is
 * always valid: places that time or noh_stage_shift_origin moves stop at NOH_NUMBER_MAX.
 * errors  ARG called during a frame or a step; NOT_FOUND it plays clips that are absent here, which are then in
 *         noh_stage_stats.wanted (where: the first kind, need: how many clips); MEMORY they and what plays here do not
 *         fit clip_reserve (where: the kind, need: bytes); DATA the state is of another plan, or a count or
 *         index in it is out of range (where: the actor). Nothing has then changed */
noh_result noh_stage_set_state(noh_stage *stage, const void *state, size_t bytes, noh_error *error);

/* A hash of the state, equal on every processor and for any number of jobs. */
uint64_t noh_stage_hash(const noh_stage *stage);

/* ======== cameras ========
 * Cameras and lights for a stage.
 *
 *   noh_view_orbit    a camera that looks at a point from a distance
 *   noh_view_shadow   a light that sees a sphere
 *   noh_view_ray      the ray under a pixel
 *
 * Threads: pure functions of their arguments; any thread. */

/* A perspective camera, y up, 40 degrees from top to bottom, that sees from a hundredth to a hundred times the
 * distance. The light comes from its left, above.
 * units   yaw_rad 0: the camera is on the side of +z; pitch_rad above 0: it looks down
 * ranges  distance above 0; width, height in pixels, at least 1 */
void noh_view_orbit(noh_stage_view *view, const float target[3], float yaw_rad, float pitch_rad, float distance,
                    uint32_t width, uint32_t height);

/* A parallel view along a light, for a shadow map: all of a sphere, and what stands between it and the light by one
 * diameter.
 * shapes  sphere: centre x, y, z, radius; light: unit vector towards the light */
void noh_view_shadow(noh_stage_view *view, const float sphere[4], const float light[3]);

/* The ray through the middle of a pixel, from the near plane on; x to the right, y down, from 0.
 * shapes  origin, direction: world; the direction's length is 1
 * returns 0 where the view's matrix cannot be inverted */
int noh_view_ray(const noh_stage_view *view, float x, float y, uint32_t width, uint32_t height, float origin[3],
                 float direction[3]);

#ifdef __cplusplus
}
#endif

#endif
