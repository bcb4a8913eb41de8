/* Marks on actors: the ring, where they lie, what fades, what is refused. */
#include "support/stage_fixture.h"

#include "deform/morph/morph_internal.h"
#include "stage/actors/decal_internal.h"
#include "noh/base.h"
#include "noh/marks.h"
#include "noh/noh.h"
#include "noh/pack.h"

#include <math.h>
#include <string.h>

/* A mask in front of the camera, and where a ray through a pixel meets it. */
typedef struct target {
    cast c;
    noh_actor actor;
    noh_stage_view view;
} target;

/* Of the cast's packs, as they are. */
static void show_target(target *t)
{
    const noh_appearance posed = { .posed = 1 };
    float sphere[4];
    t->c.desc.full_detail = 1;
    cast_make(&t->c, NULL);
    assert_int_equal(noh_stage_spawn(t->c.stage, MASKS, NULL, &t->actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(t->c.stage, t->actor, &posed, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame(t->c.stage, 0, NULL, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_sphere(t->c.stage, t->actor, sphere, NULL), NOH_OK);
    noh_view_orbit(&t->view, sphere, 0.3f, 0.1f, 1.0f * sphere[3], 640, 360);
    assert_int_equal(noh_stage_frame(t->c.stage, CAST_STEP, &t->view, NULL, NULL, NULL), NOH_OK);
}

static void open_target(target *t)
{
    memset(t, 0, sizeof *t);
    cast_open(&t->c);
    show_target(t);
}

static void close_target(target *t)
{
    cast_close_stage(&t->c);
    cast_close(&t->c);
}

static int pick(target *t, float x, float y, noh_stage_hit *hit)
{
    float origin[3], direction[3];
    assert_int_equal(noh_view_ray(&t->view, x, y, 640, 360, origin, direction), 1);
    return noh_stage_pick(t->c.stage, origin, direction, 1e6f, hit, NULL) == NOH_OK;
}

static double dot3(const float *a, const float *b)
{
    return (double)a[0] * (double)b[0] + (double)a[1] * (double)b[1] + (double)a[2] * (double)b[2];
}

static void a_mark_lies_where_the_ray_hit(void **state)
{
    noh_decal_desc look = { .size = 0.02f };
    noh_decals ring;
    noh_stage_hit hit;
    uint32_t struck = 0;
    target t;
    (void)state;
    open_target(&t);
    noh_decals_init(&ring, 0, 0, 0);
    for (int y = 60; y < 300; y += 12) {
        for (int x = 200; x < 440; x += 12) {
            const noh_decal *d;
            uint32_t at;
            if (!pick(&t, (float)x, (float)y, &hit)) continue;
            look.roll_rad = 0.1f * (float)(x % 60);
            assert_int_equal(noh_decals_strike(&ring, t.c.stage, &hit, &look, &at, NULL), NOH_OK);
            d = &ring.decals[at];
            assert_int_equal(d->mesh, hit.mesh);
            assert_memory_equal(d->centre, hit.bind_point, sizeof d->centre);
            assert_true(fabs(dot3(d->normal, d->normal) - 1.0) < 1e-5 && fabs(dot3(d->right, d->right) - 1.0) < 1e-5);
            assert_true(fabs(dot3(d->normal, d->right)) < 1e-5);
            assert_null(noh_decals_check(&ring));
            struck++;
        }
    }
    assert_true(struck > 60);
    close_target(&t);
}

/* The book's p = A + u (B A) + v (C A) has lost its minus: read as a sum it leaves the triangle. Ours is the point that
 * the corners' weights give. */
static void the_point_lies_in_its_triangle(void **state)
{
    noh_stage_hit hit;
    noh_mesh mesh;
    target t;
    double ours = 0.0, book = 0.0;
    (void)state;
    open_target(&t);
    assert_true(pick(&t, 310.0f, 190.0f, &hit));
    assert_int_equal(noh_pack_mesh_at(&t.c.packs[MASKS], hit.mesh, &mesh, NULL), NOH_OK);
    for (int k = 0; k < 3; k++) {
        double p[3], right, sum;
        for (uint32_t i = 0; i < 3; i++) {
            p[i] = (double)mesh.positions[3u * noh_mesh_index(&mesh, 3u * hit.triangle + i) + (uint32_t)k];
        }
        right = p[0] + (double)hit.barycentric[1] * (p[1] - p[0]) + (double)hit.barycentric[2] * (p[2] - p[0]);
        sum = p[0] + (double)hit.barycentric[1] * (p[1] + p[0]) + (double)hit.barycentric[2] * (p[2] + p[0]);
        ours = fmax(ours, fabs(right - (double)hit.bind_point[k]));
        book = fmax(book, fabs(sum - (double)hit.bind_point[k]));
    }
    assert_true(ours < 1e-6 && book > 0.01);
    close_target(&t);
}

/* The source crosses up with the normal: on what lies flat there is nothing to divide by. Ours has up to -Z there. */
static void up_along_the_normal_stays_finite(void **state)
{
    const noh_decal_desc look = { .size = 0.02f };
    noh_decals ring;
    noh_mesh mesh;
    uint32_t at;
    target t;
    (void)state;
    memset(&t, 0, sizeof t);
    cast_open(&t.c);
    const noh_file *file = &t.c.files[1];
    uint8_t *copy = test_aligned(file->data, file->bytes);
    t.c.packs[MASKS] = test_open(copy, file->bytes);
    assert_int_equal(noh_pack_mesh_at(&t.c.packs[MASKS], 0, &mesh, NULL), NOH_OK);
    for (uint32_t i = 0; i < 3; i++) /* laid flat */
        ((float *)(uintptr_t)mesh.positions)[3u * noh_mesh_index(&mesh, i) + 1u] = 0.0f;
    show_target(&t);
    noh_stage_hit hit = { .actor = t.actor, .mesh = 0, .triangle = 0 };
    memcpy(hit.bind_point, mesh.positions + 3u * noh_mesh_index(&mesh, 0), sizeof hit.bind_point);
    noh_decals_init(&ring, 0, 0, 0);
    assert_int_equal(noh_decals_strike(&ring, t.c.stage, &hit, &look, &at, NULL), NOH_OK);
    const noh_decal *d = &ring.decals[at];
    const float book[3] = { d->normal[2], 0.0f, -d->normal[0] }; /* (0, 1, 0) x normal */
    assert_true(fabs(fabs((double)d->normal[1]) - 1.0) < 1e-6);
    assert_true(dot3(book, book) < 1e-12);
    assert_null(noh_decals_check(&ring));
    assert_true(fabs(dot3(d->right, d->right) - 1.0) < 1e-5 && fabs(dot3(d->normal, d->right)) < 1e-5);
    const double up_z = (double)d->normal[0] * (double)d->right[1] - (double)d->normal[1] * (double)d->right[0];
    assert_true(up_z < -0.999);
    close_target(&t);
    free(copy);
}

/* How far a hit is from its triangle, as the mesh is with these weights. */
static double off_triangle(const noh_mesh *mesh, const float *weights, const noh_stage_hit *hit)
{
    double square = 0.0, at[3] = { 0.0, 0.0, 0.0 };
    for (uint32_t i = 0; i < 3; i++) {
        float p[3];
        noh_morph_position_by(mesh, weights, noh_mesh_index(mesh, 3u * hit->triangle + i), p);
        for (int k = 0; k < 3; k++) at[k] += (double)hit->barycentric[i] * (double)p[k];
    }
    for (int k = 0; k < 3; k++) square += (at[k] - (double)hit->point[k]) * (at[k] - (double)hit->point[k]);
    return sqrt(square);
}

/* The book's clone of a mesh has its bones, but not its face: where a mouth is open, a ray would strike lips that are
 * shut. */
static void a_face_is_hit_as_it_smiles(void **state)
{
    static const char *const names[] = { "jawOpen", "mouthSmileLeft", "mouthSmileRight" };
    double worst = 0.0, literal = 0.0;
    float weights[NOH_TARGETS_MAX], rest[NOH_TARGETS_MAX] = { 0 };
    uint32_t hits = 0;
    noh_stage_hit hit;
    noh_mesh mesh;
    target t;
    (void)state;
    open_target(&t);
    for (uint32_t i = 0; i < 3; i++) {
        const uint32_t at = noh_stage_find(t.c.stage, MASKS, NOH_NAME_FLOAT, names[i]);
        assert_true(at != NOH_NONE);
        assert_int_equal(noh_actor_hold_float(t.c.stage, t.actor, at, 0.8f, 1.0f, NULL), NOH_OK);
    }
    assert_int_equal(noh_stage_frame(t.c.stage, CAST_STEP, &t.view, NULL, NULL, NULL), NOH_OK);
    for (int y = 60; y < 300; y += 17) {
        for (int x = 200; x < 440; x += 17) {
            if (!pick(&t, (float)x, (float)y, &hit)) continue;
            assert_int_equal(noh_pack_mesh_at(&t.c.packs[MASKS], hit.mesh, &mesh, NULL), NOH_OK);
            for (uint32_t i = 0; i < mesh.header->target_count; i++) {
                const char *name = noh_pack_string(mesh.pack, mesh.targets[i].name);
                weights[i] = 0.0f;
                for (uint32_t n = 0; n < 3; n++) weights[i] = strcmp(name, names[n]) == 0 ? 0.8f : weights[i];
            }
            worst = fmax(worst, off_triangle(&mesh, weights, &hit));
            literal = fmax(literal, off_triangle(&mesh, rest, &hit));
            hits++;
        }
    }
    print_message("%u hits, at most %.3g off; from the shut mouth %.3g\n", hits, worst, literal);
    assert_true(hits > 80 && worst < 1e-5 && literal > 0.005);
    close_target(&t);
}

/* 10,000 hits in a ring of 64: nothing grows, the newest are there, and close ones take each other's place. */
static void a_ring_is_never_full(void **state)
{
    noh_decal_desc look = { .size = 0.001f };
    noh_decals ring;
    noh_stage_hit hit;
    uint32_t at, before = NOH_NONE;
    target t;
    (void)state;
    open_target(&t);
    noh_decals_init(&ring, 0, 0, 0);
    assert_true(pick(&t, 310.0f, 190.0f, &hit));
    for (uint32_t i = 0; i < 10000u; i++) {
        noh_stage_hit next = hit;
        next.bind_point[0] += 0.003f * (float)(i % 1000u);
        assert_int_equal(noh_decals_strike(&ring, t.c.stage, &next, &look, &at, NULL), NOH_OK);
        assert_int_equal(at, i % NOH_DECALS_MAX);
    }
    for (uint32_t i = 0; i < 50u; i++) { /* by less than a quarter of their size */
        hit.bind_point[1] += 0.00001f * (float)(i % 2u);
        look.tile = 7;
        assert_int_equal(noh_decals_strike(&ring, t.c.stage, &hit, &look, &at, NULL), NOH_OK);
        assert_true(before == NOH_NONE || at == before);
        before = at;
    }
    look.tile = 8; /* another sort does not */
    assert_int_equal(noh_decals_strike(&ring, t.c.stage, &hit, &look, &at, NULL), NOH_OK);
    assert_int_not_equal(at, before);
    noh_decals_init(&ring, 3, 0, 0);
    for (uint32_t i = 0; i < 7u; i++) {
        hit.bind_point[2] += 1.0f;
        assert_int_equal(noh_decals_strike(&ring, t.c.stage, &hit, &look, &at, NULL), NOH_OK);
        assert_int_equal(at, i % 3u);
    }
    close_target(&t);
}

static void marks_fade(void **state)
{
    const noh_decal_desc look = { .size = 0.02f };
    noh_decals ring, copy;
    noh_stage_hit hit;
    target t;
    (void)state;
    open_target(&t);
    noh_decals_init(&ring, 0, 1000, 4000);
    assert_true(pick(&t, 310.0f, 190.0f, &hit));
    assert_int_equal(noh_decals_strike(&ring, t.c.stage, &hit, &look, NULL, NULL), NOH_OK);
    copy = ring;
    noh_decals_step(&ring, 1000);
    assert_true(noh_decal_alpha(&ring, 0) == 1.0f);
    noh_decals_step(&ring, 1000);
    assert_true(fabsf(noh_decal_alpha(&ring, 0) - 0.75f) < 1e-6f);
    noh_decals_step(&ring, 3000);
    assert_true(noh_decal_alpha(&ring, 0) == 0.0f && ring.decals[0].mesh == NOH_NONE);
    noh_decals_step(&copy, UINT32_MAX);
    noh_decals_step(&copy, UINT32_MAX);
    assert_int_equal(copy.decals[0].mesh, NOH_NONE);
    noh_decals_init(&ring, 0, 0, 0); /* stays */
    assert_int_equal(noh_decals_strike(&ring, t.c.stage, &hit, &look, NULL, NULL), NOH_OK);
    noh_decals_step(&ring, UINT32_MAX);
    noh_decals_step(&ring, 10);
    assert_true(noh_decal_alpha(&ring, 0) == 1.0f);
    close_target(&t);
}

static void what_is_wrong_is_refused(void **state)
{
    const float nan = NAN;
    noh_decal_desc look = { .size = 0.02f };
    noh_decals ring, before, bad;
    noh_stage_hit hit;
    target t;
    (void)state;
    open_target(&t);
    noh_decals_init(&ring, 4, 0, 0);
    assert_true(pick(&t, 310.0f, 190.0f, &hit));
    assert_int_equal(noh_decals_strike(&ring, t.c.stage, &hit, &look, NULL, NULL), NOH_OK);
    before = ring;
    look.size = 0.0f;
    assert_int_equal(noh_decals_strike(&ring, t.c.stage, &hit, &look, NULL, NULL), NOH_ERR_ARG);
    look.size = nan;
    assert_int_equal(noh_decals_strike(&ring, t.c.stage, &hit, &look, NULL, NULL), NOH_ERR_ARG);
    look.size = 0.1f, look.roughness = 1.1f;
    assert_int_equal(noh_decals_strike(&ring, t.c.stage, &hit, &look, NULL, NULL), NOH_ERR_ARG);
    look.roughness = 0.0f, look.roll_rad = INFINITY;
    assert_int_equal(noh_decals_strike(&ring, t.c.stage, &hit, &look, NULL, NULL), NOH_ERR_ARG);
    look.roll_rad = 0.0f, hit.triangle = 0x7fffffffu;
    assert_int_equal(noh_decals_strike(&ring, t.c.stage, &hit, &look, NULL, NULL), NOH_ERR_NOT_FOUND);
    hit.triangle = 0, hit.mesh = 99;
    assert_int_equal(noh_decals_strike(&ring, t.c.stage, &hit, &look, NULL, NULL), NOH_ERR_NOT_FOUND);
    assert_true(pick(&t, 310.0f, 190.0f, &hit));
    assert_int_equal(noh_stage_despawn(t.c.stage, t.actor, NULL), NOH_OK);
    assert_int_equal(noh_decals_strike(&ring, t.c.stage, &hit, &look, NULL, NULL), NOH_ERR_NOT_FOUND);
    assert_memory_equal(&ring, &before, sizeof ring);
#define LIE(change)                              \
    do {                                         \
        bad = ring;                              \
        change;                                  \
        assert_non_null(noh_decals_check(&bad)); \
    } while (0)
    assert_null(noh_decals_check(&ring));
    LIE(bad.capacity = 0);
    LIE(bad.capacity = NOH_DECALS_MAX + 1u);
    LIE(bad.next = 4);
    LIE(bad.decals[0].centre[1] = nan);
    LIE(bad.decals[0].centre[1] = 3e38f);
    LIE(bad.decals[0].normal[0] += 0.5f);
    LIE(bad.decals[0].right[0] += 0.9f);
    LIE(bad.decals[0].size = 0.0f);
    LIE(bad.decals[0].size = nan);
    LIE(bad.decals[0].roughness = -0.1f);
    close_target(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mark_lies_where_the_ray_hit),
        cmocka_unit_test(the_point_lies_in_its_triangle),
        cmocka_unit_test(up_along_the_normal_stays_finite),
        cmocka_unit_test(a_face_is_hit_as_it_smiles),
        cmocka_unit_test(a_ring_is_never_full),
        cmocka_unit_test(marks_fade),
        cmocka_unit_test(what_is_wrong_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
