#include "retarget_set.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bones.h"
#include "convert/clips/joint_match.h"
#include "convert/clips/raw_set.h"
#include "convert/clips/raw_turn.h"
#include "feet.h"

enum { SOURCE, TARGET };

#define LOCK_ROUNDS 2 /* a foot that was out of reach at first is not where its lock takes it to be */
#define ALIKE 1e-3    /* of a skeleton's size, and radians: bind poses that are equal */

typedef struct retargeting {
    const raw_skeleton *raw[2];
    noh_skeleton skeletons[2];
    noh_retarget_rig rigs[2];
    noh_retarget map;
    noh_retarget_joint *joints;
    noh_transform *poses[2];
} retargeting;

int retarget_same(const raw_skeleton *a, const raw_skeleton *b)
{
    double size = 0.0;
    if (raw_skeleton_hash(a) != raw_skeleton_hash(b)) return 0;
    for (uint32_t j = 0; j < a->joint_count; j++) {
        for (int i = 0; i < 3; i++) size = fmax(size, fabs((double)a->joints[j].translation[i]) * a->unit_cm);
    }
    for (uint32_t j = 0; j < a->joint_count; j++) {
        const raw_joint *x = &a->joints[j], *y = &b->joints[j];
        double dot = 0.0;
        for (int i = 0; i < 4; i++) dot += (double)x->rotation[i] * (double)y->rotation[i];
        if (fabs(dot) < cos(0.5 * ALIKE)) return 0;
        for (int i = 0; i < 3; i++) {
            const double off = (double)x->translation[i] * a->unit_cm - (double)y->translation[i] * b->unit_cm;
            if (fabs(off) > ALIKE * size) return 0;
        }
    }
    return 1;
}

/* ---- skeletons ---- */

static void close_retargeting(retargeting *r)
{
    for (int i = 0; i < 2; i++) {
        free((void *)(uintptr_t)r->skeletons[i].parents);
        free((void *)(uintptr_t)r->skeletons[i].bind_pose);
        free(r->poses[i]);
    }
    free(r->joints);
}

static int open_skeleton(const raw_skeleton *from, noh_skeleton *to, noh_transform **pose)
{
    uint16_t *parents = malloc((size_t)from->joint_count * sizeof *parents);
    noh_transform *bind = malloc((size_t)from->joint_count * sizeof *bind);
    *pose = malloc((size_t)from->joint_count * sizeof **pose);
    to->joint_count = from->joint_count;
    to->parents = parents;
    to->bind_pose = bind;
    for (uint32_t j = 0; parents && bind && j < from->joint_count; j++) {
        const raw_joint *joint = &from->joints[j];
        parents[j] = joint->parent == MODEL_NONE ? (uint16_t)NOH_JOINT_ROOT : (uint16_t)joint->parent;
        memcpy(bind[j].rotation, joint->rotation, sizeof joint->rotation);
        memcpy(bind[j].translation, joint->translation, sizeof joint->translation);
        memcpy(bind[j].scale, joint->scale, sizeof joint->scale);
    }
    return !parents || !bind || !*pose;
}

static int open_retargeting(retargeting *r, raw_set *set, const raw_skeleton *to, const char *map, model_error *error)
{
    noh_error why = { NOH_OK, "", 0, 0 };
    uint32_t frame = MODEL_NONE;
    r->raw[SOURCE] = &set->skeleton;
    r->raw[TARGET] = to;
    for (int i = 0; i < 2; i++) bones_find(r->raw[i], r->rigs[i].bones);
    if (map && bones_read(map, r->raw[SOURCE], to, r->rigs[SOURCE].bones, r->rigs[TARGET].bones, &frame, error))
        return 1;
    if (frame != MODEL_NONE && raw_rest_from_frame(set, frame)) {
        return model_fail(error, "", "no clip has the reference frame %u", (unsigned)frame);
    }
    r->joints = malloc((size_t)to->joint_count * sizeof *r->joints);
    for (int i = 0; i < 2; i++) {
        if (!r->joints || open_skeleton(r->raw[i], &r->skeletons[i], &r->poses[i])) return model_fail_memory(error);
        r->rigs[i].skeleton = &r->skeletons[i];
    }
    if (noh_retarget_init(&r->map, &r->rigs[SOURCE], &r->rigs[TARGET], NOH_RETARGET_FEET | NOH_RETARGET_HANDS,
                          r->joints, &why)) {
        return model_fail(
            error, "",
            why.result == NOH_ERR_DATA
                ? "cannot retarget: the bind pose of %s does not stand upright; give a frame that does, "
                  "with --rest first-frame or a line 'reference FRAME' in the file of --retarget"
                : "cannot retarget: the bones of %s are not known by their names; give them in the file of "
                  "--retarget",
            why.where ? "the pack's skeleton" : "this file's skeleton");
    }
    return 0;
}

/* ---- clips ---- */

