/* wire_internal.h (private to wire/, and to the converter that writes what it reads): the filters of the wire form.
 *
 * A filter walks over an array of the pack, predicts each value from those before it and codes the difference. The same
 * function reads and writes: on the way out the array is there already, the differences are recorded, and nothing in it
 * changes; on the way in they are decoded. So both sides cannot come apart.
 *
 * Threads: a filter belongs to one thread. */
#ifndef NOH_WIRE_INTERNAL_H
#define NOH_WIRE_INTERNAL_H

#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Bytes of the file taken so far. */
uint32_t noh_wire_bytes_read(const noh_wire *wire);

/* ---- the entropy coder ---- */

#define NOH_WIRE_SYMBOLS 16u
#define NOH_WIRE_SCALE_BITS 15u
#define NOH_WIRE_LOW 0x10000u /* the coder's state is this at the end of a block, and never below */
#define NOH_WIRE_MODELS 736u

/* How often each of sixteen symbols came: symbol s has the range from `start[s]` up to `start[s + 1]`, the last one up
 * to 2^15. Every symbol keeps at least 1. */
typedef struct noh_wire_model {
    uint16_t start[NOH_WIRE_SYMBOLS];
    uint16_t count; /* symbols seen, up to where it adapts slowest */
} noh_wire_model;

/* One block, backwards coded by asymmetric numeral systems, so that it is read forwards; or, with `record`, written. */
typedef struct noh_wire_coder {
    const uint8_t *bytes;
    uint32_t at, end;
    uint32_t state;
    uint32_t items; /* that the block still has; when writing: that it still has room for */
    int bad;        /* the block ended too early */
    void (*record)(void *user, uint32_t start, uint32_t frequency);
    void *user;
} noh_wire_coder;

void noh_wire_model_reset(noh_wire_model *models, uint32_t count);

/* Begin to read a block of `items`. */
void noh_wire_coder_begin(noh_wire_coder *coder, const uint8_t *bytes, uint32_t count, uint32_t items);
/* The block was read to its end, and right. */
int noh_wire_coder_ended(const noh_wire_coder *coder);

/* The next item: 0 where it is in the next block. */
static inline int noh_wire_item(noh_wire_coder *coder)
{
    if (!coder->items) return 0;
    coder->items--;
    return 1;
}

/* A symbol below 16; when writing, the one that is given. */
uint32_t noh_wire_symbol(noh_wire_coder *coder, noh_wire_model *model, uint32_t symbol);
/* Bits that no model predicts, 0..32. */
uint32_t noh_wire_bits(noh_wire_coder *coder, uint32_t value, uint32_t bits);
/* A number; smaller magnitudes take fewer bits. model[1] codes large numbers. */
int32_t noh_wire_value(noh_wire_coder *coder, noh_wire_model *model, noh_wire_model *large, int32_t value);

/* ---- numbers ---- */

/* Half of a size: the next mip level's. */
static inline uint32_t noh_wire_half(uint32_t size)
{
    return size > 1u ? size / 2u : 1u;
}

/* A fraction of `whole` as one of `steps` + 1 values. It is rounded, so that the way back gives the same value. */
static inline int32_t noh_wire_steps(int32_t value, int32_t whole, int32_t steps)
{
    const int64_t scaled = (int64_t)value * steps * 2;
    return (int32_t)((scaled + (scaled < 0 ? -whole : whole)) / (2 * (int64_t)whole));
}

/* ---- sections ---- */

#define NOH_WIRE_BYTES 1u   /* bytes in rows of `stride` */
#define NOH_WIRE_COPY 2u    /* bytes of the image before this one */
#define NOH_WIRE_MESH 3u    /* nothing: a mesh whose headers are there; the next sections are about it */
#define NOH_WIRE_INDICES 4u /* of all levels */
#define NOH_WIRE_POSITIONS 5u
#define NOH_WIRE_NORMALS 6u
#define NOH_WIRE_COLUMN 7u     /* a word of each vertex, in fields */
#define NOH_WIRE_TEXEL_REFS 8u /* a word of each vertex */
#define NOH_WIRE_INFLUENCES 9u
#define NOH_WIRE_DELTAS 10u
#define NOH_WIRE_TEXTURE 11u /* in RGBA8 */
#define NOH_WIRE_BLOCKS 13u  /* a texture in blocks */

