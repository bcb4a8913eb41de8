#include "skin_asset.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/convert.h"
#include "convert/clips/model_clips.h"
#include "convert/model/model_build.h"
#include "noh/low_core.h"

/* A mesh of the model before it is bound: which of the file's it is. */
typedef struct part {
    uint32_t node; /* of the file */
    uint32_t mesh; /* of the model */
} part;

static uint32_t file_node_of(const oracle *o, const char *name)
{
    for (uint32_t n = 0; n < oracle_node_count(o); n++) {
        const char *given = oracle_node_name(o, n);
        char made[32];
        snprintf(made, sizeof made, "node_%u", (unsigned)n);
        if (strcmp(given ? given : made, name) == 0) {
            return n;
        }
    }
    fail_msg("no node '%s'", name);
    return 0;
}

/* The primitive and vertex of a model mesh's vertex: they lie one primitive after another. */
static skin_source source_of(const oracle *o, uint32_t node, uint32_t vertex)
{
    uint32_t mesh = (uint32_t)oracle_node_mesh(o, node);
    skin_source s = { node, 0, vertex };
    while (s.vertex >= oracle_vertex_count(o, mesh, s.primitive)) {
        s.vertex -= oracle_vertex_count(o, mesh, s.primitive);
        s.primitive += 1;
    }
    return s;
}

/* Which mesh skins_bind made from which source is found by vertex counts and the order of nodes: a mesh is unchanged,
 * or joined from rigid nodes, then from skinned ones. `before` is the model's nodes before binding. */
static skin_source *sources_of(const oracle *o, const model *before, const model *after, uint32_t mesh)
{
    skin_source *out = test_zeros(sizeof *out * (after->meshes[mesh].vertex_count + 1u));
    uint32_t count = 0, drawing = 0;
    while (after->nodes[drawing].mesh != mesh) {
        drawing++;
    }
    for (int skinned = 0; skinned < 2; skinned++) {
        for (uint32_t n = 0; n < before->node_count; n++) {
            const model_node *was = &before->nodes[n];
            int joined = was->mesh != MODEL_NONE && (n == drawing || after->nodes[n].mesh == MODEL_NONE);
            uint32_t node;
            if (!joined || (was->skin != MODEL_NONE) != skinned || count == after->meshes[mesh].vertex_count) {
                continue;
            }
            node = file_node_of(o, was->name);
            for (uint32_t v = 0; v < before->meshes[was->mesh].vertex_count; v++) {
                out[count++] = source_of(o, node, v);
            }
        }
    }
    assert_int_equal(count, after->meshes[mesh].vertex_count);
    return out;
}

static uint8_t *pack_of(model *m, const skin_options *options, float error_um, int clips, size_t *count,
                        uint32_t **orders)
{
    static const skin_options none;
    model_clips *made;
    sample_options rate = { 0.0 };
    clips_settings settings;
    encoded_clips encoded;
    morph_options morph = { 0 };
    morph_encoding **encodings;
    byte_buffer out = { NULL, 0, 0, 0 };
    model_error error = { "", "" };
    uint8_t *bytes;
    memset(&settings, 0, sizeof settings);
    settings.skeletons_only = !clips;
    if (clips_from_model(m, &rate, &made, &error) || skins_bind(m, made, options ? options : &none, &error) ||
        clips_encode(made->sets, made->set_count, &settings, &encoded, &error)) {
        fail_msg("%s (%s)", error.what, error.where);
    }
    encodings = test_zeros(sizeof *encodings * (m->mesh_count + 1u));
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        morph.error_um = error_um / model_mesh_scale(m, i);
        assert_int_equal(morph_encode(&m->meshes[i], &morph, &encodings[i], &error), 0);
        if (orders) {
            orders[i] = test_zeros(sizeof **orders * m->meshes[i].vertex_count);
            memcpy(orders[i], encodings[i]->order, sizeof **orders * m->meshes[i].vertex_count);
        }
    }
    if (pack_write(m, NULL, encodings, &encoded, &out, &error)) {
        fail_msg("%s (%s)", error.what, error.where);
    }
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        morph_encoding_free(encodings[i]);
    }
    free(encodings);
    bytes = test_aligned(out.bytes, out.count);
    *count = out.count;
    buffer_free(&out);
    clips_free(&encoded);
    model_clips_free(made);
    return bytes;
}

uint8_t *skin_pack_of(model *m, const skin_options *options, float error_um, size_t *count, uint32_t **orders)
{
    return pack_of(m, options, error_um, 0, count, orders);
}

uint8_t *skin_pack_with_clips(model *m, float error_um, size_t *count)
{
    return pack_of(m, NULL, error_um, 1, count, NULL);
}

