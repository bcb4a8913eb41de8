/* clip_decode_internal.h (private to clip/ and the encoder): one segment, track by track.
 *
 * Decoding can stop after any track and resume later, so a frame of the game can keep to a budget, and the first joints
 * can be decoded alone; the final bits are the same. */
#ifndef NOH_CLIP_CLIP_DECODE_INTERNAL_H
#define NOH_CLIP_CLIP_DECODE_INTERNAL_H

#include "motion/clip/clip_internal.h"
#include "motion/clip/clip_synth_internal.h"
#include "noh/low_motion.h"

#define NOH_CLIP_CLASSES 2u /* linear tracks and rotations have separate contexts */

/* The progress of decoding a segment. */
typedef struct noh_clip_cursor {
    uint32_t segment, track;
    size_t position;                       /* bits from the clip's first byte */
    size_t high;                           /* likewise in the high part; 0: the segment is not split */
    uint8_t raw_tracks;                    /* 1: the segment has some */
    uint8_t last_before[NOH_CLIP_CLASSES]; /* for a split segment in its high part */
    int16_t step_before[NOH_CLIP_CLASSES];
} noh_clip_cursor;

/* A cursor at the first track of a segment. */
noh_clip_cursor noh_clip_cursor_at(const noh_clip *clip, uint32_t segment);

/* Decode tracks up to `track_end` (at most the clip's track_count) into slots, clip->frame_bytes apart. `basis` is for
 * the segment's length. Any bits decode to some frames, and nothing is written out of bounds. */
void noh_clip_decode(const noh_clip *clip, const noh_clip_basis *basis, noh_clip_cursor *cursor, uint32_t track_end,
                     uint8_t *frames);

#endif
