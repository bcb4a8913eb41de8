/* Textures in blocks of ETC2 and EAC: what the driver reads in them against noh_etc2_decode, for random blocks of every
 * mode, sides that are no multiple of 4, and mip levels; decoded for a context without ETC2, and refused without a
 * decoder; bytes as planned both ways; edges of what one bit of alpha cuts. Blocks of ASTC: read as they lie, refused
 * without the extension, and a picture of what astcenc makes near the exact one. */
#include "support/gl_fixture.h"

#include "support/lit_quad.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "core/base/half_internal.h"
#include "convert/texture/texture_astc.h"
#include "noh/low_core.h"

#define WIDTH 70u
#define HEIGHT 39u
#define LEVELS 7u
#define BYTES_MAX 8192u

static const char fragment[] = "precision highp float;\n"
                               "uniform highp sampler2D values;\n"
                               "uniform int level;\n"
                               "layout(location = 0) out highp uvec4 o_bits;\n"
                               "void main() {\n"
                               "    o_bits = floatBitsToUint(texelFetch(values, ivec2(gl_FragCoord.xy), level));\n"
                               "}\n";

static const char vertex[] = "void main() {\n"
                             "    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0,\n"
                             "                       0.0, 1.0);\n"
                             "}\n";

typedef struct blocks {
    noh_texture_header header;
    uint8_t bytes[BYTES_MAX];
    noh_texture texture;
} blocks;

static blocks random_blocks(uint32_t format, uint32_t flags, uint64_t seed)
{
    test_random random = test_random_from(seed);
    blocks b;
    memset(&b, 0, sizeof b);
    b.header.width = WIDTH;
    b.header.height = HEIGHT;
    b.header.level_count = LEVELS;
    b.header.format = format;
    b.header.flags = flags;
    for (uint32_t i = 0; i < BYTES_MAX; i++) b.bytes[i] = (uint8_t)test_random_u32(&random);
    return b;
}

static const noh_texture *texture_of(blocks *b)
{
    b->texture.name = "blocks";
    b->texture.header = &b->header;
    b->texture.pixels = b->bytes;
    return &b->texture;
}

/* ---- what the GPU reads ---- */

typedef struct reader {
    gpu *g;
    GLuint program, framebuffer, vertex_array;
    noh_gl_texture target;
} reader;

static void reader_open(reader *r)
{
    static const char *const texts[2] = { vertex, fragment };
    static const noh_gl_source sources[2] = { { "#version 300 es\n", &texts[0], 1 },
                                              { "#version 300 es\n", &texts[1], 1 } };
    static const char *const samplers[] = { "values" };
    static char log[4096];
    const noh_gl_texture_desc target = { .format = GL_RGBA32UI, .width = WIDTH, .height = HEIGHT };
    noh_gl_program_desc desc;
    noh_error error;
    memset(&desc, 0, sizeof desc);
    desc.name = "blocks";
    desc.vertex = &sources[0];
    desc.fragment = &sources[1];
    desc.samplers = samplers;
    desc.sampler_count = 1;
    r->g = fixture_gpu();
    const noh_gl_api *gl = &r->g->gl;
    if (noh_gl_program_create(gl, &desc, &r->program, log, sizeof log, &error)) fail_msg("%s\n%s", error.what, log);
    assert_int_equal(noh_gl_texture_create(gl, &r->g->ledger, &target, &r->target, NULL), NOH_OK);
    gl->GenVertexArrays(1, &r->vertex_array);
    gl->GenFramebuffers(1, &r->framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, r->framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, r->target.name, 0);
    assert_int_equal(gl->CheckFramebufferStatus(GL_FRAMEBUFFER), GL_FRAMEBUFFER_COMPLETE);
}

static void reader_close(reader *r)
{
    const noh_gl_api *gl = &r->g->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl->DeleteFramebuffers(1, &r->framebuffer);
    gl->DeleteVertexArrays(1, &r->vertex_array);
    noh_gl_texture_delete(gl, &r->g->ledger, &r->target);
    noh_gl_program_delete(gl, NULL, &r->program);
    fixture_expect_no_errors();
}

