/* What the puppet is painted with. */
#ifndef PUPPET_PAINT_H
#define PUPPET_PAINT_H

#include "shared/maths.h"

/* A part of the body for each material. */
enum { MATERIAL_CLOTH, MATERIAL_SKIN, MATERIAL_HAIR, MATERIAL_COUNT };

typedef enum {
    PAINT_RED, /* the robe is woven in blocks of two colours */
    PAINT_IVORY,
    PAINT_COLLAR,
    PAINT_UNDER, /* what shows in the neck of the robe */
    PAINT_LINING,
    PAINT_SASH,
    PAINT_CORD,
    PAINT_SKIRT, /* the hakama */
    PAINT_SKIRT_HEM,
    PAINT_SKIRT_INSIDE,
    PAINT_SOCK,
    PAINT_BAND, /* about the hair */
    PAINT_SKIN,
    PAINT_HAIR,
    PAINT_COAT /* of coat.c */
} Paint;

int paint_material(Paint paint);

/* Linear. open: how open the vertex is to light, 0 to 1. */
V3 paint_colour(Paint paint, V3 at, double open);

#endif
