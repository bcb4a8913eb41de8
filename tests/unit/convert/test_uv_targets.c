/* Targets that move texture coordinates: within the error stated of the source's, at every level, alone and among
 * others, in two palettes; through strips and the wire form to the byte; lies about them are refused; a mesh whose
 * targets move none stores none. */
#include "support/lod_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/pack/pack_strip.h"
#include "convert/pack/pack_wire.h"
#include "support/pack_walk.h"
#include "deform/morph/morph_internal.h"
#include "noh/low_core.h"

#define TARGETS 4u
#define SLIDE 0u /* moves positions and texture coordinates */
#define TURN 1u  /* moves texture coordinates alone, of half the mesh */
#define QUIET 3u /* moves positions alone */
#define TEXEL (1.0 / 2048.0)

/* What target t changes of a vertex's texture coordinates. */
static void delta_of(uint32_t t, const float uv[2], float out[2])
{
    out[0] = out[1] = 0.0f;
    if (t == SLIDE) out[0] = 0.3f, out[1] = -0.125f;
    if (t == TURN && uv[0] < 0.5f) out[0] = 0.25f - uv[1], out[1] = uv[0] - 0.75f;
    if (t == 2u) out[0] = 0.05f * sinf(9.0f * uv[1]), out[1] = 0.02f * uv[0];
}

static void add_deltas(model_mesh *mesh)
{
    for (uint32_t t = 0; t < QUIET; t++) {
        model_target *to = &mesh->targets[t];
        to->uv = test_zeros(sizeof *to->uv * 2u * mesh->vertex_count);
        for (uint32_t v = 0; v < mesh->vertex_count; v++) delta_of(t, mesh->uv + 2u * v, to->uv + 2u * v);
    }
    memset(mesh->targets[TURN].position, 0, sizeof(float) * 3u * mesh->vertex_count);
    memset(mesh->targets[TURN].normal, 0, sizeof(float) * 3u * mesh->vertex_count);
    if (mesh->targets[TURN].tangent) memset(mesh->targets[TURN].tangent, 0, sizeof(float) * 3u * mesh->vertex_count);
}

static model *face_model(void)
{
    const lod_face face = { 24, 20, TARGETS, 0, 0 };
    model *m = lod_face_model(&face);
    add_deltas(&m->meshes[0]);
    return m;
}

/* A skinned tube with texture coordinates. */
static model *tube_model(void)
{
    const skin_cylinder tube = { 8, 16, 12, 2, TARGETS, 0, 2.0f, 0.5f };
    model *m = lod_tube_model(&tube);
    model_mesh *mesh = &m->meshes[0];
    if (!mesh->uv) {
        mesh->uv = test_zeros(sizeof *mesh->uv * 2u * mesh->vertex_count);
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            mesh->uv[2u * v] = 0.5f + 0.5f * mesh->position[3u * v];
            mesh->uv[2u * v + 1u] = 0.5f * mesh->position[3u * v + 1u] + 0.01f * (float)v / (float)mesh->vertex_count;
        }
    }
    add_deltas(mesh);
    return m;
}

static void make(model *m, uint32_t levels, uint32_t palette, lod_pack *p)
{
    const lod_settings settings = { levels, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    lod_pack_make(m, &settings, palette, p);
    assert_int_equal(p->mesh.header->level_count, levels);
}

/* The largest error of texture coordinates at a level, of a weight's sum. */
static double worst_of(const noh_mesh *mesh, const float *weights)
{
    lod_layers l = lod_layers_make(mesh);
    double worst = 0.0;
    noh_morph_accumulate_scalar(mesh, weights, &l.layers);
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        noh_vertex rest, moved;
        double want[2];
        noh_mesh_vertex(mesh, v, &rest);
        noh_morph_vertex(mesh, &l.layers, v, &moved);
        for (int c = 0; c < 2; c++) want[c] = (double)rest.uv[c];
        for (uint32_t t = 0; t < TARGETS; t++) {
            float delta[2];
            delta_of(t, rest.uv, delta);
            for (int c = 0; c < 2; c++) want[c] += (double)weights[t] * (double)delta[c];
        }
        for (int c = 0; c < 2; c++) worst = fmax(worst, fabs((double)moved.uv[c] - want[c]));
    }
    lod_layers_free(&l);
    return worst;
}

