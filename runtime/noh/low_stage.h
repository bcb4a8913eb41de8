/* low_stage.h: a character and its level of detail without a stage: for engines built of parts (noh_low.h). */

#ifndef NOH_LOW_STAGE_H
#define NOH_LOW_STAGE_H

#include <stdint.h>

#include "base.h"
#include "pack.h"
#include "clip.h"
#include "noh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== level of detail ========
 * LOD levels chosen by one setting, the largest error in pixels.
 *
 * Every simplification has an error in metres: the largest movement of a drawn point. The depth gives the size of a
 * metre in pixels. The quality setting, `pixels`, is divided into shares, one for each kind of LOD, and each kind takes
 * its coarsest level with an error within its share. Errors of different kinds at most add up (the triangle inequality)
 * and the shares sum to at most 1, so the total stays below the setting. Kinds are chosen independently, so no choice
 * makes another flicker. (D. Luebke et al., "Level of Detail for 3D Graphics", Morgan Kaufmann 2003, chapter 4,
 * describes selection by screen-space error, with hysteresis.)
 *
 * Hysteresis keeps choices stable: a coarser level is taken only when its error is below (1 - hysteresis) of the share,
 * a finer one when the current error is above the share. Mesh levels fade (noh_lod_fade), which takes time, so the
 * change to a finer one starts early, above (1 - lead) of the share; the error then stays within the share as long as
 * the scale grows by less than 1 / (1 - lead) during a fade. The other kinds switch at once: the jump is smaller than
 * their share.
 *
 * Mesh levels are numbered as in the pack and in the GL calls: 0 is the full mesh, whether it is loaded or not.
 *
 * Threads: a noh_lod belongs to one thread at a time; tables and settings are read-only and shared. */

/* Update rate: how often an instance is posed. */
typedef enum noh_update_rate {
    NOH_UPDATE_RATE_FULL = 0, /* every frame */
    NOH_UPDATE_RATE_30,       /* Hz */
    NOH_UPDATE_RATE_15,
    NOH_UPDATE_RATE_8,
    NOH_UPDATE_RATE_COUNT
} noh_update_rate;

/* A mesh level. Levels are ordered from finest to coarsest, and errors must not decrease. Plain data, as in a pack. */
typedef struct noh_lod_mesh {
    uint32_t vertex_count; /* the level draws a prefix of the mesh's vertices */
    uint32_t triangle_count;
    uint32_t influence_count; /* most joints per vertex of this level; 0: not skinned */
    float error_m;            /* largest distance of its surface from the full mesh's in any measured pose */
} noh_lod_mesh;

typedef struct noh_lod_joints {
    uint32_t joint_count; /* joints posed, a prefix with all roots; the others move with their parents */
    float error_m;        /* largest error of a vertex in any pose */
} noh_lod_joints;

typedef struct noh_lod_influences {
    uint32_t influence_count; /* influences used per vertex, the heaviest */
    float error_m;
} noh_lod_influences;

/* The levels of a character and their errors. Borrowed; shared by all its instances. */
typedef struct noh_lod_table {
    const noh_lod_mesh *meshes;
    const noh_lod_joints *joints;
    const noh_lod_influences *influences;
    uint32_t mesh_level_count; /* these counts are 1..NOH_LOD_LEVELS_MAX, or 0: no levels of the kind */
    /* the finest loaded mesh level: below mesh_level_count, or 0. Finer levels are not chosen */
    uint32_t mesh_level_first;
    uint32_t joint_level_count;
    uint32_t influence_level_count;
    float clip_error_m;          /* of clip compression: always present, part of the share of updates */
    const float *update_error_m; /* [clip_count][NOH_UPDATE_RATE_COUNT] by noh_time_lod_measure or
                                    noh_time_lod_points_measure; NULL: always full rate */
} noh_lod_table;

