/* A finished figure at rest: the mask, or the head of nell/. */
#ifndef MASK_FIGURE_H
#define MASK_FIGURE_H

#include "animate.h"
#include "mesh.h"

typedef struct {
    const char *name;
    double roughness;
} FigureMaterial;

typedef struct {
    const char *name;
    const FigureMaterial *materials; /* of the parts */
    int target_count;                /* the first ones of targets.h */
    int animation_count;
    Animation (*animation)(int number);
    Model model;
    Frame frames[PARTS_MAX];
    int *weld[PARTS_MAX]; /* from mesh_weld */
} Figure;

/* Welds the parts of the figure's model and places them at rest. */
void figure_place(Figure *figure);
void figure_free(Figure *figure);

#endif
