/* clip_bank.h: the compressed clips of a pack, joined to the controller.
 *
 * A clip bank is all that one skeleton and the morph weights of its pack can be moved by: the clips that fit, opened,
 * with one cache of decoded segments, and a noh_clip_set over them that any number of controllers play. Skeleton and
 * meshes may be in one pack and the clips in another: skeletons are bound by hash, weights by the names of their nodes.
 *
 * A frame of a game:
 *   noh_clip_cache_begin_frame(set->cache);                               once
 *   noh_controller_step(c, &set->clips, ticks, fn, user);           per controller
 *   noh_clip_bank_prefetch(set, c, ahead_ticks);                     per controller
 *   noh_clip_cache_work(set->cache, budget);                       once: decodes ahead of need
 *   noh_controller_pose(c, &set->clips, &scratch, pose, floats);    per controller
 * Without the third and fourth line the same poses come out, decoded when they are asked for.
 *
 * Threads: stepping only reads the set, so any threads may step, each its own controllers. tick, ahead and work change
 * the cache: one thread at a time, and no other call on the set meanwhile. Whatever samples (noh_controller_pose,
 * _root_motion, _inertia_*, noh_graph_pose, noh_character_update...) changes the cache too when it is given
 * &set->clips: one thread. On several threads give each a noh_clip_bank_view and hand those calls &view->clips instead:
 *   noh_controller_pose(c, &view->clips, &scratch, pose, floats);   per controller, on any thread with its own view and
 * scratch The poses are the same bits. A view never changes the set: what the cache lacks it decodes for itself alone,
 * so ask ahead for what plays. Nothing here locks; the caller orders work before posing and posing before the next
 * tick.
 *
 * Floats: the morph weights of every node of the mesh pack that has targets, in node order and with that node's
 * defaults; then the named floats of the clips, in the order in which they first come, with default 0. `groups` says
 * which is where; noh_clip_bank_mesh_weights finds those of a mesh. What a clip does not move has its default. */
#ifndef NOH_BANK_CLIP_BANK_H
#define NOH_BANK_CLIP_BANK_H

#include "clip/clip_view.h"
#include "anim/controller.h"
#include "clip/pack_clip.h"
#include "anim/root_motion.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_clip_bank_desc {
    const noh_pack *clips; /* that are played; required */
    const noh_pack *mesh;  /* whose skeleton and nodes are moved; default (NULL) `clips` */
    /* index in `mesh`, default 0; NOH_NONE, and any in a pack without skeletons: only clips of floats */
    uint32_t skeleton;
    uint32_t cached_segment_count; /* segments that the cache holds; default (0) from the next two:
                                    * NOH_CLIP_CACHE_SEGMENTS_PER_TRACK for each track that plays at once, which is
                                    * enough to look ahead by a segment; never more than there are */
    uint32_t instance_count;       /* instances that play at once; default (0) 1 */
    uint32_t track_count;          /* tracks of each that play at once; default (0) 2, a cross-fade */
    uint32_t root_axes;            /* NOH_ROOT_* to take out of joint 0 as root motion; default (0) none */
    uint32_t root_up;              /* axis of the heading: 0 x, 1 y, 2 z; read only with root_axes */
} noh_clip_bank_desc;

/* Before there is memory: the bytes, and counts to size the rest by. */
typedef struct noh_clip_bank_needs {
    size_t bytes;                  /* what noh_clip_bank_size says */
    size_t view_bytes;             /* what noh_clip_bank_view_size will say */
    noh_clip_set shape;            /* counts only, for noh_controller_size and noh_pose_scratch_size */
    uint32_t cached_segment_count; /* segments that the cache will hold, */
    uint32_t segment_count;        /* of so many in all clips */
    uint32_t foreign_count;        /* clips of the pack that move another skeleton: they are left out */
} noh_clip_bank_needs;

