/* morph_uv.c: texture coordinates that targets move, as positions of vertices more. */
#include "morph_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"

/* Texture coordinates are off by at most this: a quarter of a texel of the largest texture. */
#define UV_ERROR (1.0 / 8192.0)

static int slides(const model_mesh *m, uint32_t v)
{
    for (uint32_t t = 0; t < m->target_count; t++) {
        const float *uv = m->targets[t].uv;
        if (uv && (uv[2 * (size_t)v] != 0.0f || uv[2 * (size_t)v + 1u] != 0.0f)) return 1;
    }
    return 0;
}

/* A copy of `count` floats with room for more; NULL stays NULL. */
static float *grown(const float *from, size_t count, size_t room, int *failed)
{
    float *copy = from ? morph_alloc(room, sizeof *copy) : NULL;
    if (copy) memcpy(copy, from, count * sizeof *copy);
    *failed |= from && !copy;
    return copy;
}

static int copy_arrays(const model_mesh *from, model_mesh *to)
{
    const size_t count = 3u * (size_t)from->vertex_count, room = 3u * (size_t)to->vertex_count;
    int failed = 0;
    to->position = grown(from->position, count, room, &failed);
    to->targets = morph_alloc(from->target_count, sizeof *to->targets);
    if (!to->targets) return 1;
    for (uint32_t t = 0; t < from->target_count; t++) {
        to->targets[t] = from->targets[t];
        to->targets[t].position = grown(from->targets[t].position, count, room, &failed);
        to->targets[t].normal = grown(from->targets[t].normal, count, room, &failed);
        to->targets[t].tangent = grown(from->targets[t].tangent, count, room, &failed);
    }
    return failed;
}

static void fill_stand_in(const model_mesh *m, uint32_t v, double length, model_mesh *out, uint32_t to)
{
    memcpy(out->position + 3 * (size_t)to, m->position + 3 * (size_t)v, 3 * sizeof *out->position);
    for (uint32_t t = 0; t < m->target_count; t++) {
        const float *uv = m->targets[t].uv;
        for (size_t k = 0; uv && k < 2; k++) {
            out->targets[t].position[3 * (size_t)to + k] = (float)((double)uv[2 * (size_t)v + k] * length);
        }
    }
}

int morph_uv_needed(const model_mesh *mesh)
{
    for (uint32_t t = 0; mesh->uv && t < mesh->target_count; t++) {
        if (mesh->targets[t].uv) return 1;
    }
    return 0;
}

int morph_uv_extend(const model_mesh *mesh, const morph_options *options, morph_uv *out)
{
    uint32_t count = mesh->vertex_count, next = count;
    const double least = (double)options->error_um * 1e-6 / UV_ERROR, length = fmax(model_uv_length(mesh), least);
    memset(out, 0, sizeof *out);
    out->mesh = *mesh;
    out->uv_per_unit = (float)(1.0 / length);
    for (uint32_t v = 0; v < count; v++) next += (uint32_t)slides(mesh, v);
    out->mesh.vertex_count = next;
    out->mesh.targets = NULL;
    out->stand_in = morph_alloc(count, sizeof *out->stand_in);
    out->rank = morph_alloc(next, sizeof *out->rank);
    if (copy_arrays(mesh, &out->mesh) || !out->stand_in || !out->rank) return 1;
    if (options->rank) memcpy(out->rank, options->rank, count);
    next = count;
    for (uint32_t v = 0; v < count; v++) {
        out->stand_in[v] = MODEL_NONE;
        if (!slides(mesh, v)) continue;
        fill_stand_in(mesh, v, 1.0 / (double)out->uv_per_unit, &out->mesh, next);
        out->rank[next] = out->rank[v];
        out->stand_in[v] = next++;
    }
    return 0;
}

void morph_uv_free(morph_uv *uv)
{
    for (uint32_t t = 0; uv->mesh.targets && t < uv->mesh.target_count; t++) {
        free(uv->mesh.targets[t].position);
        free(uv->mesh.targets[t].normal);
        free(uv->mesh.targets[t].tangent);
    }
    if (uv->mesh.targets) free(uv->mesh.position);
    free(uv->mesh.targets);
    free(uv->stand_in);
    free(uv->rank);
}
