/* Tests of the clip decoder on clips that are written here bit by bit, as low_motion.h has them. The encoder does
 * without what the decoder misreads: it measures the decoded clip and stores raw what is out of bounds. So only clips
 * that it has not made show that the decoder reads the format. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"
#include "motion/clip/clip_coefs_internal.h"
#include "motion/clip/clip_synth_internal.h"

#define BYTES_MAX 2048u
#define SEGMENTS_MAX 40u
#define HERTZ 30u
#define FRAME_TICKS (48000 / 30)
#define STEP_OF_ONE 64u  /* 2^(16 - 64 / 4) */
#define LAST_AT_START 4u /* the context of the first track's number of frequencies */

/* ---- writing ---- */

typedef struct writer {
    uint8_t bytes[BYTES_MAX];
    uint32_t bits;
} writer;

static void put(writer *w, uint32_t value, uint32_t width)
{
    for (uint32_t i = 0; i < width; i++, w->bits++) {
        assert_true(w->bits < 8u * BYTES_MAX);
        w->bytes[w->bits / 8u] |= (uint8_t)((value >> i & 1u) << (w->bits % 8u));
    }
}

static uint32_t byte_count(const writer *w)
{
    return (w->bits + 7u) / 8u;
}

static void put_varint(writer *w, uint32_t value)
{
    do {
        put(w, value & 15u, 4);
        value >>= 4;
        put(w, value != 0u, 1);
    } while (value);
}

static void put_float(writer *w, float value)
{
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    put(w, word, 32);
}

/* A symbol's code is the index of its first entry. */
static void put_symbol(writer *w, const uint16_t *table, uint32_t bits, uint32_t symbol)
{
    for (uint32_t i = 0; i < 1u << bits; i++) {
        if ((uint32_t)table[i] >> 4 == symbol) {
            put(w, i, table[i] & 15u);
            return;
        }
    }
    fail_msg("the table lacks symbol %u", (unsigned)symbol);
}

static void put_step(writer *w, int single, uint32_t symbol)
{
    put_symbol(w, noh_clip_step_table[single], NOH_CLIP_STEP_BITS, symbol);
}

/* The means of a track of one frequency. */
static void put_means(writer *w, const int32_t mean[3], uint32_t last_before)
{
    put_symbol(w, noh_clip_last_table[noh_clip_last_context(last_before)], NOH_CLIP_LAST_BITS, 1);
    for (int i = 0; i < 3; i++) {
        const uint32_t magnitude = (uint32_t)abs(mean[i]), category = noh_clip_bit_length(magnitude);
        put_symbol(w, noh_clip_dc_table[noh_clip_dc_context(0, 1)], NOH_CLIP_DC_BITS, category);
        if (category) {
            put(w, magnitude & ((1u << (category - 1u)) - 1u), category - 1u);
            put(w, mean[i] < 0, 1);
        }
    }
}

/* The header up to the tracks. */
static void put_header(writer *w, uint32_t flags, uint32_t joints, uint32_t frames, uint32_t segments, uint32_t floats)
{
    put(w, NOH_CLIP_VERSION, 8);
    put(w, flags, 8);
    put_varint(w, joints);
    put_varint(w, frames);
    put(w, 1, 1);
    put_varint(w, HERTZ);
    put_varint(w, segments);
    if (segments > 1u) put(w, 8, 5);
    put_varint(w, 1000); /* the bound and the shell */
    put_varint(w, 1000);
    put(w, 0, 20); /* the errors, and where */
    put(w, 0, 20);
    put_varint(w, 0);
    put_varint(w, 0);
    put_varint(w, floats != 0u);
    if (floats) {
        put(w, 1234, 32);
        put_varint(w, 0);
        put_varint(w, floats);
    }
}

/* A triple of floats with equal steps, from 0. */
static void put_float_track(writer *w, uint32_t segments)
{
    if (segments > 1u) put(w, STEP_OF_ONE, 8);
    put(w, 128, 8);
    put(w, 128, 8);
    put(w, 0, 1);
}

/* A joint with only its rotation animated: from the bind pose, or with a reference in each segment. */
static void put_rotation_track(writer *w, uint32_t segments, int wild)
{
    put(w, 0, 1);
    if (segments > 1u) put(w, STEP_OF_ONE, 8);
    put(w, wild != 0, 1);
    if (!wild) put(w, 0, 1);
    put(w, 0, 1); /* its own axes */
}

