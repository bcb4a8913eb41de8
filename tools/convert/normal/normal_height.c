#include "normal_height.h"

#include <math.h>
#include <stdlib.h>

void normal_texel(const double v[3], uint8_t rgba[4])
{
    for (int c = 0; c < 3; c++) rgba[c] = (uint8_t)(128.5 + 127.0 * fmin(fmax(v[c], -1.0), 1.0));
    rgba[3] = 255;
}

typedef struct field {
    const uint16_t *heights;
    uint32_t width, height;
    int tiles;
} field;

/* A place one texel beyond an edge at most. */
static uint32_t inside(uint32_t at, int step, uint32_t size, int tiles)
{
    if (step < 0 && at == 0) return tiles ? size - 1u : 0;
    if (step > 0 && at + 1u == size) return tiles ? 0 : at;
    return step < 0 ? at - 1u : at + (uint32_t)step;
}

static double height_at(const field *f, uint32_t x, uint32_t y, int right, int down)
{
    const uint32_t column = inside(x, right, f->width, f->tiles), row = inside(y, down, f->height, f->tiles);
    return f->heights[(size_t)row * f->width + column] / 65535.0;
}

/* A texel's rise to the right and upwards. */
static void slope_at(const field *f, uint32_t x, uint32_t y, double slope[2])
{
    slope[0] = slope[1] = 0.0;
    for (int i = -1; i <= 1; i++) {
        const double share = i ? 1.0 / 8.0 : 2.0 / 8.0;
        slope[0] += share * (height_at(f, x, y, 1, i) - height_at(f, x, y, -1, i));
        slope[1] += share * (height_at(f, x, y, i, -1) - height_at(f, x, y, i, 1));
    }
}

uint8_t *normal_map_of_height(const uint16_t *heights, uint32_t width, uint32_t height, double depth, int tiles)
{
    const field f = { heights, width, height, tiles };
    uint8_t *rgba = malloc((size_t)width * height * 4u);
    for (uint32_t y = 0; y < height && rgba; y++) {
        for (uint32_t x = 0; x < width; x++) {
            double slope[2], v[3], length;
            slope_at(&f, x, y, slope);
            length = sqrt(1.0 + depth * depth * (slope[0] * slope[0] + slope[1] * slope[1]));
            v[0] = -depth * slope[0] / length;
            v[1] = -depth * slope[1] / length;
            v[2] = 1.0 / length;
            normal_texel(v, rgba + 4u * ((size_t)y * width + x));
        }
    }
    return rgba;
}
