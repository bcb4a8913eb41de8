/* crowd.c: a crowd's block, its agents, and the phases of its steps. */
#include "stage/crowd/crowd_internal.h"

#include "core/base/math_internal.h"
#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/crowd.h"
#include "noh/low_core.h"
#include "noh/low_life.h"

#define REACH 3.0f /* by default */
#define FIELD_CELL 0.5f
#define FIELD_VISITS 8192u
#define SLOPE_MAX 1.0f
#define FAR 1e6f        /* of places: squares and differences keep their digits */
#define SPEED_MAX 15.0f /* radii per second: a step is shorter than a radius, even for a pushed agent */

/* ---- size and init ---- */

static noh_crowd_desc with_defaults(const noh_crowd_desc *desc)
{
    noh_crowd_desc d = *desc;
    if (!d.job_count) d.job_count = 1;
    if (!(d.reach > 0.0f)) d.reach = REACH;
    if (!(d.field_cell > 0.0f)) d.field_cell = FIELD_CELL;
    if (!(d.slope_max > 0.0f)) d.slope_max = SLOPE_MAX;
    if (!d.field_visits) d.field_visits = FIELD_VISITS;
    return d;
}

static int is_place(const float at[2])
{
    return at[0] >= -FAR && at[0] <= FAR && at[1] >= -FAR && at[1] <= FAR;
}

static int is_length(float length)
{
    return length > 0.0f && length <= FAR;
}

static int is_ground(const noh_field *field)
{
    noh_world world;
    memset(&world, 0, sizeof world);
    world.field = field;
    return noh_world_check(&world, NULL) == NOH_OK;
}

static noh_result check_fields(const noh_crowd_desc *desc, noh_error *error)
{
    crowd_cells cells;
    const noh_crowd_desc d = with_defaults(desc);
    if (d.field_count > NOH_CROWD_FIELDS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "crowd: field_count is above NOH_CROWD_FIELDS_MAX", 0, d.field_count);
    }
    if (!(desc->field_cell >= 0.0f && desc->field_cell <= FAR) ||
        !(d.field_radius >= 0.0f && d.field_radius <= 0.5f * d.reach) || !(0.5f * d.field_cell <= d.reach)) {
        return noh_fail(error, NOH_ERR_ARG, "crowd: field_cell or field_radius is too large", 0, 0);
    }
    if (!(desc->slope_max >= 0.0f && desc->slope_max <= 2.0f) || (desc->ground && !is_ground(desc->ground))) {
        return noh_fail(error, NOH_ERR_ARG, "crowd: the ground has no area, or slope_max is not in 0..2", 0, 0);
    }
    if ((d.field_count || d.ground) && !noh_crowd_flow_cells(&d, &cells)) {
        return noh_fail(error, NOH_ERR_LIMIT, "crowd: too many cells of flow fields or ground: increase field_cell", 0,
                        NOH_CROWD_FIELD_CELLS_MAX);
    }
    return NOH_OK;
}

static noh_result check(const noh_crowd_desc *desc, noh_error *error)
{
    if (!desc->agent_max || desc->agent_max > NOH_CROWD_AGENTS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "crowd: agent_max must be 1 to NOH_CROWD_AGENTS_MAX", 0, desc->agent_max);
    }
    if (desc->job_count > NOH_CROWD_JOBS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "crowd: job_count is above NOH_CROWD_JOBS_MAX", 0, desc->job_count);
    }
    if (desc->obstacle_count > NOH_CROWD_OBSTACLES_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "crowd: obstacle_count is above NOH_CROWD_OBSTACLES_MAX", 0,
                        desc->obstacle_count);
    }
    if (!is_place(desc->origin) || !is_length(desc->extent[0]) || !is_length(desc->extent[1]) ||
        !(desc->reach >= 0.0f && desc->reach <= FAR)) {
        return noh_fail(error, NOH_ERR_ARG, "crowd: origin, extent or reach is out of range", 0, 0);
    }
    for (uint32_t i = 0; i < desc->obstacle_count; i++) {
        const noh_crowd_obstacle *o = &desc->obstacles[i];
        if (!is_place(o->from) || !is_place(o->to) || !(o->radius >= 0.0f && o->radius <= FAR)) {
            return noh_fail(error, NOH_ERR_ARG, "crowd: an obstacle's position or radius is out of range", i, 0);
        }
    }
    return check_fields(desc, error);
}

