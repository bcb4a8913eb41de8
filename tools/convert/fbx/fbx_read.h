/* fbx_read.h: FBX files as a model: versions 6.0 to 7.7, binary (either byte order) and ASCII.
 *
 * Meshes, skins, blend shapes with masks and in-betweens, materials with pictures, and one clip for each take, with
 * pivots, inherit types, layers and all kinds of curves, sampled at the file's frames. Axes and the unit are the file's
 * own: it becomes metres, Y up. What is left out or changed is a warning. The scene becomes a .glb in memory, which is
 * read as any other. */
#ifndef NOH_CONVERT_FBX_FBX_READ_H
#define NOH_CONVERT_FBX_FBX_READ_H

#include "convert/model/model.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct fbx_options {
    double unit_cm;           /* centimetres per unit; 0: the file's */
    const extra_list *extras; /* further sets of texture coordinates: TEXCOORD_1 is the file's second; NULL: none */
} fbx_options;

/* Returns 0 and *out, or 1 and *error. Calls model_complete. */
int fbx_read(const char *path, const fbx_options *options, model **out, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
