#include "mouth.h"

#include "face.h"
#include "jaw.h"

#include <math.h>

#define PI 3.14159265358979323846

enum { TEETH = 10, TOOTH_COLUMNS = 6, TOOTH_ROWS = 8 };
enum { TONGUE_RINGS = 16, TONGUE_SEGMENTS = 16, BAG_RINGS = 9, BAG_SEGMENTS = 28 };

/* Depth of the lips' edge at rest; everything else in the mouth lies behind it. */
static const double lips_z = 0.0272;

/* Upright profile of a tooth: away from the cutting edge, and back. */
static const double tooth_rise[TOOTH_ROWS] = { 0.0105, 0.0080, 0.0050, 0.0022, 0.0006, 0, 0.0006, 0.0060 };
static const double tooth_back[TOOTH_ROWS] = { 0.0016, 0.0004, 0, 0.0002, 0.0008, 0.0017, 0.0032, 0.0046 };

/* seed->s counts teeth from the middle, seed->k rows from the gum. */
V3 teeth_place(const Seed *seed, const Pose *pose)
{
    int row = (int)seed->k, upper = seed->mouth > 0;
    double across = 2 * (seed->s - floor(seed->s)) - 1; /* -1..1 over one tooth */
    double corner = across * across * across * across;
    double wide = upper ? 0.0238 : 0.0214, deep = upper ? 0.0175 : 0.0155, angle = seed->s / (TEETH / 2) * 1.2;
    double back = tooth_back[row] + 0.0011 * corner;
    double rise = tooth_rise[row] + (row >= 3 ? 0.0007 * corner * (upper ? 1 : 0.7) : 0);
    double edge = upper ? MOUTH_Y - 0.0012 : MOUTH_Y - 0.0030;
    double canine = 0.0005 * bump((fabs(seed->s) - 2.5) / 1.2);
    double arc = 0.0026 * bump(seed->s / 4); /* as low as the middle of the lip, which hangs down */
    V3 at = v3((wide - back) * sin(angle), edge + (upper ? rise - canine - arc : -rise),
               lips_z - 0.0062 - deep + (deep - back) * cos(angle));
    if (!upper) {
        at.z -= 0.0014;
    }
    return jaw_move(at, upper ? 0 : 1, pose);
}

static void teeth_build(Model *model, int row_side)
{
    enum { COLUMNS = TEETH * TOOTH_COLUMNS + 1 };
    uint32_t before[COLUMNS], now[COLUMNS];
    for (int k = 0; k < TOOTH_ROWS; k++) {
        for (int i = 0; i < COLUMNS; i++) {
            Seed seed = { .region = ON_TEETH, .k = k, .mouth = row_side };
            seed.s = (double)i / TOOTH_COLUMNS - TEETH / 2;
            seed.u = (double)i / (COLUMNS - 1);
            seed.v = 0.5 + row_side * (0.1 + 0.04 * k);
            now[i] = model_seed(model, PART_TEETH, &seed);
        }
        for (int i = 0; i + 1 < COLUMNS && k > 0; i++) {
            if (row_side > 0) {
                model_quad(model, PART_TEETH, now[i], now[i + 1], before[i + 1], before[i]);
            } else {
                model_quad(model, PART_TEETH, before[i], before[i + 1], now[i + 1], now[i]);
            }
        }
        for (int i = 0; i < COLUMNS; i++) {
            before[i] = now[i];
        }
    }
}

/* Middle of the tongue at `along`, 0 at its root and 1 at its tip. */
static V3 tongue_spine(double along, double out)
{
    V3 rest = v3(0, MOUTH_Y - 0.0088 + 0.0020 * along, lips_z - 0.0330 + 0.0215 * along);
    double droop = smooth(0.45, 1.15, along);
    V3 shown = v3(0, MOUTH_Y - 0.0052 - 0.0200 * droop, lips_z - 0.0330 + 0.0480 * along - 0.0030 * droop);
    return v3_mix(rest, shown, out);
}

