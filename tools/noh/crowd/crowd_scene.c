/* crowd_scene.c: where agents start, and where they want to go. */
#define _POSIX_C_SOURCE 200809L
#include "crowd_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/trig.h"
#include "cli/message.h"
#include "convert/base/nearest.h"
#include "crowd_measure.h"

typedef struct kind {
    const char *name;
    uint32_t agents;
    double seconds;
    float radius, speed, reach;
    float spacing; /* metres between agents at the start */
    void (*place)(crowd_scene *s, uint32_t index, noh_crowd_agent *agent);
    void (*aim)(crowd_scene *s, uint32_t index);
    int (*arrived)(const crowd_scene *s, uint32_t index); /* NULL: they never stop */
} kind;

struct crowd_scene {
    const kind *kind;
    noh_crowd *crowd;
    void *memory;
    size_t bytes;
    noh_crowd_agent *now, *before;
    crowd_meter meter;
    crowd_measures measures;
    uint32_t agents, side, step, steps;
    float extent; /* of the square that they walk about in; the radius of the circle */
    uint64_t random;
    double cpu_ns;
};

/* 0 to 1, less than 1. */
static float chance(crowd_scene *s)
{
    s->random = s->random * 6364136223846793005u + 1442695040888963407u;
    return (float)(s->random >> 40) * (1.0f / 16777216.0f);
}

/* ---- the circle: everyone wants to the opposite side; RVO2's example ---- */

static void place_circle(crowd_scene *s, uint32_t index, noh_crowd_agent *a)
{
    float sine, cosine;
    noh_sin_cos_turn((uint32_t)(((uint64_t)index << 32) / s->agents), &sine, &cosine);
    a->goal[0] = -s->extent * cosine;
    a->goal[1] = -s->extent * sine;
    a->position[0] = -a->goal[0] + 1e-3f * (chance(s) - 0.5f);
    a->position[1] = -a->goal[1] + 1e-3f * (chance(s) - 0.5f);
}

static int arrived_circle(const crowd_scene *s, uint32_t index)
{
    const noh_crowd_agent *a = &s->now[index];
    const float x = a->goal[0] - a->position[0], z = a->goal[1] - a->position[1];
    return x * x + z * z <= a->radius * a->radius;
}

/* ---- the door: 1.6 m in a wall along x, all on one side of it ---- */

#define DOOR_M 1.6f

/* On a lattice of a metre, each a fifth of it off, nearest to the door first. */
static void place_door(crowd_scene *s, uint32_t index, noh_crowd_agent *a)
{
    const uint32_t line = index / s->side;
    const float column = (float)(index % s->side), row = (float)line;
    a->position[0] = column + 0.5f + 0.4f * (chance(s) - 0.5f) - 0.5f * (float)s->side;
    a->position[1] = -1.5f - row - 0.4f * (chance(s) - 0.5f);
    a->goal[0] = 0.0f;
    a->goal[1] = 0.5f;
}

/* To the nearest part of the door, then straight on. */
static void aim_door(crowd_scene *s, uint32_t index)
{
    const noh_crowd_agent *a = &s->now[index];
    const float half = 0.5f * DOOR_M - 1.05f * a->radius, x = a->position[0];
    float goal[2] = { x, a->position[1] + 20.0f };
    if (a->position[1] < 0.0f) {
        goal[0] = x < -half ? -half : x > half ? half : x;
        goal[1] = 0.5f;
    }
    noh_crowd_aim(s->crowd, index, goal);
}

static int arrived_door(const crowd_scene *s, uint32_t index)
{
    return s->now[index].position[1] > 0.0f;
}

/* ---- a square: everyone walks to random places, one after the other ---- */

