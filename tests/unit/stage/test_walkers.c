/* Walkers: actors that go where agents of a crowd go. How far feet that stand slide is measured on the joints that are
 * shown, at several speeds and frame rates. NOH_WALKERS_PACK names another pack to measure, with clips walk and run. */
#include "support/stage_fixture.h"

#include <math.h>

#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/crowd.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "stage/cast/stage_internal.h"
#include "stage/actors/walkers_internal.h"

#define RADIUS 0.25f

typedef struct street {
    cast cast;
    noh_kind_feet feet;
    noh_modifier part;
    noh_world world;
    noh_plane floor;
    noh_crowd *crowd;
    noh_walkers *walkers;
    void *crowd_memory, *walkers_memory;
    size_t crowd_bytes;
    uint32_t count, ticks;
    int own_speed;  /* 1: clips play at their own, as the source has them */
    uint32_t dolls; /* who may fall at once; 0: nobody does */
    noh_kind_ragdoll ragdoll;
} street;

/* ---- a street ---- */

static void map_pack(street *s)
{
    const char *other = getenv("NOH_WALKERS_PACK");
    noh_ragdoll_source source;
    noh_error said;
    if (other) {
        if (noh_file_map(other, &s->cast.files[0], &said) != NOH_OK) fail_msg("%s: %s", other, said.what);
        s->cast.packs[0] = test_open(s->cast.files[0].data, s->cast.files[0].bytes);
    } else {
        cast_map(&s->cast, PUPPETS, s->dolls ? "demo/puppet_falls.noh" : "demo/puppet_levels.noh");
    }
    memset(&source, 0, sizeof source);
    source.pack = &s->cast.packs[0];
    source.metres = 1.0f;
    assert_int_equal(noh_pack_skeleton_at(source.pack, 0, &source.joints, NULL, NULL), NOH_OK);
    if (noh_feet_rig_make(&source, &s->feet.rig, &said) != NOH_OK) fail_msg("rig: %s", said.what);
}

static void make_crowd(street *s, uint32_t jobs)
{
    noh_crowd_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.agent_max = s->count;
    desc.job_count = jobs;
    desc.origin[0] = desc.origin[1] = -20.0f;
    desc.extent[0] = desc.extent[1] = 40.0f;
    s->crowd_bytes = noh_crowd_size(&desc);
    s->crowd_memory = test_aligned(NULL, s->crowd_bytes);
    assert_int_equal(noh_crowd_init(s->crowd_memory, noh_crowd_size(&desc), &desc, &s->crowd, NULL), NOH_OK);
}

static noh_walkers_desc walkers_desc(const street *s, uint32_t near_max)
{
    noh_walkers_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.walker_max = s->count;
    desc.near_max = near_max;
    desc.feet_modifier = 1;
    desc.walk = "walk";
    desc.idle = noh_stage_find(s->cast.stage, 0, NOH_NAME_CLIP, "idle") == NOH_NONE ? NULL : "idle";
    desc.run = noh_stage_find(s->cast.stage, 0, NOH_NAME_CLIP, "run") == NOH_NONE ? NULL : "run";
    return desc;
}

static void open_street_of(street *s, uint32_t count, uint32_t near_max, uint32_t jobs, uint32_t dolls)
{
    static const noh_layer_desc layers[] = { { "body", NOH_LAYER_BASE, NULL, NULL, 3 },
                                             { "act", NOH_LAYER_OVER, NULL, NULL, 2 } };
    noh_error said;
    memset(s, 0, sizeof *s);
    s->dolls = dolls;
    map_pack(s);
    s->floor.normal[1] = 1.0f;
    s->world.planes = &s->floor;
    s->world.plane_count = 1;
    s->world.friction = 0.6f;
    s->feet.ground.world = &s->world;
    s->part = noh_walkers_feet_modifier(&s->feet);
    s->count = count;
    noh_kind_desc *k = &s->cast.kinds[0];
    k->mesh = &s->cast.packs[0];
    k->actor_count = count;
    k->layers = layers;
    k->layer_count = dolls ? 2u : 1u;
    s->ragdoll.count = dolls;
    s->ragdoll.world = &s->world;
    k->ragdoll = noh_ragdoll_module(dolls ? &s->ragdoll : NULL);
    k->inertia = dolls != 0;
    k->root_axes = NOH_ROOT_X | NOH_ROOT_Z | NOH_ROOT_BY_GAME;
    k->modifiers = &s->part;
    k->modifier_count = 1;
    s->cast.desc.kinds = s->cast.kinds;
    s->cast.desc.kind_count = 1;
    s->cast.desc.job_count = jobs;
    s->cast.desc.full_detail = 1;
    cast_make(&s->cast, NULL);
    make_crowd(s, jobs);
    const noh_walkers_desc desc = walkers_desc(s, near_max);
    s->walkers_memory = test_aligned(NULL, noh_walkers_size(&desc));
    if (noh_walkers_init(s->walkers_memory, noh_walkers_size(&desc), &desc, s->cast.stage, &s->walkers, &said)) {
        fail_msg("walkers: %s", said.what);
    }
}

static void open_street(street *s, uint32_t count, uint32_t near_max, uint32_t jobs)
{
    open_street_of(s, count, near_max, jobs, 0);
}

static void close_street(street *s)
{
    cast_close_stage(&s->cast);
    noh_file_unmap(&s->cast.files[0]);
    free(s->crowd_memory);
    free(s->walkers_memory);
}

