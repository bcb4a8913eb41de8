/* byte_buffer.h: a growing block of bytes, the string table of a pack, and numbers in files. */
#ifndef NOH_CONVERT_BASE_BYTE_BUFFER_H
#define NOH_CONVERT_BASE_BYTE_BUFFER_H

#include <stddef.h>
#include <stdint.h>

#include "noh/base.h"

/* A growing block of bytes. */
typedef struct byte_buffer {
    uint8_t *bytes;
    size_t count, capacity;
    int failed; /* an append ran out of memory; later ones do nothing */
} byte_buffer;

void *buffer_append(byte_buffer *b, const void *bytes, size_t count); /* bytes NULL: zeros */
/* Formatted text of less than 512 bytes, without a final zero; longer text is cut. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void buffer_print(byte_buffer *b, const char *format, ...);
void buffer_align(byte_buffer *b, size_t alignment);
void buffer_free(byte_buffer *b);

/* The number of four bytes, the lowest first. */
static inline uint32_t byte_word(const uint8_t *b)
{
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

/* The names of a pack, one copy of each. */
typedef struct string_table {
    byte_buffer bytes;
    uint32_t *slots; /* [slot_count], a power of two: 1 + the offset of a name, by its hash; 0: free */
    uint32_t slot_count, name_count;
} string_table;

void string_table_free(string_table *strings);

/* A name as a pack keeps it: cut to the format's limit (its final zero included), never inside a character. */
void string_cut(const char *name, char cut[NOH_NAME_BYTES_MAX]);

/* The offset of a name, cut likewise; added if it is new. */
uint32_t string_offset(string_table *strings, const char *name);

/* noh_hash_name of a name, cut likewise. */
uint32_t string_hash(const char *name);

#endif
