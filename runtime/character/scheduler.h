/* scheduler.h: which instances are updated in a frame, within a budget.
 *
 * A frame of a game:
 *   noh_schedule_begin(s, frame_ticks, budget);
 *   noh_schedule_spend(s, cost);                      per instance that cannot wait (NOH_DUE_AT_ONCE), updated at once
 *   noh_schedule_offer(s, i, late, visibility, cost); per instance that is seen and due
 *   while (noh_schedule_next(s, &i)) update i;
 * What is off the screen is not offered: it costs its clock and its events.
 *
 * Served first is the largest (lateness + one frame) * visibility. A frame ends when the budget is spent: it is
 * passed by at most one instance, and at least one is served in every frame. Where the budget suffices for all, all are
 * served in the order in which they were offered, and nothing is sorted.
 *
 * Nobody waits long. Let V be the range of visibilities (1..NOH_VISIBILITY_MAX), N the instances, k the least that
 * a frame serves, D the longest frame, and let an instance wait W ticks. Who was served at W before it had waited
 * (W + D) / V - D at least, since D / V is the least and V times the most that lateness counts for. So in the last
 * (W + D) / V - D ticks nobody was served twice: there were at most (N - 1) / k full frames in them, hence
 *   W < V * D * ((N - 1) / k + 2)
 * which noh_schedule_wait_max gives, in frames. */
#ifndef NOH_CHARACTER_SCHEDULER_H
#define NOH_CHARACTER_SCHEDULER_H

#include "base/limits.h"
#include "base/result.h"

typedef struct noh_schedule_item {
    uint64_t urgency;
    uint32_t instance, cost;
} noh_schedule_item;

/* Counts of the frame that began last, and high-water marks. */
typedef struct noh_schedule {
    uint32_t capacity, count;   /* items that wait in the heap */
    uint32_t frame_ticks;
    uint32_t offered, served;
    uint32_t late_ticks;        /* the worst lateness of all that were offered: of those served now, and of those who wait on */
    uint64_t budget, spent;
    uint64_t offered_cost; /* of all offers of the frame */
    uint32_t late_high_water;   /* the worst since init */
    uint32_t offered_high_water;
    uint32_t lost;              /* offers over the capacity since init: they were not taken, and wait on */
    uint32_t order;             /* private: whether the items are a heap by now, or need not be */
    noh_schedule_item *items;   /* [capacity] */
} noh_schedule;

/* Exact bytes for so many offers in a frame: 16 each; 0 for none or more than NOH_SCHEDULE_MAX. */
size_t noh_schedule_size(uint32_t capacity);

/* errors  ARG memory NULL or not 16-byte aligned, capacity; MEMORY need: the bytes */
noh_result noh_schedule_init(void *memory, size_t bytes, uint32_t capacity, noh_schedule *s, noh_error *error);

/* units  budget and costs in one unit of the caller's (noh_cost_of: nanoseconds); ticks of 1/48,000 s */
void noh_schedule_begin(noh_schedule *s, uint32_t frame_ticks, uint64_t budget);

/* What was, or will be, done in this frame in any case. */
void noh_schedule_spend(noh_schedule *s, uint32_t cost);

/* ranges  visibility of any scale that fits in 1..NOH_VISIBILITY_MAX, clamped to it (NaN is 1): pixels high over 100, say;
 *         each instance at most once in a frame; all offers before the first noh_schedule_next */
void noh_schedule_offer(noh_schedule *s, uint32_t instance, uint32_t late_ticks, float visibility, uint32_t cost);

/* The next to be served; 0 when the budget is spent or all have been. Of equally urgent ones the lower number. */
int noh_schedule_next(noh_schedule *s, uint32_t *instance);

/* How many frames an instance waits at most when up to `instances` are offered, none of which costs more
 * than cost_max, and nothing is spent aside. */
uint64_t noh_schedule_wait_max(uint32_t instances, uint64_t budget, uint32_t cost_max);

/* ---- costs ---- */

/* What things cost on the machine at hand, nanoseconds, as measured by the caller (`noh bench` prints them). */
typedef struct noh_cost_weights {
    float per_instance;
    float per_joint;    /* sampled or blended: joints times tracks */
    float per_pair;     /* of a morph target and a vertex */
    float per_vertex;   /* skinned */
} noh_cost_weights;

/* Nanoseconds, rounded up; at least 1, saturating. */
uint32_t noh_cost_of(const noh_cost_weights *weights, uint32_t joints, uint32_t pairs, uint32_t vertices);

#endif
