/* tangents.c: tangents for meshes that have UVs but no tangents.
 *
 * As in MikkTSpace, for which normal maps are baked: each corner of a triangle adds the direction in which u
 * grows, projected to the plane of the corner's normal and weighted by the corner's angle in that plane. Corners share
 * the sum of a fan: those round one point (equal position, normal and UV) that are reached from each other over edges,
 * in triangles whose UVs run the same way. A vertex of several fans, as at a mirrored seam, is split.
 *
 * source  Mikkelsen, Simulation of Wrinkled Surfaces Revisited, 2008, chapter 3 */
#include "model_build.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "vertex_copy.h"

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

/* The contribution of corner k to its group: a vector as long as the corner's angle. Returns that angle. */
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

/* ---- vertices of one point ---- */

/* Position, normal and texture coordinate, as MikkTSpace welds. */
static void vertex_key(const model_mesh *mesh, uint32_t v, float key[8])
{
    memcpy(key, mesh->position + (size_t)v * 3, 3 * sizeof *key);
    memcpy(key + 3, mesh->normal + (size_t)v * 3, 3 * sizeof *key);
    key[6] = mesh->uv ? mesh->uv[(size_t)v * 2] : 0.0f;
    key[7] = mesh->uv ? mesh->uv[(size_t)v * 2 + 1] : 0.0f;
    for (size_t i = 0; i < 8; ++i) key[i] += 0.0f; /* -0 and +0 are equal */
}

static size_t hash_words(const void *bytes, size_t count)
{
    uint64_t hash = 0;
    for (size_t i = 0; i < count; ++i) {
        uint32_t word;
        memcpy(&word, (const uint8_t *)bytes + 4 * i, sizeof word);
        hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return (size_t)hash;
}

static size_t slots_for(size_t count)
{
    size_t slots = 16;
    while (slots < count * 2) slots *= 2;
    return slots;
}

/* point[v]: the first vertex that MikkTSpace takes for the same. Returns 1 when out of memory. */
static int find_points(const model_mesh *mesh, uint32_t *point)
{
    const size_t slots = slots_for(mesh->vertex_count);
    uint32_t *table = model_zeros(slots, sizeof *table); /* vertex + 1, 0 = free */
    if (!table) return 1;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        float key[8], other[8];
        vertex_key(mesh, v, key);
        size_t slot = hash_words(key, 8) & (slots - 1);
        for (; table[slot]; slot = (slot + 1) & (slots - 1)) {
            vertex_key(mesh, table[slot] - 1, other);
            if (memcmp(key, other, sizeof key) == 0) break;
        }
        if (!table[slot]) table[slot] = v + 1;
        point[v] = table[slot] - 1;
    }
    free(table);
    return 0;
}

/* ---- fans ---- */

typedef struct fans {
    const model_mesh *mesh;
    tangent_groups *out;
    uint32_t *point;    /* [vertex_count] */
    uint32_t *opposite; /* [index_count] of the edge from a corner to the next: the corner where the edge that it
                         * meets begins, or MODEL_NONE */
    signed char *hand;  /* [triangles] 0: of no use, until the first fan that reaches it gives it its own */
    uint8_t *flat;      /* [triangles] two corners are at one place */
    uint32_t triangles;
} fans;

static uint32_t next_corner(uint32_t c)
{
    return c % 3 == 2 ? c - 2 : c + 1;
}

static uint32_t last_corner(uint32_t c)
{
    return c % 3 ? c - 1 : c + 2;
}

static uint32_t corner_point(const fans *f, uint32_t c)
{
    return f->point[f->mesh->indices[c]];
}

static int same_place(const model_mesh *mesh, uint32_t a, uint32_t b)
{
    for (size_t i = 0; i < 3; ++i)
        if (mesh->position[(size_t)a * 3 + i] != mesh->position[(size_t)b * 3 + i]) return 0;
    return 1;
}

