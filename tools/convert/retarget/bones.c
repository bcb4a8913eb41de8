#include "bones.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/input_file.h"
#include "convert/base/names.h"
#include "convert/base/text_scan.h"

static const char *const middle[] = { "root", "hips", "spine", "chest", "upperChest", "neck", "head" },
                         *const side[] = { "Shoulder",
                                           "UpperArm",
                                           "LowerArm",
                                           "Hand",
                                           "UpperLeg",
                                           "LowerLeg",
                                           "Foot",
                                           "Toes",
                                           "ThumbMetacarpal",
                                           "ThumbProximal",
                                           "ThumbDistal",
                                           "IndexProximal",
                                           "IndexIntermediate",
                                           "IndexDistal",
                                           "MiddleProximal",
                                           "MiddleIntermediate",
                                           "MiddleDistal",
                                           "RingProximal",
                                           "RingIntermediate",
                                           "RingDistal",
                                           "LittleProximal",
                                           "LittleIntermediate",
                                           "LittleDistal" };

uint32_t bone_named(const char *name)
{
    const int is_right = strncmp(name, "right", 5) == 0;
    for (uint32_t i = 0; i < sizeof middle / sizeof *middle; i++) {
        if (strcmp(name, middle[i]) == 0) return i;
    }
    for (uint32_t i = 0; i < sizeof side / sizeof *side && (is_right || strncmp(name, "left", 4) == 0); i++) {
        if (strcmp(name + (is_right ? 5 : 4), side[i]) == 0) {
            return NOH_BONE_SHOULDER + i + (is_right ? (uint32_t)NOH_BONE_RIGHT : 0u);
        }
    }
    return NOH_BONES;
}

static uint32_t parent_of(const raw_skeleton *s, uint32_t joint)
{
    return s->joints[joint].parent;
}

static int is_above(const raw_skeleton *s, uint32_t above, uint32_t joint)
{
    while (joint != MODEL_NONE && joint != above) joint = parent_of(s, joint);
    return joint != MODEL_NONE;
}

/* Hips are above both thighs, whatever is named so. What is above them is the root. */
static void find_trunk(const raw_skeleton *s, uint16_t *bones)
{
    const uint16_t left = bones[NOH_BONE_UPPER_LEG], right = bones[NOH_BONE_UPPER_LEG + NOH_BONE_RIGHT];
    uint32_t at = left == NOH_JOINT_ROOT || right == NOH_JOINT_ROOT ? MODEL_NONE : parent_of(s, left);
    while (at != MODEL_NONE && !is_above(s, at, right)) at = parent_of(s, at);
    if (at != MODEL_NONE && !is_above(s, bones[NOH_BONE_HIPS], at)) bones[NOH_BONE_HIPS] = (uint16_t)at;
    if (bones[NOH_BONE_ROOT] != NOH_JOINT_ROOT || bones[NOH_BONE_HIPS] == NOH_JOINT_ROOT) return;
    for (at = parent_of(s, bones[NOH_BONE_HIPS]); at != MODEL_NONE; at = parent_of(s, at)) {
        bones[NOH_BONE_ROOT] = (uint16_t)at;
    }
}

void bones_find(const raw_skeleton *skeleton, uint16_t *bones)
{
    for (uint32_t b = 0; b < NOH_BONES; b++) bones[b] = NOH_JOINT_ROOT;
    for (uint32_t j = 0; j < skeleton->joint_count && j < NOH_JOINT_ROOT; j++) {
        char means[NOH_NAME_BYTES_MAX];
        const char *name = skeleton->joints[j].name;
        const uint32_t bone = name && names_find(NAME_JOINT, name, means, NULL) ? bone_named(means) : NOH_BONES;
        if (bone < NOH_BONES && bones[bone] == NOH_JOINT_ROOT) bones[bone] = (uint16_t)j;
    }
    find_trunk(skeleton, bones);
}

/* ---- a file ---- */

static void set_bone(const raw_skeleton *s, text_word name, uint16_t *bone)
{
    for (uint32_t j = 0; j < s->joint_count && j < NOH_JOINT_ROOT; j++) {
        const char *own = s->joints[j].name ? s->joints[j].name : "";
        if (strlen(own) == name.size && memcmp(own, name.text, name.size) == 0) *bone = (uint16_t)j;
    }
}

static int read_line(text_scan *scan, text_word word, const raw_skeleton *const skeletons[2], uint16_t *const bones[2],
                     uint32_t *frame)
{
    char name[NOH_NAME_BYTES_MAX], shown[TEXT_SHOWN];
    text_word joints[2];
    uint32_t bone;
    snprintf(name, sizeof name, "%.*s", (int)word.size, word.text);
    if (text_is(word, "reference")) {
        char *end;
        if (text_take_on_line(scan, &joints[0])) return 1;
        snprintf(name, sizeof name, "%.*s", (int)joints[0].size, joints[0].text);
        *frame = (uint32_t)strtoul(name, &end, 10);
        return joints[0].size && !*end && *name != '-'
                   ? 0
                   : text_fail(scan, word.line, "'reference' needs a frame, from 0");
    }
    bone = bone_named(name);
    if (bone == NOH_BONES) {
        return text_fail(scan, word.line, "'%s' is no bone: use VRM's names, such as leftUpperArm, root or reference",
                         text_show(word, shown));
    }
    for (int i = 0; i < 2; i++) {
        if (text_take_on_line(scan, &joints[i])) return 1;
        if (!joints[i].size) {
            return text_fail(scan, word.line, "a line needs a bone and two joints: the file's and the pack's");
        }
        set_bone(skeletons[i], joints[i], &bones[i][bone]);
    }
    return 0;
}

int bones_read(const char *path, const raw_skeleton *theirs, const raw_skeleton *ours, uint16_t *their_bones,
               uint16_t *our_bones, uint32_t *frame, model_error *error)
{
    const raw_skeleton *const skeletons[2] = { theirs, ours };
    uint16_t *const bones[2] = { their_bones, our_bones };
    size_t bytes;
    char *text = input_read_text(path, &bytes, error);
    text_scan scan;
    text_word word;
    int failed;
    if (!text) return input_fail_at(path, error);
    text_start(&scan, text, bytes, error);
    do {
        failed = text_take_on_line(&scan, &word) || (word.size && read_line(&scan, word, skeletons, bones, frame));
    } while (!failed && text_next_line(&scan));
    free(text);
    return failed ? input_fail_at(path, error) : 0;
}
