/* principal.c: what a mesh's targets do, in few numbers for each vertex. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compare.h"

#define ROUNDS 60u

/* [vertex_count][3 x target_count] deltas without their mean, in sizes of the mesh. */
static float *deltas_of(const model_mesh *mesh)
{
    uint32_t n = mesh->target_count * 3u;
    float *rows = compare_zeros((size_t)mesh->vertex_count * n, sizeof *rows), size = 0.0f;
    for (uint32_t k = 0; k < 3u; k++) {
        float low = INFINITY, high = -INFINITY;
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            low = fminf(low, mesh->position[(size_t)v * 3u + k]);
            high = fmaxf(high, mesh->position[(size_t)v * 3u + k]);
        }
        size = fmaxf(size, high - low);
    }
    for (uint32_t i = 0; i < n; i++) {
        const float *delta = mesh->targets[i / 3u].position + i % 3u;
        double mean = 0.0;
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            mean += (double)delta[(size_t)v * 3u] / mesh->vertex_count;
        }
        for (uint32_t v = 0; v < mesh->vertex_count && size > 0.0f; v++) {
            rows[(size_t)v * n + i] = (float)(((double)delta[(size_t)v * 3u] - mean) / (double)size);
        }
    }
    return rows;
}

static double *covariance_of(const float *rows, uint32_t vertex_count, uint32_t n)
{
    double *c = compare_zeros((size_t)n * n, sizeof *c);
    for (uint32_t v = 0; v < vertex_count; v++) {
        const float *row = rows + (size_t)v * n;
        for (uint32_t i = 0; i < n; i++) {
            for (uint32_t k = 0; row[i] != 0.0f && k < n; k++) {
                c[(size_t)i * n + k] += (double)row[i] * (double)row[k];
            }
        }
    }
    return c;
}

static double dot(const double *a, const double *b, uint32_t n)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/* Gram and Schmidt; a direction that the ones before it span becomes zero. */
static void make_orthonormal(double *directions, uint32_t count, uint32_t n)
{
    for (uint32_t d = 0; d < count; d++) {
        double *a = directions + (size_t)d * n, before = sqrt(dot(a, a, n)), length;
        for (uint32_t pass = 0; pass < 2u; pass++) {
            for (uint32_t e = 0; e < d; e++) {
                const double *b = directions + (size_t)e * n;
                double along = dot(a, b, n);
                for (uint32_t i = 0; i < n; i++) {
                    a[i] -= along * b[i];
                }
            }
        }
        length = sqrt(dot(a, a, n));
        for (uint32_t i = 0; i < n; i++) {
            a[i] = length > before * 1e-9 ? a[i] / length : 0.0;
        }
    }
}

/* [count][n] orthonormal directions in which the rows vary most: subspace iteration from a fixed random start. */
static double *directions_of(const double *covariance, uint32_t n, uint32_t count)
{
    double *now = compare_zeros((size_t)count * n, sizeof *now), *next = compare_zeros((size_t)count * n, sizeof *next);
    uint32_t state = 1;
    for (size_t i = 0; i < (size_t)count * n; i++) {
        state = state * 1664525u + 1013904223u;
        now[i] = (double)(state >> 8) / 8388608.0 - 1.0;
    }
    make_orthonormal(now, count, n);
    for (uint32_t round = 0; round < ROUNDS; round++) {
        double *swapped = now;
        for (size_t i = 0; i < (size_t)count * n; i++) {
            next[i] = dot(covariance + (i % n) * n, now + i / n * n, n);
        }
        make_orthonormal(next, count, n);
        now = next;
        next = swapped;
    }
    free(next);
    return now;
}

float *principal_of(const model_mesh *mesh, uint32_t count, float *kept)
{
    uint32_t n = mesh->target_count * 3u;
    float *rows = deltas_of(mesh), *out = compare_zeros((size_t)mesh->vertex_count * count, sizeof *out);
    double *covariance = covariance_of(rows, mesh->vertex_count, n), *directions = directions_of(covariance, n, count),
           all = 0.0, held = 0.0;
    for (uint32_t i = 0; i < n; i++) {
        all += covariance[(size_t)i * n + i];
    }
    for (size_t i = 0; i < (size_t)mesh->vertex_count * count; i++) {
        const float *row = rows + i / count * n;
        const double *direction = directions + i % count * n;
        double sum = 0.0;
        for (uint32_t k = 0; k < n; k++) {
            sum += (double)row[k] * direction[k];
        }
        out[i] = (float)sum;
        held += sum * sum;
    }
    *kept = all > 0.0 ? (float)(held / all) : 1.0f;
    free(directions);
    free(covariance);
    free(rows);
    return out;
}