static void place_square(crowd_scene *s, uint32_t index, noh_crowd_agent *a)
{
    const uint32_t line = index / s->side;
    const float cell = s->extent / (float)s->side, room = 0.9f * (cell - 2.0f * a->radius);
    a->position[0] = ((float)(index % s->side) + 0.5f) * cell + (chance(s) - 0.5f) * room;
    a->position[1] = ((float)line + 0.5f) * cell + (chance(s) - 0.5f) * room;
    a->goal[0] = s->extent * chance(s);
    a->goal[1] = s->extent * chance(s);
}

static void aim_square(crowd_scene *s, uint32_t index)
{
    const noh_crowd_agent *a = &s->now[index];
    const float x = a->goal[0] - a->position[0], z = a->goal[1] - a->position[1];
    if (x * x + z * z >= 1.0f) return;
    const float to_x = s->extent * chance(s), goal[2] = { to_x, s->extent * chance(s) };
    noh_crowd_aim(s->crowd, index, goal);
}

static const kind kinds[] = {
    { "circle250", 250, 300.0, 1.5f, 2.0f, 15.0f, 0.0f, place_circle, NULL, arrived_circle },
    { "door200", 200, 120.0, 0.25f, 1.3f, 2.0f, 1.0f, place_door, aim_door, arrived_door },
    { "dense1000", 1000, 30.0, 0.25f, 1.3f, 2.0f, 1.0f, place_square, aim_square, NULL },
    { "open10000", 10000, 30.0, 0.3f, 1.3f, 3.0f, 2.0f, place_square, aim_square, NULL },
};
#define KINDS (sizeof kinds / sizeof kinds[0])

static const kind *find_kind(const char *name)
{
    const char *names[KINDS], *near;
    for (size_t i = 0; i < KINDS; i++) {
        names[i] = kinds[i].name;
        if (strcmp(kinds[i].name, name) == 0) return &kinds[i];
    }
    near = nearest_name(name, names, KINDS);
    tool_usage("--test wants circle250, door200, dense1000 or open10000, not '%s'%s%s%s", name,
               near ? " (did you mean '" : "", near ? near : "", near ? "'?)" : "");
    return NULL;
}

/* ---- open and close ---- */

/* The area, and in it the wall with the door. */
static noh_crowd_desc desc_of(const crowd_scene *s, uint32_t job_count, noh_crowd_obstacle walls[2])
{
    const int is_circle = s->kind->arrived == arrived_circle, is_door = s->kind->arrived == arrived_door;
    const float low = is_circle ? -1.1f * s->extent : is_door ? -30.0f - (float)s->side : 0.0f;
    const float wide = is_circle ? 2.2f * s->extent : is_door ? -2.0f * low : s->extent;
    noh_crowd_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.agent_max = s->agents;
    desc.job_count = job_count;
    desc.origin[0] = desc.origin[1] = low;
    desc.extent[0] = desc.extent[1] = wide;
    desc.reach = s->kind->reach;
    if (is_door) {
        walls[0] = (noh_crowd_obstacle){ { low, 0.0f }, { -0.5f * DOOR_M, 0.0f }, 0.0f };
        walls[1] = (noh_crowd_obstacle){ { 0.5f * DOOR_M, 0.0f }, { -low, 0.0f }, 0.0f };
        desc.obstacles = walls;
        desc.obstacle_count = 2;
    }
    return desc;
}

static int open_crowd(crowd_scene *s, const crowd_scene_options *o)
{
    noh_crowd_obstacle walls[2];
    noh_error error = { NOH_OK, "", 0, 0 };
    const noh_crowd_desc desc = desc_of(s, o->job_count, walls);
    s->bytes = noh_crowd_size(&desc);
    s->memory = malloc(s->bytes ? s->bytes : 1);
    if (!s->memory || noh_crowd_init(s->memory, s->bytes, &desc, &s->crowd, &error)) {
        return tool_fail(s->kind->name, "%s", s->memory ? error.what : "out of memory");
    }
    for (uint32_t i = 0; i < s->agents; i++) {
        noh_crowd_agent a = {
            { 0.0f, 0.0f }, { 0.0f, 0.0f }, { 0.0f, 0.0f }, s->kind->radius, s->kind->speed, o->flags, i
        };
        s->kind->place(s, i, &a);
        if (noh_crowd_put(s->crowd, i, &a, &error)) return tool_fail(s->kind->name, "%s", error.what);
        s->now[i] = a;
    }
    return 0;
}

