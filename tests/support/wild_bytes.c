#include "wild_bytes.h"

#include <string.h>

const char *const wild_bytes_names[WILD_BYTES_COUNT] = { "c3d", "c3d of floats", "c3d of big-endian words",
                                                         "wav", "wav of floats", "osc" };

/* ---- seeds ---- */

typedef struct writer {
    uint8_t *to;
    size_t count;
    int big; /* endian */
} writer;

static void put(writer *w, const void *bytes, size_t count)
{
    memcpy(w->to + w->count, bytes, count);
    w->count += count;
}

static void put_number(writer *w, uint32_t value, int bytes)
{
    for (int i = 0; i < bytes; i++) w->to[w->count++] = (uint8_t)(value >> 8 * (w->big ? bytes - 1 - i : i));
}

static void put_float(writer *w, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_number(w, bits, 4);
}

static void put_zeros(writer *w, size_t until)
{
    while (w->count < until) w->to[w->count++] = 0;
}

/* A parameter of group 1: sizes has the dimensions, of a text also its letters; bytes: of the value and the length of
 * its description. */
static void put_parameter(writer *w, const char *name, int type, const char *sizes, const void *value, size_t bytes)
{
    const size_t dimensions = strlen(sizes);
    put_number(w, (uint32_t)strlen(name), 1);
    put_number(w, 1, 1);
    put(w, name, strlen(name));
    put_number(w, (uint32_t)(2u + 2u + dimensions + bytes), 2);
    put_number(w, (uint32_t)type, 1);
    put_number(w, (uint32_t)dimensions, 1);
    put(w, sizes, dimensions);
    if (value) put(w, value, bytes);
}

static void put_parameter_number(writer *w, const char *name, int type, float value)
{
    put_parameter(w, name, type, "", NULL, (size_t)type + 1u);
    if (type == 4) put_float(w, value);
    if (type == 2) put_number(w, (uint32_t)value, 2);
    put_number(w, 0, 1);
}

/* Three frames of two markers and one analogue channel; a marker is lost in the second. */
static void make_c3d(writer *w, int floats)
{
    static const uint32_t head[] = { 2, 1, 1, 3, 0 }; /* markers, analogue words, the first frame, the last, a gap */
    const float scale = floats ? -0.1f : 0.1f;
    put(w, "\x02\x50", 2);
    for (int i = 0; i < 5; i++) put_number(w, head[i], 2);
    put_float(w, scale);
    put_number(w, 4, 2);
    put_number(w, 1, 2);
    put_float(w, 50.0f);
    put_zeros(w, 512);
    put(w, w->big ? "\0\0\2\x56" : "\0\0\2\x54", 4);
    put_parameter(w, "UNITS", 255, "\2", "mm\0", 3);
    put_parameter(w, "LABELS", 255, "\4\2", "kneetoe \0", 9);
    put_parameter_number(w, "SCALE", 4, scale);
    put_parameter_number(w, "RATE", 4, 50.0f);
    put_parameter_number(w, "DATA_START", 2, 4.0f);
    put_parameter(w, "Y_SCREEN", 255, "\2", "+Z\0", 3);
    put(w, "\5\xffPOINT", 7);
    put_number(w, 3, 2);
    put_zeros(w, 1536);
    for (int i = 0; i < 27; i++) {
        const float value = i == 16 ? -1.0f : i % 9 == 3 || i % 9 == 7 ? 0.0f : (float)(i * 100);
        if (floats) put_float(w, value);
        if (!floats) put_number(w, (uint32_t)(int32_t)value, 2);
    }
}

/* A hundredth of a second of a tone of two channels. */
static void make_wav(writer *w, int floats)
{
    const uint32_t width = floats ? 4 : 2, frames = 160;
    put(w, "RIFF", 4);
    put_number(w, 36 + 2 * width * frames, 4);
    put(w, "WAVEfmt ", 8);
    put_number(w, 16, 4);
    put_number(w, floats ? 3 : 1, 2);
    put_number(w, 2, 2);
    put_number(w, 16000, 4);
    put_number(w, 32000 * width, 4);
    put_number(w, 2 * width, 2);
    put_number(w, 8 * width, 2);
    put(w, "data", 4);
    put_number(w, 2 * width * frames, 4);
    for (uint32_t i = 0; i < 2 * frames; i++) {
        const int32_t value = (int32_t)(i / 2 % 40) * 400 - 8000;
        if (floats) put_float(w, (float)value / 32768.0f);
        if (!floats) put_number(w, (uint32_t)value, 2);
    }
}

