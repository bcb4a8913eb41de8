/* walkers_gait.c: when walkers lift a foot and put it down. A foot on the ground stays where it is: the walk blends
 * in and out, and the body turns, while the other foot is in the air. A standing walker has both feet on the ground,
 * so it starts and stops with a step: the walk at the moment when one leg passes the other, blended with standing,
 * lifts a foot on the spot. */
#include "stage/actors/walkers_internal.h"
#include "noh/base.h"
#include "noh/crowd.h"

#define SLOWEST 0.25f    /* of the walk's speed: below this, single steps with pauses */
#define BLEND_PER_S 4.0f /* blend speed of the walk where steps are not known */
#define LIFT_PER_S 6.0f  /* blend speed of a foot lifted on the spot */
#define TURNS 0.26f      /* radians: a standing walker ignores smaller turns */
#define TURNED 0.02f     /* radians: no further step on the spot for less */
#define ENDS 0.3f        /* radians: keeps its foot up until the turn is done */
#define AHEAD 1.0f       /* radians: turns on the spot first, then walks */
#define SPIN_SLOW 0.2f   /* passes per second while a walk has to turn by more: with a foot in the air, */
#define SPIN_FAST 1.5f   /* with both on the ground */
#define CLOSE_PER_S 0.8f /* passes per second: least speed of the last step */
#define CLOSE_RATE 5.0f  /* share of the remaining way per second */
#define CLOSE_SLOW 0.15f /* passes per second at its end */
#define CLOSED 0.01f     /* passes: close enough to the end */

float noh_walkers_until_passing(const noh_walkers *w, const walker *r, float share, uint32_t *leg)
{
    float least = 2.0f;
    for (uint32_t n = 0; n < 2u * WALKER_SWAY; n++) {
        const uint32_t l = n / WALKER_SWAY, i = n % WALKER_SWAY;
        if (!(w->passes[l] >> i & 1u)) continue;
        float way = noh_walkers_pass_at(w, l, i) - share;
        way = r->goes_back ? -way : way;
        way += way < -CLOSED ? 1.0f : 0.0f;
        if (way >= least) continue;
        least = way;
        if (leg) *leg = l;
    }
    return least;
}

/* The first moment of the walk when one leg passes the other. */
static float first_pass(const noh_walkers *w, uint32_t leg)
{
    uint32_t i = 0;
    while (!(w->passes[leg] >> i & 1u)) i++;
    return noh_walkers_pass_at(w, leg, i);
}

/* Stand on the other leg, at the moment of the walk when this one passes it. */
static float lift(const noh_walkers *w, walker *r)
{
    r->gait = WALKER_LIFTS;
    r->stands = (1u - r->swings) * WALKER_PARTS;
    return first_pass(w, r->swings);
}

/* With a foot lifted: continue the step, or put the foot down. */
static void lifted(const noh_walkers *w, walker *r, const walker_speed *g, float share)
{
    const float way = share - first_pass(w, r->swings);
    if ((g->wants_to_go && g->angle < AHEAD) || way > CLOSED || way < -CLOSED) /* it has started to walk */
        r->gait = WALKER_WALKS;
    else if (!(g->angle > TURNED && g->angle < ENDS))
        r->gait = WALKER_LOWERS;
}

static float step_on_the_spot(const noh_walkers *w, walker *r, const walker_speed *g, float by, float share)
{
    if (r->gait == WALKER_LIFTS) {
        r->goes = noh_walker_towards(r->goes, 1.0f, by);
        if (r->goes >= 1.0f) lifted(w, r, g, share);
        return -1.0f;
    }
    r->goes = noh_walker_towards(r->goes, 0.0f, by);
    if (r->goes > 0.0f) return -1.0f;
    r->swings = (uint8_t)(1u - r->swings);
    r->gait = WALKER_STANDS;
    return g->angle > TURNED ? lift(w, r) : -1.0f;
}

float noh_walkers_gait(const noh_walkers *w, walker *r, const walker_speed *g, float seconds, float share)
{
    if (!w->knows_steps) {
        const float goes = g->even / (SLOWEST * g->walk), to = goes > 1.0f ? 1.0f : goes;
        r->gait = WALKER_WALKS;
        r->goes = w->clips[WALKER_IDLE].clip == NOH_NONE ? 1.0f
                                                         : noh_walker_towards(r->goes, to, BLEND_PER_S * seconds);
        return -1.0f;
    }
    if (r->gait == WALKER_STANDS) return g->wants_to_go || g->angle > TURNS ? lift(w, r) : -1.0f;
    if (r->gait == WALKER_LIFTS || r->gait == WALKER_LOWERS)
        return step_on_the_spot(w, r, g, LIFT_PER_S * seconds, share);
    r->gait = g->wants_to_go ? WALKER_WALKS : WALKER_CLOSES;
    uint32_t leg = r->swings;
    if (r->gait == WALKER_CLOSES && noh_walkers_until_passing(w, r, share, &leg) < CLOSED) {
        r->swings = (uint8_t)leg;
        r->gait = WALKER_LOWERS;
    }
    return -1.0f;
}

/* Turn with a foot in the air; with both on the ground, advance until one lifts. */
static float pace_of_walk(const noh_walkers *w, const walker *r, const walker_speed *g, float rate)
{
    const float free = (float)r->free * (1.0f / 255.0f);
    const float spin = SPIN_FAST + free * (SPIN_SLOW - SPIN_FAST);
    const float least = SLOWEST * g->walk / w->clips[WALKER_WALK].stride, fast = rate < 0.0f ? -rate : rate;
    const float by = g->angle > AHEAD ? spin : fast < least ? least : fast;
    return r->goes_back ? -by : by;
}

float noh_walkers_pace(const noh_walkers *w, const walker *r, const walker_speed *g, float rate, float share,
                       float seconds)
{
    if (!w->knows_steps) return rate;
    if (r->gait == WALKER_WALKS) return pace_of_walk(w, r, g, rate);
    if (r->gait == WALKER_LIFTS) return g->wants_to_go && g->angle < AHEAD ? r->goes * r->goes * rate : 0.0f;
    if (r->gait != WALKER_CLOSES) return 0.0f;
    const float way = noh_walkers_until_passing(w, r, share, NULL), fast = rate < 0.0f ? -rate : rate;
    const float most = fast > CLOSE_PER_S ? fast : CLOSE_PER_S, slowing = CLOSE_RATE * way;
    const float by = slowing > most ? most : slowing < CLOSE_SLOW ? CLOSE_SLOW : slowing;
    const float end = by * seconds > way ? way / seconds : by;
    return r->goes_back ? -end : end;
}
