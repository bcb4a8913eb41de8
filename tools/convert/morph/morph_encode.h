/* morph_encode.h: from dense morph targets to the pack's sparse form.
 *
 * The encoder drops pairs that move nothing, orders vertices so that those that move together lie together in the
 * accumulation texture, covers each target's vertices by rectangles, and quantises the deltas (layouts in
 * format.h). Microsoft's SparseMorphTargets sample has one rectangle per target, over vertices in the
 * order of the artist's tool; here the order is chosen, and a target may have many rectangles. The same mesh and
 * options give the same bytes on every machine: seeds are fixed, and nothing depends on addresses or on contraction of
 * floats. */
#ifndef NOH_CONVERT_MORPH_MORPH_ENCODE_H
#define NOH_CONVERT_MORPH_MORPH_ENCODE_H

#include "convert/model/model.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct morph_options {
    float error_um; /* largest position error of one target at weight 1, micrometres (model unit = metre); 0 = 10 */
    uint32_t rects; /* the most rectangles per target in each LOD level; 0 = auto (by cost) */
    float rect_cost_texels; /* for auto: the cost of a rectangle, in texels; 0 = default */
    const uint8_t *rank;  /* [vertex_count] the coarsest LOD level that has the vertex; NULL: all are in level 0 only */
    uint32_t level_count; /* 0 = 1 */
    const float *skip_radius; /* [level_count] rising: a level leaves out the targets of smallest radius whose radii sum
                                 to at most this; NULL: none */
} morph_options;

typedef struct morph_rect {
    uint16_t x, y, w, h;
} morph_rect; /* texels of the accumulation texture */

typedef struct morph_target {
    uint32_t first_rect, rect_count;   /* rectangles in drawing order; may be 0 */
    uint32_t first_texel, texel_count; /* the sum of its rectangles' areas */
    uint32_t pair_count;               /* (vertex, target) pairs kept: texels that are not all zero */
    uint32_t source_pairs; /* pairs of the source above 1e-6 x the bounding box's diagonal (or 1e-5 of a normal or
                              tangent) */
    uint8_t position_bits, normal_bits, tangent_bits;
    float position_scale, normal_scale, tangent_scale; /* value = integer x scale */
    float radius;                                      /* largest |position delta| of the source */
    float position_error;              /* largest |decoded - source| over all vertices, dropped pairs included */
    float normal_error, tangent_error; /* likewise, per component */
} morph_target;

/* A target in a LOD level: how many of its first rectangles, and the texels and pairs in them. */
typedef struct morph_part {
    uint32_t rect_count, texel_count, pair_count;
} morph_part;

/* Texels: [texel_count][3] words, word i holds axis i (x, y, z):
 *   bits from the top: position (position_bits), normal (normal_bits), tangent (tangent_bits),
 *   two's complement; bits that are left over at the bottom are zero. */
typedef struct morph_encoding {
    uint32_t vertex_count, target_count; /* with a vertex more for each whose texture coordinates move (uv_texel) */
    uint32_t touched_count; /* the first touched_count vertices of the new order are in the texture, those in coarse
                               levels first */
    uint32_t *order;        /* [vertex_count] new index -> old index; untouched ones in the source's order. From the
                               mesh's vertex_count on, what replaces texture coordinates */
    uint32_t *uv_texel;     /* [the mesh's vertex_count] the texel of its texture coordinates, MODEL_NONE: they do not
                               move; NULL: none move */
    float uv_per_unit;      /* noh_mesh_header.uv_per_unit */
    uint32_t level_count;
    uint32_t *level_touched; /* [level_count] how many of the first accumulation texels a level uses */
    morph_part *parts;       /* [level_count][target_count] */
    uint32_t width_log2;     /* texture width = 1 << width_log2; texel of vertex v: (v & (width-1), v >> width_log2) */
    uint32_t height;         /* ceil(touched_count / width) */
    morph_target *targets;
    uint32_t rect_count;
    morph_rect *rects; /* in target order */
    uint32_t texel_count;
    uint32_t *texels; /* in rectangle order, row by row */
    uint32_t pair_count, source_pairs;
    uint32_t texels_one_rect; /* for the report: sum of areas with one rectangle per target in the source's order */
} morph_encoding;

/* Encode the targets of one mesh. 0 and *out, or 1 and a filled error. */
int morph_encode(const model_mesh *mesh, const morph_options *options, morph_encoding **out, model_error *error);
void morph_encoding_free(morph_encoding *e);

#ifdef __cplusplus
}
#endif
#endif