/* LOD state of one instance. Start with zeros. */
typedef struct noh_lod {
    int64_t fade_start;     /* tick */
    uint32_t fade_ticks;    /* 0: no fade is running */
    float pixels_per_metre; /* the scale of the last choice */
    float error_m;   /* current error: the sum for the mesh level (in a fade the coarser one), the joint level, the
                      * influence level and the update rate */
    float skipped_m; /* current error of dropped morph targets */
    uint8_t mesh, mesh_before;  /* levels; mesh_before is the level that a fade leaves, otherwise equal to mesh */
    uint8_t joints, influences; /* levels */
    uint8_t update_rate;        /* noh_update_rate */
    uint8_t started;            /* 0: the next choice ignores the current levels and does not fade */
    /* the level within the quality setting; finer than `mesh` only with a limit */
    uint8_t mesh_wanted;
    uint8_t mesh_limit; /* the finest level taken; 0: no limit */
} noh_lod;

/* Pixels per metre at a distance.
 * units   distance_m to the nearest point of the character; field_of_view_rad the full vertical angle
 * ranges  distances below a millimetre count as a millimetre; 0 < angle < pi
 * Exact in the middle of the view. A perspective view stretches towards its edges: with the nearest point's depth
 * instead of its distance the scale is exact there too, across the line of sight */
float noh_lod_scale(float distance_m, float field_of_view_rad, uint32_t viewport_height);

/* Choose the levels of a frame. Call before noh_lod_targets.
 * shapes  update_error_m[NOH_UPDATE_RATE_COUNT] of everything that plays; NULL: full update rate
 * units   clock in ticks, never decreasing
 * ranges  pixels_per_metre >= 0, not NaN */
void noh_lod_choose(noh_lod *d, const noh_lod_table *table, const noh_lod_settings *settings, float pixels_per_metre,
                    const float *update_error_m, int64_t clock);

/* Call when the camera has jumped or the character was out of view: the next choice ignores the current levels and does
 * not fade. */
void noh_lod_cut(noh_lod *d);

/* Progress of a change of mesh level: 0 only mesh_before, 1 only mesh, smooth at both ends (smoothstep). For a dither
 * of two draws, or a geomorph along the collapsed edges. The next change waits until it is 1. */
float noh_lod_fade(const noh_lod *d, int64_t clock);

/* Drop morph targets with effects too small to see: the smallest |weight| * radius first, while the sum is within the
 * share of targets. Sets d->skipped_m to the sum. Takes two passes over the weights if all can be dropped, at most 33.
 * shapes   weights[count]; radius_m[count]: the largest displacement by each target at weight 1; kept[count]: the
 *          weights, 0 if dropped; may be `weights`
 * returns  the number of nonzero weights kept; NaN is kept */
uint32_t noh_lod_targets(noh_lod *d, const noh_lod_settings *settings, const float *weights, const float *radius_m,
                         uint32_t count, float *kept);

/* ======== update rates ========
 * Pose instances less often than every frame.
 *
 * An instance has two poses, source and target, and shows a blend of them. These are not the last two poses: blending
 * those would lag (125 ms at 8 Hz: feet slide and steps are heard before they are seen), and extrapolating has up to 8
 * times the error of interpolation and jumps at every update. Instead, a copy of the controller is played ahead without
 * firing callbacks. An update at tick t poses the instance as of its next update, and until then the frame blends from
 * the true pose at t to the true pose there: no lag, no jumps, and an error that grows with the square of the update
 * period, measured for each clip by noh_time_lod_measure. A change made in between shows from the next update on, or
 * from the next frame after noh_character_wake, and never as a jump.
 *
 * Poses are blended as matrices in object space, so every skinned vertex moves in a straight line from one true
 * position to the next. Blending local transforms would follow arcs, but needs new matrices every frame, which costs
 * more than sampling.
 *
 * Frames may lag behind the clock (behind_ticks): a game that steps at a fixed rate and draws at another shows frames
 * between its last two steps. An update then poses the instance as of the last step, or later, and frames blend from
 * the previous pose to it: an instance at the full rate is posed once per step and blended every frame.
 *
 * Callback keys are not affected: controllers are stepped every frame, visible or not.
 *
 * Updates are staggered: instance n is updated at the fraction n * golden ratio (modulo 1) of the period, which spreads
 * any range of consecutive numbers evenly (H. Weyl, "Ueber die Gleichverteilung von Zahlen mod. Eins", 1916).
 *
 * Threads: a noh_time_lod belongs to one thread at a time; measuring may run on any thread that may sample the set. */

