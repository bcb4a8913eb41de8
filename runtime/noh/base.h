/* base.h: results, limits, versions.
 *
 * NOH_ASSERT_LEVEL, when the library is compiled, turns on checks for a caller's bugs: 0 (default) none, 1 the cheap
 * ones (a NULL pointer, an index past its count), 2 also those that walk a structure. A failed check calls
 * NOH_ASSERT_FAILED(condition, file, line), which a build may define; the default traps. */

#ifndef NOH_BASE_H
#define NOH_BASE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ======== results and errors ========
 * How the library reports errors.
 *
 * Bad data, too little memory, missing capabilities and driver errors are reported as a noh_result; outputs are then
 * untouched. A caller's bug (a NULL that is not allowed, an index past a count) fails an assertion.
 * Threads: no state; any thread. */

/* A check at compile time that works in C99. */
#define NOH_STATIC_ASSERT(condition, name) typedef char noh_static_assert_##name[(condition) ? 1 : -1]

typedef enum noh_result {
    NOH_OK = 0,
    NOH_ERR_ARG,         /* an argument or a field of a desc is out of range: `what` names it */
    NOH_ERR_MEMORY,      /* memory is too small: `need` is the bytes needed */
    NOH_ERR_DATA,        /* a pack, clip or table is damaged: `where` is the byte offset, or the index at fault */
    NOH_ERR_VERSION,     /* the pack has another format version: `need` is the version of this library */
    NOH_ERR_LIMIT,       /* more than the format or this GPU can hold: `need` is the number requested */
    NOH_ERR_NOT_FOUND,   /* no object has this name or index: `where` is the index, `need` the count */
    NOH_ERR_UNSUPPORTED, /* the GPU or driver lacks a capability: `what` names it */
    NOH_ERR_GL           /* the driver refused a call: `where` is the GL error */
} noh_result;

/* An error, without formatting: the library has no stdio. Only a failing call writes it.
 * what   a sentence: a string constant, or text in the caller's memory (a shader's log); never NULL after a failure
 * where  the byte or index at fault, or 0
 * need   the size or count required, or 0 */
typedef struct noh_error {
    noh_result result;
    const char *what;
    uint64_t where;
    uint64_t need;
} noh_error;

/* The result in words: "too little memory". Never NULL. */
const char *noh_result_text(noh_result result);

/* Fill `error` (which may be NULL) and return its result. */
noh_result noh_fail(noh_error *error, noh_result result, const char *what, uint64_t where, uint64_t need);

/* ======== 16-bit floats ======== */

typedef enum noh_half_mode {
    NOH_HALF_UNKNOWN = 0, /* none of the others: results can only be compared within a bound */
    NOH_HALF_RTZ,         /* round toward zero */
    NOH_HALF_RNE,         /* round to nearest, ties to even */
    NOH_HALF_RTZ_RNE      /* for sums: the addend is rounded toward zero, then the sum to nearest (NVIDIA) */
} noh_half_mode;

/* ======== limits ========
 * All limits. Building a pack over a limit fails with the limit in the message; opening one fails too. A desc
 * over a limit is NOH_ERR_ARG or NOH_ERR_LIMIT, with the number requested.
 *
 * Limits set by the width of a field are with the field: limits of time (NOH_DURATION_MAX, NOH_SPEED_MAX,
 * NOH_POSITION_MAX) in clip.h, limits of a compressed clip (NOH_CLIP_*_MAX) in low_motion.h.
 * Threads: constants. */

#define NOH_NONE 0xffffffffu /* no index; above every count */

/* No call of the library uses more stack than this. */
#define NOH_STACK_BYTES 8192u

/* ---- a pack ---- */

/* Chunks start at multiples of this in the file. In memory a pack is aligned to NOH_MEMORY_ALIGN. */
#define NOH_PACK_ALIGN 64u
#define NOH_PACK_CHUNKS_MAX 4096u
#define NOH_PACK_BYTES_MAX 0x7fffffffu
/* The largest absolute value of a number in a mesh, skeleton, skin, node, material or place, so that sums and products
 * stay finite. It also bounds scales and positions accumulated along chains of joints and nodes. */
