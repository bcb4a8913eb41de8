#include "markers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/byte_buffer.h"
#include "convert/base/input_file.h"
#include "convert/base/text_scan.h"
#include "convert/model/model_build.h"
#include "raw_set.h"

typedef struct trc_file {
    text_scan text;
    markers m;
    uint32_t columns; /* of the line of names */
    byte_buffer rows; /* float[count][3] of each frame */
    uint32_t damaged, damaged_line;
} trc_file;

/* The next field, up to a tab. */
static int take_field(text_scan *s, text_word *out)
{
    return text_field(s, '\t', " \r", out);
}

/* To the beginning of the next line. 0 at the end of the text. */
static int next_line(text_scan *s)
{
    while (s->at < s->end && *s->at != '\n') s->at++;
    if (s->at == s->end) return 0;
    s->at++;
    s->line++;
    return s->at < s->end;
}

/* ---- the head ---- */

/* The line of words, and the line of values below them. */
static int read_settings(trc_file *f, double unit_cm)
{
    text_scan names = f->text, *values = &f->text;
    text_word name = { NULL, 0, 0 }, value = { NULL, 0, 0 };
    if (!next_line(values)) return text_fail(values, values->line, "the file ends in its head");
    while (take_field(&names, &name) && take_field(values, &value)) {
        if (text_is(name, "DataRate") && text_number(values, value, &f->m.rate_hz)) return 1;
        if (text_is(name, "Units")) f->m.unit_cm = markers_unit_cm(value.text, value.size);
    }
    if (unit_cm > 0.0) f->m.unit_cm = unit_cm;
    if (!(f->m.unit_cm > 0.0)) {
        return text_fail(values, values->line, "Units is none of mm, cm, m and in: give --unit-cm");
    }
    return next_line(values) ? 0 : text_fail(values, values->line, "the file ends before the names of markers");
}

/* "Frame#", "Time", and a name above the first of three columns. */
static int read_names(trc_file *f, byte_buffer *names)
{
    text_word field = { NULL, 0, 0 };
    const uint32_t line = f->text.line;
    for (f->columns = 0; take_field(&f->text, &field); f->columns++) {
        char *name;
        if (f->columns < 2 || !field.size) continue;
        name = text_copy(field);
        if (!name || !buffer_append(names, &name, sizeof name)) {
            free(name);
            return text_fail(&f->text, line, "out of memory");
        }
        f->m.count++;
    }
    return f->m.count ? 0 : text_fail(&f->text, line, "no names of markers stand behind Frame# and Time");
}

static int read_head(trc_file *f, double unit_cm, byte_buffer *names)
{
    text_word word = { NULL, 0, 0 };
    if (!take_field(&f->text, &word) || !text_is(word, "PathFileType") || !next_line(&f->text)) {
        return text_fail(&f->text, 1, "this is not a .trc file: it does not start with PathFileType");
    }
    if (read_settings(f, unit_cm) || read_names(f, names)) return 1;
    (void)next_line(&f->text); /* X1 Y1 Z1 ... */
    return next_line(&f->text) ? 0 : text_fail(&f->text, f->text.line, "the file has no frames");
}

/* ---- frames ---- */

/* A marker without three numbers was not seen. */
static int read_row(trc_file *f)
{
    text_word field = { NULL, 0, 0 };
    float *row = buffer_append(&f->rows, NULL, 3 * sizeof *row * f->m.count);
    if (!row) return text_fail(&f->text, f->text.line, "out of memory");
    for (size_t i = 0; i < 3 * (size_t)f->m.count; i++) row[i] = NAN;
    for (uint32_t column = 0; take_field(&f->text, &field); column++) {
        const size_t at = column - 2u;
        double value;
        if (column < 2 || at >= 3 * (size_t)f->m.count || !field.size) continue;
        if (!text_to_number(field, &value) && fabs(value) <= (double)NOH_NUMBER_MAX) {
            row[at] = (float)value;
        } else if (!f->damaged++) {
            f->damaged_line = field.line;
        }
    }
    for (size_t i = 0; i < f->m.count; i++) {
        if (!isfinite(row[3 * i + 1]) || !isfinite(row[3 * i + 2])) row[3 * i] = NAN;
    }
    f->m.frame_count++;
    return 0;
}

static int is_blank_line(const text_scan *s)
{
    const char *at = s->at;
    while (at < s->end && strchr(" \t\r", *at)) at++;
    return at == s->end || *at == '\n';
}

static int read_rows(trc_file *f)
{
    do {
        if (!is_blank_line(&f->text) && read_row(f)) return 1;
        if ((uint64_t)f->rows.count > RAW_BYTES_MAX) break;
    } while (next_line(&f->text));
    return 0;
}

static int fill(trc_file *f, const byte_buffer *names, model_error *error)
{
    char text[96];
    if (markers_alloc(&f->m, error)) return 1;
    memcpy(f->m.names, names->bytes, names->count);
    memcpy(f->m.places, f->rows.bytes, f->rows.count);
    if (!f->damaged) return 0;
    (void)snprintf(text, sizeof text, "%u fields are not numbers (line %u)", f->damaged, f->damaged_line);
    f->m.warning = model_string(text);
    return f->m.warning ? 0 : model_fail_memory(error);
}

int trc_read(const char *path, double unit_cm, raw_set **out, model_error *error)
{
    trc_file f = { 0 };
    byte_buffer names = { NULL, 0, 0, 0 };
    size_t size = 0;
    char *bytes = input_read_text(path, &size, error);
    int failed = !bytes, taken = 0;
    *out = NULL;
    if (!failed) {
        text_start(&f.text, bytes, size, error);
        failed = read_head(&f, unit_cm, &names) || read_rows(&f) || fill(&f, &names, error);
        taken = !failed;
        failed = failed || markers_set(&f.m, path, out, error);
    }
    for (size_t i = 0; !taken && i < names.count / sizeof(char *); i++) {
        free(((char **)(void *)names.bytes)[i]);
        if (f.m.names) f.m.names[i] = NULL;
    }
    markers_free(&f.m);
    buffer_free(&names);
    buffer_free(&f.rows);
    free(bytes);
    return failed;
}
