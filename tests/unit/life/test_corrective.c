/* Tests of corrective.c: weights that are exact where the shapes were modelled, and never jump. */
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/pack.h"

#include <math.h>
#include <string.h>

#include "support/support.h"

#define TARGETS 12u
#define ROWS 40u
#define TERMS 64u

/* A pack and a mesh of names and rows alone. */
typedef struct face {
    char strings[1024];
    uint32_t used;
    noh_pack pack;
    noh_mesh mesh;
    noh_mesh_header header;
    noh_target targets[TARGETS];
    noh_recipe_row rows[ROWS];
    noh_corrective_term terms[TERMS];
} face;

static uint32_t add_string(face *f, const char *text)
{
    const uint32_t at = f->used, size = (uint32_t)strlen(text) + 1u;
    assert_true(at + size <= sizeof f->strings);
    memcpy(f->strings + at, text, size);
    f->used += size;
    return at;
}

static void open_face(face *f, const char *const *names, uint32_t count)
{
    memset(f, 0, sizeof *f);
    f->used = 1;
    for (uint32_t i = 0; i < count; i++) {
        f->targets[i].name = add_string(f, names[i]);
        f->targets[i].name_hash = noh_hash_name(names[i]);
    }
    f->header.target_count = count;
    f->mesh.header = &f->header;
    f->mesh.targets = f->targets;
    f->mesh.pack = &f->pack;
    f->pack.strings = f->strings;
    f->pack.string_bytes = sizeof f->strings;
    f->pack.recipe_rows = f->rows;
}

static uint32_t offset_of(const face *f, const char *name)
{
    for (uint32_t i = 0; i < f->header.target_count; i++) {
        if (strcmp(f->strings + f->targets[i].name, name) == 0) return f->targets[i].name;
    }
    return 0;
}

static void drive(face *f, const char *target, const char *driver, float peak)
{
    noh_recipe_row *row = &f->rows[f->pack.recipe_row_count++];
    char channel[64] = "+";
    const uint32_t known = offset_of(f, target);
    assert_true(f->pack.recipe_row_count <= ROWS);
    memset(row, 0, sizeof *row);
    strcat(channel, driver);
    row->target = known ? known : add_string(f, target);
    row->target_hash = noh_hash_name(target);
    row->channel = add_string(f, channel);
    row->channel_hash = noh_hash_name(channel);
    row->weight = peak;
}

static const char *const names[] = { "a", "b", "c", "a_b", "a_b_c", "a25", "a75", "a50_b" };

/* Targets 0 to 2 are modelled, 3 is of two of them, 4 of all three, 5 and 6 are in-betweens, 7 is both. */
static uint32_t open_all(face *f)
{
    open_face(f, names, 8);
    drive(f, "a_b", "a", 1.0f);
    drive(f, "a_b", "b", 1.0f);
    drive(f, "a_b_c", "a", 1.0f);
    drive(f, "a_b_c", "b", 1.0f);
    drive(f, "a_b_c", "c", 1.0f);
    drive(f, "a75", "a", 0.75f);
    drive(f, "a25", "a", 0.25f);
    drive(f, "a50_b", "a", 0.5f);
    drive(f, "a50_b", "b", 1.0f);
    return noh_correctives_bind(&f->mesh, f->terms, TERMS);
}

static void corners_are_exact(void **state)
{
    face f;
    const uint32_t count = open_all(&f);
    (void)state;
    assert_int_equal(count, 9);
    for (uint32_t corner = 0; corner < 8; corner++) {
        float w[8] = { 0 };
        for (uint32_t i = 0; i < 3; i++) w[i] = corner >> i & 1u ? 1.0f : 0.0f;
        noh_correctives_apply(f.terms, count, w);
        assert_true(w[3] == ((corner & 3u) == 3u ? 1.0f : 0.0f));
        assert_true(w[4] == (corner == 7u ? 1.0f : 0.0f));
        assert_true(w[5] == 0.0f && w[6] == 0.0f && w[7] == 0.0f);
    }
}

static void in_betweens_are_exact_at_all_peaks(void **state)
{
    static const float at[] = { 0.0f, 0.25f, 0.75f, 1.0f, 1.5f, -1.0f };
    face f;
    const uint32_t count = open_all(&f);
    (void)state;
    for (uint32_t i = 0; i < 6; i++) {
        float w[8] = { at[i], 1.0f };
        noh_correctives_apply(f.terms, count, w);
        assert_true(w[5] == (i == 1 ? 1.0f : 0.0f));
        assert_true(w[6] == (i == 2 ? 1.0f : 0.0f));
        assert_true(w[7] == (i == 1 || i == 2 ? 0.5f : 0.0f)); /* a50_b: half way to its own peak */
    }
}

