/* ragdoll_pose.c: converts between poses of a skeleton and bodies of a ragdoll. */
#include "core/base/trig_internal.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/vector_internal.h"
#include "life/physics/ragdoll_internal.h"

/* ---- joints ---- */

/* Transform a point and a rotation from a joint's space to its parent's. */
static void out_of_joint(const noh_transform *t, float point[3], float rotation[4])
{
    for (int i = 0; i < 3; i++) point[i] *= t->scale[i];
    noh_quat_rotate(t->rotation, point, point);
    noh_madd3(point, 1.0f, t->translation, point);
    noh_quat_mul(t->rotation, rotation, rotation);
}

/* Transform to model space. joint: NOH_JOINT_ROOT is model space itself */
static void out_of(const noh_skeleton *k, const noh_transform *local, uint32_t joint, float point[3], float rotation[4])
{
    for (; joint != NOH_JOINT_ROOT; joint = k->parents[joint]) out_of_joint(&local[joint], point, rotation);
    noh_quat_normalize(rotation);
}

/* Transform a point from model space to a joint's: from the root down, along the path to the joint. */
static void point_into(const noh_skeleton *k, const noh_transform *local, uint32_t joint, float point[3])
{
    uint32_t above = NOH_JOINT_ROOT;
    while (above != joint) {
        uint32_t next = joint;
        float back[4];
        while (k->parents[next] != above) next = k->parents[next];
        noh_sub3(point, local[next].translation, point);
        noh_quat_conjugate(local[next].rotation, back);
        noh_quat_rotate(back, point, point);
        for (int i = 0; i < 3; i++) {
            const float scale = local[next].scale[i];
            point[i] = scale != 0.0f ? point[i] / scale : 0.0f;
        }
        above = next;
    }
}

static void joint_at(const noh_skeleton *k, const noh_transform *local, uint32_t joint, noh_ragdoll_pose *out)
{
    memset(out, 0, sizeof *out);
    out->rotation[3] = 1.0f;
    out_of(k, local, joint, out->position, out->rotation);
}

/* ---- bodies on joints ---- */

/* Express `of` relative to `in`. */
static void relative(const noh_ragdoll_pose *in, const noh_ragdoll_pose *of, noh_ragdoll_pose *out)
{
    float back[4], d[3];
    noh_quat_conjugate(in->rotation, back);
    noh_sub3(of->position, in->position, d);
    noh_quat_rotate(back, d, out->position);
    noh_quat_mul(back, of->rotation, out->rotation);
    noh_quat_normalize(out->rotation);
}

/* Convert `of`, given relative to `in`, to absolute. */
static void absolute(const noh_ragdoll_pose *in, const noh_ragdoll_pose *of, noh_ragdoll_pose *out)
{
    noh_ragdoll_pose made;
    noh_quat_rotate(in->rotation, of->position, made.position);
    noh_madd3(made.position, 1.0f, in->position, made.position);
    noh_quat_mul(in->rotation, of->rotation, made.rotation);
    noh_quat_normalize(made.rotation);
    *out = made;
}

void noh_ragdoll_fit_make(const noh_ragdoll_rig *rig, const noh_skeleton *skeleton, float metres, noh_ragdoll_fit *fit)
{
    NOH_ASSERT(rig && skeleton && fit);
    memset(fit, 0, sizeof *fit);
    fit->body_count = rig->body_count;
    fit->metres = metres;
    for (uint32_t i = 0; i < rig->body_count; i++) {
        noh_ragdoll_pose joint, body;
        fit->joints[i] = rig->bodies[i].joint;
        joint_at(skeleton, skeleton->bind_pose, fit->joints[i], &joint);
        for (int k = 0; k < 3; k++) joint.position[k] *= metres;
        memcpy(body.position, rig->bodies[i].position, sizeof body.position);
        memcpy(body.rotation, rig->bodies[i].rotation, sizeof body.rotation);
        relative(&joint, &body, &fit->bodies[i]);
    }
}

/* A body on its joint, of a figure of the frame's size. */
static noh_ragdoll_pose sized_body(const noh_ragdoll_fit *fit, const noh_ragdoll_frame *frame, uint32_t i)
{
    noh_ragdoll_pose body = fit->bodies[i];
    for (int k = 0; k < 3; k++) body.position[k] *= frame->metres / fit->metres;
    return body;
}

static noh_ragdoll_pose pose_of_frame(const noh_ragdoll_frame *frame)
{
    noh_ragdoll_pose pose;
    memcpy(pose.position, frame->position, sizeof pose.position);
    memcpy(pose.rotation, frame->rotation, sizeof pose.rotation);
    return pose;
}

void noh_ragdoll_from_pose(const noh_ragdoll_fit *fit, const noh_skeleton *skeleton, const noh_transform *local,
                           const noh_ragdoll_frame *frame, noh_ragdoll_pose *bodies)
{
    const noh_ragdoll_pose model = pose_of_frame(frame);
    for (uint32_t i = 0; i < fit->body_count; i++) {
        const noh_ragdoll_pose body = sized_body(fit, frame, i);
        noh_ragdoll_pose joint;
        joint_at(skeleton, local, fit->joints[i], &joint);
        for (int k = 0; k < 3; k++) joint.position[k] *= frame->metres;
        absolute(&joint, &body, &bodies[i]);
        absolute(&model, &bodies[i], &bodies[i]);
    }
}

