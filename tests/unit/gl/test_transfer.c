/* test_transfer.c: transfers of meshes whose answer is known, against brute force, in packs that are damaged, cut and
 * stripped; and the errors of the source's shader. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/light/pack_transfer.h"
#include "convert/light/transfer_fit.h"
#include "convert/model/model_build.h"
#include "convert/pack/pack_strip.h"
#include "gl/light/light_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/light.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "support/lod_fixture.h"
#include "support/pack_walk.h"

/* ---- models ---- */

/* A mesh of quads with given corners; one target or none, with deltas [vertex_count][3]. */
static model *quads_model(const float *corners, uint32_t quads, const float *deltas)
{
    model *m = model_new();
    model_mesh *mesh = m->meshes = test_zeros(sizeof *m->meshes);
    model_error error;
    m->mesh_count = 1;
    mesh->name = model_string("quads");
    mesh->vertex_count = 4u * quads;
    mesh->index_count = 6u * quads;
    mesh->submesh_count = 1;
    mesh->position = test_zeros(48u * quads);
    memcpy(mesh->position, corners, 48u * quads);
    mesh->indices = test_zeros(24u * quads);
    mesh->submeshes = test_zeros(sizeof *mesh->submeshes);
    mesh->submeshes[0] = (model_submesh){ 0, 6u * quads, MODEL_NONE, 0, 4u * quads, MODEL_MISSING_NORMAL };
    for (uint32_t i = 0; i < 6u * quads; i++) {
        static const uint32_t order[6] = { 0, 1, 2, 0, 2, 3 };
        mesh->indices[i] = 4u * (i / 6u) + order[i % 6u];
    }
    mesh->normal = test_zeros(48u * quads);
    if (deltas) {
        mesh->target_count = 1;
        mesh->targets = test_zeros(sizeof *mesh->targets);
        mesh->weights = test_zeros(4);
        mesh->targets[0].name = model_string("lower");
        mesh->targets[0].position = test_zeros(48u * quads);
        memcpy(mesh->targets[0].position, deltas, 48u * quads);
        mesh->targets[0].normal = test_zeros(48u * quads);
        mesh->targets[0].has_position = mesh->targets[0].has_normal = 1;
    }
    assert_int_equal(model_complete(m, &error), 0);
    return m;
}

typedef struct lit_pack {
    uint8_t *bytes;
    size_t count;
    noh_pack pack;
    noh_mesh mesh;
    noh_transfer transfer;
} lit_pack;

/* The pack of these bytes, with transfers. */
static void add_transfer(lit_pack *p, const uint8_t *bytes, size_t count, uint32_t order, uint32_t flags)
{
    const transfer_settings settings = { order, flags, NULL, 0 };
    const noh_pack pack = test_open(bytes, count);
    byte_buffer out = { NULL, 0, 0, 0 };
    model_error error;
    assert_int_equal(pack_transfer(&pack, &settings, &out, &error), 0);
    p->bytes = test_aligned(out.bytes, out.count);
    p->count = out.count;
    p->pack = test_open(p->bytes, p->count);
    p->mesh = test_mesh(&p->pack, 0);
    assert_int_equal(noh_transfer_of(&p->mesh, &p->transfer, NULL), NOH_OK);
    buffer_free(&out);
}

static void light_model(lit_pack *p, model *m, uint32_t order, uint32_t flags)
{
    size_t count;
    uint8_t *bytes = test_pack_of(m, &count, NULL);
    add_transfer(p, bytes, count, order, flags);
    free(bytes);
    model_free(m);
}

static void face_pack(lit_pack *p, uint32_t order, uint32_t flags)
{
    const lod_face face = { 20, 16, 6, 0, 0 };
    light_model(p, lod_face_model(&face), order, flags);
}

/* ---- rays ---- */

/* The tree finds what a loop over all triangles finds. */
static void the_tree_misses_nothing(void **state)
{
    enum { COUNT = 700 };
    static float triangles[COUNT][9], rest[COUNT][9];
    test_random r = test_random_from(1);
    ray_tree tree, single;
    uint32_t hits = 0, last = 0, lone = 0;
    (void)state;
    for (uint32_t i = 0; i < COUNT; i++) {
        for (uint32_t k = 0; k < 9; k++) {
            triangles[i][k] = k < 3 ? test_random_float(&r, -1, 1)
                                    : triangles[i][k % 3] + test_random_float(&r, -0.2f, 0.2f);
            rest[i][k] = (k % 3 == i % 3 ? 0.3f : 1.0f) * triangles[i][k];
        }
    }
    assert_int_equal(ray_tree_make(rest[0], COUNT, &tree), 0);
    for (int i = 0; i < 2000; i++) {
        float origin[3], direction[3];
        ray_meeting meeting;
        int any = 0, found;
        for (int k = 0; k < 3; k++) {
            origin[k] = test_random_float(&r, -1.5f, 1.5f);
            direction[k] = i % 5 == k ? 0.0f : test_random_float(&r, -1, 1);
        }
        for (uint32_t t = 0; t < COUNT; t++) {
            assert_int_equal(ray_tree_make(triangles[t], 1, &single), 0);
            any |= ray_tree_hit(&single, origin, direction, 0.01f, &lone);
            ray_tree_free(&single);
        }
        ray_tree_fit(&tree, triangles[0]);
        found = ray_tree_nearest(&tree, origin, direction, 0.01f, &meeting);
        assert_int_equal(ray_tree_hit(&tree, origin, direction, 0.01f, &last), any);
        assert_int_equal(found, any);
        ray_tree_front(&tree, origin, direction);
        assert_int_equal(ray_tree_hit(&tree, origin, direction, 0.01f, &last), any);
        hits += (uint32_t)any;
    }
    assert_true(hits > 200 && hits < 1900);
    ray_tree_free(&tree);
}

