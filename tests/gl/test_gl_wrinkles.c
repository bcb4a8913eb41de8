/* Wrinkles on the GPU: normals blended as the CPU blends them, the area of a triangle by derivatives against the exact
 * one, channels against their closed form, and in a crowd the wrinkles of each actor's own expression. */
#include "support/stage_fixture.h"

#include "convert/model/model.h"
#include "convert/wrinkle/region_mask.h"
#include "gl/draw/gl_variants_internal.h"
#include "core/mesh/mesh_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "support/gl_fixture.h"

#include <math.h>

static noh_error said;

/* ---- a program that shows floats ---- */

#define SIDE 64u

static const char fragment_head[] =
    "layout(location = 0) out vec4 o_color;\n"
    "uniform int test_pick;\n"
    "void show(float value) {\n"
    "    uint bits = floatBitsToUint(value);\n"
    "    o_color = vec4(uvec4(bits, bits >> 8, bits >> 16, bits >> 24) & 255u) / 255.0;\n"
    "}\n";

typedef struct program {
    const noh_gl_api *gl;
    noh_gl_ledger ledger;
    noh_gl_variant variant;
    char text[4096];
} program;

static void program_open_with(program *p, uint32_t features, const char *vertex, const char *fragment)
{
    static const noh_gl_input added[] = { { 8, GL_FLOAT_VEC3 }, { 9, GL_FLOAT } }; /* area_vertex */
    static char log[8192];
    gpu *g = fixture_gpu();
    noh_gl_variant_key key = { 0 };
    noh_gl_shader_desc own;
    memset(p, 0, sizeof *p);
    memset(&own, 0, sizeof own);
    p->gl = &g->gl;
    key.features = features;
    snprintf(p->text, sizeof p->text, "%s%s", fragment_head, fragment);
    own.vertex = vertex;
    own.fragment = p->text;
    own.inputs = added;
    own.input_count = 2;
    const noh_gl_device device = { &g->gl, &g->caps, &p->ledger, log, sizeof log };
    if (noh_gl_variant_create(&device, key, &own, NULL, 0, &p->variant, &said)) fail_msg("%s\n%s", said.what, log);
    p->gl->UseProgram(p->variant.program);
    p->gl->Disable(GL_DITHER);
}

static void program_open(program *p, const char *vertex, const char *fragment)
{
    program_open_with(p, NOH_FEATURE_WRINKLES, vertex, fragment);
}

static void program_close(program *p)
{
    p->gl->UseProgram(0);
    noh_gl_variant_delete(p->gl, &p->ledger, &p->variant);
    fixture_expect_no_errors();
}

static void pick(const program *p, int value)
{
    p->gl->Uniform1i(p->gl->GetUniformLocation(p->variant.program, "test_pick"), value);
}

static float float_at(const uint8_t *rgba, size_t pixel)
{
    const uint8_t *b = rgba + 4 * pixel;
    const uint32_t bits = (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static const char cover_vertex[] = "void main() {\n"
                                   "    noh_v_rest = noh_v_moved = vec3(0.0);\n"
                                   "    noh_wrinkle_vertex(vec2(0.5));\n"
                                   "    gl_Position = vec4(float(gl_VertexID & 1) * 4.0 - 1.0,\n"
                                   "                       float(gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);\n"
                                   "}\n";

/* One float of every pixel of the frame, to be freed. */
static uint8_t *cover(const program *p, fixture_frame *frame, int picked)
{
    GLuint array;
    pick(p, picked);
    p->gl->GenVertexArrays(1, &array);
    p->gl->BindVertexArray(array);
    p->gl->DrawArrays(GL_TRIANGLES, 0, 3);
    p->gl->BindVertexArray(0);
    p->gl->DeleteVertexArrays(1, &array);
    return fixture_frame_read(frame);
}

/* ---- normals ---- */

static const char blend_fragment[] =
    "void main() {\n"
    "    ivec2 i = ivec2(gl_FragCoord.xy);\n"
    "    vec3 base = normalize(vec3(vec2(i) / 16.0 - 2.0, 1.0));\n"
    "    vec3 texel = vec3(i.x * 37 + i.y * 11 & 255, i.x * 7 + i.y * 91 & 255, 130 + (i.x + i.y & 127) * 125 / 127) / 255.0;\n"
    "    float weight = float(i.x * 5 + i.y * 3 & 15) / 15.0;\n"
    "    show(normalize(noh_wrinkled(base, texel, vec3(0.0, weight, 0.5 * weight)))[test_pick]);\n"
    "}\n";

static void expected_blend(uint32_t x, uint32_t y, float out[3])
{
    float base[3] = { (float)x / 16.0f - 2.0f, (float)y / 16.0f - 2.0f, 1.0f };
    const float length = sqrtf(base[0] * base[0] + base[1] * base[1] + 1.0f);
    const uint32_t bytes[3] = { (x * 37 + y * 11) & 255, (x * 7 + y * 91) & 255, 130 + ((x + y) & 127) * 125 / 127 };
    float wrinkle[3];
    for (int i = 0; i < 3; i++) {
        base[i] /= length;
        wrinkle[i] = ((float)bytes[i] - 128.0f) / 127.0f;
    }
    noh_wrinkles_normal(base, wrinkle, (float)((x * 5 + y * 3) & 15) / 15.0f, out);
}

static void normals_are_those_of_the_cpu(void **state)
{
    program p;
    fixture_frame frame;
    double off = 0.0;
    (void)state;
    fixture_frame_open(&frame, SIDE);
    program_open(&p, cover_vertex, blend_fragment);
    for (int c = 0; c < 3; c++) {
        uint8_t *rgba = cover(&p, &frame, c);
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            float right[3];
            expected_blend(i % SIDE, i / SIDE, right);
            off = fmax(off, fabs((double)float_at(rgba, i) - (double)right[c]));
        }
        free(rgba);
    }
    print_message("wrinkled normals: the GPU's are off the CPU's by at most %.2g\n", off);
    assert_true(off < 1e-5);
    program_close(&p);
    fixture_frame_close(&frame);
}

/* ---- channels ---- */

static const char channel_fragment[] =
    "void main() {\n"
    "    vec3 by = noh_wrinkle_by_model();\n"
    "    vec3 n = normalize(noh_wrinkled(vec3(0.0, 0.0, 1.0), vec3(200.0, 90.0, 210.0) / 255.0, by));\n"
    "    show(test_pick < 3 ? n[test_pick] : by[test_pick - 3]);\n"
    "}\n";

static void one_texel(const program *p, noh_gl_texture *t, noh_gl_ledger *ledger, const uint8_t texel[4], uint32_t unit)
{
    const noh_gl_texture_desc desc = { GL_RGBA8, 1, 1, 0, 1, 0, 0 };
    assert_int_equal(noh_gl_texture_create(p->gl, ledger, &desc, t, &said), NOH_OK);
    p->gl->ActiveTexture(GL_TEXTURE0 + unit);
    p->gl->BindTexture(GL_TEXTURE_2D, t->name);
    p->gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, texel);
}

