/* Tests of tools/convert/texture/: blocks decode to what the encoder says that they do, in every mode; how close they
 * come; which format a texture gets. */
#include "support.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/texture_cut.h"
#include "convert/pack/texture_levels.h"
#include "convert/texture/etc2_block.h"
#include "convert/texture/texture_blocks.h"
#include "core/pack/pack_internal.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"

static test_random numbers;
static const uint8_t *const alone[2] = { NULL, NULL };

/* ---- blocks ---- */

/* Texels of a kind: 0 noise, 1 two colours, 2 a plane, 3 shades of one colour, 4 flat. */
static etc2_texels texels_of(int kind)
{
    etc2_texels t;
    int32_t colors[2][3], slopes[2][3];
    t.cut = 0;
    t.holes = t.bit_worth = 0;
    for (int k = 0; k < 6; k++) {
        colors[k / 3][k % 3] = (int32_t)test_random_below(&numbers, 256);
        slopes[k / 3][k % 3] = (int32_t)test_random_below(&numbers, 21) - 10;
    }
    for (int i = 0; i < 16; i++) {
        const int32_t shade = (int32_t)test_random_below(&numbers, 81) - 40;
        const int which = (int)test_random_below(&numbers, 2);
        t.counts[i] = 1;
        for (int c = 0; c < 3; c++) {
            const int32_t values[5] = { (int32_t)test_random_below(&numbers, 256), colors[which][c],
                                        colors[0][c] + slopes[0][c] * (i / 4) + slopes[1][c] * (i % 4),
                                        colors[0][c] + shade, colors[0][c] };
            t.rgb[i][c] = etc2_clamp(values[kind], 255);
        }
    }
    return t;
}

static uint32_t error_of(const etc2_texels *t, const uint8_t block[8])
{
    uint8_t texels[16][4];
    uint32_t error = 0;
    noh_etc2_decode(t->cut ? NOH_TEXTURE_ETC2_RGBA1 : NOH_TEXTURE_ETC2_RGB, block, 1, texels[0]);
    for (int i = 0; i < 16; i++) {
        assert_int_equal(texels[i % 4 * 4 + i / 4][3], t->holes >> i & 1u ? 0 : 255);
        for (int c = 0; c < 3 && t->counts[i]; c++) {
            const int32_t off = texels[i % 4 * 4 + i / 4][c] - t->rgb[i][c];
            error += (uint32_t)(off * off);
        }
    }
    return error;
}

static void bytes_of(uint64_t block, uint8_t bytes[8])
{
    for (int i = 0; i < 8; i++) bytes[i] = (uint8_t)(block >> (56 - 8 * i));
}

static void punch(etc2_texels *t, uint32_t holes)
{
    t->holes = holes;
    for (int i = 0; i < 16; i++) t->counts[i] = t->counts[i] && !(holes >> i & 1u);
}

/* Each mode alone: the error that it claims is the decoded block's error. */
static void every_mode_says_what_its_block_decodes_to(void **state)
{
    static void (*const modes[])(const etc2_texels *, etc2_best *) = { etc2_try_halves, etc2_try_paints,
                                                                       etc2_try_planar };
    (void)state;
    numbers = test_random_from(11);
    for (int i = 0; i < 2000; i++) {
        etc2_texels t = texels_of(i % 5);
        if (i % 7 == 0) t.counts[i % 16] = 0;
        t.cut = i / 5 % 2;
        if (t.cut && i % 3) punch(&t, test_random_below(&numbers, 0xffffu));
        for (size_t m = 0; m < (t.holes ? 2u : TEST_COUNT(modes)); m++) { /* planar has no holes */
            etc2_best best = { 0, UINT_MAX, 0 };
            uint8_t bytes[8];
            modes[m](&t, &best);
            bytes_of(best.block, bytes);
            if (best.error != error_of(&t, bytes)) {
                fail_msg("texels %d, mode %zu: says %u, decodes to %u", i, m, best.error, error_of(&t, bytes));
            }
        }
    }
}

/* The mean square over blocks of a kind. */
static double mean_error(int kind, int count, void (*only)(const etc2_texels *, etc2_best *))
{
    double sum = 0.0;
    numbers = test_random_from(5);
    for (int i = 0; i < count; i++) {
        const etc2_texels t = texels_of(kind);
        etc2_best best = { 0, UINT_MAX, 0 };
        uint8_t bytes[8];
        if (only) {
            only(&t, &best);
            sum += best.error;
        } else {
            etc2_encode_rgb(&t, alone, bytes);
            sum += error_of(&t, bytes);
        }
    }
    return sum / (48.0 * count);
}

