/* Left and right: the character's own left is +x. */
#ifndef MASK_SIDES_H
#define MASK_SIDES_H

enum { LEFT, RIGHT, SIDES };

/* +1 for the left, -1 for the right. */
double side_sign(int side);

#endif
