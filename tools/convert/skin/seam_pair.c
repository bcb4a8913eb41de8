#include "seam_pair.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"

#define REACH 0.1           /* of a border's size: so far apart may the sides be */
#define SIZES 1.5           /* largest ratio of the two borders' sizes */
#define OPPOSITE 0.3        /* how clearly the surfaces must go on in opposite directions: the mean cosine */
#define CREASE 0.5          /* cosine of 60 degrees, as normals of a mesh have it */
#define BORDERS_MAX 1024u   /* the largest ones are compared */
#define WORK_MAX 1000000000 /* points times edges */

double border_nearest(const border *b, const double point[3], uint32_t *edge, double *along)
{
    double best = -1.0;
    for (uint32_t e = 0; e < b->edge_count; e++) {
        const double *from = b->points[b->edges[e].from].position, *to = b->points[b->edges[e].to].position;
        double line[3], rest[3], t, square;
        for (int i = 0; i < 3; i++) line[i] = to[i] - from[i], rest[i] = point[i] - from[i];
        square = vec_dot(line, line);
        t = square > 0.0 ? vec_dot(rest, line) / square : 0.0;
        t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
        for (int i = 0; i < 3; i++) rest[i] -= t * line[i];
        square = vec_dot(rest, rest);
        if (best < 0.0 || square < best) best = square, *edge = e, *along = t;
    }
    return best;
}

/* ---- which borders ---- */

typedef struct comparer {
    const border **borders; /* [count] the largest first */
    uint32_t count;
    double *distance; /* [count] of the best partner so far: the mean */
    uint32_t *best;   /* [count] that partner */
    int64_t work;     /* what is left */
} comparer;

/* Whether all of a lies within reach of b; the sum of the distances, and the mean cosine between the ways into both
 * surfaces. */
static int lies_along(comparer *c, const border *a, const border *b, double reach, double *sum, double *cosine)
{
    uint32_t edge;
    double along;
    *sum = *cosine = 0.0;
    for (uint32_t p = 0; p < a->point_count; p++) {
        const double square = border_nearest(b, a->points[p].position, &edge, &along);
        c->work -= b->edge_count;
        if (square > reach * reach || c->work < 0) return 0;
        *sum += sqrt(square);
    }
    for (uint32_t e = 0; e < a->edge_count; e++) {
        const double *from = a->points[a->edges[e].from].position, *to = a->points[a->edges[e].to].position;
        const double middle[3] = { (from[0] + to[0]) / 2.0, (from[1] + to[1]) / 2.0, (from[2] + to[2]) / 2.0 };
        (void)border_nearest(b, middle, &edge, &along);
        c->work -= b->edge_count;
        *cosine += vec_dot(a->edges[e].inward, b->edges[edge].inward) / a->edge_count;
    }
    return 1;
}

static void compare(comparer *c, uint32_t i, uint32_t k)
{
    const border *a = c->borders[i], *b = c->borders[k];
    const double small = a->size < b->size ? a->size : b->size, large = a->size < b->size ? b->size : a->size;
    double there, back, cosine, mean;
    if (a->mesh == b->mesh || !(small > 0.0) || large > SIZES * small) return;
    for (int x = 0; x < 3; x++) {
        if (a->low[x] > b->high[x] + REACH * small || b->low[x] > a->high[x] + REACH * small) return;
    }
    if (!lies_along(c, a, b, REACH * small, &there, &cosine) || cosine > -OPPOSITE ||
        !lies_along(c, b, a, REACH * small, &back, &cosine) || cosine > -OPPOSITE) {
        return;
    }
    mean = (there + back) / (a->point_count + b->point_count);
    if (c->best[i] == MODEL_NONE || mean < c->distance[i]) c->best[i] = k, c->distance[i] = mean;
    if (c->best[k] == MODEL_NONE || mean < c->distance[k]) c->best[k] = i, c->distance[k] = mean;
}

static int by_size(const void *a, const void *b)
{
    const border *x = *(const border *const *)a, *y = *(const border *const *)b;
    if (x->size != y->size) return x->size > y->size ? -1 : 1;
    if (x->mesh != y->mesh) return x->mesh < y->mesh ? -1 : 1;
    return (x->points[0].vertex > y->points[0].vertex) - (x->points[0].vertex < y->points[0].vertex);
}

/* ---- which points ---- */

