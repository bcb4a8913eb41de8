/* face_internal.h (private to face/): the modules of a face.
 *
 *   face.c         descs, calls, the order of events
 *   face_random.c  random numbers by seed
 *   face_spring.c  damped springs
 *   face_blink.c   blinks
 *   face_gaze.c    gaze, and how far the head turns with it
 *   face_pose.c    the visible pose
 *   face_four.c    the mode of four channels */
#ifndef NOH_FACE_FACE_INTERNAL_H
#define NOH_FACE_FACE_INTERNAL_H

#include <stdint.h>

#include "noh/face.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The emotion of a name; NOH_EMOTION_COUNT: unknown. */
noh_emotion noh_emotion_of_name(const char *name);

/* Advance time while the face is not visible, at constant cost. It ends at rest, with the same gaze target and
 * emotions; blinks, breaths and glances come at other times than with noh_face_step. */
void noh_face_skip(noh_face *face, const noh_face_desc *desc, int64_t ticks);

/* Compute noh_face_pose.breath alone. */
float noh_face_breath(const noh_face *face);

/* The four channels of a frame, for a shader that has only four: one blink, the strongest emotion, the two strongest
 * mouth shapes, with a sum of at most 1. */
typedef struct noh_face_four {
    float weights[4];  /* blink, emotion, first and second mouth shape */
    uint8_t emotion;   /* noh_emotion; NOH_EMOTION_COUNT: none */
    uint8_t speech[2]; /* noh_viseme (face.h); 0: none */
    uint8_t reserved;
} noh_face_four;

/* Reduce a pose and mouth shapes to four channels.
 * pose     NULL: at rest
 * visemes  [15], as for noh_face_channels; NULL: silent */
void noh_face_four_of(const noh_face_pose *pose, const float *visemes, noh_face_four *four);

/* Expand the mouth shapes: visemes[15], at most two of them not 0. */
void noh_face_four_visemes(const noh_face_four *four, float *visemes);

#define NOH_DEGREE 0.0174532925f
#define NOH_FACE_TICKS_PER_S 48000.0f

/* How far an eye turns in its socket. */
#define NOH_EYE_YAW_MAX (35.0f * NOH_DEGREE)
#define NOH_EYE_UP_MAX (25.0f * NOH_DEGREE)
#define NOH_EYE_DOWN_MAX (30.0f * NOH_DEGREE)

/* ---- random numbers by seed ---- */

/* The use of a number. Each stream is independent, so that the times of blinks do not depend on the gaze. */
typedef enum noh_face_stream {
    NOH_FACE_INTERVAL = 1,
    NOH_FACE_SHAPE,
    NOH_FACE_DOUBLE,
    NOH_FACE_WITH_GAZE,
    NOH_FACE_LATENCY,
    NOH_FACE_GLANCE,
    NOH_FACE_GLANCE_SIZE,
    NOH_FACE_GLANCE_WAY,
    NOH_FACE_TREMOR,
    NOH_FACE_TREMOR_WAY,
    NOH_FACE_BREATH,
    NOH_FACE_IDLE = NOH_FACE_BREATH + 2, /* three: yaw, pitch, roll */
    NOH_FACE_MOOD = NOH_FACE_IDLE + 3,
    NOH_FACE_STRATA,
    NOH_FACE_SWAY,                      /* three: yaw, pitch, roll */
    NOH_FACE_DRIFT = NOH_FACE_SWAY + 3, /* three: x, y, z */
    NOH_FACE_BROWS = NOH_FACE_DRIFT + 3,
    NOH_FACE_STAND = NOH_FACE_BROWS + 3, /* six, of bodies that stand */
    NOH_FACE_COMPLEXION = NOH_FACE_STAND + 6
} noh_face_stream;

float noh_face_uniform(uint32_t seed, uint32_t stream, uint32_t index); /* above 0, below 1 */
float noh_face_normal(float uniform);                                   /* the quantile of the normal distribution */
/* Log-normal with this mean; sigma of the logarithm. */
float noh_face_log_normal(float uniform, float mean, float sigma);

/* ---- springs ---- */

