/* match.c: the search of motion matching: down a tree of boxes, the nearest box of each level first. */
#include "core/base/assert_internal.h"
#include "core/base/simd_internal.h"
#include "motion/match/match_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"

#define PAIRS (NOH_MATCH_FEATURES / 2u)
#define COARSE (NOH_MATCH_COARSE / 2u)
#define PAIR_BYTES 16u
#define LARGEST 512u /* rows of a box of the last level */

/* ---- a table ---- */

int noh_match_table_of(const noh_pack *pack, noh_match_table *t)
{
    const noh_pack_match_header *h = noh_pack_chunk_at(pack, NOH_CHUNK_MATCH, 0);
    const uint8_t *bytes = (const uint8_t *)h;
    if (!h) return 0;
    t->header = h;
    t->clips = (const noh_pack_match_clip *)(const void *)(bytes + h->clips_offset);
    t->tags = (const noh_pack_match_tag *)(const void *)(bytes + h->tags_offset);
    t->means = (const float *)(const void *)(bytes + h->numbers_offset);
    t->scales = t->means + NOH_MATCH_FEATURES;
    t->order = (const uint16_t *)(const void *)(bytes + h->order_offset);
    t->rows = (const int8_t *)(bytes + h->rows_offset);
    for (uint32_t i = 0; i < NOH_MATCH_LEVELS; i++) t->boxes[i] = (const int8_t *)(bytes + h->boxes_offset[i]);
    return 1;
}

