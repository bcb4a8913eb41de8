/* The search of motion matching: down the tree it finds what comparing all rows finds, to the bit, with every kernel;
 * ties go to the lowest number, tags are kept, and few groups are compared. */
#include "support/support.h"

#include <string.h>

#include "motion/match/match_internal.h"

#define NOH_SIMD_SCALAR 1
#define noh_match_table_of table_of_scalar
#define noh_match_clip_of clip_of_scalar
#define noh_match_row row_scalar
#define noh_match_cost cost_scalar
#define noh_match_number number_scalar
#define noh_match_search search_scalar
#define noh_match_search_all search_all_scalar
#include "motion/match/match.c"
#undef noh_match_table_of
#undef noh_match_clip_of
#undef noh_match_row
#undef noh_match_cost
#undef noh_match_number
#undef noh_match_search
#undef noh_match_search_all

int32_t noh_match_cost(const int16_t a[NOH_MATCH_FEATURES], const int16_t b[NOH_MATCH_FEATURES]);
void noh_match_row(const noh_match_table *table, uint32_t place, int16_t out[NOH_MATCH_FEATURES]);
void noh_match_search(const noh_match_table *table, const int16_t query[NOH_MATCH_FEATURES], uint32_t tags,
                      noh_match_hit *hit);
void noh_match_search_all(const noh_match_table *table, const int16_t query[NOH_MATCH_FEATURES], uint32_t tags,
                          noh_match_hit *hit);
int16_t noh_match_number(const noh_match_table *table, uint32_t feature, float value);
uint32_t noh_match_clip_of(const noh_match_table *table, uint32_t row);

#define CLIPS 5u

/* A table made here: rows in any order, in boxes that hold them. */
typedef struct made_table {
    noh_match_table table;
    noh_pack_match_header header;
    noh_pack_match_clip clips[CLIPS];
    float numbers[2][NOH_MATCH_FEATURES];
    uint16_t *order;
    int8_t *rows, *boxes[NOH_MATCH_LEVELS];
} made_table;

static size_t place_of(uint32_t index, uint32_t feature)
{
    return (size_t)(feature / 2u) * 16u + index % 8u * 2u + feature % 2u;
}

static int8_t *number_at(const made_table *m, uint32_t row, uint32_t feature)
{
    return &m->rows[(size_t)(row / 8u) * NOH_MATCH_GROUP_BYTES + place_of(row, feature)];
}

static void make_boxes(made_table *m, uint32_t level, uint32_t size)
{
    const uint32_t rows = m->header.row_count, count = (rows + size - 1u) / size;
    m->boxes[level] = test_zeros((size_t)(count + 7u) / 8u * 2u * NOH_MATCH_GROUP_BYTES);
    for (uint32_t b = 0; b < (count + 7u) / 8u * 8u; b++) {
        int8_t *low = m->boxes[level] + (size_t)(b / 8u) * 2u * NOH_MATCH_GROUP_BYTES;
        int8_t *high = low + NOH_MATCH_GROUP_BYTES;
        for (uint32_t k = 0; k < NOH_MATCH_FEATURES; k++) {
            int8_t least = 127, most = -127;
            for (uint32_t i = b * size; i < (b + 1u) * size && i < rows; i++) {
                const int8_t v = *number_at(m, i, k);
                least = v < least ? v : least;
                most = v > most ? v : most;
            }
            low[place_of(b, k)] = least;
            high[place_of(b, k)] = most;
        }
    }
    m->table.boxes[level] = m->boxes[level];
}

/* Numbers wander from row to row, as clips do; `step` 0: all rows are equal. */
static void make(made_table *m, test_random *r, uint32_t rows, uint32_t step)
{
    static const uint32_t sizes[NOH_MATCH_LEVELS] = { 16, 64, 512 };
    memset(m, 0, sizeof *m);
    m->header.row_count = rows;
    m->header.clip_count = rows < CLIPS ? 1u : CLIPS;
    m->order = test_zeros(rows * sizeof *m->order);
    m->rows = test_zeros((size_t)(rows + 7u) / 8u * NOH_MATCH_GROUP_BYTES);
    for (uint32_t c = 0; c < m->header.clip_count; c++) {
        m->clips[c].first_row = rows / m->header.clip_count * c;
        m->clips[c].tags = c % 4u;
    }
    for (uint32_t i = 0; i < rows; i++) m->order[i] = (uint16_t)i;
    for (uint32_t i = rows; i-- > 1u;) {
        const uint32_t other = test_random_below(r, i + 1u);
        const uint16_t kept = m->order[i];
        m->order[i] = m->order[other];
        m->order[other] = kept;
    }
    for (uint32_t i = 0; i < (rows + 7u) / 8u * 8u; i++) {
        for (uint32_t k = 0; k < NOH_MATCH_FEATURES - 1u; k++) {
            const int last = i ? *number_at(m, i - 1u, k) : 0;
            const int v = i < rows && step ? last - (int)step + (int)test_random_below(r, 2u * step + 1u) : last;
            *number_at(m, i, k) = (int8_t)(v > 127 ? 127 : v < -127 ? -127 : v);
        }
    }
    m->table.header = &m->header;
    m->table.clips = m->clips;
    m->table.order = m->order;
    m->table.rows = m->rows;
    m->table.means = m->numbers[0];
    m->table.scales = m->numbers[1];
    for (uint32_t i = 0; i < NOH_MATCH_LEVELS; i++) make_boxes(m, i, sizes[i]);
}

