/* Textures in blocks of ETC2 and EAC in the wire form: all formats come back to the byte, whatever their bits, and take
 * fewer bytes than as bytes; what is cut short or flipped is refused; forms of version 1 are still read.
 * cross: long, thousands of damaged blocks */
#include "support.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"
#include "convert/pack/pack_wire.h"
#include "support/pack_walk.h"
#include "core/wire/wire_internal.h"

#define FORMATS 4u
#define FORM_HASH 0xf456b1fb20d298dcull /* of what pictures_come_back_to_the_byte writes */

static const uint32_t formats[FORMATS] = { NOH_TEXTURE_ETC2_RGB, NOH_TEXTURE_ETC2_RGBA, NOH_TEXTURE_EAC_RG,
                                           NOH_TEXTURE_ETC2_RGBA1 };

/* What a texel of a picture is: 0 waves, 1 two colours in every block, 2 noise, 3 a slope with a grain, whose blocks
 * are halves of near colours. */
static uint8_t value_of(int kind, uint32_t x, uint32_t y, uint32_t c, test_random *r)
{
    const uint32_t color = (x / 4u * 7u + y / 4u * 13u + (x * 5u + y * 3u) % 7u % 2u * 101u) * (c + 3u);
    if (kind == 2) return (uint8_t)test_random_below(r, 256);
    if (kind == 3) return (uint8_t)(60u + x + y + 8u * c + (x * 2654435761u + y * 40503u * (x + 3u)) % 4096u / 128u);
    if (kind == 1) return (uint8_t)color;
    return (uint8_t)(128.0 + 90.0 * sin(0.07 * x + c) * cos(0.05 * y - 0.4 * c));
}

static void fill(model_texture *t, int kind, test_random *r)
{
    for (uint32_t i = 0; i < t->width * t->height; i++) {
        const uint32_t x = i % t->width, y = i / t->width;
        const double bumps[3] = { kind * 0.4 * sin(0.5 * x), kind * 0.4 * cos(0.4 * y), 1.0 };
        const double length = sqrt(bumps[0] * bumps[0] + bumps[1] * bumps[1] + 1.0);
        for (uint32_t c = 0; c < 3u; c++) {
            t->rgba[4 * i + c] = t->use == MODEL_TEXTURE_NORMAL ? (uint8_t)(128.5 + 127.0 * bumps[c] / length)
                                                                : value_of(kind, x, y, c, r);
        }
        t->rgba[4 * i + 3] = t->cut_alone ? (y > x / 2u ? 255 : 0) : (uint8_t)(64u + x % 100u);
    }
}

/* A pack of four textures, one of each format. */
static uint8_t *pack_of(uint32_t width, uint32_t height, int kind, size_t *count)
{
    const test_model_desc desc = { 1, 2, 0, TEST_UVS, 8 };
    test_random r = test_random_from(31);
    model *m = test_model(&desc);
    uint8_t *bytes;
    noh_pack pack;
    m->textures = test_zeros(FORMATS * sizeof *m->textures);
    m->texture_count = FORMATS;
    for (uint32_t i = 0; i < FORMATS; i++) {
        model_texture *t = &m->textures[i];
        t->name = model_string("blocks");
        t->width = width;
        t->height = height;
        t->rgba = test_zeros(4u * (size_t)width * height);
        t->blocks = MODEL_BLOCKS_ETC2;
        t->use = i == 2 ? MODEL_TEXTURE_NORMAL : MODEL_TEXTURE_COLOR;
        t->with_alpha = i == 1 || i == 3;
        t->cut_alone = i == 3;
        t->alpha_cutoff = t->cut_alone ? 0.5f : 0.0f;
        fill(t, i == 2 ? 1 : kind, &r);
    }
    bytes = test_pack_of(m, count, NULL);
    pack = test_open(bytes, *count);
    for (uint32_t i = 0; i < FORMATS && kind != 2; i++) {
        noh_texture t;
        assert_int_equal(noh_pack_texture_at(&pack, i, &t, NULL), NOH_OK);
        assert_int_equal(t.header->format, formats[i]);
    }
    model_free(m);
    return bytes;
}

static byte_buffer wire_of(const noh_pack *pack, wire_report *report)
{
    static const wire_steps exact = { NULL, 32767, 65535, 0 };
    byte_buffer out = { NULL, 0, 0, 0 };
    model_error error = { "", "" };
    if (pack_wire(pack, 1, &exact, &out, report, &error)) fail_msg("%s", error.what);
    return out;
}

