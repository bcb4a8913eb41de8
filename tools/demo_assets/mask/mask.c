#include "mask.h"

#include "colour.h"
#include "occlusion.h"

#include <stdlib.h>

void mask_build(Mask *mask)
{
    static const Pose rest;
    Model empty = { 0 };
    double *open[PART_COUNT];
    mask->model = empty;
    model_build(&mask->model);
    for (int i = 0; i < PART_COUNT; i++) {
        mask->weld[i] = mesh_weld(&mask->model.parts[i]);
        mask->frames[i] = mesh_frame(&mask->model.parts[i], mask->weld[i], &rest);
    }
    occlusion_bake(&mask->model, mask->frames, open);
    colour_bake(&mask->model, mask->frames, open);
    for (int i = 0; i < PART_COUNT; i++) {
        free(open[i]);
    }
}

void mask_free(Mask *mask)
{
    for (int i = 0; i < PART_COUNT; i++) {
        mesh_free(&mask->frames[i]);
        free(mask->weld[i]);
    }
    model_free(&mask->model);
}
