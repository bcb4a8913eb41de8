#include "core/base/assert_internal.h"
#include "stage/character/lod_pools_internal.h"
#include "noh/base.h"
#include "noh/low_core.h"

#include <string.h>

#define NOT_ASKED 0xffu /* in place.next: did not ask, */
#define LEFT_OUT 0xfeu  /* is beyond shown_max, */
#define RESTS 0xfdu     /* or found no slot */
#define STAYS 1.25f     /* factor on the priority of an instance that keeps its slot */

typedef struct pool {
    uint32_t level, slot_count;
    uint32_t first;      /* start of the pool's part of `free` */
    uint32_t free_count; /* stack of free slots: free[first .. first + free_count - 1] */
} pool;

/* One instance. */
typedef struct place {
    uint32_t slot;
    uint8_t held;  /* 1: holds a slot */
    uint8_t pool;  /* of the held slot */
    uint8_t level; /* requested */
    uint8_t next;  /* the pool assigned in this frame, or one of the above */
} place;

struct noh_lod_pools {
    uint32_t instance_count, shown_max, pool_count;
    pool pools[NOH_LOD_POOLS_MAX];
    noh_lod_pools_stats stats;
    /* byte offsets from this struct, so that the block can be copied */
    uint32_t keys_offset;   /* uint64_t[instance_count] requests; see key_of */
    uint32_t places_offset; /* place[instance_count] */
    uint32_t free_offset;   /* uint32_t[slots] */
    uint32_t bytes;
};

NOH_STATIC_ASSERT(sizeof(place) == 8, place);

/* ---- memory ---- */

static const char *bad_field(const noh_lod_pools_desc *d, uint32_t *slots)
{
    uint64_t sum = 0;
    if (d->instance_count == 0 || d->instance_count > NOH_LOD_POOL_SLOTS_MAX)
        return "LOD pools: instance_count must be 1 to NOH_LOD_POOL_SLOTS_MAX";
    if (d->pool_count == 0 || d->pool_count > NOH_LOD_POOLS_MAX)
        return "LOD pools: pool_count must be 1 to NOH_LOD_POOLS_MAX";
    if (!d->levels) return "LOD pools: levels is NULL";
    if (!d->slot_counts) return "LOD pools: slot_counts is NULL";
    for (uint32_t i = 0; i < d->pool_count; i++) {
        if (d->levels[i] >= NOH_LOD_LEVELS_MAX || (i && d->levels[i] <= d->levels[i - 1u]))
            return "LOD pools: levels must increase and be below NOH_LOD_LEVELS_MAX";
        if (d->slot_counts[i] == 0) return "LOD pools: each of slot_counts must be at least 1";
        sum += d->slot_counts[i];
    }
    if (sum > NOH_LOD_POOL_SLOTS_MAX) return "LOD pools: the sum of slot_counts is above NOH_LOD_POOL_SLOTS_MAX";
    *slots = (uint32_t)sum;
    return NULL;
}

static uint64_t *keys_of(const noh_lod_pools *p)
{
    return (uint64_t *)(void *)((uint8_t *)(uintptr_t)p + p->keys_offset);
}

static place *place_of(const noh_lod_pools *p, uint32_t instance)
{
    return (place *)(void *)((uint8_t *)(uintptr_t)p + p->places_offset) + instance;
}

static uint32_t *free_of(const noh_lod_pools *p)
{
    return (uint32_t *)(void *)((uint8_t *)(uintptr_t)p + p->free_offset);
}

/* The size of the block and the offsets of its arrays. */
static noh_lod_pools layout_of(uint32_t instances, uint32_t slots)
{
    noh_arena arena = noh_arena_measure();
    noh_lod_pools p;
    memset(&p, 0, sizeof p);
    (void)noh_arena_carve(&arena, sizeof p, 16);
    p.keys_offset = (uint32_t)arena.used;
    (void)noh_arena_carve(&arena, instances * sizeof(uint64_t), 8);
    p.places_offset = (uint32_t)arena.used;
    (void)noh_arena_carve(&arena, instances * sizeof(place), 4);
    p.free_offset = (uint32_t)arena.used;
    (void)noh_arena_carve(&arena, slots * sizeof(uint32_t), 4);
    p.bytes = (uint32_t)arena.used;
    return p;
}

size_t noh_lod_pools_size(const noh_lod_pools_desc *desc)
{
    uint32_t slots;
    NOH_ASSERT(desc);
    return bad_field(desc, &slots) ? 0 : layout_of(desc->instance_count, slots).bytes;
}

