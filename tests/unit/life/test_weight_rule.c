/* Tests of weight_rule.c: weights stay within what the pack allows, nothing jumps, and who breaks no rule
 * keeps his bits. */
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/pack.h"

#include <math.h>
#include <string.h>

#include "support/support.h"

#define TARGETS 6u
#define ROWS 40u
#define RULES 64u

static const char *const names[TARGETS] = { "smile", "frown", "blink", "o", "u", "smile_blink" };
enum { SMILE, FROWN, BLINK, O, U, SMILE_BLINK };

/* A pack and a mesh of names and rows alone. */
typedef struct face {
    char strings[2048];
    uint32_t used, rule_count;
    noh_pack pack;
    noh_mesh mesh;
    noh_mesh_header header;
    noh_target targets[TARGETS];
    noh_recipe_row rows[ROWS];
    noh_weight_rule rules[RULES];
} face;

static uint32_t add_string(face *f, const char *text)
{
    const uint32_t at = f->used, size = (uint32_t)strlen(text) + 1u;
    assert_true(at + size <= sizeof f->strings);
    memcpy(f->strings + at, text, size);
    f->used += size;
    return at;
}

static void open_face(face *f)
{
    memset(f, 0, sizeof *f);
    f->used = 1;
    for (uint32_t i = 0; i < TARGETS; i++) {
        f->targets[i].name = add_string(f, names[i]);
        f->targets[i].name_hash = noh_hash_name(names[i]);
    }
    f->header.target_count = TARGETS;
    f->mesh.header = &f->header;
    f->mesh.targets = f->targets;
    f->mesh.pack = &f->pack;
    f->pack.strings = f->strings;
    f->pack.string_bytes = sizeof f->strings;
    f->pack.recipe_rows = f->rows;
}

static void add(face *f, const char *target, const char *channel, float weight)
{
    noh_recipe_row *row = &f->rows[f->pack.recipe_row_count++];
    assert_true(f->pack.recipe_row_count <= ROWS);
    memset(row, 0, sizeof *row);
    for (uint32_t i = 0; i < TARGETS; i++) {
        if (strcmp(names[i], target) == 0) row->target = f->targets[i].name;
    }
    if (!row->target) row->target = add_string(f, target);
    row->target_hash = noh_hash_name(target);
    row->channel = add_string(f, channel);
    row->channel_hash = noh_hash_name(channel);
    row->weight = weight;
}

/* A group before opposites before a range: they are kept in the other order. */
static void open_all(face *f)
{
    open_face(f);
    add(f, "o", "=o", 1.0f);
    add(f, "u", "=o", 1.0f);
    add(f, "blink", "=o", 1.0f);
    add(f, "smile", "-frown", 1.0f);
    add(f, "aa", "range-min", -1.0f); /* the mesh has no such target */
    add(f, "aa", "range-max", 1.0f);
    add(f, "smile", "range-min", -0.5f);
    add(f, "smile", "range-max", 1.5f);
    add(f, "blink", "range-min", 0.0f);
    add(f, "blink", "range-max", 1.0f);
    f->rule_count = noh_weight_rules_bind(&f->mesh, f->rules, RULES);
}

static void ranges_hold(void **state)
{
    const float at[] = { -7.0f, -0.5f, -0.25f, 0.0f, 1.0f, 1.5f, 1.75f, 1e30f, NAN };
    const float want[] = { -0.5f, -0.5f, -0.25f, 0.0f, 1.0f, 1.5f, 1.5f, 1.5f, -0.5f };
    face f;
    (void)state;
    open_all(&f);
    assert_int_equal(f.rule_count, 6);
    for (size_t i = 0; i < sizeof at / sizeof at[0]; i++) {
        float w[TARGETS] = { at[i] };
        noh_weight_rules_apply(f.rules, f.rule_count, w);
        assert_true(w[SMILE] == want[i]);
    }
}

/* Base plus sum of weighted deltas, as the book has it, shows the corners of a mouth pulled up and down at once: half
 * of both is a flat mouth that is stretched, which nobody modelled. */
static void opposites_do_not_add_up(void **state)
{
    float w[TARGETS] = { 0.8f, 0.6f, 0.0f, 0.0f, 0.0f, 0.0f }, stretch = w[SMILE] + w[FROWN];
    face f;
    (void)state;
    open_all(&f);
    assert_true(stretch > 1.3f);
    noh_weight_rules_apply(f.rules, f.rule_count, w);
    assert_true(fabsf(w[SMILE] - 0.2f) < 1e-6f && w[FROWN] == 0.0f);
}

