/* lod_fit.h: vertices of their own for coarse levels.
 *
 * A level whose vertices are a subset of the full mesh's lies inside of round shapes: corners touch the surface, and
 * everything between them is below it. Vertices that may lie off the surface halve that distance. They cost
 * memory, since no finer level uses them, so only coarse levels have them: a level with a tenth of the triangles adds
 * about a tenth to the mesh's vertices and deltas.
 *
 * source  Hoppe, DeRose, Duchamp, McDonald and Stuetzle, "Mesh Optimization" (1993), which moves vertices by least
 * squares between collapses; here once, after them, in every pose, and by a high power of the distances, because a
 * level is chosen by its largest. */
#ifndef NOH_CONVERT_LOD_LOD_FIT_H
#define NOH_CONVERT_LOD_LOD_FIT_H

#include "lod.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LOD_OWN_SHARE 0.25f /* of the mesh's vertices, by default the most that levels may have of their own */

/* Give a level vertices of its own, appended to the mesh: copies of those that it used, moved so that the largest
 * distances to the full mesh get smaller, at rest, with each target at full weight and in mixes. Points that targets
 * take apart keep their place, and what hardly moves is not copied.
 * mesh    owns its arrays; its triangles stay as they are
 * memory  about 300 bytes for each vertex and each triangle of the mesh, for as long as it takes
 * errors  1 and *error: out of memory; mesh and level are as they were */
int lod_fit(model_mesh *mesh, lod_level *level, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
