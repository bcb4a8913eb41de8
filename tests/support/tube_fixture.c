#include "tube_fixture.h"

#include <stdlib.h>
#include <string.h>

static const uint32_t copies = COPIES;
static const float worlds[COPIES][12] = { { 1, 0, 0, -0.5f, 0, 1, 0, 0, 0, 0, 1, 0 },
                                          { 0, 0, 1, 0.6f, 0, 1, 0, 0.2f, -1, 0, 0, -0.4f } };

const noh_gl_camera tube_camera = { { 0.8f, 0, 0, 0, 0, 0.8f, 0, 0, 0, 0, -0.3f, 0, 0, -0.8f, 0, 1 },
                                    { 0, 0.8f, 9 },
                                    { 0.6f, 0, 0.8f } };

static void set_weights(tube *t)
{
    for (uint32_t i = 0; i < COPIES; i++) {
        const float weights[3] = { 0.0f, 0.8f, i ? -0.6f : 0.4f }; /* the coarsest level leaves out the first target */
        fixture_set(&t->morph, i, weights);
    }
    noh_gl_morph_update(t->morph.morph, NULL);
}

void tube_pose(tube *t)
{
    test_random r = { 90 };
    noh_skin skin;
    uint32_t joints;
    float *matrices;
    assert_int_equal(noh_pack_skin_at(t->mesh.pack, t->mesh.header->skin, &skin, NULL), NOH_OK);
    joints = skin.header->joint_count;
    matrices = test_zeros(48u * (size_t)joints);
    for (uint32_t i = 0; i < COPIES; i++) {
        noh_gl_morph_binding morph = noh_gl_morph_binding_of(t->morph.morph, i);
        for (uint32_t e = 0; e < 12u * joints; e++) {
            matrices[e] = (e % 12u % 5u == 0 ? 1.0f : 0.0f) + test_random_float(&r, -0.08f, 0.08f);
        }
        noh_gl_skin_set_matrices(t->skin, i, matrices);
        if (t->plan.mode == NOH_PALETTE_TEXTURE) {
            assert_int_equal(noh_gl_skin_set_place(t->skin, i, worlds[i], &morph, NULL), NOH_OK);
        }
    }
    noh_gl_skin_update(t->skin);
    free(matrices);
}

void tube_open_with(tube *t, const noh_mesh *mesh, noh_palette_mode mode, noh_morph_path path, int without_tangents,
                    const noh_gl_caps *caps)
{
    gpu *g = fixture_gpu();
    noh_gl_skin_desc desc;
    memset(t, 0, sizeof *t);
    memset(&desc, 0, sizeof desc);
    t->mesh = *mesh;
    assert_int_equal(noh_gl_mesh_create(&g->gl, &t->ledger, mesh, &t->gl, NULL), NOH_OK);
    t->morph_desc.meshes = desc.meshes = &t->mesh;
    t->morph_desc.mesh_count = desc.mesh_count = 1;
    t->morph_desc.instance_counts = desc.instance_counts = &copies;
    t->morph_desc.path = path;
    t->morph_desc.without_tangents = without_tangents;
    desc.mode = mode;
    fixture_morph_open(&t->morph, &t->morph_desc, caps);
    assert_int_equal(noh_gl_skin_plan_make(&desc, &g->caps, &t->plan, NULL), NOH_OK);
    t->memory = test_aligned(NULL, (size_t)t->plan.cpu_bytes);
    assert_int_equal(noh_gl_skin_init(t->memory, (size_t)t->plan.cpu_bytes,
                                      &(noh_gl_device){ &g->gl, &g->caps, &t->ledger, NULL, 0 }, &desc, &t->skin, NULL),
                     NOH_OK);
    set_weights(t);
    tube_pose(t);
}

void tube_open(tube *t, const noh_mesh *mesh, noh_palette_mode mode)
{
    tube_open_with(t, mesh, mode, NOH_MORPH_CPU, 0, NULL);
}

void tube_close(tube *t)
{
    noh_gl_mesh_delete(&fixture_gpu()->gl, &t->ledger, &t->gl);
    noh_gl_skin_delete(t->skin);
    fixture_morph_close(&t->morph);
    free(t->memory);
    assert_true(noh_gl_ledger_bytes(&t->ledger) == 0);
}

void tube_draw(noh_gl_renderer *r, const tube *t, const noh_gl_mesh *gl, draw_kind kind, const noh_gl_lod *drawn,
               int pass)
{
    for (uint32_t i = 0; i < (kind == CROWD ? 1u : COPIES); i++) {
        noh_gl_morph_binding morph = noh_gl_morph_binding_of(t->morph.morph, i);
        noh_gl_skin_binding skin = noh_gl_skin_binding_of(t->skin, i);
        skin.influences = kind == FEWER ? 1u + i : 0;
        if (kind == CROWD) {
            noh_gl_draw_crowd(r, gl, &morph, &skin, COPIES, drawn, NULL, pass);
        } else {
            noh_gl_draw_mesh(r, gl, worlds[i], &morph, kind == RIGID ? NULL : &skin, drawn, NULL, pass);
        }
    }
}