/* An expression adds to what its targets have, and its sum is clamped; one that shows whole or not at all is rounded
 * first. It goes before ranges. */
static void expressions_move_other_targets(void **state)
{
    static const float at[] = { -1.0f, 0.0f, 0.25f, 0.75f, 2.0f };
    static const float smiles[] = { 0.5f, 0.5f, 0.625f, 0.75f, 0.75f }, blinks[] = { 0.0f, 0.0f, 0.5f, 1.5f, 2.0f };
    face f;
    (void)state;
    open_face(&f);
    add(&f, "smile", "range-min", 0.0f);
    add(&f, "smile", "range-max", 0.75f);
    add(&f, "smile", ":o", 0.5f);
    add(&f, "blink", ":o", 2.0f);
    add(&f, "o", ":o", 1.0f); /* itself */
    add(&f, "aa", ":o", 1.0f);
    add(&f, "u", ":none", 1.0f);
    f.rule_count = noh_weight_rules_bind(&f.mesh, f.rules, RULES);
    assert_int_equal(f.rule_count, 3);
    for (size_t i = 0; i < sizeof at / sizeof at[0]; i++) {
        float w[TARGETS] = { 0.5f, 0.0f, 0.0f, at[i], -3.0f, 0.0f };
        noh_weight_rules_apply(f.rules, f.rule_count, w);
        assert_true(w[SMILE] == smiles[i] && w[BLINK] == blinks[i] && w[U] == -3.0f);
    }
    add(&f, "o", "binary", 1.0f);
    f.rule_count = noh_weight_rules_bind(&f.mesh, f.rules, RULES);
    assert_int_equal(f.rule_count, 4);
    for (size_t i = 0; i < sizeof at / sizeof at[0]; i++) {
        float w[TARGETS] = { 0.0f, 0.0f, 0.0f, at[i], 0.0f, 0.0f };
        noh_weight_rules_apply(f.rules, f.rule_count, w);
        assert_true(w[O] == (at[i] > 0.5f ? 1.0f : 0.0f) && w[BLINK] == 2.0f * w[O]);
    }
}

static void groups_sum_to_one(void **state)
{
    float w[TARGETS] = { 0.0f, 0.0f, -0.5f, 1.5f, 0.5f, 0.0f };
    face f;
    (void)state;
    open_all(&f);
    noh_weight_rules_apply(f.rules, f.rule_count, w); /* the range of blink is kept first: 0 */
    assert_true(w[O] == 0.75f && w[U] == 0.25f && w[BLINK] == 0.0f);
    f.rules[1] = f.rules[0]; /* without that range negative weights are left alone */
    w[BLINK] = -0.5f;
    noh_weight_rules_apply(f.rules, f.rule_count, w);
    assert_true(w[BLINK] == -0.5f);
}

/* Random weights: rules hold, twice is as once, weights that break no rule keep their bits, and a small step makes a
 * small one. */
static void rules_hold_for_any_weights(void **state)
{
    test_random r = test_random_from(5);
    face f;
    (void)state;
    open_all(&f);
    for (uint32_t trial = 0; trial < 100000; trial++) {
        float w[TARGETS], was[TARGETS], near[TARGETS], sum = 0.0f;
        int keeps = 1;
        for (uint32_t i = 0; i < TARGETS; i++) {
            w[i] = was[i] = test_random_float(&r, -1.0f, 2.0f);
            near[i] = w[i] + test_random_float(&r, -0.001f, 0.001f);
        }
        for (uint32_t i = BLINK; i <= U; i++) sum += w[i] > 0.0f ? w[i] : 0.0f;
        keeps &= w[SMILE] >= -0.5f && w[SMILE] <= 1.5f && w[BLINK] >= 0.0f && w[BLINK] <= 1.0f;
        keeps &= (w[SMILE] <= 0.0f || w[FROWN] <= 0.0f) && sum <= 1.0f;
        noh_weight_rules_apply(f.rules, f.rule_count, w);
        noh_weight_rules_apply(f.rules, f.rule_count, near);
        if (keeps) assert_memory_equal(w, was, sizeof w);
        assert_true(w[SMILE] >= -0.5f && w[SMILE] <= 1.5f && w[BLINK] >= 0.0f && w[BLINK] <= 1.0f);
        assert_true(w[SMILE] <= 0.0f || w[FROWN] <= 0.0f);
        assert_true((w[O] > 0.0f ? w[O] : 0.0f) + (w[U] > 0.0f ? w[U] : 0.0f) + w[BLINK] <= 1.000001f);
        assert_memory_equal(&w[SMILE_BLINK], &was[SMILE_BLINK], sizeof w[0]);
        for (uint32_t i = 0; i < TARGETS; i++) assert_true(fabsf(w[i] - near[i]) < 0.005f);
        memcpy(was, w, sizeof w);
        noh_weight_rules_apply(f.rules, f.rule_count, w);
        for (uint32_t i = 0; i < TARGETS; i++) assert_true(fabsf(w[i] - was[i]) < 1e-6f);
    }
}

