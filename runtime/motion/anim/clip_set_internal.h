/* clip_set_internal.h (private to anim/, graph/ and character/): the counts of a set that determine the sizes of other
 * objects; reference poses of additive clips. */
#ifndef NOH_ANIM_CLIP_SET_INTERNAL_H
#define NOH_ANIM_CLIP_SET_INTERNAL_H

#include "core/base/compiler_internal.h"
#include "noh/clip.h"

/* A clip of a reserve. */
typedef struct noh_reserved_clip {
    uint32_t at, bytes; /* where in the reserve, and how many, a multiple of 16; 0: none */
    uint32_t used;      /* the reserve's clock when it was last used */
    uint32_t absent;    /* 1: its bytes are not in memory */
} noh_reserved_clip;

/* The bytes of the clips that are in memory, one after another without gaps (bank/clip_bank_reserve.c). */
typedef struct noh_clip_reserve {
    uint8_t *bytes; /* [room] */
    uint32_t room, filled;
    uint32_t clock, clip_count;
    noh_reserved_clip *clips; /* [clip_count] of the bank */
    uint32_t *event_names;    /* [event_count of the set] offsets in the strings of their packs */
} noh_clip_reserve;

/* Test whether a clip cannot be played. Clips past a bank's own are the caller's. */
static inline int noh_clip_is_absent(const noh_clip_set *set, uint32_t clip)
{
    return !NOH_PAGE && set->reserve && clip < set->reserve->clip_count && set->reserve->clips[clip].absent;
}

/* Get a mask of a set as blending takes it: index 0 is no mask, n is the set's mask n - 1. */
noh_mask_view noh_clip_set_mask(const noh_clip_set *set, uint32_t index);

/* Get a message if joints or floats exceed a limit, else NULL: products of either with a struct's size then fit in 32
 * bits. */
const char *noh_clip_set_excess(const noh_clip_set *set);

/* Get the reference pose that a clip is added from (controller_pose.c).
 * clip       index in the set: one of another skeleton has that skeleton's bind pose
 * reference  0: the bind pose and the floats' defaults; else 1 + index of the clip whose first frame it is; joints and
 *            floats that this one does not animate are as for 0
 * shapes     pose[joint_count], floats[the set's float_count] */
void noh_reference_pose(const noh_clip_set *set, uint32_t clip, uint32_t reference, uint32_t joint_count,
                        noh_transform *pose, float *floats);

#endif
