/* face.h: involuntary motion of a face: blinks, gaze, emotions, breath, small motions of the head.
 *
 *   noh_face_init          make a face from a seed: at rest, looking ahead
 *   noh_face_step          advance time; noh_face_skip: time while it is not visible
 *   noh_face_look_at       turn the eyes to a point, and the head if the eyes do not reach; noh_face_follow: track it
 *   noh_face_set_emotion   start an emotion, which rises, holds and fades
 *   noh_face_set_activity  resting, talking or reading: sets the blink rate and how long the gaze rests on a point
 *   noh_face_phrase_end    a phrase ends: people often blink then
 *   noh_face_blink         blink now
 *   noh_face_pose_of       the visible pose
 *
 * A face is 256 bytes without pointers: copy it to clone it. It depends only on the seed, the calls and the clock in
 * whole ticks: the same bits on every processor, however time is split into steps.
 *
 * Space     neck space: x to the face's left, y up, z ahead, the origin at the joint that turns the head. Metres,
 * radians.
 *           Positive yaw turns to the left, positive pitch up.
 * Time      ticks of 1/48,000 s (NOH_TICKS_PER_SECOND).
 * Threads   a face belongs to one thread at a time; a desc may be shared. */
#ifndef NOH_FACE_FACE_H
#define NOH_FACE_FACE_H

#include <stdint.h>

#include "core/base/limits.h"
#include "core/base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum noh_emotion {
    NOH_EMOTION_JOY = 0,
    NOH_EMOTION_SADNESS,
    NOH_EMOTION_SURPRISE,
    NOH_EMOTION_FEAR,
    NOH_EMOTION_ANGER,
    NOH_EMOTION_DISGUST,
    NOH_EMOTION_CONTEMPT,
    NOH_EMOTION_COUNT
} noh_emotion;

/* Convert between an emotion and its name, "joy", "sadness" and so on. Unknown names give NOH_EMOTION_COUNT; emotions
 * past the last give NULL. */
noh_emotion noh_emotion_of_name(const char *name);
const char *noh_emotion_name(noh_emotion emotion);

typedef enum noh_activity {
    NOH_ACTIVITY_REST = 0,
    NOH_ACTIVITY_TALK,
    NOH_ACTIVITY_READ,
    NOH_ACTIVITY_COUNT
} noh_activity;

#define NOH_FACE_CALM 1u     /* nothing moves by itself: no blinks, breath, wandering gaze or idle head */
#define NOH_FACE_NO_BLINK 2u /* no spontaneous blinks; calls still blink. The next flags likewise */
#define NOH_FACE_NO_WANDER 4u
#define NOH_FACE_NO_BREATH 8u
#define NOH_FACE_NO_IDLE 16u
/* Granberg's controller of four channels: one blink at even intervals, spontaneous emotions one at a time, two mouth
 * shapes (noh_face_four); gaze, breath and head are unchanged */
#define NOH_FACE_FOUR 32u
#define NOH_FACE_FLAGS 63u

/* Settings shared by faces of one kind. Zero is a good value for all but `eyes`. */
typedef struct noh_face_desc {
    float eyes[2][3];                            /* centres of the left and the right eye, neck space; required */
    float blinks_per_minute[NOH_ACTIVITY_COUNT]; /* default (0) 17, 26, 4.5 */
    /* share of blinks that are followed by another; 0..0.5; default (0) 0.02 */
    float double_blinks;
    float breaths_per_minute;           /* default (0) 15 */
    float yaw_max, up_max, down_max;    /* limits of an eye in its socket; default (0) 35, 25 and 30 degrees */
    float head_yaw_max, head_pitch_max; /* default (0) 75 and 40 degrees */
    /* eyes turned farther than this turn the head too; default (0) 17.5 degrees */
    float head_from;
    float idle_rad; /* small idle motions of the head; default (0) 0.8 degrees */
} noh_face_desc;

typedef struct noh_face_spring {
    float from, speed, goal, omega;
    uint32_t start; /* tick, modulo 2^32 */
} noh_face_spring;

typedef struct noh_face_emotion {
    noh_face_spring amount;
    uint32_t end; /* tick at which it begins to fade, modulo 2^32 */
    float fade_omega;
    uint8_t emotion, on, holds, reserved;
} noh_face_emotion;

/* Fields are private; the type is complete so that it can be stored in an array. */
typedef struct noh_face {
    int64_t clock;
    uint32_t seed;
    uint32_t blinks, breaths, glances, tremors; /* counts that select the next random numbers */
    uint32_t next_blink, blink_start;           /* ticks modulo 2^32, as all below */
    uint32_t breath_start, next_glance, next_tremor;
    uint32_t gaze_start, gaze_ticks; /* of a saccade, or until it begins */
    float from[3];                   /* yaw, pitch and 1 / distance at the start of a saccade */
    float target[3];                 /* point, neck space */
    float away[2];                   /* yaw and pitch from the target to the gaze */
    float tremor[2];
    noh_face_spring head[2]; /* yaw, pitch */
    noh_face_emotion emotions[NOH_FACE_EMOTIONS_MAX];
    uint8_t activity, flags, gaze, blinking;
    uint32_t moods; /* number of spontaneous emotions so far */
} noh_face;

