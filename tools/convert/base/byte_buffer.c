#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "byte_buffer.h"
#include "noh/base.h"
#include "noh/low_core.h"

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

void buffer_print(byte_buffer *b, const char *format, ...)
{
    char text[512];
    va_list args;
    int count;
    va_start(args, format);
    count = vsnprintf(text, sizeof text, format, args);
    va_end(args);
    if (count > 0) buffer_append(b, text, count < (int)sizeof text ? (size_t)count : sizeof text - 1);
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

void string_cut(const char *name, char cut[NOH_NAME_BYTES_MAX])
{
    size_t length = strlen(name);
    if (length >= NOH_NAME_BYTES_MAX) {
        length = NOH_NAME_BYTES_MAX - 1;
        while (length && ((unsigned char)name[length] & 0xc0u) == 0x80u) {
            length--; /* not in the middle of a UTF-8 character */
        }
    }
    memcpy(cut, name, length);
    cut[length] = 0;
}

/* The slot of a name, or a free one. */
static uint32_t *slot_of(const string_table *s, const char *name)
{
    uint32_t slot = noh_hash_name(name) & (s->slot_count - 1u);
    while (s->slots[slot] && strcmp((char *)s->bytes.bytes + s->slots[slot] - 1u, name) != 0) {
        slot = (slot + 1u) & (s->slot_count - 1u);
    }
    return &s->slots[slot];
}

/* At least half of the slots are free. */
static int grow_slots(string_table *s)
{
    uint32_t *slots, count = s->slot_count ? 2u * s->slot_count : 64u;
    if (2u * (s->name_count + 1u) <= s->slot_count) return 0;
    slots = calloc(count, sizeof *slots);
    if (!slots) return 1;
    free(s->slots);
    s->slots = slots;
    s->slot_count = count;
    for (size_t at = 0; at < s->bytes.count; at += strlen((char *)s->bytes.bytes + at) + 1u) {
        *slot_of(s, (char *)s->bytes.bytes + at) = (uint32_t)at + 1u;
    }
    return 0;
}

uint32_t string_offset(string_table *strings, const char *name)
{
    char cut[NOH_NAME_BYTES_MAX];
    uint32_t *slot;
    string_cut(name, cut);
    strings->bytes.failed |= grow_slots(strings);
    if (strings->bytes.failed) return 0;
    slot = slot_of(strings, cut);
    if (!*slot && buffer_append(&strings->bytes, cut, strlen(cut) + 1u)) {
        strings->name_count++;
        *slot = (uint32_t)(strings->bytes.count - strlen(cut));
    }
    return *slot ? *slot - 1u : 0u;
}

void string_table_free(string_table *strings)
{
    buffer_free(&strings->bytes);
    free(strings->slots);
    memset(strings, 0, sizeof *strings);
}

uint32_t string_hash(const char *name)
{
    char cut[NOH_NAME_BYTES_MAX];
    string_cut(name, cut);
    return noh_hash_name(cut);
}
