/* check_nodes.c: the checker of nodes. */
#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"

#include <stddef.h>

static uint32_t mesh_target_count(const noh_pack *pack, uint32_t mesh)
{
    const noh_mesh_header *h = noh_pack_chunk_at(pack, NOH_CHUNK_MESH, mesh);
    return h->target_count;
}

/* A node comes after its parent, so nodes make trees, and one pass in stored order meets parents first. */
static noh_result check_node(const noh_check *check, const noh_nodes_header *h, const noh_node *node, uint32_t index)
{
    uint64_t at = h->nodes_offset + (uint64_t)index * sizeof *node;
    noh_result result = noh_check_name(check, node->name, node->name_hash, at);
    if (!result) {
        result = noh_check_floats(check, node->translation, 22, "node transform is not finite");
    }
    if (result) {
        return result;
    }
    if (node->parent != NOH_NONE && node->parent >= index) {
        return noh_check_fail(check, "node comes before its parent", at + offsetof(noh_node, parent));
    }
    if (node->mesh != NOH_NONE && node->mesh >= check->pack->runs[NOH_CHUNK_MESH].count) {
        return noh_check_fail(check, "node names a missing mesh", at + offsetof(noh_node, mesh));
    }
    if (node->first_weight != NOH_NONE &&
        (node->mesh == NOH_NONE || node->first_weight > h->weight_count ||
         mesh_target_count(check->pack, node->mesh) > h->weight_count - node->first_weight)) {
        return noh_check_fail(check, "node's weights lie outside the weights", at + offsetof(noh_node, first_weight));
    }
    return node->flags ? noh_check_fail(check, "unknown node flags", at + offsetof(noh_node, flags)) : NOH_OK;
}

noh_result noh_check_nodes(noh_check *check)
{
    const noh_nodes_header *h = (const noh_nodes_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (result) {
        return result;
    }
    if (h->node_count > NOH_NODES_MAX) {
        return noh_check_fail(check, "node count is over the limit", offsetof(noh_nodes_header, node_count));
    }
    result = noh_check_array(check, offsetof(noh_nodes_header, nodes_offset), h->node_count, sizeof(noh_node));
    if (!result) result = noh_check_array(check, offsetof(noh_nodes_header, weights_offset), h->weight_count, 4);
    if (!result) result = noh_check_end(check);
    for (uint32_t i = 0; !result && i < h->node_count; i++) {
        result = check_node(check, h, (const noh_node *)(const void *)(check->bytes + h->nodes_offset) + i, i);
    }
    if (!result) {
        result = noh_check_floats(check, (const float *)(const void *)(check->bytes + h->weights_offset),
                                  h->weight_count, "node weight is not finite");
    }
    if (!result) {
        check->opens->nodes = (const noh_node *)(const void *)(check->bytes + h->nodes_offset);
        check->opens->node_count = h->node_count;
        check->opens->node_weights = (const float *)(const void *)(check->bytes + h->weights_offset);
    }
    return result;
}
