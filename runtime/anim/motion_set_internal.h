/* motion_set_internal.h (private to anim/): which clips fit, and which of the set's floats theirs are. */
#ifndef NOH_ANIM_MOTION_SET_INTERNAL_H
#define NOH_ANIM_MOTION_SET_INTERNAL_H

#include "anim/clip_internal.h"
#include "anim/motion_set.h"

/* A run of a clip's floats, and where it goes in the set's. */
typedef struct noh_motion_floats {
    uint16_t from, to, width;
} noh_motion_floats;

struct noh_motion_set_clip {
    const noh_motion_floats *floats; /* [float_runs] */
    uint32_t float_runs;
    uint32_t joint_count;
};

/* A desc, resolved. */
typedef struct noh_motion_binding {
    const noh_pack *clips, *mesh;
    noh_skeleton skeleton;               /* joint_count 0: none */
    const noh_skeleton_header *header;   /* NULL: none */
    uint32_t skeleton_index;
} noh_motion_binding;

noh_result noh_motion_bind(const noh_motion_set_desc *desc, noh_motion_binding *b, noh_error *error);

/* The n-th motion of the pack and how its clip is opened; 0 when it moves another skeleton. */
int noh_motion_fits(const noh_motion_binding *b, uint32_t index, noh_pack_motion *motion, noh_clip_desc *clip);

/* The next node with targets, from *node on, as a group of floats at *first; 0: there is none. Moves both on. */
int noh_motion_next_node(const noh_motion_binding *b, uint32_t *node, uint32_t *first, noh_clip_group *group);

/* The set's group that a clip's group of weights moves: the node of that index if it has the name, else the
 * first of that name and width. 0: none. */
int noh_motion_find_node(const noh_motion_binding *b, const noh_clip_group *wanted, noh_clip_group *found);

/* Whether a group is a named float that neither an earlier motion that fits nor this clip, before it, has. */
int noh_motion_is_new(const noh_motion_binding *b, uint32_t index, const noh_clip_desc *clip, const noh_clip_group *group);

static inline int noh_motion_is_named(const noh_clip_group *g)
{
    return g->node == NOH_NONE;
}

static inline int noh_motion_same_group(const noh_clip_group *a, const noh_clip_group *b)
{
    return a->name_hash == b->name_hash && a->width == b->width;
}

#endif
