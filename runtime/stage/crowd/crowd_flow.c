/* crowd_flow.c: flow fields: for each cell the direction of the shortest way to a goal, built a few cells at a time.
 *
 * The length d of the shortest way satisfies |grad d| = 1 (an eikonal equation). Sweeps over the grid in four orders
 * solve it; each visits only cells with a changed neighbour. When none are left, each cell's direction is the direction
 * in which d falls. Lengths only decrease, each time by LEAST or more, so the sweeps end.
 * source   Zhao: A fast sweeping method for Eikonal equations, Mathematics of Computation 2005; Bak, McLaughlin, Renzi:
 *          Some improvements for the fast sweeping method, SIAM Journal on Scientific Computing 2010 */
#include "core/base/trig_internal.h"
#include "noh/base.h"
#include "noh/crowd.h"
#include "noh/low_core.h"
#include "stage/crowd/crowd_internal.h"

#define BLOCKED -1.0f
#define UNKNOWN 1e30f
#define LEAST 0.002f /* of a cell: gains that are smaller are not worth a look at the neighbours */

/* Phases. */
#define PREPARE 0u
#define SWEEP 1u
#define POINT 2u

int noh_crowd_flow_cells(const noh_crowd_desc *desc, crowd_cells *cells)
{
    const float wide = desc->extent[0] / desc->field_cell, deep = desc->extent[1] / desc->field_cell;
    if (!(wide < 65536.0f && deep < 65536.0f)) return 0;
    cells->origin = v2_sub(v2(desc->origin[0], desc->origin[1]), noh_crowd_home_of(desc));
    cells->edge = desc->field_cell;
    cells->per_edge = 1.0f / cells->edge;
    cells->width = (uint32_t)wide + ((float)(uint32_t)wide < wide ? 1u : 0u);
    cells->depth = (uint32_t)deep + ((float)(uint32_t)deep < deep ? 1u : 0u);
    if (!cells->width) cells->width = 1;
    if (!cells->depth) cells->depth = 1;
    return (uint64_t)cells->width * cells->depth <= NOH_CROWD_FIELD_CELLS_MAX;
}

static uint32_t count_of(const crowd_cells *cells)
{
    return cells->width * cells->depth;
}

static vec2 middle_of(const crowd_cells *cells, uint32_t column, uint32_t row)
{
    return v2(cells->origin.x + ((float)column + 0.5f) * cells->edge,
              cells->origin.z + ((float)row + 0.5f) * cells->edge);
}

uint32_t noh_crowd_flow_bytes(const crowd_cells *cells, uint32_t field_count)
{
    return (uint32_t)sizeof(crowd_flow) + CROWD_CODES * (uint32_t)sizeof(vec2) +
           field_count * (uint32_t)sizeof(crowd_field) + count_of(cells) * ((uint32_t)sizeof(float) + 1u + field_count);
}

/* Whether an agent of a radius can stand somewhere. */
static int is_blocked(const noh_crowd *c, vec2 at, float radius)
{
    const noh_crowd_obstacle *obstacles = CROWD_CONST(noh_crowd_obstacle, c, obstacle);
    const uint16_t *near = NULL;
    const uint32_t count = noh_crowd_near_of(c, at, &near);
    for (uint32_t k = 0; k < count; k++) {
        const noh_crowd_obstacle *o = &obstacles[near[k]];
        const vec2 away = noh_crowd_away_from(o, at);
        const float clear = radius + o->radius;
        if (v2_dot(away, away) <= clear * clear) return 1;
    }
    return 0;
}

static void find_blocked(const noh_crowd *c, crowd_flow *flow, float radius)
{
    float *distance = CROWD_ARRAY(float, flow, distance);
    for (uint32_t row = 0; row < flow->cells.depth; row++) {
        for (uint32_t column = 0; column < flow->cells.width; column++) {
            const vec2 at = middle_of(&flow->cells, column, row);
            *distance++ = is_blocked(c, at, radius) || noh_crowd_is_steep(c, at) ? BLOCKED : UNKNOWN;
        }
    }
}

