/* clip_vec_internal.h (private to clip/ and the encoder): four floats at a time, for SSE2, NEON and plain C.
 *
 * Every operation rounds once, as the scalar one does, so that all give the same bits. Define NOH_CLIP_SCALAR to force
 * the scalar ones.
 *
 * noh_v4_blend_i16: eight int16 each of a and b (16-byte aligned), summed with whole weights, 0..32767, that add up to
 * 32767 at most: exact in 32 bits, then rounded once to floats. */
#ifndef NOH_CLIP_CLIP_VEC_INTERNAL_H
#define NOH_CLIP_CLIP_VEC_INTERNAL_H

#include <stdint.h>
#include <string.h>

#include "core/base/math_internal.h"

#if defined(NOH_CLIP_SCALAR)
#define NOH_CLIP_SIMD "scalar"
#elif defined(NOH_SSE2)
#include <emmintrin.h>
#define NOH_CLIP_SIMD "sse2"
#define NOH_VEC_SSE 1
#elif defined(NOH_NEON)
#include <arm_neon.h>
#define NOH_CLIP_SIMD "neon"
#define NOH_VEC_NEON 1
#else
#define NOH_CLIP_SIMD "scalar"
#endif

#if defined(NOH_VEC_SSE)
typedef __m128 noh_v4;
static inline noh_v4 noh_v4_load(const float *p)
{
    return _mm_loadu_ps(p);
}
static inline void noh_v4_store(float *p, noh_v4 v)
{
    _mm_storeu_ps(p, v);
}
static inline noh_v4 noh_v4_set(float x)
{
    return _mm_set1_ps(x);
}
static inline noh_v4 noh_v4_add(noh_v4 a, noh_v4 b)
{
    return _mm_add_ps(a, b);
}
static inline noh_v4 noh_v4_sub(noh_v4 a, noh_v4 b)
{
    return _mm_sub_ps(a, b);
}
static inline noh_v4 noh_v4_mul(noh_v4 a, noh_v4 b)
{
    return _mm_mul_ps(a, b);
}
static inline noh_v4 noh_v4_div(noh_v4 a, noh_v4 b)
{
    return _mm_div_ps(a, b);
}
static inline noh_v4 noh_v4_sqrt(noh_v4 a)
{
    return _mm_sqrt_ps(a);
}
static inline noh_v4 noh_v4_max(noh_v4 a, noh_v4 b)
{
    return _mm_max_ps(a, b);
} /* a > b ? a : b */
typedef __m128i noh_weights;
static inline noh_weights noh_weights_set(int32_t to_a, int32_t to_b)
{
    return _mm_set1_epi32((int32_t)((uint32_t)to_b << 16 | (uint32_t)to_a));
}
static inline void noh_v4_blend_i16(const int16_t *a, const int16_t *b, noh_weights w, noh_v4 *first, noh_v4 *second)
{
    const __m128i p = _mm_load_si128((const __m128i *)(const void *)a),
                  q = _mm_load_si128((const __m128i *)(const void *)b);
    *first = _mm_cvtepi32_ps(_mm_madd_epi16(_mm_unpacklo_epi16(p, q), w));
    *second = _mm_cvtepi32_ps(_mm_madd_epi16(_mm_unpackhi_epi16(p, q), w));
}
static inline void noh_v4_transpose(noh_v4 v[4])
{
    _MM_TRANSPOSE4_PS(v[0], v[1], v[2], v[3]);
}
/* Lane i: (x + z) + (y + w) of the i-th vector. */
static inline noh_v4 noh_v4_sums(noh_v4 a, noh_v4 b, noh_v4 c, noh_v4 d)
{
    const noh_v4 ab = _mm_add_ps(_mm_unpacklo_ps(a, b), _mm_unpackhi_ps(a, b));
    const noh_v4 cd = _mm_add_ps(_mm_unpacklo_ps(c, d), _mm_unpackhi_ps(c, d));
    return _mm_add_ps(_mm_movelh_ps(ab, cd), _mm_movehl_ps(cd, ab));
}
/* Round halves up and store as int16; |v| must be below 32768. */
static inline void noh_v4_store_i16(int16_t *p, noh_v4 v)
{
    __m128i i = _mm_sub_epi32(_mm_cvttps_epi32(_mm_add_ps(v, _mm_set1_ps(32768.5f))), _mm_set1_epi32(32768));
    _mm_storel_epi64((__m128i *)(void *)p, _mm_packs_epi32(i, i));
}
static inline noh_v4 noh_v4_even(noh_v4 a, noh_v4 b)
{
    return _mm_shuffle_ps(a, b, 0x88);
} /* lanes 0 and 2 of a, then of b */
static inline noh_v4 noh_v4_lane(noh_v4 v, int lane)
{
    switch (lane) { /* constant after inlining */
    case 0: return _mm_shuffle_ps(v, v, 0x00);
    case 1: return _mm_shuffle_ps(v, v, 0x55);
    case 2: return _mm_shuffle_ps(v, v, 0xaa);
    default: return _mm_shuffle_ps(v, v, 0xff);
    }
}
#elif defined(NOH_VEC_NEON)
typedef float32x4_t noh_v4;
static inline noh_v4 noh_v4_load(const float *p)
{
    return vld1q_f32(p);
}
static inline void noh_v4_store(float *p, noh_v4 v)
{
    vst1q_f32(p, v);
}
static inline noh_v4 noh_v4_set(float x)
{
    return vdupq_n_f32(x);
}
static inline noh_v4 noh_v4_add(noh_v4 a, noh_v4 b)
{
    return vaddq_f32(a, b);
}
static inline noh_v4 noh_v4_sub(noh_v4 a, noh_v4 b)
{
    return vsubq_f32(a, b);
}
static inline noh_v4 noh_v4_mul(noh_v4 a, noh_v4 b)
{
    return vmulq_f32(a, b);
}
static inline noh_v4 noh_v4_div(noh_v4 a, noh_v4 b)
{
    return vdivq_f32(a, b);
}
static inline noh_v4 noh_v4_sqrt(noh_v4 a)
{
    return vsqrtq_f32(a);
}
static inline noh_v4 noh_v4_max(noh_v4 a, noh_v4 b)
{
    return vbslq_f32(vcgtq_f32(a, b), a, b);
}
typedef struct noh_weights {
    int16_t to_a, to_b;
} noh_weights;
static inline noh_weights noh_weights_set(int32_t to_a, int32_t to_b)
{
    const noh_weights w = { (int16_t)to_a, (int16_t)to_b };
    return w;
}
static inline void noh_v4_blend_i16(const int16_t *a, const int16_t *b, noh_weights w, noh_v4 *first, noh_v4 *second)
{
    const int16x8_t p = vld1q_s16(a), q = vld1q_s16(b);
    *first = vcvtq_f32_s32(vmlal_n_s16(vmull_n_s16(vget_low_s16(p), w.to_a), vget_low_s16(q), w.to_b));
    *second = vcvtq_f32_s32(vmlal_n_s16(vmull_n_s16(vget_high_s16(p), w.to_a), vget_high_s16(q), w.to_b));
}
static inline void noh_v4_transpose(noh_v4 v[4])
{
    float32x4x2_t a = vzipq_f32(v[0], v[2]), b = vzipq_f32(v[1], v[3]);
    float32x4x2_t low = vzipq_f32(a.val[0], b.val[0]), high = vzipq_f32(a.val[1], b.val[1]);
    v[0] = low.val[0];
    v[1] = low.val[1];
    v[2] = high.val[0];
    v[3] = high.val[1];
}
static inline noh_v4 noh_v4_sums(noh_v4 a, noh_v4 b, noh_v4 c, noh_v4 d)
{
    const noh_v4 ab = vaddq_f32(vzip1q_f32(a, b), vzip2q_f32(a, b)), cd = vaddq_f32(vzip1q_f32(c, d), vzip2q_f32(c, d));
    return vaddq_f32(vcombine_f32(vget_low_f32(ab), vget_low_f32(cd)),
                     vcombine_f32(vget_high_f32(ab), vget_high_f32(cd)));
}
static inline void noh_v4_store_i16(int16_t *p, noh_v4 v)
{
    int32x4_t i = vsubq_s32(vcvtq_s32_f32(vaddq_f32(v, vdupq_n_f32(32768.5f))), vdupq_n_s32(32768));
    vst1_s16(p, vqmovn_s32(i));
}
static inline noh_v4 noh_v4_even(noh_v4 a, noh_v4 b)
{
    return vuzp1q_f32(a, b);
}
static inline noh_v4 noh_v4_lane(noh_v4 v, int lane)
{
    switch (lane) {
    case 0: return vdupq_laneq_f32(v, 0);
    case 1: return vdupq_laneq_f32(v, 1);
    case 2: return vdupq_laneq_f32(v, 2);
    default: return vdupq_laneq_f32(v, 3);
    }
}
#else
typedef struct noh_v4 {
    float f[4];
} noh_v4;
/* Written out: at -O2 compilers keep loops of four. */
static inline noh_v4 noh_v4_load(const float *p)
{
    noh_v4 r;
    memcpy(r.f, p, sizeof r.f);
    return r;
}
static inline void noh_v4_store(float *p, noh_v4 v)
{
    memcpy(p, v.f, sizeof v.f);
}
static inline noh_v4 noh_v4_set(float x)
{
    const noh_v4 r = { { x, x, x, x } };
    return r;
}
static inline noh_v4 noh_v4_add(noh_v4 a, noh_v4 b)
{
    const noh_v4 r = { { a.f[0] + b.f[0], a.f[1] + b.f[1], a.f[2] + b.f[2], a.f[3] + b.f[3] } };
    return r;
}
static inline noh_v4 noh_v4_sub(noh_v4 a, noh_v4 b)
{
    const noh_v4 r = { { a.f[0] - b.f[0], a.f[1] - b.f[1], a.f[2] - b.f[2], a.f[3] - b.f[3] } };
    return r;
}
static inline noh_v4 noh_v4_mul(noh_v4 a, noh_v4 b)
{
    const noh_v4 r = { { a.f[0] * b.f[0], a.f[1] * b.f[1], a.f[2] * b.f[2], a.f[3] * b.f[3] } };
    return r;
}
static inline noh_v4 noh_v4_div(noh_v4 a, noh_v4 b)
{
    const noh_v4 r = { { a.f[0] / b.f[0], a.f[1] / b.f[1], a.f[2] / b.f[2], a.f[3] / b.f[3] } };
    return r;
}
static inline noh_v4 noh_v4_sqrt(noh_v4 a)
{
    const noh_v4 r = { { noh_sqrt(a.f[0]), noh_sqrt(a.f[1]), noh_sqrt(a.f[2]), noh_sqrt(a.f[3]) } };
    return r;
}
static inline float noh_v4_larger(float a, float b)
{
    return a > b ? a : b;
}
static inline noh_v4 noh_v4_max(noh_v4 a, noh_v4 b)
{
    const noh_v4 r = { { noh_v4_larger(a.f[0], b.f[0]), noh_v4_larger(a.f[1], b.f[1]), noh_v4_larger(a.f[2], b.f[2]),
                         noh_v4_larger(a.f[3], b.f[3]) } };
    return r;
}
typedef struct noh_weights {
    int32_t to_a, to_b;
} noh_weights;
static inline noh_weights noh_weights_set(int32_t to_a, int32_t to_b)
{
    const noh_weights w = { to_a, to_b };
    return w;
}
static inline noh_v4 noh_v4_blend_four(const int16_t *a, const int16_t *b, noh_weights w)
{
    const noh_v4 r = { { (float)(a[0] * w.to_a + b[0] * w.to_b), (float)(a[1] * w.to_a + b[1] * w.to_b),
                         (float)(a[2] * w.to_a + b[2] * w.to_b), (float)(a[3] * w.to_a + b[3] * w.to_b) } };
    return r;
}
static inline void noh_v4_blend_i16(const int16_t *a, const int16_t *b, noh_weights w, noh_v4 *first, noh_v4 *second)
{
    *first = noh_v4_blend_four(a, b, w);
    *second = noh_v4_blend_four(a + 4, b + 4, w);
}
static inline void noh_v4_transpose(noh_v4 v[4])
{
    for (int i = 0; i < 4; i++) {
        for (int k = i + 1; k < 4; k++) {
            const float t = v[i].f[k];
            v[i].f[k] = v[k].f[i];
            v[k].f[i] = t;
        }
    }
}
static inline float noh_v4_sum(noh_v4 v)
{
    return (v.f[0] + v.f[2]) + (v.f[1] + v.f[3]);
}
static inline noh_v4 noh_v4_sums(noh_v4 a, noh_v4 b, noh_v4 c, noh_v4 d)
{
    noh_v4 r;
    r.f[0] = noh_v4_sum(a);
    r.f[1] = noh_v4_sum(b);
    r.f[2] = noh_v4_sum(c);
    r.f[3] = noh_v4_sum(d);
    return r;
}
static inline void noh_v4_store_i16(int16_t *p, noh_v4 v)
{
    for (int i = 0; i < 4; i++) {
        const int32_t r = (int32_t)(v.f[i] + 32768.5f) - 32768;
        p[i] = (int16_t)(r > 32767 ? 32767 : r);
    }
}
static inline noh_v4 noh_v4_even(noh_v4 a, noh_v4 b)
{
    const noh_v4 r = { { a.f[0], a.f[2], b.f[0], b.f[2] } };
    return r;
}
static inline noh_v4 noh_v4_lane(noh_v4 v, int lane)
{
    return noh_v4_set(v.f[lane]);
}
#endif

#endif
