/* ik_two_bone.c: finds the position of the middle joint, then the rotations that bring it there. */
#include "core/base/assert_internal.h"
#include "core/base/trig_internal.h"
#include "noh/body.h"
#include "noh/low_core.h"
#include "core/base/vector_internal.h"

/* Limbs shorter than this are points: nothing turns. */
#define POINT 1e-12f
#define SQUARED_POINT 1e-24f

/* Lengths of both bones, and from start to end when straight. */
typedef struct lengths {
    float upper, lower, whole;
} lengths;

/* The distance from start to end at a bend between the bones. */
static float distance_at(const lengths *l, float bend)
{
    float sine, cosine;
    noh_sin_cos(bend, &sine, &cosine);
    const float square = l->upper * l->upper + l->lower * l->lower + 2.0f * l->upper * l->lower * cosine;
    return square > 0.0f ? noh_sqrt(square) : 0.0f;
}

/* The reachable distance of the end from the start. Just short of straight and of folded, where the side of the bend
 * would be lost. */
static float reachable(const noh_ik_limb *limb, const lengths *l, float wanted)
{
    const float soft = limb->soft > 0.0f ? limb->soft * l->whole : l->whole, room = l->whole - soft;
    const float difference = l->upper - l->lower, folded = difference < 0.0f ? -difference : difference;
    float least = folded + 1e-5f * l->whole, most = l->whole * (1.0f - 1e-6f);
    if (limb->bend_max > 0.0f) {
        const float straightest = distance_at(l, limb->bend_min), bent = distance_at(l, limb->bend_max);
        most = straightest < most ? straightest : most;
        least = bent > least ? bent : least;
    }
    if (room > 0.0f && wanted > soft) {
        const float t = 3.0f + (wanted - soft) / room, square = t * t;
        wanted = soft + room * (1.0f - 81.0f / (square * square));
    }
    wanted = wanted < most ? wanted : most;
    return wanted > least ? wanted : least;
}

/* The rotation about a unit axis that brings direction a over b; both are projected perpendicular to it. Of the two
 * half-angle forms, the one that loses no digits. */
static void turn_about(const float axis[3], const float a[3], const float b[3], float q[4])
{
    float from[3], to[3], normal[3];
    noh_reject3(a, axis, from);
    noh_reject3(b, axis, to);
    noh_cross3(from, to, normal);
    const float size = noh_sqrt(noh_dot3(from, from) * noh_dot3(to, to));
    const float cosine = noh_dot3(from, to), sine = noh_dot3(normal, axis);
    const float part = cosine < 0.0f ? size - cosine : sine;
    for (int i = 0; i < 3; i++) q[i] = axis[i] * part;
    q[3] = cosine < 0.0f ? sine : size + cosine;
    noh_quat_normalize(q);
}

/* The quaternion of a rotation matrix: of its four forms the one with the largest divisor (Shepperd 1978). */
static void quat_of_rows(float m[3][3], float q[4])
{
    const float trace = m[0][0] + m[1][1] + m[2][2];
    const int i = m[1][1] > m[0][0] ? (m[2][2] > m[1][1] ? 2 : 1) : m[2][2] > m[0][0] ? 2 : 0;
    const int j = i == 2 ? 0 : i + 1, k = j == 2 ? 0 : j + 1;
    if (trace > m[i][i]) {
        q[0] = m[2][1] - m[1][2];
        q[1] = m[0][2] - m[2][0];
        q[2] = m[1][0] - m[0][1];
        q[3] = 1.0f + trace;
    } else {
        q[i] = 1.0f + m[i][i] - m[j][j] - m[k][k];
        q[j] = m[i][j] + m[j][i];
        q[k] = m[i][k] + m[k][i];
        q[3] = m[k][j] - m[j][k];
    }
    noh_quat_normalize(q);
}

/* The rotation of the whole limb that puts the upper bone along new_upper, and the plane of its bend perpendicular to
 * `normal`: from the frame of bone, plane normal and their product, to the new frame. A straight limb has no plane. */
static void turn_frame(const float upper[3], const float lower[3], const float new_upper[3], const float normal[3],
                       float length, float q[4])
{
    float plane[3], across[3], new_across[3], m[3][3];
    noh_cross3(lower, upper, plane);
    const float square = noh_dot3(plane, plane), inverse = length > 0.0f ? 1.0f / length : 0.0f;
    if (square <= 1e-10f * noh_dot3(upper, upper) * noh_dot3(lower, lower)) {
        noh_quat_between(upper, new_upper, normal, q);
        return;
    }
    const float unit = inverse / noh_sqrt(square); /* of the plane's normal, and of bones: both fit in one factor */
    noh_cross3(plane, upper, across);
    noh_cross3(normal, new_upper, new_across);
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            m[r][c] = (new_upper[r] * upper[c] * inverse + new_across[r] * across[c] * unit) * inverse +
                      normal[r] * plane[c] * unit * length;
        }
    }
    quat_of_rows(m, q);
}

