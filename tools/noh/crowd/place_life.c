#include "place_life.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/crowd.h"
#include "noh/low_core.h"
#include "cli/message.h"
#include "platform.h"
#include "place_people.h"

#define STEPS_PER_S 30u
#define WANTS 0.6f     /* a need above this level is satisfied */
#define THERE_M 0.25f  /* distance from its slot at which it has arrived */
#define NEAR_M 2.0f    /* distance from its slot at which it walks straight to it */
#define PATIENCE_S 40u /* on the way to a goal; then it takes another */
#define SPAWN_TRIES 200u

typedef struct inhabitant {
    float speed;
    uint32_t goal;  /* the field that it follows; NOH_NONE: none */
    uint32_t since; /* step at which it began to go there */
    uint32_t was_anywhere, is_down;
    noh_smart_phase phase; /* that it has acted on */
} inhabitant;

struct place_life {
    const place_file *place;
    noh_crowd *crowd;
    noh_smart *smart; /* NULL: nothing is used */
    void *crowd_memory, *smart_memory;
    size_t bytes;
    noh_crowd_agent *now, *before;
    float (*ahead)[2]; /* the wanted direction of each */
    inhabitant *people;
    crowd_meter meter;
    crowd_measures measures;
    uint32_t agents, fields, step;
    uint64_t random;
    double cpu_ns;
};

/* 0 to 1, less than 1. */
static float chance(place_life *l)
{
    l->random = l->random * 6364136223846793005u + 1442695040888963407u;
    return (float)(l->random >> 40) * (1.0f / 16777216.0f);
}

/* ---- opening ---- */

static int open_crowd(place_life *l)
{
    const place_file *p = l->place;
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_crowd_desc desc;
    place_crowd_desc(p, l->agents, &desc);
    const size_t bytes = noh_crowd_size(&desc);
    l->crowd_memory = malloc(bytes ? bytes : 1);
    if (!l->crowd_memory) return tool_fail("crowd", "out of memory");
    if (noh_crowd_init(l->crowd_memory, bytes, &desc, &l->crowd, &error)) return tool_fail("crowd", "%s", error.what);
    l->bytes += bytes;
    l->fields = desc.field_count;
    for (uint32_t g = 0; g < p->goal_count && g < desc.field_count; g++) {
        noh_crowd_field_aim(l->crowd, g, p->goals[g].at);
    }
    for (uint32_t i = p->goal_count; i < desc.field_count; i++) {
        noh_crowd_field_aim(l->crowd, i, p->slots[p->objects[i - p->goal_count].first_slot].at);
    }
    while (desc.field_count && noh_crowd_field_build(l->crowd, 1u << 20)) {}
    return 0;
}

static int open_smart(place_life *l)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_smart_desc desc;
    place_smart_desc(l->place, l->agents, &desc);
    if (!desc.object_count) return 0;
    const size_t bytes = noh_smart_size(&desc);
    l->smart_memory = malloc(bytes ? bytes : 1);
    if (!l->smart_memory) return tool_fail("crowd", "out of memory");
    if (noh_smart_init(l->smart_memory, bytes, &desc, &l->smart, &error)) return tool_fail("crowd", "%s", error.what);
    l->bytes += bytes;
    return 0;
}

static int is_free(const place_life *l, uint32_t count, const float at[2])
{
    const place_file *p = l->place;
    for (uint32_t i = 0; i < count; i++) {
        const float x = at[0] - l->now[i].position[0], z = at[1] - l->now[i].position[1];
        if (x * x + z * z < 4.4f * p->radius * p->radius) return 0;
    }
    for (uint32_t i = 0; i < p->obstacle_count; i++) {
        const noh_crowd_obstacle *o = &p->obstacles[i];
        const float way[2] = { o->to[0] - o->from[0], o->to[1] - o->from[1] };
        const float off[2] = { at[0] - o->from[0], at[1] - o->from[1] }, square = way[0] * way[0] + way[1] * way[1];
        const float part = square > 0.0f ? fminf(fmaxf((off[0] * way[0] + off[1] * way[1]) / square, 0.0f), 1.0f)
                                         : 0.0f;
        if (hypotf(off[0] - part * way[0], off[1] - part * way[1]) < o->radius + 1.1f * p->radius) return 0;
    }
    return 1;
}