/* All texels of a level, as floats. */
static void read_level(const reader *r, GLuint texture, uint32_t level, float *texels)
{
    const noh_gl_api *gl = &r->g->gl;
    const GLsizei width = WIDTH >> level ? (GLsizei)(WIDTH >> level) : 1;
    const GLsizei height = HEIGHT >> level ? (GLsizei)(HEIGHT >> level) : 1;
    gl->BindFramebuffer(GL_FRAMEBUFFER, r->framebuffer);
    gl->Viewport(0, 0, WIDTH, HEIGHT);
    gl->UseProgram(r->program);
    gl->Uniform1i(gl->GetUniformLocation(r->program, "level"), (GLint)level);
    gl->BindVertexArray(r->vertex_array);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, texture);
    gl->DrawArraysInstanced(GL_TRIANGLES, 0, 3, 1);
    gl->ReadPixels(0, 0, width, height, GL_RGBA_INTEGER, GL_UNSIGNED_INT, texels);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    gl->BindVertexArray(0);
    gl->UseProgram(0);
}

/* ---- what the decoder makes ---- */

static float half_at(const uint8_t *bytes)
{
    return noh_half_to_float((uint16_t)(bytes[0] | bytes[1] << 8));
}

/* One texel by decoding its block alone. */
static void decode_texel(const noh_texture *t, uint32_t level, uint32_t x, uint32_t y, float out[4])
{
    const noh_texture_level at = noh_texture_level_at(t, level);
    const uint32_t block = (y / 4u) * ((at.width + 3u) / 4u) + x / 4u;
    uint8_t texels[16][4];
    noh_etc2_decode(t->header->format, at.pixels + block * noh_texture_block_bytes(t->header->format), 1, texels[0]);
    const uint8_t *texel = texels[y % 4u * 4u + x % 4u];
    for (int c = 0; c < 4; c++) out[c] = (float)texel[c] / 255.0f;
    if (t->header->format == NOH_TEXTURE_EAC_RG) {
        out[0] = half_at(texel);
        out[1] = half_at(texel + 2);
        out[2] = 0.0f;
        out[3] = 1.0f;
    }
}

static void compare(const reader *r, const noh_texture *t, GLuint name, float bound)
{
    static float got[WIDTH * HEIGHT * 4u];
    for (uint32_t level = 0; level < LEVELS; level++) {
        const noh_texture_level at = noh_texture_level_at(t, level);
        read_level(r, name, level, got);
        for (uint32_t i = 0; i < at.width * at.height; i++) {
            float want[4];
            decode_texel(t, level, i % at.width, i / at.width, want);
            for (int c = 0; c < 4; c++) {
                if (fabsf(got[4 * i + (uint32_t)c] - want[c]) <= bound) continue;
                fail_msg("format %u, level %u, texel %u, %u, channel %d: %.9g, decoded %.9g", t->header->format, level,
                         i % at.width, i / at.width, c, (double)got[4 * i + (uint32_t)c], (double)want[c]);
            }
        }
    }
}

static void with_and_without_etc2(uint32_t format, uint32_t flags, uint64_t seed, noh_gl_texture made[2], reader *r)
{
    blocks b = random_blocks(format, flags, seed);
    const noh_texture *t = texture_of(&b);
    /* a byte is a float to within rounding; two halves are 2^-12 off */
    const float bound = format == NOH_TEXTURE_EAC_RG ? 0x1.1p-12f : 1e-6f;
    reader_open(r);
    for (int without = 0; without < 2; without++) {
        noh_gl_api gl = r->g->gl;
        const uint64_t before = noh_gl_ledger_bytes(&r->g->ledger);
        if (without) gl.etc2 = 0;
        assert_int_equal(noh_gl_picture_create(&gl, &r->g->ledger, t, &made[without], NULL), NOH_OK);
        assert_int_equal(noh_gl_ledger_bytes(&r->g->ledger) - before, noh_gl_picture_bytes(t, gl.etc2));
        if (flags & NOH_TEXTURE_LINEAR) compare(r, t, made[without].name, bound);
    }
}

static void drop(reader *r, noh_gl_texture made[2])
{
    for (int i = 0; i < 2; i++) noh_gl_texture_delete(&r->g->gl, &r->g->ledger, &made[i]);
    reader_close(r);
}