static uint32_t take(uint32_t *bytes, uint32_t each, uint32_t count)
{
    const uint32_t at = *bytes;
    *bytes += each * count;
    return at;
}

/* The arrays of a valid desc. */
static void lay_out(noh_crowd *c, const noh_crowd_desc *desc)
{
    const uint32_t n = desc->agent_max;
    uint32_t bytes = sizeof *c;
    memset(c, 0, sizeof *c);
    c->agent_max = n;
    c->job_count = desc->job_count;
    c->obstacle_count = desc->obstacle_count;
    c->reach = desc->reach;
    c->cells = noh_crowd_cells_of(desc);
    c->home[0] = (double)noh_crowd_home_of(desc).x;
    c->home[1] = (double)noh_crowd_home_of(desc).z;
    const uint32_t cell_count = c->cells.width * c->cells.depth;
    c->body = take(&bytes, sizeof(crowd_body), n);
    c->wish = take(&bytes, sizeof(crowd_wish), n);
    c->position = take(&bytes, sizeof(vec2), n);
    c->velocity = take(&bytes, sizeof(vec2), n);
    c->plan[0] = take(&bytes, sizeof(vec2), n);
    c->plan[1] = take(&bytes, sizeof(vec2), n);
    c->neighbor = take(&bytes, CROWD_NEIGHBORS * sizeof(uint16_t), n);
    c->id = take(&bytes, sizeof(uint32_t), n);
    c->state = take(&bytes, sizeof(uint32_t), n);
    c->start = take(&bytes, sizeof(uint32_t), cell_count + 1u);
    if (c->obstacle_count) {
        c->round = take(&bytes, sizeof(crowd_round), n);
        c->obstacle = take(&bytes, sizeof(noh_crowd_obstacle), c->obstacle_count);
        c->near_start = take(&bytes, sizeof(uint32_t), cell_count + 1u);
        c->near = take(&bytes, sizeof(uint16_t), noh_crowd_near(&c->cells, desc, NULL, NULL));
    }
    if (desc->field_count) {
        crowd_cells cells;
        (void)noh_crowd_flow_cells(desc, &cells);
        c->flow = bytes = (bytes + 7u) & ~7u;
        bytes += noh_crowd_flow_bytes(&cells, desc->field_count);
    }
    if (desc->ground) {
        crowd_cells cells;
        (void)noh_crowd_flow_cells(desc, &cells);
        c->ground = bytes = (bytes + 3u) & ~3u;
        bytes += noh_crowd_ground_bytes(&cells);
    }
    c->bytes = (bytes + 15u) & ~15u;
}

size_t noh_crowd_size(const noh_crowd_desc *desc)
{
    noh_crowd c;
    NOH_ASSERT(desc && (desc->obstacles || !desc->obstacle_count));
    if (check(desc, NULL)) return 0;
    const noh_crowd_desc d = with_defaults(desc);
    lay_out(&c, &d);
    return c.bytes;
}

noh_result noh_crowd_init(void *memory, size_t bytes, const noh_crowd_desc *desc, noh_crowd **crowd, noh_error *error)
{
    noh_arena arena;
    noh_crowd c;
    NOH_ASSERT(desc && crowd && (desc->obstacles || !desc->obstacle_count));
    noh_result result = check(desc, error);
    if (result) return result;
    const noh_crowd_desc d = with_defaults(desc);
    lay_out(&c, &d);
    result = noh_arena_open(&arena, memory, bytes, c.bytes, error);
    if (result) return result;
    memset(memory, 0, c.bytes);
    *crowd = memory;
    **crowd = c;
    if (c.obstacle_count) {
        for (uint32_t i = 0; i < d.obstacle_count; i++) {
            CROWD_ARRAY(noh_crowd_obstacle, *crowd, obstacle)
            [i] = noh_crowd_obstacle_less(&d.obstacles[i], noh_crowd_home_of(&d));
        }
        noh_crowd_near(&c.cells, &d, CROWD_ARRAY(uint32_t, *crowd, near_start), CROWD_ARRAY(uint16_t, *crowd, near));
    }
    if (c.ground) noh_crowd_ground_init(*crowd, &d); /* which flow fields lead around */
    if (c.flow) noh_crowd_flow_init(*crowd, &d);
    return NOH_OK;
}