float noh_face_spring_at(const noh_face_spring *s, uint32_t tick);
void noh_face_spring_to(noh_face_spring *s, uint32_t tick, float goal, float omega);
float noh_face_omega(uint32_t ticks); /* for a spring that covers 95 % of its way in this many ticks */
void noh_face_spring_settle(noh_face_spring *s, uint32_t tick);

/* ---- blinks ---- */

typedef struct noh_face_lid {
    uint32_t closing, shut, opening; /* ticks */
} noh_face_lid;

noh_face_lid noh_face_lid_of(const noh_face *face, uint32_t blink);
float noh_face_blink_at(const noh_face *face); /* 0 open .. 1 shut */
void noh_face_blink_begin(noh_face *face);     /* begin the blink that is due */
void noh_face_blink_pull(noh_face *face);      /* begin the next blink now */
void noh_face_blink_schedule(noh_face *face);
/* Another owner shuts the lids, 0 to 1: no blink for a while. */
void noh_face_blink_seen(noh_face *face, float shut);
float noh_face_blink_mean(uint32_t activity); /* mean seconds between two blinks */

/* ---- the mode of four channels ---- */

static inline int noh_face_is_four(const noh_face *face)
{
    return (face->flags & NOH_FACE_FOUR) != 0;
}

uint32_t noh_face_four_wait(const noh_face *face, uint32_t blink); /* from one blink to the next */
float noh_face_four_lid(uint32_t ticks);
void noh_face_mood_begin(noh_face *face, uint32_t emotion, float amount, uint32_t hold);
void noh_face_mood_next(noh_face *face);
uint32_t noh_face_mood_end(const noh_face *face); /* tick */
float noh_face_mood_at(const noh_face *face);

/* ---- gaze ---- */

enum { NOH_GAZE_HOLD = 0, NOH_GAZE_WAIT, NOH_GAZE_MOVE };

/* Get yaw, pitch and 1 / distance from the midpoint of the eyes, with the head at the face's clock. */
void noh_face_gaze_at(const noh_face *face, const noh_face_desc *desc, float gaze[3]);
/* Get the gaze for a known rotation of the head. */
void noh_face_gaze_from(const noh_face *face, const noh_face_desc *desc, const float head[4], float gaze[3]);
void noh_face_gaze_goal(const noh_face *face, const noh_face_desc *desc, float gaze[3]);
/* Leave the gaze `from` for the target after a latency. */
void noh_face_gaze_shift(noh_face *face, const float from[3], uint32_t latency);
void noh_face_gaze_event(noh_face *face, const noh_face_desc *desc); /* a latency or a saccade has ended */
void noh_face_glance(noh_face *face, const noh_face_desc *desc);
void noh_face_glance_schedule(noh_face *face);
void noh_face_look_aside(noh_face *face, const noh_face_desc *desc, int aside); /* or back, if it is not so already */
void noh_face_tremor(noh_face *face);
void noh_face_head_follow(noh_face *face, const noh_face_desc *desc);
uint32_t noh_face_latency(const noh_face *face);
float noh_face_angle(const float a[3], const float b[3]); /* angle between two gazes, radians */

uint32_t noh_face_breath_ticks(const noh_face *face, uint32_t breath);

/* ---- the head ---- */

void noh_face_head_rotation(const noh_face *face, float angles[3], float rotation[4]);
/* Get how far breath and small motions of the body move the head, neck space. */
void noh_face_drift(const noh_face *face, const noh_face_desc *desc, float moved[3]);
/* Get rotation and drift of the head, `ago` ticks before the face's clock. */
void noh_face_whole(const noh_face *face, const noh_face_desc *desc, uint32_t ago, float rotation[4], float moved[3]);
/* Get the midpoint of the eyes, neck space. */
void noh_face_middle(const noh_face_desc *desc, const float rotation[4], float middle[3]);

/* The desc's value, or the default where it is 0. */
static inline float noh_face_or(float value, float other)
{
    return value > 0.0f ? value : other;
}

static inline float noh_face_seconds(uint32_t ticks)
{
    return (float)ticks / NOH_FACE_TICKS_PER_S;
}

static inline uint32_t noh_face_ticks(float seconds)
{
    return (uint32_t)(seconds * NOH_FACE_TICKS_PER_S + 0.5f);
}

#ifdef __cplusplus
}
#endif

#endif
