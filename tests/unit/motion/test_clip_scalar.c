/* Tests of the clip decoder's kernels: the ones of this build, the scalar twins and, where the
 * processor has it, AVX2 (clip_sample.c built again, see the Makefile) give the same bits. */
#include "support/support.h"

#include <string.h>

#define NOH_SIMD_SCALAR 1
#define noh_clip_blend_frames blend_scalar
#define noh_clip_synth_rotation synth_rotation_scalar
#define noh_clip_synth_linear synth_linear_scalar
#define noh_clip_store_rotation store_rotation_scalar
#define noh_clip_basis_build basis_build_scalar
#define noh_clip_dequantise dequantise_scalar
#define noh_clip_step step_scalar
#define noh_clip_quat_expand quat_expand_scalar
#define noh_clip_quat_unit quat_unit_scalar
#define noh_clip_mix_matrix mix_matrix_scalar
#include "motion/clip/clip_sample.c"
#include "motion/clip/clip_synth.c"
#undef noh_clip_blend_frames
#undef noh_clip_synth_rotation
#undef noh_clip_synth_linear
#undef noh_clip_store_rotation

void noh_clip_blend_frames(const noh_clip *clip, const uint8_t *a, const uint8_t *b, float fraction, uint32_t joints,
                           noh_transform *out, float *floats);
void noh_clip_blend_frames_avx2(const noh_clip *clip, const uint8_t *a, const uint8_t *b, float fraction,
                                uint32_t joints, noh_transform *out, float *floats);
void noh_clip_synth_rotation(const noh_clip_basis *basis, const float (*coefs)[4], uint32_t last,
                             const float reference[4], int wide, uint8_t *out, size_t stride);
void noh_clip_synth_linear(const noh_clip_basis *basis, const float (*coefs)[4], uint32_t last,
                           const float reference[3], uint8_t *out, size_t stride);
void noh_clip_store_rotation(const float q[4], int wide, uint8_t *out);

typedef void (*blend)(const noh_clip *clip, const uint8_t *a, const uint8_t *b, float fraction, uint32_t joints,
                      noh_transform *out, float *floats);

#define JOINTS 41u
#define LINEARS 7u
#define FRAME_BYTES 1024u
#define TRIES 4000u

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static float random_float(uint32_t *state, float size)
{
    return ((float)(next_random(state) & 0xffffu) / 32768.0f - 1.0f) * size;
}

/* ---- sampling ---- */

typedef struct made_up {
    struct noh_clip clip;
    noh_transform pose[JOINTS];
    noh_clip_prefix prefixes[JOINTS + 1u];
    uint32_t offsets[JOINTS];
    noh_clip_linear linears[LINEARS];
} made_up;

/* A clip of `joints` joints, some of them still, every sixth with a translation or scale. */
static void make_clip(made_up *m, uint32_t joints, int wide, uint32_t *state)
{
    uint32_t rotations = 0, linears = 0;
    memset(m, 0, sizeof *m);
    for (uint32_t j = 0; j < joints; j++) {
        m->prefixes[j].rotations = (uint16_t)rotations;
        m->prefixes[j].linears = (uint16_t)linears;
        for (uint32_t i = 0; i < 10u; i++) ((float *)&m->pose[j])[i] = random_float(state, 9.0f);
        if (next_random(state) % 8u) m->offsets[rotations++] = (uint32_t)(j * sizeof(noh_transform));
        if (j % 6u == 0u) {
            m->linears[linears].joint = (uint16_t)j;
            m->linears[linears++].kind = j % 12u ? NOH_CLIP_SCALE : NOH_CLIP_TRANSLATION;
        }
    }
    m->prefixes[joints].rotations = (uint16_t)rotations;
    m->prefixes[joints].linears = (uint16_t)linears;
    m->clip.info.joint_count = joints;
    m->clip.info.flags = wide ? NOH_CLIP_FLAG_WIDE : 0u;
    m->clip.rotation_count = rotations;
    m->clip.linear_count = linears;
    m->clip.weight_one = 32000u;
    m->clip.linear_offset = (rotations + NOH_CLIP_GROUP - 1u) / NOH_CLIP_GROUP * NOH_CLIP_GROUP * (wide ? 16u : 8u);
    m->clip.frame_bytes = FRAME_BYTES;
    m->clip.pose = m->pose;
    m->clip.prefixes = m->prefixes;
    m->clip.rotation_offsets = m->offsets;
    m->clip.linears = m->linears;
}

/* Quaternions as a cache holds them; one in sixteen of a try's components is extreme. */
static void fill_frame(uint8_t *frame, const noh_clip *clip, int wide, uint32_t *state)
{
    static const int16_t extremes[4] = { 0, 32767, -32767, -32768 };
    memset(frame, 0, FRAME_BYTES);
    for (uint32_t i = 0; i < 4u * clip->rotation_count; i++) {
        const int16_t v = next_random(state) % 16u ? (int16_t)(int32_t)random_float(state, 32767.0f)
                                                   : extremes[next_random(state) % 4u];
        const float f = (float)v / 32767.0f;
        memcpy(frame + (wide ? 4u : 2u) * i, wide ? (const void *)&f : (const void *)&v, wide ? 4u : 2u);
    }
    for (uint32_t i = 0; i < 3u * clip->linear_count; i++) {
        const float f = random_float(state, 100.0f);
        memcpy(frame + clip->linear_offset + 4u * i, &f, 4u);
    }
}

