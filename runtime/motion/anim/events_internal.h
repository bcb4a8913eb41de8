/* events_internal.h: finds the callback keys that a stretch of play passes, each exactly once.
 *
 * On the unwrapped position, a key at tick t occurs at:
 *   ONCE       t
 *   REPEAT     k * duration + t for every whole k
 *   PING_PONG  k * 2 * duration + t and k * 2 * duration - t (one occurrence where both are equal)
 * Play from position a to position b passes the occurrences in
 *   (a, b] forwards,  [b, a) backwards.
 * The end is included; the start is not, because it was passed on arrival. So stretches join: a..b and b..c in one
 * direction pass the same keys as a..c. After a start or a seek play has not arrived, so the first move also passes the
 * keys exactly at that position. At the seam of a repeating clip these are the keys of the pass that play enters:
 * forwards the keys at tick 0, backwards the keys at tick `duration`. Order: in the direction of play; at one tick by
 * index; at the seam pass by pass.
 *
 * source  callback keys as in Granberg 2009, chapter 5, which gives times in seconds where the API expects ticks, and
 *         loses keys in compressed clips and at the seam of a loop
 *
 * Threads: pure functions; any thread. */
#ifndef NOH_ANIM_EVENTS_INTERNAL_H
#define NOH_ANIM_EVENTS_INTERNAL_H

#include "noh/clip.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_passage {
    int64_t from, to; /* positions */
    uint32_t duration_ticks;
    uint8_t loop; /* noh_loop; for ONCE both from and to lie in the clip */
    uint8_t backward;
    uint8_t placed; /* 1: play was started or moved to `from` and has not advanced since */
} noh_passage;

/* Called for each occurrence with the index of its key and its unwrapped position in ticks. */
typedef void (*noh_key_fn)(void *user, uint32_t index, int64_t position_tick);

/* Find the first occurrence in a passage.
 * shapes   keys[count] in tick order
 * returns  1 and its tick, or 0 if there is none */
int noh_events_first(const noh_event_key *keys, uint32_t count, const noh_passage *passage, int64_t *position_tick);

/* Call fn for each occurrence in a passage, in order, at most `limit` times.
 * returns  the number of calls; if it equals `limit` there may be more */
uint32_t noh_events_pass(const noh_event_key *keys, uint32_t count, const noh_passage *passage, uint32_t limit,
                         noh_key_fn fn, void *user);

#ifdef __cplusplus
}
#endif

#endif
