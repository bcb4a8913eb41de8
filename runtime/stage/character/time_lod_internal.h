/* time_lod_internal.h: the private part of low_stage.h. */
#ifndef NOH_CHARACTER_TIME_LOD_INTERNAL_H
#define NOH_CHARACTER_TIME_LOD_INTERNAL_H

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_stage.h"

#ifdef __cplusplus
extern "C" {
#endif

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

/* Compute the errors of a playing controller: the largest of its blended tracks plus the weighted sum of its additive
 * ones. A track's error grows with the square of a playback speed above 1, as interpolation error does for a clip that
 * is smooth over an update period. A clip that ends by itself was measured as stopping; played ping-pong its velocity
 * reverses instead, so its error counts twice.
 * shapes  clip_error_m[clip_count of the set][NOH_UPDATE_RATE_COUNT], error_m[NOH_UPDATE_RATE_COUNT] */
void noh_time_lod_error(const noh_controller *c, const float *clip_error_m, float *error_m);

/* Call after changing tracks: an update is then due. */
void noh_time_lod_wake(noh_time_lod *t);

NOH_STATIC_ASSERT(sizeof(noh_time_lod) == 48, time_lod);

/* Ticks between updates; 0 for NOH_UPDATE_RATE_FULL. */
uint32_t noh_update_period(noh_update_rate rate);

void noh_time_lod_init(noh_time_lod *t, uint32_t instance);

/* Call once for each frame with the instance in view. If frames are at least as long as the update period, every frame
 * is posed exactly, or with behind_ticks every step.
 * units   clock: the game's */
void noh_time_lod_frame(noh_time_lod *t, int64_t clock, noh_update_rate rate);

noh_due noh_time_lod_due(const noh_time_lod *t);

/* Ticks since the update was due; 0 if none is due. */
uint32_t noh_time_lod_late(const noh_time_lod *t);

/* The work of an update, in two steps:
 *   1. if keep is below 1: replace the other pose by the blend of both at this fraction, the pose shown now
 *   2. pose the instance as of pose_clock into `pose`; the other pose is then the source */
typedef struct noh_time_update {
    int64_t pose_clock; /* the game's clock in this frame, or later */
    float keep;
    uint8_t pose; /* 0 or 1: the target from now on */
} noh_time_update;

/* Begin an update; allowed in any frame, due or not. */
noh_time_update noh_time_lod_update(noh_time_lod *t);

/* The blend of this frame: 0 the source, 1 the target (to_pose). */
float noh_time_lod_fraction(const noh_time_lod *t);

/* ---- errors ---- */

#ifdef __cplusplus
}
#endif

#endif