#define NOH_NUMBER_MAX 1e12f
#define NOH_NAME_BYTES_MAX 256u /* with the final zero */
#define NOH_NODES_MAX 65535u
#define NOH_MATERIALS_MAX 4096u
#define NOH_TEXTURE_SIZE_MAX 2048u /* wider or taller images are shrunk by the converter */

/* ---- a mesh ---- */

#define NOH_VERTICES_MAX (1u << 22) /* a 2048 x 2048 texture, which ES 3.0 guarantees */
#define NOH_EXTRAS_MAX 5u           /* extra attributes of a mesh's vertices */
#define NOH_INDICES_MAX (1u << 26)
#define NOH_SUBMESHES_MAX 256u
#define NOH_PIXELS_MAX 1e6f             /* of an allowed error on screen */
#define NOH_LOD_LEVELS_MAX 8u           /* of a mesh or skeleton, and rows of an LOD table */
#define NOH_TARGETS_MAX 1024u           /* the gather list has 10 bits for a target */
#define NOH_DELTA_TEXELS_MAX (1u << 22) /* the gather list has 22 bits for a delta texel */
#define NOH_MORPH_WIDTH_LOG2_MIN 2u     /* of the texture of accumulation texels */
#define NOH_MORPH_WIDTH_LOG2_MAX 11u    /* ES 3.0 guarantees textures of 2048 */
#define NOH_MORPH_HEIGHT_MAX 2048u
#define NOH_MORPH_INSTANCES_MAX 65536u

/* ---- skeletons and skins ---- */

#define NOH_JOINTS_MAX 4096u      /* of a skeleton */
#define NOH_SKIN_JOINTS_MAX 4096u /* of a skin */
/* a uniform block of 12 KiB; ES 3.0 guarantees 16 KiB. A vertex has 8 bits for an index into its palette */
#define NOH_PALETTE_JOINTS_MAX 256u
#define NOH_INFLUENCES_MAX 8u  /* joints per vertex on the GPU and in the SIMD kernels */
#define NOH_FAR_JOINTS_MAX 32u /* virtual joints of a mesh */
#define NOH_SKIN_LIST_MAX 32u  /* joints per vertex of a list (deform.h), on the CPU */

/* ---- clips, their sets and banks ---- */

#define NOH_CLIP_EVENTS_MAX 65536u /* callback keys of one clip in a pack */
#define NOH_CLIP_MARKERS_MAX 4096u /* sync markers of one clip in a pack */
#define NOH_CLIPS_MAX 65535u       /* clips of one set */
#define NOH_FLOATS_MAX 4096u       /* of one set: morph weights of all nodes and named floats */
#define NOH_MASKS_MAX 255u         /* of one set */
#define NOH_MATCH_ROWS_MAX 65536u  /* moments of clips in a table for motion matching */
#define NOH_MATCH_TAGS_MAX 32u     /* of such a table */
#define NOH_CLIP_CACHE_CLIPS_MAX 4096u
#define NOH_CLIP_CACHE_SEGMENTS_MIN 2u /* cached segments; a sample between two segments needs both */
#define NOH_CLIP_CACHE_SEGMENTS_MAX 32768u

/* ---- faces ---- */

#define NOH_SPEECH_PHONES_MAX 65536u
#define NOH_FACE_ROWS_MAX 1024u       /* of a pack's recipe */
#define NOH_CORRECTIVE_DRIVERS_MAX 8u /* targets that drive one corrective */
#define NOH_FACE_EMOTIONS_MAX 3u      /* emotions at once on a face; another replaces the weakest */

/* ---- bodies ---- */

