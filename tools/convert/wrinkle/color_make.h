/* color_make.h: gives meshes colours by target: a painted map of four regions, a colour for each, and how much each
 * target shows it. */
#ifndef NOH_CONVERT_WRINKLE_COLOR_MAKE_H
#define NOH_CONVERT_WRINKLE_COLOR_MAKE_H

#include <stdio.h>

#include "convert/base/recipe_read.h"
#include "convert/model/model.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct color_settings {
    const char *map;           /* a picture: r, g, b, a are how far each region covers the texel; NULL: no colours */
    const char *material;      /* name of the material; NULL: of each mesh the one of the most triangles */
    const recipe_text *recipe; /* rows `color` and `tint`; NULL: none */
    FILE *report;              /* NULL: quiet */
} color_settings;

/* Add colours to each mesh whose targets the recipe has `color` rows of. A mesh that cannot have colours gives a warning
 * of the model; if none can, that is an error. Returns 0, or 1 and *error. */
int colors_make(model *m, const color_settings *settings, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