int crowd_scene_open(const crowd_scene_options *o, crowd_scene **scene)
{
    const kind *k = find_kind(o->name);
    crowd_scene *s = k ? calloc(1, sizeof *s) : NULL;
    int status;
    if (!s) return k ? tool_fail(k->name, "out of memory") : EXIT_USAGE;
    s->kind = k;
    s->agents = o->agents ? o->agents : k->agents;
    s->side = (uint32_t)ceil(sqrt((double)s->agents));
    s->extent = k->spacing > 0.0f ? k->spacing * (float)sqrt((double)s->agents) : 0.8f * (float)s->agents;
    s->steps = (uint32_t)((o->seconds > 0.0 ? o->seconds : k->seconds) * 30.0 + 0.5);
    s->random = ((uint64_t)o->seed << 32) + 0x9e3779b97f4a7c15u;
    s->measures.done = s->measures.half = -1.0;
    s->now = malloc(s->agents * sizeof *s->now);
    s->before = malloc(s->agents * sizeof *s->before);
    for (uint32_t i = 0; i < 4u; i++) (void)chance(s);
    status = s->now && s->before && crowd_meter_open(&s->meter, s->agents) ? open_crowd(s, o)
                                                                           : tool_fail(k->name, "out of memory");
    if (status) {
        crowd_scene_close(s);
    } else {
        *scene = s;
    }
    return status;
}

void crowd_scene_close(crowd_scene *s)
{
    crowd_meter_close(&s->meter);
    free(s->now);
    free(s->before);
    free(s->memory);
    free(s);
}

/* ---- steps ---- */

static double cpu_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static void count_arrived(crowd_scene *s)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->agents && s->kind->arrived; i++) count += s->kind->arrived(s, i) ? 1u : 0u;
    if (s->measures.half < 0.0 && 2u * count >= s->agents) s->measures.half = (double)s->step / 30.0;
    if (s->measures.done < 0.0 && count == s->agents) s->measures.done = (double)s->step / 30.0;
}

int crowd_scene_step(crowd_scene *s)
{
    noh_crowd_agent *agents = s->before;
    if (s->step == s->steps || s->measures.done >= 0.0) return 0;
    s->before = s->now;
    s->now = agents;
    const double start = cpu_ns();
    (void)noh_crowd_step(s->crowd, NOH_CROWD_STEP_TICKS);
    s->cpu_ns += cpu_ns() - start;
    s->step++;
    for (uint32_t i = 0; i < s->agents; i++) (void)noh_crowd_agent_stepped(s->crowd, i, &s->now[i]);
    crowd_meter_add(&s->meter, s->before, s->now, &s->measures);
    for (uint32_t i = 0; i < s->agents && s->kind->aim; i++) s->kind->aim(s, i);
    count_arrived(s);
    return 1;
}

const crowd_measures *crowd_scene_measures(const crowd_scene *s)
{
    return &s->measures;
}

noh_crowd *crowd_scene_crowd(const crowd_scene *s)
{
    return s->crowd;
}

uint32_t crowd_scene_agents(const crowd_scene *s)
{
    return s->agents;
}

uint32_t crowd_scene_steps(const crowd_scene *s)
{
    return s->step;
}

size_t crowd_scene_bytes(const crowd_scene *s)
{
    return s->bytes;
}

double crowd_scene_cpu_ns(const crowd_scene *s)
{
    return s->cpu_ns;
}

const noh_crowd_agent *crowd_scene_agent(const crowd_scene *s, uint32_t index)
{
    return &s->now[index];
}
