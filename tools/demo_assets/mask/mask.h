/* The finished mask at rest. */
#ifndef MASK_MASK_H
#define MASK_MASK_H

#include "figure.h"

Figure mask_build(void);

/* Where a seed of the mask's lies in a pose. */
V3 mask_place(const Seed *seed, const Pose *pose);

#endif
