#include "occlusion.h"

#include "shared/grab.h"

#include <math.h>
#include <stdlib.h>

/* A depth map of the mask from the front: half a millimetre a cell. */
enum { WIDE = 400, HIGH = 500 };
static const double cell = 0.0005, nothing = -1;
static double map[HIGH][WIDE];

static double to_column(double x)
{
    return x / cell + WIDE / 2.0;
}
static double to_row(double y)
{
    return y / cell + HIGH / 2.0;
}

static double edge_side(V3 a, V3 b, double x, double y)
{
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

static int cell_from(double low, int limit)
{
    return (int)clamp(floor(low), 0, limit - 1);
}

static void draw_triangle(V3 a, V3 b, V3 c)
{
    V3 *corners[3] = { &a, &b, &c };
    double x0 = WIDE, x1 = 0, y0 = HIGH, y1 = 0;
    for (int i = 0; i < 3; i++) {
        corners[i]->x = to_column(corners[i]->x);
        corners[i]->y = to_row(corners[i]->y);
        x0 = fmin(x0, corners[i]->x);
        x1 = fmax(x1, corners[i]->x);
        y0 = fmin(y0, corners[i]->y);
        y1 = fmax(y1, corners[i]->y);
    }
    double area = edge_side(a, b, c.x, c.y);
    if (area <= 1e-9) {
        return;
    } /* from behind */
    for (int row = cell_from(y0, HIGH); row <= cell_from(y1, HIGH); row++) {
        for (int column = cell_from(x0, WIDE); column <= cell_from(x1, WIDE); column++) {
            double x = column + 0.5, y = row + 0.5;
            double ka = edge_side(b, c, x, y), kb = edge_side(c, a, x, y), kc = edge_side(a, b, x, y);
            if (ka < 0 || kb < 0 || kc < 0) {
                continue;
            }
            double z = (ka * a.z + kb * b.z + kc * c.z) / area;
            if (z > map[row][column]) {
                map[row][column] = z;
            }
        }
    }
}

static void draw_part(const Part *part, const Frame *frame)
{
    for (int i = 0; i < part->index_count; i += 3) {
        draw_triangle(frame->position[part->indices[i]], frame->position[part->indices[i + 1]],
                      frame->position[part->indices[i + 2]]);
    }
}

static double depth_at(double x, double y)
{
    double column = to_column(x), row = to_row(y);
    if (column < 0 || column >= WIDE || row < 0 || row >= HIGH) {
        return nothing;
    }
    return map[(int)row][(int)column];
}

/* In each direction over the map: how far the highest point rises above the surface's own slope. */
static double openness(V3 at, V3 normal)
{
    enum { WAYS = 20, STEPS = 14 };
    double closed = 0, facing = fmax(normal.z, 0.25);
    for (int way = 0; way < WAYS; way++) {
        double angle = 6.283185307179586 * way / WAYS, dx = cos(angle), dy = sin(angle);
        double own = -(normal.x * dx + normal.y * dy) / facing;
        double own_sine = own / sqrt(1 + own * own), highest = own_sine;
        double distance = 0.0008;
        for (int step = 0; step < STEPS; step++, distance *= 1.28) {
            double rise = depth_at(at.x + dx * distance, at.y + dy * distance) - at.z - 0.0002;
            double sine = rise / sqrt(rise * rise + distance * distance);
            double fade = 1 - 0.5 * step / STEPS;
            highest = fmax(highest, mix(own_sine, sine, fade));
        }
        closed += clamp(highest - own_sine, 0, 1);
    }
    return clamp(1 - closed / WAYS, 0, 1);
}

/* Average values with their neighbours', which removes noise. */
static void soften(const Part *part, double *values)
{
    double *sum = grab(NULL, part->seed_count, (int)sizeof *sum);
    double *weight = grab(NULL, part->seed_count, (int)sizeof *weight);
    for (int i = 0; i < part->seed_count; i++) {
        sum[i] = 2 * values[i];
        weight[i] = 2;
    }
    for (int i = 0; i < part->index_count; i++) {
        uint32_t a = part->indices[i], b = part->indices[i % 3 == 2 ? i - 2 : i + 1];
        sum[a] += 0.5 * values[b];
        sum[b] += 0.5 * values[a];
        weight[a] += 0.5;
        weight[b] += 0.5;
    }
    for (int i = 0; i < part->seed_count; i++) {
        values[i] = sum[i] / weight[i];
    }
    free(sum);
    free(weight);
}

void occlusion_bake(const Model *model, const Frame *frames, double *open[PARTS_MAX])
{
    for (int row = 0; row < HIGH; row++) {
        for (int column = 0; column < WIDE; column++) {
            map[row][column] = nothing;
        }
    }
    for (int part = 0; part < model->part_count; part++) {
        draw_part(&model->parts[part], &frames[part]);
    }
    for (int part = 0; part < model->part_count; part++) {
        const Frame *frame = &frames[part];
        open[part] = grab(NULL, frame->count, (int)sizeof(double));
        for (int i = 0; i < frame->count; i++) {
            open[part][i] = frame->normal[i].z < -0.3 ? 1 : openness(frame->position[i], frame->normal[i]);
        }
        soften(&model->parts[part], open[part]);
    }
}
