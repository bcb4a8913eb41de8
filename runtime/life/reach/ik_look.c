/* ik_look.c: a direction that turns towards a target within a cone. */
#include "core/base/assert_internal.h"
#include "core/base/trig_internal.h"
#include "noh/body.h"
#include "noh/low_core.h"
#include "core/base/vector_internal.h"
#include "life/reach/rig_internal.h"
#include "life/reach/gaze_internal.h"

static const float up[3] = { 0.0f, 1.0f, 0.0f };

void noh_ik_look_init(noh_ik_look *look, const float ahead[3])
{
    memcpy(look->direction, ahead, sizeof look->direction);
    look->follows = 0;
}

/* Radians between two directions, by sine and cosine, which is precise near 0 and near pi. */
static float angle_between(const float a[3], const float b[3])
{
    float normal[3];
    noh_cross3(a, b, normal);
    return noh_atan2(noh_length3(normal), noh_dot3(a, b));
}

/* Turn direction a towards b, by at most `most` radians. */
static void turn_towards(const float a[3], const float b[3], float most, float out[3])
{
    float axis[3], rotation[3] = { 0.0f, 0.0f, 0.0f }, q[4];
    if (angle_between(a, b) <= most) {
        memcpy(out, b, 3 * sizeof *out);
    } else {
        noh_cross3(a, b, axis);
        noh_perpendicular3(a, noh_dot3(axis, axis) > 1e-12f ? axis : up, axis);
        noh_madd3(rotation, most, axis, rotation);
        noh_quat_from_rotation(rotation, q);
        noh_quat_rotate(q, a, out);
    }
    noh_normalize3(out, a);
}

/* Behind, where a small motion of the target makes a large turn, the side is kept: noh_ik_look.follows. */
#define BEHIND_RAD (8.0f * NOH_PI / 9.0f)
#define BEHIND_SINE 0.34202014f

enum { LOOKS_AHEAD = 0, LOOKS_AT, LOOKS_LEFT, LOOKS_RIGHT };

/* Move a target behind to the side from which it came, as far aside as the limit of "behind". One that was teleported
 * there is looked at over the shoulder to which the look has turned already. */
static void keep_side(noh_ik_look *look, const float ahead[3], float target[3])
{
    float left[3], aside;
    noh_cross3(up, ahead, left);
    noh_perpendicular3(ahead, left, left);
    aside = noh_dot3(target, left);
    if (look->follows < LOOKS_LEFT) {
        const float turned = noh_dot3(look->direction, left), part = aside < 0.0f ? -aside : aside;
        look->follows = (part < 0.5f * BEHIND_SINE && turned != 0.0f ? turned : aside) < 0.0f ? LOOKS_RIGHT
                                                                                              : LOOKS_LEFT;
    }
    if (look->follows == LOOKS_RIGHT) {
        noh_madd3(target, (aside > -BEHIND_SINE ? -BEHIND_SINE : aside) - aside, left, target);
    } else {
        noh_madd3(target, (aside < BEHIND_SINE ? BEHIND_SINE : aside) - aside, left, target);
    }
}

/* Where to look: at the target, or towards it as far as the cone allows; ahead if there is none. */
static void wanted_of(noh_ik_look *look, float angle_max, const float ahead[3], const float *target, float wanted[3])
{
    float direction[3] = { 0.0f, 0.0f, 0.0f }, angle;
    if (target) memcpy(direction, target, sizeof direction);
    if (!(noh_dot3(direction, direction) > 1e-24f)) {
        look->follows = LOOKS_AHEAD;
        memcpy(wanted, ahead, sizeof direction);
        return;
    }
    noh_normalize3(direction, ahead);
    angle = angle_between(ahead, direction);
    if (angle > BEHIND_RAD && angle > angle_max) {
        keep_side(look, ahead, direction);
    } else {
        look->follows = LOOKS_AT;
    }
    turn_towards(ahead, direction, angle_max, wanted);
}

void noh_ik_look_step(noh_ik_look *look, float angle_max, float speed_max, const float ahead[3], const float *target,
                      float seconds, float rotation[4])
{
    float wanted[3], next[3];
    NOH_ASSERT(look && ahead && rotation && seconds >= 0.0f);
    wanted_of(look, angle_max, ahead, target, wanted);
    turn_towards(look->direction, wanted, speed_max * seconds, next);
    turn_towards(ahead, next, angle_max, look->direction); /* the direction ahead may have moved */
    noh_quat_between(ahead, look->direction, up, rotation);
}

void noh_ik_share(const float rotation[4], float share, float out[4])
{
    float by[3];
    noh_quat_to_rotation(rotation, by);
    for (int i = 0; i < 3; i++) by[i] *= share;
    noh_quat_from_rotation(by, out);
}
