/* event_queue.h: collects the events of a step to process later, instead of in the callback.
 *
 * A fixed array. With a capacity from noh_controller_events_max or noh_clip_set_events_max it cannot overflow. Pass
 * noh_event_queue_push as the callback and the queue as its user pointer.
 *
 * Threads: a queue belongs to one thread at a time. */
#ifndef NOH_ANIM_EVENT_QUEUE_H
#define NOH_ANIM_EVENT_QUEUE_H

#include "motion/anim/controller.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_event_queue {
    uint32_t capacity, count;
    uint32_t lost; /* events that did not fit; always 0 with a capacity from a bound */
    uint32_t high_water;
    noh_event *events; /* [capacity], oldest first */
} noh_event_queue;

/* Exact size in bytes; 0 if the capacity is 0 or too large. */
size_t noh_event_queue_size(uint32_t capacity);

/* Make a queue in memory[bytes], aligned to NOH_MEMORY_ALIGN.
 * errors  ARG capacity, or memory NULL or misaligned; MEMORY need: the bytes */
noh_result noh_event_queue_init(void *memory, size_t bytes, uint32_t capacity, noh_event_queue *queue,
                                noh_error *error);

/* Append an event; a noh_event_fn. `queue` is a noh_event_queue. */
void noh_event_queue_push(void *queue, const noh_event *event);

/* Remove all events; keeps `lost` and `high_water`. */
void noh_event_queue_clear(noh_event_queue *queue);

#ifdef __cplusplus
}
#endif

#endif
