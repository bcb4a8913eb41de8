/* psd_file.h: Photoshop files, which FBX and OBJ files of artists name: their flattened picture, grey or colours of 8
 * or 16 bits. stb_image takes every alpha for a blend with white, which spoils textures with a channel of alpha. */
#ifndef NOH_CONVERT_BASE_PSD_FILE_H
#define NOH_CONVERT_BASE_PSD_FILE_H

#include <stddef.h>
#include <stdint.h>

#include "convert/base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

int psd_begins(const unsigned char *bytes, size_t count);

/* Returns 0, the size, the channels in the file (1 to 4) and [height][width][4], the top row first, to be freed with
 * free(); or 1 and *error: the data is damaged or of a kind that is not read, or has more than pixels_max pixels. Where
 * pixels are damaged, the size is set as well.
 * source  Adobe Photoshop File Formats Specification */
int psd_read(const unsigned char *bytes, size_t count, uint64_t pixels_max, uint32_t *width, uint32_t *height,
             uint32_t *channels, unsigned char **rgba, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
