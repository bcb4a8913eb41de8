/* match_internal.h: the table of a pack for motion matching (format.h), and the search in it.
 *
 * A query is like a row, in int16: -NOH_MATCH_QUERY_MAX..NOH_MATCH_QUERY_MAX. The cost of a row is the sum of the
 * squared differences, in which features from NOH_MATCH_COARSE on count four times: whole numbers, so that every
 * kernel and every order of search finds the same row. Of equal costs the row with the lowest number wins.
 *
 * source  Clavet, Motion Matching and The Road to Next-Gen Animation, GDC 2016; Holden, Kanoun, Perepichka, Popa:
 *         Learned Motion Matching, 2020 (boxes of rows); Friedman, Bentley, Finkel: An Algorithm for Finding Best
 *         Matches in Logarithmic Expected Time, 1977 (the order of rows)
 * Threads: read-only; any number of threads. */
#ifndef NOH_MATCH_MATCH_INTERNAL_H
#define NOH_MATCH_MATCH_INTERNAL_H

#include <stdint.h>

#include "noh/format.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_MATCH_QUERY_MAX 2047
#define NOH_MATCH_UNIT 16 /* of a query, per standard deviation of a feature with weight 1 */

typedef struct noh_match_table {
    const noh_pack_match_header *header;
    const noh_pack_match_clip *clips; /* [header->clip_count] */
    const noh_pack_match_tag *tags;   /* [header->tag_count] */
    const float *means, *scales;      /* [NOH_MATCH_FEATURES] */
    const uint16_t *order;            /* [header->row_count] */
    const int8_t *rows;
    const int8_t *boxes[NOH_MATCH_LEVELS];
} noh_match_table;

typedef struct noh_match_hit {
    int32_t cost;    /* on input: only rows that cost this much or less are found */
    uint32_t row;    /* its number; NOH_NONE: none is near enough */
    uint32_t groups; /* of 8 rows or boxes that were compared, for measurements */
} noh_match_hit;

/* The table of a pack, in place. Returns 0: it has none. */
int noh_match_table_of(const noh_pack *pack, noh_match_table *table);

/* Find the nearest row whose clip has all of `tags`. */
void noh_match_search(const noh_match_table *table, const int16_t query[NOH_MATCH_FEATURES], uint32_t tags,
                      noh_match_hit *hit);
/* The same by comparing all rows. */
void noh_match_search_all(const noh_match_table *table, const int16_t query[NOH_MATCH_FEATURES], uint32_t tags,
                          noh_match_hit *hit);

/* The numbers of the row at a place in the table's order. */
void noh_match_row(const noh_match_table *table, uint32_t place, int16_t out[NOH_MATCH_FEATURES]);
int32_t noh_match_cost(const int16_t a[NOH_MATCH_FEATURES], const int16_t b[NOH_MATCH_FEATURES]);
/* A feature's number in a query. */
int16_t noh_match_number(const noh_match_table *table, uint32_t feature, float value);
/* The clip of a row's number. */
uint32_t noh_match_clip_of(const noh_match_table *table, uint32_t row);

#ifdef __cplusplus
}
#endif

#endif
