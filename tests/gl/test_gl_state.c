/* GL's state around noh's calls (gl_device.h): whatever a game has set does not matter where it must not, is used where
 * it is the game's, and is there again afterwards. */
#include "support/stage_fixture.h"
#include "support/gl_fixture.h"

#include "gpu/canvas.h"

#define WIDTH 320u
#define HEIGHT 180u
#define PIXELS (WIDTH * HEIGHT)
#define SHADOW_PX 128u
#define UNITS 16u

/* Beyond OpenGL ES's headers. */
#define CLIP_ORIGIN 0x935Cu
#define CLIP_DEPTH_MODE 0x935Du
#define UPPER_LEFT 0x8CA2u
#define LOWER_LEFT 0x8CA1u
#define NEGATIVE_ONE_TO_ONE 0x935Eu
#define ZERO_TO_ONE 0x935Fu

/* ---- a snapshot ---- */

typedef struct question {
    const char *name;
    GLenum what;
    int count;
} question;
#define ASK(what)      \
    {                  \
#what, what, 1 \
    }

static const question switches[] = { ASK(GL_BLEND),
                                     ASK(GL_CULL_FACE),
                                     ASK(GL_DEPTH_TEST),
                                     ASK(GL_SCISSOR_TEST),
                                     ASK(GL_STENCIL_TEST),
                                     ASK(GL_POLYGON_OFFSET_FILL),
                                     ASK(GL_RASTERIZER_DISCARD),
                                     ASK(GL_PRIMITIVE_RESTART_FIXED_INDEX),
                                     ASK(GL_DITHER),
                                     ASK(GL_SAMPLE_ALPHA_TO_COVERAGE),
                                     ASK(GL_SAMPLE_COVERAGE) };

static const question render[] = { ASK(GL_DRAW_FRAMEBUFFER_BINDING),
                                   ASK(GL_READ_FRAMEBUFFER_BINDING),
                                   ASK(GL_DEPTH_FUNC),
                                   ASK(GL_DEPTH_WRITEMASK),
                                   ASK(GL_CULL_FACE_MODE),
                                   ASK(GL_FRONT_FACE),
                                   ASK(GL_BLEND_SRC_RGB),
                                   ASK(GL_BLEND_DST_RGB),
                                   ASK(GL_BLEND_SRC_ALPHA),
                                   ASK(GL_BLEND_DST_ALPHA),
                                   ASK(GL_BLEND_EQUATION_RGB),
                                   ASK(GL_BLEND_EQUATION_ALPHA),
                                   ASK(GL_STENCIL_FUNC),
                                   ASK(GL_STENCIL_REF),
                                   ASK(GL_STENCIL_WRITEMASK),
                                   ASK(GL_UNPACK_ALIGNMENT),
                                   ASK(GL_UNPACK_ROW_LENGTH),
                                   ASK(GL_UNPACK_SKIP_ROWS),
                                   ASK(GL_UNPACK_SKIP_PIXELS),
                                   ASK(GL_UNPACK_IMAGE_HEIGHT),
                                   ASK(GL_UNPACK_SKIP_IMAGES),
                                   ASK(GL_PACK_ALIGNMENT),
                                   ASK(GL_PACK_ROW_LENGTH),
                                   ASK(GL_PACK_SKIP_ROWS),
                                   ASK(GL_PACK_SKIP_PIXELS),
                                   ASK(GL_PIXEL_UNPACK_BUFFER_BINDING),
                                   ASK(GL_PIXEL_PACK_BUFFER_BINDING),
                                   { "GL_VIEWPORT", GL_VIEWPORT, 4 },
                                   { "GL_SCISSOR_BOX", GL_SCISSOR_BOX, 4 },
                                   { "GL_COLOR_WRITEMASK", GL_COLOR_WRITEMASK, 4 } };

