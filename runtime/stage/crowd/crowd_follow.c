/* crowd_follow.c: the direction of a flow field at a position, interpolated between the four cells around it. */
#include "stage/crowd/crowd_internal.h"
#include "noh/crowd.h"

const crowd_field *noh_crowd_followed(const noh_crowd *c, uint32_t state)
{
    const uint32_t follows = state >> CROWD_FOLLOWS_SHIFT & 0xffu;
    if (!follows) return NULL;
    const crowd_flow *flow = CROWD_CONST(crowd_flow, c, flow);
    return CROWD_CONST(crowd_field, flow, field) + follows - 1u;
}

static const uint8_t *codes_of(const crowd_flow *flow, const crowd_field *field)
{
    return (const uint8_t *)flow + field->codes;
}

static float part_of(float part)
{
    return part > 0.0f ? part < 1.0f ? part : 1.0f : 0.0f;
}

/* Directions that lead around the other side of an obstacle are ignored: they would cancel. */
static vec2 between(const crowd_flow *flow, const uint8_t *codes, vec2 at, vec2 own)
{
    const vec2 *directions = CROWD_CONST(vec2, flow, direction);
    const crowd_cells *cells = &flow->cells;
    const vec2 half = v2(at.x - 0.5f * cells->edge, at.z - 0.5f * cells->edge);
    uint32_t column, row;
    vec2 sum = v2(0.0f, 0.0f);
    (void)noh_crowd_cell_at(cells, half, &column, &row);
    const float u = part_of((half.x - cells->origin.x) * cells->per_edge - (float)column);
    const float v = part_of((half.z - cells->origin.z) * cells->per_edge - (float)row);
    const float weights[4] = { (1.0f - u) * (1.0f - v), u * (1.0f - v), (1.0f - u) * v, u * v };
    for (uint32_t k = 0; k < 4u; k++) {
        const uint32_t x = column + (k & 1u), z = row + (k >> 1);
        if (x >= cells->width || z >= cells->depth || !(weights[k] > 0.0f)) continue;
        const uint32_t code = codes[z * cells->width + x];
        if (code && v2_dot(directions[code], own) > 0.0f) sum = v2_madd(sum, weights[k], directions[code]);
    }
    return sum;
}

/* From where no way leads, such as close to a wall: the direction of the nearest place from which one does, two cells
 * away or nearer. */
static int way_back(const noh_crowd *c, const crowd_flow *flow, const uint8_t *codes, vec2 at, vec2 *direction)
{
    const crowd_cells *cells = &flow->cells;
    float best = 1e30f;
    uint32_t column, row;
    (void)noh_crowd_cell_at(cells, at, &column, &row);
    for (uint32_t z = row > 2u ? row - 2u : 0; z <= row + 2u && z < cells->depth; z++) {
        for (uint32_t x = column > 2u ? column - 2u : 0; x <= column + 2u && x < cells->width; x++) {
            if (!codes[z * cells->width + x]) continue;
            const vec2 middle = v2(cells->origin.x + ((float)x + 0.5f) * cells->edge,
                                   cells->origin.z + ((float)z + 0.5f) * cells->edge);
            const vec2 to = v2_sub(middle, at);
            const float square = v2_dot(to, to);
            if (square >= best || !(square > 1e-12f) || !noh_crowd_sees(c, at, middle)) continue;
            best = square;
            *direction = v2_scale(to, 1.0f / noh_sqrt(square));
        }
    }
    return best < 1e30f;
}

int noh_crowd_flow_way(const noh_crowd *c, const crowd_field *field, vec2 at, vec2 *direction)
{
    const crowd_flow *flow = CROWD_CONST(crowd_flow, c, flow);
    const uint8_t *codes = codes_of(flow, field);
    uint32_t column, row;
    const uint32_t code = codes[noh_crowd_cell_at(&flow->cells, at, &column, &row)];
    if (!code) return way_back(c, flow, codes, at, direction);
    const vec2 own = CROWD_CONST(vec2, flow, direction)[code], way = between(flow, codes, at, own);
    const float square = v2_dot(way, way);
    *direction = square > 1e-6f ? v2_scale(way, 1.0f / noh_sqrt(square)) : own;
    return 1;
}
