#include "wrinkle_regions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define GROUPS 96         /* of points at first: the two most alike are joined until as many are left as regions */
#define ROUNDS 12         /* of assigning points to groups and moving the groups */
#define SMOOTHINGS 3      /* rounds in which borders grow soft, one edge a round */
#define FADE_FIRST 0.01f  /* compression at which a crease begins to show, */
#define FADE_LAST 0.035f  /* and at which it shows in full */
#define MATRIX_LEAST 0.04 /* a target with less than this share of the strongest in a region has no effect on it */
#define SAMPLES_MAX 64u   /* of a mask, along a side of a triangle */
#define SHOWN_LEAST 0.05  /* of a region's area, where a target that is tied to it compresses by FADE_FIRST */

/* Groups as directions: how much each target compresses their points, unit length. */
typedef struct clusters {
    const wrinkle_field *field;
    uint32_t count;              /* of groups */
    double (*direction)[GROUPS]; /* [target_count] */
    double weight[GROUPS];       /* what each explains, as point_weight counts */
    uint8_t *region;             /* [vertex_count] of points that are compressed, else GROUPS */
    double *sum;                 /* [target_count] */
} clusters;

static float fade_of(float shrink)
{
    const float x = (shrink - FADE_FIRST) / (FADE_LAST - FADE_FIRST), t = x < 0.0f ? 0.0f : x < 1.0f ? x : 1.0f;
    return t * t * (3.0f - 2.0f * t);
}

/* How much a point counts: its area, where a crease shows. */
static double point_weight(const wrinkle_field *f, uint32_t vertex)
{
    return f->point_area[vertex] * (double)fade_of(f->point_largest[vertex]);
}

static double project(const clusters *c, uint32_t vertex, uint32_t region)
{
    const uint32_t targets = c->field->mesh->target_count;
    const float *shrink = &c->field->point_shrink[(size_t)vertex * targets];
    double sum = 0.0;
    for (uint32_t t = 0; t < targets; t++) {
        sum += (double)shrink[t] * c->direction[t][region];
    }
    return sum;
}

/* The part of a point's compression that no region explains so far: as a share, so that a slight crease of the brow
 * counts next to the deep folds of a mouth, by its area. */
static double unexplained(const clusters *c, uint32_t vertex, uint32_t regions)
{
    const uint32_t targets = c->field->mesh->target_count;
    const float *shrink = &c->field->point_shrink[(size_t)vertex * targets];
    double all = 0.0, best = 0.0;
    for (uint32_t t = 0; t < targets; t++) {
        all += (double)shrink[t] * (double)shrink[t];
    }
    for (uint32_t r = 0; r < regions; r++) {
        const double along = project(c, vertex, r);
        best = along > best ? along : best;
    }
    return all > 0.0 ? (1.0 - best * best / all) * point_weight(c->field, vertex) : 0.0;
}

/* Take the direction of a region from a point, or from c->sum; 0 where that is 0. */
static int set_direction(clusters *c, uint32_t region, const float *shrink)
{
    const uint32_t targets = c->field->mesh->target_count;
    double length = 0.0;
    for (uint32_t t = 0; t < targets; t++) {
        const double v = shrink ? (double)shrink[t] : c->sum[t];
        length += v * v;
    }
    length = sqrt(length);
    for (uint32_t t = 0; t < targets && length > 0.0; t++) {
        c->direction[t][region] = (shrink ? (double)shrink[t] : c->sum[t]) / length;
    }
    return length > 0.0;
}

/* Each next group begins where most is left unexplained. */
static void seed(clusters *c)
{
    const wrinkle_field *f = c->field;
    for (uint32_t r = 0; r < GROUPS; r++) {
        uint32_t worst = 0;
        double most = 0.0;
        for (uint32_t v = 0; v < f->mesh->vertex_count; v++) {
            const double left = f->point[v] == v ? unexplained(c, v, r) : 0.0;
            if (left > most) {
                most = left;
                worst = v;
            }
        }
        if (most > 0.0) {
            (void)set_direction(c, r, &f->point_shrink[(size_t)worst * f->mesh->target_count]);
        }
    }
}

static void assign(clusters *c)
{
    const wrinkle_field *f = c->field;
    for (uint32_t v = 0; v < f->mesh->vertex_count; v++) {
        double best = 0.0;
        c->region[v] = GROUPS;
        for (uint32_t r = 0; r < c->count && f->point_largest[v] >= FADE_FIRST; r++) {
            const double along = project(c, v, r);
            if (along > best) {
                best = along;
                c->region[v] = (uint8_t)r;
            }
        }
    }
}