#define NOH_TIME_LOD_UNSEEN_TICKS 6000u /* after longer out of view an instance is posed before it is shown */

/* State, without pointers. All clocks are the game's, in ticks. */
typedef struct noh_time_lod {
    int64_t from_clock, to_clock; /* the blend runs from source to target between these; equal: only the target */
    int64_t due_clock;            /* when the next update is due */
    int64_t clock;                /* of the last frame shown: the game's minus behind_ticks */
    uint32_t frame_ticks;         /* from the frame before it to the last one */
    uint32_t instance;
    uint8_t chosen_rate;   /* noh_update_rate of the last frame, for the next update */
    uint8_t shown_rate;    /* noh_update_rate of the current blend */
    uint8_t to_pose;       /* which pose is the target, 0 or 1; the other is the source */
    uint8_t posed;         /* 0: no valid pose yet */
    uint32_t behind_ticks; /* lag of frames behind the game's clock; set it before a frame. At most the last step */
} noh_time_lod;

typedef enum noh_due {
    NOH_DUE_NOT = 0, /* the blend is still valid */
    NOH_DUE,         /* an update is due; until then the target pose is held */
    NOH_DUE_AT_ONCE  /* no valid pose: never posed, or out of view for NOH_TIME_LOD_UNSEEN_TICKS */
} noh_due;

/* ---- errors ---- */

/* The set, skeleton and radii to measure clips with. All borrowed. */
typedef struct noh_time_probe {
    const noh_clip_set *set;
    const noh_skeleton *skeleton; /* of the set */
    /* [joint_count] the joint radii (deform.h); below 0: the joint moves no vertex */
    const float *joint_radius_m;
    const float *float_radius_m; /* [float_count] largest movement of a vertex by each float at weight 1; NULL: floats
                                  * are ignored */
    /* 1: each repetition of a clip continues from the end of joint 0's translation, as with root motion, for a set that
     * will extract it later; 0: joint 0 jumps back */
    int travels;
} noh_time_probe;

/* Bytes of working memory for measuring; 0 for a set over NOH_JOINTS_MAX or NOH_FLOATS_MAX. */
size_t noh_time_lod_measure_size(const noh_time_probe *probe);

/* Measure the largest error of a clip, played in its own loop mode, at each update rate: over periods that begin every
 * 400 ticks, every 200 ticks within each, for any point within a joint's radius, in object space (without root motion
 * if the set extracts it). For converters and load time: ten seconds of 31 joints take about 0.1 s.
 *
 * The result is the largest error found, not a proof for all ticks. At each measured tick it is a bound: the difference
 * of two matrices moves a point by at most its norm times the point's distance, and the norm is overestimated by up to
 * 15 % (the Schatten 8-norm).
 * shapes  error_m[NOH_UPDATE_RATE_COUNT]; 0 at the full rate
 * units   model units, taken as metres
 * errors  ARG probe, clip, or memory is NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY too small (need: the exact
 *         bytes) */
noh_result noh_time_lod_measure(void *memory, size_t bytes, const noh_time_probe *probe, uint32_t clip, float *error_m,
                                noh_error *error);

