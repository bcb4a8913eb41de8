/* lanes3_internal.h (private to physics/): vectors and rotations, one per lane. Rotations are x, y, z, w. Threads: no
 * state; any thread. */
#ifndef NOH_SIM_LANES3_INTERNAL_H
#define NOH_SIM_LANES3_INTERNAL_H

#include "core/base/compiler_internal.h"
#include "core/base/simd_internal.h"

typedef struct lane3 {
    lanes x, y, z;
} lane3;

typedef struct lane4 {
    lanes x, y, z, w;
} lane4;

/* ---- vectors ---- */

NOH_ALWAYS_INLINE lane3 lane3_set(const float v[3])
{
    const lane3 r = { lanes_set(v[0]), lanes_set(v[1]), lanes_set(v[2]) };
    return r;
}

NOH_ALWAYS_INLINE lane3 lane3_add(lane3 a, lane3 b)
{
    const lane3 r = { lanes_add(a.x, b.x), lanes_add(a.y, b.y), lanes_add(a.z, b.z) };
    return r;
}

NOH_ALWAYS_INLINE lane3 lane3_sub(lane3 a, lane3 b)
{
    const lane3 r = { lanes_sub(a.x, b.x), lanes_sub(a.y, b.y), lanes_sub(a.z, b.z) };
    return r;
}

NOH_ALWAYS_INLINE lane3 lane3_scale(lane3 a, lanes s)
{
    const lane3 r = { lanes_mul(a.x, s), lanes_mul(a.y, s), lanes_mul(a.z, s) };
    return r;
}

NOH_ALWAYS_INLINE lane3 lane3_madd(lane3 a, lanes s, lane3 b)
{
    return lane3_add(a, lane3_scale(b, s));
}

NOH_ALWAYS_INLINE lanes lane3_dot(lane3 a, lane3 b)
{
    return lanes_add(lanes_add(lanes_mul(a.x, b.x), lanes_mul(a.y, b.y)), lanes_mul(a.z, b.z));
}

NOH_ALWAYS_INLINE lane3 lane3_cross(lane3 a, lane3 b)
{
    const lane3 r = { lanes_sub(lanes_mul(a.y, b.z), lanes_mul(a.z, b.y)),
                      lanes_sub(lanes_mul(a.z, b.x), lanes_mul(a.x, b.z)),
                      lanes_sub(lanes_mul(a.x, b.y), lanes_mul(a.y, b.x)) };
    return r;
}

NOH_ALWAYS_INLINE lane3 lane3_choose(lanes mask, lane3 yes, lane3 no)
{
    const lane3 r = { lanes_choose(mask, yes.x, no.x), lanes_choose(mask, yes.y, no.y),
                      lanes_choose(mask, yes.z, no.z) };
    return r;
}

/* 1 / sqrt(square) where the mask is set (the square is not tiny), else 1. */
NOH_ALWAYS_INLINE lanes lanes_inverse_root(lanes mask, lanes square)
{
    const lanes one = lanes_set(1.0f);
    return lanes_div(one, lanes_sqrt(lanes_choose(mask, square, one)));
}

/* ---- rotations ---- */

NOH_ALWAYS_INLINE lane4 lane4_set(const float q[4])
{
    const lane4 r = { lanes_set(q[0]), lanes_set(q[1]), lanes_set(q[2]), lanes_set(q[3]) };
    return r;
}

NOH_ALWAYS_INLINE lane4 lane4_mul(lane4 a, lane4 b)
{
    const lane3 av = { a.x, a.y, a.z }, bv = { b.x, b.y, b.z };
    const lane3 v = lane3_add(lane3_madd(lane3_scale(bv, a.w), b.w, av), lane3_cross(av, bv));
    const lane4 r = { v.x, v.y, v.z, lanes_sub(lanes_mul(a.w, b.w), lane3_dot(av, bv)) };
    return r;
}

NOH_ALWAYS_INLINE lane4 lane4_conjugate(lane4 q)
{
    const lane4 r = { lanes_negate(q.x), lanes_negate(q.y), lanes_negate(q.z), q.w };
    return r;
}

NOH_ALWAYS_INLINE lanes lane4_square(lane4 q)
{
    return lanes_add(lanes_add(lanes_mul(q.x, q.x), lanes_mul(q.y, q.y)),
                     lanes_add(lanes_mul(q.z, q.z), lanes_mul(q.w, q.w)));
}

NOH_ALWAYS_INLINE lane4 lane4_scale(lane4 q, lanes s)
{
    const lane4 r = { lanes_mul(q.x, s), lanes_mul(q.y, s), lanes_mul(q.z, s), lanes_mul(q.w, s) };
    return r;
}

