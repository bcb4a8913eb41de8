/* clip_encode.h: from a raw clip to the bytes of low_motion.h.
 *
 * The error is an object-space distance: any point at `shell_cm` from a joint (in the bind pose, in
 * the world's centimetres, whatever scale its nodes have), carried by the whole chain of parents,
 * against the raw clip; at every frame,
 * and between frames against the raw clip with translations and scales lerped and rotations
 * lerped and normalised (neighbouring raw quaternions taken in one hemisphere). It is at most
 * `error_cm` wherever it is measured: at frames and at the eighths between them, by the decoder's
 * own arithmetic. Scalars are bounded one by one: |error| x radius <= error_cm, where the radius is how far the scalar
 * moves the surface per unit. The same clip and options give the same bytes on every machine. */
#ifndef NOH_CONVERT_CODEC_CLIP_ENCODE_H
#define NOH_CONVERT_CODEC_CLIP_ENCODE_H

#include "convert/base/byte_buffer.h"
#include "convert/clips/raw_clip.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct clip_options {
    double error_cm;              /* the bound; 0 = 0.01 */
    double shell_cm;              /* least distance of the points from their joint; 0 = 3 */
    const double *reach_cm;       /* [joint_count] where it is larger; NULL = none */
    double float_error;           /* bound of floats without a radius, in their own unit; 0 = 0.001 */
    const double *joint_error_cm; /* [joint_count] bounds of single joints, 0 = error_cm; NULL = none */
    uint32_t effort;              /* 1 to 3: time for bytes, a higher one never larger; 0 = 2 */
    uint32_t segment_frames; /* wanted length of a segment, 8..40; 0: a third of a second, 24 to 32 (effort 3: or 40) */
    /* split the segments of clips of at least this rate, so that a halved clip decodes less; 0 = 100; INFINITY: none */
    double split_hz;
    int axes;      /* bound only the three points on each joint's axes, as other libraries measure */
    int open_loop; /* joints do not correct their parents' errors, so that single joints can be masked out */
    void (*progress)(void *user, uint32_t done, uint32_t of); /* segments; NULL = none */
    void *user;
    struct clip_histogram *histogram; /* counts symbols, to train the tables; NULL = none */
} clip_options;

typedef struct clip_report {
    size_t bytes, raw_bytes; /* raw: 40 per joint and frame, 4 per float and frame */
    size_t header_bytes, segment_table_bytes;
    double max_error_cm, rms_error_cm; /* as decoded */
    uint32_t max_error_joint;
    double max_error_time_s;
    double max_float_error; /* as a share of its bound: at most 1 */
    uint32_t segment_count, track_count, raw_track_segments;
    int level; /* 0 = normal; higher: more careful levels to hold the bound, see clip_encode.c */
    int wide;
    uint32_t parabola; /* 1: the transform begins with a parabola; 0: the DCT */
} clip_report;

/* Encode a clip and append its bytes to `out`. report may be NULL.
 * errors  1 and *error: a limit of the format, out of memory, or a value that is not finite; CLIP_TOO_FINE and *error:
 *         single precision cannot hold the bound */
#define CLIP_TOO_FINE 2
int clip_encode(const raw_skeleton *skeleton, const raw_clip *clip, const clip_options *options, byte_buffer *out,
                clip_report *report, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
