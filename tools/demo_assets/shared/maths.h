/* Small vectors, and the smooth functions of compact support that the mask is shaped with. */
#ifndef MASK_MATHS_H
#define MASK_MATHS_H

typedef struct {
    double x, y, z;
} V3;

V3 v3(double x, double y, double z);
V3 v3_add(V3 a, V3 b);
V3 v3_sub(V3 a, V3 b);
V3 v3_scale(V3 a, double k);
V3 v3_mix(V3 a, V3 b, double k);
V3 v3_cross(V3 a, V3 b);
double v3_dot(V3 a, V3 b);
double v3_length(V3 a);
V3 v3_unit(V3 a); /* the zero vector stays zero */

double clamp(double x, double low, double high);
double mix(double a, double b, double k);
double smooth(double edge0, double edge1, double x); /* C2 step, 0 to 1 */
double bump(double d);                               /* C2, 1 at 0, exactly 0 for |d| >= 1 */
double bump2(double x, double y, double rx, double ry);
double smooth_max(double a, double b, double blend);

/* A C1 curve through `count` points (x ascending); constant outside. */
typedef struct {
    double x, y;
} Key;
double curve(const Key *keys, int count, double x);

/* Value noise in -1..1, the same on every machine. */
double noise2(double x, double y);

#endif
