/* Smart objects: a million random reservations against a model that is written from the header alone; what objects tell
 * agents to do; and what is refused.
 * cross: long, a million reservations */
#include "noh/base.h"
#include "noh/crowd.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

#define AGENTS 41u
#define NEEDS 4u /* the last is satisfied by no object */
#define OBJECTS 6u
#define SLOTS 13u
#define STEP_MAX 2400u
#define ASKED 1000000u

/* ---- objects ---- */

typedef struct town {
    noh_smart_desc desc;
    noh_smart_object objects[OBJECTS];
    noh_smart_slot slots[SLOTS];
    noh_smart *smart;
    void *memory;
    size_t bytes;
} town;

static uint32_t chance(uint32_t *seed, uint32_t below)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (uint32_t)(((uint64_t)(*seed >> 8) * below) >> 24);
}

static void open_town(town *t)
{
    static const uint32_t counts[OBJECTS] = { 3, 2, 4, 1, 1, 2 };
    uint32_t seed = 11, slot = 0;
    memset(t, 0, sizeof *t);
    for (uint32_t i = 0; i < OBJECTS; i++) {
        t->objects[i] = (noh_smart_object){ i % 3u, 0.5f + 0.25f * (float)i, 4000u + 1000u * i, slot, counts[i] };
        slot += counts[i];
    }
    for (uint32_t i = 0; i < SLOTS; i++) {
        const float x = (float)chance(&seed, 40u), angle = 0.5f * (float)i;
        t->slots[i] = (noh_smart_slot){
            { x, (float)chance(&seed, 40u) }, { cosf(angle), sinf(angle) }, 1, 2 + i, 3, chance(&seed, 3u) * 800u,
            chance(&seed, 3u) * 800u,         2000u + chance(&seed, 9000u)
        };
    }
    t->desc = (noh_smart_desc){ AGENTS, NEEDS, OBJECTS, SLOTS, t->objects, t->slots, { 0.3f, 0.2f, 0.1f, 0.4f } };
    t->bytes = noh_smart_size(&t->desc);
    t->memory = test_aligned(NULL, t->bytes);
    assert_int_equal(noh_smart_init(t->memory, t->bytes, &t->desc, &t->smart, NULL), NOH_OK);
}

static void close_town(town *t)
{
    free(t->memory);
}

/* ---- the model ---- */

typedef struct person {
    noh_smart_phase phase;
    uint32_t need, slot, ticks;
    float at[2], needs[NEEDS];
    uint64_t asked; /* when */
} person;

typedef struct model_town {
    person people[AGENTS];
    uint32_t queue[NEEDS][AGENTS], length[NEEDS];
    uint64_t now, longest[NEEDS];
} model_town;

static uint32_t object_of(const town *t, uint32_t slot)
{
    uint32_t i = 0;
    while (slot >= t->objects[i].first_slot + t->objects[i].slot_count) i++;
    return i;
}

/* The longest time that a slot for a need may be held: four phases end late, and the slot is passed on in the next
 * step. */
static uint64_t hold_ticks(const town *t, uint32_t need)
{
    uint64_t most = 0;
    for (uint32_t k = 0; k < SLOTS; k++) {
        const noh_smart_object *o = &t->objects[object_of(t, k)];
        const noh_smart_slot *s = &t->slots[k];
        const uint64_t ticks = (uint64_t)o->going_ticks + s->enter_ticks + s->use_ticks + s->leave_ticks +
                               5u * STEP_MAX;
        if (o->need == need && ticks > most) most = ticks;
    }
    return most;
}

static int is_held(const model_town *m, uint32_t slot)
{
    for (uint32_t i = 0; i < AGENTS; i++) {
        if (m->people[i].phase >= NOH_SMART_GOING && m->people[i].slot == slot) return 1;
    }
    return 0;
}

static int model_reserve(model_town *m, const town *t, uint32_t agent)
{
    person *p = &m->people[agent];
    float most = -1.0f;
    for (uint32_t k = 0; k < SLOTS; k++) {
        const noh_smart_object *o = &t->objects[object_of(t, k)];
        const float x = t->slots[k].at[0] - p->at[0], z = t->slots[k].at[1] - p->at[1];
        const float score = o->rate / (1.0f + sqrtf(x * x + z * z));
        if (o->need != p->need || is_held(m, k) || score <= most) continue;
        most = score;
        p->slot = k;
    }
    if (most < 0.0f) return 0;
    p->phase = NOH_SMART_GOING;
    p->ticks = 0;
    return 1;
}

static void model_unqueue(model_town *m, uint32_t agent)
{
    const uint32_t n = m->people[agent].need;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < m->length[n]; i++) {
        if (m->queue[n][i] != agent) m->queue[n][kept++] = m->queue[n][i];
    }
    m->length[n] = kept;
}

