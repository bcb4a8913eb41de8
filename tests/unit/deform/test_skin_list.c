/* Tests of skin_list.c: vertices that more joints move than the GPU has room for, out of packs that are
 * whole, split into palettes, stripped of levels, and damaged. */
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/pack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/pack/pack_order.h"
#include "convert/pack/pack_strip.h"
#include "support/lod_fixture.h"
#include "support/pack_walk.h"
#include "support/skin_asset.h"

/* A tube of 24 joints; up to 12 of them move a vertex. */
static const skin_cylinder tube = { 12, 30, 24, 12, 2, 1, 3.0f, 0.5f };
static const skin_options all = { .influences = 32, .palette = 14 };

typedef struct listed {
    model *m;
    uint8_t *bytes;
    size_t count;
    noh_pack pack;
    noh_mesh mesh;
    noh_skin skin;
    noh_skin_list list;
    float *matrices;
} listed;

static listed make(void)
{
    listed x;
    test_random r = test_random_from(7);
    x.m = skin_cylinder_model(&tube);
    x.bytes = skin_pack_of(x.m, &all, 1.0f, &x.count, NULL);
    x.pack = test_open(x.bytes, x.count);
    x.mesh = test_mesh(&x.pack, 0);
    assert_int_equal(noh_pack_skin_at(&x.pack, x.mesh.header->skin, &x.skin, NULL), NOH_OK);
    assert_int_equal(noh_pack_skin_list(&x.pack, 0, &x.list, NULL), NOH_OK);
    x.matrices = test_zeros(48u * (size_t)x.skin.header->joint_count);
    for (uint32_t i = 0; i < x.skin.header->joint_count * 12u; i++) {
        x.matrices[i] = (i % 12u) % 5u == 0 ? 1.0f : test_random_float(&r, -0.3f, 0.3f);
    }
    return x;
}

static void unmake(listed *x)
{
    free(x->matrices);
    free(x->bytes);
    model_free(x->m);
}

/* Where the model's own weights put a vertex of the pack, in double precision. */
static void expected(const listed *x, const float rest[3], double out[3])
{
    const model_mesh *mesh = &x->m->meshes[0];
    uint32_t v = 0;
    while (memcmp(mesh->position + 3 * (size_t)v, rest, 12) != 0) v++;
    out[0] = out[1] = out[2] = 0.0;
    for (size_t i = (size_t)v * MODEL_INFLUENCES_MAX; i < (size_t)(v + 1) * MODEL_INFLUENCES_MAX; i++) {
        const float *m = x->matrices + 12 * (size_t)mesh->joints[i];
        for (int r = 0; r < 3; r++) {
            const double moved = (double)m[4 * r] * rest[0] + (double)m[4 * r + 1] * rest[1] +
                                 (double)m[4 * r + 2] * rest[2] + (double)m[4 * r + 3];
            out[r] += (double)mesh->joint_weights[i] * moved;
        }
    }
}

/* The literal cap of eight is off by centimetres here; the list is not, and touches no other vertex. */
static void any_number_of_joints_moves_a_vertex(void **state)
{
    listed x = make();
    const uint32_t count = x.mesh.header->vertex_count;
    float *capped = test_zeros(12 * (size_t)count), *full = test_zeros(12 * (size_t)count);
    float *normals = test_zeros(12 * (size_t)count), *tangents = test_zeros(16 * (size_t)count);
    double far = 0.0, worst = 0.0;
    uint32_t n = 0;
    (void)state;
    assert_true(x.mesh.header->palette_count > 1 && x.list.header->vertex_count > 100);
    assert_int_equal(x.list.header->most, 12);
    noh_skin_vertices(&x.mesh, x.matrices, NULL, 0, count, capped, normals, tangents);
    memcpy(full, capped, 12 * (size_t)count);
    assert_int_equal(noh_skin_list_vertices(&x.list, &x.mesh, x.matrices, NULL, 0, count, full, normals, tangents),
                     x.list.header->vertex_count);
    for (uint32_t v = 0; v < count; v++) {
        double right[3];
        const int is_listed = n < x.list.header->vertex_count && x.list.vertices[n] == v;
        n += (uint32_t)is_listed;
        if (!is_listed) assert_memory_equal(full + 3 * v, capped + 3 * v, 12);
        expected(&x, x.mesh.positions + 3 * (size_t)v, right);
        for (int i = 0; i < 3; i++) {
            worst = fmax(worst, fabs(right[i] - (double)full[3 * v + (uint32_t)i]));
            far = fmax(far, fabs(right[i] - (double)capped[3 * v + (uint32_t)i]));
        }
        assert_true(fabsf(normals[3 * v] * normals[3 * v] + normals[3 * v + 1] * normals[3 * v + 1] +
                          normals[3 * v + 2] * normals[3 * v + 2] - 1.0f) < 1e-5f);
    }
    print_message("%u of %u vertices: %.2g off with all joints, %.2g with eight\n", n, count, worst, far);
    assert_true(worst < 4e-6 && far > 1e-2);
    free(capped);
    free(full);
    free(normals);
    free(tangents);
    unmake(&x);
}

