/* The painted hair. */
#ifndef MASK_HAIR_H
#define MASK_HAIR_H

#include "model.h"

/* Distance in metres, roughly, past the hairline: negative on the bare face. */
double hair_past(double s, double t);

/* Moves a point of the face plane outwards from the middle by `distance`. */
void hair_shift(double *s, double *t, double distance);

/* Brush strokes laid over the paint, for edges finer than the face's grid. */
void hair_build(Model *model);
V3 stroke_place(const Seed *seed, const Pose *pose);

#endif