/* A random place in the areas, each with a chance by its size. returns 0 if there is no room left */
static int find_room(place_life *l, uint32_t index, float at[2])
{
    const place_file *p = l->place;
    float whole = 0.0f;
    for (uint32_t i = 0; i < p->spawn_count; i++) {
        whole += (p->spawns[i].high[0] - p->spawns[i].low[0]) * (p->spawns[i].high[1] - p->spawns[i].low[1]);
    }
    for (uint32_t try = 0; try < SPAWN_TRIES; try++) {
        float rest = whole * chance(l);
        uint32_t i = 0;
        for (; i + 1u < p->spawn_count; i++) {
            rest -= (p->spawns[i].high[0] - p->spawns[i].low[0]) * (p->spawns[i].high[1] - p->spawns[i].low[1]);
            if (rest < 0.0f) break;
        }
        for (int k = 0; k < 2; k++) {
            at[k] = p->spawns[i].low[k] + chance(l) * (p->spawns[i].high[k] - p->spawns[i].low[k]);
        }
        if (is_free(l, index, at)) return 1;
    }
    return 0;
}

/* A goal other than the last one, and a place around it. */
static void choose_goal(place_life *l, uint32_t index)
{
    const place_file *p = l->place;
    inhabitant *h = &l->people[index];
    float at[2];
    h->since = l->step;
    if (!p->goal_count) {
        (void)find_room(l, 0, at);
        h->goal = NOH_NONE;
        noh_crowd_set_goal(l->crowd, index, at);
        return;
    }
    uint32_t goal = (uint32_t)(chance(l) * (float)p->goal_count);
    if (goal == h->goal) goal = (goal + 1u) % p->goal_count;
    const float way = p->goals[goal].radius * sqrtf(chance(l)), angle = 6.2831853f * chance(l);
    at[0] = p->goals[goal].at[0] + way * cosf(angle);
    at[1] = p->goals[goal].at[1] + way * sinf(angle);
    h->goal = goal;
    noh_crowd_set_goal(l->crowd, index, at);
    noh_crowd_follow(l->crowd, index, goal);
}

static int enter(place_life *l, uint32_t index)
{
    const place_file *p = l->place;
    noh_error error = { NOH_OK, "", 0, 0 };
    inhabitant *h = &l->people[index];
    noh_crowd_agent *a = &l->now[index];
    float needs[NOH_SMART_NEEDS_MAX];
    memset(a, 0, sizeof *a);
    if (!find_room(l, index, a->position)) {
        return tool_fail("crowd", "the spawn areas have room for only %u agents: enlarge them, or use fewer agents",
                         index);
    }
    h->speed = p->speed[0] + chance(l) * (p->speed[1] - p->speed[0]);
    h->goal = NOH_NONE;
    memcpy(a->goal, a->position, sizeof a->goal);
    a->radius = p->radius;
    a->speed = h->speed;
    a->id = index;
    if (noh_crowd_add(l->crowd, index, a, &error)) return tool_fail("crowd", "%s", error.what);
    for (uint32_t n = 0; n < NOH_SMART_NEEDS_MAX; n++) needs[n] = chance(l);
    if (l->smart) noh_smart_enter(l->smart, index, needs);
    choose_goal(l, index);
    (void)noh_crowd_agent_stepped(l->crowd, index, a);
    return 0;
}

