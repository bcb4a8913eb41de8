/* motion_set.h: the compressed clips of a pack, joined to the controller (rows C4.1, C4.4).
 *
 * A motion set is all that one skeleton and the morph weights of its pack can be moved by: the
 * clips that fit, opened, with one cache of decoded segments, and a noh_anim_set over them
 * that any number of controllers play. Skeleton and meshes may be in one pack and the
 * clips in another: skeletons are bound by hash, weights by the names of their nodes.
 *
 * A frame of a game:
 *   noh_clip_cache_tick(set->cache);                               once
 *   noh_controller_step(c, &set->anim, ticks, fn, user);           per controller
 *   noh_motion_set_ahead(set, c, ahead_ticks);                     per controller
 *   noh_clip_cache_work(set->cache, budget);                       once: decodes ahead of need
 *   noh_controller_pose(c, &set->anim, &scratch, pose, floats);    per controller
 * Without the third and fourth line the same poses come out, decoded when they are asked for.
 *
 * Floats: the morph weights of every node of the mesh pack that has targets, in node order and with
 * that node's defaults; then the named floats of the clips, in the order in which they first
 * come, with default 0. `groups` says which is where. What a clip does not move has its default. */
#ifndef NOH_ANIM_MOTION_SET_H
#define NOH_ANIM_MOTION_SET_H

#include "anim/clip_cache.h"
#include "anim/controller.h"
#include "anim/pack_motion.h"
#include "anim/root_motion.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_motion_set_desc {
    const noh_pack *clips;  /* whose motion is played; required */
    const noh_pack *mesh;   /* whose skeleton and nodes are moved; default (NULL) `clips` */
    uint32_t skeleton;      /* index in `mesh`, default 0; NOH_NONE, and any in a pack without skeletons: only clips of floats */
    uint32_t slot_count;    /* segments that the cache holds; default (0) two per clip */
    uint32_t root_axes;     /* NOH_ROOT_* to take out of joint 0 as root motion; default (0) none */
    uint32_t root_up;       /* axis of the heading: 0 x, 1 y, 2 z; read only with root_axes */
} noh_motion_set_desc;

/* Before there is memory: the bytes, and counts to size the rest by. */
typedef struct noh_motion_set_needs {
    size_t bytes;          /* what noh_motion_set_size says */
    noh_anim_set shape;    /* counts alone, for noh_controller_size and noh_pose_scratch_size */
    uint32_t foreign_count; /* motions of the pack that move another skeleton: they are left out */
} noh_motion_set_needs;

typedef struct noh_motion_set {
    noh_anim_set anim;            /* for noh_controller_*; masks and mask_count may be set before controllers are made */
    noh_skeleton skeleton;        /* of the mesh pack; joint_count 0 without one */
    noh_clip_cache *cache;        /* its clip i is motion i */
    const noh_clip_group *groups; /* [group_count] of the set's floats; `node` is one of the mesh pack, NOH_NONE for a named float */
    const uint32_t *pack_motions; /* [anim.motion_count] index of each in the clips' pack, for noh_pack_motion_at */
    uint32_t group_count;
    uint32_t foreign_count;       /* as above */
    uint32_t unknown_count;       /* groups of weights in the clips for which the mesh pack has no node: not played */
    const struct noh_motion_set_clip *clips; /* [anim.motion_count] private */
    float *sampled;                          /* private: the floats of one clip */
} noh_motion_set;

/* Check a desc and the headers of all clips; what a set will take and how large its poses are.
 * errors  as noh_motion_set_init, but for MEMORY */
noh_result noh_motion_set_measure(const noh_motion_set_desc *desc, noh_motion_set_needs *needs, noh_error *error);

/* Exact bytes of a set with its clips and its cache; 0 on error. */
size_t noh_motion_set_size(const noh_motion_set_desc *desc, noh_error *error);

/* Bind, open and join, in memory[bytes], 16-byte aligned. The packs' bytes must outlive the set.
 * errors  ARG a field of desc, named; MEMORY need: the bytes;
 *         NOT_FOUND the pack has no clips, or none without joints or for this skeleton (need: how many move
 *         another one), or its skeleton has another unit (where: the skeleton's index in the clips' pack);
 *         DATA a clip is broken, its keys or markers lie outside it (where: the motion's index in the pack);
 *         LIMIT a clip longer than NOH_DURATION_MAX, more than NOH_FLOATS_MAX floats */
noh_result noh_motion_set_init(void *memory, size_t bytes, const noh_motion_set_desc *desc, noh_motion_set **set, noh_error *error);

/* The motion of that name; anim.motion_count when there is none. */
uint32_t noh_motion_set_find(const noh_motion_set *set, const char *name);

/* Whether a motion moves the floats of a group; those of others keep their defaults in it. */
int noh_motion_set_moves(const noh_motion_set *set, uint32_t motion, uint32_t group);

/* Ask the cache for all that the controller's tracks need to be posed now and within the next
 * ahead_ticks as they play now: position, rate, direction, loop mode, joints of its detail. Tracks
 * that do not weigh anything yet are asked for too. Costs no decoding.
 * ranges  ahead_ticks up to 2^31; a slot for each segment that lies there
 * returns for how many segments no slot is left in this frame: they will be decoded late */
uint32_t noh_motion_set_ahead(noh_motion_set *set, const noh_controller *controller, uint32_t ahead_ticks);

#ifdef __cplusplus
}
#endif

#endif
