#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/clips/model_clips.h"
#include "convert/model/model_build.h"
#include "convert/pack/pack_clips.h"

/* ---- models ---- */

static void unit3(float v[3])
{
    float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) {
        v[i] /= length;
    }
}

static void fill_vertex(model_mesh *m, uint32_t v, uint32_t side, test_random *r)
{
    float n[3] = { test_random_float(r, -1.0f, 1.0f), test_random_float(r, -1.0f, 1.0f),
                   test_random_float(r, 0.1f, 1.0f) };
    unit3(n);
    m->position[3 * v] = (float)(v % side);
    m->position[3 * v + 1] = (float)(v / side);
    m->position[3 * v + 2] = test_random_float(r, -0.2f, 0.2f);
    memcpy(m->normal + 3 * v, n, sizeof n);
    if (m->tangent) {
        float t[3] = { n[2], 0.0f, -n[0] }; /* at a right angle to the normal */
        unit3(t);
        memcpy(m->tangent + 4 * v, t, sizeof t);
        m->tangent[4 * v + 3] = v % 3 ? 1.0f : -1.0f;
    }
    for (uint32_t i = 0; m->uv && i < 2; i++) {
        m->uv[2 * v + i] = test_random_float(r, -0.5f, 1.5f);
    }
    for (uint32_t i = 0; m->color && i < 4; i++) {
        m->color[4 * v + i] = test_random_float(r, 0.0f, 1.0f);
    }
}

/* A bump that fades to its rim, of a random place and size; the last corner always moves, so
 * that every mesh has its highest touched texel in use. */
static void fill_target(model_mesh *m, model_target *t, uint32_t side, test_random *r)
{
    float cx = test_random_float(r, 0.0f, (float)side), cy = test_random_float(r, 0.0f, (float)side);
    float radius = test_random_float(r, 0.2f, 0.6f) * (float)side + 1.0f;
    t->has_position = t->has_normal = 1;
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        float x = m->position[3 * v] - cx, y = m->position[3 * v + 1] - cy;
        float d = 1.0f - (x * x + y * y) / (radius * radius);
        for (uint32_t i = 0; i < 3 && d > 0.0f; i++) {
            t->position[3 * v + i] = 0.1f * d * test_random_float(r, -1.0f, 1.0f);
            t->normal[3 * v + i] = 0.2f * d * test_random_float(r, -1.0f, 1.0f);
            if (t->tangent) {
                t->tangent[3 * v + i] = 0.2f * d * test_random_float(r, -1.0f, 1.0f);
            }
        }
    }
}

static void fill_targets(model_mesh *m, uint32_t side, test_random *r)
{
    static const char *const names[] = { "smile", "blink" };
    m->targets = test_zeros(sizeof *m->targets * m->target_count);
    m->weights = test_zeros(sizeof *m->weights * m->target_count);
    for (uint32_t t = 0; t < m->target_count; t++) {
        model_target *target = &m->targets[t];
        char name[32];
        snprintf(name, sizeof name, "target_%u", (unsigned)t);
        target->name = model_string(t < 2 ? names[t] : name);
        target->position = test_zeros(12u * (size_t)m->vertex_count);
        target->normal = test_zeros(12u * (size_t)m->vertex_count);
        target->tangent = m->tangent ? test_zeros(12u * (size_t)m->vertex_count) : NULL;
        m->weights[t] = t % 2 ? 0.25f : 0.0f;
        fill_target(m, target, side, r);
    }
}

static void fill_indices(model_mesh *m, uint32_t side)
{
    uint32_t *to;
    m->index_count = 6u * (side - 1u) * (side - 1u);
    to = m->indices = test_zeros(4u * (size_t)m->index_count);
    for (uint32_t y = 0; y + 1 < side; y++) {
        for (uint32_t x = 0; x + 1 < side; x++) {
            uint32_t v = y * side + x;
            const uint32_t quad[6] = { v, v + 1, v + side, v + side, v + 1, v + side + 1 };
            memcpy(to, quad, sizeof quad);
            to += 6;
        }
    }
}

