#include "markers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "convert/base/input_file.h"
#include "convert/model/model_build.h"
#include "raw_set.h"

#define BLOCK 512u

enum { INTEL = 84, DEC = 85, MIPS = 86 };
enum { TYPE_TEXT = -1, TYPE_INTEGER = 2, TYPE_FLOAT = 4 };

/* A parameter's values in the file. */
typedef struct parameter {
    const uint8_t *at;
    int type;              /* bytes of a value; TYPE_TEXT */
    uint32_t width, count; /* of a text and how many, or 1 and how many values */
} parameter;

typedef struct c3d_file {
    const uint8_t *bytes;
    size_t size;
    int processor;
    markers m;
    parameter labels, labels2, units, rate, scale, data_start, up;
    double unit; /* of integers; below 0: floats */
    size_t data, row_bytes, word_bytes;
    model_error *error;
} c3d_file;

static int refuse(c3d_file *c, size_t at, const char *what)
{
    char where[32];
    (void)snprintf(where, sizeof where, "byte %zu", at);
    return model_fail(c->error, where, "%s", what);
}

/* ---- numbers ---- */

static uint32_t word_at(const c3d_file *c, const uint8_t *at)
{
    return c->processor == MIPS ? (uint32_t)at[0] << 8 | at[1] : (uint32_t)at[1] << 8 | at[0];
}

static int integer_at(const c3d_file *c, const uint8_t *at)
{
    const int word = (int)word_at(c, at);
    return word < 0x8000 ? word : word - 0x10000;
}

/* DEC's floats have their halves the other way round, and an exponent that is larger by two. */
static double float_at(const c3d_file *c, const uint8_t *at)
{
    const uint32_t a = word_at(c, at), b = word_at(c, at + 2);
    const uint32_t bits = c->processor == INTEL ? b << 16 | a : a << 16 | b;
    float value;
    memcpy(&value, &bits, sizeof value);
    return c->processor == DEC ? (double)value / 4.0 : (double)value;
}

static double value_of(const c3d_file *c, const parameter *p, double none)
{
    if (!p->at || !p->count || p->type == TYPE_TEXT) return none;
    return p->type == TYPE_FLOAT ? float_at(c, p->at) : p->type == TYPE_INTEGER ? word_at(c, p->at) : *p->at;
}

/* ---- parameters ---- */

static int is_named(const uint8_t *name, size_t size, const char *wanted)
{
    if (strlen(wanted) != size) return 0;
    for (size_t i = 0; i < size; i++) {
        const int capital = name[i] >= 'a' && name[i] <= 'z' ? name[i] - 32 : name[i];
        if (capital != wanted[i]) return 0;
    }
    return 1;
}

static parameter *wanted_by(c3d_file *c, const uint8_t *name, size_t size)
{
    const struct {
        const char *name;
        parameter *to;
    } all[] = { { "LABELS", &c->labels }, { "LABELS2", &c->labels2 }, { "UNITS", &c->units },
                { "RATE", &c->rate },     { "SCALE", &c->scale },     { "DATA_START", &c->data_start },
                { "Y_SCREEN", &c->up } };
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        if (is_named(name, size, all[i].name)) return all[i].to;
    }
    return NULL;
}

/* Type, dimensions, values; NULL where they pass the end. */
static void read_parameter(const c3d_file *c, size_t at, parameter *out)
{
    const uint8_t *b = c->bytes + at;
    size_t count = 1, header, bytes;
    parameter p;
    if (at + 2u > c->size || at + 2u + b[1] > c->size) return;
    p.type = b[0] < 128 ? b[0] : b[0] - 256;
    header = 2u + b[1];
    p.width = p.type == TYPE_TEXT && b[1] ? b[2] : 1u;
    for (uint32_t i = p.type == TYPE_TEXT ? 1 : 0; i < b[1] && count < c->size; i++) count *= b[2 + i];
    bytes = count * (p.type == TYPE_TEXT ? p.width : (size_t)(p.type > 0 ? p.type : 1));
    if (bytes > c->size - at - header) return;
    p.at = b + header;
    p.count = (uint32_t)count;
    *out = p;
}

/* Records of a name and an offset to the next, of groups (below 0) and parameters; once for the group's number, and
 * once for its parameters, which may stand before it. */
static int read_group(c3d_file *c, size_t first, int group)
{
    size_t at = first;
    int found = 0;
    while (at + 2u < c->size && c->bytes[at]) {
        const size_t length = c->bytes[at] < 128 ? c->bytes[at] : 256u - c->bytes[at];
        const int id = c->bytes[at + 1] < 128 ? c->bytes[at + 1] : c->bytes[at + 1] - 256;
        const size_t next = at + 2u + length;
        parameter *to;
        if (next + 2u > c->size) break;
        if (!group && id < 0 && is_named(c->bytes + at + 2, length, "POINT")) found = -id;
        to = group && id == group ? wanted_by(c, c->bytes + at + 2, length) : NULL;
        if (to) read_parameter(c, next + 2u, to);
        if (!word_at(c, c->bytes + next)) break;
        at = next + word_at(c, c->bytes + next);
    }
    return found;
}

/* ---- the head ---- */

/* Of a text with blanks behind it; the usual one where it is unknown. */
static double unit_of(const parameter *p)
{
    double cm = 0.0;
    for (uint32_t n = p->type == TYPE_TEXT && p->count ? p->width : 0; n && !(cm > 0.0); n--) {
        cm = markers_unit_cm((const char *)p->at, n);
    }
    return cm > 0.0 ? cm : 0.1;
}