/* At least half a cell, so that no path between centres of adjacent cells leads through a wall. */
void noh_crowd_flow_init(noh_crowd *c, const noh_crowd_desc *desc)
{
    crowd_flow *flow = CROWD_ARRAY(crowd_flow, c, flow);
    (void)noh_crowd_flow_cells(desc, &flow->cells);
    const uint32_t cell_count = count_of(&flow->cells), n = desc->field_count;
    const float least = 0.5f * desc->field_cell;
    uint32_t codes;
    flow->field_count = n;
    flow->visits = desc->field_visits;
    flow->building = NOH_NONE;
    flow->direction = sizeof *flow;
    flow->field = flow->direction + CROWD_CODES * (uint32_t)sizeof(vec2);
    flow->distance = flow->field + n * (uint32_t)sizeof(crowd_field);
    flow->codes = codes = flow->distance + cell_count * (uint32_t)sizeof(float);
    for (uint32_t i = 0; i < n; i++) CROWD_ARRAY(crowd_field, flow, field)[i].codes = codes += cell_count;
    for (uint32_t code = 1; code < CROWD_CODES; code++) {
        vec2 *d = CROWD_ARRAY(vec2, flow, direction) + code;
        noh_sin_cos_turn((code - 1u) * 0x01010101u, &d->z, &d->x);
    }
    find_blocked(c, flow, desc->field_radius > least ? desc->field_radius : least);
}

/* ---- phases: each visits one cell at a time, and returns whether it is finished ---- */

/* Mark blocked cells and find the free cell nearest to the goal. */
static void prepare(crowd_flow *flow, uint32_t end)
{
    float *distance = CROWD_ARRAY(float, flow, distance);
    uint8_t *awake = CROWD_ARRAY(uint8_t, flow, codes);
    for (uint32_t i = flow->cursor; i < end; i++) {
        awake[i] = 0;
        if (distance[i] == BLOCKED) continue;
        const vec2 to = v2_sub(middle_of(&flow->cells, i % flow->cells.width, i / flow->cells.width), flow->goal);
        const float square = v2_dot(to, to);
        distance[i] = UNKNOWN;
        if (square >= flow->source_square) continue;
        flow->source_square = square;
        flow->source = i;
    }
}

/* The four adjacent cells; outside the grid, the cell itself. */
static void around(const crowd_cells *cells, uint32_t column, uint32_t row, uint32_t next[4])
{
    const uint32_t i = row * cells->width + column;
    next[0] = column ? i - 1u : i;
    next[1] = column + 1u < cells->width ? i + 1u : i;
    next[2] = row ? i - cells->width : i;
    next[3] = row + 1u < cells->depth ? i + cells->width : i;
}

/* The nearer of two neighbours. */
static inline float nearer(const float *distance, uint32_t a, uint32_t b)
{
    const float x = distance[a] < 0.0f ? UNKNOWN : distance[a], y = distance[b] < 0.0f ? UNKNOWN : distance[b];
    return x < y ? x : y;
}

static float solve(float a, float b, float edge)
{
    const float low = a < b ? a : b, gap = a < b ? b - a : a - b;
    return gap >= edge ? low + edge : 0.5f * (a + b + noh_sqrt(2.0f * edge * edge - gap * gap));
}

static void wake_around(crowd_flow *flow, const uint32_t next[4], float distance)
{
    const float *distances = CROWD_CONST(float, flow, distance);
    uint8_t *awake = CROWD_ARRAY(uint8_t, flow, codes);
    for (uint32_t k = 0; k < 4u; k++) {
        if (awake[next[k]] || distances[next[k]] <= distance) continue;
        awake[next[k]] = 1;
        flow->awake++;
    }
}

static void look_at(crowd_flow *flow, uint32_t column, uint32_t row)
{
    float *distance = CROWD_ARRAY(float, flow, distance);
    const uint32_t i = row * flow->cells.width + column;
    uint32_t next[4];
    around(&flow->cells, column, row, next);
    CROWD_ARRAY(uint8_t, flow, codes)[i] = 0;
    flow->awake--;
    const float may = solve(nearer(distance, next[0], next[1]), nearer(distance, next[2], next[3]), flow->cells.edge);
    if (may >= distance[i] - LEAST * flow->cells.edge) return;
    distance[i] = may;
    wake_around(flow, next, may);
}

/* Rows upwards or downwards, each to the right or to the left. */
static void sweep(crowd_flow *flow, uint32_t end)
{
    const uint32_t width = flow->cells.width, depth = flow->cells.depth;
    uint32_t row = flow->cursor / width, column = flow->cursor % width;
    for (uint32_t k = flow->cursor; k < end && flow->awake; k++) {
        const uint32_t x = flow->sweep & 1u ? width - 1u - column : column;
        const uint32_t z = flow->sweep & 2u ? depth - 1u - row : row;
        if (CROWD_CONST(uint8_t, flow, codes)[z * width + x]) look_at(flow, x, z);
        if (++column == width) {
            column = 0;
            row++;
        }
    }
}

static uint8_t code_of(vec2 way)
{
    const uint32_t turn = noh_turn_from_radians(noh_atan2(way.z, way.x));
    return (uint8_t)(1u + (uint32_t)(((uint64_t)turn * 255u + 0x80000000u) >> 32) % 255u);
}

