/* smart_object.c: slots, their holders, and queues. */
#include "noh/base.h"
#include "noh/crowd.h"
#include "noh/low_core.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"

#define TICKS_PER_S 48000.0f
#define RATE_MAX 1e3f
#define PLACE_MAX 1e6f
#define TICKS_MAX 0x3fffffffu

/* A queue is a list through its agents. */
typedef struct smart_agent {
    uint32_t phase; /* noh_smart_phase */
    uint32_t need, object, slot;
    uint32_t ticks;
    uint32_t next; /* in the queue; NOH_NONE: the last */
    float at[2];   /* where it asked */
    uint32_t unused;
} smart_agent;

typedef struct smart_slot {
    noh_smart_slot slot;
    uint32_t holder; /* NOH_NONE: it is free */
} smart_slot;

/* Followed by objects, slots, agents and their needs. */
struct noh_smart {
    uint32_t bytes, agent_max, need_count, object_count, slot_count;
    uint32_t slots, agents, needs;                                  /* byte offsets */
    uint32_t first[NOH_SMART_NEEDS_MAX], last[NOH_SMART_NEEDS_MAX]; /* of queues; NOH_NONE: it is empty */
    float growth[NOH_SMART_NEEDS_MAX];
    uint32_t satisfiers[NOH_SMART_NEEDS_MAX]; /* slots of each need */
};
NOH_STATIC_ASSERT(sizeof(struct noh_smart) == 160, smart);
NOH_STATIC_ASSERT(sizeof(smart_agent) == 36 && sizeof(smart_slot) == 44, smart_records);

static smart_slot *slots_of(const noh_smart *s)
{
    return (smart_slot *)(void *)((char *)(uintptr_t)s + s->slots);
}

static smart_agent *agents_of(const noh_smart *s)
{
    return (smart_agent *)(void *)((char *)(uintptr_t)s + s->agents);
}

static float *needs_of(const noh_smart *s, uint32_t agent)
{
    return (float *)(void *)((char *)(uintptr_t)s + s->needs) + (size_t)agent * s->need_count;
}

static noh_smart_object *objects_of(const noh_smart *s)
{
    return (noh_smart_object *)(void *)((char *)(uintptr_t)s + sizeof *s);
}

/* ---- size and init ---- */

static noh_result check_slot(const noh_smart_slot *s, uint32_t index, noh_error *error)
{
    const float face = s->face[0] * s->face[0] + s->face[1] * s->face[1];
    if (!noh_is_within(s->at[0], -PLACE_MAX, PLACE_MAX) || !noh_is_within(s->at[1], -PLACE_MAX, PLACE_MAX) ||
        !noh_is_within(face, 0.99f, 1.01f)) {
        return noh_fail(error, NOH_ERR_ARG, "slot: position is out of range, or face is not a unit vector", index, 0);
    }
    if (!s->use_ticks || s->use_ticks > TICKS_MAX || s->enter_ticks > TICKS_MAX || s->leave_ticks > TICKS_MAX) {
        return noh_fail(error, NOH_ERR_ARG, "slot: times are out of range, or use_ticks is 0", index, s->use_ticks);
    }
    return NOH_OK;
}

static noh_result check_object(const noh_smart_desc *d, uint32_t index, uint32_t next_slot, noh_error *error)
{
    const noh_smart_object *o = &d->objects[index];
    if (o->need >= d->need_count || !noh_is_within(o->rate, 1e-6f, RATE_MAX) || !o->going_ticks ||
        o->going_ticks > TICKS_MAX) {
        return noh_fail(error, NOH_ERR_ARG, "smart object: need, rate or going_ticks is out of range", index, o->need);
    }
    if (o->first_slot != next_slot || !o->slot_count || o->slot_count > d->slot_count - next_slot) {
        return noh_fail(error, NOH_ERR_ARG, "smart objects: slots of objects must be consecutive and not overlap",
                        index, o->first_slot);
    }
    return NOH_OK;
}