/* The weight of a point in its region's mean: along the region, of its compression made unit length. */
static double point_share(const clusters *c, uint32_t vertex, uint32_t region)
{
    const uint32_t targets = c->field->mesh->target_count;
    const float *shrink = &c->field->point_shrink[(size_t)vertex * targets];
    double all = 0.0;
    for (uint32_t t = 0; t < targets; t++) {
        all += (double)shrink[t] * (double)shrink[t];
    }
    return all > 0.0 ? project(c, vertex, region) * point_weight(c->field, vertex) / all : 0.0;
}

/* Set each group's direction from its points: one step of the power method. */
static void move(clusters *c)
{
    const wrinkle_field *f = c->field;
    const uint32_t targets = f->mesh->target_count;
    for (uint32_t r = 0; r < c->count; r++) {
        memset(c->sum, 0, targets * sizeof *c->sum);
        c->weight[r] = 0.0;
        for (uint32_t v = 0; v < f->mesh->vertex_count; v++) {
            const double weight = c->region[v] == r && f->point[v] == v ? point_share(c, v, r) : 0.0;
            c->weight[r] += weight > 0.0 ? weight * project(c, v, r) : 0.0;
            for (uint32_t t = 0; t < targets && weight > 0.0; t++) {
                c->sum[t] += weight * (double)f->point_shrink[(size_t)v * targets + t];
            }
        }
        (void)set_direction(c, r, NULL);
    }
}

static void settle(clusters *c)
{
    for (int round = 0; round < ROUNDS; round++) {
        assign(c);
        move(c);
    }
}

/* The part that one direction in place of two explains: the larger eigenvalue of the sum of their squares. */
static double together(const clusters *c, uint32_t a, uint32_t b, double *cosine)
{
    const double p = c->weight[a], q = c->weight[b], half = 0.5 * (p - q);
    *cosine = 0.0;
    for (uint32_t t = 0; t < c->field->mesh->target_count; t++) {
        *cosine += c->direction[t][a] * c->direction[t][b];
    }
    return 0.5 * (p + q) + sqrt(half * half + p * q * *cosine * *cosine);
}

/* Its eigenvector goes to the first; the last group takes the place of the second. */
static void join(clusters *c, uint32_t a, uint32_t b)
{
    double cosine;
    const double both = together(c, a, b, &cosine);
    const uint32_t strong = c->weight[a] >= c->weight[b] ? a : b, weak = strong == a ? b : a;
    const double rest = both - c->weight[weak], share = rest > 0.0 ? c->weight[weak] * cosine / rest : 0.0;
    double length = 0.0;
    c->count--;
    for (uint32_t t = 0; t < c->field->mesh->target_count; t++) {
        c->direction[t][a] = c->direction[t][strong] + share * c->direction[t][weak];
        length += c->direction[t][a] * c->direction[t][a];
        c->direction[t][b] = c->direction[t][c->count];
    }
    for (uint32_t t = 0; t < c->field->mesh->target_count && length > 0.0; t++) {
        c->direction[t][a] /= sqrt(length);
    }
    c->weight[a] = both;
    c->weight[b] = c->weight[c->count];
}

/* The two whose joining leaves least unexplained. */
static void join_nearest(clusters *c)
{
    uint32_t best_a = 0, best_b = 1;
    double best = -1.0;
    for (uint32_t b = 1; b < c->count; b++) {
        for (uint32_t a = 0; a < b; a++) {
            double cosine;
            const double loss = c->weight[a] + c->weight[b] - together(c, a, b, &cosine);
            if (best < 0.0 || loss < best) {
                best = loss;
                best_a = a;
                best_b = b;
            }
        }
    }
    join(c, best_a, best_b);
}

/* ---- weights of vertices ---- */

