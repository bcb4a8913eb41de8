/* Surfaces with a chequered skin, so that stretching and twisting show. */
#ifndef ARM_SHAPE_H
#define ARM_SHAPE_H

#include "shared/maths.h"

#include <stdint.h>

enum { HOLDERS = 4 };

/* A point of a surface. weight: of the joints 0 to 3, whole multiples of 1/65536, so that as floats too they sum to
 * exactly 1. */
typedef struct {
    V3 at, normal;
    double weight[HOLDERS];
} Place;

/* Colours, linear. `end`: of the first and the last band. */
typedef struct {
    V3 light, dark, end;
} Dye;

/* A surface over rows and sides: `bands` of `steps` rows each, and around it `blocks` of `sides` each. A square of
 * the pattern is a band of a block; its border vertices are its own, so that colours end sharply. */
typedef struct {
    int bands, steps, blocks, sides;
    /* side runs from 0 to blocks * sides - 1, counter-clockwise seen from where the bands go to. Where neighbouring
     * bands meet, their positions are equal to the bit. */
    Place (*place)(const void *what, int band, int step, int side);
    const void *what;
    Dye dye;
} Grid;

typedef struct {
    int count, index_count;
    V3 *position, *normal, *colour;
    double *weight; /* HOLDERS for each vertex */
    uint32_t *indices;
} Shape;

Shape shape_build(const Grid *grid);
void shape_free(Shape *shape);

#endif
