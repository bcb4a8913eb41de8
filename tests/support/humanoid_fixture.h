/* humanoid_fixture.h: figures of 22 bones and three fingers a hand, of any proportions, axes of joints and arms at rest. */
#ifndef NOH_TESTS_SUPPORT_HUMANOID_FIXTURE_H
#define NOH_TESTS_SUPPORT_HUMANOID_FIXTURE_H

#include <math.h>
#include <string.h>

#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"
#include "support/support.h"

#define HUMANOID_JOINTS 40u

typedef struct humanoid {
    uint16_t parents[HUMANOID_JOINTS];
    noh_transform bind[HUMANOID_JOINTS];
    float model[HUMANOID_JOINTS][3]; /* positions at rest */
    noh_skeleton skeleton;
    noh_retarget_rig rig;
} humanoid;

typedef struct humanoid_form {
    float unit;                          /* 1: metres */
    float thigh, shin, arm, width, foot; /* shares of the usual lengths; 0: 1 */
    float arms_down;                     /* radians from a T */
    float twist;                         /* of forearms and hands, radians */
    float turned;                        /* about +y, radians */
    uint64_t axes;                       /* a seed of joints' axes; 0: the model's */
    int has_root, is_plain;              /* is_plain: no chest, neck and clavicles */
} humanoid_form;

static inline void humanoid_axis(float x, float y, float z, float radians, float q[4])
{
    const float s = sinf(0.5f * radians), size = sqrtf(x * x + y * y + z * z);
    q[0] = x / size * s;
    q[1] = y / size * s;
    q[2] = z / size * s;
    q[3] = cosf(0.5f * radians);
}

static inline float humanoid_share(float share)
{
    return share > 0.0f ? share : 1.0f;
}

/* A joint of a bone at a place, with an axis of its own. Returns its index. */
static inline uint32_t humanoid_add(humanoid *h, const humanoid_form *form, uint32_t bone, uint32_t parent, float x,
                                    float y, float z, float rotations[][4])
{
    const uint32_t j = h->skeleton.joint_count++;
    float q[4], back[4], d[3], turn[4];
    humanoid_axis(0, 1, 0, form->turned, turn);
    h->parents[j] = (uint16_t)parent;
    h->model[j][0] = x * form->unit;
    h->model[j][1] = y * form->unit;
    h->model[j][2] = z * form->unit;
    noh_quat_rotate(turn, h->model[j], h->model[j]);
    if (form->axes) {
        test_random random = { form->axes * 977u + j * 131u };
        for (int i = 0; i < 4; i++) rotations[j][i] = test_random_float(&random, -1.0f, 1.0f);
        noh_quat_normalize(rotations[j]);
    } else {
        humanoid_axis(0, 1, 0, 0, rotations[j]);
    }
    memcpy(q, rotations[j], sizeof q);
    memcpy(d, h->model[j], sizeof d);
    if (parent != NOH_JOINT_ROOT) {
        noh_quat_conjugate(rotations[parent], back);
        noh_quat_mul(back, q, q);
        for (int i = 0; i < 3; i++) d[i] -= h->model[parent][i];
        noh_quat_rotate(back, d, d);
    }
    memcpy(h->bind[j].rotation, q, sizeof q);
    memcpy(h->bind[j].translation, d, sizeof d);
    for (int i = 0; i < 3; i++) h->bind[j].scale[i] = 1.0f;
    if (bone < NOH_BONES) h->rig.bones[bone] = (uint16_t)j;
    return j;
}

