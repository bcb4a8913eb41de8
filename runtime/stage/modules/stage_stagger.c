/* stage_stagger.c: actors that keep their feet after a push.
 *
 * The body is a linear inverted pendulum over the point that its feet press on. That point stays within the feet that
 * stand; a foot steps to where the pendulum would come to rest if that is outside them (the capture point), as far as a
 * leg reaches. An actor that needs more steps than people take falls. In the end the other foot closes up.
 * source   Pratt, Carff, Drakunov, Goswami: Capture Point: A Step toward Humanoid Push Recovery, 2006
 *          Kajita et al.: The 3D Linear Inverted Pendulum Mode, 2001 */
#include <string.h>

#include "core/base/math_internal.h"
#include "core/base/trig_internal.h"
#include "life/physics/ragdoll_internal.h"
#include "core/base/vector_internal.h"
#include "life/physics/world_internal.h"
#include "life/reach/rig_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "stage/modules/stage_legs_internal.h"
#include "stage/modules/stage_ragdoll_internal.h"

/* Lengths are in legs, times in seconds of an actor of scale 1: times grow by the square root of the scale, as the
 * pendulum's do. */
#define PIECE_TICKS 200u /* of 1/240 s */
#define PIECES_MAX 960u  /* of one step of the stage; the rest of a longer time is dropped */
#define PIECE ((float)PIECE_TICKS / (float)NOH_TICKS_PER_SECOND)
#define CENTRE 1.05f /* height of the centre of mass */
#define SOLE 0.09f   /* around an ankle: what a foot can press on */
#define PRESS 0.8f   /* how strongly feet press against the capture point's way from the middle */
#define STRIDE 0.62f /* from the centre of mass to the foot that lands, at most */
#define STEPS_MAX 5u
#define LOST 1.1f /* a capture point farther off is not reached */
#define CLOSE_TICKS 21600u
#define LIFT 0.1f
#define CLOSED 0.025f
#define SLOW 0.3f        /* legs a second: then the other foot closes up */
#define GROUND_STEP 0.4f /* ground higher or lower is no place to step on */
#define WALL 0.45f       /* what is as high as this stops a step */
#define CHEST 0.25f      /* from the centre of mass to a wall, at least */
#define LEAN_RATE 6.0f
#define CROUCH 0.04f
#define STAGGER_SPEED 0.6f /* default: of the speed of a pendulum as long as a leg */

typedef struct walk {
    const noh_stage_ragdoll_kind *shared;
    const noh_stage_body *body;
    noh_stage_stagger *s;
    float leg, omega, time, piece; /* time: the square root of its scale; piece: PIECE over it */
    float side[2];                 /* unit: the actor's left */
    float middle[2];               /* of the stance: what the centre of mass is over when both feet stand as they did */
    float place[3];                /* from the body's origin */
} walk;

static float length2(const float v[2])
{
    return noh_sqrt(v[0] * v[0] + v[1] * v[1]);
}

static void add2(float v[2], float share, const float by[2])
{
    v[0] += share * by[0];
    v[1] += share * by[1];
}

static float leg_of(const noh_stage_ragdoll_kind *shared, const noh_place *place)
{
    return shared->legs.length * shared->metres * place->scale;
}

static walk begin_walk(const noh_stage_kind *k, const noh_stage_actor *a, noh_stage_body *b)
{
    static const float left[3] = { 1.0f, 0.0f, 0.0f };
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    const noh_ragdoll_frame frame = noh_stage_ragdoll_frame(k, &a->place, b->origin);
    noh_stage_stagger *s = &b->of.stagger;
    walk w = { .shared = shared, .body = b, .s = s, .leg = leg_of(shared, &a->place) };
    float turned[3];
    w.time = noh_sqrt(a->place.scale);
    w.piece = PIECE / w.time;
    w.omega = noh_sqrt(NOH_GRAVITY / (CENTRE * w.leg));
    noh_quat_rotate(a->place.rotation, left, turned);
    turned[1] = 0.0f;
    noh_normalize3(turned, left);
    w.side[0] = turned[0];
    w.side[1] = turned[2];
    for (int i = 0; i < 2; i++) w.middle[i] = 0.5f * (s->feet[0].stance[2 * i] + s->feet[1].stance[2 * i]);
    memcpy(w.place, frame.position, sizeof w.place);
    return w;
}

