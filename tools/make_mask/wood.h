/* The wood that shows: the rim around the paint and the hollowed back. */
#ifndef MASK_WOOD_H
#define MASK_WOOD_H

#include "model.h"

void wood_build(Model *model);
V3 rim_place(const Seed *seed, const Pose *pose);
V3 back_place(const Seed *seed, const Pose *pose);

#endif
