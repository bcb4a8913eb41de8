#include "support/fbx_binary.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* Of stb_image_write, whose header declares it only for its own implementation. */
unsigned char *stbi_zlib_compress(unsigned char *data, int count, int *packed_count, int quality);

typedef struct writer {
    const char *at;
    const fbx_form *form;
    uint8_t *out;
    size_t count, capacity;
} writer;

/* ---- bytes ---- */

static void put(writer *w, const void *bytes, size_t count)
{
    if (count > w->capacity - w->count) abort();
    memcpy(w->out + w->count, bytes, count);
    w->count += count;
}

static void put_number(writer *w, const void *number, size_t size)
{
    uint8_t bytes[8];
    const uint16_t probe = 1;
    const int here_little = *(const uint8_t *)&probe;
    for (size_t i = 0; i < size; i++)
        bytes[i] = ((const uint8_t *)number)[w->form->big_endian == here_little ? size - 1 - i : i];
    put(w, bytes, size);
}

static void put_u32(writer *w, uint32_t value)
{
    put_number(w, &value, sizeof value);
}

static void put_offset(writer *w, uint64_t value)
{
    if (w->form->version >= 7500)
        put_number(w, &value, sizeof value);
    else
        put_u32(w, (uint32_t)value);
}

static void put_header(writer *w, uint64_t end, uint64_t values, uint64_t size)
{
    put_offset(w, end);
    put_offset(w, values);
    put_offset(w, size);
}

/* ---- text ---- */

static void skip_blank(writer *w)
{
    while (*w->at == ';' || isspace((unsigned char)*w->at)) w->at += *w->at == ';' ? strcspn(w->at, "\n") : 1;
}

static int skip_comma(writer *w)
{
    const char *was = w->at;
    skip_blank(w);
    if (*w->at == ',') {
        w->at++;
        skip_blank(w);
        return 1;
    }
    w->at = was;
    return 0;
}

/* ---- values ---- */

/* "Class::name" is name, 0, 1, Class. */
static void put_text(writer *w)
{
    const char *from = w->at + 1, *end = strchr(from, '"'), *colons = strstr(from, "::");
    if (!end) abort();
    put(w, "S", 1);
    if (colons && colons < end) {
        put_u32(w, (uint32_t)(end - from));
        put(w, colons + 2, (size_t)(end - colons - 2));
        put(w, "\0\1", 2);
        put(w, from, (size_t)(colons - from));
    } else {
        put_u32(w, (uint32_t)(end - from));
        put(w, from, (size_t)(end - from));
    }
    w->at = end + 1;
}

static void put_value(writer *w)
{
    char *end;
    const long long whole = strtoll(w->at, &end, 10);
    if (*w->at == '"') {
        put_text(w);
    } else if (end == w->at) { /* a letter */
        put(w, "C", 1);
        put(w, w->at, 1);
        w->at++;
    } else if (*end == '.' || *end == 'e') {
        const double real = strtod(w->at, &end);
        put(w, "D", 1);
        put_number(w, &real, sizeof real);
        w->at = end;
    } else {
        const int64_t wide = whole;
        const int32_t narrow = (int32_t)whole;
        put(w, narrow == wide ? "I" : "L", 1);
        put_number(w, narrow == wide ? (const void *)&narrow : (const void *)&wide, narrow == wide ? 4 : 8);
        w->at = end;
    }
}

/* The numbers of `*COUNT { a: ... }`. All that fit are 32-bit integers; slopes are floats. */
static void put_array(writer *w, int is_float)
{
    static uint8_t raw[1 << 16];
    writer inner = { strstr(w->at, "a:") + 2, w->form, raw, 0, sizeof raw };
    const char *end = strchr(w->at, '}');
    int is_real = 0, is_wide = 0;
    uint32_t count = 0;
    for (const char *c = inner.at; c < end; c++) is_real = is_real || *c == '.' || *c == 'e';
    for (const char *c = inner.at; c < end; c++) is_wide = is_wide || strspn(c, "0123456789") > 9;
    skip_blank(&inner);
    do {
        const double real = strtod(inner.at, NULL);
        const int64_t wide = strtoll(inner.at, NULL, 10);
        const int32_t narrow = (int32_t)wide;
        const float single = (float)real;
        if (is_float)
            put_number(&inner, &single, sizeof single);
        else if (is_real)
            put_number(&inner, &real, sizeof real);
        else if (is_wide)
            put_number(&inner, &wide, sizeof wide);
        else
            put_number(&inner, &narrow, sizeof narrow);
        inner.at += strspn(inner.at, "0123456789.eE+-");
        count++;
    } while (skip_comma(&inner));
    put(w, is_float ? "f" : is_real ? "d" : is_wide ? "l" : "i", 1);
    put_u32(w, count);
    put_u32(w, w->form->packed ? 1 : 0);
    int packed_count = 0;
    unsigned char *packed = w->form->packed ? stbi_zlib_compress(raw, (int)inner.count, &packed_count, 8) : NULL;
    put_u32(w, packed ? (uint32_t)packed_count : (uint32_t)inner.count);
    put(w, packed ? packed : raw, packed ? (size_t)packed_count : inner.count);
    free(packed);
    w->at = end + 1;
}

static uint64_t put_values(writer *w, int is_float)
{
    uint64_t count = 0;
    w->at += strspn(w->at, " \t");
    if (strchr("\n\r{", *w->at)) return 0;
    do {
        if (*w->at == '*')
            put_array(w, is_float);
        else
            put_value(w);
        count++;
    } while (skip_comma(w));
    return count;
}

/* ---- records ---- */

static void put_records(writer *w)
{
    for (skip_blank(w); *w->at && *w->at != '}'; skip_blank(w)) {
        const size_t begin = w->count, letters = strcspn(w->at, ":");
        const char *name = w->at;
        size_t values_begin, values_end, end;
        uint64_t values;
        put_header(w, 0, 0, 0);
        put(w, &(uint8_t){ (uint8_t)letters }, 1);
        put(w, name, letters);
        w->at += letters + 1;
        values_begin = w->count;
        values = put_values(w, strncmp(name, "KeyAttrDataFloat", letters) == 0);
        values_end = w->count;
        skip_blank(w);
        if (*w->at == '{') {
            w->at++;
            put_records(w);
            w->at++;
            put_header(w, 0, 0, 0);
            put(w, "", 1);
        }
        end = w->count;
        w->count = begin;
        put_header(w, end, values, values_end - values_begin);
        w->count = end;
    }
}

size_t fbx_binary_write(const char *text, const fbx_form *form, uint8_t *out, size_t capacity)
{
    writer w = { text, form, out, 0, capacity };
    put(&w, "Kaydara FBX Binary  \0\x1a", 22);
    put(&w, form->big_endian ? "\1" : "\0", 1);
    put_u32(&w, form->version);
    put_records(&w);
    put_header(&w, 0, 0, 0);
    put(&w, "", 1);
    return w.count;
}
