/* complete.c: computes the normals and tangents that a file lacks, in the base and in the targets.
 *
 * A missing delta is the result of our algorithm for the morphed mesh minus its result for the base; it is added to the
 * file's base. Where no triangle around a vertex changes, both are equal to the bit and the delta is an
 * exact zero. */
#include "model_build.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A normal of the file whose length is off by more than this is scaled to length 1. Quantised normals (8 bits) are off
 * by less and keep their exact values. */
#define UNIT_TOLERANCE 0.01

/* The state of one mesh while it is completed. */
typedef struct work {
    model_mesh *mesh;
    uint32_t *weld;          /* [vertex_count] */
    uint8_t *missing;        /* [vertex_count] MODEL_MISSING_* of the base */
    uint8_t *target_missing; /* [vertex_count] of the target at hand */
    uint8_t *touched;        /* [fans or groups] of the target at hand */
    normal_fans fans;
    tangent_groups groups;
    double *base_normal;  /* [fan_count][3] */
    double *base_tangent; /* [vertex_count][3] ours, not the file's */
} work;

/* Copies of split vertices are in no submesh's range, but in its triangles. */
static void spread_missing(const model_mesh *mesh, const uint8_t *by_submesh, uint8_t *by_vertex)
{
    for (uint32_t s = 0; s < mesh->submesh_count; ++s) {
        const model_submesh *sub = &mesh->submeshes[s];
        const uint8_t missing = by_submesh ? by_submesh[s] : sub->missing;
        memset(by_vertex + sub->first_vertex, missing, sub->vertex_count);
        for (uint32_t i = 0; i < sub->index_count; ++i) by_vertex[mesh->indices[sub->first_index + i]] = missing;
    }
}

static int any_bit(const uint8_t *bits, uint32_t count, uint8_t bit)
{
    for (uint32_t i = 0; i < count; ++i)
        if (bits[i] & bit) return 1;
    return 0;
}

static void set_bits(uint8_t *bits, uint32_t count, uint8_t bit)
{
    for (uint32_t i = 0; i < count; ++i) bits[i] = (uint8_t)(bits[i] | bit);
}

static double length_of(const float *v)
{
    double wide[3] = { (double)v[0], (double)v[1], (double)v[2] };
    return sqrt(vec_dot(wide, wide));
}

static void scale_by(float *v, double factor)
{
    for (int i = 0; i < 3; ++i) v[i] = (float)((double)v[i] * factor);
}

/* A base vector that is not unit is scaled together with its deltas, which keeps the direction of every blend. Returns
 * 0 when it has no length. */
static int unit_from_file(model_mesh *mesh, uint32_t v, int is_tangent)
{
    float *base = is_tangent ? mesh->tangent + (size_t)v * 4 : mesh->normal + (size_t)v * 3;
    double length = length_of(base);
    if (!(length > 1e-6)) return 0;
    if (fabs(length - 1.0) <= UNIT_TOLERANCE) return 1;
    scale_by(base, 1.0 / length);
    for (uint32_t t = 0; t < mesh->target_count; ++t) {
        float *delta = is_tangent ? mesh->targets[t].tangent : mesh->targets[t].normal;
        if (delta) scale_by(delta + (size_t)v * 3, 1.0 / length);
    }
    return 1;
}

/* Bring the file's vectors to unit length; those without length count as missing. */
static uint32_t check_file_vectors(work *w, int is_tangent)
{
    uint8_t bit = is_tangent ? MODEL_MISSING_TANGENT : MODEL_MISSING_NORMAL;
    uint32_t empty = 0;
    for (uint32_t v = 0; v < w->mesh->vertex_count; ++v) {
        if ((w->missing[v] & bit) || unit_from_file(w->mesh, v, is_tangent)) continue;
        w->missing[v] = (uint8_t)(w->missing[v] | bit);
        ++empty;
    }
    return empty;
}

static void write_float3(float *out, const double *v)
{
    for (int i = 0; i < 3; ++i) out[i] = (float)v[i];
}

/* The difference of two poses, without rounding noise. */
static void write_delta(float *out, const double *posed, const double *base)
{
    double delta[3];
    for (int i = 0; i < 3; ++i) delta[i] = posed[i] - base[i];
    if (vec_dot(delta, delta) < MODEL_DELTA_NOISE * MODEL_DELTA_NOISE) memset(delta, 0, sizeof delta);
    for (int i = 0; i < 3; ++i) out[i] = (float)delta[i] + 0.0f; /* no -0 */
}