static void model_be(person *p, noh_smart_phase phase)
{
    p->phase = phase;
    p->ticks = 0;
}

static int model_ask(model_town *m, const town *t, uint32_t agent, uint32_t need, const float at[2])
{
    person *p = &m->people[agent];
    if (p->phase != NOH_SMART_FREE || need >= 3u) return 0;
    p->need = need;
    memcpy(p->at, at, sizeof p->at);
    p->asked = m->now;
    if (m->length[need] || !model_reserve(m, t, agent)) {
        m->queue[need][m->length[need]++] = agent;
        model_be(p, NOH_SMART_WAITING);
    }
    return 1;
}

static void model_leave(model_town *m, uint32_t agent)
{
    if (m->people[agent].phase == NOH_SMART_WAITING) model_unqueue(m, agent);
    model_be(&m->people[agent], NOH_SMART_AWAY);
}

static int model_release(model_town *m, uint32_t agent)
{
    person *p = &m->people[agent];
    if (p->phase == NOH_SMART_AWAY || p->phase == NOH_SMART_FREE || p->phase == NOH_SMART_LEAVING) return 0;
    if (p->phase == NOH_SMART_WAITING) model_unqueue(m, agent);
    model_be(p, p->phase >= NOH_SMART_ENTERING ? NOH_SMART_LEAVING : NOH_SMART_FREE);
    return 1;
}

static void model_end(person *p, const town *t)
{
    const noh_smart_slot *s = &t->slots[p->slot];
    if (p->phase == NOH_SMART_GOING && p->ticks >= t->objects[object_of(t, p->slot)].going_ticks) {
        model_be(p, NOH_SMART_FREE);
    } else if (p->phase == NOH_SMART_ENTERING && p->ticks >= s->enter_ticks) {
        model_be(p, NOH_SMART_USING);
    } else if (p->phase == NOH_SMART_USING && (p->ticks >= s->use_ticks || p->needs[p->need] <= 0.0f)) {
        model_be(p, s->leave_ticks ? NOH_SMART_LEAVING : NOH_SMART_FREE);
    } else if (p->phase == NOH_SMART_LEAVING && p->ticks >= s->leave_ticks) {
        model_be(p, NOH_SMART_FREE);
    }
}

static void model_step(model_town *m, const town *t, uint32_t ticks)
{
    m->now += ticks;
    for (uint32_t i = 0; i < AGENTS; i++) {
        person *p = &m->people[i];
        if (p->phase == NOH_SMART_AWAY) continue;
        for (uint32_t n = 0; n < NEEDS; n++) {
            const int uses = p->phase == NOH_SMART_USING && n == p->need;
            const float rate = uses ? -t->objects[object_of(t, p->slot)].rate : t->desc.growth[n];
            p->needs[n] = fminf(fmaxf(p->needs[n] + rate * ((float)ticks * (1.0f / 48000.0f)), 0.0f), 1.0f);
        }
        p->ticks += ticks;
        if (p->phase >= NOH_SMART_GOING) model_end(p, t);
    }
    for (uint32_t n = 0; n < NEEDS; n++) {
        while (m->length[n] && model_reserve(m, t, m->queue[n][0])) {
            const uint32_t agent = m->queue[n][0];
            const uint64_t waited = m->now - m->people[agent].asked;
            m->longest[n] = waited > m->longest[n] ? waited : m->longest[n];
            memmove(m->queue[n], m->queue[n] + 1, --m->length[n] * sizeof m->queue[n][0]);
        }
    }
}

/* ---- the comparison ---- */

static void compare(const town *t, const model_town *m, uint32_t turn)
{
    uint32_t held = 0, holders = 0;
    for (uint32_t i = 0; i < AGENTS; i++) {
        const person *p = &m->people[i];
        noh_smart_use use;
        noh_smart_use_of(t->smart, i, &use);
        if (use.phase != p->phase) fail_msg("turn %u: agent %u is in phase %d, not %d", turn, i, use.phase, p->phase);
        if (p->phase < NOH_SMART_GOING) continue;
        if (use.slot != p->slot) fail_msg("turn %u: agent %u has slot %u, not %u", turn, i, use.slot, p->slot);
        if (noh_smart_holder(t->smart, use.slot) != i) fail_msg("turn %u: slot %u is not held", turn, use.slot);
        assert_int_equal(use.object, object_of(t, p->slot));
        holders++;
    }
    for (uint32_t k = 0; k < SLOTS; k++) held += noh_smart_holder(t->smart, k) != NOH_NONE;
    if (held != holders) fail_msg("turn %u: %u slots are held by %u agents", turn, held, holders);
}