static void build(skin_asset *a, const char *path, const skin_options *options)
{
    model *before, *m;
    model_error error = { "", "" };
    uint32_t **orders;
    if (model_read_gltf(path, &before, &error) || model_read_gltf(path, &m, &error)) {
        fail_msg("%s: %s (%s)", path, error.what, error.where);
    }
    orders = test_zeros(sizeof *orders * (m->mesh_count + m->node_count + 1u));
    a->bytes = skin_pack_of(m, options, 0.1f, &a->byte_count, orders);
    a->sources = test_zeros(sizeof *a->sources * (m->mesh_count + 1u));
    a->source_count = test_zeros(sizeof *a->source_count * (m->mesh_count + 1u));
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        skin_source *from = sources_of(a->o, before, m, i);
        a->source_count[i] = m->meshes[i].vertex_count;
        a->sources[i] = test_zeros(sizeof **a->sources * m->meshes[i].vertex_count);
        for (uint32_t v = 0; v < m->meshes[i].vertex_count; v++) {
            a->sources[i][v] = from[orders[i][v]];
        }
        free(from);
        free(orders[i]);
    }
    free(orders);
    model_free(m);
    model_free(before);
}

static void measure(skin_asset *a)
{
    uint32_t nodes = oracle_node_count(a->o);
    double *locals = test_zeros(sizeof *locals * 10 * nodes), *worlds = test_zeros(sizeof *worlds * 16 * nodes);
    double low[3] = { 1e30, 1e30, 1e30 }, high[3] = { -1e30, -1e30, -1e30 };
    oracle_pose(a->o, -1, 0.0, locals);
    oracle_worlds(a->o, locals, worlds);
    for (uint32_t i = 0; i < a->pack.runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh mesh = test_mesh(&a->pack, i);
        double *weights = test_zeros(sizeof *weights * (mesh.header->target_count + 1u)),
               *out = test_zeros(sizeof *out * 3 * mesh.header->vertex_count);
        skin_asset_expected(a, i, worlds, weights, out);
        for (size_t k = 0; k < 3 * (size_t)mesh.header->vertex_count; k++) {
            low[k % 3] = fmin(low[k % 3], out[k]);
            high[k % 3] = fmax(high[k % 3], out[k]);
        }
        free(out);
        free(weights);
    }
    a->size = sqrt((high[0] - low[0]) * (high[0] - low[0]) + (high[1] - low[1]) * (high[1] - low[1]) +
                   (high[2] - low[2]) * (high[2] - low[2]));
    free(locals);
    free(worlds);
}

/* A copy of an asset's pack and sources, which the caller may change. */
static void copy_built(skin_asset *to, const skin_asset *from)
{
    const uint32_t meshes = from->pack.runs[NOH_CHUNK_MESH].count;
    to->byte_count = from->byte_count;
    to->bytes = test_aligned(from->bytes, from->byte_count);
    to->sources = test_zeros(sizeof *to->sources * (meshes + 1u));
    to->source_count = test_zeros(sizeof *to->source_count * (meshes + 1u));
    for (uint32_t i = 0; i < meshes; i++) {
        const size_t bytes = sizeof **to->sources * from->source_count[i];
        to->source_count[i] = from->source_count[i];
        to->sources[i] = test_zeros(bytes);
        memcpy(to->sources[i], from->sources[i], bytes);
    }
}

static void free_built(skin_asset *a)
{
    for (uint32_t i = 0; a->bytes && i < a->pack.runs[NOH_CHUNK_MESH].count; i++) free(a->sources[i]);
    free(a->sources);
    free(a->source_count);
    free(a->bytes);
}

/* Functions of one test open the same asset: the last one without options is built once. */
void skin_asset_open(skin_asset *a, const char *name, const skin_options *options)
{
    static skin_asset last;
    static char last_name[128];
    const char *path = test_asset(name);
    memset(a, 0, sizeof *a);
    a->o = oracle_read(path);
    if (!options && strcmp(name, last_name) == 0) {
        copy_built(a, &last);
    } else {
        build(a, path, options);
    }
    a->pack = test_open(a->bytes, a->byte_count);
    measure(a);
    if (!options && strcmp(name, last_name) != 0) {
        free_built(&last);
        memset(&last, 0, sizeof last);
        copy_built(&last, a);
        last.pack = test_open(last.bytes, last.byte_count);
        snprintf(last_name, sizeof last_name, "%s", name);
    }
}

void skin_asset_close(skin_asset *a)
{
    free_built(a);
    oracle_free(a->o);
}

