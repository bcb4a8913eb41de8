/* test_gl_transfer.c: light by precomputed transfer on the GPU: vertices and pixels against the CPU's, a furnace. */
#include "support/light_scene.h"
#include "support/tube_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/light/pack_transfer.h"
#include "core/mesh/mesh_internal.h"
#include "deform/morph/morph_internal.h"
#include "gl/draw/gl_light_internal.h"
#include "gl/light/light_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/light.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "support/lod_fixture.h"
#include "support/skin_asset.h"

/* The same pack with transfers, to be freed; frees `bytes`. */
static uint8_t *with_transfer(uint8_t *bytes, size_t *count, uint32_t order, uint32_t flags)
{
    const transfer_settings settings = { order, flags, NULL, 0 };
    const noh_pack pack = test_open(bytes, *count);
    byte_buffer out = { NULL, 0, 0, 0 };
    model_error error;
    uint8_t *lit;
    assert_int_equal(pack_transfer(&pack, &settings, &out, &error), 0);
    lit = test_aligned(out.bytes, out.count);
    *count = out.count;
    buffer_free(&out);
    free(bytes);
    return lit;
}

/* Of the room, turned about an axis that is no coordinate axis. */
static void turned_room(double degrees, noh_lighting *lighting)
{
    const double a = degrees * PI / 180.0, s = sin(a), c = cos(a), x = 0.6, y = 0.8;
    const float turn[9] = { (float)(c + x * x * (1 - c)),
                            (float)(x * y * (1 - c)),
                            (float)(y * s),
                            (float)(x * y * (1 - c)),
                            (float)(c + y * y * (1 - c)),
                            (float)(-x * s),
                            (float)(-y * s),
                            (float)(x * s),
                            (float)c };
    noh_light light;
    noh_light_from_environment(noh_environment_at(noh_environment_find("room")), 6, &light);
    noh_lighting_make(&light, turn, 0, lighting);
}

/* ---- vertices ---- */

static const float placed[12] = { 0.36f, 0.48f, -0.8f, 0.1f, -0.8f, 0.6f, 0.0f, -0.2f, 0.48f, 0.64f, 0.6f, 0.3f };

/* What the vertex shader hands on, of every vertex: [vertex_count][4], to be freed. */
static float *captured(const tube *t, const fixture_morph *sums, draw_kind kind, const noh_lighting *lighting)
{
    static const char *const varyings[] = { "noh_v_transfer" };
    gpu *g = fixture_gpu();
    const noh_gl_api *gl = &g->gl;
    const noh_gl_morph_binding morph = noh_gl_morph_binding_of(sums->morph, 1);
    const noh_gl_skin_binding skin = noh_gl_skin_binding_of(t->skin, 1);
    const size_t bytes = 16u * (size_t)t->mesh.header->vertex_count;
    noh_gl_variant_key key = noh_gl_variant_key_of(&t->mesh, kind == RIGID ? NULL : &skin, 0, morph.is_uint,
                                                   NOH_VIEW_LIT);
    float rows[NOH_SH_COUNT_MAX][4], *out = test_zeros(bytes);
    char log[4096] = "";
    noh_gl_variant v;
    GLuint buffer;
    const void *mapped;
    key.lit = 1;
    key.two_layers = morph.layer_count == 2;
    if (noh_gl_variant_create(&(noh_gl_device){ gl, NULL, NULL, log, sizeof log }, key, NULL, varyings, 1, &v, NULL)) {
        fail_msg("%s", log);
    }
    gl->UseProgram(v.program);
    noh_lighting_pack_rest(lighting, rows);
    gl->Uniform4fv(v.u_rest, (GLsizei)NOH_SH_COUNT(t->mesh.transfer->order), rows[0]);
    gl->Uniform4fv(v.u_world, 3, placed);
    gl->Uniform4fv(v.u_normal, 3, placed); /* a rotation is its own inverse transpose */
    gl->Uniform4i(v.u_morph, morph.tile_x, morph.tile_y, morph.width_log2, morph.touched);
    noh_gl_morph_bind(gl, &morph);
    gl->BindVertexArray(t->gl.vertex_array);
    if (kind != RIGID) noh_gl_variant_skin(gl, &v, &t->mesh, &skin, 0);
    gl->GenBuffers(1, &buffer);
    gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
    gl->BufferData(GL_TRANSFORM_FEEDBACK_BUFFER, (GLsizeiptr)bytes, NULL, GL_STREAM_READ);
    gl->Enable(GL_RASTERIZER_DISCARD);
    gl->BeginTransformFeedback(GL_POINTS);
    gl->DrawArrays(GL_POINTS, 0, (GLsizei)t->mesh.header->vertex_count);
    gl->EndTransformFeedback();
    gl->Disable(GL_RASTERIZER_DISCARD);
    mapped = gl->MapBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, (GLsizeiptr)bytes, GL_MAP_READ_BIT);
    assert_non_null(mapped);
    memcpy(out, mapped, bytes);
    assert_true(gl->UnmapBuffer(GL_TRANSFORM_FEEDBACK_BUFFER));
    gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    gl->DeleteBuffers(1, &buffer);
    gl->BindVertexArray(0);
    gl->UseProgram(0);
    noh_gl_variant_delete(gl, NULL, &v);
    return out;
}

