/* lod_queue.c: a binary heap. */
#include "lod_queue.h"

#include <stdlib.h>

int lod_queue_make(lod_queue *q, uint32_t capacity)
{
    q->count = 0;
    q->heap = calloc((size_t)capacity + 1u, sizeof *q->heap);
    q->cost = calloc((size_t)capacity + 1u, sizeof *q->cost);
    q->place = calloc((size_t)capacity + 1u, sizeof *q->place);
    return !q->heap || !q->cost || !q->place;
}

void lod_queue_free(lod_queue *q)
{
    free(q->heap);
    free(q->cost);
    free(q->place);
}

static int before(const lod_queue *q, uint32_t a, uint32_t b)
{
    return q->cost[a] < q->cost[b] || (q->cost[a] == q->cost[b] && a < b);
}

static void set(lod_queue *q, uint32_t i, uint32_t point)
{
    q->heap[i] = point;
    q->place[point] = i;
}

/* Find a point's place, from a free one towards the root or away from it. */
static void settle(lod_queue *q, uint32_t i, uint32_t point)
{
    while (i > 0 && before(q, point, q->heap[(i - 1u) / 2u])) {
        set(q, i, q->heap[(i - 1u) / 2u]);
        i = (i - 1u) / 2u;
    }
    for (uint32_t child = 2u * i + 1u; child < q->count; child = 2u * i + 1u) {
        if (child + 1u < q->count && before(q, q->heap[child + 1u], q->heap[child])) {
            child++;
        }
        if (!before(q, q->heap[child], point)) {
            break;
        }
        set(q, i, q->heap[child]);
        i = child;
    }
    set(q, i, point);
}

void lod_queue_put(lod_queue *q, uint32_t point, float cost)
{
    q->cost[point] = cost;
    settle(q, q->count++, point);
}

int lod_queue_first(const lod_queue *q, uint32_t *point)
{
    if (q->count) {
        *point = q->heap[0];
    }
    return q->count > 0;
}

void lod_queue_drop(lod_queue *q, uint32_t point)
{
    uint32_t i = q->place[point], last = q->heap[--q->count];
    if (last != point) {
        settle(q, i, last);
    }
}

void lod_queue_take(lod_queue *q)
{
    lod_queue_drop(q, q->heap[0]);
}
