/* An upright cylinder about the y axis, with ends, and what its joints hold of it. */
#ifndef ARM_TUBE_H
#define ARM_TUBE_H

#include "shape.h"

enum { TUBE_STEPS = 4, TUBE_BLOCKS = 16, TUBE_SIDES = 2 };

typedef struct {
    double low, high, radius; /* metres; round ends reach one radius further */
    int flat_low, flat_high;  /* cut off, where another part continues */
    int bands;                /* of squares between the ends */
    int joint_count;          /* 1, 2 or 4: how many hold each vertex at most */
    double joint_at[HOLDERS]; /* their heights; the first one's is `low` */
    double overlap;           /* of two joints: they share vertices up to this distance on both sides of the second */
} Tube;

Shape tube_build(const Tube *tube, const Dye *dye);

#endif
