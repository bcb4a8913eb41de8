/* skin_mirror.h: skins whose joints mirror their mesh, in the rest pose or in a clip.
 *
 * glTF winds triangles by the sign of the determinant that places them. For a skin that is the sign of each joint's
 * matrix times its inverse bind matrix: negative below a node of negative scale, or with a mirror among the inverse
 * bind matrices. Renderers know one winding for a skinned mesh, so the mesh is wound for where its joints put it. */
#ifndef NOH_CONVERT_SKIN_SKIN_MIRROR_H
#define NOH_CONVERT_SKIN_SKIN_MIRROR_H

#include "convert/clips/raw_clip.h"
#include "convert/model/model.h"

/* Where all joints of a skin mirror, its meshes and inverse bind matrices are mirrored too, and nothing is mirrored any
 * more. Where some do, triangles most of whose corners are mirrored are turned over, with a warning if a mesh has both
 * kinds of vertices. Returns 0, or 1 when out of memory. */
int skins_mirror(model *m);

/* Warn of each clip that mirrors a joint that is not mirrored in the rest pose, or the reverse, if a material of the
 * model culls faces: winding is the rest pose's. Returns 0, or 1 when out of memory. */
int clips_mirror_warn(model *m, raw_set *const *sets, uint32_t set_count);

#endif
