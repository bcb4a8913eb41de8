/* tga_file.h: TGA pictures, which FBX and OBJ files of games often name: grey or colours, also run-length encoded. */
#ifndef NOH_CONVERT_BASE_TGA_FILE_H
#define NOH_CONVERT_BASE_TGA_FILE_H

#include <stddef.h>
#include <stdint.h>

#include "convert/base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Whether these bytes may begin a TGA picture, which has no mark of its own. */
int tga_begins(const unsigned char *bytes, size_t count);

/* Returns 0, the size, the channels in the file (1, 3 or 4) and [height][width][4], the top row first, to be freed with
 * free(); or 1 and *error: the data is damaged or of a kind that is not read, or has more than pixels_max pixels. Where
 * pixels are damaged, the size is set as well.
 * source  Truevision TGA file format specification, version 2.0 */
int tga_read(const unsigned char *bytes, size_t count, uint64_t pixels_max, uint32_t *width, uint32_t *height,
             uint32_t *channels, unsigned char **rgba, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
