/* lod_measure.c: the distance of the surface after a collapse from the samples around it, in every pose.
 *
 * Fine levels are seen from near, mostly at rest; coarse ones must at least keep the expressions. So distances in poses
 * of targets count more as they grow: one of a mean edge's length counts 1 + POSE_GROWTH times. So do those at the rims
 * of lids and lips, where the distance to the nearest surface says little about the gap that opens.
 *
 * Few poses decide. In the first one, the nearest place of every sample is noted; in any other, the distance to the
 * same place is a bound, at the price of one triangle for each sample instead of all. A pose whose bounds are below
 * the known distance needs no more work: the cost is the same. */
#include <math.h>
#include <string.h>

#include "lod_track.h"

#define POSE_GROWTH 2.0
#define RIM_GROWTH 4.0f

/* A move in one pose. */
typedef struct posed_move {
    const lod_pose_view *view;
    uint32_t pose, count;              /* count: new triangles */
    float triangles[LOD_FAN_MAX * 9u]; /* [count][3][3] the new ones */
    float at[3][LOD_REVERSE_MAX];      /* their samples */
    uint32_t samples, padded;          /* of those */
    float turned;                      /* turned_area */
} posed_move;

static float largest(const float *values, uint32_t count)
{
    float worst = 0.0f;
    for (uint32_t i = 0; i < count; i++) {
        worst = values[i] > worst ? values[i] : worst;
    }
    return worst;
}

/* The same for rims that open or close. */
static float largest_of_rims(const lod_track *t, uint32_t pose)
{
    const lod_surface *s = t->surface;
    float worst = 0.0f;
    for (uint32_t i = 0; i < t->count; i++) {
        uint32_t id = t->sample[i];
        int shows = id < s->mesh->vertex_count && lod_set_has(s->shows + (size_t)id * s->poses.words, pose);
        float grown = shows ? 1.0f + RIM_GROWTH * sqrtf(t->squared[i]) / s->edge : 1.0f,
              squared = t->squared[i] * grown * grown;
        worst = squared > worst ? squared : worst;
    }
    return worst;
}

static float largest_of_samples(const lod_track *t, uint32_t pose)
{
    return lod_set_has(t->shows, pose) ? largest_of_rims(t, pose) : largest(t->squared, t->count);
}

/* ---- a move in a pose ---- */

/* The points at which a new triangle is compared with the full mesh: on its new edge, which starts at the point that
 * stays, and inside. */
static const float reverse_weights[LOD_REVERSE_SAMPLES][3] = {
    { 0.75f, 0.25f, 0.0f }, { 0.5f, 0.5f, 0.0f }, { 0.25f, 0.75f, 0.0f },
    { 0.6f, 0.2f, 0.2f },   { 0.2f, 0.6f, 0.2f }, { 0.2f, 0.2f, 0.6f },
};

/* A triangle that flips in a pose costs its area, which is what shows wrongly. */
static float turned_area(const lod_surface *s, const lod_move *m, uint32_t pose, const float *triangles)
{
    float area = 0.0f;
    for (uint32_t i = 0; i < m->kept_count; i++) {
        float before[9], n0[3], n1[3];
        lod_move_triangle(s, m->kept[i], m->from, pose, before);
        lod_normal(before, n0);
        lod_normal(triangles + i * 9u, n1);
        if (n0[0] * n1[0] + n0[1] * n1[1] + n0[2] * n1[2] < 0.0f) {
            float squared = n1[0] * n1[0] + n1[1] * n1[1] + n1[2] * n1[2];
            area = squared > area ? squared : area;
        }
    }
    return 0.5f * sqrtf(area);
}

static void sample_triangles(posed_move *p)
{
    for (uint32_t i = 0; i < p->padded; i++) {
        const float *corner = p->triangles + (i < p->samples ? i / LOD_REVERSE_SAMPLES : 0u) * 9u,
                    *weight = reverse_weights[i % LOD_REVERSE_SAMPLES];
        for (uint32_t k = 0; k < 3u; k++) {
            p->at[k][i] = weight[0] * corner[k] + weight[1] * corner[3u + k] + weight[2] * corner[6u + k];
        }
    }
}

static void pose_move(lod_track *t, const lod_move *m, uint32_t pose, posed_move *p)
{
    p->view = lod_track_view(t, pose);
    p->pose = pose;
    p->count = m->kept_count;
    for (uint32_t i = 0; i < m->kept_count; i++) {
        lod_move_triangle(t->surface, m->kept[i], m->to, pose, p->triangles + i * 9u);
    }
    p->samples = m->kept_count * LOD_REVERSE_SAMPLES;
    p->padded = (p->samples + LOD_LANES - 1u) / LOD_LANES * LOD_LANES;
    p->turned = turned_area(t->surface, m, pose, p->triangles);
}

/* ---- distances ---- */

/* Note the nearest places of points, given the nearest of `triangles` for each. */
static void match_points(const float *triangles, const uint32_t *nearest, const float *const at[3], uint32_t count,
                         lod_match *out)
{
    for (uint32_t i = 0; i < count; i++) {
        const float point[3] = { at[0][i], at[1][i], at[2][i] };
        out[i].triangle = nearest[i];
        lod_distance_place(triangles + (size_t)nearest[i] * 9u, point, out[i].weight);
    }
}

