/* input_file.h: a whole input file in memory, for the readers written in C, and the list of all files that a conversion
 * reads. */
#ifndef NOH_CONVERT_BASE_INPUT_FILE_H
#define NOH_CONVERT_BASE_INPUT_FILE_H

#include <stdint.h>

#include "convert/base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The bytes of a file and a zero after them, to be freed. NULL and *error where it cannot be read. */
char *input_read(const char *path, size_t *bytes, model_error *error);

/* The files that were read or looked for, in the order of the first attempt, each once. */
typedef struct input_list {
    struct input_entry {
        char *path;
        int is_there;
    } * entries;
    uint32_t count;
    int failed; /* out of memory: the list is not complete */
} input_list;

/* Record what this thread reads from now on; NULL: no more. */
void inputs_record(input_list *list);
/* For readers that open files themselves. */
void inputs_note(const char *path, int is_there);
void inputs_free(input_list *list);

/* A file's name without its folder and ending: "walk" of "a/walk.bvh". NULL when out of memory. */
char *input_stem(const char *path);

#ifdef __cplusplus
}
#endif
#endif
