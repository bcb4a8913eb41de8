/* What actors wear: tints and texture sets, against the parts drawn by hand and against closed forms; planned to the
 * byte, in as few draws as there are sets, and there again after a lost context. */
#include "support/stage_fixture.h"
#include "support/tube_fixture.h"

#include "convert/model/model_build.h"
#include "gpu/canvas.h"
#include "noh/face.h"
#include "noh/format.h"
#include "null.h"
#include "support/lit_quad.h"
#include "support/skin_asset.h"
#include "support/renderer.h"
#include "support/srgb.h"

#include <math.h>

#define WIDTH 320u
#define HEIGHT 64u
#define PIXELS (WIDTH * HEIGHT)
#define ACTORS 5u

static noh_error said;

/* ---- a wardrobe: quads with a texture of one colour ---- */

/* Two packs of the same quad. The first has the textures "cloth" and "cloth_red", the second "cloth". */
static const uint8_t cloth[2][2][4] = { { { 200, 180, 160, 255 }, { 220, 30, 20, 255 } },
                                        { { 20, 200, 90, 255 }, { 99, 99, 99, 255 } } };

/* What each actor wears. */
static const noh_appearance looks[ACTORS] = {
    { .pixels = 1e-4f },
    { .pixels = 1e-4f, .tint = { 255, 128, 0, 255 }, .texture_set = 0 },
    { .pixels = 1e-4f, .tint = { 90, 255, 255, 128 }, .texture_set = 1 },
    { .pixels = 1e-4f, .tint = { 255, 255, 255, 64 }, .texture_set = 2 },
    { .pixels = 1e-4f, .tint = { 40, 10, 250, 255 }, .texture_set = 2 },
};

static const uint8_t *texel_of(const noh_appearance *look)
{
    return look->texture_set == 2 ? cloth[1][0] : cloth[0][look->texture_set];
}

/* values: of the surface; NULL: plain, unlit */
static uint8_t *quad_pack(uint32_t which, int alpha, uint8_t tint, uint32_t surface, const float *values, size_t *count)
{
    const test_model_desc desc = { 1, 2, 0, TEST_UVS, 1 };
    model *m = test_model(&desc);
    model_material *material = m->materials = test_zeros(sizeof *m->materials);
    uint8_t *bytes;
    *material = model_material_default();
    material->base_color_texture = 0;
    m->material_count = 1;
    material->name = model_string("cloth");
    for (int i = 0; i < 4; i++) material->base_color[i] = 1.0f;
    material->unlit = values == NULL;
    material->double_sided = 1;
    material->surface = surface;
    if (values) memcpy(material->surface_values, values, sizeof material->surface_values);
    material->alpha = (model_alpha)alpha;
    material->tint = tint;
    material->alpha_cutoff = 0.9f;
    m->textures = test_zeros(2 * sizeof *m->textures);
    m->texture_count = which ? 1 : 2;
    for (uint32_t t = 0; t < m->texture_count; t++) {
        model_texture *to = &m->textures[t];
        to->name = model_string(t ? "cloth_red" : "cloth");
        to->width = to->height = 1;
        to->rgba = test_zeros(4);
        memcpy(to->rgba, cloth[which][t], 4);
        to->mag_filter = to->min_filter = 9728;
    }
    m->meshes[0].submeshes[0].material = 0;
    for (uint32_t v = 0; v < 4; v++) {
        m->meshes[0].position[3 * v] = v % 2 ? 0.4f : -0.4f;
        m->meshes[0].position[3 * v + 1] = v / 2 ? 0.4f : -0.4f;
        m->meshes[0].position[3 * v + 2] = 0.0f;
        for (uint32_t i = 0; i < 3 && values; i++) m->meshes[0].normal[3 * v + i] = i == 2 ? 1.0f : 0.0f;
    }
    bytes = test_pack_of(m, count, NULL);
    model_free(m);
    return bytes;
}

typedef struct wardrobe {
    uint8_t *bytes[2];
    noh_pack packs[2];
    noh_texture_set sets[2];
    noh_kind_desc kind, each[ACTORS];
    int apart; /* 1: a kind of its own for each actor, which is drawn alone */
    noh_stage_desc desc;
    noh_stage_plan plan;
    noh_stage *stage;
    void *memory;
    noh_actor actors[ACTORS];
    noh_stage_view view;
} wardrobe;

static void wardrobe_open_as(wardrobe *w, int alpha, uint8_t tint, uint32_t surface, const float *values)
{
    memset(w, 0, sizeof *w);
    for (uint32_t i = 0; i < 2; i++) {
        size_t count;
        w->bytes[i] = quad_pack(i, alpha, tint, surface, values, &count);
        w->packs[i] = test_open(w->bytes[i], count);
    }
    w->sets[0] = (noh_texture_set){ .name = "red", .suffix = "_red" };
    w->sets[1] = (noh_texture_set){ .name = "green", .pack = &w->packs[1] };
    w->kind.mesh = &w->packs[0];
    w->kind.actor_count = ACTORS;
    w->kind.texture_sets = w->sets;
    w->kind.texture_set_count = 2;
    w->desc.kinds = &w->kind;
    w->desc.kind_count = 1;
    w->desc.gpu = &noh_stage_on_gl;
}

