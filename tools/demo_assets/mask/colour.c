#include "colour.h"

#include "shared/grab.h"
#include "eye.h"
#include "face.h"
#include "hair.h"
#include "relief.h"

#include <math.h>
#include <stddef.h>

static const V3 gofun = { 0.84, 0.765, 0.635 }, ivory = { 0.80, 0.68, 0.49 }, blush = { 0.80, 0.52, 0.40 };
static const V3 red = { 0.34, 0.024, 0.018 }, ink = { 0.010, 0.008, 0.007 };
static const V3 bare_wood = { 0.30, 0.155, 0.065 }, dark_wood = { 0.115, 0.052, 0.022 };
static const V3 flesh = { 0.50, 0.27, 0.19 };
static const V3 white_of_eye = { 0.78, 0.72, 0.60 }, iris = { 0.052, 0.024, 0.012 };
static const V3 tooth = { 0.94, 0.90, 0.80 }, gum = { 0.22, 0.05, 0.035 };
static const V3 tongue = { 0.42, 0.11, 0.09 }, throat = { 0.17, 0.035, 0.028 };

/* Distance from the middle, as a share of the distance to the rim. */
static double to_rim(double s, double t)
{
    double p = s / (FACE_HALF_WIDTH * outline_width(t)), q = t / FACE_HALF_HEIGHT;
    return sqrt(p * p + q * q);
}

/* In creases colours darken towards brown. */
static V3 shade(V3 colour, double open)
{
    double k = 1 - open;
    return v3(colour.x * (1 - 0.75 * k), colour.y * (1 - 0.90 * k), colour.z * (1 - 0.97 * k));
}

/* Painted brows, high on the forehead: soft smudges, denser in the middle. */
static double mayu(double s, double t)
{
    double x = fabs(s) - 0.0255, y = t - 0.0590;
    double along = x * 0.98 + y * 0.20, across = y * 0.98 - x * 0.20 + 14 * along * along;
    double d = sqrt(along * along / (0.0145 * 0.0145) + across * across / (0.0080 * 0.0080));
    return 0.96 * smooth(1.1, 0.3, d);
}

static V3 lip_colour(V3 base, const Seed *seed)
{
    double from_line = seed->t - mouth_line(seed->s), edge = lip_edge(seed->s, seed->mouth);
    if (fabs(seed->s) > MOUTH_HALF) {
        return base;
    }
    double inside = seed->mouth > 0 ? edge - from_line : from_line - edge;
    double soft = mix(0.0010, 0.0004, smooth(0, 0.35, mouth_almond(seed->s)));
    double k = smooth(-soft, soft, inside);
    V3 colour = v3_mix(base, red, 0.95 * k);
    return v3_scale(colour, 1 - 0.6 * smooth(0.0011, 0, fabs(from_line)) * sqrt(mouth_almond(seed->s)));
}

static V3 lid_colour(V3 base, const Seed *seed)
{
    double from_line = seed->t - eye_line(seed->s), width = eye_almond(seed->s);
    if (width <= 0) {
        return base;
    }
    if (seed->eye > 0) {
        double line = 0.0017 * sqrt(width);
        return v3_mix(base, ink, 0.9 * smooth(line + 0.0006, line - 0.0004, from_line));
    }
    return v3_mix(base, v3(0.25, 0.10, 0.06), 0.6 * smooth(0.0009, 0.0001, -from_line) * sqrt(width));
}

static V3 skin_colour(const Seed *seed, double open)
{
    double s = seed->s, t = seed->t;
    double mottle = 0.5 + 0.5 * noise2(s * 60, t * 60);
    V3 base = v3_mix(gofun, ivory, 0.25 * mottle + 0.5 * smooth(0.75, 1.0, to_rim(s, t)));
    double warm = 0.55 * bump2(fabs(s) - 0.038, t + 0.022, 0.030, 0.026) + 0.25 * bump2(s, t + 0.020, 0.016, 0.014) +
                  0.30 * bump2(fabs(s) - EYE_X, t - EYE_Y - 0.004, 0.024, 0.014) +
                  0.25 * bump2(s, t + 0.090, 0.022, 0.018);
    base = v3_mix(base, blush, 0.75 * clamp(warm, 0, 1));
    base = shade(base, mix(open, 1, 0.25));
    double nostril = bump2(fabs(s) - 0.0059, t + 0.0287, 0.0042, 0.0030);
    base = v3_mix(base, v3(0.06, 0.02, 0.015), 0.9 * nostril);
    base = lip_colour(base, seed);
    base = lid_colour(base, seed);
    base = v3_mix(base, ink, mayu(s, t));
    return v3_mix(base, ink, 0.995 * smooth(0.0004, 0.0028, hair_past(s, t)));
}