static int moves(const float *delta, uint32_t v)
{
    const float *d = delta + (size_t)v * 3;
    return d[0] != 0.0f || d[1] != 0.0f || d[2] != 0.0f;
}

static int slides(const float *uv_delta, uint32_t v)
{
    return uv_delta && (uv_delta[(size_t)v * 2] != 0.0f || uv_delta[(size_t)v * 2 + 1] != 0.0f);
}

/* --- normals --- */

static void base_normals_write(work *w)
{
    static const double fallback[3] = { 0.0, 0.0, 1.0 };
    for (uint32_t v = 0; v < w->mesh->vertex_count; ++v) {
        if (!(w->missing[v] & MODEL_MISSING_NORMAL)) continue;
        uint32_t fan = w->fans.vertex_fan[v];
        const double *n = fan == MODEL_NONE ? fallback : w->fans.normal + (size_t)fan * 3;
        write_float3(w->mesh->normal + (size_t)v * 3, vec_dot(n, n) > 0.0 ? n : fallback);
    }
}

static int base_normals(work *w)
{
    size_t bytes;
    if (normals_build(w->mesh, w->weld, &w->fans)) return 1;
    normals_evaluate(&w->fans, w->mesh, NULL, NULL);
    base_normals_write(w);
    bytes = (size_t)w->fans.fan_count * 3 * sizeof(double);
    w->base_normal = model_zeros(w->fans.fan_count, 3 * sizeof(double));
    w->touched = model_zeros(w->fans.fan_count, 1);
    if (!w->base_normal || !w->touched) return 1;
    memcpy(w->base_normal, w->fans.normal, bytes);
    return 0;
}

static void touch_fans(work *w, const float *delta)
{
    const uint32_t *index = w->mesh->indices;
    memset(w->touched, 0, w->fans.fan_count);
    for (uint32_t c = 0; c + 2 < w->mesh->index_count; c += 3)
        if (moves(delta, index[c]) || moves(delta, index[c + 1]) || moves(delta, index[c + 2]))
            for (uint32_t k = 0; k < 3; ++k) w->touched[w->fans.corner_fan[c + k]] = 1;
}

static void target_normals(work *w, model_target *target)
{
    touch_fans(w, target->position);
    normals_evaluate(&w->fans, w->mesh, target->position, w->touched);
    for (uint32_t v = 0; v < w->mesh->vertex_count; ++v) {
        uint32_t fan = w->fans.vertex_fan[v];
        if (!(w->target_missing[v] & MODEL_MISSING_NORMAL) || fan == MODEL_NONE || !w->touched[fan]) continue;
        const double *base = w->base_normal + (size_t)fan * 3, *posed = w->fans.normal + (size_t)fan * 3;
        if (vec_dot(base, base) > 0.0 && vec_dot(posed, posed) > 0.0)
            write_delta(target->normal + (size_t)v * 3, posed, base);
    }
}

/* --- tangents --- */

static void normal_in_pose(const work *w, const float *delta, uint32_t v, double *out)
{
    vec_posed(w->mesh->normal, delta, v, out);
    if (vec_normalize(out)) return;
    vec_posed(w->mesh->normal, NULL, v, out);
    (void)vec_normalize(out);
}

/* A vertex's tangent from its group's sum; if that is zero, from the base tangent, so that it turns with the normal; if
 * there is none either, any perpendicular vector. */
static void tangent_in_pose(const work *w, const float *normal_delta, uint32_t v, const double *base, double *out)
{
    const double *sum = w->groups.sum + (size_t)w->groups.vertex_group[v] * 3;
    double normal[3];
    normal_in_pose(w, normal_delta, v, normal);
    memcpy(out, sum, 3 * sizeof(double));
    vec_reject(out, normal);
    if (vec_dot(out, out) > 1e-12 && vec_normalize(out)) return;
    if (base) {
        memcpy(out, base, 3 * sizeof(double));
        vec_reject(out, normal);
        if (vec_dot(out, out) > 1e-12 && vec_normalize(out)) return;
    }
    vec_any_perpendicular(normal, out);
}

/* If the file has tangents but no UVs, its tangent serves as ours. */
static const double *base_tangent_seed(const work *w, uint32_t v, double *buffer)
{
    if (w->missing[v] & MODEL_MISSING_TANGENT) return NULL;
    const float *file = w->mesh->tangent + (size_t)v * 4;
    for (int i = 0; i < 3; ++i) buffer[i] = (double)file[i];
    return buffer;
}

