/* clip_synth_internal.h (private to clip/ and the encoder): from coefficients to frames.
 *
 * The encoder calls these same functions, so that its closed loop sees the decoder's bits.
 *
 *   noh_clip_basis_build    the rows of a segment length
 *   noh_clip_step           a step id's size
 *   noh_clip_quat_expand    three small components to a unit quaternion
 *   noh_clip_mix_matrix     a quaternion's matrix
 *   noh_clip_dequantise     integers to components
 *   noh_clip_synth_*        components to frames of a cache */
#ifndef NOH_CLIP_CLIP_SYNTH_INTERNAL_H
#define NOH_CLIP_CLIP_SYNTH_INTERNAL_H

#include <stddef.h>
#include <stdint.h>


/* The orthonormal transform of one length, first halves of its rows: row k is even about the middle for even k, odd for
 * odd k. */
typedef struct noh_clip_basis {
    uint32_t frames;
    uint32_t half;     /* (frames + 1) / 2, rounded up to a multiple of 4 */
    const float *rows; /* [frames][half], zeros beyond the middle */
    uint32_t skip;     /* bit i: slots 4 i to 4 i + 3 and their mirrors are skipped and stay unchanged */
    uint32_t halved;   /* 1: only the frames of slots */
} noh_clip_basis;

/* Decoded frames are in slots, one per frame; in a halved segment one per even frame of the first half, and one for its
 * mirror, because both are computed at once. So first and last frame are included, frames two apart each, and one to
 * three in the middle. These
 * return the number of slots of the first half, including its middle, and of the segment. */
static inline uint32_t noh_clip_front_slots(uint32_t frames, uint32_t halved)
{
    return ((frames + 1u) / 2u + halved) >> halved;
}
static inline uint32_t noh_clip_slots(uint32_t frames, uint32_t halved)
{
    const uint32_t fronts = noh_clip_front_slots(frames, halved);
    const uint32_t last = (fronts - 1u) << halved; /* a frame; it may be its own mirror */
    return 2u * fronts - (2u * last + 1u == frames);
}

/* The frame of a slot. */
static inline uint32_t noh_clip_slot_frame(uint32_t slot, uint32_t frames, uint32_t halved)
{
    const uint32_t mirror = noh_clip_slots(frames, halved) - 1u - slot;
    return slot <= mirror ? slot << halved : frames - 1u - (mirror << halved);
}

/* The last slot whose frame is not after `frame`. */
static inline uint32_t noh_clip_slot_of(uint32_t frame, uint32_t frames, uint32_t halved)
{
    const uint32_t last = noh_clip_front_slots(frames, halved) - 1u, mirror = frames - 1u - frame;
    if (mirror <= last << halved) return noh_clip_slots(frames, halved) - 1u - ((mirror + halved) >> halved);
    return frame >> halved < last ? frame >> halved : last;
}

/* The bit of `skip` for a slot. */
static inline uint32_t noh_clip_quad_bit(uint32_t slot, uint32_t slots)
{
    const uint32_t mirror = slots - 1u - slot;
    return 1u << (slot < mirror ? slot : mirror) / 4u;
}

/* The number of floats of half a row, and of a whole basis. */
static inline uint32_t noh_clip_basis_half(uint32_t frames)
{
    return ((frames + 1u) / 2u + 3u) & ~3u;
}
static inline uint32_t noh_clip_basis_count(uint32_t frames)
{
    return frames * noh_clip_basis_half(frames);
}

/* The two transforms: the DCT-II, and the one that begins with a parabola (NOH_CLIP_FLAG_PARABOLA). */
#define NOH_CLIP_BASES 2u

/* Fill rows[noh_clip_basis_count(frames)]; frames 1..NOH_CLIP_SEGMENT_FRAMES_MAX; parabola 0 or 1. */
void noh_clip_basis_build(uint32_t frames, uint32_t parabola, float *rows);

/* 2^(NOH_CLIP_STEP_TOP - id / 4); id below NOH_CLIP_STEP_IDS. */
float noh_clip_step(uint32_t id);

/* Expand codes[3] of `width` bits (low_motion.h) and the index of the omitted component to a unit quaternion. */
void noh_clip_quat_expand(const uint32_t codes[3], uint32_t left_out, uint32_t width, float q[4]);

/* Normalise q; length 0 gives the identity. */
void noh_clip_quat_unit(const float q[4], float unit[4]);

/* m[r * 3 + c]: the rotation matrix of a unit quaternion. */
void noh_clip_mix_matrix(const float q[4], float m[9]);

/* Integers to components. out[k][c] = step * coefs[k][c], turned by mix (may be NULL). */
void noh_clip_dequantise(const int32_t (*coefs)[4], uint32_t last, float step, const float *mix, float out[][4]);

/* Compute the frames of a rotation track: reference * rodrigues(components).
 * shapes  coefs[last][4]; slot s goes to out + s * stride, 4 int16 (times 32767) or 4 floats
 * source  Shuster, "A survey of attitude representations", 1993, section on modified Rodrigues parameters */
void noh_clip_synth_rotation(const noh_clip_basis *basis, const float (*coefs)[4], uint32_t last,
                             const float reference[4], int wide, uint8_t *out, size_t stride);

/* Compute the frames of a linear track: reference + components; 3 floats each. */
void noh_clip_synth_linear(const noh_clip_basis *basis, const float (*coefs)[4], uint32_t last,
                           const float reference[3], uint8_t *out, size_t stride);

/* Store one frame of a raw rotation in the cache's format; NaN becomes 0. */
void noh_clip_store_rotation(const float q[4], int wide, uint8_t *out);

#endif
