#include "parts.h"

#include <math.h>

#define PI 3.14159265358979323846

/* Rings from inside the collar down: height in front and behind, half width, depth in front and behind, how square.
 * Millimetres. */
enum { PROFILE = 13, STEPS = 2, RINGS = (PROFILE - 1) * STEPS + 1, SEGMENTS = 40 };
static const double profile[PROFILE][6] = {
    { -140, -121, 40, 13, -65, 0 },    { -114, -96, 43, 19, -69, 0 },      { -112, -94, 47, 24, -74, 0 },
    { -116, -98, 51, 28, -78, 0 },     { -128, -108, 53, 30, -81, 0 },     { -135, -115, 55, 31, -82, 0 },
    { -142, -126, 72, 35, -84, 0.2 },  { -156, -143, 100, 44, -88, 0.45 }, { -186, -176, 126, 57, -94, 0.65 },
    { -228, -222, 127, 64, -95, 0.6 }, { -264, -264, 104, 57, -85, 0.4 },  { -284, -284, 104, 57, -85, 0.4 },
    { -288, -288, 70, 34, -62, 0 },
};

double sweater_rib(const Seed *seed)
{
    double k = seed->k / STEPS;
    return (bump((k - 3) / 2.4) + bump((k - 11) / 1.6)) * cos(SEGMENTS * seed->t / 2);
}

V3 sweater_place(const Seed *seed)
{
    double r[6];
    for (int m = 0; m < 6; m++) {
        Key keys[PROFILE];
        for (int i = 0; i < PROFILE; i++) {
            keys[i].x = i;
            keys[i].y = profile[i][m];
        }
        r[m] = curve(keys, PROFILE, seed->k / STEPS);
    }
    double across = sin(seed->t), ahead = cos(seed->t);
    double square = 1 + 0.25 * r[5] * (1 - pow(fabs(across), 4)) * fabs(across);
    double y = (r[0] + r[1]) / 2 + (r[0] - r[1]) / 2 * ahead, middle = -20;
    double z = middle + (ahead > 0 ? r[3] - middle : middle - r[4]) * ahead;
    double knit = 1.2 * sweater_rib(seed);
    return v3(0.001 * (r[2] * across * square + knit * across), 0.001 * y, 0.001 * (z + knit * ahead));
}

void sweater_build(Model *model)
{
    uint32_t before[SEGMENTS], now[SEGMENTS];
    for (int k = 0; k < RINGS; k++) {
        for (int i = 0; i < SEGMENTS; i++) {
            Seed seed = { .region = ON_CLOTH, .k = k, .t = 2 * PI * i / SEGMENTS };
            seed.u = (double)i / SEGMENTS;
            seed.v = (double)k / RINGS;
            now[i] = model_seed(model, PART_CLOTH, &seed);
        }
        for (int i = 0; i < SEGMENTS && k > 0; i++) {
            int next = (i + 1) % SEGMENTS;
            model_quad(model, PART_CLOTH, before[i], now[i], now[next], before[next]);
        }
        for (int i = 0; i < SEGMENTS; i++) {
            before[i] = now[i];
        }
    }
}
