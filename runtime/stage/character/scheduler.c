#include "core/base/assert_internal.h"
#include "stage/character/scheduler_internal.h"
#include "noh/base.h"
#include "noh/low_core.h"

#include <string.h>

/* ---- memory ---- */

size_t noh_schedule_size(uint32_t capacity)
{
    return capacity > NOH_SCHEDULE_MAX ? 0 : capacity * sizeof(noh_schedule_item);
}

noh_result noh_schedule_init(void *memory, size_t bytes, uint32_t capacity, noh_schedule *s, noh_error *error)
{
    size_t need = noh_schedule_size(capacity);
    noh_arena arena;
    noh_result result;
    NOH_ASSERT(s);
    if (need == 0) {
        return noh_fail(error, NOH_ERR_ARG, "capacity must be 1 to NOH_SCHEDULE_MAX", capacity, NOH_SCHEDULE_MAX);
    }
    result = noh_arena_open(&arena, memory, bytes, need, error);
    if (result == NOH_OK) {
        memset(s, 0, sizeof *s);
        s->capacity = capacity;
        s->items = (noh_schedule_item *)noh_arena_carve(&arena, need, 16);
    }
    return result;
}

/* ---- a frame ---- */

/* noh_schedule.order */
enum { AS_OFFERED = 0, ALL_SERVED, HEAP };

void noh_schedule_begin(noh_schedule *s, uint32_t frame_ticks, uint64_t budget)
{
    NOH_ASSERT(s);
    s->count = s->offered = s->served = s->late_ticks = 0;
    s->frame_ticks = frame_ticks;
    s->budget = budget;
    s->spent = s->offered_cost = 0;
    s->order = AS_OFFERED;
}

void noh_schedule_spend(noh_schedule *s, uint32_t cost)
{
    NOH_ASSERT(s);
    s->spent += cost;
}

/* If the budget is too small for all offers, they are put in a binary heap with the most urgent on top. Building the
 * heap is linear in the offers and taking one is logarithmic, so a frame that serves few of many offers does not pay
 * for sorting all. If the budget suffices, the order does not matter and no heap is built. (J. W. J. Williams,
 * "Algorithm 232: Heapsort", and R. W. Floyd, "Algorithm 245: Treesort 3", Communications of the ACM 7, 1964) */
static int before(const noh_schedule_item *a, const noh_schedule_item *b)
{
    return a->urgency != b->urgency ? a->urgency > b->urgency : a->instance < b->instance;
}

/* Sift an item down: the more urgent child moves up until neither is more urgent. */
static void sift(noh_schedule_item *items, uint32_t at, uint32_t count)
{
    noh_schedule_item item = items[at];
    uint32_t child = 2u * at + 1u;
    while (child < count) {
        child += child + 1u < count && before(&items[child + 1u], &items[child]);
        if (!before(&items[child], &item)) {
            break;
        }
        items[at] = items[child];
        at = child;
        child = 2u * at + 1u;
    }
    items[at] = item;
}

#if NOH_ASSERT_LEVEL >= 2
static int is_heap(const noh_schedule_item *items, uint32_t count)
{
    int ordered = 1;
    for (uint32_t i = 1; i < count; i++) {
        ordered = ordered && !before(&items[i], &items[(i - 1u) / 2u]);
    }
    return ordered;
}
#endif

/* Fixed point with 8 fractional bits: urgencies are then whole numbers, equal on every machine. */
static uint32_t visibility_steps(float visibility)
{
    float clamped = visibility > 1.0f ? visibility < NOH_VISIBILITY_MAX ? visibility : NOH_VISIBILITY_MAX : 1.0f;
    return (uint32_t)(clamped * 256.0f);
}

void noh_schedule_offer(noh_schedule *s, uint32_t instance, uint32_t late_ticks, float visibility, uint32_t cost)
{
    NOH_ASSERT(s && s->order == AS_OFFERED);
    noh_schedule_item *item = &s->items[s->count];
    s->late_ticks = late_ticks > s->late_ticks ? late_ticks : s->late_ticks;
    s->late_high_water = late_ticks > s->late_high_water ? late_ticks : s->late_high_water;
    if (s->count == s->capacity) {
        s->lost++;
        return;
    }
    s->offered++;
    s->offered_high_water = s->offered > s->offered_high_water ? s->offered : s->offered_high_water;
    /* One frame is added to the lateness, so that visibility also counts among offers due in this frame. */
    item->urgency = ((uint64_t)late_ticks + s->frame_ticks + 1u) * visibility_steps(visibility);
    item->instance = instance;
    item->cost = cost;
    s->offered_cost += cost;
    s->count++;
}

/* Before the first offer is served: if not all offers fit into the budget, build the heap, subtree by subtree from
 * below. */
static void put_in_order(noh_schedule *s)
{
    s->order = s->spent + s->offered_cost <= s->budget ? ALL_SERVED : HEAP;
    for (uint32_t i = s->order == HEAP ? s->count / 2u : 0; i-- > 0;) {
        sift(s->items, i, s->count);
    }
}

int noh_schedule_next(noh_schedule *s, uint32_t *instance)
{
    const noh_schedule_item *next;
    NOH_ASSERT(s && instance);
    if (s->order == AS_OFFERED) {
        put_in_order(s);
    }
    if (s->count == 0 || (s->order == HEAP && s->spent >= s->budget && s->served > 0)) {
        return 0;
    }
    next = s->order == HEAP ? &s->items[0] : &s->items[s->served];
    *instance = next->instance;
    s->spent += next->cost;
    s->served++;
    s->count--;
    if (s->order == HEAP) {
        s->items[0] = s->items[s->count];
        sift(s->items, 0, s->count);
    }
    NOH_VALIDATE(s->order != HEAP || is_heap(s->items, s->count));
    return 1;
}

/* The bound that scheduler_internal.h derives, in frames: W / D. A frame serves until its budget is spent, so at least
 * budget / cost_max, rounded up, and never fewer than one. */
uint64_t noh_schedule_wait_max(uint32_t instances, uint64_t budget, uint32_t cost_max)
{
    uint64_t served = cost_max ? (budget + cost_max - 1u) / cost_max : instances;
    uint64_t others = instances ? instances - 1u : 0;
    served = served ? served : 1u;
    return (uint64_t)NOH_VISIBILITY_MAX * ((others + served - 1u) / served + 2u);
}

/* ---- costs ---- */

uint32_t noh_cost_ns(const noh_cost_weights *w, uint32_t joints, uint32_t pairs, uint32_t vertices)
{
    NOH_ASSERT(w);
    double cost = (double)w->per_instance + (double)w->per_joint * joints + (double)w->per_pair * pairs +
                  (double)w->per_vertex * vertices;
    if (!(cost > 1.0)) {
        return 1;
    }
    return cost >= 4294967295.0 ? UINT32_MAX : (uint32_t)(cost + 0.999999);
}