uint32_t noh_match_clip_of(const noh_match_table *t, uint32_t row)
{
    uint32_t low = 0, high = t->header->clip_count;
    while (high - low > 1u) {
        const uint32_t middle = (low + high) / 2u;
        if (t->clips[middle].first_row <= row) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

void noh_match_row(const noh_match_table *t, uint32_t place, int16_t out[NOH_MATCH_FEATURES])
{
    const int8_t *group = t->rows + (size_t)(place / 8u) * NOH_MATCH_GROUP_BYTES;
    NOH_ASSERT(place < t->header->row_count);
    for (uint32_t k = 0; k < NOH_MATCH_FEATURES; k++) {
        out[k] = group[k / 2u * PAIR_BYTES + place % 8u * 2u + k % 2u];
    }
}

int32_t noh_match_cost(const int16_t a[NOH_MATCH_FEATURES], const int16_t b[NOH_MATCH_FEATURES])
{
    int32_t cost = 0;
    for (uint32_t k = 0; k < NOH_MATCH_FEATURES; k++) {
        const int32_t d = a[k] - b[k];
        cost += d * d * (k < NOH_MATCH_COARSE ? 1 : 4);
    }
    return cost;
}

int16_t noh_match_number(const noh_match_table *t, uint32_t feature, float value)
{
    const float v = (value - t->means[feature]) * t->scales[feature];
    if (!(v > -(float)NOH_MATCH_QUERY_MAX)) return -NOH_MATCH_QUERY_MAX;
    if (v > (float)NOH_MATCH_QUERY_MAX) return NOH_MATCH_QUERY_MAX;
    return (int16_t)((int32_t)(v + 32768.5f) - 32768);
}

/* ---- eight at a time ---- */

/* What a search is about. */
typedef struct search {
    const noh_match_table *table;
    int32_t query[PAIRS]; /* two features in each */
    uint32_t tags;
    noh_match_hit hit;
} search;

/* Costs of eight rows. Returns 0, and no costs, if all are above the limit. */
static int cost_rows(const search *s, const int8_t *group, int32_t costs[8])
{
    noh_i4 near[2], far[2];
    for (int i = 0; i < 2; i++) near[i] = far[i] = noh_i4_zero();
    for (uint32_t p = 0; p < PAIRS; p++) {
        noh_i4 *sums = p < COARSE ? near : far;
        const noh_h8 q = noh_h8_pair(s->query[p]);
        noh_h8 d[2];
        noh_h8_load_i8(group + p * PAIR_BYTES, d);
        for (int i = 0; i < 2; i++) sums[i] = noh_i4_add_squares(sums[i], noh_h8_sub(d[i], q));
    }
    for (int i = 0; i < 2; i++) near[i] = noh_i4_add_four_times(near[i], far[i]);
    if (!noh_i4_any_at_most(near[0], s->hit.cost) && !noh_i4_any_at_most(near[1], s->hit.cost)) return 0;
    for (int i = 0; i < 2; i++) noh_i4_store(costs + 4 * i, near[i]);
    return 1;
}

/* The least that a row in each of eight boxes can cost. */
static void cost_boxes(search *s, const int8_t *group, int32_t costs[8])
{
    noh_i4 near[2], far[2];
    for (int i = 0; i < 2; i++) near[i] = far[i] = noh_i4_zero();
    for (uint32_t p = 0; p < PAIRS; p++) {
        noh_i4 *sums = p < COARSE ? near : far;
        const noh_h8 q = noh_h8_pair(s->query[p]), zero = noh_h8_pair(0);
        noh_h8 low[2], high[2];
        noh_h8_load_i8(group + p * PAIR_BYTES, low);
        noh_h8_load_i8(group + NOH_MATCH_GROUP_BYTES + p * PAIR_BYTES, high);
        for (int i = 0; i < 2; i++) {
            const noh_h8 out = noh_h8_max(noh_h8_sub(low[i], q), noh_h8_sub(q, high[i]));
            sums[i] = noh_i4_add_squares(sums[i], noh_h8_max(out, zero));
        }
    }
    for (int i = 0; i < 2; i++) noh_i4_store(costs + 4 * i, noh_i4_add_four_times(near[i], far[i]));
    s->hit.groups++;
}

static int has_tags(const search *s, uint32_t row)
{
    return !s->tags || (s->table->clips[noh_match_clip_of(s->table, row)].tags & s->tags) == s->tags;
}

static void take_rows(search *s, uint32_t group)
{
    const uint32_t count = s->table->header->row_count;
    int32_t costs[8];
    s->hit.groups++;
    if (!cost_rows(s, s->table->rows + (size_t)group * NOH_MATCH_GROUP_BYTES, costs)) return;
    for (uint32_t i = 0; i < 8u && group * 8u + i < count; i++) {
        const uint32_t row = s->table->order[group * 8u + i];
        if (costs[i] > s->hit.cost || (costs[i] == s->hit.cost && row >= s->hit.row) || !has_tags(s, row)) continue;
        s->hit.cost = costs[i];
        s->hit.row = row;
    }
}

/* ---- down the tree ---- */

static uint32_t boxes_of(const search *s, uint32_t rows)
{
    return (s->table->header->row_count + rows - 1u) / rows;
}

static const int8_t *boxes_at(const search *s, uint32_t level, uint32_t group)
{
    return s->table->boxes[level] + (size_t)group * 2u * NOH_MATCH_GROUP_BYTES;
}

/* The boxes of 16 rows in one of 512: eight are computed at a time, for two of 64. */
typedef struct fine_boxes {
    int32_t costs[4][8];
    uint32_t known; /* a bit for each eight */
} fine_boxes;

/* A box of 64 rows: four of 16. */
static void search_64(search *s, uint32_t box, fine_boxes *fine)
{
    const uint32_t count = boxes_of(s, 16u), groups = (s->table->header->row_count + 7u) / 8u, at = box / 2u % 4u;
    if (!(fine->known >> at & 1u)) cost_boxes(s, boxes_at(s, 0, box / 2u), fine->costs[at]);
    fine->known |= 1u << at;
    for (uint32_t i = box * 4u; i < box * 4u + 4u && i < count; i++) {
        if (fine->costs[at][i % 8u] > s->hit.cost) continue;
        take_rows(s, 2u * i);
        if (2u * i + 1u < groups) take_rows(s, 2u * i + 1u);
    }
}

static uint32_t nearest(const int32_t *costs, uint32_t count)
{
    uint32_t at = 0;
    for (uint32_t i = 1; i < count; i++) {
        if (costs[i] < costs[at]) at = i;
    }
    return at;
}

/* A box of 512 rows: eight of 64. */
static void search_512(search *s, uint32_t box)
{
    const uint32_t all = boxes_of(s, 64u) - 8u * box, count = all < 8u ? all : 8u;
    int32_t costs[8];
    fine_boxes fine;
    fine.known = 0;
    cost_boxes(s, boxes_at(s, 1, box), costs);
    const uint32_t first = nearest(costs, count);
    if (costs[first] > s->hit.cost) return;
    search_64(s, 8u * box + first, &fine);
    for (uint32_t i = 0; i < count; i++) {
        if (i != first && costs[i] <= s->hit.cost) search_64(s, 8u * box + i, &fine);
    }
}

static search begin(const noh_match_table *table, const int16_t *query, uint32_t tags, const noh_match_hit *hit)
{
    search s;
    NOH_ASSERT(table && query && hit);
    s.table = table;
    s.tags = tags;
    s.hit = *hit;
    s.hit.row = NOH_NONE;
    s.hit.groups = 0;
    for (uint32_t p = 0; p < PAIRS; p++) {
        s.query[p] = (int32_t)((uint32_t)(uint16_t)query[2u * p] | (uint32_t)(uint16_t)query[2u * p + 1u] << 16);
    }
    return s;
}

void noh_match_search(const noh_match_table *table, const int16_t query[NOH_MATCH_FEATURES], uint32_t tags,
                      noh_match_hit *hit)
{
    int32_t costs[NOH_MATCH_ROWS_MAX / LARGEST];
    search s = begin(table, query, tags, hit);
    const uint32_t count = boxes_of(&s, LARGEST);
    uint32_t g = 0;
    do cost_boxes(&s, boxes_at(&s, 2, g), costs + 8u * g);
    while (8u * ++g < count);
    const uint32_t first = nearest(costs, count);
    if (costs[first] <= s.hit.cost) search_512(&s, first);
    for (uint32_t i = 0; i < count; i++) {
        if (i != first && costs[i] <= s.hit.cost) search_512(&s, i);
    }
    *hit = s.hit;
}

void noh_match_search_all(const noh_match_table *table, const int16_t query[NOH_MATCH_FEATURES], uint32_t tags,
                          noh_match_hit *hit)
{
    search s = begin(table, query, tags, hit);
    for (uint32_t g = 0; 8u * g < table->header->row_count; g++) take_rows(&s, g);
    *hit = s.hit;
}