/* Two colours need T or H, a plane needs planar; all together are never worse than one alone. */
static void modes_are_good_at_what_they_are_for(void **state)
{
    (void)state;
    assert_true(mean_error(1, 300, NULL) < 30.0);
    assert_true(mean_error(1, 300, etc2_try_halves) > 300.0);
    assert_true(mean_error(2, 300, NULL) < 4.0);
    assert_true(mean_error(2, 300, etc2_try_halves) > 20.0);
    assert_true(mean_error(3, 300, NULL) < 25.0);
    assert_true(mean_error(4, 300, NULL) < 0.7);
    for (int kind = 0; kind < 5; kind++) {
        assert_true(mean_error(kind, 100, NULL) <= mean_error(kind, 100, etc2_try_halves) + 1e-9);
        assert_true(mean_error(kind, 100, NULL) <= mean_error(kind, 100, etc2_try_planar) + 1e-9);
    }
}

/* With holes a block still has three shades, and one of holes alone is the same whatever is in them. */
static void holes_cost_little(void **state)
{
    static const uint8_t none[8] = { 0, 0, 0, 0, 255, 255, 0, 0 };
    uint8_t block[8];
    double shades = 0.0;
    (void)state;
    numbers = test_random_from(8);
    for (int i = 0; i < 200; i++) {
        etc2_texels t = texels_of(3);
        t.cut = 1;
        punch(&t, test_random_below(&numbers, 0x10000u));
        etc2_encode_rgb(&t, alone, block);
        shades += error_of(&t, block) / (48.0 * 200.0);
        punch(&t, 0xffffu);
        etc2_encode_rgb(&t, alone, block);
        assert_memory_equal(block, none, 8);
    }
    assert_true(shades < 40.0);
}

/* A block like its neighbour becomes the same block, and loses no more than its bits are worth. */
static void blocks_are_repeated_where_that_costs_little(void **state)
{
    uint32_t repeated[2] = { 0, 0 };
    (void)state;
    numbers = test_random_from(9);
    for (int i = 0; i < 400; i++) {
        etc2_texels t = texels_of(i % 2 ? 3 : 4);
        uint8_t first[8], nearest[8], block[8];
        const uint8_t *beside[2] = { NULL, NULL };
        etc2_encode_rgb(&t, alone, first);
        for (int k = 0; k < 48; k++) {
            t.rgb[k / 3][k % 3] = etc2_clamp(t.rgb[k / 3][k % 3] + (int32_t)test_random_below(&numbers, 3) - 1, 255);
        }
        etc2_encode_rgb(&t, alone, nearest);
        beside[i / 2 % 2] = first;
        t.bit_worth = 4;
        etc2_encode_rgb(&t, beside, block);
        repeated[i % 2] += memcmp(block, first, 8) == 0;
        assert_true(error_of(&t, block) <= error_of(&t, nearest) + 4u * 80u);
    }
    assert_true(repeated[0] > 150 && repeated[1] > 150);
}

static double channel_error(const int32_t values[16], int eleven)
{
    uint16_t got[16];
    uint8_t block[8];
    double sum = 0.0;
    eac_encode(values, eleven, 0, alone, block);
    noh_eac_decode(block, eleven, got);
    for (int i = 0; i < 16; i++) {
        const double off = got[i % 4 * 4 + i / 4] - values[i];
        sum += off * off / 16.0;
    }
    return sum;
}

static void one_channel_comes_near(void **state)
{
    (void)state;
    numbers = test_random_from(3);
    for (int eleven = 0; eleven < 2; eleven++) {
        const int32_t most = eleven ? 2047 : 255;
        double ramps = 0.0, noise = 0.0;
        for (int32_t flat = 0; flat <= most; flat += eleven ? 9 : 1) {
            int32_t values[16];
            for (int i = 0; i < 16; i++) values[i] = flat;
            assert_true(channel_error(values, eleven) <= 0.0);
        }
        for (int b = 0; b < 200; b++) {
            int32_t ramp[16], any[16];
            const int32_t from = (int32_t)test_random_below(&numbers, (uint32_t)most / 2u);
            const int32_t step = (int32_t)test_random_below(&numbers, (uint32_t)most / 14u);
            for (int i = 0; i < 16; i++) {
                ramp[i] = etc2_clamp(from + step * (i / 4 + i % 4), most);
                any[i] = (int32_t)test_random_below(&numbers, (uint32_t)most + 1u);
            }
            ramps += channel_error(ramp, eleven) / 200.0;
            noise += channel_error(any, eleven) / 200.0;
        }
        const double scale = most / 255.0 * (most / 255.0);
        assert_true(ramps < 6.0 * scale);
        assert_true(noise < 140.0 * scale);
    }
}

/* ---- textures ---- */

#define SIDE 96u

static uint8_t *picture;

