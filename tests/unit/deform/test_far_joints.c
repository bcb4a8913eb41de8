/* Virtual joints of coarse levels: what a level has in their place, what they do to matrices, and lies of a pack. */
#include "support/lod_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/format.h"
#include "noh/low_core.h"
#include "support/pack_walk.h"

#define LEVELS 3u
#define TARGETS 7u

static lod_pack p;
static model *m;

static int set_up(void **state)
{
    const lod_settings settings = { LEVELS, 0, LOD_FAST, 0.0f, 0.0f, NULL, LEVELS };
    const skin_options skin = { .rigid_faces = 1 };
    const lod_face face = { 22, 16, TARGETS, 0, 0 };
    (void)state;
    m = lod_drawn_face_model(&face);
    lod_pack_make_skinned(m, &settings, &skin, &p);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    lod_pack_free(&p);
    model_free(m);
    return 0;
}

/* ---- what a pack has ---- */

static void the_coarsest_level_has_joints_and_no_targets(void **state)
{
    const noh_far_joints_header *h = p.mesh.far_joints;
    const noh_mesh far = noh_mesh_at_lod(&p.mesh, LEVELS - 1u), finer = noh_mesh_at_lod(&p.mesh, LEVELS - 2u);
    noh_skin skin;
    uint32_t moved = 0;
    (void)state;
    assert_int_equal(p.mesh.header->level_count, LEVELS);
    assert_non_null(h);
    assert_int_equal(h->level, LEVELS - 1u);
    assert_true(finer.header->touched_count && finer.header->rect_count);
    assert_int_equal(far.header->touched_count, 0);
    assert_int_equal(far.header->rect_count, 0);
    assert_true(far.header->level_skipped == 0.0f);
    assert_true(h->normal_error_p99 > 0.0f);
    assert_int_equal(noh_pack_skin_at(&p.pack, p.mesh.header->skin, &skin, NULL), NOH_OK);
    assert_int_equal(skin.header->joint_count, 1u + h->joint_count);
    for (uint32_t j = 1; j < skin.header->joint_count; j++) {
        assert_int_equal(skin.joints[j], skin.joints[0]);
        assert_memory_equal(skin.inverse_bind + 12u * (size_t)j, skin.inverse_bind, 48);
    }
    for (uint32_t v = 0; v < far.header->vertex_count; v++) {
        uint32_t joints[NOH_INFLUENCES_MAX];
        float weights[NOH_INFLUENCES_MAX];
        (void)noh_mesh_influences(&far, v, joints, weights);
        moved += joints[0] > 0;
    }
    assert_true(moved > 0);
}

/* A skin that is nearly full takes as many as it has room for, and a full one none: then targets stay. */
static void a_skin_with_little_room_takes_few(void **state)
{
    const lod_settings settings = { LEVELS, 0, LOD_FAST, 0.0f, 0.0f, NULL, LEVELS };
    const lod_face face = { 22, 16, TARGETS, 0, 0 };
    (void)state;
    for (uint32_t room = 0; room < 6u; room += 5u) {
        const uint32_t count = NOH_SKIN_JOINTS_MAX - room;
        const skin_options as_it_is = { .rigid_faces = 0 };
        model *full = lod_drawn_face_model(&face);
        model_skin *skin;
        lod_pack made;
        assert_int_equal(skins_of_faces(full), 0);
        skin = full->skins;
        assert_int_equal(skin->joint_count, 1);
        assert_non_null(skin->joints = realloc(skin->joints, count * sizeof *skin->joints));
        assert_non_null(skin->inverse_bind = realloc(skin->inverse_bind, 16u * count * sizeof *skin->inverse_bind));
        for (size_t j = 1; j < count; j++) {
            skin->joints[j] = skin->joints[0];
            memcpy(skin->inverse_bind + 16u * j, skin->inverse_bind, 16u * sizeof *skin->inverse_bind);
        }
        skin->joint_count = count;
        lod_pack_make_skinned(full, &settings, &as_it_is, &made);
        assert_int_equal(made.mesh.far_joints ? made.mesh.far_joints->joint_count : 0u, room);
        assert_true(room || noh_mesh_at_lod(&made.mesh, LEVELS - 1u).header->touched_count);
        lod_pack_free(&made);
        model_free(full);
    }
}

