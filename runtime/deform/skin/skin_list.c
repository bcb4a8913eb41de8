#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/pack.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "core/mesh/mesh_internal.h"
#include "deform/skin/skin_blend_internal.h"

noh_result noh_pack_skin_list(const noh_pack *pack, uint32_t mesh, noh_skin_list *list, noh_error *error)
{
    NOH_ASSERT(pack && list);
    const uint8_t *bytes = noh_pack_chunk_of_mesh(pack, NOH_CHUNK_INFLUENCES, mesh);
    const noh_influences_header *h = (const noh_influences_header *)(const void *)bytes;
    if (!h) {
        return noh_fail(
            error, NOH_ERR_NOT_FOUND,
            "the mesh has no influence list: build its pack with --influences above 8, from a model with that many",
            mesh, 0);
    }
    list->header = h;
    list->vertices = (const uint32_t *)(const void *)(bytes + h->vertices_offset);
    list->firsts = (const uint32_t *)(const void *)(bytes + h->firsts_offset);
    list->weights = (const float *)(const void *)(bytes + h->weights_offset);
    list->joints = (const uint16_t *)(const void *)(bytes + h->joints_offset);
    return NOH_OK;
}

uint32_t noh_skin_list_place(const noh_skin_list *list, uint32_t vertex)
{
    uint32_t low = 0, high = list->header->vertex_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2u;
        if (list->vertices[middle] < vertex) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Blend like noh_skin_vertex, in the list's order. */
static void blend(const noh_skin_list *list, const float *matrices, uint32_t place, float m[12])
{
    memset(m, 0, 12 * sizeof *m);
    for (uint32_t i = list->firsts[place]; i < list->firsts[place + 1u]; i++) {
        const float *joint = matrices + 12u * (size_t)list->joints[i];
        for (size_t e = 0; e < 12; e++) {
            m[e] = m[e] + list->weights[i] * joint[e];
        }
    }
}

uint32_t noh_skin_list_vertices(const noh_skin_list *list, const noh_mesh *mesh, const float *matrices,
                                const noh_morph_layers *layers, uint32_t first, uint32_t count, float *positions,
                                float *normals, float *tangents)
{
    uint32_t place, written = 0;
    NOH_ASSERT(list && mesh && matrices && first <= mesh->header->vertex_count);
    NOH_ASSERT(count <= mesh->header->vertex_count - first);
    for (place = noh_skin_list_place(list, first);
         place < list->header->vertex_count && list->vertices[place] - first < count; place++, written++) {
        const uint32_t vertex = list->vertices[place];
        const size_t at = vertex - first;
        noh_vertex v;
        float m[12];
        blend(list, matrices, place, m);
        noh_skin_rest(mesh, layers, vertex, &v);
        noh_skin_apply(m, &v);
        if (positions) memcpy(positions + 3u * at, v.position, sizeof v.position);
        if (normals) memcpy(normals + 3u * at, v.normal, sizeof v.normal);
        if (tangents) memcpy(tangents + 4u * at, v.tangent, sizeof v.tangent);
    }
    return written;
}