/* Where a foot is, from the centre of mass. */
static void foot_at(const walk *w, uint32_t foot, float at[2])
{
    const noh_stage_foothold *f = &w->s->feet[foot];
    for (int i = 0; i < 2; i++) at[i] = f->stance[2 * i] + f->off[i] - w->middle[i];
}

/* ---- the point that it presses on ---- */

/* The nearest point to `p` under the feet that stand. Returns how far p is outside. */
static float under_feet(const walk *w, float p[2])
{
    float a[2], b[2], way[2], out[2];
    foot_at(w, w->s->foot == 1u ? 1u : 0u, a);
    foot_at(w, w->s->foot == 2u ? 0u : 1u, b);
    for (int i = 0; i < 2; i++) way[i] = b[i] - a[i];
    const float square = way[0] * way[0] + way[1] * way[1];
    float share = square > 0.0f ? ((p[0] - a[0]) * way[0] + (p[1] - a[1]) * way[1]) / square : 0.0f;
    share = share < 0.0f ? 0.0f : share > 1.0f ? 1.0f : share;
    add2(a, share, way);
    for (int i = 0; i < 2; i++) out[i] = p[i] - a[i];
    const float far = length2(out), sole = SOLE * w->leg;
    if (far <= sole) return 0.0f;
    memcpy(p, a, sizeof a);
    add2(p, sole / far, out);
    return far - sole;
}

static void capture_point(const walk *w, float at[2])
{
    for (int i = 0; i < 2; i++) at[i] = w->s->speed[i] / w->omega;
}

static void press(const walk *w, float p[2])
{
    float capture[2], a[2], b[2];
    capture_point(w, capture);
    foot_at(w, 0, a);
    foot_at(w, 1, b);
    for (int i = 0; i < 2; i++) {
        const float middle = w->s->foot ? 0.0f : 0.5f * (a[i] + b[i]);
        p[i] = capture[i] + PRESS * (capture[i] - middle);
    }
    (void)under_feet(w, p);
}

/* ---- steps ---- */

/* The height of the ground where a foot would stand, from the place. Returns 0: it cannot stand there. */
static int ground_at(const walk *w, const float off[2], uint32_t foot, float *height)
{
    const noh_stage_foothold *f = &w->s->feet[foot];
    const float at[3] = { w->place[0] + f->stance[0] + off[0], w->place[1], w->place[2] + f->stance[2] + off[1] };
    const float most = GROUND_STEP * w->leg;
    *height = 0.0f;
    if (!w->shared->world) return 1;
    if (!noh_world_ground_below(w->shared->world, w->body->origin, at, at[1] + most, height)) return 0;
    *height -= w->place[1];
    return *height > -most;
}

/* The part of a way from the centre of mass that ends at least `margin` before a wall. */
static float free_part(const walk *w, const float way[2], float margin)
{
    const float far = length2(way);
    const noh_ray ray = { { w->place[0] + w->middle[0], w->place[1] + WALL * w->leg, w->place[2] + w->middle[1] },
                          { way[0] / far, 0.0f, way[1] / far },
                          far + margin };
    if (!w->shared->world || !(far > 0.0f)) return 1.0f;
    const float room = noh_world_wall_ahead(w->shared->world, w->body->origin, &ray) - margin;
    return room >= far ? 1.0f : room > 0.0f ? room / far : 0.0f;
}