static void the_driver_reads_what_is_decoded(void **state)
{
    static const uint32_t formats[] = { NOH_TEXTURE_ETC2_RGB, NOH_TEXTURE_ETC2_RGBA, NOH_TEXTURE_EAC_RG,
                                        NOH_TEXTURE_ETC2_RGBA1 };
    (void)state;
    for (uint64_t i = 0; i < 12; i++) {
        noh_gl_texture made[2];
        reader r;
        with_and_without_etc2(formats[i % 4u], NOH_TEXTURE_LINEAR, 100u + i, made, &r);
        drop(&r, made);
    }
}

/* sRGB becomes linear in the same way. */
static void colours_are_srgb_both_ways(void **state)
{
    static float texels[2][WIDTH * HEIGHT * 4u];
    (void)state;
    for (uint32_t format = NOH_TEXTURE_ETC2_RGB; format <= NOH_TEXTURE_ETC2_RGBA1; format++) {
        if (format == NOH_TEXTURE_EAC_RG) continue; /* never of colours */
        noh_gl_texture made[2];
        reader r;
        float darker = 0.0f;
        with_and_without_etc2(format, 0, 7u + format, made, &r);
        for (int i = 0; i < 2; i++) read_level(&r, made[i].name, 0, texels[i]);
        for (uint32_t i = 0; i < WIDTH * HEIGHT * 4u; i++) {
            assert_true(fabsf(texels[0][i] - texels[1][i]) < 1e-3f);
            darker += texels[0][i];
        }
        assert_true(darker / (WIDTH * HEIGHT * 4u) < (format == NOH_TEXTURE_ETC2_RGB ? 0.55f : 0.45f));
        drop(&r, made);
    }
}

/* A white disk on what is transparent, magnified: with alphas of one bit the texels round it are black, and yet no pixel
 * of it is darker than white, with ETC2 or without. Its edge is where 8 bits of alpha have it. */
static void edges_are_as_bright_as_what_they_are_of(void **state)
{
    static const float uv[8] = { 0, 0, 1, 0, 0, 1, 1, 1 };
    static uint8_t disk[32 * 32 * 4];
    model_texture t = {
        .width = 32, .height = 32, .rgba = disk, .blocks = MODEL_BLOCKS_ETC2, .with_alpha = 1, .alpha_cutoff = 0.5f
    };
    gpu *g = fixture_gpu();
    const int had = g->gl.etc2;
    lit_quad q = lit_quad_of();
    uint8_t *smooth, *rgba;
    (void)state;
    for (int i = 0; i < 32 * 32; i++) {
        const int x = 2 * (i % 32) - 31, y = 2 * (i / 32) - 31, inside = x * x + y * y < 25 * 25;
        memset(disk + 4 * i, inside ? 255 : 7, 3);
        disk[4 * i + 3] = inside ? 255 : 0;
    }
    for (int i = 0; i < 4; i++) q.base[i] = 1.0f;
    q.uv = uv;
    q.unlit = q.double_sided = 1;
    q.alpha = MODEL_ALPHA_MASK;
    q.base_map = &t;
    t.mag_filter = t.min_filter = 9729;
    t.wrap_s = t.wrap_t = 33071;
    smooth = lit_quad_draw(g, &q, NOH_DRAW_OPAQUE);
    t.cut_alone = 1;
    for (int without = 0; without < 2; without++) {
        uint32_t white = 0, other = 0;
        g->gl.etc2 = without ? 0 : had;
        rgba = lit_quad_draw(g, &q, NOH_DRAW_OPAQUE);
        for (uint32_t i = 0; i < LIT_QUAD_SIDE * LIT_QUAD_SIDE; i++) {
            const uint8_t *pixel = rgba + 4u * i;
            if (!lit_quad_is_background(pixel)) {
                white++;
                if (pixel[0] < 253 || pixel[1] < 253) fail_msg("pixel %u of the disk is dark: %u", i, pixel[0]);
            }
            other += lit_quad_is_background(pixel) != lit_quad_is_background(smooth + 4u * i);
        }
        assert_in_range(white, LIT_QUAD_SIDE * LIT_QUAD_SIDE / 3u, LIT_QUAD_SIDE * LIT_QUAD_SIDE / 2u);
        assert_in_range(other, 0, 2);
        free(rgba);
    }
    g->gl.etc2 = had;
    free(smooth);
    fixture_expect_no_errors();
}

/* ---- ASTC ---- */