/* ======== a character ========
 * One character: its controller, its LOD levels, and the two poses that it blends.
 *
 * A character is one block of bytes without pointers: clone, save or move it with one memcpy of its `bytes`. Hundreds
 * fit in one array. Shared data (the set, the LOD table, the scratch) is passed to
 * every call.
 *
 * A frame of a game:
 *   noh_character_step(ch, set, ticks, fn, user)              every character: clock and callback keys
 *   due = noh_character_select_lod(ch, table, settings, scale)      characters in view: chooses LOD levels
 *   noh_character_update(ch, set, skeleton, radii, &scratch)  characters that are due: samples, blends, makes matrices
 *   noh_character_skin(ch, skin, matrices)                    drawn characters: skinning matrices
 * A scheduler can spread updates within a time budget. Change tracks through noh_character_controller,
 * then call noh_character_wake. After a memcpy, give the copy its own update phase with noh_character_set_instance.
 *
 * Bytes: 160 for the head, plus the controller (clip.h), plus two poses of 48 per joint and 4 per float, each
 * rounded up to 16. 31 joints, 34 floats and 4 tracks: 3,888; with inertia 5,648.
 *
 * Each instance has its own controller and poses, so updates and draws may be batched in any order. (C. Granberg,
 * "Character Animation with Direct3D", Charles River Media 2009, chapter 4, also clones controllers, but its clones
 * write one shared tree of joints, so each must be drawn before the next is updated.)
 *
 * Threads: characters and scratches belong to one thread at a time; set, skeleton, table and settings are read-only and
 * shared. Several threads may step different characters and choose their levels at once; for updates each thread needs
 * its own view of the set (clip.h). */

typedef struct noh_character_desc {
    noh_controller_desc controller; /* set is required */
    uint32_t instance;              /* update phase: give each character its own number; default 0 */
    int64_t start_clock;            /* tick of the game's clock at its start; default 0 */
} noh_character_desc;

/* The head of the block; the rest follows at byte offsets from it. Read its fields, but change them only by calls. */
typedef struct noh_character {
    int64_t start_clock;
    uint32_t bytes; /* of the whole block */
    uint32_t joint_count, float_count;
    uint32_t controller_offset;
    uint32_t palette_offsets[2]; /* the floats of a pose follow its palette */
    float stretches[2];          /* how far the two poses stretch their joints */
    uint32_t updates;            /* since init */
    uint32_t multiplied;         /* a bit for each palette: 1 if multiplied by inverse bind matrices */
    noh_lod lod;
    noh_time_lod time;
    float spheres[2][4]; /* centre and radius around the two poses */
} noh_character;

/* Working memory of updates: one per thread and set. */
typedef struct noh_character_scratch {
    noh_pose_scratch pose;
    noh_controller *ahead; /* a copy of the controller, played to the next update */
    size_t ahead_bytes;
    noh_transform *local; /* [joint_count] the pose of an update */
    float *floats;        /* [float_count] its floats */
    uint32_t joint_count; /* joints that were sampled; the others have the bind pose */
    uint32_t pose_index;  /* 0 or 1: which of the character's two poses this update writes */
    float *model;         /* [joint_count][12] model-space matrices, after _end */
} noh_character_scratch;

/* ---- memory ---- */

/* Exact bytes of a character; 0 for an invalid desc. */
size_t noh_character_size(const noh_character_desc *desc);

/* Build a character in memory[bytes], with all tracks off and no valid pose.
 * errors  ARG a field of the desc, or memory is NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY too small (need: the
 *         exact bytes) */
noh_result noh_character_init(void *memory, size_t bytes, const noh_character_desc *desc, noh_character **character,
                              noh_error *error);

/* Working memory for characters of this desc, or of a desc with fewer tracks and changes.
 * errors  as noh_character_init */
size_t noh_character_scratch_size(const noh_character_desc *desc);
noh_result noh_character_scratch_init(void *memory, size_t bytes, const noh_character_desc *desc,
                                      noh_character_scratch *scratch, noh_error *error);

noh_controller *noh_character_controller(noh_character *ch);

