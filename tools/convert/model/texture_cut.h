/* texture_cut.h: textures whose alpha only cuts. */
#ifndef NOH_CONVERT_MODEL_TEXTURE_CUT_H
#define NOH_CONVERT_MODEL_TEXTURE_CUT_H

#include "convert/model/model.h"

/* Marks the textures of colours that nothing reads but materials with a cutoff, all the same one of 0.25 to 0.75, whose
 * own alpha and whose vertices' is 1: what is drawn depends on which texels are above the cutoff, and one bit holds
 * that. A filtered bit is cut along a line that is off by the cutoff's distance from 0.5, in texels. */
void texture_cut_mark(model *m);

/* Whether vertices of a material have an alpha that is not 1. */
int texture_cut_vertices(const model *m, uint32_t material);

#endif