/* ---- known answers ---- */

/* The occlusion that is stored for the vertex at a place. */
static float occlusion_at(const lit_pack *p, float x, float y, float z)
{
    for (uint32_t v = 0; v < p->mesh.header->vertex_count; v++) {
        const float *at = p->mesh.positions + 3u * (size_t)v;
        noh_lobe lobe;
        if (fabsf(at[0] - x) + fabsf(at[1] - y) + fabsf(at[2] - z) < 1e-4f) {
            noh_transfer_lobe(&p->mesh, &p->transfer, v, &lobe);
            return lobe.occlusion;
        }
    }
    fail_msg("no vertex there");
    return 0.0f;
}

/* On the floor at the distance d from a wall of height h that has no end: of the light (1 - d / sqrt(d d + h h)) / 2
 * does not arrive. The wall is open, so it reflects its albedo's share of that onto the floor. */
static void plane_and_wall(void **state)
{
    static const float distances[] = { 0.25f, 0.5f, 1.0f, 2.0f };
    int seen = 0;
    float corners[5][4][3] = { { { 0 } },
                               { { 0 } },
                               { { 0 } },
                               { { 0 } },
                               { { 0, -0.01f, -500 }, { 0, 1, -500 }, { 0, 1, 500 }, { 0, -0.01f, 500 } } };
    light_surface surface;
    light_rays rays;
    model_error error;
    model *m;
    size_t count;
    uint8_t *bytes, blocked[4096];
    static float direct[20][NOH_SH_COUNT_MAX];
    noh_pack pack;
    (void)state;
    for (int q = 0; q < 4; q++) { /* small floors, each with a corner at its distance */
        const float d = distances[q];
        const float floor[4][3] = { { d, 0, 0 }, { d, 0, 0.02f }, { d + 0.02f, 0, 0.02f }, { d + 0.02f, 0, 0 } };
        memcpy(corners[q], floor, sizeof floor);
    }
    m = quads_model(corners[0][0], 5, NULL);
    bytes = test_pack_of(m, &count, NULL);
    pack = test_open(bytes, count);
    assert_int_equal(light_surface_open(&pack, 0, &surface, &error), 0);
    assert_int_equal(light_rays_make(4096, &rays), 0);
    surface.least = 1e-3f; /* the wall's edges are long, and would make it long */
    assert_int_equal(surface.mesh.header->vertex_count, 20);
    for (uint32_t v = 0; v < 20; v++) light_rays_transfer(&rays, &surface, v, blocked, direct[v]);
    for (uint32_t v = 0, q; v < surface.mesh.header->vertex_count; v++) {
        const float *at = surface.position + 3u * (size_t)v;
        const double d = at[0];
        float transfer[NOH_SH_COUNT_MAX];
        for (q = 0; q < 4 && (at[0] != distances[q] || at[2] != 0.0f); q++) {}
        if (q < 4) {
            light_rays_transfer(&rays, &surface, v, blocked, transfer);
            assert_true(fabs(3.5449077 * (double)transfer[0] - (1.0 - 0.5 * (1.0 - d / sqrt(d * d + 1.0)))) < 0.004);
            assert_true(transfer[3] > 0.02f); /* bent away from the wall */
            light_rays_bounce(&rays, &surface, v, blocked, 0.6f, direct[0], NOH_SH_COUNT_MAX, transfer);
            assert_true(fabs(3.5449077 * (double)transfer[0] - (1.0 - 0.2 * (1.0 - d / sqrt(d * d + 1.0)))) < 0.004);
            seen++;
        }
    }
    assert_int_equal(seen, 4);
    light_rays_free(&rays);
    light_surface_close(&surface);
    free(bytes);
    model_free(m);
}