static void fill_pools(noh_lod_pools *p, const noh_lod_pools_desc *d)
{
    uint32_t first = 0;
    for (uint32_t i = 0; i < d->pool_count; i++) {
        pool *to = &p->pools[i];
        to->level = d->levels[i];
        to->slot_count = to->free_count = d->slot_counts[i];
        to->first = first;
        for (uint32_t k = 0; k < to->slot_count; k++) {
            free_of(p)[first + k] = to->slot_count - 1u - k; /* slot 0 is last, so it is taken first */
        }
        first += to->slot_count;
    }
}

noh_result noh_lod_pools_init(void *memory, size_t bytes, const noh_lod_pools_desc *desc, noh_lod_pools **pools,
                              noh_error *error)
{
    NOH_ASSERT(desc && pools);
    noh_arena arena;
    noh_result result;
    noh_lod_pools *p;
    uint32_t slots = 0;
    const char *what = bad_field(desc, &slots);
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, 0, 0);
    }
    result = noh_arena_open(&arena, memory, bytes, noh_lod_pools_size(desc), error);
    if (result != NOH_OK) {
        return result;
    }
    p = (noh_lod_pools *)memory;
    memset(p, 0, noh_lod_pools_size(desc));
    *p = layout_of(desc->instance_count, slots);
    p->instance_count = desc->instance_count;
    p->shown_max = desc->shown_max ? desc->shown_max : desc->instance_count;
    p->pool_count = desc->pool_count;
    fill_pools(p, desc);
    noh_lod_pools_begin(p);
    *pools = p;
    return NOH_OK;
}

/* ---- checking ---- */

static int same_desc(const noh_lod_pools *a, const noh_lod_pools *b)
{
    int same = a->instance_count == b->instance_count && a->shown_max == b->shown_max &&
               a->pool_count == b->pool_count && a->bytes == b->bytes && a->keys_offset == b->keys_offset &&
               a->places_offset == b->places_offset && a->free_offset == b->free_offset;
    for (uint32_t i = 0; i < b->pool_count && same; i++) {
        same = a->pools[i].level == b->pools[i].level && a->pools[i].slot_count == b->pools[i].slot_count &&
               a->pools[i].first == b->pools[i].first;
    }
    return same;
}

/* All slots are in range, and the numbers of held and free slots add up. A slot held twice is not detected: it only
 * shows one actor's face on two actors. */
static int are_slots_sound(const noh_lod_pools *p)
{
    uint32_t held[NOH_LOD_POOLS_MAX] = { 0 };
    for (uint32_t i = 0; i < p->instance_count; i++) {
        const place *at = place_of(p, i);
        if (at->held > 1u || (at->held && (at->pool >= p->pool_count || at->slot >= p->pools[at->pool].slot_count)))
            return 0;
        if (at->held) held[at->pool]++;
    }
    for (uint32_t i = 0; i < p->pool_count; i++) {
        if (p->pools[i].free_count > p->pools[i].slot_count ||
            held[i] + p->pools[i].free_count != p->pools[i].slot_count)
            return 0;
        for (uint32_t k = 0; k < p->pools[i].free_count; k++) {
            if (free_of(p)[p->pools[i].first + k] >= p->pools[i].slot_count) return 0;
        }
    }
    return 1;
}

noh_result noh_lod_pools_check(const void *copy, const noh_lod_pools *like, noh_error *error)
{
    const noh_lod_pools *p = (const noh_lod_pools *)copy;
    NOH_ASSERT(copy && like);
    if (!same_desc(p, like)) {
        return noh_fail(error, NOH_ERR_DATA, "LOD pools: the copy was made with a different desc", 0, 0);
    }
    return are_slots_sound(p) ? NOH_OK
                              : noh_fail(error, NOH_ERR_DATA, "LOD pools: a slot is out of range, or missing", 0, 0);
}

/* ---- asking ---- */

void noh_lod_pools_begin(noh_lod_pools *p)
{
    NOH_ASSERT(p);
    for (uint32_t i = 0; i < p->instance_count; i++) {
        place_of(p, i)->next = NOT_ASKED;
    }
    p->stats.asked = p->stats.coarser = p->stats.moved = 0;
    p->stats.resting = p->stats.waiting = p->stats.left_out = 0;
}

#define INSTANCE_BITS 16u
#define DISTANCE_BITS 17u
#define INSTANCE_LAST ((1u << INSTANCE_BITS) - 1u)

