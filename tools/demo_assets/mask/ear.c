#include "ear.h"

#include "face.h"

#include <math.h>

#define PI 3.14159265358979323846

/* Rings up to 1 cover the front of the ear; the rest turn in behind it. */
static const double rings[] = { 0.15, 0.30, 0.42, 0.53, 0.63, 0.72, 0.80, 0.88, 0.95, 1.0, 1.03, 1.0, 0.85, 0.45 };
enum { RINGS = sizeof rings / sizeof rings[0], FRONT_RINGS = 10, SEGMENTS = 32 };

/* Height of the relief above the disc at (a, b) in the unit circle; a points away from the face, b up. */
static double ear_height(double a, double b)
{
    double r = sqrt(a * a + b * b);
    double upper = smooth(-0.75, -0.35, b);
    double helix = 0.0034 * bump((r - 0.90) / 0.24) * upper * smooth(-1.0, -0.2, a + 0.6 * b);
    double groove = -0.0012 * bump((r - 0.68) / 0.16) * upper;
    double inner = 0.0026 * bump((r - 0.50) / 0.22) * smooth(-0.3, 0.3, a + 0.2 * b);
    double bowl = -0.0016 * bump2(a + 0.22, b + 0.10, 0.50, 0.46);
    double lobe = 0.0022 * bump2(a + 0.10, b + 0.80, 0.70, 0.36);
    double flap = 0.0030 * bump2(a + 0.62, b + 0.16, 0.22, 0.28);
    /* The edge towards the face sinks into the head. */
    double root = a < 0 ? -0.0052 * a * a : 0;
    return helix + groove + inner + bowl + lobe + flap + root;
}

V3 ear_place(const Seed *seed)
{
    const double side = seed->eye;
    const V3 centre = v3(0.0696, 0.0000, -0.0084);
    const V3 out = v3_unit(v3(0.60, 0.05, -0.80)), up = v3_unit(v3(0.06, 1, -0.12));
    const V3 front = v3_unit(v3_cross(out, up));
    int ring = (int)seed->k;
    double r = rings[ring < 0 ? 0 : ring] * (ring < 0 ? 0 : 1);
    double a = r * cos(seed->t), b = r * sin(seed->t);
    double width = 0.0115 * (1 + 0.22 * b - 0.14 * b * b);
    double height = ear_height(a, b);
    if (ring >= FRONT_RINGS) {
        height = ear_height(a / r, b / r) - 0.0016 * (ring - FRONT_RINGS + 1);
    }
    V3 at = v3_add(centre, v3_scale(out, a * width));
    at = v3_add(at, v3_scale(up, b * 0.0235));
    at = v3_add(at, v3_scale(front, height));
    at.x *= side;
    return at;
}

static uint32_t ear_seed(Model *model, int side, int ring, int segment)
{
    Seed seed = { .region = ON_EAR, .k = ring, .t = 2 * PI * segment / SEGMENTS, .eye = side };
    double r = ring < 0 ? 0 : ring < FRONT_RINGS ? rings[ring] : 1 + 0.05 * (ring - FRONT_RINGS + 1);
    seed.s = r;
    seed.u = 0.5 + side * (0.43 + 0.055 * r * cos(seed.t));
    seed.v = 0.5 - 0.11 * r * sin(seed.t);
    return model_seed(model, PART_PAINT, &seed);
}

static void ear_quad(Model *model, int side, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    if (side > 0) {
        model_quad(model, PART_PAINT, a, b, c, d);
    } else {
        model_quad(model, PART_PAINT, d, c, b, a);
    }
}

static void ear_build(Model *model, int side)
{
    uint32_t before[SEGMENTS], now[SEGMENTS];
    uint32_t centre = ear_seed(model, side, -1, 0);
    for (int i = 0; i < SEGMENTS; i++) {
        before[i] = centre;
    }
    for (int r = 0; r < RINGS; r++) {
        for (int i = 0; i < SEGMENTS; i++) {
            now[i] = ear_seed(model, side, r, i);
        }
        for (int i = 0; i < SEGMENTS; i++) {
            int next = (i + 1) % SEGMENTS;
            ear_quad(model, side, before[i], now[i], now[next], before[next]);
        }
        for (int i = 0; i < SEGMENTS; i++) {
            before[i] = now[i];
        }
    }
    for (int i = 1; i + 1 < SEGMENTS; i++) {
        ear_quad(model, side, before[0], before[i + 1], before[i], before[i]);
    }
}

void ears_build(Model *model)
{
    ear_build(model, 1);
    ear_build(model, -1);
}