/* Any range gives the same; targets move what joints then move. */
static void ranges_and_targets(void **state)
{
    listed x = make();
    const uint32_t count = x.mesh.header->vertex_count;
    const float weights[2] = { 0.8f, -0.3f };
    noh_morph_layers layers = test_layers(&x.mesh);
    float *whole = test_zeros(12 * (size_t)count), *parts = test_zeros(12 * (size_t)count);
    (void)state;
    noh_morph_accumulate(&x.mesh, weights, &layers);
    (void)noh_skin_list_vertices(&x.list, &x.mesh, x.matrices, &layers, 0, count, whole, NULL, NULL);
    for (uint32_t first = 0, size = 1; first < count; first += size, size = size % 13 + 1) {
        const uint32_t n = first + size <= count ? size : count - first;
        const uint32_t written = noh_skin_list_vertices(&x.list, &x.mesh, x.matrices, &layers, first, n,
                                                        parts + 3 * (size_t)first, NULL, NULL);
        assert_int_equal(written, noh_skin_list_place(&x.list, first + n) - noh_skin_list_place(&x.list, first));
    }
    test_same_floats(parts, whole, 3 * (size_t)count, "ranges");
    (void)noh_skin_list_vertices(&x.list, &x.mesh, x.matrices, NULL, 0, count, parts, NULL, NULL);
    assert_true(memcmp(parts, whole, 12 * (size_t)count) != 0);
    free(layers.position);
    free(whole);
    free(parts);
    unmake(&x);
}

/* Built as ever, no vertex has more than eight, and the model reports what it lost. */
static void eight_is_what_was_not_asked_for(void **state)
{
    model *m = skin_cylinder_model(&tube);
    noh_skin_list list;
    noh_error error;
    size_t count;
    uint8_t *bytes = skin_pack_of(m, NULL, 1.0f, &count, NULL);
    const noh_pack pack = test_open(bytes, count);
    int told = 0;
    (void)state;
    assert_int_equal(noh_pack_skin_list(&pack, 0, &list, &error), NOH_ERR_NOT_FOUND);
    assert_non_null(strstr(error.what, "--influences"));
    for (uint32_t i = 0; i < m->warning_count; i++) told += strstr(m->warnings[i], "more than 8 joints") != NULL;
    assert_int_equal(told, 1);
    free(bytes);
    model_free(m);
}

