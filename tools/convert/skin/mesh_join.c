#include "mesh_join.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/affine.h"
#include "convert/model/model_build.h"

#define EXTRA_FLOATS ((size_t)NOH_EXTRAS_MAX * 4u)

/* The transform from a part to the joined mesh. */
typedef struct turn {
    double place[16], normal[9]; /* normal: the cofactors, with the sign that keeps normals outward */
    float hand;                  /* -1: it mirrors */
} turn;

static void make_turn(const mesh_part *part, turn *t)
{
    memcpy(t->place, part->place, sizeof t->place);
    affine_cofactors(part->place, t->normal);
    t->hand = affine_determinant(part->place) < 0.0 ? -1.0f : 1.0f;
    for (int i = 0; i < 9; i++) {
        t->normal[i] *= (double)t->hand;
    }
}

/* m[3 columns][stride] times a vector. */
static void turn_vector(const double *m, int stride, const float *v, double *out)
{
    for (int r = 0; r < 3; r++) {
        out[r] = m[r] * (double)v[0] + m[stride + r] * (double)v[1] + m[2 * stride + r] * (double)v[2];
    }
}

static double length_of(const double *v)
{
    return sqrt(vec_dot(v, v));
}

static void store(const double *v, double factor, float *out)
{
    for (int i = 0; i < 3; i++) {
        out[i] = (float)(v[i] * factor);
    }
}

/* ---- vertices ---- */

static void join_frame(const model_mesh *from, size_t v, const turn *t, model_mesh *out, size_t to)
{
    double turned[3], unit[3];
    turn_vector(t->normal, 3, from->normal + 3 * v, turned);
    store(turned, vec_normalize(turned) ? 1.0 : 0.0, out->normal + 3 * to);
    if (!out->tangent) {
        return;
    }
    out->tangent[4 * to + 3] = t->hand;
    if (from->tangent) {
        turn_vector(t->place, 4, from->tangent + 4 * v, unit);
        out->tangent[4 * to + 3] *= from->tangent[4 * v + 3];
    }
    if (!from->tangent || !vec_normalize(unit)) {
        vec_any_perpendicular(turned, unit);
    }
    store(unit, 1.0, out->tangent + 4 * to);
}

static void join_influences(const mesh_part *part, size_t v, model_mesh *out, size_t to)
{
    uint16_t *joints = out->joints + to * MODEL_INFLUENCES_MAX;
    float *weights = out->joint_weights + to * MODEL_INFLUENCES_MAX;
    if (!part->places) {
        joints[0] = (uint16_t)part->place_rigid;
        weights[0] = 1.0f;
        return;
    }
    memcpy(weights, part->mesh->joint_weights + v * MODEL_INFLUENCES_MAX, MODEL_INFLUENCES_MAX * sizeof *weights);
    for (uint32_t i = 0; i < MODEL_INFLUENCES_MAX; i++) {
        joints[i] = weights[i] > 0.0f ? (uint16_t)part->places[part->mesh->joints[v * MODEL_INFLUENCES_MAX + i]]
                                      : joints[0];
    }
}

static void join_vertex(const mesh_part *part, size_t v, const turn *t, model_mesh *out, size_t to)
{
    const model_mesh *from = part->mesh;
    double turned[3];
    turn_vector(t->place, 4, from->position + 3 * v, turned);
    for (int i = 0; i < 3; i++) {
        out->position[3 * to + (size_t)i] = (float)(turned[i] + t->place[12 + i]);
    }
    join_frame(from, v, t, out, to);
    for (size_t i = 0; out->uv && from->uv && i < 2; i++) {
        out->uv[2 * to + i] = from->uv[2 * v + i];
    }
    for (size_t i = 0; out->color && i < 4; i++) {
        out->color[4 * to + i] = from->color ? from->color[4 * v + i] : 1.0f;
    }
    if (out->extra && from->extra) {
        memcpy(out->extra + EXTRA_FLOATS * to, from->extra + EXTRA_FLOATS * v, EXTRA_FLOATS * sizeof *out->extra);
    }
    join_influences(part, v, out, to);
}

/* Deltas are transformed like the values they are added to; a normal's delta is also scaled like its normal. */
static void join_target(const model_mesh *from, const model_target *target, size_t v, const turn *t, model_target *out,
                        size_t to)
{
    double turned[3], base[3], length;
    turn_vector(t->place, 4, target->position + 3 * v, turned);
    store(turned, 1.0, out->position + 3 * to);
    turn_vector(t->normal, 3, from->normal + 3 * v, base);
    turn_vector(t->normal, 3, target->normal + 3 * v, turned);
    length = length_of(base);
    store(turned, length > 0.0 ? 1.0 / length : 0.0, out->normal + 3 * to);
    if (out->uv && target->uv) memcpy(out->uv + 2 * to, target->uv + 2 * v, 2 * sizeof *out->uv);
    if (out->tangent && target->tangent) {
        turn_vector(t->place, 4, from->tangent + 4 * v, base);
        turn_vector(t->place, 4, target->tangent + 3 * v, turned);
        length = length_of(base);
        store(turned, length > 0.0 ? 1.0 / length : 0.0, out->tangent + 3 * to);
    }
}