static uint32_t act(town *t, model_town *m, uint32_t agent, uint32_t what, uint32_t *seed)
{
    person *p = &m->people[agent];
    const uint32_t need = chance(seed, NEEDS);
    const float x = (float)chance(seed, 40u), at[2] = { x, (float)chance(seed, 40u) };
    if (what < 60u) {
        const int asked = noh_smart_request(t->smart, agent, need, at);
        assert_int_equal(asked, model_ask(m, t, agent, need, at));
        return (uint32_t)asked;
    }
    if (what < 84u) {
        assert_int_equal(noh_smart_arrive(t->smart, agent), p->phase == NOH_SMART_GOING);
        if (p->phase == NOH_SMART_GOING) model_be(p, NOH_SMART_ENTERING);
    } else if (what < 94u) {
        assert_int_equal(noh_smart_release(t->smart, agent), model_release(m, agent));
    } else if (what < 96u) {
        noh_smart_leave(t->smart, agent);
        model_leave(m, agent);
    } else {
        const float needs[NEEDS] = { 0.5f, 0.25f * (float)need, 1.0f, 0.0f };
        noh_smart_enter(t->smart, agent, needs);
        model_leave(m, agent);
        model_be(p, NOH_SMART_FREE);
        memcpy(p->needs, needs, sizeof needs);
    }
    return 0;
}

/* A million that were asked for: no slot has two holders, none is lost, and none waits longer than the header says. */
static void a_million_reservations_agree_with_the_model(void **state)
{
    static model_town m;
    town t;
    uint32_t seed = 3, asked = 0, turn = 0;
    (void)state;
    memset(&m, 0, sizeof m);
    open_town(&t);
    for (; asked < ASKED; turn++) {
        for (uint32_t k = 0; k < 16u; k++) {
            const uint32_t agent = chance(&seed, AGENTS);
            asked += act(&t, &m, agent, chance(&seed, 100u), &seed);
        }
        const uint32_t ticks = chance(&seed, STEP_MAX + 1u);
        noh_smart_step(t.smart, ticks);
        model_step(&m, &t, ticks);
        compare(&t, &m, turn);
    }
    for (uint32_t n = 0; n < 3u; n++) {
        const uint32_t slots = n == 0 ? 4u : n == 1 ? 3u : 6u;
        const uint64_t bound = hold_ticks(&t, n) * ((AGENTS + slots - 1u) / slots);
        printf("  need %u: none waited longer than %.2f s; at most %.2f can\n", n, (double)m.longest[n] / 48000.0,
               (double)bound / 48000.0);
        assert_true(m.longest[n] > 48000u / 4u && m.longest[n] <= bound);
    }
    for (uint32_t i = 0; i < AGENTS; i++) noh_smart_leave(t.smart, i);
    for (uint32_t k = 0; k < SLOTS; k++) assert_int_equal(noh_smart_holder(t.smart, k), NOH_NONE);
    close_town(&t);
}

/* Who asks all the time, at a single slot: each of them is served in its turn. */
static void none_starves_where_all_ask(void **state)
{
    uint32_t served[AGENTS] = { 0 }, least = 0xffffffffu, most = 0;
    static const float at[2] = { 0.0f, 0.0f };
    town t;
    (void)state;
    open_town(&t);
    for (uint32_t i = 0; i < AGENTS; i++) noh_smart_enter(t.smart, i, NULL);
    for (uint32_t step = 0; step < 40000u; step++) {
        for (uint32_t i = 0; i < AGENTS; i++) {
            (void)noh_smart_request(t.smart, i, 0, at);
            served[i] += (uint32_t)noh_smart_arrive(t.smart, i);
        }
        noh_smart_step(t.smart, 800u);
    }
    for (uint32_t i = 0; i < AGENTS; i++) {
        least = served[i] < least ? served[i] : least;
        most = served[i] > most ? served[i] : most;
    }
    printf("  each was served %u to %u times\n", least, most);
    assert_true(least > 100u && most - least <= most / 10u);
    close_town(&t);
}

