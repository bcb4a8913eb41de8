/* walkers_step.c: moves actors and their clips after their agents. */
#include <string.h>

#include "motion/anim/root_internal.h"
#include "core/base/math_internal.h"
#include "core/base/assert_internal.h"
#include "core/base/trig_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/crowd.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "stage/actors/walkers_internal.h"
#include "stage/character/character_internal.h"

#define TURN_HALF_LIFE_S 0.12f /* of the velocity that headings follow */
#define EVEN_HALF_LIFE_S 0.06f /* of the speed that blends follow */
#define GOES 0.12f             /* of the walk's speed: below this there is no direction */
#define BLEND_PER_S 4.0f       /* blend speed of the run */
#define ABOUT_M 0.08f          /* distance of a foot from the turning axis: turning means stepping */
#define BACK 0.8f              /* of the walk's speed: turns around to go back faster */
#define CATCH_PER_S 3.0f       /* share of the way to its agent per second */
#define SLACK_M 0.06f          /* that near to its agent it stands */
#define STANDING_M 0.2f        /* a standing walker does not set out for less */
#define LOOKING_M 0.35f        /* a standing walker with a direction to face turns there for less */
#define SLOW 0.12f             /* of the walk's speed: goes no farther than to an agent slower than this */
#define LAG_M 0.7f             /* greatest distance from its agent */
#define RATE_MAX 2.5f          /* playback rate of the walk: faster looks like stumbling */
#define CLIMB_RATE 14.0f       /* of the spring that follows the ground, 1/s */
#define LEAP_M 1.0f            /* in a step: a teleport */

typedef struct step {
    noh_walkers *w;
    noh_stage *stage;
    noh_stage_kind *k;
    const noh_ground *ground;
    const double *home; /* [2] x, z of the crowd: origin of agents and walkers */
    uint32_t ticks;
    float seconds;
} step;

static float dot2(const float a[2], const float b[2])
{
    return a[0] * b[0] + a[1] * b[1];
}

/* ---- heading ---- */

/* Turn towards a unit vector, by at most an angle. Returns the angle before. */
static float turn(float heading[2], const float to[2], float most)
{
    const float cross = heading[0] * to[1] - heading[1] * to[0];
    const float angle = noh_atan2(cross, dot2(heading, to)), by = noh_clamped(angle, -most, most);
    float sine, cosine;
    noh_sin_cos(by, &sine, &cosine);
    const float x = heading[0] * cosine - heading[1] * sine, z = heading[0] * sine + heading[1] * cosine;
    const float per = 1.0f / noh_sqrt(x * x + z * z);
    heading[0] = x * per;
    heading[1] = z * per;
    return angle < 0.0f ? -angle : angle;
}

/* Turn to the wanted direction or, standing, to the one it should face. wish[2]: model units per second. */
static void find_heading(const step *s, walker *r, const float wish[2], walker_speed *g)
{
    const float square = dot2(wish, wish), walk = g->walk, least = GOES * walk, ahead = dot2(wish, r->heading);
    const float free = s->w->knows_steps ? (float)r->free * (1.0f / 255.0f) : 1.0f;
    const float most = s->w->turn_speed * s->seconds * free;
    const int turns_back = ahead < 0.0f && ahead * ahead > (r->goes_back ? 0.25f : 0.75f) * square &&
                           square < BACK * BACK * walk * walk;
    if (r->gait != WALKER_CLOSES) r->goes_back = (uint8_t)turns_back; /* the last step keeps its direction */
    g->wants_to_go = square > least * least;
    if (g->wants_to_go) {
        const float per = (r->goes_back ? -1.0f : 1.0f) / noh_sqrt(square), to[2] = { wish[0] * per, wish[1] * per };
        g->angle = turn(r->heading, to, most);
    } else if (r->face[0] != 0.0f || r->face[1] != 0.0f) {
        g->angle = turn(r->heading, r->face, most);
    }
}

/* ---- clips ---- */

/* The clips after the step: the phase of each, 0..1. */
typedef struct played {
    float before[WALKER_CLIPS], weights[WALKER_CLIPS], shares[WALKER_CLIPS];
    float way;     /* displacement by the clips in the step */
    float sway[2]; /* sway of the root about it, model units */
} played;

static float speed_of(const walker_clip *c)
{
    return c->clip == NOH_NONE ? 0.0f : c->stride * (float)NOH_TICKS_PER_SECOND / (float)c->ticks;
}

/* Blend between walk and run. Clips that are not in step are blended only while they change. */
static float runs_of(const noh_walkers *w, const walker *r, const walker_speed *g)
{
    if (!(g->run > g->walk)) return 0.0f;
    const float part = noh_clamped((g->even - g->walk) / (g->run - g->walk), 0.0f, 1.0f);
    if (w->in_step) return part;
    return part > (r->runs > 0.5f ? 0.3f : 0.6f) ? 1.0f : 0.0f;
}