static void fill_submeshes(model_mesh *m, uint32_t flags)
{
    uint32_t half = m->index_count / 6u * 3u;
    m->submesh_count = flags & TEST_SCENE ? 2 : 1;
    m->submeshes = test_zeros(sizeof *m->submeshes * m->submesh_count);
    for (uint32_t s = 0; s < m->submesh_count; s++) {
        model_submesh *sub = &m->submeshes[s];
        sub->first_index = s ? half : 0;
        sub->index_count = m->submesh_count == 1 ? m->index_count : s ? m->index_count - half : half;
        sub->material = flags & TEST_SCENE ? s : MODEL_NONE;
        sub->vertex_count = s ? 0 : m->vertex_count; /* the second shares the first one's */
    }
}

static void fill_mesh(model_mesh *m, const test_model_desc *desc, uint32_t index, test_random *r)
{
    uint32_t side = (desc->side ? desc->side : 5u) + 6u * index;
    char name[32];
    snprintf(name, sizeof name, "grid_%u", (unsigned)index);
    m->name = model_string(name);
    m->vertex_count = side * side;
    m->target_count = desc->targets;
    m->position = test_zeros(12u * (size_t)m->vertex_count);
    m->normal = test_zeros(12u * (size_t)m->vertex_count);
    m->tangent = desc->flags & TEST_TANGENTS ? test_zeros(16u * (size_t)m->vertex_count) : NULL;
    m->uv = desc->flags & TEST_UVS ? test_zeros(8u * (size_t)m->vertex_count) : NULL;
    m->color = desc->flags & TEST_COLORS ? test_zeros(16u * (size_t)m->vertex_count) : NULL;
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        fill_vertex(m, v, side, r);
    }
    fill_indices(m, side);
    fill_submeshes(m, desc->flags);
    fill_targets(m, side, r);
}

static void fill_materials(model *m)
{
    m->texture_count = 1;
    m->textures = test_zeros(sizeof *m->textures);
    m->textures[0].name = model_string("checks");
    m->textures[0].width = m->textures[0].height = 2;
    m->textures[0].rgba = test_zeros(16);
    memset(m->textures[0].rgba, 0xc3, 8);
    m->textures[0].wrap_s = 33071;
    m->material_count = 2;
    m->materials = test_zeros(sizeof *m->materials * 2);
    for (uint32_t i = 0; i < 2; i++) {
        model_material *to = &m->materials[i];
        *to = model_material_default();
        to->name = model_string(i ? "glass" : "skin");
        to->base_color[0] = to->base_color[3] = 1.0f;
        to->base_color_texture = i ? MODEL_NONE : 0;
        to->alpha = i ? MODEL_ALPHA_BLEND : MODEL_ALPHA_OPAQUE;
        to->roughness = 0.5f;
    }
}

static void fill_identity(model_node *n, uint32_t parent, uint32_t mesh, const char *name)
{
    n->name = model_string(name);
    n->parent = parent;
    n->mesh = mesh;
    n->skin = MODEL_NONE;
    n->rotation[3] = 1.0f;
    for (int i = 0; i < 4; i++) {
        n->world[5 * i] = 1.0;
        if (i < 3) {
            n->scale[i] = 1.0f;
        }
    }
}

/* A root, then a node for each mesh; the first of those has weights of its own. */
static void fill_nodes(model *m)
{
    m->node_count = 1 + m->mesh_count;
    m->nodes = test_zeros(sizeof *m->nodes * m->node_count);
    fill_identity(&m->nodes[0], MODEL_NONE, MODEL_NONE, "root");
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        fill_identity(&m->nodes[1 + i], 0, i, m->meshes[i].name);
        if (i == 0 && m->meshes[0].target_count) {
            m->nodes[1].weights = test_zeros(4u * (size_t)m->meshes[0].target_count);
            m->nodes[1].weights[0] = 0.5f;
        }
    }
}

#define TEST_KEYS 4u

