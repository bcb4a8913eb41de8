/* light_pose.h: the pose in which moving occlusion is measured: options, or targets that faces have in common. */
#ifndef NOH_NOH_LIGHT_LIGHT_POSE_H
#define NOH_NOH_LIGHT_LIGHT_POSE_H

#include "cli/args.h"
#include "noh/pack.h"

/* weights[target_count] of a mesh. Without assignments ("NAME=V", as --weight takes them): the targets whose names
 * speak of an open jaw or mouth, of brows that go down, of mouth corners that are pulled or smile, at 1; if none does,
 * the four that move the farthest. */
void light_pose(const noh_mesh *mesh, const option_list *assignments, float *weights);

#endif
