/* lod_fit_pose.c: the rows of one pose, and the steps towards the least of their largest.
 *
 * In each round every sample finds the nearest place on the other surface, both ways, and the points take a step by
 * least squares in which a row counts by the sixth power of its distance, which is the eighth power of the distances
 * in all (Lawson's iteration). Few steps are straight, so they are short, and the round with the least largest distance
 * is the one that stays. */
#include <math.h>
#include <string.h>

#include "lod_fit_pose.h"

#define SHORTENED 0.4
#define STEP_MAX 0.1f     /* of the largest distance, along each axis */
#define REACH 1.5f        /* of the largest distance at first */
#define LEAST_RATIO 0.25f /* of the largest distance: smaller ones count by less than 1/4000 and are left out */
#define FIRST_RATIO 0.2f  /* the same in a pose's first round, of the largest at rest */
#define SQRT_3 1.7320508f
#define TURNED 0.5f  /* the cosine by which a triangle may turn */
#define PATIENCE 10u /* rounds without a better one */

/* ---- rows ---- */

static int corner_moves(const fitter *f, const uint32_t *corner)
{
    return f->moves[corner[0]] || f->moves[corner[1]] || f->moves[corner[2]];
}

static void corner_slots(const fitter *f, const uint32_t *corner, fit_row *out)
{
    for (uint32_t k = 0; k < 3u; k++) {
        out->slot[k] = f->slot[f->point_of[corner[k]]];
    }
}

static int has_slot(const fit_row *r)
{
    return r->slot[0] != LOD_NONE || r->slot[1] != LOD_NONE || r->slot[2] != LOD_NONE;
}

static void place_on(const float *triangle, const float *weight, float *out)
{
    for (uint32_t k = 0; k < 3u; k++) {
        out[k] = weight[0] * triangle[k] + weight[1] * triangle[3u + k] + weight[2] * triangle[6u + k];
    }
}

/* The row from the coarse surface's place to the full one's, whose distance is *bound; it counts only if it is not far
 * below the largest, and a corner can move. */
static void add_row(fitter *f, fit_row *r, const float *coarse, const float *full, float *bound)
{
    float squared = 0.0f;
    for (uint32_t k = 0; k < 3u; k++) {
        r->direction[k] = full[k] - coarse[k];
        squared += r->direction[k] * r->direction[k];
    }
    *bound = r->distance = sqrtf(squared);
    if (!(r->distance > f->least) || !has_slot(r)) {
        return;
    }
    for (uint32_t k = 0; k < 3u; k++) {
        r->direction[k] /= r->distance;
    }
    f->rows[f->row_count++] = *r;
}

static void corners_of(const float *position, const uint32_t *corner, float *triangle)
{
    for (uint32_t k = 0; k < 3u; k++) {
        memcpy(triangle + 3u * k, position + 3u * (size_t)corner[k], 3u * sizeof *triangle);
    }
}

static void sample_place(const fitter *f, const fit_part *p, uint32_t sample, float *out)
{
    const float third[3] = { 1.0f / 3.0f, 1.0f / 3.0f, 1.0f / 3.0f };
    float triangle[9];
    if (sample < f->vertex_count) {
        memcpy(out, f->full + 3u * (size_t)sample, 3u * sizeof *out);
        return;
    }
    corners_of(f->full, p->full + 3u * (size_t)(sample - f->vertex_count), triangle);
    place_on(triangle, third, out);
}

static int sample_moves(const fitter *f, const fit_part *p, uint32_t i)
{
    const uint32_t sample = p->sample[i];
    return corner_moves(f, p->coarse + 3u * (size_t)p->match[i].triangle) ||
           (sample < f->vertex_count ? f->moves[sample]
                                     : corner_moves(f, p->full + 3u * (size_t)(sample - f->vertex_count)));
}

/* Whether a sample is nearer than what is listed, by the place that was nearest to it before; else *place is the
 * nearest one, or one as near as what is not listed. */
static int is_near(const fitter *f, lod_tree *to, const float *from, fit_match *m, float *place)
{
    m->bound = sqrtf(lod_distance_from(to->triangles + 9u * (size_t)m->triangle, m->place, from[0], from[1], from[2]));
    if (m->bound < f->least) {
        return 1;
    }
    (void)lod_tree_nearest(to, from, f->least * f->least, &m->triangle);
    lod_distance_place(to->triangles + 9u * (size_t)m->triangle, from, m->place);
    place_on(to->triangles + 9u * (size_t)m->triangle, m->place, place);
    return 0;
}

