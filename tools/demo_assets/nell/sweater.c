#include "parts.h"

#include <math.h>

#define PI 3.14159265358979323846

/* Rings from inside the collar down: height in front and behind, half width, depth in front and behind, how square.
 * Millimetres. */
enum { PROFILE = 13, STEPS = 2, RINGS = (PROFILE - 1) * STEPS + 1, SEGMENTS = 40 };
static const double profile[PROFILE][6] = {
    { -148, -128, 40, 12, -64, 0 },    { -124, -106, 41, 15, -66, 0 },    { -114, -96, 43, 19, -69, 0 },
    { -112, -94, 47, 24, -74, 0 },     { -116, -98, 51, 28, -78, 0 },     { -128, -108, 53, 30, -81, 0 },
    { -135, -115, 55, 31, -82, 0 },    { -142, -126, 72, 35, -84, 0.2 },  { -154, -140, 98, 43, -88, 0.45 },
    { -172, -160, 119, 52, -92, 0.6 }, { -198, -188, 129, 60, -95, 0.7 }, { -232, -226, 132, 66, -97, 0.7 },
    { -270, -270, 129, 68, -97, 0.7 },
};

double sweater_rib(const Seed *seed)
{
    return bump((seed->k / STEPS - 4) / 2.4) * cos(SEGMENTS * seed->t / 2);
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
