/* recipe_read.h: an artist's recipe as text: one row a line, CHANNEL TARGET [WEIGHT], or one corrective,
 * corrective TARGET DRIVER [PEAK] [DRIVER [PEAK]] ..., which makes one row for each driver: channel '+' and its name.
 * expression NAME TARGET [WEIGHT] makes a row of channel ':' and the name. override EMOTION-upper USER block|blend makes
 * a row of channel override-USER with the emotion for a target, binary EMOTION-upper one of channel binary; the name of
 * an expression above may stand for the emotion.
 * wrinkle TARGET REGION [WEIGHT] is a row of the table from expressions to wrinkle regions, color TARGET CHANNEL
 * [WEIGHT] one to regions of colour, and tint CHANNEL RRGGBB the colour of one. */
#ifndef NOH_CONVERT_BASE_RECIPE_READ_H
#define NOH_CONVERT_BASE_RECIPE_READ_H

#include <stddef.h>
#include <stdint.h>

#include "convert/base/error.h"

typedef struct recipe_row {
    char *target, *channel;
    float weight;
    uint32_t line;
} recipe_row;

/* How much a target wrinkles a region of the skin, or from NOH_WRINKLE_FOLDS on, colours it, 0..1. */
typedef struct wrinkle_row {
    char *target;
    uint32_t region, line;
    float weight;
} wrinkle_row;

typedef struct recipe_text {
    recipe_row *rows;
    wrinkle_row *wrinkles; /* for wrinkles_make; packs have the resulting table */
    uint32_t count, wrinkle_count;
    int is_full;       /* a row found no room */
    uint32_t tints[4]; /* colour of each region of colour: 0x1RRGGBB, sRGB; 0: none */
} recipe_text;

/* Channels of rows that name a joint of the face in place of a target. */
extern const char *const recipe_joint_channels[5];

recipe_text *recipe_new(void); /* NULL: out of memory */

/* Add the lines of a text. 0, or 1 with *line and *error; what was read before stays. */
int recipe_add_text(recipe_text *recipe, const char *text, size_t size, uint32_t *line, model_error *error);

/* Add one row. 0, or 1 when there are too many or memory is out, as recipe_fail says. */
int recipe_add_row(recipe_text *recipe, const char *target, const char *channel, float weight, uint32_t line);

int recipe_add_wrinkle(recipe_text *recipe, const char *target, uint32_t region, float weight, uint32_t line);

/* Why rows could not be added; NULL: out of memory. Returns 1. */
int recipe_fail(const recipe_text *recipe, model_error *error);

/* 0, or 1 with *line and *error; free in both cases. */
int recipe_read(const char *path, recipe_text **out, uint32_t *line, model_error *error);
void recipe_free(recipe_text *recipe);

#endif
