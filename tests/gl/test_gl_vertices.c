/* Finished vertices of the path cpu: every word of the vertex buffers against plain C after any sequence of updates,
 * with every kernel, mapped or sent; what a slot keeps while it may be drawn; and drivers that refuse to map, lose what
 * was mapped, or never finish. */
#include "support/gl_fixture.h"
#include "support/level_fixture.h"
#include "deform/morph/morph_internal.h"
#include "gl/morph/gl_morph_internal.h"
#include "deform/morph/morph_finish_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LEVELS 3u

static fixture_meshes plain;
static fixture_levels levels;
static noh_mesh with_levels[FIXTURE_MESHES]; /* vertices with a texel word */
static const uint32_t few[FIXTURE_MESHES] = { 3, 2, 4 };
static noh_gl_api real;

static int set_up(void **state)
{
    uint32_t referring = 0;
    (void)state;
    fixture_meshes_open(&plain);
    fixture_levels_open(&levels, &plain.pack, LEVELS, 2.0f);
    for (uint32_t i = 0; i < FIXTURE_MESHES; i++) {
        with_levels[i] = test_mesh(&levels.pack, i);
        referring += (with_levels[i].header->flags & NOH_MESH_TEXELS) != 0;
    }
    print_message("# %u meshes refer to texels\n", (unsigned)referring);
    return 0;
}

static int tear_down(void **state)
{
    fixture_levels_close(&levels);
    fixture_meshes_close(&plain);
    return fixture_tear_down(state);
}

static noh_gl_morph_desc desc_of(const noh_mesh *meshes)
{
    noh_gl_morph_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.meshes = meshes;
    desc.mesh_count = FIXTURE_MESHES;
    desc.instance_counts = few;
    desc.path = NOH_MORPH_CPU;
    desc.accumulate = NOH_ACCUMULATE_F32;
    desc.vertices = 1;
    return desc;
}

/* Opened with the table that this test changes, which it puts back to look. */
static void open_vertices(fixture_morph *m, const noh_gl_morph_desc *desc)
{
    real = fixture_gpu()->gl;
    fixture_morph_open(m, desc, NULL);
    assert_in_range(m->plan.vertex_ring, 2, 3);
    assert_true(m->plan.layer_bytes == 0 && m->plan.vertex_bytes > 0);
    assert_true(noh_gl_ledger_bytes(&m->ledger) == m->plan.gpu_bytes);
}

static uint8_t *read_words(const noh_gl_morph_binding *binding, size_t bytes)
{
    uint8_t *got = test_zeros(bytes);
    readback back;
    assert_int_equal(readback_open(&back, fixture_gpu(), 0), 0);
    assert_int_equal(readback_buffer(&back, binding->vertex_buffer, binding->vertex_offset, bytes, got), 0);
    readback_close(&back);
    return got;
}

/* All words of an instance's vertices. */
static void expect_instance(const fixture_morph *m, uint32_t instance)
{
    const noh_mesh mesh = fixture_view_of(m, instance);
    const noh_gl_morph_binding binding = noh_gl_morph_binding_of(m->morph, instance);
    const size_t bytes = (size_t)mesh.header->vertex_count * noh_morph_finished_stride(&mesh);
    noh_morph_layers layers;
    uint8_t *got, *expected;
    int exact;
    assert_int_equal(binding.is_uint, NOH_LAYERS_VERTICES);
    assert_true(binding.touched == 0 && binding.texture == 0);
    if (!mesh.header->touched_count) {
        assert_int_equal(binding.vertex_buffer, 0);
        return;
    }
    layers.position = fixture_reference(m, instance, &exact);
    layers.normal = layers.position + noh_morph_layers_size(&mesh) / 12u;
    layers.tangent = m->plan.layer_count == 3u ? layers.normal + noh_morph_layers_size(&mesh) / 12u : NULL;
    expected = test_zeros(bytes);
    noh_morph_finish_scalar(&mesh, &layers, 0, mesh.header->vertex_count, expected);
    got = read_words(&binding, bytes);
    assert_memory_equal(got, expected, bytes);
    free(layers.position);
    free(expected);
    free(got);
}

static void expect_all(const fixture_morph *m)
{
    const noh_gl_api changed = fixture_gpu()->gl;
    fixture_gpu()->gl = real;
    for (uint32_t i = 0; i < m->plan.instance_count; i++) expect_instance(m, i);
    fixture_gpu()->gl = changed;
}