static void what_makes_no_rule_is_left_out(void **state)
{
    face f;
    (void)state;
    open_face(&f);
    add(&f, "smile", "-smile", 1.0f);    /* itself */
    add(&f, "smile", "-gone", 1.0f);     /* no such target */
    add(&f, "smile", "range-min", 0.0f); /* without its other end */
    add(&f, "frown", "range-max", 1.0f);
    add(&f, "smile", "range-min", 0.5f); /* without 0 */
    add(&f, "smile", "range-max", 1.0f);
    add(&f, "blink", "aa", 1.0f);
    assert_int_equal(noh_weight_rules_bind(&f.mesh, NULL, 0), 0);
    add(&f, "smile_blink", "range-min", 0.0f);
    add(&f, "smile_blink", "range-max", 1.0f);
    assert_int_equal(noh_weight_rules_bind(&f.mesh, NULL, 0), 1);
    add(&f, "smile_blink", "+smile", 1.0f); /* it follows from others now */
    assert_int_equal(noh_weight_rules_bind(&f.mesh, NULL, 0), 0);
    add(&f, "gone", "=gone", 1.0f); /* a group without its first target */
    add(&f, "u", "=gone", 1.0f);
    add(&f, "o", "=gone", 1.0f);
    assert_int_equal(noh_weight_rules_bind(&f.mesh, f.rules, RULES), 2);
    assert_int_equal(f.rules[0].other, U);
    assert_int_equal(f.rules[1].other, U);
    noh_weight_rules_apply(f.rules, 0, NULL);
}

/* Any rows: every rule refers to targets, and none is written past the room. */
static void any_rows_bind(void **state)
{
    static const char *const channels[] = { "-smile", "=o", "=u", "range-min", "range-max", "+blink", "-", "=", "aa" };
    test_random r = test_random_from(7);
    (void)state;
    for (uint32_t trial = 0; trial < 2000; trial++) {
        face f;
        float w[TARGETS];
        uint32_t count;
        open_face(&f);
        for (uint32_t i = 0; i < ROWS; i++) {
            add(&f, names[test_random_below(&r, TARGETS)], channels[test_random_below(&r, 9)],
                test_random_float(&r, -4.0f, 4.0f));
        }
        memset(f.rules, 0xa5, sizeof f.rules);
        count = noh_weight_rules_bind(&f.mesh, f.rules, 7);
        assert_true(count <= ROWS);
        assert_int_equal(((const uint8_t *)&f.rules[7])[0], 0xa5);
        count = noh_weight_rules_bind(&f.mesh, f.rules, RULES);
        for (uint32_t i = 0; i < count; i++) {
            assert_true(f.rules[i].target < TARGETS && f.rules[i].other < TARGETS);
            assert_true(f.rules[i].low <= 0.0f && f.rules[i].high >= 0.0f);
        }
        for (uint32_t i = 0; i < TARGETS; i++) w[i] = test_random_float(&r, -3.0f, 3.0f);
        noh_weight_rules_apply(f.rules, count, w);
        for (uint32_t i = 0; i < TARGETS; i++) assert_true(w[i] >= -4.0f && w[i] <= 4.0f);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ranges_hold),
        cmocka_unit_test(opposites_do_not_add_up),
        cmocka_unit_test(expressions_move_other_targets),
        cmocka_unit_test(groups_sum_to_one),
        cmocka_unit_test(rules_hold_for_any_weights),
        cmocka_unit_test(what_makes_no_rule_is_left_out),
        cmocka_unit_test(any_rows_bind),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
