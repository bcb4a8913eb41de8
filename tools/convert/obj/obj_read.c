#include "obj_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/input_file.h"
#include "convert/model/model_build.h"
#include "convert/model/size_guess.h"

/* Vertices while corners become them: a corner that was met in the same part before is the same vertex. */
typedef struct vertices {
    obj_corner *corners; /* [count] */
    uint32_t *slots;     /* [slot_count] a hash table of vertices, MODEL_NONE where empty */
    uint32_t count, first, slot_count;
} vertices;

/* ---- corners to vertices ---- */

static uint32_t hash_of(const obj_corner *c)
{
    uint32_t h = c->position * 0x9e3779b1u ^ c->uv * 0x85ebca6bu ^ c->normal * 0xc2b2ae35u;
    h ^= h >> 15;
    return h * 0x2c1b3c6du;
}

static uint32_t vertex_of(vertices *v, const obj_corner *c)
{
    uint32_t slot = hash_of(c) & (v->slot_count - 1u);
    for (; v->slots[slot] != MODEL_NONE; slot = (slot + 1u) & (v->slot_count - 1u)) {
        if (memcmp(&v->corners[v->slots[slot]], c, sizeof *c) == 0) return v->slots[slot];
    }
    v->slots[slot] = v->count;
    v->corners[v->count] = *c;
    return v->count++;
}

static uint32_t corner_count(const obj_part *part)
{
    return (uint32_t)(part->corners.count / sizeof(obj_corner));
}

static int start_vertices(const obj_text *o, vertices *v, uint64_t *corners)
{
    memset(v, 0, sizeof *v);
    *corners = 0;
    for (uint32_t i = 0; i < obj_part_count(o); i++) *corners += corner_count(obj_part_at(o, i));
    if (*corners >= 0x40000000u) return 1;
    v->slot_count = 16;
    while (v->slot_count < *corners * 2u) v->slot_count *= 2u;
    v->corners = model_zeros((size_t)*corners, sizeof *v->corners);
    v->slots = malloc(v->slot_count * sizeof *v->slots);
    return !v->corners || !v->slots;
}

static void forget_slots(vertices *v)
{
    memset(v->slots, 0xff, v->slot_count * sizeof *v->slots);
}

/* Indices and submeshes; materials come from the parts with a name, in order. */
static int index_parts(const obj_text *o, vertices *v, uint64_t corners, model_mesh *mesh)
{
    uint32_t material = 0, at = 0;
    mesh->submesh_count = obj_part_count(o);
    mesh->index_count = (uint32_t)corners;
    mesh->submeshes = model_zeros(mesh->submesh_count, sizeof *mesh->submeshes);
    mesh->indices = model_zeros(mesh->index_count, sizeof *mesh->indices);
    if (!mesh->submeshes || !mesh->indices) return 1;
    for (uint32_t i = 0; i < mesh->submesh_count; i++) {
        const obj_part *part = obj_part_at(o, i);
        const obj_corner *c = (const obj_corner *)(const void *)part->corners.bytes;
        model_submesh *sub = &mesh->submeshes[i];
        forget_slots(v);
        sub->first_index = at;
        sub->first_vertex = v->count;
        sub->index_count = corner_count(part);
        sub->material = part->material ? material++ : MODEL_NONE;
        for (uint32_t k = 0; k < sub->index_count; k++) mesh->indices[at++] = vertex_of(v, &c[k]);
        sub->vertex_count = v->count - sub->first_vertex;
    }
    mesh->vertex_count = v->count;
    return 0;
}

/* ---- arrays ---- */

static void fill_vertex(const obj_text *o, const obj_corner *c, double scale, uint32_t vertex, model_mesh *mesh)
{
    const float *p = (const float *)(const void *)o->positions.bytes + (size_t)c->position * 3;
    for (size_t k = 0; k < 3; k++) mesh->position[(size_t)vertex * 3 + k] = (float)((double)p[k] * scale);
    if (c->normal != MODEL_NONE) {
        memcpy(mesh->normal + (size_t)vertex * 3, (const float *)(const void *)o->normals.bytes + (size_t)c->normal * 3,
               3 * sizeof(float));
    }
    for (size_t k = 0; k < 4 && mesh->color; k++) {
        const float *color = (const float *)(const void *)o->colors.bytes + (size_t)c->position * 3;
        mesh->color[(size_t)vertex * 4 + k] = k < 3 ? color[k] : 1.0f;
    }
    if (mesh->uv && c->uv != MODEL_NONE) {
        memcpy(mesh->uv + (size_t)vertex * 2, (const float *)(const void *)o->uvs.bytes + (size_t)c->uv * 2,
               2 * sizeof(float));
    }
}

/* A submesh with a corner without a normal has all of its normals computed. */
static void mark_missing(const vertices *v, model_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->submesh_count; i++) {
        model_submesh *sub = &mesh->submeshes[i];
        sub->missing = mesh->tangent ? MODEL_MISSING_TANGENT : 0;
        for (uint32_t k = 0; k < sub->vertex_count; k++) {
            if (v->corners[sub->first_vertex + k].normal == MODEL_NONE) sub->missing |= MODEL_MISSING_NORMAL;
        }
    }
}

