#include "motion/bank/clip_bank_bind_internal.h"
#include "motion/bank/clip_bank_internal.h"

#include <string.h>

#include "core/base/name_internal.h"
#include "core/base/compiler_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_motion.h"
#include "noh/pack.h"

static noh_result bind_skeleton(uint32_t skeleton, noh_bank_binding *b, noh_error *error)
{
    if (skeleton == NOH_NONE || b->mesh->runs[NOH_CHUNK_SKELETON].count == 0) {
        b->skeleton_index = NOH_NONE;
        return NOH_OK;
    }
    b->skeleton_index = skeleton;
    if (noh_pack_skeleton_at(b->mesh, skeleton, &b->skeleton, &b->header, NULL) != NOH_OK) {
        return noh_fail(error, NOH_ERR_ARG, "skeleton of a clip bank is past the mesh pack's last skeleton", skeleton,
                        b->mesh->runs[NOH_CHUNK_SKELETON].count);
    }
    return NOH_OK;
}

/* Clips of this skeleton in another unit would be posed at the wrong size. */
static noh_result check_units(const noh_bank_binding *b, uint32_t pack, noh_error *error)
{
    for (uint32_t i = 0; b->header && i < b->packs[pack]->runs[NOH_CHUNK_SKELETON].count; i++) {
        const noh_bank_place at = { pack, i };
        noh_skeleton skeleton;
        const noh_skeleton_header *h;
        noh_pack_skeleton_at(b->packs[pack], i, &skeleton, &h, NULL);
        if (h->hash == b->header->hash && (h->unit_cm > b->header->unit_cm || h->unit_cm < b->header->unit_cm)) {
            return noh_fail(
                error, NOH_ERR_NOT_FOUND,
                "the clips' skeleton and the mesh's have different units: build both with one unit, or in one pack",
                noh_bank_where(at), 0);
        }
    }
    return NOH_OK;
}

static int has_same_joints(const noh_skeleton *a, const noh_skeleton *b)
{
    return a->joint_count == b->joint_count && !memcmp(a->parents, b->parents, a->joint_count * sizeof *a->parents);
}

int noh_bank_map_fits(const noh_clip_map *map, const noh_skeleton *skeleton)
{
    return map->source && map->target && map->pose && map->least <= map->target->joint_count &&
           has_same_joints(map->target, skeleton);
}

noh_result noh_bank_bind(const noh_clip_bank_desc *desc, noh_bank_binding *b, noh_error *error)
{
    noh_result r;
    memset(b, 0, sizeof *b);
    b->packs = desc->clips ? &desc->clips : desc->clip_packs;
    b->pack_count = desc->clips ? 1u : desc->clip_pack_count;
    b->mesh = desc->mesh ? desc->mesh : b->packs[0];
    b->sample_rate_needed = desc->sample_rate_needed;
    b->map = NOH_PAGE ? NULL : desc->map;
    r = bind_skeleton(desc->skeleton, b, error);
    for (uint32_t i = 0; !r && i < b->pack_count; i++) {
        r = check_units(b, i, error);
    }
    if (!NOH_PAGE && !r && b->map && !noh_bank_map_fits(b->map, &b->skeleton)) {
        return noh_fail(error, NOH_ERR_ARG,
                        "map of a clip bank is not whole, or its target is another skeleton than the bank's",
                        b->skeleton.joint_count, 0);
    }
    return r;
}

int noh_bank_same_skeletons(const noh_skeleton *a, const noh_skeleton *b)
{
    return has_same_joints(a, b) && !memcmp(a->bind_pose, b->bind_pose, a->joint_count * sizeof *a->bind_pose);
}

/* Whether the clip at found->at fits, and the desc to open it with. A clip without joints always fits. A clip with
 * joints fits the skeleton of the same hash; in the mesh's own pack, which may contain equal skeletons, it fits only
 * the one that it was built with. */
