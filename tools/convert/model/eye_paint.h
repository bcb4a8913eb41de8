/* eye_paint.h: an iris and a pupil for eyes of one colour, which would look blind, no shadow that turns with
 * an eye, and no lashes that are a slab. */
#ifndef NOH_CONVERT_MODEL_EYE_PAINT_H
#define NOH_CONVERT_MODEL_EYE_PAINT_H

#include "model.h"

/* Paint pale eyes that have no texture, do not glow, and have one vertex colour: two balls of one size, side by side,
 * get a texture that is made here, and texture coordinates about the world's +z, where they look, by the first node that
 * draws them. Of balls in each other the outermost is seen; an iris, pupil or cornea of another opaque material that is
 * seen, too, leaves its eye as it is. Painted materials become white and wet, and add a warning. Meshes without texture
 * coordinates get zeros for all else, and no tangents. Surfaces of materials are known. If the model has no texture of
 * its own, materials of skin, or named as a face, head or neck, that are grey or have a colour of people become skin,
 * each with a warning, unless their surface is given or they have vertex colours: a living eye in plaster looks
 * uncanny. Grey takes skin's colour.
 * returns  1: out of memory */
int eye_paint(model *m);

/* Eyes with a texture may have the shadow of the lids in their vertex colours: greys, dark behind the lids. It turns with
 * the eyeball, and an eye that looks aside is grey where it should be white. Such colours become white, with a warning,
 * unless the surface is given.
 * returns  1: out of memory */
int eye_shade_clear(model *m);

/* Strips of lashes that lack the picture that cuts them are slabs: opaque ones without a texture and vertex colours are
 * not drawn, with a warning. Modelled lashes, of many small pieces, stay, and so do those whose surface is given.
 * returns  1: out of memory */
int lash_strips_hide(model *m);

#endif
