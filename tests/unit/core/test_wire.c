/* The wire form: packs come back to the byte in pieces of any size, the coarse levels first; rounded ones stay within
 * what is stated and draw the same triangles; every truncation and every flipped bit is refused. */
#include "support/lod_fixture.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/pack/pack_order.h"
#include "convert/pack/pack_round.h"
#include "convert/pack/pack_strip.h"
#include "convert/pack/pack_wire.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"
#include "support/pack_walk.h"
#include "core/wire/wire_internal.h"

#define LEVELS 3u
#define FORM_HASH 0x6498e9f491796427ull /* of what the_form_stays writes */

typedef struct kept {
    uint8_t *bytes;
    noh_pack pack;
} kept;

static kept face, tube, coarse_face; /* rigid, with targets; skinned, in two palettes; levels in all */

static kept keep(const uint8_t *bytes, size_t count)
{
    kept k;
    k.bytes = test_aligned(bytes, count);
    k.pack = test_open(k.bytes, count);
    return k;
}

static kept build(model *m, uint32_t palette)
{
    const lod_settings settings = { LEVELS, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    lod_pack p;
    kept k;
    lod_pack_make(m, &settings, palette, &p);
    assert_int_equal(p.mesh.header->level_count, LEVELS);
    k = keep(p.bytes, p.byte_count);
    lod_pack_free(&p);
    model_free(m);
    return k;
}

static kept strip_to_coarsest(const noh_pack *pack)
{
    const char *item = "7";
    const strip_levels levels = { &item, 1 };
    uint32_t *first = test_zeros((pack->runs[NOH_CHUNK_MESH].count + 1u) * sizeof *first);
    byte_buffer out = { NULL, 0, 0, 0 };
    model_error error = { "", "" };
    kept k;
    if (strip_levels_of(&levels, pack, first, &error) || pack_strip(pack, first, &out, &error))
        fail_msg("%s", error.what);
    k = keep(out.bytes, out.count);
    buffer_free(&out);
    free(first);
    return k;
}

static int set_up(void **state)
{
    const lod_face of_face = { 20, 16, LOD_FACE_TARGETS, 1, 0 };
    const skin_cylinder of_tube = { 4, 16, 24, 2, 2, 0, 2.0f, 0.5f };
    (void)state;
    face = build(lod_face_model(&of_face), 0);
    tube = build(lod_tube_model(&of_tube), 6);
    coarse_face = strip_to_coarsest(&face.pack);
    assert_true(test_mesh(&tube.pack, 0).header->palette_count > 1);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    free(face.bytes);
    free(tube.bytes);
    free(coarse_face.bytes);
    return 0;
}

/* ---- there and back ---- */

static byte_buffer wire_of(const noh_pack *packs, uint32_t count, const wire_steps *steps)
{
    static const wire_steps exact = { NULL, 32767, 65535, 0 };
    byte_buffer out = { NULL, 0, 0, 0 };
    wire_report report;
    model_error error = { "", "" };
    if (pack_wire(packs, count, steps ? steps : &exact, &out, &report, &error)) fail_msg("%s", error.what);
    return out;
}

typedef struct reader {
    uint8_t *memory, *block;
    noh_wire_info info;
    noh_wire *wire;
} reader;

static reader begin(const uint8_t *bytes, size_t count)
{
    reader r;
    noh_wire_desc desc;
    assert_int_equal(noh_wire_info_read(bytes, count, &r.info, NULL), NOH_OK);
    r.memory = test_zeros(noh_wire_size());
    r.block = malloc(r.info.block_bytes);
    memset(r.block, 0xa5, r.info.block_bytes);
    desc.block = r.block;
    desc.block_bytes = r.info.block_bytes;
    assert_int_equal(noh_wire_init(r.memory, noh_wire_size(), &desc, &r.wire, NULL), NOH_OK);
    return r;
}

static void end(reader *r)
{
    free(r->memory);
    free(r->block);
}

static void packs_come_back_to_the_byte(void **state)
{
    const noh_pack all[] = { face.pack, tube.pack, coarse_face.pack };
    static const size_t pieces[] = { 1u << 30, 7, 4096, 1 };
    (void)state;
    for (unsigned i = 0; i < 3; i++) {
        byte_buffer out = wire_of(&all[i], 1, NULL);
        for (unsigned k = 0; k < 4; k++) {
            reader r = begin(out.bytes, out.count);
            noh_error error = { NOH_OK, "", 0, 0 };
            noh_pack pack;
            for (size_t at = 0; at < out.count;) {
                const size_t now = out.count - at < pieces[k] ? out.count - at : pieces[k];
                assert_false(noh_wire_is_complete(r.wire));
                if (noh_wire_push(r.wire, out.bytes + at, now, &error)) fail_msg("%s", error.what);
                at += now;
                assert_int_equal(noh_wire_bytes_read(r.wire), at);
            }
            assert_true(noh_wire_is_complete(r.wire));
            assert_int_equal(noh_wire_pack(r.wire, &pack, NULL), NOH_OK);
            assert_int_equal(pack.byte_count, all[i].byte_count);
            assert_memory_equal(pack.bytes, all[i].bytes, pack.byte_count);
            assert_ptr_equal(pack.bytes, r.block);
            end(&r);
        }
        buffer_free(&out);
    }
}

/* Later versions read the same bytes, so whatever the coder guesses by is part of the form: if that is meant to change,
 * raise NOH_WIRE_VERSION. */
static void the_form_stays(void **state)
{
    const test_model_desc desc = { 1, 12, 5, TEST_UVS | TEST_TANGENTS | TEST_COLORS, 8 };
    size_t count;
    uint8_t *bytes = test_pack(&desc, &count);
    const noh_pack pack = test_open(bytes, count);
    byte_buffer out = wire_of(&pack, 1, NULL);
    (void)state;
    const uint64_t hash = test_hash(TEST_HASH, out.bytes, out.count);
    if (hash != FORM_HASH) fail_msg("the wire form, or the pack in it, has the hash %016" PRIx64, hash);
    buffer_free(&out);
    free(bytes);
}

/* The coarse pack is there long before the end, and stays as it is while the rest comes. */
static void coarse_levels_come_first(void **state)
{
    const noh_pack both[2] = { coarse_face.pack, face.pack };
    byte_buffer out = wire_of(both, 2, NULL);
    reader r = begin(out.bytes, out.count);
    size_t at = 0;
    noh_pack first, last;
    noh_mesh coarse, whole;
    (void)state;
    assert_int_equal(r.info.coarse_bytes, coarse_face.pack.byte_count);
    while (noh_wire_pack(r.wire, &first, NULL) == NOH_ERR_NOT_FOUND) {
        assert_int_equal(noh_wire_push(r.wire, out.bytes + at++, 1, NULL), NOH_OK);
    }
    assert_true(at < out.count / 2u);
    assert_false(noh_wire_is_complete(r.wire));
    assert_memory_equal(first.bytes, coarse_face.pack.bytes, first.byte_count);
    coarse = test_mesh(&first, 0);
    whole = test_mesh(&face.pack, 0);
    assert_int_equal(noh_mesh_source(&coarse), noh_mesh_source(&whole));
    assert_int_equal(noh_wire_push(r.wire, out.bytes + at, out.count - at, NULL), NOH_OK);
    assert_true(noh_wire_is_complete(r.wire));
    assert_int_equal(noh_wire_pack(r.wire, &last, NULL), NOH_OK);
    assert_memory_equal(last.bytes, face.pack.bytes, face.pack.byte_count);
    assert_memory_equal(first.bytes, coarse_face.pack.bytes, first.byte_count);
    end(&r);
    buffer_free(&out);
}

static void the_state_is_small_and_never_grows(void **state)
{
    (void)state;
    assert_true(noh_wire_size() <= NOH_WIRE_STATE_BYTES);
    assert_true(NOH_WIRE_STATE_BYTES < 65536u);
}

static void a_short_block_is_refused_untouched(void **state)
{
    byte_buffer out = wire_of(&tube.pack, 1, NULL);
    reader r = begin(out.bytes, out.count);
    noh_wire_desc desc;
    noh_error error;
    (void)state;
    desc.block = r.block;
    desc.block_bytes = r.info.block_bytes - 1u;
    assert_int_equal(noh_wire_init(r.memory, noh_wire_size(), &desc, &r.wire, NULL), NOH_OK);
    assert_int_equal(noh_wire_push(r.wire, out.bytes, out.count, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, r.info.block_bytes);
    for (uint32_t i = 0; i < r.info.block_bytes; i++) assert_int_equal(r.block[i], 0xa5);
    end(&r);
    buffer_free(&out);
}

/* ---- damage ---- */

static void no_part_is_the_whole(void **state)
{
    byte_buffer out = wire_of(&tube.pack, 1, NULL);
    reader r = begin(out.bytes, out.count);
    noh_pack pack;
    noh_error error;
    (void)state;
    for (size_t i = 0; i + 1u < out.count; i++) {
        assert_int_equal(noh_wire_push(r.wire, out.bytes + i, 1, NULL), NOH_OK);
        assert_false(noh_wire_is_complete(r.wire));
        assert_int_equal(noh_wire_pack(r.wire, &pack, &error), NOH_ERR_NOT_FOUND);
    }
    assert_int_equal(noh_wire_push(r.wire, out.bytes + out.count - 1u, 1, NULL), NOH_OK);
    assert_true(noh_wire_is_complete(r.wire));
    assert_int_equal(noh_wire_push(r.wire, "x", 1, &error), NOH_ERR_DATA);
    end(&r);
    buffer_free(&out);
}

static void every_flipped_bit_is_refused(void **state)
{
    byte_buffer out = wire_of(&tube.pack, 1, NULL);
    noh_wire_info info;
    reader r = begin(out.bytes, out.count);
    (void)state;
    for (size_t bit = 0; bit < 8u * out.count; bit += bit < 8u * 512u ? 1u : 5u) {
        const noh_wire_desc desc = { r.block, r.info.block_bytes };
        noh_error error = { NOH_OK, NULL, 0, 0 };
        out.bytes[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
        if (bit < 8u * NOH_WIRE_HEAD_BYTES)
            assert_true(noh_wire_info_read(out.bytes, out.count, &info, NULL) != NOH_OK);
        assert_int_equal(noh_wire_init(r.memory, noh_wire_size(), &desc, &r.wire, NULL), NOH_OK);
        if (noh_wire_push(r.wire, out.bytes, out.count, &error) == NOH_OK) {
            assert_false(noh_wire_is_complete(r.wire)); /* a length that grew: the file seems cut short */
        } else {
            assert_non_null(error.what);
            assert_true(error.where <= out.count);
            assert_int_equal(noh_wire_push(r.wire, out.bytes, 1, NULL), NOH_ERR_DATA);
        }
        out.bytes[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
    }
    end(&r);
    buffer_free(&out);
}

/* Their scratch is others' later: a second section of triangles, or one behind the positions, would read it. */
static void triangles_come_once_and_first(void **state)
{
    static const uint8_t others[] = { NOH_WIRE_INDICES, NOH_WIRE_POSITIONS, NOH_WIRE_NORMALS };
    const noh_mesh mesh = test_mesh(&face.pack, 0);
    const uint32_t bytes = (uint32_t)noh_wire_scratch(mesh.header);
    noh_wire_filter *f = test_zeros(sizeof *f);
    (void)state;
    f->scratch = test_zeros(bytes);
    f->scratch_bytes = bytes;
    f->image = face.bytes;
    f->image_bytes = face.pack.byte_count;
    for (size_t i = 0; i < TEST_COUNT(others); i++) {
        noh_wire_section s;
        memset(&s, 0, sizeof s);
        s.kind = NOH_WIRE_MESH;
        s.at = face.pack.chunks[face.pack.runs[NOH_CHUNK_MESH].first].offset;
        assert_int_equal(noh_wire_begin(f, &s), 1);
        s.kind = others[i];
        assert_int_equal(noh_wire_begin(f, &s), 0);
        s.kind = NOH_WIRE_INDICES;
        assert_int_equal(noh_wire_begin(f, &s), -1);
        assert_non_null(strstr(f->wrong, "two sections of triangles"));
    }
    free(f->scratch);
    free(f);
}

/* ---- rounding ---- */

/* What a target adds to a vertex. */
static void delta_of(const noh_mesh *mesh, uint32_t target, uint32_t vertex, float out[6])
{
    const noh_target *t = &mesh->targets[target];
    const uint32_t texel = noh_mesh_accumulation_texel(mesh, vertex);
    uint32_t slot = t->first_texel;
    memset(out, 0, 6 * sizeof *out);
    for (uint32_t i = 0; i < t->rect_count && texel < mesh->header->touched_count; i++) {
        const noh_rect *r = &mesh->rects[t->first_rect + i];
        const uint32_t x = texel & ((1u << mesh->header->morph_width_log2) - 1u),
                       y = texel >> mesh->header->morph_width_log2;
        if (x >= r->x && x < (uint32_t)r->x + r->w && y >= r->y && y < (uint32_t)r->y + r->h) {
            const uint32_t *words = mesh->texels + 3u * (size_t)(slot + (y - r->y) * r->w + (x - r->x));
            for (unsigned k = 0; k < 3; k++) { /* rectangles may overlap: both add */
                out[k] += t->position_scale * (float)((int32_t)words[k] >> (32u - t->position_bits));
                out[3 + k] += t->normal_scale *
                              (float)((int32_t)(words[k] << t->position_bits) >> (32u - t->normal_bits));
            }
        }
        slot += (uint32_t)r->w * r->h;
    }
}

static kept rounded(const noh_pack *pack, double error_um, int keep_tangents, round_mesh *report)
{
    const round_desc desc = { 1e-6 * error_um, keep_tangents };
    byte_buffer out = { NULL, 0, 0, 0 };
    model_error error = { "", "" };
    kept k;
    if (pack_round(pack, &desc, &out, report, &error)) fail_msg("%s", error.what);
    k = keep(out.bytes, out.count);
    buffer_free(&out);
    return k;
}

static void nothing_changes_without_a_bound(void **state)
{
    round_mesh report;
    kept k = rounded(&face.pack, 0.0, 1, &report);
    (void)state;
    assert_int_equal(k.pack.byte_count, face.pack.byte_count);
    assert_memory_equal(k.bytes, face.bytes, face.pack.byte_count);
    free(k.bytes);
}

static void tangents_go_where_no_map_wants_them(void **state)
{
    round_mesh report;
    kept k = rounded(&face.pack, 0.0, 0, &report);
    const noh_mesh had = test_mesh(&face.pack, 0), has = test_mesh(&k.pack, 0);
    (void)state;
    assert_true(had.header->flags & NOH_MESH_TANGENTS);
    assert_true(report.dropped_tangents);
    assert_false(has.header->flags & NOH_MESH_TANGENTS);
    for (uint32_t v = 0; v < had.header->vertex_count; v++) {
        noh_vertex a, b;
        noh_mesh_vertex(&had, v, &a);
        noh_mesh_vertex(&has, v, &b);
        memset(a.tangent, 0, sizeof a.tangent);
        assert_memory_equal(&a, &b, sizeof a);
    }
    free(k.bytes);
}

static void values_stay_within_what_is_stated(void **state)
{
    const noh_pack *all[] = { &face.pack, &tube.pack };
    (void)state;
    for (unsigned i = 0; i < 2; i++) {
        const double bound = 10e-6;
        round_mesh report;
        kept k = rounded(all[i], 1e6 * bound, 0, &report);
        const noh_mesh a = test_mesh(all[i], 0), b = test_mesh(&k.pack, 0);
        double moved = 0.0, off = 0.0;
        for (uint32_t v = 0; v < a.header->vertex_count; v++) {
            noh_vertex p, q;
            double square = 0.0, dot = 0.0;
            noh_mesh_vertex(&a, v, &p);
            noh_mesh_vertex(&b, v, &q);
            for (unsigned n = 0; n < 3; n++) {
                square += pow((double)p.position[n] - (double)q.position[n], 2.0);
                dot += (double)p.normal[n] * (double)q.normal[n];
            }
            moved = fmax(moved, sqrt(square));
            assert_true(dot > cos(0.6 / 57.3));
            for (uint32_t t = 0; t < a.header->target_count; t++) {
                float d[6], e[6];
                delta_of(&a, t, v, d);
                delta_of(&b, t, v, e);
                assert_memory_equal(d, e, 3 * sizeof *d); /* positions of targets are not touched */
                for (unsigned n = 3; n < 6; n++) off = fmax(off, fabs((double)d[n] - (double)e[n]));
            }
        }
        assert_true(moved * (double)a.header->world_scale <= bound * 1.0001);
        assert_true(moved > 0.1 * bound / (double)a.header->world_scale);
        assert_true(off <= 0.5 * (double)ROUND_DELTA_STEP * 1.0001);
        free(k.bytes);
    }
}

/* ---- order ---- */

/* All that a vertex is: its bytes without its texel's number, its joints and weights, what each target adds. */
static uint64_t vertex_hash(const noh_mesh *mesh, uint32_t v)
{
    uint64_t hash = TEST_HASH;
    noh_vertex vertex;
    noh_mesh_vertex(mesh, v, &vertex);
    hash = test_hash(hash, &vertex, sizeof vertex);
    if (mesh->header->skin != NOH_NONE) {
        uint32_t joints[NOH_INFLUENCES_MAX];
        float weights[NOH_INFLUENCES_MAX];
        const uint32_t count = noh_mesh_influences(mesh, v, joints, weights);
        hash = test_hash(test_hash(hash, joints, 4u * count), weights, 4u * count);
    }
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        float delta[6];
        delta_of(mesh, t, v, delta);
        hash = test_hash(hash, delta, sizeof delta);
    }
    return hash;
}

static int compare_hashes(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/* Triangles of a submesh as sorted hashes, the same whichever corner they begin at. */
static uint64_t *triangles_of(const noh_mesh *mesh, const noh_submesh *s)
{
    uint64_t *hashes = test_zeros((s->index_count / 3u + 1u) * sizeof *hashes);
    for (uint32_t i = 0; i < s->index_count / 3u; i++) {
        uint64_t h[3], best = 0;
        for (uint32_t k = 0; k < 3u; k++) h[k] = vertex_hash(mesh, noh_mesh_index(mesh, s->first_index + 3u * i + k));
        for (uint32_t k = 0; k < 3u; k++) {
            const uint64_t turned[3] = { h[k], h[(k + 1u) % 3u], h[(k + 2u) % 3u] };
            const uint64_t hash = test_hash(1, turned, sizeof turned);
            best = hash > best ? hash : best;
        }
        hashes[i] = best;
    }
    qsort(hashes, s->index_count / 3u, sizeof *hashes, compare_hashes);
    return hashes;
}

static void the_same_triangles_in_another_order(void **state)
{
    const noh_pack *all[] = { &face.pack, &tube.pack, &coarse_face.pack };
    (void)state;
    for (unsigned i = 0; i < 3; i++) {
        byte_buffer out = { NULL, 0, 0, 0 };
        model_error error = { "", "" };
        kept k;
        assert_int_equal(pack_order(all[i], &out, &error), 0);
        k = keep(out.bytes, out.count);
        assert_int_equal(k.pack.byte_count, all[i]->byte_count);
        for (uint32_t level = 0; level < LEVELS; level++) {
            const noh_mesh first = test_mesh(all[i], 0), other = test_mesh(&k.pack, 0);
            const noh_mesh a = noh_mesh_at_lod(&first, level), b = noh_mesh_at_lod(&other, level);
            for (uint32_t s = 0; s < a.header->submesh_count; s++) {
                uint64_t *x = triangles_of(&a, &a.submeshes[s]), *y = triangles_of(&b, &b.submeshes[s]);
                assert_int_equal(a.submeshes[s].index_count, b.submeshes[s].index_count);
                assert_memory_equal(x, y, a.submeshes[s].index_count / 3u * sizeof *x);
                free(x);
                free(y);
            }
        }
        buffer_free(&out);
        free(k.bytes);
    }
}

/* Rounded and put in order, a pack takes less than half of what it takes as it is, and comes back, too. */
static void rounding_is_worth_it(void **state)
{
    round_mesh report;
    byte_buffer ordered = { NULL, 0, 0, 0 }, exact = wire_of(&face.pack, 1, NULL), out;
    model_error error = { "", "" };
    kept o, k;
    wire_grid grid;
    const wire_steps steps = { &grid, ROUND_NORMAL_STEPS, ROUND_UV_STEPS, ROUND_WEIGHT_SHIFT };
    reader r;
    (void)state;
    assert_int_equal(pack_order(&face.pack, &ordered, &error), 0);
    o = keep(ordered.bytes, ordered.count);
    k = rounded(&o.pack, 10.0, 0, &report);
    grid = report.grid;
    out = wire_of(&k.pack, 1, &steps);
    print_message("# %u bytes as a pack, %zu exact, %zu within 10 um\n", face.pack.byte_count, exact.count, out.count);
    assert_true(exact.count < face.pack.byte_count * 3u / 5u);
    assert_true(out.count < exact.count * 3u / 4u);
    r = begin(out.bytes, out.count);
    assert_int_equal(noh_wire_push(r.wire, out.bytes, out.count, NULL), NOH_OK);
    assert_true(noh_wire_is_complete(r.wire));
    assert_memory_equal(r.block, k.bytes, k.pack.byte_count);
    end(&r);
    buffer_free(&out);
    buffer_free(&exact);
    buffer_free(&ordered);
    free(o.bytes);
    free(k.bytes);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(packs_come_back_to_the_byte),
    cmocka_unit_test(the_form_stays),
    cmocka_unit_test(coarse_levels_come_first),
    cmocka_unit_test(the_state_is_small_and_never_grows),
    cmocka_unit_test(a_short_block_is_refused_untouched),
    cmocka_unit_test(no_part_is_the_whole),
    cmocka_unit_test(every_flipped_bit_is_refused),
    cmocka_unit_test(triangles_come_once_and_first),
    cmocka_unit_test(nothing_changes_without_a_bound),
    cmocka_unit_test(tangents_go_where_no_map_wants_them),
    cmocka_unit_test(values_stay_within_what_is_stated),
    cmocka_unit_test(the_same_triangles_in_another_order),
    cmocka_unit_test(rounding_is_worth_it),
};

TEST_MAIN(tests, set_up, tear_down)
