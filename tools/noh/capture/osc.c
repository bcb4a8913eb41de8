#include "osc.h"

#include <math.h>
#include <string.h>

#define BUNDLE_BYTES 16u /* "#bundle" and its time, which is not used: all is for now */
#define NUMBER_MAX 1e6

void osc_begin(osc_reader *r, const uint8_t *bytes, size_t count)
{
    memset(r, 0, sizeof *r);
    r->bytes = bytes;
    r->ends[0] = count;
}

static uint64_t big_endian(const uint8_t *b, size_t bytes)
{
    uint64_t n = 0;
    for (size_t i = 0; i < bytes; i++) n = n << 8 | b[i];
    return n;
}

/* A text up to its zero, and padded to four bytes. NULL: it does not end before `end`. */
static const char *take_text(const uint8_t *bytes, size_t *at, size_t end)
{
    const uint8_t *zero = *at < end ? memchr(bytes + *at, 0, end - *at) : NULL;
    const char *text = (const char *)bytes + *at;
    size_t size;
    if (!zero) return NULL;
    size = ((size_t)(zero - (bytes + *at)) + 4u) & ~(size_t)3u;
    if (size > end - *at) return NULL;
    *at += size;
    return text;
}

static double number_of(char type, const uint8_t *b)
{
    const uint32_t bits = (uint32_t)big_endian(b, 4);
    const uint64_t wide = type == 'h' || type == 'd' ? big_endian(b, 8) : 0;
    float single;
    double full;
    memcpy(&single, &bits, sizeof single);
    memcpy(&full, &wide, sizeof full);
    switch (type) {
    case 'f': return (double)single;
    case 'd': return full;
    case 'h': return (double)(int64_t)wide;
    default: return (double)(int32_t)bits;
    }
}

/* An argument of a type. 0: it does not fit, or the type is none of OSC. */
static int take_value(char type, const uint8_t *bytes, size_t *at, size_t end, osc_value *out)
{
    const size_t left = end - *at, size = type == 'h' || type == 'd' || type == 't' ? 8u : 4u;
    memset(out, 0, sizeof *out);
    if (strchr("TFNI[]", type)) {
        out->type = type == 'T' || type == 'F' ? 'f' : 0;
        out->number = type == 'T';
        return 1;
    }
    if (type == 's' || type == 'S') {
        out->type = 's';
        out->text = take_text(bytes, at, end);
        return out->text != NULL;
    }
    if (!strchr("ifhdtcrmb", type) || left < size) return 0;
    if (type == 'b') {
        const uint64_t padded = (big_endian(bytes + *at, 4) + 3u) & ~(uint64_t)3u;
        if (padded > left - 4u) return 0;
        *at += 4u + (size_t)padded;
        return 1;
    }
    out->type = strchr("ifhd", type) ? 'f' : 0;
    if (out->type) out->number = number_of(type, bytes + *at);
    *at += size;
    return 1;
}

static osc_kind take_message(const uint8_t *bytes, size_t at, size_t end, osc_message *out)
{
    const char *types;
    out->count = 0;
    out->address = take_text(bytes, &at, end);
    if (!out->address || out->address[0] != '/') return OSC_DAMAGED;
    if (at == end) return OSC_MESSAGE; /* old senders leave the types out where there are no arguments */
    types = take_text(bytes, &at, end);
    if (!types || *types++ != ',') return OSC_DAMAGED;
    for (; *types; types++) {
        osc_value value;
        if (!take_value(*types, bytes, &at, end, &value)) return OSC_DAMAGED;
        if (out->count < OSC_VALUES_MAX) out->values[out->count++] = value;
    }
    return OSC_MESSAGE;
}

static int is_bundle(const osc_reader *r, size_t end)
{
    return end - r->at >= BUNDLE_BYTES && memcmp(r->bytes + r->at, "#bundle", 8) == 0;
}

/* What lies from here to `end`: a message, or a bundle, which is opened. */
static osc_kind take_element(osc_reader *r, size_t end, osc_message *out, int *opened)
{
    osc_kind kind;
    *opened = is_bundle(r, end) && r->depth + 1u < OSC_DEPTH_MAX;
    if (*opened) {
        r->at += BUNDLE_BYTES;
        r->ends[++r->depth] = end;
        return OSC_END;
    }
    kind = take_message(r->bytes, r->at, end, out);
    r->at = end;
    return kind;
}

osc_kind osc_next(osc_reader *r, osc_message *out)
{
    int opened;
    for (;;) {
        const size_t end = r->ends[r->depth];
        osc_kind kind;
        uint64_t size;
        if (r->at >= end) {
            if (!r->depth) return OSC_END;
            r->depth--;
            continue;
        }
        if (!r->depth) {
            kind = take_element(r, end, out, &opened);
        } else {
            size = end - r->at > 4u ? big_endian(r->bytes + r->at, 4) : 0;
            if (!size || size > end - r->at - 4u) { /* the rest of this bundle is lost */
                r->at = end;
                return OSC_DAMAGED;
            }
            r->at += 4u;
            kind = take_element(r, r->at + (size_t)size, out, &opened);
        }
        if (!opened) return kind;
    }
}

int osc_text(const osc_message *m, uint32_t first, const char **out)
{
    const int found = first < m->count && m->values[first].type == 's';
    if (found) *out = m->values[first].text;
    return found;
}

int osc_numbers(const osc_message *m, uint32_t first, uint32_t count, float *out)
{
    for (uint32_t i = 0; i < count; i++) {
        const osc_value *v = &m->values[first + i];
        if (first + i >= m->count || v->type != 'f' || !(fabs(v->number) <= NUMBER_MAX)) return 0;
        out[i] = (float)v->number;
    }
    return 1;
}