/* What a section is of; each filter says what its parameters are. */
typedef struct noh_wire_section {
    uint8_t kind, mode;
    uint16_t stride;
    uint32_t at;    /* in the image */
    uint32_t count; /* bytes, where no mesh says */
    uint32_t params[8];
} noh_wire_section;

/* The mesh that sections are about. Its arrays are in the image, which is not checked yet: indices are clamped below
 * their counts where they are used. */
typedef struct noh_wire_mesh {
    noh_mesh_header header; /* the finest level's */
    uint32_t chunk;         /* where it lies in the image; 0: there is none */
    uint32_t begun;         /* 1: a section of it came: triangles need the scratch as it was before */
    uint32_t level_count;
    uint32_t order_count;
    uint32_t *order;     /* [vertex_count] vertices as triangles come to them */
    uint32_t *around;    /* [vertex_count][3] a triangle's edge and the vertex on its other side, or NOH_NONE */
    uint32_t *ends;      /* [vertex_count] where the edge from a vertex ends that waits for its other side; NOH_NONE */
    uint32_t *starts;    /* [vertex_count] where the one that ends there starts */
    uint32_t *beyond;    /* [vertex_count] the third vertex of the triangle that has that edge */
    uint32_t *more;      /* [vertex_count][2][3] two more parallelograms: two ends less a third; NOH_NONE: none */
    uint32_t *next;      /* [vertex_count + 1] towards the next vertex that triangles did not come to */
    int32_t *grid;       /* [vertex_count][3] */
    float *directions;   /* [vertex_count][3], in the place of the grid */
    float *moved;        /* [vertex_count][3] */
    uint32_t *twins;     /* [vertex_count] until positions are there its place in the order; then the first vertex at
                          * the same place */
    uint32_t summed;     /* directions are there: 1 by vertex, 2 by place */
    uint32_t kinds;      /* of deltas that the target has: bit 0 positions, 1 normals, 2 tangents */
    uint32_t *slots;     /* [touched_count] delta texels of a target, from 1; 0: it has none there */
    uint32_t *reference; /* [touched_count] of the target that this one is like */
} noh_wire_mesh;

/* A row of the order in which targets are written: its number, 1 + the number of the target it is coded as a
 * difference from (0: none), and which kinds of its deltas are not 0 everywhere. */
#define NOH_WIRE_PLAN(target, like, kinds) ((uint32_t)(target) | (uint32_t)(like) << 10 | (uint32_t)(kinds) << 21)
#define NOH_WIRE_PLAN_TARGET(plan) ((plan)&0x3ffu)
#define NOH_WIRE_PLAN_LIKE(plan) ((plan) >> 10 & 0x7ffu)
#define NOH_WIRE_PLAN_KINDS(plan) ((plan) >> 21 & 7u)

typedef struct noh_wire_edge {
    uint32_t a, b, across;
} noh_wire_edge;

#define NOH_WIRE_EDGES 16u

typedef struct noh_wire_filter {
    noh_wire_coder coder;
    const uint8_t *before; /* the image before this one */
    uint32_t before_bytes;
    uint8_t *image;
    uint32_t image_bytes;
    uint8_t *scratch; /* behind the image: what a mesh needs while its arrays are made */
    uint32_t scratch_bytes;
    const char *wrong;    /* what is wrong with the section */
    const uint32_t *plan; /* when targets are written: [target_count] NOH_WIRE_PLAN */
    noh_wire_section section;
    noh_wire_mesh mesh;
    uint32_t cursor[4]; /* where the filter goes on in its next block */
    int32_t last[12];   /* previous values and magnitudes */
    noh_wire_edge edges[NOH_WIRE_EDGES];
    uint32_t recent[NOH_WIRE_EDGES];
    noh_wire_model models[NOH_WIRE_MODELS];
} noh_wire_filter;

