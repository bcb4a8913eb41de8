#include "motion/clip/clip_sample_internal.h"

#include <string.h>

#include "core/base/simd_internal.h"
#include "core/base/assert_internal.h"
#include "core/base/compiler_internal.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

/* Kernels in which a flag is a constant, or whose vectors must stay in registers. */
#define NOH_CLIP_INLINE NOH_ALWAYS_INLINE

#define TINY 1e-30f /* so that zero rotations, which only a broken clip has, do not divide by 0 */

/* The weights of two frames: whole numbers if rotations are stored in 16 bits, else floats. */
typedef struct weights {
    int32_t whole_a, whole_b;
    float to_a, to_b;
} weights;

/* `offset`: byte offset of a joint in a pose. */
static inline float *rotation_at(noh_transform *out, uint32_t offset)
{
    return (float *)(void *)((uint8_t *)out + offset);
}

#if NOH_LANES == 8
/* Four joints, 0 2 in one register and 1 3 in the other; sums in the order of the scalar twin. */
NOH_CLIP_INLINE void blend_four(const uint8_t *a, const uint8_t *b, uint32_t r, int wide, const weights *w,
                                noh_v8 *first, noh_v8 *second)
{
    if (wide) {
        const float *p = (const float *)(const void *)a + 4u * r, *q = (const float *)(const void *)b + 4u * r;
        const noh_v8 to_a = noh_v8_set(w->to_a), to_b = noh_v8_set(w->to_b);
        *first = noh_v8_add(noh_v8_mul(noh_v8_load_two(p, p + 8), to_a), noh_v8_mul(noh_v8_load_two(q, q + 8), to_b));
        *second = noh_v8_add(noh_v8_mul(noh_v8_load_two(p + 4, p + 12), to_a),
                             noh_v8_mul(noh_v8_load_two(q + 4, q + 12), to_b));
    } else {
        noh_v8_blend_i16((const int16_t *)(const void *)(a + 8u * r), (const int16_t *)(const void *)(b + 8u * r),
                         w->whole_a, w->whole_b, first, second);
    }
}

static inline void store_two(noh_v8 q, noh_transform *out, uint32_t first, uint32_t second)
{
    noh_v8_store_two(rotation_at(out, first), rotation_at(out, second), q);
}

/* Registers hold joints 0 2, 1 3, 4 6, 5 7. Returns the number of rotations done. */
NOH_CLIP_INLINE uint32_t blend_many(const uint32_t *offsets, const uint8_t *a, const uint8_t *b, const weights *w,
                                    uint32_t count, int wide, noh_transform *out)
{
    uint32_t r = 0;
    for (; r + 8u <= count; r += 8u) {
        noh_v8 q[4], scale;
        blend_four(a, b, r, wide, w, &q[0], &q[1]);
        blend_four(a, b, r + 4u, wide, w, &q[2], &q[3]);
        scale = noh_v8_sums(noh_v8_mul(q[0], q[0]), noh_v8_mul(q[1], q[1]), noh_v8_mul(q[2], q[2]),
                            noh_v8_mul(q[3], q[3]));
        scale = noh_v8_div(noh_v8_set(1.0f), noh_v8_sqrt(noh_v8_max(noh_v8_set(TINY), scale)));
        store_two(noh_v8_mul(q[0], noh_v8_lane(scale, 0)), out, offsets[r], offsets[r + 2u]);
        store_two(noh_v8_mul(q[1], noh_v8_lane(scale, 1)), out, offsets[r + 1u], offsets[r + 3u]);
        store_two(noh_v8_mul(q[2], noh_v8_lane(scale, 2)), out, offsets[r + 4u], offsets[r + 6u]);
        store_two(noh_v8_mul(q[3], noh_v8_lane(scale, 3)), out, offsets[r + 5u], offsets[r + 7u]);
    }
    return r;
}
#else
NOH_CLIP_INLINE uint32_t blend_many(const uint32_t *offsets, const uint8_t *a, const uint8_t *b, const weights *w,
                                    uint32_t count, int wide, noh_transform *out)
{
    (void)offsets;
    (void)a;
    (void)b;
    (void)w;
    (void)count;
    (void)wide;
    (void)out;
    return 0;
}
#endif

/* Normalise four quaternions with one vector square root. Unrolled by hand, here and below: at -O2 compilers keep loops
 * of four, and their arrays in memory. */
NOH_CLIP_INLINE void normalise_group(noh_v4 q[NOH_CLIP_GROUP])
{
    noh_v4 scale = noh_v4_sums(noh_v4_mul(q[0], q[0]), noh_v4_mul(q[1], q[1]), noh_v4_mul(q[2], q[2]),
                               noh_v4_mul(q[3], q[3]));
    scale = noh_v4_max(noh_v4_set(TINY), scale);
    scale = noh_v4_div(noh_v4_set(1.0f), noh_v4_sqrt(scale));
    q[0] = noh_v4_mul(q[0], noh_v4_lane(scale, 0));
    q[1] = noh_v4_mul(q[1], noh_v4_lane(scale, 1));
    q[2] = noh_v4_mul(q[2], noh_v4_lane(scale, 2));
    q[3] = noh_v4_mul(q[3], noh_v4_lane(scale, 3));
}