/* A step of smoothing over the edges of triangles: each point becomes the mean of itself and its neighbours. */
static void smooth(const wrinkle_field *f, region_weights *weights, region_weights *sum, float *count)
{
    const uint32_t vertices = f->mesh->vertex_count;
    memcpy(sum, weights, vertices * sizeof *sum);
    for (uint32_t v = 0; v < vertices; v++) {
        count[v] = 1.0f;
    }
    for (uint32_t i = 0; i < 3 * f->triangle_count; i++) {
        const uint32_t a = f->point[wrinkle_corner(f, i / 3, i % 3)];
        const uint32_t b = f->point[wrinkle_corner(f, i / 3, (i + 1) % 3)];
        for (uint32_t r = 0; r < REGION_COUNT; r++) {
            sum[a][r] += weights[b][r];
            sum[b][r] += weights[a][r];
        }
        count[a] += 1.0f;
        count[b] += 1.0f;
    }
    for (uint32_t i = 0; i < vertices * REGION_COUNT; i++) {
        const uint32_t v = i / REGION_COUNT, r = i % REGION_COUNT, point = f->point[v];
        weights[v][r] = sum[point][r] / count[point];
    }
}

static int weigh(const clusters *c, region_weights *weights)
{
    const wrinkle_field *f = c->field;
    const uint32_t vertices = f->mesh->vertex_count;
    region_weights *sum = model_zeros(vertices, sizeof *sum);
    float *count = model_zeros(vertices, sizeof *count);
    const int failed = !sum || !count;
    for (uint32_t v = 0; v < vertices; v++) {
        if (c->region[v] < c->count) weights[v][c->region[v]] = 1.0f;
    }
    for (int round = 0; round < SMOOTHINGS && !failed; round++) {
        smooth(f, weights, sum, count);
    }
    for (uint32_t i = 0; i < vertices * REGION_COUNT; i++) {
        float *weight = &weights[i / REGION_COUNT][i % REGION_COUNT];
        *weight = *weight * 2.0f < 1.0f ? *weight * 2.0f : 1.0f; /* where two regions meet both are whole */
        *weight *= fade_of(f->point_largest[i / REGION_COUNT]);
    }
    free(sum);
    free(count);
    return failed;
}

/* ---- which channel ---- */

/* How much of two regions' area a mask loses where both have the same channel. */
static double meeting(const wrinkle_field *f, region_weights *weights, uint32_t a, uint32_t b)
{
    double sum = 0.0;
    for (uint32_t v = 0; v < f->mesh->vertex_count; v++) {
        const float less = weights[v][a] < weights[v][b] ? weights[v][a] : weights[v][b];
        sum += f->point[v] == v ? f->point_area[v] * (double)less : 0.0;
    }
    return sum;
}

/* The loss of region `of` in the channel of place `place`, next to the regions there except at place `but`. */
static double loss_at(double (*meets)[REGION_COUNT], const uint32_t *at, uint32_t of, uint32_t place, uint32_t but)
{
    double sum = 0.0;
    for (uint32_t i = place / 3u * 3u; i < place / 3u * 3u + 3u; i++) {
        sum += i != but && i != place && at[i] != of ? meets[of][at[i]] : 0.0;
    }
    return sum;
}

/* Exchange two regions of different channels as long as that makes less of regions of one channel meet. */
static void part_neighbours(double (*meets)[REGION_COUNT], uint32_t *at)
{
    double all = 0.0;
    for (uint32_t i = 0; i < REGION_COUNT * REGION_COUNT; i++) all += meets[i / REGION_COUNT][i % REGION_COUNT];
    for (;;) {
        uint32_t best_a = 0, best_b = 0;
        double best = 1e-6 * all;
        for (uint32_t i = 0; i < REGION_COUNT * REGION_COUNT; i++) {
            const uint32_t a = i / REGION_COUNT, b = i % REGION_COUNT;
            if (a >= b || a / 3u == b / 3u) continue;
            const double before = loss_at(meets, at, at[a], a, a) + loss_at(meets, at, at[b], b, b);
            const double after = loss_at(meets, at, at[a], b, b) + loss_at(meets, at, at[b], a, a);
            if (before - after > best) {
                best = before - after;
                best_a = a;
                best_b = b;
            }
        }
        if (best_a == best_b) return;
        const uint32_t region = at[best_a];
        at[best_a] = at[best_b];
        at[best_b] = region;
    }
}

/* Number the regions so that regions that meet are in different channels: a mask holds one per channel at a texel. */
static void order(const wrinkle_field *f, region_weights *weights)
{
    double meets[REGION_COUNT][REGION_COUNT] = { { 0.0 } };
    uint32_t at[REGION_COUNT];
    for (uint32_t a = 0; a < REGION_COUNT; a++) {
        at[a] = a;
        for (uint32_t b = 0; b < a; b++) meets[a][b] = meets[b][a] = meeting(f, weights, a, b);
    }
    part_neighbours(meets, at);
    for (uint32_t v = 0; v < f->mesh->vertex_count; v++) {
        region_weights before;
        memcpy(before, weights[v], sizeof before);
        for (uint32_t r = 0; r < REGION_COUNT; r++) weights[v][r] = before[at[r]];
    }
}

