/* wrinkle_make.h: gives meshes wrinkles: a normal map, three maps of twelve regions, and how much each target wrinkles
 * each of them; out of the targets themselves, or painted. */
#ifndef NOH_CONVERT_WRINKLE_WRINKLE_MAKE_H
#define NOH_CONVERT_WRINKLE_WRINKLE_MAKE_H

#include <stdio.h>

#include "convert/base/recipe_read.h"
#include "convert/model/model.h"
#include "region_mask.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { WRINKLES_OFF, WRINKLES_OF_ALL, WRINKLES_OF_FACES };

typedef struct wrinkle_settings {
    int automatic;    /* WRINKLES_*: the meshes that get maps that are generated; with painted ones all meshes get them */
    const char *map;  /* a painted normal map, tangent space, +y up; NULL: generated */
    const char *mask; /* a painted region mask (region_mask.h); NULL: generated */
    uint32_t models;  /* NOH_WRINKLE_BY_* of format.h: what shows them; 0: regions, and area where there are no folds */
    int by_pixel;     /* 1: pixels read a mask of codes, texel by texel; else vertices read its weights, filtered */
    uint32_t size;    /* side of a generated normal map, texels, 64 or more; 0: as creases want it */
    uint32_t mask_size;        /* side of a generated mask; 0: as it is read */
    region_mask *kept;         /* of no texels; takes the mask of the first mesh that gets wrinkles. NULL: nowhere */
    const recipe_text *recipe; /* which targets blink and smile; wrinkle rows override the measurement; NULL: none */
    FILE *report;              /* NULL: quiet */
} wrinkle_settings;

/* Add wrinkles to the material of each mesh that targets compress the most. Meshes without possible wrinkles give a
 * warning of the model; if no mesh can have wrinkles, that is an error, unless only faces get them: then all others are
 * left as they are. Does nothing if the settings request none.
 * Returns 0, or 1 and *error. */
int wrinkles_make(model *m, const wrinkle_settings *settings, model_error *error);

/* Whether a recipe, which may be NULL, has rows of `count` regions from `first` on. */
int wrinkle_has_rows(const recipe_text *recipe, uint32_t first, uint32_t count);

/* Append a texture named "MESH WHAT" to the model, which takes *rgba and leaves NULL there.
 * clamped  for s and t, 1: clamped at the edges, 0: repeated
 * Returns 0, or 1: out of memory. */
int wrinkle_add_texture(model *m, const char *mesh, const char *what, uint8_t **rgba, uint32_t width, uint32_t height,
                        const uint8_t clamped[2], model_texture_use use);

#ifdef __cplusplus
}
#endif
#endif
