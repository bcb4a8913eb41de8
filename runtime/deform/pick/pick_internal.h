/* pick_internal.h: what pick.c asks pick_cutout.c. */
#ifndef NOH_DEFORM_PICK_INTERNAL_H
#define NOH_DEFORM_PICK_INTERNAL_H

#include "core/mesh/mesh.h"

/* Whether a place of a triangle shows, as mesh.frag decides it at the texture's first mip level.
 * vertices    its corners
 * mix         [3] the place: how much each corner counts
 * tint_alpha  0..255: counts where the material blends */
int noh_pick_shows(const noh_mesh *mesh, const noh_submesh *submesh, const uint32_t vertices[3], const float mix[3],
                   uint8_t tint_alpha);

#endif
