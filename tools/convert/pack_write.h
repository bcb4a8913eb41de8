/* pack_write.h: from a model and its encoded targets to the bytes of a pack. */
#ifndef NOH_CONVERT_PACK_WRITE_H
#define NOH_CONVERT_PACK_WRITE_H

#include "morph_encode.h"

/* A growing block of bytes. */
typedef struct byte_buffer {
    uint8_t *bytes;
    size_t count, capacity;
    int failed; /* out of memory at some append; later appends do nothing */
} byte_buffer;

void *buffer_append(byte_buffer *b, const void *bytes, size_t count); /* bytes NULL: zeros */
void buffer_align(byte_buffer *b, size_t alignment);
void buffer_free(byte_buffer *b);

/* Refuse what no pack can hold: before encoding, and after. 0, or 1 and a filled error with the limit. */
int pack_check_model(const model *m, model_error *error);
int pack_check_encoding(const model_mesh *m, const morph_encoding *e, model_error *error);

/* Build a pack. encodings[mesh_count], none NULL. 0 on success, else 1 and a filled error. */
int pack_write(const model *m, morph_encoding *const *encodings, byte_buffer *out, model_error *error);

#endif