/* A texture of waves in three channels, or of noise. */
static model_texture texture_of(model_texture_use use, int noise)
{
    model_texture t;
    memset(&t, 0, sizeof t);
    picture = realloc(picture, SIDE * SIDE * 4u);
    assert_non_null(picture);
    numbers = test_random_from(17);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const double x = (i % SIDE) * 0.11, y = (i / (double)SIDE) * 0.07;
        for (int c = 0; c < 3; c++) {
            const double wave = 128.0 + 70.0 * sin(x + c) * cos(y - 0.5 * c);
            picture[4 * i + (uint32_t)c] = (uint8_t)(noise ? test_random_below(&numbers, 256) : (uint32_t)wave);
        }
        picture[4 * i + 3] = 255;
    }
    t.width = t.height = SIDE;
    t.rgba = picture;
    t.use = use;
    t.blocks = MODEL_BLOCKS_ETC2;
    return t;
}

static noh_texture_header header_of(const model_texture *t)
{
    byte_buffer out = { NULL, 0, 0, 0 };
    noh_texture_header h;
    uint64_t bytes = 0;
    memset(&h, 0, sizeof h);
    h.nearest = t->mag_filter == 9728;
    assert_int_equal(texture_levels_write(t, &h, &out), 0);
    for (uint32_t i = 0; i < h.level_count; i++) {
        const uint32_t width = h.width >> i, height = h.height >> i;
        bytes += noh_texture_bytes(h.format, width ? width : 1u, height ? height : 1u);
    }
    assert_int_equal(out.count, bytes);
    buffer_free(&out);
    return h;
}

static void each_use_has_its_format(void **state)
{
    model_texture t = texture_of(MODEL_TEXTURE_COLOR, 0);
    (void)state;
    noh_texture_header h = header_of(&t);
    assert_int_equal(h.format, NOH_TEXTURE_ETC2_RGB);
    assert_true(texture_quality_db(&h) > 40.0 && texture_quality_db(&h) < 99.0);
    picture[3] = 0; /* an alpha that no material asks for */
    assert_int_equal(header_of(&t).format, NOH_TEXTURE_ETC2_RGB);
    t.with_alpha = 1;
    assert_int_equal(header_of(&t).format, NOH_TEXTURE_ETC2_RGBA);
    t.use = MODEL_TEXTURE_DATA;
    assert_int_equal(header_of(&t).format, NOH_TEXTURE_ETC2_RGBA);
    t.mag_filter = 9728;
    assert_int_equal(header_of(&t).format, NOH_TEXTURE_RGBA8);
    t.mag_filter = 0;
    t.blocks = MODEL_BLOCKS_NONE;
    h = header_of(&t);
    assert_int_equal(h.format, NOH_TEXTURE_RGBA8);
    assert_true(texture_quality_db(&h) >= 99.0);
}

/* Where every reader cuts, one bit of alpha is taken if it is near enough; what is not seen does not count. */
static void what_is_only_cut_has_one_bit_of_alpha(void **state)
{
    model_texture t = texture_of(MODEL_TEXTURE_COLOR, 0);
    (void)state;
    t.with_alpha = t.cut_alone = 1;
    t.alpha_cutoff = 0.5f;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) picture[4 * i + 3] = i / SIDE < 40u + i % 3u ? 255 : 0;
    noh_texture_header h = header_of(&t);
    assert_int_equal(h.format, NOH_TEXTURE_ETC2_RGBA1);
    assert_true(texture_quality_db(&h) > 40.0);
    for (uint32_t i = 0; i < SIDE * SIDE / 3u; i++) memset(picture + 4 * (SIDE * SIDE - 1u - i), i % 251 ? 9 : 200, 3);
    const noh_texture_header other = header_of(&t);
    assert_memory_equal(&other, &h, sizeof h);
    t.cut_alone = 0;
    assert_int_equal(header_of(&t).format, NOH_TEXTURE_ETC2_RGBA);
    t.cut_alone = 1;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) picture[4 * i + 3] = (uint8_t)(i % 256u);
    assert_int_equal(header_of(&t).format, NOH_TEXTURE_ETC2_RGBA);
}

