/* retarget_limb.c: feet where the source has them, hips that go down for them, hands as far out as the source's. */
#include "life/reach/retarget_internal.h"
#include "core/base/trig_internal.h"

#define SOFT 0.998f      /* share of a limb's length beyond which it straightens slowly */
#define REACH 0.999f     /* share of a leg's length that the hips go down for */
#define LIFTED_LOW 0.2f  /* heights of a foot, in lengths of the leg: below the first it stands, ... */
#define LIFTED_HIGH 0.4f /* ... above the second the hips do not go down for it */
#define TOGETHER \
    0.35f          /* distances of hands, in lengths of the arm: below the first they meet as the source's do, ... */
#define APART 0.7f /* ... above the second each follows its own shoulder */
#define UNDER_LOW 0.35f /* depths of a foot, in lengths of the leg: above the first it is put on the ground, ... */
#define UNDER_HIGH 0.6f /* ... below the second there is no ground */
#define SIDE 0.05f      /* say of the usual side over a straight limb's bend, in lengths of the limb, ... */
#define BENT 0.04f      /* ... and how far out of line the middle is of one that has its own side */

typedef struct bent {
    noh_retarget_place start, middle, end; /* of the target */
    float goal[3];
    float stands; /* 0..1 */
} bent;

static float between(float low, float high, float at)
{
    const float t = (at - low) / (high - low);
    return t < 0.0f ? 0.0f : t > 1.0f ? 1.0f : t;
}

static void place_limb(const noh_skeleton *s, const noh_transform *pose, const noh_retarget_limb *limb, bent *b)
{
    noh_retarget_place_of(s, pose, limb->target[0], NOH_JOINT_ROOT, &b->start);
    noh_retarget_place_below(s, pose, limb->target[1], limb->target[0], &b->start, &b->middle);
    if (limb->is_apart) {
        noh_retarget_place_of(s, pose, limb->target[2], NOH_JOINT_ROOT, &b->end);
        noh_quat_rotate(b->middle.rotation, limb->tip, b->end.position);
        noh_madd3(b->middle.position, b->middle.scale, b->end.position, b->end.position);
    } else {
        noh_retarget_place_below(s, pose, limb->target[2], limb->target[1], &b->middle, &b->end);
    }
}

/* A local rotation that turns the joint by q in the model's space, where its rotation was `at`. */
static void turn_local(const float at[4], const float q[4], noh_transform *local)
{
    float turn[4], back[4];
    noh_quat_conjugate(at, back);
    noh_quat_mul(q, at, turn);
    noh_quat_mul(back, turn, turn);
    noh_quat_mul(local->rotation, turn, local->rotation);
    noh_quat_normalize(local->rotation);
}

static void bend_limb(const noh_retarget *r, const noh_retarget_limb *limb, const bent *b, noh_transform *pose)
{
    noh_ik_limb ik;
    noh_ik_bend turns;
    float pole[3], side[3], along[3], both[4], at[4];
    memset(&ik, 0, sizeof ik);
    memcpy(ik.start, b->start.position, sizeof ik.start);
    memcpy(ik.middle, b->middle.position, sizeof ik.middle);
    memcpy(ik.end, b->end.position, sizeof ik.end);
    ik.soft = SOFT;
    noh_quat_rotate(b->start.rotation, limb->bend, side);
    noh_sub3(ik.end, ik.start, along);
    noh_normalize3(along, side);
    noh_sub3(ik.middle, ik.start, pole);
    noh_reject3(pole, along, pole);
    noh_madd3(pole, SIDE * limb->length * (1.0f - between(0.0f, BENT, noh_length3(pole) / limb->length)), side, pole);
    noh_ik_two_bone(&ik, b->goal, pole, 1.0f, &turns);
    turn_local(b->start.rotation, turns.start, &pose[limb->target[0]]);
    noh_quat_mul(turns.start, b->middle.rotation, at);
    turn_local(at, turns.middle, &pose[limb->target[1]]);
    if (limb->is_apart) {
        noh_retarget_put(r->clips.target, pose, limb->target[2], b->goal);
        return;
    }
    noh_quat_mul(turns.middle, turns.start, both);
    noh_quat_conjugate(both, both);
    turn_local(b->end.rotation, both, &pose[limb->target[2]]); /* it keeps its direction */
}

/* ---- legs ---- */

/* The goal of a foot, from its rotation since the reference pose. The stance turns with the foot about the vertical, so
 * it is constant while the foot stands, and while the heel is up the foot is placed by its toes. A foot under the ground
 * that the reference pose stands on is put on it. */
static void place_foot(const noh_retarget *r, const noh_retarget_limb *limb, const noh_transform *from,
                       const noh_retarget_place *foot, float goal[3], float *stands)
{
    noh_retarget_place source;
    float turned[4], heading[4], v[3], sole[3];
    noh_retarget_place_of(r->clips.source, from, limb->source[2], NOH_JOINT_ROOT, &source);
    noh_retarget_point(r, source.position, goal);
    noh_quat_mul(foot->rotation, limb->rest, turned);
    noh_quat_twist(turned, 1u, heading);
    noh_quat_rotate(heading, limb->stance, v);
    noh_madd3(goal, 1.0f, v, goal);
    noh_quat_rotate(turned, limb->sole, sole);
    if (sole[1] < limb->sole[1]) {
        noh_quat_rotate(heading, limb->shorter, v);
        noh_madd3(goal, 1.0f, v, goal);
        noh_quat_rotate(turned, limb->shorter, v);
        noh_madd3(goal, -1.0f, v, goal);
    }
    const float ankle = limb->height - goal[1], toes = ankle + limb->sole[1] - sole[1];
    const float under = ankle > toes ? ankle : toes;
    *stands = 1.0f - between(LIFTED_LOW, LIFTED_HIGH, -under / limb->length);
    if (under > 0.0f) goal[1] += under * (1.0f - between(UNDER_LOW, UNDER_HIGH, under / limb->length));
}

