/* face.h: what makes a face alive: blinks, gaze, emotions, breath, small motions of the head.
 *
 *   noh_face_init          a face by seed: at rest, looking ahead
 *   noh_face_step          time moves on; noh_face_skip: unseen
 *   noh_face_look_at       turn the eyes, and the head where the eyes do not reach, to a point; noh_face_follow: keep
 *                          them on it
 *   noh_face_feel          an emotion comes, holds and goes
 *   noh_face_set_activity  resting, talking or reading: how often it blinks, how long it looks at what it looks at
 *   noh_face_phrase_end    a phrase ends: people often blink then
 *   noh_face_blink         now
 *   noh_face_pose_of       what shows
 *
 * A face is 256 bytes without pointers: a copy of it is a face. Everything follows from the seed, the calls and the
 * clock in whole ticks: the same bits on every processor, however time is cut into steps.
 *
 * Space     that of the neck: x to the face's left, y up, z ahead, the origin in the joint that turns the head. Metres,
 *           radians. Positive yaw turns to the left, positive pitch up.
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

/* "joy", "sadness" and so on; NOH_EMOTION_COUNT: none of them. NULL past the last. */
noh_emotion noh_emotion_of_name(const char *name);
const char *noh_emotion_name(noh_emotion emotion);

typedef enum noh_activity {
    NOH_ACTIVITY_REST = 0,
    NOH_ACTIVITY_TALK,
    NOH_ACTIVITY_READ,
    NOH_ACTIVITY_COUNT
} noh_activity;

#define NOH_FACE_CALM 1u     /* nothing moves by itself: no blinks, breath, wandering gaze or idle head */
#define NOH_FACE_NO_BLINK 2u /* none of these by itself; calls still do them */
#define NOH_FACE_NO_WANDER 4u
#define NOH_FACE_NO_BREATH 8u
#define NOH_FACE_NO_IDLE 16u
#define NOH_FACE_FOUR \
    32u /* Granberg's controller of four channels: one blink at even intervals, one emotion after \
         * another by itself, two mouth shapes (noh_face_four); gaze, breath and head as ever */
#define NOH_FACE_FLAGS 63u

/* What faces of one kind have in common. Zero is a good value for all but `eyes`. */
typedef struct noh_face_desc {
    float eyes[2][3];                            /* centres of the left and the right eye, neck space; required */
    float blinks_per_minute[NOH_ACTIVITY_COUNT]; /* default (0) 17, 26, 4.5 */
    float double_blinks;                         /* share of blinks followed by another; 0..0.5; default (0) 0.02 */
    float breaths_per_minute;                    /* default (0) 15 */
    float yaw_max, up_max, down_max;             /* of an eye in its socket; default (0) 35, 25 and 30 degrees */
    float head_yaw_max, head_pitch_max;          /* default (0) 75 and 40 degrees */
    float head_from;                             /* eyes turned further than this take the head along; default (0) 17.5
                                                  * degrees */
    float idle_rad;                              /* of the head's own small motions; default (0) 0.8 degrees */
} noh_face_desc;

typedef struct noh_face_spring {
    float from, speed, goal, omega;
    uint32_t start; /* tick, modulo 2^32 */
} noh_face_spring;

typedef struct noh_face_feeling {
    noh_face_spring amount;
    uint32_t end; /* tick at which it begins to go, modulo 2^32 */
    float fade_omega;
    uint8_t emotion, on, holds, reserved;
} noh_face_feeling;

/* Its fields are private; the type is complete so that it can be kept in an array. */
typedef struct noh_face {
    int64_t clock;
    uint32_t seed;
    uint32_t blinks, breaths, glances, tremors; /* counts: what the next random numbers are drawn by */
    uint32_t next_blink, blink_start;           /* ticks modulo 2^32, as all below */
    uint32_t breath_start, next_glance, next_tremor;
    uint32_t gaze_start, gaze_ticks; /* of a saccade, or until it begins */
    float from[3];                   /* yaw, pitch and 1 / distance that a saccade begins at */
    float target[3];                 /* point, neck space */
    float away[2];                   /* yaw and pitch by which the gaze is off its target */
    float tremor[2];
    noh_face_spring head[2]; /* yaw, pitch */
    noh_face_feeling feelings[NOH_FACE_EMOTIONS_MAX];
    uint8_t activity, flags, gaze, blinking;
    uint32_t moods; /* emotions that have come by themselves */
} noh_face;