int place_life_open(const place_file *place, uint32_t agents, uint32_t seed, place_life **life)
{
    place_life *l = calloc(1, sizeof *l);
    int status;
    if (!l) return tool_fail("crowd", "out of memory");
    l->place = place;
    l->agents = agents ? agents : PLACE_AGENTS;
    l->random = ((uint64_t)seed << 32) + 0x9e3779b97f4a7c15u;
    l->measures.done = l->measures.half = -1.0;
    l->now = calloc(l->agents, sizeof *l->now);
    l->before = calloc(l->agents, sizeof *l->before);
    l->people = calloc(l->agents, sizeof *l->people);
    l->ahead = calloc(l->agents, sizeof *l->ahead);
    status = l->now && l->before && l->people && l->ahead && crowd_meter_open(&l->meter, l->agents)
                 ? open_crowd(l)
                 : tool_fail("crowd", "out of memory");
    if (!status) status = open_smart(l);
    for (uint32_t i = 0; i < l->agents && !status; i++) status = enter(l, i);
    if (status) {
        place_life_close(l);
    } else {
        *life = l;
    }
    return status;
}

void place_life_close(place_life *l)
{
    crowd_meter_close(&l->meter);
    free(l->crowd_memory);
    free(l->smart_memory);
    free(l->now);
    free(l->before);
    free(l->people);
    free(l->ahead);
    free(l);
}

/* ---- decisions ---- */

static float distance(const float a[2], const float b[2])
{
    return hypotf(a[0] - b[0], a[1] - b[1]);
}

/* Along the object's field, and straight once it is near. */
static void go_to_slot(place_life *l, uint32_t index, const noh_smart_use *use)
{
    const float *at = noh_smart_slot_at(l->smart, use->slot)->at;
    const uint32_t field = l->place->goal_count + use->object;
    const int is_near = distance(l->now[index].position, at) < NEAR_M || field >= l->fields;
    noh_crowd_set_goal(l->crowd, index, at);
    noh_crowd_follow(l->crowd, index, is_near ? NOH_NONE : field);
    l->people[index].goal = is_near ? NOH_NONE : field;
}

/* The phase of its use has changed. */
static void act(place_life *l, uint32_t index, const noh_smart_use *use)
{
    inhabitant *h = &l->people[index];
    if (use->phase == NOH_SMART_GOING) {
        go_to_slot(l, index, use);
    } else if (use->phase == NOH_SMART_ENTERING) {
        noh_crowd_set_speed(l->crowd, index, 0.0f);
    } else if (use->phase == NOH_SMART_FREE && h->phase >= NOH_SMART_GOING) {
        noh_crowd_set_speed(l->crowd, index, h->speed);
        choose_goal(l, index);
    }
    h->phase = use->phase;
}

static void use(place_life *l, uint32_t index)
{
    const float *at = l->now[index].position;
    noh_smart_use u;
    noh_smart_use_of(l->smart, index, &u);
    if (u.phase == NOH_SMART_FREE) {
        const uint32_t need = noh_smart_most(l->smart, index, WANTS);
        if (need != NOH_NONE) (void)noh_smart_request(l->smart, index, need, at);
    } else if (u.phase == NOH_SMART_GOING && distance(at, noh_smart_slot_at(l->smart, u.slot)->at) < THERE_M) {
        (void)noh_smart_arrive(l->smart, index);
        l->people[index].was_anywhere = 1;
    }
    noh_smart_use_of(l->smart, index, &u);
    if (u.phase != l->people[index].phase) act(l, index, &u);
    if (u.phase == NOH_SMART_GOING) go_to_slot(l, index, &u);
}

static void walk(place_life *l, uint32_t index)
{
    inhabitant *h = &l->people[index];
    const noh_crowd_agent *a = &l->now[index];
    const int is_at_goal = h->goal < l->place->goal_count && distance(a->position, l->place->goals[h->goal].at) <
                                                                 l->place->goals[h->goal].radius + 2.0f * a->radius;
    if (h->phase >= NOH_SMART_GOING) return;
    if (is_at_goal || distance(a->position, a->goal) < 2.0f * a->radius) {
        h->was_anywhere = 1;
        choose_goal(l, index);
    } else if (l->step - h->since > PATIENCE_S * STEPS_PER_S) {
        choose_goal(l, index);
    }
}

