/* crowd_scene.c: the starts and goals of agents. */
#include "crowd_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/crowd.h"
#include "noh/low_core.h"
#include "cli/message.h"
#include "platform.h"
#include "convert/base/nearest.h"
#include "crowd_measure.h"

typedef struct kind {
    const char *name;
    uint32_t agents;
    double seconds;
    float radius, speed, reach;
    float spacing; /* metres between agents at the start */
    uint32_t fields;
    uint32_t (*build)(crowd_scene *s, noh_crowd_obstacle *walls); /* how many, up to WALLS_MAX; NULL: none */
    void (*place)(crowd_scene *s, uint32_t index, noh_crowd_agent *agent);
    void (*aim)(crowd_scene *s, uint32_t index);
    int (*arrived)(const crowd_scene *s, uint32_t index); /* NULL: they never stop */
} kind;

#define WALLS_MAX 256u
#define NO_FIELD NOH_NONE

struct crowd_scene {
    const kind *kind;
    noh_crowd *crowd;
    void *memory;
    size_t bytes;
    noh_crowd_agent *now, *before;
    float (*ahead)[2];      /* where agents want to go */
    uint32_t *field, *rest; /* that they follow; steps that they stay at a stall */
    size_t field_bytes;
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

static float low_of(const crowd_scene *s);

/* Flow fields lead to goals of this width. */
static int is_within(const crowd_scene *s, uint32_t index, float distance)
{
    const noh_crowd_agent *a = &s->now[index];
    const float x = a->goal[0] - a->position[0], z = a->goal[1] - a->position[1];
    return x * x + z * z <= distance * distance;
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
    return is_within(s, index, s->now[index].radius);
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

/* To the nearest point of the door, then straight on. */
static void aim_door(crowd_scene *s, uint32_t index)
{
    const noh_crowd_agent *a = &s->now[index];
    const float half = 0.5f * DOOR_M - 1.05f * a->radius, x = a->position[0];
    float goal[2] = { x, a->position[1] + 20.0f };
    if (a->position[1] < 0.0f) {
        goal[0] = x < -half ? -half : x > half ? half : x;
        goal[1] = 0.5f;
    }
    noh_crowd_set_goal(s->crowd, index, goal);
}

static uint32_t build_door(crowd_scene *s, noh_crowd_obstacle *walls)
{
    const float low = low_of(s);
    walls[0] = (noh_crowd_obstacle){ { low, 0.0f }, { -0.5f * DOOR_M, 0.0f }, 0.0f };
    walls[1] = (noh_crowd_obstacle){ { 0.5f * DOOR_M, 0.0f }, { -low, 0.0f }, 0.0f };
    return 2;
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
    if (!is_within(s, index, 1.0f)) return;
    const float to_x = s->extent * chance(s), goal[2] = { to_x, s->extent * chance(s) };
    noh_crowd_set_goal(s->crowd, index, goal);
}

/* ---- shared by scenes with flow fields: agents walk from goal to goal ---- */

static uint32_t choice(crowd_scene *s, uint32_t count)
{
    return (uint32_t)(chance(s) * (float)count);
}

static void follow(crowd_scene *s, uint32_t index, uint32_t field)
{
    s->field[index] = field;
    noh_crowd_follow(s->crowd, index, field);
}

static void follow_another(crowd_scene *s, uint32_t index)
{
    const uint32_t n = s->kind->fields;
    follow(s, index, s->field[index] == NO_FIELD ? choice(s, n) : (s->field[index] + 1u + choice(s, n - 1u)) % n);
}

/* ---- a maze: rooms of 5 m, one way between any two, and a loop for every sixth wall; goals in its corners ---- */

#define ROOMS 8u
#define ROOM(s) ((s)->extent / (float)ROOMS)

static uint32_t root_of(uint32_t *parent, uint32_t room)
{
    while (parent[room] != room) room = parent[room] = parent[parent[room]];
    return room;
}

/* Kruskal's: walls between rooms in random order; one falls where its rooms are not connected. Wall 2 r is to the right
 * of room r, 2 r + 1 above it. */
static uint32_t build_maze(crowd_scene *s, noh_crowd_obstacle *walls)
{
    uint32_t order[2u * ROOMS * ROOMS], parent[ROOMS * ROOMS], count = 0;
    const float room = ROOM(s);
    for (uint32_t i = 0; i < 2u * ROOMS * ROOMS; i++) {
        const uint32_t other = choice(s, i + 1u);
        order[i] = order[other];
        order[other] = i;
        parent[i / 2u] = i / 2u;
    }
    for (uint32_t k = 0; k < 2u * ROOMS * ROOMS; k++) {
        const uint32_t r = order[k] / 2u, up = order[k] & 1u, x = r % ROOMS, z = r / ROOMS;
        const int is_edge = up ? z + 1u == ROOMS : x + 1u == ROOMS;
        const uint32_t a = root_of(parent, r), b = is_edge ? a : root_of(parent, r + (up ? ROOMS : 1u));
        if (a != b) parent[a] = b;
        if (a != b || (!is_edge && choice(s, 6u) == 0)) continue;
        const float right = room * (float)(x + 1u), top = room * (float)(z + 1u);
        walls[count++] = (noh_crowd_obstacle){ { up ? right - room : right, up ? top : top - room },
                                               { right, top },
                                               0.1f };
    }
    walls[count++] = (noh_crowd_obstacle){ { 0.0f, 0.0f }, { s->extent, 0.0f }, 0.1f };
    walls[count++] = (noh_crowd_obstacle){ { 0.0f, 0.0f }, { 0.0f, s->extent }, 0.1f };
    return count;
}

/* The middle of each corner's room. */
static void goal_of_maze(const crowd_scene *s, uint32_t field, float goal[2])
{
    const float room = ROOM(s);
    goal[0] = (field & 1u) ? s->extent - 0.5f * room : 0.5f * room;
    goal[1] = (field & 2u) ? s->extent - 0.5f * room : 0.5f * room;
}

static void place_maze(crowd_scene *s, uint32_t index, noh_crowd_agent *a)
{
    const float room = ROOM(s), side = ceilf(sqrtf((float)s->agents / (float)(ROOMS * ROOMS)));
    const uint32_t r = index % (ROOMS * ROOMS), place = index / (ROOMS * ROOMS), n = (uint32_t)side;
    const uint32_t up = r / ROOMS, line = place / n;
    const float free = room - 1.0f;
    a->position[0] = room * (float)(r % ROOMS) + 0.5f + free * ((float)(place % n) + 0.5f) / side;
    a->position[1] = room * (float)up + 0.5f + free * ((float)line + 0.5f) / side;
}

static void aim_maze(crowd_scene *s, uint32_t index)
{
    if (is_within(s, index, 2.0f)) follow_another(s, index);
}

/* ---- a square with stalls: boxes of 4 x 2 m; agents stay in front of them for 5 to 15 s ---- */

#define STALLS 12u
#define STALL_REACH 2.5f /* in front of it */

/* Three rows of four. */
static void middle_of_stall(const crowd_scene *s, uint32_t stall, float middle[2])
{
    const uint32_t row = stall / 4u;
    middle[0] = s->extent * ((float)(stall % 4u) + 0.5f) / 4.0f;
    middle[1] = s->extent * ((float)row + 0.5f) / 3.0f;
}

static uint32_t build_stalls(crowd_scene *s, noh_crowd_obstacle *walls)
{
    static const float corner[5][2] = {
        { -2.0f, -1.0f }, { 2.0f, -1.0f }, { 2.0f, 1.0f }, { -2.0f, 1.0f }, { -2.0f, -1.0f }
    };
    uint32_t count = 0;
    for (uint32_t stall = 0; stall < STALLS; stall++) {
        float m[2];
        middle_of_stall(s, stall, m);
        for (uint32_t k = 0; k < 4u; k++) {
            const float *from = corner[k], *to = corner[k + 1u];
            walls[count++] = (noh_crowd_obstacle){ { m[0] + from[0], m[1] + from[1] },
                                                   { m[0] + to[0], m[1] + to[1] },
                                                   0.1f };
        }
    }
    return count;
}

static void goal_of_stall(const crowd_scene *s, uint32_t field, float goal[2])
{
    middle_of_stall(s, field, goal);
    goal[1] -= 1.0f + 0.5f * STALL_REACH;
}

/* Between the rows of stalls. */
static void place_stalls(crowd_scene *s, uint32_t index, noh_crowd_agent *a)
{
    const uint32_t columns = (uint32_t)(s->extent / 0.8f), row = index / columns, lap = row / 3u;
    a->position[0] = 0.8f * ((float)(index % columns) + 0.5f);
    a->position[1] = s->extent * ((float)(row % 3u) + 0.9f) / 3.0f + 0.8f * (float)lap;
}

static void aim_stalls(crowd_scene *s, uint32_t index)
{
    if (s->rest[index]) {
        if (--s->rest[index]) return;
        noh_crowd_set_speed(s->crowd, index, s->kind->speed);
        follow_another(s, index);
    } else if (s->field[index] == NO_FIELD) {
        follow_another(s, index);
    } else if (is_within(s, index, STALL_REACH)) {
        s->rest[index] = 150u + choice(s, 300u);
        noh_crowd_set_speed(s->crowd, index, 0.0f);
    }
}

static const kind kinds[] = {
    { "circle250", 250, 300.0, 1.5f, 2.0f, 15.0f, 0.0f, 0, NULL, place_circle, NULL, arrived_circle },
    { "door200", 200, 120.0, 0.25f, 1.3f, 2.0f, 1.0f, 0, build_door, place_door, aim_door, arrived_door },
    { "dense1000", 1000, 30.0, 0.25f, 1.3f, 2.0f, 1.0f, 0, NULL, place_square, aim_square, NULL },
    { "open10000", 10000, 30.0, 0.3f, 1.3f, 3.0f, 2.0f, 0, NULL, place_square, aim_square, NULL },
    { "maze400", 400, 120.0, 0.25f, 1.3f, 2.0f, 2.0f, 4, build_maze, place_maze, aim_maze, NULL },
    { "stalls600", 600, 120.0, 0.25f, 1.3f, 2.0f, 2.0f, STALLS, build_stalls, place_stalls, aim_stalls, NULL },
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
    tool_usage("--test must be circle250, door200, dense1000, open10000, maze400 or stalls600, not '%s'%s%s%s", name,
               near ? " (did you mean '" : "", near ? near : "", near ? "'?)" : "");
    return NULL;
}

/* ---- open and close ---- */

/* The least x and z of the area. */
static float low_of(const crowd_scene *s)
{
    const int is_circle = s->kind->arrived == arrived_circle, is_door = s->kind->arrived == arrived_door;
    return is_circle ? -1.1f * s->extent : is_door ? -30.0f - (float)s->side : 0.0f;
}

/* The area and its obstacles. */
static noh_crowd_desc desc_of(crowd_scene *s, uint32_t job_count, noh_crowd_obstacle walls[WALLS_MAX])
{
    const float low = low_of(s);
    noh_crowd_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.agent_max = s->agents;
    desc.job_count = job_count;
    desc.origin[0] = desc.origin[1] = low;
    desc.extent[0] = desc.extent[1] = low < 0.0f ? -2.0f * low : s->extent;
    desc.reach = s->kind->reach;
    desc.obstacle_count = s->kind->build ? s->kind->build(s, walls) : 0;
    desc.obstacles = walls;
    desc.field_count = s->kind->fields;
    desc.field_radius = 1.1f * s->kind->radius;
    return desc;
}

static void build_fields(crowd_scene *s)
{
    for (uint32_t i = 0; i < s->kind->fields; i++) {
        float goal[2];
        if (s->kind->build == build_maze)
            goal_of_maze(s, i, goal);
        else
            goal_of_stall(s, i, goal);
        noh_crowd_field_aim(s->crowd, i, goal);
    }
    while (noh_crowd_field_build(s->crowd, 1000000)) {}
}

static int open_crowd(crowd_scene *s, const crowd_scene_options *o)
{
    noh_crowd_obstacle walls[WALLS_MAX];
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_crowd_desc desc = desc_of(s, o->job_count, walls);
    const size_t bytes = noh_crowd_size(&desc);
    s->memory = malloc(bytes ? bytes : 1);
    if (!s->memory || noh_crowd_init(s->memory, bytes, &desc, &s->crowd, &error)) {
        return tool_fail(s->kind->name, "%s", s->memory ? error.what : "out of memory");
    }
    desc.field_count = 0;
    s->bytes = noh_crowd_size(&desc);
    s->field_bytes = bytes - s->bytes;
    build_fields(s);
    for (uint32_t i = 0; i < s->agents; i++) {
        noh_crowd_agent a = {
            { 0.0f, 0.0f }, { 0.0f, 0.0f }, { 0.0f, 0.0f }, s->kind->radius, s->kind->speed, o->flags, i
        };
        s->kind->place(s, i, &a);
        if (noh_crowd_add(s->crowd, i, &a, &error)) return tool_fail(s->kind->name, "%s", error.what);
        s->now[i] = a;
        if (s->kind->fields) follow_another(s, i);
        (void)noh_crowd_agent_stepped(s->crowd, i, &s->now[i]);
    }
    return 0;
}

static int has_memory(crowd_scene *s)
{
    s->now = malloc(s->agents * sizeof *s->now);
    s->before = malloc(s->agents * sizeof *s->before);
    s->ahead = malloc(s->agents * sizeof *s->ahead);
    s->field = malloc(s->agents * sizeof *s->field);
    s->rest = calloc(s->agents, sizeof *s->rest);
    return s->now && s->before && s->ahead && s->field && s->rest && crowd_meter_open(&s->meter, s->agents);
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
    for (uint32_t i = 0; i < 4u; i++) (void)chance(s);
    status = has_memory(s) ? 0 : tool_fail(k->name, "out of memory");
    if (!status) {
        for (uint32_t i = 0; i < s->agents; i++) s->field[i] = NO_FIELD;
        status = open_crowd(s, o);
    }
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
    free(s->ahead);
    free(s->field);
    free(s->rest);
    free(s->memory);
    free(s);
}

/* ---- steps ---- */

static void count_arrived(crowd_scene *s)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->agents && s->kind->arrived; i++) count += s->kind->arrived(s, i) ? 1u : 0u;
    if (s->measures.half < 0.0 && 2u * count >= s->agents) s->measures.half = (double)s->step / 30.0;
    if (s->measures.done < 0.0 && count == s->agents) s->measures.done = (double)s->step / 30.0;
}