static V3 fold_colour(const Seed *seed, double open)
{
    if (seed->region == ON_LID_FOLD) {
        /* An inked upper edge; in the corner by the nose the ball's white goes on. */
        double corner = smooth(-0.50, -0.80, (fabs(seed->s) - EYE_X) / EYE_HALF);
        V3 edge = v3_mix(seed->eye > 0 && seed->k < 3 ? ink : flesh, ink, 0.12 * seed->k);
        V3 wet = v3_mix(v3_mix(flesh, white_of_eye, 0.4), v3_scale(white_of_eye, 0.75), smooth(0, 1.5, seed->k));
        return v3_mix(edge, wet, corner);
    }
    double k = smooth(0, 2.2, seed->k);
    return shade(v3_mix(v3_scale(red, 0.75), throat, k), open);
}

static V3 ear_colour(const Seed *seed, double open)
{
    V3 base = v3_mix(gofun, ivory, 0.5);
    base = v3_mix(base, blush, 0.18);
    if (seed->k >= 10) {
        return v3_mix(ivory, bare_wood, 0.5);
    }
    return shade(base, open);
}

static V3 wood_colour(const Seed *seed, V3 at, double open)
{
    if (seed->region == ON_RIM) { /* painted as the face is; bare from where it turns inwards behind it */
        Seed border = *seed;
        border.mouth = seed->t > MOUTH_Y ? 1 : -1;
        border.eye = seed->t > EYE_Y ? 1 : -1;
        V3 bare = v3_mix(dark_wood, bare_wood, 0.55 + 0.30 * noise2(at.x * 60, at.y * 22));
        return v3_mix(skin_colour(&border, open), bare, smooth(4, 6, seed->k));
    }
    double rings = sin(at.x * 420 + 5 * noise2(at.x * 40, at.y * 14) + 1.5 * noise2(at.x * 90, at.y * 16));
    double grain = 0.5 + 0.35 * rings + 0.15 * noise2(at.x * 1500, at.y * 60);
    V3 base = v3_mix(dark_wood, bare_wood, clamp(grain, 0, 1));
    if (seed->region == ON_BACK) {
        base = v3_scale(base, 0.6);
    }
    return shade(base, open);
}

static V3 ball_colour(const Seed *seed, double open)
{
    double ring = seed->s;
    if (ring < PUPIL_ANGLE) {
        return v3(0.004, 0.003, 0.003);
    }
    if (ring < IRIS_ANGLE) {
        double k = (ring - PUPIL_ANGLE) / (IRIS_ANGLE - PUPIL_ANGLE);
        double streak = 0.85 + 0.15 * cos(seed->t * 16);
        return v3_scale(iris, mix(1.5, 0.35, k * k) * streak);
    }
    V3 pink = v3_mix(white_of_eye, blush, 0.35 * smooth(0.5, 0.9, ring));
    return shade(pink, mix(open, 1, 0.45));
}

static V3 tooth_colour(const Seed *seed, double open)
{
    double across = fabs(2 * (seed->s - floor(seed->s)) - 1);
    V3 base = v3_mix(tooth, gum, seed->k < 1 ? 1 : 0);
    base = v3_scale(base, 1 - 0.25 * smooth(0.8, 1, across));
    return shade(base, mix(open, 1, 0.8));
}

static V3 mouth_colour(const Seed *seed, double open)
{
    if (seed->region == ON_BAG) {
        return v3_mix(gum, throat, smooth(0, 0.7, seed->s));
    }
    return v3_mix(throat, tongue, smooth(0.05, 0.5, seed->s) * mix(open, 1, 0.6));
}

static V3 colour_of(const Seed *seed, V3 at, double open)
{
    switch (seed->region) {
    case ON_SKIN: return skin_colour(seed, open);
    case ON_LIP_FOLD:
    case ON_LID_FOLD: return fold_colour(seed, open);
    case ON_EAR: return ear_colour(seed, open);
    case ON_STROKE: return ink;
    case ON_RIM:
    case ON_BACK: return wood_colour(seed, at, open);
    case ON_BALL: return ball_colour(seed, open);
    case ON_TEETH: return tooth_colour(seed, open);
    case ON_TONGUE:
    case ON_BAG: return mouth_colour(seed, open);
    }
    return gofun;
}

void colour_bake(Model *model, const Frame *frames, double *const open[PARTS_MAX])
{
    for (int p = 0; p < PART_COUNT; p++) {
        Part *part = &model->parts[p];
        part->colours = grab(NULL, part->seed_count, (int)sizeof *part->colours);
        for (int i = 0; i < part->seed_count; i++) {
            part->colours[i] = colour_of(&part->seeds[i], frames[p].position[i], open[p][i]);
        }
    }
}
