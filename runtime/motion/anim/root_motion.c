#include "core/base/assert_internal.h"
#include "core/base/trig_internal.h"
#include "motion/anim/root_motion_internal.h"
#include "motion/anim/time_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

#include <string.h>

#include "motion/anim/root_internal.h"

/* The axes across the up axis, in the order that makes turns counter-clockwise. */
static void ground_axes(uint32_t up, uint32_t *a, uint32_t *b)
{
    *a = (up + 1u) % 3u;
    *b = (up + 2u) % 3u;
}

/* Sine and cosine in double, because the displacement of a million passes needs more than 24 bits, and without libm, so
 * that all machines get the same bits. Taylor series to x^17 in Horner form; |x| <= pi/4, error below 1e-16. */
static void sin_cos_double(double x, double *sine, double *cosine)
{
    double y = x * x;
    *sine = x *
            (1.0 -
             y / 6.0 *
                 (1.0 -
                  y / 20.0 *
                      (1.0 -
                       y / 42.0 *
                           (1.0 - y / 72.0 *
                                      (1.0 - y / 110.0 * (1.0 - y / 156.0 * (1.0 - y / 210.0 * (1.0 - y / 272.0))))))));
    *cosine = 1.0 -
              y / 2.0 *
                  (1.0 -
                   y / 12.0 *
                       (1.0 -
                        y / 30.0 *
                            (1.0 -
                             y / 56.0 *
                                 (1.0 -
                                  y / 90.0 *
                                      (1.0 - y / 132.0 * (1.0 - y / 182.0 * (1.0 - y / 240.0 * (1.0 - y / 306.0))))))));
}

/* Sine and cosine of `half_turns` times 2^-33 turns, which wraps at 2^33. The nearest quarter turn is split off as an
 * integer, so the series sees at most an eighth. */
static void sin_cos_half(uint64_t half_turns, double *sine, double *cosine)
{
    uint64_t wrapped = half_turns & (((uint64_t)1 << 33) - 1u);
    uint64_t quarters = (wrapped + ((uint64_t)1 << 30)) >> 31;
    double rest = ((double)wrapped - (double)(quarters << 31)) * 7.31459039633579841e-10; /* 2 pi / 2^33 */
    double s, c;
    sin_cos_double(rest, &s, &c);
    const double a = quarters & 1u ? c : s, b = quarters & 1u ? s : c;
    *sine = quarters & 2u ? -a : a;
    *cosine = (quarters + 1u) & 2u ? -b : b;
}

static void turn_vector(uint32_t up, uint64_t half_turns, double v[3])
{
    uint32_t a, b;
    double s, c, va, vb;
    ground_axes(up, &a, &b);
    sin_cos_half(half_turns, &s, &c);
    va = v[a];
    vb = v[b];
    v[a] = c * va - s * vb;
    v[b] = s * va + c * vb;
}

/* The heading: the angle of the twist about the up axis, which is twice the half angle in the quaternion. The error of
 * a float's arc tangent is corrected in double by the tangent of the difference, because passes add up heading
 * errors. */
static uint32_t heading(uint32_t up, const noh_transform *root)
{
    const double along = (double)root->rotation[up], w = (double)root->rotation[3];
    float twist[4];
    double s, c, rest;
    uint32_t turn;
    noh_quat_twist(root->rotation, up, twist);
    turn = noh_turn_from_radians(2.0f * noh_atan2(twist[up], twist[3]));
    sin_cos_half(turn, &s, &c);
    rest = w * c + along * s;
    if (along * along + w * w <= 1e-12) return turn;        /* no twist, as in noh_quat_twist */
    rest = (along * c - w * s) / rest * 1367130551.1528633; /* 2^33 / 2 pi */
    return turn + (uint32_t)(int32_t)(rest < 0.0 ? rest - 0.5 : rest + 0.5);
}

noh_root_pose noh_root_extract(uint32_t axes, uint32_t up, const noh_transform *root)
{
    noh_root_pose e;
    NOH_ASSERT(root && axes <= 15u && up <= 2u);
    memset(&e, 0, sizeof e);
    for (uint32_t i = 0; i < 3; i++) {
        e.translation[i] = axes & (1u << i) ? (double)root->translation[i] : 0.0;
    }
    e.turn = axes & NOH_ROOT_HEADING ? heading(up, root) : 0u;
    return e;
}

/* rest = inverse(E) * root: subtract E's translation, then turn both the remaining translation and the rotation back by
 * the heading, except for `facing`. */
