/* clip_bank.h: the compressed clips of packs, joined to the controller.
 *
 * A clip bank holds everything that can move one skeleton and the morph weights of its pack: the clips that fit,
 * opened, with one cache of decoded segments. Over them it makes a noh_clip_set, bank->clips, which any number of
 * controllers play: the set is what controllers see (names, durations, keys, a function that samples), the bank is what
 * is behind it (packs, codec, cache). Skeleton and meshes may be in one pack and the clips in others: skeletons are
 * bound by hash, weights by the names of their nodes.
 *
 * Several packs of clips make one set, in their order: a game, what was added to it, what was mended since. A clip of a
 * later pack takes the place of a clip of the same name in an earlier one, if both fit; so a pack put at the end
 * replaces clips and adds others, and those that were there keep their index. Within one pack names are not compared.
 *
 * In each frame of a game call
 *   noh_clip_cache_begin_frame(bank->cache);                        once
 *   noh_controller_step(c, &bank->clips, ticks, fn, user);          per controller
 *   noh_clip_bank_prefetch(bank, c, ahead_ticks);                   per controller
 *   noh_clip_cache_work(bank->cache, budget);                       once: decodes ahead of need
 *   noh_controller_pose(c, &bank->clips, &scratch, pose, floats);   per controller
 * Without prefetch and work the poses are the same, but decoded when they are asked for.
 *
 * Floats: the morph weights of every node of the mesh pack that has targets, in node order and with that node's
 * defaults; then the named floats of the clips, in the order of their first occurrence, with default 0. `groups` says
 * where each lies; noh_clip_bank_mesh_weights finds those of a mesh. Floats that a clip does not move have their
 * defaults.
 *
 * Threads: stepping only reads the bank, so any threads may step, each its own controllers. begin_frame, prefetch and
 * work change the cache: one thread at a time, and no other call on the bank meanwhile. Calls that sample
 * (noh_controller_pose, _root_motion, _inertia_*, noh_graph_pose, noh_character_update...) change the cache too when
 * they are given &bank->clips: one thread. To pose on several threads give each a noh_clip_bank_view and pass
 * &view->clips instead:
 *   noh_controller_pose(c, &view->clips, &scratch, pose, floats);   per controller, with the thread's own view, scratch
 * The poses are the same bits. A view never changes the bank: what the cache lacks it decodes for itself alone, so
 * prefetch what plays. There is no lock inside; the caller orders work before posing and posing before the next frame.
 */
#ifndef NOH_BANK_CLIP_BANK_H
#define NOH_BANK_CLIP_BANK_H

#include "motion/clip/clip_view.h"
#include "motion/anim/controller.h"
#include "motion/clip/pack_clip.h"
#include "motion/anim/root_motion.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_clip_bank_desc {
    const noh_pack *clips; /* the pack whose clips are played; NULL where clip_packs has them */
    /* the pack whose skeleton and nodes they move; default (NULL) `clips`, or the first of clip_packs */
    const noh_pack *mesh;
    /* index in `mesh`, default 0. NOH_NONE, and any index in a pack without skeletons: only clips without joints */
    uint32_t skeleton;
    uint32_t cached_segment_count; /* segments that the cache holds; default (0): NOH_CLIP_CACHE_SEGMENTS_PER_TRACK for
                                    * each track that plays at once, instance_count times track_count, which is enough
                                    * to look ahead by a segment; never more than the clips have */
    uint32_t instance_count;       /* instances that play at once; default (0) 1 */
    uint32_t track_count;          /* tracks of each that play at once; default (0) 2, a cross-fade */
    uint32_t root_axes;            /* NOH_ROOT_* to extract from joint 0 as root motion; default (0) none */
    uint32_t root_up;              /* axis of the heading: 0 x, 1 y, 2 z; not used without root_axes */
    /* [clip_pack_count] instead of `clips`, where there are several: none NULL; both arrays borrowed until the bank is
     * made */
    const noh_pack *const *clip_packs;
    uint32_t clip_pack_count; /* 0 with `clips` */
    /* frames per second that are enough: clips of twice as many take half of the cache and less time (clip_codec.h);
     * default (0) all */
    uint32_t sample_rate_enough;
} noh_clip_bank_desc;

/* What is known before there is memory: the bytes, and counts to size the rest by. */
typedef struct noh_clip_bank_needs {
    size_t bytes;                  /* of the bank: noh_clip_bank_size */
    size_t view_bytes;             /* of each view: noh_clip_bank_view_size */
    noh_clip_set shape;            /* counts only, for noh_controller_size and noh_pose_scratch_size */
    uint32_t cached_segment_count; /* segments that the cache will hold */
    uint32_t segment_count;        /* segments of all clips */
    uint32_t foreign_count;        /* clips of the packs that move another skeleton and are left out */
    uint32_t replaced_count;       /* clips left out for one of the same name in a later pack */
} noh_clip_bank_needs;

