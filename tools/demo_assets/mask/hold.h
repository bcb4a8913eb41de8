/* The weights of the mask's vertices on a skeleton's jaw. */
#ifndef MASK_HOLD_H
#define MASK_HOLD_H

#include "model.h"

/* How far the vertex follows the jaw, 0 to 1; the rest stays with the head. */
double jaw_hold(const Seed *seed);

#endif
