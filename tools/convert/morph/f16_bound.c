#include "f16_bound.h"

#include <math.h>
#include <stdlib.h>

#include "noh/base.h"

#define WEIGHT_MAX 2.0
#define HALF_MAX 65504.0

typedef struct bound {
    double sum, error;
} bound;

static double field(uint32_t word, unsigned before, unsigned bits, float scale)
{
    int32_t q = (int32_t)(word << before) >> (32u - bits);
    return fabs((double)q * (double)scale);
}

static void add(bound *b, double delta)
{
    b->sum += WEIGHT_MAX * delta;
    if (delta > 0.0) {
        b->error += ldexp(b->sum + b->error, -10) + ldexp(1.0, -24);
    }
}

/* bounds[vertex][9]: position, normal, tangent */
static void add_texel(bound *bounds, const uint32_t *words, const morph_target *t)
{
    for (unsigned axis = 0; axis < 3; axis++) {
        add(&bounds[axis], field(words[axis], 0, t->position_bits, t->position_scale));
        add(&bounds[3 + axis], field(words[axis], t->position_bits, t->normal_bits, t->normal_scale));
        add(&bounds[6 + axis],
            field(words[axis], (unsigned)t->position_bits + t->normal_bits, t->tangent_bits, t->tangent_scale));
    }
}

static void add_target(const morph_encoding *e, const morph_target *t, bound *bounds)
{
    const uint32_t *words = e->texels + 3 * (size_t)t->first_texel;
    for (uint32_t r = 0; r < t->rect_count; r++) {
        const morph_rect *rect = &e->rects[t->first_rect + r];
        for (uint32_t y = rect->y; y < (uint32_t)rect->y + rect->h; y++) {
            for (uint32_t x = rect->x; x < (uint32_t)rect->x + rect->w; x++, words += 3) {
                add_texel(bounds + 9 * (((size_t)y << e->width_log2) + x), words, t);
            }
        }
    }
}

int f16_bound(const morph_encoding *e, float *position, float *direction)
{
    size_t texels = (size_t)e->height << e->width_log2;
    bound *bounds = calloc(texels * 9 + 1, sizeof *bounds);
    double worst_position = 0.0, worst_direction = 0.0, largest = 0.0;
    *position = *direction = NOH_NUMBER_MAX;
    if (!bounds) return 1;
    for (uint32_t t = 0; t < e->target_count; t++) {
        add_target(e, &e->targets[t], bounds);
    }
    for (size_t v = 0; v < texels; v++) {
        const bound *b = bounds + 9 * v;
        double square = b[0].error * b[0].error + b[1].error * b[1].error + b[2].error * b[2].error;
        worst_position = fmax(worst_position, sqrt(square));
        for (int c = 3; c < 9; c++) {
            worst_direction = fmax(worst_direction, b[c].error);
        }
        for (int c = 0; c < 9; c++) {
            largest = fmax(largest, b[c].sum + b[c].error);
        }
    }
    if (largest < HALF_MAX) { /* else a sum may overflow, and there is no bound */
        *position = nextafterf((float)worst_position, 1e30f);
        *direction = nextafterf((float)worst_direction, 1e30f);
    }
    free(bounds);
    return 0;
}
