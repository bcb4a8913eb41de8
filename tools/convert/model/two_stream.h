/* two_stream.h: two meshes of one shape, the second as a morph target of the first.
 *
 * The classic way binds two vertex streams and mixes them in the shader. Here the second mesh's difference from the
 * first becomes a target with its name, goes through the same encoder and accumulation, and is played by one weight
 * (runtime/anim/ping_pong.h). */
#ifndef NOH_CONVERT_MODEL_TWO_STREAM_H
#define NOH_CONVERT_MODEL_TWO_STREAM_H

#include "model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* pair: "SOURCE=TARGET", names of two meshes. They need the same triangles over the same vertices, in the same order:
 * an optimiser that sorted each mesh for itself would have broken the correspondence. Only positions, normals and
 * tangents of the second are used. It is then no longer drawn. 0, or 1 and a filled error. */
int two_stream_join(model *m, const char *pair, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
