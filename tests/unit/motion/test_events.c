/* Tests of callback keys: runtime/motion/anim/events.c, and through the controller.
 * cross: long, thousands of clips with keys */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "motion/anim/controller_internal.h"
#include "motion/anim/events_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

#define ALIGNED __attribute__((aligned(16)))
#define SEED 20240611u
#define STEPS_WANTED 1000000u

typedef struct rng {
    uint32_t state;
} rng;

static uint32_t next(rng *r)
{
    r->state = r->state * 1664525u + 1013904223u;
    return r->state >> 8;
}

static uint32_t below(rng *r, uint32_t n)
{
    return next(r) % n;
}
static int64_t between(rng *r, int64_t low, int64_t high)
{
    return low + (int64_t)below(r, (uint32_t)(high - low + 1));
}

/* ---- sets of random clips ---- */

#define CLIPS 4u
#define KEYS 6u

typedef struct fixture {
    noh_clip_set set;
    noh_clip_entry clips[CLIPS];
    noh_event_key keys[CLIPS * KEYS];
    noh_marker markers[CLIPS * 2u];
    noh_transform bind;
} fixture;

static void no_sample(void *user, uint32_t clip, uint32_t tick, uint32_t joints, noh_transform *pose, uint32_t floats,
                      float *values)
{
    (void)user, (void)clip, (void)tick, (void)joints, (void)pose, (void)floats, (void)values;
}

static int by_tick(const void *a, const void *b)
{
    const noh_event_key *x = a, *y = b;
    return x->tick < y->tick ? -1 : x->tick > y->tick;
}

static void random_keys(rng *r, noh_event_key *keys, uint32_t count, uint32_t duration)
{
    for (uint32_t i = 0; i < count; i++) {
        memset(&keys[i], 0, sizeof keys[i]);
        switch (below(r, 5)) {
        case 0: keys[i].tick = 0; break;
        case 1: keys[i].tick = duration; break;
        default: keys[i].tick = below(r, duration + 1u); break;
        }
        keys[i].name_hash = next(r);
        keys[i].weight_min = below(r, 3) ? 0.0f : 0.5f;
    }
    qsort(keys, count, sizeof *keys, by_tick);
}

static void random_set(rng *r, fixture *f, uint32_t duration_max)
{
    memset(f, 0, sizeof *f);
    f->bind.rotation[3] = 1.0f;
    for (uint32_t m = 0; m < CLIPS; m++) {
        noh_clip_entry *clip = &f->clips[m];
        clip->duration_ticks = below(r, 8) ? 1u + below(r, duration_max) : below(r, 3);
        clip->loop = (uint32_t)between(r, NOH_LOOP_ONCE, NOH_LOOP_PING_PONG);
        clip->first_event = m * KEYS;
        clip->event_count = below(r, KEYS + 1u);
        random_keys(r, f->keys + m * KEYS, clip->event_count, clip->duration_ticks);
    }
    f->set.clip_count = CLIPS;
    f->set.joint_count = 1;
    f->set.event_count = CLIPS * KEYS;
    f->set.marker_count = CLIPS * 2u;
    f->set.clips = f->clips;
    f->set.events = f->keys;
    f->set.markers = f->markers;
    f->set.bind_pose = &f->bind;
    f->set.sample = no_sample;
}

/* ---- the oracle: the definition in clip.h, tick by tick and key by key ---- */

static int64_t modulo(int64_t a, int64_t b)
{
    return ((a % b) + b) % b;
}
static int64_t floor_of(int64_t a, int64_t b)
{
    return (a - modulo(a, b)) / b;
}

/* Whether a key of tick t happens at tick u, and in which pass. */
static int happens(noh_loop loop, int64_t d, int64_t t, int64_t u, int64_t *pass)
{
    *pass = 0;
    if (loop == NOH_LOOP_ONCE || d == 0) return u == t;
    if (loop == NOH_LOOP_PING_PONG) return modulo(u - t, 2 * d) == 0 || modulo(u + t, 2 * d) == 0;
    *pass = floor_of(u - t, d);
    return modulo(u - t, d) == 0;
}

typedef struct happening {
    int64_t clock, u;
    uint32_t track, index;
} happening;

typedef struct list {
    happening *items;
    uint32_t count, capacity;
} list;

static void push(list *l, happening h)
{
    if (l->count == l->capacity) {
        l->capacity = l->capacity ? 2u * l->capacity : 256u;
        l->items = realloc(l->items, l->capacity * sizeof *l->items);
        assert_non_null(l->items);
    }
    l->items[l->count++] = h;
}

static int same_lists(const list *a, const list *b)
{
    uint32_t same = 0;
    while (same < a->count && same < b->count && a->items[same].clock == b->items[same].clock &&
           a->items[same].u == b->items[same].u && a->items[same].track == b->items[same].track &&
           a->items[same].index == b->items[same].index) {
        same++;
    }
    return same == a->count && same == b->count;
}