/* Where a surface is sewn, its points have one set of weights, whatever their normals, and 0 may be -0: else it
 * opens. */
static void points_at_one_place_stay_there(void **state)
{
    enum { COUNT = 12 };
    float place[COUNT][3] = { { 0 } }, normal[COUNT][3] = { { 0 } }, move[COUNT][2][3] = { { { 0 } } };
    float turn[COUNT][2][3] = { { { 0 } } }, share[COUNT];
    const uint16_t parent[COUNT] = { 0 };
    uint8_t slots[COUNT];
    joint_fit f;
    (void)state;
    for (uint32_t i = 0; i < COUNT; i++) {
        const uint32_t at = i / 2u;
        place[i][1] = 0.1f * (float)at;
        place[i][0] = move[i][0][0] = i % 2u ? -0.0f : 0.0f;
        normal[i][i % 2u ? 0 : 2] = 1.0f;
        move[i][0][1] = 0.01f * (float)(at * at);
        move[i][1][2] = at == 2u ? 0.02f : 0.01f;
        turn[i][1][1] = i % 2u ? 0.6f : -0.4f;
        share[i] = 1.0f;
        slots[i] = JOINTS_PER_VERTEX;
    }
    const joint_fit_points points = {
        COUNT, 2, place[0], normal[0], move[0][0], turn[0][0], parent, share, slots, 0.1f
    };
    assert_int_equal(joint_fit_make(&points, 3, &f), 0);
    assert_int_equal(f.joint_count, 3);
    for (uint32_t i = 0; i < COUNT; i += 2u) {
        assert_memory_equal(f.joint + 4u * i, f.joint + 4u * i + 4u, 4);
        assert_memory_equal(f.weight + 4u * i, f.weight + 4u * i + 4u, 16);
    }
    joint_fit_free(&f);
}

/* Finer levels are moved by targets alone: no vertex that they draw follows a virtual joint. */
static void finer_levels_keep_their_targets(void **state)
{
    (void)state;
    for (uint32_t k = 0; k + 1u < LEVELS; k++) {
        const noh_mesh level = noh_mesh_at_lod(&p.mesh, k);
        for (uint32_t i = 0; i < level.header->index_count; i++) {
            uint32_t joints[NOH_INFLUENCES_MAX];
            float weights[NOH_INFLUENCES_MAX];
            (void)noh_mesh_influences(&level, noh_mesh_index(&level, i), joints, weights);
            assert_true(joints[0] == 0 && weights[0] == 1.0f);
        }
    }
}

/* ---- what they do ---- */

static int32_t number_of(uint32_t word, uint32_t i)
{
    const int32_t bits = (int32_t)(word >> 10u * i & 1023u);
    return bits < 512 ? bits : bits - 1024;
}

/* A point moved by one virtual joint in front of a matrix, by the formula of format.h, in double precision. */
static void expect_point(const noh_far_joints_header *h, uint32_t j, const float *weights, const float *matrix,
                         const float point[3], double out[3])
{
    const uint8_t *at = (const uint8_t *)h;
    const float *centre = (const float *)(const void *)(at + h->centres_offset) + 3u * j;
    const float *scale = (const float *)(const void *)(at + h->scales_offset) + 2u * j;
    const uint32_t *motions = (const uint32_t *)(const void *)(at + h->motions_offset);
    double moved[3], b[3] = { 0.0, 0.0, 0.0 }, w[3] = { 0.0, 0.0, 0.0 };
    for (uint32_t t = 0; t < h->target_count; t++) {
        const uint32_t *motion = motions + 2u * (t * h->joint_count + j);
        for (uint32_t i = 0; i < 3u; i++) {
            b[i] += (double)weights[t] * number_of(motion[0], i) * (double)scale[0];
            w[i] += (double)weights[t] * number_of(motion[1], i) * (double)scale[1];
        }
    }
    for (uint32_t i = 0; i < 3u; i++) {
        const uint32_t x = (i + 1u) % 3u, y = (i + 2u) % 3u;
        moved[i] = (double)point[i] + b[i] + w[x] * (double)(point[y] - centre[y]) -
                   w[y] * (double)(point[x] - centre[x]);
    }
    for (uint32_t i = 0; i < 3u; i++) {
        out[i] = (double)matrix[4u * i + 3u];
        for (uint32_t k = 0; k < 3u; k++) out[i] += (double)matrix[4u * i + k] * moved[k];
    }
}

