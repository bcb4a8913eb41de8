/* bench_artist.c: the vertex order that the asset had before the converter changed it. The
 * encoder is deterministic: run again on the asset, it gives the pack's order. */
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "convert/morph/morph_encode.h"
#include "cli/message.h"

/* 0 if the encoder's order, applied to the asset, gives the pack's vertices. */
static int differs(const model_mesh *from, const morph_encoding *e, const noh_mesh *mesh)
{
    if (e->vertex_count != mesh->header->vertex_count || e->target_count != mesh->header->target_count) {
        return 1;
    }
    for (uint32_t v = 0; v < e->vertex_count; v++) {
        if (memcmp(from->position + 3 * (size_t)e->order[v], mesh->positions + 3 * (size_t)v, 12) != 0) {
            return 1;
        }
    }
    return 0;
}

static int copy_order(const char *asset, const morph_encoding *e, uint32_t **out)
{
    *out = malloc(sizeof **out * (e->vertex_count + 1u));
    if (!*out) {
        return tool_fail(asset, "out of memory");
    }
    memcpy(*out, e->order, sizeof **out * e->vertex_count);
    return 0;
}

int bench_artist_order(const char *asset, uint32_t mesh_index, const noh_mesh *mesh, uint32_t **out)
{
    morph_options options = { 0 };
    morph_encoding *e = NULL;
    model *m = NULL;
    model_error error;
    int status;
    memset(&error, 0, sizeof error);
    *out = NULL;
    if (model_read_gltf(asset, &m, &error)) {
        return tool_fail(asset, "%s (%s)", error.what, error.where);
    }
    if (mesh_index >= m->mesh_count || morph_encode(&m->meshes[mesh_index], &options, &e, &error) ||
        differs(&m->meshes[mesh_index], e, mesh)) {
        status = tool_fail(asset, "the pack was not built from this file with default options");
    } else {
        status = copy_order(asset, e, out);
    }
    if (e) {
        morph_encoding_free(e);
    }
    model_free(m);
    return status;
}
