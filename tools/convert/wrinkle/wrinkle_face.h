/* wrinkle_face.h: where the eyes, brows and mouth of a face are, out of what its channels move (noh/face.h). */
#ifndef NOH_CONVERT_WRINKLE_WRINKLE_FACE_H
#define NOH_CONVERT_WRINKLE_WRINKLE_FACE_H

#include "convert/base/recipe_read.h"
#include "wrinkle_strain.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A face's own coordinates: x to one side, y up, z out of the face; the eyes are at x = -0.5 and 0.5. */
typedef struct wrinkle_face {
    double middle[3];  /* between the eyes, model units */
    double axis[3][3]; /* unit: x, y, z */
    double unit;       /* from eye to eye, model units */
    double brow;       /* y of the brows */
    double mouth[2];   /* x and y of the corner of the mouth, the mean of both */
} wrinkle_face;

/* Find them on the field's material. recipe: rows of the artist, NULL: none. Returns 1, or 0: its targets do not blink
 * and smile, or not where a face does. */
int wrinkle_face_find(const wrinkle_field *field, const recipe_text *recipe, wrinkle_face *out);

/* A point or a direction in the face's coordinates. A direction keeps its length. */
void wrinkle_face_point(const wrinkle_face *face, const double point[3], double out[3]);
void wrinkle_face_direction(const wrinkle_face *face, const double direction[3], double out[3]);

#ifdef __cplusplus
}
#endif
#endif