static void aim(const walk *w, uint32_t foot, float seconds, float off[2])
{
    const noh_stage_foothold *f = &w->s->feet[foot];
    const float grown = noh_exp2(1.44269504f * w->omega * seconds);
    float capture[2], p[2], stands[2], centre[2], goal[2];
    capture_point(w, capture);
    press(w, p);
    foot_at(w, 1u - foot, stands);
    const float own = (f->stance[0] - w->middle[0]) * w->side[0] + (f->stance[2] - w->middle[1]) * w->side[1];
    for (int i = 0; i < 2; i++) {
        centre[i] = p[i] + 0.5f * ((capture[i] - p[i]) * grown - (capture[i] + p[i]) / grown);
        goal[i] = p[i] + (capture[i] - p[i]) * grown + own * w->side[i];
    }
    const float across = (goal[0] - stands[0]) * w->side[0] + (goal[1] - stands[1]) * w->side[1];
    const float lacks = own > 0.0f ? own - across : across - own;
    if (lacks > 0.0f) add2(goal, own > 0.0f ? lacks : -lacks, w->side); /* legs do not cross */
    add2(goal, -1.0f, centre);
    const float far = length2(goal), most = STRIDE * w->leg;
    for (int i = 0; i < 2; i++) goal[i] = centre[i] + goal[i] * (far > most ? most / far : 1.0f);
    const float part = free_part(w, goal, SOLE * w->leg);
    for (int i = 0; i < 2; i++) off[i] = part * goal[i] + w->middle[i] - f->stance[2 * i];
}

static void begin_step(const walk *w, uint32_t foot, uint32_t ticks)
{
    noh_stage_foothold *f = &w->s->feet[foot];
    w->s->foot = foot + 1u;
    w->s->last = foot;
    w->s->step_ticks = 0;
    w->s->step_lasts = ticks;
    memcpy(f->from, f->off, sizeof f->from);
    f->height_was = f->height;
}

/* The foot that is behind, or the one on the side to which it is pushed; then they take turns. */
static uint32_t choose_foot(const walk *w, const float capture[2])
{
    float a[2], b[2];
    if (w->s->steps > 1u) return 1u - w->s->last;
    foot_at(w, 0, a);
    foot_at(w, 1, b);
    const float ahead = (a[0] - b[0]) * capture[0] + (a[1] - b[1]) * capture[1];
    const float across = capture[0] * w->side[0] + capture[1] * w->side[1], far = length2(capture);
    const float own = (w->s->feet[0].stance[0] - w->s->feet[1].stance[0]) * w->side[0] +
                      (w->s->feet[0].stance[2] - w->s->feet[1].stance[2]) * w->side[1];
    if (across * own > 0.35f * far * (own < 0.0f ? -own : own)) return 0;
    if (across * own < -0.35f * far * (own < 0.0f ? -own : own)) return 1;
    return ahead > 0.0f ? 1u : 0u;
}

/* Returns 0: it falls. */
static int decide(const walk *w)
{
    noh_stage_stagger *s = w->s;
    float capture[2], nearest[2], apart[2];
    capture_point(w, capture);
    memcpy(nearest, capture, sizeof nearest);
    const float outside = under_feet(w, nearest);
    if (outside > LOST * w->leg) return 0;
    if (s->foot) return 1;
    if (outside > 0.0f) {
        const float speed = length2(s->speed) / w->leg * w->time;
        const float seconds = (speed > 1.5f ? 0.22f : 0.34f - 0.08f * speed) * w->time;
        const uint32_t pieces = (uint32_t)(seconds / PIECE);
        if (s->steps++ == STEPS_MAX) return 0;
        begin_step(w, choose_foot(w, capture), PIECE_TICKS * (pieces ? pieces : 1u));
        return 1;
    }
    for (int i = 0; i < 2; i++) apart[i] = s->feet[0].off[i] - s->feet[1].off[i];
    if (length2(apart) > CLOSED * w->leg && length2(s->speed) * w->time < SLOW * w->leg) {
        const uint32_t foot = s->steps ? 1u - s->last : 0u;
        begin_step(w, foot, (uint32_t)(CLOSE_TICKS * w->time));
        memcpy(s->to, s->feet[1u - foot].off, sizeof s->to);
        s->steps = 0;
    }
    return 1;
}