NOH_STATIC_ASSERT(NOH_LOD_POOL_SLOTS_MAX == INSTANCE_LAST + 1u, pool_key);

/* Floats that are not negative have the order of their bits. */
static uint32_t bits_of(float value)
{
    union {
        float value;
        uint32_t bits;
    } u;
    u.value = value > 0.0f ? value : 0.0f;
    return u.bits;
}

/* A sort key of a request: the 31 bits of the priority, then the complement of the distance's highest bits, then the
 * complement of the instance; with equal priorities the nearer one comes first, with equal distances the lower
 * instance. */
static uint64_t key_of(float priority, float distance, uint32_t instance)
{
    const uint64_t near = (1u << DISTANCE_BITS) - 1u - (bits_of(distance) >> (31u - DISTANCE_BITS));
    return (uint64_t)bits_of(priority) << (DISTANCE_BITS + INSTANCE_BITS) | near << INSTANCE_BITS |
           (INSTANCE_LAST - instance);
}

static uint32_t instance_of(uint64_t key)
{
    return INSTANCE_LAST - ((uint32_t)key & INSTANCE_LAST);
}

void noh_lod_pools_ask_at(noh_lod_pools *p, uint32_t instance, uint32_t level, float priority, float distance,
                          int afresh)
{
    place *at = place_of(p, instance);
    int stays;
    NOH_ASSERT(instance < p->instance_count && at->next == NOT_ASKED);
    at->level = (uint8_t)(level < NOH_LOD_LEVELS_MAX ? level : NOH_LOD_LEVELS_MAX - 1u);
    at->next = 0;
    stays = !afresh && at->held && p->pools[at->pool].level <= at->level;
    keys_of(p)[p->stats.asked++] = key_of(stays ? priority * STAYS : priority, distance, instance);
}

/* ---- sharing ---- */

#if NOH_ASSERT_LEVEL >= 2
/* Every slot is free or held: the counts of each pool agree. */
static int is_consistent(const noh_lod_pools *p)
{
    uint32_t held[NOH_LOD_POOLS_MAX] = { 0 };
    for (uint32_t i = 0; i < p->instance_count; i++) {
        const place *at = place_of(p, i);
        if (at->held && (at->pool >= p->pool_count || at->slot >= p->pools[at->pool].slot_count)) {
            return 0;
        }
        held[at->pool] += at->held;
    }
    for (uint32_t i = 0; i < p->pool_count; i++) {
        if (held[i] + p->pools[i].free_count != p->pools[i].slot_count) {
            return 0;
        }
    }
    return 1;
}
#endif

/* Sift a key down in a heap whose top is the lowest key. */
static void sift(uint64_t *keys, uint32_t at, uint32_t count)
{
    uint64_t key = keys[at];
    uint32_t child;
    while ((child = 2u * at + 1u) < count) {
        child += child + 1u < count && keys[child + 1u] < keys[child];
        if (key <= keys[child]) {
            break;
        }
        keys[at] = keys[child];
        at = child;
    }
    keys[at] = key;
}

/* Heap sort, the highest first: the top of the heap, its lowest key, moves to the end again and again. In place, and
 * never worse than n log n. */
static void sort_keys(uint64_t *keys, uint32_t count)
{
    for (uint32_t i = count / 2u; i-- > 0;) {
        sift(keys, i, count);
    }
    for (uint32_t end = count; end-- > 1u;) {
        uint64_t lowest = keys[0];
        keys[0] = keys[end];
        keys[end] = lowest;
        sift(keys, 0, end);
    }
}

/* The number of pools that hold a level: the first ones, whose level is the same or finer. */
static uint32_t count_fitting(const noh_lod_pools *p, uint32_t level)
{
    uint32_t fit = 0;
    while (fit < p->pool_count && p->pools[fit].level <= level) {
        fit++;
    }
    return fit;
}

/* Whether every request fits into the coarsest pool that holds its level: then the order does not matter. */
static int all_fit(const noh_lod_pools *p)
{
    uint32_t by_level[NOH_LOD_LEVELS_MAX] = { 0 }, by_pool[NOH_LOD_POOLS_MAX] = { 0 };
    if (p->stats.asked > p->shown_max) {
        return 0;
    }
    for (uint32_t i = 0; i < p->stats.asked; i++) {
        by_level[place_of(p, instance_of(keys_of(p)[i]))->level]++;
    }
    for (uint32_t level = 0; level < NOH_LOD_LEVELS_MAX; level++) {
        const uint32_t fit = count_fitting(p, level);
        if (by_level[level] && (fit == 0 || (by_pool[fit - 1u] += by_level[level]) > p->pools[fit - 1u].slot_count)) {
            return 0;
        }
    }
    return 1;
}