/* No step of a driver changes a corrective by more than the steepest ramp, 1 / 0.25, times the step. */
static void nothing_jumps(void **state)
{
    face f;
    const uint32_t count = open_all(&f);
    test_random r = test_random_from(3);
    (void)state;
    for (uint32_t path = 0; path < 200; path++) {
        float w[8] = { 0 }, from[3], to[3], before[8];
        for (int i = 0; i < 3; i++) {
            from[i] = test_random_float(&r, -0.2f, 1.2f);
            to[i] = test_random_float(&r, -0.2f, 1.2f);
        }
        for (uint32_t step = 0; step <= 1000; step++) {
            const float t = (float)step / 1000.0f;
            for (int i = 0; i < 3; i++) w[i] = from[i] + (to[i] - from[i]) * t;
            noh_correctives_apply(f.terms, count, w);
            for (int i = 3; i < 8; i++) {
                assert_true(w[i] >= 0.0f && w[i] <= 1.0f);
                if (step) assert_true(fabsf(w[i] - before[i]) <= 3.0f * 4.0f * 1.4f / 1000.0f + 1e-5f);
            }
            memcpy(before, w, sizeof before);
        }
    }
}

/* Targets that are added up as they come, as Granberg's four channels are (Character Animation with Direct3D, chapter
 * 9), miss what was modelled for both: a lip that a smile and an open jaw move 10 mm each, and both together 12. */
static void shapes_modelled_for_both_are_shown(void **state)
{
    face f;
    const uint32_t count = open_all(&f);
    const float deltas[4] = { 10.0f, 10.0f, 0.0f, -8.0f };
    float w[8] = { 1.0f, 1.0f }, added = 0.0f, corrected = 0.0f;
    (void)state;
    for (int i = 0; i < 3; i++) added += deltas[i] * w[i];
    noh_correctives_apply(f.terms, count, w);
    for (int i = 0; i < 4; i++) corrected += deltas[i] * w[i];
    assert_true(fabsf(added - 12.0f) > 7.0f && corrected == 12.0f);
}

static void what_lacks_a_target_is_left_out(void **state)
{
    face f;
    (void)state;
    open_face(&f, names, 4);
    drive(&f, "a_b", "a", 1.0f);
    drive(&f, "a_b", "gone", 1.0f);
    drive(&f, "a_b_c", "a", 1.0f);
    assert_int_equal(noh_correctives_bind(&f.mesh, NULL, 0), 0);
    drive(&f, "c", "b", 1.0f);
    drive(&f, "c", "a", 0.0f); /* no peak */
    assert_int_equal(noh_correctives_bind(&f.mesh, NULL, 0), 0);
    drive(&f, "b", "a", 0.5f);
    assert_int_equal(noh_correctives_bind(&f.mesh, NULL, 0), 1);
    for (uint32_t i = 0; i <= NOH_CORRECTIVE_DRIVERS_MAX; i++) drive(&f, "a_b", "a", 1.0f);
    assert_int_equal(noh_correctives_bind(&f.mesh, NULL, 0), 1);
    assert_int_equal(noh_correctives_bind(&f.mesh, f.terms, 0), 1);
    noh_correctives_apply(f.terms, 0, NULL);
}

/* Channels of faces and drivers, in any order: every term refers to targets, and none is written past the room. */
static void any_rows_bind(void **state)
{
    test_random r = test_random_from(11);
    (void)state;
    for (uint32_t trial = 0; trial < 2000; trial++) {
        face f;
        float w[8];
        uint32_t count;
        open_face(&f, names, 8);
        for (uint32_t i = 0; i < 20; i++) {
            const uint32_t target = (uint32_t)test_random_float(&r, 0.0f, 7.99f),
                           driver = (uint32_t)test_random_float(&r, 0.0f, 7.99f);
            drive(&f, names[target], names[driver], test_random_float(&r, -0.5f, 1.5f));
        }
        memset(f.terms, 0xa5, sizeof f.terms);
        count = noh_correctives_bind(&f.mesh, f.terms, 10);
        assert_int_equal(f.terms[10].target, 0xa5a5);
        count = count < 10 ? count : 10;
        for (uint32_t i = 0; i < count; i++) {
            assert_true(f.terms[i].target < 8 && f.terms[i].driver < 8);
            assert_true(f.terms[i].from < f.terms[i].peak && f.terms[i].peak <= f.terms[i].to);
        }
        for (uint32_t i = 0; i < 8; i++) w[i] = test_random_float(&r, -1.0f, 2.0f);
        noh_correctives_apply(f.terms, count, w);
        for (uint32_t i = 0; i < 8; i++) assert_true(w[i] >= -1.0f && w[i] <= 2.0f);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(corners_are_exact),
        cmocka_unit_test(in_betweens_are_exact_at_all_peaks),
        cmocka_unit_test(nothing_jumps),
        cmocka_unit_test(shapes_modelled_for_both_are_shown),
        cmocka_unit_test(what_lacks_a_target_is_left_out),
        cmocka_unit_test(any_rows_bind),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
