#include "maths.h"

#include <math.h>
#include <stdint.h>

V3 v3(double x, double y, double z)
{
    V3 v = { x, y, z };
    return v;
}

V3 v3_add(V3 a, V3 b)
{
    return v3(a.x + b.x, a.y + b.y, a.z + b.z);
}
V3 v3_sub(V3 a, V3 b)
{
    return v3(a.x - b.x, a.y - b.y, a.z - b.z);
}
V3 v3_scale(V3 a, double k)
{
    return v3(a.x * k, a.y * k, a.z * k);
}
V3 v3_mix(V3 a, V3 b, double k)
{
    return v3_add(v3_scale(a, 1 - k), v3_scale(b, k));
}

V3 v3_cross(V3 a, V3 b)
{
    return v3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

double v3_dot(V3 a, V3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
double v3_length(V3 a)
{
    return sqrt(v3_dot(a, a));
}

V3 v3_unit(V3 a)
{
    double length = v3_length(a);
    return length > 0 ? v3_scale(a, 1 / length) : a;
}

double clamp(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

double mix(double a, double b, double k)
{
    return a + (b - a) * k;
}

double smooth(double edge0, double edge1, double x)
{
    double k = clamp((x - edge0) / (edge1 - edge0), 0, 1);
    return k * k * k * (k * (6 * k - 15) + 10);
}

double bump(double d)
{
    double k = 1 - d * d;
    return k > 0 ? k * k * k : 0;
}

double bump2(double x, double y, double rx, double ry)
{
    double k = 1 - (x * x) / (rx * rx) - (y * y) / (ry * ry);
    return k > 0 ? k * k * k : 0;
}

double smooth_max(double a, double b, double blend)
{
    double k = clamp(1 - fabs(a - b) / blend, 0, 1);
    return (a > b ? a : b) + k * k * k * blend / 6;
}

static double slope(const Key *keys, int count, int i)
{
    if (i == 0 || i == count - 1) {
        return 0;
    }
    return (keys[i + 1].y - keys[i - 1].y) / (keys[i + 1].x - keys[i - 1].x);
}

double curve(const Key *keys, int count, double x)
{
    if (x <= keys[0].x) {
        return keys[0].y;
    }
    for (int i = 0; i + 1 < count; i++) {
        if (x > keys[i + 1].x) {
            continue;
        }
        double width = keys[i + 1].x - keys[i].x, k = (x - keys[i].x) / width;
        double k2 = k * k, k3 = k2 * k;
        return (2 * k3 - 3 * k2 + 1) * keys[i].y + (k3 - 2 * k2 + k) * width * slope(keys, count, i) +
               (3 * k2 - 2 * k3) * keys[i + 1].y + (k3 - k2) * width * slope(keys, count, i + 1);
    }
    return keys[count - 1].y;
}

static double lattice(int x, int y)
{
    uint32_t h = (uint32_t)x * 0x8da6b343u ^ (uint32_t)y * 0xd8163841u;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return (double)((h ^ (h >> 15)) & 0xffff) / 32767.5 - 1;
}

double noise2(double x, double y)
{
    int cx = (int)floor(x), cy = (int)floor(y);
    double kx = smooth(0, 1, x - cx), ky = smooth(0, 1, y - cy);
    return mix(mix(lattice(cx, cy), lattice(cx + 1, cy), kx), mix(lattice(cx, cy + 1), lattice(cx + 1, cy + 1), kx),
               ky);
}
