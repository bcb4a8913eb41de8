#include "target_append.h"

#include <stdlib.h>
#include <string.h>

#include "model_build.h"

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

int model_append_targets(model *m, uint32_t mesh, model_mesh *b)
{
    model_mesh *a = &m->meshes[mesh];
    const uint32_t count = a->target_count + b->target_count;
    model_target *targets;
    if (grow_weights(m, mesh, count)) return 1;
    targets = realloc(a->targets, (size_t)count * sizeof *targets);
    if (!targets) return 1;
    a->targets = targets;
    for (uint32_t i = 0; i < b->target_count; i++) {
        targets[a->target_count + i] = b->targets[i];
    }
    a->target_count = count;
    b->target_count = 0;
    for (uint32_t i = 0; i < count; i++) { /* both have tangents, or neither */
        if (!a->uv) {
            free(targets[i].uv);
            targets[i].uv = NULL;
        }
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
