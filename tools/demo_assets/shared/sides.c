#include "sides.h"

double side_sign(int side)
{
    return side == LEFT ? 1 : -1;
}
