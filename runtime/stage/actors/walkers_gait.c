/* walkers_gait.c: when walkers lift a foot and put it down. A foot that is on the ground stays where it is: the walk
 * comes and goes, and the body turns, while the other foot is in the air. Who stands has both on the ground, so it
 * begins with a step and ends with one: the walk at the moment at which a leg swings past the other one, blended with
 * standing, is a foot that is lifted on the spot. */
#include "stage/actors/walkers_internal.h"
#include "noh/base.h"
#include "noh/crowd.h"

#define SLOWEST 0.25f    /* of the walk's speed: who goes slower makes a step now and then */
#define BLEND_PER_S 4.0f /* how fast the walk comes and goes of one whose steps are not known */
#define LIFT_PER_S 6.0f  /* likewise, on the spot */
#define TURNS 0.26f      /* radians: who stands and is to turn by less does not */
#define TURNED 0.02f     /* who turns on the spot makes no further step for less */
#define ENDS 0.3f        /* or holds its foot up until it is done */
#define AHEAD 1.0f       /* who has to turn by more first turns on the spot, then goes */
#define SPIN_SLOW 0.2f   /* passes a second of one who walks and has to turn by more, with a foot in the air, */
#define SPIN_FAST 1.5f   /* and with both on the ground */
#define CLOSE_PER_S 0.8f /* passes: how fast the last step is at least */
#define CLOSE_RATE 5.0f  /* of the way that is left, per second */
#define CLOSE_SLOW 0.15f /* passes a second, at its end */
#define CLOSED 0.01f     /* passes: it has come to the end */

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

/* The first moment of the walk at which a leg swings past the other. */
static float first_pass(const noh_walkers *w, uint32_t leg)
{
    uint32_t i = 0;
    while (!(w->passes[leg] >> i & 1u)) i++;
    return noh_walkers_pass_at(w, leg, i);
}

/* It stands on the other leg, at the moment of its walk at which this one swings. */
static float lift(const noh_walkers *w, walker *r)
{
    r->gait = WALKER_LIFTS;
    r->stands = (1u - r->swings) * WALKER_PARTS;
    return first_pass(w, r->swings);
}

/* Who has lifted a foot goes on with its step, or puts it down. */
static void lifted(const noh_walkers *w, walker *r, const walker_speed *g, float share)
{
    const float way = share - first_pass(w, r->swings);
    if ((g->wants_to_go && g->angle < AHEAD) || way > CLOSED || way < -CLOSED) /* it has begun to go */
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

/* With a foot in the air it turns, and with both on the ground it goes on to where one is. */
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
