/* What a stage draws alone: a mesh is mirrored if, and only if, the sizes along its axes have a negative product,
 * however it is turned. */
#include "stage/actors/stage_draws_internal.h"

#include <string.h>

#include "noh/low_core.h"
#include "support/support.h"

static uint32_t state_of_draws = 5;

static float between(float low, float high)
{
    state_of_draws = state_of_draws * 1664525u + 1013904223u;
    return low + (high - low) * (float)(state_of_draws >> 8) / 16777216.0f;
}

/* A turned place [3][4] with sizes of given signs (bits). */
static void make_place(uint32_t negative, float w[12])
{
    float q[4];
    for (int i = 0; i < 4; i++) q[i] = between(-1.0f, 1.0f);
    noh_quat_normalize(q);
    for (int axis = 0; axis < 3; axis++) {
        float way[3] = { 0 };
        way[axis] = between(0.2f, 5.0f) * (negative >> axis & 1u ? -1.0f : 1.0f);
        noh_quat_rotate(q, way, way);
        for (int row = 0; row < 3; row++) w[4 * row + axis] = way[row];
    }
    for (int row = 0; row < 3; row++) w[4 * row + 3] = between(-9.0f, 9.0f);
}

static void mirrors_are_known_by_their_sizes(void **state)
{
    (void)state;
    for (int i = 0; i < 800; i++) {
        const uint32_t negative = (uint32_t)i % 8u;
        const int mirrored = (int)((negative ^ negative >> 1 ^ negative >> 2) & 1u);
        float place[12];
        noh_stage_mesh mesh;
        noh_stage_actor actor;
        noh_stage_shown shown;
        memset(&mesh, 0, sizeof mesh);
        memset(&actor, 0, sizeof actor);
        memset(&shown, 0, sizeof shown);
        make_place(negative, place);
        mesh.node_world = place;
        assert_int_equal(noh_stage_is_mirrored(&mesh, &actor, &shown), mirrored);
        mesh.skinned = 1; /* its joints place it */
        memcpy(shown.world, place, sizeof place);
        assert_int_equal(noh_stage_is_mirrored(&mesh, &actor, &shown), 0);
        actor.parent = 1;
        assert_int_equal(noh_stage_is_mirrored(&mesh, &actor, &shown), mirrored);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(mirrors_are_known_by_their_sizes),
};

TEST_MAIN(tests, NULL, NULL)
