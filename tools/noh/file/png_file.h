/* png_file.h: pictures as .png files. */
#ifndef NOH_NOH_FILE_PNG_FILE_H
#define NOH_NOH_FILE_PNG_FILE_H

#include <stdint.h>

/* Write a whole picture or nothing: rgba[height][width][4], top row first. Prints an error and returns an exit code; 0
 * on success. */
int tool_write_png(const char *path, uint32_t width, uint32_t height, const uint8_t *rgba);

#endif