NOH_ALWAYS_INLINE lane4 lane4_normalize(lane4 q)
{
    return lane4_scale(q, lanes_div(lanes_set(1.0f), lanes_sqrt(lane4_square(q))));
}

NOH_ALWAYS_INLINE lane4 lane4_choose(lanes mask, lane4 yes, lane4 no)
{
    const lane4 r = { lanes_choose(mask, yes.x, no.x), lanes_choose(mask, yes.y, no.y), lanes_choose(mask, yes.z, no.z),
                      lanes_choose(mask, yes.w, no.w) };
    return r;
}

NOH_ALWAYS_INLINE lane3 lane4_rotate(lane4 q, lane3 v)
{
    const lane3 u = { q.x, q.y, q.z };
    const lane3 t = lane3_scale(lane3_cross(u, v), lanes_set(2.0f));
    return lane3_add(lane3_madd(v, q.w, t), lane3_cross(u, t));
}

/* The rotated z axis. */
NOH_ALWAYS_INLINE lane3 lane4_axis_z(lane4 q)
{
    const lanes two = lanes_set(2.0f);
    const lane3 r = { lanes_mul(two, lanes_add(lanes_mul(q.x, q.z), lanes_mul(q.w, q.y))),
                      lanes_mul(two, lanes_sub(lanes_mul(q.y, q.z), lanes_mul(q.w, q.x))),
                      lanes_sub(lanes_set(1.0f), lanes_mul(two, lanes_add(lanes_mul(q.x, q.x), lanes_mul(q.y, q.y)))) };
    return r;
}

/* Turn q by a small rotation vector, clamped to 0.5 rad: one Newton step restores length 1, and fails if the square
 * exceeds 3. */
NOH_ALWAYS_INLINE lane4 lane4_turn(lane4 q, lane3 w)
{
    const lanes square = lane3_dot(w, w), large = lanes_less(lanes_set(0.25f), square);
    if (lanes_any(large)) {
        const lanes shorter = lanes_mul(lanes_set(0.5f), lanes_inverse_root(large, square));
        w = lane3_choose(large, lane3_scale(w, shorter), w);
    }
    const lanes half = lanes_set(0.5f);
    const lane4 v = { lanes_mul(w.x, half), lanes_mul(w.y, half), lanes_mul(w.z, half), lanes_set(0.0f) };
    const lane4 d = lane4_mul(v, q);
    const lane4 sum = { lanes_add(q.x, d.x), lanes_add(q.y, d.y), lanes_add(q.z, d.z), lanes_add(q.w, d.w) };
    return lane4_scale(sum, lanes_sub(lanes_set(1.5f), lanes_mul(half, lane4_square(sum))));
}

/* The rotation from b to a as a vector: twice the imaginary part, accurate for small rotations. */
NOH_ALWAYS_INLINE lane3 lane4_difference(lane4 a, lane4 b)
{
    const lane4 d = lane4_mul(a, lane4_conjugate(b));
    const lanes two = lanes_choose(lanes_less(d.w, lanes_set(0.0f)), lanes_set(-2.0f), lanes_set(2.0f));
    const lane3 r = { lanes_mul(d.x, two), lanes_mul(d.y, two), lanes_mul(d.z, two) };
    return r;
}

/* The vector by which lane4_turn turned b into a: its inverse, so that a free body keeps its spin. */
NOH_ALWAYS_INLINE lane3 lane4_turned(lane4 a, lane4 b)
{
    const lane4 d = lane4_mul(a, lane4_conjugate(b));
    const lanes w = lanes_max(lanes_abs(d.w), lanes_set(0.5f));
    const lanes two = lanes_choose(lanes_less(d.w, lanes_set(0.0f)), lanes_set(-2.0f), lanes_set(2.0f));
    const lane3 v = { d.x, d.y, d.z };
    return lane3_scale(v, lanes_div(two, w));
}

/* The arc tangent of num / den, clamped to -1..1, accurate to 1e-4.
 * source  a polynomial of degree 9 in the ratio */
NOH_ALWAYS_INLINE lanes lanes_arc_tangent(lanes num, lanes den)
{
    const lanes one = lanes_set(1.0f);
    const lanes a = lanes_max(lanes_min(lanes_div(num, den), one), lanes_set(-1.0f));
    const lanes s = lanes_mul(a, a), c = lanes_mul(s, a), q = lanes_mul(s, s);
    const lanes r = lanes_add(lanes_mul(lanes_set(0.024840285f), q), lanes_set(0.18681418f));
    const lanes t = lanes_sub(lanes_mul(lanes_set(-0.094097948f), q), lanes_set(0.33213072f));
    return lanes_add(lanes_mul(lanes_add(lanes_mul(r, s), t), c), a);
}

#endif
