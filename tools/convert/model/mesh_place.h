/* mesh_place.h: where nodes and joints put a mesh, in the rest pose. */
#ifndef NOH_CONVERT_MODEL_MESH_PLACE_H
#define NOH_CONVERT_MODEL_MESH_PLACE_H

#include "convert/model/model.h"

#define MESH_PLACES_MAX 16u

/* For each node that draws the mesh, what moves the vertex to the world; at least one, at most MESH_PLACES_MAX. Of the
 * turns of joints only right angles are left, each about its joint, from the root on: the rest pose may tilt a head or
 * turn an eye, the bind pose does not.
 * returns  their count */
uint32_t mesh_places(const model *m, uint32_t mesh, uint32_t vertex, double out[MESH_PLACES_MAX][16]);

/* Skinned meshes take the axes that the world has in the rest pose: files of programs whose z points up have a turn in
 * their joints, and up, ahead, left and right of a mesh's own space would be wrong. Vertices turn by the right angles of
 * the skeleton's topmost joint, the skins' matrices turn back: the figure does not move. Skins whose meshes others draw,
 * too, stay, and those below a topmost joint that leans from all axes.
 * errors  1: out of memory */
int meshes_upright(model *m);

#endif
