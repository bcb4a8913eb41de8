#include "raw_turn.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/quat.h"
#include "convert/retarget/bones.h"
#include "raw_set.h"

#define DEGREE (3.14159265358979323846 / 180.0)

int raw_rest_from_frame(raw_set *set, uint32_t frame)
{
    raw_skeleton *skeleton = &set->skeleton;
    uint32_t c = 0;
    while (c < set->clip_count && set->clips[c].joint_count != skeleton->joint_count) c++;
    if (c == set->clip_count || !skeleton->joint_count || frame >= set->clips[c].frame_count) return 1;
    for (uint32_t j = 0; j < skeleton->joint_count; j++) {
        const size_t at = (size_t)frame * skeleton->joint_count + j;
        raw_joint *joint = &skeleton->joints[j];
        memcpy(joint->rotation, set->clips[c].rotations + 4u * at, sizeof joint->rotation);
        memcpy(joint->translation, set->clips[c].translations + 3u * at, sizeof joint->translation);
        memcpy(joint->scale, set->clips[c].scales + 3u * at, sizeof joint->scale);
    }
    return 0;
}

/* ---- left and right ---- */

static uint32_t joint_named(const raw_skeleton *skeleton, const char *name)
{
    for (uint32_t j = 0; j < skeleton->joint_count; j++) {
        if (strcmp(skeleton->joints[j].name, name) == 0) return j;
    }
    return MODEL_NONE;
}

/* The joint whose name has `right` where this one has `size` bytes at `at`. */
static uint32_t other_side(const raw_skeleton *skeleton, const char *name, size_t at, size_t size, const char *right)
{
    const size_t length = strlen(name), put = strlen(right);
    char *text = malloc(length - size + put + 1u);
    uint32_t found;
    if (!text) return MODEL_NONE;
    snprintf(text, length - size + put + 1u, "%.*s%s%s", (int)at, name, right, name + at + size);
    found = joint_named(skeleton, text);
    free(text);
    return found;
}

/* Whether the l at this place stands alone: l_hand, hand.L, lHand, Bip01 L Hand. */
static int stands_alone(const char *name, size_t at)
{
    const int first = at == 0 || !isalnum((unsigned char)name[at - 1]);
    const char next = name[at + 1];
    return first && (!isalnum((unsigned char)next) || isupper((unsigned char)next));
}

static uint32_t partner_of(const raw_skeleton *skeleton, const char *name)
{
    static const char *const words[][2] = { { "left", "right" }, { "Left", "Right" }, { "LEFT", "RIGHT" } };
    for (size_t w = 0; w < 3; w++) {
        const char *found = strstr(name, words[w][0]);
        if (found) return other_side(skeleton, name, (size_t)(found - name), 4, words[w][1]);
    }
    for (size_t at = 0; name[at]; at++) {
        uint32_t other;
        if ((name[at] != 'l' && name[at] != 'L') || !stands_alone(name, at)) continue;
        other = other_side(skeleton, name, at, 1, name[at] == 'l' ? "r" : "R");
        if (other != MODEL_NONE) return other;
    }
    return MODEL_NONE;
}

int raw_side(const raw_skeleton *skeleton, uint32_t joint)
{
    for (uint32_t at = joint; at != MODEL_NONE; at = skeleton->joints[at].parent) {
        if (partner_of(skeleton, skeleton->joints[at].name) != MODEL_NONE) return 1;
        for (uint32_t j = 0; j < skeleton->joint_count; j++) {
            if (partner_of(skeleton, skeleton->joints[j].name) == at) return -1;
        }
    }
    return 0;
}