/* Straight to the goal, or along a flow field. */
static void look_ahead(crowd_scene *s)
{
    for (uint32_t i = 0; i < s->agents; i++) {
        const noh_crowd_agent *a = &s->now[i];
        const float x = a->goal[0] - a->position[0], z = a->goal[1] - a->position[1], far = sqrtf(x * x + z * z);
        s->ahead[i][0] = far > 0.0f ? x / far : 0.0f;
        s->ahead[i][1] = far > 0.0f ? z / far : 0.0f;
        if (s->field[i] != NO_FIELD) (void)noh_crowd_field_at(s->crowd, s->field[i], a->position, s->ahead[i]);
    }
}

int crowd_scene_step(crowd_scene *s)
{
    noh_crowd_agent *agents = s->before;
    if (s->step == s->steps || s->measures.done >= 0.0) return 0;
    look_ahead(s);
    s->before = s->now;
    s->now = agents;
    const uint64_t start = noh_thread_clock_ns();
    (void)noh_crowd_step(s->crowd, NOH_CROWD_STEP_TICKS);
    s->cpu_ns += (double)(noh_thread_clock_ns() - start);
    s->step++;
    for (uint32_t i = 0; i < s->agents; i++) (void)noh_crowd_agent_stepped(s->crowd, i, &s->now[i]);
    crowd_meter_add(&s->meter, s->before, s->now, (const float(*)[2])s->ahead, &s->measures);
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

size_t crowd_scene_field_bytes(const crowd_scene *s)
{
    return s->field_bytes;
}

double crowd_scene_cpu_ns(const crowd_scene *s)
{
    return s->cpu_ns;
}

const noh_crowd_agent *crowd_scene_agent(const crowd_scene *s, uint32_t index)
{
    return &s->now[index];
}
