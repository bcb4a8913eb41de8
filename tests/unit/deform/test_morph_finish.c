/* Finished vertices: every instruction set gives the scalar bits, whatever the mesh, the range and the deltas; they are
 * noh_morph_vertex's as closely as their formats allow; what nothing moves has the pack's own words. */
#include "support/support.h"
#include "deform/morph/morph_internal.h"
#include "deform/morph/morph_finish_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "noh/low_core.h"

/* ---- meshes of vertices, made without the converter, in memory that ends where they do ---- */

typedef struct loose_mesh {
    noh_mesh mesh;
    noh_mesh_header header;
    float *positions;
    uint8_t *attributes;
    noh_morph_layers layers;
} loose_mesh;

static void put_word(uint8_t *at, uint32_t word)
{
    memcpy(at, &word, sizeof word);
}

/* Runs of vertices whose texels follow each other, and single ones that have any or none. */
static void random_texels(loose_mesh *m, test_random *r)
{
    const uint32_t stride = m->header.attribute_stride;
    uint32_t texel = 0, left = 0;
    for (uint32_t v = 0; v < m->header.vertex_count; v++, texel++, left--) {
        if (!left) {
            left = 1u + test_random_below(r, 40);
            texel = test_random_below(r, m->header.touched_count + 20u);
        }
        put_word(m->attributes + ((size_t)v + 1u) * stride - 4u, texel | test_random_below(r, 4)
                                                                             << NOH_TEXEL_VERTEX_BITS);
    }
}

/* size: of deltas relative to the directions */
static void random_loose(loose_mesh *m, test_random *r, float size)
{
    noh_mesh_header *h = &m->header;
    size_t floats;
    memset(m, 0, sizeof *m);
    h->flags = test_random_u32(r) & (NOH_MESH_TANGENTS | NOH_MESH_UVS | NOH_MESH_COLORS | NOH_MESH_TEXELS);
    h->attribute_stride = 4u;
    for (uint32_t f = 1; f <= NOH_MESH_TEXELS; f *= 2u) h->attribute_stride += h->flags & f ? 4u : 0u;
    h->morph_width_log2 = 4;
    h->morph_height = (uint16_t)(1u + test_random_below(r, 6));
    h->touched_count = 1u + test_random_below(r, 16u * h->morph_height);
    h->vertex_count = h->touched_count + (test_random_below(r, 2) ? test_random_below(r, 30) : 0u);
    m->positions = test_zeros(12u * (size_t)h->vertex_count);
    m->attributes = test_zeros((size_t)h->attribute_stride * h->vertex_count);
    for (uint32_t i = 0; i < 3u * h->vertex_count; i++) m->positions[i] = test_random_float(r, -2.0f, 2.0f);
    for (uint32_t i = 0; i < h->attribute_stride * h->vertex_count / 4u; i++) {
        const uint32_t x = test_random_below(r, 65535u) - 32767u, y = test_random_below(r, 65535u) - 32767u;
        put_word(m->attributes + 4u * (size_t)i, (x & 0xffffu) | y << 16); /* -32768 is in no pack */
    }
    if (h->flags & NOH_MESH_TEXELS) random_texels(m, r);
    m->mesh.header = h;
    m->mesh.positions = m->positions;
    m->mesh.attributes = m->attributes;
    m->layers = test_layers(&m->mesh);
    floats = noh_morph_layers_size(&m->mesh) / 4u;
    for (size_t i = 0; i < floats; i++) m->layers.position[i] = test_random_float(r, -size, size);
}

static void close_loose(loose_mesh *m)
{
    free(m->positions);
    free(m->attributes);
    free(m->layers.position);
}

/* Deltas that cancel the normal or the tangent, are zeros, or are too large for a product. */
static void make_hard(loose_mesh *m, test_random *r)
{
    for (uint32_t v = 0; v < m->header.vertex_count; v++) {
        const size_t texel = noh_mesh_accumulation_texel(&m->mesh, v), at = 3u * texel;
        noh_vertex rest;
        if (texel >= m->header.touched_count || test_random_below(r, 3)) continue;
        noh_mesh_vertex(&m->mesh, v, &rest);
        for (size_t i = 0; i < 3; i++) {
            static const float large[] = { 0.0f, 1e-20f, 1e14f, 1e17f, 3e38f, -3e38f };
            switch (test_random_below(r, 4)) {
            case 0: m->layers.normal[at + i] = -rest.normal[i]; break;
            case 1: m->layers.tangent[at + i] = rest.normal[i] - rest.tangent[i]; break;
            case 2: m->layers.normal[at + i] = large[test_random_below(r, 6)]; break;
            default: m->layers.tangent[at + i] = large[test_random_below(r, 6)]; break;
            }
        }
    }
}