/* The keys that happen at tick u, in order, if that tick is passed from `from` to `to`. */
static void oracle_tick(const noh_event_key *keys, uint32_t count, const noh_passage *p, int64_t u, noh_key_fn fn,
                        void *user)
{
    int64_t d = (int64_t)p->duration_ticks, at = u * 65536, pass, from_pass, passes[2] = { 0, 0 };
    int passed = p->backward ? at >= p->to && at < p->from : at > p->from && at <= p->to;
    int under = p->placed && at == p->from && (p->backward ? p->to <= at : p->to >= at);
    if (!passed && !under) return;
    if (p->loop == NOH_LOOP_REPEAT && d) {
        passes[0] = floor_of(u, d) - (modulo(u, d) == 0);
        passes[1] = floor_of(u, d);
    }
    from_pass = passes[p->backward ? 0 : 1]; /* the pass that play is moving to */
    for (int k = 0; k < (passes[0] == passes[1] ? 1 : 2); k++) {
        for (uint32_t i = 0; i < count; i++) {
            int64_t wanted = passes[p->backward ? 1 - k : k];
            if (passes[0] == passes[1]) wanted = passes[0];
            if (!happens((noh_loop)p->loop, d, keys[i].tick, u, &pass) || pass != wanted) continue;
            if (!passed && pass != from_pass) continue;
            fn(user, i, u);
        }
    }
}

static void oracle_pass(const noh_event_key *keys, uint32_t count, const noh_passage *p, noh_key_fn fn, void *user)
{
    int64_t a = floor_of(p->from, 65536) - 1, b = floor_of(p->to, 65536) + 1;
    if (p->backward) {
        for (int64_t u = a + 3; u >= b - 3; u--) oracle_tick(keys, count, p, u, fn, user);
    } else {
        for (int64_t u = a; u <= b; u++) oracle_tick(keys, count, p, u, fn, user);
    }
}

static void collect(void *user, uint32_t index, int64_t position_tick)
{
    happening h = { 0, 0, 0, 0 };
    h.u = position_tick;
    h.index = index;
    push(user, h);
}

/* ---- passages ---- */

static noh_passage random_passage(rng *r, const noh_clip_entry *m)
{
    noh_passage p;
    int64_t end = (int64_t)m->duration_ticks * 65536;
    p.duration_ticks = m->duration_ticks;
    p.loop = (uint8_t)m->loop;
    p.from = between(r, -40, 40) * (below(r, 2) ? 65536 : end / 3 + 1) + (below(r, 2) ? 0 : between(r, 0, 65535));
    p.to = p.from + between(r, -3000000, 3000000);
    if (below(r, 3) == 0) p.to = p.to / 65536 * 65536;
    if (p.loop == NOH_LOOP_ONCE || end == 0) {
        p.from = p.from < 0 ? 0 : p.from > end ? end : p.from;
        p.to = p.to < 0 ? 0 : p.to > end ? end : p.to;
    }
    p.backward = p.to < p.from || (p.to == p.from && below(r, 2));
    p.placed = (uint8_t)below(r, 2);
    return p;
}

/* A passage cut in two at random gives the list of the whole. */
static void passages_join(rng *r, const noh_event_key *keys, uint32_t count, const noh_passage *whole,
                          const list *wanted)
{
    int64_t low = whole->from < whole->to ? whole->from : whole->to, high = whole->from + whole->to - low;
    noh_passage first = *whole, second = *whole;
    list parts = { NULL, 0, 0 };
    if (high > low) {
        first.to = second.from = low + (int64_t)(((uint64_t)next(r) << 16) % (uint64_t)(high - low));
        if (below(r, 2) && floor_of(first.to, 65536) * 65536 >= low)
            first.to = second.from = floor_of(first.to, 65536) * 65536;
    }
    if (first.to != first.from) second.placed = 0;
    if (high > low && first.to == first.from) first.placed = 0; /* nothing moved: still placed in the second */
    if (high > low) noh_events_pass(keys, count, &first, UINT32_MAX, collect, &parts);
    noh_events_pass(keys, count, &second, UINT32_MAX, collect, &parts);
    assert_true(same_lists(wanted, &parts));
    free(parts.items);
}

static void passages_follow_the_definition(void **state)
{
    rng r = { SEED };
    uint64_t total = 0;
    (void)state;
    for (int round = 0; round < 20000; round++) {
        fixture f;
        list wanted = { NULL, 0, 0 }, got = { NULL, 0, 0 };
        const noh_clip_entry *m = &f.clips[0];
        noh_passage p;
        int64_t first;
        int any;
        random_set(&r, &f, round % 2 ? 12u : 60u);
        p = random_passage(&r, m);
        oracle_pass(f.keys, m->event_count, &p, collect, &wanted);
        noh_events_pass(f.keys, m->event_count, &p, UINT32_MAX, collect, &got);
        if (!same_lists(&wanted, &got)) {
            print_message("round %d: from %ld to %ld d %u loop %u placed %u\n", round, (long)p.from, (long)p.to,
                          p.duration_ticks, p.loop, p.placed);
        }
        assert_true(same_lists(&wanted, &got));
        any = noh_events_first(f.keys, m->event_count, &p, &first);
        assert_int_equal(any, wanted.count > 0);
        if (any) assert_int_equal(first, wanted.items[0].u);
        passages_join(&r, f.keys, m->event_count, &p, &wanted);
        total += got.count;
        free(wanted.items);
        free(got.items);
    }
    print_message("20000 passages, %lu happenings\n", (unsigned long)total);
    assert_true(total > 100000);
}

/* ---- the controller against a simulation of single ticks ---- */

#define TRACKS 3u

