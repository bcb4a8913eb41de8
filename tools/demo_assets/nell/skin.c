#include "skin.h"

#include "mask/stroke.h"
#include "shape.h"

#include <math.h>

#define COUNT(list) ((int)(sizeof(list) / sizeof *(list)))
#define LID 0.0012

/* ---- slits ---- */

static double almond(double sigma, double power)
{
    double k = 1 - sigma * sigma;
    return k > 1e-9 ? pow(k, power) : 0;
}

static double eye_sigma(double s)
{
    return (fabs(s) - EYE_S) / EYE_REACH;
}

double lids_width(double s)
{
    return almond(eye_sigma(s), 0.62);
}

double lips_width(double s)
{
    return almond(s / MOUTH_REACH, 0.9);
}

double lids_line(double s)
{
    double sigma = eye_sigma(s);
    return EYE_T + 0.0016 * sigma * bump(sigma / 2.4) - 0.0042 * bump(sigma / 1.9);
}

double lips_line(double s)
{
    double sigma = s / MOUTH_REACH;
    return MOUTH_T + 0.0034 * sigma * sigma * bump(sigma / 2.4);
}

/* As lips_width, but wider and softer away from the line: only on the line must it end at the corners. */
static double lips_gate(double s, double from_line)
{
    double away = fabs(from_line);
    return pow(almond(s / (MOUTH_REACH + 1.1 * away), 0.62), 1 + 2.0 * smooth(0, 0.010, away));
}

double red_edge(double s, int side)
{
    double sigma = s / MOUTH_REACH, width = pow(almond(sigma, 1), side > 0 ? 0.85 : 0.75);
    double bow = 0.0011 * bump(sigma / 0.26) - 0.0006 * bump((fabs(sigma) - 0.28) / 0.28);
    return side > 0 ? (0.0052 - bow) * width : -0.0066 * width;
}

/* ---- eyes ---- */

V3 eyeball(int side)
{
    return v3(side_sign(side) * 0.0328, -0.0005, 0.0489);
}

double eyeball_shell(int side, double x, double y, double lift)
{
    V3 centre = eyeball(side);
    double dx = x - centre.x, dy = y - centre.y, radius = EYEBALL + lift, edge = 0.05;
    double inside = 1 - (dx * dx + dy * dy) / (radius * radius);
    if (inside > edge) {
        return centre.z + radius * sqrt(inside);
    }
    return centre.z + radius * (sqrt(edge) + (inside - edge) / (2 * sqrt(edge)));
}

static double upper_lid(int side, const Pose *pose)
{
    double open = 0.0170 + 0.0026 * pose->wide[side] - 0.0040 * pose->squint[side] + 0.0016 * pose->look_up[side] -
                  0.0062 * pose->look_down[side] - 0.0012 * pose->smile[side];
    return open * (1 - pose->blink[side]);
}

static double lower_lid(int side, const Pose *pose)
{
    double open = 0.0046 + 0.0012 * pose->wide[side] - 0.0040 * pose->squint[side] - 0.0012 * pose->cheek_squint[side] -
                  0.0010 * pose->smile[side] - 0.0010 * pose->grin + 0.0012 * pose->look_down[side];
    return open * (1 - pose->blink[side]);
}

static double lid_shift(SkinPoint p, const Pose *pose)
{
    int side = p.s > 0 ? LEFT : RIGHT;
    double from_line = p.t - lids_line(p.s), width = lids_width(p.s);
    if (p.eye > 0) {
        return upper_lid(side, pose) * width * bump(from_line / 0.036);
    }
    return -lower_lid(side, pose) * width * bump(from_line / 0.020);
}

/* How much of the skin lies on the ball: all about the eye. */
static double on_ball(SkinPoint p)
{
    double out = fabs(p.s) - EYE_S, up = p.t - lids_line(p.s);
    double across = fabs(out) / (out > 0 ? 0.0330 : 0.0265);
    if (up < 0) {
        return smooth(1, 0.50, across) * smooth(0.021, 0.0010, -up);
    }
    return smooth(1, 0.45, sqrt(across * across + up * up / (0.027 * 0.027)));
}

/* ---- features ---- */

/* Soft hills and hollows, mirrored left and right. Millimetres. */
typedef struct {
    double x, y, rx, ry, height;
} Hill;

