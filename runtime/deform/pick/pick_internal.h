/* pick_internal.h (private to deform/): the visibility test of pick_cutout.c. */
#ifndef NOH_DEFORM_PICK_INTERNAL_H
#define NOH_DEFORM_PICK_INTERNAL_H

#include "noh/format.h"
#include "noh/pack.h"

/* Whether a point of a triangle is visible, by the rule of mesh.frag at the texture's first mip level.
 * vertices    its corners
 * mix         [3] barycentric weights of the corners
 * tint_alpha  0..255: used if the material blends */
int noh_pick_shows(const noh_mesh *mesh, const noh_submesh *submesh, const uint32_t vertices[3], const float mix[3],
                   uint8_t tint_alpha);

#endif
