/* texture_solid.h: materials whose cutoff cuts nothing. */
#ifndef NOH_CONVERT_TEXTURE_TEXTURE_SOLID_H
#define NOH_CONVERT_TEXTURE_TEXTURE_SOLID_H

#include "convert/lod/lod_levels.h"
#include "convert/model/model.h"

/* Materials with a cutoff whose triangles, on every level and with what filters reach, read no texel below it become
 * opaque: exporters give one cutoff to all materials of a character, and blocks with one bit of alpha have half of the
 * colours. A texture whose alpha nothing reads any more keeps none.
 *
 * Stay as they are: cards of hair; eyes, which are read off the texture coordinates; materials whose factor or vertices
 * have an alpha; where targets move texture coordinates; what is read beyond 0..1; and textures that a game replaces by
 * others (noh_texture_set), whose cuts are their own.
 *
 * levels: [mesh_count], finished, or NULL. Call before texture_trim, which moves texture coordinates, and
 * texture_cut_mark. count: takes how many materials changed. Returns 0, or 1: out of memory. */
int texture_solid(model *m, const mesh_levels *levels, uint32_t *count);

#endif
