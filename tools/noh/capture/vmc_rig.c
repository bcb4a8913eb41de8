#include "vmc_rig.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/names.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

#define RAISED_COS 0.985f /* of 10 degrees: arms that rest nearer to a T are taken for one */
#define LEGS_MIN 0.01f    /* metres */

/* Joints in model space, at rest. */
typedef struct rest_joint {
    float rotation[4], place[3], scale;
    float raise[4];                 /* from the rest to a T */
    uint32_t bone;                  /* VMC_BONES: none */
    char means[NOH_NAME_BYTES_MAX]; /* what its name stands for; "": no bone */
} rest_joint;

/* ---- names ---- */

/* A bone's name as VRM has it; since VRM 1.0, thumbs begin with a metacarpal. */
static void vrm_name(uint32_t bone, int has_metacarpal, char out[NOH_NAME_BYTES_MAX])
{
    char *thumb;
    (void)snprintf(out, NOH_NAME_BYTES_MAX, "%s", vmc_bone_names[bone]);
    out[0] = (char)(out[0] - 'A' + 'a');
    thumb = has_metacarpal ? strstr(out, "Thumb") : NULL;
    if (thumb && strcmp(thumb, "ThumbProximal") == 0)
        strcpy(thumb, "ThumbMetacarpal");
    else if (thumb && strcmp(thumb, "ThumbIntermediate") == 0)
        strcpy(thumb, "ThumbProximal");
}

/* VRM's own names count first, then others that mean the same; of those the first joint. */
static void find_bones(const noh_skeleton *s, const char *const *names, rest_joint *rest, uint32_t *joint_of)
{
    int has_metacarpal = 0;
    for (uint32_t j = 0; j < s->joint_count; j++) {
        has_metacarpal |= names[j] && strstr(names[j], "ThumbMetacarpal") != NULL;
        if (!names[j] || !names_find(NAME_JOINT, names[j], rest[j].means, NULL)) rest[j].means[0] = 0;
    }
    for (uint32_t b = 0; b < VMC_BONES; b++) {
        char own[NOH_NAME_BYTES_MAX], means[NOH_NAME_BYTES_MAX];
        joint_of[b] = NOH_NONE;
        vrm_name(b, has_metacarpal, own);
        if (!names_find(NAME_JOINT, own, means, NULL)) continue;
        for (uint32_t j = 0; j < s->joint_count && joint_of[b] == NOH_NONE; j++) {
            if (rest[j].bone == VMC_BONES && names[j] && strcmp(names[j], own) == 0) joint_of[b] = j;
        }
        for (uint32_t j = 0; j < s->joint_count && joint_of[b] == NOH_NONE; j++) {
            if (rest[j].bone == VMC_BONES && strcmp(rest[j].means, means) == 0) joint_of[b] = j;
        }
        if (joint_of[b] != NOH_NONE) rest[joint_of[b]].bone = b;
    }
}

/* ---- the bind pose ---- */