/* The rotation of the lower bone in the plane of the bend, plus the remaining rotation of the plane. */
static void turn_lower(const float lower[3], const float new_lower[3], const float normal[3], float q[4])
{
    float turned[3], off[3], rest[4];
    turn_about(normal, lower, new_lower, q);
    noh_quat_rotate(q, lower, turned);
    noh_sub3(turned, new_lower, off);
    if (noh_dot3(off, off) > 1e-12f * noh_dot3(lower, lower)) {
        noh_quat_between(turned, new_lower, normal, rest);
        noh_quat_mul(rest, q, q);
    }
}

/* The unit direction, perpendicular to the target's, in which the middle joint must lie. Without a pole it stays in the
 * plane of the bend: with e along the limb, p the side, x + x' its length and h the height of the bend, the bones are x
 * e + h p and x' e - h p, so upper x lower points against e x p, and e x (upper x lower) along p. */
static void side_of(const float along[3], const float upper[3], const float lower[3], const float pole[3],
                    float side[3])
{
    float now[3], normal[3];
    noh_cross3(upper, lower, normal);
    noh_cross3(along, normal, now);
    if (noh_dot3(now, now) <= 1e-10f * noh_dot3(normal, normal)) memcpy(now, upper, sizeof now);
    if (pole) {
        float part[3];
        noh_reject3(pole, along, part);
        if (noh_dot3(part, part) > 1e-8f * noh_dot3(pole, pole)) memcpy(now, part, sizeof now);
    }
    noh_perpendicular3(along, now, side);
}

/* The direction of the first vector that has one, else of the last. */
static void direction_of(const float *const from[], int count, float along[3])
{
    static const float ahead[3] = { 0.0f, 0.0f, 1.0f };
    int i = 0;
    while (i + 1 < count && noh_dot3(from[i], from[i]) <= SQUARED_POINT) i++;
    memcpy(along, from[i], 3 * sizeof *along);
    noh_normalize3(along, ahead);
}

static void weigh(float weight, float q[4])
{
    static const float identity[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
    if (weight < 1.0f) noh_quat_nlerp(identity, q, weight, q);
}

/* The goals of the middle and the end, relative to the start. */
static void place(const lengths *l, float distance, const float along[3], const float side[3], float middle[3],
                  float end[3])
{
    const float x = distance > 0.0f
                        ? ((l->upper - l->lower) * (l->upper + l->lower) + distance * distance) / (2.0f * distance)
                        : 0.0f;
    const float square = (l->upper - x) * (l->upper + x), h = square > 0.0f ? noh_sqrt(square) : 0.0f;
    for (int i = 0; i < 3; i++) {
        middle[i] = x * along[i] + h * side[i];
        end[i] = distance * along[i];
    }
}

void noh_ik_two_bone(const noh_ik_limb *limb, const float target[3], const float pole[3], float weight,
                     noh_ik_bend *bend)
{
    static const float identity[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
    float upper[3], lower[3], wanted[3], along[3], side[3], normal[3], middle[3], end[3], rest[3];
    NOH_ASSERT(limb && target && bend && weight >= 0.0f && weight <= 1.0f);
    NOH_ASSERT(limb->bend_min >= 0.0f && limb->bend_min <= limb->bend_max && limb->bend_max <= 1.0001f * NOH_PI);
    noh_sub3(limb->middle, limb->start, upper);
    noh_sub3(limb->end, limb->middle, lower);
    noh_sub3(target, limb->start, wanted);
    lengths l = { noh_length3(upper), noh_length3(lower), 0.0f };
    l.whole = l.upper + l.lower;
    memcpy(bend->start, identity, sizeof identity);
    memcpy(bend->middle, identity, sizeof identity);
    bend->missed = noh_length3(wanted);
    if (!(l.whole > POINT)) return;

    noh_sub3(limb->end, limb->start, rest); /* a target on the root: towards the present end */
    direction_of((const float *const[]){ wanted, rest, upper, lower }, 4, along);
    side_of(along, upper, lower, pole, side);
    noh_cross3(along, side, normal);
    place(&l, reachable(limb, &l, bend->missed), along, side, middle, end);
    noh_sub3(end, middle, rest);
    turn_frame(upper, lower, middle, normal, l.upper, bend->start);
    noh_quat_rotate(bend->start, lower, lower);
    turn_lower(lower, rest, normal, bend->middle);
    noh_sub3(end, wanted, rest);
    bend->missed = noh_length3(rest);
    weigh(weight, bend->start);
    weigh(weight, bend->middle);
}