/* A bench is entered, used until the need is gone, and left; an agent that does not come loses it. */
static void an_object_knows_what_is_done_with_it(void **state)
{
    static const float at[2] = { 0.0f, 0.0f }, needs[1] = { 0.5f };
    const noh_smart_object bench = { 0, 0.25f, 48000u, 0, 1 };
    const noh_smart_slot seat = { { 3.0f, 4.0f }, { 0.0f, -1.0f }, 7, 8, 9, 24000u, 12000u, 480000u };
    noh_smart_desc desc;
    noh_smart_use use;
    noh_smart *smart = NULL;
    (void)state;
    memset(&desc, 0, sizeof desc);
    desc.agent_max = 2, desc.need_count = 1, desc.object_count = 1, desc.slot_count = 1;
    desc.objects = &bench, desc.slots = &seat;
    void *memory = test_aligned(NULL, noh_smart_size(&desc));
    assert_int_equal(noh_smart_init(memory, noh_smart_size(&desc), &desc, &smart, NULL), NOH_OK);
    noh_smart_enter(smart, 0, needs);
    noh_smart_enter(smart, 1, NULL);
    assert_int_equal(noh_smart_most(smart, 0, 0.4f), 0);
    assert_int_equal(noh_smart_most(smart, 0, 0.5f), NOH_NONE);
    assert_int_equal(noh_smart_request(smart, 0, 0, at), 1);
    assert_int_equal(noh_smart_slot_at(smart, 0)->use_clip, 8);
    assert_int_equal(noh_smart_arrive(smart, 0), 1);
    for (uint32_t tick = 0; tick < 24000u + 96000u + 12000u; tick += 1000u) {
        noh_smart_use_of(smart, 0, &use);
        const noh_smart_phase want = tick < 24000u    ? NOH_SMART_ENTERING
                                     : tick < 120000u ? NOH_SMART_USING
                                                      : NOH_SMART_LEAVING;
        if (use.phase != want) fail_msg("tick %u: phase %d", tick, use.phase); /* 0.5 at 0.25 a second: 2 s */
        noh_smart_step(smart, 1000u);
    }
    noh_smart_use_of(smart, 0, &use);
    assert_int_equal(use.phase, NOH_SMART_FREE);
    assert_int_equal(noh_smart_request(smart, 0, 0, at), 1);
    assert_int_equal(noh_smart_request(smart, 1, 0, at), 1);
    noh_smart_step(smart, 47999u);
    noh_smart_use_of(smart, 1, &use);
    assert_int_equal(use.phase, NOH_SMART_WAITING);
    noh_smart_step(smart, 1u); /* it does not come: the other's */
    noh_smart_use_of(smart, 1, &use);
    assert_int_equal(use.phase, NOH_SMART_GOING);
    noh_smart_leave(smart, 1);
    assert_int_equal(noh_smart_holder(smart, 0), NOH_NONE);
    noh_smart_enter(smart, 1, NULL);
    noh_smart_step(smart, 100u);
    noh_smart_use_of(smart, 1, &use);
    assert_int_equal(use.ticks, 100);
    noh_smart_step(smart, UINT32_MAX); /* of a day six hours count */
    noh_smart_use_of(smart, 1, &use);
    assert_int_equal(use.ticks, (1u << 30) - 1u);
    noh_smart_leave(smart, 1); /* nothing is left of it */
    noh_smart_use_of(smart, 1, &use);
    assert_true(use.phase == NOH_SMART_AWAY && use.ticks == 0 && use.object == NOH_NONE && use.slot == NOH_NONE);
    free(memory);
}

static void what_is_no_object_is_refused(void **state)
{
    town t;
    noh_smart *smart;
    noh_error said;
    (void)state;
    open_town(&t);
#define REFUSED(change, result, at)                                                            \
    do {                                                                                       \
        town bad = t;                                                                          \
        bad.desc.objects = bad.objects;                                                        \
        bad.desc.slots = bad.slots;                                                            \
        change;                                                                                \
        assert_int_equal(noh_smart_size(&bad.desc), 0);                                        \
        assert_int_equal(noh_smart_init(t.memory, t.bytes, &bad.desc, &smart, &said), result); \
        assert_int_equal(said.where, at);                                                      \
    } while (0)
    REFUSED(bad.desc.agent_max = 0, NOH_ERR_LIMIT, 0);
    REFUSED(bad.desc.need_count = NOH_SMART_NEEDS_MAX + 1u, NOH_ERR_LIMIT, 0);
    REFUSED(bad.desc.growth[2] = NAN, NOH_ERR_ARG, 2);
    REFUSED(bad.objects[3].need = NEEDS, NOH_ERR_ARG, 3);
    REFUSED(bad.objects[3].rate = 0.0f, NOH_ERR_ARG, 3);
    REFUSED(bad.objects[4].first_slot = 0, NOH_ERR_ARG, 4);
    REFUSED(bad.objects[5].slot_count = 3, NOH_ERR_ARG, 5);
    REFUSED(bad.objects[5].slot_count = 1, NOH_ERR_ARG, SLOTS - 1u);
    REFUSED(bad.slots[7].face[0] = 2.0f, NOH_ERR_ARG, 7);
    REFUSED(bad.slots[8].at[1] = INFINITY, NOH_ERR_ARG, 8);
    REFUSED(bad.slots[9].use_ticks = 0, NOH_ERR_ARG, 9);
#undef REFUSED
    close_town(&t);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_million_reservations_agree_with_the_model),
        cmocka_unit_test(none_starves_where_all_ask),
        cmocka_unit_test(an_object_knows_what_is_done_with_it),
        cmocka_unit_test(what_is_no_object_is_refused),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