/* ---- equal bits ---- */

typedef void (*finish_function)(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count,
                                void *out);

/* Any range of it; nothing behind is written. */
static void expect_scalar_bits(const loose_mesh *m, test_random *r, finish_function finish, const char *name)
{
    const uint32_t first = test_random_below(r, m->header.vertex_count + 1u);
    const uint32_t count = test_random_below(r, m->header.vertex_count - first + 1u);
    const size_t bytes = (size_t)count * noh_morph_finished_stride(&m->mesh);
    uint8_t *expected = test_zeros(bytes + 8u), *got = test_zeros(bytes + 8u);
    noh_morph_layers layers = m->layers;
    if (test_random_below(r, 4) == 0) layers.tangent = NULL;
    memset(expected, 0xa5, bytes + 8u);
    memset(got, 0xa5, bytes + 8u);
    noh_morph_finish_scalar(&m->mesh, &layers, first, count, expected);
    finish(&m->mesh, &layers, first, count, got);
    if (memcmp(got, expected, bytes + 8u)) print_message("# %s differs\n", name);
    assert_memory_equal(got, expected, bytes + 8u);
    free(expected);
    free(got);
}

static void equals_scalar(finish_function finish, const char *name)
{
    test_random r = test_random_from(61);
    for (int round = 0; round < 1000; round++) {
        loose_mesh m;
        random_loose(&m, &r, round % 3 ? 0.5f : 4.0f);
        if (round % 4 == 0) make_hard(&m, &r);
        expect_scalar_bits(&m, &r, finish, name);
        close_loose(&m);
    }
}

static void named_equals_scalar(const char *name)
{
    noh_morph_kernel kernel;
    if (noh_morph_kernel_find(name, &kernel, NULL) != NOH_OK) {
        test_skip("this processor, or this build, has no such kernel");
    }
    equals_scalar(kernel.finish, name);
}

static void compiled_in_equals_scalar(void **state)
{
    (void)state;
    equals_scalar(noh_morph_finish, noh_morph_simd());
}

static void sse2_equals_scalar(void **state)
{
    (void)state;
    named_equals_scalar("sse2");
}

static void avx2_equals_scalar(void **state)
{
    (void)state;
    named_equals_scalar("avx2");
}

/* ---- what the words say ---- */

typedef struct finished {
    float position[3];
    uint32_t words[2];
} finished;

static finished finish_one(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t v)
{
    finished f = { { 0.0f, 0.0f, 0.0f }, { 0, 0 } };
    noh_morph_finish_scalar(mesh, layers, v, 1, &f);
    return f;
}

/* A vertex of a mesh that has these words: what a shader decodes. */
static noh_vertex decode(const loose_mesh *m, const finished *f)
{
    noh_mesh_header h = m->header;
    noh_mesh mesh = m->mesh;
    noh_vertex v;
    h.flags &= NOH_MESH_TANGENTS;
    h.attribute_stride = noh_morph_finished_stride(&m->mesh) - 12u;
    h.vertex_count = 1;
    mesh.header = &h;
    mesh.positions = f->position;
    mesh.attributes = (const uint8_t *)f->words;
    noh_mesh_vertex(&mesh, 0, &v);
    return v;
}

/* Of unit vectors, in double precision: noh_morph_vertex's are unit to 1e-7 only. */
static double angle(const float a[3], const float b[3])
{
    double cross = 0.0, dot = 0.0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double c = (double)a[j] * (double)b[k] - (double)a[k] * (double)b[j];
        cross += c * c;
        dot += (double)a[i] * (double)b[i];
    }
    return atan2(sqrt(cross), dot);
}

