/* clip_bank_bind_internal.h (private to bank/): matches the clips of packs with a skeleton and the nodes of a mesh
 * pack. Reads only the packs' bytes, so that sizes are known before any memory is allocated. */
#ifndef NOH_BANK_CLIP_BANK_BIND_INTERNAL_H
#define NOH_BANK_CLIP_BANK_BIND_INTERNAL_H

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_motion.h"
#include "noh/pack.h"
#include "motion/clip/clip_internal.h"

/* The name of a mesh's last target if `noh build` added it to the file's own: clips of other builds lack it. */
#define NOH_BANK_ADDED_TARGET "lipToTeeth"

typedef struct noh_bank_binding {
    const noh_pack *const *packs; /* [pack_count] packs of clips */
    uint32_t pack_count;
    const noh_pack *mesh;
    noh_skeleton skeleton;             /* joint_count 0: none */
    const noh_skeleton_header *header; /* NULL: none */
    uint32_t skeleton_index;
    uint32_t sample_rate_needed;
    const noh_clip_map *map; /* NULL: none */
} noh_bank_binding;

/* A clip: its pack, and its index there. */
typedef struct noh_bank_place {
    uint32_t pack, index;
} noh_bank_place;

/* The place as reported in errors. */
static inline uint64_t noh_bank_where(noh_bank_place at)
{
    return (uint64_t)at.pack << 32 | at.index;
}

/* A clip of the bank: its place, and the desc to open it with. */
typedef struct noh_bank_found {
    noh_bank_place at;
    noh_pack_clip packed;
    noh_clip_desc clip;
    int is_mapped;
} noh_bank_found;

/* Bind the clips of desc's packs to its skeleton.
 * errors  ARG skeleton, or map; NOT_FOUND the clips' skeleton has another unit (where: its place) */
noh_result noh_bank_bind(const noh_clip_bank_desc *desc, noh_bank_binding *b, noh_error *error);

/* Get the next clip of the bank, from *next on, which starts as zeros. Advances *next; returns 0 if there is none. A
 * clip is replaced by one of the same name in a later pack, and in its own pack one that plays through the map by one
 * that does not. */
int noh_bank_next_clip(const noh_bank_binding *b, noh_bank_place *next, noh_bank_found *found);

/* Count the clips of all packs that fit, including replaced ones. */
uint32_t noh_bank_count_fitting(const noh_bank_binding *b);

/* Get the next node with targets, from *node on, as a group of floats at *first. Advances both; returns 0 if there is
 * none. */
int noh_bank_next_node(const noh_bank_binding *b, uint32_t *node, uint32_t *first, noh_clip_group *group);

/* Find the bank's group that a clip's group of weights moves: the node of the same index if it has the same name and
 * width, else the first node that has, else one of the same name with NOH_BANK_ADDED_TARGET as one more, last target,
 * which keeps its default. Returns 0 if there is none. */
int noh_bank_find_node(const noh_bank_binding *b, const noh_clip_group *wanted, noh_clip_group *found);

/* Count the named groups of the bank's clips, equal names and widths once, and their floats; adds to both counts. The
 * clips were checked. */
void noh_bank_count_names(const noh_bank_binding *b, uint32_t *group_count, uint32_t *float_count);

static inline int noh_bank_is_named(const noh_clip_group *g)
{
    return g->node == NOH_NONE;
}

static inline int noh_bank_same_group(const noh_clip_group *a, const noh_clip_group *b)
{
    return a->name_hash == b->name_hash && a->width == b->width;
}

#endif
