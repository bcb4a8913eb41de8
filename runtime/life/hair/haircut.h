/* haircut.h: the hair in a pack: control hairs, and the strips drawn between them.
 *
 *   noh_haircut_open     the haircut of a pack
 *   noh_haircut_strips   the number of strips to draw at a screen size
 *   noh_haircut_fade     opacity of strips over painted hair
 *   noh_haircut_widen    width factor when fewer strips are drawn
 *   noh_haircut_vertex   a vertex of a strip, as in the vertex shader
 *
 * A strip lies in a patch of four control hairs, at some point between their curves. Its place, length and curl follow
 * from its number alone: the GPU receives the control hairs, and no data per strip.
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
    const char *joint;       /* the joint that carries it; "": the actor itself */
    const uint32_t *patches; /* [header->patch_count][4] */
    noh_hair_desc desc;      /* of the control hairs */
} noh_haircut;

/* Get the haircut of a pack. The pack must outlive it.
 * errors  NOT_FOUND the pack has none */
noh_result noh_haircut_open(const noh_pack *pack, noh_haircut *out, noh_error *error);

/* Get the number of strips to draw at a number of pixels per metre: all from 500 up, proportionally fewer below, none
 * at 25 and below, where hair covers only a few pixels and is painted on the head. */
uint32_t noh_haircut_strips(const noh_haircut *cut, float pixels_per_metre);

/* Get the opacity of strips over hair painted on the head: 1 from 50 pixels per metre up, 0 at 25. */
float noh_haircut_fade(float pixels_per_metre);

/* Get the width factor with which `strips` strips cover as much as all of them. 1 for 0. */
float noh_haircut_widen(const noh_haircut *cut, uint32_t strips);

/* Compute a point of the centre line of a strip and its tangent, as the vertex shader does (hair.vert), within the
 * precision of the GPU's sines.
 * shapes  points: from noh_hair_points
 * ranges  strip below noh_pack_hair_header.strip_count; along 0 the root, 1 the tip */
void noh_haircut_vertex(const noh_haircut *cut, const float *points, uint32_t strip, float along, float position[3],
                        float tangent[3]);

#ifdef __cplusplus
}
#endif

#endif