static const question bindings[] = {
    ASK(GL_CURRENT_PROGRAM),          ASK(GL_VERTEX_ARRAY_BINDING),      ASK(GL_ARRAY_BUFFER_BINDING),
    ASK(GL_UNIFORM_BUFFER_BINDING),   ASK(GL_RENDERBUFFER_BINDING),      ASK(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING),
    ASK(GL_COPY_READ_BUFFER_BINDING), ASK(GL_COPY_WRITE_BUFFER_BINDING), ASK(GL_ACTIVE_TEXTURE)
};
static const question of_units[] = { ASK(GL_TEXTURE_BINDING_2D), ASK(GL_TEXTURE_BINDING_2D_ARRAY),
                                     ASK(GL_TEXTURE_BINDING_CUBE_MAP), ASK(GL_SAMPLER_BINDING) };

typedef struct snapshot {
    GLint on[TEST_COUNT(switches)], render[TEST_COUNT(render)][4], bindings[TEST_COUNT(bindings)];
    GLint units[UNITS][TEST_COUNT(of_units)], uniform_buffer, clip[2];
    GLfloat depth_range[2], polygon_offset[2];
} snapshot;

static void take(const noh_gl_api *gl, snapshot *s)
{
    memset(s, 0, sizeof *s);
    for (size_t i = 0; i < TEST_COUNT(switches); i++) s->on[i] = gl->IsEnabled(switches[i].what);
    for (size_t i = 0; i < TEST_COUNT(render); i++) gl->GetIntegerv(render[i].what, s->render[i]);
    for (size_t i = 0; i < TEST_COUNT(bindings); i++) gl->GetIntegerv(bindings[i].what, &s->bindings[i]);
    for (GLuint u = 0; u < UNITS; u++) {
        gl->ActiveTexture(GL_TEXTURE0 + u);
        for (size_t i = 0; i < TEST_COUNT(of_units); i++) gl->GetIntegerv(of_units[i].what, &s->units[u][i]);
    }
    gl->ActiveTexture((GLenum)s->bindings[TEST_COUNT(bindings) - 1u]);
    gl->GetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, 0, &s->uniform_buffer);
    gl->GetFloatv(GL_DEPTH_RANGE, s->depth_range);
    gl->GetFloatv(GL_POLYGON_OFFSET_FACTOR, &s->polygon_offset[0]);
    if (!gl->ClipControl) return;
    gl->GetIntegerv(CLIP_ORIGIN, &s->clip[0]);
    gl->GetIntegerv(CLIP_DEPTH_MODE, &s->clip[1]);
}

/* Render state and pixel store are as they were. */
static void expect_render(const noh_gl_api *gl, const snapshot *was, const char *call)
{
    snapshot is;
    take(gl, &is);
    for (size_t i = 0; i < TEST_COUNT(switches); i++) {
        if (is.on[i] != was->on[i]) fail_msg("%s: %s is %d", call, switches[i].name, is.on[i]);
    }
    for (size_t i = 0; i < TEST_COUNT(render); i++) {
        for (int k = 0; k < render[i].count; k++) {
            if (is.render[i][k] == was->render[i][k]) continue;
            fail_msg("%s: %s is 0x%x, not 0x%x", call, render[i].name, (unsigned)is.render[i][k],
                     (unsigned)was->render[i][k]);
        }
    }
    assert_memory_equal(is.depth_range, was->depth_range, sizeof is.depth_range);
    assert_memory_equal(is.polygon_offset, was->polygon_offset, sizeof is.polygon_offset);
    assert_memory_equal(is.clip, was->clip, sizeof is.clip);
}

/* Bindings are empty: program to copy buffers, and of the units below NOH_UNIT_USER what noh bound. */
static void expect_no_bindings(const noh_gl_api *gl, const char *call)
{
    snapshot is;
    take(gl, &is);
    for (size_t i = 0; i + 1u < TEST_COUNT(bindings); i++) {
        if (is.bindings[i]) fail_msg("%s: %s is %d", call, bindings[i].name, is.bindings[i]);
    }
    for (GLuint u = 0; u < UNITS; u++) {
        for (size_t i = 0; i < TEST_COUNT(of_units); i++) {
            if (is.units[u][i]) fail_msg("%s: unit %u: %s is %d", call, u, of_units[i].name, is.units[u][i]);
        }
    }
    assert_int_equal(is.uniform_buffer, 0);
}

/* ---- what a game may have set ---- */

