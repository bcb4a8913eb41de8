/* teeth_paint.h: gums for teeth of one colour, and a colour for pale gums. */
#ifndef NOH_CONVERT_MODEL_TEETH_PAINT_H
#define NOH_CONVERT_MODEL_TEETH_PAINT_H

#include "model.h"

/* Paint teeth that have no texture, and no other hue in their vertex colours, from their edge to the gum, in vertex
 * colours: a crown is 0.16 of the width of the jaw high, and gum is what lies farther from the edge. Their brightest
 * place becomes as bright as enamel, or white vertex colours where the base color is darker; what is darker in the file
 * stays so. Needs two jaws of a similar height and width that overlap by no more than an overbite, or by two fifths of a
 * jaw's height if a target parts them. Surfaces of materials are known. Materials that are by their names gums, a
 * tongue or a mouth, where the file has others of teeth, become red, with a warning, if they have no texture, no colour
 * of flesh, and no given surface.
 * returns  1: out of memory */
int teeth_paint(model *m);

#endif
