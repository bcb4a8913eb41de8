/* The pass that draws depth alone: its depth equals the colour pass's in every bit, however the mesh is drawn; it
 * writes no colour, and its programs fetch nothing but positions, and what alpha needs where a material cuts. Run on
 * every driver by matrix.sh. */
#include "support/tube_fixture.h"

#include "support/level_fixture.h"
#include "support/skin_asset.h"
#include "support/renderer.h"
#include "gl/draw/gl_variants_internal.h"
#include "gl/device/gl_memory_internal.h"

#include <stdlib.h>
#include <string.h>

#define SIDE 160u

/* ---- a frame whose depth can be read ---- */

typedef struct depth_frame {
    noh_gl_ledger ledger;
    noh_gl_texture depth;
    noh_gl_renderbuffer color;
    GLuint framebuffer;
} depth_frame;

static void frame_open(depth_frame *f)
{
    const noh_gl_api *gl = &fixture_gpu()->gl;
    const float clear[4] = { 0.25f, 0.5f, 0.75f, 1.0f }, far = 1.0f;
    memset(f, 0, sizeof *f);
    gl->GenTextures(1, &f->depth.name);
    gl->BindTexture(GL_TEXTURE_2D, f->depth.name);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_DEPTH_COMPONENT32F, SIDE, SIDE);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    assert_int_equal(noh_gl_renderbuffer_create(gl, &f->ledger, GL_RGBA8, SIDE, SIDE, 0, &f->color, NULL), NOH_OK);
    assert_int_equal(noh_gl_framebuffer_create(gl, &f->ledger, &f->framebuffer, NULL), NOH_OK);
    gl->BindFramebuffer(GL_FRAMEBUFFER, f->framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, f->depth.name, 0);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, f->color.name);
    assert_int_equal(gl->CheckFramebufferStatus(GL_FRAMEBUFFER), GL_FRAMEBUFFER_COMPLETE);
    gl->Viewport(0, 0, SIDE, SIDE);
    gl->ClearBufferfv(GL_COLOR, 0, clear);
    gl->ClearBufferfv(GL_DEPTH, 0, &far);
}

static void frame_close(depth_frame *f)
{
    const noh_gl_api *gl = &fixture_gpu()->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    noh_gl_framebuffer_delete(gl, &f->ledger, &f->framebuffer);
    noh_gl_renderbuffer_delete(gl, &f->ledger, &f->color);
    gl->DeleteTextures(1, &f->depth.name);
    assert_true(noh_gl_ledger_bytes(&f->ledger) == 0 && f->ledger.programs == 0);
    fixture_expect_no_errors();
}

static GLuint bits_program(void)
{
    static const char vertex[] =
        "#version 300 es\nvoid main() {\n"
        "gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);\n}\n";
    static const char fragment[] = "#version 300 es\nprecision highp float;\nuniform highp sampler2D u_depth;\n"
                                   "layout(location = 0) out highp uvec4 o;\nvoid main() {\n"
                                   "o = uvec4(floatBitsToUint(texelFetch(u_depth, ivec2(gl_FragCoord.xy), 0).x));\n}\n";
    const char *const texts[2] = { vertex, fragment };
    const noh_gl_api *gl = &fixture_gpu()->gl;
    GLuint program = gl->CreateProgram();
    GLint linked = 0;
    for (int i = 0; i < 2; i++) {
        GLuint shader = gl->CreateShader(i ? GL_FRAGMENT_SHADER : GL_VERTEX_SHADER);
        gl->ShaderSource(shader, 1, &texts[i], NULL);
        gl->CompileShader(shader);
        gl->AttachShader(program, shader);
        gl->DeleteShader(shader);
    }
    gl->LinkProgram(program);
    gl->GetProgramiv(program, GL_LINK_STATUS, &linked);
    assert_true(linked);
    return program;
}