/* The direction in which the path becomes shorter, and by how much; 0 if it does not on either side. */
static float falls(const float *distance, float here, uint32_t before, uint32_t after)
{
    const float low = distance[before] < 0.0f ? UNKNOWN : distance[before];
    const float high = distance[after] < 0.0f ? UNKNOWN : distance[after];
    if (low <= high) return low < here ? low - here : 0.0f;
    return high < here ? here - high : 0.0f;
}

static void point(crowd_flow *flow, uint32_t end)
{
    const float *distance = CROWD_CONST(float, flow, distance);
    uint8_t *codes = CROWD_ARRAY(uint8_t, flow, codes);
    for (uint32_t i = flow->cursor; i < end; i++) {
        const uint32_t column = i % flow->cells.width, row = i / flow->cells.width;
        const float here = distance[i];
        uint32_t next[4];
        if (here < 0.0f || here == UNKNOWN) continue; /* its code is 0 since it sleeps */
        around(&flow->cells, column, row, next);
        const vec2 way = i == flow->source
                             ? v2_sub(flow->goal, middle_of(&flow->cells, column, row))
                             : v2(falls(distance, here, next[0], next[1]), falls(distance, here, next[2], next[3]));
        codes[i] = code_of(way);
    }
}

/* ---- building fields one after another ---- */

/* The next requested field. returns 0 if there is none */
static int begin_next(crowd_flow *flow)
{
    crowd_field *fields = CROWD_ARRAY(crowd_field, flow, field);
    for (uint32_t k = 0; k < flow->field_count; k++) {
        const uint32_t i = (flow->next + k) % flow->field_count;
        if (!fields[i].is_asked) continue;
        flow->building = i;
        flow->next = i + 1u;
        flow->phase = PREPARE;
        flow->cursor = flow->sweep = flow->awake = 0;
        flow->source = NOH_NONE;
        flow->source_square = UNKNOWN;
        return 1;
    }
    return 0;
}

static void begin_sweeps(crowd_flow *flow)
{
    uint32_t next[4];
    if (flow->source == NOH_NONE) return; /* all is blocked: nothing wakes */
    const float here = noh_sqrt(flow->source_square);
    CROWD_ARRAY(float, flow, distance)[flow->source] = here;
    around(&flow->cells, flow->source % flow->cells.width, flow->source / flow->cells.width, next);
    wake_around(flow, next, here);
}

/* Swap the new field with the old one, whose memory is used for building the next. */
static void finish(crowd_flow *flow, crowd_field *field)
{
    const uint32_t codes = field->codes;
    field->codes = flow->codes;
    flow->codes = codes;
    field->goal = flow->goal;
    field->is_built = 1;
    flow->building = NOH_NONE;
}

/* Start the next phase if this one is finished. */
static void move_on(crowd_flow *flow, crowd_field *field, uint32_t end)
{
    const uint32_t count = count_of(&flow->cells);
    flow->cursor = end;
    if (flow->phase == SWEEP && !flow->awake) {
        flow->phase = POINT;
        flow->cursor = 0;
    } else if (end == count) {
        flow->cursor = 0;
        if (flow->phase == PREPARE) begin_sweeps(flow);
        if (flow->phase == POINT) finish(flow, field);
        flow->sweep += flow->phase == SWEEP ? 1u : 0u;
        flow->phase = flow->phase == PREPARE ? SWEEP : flow->phase;
    }
}

/* A field requested again during its build is built once more. */
uint32_t noh_crowd_flow_build(noh_crowd *c, uint32_t visits)
{
    crowd_flow *flow = CROWD_ARRAY(crowd_flow, c, flow);
    crowd_field *fields = CROWD_ARRAY(crowd_field, flow, field);
    const uint32_t count = count_of(&flow->cells);
    uint32_t left = 0;
    while (visits && (flow->building != NOH_NONE || begin_next(flow))) {
        crowd_field *field = &fields[flow->building];
        if (flow->phase == PREPARE && !flow->cursor) {
            flow->goal = field->asked;
            field->is_asked = 0;
        }
        const uint32_t end = visits < count - flow->cursor ? flow->cursor + visits : count;
        visits -= end - flow->cursor;
        if (flow->phase == PREPARE)
            prepare(flow, end);
        else if (flow->phase == SWEEP)
            sweep(flow, end);
        else
            point(flow, end);
        move_on(flow, field, end);
    }
    for (uint32_t i = 0; i < flow->field_count; i++) left += fields[i].is_asked ? 1u : 0u;
    return left + (flow->building != NOH_NONE ? 1u : 0u);
}
