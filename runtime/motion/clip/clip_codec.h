/* clip_codec.h: a compressed clip, ready to be played.
 *
 * The clip's bytes are used where they lie; its header, a few bits per joint, is expanded once into the caller's
 * memory. Frames are decoded through a cache: clip_cache.h.
 *
 *   noh_clip_measure   its counts, duration and certificate, and the bytes it takes, before it is opened
 *   noh_clip_size      the bytes that noh_clip_init will use
 *   noh_clip_init      check a clip and expand its header
 *   noh_clip_info_of   its counts, duration and certificate
 *   noh_clip_group_at  a group of its floats
 *   noh_clip_frame_at  a time's frame and fraction
 *
 * Threads: an open clip is read-only; any number of threads may share it. */
#ifndef NOH_CLIP_CLIP_CODEC_H
#define NOH_CLIP_CLIP_CODEC_H

#include "motion/clip/clip_format.h"
#include "motion/pose/pose.h"
#include "core/base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_clip_desc {
    const void *bytes; /* the clip, any alignment; must outlive the noh_clip */
    size_t byte_count;
    /* [joint_count] the skeleton's bind pose, the one that the clip was built with; needed by init only */
    const noh_transform *bind;
    uint32_t joint_count; /* of the skeleton; must be the clip's; 0 for a clip that animates floats only */
    /* frames per second that are enough; default (0) all of them. A clip of at least twice as many (less a hundredth)
     * is halved: about every second of its frames is decoded and kept in the cache, and what lies between is
     * interpolated. Its certificate does not hold then: of segments that are split (NOH_CLIP_FLAG_SPLIT) the higher
     * half of the frequencies is left out, too */
    uint32_t sample_rate_enough;
} noh_clip_desc;

typedef struct noh_clip noh_clip;

/* What the header of a clip says. Distances in centimetres. */
typedef struct noh_clip_info {
    uint32_t joint_count, frame_count, segment_count, float_count, group_count;
    uint32_t track_count;              /* animated rotations, translations, scales and triples of floats */
    uint32_t sample_rate_uhz;          /* frames per second, times 10^6 */
    uint64_t duration_ticks;           /* 1/48,000 s, of frame_count - 1 frames; the last frame is shown at the end */
    uint32_t flags;                    /* NOH_CLIP_FLAG_* */
    double error_cm, shell_cm;         /* the bound that it was built for, and how far the points it bounds are from
                                        * their joint in the bind pose: with NOH_CLIP_FLAG_SPHERE all such points,
                                        * without it those on the joint's three axes */
    double max_error_cm, rms_error_cm; /* certificate: the errors measured, at frames and between them */
    uint32_t max_error_joint;
    double max_error_time_s;
    uint32_t segment_frames_max;
    uint32_t halved;          /* 1: half of its frames are enough (noh_clip_desc.sample_rate_enough) */
    size_t segment_bytes_max; /* of the longest segment, decoded in the cache */
} noh_clip_info;

/* Floats that belong together: the morph weights of a node, or one named float. */
typedef struct noh_clip_group {
    uint32_t name_hash;
    uint32_t node;         /* 0xffffffff: none */
    uint32_t first, width; /* floats of a sample */
} noh_clip_group;

/* Check a clip completely; give its info and the bytes that its noh_clip takes.
 * errors  as noh_clip_init, without MEMORY */
noh_result noh_clip_measure(const noh_clip_desc *desc, noh_clip_info *info, size_t *bytes, noh_error *error);

/* Exact bytes of a noh_clip; 0 for a clip that noh_clip_measure refuses. */
size_t noh_clip_size(const noh_clip_desc *desc, noh_error *error);

/* Check the clip completely and expand its header into memory[noh_clip_size()], aligned to NOH_MEMORY_ALIGN.
 * errors  ARG bytes or bind is NULL, the joints are not the skeleton's (need: the clip's), memory NULL or misaligned;
 *         MEMORY need: the bytes; VERSION need: ours; LIMIT need: what the clip has; DATA where: the byte in the clip
 */
noh_result noh_clip_init(void *memory, size_t bytes, const noh_clip_desc *desc, noh_clip **out, noh_error *error);

void noh_clip_info_of(const noh_clip *clip, noh_clip_info *info);

/* Group `index`, below group_count. */
noh_clip_group noh_clip_group_at(const noh_clip *clip, uint32_t index);

/* The frame at or before a time and the fraction 0 <= f < 1 to the next. Where the time is the nearest tick to a frame,
 * that frame and 0. Times before the first frame give the first, those after the last one the last. Exact, because it
 * is computed in integers. */
uint32_t noh_clip_frame_at(const noh_clip *clip, int64_t ticks, float *fraction);

#ifdef __cplusplus
}
#endif

#endif
