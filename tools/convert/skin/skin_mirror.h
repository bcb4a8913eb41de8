/* skin_mirror.h (private to skins_bind): skins whose joints mirror their mesh in the rest pose.
 *
 * glTF winds triangles by the sign of the determinant that places them. For a skin that is the sign of each joint's
 * matrix times its inverse bind matrix: negative below a node of negative scale, or with a mirror among the inverse
 * bind matrices. Renderers know one winding for a skinned mesh, so the mesh is wound for where its joints put it. */
#ifndef NOH_CONVERT_SKIN_SKIN_MIRROR_H
#define NOH_CONVERT_SKIN_SKIN_MIRROR_H

#include "convert/model/model.h"

/* Where all joints of a skin mirror, its meshes and inverse bind matrices are mirrored too, and nothing is mirrored any
 * more. Where some do, triangles most of whose corners are mirrored are turned over, with a warning if a mesh has both
 * kinds of vertices. Returns 0, or 1 when out of memory. */
int skins_mirror(model *m);

#endif
