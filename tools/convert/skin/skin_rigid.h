/* skin_rigid.h (private to skins_bind): rigid meshes in a joint hierarchy, such as the parts of a robot.
 *
 * A mesh without joints whose node is a joint, or hangs below one, moves with it. Drawing each part with its joint's
 * matrix (Granberg, Character Animation with Direct3D, chapter 3) costs a draw per part. Here a part becomes a skinned
 * mesh of one influence per vertex, placed in model space by the rest pose; all parts of one skeleton become one mesh
 * with one draw per material. A skinned mesh of that skeleton joins them where that saves draws: where all its
 * materials are among theirs. */
#ifndef NOH_CONVERT_SKIN_SKIN_RIGID_H
#define NOH_CONVERT_SKIN_SKIN_RIGID_H

#include <stdio.h>

#include "convert/clips/model_clips.h"

/* keep_parts: join none. report: NULL: quiet. Returns 0, or 1 when out of memory. */
int skin_rigid_meshes(model *m, model_clips *made, int keep_parts, FILE *report);

#endif
