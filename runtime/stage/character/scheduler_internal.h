/* scheduler_internal.h: choose the instances to update in a frame, within a time budget.
 *
 * A frame of a game:
 *   noh_schedule_begin(s, frame_ticks, budget);
 *   noh_schedule_spend(s, cost);                      for instances that cannot wait (NOH_DUE_AT_ONCE): update them
 *   noh_schedule_offer(s, i, late, visibility, cost); for each due instance in view
 *   while (noh_schedule_next(s, &i)) update i;
 * An instance out of view is not offered; it only costs its step.
 *
 * The largest (lateness + one frame) * visibility is served first. A frame ends when the budget is spent; it is
 * exceeded by at most one instance, and every frame serves at least one. If the budget suffices for all, they are
 * served in the order of the offers, without sorting.
 *
 * The wait is bounded. Let V be NOH_VISIBILITY_MAX, N the number of instances, k the fewest that a frame serves, and D
 * the longest frame. Suppose an instance has waited W ticks. Any instance served before it has waited at least
 * (W + D) / V - D, because visibility scales lateness by at most V. So within the last (W + D) / V - D ticks no
 * instance was served twice, and these ticks contain at most (N - 1) / k full frames. So
 *   W < V * D * ((N - 1) / k + 2)
 * which noh_schedule_wait_max returns in frames.
 *
 * Threads: a schedule belongs to one thread at a time. */
#ifndef NOH_CHARACTER_SCHEDULER_INTERNAL_H
#define NOH_CHARACTER_SCHEDULER_INTERNAL_H

#include "noh/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_schedule_item {
    uint64_t urgency;
    uint32_t instance, cost;
} noh_schedule_item;

/* A schedule, with counts of the current frame and high-water marks. */
typedef struct noh_schedule {
    uint32_t capacity, count; /* items waiting in the heap */
    uint32_t frame_ticks;
    uint32_t offered, served;
    uint32_t late_ticks; /* largest lateness offered, served or not */
    uint64_t budget, spent;
    uint64_t offered_cost;    /* of all offers of the frame */
    uint32_t late_high_water; /* largest since init */
    uint32_t offered_high_water;
    uint32_t lost;            /* offers ignored since init because of the capacity */
    uint32_t order;           /* private: state of the offers: unsorted, a heap, or served in order */
    noh_schedule_item *items; /* [capacity] */
} noh_schedule;

/* Exact bytes for `capacity` offers per frame: 16 each; 0 for a capacity of 0 or above NOH_SCHEDULE_MAX. */
size_t noh_schedule_size(uint32_t capacity);

/* Build a schedule in memory[bytes].
 * errors  ARG capacity, or memory is NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY too small (need: the exact
 *         bytes) */
noh_result noh_schedule_init(void *memory, size_t bytes, uint32_t capacity, noh_schedule *s, noh_error *error);

/* Begin a frame.
 * units   frame_ticks: length of the frame; budget and costs in the same unit (noh_cost_ns: nanoseconds) */
void noh_schedule_begin(noh_schedule *s, uint32_t frame_ticks, uint64_t budget);

/* Charge the budget for work that the frame does in any case. */
void noh_schedule_spend(noh_schedule *s, uint32_t cost);

/* Offer an instance that is due.
 * units   late_ticks since its update was due (noh_time_lod_late); cost as the budget
 * ranges  visibility 1..NOH_VISIBILITY_MAX on your own scale (such as height in pixels / 100), clamped; NaN is 1. Each
 *         instance at most once per frame; all offers before the first noh_schedule_next */
void noh_schedule_offer(noh_schedule *s, uint32_t instance, uint32_t late_ticks, float visibility, uint32_t cost);

/* Get the next instance to update; returns 0 when the budget is spent or none is left. With equal urgency the lower
 * number comes first. */
int noh_schedule_next(noh_schedule *s, uint32_t *instance);

/* The most frames that an instance waits if up to `instances` are offered, none costs more than cost_max, and nothing
 * is charged by noh_schedule_spend. */
uint64_t noh_schedule_wait_max(uint32_t instances, uint64_t budget, uint32_t cost_max);

/* ---- costs ---- */

/* Measured costs of a machine in nanoseconds (`noh bench` prints them). */
typedef struct noh_cost_weights {
    float per_instance;
    float per_joint;  /* sampled or blended: joints times tracks */
    float per_pair;   /* of a morph target and a vertex */
    float per_vertex; /* skinned */
} noh_cost_weights;

/* The cost of an update in nanoseconds, rounded up; at least 1, saturating. */
uint32_t noh_cost_ns(const noh_cost_weights *weights, uint32_t joints, uint32_t pairs, uint32_t vertices);

#ifdef __cplusplus
}
#endif

#endif