#define NOH_WIRE_END 12u /* the image ends, and has to open as a pack */

/* ---- the file: a header, then blocks ---- */

#define NOH_WIRE_MAGIC 0x5a484f4eu /* "NOHZ" */
#define NOH_WIRE_IMAGES_MAX 2u

typedef struct noh_wire_head {
    uint32_t magic, version;
    uint32_t file_bytes;
    uint32_t library_version; /* that wrote it, for reports */
    uint32_t image_count;     /* 1 or 2 packs: the last is the whole one */
    uint32_t image_bytes[NOH_WIRE_IMAGES_MAX];
    uint32_t scratch_bytes;
    uint32_t reserved[7];
    uint32_t crc; /* CRC-32C of all fields before it; the first block continues from this value */
} noh_wire_head;

/* Head of a block: items (16 bits), bytes behind the head (15 bits) with the flag of a section, CRC-32C of both words
 * and the bytes, going on from the block before: blocks cannot change places. A block without the flag is read by the
 * filter of the section before it. */
#define NOH_WIRE_BLOCK_HEAD_BYTES 8u
#define NOH_WIRE_BLOCK_BYTES_MAX 16384u
#define NOH_WIRE_BLOCK_SECTION 0x8000u
#define NOH_WIRE_ITEMS_MAX 65535u
#define NOH_WIRE_SECTION_BYTES 44u

/* A section as bytes: kind, mode, stride, then words. */
void noh_wire_section_write(const noh_wire_section *section, uint8_t bytes[NOH_WIRE_SECTION_BYTES]);
void noh_wire_section_read(noh_wire_section *section, const uint8_t bytes[NOH_WIRE_SECTION_BYTES]);

/* Begin a section; then run it until it is done, once for each block.
 * returns  1 done, 0 the block is used up, -1 `wrong` */
int noh_wire_begin(noh_wire_filter *filter, const noh_wire_section *section);
int noh_wire_run(noh_wire_filter *filter);
/* Bytes of scratch that a mesh needs. */
/* The first vertex in the order at each one's place, into mesh.twins. */
void noh_wire_find_twins(noh_wire_filter *filter);
uint64_t noh_wire_scratch(const noh_mesh_header *header);

/* The filters by kind. */
int noh_wire_run_bytes(noh_wire_filter *filter);
int noh_wire_run_texture(noh_wire_filter *filter);
int noh_wire_run_blocks(noh_wire_filter *filter);
int noh_wire_run_indices(noh_wire_filter *filter);
int noh_wire_run_positions(noh_wire_filter *filter);
int noh_wire_run_normals(noh_wire_filter *filter);
int noh_wire_run_column(noh_wire_filter *filter);
int noh_wire_run_texel_refs(noh_wire_filter *filter);
int noh_wire_run_influences(noh_wire_filter *filter);
int noh_wire_run_deltas(noh_wire_filter *filter);

/* ---- shared by the filters ---- */

static inline int noh_wire_wrong(noh_wire_filter *filter, const char *what)
{
    filter->wrong = what;
    return -1;
}

static inline int noh_wire_writes(const noh_wire_filter *filter)
{
    return filter->coder.record != 0;
}

