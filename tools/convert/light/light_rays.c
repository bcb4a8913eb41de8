#include "light_rays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"

#define GOLDEN_TURN 1640531527u /* 2^32 (1 - 1 / golden ratio) */
#define NEIGHBOUR 34u           /* directions whose numbers differ by this Fibonacci number are close */

int light_rays_make(uint32_t count, light_rays *out)
{
    out->count = count;
    out->directions = malloc(3u * sizeof(float) * (count + 1u));
    out->basis = malloc(NOH_SH_COUNT_MAX * sizeof(float) * (count + 1u));
    if (!out->directions || !out->basis) {
        return 1;
    }
    for (uint32_t i = 0; i < count; i++) {
        float *d = out->directions + 3u * (size_t)i, sine, cosine, across;
        d[1] = 1.0f - (2.0f * (float)i + 1.0f) / (float)count;
        across = sqrtf(1.0f - d[1] * d[1]);
        noh_sin_cos_turn(i * GOLDEN_TURN, &sine, &cosine);
        d[0] = across * cosine;
        d[2] = across * sine;
        noh_sh_basis(NOH_SH_ORDER_MAX, d, out->basis + NOH_SH_COUNT_MAX * (size_t)i);
    }
    return 0;
}

void light_rays_free(light_rays *r)
{
    free(r->directions);
    free(r->basis);
    memset(r, 0, sizeof *r);
}

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

float light_rays_sum(const light_rays *r, const float normal[3])
{
    float sum = 0.0f;
    for (uint32_t i = 0; i < r->count; i++) {
        const float cosine = dot(normal, r->directions + 3u * (size_t)i);
        sum += cosine > 0.0f ? cosine : 0.0f;
    }
    return sum;
}

static void origin_of(const light_surface *s, uint32_t vertex, float origin[3])
{
    const float *p = s->position + 3u * (size_t)vertex, *n = s->normal + 3u * (size_t)vertex;
    for (int k = 0; k < 3; k++) origin[k] = p[k] + s->least * n[k];
}

void light_rays_blocked(const light_rays *r, const light_surface *s, uint32_t vertex, uint8_t *blocked)
{
    const float *n = s->normal + 3u * (size_t)vertex;
    uint32_t last[NEIGHBOUR] = { 0 };
    float origin[3];
    origin_of(s, vertex, origin);
    ray_tree_front(&s->tree, origin, n);
    for (uint32_t i = 0; i < r->count; i++) {
        const float *d = r->directions + 3u * (size_t)i;
        blocked[i] = dot(n, d) > 0.0f && ray_tree_hit(&s->tree, origin, d, s->least, &last[i % NEIGHBOUR]);
    }
}

void light_rays_transfer(const light_rays *r, const light_surface *s, uint32_t vertex, uint8_t *blocked,
                         float *transfer)
{
    const float *n = s->normal + 3u * (size_t)vertex;
    const float scale = 1.0f / light_rays_sum(r, n);
    noh_sh_basis(NOH_SH_ORDER_MAX, n, transfer);
    noh_sh_convolve(NOH_SH_ORDER_MAX, noh_sh_cosine_lobe, transfer);
    light_rays_blocked(r, s, vertex, blocked);
    for (uint32_t i = 0; i < r->count; i++) {
        const float weight = blocked[i] ? scale * dot(n, r->directions + 3u * (size_t)i) : 0.0f;
        const float *basis = r->basis + NOH_SH_COUNT_MAX * (size_t)i;
        for (uint32_t k = 0; k < NOH_SH_COUNT_MAX && blocked[i]; k++) {
            transfer[k] -= weight * basis[k];
        }
    }
}

/* Whether a ray meets the side of a triangle from which its corners go round anticlockwise. */
static int meets_front(const float *triangle, const float d[3])
{
    float a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = triangle[3 + k] - triangle[k];
        b[k] = triangle[6 + k] - triangle[k];
    }
    return d[0] * (a[1] * b[2] - a[2] * b[1]) + d[1] * (a[2] * b[0] - a[0] * b[2]) +
               d[2] * (a[0] * b[1] - a[1] * b[0]) <
           0.0f;
}

void light_rays_bounce(const light_rays *r, const light_surface *s, uint32_t vertex, const uint8_t *blocked,
                       float albedo, const float *values, uint32_t stride, float *sums)
{
    const float *n = s->normal + 3u * (size_t)vertex;
    const float scale = albedo / light_rays_sum(r, n);
    float origin[3];
    origin_of(s, vertex, origin);
    for (uint32_t i = 0; i < r->count; i++) {
        const float *d = r->directions + 3u * (size_t)i;
        ray_meeting m;
        if (blocked[i] && ray_tree_nearest(&s->tree, origin, d, s->least, &m) && m.triangle < s->own_count &&
            meets_front(s->triangles + 9u * (size_t)m.triangle, d)) {
            const uint32_t *corners = s->corners + 3u * (size_t)m.triangle;
            const float share[3] = { 1.0f - m.u - m.v, m.u, m.v }, weight = scale * dot(n, d);
            for (uint32_t k = 0; k < 3u * stride; k++) {
                sums[k % stride] += weight * share[k / stride] *
                                    values[(size_t)corners[k / stride] * stride + k % stride];
            }
        }
    }
}