static void fill(test_random *r, float *weights, float *matrices, uint32_t joint_count)
{
    for (uint32_t t = 0; t < TARGETS; t++) weights[t] = test_random_float(r, -1.0f, 2.0f);
    for (uint32_t i = 0; i < 12u * joint_count; i++) matrices[i] = test_random_float(r, -1.0f, 1.0f);
}

static void joints_do_what_their_motions_say(void **state)
{
    const noh_far_joints_header *h = p.mesh.far_joints;
    const noh_mesh far = noh_mesh_at_lod(&p.mesh, LEVELS - 1u);
    const uint32_t joint_count = h->first_joint + h->joint_count;
    float *before = test_zeros(48u * joint_count), *after = test_zeros(48u * joint_count);
    test_random r = test_random_from(40);
    (void)state;
    for (int round = 0; round < 20; round++) {
        float weights[TARGETS], point[3];
        fill(&r, weights, before, joint_count);
        memcpy(after, before, 48u * joint_count);
        for (int i = 0; i < 3; i++) point[i] = test_random_float(&r, -0.1f, 0.1f);
        noh_mesh_move_far_joints(&far, weights, after);
        assert_memory_equal(after, before, 48u * h->first_joint);
        for (uint32_t j = 0; j < h->joint_count; j++) {
            const float *moved = after + 12u * (h->first_joint + j);
            double expected[3];
            expect_point(h, j, weights, before + 12u * (h->first_joint + j), point, expected);
            for (uint32_t i = 0; i < 3u; i++) {
                const float *row = moved + 4u * i;
                const float got = row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3];
                assert_float_equal(got, (float)expected[i], 1e-5);
            }
        }
    }
    free(before);
    free(after);
}

static void finer_levels_and_weights_of_0_move_nothing(void **state)
{
    const noh_far_joints_header *h = p.mesh.far_joints;
    const noh_mesh far = noh_mesh_at_lod(&p.mesh, LEVELS - 1u);
    const uint32_t joint_count = h->first_joint + h->joint_count;
    float *before = test_zeros(48u * joint_count), *after = test_zeros(48u * joint_count), weights[TARGETS];
    test_random r = test_random_from(41);
    (void)state;
    fill(&r, weights, before, joint_count);
    memcpy(after, before, 48u * joint_count);
    noh_mesh_move_far_joints(&p.mesh, weights, after);
    assert_memory_equal(after, before, 48u * joint_count);
    memset(weights, 0, sizeof weights);
    noh_mesh_move_far_joints(&far, weights, after);
    for (uint32_t i = 0; i < 12u * joint_count; i++) assert_true(after[i] == before[i]);
    free(before);
    free(after);
}

/* ---- lies ---- */

typedef struct forged {
    uint8_t *bytes;
    size_t count;
    noh_pack_chunk *chunk;
    noh_far_joints_header *h;
    float *scales, *centres;
    uint32_t *motions;
} forged;