/* Poses the second copy, by these matrices. */
static float *pose(tube *t)
{
    test_random r = test_random_from(8);
    noh_skin skin;
    float *matrices;
    assert_int_equal(noh_pack_skin_at(t->mesh.pack, t->mesh.header->skin, &skin, NULL), NOH_OK);
    matrices = test_zeros(48u * (size_t)skin.header->joint_count);
    for (uint32_t j = 0; j < skin.header->joint_count; j++) {
        const float a = test_random_float(&r, -1.2f, 1.2f), s = sinf(a), c = cosf(a);
        const float turn[12] = { c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0 };
        memcpy(matrices + 12u * j, turn, sizeof turn);
    }
    noh_gl_skin_set_matrices(t->skin, 1, matrices);
    noh_gl_skin_update(t->skin);
    return matrices;
}

/* By the CPU: turned in model space, then placed. */
static float *expected(const tube *t, const float *matrices, const noh_lighting *lighting)
{
    const uint32_t count = t->mesh.header->vertex_count;
    const noh_mesh *mesh = &t->mesh;
    float *out = test_zeros(16u * (size_t)count);
    noh_morph_layers layers = test_layers(mesh);
    float *occlusion = test_zeros(4u * ((size_t)mesh->header->morph_height << mesh->header->morph_width_log2));
    noh_transfer transfer;
    assert_int_equal(noh_transfer_of(mesh, &transfer, NULL), NOH_OK);
    noh_morph_accumulate_scalar(mesh, t->morph.weights[1], &layers);
    noh_transfer_accumulate(mesh, t->morph.weights[1], occlusion);
    for (uint32_t v = 0; v < count; v++) {
        const uint32_t texel = noh_mesh_accumulation_texel(mesh, v);
        float rest[3], tangent[3], axis[3], length;
        noh_vertex vertex;
        noh_lobe lobe;
        if (matrices) {
            noh_skin_vertex(mesh, matrices, &layers, v, &vertex);
        } else {
            noh_morph_vertex(mesh, &layers, v, &vertex);
        }
        noh_transfer_lobe(mesh, &transfer, v, &lobe);
        noh_mesh_directions(mesh, v, rest, tangent);
        length = sqrtf(rest[0] * rest[0] + rest[1] * rest[1] + rest[2] * rest[2]);
        for (int k = 0; k < 3; k++) rest[k] /= length;
        noh_lobe_turn(&lobe, rest, vertex.normal);
        if (texel < mesh->header->touched_count) {
            lobe.occlusion = fminf(fmaxf(lobe.occlusion + occlusion[texel], 0.0f), 1.0f);
        }
        memcpy(axis, lobe.axis, sizeof axis);
        for (int k = 0; k < 3; k++) {
            lobe.axis[k] = placed[4 * k] * axis[0] + placed[4 * k + 1] * axis[1] + placed[4 * k + 2] * axis[2];
        }
        noh_lobe_shade(&lobe, transfer.header->order, &lighting->rest, out + 4u * (size_t)v);
        out[4u * (size_t)v + 3u] = lobe.occlusion;
    }
    free(occlusion);
    free(layers.position);
    return out;
}

/* A tube that is bent by its joints and by targets, and turned in the world, under a light that turns: every vertex is
 * lit as by the CPU, in both orders, about both axes. */