region_weights *wrinkle_regions_make(const wrinkle_field *field)
{
    const model_mesh *mesh = field->mesh;
    region_weights *weights = model_zeros(mesh->vertex_count, sizeof *weights);
    clusters c = { .field = field,
                   .count = GROUPS,
                   .direction = model_zeros(mesh->target_count, sizeof *c.direction),
                   .region = model_zeros(mesh->vertex_count, 1),
                   .sum = model_zeros(mesh->target_count, sizeof *c.sum) };
    int failed = !weights || !c.direction || !c.region || !c.sum;
    if (!failed) {
        seed(&c);
        settle(&c);
        while (c.count > REGION_COUNT) {
            join_nearest(&c);
        }
        settle(&c);
        assign(&c);
        failed = weigh(&c, weights);
        if (!failed) order(field, weights);
    }
    free(c.direction);
    free(c.region);
    free(c.sum);
    if (failed) {
        free(weights);
        weights = NULL;
    }
    return weights;
}

/* ---- the matrix ---- */

/* The effects of targets on regions. */
typedef struct deeds {
    double (*sum)[REGION_COUNT];   /* [target_count] of compression times area */
    double (*shown)[REGION_COUNT]; /* [target_count] area that a target compresses so that creases show */
    double area[REGION_COUNT];
} deeds;

static int deeds_make(uint32_t targets, deeds *d)
{
    memset(d, 0, sizeof *d);
    d->sum = model_zeros(targets, sizeof *d->sum);
    d->shown = model_zeros(targets, sizeof *d->shown);
    return !d->sum || !d->shown;
}

static void deeds_free(deeds *d)
{
    free(d->sum);
    free(d->shown);
}

/* area: of a triangle, as much as is the region's. shrink: [targets] */
static void add_deeds(deeds *d, uint32_t targets, uint32_t region, double area, const float *shrink)
{
    d->area[region] += area;
    for (uint32_t t = 0; t < targets; t++) {
        d->sum[t][region] += area * (double)shrink[t];
        d->shown[t][region] += shrink[t] >= FADE_FIRST ? area : 0.0;
    }
}

static int is_tied(const deeds *d, uint32_t target, uint32_t region)
{
    return d->shown[target][region] > 0.0 && d->shown[target][region] >= SHOWN_LEAST * d->area[region];
}

/* The target that does most to a region gets 255. A target that shows creases next to nowhere in a region is not tied
 * to it, however little the others do. */
static uint8_t *matrix_of(uint32_t targets, const deeds *d)
{
    uint8_t *matrix = model_zeros(targets, REGION_COUNT);
    for (uint32_t r = 0; r < REGION_COUNT && matrix; r++) {
        double most = 0.0;
        for (uint32_t t = 0; t < targets; t++) {
            if (is_tied(d, t, r) && d->sum[t][r] > most) most = d->sum[t][r];
        }
        for (uint32_t t = 0; t < targets && most > 0.0; t++) {
            const double share = is_tied(d, t, r) ? d->sum[t][r] / most : 0.0;
            matrix[t * REGION_COUNT + r] = (uint8_t)(share < MATRIX_LEAST ? 0.0 : share * 255.0 + 0.5);
        }
    }
    return matrix;
}

/* A mask's texel at texture coordinates, of map 0. */
static size_t texel_at(const wrinkle_field *f, const region_maps *maps, const double uv[2])
{
    const uint32_t side[2] = { maps->width, maps->height };
    uint32_t at[2];
    for (int axis = 0; axis < 2; axis++) {
        const double in = f->clamped[axis] ? uv[axis] : uv[axis] - floor(uv[axis]), texel = floor(in * side[axis]);
        at[axis] = !(texel > 0.0) ? 0 : texel < side[axis] ? (uint32_t)texel : side[axis] - 1u;
    }
    return 4u * ((size_t)at[1] * maps->width + at[0]);
}

