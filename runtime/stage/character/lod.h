/* lod.h: LOD levels chosen by one number, the largest error in pixels.
 *
 * Everything that can be left out has an error in metres: how far it can move a drawn point. At a given depth a metre
 * is so many pixels. The quality setting, `pixels`, is cut into shares, one for each kind of LOD. Errors of different
 * kinds add up at worst (the triangle inequality) and the shares sum to at most 1, so the total stays below the
 * setting; and kinds are chosen independently, so that no choice makes another one flicker. Each kind takes its
 * coarsest level whose error is within its share. (D. Luebke et al., "Level of Detail for 3D Graphics", Morgan Kaufmann
 * 2003, chapter 4, describes selection by screen-space error, with hysteresis.)
 *
 * Hysteresis keeps choices stable: a coarser level is taken only when its error is below (1 - hysteresis) of the share,
 * a finer one when the present error is above the share. Mesh levels fade (noh_lod_fade) and so take time to leave;
 * they are left a little early, above (1 - lead) of the share, which keeps the error within it for as long as the scale
 * grows by less than 1 / (1 - lead) during one fade. The other kinds switch at once: the jump is smaller than their
 * share.
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

/* Levels run from the finest to the coarsest; errors must not fall along the way. Plain data, as in a pack. */
typedef struct noh_lod_mesh {
    uint32_t vertex_count; /* the level draws a prefix of the mesh's vertices */
    uint32_t triangle_count;
    uint32_t influence_count; /* the most joints that move one vertex of this level; 0: not skinned */
    float error_m; /* the largest distance of its surface from the full mesh's, in any pose that was measured */
} noh_lod_mesh;

typedef struct noh_lod_joints {
    uint32_t joint_count; /* a prefix of the joints is posed, all roots in it; the others move with their parents */
    float error_m;        /* the largest error of a vertex, in any pose */
} noh_lod_joints;

typedef struct noh_lod_influences {
    uint32_t influence_count; /* this many of a vertex's influences are used, the heaviest */
    float error_m;
} noh_lod_influences;

/* The levels of a character and their errors. Borrowed; one for all its instances. */
typedef struct noh_lod_table {
    const noh_lod_mesh *meshes;
    const noh_lod_joints *joints;
    const noh_lod_influences *influences;
    uint32_t mesh_level_count; /* each 1..NOH_LOD_LEVELS_MAX, or 0: that kind has no levels */
    /* the finest mesh level that is loaded: below mesh_level_count, or 0. No finer one is chosen */
    uint32_t mesh_level_first;
    uint32_t joint_level_count;
    uint32_t influence_level_count;
    float clip_error_m;          /* of clip compression: always present, counted in the share of time */
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
    uint32_t fade_ticks; /* of a change of mesh level; default (0) 12,000: a quarter of a second; 1: at once */
} noh_lod_settings;

/* State of one instance. Begin with zeros. */
typedef struct noh_lod {
    int64_t fade_start;     /* tick */
    uint32_t fade_ticks;    /* 0: no fade is running */
    float pixels_per_metre; /* the scale of the last choice */
    float error_m;   /* present error: the sum of those of the mesh level (in a fade the coarser one), the joint level,
                        the influence level and the update rate */
    float skipped_m; /* present error of the morph targets that are left out */
    uint8_t mesh, mesh_before;  /* levels; mesh_before is the level that a fade leaves, else the same as mesh */
    uint8_t joints, influences; /* levels */
    uint8_t update_rate;        /* noh_update_rate */
    uint8_t started;            /* 0: the next choice is made afresh, without a fade */
    /* the level within the quality setting: finer than `mesh` only where noh_lod_set_limit holds it back */
    uint8_t mesh_wanted;
    uint8_t mesh_limit; /* of noh_lod_set_limit */
} noh_lod;

NOH_STATIC_ASSERT(sizeof(noh_lod) == 32, lod);

/* Pixels per metre at a distance.
 * units   distance_m to the nearest point of the character; field_of_view_rad the full vertical angle
 * ranges  distances below a millimetre count as a millimetre; 0 < angle < pi
 * Exact in the middle of the view. A perspective view stretches towards its edges: pass the nearest point's depth
 * instead of its distance, and the scale is exact there too, across the line of sight */
