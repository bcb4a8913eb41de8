/* morph_internal.h: shared by the parts of the morph encoder.
 *
 * morph_encode.c drives; morph_uv.c makes positions of texture coordinates; morph_quantise.c turns deltas into words
 * and certifies the errors; morph_patterns.c groups vertices by the targets that move them;
 * morph_order.c puts the groups in line; morph_fold.c lays the line into the texture; morph_bands.c and morph_rects.c
 * cover a target's texels by rectangles. */
#ifndef NOH_CONVERT_MORPH_MORPH_INTERNAL_H
#define NOH_CONVERT_MORPH_MORPH_INTERNAL_H

#include "morph_encode.h"

#ifdef __cplusplus
extern "C" {
#endif

#define MORPH_AXES 3u
/* Measured on llvmpipe with three RGBA32F layers: blending a rectangle costs about 250 ns, each 4x4 block that it
 * touches 100 ns, each texel 5 ns. A larger value draws no faster and takes more bytes. */
#define MORPH_DEFAULT_RECT_COST 8.0f
#define MORPH_DEFAULT_ERROR_UM 10.0f

/* ---- bits: which targets move which vertices; a row per vertex ---- */
typedef struct morph_bits {
    uint32_t rows, words; /* words: 64-bit words per row */
    uint64_t *bits;       /* [rows][words] */
} morph_bits;

static inline const uint64_t *morph_row(const morph_bits *b, uint32_t row)
{
    return b->bits + (size_t)row * b->words;
}

static inline int morph_bit(const morph_bits *b, uint32_t row, uint32_t column)
{
    return (int)(morph_row(b, row)[column / 64u] >> (column % 64u) & 1u);
}

static inline void morph_set_bit(morph_bits *b, uint32_t row, uint32_t column)
{
    b->bits[(size_t)row * b->words + column / 64u] |= (uint64_t)1 << (column % 64u);
}

/* Portable population count: the compiler's own may be a library call, and this one vectorises. */
static inline uint32_t morph_popcount(uint64_t x)
{
    x -= x >> 1 & 0x5555555555555555u;
    x = (x & 0x3333333333333333u) + (x >> 2 & 0x3333333333333333u);
    x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fu;
    return (uint32_t)(x * 0x0101010101010101u >> 56);
}

/* ---- memory: calloc that refuses products above SIZE_MAX, and returns a block for 0 ---- */
void *morph_alloc(size_t count, size_t size);

/* ---- annealing, in integers and without libm: the same decisions on every machine ---- */
typedef uint64_t morph_random;
#define MORPH_RANDOM_SEED 0x9e3779b97f4a7c15u
#define MORPH_ODDS_BITS 16u
#define MORPH_HEAT_BITS 16u /* fraction bits of a temperature */

/* xorshift64*, upper half */
static inline uint32_t morph_random32(morph_random *r)
{
    uint64_t x = *r;
    x ^= x >> 12;
    x ^= x << 25;
    x ^= x >> 27;
    *r = x;
    return (uint32_t)((x * 0x2545f4914f6cdd1du) >> 32);
}

static inline uint32_t morph_random_below(morph_random *r, uint32_t n)
{
    return (uint32_t)(((uint64_t)morph_random32(r) * n) >> 32);
}

/* The probability of accepting one unit of extra cost at temperature T: T / (T + 1) in place of exp(-1 / T). */
static inline uint32_t morph_odds(uint32_t heat)
{
    return (uint32_t)(((uint64_t)heat << MORPH_ODDS_BITS) / (heat + ((uint32_t)1 << MORPH_HEAT_BITS)));
}

/* Whether a change is accepted: always if it costs nothing, else with the probability odds^cost. */
static inline int morph_accepts(morph_random *r, int64_t cost, uint32_t odds)
{
    uint64_t chance = (uint64_t)1 << MORPH_ODDS_BITS;
    if (cost <= 0) return 1;
    for (; cost > 0 && chance > 0u; cost--) chance = chance * odds >> MORPH_ODDS_BITS;
    return (morph_random32(r) >> (32u - MORPH_ODDS_BITS)) < chance;
}

/* ---- quantising ---- */
/* Chooses bits and scales of target t, and fills these, the errors and the counts of pairs in *out; error_um as in
 * morph_options, above 0. */
void morph_quantise_choose(const model_mesh *mesh, uint32_t t, float error_um, morph_target *out);

/* The three words of one delta. 0 where the pair is dropped: the words are then 0. */
int morph_quantise_pack(const morph_target *q, const model_target *source, uint32_t vertex, uint32_t words[3]);

/* ---- texture coordinates ---- */
/* A mesh with a vertex more for each whose texture coordinates a target moves. That stand-in has, as positions, how far
 * the picture slides over the surface along u and v: so bits, errors, rectangles and the texture of sums work as for
 * positions, and a target's radius is how far anything moves over the screen. It has only the fields that the encoder
 * reads. */
typedef struct morph_uv {
    model_mesh mesh;
    uint32_t *stand_in; /* [vertices of the mesh it was made from], MODEL_NONE: nothing moves its UV */
    uint8_t *rank;      /* [mesh.vertex_count] as in morph_options */
    float uv_per_unit;  /* texture coordinates for a model unit */
} morph_uv;

int morph_uv_needed(const model_mesh *mesh);
/* 0 on success, 1 when memory runs out; free it in any case. */
int morph_uv_extend(const model_mesh *mesh, const morph_options *options, morph_uv *out);
void morph_uv_free(morph_uv *uv);

/* ---- patterns: vertices that exactly the same targets move ---- */
typedef struct morph_patterns {
    uint32_t count;
    morph_bits bits;   /* a row per pattern */
    uint32_t *first;   /* [count + 1] into members */
    uint32_t *members; /* rows of the vertex bits, ascending within a pattern */
} morph_patterns;

/* 0 on success, 1 when memory runs out (as for all below). */
int morph_patterns_init(morph_patterns *p, const morph_bits *vertices);
void morph_patterns_free(morph_patterns *p);

/* ---- order ---- */
/* Fills path[patterns->count] with an order of the patterns that takes few rectangles. */
int morph_order_path(const morph_patterns *patterns, float rect_cost, uint32_t *path);

/* ---- fold: the line into the texture ---- */
#define MORPH_STRIP_ROWS 4u /* the texture is filled in strips of this many rows */

void morph_fold_size(uint32_t touched, uint32_t *width_log2, uint32_t *height);

/* A run of texels, row after row. */
typedef struct morph_region {
    uint32_t width_log2; /* of the texture */
    uint32_t first, count;
} morph_region;

/* Improves line[vertices->rows], an order of the rows of `vertices`, for a region of as many texels. */
int morph_fold_settle(const morph_bits *vertices, const morph_region *region, float rect_cost, uint32_t *line);

/* order[texel - region->first] = the entry of the line that lies at that texel. */
void morph_fold_order(const uint32_t *line, const morph_region *region, uint32_t *order);

/* ---- rectangles ---- */
typedef struct morph_rect_list {
    morph_rect *items;
    uint32_t count, capacity;
} morph_rect_list;

typedef struct morph_cover_options {
    uint32_t width_log2;
    float rect_cost;     /* texels */
    uint32_t most_rects; /* 0 = no limit */
} morph_cover_options;

int morph_rect_append(morph_rect_list *list, const morph_rect *r);

/* Appends the boxes of bands of `rows` texture rows: disjoint, and covering texels[count] (ascending). */
int morph_bands(const uint32_t *texels, uint32_t count, uint32_t rows, const morph_cover_options *options,
                morph_rect_list *list);

/* Appends disjoint rectangles that cover texels[count] (ascending) to *list. */
int morph_cover(const uint32_t *texels, uint32_t count, const morph_cover_options *options, morph_rect_list *list);

#ifdef __cplusplus
}
#endif
#endif
