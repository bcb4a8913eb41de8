#include "face.h"

#include "eye.h"
#include "hair.h"
#include "jaw.h"
#include "relief.h"
#include "stroke.h"

#include <math.h>

#define LID_THICKNESS 0.0013

static double eye_sigma(double s)
{
    return (fabs(s) - EYE_X) / EYE_HALF;
}

/* Exactly shut in the corners, where sigma is 1 but for rounding: upper and lower side meet in one point. */
static double almond(double sigma, double fullness)
{
    double k = 1 - sigma * sigma;
    return k > 1e-9 ? k * (1 + fullness * sigma * sigma) : 0;
}

double eye_almond(double s)
{
    return almond(eye_sigma(s), 0.3);
}
double mouth_almond(double s)
{
    return almond(s / MOUTH_HALF, 0.7);
}

double mouth_gate(double s, double from_line)
{
    double away = fabs(from_line), half_width = MOUTH_HALF + 1.2 * away;
    return pow(almond(s / half_width, 0.7), 1 + 1.5 * smooth(0, 0.010, away));
}

double eye_line(double s)
{
    double sigma = eye_sigma(s);
    return EYE_Y + 0.0007 * sigma * bump(sigma / 2.2) - 0.0017 * bump(sigma / 1.6);
}

double mouth_line(double s)
{
    double sigma = s / MOUTH_HALF;
    return MOUTH_Y + 0.0042 * sigma * sigma * bump(sigma / 2.2) - 0.0007 * bump(sigma / 0.5);
}

double outline_width(double t)
{
    double q = t / FACE_HALF_HEIGHT;
    return 1 + 0.045 * q + 0.045 * bump((q + 0.55) / 0.5) - 0.05 * q * q;
}

/* How far the upper lid stands above the line where lids meet. */
static double upper_lid(int side, const Pose *pose)
{
    double open = 0.0056 + 0.0042 * pose->wide[side] - 0.0018 * pose->squint[side] + 0.0024 * pose->look_up[side] -
                  0.0028 * pose->look_down[side];
    return open * (1 - pose->blink[side]);
}

/* How far the lower lid hangs below that line. */
static double lower_lid(int side, const Pose *pose)
{
    double open = 0.0012 + 0.0014 * pose->wide[side] - 0.0024 * pose->squint[side] - 0.0014 * pose->cheek_squint[side] -
                  0.0004 * pose->smile[side] + 0.0010 * pose->look_down[side];
    return open * (1 - pose->blink[side]);
}

static double lid_shift(FacePoint point, const Pose *pose)
{
    int side = point.s > 0 ? LEFT : RIGHT;
    double from_line = point.t - eye_line(point.s), width = eye_almond(point.s);
    if (point.eye > 0) {
        return upper_lid(side, pose) * width * bump(from_line / 0.020);
    }
    return -lower_lid(side, pose) * width * bump(from_line / 0.016);
}

/* The share of a one-sided mouth movement that a point takes part in. */
static double half_mouth(int side, double s)
{
    return smooth(-0.010, 0.010, side_sign(side) * s);
}

static double lip_shift(FacePoint point, const Pose *pose)
{
    double upper = 0.0030 * pose->funnel;
    double lower = 0.0042 * pose->funnel + 0.0030 * pose->tongue_out;
    double shut = pose->mouth_close + pose->cheek_puff + 0.75 * pose->pucker;
    for (int side = 0; side < SIDES; side++) {
        double half = half_mouth(side, point.s);
        upper += half * (0.0048 * pose->upper_up[side] + 0.0018 * pose->sneer[side]);
        lower += half * 0.0054 * pose->lower_down[side];
        shut += half * pose->press[side];
    }
    double from_line = point.t - mouth_line(point.s);
    double open = mouth_gate(point.s, from_line) * (1 - clamp(shut, 0, 1));
    double grin = open * pose->grin; /* carries all of the red, so that lips stay thick */
    if (point.mouth > 0) {
        return upper * open * bump(from_line / 0.018) + 0.0024 * grin * smooth(0.022, 0.003, from_line);
    }
    return -lower * open * bump(from_line / 0.020) - 0.0030 * grin * smooth(0.026, 0.004, -from_line);
}

/* Brows hardly move the scalp. */
static void drag_brows(V3 *all, FacePoint point, int side, const Pose *pose)
{
    V3 own = v3(0, 0, 0), *shift = &own;
    drag(shift, point.s, point.t, side, pose->brow_inner_up,
         (Stroke){ 0.014, 0.053, 0.027, 0.040, -0.001, 0.0105, 0.0006 });
    drag(shift, point.s, point.t, side, pose->brow_outer_up[side],
         (Stroke){ 0.038, 0.053, 0.027, 0.040, 0, 0.0115, 0 });
    drag(shift, point.s, point.t, side, pose->brow_down[side],
         (Stroke){ 0.017, 0.047, 0.034, 0.040, -0.0035, -0.0090, 0.0016 });
    double held = smooth(-0.022, 0.002, hair_past(point.s, point.t));
    *all = v3_add(*all, v3_scale(own, 1 - 0.8 * held));
}

