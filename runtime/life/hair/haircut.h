/* haircut.h: the hair of a pack: control hairs, and the strips that are drawn between them.
 *
 *   noh_haircut_open     the haircut of a pack
 *   noh_haircut_strips   how many strips are drawn, by how many pixels a metre has
 *   noh_haircut_fade     how much of them, where paint takes over
 *   noh_haircut_widen    how much wider fewer strips are
 *   noh_haircut_vertex   a vertex of a strip, as the vertex shader has it
 *
 * A strip lies in a patch of four control hairs, somewhere between their curves. Where, how long it is and how it
 * curls follows from its number alone: the GPU is told the control hairs, and no byte for any strip.
 *
 * Threads: constant data; any thread.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 15: patches of four control hairs; Nguyen,
 *          Donnelly: Hair Animation and Rendering in the Nalu Demo, GPU Gems 2, 2005, chapter 23 */
#ifndef NOH_SIM_HAIRCUT_H
#define NOH_SIM_HAIRCUT_H

#include "core/pack/pack.h"
#include "life/hair/hair.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_haircut {
    const noh_pack_hair_header *header;
    const char *joint;       /* that carries it; "": the actor itself */
    const uint32_t *patches; /* [header->patch_count][4] */
    noh_hair_desc desc;      /* of its control hairs */
} noh_haircut;

/* The haircut of a pack, which must stay.
 * errors  NOT_FOUND the pack has none */
noh_result noh_haircut_open(const noh_pack *pack, noh_haircut *out, noh_error *error);

/* Strips to draw of hair of which a metre is so many pixels: all from 500 pixels on, fewer in proportion below, none
 * from 25 down, where hair is a few pixels and what is painted on the head shows it. */
uint32_t noh_haircut_strips(const noh_haircut *cut, float pixels_per_metre);

/* How much of that hair covers what is painted on the head: 1 from 50 pixels a metre on, 0 at 25. */
float noh_haircut_fade(float pixels_per_metre);

/* The factor by which `strips` strips are wider than all would be: they cover as much. 1 for 0. */
float noh_haircut_widen(const noh_haircut *cut, uint32_t strips);

/* A point of the middle line of a strip, and where the strip goes there: what the vertex shader computes (hair.vert),
 * within the precision of the GPU's sines.
 * shapes  points: of noh_hair_points
 * ranges  strip below noh_pack_hair_header.strip_count; along 0 the root to 1 the tip */
void noh_haircut_vertex(const noh_haircut *cut, const float *points, uint32_t strip, float along, float position[3],
                        float tangent[3]);

#ifdef __cplusplus
}
#endif

#endif