/* ---- a frame ---- */

/* Advance time and deliver callback keys, as noh_controller_step. LOD levels do not affect it. */
uint32_t noh_character_step(noh_character *ch, const noh_clip_set *set, uint32_t ticks, noh_event_fn fn, void *user);

/* Choose the LOD levels of a character in view, and return whether an update is due. Call at most once a frame. The
 * controller then plays for the chosen mesh level and samples the joints of the chosen joint level.
 * units   pixels_per_metre at its nearest point (noh_lod_scale) */
noh_due noh_character_select_lod(noh_character *ch, const noh_lod_table *table, const noh_lod_settings *settings,
                                 float pixels_per_metre);

/* Pose a character for this frame or for the next update; calls _begin and _end. Not within a callback of
 * noh_character_step. */
void noh_character_update(noh_character *ch, const noh_clip_set *set, const noh_skeleton *skeleton,
                          const float *joint_radius_m, noh_character_scratch *scratch);

/* The first joint_count matrices shown in this frame, after an update, in the skeleton's order: as from
 * noh_model_to_palette for the skeleton passed to update_end. They are the joints' model-space matrices unless this
 * skeleton has inverse bind matrices; to draw a mesh, call noh_character_skin, which handles both cases.
 * shapes   mixed[joint_count][12]
 * returns  `mixed`, or the character's own matrices if no blend was needed; valid until the next update */
const float *noh_character_palette(const noh_character *ch, float *mixed, uint32_t joint_count);

/* The floats shown in this frame, returned as noh_character_palette does.
 * shapes  mixed[float_count of the set] */
const float *noh_character_floats(const noh_character *ch, float *mixed);

/* Call after changing tracks or weights. An update is then due, and the character moves to the changed pose within half
 * to one update period. */
void noh_character_wake(noh_character *ch);

/* Give a copy its own update phase. */
void noh_character_set_instance(noh_character *ch, uint32_t instance);

/* ======== levels of a pack ========
 * LOD tables from packs.
 *
 * The converter measures the errors of each mesh level, of fewer influences, and of each clip with fewer joints and at
 * lower update rates. These functions convert them to metres and combine them for the clips of a set. The error of a
 * mesh level is its largest (at rest, with targets, in clips) plus the movement by targets that the level drops. Joint
 * levels come from the set's skeleton, each with the largest error of all clips.
 *
 * Threads: as low_stage.h; filling a table reads the set and its packs and writes only to the memory given. */

typedef struct noh_lod_pack_desc {
    const noh_clip_bank *set;           /* required */
    const noh_clip_bank_desc *set_desc; /* the desc of the set; required */
    /* the drawn mesh, at the finest loaded level: a mesh of set_desc->mesh that the set's skeleton moves, or a rigid
     * one; default (NULL) unknown: no mesh levels, no radii */
    const noh_mesh *mesh;
    const float *weights; /* [target_count of the mesh] as in noh_mesh_add_joint_radii; default (NULL) 1 each */
} noh_lod_pack_desc;

/* An LOD table and radii. The arrays are in the memory passed to init; the packs are no longer needed. */
typedef struct noh_lod_pack {
    noh_lod_table table; /* clip_error_m is the clips' compression bound, at their shell distance */
    /* [joint_count of the skeleton] joint radii of the mesh, for noh_character_update; NULL without a skinned mesh. Add
     * other drawn meshes with noh_mesh_add_joint_radii */
    float *joint_radius_m;
    /* [target_count of the mesh] radius of each target at weight 1, for noh_lod_targets; NULL without a mesh */
    float *radius_m;
} noh_lod_pack;

/* Exact bytes; 0 for an invalid desc. Only clips.clip_count and skeleton.joint_count of the set are read, so before a
 * set exists, pass a zeroed one with these two counts from noh_clip_bank_needs.shape. */
size_t noh_lod_pack_size(const noh_lod_pack_desc *desc);

