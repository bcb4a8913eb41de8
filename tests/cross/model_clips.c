/* model_clips.c: replaces the C++ side of the converter: no model has clips here, and no file curves. Tests that
 * need one are left out. */
#include <stdio.h>
#include <stdlib.h>

#include "convert/base/curves.h"
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

int curves_read(const char *path, curve_list *out, model_error *error)
{
    (void)path;
    (void)out;
    (void)snprintf(error->what, sizeof error->what, "glTF is not read here");
    return 1;
}

void curves_free(curve_list *curves)
{
    (void)curves;
}
