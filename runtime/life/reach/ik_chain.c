/* ik_chain.c: three solvers over one chain of joints. After each iteration, positions match rotations. */
#include "core/base/trig_internal.h"
#include "life/reach/ik_chain_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_core.h"

#include "core/base/assert_internal.h"
#include "core/base/vector_internal.h"

static const float identity[4] = { 0.0f, 0.0f, 0.0f, 1.0f };

/* A chain being solved. All in the space of its root, except `local`. */
typedef struct work {
    const noh_ik_chain *chain;
    float target[3], length;
    float local[NOH_IK_JOINTS_MAX][4];
    float joints[NOH_IK_JOINTS_MAX][4];         /* rotations */
    float positions[NOH_IK_JOINTS_MAX + 1u][3]; /* the last is the end */
} work;

/* ---- limits ---- */

/* Clamp an angle to a range. Outside it, the nearer end around the circle counts. */
static float within(float angle, float least, float most)
{
    if (angle >= least && angle <= most) return angle;
    float below = least - angle, above = angle - most;
    below = below < 0.0f ? below + 2.0f * NOH_PI : below;
    above = above < 0.0f ? above + 2.0f * NOH_PI : above;
    return below < above ? least : most;
}

void noh_ik_limit_apply(const noh_ik_limit *limit, const float bone[3], const float *bind, float rotation[4])
{
    static const float along[3] = { 0.0f, 0.0f, 1.0f };
    float back[4], twist[4], swing[4], axis[3], angle, by[3];
    if (!limit->flags) return;
    memcpy(axis, bone, sizeof axis);
    noh_normalize3(axis, along);
    noh_quat_conjugate(bind ? bind : identity, back);
    noh_quat_mul(back, rotation, swing);
    for (int i = 0; i < 3; i++) twist[i] = axis[i] * noh_dot3(swing, axis);
    twist[3] = swing[3];
    noh_quat_normalize(twist); /* half a turn of swing has no twist: the identity */
    noh_quat_conjugate(twist, back);
    noh_quat_mul(swing, back, swing);
    noh_quat_to_rotation(twist, by);
    angle = noh_dot3(by, axis);
    if (limit->flags & NOH_IK_LIMIT_TWIST) angle = within(angle, limit->twist_min, limit->twist_max);
    for (int i = 0; i < 3; i++) by[i] = axis[i] * angle;
    noh_quat_from_rotation(by, twist);
    noh_quat_to_rotation(swing, by);
    angle = noh_length3(by);
    if ((limit->flags & NOH_IK_LIMIT_SWING) && angle > limit->swing_max) {
        for (int i = 0; i < 3; i++) by[i] *= limit->swing_max / angle;
        noh_quat_from_rotation(by, swing);
    }
    noh_quat_mul(swing, twist, rotation);
    noh_quat_mul(bind ? bind : identity, rotation, rotation);
    noh_quat_normalize(rotation);
}

static void limit_joint(work *w, uint32_t j)
{
    const noh_ik_chain *c = w->chain;
    if (c->limits) noh_ik_limit_apply(&c->limits[j], c->bones + 3 * j, c->binds ? c->binds + 4 * j : NULL, w->local[j]);
}

/* ---- forward kinematics ---- */

static const float *carrier(const work *w, uint32_t j)
{
    return j ? w->joints[j - 1] : w->chain->root_rotation ? w->chain->root_rotation : identity;
}

static void place_joint(work *w, uint32_t j)
{
    float bone[3];
    noh_quat_mul(carrier(w, j), w->local[j], w->joints[j]);
    noh_quat_rotate(w->joints[j], w->chain->bones + 3 * j, bone);
    noh_madd3(w->positions[j], 1.0f, bone, w->positions[j + 1]);
}

static void place_from(work *w, uint32_t j)
{
    for (; j < w->chain->count; j++) place_joint(w, j);
}

/* Turn a joint by a rotation in the root's space, within its limits. Its descendants keep their old positions. */
static void turn(work *w, uint32_t j, const float q[4])
{
    float back[4];
    noh_quat_conjugate(carrier(w, j), back);
    noh_quat_mul(q, w->joints[j], w->local[j]);
    noh_quat_mul(back, w->local[j], w->local[j]);
    noh_quat_normalize(w->local[j]);
    limit_joint(w, j);
}