/* An arm: points of a T pose, lowered, and twisted about the forearm. */
static inline void humanoid_arm(humanoid *h, const humanoid_form *f, uint32_t chest, uint32_t side,
                                float rotations[][4])
{
    const float sign = side ? -1.0f : 1.0f, w = humanoid_share(f->width), a = humanoid_share(f->arm);
    const float shoulder = 0.18f * w, y = 1.4f;
    const float points[6][3] = { { 0.28f * a, 0, 0 }, { 0.53f * a, 0, 0 },          { 0.62f * a, 0, 0.03f },
                                 { 0.62f * a, 0, -0.03f }, { 0.56f * a, -0.01f, 0.03f }, { 0.60f * a, -0.02f, 0.05f } };
    static const uint32_t bones[6] = { NOH_BONE_LOWER_ARM, NOH_BONE_HAND,  NOH_BONE_INDEX,
                                       NOH_BONE_LITTLE,    NOH_BONE_THUMB, NOH_BONE_THUMB + 1 };
    uint32_t joints[6], up = chest;
    float down[4], twist[4];
    if (!f->is_plain) up = humanoid_add(h, f, NOH_BONE_SHOULDER + side, up, sign * 0.05f, 1.38f, 0, rotations);
    up = humanoid_add(h, f, NOH_BONE_UPPER_ARM + side, up, sign * shoulder, y, 0, rotations);
    humanoid_axis(0, 0, 1, -sign * f->arms_down, down);
    humanoid_axis(1, 0, 0.0f, sign * f->twist, twist);
    for (uint32_t i = 0; i < 6; i++) {
        static const uint32_t above[6] = { 0, 0, 1, 1, 1, 4 };
        float p[3] = { sign * points[i][0], points[i][1], points[i][2] };
        if (i > 1) noh_quat_rotate(twist, p, p);
        noh_quat_rotate(down, p, p);
        joints[i] = humanoid_add(h, f, bones[i] + side, i ? joints[above[i]] : up, p[0] + sign * shoulder, p[1] + y,
                                 p[2], rotations);
    }
}

static inline void humanoid_make(humanoid *h, const humanoid_form *f)
{
    float rotations[HUMANOID_JOINTS][4];
    const float thigh = 0.42f * humanoid_share(f->thigh), shin = 0.40f * humanoid_share(f->shin), ankle = 0.08f;
    const float hips_y = thigh + shin + ankle, w = 0.1f * humanoid_share(f->width), lift = hips_y - 0.9f;
    uint32_t at = NOH_JOINT_ROOT, hips;
    memset(h, 0, sizeof *h);
    for (uint32_t b = 0; b < NOH_BONES; b++) h->rig.bones[b] = NOH_JOINT_ROOT;
    if (f->has_root) at = humanoid_add(h, f, NOH_BONE_ROOT, at, 0, 0, 0, rotations);
    hips = humanoid_add(h, f, NOH_BONE_HIPS, at, 0, hips_y, 0, rotations);
    for (uint32_t side = 0; side <= NOH_BONE_RIGHT; side += NOH_BONE_RIGHT) {
        const float x = side ? -w : w;
        at = humanoid_add(h, f, NOH_BONE_UPPER_LEG + side, hips, x, hips_y, 0, rotations);
        at = humanoid_add(h, f, NOH_BONE_LOWER_LEG + side, at, x, hips_y - thigh, 0.01f, rotations);
        at = humanoid_add(h, f, NOH_BONE_FOOT + side, at, x, ankle, 0, rotations);
        humanoid_add(h, f, NOH_BONE_TOES + side, at, x, 0.02f, 0.15f * humanoid_share(f->foot), rotations);
    }
    at = humanoid_add(h, f, NOH_BONE_SPINE, hips, 0, 1.0f + lift, 0, rotations);
    if (!f->is_plain) at = humanoid_add(h, f, NOH_BONE_CHEST, at, 0, 1.2f + lift, 0, rotations);
    hips = at;
    if (!f->is_plain) at = humanoid_add(h, f, NOH_BONE_NECK, at, 0, 1.45f + lift, 0, rotations);
    humanoid_add(h, f, NOH_BONE_HEAD, at, 0, 1.55f + lift, 0, rotations);
    humanoid_arm(h, f, hips, 0, rotations);
    humanoid_arm(h, f, hips, NOH_BONE_RIGHT, rotations);
    h->skeleton.parents = h->parents;
    h->skeleton.bind_pose = h->bind;
    h->rig.skeleton = &h->skeleton;
}

/* Where a bone is in a pose. */
static inline void humanoid_place(const humanoid *h, const noh_transform *pose, uint32_t bone, float out[3])
{
    float matrices[HUMANOID_JOINTS * 12u];
    noh_local_to_model(&h->skeleton, pose, h->skeleton.joint_count, matrices);
    for (uint32_t i = 0; i < 3; i++) out[i] = matrices[12u * h->rig.bones[bone] + 4u * i + 3u];
}

#endif