static void forge(forged *f)
{
    f->count = p.byte_count;
    f->bytes = test_aligned(p.bytes, f->count);
    f->chunk = pack_find(f->bytes, NOH_TAG_FAR_JOINTS);
    assert_non_null(f->chunk);
    f->h = (noh_far_joints_header *)(void *)(f->bytes + f->chunk->offset);
    f->centres = (float *)(void *)((uint8_t *)f->h + f->h->centres_offset);
    f->scales = (float *)(void *)((uint8_t *)f->h + f->h->scales_offset);
    f->motions = (uint32_t *)(void *)((uint8_t *)f->h + f->h->motions_offset);
}

/* name, a word of the message, the lie */
#define FORGERIES(X)                                                                 \
    X(mesh_missing, "name a missing mesh", f->h->mesh = 1)                           \
    X(level_0, "do not fit", f->h->level = 0)                                        \
    X(level_past, "do not fit", f->h->level = LEVELS)                                \
    X(level_of_targets, "accumulation texels", f->h->level -= 1)                     \
    X(no_joints, "do not fit", f->h->joint_count = 0)                                \
    X(many_joints, "do not fit", f->h->joint_count = NOH_FAR_JOINTS_MAX + 1u)        \
    X(joints_overflow, "do not fit", f->h->joint_count = 0xffffffffu)                \
    X(fewer_joints, "begin", f->h->joint_count = 1)                                  \
    X(targets, "do not fit", f->h->target_count += 1)                                \
    X(first_joint_past, "do not fit", f->h->first_joint += 1)                        \
    X(first_joint_overflow, "do not fit", f->h->first_joint = 0xffffffffu)           \
    X(normals_below, "do not fit", f->h->normal_error = -1.0f)                       \
    X(normals_nan, "do not fit", f->h->normal_error = (float)NAN)                    \
    X(normals_p99, "do not fit", f->h->normal_error_p99 = 2.0f * f->h->normal_error) \
    X(reserved, "reserved", f->h->reserved[5] = 1)                                   \
    X(centres_elsewhere, "begin", f->h->centres_offset = 0)                          \
    X(scales_elsewhere, "begin", f->h->scales_offset += 16)                          \
    X(motions_elsewhere, "begin", f->h->motions_offset = 0xfffffff0u)                \
    X(centre_nan, "centre", f->centres[1] = (float)NAN)                              \
    X(centre_huge, "10^12", f->centres[0] = 1e30f)                                   \
    X(scale_infinite, "scale", f->scales[1] = (float)INFINITY)                       \
    X(scale_below, "below 0", f->scales[0] = -1.0f)                                  \
    X(motion_bits, "bits above", f->motions[3] |= 0x40000000u)

#include "support/forgeries_template.h"

/* Whatever opens can be used. */
static void every_bit(void **state)
{
    uint32_t opened = 0, refused = 0;
    forged f;
    (void)state;
    forge(&f);
    for (uint32_t bit = 0; bit < 8u * f.chunk->bytes; bit += 3u) {
        uint8_t *byte = (uint8_t *)f.h + bit / 8u;
        noh_pack pack;
        *byte = (uint8_t)(*byte ^ 1u << bit % 8u);
        pack_repair(f.bytes, p.byte_count);
        if (noh_pack_open(f.bytes, p.byte_count, &pack, NULL) == NOH_OK) {
            if (opened++ % 64u == 0u) pack_walk(&pack, 1);
        } else {
            refused++;
        }
        *byte = (uint8_t)(*byte ^ 1u << bit % 8u);
    }
    assert_true(opened > 0 && refused > 0);
    free(f.bytes);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_coarsest_level_has_joints_and_no_targets),
    cmocka_unit_test(a_skin_with_little_room_takes_few),
    cmocka_unit_test(points_at_one_place_stay_there),
    cmocka_unit_test(finer_levels_keep_their_targets),
    cmocka_unit_test(joints_do_what_their_motions_say),
    cmocka_unit_test(finer_levels_and_weights_of_0_move_nothing),
    cmocka_unit_test(lies_are_refused),
    cmocka_unit_test(every_bit),
};

TEST_MAIN(tests, set_up, tear_down)
