#include "colour.h"

#include "mask/eye.h"
#include "parts.h"
#include "shape.h"
#include "shared/grab.h"
#include "skin.h"

#include <math.h>
#include <stddef.h>

static const V3 fair = { 0.870, 0.570, 0.430 }, rose = { 0.820, 0.320, 0.250 }, lip = { 0.620, 0.205, 0.180 };
static const V3 brown = { 0.190, 0.064, 0.026 }, copper = { 0.500, 0.175, 0.060 }, dark = { 0.022, 0.010, 0.006 };
static const V3 white = { 0.92, 0.91, 0.89 }, teal = { 0.050, 0.290, 0.320 };
static const V3 tooth = { 0.93, 0.90, 0.83 }, gum = { 0.50, 0.16, 0.14 };
static const V3 tongue = { 0.55, 0.17, 0.16 }, throat = { 0.120, 0.020, 0.018 };
static const V3 wool = { 0.070, 0.270, 0.320 };

/* In creases colours darken, towards red. */
static V3 shade(V3 colour, double open)
{
    double k = 1 - open;
    return v3(colour.x * (1 - 0.55 * k), colour.y * (1 - 0.78 * k), colour.z * (1 - 0.82 * k));
}

static V3 skin_colour(const Seed *seed, double open)
{
    double s = fabs(seed->s), t = seed->t;
    double blush = 0.62 * bump2(s - 0.043, t + 0.033, 0.029, 0.023) + 0.34 * bump2(s, t + 0.019, 0.014, 0.012) +
                   0.14 * bump2(s, t + 0.074, 0.020, 0.014) + 0.16 * bump2(s - EYE_S, t - 0.004, 0.028, 0.022);
    V3 base = v3_mix(fair, rose, clamp(blush, 0, 1));
    double fade = mix(0.74, 1, fmax(smooth(-0.026, -0.036, t), 0.8 * bump2(s, t + 0.025, 0.024, 0.014)));
    base = shade(base, mix(open, 1, fade));
    base = v3_mix(base, v3(0.22, 0.06, 0.04), 0.75 * bump2(s - 0.0042, t + 0.0272, 0.0034, 0.0026));
    double from_line = t - lips_line(s), edge = red_edge(s, seed->mouth);
    if (s < MOUTH_REACH) {
        double inside = seed->mouth > 0 ? edge - from_line : from_line - edge;
        base = v3_mix(base, lip, 0.80 * smooth(-0.0006, 0.0009, inside));
        base = v3_scale(base, 1 - 0.60 * smooth(0.0011, 0, fabs(from_line)) * sqrt(lips_width(s)));
    }
    double from_lid = t - lids_line(s), width = lids_width(s);
    if (width > 0 && seed->eye > 0) {
        base = v3_mix(base, v3(0.10, 0.030, 0.018), 0.85 * smooth(0.0016, 0.0002, from_lid));
    }
    if (width > 0 && seed->eye < 0) {
        base = v3_mix(base, v3(0.45, 0.17, 0.12), 0.7 * smooth(0.0014, 0, -from_lid));
    }
    return v3_mix(base, v3_mix(brown, copper, 0.6),
                  0.95 * smooth(0.001, 0.006, nell_hair_past(s, t)) * smooth(0.125, 0.105, s));
}

static V3 fold_colour(const Seed *seed)
{
    if (seed->region == ON_LID_FOLD) {
        double corner = smooth(-0.50, -0.80, (fabs(seed->s) - EYE_S) / EYE_REACH);
        V3 edge = seed->eye > 0 ? v3(0.10, 0.030, 0.018) : v3(0.55, 0.24, 0.18);
        V3 wet = v3_mix(v3(0.66, 0.38, 0.32), v3_scale(white, 0.72), smooth(0, 1, seed->k)); /* as the ball */
        return v3_mix(edge, wet, corner);
    }
    return v3_mix(v3_scale(lip, 0.85), v3(0.30, 0.07, 0.06), seed->k / 4);
}