/* A ball is open everywhere: under white light it is white within 1 %, as without a transfer; about the normal too. */
static void a_ball_in_a_furnace_is_white(void **state)
{
    const lod_face ball = { 24, 20, 0, 0, 0 };
    noh_light white;
    (void)state;
    noh_light_from_environment(noh_environment_at(0), 6, &white);
    for (uint32_t flags = 0; flags < 2; flags++) {
        lit_pack p;
        model *m = lod_face_model(&ball);
        for (uint32_t i = 0; i < 3u * m->meshes[0].vertex_count; i++) {
            m->meshes[0].position[i] = 0.1f * m->meshes[0].normal[i]; /* without its bumps */
        }
        light_model(&p, m, 4u + 2u * flags, flags);
        for (uint32_t v = 0; v < p.mesh.header->vertex_count; v++) {
            noh_vertex vertex;
            float rgb[3], without[3];
            noh_mesh_vertex(&p.mesh, v, &vertex);
            noh_transfer_shade(&p.mesh, &p.transfer, v, vertex.normal, NULL, &white, rgb);
            noh_light_irradiance(&white, vertex.normal, without);
            for (int c = 0; c < 3; c++) {
                assert_true(fabsf(rgb[c] - 1.0f) < 0.01f && fabsf(without[c] - 1.0f) < 1e-5f);
            }
        }
        free(p.bytes);
    }
}

/* A lid over a floor, which a target lowers until it nearly lies on it: the floor, which the target moves too little to
 * see, darkens by the stored differences, linearly in the weight and exactly as rays say at 1. */
static void occlusion_follows_the_targets(void **state)
{
    static const float corners[2][4][3] = { { { -1, 0, -1 }, { -1, 0, 1 }, { 1, 0, 1 }, { 1, 0, -1 } },
                                            { { -3, 4, -3 }, { 3, 4, -3 }, { 3, 4, 3 }, { -3, 4, 3 } } };
    float deltas[2][4][3], weight[1] = { 1.0f };
    float *layer;
    double rest, lowered, half, rays_say = 0.0;
    light_surface surface;
    light_rays rays;
    model_error error;
    uint32_t vertex = NOH_NONE;
    noh_lobe lobe;
    lit_pack p;
    (void)state;
    memset(deltas, 0, sizeof deltas);
    for (int i = 0; i < 4; i++) {
        deltas[0][i][1] = -0.05f;
        deltas[1][i][1] = -2.5f;
    }
    light_model(&p, quads_model(corners[0][0], 2, deltas[0][0]), 6, 0);
    rest = occlusion_at(&p, 1, 0, 1);
    for (uint32_t v = 0; v < p.mesh.header->vertex_count; v++) {
        const float *at = p.mesh.positions + 3u * (size_t)v;
        if (at[0] == 1.0f && at[1] == 0.0f && at[2] == 1.0f) vertex = v;
    }
    assert_true(vertex != NOH_NONE && noh_mesh_accumulation_texel(&p.mesh, vertex) < p.mesh.header->touched_count);
    layer = test_zeros(4u * ((size_t)p.mesh.header->morph_height << p.mesh.header->morph_width_log2));
    noh_transfer_accumulate(&p.mesh, weight, layer);
    lowered = rest + layer[noh_mesh_accumulation_texel(&p.mesh, vertex)];
    weight[0] = -0.5f;
    noh_transfer_accumulate(&p.mesh, weight, layer); /* 1 - 1/2 */
    half = rest + layer[noh_mesh_accumulation_texel(&p.mesh, vertex)];
    weight[0] = 1.0f;
    assert_int_equal(light_surface_open(&p.pack, 0, &surface, &error), 0);
    assert_int_equal(light_surface_pose(&surface, weight, &error), 0);
    assert_int_equal(light_rays_make(TRANSFER_RAYS, &rays), 0);
    {
        float transfer[NOH_SH_COUNT_MAX];
        uint8_t blocked[TRANSFER_RAYS];
        light_rays_transfer(&rays, &surface, vertex, blocked, transfer);
        rays_say = 3.5449077 * (double)transfer[0];
    }
    print_message("rest %.3f, lowered %.3f (rays %.3f)\n", rest, lowered, rays_say);
    assert_true(rest > 0.45 && lowered < 0.35);
    assert_true(fabs(lowered - rays_say) < 0.003);
    assert_true(fabs(half - (rest + lowered) / 2.0) < 1e-5);
    noh_transfer_lobe(&p.mesh, &p.transfer, vertex, &lobe);
    assert_true(lobe.axis[0] > 0.05f && lobe.axis[2] > 0.05f); /* out from below the lid */
    light_rays_free(&rays);
    light_surface_close(&surface);
    free(layer);
    free(p.bytes);
}

static void set_surface(model *m, uint32_t surface)
{
    m->materials = test_zeros(sizeof *m->materials);
    m->materials[0] = model_material_default();
    m->materials[0].name = model_string("surface");
    m->materials[0].surface = surface;
    m->material_count = 1;
    m->meshes[0].submeshes[0].material = 0;
}

/* Two plates, one of them below a lid. Of an eye, which turns, what the lid covers is lit as what it leaves open; of an eye
 * that a target moves, and of skin, it stays dark. */