/* The visible state of a face in one frame. */
typedef struct noh_face_pose {
    float head[4];                     /* rotation of the head in the neck, quaternion */
    float head_angles[3];              /* the same rotation as yaw, pitch and roll */
    float eyes[2][2];                  /* yaw and pitch of the left and the right eye in the head */
    float blink;                       /* 0 open .. 1 closed */
    float lids_down, lids_up;          /* 0..1: how far the lids follow the eyes down and up */
    float breath;                      /* 0 exhaled .. 1 inhaled */
    float emotions[NOH_EMOTION_COUNT]; /* 0..1 */
} noh_face_pose;

/* Make a face at rest.
 * flags    NOH_FACE_*
 * errors   ARG a field of the desc is negative, too large or not finite, or the eyes are at the same point (where: the
 *          index among the desc's floats) */
noh_result noh_face_init(noh_face *face, const noh_face_desc *desc, uint32_t seed, uint32_t flags, noh_error *error);

void noh_face_set_flags(noh_face *face, const noh_face_desc *desc, uint32_t flags);

/* Advance time. Everything due within the step happens at its own tick. */
void noh_face_step(noh_face *face, const noh_face_desc *desc, uint32_t ticks);

/* Advance time while the face is not visible, at constant cost. It ends at rest, with the same gaze target and
 * emotions; blinks, breaths and glances come at other times than with noh_face_step. */
void noh_face_skip(noh_face *face, const noh_face_desc *desc, int64_t ticks);

/* Look at a point from now on. The eyes follow a nearby point; to a farther one they make a saccade, after the human
 * reaction time.
 * point   neck space, metres; NULL: ahead, at 2 m
 * errors  ARG not finite, or nearer than 5 cm to the midpoint of the eyes */
noh_result noh_face_look_at(noh_face *face, const noh_face_desc *desc, const float point[3], noh_error *error);

/* Update the gaze target after it or the neck moved. The eyes stay on it without a saccade, as when a person's head is
 * turned.
 * errors  as noh_face_look_at */
noh_result noh_face_follow(noh_face *face, const noh_face_desc *desc, const float point[3], noh_error *error);

/* Start an emotion, or change a visible one. With NOH_FACE_FOUR it replaces the present one, and rises and fades in one
 * second each; hold_ticks 0 holds it as long as spontaneous ones.
 * ranges  amount 0..1; hold_ticks below 2^31, 0: until it is changed. onset_ticks, fade_ticks: time to reach 95 %; 0:
 *         0.35 and 0.8 s. A micro-expression has a hold of 0.04 to 0.2 s and an equally short onset
 * errors  ARG */
noh_result noh_face_set_emotion(noh_face *face, noh_emotion emotion, float amount, uint32_t onset_ticks,
                                uint32_t hold_ticks, uint32_t fade_ticks, noh_error *error);

void noh_face_set_activity(noh_face *face, const noh_face_desc *desc, noh_activity activity);

/* Blink now. Replaces the next spontaneous blink, so that the blink rate stays the same. */
void noh_face_blink(noh_face *face, const noh_face_desc *desc);

/* Blink now with a probability of one half. */
void noh_face_phrase_end(noh_face *face, const noh_face_desc *desc);

void noh_face_pose_of(const noh_face *face, const noh_face_desc *desc, noh_face_pose *pose);

/* Compute noh_face_pose.breath alone. */
float noh_face_breath(const noh_face *face, const noh_face_desc *desc);

/* The four channels of a frame, for a shader that has only four: one blink, the strongest emotion, the two strongest
 * mouth shapes, with a sum of at most 1. */
typedef struct noh_face_four {
    float weights[4];  /* blink, emotion, first and second mouth shape */
    uint8_t emotion;   /* noh_emotion; NOH_EMOTION_COUNT: none */
    uint8_t speech[2]; /* noh_viseme (recipe.h); 0: none */
    uint8_t reserved;
} noh_face_four;

/* Reduce a pose and mouth shapes to four channels.
 * pose     NULL: at rest
 * visemes  [15], as for noh_face_channels; NULL: silent */
void noh_face_four_of(const noh_face_pose *pose, const float *visemes, noh_face_four *four);

/* Expand the mouth shapes: visemes[15], at most two of them not 0. */
void noh_face_four_visemes(const noh_face_four *four, float *visemes);

#ifdef __cplusplus
}
#endif

#endif