/* Passes per second at which the blended clips keep up with the agent. way: model units of a pass. */
static float pace(const step *s, const walker *r, const walker_speed *g, float share, float *way)
{
    const walker_clip *walk = &s->w->clips[WALKER_WALK], *run = &s->w->clips[WALKER_RUN];
    const float stride = r->goes * (walk->stride + r->runs * (run->stride - walk->stride));
    const float most = RATE_MAX * (float)NOH_TICKS_PER_SECOND / (float)walk->ticks; /* applies to the run, too */
    const float wanted = noh_clamped(stride > 1e-3f * walk->stride ? g->now / stride : 0.0f, -most, most);
    const float rate = noh_walkers_pace(s->w, r, g, wanted, share, s->seconds);
    *way = rate * stride * s->seconds;
    return rate;
}

/* The phase of a track now, and after the step. */
static float share_of(const walker_clip *c, const noh_track *track, int64_t speed, uint32_t ticks)
{
    const int64_t pass = noh_position_of(c->ticks);
    const int64_t at = pass ? (track->position + speed * (int64_t)ticks) % pass : 0;
    return pass ? (float)(at < 0 ? at + pass : at) / (float)pass : 0.0f;
}

/* Stop a walker whose last step brings it next to a standing agent. */
static void find_end(const step *s, const walker *r, const noh_controller *c, float scale, walker_speed *g)
{
    const walker_clip *walk = &s->w->clips[WALKER_WALK];
    const float slow = SLOW * g->walk, off[2] = { r->at[0] - r->body[0], r->at[1] - r->body[1] };
    const float ahead = (r->goes_back ? -1.0f : 1.0f) * dot2(off, r->heading);
    if (!s->w->knows_steps || r->gait != WALKER_WALKS || dot2(r->velocity, r->velocity) > slow * slow) return;
    const uint32_t track = s->k->layers[s->w->layer].first_track;
    const float share = share_of(walk, noh_controller_track(c, track), 0, 0);
    g->wants_to_go = ahead > (noh_walkers_until_passing(s->w, r, share, NULL) + 0.25f) * walk->stride * scale;
}

/* Stand, step on the spot or walk. */
static float find_gait(const step *s, walker *r, noh_controller *c, const walker_speed *g)
{
    const uint32_t track = s->k->layers[s->w->layer].first_track;
    const walker_clip *walk = &s->w->clips[WALKER_WALK];
    const float share = share_of(walk, noh_controller_track(c, track), 0, 0);
    const float to = noh_walkers_gait(s->w, r, g, s->seconds, share);
    r->runs = noh_walker_towards(r->runs, runs_of(s->w, r, g), BLEND_PER_S * s->seconds);
    if (to < 0.0f) return share;
    (void)noh_controller_seek(c, &s->k->set, track, (int64_t)(to * (float)walk->ticks), NOH_SEEK_SKIP, NULL);
    return to;
}

/* Sway of a root about its straight way, model units. */
static void add_sway(const walker_clip *c, float share, float weight, float sway[2])
{
    const float at = share * (float)WALKER_SWAY;
    const uint32_t i = at < (float)(WALKER_SWAY - 1u) ? (uint32_t)at : WALKER_SWAY - 1u;
    const float part = at - (float)i;
    for (int k = 0; k < 2; k++) sway[k] += weight * (c->sway[i][k] + part * (c->sway[i + 1u][k] - c->sway[i][k]));
}

/* Set weights and speeds of the tracks for this step. */
static void play(const step *s, const walker *r, noh_controller *c, float passes, played *p)
{
    const float weights[WALKER_CLIPS] = { r->goes * (1.0f - r->runs), 1.0f - r->goes, r->goes * r->runs };
    uint32_t track = s->k->layers[s->w->layer].first_track;
    memset(p->before, 0, sizeof p->before); /* missing clips have no weight */
    memset(p->sway, 0, sizeof p->sway);
    memset(p->shares, 0, sizeof p->shares);
    memcpy(p->weights, weights, sizeof weights);
    for (uint32_t i = 0; i < WALKER_CLIPS; i++) {
        const walker_clip *clip = &s->w->clips[i];
        int32_t speed = 65536;
        if (clip->clip == NOH_NONE) continue;
        if (i != WALKER_IDLE) {
            const float rate = passes * (float)clip->ticks * (65536.0f / (float)NOH_TICKS_PER_SECOND);
            speed = (int32_t)noh_clamped(rate, -(float)NOH_SPEED_MAX, (float)NOH_SPEED_MAX);
        }
        p->before[i] = noh_controller_track(c, track)->weight;
        (void)noh_controller_set_weight(c, track, weights[i]);
        (void)noh_controller_set_speed(c, track, speed);
        const float was = share_of(clip, noh_controller_track(c, track), 0, 0);
        p->shares[i] = share_of(clip, noh_controller_track(c, track), speed, s->ticks);
        add_sway(clip, was, -weights[i], p->sway);
        add_sway(clip, p->shares[i], weights[i], p->sway);
        track++;
    }
}

