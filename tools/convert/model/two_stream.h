/* two_stream.h: two meshes of one shape, the second as a morph target of the first (rows D1-D9).
 *
 * In place of two vertex streams that a shader mixes: the second mesh's difference from the
 * first becomes a target with its name, goes through the same encoder and accumulation, and is
 * played by one weight (runtime/anim/ping_pong.h). */
#ifndef NOH_CONVERT_TWO_STREAM_H
#define NOH_CONVERT_TWO_STREAM_H

#include "model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* pair: "SOURCE=TARGET", names of two meshes. They need the same triangles over the same vertices, in the same order
 * (row D8); attributes of the second other than positions, normals and tangents are not used (row D2). It is then
 * drawn no more. 0, or 1 and a filled error. */
int two_stream_join(model *m, const char *pair, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
