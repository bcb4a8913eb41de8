/* obj_read.h: Wavefront OBJ files as a model, with a folder of others as its morph targets.
 *
 * One mesh: positions, with colours where lines have them, normals, UVs and polygons, a submesh for each material;
 * groups and objects are not distinguished. Materials come from the .mtl file in its folder: diffuse colour and
 * texture, opacity, specular exponent. Vertices are never split or joined but by their UVs and normals, so that files
 * of the same positions in the same order are one face in different shapes, as sculptors and FaceKit write them. */
#ifndef NOH_CONVERT_OBJ_OBJ_READ_H
#define NOH_CONVERT_OBJ_OBJ_READ_H

#include "convert/model/model.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct obj_options {
    double unit_cm;      /* centimetres per unit of the files; 0: 100 */
    const char *targets; /* a folder: each other .obj file in it is a target of its name; NULL: none */
} obj_options;

/* Returns 0 and *out, or 1 and *error, with the line. Calls model_complete. */
int obj_read(const char *path, const obj_options *options, model **out, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
