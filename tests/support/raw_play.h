/* raw_play.h: a raw clip as a set of one clip, its frames lerped: for tests that need real motion. */
#ifndef TESTS_RAW_PLAY_H
#define TESTS_RAW_PLAY_H

#include <stdlib.h>
#include <string.h>

#include "noh/clip.h"
#include "noh/low_motion.h"
#include "convert/clips/raw_set.h"
#include "convert/clips/rcl.h"

typedef struct raw_play {
    raw_set *raw;
    noh_clip_set set;
    noh_clip_entry clip;
    noh_skeleton skeleton;
    noh_transform *bind;
    uint16_t *parents;
} raw_play;

static inline void raw_play_frame(const raw_clip *c, uint32_t frame, uint32_t count, noh_transform *out)
{
    for (uint32_t j = 0; j < count; j++) {
        size_t at = (size_t)frame * c->joint_count + j;
        memcpy(out[j].rotation, c->rotations + 4 * at, sizeof out[j].rotation);
        memcpy(out[j].translation, c->translations + 3 * at, sizeof out[j].translation);
        memcpy(out[j].scale, c->scales + 3 * at, sizeof out[j].scale);
    }
}

static inline void raw_play_sample(void *user, uint32_t clip, uint32_t tick, uint32_t joints, noh_transform *pose,
                                   uint32_t floats, float *values)
{
    const raw_clip *c = &((raw_play *)user)->raw->clips[0];
    double at = (double)tick / 48000.0 * c->sample_rate_hz;
    uint32_t frame = (uint32_t)at, last = c->frame_count - 1u;
    noh_transform *next = malloc(joints * sizeof *next);
    (void)clip, (void)floats, (void)values;
    raw_play_frame(c, frame < last ? frame : last, joints, pose);
    raw_play_frame(c, frame + 1u < last ? frame + 1u : last, joints, next);
    noh_pose_mix(joints, pose, next, (float)(at - frame), NULL, pose);
    free(next);
}

/* 0 on success. */
static inline int raw_play_open(raw_play *p, const char *path, uint32_t loop)
{
    model_error error;
    memset(p, 0, sizeof *p);
    if (rcl_read(path, &p->raw, &error)) return 1;
    p->skeleton.joint_count = p->raw->skeleton.joint_count;
    p->bind = calloc(p->skeleton.joint_count, sizeof *p->bind);
    p->parents = calloc(p->skeleton.joint_count, sizeof *p->parents);
    for (uint32_t j = 0; j < p->skeleton.joint_count; j++) {
        const raw_joint *joint = &p->raw->skeleton.joints[j];
        memcpy(p->bind[j].rotation, joint->rotation, sizeof joint->rotation);
        memcpy(p->bind[j].translation, joint->translation, sizeof joint->translation);
        memcpy(p->bind[j].scale, joint->scale, sizeof joint->scale);
        p->parents[j] = joint->parent == MODEL_NONE ? NOH_JOINT_ROOT : (uint16_t)joint->parent;
    }
    p->skeleton.parents = p->parents;
    p->skeleton.bind_pose = p->bind;
    p->clip.duration_ticks = (uint32_t)(raw_clip_duration_s(&p->raw->clips[0]) * 48000.0);
    p->clip.loop = loop;
    p->set.clip_count = 1;
    p->set.joint_count = p->skeleton.joint_count;
    p->set.clips = &p->clip;
    p->set.bind_pose = p->bind;
    p->set.sample = raw_play_sample;
    p->set.user = p;
    return 0;
}

static inline void raw_play_close(raw_play *p)
{
    raw_set_free(p->raw);
    free(p->bind);
    free(p->parents);
}

#endif