static void sort_triangles(fans *f)
{
    const pose base = { f->mesh, NULL, NULL, NULL };
    for (uint32_t t = 0; t < f->triangles; ++t) {
        const uint32_t *v = f->mesh->indices + (size_t)t * 3;
        face_tangent face;
        face_tangent_evaluate(&base, v, &face);
        f->hand[t] = face.hand;
        f->flat[t] = (uint8_t)(same_place(f->mesh, v[0], v[1]) || same_place(f->mesh, v[1], v[2]) ||
                               same_place(f->mesh, v[2], v[0]));
    }
}

/* Each edge meets the first one that runs the other way and is free. Returns 1 when out of memory. */
static int find_opposites(fans *f)
{
    const uint32_t count = f->triangles * 3;
    const size_t slots = slots_for(count);
    uint32_t *table = model_zeros(slots, sizeof *table); /* corner + 1, 0 = free */
    if (!table) return 1;
    for (uint32_t c = 0; c < count; ++c) f->opposite[c] = MODEL_NONE;
    for (uint32_t c = 0; c < count; ++c) {
        const uint32_t edge[2] = { corner_point(f, c), corner_point(f, next_corner(c)) };
        const uint32_t met[2] = { edge[1], edge[0] };
        size_t slot = hash_words(met, 2) & (slots - 1);
        if (f->flat[c / 3]) continue;
        for (; table[slot]; slot = (slot + 1) & (slots - 1)) {
            const uint32_t other = table[slot] - 1;
            if (f->opposite[other] == MODEL_NONE && corner_point(f, other) == met[0] &&
                corner_point(f, next_corner(other)) == met[1])
                break;
        }
        if (table[slot]) {
            f->opposite[c] = table[slot] - 1;
            f->opposite[table[slot] - 1] = c;
            continue;
        }
        slot = hash_words(edge, 2) & (slots - 1);
        while (table[slot]) slot = (slot + 1) & (slots - 1);
        table[slot] = c + 1;
    }
    free(table);
    return 0;
}

/* Add a corner to a fan. Returns 0 where the fan ends: it is in one already, or its triangle is mirrored. */
static int join_fan(fans *f, uint32_t corner, uint32_t group)
{
    uint32_t *taken = f->out->corner_group, *first = taken + corner / 3 * 3;
    const signed char hand = f->out->hand[group];
    if (taken[corner] != MODEL_NONE) return 0;
    if (!f->hand[corner / 3] && first[0] == MODEL_NONE && first[1] == MODEL_NONE && first[2] == MODEL_NONE)
        f->hand[corner / 3] = hand;
    if (f->hand[corner / 3] != hand) return 0;
    taken[corner] = group;
    return 1;
}

/* All corners round the seed's point that are reached over edges of triangles of its hand. */
static void grow_fan(fans *f, uint32_t seed, uint32_t group)
{
    uint32_t corner = seed, edge;
    f->out->corner_group[seed] = group;
    while ((edge = f->opposite[corner]) != MODEL_NONE && join_fan(f, next_corner(edge), group))
        corner = next_corner(edge);
    corner = seed;
    while ((edge = f->opposite[last_corner(corner)]) != MODEL_NONE && join_fan(f, edge, group)) corner = edge;
}

static void find_fans(fans *f)
{
    tangent_groups *out = f->out;
    for (uint32_t c = 0; c < f->triangles * 3; ++c) out->corner_group[c] = MODEL_NONE;
    /* hands that fans give to triangles without one seed no fans: they belong to a corner that was reached */
    for (uint32_t c = 0; c < f->triangles * 3; ++c) {
        const pose base = { f->mesh, NULL, NULL, NULL };
        face_tangent face;
        if (out->corner_group[c] != MODEL_NONE || !f->hand[c / 3] || f->flat[c / 3]) continue;
        face_tangent_evaluate(&base, f->mesh->indices + c / 3 * 3, &face);
        if (!face.hand) continue;
        out->hand[out->group_count] = face.hand;
        grow_fan(f, c, out->group_count++);
    }
}

/* ---- groups of vertices ---- */

/* How much a corner adds to its fan in the base pose. */
static double corner_weight(const fans *f, uint32_t corner)
{
    const pose base = { f->mesh, NULL, NULL, NULL };
    const uint32_t *v = f->mesh->indices + corner / 3 * 3;
    double unused[3];
    face_tangent face;
    face_tangent_evaluate(&base, v, &face);
    return face.hand ? corner_tangent(&base, &face, v, corner % 3, unused) : 0.0;
}