typedef struct sim_track {
    int64_t position;
    int32_t speed;
    float weight;
    uint32_t clip, loop;
    int placed, on;
} sim_track;

/* What a key's callback does to the other tracks in these tests, read from its name hash: the same for both sides. */
typedef struct action {
    uint32_t kind, track, clip;
    int32_t speed;
    float weight;
    int64_t tick;
} action;

static action action_of(const noh_event_key *key, int active)
{
    uint32_t h = key->name_hash;
    action a;
    a.kind = active ? h % 10u : 9u;
    a.track = h / 16u % TRACKS;
    a.clip = h / 64u % CLIPS;
    a.speed = (int32_t)(h / 256u % 400000u) - 200000;
    if (a.speed == 0) a.speed = 1;
    a.weight = h / 1024u % 2u ? 1.0f : 0.25f;
    a.tick = (int64_t)(h / 4096u % 20u) - 5;
    return a;
}

typedef struct sim {
    const fixture *f;
    sim_track tracks[TRACKS];
    int actions;
    list out;
    int64_t clock;
} sim;

typedef struct sim_sink {
    sim *s;
    uint32_t track, clip;
    float weight;
} sim_sink;

static void sim_place(sim_track *t, const noh_clip_entry *m, int64_t position)
{
    int64_t end = (int64_t)m->duration_ticks * 65536;
    t->position = position;
    if (t->loop == NOH_LOOP_ONCE || end == 0) t->position = position < 0 ? 0 : position > end ? end : position;
    t->placed = 1;
}

static void sim_act(sim *s, const noh_event_key *key)
{
    action a = action_of(key, s->actions);
    sim_track *t = &s->tracks[a.track];
    const noh_clip_entry *m = &s->f->clips[t->clip];
    int64_t d = (int64_t)m->duration_ticks, cycle = t->loop == NOH_LOOP_PING_PONG ? 2 * d : d;
    switch (a.kind) {
    case 0:
    case 1:
        t->clip = a.clip;
        t->loop = s->f->clips[a.clip].loop;
        t->speed = a.speed;
        t->weight = a.weight;
        t->on = 1;
        sim_place(t, &s->f->clips[a.clip], a.tick * 65536);
        break;
    case 2: t->weight = a.weight; break;
    case 3: t->speed = a.speed; break;
    case 4:
        sim_place(t, m,
                  t->loop == NOH_LOOP_ONCE || d == 0 ? a.tick * 65536
                                                     : (floor_of(t->position, cycle * 65536) * cycle + a.tick) * 65536);
        break;
    case 5: t->on = !t->on; break;
    default: break;
    }
}

static void sim_key(void *user, uint32_t index, int64_t u)
{
    sim_sink *k = user;
    const noh_event_key *key = &k->s->f->keys[k->clip * KEYS + index];
    happening h = { 0, 0, 0, 0 };
    if (k->weight < key->weight_min) return;
    h.clock = k->s->clock;
    h.u = u;
    h.track = k->track;
    h.index = index;
    push(&k->s->out, h);
    sim_act(k->s, key);
}

/* One tick of all tracks. */
static void sim_tick(sim *s)
{
    noh_passage p[TRACKS];
    sim_sink sinks[TRACKS];
    int moved[TRACKS];
    s->clock++;
    for (uint32_t i = 0; i < TRACKS; i++) {
        sim_track *t = &s->tracks[i];
        const noh_clip_entry *m = &s->f->clips[t->clip];
        int64_t end = (int64_t)m->duration_ticks * 65536;
        moved[i] = t->on && t->speed != 0;
        if (!moved[i]) continue;
        p[i].from = t->position;
        p[i].to = t->position + t->speed;
        if (t->loop == NOH_LOOP_ONCE || end == 0) p[i].to = p[i].to < 0 ? 0 : p[i].to > end ? end : p[i].to;
        p[i].duration_ticks = m->duration_ticks;
        p[i].loop = (uint8_t)t->loop;
        p[i].backward = t->speed < 0;
        p[i].placed = (uint8_t)t->placed;
        t->position = p[i].to;
        t->placed = 0;
        sinks[i].s = s;
        sinks[i].track = i;
        sinks[i].clip = t->clip;
        sinks[i].weight = t->weight;
    }
    for (uint32_t i = 0; i < TRACKS; i++) {
        if (moved[i])
            oracle_pass(s->f->keys + sinks[i].clip * KEYS, s->f->clips[sinks[i].clip].event_count, &p[i], sim_key,
                        &sinks[i]);
    }
}

typedef struct play {
    const fixture *f;
    noh_controller *c;
    int actions;
    list out;
} play;