static void drag_cheeks(V3 *shift, FacePoint point, int side, const Pose *pose)
{
    drag(shift, point.s, point.t, side, pose->cheek_squint[side],
         (Stroke){ 0.036, -0.014, 0.028, 0.022, 0, 0.0062, 0.0046 });
    drag(shift, point.s, point.t, side, pose->squint[side], (Stroke){ 0.034, -0.006, 0.026, 0.016, 0, 0.0020, 0.0012 });
    drag(shift, point.s, point.t, side, pose->smile[side],
         (Stroke){ 0.038, -0.022, 0.025, 0.025, 0.001, 0.0020, 0.0036 });
    drag(shift, point.s, point.t, side, pose->cheek_puff, (Stroke){ 0.038, -0.046, 0.027, 0.038, 0.0085, 0, 0.0120 });
    drag(shift, point.s, point.t, side, pose->sneer[side],
         (Stroke){ 0.014, -0.022, 0.018, 0.020, 0.0020, 0.0064, 0.0008 });
    drag(shift, point.s, point.t, side, pose->sneer[side], (Stroke){ 0.009, 0.004, 0.010, 0.016, 0, 0.0015, 0.0018 });
}

static void drag_mouth(V3 *shift, FacePoint point, int side, const Pose *pose)
{
    const double x = MOUTH_HALF, y = MOUTH_Y;
    drag(shift, point.s, point.t, side, pose->smile[side],
         (Stroke){ x + 0.010, y + 0.002, 0.034, 0.036, 0.0070, 0.0110, -0.0022 });
    drag(shift, point.s, point.t, side, pose->frown[side],
         (Stroke){ x + 0.008, y, 0.033, 0.032, -0.0005, -0.0110, -0.0005 });
    drag(shift, point.s, point.t, side, pose->dimple[side],
         (Stroke){ x + 0.002, y + 0.001, 0.018, 0.016, 0.0035, 0.001, -0.0035 });
    drag(shift, point.s, point.t, side, pose->stretch[side], (Stroke){ x, y, 0.032, 0.026, 0.0085, -0.0020, -0.0025 });
    drag(shift, point.s, point.t, side, pose->press[side], (Stroke){ x, y, 0.026, 0.016, 0.0015, 0.0020, -0.0020 });
    drag(shift, point.s, point.t, side, pose->upper_up[side],
         (Stroke){ 0.014, -0.043, 0.017, 0.015, 0.0005, 0.0022, 0.0008 });
    drag(shift, point.s, point.t, side, 0.5 * (pose->frown[side] + pose->shrug_lower),
         (Stroke){ 0.004, -0.082, 0.024, 0.020, 0, 0.0020, 0.0020 });
}

/* Pulls that act on the whole mouth at once. */
static void drag_whole_mouth(V3 *shift, FacePoint point, const Pose *pose)
{
    double dx = point.s, dy = point.t - MOUTH_Y;
    double wide = bump2(dx, dy, 0.044, 0.032), near = bump2(dx, dy, 0.032, 0.026);
    shift->x -= point.s * wide * (0.46 * pose->pucker + 0.40 * pose->funnel);
    shift->z += near * (0.0075 * pose->pucker + 0.0065 * pose->funnel);
    shift->x += wide * 0.0090 * pose->mouth_side;
    /* The lips alone: each side of the slit moves by itself, so the pull must be zero at the corners. */
    double from_line = point.t - mouth_line(point.s), width = mouth_almond(point.s);
    double red = width * bump(from_line / 0.011);
    if (point.mouth > 0) {
        shift->y -= pose->roll_upper * (0.0012 * red + 0.0035 * width * bump((from_line - 0.007) / 0.010));
        shift->z -= pose->roll_upper * 0.0036 * red;
        shift->y += pose->shrug_upper * 0.0022 * width * bump((from_line - 0.007) / 0.007);
        shift->z += pose->shrug_upper * 0.0028 * width * bump((from_line - 0.003) / 0.014);
    } else {
        shift->y += pose->roll_lower * (0.0014 * red + 0.0040 * width * bump((from_line + 0.008) / 0.011));
        shift->z -= pose->roll_lower * 0.0040 * red;
        shift->z += pose->shrug_lower * 0.0032 * width * bump((from_line + 0.008) / 0.008);
        shift->y += pose->shrug_lower * 0.0038 * width * bump((from_line + 0.010) / 0.010);
    }
}

/* The lids ride on the eyeball: wherever the face would lie lower than a
 * shell around the ball, it is the shell. */
static double over_ball(double x, double y, double depth)
{
    int side = x > 0 ? LEFT : RIGHT;
    return smooth_max(depth, ball_shell(side, x, y, LID_THICKNESS), 0.006);
}

/* A depth over a plane cannot overhang; the nose overhangs because it is dragged down over its own base. */
static double nose_overhang(FacePoint point)
{
    return -0.0032 * bump2(point.s, point.t + 0.0230, 0.0220, 0.0092);
}

V3 face_place(FacePoint point, const Pose *pose)
{
    V3 shift = v3(0, lid_shift(point, pose) + lip_shift(point, pose) + nose_overhang(point), 0);
    for (int side = 0; side < SIDES; side++) {
        drag_brows(&shift, point, side, pose);
        drag_cheeks(&shift, point, side, pose);
        drag_mouth(&shift, point, side, pose);
    }
    drag_whole_mouth(&shift, point, pose);
    double x = point.s + shift.x, y = point.t + shift.y;
    double depth = over_ball(x, y, head_depth(x, y) + relief(point, pose));
    V3 at = v3(x, y, depth + shift.z);
    return jaw_move(at, jaw_weight(point, pose), pose);
}