/* Squared distances of points to the places noted. */
static void match_distances(lod_track *t, const float *triangles, const lod_match *match, const float *const at[3],
                            uint32_t count, float *squared)
{
    t->work += count;
    for (uint32_t i = 0; i < count; i++) {
        squared[i] = lod_distance_from(triangles + (size_t)match[i].triangle * 9u, match[i].weight, at[0][i], at[1][i],
                                       at[2][i]);
    }
}

static void all_distances(lod_track *t, const float *triangles, uint32_t triangle_count, const float *const at[3],
                          uint32_t padded, float *squared, uint32_t *nearest)
{
    t->work += (uint64_t)triangle_count * padded;
    lod_track_fill(squared, padded);
    for (uint32_t i = 0; i < triangle_count; i++) {
        const float *triangle = triangles + (size_t)i * 9u;
        if (nearest) {
            lod_distance_nearest(triangle, i, at[0], at[1], at[2], padded, squared, nearest);
        } else {
            lod_distance_triangle(triangle, at[0], at[1], at[2], padded, squared);
        }
    }
}

/* The largest squared distance in a pose; stops at `bound`. note: take down the nearest places. */
static double pose_cost(lod_track *t, posed_move *p, double bound, int note)
{
    const float *const from[3] = { p->view->samples, p->view->samples + t->capacity,
                                   p->view->samples + 2u * t->capacity };
    const float *const back[3] = { p->at[0], p->at[1], p->at[2] };
    uint32_t nearest[LOD_REVERSE_MAX] = { 0 };
    float squared[LOD_REVERSE_MAX], worst, reverse;
    all_distances(t, p->triangles, p->count, from, t->padded, t->squared, note ? t->owner : NULL);
    worst = largest_of_samples(t, p->pose);
    worst = p->turned > worst ? p->turned : worst;
    if (worst >= bound) {
        return worst;
    }
    sample_triangles(p);
    all_distances(t, p->view->triangles, t->triangle_count, back, p->padded, squared, note ? nearest : NULL);
    reverse = t->triangle_count ? largest(squared, p->samples) : 0.0f;
    if (note) {
        match_points(p->triangles, t->owner, from, t->count, t->match);
        match_points(p->view->triangles, nearest, back, t->triangle_count ? p->samples : 0u, t->back);
    }
    return reverse > worst ? reverse : worst;
}

/* Whether no distance in a pose is above a squared one, by the places noted. */
static int is_within(lod_track *t, posed_move *p, double limit)
{
    const float *const from[3] = { p->view->samples, p->view->samples + t->capacity,
                                   p->view->samples + 2u * t->capacity };
    const float *const back[3] = { p->at[0], p->at[1], p->at[2] };
    float squared[LOD_REVERSE_MAX];
    if (p->turned > limit) {
        return 0;
    }
    match_distances(t, p->triangles, t->match, from, t->count, t->squared);
    if (largest_of_samples(t, p->pose) > limit) {
        return 0;
    }
    if (!t->triangle_count) {
        return 1;
    }
    sample_triangles(p);
    match_distances(t, p->view->triangles, t->back, back, p->samples, squared);
    return largest(squared, p->samples) <= limit;
}

/* ---- all poses ---- */

/* The factor on a squared distance in a pose. */
static double counted(const lod_surface *s, uint32_t pose, double squared)
{
    double grown = 1.0;
    if (pose && pose < s->poses.first_given && s->edge > 0.0f) {
        grown += POSE_GROWTH * sqrt(squared) / s->edge;
    }
    return squared * grown * grown * s->poses.weight[pose];
}

/* A squared distance up to which a pose changes neither what is known of the distances nor of the costs: the factor of
 * a smaller distance is not larger. */
static double limit_of(const lod_surface *s, uint32_t pose, double squared, double cost)
{
    const double here = counted(s, pose, squared);
    return here > cost ? squared * (cost / here) : squared;
}

double lod_track_cost(lod_track *t, const lod_move *m, double bound, double *squared)
{
    const lod_surface *s = t->surface;
    double worst = 0.0;
    posed_move p;
    *squared = 0.0;
    for (uint32_t i = 0; i < t->pose_count && worst < bound; i++) {
        uint32_t pose = t->pose[i];
        double distance, cost;
        pose_move(t, m, pose, &p);
        if (i && is_within(t, &p, limit_of(s, pose, *squared, worst))) {
            continue;
        }
        distance = pose_cost(t, &p, bound / s->poses.weight[pose], i == 0);
        cost = counted(s, pose, distance);
        *squared = distance > *squared ? distance : *squared;
        if (cost > worst) {
            worst = cost;
            memmove(t->pose + 1, t->pose, i * sizeof *t->pose);
            t->pose[0] = pose;
        }
    }
    return worst;
}

double lod_track_least(lod_track *t, const lod_move *m)
{
    const lod_pose_view *v = lod_track_view(t, 0);
    const float *const from[3] = { v->samples, v->samples + t->capacity, v->samples + 2u * t->capacity };
    float triangles[LOD_FAN_MAX * 9u];
    for (uint32_t i = 0; i < m->kept_count; i++) {
        lod_move_triangle(t->surface, m->kept[i], m->to, 0, triangles + i * 9u);
    }
    all_distances(t, triangles, m->kept_count, from, t->padded, t->squared, NULL);
    return counted(t->surface, 0, largest(t->squared, t->count));
}