static void play_event(void *user, const noh_event *e)
{
    play *p = user;
    happening h = { 0, 0, 0, 0 };
    action a = action_of(e->key, p->actions);
    noh_track_desc d;
    h.clock = e->clock;
    h.u = e->position_tick;
    h.track = e->track;
    h.index = e->index;
    push(&p->out, h);
    assert_int_equal(e->clock, p->c->clock);
    memset(&d, 0, sizeof d);
    d.clip = a.clip;
    d.speed = a.speed;
    d.weight = a.weight;
    d.position_ticks = a.tick;
    switch (a.kind) {
    case 0:
    case 1: assert_int_equal(noh_controller_start(p->c, &p->f->set, a.track, &d, NULL), NOH_OK); break;
    case 2: assert_int_equal(noh_controller_set_weight(p->c, a.track, a.weight), NOH_OK); break;
    case 3: assert_int_equal(noh_controller_set_speed(p->c, a.track, a.speed), NOH_OK); break;
    case 4:
        assert_int_equal(noh_controller_seek(p->c, &p->f->set, a.track, a.tick, NOH_SEEK_SKIP, NULL), NOH_OK);
        break;
    case 5: {
        int off = noh_controller_track(p->c, a.track)->mode == NOH_TRACK_OFF;
        assert_int_equal(noh_controller_set_mode(p->c, a.track, off ? NOH_TRACK_ON : NOH_TRACK_OFF), NOH_OK);
        break;
    }
    default: break;
    }
    assert_int_equal(noh_controller_step(p->c, &p->f->set, 5, NULL, NULL), 0); /* refused inside */
}

/* A random start, the same for the simulation and for every controller. */
static void start_tracks(uint32_t seed, const fixture *f, sim *s, noh_controller *c)
{
    rng r = { seed };
    for (uint32_t i = 0; i < TRACKS; i++) {
        noh_track_desc d;
        int off = below(&r, 5) == 0;
        memset(&d, 0, sizeof d);
        d.clip = below(&r, CLIPS);
        d.position_ticks = between(&r, -30, 60);
        d.speed = below(&r, 3) ? (int32_t)between(&r, -200000, 200000) : (int32_t)between(&r, -6, 6) * 65536;
        if (d.speed == 0) d.speed = 30000;
        d.weight = below(&r, 3) ? 1.0f : 0.25f;
        d.mode = off ? NOH_TRACK_TIME_ONLY : NOH_TRACK_ON;
        if (s) {
            sim_track *t = &s->tracks[i];
            t->clip = d.clip;
            t->loop = f->clips[d.clip].loop;
            t->speed = d.speed;
            t->weight = d.weight;
            t->on = 1;
            sim_place(t, &f->clips[d.clip], d.position_ticks * 65536);
        } else {
            assert_int_equal(noh_controller_start(c, &f->set, i, &d, NULL), NOH_OK);
        }
    }
}

static uint32_t partition_step(rng *r, uint32_t style)
{
    switch (style) {
    case 0: return 1;
    case 1: return 1u + below(r, 4);
    case 2: return 1u + below(r, 300);
    default: return below(r, 2) ? 1u : 1u + below(r, 40);
    }
}

static uint64_t play_partition(const fixture *f, uint32_t seed, uint32_t style, uint32_t ticks, int actions, play *p,
                               void *memory, size_t bytes)
{
    noh_controller_desc d;
    rng r = { seed ^ (style * 77777u) };
    uint32_t left = ticks;
    uint64_t steps = 0;
    memset(&d, 0, sizeof d);
    d.set = &f->set;
    d.track_count = TRACKS;
    memset(p, 0, sizeof *p);
    p->f = f;
    p->actions = actions;
    assert_int_equal(noh_controller_init(memory, bytes, &d, &p->c, NULL), NOH_OK);
    start_tracks(seed, f, NULL, p->c);
    while (left) {
        uint32_t step = partition_step(&r, style);
        step = step < left ? step : left;
        (void)noh_controller_step(p->c, &f->set, step, play_event, p);
        left -= step;
        steps++;
    }
    return steps;
}

static void every_partition_gives_the_oracles_list(void **state)
{
    static ALIGNED uint8_t memory[2048];
    rng r = { SEED + 1u };
    uint64_t steps = 0, events = 0;
    uint32_t cases = 0, per_loop[4] = { 0, 0, 0, 0 };
    (void)state;
    while (steps < STEPS_WANTED) {
        fixture f;
        sim s;
        uint32_t seed = next(&r), ticks = 100u + below(&r, 900);
        int actions = cases % 2 == 1;
        random_set(&r, &f, cases % 3 ? 40u : 400u);
        assert_int_equal(noh_clip_set_check(&f.set, NULL), NOH_OK);
        memset(&s, 0, sizeof s);
        s.f = &f;
        s.actions = actions;
        start_tracks(seed, &f, &s, NULL);
        for (uint32_t i = 0; i < ticks; i++) sim_tick(&s);
        for (uint32_t style = 0; style < 4; style++) {
            play p;
            steps += play_partition(&f, seed, style, ticks, actions, &p, memory, sizeof memory);
            if (!same_lists(&s.out, &p.out))
                print_message("case %u seed %u style %u: %u against %u\n", cases, seed, style, s.out.count,
                              p.out.count);
            assert_true(same_lists(&s.out, &p.out));
            for (uint32_t i = 0; i < TRACKS; i++)
                assert_int_equal(noh_controller_track(p.c, i)->position, s.tracks[i].position);
            free(p.out.items);
        }
        events += s.out.count;
        per_loop[f.clips[s.tracks[0].clip].loop]++;
        cases++;
        free(s.out.items);
    }
    print_message("%u cases, %lu steps, %lu events in each partition's list; loop modes %u %u %u\n", cases,
                  (unsigned long)steps, (unsigned long)events, per_loop[1], per_loop[2], per_loop[3]);
    assert_true(per_loop[1] && per_loop[2] && per_loop[3] && events > 20000);
}

/* ---- changes over time and sync groups: every partition alike ---- */