static V3 ball_colour(const Seed *seed, double open)
{
    double ring = seed->s;
    if (ring < PUPIL_ANGLE) {
        return v3(0.006, 0.006, 0.007);
    }
    if (ring < IRIS_ANGLE) {
        double k = (ring - PUPIL_ANGLE) / (IRIS_ANGLE - PUPIL_ANGLE);
        double streak = 0.90 + 0.10 * cos(seed->t * 16);
        V3 inner = v3(0.30, 0.26, 0.07);
        V3 mid = v3_mix(inner, v3_scale(teal, 1.5), smooth(0, 0.45, k));
        return v3_scale(v3_mix(mid, v3_scale(teal, 0.22), smooth(0.55, 1, k)), streak * (1.15 - 0.45 * sin(seed->t)));
    }
    V3 pink = v3_mix(white, v3(0.80, 0.50, 0.44), 0.45 * smooth(0.62, 1.0, ring));
    return shade(pink, mix(open, 1, 0.55));
}

static V3 tooth_colour(const Seed *seed, double open)
{
    double across = fabs(2 * (seed->s - floor(seed->s)) - 1), side = smooth(1.6, 5, fabs(seed->s));
    V3 base = v3_scale(tooth, 1 - 0.16 * smooth(0.75, 1, across));
    base = v3_mix(base, gum, seed->k < 1 ? 1 : seed->k < 2 ? 0.3 : 0);
    return v3_scale(shade(base, mix(open, 1, 0.9)), 1 - 0.35 * side);
}

static V3 mouth_colour(const Seed *seed)
{
    if (seed->region == ON_BAG) {
        return v3_mix(v3(0.42, 0.11, 0.09), throat, smooth(0, 0.5, seed->s));
    }
    return v3_mix(throat, tongue, smooth(0.05, 0.5, seed->s));
}

static V3 hair_colour(const Seed *seed, double open)
{
    if (seed->region == ON_SCALP) {
        double ridge = mix(nell_hair_arch(seed), 0.8, smooth(0.65, 0.95, seed->t));
        double lit = 0.20 + 0.30 * smooth(0.5, 0, seed->t) + 0.22 * bump((seed->t - 0.56) / 0.22);
        return shade(v3_scale(v3_mix(brown, copper, lit * ridge), mix(0.50, 1, ridge)), mix(open, 1, 0.4));
    }
    double a = cos(seed->t), tip = smooth(0.2, 1, seed->s);
    double strand = 0.55 + 0.45 * cos(5 * a + seed->k);
    V3 base = v3_mix(brown, copper, 0.25 * strand + 0.45 * tip + 0.08 * cos(seed->k * 2.4));
    return shade(v3_scale(base, 1 - 0.45 * a * a * a * a), mix(open, 1, 0.4));
}

/* Occlusion as seen from the front: sides and back have none. */
static V3 colour_of(const Seed *seed, V3 at, double front)
{
    double open = mix(1, front, smooth(-0.010, 0.030, at.z));
    switch (seed->region) {
    case ON_LIP_FOLD:
    case ON_LID_FOLD: return fold_colour(seed);
    case ON_EAR: return shade(v3_mix(fair, rose, 0.30), mix(open, 1, 0.4));
    case ON_BALL: return ball_colour(seed, open);
    case ON_TEETH: return tooth_colour(seed, open);
    case ON_TONGUE:
    case ON_BAG: return mouth_colour(seed);
    case ON_LASH: return dark;
    case ON_BROW: return v3_mix(dark, brown, 0.6);
    case ON_SCALP:
    case ON_LOCK: return hair_colour(seed, open);
    case ON_CLOTH: return shade(v3_scale(wool, 1 + 0.35 * fmin(sweater_rib(seed), 0)), mix(open, 1, 0.3));
    default: return skin_colour(seed, open);
    }
}

void nell_colour(Model *model, const Frame *frames, double *const open[PARTS_MAX])
{
    for (int p = 0; p < model->part_count; p++) {
        Part *part = &model->parts[p];
        part->colours = grab(NULL, part->seed_count, (int)sizeof *part->colours);
        for (int i = 0; i < part->seed_count; i++) {
            part->colours[i] = colour_of(&part->seeds[i], frames[p].position[i], open[p][i]);
        }
    }
}
