/* low_stage.h: levels of detail and palettes without a stage: for engines built of parts (noh_low.h). */

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
    const float *update_error_m; /* [clip_count][NOH_UPDATE_RATE_COUNT]; NULL: always full rate */
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
    /* [joint_count of the skeleton] joint radii of the mesh; NULL without a skinned mesh. Add other drawn meshes
     * with noh_mesh_add_joint_radii */
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
 * BODY MOVES, also with --only anim).
 *
 * A clip built with its mesh has exact errors of a few hundred vertices at each update rate; vertices between them may
 * have slightly larger errors. These errors assume that the set extracts root motion: the
 * jump at the end of a travelling loop is not counted. A clip built for a skeleton of other proportions may have other
 * joint levels: a joint level without an error for every clip is omitted, with all coarser ones.
 * errors  ARG a field of desc, or memory is NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY too small (need: the exact
 *         bytes) */
noh_result noh_lod_pack_init(void *memory, size_t bytes, const noh_lod_pack_desc *desc, noh_lod_pack *lod,
                             noh_error *error);

/* ======== palettes ========
 * Skinning matrices from poses, for any skin of any pack.
 *
 *   noh_pose_skin        matrices of a pose
 *
 * Matrices are in skin order: matrix k belongs to skin->joints[k], as for noh_gl_skin_set_matrices, noh_skin_vertices
 * and noh_skin_box. A skin may contain a joint several times with different inverse bind matrices (rigid parts that the
 * converter joined), and two skins may bind one joint differently. Inverse bind matrices therefore belong to skins, not
 * to the skeletons of packs.
 *
 * Threads: no state; any thread. */

/* Get the skin's matrices of a local pose.
 * shapes  pose[joint_count of the skeleton]; model[joint_count of the skeleton][12]: receives the joints' model-space
 *         matrices; matrices[joint_count of the skin][12] */
void noh_pose_skin(const noh_skeleton *skeleton, const noh_skin *skin, const noh_transform *pose, float *model,
                   float *matrices);

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