static void eyes_turn_out_of_the_shade(void **state)
{
    static const float corners[3][4][3] = { { { -8, 0, -1 }, { -8, 0, 1 }, { -6, 0, 1 }, { -6, 0, -1 } },
                                            { { -1, 0, -1 }, { -1, 0, 1 }, { 1, 0, 1 }, { 1, 0, -1 } },
                                            { { -3, 1, -3 }, { 3, 1, -3 }, { 3, 1, 3 }, { -3, 1, 3 } } };
    float deltas[3][4][3];
    (void)state;
    for (int i = 0; i < 36; i++) (&deltas[0][0][0])[i] = 1.0f;
    for (int kind = 0; kind < 3; kind++) {
        model *m = quads_model(corners[0][0], 3, kind == 1 ? deltas[0][0] : NULL);
        lit_pack p;
        set_surface(m, kind == 2 ? NOH_SURFACE_SKIN : NOH_SURFACE_EYE);
        light_model(&p, m, 4, 0);
        print_message("open %.3f, covered %.3f\n", occlusion_at(&p, -8, 0, 1), occlusion_at(&p, 1, 0, 1));
        assert_true(occlusion_at(&p, -8, 0, 1) > 0.8f);
        assert_true(kind == 0 ? occlusion_at(&p, 1, 0, 1) == occlusion_at(&p, -8, 0, 1)
                              : occlusion_at(&p, 1, 0, 1) < 0.3f);
        free(p.bytes);
    }
}

/* A plate below a lid, which a target takes away: teeth have the light that they have then if the target opens lips. */
static void teeth_are_lit_between_open_lips(void **state)
{
    static const float corners[2][4][3] = { { { -1, 0, -1 }, { -1, 0, 1 }, { 1, 0, 1 }, { 1, 0, -1 } },
                                            { { -3, 1, -3 }, { 3, 1, -3 }, { 3, 1, 3 }, { -3, 1, 3 } } };
    float deltas[2][4][3];
    (void)state;
    memset(deltas, 0, sizeof deltas);
    for (int i = 0; i < 4; i++) deltas[1][i][0] = 40.0f;
    for (int kind = 0; kind < 3; kind++) {
        model *m = quads_model(corners[0][0], 2, deltas[0][0]);
        lit_pack p;
        set_surface(m, kind == 2 ? NOH_SURFACE_SKIN : NOH_SURFACE_TEETH);
        m->meshes[0].targets[0].lips = kind == 1 ? 0.0f : 0.5f;
        light_model(&p, m, 4, 0);
        print_message("covered at rest: %.3f\n", occlusion_at(&p, 1, 0, 1));
        assert_true(kind == 0 ? occlusion_at(&p, 1, 0, 1) > 0.9f : occlusion_at(&p, 1, 0, 1) < 0.3f);
        free(p.bytes);
    }
}

/* An eye around teeth: all levels of the eye have one light. Vertices of the teeth lie in the eye's range, and stay
 * dark. */
