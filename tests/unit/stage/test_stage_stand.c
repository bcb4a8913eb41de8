/* Puppets that play nothing stand: arms down, feet still, the rest never still, and no two alike. */
#include "support/stage_fixture.h"

#include "core/base/vector_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/modules.h"
#include "noh/noh.h"

#include <math.h>
#include <string.h>

static noh_kind_stand stand;
static noh_modifier modifier;

static void open_cast(cast *c, uint32_t jobs)
{
    memset(c, 0, sizeof *c);
    cast_map(c, PUPPETS, "demo/puppet_falls.noh");
    c->kinds[0].mesh = &c->packs[0];
    c->kinds[0].actor_count = 2;
    assert_int_equal(noh_kind_stand_make(&c->kinds[0], &stand, NULL), NOH_OK);
    modifier = noh_stand_modifier(&stand);
    c->kinds[0].modifiers = &modifier;
    c->kinds[0].modifier_count = 1;
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
    c->desc.job_count = jobs;
    cast_make(c, NULL);
}

static void close_cast(cast *c)
{
    cast_close_stage(c);
    noh_file_unmap(&c->files[0]);
}

static void enter(const cast *c, noh_actor actors[2])
{
    const noh_appearance posed = { .posed = 1 };
    const noh_place place = { { 0.0f, 0.0f, 0.0f }, { 0, 0, 0, 0 }, 0.0f };
    for (int i = 0; i < 2; i++) {
        assert_int_equal(noh_stage_spawn(c->stage, 0, &place, &actors[i], NULL), NOH_OK);
        assert_int_equal(noh_actor_set_appearance(c->stage, actors[i], &posed, NULL), NOH_OK);
    }
}

static void joint_at(const cast *c, noh_actor actor, const char *name, float out[12])
{
    const uint32_t joint = noh_stage_find(c->stage, 0, NOH_NAME_JOINT, name);
    assert_true(joint != NOH_NONE);
    assert_int_equal(noh_actor_joint(c->stage, actor, joint, out, NULL), NOH_OK);
}

static float apart(const float a[12], const float b[12])
{
    return hypotf(hypotf(a[3] - b[3], a[7] - b[7]), a[11] - b[11]);
}

static void it_stands_and_lives(void **state)
{
    static const char *const feet[] = { "foot.L", "foot.R" };
    float first[2][12], now[12], other[12], before[12], wide[2] = { 1e3f, -1e3f }, turned[2] = { 1e3f, -1e3f };
    float slid = 0.0f, leap = 0.0f, differs = 0.0f;
    noh_actor actors[2];
    cast c;
    (void)state;
    open_cast(&c, 1);
    enter(&c, actors);
    for (uint32_t f = 0; f < 1800; f++) {
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
        for (int i = 0; i < 2; i++) {
            joint_at(&c, actors[0], feet[i], now);
            if (!f) memcpy(first[i], now, sizeof now);
            slid = fmaxf(slid, apart(first[i], now));
        }
        joint_at(&c, actors[0], "head", now);
        joint_at(&c, actors[1], "head", other);
        differs = fmaxf(differs, apart(now, other));
        if (f) {
            assert_true(memcmp(now, before, sizeof now) != 0);
            leap = fmaxf(leap, apart(now, before));
        }
        memcpy(before, now, sizeof now);
        turned[0] = fminf(turned[0], now[2]);
        turned[1] = fmaxf(turned[1], now[2]);
        joint_at(&c, actors[0], "hips", now);
        wide[0] = fminf(wide[0], now[3]);
        wide[1] = fmaxf(wide[1], now[3]);
        joint_at(&c, actors[0], "hand.L", other);
        assert_true(other[7] < now[7] + 0.05f && fabsf(other[3] - now[3]) < 0.45f); /* next to the hips */
    }
    print_message("hips go %.0f mm from side to side, the head turns by %.2f, feet slide %.2f mm\n",
                  1e3 * (double)(wide[1] - wide[0]), (double)(turned[1] - turned[0]), 1e3 * (double)slid);
    assert_true(slid < 0.001f && leap < 0.004f && differs > 0.01f);
    assert_true(wide[1] - wide[0] > 0.03f && turned[1] - turned[0] > 0.15f);
    close_cast(&c);
}

static void bits_do_not_depend_on_jobs(void **state)
{
    float at[2][12];
    (void)state;
    for (uint32_t jobs = 1; jobs <= 2; jobs++) {
        noh_actor actors[2];
        cast c;
        open_cast(&c, jobs);
        enter(&c, actors);
        for (int f = 0; f < 100; f++) {
            assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
        }
        joint_at(&c, actors[1], "hand.R", at[jobs - 1u]);
        close_cast(&c);
    }
    assert_memory_equal(at[0], at[1], sizeof at[0]);
}

static void what_has_no_limbs_does_not_stand(void **state)
{
    const noh_kind_desc kind = { .mesh = &(noh_pack){ 0 }, .skeleton = NOH_NONE };
    noh_error said;
    (void)state;
    assert_int_equal(noh_kind_stand_make(&kind, &stand, &said), NOH_ERR_NOT_FOUND);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_stands_and_lives),
        cmocka_unit_test(bits_do_not_depend_on_jobs),
        cmocka_unit_test(what_has_no_limbs_does_not_stand),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
