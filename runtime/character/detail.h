/* detail.h: how much detail a character needs, by one number: the largest error in pixels (row C16.4).
 *
 * Everything that can be left out has an error in metres: how far it can move a drawn point. Seen from where
 * the camera stands a metre is so many pixels. The knob, pixels, is cut into shares, one for each kind of
 * detail: errors of different kinds add at worst (the triangle inequality), the shares sum to at most 1, so
 * the whole stays under the knob, and kinds are chosen independently of each other: no choice makes
 * another one flicker. Each kind takes its coarsest level whose error is under its share.
 *
 * Nothing flickers: a level is left for a coarser one only when that one's error is under (1 - hysteresis) of
 * the share, and for a finer one when its own error is over the share. Mesh levels fade (see noh_detail_fade)
 * and can therefore not be left at once: they are left a little earlier, over (1 - lead) of their share, so
 * that the error stays under the share while the scale grows by less than 1 / (1 - lead) in one fade. The
 * other kinds change at once: what then jumps is smaller than their share of the knob. */
#ifndef NOH_CHARACTER_DETAIL_H
#define NOH_CHARACTER_DETAIL_H

#include "base/limits.h"
#include "base/result.h"

/* How often an instance is posed (time_lod.h). */
typedef enum noh_rate {
    NOH_RATE_FULL = 0, /* every frame */
    NOH_RATE_30,       /* Hz */
    NOH_RATE_15,
    NOH_RATE_8,
    NOH_RATE_COUNT
} noh_rate;

/* Levels from the finest to the coarsest; errors must not fall from one to the next. Plain data, as in a pack. */
typedef struct noh_mesh_level {
    uint32_t vertex_count;    /* a prefix of the mesh's vertices */
    uint32_t triangle_count;
    uint32_t influence_count; /* the most joints that one vertex of this level hangs on; 0: not skinned */
    float error_m;            /* certified: the largest distance of its surface to the full one, in any pose */
} noh_mesh_level;

typedef struct noh_joint_level {
    uint32_t joint_count;     /* a prefix of the joints is posed, all that have no parent in it; the others go where their parents go */
    float error_m;            /* the farthest that a vertex is off for that, in any pose */
} noh_joint_level;

typedef struct noh_influence_level {
    uint32_t influence_count; /* the heaviest so many of a vertex are used */
    float error_m;
} noh_influence_level;

/* What a character can leave out. Borrowed; one for all its instances. */
typedef struct noh_detail_table {
    const noh_mesh_level *meshes;
    const noh_joint_level *joints;
    const noh_influence_level *influences;
    uint32_t mesh_level_count;      /* each 1..NOH_DETAIL_LEVELS_MAX, or 0: that kind is always full */
    uint32_t mesh_level_first;      /* the finest mesh level that is loaded; below mesh_level_count, or 0. None finer is chosen */
    uint32_t joint_level_count;
    uint32_t influence_level_count;
    float clip_error_m;             /* of compressed motion, always there; counted in the share of time */
    const float *rate_error_m;      /* [motion_count][NOH_RATE_COUNT] by noh_time_lod_measure or noh_time_points_measure; NULL: always full rate */
} noh_detail_table;

typedef enum noh_detail_kind {
    NOH_DETAIL_MESH = 0,
    NOH_DETAIL_JOINTS,
    NOH_DETAIL_INFLUENCES,
    NOH_DETAIL_TARGETS,
    NOH_DETAIL_TIME,
    NOH_DETAIL_KIND_COUNT
} noh_detail_kind;

typedef struct noh_detail_settings {
    float pixels;                       /* the knob; default (0) 1; above 0 */
    float shares[NOH_DETAIL_KIND_COUNT]; /* of the knob; each 0..1, sum at most 1; default (all 0) 0.3, 0.1, 0.05, 0.1, 0.45 */
    float hysteresis;                   /* default (0) 0.3; below 1 */
    float lead;                         /* default (0) half the hysteresis; below the hysteresis */
    uint32_t fade_ticks;                /* of a change of mesh level; default (0) 12,000: a quarter of a second; 1: at once */
} noh_detail_settings;

/* State, for each instance. Zero is a good start. */
typedef struct noh_detail {
    int64_t fade_start;     /* tick */
    uint32_t fade_ticks;    /* 0: no fade is on */
    float pixels_per_metre; /* as last chosen for */
    float error_m;          /* of all that was chosen, live: what the shown mesh levels, joints, influences and rate are off at most */
    float skipped_m;        /* of the targets that were left out, live */
    uint8_t mesh, mesh_before; /* levels; mesh_before is what is faded from, else the same */
    uint8_t joints, influences, rate;
    uint8_t started;        /* 0: the next choice is made afresh and does not fade */
    uint8_t mesh_wanted;    /* what the knob asks for: finer than `mesh` only where noh_detail_limit holds it back */
    uint8_t mesh_limit;     /* see there */
} noh_detail;

