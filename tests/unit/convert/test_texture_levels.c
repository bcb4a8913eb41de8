/* Tests of tools/convert/pack/texture_levels.c: mip levels are means of what they cover, in the right measure. */
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/pack/texture_levels.h"

/* The levels of a texture, one behind the other; to be freed by buffer_free. */
static byte_buffer levels_of(const model_texture *t, noh_texture_header *h)
{
    byte_buffer out = { NULL, 0, 0, 0 };
    uint64_t texels = 0;
    assert_int_equal(texture_levels_write(t, h, &out), 0);
    for (uint32_t i = 0; i < h->level_count; i++) {
        const uint32_t width = h->width >> i, height = h->height >> i;
        texels += (uint64_t)(width ? width : 1u) * (height ? height : 1u);
    }
    assert_int_equal(out.count, texels * 4u);
    return out;
}

static model_texture texture_of(uint32_t width, uint32_t height, const uint8_t *rgba, model_texture_use use)
{
    model_texture t;
    memset(&t, 0, sizeof t);
    t.width = width;
    t.height = height;
    t.rgba = (uint8_t *)(uintptr_t)rgba;
    t.use = use;
    return t;
}

/* Half black and half white: half the light, which is the byte 188 of sRGB, and the byte 128 of data. */
static void colours_are_means_of_light(void **state)
{
    static const uint8_t checks[16] = { 0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 255 };
    (void)state;
    for (int data = 0; data < 2; data++) {
        const model_texture t = texture_of(2, 2, checks, data ? MODEL_TEXTURE_DATA : MODEL_TEXTURE_COLOR);
        noh_texture_header h = { 0 };
        byte_buffer out = levels_of(&t, &h);
        assert_int_equal(h.level_count, 2);
        assert_memory_equal(out.bytes, checks, 16); /* the first is as it was */
        for (int c = 0; c < 3; c++) assert_int_equal(out.bytes[16 + c], data ? 128 : 188);
        assert_int_equal(out.bytes[19], 255);
        buffer_free(&out);
    }
}

/* A level whose side is odd weighs the texel that two share; the mean of all stays. */
static void odd_sides_keep_the_mean(void **state)
{
    uint8_t rgba[5 * 3 * 4];
    double mean = 0.0;
    (void)state;
    for (uint32_t i = 0; i < 15; i++) {
        memset(rgba + 4 * i, (int)(i * 17), 4);
        mean += i * 17 / 15.0;
    }
    const model_texture t = texture_of(5, 3, rgba, MODEL_TEXTURE_DATA);
    noh_texture_header h = { 0 };
    byte_buffer out = levels_of(&t, &h);
    assert_int_equal(h.level_count, 3); /* 5 x 3, 2 x 1, 1 x 1 */
    assert_true(fabs((out.bytes[60] + out.bytes[64]) / 2.0 - mean) <= 0.5);
    assert_true(fabs(out.bytes[68] - mean) <= 0.5);
    buffer_free(&out);
}

/* Colours under an alpha of 0 do not bleed into the strands. */
static void colours_count_by_their_alpha(void **state)
{
    static const uint8_t strand[8] = { 255, 0, 0, 0, 90, 60, 30, 255 };
    (void)state;
    model_texture t = texture_of(2, 1, strand, MODEL_TEXTURE_COLOR);
    noh_texture_header h = { 0 };
    byte_buffer out;
    t.with_alpha = 1;
    out = levels_of(&t, &h);
    assert_memory_equal(out.bytes + 8, "\x5a\x3c\x1e\x80", 4);
    buffer_free(&out);
}

static void normals_stay_unit(void **state)
{
    uint8_t rgba[8 * 8 * 4];
    test_random r = test_random_from(7);
    (void)state;
    for (uint32_t i = 0; i < 64; i++) {
        const double x = (double)test_random_float(&r, -0.6f, 0.6f), y = (double)test_random_float(&r, -0.6f, 0.6f);
        const double v[3] = { x, y, sqrt(1.0 - x * x - y * y) };
        for (int c = 0; c < 3; c++) rgba[4 * i + (uint32_t)c] = (uint8_t)lround(128.0 + 127.0 * v[c]);
        rgba[4 * i + 3] = 255;
    }
    const model_texture t = texture_of(8, 8, rgba, MODEL_TEXTURE_NORMAL);
    noh_texture_header h = { 0 };
    byte_buffer out = levels_of(&t, &h);
    assert_int_equal(h.level_count, 4);
    for (size_t i = 256; i < out.count; i += 4) {
        double length = 0.0;
        for (size_t c = 0; c < 3; c++) length += pow((out.bytes[i + c] - 128.0) / 127.0, 2.0);
        assert_true(fabs(sqrt(length) - 1.0) < 0.01);
    }
    buffer_free(&out);
}

