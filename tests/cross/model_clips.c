/* model_clips.c: stands in for the C++ side of the converter: no model has clips here. Tests that need one are left
 * out. */
#include <stdlib.h>

#include "convert/clips/model_clips.h"

int clips_from_model(model *m, const sample_options *options, model_clips **out, model_error *error)
{
    (void)m;
    (void)options;
    (void)error;
    *out = calloc(1, sizeof **out);
    return *out == NULL;
}

void model_clips_free(model_clips *made)
{
    free(made);
}