/* The book's formula on its own: w = min(r + forehead g + cheek b, 1); n.xy *= w, and unit again. */
static void channel_formula(const uint8_t texel[4], const float region[12], uint32_t models, double out[4])
{
    double w = texel[0] / 255.0 + (double)region[1] * texel[1] / 255.0 + (double)region[2] * texel[2] / 255.0;
    double n[3] = { 72.0 / 127.0, -38.0 / 127.0, 82.0 / 127.0 }, length, most = 0.0;
    w = w < 1.0 ? w : 1.0;
    for (int c = 0; c < 3 && (models & NOH_WRINKLE_BY_REGION); c++) {
        most = fmax(most, (double)region[c] * texel[c] / 255.0); /* of region 3 c, the first map's */
    }
    out[3] = w;
    w = w > most ? w : most;
    length = sqrt(w * w * (n[0] * n[0] + n[1] * n[1]) + n[2] * n[2]);
    for (int i = 0; i < 3; i++) out[i] = (i < 2 ? w : 1.0) * n[i] / length;
}

static void channels_add_up_to_one(void **state)
{
    static const uint8_t texels[3][4] = { { 40, 200, 90, 0 }, { 0, 255, 255, 255 }, { 130, 60, 255, 0 } };
    static const uint8_t none[4] = { 0, 0, 0, 0 };
    static const float regions[3][12] = { { 0, 0, 0 }, { 0.5f, 0.25f, 0.6f }, { 1.0f, 0.8f, 1.0f } };
    program p;
    fixture_frame frame;
    noh_gl_ledger ledger;
    noh_gl_texture maps[3];
    double off = 0.0;
    (void)state;
    memset(&ledger, 0, sizeof ledger);
    fixture_frame_open(&frame, 1);
    program_open(&p, cover_vertex, channel_fragment);
    for (uint32_t i = 0; i < 18; i++) {
        const uint32_t models = i < 9 ? NOH_WRINKLE_BY_CHANNEL : NOH_WRINKLE_BY_CHANNEL | NOH_WRINKLE_BY_REGION;
        double right[4];
        for (uint32_t k = 0; k < 3; k++) {
            one_texel(&p, &maps[k], &ledger, k ? none : texels[i % 3], NOH_UNIT_WRINKLE_WEIGHTS + k);
        }
        p.gl->Uniform4fv(p.variant.u_wrinkle_regions, 3, regions[i / 3 % 3]);
        p.gl->Uniform2i(p.variant.u_wrinkle_models, (GLint)models, 255);
        channel_formula(texels[i % 3], regions[i / 3 % 3], models, right);
        for (int c = 0; c < 4; c++) {
            uint8_t *rgba = cover(&p, &frame, c < 3 ? c : 5);
            off = fmax(off, fabs((double)float_at(rgba, 0) - right[c]));
            free(rgba);
        }
        for (uint32_t k = 0; k < 3; k++) noh_gl_texture_delete(p.gl, &ledger, &maps[k]);
    }
    print_message("wrinkles by channel: off the closed form by at most %.2g\n", off);
    assert_true(off < 5e-4); /* an eighth of a step of a byte: filters of textures are that coarse */
    program_close(&p);
    fixture_frame_close(&frame);
}

