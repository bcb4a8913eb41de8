/* tangents.c: tangents for meshes that have UVs but no tangents.
 *
 * After MikkTSpace, for which normal maps are baked: each corner of a
 * triangle adds the direction in which u grows, projected to the plane of the
 * corner's normal and weighted by the corner's angle in that plane; corners of
 * welded vertices with equal normals and UVs share the sum. Unlike MikkTSpace,
 * no vertex is split where UVs are mirrored: the side with the larger weight wins. */
#include "model_build.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A triangle's UVs are unusable when their area is below this part of their edges' product. */
#define UV_SLIVER 1e-9

typedef struct pose {
    const model_mesh *mesh;
    const float *position_delta, *normal_delta, *uv_delta;
} pose;

typedef struct face_tangent {
    double direction[3]; /* in which u grows, not unit */
    double position[3][3];
    signed char hand; /* +1 where the UVs run counter-clockwise, -1 where mirrored, 0 where unusable */
} face_tangent;

static void uv_difference(const pose *p, uint32_t from, uint32_t to, double *out)
{
    const float *uv = p->mesh->uv, *delta = p->uv_delta;
    for (size_t i = 0; i < 2; ++i) {
        out[i] = (double)uv[(size_t)to * 2 + i] - (double)uv[(size_t)from * 2 + i];
        if (delta) out[i] += (double)delta[(size_t)to * 2 + i] - (double)delta[(size_t)from * 2 + i];
    }
}

static signed char uv_hand(const double *d1, const double *d2)
{
    double area = d1[0] * d2[1] - d2[0] * d1[1];
    double edges = sqrt((d1[0] * d1[0] + d1[1] * d1[1]) * (d2[0] * d2[0] + d2[1] * d2[1]));
    if (!(fabs(area) > UV_SLIVER * edges)) return 0;
    return area > 0.0 ? 1 : -1;
}

static void face_tangent_evaluate(const pose *p, const uint32_t *v, face_tangent *out)
{
    double d1[2], d2[2];
    out->hand = 0;
    if (!p->mesh->uv) return;
    uv_difference(p, v[0], v[1], d1);
    uv_difference(p, v[0], v[2], d2);
    out->hand = uv_hand(d1, d2);
    if (!out->hand) return;
    for (size_t k = 0; k < 3; ++k) vec_posed(p->mesh->position, p->position_delta, v[k], out->position[k]);
    for (size_t i = 0; i < 3; ++i) {
        double e1 = out->position[1][i] - out->position[0][i], e2 = out->position[2][i] - out->position[0][i];
        out->direction[i] = (d2[1] * e1 - d1[1] * e2) * (double)out->hand;
    }
    if (!vec_normalize(out->direction)) out->hand = 0;
}

static void posed_normal(const pose *p, uint32_t v, double *out)
{
    vec_posed(p->mesh->normal, p->normal_delta, v, out);
    if (vec_normalize(out)) return;
    vec_posed(p->mesh->normal, NULL, v, out);
    (void)vec_normalize(out);
}

/* What corner k adds to its group: a vector as long as the corner's angle. Returns that angle. */
static double corner_tangent(const pose *p, const face_tangent *f, const uint32_t *v, size_t k, double *out)
{
    double normal[3], to_next[3], to_last[3];
    posed_normal(p, v[k], normal);
    for (size_t i = 0; i < 3; ++i) {
        out[i] = f->direction[i];
        to_next[i] = f->position[(k + 1) % 3][i] - f->position[k][i];
        to_last[i] = f->position[(k + 2) % 3][i] - f->position[k][i];
    }
    vec_reject(out, normal);
    vec_reject(to_next, normal);
    vec_reject(to_last, normal);
    if (!vec_normalize(out)) return 0.0;
    double angle = vec_angle(to_next, to_last);
    for (size_t i = 0; i < 3; ++i) out[i] *= angle;
    return angle;
}

typedef struct group_key {
    uint32_t word[6];
} group_key; /* welded vertex, normal, uv */

static group_key key_of(const model_mesh *mesh, const uint32_t *weld, uint32_t v)
{
    group_key key;
    float values[5] = { 0.0f };
    memcpy(values, mesh->normal + (size_t)v * 3, 3 * sizeof(float));
    if (mesh->uv) memcpy(values + 3, mesh->uv + (size_t)v * 2, 2 * sizeof(float));
    for (size_t i = 0; i < 5; ++i) values[i] += 0.0f; /* -0 and +0 are equal */
    key.word[0] = weld[v];
    memcpy(key.word + 1, values, sizeof values);
    return key;
}