/* ---- agents ---- */

/* Flags as stored. */
static uint32_t flags_of(uint32_t flags)
{
    if (flags & NOH_CROWD_ORCA) return CROWD_ORCA;
    return flags == NOH_CROWD_FLOCK ? CROWD_FORCES | CROWD_FLOCK : flags == NOH_CROWD_FORCES ? CROWD_FORCES : 0;
}

static uint32_t given_flags(uint32_t state)
{
    if (state & CROWD_ORCA) return NOH_CROWD_ORCA;
    return state & CROWD_FLOCK ? NOH_CROWD_FLOCK : state & CROWD_FORCES ? NOH_CROWD_FORCES : 0;
}

/* Forget what the agent knew about walls on its path. */
static void begin_anew(noh_crowd *crowd, uint32_t index)
{
    if (crowd->obstacle_count) memset(CROWD_ARRAY(crowd_round, crowd, round) + index, 0, sizeof(crowd_round));
}

noh_result noh_crowd_add(noh_crowd *crowd, uint32_t index, const noh_crowd_agent *agent, noh_error *error)
{
    NOH_ASSERT(crowd && agent && index < crowd->agent_max);
    if (!is_place(agent->position) || !is_place(agent->goal) || !is_place(agent->velocity) ||
        !(agent->radius > 0.0f && agent->radius <= 0.5f * crowd->reach) || agent->flags > NOH_CROWD_FLOCK ||
        !(agent->speed >= 0.0f && agent->speed <= SPEED_MAX * agent->radius)) {
        return noh_fail(error, NOH_ERR_ARG,
                        "agent: a position, goal or velocity is too large, speed is not 0 to 15 radii per second, "
                        "flags are unknown, or radius is not above 0 and at most half of the reach",
                        index, 0);
    }
    crowd_wish *w = CROWD_ARRAY(crowd_wish, crowd, wish) + index;
    w->goal = noh_crowd_from(crowd, agent->goal);
    w->radius = agent->radius;
    w->speed = agent->speed;
    CROWD_ARRAY(vec2, crowd, position)[index] = noh_crowd_from(crowd, agent->position);
    CROWD_ARRAY(vec2, crowd, velocity)[index] = v2(agent->velocity[0], agent->velocity[1]);
    CROWD_ARRAY(uint32_t, crowd, id)[index] = agent->id;
    CROWD_ARRAY(uint32_t, crowd, state)[index] = flags_of(agent->flags);
    begin_anew(crowd, index);
    return NOH_OK;
}

void noh_crowd_remove(noh_crowd *crowd, uint32_t index)
{
    NOH_ASSERT(crowd && index < crowd->agent_max);
    CROWD_ARRAY(crowd_wish, crowd, wish)[index].radius = 0.0f;
}

void noh_crowd_move(noh_crowd *crowd, uint32_t index, const float position[2])
{
    NOH_ASSERT(crowd && position && index < crowd->agent_max && !crowd->to_do);
    vec2 *at = CROWD_ARRAY(vec2, crowd, position) + index;
    const float to[2] = { noh_clamped(position[0], -FAR, FAR), noh_clamped(position[1], -FAR, FAR) };
    *at = noh_crowd_keep_out(crowd, *at, noh_crowd_from(crowd, to), CROWD_CONST(crowd_wish, crowd, wish)[index].radius);
    CROWD_ARRAY(vec2, crowd, velocity)[index] = v2(0.0f, 0.0f);
    begin_anew(crowd, index);
}

void noh_crowd_shift_origin(noh_crowd *crowd, const float by[2])
{
    NOH_ASSERT(crowd && by && !crowd->to_do);
    for (int i = 0; i < 2; i++) crowd->home[i] -= (double)by[i];
}

