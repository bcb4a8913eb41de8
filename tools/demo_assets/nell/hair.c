/* Hair: a cap that follows the skull, and large locks that lie on it. */
#include "parts.h"

#include "shape.h"

#include <math.h>

#define PI 3.14159265358979323846
#define COUNT(list) ((int)(sizeof(list) / sizeof *(list)))

/* ---- cap ---- */

enum { CAP_COLUMNS = 64, CAP_ROWS = 14 };

/* Height of the hairline at s. */
static double hairline(double s)
{
    static const Key line[] = { { 0, 0.084 },      { 0.030, 0.080 },  { 0.052, 0.064 },  { 0.066, 0.040 },
                                { 0.080, 0.018 },  { 0.091, 0.002 },  { 0.100, -0.003 }, { 0.112, -0.018 },
                                { 0.126, -0.042 }, { 0.150, -0.076 }, { 0.200, -0.084 } };
    return curve(line, COUNT(line), fabs(s));
}

double nell_hair_past(double s, double t)
{
    return t - hairline(s);
}

/* The edge is round. */
static double cap_thickness(double s, double t)
{
    double k = clamp((nell_hair_past(s, t) + 0.003) / 0.030, 0, 1);
    return -0.006 + (0.0120 + 0.002 * smooth(0.02, 0.10, t)) * sqrt(k * (2 - k));
}

V3 scalp_place(const Seed *seed)
{
    double grain = 0.0011 * sin(seed->s * 190 + 2.2 * sin(seed->t * 30)) *
                   smooth(0.01, 0.04, nell_hair_past(seed->s, seed->t)) * smooth(0.16, 0.12, seed->t);
    return v3_add(shape_at(seed->s, seed->t),
                  v3_scale(shape_normal(seed->s, seed->t), cap_thickness(seed->s, seed->t) + grain));
}

static void cap_build(Model *model)
{
    uint32_t before[CAP_COLUMNS], now[CAP_COLUMNS];
    for (int k = 0; k <= CAP_ROWS; k++) {
        for (int i = 0; i < CAP_COLUMNS; i++) {
            double s = HALF_ROUND * (2.0 * i / CAP_COLUMNS - 1), low = hairline(s) - 0.003;
            Seed seed = { .region = ON_SCALP, .s = s, .t = mix(low, TOP - 0.0005, pow((double)k / CAP_ROWS, 1.6)) };
            seed.u = 0.5 + s / 0.4;
            seed.v = 0.5 - seed.t / 0.4;
            now[i] = model_seed(model, PART_HAIR, &seed);
        }
        for (int i = 0; i < CAP_COLUMNS && k > 0; i++) {
            int next = (i + 1) % CAP_COLUMNS;
            model_quad(model, PART_HAIR, before[i], before[next], now[next], now[i]);
        }
        for (int i = 0; i < CAP_COLUMNS; i++) {
            before[i] = now[i];
        }
    }
}

/* ---- locks ---- */

/* A curve over the head through four points (s, t, height above the skin; millimetres), half its width, and its
 * thickness. mirror: also on the other side. */
typedef struct {
    double s[4], t[4], high[4];
    double width, thick;
    int mirror;
} Lock;

static const Lock locks[] = {
    /* the fringe: from the parting on her right over the forehead to her left; neighbours differ in height */
    { { -30, -12, 16, 48 }, { 112, 88, 70, 60 }, { 8, 14, 12, 8 }, 16, 7, 0 },
    { { -28, 0, 36, 68 }, { 124, 104, 80, 44 }, { 9, 19, 16, 10 }, 21, 8, 0 },
    { { -22, 14, 52, 80 }, { 138, 124, 94, 26 }, { 9, 23, 19, 12 }, 23, 8, 0 },
    { { -10, 34, 70, 85 }, { 150, 140, 98, 22 }, { 9, 17, 15, 10 }, 24, 8, 0 },
    /* the other side of the parting */
    { { -32, -46, -62, -74 }, { 118, 104, 78, 26 }, { 8, 15, 13, 9 }, 18, 7, 0 },
    { { -32, -54, -76, -86 }, { 134, 124, 86, 20 }, { 9, 20, 17, 11 }, 23, 8, 0 },
    { { -30, -60, -98, -104 }, { 148, 140, 80, 18 }, { 9, 15, 14, 10 }, 25, 8, 0 },
    /* over her left ear */
    { { 16, 62, 98, 104 }, { 154, 142, 80, 18 }, { 9, 21, 18, 12 }, 25, 8, 0 },
    /* behind the ears */
    { { 70, 104, 131, 132 }, { 156, 130, 50, -40 }, { 8, 17, 16, 9 }, 28, 8, 1 },
    { { 100, 130, 146, 146 }, { 156, 120, 40, -78 }, { 8, 13, 13, 6 }, 28, 8, 1 },
    { { 150, 164, 172, 172 }, { 158, 110, 10, -124 }, { 8, 17, 17, 6 }, 26, 9, 1 },
    { { 199, 199, 199, 199 }, { 156, 110, 20, -128 }, { 8, 21, 20, 6 }, 23, 9, 0 },
    /* tips */
    { { 130, 134, 136, 132 }, { 20, -4, -30, -60 }, { 8, 12, 12, 9 }, 15, 6, 1 },
    { { 150, 158, 158, 154 }, { -10, -50, -90, -126 }, { 10, 13, 11, 6 }, 17, 7, 1 },
    /* one that will not lie down */
    { { -4, 8, 22, 30 }, { 162, 158, 148, 128 }, { 8, 26, 27, 22 }, 9, 5, 0 },
};

static double spline(const double p[4], double u)
{
    double v = 1 - u;
    return v * v * v * p[0] + 3 * v * v * u * p[1] + 3 * v * u * u * p[2] + u * u * u * p[3];
}

V3 lock_place(const Seed *seed)
{
    const Lock *lock = &locks[(int)seed->k];
    double side = seed->eye, u = seed->s, step = 0.01;
    double ds = spline(lock->s, u + step) - spline(lock->s, u - step);
    double dt = spline(lock->t, u + step) - spline(lock->t, u - step), length = sqrt(ds * ds + dt * dt);
    double end = u <= 0 || u >= 1 ? 0 : 1, a = cos(seed->t), b = -sin(seed->t);
    double taper = end * (1 - pow(u, 2.2)) * smooth(-0.2, 0.35, u);
    double across = lock->width * taper * a;
    double s = spline(lock->s, u) - across * dt / length, t = spline(lock->t, u) + across * ds / length;
    /* The edges lie below the cap, except near the tip. */
    double high = spline(lock->high, u), low = mix(4, high - lock->thick * (0.3 + 0.7 * taper), smooth(0.55, 0.95, u)),
           round = sqrt(fabs(b));
    high = b > 0 ? mix(low, high, end * round * (1 + 0.05 * cos(3 * PI * a))) : low - 2 * end * round;
    s *= 0.001 * side;
    t = fmin(0.001 * t, TOP - 0.001);
    return v3_add(shape_at(s, t), v3_scale(shape_normal(s, t), 0.001 * high));
}

void nell_hair_build(Model *model)
{
    cap_build(model);
    for (int i = 0; i < COUNT(locks); i++) {
        for (int side = 1; side >= (locks[i].mirror ? -1 : 1); side -= 2) {
            Seed seed = { .region = ON_LOCK, .k = i, .eye = side };
            stroke_build(model, PART_HAIR, seed, 10, 9);
        }
    }
}