static void add_samples(fitter *f, fit_part *p)
{
    for (uint32_t i = 0; i < p->sample_count; i++) {
        fit_match *m = &p->match[i];
        float from[3], to[3];
        fit_row r;
        m->bound += f->drift;
        if (m->bound < f->least || !sample_moves(f, p, i)) {
            continue;
        }
        sample_place(f, p, p->sample[i], from);
        if (is_near(f, &p->coarse_tree, from, m, to)) {
            continue;
        }
        memcpy(r.weight, m->place, sizeof r.weight);
        corner_slots(f, p->coarse + 3u * (size_t)m->triangle, &r);
        add_row(f, &r, to, from, &m->bound);
    }
}

/* Whether a sample is to be measured, i, j and k steps from the opposite edges: a corner in one of its triangles alone.
 */
static int is_own_sample(fitter *f, const uint32_t *corner, uint32_t i, uint32_t j, uint32_t k)
{
    const uint32_t steps[3] = { i, j, k };
    for (uint32_t c = 0; c < 3u; c++) {
        const uint32_t p = f->point_of[corner[c]];
        if (steps[c] == FIT_GRID) {
            const int first = f->seen[p] != f->list;
            f->seen[p] = f->list;
            return first;
        }
    }
    return 1;
}

static void add_back(fitter *f, fit_part *p, uint32_t t)
{
    const uint32_t *corner = p->coarse + 3u * (size_t)t;
    fit_match *m = p->back + (size_t)FIT_BACK * t;
    fit_row r;
    corner_slots(f, corner, &r);
    for (uint32_t i = 0; i <= FIT_GRID; i++) {
        for (uint32_t j = 0; i + j <= FIT_GRID; j++, m++) {
            const float a = (float)i / FIT_GRID, b = (float)j / FIT_GRID;
            float from[3], to[3];
            m->bound += f->drift;
            if (m->bound < f->least || !is_own_sample(f, corner, i, j, FIT_GRID - i - j)) {
                continue;
            }
            r.weight[0] = a;
            r.weight[1] = b;
            r.weight[2] = 1.0f - a - b;
            place_on(p->coarse_tree.triangles + 9u * (size_t)t, r.weight, from);
            if (!is_near(f, &p->full_tree, from, m, to)) {
                add_row(f, &r, from, to, &m->bound);
            }
        }
    }
}

static float list_rows(fitter *f)
{
    float largest = 0.0f;
    f->row_count = 0;
    f->list++;
    for (uint32_t i = 0; i < f->part_count; i++) {
        fit_part *p = &f->parts[i];
        lod_tree_pose(&p->coarse_tree, f->at);
        add_samples(f, p);
        for (uint32_t t = 0; t < p->coarse_count; t++) {
            if (corner_moves(f, p->coarse + 3u * (size_t)t)) {
                add_back(f, p, t);
            }
        }
    }
    for (uint32_t i = 0; i < f->row_count; i++) {
        largest = f->rows[i].distance > largest ? f->rows[i].distance : largest;
    }
    f->reach = f->reach > 0.0f ? f->reach : REACH * largest;
    /* farther places are torn by mixes and do not guide the fit */
    largest = largest < f->reach ? largest : f->reach;
    for (uint32_t i = 0; i < f->row_count; i++) {
        const double ratio = f->rows[i].distance < largest ? f->rows[i].distance / largest : 1.0f,
                     squared = ratio * ratio;
        f->rows[i].stiffness = squared * squared * squared;
    }
    f->least = LEAST_RATIO * largest;
    return largest;
}

/* ---- steps ---- */

/* The vertices of each point go where it is. */
static void spread(fitter *f)
{
    for (uint32_t i = 0; i < f->used_count; i++) {
        const uint32_t v = f->used[i], p = f->point_of[v];
        if (v != p) {
            memcpy(f->at + 3u * (size_t)v, f->at + 3u * (size_t)p, 3u * sizeof *f->at);
        }
    }
}