/* ---- triangles ---- */

/* The submesh of a material, added if there is none. */
static model_submesh *submesh_of(model_mesh *out, uint32_t material)
{
    uint32_t s = 0;
    while (s < out->submesh_count && out->submeshes[s].material != material) {
        s++;
    }
    if (s == out->submesh_count) {
        out->submeshes[out->submesh_count++].material = material;
    }
    return &out->submeshes[s];
}

static void list_submeshes(const mesh_part *parts, uint32_t part_count, model_mesh *out)
{
    uint32_t first = 0;
    for (uint32_t p = 0; p < part_count; p++) {
        for (uint32_t s = 0; s < parts[p].mesh->submesh_count; s++) {
            submesh_of(out, parts[p].mesh->submeshes[s].material)->index_count +=
                parts[p].mesh->submeshes[s].index_count;
        }
    }
    for (uint32_t s = 0; s < out->submesh_count; s++) {
        out->submeshes[s].first_index = first;
        out->submeshes[s].vertex_count = out->vertex_count;
        first += out->submeshes[s].index_count;
        out->submeshes[s].index_count = 0;
    }
}

static void join_triangles(const model_mesh *from, float hand, uint32_t first_vertex, model_mesh *out)
{
    for (uint32_t s = 0; s < from->submesh_count; s++) {
        const model_submesh *sub = &from->submeshes[s];
        model_submesh *to = submesh_of(out, sub->material);
        for (uint32_t i = 0; i < sub->index_count; i++) {
            uint32_t turned = hand < 0.0f && i % 3 ? i - i % 3 + 3 - i % 3 : i;
            out->indices[to->first_index + to->index_count++] = from->indices[sub->first_index + turned] + first_vertex;
        }
    }
}

/* ---- all of it ---- */

static int allocate_targets(const model_mesh *from, model_mesh *out)
{
    out->targets = model_zeros(from->target_count, sizeof *out->targets);
    out->weights = model_zeros(from->target_count, sizeof *out->weights);
    out->target_count = out->targets ? from->target_count : 0;
    for (uint32_t i = 0; i < out->target_count; i++) {
        model_target *to = &out->targets[i];
        to->name = model_string(from->targets[i].name);
        to->position = model_zeros((size_t)out->vertex_count * 3, sizeof *to->position);
        to->normal = model_zeros((size_t)out->vertex_count * 3, sizeof *to->normal);
        to->tangent = out->tangent ? model_zeros((size_t)out->vertex_count * 3, sizeof *to->tangent) : NULL;
        to->has_position = to->has_normal = to->has_tangent = 1;
        if (from->targets[i].uv) to->uv = model_zeros((size_t)out->vertex_count * 2, sizeof *to->uv);
        if (!to->name || !to->position || !to->normal || (out->tangent && !to->tangent) ||
            (from->targets[i].uv && !to->uv)) {
            return 1;
        }
    }
    if (!out->targets || !out->weights) {
        return 1;
    }
    for (uint32_t i = 0; i < from->target_count; i++) {
        out->weights[i] = from->weights[i];
    }
    return 0;
}

/* An extra attribute that parts have in several ways is floats. */
static void join_extras(const model_extra *part, model_extra *out)
{
    for (uint32_t k = 0; k < NOH_EXTRAS_MAX; k++) {
        const model_extra *from = &part[k];
        model_extra *to = &out[k];
        if (from->width && to->width &&
            (from->bits != to->bits || from->least != to->least || from->step != to->step)) {
            *to = (model_extra){ to->width > from->width ? to->width : from->width, 0, 0.0f, 0.0f };
        } else if (from->width > to->width) {
            *to = *from;
        }
    }
}

static int allocate(const mesh_part *parts, uint32_t part_count, model_mesh *out)
{
    const model_mesh *morphed = parts[0].mesh;
    size_t submeshes = 0;
    int tangent = 0, uv = 0, color = 0, extra = 0;
    for (uint32_t p = 0; p < part_count; p++) {
        const model_mesh *m = parts[p].mesh;
        out->vertex_count += m->vertex_count;
        out->index_count += m->index_count;
        submeshes += m->submesh_count;
        tangent |= m->tangent != NULL;
        uv |= m->uv != NULL;
        color |= m->color != NULL;
        extra |= m->extra != NULL;
        join_extras(m->extras, out->extras);
        morphed = m->target_count ? m : morphed;
    }
    out->position = model_zeros((size_t)out->vertex_count * 3, sizeof *out->position);
    out->normal = model_zeros((size_t)out->vertex_count * 3, sizeof *out->normal);
    out->tangent = tangent ? model_zeros((size_t)out->vertex_count * 4, sizeof *out->tangent) : NULL;
    out->uv = uv ? model_zeros((size_t)out->vertex_count * 2, sizeof *out->uv) : NULL;
    out->color = color ? model_zeros((size_t)out->vertex_count * 4, sizeof *out->color) : NULL;
    out->extra = extra ? model_zeros(out->vertex_count * EXTRA_FLOATS, sizeof *out->extra) : NULL;
    out->joints = model_zeros((size_t)out->vertex_count * MODEL_INFLUENCES_MAX, sizeof *out->joints);
    out->joint_weights = model_zeros((size_t)out->vertex_count * MODEL_INFLUENCES_MAX, sizeof *out->joint_weights);
    out->indices = model_zeros(out->index_count, sizeof *out->indices);
    out->submeshes = model_zeros(submeshes, sizeof *out->submeshes);
    return !out->position || !out->normal || (tangent && !out->tangent) || (uv && !out->uv) || (color && !out->color) ||
           (extra && !out->extra) || !out->joints || !out->joint_weights || !out->indices || !out->submeshes ||
           allocate_targets(morphed, out);
}