/* Blocks of one random colour each (a void extent without bounds). */
static blocks plain_blocks(uint32_t format, uint32_t flags)
{
    blocks b = random_blocks(format, flags, 5);
    for (uint32_t i = 0; i < BYTES_MAX / 16u; i++) {
        uint8_t *block = b.bytes + 16u * i;
        memset(block, 0xff, 8);
        block[0] = 0xfc;
        block[1] = 0xfd;
        for (int c = 0; c < 4; c++) block[8 + 2 * c] = block[9 + 2 * c];
    }
    return b;
}

static void astc_blocks_are_read_as_they_lie(void **state)
{
    static const uint32_t sides[] = { 4, 5, 6, 8 };
    static float got[WIDTH * HEIGHT * 4u];
    gpu *g = fixture_gpu();
    (void)state;
    if (!g->gl.astc) skip();
    for (uint32_t i = 0; i < 8; i++) {
        const uint32_t side = sides[i % 4u];
        blocks b = plain_blocks(NOH_TEXTURE_ASTC_4X4 + i % 4u, i < 4 ? NOH_TEXTURE_LINEAR : 0u);
        const noh_texture *t = texture_of(&b);
        const uint64_t before = noh_gl_ledger_bytes(&g->ledger);
        noh_gl_texture made;
        reader r;
        reader_open(&r);
        const uint64_t opened = noh_gl_ledger_bytes(&g->ledger);
        assert_int_equal(noh_gl_picture_create(&g->gl, &g->ledger, t, &made, NULL), NOH_OK);
        assert_int_equal(noh_gl_ledger_bytes(&g->ledger) - opened, noh_gl_picture_bytes(t, 0));
        for (uint32_t level = 0; level < LEVELS; level++) {
            const noh_texture_level at = noh_texture_level_at(t, level);
            const uint32_t columns = (at.width + side - 1u) / side;
            read_level(&r, made.name, level, got);
            for (uint32_t k = 0; k < at.width * at.height; k++) {
                const uint8_t *block = at.pixels + 16u * (k / at.width / side * columns + k % at.width / side);
                for (uint32_t c = i < 4 ? 0 : 3; c < 4u; c++) { /* of sRGB, alpha is as it is */
                    assert_true(fabsf(got[4 * k + c] - (float)block[8 + 2 * c] / 255.0f) < 1e-3f);
                }
            }
        }
        noh_gl_texture_delete(&g->gl, &g->ledger, &made);
        reader_close(&r);
        assert_int_equal(noh_gl_ledger_bytes(&g->ledger), before);
    }
}

static void astc_without_the_extension_is_refused(void **state)
{
    gpu *g = fixture_gpu();
    blocks b = plain_blocks(NOH_TEXTURE_ASTC_6X6, 0);
    noh_gl_texture texture;
    noh_gl_api gl = g->gl;
    const uint64_t before = noh_gl_ledger_bytes(&g->ledger);
    noh_error error;
    (void)state;
    gl.astc = 0;
    assert_int_equal(noh_gl_picture_create(&gl, &g->ledger, texture_of(&b), &texture, &error), NOH_ERR_UNSUPPORTED);
    assert_non_null(strstr(error.what, "--textures etc2"));
    assert_int_equal(noh_gl_ledger_bytes(&g->ledger), before);
    fixture_expect_no_errors();
}

/* The plan of a stage says it, before there is anything. */
static void plans_refuse_astc_without_the_extension(void **state)
{
    const test_model_desc sheet = { 1, 5, 0, TEST_UVS | TEST_SCENE, 3 };
    size_t count;
    uint8_t *bytes = test_pack(&sheet, &count);
    noh_pack pack = test_open(bytes, count);
    noh_kind_desc kind = { .mesh = &pack, .actor_count = 1 };
    noh_stage_desc desc = { .kinds = &kind, .kind_count = 1, .gpu = &noh_stage_on_gl };
    noh_gl_caps caps;
    noh_stage_plan plan;
    noh_texture texture;
    noh_error error;
    (void)state;
    noh_gl_caps_nominal(&caps);
    assert_int_equal(noh_stage_plan_make(&desc, &caps, &plan, NULL), NOH_OK);
    const uint64_t exact = plan.gpu_bytes;
    assert_int_equal(noh_pack_texture_at(&pack, 0, &texture, NULL), NOH_OK);
    const uint64_t texels = noh_gl_picture_bytes(&texture, 1);
    ((noh_texture_header *)(uintptr_t)texture.header)->format = NOH_TEXTURE_ASTC_6X6;
    assert_int_equal(noh_stage_plan_make(&desc, &caps, &plan, NULL), NOH_OK);
    assert_int_equal(exact - plan.gpu_bytes, texels - noh_gl_picture_bytes(&texture, 1));
    caps.astc = 0;
    assert_int_equal(noh_stage_plan_make(&desc, &caps, &plan, &error), NOH_ERR_UNSUPPORTED);
    assert_non_null(strstr(error.what, "--textures etc2"));
    free(bytes);
}

