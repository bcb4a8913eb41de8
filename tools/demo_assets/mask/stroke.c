#include "stroke.h"

#include "shared/sides.h"

void drag(V3 *shift, double s, double t, int side, double pull, Stroke stroke)
{
    if (pull == 0) {
        return;
    }
    double sign = side_sign(side);
    double k = pull * bump2(sign * s - stroke.x, t - stroke.y, stroke.rx, stroke.ry);
    *shift = v3_add(*shift, v3(k * sign * stroke.dx, k * stroke.dy, k * stroke.dz));
}
