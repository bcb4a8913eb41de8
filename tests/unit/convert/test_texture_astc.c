/* Tests of tools/convert/texture/texture_astc.c, and of the ASTC blocks that texture_levels chooses for a texture. They
 * are skipped without astcenc. */
#define _POSIX_C_SOURCE 200809L /* setenv */
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/pack/texture_levels.h"
#include "convert/texture/texture_astc.h"
#include "core/pack/pack_internal.h"

#define SIDE 90u /* no multiple of 4 */

static uint8_t picture[SIDE * SIDE * 4u];

static void need_astcenc(void)
{
    model_error error;
    if (texture_astc_find(&error)) skip();
}

/* Waves, alone or under noise. Normal maps are unit. */
static model_texture texture_of(model_texture_use use, uint32_t noise)
{
    test_random numbers = test_random_from(23);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const double x = (i % SIDE) * 0.06, y = (i / SIDE) * 0.04;
        uint8_t *texel = picture + 4u * i;
        for (int c = 0; c < 3; c++) {
            const double wave = 128.0 + 60.0 * sin(x + c) * cos(y - 0.5 * c);
            texel[c] = (uint8_t)(wave + (noise ? test_random_below(&numbers, noise) : 0u));
        }
        texel[3] = 255;
        if (use != MODEL_TEXTURE_NORMAL) continue;
        texel[2] = 240;
        texture_unit_bytes(texel, texel);
    }
    model_texture t;
    memset(&t, 0, sizeof t);
    t.width = t.height = SIDE;
    t.rgba = picture;
    t.use = use;
    t.blocks = MODEL_BLOCKS_ASTC;
    return t;
}

/* Its levels, to be freed by buffer_free. */
static byte_buffer levels_of(const model_texture *t, noh_texture_header *h)
{
    byte_buffer out = { NULL, 0, 0, 0 };
    uint64_t bytes = 0;
    memset(h, 0, sizeof *h);
    h->nearest = t->mag_filter == 9728;
    assert_int_equal(texture_levels_write(t, h, &out), 0);
    for (uint32_t i = 0; i < h->level_count; i++) {
        const uint32_t side = SIDE >> i ? SIDE >> i : 1u;
        bytes += noh_texture_bytes(h->format, side, side);
    }
    assert_int_equal(out.count, bytes);
    return out;
}

static noh_texture_header header_of(const model_texture *t)
{
    noh_texture_header h;
    byte_buffer out = levels_of(t, &h);
    buffer_free(&out);
    return h;
}

static void blocks_are_as_large_as_the_error_lets_them(void **state)
{
    static const struct {
        model_texture_use use;
        uint32_t noise, format;
        double db;
    } rows[] = { { MODEL_TEXTURE_COLOR, 0, NOH_TEXTURE_ASTC_8X8, 38.0 },
                 { MODEL_TEXTURE_COLOR, 12, NOH_TEXTURE_ASTC_6X6, 38.0 },
                 { MODEL_TEXTURE_COLOR, 60, NOH_TEXTURE_ASTC_4X4, 25.0 },
                 { MODEL_TEXTURE_DATA, 0, NOH_TEXTURE_ASTC_8X8, 38.0 },
                 { MODEL_TEXTURE_NORMAL, 0, NOH_TEXTURE_ASTC_6X6, 40.0 },
                 { MODEL_TEXTURE_NORMAL, 60, NOH_TEXTURE_ASTC_4X4, 25.0 } };
    (void)state;
    need_astcenc();
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const model_texture t = texture_of(rows[i].use, rows[i].noise);
        const noh_texture_header h = header_of(&t);
        if (h.format != rows[i].format || texture_quality_db(&h) < rows[i].db || !(h.error > 0.0f)) {
            fail_msg("row %zu: %s, %.1f dB", i, texture_format_name(h.format), texture_quality_db(&h));
        }
    }
}