static noh_result check_counts(const noh_smart_desc *d, noh_error *error)
{
    if (!d->agent_max || d->agent_max > NOH_CROWD_AGENTS_MAX || !d->need_count || d->need_count > NOH_SMART_NEEDS_MAX ||
        !d->object_count || d->object_count > NOH_SMART_OBJECTS_MAX || !d->slot_count ||
        d->slot_count > NOH_SMART_SLOTS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT,
                        "smart objects: a count of agents, needs, objects or slots is 0 or above its limit", 0, 0);
    }
    for (uint32_t n = 0; n < d->need_count; n++) {
        if (!noh_is_within(d->growth[n], 0.0f, RATE_MAX)) {
            return noh_fail(error, NOH_ERR_ARG, "smart objects: growth of a need is negative or out of range", n, 0);
        }
    }
    return NOH_OK;
}

static noh_result check(const noh_smart_desc *d, noh_error *error)
{
    uint32_t slot = 0;
    noh_result result = check_counts(d, error);
    if (result) return result;
    for (uint32_t i = 0; i < d->object_count; i++) {
        result = check_object(d, i, slot, error);
        if (result) return result;
        slot += d->objects[i].slot_count;
    }
    if (slot != d->slot_count)
        return noh_fail(error, NOH_ERR_ARG, "smart objects: a slot belongs to no object", slot, 0);
    for (uint32_t i = 0; i < d->slot_count && !result; i++) result = check_slot(&d->slots[i], i, error);
    return result;
}

static void lay_out(noh_smart *s, const noh_smart_desc *d)
{
    memset(s, 0, sizeof *s);
    s->agent_max = d->agent_max;
    s->need_count = d->need_count;
    s->object_count = d->object_count;
    s->slot_count = d->slot_count;
    s->slots = (uint32_t)(sizeof *s + d->object_count * sizeof(noh_smart_object));
    s->agents = s->slots + (uint32_t)(d->slot_count * sizeof(smart_slot));
    s->needs = s->agents + (uint32_t)(d->agent_max * sizeof(smart_agent));
    s->bytes = (s->needs + (uint32_t)sizeof(float) * d->need_count * d->agent_max + 15u) & ~15u;
    for (uint32_t n = 0; n < NOH_SMART_NEEDS_MAX; n++) s->first[n] = s->last[n] = NOH_NONE;
    for (uint32_t n = 0; n < d->need_count; n++) s->growth[n] = d->growth[n];
    for (uint32_t i = 0; i < d->object_count; i++) s->satisfiers[d->objects[i].need] += d->objects[i].slot_count;
}

size_t noh_smart_size(const noh_smart_desc *desc)
{
    noh_smart s;
    NOH_ASSERT(desc && desc->objects && desc->slots);
    if (check(desc, NULL)) return 0;
    lay_out(&s, desc);
    return s.bytes;
}

noh_result noh_smart_init(void *memory, size_t bytes, const noh_smart_desc *desc, noh_smart **smart, noh_error *error)
{
    noh_arena arena;
    noh_smart s;
    NOH_ASSERT(desc && desc->objects && desc->slots && smart);
    noh_result result = check(desc, error);
    if (result) return result;
    lay_out(&s, desc);
    result = noh_arena_open(&arena, memory, bytes, s.bytes, error);
    if (result) return result;
    memset(memory, 0, s.bytes);
    *smart = memory;
    **smart = s;
    memcpy(objects_of(*smart), desc->objects, desc->object_count * sizeof *desc->objects);
    for (uint32_t i = 0; i < desc->slot_count; i++) {
        slots_of(*smart)[i].slot = desc->slots[i];
        slots_of(*smart)[i].holder = NOH_NONE;
    }
    return NOH_OK;
}

/* ---- phases ---- */

static void begin(smart_agent *a, uint32_t phase)
{
    a->phase = phase;
    a->ticks = 0;
}

static void be_free(smart_agent *a)
{
    begin(a, NOH_SMART_FREE);
    a->object = a->slot = a->next = NOH_NONE;
}

static void let_go(noh_smart *s, smart_agent *a)
{
    if (a->slot != NOH_NONE) slots_of(s)[a->slot].holder = NOH_NONE;
}

static void queue_up(noh_smart *s, uint32_t agent, uint32_t need)
{
    smart_agent *agents = agents_of(s);
    if (s->last[need] == NOH_NONE) {
        s->first[need] = agent;
    } else {
        agents[s->last[need]].next = agent;
    }
    s->last[need] = agent;
    agents[agent].next = NOH_NONE;
    begin(&agents[agent], NOH_SMART_WAITING);
}

