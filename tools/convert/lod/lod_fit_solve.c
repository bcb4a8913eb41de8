/* lod_fit_solve.c: weighted least squares for the steps of all slots, by conjugate gradients.
 *
 * A row states that its distance shrinks as its corners move along its direction. Rows are valid only nearby, so steps
 * are damped, and more so across the normal, since a vertex that slides drags its texture. */
#include <string.h>

#include "lod_fit_pose.h"

#define DAMPING 0.05 /* of the mean stiffness of a slot */
#define SLIDING 0.25 /* the same for the part of all steps so far that is not along the normal */
#define ROUNDS_MAX 40u
#define ENOUGH 1e-8 /* of the first residual, squared */

static double row_along(const fit_row *r, const double *x)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < 3u; i++) {
        const double *at = x + 3u * (size_t)(r->slot[i] == LOD_NONE ? 0u : r->slot[i]);
        if (r->slot[i] != LOD_NONE) {
            sum += (double)r->weight[i] * (r->direction[0] * at[0] + r->direction[1] * at[1] + r->direction[2] * at[2]);
        }
    }
    return sum;
}

static void row_add(const fit_row *r, double amount, double *x)
{
    for (uint32_t i = 0; i < 3u; i++) {
        for (uint32_t k = 0; k < 3u && r->slot[i] != LOD_NONE; k++) {
            x[3u * (size_t)r->slot[i] + k] += amount * r->weight[i] * r->direction[k];
        }
    }
}

/* out += amount x (v less its part along the slot's normal). */
static void add_sliding(const fitter *f, uint32_t slot, const double *v, double amount, double *out)
{
    const float *n = f->mesh->normal + 3u * (size_t)f->slot_point[slot];
    const double along = n[0] * v[0] + n[1] * v[1] + n[2] * v[2];
    for (uint32_t k = 0; k < 3u; k++) {
        out[k] += amount * (v[k] - along * n[k]);
    }
}

/* out = the matrix times x. */
static void apply(const fitter *f, double stiffness, const double *x, double *out)
{
    for (size_t i = 0; i < 3u * (size_t)f->slot_count; i++) {
        out[i] = DAMPING * stiffness * x[i];
    }
    for (uint32_t s = 0; s < f->slot_count; s++) {
        add_sliding(f, s, x + 3u * (size_t)s, SLIDING * stiffness, out + 3u * (size_t)s);
    }
    for (uint32_t i = 0; i < f->row_count; i++) {
        row_add(&f->rows[i], f->rows[i].stiffness * row_along(&f->rows[i], x), out);
    }
}

static void right_side(const fitter *f, double stiffness, double *out)
{
    memset(out, 0, 3u * (size_t)f->slot_count * sizeof *out);
    for (uint32_t i = 0; i < f->row_count; i++) {
        row_add(&f->rows[i], f->rows[i].stiffness * f->rows[i].distance, out);
    }
    for (uint32_t s = 0; s < f->slot_count; s++) {
        const float *at = f->at + 3u * (size_t)f->slot_point[s], *from = f->start + 3u * (size_t)f->slot_point[s];
        const double moved[3] = { (double)at[0] - from[0], (double)at[1] - from[1], (double)at[2] - from[2] };
        add_sliding(f, s, moved, -SLIDING * stiffness, out + 3u * (size_t)s);
    }
}

static double dot(const double *a, const double *b, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

void fit_solve(fitter *f)
{
    const size_t n = 3u * (size_t)f->slot_count;
    double *x = f->unknowns, *rest = x + n, *along = rest + n, *product = along + n, stiffness = 0.0, squared, first;
    for (uint32_t i = 0; i < f->row_count; i++) {
        stiffness += f->rows[i].stiffness;
    }
    stiffness /= f->slot_count;
    memset(x, 0, n * sizeof *x);
    right_side(f, stiffness, rest);
    memcpy(along, rest, n * sizeof *along);
    first = squared = dot(rest, rest, n);
    for (uint32_t round = 0; round < ROUNDS_MAX && squared > ENOUGH * first; round++) {
        double curvature, step, before = squared;
        apply(f, stiffness, along, product);
        curvature = dot(along, product, n);
        if (!(curvature > 0.0)) {
            return;
        }
        step = squared / curvature;
        for (size_t i = 0; i < n; i++) {
            x[i] += step * along[i];
            rest[i] -= step * product[i];
        }
        squared = dot(rest, rest, n);
        for (size_t i = 0; i < n; i++) {
            along[i] = rest[i] + squared / before * along[i];
        }
    }
}
