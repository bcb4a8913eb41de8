/* bmp_file.h: BMP pictures, which FBX and OBJ files name. stb_image decodes them, but fills up what is missing. */
#ifndef NOH_CONVERT_BASE_BMP_FILE_H
#define NOH_CONVERT_BASE_BMP_FILE_H

#include <stddef.h>

#include "convert/base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

int bmp_begins(const unsigned char *bytes, size_t count);

/* Whether stb_image must not have these bytes, which begin so: they are cut off or packed, or lack colours. Returns 0,
 * or 1 and *error.
 * source  Microsoft, Windows GDI: BITMAPFILEHEADER, BITMAPV5HEADER */
int bmp_is_refused(const unsigned char *bytes, size_t count, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