void skin_asset_expected(const skin_asset *a, uint32_t mesh, const double *worlds, const double *weights, double *out)
{
    noh_mesh m = test_mesh(&a->pack, mesh);
    uint32_t node = MODEL_NONE, primitive = 0;
    double *drawn = NULL;
    /* One primitive in each pass: the pack's order mixes them. */
    uint8_t *done = test_zeros(m.header->vertex_count);
    for (uint32_t start = 0; start < m.header->vertex_count; start++) {
        const skin_source *first = &a->sources[mesh][noh_mesh_accumulation_texel(&m, start)];
        if (done[start]) {
            continue;
        }
        node = first->node;
        primitive = first->primitive;
        drawn = test_zeros(sizeof *drawn * 3 *
                           oracle_vertex_count(a->o, (uint32_t)oracle_node_mesh(a->o, node), primitive));
        oracle_drawn(a->o, node, primitive, worlds, weights, drawn);
        for (uint32_t v = start; v < m.header->vertex_count; v++) {
            const skin_source *s = &a->sources[mesh][noh_mesh_accumulation_texel(&m, v)];
            if (!done[v] && s->node == node && s->primitive == primitive) {
                done[v] = 1;
                memcpy(out + 3 * (size_t)v, drawn + 3 * (size_t)s->vertex, 3 * sizeof *out);
            }
        }
        free(drawn);
    }
    free(done);
}

float *skin_asset_model(const skin_asset *a, uint32_t skeleton, const double *locals)
{
    noh_skeleton s;
    noh_transform *pose;
    float *model_space;
    assert_int_equal(noh_pack_skeleton_at(&a->pack, skeleton, &s, NULL, NULL), NOH_OK);
    pose = test_zeros(sizeof *pose * s.joint_count);
    model_space = test_zeros(48u * (size_t)s.joint_count);
    for (uint32_t j = 0; j < s.joint_count; j++) {
        const double *from = locals + 10 * (size_t)file_node_of(a->o, noh_pack_joint_name(&a->pack, skeleton, j));
        for (int i = 0; i < 4; i++) {
            pose[j].rotation[i] = (float)from[i];
        }
        for (int i = 0; i < 3; i++) {
            pose[j].translation[i] = (float)from[4 + i];
            pose[j].scale[i] = (float)from[7 + i];
        }
    }
    noh_local_to_model(&s, pose, s.joint_count, model_space);
    free(pose);
    return model_space;
}

float *skin_asset_matrices(const skin_asset *a, const noh_mesh *mesh, const double *locals)
{
    noh_skin skin;
    float *model_space, *matrices;
    assert_int_equal(noh_pack_skin_at(&a->pack, mesh->header->skin, &skin, NULL), NOH_OK);
    model_space = skin_asset_model(a, skin.header->skeleton, locals);
    matrices = test_zeros(48u * (size_t)skin.header->joint_count);
    noh_skin_matrices(&skin, model_space, matrices);
    free(model_space);
    return matrices;
}

/* ---- a cylinder ---- */

static void ring_influences(const skin_cylinder *c, float height, uint16_t *joints, float *weights)
{
    float place = height / c->length * (float)(c->joints - 1u), sum = 0.0f;
    uint32_t used = 0;
    /* a hat as wide as the influences asked for, centred on the vertex */
    for (uint32_t j = 0; j < c->joints; j++) {
        float distance = fabsf(place - (float)j), reach = 0.5f * (float)c->influences;
        if (distance < reach && used < c->influences) {
            uint32_t at = used++;
            float weight = c->influences == 1 ? 1.0f : 1.0f - distance / reach;
            while (at > 0 && weights[at - 1] < weight) { /* the largest first */
                weights[at] = weights[at - 1];
                joints[at] = joints[at - 1];
                at--;
            }
            weights[at] = weight;
            joints[at] = (uint16_t)j;
            sum += weight;
        }
    }
    for (uint32_t i = 0; i < used; i++) {
        weights[i] /= sum;
    }
}

static void cylinder_vertex(const skin_cylinder *c, model_mesh *m, uint32_t v)
{
    float turn = 6.2831853f * (float)(v % c->around) / (float)c->around, x = cosf(turn), z = sinf(turn);
    float height = c->length * (float)(v / c->around) / (float)(c->rings - 1u);
    const float p[3] = { c->radius * x, height, c->radius * z }, n[3] = { x, 0.0f, z },
                t[4] = { z, 0.0f, -x, v % 3 ? 1.0f : -1.0f };
    memcpy(m->position + 3 * v, p, sizeof p);
    memcpy(m->normal + 3 * v, n, sizeof n);
    if (m->tangent) {
        memcpy(m->tangent + 4 * v, t, sizeof t);
    }
    ring_influences(c, height, m->joints + MODEL_INFLUENCES_MAX * v, m->joint_weights + MODEL_INFLUENCES_MAX * v);
}