NOH_STATIC_ASSERT(sizeof(noh_detail) == 32, detail);

/* How many pixels a metre is at a distance.
 * units   distance_m to the nearest point of the bounding sphere; field_of_view_rad the whole vertical angle
 * ranges  distances below a millimetre count as one; 0 < angle < pi
 * It holds at the middle of the view. Towards the edges a perspective view is stretched: give the depth of
 * the nearest point instead of its distance to be right across the line of sight there too */
float noh_detail_scale(float distance_m, float field_of_view_rad, uint32_t viewport_height);

/* The depth of the nearest corner of a box, in world units; below 0: behind the camera.
 * shapes  view_projection column-major with a last row of (-z, distance) as perspective has it; world[12] rows of 3 x 4;
 *         box: smallest and largest x, y, z (noh_mesh_box, noh_skin_box) */
float noh_detail_depth(const float view_projection[16], const float world[12], const float box[6]);

/* Check what a pack or a program brings, once.
 * errors  DATA (where: the level) a count or an error that is not finite, negative, or smaller than that
 *         before it; ARG a count over the limit, named */
noh_result noh_detail_table_check(const noh_detail_table *table, noh_error *error);

/* errors  ARG names the field */
noh_result noh_detail_settings_check(const noh_detail_settings *settings, noh_error *error);

/* Choose for this frame. Before noh_detail_targets.
 * shapes  rate_error_m[NOH_RATE_COUNT] of what plays (noh_time_lod_error); NULL: full rate
 * units   clock in ticks; it must not go back
 * ranges  pixels_per_metre >= 0, not NaN */
void noh_detail_choose(noh_detail *d, const noh_detail_table *table, const noh_detail_settings *settings, float pixels_per_metre,
                       const float *rate_error_m, int64_t clock);

/* Show one mesh level whatever the knob says (past the last: that one), and all of everything else. The next choice is
 * made afresh. */
void noh_detail_fix(noh_detail *d, const noh_detail_table *table, uint32_t level, float pixels_per_metre);

/* The camera has jumped, or the character was not seen: choose afresh, without a fade. */
void noh_detail_cut(noh_detail *d);

/* From the next choice on take no finer mesh level than this: there is no memory for it (level_pools.h). 0: take any.
 * What the knob asks for goes on to be chosen, into mesh_wanted; error_m is that of what is shown. */
void noh_detail_limit(noh_detail *d, uint32_t level);

/* The finest mesh level that there has to be memory for: of what is shown, what is faded from and what is wanted. */
uint32_t noh_detail_finest(const noh_detail *d);

/* How far a change of mesh level has come: 0 mesh_before alone, 1 mesh alone; smooth at both ends. For a
 * geomorph along the collapsed edges, or a dither of two draws. No other change begins before it is 1. */
float noh_detail_fade(const noh_detail *d, int64_t clock);

/* One of the draws that a dithered fade takes: a level, and the pixels that are its, as in noh_gl_detail. */
typedef struct noh_detail_part {
    uint32_t level;
    float from, to;
} noh_detail_part;

/* What to draw: one part with all pixels, or, while a level fades, that which comes and that which goes. Returns how many. */
uint32_t noh_detail_parts(const noh_detail *d, int64_t clock, noh_detail_part parts[2]);

/* The finest level that is drawn now or in the fade that has begun: for noh_gl_morph_set_level. */
uint32_t noh_detail_drawn(const noh_detail *d, int64_t clock);

/* Leave out morph targets that cannot be seen: the smallest |weight| * reach first, for as long as their sum
 * is within the share. Sets d->skipped_m to that sum. Costs two passes over the weights where all go, else a few more: 33 at most.
 * shapes  weights[count], kept[count] (may be weights): 0 where left out; reach_m[count]: the largest
 *         displacement of each target at weight 1
 * returns how many weights that were not 0 were kept. What is not a number is kept. */
uint32_t noh_detail_targets(noh_detail *d, const noh_detail_settings *settings, const float *weights, const float *reach_m, uint32_t count,
                            float *kept);

/* The whole error, pixels: what was chosen and what was skipped. Under the knob wherever the finest levels
 * and the clip's error are, and the scale did not outgrow the lead within a fade. */
float noh_detail_error_pixels(const noh_detail *d);

/* What the levels come to: 0 where the table does not say, and everything is to be used. */
uint32_t noh_detail_joint_count(const noh_detail *d, const noh_detail_table *table);
uint32_t noh_detail_influence_count(const noh_detail *d, const noh_detail_table *table);

#endif