#define NOH_TERRAIN_SIZE_MAX 4097u   /* heights along a side of a pack's terrain */
#define NOH_OBSTACLES_MAX 16u        /* of each kind in a world */
#define NOH_TOUCHES_MAX 8u           /* of a body that asks: 3 at each end, 2 between them */
#define NOH_TRIANGLES_MAX (1u << 22) /* of one world */
#define NOH_FEET_LEGS_MAX 2u         /* placed on the ground */
#define NOH_GAZE_JOINTS_MAX 8u       /* joints of spine, neck and head that turn together */
#define NOH_REACH_ARMS_MAX 2u        /* arms that reach */
#define NOH_RAGDOLL_BODIES_MAX 16u   /* of one ragdoll */
#define NOH_RAGDOLL_PAIRS_MAX 24u    /* pairs of colliding bodies of a ragdoll */
#define NOH_RAGDOLL_SUBSTEPS_MAX 20u
#define NOH_RAGDOLL_STEPS_MAX 4u     /* of 1/60 s per call; the rest of a longer time is dropped, and counted */
#define NOH_RAGDOLLS_MAX 1024u       /* of one set */
#define NOH_IK_JOINTS_MAX 32u        /* of one chain */
#define NOH_SPRING_JOINTS_MAX 256u   /* of one spring */
#define NOH_SPRING_COLLIDERS_MAX 32u /* of one spring */
#define NOH_SPRING_STEPS_MAX 60u     /* of 1/60 s per call; of a longer time only the last second is simulated */
#define NOH_HAIRS_MAX 256u           /* control hairs of one head */
#define NOH_HAIR_POINTS_MAX 32u      /* of a control hair */
#define NOH_HAIR_SPHERES_MAX 8u      /* collision spheres of a head */
#define NOH_HAIR_PATCHES_MAX 256u    /* patches of four control hairs, of one haircut */
#define NOH_HAIR_STRIPS_MAX 16384u   /* of one haircut */
#define NOH_HAIR_SEGMENTS_MAX 64u    /* of a strip */
#define NOH_HAIR_NEAR_MAX 64u        /* heads of a kind whose hair moves at once (modules.h) */
#define NOH_HAIR_STEPS_MAX 60u       /* of 1/60 s in one call; what is left of a longer time is dropped */

/* ---- crowds ---- */

#define NOH_CROWD_AGENTS_MAX (1u << 18)
#define NOH_CROWD_OBSTACLES_MAX 1024u
#define NOH_CROWD_JOBS_MAX 64u
#define NOH_CROWD_FIELDS_MAX 255u            /* flow fields of one crowd */
#define NOH_CROWD_FIELD_CELLS_MAX (1u << 20) /* of one flow field */
#define NOH_CROWD_STEPS_MAX 4u               /* of 1/30 s per call; the rest of a longer time is dropped */
#define NOH_SMART_NEEDS_MAX 8u
#define NOH_SMART_OBJECTS_MAX 1024u
#define NOH_SMART_SLOTS_MAX 8192u

/* ---- controllers and graphs ---- */

#define NOH_TRACKS_MAX 64u
#define NOH_CHANGES_MAX 1024u /* waiting or running at one time */
#define NOH_WEIGHT_MAX 1e6f   /* of a track */
/* Most callback keys that one step examines. A track can pass billions (a seek a day ahead in a clip of 10 ms); a step
 * that reaches this limit delivers no more and only advances time. */
#define NOH_STEP_EVENTS_MAX (1u << 20)
#define NOH_SYNC_GROUPS_MAX 15u
#define NOH_SYNC_DURATION_MIN 480u       /* ticks of a clip in a sync group: 10 ms */
#define NOH_SYNC_DURATION_MAX (1u << 28) /* ticks: 93 minutes */
#define NOH_GRAPH_NODES_MAX 256u
#define NOH_GRAPH_CHILDREN_MAX 32u /* of one node */
#define NOH_GRAPH_PARAMS_MAX 256u
#define NOH_GRAPH_BUFFERS_MAX 32u       /* pose buffers */
#define NOH_GRAPH_TRANSITIONS_MAX 1024u /* of one graph in a pack */
#define NOH_GRAPH_NAMES_MAX 4096u       /* values of parameters and joints of masks, of one graph in a pack */
#define NOH_BLEND_SPACE_POINTS_MAX 32u  /* of a blend space */
#define NOH_BLEND_SPACE_TRIANGLES_MAX (2u * NOH_BLEND_SPACE_POINTS_MAX)
#define NOH_BLEND_SPACE_COORDINATE_MAX 1e18f /* of points and thresholds, so that squares of differences stay finite */

/* ---- characters ---- */