static void fill_channel(model_channel *c, model_interpolation interpolation, uint32_t width, test_random *r)
{
    uint32_t values = width * (interpolation == MODEL_CUBICSPLINE ? 3u : 1u);
    c->node = 1;
    c->path = MODEL_PATH_WEIGHTS;
    c->interpolation = interpolation;
    c->key_count = TEST_KEYS;
    c->width = width;
    c->times = test_zeros(4u * TEST_KEYS);
    c->values = test_zeros(4u * (size_t)TEST_KEYS * values);
    for (uint32_t k = 0; k < TEST_KEYS; k++) {
        c->times[k] = (k ? c->times[k - 1] : 0.0f) + test_random_float(r, 0.1f, 0.8f);
    }
    for (uint32_t i = 0; i < TEST_KEYS * values; i++) {
        c->values[i] = test_random_float(r, -1.0f, 2.0f);
    }
}

static void fill_clips(model *m, test_random *r)
{
    static const char *const names[] = { "linear", "step", "cubic" };
    m->clip_count = m->meshes[0].target_count ? 3 : 0;
    m->clips = test_zeros(sizeof *m->clips * 3);
    for (uint32_t i = 0; i < m->clip_count; i++) {
        model_clip *c = &m->clips[i];
        c->name = model_string(names[i]);
        c->channel_count = 1;
        c->channels = test_zeros(sizeof *c->channels);
        fill_channel(c->channels, (model_interpolation)i, m->meshes[0].target_count, r);
        c->duration_s = c->channels->times[TEST_KEYS - 1];
    }
}

model *test_model(const test_model_desc *desc)
{
    test_random r = { desc->seed * 0x9e3779b97f4a7c15ull + 1 };
    model *m = model_new();
    assert_non_null(m);
    m->mesh_count = desc->meshes ? desc->meshes : 1;
    m->meshes = test_zeros(sizeof *m->meshes * m->mesh_count);
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        fill_mesh(&m->meshes[i], desc, i, &r);
    }
    if (desc->flags & TEST_SCENE) {
        fill_materials(m);
        fill_nodes(m);
        fill_clips(m, &r);
    }
    return m;
}

/* ---- packs ---- */

static void encode_clip(model *m, model_clips **made, encoded_clips *encoded)
{
    model_error error;
    clips_settings settings;
    memset(&settings, 0, sizeof settings);
    if (clips_from_model(m, NULL, made, &error) ||
        clips_encode((*made)->sets, (*made)->set_count, &settings, encoded, &error)) {
        fail_msg("%s (%s)", error.what, error.where);
    }
}

uint8_t *test_pack_of(model *m, size_t *count, uint32_t **orders)
{
    morph_encoding **encodings = test_zeros(sizeof *encodings * m->mesh_count);
    morph_options options = { 0 };
    byte_buffer out = { NULL, 0, 0, 0 };
    model_clips *made = NULL;
    encoded_clips encoded;
    model_error error;
    uint8_t *bytes;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        assert_int_equal(morph_encode(&m->meshes[i], &options, &encodings[i], &error), 0);
        if (orders) {
            orders[i] = test_zeros(4u * (size_t)m->meshes[i].vertex_count);
            memcpy(orders[i], encodings[i]->order, 4u * (size_t)m->meshes[i].vertex_count);
        }
    }
    encode_clip(m, &made, &encoded);
    if (pack_write(m, NULL, encodings, &encoded, &out, &error)) {
        fail_msg("pack_write: %s", error.what);
    }
    clips_free(&encoded);
    model_clips_free(made);
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        morph_encoding_free(encodings[i]);
    }
    free(encodings);
    bytes = test_aligned(out.bytes, out.count);
    *count = out.count;
    buffer_free(&out);
    return bytes;
}

uint8_t *test_pack(const test_model_desc *desc, size_t *count)
{
    model *m = test_model(desc);
    uint8_t *bytes = test_pack_of(m, count, NULL);
    model_free(m);
    return bytes;
}
