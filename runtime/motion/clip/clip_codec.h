/* clip_codec.h: a compressed clip, opened for playing.
 *
 * The clip's bytes are used in place; its header, a few bits per joint, is expanded once into the caller's memory.
 * Frames are decoded through a cache: clip_cache.h.
 *
 *   noh_clip_measure   counts, duration, certificate and memory size, before it is opened
 *   noh_clip_size      the bytes that noh_clip_init needs
 *   noh_clip_init      check a clip and expand its header
 *   noh_clip_info_of   counts, duration and certificate
 *   noh_clip_group_at  a group of its floats
 *   noh_clip_frame_at  frame and fraction of a time
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
    /* [joint_count] the skeleton's bind pose that the clip was built with; used by init only */
    const noh_transform *bind;
    uint32_t joint_count; /* joints of the skeleton; must equal the clip's; 0 for a clip that animates floats only */
    /* sample rate, in frames per second, that suffices; default (0) the full rate. A clip with at least twice this rate
     * (less 1%) is halved: about every second frame is decoded and cached, and frames between are interpolated. Its
     * certificate does not hold then. Split segments (NOH_CLIP_FLAG_SPLIT) also lose the higher half of their
     * frequencies */
    uint32_t sample_rate_enough;
} noh_clip_desc;

typedef struct noh_clip noh_clip;

/* Contents of a clip's header. Distances in centimetres. */
typedef struct noh_clip_info {
    uint32_t joint_count, frame_count, segment_count, float_count, group_count;
    uint32_t track_count;     /* animated rotations, translations, scales and triples of floats */
    uint32_t sample_rate_uhz; /* frames per second, times 10^6 */
    uint64_t duration_ticks;  /* 1/48,000 s; frame_count - 1 frames: the last frame is shown at the end */
    uint32_t flags;           /* NOH_CLIP_FLAG_* */
    /* the error bound that it was built for, and the distance in the bind pose from a joint to the points that the
     * bound covers: with NOH_CLIP_FLAG_SPHERE all points at that distance, without it the three on the joint's axes */
    double error_cm, shell_cm;
    double max_error_cm, rms_error_cm; /* certificate: measured errors, at frames and between them */
    uint32_t max_error_joint;
    double max_error_time_s;
    uint32_t segment_frames_max;
    uint32_t halved;          /* 1: half of its frames suffice (noh_clip_desc.sample_rate_enough) */
    size_t segment_bytes_max; /* of the longest segment, decoded in the cache */
} noh_clip_info;

/* Floats that belong together: the morph weights of a node, or one named float. */
typedef struct noh_clip_group {
    uint32_t name_hash;
    uint32_t node;         /* 0xffffffff: none */
    uint32_t first, width; /* floats of a sample */
} noh_clip_group;

/* Check a clip completely; get its info and the size of its noh_clip.
 * errors  as noh_clip_init, except MEMORY */
noh_result noh_clip_measure(const noh_clip_desc *desc, noh_clip_info *info, size_t *bytes, noh_error *error);

/* Exact size of a noh_clip in bytes; 0 for a clip that noh_clip_measure rejects. */
size_t noh_clip_size(const noh_clip_desc *desc, noh_error *error);

/* Check a clip completely and expand its header into memory[noh_clip_size()], aligned to NOH_MEMORY_ALIGN.
 * errors  ARG bytes or bind NULL, joint_count not the clip's (need: the clip's), memory NULL or misaligned; MEMORY
 *         need: the bytes; VERSION need: the version read; LIMIT need: the clip's count; DATA where: the byte in the
 *         clip */
noh_result noh_clip_init(void *memory, size_t bytes, const noh_clip_desc *desc, noh_clip **out, noh_error *error);

void noh_clip_info_of(const noh_clip *clip, noh_clip_info *info);

noh_clip_group noh_clip_group_at(const noh_clip *clip, uint32_t index);

/* Get the frame at or before a time, and the fraction 0 <= f < 1 to the next. At the tick nearest to a frame the result
 * is that frame and 0. Times are clamped to the first and last frame. Exact: computed in integers. */
uint32_t noh_clip_frame_at(const noh_clip *clip, int64_t ticks, float *fraction);

#ifdef __cplusplus
}
#endif

#endif
