#include "anim/clip_sample.h"

#include <string.h>

#include "anim/clip_vec.h"

/* Kernels in which a flag is a constant, or whose vectors must stay in registers. */
#define NOH_CLIP_INLINE static inline __attribute__((always_inline))

#define GROUP 4u
#define TINY 1e-30f /* so that frames of zeros, which only a broken clip has, divide */

#if defined(__AVX2__) && !defined(NOH_CLIP_SCALAR)
#include <immintrin.h>

/* Two joints to a register, eight at a time; sums in the order of the scalar twin. */
static inline __m256 load_pair(const uint8_t *frame, uint32_t index, int wide)
{
    if (wide) return _mm256_loadu_ps((const float *)(const void *)frame + 4u * index);
    return _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(_mm_loadu_si128((const __m128i *)(const void *)(frame + 8u * index))));
}

static inline void store_pair(const noh_clip *clip, uint32_t index, __m256 q, noh_transform *out)
{
    _mm_storeu_ps(out[clip->rotation_joints[index]].rotation, _mm256_castps256_ps128(q));
    _mm_storeu_ps(out[clip->rotation_joints[index + 1u]].rotation, _mm256_extractf128_ps(q, 1));
}

/* noh_v4_sums of both halves: joints 0 2 4 6, then 1 3 5 7. */
static inline __m256 sums8(__m256 a, __m256 b, __m256 c, __m256 d)
{
    const __m256 ab = _mm256_add_ps(_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
    const __m256 cd = _mm256_add_ps(_mm256_unpacklo_ps(c, d), _mm256_unpackhi_ps(c, d));
    return _mm256_add_ps(_mm256_shuffle_ps(ab, cd, 0x44), _mm256_shuffle_ps(ab, cd, 0xee));
}

/* Returns how many rotations are done. */
NOH_CLIP_INLINE uint32_t blend_many(const noh_clip *clip, const uint8_t *a, const uint8_t *b, float fraction, uint32_t count, int wide,
                                  noh_transform *out)
{
    const __m256 to_b = _mm256_set1_ps(fraction), to_a = _mm256_set1_ps(1.0f - fraction);
    uint32_t r = 0;
    for (; r + 8u <= count; r += 8u) {
        __m256 q[4], scale;
        q[0] = _mm256_add_ps(_mm256_mul_ps(load_pair(a, r, wide), to_a), _mm256_mul_ps(load_pair(b, r, wide), to_b));
        q[1] = _mm256_add_ps(_mm256_mul_ps(load_pair(a, r + 2u, wide), to_a), _mm256_mul_ps(load_pair(b, r + 2u, wide), to_b));
        q[2] = _mm256_add_ps(_mm256_mul_ps(load_pair(a, r + 4u, wide), to_a), _mm256_mul_ps(load_pair(b, r + 4u, wide), to_b));
        q[3] = _mm256_add_ps(_mm256_mul_ps(load_pair(a, r + 6u, wide), to_a), _mm256_mul_ps(load_pair(b, r + 6u, wide), to_b));
        scale = sums8(_mm256_mul_ps(q[0], q[0]), _mm256_mul_ps(q[1], q[1]), _mm256_mul_ps(q[2], q[2]), _mm256_mul_ps(q[3], q[3]));
        scale = _mm256_div_ps(_mm256_set1_ps(1.0f), _mm256_sqrt_ps(_mm256_max_ps(scale, _mm256_set1_ps(TINY))));
        store_pair(clip, r, _mm256_mul_ps(q[0], _mm256_permute_ps(scale, 0x00)), out);
        store_pair(clip, r + 2u, _mm256_mul_ps(q[1], _mm256_permute_ps(scale, 0x55)), out);
        store_pair(clip, r + 4u, _mm256_mul_ps(q[2], _mm256_permute_ps(scale, 0xaa)), out);
        store_pair(clip, r + 6u, _mm256_mul_ps(q[3], _mm256_permute_ps(scale, 0xff)), out);
    }
    return r;
}
#else
NOH_CLIP_INLINE uint32_t blend_many(const noh_clip *clip, const uint8_t *a, const uint8_t *b, float fraction, uint32_t count, int wide,
                                  noh_transform *out)
{
    (void)clip;
    (void)a;
    (void)b;
    (void)fraction;
    (void)count;
    (void)wide;
    (void)out;
    return 0;
}
#endif

static inline noh_v4 load_quat(const uint8_t *frame, uint32_t index, int wide)
{
    return wide ? noh_v4_load((const float *)(const void *)frame + 4u * index)
                : noh_v4_load_i16((const int16_t *)(const void *)frame + 4u * index);
}

static inline void load_two(const uint8_t *frame, uint32_t index, int wide, noh_v4 *first, noh_v4 *second)
{
    if (wide) {
        *first = load_quat(frame, index, wide);
        *second = load_quat(frame, index + 1u, wide);
    } else {
        noh_v4_load_i16_pair((const int16_t *)(const void *)frame + 4u * index, first, second);
    }
}

/* Normalise four; they share the square root. Written out, here and below: at -O2 compilers keep
 * loops of four, and their arrays in memory. */
NOH_CLIP_INLINE void normalise_group(noh_v4 q[GROUP])
{
    noh_v4 scale = noh_v4_sums(noh_v4_mul(q[0], q[0]), noh_v4_mul(q[1], q[1]), noh_v4_mul(q[2], q[2]), noh_v4_mul(q[3], q[3]));
    scale = noh_v4_max(scale, noh_v4_set(TINY));
    scale = noh_v4_div(noh_v4_set(1.0f), noh_v4_sqrt(scale));
    q[0] = noh_v4_mul(q[0], noh_v4_lane(scale, 0));
    q[1] = noh_v4_mul(q[1], noh_v4_lane(scale, 1));
    q[2] = noh_v4_mul(q[2], noh_v4_lane(scale, 2));
    q[3] = noh_v4_mul(q[3], noh_v4_lane(scale, 3));
}

NOH_CLIP_INLINE noh_v4 lerp(noh_v4 a, noh_v4 b, noh_v4 to_a, noh_v4 to_b)
{
    return noh_v4_add(noh_v4_mul(a, to_a), noh_v4_mul(b, to_b));
}

/* Four neighbours. */
NOH_CLIP_INLINE void blend_group(const uint8_t *a, const uint8_t *b, uint32_t r, int wide, noh_v4 to_a, noh_v4 to_b, noh_v4 q[GROUP])
{
    noh_v4 a0, a1, a2, a3, b0, b1, b2, b3;
    load_two(a, r, wide, &a0, &a1);
    load_two(a, r + 2u, wide, &a2, &a3);
    load_two(b, r, wide, &b0, &b1);
    load_two(b, r + 2u, wide, &b2, &b3);
    q[0] = lerp(a0, b0, to_a, to_b);
    q[1] = lerp(a1, b1, to_a, to_b);
    q[2] = lerp(a2, b2, to_a, to_b);
    q[3] = lerp(a3, b3, to_a, to_b);
    normalise_group(q);
}

/* Rotations: neighbouring frames lie in one hemisphere (the encoder sees to it), so there is
 * no sign to look at. */
NOH_CLIP_INLINE void blend_rotations(const noh_clip *clip, const uint8_t *a, const uint8_t *b, float fraction, uint32_t count, int wide,
                                   noh_transform *out)
{
    const uint16_t *joints = clip->rotation_joints;
    uint32_t r = blend_many(clip, a, b, fraction, count, wide, out);
    const noh_v4 to_b = noh_v4_set(fraction), to_a = noh_v4_set(1.0f - fraction);
    noh_v4 q[GROUP];
    for (; r + GROUP <= count; r += GROUP) {
        blend_group(a, b, r, wide, to_a, to_b, q);
        noh_v4_store(out[joints[r]].rotation, q[0]);
        noh_v4_store(out[joints[r + 1u]].rotation, q[1]);
        noh_v4_store(out[joints[r + 2u]].rotation, q[2]);
        noh_v4_store(out[joints[r + 3u]].rotation, q[3]);
    }
    if (r < count) {
        for (uint32_t i = 0; i < GROUP; i++) {
            const uint32_t index = r + i < count ? r + i : count - 1u;
            q[i] = lerp(load_quat(a, index, wide), load_quat(b, index, wide), to_a, to_b);
        }
        normalise_group(q);
        for (uint32_t i = 0; r + i < count; i++) {
            noh_v4_store(out[joints[r + i]].rotation, q[i]);
        }
    }
}

static inline void blend_linear(const float *a, const float *b, float fraction, uint32_t count, float *out)
{
    for (uint32_t i = 0; i < count; i++) {
        out[i] = a[i] + (b[i] - a[i]) * fraction;
    }
}

void noh_clip_blend_frames(const noh_clip *clip, const uint8_t *a, const uint8_t *b, float fraction, uint32_t joints, noh_transform *out,
                           float *floats)
{
    const float *la = (const float *)(const void *)(a + clip->linear_offset), *lb = (const float *)(const void *)(b + clip->linear_offset);
    const noh_clip_prefix *prefix = &clip->prefixes[joints];
    memcpy(out, clip->pose, joints * sizeof *out);
    if (clip->info.flags & NOH_CLIP_FLAG_WIDE) {
        blend_rotations(clip, a, b, fraction, prefix->rotations, 1, out);
    } else {
        blend_rotations(clip, a, b, fraction, prefix->rotations, 0, out);
    }
    for (uint32_t i = clip->prefixes[0].linears; i < prefix->linears; i++) {
        noh_transform *t = &out[clip->linears[i].joint];
        float *v = clip->linears[i].kind == NOH_CLIP_SCALE ? t->scale : t->translation;
        const float *p = la + 3u * i, *q = lb + 3u * i;
        v[0] = p[0] + (q[0] - p[0]) * fraction;
        v[1] = p[1] + (q[1] - p[1]) * fraction;
        v[2] = p[2] + (q[2] - p[2]) * fraction;
    }
    if (floats) {
        blend_linear(la, lb, fraction, clip->info.float_count, floats);
    }
}
