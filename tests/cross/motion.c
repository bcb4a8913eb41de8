/* motion.c: stands in for the C++ side of the converter: a model has no motion here. Tests that want any are left out. */
#include <stdlib.h>

#include "convert/gltf/gltf_motion.h"

int motion_from_model(model *m, const motion_options *options, motion **out, model_error *error)
{
    (void)m;
    (void)options;
    (void)error;
    *out = calloc(1, sizeof **out);
    return *out == NULL;
}

void motion_free(motion *made)
{
    free(made);
}