static void add_changes(rng *r, const fixture *f, noh_controller *c)
{
    for (uint32_t i = 0; i < 6; i++) {
        noh_change_desc d;
        memset(&d, 0, sizeof d);
        d.kind = (noh_change_kind)below(r, 5);
        d.track = below(r, TRACKS);
        d.delay_ticks = below(r, 300);
        d.duration_ticks = d.kind == NOH_CHANGE_MODE ? 0 : below(r, 3) ? below(r, 500) : below(r, 8);
        d.curve = (noh_curve)below(r, 2);
        d.speed = (int32_t)between(r, -200000, 200000);
        d.weight = (float)below(r, 5) / 4.0f;
        d.position_ticks = between(r, -100, 100);
        d.mode = (noh_track_mode)below(r, 3);
        (void)noh_controller_change(c, &f->set, &d, NULL);
    }
}

static uint64_t play_changes(const fixture *f, uint32_t seed, uint32_t style, uint32_t ticks, int sync, play *p,
                             void *memory, size_t bytes)
{
    noh_controller_desc d;
    rng r = { seed }, cut = { seed ^ (style * 77777u) };
    uint32_t left = ticks;
    uint64_t steps = 0;
    memset(&d, 0, sizeof d);
    d.set = &f->set;
    d.track_count = TRACKS;
    memset(p, 0, sizeof *p);
    p->f = f;
    assert_int_equal(noh_controller_init(memory, bytes, &d, &p->c, NULL), NOH_OK);
    start_tracks(seed, f, NULL, p->c);
    if (sync) {
        for (uint32_t i = 0; i < TRACKS; i++) {
            noh_track_desc t;
            memset(&t, 0, sizeof t);
            t.clip = i;
            t.sync_group = 1;
            t.loop = NOH_LOOP_REPEAT;
            t.weight = 0.2f + (float)i;
            t.speed = 50000 + 30000 * (int32_t)i;
            assert_int_equal(noh_controller_start(p->c, &f->set, i, &t, NULL), NOH_OK);
        }
    }
    add_changes(&r, f, p->c);
    while (left) {
        uint32_t step = partition_step(&cut, style);
        step = step < left ? step : left;
        (void)noh_controller_step(p->c, &f->set, step, play_event, p);
        left -= step;
        steps++;
    }
    return steps;
}

static void compare_changes(rng *r, int sync, uint64_t *steps, uint64_t *events)
{
    static ALIGNED uint8_t memory[2048];
    fixture f;
    play one;
    noh_track last[TRACKS];
    uint32_t seed = next(r), ticks = 200u + below(r, 1200);
    random_set(r, &f, 100);
    for (uint32_t m = 0; sync && m < CLIPS; m++) {
        f.clips[m].duration_ticks = 480u + below(r, 700);
        random_keys(r, f.keys + m * KEYS, f.clips[m].event_count, f.clips[m].duration_ticks);
        f.clips[m].first_marker = 2u * m;
        f.clips[m].marker_count = 2;
        f.markers[2u * m].tick = below(r, 200);
        f.markers[2u * m + 1u].tick = 201u + below(r, 200);
        f.markers[2u * m].id = m % 2u;
        f.markers[2u * m + 1u].id = 1u - m % 2u;
    }
    assert_int_equal(noh_clip_set_check(&f.set, NULL), NOH_OK);
    *steps += play_changes(&f, seed, 0, ticks, sync, &one, memory, sizeof memory);
    memcpy(last, noh_controller_tracks(one.c), sizeof last);
    for (uint32_t style = 1; style < 4; style++) {
        play p;
        *steps += play_changes(&f, seed, style, ticks, sync, &p, memory, sizeof memory);
        if (!same_lists(&one.out, &p.out))
            print_message("seed %u style %u sync %d: %u against %u\n", seed, style, sync, one.out.count, p.out.count);
        assert_true(same_lists(&one.out, &p.out));
        for (uint32_t i = 0; i < TRACKS; i++) {
            assert_int_equal(noh_controller_track(p.c, i)->position, last[i].position);
            assert_memory_equal(&noh_controller_track(p.c, i)->weight, &last[i].weight, sizeof(float));
        }
        free(p.out.items);
    }
    *events += one.out.count;
    free(one.out.items);
}

static void changes_and_sync_do_not_depend_on_the_partition(void **state)
{
    rng r = { SEED + 2u };
    uint64_t steps = 0, events = 0;
    (void)state;
    for (uint32_t i = 0; i < 400; i++) compare_changes(&r, (int)(i % 2), &steps, &events);
    print_message("%lu steps, %lu events\n", (unsigned long)steps, (unsigned long)events);
    assert_true(events > 1000);
}

/* ---- plain cases ---- */

typedef struct one_clip {
    fixture f;
    noh_controller *c;
    ALIGNED uint8_t memory[2048];
    play p;
} one_clip;

static void one_open(one_clip *o, uint32_t duration, noh_loop loop, const uint32_t *ticks, uint32_t count)
{
    rng r = { 1 };
    noh_controller_desc d;
    random_set(&r, &o->f, 10);
    memset(o->f.keys, 0, sizeof o->f.keys);
    o->f.clips[0].duration_ticks = duration;
    o->f.clips[0].loop = loop;
    o->f.clips[0].event_count = count;
    for (uint32_t i = 0; i < count; i++) o->f.keys[i].tick = ticks[i];
    memset(&d, 0, sizeof d);
    d.set = &o->f.set;
    assert_int_equal(noh_controller_init(o->memory, sizeof o->memory, &d, &o->c, NULL), NOH_OK);
    memset(&o->p, 0, sizeof o->p);
    o->p.f = &o->f;
    o->p.c = o->c;
}

