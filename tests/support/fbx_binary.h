/* fbx_binary.h: a writer of binary FBX files out of ASCII ones, for tests: every record, any version and byte order. */
#ifndef NOH_TESTS_SUPPORT_FBX_BINARY_H
#define NOH_TESTS_SUPPORT_FBX_BINARY_H

#include <stddef.h>
#include <stdint.h>

typedef struct fbx_form {
    uint32_t version; /* 7500 and later: records of 64 bits */
    int big_endian;
    int packed; /* arrays are deflated */
} fbx_form;

/* `text`: a valid ASCII file. Returns the bytes written to `out`; the process ends where they do not fit. */
size_t fbx_binary_write(const char *text, const fbx_form *form, uint8_t *out, size_t capacity);

#endif
