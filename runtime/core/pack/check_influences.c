/* check_influences.c: the checker of influence lists. */
#include "core/pack/check_internal.h"

#include <stddef.h>

#include "noh/base.h"
#include "noh/format.h"

static noh_result check_header(const noh_check *check, const noh_influences_header *h)
{
    return noh_check_reserved(check, offsetof(noh_influences_header, reserved),
                              sizeof h->reserved / sizeof h->reserved[0]);
}

static noh_result check_arrays(noh_check *check, const noh_influences_header *h)
{
    noh_result result = noh_check_array(check, offsetof(noh_influences_header, vertices_offset), h->vertex_count, 4);
    if (!result) {
        result = noh_check_array(check, offsetof(noh_influences_header, firsts_offset), h->vertex_count + 1ull, 4);
    }
    if (!result) {
        result = noh_check_array(check, offsetof(noh_influences_header, weights_offset), h->influence_count, 4);
    }
    if (!result) {
        result = noh_check_array(check, offsetof(noh_influences_header, joints_offset), h->influence_count, 2);
    }
    return result ? result : noh_check_end(check);
}

/* The joints and weights of one vertex. */
static noh_result check_vertex(const noh_check *check, const noh_influences_header *h, uint32_t joint_count,
                               uint32_t first, uint32_t end)
{
    const float *weights = (const float *)(const void *)(check->bytes + h->weights_offset);
    const uint16_t *joints = (const uint16_t *)(const void *)(check->bytes + h->joints_offset);
    float sum = 0.0f;
    for (uint32_t i = first; i < end; i++) {
        if (!(weights[i] > 0.0f && weights[i] <= 1.0f)) {
            return noh_check_fail(check, "weight of an influence list is not above 0, or over 1",
                                  h->weights_offset + 4ull * i);
        }
        if (joints[i] >= joint_count) {
            return noh_check_fail(check, "influence list names a joint that its skin lacks",
                                  h->joints_offset + 2ull * i);
        }
        sum += weights[i];
    }
    return sum > 1.0f - 1.0f / 65536.0f && sum < 1.0f + 1.0f / 65536.0f
               ? NOH_OK
               : noh_check_fail(check, "weights of a vertex of an influence list do not sum to 1",
                                h->weights_offset + 4ull * first);
}

static noh_result check_values(const noh_check *check, const noh_influences_header *h, const noh_mesh_header *mesh)
{
    const uint32_t *vertices = (const uint32_t *)(const void *)(check->bytes + h->vertices_offset);
    const uint32_t *firsts = (const uint32_t *)(const void *)(check->bytes + h->firsts_offset);
    const uint32_t joint_count = noh_check_skin_joints(check->pack, mesh->skin);
    uint32_t most = 0;
    noh_result result = NOH_OK;
    if (firsts[0] != 0 || firsts[h->vertex_count] != h->influence_count) {
        return noh_check_fail(check, "influence list does not begin at 0, or does not end with its influences",
                              h->firsts_offset);
    }
    for (uint32_t i = 0; !result && i < h->vertex_count; i++) {
        const uint32_t count = firsts[i + 1u] - firsts[i];
        if (vertices[i] >= mesh->vertex_count || (i && vertices[i] <= vertices[i - 1u])) {
            return noh_check_fail(check, "vertex of an influence list is not its mesh's, or not in ascending order",
                                  h->vertices_offset + 4ull * i);
        }
        if (firsts[i + 1u] > h->influence_count || count == 0 || count > NOH_SKIN_LIST_MAX) {
            return noh_check_fail(check, "vertex of an influence list has no joints, or more than the limit",
                                  h->firsts_offset + 4ull * i);
        }
        most = count > most ? count : most;
        result = check_vertex(check, h, joint_count, firsts[i], firsts[i + 1u]);
    }
    if (!result && most != h->most) {
        result = noh_check_fail(check,
                                "joint count of an influence list differs from the most that one of its vertices has",
                                offsetof(noh_influences_header, most));
    }
    return result;
}

noh_result noh_check_influences(noh_check *check)
{
    const noh_influences_header *h = (const noh_influences_header *)(const void *)check->bytes;
    const noh_mesh_header *mesh;
    noh_result result = noh_check_head(check, sizeof *h);
    if (!result) result = check_header(check, h);
    if (result) return result;
    mesh = noh_check_subject(check, NOH_CHUNK_INFLUENCES, NOH_CHUNK_MESH);
    if (!mesh || mesh->skin == NOH_NONE) {
        return noh_check_fail(check, "influence list names a mesh that is missing or not skinned, or is out of order",
                              offsetof(noh_influences_header, mesh));
    }
    result = check_arrays(check, h);
    return result ? result : check_values(check, h, mesh);
}