/* Turn a joint so that `from`, seen from it, comes to `to`. */
static void turn_between(work *w, uint32_t j, const float from[3], const float to[3])
{
    static const float up[3] = { 0.0f, 1.0f, 0.0f };
    float a[3], b[3], q[4];
    noh_sub3(from, w->positions[j], a);
    noh_sub3(to, w->positions[j], b);
    noh_quat_between(a, b, up, q);
    turn(w, j, q);
}

static float missed(const work *w)
{
    float rest[3];
    noh_sub3(w->target, w->positions[w->chain->count], rest);
    return noh_length3(rest);
}

/* ---- one iteration of each ---- */

static void iterate_ccd(work *w)
{
    for (uint32_t j = w->chain->count; j-- > 0;) {
        turn_between(w, j, w->positions[w->chain->count], w->target);
        place_from(w, j);
    }
}

/* From the target back to the root by lengths alone; then from the root on, turn each joint towards the new end of its
 * bone, within its limits. */
static void iterate_fabrik(work *w)
{
    const uint32_t count = w->chain->count;
    float wanted[NOH_IK_JOINTS_MAX + 1u][3];
    memcpy(wanted[count], w->target, sizeof wanted[0]);
    for (uint32_t j = count; j-- > 1;) {
        float back[3];
        noh_sub3(w->positions[j], wanted[j + 1], back);
        const float length = noh_length3(w->chain->bones + 3 * j), now = noh_length3(back);
        noh_madd3(wanted[j + 1], now > 0.0f ? length / now : 0.0f, back, wanted[j]);
    }
    for (uint32_t j = 0; j < count; j++) {
        place_joint(w, j); /* as the joints before it have turned */
        turn_between(w, j, w->positions[j + 1], wanted[j + 1]);
        place_joint(w, j);
    }
}

/* f = (J J^T + lambda^2)^-1 e, symmetric 3 x 3, by cofactors. A joint that turns freely by a rotation vector u moves
 * the end by u x r, so J J^T is the sum of |r|^2 - r r^T, and its turn is J^T f = r x f. lambda is a share of the
 * length, so the solution does not depend on units. */
static void least_squares(const work *w, const float e[3], float f[3])
{
    float a[6] = { 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f };
    a[0] = a[3] = a[5] = 3e-4f * w->length * w->length;
    for (uint32_t j = 0; j < w->chain->count; j++) {
        float r[3];
        noh_sub3(w->positions[w->chain->count], w->positions[j], r);
        const float square = noh_dot3(r, r);
        a[0] += square - r[0] * r[0];
        a[1] -= r[0] * r[1];
        a[2] -= r[0] * r[2];
        a[3] += square - r[1] * r[1];
        a[4] -= r[1] * r[2];
        a[5] += square - r[2] * r[2];
    }
    const float c0 = a[3] * a[5] - a[4] * a[4], c1 = a[2] * a[4] - a[1] * a[5], c2 = a[1] * a[4] - a[2] * a[3];
    const float c3 = a[0] * a[5] - a[2] * a[2], c4 = a[1] * a[2] - a[0] * a[4], c5 = a[0] * a[3] - a[1] * a[1];
    const float inverse = 1.0f / (a[0] * c0 + a[1] * c1 + a[2] * c2);
    f[0] = inverse * (c0 * e[0] + c1 * e[1] + c2 * e[2]);
    f[1] = inverse * (c1 * e[0] + c3 * e[1] + c4 * e[2]);
    f[2] = inverse * (c2 * e[0] + c4 * e[1] + c5 * e[2]);
}