static void step(fitter *f, float largest)
{
    const float reach = f->reach;
    f->drift = 0.0f;
    for (uint32_t s = 0; s < f->slot_count; s++) {
        float *at = f->at + 3u * (size_t)f->slot_point[s];
        const float *from = f->start + 3u * (size_t)f->slot_point[s];
        for (uint32_t k = 0; k < 3u; k++) {
            const float most = STEP_MAX * largest;
            float by = (float)(SHORTENED * f->unknowns[3u * (size_t)s + k]), to;
            by = by > most ? most : by < -most ? -most : by;
            to = at[k] + by;
            f->drift = fabsf(by) > f->drift ? fabsf(by) : f->drift;
            at[k] = to > from[k] + reach ? from[k] + reach : to < from[k] - reach ? from[k] - reach : to;
        }
    }
    f->drift *= SQRT_3;
    spread(f);
}

static float dot(const float *a, const float *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Points of triangles that would fold go back to where they started, and stay. */
static void hold_folds(fitter *f)
{
    for (uint32_t i = 0; i < f->part_count; i++) {
        for (uint32_t t = 0; t < f->parts[i].coarse_count; t++) {
            const uint32_t *corner = f->parts[i].coarse + 3u * (size_t)t;
            float triangle[9], before[3], now[3];
            corners_of(f->start, corner, triangle);
            lod_normal(triangle, before);
            corners_of(f->at, corner, triangle);
            lod_normal(triangle, now);
            if (dot(before, now) >= TURNED * sqrtf(dot(before, before) * dot(now, now))) {
                continue;
            }
            for (uint32_t k = 0; k < 3u; k++) {
                const uint32_t p = f->point_of[corner[k]];
                if (f->slot[p] != LOD_NONE) {
                    f->drift += SQRT_3 * f->reach; /* anything may be farther now */
                    memcpy(f->at + 3u * (size_t)p, f->start + 3u * (size_t)p, 3u * sizeof *f->at);
                    f->slot[p] = LOD_NONE;
                }
            }
        }
    }
    spread(f);
}

/* Nothing is known of a new pose, but that its largest distance is like that at rest. */
static void forget(fitter *f)
{
    f->least = FIRST_RATIO / REACH * f->reach;
    f->drift = 0.0f;
    for (uint32_t i = 0; i < f->part_count; i++) {
        fit_part *p = &f->parts[i];
        for (uint32_t k = 0; k < p->sample_count; k++) {
            p->match[k].bound = INFINITY;
        }
        for (uint32_t k = 0; k < FIT_BACK * p->coarse_count; k++) {
            p->back[k].bound = INFINITY;
        }
    }
}

static void number_slots(fitter *f)
{
    f->slot_count = 0;
    for (uint32_t i = 0; i < f->point_count; i++) {
        const uint32_t p = f->point[i];
        if (f->slot[p] != LOD_NONE) {
            f->slot_point[f->slot_count] = p;
            f->slot[p] = f->slot_count++;
        }
    }
}

static void keep(const fitter *f)
{
    for (uint32_t i = 0; i < f->point_count; i++) {
        memcpy(f->best + 3u * (size_t)i, f->at + 3u * (size_t)f->point[i], 3u * sizeof *f->best);
    }
}

static void take_kept(fitter *f)
{
    for (uint32_t i = 0; i < f->point_count; i++) {
        memcpy(f->at + 3u * (size_t)f->point[i], f->best + 3u * (size_t)i, 3u * sizeof *f->best);
    }
    spread(f);
}

void fit_pose(fitter *f, uint32_t rounds)
{
    float least = INFINITY;
    uint32_t since = 0;
    for (uint32_t i = 0; i < f->point_count; i++) {
        f->slot[f->point[i]] = f->moves[f->point[i]] ? 0u : LOD_NONE;
    }
    for (uint32_t i = 0; i < f->part_count; i++) {
        lod_tree_pose(&f->parts[i].full_tree, f->full);
    }
    forget(f);
    keep(f);
    for (uint32_t round = 0; round < rounds && since < PATIENCE; round++) {
        float largest;
        number_slots(f);
        largest = f->slot_count ? list_rows(f) : 0.0f;
        if (!(largest > 0.0f)) {
            break;
        }
        since++;
        if (largest < least) {
            least = largest;
            since = 0;
            keep(f);
        }
        fit_solve(f);
        step(f, largest);
        hold_folds(f);
    }
    if (rounds > 1u) {
        take_kept(f);
    }
}
