#include "bones.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/input_file.h"
#include "convert/base/names.h"
#include "convert/base/text_scan.h"
#include "life/reach/bone_names_internal.h"

uint32_t bone_named(const char *name)
{
    const int is_right = strncmp(name, "right", 5) == 0, is_left = strncmp(name, "left", 4) == 0;
    if (strcmp(name, "root") == 0) return NOH_BONE_ROOT;
    for (uint32_t i = 0; i < NOH_BONE_NAMES; i++) {
        const char *vrm = noh_bone_names[i].vrm;
        if (*vrm != '*' && strcmp(name, vrm) == 0) return NOH_BONE_HIPS + i;
        if (*vrm == '*' && (is_left || is_right) && strcmp(name + (is_right ? 5 : 4), vrm + 1) == 0)
            return NOH_BONE_HIPS + i + (is_right ? (uint32_t)NOH_BONE_RIGHT : 0u);
    }
    return NOH_BONES;
}

void bones_find(const raw_skeleton *skeleton, uint16_t *bones)
{
    uint16_t parents[NOH_JOINTS_MAX];
    const uint32_t count = skeleton->joint_count < NOH_JOINTS_MAX ? skeleton->joint_count : NOH_JOINTS_MAX;
    for (uint32_t b = 0; b < NOH_BONES; b++) bones[b] = NOH_JOINT_ROOT;
    for (uint32_t j = 0; j < count; j++) {
        char means[NOH_NAME_BYTES_MAX];
        const raw_joint *joint = &skeleton->joints[j];
        const uint32_t bone = joint->name && names_find(NAME_JOINT, joint->name, means, NULL) ? bone_named(means)
                                                                                              : NOH_BONES;
        parents[j] = joint->parent == MODEL_NONE ? NOH_JOINT_ROOT : (uint16_t)joint->parent;
        if (bone < NOH_BONES && bones[bone] == NOH_JOINT_ROOT) bones[bone] = (uint16_t)j;
    }
    noh_bones_find_trunk(parents, bones);
}

int bones_are_a_person(const uint16_t *bones)
{
    static const uint32_t limbs[] = { NOH_BONE_UPPER_ARM, NOH_BONE_LOWER_ARM, NOH_BONE_UPPER_LEG, NOH_BONE_LOWER_LEG };
    int all = bones[NOH_BONE_HIPS] != NOH_JOINT_ROOT;
    for (size_t i = 0; i < sizeof limbs / sizeof limbs[0]; i++) {
        all &= bones[limbs[i]] != NOH_JOINT_ROOT && bones[limbs[i] + NOH_BONE_RIGHT] != NOH_JOINT_ROOT;
    }
    return all;
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
