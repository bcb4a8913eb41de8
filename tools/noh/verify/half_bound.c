#include "half_bound.h"
#include "deform/morph/morph_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define FLOAT_SLACK 1e-5 /* of a sum: products and sums of floats, which are compared with, are rounded too */

/* One coordinate of a vertex: what its sum so far lies between, and how far it may be off. */
typedef struct partial {
    double low, high, error;
} partial;

/* The distance of neighbouring half floats at a magnitude; 2^-24 where they are denormal. */
static double spacing(double magnitude)
{
    int exponent;
    (void)frexp(magnitude, &exponent); /* 2^(exponent - 1) <= magnitude */
    return ldexp(1.0, exponent - 11 > -24 ? exponent - 11 : -24);
}

static double rounding(double magnitude, noh_half_mode mode)
{
    return mode == NOH_HALF_RNE || mode == NOH_HALF_RTZ_RNE ? 0.5 * spacing(magnitude) : spacing(magnitude);
}

static double largest(double a, double b)
{
    return fmax(fabs(a), fabs(b));
}

static void add(partial *p, double delta, double low, double high, int once, noh_half_mode mode)
{
    double from, to;
    if (delta == 0.0) return; /* most are */
    from = fmin(low * delta, high * delta);
    to = fmax(low * delta, high * delta);
    p->low += from;
    p->high += to;
    if (once) return;
    if (mode == NOH_HALF_UNKNOWN || mode == NOH_HALF_RTZ_RNE) p->error += spacing(largest(from, to));
    p->error += rounding(largest(p->low, p->high) + p->error, mode);
}

static double error_of(const partial *p, int once, noh_half_mode mode)
{
    const double sum = largest(p->low, p->high);
    return p->error + (once && sum > 0.0 ? rounding(sum, mode) : 0.0) + FLOAT_SLACK * sum;
}

/* The Euclidean error of each accumulation texel. */
static void errors_of(const partial *parts, uint32_t touched, int once, noh_half_mode mode, double *errors)
{
    for (uint32_t v = 0; v < touched; v++) {
        double square = 0.0;
        for (uint32_t c = 0; c < 3; c++) {
            const double error = error_of(&parts[3 * (size_t)v + c], once, mode);
            square += error * error;
        }
        errors[v] = sqrt(square);
    }
}

int half_errors(const noh_mesh *mesh, const half_range *range, half_layer layer, double *errors)
{
    const uint32_t touched = mesh->header->touched_count, targets = mesh->header->target_count;
    const size_t bytes = noh_morph_layers_size(mesh);
    partial *parts = calloc((size_t)touched * 3u + 1u, sizeof *parts);
    float *alone = calloc(targets + 1u, sizeof *alone);
    void *memory = malloc(bytes + 16u);
    const int ok = parts && alone && memory;
    for (uint32_t t = 0; t < targets && ok; t++) {
        const float low = range->low[t], high = range->high[t];
        noh_morph_layers layers;
        if (low == 0.0f && high == 0.0f) continue;
        noh_morph_layers_init(memory, bytes + 16u, mesh, &layers, NULL);
        alone[t] = 1.0f;
        noh_morph_accumulate_scalar(mesh, alone, &layers);
        alone[t] = 0.0f;
        const float *deltas = layer == HALF_NORMAL ? layers.normal : layers.position;
        for (size_t i = 0; i < 3u * (size_t)touched; i++) {
            add(&parts[i], (double)deltas[i], (double)low, (double)high, range->once, range->mode);
        }
    }
    if (ok) errors_of(parts, touched, range->once, range->mode, errors);
    free(memory);
    free(alone);
    free(parts);
    return ok ? 0 : -1;
}

double half_bound(const noh_mesh *mesh, const half_range *range)
{
    const uint32_t touched = mesh->header->touched_count;
    double *errors = calloc(touched + 1u, sizeof *errors), worst = -1.0;
    if (errors && !half_errors(mesh, range, HALF_POSITION, errors)) {
        worst = 0.0;
        for (uint32_t v = 0; v < touched; v++) worst = fmax(worst, errors[v]);
    }
    free(errors);
    return worst;
}