static void iterate_dls(work *w)
{
    const uint32_t count = w->chain->count;
    float turns[NOH_IK_JOINTS_MAX][4], e[3], f[3];
    noh_sub3(w->target, w->positions[count], e);
    const float size = noh_length3(e), most = w->length / 6.0f; /* a step for which the chain is nearly linear */
    for (int i = 0; i < 3 && size > most; i++) e[i] *= most / size;
    least_squares(w, e, f);
    for (uint32_t j = 0; j < count; j++) {
        float r[3], by[3];
        noh_sub3(w->positions[count], w->positions[j], r);
        noh_cross3(r, f, by);
        noh_quat_from_rotation(by, turns[j]);
    }
    /* Turns add up along the chain; each joint is turned from its present rotation, which differs only in second
     * order. */
    for (uint32_t j = 0; j < count; j++) {
        place_joint(w, j);
        turn(w, j, turns[j]);
        place_joint(w, j);
    }
}

/* A straight chain with its target on its line has no direction to bend in: bend it a little, to one side. */
static void unbend(work *w)
{
    static const float up[3] = { 0.0f, 1.0f, 0.0f };
    float along[3], by[3], q[4];
    noh_sub3(w->positions[w->chain->count], w->positions[0], along);
    noh_normalize3(along, up);
    noh_perpendicular3(along, up, by);
    for (int i = 0; i < 3; i++) by[i] *= 0.1f;
    noh_quat_from_rotation(by, q);
    for (uint32_t j = 0; j < w->chain->count; j++) {
        place_joint(w, j);
        turn(w, j, q);
        place_joint(w, j);
    }
}

/* ---- the solver ---- */

static noh_result check(const noh_ik_chain *chain, const float target[3], noh_error *error)
{
    if (chain->count == 0 || chain->count > NOH_IK_JOINTS_MAX) {
        return noh_fail(error, NOH_ERR_ARG, "count of a chain must be 1 to NOH_IK_JOINTS_MAX", chain->count,
                        NOH_IK_JOINTS_MAX);
    }
    if (!noh_is_finite(target[0] + target[1] + target[2])) {
        return noh_fail(error, NOH_ERR_ARG, "the target is not finite", 0, 0);
    }
    return NOH_OK;
}

static void begin(work *w, const noh_ik_chain *chain, const float target[3], const float *rotations)
{
    w->chain = chain;
    w->length = 0.0f;
    memcpy(w->target, target, sizeof w->target);
    memcpy(w->local, rotations, chain->count * sizeof w->local[0]);
    memcpy(w->positions[0], chain->root, sizeof w->positions[0]);
    for (uint32_t j = 0; j < chain->count; j++) {
        w->length += noh_length3(chain->bones + 3 * j);
        limit_joint(w, j);
    }
    place_from(w, 0);
}

static void iterate(work *w, noh_ik_solver solver)
{
    if (solver == NOH_IK_CCD) {
        iterate_ccd(w);
    } else if (solver == NOH_IK_FABRIK) {
        iterate_fabrik(w);
    } else {
        iterate_dls(w);
    }
}

noh_result noh_ik_chain_solve(const noh_ik_chain *chain, noh_ik_solver solver, const float target[3], float tolerance,
                              uint32_t iterations, float *rotations, noh_ik_chain_result *result, noh_error *error)
{
    work w;
    uint32_t stalls = 0;
    int unbent = 0;
    NOH_ASSERT(chain && chain->root && chain->bones && target && rotations && result);
    NOH_ASSERT(tolerance > 0.0f && iterations > 0 && iterations <= 1000u && solver <= NOH_IK_DLS);
    const noh_result checked = check(chain, target, error);
    if (checked) return checked;
    begin(&w, chain, target, rotations);
    float before = missed(&w);
    memcpy(rotations, w.local, chain->count * sizeof w.local[0]);
    *result = (noh_ik_chain_result){ 0, before };
    while (w.length > 0.0f && result->missed > tolerance && result->iterations < iterations && stalls < 4u) {
        iterate(&w, solver);
        result->iterations++;
        const float now = missed(&w);
        if (now < result->missed) {
            result->missed = now;
            memcpy(rotations, w.local, chain->count * sizeof w.local[0]);
        }
        stalls = now > 0.9999f * before ? stalls + 1u : 0;
        if (stalls == 1u && !unbent) {
            unbend(&w);
            unbent = 1;
        }
        before = missed(&w);
    }
    return NOH_OK;
}
