/* time_lod.h: posing an instance less often than once a frame.
 *
 * An instance holds two poses, source and target, and shows a mix of them. They are not the last two poses: mixing
 * those shows the past (125 ms late at 8 Hz, so that a walk's feet slide and its steps are heard before they are seen),
 * and extrapolating from them costs up to 8 times the error of interpolation and a jump at every update. But a
 * controller is a block of bytes, and a copy of it can be played ahead without firing callbacks. So an update at tick t
 * poses the instance as it will be at its next update, and until then what is shown moves from the true pose at t to
 * the true pose there: no lag, no jumps, and an error that grows with the square of the update period, measured for
 * each clip by noh_time_lod_measure. What a program changes in between could not be foreseen: it is shown from the next
 * update on, or after noh_time_lod_wake from the next frame on, and never as a jump.
 *
 * Poses are mixed as matrices in object space, so every skinned vertex moves in a straight line from one true position
 * to the next. Mixing local transforms would follow arcs, but would need new matrices in every frame, which costs more
 * than sampling does.
 *
 * What is shown may lie behind the clock (behind_ticks): a game that steps at a fixed rate and draws at another one
 * shows frames between its last two steps. An update then poses the instance as it is after the last step, or later,
 * and what is shown moves there from the pose before: an instance at the full rate is posed once in a step, and mixed
 * in every frame.
 *
 * Callback keys are not affected: controllers are stepped in every frame, seen or not.
 *
 * Updates are staggered: instance n is updated at the fraction n * golden ratio (modulo 1) of the period, so that any
 * run of numbers is spread evenly (H. Weyl, "Ueber die Gleichverteilung von Zahlen mod. Eins", 1916).
 *
 * Threads: a noh_time_lod belongs to one thread at a time; measuring may run on any thread that may sample the set. */
#ifndef NOH_CHARACTER_TIME_LOD_H
#define NOH_CHARACTER_TIME_LOD_H

#include "motion/anim/controller.h"
#include "motion/pose/skeleton.h"
#include "stage/character/lod.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_TIME_LOD_UNSEEN_TICKS 6000u /* after a longer absence an instance is posed before it is shown */

/* State, without pointers. All clocks are the game's, in ticks. */
typedef struct noh_time_lod {
    int64_t from_clock, to_clock; /* the mix runs from source to target between these; equal: the target alone */
    int64_t due_clock;            /* when the next update is due */
    int64_t clock;                /* of the last frame, as shown: behind_ticks before the game's */
    uint32_t frame_ticks;         /* from the frame before it to that one */
    uint32_t instance;
    uint8_t chosen_rate;   /* noh_update_rate of the last frame; the next update takes it up */
    uint8_t shown_rate;    /* noh_update_rate of the mix that is shown */
    uint8_t to_pose;       /* which pose is the target, 0 or 1; the other is the source */
    uint8_t posed;         /* 0: no valid pose yet */
    uint32_t behind_ticks; /* what frames show lies so far behind the game's clock; set it before a frame. At most the
                            * last step */
} noh_time_lod;

NOH_STATIC_ASSERT(sizeof(noh_time_lod) == 48, time_lod);

/* Ticks between updates; 0 for NOH_UPDATE_RATE_FULL. */
uint32_t noh_update_period(noh_update_rate rate);

void noh_time_lod_init(noh_time_lod *t, uint32_t instance);

/* Call once in each frame in which the instance is in view. Where frames are as long as the update period, or longer,
 * every one is posed exactly, or where what is shown lies behind, every step.
 * units   clock: the game's */
void noh_time_lod_frame(noh_time_lod *t, int64_t clock, noh_update_rate rate);

typedef enum noh_due {
    NOH_DUE_NOT = 0, /* the mix is still valid */
    NOH_DUE,         /* an update is due; until it comes the target pose is held */
    NOH_DUE_AT_ONCE  /* no valid pose: never posed, or out of view for NOH_TIME_LOD_UNSEEN_TICKS */
} noh_due;

noh_due noh_time_lod_due(const noh_time_lod *t);

/* Ticks since the update was due; 0 when it is not. */
uint32_t noh_time_lod_late(const noh_time_lod *t);

/* What an update has to do, in two steps:
 *   1. where keep is below 1: replace the other pose by the mix of both at this fraction, which is what is shown now
 *   2. pose the instance, as it will be at pose_clock, into `pose`; the other one is then the source */
typedef struct noh_time_update {
    int64_t pose_clock; /* the game's clock in this frame, or later */
    float keep;
    uint8_t pose; /* 0 or 1: the target from now on */
} noh_time_update;

/* Begin an update; allowed in any frame, due or not. */
noh_time_update noh_time_lod_update(noh_time_lod *t);

/* The mix of this frame: 0 the source, 1 the target (to_pose). */
float noh_time_lod_fraction(const noh_time_lod *t);

/* Tracks were changed: an update is due from now on. */
void noh_time_lod_wake(noh_time_lod *t);

/* ---- errors ---- */

/* What a clip is measured for. All borrowed. */
typedef struct noh_time_probe {
    const noh_clip_set *set;
    const noh_skeleton *skeleton; /* of the set */
    /* [joint_count] the joint radii (bounds.h); below 0: the joint moves no vertex */
    const float *joint_radius_m;
    const float *float_radius_m; /* [float_count] the most that each float moves a vertex at weight 1; NULL: floats are
                                    left out */
    /* 1: each pass of a repeating clip begins where joint 0 ended the one before, as if its translation were root
     * motion: for a set that does not extract it yet, but will; 0: joint 0 jumps back */
    int travels;
} noh_time_probe;

/* Bytes of the working memory that measuring takes; 0 for a set over NOH_JOINTS_MAX or NOH_FLOATS_MAX. */
size_t noh_time_lod_measure_size(const noh_time_probe *probe);

/* Measure the largest error of a clip, played in its own loop mode, at each update rate: over periods that begin every
 * 400 ticks, every 200 ticks within each, for any point within a joint's radius, in object space (without root motion
 * where the set extracts it). For converters and for load time: ten seconds of 31 joints take about 0.1 s.
 *
 * The result is the largest error found, not a proof for all ticks. At each tick it is a bound: the difference of two
 * matrices moves a point by at most its norm times the point's distance, and the norm is overestimated by up to 15 %
 * (the Schatten 8-norm).
 * shapes  error_m[NOH_UPDATE_RATE_COUNT]; at the full rate it is 0
 * units   model units, taken as metres
 * errors  ARG probe, clip, or memory NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY too small; need: the exact bytes
 */
noh_result noh_time_lod_measure(void *memory, size_t bytes, const noh_time_probe *probe, uint32_t clip, float *error_m,
                                noh_error *error);

/* The errors of what a controller plays: the largest among its blended tracks plus the weighted sum of its additive
 * ones. Where a track's playback speed is above 1, its error grows with the square of the speed, as that of
 * interpolation does where a clip is smooth over an update period. A clip that ends by itself was measured so: played
 * ping-pong it turns instead, where velocity reverses instead of stopping, and its error counts twice.
 * shapes  clip_error_m[the set's clip_count][NOH_UPDATE_RATE_COUNT], error_m[NOH_UPDATE_RATE_COUNT] */
void noh_time_lod_error(const noh_controller *c, const float *clip_error_m, float *error_m);

#ifdef __cplusplus
}
#endif

#endif
