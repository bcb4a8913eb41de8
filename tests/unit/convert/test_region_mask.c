/* test_region_mask.c: masks of wrinkle regions decoded exactly, and the mask clinic on damage of every kind. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/wrinkle/mask_clinic.h"

#define SIZE 128
#define TEXELS (SIZE * SIZE)

/* The source's segments, written out. */
static int in_segment(int code)
{
    return code <= 75 || (code >= 90 && code <= 165) || code >= 180;
}

static void all_codes_decode_exactly(void **state)
{
    (void)state;
    for (int code = 0; code < 256; ++code) {
        const int region = code < 90 ? 0 : code < 180 ? 1 : 2, offset = code - 90 * region;
        const float ramp = fminf((float)offset * 0.014f, 1.0f), weight = in_segment(code) ? ramp : 0.0f;
        assert_int_equal(region_of_code((uint8_t)code), region);
        assert_int_equal(region_is_guard((uint8_t)code), !in_segment(code));
        assert_true(region_weight((uint8_t)code) == weight);
        assert_int_equal(region_weight_byte((uint8_t)code), (int)floorf(weight * 255.0f + 0.5f));
    }
    assert_true(region_weight(71) < 1.0f && region_weight(72) == 1.0f && region_weight(75) == 1.0f);
}

/* Maps of one region a channel become a mask, and the mask the same maps, to half a step; a mask that was decoded comes
 * back but for codes that mean the same. */
static void maps_become_masks_and_back(void **state)
{
    (void)state;
    static uint8_t codes[256 * 4], *maps[REGION_MAP_COUNT], *again[REGION_MAP_COUNT];
    const region_mask painted = { 16, 16, codes };
    region_mask made;
    for (int i = 0; i < 256; ++i) {
        for (int c = 0; c < 4; ++c) codes[4 * i + c] = (uint8_t)(i + 67 * c);
    }
    assert_int_equal(region_maps_make(&painted, maps), 0);
    assert_int_equal(region_mask_make(maps, 16, 16, &made), 0);
    assert_int_equal(region_maps_make(&made, again), 0);
    for (int i = 0; i < 1024; ++i) {
        const int is_none = codes[i] % 90 == 0 || codes[i] % 90 > 75;
        assert_int_equal(made.rgba[i], is_none ? 0 : codes[i] % 90 >= 72 ? codes[i] / 90 * 90 + 75 : codes[i]);
        for (uint32_t k = 0; k < REGION_MAP_COUNT; ++k) assert_int_equal(again[k][i], maps[k][i]);
    }
    for (uint32_t k = 0; k < REGION_MAP_COUNT; ++k) {
        free(maps[k]);
        free(again[k]);
    }
    region_mask_free(&made);
}

/* "offset = value % 90" reads a name that is not there. Taken from another channel, or as the code itself, the weight
 * is another one. */
static void the_remainder_is_of_the_same_channel(void **state)
{
    (void)state;
    float weights[REGION_COUNT];
    int differ = 0;
    for (uint32_t r = 0; r < REGION_COUNT; ++r) weights[r] = 1.0f;
    const uint8_t texel[4] = { 40, 165, 0, 0 };
    const float literal = region_weight(texel[1]) * weights[0]; /* red with green's remainder */
    assert_true(literal == 1.0f);
    assert_true(region_texel_weight((const uint8_t[4]){ 40, 0, 0, 0 }, weights) == 40 * 0.014f);
    for (int code = 0; code < 256; ++code) {
        const float as_code = code <= 75 ? fminf((float)code * 0.014f, 1.0f) : 0.0f;
        differ += as_code != region_weight((uint8_t)code);
    }
    assert_int_equal(differ, 75 + 75); /* all of the upper two regions but their zeros */
}

/* Rounded, a code survives a sampler that is off by less than half a step either way; cut, it loses one as soon as the
 * sampler is below it. */