/* ---- masks that pixels read ---- */

static const char mask_fragment[] = "void main() {\n"
                                    "    vec3 by = noh_wrinkle_by_model(gl_FragCoord.xy / 64.0);\n"
                                    "    show(test_pick == 0 ? by.y : by.z);\n"
                                    "}\n";

static void mask_texture(const program *p, noh_gl_texture *t, noh_gl_ledger *ledger, const uint8_t *codes)
{
    const noh_gl_texture_desc desc = { GL_RGBA8, SIDE, SIDE, 0, 1, 0, 0 };
    assert_int_equal(noh_gl_texture_create(p->gl, ledger, &desc, t, &said), NOH_OK);
    p->gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_WRINKLE_WEIGHTS);
    p->gl->BindTexture(GL_TEXTURE_2D, t->name);
    p->gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    p->gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    p->gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, (GLsizei)SIDE, (GLsizei)SIDE, GL_RGBA, GL_UNSIGNED_BYTE, codes);
}

/* Every code in every channel, alone and with others: the source's formula, to the rounding of floats. */
static void pixels_read_masks_as_the_source_does(void **state)
{
    static uint8_t codes[SIDE * SIDE * 4];
    program p;
    fixture_frame frame;
    noh_gl_ledger ledger;
    noh_gl_texture mask;
    float regions[NOH_WRINKLE_REGIONS], rows[NOH_WRINKLE_REGIONS];
    double off = 0.0;
    (void)state;
    test_random r = test_random_from(12);
    memset(&ledger, 0, sizeof ledger);
    for (uint32_t i = 0; i < SIDE * SIDE * 4; i++) codes[i] = (uint8_t)(i < 1024 ? i / 4 : test_random_below(&r, 256));
    for (uint32_t i = 0; i < NOH_WRINKLE_FOLDS; i++) {
        regions[i] = (float)(30 + 20 * i) / 255.0f;
        rows[4 * (i % 3) + i / 3] = regions[i];
    }
    fixture_frame_open(&frame, SIDE);
    program_open_with(&p, NOH_FEATURE_WRINKLES | NOH_FEATURE_WRINKLE_PIXEL, cover_vertex, mask_fragment);
    mask_texture(&p, &mask, &ledger, codes);
    p.gl->Uniform4fv(p.variant.u_wrinkle_regions, 3, rows);
    p.gl->Uniform2i(p.variant.u_wrinkle_models, NOH_WRINKLE_BY_REGION | NOH_WRINKLE_BY_CHANNEL, 255);
    uint8_t *by_region = cover(&p, &frame, 0), *by_channel = cover(&p, &frame, 1);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const uint8_t *c = codes + 4 * i;
        const float first[3] = { c[0] < 90 ? region_weight(c[0]) : 0.0f, c[1] < 90 ? region_weight(c[1]) : 0.0f,
                                 c[2] < 90 ? region_weight(c[2]) : 0.0f };
        const float sum = first[0] + regions[3] * first[1] + regions[6] * first[2];
        off = fmax(off, fabs((double)float_at(by_region, i) - (double)region_texel_weight(c, regions)));
        off = fmax(off, fabs((double)float_at(by_channel, i) - fmin((double)sum, 1.0)));
    }
    free(by_region);
    free(by_channel);
    print_message("masks by pixel: off the CPU's weights by at most %.2g\n", off);
    assert_true(off < 1e-5);
    noh_gl_texture_delete(p.gl, &ledger, &mask);
    program_close(&p);
    fixture_frame_close(&frame);
}

/* ---- errors of the source of regions ---- */

static const char region_fragment[] = "void main() {\n    show(noh_wrinkle_by_model().y);\n}\n";

/* float3 takes four floats in a constant buffer, so twelve weights in a row shift: red's third is green's first. Here
 * they are three vectors of four, one for each map, and each region finds its own. */