static int fits(const noh_bank_binding *b, noh_bank_found *found)
{
    const noh_pack *pack = b->packs[found->at.pack];
    noh_clip_desc *clip = &found->clip;
    noh_skeleton built_with;
    const noh_clip_header *h;
    (void)noh_pack_clip_at(pack, found->at.index, &found->packed, NULL);
    h = found->packed.header;
    clip->bytes = found->packed.bytes;
    clip->byte_count = h->clip_bytes;
    clip->joint_count = h->joint_count;
    clip->sample_rate_needed = b->sample_rate_needed;
    clip->bind = NULL;
    found->is_mapped = 0;
    if (h->joint_count == 0) {
        return 1;
    }
    if (noh_pack_skeleton_at(pack, h->skeleton, &built_with, NULL, NULL)) return 0;
    clip->bind = built_with.bind_pose;
    if (!b->header || h->skeleton_hash != b->header->hash || h->joint_count != b->header->joint_count ||
        (b->mesh == pack && h->skeleton != b->skeleton_index)) {
        found->is_mapped = !NOH_PAGE && b->map && noh_bank_same_skeletons(&built_with, b->map->source);
        return found->is_mapped;
    }
    return 1;
}

static uint32_t name_hash_at(const noh_bank_binding *b, noh_bank_place at)
{
    const noh_pack *pack = b->packs[at.pack];
    return pack->chunks[pack->runs[NOH_CHUNK_CLIP].first + at.index].name_hash;
}

/* Find the first clip of a pack that has this name and fits: without the map, or only through it. Returns 0 if there
 * is none. */
static int find_as(const noh_bank_binding *b, uint32_t pack, uint32_t name_hash, int is_mapped, noh_bank_found *found)
{
    noh_bank_place at = { pack, 0 };
    for (; at.index < b->packs[pack]->runs[NOH_CHUNK_CLIP].count; at.index++) {
        if (name_hash_at(b, at) == name_hash) {
            found->at = at;
            if (fits(b, found) && (NOH_PAGE || found->is_mapped == is_mapped)) return 1;
        }
    }
    return 0;
}

/* Find a pack's clip of a name; one of the skeleton itself comes before one that plays through the map. */
static int find_name(const noh_bank_binding *b, uint32_t pack, uint32_t name_hash, noh_bank_found *found)
{
    return find_as(b, pack, name_hash, 0, found) || (!NOH_PAGE && b->map && find_as(b, pack, name_hash, 1, found));
}

/* Whether a clip that plays through the map has its name from a clip of the skeleton itself in its pack. */
static int is_hidden(const noh_bank_binding *b, const noh_bank_found *found)
{
    noh_bank_found own;
    return !NOH_PAGE && found->is_mapped && find_as(b, found->at.pack, name_hash_at(b, found->at), 0, &own);
}

/* A clip replaces the clip of the same name in the first pack that has it, so an added pack renumbers no clip: a clip
 * that an earlier pack also has was numbered there. */
static int resolve(const noh_bank_binding *b, noh_bank_place at, noh_bank_found *found)
{
    const uint32_t name_hash = name_hash_at(b, at);
    for (uint32_t pack = 0; pack < at.pack; pack++) {
        if (find_name(b, pack, name_hash, found)) return 0;
    }
    for (uint32_t pack = b->pack_count; pack-- > at.pack + 1u;) {
        if (find_name(b, pack, name_hash, found)) return 1;
    }
    found->at = at;
    return fits(b, found);
}

int noh_bank_next_clip(const noh_bank_binding *b, noh_bank_place *next, noh_bank_found *found)
{
    while (next->pack < b->pack_count) {
        const noh_bank_place at = *next;
        if (at.index >= b->packs[at.pack]->runs[NOH_CHUNK_CLIP].count) {
            next->pack++;
            next->index = 0;
            continue;
        }
        next->index++;
        found->at = at;
        if (fits(b, found) && !is_hidden(b, found) && resolve(b, at, found)) return 1;
    }
    return 0;
}

