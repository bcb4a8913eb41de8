/* The springs of a pack: what a text says is what is there; lies are refused, and whatever opens can be used. */
#include "support/springs_fixture.h"

#include <math.h>
#include <stdlib.h>

#include "support/pack_walk.h"
#include "stage/modules/springs_internal.h"
#include "noh/modules.h"

static uint8_t *good;
static size_t good_count;

static int set_up(void **state)
{
    (void)state;
    good = springs_fixture_pack(&good_count);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    free(good);
    return 0;
}

static const char *joint_name(const noh_pack *pack, const noh_springs_desc *d, uint32_t row)
{
    return noh_pack_joint_name(pack, 0, d->rows[row].joint);
}

/* A tail that forks is two chains: the longer way, and behind it the other, which is attached to it. */
static void a_text_becomes_chains(void **state)
{
    const noh_pack pack = test_open(good, good_count);
    noh_springs_desc d;
    int tail = -1, fork = -1, scarf = -1;
    (void)state;
    assert_true(noh_springs_of_pack(&pack, 0, &d));
    assert_false(noh_springs_of_pack(&pack, 1, &d));
    assert_int_equal(d.chain_count, 3);
    assert_int_equal(d.row_count, 8);
    assert_int_equal(d.collider_count, 2);
    for (uint32_t i = 0; i < 3; i++) {
        const char *name = joint_name(&pack, &d, d.chains[i].first_row);
        if (strcmp(name, "tail1") == 0) tail = (int)i;
        if (strcmp(name, "tail3") == 0) fork = (int)i;
        if (strcmp(name, "scarf1") == 0) scarf = (int)i;
    }
    assert_true(tail >= 0 && fork > tail && scarf >= 0);
    assert_int_equal(d.chains[tail].row_count, 4);
    assert_string_equal(joint_name(&pack, &d, d.chains[tail].first_row + 3), "tail5");
    assert_float_equal(d.chains[tail].end[1], -10.0f, 1e-5);
    assert_float_equal(d.chains[fork].end[1], -12.0f, 1e-5);
    assert_int_equal(d.chains[scarf].row_count, 2);
    assert_int_equal(d.chains[tail].collides, 3);
    assert_int_equal(d.chains[scarf].collides, 2);
    assert_float_equal(d.rows[d.chains[tail].first_row].stiffness, 0.8f, 1e-6);
    assert_float_equal(d.rows[d.chains[tail].first_row].gravity[1], -0.5f, 1e-6);
    assert_float_equal(d.rows[d.chains[scarf].first_row].drag, 0.4f, 1e-6);
    assert_float_equal(d.metres, 0.01f, 1e-8);
    assert_float_equal(d.colliders[0].to[1], 20.0f, 1e-5);
}

typedef struct forged {
    uint8_t *bytes;
    size_t count;
    noh_pack_chunk *chunk;
    noh_springs_header *h;
    noh_spring_row *rows;
    noh_spring_chain *chains;
    noh_spring_capsule *colliders;
} forged;

static void forge(forged *f)
{
    f->count = good_count;
    f->bytes = test_aligned(good, f->count);
    f->chunk = pack_find(f->bytes, NOH_TAG_SPRINGS);
    assert_non_null(f->chunk);
    f->h = (noh_springs_header *)(void *)(f->bytes + f->chunk->offset);
    f->rows = (noh_spring_row *)(void *)((uint8_t *)f->h + f->h->rows_offset);
    f->chains = (noh_spring_chain *)(void *)((uint8_t *)f->h + f->h->chains_offset);
    f->colliders = (noh_spring_capsule *)(void *)((uint8_t *)f->h + f->h->colliders_offset);
}

#define NOT_A_NUMBER ((float)NAN)