/* Picking reads alphas that cut or blend, and the library decodes ETC2 alone. */
static void alphas_that_cut_or_blend_stay_etc2(void **state)
{
    model_texture t = texture_of(MODEL_TEXTURE_COLOR, 0);
    (void)state;
    need_astcenc();
    picture[3] = 0;
    assert_int_equal(header_of(&t).format, NOH_TEXTURE_ASTC_8X8); /* an alpha that no material asks for */
    t.with_alpha = 1;
    assert_int_equal(header_of(&t).format, NOH_TEXTURE_ETC2_RGBA);
    t.with_alpha = 0;
    t.mag_filter = 9728;
    assert_int_equal(header_of(&t).format, NOH_TEXTURE_RGBA8);
}

/* The error that a header states is off what is decoded, alpha with it where it is data. */
static void errors_are_of_what_is_decoded(void **state)
{
    static uint8_t decoded[SIDE * SIDE * 4u];
    model_texture t = texture_of(MODEL_TEXTURE_DATA, 0);
    noh_texture_header h;
    double squares = 0.0;
    (void)state;
    need_astcenc();
    for (uint32_t i = 0; i < SIDE * SIDE; i++) picture[4 * i + 3] = (uint8_t)(100u + i % SIDE);
    byte_buffer out = levels_of(&t, &h);
    const texture_image level = { .rgba = picture, .width = SIDE, .height = SIDE, .use = t.use, .keeps_alpha = 1 };
    assert_int_equal(texture_astc_decode(&level, h.format, out.bytes, decoded), 0);
    for (uint32_t i = 0; i < sizeof decoded; i++) {
        squares += pow((double)decoded[i] - picture[i], 2.0);
    }
    assert_true(fabs(squares / (double)sizeof decoded - (double)h.error) < 1e-4);
    assert_true(h.error < 10.3f);
    buffer_free(&out);
}

/* Shaders tell by the blue of a normal map that z is left out. */
static void normal_maps_have_no_blue(void **state)
{
    static uint8_t decoded[SIDE * SIDE * 4u];
    (void)state;
    need_astcenc();
    for (uint32_t noise = 0; noise < 80u; noise += 40u) {
        const model_texture t = texture_of(MODEL_TEXTURE_NORMAL, noise);
        noh_texture_header h;
        byte_buffer out = levels_of(&t, &h);
        const texture_image level = { .rgba = picture, .width = SIDE, .height = SIDE, .use = t.use };
        assert_int_equal(texture_astc_decode(&level, h.format, out.bytes, decoded), 0);
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            assert_int_equal(decoded[4 * i + 2], 0);
            assert_int_equal(decoded[4 * i + 3], 255);
        }
        buffer_free(&out);
    }
}

static void without_astcenc_the_package_is_named(void **state)
{
    const char *path = getenv("PATH");
    char kept[4096];
    model_error error;
    byte_buffer out = { NULL, 0, 0, 0 };
    noh_texture_header h = { 0 };
    const model_texture t = texture_of(MODEL_TEXTURE_COLOR, 0);
    (void)state;
    assert_true(path && strlen(path) < sizeof kept);
    strcpy(kept, path);
    assert_int_equal(setenv("PATH", "/nonexistent", 1), 0);
    assert_int_equal(texture_astc_find(&error), 1);
    assert_non_null(strstr(error.what, "apt-get install astcenc"));
    assert_int_equal(texture_levels_write(&t, &h, &out), 1);
    assert_int_equal(setenv("PATH", kept, 1), 0);
    buffer_free(&out);
}

static const struct CMUnitTest tests[] = { cmocka_unit_test(blocks_are_as_large_as_the_error_lets_them),
                                           cmocka_unit_test(alphas_that_cut_or_blend_stay_etc2),
                                           cmocka_unit_test(errors_are_of_what_is_decoded),
                                           cmocka_unit_test(normal_maps_have_no_blue),
                                           cmocka_unit_test(without_astcenc_the_package_is_named) };

TEST_MAIN(tests, NULL, NULL)
