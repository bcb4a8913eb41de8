/* events.h: which callback keys a stretch of play passes, each exactly once.
 *
 * Definition. On the unwrapped position a key of tick t occurs at these ticks:
 *   ONCE       t
 *   REPEAT     k * duration + t for every whole k
 *   PING_PONG  k * 2 * duration + t and k * 2 * duration - t (one occurrence where both agree)
 * Play from position a to position b passes the occurrences in
 *   (a, b] forwards,  [b, a) backwards:
 * the end is passed; the start is not, because it was passed on arrival. So stretches join: a..b and b..c in one
 * direction pass what a..c passes. Where play was placed (started, sought) it has not arrived, so its first move also
 * passes the keys exactly there. On the seam of a repeating clip those are the keys of the pass that play enters:
 * forwards the keys at tick 0, backwards the keys at tick `duration`. Order: in the direction of play; at one tick by
 * index; at the seam pass after pass.
 *
 * source  callback keys as in Granberg 2009, chapter 5, which gives their times in seconds where the API wants ticks,
 *         and loses keys in compressed clips and at the seam of a loop
 *
 * Threads: pure functions; any thread. */
#ifndef NOH_ANIM_EVENTS_H
#define NOH_ANIM_EVENTS_H

#include "motion/anim/clip_set.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A stretch of play in one direction. */
typedef struct noh_passage {
    int64_t from, to; /* positions */
    uint32_t duration_ticks;
    uint8_t loop; /* noh_loop; for ONCE from and to lie in the clip */
    uint8_t backward;
    uint8_t placed; /* 1: play was placed at `from` and has not moved since */
} noh_passage;

/* Called for each occurrence: the index of the key, and the tick of the unwrapped position. */
typedef void (*noh_key_fn)(void *user, uint32_t index, int64_t position_tick);

/* The first occurrence of a passage.
 * shapes   keys[count] in tick order
 * returns  1 and its tick, or 0 when there is none */
int noh_events_first(const noh_event_key *keys, uint32_t count, const noh_passage *passage, int64_t *position_tick);

/* Call fn for the occurrences of a passage, in order, at most `limit` of them.
 * returns  how many; if that is `limit` there may be more */
uint32_t noh_events_pass(const noh_event_key *keys, uint32_t count, const noh_passage *passage, uint32_t limit,
                         noh_key_fn fn, void *user);

/* The most occurrences that a given travel can pass; saturates at UINT32_MAX.
 * units   travel: the sum of all movement, 1/65,536 ticks; runs: into how many stretches of one direction it falls, at
 *         least 1 */
uint32_t noh_events_max(uint32_t key_count, uint32_t duration_ticks, noh_loop loop, uint64_t travel, uint32_t runs);

/* The most that one step can deliver with every track on the worst clip of a set: known before anything plays, for
 * budgets and queues. One change of direction within the step is allowed for. Saturates at NOH_STEP_EVENTS_MAX.
 * ranges  |speed| of every track at most speed_max (1/65,536), a step at most step_ticks_max */
uint32_t noh_clip_set_events_max(const noh_clip_set *set, uint32_t track_count, uint32_t speed_max,
                                 uint32_t step_ticks_max);

#ifdef __cplusplus
}
#endif

#endif
