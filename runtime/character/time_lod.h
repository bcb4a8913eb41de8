/* time_lod.h: posing an instance less often than once a frame (row C16.4).
 *
 * An instance holds two poses and shows a mix of them. Which two: not the last two, which are either late
 * (shown one update behind, the feet of a walk 125 ms behind the ground and the sound of the step) or wrong
 * (extrapolated: up to 8 times the error of interpolation, and a jump at every update). The future is known: a
 * controller is a block of bytes that can be copied and played on without anyone's hearing of it. So an update
 * at tick t poses the instance as it will be at its next update, and until then what is shown goes from the true
 * pose at t to the true pose there: no lag, no jump, and an error that grows with the square of the interval,
 * measured for each motion by noh_time_lod_measure. What a program changes in between is not foreseen: it is
 * shown from the next update on, or, after noh_time_lod_wake, from the next frame on; never as a jump.
 *
 * Poses are mixed as matrices in object space: every skinned vertex goes straight from one true place to the
 * next. Local transforms would go along arcs, but would have to be made matrices in every frame, which costs
 * more than sampling them does.
 *
 * Callback keys have nothing to do with all this: controllers are stepped every frame, seen or not.
 *
 * Updates are staggered by the number of the instance: the n-th is updated at the fraction n * golden ratio (modulo
 * 1) of the period, so that any stretch of numbers is spread evenly (Weyl's sequence). */
#ifndef NOH_CHARACTER_TIME_LOD_H
#define NOH_CHARACTER_TIME_LOD_H

#include "anim/controller.h"
#include "anim/skeleton.h"
#include "character/detail.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_TIME_LOD_UNSEEN_TICKS 6000u /* what was not looked at for longer has to be posed before it is shown */

/* State, without pointers. Clocks are of one clock that all instances share. */
typedef struct noh_time_lod {
    int64_t from_clock, to_clock; /* what is shown goes from one pose to the other between these; equal: the second alone */
    int64_t due_clock;            /* when the next update is wanted */
    int64_t clock;                /* of the last frame */
    uint32_t frame_ticks;         /* from the frame before it to that one */
    uint32_t instance;
    uint8_t wanted, running;      /* noh_rate: as chosen last, and of the interval that is shown */
    uint8_t to_slot;              /* 0, 1: which pose is gone to; the other one is come from */
    uint8_t posed;                /* 0: there is no pose yet */
    uint8_t reserved[4];
} noh_time_lod;

NOH_STATIC_ASSERT(sizeof(noh_time_lod) == 48, time_lod);

/* Ticks between updates; 0 for NOH_RATE_FULL. */
uint32_t noh_rate_period(noh_rate rate);

void noh_time_lod_init(noh_time_lod *t, uint32_t instance);

/* Once for each frame in which the instance is seen. Frames as long as a period or longer are posed exactly. */
void noh_time_lod_frame(noh_time_lod *t, int64_t clock, noh_rate rate);

typedef enum noh_due {
    NOH_DUE_NOT = 0, /* what is shown goes on to be right */
    NOH_DUE,         /* an update is wanted; for as long as it does not come, the last pose is held */
    NOH_DUE_AT_ONCE  /* there is nothing fit to be shown: never posed, or not seen for NOH_TIME_LOD_UNSEEN_TICKS */
} noh_due;

noh_due noh_time_lod_due(const noh_time_lod *t);

/* Ticks since the update was due; 0 when it is not. */
uint32_t noh_time_lod_late(const noh_time_lod *t);

/* What an update has to do, in this order. */
typedef struct noh_time_update {
    int64_t pose_clock; /* 2. pose the instance as it is (the clock of this frame) or will be then */
    float keep;         /* 1. below 1: the pose in the other slot becomes the mix of both at this fraction, as it is shown now */
    uint8_t slot;       /* 2. into this slot; the other one is what is come from */
} noh_time_update;

/* Begin an update; allowed in any frame, due or not. */
noh_time_update noh_time_lod_update(noh_time_lod *t);

/* Of this frame: 0 the pose come from, 1 that in to_slot. */
float noh_time_lod_fraction(const noh_time_lod *t);

/* Something was changed that the poses do not know: a track started, sought, stopped. Due from now on. */
void noh_time_lod_wake(noh_time_lod *t);

/* ---- errors ---- */

/* What a motion is measured for. All borrowed. */
typedef struct noh_time_probe {
    const noh_anim_set *set;
    const noh_skeleton *skeleton;  /* of the set */
    const float *joint_reach_m;    /* [joint_count] the farthest vertex that hangs on each joint, in the bind pose; below 0: none does */
    const float *float_reach_m;    /* [float_count] what each float moves at weight 1; NULL: floats are not counted */
    int travels;                   /* 1: each pass of a repeating motion begins where joint 0 came in the one before, as if its
                                    * translation were root motion: for a set that does not take it out, but will; 0: it leaps back */
} noh_time_probe;

/* Bytes of the working memory that measuring takes. */
size_t noh_time_lod_measure_size(const noh_time_probe *probe);

/* Measure what a motion, played in its own loop mode, is off at most when it is posed at each rate: over intervals that
 * begin every 400 ticks, every 200 ticks within each, for any point within a joint's reach of it, in object
 * space (without root motion where the set takes it out). For a converter, or when a set is loaded: ten
 * seconds of 31 joints take about 0.1 s.
 * shapes  error_m[NOH_RATE_COUNT]; that of the full rate is 0
 * units   model units, as metres
 * memory  16-byte aligned
 * errors  ARG probe, motion, memory; MEMORY need: the bytes
 * A largest value found, not a proof; of each place, though, a bound: the difference of two matrices moves a
 * point by at most its norm, taken up to 15 % too high (Schatten's 8-norm) */
noh_result noh_time_lod_measure(void *memory, size_t bytes, const noh_time_probe *probe, uint32_t motion, float *error_m, noh_error *error);

/* The errors of what a controller plays: the worst of the blended tracks, plus the weighted sum of the additive ones.
 * Tracks faster than 1 have the square of their speed times the error: for motion that is smooth over a period.
 * shapes  motion_error_m[motion_count of the set][NOH_RATE_COUNT], error_m[NOH_RATE_COUNT] */
void noh_time_lod_error(const noh_controller *c, const float *motion_error_m, float *error_m);

#ifdef __cplusplus
}
#endif

#endif