static float ease(float x)
{
    return x * x * (3.0f - 2.0f * x);
}

/* Returns 0: there is no ground to step on. */
static int move_foot(const walk *w)
{
    noh_stage_stagger *s = w->s;
    noh_stage_foothold *f = &s->feet[s->foot - 1u];
    const float part = (float)s->step_ticks / (float)s->step_lasts;
    if (s->steps && part < 0.7f) {
        aim(w, s->foot - 1u, (float)(s->step_lasts - s->step_ticks) / (float)NOH_TICKS_PER_SECOND, s->to);
    }
    const int stands = ground_at(w, s->to, s->foot - 1u, &s->to_height);
    for (int i = 0; i < 2; i++) f->off[i] = f->from[i] + ease(part) * (s->to[i] - f->from[i]);
    f->height = f->height_was + ease(part) * (s->to_height - f->height_was);
    s->step_ticks += PIECE_TICKS;
    if (s->step_ticks < s->step_lasts) return stands;
    memcpy(f->off, s->to, sizeof f->off);
    f->height = s->to_height;
    s->foot = 0;
    return stands;
}

/* ---- time ---- */

/* The centre of mass goes on, and with it the place: feet that stand stay behind. */
static void move_centre(walk *w, float moved[3])
{
    noh_stage_stagger *s = w->s;
    float p[2], way[2], rise = 0.0f;
    press(w, p);
    for (int i = 0; i < 2; i++) {
        const float closes = w->s->foot && !s->steps ? s->feet[1u - s->last].off[i] : 0.0f;
        const float pull = s->foot && !s->steps ? 16.0f * closes / (w->time * w->time) - 8.0f * s->speed[i] / w->time
                                                : -w->omega * w->omega * p[i];
        s->speed[i] += pull * PIECE;
        way[i] = s->speed[i] * PIECE;
    }
    const float part = free_part(w, way, CHEST * w->leg); /* a wall takes the speed */
    for (int i = 0; i < 2; i++) {
        s->speed[i] *= part;
        way[i] *= part;
        w->place[2 * i] += way[i];
        moved[2 * i] += way[i];
    }
    for (int f = 0; f < 2; f++) rise += 0.5f * s->feet[f].height * 8.0f * w->piece;
    w->place[1] += rise;
    moved[1] += rise;
    for (int f = 0; f < 2; f++) {
        add2(s->feet[f].off, -1.0f, way);
        add2(s->feet[f].from, -1.0f, way);
        s->feet[f].height -= rise;
        s->feet[f].height_was -= rise;
    }
    add2(s->to, -1.0f, way);
    s->to_height -= rise;
}

static void move_trunk(const walk *w)
{
    noh_stage_stagger *s = w->s;
    const float fast = length2(s->speed) / w->leg * w->time, spread = s->ends ? 0.0f : fast > 1.0f ? 1.0f : fast;
    for (int i = 0; i < 2; i++) {
        s->lean_speed[i] -= (LEAN_RATE * LEAN_RATE * s->lean[i] + LEAN_RATE * s->lean_speed[i]) * w->piece;
        s->lean[i] += s->lean_speed[i] * w->piece;
    }
    s->arms += (spread - s->arms) * (spread > s->arms ? 9.0f : 3.0f) * w->piece;
    s->weight += s->ends ? -4.0f * w->piece : 0.0f;
}

static void lower_feet(const walk *w)
{
    noh_stage_foothold *f = w->s->feet;
    const int high = f[0].stance[1] > f[1].stance[1] ? 0 : 1;
    const float over = f[high].stance[1] - f[1 - high].stance[1], most = 2.0f * w->leg * w->piece;
    f[high].stance[1] -= over > most ? most : over; /* the push may come in the middle of a step */
}

