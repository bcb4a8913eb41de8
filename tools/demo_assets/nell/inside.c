/* Eyes, ears and the inside of the mouth: the mask's meshes, in other places. */
#include "parts.h"

#include "mask/ear.h"
#include "skin.h"

#include <math.h>

#define MM 0.001

/* The mask's rings are spread, for a large iris. */
V3 nell_ball_place(const Seed *seed, const Pose *pose)
{
    int side = seed->eye > 0 ? LEFT : RIGHT;
    double ring = 1.45 * seed->s - 0.48 * smooth(0.4, 1.12, seed->s), still = smooth(1.15, 0.75, ring);
    double around = seed->t;
    double yaw = still * side_sign(side) * (0.03 + 0.40 * (pose->look_out[side] - pose->look_in[side]));
    double pitch = still * (0.30 * pose->look_up[side] - 0.32 * pose->look_down[side]);
    V3 d = v3(sin(ring) * cos(around), sin(ring) * sin(around), cos(ring));
    V3 pitched = v3(d.x, d.y * cos(pitch) + d.z * sin(pitch), d.z * cos(pitch) - d.y * sin(pitch));
    V3 turned = v3(pitched.x * cos(yaw) + pitched.z * sin(yaw), pitched.y, pitched.z * cos(yaw) - pitched.x * sin(yaw));
    return v3_add(eyeball(side), v3_scale(turned, EYEBALL));
}

V3 nell_ear_place(const Seed *seed)
{
    V3 at = ear_place(seed);
    double side = seed->eye, scale = 1.12;
    V3 from = v3(side * at.x - 0.0696, at.y, at.z + 0.0084);
    /* Turned to lie closer to the head. */
    double across = 0.98 * from.x + 0.20 * from.z, ahead = 0.98 * from.z - 0.20 * from.x;
    return v3(side * (0.0765 + scale * across), -0.004 + scale * from.y, -0.0050 + scale * ahead);
}

/* ---- mouth ---- */

static const double lips_z = 0.0816;

/* seed->s counts ten teeth from the middle, seed->k rows from the gum. rise: away from the cutting edge. */
V3 nell_teeth_place(const Seed *seed, const Pose *pose)
{
    static const double rise[] = { 12.5, 10.0, 7.0, 3.6, 1.4, 0, 0.8, 6.0 };
    static const double back[] = { 2.6, 0.6, 0, 0, 0.3, 1.6, 3.2, 4.6 };
    int row = (int)seed->k, upper = seed->mouth > 0;
    double across = 2 * (seed->s - floor(seed->s)) - 1, corner = across * across * across * across;
    double wide = upper ? 0.0275 : 0.0245, deep = upper ? 0.0230 : 0.0210, angle = seed->s / 5 * 1.35;
    double in = back[row] * MM + 0.0004 * corner;
    double up = rise[row] * MM + (row >= 3 ? 0.0004 * corner : 0);
    double arc = 0.0016 * (1 - cos(angle)), aside = pow(1 - cos(angle), 1.3);
    V3 at = v3((wide - in) * sin(angle), upper ? MOUTH_T - 0.0040 + up + arc : MOUTH_T - 0.0050 - up + arc,
               lips_z - 0.0055 - in - (deep - in) * aside - (upper ? 0 : 0.0018));
    return jaw_turn(at, upper ? 0 : 1, pose);
}

/* Middle of the tongue at `along`, 0 at its root and 1 at its tip. */
static V3 tongue_spine(double along, const Pose *pose)
{
    V3 rest = v3(0, MOUTH_T - 0.0105 + 0.0015 * along, lips_z - 0.0400 + 0.0275 * along);
    double droop = smooth(0.45, 1.15, along);
    V3 shown = v3(0, MOUTH_T - 0.0062 - 0.0150 * droop, lips_z - 0.0400 + 0.0560 * along - 0.0030 * droop);
    V3 at = v3_mix(rest, shown, pose->tongue_out);
    at.y += 0.0075 * pose->tongue_up * smooth(0.3, 1, along);
    return at;
}

V3 nell_tongue_place(const Seed *seed, const Pose *pose)
{
    double along = seed->s, around = seed->t, round = sqrt(clamp(1 - pow(along, 7), 0, 1));
    V3 spine = tongue_spine(along, pose), ahead = tongue_spine(along + 0.01, pose);
    V3 forward = v3_unit(v3_sub(ahead, spine)), up = v3(0, forward.z, -forward.y);
    double groove = -0.0012 * bump(cos(around) / 0.5) * (sin(around) > 0 ? 1 : 0) * round;
    V3 at = v3_add(spine, v3_scale(up, 0.0042 * round * sin(around) + groove));
    at.x += 0.0135 * round * cos(around);
    /* It lies on the jaw, which opens no further for a tongue that is out. */
    Pose jaw = *pose;
    jaw.tongue_out = 0;
    return jaw_turn(at, 1, &jaw);
}

/* A cup behind the lips, fixed to the inside of the face. */
V3 nell_bag_place(const Seed *seed, const Pose *pose)
{
    double x = 0.0285 * cos(seed->s) * cos(seed->t), y = 0.0170 * cos(seed->s) * sin(seed->t);
    SkinPoint p = { x, MOUTH_T + y, -1, y > 0 ? 1 : -1 };
    if (seed->s > 0) {
        V3 at = v3(x, MOUTH_T + y, lips_z - 0.0130 - 18 * x * x - 0.0350 * sin(seed->s));
        return jaw_turn(at, smooth(-0.004, 0.020, -y), pose);
    }
    V3 at = skin_place(p, pose);
    at.z -= 0.0060;
    return at;
}