/* Some instances get some new weights, all of them, or none; some a level. */
static void change(fixture_morph *m, test_random *r)
{
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        const noh_mesh *mesh = fixture_mesh_of(m, i);
        float weights[NOH_TARGETS_MAX];
        if (!mesh->header->target_count || test_random_below(r, 3) == 0) continue;
        memcpy(weights, m->weights[i], sizeof *weights * mesh->header->target_count);
        switch (test_random_below(r, 4)) {
        case 0: test_random_weights(r, weights, mesh->header->target_count); break;
        case 1: memset(weights, 0, sizeof *weights * mesh->header->target_count); break;
        default: weights[test_random_below(r, mesh->header->target_count)] = test_random_float(r, -1.0f, 1.0f); break;
        }
        fixture_set(m, i, weights);
        if (mesh->header->level_count > 1 && test_random_below(r, 4) == 0) {
            fixture_set_level(m, i, test_random_below(r, LEVELS));
        }
    }
}

static void run_updates(const noh_gl_morph_desc *desc, uint64_t seed, int rounds)
{
    test_random r = test_random_from(seed);
    fixture_morph m;
    open_vertices(&m, desc);
    for (int round = 0; round < rounds; round++) {
        noh_gl_morph_update(m.morph, NULL);
        expect_all(&m);
        change(&m, &r);
    }
    fixture_gpu()->gl = real;
    fixture_morph_close(&m);
    fixture_expect_no_errors();
}

/* ---- equal to plain C ---- */

static void every_kernel_writes_the_words_of_plain_c(void **state)
{
    static const char *const names[] = { NULL, "scalar", "sse2", "avx2", "neon" };
    (void)state;
    for (uint32_t i = 0; i < 2u * TEST_COUNT(names); i++) {
        noh_gl_morph_desc desc = desc_of(plain.meshes);
        noh_morph_kernel kernel;
        desc.simd = names[i / 2u];
        desc.without_tangents = (int)(i % 2u);
        if (noh_morph_kernel_find(desc.simd, &kernel, NULL) == NOH_OK) run_updates(&desc, 71, 12);
    }
}

/* Past the updates at which all of a slot is written. */
static void long_runs_stay_equal(void **state)
{
    const noh_gl_morph_desc desc = desc_of(plain.meshes);
    (void)state;
    run_updates(&desc, 72, 140);
}

static void levels_and_references_are_equal(void **state)
{
    const noh_gl_morph_desc desc = desc_of(with_levels);
    (void)state;
    run_updates(&desc, 73, 40);
}

/* ---- drivers ---- */

static uint32_t calls, sent;

static void *GL_APIENTRY refuses_to_map(GLenum target, GLintptr offset, GLsizeiptr bytes, GLbitfield access)
{
    return calls++ % 3u == 1u ? NULL : real.MapBufferRange(target, offset, bytes, access);
}

/* What was mapped is lost: the buffer holds anything. Its first instance has other vertices now. */
static GLboolean GL_APIENTRY loses_what_was_mapped(GLenum target)
{
    static const uint8_t anything[64] = { 1, 2, 3 };
    const GLboolean was = real.UnmapBuffer(target);
    if (!was || calls++ % 3u != 1u) return was;
    real.BufferSubData(target, 0, sizeof anything, anything);
    return GL_FALSE;
}

static GLenum GL_APIENTRY never_finishes(GLsync sync, GLbitfield flags, GLuint64 ns)
{
    (void)flags;
    (void)ns;
    return calls++ % 3u == 1u ? GL_TIMEOUT_EXPIRED : real.ClientWaitSync(sync, GL_SYNC_FLUSH_COMMANDS_BIT, 1000000000u);
}

static GLsync GL_APIENTRY has_no_fences(GLenum condition, GLbitfield flags)
{
    return calls++ % 3u == 1u ? NULL : real.FenceSync(condition, flags);
}

/* Each of these from the first call on; the words stay equal. */
static void drivers_may_refuse(void **state)
{
    (void)state;
    for (int fault = 0; fault < 5; fault++) {
        const noh_gl_morph_desc desc = desc_of(fault % 2 ? with_levels : plain.meshes);
        noh_gl_api *gl = &fixture_gpu()->gl;
        test_random r = test_random_from(74 + (uint64_t)fault);
        fixture_morph m;
        open_vertices(&m, &desc);
        calls = 0;
        if (fault == 0) gl->MapBufferRange = refuses_to_map;
        if (fault == 1) gl->UnmapBuffer = loses_what_was_mapped;
        if (fault == 2) gl->ClientWaitSync = never_finishes;
        if (fault == 3) gl->FenceSync = has_no_fences;
        if (fault == 4) gl->MapBufferRange = NULL; /* WebGL */
        for (int round = 0; round < 20; round++) {
            noh_gl_morph_update(m.morph, NULL);
            expect_all(&m);
            change(&m, &r);
        }
        assert_true(calls > 10 || fault == 4);
        *gl = real;
        fixture_morph_close(&m);
        fixture_expect_no_errors();
    }
}