/* The mean of a mask over a triangle, by samples that are a texel apart at most. */
static void mean_weights(const wrinkle_field *f, const region_maps *maps, uint32_t triangle, double *weights)
{
    double corner[3][2], longest = 0.0, sum[REGION_COUNT] = { 0.0 };
    for (uint32_t k = 0; k < 3; k++) {
        const float *uv = f->mesh->uv + 2 * (size_t)wrinkle_corner(f, triangle, k);
        for (int axis = 0; axis < 2; axis++) corner[k][axis] = (double)uv[axis];
    }
    for (int k = 0; k < 3; k++) {
        longest = fmax(longest, fabs(corner[(k + 1) % 3][0] - corner[k][0]) * maps->width);
        longest = fmax(longest, fabs(corner[(k + 1) % 3][1] - corner[k][1]) * maps->height);
    }
    const uint32_t n = longest < 1.0 ? 1u : longest < SAMPLES_MAX ? (uint32_t)ceil(longest) : SAMPLES_MAX;
    for (uint32_t i = 0; i < n * n; i++) { /* the middles of the n * n triangles that it is divided into */
        const uint32_t a = i / n, b = i % n, over = a + b >= n;
        const double s = (over ? n - a - 1.0 / 3.0 : a + 1.0 / 3.0) / n,
                     t = (over ? n - b - 1.0 / 3.0 : b + 1.0 / 3.0) / n;
        double uv[2];
        for (int axis = 0; axis < 2; axis++) {
            uv[axis] = corner[0][axis] + s * (corner[1][axis] - corner[0][axis]) +
                       t * (corner[2][axis] - corner[0][axis]);
        }
        const size_t at = texel_at(f, maps, uv);
        for (uint32_t r = 0; r < REGION_COUNT; r++) {
            const size_t channel = r / REGION_MAP_COUNT;
            sum[r] += maps->map[r % REGION_MAP_COUNT][at + channel];
        }
    }
    for (uint32_t r = 0; r < REGION_COUNT; r++) weights[r] = sum[r] / (255.0 * n * n);
}

uint8_t *wrinkle_matrix_make(const wrinkle_field *field, const region_maps *maps)
{
    const uint32_t targets = field->mesh->target_count;
    deeds d;
    const int failed = deeds_make(targets, &d);
    uint8_t *matrix = NULL;
    for (uint32_t i = 0; i < field->triangle_count && !failed; i++) {
        double weights[REGION_COUNT];
        mean_weights(field, maps, i, weights);
        for (uint32_t r = 0; r < REGION_COUNT; r++) {
            const double area = field->area[i] * weights[r];
            if (area > 0.0) add_deeds(&d, targets, r, area, &field->shrink[(size_t)i * targets]);
        }
    }
    if (!failed) matrix = matrix_of(targets, &d);
    deeds_free(&d);
    return matrix;
}

/* ---- maps ---- */

static void fill_maps(const wrinkle_field *f, region_weights *regions, const wrinkle_raster *raster,
                      uint8_t *const *maps)
{
    for (size_t at = 0; at < (size_t)raster->width * raster->height; at++) {
        const uint32_t triangle = raster->triangle[at];
        for (uint32_t r = 0; r < REGION_COUNT && triangle != MODEL_NONE; r++) {
            float weight = 0.0f;
            for (uint32_t k = 0; k < 3; k++) {
                weight += raster->share[at][k] * regions[wrinkle_corner(f, triangle, k)][r];
            }
            maps[r % REGION_MAP_COUNT][4 * at + r / REGION_MAP_COUNT] =
                (uint8_t)((weight < 1.0f ? weight : 1.0f) * 255.0f + 0.5f);
        }
    }
}

int wrinkle_maps_make(const wrinkle_field *field, region_weights *regions, const wrinkle_raster *raster,
                      uint8_t *maps[REGION_MAP_COUNT])
{
    int failed = 0;
    for (uint32_t k = 0; k < REGION_MAP_COUNT; k++) {
        maps[k] = model_zeros((size_t)raster->width * raster->height, 4);
        failed |= !maps[k];
    }
    if (!failed) fill_maps(field, regions, raster, maps);
    for (uint32_t k = 0; k < REGION_MAP_COUNT && !failed; k++) {
        failed = wrinkle_raster_dilate(raster, maps[k], 4);
    }
    for (uint32_t k = 0; k < REGION_MAP_COUNT && failed; k++) {
        free(maps[k]);
        maps[k] = NULL;
    }
    return failed;
}