/* Of a pack that lost its finest levels, and of one made ready for the wire, every vertex has its own joints. */
static void lists_follow_their_vertices(void **state)
{
    static const lod_settings three = { 3, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    const skin_options skin = { .influences = 32 };
    model *m = skin_cylinder_model(&tube);
    lod_pack p;
    noh_skin_list whole;
    (void)state;
    lod_pack_make_skinned(m, &three, &skin, &p);
    assert_int_equal(noh_pack_skin_list(&p.pack, 0, &whole, NULL), NOH_OK);
    for (uint32_t level = 0; level < p.mesh.header->level_count; level++) {
        byte_buffer out = { NULL, 0, 0, 0 };
        model_error error;
        noh_skin_list list;
        assert_int_equal(pack_strip(&p.pack, &level, &out, &error), 0);
        uint8_t *bytes = test_aligned(out.bytes, out.count);
        const noh_pack cut = test_open(bytes, out.count);
        const noh_mesh mesh = test_mesh(&cut, 0);
        assert_int_equal(noh_pack_skin_list(&cut, 0, &list, NULL), NOH_OK);
        const uint32_t n = list.header->vertex_count;
        assert_int_equal(n, noh_skin_list_place(&whole, mesh.header->vertex_count));
        assert_memory_equal(list.vertices, whole.vertices, 4 * (size_t)n);
        assert_memory_equal(list.weights, whole.weights, 4 * (size_t)list.header->influence_count);
        assert_memory_equal(list.joints, whole.joints, 2 * (size_t)list.header->influence_count);
        print_message("level %u: %u of %u vertices\n", level, n, mesh.header->vertex_count);
        free(bytes);
        buffer_free(&out);
    }
    byte_buffer out = { NULL, 0, 0, 0 };
    model_error error;
    assert_int_equal(pack_order(&p.pack, &out, &error), 0);
    uint8_t *bytes = test_aligned(out.bytes, out.count);
    const noh_pack ordered = test_open(bytes, out.count);
    const noh_mesh mesh = test_mesh(&ordered, 0);
    noh_skin_list list;
    assert_int_equal(noh_pack_skin_list(&ordered, 0, &list, NULL), NOH_OK);
    for (uint32_t i = 0; i < list.header->vertex_count; i++) {
        assert_memory_equal(mesh.positions + 3 * (size_t)list.vertices[i],
                            p.mesh.positions + 3 * (size_t)whole.vertices[i], 12);
    }
    free(bytes);
    buffer_free(&out);
    lod_pack_free(&p);
    model_free(m);
}

/* ---- lies ---- */

static listed good;

static int make_good(void **state)
{
    (void)state;
    good = make();
    return 0;
}

static int unmake_good(void **state)
{
    (void)state;
    unmake(&good);
    return 0;
}

typedef struct forged {
    uint8_t *bytes;
    size_t count;
    noh_pack_chunk *chunk;
    noh_influences_header *h;
    uint32_t *vertices, *firsts;
    float *weights;
    uint16_t *joints;
} forged;

static void forge(forged *f)
{
    f->count = good.count;
    f->bytes = test_aligned(good.bytes, f->count);
    f->chunk = pack_find(f->bytes, NOH_TAG_INFLUENCES);
    assert_non_null(f->chunk);
    f->h = (noh_influences_header *)(void *)(f->bytes + f->chunk->offset);
    f->vertices = (uint32_t *)(void *)((uint8_t *)f->h + f->h->vertices_offset);
    f->firsts = (uint32_t *)(void *)((uint8_t *)f->h + f->h->firsts_offset);
    f->weights = (float *)(void *)((uint8_t *)f->h + f->h->weights_offset);
    f->joints = (uint16_t *)(void *)((uint8_t *)f->h + f->h->joints_offset);
}

#define FORGERIES(X)                                                    \
    X(mesh_missing, "names a mesh that is missing", f->h->mesh = 1)     \
    X(reserved, "reserved", f->h->reserved[7] = 1)                      \
    X(more_vertices, "begin", f->h->vertex_count += 8)                  \
    X(vertices_overflow, "past", f->h->vertex_count = 0xffffffffu)      \
    X(influences_overflow, "past", f->h->influence_count = 0xfffffff0u) \
    X(elsewhere, "begin", f->h->joints_offset -= 16)                    \
    X(most, "differs from the most", f->h->most = 32)                   \
    X(vertex_past, "not its mesh's", f->vertices[0] = 100000)           \
    X(vertex_twice, "ascending", f->vertices[3] = f->vertices[2])       \
    X(first, "begin at 0", f->firsts[0] = 1)                            \
    X(backward, "no joints", f->firsts[2] = f->firsts[1])               \
    X(far, "no joints", f->firsts[2] = 0x80000000u)                     \
    X(weight_nan, "weight of", f->weights[5] = (float)NAN)              \
    X(weight_zero, "weight of", f->weights[5] = 0.0f)                   \
    X(weight_huge, "weight of", f->weights[5] = 3e38f)                  \
    X(weight_more, "sum to 1", f->weights[5] += 0.01f)                  \
    X(joint_missing, "joint that its skin lacks", f->joints[9] = 24)

#include "support/forgeries_template.h"

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_number_of_joints_moves_a_vertex),
        cmocka_unit_test(ranges_and_targets),
        cmocka_unit_test(eight_is_what_was_not_asked_for),
        cmocka_unit_test(lists_follow_their_vertices),
        cmocka_unit_test_setup_teardown(lies_are_refused, make_good, unmake_good),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