void noh_crowd_set_goal(noh_crowd *crowd, uint32_t index, const float goal[2])
{
    NOH_ASSERT(crowd && goal && index < crowd->agent_max);
    const float absolute[2] = { noh_clamped(goal[0], -FAR, FAR), noh_clamped(goal[1], -FAR, FAR) };
    crowd_wish *w = CROWD_ARRAY(crowd_wish, crowd, wish) + index;
    const vec2 to = noh_crowd_from(crowd, absolute), by = v2_sub(to, w->goal);
    const float way = v2_length(by);
    w->goal = to;
    if (way > w->radius) begin_anew(crowd, index); /* a goal that wanders is walked round to, too */
    if (crowd->obstacle_count && way > 0.0f) CROWD_ARRAY(crowd_round, crowd, round)[index].nearest += way;
}

void noh_crowd_set_speed(noh_crowd *crowd, uint32_t index, float speed)
{
    NOH_ASSERT(crowd && index < crowd->agent_max);
    crowd_wish *w = CROWD_ARRAY(crowd_wish, crowd, wish) + index;
    w->speed = noh_clamped(speed, 0.0f, SPEED_MAX * w->radius);
}

void noh_crowd_field_aim(noh_crowd *crowd, uint32_t field, const float goal[2])
{
    NOH_ASSERT(crowd && goal && crowd->flow && field < CROWD_CONST(crowd_flow, crowd, flow)->field_count);
    crowd_flow *flow = CROWD_ARRAY(crowd_flow, crowd, flow);
    const crowd_cells *cells = &flow->cells;
    crowd_field *f = CROWD_ARRAY(crowd_field, flow, field) + field;
    const vec2 at = noh_crowd_from(crowd, goal);
    f->asked = v2(noh_clamped(at.x, cells->origin.x, cells->origin.x + (float)cells->width * cells->edge),
                  noh_clamped(at.z, cells->origin.z, cells->origin.z + (float)cells->depth * cells->edge));
    f->is_asked = 1;
}

uint32_t noh_crowd_field_build(noh_crowd *crowd, uint32_t visits)
{
    NOH_ASSERT(crowd && !crowd->to_do);
    return crowd->flow ? noh_crowd_flow_build(crowd, visits) : 0;
}

void noh_crowd_follow(noh_crowd *crowd, uint32_t index, uint32_t field)
{
    NOH_ASSERT(crowd && index < crowd->agent_max);
    NOH_ASSERT(field == NOH_NONE || (crowd->flow && field < CROWD_CONST(crowd_flow, crowd, flow)->field_count));
    uint32_t *state = CROWD_ARRAY(uint32_t, crowd, state) + index;
    const uint32_t follows = field == NOH_NONE ? 0 : field + 1u;
    *state = (*state & (CROWD_FLAGS | CROWD_WAITED)) | follows << CROWD_FOLLOWS_SHIFT;
}

int noh_crowd_field_at(const noh_crowd *crowd, uint32_t field, const float at[2], float direction[2])
{
    vec2 way;
    NOH_ASSERT(crowd && at && direction && crowd->flow);
    const crowd_field *f = noh_crowd_followed(crowd, (field + 1u) << CROWD_FOLLOWS_SHIFT);
    if (!f->is_built || !noh_crowd_flow_way(crowd, f, noh_crowd_from(crowd, at), &way)) return 0;
    direction[0] = way.x;
    direction[1] = way.z;
    return 1;
}

int noh_crowd_agent_stepped(const noh_crowd *crowd, uint32_t index, noh_crowd_agent *agent)
{
    NOH_ASSERT(crowd && agent && index < crowd->agent_max);
    const crowd_wish *w = CROWD_CONST(crowd_wish, crowd, wish) + index;
    if (!(w->radius > 0.0f)) return 0;
    noh_crowd_to(crowd, CROWD_CONST(vec2, crowd, position)[index], agent->position);
    memcpy(agent->velocity, CROWD_CONST(vec2, crowd, velocity) + index, sizeof agent->velocity);
    const crowd_field *field = noh_crowd_followed(crowd, CROWD_CONST(uint32_t, crowd, state)[index]);
    noh_crowd_to(crowd, field ? field->asked : w->goal, agent->goal);
    agent->radius = w->radius;
    agent->speed = w->speed;
    agent->flags = given_flags(CROWD_CONST(uint32_t, crowd, state)[index]);
    agent->id = CROWD_CONST(uint32_t, crowd, id)[index];
    return 1;
}

