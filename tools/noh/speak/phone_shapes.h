/* phone_shapes.h: the mouth shapes of phones: the rows `phone` of a face's recipe, and for all other phones what
 * noh_viseme_of_phone gives. */
#ifndef NOH_NOH_SPEAK_PHONE_SHAPES_H
#define NOH_NOH_SPEAK_PHONE_SHAPES_H

#include "noh/face.h"
#include "noh/pack.h"

/* Take the rows of a face's recipe, once a process. The pack stays open until the last phone_shape. */
void phone_shapes_of(const noh_pack *face);

/* As noh_viseme_of_phone; second may be NULL. */
noh_viseme phone_shape(const char *phone, noh_viseme *second);

#endif