uint32_t noh_bank_count_fitting(const noh_bank_binding *b)
{
    noh_bank_found found;
    uint32_t count = 0;
    for (found.at.pack = 0; found.at.pack < b->pack_count; found.at.pack++) {
        for (found.at.index = 0; found.at.index < b->packs[found.at.pack]->runs[NOH_CHUNK_CLIP].count;
             found.at.index++) {
            count += (uint32_t)fits(b, &found);
        }
    }
    return count;
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

/* Whether the build added the last target of a node's mesh, so that clips of other builds do not have it. */
static int has_added_target(const noh_bank_binding *b, uint32_t node)
{
    noh_mesh mesh;
    (void)noh_pack_mesh_at(b->mesh, b->mesh->nodes[node].mesh, &mesh, NULL);
    return noh_names_equal(noh_pack_string(b->mesh, mesh.targets[mesh.header->target_count - 1u].name),
                           NOH_BANK_ADDED_TARGET);
}

/* How well a node fits; 0: not. Nodes may share names. */
static int fit_of(const noh_bank_binding *b, const noh_clip_group *node, const noh_clip_group *wanted)
{
    const int is_same = noh_bank_same_group(node, wanted);
    if (!is_same &&
        (node->name_hash != wanted->name_hash || node->width != wanted->width + 1u || !has_added_target(b, node->node)))
        return 0;
    return 1 + 2 * is_same + (node->node == wanted->node);
}

int noh_bank_find_node(const noh_bank_binding *b, const noh_clip_group *wanted, noh_clip_group *found)
{
    noh_clip_group group;
    uint32_t node = 0, first = 0;
    int best = 0;
    while (noh_bank_next_node(b, &node, &first, &group)) {
        const int fit = fit_of(b, &group, wanted);
        if (fit > best) {
            *found = group;
            best = fit;
        }
    }
    return best > 0;
}

/* ---- named floats ---- */

#define NAMES_AT_ONCE 128u

/* Distinct named groups, in batches of the lowest keys: counting them all at once would need memory, and comparing each
 * with all previous ones would take quadratic time. */
typedef struct names {
    uint64_t after;               /* keys up to this one were counted in earlier batches */
    uint64_t keys[NAMES_AT_ONCE]; /* increasing: the name's hash above, the width below */
    uint32_t count;
} names;

static void keep_name(names *n, uint64_t key)
{
    uint32_t at = 0, end = n->count;
    while (at < end) {
        const uint32_t middle = at + (end - at) / 2u;
        if (n->keys[middle] < key) {
            at = middle + 1u;
        } else {
            end = middle;
        }
    }
    if (key <= n->after || at == NAMES_AT_ONCE || (at < n->count && n->keys[at] == key)) {
        return;
    }
    if (n->count < NAMES_AT_ONCE) n->keys[n->count++] = key;
    for (; at < n->count; at++) { /* larger keys move up; the highest drops out of a full batch */
        const uint64_t next = n->keys[at];
        n->keys[at] = key;
        key = next;
    }
}

static void collect_names(const noh_bank_binding *b, names *n)
{
    noh_bank_place next = { 0, 0 };
    noh_bank_found found;
    n->count = 0;
    while (noh_bank_next_clip(b, &next, &found)) {
        noh_clip_group_reader reader = noh_clip_groups_of(&found.clip);
        noh_clip_group group;
        while (noh_clip_next_group(&reader, &group)) {
            if (noh_bank_is_named(&group) && group.width) {
                keep_name(n, (uint64_t)group.name_hash << 32 | group.width);
            }
        }
    }
}

void noh_bank_count_names(const noh_bank_binding *b, uint32_t *group_count, uint32_t *float_count)
{
    names n;
    n.after = 0; /* below every key: no width is 0 */
    do {
        collect_names(b, &n);
        for (uint32_t i = 0; i < n.count; i++) {
            *float_count += (uint32_t)n.keys[i];
        }
        *group_count += n.count;
        n.after = n.count ? n.keys[n.count - 1u] : n.after;
    } while (n.count == NAMES_AT_ONCE);
}