/* name, a word of the message, the lie */
#define FORGERIES(X)                                                                \
    X(skeleton_missing, "name a missing skeleton", f->h->skeleton = 1)              \
    X(joint_count, "count of springs", f->h->joint_count += 1)                      \
    X(no_rows, "count of springs", f->h->row_count = 0)                             \
    X(rows_overflow, "count of springs", f->h->row_count = 0xffffffffu)             \
    X(row_more, "begin", f->h->row_count += 1)                                      \
    X(no_chains, "count of springs", f->h->chain_count = 0)                         \
    X(chains_overflow, "count of springs", f->h->chain_count = 0xffffffffu)         \
    X(colliders_overflow, "count of springs", f->h->collider_count = 33)            \
    X(reserved, "reserved field", f->h->reserved[3] = 1)                            \
    X(rows_elsewhere, "begin", f->h->rows_offset += 16)                             \
    X(chains_elsewhere, "begin", f->h->chains_offset = 0)                           \
    X(colliders_elsewhere, "begin", f->h->colliders_offset = 0xfffffff0u)           \
    X(collider_less, "longer", f->h->collider_count -= 1)                           \
    X(joint_missing, "row of springs", f->rows[1].joint = 1000)                     \
    X(joint_root, "row of springs", f->rows[0].joint = 0)                           \
    X(joint_no_child, "row of springs", f->rows[1].joint = f->rows[2].joint)        \
    X(stiffness_below, "row of springs", f->rows[0].stiffness = -1.0f)              \
    X(stiffness_nan, "row of springs", f->rows[5].stiffness = NOT_A_NUMBER)         \
    X(drag_above, "row of springs", f->rows[2].drag = 1.5f)                         \
    X(radius_infinite, "row of springs", f->rows[2].radius = (float)INFINITY)       \
    X(gravity_nan, "row of springs", f->rows[2].gravity[2] = NOT_A_NUMBER)          \
    X(gravity_huge, "row of springs", f->rows[2].gravity[0] = 1e30f)                \
    X(first_row, "out of order", f->chains[1].first_row += 1)                       \
    X(chain_empty, "chain of springs", f->chains[0].row_count = 0)                  \
    X(chain_long, "chain of springs", f->chains[2].row_count = 0xffffffffu)         \
    X(chain_short, "row of springs is in no chain", f->chains[2].row_count -= 1)    \
    X(collides, "chain of springs", f->chains[0].collides = 4)                      \
    X(end_zero, "chain of springs", memset(f->chains[1].end, 0, 12))                \
    X(end_nan, "chain of springs", f->chains[1].end[0] = NOT_A_NUMBER)              \
    X(collider_joint, "collider of springs", f->colliders[0].joint = 99)            \
    X(collider_from, "collider of springs", f->colliders[0].from[1] = NOT_A_NUMBER) \
    X(collider_radius, "collider of springs", f->colliders[1].radius = -1.0f)

#include "support/forgeries_template.h"

/* A joint in two rows: in a chain of its own, which nothing else is wrong with. */
static void a_joint_swings_once(void **state)
{
    noh_error error;
    noh_pack pack;
    forged f;
    (void)state;
    forge(&f);
    f.rows[f.chains[2].first_row].joint = f.rows[f.chains[0].first_row].joint;
    f.rows[f.chains[2].first_row + f.chains[2].row_count - 1u].joint =
        f.rows[f.chains[0].first_row + (f.chains[2].row_count - 1u)].joint;
    pack_repair(f.bytes, good_count);
    assert_int_equal(noh_pack_open(f.bytes, good_count, &pack, &error), NOH_ERR_DATA);
    assert_non_null(strstr(error.what, "in two rows"));
    free(f.bytes);
}

static void every_bit_and_every_cut(void **state)
{
    uint32_t opened = 0, refused = 0;
    forged f;
    (void)state;
    forge(&f);
    for (uint32_t bit = 0; bit < 8u * f.chunk->bytes; bit++) {
        uint8_t *byte = (uint8_t *)f.h + bit / 8u;
        noh_pack pack;
        *byte = (uint8_t)(*byte ^ 1u << bit % 8u);
        pack_repair(f.bytes, good_count);
        if (noh_pack_open(f.bytes, good_count, &pack, NULL) == NOH_OK) {
            pack_walk(&pack, 1);
            opened++;
        } else {
            refused++;
        }
        *byte = (uint8_t)(*byte ^ 1u << bit % 8u);
    }
    free(f.bytes);
    for (size_t count = 0; count < good_count; count += 16) {
        uint8_t *cut = test_aligned(good, count);
        noh_pack pack;
        assert_int_not_equal(noh_pack_open(cut, count, &pack, NULL), NOH_OK);
        free(cut);
    }
    print_message("# of %u flipped bits %u are refused\n", opened + refused, refused);
    assert_true(opened > 0 && refused > opened / 4);
}