static void each_region_has_its_own_weight(void **state)
{
    program p;
    fixture_frame frame;
    noh_gl_ledger ledger;
    noh_gl_texture maps[3];
    noh_gl_renderer renderer;
    uint32_t literal_wrong = 0;
    (void)state;
    memset(&ledger, 0, sizeof ledger);
    memset(&renderer, 0, sizeof renderer);
    fixture_frame_open(&frame, 1);
    program_open(&p, cover_vertex, region_fragment);
    for (uint32_t k = 0; k < 3; k++) {
        const uint8_t texel[4] = { (uint8_t)(10 + 20 * k), (uint8_t)(70 + 20 * k), (uint8_t)(130 + 20 * k),
                                   (uint8_t)(190 + 20 * k) };
        one_texel(&p, &maps[k], &ledger, texel, NOH_UNIT_WRINKLE_WEIGHTS + k);
    }
    p.gl->Uniform2i(p.variant.u_wrinkle_models, NOH_WRINKLE_BY_REGION, 255);
    for (uint32_t r = 0; r < 2u * NOH_WRINKLE_FOLDS; r++) {
        const uint32_t region = r % NOH_WRINKLE_FOLDS;
        const int literal = r >= NOH_WRINKLE_FOLDS;
        const double right = (10 + 60 * (region / 3) + 20 * (region % 3)) / 255.0;
        float regions[NOH_WRINKLE_REGIONS] = { 0.0f };
        regions[region] = 1.0f;
        noh_gl_draw_instance(&renderer, NULL, NULL, regions);
        p.gl->Uniform4fv(p.variant.u_wrinkle_regions, 3, literal ? regions : renderer.wrinkles);
        uint8_t *rgba = cover(&p, &frame, 0);
        const int is_right = fabs((double)float_at(rgba, 0) - right) < 5e-4;
        free(rgba);
        literal_wrong += literal && !is_right;
        if (!literal) assert_true(is_right);
    }
    print_message("weights in a row: %u of 12 regions get another's\n", literal_wrong);
    assert_true(literal_wrong >= 9);
    for (uint32_t k = 0; k < 3; k++) noh_gl_texture_delete(p.gl, &ledger, &maps[k]);
    program_close(&p);
    fixture_frame_close(&frame);
}

/* ---- colours ---- */

static const char color_fragment[] = "void main() {\n"
                                     "    ivec2 i = ivec2(gl_FragCoord.xy);\n"
                                     "    vec3 albedo = vec3(i.x, i.y, i.x + i.y & 63) / 63.0;\n"
                                     "    show(noh_colored(albedo, noh_color_weights(vec2(0.5)))[test_pick]);\n"
                                     "}\n";

static const char color_vertex[] = "void main() {\n"
                                   "    gl_Position = vec4(float(gl_VertexID & 1) * 4.0 - 1.0,\n"
                                   "                       float(gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);\n"
                                   "}\n";

/* The weights are those that the renderer keeps for a mesh drawn alone. */
static void colors_are_those_of_the_cpu(void **state)
{
    static const uint8_t colors[4][4] = {
        { 204, 51, 51, 0 }, { 20, 250, 130, 0 }, { 90, 90, 200, 0 }, { 255, 255, 255, 0 }
    };
    static const uint8_t texel[4] = { 200, 31, 128, 77 };
    const noh_wrinkles wrinkles = { .colors = colors[0] };
    float regions[NOH_WRINKLE_REGIONS] = { 0.0f }, sent[4][4], worst = 0.0f;
    noh_gl_renderer renderer;
    noh_gl_ledger ledger;
    noh_gl_texture map;
    fixture_frame frame;
    program p;
    (void)state;
    memset(&renderer, 0, sizeof renderer);
    memset(&ledger, 0, sizeof ledger);
    fixture_frame_open(&frame, SIDE);
    program_open_with(&p, NOH_FEATURE_COLORS, color_vertex, color_fragment);
    one_texel(&p, &map, &ledger, texel, NOH_UNIT_COLORS);
    for (uint32_t c = 0; c < 4; c++) regions[NOH_WRINKLE_FOLDS + c] = (float)(51u * (c + 1u)) / 255.0f;
    noh_gl_draw_instance(&renderer, NULL, NULL, regions);
    for (uint32_t c = 0; c < 4; c++) {
        for (uint32_t i = 0; i < 3; i++) sent[c][i] = (float)(colors[c][i] * colors[c][i]) / 65025.0f;
        sent[c][3] = renderer.wrinkles[NOH_WRINKLE_FOLDS + c];
    }
    p.gl->Uniform4fv(p.variant.u_colors, 4, sent[0]);
    for (int picked = 0; picked < 3; picked++) {
        uint8_t *rgba = cover(&p, &frame, picked);
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            const uint32_t x = i % SIDE, y = i / SIDE;
            float rgb[3] = { (float)x / 63.0f, (float)y / 63.0f, (float)((x + y) & 63u) / 63.0f };
            noh_wrinkles_color(&wrinkles, texel, regions, rgb);
            worst = fmaxf(worst, fabsf(float_at(rgba, i) - rgb[picked]));
        }
        free(rgba);
    }
    print_message("colours differ from the CPU's by at most %.2g\n", (double)worst);
    assert_true(worst < 5e-4f); /* filtered texels of drivers are off by that much; a byte is 4e-3 */
    noh_gl_texture_delete(p.gl, &ledger, &map);
    program_close(&p);
    fixture_frame_close(&frame);
}

/* Weights of 0 in the left half. */
static const char half_vertex[] = "out float v_x;\n"
                                  "void main() {\n"
                                  "    noh_v_rest = noh_v_moved = vec3(0.0);\n"
                                  "    v_x = float(gl_VertexID & 1) * 4.0 - 1.0;\n"
                                  "    noh_v_wrinkles = vec2(v_x, 0.0);\n"
                                  "    gl_Position = vec4(v_x, float(gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);\n"
                                  "}\n";

