#include <stdlib.h>
#include <string.h>

#include "pack_write.h"

void *buffer_append(byte_buffer *b, const void *bytes, size_t count)
{
    if (!b->failed && (b->count + count > b->capacity || !b->bytes)) {
        size_t capacity = (b->count + count) * 2 + 64;
        uint8_t *grown = realloc(b->bytes, capacity);
        if (grown) {
            b->bytes = grown;
            b->capacity = capacity;
        } else {
            b->failed = 1;
        }
    }
    if (b->failed) {
        return NULL;
    }
    if (bytes) {
        memcpy(b->bytes + b->count, bytes, count);
    } else {
        memset(b->bytes + b->count, 0, count);
    }
    b->count += count;
    return b->bytes + b->count - count;
}

void buffer_align(byte_buffer *b, size_t alignment)
{
    size_t rest = b->count % alignment;
    if (rest) {
        buffer_append(b, NULL, alignment - rest);
    }
}

void buffer_free(byte_buffer *b)
{
    free(b->bytes);
    memset(b, 0, sizeof *b);
}