typedef struct game {
    const noh_gl_api *gl;
    GLuint sampler, buffers[4], framebuffer, texture, vertex_array;
} game;

static void game_open(game *o, const noh_gl_api *gl)
{
    o->gl = gl;
    gl->GenSamplers(1, &o->sampler);
    gl->SamplerParameteri(o->sampler, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR); /* incomplete, or wrong texels */
    gl->SamplerParameteri(o->sampler, GL_TEXTURE_WRAP_S, GL_MIRRORED_REPEAT);
    gl->SamplerParameteri(o->sampler, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    gl->GenBuffers(4, o->buffers);
    for (int i = 0; i < 4; i++) {
        gl->BindBuffer(GL_ARRAY_BUFFER, o->buffers[i]);
        gl->BufferData(GL_ARRAY_BUFFER, 1024, NULL, GL_STATIC_DRAW);
    }
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    gl->GenTextures(1, &o->texture);
    gl->BindTexture(GL_TEXTURE_2D, o->texture);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, 8, 8);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    gl->GenFramebuffers(1, &o->framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, o->framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, o->texture, 0);
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl->GenVertexArrays(1, &o->vertex_array);
}

static void set_switches(const noh_gl_api *gl, int on)
{
    static const GLenum all[] = {
        GL_BLEND,        GL_CULL_FACE,           GL_DEPTH_TEST,         GL_SCISSOR_TEST,
        GL_STENCIL_TEST, GL_POLYGON_OFFSET_FILL, GL_RASTERIZER_DISCARD, GL_PRIMITIVE_RESTART_FIXED_INDEX
    };
    for (size_t i = 0; i < TEST_COUNT(all); i++) (on ? gl->Enable : gl->Disable)(all[i]);
}

static void set_store(const noh_gl_api *gl, int foreign)
{
    static const GLenum all[] = { GL_UNPACK_ROW_LENGTH,   GL_UNPACK_SKIP_ROWS,   GL_UNPACK_SKIP_PIXELS,
                                  GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SKIP_IMAGES, GL_PACK_ROW_LENGTH,
                                  GL_PACK_SKIP_ROWS,      GL_PACK_SKIP_PIXELS };
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, foreign ? 8 : 4);
    gl->PixelStorei(GL_PACK_ALIGNMENT, foreign ? 8 : 4);
    for (size_t i = 0; i < TEST_COUNT(all); i++) gl->PixelStorei(all[i], foreign ? 7 : 0);
}

/* Everything that could spoil what noh draws into its own textures, and what it uploads. */
static void game_sets(const game *o)
{
    const noh_gl_api *gl = o->gl;
    set_switches(gl, 1);
    set_store(gl, 1);
    gl->Scissor(1, 2, 3, 4);
    gl->Viewport(3, 3, 2, 2);
    gl->DepthFunc(GL_NEVER);
    gl->DepthMask(GL_FALSE);
    gl->DepthRangef(0.75f, 0.25f);
    gl->ColorMask(GL_TRUE, GL_FALSE, GL_FALSE, GL_TRUE);
    gl->BlendFunc(GL_ZERO, GL_ONE_MINUS_DST_COLOR);
    gl->BlendEquationSeparate(GL_FUNC_REVERSE_SUBTRACT, GL_FUNC_SUBTRACT);
    gl->FrontFace(GL_CW);
    gl->PolygonOffset(-3.0f, 2.0f);
    if (gl->ClipControl) gl->ClipControl(UPPER_LEFT, ZERO_TO_ONE);
    for (GLuint u = 0; u < UNITS; u++) gl->BindSampler(u, o->sampler);
    gl->BindBuffer(GL_PIXEL_UNPACK_BUFFER, o->buffers[0]);
    gl->BindBuffer(GL_PIXEL_PACK_BUFFER, o->buffers[1]);
    gl->BindFramebuffer(GL_FRAMEBUFFER, o->framebuffer);
    gl->ActiveTexture(GL_TEXTURE0 + 5u);
}