static const Hill hills[] = {
    { 27, 27, 30, 15, 1.6 },       /* brow */
    { 34, -22, 30, 17, 1.2 },      /* under the eye */
    { 40, -31, 32, 27, 4.4 },      /* cheek */
    { 54, -16, 26, 24, 1.6 },      /* cheekbone */
    { 0, -43, 32, 26, 2.2 },       /* the round of the teeth (counts twice) */
    { 0, -71, 20, 15, 2.4 },       /* chin (twice) */
    { 0, -58, 17, 6, -0.5 },       /* hollow under the lip (twice) */
    { 25, -42, 9, 9, -1.0 },       /* corner of the mouth */
    { 8.6, -22.5, 6.5, 6.0, 3.4 }, /* wing of the nose */
    { 4.2, -27.0, 3.4, 2.8, -1.0 } /* nostril */
};

static double nose(double s, double t)
{
    static const Key height[] = { { -0.0300, 0 },      { -0.0275, 0.0018 }, { -0.0248, 0.0084 }, { -0.0218, 0.0134 },
                                  { -0.0180, 0.0150 }, { -0.0130, 0.0128 }, { -0.0050, 0.0076 }, { 0.0060, 0.0038 },
                                  { 0.0200, 0.0014 },  { 0.0320, 0 } };
    static const Key width[] = {
        { -0.0280, 0.0130 }, { -0.0180, 0.0142 }, { -0.0100, 0.0132 }, { 0.0060, 0.0150 }, { 0.0320, 0.0200 }
    };
    return curve(height, COUNT(height), t) * bump(s / curve(width, COUNT(width), t));
}

static double lips(SkinPoint p)
{
    static const Key upper[] = { { 0, -0.0002 },     { 0.0012, 0.0008 }, { 0.0034, 0.0020 },
                                 { 0.0062, 0.0013 }, { 0.0100, 0.0002 }, { 0.0130, 0 } };
    static const Key lower[] = { { 0, -0.0002 },     { 0.0012, 0.0010 },  { 0.0042, 0.0028 },
                                 { 0.0078, 0.0016 }, { 0.0115, -0.0002 }, { 0.0150, 0 } };
    double away = fabs(p.t - lips_line(p.s)), wide = bump(p.s / 0.036);
    return wide * (p.mouth > 0 ? curve(upper, COUNT(upper), away) : curve(lower, COUNT(lower), away));
}

static double relief(SkinPoint p)
{
    double sum = lips(p) + nose(p.s, p.t);
    for (int i = 0; i < COUNT(hills); i++) {
        const Hill *h = &hills[i];
        double x = h->x * 0.001, y = p.t - h->y * 0.001, rx = h->rx * 0.001, ry = h->ry * 0.001;
        sum += h->height * 0.001 * (bump2(p.s - x, y, rx, ry) + bump2(p.s + x, y, rx, ry));
    }
    return sum - 0.0006 * bump2(p.s, p.t + 0.0335, 0.0040, 0.0060);
}

/* The fold above the lid: it follows the lid's edge at rest. */
static double lid_fold(SkinPoint p)
{
    double sigma = eye_sigma(p.s) / 1.12, rise = 0.0078 * almond(sigma, 0.9);
    return p.eye > 0 ? -0.0011 * bump((p.t - lids_line(p.s) - rise) / 0.0042) * bump(sigma) : 0;
}

/* ---- muscles ---- */

/* The share of a one-sided mouth movement that a point takes part in. */
static double half_mouth(int side, double s)
{
    return smooth(-0.010, 0.010, side_sign(side) * s);
}

static double lip_shift(SkinPoint p, const Pose *pose)
{
    double upper = 0.0030 * pose->funnel + 0.0014 * pose->shrug_upper;
    double lower = 0.0036 * pose->funnel + 0.0040 * pose->tongue_out;
    for (int side = 0; side < SIDES; side++) {
        double half = half_mouth(side, p.s);
        upper += half * (0.0042 * pose->upper_up[side] + 0.0010 * pose->sneer[side]);
        lower += half * 0.0048 * pose->lower_down[side];
    }
    double from_line = p.t - lips_line(p.s), gate = lips_gate(p.s, from_line) * (1 - clamp(pose->mouth_close, 0, 1));
    double grin = gate * pose->grin; /* carries all of the red, so that lips stay thick */
    return p.mouth > 0 ? upper * gate * bump(from_line / 0.018) + 0.0042 * grin * smooth(0.020, 0.003, from_line)
                       : -lower * gate * bump(from_line / 0.020) - 0.0039 * grin * smooth(0.026, 0.004, -from_line);
}