/* What quantising allows: the stated error of each target, and what the bind pose's 16 bits put the formula off. */
static double bound_of(const noh_mesh *mesh, const float *weights)
{
    double bound = 4.0 / 65535.0;
    for (uint32_t t = 0; t < TARGETS; t++) {
        bound += fabs((double)weights[t]) * (double)(mesh->targets[t].position_error * mesh->header->uv_per_unit);
    }
    return bound;
}

static void check_levels(const lod_pack *p)
{
    test_random r = test_random_from(11);
    for (uint32_t k = 0; k < p->mesh.header->level_count; k++) {
        const noh_mesh level = noh_mesh_at_lod(&p->mesh, k);
        double most = 0.0;
        for (uint32_t i = 0; i < TARGETS + 8u; i++) {
            float weights[TARGETS] = { 0.0f, 0.0f, 0.0f, 0.0f };
            if (i < TARGETS)
                weights[i] = 1.0f;
            else
                test_random_weights(&r, weights, TARGETS);
            const double worst = worst_of(&level, weights);
            assert_true(worst <= bound_of(&level, weights));
            if (i < TARGETS) most = fmax(most, worst);
        }
        print_message("level %u: at most %.2f texels of 2048 with one target\n", k, most / TEXEL);
        assert_true(most < TEXEL);
    }
}

static void they_are_within_a_texel_at_every_level(void **state)
{
    lod_pack p;
    model *m = face_model();
    (void)state;
    make(m, 3, 0, &p);
    assert_true(p.mesh.header->flags & NOH_MESH_UV_TARGETS);
    assert_true(p.mesh.targets[TURN].radius > 0.0f); /* or a level would leave it out */
    check_levels(&p);
    lod_pack_free(&p);
    model_free(m);
}

static void without_levels_and_in_two_palettes(void **state)
{
    lod_pack p;
    model *m = face_model();
    (void)state;
    make(m, 1, 0, &p);
    check_levels(&p);
    lod_pack_free(&p);
    model_free(m);
    m = tube_model();
    make(m, 1, 6, &p);
    assert_true(p.mesh.header->palette_count > 1);
    check_levels(&p);
    lod_pack_free(&p);
    model_free(m);
}

/* Positions and normals are what they are without. */
static void nothing_else_changes(void **state)
{
    const float weights[TARGETS] = { 0.7f, 1.0f, -0.4f, 0.5f };
    lod_pack with, without;
    model *m = face_model(), *bare = face_model();
    (void)state;
    for (uint32_t t = 0; t < TARGETS; t++) {
        free(bare->meshes[0].targets[t].uv);
        bare->meshes[0].targets[t].uv = NULL;
    }
    make(m, 1, 0, &with);
    make(bare, 1, 0, &without);
    assert_int_equal(without.mesh.header->flags & (NOH_MESH_UV_TARGETS | NOH_MESH_TEXELS), 0);
    assert_true(without.mesh.header->uv_per_unit == 0.0f);
    assert_int_equal(with.mesh.header->vertex_count, without.mesh.header->vertex_count);
    {
        uint32_t *a = lod_pack_sources(&with), *b = lod_pack_sources(&without);
        lod_layers x = lod_layers_make(&with.mesh), y = lod_layers_make(&without.mesh);
        const double bound = 4.0 * 1e-5; /* both are off by the error asked at most */
        noh_morph_accumulate(&with.mesh, weights, &x.layers);
        noh_morph_accumulate(&without.mesh, weights, &y.layers);
        for (uint32_t v = 0; v < with.mesh.header->vertex_count; v++) {
            uint32_t w = 0;
            float p[3], q[3];
            while (b[w] != a[v]) w++;
            noh_morph_position(&with.mesh, &x.layers, v, p);
            noh_morph_position(&without.mesh, &y.layers, w, q);
            for (int c = 0; c < 3; c++) assert_true(fabs((double)p[c] - (double)q[c]) < bound);
        }
        for (uint32_t i = 0; i < 6u * TARGETS; i++) { /* boxes hold positions alone */
            assert_true(fabsf(with.mesh.target_boxes[i] - without.mesh.target_boxes[i]) < (float)bound);
        }
        lod_layers_free(&x), lod_layers_free(&y);
        free(a), free(b);
    }
    lod_pack_free(&with), lod_pack_free(&without);
    model_free(m), model_free(bare);
}

