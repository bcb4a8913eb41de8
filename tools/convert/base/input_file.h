/* input_file.h: a whole input file in memory, for the readers written in C. */
#ifndef NOH_CONVERT_BASE_INPUT_FILE_H
#define NOH_CONVERT_BASE_INPUT_FILE_H

#include "convert/base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The bytes of a file and a zero after them, to be freed. NULL and *error where it cannot be read. */
char *input_read(const char *path, size_t *bytes, model_error *error);

/* A file's name without its folder and ending: "walk" of "a/walk.bvh". NULL when out of memory. */
char *input_stem(const char *path);

#ifdef __cplusplus
}
#endif
#endif
