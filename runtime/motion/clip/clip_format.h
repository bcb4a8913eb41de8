/* clip_format.h: the bytes of a compressed clip.
 *
 * A clip is one position-independent block: a header of bits, then its segments. Bits fill bytes from the lowest; a
 * field's lowest bit comes first. There is no alignment and no pointer. The header is a bit stream because a game clip
 * of 20 frames takes two kilobytes: a plain struct of joints would be a third of it.
 *
 * varint: groups of 4 bits, lowest first, each followed by one bit, 1 = another follows; at most 8 groups.
 * unit quaternion of width w: 2 bits index of the omitted component (the largest, made positive), then 3 x w bits:
 *         component = (v - mid) * sqrt(1/2) / mid, mid = 2^(w-1) - 1.
 * floats of width w: the highest w bits of an IEEE single, the rest zero.
 *
 * Header
 *   8        version, NOH_CLIP_VERSION
 *   8        flags, NOH_CLIP_FLAG_*; other bits are 0
 *   varint   joints
 *   varint   frames, at least 1
 *   1        1: varint sample rate in Hz;  0: 32 bits of sample rate in micro-Hz
 *   varint   segments; segment s holds frames [s * frames / segments, (s + 1) * frames / segments)
 *   5        only when segments > 1: width of a segment's byte count
 *   varint   the bound in nanometres;  varint the shell in micrometres
 *   20       largest error;  20 rms error (4 bits e, 16 bits m: bound * m * 2^e / 65536)
 *   varint   joint of the largest error;  varint its time in eighths of a frame
 *   varint   float groups; each: 32 bits name hash, varint node + 1 (0: none), varint width
 *   floats   per triple of floats (last padded): track fields, see below
 *   joints   per joint: 0 = rotation animated, rest as in the bind pose; 10 = all as bind;
 *            11, then 2 bits each for rotation, translation and (flag SCALE only) scale:
 *            0 bind, 1 constant, 2 animated. Then the fields of all that is not bind, in the
 *            order translation, scale, rotation:
 *              constant rotation   4 bits c, unit quaternion of width 11 + c
 *              constant linear     2 bits c, 3 floats of width 16, 20, 24, 32
 *              animated            track fields
 *   sizes    only when segments > 1: each segment's byte count; a single segment has the rest
 *   0..7     zeros up to a byte
 * Track fields
 *   8        step of reference (segments > 1 only)
 *   floats:  2 x 8 more: the steps of the second and third float relative to the first, + 128
 *   rotation: 1 wild: each segment has its own reference. Else as follows.
 *   1        0: the reference is the bind pose's value (floats: zero);
 *            1: rotation: unit quaternion of width 8; linear: 3 floats of width 16
 *   1        joints only. 1: mixed axes: unit quaternion of width 8, whose matrix turns
 *            decoded triples into components
 *
 * A segment is a separate bit stream: 1 bit "has raw tracks", with SPLIT 1 bit "is split", if that is 1 a varint, the
 * number of bits before the high part, then per track, in header order:
 *   1        only with raw tracks: this one is raw: frames x (4 or 3) x 32-bit floats, nothing else
 *   step     symbol of the step table: zigzag difference to the header's step (segments > 1)
 *            or to the step of the last track of its class (single); 31: 8 bits, absolute.
 *            step size = 2^(NOH_CLIP_STEP_TOP - id / 4)
 *   32 + 1   wild rotations: unit quaternion of width 10, then a sign bit
 *   last     symbol: number of frequencies, 0..frames of the segment, or 0..frames / 2 if it is split
 *   triples  frequencies last - 1 down to 1, all three components at once; see clip_coefs_internal.h
 *   dc       frequency 0: per component a category symbol, then bits and sign
 * The high part of a split segment has the frequencies from frames / 2 up of each track that is not raw: their number,
 * as a symbol like `last`, then triples down to frames / 2. Playback of half of the frames skips it.
 * Values are the orthonormal DCT-II of each component, or with PARABOLA the transform whose rows are the constant, x
 * and x^2, then the rows of the DCT-II from its second on, made orthonormal in that order among rows of the same
 * symmetry. A rotation's components are the modified Rodrigues vector u = 4 xyz / (1 + w) relative to the reference; a
 * linear track's are differences from the reference.
 *
 * Threads: constants. */
#ifndef NOH_CLIP_CLIP_FORMAT_H
#define NOH_CLIP_CLIP_FORMAT_H

#define NOH_CLIP_VERSION 5u /* raised for new tables too: clip_tables.c is part of the format */

#define NOH_CLIP_FLAG_WIDE 1u  /* cache rotations as floats: 16 bits are too few for some joint's lever */
#define NOH_CLIP_FLAG_SCALE 2u /* some joint's scale differs from its bind pose */
#define NOH_CLIP_FLAG_LOOP 4u  /* the last frame equals the first */
#define NOH_CLIP_FLAG_OPEN 8u  /* coded in an open loop, each joint separately: joints may be masked or replaced */
/* the bound holds for all points at the shell's distance; without it, for the three on each joint's axes */
#define NOH_CLIP_FLAG_SPHERE 16u
#define NOH_CLIP_FLAG_PARABOLA 32u /* the transform begins with a parabola: see above */
#define NOH_CLIP_FLAG_SPLIT 64u    /* in some segments the high frequencies are stored separately */
#define NOH_CLIP_FLAGS_ALL 127u

#define NOH_CLIP_JOINTS_MAX 4096u
#define NOH_CLIP_FLOATS_MAX 4096u
#define NOH_CLIP_GROUPS_MAX 1024u
#define NOH_CLIP_FRAMES_MAX (1u << 20)
#define NOH_CLIP_SEGMENT_FRAMES_MAX 64u

#define NOH_CLIP_TICKS_PER_SECOND 48000u
#define NOH_CLIP_MICRO 1000000u

#define NOH_CLIP_STEP_TOP 16    /* the largest step is 2^16 ... */
#define NOH_CLIP_STEP_IDS 256u  /* ... and the smallest 2^-47.75 */
#define NOH_CLIP_STEP_FIRST 112 /* the reference for the first track of a single segment */
#define NOH_CLIP_STEP_ESCAPE 31u

#define NOH_CLIP_MODE_BIND 0u
#define NOH_CLIP_MODE_CONSTANT 1u
#define NOH_CLIP_MODE_ANIMATED 2u

#define NOH_CLIP_CONSTANT_BITS 11u /* smallest width of a constant rotation */
#define NOH_CLIP_REFERENCE_BITS 8u
#define NOH_CLIP_WILD_BITS 10u
#define NOH_CLIP_MIX_BITS 8u
#define NOH_CLIP_ERROR_ONE 65536u
#define NOH_CLIP_TIME_PARTS 8u /* a certificate's time is in eighths of a frame */

#define NOH_CLIP_MAGNITUDE_BITS 23u /* of a coefficient */

#endif
