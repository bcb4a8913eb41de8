/* clip_bank.h: the compressed clips of packs, ready for controllers to play.
 *
 * A clip bank holds everything that can move one skeleton and the morph weights of its pack: the clips that fit,
 * opened, with one cache of decoded segments. Its noh_clip_set, bank->clips, serves any number of controllers.
 * Controllers see only the set (names, durations, keys, a sample function); packs, codec and cache stay behind it.
 * Skeleton and meshes may be in one pack and the clips in others: skeletons are matched by hash, morph weights by node
 * name.
 *
 * Several packs of clips make one set, in order: a base game, its additions, its patches. A clip in a later pack
 * replaces a clip of the same name in an earlier pack, if both fit. Appending a pack replaces or adds clips; existing
 * clips keep their index. Names are not compared within one pack.
 *
 * In each frame of a game call
 *   noh_clip_cache_begin_frame(bank->cache);                        once
 *   noh_controller_step(c, &bank->clips, ticks, fn, user);          per controller
 *   noh_clip_bank_prefetch(bank, c, ahead_ticks);                   per controller
 *   noh_clip_cache_work(bank->cache, budget);                       once: decodes ahead of need
 *   noh_controller_pose(c, &bank->clips, &scratch, pose, floats);   per controller
 * Without prefetch and work the poses are the same, but decoded when they are sampled.
 *
 * Floats: first the morph weights of every node of the mesh pack that has targets, in node order, with the node's
 * defaults; then the named floats of the clips, in order of first occurrence, with default 0. `groups` lists the
 * position of each; noh_clip_bank_mesh_weights finds the weights of a mesh. Floats that a clip does not move have their
 * defaults.
 *
 * Threads: stepping only reads the bank, so any thread may step its own controllers. begin_frame, prefetch and work
 * change the cache: call them on one thread, with no other call on the bank at the same time. Calls that sample
 * (noh_controller_pose, _root_motion, _inertia_*, noh_graph_pose, noh_character_update...) also change the cache when
 * passed &bank->clips: one thread only. To pose on several threads, give each thread a noh_clip_bank_view and pass
 * &view->clips instead:
 *   noh_controller_pose(c, &view->clips, &scratch, pose, floats);   per controller, with the thread's own view, scratch
 * The poses are bit-identical. A view never changes the bank: it decodes missing segments for itself only, so prefetch
 * what plays. There is no lock; the caller orders work before posing, and posing before the next frame. */
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
    const noh_pack *clips; /* the pack whose clips are played; NULL if clip_packs is set */
    /* the pack with the skeleton and nodes that the clips move; default (NULL) `clips`, or the first of clip_packs */
    const noh_pack *mesh;
    /* index in `mesh`, default 0. NOH_NONE, or any index in a pack without skeletons: only clips without joints */
    uint32_t skeleton;
    /* segments that the cache holds; default (0): NOH_CLIP_CACHE_SEGMENTS_PER_TRACK for each of instance_count *
     * track_count tracks, enough to look ahead by one segment; never more than the clips have */
    uint32_t cached_segment_count;
    uint32_t instance_count; /* instances that play at the same time; default (0) 1 */
    uint32_t track_count;    /* tracks of each that play at the same time; default (0) 2, a cross-fade */
    uint32_t root_axes;      /* NOH_ROOT_* to extract from joint 0 as root motion; default (0) none */
    uint32_t root_up;        /* axis of the heading: 0 x, 1 y, 2 z; unused without root_axes */
    /* [clip_pack_count] several packs instead of `clips`, none NULL; both arrays are borrowed until the bank is made */
    const noh_pack *const *clip_packs;
    uint32_t clip_pack_count; /* 0 with `clips` */
    /* sample rate, in frames per second, that suffices: clips with at least twice this rate use half the cache and less
     * time (clip_codec.h); default (0) the full rate */
    uint32_t sample_rate_enough;
} noh_clip_bank_desc;

/* Sizes and counts, known before any memory is allocated. */
typedef struct noh_clip_bank_needs {
    size_t bytes;                  /* of the bank: noh_clip_bank_size */
    size_t view_bytes;             /* of each view: noh_clip_bank_view_size */
    noh_clip_set shape;            /* counts only, for noh_controller_size and noh_pose_scratch_size */
    uint32_t cached_segment_count; /* segments that the cache will hold */
    uint32_t segment_count;        /* segments of all clips */
    uint32_t foreign_count;        /* clips left out because they move another skeleton */
    uint32_t replaced_count;       /* clips left out because a later pack has one of the same name */
} noh_clip_bank_needs;