static void drop(made_table *m)
{
    free(m->order);
    free(m->rows);
    for (uint32_t i = 0; i < NOH_MATCH_LEVELS; i++) free(m->boxes[i]);
}

/* What both searches have to find. */
static noh_match_hit expected(const made_table *m, const int16_t *query, uint32_t tags, int32_t limit)
{
    noh_match_hit best = { limit, NOH_NONE, 0 };
    for (uint32_t i = 0; i < m->header.row_count; i++) {
        const uint32_t row = m->order[i];
        int16_t numbers[NOH_MATCH_FEATURES];
        int32_t cost;
        noh_match_row(&m->table, i, numbers);
        cost = noh_match_cost(numbers, query);
        if ((m->clips[noh_match_clip_of(&m->table, row)].tags & tags) != tags) continue;
        if (cost > best.cost || (cost == best.cost && row >= best.row)) continue;
        best.cost = cost;
        best.row = row;
    }
    return best;
}

static void compare(const made_table *m, const int16_t *query, uint32_t tags, int32_t limit)
{
    const noh_match_hit start = { limit, 7, 7 }, wanted = expected(m, query, tags, limit);
    noh_match_hit found = start, all = start, scalar = start, all_scalar = start;
    noh_match_search(&m->table, query, tags, &found);
    noh_match_search_all(&m->table, query, tags, &all);
    search_scalar(&m->table, query, tags, &scalar);
    search_all_scalar(&m->table, query, tags, &all_scalar);
    assert_int_equal(found.row, wanted.row);
    assert_int_equal(found.cost, wanted.cost);
    assert_int_equal(all.row, wanted.row);
    assert_int_equal(all.cost, wanted.cost);
    assert_memory_equal(&scalar, &found, sizeof found);
    assert_memory_equal(&all_scalar, &all, sizeof all);
    assert_int_equal(all.groups, (m->header.row_count + 7u) / 8u);
}

static void make_query(const made_table *m, test_random *r, int16_t *query)
{
    const uint32_t kind = test_random_below(r, 3);
    memset(query, 0, NOH_MATCH_FEATURES * sizeof *query);
    if (kind) noh_match_row(&m->table, test_random_below(r, m->header.row_count), query);
    for (uint32_t k = 0; k < NOH_MATCH_FEATURES - 1u; k++) {
        const int reach = kind == 2 ? 12 : kind ? 0 : NOH_MATCH_QUERY_MAX;
        query[k] = (int16_t)(query[k] + (int)test_random_below(r, 2u * (uint32_t)reach + 1u) - reach);
    }
}

static void the_tree_finds_what_all_rows_give(void **state)
{
    static const uint32_t rows[] = { 1, 2, 7, 8, 9, 15, 16, 17, 63, 64, 65, 127, 128, 129, 511, 512, 513, 1025, 5000 };
    test_random r = test_random_from(77);
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(rows); i++) {
        for (uint32_t step = 0; step < 12; step += 3) {
            made_table m;
            make(&m, &r, rows[i], step);
            for (int n = 0; n < test_rounds(24); n++) {
                int16_t query[NOH_MATCH_FEATURES];
                make_query(&m, &r, query);
                compare(&m, query, test_random_below(&r, 4), INT32_MAX);
                compare(&m, query, 0, (int32_t)test_random_below(&r, 20000) - 100);
                compare(&m, query, 8, INT32_MAX); /* a tag that no clip has */
            }
            drop(&m);
        }
    }
}

/* All rows there can be, with queries as far out as there can be: nothing overflows. */
static void the_largest_table_and_the_farthest_query(void **state)
{
    test_random r = test_random_from(78);
    int16_t query[NOH_MATCH_FEATURES];
    made_table m;
    (void)state;
    make(&m, &r, NOH_MATCH_ROWS_MAX, 40);
    for (int side = -1; side < 2; side += 2) {
        for (uint32_t k = 0; k < NOH_MATCH_FEATURES; k++) query[k] = (int16_t)(side * NOH_MATCH_QUERY_MAX);
        compare(&m, query, 0, INT32_MAX);
    }
    for (int n = 0; n < 4; n++) {
        make_query(&m, &r, query);
        compare(&m, query, (uint32_t)n, INT32_MAX);
    }
    drop(&m);
}

static void numbers_are_rounded_and_bounded(void **state)
{
    test_random r = test_random_from(79);
    made_table m;
    (void)state;
    make(&m, &r, 1, 1);
    m.numbers[0][3] = 0.5f;
    m.numbers[1][3] = 10.0f;
    assert_int_equal(noh_match_number(&m.table, 3, 0.5f), 0);
    assert_int_equal(noh_match_number(&m.table, 3, 0.64f), 1);
    assert_int_equal(noh_match_number(&m.table, 3, 0.36f), -1);
    assert_int_equal(noh_match_number(&m.table, 3, 1e30f), NOH_MATCH_QUERY_MAX);
    assert_int_equal(noh_match_number(&m.table, 3, -1e30f), -NOH_MATCH_QUERY_MAX);
    assert_int_equal(noh_match_number(&m.table, 4, 1e30f), 0); /* a feature without a scale */
    drop(&m);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_tree_finds_what_all_rows_give),
    cmocka_unit_test(the_largest_table_and_the_farthest_query),
    cmocka_unit_test(numbers_are_rounded_and_bounded),
};

TEST_MAIN(tests, NULL, NULL)
