#include "rest_fit.h"

#include <stdlib.h>
#include <string.h>

#include "convert/base/quat.h"
#include "convert/clips/raw_set.h"
#include "convert/model/affine.h"
#include "convert/model/model_build.h"

typedef struct fitting {
    const raw_skeleton *from, *to;
    const uint32_t *counterpart;
    double *from_rest, *to_rest, *from_now, *to_now; /* [joints][4] in the world */
    double *from_pose, *to_pose;                     /* [joints][12] */
    double unit;                                     /* of `from` per unit of `to` */
    uint32_t top;                                    /* joint of `to` whose position follows; MODEL_NONE: none */
    double share, from_top[3], to_top[3];            /* of its height; where it rests, in the unit of `from` */
} fitting;

static void conjugate(const double *q, double *out)
{
    for (int i = 0; i < 4; i++) out[i] = i < 3 ? -q[i] : q[i];
}

/* rotations NULL: at rest */
static void world_turns(const raw_skeleton *s, const float *rotations, double *out)
{
    for (uint32_t j = 0; j < s->joint_count; j++) {
        const float *given = rotations ? rotations + 4u * (size_t)j : s->joints[j].rotation;
        const uint32_t parent = s->joints[j].parent;
        double local[4];
        for (int i = 0; i < 4; i++) local[i] = (double)given[i];
        (void)quat_normalize(local);
        if (parent == MODEL_NONE)
            memcpy(out + 4u * (size_t)j, local, sizeof local);
        else
            quat_multiply(out + 4u * (size_t)parent, local, out + 4u * (size_t)j);
    }
}

static void turn_joint(fitting *f, uint32_t j, float *out)
{
    const raw_joint *joint = &f->to->joints[j];
    const uint32_t other = f->counterpart[j];
    double back[4], turned[4], local[4], *now = f->to_now + 4u * (size_t)j;
    for (int i = 0; i < 4; i++) local[i] = (double)joint->rotation[i];
    (void)quat_normalize(local);
    if (other != MODEL_NONE) {
        conjugate(f->from_rest + 4u * (size_t)other, back);
        quat_multiply(f->from_now + 4u * (size_t)other, back, turned);
        quat_multiply(turned, f->to_rest + 4u * (size_t)j, now);
        if (joint->parent == MODEL_NONE) {
            memcpy(local, now, sizeof local);
        } else {
            conjugate(f->to_now + 4u * (size_t)joint->parent, back);
            quat_multiply(back, now, local);
        }
    } else if (joint->parent == MODEL_NONE) {
        memcpy(now, local, sizeof local);
    } else {
        quat_multiply(f->to_now + 4u * (size_t)joint->parent, local, now);
    }
    (void)quat_normalize(local);
    for (int i = 0; i < 4; i++) out[i] = (float)local[i];
}

/* Below its parent, which rests. */
static void place_top(const fitting *f, float *out)
{
    const uint32_t parent = f->to->joints[f->top].parent;
    const double *at = f->from_pose + 12u * (size_t)f->counterpart[f->top] + 9;
    double up[16], back[16];
    affine_identity(up);
    for (int i = 0; i < 12 && parent != MODEL_NONE; i++) {
        up[i / 3 * 4 + i % 3] = f->to_pose[12u * (size_t)parent + (size_t)i] * (i < 9 ? 1.0 : f->unit);
    }
    if (affine_invert(up, back)) return;
    for (int r = 0; r < 3; r++) {
        double sum = back[12 + r];
        for (int c = 0; c < 3; c++) sum += back[c * 4 + r] * (f->to_top[c] + (at[c] - f->from_top[c]) * f->share);
        out[r] = (float)sum;
    }
}

static void fit_frame(fitting *f, const raw_clip *clip, uint32_t frame, raw_clip *out)
{
    const size_t first = (size_t)frame * out->joint_count;
    world_turns(f->from, clip->rotations + 4u * (size_t)frame * clip->joint_count, f->from_now);
    raw_pose_object(f->from, clip, frame, f->from_pose);
    for (uint32_t j = 0; j < f->to->joint_count; j++) {
        const raw_joint *joint = &f->to->joints[j];
        float *t = out->translations + 3u * (first + j);
        turn_joint(f, j, out->rotations + 4u * (first + j));
        for (int i = 0; i < 3; i++) t[i] = (float)((double)joint->translation[i] * f->unit);
        memcpy(out->scales + 3u * (first + j), joint->scale, sizeof joint->scale);
        if (j == f->top) place_top(f, t);
    }
}

static int open_fitting(fitting *f)
{
    const size_t theirs = f->from->joint_count, ours = f->to->joint_count;
    f->from_rest = model_zeros(theirs * 4u, sizeof(double));
    f->from_now = model_zeros(theirs * 4u, sizeof(double));
    f->to_rest = model_zeros(ours * 4u, sizeof(double));
    f->to_now = model_zeros(ours * 4u, sizeof(double));
    f->from_pose = model_zeros(theirs * 12u, sizeof(double));
    f->to_pose = model_zeros(ours * 12u, sizeof(double));
    if (!f->from_rest || !f->from_now || !f->to_rest || !f->to_now || !f->from_pose || !f->to_pose) return 1;
    world_turns(f->from, NULL, f->from_rest);
    world_turns(f->to, NULL, f->to_rest);
    raw_pose_object(f->from, NULL, 0, f->from_pose);
    raw_pose_object(f->to, NULL, 0, f->to_pose);
    f->unit = f->to->unit_cm / f->from->unit_cm;
    f->top = 0;
    while (f->top < f->to->joint_count && f->counterpart[f->top] == MODEL_NONE) f->top++;
    if (f->top < f->to->joint_count) {
        memcpy(f->from_top, f->from_pose + 12u * (size_t)f->counterpart[f->top] + 9, sizeof f->from_top);
        for (int i = 0; i < 3; i++) f->to_top[i] = f->to_pose[12u * (size_t)f->top + 9 + (size_t)i] * f->unit;
        f->share = f->from_top[1] > 1e-6 && f->to_top[1] > 0.0 ? f->to_top[1] / f->from_top[1] : 1.0;
    }
    return 0;
}

int rest_fit_clip(const raw_skeleton *from, const raw_skeleton *to, const uint32_t *counterpart, const raw_clip *clip,
                  raw_clip *out)
{
    fitting f;
    int failed;
    memset(&f, 0, sizeof f);
    f.from = from;
    f.to = to;
    f.counterpart = counterpart;
    failed = open_fitting(&f);
    for (uint32_t frame = 0; !failed && frame < clip->frame_count; frame++) fit_frame(&f, clip, frame, out);
    free(f.from_rest);
    free(f.from_now);
    free(f.to_rest);
    free(f.to_now);
    free(f.from_pose);
    free(f.to_pose);
    return failed;
}
