/* lod_measure.c: how far a collapse would take the surface from the samples around it, in every pose.
 *
 * Fine levels are seen from near, mostly at rest; coarse ones must at least keep the expressions. So distances in poses
 * of targets count more as they grow: one of a mean edge's length counts 1 + POSE_GROWTH times. So do those at the rims
 * of lids and lips, where the distance to the nearest surface says little about the gap that opens. */
#include <math.h>
#include <string.h>

#include "lod_track.h"

#define REVERSE_SAMPLES 6u
#define REVERSE_MAX (REVERSE_SAMPLES * LOD_FAN_MAX) /* a multiple of LOD_LANES */
#define POSE_GROWTH 2.0
#define RIM_GROWTH 4.0f

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

static float samples_to_triangles(lod_track *t, const lod_pose_view *v, uint32_t pose, const float *triangles,
                                  uint32_t count)
{
    lod_track_fill(t->squared, t->padded);
    for (uint32_t i = 0; i < count; i++) {
        lod_distance_triangle(triangles + i * 9u, v->samples, v->samples + t->capacity, v->samples + 2u * t->capacity,
                              t->padded, t->squared);
    }
    return lod_set_has(t->shows, pose) ? largest_of_rims(t, pose) : largest(t->squared, t->count);
}

/* The points at which a new triangle is compared with the full mesh: on its new edge, which starts at the point that
 * stays, and inside. */
static const float reverse_weights[REVERSE_SAMPLES][3] = {
    { 0.75f, 0.25f, 0.0f }, { 0.5f, 0.5f, 0.0f }, { 0.25f, 0.75f, 0.0f },
    { 0.6f, 0.2f, 0.2f },   { 0.2f, 0.6f, 0.2f }, { 0.2f, 0.2f, 0.6f },
};

static float triangles_to_mesh(lod_track *t, const lod_pose_view *v, const float *triangles, uint32_t count)
{
    float at[3][REVERSE_MAX], squared[REVERSE_MAX];
    uint32_t samples = count * REVERSE_SAMPLES, padded = (samples + LOD_LANES - 1u) / LOD_LANES * LOD_LANES;
    for (uint32_t i = 0; i < padded; i++) {
        const float *p = triangles + (i < samples ? i / REVERSE_SAMPLES : 0u) * 9u,
                    *weight = reverse_weights[i % REVERSE_SAMPLES];
        for (uint32_t k = 0; k < 3u; k++) {
            at[k][i] = weight[0] * p[k] + weight[1] * p[3u + k] + weight[2] * p[6u + k];
        }
    }
    lod_track_fill(squared, padded);
    for (uint32_t i = 0; i < t->triangle_count; i++) {
        lod_distance_triangle(v->triangles + (size_t)i * 9u, at[0], at[1], at[2], padded, squared);
    }
    return t->triangle_count ? largest(squared, samples) : 0.0f;
}

static void normal_of(const float *t, float *out)
{
    float a[3] = { t[3] - t[0], t[4] - t[1], t[5] - t[2] }, b[3] = { t[6] - t[0], t[7] - t[1], t[8] - t[2] };
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* A triangle that flips in a pose costs its area, which is what shows wrongly. */
static float turned_area(const lod_surface *s, const lod_move *m, uint32_t pose, const float *triangles)
{
    float area = 0.0f;
    for (uint32_t i = 0; i < m->kept_count; i++) {
        float before[9], n0[3], n1[3];
        lod_move_triangle(s, m->kept[i], m->from, pose, before);
        normal_of(before, n0);
        normal_of(triangles + i * 9u, n1);
        if (n0[0] * n1[0] + n0[1] * n1[1] + n0[2] * n1[2] < 0.0f) {
            float squared = n1[0] * n1[0] + n1[1] * n1[1] + n1[2] * n1[2];
            area = squared > area ? squared : area;
        }
    }
    return 0.5f * sqrtf(area);
}

static double pose_cost(lod_track *t, const lod_move *m, uint32_t pose, double bound)
{
    const lod_pose_view *v = lod_track_view(t, pose);
    float triangles[LOD_FAN_MAX * 9u], worst, turned, reverse;
    for (uint32_t i = 0; i < m->kept_count; i++) {
        lod_move_triangle(t->surface, m->kept[i], m->to, pose, triangles + i * 9u);
    }
    worst = samples_to_triangles(t, v, pose, triangles, m->kept_count);
    turned = turned_area(t->surface, m, pose, triangles);
    worst = turned > worst ? turned : worst;
    if (worst >= bound) {
        return worst;
    }
    reverse = triangles_to_mesh(t, v, triangles, m->kept_count);
    return reverse > worst ? reverse : worst;
}

/* The factor on a squared distance in a pose. */
static double counted(const lod_surface *s, uint32_t pose, double squared)
{
    double grown = 1.0;
    if (pose && pose < s->poses.first_given && s->edge > 0.0f) {
        grown += POSE_GROWTH * sqrt(squared) / s->edge;
    }
    return squared * grown * grown * s->poses.weight[pose];
}

double lod_track_cost(lod_track *t, const lod_move *m, double bound, double *squared)
{
    const lod_surface *s = t->surface;
    double worst = 0.0;
    *squared = 0.0;
    for (uint32_t i = 0; i < t->pose_count && worst < bound; i++) {
        uint32_t pose = t->pose[i];
        double distance = pose_cost(t, m, pose, bound / s->poses.weight[pose]), cost = counted(s, pose, distance);
        *squared = distance > *squared ? distance : *squared;
        if (cost > worst) {
            worst = cost;
            memmove(t->pose + 1, t->pose, i * sizeof *t->pose);
            t->pose[0] = pose;
        }
    }
    return worst;
}