static int read_head(c3d_file *c, double unit_cm)
{
    const uint8_t *b = c->bytes;
    size_t parameters;
    uint32_t first, last;
    double start;
    if (c->size < BLOCK || b[1] != 0x50) return refuse(c, 0, "this is not a .c3d file");
    parameters = b[0] ? (b[0] - 1u) * BLOCK : BLOCK;
    if (parameters + 4u > c->size) return refuse(c, 0, "the file ends before its parameters");
    c->processor = b[parameters + 3];
    if (c->processor < INTEL || c->processor > MIPS) {
        return refuse(c, parameters + 3, "the processor is none of Intel, DEC and MIPS");
    }
    (void)read_group(c, parameters + 4u, read_group(c, parameters + 4u, 0));
    first = word_at(c, b + 6);
    last = word_at(c, b + 8);
    c->m.count = word_at(c, b + 2);
    c->m.frame_count = last >= first ? last - first + 1u : 0u;
    c->unit = value_of(c, &c->scale, float_at(c, b + 12));
    c->m.rate_hz = value_of(c, &c->rate, float_at(c, b + 20));
    start = value_of(c, &c->data_start, word_at(c, b + 16));
    c->data = start >= 1.0 && start < 65536.0 ? ((size_t)start - 1u) * BLOCK : c->size;
    c->word_bytes = c->unit < 0.0 ? 4 : 2;
    c->row_bytes = c->word_bytes * (4u * (size_t)c->m.count + word_at(c, b + 4));
    c->m.unit_cm = unit_cm > 0.0 ? unit_cm : unit_of(&c->units);
    return isfinite(c->unit) ? 0 : refuse(c, 12, "the scale is not finite");
}

/* A recording longer than 65,535 frames, or one that was cut off: as many as there are. */
static int count_frames(c3d_file *c)
{
    const size_t there = c->row_bytes && c->data < c->size ? (c->size - c->data) / c->row_bytes : 0;
    const int is_long = word_at(c, c->bytes + 8) == 0xffff;
    if (!is_long && there < c->m.frame_count) c->m.warning = model_string("the file ends before its last frame");
    if (is_long || there < c->m.frame_count) {
        c->m.frame_count = (uint32_t)(there < RAW_FRAMES_MAX ? there : RAW_FRAMES_MAX + 1u);
    }
    return markers_alloc(&c->m, c->error);
}

/* ---- markers ---- */

static int name_markers(c3d_file *c)
{
    for (uint32_t i = 0; i < c->m.count; i++) {
        const parameter *p = i < c->labels.count || !c->labels.at ? &c->labels : &c->labels2;
        const uint32_t at = p == &c->labels ? i : i - c->labels.count;
        char name[264];
        size_t n = 0;
        if (p->type == TYPE_TEXT && at < p->count) {
            for (n = p->width; n && strchr(" ", p->at[(size_t)at * p->width + n - 1u]);) n--;
            for (size_t k = 0; k < n; k++) {
                const uint8_t letter = p->at[(size_t)at * p->width + k];
                name[k] = letter < 0x20 || letter > 0x7e ? '_' : (char)letter;
            }
        }
        name[n] = '\0';
        if (!n) (void)snprintf(name, sizeof name, "marker_%u", (unsigned)i + 1u);
        c->m.names[i] = model_string(name);
        if (!c->m.names[i]) return refuse(c, 0, "out of memory");
    }
    return 0;
}

/* So that y is up. */
static void turn_up(char axis, int downwards, const double *p, float *to)
{
    const double s = downwards ? -1.0 : 1.0;
    const double ways[3][3] = { { -p[1], s * p[0], s * p[2] },
                                { p[0], s * p[1], s * p[2] },
                                { p[0], s * p[2], -s * p[1] } };
    for (int i = 0; i < 3; i++) to[i] = (float)ways[axis - 'X'][i];
}

static void read_place(const c3d_file *c, const uint8_t *at, char axis, int downwards, float *out)
{
    double place[3];
    int state;
    for (size_t i = 0; i < 3; i++) {
        place[i] = c->unit < 0.0 ? float_at(c, at + 4 * i) : c->unit * integer_at(c, at + 2 * i);
        if (!(fabs(place[i]) <= (double)NOH_NUMBER_MAX)) place[0] = NAN;
    }
    state = c->unit < 0.0 ? float_at(c, at + 12) < 0.0 : integer_at(c, at + 6) < 0;
    turn_up(axis, downwards, place, out);
    if (state || isnan(place[0])) out[0] = NAN;
}

static void read_frames(c3d_file *c)
{
    const int is_named = c->up.type == TYPE_TEXT && c->up.width > 1u && c->up.count;
    const char *up = is_named ? (const char *)c->up.at : "+Z";
    const char axis = up[1] == 'X' || up[1] == 'Y' ? up[1] : 'Z';
    if (!is_named && !c->m.warning) c->m.warning = model_string("POINT:Y_SCREEN is missing: z was taken as up");
    for (size_t f = 0; f < c->m.frame_count; f++) {
        for (size_t i = 0; i < c->m.count; i++) {
            read_place(c, c->bytes + c->data + f * c->row_bytes + 4u * i * c->word_bytes, axis, up[0] == '-',
                       c->m.places + 3 * (f * c->m.count + i));
        }
    }
}

int c3d_read(const char *path, double unit_cm, raw_set **out, model_error *error)
{
    c3d_file c = { 0 };
    char *bytes = input_read(path, &c.size, error);
    int failed = !bytes;
    *out = NULL;
    c.bytes = (const uint8_t *)bytes;
    c.error = error;
    failed = failed || read_head(&c, unit_cm) || count_frames(&c) || name_markers(&c);
    if (!failed) {
        read_frames(&c);
        failed = markers_set(&c.m, path, out, error);
    }
    markers_free(&c.m);
    free(bytes);
    return failed;
}