static void wardrobe_open(wardrobe *w, int alpha, uint8_t tint)
{
    wardrobe_open_as(w, alpha, tint, NOH_SURFACE_PLAIN, NULL);
}

static void wardrobe_make(wardrobe *w, gpu *g)
{
    static const float middle[3] = { 2.0f, 0.0f, 0.0f };
    static char log[4096];
    const noh_gl_device device = { &g->gl, &g->caps, &g->ledger, log, sizeof log };
    for (uint32_t i = 0; i < ACTORS && w->apart; i++) {
        w->each[i] = w->kind;
        w->each[i].actor_count = 1;
        w->desc.kinds = w->each;
        w->desc.kind_count = ACTORS;
    }
    if (noh_stage_plan_make(&w->desc, &g->caps, &w->plan, &said) != NOH_OK) fail_msg("plan: %s", said.what);
    w->memory = test_aligned(NULL, (size_t)w->plan.cpu_bytes);
    if (noh_stage_init(w->memory, (size_t)w->plan.cpu_bytes, &device, &w->desc, &w->plan, &w->stage, &said) != NOH_OK)
        fail_msg("stage: %s", said.what);
    for (uint32_t i = 0; i < ACTORS; i++) {
        const noh_place place = { .position = { (float)i, 0.0f, 0.0f } };
        assert_int_equal(noh_stage_spawn(w->stage, w->apart ? i : 0, &place, &w->actors[i], NULL), NOH_OK);
        assert_int_equal(noh_actor_set_appearance(w->stage, w->actors[i], &looks[i], NULL), NOH_OK);
    }
    noh_view_orbit(&w->view, middle, 0.0f, 0.0f, 1.45f, WIDTH, HEIGHT);
}

static void wardrobe_close(wardrobe *w)
{
    if (w->stage) noh_stage_delete(w->stage);
    free(w->memory);
    free(w->bytes[0]);
    free(w->bytes[1]);
}

static void draw(wardrobe *w, canvas *to, noh_stage_shader *shader, uint32_t *rgba)
{
    assert_int_equal(noh_stage_frame(w->stage, 0, &w->view, NULL, NULL, NULL), NOH_OK);
    canvas_begin(to);
    assert_int_equal(noh_stage_draw(w->stage, NOH_PASS_COLOR, 0, shader, NULL), NOH_OK);
    canvas_resolve(to);
    assert_int_equal(canvas_read(to, (uint8_t *)rgba), 0);
}

/* The middle of an actor in a picture. */
static const uint8_t *middle_of(const wardrobe *w, const uint32_t *rgba, uint32_t actor)
{
    const float *m = w->view.view_projection;
    const float x = m[0] * (float)actor + m[12], width = m[3] * (float)actor + m[15];
    const uint32_t column = (uint32_t)((0.5f + 0.5f * x / width) * (float)WIDTH);
    assert_true(column < WIDTH);
    return (const uint8_t *)&rgba[HEIGHT / 2u * WIDTH + column];
}

/* ---- by hand ---- */