static void same_samples(blend other, int wide)
{
    static uint8_t frames[2][FRAME_BYTES] __attribute__((aligned(16)));
    uint32_t state = 0x6e6f68u;
    for (uint32_t i = 0; i < TRIES; i++) {
        noh_transform here[JOINTS], there[JOINTS];
        made_up m;
        const uint32_t joints = next_random(&state) % (JOINTS + 1u);
        const uint32_t prefix = next_random(&state) % 2u ? joints : next_random(&state) % (joints + 1u);
        const float fraction = (float)(next_random(&state) & 0xfffu) / 4096.0f;
        make_clip(&m, joints, wide, &state);
        fill_frame(frames[0], &m.clip, wide, &state);
        fill_frame(frames[1], &m.clip, wide, &state);
        memset(here, 0x55, sizeof here);
        memset(there, 0x55, sizeof there);
        noh_clip_blend_frames(&m.clip, frames[0], frames[1], fraction, prefix, here, NULL);
        other(&m.clip, frames[0], frames[1], fraction, prefix, there, NULL);
        assert_memory_equal(here, there, sizeof here);
    }
}

static void samples_are_the_scalar_twins(void **state)
{
    (void)state;
    same_samples(blend_scalar, 0);
    same_samples(blend_scalar, 1);
}

static void samples_are_the_same_with_avx2(void **state)
{
    (void)state;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) {
        same_samples(noh_clip_blend_frames_avx2, 0);
        same_samples(noh_clip_blend_frames_avx2, 1);
        return;
    }
#endif
    print_message("SKIP: this processor has no AVX2\n");
    skip();
}

/* ---- decoding ---- */

#define STRIDE 32u

/* With `skip` what is skipped stays 0, and the rest is as without. */
static void expect_skipped(const noh_clip_basis *basis, const uint8_t *whole, const uint8_t *some)
{
    const uint32_t slots = noh_clip_slots(basis->frames, basis->halved);
    static const uint8_t none[STRIDE];
    for (uint32_t s = 0; s < slots; s++) {
        const int is_skipped = (basis->skip & noh_clip_quad_bit(s, slots)) != 0;
        assert_memory_equal(some + s * STRIDE, is_skipped ? none : whole + s * STRIDE, STRIDE);
    }
}

static void frames_are_the_scalar_twins(void **state)
{
    static float rows[NOH_CLIP_SEGMENT_FRAMES_MAX * NOH_CLIP_SEGMENT_FRAMES_MAX];
    uint32_t seed = 5;
    (void)state;
    for (uint32_t frames = 1; frames <= NOH_CLIP_SEGMENT_FRAMES_MAX; frames++) {
        noh_clip_basis basis = { frames, noh_clip_basis_half(frames), rows, frames % 3u ? 0u : 2u, 0 };
        basis_build_scalar(frames, frames % 2u, rows);
        for (uint32_t i = 0; i < 12u; i++) {
            float coefs[NOH_CLIP_SEGMENT_FRAMES_MAX][4], reference[4];
            uint8_t here[NOH_CLIP_SEGMENT_FRAMES_MAX * STRIDE], there[sizeof here];
            const uint32_t last = next_random(&seed) % (frames + 1u), size = next_random(&seed) % 3u;
            basis.halved = i % 2u;
            for (uint32_t k = 0; k < frames * 4u; k++)
                coefs[k / 4u][k % 4u] = random_float(&seed, size == 2u ? 1e9f : 1.0f);
            for (uint32_t k = 0; k < 4u; k++) reference[k] = random_float(&seed, 0.5f);
            for (int kind = 0; kind < 3; kind++) {
                memset(here, 0, sizeof here);
                memset(there, 0, sizeof there);
                if (kind < 2) {
                    noh_clip_synth_rotation(&basis, (const float(*)[4])coefs, last, reference, kind, here, STRIDE);
                    synth_rotation_scalar(&basis, (const float(*)[4])coefs, last, reference, kind, there, STRIDE);
                } else {
                    noh_clip_synth_linear(&basis, (const float(*)[4])coefs, last, reference, here, STRIDE);
                    synth_linear_scalar(&basis, (const float(*)[4])coefs, last, reference, there, STRIDE);
                }
                assert_memory_equal(here, there, sizeof here);
                if (!basis.skip) continue;
                noh_clip_basis all = basis;
                all.skip = 0;
                memset(there, 0, sizeof there);
                if (kind < 2) {
                    noh_clip_synth_rotation(&all, (const float(*)[4])coefs, last, reference, kind, there, STRIDE);
                } else {
                    noh_clip_synth_linear(&all, (const float(*)[4])coefs, last, reference, there, STRIDE);
                }
                expect_skipped(&basis, there, here);
            }
        }
    }
}

static void raw_rotations_are_the_scalar_twins(void **state)
{
    static const float odd[8] = { 0.0f, 1.0f, -1.0f, 1.00005f, 2.0f, 1e30f, -1e-40f, 0.99998f };
    uint32_t seed = 9;
    (void)state;
    for (uint32_t i = 0; i < TRIES; i++) {
        float q[4];
        for (uint32_t k = 0; k < 4u; k++)
            q[k] = next_random(&seed) % 3u ? random_float(&seed, 1.0f) : odd[next_random(&seed) % 8u];
        for (int wide = 0; wide < 2; wide++) {
            uint8_t here[16] = { 0 }, there[16] = { 0 };
            noh_clip_store_rotation(q, wide, here);
            store_rotation_scalar(q, wide, there);
            assert_memory_equal(here, there, sizeof here);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_are_the_scalar_twins),
        cmocka_unit_test(samples_are_the_same_with_avx2),
        cmocka_unit_test(frames_are_the_scalar_twins),
        cmocka_unit_test(raw_rotations_are_the_scalar_twins),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
