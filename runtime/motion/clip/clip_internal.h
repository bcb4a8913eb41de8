/* clip_internal.h (private to clip/, bank/ and the encoder): an expanded clip. */
#ifndef NOH_CLIP_CLIP_INTERNAL_H
#define NOH_CLIP_CLIP_INTERNAL_H

#include "motion/clip/clip_bits_internal.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

typedef enum noh_clip_kind { NOH_CLIP_FLOATS, NOH_CLIP_TRANSLATION, NOH_CLIP_SCALE, NOH_CLIP_ROTATION } noh_clip_kind;

#define NOH_CLIP_GROUP 4u /* rotations that are sampled together; a frame has room for whole groups */
/* limit of weight_one: two whole-number weights times 16-bit values fit in 32 bits */
#define NOH_CLIP_WEIGHT_MAX 32767u
#define NOH_CLIP_WEIGHT_PARTS 8u /* eighths of a frame have whole-number weights: errors were measured there */

#define NOH_CLIP_TRACK_MIX 1u
#define NOH_CLIP_TRACK_WILD 2u

/* An animated track, in the order of the header and of every segment. */
typedef struct noh_clip_track {
    uint8_t kind, flags;
    uint16_t target; /* joint, or first float of the triple */
    uint16_t entry;  /* among rotations, or among linear tracks (including floats) */
    int16_t step;    /* id, where the clip has several segments */
    float reference[4];
    float mix[9]; /* floats: two scales in mix[4] and mix[8] */
} noh_clip_track;

/* The number of tracks of each kind before a joint. */
typedef struct noh_clip_prefix {
    uint16_t tracks, rotations, linears;
} noh_clip_prefix;

/* Destination of the three floats of a linear joint track. */
typedef struct noh_clip_linear {
    uint16_t joint, kind; /* noh_clip_kind: translation or scale */
} noh_clip_linear;

struct noh_clip {
    const uint8_t *bytes;
    noh_clip_info info;
    uint32_t rotation_count, linear_count;
    uint64_t segments_per_frame;         /* times 2^32, rounded down */
    uint32_t frame_bytes, linear_offset; /* of one frame in the cache: rotations, in whole groups, then linear floats */
    /* the sum of the whole-number weights of two frames: a tick and an eighth of a frame are whole if the sample rate
     * allows it */
    uint32_t weight_one;
    const noh_transform *pose;        /* [joint_count] values of joints that are not animated */
    const noh_clip_track *tracks;     /* [track_count] */
    const noh_clip_prefix *prefixes;  /* [joint_count + 1]; the last counts everything */
    const uint32_t *rotation_offsets; /* [rotation_count] byte offset of each in a pose */
    const noh_clip_linear *linears;   /* [linear_count]; float triples come first and are unused */
    const uint32_t *segment_offsets;  /* [segment_count + 1] bytes */
    const uint32_t *segment_firsts;   /* [segment_count + 1] frames */
    const noh_clip_group *groups;     /* [group_count] */
};

/* Reads the float groups of a clip from its bytes, before it is opened; noh_clip_measure must have accepted it. */
typedef struct noh_clip_group_reader {
    noh_bits bits;
    uint32_t left, first;
} noh_clip_group_reader;

noh_clip_group_reader noh_clip_groups_of(const noh_clip_desc *desc);
/* Read the next group; returns 0 after the last one. */
int noh_clip_next_group(noh_clip_group_reader *reader, noh_clip_group *group);

/* Get the index of the transform, below NOH_CLIP_BASES, that a clip is coded in. */
static inline uint32_t noh_clip_basis_of(const noh_clip_info *info)
{
    return (info->flags & NOH_CLIP_FLAG_PARABOLA) != 0u;
}

static inline uint32_t noh_clip_segment_first(const noh_clip *clip, uint32_t segment)
{
    return clip->segment_firsts[segment];
}

static inline uint32_t noh_clip_segment_frames(const noh_clip *clip, uint32_t segment)
{
    return noh_clip_segment_first(clip, segment + 1u) - noh_clip_segment_first(clip, segment);
}

/* Get the segment with a frame (below frame_count). Multiplied by a reciprocal that was rounded down, the guess is
 * never too high and rarely too low. */
static inline uint32_t noh_clip_segment_of(const noh_clip *clip, uint32_t frame)
{
    uint32_t segment = (uint32_t)((uint64_t)frame * clip->segments_per_frame >> 32);
    while (frame >= clip->segment_firsts[segment + 1u]) {
        segment++;
    }
    return segment;
}

/* One unit quaternion: index, then three codes. */
static inline uint32_t noh_clip_read_quat_codes(noh_bits *b, uint32_t width, uint32_t codes[3])
{
    const uint32_t left_out = noh_bits_get(b, 2u);
    for (uint32_t i = 0; i < 3u; i++) {
        codes[i] = noh_bits_get(b, width);
    }
    return left_out;
}

#endif
