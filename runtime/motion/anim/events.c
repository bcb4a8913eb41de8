#include "core/base/assert_internal.h"
#include "motion/anim/events_internal.h"
#include "motion/anim/time_internal.h"
#include "noh/base.h"
#include "noh/clip.h"

/* The whole ticks of a passage, both ends included. Occurrences lie on whole ticks, so this is enough; the open end is
 * resolved here, once. */
typedef struct span {
    int64_t low, high;
} span;

/* One leg of a passage: the clip ticks low..high, at position base + sign * tick. */
typedef struct leg {
    int64_t low, high;
    int64_t base, sign;
    int descending; /* 1: clip ticks decrease along the passage */
} leg;

typedef struct legs {
    int64_t next, last; /* leg numbers; `next` moves towards `last` */
    int done;
} legs;

static span passage_span(const noh_passage *p)
{
    span s;
    if (p->backward) {
        s.low = noh_ceil_div(p->to, 65536);
        s.high = p->placed ? noh_floor_div(p->from, 65536) : noh_ceil_div(p->from, 65536) - 1;
    } else {
        s.low = p->placed ? noh_ceil_div(p->from, 65536) : noh_floor_div(p->from, 65536) + 1;
        s.high = noh_floor_div(p->to, 65536);
    }
    return s;
}

/* A leg is one traversal of the clip: a pass, or half of a ping-pong cycle. Find the legs in a span. The tick between
 * two legs belongs to both, since in a repeating clip keys at tick 0 and at tick `duration` both occur there. */
static legs passage_legs(const noh_passage *p, span s)
{
    int64_t d = (int64_t)p->duration_ticks;
    /* placed on a seam: only the keys beyond it lie ahead */
    int fresh = p->placed && p->from % 65536 == 0 && p->loop == NOH_LOOP_REPEAT;
    legs l = { 0, 0, s.low > s.high };
    if (p->loop == NOH_LOOP_ONCE || d == 0) {
        return l;
    }
    if (p->backward) {
        l.next = fresh ? noh_ceil_div(s.high, d) - 1 : noh_floor_div(s.high, d);
        l.last = noh_ceil_div(s.low, d) - 1;
        l.done = l.done || l.next < l.last;
    } else {
        l.next = fresh ? noh_floor_div(s.low, d) : noh_ceil_div(s.low, d) - 1;
        l.last = noh_floor_div(s.high, d);
        l.done = l.done || l.next > l.last;
    }
    return l;
}

static int64_t larger(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static int64_t smaller(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* The next leg of a passage; 0 when there is none. */
static int next_leg(const noh_passage *p, span s, legs *l, leg *out)
{
    int64_t d = (int64_t)p->duration_ticks, number = l->next;
    int way_back = p->loop == NOH_LOOP_PING_PONG && (number & 1);
    if (l->done) {
        return 0;
    }
    out->sign = way_back ? -1 : 1;
    out->base = (number + way_back) * d;
    if (way_back) {
        /* the turning ticks belong to the legs before and after, once */
        out->low = larger(out->base - s.high, 1);
        out->high = smaller(out->base - s.low, d - 1);
    } else {
        out->low = larger(s.low - out->base, 0);
        out->high = smaller(s.high - out->base, d);
    }
    out->descending = (p->backward != 0) != way_back;
    l->done = number == l->last;
    l->next += p->backward ? -1 : 1;
    return 1;
}

/* How many keys lie before a tick. */
static uint32_t keys_before(const noh_event_key *keys, uint32_t count, int64_t tick)
{
    uint32_t low = 0, high = count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if ((int64_t)keys[middle].tick < tick) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

int noh_events_first(const noh_event_key *keys, uint32_t count, const noh_passage *passage, int64_t *position_tick)
{
    NOH_ASSERT(passage && position_tick && (keys || !count));
    span s = passage_span(passage);
    legs l = passage_legs(passage, s);
    leg g;
    /* Every whole leg forwards contains every key, so this ends after three legs at most. */
    while (count && next_leg(passage, s, &l, &g)) {
        uint32_t begin = keys_before(keys, count, g.low), end = keys_before(keys, count, g.high + 1);
        if (begin < end) {
            *position_tick = g.base + g.sign * (int64_t)keys[g.descending ? end - 1 : begin].tick;
            return 1;
        }
    }
    return 0;
}

static uint32_t pass_ascending(const noh_event_key *keys, uint32_t begin, uint32_t end, const leg *g, uint32_t limit,
                               noh_key_fn fn, void *user)
{
    uint32_t i = begin;
    for (; i < end && i - begin < limit; i++) {
        fn(user, i, g->base + g->sign * (int64_t)keys[i].tick);
    }
    return i - begin;
}

static uint32_t pass_descending(const noh_event_key *keys, uint32_t begin, uint32_t end, const leg *g, uint32_t limit,
                                noh_key_fn fn, void *user)
{
    uint32_t passed = 0;
    while (end > begin && passed < limit) {
        uint32_t first = end - 1; /* of the keys at this tick, which keep their order */
        while (first > begin && keys[first - 1].tick == keys[first].tick) {
            first--;
        }
        passed += pass_ascending(keys, first, end, g, limit - passed, fn, user);
        end = first;
    }
    return passed;
}

uint32_t noh_events_pass(const noh_event_key *keys, uint32_t count, const noh_passage *passage, uint32_t limit,
                         noh_key_fn fn, void *user)
{
    NOH_ASSERT(passage && fn && (keys || !count));
    uint32_t passed = 0;
    span s = passage_span(passage);
    legs l = passage_legs(passage, s);
    leg g;
    while (count && passed < limit && next_leg(passage, s, &l, &g)) {
        uint32_t begin = keys_before(keys, count, g.low), end = keys_before(keys, count, g.high + 1);
        passed += (g.descending ? pass_descending : pass_ascending)(keys, begin, end, &g, limit - passed, fn, user);
    }
    return passed;
}
