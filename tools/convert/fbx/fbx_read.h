/* fbx_read.h: FBX files as a model, by Assimp where the build found it.
 *
 * Meshes, skins, blend shapes, materials with their pictures, and animations of nodes and of shapes. Axes and the unit
 * are the file's own: it becomes metres, Y up. Assimp runs in a process of its own and hands over a .glb, which is read
 * as any other: a damaged file that breaks Assimp off is refused, and breaks nothing else. */
#ifndef NOH_CONVERT_FBX_FBX_READ_H
#define NOH_CONVERT_FBX_FBX_READ_H

#include "convert/model/model.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct fbx_options {
    double unit_cm; /* centimetres per unit; 0: the file's */
} fbx_options;

/* Returns 0 and *out, or 1 and *error. Calls model_complete. */
int fbx_read(const char *path, const fbx_options *options, model **out, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