static void one_start(one_clip *o, int64_t position, int32_t speed)
{
    noh_track_desc d;
    memset(&d, 0, sizeof d);
    d.position_ticks = position;
    d.speed = speed;
    assert_int_equal(noh_controller_start(o->c, &o->f.set, 0, &d, NULL), NOH_OK);
}

/* Step, and compare the indices delivered with a string of digits. */
static void expect(one_clip *o, uint32_t ticks, const char *indices)
{
    char got[64];
    uint32_t n = 0;
    o->p.out.count = 0;
    noh_controller_step(o->c, &o->f.set, ticks, play_event, &o->p);
    for (uint32_t i = 0; i < o->p.out.count && n < 63; i++) got[n++] = (char)('0' + o->p.out.items[i].index);
    got[n] = 0;
    assert_string_equal(got, indices);
}

static void one_close(one_clip *o)
{
    free(o->p.out.items);
}

static void keys_at_start_end_seam_and_turn(void **state)
{
    static const uint32_t ticks[] = { 0, 5, 5, 10 };
    one_clip o;
    (void)state;
    one_open(&o, 10, NOH_LOOP_REPEAT, ticks, 4);
    o.p.actions = 0;
    one_start(&o, 0, NOH_SPEED_ONE);
    expect(&o, 1, "0");
    expect(&o, 3, "");
    expect(&o, 1, "12");
    expect(&o, 5, "30"); /* the end, then the next start */
    expect(&o, 20, "12301230");
    one_start(&o, 10, -NOH_SPEED_ONE);
    expect(&o, 1, "3");
    expect(&o, 4, "12"); /* backwards, equal ticks keep their order */
    expect(&o, 5, "03");
    one_close(&o);
    one_open(&o, 10, NOH_LOOP_PING_PONG, ticks, 4);
    one_start(&o, 0, NOH_SPEED_ONE);
    expect(&o, 40,
           "0123120"
           "123120");
    one_close(&o);
    one_open(&o, 10, NOH_LOOP_ONCE, ticks, 4);
    one_start(&o, 0, NOH_SPEED_ONE);
    expect(&o, 9, "012");
    expect(&o, 1000, "3");
    expect(&o, 1000, "");
    one_start(&o, 10, 0x7fffffff > NOH_SPEED_MAX ? -NOH_SPEED_MAX : 0);
    expect(&o, 1, "3120");
    one_close(&o);
    one_open(&o, 0, NOH_LOOP_REPEAT, ticks, 1); /* a single pose */
    one_start(&o, 0, NOH_SPEED_ONE);
    expect(&o, 100, "0");
    expect(&o, 100, "");
    one_close(&o);
}

static void turning_back_passes_again_what_was_passed(void **state)
{
    static const uint32_t ticks[] = { 5 };
    one_clip o;
    (void)state;
    one_open(&o, 10, NOH_LOOP_REPEAT, ticks, 1);
    one_start(&o, 0, NOH_SPEED_ONE);
    expect(&o, 5, "0");
    noh_controller_set_speed(o.c, 0, -NOH_SPEED_ONE);
    expect(&o, 3, ""); /* arrived at before, only left now */
    noh_controller_set_speed(o.c, 0, NOH_SPEED_ONE);
    expect(&o, 4, "0");
    noh_controller_set_speed(o.c, 0, -NOH_SPEED_ONE);
    expect(&o, 1, "0"); /* from 6 back to 5 */
    one_close(&o);
}

static void a_seek_skips_or_fires(void **state)
{
    static const uint32_t ticks[] = { 2, 4, 6, 8 };
    one_clip o;
    noh_error error;
    (void)state;
    one_open(&o, 10, NOH_LOOP_REPEAT, ticks, 4);
    one_start(&o, 0, NOH_SPEED_ONE);
    assert_int_equal(noh_controller_seek(o.c, &o.f.set, 0, 6, NOH_SEEK_SKIP, &error), NOH_OK);
    expect(&o, 1, "2"); /* what lies at the target fires as play leaves it */
    one_start(&o, 0, NOH_SPEED_ONE);
    assert_int_equal(noh_controller_seek(o.c, &o.f.set, 0, 6, NOH_SEEK_FIRE, &error), NOH_OK);
    expect(&o, 1, "012");
    assert_int_equal(noh_controller_track(o.c, 0)->position, 6 * 65536);
    expect(&o, 2, "3");
    assert_int_equal(noh_controller_seek(o.c, &o.f.set, 0, -5, NOH_SEEK_FIRE, &error), NOH_OK);
    expect(&o, 1, "21032"); /* from 8, itself passed before, back into the pass before */
    assert_int_equal(noh_controller_track(o.c, 0)->position, -5 * 65536);
    assert_int_equal(noh_controller_seek(o.c, &o.f.set, 9, 0, NOH_SEEK_FIRE, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, "track", strlen("track")), 0);
    assert_int_equal(noh_controller_seek(o.c, &o.f.set, 0, (int64_t)1 << 50, NOH_SEEK_SKIP, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, "tick", strlen("tick")), 0);
    assert_int_equal(noh_controller_seek(o.c, &o.f.set, 0, 0, (noh_seek)7, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, "policy", strlen("policy")), 0);
    one_close(&o);
}