static void vertices_are_lit_as_by_the_cpu(void **state)
{
    const skin_cylinder c = { 24, 33, 9, 4, 3, 1, 2.0f, 0.35f };
    (void)state;
    for (uint32_t i = 0; i < 4; i++) {
        model *m = skin_cylinder_model(&c);
        size_t count;
        uint8_t *bytes = skin_pack_of(m, NULL, 1.0f, &count, NULL);
        double worst = 0.0, spread = 0.0;
        noh_pack pack;
        noh_mesh mesh;
        tube t;
        float *matrices;
        model_free(m);
        bytes = with_transfer(bytes, &count, i % 2 ? 6 : 4, i / 2 ? NOH_TRANSFER_ON_NORMAL : 0);
        pack = test_open(bytes, count);
        mesh = test_mesh(&pack, 0);
        assert_int_equal(mesh.header->palette_count, 1);
        tube_open_with(&t, &mesh, NOH_PALETTE_TEXTURE, NOH_MORPH_CPU, 1, NULL);
        matrices = pose(&t);
        for (int kind = RIGID; kind <= SKINNED; kind++) {
            for (int degrees = 0; degrees < 360; degrees += 100) {
                noh_lighting lighting;
                float *got, *right;
                turned_room(degrees, &lighting);
                got = captured(&t, &t.morph, (draw_kind)kind, &lighting);
                right = expected(&t, kind == RIGID ? NULL : matrices, &lighting);
                for (uint32_t k = 0; k < 4u * mesh.header->vertex_count; k++) {
                    worst = fmax(worst, fabs((double)got[k] - (double)right[k]));
                    spread = fmax(spread, fabs((double)right[k] - (double)right[k % 4u]));
                }
                free(got);
                free(right);
            }
        }
        print_message("# order %u: off by %.6f of a spread of %.2f\n", i % 2 ? 6u : 4u, worst, spread);
        assert_true(worst < 2e-4 && spread > 0.3);
        free(matrices);
        tube_close(&t);
        free(bytes);
    }
    fixture_expect_no_errors();
}

/* ---- occlusion that morphs ---- */

/* Sums of a way for the tube's weights; 0 where this driver has no such way. */
static int open_sums(fixture_morph *sums, const tube *t, noh_gl_morph_desc *desc, fixture_way way,
                     const noh_gl_caps *caps)
{
    noh_gl_morph_plan plan;
    *desc = t->morph_desc;
    desc->path = way.path;
    desc->accumulate = way.accumulate;
    if (noh_gl_morph_plan_make(desc, caps, &plan, NULL) != NOH_OK) {
        return 0;
    }
    assert_int_equal(plan.occlusion, 1);
    fixture_morph_open(sums, desc, caps);
    assert_true(noh_gl_ledger_bytes(&sums->ledger) == sums->plan.gpu_bytes);
    for (uint32_t i = 0; i < COPIES; i++) fixture_set(sums, i, t->morph.weights[i]);
    noh_gl_morph_update(sums->morph, NULL);
    return 1;
}

/* The occlusion of one way equals the CPU's: to the bit in 32 bits, where this driver blends so. */
static void check_way(const tube *t, fixture_way way, const noh_gl_caps *caps, const float *right, const float *cpu)
{
    const int blended = way.path != NOH_MORPH_CPU && way.path != NOH_MORPH_GATHER && way.path != NOH_MORPH_DIRECT;
    const int exact = way.accumulate == NOH_ACCUMULATE_F32 && (!blended || caps->blend_f32_exact);
    noh_lighting lighting;
    noh_gl_morph_desc desc;
    fixture_morph sums;
    double worst = 0.0;
    float *got;
    if (!open_sums(&sums, t, &desc, way, caps)) {
        return;
    }
    turned_room(0, &lighting);
    got = captured(t, &sums, RIGID, &lighting);
    for (uint32_t v = 0; v < t->mesh.header->vertex_count; v++) {
        worst = fmax(worst, fabs((double)got[4u * v + 3u] - (double)right[4u * v + 3u]));
        if (exact && cpu) assert_memory_equal(&got[4u * v + 3u], &cpu[4u * v + 3u], 4);
    }
    print_message("# %s: occlusion is off by %.7f\n", fixture_way_name(way), worst);
    assert_true(worst < (way.accumulate == NOH_ACCUMULATE_F32 ? 1e-6 : 2e-3));
    free(got);
    fixture_morph_close(&sums);
}