/* A bundle of a bone, an expression and a bundle of what applies it. */
static void make_osc(writer *w)
{
    static const float bone[7] = { 0, 1, 0, 0, 0, 0, 1 };
    put(w, "#bundle\0\0\0\0\0\0\0\0\1", 16);
    put_number(w, 68, 4);
    put(w, "/VMC/Ext/Bone/Pos\0\0\0,sfffffff\0\0\0Hips\0\0\0\0", 40);
    for (int i = 0; i < 7; i++) put_float(w, bone[i]);
    put_number(w, 32, 4);
    put(w, "/VMC/Ext/Blend/Val\0\0,sf\0Joy\0", 28);
    put_float(w, 0.5f);
    put_number(w, 48, 4);
    put(w, "#bundle\0\0\0\0\0\0\0\0\1", 16);
    put_number(w, 28, 4);
    put(w, "/VMC/Ext/Blend/Apply\0\0\0\0,\0\0\0", 28);
}

size_t wild_bytes_seed(int which, uint8_t *to)
{
    writer w = { to, 0, which == WILD_C3D_MIPS || which == WILD_OSC };
    if (which <= WILD_C3D_MIPS) make_c3d(&w, which == WILD_C3D_FLOATS);
    if (which == WILD_WAV || which == WILD_WAV_FLOATS) make_wav(&w, which == WILD_WAV_FLOATS);
    if (which == WILD_OSC) make_osc(&w);
    return w.count;
}

/* ---- edits ---- */

typedef struct draft {
    uint8_t *bytes;
    size_t count, room;
    uint32_t state;
} draft;

static uint32_t draw(draft *d, size_t below)
{
    d->state = d->state * 1664525u + 1013904223u; /* Knuth 3.3.4: the high bits are random */
    return (uint32_t)((uint64_t)(d->state >> 8) * below >> 24);
}

/* Of a byte that is not 0, or next to one: what is filled with zeros has nothing to edit. Mostly in the head. */
static size_t place(draft *d)
{
    const size_t all = draw(d, 3) || d->count < 64 ? d->count : 64;
    size_t at = draw(d, all);
    for (size_t i = 0; i < all && !d->bytes[at]; i++) at = (at + 1u) % all;
    return at;
}

static void wild_field(draft *d)
{
    static const uint32_t numbers[] = { 0,          1,          2,          3,          0x7f,       0x80,
                                        0xff,       0x100,      0x7fff,     0x8000,     0xffff,     0x10000,
                                        0x7fffffff, 0x80000000, 0xffffffff, 0xfffffffe, 0x40000000, 0x01000000,
                                        0x3f800000, 0xbf800000, 0x7f800000, 0xff800000, 0x7fc00000, 0x00000001,
                                        0x7f7fffff, 0x60ad78ec, 0x1e3ce508 };
    const uint32_t width = 1u << draw(d, 3), value = numbers[draw(d, sizeof numbers / sizeof *numbers)];
    const size_t at = place(d) / width * width;
    const int big = (int)draw(d, 2);
    if (at + width > d->count) return;
    for (uint32_t i = 0; i < width; i++) d->bytes[at + i] = (uint8_t)(value >> 8u * (big ? width - 1u - i : i));
}

static void copy_word(draft *d)
{
    const size_t from = draw(d, d->count) & ~(size_t)3, to = place(d) & ~(size_t)3;
    if (from + 4 <= d->count && to + 4 <= d->count) memmove(d->bytes + to, d->bytes + from, 4);
}

static void cut(draft *d)
{
    const size_t at = draw(d, d->count), most = d->count - at;
    const size_t count = draw(d, 4) ? 1u + draw(d, most < 16 ? most : 16) : most;
    if (count >= d->count) return;
    memmove(d->bytes + at, d->bytes + at + count, d->count - at - count);
    d->count -= count;
}

static void repeat(draft *d)
{
    const size_t at = draw(d, d->count), most = d->count - at;
    const size_t count = 1u + draw(d, draw(d, 4) && most > 64 ? 64 : most);
    if (count > most || d->count + count > d->room) return;
    memmove(d->bytes + at + count, d->bytes + at, d->count - at);
    d->count += count;
}

size_t wild_bytes(uint8_t *bytes, size_t count, size_t room, uint32_t seed)
{
    draft d = { bytes, count, room, seed * 2654435769u + 1u };
    for (uint32_t edits = 1u + draw(&d, 4); edits && d.count; edits--) {
        switch (draw(&d, 8)) {
        case 0: copy_word(&d); break;
        case 1: cut(&d); break;
        case 2: repeat(&d); break;
        default: wild_field(&d); break;
        }
    }
    return d.count;
}
