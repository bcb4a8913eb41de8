/* file_kind.h: what a file is, by its first bytes or its ending: which reader takes it, or what to do with it instead.
 */
#ifndef NOH_CONVERT_BASE_FILE_KIND_H
#define NOH_CONVERT_BASE_FILE_KIND_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum file_reader {
    READER_NONE,
    READER_PACK,
    READER_GLTF,
    READER_FBX,
    READER_OBJ,
    READER_BVH, /* this and those below: clips alone */
    READER_RCL,
    READER_FACE,
    READER_TRC,
    READER_C3D
} file_reader;

typedef struct file_kind {
    const char *ending; /* in small letters; NULL: of no format, but what came in place of a file */
    const char *begins; /* its first bytes, without a zero; NULL: by its ending alone */
    file_reader reader;
    const char *what;    /* "a Blender file" */
    const char *instead; /* what to do with it; NULL where a reader takes it */
} file_kind;

/* By the first bytes, else by the ending. NULL: of no kind, or a missing file that no reader would take. */
const file_kind *file_kind_of(const char *path);

/* By the first bytes alone. NULL: of no kind. */
const file_kind *file_kind_of_bytes(const void *bytes, size_t count);

/* ending: in small letters, such as ".png"; the path may have capitals. */
int file_has_ending(const char *path, const char *ending);

/* 1 where noh build makes a pack of it. */
int file_kind_is_built(const file_kind *kind);

#ifdef __cplusplus
}
#endif

#endif
