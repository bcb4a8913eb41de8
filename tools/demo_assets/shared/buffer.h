/* Growing text and bytes. */
#ifndef MASK_BUFFER_H
#define MASK_BUFFER_H

#include <stdint.h>

typedef struct {
    unsigned char *bytes;
    int count, space;
} Buffer;

void buffer_print(Buffer *buffer, const char *format, ...);
void buffer_append(Buffer *buffer, const Buffer *other);
void buffer_pad(Buffer *buffer, int alignment, unsigned char with);
void buffer_u8(Buffer *buffer, uint32_t value);
void buffer_u16(Buffer *buffer, uint32_t value); /* little-endian */
void buffer_u32(Buffer *buffer, uint32_t value);
void buffer_float(Buffer *buffer, float value);
void buffer_free(Buffer *buffer);

#endif
