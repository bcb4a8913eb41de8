/* lod_certify.c: the distance between a level and the full mesh, both ways, pose by pose.
 *
 * The two-sided (Hausdorff) distance: the farthest that any point of one surface lies from the other surface, in both
 * directions, because a level may lack a tip of the full mesh, and may bridge a gap in it. It does not depend on how
 * the level was built, and is stored in the pack as the level's error. Each triangle carries a grid of samples, its
 * corners and edges, its centroid and a random place; random samples alone find only about half of the largest
 * distances (compare Cignoni, Rocchini and Scopigno, "Metro", 1998). The nearest triangle is found in a tree of boxes
 * that is built once; only the boxes are refitted in every pose. The nearest triangle of the previous pose is the first
 * guess, which prunes most of the tree. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lod_internal.h"
#include "lod_tree.h"
#include "convert/model/model_build.h"

#define GRID_MAX 24u /* steps along a triangle's edge */
#define GRID_LEAST 2u
#define RANDOM_SEED UINT64_C(0x6365727469667921)

typedef struct sample {
    uint32_t triangle;
    float weight[3];
    float area; /* the sample's area; 0 on edges and corners */
} sample;

/* One direction: samples on `from`, distances to the tree of `to`. */
typedef struct way {
    const uint32_t *from;
    uint32_t from_count;
    lod_tree to;
    sample *samples;
    uint32_t sample_count;
    uint32_t *nearest;      /* [sample_count] triangles in the previous pose: the guess for the next */
    uint32_t *rest_nearest; /* [sample_count] */
    float *rest_weight;     /* [sample_count][3] of the nearest place on it */
    float *rest;            /* [sample_count] distances */
    uint32_t worst;         /* the farthest sample at rest */
} way;

typedef struct ranked {
    float distance, area;
} ranked;

/* ---- samples ---- */

