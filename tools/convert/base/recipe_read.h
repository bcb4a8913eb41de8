/* recipe_read.h: an artist's recipe as text: one row a line, CHANNEL TARGET [WEIGHT]. */
#ifndef NOH_CONVERT_BASE_RECIPE_READ_H
#define NOH_CONVERT_BASE_RECIPE_READ_H

#include <stdint.h>

#include "convert/base/error.h"

typedef struct recipe_row {
    char *target;
    const char *channel; /* a constant */
    float weight;
    uint32_t line;
} recipe_row;

typedef struct recipe_text {
    recipe_row *rows;
    uint32_t count;
} recipe_text;

/* 0, or 1 with *line and *error; free in both cases. */
int recipe_read(const char *path, recipe_text **out, uint32_t *line, model_error *error);
void recipe_free(recipe_text *recipe);

#endif