static size_t key_hash(const group_key *key)
{
    uint64_t hash = 0;
    for (size_t i = 0; i < 6; ++i) {
        hash = (hash ^ key->word[i]) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return (size_t)hash;
}

/* Number the groups in order of their first vertex. */
static int find_groups(const model_mesh *mesh, const uint32_t *weld, tangent_groups *out)
{
    size_t slots = 16;
    while (slots < (size_t)mesh->vertex_count * 2) slots *= 2;
    uint32_t *table = model_zeros(slots, sizeof *table); /* vertex + 1, 0 = free */
    if (!table) return 1;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        group_key key = key_of(mesh, weld, v);
        size_t slot = key_hash(&key) & (slots - 1);
        for (; table[slot]; slot = (slot + 1) & (slots - 1)) {
            group_key other = key_of(mesh, weld, table[slot] - 1);
            if (memcmp(&key, &other, sizeof key) == 0) break;
        }
        if (table[slot]) {
            out->vertex_group[v] = out->vertex_group[table[slot] - 1];
        } else {
            table[slot] = v + 1;
            out->vertex_group[v] = out->group_count++;
        }
    }
    free(table);
    return 0;
}

/* hand = the side with the larger weight; a tie goes to +1. */
static int choose_hands(const model_mesh *mesh, tangent_groups *groups)
{
    const pose base = { mesh, NULL, NULL, NULL };
    double *weight = model_zeros(groups->group_count, sizeof *weight);
    if (!weight) return 1;
    for (uint32_t c = 0; c + 2 < mesh->index_count; c += 3) {
        const uint32_t *v = mesh->indices + c;
        face_tangent f;
        face_tangent_evaluate(&base, v, &f);
        for (size_t k = 0; f.hand && k < 3; ++k) {
            double unused[3];
            weight[groups->vertex_group[v[k]]] += (double)f.hand * corner_tangent(&base, &f, v, k, unused);
        }
    }
    for (uint32_t g = 0; g < groups->group_count; ++g) groups->hand[g] = weight[g] < 0.0 ? -1 : 1;
    free(weight);
    return 0;
}

int tangents_build(const model_mesh *mesh, const uint32_t *weld, tangent_groups *out)
{
    memset(out, 0, sizeof *out);
    out->vertex_group = model_zeros(mesh->vertex_count, sizeof *out->vertex_group);
    int failed = !out->vertex_group || find_groups(mesh, weld, out);
    if (!failed) {
        out->sum = model_zeros(out->group_count, 3 * sizeof *out->sum);
        out->hand = model_zeros(out->group_count, sizeof *out->hand);
        failed = !out->sum || !out->hand || choose_hands(mesh, out);
    }
    if (failed) tangents_free(out);
    return failed;
}

static int wanted(const uint8_t *touched, uint32_t group)
{
    return !touched || touched[group];
}

static void add_corners(tangent_groups *groups, const pose *p, const uint32_t *v, const uint8_t *touched)
{
    face_tangent f;
    face_tangent_evaluate(p, v, &f);
    for (size_t k = 0; f.hand && k < 3; ++k) {
        uint32_t g = groups->vertex_group[v[k]];
        double add[3];
        if (!wanted(touched, g) || groups->hand[g] != f.hand || corner_tangent(p, &f, v, k, add) == 0.0) continue;
        for (size_t i = 0; i < 3; ++i) groups->sum[(size_t)g * 3 + i] += add[i];
    }
}

void tangents_evaluate(tangent_groups *groups, const model_mesh *mesh, const float *position_delta,
                       const float *normal_delta, const float *uv_delta, const uint8_t *touched)
{
    const pose p = { mesh, position_delta, normal_delta, uv_delta };
    for (uint32_t g = 0; g < groups->group_count; ++g)
        if (wanted(touched, g)) memset(groups->sum + (size_t)g * 3, 0, 3 * sizeof(double));
    for (uint32_t c = 0; c + 2 < mesh->index_count; c += 3) {
        const uint32_t *v = mesh->indices + c, *group = groups->vertex_group;
        if (wanted(touched, group[v[0]]) || wanted(touched, group[v[1]]) || wanted(touched, group[v[2]]))
            add_corners(groups, &p, v, touched);
    }
}

void tangents_free(tangent_groups *groups)
{
    free(groups->vertex_group);
    free(groups->sum);
    free(groups->hand);
    memset(groups, 0, sizeof *groups);
}