static void base_tangents_write(work *w)
{
    for (uint32_t v = 0; v < w->mesh->vertex_count; ++v) {
        double *ours = w->base_tangent + (size_t)v * 3, buffer[3];
        tangent_in_pose(w, NULL, v, base_tangent_seed(w, v, buffer), ours);
        if (!(w->missing[v] & MODEL_MISSING_TANGENT)) continue;
        float *out = w->mesh->tangent + (size_t)v * 4;
        write_float3(out, ours);
        /* v runs down in glTF but a normal map's y runs up: the bitangent, cross(normal, tangent) * w, is -dP/dv */
        out[3] = (float)-w->groups.hand[w->groups.vertex_group[v]];
    }
}

static int grow_bits(uint8_t **bits, uint32_t before, const uint32_t *sources, uint32_t count)
{
    uint8_t *grown = realloc(*bits, (size_t)before + count);
    if (!grown) return 1;
    for (uint32_t i = 0; i < count; ++i) grown[before + i] = grown[sources[i]];
    *bits = grown;
    return 0;
}

static int split_vertices(work *w)
{
    const uint32_t before = w->mesh->vertex_count;
    uint32_t *sources = NULL, count = 0;
    int failed = tangents_split(&w->groups, w->mesh, w->missing, &sources, &count) ||
                 (count && (grow_bits(&w->missing, before, sources, count) ||
                            grow_bits(&w->target_missing, before, sources, count)));
    free(sources);
    return failed;
}

static int base_tangents(work *w)
{
    if (tangents_build(w->mesh, &w->groups) || split_vertices(w)) return 1;
    tangents_evaluate(&w->groups, w->mesh, NULL, NULL, NULL, NULL);
    w->base_tangent = model_zeros(w->mesh->vertex_count, 3 * sizeof(double));
    free(w->touched);
    w->touched = model_zeros(w->groups.group_count, 1);
    if (!w->base_tangent || !w->touched) return 1;
    base_tangents_write(w);
    return 0;
}

static void touch_groups(work *w, const model_target *target)
{
    const uint32_t *index = w->mesh->indices, *group = w->groups.vertex_group;
    memset(w->touched, 0, w->groups.group_count);
    for (uint32_t c = 0; c + 2 < w->mesh->index_count; c += 3) {
        int changed = 0;
        for (uint32_t k = 0; k < 3; ++k)
            changed |= moves(target->position, index[c + k]) || moves(target->normal, index[c + k]) ||
                       slides(target->uv, index[c + k]);
        for (uint32_t k = 0; changed && k < 3; ++k) w->touched[group[index[c + k]]] = 1;
    }
}

static void target_tangents(work *w, model_target *target)
{
    touch_groups(w, target);
    tangents_evaluate(&w->groups, w->mesh, target->position, target->normal, target->uv, w->touched);
    for (uint32_t v = 0; v < w->mesh->vertex_count; ++v) {
        if (!(w->target_missing[v] & MODEL_MISSING_TANGENT) || !w->touched[w->groups.vertex_group[v]]) continue;
        const double *base = w->base_tangent + (size_t)v * 3;
        double posed[3];
        tangent_in_pose(w, target->normal, v, base, posed);
        write_delta(target->tangent + (size_t)v * 3, posed, base);
    }
}

/* --- one mesh --- */

/* Missing arrays become zeros with every MODEL_MISSING_* bit set, so that the rest has one case only. */
static int allocate_target(const model_mesh *mesh, model_target *target)
{
    size_t count = mesh->vertex_count;
    int no_normal = !target->normal, no_tangent = mesh->tangent && !target->tangent;
    if (!target->missing) target->missing = model_zeros(mesh->submesh_count, 1);
    if (no_normal) target->normal = model_zeros(count, 3 * sizeof(float));
    if (no_tangent) target->tangent = model_zeros(count, 3 * sizeof(float));
    if (!target->missing || !target->normal || (mesh->tangent && !target->tangent)) return 1;
    if (no_normal) set_bits(target->missing, mesh->submesh_count, MODEL_MISSING_NORMAL);
    if (no_tangent) set_bits(target->missing, mesh->submesh_count, MODEL_MISSING_TANGENT);
    return 0;
}

