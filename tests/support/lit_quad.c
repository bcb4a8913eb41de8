#include "lit_quad.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/math_internal.h"
#include "convert/model/model_build.h"
#include "support.h"
#include "draw/camera.h"
#include "gpu/canvas.h"
#include "renderer.h"

/* Half a turn about y with a scale that differs by axis; the camera looks along +z, and from x and y the scales are
 * taken out again, so that the quad fills the picture. */
lit_quad lit_quad_of(void)
{
    const float scale[3] = { 0.5f, 2.0f, 1.0f }, key[3] = { 0.95f, -0.2f, -0.24f };
    lit_quad q;
    memset(&q, 0, sizeof q);
    for (int i = 0; i < 3; i++) {
        q.world[5 * i] = i == 1 ? scale[i] : -scale[i];
        q.camera.key[i] = key[i] / sqrtf(noh_dot3(key, key));
        q.base[i] = 0.8f - 0.2f * (float)i;
    }
    q.base[3] = 1.0f;
    q.camera.view_projection[0] = -1.0f / scale[0];
    q.camera.view_projection[5] = 1.0f / scale[1];
    q.camera.view_projection[10] = 0.1f;
    q.camera.view_projection[15] = 1.0f;
    q.camera.eye[2] = -4.0f;
    q.normal_scale = q.occlusion_strength = 1.0f;
    q.metallic = 0.25f;
    q.roughness = 0.5f;
    q.cutoff = 0.5f;
    return q;
}

/* The unit normal at x = -1..1 of the quad is the mix of those at its ends, made unit again. */
static void quad_normal(float x, float out[3])
{
    out[0] = 0.96f * x;
    out[1] = 0.168f;
    out[2] = 0.224f;
}

/* ---- drawing ---- */

static void fill_material(const lit_quad *q, model *m)
{
    model_material *material = m->materials = test_zeros(sizeof *m->materials);
    *material = model_material_default();
    m->material_count = 1;
    material->name = model_string("quad");
    material->base_color_texture = q->picture || q->base_map ? 1 : MODEL_NONE;
    memcpy(material->base_color, q->base, sizeof q->base);
    material->metallic = q->metallic;
    material->roughness = q->roughness;
    material->alpha = q->alpha;
    material->alpha_cutoff = q->cutoff;
    material->double_sided = (uint8_t)(q->double_sided != 0);
    material->unlit = (uint8_t)(q->unlit != 0);
    material->normal_scale = q->normal_scale;
    material->occlusion_strength = q->occlusion_strength;
    memcpy(material->emissive, q->emissive, sizeof q->emissive);
    if (q->normal_map) material->normal_texture = 0;
    if (q->surface_map) material->surface_texture = 1;
    if (q->specular_map) material->specular_texture = 2;
    material->specular_roughness = (uint8_t)(q->specular_roughness != 0);
    material->f90_loss = q->f90_loss;
    for (int i = 0; i < 3 && q->f0 > 0.0f; i++) material->f0[i] = q->f0;
    m->meshes[0].submeshes[0].material = 0;
}

/* The normal map, the surface map, and the specular map. */
static void fill_maps(const lit_quad *q, model *m)
{
    static const uint8_t none[4] = { 128, 128, 255, 255 };
    static const char *const names[3] = { "normal", "surface", "specular" };
    static const model_texture_use uses[3] = { MODEL_TEXTURE_NORMAL, MODEL_TEXTURE_DATA, MODEL_TEXTURE_COLOR };
    const uint8_t *const texels[3] = { q->normal_map, q->surface_map, q->specular_map };
    m->textures = test_zeros(3 * sizeof *m->textures);
    m->texture_count = 3;
    for (int i = 0; i < 3; i++) {
        model_texture *t = &m->textures[i];
        t->name = model_string(names[i]);
        t->width = t->height = 1;
        t->rgba = test_zeros(4);
        memcpy(t->rgba, texels[i] ? texels[i] : none, 4);
        t->use = uses[i];
        t->alpha_is_data = i == 2;
    }
    if (!q->normal_map) return;
    m->meshes[0].tangent = test_zeros(16 * sizeof(float));
    for (int v = 0; v < 4; v++) memcpy(m->meshes[0].tangent + 4 * v, q->tangent, sizeof q->tangent);
}

