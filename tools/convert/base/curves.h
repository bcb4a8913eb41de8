/* curves.h: curves of a glTF file, such as the control hairs of a groom: its lines, in the scene's space. */
#ifndef NOH_CONVERT_BASE_CURVES_H
#define NOH_CONVERT_BASE_CURVES_H

#include <stdint.h>

#include "convert/base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

#define CURVES_MAX 65536u

typedef struct curve_list {
    float *points;    /* [starts[count]][3] from root to tip */
    uint32_t *starts; /* [count + 1] */
    uint32_t count;
} curve_list;

/* A primitive of mode LINE_STRIP is a curve, and one of mode LINES a curve for each chain of segments. What cannot be
 * read is left out. 0, or 1 and the error, also where the file has no curve. Free in both cases. */
int curves_read(const char *path, curve_list *out, model_error *error);
void curves_free(curve_list *curves);

#ifdef __cplusplus
}
#endif
#endif
