/* fbx_math.h: vectors, affine transforms, rotations by Euler angles, all in double precision. */
#ifndef NOH_CONVERT_FBX_FBX_MATH_H
#define NOH_CONVERT_FBX_FBX_MATH_H

#include <cmath>
#include <cstdint>

namespace fbx
{

struct vec {
    double at[3] = { 0.0, 0.0, 0.0 };
    double &operator[](int i)
    {
        return at[i];
    }
    double operator[](int i) const
    {
        return at[i];
    }
};

inline vec operator+(const vec &a, const vec &b)
{
    return { { a[0] + b[0], a[1] + b[1], a[2] + b[2] } };
}

inline vec operator-(const vec &a, const vec &b)
{
    return { { a[0] - b[0], a[1] - b[1], a[2] - b[2] } };
}

inline vec operator*(const vec &a, double s)
{
    return { { a[0] * s, a[1] * s, a[2] * s } };
}

inline double dot(const vec &a, const vec &b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline vec cross(const vec &a, const vec &b)
{
    return { { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] } };
}

/* Columns: three axes and the origin. */
struct mat {
    vec column[4] = { { { 1, 0, 0 } }, { { 0, 1, 0 } }, { { 0, 0, 1 } }, { { 0, 0, 0 } } };
    vec direction(const vec &v) const
    {
        return column[0] * v[0] + column[1] * v[1] + column[2] * v[2];
    }
    vec point(const vec &v) const
    {
        return direction(v) + column[3];
    }
};

struct quat {
    double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
};

static const double degrees_per_radian = 57.295779513082320877;

/* --- fbx_math.cpp --- */
mat operator*(const mat &a, const mat &b);
quat operator*(const quat &a, const quat &b);
double determinant(const mat &m);
/* The identity where m has no inverse. */
mat inverse(const mat &m);
mat translation(const vec &t);
mat scaling(const vec &s);
mat rotation(const quat &q);
quat conjugate(const quat &q);
/* Of a matrix that is a rotation. */
quat quaternion(const mat &m);
/* order 0..5: XYZ, XZY, YZX, YXZ, ZXY, ZYX; the first letter turns first. */
quat euler(const vec &degrees, int64_t order);
/* The inverse of euler() of order 0, its middle angle within 90 degrees. */
vec angles(const quat &q);
quat slerp(const quat &a, const quat &b, double share);

} // namespace fbx
#endif