float noh_lod_scale(float distance_m, float field_of_view_rad, uint32_t viewport_height);

/* The depth of a box's nearest corner, in world units; below 0: behind the camera.
 * shapes  view_projection[16] column-major, of a perspective camera (clip w is the depth); world[12] rows of 3 x 4;
 *         box[6]: smallest x, y, z, largest x, y, z (noh_mesh_box, noh_skin_box) */
float noh_lod_depth(const float view_projection[16], const float world[12], const float box[6]);

/* Check a table once, before it is used.
 * errors  DATA (where: the level) a count of 0, or an error that is negative, not finite, or below that of the level
 *         before; ARG a count of levels over the limit, or a NULL array */
noh_result noh_lod_table_check(const noh_lod_table *table, noh_error *error);

/* errors  ARG names the field */
noh_result noh_lod_settings_check(const noh_lod_settings *settings, noh_error *error);

/* Choose for this frame. Before noh_lod_targets.
 * shapes  update_error_m[NOH_UPDATE_RATE_COUNT] of what plays (noh_time_lod_error); NULL: full update rate
 * units   clock in ticks, never decreasing
 * ranges  pixels_per_metre >= 0, not NaN */
void noh_lod_choose(noh_lod *d, const noh_lod_table *table, const noh_lod_settings *settings, float pixels_per_metre,
                    const float *update_error_m, int64_t clock);

/* Show one mesh level whatever its error, with everything else in full: for tools and debugging. Levels that are not
 * loaded or past the last give the nearest one that exists. The next noh_lod_choose starts afresh. */
void noh_lod_set_mesh(noh_lod *d, const noh_lod_table *table, uint32_t level, float pixels_per_metre);

/* Call when the camera has jumped or the character was out of view: the next choice is made afresh, without a fade. */
void noh_lod_cut(noh_lod *d);

/* From the next choice on, take no finer mesh level than this one, because no finer one has memory (lod_pools.h). 0: no
 * limit. mesh_wanted is still the level within the quality setting; error_m is that of the level shown. */
void noh_lod_set_limit(noh_lod *d, uint32_t level);

/* The finest mesh level that needs memory: of the level shown, the one a fade leaves and the one wanted. */
uint32_t noh_lod_finest(const noh_lod *d);

/* Progress of a change of mesh level: 0 mesh_before alone, 1 mesh alone, smooth at both ends (smoothstep). For a dither
 * of two draws, or a geomorph along the collapsed edges. The next change waits until it is 1. */
float noh_lod_fade(const noh_lod *d, int64_t clock);

/* One draw of a dithered fade: a level and its share of the pixels, as noh_gl_lod takes them. */
typedef struct noh_lod_part {
    uint32_t level;
    float from, to;
} noh_lod_part;

/* What to draw: one part with all pixels or, during a fade, the new level and the old one. Returns how many. */
uint32_t noh_lod_parts(const noh_lod *d, int64_t clock, noh_lod_part parts[2]);

/* The finest level drawn from now to the end of the fade: for noh_gl_morph_set_lod. */
uint32_t noh_lod_drawn(const noh_lod *d, int64_t clock);

/* Leave out morph targets whose effect is too small to see: the smallest |weight| * radius first, while their sum is
 * within the share of targets. Sets d->skipped_m to that sum. Two passes over the weights where all can be left out, 33
 * at most.
 * shapes   weights[count]; radius_m[count]: the largest displacement that each target causes at weight 1; kept[count]:
 *          the weights, 0 where left out; may be `weights`
 * returns  how many weights that are not 0 were kept; NaN is kept */
uint32_t noh_lod_targets(noh_lod *d, const noh_lod_settings *settings, const float *weights, const float *radius_m,
                         uint32_t count, float *kept);

/* The total error in pixels, targets included. It is within the quality setting, unless the finest levels and the clips
 * themselves exceed it, or the scale outgrew the lead during a fade. */
float noh_lod_error_pixels(const noh_lod *d);

/* Joints to pose, and influences to use per vertex, at the chosen levels; 0: all, the table has no levels of that kind.
 */
uint32_t noh_lod_joint_count(const noh_lod *d, const noh_lod_table *table);
uint32_t noh_lod_influence_count(const noh_lod *d, const noh_lod_table *table);

#ifdef __cplusplus
}
#endif

#endif
