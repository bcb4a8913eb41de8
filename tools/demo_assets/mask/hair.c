#include "hair.h"

#include "face.h"

#include <math.h>

/* Metres for one unit of radius: about the size of the face. */
static const double scale = 0.080;

static double radius(double s, double t)
{
    double p = s / FACE_HALF_WIDTH, q = t / FACE_HALF_HEIGHT;
    return sqrt(p * p + q * q);
}

/* The hair is parted in the middle and falls along the temples. Keys: the angle from straight up, and the hairline as a
 * share of the distance to the rim. */
static double hair_line(double angle)
{
    static const Key line[] = { { 0.00, 0.872 }, { 0.05, 0.860 }, { 0.14, 0.846 }, { 0.45, 0.840 }, { 0.80, 0.850 },
                                { 1.15, 0.872 }, { 1.45, 0.900 }, { 1.65, 0.940 }, { 1.85, 1.020 }, { 3.15, 1.200 } };
    return curve(line, (int)(sizeof line / sizeof *line), angle);
}

double hair_past(double s, double t)
{
    double angle = atan2(fabs(s) / FACE_HALF_WIDTH, t / FACE_HALF_HEIGHT);
    return (radius(s, t) - hair_line(angle)) * scale;
}

void hair_shift(double *s, double *t, double distance)
{
    double now = radius(*s, *t), k = (now + distance / scale) / now;
    *s *= k;
    *t *= k;
}

/* A stroke lies just above the face and moves with it. Strokes that cross lie one on the other: in one plane, corners
 * of one would meet edges of the other, which shows as specks. */
V3 stroke_place(const Seed *seed, const Pose *pose)
{
    FacePoint point = { seed->s, seed->t, 1, seed->t > MOUTH_Y ? 1 : -1 };
    V3 at = face_place(point, pose);
    V3 out = v3_unit(v3(seed->s / FACE_HALF_WIDTH, 0.5 * seed->t / FACE_HALF_HEIGHT, 0.6));
    return v3_add(at, v3_scale(out, 0.00022 + 0.00005 * seed->k));
}

/* A stroke follows the hairline from one angle to another. It keeps `inset`
 * inside the line, meets it at both ends, and tapers there. */
typedef struct {
    double from, to, inset, width;
    int layer;
} Stroke;

static Seed stroke_seed(const Stroke *stroke, int side, double along, double across)
{
    static const Pose rest;
    double angle = mix(stroke->from, stroke->to, along);
    double arch = pow(fmax(4 * along * (1 - along), 0), 0.7);
    double width = stroke->inset > 0 ? stroke->width * mix(0.25, 1, arch) : stroke->width;
    double r = fmin(hair_line(angle) + (across * width - stroke->inset * arch) / scale, 0.975);
    Seed seed = { .region = ON_STROKE, .k = stroke->layer };
    seed.s = side_sign(side) * r * sin(angle) * FACE_HALF_WIDTH;
    seed.t = r * cos(angle) * FACE_HALF_HEIGHT;
    V3 at = stroke_place(&seed, &rest);
    seed.u = 0.5 + at.x / 0.24;
    seed.v = 0.5 - at.y / 0.24;
    return seed;
}

static void stroke_build(Model *model, const Stroke *stroke, int side)
{
    enum { STEPS = 64 };
    uint32_t inner = 0, outer = 0;
    for (int i = 0; i <= STEPS; i++) {
        Seed a = stroke_seed(stroke, side, (double)i / STEPS, 0);
        Seed b = stroke_seed(stroke, side, (double)i / STEPS, 1);
        uint32_t next_inner = model_seed(model, PART_PAINT, &a);
        uint32_t next_outer = model_seed(model, PART_PAINT, &b);
        if (i > 0 && side == LEFT) {
            model_quad(model, PART_PAINT, inner, next_inner, next_outer, outer);
        }
        if (i > 0 && side == RIGHT) {
            model_quad(model, PART_PAINT, outer, next_outer, next_inner, inner);
        }
        inner = next_inner;
        outer = next_outer;
    }
}

void hair_build(Model *model)
{
    static const Stroke strokes[] = { { 0.0, 1.70, 0, 0.0042, 2 }, /* the edge of the hair itself */
                                      { 0.05, 1.62, 0.0034, 0.00075,
                                        1 }, /* loose strands, as young women's masks have */
                                      { 0.09, 1.40, 0.0058, 0.00060, 0 } };
    for (int side = 0; side < SIDES; side++) {
        for (int i = 0; i < (int)(sizeof strokes / sizeof *strokes); i++) {
            stroke_build(model, &strokes[i], side);
        }
    }
}