static void the_same_text_gives_the_same_bytes(void **state)
{
    const noh_pack pack = test_open(good, good_count);
    size_t again = 0;
    uint8_t *other = springs_fixture_pack(&again);
    (void)state;
    assert_int_equal(again, good_count);
    assert_memory_equal(other, good, good_count); /* the same input, the same bytes */
    assert_true(pack_walk(&pack, 1) == pack_walk(&pack, 1));
    free(other);
}

static void refused_line(const char *line, const char *what)
{
    const char *lines[5];
    convert_failure failure;
    size_t count;
    memcpy(lines, springs_fixture_lines, sizeof springs_fixture_lines);
    lines[4] = line;
    if (springs_fixture_build(lines, 5, NULL, &count, &failure) || !strstr(failure.error.what, what)) {
        fail_msg("'%s': '%s'", line, failure.error.what);
    }
}

static void bad_lines_are_refused(void **state)
{
    (void)state;
    refused_line("chian tail1", "'chian' is neither `chain` nor `collider`");
    refused_line("chain", "the joint is missing");
    refused_line("chain \"tail", "a quote is not closed");
    refused_line("chain hair1", "no skeleton has this joint");
    refused_line("chain chest to tail1", "no skeleton has this joint with the joint after `to`");
    refused_line("chain hips to chest", "it cannot swing");
    refused_line("chain tail2", "already in a chain");
    refused_line("chain chest stiff 1", "'stiff' is not understood");
    refused_line("chain chest stiffness", "the number of stiffness is missing");
    refused_line("chain chest drag 2", "drag is 2: it must be 0 to 1");
    refused_line("chain chest end 0 1", "the number of end is missing");
    refused_line("chain chest hits", "`hits` needs the name of a joint");
    refused_line("chain chest to", "`to` needs the name of a joint");
    refused_line("collider", "the joint is missing");
    refused_line("collider nose 0.1", "no skeleton has this joint");
    refused_line("collider hips", "the number of radius is missing");
    refused_line("collider hips 0", "radius is 0");
    refused_line("collider hips 0.1 1 2", "the number of X Y Z is missing");
    refused_line("collider hips 0.1 1 2 3 4 5 6 7", "a word too many");
}

static void bad_files_are_told_by_line(void **state)
{
    const char *path = test_path("bad.springs");
    convert_failure failure;
    size_t count;
    (void)state;
    test_write_file(path, "# hair\nchain tail1 drag 0.5\n\nchain scarf9\n", 42);
    assert_null(springs_fixture_build(NULL, 0, path, &count, &failure));
    assert_int_equal(failure.line, 4);
    assert_string_equal(failure.file, path);
    test_write_file(path, "# hair\nchain tail1 drag 5\n", 26);
    assert_null(springs_fixture_build(NULL, 0, path, &count, &failure));
    assert_int_equal(failure.line, 2);
    test_write_file(path, "# none\n", 7);
    assert_null(springs_fixture_build(NULL, 0, path, &count, &failure));
    assert_non_null(strstr(failure.error.what, "the file has no chain"));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_text_becomes_chains),
    cmocka_unit_test(lies_are_refused),
    cmocka_unit_test(a_joint_swings_once),
    cmocka_unit_test(every_bit_and_every_cut),
    cmocka_unit_test(the_same_text_gives_the_same_bytes),
    cmocka_unit_test(bad_lines_are_refused),
    cmocka_unit_test(bad_files_are_told_by_line),
};

TEST_MAIN(tests, set_up, tear_down)