/* Each vertex's fan: of several, one whose hand equals the file's tangent, then the one with the largest weight. */
static int choose_fans(const fans *f)
{
    const model_mesh *mesh = f->mesh;
    tangent_groups *out = f->out;
    double *weight = model_zeros(out->group_count, sizeof *weight);
    if (!weight) return 1;
    for (uint32_t c = 0; c < f->triangles * 3; ++c)
        if (out->corner_group[c] != MODEL_NONE) weight[out->corner_group[c]] += corner_weight(f, c);
    for (uint32_t c = 0; c < f->triangles * 3; ++c) {
        const uint32_t v = mesh->indices[c], g = out->corner_group[c], before = out->vertex_group[v];
        const float file = mesh->tangent ? -mesh->tangent[(size_t)v * 4 + 3] : 0.0f;
        if (g == MODEL_NONE || g == before) continue;
        if (before != MODEL_NONE) {
            const int fits = (float)out->hand[g] * file > 0.0f, fitted = (float)out->hand[before] * file > 0.0f;
            if (fits < fitted || (fits == fitted && weight[g] <= weight[before])) continue;
        }
        out->vertex_group[v] = g;
    }
    free(weight);
    return 0;
}

/* Vertices that no fan reached share the fan of another vertex of their point, or else get one without a tangent. */
static int complete_groups(const fans *f)
{
    tangent_groups *out = f->out;
    const uint32_t count = f->mesh->vertex_count;
    uint32_t *of_point = model_zeros(count, sizeof *of_point); /* group + 1 */
    if (!of_point) return 1;
    for (uint32_t v = 0; v < count; ++v)
        if (out->vertex_group[v] != MODEL_NONE && !of_point[f->point[v]])
            of_point[f->point[v]] = out->vertex_group[v] + 1;
    for (uint32_t v = 0; v < count; ++v) {
        if (out->vertex_group[v] != MODEL_NONE) continue;
        if (!of_point[f->point[v]]) {
            out->hand[out->group_count] = 1;
            of_point[f->point[v]] = ++out->group_count;
        }
        out->vertex_group[v] = of_point[f->point[v]] - 1;
    }
    free(of_point);
    return 0;
}

static int build_fans(fans *f)
{
    const model_mesh *mesh = f->mesh;
    tangent_groups *out = f->out;
    f->triangles = mesh->index_count / 3;
    f->point = model_zeros(mesh->vertex_count, sizeof *f->point);
    f->opposite = model_zeros(mesh->index_count, sizeof *f->opposite);
    f->hand = model_zeros(f->triangles, sizeof *f->hand);
    f->flat = model_zeros(f->triangles, sizeof *f->flat);
    out->vertex_group = model_zeros(mesh->vertex_count, sizeof *out->vertex_group);
    out->corner_group = model_zeros(mesh->index_count, sizeof *out->corner_group);
    out->hand = model_zeros((size_t)mesh->vertex_count + mesh->index_count, sizeof *out->hand);
    if (!f->point || !f->opposite || !f->hand || !f->flat || !out->vertex_group || !out->corner_group || !out->hand ||
        find_points(mesh, f->point))
        return 1;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) out->vertex_group[v] = MODEL_NONE;
    sort_triangles(f);
    if (find_opposites(f)) return 1;
    find_fans(f);
    return choose_fans(f) || complete_groups(f);
}

int tangents_build(const model_mesh *mesh, tangent_groups *out)
{
    fans f = { 0 };
    memset(out, 0, sizeof *out);
    f.mesh = mesh;
    f.out = out;
    int failed = build_fans(&f);
    if (!failed) {
        out->sum = model_zeros(out->group_count, 3 * sizeof *out->sum);
        failed = !out->sum;
    }
    free(f.point);
    free(f.opposite);
    free(f.hand);
    free(f.flat);
    if (failed) tangents_free(out);
    return failed;
}

