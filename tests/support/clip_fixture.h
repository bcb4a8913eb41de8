/* clip_fixture.h: clips made in code, encoded and opened, for the clip tests. */
#ifndef TESTS_CLIP_FIXTURE_H
#define TESTS_CLIP_FIXTURE_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"
#include "convert/codec/clip_encode.h"
#include "convert/clips/raw_set.h"

typedef struct fixture {
    raw_set *set;
    byte_buffer blob;
    clip_report report;
    noh_transform *bind;
    void *clip_memory, *cache_memory;
    noh_clip *clip;
    noh_clip_cache *cache;
    uint32_t sample_rate_uhz; /* of the clip */
} fixture;

/* ---- raw clips ---- */

typedef struct fixture_rng {
    uint32_t state;
} fixture_rng;

static inline double fixture_random(fixture_rng *r)
{
    r->state = r->state * 1664525u + 1013904223u;
    return (double)(r->state >> 8) / 16777216.0;
}

static inline void fixture_axis_angle(float q[4], double x, double y, double z, double angle)
{
    const double n = sqrt(x * x + y * y + z * z), s = sin(angle / 2.0) / (n > 0.0 ? n : 1.0);
    q[0] = (float)(x * s);
    q[1] = (float)(y * s);
    q[2] = (float)(z * s);
    q[3] = (float)cos(angle / 2.0);
}

static inline float *fixture_rotation(raw_clip *c, uint32_t frame, uint32_t joint)
{
    return c->rotations + ((size_t)frame * c->joint_count + joint) * 4u;
}
static inline float *fixture_translation(raw_clip *c, uint32_t frame, uint32_t joint)
{
    return c->translations + ((size_t)frame * c->joint_count + joint) * 3u;
}
static inline float *fixture_scale(raw_clip *c, uint32_t frame, uint32_t joint)
{
    return c->scales + ((size_t)frame * c->joint_count + joint) * 3u;
}

/* A chain or tree (branch > 1) of joints `bone` apart that stays in its bind pose. */
static inline raw_set *fixture_still(uint32_t joints, uint32_t frames, uint32_t branch, float bone,
                                     double sample_rate_hz)
{
    raw_set *set = raw_set_new(joints, 1);
    raw_clip *c;
    if (!set) return NULL;
    c = &set->clips[0];
    set->skeleton.unit_cm = 1.0;
    c->sample_rate_hz = sample_rate_hz;
    if (raw_clip_alloc(c, frames, joints)) return NULL;
    for (uint32_t j = 0; j < joints; j++) {
        raw_joint *r = &set->skeleton.joints[j];
        r->parent = j ? (j - 1u) / branch : MODEL_NONE;
        fixture_axis_angle(r->rotation, 1, 0, 0, 0);
        r->translation[1] = j ? bone : 0.0f;
        r->scale[0] = r->scale[1] = r->scale[2] = 1.0f;
        for (uint32_t f = 0; f < frames; f++) {
            memcpy(fixture_rotation(c, f, j), r->rotation, sizeof r->rotation);
            memcpy(fixture_translation(c, f, j), r->translation, sizeof r->translation);
            memcpy(fixture_scale(c, f, j), r->scale, sizeof r->scale);
        }
    }
    return set;
}

/* Every joint swings about an axis of its own, `swing` radians wide; joint 0 walks. */
static inline raw_set *fixture_swing(uint32_t joints, uint32_t frames, uint32_t branch, float bone, double swing,
                                     double walk)
{
    raw_set *set = fixture_still(joints, frames, branch, bone, 30.0);
    fixture_rng r = { 7 };
    for (uint32_t j = 0; set && j < joints; j++) {
        const double x = fixture_random(&r) - 0.5, y = fixture_random(&r) - 0.5, z = fixture_random(&r) - 0.5,
                     phase = 6.0 * fixture_random(&r);
        const double speed = 0.05 + 0.15 * fixture_random(&r);
        for (uint32_t f = 0; f < frames; f++) {
            raw_clip *c = &set->clips[0];
            fixture_axis_angle(fixture_rotation(c, f, j), x, y, z,
                               swing * sin(speed * (double)f + phase) + 0.2 * swing * sin(3.1 * speed * (double)f));
            if (j == 0) {
                fixture_translation(c, f, 0)[0] += (float)(walk * (double)f);
                fixture_translation(c, f, 0)[1] += (float)(0.03 * walk * sin(0.7 * (double)f));
            }
        }
    }
    return set;
}