/* How the hips have to move for a leg that does not reach: down by at most twice what is missing, and the rest towards
 * the foot, as in a lunge. */
static void hips_for(const noh_retarget_limb *limb, const bent *b, float move[3])
{
    float d[3];
    noh_sub3(b->start.position, b->goal, d);
    const float reach = REACH * limb->length, square = d[0] * d[0] + d[2] * d[2], flat = noh_sqrt(square);
    const float missing = noh_length3(d) - reach;
    if (!(b->stands > 0.0f) || !(d[1] > 0.0f) || !(missing > 0.0f)) return;
    const float down = square < reach * reach ? d[1] - noh_sqrt(reach * reach - square) : d[1];
    const float lower = down < 2.0f * missing ? down : 2.0f * missing, y = d[1] - lower, room = reach * reach - y * y;
    const float keep = room > 0.0f ? noh_sqrt(room) : 0.0f,
                share = flat > keep ? b->stands * (1.0f - keep / flat) : 0.0f;
    move[0] -= share * d[0];
    move[2] -= share * d[2];
    if (move[1] > -lower * b->stands) move[1] = -lower * b->stands;
}

static void move_hips(const noh_retarget *r, const float by[3], bent legs[2], noh_transform *to)
{
    noh_retarget_place hips;
    noh_retarget_place_of(r->clips.target, to, r->moved[1][1], NOH_JOINT_ROOT, &hips);
    noh_madd3(hips.position, 1.0f, by, hips.position);
    noh_retarget_put(r->clips.target, to, r->moved[1][1], hips.position);
    for (int i = 0; i < 2; i++) {
        noh_madd3(legs[i].start.position, 1.0f, by, legs[i].start.position);
        noh_madd3(legs[i].middle.position, 1.0f, by, legs[i].middle.position);
        noh_madd3(legs[i].end.position, 1.0f, by, legs[i].end.position);
    }
}

static void bend_legs(const noh_retarget *r, const noh_transform *from, const float (*feet)[3], uint32_t joint_count,
                      noh_transform *to)
{
    bent legs[2];
    float by[3] = { 0.0f, 0.0f, 0.0f };
    int used[2];
    memset(legs, 0, sizeof legs);
    for (int i = 0; i < 2; i++) {
        const noh_retarget_limb *limb = &r->limbs[i];
        used[i] = limb->exists && limb->target[2] < joint_count;
        if (!used[i]) continue;
        place_limb(r->clips.target, to, limb, &legs[i]);
        place_foot(r, limb, from, &legs[i].end, legs[i].goal, &legs[i].stands);
        if (feet) noh_madd3(legs[i].goal, 1.0f, feet[i], legs[i].goal);
        hips_for(limb, &legs[i], by);
    }
    if (by[1] < 0.0f && r->moved[1][1] < joint_count) move_hips(r, by, legs, to);
    for (int i = 0; i < 2; i++) {
        if (used[i]) bend_limb(r, &r->limbs[i], &legs[i], to);
    }
}

/* ---- arms ---- */

static void bend_arms(const noh_retarget *r, const noh_transform *from, uint32_t joint_count, noh_transform *to)
{
    bent arms[2];
    noh_retarget_place start, hands[2];
    int used[2];
    for (int i = 0; i < 2; i++) {
        const noh_retarget_limb *limb = &r->limbs[2 + i];
        float d[3];
        used[i] = limb->exists && limb->target[2] < joint_count;
        if (!used[i]) continue;
        place_limb(r->clips.target, to, limb, &arms[i]);
        noh_retarget_place_of(r->clips.source, from, limb->source[0], NOH_JOINT_ROOT, &start);
        noh_retarget_place_below(r->clips.source, from, limb->source[2], limb->source[0], &start, &hands[i]);
        noh_sub3(hands[i].position, start.position, d);
        noh_quat_rotate(r->facing, d, d);
        noh_madd3(arms[i].start.position, limb->ratio, d, arms[i].goal);
    }
    if (used[0] && used[1]) {
        const float ratio = 0.5f * (r->limbs[2].ratio + r->limbs[3].ratio);
        float apart[3], *goals[2] = { arms[0].goal, arms[1].goal };
        noh_sub3(hands[0].position, hands[1].position, apart);
        noh_quat_rotate(r->facing, apart, apart);
        const float say = 1.0f - between(TOGETHER, APART, noh_length3(apart) * ratio / r->limbs[2].length);
        for (int i = 0; i < 3 && say > 0.0f; i++) {
            const float off = 0.5f * say * (ratio * apart[i] - (goals[0][i] - goals[1][i]));
            goals[0][i] += off;
            goals[1][i] -= off;
        }
    }
    for (int i = 0; i < 2; i++) {
        if (used[i]) bend_limb(r, &r->limbs[2 + i], &arms[i], to);
    }
}

void noh_retarget_bend(const noh_retarget *r, const noh_transform *from, const float (*feet)[3], uint32_t joint_count,
                       noh_transform *to)
{
    if (r->flags & NOH_RETARGET_FEET) bend_legs(r, from, feet, joint_count, to);
    if (r->flags & NOH_RETARGET_HANDS) bend_arms(r, from, joint_count, to);
}