/* ---- position ---- */

static float ground_at(const step *s, const walker *r)
{
    const float up = 2.0f;
    const float from[3] = { (float)(s->home[0] + (double)r->at[0]), r->height + up,
                            (float)(s->home[1] + (double)r->at[1]) };
    float normal[3];
    if (!s->ground || !(s->ground->world || s->ground->below)) return 0.0f;
    const float distance = noh_ground_below(s->ground, from, 1e3f, normal);
    return distance < 0.0f ? r->height : from[1] - distance;
}

/* Critically damped, exact for steps of any length. */
static void climb(const step *s, walker *r)
{
    const float goal = ground_at(s, r), off = r->height - goal;
    const float part = (r->climb + CLIMB_RATE * off) * s->seconds;
    const float shrink = noh_exp2(-1.44269504f * CLIMB_RATE * s->seconds);
    r->height = r->begun ? goal + (off + part) * shrink : goal;
    r->climb = r->begun ? (r->climb - CLIMB_RATE * part) * shrink : 0.0f;
}

/* The rotation about y from the walk's direction to the heading. */
static void rotation_of(const noh_walkers *w, const float heading[2], float rotation[4])
{
    const float cosine = dot2(w->forward, heading);
    const float sine = w->forward[1] * heading[0] - w->forward[0] * heading[1];
    const float half = noh_sqrt(noh_clamped(0.5f - 0.5f * cosine, 0.0f, 1.0f));
    memset(rotation, 0, 4 * sizeof *rotation);
    rotation[1] = sine < 0.0f ? -half : half;
    rotation[3] = noh_sqrt(noh_clamped(0.5f + 0.5f * cosine, 0.0f, 1.0f));
}

/* Rotate and scale a horizontal vector. */
static void turned_by(const float rotation[4], float scale, float x, float z, float out[2])
{
    const float local[3] = { x, 0.0f, z };
    float turned[3];
    noh_quat_rotate(rotation, local, turned);
    out[0] = scale * turned[0];
    out[1] = scale * turned[2];
}

static void put(const step *s, const walker *r, noh_stage_actor *a, const noh_place *was, const float rotation[4])
{
    noh_place place = *was;
    float rest[2];
    memcpy(place.rotation, rotation, sizeof place.rotation);
    for (int i = 0; i < 2; i++) noh_split(s->home[i] + (double)r->body[i], &place.position[2 * i], &rest[i]);
    place.position[1] = r->height;
    if (!noh_actor_set_place(s->stage, (noh_actor){ r->actor }, &place, NULL)) {
        a->rest[0] = rest[0];
        a->rest[2] = rest[1];
    }
    if (!r->begun) (void)noh_actor_cut(s->stage, (noh_actor){ r->actor }, NULL);
}

/* Move as the clips do. The standing foot stays in place while clips blend; the body turns about it. */
static void go_on(const step *s, walker *r, const noh_place *was, const float rotation[4], const played *p)
{
    const uint32_t leg = r->stands / WALKER_PARTS, part = r->stands % WALKER_PARTS;
    walker_feet blended, feet;
    float on[2], from[2], to[2];
    noh_walkers_soles_at(s->w, p->shares, p->before, &blended);
    noh_walkers_soles_at(s->w, p->shares, p->weights, &feet);
    const float *b = blended.at[leg][part], *f = feet.at[leg][part];
    turned_by(was->rotation, was->scale, s->w->forward[0] * p->way + p->sway[0], s->w->forward[1] * p->way + p->sway[1],
              on);
    turned_by(was->rotation, was->scale, b[0], b[2], from);
    turned_by(rotation, was->scale, f[0], f[2], to);
    for (int i = 0; i < 2 && r->begun == 1u; i++) r->body[i] += on[i] + from[i] - to[i];
    r->stands = noh_walkers_stand(s->w, &feet, r->stands);
    r->free = s->w->knows_steps ? (uint8_t)(255.0f * noh_walkers_free(s->w, &feet, r->stands)) : 255u;
}

/* ---- a step ---- */

/* Desired velocity: the agent's velocity, plus a correction to catch up with it. Model units per second. */
static void find_wish(const noh_walkers *w, const walker *r, float scale, float wish[2])
{
    const float off[2] = { r->at[0] - r->body[0], r->at[1] - r->body[1] }, length = noh_sqrt(dot2(off, off));
    const int looks = r->face[0] != 0.0f || r->face[1] != 0.0f;
    const int stands = w->knows_steps ? r->gait != WALKER_WALKS : looks;
    const float slack = !stands ? SLACK_M : looks ? LOOKING_M : STANDING_M;
    const float catch = length > slack ? CATCH_PER_S * (length - slack) / (length * scale) : 0.0f;
    for (int i = 0; i < 2; i++) wish[i] = r->velocity[i] + catch * off[i];
}

