/* The finished mask at rest. */
#ifndef MASK_MASK_H
#define MASK_MASK_H

#include "mesh.h"

typedef struct {
    Model model;
    Frame frames[PART_COUNT];
    int *weld[PART_COUNT]; /* from mesh_weld */
} Mask;

void mask_build(Mask *mask);
void mask_free(Mask *mask);

#endif
