/* retarget_internal.h: what both halves of retargeting share: places of joints, and the limbs. */
#ifndef NOH_RETARGET_INTERNAL_H
#define NOH_RETARGET_INTERNAL_H

#include "core/base/vector_internal.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"

#define NOH_RETARGET_WHOLE 0x8000u /* in noh_retarget_joint.above: the rotation counts from the source's root */

/* A joint in the space of another, or of the model. */
typedef struct noh_retarget_place {
    float rotation[4], position[3];
    float scale; /* an even one; of positions below the joint */
} noh_retarget_place;

/* The place of a joint below one of its ancestors; NOH_JOINT_ROOT: in the model's space. */
void noh_retarget_place_of(const noh_skeleton *skeleton, const noh_transform *pose, uint32_t joint, uint32_t ancestor,
                           noh_retarget_place *out);
/* The place of a joint from its ancestor's. */
void noh_retarget_place_below(const noh_skeleton *skeleton, const noh_transform *pose, uint32_t joint,
                              uint32_t ancestor, const noh_retarget_place *at, noh_retarget_place *out);

/* A position of the source as the target has it. */
void noh_retarget_point(const noh_retarget *r, const float source[3], float out[3]);

/* Put a joint at a position in the model's space. */
void noh_retarget_put(const noh_skeleton *skeleton, noh_transform *pose, uint32_t joint, const float position[3]);

/* Bend the limbs of a pose: legs first, which may lower the hips. */
void noh_retarget_bend(const noh_retarget *r, const noh_transform *source, const float (*feet)[3], uint32_t joint_count,
                       noh_transform *target);

#endif
