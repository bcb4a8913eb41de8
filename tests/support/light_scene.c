#include "light_scene.h"

#include "support/renderer.h"
#include "gl/draw/gl_light_internal.h"
#include "gl/draw/gl_renderer_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const float scene_identity[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
const noh_environment scene_black = { .name = "black" };

double pixel_at(uint32_t i)
{
    return (2.0 * i + 1.0) / SIDE - 1.0;
}

static void fill_sphere(model_mesh *m, uint32_t side)
{
    for (uint32_t v = 0; v < side * side; v++) {
        const double a = 2.0 * PI * (v % side) / (side - 1u), b = PI * (v / side) / (side - 1u) - PI / 2.0;
        const double at[3] = { cos(b) * sin(a), sin(b), cos(b) * cos(a) };
        m->uv[2 * v] = (float)(0.5 + 0.5 * at[0]);
        m->uv[2 * v + 1] = (float)(0.5 + 0.5 * at[1]);
        for (int k = 0; k < 3; k++) m->position[3 * v + (uint32_t)k] = m->normal[3 * v + (uint32_t)k] = (float)at[k];
    }
}

static void fill_square(model_mesh *m, uint32_t side)
{
    for (uint32_t v = 0; v < side * side; v++) {
        const float at[3] = { 2.0f * (float)(v % side) / (float)(side - 1u) - 1.0f,
                              2.0f * (float)(v / side) / (float)(side - 1u) - 1.0f, 0.0f };
        const float normal[3] = { 0.0f, 0.0f, 1.0f };
        memcpy(m->position + 3 * v, at, sizeof at);
        memcpy(m->normal + 3 * v, normal, sizeof normal);
    }
}

model_material scene_material(const float values[4])
{
    model_material m = model_material_default();
    m.name = (char *)"ball";
    for (int k = 0; k < 3; k++) {
        m.base_color[k] = values[0];
        m.f0[k] = values[3];
    }
    m.roughness = values[1];
    m.metallic = values[2];
    m.double_sided = 1;
    return m;
}

uint8_t *scene_pack(const model_material *material, const model_texture *texture, size_t *count)
{
    const test_model_desc desc = { MESHES, 65, 0, TEST_UVS, 1 };
    model *m = test_model(&desc);
    uint8_t *bytes;
    m->materials = test_zeros(sizeof *m->materials);
    m->materials[0] = *material;
    m->material_count = 1;
    m->materials[0].name = model_string("ball");
    if (texture) {
        const size_t size = (size_t)texture->width * texture->height * 4u;
        m->textures = test_zeros(sizeof *m->textures);
        m->textures[0] = *texture;
        m->textures[0].name = model_string("picture");
        m->textures[0].rgba = test_zeros(size);
        memcpy(m->textures[0].rgba, texture->rgba, size);
        m->texture_count = 1;
    }
    fill_sphere(&m->meshes[SPHERE], 65);
    fill_square(&m->meshes[SQUARE], 71);
    for (int i = 0; i < MESHES; i++) m->meshes[i].submeshes[0].material = 0;
    bytes = test_pack_of(m, count, NULL);
    model_free(m);
    return bytes;
}

static void open_light(scene *s, const noh_gl_device *device, const noh_environment *environment, uint32_t shadow_px)
{
    static __attribute__((aligned(16))) uint32_t texels[2 * 6 * 32 * 32];
    static __attribute__((aligned(16))) uint8_t scratch[3 * 4 * 2 * 6 * 32 * 32];
    const noh_reflection_desc baked = { 32, noh_reflection_of_environment, environment };
    const noh_gl_light_desc desc = { &s->reflection, shadow_px & ~SCENE_SOFT };
    const uint64_t before = noh_gl_ledger_bytes(&s->ledger);
    assert_int_equal(noh_reflection_init(texels, sizeof texels, scratch, sizeof scratch, &baked, &s->reflection, NULL),
                     NOH_OK);
    assert_int_equal(noh_gl_light_create(device, &desc, &s->light, NULL), NOH_OK);
    assert_int_equal(noh_gl_ledger_bytes(&s->ledger) - before, noh_gl_light_bytes(&desc, s->light.is_soft));
}

void scene_open(scene *s, const model_material *material, const noh_environment *lit, uint32_t shadow_px,
                const char *own)
{
    size_t count;
    uint8_t *bytes = scene_pack(material, NULL, &count);
    scene_open_pack(s, bytes, count, lit, shadow_px, own);
}