/* The sizes of the segments, then the segments. */
static void put_segments(writer *w, const writer *segments, uint32_t count)
{
    for (uint32_t s = 0; s < count && count > 1u; s++) put(w, byte_count(&segments[s]), 8);
    w->bits = 8u * byte_count(w);
    for (uint32_t s = 0; s < count; s++) {
        for (uint32_t i = 0; i < byte_count(&segments[s]); i++) put(w, segments[s].bytes[i], 8);
    }
}

/* ---- playing ---- */

typedef struct player {
    noh_transform bind;
    void *clip_memory, *cache_memory;
    noh_clip_cache *cache;
} player;

static void open_player(player *p, const writer *w, uint32_t joints)
{
    const noh_transform bind = { { 0, 0, 0, 1 }, { 0, 0, 0 }, { 1, 1, 1 } };
    const noh_clip *clips[1];
    noh_clip *clip;
    noh_clip_desc desc;
    noh_clip_cache_desc cache;
    noh_error error;
    size_t size;
    memset(p, 0, sizeof *p);
    memset(&desc, 0, sizeof desc);
    memset(&cache, 0, sizeof cache);
    p->bind = bind;
    desc.bytes = w->bytes;
    desc.byte_count = byte_count(w);
    desc.bind = &p->bind;
    desc.joint_count = joints;
    size = noh_clip_size(&desc, &error);
    if (!size) fail_msg("%s (byte %lu)", error.what, (unsigned long)error.where);
    p->clip_memory = malloc(size);
    assert_int_equal(noh_clip_init(p->clip_memory, size, &desc, &clip, &error), NOH_OK);
    clips[0] = clip;
    cache.clips = clips;
    cache.clip_count = 1;
    size = noh_clip_cache_size(&cache, &error);
    p->cache_memory = malloc(size);
    assert_int_equal(noh_clip_cache_init(p->cache_memory, size, &cache, &p->cache, &error), NOH_OK);
}

static void close_player(player *p)
{
    free(p->clip_memory);
    free(p->cache_memory);
}

/* A frame as it was decoded. */
static noh_transform frame_of(player *p, uint32_t frame, uint32_t joints, float *floats)
{
    noh_transform pose = { { 0, 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 } };
    noh_clip_sample(p->cache, 0, (int64_t)frame * FRAME_TICKS, joints, &pose, floats);
    return pose;
}

static void near_to(float value, double wanted)
{
    if (!(fabs((double)value - wanted) <= 2e-6 * fabs(wanted))) fail_msg("%.9g, wanted %.9g", (double)value, wanted);
}

/* ---- tests ---- */

/* Even symbols are 0, 1, 2... finer, odd ones 1, 2... coarser; four to each factor of two. The last symbol is followed
 * by the step itself. With segments of one frame a mean of 1 is a step. */
static void steps_differ_from_those_of_the_header(void **state)
{
    static const int32_t means[3] = { 1, 0, -1 };
    static writer clip, segments[SEGMENTS_MAX];
    player p;
    (void)state;
    put_header(&clip, 0, 0, NOH_CLIP_STEP_SYMBOLS, NOH_CLIP_STEP_SYMBOLS, 3);
    put_float_track(&clip, NOH_CLIP_STEP_SYMBOLS);
    for (uint32_t s = 0; s < NOH_CLIP_STEP_SYMBOLS; s++) {
        put(&segments[s], 0, 1);
        put_step(&segments[s], 0, s);
        if (s == NOH_CLIP_STEP_ESCAPE) put(&segments[s], 40, 8);
        put_means(&segments[s], means, LAST_AT_START);
    }
    put_segments(&clip, segments, NOH_CLIP_STEP_SYMBOLS);
    open_player(&p, &clip, 0);
    for (uint32_t s = 0; s < NOH_CLIP_STEP_SYMBOLS; s++) {
        const double finer = s & 1u ? -(double)((s + 1u) / 2u) : (double)(s / 2u);
        const double step = s == NOH_CLIP_STEP_ESCAPE ? 64.0 : pow(2.0, -finer / 4.0);
        float floats[3];
        (void)frame_of(&p, s, 0, floats);
        near_to(floats[0], step);
        assert_true(floats[1] == 0.0f);
        near_to(floats[2], -step);
    }
    close_player(&p);
}

/* In a clip of one segment a step follows from the previous track's step, of floats and rotations apart; the first from
 * NOH_CLIP_STEP_FIRST. */