/* Two textures: a grey one that nothing uses, and the quad's. */
static void fill_textures(const lit_quad *q, model *m)
{
    m->textures = test_zeros(2 * sizeof *m->textures);
    m->texture_count = 2;
    for (int i = 0; i < 2; i++) {
        model_texture *t = &m->textures[i];
        t->name = model_string(i ? "picture" : "grey");
        t->width = 2;
        t->height = 1;
        t->rgba = test_zeros(8);
        memset(t->rgba, 99, 8);
        if (i) memcpy(t->rgba, q->picture, 8);
        t->wrap_s = t->wrap_t = 33071;
        t->mag_filter = t->min_filter = 9728;
    }
}

/* The texture in the place of the second of two. */
static void fill_base_map(const lit_quad *q, model *m)
{
    const lit_quad small = { .picture = (const uint8_t[8]){ 0 } };
    const size_t bytes = 4u * (size_t)q->base_map->width * q->base_map->height;
    model_texture *t;
    fill_textures(&small, m);
    t = &m->textures[1];
    free(t->rgba);
    free(t->name);
    *t = *q->base_map;
    t->name = model_string("base");
    t->rgba = test_zeros(bytes);
    memcpy(t->rgba, q->base_map->rgba, bytes);
}

static float *copied(const float *values, size_t count)
{
    float *copy = test_zeros(count * sizeof *copy);
    memcpy(copy, values, count * sizeof *copy);
    return copy;
}

static uint8_t *quad_pack(const lit_quad *q, size_t *count)
{
    const test_model_desc desc = { 1, 2, 0, 0, 1 };
    model *m = test_model(&desc);
    model_mesh *mesh = &m->meshes[0];
    uint8_t *bytes;
    fill_material(q, m);
    if (q->picture) fill_textures(q, m);
    if (q->base_map) fill_base_map(q, m);
    if (q->normal_map || q->surface_map || q->specular_map) fill_maps(q, m);
    if (q->uv) mesh->uv = copied(q->uv, 8);
    if (q->color) mesh->color = copied(q->color, 16);
    for (uint32_t v = 0; v < 4; v++) {
        const float x = v % 2 ? 1.0f : -1.0f, y = v / 2 ? 1.0f : -1.0f, at[3] = { x, y, 0.0f };
        memcpy(mesh->position + 3 * v, at, sizeof at);
        quad_normal(x, mesh->normal + 3 * v);
    }
    bytes = test_pack_of(m, count, NULL);
    model_free(m);
    return bytes;
}

static void draw(gpu *g, const lit_quad *q, const noh_pack *pack, noh_gl_ledger *ledger, int pass)
{
    noh_mesh mesh = test_mesh(pack, 0);
    noh_gl_renderer_desc desc;
    noh_gl_renderer renderer;
    noh_gl_mesh drawn;
    noh_gl_texture pictures[3];
    char log[1024] = "";
    memset(&desc, 0, sizeof desc);
    memset(pictures, 0, sizeof pictures);
    desc.meshes = &mesh;
    desc.mesh_count = 1;
    desc.shaders = q->shaders;
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_TEXTURE].count; i++) {
        noh_texture texture;
        noh_pack_texture_at(pack, i, &texture, NULL);
        assert_int_equal(noh_gl_picture_create(&g->gl, ledger, &texture, &pictures[i], NULL), NOH_OK);
    }
    assert_int_equal(noh_gl_mesh_create(&g->gl, ledger, &mesh, &drawn, NULL), NOH_OK);
    assert_int_equal(renderer_create(&(noh_gl_device){ &g->gl, NULL, ledger, log, sizeof log }, &desc, &renderer, NULL),
                     NOH_OK);
    noh_gl_draw_begin(&renderer, &q->camera);
    noh_gl_draw_mesh(&renderer, &drawn, q->world, NULL, NULL, NULL, pictures, pass);
    noh_gl_draw_end(&renderer);
    noh_gl_renderer_delete(&renderer);
    noh_gl_mesh_delete(&g->gl, ledger, &drawn);
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_TEXTURE].count; i++) {
        noh_gl_texture_delete(&g->gl, ledger, &pictures[i]);
    }
}

