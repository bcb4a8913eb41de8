/* Spots under actors: where they are, how dark, on floors and slopes. */
#include "support/stage_fixture.h"

#include "noh/base.h"
#include "noh/body.h"
#include "noh/marks.h"
#include "noh/noh.h"
#include "noh/pack.h"

#include <math.h>

typedef struct under {
    noh_plane plane;
    noh_world world;
    noh_ground ground;
} under;

static void floor_at(under *u, float y)
{
    memset(u, 0, sizeof *u);
    u->plane.normal[1] = 1.0f;
    u->plane.distance = y;
    u->world.planes = &u->plane;
    u->world.plane_count = 1;
    u->ground.world = &u->world;
}

static noh_actor posed(cast *c, uint32_t kind, const noh_place *place)
{
    const noh_appearance look = { .posed = 1 };
    noh_actor actor;
    assert_int_equal(noh_stage_spawn(c->stage, kind, place, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(c->stage, actor, &look, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame(c->stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    return actor;
}

static double darkest(const noh_blob *blobs, uint32_t count)
{
    double most = 0.0;
    for (uint32_t i = 0; i < count; i++) most = fmax(most, (double)blobs[i].darkness);
    return most;
}

/* Of the two joints that carry the feet. */
static void near_feet(const cast *c, noh_actor actor, const noh_blob *blobs, uint32_t count)
{
    static const char *const names[2] = { "foot.L", "foot.R" };
    for (int side = 0; side < 2; side++) {
        const uint32_t joint = noh_stage_find(c->stage, PUPPETS, NOH_NAME_JOINT, names[side]);
        double nearest = 1.0;
        float m[12];
        assert_int_equal(noh_actor_joint(c->stage, actor, joint, m, NULL), NOH_OK);
        for (uint32_t i = 0; i < count; i++) {
            if (blobs[i].darkness > 0.4f)
                nearest = fmin(nearest,
                               hypot((double)(blobs[i].centre[0] - m[3]), (double)(blobs[i].centre[2] - m[11])));
        }
        if (!(nearest < 0.12)) fail_msg("the nearest dark spot is %g m from %s", nearest, names[side]);
    }
}

static void who_stands_has_spots_under_the_feet(void **state)
{
    const noh_place place = { { 3.0f, 0.5f, -2.0f }, { 0, 0.6f, 0, 0.8f }, 1.0f };
    noh_blob blobs[NOH_BLOBS_MAX];
    noh_blob_rig rig;
    double before = 1.0;
    noh_actor actor;
    uint32_t count;
    under u;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    assert_int_equal(noh_blob_rig_make(&c.kinds[PUPPETS], &rig, NULL), NOH_OK);
    assert_true(rig.body_count > 8 && rig.body_count <= NOH_BLOBS_MAX);
    floor_at(&u, 0.5f);
    assert_int_equal(noh_stage_spawn(c.stage, PUPPETS, &place, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_blobs(c.stage, actor, &rig, &u.ground, blobs), 0); /* never posed */
    assert_int_equal(noh_stage_despawn(c.stage, actor, NULL), NOH_OK);
    actor = posed(&c, PUPPETS, &place);
    count = noh_actor_blobs(c.stage, actor, &rig, &u.ground, blobs);
    near_feet(&c, actor, blobs, count);
    for (uint32_t i = 0; i < count; i++) assert_true(fabsf(blobs[i].centre[1] - 0.5f) < 1e-5f);
    for (int k = 0; k < 4; k++) { /* the floor sinks */
        floor_at(&u, 0.45f - 0.1f * (float)k);
        count = noh_actor_blobs(c.stage, actor, &rig, &u.ground, blobs);
        assert_true(darkest(blobs, count) < before);
        before = darkest(blobs, count);
    }
    floor_at(&u, -4.0f);
    assert_int_equal(noh_actor_blobs(c.stage, actor, &rig, &u.ground, blobs), 0);
    assert_int_equal(noh_stage_despawn(c.stage, actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_blobs(c.stage, actor, &rig, &u.ground, blobs), 0);
    cast_close_stage(&c);
    cast_close(&c);
}

/* Moments of a box from above, by a rig of one box that is turned about y, leans and is scaled. */
static void spots_have_the_shape_of_what_is_above(void **state)
{
    const noh_place place = { { 0 }, { 0, 0.3826834f, 0, 0.9238795f }, 2.0f }; /* 45 degrees */
    noh_blob_rig rig = { .body_count = 1 };
    noh_blob_body *b = &rig.bodies[0];
    noh_blob blob[NOH_BLOBS_MAX];
    double along, across;
    under u;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    b->joint = NOH_NONE;
    b->half[0][0] = 0.3f, b->half[1][1] = 0.05f, b->half[2][2] = 0.1f;
    b->centre[1] = 0.05f;
    floor_at(&u, 0.0f);
    assert_int_equal(noh_actor_blobs(c.stage, posed(&c, MASKS, &place), &rig, &u.ground, blob), 1);
    along = hypot((double)blob->along[0], (double)blob->along[2]);
    across = hypot((double)blob->across[0], (double)blob->across[2]);
    assert_true(fabs(along / across - 3.0) < 1e-4 && fabs((double)blob->darkness - 0.67) < 1e-4);
    assert_true(fabs(fabs((double)blob->along[0] / along) - sqrt(0.5)) < 1e-4);
    assert_true(fabs((double)(blob->along[0] * blob->across[0] + blob->along[2] * blob->across[2])) < 1e-5);
    /* a slope: spots lie in it */
    u.plane.normal[0] = 0.6f, u.plane.normal[1] = 0.8f;
    u.plane.distance = -0.05f;
    assert_int_equal(noh_actor_blobs(c.stage, noh_stage_actor_at(c.stage, cast_counts[PUPPETS]), &rig, &u.ground, blob),
                     1);
    assert_true(fabs(0.6 * (double)blob->along[0] + 0.8 * (double)blob->along[1]) < 1e-5);
    assert_true(fabs(0.6 * (double)blob->across[0] + 0.8 * (double)blob->across[1]) < 1e-5);
    assert_true(fabs(0.8 * (double)blob->centre[1] + 0.6 * (double)blob->centre[0] + 0.05) < 1e-5);
    cast_close_stage(&c);
    cast_close(&c);
}

/* A mesh without joints has its own box; a kind that draws nothing has none. */
static void rigid_meshes_have_their_box(void **state)
{
    const uint32_t nothing = NOH_NONE;
    noh_kind_desc kind;
    noh_blob_rig rig;
    noh_error error;
    noh_mesh mesh;
    cast c;
    (void)state;
    cast_open(&c);
    kind = c.kinds[MASKS];
    kind.skeleton = NOH_NONE;
    assert_int_equal(noh_blob_rig_make(&kind, &rig, NULL), NOH_OK);
    assert_int_equal(rig.bodies[0].joint, NOH_NONE);
    assert_int_equal(noh_pack_mesh_at(kind.mesh, 0, &mesh, NULL), NOH_OK);
    for (int i = 0; i < 3; i++) {
        const float half = 0.5f * (mesh.header->bounds_max[i] - mesh.header->bounds_min[i]);
        assert_true(fabsf(rig.bodies[0].half[i][i] - half) < 1e-5f);
    }
    kind.nodes = &nothing;
    kind.node_count = 1;
    assert_int_equal(noh_blob_rig_make(&kind, &rig, &error), NOH_ERR_NOT_FOUND);
    cast_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(who_stands_has_spots_under_the_feet),
        cmocka_unit_test(spots_have_the_shape_of_what_is_above),
        cmocka_unit_test(rigid_meshes_have_their_box),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
