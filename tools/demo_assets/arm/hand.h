/* Two shapes of the same vertices: a fist (a ball) and an open hand (a star of five fingers). */
#ifndef ARM_HAND_H
#define ARM_HAND_H

#include "shape.h"

/* open: 0 or 1. The radius of the fist is 0.3 m. */
Shape hand_shape(int open, const Dye *dye);

#endif