/* What shows in one frame. */
typedef struct noh_face_pose {
    float head[4];                     /* rotation of the head in the neck, quaternion */
    float head_angles[3];              /* the same as yaw, pitch and roll */
    float eyes[2][2];                  /* yaw and pitch of the left and the right eye in the head */
    float blink;                       /* 0 open .. 1 shut */
    float lids_down, lids_up;          /* 0..1: how far the lids follow a look down and up */
    float breath;                      /* 0 out .. 1 in */
    float emotions[NOH_EMOTION_COUNT]; /* 0..1 */
} noh_face_pose;

/* flags    NOH_FACE_*
 * errors   ARG a field of the desc is negative, too large or not finite, or the eyes are in one place (where: its
 *          index among the desc's floats) */
noh_result noh_face_init(noh_face *face, const noh_face_desc *desc, uint32_t seed, uint32_t flags, noh_error *error);

void noh_face_set_flags(noh_face *face, const noh_face_desc *desc, uint32_t flags);

/* Move time on. Whatever falls due within the step happens at its own tick. */
void noh_face_step(noh_face *face, const noh_face_desc *desc, uint32_t ticks);

/* Time passes that nothing is seen of: it is still at rest, looks at what it looked at, feels what it felt, and blinks,
 * breathes and glances at other times than it would have. Costs the same however long it is. */
void noh_face_skip(noh_face *face, const noh_face_desc *desc, int64_t ticks);

/* Look at a point from now on. A point nearby is followed; one further off is reached by a saccade, after the time that
 * people take to see it.
 * point   neck space, metres; NULL: ahead, at 2 m
 * errors  ARG not finite, or nearer than 5 cm to the middle of the eyes */
noh_result noh_face_look_at(noh_face *face, const noh_face_desc *desc, const float point[3], noh_error *error);

/* The point that it looks at has moved, or the neck has: the eyes stay on it, without a saccade, as those of people do
 * whose head is turned.
 * errors  as noh_face_look_at */
noh_result noh_face_follow(noh_face *face, const noh_face_desc *desc, const float point[3], noh_error *error);

/* Begin an emotion, or change one that shows. In the mode of four channels it takes the place of the one that shows,
 * and comes and goes in a second each; hold_ticks 0: for as long as others.
 * ranges  amount 0..1; hold_ticks 0: until it is changed; below 2^31. onset_ticks, fade_ticks: to 95 %; 0: 0.35 and
 *         0.8 s. A micro-expression is held for 0.04 to 0.2 s, with an onset as short
 * errors  ARG */
noh_result noh_face_feel(noh_face *face, noh_emotion emotion, float amount, uint32_t onset_ticks, uint32_t hold_ticks,
                         uint32_t fade_ticks, noh_error *error);

void noh_face_set_activity(noh_face *face, const noh_face_desc *desc, noh_activity activity);

/* Shut the eyes now. It takes the place of the blink that would have come next, so that their rate is kept. */
void noh_face_blink(noh_face *face, const noh_face_desc *desc);

/* The same, half of the times. */
void noh_face_phrase_end(noh_face *face, const noh_face_desc *desc);

void noh_face_pose_of(const noh_face *face, const noh_face_desc *desc, noh_face_pose *pose);

/* noh_face_pose.breath alone. */
float noh_face_breath(const noh_face *face, const noh_face_desc *desc);

/* The four channels of a frame, for a shader that has no more: one blink, the strongest emotion, the two strongest
 * mouth shapes, which are at most 1 together. */
typedef struct noh_face_four {
    float weights[4];  /* blink, emotion, first and second mouth shape */
    uint8_t emotion;   /* noh_emotion; NOH_EMOTION_COUNT: none */
    uint8_t speech[2]; /* noh_viseme (recipe.h); 0: none */
    uint8_t reserved;
} noh_face_four;

/* pose  NULL: at rest. visemes[15], as noh_face_channels takes them; NULL: says nothing */
void noh_face_four_of(const noh_face_pose *pose, const float *visemes, noh_face_four *four);

/* The mouth shapes back: visemes[15], of which two at most are not 0. */
void noh_face_four_visemes(const noh_face_four *four, float *visemes);

#ifdef __cplusplus
}
#endif

#endif