static void read_frame(const raw_clip *clip, uint32_t frame, noh_transform *pose)
{
    for (uint32_t j = 0; j < clip->joint_count; j++) {
        const size_t at = (size_t)frame * clip->joint_count + j;
        memcpy(pose[j].rotation, clip->rotations + 4u * at, sizeof pose[j].rotation);
        memcpy(pose[j].translation, clip->translations + 3u * at, sizeof pose[j].translation);
        memcpy(pose[j].scale, clip->scales + 3u * at, sizeof pose[j].scale);
    }
}

static void write_frame(const noh_transform *pose, uint32_t frame, raw_clip *clip)
{
    for (uint32_t j = 0; j < clip->joint_count; j++) {
        const size_t at = (size_t)frame * clip->joint_count + j;
        memcpy(clip->rotations + 4u * at, pose[j].rotation, sizeof pose[j].rotation);
        memcpy(clip->translations + 3u * at, pose[j].translation, sizeof pose[j].translation);
        memcpy(clip->scales + 3u * at, pose[j].scale, sizeof pose[j].scale);
    }
}

static void pose_frames(const retargeting *r, const raw_clip *from, float (*feet)[2][3], raw_clip *to)
{
    for (uint32_t f = 0; f < from->frame_count; f++) {
        read_frame(from, f, r->poses[SOURCE]);
        noh_retarget_pose(&r->map, r->poses[SOURCE], (const float(*)[3])feet[f], to->joint_count, r->poses[TARGET]);
        write_frame(r->poses[TARGET], f, to);
    }
}

static int say_figures(const retargeting *r, const retarget_pair *pair, FILE *report)
{
    const double y = (double)r->map.facing[1], w = (double)r->map.facing[3], facing[2] = { w * w - y * y, 2.0 * y * w };
    retarget_figures f;
    if (!report) return 0;
    if (feet_measure(pair, facing, (double)r->map.ground, &f)) return 1;
    fprintf(
        report,
        "retargeted '%s': %u bones, sizes x %.3f; feet slide %.2f %% of a stride, penetrate %.1f cm in 95 %% of frames "
        "(source: %.1f), hands off by %.1f cm, %.1f %% of bends turned over\n",
        pair->clips[TARGET]->name, r->map.bone_count,
        (double)r->map.clips.ratio * pair->skeletons[TARGET]->unit_cm / pair->skeletons[SOURCE]->unit_cm,
        100.0 * f.slide, f.penetration_cm, f.source_penetration_cm, f.reach_cm, 100.0 * f.against);
    return 0;
}

static int pose_clip(retargeting *r, const raw_clip *from, raw_clip *to, FILE *report)
{
    retarget_pair pair = {
        { r->raw[SOURCE], r->raw[TARGET] }, { from, NULL }, { r->rigs[SOURCE].bones, r->rigs[TARGET].bones }, NULL
    };
    float(*feet)[2][3] = calloc(from->frame_count, sizeof *feet);
    double ground;
    int failed;
    contacts *stands = contacts_find(r->raw[SOURCE], from, &failed);
    pair.stands = stands;
    failed = failed || !feet || feet_ground(&pair, &ground);
    if (!failed) {
        r->map.ground = (float)ground;
        pair.clips[TARGET] = to;
        pose_frames(r, from, feet, to);
    }
    for (int round = 0; round < LOCK_ROUNDS && !failed; round++) {
        failed = feet_lock(&pair, feet);
        if (!failed) pose_frames(r, from, feet, to);
    }
    failed = failed || say_figures(r, &pair, report);
    contacts_free(stands);
    free(feet);
    return failed;
}

static int retarget_clip(retargeting *r, raw_clip *clip, FILE *report)
{
    raw_clip to = *clip;
    if (!clip->joint_count) return 0;
    to.rotations = to.translations = to.scales = NULL;
    if (raw_clip_alloc(&to, clip->frame_count, r->raw[TARGET]->joint_count) || pose_clip(r, clip, &to, report)) {
        free(to.rotations);
        free(to.translations);
        free(to.scales);
        return 1;
    }
    free(clip->rotations);
    free(clip->translations);
    free(clip->scales);
    *clip = to;
    return 0;
}

int retarget_set(raw_set *set, const raw_skeleton *to, const char *map, FILE *report, model_error *error)
{
    retargeting r;
    int failed;
    memset(&r, 0, sizeof r);
    failed = open_retargeting(&r, set, to, map, error);
    for (uint32_t c = 0; c < set->clip_count && !failed; c++) {
        set->clips[c].source = NULL; /* its curves are of the other skeleton */
        failed = retarget_clip(&r, &set->clips[c], report) && model_fail_memory(error);
    }
    close_retargeting(&r);
    if (failed) return 1;
    set->skeleton.unit_cm = to->unit_cm;
    return raw_skeleton_take(&set->skeleton, to) ? model_fail_memory(error) : 0;
}