static void join_part(const mesh_part *part, uint32_t first_vertex, model_mesh *out)
{
    const model_mesh *from = part->mesh;
    uint32_t influences = part->places ? from->influence_max : 1;
    turn t;
    make_turn(part, &t);
    for (uint32_t v = 0; v < from->vertex_count; v++) {
        join_vertex(part, v, &t, out, (size_t)first_vertex + v);
        for (uint32_t i = 0; i < from->target_count; i++) {
            join_target(from, &from->targets[i], v, &t, &out->targets[i], (size_t)first_vertex + v);
        }
    }
    join_triangles(from, t.hand, first_vertex, out);
    out->influence_max = influences > out->influence_max ? influences : out->influence_max;
}

int mesh_join(const mesh_part *parts, uint32_t part_count, model_mesh *out)
{
    uint32_t first_vertex = 0;
    memset(out, 0, sizeof *out);
    if (allocate(parts, part_count, out)) {
        return 1; /* freed with the model that it is in */
    }
    list_submeshes(parts, part_count, out);
    for (uint32_t p = 0; p < part_count; p++) {
        join_part(&parts[p], first_vertex, out);
        first_vertex += parts[p].mesh->vertex_count;
    }
    for (size_t i = 0; i < (size_t)out->vertex_count * MODEL_INFLUENCES_MAX; i++) {
        out->joint_limit = out->joints[i] >= out->joint_limit ? out->joints[i] + 1u : out->joint_limit;
    }
    return 0;
}

/* ---- copies ---- */

static void *duplicate(const void *from, size_t count, size_t element_size, int *failed)
{
    void *copy = from ? model_zeros(count, element_size) : NULL;
    if (copy && count) {
        memcpy(copy, from, count * element_size);
    }
    *failed |= from && !copy;
    return copy;
}

static void copy_target(const model_target *from, const model_mesh *mesh, model_target *out, int *failed)
{
    size_t vectors = (size_t)mesh->vertex_count * 3;
    *out = *from;
    out->name = duplicate(from->name, strlen(from->name) + 1, 1, failed);
    out->position = duplicate(from->position, vectors, sizeof *from->position, failed);
    out->normal = duplicate(from->normal, vectors, sizeof *from->normal, failed);
    out->tangent = duplicate(from->tangent, vectors, sizeof *from->tangent, failed);
    out->uv = duplicate(from->uv, (size_t)mesh->vertex_count * 2, sizeof *from->uv, failed);
    out->missing = duplicate(from->missing, mesh->submesh_count, 1, failed);
}

int mesh_copy(const model_mesh *mesh, model_mesh *out)
{
    size_t vertices = mesh->vertex_count, influences = vertices * MODEL_INFLUENCES_MAX;
    int failed = 0;
    *out = *mesh;
    out->name = duplicate(mesh->name, strlen(mesh->name) + 1, 1, &failed);
    out->position = duplicate(mesh->position, vertices * 3, sizeof *mesh->position, &failed);
    out->normal = duplicate(mesh->normal, vertices * 3, sizeof *mesh->normal, &failed);
    out->tangent = duplicate(mesh->tangent, vertices * 4, sizeof *mesh->tangent, &failed);
    out->uv = duplicate(mesh->uv, vertices * 2, sizeof *mesh->uv, &failed);
    out->color = duplicate(mesh->color, vertices * 4, sizeof *mesh->color, &failed);
    out->extra = duplicate(mesh->extra, vertices * EXTRA_FLOATS, sizeof *mesh->extra, &failed);
    out->joints = duplicate(mesh->joints, influences, sizeof *mesh->joints, &failed);
    out->joint_weights = duplicate(mesh->joint_weights, influences, sizeof *mesh->joint_weights, &failed);
    out->indices = duplicate(mesh->indices, mesh->index_count, sizeof *mesh->indices, &failed);
    out->submeshes = duplicate(mesh->submeshes, mesh->submesh_count, sizeof *mesh->submeshes, &failed);
    out->weights = duplicate(mesh->weights, mesh->target_count, sizeof *mesh->weights, &failed);
    out->targets = model_zeros(mesh->target_count, sizeof *out->targets);
    failed |= !out->targets;
    for (uint32_t i = 0; out->targets && i < mesh->target_count; i++) {
        copy_target(&mesh->targets[i], mesh, &out->targets[i], &failed);
    }
    return failed;
}