/* Targets that make a tube narrow shade it by the same bits in every way of accumulating. */
static void every_way_sums_the_same_occlusion(void **state)
{
    const skin_cylinder c = { 24, 33, 9, 4, 3, 1, 2.0f, 0.35f };
    const fixture_way first = { NOH_MORPH_CPU, NOH_ACCUMULATE_F32 }, words = { NOH_MORPH_GATHER, NOH_ACCUMULATE_F32 };
    noh_gl_caps lesser = fixture_gpu()->caps;
    const noh_gl_caps caps = lesser;
    model *m = skin_cylinder_model(&c);
    noh_gl_morph_desc desc;
    fixture_morph sums;
    noh_lighting lighting;
    float *right, *cpu, *layer, most = 0.0f;
    size_t count;
    noh_pack pack;
    noh_mesh mesh;
    uint8_t *bytes;
    tube t;
    (void)state;
    for (uint32_t k = 1; k < 3; k++) { /* a waist, and a bulge next to it */
        model_target *target = &m->meshes[0].targets[k];
        for (uint32_t v = 0; v < m->meshes[0].vertex_count; v++) {
            const float *at = m->meshes[0].position + 3u * v, y = at[1] - 0.5f * (float)k;
            const float by = expf(-20.0f * y * y) * (k == 1 ? -0.8f : 1.5f);
            target->position[3u * v] = by * at[0];
            target->position[3u * v + 2u] = by * at[2];
        }
    }
    bytes = with_transfer(skin_pack_of(m, NULL, 1.0f, &count, NULL), &count, 4, 0);
    model_free(m);
    pack = test_open(bytes, count);
    mesh = test_mesh(&pack, 0);
    tube_open_with(&t, &mesh, NOH_PALETTE_TEXTURE, NOH_MORPH_CPU, 1, NULL);
    turned_room(0, &lighting);
    right = expected(&t, NULL, &lighting);
    layer = test_zeros(4u * ((size_t)mesh.header->morph_height << mesh.header->morph_width_log2));
    noh_transfer_accumulate(&mesh, t.morph.weights[1], layer);
    for (uint32_t i = 0; i < mesh.header->touched_count; i++) most = fmaxf(most, fabsf(layer[i]));
    assert_true(most > 0.1f);
    assert_true(open_sums(&sums, &t, &desc, first, &caps));
    cpu = captured(&t, &sums, RIGID, &lighting);
    fixture_morph_close(&sums);
    for (uint32_t w = 0; w < FIXTURE_WAYS; w++) check_way(&t, fixture_ways[w], &caps, right, cpu);
    lesser.render_f32 = lesser.blend_f32 = 0;
    if (caps.render_u32) check_way(&t, words, &lesser, right, cpu);
    free(cpu);
    free(right);
    free(layer);
    tube_close(&t);
    free(bytes);
    fixture_expect_no_errors();
}

/* A lit stage of meshes with a transfer takes on the GPU what its plan says, on every path; one byte short it is not
 * made. Without the transfer it takes less. */