static uint32_t covered_by(const char *fragment)
{
    program p;
    fixture_frame frame;
    uint32_t drawn = 0;
    fixture_frame_open(&frame, SIDE);
    program_open(&p, half_vertex, fragment);
    p.gl->Uniform2i(p.variant.u_wrinkle_models, NOH_WRINKLE_BY_REGION, 255);
    p.gl->ClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    p.gl->Clear(GL_COLOR_BUFFER_BIT);
    uint8_t *rgba = cover(&p, &frame, 0);
    for (size_t i = 0; i < (size_t)SIDE * SIDE; i++) drawn += float_at(rgba, i) > 0.0f;
    free(rgba);
    program_close(&p);
    fixture_frame_close(&frame);
    return drawn;
}

/* clip(r + g + b + a - 0.01), clip(weight - 0.001): in a pass that also draws the base, holes where nothing wrinkles.
 */
static void what_has_no_wrinkles_is_drawn(void **state)
{
    static const char ours[] =
        "void main() {\n"
        "    vec3 by = max(noh_wrinkle_by_model(), vec3(0.0));\n"
        "    show(normalize(noh_wrinkled(vec3(0.0, 0.0, 1.0), vec3(200.0, 90.0, 210.0) / 255.0, by)).z);\n"
        "}\n",
                      literal[] = "void main() {\n"
                                  "    if (noh_wrinkle_by_model().y - 0.001 < 0.0) discard;\n"
                                  "    show(1.0);\n"
                                  "}\n";
    (void)state;
    assert_int_equal(covered_by(ours), SIDE * SIDE);
    assert_int_equal(covered_by(literal), SIDE * SIDE / 2);
}

/* lerp(base, wrinkle, weight) of texels as they are read: a flat map leans by 35 degrees. */
static void texels_become_normals_before_they_mix(void **state)
{
    static const char fragment[] =
        "void main() {\n"
        "    vec3 flat_texel = vec3(128.0, 128.0, 255.0) / 255.0, base = vec3(0.0, 0.0, 1.0);\n"
        "    vec3 literal = normalize(mix(base, flat_texel, 1.0));\n"
        "    show(test_pick == 0 ? normalize(noh_wrinkled(base, flat_texel, vec3(1.0))).z : literal.z);\n"
        "}\n";
    program p;
    fixture_frame frame;
    (void)state;
    fixture_frame_open(&frame, 1);
    program_open(&p, cover_vertex, fragment);
    uint8_t *ours = cover(&p, &frame, 0), *literal = cover(&p, &frame, 1);
    assert_true(float_at(ours, 0) > 0.99999f);
    assert_true(float_at(literal, 0) < 0.83f);
    free(ours);
    free(literal);
    program_close(&p);
    fixture_frame_close(&frame);
}

/* ---- area ---- */

#define AREA_SIDE 384u
#define AREA_BOUND 5e-4

static const char area_vertex[] = "layout(location = 8) in vec3 test_moved;\n"
                                  "layout(location = 9) in float test_id;\n"
                                  "uniform vec4 test_camera;\n" /* 1 / radius, distance, x, y */
                                  "flat out float v_id;\n"
                                  "void main() {\n"
                                  "    vec3 p = (noh_a_position + test_moved - noh_center) * test_camera.x;\n"
                                  "    noh_v_rest = noh_a_position - noh_center;\n"
                                  "    noh_v_moved = test_moved;\n"
                                  "    noh_v_wrinkles = vec2(0.0);\n"
                                  "    v_id = test_id;\n"
                                  "    p = vec3(p.xy - test_camera.zw, test_camera.y - p.z);\n"
                                  "    gl_Position = vec4(2.0 * p.xy, p.z * 0.5 - 0.1, p.z);\n"
                                  "}\n";

static const char area_fragment[] = "flat in float v_id;\n"
                                    "void main() {\n"
                                    "    show(test_pick == 0 ? v_id : noh_area_ratio());\n"
                                    "}\n";

typedef struct corner {
    float rest[3], moved[3], id;
} corner;

