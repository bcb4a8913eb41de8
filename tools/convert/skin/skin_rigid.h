/* skin_rigid.h (private to skins_bind): rigid meshes in a bone hierarchy (rows C3.9, C3.10).
 *
 * A mesh without joints whose node is, or hangs below, a joint moves as that joint does. It becomes
 * a skinned mesh of one influence, its vertices where the rest pose puts them, in model space. All that one
 * skeleton moves so become one mesh, with one draw per material; a skinned mesh of that skeleton
 * joins them where that saves draws: all its materials are among theirs. */
#ifndef NOH_CONVERT_SKIN_RIGID_H
#define NOH_CONVERT_SKIN_RIGID_H

#include <stdio.h>

#include "convert/gltf/gltf_motion.h"

/* keep_parts: none are joined. report: NULL: quiet. Returns 0, or 1 when out of memory. */
int skin_rigid_meshes(model *m, motion *made, int keep_parts, FILE *report);

#endif
