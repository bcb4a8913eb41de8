/* bones.h: which joints are a person's bones: by their names (base/names.h), by a file of its own, and hips by what
 * both legs hang from. */
#ifndef NOH_CONVERT_RETARGET_BONES_H
#define NOH_CONVERT_RETARGET_BONES_H

#include "convert/clips/raw_clip.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"

/* Fill bones[NOH_BONES] with joints, or NOH_JOINT_ROOT. */
void bones_find(const raw_skeleton *skeleton, uint16_t *bones);

/* Whether hips and both arms and legs are known. */
int bones_are_a_person(const uint16_t *bones);

/* The bone of a name as VRM has it (leftUpperArm), or "root"; NOH_BONES: none. */
uint32_t bone_named(const char *name);

/* A file of lines BONE THEIRS OURS, and of one line "reference FRAME": which frame of the clips stands upright. Joints
 * that a skeleton lacks are skipped: one file serves many. frame: unchanged where there is none. 0, or 1 and the error. */
int bones_read(const char *path, const raw_skeleton *theirs, const raw_skeleton *ours, uint16_t *their_bones,
               uint16_t *our_bones, uint32_t *frame, model_error *error);

#endif