static double area_of(const corner *t, int moved)
{
    double a[3], b[3], n[3];
    for (int i = 0; i < 3; i++) {
        a[i] = (double)t[1].rest[i] - (double)t[0].rest[i];
        b[i] = (double)t[2].rest[i] - (double)t[0].rest[i];
        if (moved) a[i] += (double)t[1].moved[i] - (double)t[0].moved[i];
        if (moved) b[i] += (double)t[2].moved[i] - (double)t[0].moved[i];
    }
    for (int i = 0; i < 3; i++) n[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    return 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

typedef struct area_stage {
    program p;
    fixture_frame frame;
    GLuint array, buffer;
    corner *corners;
    uint32_t count;
    double worst;
    uint64_t pixels;
} area_stage;

static void fill_corners(area_stage *s, const model_mesh *m, uint32_t target)
{
    for (uint32_t i = 0; i < s->count; i++) {
        const size_t v = m->indices[i];
        memcpy(s->corners[i].rest, m->position + 3 * v, 12);
        memcpy(s->corners[i].moved, m->targets[target].position + 3 * v, 12);
        s->corners[i].id = (float)(1 + i / 3);
    }
}

static void area_open(area_stage *s, const model_mesh *m)
{
    static const struct {
        GLuint at;
        GLint size;
        size_t offset;
    } attributes[] = { { 0, 3, 0 }, { 8, 3, 12 }, { 9, 1, 24 } };
    float low[3] = { 1e9f, 1e9f, 1e9f }, high[3] = { -1e9f, -1e9f, -1e9f };
    for (uint32_t i = 0; i < 3 * m->vertex_count; i++) {
        low[i % 3] = fminf(low[i % 3], m->position[i]);
        high[i % 3] = fmaxf(high[i % 3], m->position[i]);
    }
    memset(s, 0, sizeof *s);
    s->count = m->index_count;
    s->corners = test_zeros(s->count * sizeof *s->corners);
    fixture_frame_open(&s->frame, AREA_SIDE);
    program_open(&s->p, area_vertex, area_fragment);
    s->p.gl->Uniform3f(s->p.variant.u_center, 0.5f * (low[0] + high[0]), 0.5f * (low[1] + high[1]),
                       0.5f * (low[2] + high[2]));
    s->p.gl->Uniform4f(s->p.gl->GetUniformLocation(s->p.variant.program, "test_camera"), 2.0f / (high[1] - low[1]),
                       2.6f, 0.2f, 0.1f);
    s->p.gl->GenVertexArrays(1, &s->array);
    s->p.gl->BindVertexArray(s->array);
    s->p.gl->GenBuffers(1, &s->buffer);
    s->p.gl->BindBuffer(GL_ARRAY_BUFFER, s->buffer);
    for (size_t i = 0; i < TEST_COUNT(attributes); i++) {
        s->p.gl->EnableVertexAttribArray(attributes[i].at);
        s->p.gl->VertexAttribPointer(attributes[i].at, attributes[i].size, GL_FLOAT, GL_FALSE, sizeof(corner),
                                     (const void *)attributes[i].offset);
    }
    s->p.gl->Enable(GL_DEPTH_TEST);
    s->p.gl->DepthFunc(GL_LEQUAL);
    s->p.gl->DepthMask(GL_TRUE);
}

static uint8_t *area_draw(area_stage *s, int picked)
{
    pick(&s->p, picked);
    s->p.gl->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    s->p.gl->DrawArrays(GL_TRIANGLES, 0, (GLsizei)s->count);
    return fixture_frame_read(&s->frame);
}

static void area_compare(area_stage *s)
{
    uint8_t *ids, *ratios;
    s->p.gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(s->count * sizeof(corner)), s->corners, GL_DYNAMIC_DRAW);
    ids = area_draw(s, 0);
    ratios = area_draw(s, 1);
    for (size_t i = 0; i < (size_t)AREA_SIDE * AREA_SIDE; i++) {
        const uint32_t id = (uint32_t)float_at(ids, i);
        const corner *t = s->corners + 3u * (size_t)(id ? id - 1u : 0u);
        const double rest = id ? area_of(t, 0) : 0.0;
        if (rest < 1e-12) continue; /* a millionth of a square millimetre: such triangles have what they have at rest */
        const double right = area_of(t, 1) / rest;
        s->worst = fmax(s->worst, fabs((double)float_at(ratios, i) - right) / fmax(1.0, right));
        s->pixels++;
    }
    free(ids);
    free(ratios);
}

static void area_close(area_stage *s)
{
    s->p.gl->Disable(GL_DEPTH_TEST);
    s->p.gl->BindVertexArray(0);
    s->p.gl->DeleteVertexArrays(1, &s->array);
    s->p.gl->DeleteBuffers(1, &s->buffer);
    free(s->corners);
    program_close(&s->p);
    fixture_frame_close(&s->frame);
}

static void check_areas(const char *path)
{
    model *m;
    model_error error;
    uint32_t targets = 0;
    if (model_read_gltf(path, &m, &error)) fail_msg("%s: %s", path, error.what);
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const model_mesh *mesh = &m->meshes[i];
        area_stage s;
        if (!mesh->target_count) continue;
        area_open(&s, mesh);
        for (uint32_t t = 0; t < mesh->target_count; t++) {
            fill_corners(&s, mesh, t);
            area_compare(&s);
        }
        print_message("%s, mesh '%s': %u targets, %llu pixels: area ratios off the triangles' by at most %.3g\n", path,
                      mesh->name, mesh->target_count, (unsigned long long)s.pixels, s.worst);
        assert_true(s.pixels > 1000u * mesh->target_count);
        assert_true(s.worst <= AREA_BOUND);
        targets += mesh->target_count;
        area_close(&s);
    }
    assert_true(targets > 0);
    model_free(m);
}

static void areas_by_derivatives_are_exact(void **state)
{
    char path[1024];
    (void)state;
    snprintf(path, sizeof path, "%s/mask.glb", getenv("NOH_BUILD") ? getenv("NOH_BUILD") : "build");
    check_areas(path);
}

static void areas_of_a_human_head(void **state)
{
    (void)state;
    check_areas(test_asset("hero/head.glb"));
}

/* ---- a crowd ---- */

#define ACTORS 4u
#define CROWD_SIDE 256u