uint8_t *lit_quad_draw(gpu *g, const lit_quad *q, int pass)
{
    size_t count;
    uint8_t *bytes = quad_pack(q, &count), *rgba = test_zeros(LIT_QUAD_SIDE * LIT_QUAD_SIDE * 4u);
    noh_pack pack = test_open(bytes, count);
    noh_gl_ledger ledger;
    canvas c;
    memset(&ledger, 0, sizeof ledger);
    assert_int_equal(canvas_open(&c, g, LIT_QUAD_SIDE, LIT_QUAD_SIDE), 0);
    canvas_begin(&c);
    draw(g, q, &pack, &ledger, pass);
    assert_int_equal(canvas_read(&c, rgba), 0);
    canvas_close(&c);
    free(bytes);
    return rgba;
}

const uint8_t *lit_quad_at(const uint8_t *rgba, uint32_t column)
{
    return rgba + 4u * (LIT_QUAD_SIDE / 2u * LIT_QUAD_SIDE + column);
}

int lit_quad_is_background(const uint8_t *pixel)
{
    static const uint8_t background[3] = { CANVAS_BACKGROUND_SRGB };
    for (int i = 0; i < 3; i++) {
        if (abs(pixel[i] - background[i]) > 1) { /* each driver rounds it differently */
            return 0;
        }
    }
    return 1;
}

/* ---- the closed form ---- */

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void unit(double v[3])
{
    const double length = sqrt(dot(v, v));
    for (int i = 0; i < 3; i++) {
        v[i] /= length;
    }
}

/* GGX with Smith's visibility (Walter et al. 2007). */
static double highlight(double nh, double nl, double nv, double roughness)
{
    const double a = roughness * roughness, d = nh * nh * (a * a - 1.0) + 1.0, k = 0.5 * a;
    return a * a / (3.14159265 * d * d) * 0.25 / ((nl * (1.0 - k) + k) * (nv * (1.0 - k) + k));
}

/* The cosines that the light depends on. */
typedef struct cosines {
    double lit, wrapped, nv, nh, edge, up;
} cosines;

/* n: of the maps; surface: without them */
static cosines cosines_of(const lit_quad *q, const double n[3], const double surface[3], const double at[3], int held)
{
    const double key[3] = { (double)q->camera.key[0], (double)q->camera.key[1], (double)q->camera.key[2] };
    const double nl = dot(n, key);
    double v[3], h[3];
    cosines c;
    for (int i = 0; i < 3; i++) {
        v[i] = (double)q->camera.eye[i] - at[i];
    }
    unit(v);
    for (int i = 0; i < 3; i++) {
        h[i] = key[i] + v[i];
    }
    unit(h);
    c.lit = held ? fmax(nl, 0.0) : nl;
    c.wrapped = held ? fmax((nl + 0.18) / 1.18, 0.0) : nl;
    c.nv = fmax(fmax(dot(n, v), q->normal_map ? 0.5 * fabs(dot(surface, v)) : 0.0), 1e-3);
    c.nh = fmax(dot(n, h), 0.0);
    c.edge = pow(1.0 - fmax(dot(h, v), 0.0), 5.0);
    c.up = 0.5 * n[1] + 0.5;
    return c;
}

static double shade(const lit_quad *q, const cosines *c, int i)
{
    static const double warm[3] = { 1.02, 0.98, 0.92 }, ground[3] = { 0.23, 0.20, 0.18 },
                        above[3] = { 0.50, 0.54, 0.60 };
    static const uint8_t full[4] = { 255, 255, 255, 255 };
    static const uint8_t plain[4] = { 255, 255, 255, 255 };
    const uint8_t *map = q->surface_map ? q->surface_map : full;
    const uint8_t *specular = q->specular_map ? q->specular_map : plain;
    const double in_alpha = specular[3] / 255.0, weight = q->specular_roughness ? 1.0 : in_alpha;
    const double dull = (1.0 - (double)q->f90_loss) * weight * (q->surface_map ? map[3] / 255.0 : 1.0);
    const double albedo = (double)q->base[i], metallic = (double)q->metallic * map[2] / 255.0;
    const double rough = fmax((double)q->roughness * map[1] / 255.0 * (q->specular_roughness ? in_alpha : 1.0), 0.08);
    /* KHR_materials_specular: min(f0 * colour, 1) * weight straight on, the weight at grazing angles; f0 as the pack has
     * it is over the factor of the weight */
    const double factor = 1.0 - (double)q->f90_loss, plain_f0 = q->f0 > 0.0f ? (double)q->f0 : 0.04;
    const double colored = factor > 0.0 ? plain_f0 / factor * decoded(specular[i]) : 0.0;
    const double dielectric = fmin(colored, 1.0) * dull, f90 = dull + (1.0 - dull) * metallic;
    const double open = 1.0 + (double)q->occlusion_strength * (map[0] / 255.0 - 1.0);
    const double f0 = dielectric + (albedo - dielectric) * metallic,
                 sky = open * (ground[i] + (above[i] - ground[i]) * c->up);
    double color = albedo * (1.0 - metallic) * (warm[i] * c->wrapped * fabs(c->wrapped) + 0.62 * sky);
    color += (f0 + (f90 - f0) * c->edge) * highlight(c->nh, fmax(c->lit, 0.0), c->nv, rough) * c->lit * 2.6;
    color += f0 * sky * (0.7 - 0.4 * rough) * (0.15 + 0.85 * metallic);
    color += (double)q->emissive[i];
    return color + 0.10 * sky * pow(1.0 - c->nv, 3.0) * (1.0 - 0.6 * rough);
}