typedef struct noh_clip_bank {
    /* the set, for noh_controller_*; fill in masks and mask_count, if any, before making controllers and views */
    noh_clip_set clips;
    noh_skeleton skeleton; /* of the mesh pack; joint_count 0 without one */
    noh_clip_cache *cache; /* clip i of the cache is clip i of the set */
    /* [group_count] groups of the set's floats; `node` is a node of the mesh pack, NOH_NONE for a named float */
    const noh_clip_group *groups;
    const uint32_t *packs;      /* [clips.clip_count] the pack of each clip: an index in clip_packs; 0 with `clips` */
    const uint32_t *pack_clips; /* [clips.clip_count] index of each clip in its pack, for noh_pack_clip_at */
    uint32_t group_count;
    uint32_t foreign_count, replaced_count; /* as above */
    uint32_t unknown_count; /* weight groups of the clips without a matching node in the mesh pack: not played */
    const noh_node *nodes;  /* private: of the mesh pack */
    const struct noh_bank_clip *bound; /* [clips.clip_count] private */
    float *sampled;                    /* private: the floats of one clip */
    uint32_t sampled_count;            /* private */
} noh_clip_bank;

/* Check a desc and the headers of all clips; find the clips that fit and all sizes.
 * errors  as noh_clip_bank_init, except for memory */
noh_result noh_clip_bank_measure(const noh_clip_bank_desc *desc, noh_clip_bank_needs *needs, noh_error *error);

/* Exact size of a bank in bytes, including its clips and cache; 0 on error. */
size_t noh_clip_bank_size(const noh_clip_bank_desc *desc, noh_error *error);

/* Make a bank in memory[bytes], aligned to NOH_MEMORY_ALIGN. The packs' bytes must outlive it.
 * errors  ARG a field of desc, named, or memory NULL or misaligned; MEMORY need: the bytes;
 *         NOT_FOUND no clip fits: all have joints of another skeleton (need: their count), or of one in another unit
 *         (where: the skeleton);
 *         DATA a clip is broken, or its keys or markers lie outside it (where: the clip);
 *         LIMIT a clip longer than NOH_DURATION_MAX (where: the clip), more clips than NOH_CLIP_CACHE_CLIPS_MAX, or
 *         more floats than NOH_FLOATS_MAX.
 *         `where` is an index in a pack, plus 2^32 times the pack's index in clip_packs */
noh_result noh_clip_bank_init(void *memory, size_t bytes, const noh_clip_bank_desc *desc, noh_clip_bank **bank,
                              noh_error *error);

/* Find a clip by name.
 * returns  its index, or NOH_NONE */
uint32_t noh_clip_bank_find(const noh_clip_bank *bank, const char *name);

/* Test whether a clip moves the floats of a group. If not, they have their defaults. */
int noh_clip_bank_moves(const noh_clip_bank *bank, uint32_t index, uint32_t group);

/* Test whether a controller moves the floats of a group: whether some track that is on, at any weight, plays a clip
 * that moves them. A game that sets face weights itself keeps its own if this is 0, and uses the pose's if it is 1.
 * ranges   a controller of the bank's set */
int noh_clip_bank_controller_moves(const noh_clip_bank *bank, const noh_controller *controller, uint32_t group);

/* Get the float group with the morph weights of a node, or of the first node that draws a mesh.
 * returns  NOH_NONE if that node has no targets or does not exist */
uint32_t noh_clip_bank_node_group(const noh_clip_bank *bank, uint32_t node);
uint32_t noh_clip_bank_mesh_group(const noh_clip_bank *bank, uint32_t mesh);

/* Get the morph weights of a mesh in the floats of a pose, as of the first node that draws it, for noh_morph_accumulate
 * and noh_gl_morph_set_weights.
 * shapes   floats[clips.float_count] of a pose; the result [the mesh's target_count] points into floats
 * returns  NULL if noh_clip_bank_mesh_group is NOH_NONE: the mesh keeps its defaults */
const float *noh_clip_bank_mesh_weights(const noh_clip_bank *bank, const float *floats, uint32_t mesh);

/* Request the segments that a controller's tracks need now and within the next ahead_ticks, assuming that position,
 * playback speed, loop mode and LOD level stay as they are. Includes tracks of weight 0. Decodes nothing.
 * ranges   ahead_ticks up to 2^31; the cache should have room for every segment in that range
 * returns  the number of segments that found no room in this frame and will be decoded late */
uint32_t noh_clip_bank_prefetch(noh_clip_bank *bank, const noh_controller *controller, uint32_t ahead_ticks);

/* ---- several threads ---- */

/* The clips of a bank for one thread. */
typedef struct noh_clip_bank_view {
    noh_clip_set clips; /* a copy of bank->clips that samples through this view */
    const noh_clip_bank *bank;
    noh_clip_view *samples; /* noh_clip_view_stats_of counts its late decodes */
    float *sampled;         /* private: the floats of one clip */
} noh_clip_bank_view;

/* Exact size of a view in bytes: two segments, and the floats of a clip. */
size_t noh_clip_bank_view_size(const noh_clip_bank *bank);

/* Make a view in memory[bytes], aligned to NOH_MEMORY_ALIGN. The bank must outlive it. Copies the bank's masks as they
 * are now.
 * errors  ARG memory NULL or misaligned; MEMORY need: the bytes */
noh_result noh_clip_bank_view_init(void *memory, size_t bytes, const noh_clip_bank *bank, noh_clip_bank_view **view,
                                   noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