#define NOH_LOD_POOLS_MAX NOH_LOD_LEVELS_MAX
#define NOH_LOD_POOL_SLOTS_MAX 65536u
#define NOH_SCHEDULE_MAX 65536u /* characters of one scheduler */
#define NOH_VISIBILITY_MAX 8.0f

/* ---- stages ---- */

#define NOH_STAGE_KINDS_MAX 16u
#define NOH_STAGE_ACTORS_MAX 65535u /* of all kinds */
#define NOH_STAGE_MESHES_MAX 32u    /* drawn meshes of a kind */
#define NOH_STAGE_JOBS_MAX 64u
#define NOH_TEXTURE_SETS_MAX 64u /* of a kind, besides its own */
#define NOH_STAGE_VIEWS_MAX 8u
#define NOH_VIEW_NUMBER_MAX 1e18f         /* of a view, so that squares stay finite */
#define NOH_ATTACH_DEPTH_MAX 8u           /* length of a chain of attachments */
#define NOH_LAYERS_MAX 16u                /* of a kind */
#define NOH_MODIFIERS_MAX 16u             /* of a kind */
#define NOH_MODIFIER_BYTES_MAX (1u << 20) /* state of one actor, or scratch of one job */
#define NOH_STAGE_GRAPHS_MAX 16u          /* of a kind */
#define NOH_LAYER_TRACKS_MAX 8u           /* of a layer */
#define NOH_CONCESSIONS_MAX 32u           /* of a plan */
#define NOH_WANTED_CLIPS_MAX 16u          /* listed at one time (noh_stage_stats) */
#define NOH_CLIP_RESERVE_MAX (1u << 30)   /* bytes of a kind */
#define NOH_BLOBS_MAX 24u                 /* blob shadows of an actor */
#define NOH_DECALS_MAX 64u                /* of a ring */
#define NOH_DECAL_TRIANGLES 96u           /* default room for each grown mark, as a mean */

/* ---- light ---- */

#define NOH_SH_ORDER_MAX 6u /* of spherical harmonics */
#define NOH_SH_COUNT_MAX 36u
#define NOH_LAMPS_MAX 8u /* of an environment */
#define NOH_WINDOWS_MAX 2u
#define NOH_REFLECTION_SIDE_MAX 128u /* texels */

/* ---- GL ---- */

/* of a renderer: a type of mesh needs 2 to 8 for each type of material on it; twice as many with fades or depth */
#define NOH_GL_VARIANTS_MAX 192u
#define NOH_MORPH_STREAMS_MAX 4u    /* targets per draw on the path streams */
#define NOH_GL_FETCHES_MAX 8u       /* texture fetches per pixel, for any material */
#define NOH_MATERIAL_MAPS_MAX 5u    /* of these, maps besides the base colour, the environment and the shadow */
#define NOH_GL_OWN_INPUTS_MAX 8u    /* a game's own attributes for its shaders */
#define NOH_GL_OWN_SAMPLERS_MAX 13u /* of a game's own shaders: ES 3.0 guarantees 16, and the library uses 3 */
#define NOH_GL_LABEL_BYTES 96u      /* of an object's name; longer ones are cut. GL accepts at least 256 */
#define NOH_GL_PIECES_MAX 56u       /* of a shader's text; noh-embed writes no more */

/* ======== versions ========
 * The version of noh. Semantic versioning; below 1.0.0 a new minor version may change the interface. The
 * pack format has its own version, NOH_PACK_VERSION (format.h).
 *
 * Threads: no state; any thread. */

#define NOH_VERSION_MAJOR 0
#define NOH_VERSION_MINOR 3
#define NOH_VERSION_PATCH 0
#define NOH_VERSION "0.3.0"

/* A version as one number that grows with the version; packs store it. 8 bits major, 12 minor, 12 patch. */
#define NOH_VERSION_NUMBER(major, minor, patch) ((uint32_t)(major) << 24 | (uint32_t)(minor) << 12 | (uint32_t)(patch))

/* The version of the linked library, "0.3.0", to be compared with NOH_VERSION of the headers. */
const char *noh_version(void);

/* The version of the linked library, as NOH_VERSION_NUMBER. */
uint32_t noh_version_number(void);

#ifdef __cplusplus
}
#endif

#endif
