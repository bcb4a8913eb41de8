/* Visible wood: the rim around the paint and the hollow back. */
#ifndef MASK_WOOD_H
#define MASK_WOOD_H

#include "model.h"

void wood_build(Model *model);
V3 rim_place(const Seed *seed, const Pose *pose);
V3 back_place(const Seed *seed, const Pose *pose);

/* How close a vertex of the back is to the rim: 1 at the rim, 0 in the middle. */
double back_share(const Seed *seed);

#endif