/* Words of the image, at any byte; beyond its end they are 0, and lost. */
static inline uint32_t noh_wire_load(const noh_wire_filter *filter, uint64_t at)
{
    const uint8_t *b = filter->image + at;
    if (at + 4u > filter->image_bytes) return 0;
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static inline void noh_wire_store(noh_wire_filter *filter, uint64_t at, uint32_t word)
{
    uint8_t *b = filter->image + at;
    if (noh_wire_writes(filter) || at + 4u > filter->image_bytes) return;
    b[0] = (uint8_t)word;
    b[1] = (uint8_t)(word >> 8);
    b[2] = (uint8_t)(word >> 16);
    b[3] = (uint8_t)(word >> 24);
}

/* How large the values of a column have been of late, as one of 8 classes. */
static inline uint32_t noh_wire_class(uint32_t magnitude)
{
    static const uint8_t classes[32] = { 0, 1, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4,
                                         5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5 };
    return magnitude < 32u ? classes[magnitude] : magnitude < 128u ? 6u : 7u;
}

static inline uint32_t noh_wire_magnitude(int32_t value)
{
    return value < 0 ? 0u - (uint32_t)value : (uint32_t)value;
}

/* Code a value of a column, given how large its neighbours were; 8 models a column from `first`, and one for all
 * large values. */
static inline int32_t noh_wire_residual(noh_wire_filter *filter, uint32_t first, uint32_t magnitude, int32_t value)
{
    return noh_wire_value(&filter->coder, &filter->models[first + noh_wire_class(magnitude)],
                          &filter->models[NOH_WIRE_MODELS - 1u], value);
}

/* What a vertex is predicted from: a sum of what other vertices have, over a divisor. The means of up to three
 * parallelograms; without any an edge, a vertex, or nothing. */
#define NOH_WIRE_TERMS 9u

typedef struct noh_wire_near {
    uint32_t a, b, across; /* the triangle that it was reached from; NOH_NONE: there is no such vertex */
    uint32_t count;
    int32_t divisor;
    uint32_t vertex[NOH_WIRE_TERMS];
    int32_t sign[NOH_WIRE_TERMS];
} noh_wire_near;

noh_wire_near noh_wire_near_of(const noh_wire_filter *filter, uint32_t vertex);

/* The sum divided, to the nearest. */
static inline int32_t noh_wire_mean(const noh_wire_near *near, int64_t sum)
{
    const int64_t half = near->divisor / 2;
    return near->divisor == 1 ? (int32_t)sum : (int32_t)((sum + (sum < 0 ? -half : half)) / near->divisor);
}

/* The fourth corner of one parallelogram, or what is nearest to it. */
static inline int32_t noh_wire_predict(const noh_wire_near *near, int32_t a, int32_t b, int32_t across)
{
    if (near->a == NOH_NONE) return 0;
    if (near->b == NOH_NONE) return a;
    if (near->across == NOH_NONE) return (int32_t)(((int64_t)a + b) / 2);
    return (int32_t)((uint32_t)a + (uint32_t)b - (uint32_t)across);
}

/* How large the last residuals of a component were. */
static inline uint32_t noh_wire_activity(const noh_wire_filter *filter, uint32_t component)
{
    return (uint32_t)filter->last[component] / 4u;
}

static inline void noh_wire_note(noh_wire_filter *filter, uint32_t component, int32_t residual)
{
    const uint32_t size = noh_wire_magnitude(residual) > 4095u ? 4095u : noh_wire_magnitude(residual);
    filter->last[component] += (int32_t)size - filter->last[component] / 4;
}

/* The n-th index of a triangle of the finest level, below the count of vertices. */
uint32_t noh_wire_index(const noh_wire_filter *filter, uint32_t n);
/* A vertex's accumulation texel; NOH_NONE: no target moves it. */
uint32_t noh_wire_texel(const noh_wire_filter *filter, uint32_t vertex);
void noh_wire_position(const noh_wire_filter *filter, uint32_t vertex, float position[3]);
/* The sums of the triangles' normals around each vertex, weighed by their areas, into mesh.directions: of each place
 * where `by_place`, else of each vertex. */
void noh_wire_sum_normals(noh_wire_filter *filter, int by_place);

#ifdef __cplusplus
}
#endif

#endif