static void cylinder_targets(const skin_cylinder *c, model_mesh *m)
{
    m->target_count = c->targets;
    m->targets = test_zeros(sizeof *m->targets * c->targets);
    m->weights = test_zeros(sizeof *m->weights * c->targets);
    for (uint32_t t = 0; t < c->targets; t++) {
        model_target *target = &m->targets[t];
        target->name = model_string(t ? "swell" : "bulge");
        target->position = test_zeros(12u * (size_t)m->vertex_count);
        target->normal = test_zeros(12u * (size_t)m->vertex_count);
        target->tangent = m->tangent ? test_zeros(12u * (size_t)m->vertex_count) : NULL;
        for (uint32_t v = 0; v < m->vertex_count; v++) {
            if ((v / c->around + t) % 3 == 1) {
                for (uint32_t i = 0; i < 3; i++) {
                    target->position[3 * v + i] = 0.2f * m->normal[3 * v + i] * (t ? 0.5f : 1.0f);
                    target->normal[3 * v + i] = i == 1 ? 0.3f : 0.0f;
                }
            }
        }
    }
}

static void cylinder_triangles(const skin_cylinder *c, model_mesh *m)
{
    uint32_t *to;
    m->index_count = 6u * c->around * (c->rings - 1u);
    to = m->indices = test_zeros(4u * (size_t)m->index_count);
    for (uint32_t q = 0; q < c->around * (c->rings - 1u); q++) {
        uint32_t a = q, b = q / c->around * c->around + (q + 1) % c->around;
        const uint32_t quad[6] = { a, a + c->around, b, b, a + c->around, b + c->around };
        memcpy(to, quad, sizeof quad);
        to += 6;
    }
    m->submesh_count = 1;
    m->submeshes = test_zeros(sizeof *m->submeshes);
    m->submeshes[0].index_count = m->index_count;
    m->submeshes[0].material = MODEL_NONE;
    m->submeshes[0].vertex_count = m->vertex_count;
}

static void add_node(model *m, const char *name, uint32_t parent, float y, uint32_t mesh)
{
    model_node *n = &m->nodes[m->node_count++];
    n->name = model_string(name);
    n->parent = parent;
    n->mesh = mesh;
    n->skin = MODEL_NONE;
    n->rotation[3] = n->scale[0] = n->scale[1] = n->scale[2] = 1.0f;
    n->translation[1] = y;
    for (int i = 0; i < 16; i++) {
        n->world[i] = i % 5 == 0;
    }
    n->world[13] = (double)y + (parent == MODEL_NONE ? 0.0 : m->nodes[parent].world[13]);
}

model *skin_cylinder_model(const skin_cylinder *c)
{
    model *m = model_new();
    model_mesh *mesh;
    m->mesh_count = 1;
    mesh = m->meshes = test_zeros(sizeof *m->meshes);
    mesh->name = model_string("cylinder");
    mesh->vertex_count = c->around * c->rings;
    mesh->position = test_zeros(12u * (size_t)mesh->vertex_count);
    mesh->normal = test_zeros(12u * (size_t)mesh->vertex_count);
    mesh->tangent = c->tangents ? test_zeros(16u * (size_t)mesh->vertex_count) : NULL;
    mesh->joints = test_zeros(2u * MODEL_INFLUENCES_MAX * (size_t)mesh->vertex_count);
    mesh->joint_weights = test_zeros(4u * MODEL_INFLUENCES_MAX * (size_t)mesh->vertex_count);
    mesh->influence_max = c->influences;
    mesh->joint_limit = c->joints;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        cylinder_vertex(c, mesh, v);
    }
    cylinder_targets(c, mesh);
    cylinder_triangles(c, mesh);
    m->nodes = test_zeros(sizeof *m->nodes * (c->joints + 3u));
    m->skin_count = 1;
    m->skins = test_zeros(sizeof *m->skins);
    m->skins[0].name = model_string("bones");
    m->skins[0].joint_count = c->joints;
    m->skins[0].joints = test_zeros(4u * (size_t)c->joints);
    m->skins[0].inverse_bind = test_zeros(64u * (size_t)c->joints);
    for (uint32_t j = 0; j < c->joints; j++) {
        char name[32];
        snprintf(name, sizeof name, "joint_%u", (unsigned)j);
        add_node(m, name, j ? j - 1 : MODEL_NONE, j ? c->length / (float)(c->joints - 1u) : 0.0f, MODEL_NONE);
        m->skins[0].joints[j] = j;
        for (int i = 0; i < 4; i++) {
            m->skins[0].inverse_bind[16 * j + 5 * (uint32_t)i] = 1.0f;
        }
        m->skins[0].inverse_bind[16 * j + 13] = -(float)m->nodes[j].world[13];
    }
    add_node(m, "body", MODEL_NONE, 0.0f, 0);
    m->nodes[c->joints].skin = 0;
    return m;
}