static void codes_are_rounded_not_cut(void **state)
{
    (void)state;
    int cut_wrong = 0;
    for (int code = 0; code < 256; ++code) {
        for (int side = -1; side <= 1; side += 2) {
            const double sampled = code / 255.0 * (1.0 + side * 1e-6);
            assert_int_equal((int)(sampled * 255.0 + 0.5), code);
            cut_wrong += (int)(sampled * 255.0) != code;
        }
        assert_true(fabsf((float)region_weight_byte((uint8_t)code) - 255.0f * region_weight((uint8_t)code)) <= 0.5f);
    }
    assert_int_equal(cut_wrong, 255);
}

static void random_mask(test_random *r, region_mask *mask)
{
    for (size_t i = 0; i < 4u * mask->width * mask->height; ++i) {
        mask->rgba[i] = (uint8_t)(test_random_below(r, 256));
    }
}

/* The three maps give, on every texel and for every weight, what the codes give. */
static void maps_equal_codes_on_every_texel(void **state)
{
    (void)state;
    region_mask mask = { SIZE, SIZE, malloc(4 * TEXELS) };
    uint8_t *maps[REGION_MAP_COUNT];
    test_random r = test_random_from(11);
    random_mask(&r, &mask);
    for (int code = 0; code < 256; ++code) memset(&mask.rgba[4 * code], code, 4);
    assert_int_equal(region_maps_make(&mask, maps), 0);
    for (int i = 0; i < TEXELS; ++i) {
        float weights[REGION_COUNT];
        const uint8_t *texels[REGION_MAP_COUNT] = { maps[0] + 4 * i, maps[1] + 4 * i, maps[2] + 4 * i };
        for (uint32_t k = 0; k < REGION_COUNT; ++k) weights[k] = test_random_float(&r, 0.0f, 1.0f);
        for (uint32_t c = 0; c < 4; ++c) {
            const uint8_t code = mask.rgba[4 * i + (int)c];
            for (uint32_t k = 0; k < 3; ++k) {
                assert_int_equal(texels[k][c], k == region_of_code(code) ? region_weight_byte(code) : 0);
            }
        }
        assert_true(fabsf(region_maps_weight(texels, weights) - region_texel_weight(&mask.rgba[4 * i], weights)) <=
                    0.5f / 255.0f + 1e-6f);
    }
    for (uint32_t k = 0; k < REGION_MAP_COUNT; ++k) free(maps[k]);
    region_mask_free(&mask);
}

/* Overlapping regions do not add. */
static void the_largest_channel_counts(void **state)
{
    (void)state;
    const float weights[REGION_COUNT] = { 0.25f, 0, 0, 0, 0.75f, 0, 0, 0, 0, 0, 0, 0.5f };
    assert_true(region_texel_weight((const uint8_t[4]){ 75, 165, 0, 255 }, weights) == 0.75f);
    assert_true(region_texel_weight((const uint8_t[4]){ 75, 75, 0, 255 }, weights) == 0.5f);
    assert_true(region_texel_weight((const uint8_t[4]){ 75, 0, 0, 0 }, weights) == 0.25f);
    assert_true(region_texel_weight((const uint8_t[4]){ 80, 170, 80, 79 }, weights) == 0.0f);
}

/* ---- masks as they are painted ---- */

/* Twelve discs, one for each region, whole in the middle and fading over `fade` texels inside the edge (0: not). */
static uint8_t painted(uint32_t c, double x, double y, double fade)
{
    for (uint32_t k = 0; k < 3; ++k) {
        const double dx = x - (24 + 40 * k), dy = y - (20 + 29 * c), inside = 13 - sqrt(dx * dx + dy * dy);
        if (inside > 0) {
            const double share = fade > 0 ? fmin(inside / fade, 1.0) : 1.0;
            return (uint8_t)(90 * k + floor(75 * share + 0.5));
        }
    }
    return 0;
}

