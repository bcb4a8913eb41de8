/* sheet_wrinkles.h: the same expressions without wrinkles, and with each wrinkle model, one row each. */
#ifndef NOH_NOH_SHEET_SHEET_WRINKLES_H
#define NOH_NOH_SHEET_SHEET_WRINKLES_H

#include "draw/figure.h"
#include "noh/pack.h"

#define SHEET_WRINKLE_ROWS 5u
#define SHEET_WRINKLE_FACES 5u /* emotions, where no targets are asked for */

typedef struct sheet_wrinkles {
    const option_list *faces; /* NAME[=V][,NAME[=V]]...: a column each; none: emotions */
    noh_mesh mesh;            /* the first one with wrinkles */
    const char **names;       /* [target_count] */
    float *weights;           /* [target_count] */
} sheet_wrinkles;

/* Prints an error and returns an exit code; 0 on success. */
int sheet_wrinkles_open(sheet_wrinkles *s, const pack_file *file, const option_list *faces);
void sheet_wrinkles_close(sheet_wrinkles *s);

uint32_t sheet_wrinkles_columns(const sheet_wrinkles *s);
/* Hold the weights of a tile; tiles are counted row by row. */
int sheet_wrinkles_hold(const sheet_wrinkles *s, figure *f, uint32_t tile);
void sheet_wrinkles_label(const sheet_wrinkles *s, uint32_t tile, char *text, size_t bytes);

#endif
