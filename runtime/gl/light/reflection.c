#include "noh/base.h"
#include "noh/light.h"
#include "noh/low_core.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"
#include "gl/light/light_internal.h"

/* A face's direction at s, t of -1..1: middle + s * across + t * down. */
static const float faces[6][3][3] = {
    { { 1, 0, 0 }, { 0, 0, -1 }, { 0, -1, 0 } }, { { -1, 0, 0 }, { 0, 0, 1 }, { 0, -1, 0 } },
    { { 0, 1, 0 }, { 1, 0, 0 }, { 0, 0, 1 } },   { { 0, -1, 0 }, { 1, 0, 0 }, { 0, 0, -1 } },
    { { 0, 0, 1 }, { 1, 0, 0 }, { 0, -1, 0 } },  { { 0, 0, -1 }, { -1, 0, 0 }, { 0, -1, 0 } },
};

static int is_side(uint32_t side)
{
    return side >= 16u && side <= NOH_REFLECTION_SIDE_MAX && (side & (side - 1u)) == 0;
}

uint32_t noh_reflection_first(uint32_t side, uint32_t level)
{
    uint32_t texels = 0;
    for (uint32_t i = 0; i < level; i++) texels += 6u * (side >> i) * (side >> i);
    return texels;
}

size_t noh_reflection_size(uint32_t side)
{
    side = side ? side : 64u;
    return is_side(side) ? sizeof(uint32_t) * noh_reflection_first(side, NOH_REFLECTION_LEVELS) : 0;
}

/* Level 0 to 2 unblurred. */
#define SOURCES 3u

size_t noh_reflection_scratch_size(uint32_t side)
{
    side = side ? side : 64u;
    return is_side(side) ? 3u * sizeof(float) * noh_reflection_first(side, SOURCES) : 0;
}

void noh_reflection_of_environment(const void *user, const float direction[3], float rgb[3])
{
    noh_environment_radiance(user, direction, rgb);
}

static void face_direction(uint32_t face, float s, float t, float direction[3])
{
    for (uint32_t k = 0; k < 3u; k++) {
        direction[k] = faces[face][0][k] + s * faces[face][1][k] + t * faces[face][2][k];
    }
    noh_normalize3(direction, faces[face][0]);
}

void noh_reflection_direction(uint32_t side, uint32_t face, uint32_t x, uint32_t y, float direction[3])
{
    NOH_ASSERT(face < 6u && x < side && y < side && direction);
    face_direction(face, (2.0f * (float)x + 1.0f) / (float)side - 1.0f, (2.0f * (float)y + 1.0f) / (float)side - 1.0f,
                   direction);
}

/* ---- texels ---- */

