/* crowd_grid.c: agents sorted by cell, and the obstacles near each cell. */
#include "stage/crowd/crowd_internal.h"
#include "noh/crowd.h"

crowd_cells noh_crowd_cells_of(const noh_crowd_desc *desc)
{
    const uint32_t most = desc->agent_max / 2u + 1u;
    crowd_cells cells;
    cells.edge = desc->reach;
    for (;;) {
        const float wide = desc->extent[0] / cells.edge, deep = desc->extent[1] / cells.edge;
        if (wide < 32768.0f && deep < 32768.0f) {
            cells.width = (uint32_t)wide + 1u;
            cells.depth = (uint32_t)deep + 1u;
            if (cells.width * cells.depth <= most) break;
        }
        cells.edge *= 1.0625f;
    }
    cells.origin = v2_sub(v2(desc->origin[0], desc->origin[1]), noh_crowd_home_of(desc));
    cells.per_edge = 1.0f / cells.edge;
    return cells;
}

static inline uint32_t clamped(float at, uint32_t count)
{
    if (!(at > 0.0f)) return 0;
    return at >= (float)count ? count - 1u : (uint32_t)at;
}

uint32_t noh_crowd_cell_at(const crowd_cells *cells, vec2 at, uint32_t *column, uint32_t *row)
{
    *column = clamped((at.x - cells->origin.x) * cells->per_edge, cells->width);
    *row = clamped((at.z - cells->origin.z) * cells->per_edge, cells->depth);
    return *row * cells->width + *column;
}

void noh_crowd_find_runs(const noh_crowd *c, uint32_t rank, crowd_runs *runs)
{
    const uint32_t *start = CROWD_CONST(uint32_t, c, start);
    const uint32_t width = c->cells.width;
    uint32_t column, row;
    const uint32_t cell = noh_crowd_cell_at(&c->cells, CROWD_CONST(crowd_body, c, body)[rank].at, &column, &row);
    const uint32_t left = column ? column - 1u : 0, right = column + 1u < width ? column + 1u : column;
    runs->count = 0;
    runs->until = start[cell + 1u];
    for (uint32_t r = row ? row - 1u : 0; r <= row + 1u && r < c->cells.depth; r++) {
        runs->first[runs->count] = start[r * width + left];
        runs->end[runs->count++] = start[r * width + right + 1u];
    }
}

/* ---- obstacles ---- */

static int is_near(const crowd_cells *cells, const noh_crowd_obstacle *o, uint32_t column, uint32_t row, float reach)
{
    const vec2 middle = v2(cells->origin.x + ((float)column + 0.5f) * cells->edge,
                           cells->origin.z + ((float)row + 0.5f) * cells->edge);
    const vec2 from = v2(o->from[0], o->from[1]), along = v2_sub(v2(o->to[0], o->to[1]), from);
    const float square = v2_dot(along, along), far = reach + o->radius + 0.7072f * cells->edge;
    float t = square > 0.0f ? v2_dot(v2_sub(middle, from), along) / square : 0.0f;
    t = t < 0.0f ? 0.0f : t > 1.0f ? 1.0f : t;
    const vec2 away = v2_sub(middle, v2_madd(from, t, along));
    return v2_dot(away, away) <= far * far;
}

/* What a walk over obstacles does with each cell that one is near: it counts them in start[cell + 1] (list NULL), or
 * lists the obstacle where start[cell + 1] says, and moves that on. */
static uint32_t walk(const crowd_cells *cells, const noh_crowd_desc *desc, uint32_t *start, uint16_t *list)
{
    const vec2 home = noh_crowd_home_of(desc);
    uint32_t count = 0;
    for (uint32_t i = 0; i < desc->obstacle_count; i++) {
        const noh_crowd_obstacle at = noh_crowd_obstacle_less(&desc->obstacles[i], home), *o = &at;
        const float far = desc->reach + o->radius;
        const int right = o->to[0] > o->from[0], up = o->to[1] > o->from[1];
        uint32_t low[2], high[2];
        noh_crowd_cell_at(cells, v2((right ? o->from[0] : o->to[0]) - far, (up ? o->from[1] : o->to[1]) - far), &low[0],
                          &low[1]);
        noh_crowd_cell_at(cells, v2((right ? o->to[0] : o->from[0]) + far, (up ? o->to[1] : o->from[1]) + far),
                          &high[0], &high[1]);
        for (uint32_t row = low[1]; row <= high[1]; row++) {
            for (uint32_t column = low[0]; column <= high[0]; column++) {
                if (!is_near(cells, o, column, row, desc->reach)) continue;
                const uint32_t cell = row * cells->width + column;
                if (start && list) list[start[cell + 1u]] = (uint16_t)i;
                if (start) start[cell + 1u]++;
                count++;
            }
        }
    }
    return count;
}

/* start[k + 1], a count, becomes where cell k begins. Filling the cells then moves it on to where k ends, which is
 * where k + 1 begins. */
static uint32_t begin_cells(uint32_t *start, uint32_t cell_count)
{
    uint32_t sum = 0;
    for (uint32_t k = 1; k <= cell_count; k++) {
        const uint32_t count = start[k];
        start[k] = sum;
        sum += count;
    }
    return sum;
}

uint32_t noh_crowd_near(const crowd_cells *cells, const noh_crowd_desc *desc, uint32_t *start, uint16_t *list)
{
    if (start) {
        const uint32_t cell_count = cells->width * cells->depth;
        memset(start, 0, (cell_count + 1u) * sizeof *start);
        walk(cells, desc, start, NULL);
        begin_cells(start, cell_count);
    }
    return walk(cells, desc, start, list);
}

/* ---- agents ---- */

/* A counting sort. Ranks within a cell follow indices; nothing else depends on indices. */
void noh_crowd_sort(noh_crowd *c)
{
    const crowd_wish *wishes = CROWD_CONST(crowd_wish, c, wish);
    const vec2 *positions = CROWD_CONST(vec2, c, position), *velocities = CROWD_CONST(vec2, c, velocity);
    uint32_t *start = CROWD_ARRAY(uint32_t, c, start), *cell_of = CROWD_ARRAY(uint32_t, c, plan[0]);
    vec2 *now = CROWD_ARRAY(vec2, c, plan[1]); /* velocities by rank, which the plans are made of */
    const uint32_t *states = CROWD_CONST(uint32_t, c, state);
    crowd_body *bodies = CROWD_ARRAY(crowd_body, c, body);
    const uint32_t cell_count = c->cells.width * c->cells.depth;
    memset(start, 0, (cell_count + 1u) * sizeof *start);
    for (uint32_t i = 0; i < c->agent_max; i++) {
        uint32_t column, row;
        if (!(wishes[i].radius > 0.0f)) continue;
        cell_of[i] = noh_crowd_cell_at(&c->cells, positions[i], &column, &row);
        start[cell_of[i] + 1u]++;
    }
    c->present = begin_cells(start, cell_count);
    c->corrected = 0;
    for (uint32_t i = 0; i < c->agent_max; i++) {
        if (!(wishes[i].radius > 0.0f)) continue;
        const uint32_t rank = start[cell_of[i] + 1u]++;
        bodies[rank].at = positions[i];
        bodies[rank].radius = wishes[i].radius;
        bodies[rank].item = i | (states[i] & CROWD_FLAGS) | (wishes[i].speed > 0.0f ? 0u : CROWD_HOLDS);
        c->corrected += !(bodies[rank].item & (CROWD_ORCA | CROWD_HOLDS));
        now[rank] = velocities[i];
    }
}
