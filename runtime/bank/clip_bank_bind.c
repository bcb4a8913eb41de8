#include "bank/clip_bank_bind_internal.h"

#include <string.h>

#include "mesh/mesh.h"

static noh_result bind_skeleton(uint32_t skeleton, noh_bank_binding *b, noh_error *error)
{
    if (skeleton == NOH_NONE || b->mesh->skeleton_count == 0) {
        b->skeleton_index = NOH_NONE;
        return NOH_OK;
    }
    b->skeleton_index = skeleton;
    if (noh_pack_skeleton_at(b->mesh, skeleton, &b->skeleton, &b->header, NULL) != NOH_OK) {
        return noh_fail(error, NOH_ERR_ARG, "skeleton of a clip bank: the mesh pack has fewer", skeleton,
                        b->mesh->skeleton_count);
    }
    return NOH_OK;
}

/* Clips of this skeleton that were built in other units would be posed in the wrong size. */
static noh_result check_units(const noh_bank_binding *b, noh_error *error)
{
    for (uint32_t i = 0; b->header && i < b->clips->skeleton_count; i++) {
        noh_skeleton skeleton;
        const noh_skeleton_header *h;
        noh_pack_skeleton_at(b->clips, i, &skeleton, &h, NULL);
        if (h->hash == b->header->hash && (h->unit_cm > b->header->unit_cm || h->unit_cm < b->header->unit_cm)) {
            return noh_fail(
                error, NOH_ERR_NOT_FOUND,
                "the clips' skeleton has another unit than the mesh's: build both in one unit, or in one pack", i, 0);
        }
    }
    return NOH_OK;
}

noh_result noh_bank_bind(const noh_pack *clips, const noh_pack *mesh, uint32_t skeleton, noh_bank_binding *b,
                         noh_error *error)
{
    noh_result r;
    memset(b, 0, sizeof *b);
    b->clips = clips;
    b->mesh = mesh;
    r = bind_skeleton(skeleton, b, error);
    return r ? r : check_units(b, error);
}

/* A clip without joints fits always. One with joints fits the skeleton of the same hash; in a single pack, which may
 * hold equal skeletons, it fits the very one that it was built with. */
int noh_bank_fits(const noh_bank_binding *b, uint32_t index, noh_pack_clip *packed, noh_clip_desc *clip)
{
    noh_skeleton built_with;
    const noh_clip_header *h;
    (void)noh_pack_clip_at(b->clips, index, packed, NULL);
    h = packed->header;
    clip->bytes = packed->bytes;
    clip->byte_count = h->clip_bytes;
    clip->joint_count = h->joint_count;
    clip->bind = NULL;
    if (h->joint_count == 0) {
        return 1;
    }
    if (!b->header || h->skeleton_hash != b->header->hash || h->joint_count != b->header->joint_count ||
        (b->mesh == b->clips && h->skeleton != b->skeleton_index)) {
        return 0;
    }
    if (noh_pack_skeleton_at(b->clips, h->skeleton, &built_with, NULL, NULL)) return 0;
    clip->bind = built_with.bind_pose;
    return 1;
}

int noh_bank_next_node(const noh_bank_binding *b, uint32_t *node, uint32_t *first, noh_clip_group *group)
{
    for (; *node < b->mesh->node_count; ++*node) {
        const noh_node *n = &b->mesh->nodes[*node];
        noh_mesh mesh;
        if (n->mesh == NOH_NONE) {
            continue;
        }
        (void)noh_pack_mesh_at(b->mesh, n->mesh, &mesh, NULL);
        if (mesh.header->target_count) {
            group->name_hash = n->name_hash;
            group->node = (*node)++;
            group->first = *first;
            group->width = mesh.header->target_count;
            *first += group->width;
            return 1;
        }
    }
    return 0;
}

/* Names may repeat among nodes: the node of the clip's index decides where it has the name, else the first that does.
 */
int noh_bank_find_node(const noh_bank_binding *b, const noh_clip_group *wanted, noh_clip_group *found)
{
    noh_clip_group group;
    uint32_t node = 0, first = 0;
    int any = 0;
    while (noh_bank_next_node(b, &node, &first, &group)) {
        if (noh_bank_same_group(&group, wanted) && (!any || group.node == wanted->node)) {
            *found = group;
            any = 1;
        }
    }
    return any;
}

static int clip_has(const noh_clip_desc *clip, const noh_clip_group *wanted, uint32_t before)
{
    noh_clip_group_reader reader = noh_clip_groups_of(clip);
    noh_clip_group group;
    while (noh_clip_next_group(&reader, &group) && group.first < before) {
        if (noh_bank_is_named(&group) && noh_bank_same_group(&group, wanted)) {
            return 1;
        }
    }
    return 0;
}

int noh_bank_is_new(const noh_bank_binding *b, uint32_t index, const noh_clip_desc *clip, const noh_clip_group *group)
{
    if (!noh_bank_is_named(group) || group->width == 0 || clip_has(clip, group, group->first)) {
        return 0;
    }
    for (uint32_t i = 0; i < index; i++) {
        noh_pack_clip packed;
        noh_clip_desc other;
        if (noh_bank_fits(b, i, &packed, &other) && clip_has(&other, group, NOH_NONE)) {
            return 0;
        }
    }
    return 1;
}
