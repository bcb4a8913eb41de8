/* The ears: relief on a tilted disc, closed behind. */
#ifndef MASK_EAR_H
#define MASK_EAR_H

#include "model.h"

void ears_build(Model *model);
V3 ear_place(const Seed *seed);

#endif
