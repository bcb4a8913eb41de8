/* palette_deal.h (private to the pack writer): splits a mesh that follows more joints than one draw may use.
 *
 * Greedy by triangle: each goes to the palette that lacks the fewest of its joints and has room for them, or to a new
 * one. Triangles of one region follow the same few joints and are neighbours in the mesh's order, so palettes cover
 * regions; vertices on the border of two palettes are doubled. The least number of parts is a set-cover problem; the
 * greedy choice may need more, but no part exceeds the limit. */
#ifndef NOH_CONVERT_SKIN_PALETTE_DEAL_H
#define NOH_CONVERT_SKIN_PALETTE_DEAL_H

#include "convert/model/model.h"

/* Sets of joints, as bits. */
typedef struct palette_deal {
    uint32_t joint_count, limit, words; /* words: of one set */
    uint32_t palette_count;
    uint64_t *sets;  /* [palette_count][words] */
    uint32_t *sizes; /* [palette_count] */
} palette_deal;

/* limit: joints that a palette holds. 1 when out of memory; free in both cases. */
int palette_deal_begin(palette_deal *deal, uint32_t joint_count, uint32_t limit);
void palette_deal_free(palette_deal *deal);

/* The palette for a triangle: of those from `first` on the one that needs the fewest further joints, or a new one.
 * Its joints are added. Returns 0, or 1 and a filled error. */
int palette_deal_triangle(palette_deal *deal, const model_mesh *mesh, const uint32_t vertices[3], uint32_t first,
                          uint32_t *palette, model_error *error);

int palette_deal_has(const palette_deal *deal, uint32_t palette, uint32_t joint);

#endif