static void keys_need_their_smallest_weight(void **state)
{
    static const uint32_t ticks[] = { 2, 4, 6 };
    one_clip o;
    (void)state;
    one_open(&o, 10, NOH_LOOP_REPEAT, ticks, 3);
    o.f.keys[1].weight_min = 0.5f;
    one_start(&o, 0, NOH_SPEED_ONE);
    noh_controller_set_weight(o.c, 0, 0.5f);
    expect(&o, 10, "012");
    noh_controller_set_weight(o.c, 0, 0.4999f);
    expect(&o, 10, "02");
    noh_controller_set_mode(o.c, 0, NOH_TRACK_TIME_ONLY); /* time runs, keys fire, nothing is sampled */
    expect(&o, 10, "02");
    noh_controller_set_mode(o.c, 0, NOH_TRACK_OFF);
    expect(&o, 100, "");
    one_close(&o);
}

static void keys_are_ordered_by_time_then_track(void **state)
{
    static const uint32_t ticks[] = { 2, 4 };
    one_clip o;
    noh_track_desc d;
    (void)state;
    one_open(&o, 10, NOH_LOOP_REPEAT, ticks, 2);
    memset(&d, 0, sizeof d);
    d.position_ticks = 1;
    assert_int_equal(noh_controller_start(o.c, &o.f.set, 2, &d, NULL), NOH_OK);
    one_start(&o, 0, NOH_SPEED_ONE);
    noh_controller_step(o.c, &o.f.set, 4, play_event, &o.p);
    assert_int_equal(o.p.out.count, 4);
    assert_int_equal(o.p.out.items[0].track, 2); /* tick 1 */
    assert_int_equal(o.p.out.items[1].track, 0); /* tick 2 */
    assert_int_equal(o.p.out.items[2].track, 2); /* tick 3 */
    assert_int_equal(o.p.out.items[3].track, 0); /* tick 4 */
    one_close(&o);
}

static void a_step_without_callback_or_time(void **state)
{
    static const uint32_t ticks[] = { 2 };
    one_clip o;
    (void)state;
    one_open(&o, 10, NOH_LOOP_REPEAT, ticks, 1);
    one_start(&o, 3, NOH_SPEED_ONE);
    expect(&o, 0, "");
    assert_int_equal(noh_controller_step(o.c, &o.f.set, 100, NULL, NULL), 10);
    assert_int_equal(o.c->events_high_water, 10);
    one_close(&o);
}

/* A step far longer than anything sane: bounded work, right count. */
static void a_day_passes_in_one_step(void **state)
{
    static const uint32_t ticks[] = { 2, 7 };
    one_clip o;
    uint32_t day = 24u * 3600u * 1000u;
    (void)state;
    one_open(&o, 1000, NOH_LOOP_REPEAT, ticks, 2);
    one_start(&o, 0, NOH_SPEED_ONE);
    assert_int_equal(noh_controller_step(o.c, &o.f.set, day, NULL, NULL), 2u * (day / 1000u));
    one_close(&o);
}

/* The most times that a key fires in one step, however long; time advances all the same. */
static void a_step_is_bounded(void **state)
{
    static const uint32_t ticks[] = { 0, 0, 1 };
    one_clip o;
    (void)state;
    for (int way = -1; way <= 1; way += 2) {
        one_open(&o, 1, NOH_LOOP_REPEAT, ticks, 3);
        one_start(&o, 0, way * NOH_SPEED_MAX);
        assert_int_equal(noh_controller_step(o.c, &o.f.set, UINT32_MAX, NULL, NULL), NOH_STEP_EVENTS_MAX);
        assert_int_equal(o.c->clock, UINT32_MAX);
        assert_true(o.c->flags & NOH_CONTROLLER_EVENTS_CUT);
        assert_int_equal(noh_controller_step(o.c, &o.f.set, 2, NULL, NULL),
                         3 * 2 * 256); /* and the next step is whole again */
        assert_false(o.c->flags & NOH_CONTROLLER_EVENTS_CUT);
        one_start(&o, 0, NOH_SPEED_ONE);
        assert_int_equal(noh_controller_seek(o.c, &o.f.set, 0, way * ((int64_t)1 << 43), NOH_SEEK_FIRE, NULL), NOH_OK);
        assert_int_equal(noh_controller_step(o.c, &o.f.set, 1, NULL, NULL), NOH_STEP_EVENTS_MAX);
        one_close(&o);
    }
}

/* The limit keeps the beginning of the list, in every loop mode and direction. */
static void a_limit_cuts_the_list(void **state)
{
    rng r = { SEED + 5u };
    (void)state;
    for (int round = 0; round < 2000; round++) {
        fixture f;
        list all = { NULL, 0, 0 }, some = { NULL, 0, 0 };
        const noh_clip_entry *m = &f.clips[0];
        noh_passage p;
        uint32_t limit, passed;
        random_set(&r, &f, 12u);
        p = random_passage(&r, m);
        passed = noh_events_pass(f.keys, m->event_count, &p, UINT32_MAX, collect, &all);
        assert_int_equal(passed, all.count);
        limit = below(&r, passed + 3u);
        passed = noh_events_pass(f.keys, m->event_count, &p, limit, collect, &some);
        assert_int_equal(passed, limit < all.count ? limit : all.count);
        all.count = passed;
        assert_true(same_lists(&all, &some));
        free(all.items);
        free(some.items);
    }
}

