/* lod_distance.c: distances of points to triangles. Branch-free over lanes, so that compilers vectorise it. */
#include "lod_internal.h"

/* Comparisons may be evaluated for all lanes: floating-point exception flags are not read. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("O3", "no-trapping-math")
#endif

/* A second version with AVX2 where the processor has it; without fused multiply-adds, so with the same bits. Sanitizers
 * do not take functions that are chosen at load time. */
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define LOD_WIDE __attribute__((target_clones("default", "avx2")))
#else
#define LOD_WIDE
#endif
/* A loop over lanes is vectorised only if its calls are inlined. */
#if defined(__GNUC__)
#define LOD_INLINE static inline __attribute__((always_inline))
#else
#define LOD_INLINE static inline
#endif

LOD_INLINE float dot(const float *a, const float *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

LOD_INLINE void cross(const float *a, const float *b, float *out)
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

LOD_INLINE void prepare(const float *triangle, lod_prepared *out)
{
    float squared;
    for (uint32_t e = 0; e < 3u; e++) {
        const float *a = triangle + e * 3u, *b = triangle + (e + 1u) % 3u * 3u;
        lod_edge *to = &out->edges[e];
        for (uint32_t k = 0; k < 3u; k++) {
            to->at[k] = a[k];
            to->along[k] = b[k] - a[k];
        }
        squared = dot(to->along, to->along);
        to->inverse = squared > 0.0f ? 1.0f / squared : 0.0f;
    }
    cross(out->edges[0].along, out->edges[1].along, out->normal);
    squared = dot(out->normal, out->normal);
    out->inverse = squared > 0.0f ? 1.0f / squared : 0.0f;
    for (uint32_t e = 0; e < 3u; e++) {
        cross(out->normal, out->edges[e].along, out->edges[e].side);
    }
}

void lod_prepare(const float *triangle, lod_prepared *out)
{
    prepare(triangle, out);
}

/* The squared distance to an edge; *inside falls to the least of the sides' signs. */
LOD_INLINE float edge_squared(const lod_edge *e, float x, float y, float z, float *inside)
{
    float dx = x - e->at[0], dy = y - e->at[1], dz = z - e->at[2];
    float side = dx * e->side[0] + dy * e->side[1] + dz * e->side[2];
    float t = (dx * e->along[0] + dy * e->along[1] + dz * e->along[2]) * e->inverse;
    *inside = side < *inside ? side : *inside;
    t = t < 0.0f ? 0.0f : t;
    t = t > 1.0f ? 1.0f : t;
    dx -= t * e->along[0];
    dy -= t * e->along[1];
    dz -= t * e->along[2];
    return dx * dx + dy * dy + dz * dz;
}

LOD_INLINE float triangle_squared(const lod_prepared *p, float x, float y, float z)
{
    float inside = 1.0f;
    float d0 = edge_squared(&p->edges[0], x, y, z, &inside);
    float d1 = edge_squared(&p->edges[1], x, y, z, &inside);
    float d2 = edge_squared(&p->edges[2], x, y, z, &inside);
    float height = (x - p->edges[0].at[0]) * p->normal[0] + (y - p->edges[0].at[1]) * p->normal[1] +
                   (z - p->edges[0].at[2]) * p->normal[2];
    float plane = height * height * p->inverse;
    d0 = d1 < d0 ? d1 : d0;
    d0 = d2 < d0 ? d2 : d0;
    return inside > 0.0f ? plane : d0;
}

LOD_WIDE void lod_distance_triangle(const float *triangle, const float *x, const float *y, const float *z,
                                    uint32_t count, float *squared)
{
    lod_prepared p;
    lod_prepare(triangle, &p);
    for (uint32_t i = 0; i < count; i += LOD_LANES) {
        float lane[LOD_LANES];
        for (uint32_t k = 0; k < LOD_LANES; k++) {
            lane[k] = triangle_squared(&p, x[i + k], y[i + k], z[i + k]);
        }
        for (uint32_t k = 0; k < LOD_LANES; k++) {
            squared[i + k] = lane[k] < squared[i + k] ? lane[k] : squared[i + k];
        }
    }
}

LOD_WIDE void lod_distance_nearest(const float *triangle, uint32_t which, const float *x, const float *y,
                                   const float *z, uint32_t count, float *squared, uint32_t *nearest)
{
    lod_prepared p;
    lod_prepare(triangle, &p);
    for (uint32_t i = 0; i < count; i += LOD_LANES) {
        float lane[LOD_LANES];
        for (uint32_t k = 0; k < LOD_LANES; k++) {
            lane[k] = triangle_squared(&p, x[i + k], y[i + k], z[i + k]);
        }
        for (uint32_t k = 0; k < LOD_LANES; k++) {
            nearest[i + k] = lane[k] < squared[i + k] ? which : nearest[i + k];
            squared[i + k] = lane[k] < squared[i + k] ? lane[k] : squared[i + k];
        }
    }
}

/* ---- blocks ---- */

LOD_INLINE lod_edge lane_edge(const float edge[10][LOD_LANES], uint32_t k)
{
    const lod_edge e = { { edge[0][k], edge[1][k], edge[2][k] },
                         { edge[3][k], edge[4][k], edge[5][k] },
                         { edge[6][k], edge[7][k], edge[8][k] },
                         edge[9][k] };
    return e;
}

LOD_INLINE void put_lane_edge(const lod_edge *e, uint32_t k, float out[10][LOD_LANES])
{
    for (uint32_t c = 0; c < 3u; c++) {
        out[c][k] = e->at[c];
        out[3u + c][k] = e->along[c];
        out[6u + c][k] = e->side[c];
    }
    out[9][k] = e->inverse;
}

LOD_WIDE static void prepare_lanes(const float *restrict corners, lod_block *restrict out)
{
    for (uint32_t k = 0; k < LOD_LANES; k++) {
        float triangle[9];
        lod_prepared p;
        for (uint32_t i = 0; i < 9u; i++) {
            triangle[i] = corners[i * LOD_LANES + k];
        }
        prepare(triangle, &p);
        for (uint32_t c = 0; c < 3u; c++) {
            put_lane_edge(&p.edges[c], k, out->edges[c]);
            out->normal[c][k] = p.normal[c];
        }
        out->inverse[k] = p.inverse;
    }
}

void lod_block_prepare(const float *triangles, uint32_t count, lod_block *out)
{
    float corners[9u * LOD_LANES];
    for (uint32_t k = 0; k < LOD_LANES; k++) {
        const float *from = triangles + 9u * (size_t)(k < count ? k : count - 1u);
        for (uint32_t i = 0; i < 9u; i++) {
            corners[i * LOD_LANES + k] = from[i];
        }
    }
    prepare_lanes(corners, out);
}

LOD_WIDE void lod_block_distances(const lod_block *restrict b, const float *point, float *restrict squared)
{
    const float x = point[0], y = point[1], z = point[2];
    for (uint32_t k = 0; k < LOD_LANES; k++) {
        const lod_prepared p = { { lane_edge(b->edges[0], k), lane_edge(b->edges[1], k), lane_edge(b->edges[2], k) },
                                 { b->normal[0][k], b->normal[1][k], b->normal[2][k] },
                                 b->inverse[k] };
        squared[k] = triangle_squared(&p, x, y, z);
    }
}

/* ---- places ---- */

/* Barycentric weights of the nearest point on the edge from corner e. */
static float edge_barycentric(const lod_prepared *p, uint32_t e, const float *point, float *out)
{
    const lod_edge *of = &p->edges[e];
    float d[3] = { point[0] - of->at[0], point[1] - of->at[1], point[2] - of->at[2] },
          t = dot(d, of->along) * of->inverse;
    t = t < 0.0f ? 0.0f : t > 1.0f ? 1.0f : t;
    for (uint32_t k = 0; k < 3u; k++) {
        d[k] -= t * of->along[k];
    }
    out[e] = 1.0f - t;
    out[(e + 1u) % 3u] = t;
    out[(e + 2u) % 3u] = 0.0f;
    return dot(d, d);
}

float lod_distance_weights(const lod_prepared *p, const float *point, float *barycentric)
{
    const float squared = triangle_squared(p, point[0], point[1], point[2]);
    float best = 0.0f;
    for (uint32_t e = 0; e < 3u; e++) {
        float weights[3], d = edge_barycentric(p, e, point, weights);
        if (e == 0 || d < best) {
            best = d;
            barycentric[0] = weights[0];
            barycentric[1] = weights[1];
            barycentric[2] = weights[2];
        }
    }
    if (squared < best) { /* inside: weights from the areas opposite the corners */
        for (uint32_t e = 0; e < 3u; e++) {
            const lod_edge *of = &p->edges[e];
            float d[3] = { point[0] - of->at[0], point[1] - of->at[1], point[2] - of->at[2] };
            barycentric[(e + 2u) % 3u] = dot(d, of->side) * p->inverse;
        }
    }
    return squared;
}

float lod_distance_point(const float *triangle, const float *point)
{
    lod_prepared p;
    lod_prepare(triangle, &p);
    return triangle_squared(&p, point[0], point[1], point[2]);
}

static void minus(const float *a, const float *b, float *out)
{
    for (uint32_t k = 0; k < 3u; k++) {
        out[k] = a[k] - b[k];
    }
}

/* On the edge between corners a and b, where a's and b's projections have these lengths. */
static void on_edge(uint32_t a, uint32_t b, float from_a, float to_b, float *out)
{
    const float sum = from_a + to_b;
    out[0] = out[1] = out[2] = 0.0f;
    out[b] = sum > 0.0f ? from_a / sum : 0.0f;
    out[a] = 1.0f - out[b];
}

/* By the regions around a triangle: Ericson, "Real-Time Collision Detection" (2005), 5.1.5. */
void lod_distance_place(const float *triangle, const float *point, float *out)
{
    float ab[3], ac[3], p[3], a1, a2, b1, b2, c1, c2, va, vb, vc;
    minus(triangle + 3, triangle, ab);
    minus(triangle + 6, triangle, ac);
    minus(point, triangle, p);
    a1 = dot(ab, p);
    a2 = dot(ac, p);
    minus(point, triangle + 3, p);
    b1 = dot(ab, p);
    b2 = dot(ac, p);
    minus(point, triangle + 6, p);
    c1 = dot(ab, p);
    c2 = dot(ac, p);
    va = b1 * c2 - c1 * b2;
    vb = c1 * a2 - a1 * c2;
    vc = a1 * b2 - b1 * a2;
    if (a1 <= 0.0f && a2 <= 0.0f) {
        on_edge(0, 1, 0.0f, 0.0f, out);
    } else if (b1 >= 0.0f && b2 <= b1) {
        on_edge(1, 0, 0.0f, 0.0f, out);
    } else if (vc <= 0.0f && a1 >= 0.0f && b1 <= 0.0f) {
        on_edge(0, 1, a1, -b1, out);
    } else if (c2 >= 0.0f && c1 <= c2) {
        on_edge(2, 0, 0.0f, 0.0f, out);
    } else if (vb <= 0.0f && a2 >= 0.0f && c2 <= 0.0f) {
        on_edge(0, 2, a2, -c2, out);
    } else if (va <= 0.0f && b2 >= b1 && c1 >= c2) {
        on_edge(1, 2, b2 - b1, c1 - c2, out);
    } else {
        out[1] = vb / (va + vb + vc);
        out[2] = vc / (va + vb + vc);
        out[0] = 1.0f - out[1] - out[2];
    }
}