static void leave_queue(noh_smart *s, uint32_t agent)
{
    smart_agent *agents = agents_of(s);
    const uint32_t need = agents[agent].need;
    uint32_t before = NOH_NONE;
    for (uint32_t i = s->first[need]; i != agent; i = agents[i].next) before = i;
    if (before == NOH_NONE) {
        s->first[need] = agents[agent].next;
    } else {
        agents[before].next = agents[agent].next;
    }
    if (s->last[need] == agent) s->last[need] = before;
    agents[agent].next = NOH_NONE;
}

/* ---- reservations ---- */

static float distance_to(const noh_smart_slot *slot, const float at[2])
{
    const float x = slot->at[0] - at[0], z = slot->at[1] - at[1];
    return noh_sqrt(x * x + z * z);
}

/* The best free slot; NOH_NONE: there is none. */
static uint32_t best_of(const noh_smart *s, uint32_t need, const float at[2], uint32_t *object)
{
    uint32_t best = NOH_NONE;
    float most = -1.0f;
    for (uint32_t i = 0; i < s->object_count; i++) {
        const noh_smart_object *o = &objects_of(s)[i];
        for (uint32_t k = o->first_slot; o->need == need && k < o->first_slot + o->slot_count; k++) {
            const float score = o->rate / (1.0f + distance_to(&slots_of(s)[k].slot, at));
            if (slots_of(s)[k].holder != NOH_NONE || !(score > most)) continue;
            most = score;
            best = k;
            *object = i;
        }
    }
    return best;
}

static int reserve(noh_smart *s, uint32_t agent)
{
    smart_agent *a = &agents_of(s)[agent];
    uint32_t object = NOH_NONE;
    const uint32_t slot = best_of(s, a->need, a->at, &object);
    if (slot == NOH_NONE) return 0;
    slots_of(s)[slot].holder = agent;
    a->slot = slot;
    a->object = object;
    begin(a, NOH_SMART_GOING);
    return 1;
}

/* Assign free slots to waiting agents, first come, first served. */
static void pass_on(noh_smart *s, uint32_t need)
{
    while (s->first[need] != NOH_NONE) {
        const uint32_t agent = s->first[need], next = agents_of(s)[agent].next;
        if (!reserve(s, agent)) return;
        agents_of(s)[agent].next = NOH_NONE;
        s->first[need] = next;
        if (next == NOH_NONE) s->last[need] = NOH_NONE;
    }
}

static float clamped(float x)
{
    return x > 0.0f ? x < 1.0f ? x : 1.0f : 0.0f;
}

void noh_smart_enter(noh_smart *smart, uint32_t agent, const float *needs)
{
    NOH_ASSERT(smart && agent < smart->agent_max);
    noh_smart_leave(smart, agent);
    for (uint32_t n = 0; n < smart->need_count; n++) needs_of(smart, agent)[n] = needs ? clamped(needs[n]) : 0.0f;
    be_free(&agents_of(smart)[agent]);
}

void noh_smart_leave(noh_smart *smart, uint32_t agent)
{
    NOH_ASSERT(smart && agent < smart->agent_max);
    smart_agent *a = &agents_of(smart)[agent];
    if (a->phase == NOH_SMART_AWAY) return;
    if (a->phase == NOH_SMART_WAITING) leave_queue(smart, agent);
    let_go(smart, a);
    be_free(a);
    a->phase = NOH_SMART_AWAY;
}

int noh_smart_request(noh_smart *smart, uint32_t agent, uint32_t need, const float at[2])
{
    NOH_ASSERT(smart && at && agent < smart->agent_max);
    smart_agent *a = &agents_of(smart)[agent];
    if (a->phase != NOH_SMART_FREE || need >= smart->need_count || !smart->satisfiers[need]) return 0;
    a->need = need;
    memcpy(a->at, at, sizeof a->at);
    if (smart->first[need] != NOH_NONE || !reserve(smart, agent)) queue_up(smart, agent, need);
    return 1;
}

int noh_smart_arrive(noh_smart *smart, uint32_t agent)
{
    NOH_ASSERT(smart && agent < smart->agent_max);
    smart_agent *a = &agents_of(smart)[agent];
    if (a->phase != NOH_SMART_GOING) return 0;
    begin(a, NOH_SMART_ENTERING);
    return 1;
}