/* The bits of every depth: out[SIDE * SIDE], to be freed. */
static uint32_t *frame_bits(const depth_frame *f)
{
    const noh_gl_api *gl = &fixture_gpu()->gl;
    uint32_t *pixels = test_zeros(SIDE * SIDE * 16u), *bits = test_zeros(SIDE * SIDE * 4u);
    GLuint target = 0, array = 0, framebuffer = 0, program = bits_program();
    gl->GenRenderbuffers(1, &target);
    gl->BindRenderbuffer(GL_RENDERBUFFER, target);
    gl->RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32UI, SIDE, SIDE);
    gl->GenFramebuffers(1, &framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target);
    gl->GenVertexArrays(1, &array);
    gl->BindVertexArray(array);
    gl->UseProgram(program);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, f->depth.name);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
    gl->ReadPixels(0, 0, SIDE, SIDE, GL_RGBA_INTEGER, GL_UNSIGNED_INT, pixels);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    gl->UseProgram(0);
    gl->BindVertexArray(0);
    gl->DeleteVertexArrays(1, &array);
    gl->DeleteProgram(program);
    gl->BindFramebuffer(GL_FRAMEBUFFER, f->framebuffer);
    gl->DeleteFramebuffers(1, &framebuffer);
    gl->DeleteRenderbuffers(1, &target);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        bits[i] = pixels[4u * i];
    }
    free(pixels);
    return bits;
}

static void expect_untouched_color(void)
{
    static const uint8_t clear[4] = { 64, 128, 191, 255 };
    uint8_t *rgba = test_zeros(SIDE * SIDE * 4u);
    fixture_gpu()->gl.ReadPixels(0, 0, SIDE, SIDE, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    for (uint32_t i = 0; i < SIDE * SIDE * 4u; i++) {
        assert_in_range(rgba[i] + 1, clear[i % 4u], clear[i % 4u] + 2u); /* 127.5 may round either way */
    }
    free(rgba);
}

static uint32_t covered(const uint32_t *bits)
{
    const float far = 1.0f;
    uint32_t count = 0, none;
    memcpy(&none, &far, 4);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        count += bits[i] != none;
    }
    return count;
}

/* ---- a tube ---- */

typedef struct tube_kind {
    uint32_t palette, dual, uniform; /* joints per palette, 0 all; the rest 0 or 1 */
    uint32_t is_uint;                /* as in noh_gl_morph_binding: 0, 1 or NOH_LAYERS_DIRECT */
} tube_kind;

static noh_gl_renderer renderer_of(const tube *t, const tube_kind *k, noh_gl_passes passes, noh_gl_ledger *ledger)
{
    noh_gl_renderer_desc desc;
    noh_gl_renderer r;
    char log[4096] = "";
    memset(&desc, 0, sizeof desc);
    desc.meshes = &t->mesh;
    desc.mesh_count = 1;
    desc.palettes = k->uniform ? NOH_PALETTE_UNIFORM : NOH_PALETTE_TEXTURE;
    desc.crowds = !k->uniform;
    desc.layers_uint = (int)k->is_uint;
    desc.fewer_influences = desc.fades = 1;
    desc.passes = passes;
    assert_int_equal(
        renderer_create(&(noh_gl_device){ &fixture_gpu()->gl, NULL, ledger, log, sizeof log }, &desc, &r, NULL),
        NOH_OK);
    return r;
}

/* The depth that a pass leaves, to be freed. */
static uint32_t *depth_by(const tube *t, noh_gl_renderer *r, draw_kind kind, const noh_gl_lod *lods, uint32_t count,
                          int pass)
{
    depth_frame f;
    uint32_t *bits;
    frame_open(&f);
    noh_gl_draw_begin(r, &tube_camera);
    for (uint32_t i = 0; i < count; i++) {
        tube_draw(r, t, &t->gl, kind, &lods[i], pass);
    }
    noh_gl_draw_end(r);
    if (pass == NOH_DRAW_DEPTH) expect_untouched_color();
    bits = frame_bits(&f);
    frame_close(&f);
    return bits;
}

/* By a renderer of colours and one of depth. */
static void expect_same(const tube *t, noh_gl_renderer *r, draw_kind kind, const noh_gl_lod *lods, uint32_t count)
{
    uint32_t *color = depth_by(t, &r[0], kind, lods, count, NOH_DRAW_OPAQUE);
    uint32_t *depth = depth_by(t, &r[1], kind, lods, count, NOH_DRAW_DEPTH);
    assert_true(covered(color) > SIDE * SIDE / 20u);
    assert_memory_equal(depth, color, SIDE * SIDE * 4u);
    free(color);
    free(depth);
}

