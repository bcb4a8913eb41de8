/* controller_internal.h: the private part of clip.h. */
#ifndef NOH_ANIM_CONTROLLER_INTERNAL_H
#define NOH_ANIM_CONTROLLER_INTERNAL_H

#include "noh/base.h"
#include "noh/clip.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_CONTROLLER_INERTIAL 1u /* reserve memory for inertial transitions: 48 bytes per joint, 8 per float */
/* the last step passed more than NOH_STEP_EVENTS_MAX keys; the rest were not delivered */
#define NOH_CONTROLLER_EVENTS_CUT 2u
/* Weights with a sum below 1 cover only partly: the high group covers the pose of the low group, and floats cover their
 * defaults. So a group fades in and out with the weights of its tracks. Without this flag weights are relative. Weights
 * of joints in the low group are always relative. */
#define NOH_CONTROLLER_COVERS 4u

/* ---- memory ---- */

/* Bytes to copy to clone or save a controller. Align the copy to NOH_MEMORY_ALIGN too. */
size_t noh_controller_bytes(const noh_controller *c);

/* Check a block from outside, such as a saved game, before any other call. A block that passes cannot make a call
 * overrun its memory, overflow or hang. Transition offsets are not checked, so poses may still be meaningless.
 * errors  ARG memory NULL or misaligned; DATA not a controller for this set (where: the track or change) */
noh_result noh_controller_check(const void *memory, size_t bytes, const noh_clip_set *set, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