/* ---- what is written ---- */

static void GL_APIENTRY count_bytes(GLenum target, GLintptr offset, GLsizeiptr bytes, const void *data)
{
    sent += (uint32_t)bytes;
    real.BufferSubData(target, offset, bytes, data);
}

/* One target of a large mesh: once into each slot, and what it does not move is not sent. */
static void what_no_changed_target_moves_is_not_written(void **state)
{
    const test_model_desc made = { 1, 70, 40, 0, 68 };
    size_t count;
    uint8_t *bytes = test_pack(&made, &count);
    noh_pack pack = test_open(bytes, count);
    noh_mesh mesh = test_mesh(&pack, 0);
    noh_gl_morph_desc desc = desc_of(&mesh);
    const uint32_t whole = mesh.header->touched_count * noh_morph_finished_stride(&mesh);
    float weights[NOH_TARGETS_MAX] = { 0 };
    uint32_t smallest = 0;
    fixture_morph m;
    (void)state;
    desc.mesh_count = 1;
    desc.instance_counts = NULL;
    for (uint32_t t = 1; t < mesh.header->target_count; t++) {
        if (mesh.targets[t].texel_count < mesh.targets[smallest].texel_count) smallest = t;
    }
    open_vertices(&m, &desc);
    fixture_gpu()->gl.MapBufferRange = NULL;
    fixture_gpu()->gl.BufferSubData = count_bytes;
    for (uint32_t round = 0; round < 12; round++) {
        sent = 0;
        weights[smallest] = 0.25f * (float)(round % 4u);
        fixture_set(&m, 0, weights);
        noh_gl_morph_update(m.morph, NULL);
        if (round < m.plan.vertex_ring) {
            assert_int_equal(sent, round || weights[smallest] != 0.0f ? whole : sent);
        } else {
            assert_in_range(sent, 1, whole / 2u);
        }
        expect_all(&m);
        sent = 0;
        noh_gl_morph_update(m.morph, NULL);
        assert_int_equal(sent, 0);
    }
    fixture_gpu()->gl = real;
    fixture_morph_close(&m);
    fixture_expect_no_errors();
    free(bytes);
}

/* The words that a frame may still be drawn from stay for as many updates as the ring has other buffers. */
static void what_may_be_drawn_is_kept(void **state)
{
    const noh_gl_morph_desc desc = desc_of(plain.meshes);
    test_random r = test_random_from(79);
    fixture_morph m;
    (void)state;
    open_vertices(&m, &desc);
    for (int round = 0; round < 10; round++) {
        const size_t bytes = (size_t)plain.meshes[0].header->vertex_count * noh_morph_finished_stride(&plain.meshes[0]);
        noh_gl_morph_binding binding, next;
        uint8_t *before, *after;
        fixture_set_random(&m, 0, &r);
        noh_gl_morph_update(m.morph, NULL);
        binding = noh_gl_morph_binding_of(m.morph, 0);
        before = read_words(&binding, bytes);
        for (uint32_t i = 1; i < m.plan.vertex_ring; i++) {
            fixture_set_random(&m, 0, &r);
            noh_gl_morph_update(m.morph, NULL);
            next = noh_gl_morph_binding_of(m.morph, 0);
            assert_int_not_equal(next.vertex_buffer, binding.vertex_buffer);
            after = read_words(&binding, bytes);
            assert_memory_equal(after, before, bytes);
            free(after);
        }
        free(before);
    }
    fixture_morph_close(&m);
    fixture_expect_no_errors();
}

/* ---- drawing ---- */

/* Bound, a mesh has the morphed vertices; unbound, the bind pose's again. By its own vertex array, then by the
 * instances' arrays. */