static void stages_take_what_they_plan(void **state)
{
    static const noh_morph_path paths[] = { NOH_MORPH_CPU,       NOH_MORPH_GATHER,  NOH_MORPH_MRT,
                                            NOH_MORPH_PER_LAYER, NOH_MORPH_LAYERED, NOH_MORPH_DIRECT };
    static __attribute__((aligned(16))) uint32_t texels[2 * 6 * 32 * 32];
    static __attribute__((aligned(16))) uint8_t scratch[3 * 4 * 2 * 6 * 32 * 32];
    const noh_reflection_desc baked = { 32, noh_reflection_of_environment, noh_environment_at(0) };
    const lod_face face = { 16, 12, 4, 0, 0 };
    gpu *g = fixture_gpu();
    noh_reflection reflection;
    const noh_gl_light_desc light = { &reflection, 0 };
    model *m = lod_face_model(&face);
    size_t count;
    uint8_t *bytes = with_transfer(test_pack_of(m, &count, NULL), &count, 4, 0);
    const noh_pack pack = test_open(bytes, count);
    const noh_kind_desc kind = { .mesh = &pack, .skeleton = NOH_NONE, .actor_count = 2 };
    (void)state;
    model_free(m);
    assert_int_equal(noh_reflection_init(texels, sizeof texels, scratch, sizeof scratch, &baked, &reflection, NULL),
                     NOH_OK);
    for (uint32_t i = 0; i < 2 * TEST_COUNT(paths); i++) {
        noh_stage_desc desc = { .kinds = &kind, .kind_count = 1, .light = &light, .gpu = &noh_stage_on_gl };
        noh_gl_ledger ledger;
        char log[1024] = "";
        const noh_gl_device device = { &g->gl, &g->caps, &ledger, log, sizeof log };
        noh_stage *stage = NULL;
        noh_stage_plan plan, without;
        noh_error error;
        uint8_t *memory;
        memset(&ledger, 0, sizeof ledger);
        desc.morph_path = (uint32_t)paths[i / 2];
        desc.halves = i % 2 ? 1 : -1;
        if (noh_stage_plan_make(&desc, &g->caps, &plan, NULL) != NOH_OK) continue;
        memory = test_aligned(NULL, (size_t)plan.cpu_bytes);
        assert_int_equal(noh_stage_init(memory, (size_t)plan.cpu_bytes - 1u, &device, &desc, &plan, &stage, &error),
                         NOH_ERR_MEMORY);
        assert_true(noh_gl_ledger_bytes(&ledger) == 0);
        assert_int_equal(noh_stage_init(memory, (size_t)plan.cpu_bytes, &device, &desc, &plan, &stage, &error), NOH_OK);
        assert_true(noh_gl_ledger_bytes(&ledger) == plan.gpu_bytes);
        noh_stage_delete(stage);
        assert_true(noh_gl_ledger_bytes(&ledger) == 0);
        desc.without_transfer = 1;
        assert_int_equal(noh_stage_plan_make(&desc, &g->caps, &without, NULL), NOH_OK);
        assert_true(without.gpu_bytes < plan.gpu_bytes);
        free(memory);
    }
    free(bytes);
    fixture_expect_no_errors();
}

/* ---- pixels ---- */

#define BALL_SIDE 33u
#define VALLEYS_SIDE 39u
enum { BALL, VALLEYS };

static double height_at(double x, double y)
{
    return 0.35 * cos(5.0 * x) * cos(4.0 * y);
}

/* Of hills and valleys, which shade each other; all of them are seen along -z, with a vertex at each second pixel. */
static void fill_valleys(model_mesh *m)
{
    for (uint32_t v = 0; v < VALLEYS_SIDE * VALLEYS_SIDE; v++) {
        const double x = pixel_at(0) + 4.0 / SIDE * ((v % VALLEYS_SIDE) - 3.0);
        const double y = pixel_at(0) + 4.0 / SIDE * ((v / VALLEYS_SIDE) - 3.0);
        const double slope[2] = { 1.75 * sin(5.0 * x) * cos(4.0 * y), 1.4 * cos(5.0 * x) * sin(4.0 * y) };
        const double length = sqrt(slope[0] * slope[0] + slope[1] * slope[1] + 1.0);
        const double at[3] = { x, y, height_at(x, y) }, normal[3] = { slope[0], slope[1], 1.0 };
        for (int k = 0; k < 3; k++) {
            m->position[3 * v + (uint32_t)k] = (float)at[k];
            m->normal[3 * v + (uint32_t)k] = (float)(normal[k] / length);
        }
    }
}

static void fill_ball(model_mesh *m)
{
    for (uint32_t v = 0; v < BALL_SIDE * BALL_SIDE; v++) {
        const double a = 2.0 * PI * (v % BALL_SIDE) / (BALL_SIDE - 1u);
        const double b = PI * (v / BALL_SIDE) / (BALL_SIDE - 1u) - PI / 2.0;
        const double at[3] = { cos(b) * sin(a), sin(b), cos(b) * cos(a) };
        for (int k = 0; k < 3; k++) m->position[3 * v + (uint32_t)k] = m->normal[3 * v + (uint32_t)k] = (float)at[k];
    }
}

static void open_scene(scene *s, const noh_environment *environment, uint32_t order, int without)
{
    static const float matte[4] = { 1.0f, 1.0f, 0.0f, 0.0f };
    const test_model_desc desc = { MESHES, BALL_SIDE, 0, 0, 1 };
    model *m = test_model(&desc);
    size_t count;
    uint8_t *bytes;
    m->materials = test_zeros(sizeof *m->materials);
    m->materials[0] = scene_material(matte);
    m->materials[0].name = model_string("ball");
    m->material_count = 1;
    fill_ball(&m->meshes[BALL]);
    fill_valleys(&m->meshes[VALLEYS]);
    for (int i = 0; i < MESHES; i++) m->meshes[i].submeshes[0].material = 0;
    bytes = test_pack_of(m, &count, NULL);
    model_free(m);
    if (!without) bytes = with_transfer(bytes, &count, order, 0);
    scene_open_pack(s, bytes, count, environment, 0, NULL);
}