static region_mask paint(double fade)
{
    region_mask mask = { SIZE, SIZE, malloc(4 * TEXELS) };
    for (uint32_t i = 0; i < 4 * TEXELS; ++i) {
        mask.rgba[i] = painted(i % 4, (i / 4) % SIZE + 0.5, i / 4 / SIZE + 0.5, fade);
    }
    return mask;
}

static region_mask copy_of(const region_mask *from)
{
    region_mask mask = { from->width, from->height, malloc(4 * TEXELS) };
    memcpy(mask.rgba, from->rgba, 4 * TEXELS);
    return mask;
}

static uint32_t sum4(const uint32_t *counts)
{
    return counts[0] + counts[1] + counts[2] + counts[3];
}

static mask_findings examine(const region_mask *mask)
{
    static mask_findings found;
    assert_int_equal(mask_examine(mask, &found), 0);
    return found;
}

/* Share of the painted texels and channels that have their region with its weight, within `off`. */
static double agreement(const region_mask *a, const region_mask *b, float off)
{
    int painted_count = 0, same = 0;
    for (int i = 0; i < 4 * TEXELS; ++i) {
        const float wa = region_weight(a->rgba[i]), wb = region_weight(b->rgba[i]);
        if (wa <= 0.0f && wb <= 0.0f) continue;
        ++painted_count;
        same += fabsf(wa - wb) <= off &&
                (wa <= 0.1f || wb <= 0.1f || region_of_code(a->rgba[i]) == region_of_code(b->rgba[i]));
    }
    return (double)same / painted_count;
}

static void check_repair(const char *what, const region_mask *clean, region_mask *damaged, float off, double least)
{
    const mask_findings before = examine(damaged);
    const double was = agreement(clean, damaged, off);
    const uint32_t changed = mask_repair(damaged, &before);
    const mask_findings after = examine(damaged);
    const double is = agreement(clean, damaged, off);
    print_message("%s: %u illegal codes, %u seams, regions right %.4f, repaired %.4f (%u texels changed)\n", what,
                  sum4(before.guard), sum4(before.seams), was, is, changed);
    assert_true(changed > 0 && changed != UINT32_MAX);
    assert_int_equal(sum4(after.guard), 0);
    assert_int_equal(after.damage, 0);
    assert_true(is >= least && is > was);
}

static void clean_masks_are_clean(void **state)
{
    (void)state;
    for (int fade = 0; fade <= 12; fade += 6) {
        region_mask mask = paint(fade), before = copy_of(&mask);
        const mask_findings found = examine(&mask);
        assert_int_equal(found.damage, 0);
        assert_int_equal(sum4(found.guard), 0);
        for (uint32_t r = 0; r < REGION_COUNT; ++r) {
            const mask_region *region = &found.regions[r];
            assert_in_range(region->texels, 500, 550); /* discs of radius 13 */
            assert_in_range(region->left, 11 + 40 * (r % 3), 12 + 40 * (r % 3));
            assert_in_range(region->bottom, 31 + 29 * (r / 3), 33 + 29 * (r / 3));
            assert_true(fade ? region->full < region->texels : region->full == region->texels);
        }
        assert_int_equal(mask_repair(&mask, &found), 0);
        assert_memory_equal(mask.rgba, before.rgba, 4 * TEXELS);
        region_mask_free(&mask);
        region_mask_free(&before);
    }
}

static void anti_aliasing_is_found(void **state)
{
    (void)state;
    region_mask clean = paint(0), damaged = copy_of(&clean);
    for (uint32_t i = 0; i < 4 * TEXELS; ++i) {
        int sum = 0;
        for (uint32_t s = 0; s < 64; ++s) {
            sum += painted(i % 4, (i / 4) % SIZE + (s % 8 + 0.5) / 8, i / 4 / SIZE + (s / 8 + 0.5) / 8, 0);
        }
        damaged.rgba[i] = (uint8_t)((sum + 32) / 64);
    }
    assert_int_equal(examine(&damaged).damage, MASK_SMOOTHED);
    /* what a filter made of an edge stays a soft edge */
    check_repair("anti-aliasing", &clean, &damaged, 0.8f, 0.97);
    region_mask_free(&clean);
    region_mask_free(&damaged);
}