static void drag_upper_face(V3 *d, double s, double t, int side, const Pose *p)
{
    drag(d, s, t, side, p->brow_inner_up, (Stroke){ 0.014, 0.036, 0.028, 0.034, 0, 0.0080, 0.0006 });
    drag(d, s, t, side, p->brow_outer_up[side], (Stroke){ 0.042, 0.036, 0.028, 0.034, 0, 0.0085, 0 });
    drag(d, s, t, side, p->brow_down[side], (Stroke){ 0.020, 0.032, 0.036, 0.032, -0.0028, -0.0068, 0.0014 });
    drag(d, s, t, side, p->cheek_squint[side], (Stroke){ 0.040, -0.026, 0.034, 0.030, 0, 0.0014, 0.0010 });
    drag(d, s, t, side, p->squint[side], (Stroke){ 0.036, -0.020, 0.026, 0.016, 0, 0.0016, 0.0008 });
    drag(d, s, t, side, p->smile[side], (Stroke){ 0.042, -0.034, 0.036, 0.036, 0.001, 0.0014, 0.0008 });
    drag(d, s, t, side, p->grin, (Stroke){ 0.042, -0.032, 0.032, 0.030, 0.001, 0.0022, 0.0024 });
    drag(d, s, t, side, p->cheek_puff, (Stroke){ 0.040, -0.042, 0.030, 0.032, 0.0070, 0, 0.0090 });
    drag(d, s, t, side, p->sneer[side], (Stroke){ 0.012, -0.024, 0.016, 0.018, 0.0012, 0.0040, 0.0006 });
}

static void drag_mouth(V3 *d, double s, double t, int side, const Pose *p)
{
    const double x = MOUTH_REACH, y = MOUTH_T;
    drag(d, s, t, side, p->smile[side], (Stroke){ x + 0.006, y - 0.001, 0.034, 0.044, 0.0064, 0.0068, -0.0008 });
    drag(d, s, t, side, p->frown[side], (Stroke){ x + 0.006, y, 0.030, 0.030, -0.0004, -0.0082, -0.0004 });
    drag(d, s, t, side, p->dimple[side], (Stroke){ x + 0.002, y + 0.001, 0.018, 0.016, 0.0032, 0.0010, -0.0032 });
    drag(d, s, t, side, p->stretch[side], (Stroke){ x, y, 0.031, 0.026, 0.0065, -0.0014, -0.0026 });
    drag(d, s, t, side, p->press[side], (Stroke){ x, y, 0.024, 0.014, 0.0012, 0.0012, -0.0014 });
    drag(d, s, t, side, p->upper_up[side], (Stroke){ 0.012, -0.035, 0.017, 0.014, 0.0004, 0.0018, 0.0006 });
    drag(d, s, t, side, 0.5 * (p->frown[side] + p->shrug_lower),
         (Stroke){ 0.004, -0.070, 0.022, 0.018, 0, 0.0018, 0.0016 });
}

static void drag_lips(V3 *d, SkinPoint p, const Pose *pose)
{
    double y = p.t - MOUTH_T, wide = bump2(p.s, y, 0.042, 0.030), near = bump2(p.s, y, 0.030, 0.024);
    d->x -= p.s * wide * (0.44 * pose->pucker + 0.34 * pose->funnel);
    d->z += near * (0.0064 * pose->pucker + 0.0056 * pose->funnel);
    d->x += wide * 0.0080 * pose->mouth_side;
    double from_line = p.t - lips_line(p.s), width = lips_width(p.s), red = width * bump(from_line / 0.010);
    double press = 0.5 * (pose->press[LEFT] + pose->press[RIGHT]);
    d->z -= 0.0012 * press * red;
    if (p.mouth > 0) {
        d->y -= pose->roll_upper * 0.0030 * width * bump((from_line - 0.006) / 0.006);
        d->z -= pose->roll_upper * 0.0030 * red;
        d->y += pose->shrug_upper * 0.0020 * width * bump((from_line - 0.006) / 0.006);
        d->z += pose->shrug_upper * 0.0022 * width * bump((from_line - 0.004) / 0.012);
        d->y -= press * 0.0012 * width * bump((from_line - 0.006) / 0.006);
    } else {
        d->y += pose->roll_lower * 0.0034 * width * bump((from_line + 0.007) / 0.007);
        d->z -= pose->roll_lower * 0.0034 * red;
        d->z += pose->shrug_lower * 0.0026 * width * bump((from_line + 0.004) / 0.012);
        d->y += pose->shrug_lower * 0.0018 * width * bump((from_line + 0.009) / 0.009);
        d->y += press * 0.0014 * width * bump((from_line + 0.007) / 0.007);
    }
}

/* ---- jaw ---- */