static void teeth_behind_eyes_stay_dark(void **state)
{
    const lod_face face = { 24, 20, 0, 1, 0 };
    const lod_settings three = { 3, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    model *m = lod_face_model(&face);
    uint32_t first = NOH_NONE, foreign = 0;
    lod_pack from;
    lit_pack p;
    (void)state;
    m->materials[0].surface = NOH_SURFACE_EYE;
    m->materials[1].surface = NOH_SURFACE_TEETH;
    m->materials[1].alpha = MODEL_ALPHA_OPAQUE;
    lod_pack_make(m, &three, 0, &from);
    add_transfer(&p, from.bytes, from.byte_count, 4, 0);
    assert_int_equal(p.mesh.header->level_count, 3);
    for (uint32_t k = 0; k < 3; k++) {
        const noh_mesh level = noh_mesh_at_lod(&p.mesh, k);
        for (uint32_t i = 0; i < level.header->index_count; i++) {
            const uint32_t v = noh_mesh_index(&level, i);
            const uint8_t occlusion = p.transfer.records[(size_t)v * NOH_TRANSFER_RECORD_BYTES(4, 0)];
            const noh_submesh *eye = &p.mesh.submeshes[0];
            if (level.submeshes[0].index_count > i) {
                if (first == NOH_NONE) first = occlusion;
                assert_int_equal(occlusion, first);
            } else {
                assert_true(occlusion < 30);
                foreign += v >= eye->first_vertex && v < eye->first_vertex + eye->vertex_count;
            }
        }
    }
    assert_true(first > 200 && foreign > 0);
    free(p.bytes);
    lod_pack_free(&from);
    model_free(m);
}

/* ---- lobes ---- */

/* A surface that has turned under light that has turned with it looks the same: only the axis turns. */
static void turned_surfaces_under_turned_light_look_alike(void **state)
{
    static const float turn[9] = { 0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0.0f, 0.48f, 0.64f, 0.6f };
    test_random r = test_random_from(2);
    noh_light light, turned;
    (void)state;
    noh_light_from_environment(noh_environment_at(noh_environment_find("room")), 6, &light);
    noh_light_rotate(&light, turn, &turned);
    for (int i = 0; i < 500; i++) {
        noh_lobe lobe = { 0.7f, { 0, 0, 0 }, { 1, 0.7f, 0.3f, 0.05f, -0.04f, 0.02f } }, after;
        float a[3], b[3], square = 0.0f;
        for (int k = 0; k < 3; k++) lobe.axis[k] = test_random_float(&r, -1, 1);
        for (int k = 0; k < 3; k++) square += lobe.axis[k] * lobe.axis[k];
        for (int k = 0; k < 3; k++) lobe.axis[k] /= sqrtf(square);
        after = lobe;
        for (int k = 0; k < 3; k++) {
            after.axis[k] = turn[3 * k] * lobe.axis[0] + turn[3 * k + 1] * lobe.axis[1] +
                            turn[3 * k + 2] * lobe.axis[2];
        }
        noh_lobe_shade(&lobe, 6, &light, a);
        noh_lobe_shade(&after, 6, &turned, b);
        for (int c = 0; c < 3; c++) assert_true(fabsf(a[c] - b[c]) < 2e-5f);
        memcpy(after.axis, lobe.axis, sizeof after.axis); /* turning by the smallest rotation takes from to to */
        noh_lobe_turn(&after, lobe.axis, turn);
        assert_true(fabsf(after.axis[0] - turn[0]) + fabsf(after.axis[1] - turn[1]) + fabsf(after.axis[2] - turn[2]) <
                    1e-5f);
    }
}

/* Lobes fitted to lobes are the same lobes, and lose little in a record. */
static void a_lobe_fits_itself(void **state)
{
    test_random r = test_random_from(3);
    (void)state;
    for (int i = 0; i < 500; i++) {
        noh_lobe lobe = { 0.6f, { 0, 0, 0 }, { 1, 0.72f, 0.31f, 0.06f, -0.04f, 0.02f } }, fitted;
        float transfer[NOH_SH_COUNT_MAX], axis[3], square = 0.0f;
        const float none[3] = { 0, 0, 0 };
        for (int k = 0; k < 3; k++) lobe.axis[k] = test_random_float(&r, -1, 1);
        for (int k = 0; k < 3; k++) square += lobe.axis[k] * lobe.axis[k];
        for (int k = 0; k < 3; k++) lobe.axis[k] /= sqrtf(square);
        noh_sh_basis(6, lobe.axis, transfer);
        noh_sh_convolve(6, lobe.shape, transfer);
        for (int k = 0; k < 36; k++) transfer[k] *= lobe.occlusion;
        transfer_axis(transfer, none, axis);
        transfer_lobe(transfer, axis, &fitted);
        assert_true(fabsf(fitted.occlusion - 0.6f) < 1e-5f);
        for (int l = 0; l < 6; l++) assert_true(fabsf(fitted.shape[l] - lobe.shape[l]) < 1e-5f);
        for (int k = 0; k < 3; k++) assert_true(fabsf(axis[k] - lobe.axis[k]) < 1e-5f);
    }
}

/* The source's shader adds the cube of blue light times the coefficients of green: a face lit by blue alone is black
 * where green light is none, and wrong by green's amount elsewhere. */
static void blue_light_is_answered_by_blue(void **state)
{
    const noh_environment blue = { .name = "blue",
                                   .lamp_count = 1,
                                   .lamps = { { { 0, 1, 0 }, 0.3f, 1, { 0, 0, 2 } } } };
    float basis[NOH_SH_COUNT_MAX], literal = 0.0f, right = 0.0f, rgb[3];
    const noh_lobe lobe = { 1.0f, { 0, 0.8f, 0.6f }, { 1, 2.0f / 3.0f, 0.25f, 0, -1.0f / 24.0f, 0 } };
    /* coefficients by channel, as the source stores them; green here answers half as much */
    const float green_share = 0.5f;
    noh_light light;
    (void)state;
    noh_light_from_environment(&blue, 4, &light);
    noh_sh_basis(4, lobe.axis, basis);
    for (uint32_t l = 0; l < 4; l++) {
        for (uint32_t k = l * l; k < (l + 1) * (l + 1); k++) {
            literal += green_share * lobe.shape[l] * basis[k] * light.coefs[k][2];
            right += lobe.shape[l] * basis[k] * light.coefs[k][2];
        }
    }
    noh_lobe_shade(&lobe, 4, &light, rgb);
    assert_true(rgb[0] == 0.0f && rgb[1] == 0.0f);
    assert_true(fabsf(rgb[2] - right) < 1e-6f && right > 0.2f);
    assert_true(fabsf(rgb[2] - literal) > 0.1f);
}

/* ---- packs ---- */

/* Next to a wall the lobe with an axis of its own is nearer to the whole transfer than the one about the normal, in
 * both orders, and order 4 of the source is order 6 cut. */
static void bent_axes_come_nearer(void **state)
{
    enum { SIDE = 8, CORNER_QUADS = 2 * SIDE * SIDE };
    static float corners[CORNER_QUADS][4][3]; /* a floor, and a wall over its edge */
    double errors[4] = { 0, 0, 0, 0 };
    (void)state;
    for (int q = 0; q < CORNER_QUADS; q++) {
        for (int c = 0; c < 4; c++) {
            const float a = (float)(q / SIDE % SIDE + (c == 2 || c == 3)), b = (float)(q % SIDE + (c == 1 || c == 2));
            corners[q][c][0] = q < SIDE * SIDE ? a : 0.0f;
            corners[q][c][1] = q < SIDE * SIDE ? 0.0f : b;
            corners[q][c][2] = q < SIDE * SIDE ? b : a;
        }
    }
    for (int i = 0; i < 4; i++) {
        lit_pack p;
        light_rays rays;
        light_surface surface;
        model_error error;
        uint8_t blocked[TRANSFER_RAYS];
        const uint32_t order = i % 2 ? 6 : 4;
        light_model(&p, quads_model(corners[0][0], CORNER_QUADS, NULL), order, (uint32_t)i / 2u);
        assert_int_equal(p.transfer.header->order, order);
        assert_int_equal(light_rays_make(TRANSFER_RAYS, &rays), 0);
        assert_int_equal(light_surface_open(&p.pack, 0, &surface, &error), 0);
        for (uint32_t v = 0; v < p.mesh.header->vertex_count; v++) {
            float transfer[NOH_SH_COUNT_MAX], own[NOH_SH_COUNT_MAX];
            noh_lobe lobe;
            light_rays_transfer(&rays, &surface, v, blocked, transfer);
            noh_transfer_lobe(&p.mesh, &p.transfer, v, &lobe);
            noh_sh_basis(4, lobe.axis, own);
            noh_sh_convolve(4, lobe.shape, own);
            for (int k = 0; k < 16; k++) {
                const double d = (double)lobe.occlusion * own[k] - transfer[k];
                errors[i] += d * d;
            }
        }
        light_surface_close(&surface);
        light_rays_free(&rays);
        free(p.bytes);
    }
    print_message("bent %.4f %.4f, normal %.4f %.4f\n", errors[0], errors[1], errors[2], errors[3]);
    assert_true(errors[0] < 0.5 * errors[2] && errors[1] < 0.5 * errors[3]);
}

static void a_pack_without_transfer_says_so(void **state)
{
    const test_model_desc desc = { 1, 3, 1, 0, 1 };
    size_t count;
    uint8_t *bytes = test_pack(&desc, &count);
    noh_pack pack = test_open(bytes, count);
    const noh_mesh mesh = test_mesh(&pack, 0);
    noh_transfer transfer = { NULL, NULL, NULL, NULL };
    noh_error error = { NOH_OK, NULL, 0, 0 };
    (void)state;
    assert_int_equal(noh_transfer_of(&mesh, &transfer, &error), NOH_ERR_NOT_FOUND);
    assert_non_null(strstr(error.what, "--transfer"));
    assert_null(transfer.header);
    free(bytes);
}

/* The same input gives the same bytes. */
static void transfers_are_made_alike(void **state)
{
    lit_pack a, b;
    (void)state;
    face_pack(&a, 4, 0);
    face_pack(&b, 4, 0);
    assert_int_equal(a.count, b.count);
    assert_memory_equal(a.bytes, b.bytes, a.count);
    free(a.bytes);
    free(b.bytes);
}

/* A view whose headers were copied, and whose pack is another one, keeps the transfer of its own: so does the room for
 * levels that come later, which has the materials of the coarse pack. */
static void copied_headers_keep_the_transfer(void **state)
{
    const test_model_desc desc = { 1, 3, 1, 0, 1 };
    noh_transfer transfer = { NULL, NULL, NULL, NULL };
    noh_mesh_header header;
    noh_pack plain;
    noh_mesh copy;
    size_t count;
    uint8_t *bytes = test_pack(&desc, &count);
    lit_pack p;
    (void)state;
    face_pack(&p, 4, 0);
    plain = test_open(bytes, count);
    copy = p.mesh;
    header = *copy.header;
    copy.header = &header;
    copy.pack = &plain;
    assert_int_equal(noh_transfer_of(&copy, &transfer, NULL), NOH_OK);
    assert_ptr_equal(transfer.header, p.transfer.header);
    assert_ptr_equal(transfer.records, p.transfer.records);
    assert_int_equal(transfer.header->vertex_count, header.vertex_count);
    free(bytes);
    free(p.bytes);
}

/* Shade all vertices of a level at half of every target. */
static float *shaded(const noh_mesh *mesh, uint32_t *count)
{
    const noh_mesh_header *h = mesh->header;
    float *rgb = test_zeros(12u * (size_t)h->vertex_count), *weights = test_zeros(4u * (h->target_count + 1u));
    float *layer = test_zeros(4u * ((size_t)h->morph_height << h->morph_width_log2));
    noh_morph_layers layers = test_layers(mesh);
    noh_transfer transfer;
    noh_light light;
    noh_light_from_environment(noh_environment_at(3), 6, &light);
    for (uint32_t t = 0; t < h->target_count; t++) weights[t] = 0.5f;
    assert_int_equal(noh_transfer_of(mesh, &transfer, NULL), NOH_OK);
    noh_transfer_accumulate(mesh, weights, layer);
    noh_morph_accumulate(mesh, weights, &layers);
    for (uint32_t v = 0; v < h->vertex_count; v++) {
        noh_vertex vertex;
        noh_morph_vertex(mesh, &layers, v, &vertex);
        noh_transfer_shade(mesh, &transfer, v, vertex.normal, layer, &light, rgb + 3u * (size_t)v);
    }
    *count = 3u * h->vertex_count;
    free(layer);
    free(weights);
    free(layers.position);
    return rgb;
}

/* A coarser level shades its vertices to the bit as a pack that was stripped to it. */
static void levels_are_prefixes_of_transfers(void **state)
{
    const lod_face face = { 24, 20, LOD_FACE_TARGETS, 1, 0 };
    const lod_settings three = { 3, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    model *m = lod_face_model(&face);
    lod_pack from;
    lit_pack p;
    (void)state;
    lod_pack_make(m, &three, 0, &from);
    add_transfer(&p, from.bytes, from.byte_count, 4, 0);
    for (uint32_t level = 0; level < 3; level++) {
        const noh_mesh at = noh_mesh_at_lod(&p.mesh, level);
        byte_buffer out = { NULL, 0, 0, 0 };
        model_error error;
        uint8_t *bytes;
        noh_pack stripped;
        noh_mesh mesh;
        uint32_t a, b;
        float *full, *cut;
        assert_int_equal(pack_strip(&p.pack, &level, &out, &error), 0);
        bytes = test_aligned(out.bytes, out.count);
        stripped = test_open(bytes, out.count);
        mesh = test_mesh(&stripped, 0);
        assert_int_equal(mesh.header->level, level);
        full = shaded(&at, &a);
        cut = shaded(&mesh, &b);
        assert_int_equal(a, b);
        test_same_floats(cut, full, a, "light of a stripped pack");
        free(full);
        free(cut);
        free(bytes);
        buffer_free(&out);
    }
    free(p.bytes);
    lod_pack_free(&from);
    model_free(m);
}

static uint8_t *strip(const noh_pack *from, uint32_t level, noh_pack *pack)
{
    byte_buffer out = { NULL, 0, 0, 0 };
    model_error error;
    uint8_t *bytes;
    assert_int_equal(pack_strip(from, &level, &out, &error), 0);
    bytes = test_aligned(out.bytes, out.count);
    *pack = test_open(bytes, out.count);
    buffer_free(&out);
    return bytes;
}

/* Finer levels bring records that go on where the coarse pack's end: of another transfer, or of none, they would not.
 */
static void finer_packs_have_the_same_transfer(void **state)
{
    const lod_face face = { 12, 10, 2, 0, 0 };
    const lod_settings two = { 2, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    model *m = lod_face_model(&face);
    lit_pack fours, sixes;
    noh_pack plain, coarse[3];
    const noh_pack *finer[3];
    uint8_t *bytes[3];
    lod_pack from;
    (void)state;
    lod_pack_make(m, &two, 0, &from);
    plain = test_open(from.bytes, from.byte_count);
    add_transfer(&fours, from.bytes, from.byte_count, 4, 0);
    add_transfer(&sixes, from.bytes, from.byte_count, 6, 0);
    finer[0] = &plain;
    finer[1] = &fours.pack;
    finer[2] = &sixes.pack;
    for (int i = 0; i < 3; i++) bytes[i] = strip(finer[i], 1, &coarse[i]);
    for (int i = 0; i < 9; i++) {
        const noh_kind_desc kind = {
            .mesh = &coarse[i / 3], .finer = finer[i % 3], .skeleton = NOH_NONE, .actor_count = 1
        };
        const noh_stage_desc desc = { .kinds = &kind, .kind_count = 1 };
        noh_stage_plan plan;
        noh_error error = { NOH_OK, "", 0, 0 };
        const noh_result result = noh_stage_plan_make(&desc, NULL, &plan, &error);
        assert_int_equal(result, i / 3 == i % 3 ? NOH_OK : NOH_ERR_ARG);
        if (result) assert_non_null(strstr(error.what, "not the pack that its mesh was stripped from"));
    }
    for (int i = 0; i < 3; i++) free(bytes[i]);
    free(fours.bytes);
    free(sixes.bytes);
    lod_pack_free(&from);
    model_free(m);
}

/* ---- lies ---- */

static noh_transfer_header *header_of(uint8_t *bytes, const noh_pack *pack)
{
    return (noh_transfer_header *)(void *)(bytes + pack->chunks[pack->runs[NOH_CHUNK_TRANSFER].first].offset);
}

static void every_lie_is_refused(void **state)
{
    lit_pack p;
    uint8_t *bytes;
    (void)state;
    face_pack(&p, 6, 0);
    bytes = test_aligned(p.bytes, p.count);
    for (int lie = 0; lie < 16; lie++) {
        noh_transfer_header *h;
        uint8_t *chunk;
        noh_error error = { NOH_OK, NULL, 0, 0 };
        noh_pack pack;
        const float nan = NAN, below = -1.0f;
        memcpy(bytes, p.bytes, p.count);
        h = header_of(bytes, &p.pack);
        chunk = (uint8_t *)h;
        switch (lie) {
        case 0: h->mesh = 1; break;
        case 1: h->order = 5; break;
        case 2: h->flags = 2; break;
        case 3: h->flags = NOH_TRANSFER_ON_NORMAL; break;
        case 4: h->vertex_count--; break;
        case 5: h->texel_count++; break;
        case 6: h->target_count--; break;
        case 7: h->records_offset += 16; break;
        case 8: h->scales_offset -= 16; break;
        case 9: h->deltas_offset ^= 64; break;
        case 10: h->ray_count = 0; break;
        case 11: h->reserved[4] = 1; break;
        case 12: chunk[h->records_offset + 7] = 0x80; break;
        case 14: h->bounce = 256; break;
        case 13: memcpy(chunk + h->scales_offset + 4, lie % 2 ? &nan : &below, 4); break;
        default: chunk[h->deltas_offset + 1] = 0x80; break;
        }
        pack_repair(bytes, p.count);
        if (noh_pack_open(bytes, p.count, &pack, &error) != NOH_ERR_DATA) fail_msg("lie %d opens", lie);
        assert_true(error.where >= p.pack.chunks[p.pack.runs[NOH_CHUNK_TRANSFER].first].offset);
        assert_true(strlen(error.what) > 10);
    }
    memcpy(bytes, p.bytes, p.count);
    memcpy((uint8_t *)header_of(bytes, &p.pack) + header_of(bytes, &p.pack)->scales_offset, &(float){ -1.0f }, 4);
    pack_repair(bytes, p.count);
    assert_int_equal(noh_pack_open(bytes, p.count, &p.pack, NULL), NOH_ERR_DATA);
    free(bytes);
    free(p.bytes);
}

/* Two transfers of one mesh, and any flipped bit of a transfer with repaired checksums: refused, or safe to use. */
static void every_flip_is_safe(void **state)
{
    const lod_face face = { 6, 5, 2, 0, 0 };
    uint32_t opened = 0, refused = 0;
    const noh_pack_chunk *chunk;
    uint8_t *bytes;
    lit_pack p;
    (void)state;
    light_model(&p, lod_face_model(&face), 4, 0);
    bytes = test_aligned(p.bytes, p.count);
    chunk = &p.pack.chunks[p.pack.runs[NOH_CHUNK_TRANSFER].first];
    for (uint32_t bit = 0; bit < 8u * chunk->bytes; bit++) {
        noh_pack pack;
        memcpy(bytes, p.bytes, p.count);
        bytes[chunk->offset + bit / 8u] ^= (uint8_t)(1u << bit % 8u);
        assert_int_equal(noh_pack_open(bytes, p.count, &pack, NULL), NOH_ERR_DATA);
        pack_repair(bytes, p.count);
        if (noh_pack_open(bytes, p.count, &pack, NULL) == NOH_OK) {
            pack_walk(&pack, bit);
            opened++;
        } else {
            refused++;
        }
    }
    assert_true(opened > 0 && refused > 0);
    free(bytes);
    free(p.bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_tree_misses_nothing),
        cmocka_unit_test(plane_and_wall),
        cmocka_unit_test(a_ball_in_a_furnace_is_white),
        cmocka_unit_test(occlusion_follows_the_targets),
        cmocka_unit_test(eyes_turn_out_of_the_shade),
        cmocka_unit_test(teeth_are_lit_between_open_lips),
        cmocka_unit_test(teeth_behind_eyes_stay_dark),
        cmocka_unit_test(turned_surfaces_under_turned_light_look_alike),
        cmocka_unit_test(a_lobe_fits_itself),
        cmocka_unit_test(blue_light_is_answered_by_blue),
        cmocka_unit_test(bent_axes_come_nearer),
        cmocka_unit_test(a_pack_without_transfer_says_so),
        cmocka_unit_test(transfers_are_made_alike),
        cmocka_unit_test(copied_headers_keep_the_transfer),
        cmocka_unit_test(levels_are_prefixes_of_transfers),
        cmocka_unit_test(finer_packs_have_the_same_transfer),
        cmocka_unit_test(every_lie_is_refused),
        cmocka_unit_test(every_flip_is_safe),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