/* The coarsest pool that holds the level and has room, else the next coarser pool with room; RESTS if there is none. */
static uint32_t choose_pool(const noh_lod_pools *p, uint32_t level)
{
    const uint32_t *used = p->stats.used, fit = count_fitting(p, level);
    uint32_t i;
    for (i = fit; i-- > 0;) {
        if (used[i] < p->pools[i].slot_count) {
            return i;
        }
    }
    for (i = fit; i < p->pool_count; i++) {
        if (used[i] < p->pools[i].slot_count) {
            return i;
        }
    }
    return RESTS;
}

static int has_pool(const place *at)
{
    return at->next < NOH_LOD_POOLS_MAX;
}

/* Sharing has three passes, so that a slot released by one instance can go to another in the same frame. The first only
 * counts: each request, in order of priority, is assigned a pool. The second frees the slots of instances that did not
 * ask or are assigned another pool. The third takes slots for instances without one; the counts guarantee that there
 * are enough. */
static void choose_pools(noh_lod_pools *p)
{
    memset(p->stats.used, 0, sizeof p->stats.used);
    for (uint32_t i = 0; i < p->stats.asked; i++) {
        place *at = place_of(p, instance_of(keys_of(p)[i]));
        at->next = (uint8_t)(i < p->shown_max ? choose_pool(p, at->level) : LEFT_OUT);
        p->stats.left_out += at->next == LEFT_OUT;
        p->stats.resting += at->next == RESTS;
        if (has_pool(at)) {
            p->stats.used[at->next]++;
            p->stats.coarser += p->pools[at->next].level > at->level;
        }
    }
}

static void give_up(noh_lod_pools *p, place *at)
{
    pool *from = &p->pools[at->pool];
    free_of(p)[from->first + from->free_count++] = at->slot;
    at->held = 0;
}

static void take_from(noh_lod_pools *p, place *at, uint32_t which)
{
    pool *to = &p->pools[which];
    at->slot = free_of(p)[to->first + --to->free_count];
    at->pool = (uint8_t)which;
    at->held = 1;
    p->stats.moved++;
}

/* stays 1: free only the slots of instances without an assigned pool. */
static void release(noh_lod_pools *p, int stays)
{
    for (uint32_t i = 0; i < p->instance_count; i++) {
        place *at = place_of(p, i);
        if (at->held && at->next != at->pool && !(stays && has_pool(at))) {
            give_up(p, at);
        }
    }
}

static void take(noh_lod_pools *p)
{
    for (uint32_t i = 0; i < p->stats.asked; i++) {
        place *at = place_of(p, instance_of(keys_of(p)[i]));
        if (!at->held && has_pool(at)) {
            take_from(p, at, at->next);
        }
    }
}

/* ---- a bound on moves ---- */

static int is_due(const place *at)
{
    return has_pool(at) && !(at->held && at->pool == at->next);
}

static uint32_t count_due(const noh_lod_pools *p)
{
    uint32_t due = 0;
    for (uint32_t i = 0; i < p->stats.asked; i++) {
        due += (uint32_t)is_due(place_of(p, instance_of(keys_of(p)[i])));
    }
    return due;
}

/* The due instance of highest priority; without_slot 1: among those without a slot. NULL: none. */
static place *first_due(const noh_lod_pools *p, int without_slot)
{
    for (uint32_t i = 0; i < p->stats.asked; i++) {
        place *at = place_of(p, instance_of(keys_of(p)[i]));
        if (is_due(at) && !(without_slot && at->held)) return at;
    }
    return NULL;
}

/* Give free slots to due instances, by priority; the slots they leave are free for the next. Returns the number of
 * moves. */
static uint32_t move_where_free(noh_lod_pools *p, uint32_t moves)
{
    uint32_t made = 0;
    for (uint32_t i = 0; i < p->stats.asked && made < moves; i++) {
        place *at = place_of(p, instance_of(keys_of(p)[i]));
        if (is_due(at) && p->pools[at->next].free_count) {
            if (at->held) give_up(p, at);
            take_from(p, at, at->next);
            made++;
        }
    }
    return made;
}

/* The instance of lowest priority in a pool that is due another pool. A full pool with an instance waiting for it
 * contains one, because no more instances are assigned to a pool than it has slots. */