/* A texture is only cut where all that reads it says so, alike. */
static void everything_that_reads_a_texture_has_to_cut(void **state)
{
    const test_model_desc desc = { 1, 2, 0, TEST_UVS, 1 };
    model *m = test_model(&desc);
    float colors[16] = { 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1 };
    model_texture *t = m->textures = test_zeros(sizeof *m->textures);
    (void)state;
    m->texture_count = 1;
    t->with_alpha = 1;
    t->alpha_cutoff = 0.5f;
    m->materials = test_zeros(2 * sizeof *m->materials);
    m->material_count = 2;
    for (int i = 0; i < 2; i++) {
        m->materials[i] = model_material_default();
        m->materials[i].alpha = MODEL_ALPHA_MASK;
        m->materials[i].base_color_texture = 0;
    }
    m->meshes[0].submeshes[0].material = 1;
    texture_cut_mark(m);
    assert_int_equal(t->cut_alone, 1);
#define REFUSED(change, back)              \
    do {                                   \
        change;                            \
        texture_cut_mark(m);               \
        assert_int_equal(t->cut_alone, 0); \
        back;                              \
        texture_cut_mark(m);               \
        assert_int_equal(t->cut_alone, 1); \
    } while (0)
    REFUSED(m->materials[1].alpha = MODEL_ALPHA_BLEND, m->materials[1].alpha = MODEL_ALPHA_MASK);
    REFUSED(m->materials[0].alpha = MODEL_ALPHA_OPAQUE, m->materials[0].alpha = MODEL_ALPHA_MASK);
    REFUSED(m->materials[0].alpha_cutoff = 0.4f, m->materials[0].alpha_cutoff = 0.5f);
    REFUSED(m->materials[0].emissive_texture = 0, m->materials[0].emissive_texture = MODEL_NONE);
    REFUSED(m->materials[0].base_color[3] = 0.9f, m->materials[0].base_color[3] = 1.0f);
    m->meshes[0].color = colors;
    REFUSED(colors[7] = 0.5f, colors[7] = 1.0f);
    m->meshes[0].color = NULL;
    t->alpha_cutoff = m->materials[0].alpha_cutoff = m->materials[1].alpha_cutoff = 0.2f;
    texture_cut_mark(m);
    assert_int_equal(t->cut_alone, 0);
    model_free(m);
}

/* Noise of 96 texels a side is compressed, and said to be bad; of 64 it stays as it is. */
static void small_textures_stay_where_blocks_lose_much(void **state)
{
    model_texture t = texture_of(MODEL_TEXTURE_COLOR, 1);
    (void)state;
    noh_texture_header h = header_of(&t);
    assert_int_equal(h.format, NOH_TEXTURE_ETC2_RGB);
    assert_true(texture_quality_db(&h) < TEXTURE_QUALITY_DB);
    t.width = t.height = 64;
    assert_int_equal(header_of(&t).format, NOH_TEXTURE_RGBA8);
    t = texture_of(MODEL_TEXTURE_COLOR, 0);
    t.width = 3;
    assert_int_equal(header_of(&t).format, NOH_TEXTURE_RGBA8);
}

/* A bumpy normal map needs two channels of 11 bits; of longer vectors the direction counts. */
static void normal_maps_keep_their_directions(void **state)
{
    model_texture t = texture_of(MODEL_TEXTURE_NORMAL, 0);
    (void)state;
    for (int bumpy = 0; bumpy < 2; bumpy++) {
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            const double x = i % SIDE, y = i / (double)SIDE, scale = bumpy ? 1.0 : 0.05;
            const double v[3] = { scale * sin(0.5 * x + 0.2 * y), scale * cos(0.4 * y), 1.0 };
            const double length = (bumpy && i & 1u ? 1.1 : 1.0) * sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
            for (int c = 0; c < 3; c++) picture[4 * i + (uint32_t)c] = (uint8_t)(128.5 + 127.0 * v[c] / length);
        }
        const noh_texture_header h = header_of(&t);
        assert_int_equal(h.format, bumpy ? NOH_TEXTURE_EAC_RG : NOH_TEXTURE_ETC2_RGB);
        assert_true(texture_quality_db(&h) > (bumpy ? 38.0 : 40.0));
    }
}

static void textures_are_halved_on_request(void **state)
{
    model_texture t = texture_of(MODEL_TEXTURE_COLOR, 0);
    (void)state;
    t.size_max = 40;
    noh_texture_header h = header_of(&t);
    assert_int_equal(h.width, 24);
    assert_int_equal(h.height, 24);
    t.size_max = 48;
    assert_int_equal(header_of(&t).width, 48);
    t.size_max = 1;
    h = header_of(&t);
    assert_int_equal(h.width, 1);
    assert_int_equal(h.level_count, 1);
    free(picture);
    picture = NULL;
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(every_mode_says_what_its_block_decodes_to),
                                        cmocka_unit_test(modes_are_good_at_what_they_are_for),
                                        cmocka_unit_test(holes_cost_little),
                                        cmocka_unit_test(blocks_are_repeated_where_that_costs_little),
                                        cmocka_unit_test(one_channel_comes_near),
                                        cmocka_unit_test(each_use_has_its_format),
                                        cmocka_unit_test(what_is_only_cut_has_one_bit_of_alpha),
                                        cmocka_unit_test(everything_that_reads_a_texture_has_to_cut),
                                        cmocka_unit_test(small_textures_stay_where_blocks_lose_much),
                                        cmocka_unit_test(normal_maps_keep_their_directions),
                                        cmocka_unit_test(textures_are_halved_on_request) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