int raw_facing(const raw_skeleton *skeleton, double *degrees)
{
    double *pose = malloc((skeleton->joint_count + 1u) * 12u * sizeof *pose);
    double left[3] = { 0.0, 0.0, 0.0 }, all = 0.0;
    if (!pose) return 1;
    raw_pose_object(skeleton, NULL, 0, pose);
    for (uint32_t j = 0; j < skeleton->joint_count; j++) {
        const uint32_t other = partner_of(skeleton, skeleton->joints[j].name);
        for (uint32_t i = 0; i < 3 && other != MODEL_NONE; i++) {
            const double apart = pose[12u * (size_t)j + 9u + i] - pose[12u * (size_t)other + 9u + i];
            left[i] += apart;
            all += fabs(apart);
        }
    }
    free(pose);
    if (!(hypot(left[0], left[2]) > 0.1 * all)) return 1;
    *degrees = atan2(-left[2], left[0]) / DEGREE; /* forward = left x up = (-left.z, 0, left.x) */
    return 0;
}

/* ---- turning ---- */

static void turn_root(const double q[4], float *rotation, float *translation)
{
    double before[4], after[4], columns[9], t[3];
    for (int i = 0; i < 4; i++) before[i] = (double)rotation[i];
    quat_multiply(q, before, after);
    (void)quat_normalize(after);
    quat_align(after, before);
    quat_columns(q, columns);
    for (int i = 0; i < 3; i++) {
        t[i] = 0.0;
        for (int k = 0; k < 3; k++) t[i] += columns[3 * k + i] * (double)translation[k];
    }
    for (int i = 0; i < 4; i++) rotation[i] = (float)after[i];
    for (int i = 0; i < 3; i++) translation[i] = (float)t[i];
}

static void turn_roots(raw_set *set, const double q[4])
{
    for (uint32_t j = 0; j < set->skeleton.joint_count; j++) {
        raw_joint *joint = &set->skeleton.joints[j];
        if (joint->parent != MODEL_NONE) continue;
        turn_root(q, joint->rotation, joint->translation);
        for (uint32_t c = 0; c < set->clip_count; c++) {
            raw_clip *clip = &set->clips[c];
            for (uint32_t f = 0; f < clip->frame_count && clip->joint_count; f++) {
                const size_t at = (size_t)f * clip->joint_count + j;
                turn_root(q, clip->rotations + 4u * at, clip->translations + 3u * at);
            }
        }
    }
}

void raw_turn(raw_set *set, double degrees)
{
    const double q[4] = { 0.0, sin(0.5 * degrees * DEGREE), 0.0, cos(0.5 * degrees * DEGREE) };
    turn_roots(set, q);
}

/* ---- standing up ---- */

/* Whether the head is above the feet along +z, `times` as far as it is away from them across. */
static int z_is_up(const raw_skeleton *skeleton, const raw_clip *clip, const uint16_t *bones, double *pose,
                   double times)
{
    double up[3];
    raw_pose_object(skeleton, clip, 0, pose);
    for (int i = 0; i < 3; i++) {
        const double *origins = pose + 9 + i;
        up[i] = origins[12u * (size_t)bones[NOH_BONE_HEAD]] -
                0.5 * (origins[12u * (size_t)bones[NOH_BONE_FOOT]] +
                       origins[12u * (size_t)bones[NOH_BONE_FOOT + NOH_BONE_RIGHT]]);
    }
    return up[2] > times * hypot(up[0], up[1]);
}

int raw_stand_up(raw_set *set)
{
    const double q[4] = { -sqrt(0.5), 0.0, 0.0, sqrt(0.5) };
    uint16_t bones[NOH_BONES];
    double *pose = malloc((set->skeleton.joint_count + 1u) * 12u * sizeof *pose);
    int is_up;
    bones_find(&set->skeleton, bones);
    is_up = pose && bones[NOH_BONE_HEAD] != NOH_JOINT_ROOT && bones[NOH_BONE_FOOT] != NOH_JOINT_ROOT &&
            bones[NOH_BONE_FOOT + NOH_BONE_RIGHT] != NOH_JOINT_ROOT && z_is_up(&set->skeleton, NULL, bones, pose, 2.0);
    for (uint32_t c = 0; c < set->clip_count && is_up; c++) {
        if (set->clips[c].joint_count && set->clips[c].frame_count) {
            is_up = z_is_up(&set->skeleton, &set->clips[c], bones, pose, 1.0); /* may bend or sit */
        }
    }
    free(pose);
    if (is_up) turn_roots(set, q);
    return is_up;
}