typedef struct noh_clip_bank {
    /* for noh_controller_*; masks and mask_count may be set before controllers and views are made */
    noh_clip_set clips;
    noh_skeleton skeleton; /* of the mesh pack; joint_count 0 without one */
    noh_clip_cache *cache; /* its clip i is clip i of `anim` */
    /* [group_count] of the set's floats; `node` is one of the mesh pack, NOH_NONE for a named float */
    const noh_clip_group *groups;
    const uint32_t *pack_clips; /* [anim.clip_count] index of each in the clips' pack, for noh_pack_clip_at */
    uint32_t group_count;
    uint32_t foreign_count; /* as above */
    uint32_t unknown_count; /* groups of weights in the clips for which the mesh pack has no node: not played */
    const noh_node *nodes;  /* private: of the mesh pack */
    const struct noh_bank_clip *bound; /* [anim.clip_count] private */
    float *sampled;                    /* private: the floats of one clip */
    uint32_t sampled_count;            /* private */
} noh_clip_bank;

/* Check a desc and the headers of all clips; which clips the set will take and how large its poses are.
 * errors  as noh_clip_bank_init, but for the memory's */
noh_result noh_clip_bank_measure(const noh_clip_bank_desc *desc, noh_clip_bank_needs *needs, noh_error *error);

/* Exact bytes of a set with its clips and its cache; 0 on error. */
size_t noh_clip_bank_size(const noh_clip_bank_desc *desc, noh_error *error);

/* Bind, open and join, in memory[bytes], 16-byte aligned. The packs' bytes must outlive the set.
 * errors  ARG a field of desc, named, or memory NULL or misaligned; MEMORY need: the bytes;
 *         NOT_FOUND the pack has no clips, or none without joints or for this skeleton (need: how many move
 *         another one), or its skeleton has another unit (where: the skeleton's index in the clips' pack);
 *         DATA a clip is broken, its keys or markers lie outside it (where: the clip's index in the pack);
 *         LIMIT a clip longer than NOH_DURATION_MAX, more than NOH_FLOATS_MAX floats */
noh_result noh_clip_bank_init(void *memory, size_t bytes, const noh_clip_bank_desc *desc, noh_clip_bank **set,
                              noh_error *error);

/* The index of the clip of that name; NOH_NONE when there is none. */
uint32_t noh_clip_bank_find(const noh_clip_bank *set, const char *name);

/* Whether a clip moves the floats of a group; those of others keep their defaults in it. */
int noh_clip_bank_moves(const noh_clip_bank *set, uint32_t index, uint32_t group);

/* The group of a node's morph weights, or of those of the first node that draws a mesh; NOH_NONE when it has no targets
 * or the mesh pack has no such node. */
uint32_t noh_clip_bank_node_group(const noh_clip_bank *set, uint32_t node);
uint32_t noh_clip_bank_mesh_group(const noh_clip_bank *set, uint32_t mesh);

/* The morph weights of a mesh among the floats of a pose: those of the first node that draws it. Hand them to
 * noh_gl_morph_set_weights or noh_morph_accumulate.
 * shapes   floats[anim.float_count] of a pose; the result [the mesh's target_count], inside floats
 * returns  NULL as noh_clip_bank_mesh_group: the mesh keeps its defaults */
const float *noh_clip_bank_mesh_weights(const noh_clip_bank *set, const float *floats, uint32_t mesh);

/* Ask the cache for all that the controller's tracks need to be posed now and within the next ahead_ticks as they play
 * now: position, playback speed, direction, loop mode, joints of its LOD level. Tracks that do not weigh anything yet
 * are asked for too. Decodes nothing. ranges   ahead_ticks up to 2^31; the cache should have room for each segment that
 * lies there returns  how many segments found no room in this frame: they will be decoded late */
uint32_t noh_clip_bank_prefetch(noh_clip_bank *set, const noh_controller *controller, uint32_t ahead_ticks);

/* ---- several threads ---- */

/* What one thread poses through. */
typedef struct noh_clip_bank_view {
    noh_clip_set clips; /* a copy of the set's that samples through this view */
    const noh_clip_bank *set;
    noh_clip_view *samples; /* noh_clip_view_stats_of says what it decoded late */
    float *sampled;         /* private: the floats of one clip */
} noh_clip_bank_view;

/* Exact bytes of a view: two segments, and the floats of a clip. */
size_t noh_clip_bank_view_size(const noh_clip_bank *set);

/* Make a view in memory[bytes], 16-byte aligned. The set must outlive it; its masks are taken as they are now.
 * errors  ARG memory NULL or misaligned; MEMORY need: the bytes */
noh_result noh_clip_bank_view_init(void *memory, size_t bytes, const noh_clip_bank *set, noh_clip_bank_view **view,
                                   noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