typedef struct crowd {
    noh_file file;
    noh_pack pack;
    noh_kind_desc kind;
    noh_stage_desc desc;
    noh_stage_plan plan;
    noh_stage *stage;
    void *memory;
    noh_stage_view view;
    noh_actor actors[ACTORS];
} crowd;

static const char *const frowns[ACTORS][2] = { { "browDownLeft", "browDownRight" },
                                               { "mouthSmileLeft", "mouthSmileRight" },
                                               { "browInnerUp", "jawOpen" },
                                               { "noseSneerLeft", "noseSneerRight" } };

static noh_place place_of(uint32_t i)
{
    const noh_place place = { .position = { 0.3f * ((float)(i % 2) - 0.5f), 0.3f * ((float)(i / 2) - 0.5f), 0.0f } };
    return place;
}

static void crowd_open(crowd *c, uint32_t actors, const char *name)
{
    static const float middle[3] = { 0.0f, 0.0f, 0.0f };
    static char log[4096];
    gpu *g = fixture_gpu();
    char path[1024];
    const noh_gl_device device = { &g->gl, &g->caps, &g->ledger, log, sizeof log };
    memset(c, 0, sizeof *c);
    snprintf(path, sizeof path, "%s/%s", getenv("NOH_BUILD") ? getenv("NOH_BUILD") : "build", name);
    if (noh_file_map(path, &c->file, &said)) fail_msg("%s: %s", path, said.what);
    c->pack = test_open(c->file.data, c->file.bytes);
    c->kind.mesh = &c->pack;
    c->kind.actor_count = actors;
    c->kind.held_float_count = 2;
    c->desc.kinds = &c->kind;
    c->desc.kind_count = 1;
    c->desc.full_detail = 1;
    c->desc.gpu = &noh_stage_on_gl;
    if (noh_stage_plan_make(&c->desc, &g->caps, &c->plan, &said)) fail_msg("plan: %s", said.what);
    c->memory = test_aligned(NULL, (size_t)c->plan.cpu_bytes);
    if (noh_stage_init(c->memory, (size_t)c->plan.cpu_bytes, &device, &c->desc, &c->plan, &c->stage, &said))
        fail_msg("stage: %s", said.what);
    noh_view_orbit(&c->view, middle, 0.0f, 0.0f, 0.75f, CROWD_SIDE, CROWD_SIDE);
}

static void spawn(crowd *c, uint32_t i, uint32_t face)
{
    const noh_place place = place_of(i);
    assert_int_equal(noh_stage_spawn(c->stage, 0, &place, &c->actors[i], &said), NOH_OK);
    for (int k = 0; k < 2; k++) {
        const uint32_t index = noh_stage_find(c->stage, 0, NOH_NAME_FLOAT, frowns[face][k]);
        assert_true(index != NOH_NONE);
        assert_int_equal(noh_actor_hold_float(c->stage, c->actors[i], index, 1.0f, 1.0f, &said), NOH_OK);
    }
}

static uint32_t *crowd_draw(crowd *c)
{
    fixture_frame frame;
    uint8_t *rgba;
    assert_int_equal(noh_stage_frame(c->stage, 0, &c->view, NULL, NULL, &said), NOH_OK);
    fixture_frame_open(&frame, CROWD_SIDE);
    assert_int_equal(noh_stage_draw(c->stage, NOH_PASS_COLOR, 0, NULL, &said), NOH_OK);
    rgba = fixture_frame_read(&frame);
    fixture_frame_close(&frame);
    return (uint32_t *)(void *)rgba;
}

static void crowd_close(crowd *c)
{
    noh_stage_delete(c->stage);
    free(c->memory);
    noh_file_unmap(&c->file);
    fixture_expect_no_errors();
}

/* Pixels that differ by more than 2 of 255 in the quarter of an actor. */
static uint32_t differing(const uint32_t *a, const uint32_t *b, uint32_t actor)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < CROWD_SIDE * CROWD_SIDE; i++) {
        int most = 0;
        if ((i % CROWD_SIDE >= CROWD_SIDE / 2) != actor % 2 || (i / CROWD_SIDE >= CROWD_SIDE / 2) != actor / 2)
            continue;
        for (int k = 0; k < 4; k++) {
            const int d = (int)(a[i] >> 8 * k & 255u) - (int)(b[i] >> 8 * k & 255u);
            most = d > most ? d : -d > most ? -d : most;
        }
        count += most > 2;
    }
    return count;
}

/* An actor in a crowd looks as it does on a stage of its own, on which its mesh is drawn alone; so does the inside of an
 * open mouth between shut ones. */