static int is_done(const walk *w)
{
    const noh_stage_stagger *s = w->s;
    return !s->foot && length2(s->speed) * w->time < 0.03f * w->leg && length2(s->feet[0].off) < CLOSED * w->leg &&
           length2(s->feet[1].off) < CLOSED * w->leg && s->arms < 0.1f;
}

/* The place goes to where the clips have the pelvis where it is: a clip that travels would slide back to its way. */
static void end_walk(walk *w, float moved[3])
{
    noh_stage_stagger *s = w->s;
    s->ends = 1;
    for (int i = 0; i < 2; i++) {
        w->place[2 * i] -= s->strays[i];
        moved[2 * i] -= s->strays[i];
        w->middle[i] += s->strays[i];
        s->pelvis[i] += s->strays[i];
        for (int f = 0; f < 2; f++) s->feet[f].stance[2 * i] += s->strays[i];
        s->strays[i] = 0.0f;
    }
}

void noh_stage_step_stagger(noh_stage_kind *k, noh_stage_actor *a, noh_stage_body *b, uint32_t ticks)
{
    noh_stage_stagger *s = &b->of.stagger;
    float moved[3] = { 0.0f, 0.0f, 0.0f };
    int stands = 1;
    if (!noh_stage_can_fall(a)) { /* the game has attached or scaled it */
        b->moves = NOH_MOVES_BY_CLIPS;
        return;
    }
    walk w = begin_walk(k, a, b);
    s->rest_ticks += ticks < PIECES_MAX * PIECE_TICKS ? ticks : PIECES_MAX * PIECE_TICKS;
    for (; s->rest_ticks >= PIECE_TICKS && stands && s->weight > 0.0f; s->rest_ticks -= PIECE_TICKS) {
        stands = decide(&w);
        move_centre(&w, moved);
        if (s->foot && stands) stands = move_foot(&w);
        move_trunk(&w);
        lower_feet(&w);
        if (!s->ends && is_done(&w)) end_walk(&w, moved);
    }
    for (int i = 0; i < 3; i++) {
        float *at = &a->place.position[i], unused = 0.0f, *left = i == 1 ? &unused : &s->left[i / 2];
        const float way = moved[i] / w.shared->metres + *left, next = *at + way;
        *left = way - (next - *at);
        *at = next;
    }
    if (!NOH_PAGE) noh_stage_keep_within(&a->place, a->rest);
    noh_character_wake(noh_stage_character(k, noh_stage_index(k, a)));
    if (s->weight <= 0.0f) b->moves = NOH_MOVES_BY_CLIPS;
    if (!stands && noh_stage_brace_fall(k, a, b, NULL, NULL) != NOH_OK) b->moves = NOH_MOVES_BY_CLIPS;
}

/* ---- a push ---- */

/* The joint that a body of an actor of a scale lies on: in metres from the origin, and its rotation. */
static void joint_of(const noh_stage_ragdoll_kind *shared, const noh_stage_body *b, float scale, uint32_t body,
                     float at[3], float rotation[4])
{
    float back[4], offset[3];
    noh_quat_conjugate(shared->fit.bodies[body].rotation, back);
    noh_quat_mul(b->bodies[0][body].rotation, back, rotation);
    noh_quat_rotate(rotation, shared->fit.bodies[body].position, offset);
    noh_madd3(b->bodies[0][body].position, -scale, offset, at);
}