static float edge_length(const float *a, const float *b)
{
    float d[3] = { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
    return sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

static float longest_edge(const float *position, const uint32_t *corner)
{
    float longest = 0.0f;
    for (uint32_t k = 0; k < 3u; k++) {
        float length = edge_length(position + (size_t)corner[k] * 3u, position + (size_t)corner[(k + 1u) % 3u] * 3u);
        longest = length > longest ? length : longest;
    }
    return longest;
}

static float triangle_area(const float *position, const uint32_t *corner)
{
    const float *p = position + (size_t)corner[0] * 3u, *q = position + (size_t)corner[1] * 3u,
                *r = position + (size_t)corner[2] * 3u;
    double a[3], b[3], n[3];
    for (uint32_t k = 0; k < 3u; k++) {
        a[k] = (double)q[k] - p[k];
        b[k] = (double)r[k] - p[k];
    }
    vec_cross(a, b, n);
    return (float)(0.5 * sqrt(vec_dot(n, n)));
}

static void add_sample(way *w, uint32_t triangle, float a, float b, float c, float area)
{
    sample *s = &w->samples[w->sample_count++];
    s->triangle = triangle;
    s->weight[0] = a;
    s->weight[1] = b;
    s->weight[2] = c;
    s->area = area;
}

static uint32_t grid_steps(const way *w, const float *position, uint32_t triangle, float spacing)
{
    float steps = spacing > 0.0f ? ceilf(longest_edge(position, w->from + (size_t)triangle * 3u) / spacing) : 0.0f;
    return steps < (float)GRID_LEAST ? GRID_LEAST : steps > (float)GRID_MAX ? GRID_MAX : (uint32_t)steps;
}

/* A lattice that includes corners and edges, the centroid, and a random point. */
static void sample_triangle(way *w, uint32_t triangle, uint32_t steps, float area, uint64_t *random)
{
    uint32_t inner = 2u + (steps - 1u) * (steps - 2u) / 2u;
    float share = area / (float)inner, third = 1.0f / 3.0f;
    float u = (float)lod_random(random), v = (float)lod_random(random);
    for (uint32_t i = 0; i <= steps; i++) {
        for (uint32_t j = 0; i + j <= steps; j++) {
            uint32_t k = steps - i - j;
            float a = (float)i / (float)steps, b = (float)j / (float)steps;
            add_sample(w, triangle, a, b, 1.0f - a - b, i && j && k ? share : 0.0f);
        }
    }
    u = u + v > 1.0f ? 1.0f - u : u;
    v = u + v > 1.0f ? 1.0f - v : v;
    add_sample(w, triangle, third, third, third, share);
    add_sample(w, triangle, u, v, 1.0f - u - v, share);
}

/* ---- one direction ---- */

static int way_make(way *w, const uint32_t *from, uint32_t from_count, const uint32_t *to, uint32_t to_count,
                    const float *position, float spacing)
{
    uint64_t random = RANDOM_SEED;
    size_t count = 0;
    w->from = from;
    w->from_count = from_count;
    for (uint32_t t = 0; t < from_count; t++) {
        uint32_t steps = grid_steps(w, position, t, spacing);
        count += (size_t)(steps + 1u) * (steps + 2u) / 2u + 2u;
    }
    w->samples = calloc(count + 1u, sizeof *w->samples);
    w->nearest = calloc(count + 1u, 2u * sizeof *w->nearest);
    w->rest = calloc(count + 1u, 4u * sizeof *w->rest);
    if (count > UINT32_MAX || !w->samples || !w->nearest || !w->rest || lod_tree_make(to, to_count, position, &w->to)) {
        return 1;
    }
    w->rest_nearest = w->nearest + count;
    w->rest_weight = w->rest + count;
    for (uint32_t t = 0; t < from_count; t++) {
        sample_triangle(w, t, grid_steps(w, position, t, spacing), triangle_area(position, from + (size_t)t * 3u),
                        &random);
    }
    return 0;
}

static void way_free(way *w)
{
    lod_tree_free(&w->to);
    free(w->samples);
    free(w->nearest);
    free(w->rest);
}

static int moves(const uint8_t *moved, const uint32_t *corner)
{
    return moved[corner[0]] || moved[corner[1]] || moved[corner[2]];
}

static void sample_point(const way *w, const sample *s, const float *position, float at[3])
{
    const uint32_t *corner = w->from + (size_t)s->triangle * 3u;
    for (uint32_t k = 0; k < 3u; k++) {
        at[k] = s->weight[0] * position[(size_t)corner[0] * 3u + k] +
                s->weight[1] * position[(size_t)corner[1] * 3u + k] +
                s->weight[2] * position[(size_t)corner[2] * 3u + k];
    }
}

/* Every distance, at rest. */
static void way_measure_rest(way *w, const float *position)
{
    uint32_t guess = 0;
    lod_tree_pose(&w->to, position);
    for (uint32_t i = 0; i < w->sample_count; i++) {
        float at[3];
        sample_point(w, &w->samples[i], position, at);
        w->nearest[i] = guess;
        w->rest[i] = sqrtf(lod_tree_nearest(&w->to, at, 0.0f, &w->nearest[i]));
        guess = w->nearest[i];
        lod_distance_place(w->to.triangles + (size_t)guess * 9u, at, w->rest_weight + (size_t)i * 3u);
        w->worst = w->rest[i] > w->rest[w->worst] ? i : w->worst;
    }
    memcpy(w->rest_nearest, w->nearest, w->sample_count * sizeof *w->nearest);
}

/* The distance of one sample, if it is above *most. A sample with any place nearer than that is skipped, as most are:
 * they lie near the place that was nearest at rest, or near the triangle that was in the previous pose. */
static void way_raise(way *w, uint32_t i, const float *position, float *most)
{
    float at[3], squared;
    sample_point(w, &w->samples[i], position, at);
    if (lod_distance_from(w->to.triangles + (size_t)w->rest_nearest[i] * 9u, w->rest_weight + (size_t)i * 3u, at[0],
                          at[1], at[2]) <= *most * *most) {
        return;
    }
    squared = lod_tree_distance(&w->to, at, w->nearest[i]);
    if (squared > *most * *most) {
        squared = lod_tree_nearest(&w->to, at, *most * *most, &w->nearest[i]);
        *most = squared > *most * *most ? sqrtf(squared) : *most;
    }
}

/* The largest distance in a pose. moved: NULL, or [vertices]. If neither a sample nor its nearest triangle moves, its
 * distance at rest is taken: it may have become smaller, never larger. */
static void way_measure(way *w, const float *position, const uint8_t *moved, float *most)
{
    lod_tree_pose(&w->to, position);
    if (moved) {
        memcpy(w->nearest, w->rest_nearest, w->sample_count * sizeof *w->nearest);
    } else if (w->sample_count) {
        way_raise(w, w->worst, position, most);
    }
    for (uint32_t i = 0; i < w->sample_count; i++) {
        const uint32_t *corner = w->from + (size_t)w->samples[i].triangle * 3u;
        if (moved && !moves(moved, corner) && !moves(moved, w->to.indices + (size_t)w->rest_nearest[i] * 3u)) {
            *most = w->rest[i] > *most ? w->rest[i] : *most;
            continue;
        }
        way_raise(w, i, position, most);
    }
}

static int by_distance(const void *a, const void *b)
{
    const ranked *p = a, *q = b;
    return (p->distance > q->distance) - (p->distance < q->distance);
}

static void raise_to(lod_distance *d, const way *w, ranked *list)
{
    uint32_t count = 0, i = 0;
    double area = 0.0, below = 0.0;
    for (uint32_t k = 0; k < w->sample_count; k++) {
        d->max = w->rest[k] > d->max ? w->rest[k] : d->max;
        if (w->samples[k].area > 0.0f) {
            list[count].distance = w->rest[k];
            list[count++].area = w->samples[k].area;
            area += w->samples[k].area;
        }
    }
    qsort(list, count, sizeof *list, by_distance);
    while (i + 1u < count && (below += list[i].area) < 0.99 * area) {
        i++;
    }
    if (count && list[i].distance > d->p99) {
        d->p99 = list[i].distance;
    }
}

/* ---- all poses of one submesh ---- */

typedef struct certifier {
    const model_mesh *mesh;
    const float *const *poses;
    uint32_t pose_count;
    way ways[2];
    ranked *list;
    float *position; /* [vertex_count][3] */
    uint8_t *moved;  /* [vertex_count] */
} certifier;

static void measure_rest(certifier *c, lod_distance *out)
{
    memset(out, 0, sizeof *out);
    for (uint32_t i = 0; i < 2u; i++) {
        way_measure_rest(&c->ways[i], c->mesh->position);
        raise_to(out, &c->ways[i], c->list);
    }
}

static void measure(certifier *c, const float *position, const uint8_t *moved, lod_distance *out)
{
    memset(out, 0, sizeof *out);
    for (uint32_t i = 0; i < 2u; i++) {
        way_measure(&c->ways[i], position, moved, &out->max);
    }
}

static void measure_target(certifier *c, uint32_t target, lod_distance *out)
{
    const float *delta = c->mesh->targets[target].position;
    memset(c->moved, 0, c->mesh->vertex_count);
    for (size_t i = 0; i < (size_t)c->mesh->vertex_count * 3u; i++) {
        c->position[i] = c->mesh->position[i] + delta[i];
        c->moved[i / 3u] |= delta[i] != 0.0f;
    }
    measure(c, c->position, c->moved, out);
}

/* Half the typical edge of the full mesh. */
static float sample_spacing(const model_mesh *mesh, const uint32_t *indices, uint32_t count)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        sum += longest_edge(mesh->position, indices + (size_t)i * 3u);
    }
    return (float)(0.5 * sum / count);
}