static int fill_vertices(const obj_text *o, const vertices *v, double scale, model_mesh *mesh)
{
    const size_t count = mesh->vertex_count;
    int uvs = 0;
    for (size_t i = 0; i < count; i++) uvs = uvs || v->corners[i].uv != MODEL_NONE;
    mesh->position = model_zeros(count * 3, sizeof(float));
    mesh->normal = model_zeros(count * 3, sizeof(float));
    mesh->uv = uvs ? model_zeros(count * 2, sizeof(float)) : NULL;
    mesh->tangent = uvs ? model_zeros(count * 4, sizeof(float)) : NULL;
    mesh->color = o->has_colors ? model_zeros(count * 4, sizeof(float)) : NULL;
    if (!mesh->position || !mesh->normal || (uvs && (!mesh->uv || !mesh->tangent)) || (o->has_colors && !mesh->color)) {
        return 1;
    }
    for (uint32_t i = 0; i < mesh->vertex_count; i++) fill_vertex(o, &v->corners[i], scale, i, mesh);
    mark_missing(v, mesh);
    return 0;
}

/* ---- the model ---- */

/* One node that draws the mesh, both named after the file. */
static int add_mesh(const char *path, model *m)
{
    m->meshes = model_zeros(1, sizeof *m->meshes);
    m->nodes = model_zeros(1, sizeof *m->nodes);
    if (!m->meshes || !m->nodes) return 1;
    m->mesh_count = m->node_count = 1;
    m->meshes[0].name = input_stem(path);
    m->nodes[0].name = input_stem(path);
    m->nodes[0].parent = m->nodes[0].skin = MODEL_NONE;
    m->nodes[0].rotation[3] = 1.0f;
    for (int i = 0; i < 3; i++) m->nodes[0].scale[i] = 1.0f;
    for (int i = 0; i < 4; i++) m->nodes[0].world[i * 5] = 1.0;
    return !m->meshes[0].name || !m->nodes[0].name;
}

/* The format has no unit: the distance of the eyes tells it, if there are any. */
static int take_unit(model *m, double *unit_cm)
{
    const double metres = size_unit(m);
    model_mesh *mesh = &m->meshes[0];
    if (metres == 1.0) return 0;
    for (size_t i = 0; i < 3 * (size_t)mesh->vertex_count; i++) mesh->position[i] *= (float)metres;
    *unit_cm *= metres;
    return model_warn(m, "by the distance of its eyes, a unit of the model is %g cm (--unit-cm CM: another)", *unit_cm);
}

/* The format has no unit: a size that no character has is a sign that it is not the one that was taken. */
static int warn_of_size(const model_mesh *mesh, double unit_cm, model *m)
{
    double size = 0.0;
    for (int c = 0; c < 3; c++) {
        float low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < mesh->vertex_count; i++) {
            low = fminf(low, mesh->position[i * 3 + (size_t)c]);
            high = fmaxf(high, mesh->position[i * 3 + (size_t)c]);
        }
        size = fmax(size, (double)high - (double)low);
    }
    if (size >= 0.05 && size <= 5.0) return 0;
    return model_warn(m, "the model is %.3g m large with a unit of %g cm; to change the unit, use --unit-cm CM", size,
                      unit_cm);
}

static int warn_of_losses(const obj_text *o, model *m)
{
    if (o->bad_line_count &&
        model_warn(m, "%s: %s; %u lines were left out", o->bad_line.where, o->bad_line.what, o->bad_line_count))
        return 1;
    return o->left_out_count &&
           model_warn(m, "line %u: '%s' was left out, and %u more lines of points, lines or curves", o->left_out_line,
                      o->left_out, o->left_out_count - 1u);
}

static int fill_model(const char *path, const obj_text *o, vertices *v, const obj_options *options, model *m,
                      model_error *error)
{
    double unit_cm = options->unit_cm > 0.0 ? options->unit_cm : 100.0;
    model_mesh *mesh;
    uint32_t *source;
    uint64_t corners;
    int failed;
    if (start_vertices(o, v, &corners) || add_mesh(path, m)) return model_fail_memory(error);
    mesh = &m->meshes[0];
    if (index_parts(o, v, corners, mesh) || fill_vertices(o, v, unit_cm / 100.0, mesh) ||
        obj_materials_read(path, o, m) || (options->unit_cm <= 0.0 && take_unit(m, &unit_cm)) ||
        warn_of_size(mesh, unit_cm, m) || warn_of_losses(o, m)) {
        return model_fail_memory(error);
    }
    if (!options->targets) return 0;
    source = model_zeros(mesh->vertex_count, sizeof *source);
    if (!source) return model_fail_memory(error);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) source[i] = v->corners[i].position;
    failed = obj_targets_read(options->targets, path, o, source, unit_cm / 100.0, m, error);
    free(source);
    return failed;
}

int obj_read(const char *path, const obj_options *options, model **out, model_error *error)
{
    obj_text o;
    vertices v = { NULL, NULL, 0, 0, 0 };
    model *m = model_new();
    int failed = obj_text_read(path, 0, &o, error);
    *out = NULL;
    if (!failed) failed = m ? fill_model(path, &o, &v, options, m, error) : model_fail_memory(error);
    if (!failed) failed = model_complete(m, error);
    obj_text_free(&o);
    free(v.corners);
    free(v.slots);
    if (failed) {
        model_free(m);
        return 1;
    }
    *out = m;
    return 0;
}
