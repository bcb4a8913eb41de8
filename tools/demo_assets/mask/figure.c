#include "figure.h"

#include <stdlib.h>

void figure_place(Figure *figure)
{
    static const Pose rest;
    for (int i = 0; i < figure->model.part_count; i++) {
        figure->weld[i] = mesh_weld(&figure->model.parts[i]);
        figure->frames[i] = mesh_frame(&figure->model.parts[i], figure->weld[i], &rest);
    }
}

void figure_free(Figure *figure)
{
    for (int i = 0; i < figure->model.part_count; i++) {
        mesh_free(&figure->frames[i]);
        free(figure->weld[i]);
    }
    model_free(&figure->model);
}