int noh_smart_release(noh_smart *smart, uint32_t agent)
{
    NOH_ASSERT(smart && agent < smart->agent_max);
    smart_agent *a = &agents_of(smart)[agent];
    switch (a->phase) {
    case NOH_SMART_WAITING:
        leave_queue(smart, agent);
        be_free(a);
        return 1;
    case NOH_SMART_GOING:
        let_go(smart, a);
        be_free(a);
        return 1;
    case NOH_SMART_ENTERING:
    case NOH_SMART_USING: begin(a, NOH_SMART_LEAVING); return 1;
    default: return 0;
    }
}

/* ---- time ---- */

/* End a phase that has lasted long enough. returns 1 if the next one may also have ended */
static int end_phase(noh_smart *s, uint32_t agent)
{
    smart_agent *a = &agents_of(s)[agent];
    const noh_smart_slot *slot = &slots_of(s)[a->slot].slot;
    const uint32_t over = a->ticks;
    const int is_late = a->phase == NOH_SMART_GOING && over >= objects_of(s)[a->object].going_ticks;
    if (is_late || (a->phase == NOH_SMART_LEAVING && over >= slot->leave_ticks)) {
        let_go(s, a);
        be_free(a);
    } else if (a->phase == NOH_SMART_ENTERING && over >= slot->enter_ticks) {
        begin(a, NOH_SMART_USING);
    } else if (a->phase == NOH_SMART_USING && (over >= slot->use_ticks || needs_of(s, agent)[a->need] <= 0.0f)) {
        begin(a, NOH_SMART_LEAVING);
        return !slot->leave_ticks;
    }
    return 0;
}

static void step_agent(noh_smart *s, uint32_t agent, uint32_t ticks)
{
    smart_agent *a = &agents_of(s)[agent];
    const float seconds = (float)ticks * (1.0f / TICKS_PER_S);
    float *needs = needs_of(s, agent);
    if (a->phase == NOH_SMART_AWAY) return;
    for (uint32_t n = 0; n < s->need_count; n++) {
        const float rate = a->phase == NOH_SMART_USING && n == a->need ? -objects_of(s)[a->object].rate : s->growth[n];
        needs[n] = clamped(needs[n] + rate * seconds);
    }
    a->ticks = a->ticks > TICKS_MAX - ticks ? TICKS_MAX : a->ticks + ticks;
    if (a->slot == NOH_NONE) return;
    while (end_phase(s, agent)) {}
}

void noh_smart_step(noh_smart *smart, uint32_t ticks)
{
    NOH_ASSERT(smart);
    if (ticks > TICKS_MAX) ticks = TICKS_MAX;
    for (uint32_t i = 0; i < smart->agent_max; i++) step_agent(smart, i, ticks);
    for (uint32_t n = 0; n < smart->need_count; n++) pass_on(smart, n);
}

/* ---- queries ---- */

void noh_smart_use_of(const noh_smart *smart, uint32_t agent, noh_smart_use *use)
{
    NOH_ASSERT(smart && use && agent < smart->agent_max);
    const smart_agent *a = &agents_of(smart)[agent];
    use->phase = (noh_smart_phase)a->phase;
    use->need = a->phase >= NOH_SMART_WAITING ? a->need : NOH_NONE;
    use->object = a->phase >= NOH_SMART_GOING ? a->object : NOH_NONE;
    use->slot = a->phase >= NOH_SMART_GOING ? a->slot : NOH_NONE;
    use->ticks = a->ticks;
}

uint32_t noh_smart_most(const noh_smart *smart, uint32_t agent, float least)
{
    const float *needs;
    uint32_t most = NOH_NONE;
    NOH_ASSERT(smart && agent < smart->agent_max);
    if (agents_of(smart)[agent].phase == NOH_SMART_AWAY) return NOH_NONE;
    needs = needs_of(smart, agent);
    for (uint32_t n = 0; n < smart->need_count; n++) {
        if (!smart->satisfiers[n] || !(needs[n] > least)) continue;
        least = needs[n];
        most = n;
    }
    return most;
}

const noh_smart_slot *noh_smart_slot_at(const noh_smart *smart, uint32_t slot)
{
    NOH_ASSERT(smart && slot < smart->slot_count);
    return &slots_of(smart)[slot].slot;
}

uint32_t noh_smart_holder(const noh_smart *smart, uint32_t slot)
{
    NOH_ASSERT(smart && slot < smart->slot_count);
    return slots_of(smart)[slot].holder;
}