static noh_actor enter(street *s, uint32_t index, const float at[2], const float goal[2], float speed)
{
    const noh_crowd_agent agent = { { at[0], at[1] }, { 0, 0 }, { goal[0], goal[1] }, RADIUS, speed, 0, index };
    const float x = goal[0] - at[0], z = goal[1] - at[1], length = hypotf(x, z);
    const float heading[2] = { x / length, z / length };
    noh_appearance look;
    noh_actor actor;
    noh_error said;
    memset(&look, 0, sizeof look);
    look.posed = 1;
    assert_int_equal(noh_crowd_add(s->crowd, index, &agent, NULL), NOH_OK);
    assert_int_equal(noh_stage_spawn(s->cast.stage, 0, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(s->cast.stage, actor, &look, NULL), NOH_OK);
    if (noh_walkers_add(s->walkers, index, s->cast.stage, actor, index, heading, &said)) fail_msg("%s", said.what);
    return actor;
}

static noh_controller *controller_of(street *s, uint32_t index)
{
    return noh_actor_controller(s->cast.stage, noh_stage_actor_at(s->cast.stage, index), NULL);
}

static void frame(street *s, uint32_t ticks)
{
    static const float eye[3] = { 0.0f, 2.0f, 0.0f };
    noh_stage_view view;
    noh_crowd_agent agent;
    (void)noh_crowd_step(s->crowd, ticks);
    assert_int_equal(noh_walkers_step(s->walkers, s->crowd, s->cast.stage, NULL, ticks, NULL), NOH_OK);
    if (s->own_speed) (void)noh_controller_set_speed(controller_of(s, 0), 0, 65536);
    assert_int_equal(noh_stage_step(s->cast.stage, ticks, NULL, NULL, NULL), NOH_OK);
    (void)noh_walkers_near(s->walkers, s->cast.stage, eye);
    assert_true(noh_crowd_agent_at(s->crowd, 0, &agent));
    const float middle[3] = { agent.position[0], 1.0f, agent.position[1] };
    noh_view_orbit(&view, middle, 0.5f, 0.3f, 4.0f, 640, 360);
    assert_int_equal(noh_stage_frame_begin(s->cast.stage, &view, 1, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame_end(s->cast.stage, NULL), NOH_OK);
    s->ticks += ticks;
}

/* ---- slides ---- */

#define SLIDES_MAX 4096u
#define DOWN_M 0.0003f /* above the lowest point of both feet: a part of a foot that is down */
#define UP_M 0.001f    /* likewise: a foot whose lowest part is higher has been lifted */

/* A foot of an actor, from where it comes down to where it is lifted. */
typedef struct stance {
    uint32_t is_down, counts;
    float was[3][3], slid[2];
} stance;

/* Both feet count while they are down. What slides is the part that moves the least of those on the ground: a foot that
 * turns about its heel or its ball does not. */
typedef struct slides {
    stance feet[NOH_FEET_LEGS_MAX];
    uint32_t steps, lengths, ready;
    int lower_alone; /* 1: the other foot does not count: captured ones slide while both are down */
    float landed[2];
    float sum, worst;       /* of what whole steps slid, metres */
    float length;           /* of all of `lengths`, from where one foot came down to where the next did */
    uint32_t small;         /* of these, those that slid by at most 3 % of a step of 0.426 m */
    float each[SLIDES_MAX]; /* what they slid */
    float lag, lag_sum;     /* from the agent: the longest, and the sum of all frames */
    uint32_t frames;
} slides;

static void parts_of(const street *s, noh_actor actor, uint32_t leg, float out[3][3])
{
    for (uint32_t p = 0; p < 3; p++) {
        float lowest = 1e9f;
        memset(out[p], 0, sizeof out[p]);
        for (uint32_t side = 0; side < 2; side++) {
            const noh_feet_point *point = &s->feet.rig.legs[leg].points[2u * p + side];
            float m[12], y;
            assert_int_equal(noh_actor_joint(s->cast.stage, actor, point->joint, m, NULL), NOH_OK);
            for (int i = 0; i < 3; i++) {
                out[p][i] += 0.5f * (m[4 * i] * point->at[0] + m[4 * i + 1] * point->at[1] +
                                     m[4 * i + 2] * point->at[2] + m[4 * i + 3]);
            }
            y = m[4] * point->at[0] + m[5] * point->at[1] + m[6] * point->at[2] + m[7];
            lowest = y < lowest ? y : lowest;
        }
        out[p][1] = lowest;
    }
}

static uint32_t lowest_of(float parts[3][3])
{
    uint32_t lowest = 0;
    for (uint32_t p = 1; p < 3; p++) lowest = parts[p][1] < parts[lowest][1] ? p : lowest;
    return lowest;
}

static void lift(slides *m, stance *f)
{
    const float slid = hypotf(f->slid[0], f->slid[1]);
    f->is_down = 0;
    if (!f->counts) return;
    m->sum += slid;
    m->worst = fmaxf(m->worst, slid);
    if (m->steps < SLIDES_MAX) m->each[m->steps] = slid;
    m->steps++;
    m->small += slid <= 0.03f * 0.426f ? 1u : 0u;
}

static void land(slides *m, stance *f, const float at[3])
{
    f->counts = m->ready > (m->lower_alone ? 0u : 1u); /* the first step began before */
    if (m->ready > 1) {
        m->length += hypotf(at[0] - m->landed[0], at[2] - m->landed[1]);
        m->lengths++;
    }
    m->ready++;
    m->landed[0] = at[0];
    m->landed[1] = at[2];
    f->is_down = 1;
    f->slid[0] = f->slid[1] = 0.0f;
}

/* What the part that moves the least of those on the ground moved. */
static void slide(stance *f, float parts[3][3], float ground)
{
    const uint32_t low = lowest_of(parts);
    float by[2] = { parts[low][0] - f->was[low][0], parts[low][2] - f->was[low][2] };
    for (uint32_t p = 0; p < 3; p++) {
        const float x = parts[p][0] - f->was[p][0], z = parts[p][2] - f->was[p][2];
        if (parts[p][1] > ground + DOWN_M || hypotf(x, z) >= hypotf(by[0], by[1])) continue;
        by[0] = x;
        by[1] = z;
    }
    for (int i = 0; i < 2; i++) f->slid[i] += by[i];
}

static void measure(const street *s, noh_actor actor, slides *m)
{
    float parts[NOH_FEET_LEGS_MAX][3][3], ground = 1e9f;
    for (uint32_t l = 0; l < 2; l++) {
        parts_of(s, actor, l, parts[l]);
        ground = fminf(ground, parts[l][lowest_of(parts[l])][1]);
    }
    for (uint32_t l = 0; l < 2; l++) {
        stance *f = &m->feet[l];
        const float *low = parts[l][lowest_of(parts[l])], other = parts[1u - l][lowest_of(parts[1u - l])][1];
        if (f->is_down && low[1] > ground + (m->lower_alone ? DOWN_M : UP_M)) lift(m, f);
        if (f->is_down) slide(f, parts[l], ground);
        if (!f->is_down && low[1] <= (m->lower_alone ? other - DOWN_M : ground + DOWN_M)) land(m, f, low);
        memcpy(f->was, parts[l], sizeof f->was);
    }
}

static int by_size(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

/* ---- in parts of a step ---- */

static float step_of(const slides *m)
{
    return m->length / (float)(m->lengths ? m->lengths : 1u);
}

static float mean_slide(const slides *m)
{
    return m->steps ? m->sum / (float)m->steps / step_of(m) : 1e9f;
}

/* What 95 of 100 steps slide by at most. */
static float most_slide(const slides *m)
{
    static float each[SLIDES_MAX];
    const uint32_t count = m->steps < SLIDES_MAX ? m->steps : SLIDES_MAX;
    memcpy(each, m->each, sizeof each);
    qsort(each, count, sizeof *each, by_size);
    return each[count * 95u / 100u] / step_of(m);
}

static float worst_slide(const slides *m)
{
    return m->worst / step_of(m);
}

static void tell(const char *name, float speed, uint32_t rate, const slides *m)
{
    printf(
        "  %-22s %.2f m/s, %3u Hz: %3u steps of %.3f m, slide %.2f %%, 95 of 100 %.2f %%, at worst %.2f %%; %u small; "
        "%.0f mm behind, at most %.0f\n",
        name, (double)speed, rate, m->steps, (double)step_of(m), 100.0 * (double)mean_slide(m),
        100.0 * (double)most_slide(m), 100.0 * (double)worst_slide(m), m->small,
        1000.0 * (double)(m->lag_sum / (float)(m->frames ? m->frames : 1u)), 1000.0 * (double)m->lag);
}

/* From where its agent is. */
static void measure_lag(const street *s, noh_actor actor, uint32_t agent, slides *m)
{
    noh_crowd_agent a;
    noh_place place;
    assert_true(noh_crowd_agent_at(s->crowd, agent, &a));
    assert_int_equal(noh_actor_place(s->cast.stage, actor, &place, NULL), NOH_OK);
    const float lag = hypotf(place.position[0] - a.position[0], place.position[2] - a.position[1]);
    m->lag = fmaxf(m->lag, lag);
    m->lag_sum += lag;
    m->frames++;
}

/* Straight on, from second `from` to `to` of a walk that begins and ends with standing. */
static slides walk_straight(float speed, uint32_t rate, float from, float to, uint32_t near_max)
{
    const float way = speed * 12.0f, start[2] = { 0.0f, -0.5f * way }, goal[2] = { 0.3f * way, 0.5f * way };
    slides m;
    street s;
    memset(&m, 0, sizeof m);
    m.lower_alone = getenv("NOH_WALKERS_PACK") != NULL;
    open_street(&s, 1, near_max, 1);
    const noh_actor actor = enter(&s, 0, start, goal, speed);
    while ((float)s.ticks < 48000.0f * to) {
        frame(&s, 48000u / rate);
        if ((float)s.ticks >= 48000.0f * from) measure(&s, actor, &m);
    }
    close_street(&s);
    return m;
}

/* An agent at nine tenths of a metre a second, its walk as fast as it was made, at half a metre. */
static void clips_play_by_the_way_walked(void **state)
{
    static const float start[2] = { 0.0f, -5.0f }, goal[2] = { 0.0f, 5.0f };
    float share[2];
    (void)state;
    if (getenv("NOH_WALKERS_PACK")) return;
    for (int literal = 0; literal < 2; literal++) {
        slides m;
        street s;
        memset(&m, 0, sizeof m);
        open_street(&s, 1, 0, 1);
        s.own_speed = literal;
        const noh_actor actor = enter(&s, 0, start, goal, 0.9f);
        for (uint32_t f = 0; f < 420; f++) {
            frame(&s, CAST_STEP);
            if (f > 60) measure(&s, actor, &m);
        }
        tell(literal ? "at its own speed" : "as fast as it goes", 0.9f, 60, &m);
        share[literal] = mean_slide(&m);
        close_street(&s);
    }
    assert_true(share[0] <= 0.03f && share[1] > 0.25f);
}

static void feet_that_stand_do_not_slide(void **state)
{
    static const float speeds[] = { 0.2f, 0.35f, 0.5f, 0.75f, 1.0f };
    static const uint32_t rates[] = { 24, 60, 144 };
    const int is_other = getenv("NOH_WALKERS_PACK") != NULL;
    (void)state;
    for (uint32_t i = 0; i < 15; i++) {
        const float speed = is_other ? 0.6f + 0.5f * speeds[i / 3] : speeds[i / 3];
        /* a clip that is no loop jumps at its end: within its first pass */
        const slides m = walk_straight(speed, rates[i % 3], is_other ? 0.6f : 2.0f, is_other ? 2.6f / speed : 10.0f,
                                       (uint32_t)is_other);
        tell(is_other ? "straight on, held" : "straight on", speed, rates[i % 3], &m);
        assert_true(m.steps > 0 && mean_slide(&m) <= 0.03f && (is_other || worst_slide(&m) <= 0.03f));
    }
}

/* ---- a crowd ----
 * Agents turn on the spot, and are pushed aside: bodies follow on their feet, within a few centimetres, by clips alone
 * and with feet on the ground (of every second scene). */

#define COUNT 24u

static float chance(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (float)(*seed >> 8) / 16777216.0f;
}

/* Across a circle, through a knot in the middle; or to and from random places of a square. */
static void fill(street *s, int is_circle, noh_actor actors[COUNT])
{
    uint32_t seed = 5;
    for (uint32_t i = 0; i < COUNT; i++) {
        const float angle = 6.2831853f * (float)i / (float)COUNT, x = 4.0f * cosf(angle), z = 4.0f * sinf(angle);
        const float at[2] = { is_circle ? x : 10.0f * chance(&seed), is_circle ? z : 10.0f * chance(&seed) };
        const float goal[2] = { is_circle ? -x : 10.0f * chance(&seed), is_circle ? -z : 10.0f * chance(&seed) };
        actors[i] = enter(s, i, at, goal, 0.5f + 0.02f * (float)i);
    }
}

/* is_ahead: to places that are not behind it, as far as twenty tries find one. */
static void aim_again(street *s, int is_ahead, uint32_t *seed)
{
    for (uint32_t i = 0; i < COUNT; i++) {
        noh_crowd_agent a;
        assert_true(noh_crowd_agent_at(s->crowd, i, &a));
        if (hypotf(a.goal[0] - a.position[0], a.goal[1] - a.position[1]) > 0.5f) continue;
        for (int try = 0; try < 20; try++) {
            const float x = 10.0f * chance(seed), goal[2] = { x, 10.0f * chance(seed) };
            float heading[2];
            assert_true(noh_walkers_heading(s->walkers, i, heading));
            noh_crowd_set_goal(s->crowd, i, goal);
            const float way[2] = { goal[0] - a.position[0], goal[1] - a.position[1] };
            if (!is_ahead || way[0] * heading[0] + way[1] * heading[1] > 0.7f * hypotf(way[0], way[1])) break;
        }
    }
}

enum { KNOT, ANYWHERE, AHEAD };

static slides mill(const char *name, int where, uint32_t near_max)
{
    static slides m[COUNT];
    noh_actor actors[COUNT];
    slides all;
    uint32_t seed = 9;
    street s;
    memset(m, 0, sizeof m);
    memset(&all, 0, sizeof all);
    open_street(&s, COUNT, near_max, 1);
    fill(&s, where == KNOT, actors);
    for (uint32_t f = 0; f < 900; f++) {
        if (where != KNOT) aim_again(&s, where == AHEAD, &seed);
        frame(&s, CAST_STEP);
        for (uint32_t i = 0; i < COUNT && f > 60; i += 3) {
            measure(&s, actors[i], &m[i]);
            measure_lag(&s, actors[i], i, &m[i]);
        }
    }
    for (uint32_t i = 0; i < COUNT; i++) {
        for (uint32_t n = 0; n < m[i].steps && all.steps + n < SLIDES_MAX; n++) all.each[all.steps + n] = m[i].each[n];
        all.lag = fmaxf(all.lag, m[i].lag);
        all.lag_sum += m[i].lag_sum;
        all.frames += m[i].frames;
        all.steps += m[i].steps;
        all.sum += m[i].sum;
        all.length += m[i].length;
        all.lengths += m[i].lengths;
        all.small += m[i].small;
        all.worst = fmaxf(all.worst, m[i].worst);
    }
    tell(name, 0.7f, 60, &all);
    close_street(&s);
    return all;
}

static void feet_do_not_slide_in_a_crowd(void **state)
{
    (void)state;
    if (getenv("NOH_WALKERS_PACK")) return;
    static const char *const names[] = { "a knot", "with U-turns", "a square" };
    static const int wheres[] = { KNOT, ANYWHERE, AHEAD };
    for (uint32_t i = 0; i < 6; i++) {
        const slides m = mill(names[i / 2u], wheres[i / 2u], i % 2u ? COUNT : 0);
        assert_true(m.steps > (i < 2 ? 50u : 100u) && mean_slide(&m) <= 0.01f);
        assert_true(most_slide(&m) <= 0.015f && worst_slide(&m) <= 0.03f);
        assert_true(m.lag <= 0.701f && m.lag_sum <= 0.1f * (float)m.frames);
    }
}

/* ---- bits, bytes, and what is refused ---- */

/* Any number of jobs gives the same bits; and so do copies of crowd, walkers and stage that are put back. */
static void walkers_are_the_same_for_any_number_of_jobs(void **state)
{
    uint64_t want = 0;
    (void)state;
    if (getenv("NOH_WALKERS_PACK")) return;
    for (uint32_t jobs = 1; jobs <= 4; jobs += 3) {
        noh_actor actors[COUNT];
        size_t bytes;
        street s;
        open_street(&s, COUNT, 5, jobs);
        fill(&s, 1, actors);
        for (uint32_t f = 0; f < 120; f++) frame(&s, 700u);
        const noh_walkers_desc desc = walkers_desc(&s, 5);
        const size_t own = noh_walkers_size(&desc), crowd = s.crowd_bytes;
        uint8_t *stage = test_aligned(noh_stage_state(s.cast.stage, &bytes), (size_t)s.cast.plan.state_bytes);
        uint8_t *walkers = test_aligned(s.walkers_memory, own), *agents = test_aligned(s.crowd_memory, crowd);
        for (int again = 0; again < 2; again++) {
            for (uint32_t f = 0; f < 90; f++) frame(&s, 700u);
            const uint64_t hash = noh_stage_hash(s.cast.stage) + noh_crowd_hash(s.crowd);
            if (!want) want = hash;
            if (hash != want) fail_msg("%u jobs, run %d", jobs, again);
            assert_int_equal(noh_stage_set_state(s.cast.stage, stage, bytes, NULL), NOH_OK);
            memcpy(s.walkers_memory, walkers, own);
            memcpy(s.crowd_memory, agents, crowd);
        }
        free(stage);
        free(walkers);
        free(agents);
        close_street(&s);
    }
}

/* The pool holds the nearest, and as many as it has room for. */
static void the_nearest_have_their_feet_on_the_ground(void **state)
{
    static const float eye[3] = { 4.0f, 0.0f, 0.0f }, other[3] = { -4.0f, 0.0f, 0.0f };
    noh_actor actors[COUNT];
    street s;
    (void)state;
    if (getenv("NOH_WALKERS_PACK")) return;
    open_street(&s, COUNT, 5, 1);
    fill(&s, 1, actors);
    frame(&s, CAST_STEP);
    assert_int_equal(noh_walkers_near(s.walkers, s.cast.stage, eye), 5);
    for (uint32_t i = 0; i < COUNT; i++) {
        const uint32_t *near_feet = noh_actor_modifier(s.cast.stage, actors[i], 0);
        const uint32_t is_near = near_feet[sizeof(noh_feet) / 4u + 1u];
        assert_int_equal(is_near, i < 3 || i > COUNT - 3u);
    }
    assert_int_equal(noh_walkers_near(s.walkers, s.cast.stage, other), 5);
    assert_int_equal(((const uint32_t *)noh_actor_modifier(s.cast.stage, actors[0], 0))[sizeof(noh_feet) / 4u + 1u], 0);
    assert_int_equal(noh_stage_despawn(s.cast.stage, actors[12], NULL), NOH_OK);
    assert_int_equal(noh_walkers_near(s.walkers, s.cast.stage, other), 5);
    for (uint32_t f = 0; f < 30; f++) frame(&s, CAST_STEP); /* one that is gone is let go */
    float heading[2];
    assert_int_equal(noh_walkers_heading(s.walkers, 12, heading), 0);
    assert_int_equal(noh_walkers_heading(s.walkers, 11, heading), 1);
    close_street(&s);
}

/* ---- an origin that moves ---- */

#define MOVERS 8u
#define JOINTS_SHOWN 4u

/* Eight walk on from where they are; half have their feet put on the ground. */
static void open_mover(street *s, noh_actor actors[MOVERS])
{
    open_street(s, MOVERS, MOVERS / 2u, 1);
    for (uint32_t i = 0; i < MOVERS; i++) {
        const float angle = 6.2831853f * (float)i / (float)MOVERS, x = 3.0f * cosf(angle), z = 3.0f * sinf(angle);
        const float at[2] = { x, z }, goal[2] = { -x, -z };
        actors[i] = enter(s, i, at, goal, 0.5f + 0.05f * (float)i);
    }
}

/* Their places and some joints, less the way that the origin has moved; drawing counts from near the eye. */
static void step_mover(street *s, const noh_actor actors[MOVERS], const double moved[3],
                       double at[MOVERS][1 + JOINTS_SHOWN][3])
{
    const float eye[3] = { (float)-moved[0], (float)(2.0 - moved[1]), (float)-moved[2] };
    noh_stage_view view;
    float origin[3];
    (void)noh_crowd_step(s->crowd, CAST_STEP);
    assert_int_equal(noh_walkers_step(s->walkers, s->crowd, s->cast.stage, &s->feet.ground, CAST_STEP, NULL), NOH_OK);
    assert_int_equal(noh_stage_step(s->cast.stage, CAST_STEP, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_walkers_near(s->walkers, s->cast.stage, eye), MOVERS / 2u);
    noh_view_orbit(&view, eye, 0.5f, 0.3f, 4.0f, 640, 360);
    assert_int_equal(noh_stage_frame_begin(s->cast.stage, &view, 1, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame_end(s->cast.stage, NULL), NOH_OK);
    noh_stage_origin(s->cast.stage, origin);
    for (uint32_t i = 0; i < MOVERS; i++) {
        noh_place place;
        assert_int_equal(noh_actor_place(s->cast.stage, actors[i], &place, NULL), NOH_OK);
        for (int k = 0; k < 3; k++) at[i][0][k] = (double)place.position[k] + moved[k];
        for (uint32_t j = 0; j < JOINTS_SHOWN; j++) {
            float m[12];
            const uint32_t joint = s->feet.rig.legs[j % 2u].points[2u * (j / 2u)].joint;
            assert_int_equal(noh_stage_joint(s->cast.stage, actors[i], joint, m, NULL), NOH_OK);
            for (int k = 0; k < 3; k++) at[i][1 + j][k] = (double)m[4 * k + 3] + (double)origin[k] + moved[k];
        }
    }
}

static double apart3(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

/* Under walkers of one of two streets the origin moves, there and back again. What shows is the same to a
 * millimetre, and what noh_actor_place tells to a float of that distance. */
static void the_origin_may_move(void **state)
{
    static const float ways[][3] = { { 4096.0f, 16.0f, -2048.0f },
                                     { 100000.0f, 0.0f, -100000.0f },
                                     { 1e6f, 0.0f, 0.0f } };
    (void)state;
    if (getenv("NOH_WALKERS_PACK")) return;
    for (size_t w = 0; w < TEST_COUNT(ways); w++) {
        static double a[MOVERS][1 + JOINTS_SHOWN][3], b[MOVERS][1 + JOINTS_SHOWN][3];
        noh_actor here_actors[MOVERS], moved_actors[MOVERS];
        double moved[3] = { 0.0, 0.0, 0.0 }, told = 0.0, shown = 0.0, way = 0.0;
        const double none[3] = { 0.0, 0.0, 0.0 };
        street here, moves;
        open_mover(&here, here_actors);
        open_mover(&moves, moved_actors);
        for (int f = 0; f < 600; f++) {
            if (f % 100 == 50) {
                const float sign = f % 200 == 50 ? 1.0f : -1.0f;
                const float by[3] = { sign * ways[w][0], sign * ways[w][1], sign * ways[w][2] },
                            flat[2] = { by[0], by[2] };
                noh_crowd_shift_origin(moves.crowd, flat);
                noh_walkers_shift_origin(moves.walkers, by);
                assert_int_equal(noh_stage_shift_origin(moves.cast.stage, by, NULL), NOH_OK);
                moves.floor.distance -= by[1];
                for (int k = 0; k < 3; k++) moved[k] += (double)by[k];
            }
            step_mover(&here, here_actors, none, a);
            step_mover(&moves, moved_actors, moved, b);
            for (uint32_t i = 0; i < MOVERS; i++) {
                told = fmax(told, apart3(a[i][0], b[i][0]));
                for (uint32_t j = 1; j <= JOINTS_SHOWN; j++) shown = fmax(shown, apart3(a[i][j], b[i][j]));
                if (f == 599) way = fmax(way, apart3(a[i][0], none));
            }
        }
        print_message("%.0f m: shown within %.3f mm, told within %.3f mm\n", (double)ways[w][0], 1000.0 * shown,
                      1000.0 * told);
        assert_true(way > 1.0);
        assert_true(shown < 0.001);
        assert_true(told < 1e-4 + (double)ways[w][0] / 8388608.0);
        close_street(&here);
        close_street(&moves);
    }
}

static void what_walkers_cannot_use_is_refused(void **state)
{
    street s;
    noh_walkers *w = NULL;
    noh_error said;
    (void)state;
    if (getenv("NOH_WALKERS_PACK")) return;
    open_street(&s, 3, 2, 1);
    noh_walkers_desc desc = walkers_desc(&s, 2);
    const size_t bytes = noh_walkers_size(&desc);
    assert_int_equal(bytes, (8016u + 3u * 96u + 2u * 8u + 15u) / 16u * 16u);
    assert_int_equal(noh_walkers_init(s.walkers_memory, bytes - 1u, &desc, s.cast.stage, &w, &said), NOH_ERR_MEMORY);
    assert_int_equal(said.need, bytes);
    desc.walk = "stride";
    assert_int_equal(noh_walkers_init(s.walkers_memory, bytes, &desc, s.cast.stage, &w, &said), NOH_ERR_NOT_FOUND);
    desc.walk = "idle"; /* it stays where it is */
    assert_int_equal(noh_walkers_init(s.walkers_memory, bytes, &desc, s.cast.stage, &w, &said), NOH_ERR_ARG);
    desc.walk_speed = 1.0f;
    assert_int_equal(noh_walkers_init(s.walkers_memory, bytes, &desc, s.cast.stage, &w, &said), NOH_OK);
    desc.layer = 1;
    assert_int_equal(noh_walkers_init(s.walkers_memory, bytes, &desc, s.cast.stage, &w, &said), NOH_ERR_ARG);
    desc.layer = 0;
    desc.feet_modifier = 2;
    assert_int_equal(noh_walkers_init(s.walkers_memory, bytes, &desc, s.cast.stage, &w, &said), NOH_ERR_ARG);
    desc.feet_modifier = 0;
    assert_int_equal(noh_walkers_size(&desc), 0);
    assert_int_equal(noh_walkers_add(s.walkers, 3, s.cast.stage, (noh_actor){ 0 }, 0, NULL, &said), NOH_ERR_NOT_FOUND);
    close_street(&s);
}

/* A walker that stands turns to where it is asked to look, and steps while it turns. */
static void who_stands_turns(void **state)
{
    static const float at[2] = { 0.0f, 0.0f }, ahead[2] = { 0.0f, 1e-3f }, aside[2] = { 3.0f, 0.0f };
    street s;
    float heading[2];
    (void)state;
    if (getenv("NOH_WALKERS_PACK")) return;
    open_street(&s, 1, 0, 1);
    const noh_actor actor = enter(&s, 0, at, ahead, 0.5f);
    for (uint32_t f = 0; f < 30; f++) frame(&s, CAST_STEP);
    noh_walkers_face(s.walkers, 0, aside);
    for (uint32_t f = 0; f < 10; f++) frame(&s, CAST_STEP);
    assert_true(noh_walkers_heading(s.walkers, 0, heading));
    assert_true(heading[0] > 0.3f && heading[0] < 0.9f); /* 4 radians a second */
    for (uint32_t f = 0; f < 30; f++) frame(&s, CAST_STEP);
    assert_true(noh_walkers_heading(s.walkers, 0, heading));
    assert_true(heading[0] > 0.9999f);
    noh_place place;
    assert_int_equal(noh_actor_place(s.cast.stage, actor, &place, NULL), NOH_OK);
    assert_true(fabsf(place.rotation[1] - 0.70710678f) < 1e-4f && hypotf(place.position[0], place.position[2]) < 0.25f);
    close_street(&s);
}

/* How far its agent is from it. */
static float distance_of(const street *s, noh_actor actor, uint32_t agent)
{
    noh_crowd_agent a;
    noh_place place;
    assert_true(noh_crowd_agent_at(s->crowd, agent, &a));
    assert_int_equal(noh_actor_place(s->cast.stage, actor, &place, NULL), NOH_OK);
    return hypotf(place.position[0] - a.position[0], place.position[2] - a.position[1]);
}

/* How far one foot is ahead of the other. */
static float apart(const street *s, noh_actor actor, const float heading[2])
{
    float parts[2][3][3];
    for (uint32_t l = 0; l < 2; l++) parts_of(s, actor, l, parts[l]);
    return fabsf((parts[0][1][0] - parts[1][1][0]) * heading[0] + (parts[0][1][2] - parts[1][1][2]) * heading[1]);
}

/* A walker that stops closes with a step and then stands, feet together; one that turns on the spot steps, too; and no
 * foot on the ground slides meanwhile. Stops at eight moments of a pass. */
static void stops_and_turns_are_steps(void **state)
{
    static const float back[2] = { 0.0f, -1.0f }, aside[2] = { 1.0f, 0.0f };
    slides m;
    (void)state;
    if (getenv("NOH_WALKERS_PACK")) return;
    memset(&m, 0, sizeof m);
    for (int k = 0; k < 8; k++) {
        const float at[2] = { 0.0f, 0.0f }, goal[2] = { 0.0f, 2.0f + 0.0875f * (float)k };
        float heading[2];
        street s;
        open_street(&s, 1, 0, 1);
        const noh_actor actor = enter(&s, 0, at, goal, 0.4f + 0.05f * (float)k);
        m.ready = 0;
        memset(m.feet, 0, sizeof m.feet);
        for (uint32_t f = 0; f < 800; f++) {
            if (f == 560) noh_walkers_face(s.walkers, 0, k % 2 ? back : aside);
            frame(&s, CAST_STEP);
            measure(&s, actor, &m);
            assert_true(noh_walkers_heading(s.walkers, 0, heading));
            if (f == 559) assert_true(apart(&s, actor, heading) < 0.01f && distance_of(&s, actor, 0) < 0.26f);
        }
        assert_true(heading[0] * (k % 2 ? back : aside)[0] + heading[1] * (k % 2 ? back : aside)[1] > 0.9995f);
        assert_true(apart(&s, actor, heading) < 0.01f);
        for (uint32_t l = 0; l < 2; l++) lift(&m, &m.feet[l]); /* what they slid while it stood */
        close_street(&s);
    }
    tell("it stops and turns", 0.6f, 60, &m);
    assert_true(m.steps > 40 && mean_slide(&m) <= 0.02f && worst_slide(&m) <= 0.03f);
}

/* While it walks, with U-turns, no body turns faster than it was asked to. */
static void nobody_turns_faster_than_asked(void **state)
{
    static const float speeds[] = { 1.0f, 2.5f };
    (void)state;
    if (getenv("NOH_WALKERS_PACK")) return;
    for (int k = 0; k < 2; k++) {
        noh_actor actors[COUNT];
        float was[COUNT][2], most = 0.0f;
        uint32_t seed = 9;
        street s;
        open_street(&s, COUNT, 0, 1);
        noh_walkers_desc desc = walkers_desc(&s, 0);
        desc.turn_speed = speeds[k];
        assert_int_equal(
            noh_walkers_init(s.walkers_memory, noh_walkers_size(&desc), &desc, s.cast.stage, &s.walkers, NULL), NOH_OK);
        fill(&s, 0, actors);
        for (uint32_t f = 0; f < 600; f++) {
            aim_again(&s, 0, &seed);
            frame(&s, CAST_STEP);
            for (uint32_t i = 0; i < COUNT; i++) {
                float h[2];
                assert_true(noh_walkers_heading(s.walkers, i, h));
                const float turned = fabsf(
                    atan2f(was[i][0] * h[1] - was[i][1] * h[0], was[i][0] * h[0] + was[i][1] * h[1]));
                if (f) most = fmaxf(most, turned * 48000.0f / (float)CAST_STEP);
                memcpy(was[i], h, sizeof h);
            }
        }
        assert_true(most <= 1.001f * speeds[k] && most > 0.9f * speeds[k]);
        close_street(&s);
    }
}

/* ---- falling ---- */

#define DOLLS 3u

static uint32_t tend(street *s)
{
    noh_error said = { NOH_OK, "", 0, 0 };
    const uint32_t down = noh_walkers_tend(s->walkers, s->crowd, s->cast.stage, 1, CAST_STEP, &said);
    if (said.result) fail_msg("%s", said.what);
    return down;
}

/* How many are nearer. */
static uint32_t rank_of(const float far[COUNT], uint32_t of)
{
    uint32_t nearer = 0;
    for (uint32_t i = 0; i < COUNT; i++) nearer += far[i] < far[of];
    return nearer;
}

/* A push in a crowd: as many fall as the pool has ragdolls, the nearest of all; their agents lie under them, others
 * walk around them; they get up, go on at their pace, and the pool is free for the next: of a push from outside that
 * reaches one fewer. */
static void who_is_pushed_falls_and_goes_on(void **state)
{
    noh_actor actors[COUNT];
    uint32_t seed = 9;
    street s;
    (void)state;
    if (getenv("NOH_WALKERS_PACK")) return;
    open_street_of(&s, COUNT, 0, 1, DOLLS);
    fill(&s, 0, actors);
    for (uint32_t f = 0; f < 240; f++) {
        aim_again(&s, 0, &seed);
        assert_int_equal(tend(&s), 0);
        frame(&s, CAST_STEP);
    }
    for (int round = 0; round < 2; round++) {
        const float point[3] = { round ? 40.0f : 5.0f, 1.2f, 5.0f };
        const uint32_t falls = DOLLS - (uint32_t)round;
        float pace[COUNT], far[COUNT], reach = 100.0f;
        uint32_t fell = 0, up = 0, frames = 0;
        for (uint32_t i = 0; i < COUNT; i++) {
            noh_crowd_agent a;
            noh_place place;
            assert_true(noh_crowd_agent_stepped(s.crowd, i, &a));
            assert_int_equal(noh_actor_place(s.cast.stage, actors[i], &place, NULL), NOH_OK);
            pace[i] = a.speed;
            far[i] = hypotf(place.position[0] - point[0], place.position[2] - point[2]);
        }
        for (uint32_t i = 0; i < COUNT && round; i++) {
            if (rank_of(far, i) + 1u == falls) reach = far[i] * 1.00001f;
        }
        assert_int_equal(noh_walkers_push(s.walkers, s.cast.stage, point, reach, 90.0f), falls);
        assert_int_equal(tend(&s), falls);
        for (uint32_t i = 0; i < COUNT; i++) {
            assert_int_equal(noh_walkers_is_down(s.walkers, i), rank_of(far, i) < falls);
            fell += noh_actor_body(s.cast.stage, actors[i]) == NOH_BODY_FALLS;
        }
        assert_int_equal(fell, falls);
        while (up < 60 && ++frames < 1500) { /* a second on their feet */
            aim_again(&s, 0, &seed);
            up = tend(&s) ? 0 : up + 1u;
            frame(&s, CAST_STEP);
            for (uint32_t i = 0; i < COUNT; i++) {
                if (noh_walkers_is_down(s.walkers, i)) assert_true(distance_of(&s, actors[i], i) < 0.2f);
            }
        }
        assert_true(frames > 60 && frames < 1500);
        for (uint32_t i = 0; i < COUNT; i++) {
            noh_crowd_agent a;
            assert_true(noh_crowd_agent_stepped(s.crowd, i, &a));
            assert_true(a.speed == pace[i]);
            assert_true(distance_of(&s, actors[i], i) <= 0.701f);
            assert_int_equal(noh_actor_body(s.cast.stage, actors[i]), NOH_BODY_STANDS);
        }
        printf("  %u of %u pushed, all walk again after %.1f s\n", falls, COUNT, (double)frames / 60.0);
    }
    close_street(&s);
}

/* With an origin that is 100 km away, walkers near a point fall there, their agents under them, and walk on; and they do
 * when it is back again. */
static void who_falls_far_away_goes_on(void **state)
{
    const float by[3] = { 100000.0f, 0.0f, -100000.0f }, flat[2] = { by[0], by[2] };
    const float back[3] = { -by[0], 0.0f, -by[2] }, flat_back[2] = { back[0], back[2] };
    noh_actor actors[COUNT];
    street s;
    (void)state;
    if (getenv("NOH_WALKERS_PACK")) return;
    open_street_of(&s, COUNT, 0, 1, DOLLS);
    fill(&s, 1, actors);
    for (uint32_t f = 0; f < 60; f++) frame(&s, CAST_STEP);
    for (int home = 0; home < 2; home++) {
        uint32_t up = 0, frames = 0;
        noh_crowd_shift_origin(s.crowd, home ? flat_back : flat);
        noh_walkers_shift_origin(s.walkers, home ? back : by);
        assert_int_equal(noh_stage_shift_origin(s.cast.stage, home ? back : by, NULL), NOH_OK);
        const float point[3] = { home ? 0.0f : -by[0], 1.2f, home ? 0.0f : -by[2] };
        assert_int_equal(noh_walkers_push(s.walkers, s.cast.stage, point, 8.0f, 90.0f), DOLLS);
        while (up < 60 && ++frames < 1500) {
            up = tend(&s) ? 0 : up + 1u;
            frame(&s, CAST_STEP);
            for (uint32_t i = 0; i < COUNT; i++) {
                if (noh_walkers_is_down(s.walkers, i)) assert_true(distance_of(&s, actors[i], i) < 0.21f);
            }
        }
        assert_true(frames > 60 && frames < 1500);
        for (uint32_t i = 0; i < COUNT; i++) {
            noh_place place;
            assert_int_equal(noh_actor_place(s.cast.stage, actors[i], &place, NULL), NOH_OK);
            assert_true(hypotf(place.position[0] - point[0], place.position[2] - point[2]) < 8.0f);
            assert_true(fabsf(place.position[1]) < 0.01f && distance_of(&s, actors[i], i) <= 0.72f);
            assert_int_equal(noh_actor_body(s.cast.stage, actors[i]), NOH_BODY_STANDS);
        }
    }
    close_street(&s);
}

/* From its clips to the ground and back to its clips: no joint leaps, except for what it falls and gets up by. */
static void it_gets_up_where_it_lies(void **state)
{
    static const float at[2] = { 0.0f, -3.0f }, goal[2] = { 0.0f, 30.0f };
    static const float point[3] = { 0.2f, 1.2f, -1.5f };
    float was[3] = { 0.0f, 0.0f, 0.0f }, most = 0.0f, before = 0.0f, after = 0.0f;
    street s;
    (void)state;
    if (getenv("NOH_WALKERS_PACK")) return;
    open_street_of(&s, 1, 0, 1, 1);
    const noh_actor actor = enter(&s, 0, at, goal, 0.7f);
    for (uint32_t f = 0; f < 900; f++) {
        float m[12], move = 0.0f;
        noh_crowd_agent a;
        (void)tend(&s);
        frame(&s, CAST_STEP);
        assert_true(noh_crowd_agent_stepped(s.crowd, 0, &a));
        if (f == 120) {
            before = a.position[1];
            assert_int_equal(noh_walkers_push(s.walkers, s.cast.stage, point, 3.0f, 80.0f), 1);
            assert_int_equal(noh_walkers_push(s.walkers, s.cast.stage, point, 3.0f, 80.0f), 0); /* the pool is empty */
        }
        assert_int_equal(noh_actor_joint(s.cast.stage, actor, 1, m, NULL), NOH_OK);
        for (int i = 0; i < 3; i++) {
            move += (m[4 * i + 3] - was[i]) * (m[4 * i + 3] - was[i]);
            was[i] = m[4 * i + 3];
        }
        if (f) most = fmaxf(most, sqrtf(move));
        after = a.position[1];
    }
    printf("  its first joint moves at most %.0f mm in a frame; its way: to %.2f m, pushed, to %.2f m\n",
           1e3 * (double)most, (double)before, (double)after);
    assert_true(most < 0.12f); /* 7 m/s: it falls */
    assert_true(after > before + 2.0f);
    assert_false(noh_walkers_is_down(s.walkers, 0));
    close_street(&s);
}

/* No actor of a kind without ragdolls falls; a dead one stays, and others walk around it. */
static void who_is_dead_lies(void **state)
{
    static const float at[2] = { 0.0f, 0.0f }, goal[2] = { 0.0f, 9.0f }, point[3] = { 0.0f, 1.2f, 0.0f };
    noh_crowd_agent a;
    street s;
    (void)state;
    if (getenv("NOH_WALKERS_PACK")) return;
    open_street(&s, 1, 0, 1);
    (void)enter(&s, 0, at, goal, 0.7f);
    assert_int_equal(noh_walkers_push(s.walkers, s.cast.stage, point, 9.0f, 90.0f), 0);
    assert_int_equal(noh_walkers_tend(s.walkers, s.crowd, s.cast.stage, 1, CAST_STEP, NULL), 0);
    close_street(&s);
    open_street_of(&s, 1, 0, 1, 1);
    const noh_actor actor = enter(&s, 0, at, goal, 0.7f);
    for (int i = 0; i < 15; i++) { /* a push that is no number moves nobody */
        static const float wrong[3] = { NAN, INFINITY, -INFINITY };
        float from[5] = { 0.0f, 1.2f, 0.0f, 9.0f, 90.0f };
        from[i / 3] = wrong[i % 3];
        assert_int_equal(noh_walkers_push(s.walkers, s.cast.stage, from, from[3], from[4]), 0);
        assert_int_equal(noh_actor_body(s.cast.stage, actor), NOH_BODY_STANDS);
    }
    noh_error said = { NOH_OK, "", 0, 0 };
    assert_int_equal(noh_walkers_tend(s.walkers, s.crowd, s.cast.stage, 0, CAST_STEP, &said), 0);
    assert_int_equal(said.result, NOH_ERR_ARG); /* the walkers' own layer */
    for (uint32_t f = 0; f < 30; f++) frame(&s, CAST_STEP);
    assert_int_equal(noh_actor_kill(s.cast.stage, actor, NULL), NOH_OK);
    for (uint32_t f = 0; f < 600; f++) {
        assert_int_equal(tend(&s), 1);
        frame(&s, CAST_STEP);
    }
    assert_true(noh_crowd_agent_stepped(s.crowd, 0, &a));
    assert_true(a.speed == 0.0f && distance_of(&s, actor, 0) < 0.1f);
    assert_int_equal(noh_actor_revive(s.cast.stage, actor, NULL), NOH_OK);
    for (uint32_t f = 0; f < 420; f++) {
        (void)tend(&s);
        frame(&s, CAST_STEP);
    }
    assert_true(noh_crowd_agent_stepped(s.crowd, 0, &a));
    assert_true(a.speed == 0.7f && !noh_walkers_is_down(s.walkers, 0));
    close_street(&s);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(feet_that_stand_do_not_slide),
        cmocka_unit_test(clips_play_by_the_way_walked),
        cmocka_unit_test(feet_do_not_slide_in_a_crowd),
        cmocka_unit_test(walkers_are_the_same_for_any_number_of_jobs),
        cmocka_unit_test(the_nearest_have_their_feet_on_the_ground),
        cmocka_unit_test(the_origin_may_move),
        cmocka_unit_test(what_walkers_cannot_use_is_refused),
        cmocka_unit_test(who_stands_turns),
        cmocka_unit_test(stops_and_turns_are_steps),
        cmocka_unit_test(nobody_turns_faster_than_asked),
        cmocka_unit_test(who_is_pushed_falls_and_goes_on),
        cmocka_unit_test(who_falls_far_away_goes_on),
        cmocka_unit_test(it_gets_up_where_it_lies),
        cmocka_unit_test(who_is_dead_lies),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