static void each_actor_of_a_crowd_has_its_own_wrinkles(void **state)
{
    crowd many, one;
    uint32_t *together, *smooth;
    (void)state;
    crowd_open(&many, ACTORS, "mask.noh");
    for (uint32_t i = 0; i < ACTORS; i++) spawn(&many, i, i);
    together = crowd_draw(&many);
    for (uint32_t i = 0; i < ACTORS; i++) {
        const noh_appearance look = { .wrinkle_models = NOH_WRINKLE_BY_AREA };
        assert_int_equal(noh_actor_set_appearance(many.stage, many.actors[i], &look, NULL), NOH_OK);
    }
    smooth = crowd_draw(&many); /* what a crowd without regions would show */
    crowd_open(&one, 1, "mask.noh");
    for (uint32_t i = 0; i < ACTORS; i++) {
        uint32_t *alone;
        spawn(&one, i, i);
        alone = crowd_draw(&one);
        print_message("%s: %u pixels differ from the actor alone, %u without regions\n", frowns[i][0],
                      differing(together, alone, i), differing(smooth, alone, i));
        assert_true(differing(together, alone, i) <= 4);
        assert_true(differing(smooth, alone, i) > 100);
        assert_int_equal(noh_stage_despawn(one.stage, one.actors[i], NULL), NOH_OK);
        free(alone);
    }
    free(together);
    free(smooth);
    crowd_close(&one);
    crowd_close(&many);
}

static void blush(crowd *c, uint32_t i, const char *target)
{
    const noh_place place = place_of(i);
    assert_int_equal(noh_stage_spawn(c->stage, 0, &place, &c->actors[i], &said), NOH_OK);
    const uint32_t index = noh_stage_find(c->stage, 0, NOH_NAME_FLOAT, target);
    assert_true(index != NOH_NONE);
    assert_int_equal(noh_actor_hold_float(c->stage, c->actors[i], index, 1.0f, 1.0f, &said), NOH_OK);
}

/* An actor in a crowd has the colours that it has alone, and the mask without colours differs from it where it blushes.
 * With a target that colours nothing it is the mask without colours. */
static void each_actor_of_a_crowd_has_its_own_colors(void **state)
{
    static const char *const targets[ACTORS] = { "smile", "surprise", "anger", "browInnerUp" };
    static const int is_colored[ACTORS] = { 1, 1, 1, 0 };
    crowd many, one, plain;
    (void)state;
    crowd_open(&many, ACTORS, "demo/flush.noh");
    crowd_open(&plain, ACTORS, "mask.noh");
    crowd_open(&one, 1, "demo/flush.noh");
    for (uint32_t i = 0; i < ACTORS; i++) {
        blush(&many, i, targets[i]);
        blush(&plain, i, targets[i]);
    }
    uint32_t *together = crowd_draw(&many), *without = crowd_draw(&plain);
    for (uint32_t i = 0; i < ACTORS; i++) {
        blush(&one, i, targets[i]);
        uint32_t *alone = crowd_draw(&one);
        const uint32_t colored = differing(together, without, i);
        print_message("%s: %u pixels differ from the actor alone, %u from one without colours\n", targets[i],
                      differing(together, alone, i), colored);
        assert_true(differing(together, alone, i) <= 4);
        assert_true(is_colored[i] ? colored > 100 : colored == 0);
        assert_int_equal(noh_stage_despawn(one.stage, one.actors[i], NULL), NOH_OK);
        free(alone);
    }
    free(together);
    free(without);
    crowd_close(&one);
    crowd_close(&plain);
    crowd_close(&many);
}

/* Smoothed out, an actor looks as the same mesh does whose wrinkles no model shows; half smoothed, it lies between. */
static void looks_smooth_wrinkles_out(void **state)
{
    static const uint8_t smoothed[3] = { 0, 128, 255 };
    uint32_t *pictures[3];
    crowd c;
    (void)state;
    crowd_open(&c, 1, "mask.noh");
    spawn(&c, 0, 0);
    for (int i = 0; i < 3; i++) {
        const noh_appearance look = { .smoothed = smoothed[i] };
        assert_int_equal(noh_actor_set_appearance(c.stage, c.actors[0], &look, NULL), NOH_OK);
        pictures[i] = crowd_draw(&c);
    }
    assert_true(differing(pictures[0], pictures[2], 0) > differing(pictures[1], pictures[2], 0));
    assert_true(differing(pictures[1], pictures[2], 0) > 50);
    const noh_appearance unknown = { .wrinkle_models = 8 };
    assert_int_equal(noh_actor_set_appearance(c.stage, c.actors[0], &unknown, &said), NOH_ERR_ARG);
    for (int i = 0; i < 3; i++) free(pictures[i]);
    crowd_close(&c);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(normals_are_those_of_the_cpu),
    cmocka_unit_test(channels_add_up_to_one),
    cmocka_unit_test(pixels_read_masks_as_the_source_does),
    cmocka_unit_test(each_region_has_its_own_weight),
    cmocka_unit_test(colors_are_those_of_the_cpu),
    cmocka_unit_test(what_has_no_wrinkles_is_drawn),
    cmocka_unit_test(texels_become_normals_before_they_mix),
    cmocka_unit_test(areas_by_derivatives_are_exact),
    cmocka_unit_test(areas_of_a_human_head),
    cmocka_unit_test(each_actor_of_a_crowd_has_its_own_wrinkles),
    cmocka_unit_test(each_actor_of_a_crowd_has_its_own_colors),
    cmocka_unit_test(looks_smooth_wrinkles_out),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