/* Waves in three channels, drawn out of the largest blocks: at most 16 of 255 off, 2 in the mean. */
static void astc_is_drawn_near_the_exact_picture(void **state)
{
    static const float uv[8] = { 0, 0, 1, 0, 0, 1, 1, 1 };
    static uint8_t waves[64 * 64 * 4];
    model_texture t = { .width = 64, .height = 64, .rgba = waves, .wrap_s = 33071, .wrap_t = 33071 };
    gpu *g = fixture_gpu();
    lit_quad q = lit_quad_of();
    uint32_t sum = 0;
    (void)state;
    if (!g->gl.astc || texture_astc_find(NULL)) skip();
    for (int i = 0; i < 64 * 64; i++) {
        for (int c = 0; c < 3; c++) {
            waves[4 * i + c] = (uint8_t)(128.0 + 70.0 * sin(i % 64 * 0.06 + c) * cos(i / 64 * 0.05 - c));
        }
        waves[4 * i + 3] = 255;
    }
    for (int i = 0; i < 4; i++) q.base[i] = 1.0f;
    q.uv = uv;
    q.unlit = q.double_sided = 1;
    q.base_map = &t;
    t.mag_filter = t.min_filter = 9729;
    uint8_t *exact = lit_quad_draw(g, &q, NOH_DRAW_OPAQUE);
    t.blocks = MODEL_BLOCKS_ASTC;
    uint8_t *rgba = lit_quad_draw(g, &q, NOH_DRAW_OPAQUE);
    for (uint32_t i = 0; i < LIT_QUAD_SIDE * LIT_QUAD_SIDE * 4u; i++) {
        const uint32_t off = (uint32_t)abs(rgba[i] - exact[i]);
        assert_in_range(off, 0, 16);
        sum += off;
    }
    assert_in_range(sum, 1, 2u * LIT_QUAD_SIDE * LIT_QUAD_SIDE * 4u);
    free(exact);
    free(rgba);
    fixture_expect_no_errors();
}

static void blocks_without_etc2_and_decoder_are_refused(void **state)
{
    gpu *g = fixture_gpu();
    blocks b = random_blocks(NOH_TEXTURE_ETC2_RGB, 0, 1);
    noh_gl_texture texture;
    noh_gl_api gl = g->gl;
    const uint64_t before = noh_gl_ledger_bytes(&g->ledger);
    noh_error error;
    (void)state;
    gl.etc2 = 0;
    gl.decode = NULL;
    assert_int_equal(noh_gl_picture_create(&gl, &g->ledger, texture_of(&b), &texture, &error), NOH_ERR_UNSUPPORTED);
    assert_non_null(strstr(error.what, "noh_gl_api.decode"));
    assert_int_equal(noh_gl_ledger_bytes(&g->ledger), before);
    b.header.format = NOH_TEXTURE_RGBA8; /* needs neither */
    b.header.level_count = 1;
    b.header.width = b.header.height = 16;
    assert_int_equal(noh_gl_picture_create(&gl, &g->ledger, texture_of(&b), &texture, &error), NOH_OK);
    noh_gl_texture_delete(&gl, &g->ledger, &texture);
    fixture_expect_no_errors();
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(the_driver_reads_what_is_decoded),
                                        cmocka_unit_test(colours_are_srgb_both_ways),
                                        cmocka_unit_test(edges_are_as_bright_as_what_they_are_of),
                                        cmocka_unit_test(blocks_without_etc2_and_decoder_are_refused),
                                        cmocka_unit_test(astc_blocks_are_read_as_they_lie),
                                        cmocka_unit_test(astc_without_the_extension_is_refused),
                                        cmocka_unit_test(plans_refuse_astc_without_the_extension),
                                        cmocka_unit_test(astc_is_drawn_near_the_exact_picture) };
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