static void game_unsets(const game *o)
{
    const noh_gl_api *gl = o->gl;
    set_switches(gl, 0);
    set_store(gl, 0);
    gl->DepthFunc(GL_LESS);
    gl->DepthMask(GL_TRUE);
    gl->DepthRangef(0.0f, 1.0f);
    gl->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl->BlendFunc(GL_ONE, GL_ZERO);
    gl->BlendEquation(GL_FUNC_ADD);
    gl->FrontFace(GL_CCW);
    gl->CullFace(GL_BACK);
    gl->PolygonOffset(0.0f, 0.0f);
    if (gl->ClipControl) gl->ClipControl(LOWER_LEFT, NEGATIVE_ONE_TO_ONE);
    for (GLuint u = 0; u < UNITS; u++) gl->BindSampler(u, 0);
    gl->BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    gl->BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl->ActiveTexture(GL_TEXTURE0);
}

static void game_close(game *o)
{
    game_unsets(o);
    o->gl->DeleteSamplers(1, &o->sampler);
    o->gl->DeleteBuffers(4, o->buffers);
    o->gl->DeleteTextures(1, &o->texture);
    o->gl->DeleteFramebuffers(1, &o->framebuffer);
    o->gl->DeleteVertexArrays(1, &o->vertex_array);
}

/* ---- a lit cast ---- */

typedef struct scene {
    gpu *g;
    cast c;
    void *texels;
    noh_reflection reflection;
    noh_gl_light_desc light;
    noh_lighting lighting;
    noh_backdrop backdrop;
    noh_stage_blob blob;
    noh_stage_floor level;
    noh_actor actors[CAST_ACTORS];
    noh_stage_view views[2];
    canvas to;
} scene;

static void scene_light(scene *s)
{
    const noh_environment *room = noh_environment_at(noh_environment_find("room"));
    const noh_reflection_desc desc = { 0, noh_reflection_of_environment, room };
    const size_t bytes = noh_reflection_size(0), scratch_bytes = noh_reflection_scratch_size(0);
    void *scratch = malloc(scratch_bytes);
    noh_light all;
    s->texels = malloc(bytes);
    assert_int_equal(noh_reflection_init(s->texels, bytes, scratch, scratch_bytes, &desc, &s->reflection, NULL),
                     NOH_OK);
    free(scratch);
    noh_light_from_environment(room, NOH_SH_ORDER_MAX, &all);
    noh_lighting_make(&all, NULL, 1, &s->lighting);
    s->light.reflection = &s->reflection;
    s->light.shadow_px = SHADOW_PX;
}

/* All that is made: caps, stage, backdrop, blob, floor. */
static void scene_make(scene *s, noh_gl_caps *caps)
{
    const noh_gl_device device = { &s->g->gl, &s->g->caps, &s->g->ledger, NULL, 0 };
    assert_int_equal(noh_gl_caps_probe(&s->g->gl, caps, NULL), NOH_OK);
    cast_make(&s->c, &device);
    assert_int_equal(noh_backdrop_create(&device, 0, &s->backdrop, NULL), NOH_OK);
    assert_int_equal(noh_stage_blob_create(&device, &s->blob, NULL), NOH_OK);
    assert_int_equal(noh_stage_floor_create(&device, 0, &s->level, NULL), NOH_OK);
}

static void scene_open(scene *s)
{
    memset(s, 0, sizeof *s);
    s->g = fixture_gpu();
    scene_light(s);
    cast_open(&s->c);
    s->c.desc.gpu = &noh_stage_on_gl;
    s->c.desc.light = &s->light;
    assert_int_equal(canvas_open(&s->to, s->g, WIDTH, HEIGHT), 0);
}

static void scene_begin(scene *s)
{
    const float all[4] = { 0.0f, 0.8f, -2.0f, 8.0f };
    s->views[0] = cast_view(7, 6.0f);
    s->views[0].cut = 1;
    cast_enter(&s->c, s->actors);
    noh_stage_set_lighting(s->c.stage, &s->lighting);
    noh_view_shadow(&s->views[1], all, s->lighting.key_direction);
    noh_lighting_shadow(&s->lighting, s->views[1].view_projection, all[3], SHADOW_PX);
    assert_int_equal(noh_stage_step(s->c.stage, 30u * CAST_STEP, NULL, NULL, NULL), NOH_OK);
}