typedef struct noh_clip_bank {
    /* the set, for noh_controller_*; fill in masks and mask_count, if any, before controllers and views are made */
    noh_clip_set clips;
    noh_skeleton skeleton; /* of the mesh pack; joint_count 0 without one */
    noh_clip_cache *cache; /* its clip i is clip i of the set */
    /* [group_count] of the set's floats; `node` is one of the mesh pack, NOH_NONE for a named float */
    const noh_clip_group *groups;
    const uint32_t *packs;      /* [clips.clip_count] the pack of each: an index into clip_packs; 0 with `clips` */
    const uint32_t *pack_clips; /* [clips.clip_count] index of each in its pack, for noh_pack_clip_at */
    uint32_t group_count;
    uint32_t foreign_count, replaced_count; /* as above */
    uint32_t unknown_count; /* groups of weights in the clips for which the mesh pack has no node: not played */
    const noh_node *nodes;  /* private: of the mesh pack */
    const struct noh_bank_clip *bound; /* [clips.clip_count] private */
    float *sampled;                    /* private: the floats of one clip */
    uint32_t sampled_count;            /* private */
} noh_clip_bank;

/* Check a desc and the headers of all clips; find which clips fit and how large everything will be.
 * errors  as noh_clip_bank_init, without those of memory */
noh_result noh_clip_bank_measure(const noh_clip_bank_desc *desc, noh_clip_bank_needs *needs, noh_error *error);

/* Exact bytes of a bank with its clips and its cache; 0 on error. */
size_t noh_clip_bank_size(const noh_clip_bank_desc *desc, noh_error *error);

/* Make a bank in memory[bytes], aligned to NOH_MEMORY_ALIGN. The packs' bytes must outlive it.
 * errors  ARG a field of desc, named, or memory NULL or misaligned; MEMORY need: the bytes;
 *         NOT_FOUND the packs have no clip that fits: all have joints, and of another skeleton (need: how many), or
 *         their skeleton has another unit (where: the skeleton);
 *         DATA a clip is broken, or its keys or markers lie outside it (where: the clip);
 *         LIMIT a clip longer than NOH_DURATION_MAX (where: the clip), more clips than NOH_CLIP_CACHE_CLIPS_MAX or
 *         floats than NOH_FLOATS_MAX.
 *         `where` is an index in a pack, plus 2^32 times the index of that pack in clip_packs */
noh_result noh_clip_bank_init(void *memory, size_t bytes, const noh_clip_bank_desc *desc, noh_clip_bank **bank,
                              noh_error *error);

/* The index of the clip of that name; NOH_NONE when there is none. */
uint32_t noh_clip_bank_find(const noh_clip_bank *bank, const char *name);

/* Whether a clip moves the floats of a group. Where it does not, they have their defaults. */
int noh_clip_bank_moves(const noh_clip_bank *bank, uint32_t index, uint32_t group);

/* Whether a controller moves the floats of a group: some track of it that is on, at any weight, plays a clip that does.
 * A game that sets the weights of a face itself keeps its own where this is 0, and takes those of the pose where it is
 * not.
 * ranges   a controller of the bank's set */
int noh_clip_bank_controller_moves(const noh_clip_bank *bank, const noh_controller *controller, uint32_t group);

/* The group of a node's morph weights, or of those of the first node that draws a mesh; NOH_NONE when that has no
 * targets or the mesh pack has no such node. */
uint32_t noh_clip_bank_node_group(const noh_clip_bank *bank, uint32_t node);
uint32_t noh_clip_bank_mesh_group(const noh_clip_bank *bank, uint32_t mesh);

/* The morph weights of a mesh among the floats of a pose: those of the first node that draws it. noh_morph_accumulate
 * and noh_gl_morph_set_weights take them.
 * shapes   floats[clips.float_count] of a pose; the result [the mesh's target_count] lies in floats
 * returns  NULL where noh_clip_bank_mesh_group is NOH_NONE: the mesh keeps its defaults */
const float *noh_clip_bank_mesh_weights(const noh_clip_bank *bank, const float *floats, uint32_t mesh);

/* Ask the cache for all that a controller's tracks need, now and within the next ahead_ticks if they play on as they
 * do: position, playback speed, loop mode, joints of its LOD level. That includes tracks whose weight is still 0.
 * Decodes nothing.
 * ranges   ahead_ticks up to 2^31; the cache should have room for every segment within them
 * returns  how many segments found no room in this frame and will be decoded late */
uint32_t noh_clip_bank_prefetch(noh_clip_bank *bank, const noh_controller *controller, uint32_t ahead_ticks);

/* ---- several threads ---- */

/* What one thread poses with. */
typedef struct noh_clip_bank_view {
    noh_clip_set clips; /* a copy of bank->clips that samples through this view */
    const noh_clip_bank *bank;
    noh_clip_view *samples; /* noh_clip_view_stats_of says what it decoded late */
    float *sampled;         /* private: the floats of one clip */
} noh_clip_bank_view;

/* Exact bytes of a view: two segments, and the floats of a clip. */
size_t noh_clip_bank_view_size(const noh_clip_bank *bank);

/* Make a view in memory[bytes], aligned to NOH_MEMORY_ALIGN. The bank must outlive it; its masks are taken as they are
 * now.
 * errors  ARG memory NULL or misaligned; MEMORY need: the bytes */
noh_result noh_clip_bank_view_init(void *memory, size_t bytes, const noh_clip_bank *bank, noh_clip_bank_view **view,
                                   noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
