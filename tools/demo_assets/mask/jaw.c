#include "jaw.h"

#include <math.h>

static const double hinge_y = -0.004, hinge_z = -0.045, full_angle = 0.20;

/* The skin between cheekbone and chin follows in part. At the mouth the lips part: the upper one stays, the lower one
 * follows fully, unless they are held closed, and at the corners both agree. */
double jaw_weight(FacePoint point, const Pose *pose)
{
    double skin = smooth(0.024, 0.092, -point.t);
    double from_line = point.t - mouth_line(point.s), width = mouth_gate(point.s, from_line);
    width *= 1 - clamp(pose->mouth_close, 0, 1);
    if (point.mouth > 0) {
        return skin * (1 - width * bump(from_line / 0.030));
    }
    return skin + (1 - skin) * width * bump(from_line / 0.040);
}

V3 jaw_move(V3 at, double weight, const Pose *pose)
{
    double angle = full_angle * (pose->jaw_open + 0.35 * pose->tongue_out + 0.30 * pose->funnel);
    double y = at.y - hinge_y, z = at.z - hinge_z;
    V3 turned = v3(at.x + 0.0085 * pose->jaw_side, hinge_y + y * cos(angle) - z * sin(angle),
                   hinge_z + z * cos(angle) + y * sin(angle) + 0.0070 * pose->jaw_forward);
    return v3_add(at, v3_scale(v3_sub(turned, at), weight));
}
