/* priority.h: in which order what blends is drawn. */
#ifndef NOH_CONVERT_MODEL_PRIORITY_H
#define NOH_CONVERT_MODEL_PRIORITY_H

#include "model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --priority MATERIAL=N, for all materials of that name. 1 with the error: no material has the name, or N is no whole
 * number from -128 to 127. */
int priority_assign(model *m, const char *assignment, model_error *error);

#ifdef __cplusplus
}
#endif

#endif
