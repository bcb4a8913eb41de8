/* two_stream.h: two meshes of one shape, the second as a morph target of the first.
 *
 * The classic method binds two vertex streams and mixes them in the shader. Here the difference of the second mesh from
 * the first becomes a target with the second's name, is encoded and accumulated like any other, and is driven by one
 * weight (clip.h). */
#ifndef NOH_CONVERT_MODEL_TWO_STREAM_H
#define NOH_CONVERT_MODEL_TWO_STREAM_H

#include "model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* pair: "SOURCE=TARGET", names of two meshes. Both need the same triangles over the same vertices, in the same order;
 * an optimiser that sorts each mesh for itself breaks the correspondence. Only positions, normals and tangents of the
 * second are used, and it is no longer drawn. 0, or 1 and a filled error. */
int two_stream_join(model *m, const char *pair, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