static int take_stance(const noh_stage_kind *k, const noh_stage_actor *a, noh_stage_body *b, noh_stage_stagger *s)
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    const noh_ragdoll_frame frame = noh_stage_ragdoll_frame(k, &a->place, b->origin);
    float back[4], at[3], turned[4];
    memset(s, 0, sizeof *s);
    noh_quat_conjugate(frame.rotation, back);
    for (uint32_t i = 0; i < 2; i++) {
        noh_stage_foothold *f = &s->feet[i];
        joint_of(shared, b, a->place.scale, shared->parts.feet[i], f->stance, f->rotation);
        noh_quat_mul(back, f->rotation, f->rotation);
        noh_sub3(f->stance, frame.position, f->stance);
        if (b->bodies[0][0].position[1] - frame.position[1] - f->stance[1] < 0.75f * leg_of(shared, &a->place))
            return 0;
    }
    joint_of(shared, b, a->place.scale, 0, at, turned);
    for (int i = 0; i < 2; i++) s->pelvis[i] = at[2 * i] - frame.position[2 * i];
    s->weight = 1.0f;
    return 1;
}

static int is_upright(const noh_stage_actor *a)
{
    static const float up[3] = { 0.0f, 1.0f, 0.0f };
    float turned[3];
    noh_quat_rotate(a->place.rotation, up, turned);
    return turned[1] > 0.99f;
}

int noh_stage_begin_stagger(noh_stage_kind *k, noh_stage_actor *a, noh_stage_body *b, const noh_stage_push *push)
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    const float size = a->place.scale, mass = shared->mass * size * size * size, leg = leg_of(shared, &a->place);
    const float natural = STAGGER_SPEED * noh_sqrt(NOH_GRAVITY * leg);
    const float most = shared->stagger_speed != 0.0f ? shared->stagger_speed * noh_sqrt(size) : natural;
    const float by[2] = { push->impulse[0] / mass, push->impulse[2] / mass };
    noh_stage_stagger s = b->of.stagger;
    if (!shared->parts.has_legs || b->state != NOH_BODY_STANDS || b->dead || !b->poses) return 0;
    if (!noh_stage_can_fall(a) || !is_upright(a) || b->moves == NOH_MOVES_UP_BEGINS || b->moves == NOH_MOVES_UP)
        return 0;
    if (b->moves != NOH_MOVES_STAGGERING && !take_stance(k, a, b, &s)) return 0;
    add2(s.speed, 1.0f, by);
    if (!(length2(s.speed) <= most)) return 0;
    const float height = push->point[1] - b->origin[1] - b->bodies[0][0].position[1], high = 2.0f * height / leg;
    add2(s.lean_speed, (high > 1.0f ? 1.0f : high < -1.0f ? -1.0f : high) * 2.0f * noh_sqrt(size) / leg, by);
    s.steps = s.foot ? 1u : 0u;
    s.weight = 1.0f;
    s.ends = 0;
    b->of.stagger = s;
    b->moves = NOH_MOVES_STAGGERING;
    noh_character_wake(noh_stage_character(k, noh_stage_index(k, a)));
    return 1;
}

/* ---- the pose ---- */

static void pose_trunk(const noh_stage_ragdoll_kind *shared, const noh_stage_stagger *s, const noh_modifier_work *w)
{
    static const float shares[3] = { 0.6f, 0.4f, -0.6f };
    const uint32_t bodies[3] = { shared->parts.spine, shared->parts.chest, shared->parts.head };
    float axis[3] = { s->lean[1] * s->weight, 0.0f, -s->lean[0] * s->weight }, back[4];
    noh_quat_conjugate(w->place.rotation, back);
    noh_quat_rotate(back, axis, axis);
    for (int i = 0; i < 3; i++) {
        const float turn[3] = { axis[0] * shares[i], axis[1] * shares[i], axis[2] * shares[i] };
        if (bodies[i] != NOH_NONE) noh_rig_rotate(w->skeleton, w->local, shared->fit.joints[bodies[i]], turn);
    }
    for (uint32_t i = 0; i < shared->parts.arm_count; i++) {
        const uint32_t upper = shared->fit.joints[shared->parts.upper_arms[i]];
        const uint32_t lower = shared->fit.joints[shared->parts.forearms[i]];
        float way[3], turn[3], at[3], unused[4];
        noh_rig_joint(w->skeleton, w->local, upper, at, unused);
        noh_rig_bone(w->skeleton, w->local, upper, lower, way);
        noh_normalize3(way, at);
        const float out[3] = { at[0] > 0.0f ? 0.9f : -0.9f, 0.0f, 0.45f };
        noh_cross3(way, out, turn);
        for (int n = 0; n < 3; n++) turn[n] *= 0.7f * s->arms * s->weight;
        noh_rig_rotate(w->skeleton, w->local, upper, turn);
    }
}