static void place_joints(const noh_skeleton *s, rest_joint *rest)
{
    static const float none[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
    for (uint32_t j = 0; j < s->joint_count; j++) {
        const noh_transform *local = &s->bind_pose[j];
        const rest_joint *parent = s->parents[j] == NOH_JOINT_ROOT ? NULL : &rest[s->parents[j]];
        memcpy(rest[j].rotation, local->rotation, sizeof rest[j].rotation);
        memcpy(rest[j].place, local->translation, sizeof rest[j].place);
        memcpy(rest[j].raise, none, sizeof none);
        rest[j].scale = local->scale[0];
        rest[j].bone = VMC_BONES;
        if (!parent) continue;
        noh_quat_mul(parent->rotation, local->rotation, rest[j].rotation);
        noh_quat_rotate(parent->rotation, local->translation, rest[j].place);
        for (int i = 0; i < 3; i++) rest[j].place[i] = parent->place[i] + parent->scale * rest[j].place[i];
        rest[j].scale *= parent->scale;
    }
}

static float distance(const rest_joint *a, const rest_joint *b, float way[3])
{
    for (int i = 0; i < 3; i++) way[i] = b->place[i] - a->place[i];
    return sqrtf(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
}

/* The shortest rotation of a joint's bone to the side, if it is below a T. */
static void raise_arm(rest_joint *arm, const rest_joint *next, float side)
{
    float way[3];
    const float length = distance(arm, next, way);
    if (!(length > 0.0f) || way[0] * side / length > RAISED_COS) return;
    arm->raise[0] = 0.0f; /* the cross product of the bone's direction and the side */
    arm->raise[1] = way[2] / length * side;
    arm->raise[2] = -way[1] / length * side;
    arm->raise[3] = 1.0f + way[0] * side / length;
    noh_quat_normalize(arm->raise);
}

static void raise_arms(const noh_skeleton *s, rest_joint *rest, const uint32_t *joint_of)
{
    static const uint32_t bones[3] = { VMC_UPPER_ARM, VMC_LOWER_ARM, VMC_HAND };
    for (uint32_t side = 0; side < 2; side++) {
        const uint32_t upper = joint_of[VMC_UPPER_ARM + side], hand = joint_of[VMC_HAND + side];
        const uint32_t other = joint_of[VMC_UPPER_ARM + 1u - side];
        if (upper == NOH_NONE || hand == NOH_NONE || other == NOH_NONE) continue;
        for (int i = 0; i < 2; i++) {
            const uint32_t a = joint_of[bones[i] + side], b = joint_of[bones[i + 1] + side];
            if (a == NOH_NONE || b == NOH_NONE) continue;
            raise_arm(&rest[a], &rest[b], rest[upper].place[0] > rest[other].place[0] ? 1.0f : -1.0f);
        }
    }
    for (uint32_t j = 0; j < s->joint_count; j++) { /* what hangs from an arm is raised with it */
        const int is_arm = rest[j].bone >= VMC_UPPER_ARM && rest[j].bone < VMC_HAND;
        if (!is_arm && s->parents[j] != NOH_JOINT_ROOT)
            memcpy(rest[j].raise, rest[s->parents[j]].raise, sizeof rest[j].raise);
    }
}

/* ---- making it ---- */

static void add_bone(vmc_rig *rig, const noh_skeleton *s, const rest_joint *rest, uint32_t joint)
{
    vmc_joint *out = &rig->bones[rig->bone_count++];
    const uint32_t parent = s->parents[joint];
    float above[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
    out->joint = joint;
    out->bone = rest[joint].bone;
    if (parent != NOH_JOINT_ROOT) noh_quat_mul(rest[parent].raise, rest[parent].rotation, above);
    noh_quat_conjugate(above, out->from);
    noh_quat_mul(rest[joint].raise, rest[joint].rotation, out->to);
}

static void set_hips(vmc_rig *rig, const noh_skeleton *s, const rest_joint *rest, const uint32_t *joint_of)
{
    const uint32_t upper = joint_of[VMC_UPPER_LEG], other = joint_of[VMC_UPPER_LEG + 1u],
                   lower = joint_of[VMC_LOWER_LEG], foot = joint_of[VMC_FOOT], hips = joint_of[VMC_HIPS];
    const uint32_t parent = hips == NOH_NONE ? NOH_JOINT_ROOT : s->parents[hips];
    float way[3];
    rig->hips_scale = rig->hips_from[3] = 1.0f;
    if (parent != NOH_JOINT_ROOT) {
        noh_quat_conjugate(rest[parent].rotation, rig->hips_from);
        rig->hips_scale = rest[parent].scale;
        memcpy(rig->hips_above, rest[parent].place, sizeof rig->hips_above);
    }
    if (upper == NOH_NONE) return;
    rig->faces_back = other != NOH_NONE && rest[upper].place[0] < rest[other].place[0];
    if (lower == NOH_NONE || foot == NOH_NONE || !(rig->hips_scale > 0.0f)) return;
    rig->legs = distance(&rest[upper], &rest[lower], way);
    rig->legs += distance(&rest[lower], &rest[foot], way);
}

void vmc_rig_make(vmc_rig *rig, const noh_skeleton *skeleton, const char *const *names)
{
    rest_joint *rest = malloc((skeleton->joint_count + 1u) * sizeof *rest);
    uint32_t joint_of[VMC_BONES];
    memset(rig, 0, sizeof *rig);
    if (!rest) return;
    rig->joint_count = skeleton->joint_count;
    place_joints(skeleton, rest);
    find_bones(skeleton, names, rest, joint_of);
    raise_arms(skeleton, rest, joint_of);
    for (uint32_t j = 0; j < skeleton->joint_count; j++) {
        if (rest[j].bone != VMC_BONES) add_bone(rig, skeleton, rest, j);
    }
    set_hips(rig, skeleton, rest, joint_of);
    free(rest);
}

/* ---- a pose ---- */

/* From Unity's axes, which are left-handed. */
static void turn_over(const vmc_rig *rig, const float in[4], float out[4])
{
    out[0] = rig->faces_back ? -in[0] : in[0];
    out[1] = -in[1];
    out[2] = rig->faces_back ? in[2] : -in[2];
    out[3] = in[3];
}

static float length_of(const float v[3])
{
    return sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static void place_hips(const vmc_rig *rig, const vmc *v, float out[3])
{
    const vmc_bone *lower = &v->bones[VMC_LOWER_LEG], *foot = &v->bones[VMC_FOOT], *hips = &v->bones[VMC_HIPS];
    const float theirs = lower->is_known && foot->is_known ? length_of(lower->position) + length_of(foot->position) : 0;
    float at[3];
    if (!(theirs > LEGS_MIN) || !(rig->legs > 0.0f)) return;
    memcpy(at, hips->position, sizeof at);
    if (v->root.is_known) {
        noh_quat_rotate(v->root.rotation, hips->position, at);
        for (int i = 0; i < 3; i++) at[i] += v->root.position[i];
    }
    at[rig->faces_back ? 2 : 0] *= -1.0f;
    for (int i = 0; i < 3; i++) at[i] = at[i] * rig->legs / theirs - rig->hips_above[i];
    noh_quat_rotate(rig->hips_from, at, out);
    for (int i = 0; i < 3; i++) out[i] /= rig->hips_scale;
}

void vmc_rig_pose(const vmc_rig *rig, const vmc *v, noh_transform *local)
{
    for (uint32_t i = 0; i < rig->bone_count; i++) {
        const vmc_joint *j = &rig->bones[i];
        const vmc_bone *bone = &v->bones[j->bone];
        float sent[4], turned[4], half[4];
        if (!bone->is_known) continue;
        memcpy(sent, bone->rotation, sizeof sent);
        if (j->bone == VMC_HIPS && v->root.is_known) noh_quat_mul(v->root.rotation, bone->rotation, sent);
        turn_over(rig, sent, turned);
        noh_quat_mul(j->from, turned, half);
        noh_quat_mul(half, j->to, local[j->joint].rotation);
        noh_quat_normalize(local[j->joint].rotation);
        if (j->bone == VMC_HIPS) place_hips(rig, v, local[j->joint].translation);
    }
}
