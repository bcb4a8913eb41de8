/* inertial_internal.h (private to pose/ and anim/): transitions by decaying offsets.
 *
 * At the switch the difference between the old and the new animation is stored for each joint, with its speed. From
 * then on only the new one is sampled, and the difference is added, decaying along a quintic that starts with that
 * speed and ends with zero speed and acceleration. It never grows and never overshoots. Rotation, translation and scale
 * are each a direction and a length.
 *
 * source  D. Bollo, "Inertialization: High-Performance Animation Transitions in Gears of War", GDC 2018
 *
 * Threads: pure functions of their arguments; any thread. */
#ifndef NOH_POSE_INERTIAL_INTERNAL_H
#define NOH_POSE_INERTIAL_INTERNAL_H

#include <stdint.h>

#include "noh/clip.h"
#include "core/base/assert_internal.h"

/* The offsets of one joint at the switch: 48 bytes. Speeds are along the vectors, per second, never positive. */
typedef struct noh_inertia_joint {
    float rotation[3], rotation_speed; /* axis times angle: source = rotation * target */
    float translation[3], translation_speed;
    float scale[3], scale_speed;
} noh_inertia_joint;

typedef struct noh_inertia_float {
    float offset, speed;
} noh_inertia_float;

/* Get the remainder at time t of an offset x0 >= 0 that begins with speed v0 <= 0: x0 at 0, 0 from the duration on.
 * units   seconds */
float noh_inertia_decay(float x0, float v0, float t, float duration);

/* Compute offsets from the poses at the switch and the poses `delta_s` seconds before it.
 * shapes  all [joint_count]
 * ranges  delta_s > 0 */
void noh_inertia_begin(uint32_t joint_count, const noh_transform *source, const noh_transform *source_before,
                       const noh_transform *target, const noh_transform *target_before, float delta_s,
                       noh_inertia_joint *out);
void noh_inertia_begin_floats(uint32_t count, const float *source, const float *source_before, const float *target,
                              const float *target_before, float delta_s, noh_inertia_float *out);

/* Add the remaining offsets to the pose, in place. */
void noh_inertia_apply(uint32_t joint_count, const noh_inertia_joint *joints, float elapsed_s, float duration_s,
                       noh_transform *pose);
void noh_inertia_apply_floats(uint32_t count, const noh_inertia_float *offsets, float elapsed_s, float duration_s,
                              float *floats);

#endif
