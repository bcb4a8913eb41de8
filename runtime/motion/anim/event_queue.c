#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

#define CAPACITY_MAX (1u << 24)

size_t noh_event_queue_size(uint32_t capacity)
{
    return capacity > CAPACITY_MAX ? 0 : capacity * sizeof(noh_event);
}

noh_result noh_event_queue_init(void *memory, size_t bytes, uint32_t capacity, noh_event_queue *queue, noh_error *error)
{
    size_t need = noh_event_queue_size(capacity);
    noh_arena arena;
    noh_result result;
    NOH_ASSERT(queue);
    if (need == 0) return noh_fail(error, NOH_ERR_ARG, "capacity must be 1 to 16777216", capacity, CAPACITY_MAX);
    result = noh_arena_open(&arena, memory, bytes, need, error);
    if (result == NOH_OK) {
        queue->capacity = capacity;
        queue->count = queue->lost = queue->high_water = 0;
        queue->events = (noh_event *)noh_arena_carve(&arena, need, 16);
    }
    return result;
}

void noh_event_queue_push(void *queue, const noh_event *event)
{
    noh_event_queue *q = (noh_event_queue *)queue;
    NOH_ASSERT(q && event && q->count <= q->capacity);
    if (q->count == q->capacity) {
        q->lost++;
        return;
    }
    q->events[q->count++] = *event;
    q->high_water = q->count > q->high_water ? q->count : q->high_water;
}

void noh_event_queue_clear(noh_event_queue *queue)
{
    NOH_ASSERT(queue);
    queue->count = 0;
}