static int prepare(certifier *c, const uint32_t *full, uint32_t full_count, const uint32_t *level, uint32_t level_count)
{
    const float *rest = c->mesh->position;
    float spacing = sample_spacing(c->mesh, full, full_count);
    uint32_t a, b;
    if (way_make(&c->ways[0], full, full_count, level, level_count, rest, spacing) ||
        way_make(&c->ways[1], level, level_count, full, full_count, rest, spacing)) {
        return 1;
    }
    a = c->ways[0].sample_count;
    b = c->ways[1].sample_count;
    c->list = calloc(a > b ? a : b, sizeof *c->list);
    return !c->list;
}

/* Triangles of a submesh, in the full mesh and in the level. Returns 1 when out of memory. */
static int certify_submesh(certifier *c, const uint32_t *full, uint32_t full_count, const uint32_t *level,
                           uint32_t level_count, lod_distance *out)
{
    uint32_t targets = c->mesh->target_count;
    int failed;
    memset(c->ways, 0, sizeof c->ways);
    c->list = NULL;
    failed = prepare(c, full, full_count, level, level_count);
    if (!failed) {
        measure_rest(c, &out[0]);
        for (uint32_t t = 0; t < targets; t++) {
            measure_target(c, t, &out[1u + t]);
        }
        for (uint32_t i = 0; i < c->pose_count; i++) {
            measure(c, c->poses[i], NULL, &out[1u + targets + i]);
        }
    }
    way_free(&c->ways[0]);
    way_free(&c->ways[1]);
    free(c->list);
    return failed;
}

int lod_certify(const model_mesh *mesh, const lod_level *level, const float *const *poses, uint32_t pose_count,
                lod_distance *out, model_error *error)
{
    size_t row = (size_t)1u + mesh->target_count + pose_count;
    certifier c = { mesh, poses, pose_count, { { 0 } }, NULL, NULL, NULL };
    int failed;
    c.position = calloc((size_t)mesh->vertex_count + 1u, 3u * sizeof *c.position);
    c.moved = calloc((size_t)mesh->vertex_count + 1u, 1);
    failed = !c.position || !c.moved;
    memset(out, 0, mesh->submesh_count * row * sizeof *out);
    for (uint32_t i = 0; i < mesh->submesh_count && !failed; i++) {
        const model_submesh *sub = &mesh->submeshes[i];
        if (sub->index_count >= 3u && level->submesh_count[i] >= 3u) {
            failed = certify_submesh(&c, mesh->indices + sub->first_index, sub->index_count / 3u,
                                     level->indices + level->submesh_first[i], level->submesh_count[i] / 3u,
                                     out + i * row);
        }
    }
    free(c.position);
    free(c.moved);
    return failed ? model_fail(error, "", "out of memory for measuring a LOD level") : 0;
}
