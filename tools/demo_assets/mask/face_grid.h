/* The grid of the painted front, with slits for the eyes and the mouth. */
#ifndef MASK_FACE_GRID_H
#define MASK_FACE_GRID_H

#include "model.h"

enum { GRID_COLUMNS = 97, GRID_ROWS = 109 };
enum { GRID_BORDER = 2 * (GRID_COLUMNS + GRID_ROWS) - 4 };

void face_grid_build(Model *model);

/* Point `i` of the border, counter-clockwise seen from the front. */
Seed face_grid_border(int i);

#endif