static double to_srgb(double v)
{
    return v <= 0.0031308 ? v * 12.92 : 1.055 * pow(v, 1 / 2.4) - 0.055;
}

static double from_srgb(double v)
{
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static double darker(double v)
{
    return pow(v, 2.2);
}

static double mac_to_pc(double v)
{
    return pow(v, 1.8 / 2.2);
}

static void gamma_is_found(void **state)
{
    (void)state;
    static double (*const curves[])(double) = { to_srgb, from_srgb, darker, mac_to_pc };
    static const char *const names[] = { "linear data read as sRGB", "sRGB data read as linear", "a power of 2.2",
                                         "a power of 1.8/2.2" };
    for (size_t k = 0; k < 8; ++k) {
        region_mask clean = paint(k < 4 ? 8 : 0), damaged = copy_of(&clean);
        for (int i = 0; i < 4 * TEXELS; ++i) {
            damaged.rgba[i] = (uint8_t)floor(255 * curves[k % 4](damaged.rgba[i] / 255.0) + 0.5);
        }
        const mask_findings found = examine(&damaged);
        assert_int_equal(found.damage, MASK_GAMMA);
        /* without ramps a power of 2.2 and sRGB leave the same three codes except for a rounding */
        if (k < 4) assert_memory_equal(found.gamma, names[k], strlen(names[k]));
        check_repair(found.gamma, &clean, &damaged, 0.3f, 0.99);
        region_mask_free(&clean);
        region_mask_free(&damaged);
    }
}

static int stored(int value, int bits)
{
    const int step = (value * ((1 << bits) - 1) + 127) / 255;
    return bits == 5 ? step << 3 | step >> 2 : step << 2 | step >> 4;
}

/* BC1's colours by the simplest of encoders: the corners of the box as end points, the nearest of four colours. */
static void compress_block(uint8_t *rgba, int x, int y)
{
    int low[3] = { 255, 255, 255 }, high[3] = { 0, 0, 0 };
    for (int i = 0; i < 48; ++i) {
        const int v = rgba[4 * ((y + i / 12) * SIZE + x + i / 3 % 4) + i % 3];
        if (v < low[i % 3]) low[i % 3] = v;
        if (v > high[i % 3]) high[i % 3] = v;
    }
    for (int c = 0; c < 3; ++c) {
        low[c] = stored(low[c], c == 1 ? 6 : 5);
        high[c] = stored(high[c], c == 1 ? 6 : 5);
    }
    for (int i = 0; i < 16; ++i) {
        uint8_t *texel = &rgba[4 * ((y + i / 4) * SIZE + x + i % 4)];
        int best = 0, least = 1 << 30;
        for (int third = 0; third < 4; ++third) {
            int off = 0;
            for (int c = 0; c < 3; ++c) {
                const int d = (3 * low[c] + third * (high[c] - low[c]) + 1) / 3 - texel[c];
                off += d * d;
            }
            if (off < least) {
                least = off;
                best = third;
            }
        }
        for (int c = 0; c < 3; ++c) texel[c] = (uint8_t)((3 * low[c] + best * (high[c] - low[c]) + 1) / 3);
    }
}

static void block_compression_is_found(void **state)
{
    (void)state;
    for (int fade = 0; fade <= 8; fade += 4) {
        region_mask clean = paint(fade), damaged = copy_of(&clean);
        for (int b = 0; b < TEXELS / 16; ++b) {
            compress_block(damaged.rgba, b % (SIZE / 4) * 4, b / (SIZE / 4) * 4);
        }
        assert_int_equal(examine(&damaged).damage, MASK_BLOCKS);
        check_repair("block compression", &clean, &damaged, 0.3f, fade ? 0.96 : 0.99);
        region_mask_free(&clean);
        region_mask_free(&damaged);
    }
}

/* The codes that 6 bits of green take out of their segments, and what a block mixes out of 0 and 165. */
static void codes_damaged_by_blocks_are_found(void **state)
{
    (void)state;
    static const int codes[6][2] = { { 75, 77 }, { 90, 89 }, { 91, 89 }, { 164, 166 }, { 165, 166 }, { 180, 178 } };
    for (int i = 0; i < 6; ++i) {
        assert_int_equal(stored(codes[i][0], 6), codes[i][1]);
        assert_true(region_is_guard((uint8_t)codes[i][1]) && region_weight((uint8_t)codes[i][1]) == 0.0f);
    }
    const uint8_t mixed = 110; /* two thirds of 165 */
    assert_int_equal(region_of_code(mixed), 1);
    assert_true(fabsf(region_weight(mixed) - 0.28f) < 1e-6f);
    region_mask mask = paint(0);
    for (int i = 0; i < TEXELS; ++i) mask.rgba[4 * i + 1] = (uint8_t)stored(mask.rgba[4 * i + 1], 6);
    const mask_findings found = examine(&mask);
    assert_true(found.guard[1] > 900 && found.guard[0] == 0); /* two discs of green are gone */
    assert_int_not_equal(mask_repair(&mask, &found), UINT32_MAX);
    region_mask clean = paint(0);
    assert_true(agreement(&clean, &mask, 0.0f) == 1.0);
    region_mask_free(&clean);
    region_mask_free(&mask);
}

/* Half-way between full weights of region 0 and region 2, a filter gives a code of region 1. Decoded first, weights are
 * mixed, and no region comes up that was not there. */
static void weights_are_filtered_not_codes(void **state)
{
    (void)state;
    const uint8_t filtered = (75 + 180) / 2;
    assert_int_equal(region_of_code(filtered), 1);
    assert_true(region_weight(filtered) > 0.5f);
    uint8_t codes[8] = { 75, 0, 0, 0, 255, 0, 0, 0 };
    const region_mask mask = { 2, 1, codes };
    uint8_t *maps[REGION_MAP_COUNT];
    assert_int_equal(region_maps_make(&mask, maps), 0);
    assert_int_equal((maps[0][0] + maps[0][4] + 1) / 2, 128);
    assert_int_equal(maps[1][0] + maps[1][4], 0);
    assert_int_equal((maps[2][0] + maps[2][4] + 1) / 2, 128);
    for (uint32_t k = 0; k < REGION_MAP_COUNT; ++k) free(maps[k]);
}

static void small_masks(void **state)
{
    (void)state;
    uint8_t codes[4] = { 80, 0, 0, 170 };
    region_mask mask = { 1, 1, codes };
    const mask_findings found = examine(&mask);
    assert_int_equal(sum4(found.guard), 2);
    assert_int_equal(mask_repair(&mask, &found), 1);
    assert_memory_equal(codes, ((const uint8_t[4]){ 75, 0, 0, 165 }), 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_become_masks_and_back),
        cmocka_unit_test(all_codes_decode_exactly),
        cmocka_unit_test(the_remainder_is_of_the_same_channel),
        cmocka_unit_test(codes_are_rounded_not_cut),
        cmocka_unit_test(maps_equal_codes_on_every_texel),
        cmocka_unit_test(the_largest_channel_counts),
        cmocka_unit_test(clean_masks_are_clean),
        cmocka_unit_test(anti_aliasing_is_found),
        cmocka_unit_test(gamma_is_found),
        cmocka_unit_test(block_compression_is_found),
        cmocka_unit_test(codes_damaged_by_blocks_are_found),
        cmocka_unit_test(weights_are_filtered_not_codes),
        cmocka_unit_test(small_masks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