/* Where the foot of a leg is wanted. */
static void want_foot(const noh_stage_ragdoll_kind *shared, const noh_stage_stagger *s, const noh_modifier_work *w,
                      uint32_t i, noh_stage_leg *leg)
{
    const noh_stage_foothold *f = &s->feet[i];
    const float part = s->foot == i + 1u ? (float)s->step_ticks / (float)s->step_lasts : 0.0f;
    float back[4], want[3] = { f->stance[0] + f->off[0], f->stance[1] + f->height, f->stance[2] + f->off[1] };
    want[1] += 4.0f * part * (1.0f - part) * LIFT * leg_of(shared, &w->place);
    noh_quat_nlerp(leg->foot, f->rotation, ease(s->weight), leg->foot);
    noh_quat_conjugate(w->place.rotation, back);
    noh_quat_rotate(back, want, want);
    for (int n = 0; n < 3; n++) {
        want[n] = want[n] / (shared->metres * w->place.scale) - leg->ankle[n];
        leg->ankle[n] += ease(s->weight) * want[n];
    }
}

/* How the pelvis moves, in model space: it stays where it was over the feet, and low while arms are out. */
static void pelvis_move(const noh_stage_ragdoll_kind *shared, noh_stage_stagger *s, const noh_modifier_work *w,
                        float by[3])
{
    const float unit = shared->metres * w->place.scale;
    float at[3], back[4];
    noh_rig_joint(w->skeleton, w->local, shared->fit.joints[0], at, back);
    noh_quat_rotate(w->place.rotation, at, at);
    for (int i = 0; i < 2; i++) {
        s->strays[i] = at[2 * i] * unit - s->pelvis[i];
        by[2 * i] = -ease(s->weight) * s->strays[i] / unit;
    }
    by[1] = -CROUCH * shared->legs.length * s->arms * s->weight;
    noh_quat_conjugate(w->place.rotation, back);
    noh_quat_rotate(back, by, by);
}

void noh_stage_run_stagger(const noh_stage_kind *k, noh_stage_body *b, noh_modifier_work *w)
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    noh_stage_stagger *s = &b->of.stagger;
    noh_stage_leg legs[NOH_FEET_LEGS_MAX];
    float by[3];
    if (w->joint_count <= shared->legs.last) return;
    pelvis_move(shared, s, w, by);
    pose_trunk(shared, s, w);
    for (uint32_t i = 0; i < NOH_FEET_LEGS_MAX; i++) {
        noh_stage_read_leg(&shared->legs, w, i, &legs[i]);
        want_foot(shared, s, w, i, &legs[i]);
    }
    noh_stage_move_pelvis(&shared->legs, w, legs, by);
}

const char *noh_stage_check_stagger(const noh_stage_stagger *s)
{
    const int are_numbers = NOH_ARE_SOUND(noh_stage_stagger, s, feet, foot);
    return are_numbers && s->arms <= 1.01f && s->weight > 0.0f && s->weight <= 1.0f && s->foot <= 2u && s->last <= 1u &&
                   s->step_ticks <= NOH_RAGDOLL_TIME_MAX * NOH_TICKS_PER_SECOND && (!s->foot || s->step_lasts) &&
                   s->step_lasts <= NOH_RAGDOLL_TIME_MAX * NOH_TICKS_PER_SECOND && s->rest_ticks < PIECE_TICKS &&
                   s->ends <= 1u
               ? NULL
               : "state: a push of an actor is out of range";
}
