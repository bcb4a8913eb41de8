/* clip_set_fixture.h: a set of clips that are formulas, for the tests of anim/, graph/ and character/. Include it after
 * cmocka.h. */
#ifndef NOH_TESTS_SUPPORT_CLIP_SET_FIXTURE_H
#define NOH_TESTS_SUPPORT_CLIP_SET_FIXTURE_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

#define ALIGNED __attribute__((aligned(16)))
#define JOINTS 24u
#define FLOATS 5u
#define CLIPS 6u
#define MASKS 2u
#define TWO_PI 6.283185307179586

enum { WALK, RUN, WAVE, LEAN, JUMP, POSE };

typedef struct scene {
    noh_clip_set set;
    noh_clip_entry clips[CLIPS];
    noh_event_key events[8];
    noh_marker markers[4];
    noh_transform bind[JOINTS];
    uint16_t parents[JOINTS];
    noh_skeleton skeleton;
    float defaults[FLOATS];
    uint8_t masks[MASKS][JOINTS + FLOATS]; /* 0: the upper half, 1: joint j has 10 * j */
    noh_root_track roots[CLIPS];
    uint32_t samples; /* calls of sample */
} scene;

static inline void scene_joint(uint32_t clip, double s, uint32_t joint, noh_transform *out)
{
    float v[3];
    for (uint32_t k = 0; k < 3; k++) {
        v[k] = (float)(0.6 * sin(TWO_PI * s * (1.0 + joint % 3u) + clip * 1.3 + k * 0.7 + joint));
        out->translation[k] = (float)(0.1 * joint + 0.02 * cos(TWO_PI * s + clip + k));
        out->scale[k] = (float)(1.0 + 0.05 * sin(TWO_PI * s + clip * 0.5 + joint * 0.3 + k));
    }
    noh_quat_from_rotation(v, out->rotation);
    if (joint == 0) {
        out->translation[2] = (float)(1.3 * s); /* walks along z */
    }
}

static inline void scene_sample(void *user, uint32_t clip, uint32_t tick, uint32_t joints, noh_transform *pose,
                                uint32_t floats, float *values)
{
    scene *s = user;
    uint32_t duration = s->clips[clip].duration_ticks;
    double t = duration ? (double)tick / (double)duration : 0.0;
    assert_true(tick <= duration);
    s->samples++;
    for (uint32_t j = 0; j < joints; j++) scene_joint(clip, t, j, &pose[j]);
    for (uint32_t i = 0; i < floats; i++) values[i] = (float)(0.5 + 0.4 * sin(TWO_PI * t + clip + i));
}

static inline void scene_open(scene *s)
{
    static const uint32_t durations[CLIPS] = { 48000, 30000, 24000, 96000, 36000, 0 };
    static const uint32_t loops[CLIPS] = { NOH_LOOP_REPEAT, NOH_LOOP_REPEAT, NOH_LOOP_PING_PONG,
                                           NOH_LOOP_REPEAT, NOH_LOOP_ONCE,   NOH_LOOP_ONCE };
    memset(s, 0, sizeof *s);
    for (uint32_t m = 0; m < CLIPS; m++) {
        s->clips[m].name_hash = 100u + m;
        s->clips[m].duration_ticks = durations[m];
        s->clips[m].loop = loops[m];
    }
    for (uint32_t i = 0; i < 4; i++) { /* steps: id 0 left, 1 right; run begins with the right foot */
        s->clips[i / 2u].first_marker = i / 2u * 2u;
        s->clips[i / 2u].marker_count = 2;
        s->markers[i].id = i == 1 || i == 2;
        s->markers[i].tick = i / 2u ? (i % 2u ? 18000u : 2000u) : (i % 2u ? 25000u : 1000u);
    }
    for (uint32_t j = 0; j < JOINTS; j++) {
        s->parents[j] = (uint16_t)(j ? (j - 1u) / 2u : NOH_JOINT_ROOT);
        s->bind[j].rotation[3] = 1.0f;
        s->bind[j].translation[1] = j ? 0.25f : 0.0f;
        for (int k = 0; k < 3; k++) s->bind[j].scale[k] = 1.0f;
        s->masks[0][j] = j >= JOINTS / 2u ? 255 : 0;
        s->masks[1][j] = (uint8_t)(10u * j);
    }
    for (uint32_t i = 0; i < FLOATS; i++) {
        s->defaults[i] = 0.125f * (float)i;
        s->masks[0][JOINTS + i] = i >= 2 ? 255 : 0;
        s->masks[1][JOINTS + i] = 128;
    }
    s->skeleton.joint_count = JOINTS;
    s->skeleton.parents = s->parents;
    s->skeleton.bind_pose = s->bind;
    s->set.clip_count = CLIPS;
    s->set.joint_count = JOINTS;
    s->set.float_count = FLOATS;
    s->set.mask_count = MASKS;
    s->set.marker_count = 4;
    s->set.event_count = 8;
    s->set.clips = s->clips;
    s->set.events = s->events;
    s->set.markers = s->markers;
    s->set.bind_pose = s->bind;
    s->set.float_defaults = s->defaults;
    s->set.masks = s->masks[0];
    s->set.sample = scene_sample;
    s->set.user = s;
    assert_int_equal(noh_clip_set_check(&s->set, NULL), NOH_OK);
}

/* The largest difference of two poses: of rotations as angles, q and -q alike. */
static inline double pose_apart(const noh_transform *a, const noh_transform *b, uint32_t count)
{
    double worst = 0.0;
    for (uint32_t j = 0; j < count; j++) {
        float inverse[4], q[4], v[3];
        noh_quat_conjugate(b[j].rotation, inverse);
        noh_quat_mul(a[j].rotation, inverse, q);
        noh_quat_to_rotation(q, v);
        worst = fmax(worst, sqrt((double)v[0] * v[0] + (double)v[1] * v[1] + (double)v[2] * v[2]));
        for (int k = 0; k < 3; k++) {
            worst = fmax(worst, fabs((double)a[j].translation[k] - b[j].translation[k]));
            worst = fmax(worst, fabs((double)a[j].scale[k] - b[j].scale[k]));
        }
    }
    return worst;
}

static inline double floats_apart(const float *a, const float *b, uint32_t count)
{
    double worst = 0.0;
    for (uint32_t i = 0; i < count; i++) worst = fmax(worst, fabs((double)a[i] - b[i]));
    return worst;
}

/* The pose that one model_clips has, as sampled. */
static inline void scene_pose(scene *s, uint32_t clip, uint32_t tick, noh_transform *pose, float *floats)
{
    scene_sample(s, clip, tick, JOINTS, pose, FLOATS, floats);
}

static inline noh_track_desc track_of(uint32_t clip, float weight)
{
    noh_track_desc d;
    memset(&d, 0, sizeof d);
    d.clip = clip;
    d.weight = weight;
    return d;
}

#endif