static void scene_frame(scene *s)
{
    assert_int_equal(noh_stage_frame_begin(s->c.stage, s->views, 2, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame_end(s->c.stage, NULL), NOH_OK);
}

static void scene_draw(scene *s, uint32_t *picture)
{
    canvas_begin(&s->to);
    assert_int_equal(noh_stage_draw(s->c.stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
    canvas_resolve(&s->to);
    assert_int_equal(canvas_read(&s->to, (uint8_t *)picture), 0);
}

static void scene_close(scene *s)
{
    canvas_close(&s->to);
    noh_backdrop_delete(&s->backdrop);
    noh_stage_blob_delete(&s->blob);
    noh_stage_floor_delete(&s->level);
    cast_close(&s->c);
    free(s->texels);
    fixture_expect_no_errors();
}

static uint32_t covered(const uint32_t *picture)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < PIXELS; i++) count += picture[i] != picture[0];
    return count;
}

/* How many pixels differ by more than `most` in a channel. */
static uint32_t different(const uint32_t *a, const uint32_t *b, int most)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        const uint8_t *p = (const uint8_t *)&a[i], *q = (const uint8_t *)&b[i];
        count += abs(p[0] - q[0]) > most || abs(p[1] - q[1]) > most || abs(p[2] - q[2]) > most;
    }
    return count;
}

static uint32_t plain[PIXELS], other[PIXELS];

/* ---- the tests ---- */

/* Probed, made, stepped and shadowed within a game's state, a stage gives the same picture, and the state stays. */
static void a_games_state_does_not_matter_and_stays(void **state)
{
    noh_gl_caps caps[2];
    (void)state;
    for (int foreign = 0; foreign < 2; foreign++) {
        scene s;
        game o;
        snapshot was;
        noh_error error;
        scene_open(&s);
        game_open(&o, &s.g->gl);
        if (foreign) game_sets(&o);
        take(&s.g->gl, &was);
        scene_make(&s, &caps[foreign]);
        expect_render(&s.g->gl, &was, "create");
        scene_begin(&s);
        scene_frame(&s);
        expect_render(&s.g->gl, &was, "frame");
        s.g->gl.Disable(GL_POLYGON_OFFSET_FILL); /* is the game's, in shadow maps too */
        take(&s.g->gl, &was);
        assert_int_equal(noh_stage_draw_shadow(s.c.stage, 1, &error), NOH_OK);
        expect_render(&s.g->gl, &was, "draw_shadow");
        if (foreign) game_unsets(&o);
        expect_no_bindings(&s.g->gl, "all of it");
        scene_draw(&s, foreign ? other : plain);
        game_close(&o);
        scene_close(&s);
    }
    assert_memory_equal(&caps[0], &caps[1], sizeof caps[0]);
    assert_true(covered(plain) > 3000u);
    assert_int_equal(different(plain, other, 0), 0);
}

static void draw_all(scene *s, uint32_t i)
{
    static const noh_blob blob = { .along = { 1, 0, 0 }, .across = { 0, 0, 1 }, .darkness = 0.5f };
    static const float disc[4] = { 0.0f, 0.0f, 0.0f, 2.0f };
    switch (i) {
    case 0:
    case 1:
    case 2:
    case 3: assert_int_equal(noh_stage_draw(s->c.stage, (noh_pass)i, 0, NULL, NULL), NOH_OK); break;
    case 4: noh_stage_blob_draw(&s->blob, &s->views[0], &blob, 1); break;
    case 5: noh_stage_floor_draw(&s->level, noh_stage_light_of(s->c.stage), &s->lighting, &s->views[0], disc); break;
    default:
        noh_backdrop_draw(&s->backdrop, NOH_BACKDROP_LIGHT, noh_stage_light_of(s->c.stage), &s->lighting, &s->views[0]);
    }
}

