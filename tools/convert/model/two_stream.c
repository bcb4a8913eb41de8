#include "two_stream.h"

#include <stdlib.h>
#include <string.h>

#include "model_build.h"

static uint32_t find_mesh(const model *m, const char *name, size_t length)
{
    uint32_t i = 0;
    while (i < m->mesh_count && (strncmp(m->meshes[i].name, name, length) != 0 || m->meshes[i].name[length])) {
        i++;
    }
    return i;
}

static int same_triangles(const model_mesh *a, const model_mesh *b)
{
    int same = a->submesh_count == b->submesh_count &&
               memcmp(a->indices, b->indices, a->index_count * sizeof *a->indices) == 0;
    for (uint32_t s = 0; same && s < a->submesh_count; s++) {
        same = a->submeshes[s].first_index == b->submeshes[s].first_index &&
               a->submeshes[s].index_count == b->submeshes[s].index_count;
    }
    return same;
}

static int check_pair(const model_mesh *a, const model_mesh *b, const char *pair, model_error *error)
{
    if (a->vertex_count != b->vertex_count || a->index_count != b->index_count) {
        return model_fail(error, pair, "the meshes have %u and %u vertices, %u and %u indices: they must have the same",
                          a->vertex_count, b->vertex_count, a->index_count, b->index_count);
    }
    if (!same_triangles(a, b)) {
        return model_fail(error, pair, "the meshes have different triangles: export both with the same vertex order");
    }
    return b->target_count ? model_fail(error, pair, "the second mesh has morph targets of its own") : 0;
}

static float *difference(const float *from, const float *to, uint32_t count, uint32_t stride)
{
    float *out = model_zeros((size_t)count * 3, sizeof *out);
    for (size_t i = 0; out && i < (size_t)count * 3; i++) {
        size_t at = i / 3 * stride + i % 3;
        out[i] = to[at] - from[at];
    }
    return out;
}

static int add_target(model_mesh *a, const model_mesh *b)
{
    model_target *targets = realloc(a->targets, ((size_t)a->target_count + 1) * sizeof *targets), *t;
    float *weights;
    if (!targets) {
        return 1;
    }
    a->targets = targets;
    weights = realloc(a->weights, ((size_t)a->target_count + 1) * sizeof *weights);
    if (!weights) {
        return 1;
    }
    a->weights = weights;
    weights[a->target_count] = 0.0f;
    t = &targets[a->target_count++];
    memset(t, 0, sizeof *t);
    t->name = model_string(b->name);
    t->position = difference(a->position, b->position, a->vertex_count, 3);
    t->normal = difference(a->normal, b->normal, a->vertex_count, 3);
    t->tangent = !a->tangent  ? NULL
                 : b->tangent ? difference(a->tangent, b->tangent, a->vertex_count, 4)
                              : model_zeros((size_t)a->vertex_count * 3, sizeof(float));
    t->has_position = t->has_normal = 1;
    t->has_tangent = a->tangent && b->tangent;
    return !t->name || !t->position || !t->normal || (a->tangent && !t->tangent);
}

/* Nodes that draw the first mesh get one more weight. */
static int grow_weights(model *m, uint32_t mesh)
{
    for (uint32_t n = 0; n < m->node_count; n++) {
        if (m->nodes[n].mesh == mesh && m->nodes[n].weights) {
            uint32_t count = m->meshes[mesh].target_count;
            float *grown = realloc(m->nodes[n].weights, count * sizeof *grown);
            if (!grown) {
                return 1;
            }
            grown[count - 1] = 0.0f;
            m->nodes[n].weights = grown;
        }
    }
    return 0;
}

/* Animations of the first mesh's weights would lack the new weight. */
static int is_animated(const model *m, uint32_t mesh)
{
    for (uint32_t c = 0; c < m->clip_count; c++) {
        for (uint32_t i = 0; i < m->clips[c].channel_count; i++) {
            const model_channel *channel = &m->clips[c].channels[i];
            if (channel->path == MODEL_PATH_WEIGHTS && m->nodes[channel->node].mesh == mesh) {
                return 1;
            }
        }
    }
    return 0;
}

int two_stream_join(model *m, const char *pair, model_error *error)
{
    const char *equals = strchr(pair, '=');
    uint32_t a = equals ? find_mesh(m, pair, (size_t)(equals - pair)) : m->mesh_count;
    uint32_t b = equals ? find_mesh(m, equals + 1, strlen(equals + 1)) : m->mesh_count;
    if (a == m->mesh_count || b == m->mesh_count || a == b) {
        return model_fail(error, pair, "--two-stream must be SOURCE=TARGET, the names of two meshes of the file");
    }
    if (check_pair(&m->meshes[a], &m->meshes[b], pair, error)) {
        return 1;
    }
    if (is_animated(m, a)) {
        return model_fail(error, pair, "an animation moves the first mesh's morph weights");
    }
    if (add_target(&m->meshes[a], &m->meshes[b]) || grow_weights(m, a)) {
        return model_fail(error, pair, "out of memory");
    }
    for (uint32_t n = 0; n < m->node_count; n++) {
        m->nodes[n].mesh = m->nodes[n].mesh == b ? MODEL_NONE : m->nodes[n].mesh;
    }
    model_drop_mesh(m, b);
    return 0;
}
