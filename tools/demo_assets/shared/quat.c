#include "quat.h"

#include <math.h>

Quat quat_none(void)
{
    Quat q = { 0, 0, 0, 1 };
    return q;
}

Quat quat_about(V3 axis, double angle)
{
    double s = sin(angle / 2);
    Quat q = { s * axis.x, s * axis.y, s * axis.z, cos(angle / 2) };
    return q;
}

Quat quat_turn(V3 angles)
{
    Quat x = quat_about(v3(1, 0, 0), angles.x), y = quat_about(v3(0, 1, 0), angles.y);
    return quat_multiply(y, quat_multiply(x, quat_about(v3(0, 0, 1), angles.z)));
}

Quat quat_multiply(Quat a, Quat b)
{
    Quat q = { a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
               a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z };
    return q;
}

Quat quat_inverse(Quat q)
{
    Quat back = { -q.x, -q.y, -q.z, q.w };
    return back;
}

V3 quat_rotate(Quat q, V3 v)
{
    V3 axis = v3(q.x, q.y, q.z), cross = v3_scale(v3_cross(axis, v), 2);
    return v3_add(v3_add(v, v3_scale(cross, q.w)), v3_cross(axis, cross));
}

Quat quat_between(V3 from, V3 to, double limit)
{
    V3 axis = v3_cross(from, to);
    double sine = v3_length(axis), angle = atan2(sine, v3_dot(from, to));
    if (sine < 1e-9) {
        return quat_none();
    }
    return quat_about(v3_scale(axis, 1 / sine), angle < limit ? angle : limit);
}

/* From the axes x, y and z of a frame; the largest member first, for precision. */
static Quat from_axes(V3 x, V3 y, V3 z)
{
    double members[4] = { 1 + x.x - y.y - z.z, 1 - x.x + y.y - z.z, 1 - x.x - y.y + z.z, 1 + x.x + y.y + z.z };
    int largest = 0;
    for (int i = 1; i < 4; i++) {
        largest = members[i] > members[largest] ? i : largest;
    }
    double twice = sqrt(members[largest]), k = 0.5 / twice;
    double a = y.z - z.y, b = z.x - x.z, c = x.y - y.x, d = x.y + y.x, e = x.z + z.x, f = y.z + z.y;
    Quat by_x = { 0.5 * twice, k * d, k * e, k * a }, by_y = { k * d, 0.5 * twice, k * f, k * b };
    Quat by_z = { k * e, k * f, 0.5 * twice, k * c }, by_w = { k * a, k * b, k * c, 0.5 * twice };
    return largest == 0 ? by_x : largest == 1 ? by_y : largest == 2 ? by_z : by_w;
}

static Quat frame_of(V3 ahead, V3 side)
{
    V3 z = v3_unit(v3_cross(ahead, side));
    return from_axes(ahead, v3_cross(z, ahead), z);
}

Quat quat_align(V3 a, V3 side_a, V3 b, V3 side_b)
{
    return quat_multiply(frame_of(b, side_b), quat_inverse(frame_of(a, side_a)));
}