static int allocate_mesh(model_mesh *mesh)
{
    size_t count = mesh->vertex_count;
    int no_normal = !mesh->normal, no_tangent = !mesh->tangent && mesh->uv;
    if (no_normal) mesh->normal = model_zeros(count, 3 * sizeof(float));
    if (no_tangent) mesh->tangent = model_zeros(count, 4 * sizeof(float));
    if (!mesh->normal || (no_tangent && !mesh->tangent)) return 1;
    for (uint32_t s = 0; s < mesh->submesh_count; ++s) {
        uint8_t *missing = &mesh->submeshes[s].missing;
        if (no_normal) set_bits(missing, 1, MODEL_MISSING_NORMAL);
        if (no_tangent) set_bits(missing, 1, MODEL_MISSING_TANGENT);
    }
    for (uint32_t t = 0; t < mesh->target_count; ++t)
        if (allocate_target(mesh, &mesh->targets[t])) return 1;
    return 0;
}

static int targets_miss(const model_mesh *mesh, uint8_t bit)
{
    for (uint32_t t = 0; t < mesh->target_count; ++t)
        if (any_bit(mesh->targets[t].missing, mesh->submesh_count, bit)) return 1;
    return 0;
}

static int complete_normals(work *w)
{
    model_mesh *mesh = w->mesh;
    if (!any_bit(w->missing, mesh->vertex_count, MODEL_MISSING_NORMAL) && !targets_miss(mesh, MODEL_MISSING_NORMAL))
        return 0;
    if (base_normals(w)) return 1;
    for (uint32_t t = 0; t < mesh->target_count; ++t) {
        if (!any_bit(mesh->targets[t].missing, mesh->submesh_count, MODEL_MISSING_NORMAL)) continue;
        spread_missing(mesh, mesh->targets[t].missing, w->target_missing);
        target_normals(w, &mesh->targets[t]);
    }
    return 0;
}

static int complete_tangents(work *w)
{
    model_mesh *mesh = w->mesh;
    if (!any_bit(w->missing, mesh->vertex_count, MODEL_MISSING_TANGENT) && !targets_miss(mesh, MODEL_MISSING_TANGENT))
        return 0;
    if (base_tangents(w)) return 1;
    for (uint32_t t = 0; t < mesh->target_count; ++t) {
        if (!any_bit(mesh->targets[t].missing, mesh->submesh_count, MODEL_MISSING_TANGENT)) continue;
        spread_missing(mesh, mesh->targets[t].missing, w->target_missing);
        target_tangents(w, &mesh->targets[t]);
    }
    return 0;
}

static void clear_missing(model_mesh *mesh)
{
    for (uint32_t s = 0; s < mesh->submesh_count; ++s) mesh->submeshes[s].missing = 0;
    for (uint32_t t = 0; t < mesh->target_count; ++t) {
        free(mesh->targets[t].missing);
        mesh->targets[t].missing = NULL;
    }
}

static int complete_arrays(model *m, work *w)
{
    model_mesh *mesh = w->mesh;
    size_t count = mesh->vertex_count;
    w->weld = model_zeros(count, sizeof *w->weld);
    w->missing = model_zeros(count, 1);
    w->target_missing = model_zeros(count, 1);
    if (!w->weld || !w->missing || !w->target_missing || allocate_mesh(mesh) || weld_vertices(mesh, w->weld)) return 1;
    spread_missing(mesh, NULL, w->missing);
    uint32_t empty = check_file_vectors(w, 0);
    if (empty && model_warn(m, "mesh '%s': %u normals have no length and were computed", mesh->name, empty)) return 1;
    empty = mesh->tangent ? check_file_vectors(w, 1) : 0;
    if (empty && model_warn(m, "mesh '%s': %u tangents have no length and were computed", mesh->name, empty)) return 1;
    return complete_normals(w) || (mesh->tangent && complete_tangents(w));
}

static int complete_mesh(model *m, model_mesh *mesh)
{
    work w = { 0 };
    w.mesh = mesh;
    int failed = complete_arrays(m, &w);
    if (!failed) clear_missing(mesh);
    normals_free(&w.fans);
    tangents_free(&w.groups);
    free(w.weld);
    free(w.missing);
    free(w.target_missing);
    free(w.touched);
    free(w.base_normal);
    free(w.base_tangent);
    return failed;
}

int model_complete(model *m, model_error *error)
{
    for (uint32_t i = 0; i < m->mesh_count; ++i) {
        if (!complete_mesh(m, &m->meshes[i])) continue;
        char where[sizeof error->where];
        (void)snprintf(where, sizeof where, "mesh '%.40s'", m->meshes[i].name);
        return model_fail(error, where, "there is not enough memory to compute normals and tangents");
    }
    return 0;
}