void scene_open_pack(scene *s, uint8_t *bytes, size_t count, const noh_environment *lit, uint32_t shadow_px,
                     const char *own)
{
    const noh_gl_shader_desc shaders = { .name = "own", .fragment = own };
    noh_gl_renderer_desc d;
    char log[1024] = "";
    memset(s, 0, sizeof *s);
    memset(&d, 0, sizeof d);
    s->g = fixture_gpu();
    s->eye[2] = 1000.0f;
    s->key[2] = 1.0f;
    s->bytes = bytes;
    s->pack = test_open(s->bytes, count);
    for (uint32_t i = 0; i < MESHES; i++) {
        s->meshes[i] = test_mesh(&s->pack, i);
        assert_int_equal(noh_gl_mesh_create(&s->g->gl, &s->ledger, &s->meshes[i], &s->drawn[i], NULL), NOH_OK);
    }
    const noh_gl_caps *caps = shadow_px & SCENE_SOFT ? &s->g->caps : NULL;
    const noh_gl_device device = { &s->g->gl, caps, &s->ledger, log, sizeof log };
    if (s->pack.runs[NOH_CHUNK_TEXTURE].count) {
        noh_texture texture;
        assert_int_equal(noh_pack_texture_at(&s->pack, 0, &texture, NULL), NOH_OK);
        assert_int_equal(noh_gl_picture_create(&s->g->gl, &s->ledger, &texture, &s->picture, NULL), NOH_OK);
    }
    if (lit) open_light(s, &device, lit, shadow_px);
    d.meshes = s->meshes;
    d.mesh_count = MESHES;
    d.lit = lit != NULL;
    d.passes = own ? NOH_PASSES_COLOR : NOH_PASSES_ALL;
    d.shaders = own ? &shaders : NULL;
    if (renderer_create(&device, &d, &s->renderer, NULL)) fail_msg("%s", log);
    assert_int_equal(canvas_open(&s->canvas, s->g, SIDE, SIDE), 0);
}

void scene_close(scene *s)
{
    canvas_close(&s->canvas);
    noh_gl_renderer_delete(&s->renderer);
    if (s->light.gl) noh_gl_light_delete(&s->light);
    noh_gl_texture_delete(&s->g->gl, &s->ledger, &s->picture);
    for (int i = 0; i < MESHES; i++) noh_gl_mesh_delete(&s->g->gl, &s->ledger, &s->drawn[i]);
    assert_int_equal(noh_gl_ledger_bytes(&s->ledger), 0);
    free(s->bytes);
    fixture_expect_no_errors();
}

noh_gl_camera scene_front(void)
{
    noh_gl_camera c;
    memset(&c, 0, sizeof c);
    c.view_projection[0] = c.view_projection[5] = c.view_projection[15] = 1.0f;
    c.view_projection[10] = -0.1f;
    c.eye[2] = 1000.0f;
    return c;
}

void scene_draw_mesh(scene *s, int mesh, const float world[12], int pass)
{
    noh_gl_draw_mesh(&s->renderer, &s->drawn[mesh], world, NULL, NULL, NULL, &s->picture, pass);
}

uint8_t *scene_draw(scene *s, int mesh, const float world[12], const noh_lighting *lighting)
{
    noh_gl_camera camera = scene_front();
    uint8_t *rgba = test_zeros(SIDE * SIDE * 4);
    memcpy(camera.eye, s->eye, sizeof camera.eye);
    memcpy(camera.key, s->key, sizeof camera.key);
    canvas_begin(&s->canvas);
    if (lighting) noh_gl_renderer_light(&s->renderer, &s->light, lighting);
    noh_gl_draw_begin(&s->renderer, &camera);
    scene_draw_mesh(s, mesh, world, NOH_DRAW_OPAQUE);
    noh_gl_draw_end(&s->renderer);
    assert_int_equal(canvas_read(&s->canvas, rgba), 0);
    return rgba;
}

void key_alone(const float to_light[3], noh_lighting *lighting)
{
    noh_light none;
    memset(&none, 0, sizeof none);
    none.order = 3;
    noh_lighting_make(&none, NULL, 1, lighting);
    memcpy(lighting->key_direction, to_light, sizeof lighting->key_direction);
    for (int c = 0; c < 3; c++) lighting->key[c] = 0.9f;
}
