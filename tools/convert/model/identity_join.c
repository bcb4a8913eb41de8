#include "identity_join.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model_build.h"

/* ---- which mesh ---- */

static float size_of(const model_mesh *mesh)
{
    float low[3] = { 0 }, high[3] = { 0 }, square = 0.0f;
    for (size_t i = 0; i < (size_t)mesh->vertex_count * 3; i++) {
        const float x = mesh->position[i];
        if (i < 3 || x < low[i % 3]) low[i % 3] = x;
        if (i < 3 || x > high[i % 3]) high[i % 3] = x;
    }
    for (int c = 0; c < 3; c++) square += (high[c] - low[c]) * (high[c] - low[c]);
    return sqrtf(square);
}

/* Files are rounded each for itself: positions may differ by a thousandth of the mesh. */
static int same_surface(const model_mesh *a, const model_mesh *b)
{
    const float within = 1e-3f * size_of(a);
    if (a->vertex_count != b->vertex_count || a->index_count != b->index_count ||
        memcmp(a->indices, b->indices, a->index_count * sizeof *a->indices) != 0) {
        return 0;
    }
    for (size_t i = 0; i < (size_t)a->vertex_count * 3; i++) {
        if (!(fabsf(a->position[i] - b->position[i]) <= within)) return 0;
    }
    return 1;
}

static int names_clash(const model_mesh *a, const model_mesh *b, const char *path, model_error *error)
{
    for (uint32_t i = 0; i < a->target_count; i++) {
        for (uint32_t k = 0; k < b->target_count; k++) {
            if (strcmp(a->targets[i].name, b->targets[k].name) == 0) {
                return model_fail(error, path, "both files have a target '%s'", b->targets[k].name);
            }
        }
    }
    return 0;
}

/* ---- weights ---- */

static int grow(float **values, size_t rows, uint32_t from, uint32_t to)
{
    float *grown = *values ? calloc(rows * to + 1u, sizeof *grown) : NULL;
    for (size_t r = 0; grown && r < rows; r++) {
        memcpy(grown + r * to, *values + r * from, from * sizeof *grown);
    }
    if (*values && !grown) return 1;
    free(*values);
    *values = grown;
    return 0;
}

static int grow_channels(model *m, uint32_t mesh, uint32_t to)
{
    for (uint32_t c = 0; c < m->clip_count; c++) {
        for (uint32_t i = 0; i < m->clips[c].channel_count; i++) {
            model_channel *channel = &m->clips[c].channels[i];
            const size_t rows = channel->interpolation == MODEL_CUBICSPLINE ? 3u : 1u;
            if (channel->path != MODEL_PATH_WEIGHTS || m->nodes[channel->node].mesh != mesh) continue;
            if (grow(&channel->values, rows * channel->key_count, channel->width, to)) return 1;
            channel->width = to;
        }
    }
    return 0;
}

static int grow_weights(model *m, uint32_t mesh, uint32_t to)
{
    const uint32_t from = m->meshes[mesh].target_count;
    for (uint32_t n = 0; n < m->node_count; n++) {
        if (m->nodes[n].mesh == mesh && grow(&m->nodes[n].weights, 1, from, to)) return 1;
    }
    return grow(&m->meshes[mesh].weights, 1, from, to) || grow_channels(m, mesh, to);
}

/* ---- targets ---- */

/* Moved, not copied: b has none afterwards. */
static int move_targets(model *m, uint32_t mesh, model_mesh *b)
{
    model_mesh *a = &m->meshes[mesh];
    const uint32_t count = a->target_count + b->target_count;
    model_target *targets;
    if (grow_weights(m, mesh, count)) return 1;
    targets = realloc(a->targets, (size_t)count * sizeof *targets);
    if (!targets) return 1;
    a->targets = targets;
    for (uint32_t i = 0; i < b->target_count; i++) {
        model_target *t = &targets[a->target_count + i];
        *t = b->targets[i];
        t->identity = 1;
    }
    a->target_count = count;
    b->target_count = 0;
    for (uint32_t i = 0; i < count; i++) { /* both have tangents, or neither */
        if (a->tangent && !targets[i].tangent) {
            targets[i].tangent = model_zeros((size_t)a->vertex_count * 3, sizeof(float));
            if (!targets[i].tangent) return 1;
        } else if (!a->tangent) {
            free(targets[i].tangent);
            targets[i].tangent = NULL;
        }
    }
    return 0;
}

static int join(model *m, model *other, const char *path, model_error *error)
{
    uint32_t joined = 0;
    for (uint32_t b = 0; b < other->mesh_count; b++) {
        model_mesh *from = &other->meshes[b];
        for (uint32_t a = 0; a < m->mesh_count && from->target_count; a++) {
            if (!same_surface(&m->meshes[a], from)) continue;
            if (names_clash(&m->meshes[a], from, path, error)) return 1;
            if (move_targets(m, a, from)) return model_fail(error, path, "out of memory");
            joined++;
            break;
        }
    }
    return joined ? 0
                  : model_fail(error, path,
                               "no mesh with targets has the triangles and the rest positions of a mesh of the model: "
                               "export both with the same order of vertices");
}

int identity_join(model *m, const char *path, model_error *error)
{
    model *other = NULL;
    int failed;
    if (model_read_gltf(path, &other, error)) {
        return 1;
    }
    failed = join(m, other, path, error);
    model_free(other);
    return failed;
}