NOH_CLIP_INLINE noh_v4 lerp(const float *a, const float *b, noh_v4 to_a, noh_v4 to_b)
{
    return noh_v4_add(noh_v4_mul(noh_v4_load(a), to_a), noh_v4_mul(noh_v4_load(b), to_b));
}

/* Blend four neighbours. A frame has room for a whole group after the last rotation; the extra results are unused. */
NOH_CLIP_INLINE void blend_group(const uint8_t *a, const uint8_t *b, uint32_t r, int wide, const weights *w,
                                 noh_v4 q[NOH_CLIP_GROUP])
{
    if (wide) {
        const float *p = (const float *)(const void *)a + 4u * r, *o = (const float *)(const void *)b + 4u * r;
        const noh_v4 to_a = noh_v4_set(w->to_a), to_b = noh_v4_set(w->to_b);
        q[0] = lerp(p, o, to_a, to_b);
        q[1] = lerp(p + 4, o + 4, to_a, to_b);
        q[2] = lerp(p + 8, o + 8, to_a, to_b);
        q[3] = lerp(p + 12, o + 12, to_a, to_b);
    } else {
        const int16_t *p = (const int16_t *)(const void *)a + 4u * r, *o = (const int16_t *)(const void *)b + 4u * r;
        noh_v4_blend_i16(p, o, w->whole_a, w->whole_b, &q[0], &q[1]);
        noh_v4_blend_i16(p + 8, o + 8, w->whole_a, w->whole_b, &q[2], &q[3]);
    }
    normalise_group(q);
}

/* Rotations: a weighted sum, normalised. Frames of one segment lie in one hemisphere, and so do the last and first
 * frames of neighbouring segments (the encoder negates them if needed), so signs need no comparison. Cached frames hold
 * rotations as 16-bit integers: they are multiplied by whole-number weights, exactly, and rounded once to floats, so
 * every instruction set gives the same bits. */
NOH_CLIP_INLINE void blend_rotations(const noh_clip *clip, const uint8_t *a, const uint8_t *b, const weights *w,
                                     uint32_t count, int wide, noh_transform *out)
{
    const uint32_t *offsets = clip->rotation_offsets;
    uint32_t r = blend_many(offsets, a, b, w, count, wide, out);
    noh_v4 q[NOH_CLIP_GROUP];
    for (; r + NOH_CLIP_GROUP <= count; r += NOH_CLIP_GROUP) {
        blend_group(a, b, r, wide, w, q);
        noh_v4_store(rotation_at(out, offsets[r]), q[0]);
        noh_v4_store(rotation_at(out, offsets[r + 1u]), q[1]);
        noh_v4_store(rotation_at(out, offsets[r + 2u]), q[2]);
        noh_v4_store(rotation_at(out, offsets[r + 3u]), q[3]);
    }
    if (r < count) {
        blend_group(a, b, r, wide, w, q);
        noh_v4_store(rotation_at(out, offsets[r]), q[0]);
        if (r + 1u < count) noh_v4_store(rotation_at(out, offsets[r + 1u]), q[1]);
        if (r + 2u < count) noh_v4_store(rotation_at(out, offsets[r + 2u]), q[2]);
    }
}

static inline void blend_linear(const float *a, const float *b, float fraction, uint32_t count, float *out)
{
    for (uint32_t i = 0; i < count; i++) {
        out[i] = a[i] + (b[i] - a[i]) * fraction;
    }
}

void noh_clip_blend_frames(const noh_clip *clip, const uint8_t *a, const uint8_t *b, float fraction, uint32_t joints,
                           noh_transform *out, float *floats)
{
    const float *la = (const float *)(const void *)(a + clip->linear_offset),
                *lb = (const float *)(const void *)(b + clip->linear_offset);
    const noh_clip_prefix *prefix = &clip->prefixes[joints];
    const int32_t whole_b = (int32_t)(fraction * (float)clip->weight_one + 0.5f);
    const weights w = { (int32_t)clip->weight_one - whole_b, whole_b, 1.0f - fraction, fraction };
    NOH_ASSERT(joints <= clip->info.joint_count && fraction >= 0.0f && fraction <= 1.0f);
    memcpy(out, clip->pose, joints * sizeof *out);
    if (clip->info.flags & NOH_CLIP_FLAG_WIDE) {
        blend_rotations(clip, a, b, &w, prefix->rotations, 1, out);
    } else {
        blend_rotations(clip, a, b, &w, prefix->rotations, 0, out);
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
