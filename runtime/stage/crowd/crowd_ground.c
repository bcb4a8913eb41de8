/* crowd_ground.c: how steep the ground is, by cells, and how fast it lets agents walk.
 *
 * source   Tobler: Three presentations on geographical analysis and modeling, NCGIA report 93-1, 1993 (the speed on a
 *          map is 6 e^(-3.5 |rise / run + 0.05|) km/h; here as a share of that on level ground) */
#include "core/base/trig_internal.h"
#include "noh/body.h"
#include "noh/crowd.h"
#include "stage/crowd/crowd_internal.h"

#define GRADES 64.0f      /* steps of a rise of its run */
#define STEEPNESS 5.0494f /* 3.5 / ln 2 */
#define EASIEST 0.05f     /* the downward slope with the highest speed */
#define SLOWEST 0.2f      /* downhill, however steep */

uint32_t noh_crowd_ground_bytes(const crowd_cells *cells)
{
    return (uint32_t)sizeof(crowd_ground) + 2u * cells->width * cells->depth;
}

static int8_t grade_of(const noh_field *field, float low_x, float low_z, float high_x, float high_z, float run)
{
    float low, high;
    if (!noh_field_height(field, low_x, low_z, &low, NULL) || !noh_field_height(field, high_x, high_z, &high, NULL)) {
        return 0;
    }
    const float steps = (high - low) / run * GRADES;
    return steps >= 127.0f ? 127 : steps <= -127.0f ? -127 : (int8_t)(steps + (steps < 0.0f ? -0.5f : 0.5f));
}

/* Slopes from edge to edge of each cell; the ground between may be rougher. */
void noh_crowd_ground_init(noh_crowd *c, const noh_crowd_desc *desc)
{
    crowd_ground *ground = CROWD_ARRAY(crowd_ground, c, ground);
    int8_t *grades = (int8_t *)(ground + 1);
    (void)noh_crowd_flow_cells(desc, &ground->cells);
    ground->slope_max = desc->slope_max;
    const float edge = ground->cells.edge, half = 0.5f * edge;
    const vec2 home = noh_crowd_home_of(desc);
    for (uint32_t row = 0; row < ground->cells.depth; row++) {
        for (uint32_t column = 0; column < ground->cells.width; column++, grades += 2) {
            const float x = ground->cells.origin.x + ((float)column + 0.5f) * edge + home.x;
            const float z = ground->cells.origin.z + ((float)row + 0.5f) * edge + home.z;
            grades[0] = grade_of(desc->ground, x - half, z, x + half, z, edge);
            grades[1] = grade_of(desc->ground, x, z - half, x, z + half, edge);
        }
    }
}

static vec2 slope_at(const crowd_ground *ground, vec2 at)
{
    const int8_t *grades = (const int8_t *)(ground + 1);
    uint32_t column, row;
    grades += 2u * noh_crowd_cell_at(&ground->cells, at, &column, &row);
    return v2((float)grades[0] * (1.0f / GRADES), (float)grades[1] * (1.0f / GRADES));
}

int noh_crowd_is_steep(const noh_crowd *c, vec2 at)
{
    if (!c->ground) return 0;
    const crowd_ground *ground = CROWD_CONST(crowd_ground, c, ground);
    const vec2 slope = slope_at(ground, at);
    return v2_dot(slope, slope) > ground->slope_max * ground->slope_max;
}

float noh_crowd_ease(const noh_crowd *c, vec2 at, vec2 direction)
{
    const crowd_ground *ground = CROWD_CONST(crowd_ground, c, ground);
    const float rise = v2_dot(slope_at(ground, at), direction), off = rise + EASIEST;
    if (rise > ground->slope_max) return 0.0f;
    const float ease = noh_exp2(STEEPNESS * (EASIEST - (off < 0.0f ? -off : off)));
    return rise < 0.0f && ease < SLOWEST ? SLOWEST : ease;
}
