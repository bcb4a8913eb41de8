/* input_file.h: a whole input file in memory, the list of all files that a conversion reads, and files that are in
 * memory from the start. */
#ifndef NOH_CONVERT_BASE_INPUT_FILE_H
#define NOH_CONVERT_BASE_INPUT_FILE_H

#include <stdint.h>

#include "convert/base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The bytes of a file and a zero after them, to be freed. NULL and *error where it cannot be read. */
char *input_read(const char *path, size_t *bytes, model_error *error);

/* The same for a text: lines end with LF or CRLF, and UTF-16 and a binary file are
 * errors. */
char *input_read_text(const char *path, size_t *bytes, model_error *error);
/* Name an input file in an error: the message begins with the input's name. Returns 1. */
int input_fail_at(const char *path, model_error *error);

/* A file that the caller of noh_convert.h has in memory. */
typedef struct input_held {
    const char *path;
    const void *bytes;
    size_t count;
} input_held;

/* From now on this thread reads these files and none of the machine's; NULL: the machine's again. They stay the
 * caller's. Paths are compared without "./" and "FOLDER/../". */
void inputs_hold(const input_held *files, uint32_t count);
int inputs_are_held(void);
/* NULL: there is none of this name. */
const input_held *input_find_held(const char *path);
/* The name of the next file in a folder, not below it; *at starts with 0. NULL: no more. */
const char *input_next_held(const char *folder, uint32_t *at);
/* Windows does not distinguish A.PNG from a.png, so a file may name its pictures, and their folders, in another case.
 * found[size]: the path as it is there, of several the one as given, then the first by its bytes, folder by folder; it
 * is as long as `path`. 0: there is none, or it does not fit. */
int input_find_any_case(const char *path, char *found, size_t size);
/* Its bytes until input_unmap. 0, or 1 and *what, the reason (NULL: not wanted). */
int input_map(const char *path, const void **bytes, size_t *count, const char **what);
void input_unmap(const void *bytes, size_t count);

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