/* Every rotation of a clip jitters as captured motion does. */
static inline void fixture_shake(raw_clip *c, double radians)
{
    fixture_rng r = { 11 };
    for (uint32_t i = 0; i < c->frame_count * c->joint_count; i++) {
        float *q = fixture_rotation(c, i / c->joint_count, i % c->joint_count);
        double square = 0.0;
        for (int k = 0; k < 3; k++) q[k] += (float)(radians * (fixture_random(&r) - 0.5));
        for (int k = 0; k < 4; k++) square += (double)q[k] * (double)q[k];
        for (int k = 0; k < 4; k++) q[k] = (float)((double)q[k] / sqrt(square));
    }
}

/* Every n-th frame. */
static inline void fixture_decimate(raw_clip *c, uint32_t n)
{
    const uint32_t count = (c->frame_count - 1u) / n + 1u;
    for (uint32_t f = 1; f < count; f++) {
        memmove(fixture_rotation(c, f, 0), fixture_rotation(c, f * n, 0), c->joint_count * 4u * sizeof(float));
        memmove(fixture_translation(c, f, 0), fixture_translation(c, f * n, 0), c->joint_count * 3u * sizeof(float));
        memmove(fixture_scale(c, f, 0), fixture_scale(c, f * n, 0), c->joint_count * 3u * sizeof(float));
    }
    c->frame_count = count;
    c->sample_rate_hz /= n;
}

/* ---- encoded and opened ---- */

/* Open fixture->blob with its bind pose. NULL on success, else what failed. */
static inline const char *fixture_open(fixture *x, uint32_t slots)
{
    const raw_skeleton *s = &x->set->skeleton;
    const uint32_t joints = x->set->clips[0].joint_count;
    const noh_clip *clips[1];
    noh_clip_cache_desc cache;
    noh_clip_info info;
    noh_clip_desc desc;
    noh_error error;
    size_t size;
    x->bind = calloc(joints ? joints : 1u, sizeof *x->bind);
    for (uint32_t j = 0; j < joints; j++) {
        memcpy(x->bind[j].rotation, s->joints[j].rotation, sizeof x->bind[j].rotation);
        memcpy(x->bind[j].translation, s->joints[j].translation, sizeof x->bind[j].translation);
        memcpy(x->bind[j].scale, s->joints[j].scale, sizeof x->bind[j].scale);
    }
    memset(&desc, 0, sizeof desc);
    desc.bytes = x->blob.bytes;
    desc.byte_count = x->blob.count;
    desc.bind = x->bind;
    desc.joint_count = joints;
    size = noh_clip_size(&desc, &error);
    if (!size) return error.what;
    x->clip_memory = malloc(size);
    if (noh_clip_init(x->clip_memory, size, &desc, &x->clip, &error) != NOH_OK) return error.what;
    noh_clip_info_of(x->clip, &info);
    x->sample_rate_uhz = info.sample_rate_uhz;
    clips[0] = x->clip;
    memset(&cache, 0, sizeof cache);
    cache.clips = clips;
    cache.clip_count = 1;
    cache.cached_segment_count = slots;
    size = noh_clip_cache_size(&cache, &error);
    if (!size) return error.what;
    x->cache_memory = malloc(size);
    return noh_clip_cache_init(x->cache_memory, size, &cache, &x->cache, &error) == NOH_OK ? NULL : error.what;
}

/* Encode set's first clip and open it; takes the set. NULL on success. */
static inline const char *fixture_build(fixture *x, raw_set *set, const clip_options *options, uint32_t slots)
{
    static model_error error;
    memset(x, 0, sizeof *x);
    x->set = set;
    if (!set) return "no set";
    if (clip_encode(&set->skeleton, &set->clips[0], options, &x->blob, &x->report, &error)) return error.what;
    return fixture_open(x, slots);
}

static inline void fixture_free(fixture *x)
{
    raw_set_free(x->set);
    buffer_free(&x->blob);
    free(x->bind);
    free(x->clip_memory);
    free(x->cache_memory);
    memset(x, 0, sizeof *x);
}

#endif