/* The same actors, each drawn alone by noh_gl_draw_mesh. */
static void draw_by_hand(const wardrobe *w, gpu *g, canvas *to, uint32_t *rgba)
{
    static noh_gl_renderer renderer;
    const noh_gl_device device = { &g->gl, &g->caps, &g->ledger, NULL, 0 };
    const noh_mesh mesh = test_mesh(&w->packs[0], 0);
    const noh_gl_renderer_desc desc = { .meshes = &mesh, .mesh_count = 1, .without_tangents = 1 };
    noh_gl_texture pictures[3][2];
    noh_gl_mesh on_gl;
    noh_gl_camera camera;
    noh_texture texture;
    memset(pictures, 0, sizeof pictures);
    assert_int_equal(noh_gl_mesh_create(&g->gl, &g->ledger, &mesh, &on_gl, NULL), NOH_OK);
    assert_int_equal(renderer_create(&device, &desc, &renderer, NULL), NOH_OK);
    for (uint32_t set = 0; set < 3; set++) {
        assert_int_equal(noh_pack_texture_at(&w->packs[set / 2u], set % 2u, &texture, NULL), NOH_OK);
        assert_int_equal(noh_gl_picture_create(&g->gl, &g->ledger, &texture, &pictures[set][0], NULL), NOH_OK);
    }
    memcpy(camera.view_projection, w->view.view_projection, sizeof camera.view_projection);
    memcpy(camera.eye, w->view.eye, sizeof camera.eye);
    memcpy(camera.key, w->view.light, sizeof camera.key);
    canvas_begin(to);
    noh_gl_draw_begin(&renderer, &camera);
    for (int pass = NOH_DRAW_OPAQUE; pass <= NOH_DRAW_BLENDED; pass++) {
        for (uint32_t i = 0; i < ACTORS; i++) {
            const float *node = w->packs[0].node_count ? w->packs[0].nodes[0].world : NULL;
            float world[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
            if (node) memcpy(world, node, sizeof world);
            world[3] += (float)i;
            noh_gl_draw_instance(&renderer, looks[i].tint[3] ? looks[i].tint : NULL, NULL, NULL);
            noh_gl_draw_mesh(&renderer, &on_gl, world, NULL, NULL, NULL, pictures[looks[i].texture_set], pass);
        }
    }
    noh_gl_draw_end(&renderer);
    canvas_resolve(to);
    assert_int_equal(canvas_read(to, (uint8_t *)rgba), 0);
    noh_gl_renderer_delete(&renderer);
    noh_gl_mesh_delete(&g->gl, &g->ledger, &on_gl);
    for (int set = 0; set < 3; set++) noh_gl_texture_delete(&g->gl, &g->ledger, &pictures[set][0]);
}

/* Actors side by side are the parts drawn by hand, pixel by pixel. */
static void expect_looks(const uint32_t *by_stage, const uint32_t *by_hand, const uint32_t *empty)
{
    uint32_t drawn = 0;
    for (uint32_t i = 0; i < PIXELS; i++) drawn += by_stage[i] != empty[i];
    assert_true(drawn > PIXELS / 5u);
    assert_memory_equal(by_stage, by_hand, PIXELS * sizeof *by_stage);
}

/* Their colours are texture times tint, where the material takes one; of opaque and alpha-cut materials whatever the
 * tint's alpha, of blended ones by that over the background, whether they take its colour or not. */
static void actors_look_as_their_parts_drawn_by_hand(void **state)
{
    static uint32_t by_stage[PIXELS], by_hand[PIXELS], empty[PIXELS];
    gpu *g = fixture_gpu();
    canvas to;
    (void)state;
    assert_int_equal(canvas_open(&to, g, WIDTH, HEIGHT), 0);
    canvas_begin(&to);
    canvas_resolve(&to);
    assert_int_equal(canvas_read(&to, (uint8_t *)empty), 0);
    for (int turn = 0; turn < 6; turn++) {
        const int alpha = turn % 3, takes = turn < 3;
        wardrobe w;
        wardrobe_open(&w, alpha, takes ? MODEL_TINT_ON : MODEL_TINT_OFF);
        wardrobe_make(&w, g);
        draw(&w, &to, NULL, by_stage);
        draw_by_hand(&w, g, &to, by_hand);
        expect_looks(by_stage, by_hand, empty);
        for (uint32_t a = 0; a < ACTORS; a++) {
            const uint8_t *pixel = middle_of(&w, by_stage, a), *texel = texel_of(&looks[a]);
            const uint8_t *behind = middle_of(&w, empty, a), *tint = looks[a].tint;
            const int white = tint[3] == 0;
            const double share = alpha == MODEL_ALPHA_BLEND && !white ? tint[3] / 255.0 : 1.0;
            for (int i = 0; i < 3; i++) {
                const double own = decoded(texel[i]) * (white || !takes ? 1.0 : decoded(tint[i]));
                const double want = encoded(own * share + decoded(behind[i]) * (1.0 - share));
                if (fabs(pixel[i] - want) > 2.0)
                    fail_msg("alpha %d, tint %s, actor %u, channel %d: %u for %g", alpha, takes ? "on" : "off",
                             (unsigned)a, i, pixel[i], want);
            }
        }
        wardrobe_close(&w);
    }
    canvas_close(&to);
    fixture_expect_no_errors();
}

/* A shader of the game's own is given the tint, linear: encoded again, it is the bytes of the look. */
static void own_shaders_are_given_the_tint(void **state)
{
    static const char vertex[] = "out vec4 v_tint;\n"
                                 "void main() {\n"
                                 "    noh_vertex v = noh_fetch();\n"
                                 "    v_tint = v.tint;\n"
                                 "    gl_Position = noh_view_projection * vec4(v.position, 1.0);\n"
                                 "}\n";
    static const char fragment[] = "in vec4 v_tint; out vec4 color;\n"
                                   "void main() { noh_fade(); color = vec4(v_tint.rgb, 1.0); }\n";
    const noh_gl_shader_desc desc = { .name = "tint", .vertex = vertex, .fragment = fragment };
    static uint32_t rgba[PIXELS];
    gpu *g = fixture_gpu();
    noh_stage_shader *shader;
    void *memory;
    canvas to;
    wardrobe w;
    (void)state;
    wardrobe_open(&w, MODEL_ALPHA_OPAQUE, MODEL_TINT_ON);
    wardrobe_make(&w, g);
    assert_int_equal(canvas_open(&to, g, WIDTH, HEIGHT), 0);
    memory = test_aligned(NULL, noh_stage_shader_size(w.stage));
    assert_int_equal(
        noh_stage_shader_create(w.stage, memory, noh_stage_shader_size(w.stage), &desc, NULL, 0, &shader, NULL),
        NOH_OK);
    draw(&w, &to, shader, rgba);
    for (uint32_t a = 0; a < ACTORS; a++) {
        for (int i = 0; i < 3; i++) {
            const int want = looks[a].tint[3] ? looks[a].tint[i] : 255;
            assert_in_range(middle_of(&w, rgba, a)[i], want > 0 ? want - 1 : 0, want + 1);
        }
    }
    noh_stage_shader_delete(shader);
    free(memory);
    canvas_close(&to);
    wardrobe_close(&w);
    fixture_expect_no_errors();
}

/* And four floats of each actor, in one draw of a crowd and alone; zeros in a stage that does not ask for them. */
static void own_shaders_are_given_user_values(void **state)
{
    static const char vertex[] = "flat out vec4 v_user;\n"
                                 "void main() {\n"
                                 "    noh_vertex v = noh_fetch();\n"
                                 "    v_user = noh_user();\n"
                                 "    gl_Position = noh_view_projection * vec4(v.position, 1.0);\n"
                                 "}\n";
    static const char fragment[] =
        "flat in vec4 v_user; out vec4 color;\n"
        "void main() { noh_fade(); color = vec4(v_user.w > 6.5 ? v_user.rgb : vec3(0.0), 1.0); }\n";
    const noh_gl_shader_desc desc = { .name = "user", .vertex = vertex, .fragment = fragment };
    static uint32_t rgba[PIXELS];
    gpu *g = fixture_gpu();
    (void)state;
    for (uint32_t way = 0; way < 3; way++) {
        noh_stage_shader *shader;
        void *memory;
        canvas to;
        wardrobe w;
        wardrobe_open(&w, MODEL_ALPHA_OPAQUE, MODEL_TINT_ON);
        w.apart = way == 1;
        w.desc.user_values = way < 2;
        wardrobe_make(&w, g);
        for (uint32_t a = 0; a < ACTORS; a++) {
            noh_appearance look = looks[a];
            for (uint32_t i = 0; i < 3; i++) look.user[i] = (float)((a + 1u) >> i & 1u);
            look.user[3] = 7.0f;
            assert_int_equal(noh_actor_set_appearance(w.stage, w.actors[a], &look, NULL), NOH_OK);
        }
        assert_int_equal(canvas_open(&to, g, WIDTH, HEIGHT), 0);
        memory = test_aligned(NULL, noh_stage_shader_size(w.stage));
        assert_int_equal(
            noh_stage_shader_create(w.stage, memory, noh_stage_shader_size(w.stage), &desc, NULL, 0, &shader, NULL),
            NOH_OK);
        draw(&w, &to, shader, rgba);
        for (uint32_t a = 0; a < ACTORS; a++) {
            for (uint32_t i = 0; i < 3; i++) {
                const uint32_t want = way < 2 ? 255u * ((a + 1u) >> i & 1u) : 0;
                assert_int_equal(middle_of(&w, rgba, a)[i], want);
            }
        }
        noh_stage_shader_delete(shader);
        free(memory);
        canvas_close(&to);
        wardrobe_close(&w);
    }
    fixture_expect_no_errors();
}

/* ---- complexions ---- */

static double smooth(double from, double to, double x)
{
    const double t = fmin(fmax((x - from) / (to - from), 0.0), 1.0);
    return t * t * (3.0 - 2.0 * t);
}

static double signed_byte(float three, uint32_t which)
{
    return (double)(int8_t)((uint32_t)three >> 8u * which & 255u);
}

/* The densities of face.h, on linear colour. */
static void skin_of(const float user[4], const double own[3], double out[3])
{
    static const double melanin[3] = { 1.0, 1.35, 1.85 }, blood[3] = { 0.15, 1.0, 0.85 }, rest[3] = { .05, .08, .11 };
    const double red = log(own[0] / own[1]), yellow = log(own[1] / own[2]);
    const double lips = smooth(0.5, 0.9, 1.047 * red - 0.733 * yellow);
    const double m = signed_byte(user[0], 0) / 32.0 * (1.0 - 0.4 * lips);
    const double b = signed_byte(user[0], 1) / 64.0 + signed_byte(user[1], 2) / 64.0 * lips;
    const double is_skin = smooth(0.0, 0.2, red + yellow);
    for (int i = 0; i < 3; i++) {
        const double through = rest[i] + (1.0 - rest[i]) * exp(-m * melanin[i]);
        out[i] = fmin(own[i] * (1.0 - is_skin + is_skin * through * exp(-b * blood[i])), 1.0);
    }
}

static void iris_of(const float user[4], const double own[3], double out[3])
{
    const double light = 0.2126 * own[0] + 0.7152 * own[1] + 0.0722 * own[2];
    const double share = (double)((uint32_t)user[3] & 255u) / 255.0;
    for (int i = 0; i < 3; i++) {
        const double root = (double)((uint32_t)user[2] >> 8 * i & 255u) / 255.0;
        out[i] = own[i] * (1.0 - share) + share * root * root * 1.6 * light / (light + 0.06);
    }
}

static void hair_of(const float user[4], const double own[3], double out[3])
{
    static const double eumelanin[3] = { 0.60, 1.0, 1.97 }, pheomelanin[3] = { 0.47, 1.0, 2.63 };
    const double m = signed_byte(user[1], 0) / 32.0, red = signed_byte(user[1], 1) / 64.0;
    for (int i = 0; i < 3; i++) {
        out[i] = pow(own[i], exp(fmin(m, 0.0))) * exp(-fmax(m, 0.0) * eumelanin[i] - red * pheomelanin[i]);
    }
}

static void none_of(const float user[4], const double own[3], double out[3])
{
    (void)user;
    memcpy(out, own, 3 * sizeof *own);
}

static const struct {
    const char *what;
    uint32_t surface;
    float values[4];
    void (*should)(const float user[4], const double own[3], double out[3]);
} parts[] = {
    { "skin", NOH_SURFACE_SKIN, { 1000.0f }, skin_of },
    { "an iris", NOH_SURFACE_EYE, { 0.0f, 0.0f, 1.0f, 0.3f }, iris_of },
    { "the white of an eye", NOH_SURFACE_EYE, { 0.0f, 0.0f, -1.0f, 0.3f }, none_of },
    { "an eye without an iris", NOH_SURFACE_EYE, { 0.0f }, none_of },
    { "hair", NOH_SURFACE_HAIR, { 0.0f }, hair_of },
    { "teeth", NOH_SURFACE_TEETH, { 0.0f }, none_of },
    { "cloth", NOH_SURFACE_PLAIN, { 0.0f }, none_of },
};

/* Without freckles, which have a test of their own; the first actor has no complexion. */
static noh_appearance complexion_of(uint32_t actor)
{
    noh_appearance look = { .pixels = 1e-4f, .texture_set = looks[actor].texture_set };
    if (!actor) return look;
    noh_complexion_random(actor * 7u, 1.0f, look.user);
    look.user[0] = (float)((uint32_t)look.user[0] & 0xffffu);
    return look;
}

/* ways: 0 a crowd in one draw, 1 each alone, 2 each alone in the phone tier. users: 0 none, 1 zeros, 2 complexions */
static void draw_complexions(gpu *g, uint32_t part, uint32_t way, int users, const noh_gl_shader_desc *desc,
                             wardrobe *w, uint32_t *rgba)
{
    canvas to;
    noh_stage_shader *shader = NULL;
    void *memory = NULL;
    wardrobe_open_as(w, MODEL_ALPHA_OPAQUE, MODEL_TINT_OFF, parts[part].surface, parts[part].values);
    w->apart = way > 0;
    w->desc.shading = way == 2 ? NOH_SHADING_PHONE : NOH_SHADING_FULL;
    w->desc.without_depth = 1; /* the albedo is of colour passes alone */
    w->desc.user_values = users ? NOH_USER_COMPLEXION : 0;
    wardrobe_make(w, g);
    for (uint32_t a = 0; a < ACTORS; a++) {
        noh_appearance look = complexion_of(a);
        if (users < 2) memset(look.user, 0, sizeof look.user);
        assert_int_equal(noh_actor_set_appearance(w->stage, w->actors[a], &look, NULL), NOH_OK);
    }
    assert_int_equal(canvas_open(&to, g, WIDTH, HEIGHT), 0);
    if (desc) {
        const size_t bytes = noh_stage_shader_size(w->stage);
        memory = test_aligned(NULL, bytes);
        static char log[4096];
        if (noh_stage_shader_create(w->stage, memory, bytes, desc, log, sizeof log, &shader, &said))
            fail_msg("%s: %s", said.what, log);
    }
    draw(w, &to, shader, rgba);
    if (shader) noh_stage_shader_delete(shader);
    free(memory);
    canvas_close(&to);
}

static void complexions_are_the_densities_of_each_part(void **state)
{
    static const char fragment[] =
        "in vec3 v_world; in vec3 v_normal; in vec2 v_uv; centroid in vec4 v_color;\n"
        "layout(location = 0) out vec4 o_color;\n"
        "void main() {\n"
        "    noh_surface s = noh_surface_of(noh_base(v_uv, v_color), v_world, v_normal, vec4(0.0), v_uv);\n"
        "    noh_fade();\n"
        "    o_color = vec4(s.albedo, 1.0);\n"
        "}\n";
    const noh_gl_shader_desc desc = { .name = "albedo", .fragment = fragment };
    static uint32_t rgba[PIXELS];
    (void)state;
    for (uint32_t i = 0; i < TEST_COUNT(parts) * 3u; i++) {
        const uint32_t part = i / 3u;
        int changed = 0;
        wardrobe w;
        draw_complexions(fixture_gpu(), part, i % 3u, 2, &desc, &w, rgba);
        for (uint32_t a = 0; a < ACTORS; a++) {
            const noh_appearance look = complexion_of(a);
            const uint8_t *texel = texel_of(&look), *pixel = middle_of(&w, rgba, a);
            double own[3], want[3];
            for (int c = 0; c < 3; c++) own[c] = decoded(texel[c]);
            if (a)
                parts[part].should(look.user, own, want);
            else
                none_of(look.user, own, want);
            for (int c = 0; c < 3; c++) {
                changed |= abs(pixel[c] - texel[c]) > 8;
                if (fabs(pixel[c] - encoded(want[c])) > 1.6)
                    fail_msg("%s, way %u, actor %u, channel %d: %u for %g", parts[part].what, i % 3u, a, c, pixel[c],
                             encoded(want[c]));
            }
        }
        assert_int_equal(changed, parts[part].should != none_of);
        wardrobe_close(&w);
    }
    fixture_expect_no_errors();
}

/* A complexion of zeros is the picture of a stage without complexions, lit, to the bit; others are not; a crowd is the
 * picture of its actors alone. */
static void no_complexion_is_no_change(void **state)
{
    static uint32_t rgba[4][PIXELS];
    (void)state;
    for (uint32_t part = 0; part < TEST_COUNT(parts); part++) {
        for (uint32_t i = 0; i < 4; i++) {
            wardrobe w;
            draw_complexions(fixture_gpu(), part, i == 3u, i < 2u ? (int)i : 2, NULL, &w, rgba[i]);
            wardrobe_close(&w);
        }
        assert_memory_equal(rgba[0], rgba[1], sizeof rgba[0]);
        assert_int_equal(memcmp(rgba[0], rgba[2], sizeof rgba[0]) != 0, parts[part].should != none_of);
        assert_memory_equal(rgba[2], rgba[3], sizeof rgba[2]);
    }
    fixture_expect_no_errors();
}

/* Freckles darken spots and leave the skin between them as it is, to the bit. */
static void freckles_are_spots(void **state)
{
    static const float values[4] = { 20.0f };
    static uint32_t rgba[2][PIXELS];
    uint32_t spots = 0, skin = 0;
    (void)state;
    for (uint32_t i = 0; i < 2; i++) {
        noh_appearance look = { .pixels = 1e-4f, .user = { (float)(i * 255u << 16), 0.0f, 0.0f, (float)(9u << 8) } };
        canvas to;
        wardrobe w;
        wardrobe_open_as(&w, MODEL_ALPHA_OPAQUE, MODEL_TINT_OFF, NOH_SURFACE_SKIN, values);
        w.desc.user_values = NOH_USER_COMPLEXION;
        wardrobe_make(&w, fixture_gpu());
        for (uint32_t a = 0; a < ACTORS; a++) {
            assert_int_equal(noh_actor_set_appearance(w.stage, w.actors[a], &look, NULL), NOH_OK);
        }
        assert_int_equal(canvas_open(&to, fixture_gpu(), WIDTH, HEIGHT), 0);
        draw(&w, &to, NULL, rgba[i]);
        canvas_close(&to);
        wardrobe_close(&w);
    }
    for (uint32_t p = 0; p < PIXELS; p++) {
        const uint8_t *before = (const uint8_t *)&rgba[0][p], *after = (const uint8_t *)&rgba[1][p];
        for (int c = 0; c < 3; c++) assert_true(after[c] <= before[c] + 1); /* a byte may round up */
        spots += after[1] + 4 < before[1];
        skin += before[0] > 0 && memcmp(before, after, 3) == 0;
    }
    print_message("%u pixels of freckles, %u of skin\n", spots, skin);
    assert_true(spots > 50 && skin > spots);
    fixture_expect_no_errors();
}

/* ---- in every way of drawing ---- */

/* Morphed and skinned copies with a tint: one by one with palettes in a block and in a texture, and as a crowd, the
 * same picture; without the tint, another one. A copy that is placed again keeps its tint. */
static void every_way_of_drawing_has_the_tint(void **state)
{
    static const uint8_t tint[4] = { 120, 200, 31, 255 };
    static const skin_cylinder c = { 24, 33, 9, 4, 3, 1, 2.0f, 0.35f };
    const noh_palette_mode modes[4] = { NOH_PALETTE_TEXTURE, NOH_PALETTE_TEXTURE, NOH_PALETTE_UNIFORM,
                                        NOH_PALETTE_TEXTURE };
    uint8_t *pictures[4], *bytes;
    gpu *g = fixture_gpu();
    skin_options options;
    noh_pack pack;
    noh_mesh mesh;
    size_t count;
    model *m = skin_cylinder_model(&c);
    (void)state;
    memset(&options, 0, sizeof options);
    options.palette = 6;
    bytes = skin_pack_of(m, &options, 1.0f, &count, NULL);
    model_free(m);
    pack = test_open(bytes, count);
    mesh = test_mesh(&pack, 0);
    for (int way = 0; way < 4; way++) {
        const noh_gl_renderer_desc desc = {
            .meshes = &mesh, .mesh_count = 1, .palettes = modes[way], .crowds = modes[way] == NOH_PALETTE_TEXTURE
        };
        noh_gl_ledger ledger = { 0 };
        noh_gl_renderer r;
        fixture_frame f;
        tube t;
        tube_open(&t, &mesh, modes[way]);
        assert_int_equal(renderer_create(&(noh_gl_device){ &g->gl, NULL, &ledger, NULL, 0 }, &desc, &r, NULL), NOH_OK);
        for (uint32_t i = 0; i < COPIES && way < 3; i++) {
            const noh_result result = noh_gl_skin_set_tint(t.skin, i, tint, &said);
            assert_int_equal(result, modes[way] == NOH_PALETTE_TEXTURE ? NOH_OK : NOH_ERR_UNSUPPORTED);
        }
        if (way == 0) tube_pose(&t);
        noh_gl_skin_update(t.skin);
        fixture_frame_open(&f, 128);
        noh_gl_draw_begin(&r, &tube_camera);
        if (way < 3) noh_gl_draw_instance(&r, tint, NULL, NULL);
        tube_draw(&r, &t, &t.gl, way == 0 || way == 3 ? CROWD : SKINNED, NULL, NOH_DRAW_OPAQUE);
        noh_gl_draw_end(&r);
        pictures[way] = fixture_frame_read(&f);
        fixture_frame_close(&f);
        noh_gl_renderer_delete(&r);
        tube_close(&t);
    }
    assert_memory_equal(pictures[0], pictures[1], 128u * 128u * 4u);
    assert_memory_equal(pictures[0], pictures[2], 128u * 128u * 4u);
    assert_memory_not_equal(pictures[0], pictures[3], 128u * 128u * 4u);
    for (int way = 0; way < 4; way++) free(pictures[way]);
    free(bytes);
    fixture_expect_no_errors();
}

/* ---- bytes, order, errors ---- */

/* A set of the kind's own pack takes no byte on the GPU, one of another pack takes the bytes of its textures. */
static void sets_take_what_is_planned(void **state)
{
    gpu *g = fixture_gpu();
    const noh_gl_ledger before = g->ledger;
    uint64_t bytes[3];
    wardrobe w;
    (void)state;
    for (uint32_t sets = 0; sets < 3; sets++) {
        wardrobe_open(&w, MODEL_ALPHA_OPAQUE, MODEL_TINT_ON);
        w.kind.texture_set_count = sets;
        w.kind.actor_count = ACTORS;
        if (sets < 2) {
            static char log[4096];
            const noh_gl_device device = { &g->gl, &g->caps, &g->ledger, log, sizeof log };
            assert_int_equal(noh_stage_plan_make(&w.desc, &g->caps, &w.plan, NULL), NOH_OK);
            w.memory = test_aligned(NULL, (size_t)w.plan.cpu_bytes);
            assert_int_equal(
                noh_stage_init(w.memory, (size_t)w.plan.cpu_bytes, &device, &w.desc, &w.plan, &w.stage, NULL), NOH_OK);
        } else {
            wardrobe_make(&w, g);
        }
        bytes[sets] = w.plan.gpu_bytes;
        assert_true(noh_gl_ledger_bytes(&g->ledger) - noh_gl_ledger_bytes(&before) == w.plan.gpu_bytes);
        wardrobe_close(&w);
        assert_memory_equal(&before, &g->ledger, sizeof before);
    }
    assert_true(bytes[1] == bytes[0] && bytes[2] == bytes[0] + 4u);
    fixture_expect_no_errors();
}

/* Two kinds; one's mesh pack is the other's texture set: the texture is on the GPU once. */
static void textures_are_shared_between_kinds(void **state)
{
    noh_kind_desc kinds[2];
    gpu *g = fixture_gpu();
    const noh_gl_ledger before = g->ledger;
    wardrobe w;
    (void)state;
    wardrobe_open(&w, MODEL_ALPHA_OPAQUE, MODEL_TINT_ON);
    kinds[0] = w.kind;
    kinds[1] = w.kind;
    kinds[1].mesh = &w.packs[1];
    kinds[1].texture_sets = NULL;
    kinds[1].texture_set_count = 0;
    w.desc.kinds = kinds;
    w.desc.kind_count = 2;
    wardrobe_make(&w, g);
    assert_int_equal(g->ledger.textures - before.textures, 3 + 2 + 1); /* cloths, palettes, the renderer's white */
    assert_true(noh_gl_ledger_bytes(&g->ledger) - noh_gl_ledger_bytes(&before) == w.plan.gpu_bytes);
    wardrobe_close(&w);
    assert_memory_equal(&before, &g->ledger, sizeof before);
    fixture_expect_no_errors();
}

/* However sets are mixed, there is one draw for each that is worn; tints need none of their own. */
static void a_set_is_one_draw(void **state)
{
    static gpu g;
    test_random r = test_random_from(8);
    noh_null_report report;
    wardrobe w;
    (void)state;
    memset(&g, 0, sizeof g);
    assert_int_equal(gpu_open(&g, "null"), 0);
    g.caps.blend_f32 = g.caps.blend_f32_exact = 1;
    wardrobe_open(&w, MODEL_ALPHA_OPAQUE, MODEL_TINT_ON);
    wardrobe_make(&w, &g);
    for (uint32_t f = 0; f < 200; f++) {
        uint32_t worn = 0, sets = 0;
        for (uint32_t i = 0; i < ACTORS; i++) {
            const noh_appearance look = { .tint = { (uint8_t)test_random_below(&r, 256), 9, 9, 9 },
                                          .texture_set = test_random_below(&r, 3) };
            assert_int_equal(noh_actor_set_appearance(w.stage, w.actors[i], &look, NULL), NOH_OK);
            worn |= 1u << look.texture_set;
        }
        for (uint32_t i = 0; i < 3; i++) sets += worn >> i & 1u;
        noh_null_count_anew(g.context);
        assert_int_equal(noh_stage_frame(w.stage, CAST_STEP, &w.view, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_stage_draw(w.stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
        noh_null_report_of(g.context, &report);
        assert_int_equal(report.draws, sets);
        if (report.violations) fail_msg("%s", report.first);
    }
    wardrobe_close(&w);
    gpu_close(&g);
}

/* As if parts of a texture had been trimmed. */
static void set_trim(const wardrobe *w, uint32_t pack, uint32_t texture, uint32_t trim)
{
    noh_texture t;
    assert_int_equal(noh_pack_texture_at(&w->packs[pack], texture, &t, NULL), NOH_OK);
    ((noh_texture_header *)(uintptr_t)t.header)->trim = trim;
}

static void sets_are_found_and_checked(void **state)
{
    noh_appearance look = { .texture_set = 3 };
    gpu *g = fixture_gpu();
    wardrobe w;
    (void)state;
    wardrobe_open(&w, MODEL_ALPHA_OPAQUE, MODEL_TINT_ON);
    w.sets[0].suffix = "_blue";
    assert_int_equal(noh_stage_plan_make(&w.desc, &g->caps, &w.plan, &said), NOH_ERR_ARG);
    assert_non_null(strstr(said.what, "texture set"));
    w.sets[0].suffix = "";
    assert_int_equal(noh_stage_plan_make(&w.desc, &g->caps, &w.plan, &said), NOH_ERR_ARG);
    w.sets[0].suffix = "_red";
    w.kind.texture_set_count = NOH_TEXTURE_SETS_MAX + 1u;
    assert_int_equal(noh_stage_plan_make(&w.desc, &g->caps, &w.plan, &said), NOH_ERR_ARG);
    w.kind.texture_set_count = 2;
    for (uint32_t i = 0; i < 3; i++) { /* they fit again once all of them are trimmed alike */
        set_trim(&w, i == 0, i / 2u, 7);
        assert_int_equal(noh_stage_plan_make(&w.desc, &g->caps, &w.plan, &said), i < 2 ? NOH_ERR_ARG : NOH_OK);
        if (i < 2) assert_non_null(strstr(said.what, "trimmed"));
    }
    wardrobe_make(&w, g);
    assert_int_equal(noh_stage_find(w.stage, 0, NOH_NAME_TEXTURE_SET, "green"), 2);
    assert_int_equal(noh_stage_find(w.stage, 0, NOH_NAME_TEXTURE_SET, "blue"), NOH_NONE);
    assert_string_equal(noh_stage_name(w.stage, 0, NOH_NAME_TEXTURE_SET, 1), "red");
    assert_string_equal(noh_stage_name(w.stage, 0, NOH_NAME_TEXTURE_SET, 0), "");
    assert_null(noh_stage_name(w.stage, 0, NOH_NAME_TEXTURE_SET, 3));
    assert_int_equal(noh_actor_set_appearance(w.stage, w.actors[0], &look, &said), NOH_ERR_ARG);
    look.texture_set = 2;
    assert_int_equal(noh_actor_set_appearance(w.stage, w.actors[0], &look, &said), NOH_OK);
    wardrobe_close(&w);
    fixture_expect_no_errors();
}

/* ---- a lost context ---- */

static void a_lost_context_brings_the_looks_back(void **state)
{
    static uint32_t first[PIXELS], again[PIXELS];
    static gpu g;
    char message[1024];
    noh_gl_ledger before;
    canvas to;
    wardrobe w;
    (void)state;
    memset(&g, 0, sizeof g);
    if (gpu_open(&g, "egl")) test_skip("no context of the driver egl here");
    wardrobe_open(&w, MODEL_ALPHA_BLEND, MODEL_TINT_ON);
    wardrobe_make(&w, &g);
    before = g.ledger;
    assert_int_equal(canvas_open(&to, &g, WIDTH, HEIGHT), 0);
    draw(&w, &to, NULL, first);
    canvas_close(&to);
    g.platform->destroy(g.context);
    assert_int_equal(g.platform->create(NULL, &g.context, message, sizeof message), NOH_OK);
    assert_int_equal(noh_gl_api_load(&g.gl, g.platform->get_proc, g.context, NULL), NOH_OK);
    assert_int_equal(noh_stage_restore(w.stage, &said), NOH_OK);
    assert_memory_equal(&before, &g.ledger, sizeof before);
    assert_int_equal(canvas_open(&to, &g, WIDTH, HEIGHT), 0);
    draw(&w, &to, NULL, again);
    canvas_close(&to);
    assert_memory_equal(first, again, sizeof first);
    wardrobe_close(&w);
    assert_int_equal(g.gl.GetError(), GL_NO_ERROR);
    gpu_close(&g);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(actors_look_as_their_parts_drawn_by_hand),
        cmocka_unit_test(own_shaders_are_given_the_tint),
        cmocka_unit_test(own_shaders_are_given_user_values),
        cmocka_unit_test(complexions_are_the_densities_of_each_part),
        cmocka_unit_test(no_complexion_is_no_change),
        cmocka_unit_test(freckles_are_spots),
        cmocka_unit_test(every_way_of_drawing_has_the_tint),
        cmocka_unit_test(sets_take_what_is_planned),
        cmocka_unit_test(textures_are_shared_between_kinds),
        cmocka_unit_test(a_set_is_one_draw),
        cmocka_unit_test(sets_are_found_and_checked),
        cmocka_unit_test(a_lost_context_brings_the_looks_back),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