void noh_root_remove(uint32_t axes, uint32_t up, uint32_t facing, noh_transform *root)
{
    noh_root_pose e = noh_root_extract(axes, up, root);
    float back[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
    double rest[3];
    NOH_ASSERT(root && axes <= 15u && up <= 2u);
    e.turn -= facing;
    /* half of minus the turn, as a signed angle: the quaternion of the inverse heading */
    noh_sin_cos(-0.5f * noh_radians_from_turn(e.turn), &back[up], &back[3]);
    for (int i = 0; i < 3; i++) {
        rest[i] = (double)root->translation[i] - e.translation[i];
    }
    turn_vector(up, 0u - 2u * (uint64_t)e.turn, rest);
    for (int i = 0; i < 3; i++) {
        root->translation[i] = (float)rest[i];
    }
    noh_quat_mul(back, root->rotation, root->rotation);
}

void noh_root_sample_rest(const noh_clip_set *set, uint32_t clip, uint32_t clip_tick, uint32_t joint_count,
                          noh_transform *pose, float *floats)
{
    NOH_ASSERT(set && clip < set->clip_count && clip_tick <= set->clips[clip].duration_ticks &&
               joint_count <= set->joint_count);
    set->sample(set->user, clip, clip_tick, joint_count, pose, set->float_count, floats);
    if (set->roots && set->roots[clip].axes) {
        noh_root_remove(set->roots[clip].axes, set->roots[clip].up, set->roots[clip].facing, &pose[0]);
    }
}

noh_root_pose noh_root_compose(uint32_t up, const noh_root_pose *a, const noh_root_pose *b)
{
    noh_root_pose out = *b;
    NOH_ASSERT(up <= 2u && a && b);
    turn_vector(up, 2u * (uint64_t)a->turn, out.translation);
    for (int i = 0; i < 3; i++) {
        out.translation[i] += a->translation[i];
    }
    out.turn = a->turn + b->turn;
    return out;
}

noh_root_pose noh_root_inverse(uint32_t up, const noh_root_pose *a)
{
    noh_root_pose out = *a;
    NOH_ASSERT(up <= 2u && a);
    for (int i = 0; i < 3; i++) {
        out.translation[i] = -a->translation[i];
    }
    turn_vector(up, 0u - 2u * (uint64_t)a->turn, out.translation);
    out.turn = 0u - a->turn;
    return out;
}

/* L^n turns by n * turn and translates by the sum of d turned by k * turn for k = 0..n-1. That is a geometric series of
 * rotations: d turned by (n-1)/2 * turn, times sin(n turn / 2) / sin(turn / 2). Along the up axis, and without a turn,
 * it is n d. Turns are integers modulo 2^32, half turns modulo 2^33, so no angle loses bits however large n is. */
noh_root_pose noh_root_power(uint32_t up, const noh_root_pose *a, int64_t n)
{
    noh_root_pose base = n < 0 ? noh_root_inverse(up, a) : *a, out;
    uint64_t count = n < 0 ? (uint64_t)0 - (uint64_t)n : (uint64_t)n;
    double s_one, s_all, unused, ratio = (double)count;
    NOH_ASSERT(up <= 2u && a);
    memset(&out, 0, sizeof out);
    if (count == 0) {
        return out;
    }
    for (uint32_t i = 0; i < 3; i++) {
        out.translation[i] = base.translation[i];
    }
    if (base.turn) {
        sin_cos_half(base.turn, &s_one, &unused);
        sin_cos_half((uint64_t)base.turn * count, &s_all, &unused);
        ratio = s_all / s_one;
        turn_vector(up, (uint64_t)base.turn * (count - 1u), out.translation);
    }
    for (uint32_t i = 0; i < 3; i++) {
        out.translation[i] = i == up ? base.translation[i] * (double)count : out.translation[i] * ratio;
    }
    out.turn = (uint32_t)(base.turn * count);
    return out;
}

/* E of the sampled joint at a tick. */
static noh_root_pose sampled_root(const noh_clip_set *set, uint32_t clip, uint32_t axes, uint32_t up,
                                  uint32_t clip_tick)
{
    noh_transform root;
    set->sample(set->user, clip, clip_tick, 1, &root, 0, NULL);
    return noh_root_extract(axes, up, &root);
}

/* E at a tick of the clip. */
static noh_root_pose root_at(const noh_clip_set *set, const noh_root_track *track, uint32_t clip, uint32_t clip_tick)
{
    const uint32_t left = set->clips[clip].duration_ticks - clip_tick, end = left < clip_tick,
                   away = end ? left : clip_tick;
    noh_root_pose e;
    if (clip_tick == 0) return track->start;
    if (left == 0) return track->end;
    e = sampled_root(set, clip, track->axes, track->up, clip_tick);
    e.turn -= track->facing;
    if (away < NOH_ROOT_SEAM_TICKS) {
        const double part = (double)(NOH_ROOT_SEAM_TICKS - away) / NOH_ROOT_SEAM_TICKS;
        for (int i = 0; i < 3; i++) e.translation[i] += part * (double)track->seam[end][i];
        e.turn += (uint32_t)(int32_t)(part * track->seam_turn[end]);
    }
    return e;
}

/* One end of a track: the source's value, and the difference to the sampled one. */
static noh_root_pose measure_end(const noh_clip_set *set, uint32_t clip, uint32_t end, noh_root_track *t)
{
    const noh_root_ends *ends = set->root_ends ? set->root_ends[clip] : NULL;
    const noh_root_pose sampled = sampled_root(set, clip, t->axes, t->up, end ? set->clips[clip].duration_ticks : 0u);
    noh_root_pose e = sampled;
    if (ends) {
        noh_transform root;
        memset(&root, 0, sizeof root);
        memcpy(root.rotation, (*ends)[end], sizeof root.rotation);
        memcpy(root.translation, &(*ends)[end][4], sizeof root.translation);
        e = noh_root_extract(t->axes, t->up, &root);
    }
    for (int i = 0; i < 3; i++) t->seam[end][i] = (float)(e.translation[i] - sampled.translation[i]);
    t->seam_turn[end] = (int32_t)(e.turn - sampled.turn);
    return e;
}

noh_result noh_root_track_measure(const noh_clip_set *set, uint32_t clip, uint32_t axes, uint32_t up,
                                  noh_root_track *track, noh_error *error)
{
    noh_root_track t;
    noh_root_pose back;
    NOH_ASSERT(set && track);
    if (clip >= set->clip_count)
        return noh_fail(error, NOH_ERR_ARG, "clip is not a clip of the set", clip, set->clip_count);
    if (axes > 15u) return noh_fail(error, NOH_ERR_ARG, "axes must be bits of NOH_ROOT_*", clip, 0);
    if (up > 2u) return noh_fail(error, NOH_ERR_ARG, "up must be 0, 1 or 2", clip, 0);
    memset(&t, 0, sizeof t);
    t.axes = axes;
    t.up = up;
    if (axes) {
        t.start = measure_end(set, clip, 0, &t);
        t.end = measure_end(set, clip, 1, &t);
        t.facing = t.start.turn;
        t.end.turn -= t.facing;
        t.start.turn = 0;
        back = noh_root_inverse(up, &t.start);
        t.loop = noh_root_compose(up, &back, &t.end);
    }
    *track = t;
    return NOH_OK;
}

noh_root_pose noh_root_between(const noh_clip_set *set, const noh_root_track *track, uint32_t clip, noh_loop loop,
                               int64_t from, int64_t to)
{
    NOH_ASSERT(set && track && clip < set->clip_count);
    uint32_t duration = set->clips[clip].duration_ticks, up = track->up;
    /* a ping-pong clip returns to its start, so only repeating clips add up passes */
    int64_t passes = loop == NOH_LOOP_REPEAT ? noh_time_legs(to, duration, loop) - noh_time_legs(from, duration, loop)
                                             : 0;
    noh_root_pose a = root_at(set, track, clip, (uint32_t)(noh_time_clip(from, duration, loop) / 65536));
    noh_root_pose b = root_at(set, track, clip, (uint32_t)(noh_time_clip(to, duration, loop) / 65536));
    noh_root_pose back = noh_root_inverse(up, &a), step, start_back;
    if (passes == 0) {
        return noh_root_compose(up, &back, &b);
    }
    /* inverse(E(a)) E(0) L^n inverse(E(0)) E(b): the formula of low_motion.h, with E(end) = E(0) L */
    step = noh_root_power(up, &track->loop, passes);
    start_back = noh_root_inverse(up, &track->start);
    back = noh_root_compose(up, &back, &track->start);
    back = noh_root_compose(up, &back, &step);
    back = noh_root_compose(up, &back, &start_back);
    return noh_root_compose(up, &back, &b);
}

/* v turned by q, as noh_quat_rotate does it. */
static void rotate_double(const double q[4], double v[3])
{
    double t[3], r[3];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        t[i] = 2.0 * (q[j] * v[k] - q[k] * v[j]);
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        r[i] = v[i] + q[3] * t[i] + (q[j] * t[k] - q[k] * t[j]);
    }
    memcpy(v, r, sizeof r);
}

void noh_root_drive(uint32_t up, const noh_root_pose *moved, double scale, double position[3], double rotation[4])
{
    double step[3], s, c, square = 0.0, q[4];
    uint32_t a, b;
    for (int i = 0; i < 3; i++) step[i] = moved->translation[i] * scale;
    rotate_double(rotation, step);
    for (int i = 0; i < 3; i++) position[i] += step[i];
    if (!moved->turn) return;
    ground_axes(up, &a, &b);
    sin_cos_half(moved->turn, &s, &c);
    q[up] = rotation[up] * c + rotation[3] * s;
    q[3] = rotation[3] * c + rotation[up] * -s; /* sums only: see noh_quat_mul */
    q[a] = rotation[a] * c + rotation[b] * s;
    q[b] = rotation[b] * c + rotation[a] * -s;
    for (int i = 0; i < 4; i++) square += q[i] * q[i];
    for (int i = 0; i < 4; i++) rotation[i] = q[i] * (1.5 - 0.5 * square); /* a Newton step towards length 1 */
}