int noh_crowd_shown(const noh_crowd *crowd, uint32_t index, float at[2])
{
    NOH_ASSERT(crowd && at && index < crowd->agent_max);
    const vec2 position = CROWD_CONST(vec2, crowd, position)[index],
               velocity = CROWD_CONST(vec2, crowd, velocity)[index];
    const float ago = CROWD_STEP_S * (1.0f - (float)crowd->time.left * (1.0f / (float)NOH_CROWD_STEP_TICKS));
    at[0] = position.x - ago * velocity.x;
    at[1] = position.z - ago * velocity.z;
    return CROWD_CONST(crowd_wish, crowd, wish)[index].radius > 0.0f;
}

int noh_crowd_agent_at(const noh_crowd *crowd, uint32_t index, noh_crowd_agent *agent)
{
    float at[2];
    if (!noh_crowd_agent_stepped(crowd, index, agent)) return 0;
    (void)noh_crowd_shown(crowd, index, at);
    noh_crowd_to(crowd, v2(at[0], at[1]), agent->position);
    return 1;
}

uint32_t noh_crowd_hash(const noh_crowd *crowd)
{
    uint32_t sum = 0;
    NOH_ASSERT(crowd);
    for (uint32_t i = 0; i < crowd->agent_max; i++) {
        noh_crowd_agent agent;
        if (noh_crowd_agent_stepped(crowd, i, &agent)) sum += noh_crc32c(0, &agent, sizeof agent);
    }
    return sum;
}

/* ---- steps ---- */

/* Phases. SORT ends before jobs begin. */
#define SORT 0u
#define SEE 1u
#define ITERATE 2u
#define FINISH (ITERATE + CROWD_ITERATIONS)

uint32_t noh_crowd_begin(noh_crowd *crowd, uint32_t ticks)
{
    NOH_ASSERT(crowd && !crowd->to_do);
    crowd->to_do = noh_steps_take(&crowd->time, ticks, NOH_CROWD_STEP_TICKS, NOH_CROWD_STEPS_MAX);
    crowd->phase = SORT;
    return crowd->to_do;
}

uint32_t noh_crowd_jobs(noh_crowd *crowd)
{
    NOH_ASSERT(crowd);
    if (!crowd->to_do) return 0;
    if (crowd->phase == FINISH) {
        crowd->phase = SORT;
        if (!--crowd->to_do) return 0;
    }
    if (crowd->phase == SORT) {
        if (crowd->flow) (void)noh_crowd_flow_build(crowd, CROWD_CONST(crowd_flow, crowd, flow)->visits);
        noh_crowd_sort(crowd);
    }
    crowd->phase = crowd->phase == SEE && !crowd->corrected ? FINISH : crowd->phase + 1u;
    return crowd->job_count;
}

void noh_crowd_job(noh_crowd *crowd, uint32_t job)
{
    NOH_ASSERT(crowd && job < crowd->job_count && crowd->phase >= SEE && crowd->phase <= FINISH);
    const uint32_t begin = (uint32_t)((uint64_t)crowd->present * job / crowd->job_count);
    const uint32_t end = (uint32_t)((uint64_t)crowd->present * (job + 1u) / crowd->job_count);
    crowd_runs runs;
    runs.until = 0;
    if (crowd->phase > SEE && crowd->phase < FINISH) {
        noh_crowd_iterate(crowd, begin, end, crowd->phase - ITERATE);
        return;
    }
    for (uint32_t rank = begin; rank < end; rank++) {
        if (crowd->phase == SEE) {
            noh_crowd_runs_of(crowd, rank, &runs);
            noh_crowd_see(crowd, rank, &runs);
            noh_crowd_plan(crowd, rank, &runs);
        } else {
            noh_crowd_finish(crowd, rank);
        }
    }
}

uint32_t noh_crowd_step(noh_crowd *crowd, uint32_t ticks)
{
    const uint32_t steps = noh_crowd_begin(crowd, ticks);
    for (uint32_t count; (count = noh_crowd_jobs(crowd)) > 0;) {
        for (uint32_t i = 0; i < count; i++) noh_crowd_job(crowd, i);
    }
    return steps;
}