/* The joint of a body in model space, in the skeleton's unit. */
static void joint_of_body(const noh_ragdoll_fit *fit, const noh_ragdoll_frame *frame, uint32_t i,
                          const noh_ragdoll_pose *body, noh_ragdoll_pose *joint)
{
    const noh_ragdoll_pose model = pose_of_frame(frame), own = sized_body(fit, frame, i);
    noh_ragdoll_pose in_model;
    float back[4], offset[3];
    relative(&model, body, &in_model);
    noh_quat_conjugate(fit->bodies[i].rotation, back);
    noh_quat_mul(in_model.rotation, back, joint->rotation);
    noh_quat_rotate(joint->rotation, own.position, offset);
    for (int k = 0; k < 3; k++) joint->position[k] = (in_model.position[k] - offset[k]) / frame->metres;
}

void noh_ragdoll_to_pose(const noh_ragdoll_fit *fit, const noh_skeleton *skeleton, const noh_ragdoll_frame *frame,
                         const noh_ragdoll_pose *bodies, const float *weights, noh_transform *local)
{
    for (uint32_t i = 0; i < fit->body_count; i++) { /* by increasing joint: ancestors are done first */
        const float weight = weights ? weights[i] : 1.0f;
        const uint32_t at = fit->joints[i], parent = skeleton->parents[at];
        noh_ragdoll_pose joint, above;
        float back[4], own[4];
        if (!(weight > 0.0f)) continue;
        joint_of_body(fit, frame, i, &bodies[i], &joint);
        joint_at(skeleton, local, parent, &above);
        noh_quat_conjugate(above.rotation, back);
        noh_quat_mul(back, joint.rotation, own);
        noh_quat_nlerp(local[at].rotation, own, weight < 1.0f ? weight : 1.0f, local[at].rotation);
        noh_quat_normalize(local[at].rotation);
        if (i) continue;
        point_into(skeleton, local, parent, joint.position);
        for (int k = 0; k < 3; k++) {
            local[at].translation[k] += (joint.position[k] - local[at].translation[k]) *
                                        (weight < 1.0f ? weight : 1.0f);
        }
    }
}

void noh_ragdoll_motions_of(const noh_ragdoll_pose *before, const noh_ragdoll_pose *now, uint32_t count, float seconds,
                            noh_ragdoll_motion *motions)
{
    NOH_ASSERT(seconds > 0.0f);
    for (uint32_t i = 0; i < count; i++) {
        float back[4], turn[4];
        noh_quat_conjugate(before[i].rotation, back);
        noh_quat_mul(now[i].rotation, back, turn);
        noh_quat_to_rotation(turn, motions[i].spin);
        for (int k = 0; k < 3; k++) {
            motions[i].velocity[k] = (now[i].position[k] - before[i].position[k]) / seconds;
            motions[i].spin[k] /= seconds;
        }
    }
}

/* ---- getting up ---- */

/* The up direction in a body's space. */
static void up_of(const noh_ragdoll_pose *body, float up[3])
{
    static const float y[3] = { 0.0f, 1.0f, 0.0f };
    float back[4];
    noh_quat_conjugate(body->rotation, back);
    noh_quat_rotate(back, y, up);
}

float noh_ragdoll_similarity(const noh_ragdoll_pose *a, const noh_ragdoll_pose *b)
{
    float ups[2][3];
    up_of(a, ups[0]);
    up_of(b, ups[1]);
    return noh_dot3(ups[0], ups[1]);
}

/* Half of the turn about +Y, as sine and cosine, that brings one doll's bodies, about the first, nearest to the
 * other's: least squares of their distances, seen from above. */
static void heading_between(const noh_ragdoll_pose *from, const noh_ragdoll_pose *to, uint32_t count, float turn[4])
{
    float along = 0.0f, across = 0.0f;
    for (uint32_t i = 1; i < count; i++) {
        float a[3], b[3];
        noh_sub3(from[i].position, from[0].position, a);
        noh_sub3(to[i].position, to[0].position, b);
        along += a[0] * b[0] + a[2] * b[2];
        across += a[2] * b[0] - a[0] * b[2];
    }
    turn[0] = turn[2] = 0.0f;
    noh_sin_cos(0.5f * noh_atan2(across, along), &turn[1], &turn[3]);
}

void noh_ragdoll_place_under(const noh_ragdoll_pose *pose, const noh_ragdoll_pose *doll, uint32_t count,
                             noh_ragdoll_frame *frame)
{
    float turn[4], arm[3];
    heading_between(pose, doll, count, turn);
    noh_sub3(frame->position, pose[0].position, arm);
    noh_quat_rotate(turn, arm, arm);
    frame->position[0] = doll[0].position[0] + arm[0];
    frame->position[2] = doll[0].position[2] + arm[2];
    noh_quat_mul(turn, frame->rotation, frame->rotation);
    noh_quat_normalize(frame->rotation);
}