static void check(const tube_kind *k)
{
    static const char *const every_mesh[] = { "all" };
    const skin_cylinder c = { 24, 33, 9, 4, 3, 1, 2.0f, 0.35f };
    const noh_gl_lod fades[2] = { { 1, 0.0f, 0.4f }, { 0, 0.4f, 1.0f } }, wholes[2] = { { 0, 0, 1 }, { 1, 0, 1 } };
    noh_gl_caps caps = fixture_gpu()->caps;
    noh_gl_ledger ledger = { 0 };
    noh_gl_renderer r[2]; /* for all draws: ANGLE compiles a renderer's programs in a quarter of a second */
    skin_options options;
    fixture_levels levels;
    noh_pack pack;
    noh_mesh mesh;
    uint8_t *bytes;
    size_t count;
    model *m = skin_cylinder_model(&c);
    tube t;
    memset(&options, 0, sizeof options);
    options.palette = k->palette;
    options.dual_quaternion = every_mesh;
    options.dual_quaternion_count = k->dual;
    bytes = skin_pack_of(m, &options, 1.0f, &count, NULL);
    model_free(m);
    pack = test_open(bytes, count);
    fixture_levels_open(&levels, &pack, 2, 0.12f);
    mesh = test_mesh(&levels.pack, 0);
    assert_int_equal((mesh.header->flags & NOH_MESH_DUAL_QUATERNION) != 0, k->dual);
    if (k->is_uint == 1u) caps.render_f32 = caps.blend_f32 = 0;
    tube_open_with(&t, &mesh, k->uniform ? NOH_PALETTE_UNIFORM : NOH_PALETTE_TEXTURE,
                   k->is_uint == 1u                  ? NOH_MORPH_GATHER
                   : k->is_uint == NOH_LAYERS_DIRECT ? NOH_MORPH_DIRECT
                                                     : NOH_MORPH_CPU,
                   0, &caps);
    r[0] = renderer_of(&t, k, NOH_PASSES_COLOR, &ledger);
    r[1] = renderer_of(&t, k, NOH_PASSES_DEPTH, &ledger);
    for (int kind = RIGID; kind <= (k->uniform ? FEWER : CROWD); kind++) {
        for (uint32_t level = 0; level < 2; level++) {
            expect_same(&t, r, (draw_kind)kind, &wholes[level], 1);
        }
        expect_same(&t, r, (draw_kind)kind, fades, 2);
    }
    for (int i = 0; i < 2; i++) noh_gl_renderer_delete(&r[i]);
    assert_int_equal(ledger.programs, 0);
    tube_close(&t);
    fixture_levels_close(&levels);
    free(bytes);
}

static void depth_is_that_of_the_color_pass(void **state)
{
    const tube_kind k = { 0, 0, 0, 0 };
    (void)state;
    fixture_gpu();
    check(&k);
}

static void so_with_palettes_in_a_block(void **state)
{
    const tube_kind k = { 0, 0, 1, 0 };
    (void)state;
    fixture_gpu();
    check(&k);
}

static void so_with_dual_quaternions_and_small_palettes(void **state)
{
    const tube_kind k = { 6, 1, 0, 0 };
    (void)state;
    fixture_gpu();
    check(&k);
}

static void so_with_integer_layers(void **state)
{
    const tube_kind k = { 0, 0, 0, 1 };
    (void)state;
    if (!fixture_gpu()->caps.render_u32) test_skip("no renderable RGBA32UI here");
    check(&k);
}

static void so_where_draws_sum(void **state)
{
    static const tube_kind kinds[] = { { 0, 0, 0, NOH_LAYERS_DIRECT }, { 6, 1, 1, NOH_LAYERS_DIRECT } };
    (void)state;
    fixture_gpu();
    for (size_t i = 0; i < TEST_COUNT(kinds); i++) check(&kinds[i]);
}

/* ---- what is fetched ---- */