/* Limit the distance to the agent. */
static void keep_near(walker *r)
{
    const float off[2] = { r->body[0] - r->at[0], r->body[1] - r->at[1] }, square = dot2(off, off);
    const float by = square > LAG_M * LAG_M ? 1.0f - LAG_M / noh_sqrt(square) : 0.0f;
    for (int i = 0; i < 2; i++) r->body[i] -= by * off[i];
}

/* Start from standing. */
static void begin(walker *r)
{
    r->gait = WALKER_STANDS;
    r->goes = r->runs = 0.0f;
    r->free = 0;
}

static void follow(const step *s, walker *r, noh_stage_actor *a, const float to[2])
{
    const float way[2] = { to[0] - r->at[0], to[1] - r->at[1] }, scale = a->place.scale;
    const float per = 1.0f / (s->seconds * scale); /* model units per second */
    const float keep = noh_exp2(-s->seconds / TURN_HALF_LIFE_S);
    walker_speed g = { speed_of(&s->w->clips[WALKER_WALK]), speed_of(&s->w->clips[WALKER_RUN]), 0.0f, 0.0f, 0.0f, 0 };
    noh_controller *c = noh_character_controller(noh_stage_character(s->k, noh_stage_index(s->k, a)));
    float wish[2], rotation[4];
    played p;
    noh_place was;
    if (dot2(way, way) > LEAP_M * LEAP_M) r->begun = 0;
    memcpy(r->at, to, sizeof r->at);
    if (!r->begun) memcpy(r->body, to, sizeof r->body);
    if (r->begun != 1u) begin(r);
    for (int i = 0; i < 2 && r->begun; i++) {
        r->velocity[i] = per * way[i] + keep * (r->velocity[i] - per * way[i]);
    }
    find_wish(s->w, r, scale, wish);
    find_heading(s, r, wish, &g);
    const float turns = noh_clamped(g.angle, 0.0f, s->w->turn_speed * s->seconds), steps = ABOUT_M * turns * per;
    const float ahead = dot2(wish, r->heading);
    g.now = !r->begun ? 0.0f : r->goes_back ? ahead : ahead > steps ? ahead : steps;
    const float fast = g.now < 0.0f ? -g.now : g.now;
    r->even = fast + noh_exp2(-s->seconds / EVEN_HALF_LIFE_S) * (r->even - fast);
    g.even = r->even;
    find_end(s, r, c, scale, &g);
    const float share = find_gait(s, r, c, &g);
    play(s, r, c, pace(s, r, &g, share, &p.way), &p);
    climb(s, r);
    (void)noh_actor_place(s->stage, (noh_actor){ r->actor }, &was, NULL);
    rotation_of(s->w, r->heading, rotation);
    go_on(s, r, &was, rotation, &p);
    keep_near(r);
    noh_walkers_tell_leg(s->w, s->stage, r);
    put(s, r, a, &was, rotation);
    r->begun = 1;
}

static void step_walker(const step *s, const noh_crowd *crowd, walker *r)
{
    float at[2];
    noh_stage_kind *k;
    noh_stage_actor *a = noh_stage_actor_of(s->stage, (noh_actor){ r->actor }, &k);
    if (!a) {
        r->actor = 0;
        return;
    }
    if (noh_stage_is_carried(k, noh_stage_index(k, a))) {
        r->begun = 0;
        return;
    }
    if (!noh_crowd_shown(crowd, r->agent, at)) memcpy(at, r->at, sizeof at); /* no agent: stop */
    follow(s, r, a, at);
}

noh_result noh_walkers_step(noh_walkers *walkers, const noh_crowd *crowd, noh_stage *stage, const noh_ground *ground,
                            uint32_t ticks, noh_error *error)
{
    NOH_ASSERT(walkers && crowd && stage);
    const step s = { walkers,
                     stage,
                     &stage->kinds[walkers->kind],
                     ground,
                     crowd->home,
                     ticks,
                     (float)ticks * (1.0f / (float)NOH_TICKS_PER_SECOND) };
    if (stage->phase != NOH_STAGE_IDLE) {
        return noh_fail(error, NOH_ERR_ARG, "noh_walkers_step called during a step or a frame", 0, 0);
    }
    for (uint32_t i = 0; i < walkers->walker_max && ticks; i++) {
        walker *r = noh_walker_at(walkers, i);
        if (r->actor) step_walker(&s, crowd, r);
    }
    return NOH_OK;
}