static float power_of_two(int exponent) /* -126..127 */
{
    const uint32_t bits = (uint32_t)(exponent + 127) << 23;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* source  OpenGL ES 3.0, section 3.8.3, RGB9_E5 */
static uint32_t pack_texel(const float rgb[3])
{
    uint32_t bits, texel, parts[3];
    float c[3], most = 0.0f, scale;
    int exponent;
    for (uint32_t k = 0; k < 3u; k++) {
        c[k] = rgb[k] > 0.0f ? (rgb[k] < 65408.0f ? rgb[k] : 65408.0f) : 0.0f; /* NaN: 0 */
        most = c[k] > most ? c[k] : most;
    }
    memcpy(&bits, &most, sizeof bits);
    exponent = (int)(bits >> 23) - 127 + 1 + 15; /* floor(log2) and the bias */
    exponent = exponent < 0 ? 0 : exponent;
    if (most * power_of_two(15 + 9 - exponent) >= 511.5f) exponent++;
    scale = power_of_two(15 + 9 - exponent);
    for (uint32_t k = 0; k < 3u; k++) parts[k] = (uint32_t)(c[k] * scale + 0.5f);
    texel = parts[0] | parts[1] << 9 | parts[2] << 18 | (uint32_t)exponent << 27;
    return texel;
}

void noh_reflection_texel(const noh_reflection *reflection, uint32_t level, uint32_t face, uint32_t x, uint32_t y,
                          float rgb[3])
{
    NOH_ASSERT(reflection && level < NOH_REFLECTION_LEVELS && face < 6u);
    const uint32_t n = reflection->side >> level;
    NOH_ASSERT(x < n && y < n && rgb);
    const uint32_t texel = reflection->texels[noh_reflection_first(reflection->side, level) + (face * n + y) * n + x];
    const float scale = power_of_two((int)(texel >> 27) - 15 - 9);
    for (uint32_t k = 0; k < 3u; k++) rgb[k] = (float)(texel >> 9u * k & 511u) * scale;
}

/* ---- sources ---- */

#define SAMPLES 4u /* along each side of a texel */

static void sample_texel(const noh_reflection_desc *desc, uint32_t side, uint32_t face, uint32_t x, uint32_t y,
                         float *rgb)
{
    float sum[3] = { 0.0f, 0.0f, 0.0f };
    for (uint32_t i = 0; i < SAMPLES * SAMPLES; i++) {
        const float fine = (float)(side * SAMPLES);
        const uint32_t column = x * SAMPLES + i % SAMPLES, row = y * SAMPLES + i / SAMPLES;
        const float s = (2.0f * (float)column + 1.0f) / fine - 1.0f;
        const float t = (2.0f * (float)row + 1.0f) / fine - 1.0f;
        float direction[3], one[3];
        face_direction(face, s, t, direction);
        desc->radiance(desc->user, direction, one);
        for (uint32_t k = 0; k < 3u; k++) sum[k] += one[k];
    }
    for (uint32_t k = 0; k < 3u; k++) rgb[k] = sum[k] * (1.0f / (float)(SAMPLES * SAMPLES));
}

static float *source_at(float *sources, uint32_t side, uint32_t level, uint32_t face, uint32_t x, uint32_t y)
{
    const uint32_t n = side >> level;
    return sources + 3u * (size_t)(noh_reflection_first(side, level) + (face * n + y) * n + x);
}

static void make_sources(const noh_reflection_desc *desc, uint32_t side, float *sources)
{
    for (uint32_t i = 0; i < 6u * side * side; i++) {
        sample_texel(desc, side, i / (side * side), i % side, i / side % side, sources + 3u * (size_t)i);
    }
    for (uint32_t level = 1; level < SOURCES; level++) {
        const uint32_t n = side >> level;
        for (uint32_t i = 0; i < 6u * n * n; i++) {
            const uint32_t face = i / (n * n), x = i % n, y = i / n % n;
            float *to = source_at(sources, side, level, face, x, y);
            const float *from = source_at(sources, side, level - 1u, face, 2u * x, 2u * y);
            for (uint32_t k = 0; k < 3u; k++) {
                to[k] = 0.25f * (from[k] + from[k + 3u] + from[k + 6u * n] + from[k + 6u * n + 3u]);
            }
        }
    }
}

/* ---- blurring ---- */

/* The middle of a texel on the cube, and 1 / its distance from the centre. They are the same for each texel that is
 * blurred, so they are computed once, for levels 1 and 2, in the memory of level 0's source, which is packed by
 * then. */
typedef struct ray {
    float to[3], inverse;
} ray;

typedef struct blur {
    const float *sources; /* from level 1 */
    const ray *rays;      /* their middles */
    uint32_t coarse;      /* texels of a face's side at level 2 */
    int is_narrow;        /* level 1 is taken near the middle */
    float a2;             /* alpha squared */
    float direction[3];
    float sum[3], weight;
} blur;

static void make_rays(uint32_t side, ray *r)
{
    for (uint32_t level = 1; level < SOURCES; level++) {
        const uint32_t n = side >> level;
        for (uint32_t i = 0; i < 6u * n * n; i++, r++) {
            const float(*face)[3] = faces[i / (n * n)];
            const float s = (2.0f * (float)(i % n) + 1.0f) / (float)n - 1.0f;
            const float t = (2.0f * (float)(i / n % n) + 1.0f) / (float)n - 1.0f;
            for (uint32_t k = 0; k < 3u; k++) r->to[k] = face[0][k] + s * face[1][k] + t * face[2][k];
            r->inverse = 1.0f / noh_sqrt(1.0f + s * s + t * t);
        }
    }
}

/* GGX of the half vector between the direction and a light, times t, as a function of the cosine t between the two (the
 * half vector's cosine is sqrt((1 + t) / 2)); without constant factors. */
static float lobe(float a2, float t)
{
    const float d = 0.5f * (1.0f + t) * (a2 - 1.0f) + 1.0f;
    return t / (d * d);
}

/* Texel i of the sources, whose level has this share of a face in each texel. */
static void add_source(blur *b, uint32_t i, float cosine, float share)
{
    const float inverse = b->rays[i].inverse;
    float weight;
    if (cosine <= 0.0f) return;
    weight = lobe(b->a2, cosine) * inverse * inverse * inverse * share; /* times the solid angle */
    for (uint32_t k = 0; k < 3u; k++) b->sum[k] += weight * b->sources[3u * (size_t)i + k];
    b->weight += weight;
}

static float cosine_of(const blur *b, uint32_t i)
{
    return noh_dot3(b->direction, b->rays[i].to) * b->rays[i].inverse;
}

/* All texels of level 2. Near the middle of a narrow blur, the four texels of level 1 take the place of each. */
static void blur_texel(blur *b, float rgb[3])
{
    const uint32_t n = b->coarse, fine = 2u * n;
    const float share = 1.0f / (float)(n * n);
    memset(b->sum, 0, sizeof b->sum);
    b->weight = 0.0f;
    for (uint32_t i = 0; i < 6u * n * n; i++) {
        const uint32_t at = 6u * fine * fine + i, corner = 2u * (i / n) * fine + 2u * (i % n);
        const float cosine = cosine_of(b, at);
        if (b->is_narrow && cosine > 0.85f) {
            for (uint32_t j = 0; j < 4u; j++) {
                const uint32_t one = corner + j / 2u * fine + j % 2u;
                add_source(b, one, cosine_of(b, one), 0.25f * share);
            }
        } else {
            add_source(b, at, cosine, share);
        }
    }
    for (uint32_t k = 0; k < 3u; k++) rgb[k] = b->sum[k] / b->weight;
}

static void blur_level(const float *sources, const ray *rays, uint32_t side, uint32_t level, uint32_t *texels)
{
    const uint32_t n = side >> level;
    const float roughness = (float)level / (float)(NOH_REFLECTION_LEVELS - 1u), alpha = roughness * roughness;
    blur b = {
        sources, rays, side >> (SOURCES - 1u), level == 1u, alpha * alpha, { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f },
        0.0f
    };
    for (uint32_t i = 0; i < 6u * n * n; i++) {
        float rgb[3];
        noh_reflection_direction(n, i / (n * n), i % n, i / n % n, b.direction);
        blur_texel(&b, rgb);
        texels[i] = pack_texel(rgb);
    }
}

static void make_levels(float *sources, uint32_t side, uint32_t *texels)
{
    ray *rays = (ray *)(void *)sources;
    for (uint32_t i = 0; i < 6u * side * side; i++) texels[i] = pack_texel(sources + 3u * (size_t)i);
    make_rays(side, rays);
    for (uint32_t level = 1; level < NOH_REFLECTION_LEVELS; level++) {
        blur_level(source_at(sources, side, 1, 0, 0, 0), rays, side, level, texels + noh_reflection_first(side, level));
    }
}

noh_result noh_reflection_init(void *memory, size_t bytes, void *scratch, size_t scratch_bytes,
                               const noh_reflection_desc *desc, noh_reflection *out, noh_error *error)
{
    noh_arena arena;
    noh_result result;
    NOH_ASSERT(desc && out);
    const uint32_t side = desc->side ? desc->side : 64u;
    if (!is_side(side) || !desc->radiance) {
        return noh_fail(error, NOH_ERR_ARG, "reflection: radiance is NULL, or side is not a power of 2 from 16 to 128",
                        side, 0);
    }
    result = noh_arena_open(&arena, scratch, scratch_bytes, noh_reflection_scratch_size(side), error);
    if (result == NOH_OK) result = noh_arena_open(&arena, memory, bytes, noh_reflection_size(side), error);
    if (result != NOH_OK) {
        return result;
    }
    make_sources(desc, side, scratch);
    make_levels(scratch, side, memory);
    out->side = side;
    out->texels = memory;
    return NOH_OK;
}
