/* identity_join.h: the targets of another file's mesh, of the same vertices, as targets that make people
 * (face.h): characters are often modelled with the expressions in one file and the people in another.
 */
#ifndef NOH_CONVERT_MODEL_IDENTITY_JOIN_H
#define NOH_CONVERT_MODEL_IDENTITY_JOIN_H

#include "model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Read a .gltf or .glb file and append the targets of its meshes to those meshes of `m` that have the same triangles
 * and rest positions. Weights, and animations of weights, grow by zeros.
 * errors  1: the file cannot be read, no mesh fits, or a name occurs twice; the error names the file */
int identity_join(model *m, const char *path, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