/* Every draw puts back what it changes, whether a game has it on or off, binds nothing, and asks for no uniform. */
static void draws_put_render_state_back(void **state)
{
    static const char *const names[] = { "color", "opaque", "blended", "depth", "blob", "floor", "backdrop" };
    noh_gl_caps caps;
    scene s;
    game o;
    (void)state;
    scene_open(&s);
    game_open(&o, &s.g->gl);
    scene_make(&s, &caps);
    scene_begin(&s);
    scene_frame(&s);
    for (uint32_t i = 0; i < 2u * TEST_COUNT(names); i++) {
        snapshot was;
        if (i & 1u) game_sets(&o);
        take(&s.g->gl, &was);
        const unsigned lookups = fixture_uniform_lookups();
        draw_all(&s, i / 2u);
        assert_int_equal(fixture_uniform_lookups(), lookups);
        expect_render(&s.g->gl, &was, names[i / 2u]);
        game_unsets(&o);
        expect_no_bindings(&s.g->gl, names[i / 2u]);
    }
    game_close(&o);
    scene_close(&s);
}

/* Draw with a projection of the game's whose depths are -z, into a buffer that was cleared to their far end. */
static void draw_reversed(scene *s, GLenum function)
{
    static const float far = 0.0f;
    const noh_stage_view plain_view = s->views[0];
    for (int i = 0; i < 4; i++) s->views[0].view_projection[4 * i + 2] *= -1.0f;
    scene_frame(s);
    canvas_begin(&s->to);
    s->g->gl.ClearBufferfv(GL_DEPTH, 0, &far);
    s->g->gl.DepthFunc(function);
    assert_int_equal(noh_stage_draw(s->c.stage, NOH_PASS_DEPTH, 0, NULL, NULL), NOH_OK);
    assert_int_equal(noh_stage_draw(s->c.stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
    s->g->gl.DepthFunc(GL_LESS);
    canvas_resolve(&s->to);
    assert_int_equal(canvas_read(&s->to, (uint8_t *)other), 0);
    s->views[0] = plain_view;
}

static void reversed_depth_draws_the_same_picture(void **state)
{
    static const GLenum functions[] = { GL_GREATER, GL_GEQUAL };
    noh_gl_caps caps;
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(functions); i++) {
        scene s;
        scene_open(&s);
        scene_make(&s, &caps);
        scene_begin(&s);
        scene_frame(&s);
        scene_draw(&s, plain);
        assert_true(covered(plain) > 3000u);
        draw_reversed(&s, functions[i]);
        assert_true(covered(other) > 3000u);
        assert_true(different(plain, other, 8) < covered(plain) / 50u); /* edges: depths are rounded elsewhere */
        scene_close(&s);
    }
}

/* Colours after a depth pass, where depths are equal, and none are written. */
static void an_equal_pass_follows_a_depth_pass(void **state)
{
    noh_gl_caps caps;
    scene s;
    (void)state;
    scene_open(&s);
    scene_make(&s, &caps);
    scene_begin(&s);
    scene_frame(&s);
    scene_draw(&s, plain);
    canvas_begin(&s.to);
    assert_int_equal(noh_stage_draw(s.c.stage, NOH_PASS_DEPTH, 0, NULL, NULL), NOH_OK);
    s.g->gl.DepthFunc(GL_EQUAL);
    s.g->gl.DepthMask(GL_FALSE);
    assert_int_equal(noh_stage_draw(s.c.stage, NOH_PASS_OPAQUE, 0, NULL, NULL), NOH_OK);
    s.g->gl.DepthFunc(GL_LESS);
    s.g->gl.DepthMask(GL_TRUE);
    assert_int_equal(noh_stage_draw(s.c.stage, NOH_PASS_BLENDED, 0, NULL, NULL), NOH_OK);
    canvas_resolve(&s.to);
    assert_int_equal(canvas_read(&s.to, (uint8_t *)other), 0);
    assert_true(covered(plain) > 3000u);
    assert_int_equal(different(plain, other, 1), 0);
    scene_close(&s);
}

/* Through a mirror, where a game calls what is clockwise the front, the picture is the other way round. */
static void a_mirrored_projection_has_its_own_front(void **state)
{
    noh_gl_caps caps;
    uint32_t wrong = 0;
    scene s;
    (void)state;
    scene_open(&s);
    scene_make(&s, &caps);
    scene_begin(&s);
    scene_frame(&s);
    scene_draw(&s, plain);
    for (int i = 0; i < 4; i++) s.views[0].view_projection[4 * i] *= -1.0f;
    scene_frame(&s);
    s.g->gl.FrontFace(GL_CW);
    scene_draw(&s, other);
    s.g->gl.FrontFace(GL_CCW);
    for (uint32_t i = 0; i < PIXELS; i++) {
        const uint8_t *a = (const uint8_t *)&plain[i];
        const uint8_t *b = (const uint8_t *)&other[i / WIDTH * WIDTH + WIDTH - 1u - i % WIDTH];
        wrong += abs(a[0] - b[0]) > 24 || abs(a[1] - b[1]) > 24 || abs(a[2] - b[2]) > 24;
    }
    assert_true(covered(plain) > 3000u);
    assert_true(wrong < covered(plain) / 10u); /* edges: the two are not sampled alike */
    scene_close(&s);
}

/* Where a game blends, it blends as it says. Decided by draws that add nothing. */
static void blending_that_is_on_is_the_games(void **state)
{
    noh_gl_caps caps;
    scene s;
    (void)state;
    scene_open(&s);
    scene_make(&s, &caps);
    scene_begin(&s);
    scene_frame(&s);
    s.g->gl.Enable(GL_BLEND);
    s.g->gl.BlendFunc(GL_ZERO, GL_ONE);
    scene_draw(&s, other);
    s.g->gl.BlendFunc(GL_ONE, GL_ZERO);
    s.g->gl.Disable(GL_BLEND);
    assert_int_equal(covered(other), 0);
    scene_close(&s);
}

/* Saved before and restored after, GL does not know that noh was there: bindings of all kinds, too. */
static void saved_state_is_restored(void **state)
{
    noh_gl_caps caps;
    snapshot was, is;
    noh_gl_state saved;
    scene s;
    game o;
    (void)state;
    scene_open(&s);
    game_open(&o, &s.g->gl);
    scene_make(&s, &caps);
    scene_begin(&s);
    game_sets(&o);
    for (GLuint u = 0; u < UNITS; u++) {
        s.g->gl.ActiveTexture(GL_TEXTURE0 + u);
        s.g->gl.BindTexture(GL_TEXTURE_2D, o.texture);
    }
    s.g->gl.ActiveTexture(GL_TEXTURE0 + 9u);
    s.g->gl.BindVertexArray(o.vertex_array);
    s.g->gl.BindBuffer(GL_ARRAY_BUFFER, o.buffers[2]);
    s.g->gl.BindBuffer(GL_COPY_READ_BUFFER, o.buffers[2]);
    s.g->gl.BindBufferRange(GL_UNIFORM_BUFFER, 0, o.buffers[3], 0, 256);
    s.g->gl.BindBuffer(GL_UNIFORM_BUFFER, o.buffers[1]);
    take(&s.g->gl, &was);
    noh_gl_state_save(&s.g->gl, &saved);
    take(&s.g->gl, &is);
    assert_memory_equal(&was, &is, sizeof was);
    scene_frame(&s);
    assert_int_equal(noh_stage_draw_shadow(s.c.stage, 1, NULL), NOH_OK);
    for (uint32_t i = 0; i < 7u; i++) draw_all(&s, i);
    noh_gl_state_restore(&s.g->gl, &saved);
    expect_render(&s.g->gl, &was, "restore");
    take(&s.g->gl, &is);
    assert_memory_equal(was.bindings, is.bindings, sizeof was.bindings);
    assert_memory_equal(was.units, is.units, sizeof was.units);
    assert_int_equal(was.uniform_buffer, is.uniform_buffer);
    s.g->gl.BindVertexArray(0);
    game_close(&o);
    scene_close(&s);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_games_state_does_not_matter_and_stays),
    cmocka_unit_test(draws_put_render_state_back),
    cmocka_unit_test(reversed_depth_draws_the_same_picture),
    cmocka_unit_test(an_equal_pass_follows_a_depth_pass),
    cmocka_unit_test(a_mirrored_projection_has_its_own_front),
    cmocka_unit_test(blending_that_is_on_is_the_games),
    cmocka_unit_test(saved_state_is_restored),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
