/* Lashes and brows: closed strokes on the skin. */
#include "parts.h"

#include "skin.h"

#include <math.h>

#define PI 3.14159265358979323846

void stroke_build(Model *model, int part, Seed seed, int rings, int segments)
{
    uint32_t before[32], now[32];
    for (int k = 0; k <= rings; k++) {
        int end = k == 0 || k == rings;
        for (int i = 0; i < segments; i++) {
            seed.s = (double)k / rings;
            seed.t = (seed.eye > 0 ? -2 : 2) * PI * i / segments;
            seed.u = seed.t / (2 * PI);
            seed.v = seed.s;
            now[i] = end && i > 0 ? now[0] : model_seed(model, part, &seed);
        }
        for (int i = 0; i < segments && k > 0; i++) {
            int next = (i + 1) % segments;
            model_quad(model, part, before[i], before[next], now[next], now[i]);
        }
        for (int i = 0; i < segments; i++) {
            before[i] = now[i];
        }
    }
}

void brows_build(Model *model)
{
    for (int side = -1; side <= 1; side += 2) {
        Seed lash = { .region = ON_LASH, .eye = side }, brow = { .region = ON_BROW, .eye = side };
        stroke_build(model, PART_HAIR, lash, 16, 5);
        stroke_build(model, PART_HAIR, brow, 12, 6);
    }
}

/* Along the edge of the upper lid, from the nose outwards and past the corner; the points stand out from the ball. */
V3 lash_place(const Seed *seed, const Pose *pose)
{
    int side = seed->eye > 0 ? LEFT : RIGHT;
    double along = mix(-0.86, 0.93, seed->s), s = side_sign(side) * (EYE_S + along * EYE_REACH);
    SkinPoint p = { s, lids_line(s), 1, 1 };
    V3 edge = skin_place(p, pose), out = v3_unit(v3_sub(edge, eyeball(side)));
    double shut = pose->blink[side], taper = seed->s <= 0 || seed->s >= 1 ? 0 : 1;
    double length = mix(0.0018, 0.0062, smooth(0.1, 0.8, seed->s)) * smooth(0, 0.25, seed->s) *
                    mix(1, 0.15, smooth(0.5, 1, seed->s));
    V3 lift = v3_unit(v3(side_sign(side) * (0.2 * seed->s + 0.5 * seed->s * seed->s), mix(0.75, -0.35, shut), 0.55));
    double reach = cos(seed->t) > 0 ? cos(seed->t) : 0.12 * cos(seed->t);
    V3 at = v3_add(edge, v3_scale(out, 0.0004));
    at = v3_add(at, v3_scale(lift, length * reach * reach));
    return v3_add(at, v3_scale(v3(0, 0.9, 0.3), taper * (0.0009 * sin(seed->t) + 0.0004)));
}

V3 brow_place(const Seed *seed, const Pose *pose)
{
    double side = seed->eye, u = seed->s;
    double s = mix(0.0135, 0.0545, u), t = 0.0335 + 0.0052 * sin(PI * pow(u, 0.95) * 0.9) - 0.0050 * u * u;
    double half = u <= 0 || u >= 1 ? 0 : 0.0031 * pow(1 - u, 0.55) * smooth(-0.08, 0.20, u) + 0.0004;
    SkinPoint p = { side * s, t + half * sin(seed->t), 1, 1 };
    V3 at = skin_place(p, pose), out = v3_unit(v3(0.55 * side * u, 0.1, 1));
    return v3_add(at, v3_scale(out, half * (0.45 * cos(seed->t) + 0.15)));
}
