/* Accumulators without a layer of tangents, drawn: where no shader looks at tangents, the pictures equal three
 * layers' on every path; a tangent is then the bind pose's, turned with the normal. */
#include "support/tube_fixture.h"

#include "support/skin_asset.h"
#include "support/renderer.h"

#include <stdlib.h>
#include <string.h>

#define SIDE 128u

static uint8_t *picture(const tube *t, draw_kind kind, noh_debug_view view)
{
    const noh_gl_api *gl = &fixture_gpu()->gl;
    const int is_uint = noh_gl_morph_binding_of(t->morph.morph, 0).is_uint;
    noh_gl_renderer_desc desc;
    noh_gl_renderer r;
    fixture_frame f;
    uint8_t *rgba;
    memset(&desc, 0, sizeof desc);
    desc.meshes = &t->mesh;
    desc.mesh_count = 1;
    desc.palettes = NOH_PALETTE_TEXTURE;
    desc.crowds = desc.fewer_influences = 1;
    desc.layers_uint = is_uint;
    desc.without_tangents = t->morph_desc.without_tangents;
    desc.view = view;
    fixture_frame_open(&f, SIDE);
    assert_int_equal(renderer_create(&(noh_gl_device){ gl, NULL, &f.ledger, NULL, 0 }, &desc, &r, NULL), NOH_OK);
    noh_gl_draw_begin(&r, &tube_camera);
    tube_draw(&r, t, &t->gl, kind, NULL, NOH_DRAW_OPAQUE);
    noh_gl_draw_end(&r);
    rgba = fixture_frame_read(&f);
    noh_gl_renderer_delete(&r);
    fixture_frame_close(&f);
    fixture_expect_no_errors();
    return rgba;
}

static uint32_t covered(const uint8_t *rgba)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        count += rgba[4u * i + 3u] != 0;
    }
    return count;
}

static void check_path(const noh_mesh *mesh, noh_morph_path path, const noh_gl_caps *caps)
{
    tube with, without;
    tube_open_with(&with, mesh, NOH_PALETTE_TEXTURE, path, 0, caps);
    tube_open_with(&without, mesh, NOH_PALETTE_TEXTURE, path, 1, caps);
    assert_true(without.morph.plan.layer_bytes < with.morph.plan.layer_bytes || !with.morph.plan.layer_format);
    for (int kind = RIGID; kind <= CROWD; kind++) {
        for (int view = NOH_VIEW_LIT; view <= NOH_VIEW_TANGENT; view++) {
            uint8_t *three = picture(&with, (draw_kind)kind, (noh_debug_view)view);
            uint8_t *two = picture(&without, (draw_kind)kind, (noh_debug_view)view);
            assert_true(covered(three) > SIDE * SIDE / 50u);
            if (view == NOH_VIEW_TANGENT) { /* the targets do move tangents */
                assert_memory_not_equal(two, three, SIDE * SIDE * 4u);
            } else {
                assert_memory_equal(two, three, SIDE * SIDE * 4u);
            }
            free(three);
            free(two);
        }
    }
    tube_close(&with);
    tube_close(&without);
}

/* A tube whose targets move tangents, too. */
static uint8_t *tube_bytes(size_t *count)
{
    const skin_cylinder c = { 24, 33, 9, 4, 3, 1, 2.0f, 0.35f };
    model *m = skin_cylinder_model(&c);
    const model_mesh *mesh = &m->meshes[0];
    uint8_t *bytes;
    for (uint32_t t = 0; t < mesh->target_count; t++) {
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            mesh->targets[t].tangent[3 * v + 1] = mesh->targets[t].position[3 * v] != 0.0f ? 0.6f : 0.0f;
        }
    }
    bytes = skin_pack_of(m, NULL, 1.0f, count, NULL);
    model_free(m);
    return bytes;
}

static void only_tangents_differ(void **state)
{
    static const noh_morph_path paths[] = { NOH_MORPH_LAYERED, NOH_MORPH_MRT, NOH_MORPH_PER_LAYER,
                                            NOH_MORPH_GATHER,  NOH_MORPH_CPU, NOH_MORPH_DIRECT };
    const noh_gl_caps caps = fixture_gpu()->caps;
    noh_gl_caps lesser = caps;
    size_t count;
    uint8_t *bytes = tube_bytes(&count);
    noh_pack pack = test_open(bytes, count);
    noh_mesh mesh = test_mesh(&pack, 0);
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(paths); i++) {
        noh_gl_morph_desc desc = { .meshes = &mesh, .mesh_count = 1, .path = paths[i] };
        noh_gl_morph_plan plan;
        if (noh_gl_morph_plan_make(&desc, &caps, &plan, NULL) == NOH_OK) {
            check_path(&mesh, paths[i], &caps);
        }
    }
    lesser.render_f32 = lesser.blend_f32 = 0;
    if (caps.render_u32) {
        check_path(&mesh, NOH_MORPH_GATHER, &lesser);
    }
    free(bytes);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(only_tangents_differ),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
