#include "anim/event_queue.h"

#define CAPACITY_MAX (1u << 24)

size_t noh_event_queue_size(uint32_t capacity)
{
    return capacity > CAPACITY_MAX ? 0 : capacity * sizeof(noh_event);
}

noh_result noh_event_queue_init(void *memory, size_t bytes, uint32_t capacity, noh_event_queue *queue, noh_error *error)
{
    size_t need = noh_event_queue_size(capacity);
    if (need == 0) return noh_fail(error, NOH_ERR_ARG, "capacity", capacity, CAPACITY_MAX);
    if (!memory || ((uintptr_t)memory & 15u) != 0) {
        return noh_fail(error, NOH_ERR_ARG, "memory for an event queue is NULL or not 16-byte aligned", 0, need);
    }
    if (bytes < need) return noh_fail(error, NOH_ERR_MEMORY, "memory for an event queue is too small", bytes, need);
    queue->capacity = capacity;
    queue->count = queue->lost = queue->high_water = 0;
    queue->events = (noh_event *)memory;
    return NOH_OK;
}

void noh_event_queue_push(void *queue, const noh_event *event)
{
    noh_event_queue *q = (noh_event_queue *)queue;
    if (q->count == q->capacity) {
        q->lost++;
        return;
    }
    q->events[q->count++] = *event;
    q->high_water = q->count > q->high_water ? q->count : q->high_water;
}

void noh_event_queue_clear(noh_event_queue *queue)
{
    queue->count = 0;
}
