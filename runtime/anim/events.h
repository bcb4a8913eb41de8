/* events.h: which callback keys a stretch of play passes, each exactly once.
 *
 * Definition. Unwrapped, a key of tick t happens at these ticks of the position:
 *   ONCE       t
 *   REPEAT     k * duration + t for every whole k
 *   PING_PONG  k * 2 * duration + t and k * 2 * duration - t (one happening where both agree)
 * Play from position a to position b passes the happenings in
 *   (a, b] forwards,  [b, a) backwards:
 * what is arrived at is passed, what is left is not, for it was passed on arrival.
 * Stretches therefore join: a..b and b..c in one direction pass what a..c passes.
 * Where play was placed (started, sought) it has not arrived: the first movement
 * from there also passes what happens exactly there. At the seam of a repeating
 * motion those are the keys of the pass that play goes into: forwards from the
 * seam the keys at tick 0, backwards the keys at tick `duration`.
 * Order: along the play; at one tick by index; at the seam pass after pass. */
#ifndef NOH_ANIM_EVENTS_H
#define NOH_ANIM_EVENTS_H

#include "anim/motion.h"

/* A stretch of play in one direction. */
typedef struct noh_passage {
    int64_t from, to;        /* positions */
    uint32_t duration_ticks;
    uint8_t loop;            /* noh_loop; for ONCE from and to lie in the clip */
    uint8_t backward;
    uint8_t placed;          /* play was placed at `from` and has not moved since */
} noh_passage;

/* What is passed: the index of the key and the tick of the position at which it happens. */
typedef void (*noh_key_fn)(void *user, uint32_t index, int64_t position_tick);

/* The first happening of a passage: 1 and its tick, or 0.
 * shapes  keys[count] in tick order */
int noh_events_first(const noh_event_key *keys, uint32_t count, const noh_passage *passage, int64_t *position_tick);

/* Hand the happenings of a passage to fn, in order, the first `limit` of them.
 * returns  how many; `limit` may mean that there are more */
uint32_t noh_events_pass(const noh_event_key *keys, uint32_t count, const noh_passage *passage, uint32_t limit, noh_key_fn fn, void *user);

/* The most happenings that play can pass in a given travel.
 * shapes  travel: the sum of all movements, in 1/65,536 ticks; runs: how many
 *         stretches of one direction they make, at least 1
 * ranges  saturates at UINT32_MAX */
uint32_t noh_events_max(uint32_t key_count, uint32_t duration_ticks, noh_loop loop, uint64_t travel, uint32_t runs);

/* The most that one step can deliver with every track on the worst motion of a
 * set: known before anything is played, for budgets and queues. One turn of the
 * direction within the step is counted in.
 * ranges  |speed| <= speed_max (1/65,536), step <= step_ticks_max; saturates at NOH_STEP_EVENTS_MAX */
uint32_t noh_anim_set_events_max(const noh_anim_set *set, uint32_t track_count, uint32_t speed_max, uint32_t step_ticks_max);

#endif