/* ---- vertices with several fans ---- */

typedef struct splits {
    uint32_t *source, *group; /* [count] of each copy */
    uint32_t *next;           /* [vertices + count] the next copy of the same vertex, or 0 */
    uint32_t count, room;
} splits;

static int grow_splits(splits *s, uint32_t vertices)
{
    if (s->count < s->room) return 0;
    const uint32_t room = s->room ? s->room * 2 : 64;
    uint32_t *source = realloc(s->source, room * sizeof *source), *group, *next;
    if (source) s->source = source;
    group = realloc(s->group, room * sizeof *group);
    if (group) s->group = group;
    next = realloc(s->next, ((size_t)vertices + room) * sizeof *next);
    if (next) s->next = next;
    if (!source || !group || !next) return 1;
    if (!s->room) memset(next, 0, (size_t)vertices * sizeof *next);
    s->room = room;
    return 0;
}

/* The copy of a vertex for a fan, made where there is none; 0 when out of memory. */
static uint32_t copy_for(splits *s, uint32_t vertices, uint32_t vertex, uint32_t group)
{
    uint32_t last = vertex;
    if (grow_splits(s, vertices)) return 0;
    while (s->next[last]) {
        last = s->next[last];
        if (s->group[last - vertices] == group) return last;
    }
    s->source[s->count] = vertex;
    s->group[s->count] = group;
    s->next[last] = vertices + s->count;
    s->next[vertices + s->count] = 0;
    return vertices + s->count++;
}

static int find_splits(const tangent_groups *groups, model_mesh *mesh, const uint8_t *missing, splits *s)
{
    for (uint32_t c = 0; c < mesh->index_count / 3 * 3; ++c) {
        const uint32_t v = mesh->indices[c], g = groups->corner_group[c];
        if (!(missing[v] & MODEL_MISSING_TANGENT) || g == MODEL_NONE || g == groups->vertex_group[v]) continue;
        mesh->indices[c] = copy_for(s, mesh->vertex_count, v, g);
        if (!mesh->indices[c]) return 1;
    }
    return 0;
}

int tangents_split(tangent_groups *groups, model_mesh *mesh, const uint8_t *missing, uint32_t **sources,
                   uint32_t *count)
{
    splits s = { 0 };
    const uint32_t vertices = mesh->vertex_count;
    uint32_t *grown;
    int failed = find_splits(groups, mesh, missing, &s);
    if (!failed && s.count) {
        failed = model_copy_vertices(mesh, s.source, s.count);
        grown = failed ? NULL
                       : realloc(groups->vertex_group, ((size_t)vertices + s.count) * sizeof *groups->vertex_group);
        failed = !grown;
        if (grown) {
            groups->vertex_group = grown;
            memcpy(grown + vertices, s.group, s.count * sizeof *grown);
        }
    }
    *sources = s.source;
    *count = failed ? 0 : s.count;
    free(s.group);
    free(s.next);
    return failed;
}

/* ---- sums ---- */

static int wanted(const uint8_t *touched, uint32_t group)
{
    return !touched || (group != MODEL_NONE && touched[group]);
}

static void add_corners(tangent_groups *groups, const pose *p, const uint32_t *v, const uint32_t *corners,
                        const uint8_t *touched)
{
    face_tangent f;
    face_tangent_evaluate(p, v, &f);
    for (size_t k = 0; f.hand && k < 3; ++k) {
        const uint32_t g = corners[k];
        double add[3];
        if (g == MODEL_NONE || !wanted(touched, g) || groups->hand[g] != f.hand ||
            corner_tangent(p, &f, v, k, add) == 0.0)
            continue;
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
        const uint32_t *v = mesh->indices + c, *group = groups->corner_group + c;
        if (wanted(touched, group[0]) || wanted(touched, group[1]) || wanted(touched, group[2]))
            add_corners(groups, &p, v, group, touched);
    }
}

void tangents_free(tangent_groups *groups)
{
    free(groups->corner_group);
    free(groups->vertex_group);
    free(groups->sum);
    free(groups->hand);
    memset(groups, 0, sizeof *groups);
}