static void a_mesh_is_drawn_from_them(void **state)
{
    gpu *g = fixture_gpu();
    const noh_mesh *mesh = &plain.meshes[2];
    const noh_gl_morph_desc desc = desc_of(plain.meshes);
    const size_t floats = 3u * (size_t)mesh->header->vertex_count;
    float *positions = test_zeros(4 * floats), *normals = test_zeros(4 * floats), *tangents = test_zeros(4 * floats);
    test_random r = test_random_from(80);
    noh_gl_morph_binding binding;
    noh_gl_ledger ledger;
    noh_gl_mesh gl_mesh;
    fixture_morph m;
    readback back;
    (void)state;
    memset(&ledger, 0, sizeof ledger);
    open_vertices(&m, &desc);
    assert_int_equal(noh_gl_mesh_create(&g->gl, &ledger, mesh, &gl_mesh, NULL), NOH_OK);
    for (int round = 0; round < 4; round++) {
        const int morphed = !(round % 2);
        const uint32_t instance = noh_gl_morph_instance(m.morph, 2, 1);
        noh_morph_layers layers;
        int exact;
        if (round == 2) assert_int_equal(noh_gl_morph_set_mesh(m.morph, 2, &gl_mesh, NULL), NOH_OK);
        if (morphed) fixture_set_random(&m, instance, &r);
        noh_gl_morph_update(m.morph, NULL);
        layers.position = fixture_reference(&m, instance, &exact);
        layers.normal = layers.position + noh_morph_layers_size(mesh) / 12u;
        layers.tangent = layers.normal + noh_morph_layers_size(mesh) / 12u;
        if (!morphed) memset(layers.position, 0, noh_morph_layers_size(mesh));
        binding = noh_gl_morph_binding_of(m.morph, instance);
        assert_int_equal(binding.vertex_array != 0, round >= 2);
        if (!morphed) binding.vertex_buffer = binding.vertex_array = 0; /* as where nothing is morphed */
        assert_int_equal(readback_open(&back, g, NOH_LAYERS_VERTICES), 0);
        assert_int_equal(readback_vertices(&back, &gl_mesh, &binding, positions, normals, tangents), 0);
        readback_close(&back);
        for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
            noh_vertex expected;
            noh_morph_vertex(mesh, &layers, v, &expected);
            assert_memory_equal(positions + 3 * v, expected.position, sizeof expected.position);
            for (uint32_t c = 0; c < 3; c++) {
                assert_true(fabsf(normals[3 * v + c] - expected.normal[c]) <= 1e-5f + NOH_FINISHED_NORMAL_ERROR);
                assert_true(fabsf(tangents[3 * v + c] - expected.tangent[c]) <= 1e-5f + NOH_FINISHED_TANGENT_ERROR);
            }
        }
        free(layers.position);
    }
    noh_gl_mesh_delete(&g->gl, &ledger, &gl_mesh);
    fixture_morph_close(&m);
    fixture_expect_no_errors();
    free(positions);
    free(normals);
    free(tangents);
}

/* ---- plans ---- */

/* Where sums are needed there are none, and the plan is the plan for sums. */
static void where_sums_are_needed_there_are_none(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        noh_gl_morph_desc desc = desc_of(plain.meshes), without;
        noh_gl_morph_plan plan, expected;
        if (i == 0) desc.accumulate = NOH_ACCUMULATE_F16;
        if (i == 1) desc.path = NOH_MORPH_GATHER;
        if (i == 2) desc.meshes = &plain.meshes[FIXTURE_BARE], desc.mesh_count = 1;
        without = desc;
        without.vertices = 0;
        assert_int_equal(noh_gl_morph_plan_make(&desc, &fixture_gpu()->caps, &plan, NULL), NOH_OK);
        assert_int_equal(noh_gl_morph_plan_make(&without, &fixture_gpu()->caps, &expected, NULL), NOH_OK);
        assert_int_equal(plan.vertex_ring, 0);
        assert_true(plan.vertex_bytes == 0);
        assert_true(plan.gpu_bytes == expected.gpu_bytes && plan.cpu_bytes == expected.cpu_bytes);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_kernel_writes_the_words_of_plain_c),
    cmocka_unit_test(long_runs_stay_equal),
    cmocka_unit_test(levels_and_references_are_equal),
    cmocka_unit_test(drivers_may_refuse),
    cmocka_unit_test(what_no_changed_target_moves_is_not_written),
    cmocka_unit_test(what_may_be_drawn_is_kept),
    cmocka_unit_test(a_mesh_is_drawn_from_them),
    cmocka_unit_test(where_sums_are_needed_there_are_none),
};

TEST_MAIN(tests, set_up, tear_down)
