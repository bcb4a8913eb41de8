/* hollow_paint.h: dark nostrils and ears for skin that no texture shades. */
#ifndef NOH_CONVERT_LIGHT_HOLLOW_PAINT_H
#define NOH_CONVERT_LIGHT_HOLLOW_PAINT_H

#include "convert/model/model.h"

/* A texture of skin has dark nostrils; skin of one colour is lit in them as on the cheeks. Vertices of skin without a
 * texture and vertex colours get dark ones where the mesh's own skin lets in little light, at rest and with each target
 * at 1: so lids and lips, which targets open, stay as they are. Each mesh that is changed adds a warning. Skin whose
 * surface is given stays. With joints, only vertices that one joint moves alone become dark, and only triangles which
 * the same joint moves alone shade them: so arms do not darken a body's sides, and a jaw does not darken its mouth. The
 * surfaces of materials are known, and the meshes have normals.
 * returns  1: out of memory */
int hollow_paint(model *m);

#endif