static float x_of(const lit_quad *q, uint32_t column)
{
    const float screen = (2.0f * (float)column + 1.0f) / (float)LIT_QUAD_SIDE - 1.0f;
    return screen / (q->camera.view_projection[0] * q->world[0]);
}

/* The map's vector in the frame of a unit normal. */
static void map_normal(const lit_quad *q, lit_quad_normals by, double n[3])
{
    const double determinant = (double)(q->world[0] * q->world[5] * q->world[10]);
    const double hand = (double)q->tangent[3] * (determinant < 0.0 && by != FRAME_NOT_MIRRORED ? -1.0 : 1.0);
    double t[3], b[3], v[3], along = 0.0;
    for (int i = 0; i < 3; i++) {
        v[i] = ((double)q->normal_map[i] - 128.0) / 127.0 * (i < 2 ? (double)q->normal_scale : 1.0);
        t[i] = (double)((by == FRAME_IN_OBJECT ? 1.0f : q->world[5 * i]) * q->tangent[i]);
        along += t[i] * n[i];
    }
    for (int i = 0; i < 3 && by != FRAME_AS_IT_IS; i++) t[i] -= along * n[i];
    unit(t);
    for (int i = 0; i < 3; i++) {
        b[i] = hand * (n[(i + 1) % 3] * t[(i + 2) % 3] - n[(i + 2) % 3] * t[(i + 1) % 3]);
    }
    unit(v);
    for (int i = 0; i < 3; i++) n[i] = v[0] * t[i] + v[1] * b[i] + v[2] * n[i];
    unit(n);
}

void lit_quad_normal(const lit_quad *q, uint32_t column, lit_quad_normals by, double n[3])
{
    const double determinant = (double)(q->world[0] * q->world[5] * q->world[10]);
    float normal[3];
    quad_normal(x_of(q, column), normal);
    for (int i = 0; i < 3; i++) { /* NOT_UNIT: by the cofactors, with the length that they give */
        const double axis = (double)q->world[5 * i];
        const int as_it_is = by == NORMALS_BY_NOTHING || by == FRAME_IN_OBJECT;
        n[i] = (double)normal[i] * (by == NORMALS_BY_MATRIX ? axis : as_it_is ? 1.0 : fabs(determinant) / axis);
    }
    if (by != NORMALS_NOT_UNIT) {
        unit(n);
    }
    if (q->normal_map) map_normal(q, by, n);
}

void lit_quad_pixel(const lit_quad *q, uint32_t column, lit_quad_normals by, int held, double out[3])
{
    const double at[3] = { (double)(q->world[0] * x_of(q, column)), 0.0, 0.0 };
    double n[3], surface[3];
    cosines c;
    lit_quad bare = *q;
    bare.normal_map = NULL;
    lit_quad_normal(q, column, by, n);
    lit_quad_normal(&bare, column, NORMALS_BY_INVERSE_TRANSPOSE, surface);
    for (int i = 0; q->world[10] > 0.0f && i < 3; i++) { /* seen from behind: the normal of that side */
        n[i] = -n[i];
    }
    c = cosines_of(q, n, surface, at, held);
    for (int i = 0; i < 3; i++) {
        out[i] = encoded(shade(q, &c, i));
    }
}