static place *last_due_in(const noh_lod_pools *p, uint32_t which)
{
    for (uint32_t i = p->stats.asked; i-- > 0;) {
        place *at = place_of(p, instance_of(keys_of(p)[i]));
        if (at->held && at->pool == which && at->next != which) return at;
    }
    return NULL;
}

/* The coarsest pool with a free slot; there is one while a due instance has no slot. */
static uint32_t any_free(const noh_lod_pools *p)
{
    uint32_t which = p->pool_count;
    while (which-- > 0 && !p->pools[which].free_count) {}
    return which;
}

/* The first due instance takes a slot in its pool from an instance due elsewhere, which gets the first one's slot, or a
 * free slot. */
static uint32_t exchange(noh_lod_pools *p)
{
    place *a = first_due(p, 0), *b = a ? last_due_in(p, a->next) : NULL;
    uint32_t slot;
    uint8_t which;
    if (!b) {
        return 0;
    }
    slot = b->slot;
    which = b->pool;
    if (a->held) {
        b->slot = a->slot;
        b->pool = a->pool;
        p->stats.moved++;
    } else {
        take_from(p, b, any_free(p));
        a->held = 1;
    }
    a->slot = slot;
    a->pool = which;
    p->stats.moved++;
    return 2;
}

/* With one move left: give any slot to an instance without one, even outside its assigned pool. */
static uint32_t take_any(noh_lod_pools *p)
{
    place *at = first_due(p, 1);
    if (!at) {
        return 0;
    }
    take_from(p, at, any_free(p));
    return 1;
}

/* Instances that still wait keep their slots. */
static void settle(noh_lod_pools *p)
{
    memset(p->stats.used, 0, sizeof p->stats.used);
    p->stats.coarser = 0;
    for (uint32_t i = 0; i < p->stats.asked; i++) {
        place *at = place_of(p, instance_of(keys_of(p)[i]));
        if (is_due(at)) {
            at->next = (uint8_t)(at->held ? at->pool : RESTS);
            p->stats.waiting++;
            p->stats.resting += !at->held;
        }
        if (has_pool(at)) {
            p->stats.used[at->pool]++;
            p->stats.coarser += p->pools[at->pool].level > at->level;
        }
    }
}

static void share_bounded(noh_lod_pools *p, uint32_t moves)
{
    uint32_t made = 1;
    release(p, 1);
    while (moves && made) {
        made = move_where_free(p, moves);
        if (!made) made = moves > 1u ? exchange(p) : take_any(p);
        moves -= made;
    }
    settle(p);
}

/* ---- sharing, all steps ---- */

static void mark(uint32_t *high_water, uint32_t value)
{
    *high_water = value > *high_water ? value : *high_water;
}

void noh_lod_pools_share_some(noh_lod_pools *p, uint32_t moves)
{
    int sorted;
    NOH_ASSERT(p);
    moves = moves > 2u ? moves : 2u;
    sorted = !all_fit(p);
    if (sorted) sort_keys(keys_of(p), p->stats.asked);
    choose_pools(p);
    if (count_due(p) > moves) {
        if (!sorted) sort_keys(keys_of(p), p->stats.asked);
        share_bounded(p, moves);
    } else {
        release(p, 0);
        take(p);
    }
    mark(&p->stats.coarser_high_water, p->stats.coarser);
    for (uint32_t i = 0; i < p->pool_count; i++) {
        mark(&p->stats.used_high_water[i], p->stats.used[i]);
    }
    NOH_VALIDATE(is_consistent(p));
}

/* ---- results ---- */

noh_lod_slot noh_lod_pools_slot(const noh_lod_pools *p, uint32_t instance)
{
    const place *at = place_of(p, instance);
    noh_lod_slot s = { NOH_NONE, 0, 0, 0 };
    NOH_ASSERT(instance < p->instance_count && at->next != NOT_ASKED);
    s.level = at->level;
    s.left_out = at->next == LEFT_OUT;
    if (has_pool(at)) {
        NOH_ASSERT(at->held && at->next == at->pool);
        s.pool = at->pool;
        s.slot = at->slot;
        s.level = at->level > p->pools[at->pool].level ? at->level : p->pools[at->pool].level;
    }
    return s;
}

const noh_lod_pools_stats *noh_lod_pools_stats_of(const noh_lod_pools *p)
{
    NOH_ASSERT(p);
    return &p->stats;
}