static void comes_back(const uint8_t *bytes, size_t count, const byte_buffer *wire, size_t piece)
{
    noh_wire_info info;
    noh_wire_desc desc;
    noh_wire *w;
    noh_error error = { NOH_OK, "", 0, 0 };
    void *memory = test_zeros(noh_wire_size());
    assert_int_equal(noh_wire_info_read(wire->bytes, wire->count, &info, NULL), NOH_OK);
    desc.block = malloc(info.block_bytes);
    desc.block_bytes = info.block_bytes;
    memset(desc.block, 0xa5, info.block_bytes);
    assert_int_equal(noh_wire_init(memory, noh_wire_size(), &desc, &w, NULL), NOH_OK);
    for (size_t at = 0; at < wire->count; at += piece) {
        const size_t now = wire->count - at < piece ? wire->count - at : piece;
        if (noh_wire_push(w, wire->bytes + at, now, &error)) fail_msg("%s", error.what);
    }
    assert_true(noh_wire_is_complete(w));
    assert_memory_equal(desc.block, bytes, count);
    free(desc.block);
    free(memory);
}

/* Later versions read the same bytes, so whatever the coder guesses by is part of the form: if that is meant to change,
 * raise NOH_WIRE_VERSION. */
static void pictures_come_back_to_the_byte(void **state)
{
    static const uint32_t sizes[][2] = { { 72, 64 }, { 70, 39 }, { 4, 33 }, { 5, 4 }, { 130, 6 } };
    uint64_t hash = TEST_HASH;
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(sizes); i++) {
        for (int kind = 0; kind < (i ? 1 : 4); kind++) {
            size_t count;
            uint8_t *bytes = pack_of(sizes[i][0], sizes[i][1], kind, &count);
            const noh_pack pack = test_open(bytes, count);
            wire_report report;
            byte_buffer out = wire_of(&pack, &report);
            comes_back(bytes, count, &out, i == 1 ? 7 : 4096);
            hash = test_hash(hash, out.bytes, out.count);
            buffer_free(&out);
            free(bytes);
        }
    }
    if (hash != FORM_HASH) fail_msg("the wire form, or the pack in it, has the hash %016" PRIx64, hash);
}

/* Blocks that no encoder writes: modes with other free bits, planar blocks with holes, equal colours. */
static void any_bits_come_back(void **state)
{
    test_random r = test_random_from(32);
    size_t count;
    uint8_t *bytes = pack_of(70, 39, 0, &count);
    (void)state;
    for (int round = 0; round < 6; round++) {
        noh_pack pack = test_open(bytes, count);
        wire_report report;
        for (uint32_t i = 0; i < FORMATS; i++) {
            const noh_pack_chunk *c = &pack.chunks[pack.runs[NOH_CHUNK_TEXTURE].first + i];
            noh_texture t;
            assert_int_equal(noh_pack_texture_at(&pack, i, &t, NULL), NOH_OK);
            for (uint32_t at = t.header->pixels_offset; at < c->bytes; at++) {
                /* few bytes of 0 and 255 among them: colours at the ends of their range */
                const uint32_t value = test_random_below(&r, round % 2 ? 256 : 512);
                bytes[c->offset + at] = (uint8_t)(value < 256u ? value : value < 384u ? 0u : 255u);
            }
        }
        pack_repair(bytes, count);
        pack = test_open(bytes, count);
        byte_buffer out = wire_of(&pack, &report);
        comes_back(bytes, count, &out, 4096);
        assert_true(report.textures < count + count / 8u);
        buffer_free(&out);
    }
    free(bytes);
}

/* Smooth pictures take less than half of what their bytes do; pictures of two colours in each block, which need the
 * modes whose free bits are guessed, less than three eighths: if blocks of one mode were sent as they are, they would
 * take more. */
static void pictures_take_few_bytes(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        size_t count;
        uint8_t *bytes = pack_of(256, 256, kind, &count);
        const noh_pack pack = test_open(bytes, count);
        uint64_t blocks = 0;
        wire_report report;
        byte_buffer out = wire_of(&pack, &report);
        for (uint32_t i = 0; i < FORMATS; i++) blocks += pack.chunks[pack.runs[NOH_CHUNK_TEXTURE].first + i].bytes;
        print_message("# %u of %u bytes\n", (unsigned)report.textures, (unsigned)blocks);
        assert_true(report.textures * 8u < blocks * (kind ? 3u : 4u));
        buffer_free(&out);
        free(bytes);
    }
}

static noh_result push(const byte_buffer *wire, size_t count, noh_error *error, int *whole)
{
    static uint8_t block[1u << 20] __attribute__((aligned(64))),
        memory[NOH_WIRE_STATE_BYTES] __attribute__((aligned(64)));
    const noh_wire_desc desc = { block, sizeof block };
    noh_wire *w;
    noh_result result;
    assert_int_equal(noh_wire_init(memory, sizeof memory, &desc, &w, NULL), NOH_OK);
    result = noh_wire_push(w, wire->bytes, count, error);
    *whole = noh_wire_is_complete(w);
    return result;
}