/* Which of a program's attributes 0 to 4 are active, as bits. */
static uint32_t attributes_of(const noh_gl_variant *v)
{
    static const char *const names[] = { "noh_a_position", "noh_a_normal", "noh_a_tangent", "noh_a_uv", "noh_a_color" };
    uint32_t bits = 0;
    for (uint32_t i = 0; i < TEST_COUNT(names); i++) {
        const GLint at = fixture_gpu()->gl.GetAttribLocation(v->program, names[i]);
        assert_true(at == -1 || at == (GLint)i);
        bits |= (at >= 0 ? 1u : 0u) << i;
    }
    return bits;
}

static void depth_fetches_positions_alone(void **state)
{
    gpu *g = fixture_gpu();
    noh_gl_ledger ledger = { 0 };
    (void)state;
    for (uint8_t i = 0; i < 16; i++) {
        noh_gl_variant_key key = { 0 };
        noh_gl_variant v;
        char log[2048] = "";
        key.influences = key.drawn = i & 1 ? 4 : 0;
        key.crowd = key.texture = i >> 1 & 1;
        key.fade = i >> 2 & 1;
        key.view = i & 1 ? NOH_VIEW_TANGENT : NOH_VIEW_LIT;
        key = noh_gl_variant_key_depth(key, i >> 3 & 1);
        assert_int_equal(noh_gl_variant_create(&(noh_gl_device){ &g->gl, NULL, &ledger, log, sizeof log }, key, NULL,
                                               NULL, 0, &v, NULL),
                         NOH_OK);
        assert_int_equal(attributes_of(&v), key.cut ? 1 | 8 | 16 : 1);
        assert_int_equal(v.u_normal, -1);
        assert_int_equal(v.u_base_color >= 0, key.cut);
        assert_int_equal(v.u_lod >= 0, key.fade);
        noh_gl_variant_delete(&g->gl, &ledger, &v);
    }
    assert_int_equal(ledger.programs, 0);
    fixture_expect_no_errors();
}

static void only_renderers_with_a_depth_pass_compile_for_it(void **state)
{
    const tube_kind k = { 0, 0, 0, 0 };
    const test_model_desc grid = { 1, 9, 1, 0, 1 };
    noh_gl_ledger ledger = { 0 };
    noh_gl_renderer r[3];
    noh_pack pack;
    size_t count;
    uint8_t *bytes;
    tube t;
    (void)state;
    fixture_gpu();
    bytes = test_pack(&grid, &count);
    pack = test_open(bytes, count);
    t.mesh = test_mesh(&pack, 0);
    for (int i = 0; i < 3; i++) {
        r[i] = renderer_of(&t, &k, (noh_gl_passes)i, &ledger);
    }
    assert_int_equal(r[NOH_PASSES_ALL].variant_count, 2u * r[NOH_PASSES_COLOR].variant_count);
    assert_int_equal(r[NOH_PASSES_DEPTH].variant_count, r[NOH_PASSES_COLOR].variant_count);
    for (uint32_t i = 0; i < r[NOH_PASSES_DEPTH].variant_count; i++) {
        assert_int_equal(r[NOH_PASSES_DEPTH].variants[i].key.depth, 1);
        assert_int_equal(r[NOH_PASSES_COLOR].variants[i].key.depth, 0);
    }
    for (int i = 0; i < 3; i++) {
        noh_gl_renderer_delete(&r[i]);
    }
    assert_int_equal(ledger.programs, 0);
    free(bytes);
}

/* ---- materials ---- */

/* A grid of one material, half of whose vertices have an alpha below its cutoff. */
static uint8_t *grid_with(model_alpha alpha, size_t *count)
{
    const test_model_desc desc = { 1, 9, 0, 0, 1 };
    model *m = test_model(&desc);
    model_mesh *mesh = &m->meshes[0];
    uint8_t *bytes;
    m->materials = test_zeros(sizeof *m->materials);
    m->material_count = 1;
    m->materials[0] = model_material_default();
    m->materials[0].name = model_string("grid");
    m->materials[0].base_color_texture = MODEL_NONE;
    for (int i = 0; i < 4; i++) m->materials[0].base_color[i] = 1.0f;
    m->materials[0].alpha = alpha;
    m->materials[0].alpha_cutoff = 0.5f;
    m->materials[0].double_sided = 1;
    mesh->submeshes[0].material = 0;
    mesh->color = test_zeros(16u * (size_t)mesh->vertex_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        for (uint32_t c = 0; c < 4; c++) mesh->color[4 * v + c] = c < 3 || v % 2 ? 1.0f : 0.0f;
    }
    bytes = test_pack_of(m, count, NULL);
    model_free(m);
    return bytes;
}