static void expect_unpacked(const byte_buffer *wire, const lod_pack *p)
{
    noh_wire_info info;
    noh_wire_desc desc;
    noh_wire *reader;
    noh_pack pack;
    void *memory = test_zeros(noh_wire_size());
    assert_int_equal(noh_wire_info_read(wire->bytes, wire->count, &info, NULL), NOH_OK);
    desc.block_bytes = info.block_bytes;
    desc.block = test_zeros(info.block_bytes);
    assert_int_equal(noh_wire_init(memory, noh_wire_size(), &desc, &reader, NULL), NOH_OK);
    assert_int_equal(noh_wire_push(reader, wire->bytes, wire->count, NULL), NOH_OK);
    assert_int_equal(noh_wire_pack(reader, &pack, NULL), NOH_OK);
    assert_int_equal(pack.byte_count, p->byte_count);
    assert_memory_equal(pack.bytes, p->bytes, p->byte_count);
    free(desc.block);
    free(memory);
}

static void strips_and_the_wire_form_keep_them(void **state)
{
    static const wire_steps exact = { NULL, 32767, 65535, 0 };
    const char *item = "1";
    const strip_levels levels = { &item, 1 };
    lod_pack p;
    model *m = face_model();
    uint32_t first[2] = { 0, 0 };
    byte_buffer cut = { NULL, 0, 0, 0 }, wire = { NULL, 0, 0, 0 };
    wire_report report;
    model_error error = { "", "" };
    (void)state;
    make(m, 3, 0, &p);
    assert_int_equal(strip_levels_of(&levels, &p.pack, first, &error), 0);
    assert_int_equal(pack_strip(&p.pack, first, &cut, &error), 0);
    {
        uint8_t *bytes = test_aligned(cut.bytes, cut.count);
        const noh_pack pack = test_open(bytes, cut.count);
        const noh_mesh level = test_mesh(&pack, 0);
        const float weights[TARGETS] = { 1.0f, 1.0f, 1.0f, 1.0f };
        assert_int_equal(level.header->level, 1);
        assert_true(worst_of(&level, weights) <= bound_of(&level, weights));
        free(bytes);
    }
    assert_int_equal(pack_wire(&p.pack, 1, &exact, &wire, &report, &error), 0);
    expect_unpacked(&wire, &p);
    buffer_free(&cut), buffer_free(&wire);
    lod_pack_free(&p);
    model_free(m);
}

/* ---- lies ---- */

static uint32_t *uv_word(const lod_pack *p, uint8_t *bytes, uint32_t vertex)
{
    const size_t at = (size_t)(p->mesh.attributes - p->pack.bytes) + p->mesh.header->attribute_stride - 8u +
                      (size_t)vertex * p->mesh.header->attribute_stride;
    return (uint32_t *)(void *)(bytes + at);
}

static noh_mesh_header *header_in(const lod_pack *p, uint8_t *bytes, uint32_t level)
{
    return (noh_mesh_header *)(void *)(bytes + ((const uint8_t *)p->mesh.header - p->pack.bytes)) + level;
}

static void lies_are_refused(void **state)
{
    static const char *const words[] = { "texel that its level does not have", "not above 0", "nothing moves any",
                                         "does not have" };
    lod_pack p;
    model *m = face_model();
    (void)state;
    make(m, 2, 0, &p);
    for (uint32_t lie = 0; lie < 4; lie++) {
        uint8_t *bytes = test_aligned(p.bytes, p.byte_count);
        noh_error error = { NOH_OK, "", 0, 0 };
        noh_pack pack;
        for (uint32_t k = 0; k < 2; k++) {
            noh_mesh_header *h = header_in(&p, bytes, k);
            if (lie == 1) h->uv_per_unit = -1.0f;
            if (lie == 2) h->flags &= ~NOH_MESH_UV_TARGETS;
            if (lie == 3) h->flags &= ~NOH_MESH_TEXELS;
        }
        if (lie == 0) *uv_word(&p, bytes, 0) = p.mesh.header->touched_count;
        pack_repair(bytes, p.byte_count);
        assert_int_equal(noh_pack_open(bytes, p.byte_count, &pack, &error), NOH_ERR_DATA);
        if (!strstr(error.what, words[lie])) fail_msg("lie %u: %s", lie, error.what);
        free(bytes);
    }
    lod_pack_free(&p);
    model_free(m);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(they_are_within_a_texel_at_every_level),
    cmocka_unit_test(without_levels_and_in_two_palettes),
    cmocka_unit_test(nothing_else_changes),
    cmocka_unit_test(strips_and_the_wire_form_keep_them),
    cmocka_unit_test(lies_are_refused),
};

TEST_MAIN(tests, NULL, NULL)