/* Deltas of up to half a direction's length: it stays far enough from 0 for floats to have it to 1e-6. */
static void vertices_are_those_of_the_reference(void **state)
{
    test_random r = test_random_from(62);
    double worst[2] = { 0.0, 0.0 };
    (void)state;
    for (int round = 0; round < 300; round++) {
        loose_mesh m;
        random_loose(&m, &r, 0.25f);
        for (uint32_t v = 0; v < m.header.vertex_count; v++) {
            const finished f = finish_one(&m.mesh, &m.layers, v);
            const noh_vertex got = decode(&m, &f);
            noh_vertex want, rest;
            noh_mesh_vertex(&m.mesh, v, &rest);
            noh_morph_vertex(&m.mesh, &m.layers, v, &want);
            assert_memory_equal(got.position, want.position, sizeof want.position);
            worst[0] = fmax(worst[0], angle(got.normal, want.normal));
            if (m.header.flags & NOH_MESH_TANGENTS) {
                /* where the bind pose's two are nearly parallel, so little is left that rounding turns it */
                if (fabs(cos(angle(rest.normal, rest.tangent))) < 0.3) {
                    worst[1] = fmax(worst[1], angle(got.tangent, want.tangent));
                }
                assert_true(got.tangent[3] == want.tangent[3]);
            }
        }
        close_loose(&m);
    }
    print_message("# angles to the reference: normals %.3g, tangents %.3g\n", worst[0], worst[1]);
    assert_true(worst[0] <= (double)NOH_FINISHED_NORMAL_ERROR && worst[0] > 0.5 * (double)NOH_FINISHED_NORMAL_ERROR);
    assert_true(worst[1] <= (double)NOH_FINISHED_TANGENT_ERROR && worst[1] > 0.5 * (double)NOH_FINISHED_TANGENT_ERROR);
}

/* The pack's own words, whatever they are. */
static void what_nothing_moves_is_the_bind_pose(void **state)
{
    test_random r = test_random_from(63);
    (void)state;
    for (int round = 0; round < 100; round++) {
        loose_mesh m;
        random_loose(&m, &r, 0.5f);
        for (uint32_t v = 0; v < m.header.vertex_count; v++) {
            const int is_moved = noh_mesh_accumulation_texel(&m.mesh, v) < m.header.touched_count;
            const finished f = finish_one(&m.mesh, is_moved ? NULL : &m.layers, v);
            const uint8_t *record = m.attributes + (size_t)v * m.header.attribute_stride;
            assert_memory_equal(f.position, m.positions + 3u * (size_t)v, sizeof f.position);
            assert_memory_equal(f.words, record, noh_morph_finished_stride(&m.mesh) - 12u);
        }
        close_loose(&m);
    }
}

/* A normal that its delta takes away is the bind pose's; a tangent, too; so is what overflows. */
static void what_vanishes_is_the_bind_pose(void **state)
{
    static const float deltas[] = { 0.0f, 3e38f };
    test_random r = test_random_from(64);
    loose_mesh m;
    (void)state;
    do {
        random_loose(&m, &r, 0.0f);
        if (m.header.flags & NOH_MESH_TANGENTS && !(m.header.flags & NOH_MESH_TEXELS)) break;
        close_loose(&m);
    } while (1);
    put_word(m.attributes, 0);         /* +z, exactly */
    put_word(m.attributes + 4, 32767); /* +x */
    for (int i = 0; i < 2; i++) {
        finished f;
        m.layers.normal[2] = i ? deltas[1] : -1.0f;
        f = finish_one(&m.mesh, &m.layers, 0);
        assert_int_equal(f.words[0], 0);
        assert_int_equal(f.words[1], 32767);
        m.layers.normal[2] = 0.0f;
        m.layers.tangent[0] = i ? deltas[1] : -1.0f;
        f = finish_one(&m.mesh, &m.layers, 0);
        assert_int_equal(f.words[0], 0);
        assert_int_equal(f.words[1], 32767);
        m.layers.tangent[0] = 0.0f;
    }
    close_loose(&m);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(compiled_in_equals_scalar),
    cmocka_unit_test(sse2_equals_scalar),
    cmocka_unit_test(avx2_equals_scalar),
    cmocka_unit_test(vertices_are_those_of_the_reference),
    cmocka_unit_test(what_nothing_moves_is_the_bind_pose),
    cmocka_unit_test(what_vanishes_is_the_bind_pose),
};

TEST_MAIN(tests, NULL, NULL)