/* How far pixels at vertices are from what the CPU says of these, by its transfer or by the normal alone. Returns the
 * largest of 255; *mean: of all. */
static double compare_pixels(const scene *s, const uint8_t *rgba, const noh_lighting *lighting, int by_normal,
                             double *mean)
{
    const noh_mesh *mesh = &s->meshes[VALLEYS];
    double worst = 0.0;
    uint32_t pixels = 0;
    noh_transfer transfer;
    assert_int_equal(noh_transfer_of(mesh, &transfer, NULL), NOH_OK);
    *mean = 0.0;
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        const double x = ((double)mesh->positions[3u * v] + 1.0) * SIDE / 2.0 - 0.5;
        const double y = (1.0 - (double)mesh->positions[3u * v + 1u]) * SIDE / 2.0 - 0.5;
        uint32_t column, row;
        float rgb[3];
        noh_vertex vertex;
        if (x < 0.5 || y < 0.5 || x > SIDE - 1.5 || y > SIDE - 1.5) continue;
        column = (uint32_t)(x + 0.5);
        row = (uint32_t)(y + 0.5);
        noh_mesh_vertex(mesh, v, &vertex);
        if (by_normal) {
            noh_light_irradiance(&lighting->rest, vertex.normal, rgb);
        } else {
            noh_transfer_shade(mesh, &transfer, v, vertex.normal, NULL, &lighting->rest, rgb);
        }
        for (uint32_t k = 0; k < 3; k++) {
            const double off = fabs((double)rgba[4u * (row * SIDE + column) + k] - encoded((double)rgb[k]));
            worst = fmax(worst, off);
            *mean += off;
        }
        pixels += 3;
    }
    assert_true(pixels > 2500);
    *mean /= pixels;
    return worst;
}

/* Pixels at vertices have the vertices' light, whichever way the light is turned: by the transfer, and by no normal. */
static void pixels_are_lit_as_by_the_cpu(void **state)
{
    scene s;
    (void)state;
    open_scene(&s, noh_environment_at(noh_environment_find("room")), 4, 0);
    for (int degrees = 0; degrees < 360; degrees += 120) {
        double worst, mean, plain;
        noh_lighting lighting;
        uint8_t *rgba;
        turned_room(degrees, &lighting);
        rgba = scene_draw(&s, VALLEYS, scene_identity, &lighting);
        worst = compare_pixels(&s, rgba, &lighting, 0, &mean);
        (void)compare_pixels(&s, rgba, &lighting, 1, &plain);
        print_message("# off by %.2f of 255 at most, %.2f on average; from the normals' light by %.2f\n", worst, mean,
                      plain);
        assert_true(worst <= 2.0 && plain > 10.0);
        free(rgba);
    }
    scene_close(&s);
}

/* A white ball under white light is white within 1 % at every pixel, by its transfer and without. */
static void a_furnace_is_white_with_a_transfer(void **state)
{
    (void)state;
    for (uint32_t order = 2; order <= 6; order += 2) { /* 2: none */
        noh_light light;
        noh_lighting lighting;
        uint32_t covered = 0;
        uint8_t *rgba;
        scene s;
        open_scene(&s, noh_environment_at(0), order, order == 2);
        noh_light_from_environment(noh_environment_at(0), 6, &light);
        noh_lighting_make(&light, NULL, 1, &lighting);
        rgba = scene_draw(&s, BALL, scene_identity, &lighting);
        for (uint32_t p = 0; p < SIDE * SIDE; p++) {
            const double x = pixel_at(p % SIDE), y = pixel_at(p / SIDE);
            if (x * x + y * y > 0.95 * 0.95) continue;
            covered++;
            for (uint32_t k = 0; k < 3; k++) assert_true(rgba[4u * p + k] >= encoded(0.99) - 0.5);
        }
        assert_true(covered > 2500);
        free(rgba);
        scene_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vertices_are_lit_as_by_the_cpu),     cmocka_unit_test(every_way_sums_the_same_occlusion),
        cmocka_unit_test(stages_take_what_they_plan),         cmocka_unit_test(pixels_are_lit_as_by_the_cpu),
        cmocka_unit_test(a_furnace_is_white_with_a_transfer),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
