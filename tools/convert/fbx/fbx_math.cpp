/* fbx_math.cpp: affine transforms and rotations. */
#include "fbx_math.h"

#include <algorithm>

namespace fbx
{

/* --- matrices --- */

mat operator*(const mat &a, const mat &b)
{
    mat out;
    for (int i = 0; i < 3; ++i) out.column[i] = a.direction(b.column[i]);
    out.column[3] = a.point(b.column[3]);
    return out;
}

double determinant(const mat &m)
{
    return dot(m.column[0], cross(m.column[1], m.column[2]));
}

mat inverse(const mat &m)
{
    const double det = determinant(m);
    mat out;
    if (!(std::fabs(det) > 1e-200)) return out;
    for (int row = 0; row < 3; ++row) {
        const vec v = cross(m.column[(row + 1) % 3], m.column[(row + 2) % 3]) * (1.0 / det);
        for (int i = 0; i < 3; ++i) out.column[i][row] = v[i];
    }
    out.column[3] = out.direction(m.column[3]) * -1.0;
    return out;
}

mat translation(const vec &t)
{
    mat out;
    out.column[3] = t;
    return out;
}

mat scaling(const vec &s)
{
    mat out;
    for (int i = 0; i < 3; ++i) out.column[i][i] = s[i];
    return out;
}

mat rotation(const quat &q)
{
    mat m;
    m.column[0] = { { 1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y + q.w * q.z), 2 * (q.x * q.z - q.w * q.y) } };
    m.column[1] = { { 2 * (q.x * q.y - q.w * q.z), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z + q.w * q.x) } };
    m.column[2] = { { 2 * (q.x * q.z + q.w * q.y), 2 * (q.y * q.z - q.w * q.x), 1 - 2 * (q.x * q.x + q.y * q.y) } };
    return m;
}

/* --- quaternions --- */

quat operator*(const quat &a, const quat &b)
{
    return { a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
             a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z };
}

quat conjugate(const quat &q)
{
    return { -q.x, -q.y, -q.z, q.w };
}

/* From the largest of the four parts, which is well away from zero. */
quat quaternion(const mat &m)
{
    const double x = m.column[0][0], y = m.column[1][1], z = m.column[2][2];
    const double yz = m.column[1][2], zy = m.column[2][1], zx = m.column[2][0], xz = m.column[0][2];
    const double xy = m.column[0][1], yx = m.column[1][0];
    if (x + y + z > 0.0) {
        const double s = std::sqrt(x + y + z + 1.0) * 2.0;
        return { (yz - zy) / s, (zx - xz) / s, (xy - yx) / s, s / 4.0 };
    }
    if (x > y && x > z) {
        const double s = std::sqrt(1.0 + x - y - z) * 2.0;
        return { s / 4.0, (yx + xy) / s, (zx + xz) / s, (yz - zy) / s };
    }
    if (y > z) {
        const double s = std::sqrt(1.0 + y - x - z) * 2.0;
        return { (yx + xy) / s, s / 4.0, (zy + yz) / s, (zx - xz) / s };
    }
    const double s = std::sqrt(1.0 + z - x - y) * 2.0;
    return { (zx + xz) / s, (zy + yz) / s, s / 4.0, (xy - yx) / s };
}

quat euler(const vec &degrees, int64_t order)
{
    static const int letters[6][3] = { { 0, 1, 2 }, { 0, 2, 1 }, { 1, 2, 0 }, { 1, 0, 2 }, { 2, 0, 1 }, { 2, 1, 0 } };
    quat q;
    for (int axis : letters[order < 0 || order > 5 ? 0 : order]) {
        const double half = degrees[axis] / degrees_per_radian / 2.0;
        if (half == 0.0) continue;
        quat turn{ 0.0, 0.0, 0.0, std::cos(half) };
        (axis == 0 ? turn.x : axis == 1 ? turn.y : turn.z) = std::sin(half);
        q = turn * q;
    }
    return q;
}

vec angles(const quat &q)
{
    const mat m = rotation(q);
    const double sine = std::min(std::max(-m.column[0][2], -1.0), 1.0);
    vec out;
    out[1] = std::asin(sine);
    if (std::fabs(sine) < 1.0 - 1e-12) {
        out[0] = std::atan2(m.column[1][2], m.column[2][2]);
        out[2] = std::atan2(m.column[0][1], m.column[0][0]);
    } else {
        out[0] = std::atan2(-m.column[2][1], m.column[1][1]);
    }
    return out * degrees_per_radian;
}

quat slerp(const quat &a, const quat &b, double share)
{
    double cosine = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
    const double sign = cosine < 0.0 ? -1.0 : 1.0;
    double of_a = 1.0 - share, of_b = share;
    cosine = std::fabs(cosine);
    if (cosine < 0.999999) {
        const double angle = std::acos(cosine);
        of_a = std::sin(of_a * angle) / std::sin(angle);
        of_b = std::sin(of_b * angle) / std::sin(angle);
    }
    of_b *= sign;
    return { a.x * of_a + b.x * of_b, a.y * of_a + b.y * of_b, a.z * of_a + b.z * of_b, a.w * of_a + b.w * of_b };
}

} // namespace fbx