static uint32_t nearest_point(const border *b, const double point[3])
{
    double best = -1.0;
    uint32_t at = MODEL_NONE;
    for (uint32_t p = 0; p < b->point_count; p++) {
        double d[3];
        for (int i = 0; i < 3; i++) d[i] = b->points[p].position[i] - point[i];
        if (best < 0.0 || vec_dot(d, d) < best) best = vec_dot(d, d), at = p;
    }
    return at;
}

int seam_is_crease(const border_point *a, const border_point *b)
{
    double x[3], y[3];
    memcpy(x, a->inward, sizeof x);
    memcpy(y, b->inward, sizeof y);
    return a->is_hard || b->is_hard || (vec_normalize(x) && vec_normalize(y) && vec_dot(x, y) > -CREASE);
}

static void centre_of(const border *b, double out[3])
{
    memset(out, 0, 3 * sizeof *out);
    for (uint32_t p = 0; p < b->point_count; p++) {
        for (int i = 0; i < 3; i++) out[i] += b->points[p].position[i] / b->point_count;
    }
}

/* As if one border was moved onto the other: a head that sits askew has the partners that it was modelled with. */
static int pair_points(seam_pair *s)
{
    double centre[2][3];
    for (int k = 0; k < 2; k++) centre_of(s->side[k], centre[k]);
    for (int k = 0; k < 2; k++) {
        const border *b = s->side[k];
        s->mate[k] = model_zeros(b->point_count, sizeof *s->mate[k]);
        if (!s->mate[k]) return 1;
        for (uint32_t p = 0; p < b->point_count; p++) {
            double at[3];
            for (int i = 0; i < 3; i++) at[i] = b->points[p].position[i] + centre[1 - k][i] - centre[k][i];
            s->mate[k][p] = nearest_point(s->side[1 - k], at);
        }
    }
    for (uint32_t p = 0; p < s->side[0]->point_count; p++) {
        if (s->mate[1][s->mate[0][p]] != p) s->mate[0][p] = MODEL_NONE;
    }
    for (uint32_t p = 0; p < s->side[1]->point_count; p++) {
        if (s->mate[0][s->mate[1][p]] != p) s->mate[1][p] = MODEL_NONE;
    }
    return 0;
}

static int add_seam(comparer *c, uint32_t i, uint32_t k, seam_list *out)
{
    const int swap = c->borders[i]->mesh > c->borders[k]->mesh;
    seam_pair *grown = realloc(out->all, ((size_t)out->count + 1u) * sizeof *grown);
    if (!grown) return 1;
    out->all = grown;
    memset(&grown[out->count], 0, sizeof *grown);
    grown[out->count].side[swap] = c->borders[i];
    grown[out->count].side[!swap] = c->borders[k];
    return pair_points(&grown[out->count++]);
}

int seams_find(const border_list *borders, seam_list *out)
{
    comparer c;
    int failed;
    memset(out, 0, sizeof *out);
    c.borders = model_zeros(borders->count, sizeof *c.borders);
    c.distance = model_zeros(borders->count, sizeof *c.distance);
    c.best = model_zeros(borders->count, sizeof *c.best);
    c.count = borders->count;
    c.work = WORK_MAX;
    failed = !c.borders || !c.distance || !c.best;
    for (uint32_t i = 0; !failed && i < c.count; i++) {
        c.borders[i] = &borders->all[i];
        c.best[i] = MODEL_NONE;
    }
    if (!failed && c.count) qsort(c.borders, c.count, sizeof *c.borders, by_size);
    if (c.count > BORDERS_MAX) c.count = BORDERS_MAX, out->gave_up = 1;
    for (uint32_t i = 0; !failed && i < c.count; i++) {
        for (uint32_t k = i + 1u; k < c.count && c.work >= 0; k++) compare(&c, i, k);
    }
    out->gave_up |= c.work < 0;
    for (uint32_t i = 0; !failed && i < c.count; i++) {
        const uint32_t k = c.best[i];
        if (k != MODEL_NONE && k > i && c.best[k] == i) failed = add_seam(&c, i, k, out);
    }
    free(c.borders);
    free(c.distance);
    free(c.best);
    return failed;
}

void seams_free(seam_list *list)
{
    for (uint32_t i = 0; i < list->count; i++) {
        free(list->all[i].mate[0]);
        free(list->all[i].mate[1]);
    }
    free(list->all);
    memset(list, 0, sizeof *list);
}