/* One texel in four stays at a cutoff of 1/2. Means alone would remove all of them in the first smaller level. */
static void masks_keep_their_coverage(void **state)
{
    uint8_t rgba[32 * 32 * 4];
    (void)state;
    for (uint32_t i = 0; i < 32 * 32; i++) {
        const uint32_t x = i % 32, y = i / 32;
        memset(rgba + 4 * i, 200, 3);
        rgba[4 * i + 3] = x % 2 || y % 2 ? 0 : (uint8_t)(180 + (x * 7 + y * 3) % 70);
    }
    for (int kept = 0; kept < 2; kept++) {
        model_texture t = texture_of(32, 32, rgba, MODEL_TEXTURE_COLOR);
        noh_texture_header h = { 0 };
        byte_buffer out;
        uint32_t stays = 0;
        t.with_alpha = 1;
        t.alpha_cutoff = kept ? 0.5f : 0.0f;
        out = levels_of(&t, &h);
        for (uint32_t i = 0; i < 16 * 16; i++) stays += out.bytes[4096 + 4 * i + 3] >= 128;
        if (kept) {
            assert_in_range(stays, 50, 78);
        } else {
            assert_int_equal(stays, 0);
        }
        buffer_free(&out);
    }
}

static void nearest_has_one_level(void **state)
{
    static const uint8_t four[16] = { 9, 8, 7, 6 };
    const model_texture t = texture_of(2, 2, four, MODEL_TEXTURE_COLOR);
    noh_texture_header h = { 0 };
    byte_buffer out;
    (void)state;
    h.nearest = 1;
    out = levels_of(&t, &h);
    assert_int_equal(h.level_count, 1);
    buffer_free(&out);
}

/* Codes that are made smaller are texels of the source, of sides that are no powers of two too. */
static void codes_are_left_out_and_not_mixed(void **state)
{
    (void)state;
    static uint8_t rgba[37 * 21 * 4];
    for (uint32_t i = 0; i < 37 * 21; i++) {
        for (uint32_t c = 0; c < 4; c++) rgba[4 * i + c] = (uint8_t)((i + c) % 2 ? 75 : 165);
    }
    model_texture t = texture_of(37, 21, rgba, MODEL_TEXTURE_CODES);
    for (uint32_t most = 1; most < 64; most *= 3) {
        noh_texture_header h = { .nearest = 1 };
        t.size_max = most;
        byte_buffer out = levels_of(&t, &h);
        assert_true(h.width <= most && h.level_count == 1 && h.format == NOH_TEXTURE_RGBA8);
        for (size_t i = 0; i < out.count; i++) assert_true(out.bytes[i] == 75 || out.bytes[i] == 165);
        buffer_free(&out);
    }
}

/* Roughness in an alpha channel: colours of smooth texels count in mip levels as much as others, and alpha stays in
 * blocks. */
static void alphas_that_are_data_change_no_colour(void **state)
{
    (void)state;
    uint8_t rgba[8 * 8 * 4];
    for (uint32_t i = 0; i < 64; i++) {
        const uint8_t texel[4] = { i % 2 ? 255 : 0, 80, 80, i % 2 ? 0 : 200 };
        memcpy(rgba + 4 * i, texel, 4);
    }
    model_texture t = texture_of(8, 8, rgba, MODEL_TEXTURE_COLOR);
    noh_texture_header h = { 0 };
    t.alpha_is_data = 1;
    byte_buffer out = levels_of(&t, &h);
    assert_int_equal(out.bytes[256], 188); /* half the light */
    assert_int_equal(out.bytes[256 + 3], 100);
    buffer_free(&out);
    for (uint32_t i = 0; i < 64; i++) rgba[4 * i] = 90;
    t.blocks = MODEL_BLOCKS_ETC2;
    memset(&h, 0, sizeof h);
    byte_buffer blocks = { NULL, 0, 0, 0 };
    assert_int_equal(texture_levels_write(&t, &h, &blocks), 0);
    assert_int_equal(h.format, NOH_TEXTURE_ETC2_RGBA);
    buffer_free(&blocks);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(codes_are_left_out_and_not_mixed), cmocka_unit_test(alphas_that_are_data_change_no_colour),
    cmocka_unit_test(colours_are_means_of_light),       cmocka_unit_test(odd_sides_keep_the_mean),
    cmocka_unit_test(colours_count_by_their_alpha),     cmocka_unit_test(normals_stay_unit),
    cmocka_unit_test(masks_keep_their_coverage),        cmocka_unit_test(nearest_has_one_level),
};

TEST_MAIN(tests, NULL, NULL)
