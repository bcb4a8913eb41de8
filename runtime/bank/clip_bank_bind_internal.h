/* clip_bank_bind_internal.h (private to bank/): which clips of a pack fit a skeleton and the nodes of a mesh pack.
 * Reads only the packs' bytes, so that sizes are known before there is memory. */
#ifndef NOH_BANK_CLIP_BANK_BIND_INTERNAL_H
#define NOH_BANK_CLIP_BANK_BIND_INTERNAL_H

#include "clip/clip_internal.h"
#include "clip/pack_clip.h"

typedef struct noh_bank_binding {
    const noh_pack *clips, *mesh;
    noh_skeleton skeleton;             /* joint_count 0: none */
    const noh_skeleton_header *header; /* NULL: none */
    uint32_t skeleton_index;
} noh_bank_binding;

/* Bind clips to the skeleton of that index in `mesh`; NOH_NONE, or any in a pack without skeletons: none.
 * errors  ARG skeleton; NOT_FOUND the clips' skeleton has another unit (where: its index in their pack) */
noh_result noh_bank_bind(const noh_pack *clips, const noh_pack *mesh, uint32_t skeleton, noh_bank_binding *b,
                         noh_error *error);

/* The n-th clip of the pack and the desc that opens it; returns 0 when it moves another skeleton. */
int noh_bank_fits(const noh_bank_binding *b, uint32_t index, noh_pack_clip *packed, noh_clip_desc *clip);

/* The next node with targets, from *node on, as a group of floats at *first. Advances both; returns 0 when there is
 * none. */
int noh_bank_next_node(const noh_bank_binding *b, uint32_t *node, uint32_t *first, noh_clip_group *group);

/* The bank's group that a clip's group of weights moves: that of the node of the same index if it has the name and
 * width, else the first of that name and width. Returns 0 when there is none. */
int noh_bank_find_node(const noh_bank_binding *b, const noh_clip_group *wanted, noh_clip_group *found);

/* Whether a group is a named float that occurs here first: no earlier clip that fits has it, nor this one before. */
int noh_bank_is_new(const noh_bank_binding *b, uint32_t index, const noh_clip_desc *clip, const noh_clip_group *group);

static inline int noh_bank_is_named(const noh_clip_group *g)
{
    return g->node == NOH_NONE;
}

static inline int noh_bank_same_group(const noh_clip_group *a, const noh_clip_group *b)
{
    return a->name_hash == b->name_hash && a->width == b->width;
}

#endif
