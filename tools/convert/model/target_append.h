/* target_append.h: more targets for a mesh of a model. */
#ifndef NOH_CONVERT_MODEL_TARGET_APPEND_H
#define NOH_CONVERT_MODEL_TARGET_APPEND_H

#include "model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Move the targets of `b`, which has the same vertices, to a mesh of the model: b has none afterwards. Weights, and
 * animations of weights, grow by zeros. 0, or 1 when out of memory. */
int model_append_targets(model *m, uint32_t mesh, model_mesh *b);

#ifdef __cplusplus
}
#endif
#endif