static double jaw_weight(SkinPoint p, const Pose *pose)
{
    double skin = smooth(0.016, 0.080, -p.t) * smooth(0.145, 0.103, -p.t) * smooth(0.118, 0.060, fabs(p.s));
    double from_line = p.t - lips_line(p.s);
    double parted = lips_gate(p.s, from_line) * (1 - clamp(pose->mouth_close, 0, 1));
    if (p.mouth > 0) {
        return skin * (1 - parted * bump(from_line / 0.030));
    }
    return skin + (1 - skin) * parted * bump(from_line / 0.040) * smooth(0.145, 0.103, -p.t);
}

V3 jaw_turn(V3 at, double weight, const Pose *pose)
{
    const double hinge_y = -0.012, hinge_z = -0.010;
    double angle = 0.27 * (pose->jaw_open + 0.30 * pose->tongue_out + 0.16 * pose->funnel);
    double y = at.y - hinge_y, z = at.z - hinge_z;
    /* Exactly nothing at rest: the lips' copies stay in one place. */
    V3 turn = v3(0.0075 * pose->jaw_side, y * (cos(angle) - 1) - z * sin(angle),
                 z * (cos(angle) - 1) + y * sin(angle) + 0.0060 * pose->jaw_forward);
    return v3_add(at, v3_scale(turn, weight));
}

/* ---- places ---- */

SkinPoint skin_point(const Seed *seed)
{
    SkinPoint p = { seed->s, seed->t, seed->eye, seed->mouth };
    return p;
}

V3 skin_place(SkinPoint p, const Pose *pose)
{
    V3 d = v3(0, lid_shift(p, pose) + lip_shift(p, pose), 0);
    for (int side = 0; side < SIDES; side++) {
        drag_upper_face(&d, p.s, p.t, side, pose);
        drag_mouth(&d, p.s, p.t, side, pose);
    }
    drag_lips(&d, p, pose);
    double s = p.s + d.x, t = p.t + d.y;
    V3 at = v3_add(shape_at(s, t), v3_scale(shape_out(s, t), relief(p)));
    int side = p.s > 0 ? LEFT : RIGHT;
    if (at.z > 0) {
        /* Flatter below the ball's middle, towards the cheek. */
        double middle = eyeball(side).y, y = at.y < middle ? middle + 0.86 * (at.y - middle) : at.y;
        double shell = eyeball_shell(side, at.x, y, LID);
        at.z = smooth_max(mix(at.z, shell, on_ball(p)), shell, 0.012) + lid_fold(p);
    }
    at.z += d.z;
    at.y -= 0.0022 * bump2(p.s, p.t + 0.0200, 0.016, 0.012);
    return jaw_turn(at, jaw_weight(p, pose), pose);
}

/* From the lid's edge back to just behind the ball's surface. */
V3 lid_place(const Seed *seed, const Pose *pose)
{
    static const double depth[] = { 0, 0.5, 1 }, spread[] = { 0, 0.0003, 0.0024 };
    int row = (int)seed->k;
    V3 at = skin_place(skin_point(seed), pose);
    double inner = eyeball_shell(seed->s > 0 ? LEFT : RIGHT, at.x, at.y, 0) - 0.0014;
    at.y += seed->eye * spread[row] * sqrt(lids_width(seed->s));
    at.z = mix(at.z, inner, depth[row]);
    return at;
}

/* How far a pose parts the lips, 0 to 1. */
static double lips_open(const Pose *pose)
{
    double parted = 0;
    for (int side = 0; side < SIDES; side++) {
        parted += 0.5 * (pose->upper_up[side] + pose->lower_down[side]);
    }
    return clamp(pose->grin + 2 * pose->jaw_open + pose->funnel + pose->tongue_out + 0.5 * parted, 0, 1) *
           (1 - clamp(pose->mouth_close, 0, 1));
}

/* From the lip's edge inwards, curling up (or down) behind the lip. The lower lip is pressed into the upper one, so
 * that a slight smile parts them hardly at all. */
V3 lip_place(const Seed *seed, const Pose *pose)
{
    static const double back[] = { 0, 0.0012, 0.0024, 0.0033, 0.0038 };
    static const double spread[] = { 0, 0.0001, 0.0014, 0.0050, 0.0100 };
    static const double pressed[] = { 0, 0.0022, 0.0036, 0.0020, 0 };
    int row = (int)seed->k;
    double width = sqrt(lips_width(seed->s));
    V3 at = skin_place(skin_point(seed), pose);
    at.y += seed->mouth * spread[row] * width;
    if (seed->mouth < 0) {
        at.y += pressed[row] * width * (1 - lips_open(pose));
    }
    at.z -= back[row];
    return at;
}
