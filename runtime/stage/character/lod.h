/* lod.h: LOD levels chosen by one setting, the largest error in pixels.
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
#ifndef NOH_CHARACTER_LOD_H
#define NOH_CHARACTER_LOD_H

#include "core/base/limits.h"
#include "core/base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Update rate: how often an instance is posed (time_lod.h). */
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
    /* the level within the quality setting; finer than `mesh` only with a limit of noh_lod_set_limit */
    uint8_t mesh_wanted;
    uint8_t mesh_limit; /* of noh_lod_set_limit */
} noh_lod;

NOH_STATIC_ASSERT(sizeof(noh_lod) == 32, lod);

/* Pixels per metre at a distance.
 * units   distance_m to the nearest point of the character; field_of_view_rad the full vertical angle
 * ranges  distances below a millimetre count as a millimetre; 0 < angle < pi
 * Exact in the middle of the view. A perspective view stretches towards its edges: with the nearest point's depth
 * instead of its distance the scale is exact there too, across the line of sight */
float noh_lod_scale(float distance_m, float field_of_view_rad, uint32_t viewport_height);

/* The depth of a box's nearest corner, in world units; below 0: behind the camera.
 * shapes  view_projection[16] column-major, of a perspective camera (clip w is the depth); world[12] rows of 3 x 4;
 *         box[6]: smallest x, y, z, largest x, y, z (noh_mesh_box, noh_skin_box) */
float noh_lod_depth(const float view_projection[16], const float world[12], const float box[6]);

/* Check a table once before using it.
 * errors  DATA a count is 0, or an error is negative, not finite, or below the previous level's (where: the level); ARG
 *         a level count is over the limit, or an array is NULL */
noh_result noh_lod_table_check(const noh_lod_table *table, noh_error *error);

/* Check settings.
 * errors  ARG `what` names the field */
noh_result noh_lod_settings_check(const noh_lod_settings *settings, noh_error *error);

/* Choose the levels of a frame. Call before noh_lod_targets.
 * shapes  update_error_m[NOH_UPDATE_RATE_COUNT] of everything that plays (noh_time_lod_error); NULL: full update rate
 * units   clock in ticks, never decreasing
 * ranges  pixels_per_metre >= 0, not NaN */
void noh_lod_choose(noh_lod *d, const noh_lod_table *table, const noh_lod_settings *settings, float pixels_per_metre,
                    const float *update_error_m, int64_t clock);

/* Show one mesh level in full detail otherwise, regardless of error, for tools and debugging. For a level that is not
 * loaded or past the last, the nearest existing one is shown. The next noh_lod_choose does not fade. */
void noh_lod_set_mesh(noh_lod *d, const noh_lod_table *table, uint32_t level, float pixels_per_metre);

/* Call when the camera has jumped or the character was out of view: the next choice ignores the current levels and does
 * not fade. */
void noh_lod_cut(noh_lod *d);

/* From the next choice on, take no finer mesh level than this one, because finer ones have no memory (lod_pools.h). 0:
 * no limit. mesh_wanted is still the level within the quality setting; error_m is for the level shown. */
void noh_lod_set_limit(noh_lod *d, uint32_t level);

/* The finest mesh level that needs memory: the finest of the level shown, the level a fade leaves, and the level
 * wanted. */
uint32_t noh_lod_finest(const noh_lod *d);

/* Progress of a change of mesh level: 0 only mesh_before, 1 only mesh, smooth at both ends (smoothstep). For a dither
 * of two draws, or a geomorph along the collapsed edges. The next change waits until it is 1. */
float noh_lod_fade(const noh_lod *d, int64_t clock);

/* One draw of a dithered fade: a level and its share of the pixels, as in noh_gl_lod. */
typedef struct noh_lod_part {
    uint32_t level;
    float from, to;
} noh_lod_part;

/* Get the draws of a frame: one part with all pixels or, during a fade, the new level and the old one. Returns their
 * number. */
uint32_t noh_lod_parts(const noh_lod *d, int64_t clock, noh_lod_part parts[2]);

/* The finest level drawn from now to the end of the fade: for noh_gl_morph_set_lod. */
uint32_t noh_lod_drawn(const noh_lod *d, int64_t clock);

/* Drop morph targets with effects too small to see: the smallest |weight| * radius first, while the sum is within the
 * share of targets. Sets d->skipped_m to the sum. Takes two passes over the weights if all can be dropped, at most 33.
 * shapes   weights[count]; radius_m[count]: the largest displacement by each target at weight 1; kept[count]: the
 *          weights, 0 if dropped; may be `weights`
 * returns  the number of nonzero weights kept; NaN is kept */
uint32_t noh_lod_targets(noh_lod *d, const noh_lod_settings *settings, const float *weights, const float *radius_m,
                         uint32_t count, float *kept);

/* The total error in pixels, including targets. It is within the quality setting, unless the finest levels and the
 * clips themselves exceed it, or the scale grew too fast for the lead during a fade. */
float noh_lod_error_pixels(const noh_lod *d);

/* Joints to pose, and influences to use per vertex, at the chosen levels; 0: all, the table has no levels of the
 * kind. */
uint32_t noh_lod_joint_count(const noh_lod *d, const noh_lod_table *table);
uint32_t noh_lod_influence_count(const noh_lod *d, const noh_lod_table *table);

#ifdef __cplusplus
}
#endif

#endif