static void steps_of_one_segment_follow_each_other(void **state)
{
    static const int32_t one[3] = { 1, 1, 1 }, turn[3] = { 4096, 0, 0 };
    static writer clip, segment;
    const double m = 0.25; /* a quarter of the component, the tangent of a quarter of the turn */
    noh_transform pose;
    player p;
    float floats[6];
    (void)state;
    put_header(&clip, NOH_CLIP_FLAG_WIDE, 1, 1, 1, 6);
    put_float_track(&clip, 1);
    put_float_track(&clip, 1);
    put_rotation_track(&clip, 1, 0);
    put(&segment, 0, 1);
    put_step(&segment, 1, NOH_CLIP_STEP_ESCAPE);
    put(&segment, STEP_OF_ONE, 8);
    put_means(&segment, one, LAST_AT_START);
    put_step(&segment, 1, 3); /* two coarser */
    put_means(&segment, one, 1);
    put_step(&segment, 1, 0); /* 2^(16 - 112 / 4) */
    put_means(&segment, turn, LAST_AT_START);
    put_segments(&clip, &segment, 1);
    open_player(&p, &clip, 1);
    pose = frame_of(&p, 0, 1, floats);
    for (int i = 0; i < 3; i++) {
        near_to(floats[i], 1.0);
        near_to(floats[3 + i], sqrt(2.0));
    }
    near_to(pose.rotation[0], 2.0 * m / (1.0 + m * m));
    near_to(pose.rotation[3], (1.0 - m * m) / (1.0 + m * m));
    close_player(&p);
}

/* What is not finite in a raw track is 0 in the frames, and so is what no unit quaternion has. */
static void raw_values_that_are_not_finite_are_zero(void **state)
{
    const float raw[2][7] = { { 1.5f, NAN, -INFINITY, INFINITY, 0.6f, NAN, 0.8f },
                              { INFINITY, -2.25f, 1e38f, 0.6f, -INFINITY, -0.8f, 2.0f } };
    static const float wanted[2][7] = { { 1.5f, 0, 0, 0, 0.6f, 0, 0.8f }, { 0, -2.25f, 1e38f, 0.6f, 0, -0.8f, 0 } };
    (void)state;
    for (uint32_t wide = 0; wide < 2u; wide++) {
        writer clip, segment;
        player p;
        memset(&clip, 0, sizeof clip);
        memset(&segment, 0, sizeof segment);
        put_header(&clip, wide ? NOH_CLIP_FLAG_WIDE : 0u, 1, 2, 1, 3);
        put_float_track(&clip, 1);
        put_rotation_track(&clip, 1, 0);
        put(&segment, 1, 1);
        put(&segment, 1, 1);
        for (int i = 0; i < 6; i++) put_float(&segment, raw[i / 3][i % 3]);
        put(&segment, 1, 1);
        for (int i = 0; i < 8; i++) put_float(&segment, raw[i / 4][3 + i % 4]);
        put_segments(&clip, &segment, 1);
        open_player(&p, &clip, 1);
        for (uint32_t f = 0; f < 2u; f++) {
            float floats[3];
            const noh_transform pose = frame_of(&p, f, 1, floats);
            for (int i = 0; i < 3; i++) assert_true(floats[i] == wanted[f][i]);
            for (int i = 0; i < 4; i++)
                assert_true(fabsf(pose.rotation[i] - wanted[f][3 + i]) <= (wide ? 1e-6f : 4e-5f));
        }
        close_player(&p);
    }
}

/* Each segment of a wild rotation has a reference of its own, and its sign: in that hemisphere the coefficients lie. */
static void wild_references_have_a_sign(void **state)
{
    static const uint32_t codes[3] = { 511 + 361, 511, 511 - 200 };
    const double unit = sqrt(0.5) / 511.0, x = 361.0 * unit, z = -200.0 * unit, w = sqrt(1.0 - x * x - z * z);
    static writer clip, segments[2];
    player p;
    (void)state;
    put_header(&clip, NOH_CLIP_FLAG_WIDE, 1, 2, 2, 0);
    put_rotation_track(&clip, 2, 1);
    for (uint32_t s = 0; s < 2u; s++) {
        put(&segments[s], 0, 1);
        put_step(&segments[s], 0, 0);
        put(&segments[s], 3, 2); /* w is left out */
        for (int i = 0; i < 3; i++) put(&segments[s], codes[i], NOH_CLIP_WILD_BITS);
        put(&segments[s], s, 1);
        put_symbol(&segments[s], noh_clip_last_table[noh_clip_last_context(LAST_AT_START)], NOH_CLIP_LAST_BITS, 0);
    }
    put_segments(&clip, segments, 2);
    open_player(&p, &clip, 1);
    for (uint32_t s = 0; s < 2u; s++) {
        const noh_transform pose = frame_of(&p, s, 1, NULL);
        const double sign = s ? -1.0 : 1.0;
        near_to(pose.rotation[0], sign * x);
        assert_true(pose.rotation[1] == 0.0f);
        near_to(pose.rotation[2], sign * z);
        near_to(pose.rotation[3], sign * w);
    }
    close_player(&p);
}