/* Fill a table.
 *
 * A clip built without a mesh has errors of points at a shell distance from the joints. For a mesh with larger radii
 * they are scaled up in proportion: safe, but several times too high. Build clips together with their mesh (noh build
 * BODY MOVES, also with --only anim), or measure them at load time.
 *
 * A clip built with its mesh has exact errors of a few hundred vertices at each update rate; vertices between them may
 * have slightly larger errors (noh_time_lod_points_measure). These errors assume that the set extracts root motion: the
 * jump at the end of a travelling loop is not counted. A clip built for a skeleton of other proportions may have other
 * joint levels: a joint level without an error for every clip is omitted, with all coarser ones.
 * errors  ARG a field of desc, or memory is NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY too small (need: the exact
 *         bytes) */
noh_result noh_lod_pack_init(void *memory, size_t bytes, const noh_lod_pack_desc *desc, noh_lod_pack *lod,
                             noh_error *error);

/* ======== palettes ========
 * Skinning matrices from poses, for any skin of any pack.
 *
 *   noh_character_skin   matrices of a character in this frame
 *   noh_pose_skin        matrices of a pose, without a character
 *   noh_skin_skeleton    optional: applies the inverse bind matrices once per update instead of once per frame
 *
 * Matrices are in skin order: matrix k belongs to skin->joints[k], as for noh_gl_skin_set_matrices, noh_skin_vertices
 * and noh_skin_box. A skin may contain a joint several times with different inverse bind matrices (rigid parts that the
 * converter joined), and two skins may bind one joint differently. Inverse bind matrices therefore belong to skins, not
 * to the skeletons of packs.
 *
 * Threads: as noh_character. noh_pose_skin and noh_skin_skeleton write only to their arguments. */

/* Get the skin's matrices of a character in this frame, after an update.
 * shapes  matrices[joint_count of the skin][12]
 * ranges  skin: of the skeleton that updates the character; if the skeleton has inverse bind matrices, they must be
 *         this skin's (noh_skin_skeleton) */
void noh_character_skin(const noh_character *ch, const noh_skin *skin, float *matrices);

/* Get the skin's matrices of a local pose.
 * shapes  pose[joint_count of the skeleton]; model[joint_count of the skeleton][12]: receives the joints' model-space
 *         matrices; matrices[joint_count of the skin][12] */
void noh_pose_skin(const noh_skeleton *skeleton, const noh_skin *skin, const noh_transform *pose, float *model,
                   float *matrices);

/* Give a skeleton the inverse bind matrices of a skin, if only meshes of this skin are drawn. Updates then multiply by
 * them, and noh_character_skin only blends and gathers. If the skin contains a joint twice, this is impossible: `out`
 * then has no inverse bind matrices, which noh_character_skin also accepts.
 * shapes   inverse_bind[joint_count of the skeleton][12], borrowed by `out`; out may be skeleton
 * returns  1: `out` has inverse bind matrices; 0: it has none */
int noh_skin_skeleton(const noh_skin *skin, const noh_skeleton *skeleton, float *inverse_bind, noh_skeleton *out);

/* ======== errors of update rates ========
 * The error of lower update rates, measured on points of a mesh.
 *
 * noh_time_lod_measure bounds the error of every point within a joint's radius: safe, but on a body three to seven
 * times the error of its vertices. noh_time_lod_points_measure measures chosen vertices exactly, and no others.
 *
 * Threads: as low_stage.h. */

/* One joint's influence on a point. */
typedef struct noh_time_hold {
    uint32_t joint;
    float weight;   /* 0: unused */
    float place[3]; /* position in the joint's space: inverse bind matrix times vertex */
} noh_time_hold;

typedef struct noh_time_lod_points {
    const noh_time_hold *holds; /* [point_count][holds_per_point]; the weights of a point sum to 1 */
    uint32_t point_count, holds_per_point;
} noh_time_lod_points;