/* Along its flow field, or straight to its goal. */
static void look_ahead(place_life *l, uint32_t index)
{
    const noh_crowd_agent *a = &l->now[index];
    const inhabitant *h = &l->people[index];
    const float x = a->goal[0] - a->position[0], z = a->goal[1] - a->position[1], far = hypotf(x, z);
    l->ahead[index][0] = far > 0.0f ? x / far : 0.0f;
    l->ahead[index][1] = far > 0.0f ? z / far : 0.0f;
    if (h->goal == NOH_NONE || h->phase > NOH_SMART_GOING) return;
    (void)noh_crowd_field_at(l->crowd, h->goal, a->position, l->ahead[index]);
}

static void count_arrived(place_life *l)
{
    const double now = (double)l->step / (double)STEPS_PER_S;
    uint32_t count = 0;
    for (uint32_t i = 0; i < l->agents; i++) count += l->people[i].was_anywhere;
    if (l->measures.half < 0.0 && 2u * count >= l->agents) l->measures.half = now;
    if (l->measures.done < 0.0 && count == l->agents) l->measures.done = now;
}

void place_life_step(place_life *l)
{
    noh_crowd_agent *agents = l->before;
    for (uint32_t i = 0; i < l->agents; i++) look_ahead(l, i);
    l->before = l->now;
    l->now = agents;
    const uint64_t start = noh_thread_clock_ns();
    (void)noh_crowd_step(l->crowd, NOH_CROWD_STEP_TICKS);
    if (l->smart) noh_smart_step(l->smart, NOH_CROWD_STEP_TICKS);
    l->cpu_ns += (double)(noh_thread_clock_ns() - start);
    l->step++;
    for (uint32_t i = 0; i < l->agents; i++) (void)noh_crowd_agent_stepped(l->crowd, i, &l->now[i]);
    crowd_meter_add(&l->meter, l->before, l->now, (const float(*)[2])l->ahead, &l->measures);
    for (uint32_t i = 0; i < l->agents; i++) {
        if (l->people[i].is_down) continue;
        if (l->smart) use(l, i);
        walk(l, i);
    }
    count_arrived(l);
}

void place_life_set_down(place_life *l, uint32_t index, int is_down)
{
    inhabitant *h = &l->people[index];
    if (is_down && !h->is_down && l->smart) (void)noh_smart_release(l->smart, index);
    if (!is_down && h->is_down) {
        noh_crowd_set_speed(l->crowd, index, h->speed);
        choose_goal(l, index);
    }
    h->is_down = is_down != 0;
}

/* ---- queries ---- */

const crowd_measures *place_life_measures(const place_life *l)
{
    return &l->measures;
}

uint32_t place_life_agents(const place_life *l)
{
    return l->agents;
}

uint32_t place_life_steps(const place_life *l)
{
    return l->step;
}

size_t place_life_bytes(const place_life *l)
{
    return l->bytes;
}

double place_life_cpu_ns(const place_life *l)
{
    return l->cpu_ns;
}

uint32_t place_life_hash(const place_life *l)
{
    uint32_t hash = noh_crowd_hash(l->crowd);
    for (uint32_t i = 0; l->smart && i < l->place->smart.slot_count; i++) {
        const uint32_t holder = noh_smart_holder(l->smart, i);
        hash = noh_crc32c(hash, &holder, sizeof holder);
    }
    return hash;
}

noh_crowd *place_life_crowd(const place_life *l)
{
    return l->crowd;
}

const noh_crowd_agent *place_life_agent(const place_life *l, uint32_t index)
{
    return &l->now[index];
}

noh_smart_use place_life_use(const place_life *l, uint32_t index)
{
    noh_smart_use u;
    memset(&u, 0, sizeof u);
    if (l->smart) noh_smart_use_of(l->smart, index, &u);
    return u;
}

const noh_smart_slot *place_life_slot(const place_life *l, uint32_t slot)
{
    return noh_smart_slot_at(l->smart, slot);
}