/* ---- transforms ---- */

/* Frame f of row k: even rows are mirrored, odd ones also negated. */
static double row_at(const float *rows, uint32_t frames, uint32_t k, uint32_t f)
{
    const uint32_t half = noh_clip_basis_half(frames), mirror = frames - 1u - f;
    const double v = (double)rows[k * half + (f < mirror ? f : mirror)];
    return f > mirror && k % 2u ? -v : v;
}

/* So errors of coefficients and of frames have one size, and the second transform spends three coefficients on a
 * constant, a slope and a bend. */
static void transforms_are_orthonormal(void **state)
{
    static float rows[NOH_CLIP_SEGMENT_FRAMES_MAX * NOH_CLIP_SEGMENT_FRAMES_MAX];
    (void)state;
    for (uint32_t i = 0; i < NOH_CLIP_BASES * NOH_CLIP_SEGMENT_FRAMES_MAX; i++) {
        const uint32_t frames = i / NOH_CLIP_BASES + 1u, parabola = i % NOH_CLIP_BASES;
        noh_clip_basis_build(frames, parabola, rows);
        for (uint32_t a = 0; a < frames; a++) {
            double square = 0.0;
            for (uint32_t b = 0; b < frames; b++) {
                double sum = 0.0;
                for (uint32_t f = 0; f < frames; f++) sum += row_at(rows, frames, a, f) * row_at(rows, frames, b, f);
                assert_true(fabs(sum - (a == b ? 1.0 : 0.0)) < 1e-6);
            }
            for (uint32_t f = 0; f < frames; f++) {
                const double x = (double)f / (double)frames;
                square += row_at(rows, frames, a, f) * (0.3 + 2.0 * x - 1.5 * x * x);
            }
            if (parabola && a > 2u) assert_true(fabs(square) < 1e-6);
        }
    }
}

/* What is skipped stays as it was, and the rest is what it is without skipping. */
static void skipped_frames_stay(void **state)
{
    float rows[40 * 20], coefs[40][4], reference[4] = { 0.0f, 0.6f, 0.0f, 0.8f };
    uint8_t whole[40 * 16], part[sizeof whole];
    noh_clip_basis basis = { 37, noh_clip_basis_half(37), rows, 0, 0 };
    (void)state;
    noh_clip_basis_build(37, 1, rows);
    for (uint32_t k = 0; k < 160u; k++) coefs[k / 4u][k % 4u] = 0.3f / (float)(1u + k % 7u);
    for (int kind = 0; kind < 3; kind++) {
        memset(whole, 0, sizeof whole);
        memset(part, 0x55, sizeof part);
        for (int skips = 0; skips < 2; skips++) {
            uint8_t *out = skips ? part : whole;
            basis.skip = skips ? ~4u : 0u; /* but frames 8 to 11, and 25 to 28 */
            if (kind < 2) {
                noh_clip_synth_rotation(&basis, (const float(*)[4])coefs, 9, reference, kind, out, 16);
            } else {
                noh_clip_synth_linear(&basis, (const float(*)[4])coefs, 9, reference, out, 16);
            }
        }
        for (uint32_t f = 0; f < 37u; f++) {
            const size_t bytes = kind == 0 ? 8u : kind == 1 ? 16u : 12u;
            const int wanted = (f >= 8u && f < 12u) || (f >= 25u && f < 29u);
            assert_int_equal(noh_clip_quad_bit(f, 37) == 4u, wanted);
            if (wanted) assert_memory_equal(part + 16u * f, whole + 16u * f, bytes);
            for (size_t i = 0; i < 16u && !wanted; i++) assert_int_equal(part[16u * f + i], 0x55);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_differ_from_those_of_the_header),
        cmocka_unit_test(steps_of_one_segment_follow_each_other),
        cmocka_unit_test(raw_values_that_are_not_finite_are_zero),
        cmocka_unit_test(wild_references_have_a_sign),
        cmocka_unit_test(transforms_are_orthonormal),
        cmocka_unit_test(skipped_frames_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