static void damage_is_refused(void **state)
{
    size_t count;
    uint8_t *bytes = pack_of(20, 12, 0, &count);
    const noh_pack pack = test_open(bytes, count);
    wire_report report;
    byte_buffer out = wire_of(&pack, &report);
    noh_error error = { NOH_OK, NULL, 0, 0 };
    int whole;
    (void)state;
    for (size_t cut = 0; cut < out.count; cut++) {
        assert_int_equal(push(&out, cut, &error, &whole), NOH_OK);
        assert_false(whole);
    }
    for (size_t bit = 0; bit < 8u * out.count; bit += 3u) {
        out.bytes[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
        if (push(&out, out.count, &error, &whole) == NOH_OK) assert_false(whole); /* a length that grew */
        out.bytes[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
    }
    assert_int_equal(push(&out, out.count, &error, &whole), NOH_OK);
    assert_true(whole);
    buffer_free(&out);
    free(bytes);
}

/* Make the checksums right again. */
static void seal(byte_buffer *wire)
{
    noh_wire_head h;
    uint32_t crc;
    memcpy(&h, wire->bytes, sizeof h);
    crc = h.crc = noh_crc32c(0, &h, offsetof(noh_wire_head, crc));
    memcpy(wire->bytes, &h, sizeof h);
    for (size_t at = sizeof h; at < wire->count;) {
        uint8_t *b = wire->bytes + at;
        const uint32_t size = ((uint32_t)b[2] | (uint32_t)b[3] << 8) & (NOH_WIRE_BLOCK_SECTION - 1u);
        crc = noh_crc32c(noh_crc32c(crc, b, 4), b + NOH_WIRE_BLOCK_HEAD_BYTES, size);
        memcpy(b + 4, &crc, 4);
        at += NOH_WIRE_BLOCK_HEAD_BYTES + size;
    }
}

static void versions_from_1_on_are_read(void **state)
{
    const test_model_desc plain = { 1, 4, 3, TEST_UVS, 5 };
    size_t count;
    uint8_t *bytes = test_pack(&plain, &count);
    const noh_pack pack = test_open(bytes, count);
    wire_report report;
    byte_buffer out = wire_of(&pack, &report);
    (void)state;
    for (uint32_t version = 0; version <= NOH_WIRE_VERSION + 1u; version++) {
        noh_error error = { NOH_OK, NULL, 0, 0 };
        int whole;
        memcpy(out.bytes + offsetof(noh_wire_head, version), &version, sizeof version);
        seal(&out);
        if (version && version <= NOH_WIRE_VERSION) {
            assert_int_equal(push(&out, out.count, &error, &whole), NOH_OK);
            assert_true(whole);
        } else {
            assert_int_equal(push(&out, out.count, &error, &whole), NOH_ERR_VERSION);
            assert_int_equal(error.need, NOH_WIRE_VERSION);
        }
    }
    buffer_free(&out);
    free(bytes);
}

/* Sections that are not valid textures. */
static void lies_about_textures_are_refused(void **state)
{
    static uint8_t image[4096];
    static noh_wire_filter f;
    static const uint32_t wrong[][4] = { { 0, 8, 1, 1 },     { 8, 0, 1, 1 },  { 8, 8, 33, 1 },
                                         { 8, 8, 1, 0 },     { 8, 8, 1, 5 },  { 4096, 8, 1, 1 },
                                         { 128, 128, 1, 1 }, { 8, 8, 33, 2 }, { 64, 64, 7, 4 } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(wrong) + 1u; i++) {
        noh_wire_section s;
        memset(&s, 0, sizeof s);
        memset(&f, 0, sizeof f);
        f.image = image;
        f.image_bytes = sizeof image;
        s.kind = NOH_WIRE_BLOCKS;
        s.at = 2048;
        if (i < TEST_COUNT(wrong)) {
            memcpy(s.params, wrong[i], sizeof wrong[i]);
        } else {
            s.params[0] = s.params[1] = 64;
            s.params[2] = s.params[3] = 1;
        }
        assert_int_equal(noh_wire_begin(&f, &s), 0);
        assert_int_equal(noh_wire_run(&f), i < TEST_COUNT(wrong) ? -1 : 0);
        if (i < TEST_COUNT(wrong)) assert_non_null(strstr(f.wrong, "outside the pack"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_come_back_to_the_byte), cmocka_unit_test(any_bits_come_back),
        cmocka_unit_test(pictures_take_few_bytes),        cmocka_unit_test(damage_is_refused),
        cmocka_unit_test(versions_from_1_on_are_read),    cmocka_unit_test(lies_about_textures_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
