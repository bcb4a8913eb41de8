/* What a stage draws alone: a mesh is mirrored if, and only if, the sizes along its axes have a negative product,
 * however it is turned. What it draws together: actors of one look. */
#include "stage/actors/stage_draws_internal.h"

#include <string.h>

#include "noh/low_core.h"
#include "support/stage_fixture.h"
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

/* ---- looks ---- */

#define SETS 2u /* of textures, and the kind's own */
#define EACH 3u /* actors of a look */
#define LOOKS_MOST 80u

static int is_same(const noh_appearance *a, const noh_appearance *b)
{
    return a->texture_set == b->texture_set && a->hidden_meshes == b->hidden_meshes && a->smoothed == b->smoothed &&
           a->wrinkle_models == b->wrinkle_models;
}

/* Look n: the first has no texture set, no hidden meshes and no wrinkles. */
static noh_appearance look_of(uint32_t n)
{
    const noh_appearance look = { .texture_set = n % (SETS + 1u),
                                  .hidden_meshes = n / (SETS + 1u) % 2u,
                                  .smoothed = (uint8_t)(n / (2u * (SETS + 1u))) };
    return look;
}

/* How often neighbours of the order differ in their look, or in their textures alone. */
static uint32_t count_changes(const noh_stage_kind *k, int textures_alone)
{
    uint32_t changes = 0;
    for (uint32_t p = 1; p < noh_stage_seen(k); p++) {
        const noh_appearance *a = &k->actors[k->order[p - 1u]].look, *b = &k->actors[k->order[p]].look;
        changes += textures_alone ? a->texture_set != b->texture_set : !is_same(a, b);
        if (is_same(a, b)) assert_true(k->order[p - 1u] < k->order[p]); /* stable */
    }
    return changes;
}

/* Actors of each look lie together, wherever they are in memory, in the order in which they are there. Of more looks
 * than a table holds, those that do not fit lie one by one among others of their textures, and the others as before. */
static void looks_that_do_not_fit_leave_others_together(void **state)
{
    static const uint32_t counts[] = { 1, 7, LOOKS_MOST, LOOKS_MOST + 1u, LOOKS_MOST + 9u, 2u * LOOKS_MOST };
    (void)state;
    for (size_t n = 0; n < TEST_COUNT(counts); n++) {
        const uint32_t most = counts[n] < LOOKS_MOST ? counts[n] : LOOKS_MOST, left = counts[n] - most;
        const noh_stage_view view = cast_view(0, 30.0f);
        cast c;
        cast_open(&c);
        c.kinds[0] = c.kinds[TUBES];
        c.kinds[0].actor_count = EACH * counts[n];
        c.desc.kind_count = 1;
        c.desc.full_detail = 1;
        cast_make(&c, NULL);
        const noh_stage_kind *k = &c.stage->kinds[0];
        for (uint32_t i = 0; i < EACH * counts[n]; i++) {
            const noh_place place = { .position = { 0.01f * (float)(i % 20u), 0.0f, -0.01f * (float)(i / 20u) } };
            noh_actor actor;
            assert_int_equal(noh_stage_spawn(c.stage, 0, &place, &actor, NULL), NOH_OK);
            k->actors[i].look = look_of(i * 11u % counts[n]); /* a tube has no textures to choose from */
        }
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        const uint32_t changes = count_changes(k, 0), of_textures = count_changes(k, 1);
        print_message("%u looks: %u changes, %u of textures\n", counts[n], changes, of_textures);
        assert_int_equal(noh_stage_seen(k), EACH * counts[n]);
        if (!left) assert_int_equal(changes, counts[n] - 1u);
        assert_true(changes < counts[n] + 2u * EACH * left);
        assert_int_equal(of_textures, counts[n] > SETS ? SETS : 0u);
        cast_close(&c);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(looks_that_do_not_fit_leave_others_together),
    cmocka_unit_test(mirrors_are_known_by_their_sizes),
};

TEST_MAIN(tests, NULL, NULL)
