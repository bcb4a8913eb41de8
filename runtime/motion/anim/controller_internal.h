/* controller_internal.h: the private part of clip.h. */
#ifndef NOH_ANIM_CONTROLLER_INTERNAL_H
#define NOH_ANIM_CONTROLLER_INTERNAL_H

#include "noh/base.h"
#include "noh/clip.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- memory ---- */

/* Check a block from outside, such as a saved game, before any other call. A block that passes cannot make a call
 * overrun its memory, overflow or hang. Transition offsets are not checked, so poses may still be meaningless.
 * errors  ARG memory NULL or misaligned; DATA not a controller for this set (where: the track or change) */
noh_result noh_controller_check(const void *memory, size_t bytes, const noh_clip_set *set, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
