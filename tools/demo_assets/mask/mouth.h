/* Inside the mouth: teeth, tongue and the dark cup behind them. */
#ifndef MASK_MOUTH_H
#define MASK_MOUTH_H

#include "model.h"

void mouth_build(Model *model);
V3 teeth_place(const Seed *seed, const Pose *pose);
V3 tongue_place(const Seed *seed, const Pose *pose);
V3 bag_place(const Seed *seed, const Pose *pose);

/* How far a vertex of the cup follows the jaw, 0 to 1. */
double bag_jaw_weight(const Seed *seed);

#endif
