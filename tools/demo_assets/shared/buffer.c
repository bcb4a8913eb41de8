#include "buffer.h"

#include "grab.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static unsigned char *make_room(Buffer *buffer, int more)
{
    int need = buffer->count + more;
    if (need > buffer->space) {
        buffer->space = need > 2 * buffer->space ? need + 256 : 2 * buffer->space;
        buffer->bytes = grab(buffer->bytes, buffer->space, 1);
    }
    return buffer->bytes + buffer->count;
}

void buffer_print(Buffer *buffer, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    int length = vsnprintf(NULL, 0, format, list);
    va_end(list);
    if (length < 0) {
        return;
    }
    char *room = (char *)make_room(buffer, length + 1);
    va_start(list, format);
    vsnprintf(room, (size_t)length + 1, format, list);
    va_end(list);
    buffer->count += length;
}

void buffer_append(Buffer *buffer, const Buffer *other)
{
    if (other->count == 0) {
        return;
    }
    memcpy(make_room(buffer, other->count), other->bytes, (size_t)other->count);
    buffer->count += other->count;
}

static void put(Buffer *buffer, uint32_t value, int bytes)
{
    unsigned char *room = make_room(buffer, bytes);
    for (int i = 0; i < bytes; i++) {
        room[i] = (unsigned char)(value >> 8 * i & 0xff);
    }
    buffer->count += bytes;
}

void buffer_u8(Buffer *buffer, uint32_t value)
{
    put(buffer, value, 1);
}
void buffer_u16(Buffer *buffer, uint32_t value)
{
    put(buffer, value, 2);
}
void buffer_u32(Buffer *buffer, uint32_t value)
{
    put(buffer, value, 4);
}

void buffer_float(Buffer *buffer, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(buffer, bits, 4);
}

void buffer_pad(Buffer *buffer, int alignment, unsigned char with)
{
    while (buffer->count % alignment) {
        put(buffer, with, 1);
    }
}

void buffer_free(Buffer *buffer)
{
    free(buffer->bytes);
    Buffer empty = { 0 };
    *buffer = empty;
}
