/* sheet_data.h: the data textures of morph targets: base, deltas, sums. */
#ifndef NOH_NOH_SHEET_SHEET_DATA_H
#define NOH_NOH_SHEET_SHEET_DATA_H

#include "sheet_tiles.h"

typedef struct sheet_data {
    const sheet_tiles *tiles; /* whose targets are shown */
    const char *output;
    uint32_t tile,
        columns; /* tile: the side that a layer fills as far as whole pixels allow; columns 0: about square */
} sheet_data;

/* For each mesh that targets move, three pictures a page (draw/data_page.h): the base, each target's deltas, and the
 * sum of the targets at their weights. A texel is a square of whole pixels. Prints an error and returns an
 * exit code; 0 on success. */
int sheet_data_write(const sheet_data *s);

#endif