static uint32_t *grid_depth(noh_gl_renderer *r, const noh_gl_mesh *gl, const noh_gl_texture *pictures,
                            const uint8_t tint[4], int pass)
{
    static const float world[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
    depth_frame f;
    uint32_t *bits;
    noh_gl_camera camera = { { 0 }, { 0 }, { 0, 0, 1 } };
    const noh_mesh_header *h = gl->mesh.header;
    for (int i = 0; i < 3; i++) { /* the box of the grid fills the frame */
        const float size = h->bounds_max[i] - h->bounds_min[i];
        camera.view_projection[5 * i] = size > 0.0f ? 1.8f / size : 1.0f;
        camera.view_projection[12 + i] = -0.5f * camera.view_projection[5 * i] * (h->bounds_max[i] + h->bounds_min[i]);
    }
    camera.view_projection[15] = 1.0f;
    frame_open(&f);
    noh_gl_draw_begin(r, &camera);
    noh_gl_draw_instance(r, tint, NULL, NULL);
    noh_gl_draw_mesh(r, gl, world, NULL, NULL, NULL, pictures, pass);
    noh_gl_draw_end(r);
    if (pass == NOH_DRAW_DEPTH) expect_untouched_color();
    bits = frame_bits(&f);
    frame_close(&f);
    return bits;
}

static void materials_are_cut_and_blended_ones_left_out(void **state)
{
    gpu *g = fixture_gpu();
    uint32_t drawn[3];
    (void)state;
    for (int alpha = MODEL_ALPHA_OPAQUE; alpha <= MODEL_ALPHA_BLEND; alpha++) {
        noh_gl_renderer_desc desc;
        noh_gl_renderer r;
        noh_gl_ledger ledger = { 0 };
        noh_gl_mesh gl;
        size_t count;
        uint8_t *bytes = grid_with((model_alpha)alpha, &count);
        noh_pack pack = test_open(bytes, count);
        noh_mesh mesh = test_mesh(&pack, 0);
        uint32_t *color, *depth;
        memset(&desc, 0, sizeof desc);
        desc.meshes = &mesh;
        desc.mesh_count = 1;
        desc.passes = NOH_PASSES_ALL;
        assert_int_equal(noh_gl_mesh_create(&g->gl, &ledger, &mesh, &gl, NULL), NOH_OK);
        assert_int_equal(renderer_create(&(noh_gl_device){ &g->gl, NULL, &ledger, NULL, 0 }, &desc, &r, NULL), NOH_OK);
        assert_int_equal(r.variant_count, alpha == MODEL_ALPHA_MASK ? 3 : 2);
        color = grid_depth(&r, &gl, NULL, NULL, NOH_DRAW_OPAQUE);
        depth = grid_depth(&r, &gl, NULL, NULL, NOH_DRAW_DEPTH);
        assert_memory_equal(depth, color, SIDE * SIDE * 4u);
        drawn[alpha] = covered(depth);
        noh_gl_renderer_delete(&r);
        noh_gl_mesh_delete(&g->gl, &ledger, &gl);
        free(color);
        free(depth);
        free(bytes);
    }
    assert_true(drawn[MODEL_ALPHA_OPAQUE] > SIDE * SIDE / 2u);
    assert_in_range(drawn[MODEL_ALPHA_MASK], drawn[MODEL_ALPHA_OPAQUE] / 4u, 3u * drawn[MODEL_ALPHA_OPAQUE] / 4u);
    assert_int_equal(drawn[MODEL_ALPHA_BLEND], 0);
}

/* A textured quad that blends, opaque everywhere: all of it is its core. */
static uint8_t *hair_quad(size_t *count)
{
    const test_model_desc desc = { 1, 2, 0, TEST_UVS, 1 };
    model *m = test_model(&desc);
    uint8_t *bytes;
    m->materials = test_zeros(sizeof *m->materials);
    m->material_count = 1;
    m->materials[0] = model_material_default();
    m->materials[0].name = model_string("hair");
    m->materials[0].base_color_texture = 0;
    m->materials[0].alpha = MODEL_ALPHA_BLEND;
    m->materials[0].double_sided = 1;
    m->textures = test_zeros(sizeof *m->textures);
    m->texture_count = 1;
    m->textures[0].name = model_string("strands");
    m->textures[0].width = m->textures[0].height = 1;
    m->textures[0].rgba = test_zeros(4);
    memset(m->textures[0].rgba, 255, 4);
    m->meshes[0].submeshes[0].material = 0;
    bytes = test_pack_of(m, count, NULL);
    model_free(m);
    return bytes;
}

/* Hair that a tint thins has no core, and then it leaves no depth either. */
static void alpha_of_a_tint_counts_in_depth(void **state)
{
    static const uint8_t tints[2][4] = { { 10, 20, 30, 255 }, { 255, 255, 255, 128 } };
    gpu *g = fixture_gpu();
    noh_gl_renderer_desc desc;
    noh_gl_renderer r;
    noh_gl_ledger ledger = { 0 };
    noh_gl_mesh gl;
    noh_gl_texture picture;
    noh_texture strands;
    size_t count;
    uint8_t *bytes = hair_quad(&count);
    noh_pack pack = test_open(bytes, count);
    noh_mesh mesh = test_mesh(&pack, 0);
    (void)state;
    memset(&desc, 0, sizeof desc);
    desc.meshes = &mesh;
    desc.mesh_count = 1;
    desc.passes = NOH_PASSES_ALL;
    assert_int_equal(noh_pack_texture_at(&pack, 0, &strands, NULL), NOH_OK);
    assert_int_equal(noh_gl_picture_create(&g->gl, &ledger, &strands, &picture, NULL), NOH_OK);
    assert_int_equal(noh_gl_mesh_create(&g->gl, &ledger, &mesh, &gl, NULL), NOH_OK);
    assert_int_equal(renderer_create(&(noh_gl_device){ &g->gl, NULL, &ledger, NULL, 0 }, &desc, &r, NULL), NOH_OK);
    for (int i = 0; i < 2; i++) {
        uint32_t *color = grid_depth(&r, &gl, &picture, tints[i], NOH_DRAW_OPAQUE);
        uint32_t *depth = grid_depth(&r, &gl, &picture, tints[i], NOH_DRAW_DEPTH);
        assert_memory_equal(depth, color, SIDE * SIDE * 4u);
        assert_true(i ? covered(depth) == 0 : covered(depth) > SIDE * SIDE / 2u);
        free(color);
        free(depth);
    }
    noh_gl_renderer_delete(&r);
    noh_gl_mesh_delete(&g->gl, &ledger, &gl);
    noh_gl_texture_delete(&g->gl, &ledger, &picture);
    free(bytes);
}

static void unknown_passes_are_refused(void **state)
{
    gpu *g = fixture_gpu();
    noh_gl_ledger ledger = { 0 };
    noh_gl_renderer_desc desc;
    noh_gl_renderer r;
    noh_error error;
    (void)state;
    memset(&desc, 0, sizeof desc);
    desc.passes = (noh_gl_passes)3;
    assert_int_equal(renderer_create(&(noh_gl_device){ &g->gl, NULL, &ledger, NULL, 0 }, &desc, &r, &error),
                     NOH_ERR_ARG);
    assert_int_equal(error.where, 3);
    assert_int_equal(ledger.programs, 0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(depth_is_that_of_the_color_pass),
    cmocka_unit_test(so_with_palettes_in_a_block),
    cmocka_unit_test(so_with_dual_quaternions_and_small_palettes),
    cmocka_unit_test(so_with_integer_layers),
    cmocka_unit_test(so_where_draws_sum),
    cmocka_unit_test(depth_fetches_positions_alone),
    cmocka_unit_test(only_renderers_with_a_depth_pass_compile_for_it),
    cmocka_unit_test(materials_are_cut_and_blended_ones_left_out),
    cmocka_unit_test(alpha_of_a_tint_counts_in_depth),
    cmocka_unit_test(unknown_passes_are_refused),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