V3 tongue_place(const Seed *seed, const Pose *pose)
{
    double along = seed->s, around = seed->t, out = pose->tongue_out;
    double round = sqrt(clamp(1 - pow(along, 9), 0, 1));
    double half_width = mix(0.0125, 0.0120, out) * round;
    double half_height = mix(0.0042, 0.0030, out) * round;
    V3 spine = tongue_spine(along, out), ahead = tongue_spine(along + 0.01, out);
    V3 forward = v3_unit(v3_sub(ahead, spine)), up = v3(0, forward.z, -forward.y);
    double groove = -0.0012 * bump(cos(around) / 0.5) * (sin(around) > 0 ? 1 : 0) * round;
    V3 at = v3_add(spine, v3_scale(up, half_height * sin(around) + groove));
    at.x += half_width * cos(around);
    /* The tongue lies on the jaw; its resting place moves with it in full. */
    Pose jaw = *pose;
    jaw.tongue_out = 0;
    V3 moved = jaw_move(at, 1, &jaw);
    at.y -= 0.0035 * out;
    return v3_add(at, v3_sub(moved, v3(at.x, at.y + 0.0035 * out, at.z)));
}

static void tongue_build(Model *model)
{
    uint32_t before[TONGUE_SEGMENTS], now[TONGUE_SEGMENTS];
    for (int k = 0; k <= TONGUE_RINGS; k++) {
        double along = 1 - pow(1 - (double)k / TONGUE_RINGS, 1.6);
        for (int i = 0; i < TONGUE_SEGMENTS; i++) {
            Seed seed = { .region = ON_TONGUE, .s = along, .t = 2 * PI * i / TONGUE_SEGMENTS };
            seed.u = 0.25 + 0.2 * cos(seed.t);
            seed.v = 0.9 - 0.5 * along - 0.05 * sin(seed.t);
            now[i] = k < TONGUE_RINGS || i == 0 ? model_seed(model, PART_MOUTH, &seed) : now[0];
        }
        for (int i = 0; i < TONGUE_SEGMENTS && k > 0; i++) {
            int next = (i + 1) % TONGUE_SEGMENTS;
            model_quad(model, PART_MOUTH, before[i], before[next], now[next], now[i]);
        }
        for (int i = 0; i < TONGUE_SEGMENTS; i++) {
            before[i] = now[i];
        }
    }
}

/* The place of the cup's vertices in the mouth's own plane. */
static FacePoint bag_point(const Seed *seed)
{
    double x = 0.0265 * cos(seed->s) * cos(seed->t), y = 0.0165 * cos(seed->s) * sin(seed->t);
    FacePoint point = { x, MOUTH_Y + y, -1, y > 0 ? 1 : -1 };
    return point;
}

static double bag_weight(const Seed *seed)
{
    return smooth(-0.004, 0.020, -(0.0165 * cos(seed->s) * sin(seed->t)));
}

double bag_jaw_weight(const Seed *seed)
{
    const Pose rest = { 0 };
    return seed->s > 0 ? bag_weight(seed) : jaw_weight(bag_point(seed), &rest);
}

/* A cup behind the lips, open to the front and wider than the mouth. */
V3 bag_place(const Seed *seed, const Pose *pose)
{
    FacePoint point = bag_point(seed);
    if (seed->s > 0) {
        V3 at = v3(point.s, point.t, lips_z - 0.0080 - 8 * point.s * point.s - 0.0220 * sin(seed->s));
        return jaw_move(at, bag_weight(seed), pose);
    }
    /* The cup's edge is fixed to the inside of the face. */
    V3 at = face_place(point, pose);
    at.z -= 0.0050;
    return at;
}

static void bag_build(Model *model)
{
    uint32_t before[BAG_SEGMENTS], now[BAG_SEGMENTS];
    for (int k = 0; k <= BAG_RINGS; k++) {
        for (int i = 0; i < BAG_SEGMENTS; i++) {
            Seed seed = { .region = ON_BAG, .s = PI / 2 * k / BAG_RINGS, .t = 2 * PI * i / BAG_SEGMENTS };
            seed.u = 0.75 + 0.2 * cos(seed.s) * cos(seed.t);
            seed.v = 0.5 - 0.2 * cos(seed.s) * sin(seed.t);
            now[i] = k < BAG_RINGS || i == 0 ? model_seed(model, PART_MOUTH, &seed) : now[0];
        }
        for (int i = 0; i < BAG_SEGMENTS && k > 0; i++) {
            int next = (i + 1) % BAG_SEGMENTS;
            model_quad(model, PART_MOUTH, before[i], before[next], now[next], now[i]);
        }
        for (int i = 0; i < BAG_SEGMENTS; i++) {
            before[i] = now[i];
        }
    }
}

void mouth_build(Model *model)
{
    teeth_build(model, 1);
    teeth_build(model, -1);
    tongue_build(model);
    bag_build(model);
}