/* Bytes of working memory for measuring; 0 for a set over NOH_JOINTS_MAX or NOH_FLOATS_MAX. */
size_t noh_time_lod_points_size(const noh_time_probe *probe);

/* Measure the largest error of any point at each update rate, over the periods and ticks of noh_time_lod_measure, plus
 * the movement by the probe's floats. joint_radius_m is not read. Ten seconds of 31 joints and 128 points take about
 * 0.2 s.
 * shapes  error_m[NOH_UPDATE_RATE_COUNT]; 0 at the full rate
 * units   model units, taken as metres
 * errors  ARG probe, clip, points (none, or a joint does not exist; where: the hold), or memory is NULL or not aligned
 *         to NOH_MEMORY_ALIGN; MEMORY too small (need: the exact bytes) */
noh_result noh_time_lod_points_measure(void *memory, size_t bytes, const noh_time_probe *probe,
                                       const noh_time_lod_points *points, uint32_t clip, float *error_m,
                                       noh_error *error);

/* ======== rules of a flock ========
 * Flocking rules: away from neighbours and obstacles, along with neighbours, towards a goal. Vectors are on
 * the ground, x and z.
 *
 *   noh_flock_repel      away from a neighbour
 *   noh_flock_avoid      away from a round obstacle
 *   noh_flock_apart      half of the correction of an overlap
 *   noh_flock_join       along with neighbours, and towards their centre
 *   noh_flock_turn       turns the velocity towards the wish
 *
 * Agents of a crowd with NOH_CROWD_FORCES or NOH_CROWD_FLOCK follow these rules instead of planning ahead. The rules
 * suit few agents, and flocks; in dense crowds agents hardly advance, because repulsion outweighs the goal.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 13, with corrections (its repulsion vanishes at
 *          contact, its obstacles attract, its overlaps are resolved in place, its sums are normalised); Reynolds:
 *          Flocks, herds, and schools, 1987 (noh_flock_join)
 * Threads: no state; any thread. */

#define NOH_FLOCK_RANGE 3.0f     /* metres within which neighbours repel each other */
#define NOH_FLOCK_REPULSION 5.0f /* metres per second squared, at contact of centres */
#define NOH_FLOCK_AVOIDANCE 10.0f

/* Add the repulsion of a neighbour: -5 (1 - d / 3) along the unit vector to it, for a distance d below 3. For d = 0
 * nothing is added.
 * shapes  to[2] from here to the neighbour; force[2] in and out */
void noh_flock_repel(const float to[2], float force[2]);

/* Add the repulsion of an obstacle of radius r: 10 (1 - d / 3 r) away from its centre, for a distance d below 3 r. For
 * d = 0 nothing is added.
 * shapes  to[2] from here to its centre; force[2] in and out */
void noh_flock_avoid(const float to[2], float radius, float force[2]);

/* Add half of the movement that separates two agents nearer than `size`; the neighbour adds the other half. At the same
 * position the direction follows from their ids.
 * shapes   to[2] from here to the neighbour; move[2] in and out
 * returns  1 if they overlap */
int noh_flock_apart(const float to[2], float size, uint32_t id, uint32_t other, float move[2]);

/* Add alignment and cohesion: the mean velocity of neighbours minus the agent's own, and the vector to their centre,
 * each per second.
 * shapes  velocity[2]; to[count][2], velocities[count][2]; force[2] in and out */
void noh_flock_join(const float velocity[2], const float *to, const float *velocities, uint32_t count, float force[2]);

/* Change the velocity by at most `acceleration` * seconds towards the wish, clamped to `speed`. The agent may walk
 * slowly or stop, and results do not depend on the step length.
 * shapes  velocity[2] in and out; wish[2] metres per second */
void noh_flock_turn(float velocity[2], const float wish[2], float speed, float acceleration, float seconds);

#ifdef __cplusplus
}
#endif

#endif