/* Clocks at the end of their range stop there: nothing overflows, waits for ever or fires without end. */
static void clocks_stop_at_the_end(void **state)
{
    static const uint32_t ticks[] = { 2, 700 };
    one_clip o;
    noh_change_desc d;
    (void)state;
    one_open(&o, 1000, NOH_LOOP_REPEAT, ticks, 2);
    one_start(&o, 0, NOH_SPEED_ONE);
    o.c->clock = INT64_MAX - 2500;
    memset(&d, 0, sizeof d);
    d.kind = NOH_CHANGE_WEIGHT;
    d.delay_ticks = 100;
    d.duration_ticks = UINT32_MAX;
    assert_int_equal(noh_controller_change(o.c, &o.f.set, &d, NULL), NOH_OK);
    d.kind = NOH_CHANGE_SPEED;
    d.speed = 2 * NOH_SPEED_ONE;
    d.delay_ticks = UINT32_MAX;
    assert_int_equal(noh_controller_change(o.c, &o.f.set, &d, NULL), NOH_OK);
    assert_int_equal(noh_controller_step(o.c, &o.f.set, 2000, NULL, NULL), 4);
    assert_int_equal(noh_controller_step(o.c, &o.f.set, 2000, NULL, NULL), 1);
    assert_int_equal(o.c->clock, INT64_MAX);
    assert_int_equal(noh_controller_step(o.c, &o.f.set, UINT32_MAX, NULL, NULL), 0);
    assert_int_equal(noh_controller_track(o.c, 0)->position, noh_position_of(2500));
    one_close(&o);
    one_open(&o, 1000, NOH_LOOP_REPEAT, ticks, 2); /* likewise a sync group, which has a grid of its own */
    for (uint32_t i = 0; i < 2; i++) {
        noh_track_desc t;
        memset(&t, 0, sizeof t);
        t.sync_group = 1;
        assert_int_equal(noh_controller_start(o.c, &o.f.set, i, &t, NULL), NOH_OK);
    }
    o.c->clock = INT64_MAX - 500;
    assert_int_equal(noh_controller_step(o.c, &o.f.set, 4000, NULL, NULL), 2);
    assert_int_equal(o.c->clock, INT64_MAX);
    one_close(&o);
}

/* Repeated seeks, each from the pass that the track is in, stay in range. */
static void seeks_add_up_within_range(void **state)
{
    static const uint32_t ticks[] = { 2 };
    one_clip o;
    (void)state;
    one_open(&o, 1000, NOH_LOOP_REPEAT, ticks, 1);
    one_start(&o, 0, NOH_SPEED_ONE);
    for (int i = 0; i < 1000; i++) {
        assert_int_equal(noh_controller_seek(o.c, &o.f.set, 0, (int64_t)1 << 43, NOH_SEEK_SKIP, NULL), NOH_OK);
        assert_true(noh_controller_track(o.c, 0)->position <= NOH_POSITION_MAX);
    }
    assert_int_equal(noh_controller_step(o.c, &o.f.set, 1000, NULL, NULL), 1);
    one_close(&o);
}

/* ---- errors of the sources ---- */

/* A test of "is the key in this frame's [t0, t1] of wrapped times" fires twice on a
 * frame's edge, loses keys over the seam and all but one of several loops. */
static void keys_fire_once_however_frames_fall(void **state)
{
    static const uint32_t ticks[] = { 5 };
    one_clip o;
    uint32_t naive = 0, ours = 0, t = 0;
    (void)state;
    one_open(&o, 10, NOH_LOOP_REPEAT, ticks, 1);
    one_start(&o, 0, NOH_SPEED_ONE);
    for (uint32_t i = 0; i < 40; i++) {
        uint32_t step = i % 4u * 10u + 5u, to = (t + step) % 10u;
        naive += t <= 5u && 5u <= to;
        t = to;
        ours += noh_controller_step(o.c, &o.f.set, step, NULL, NULL);
    }
    assert_int_equal(ours, 40u * 20u / 10u); /* 800 ticks */
    assert_int_not_equal(naive, ours);
    one_close(&o);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(passages_follow_the_definition),
        cmocka_unit_test(every_partition_gives_the_oracles_list),
        cmocka_unit_test(changes_and_sync_do_not_depend_on_the_partition),
        cmocka_unit_test(keys_at_start_end_seam_and_turn),
        cmocka_unit_test(turning_back_passes_again_what_was_passed),
        cmocka_unit_test(a_seek_skips_or_fires),
        cmocka_unit_test(keys_need_their_smallest_weight),
        cmocka_unit_test(keys_are_ordered_by_time_then_track),
        cmocka_unit_test(a_step_without_callback_or_time),
        cmocka_unit_test(a_day_passes_in_one_step),
        cmocka_unit_test(a_step_is_bounded),
        cmocka_unit_test(a_limit_cuts_the_list),
        cmocka_unit_test(clocks_stop_at_the_end),
        cmocka_unit_test(seeks_add_up_within_range),
        cmocka_unit_test(keys_fire_once_however_frames_fall),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
