#include "face_csv.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/byte_buffer.h"
#include "convert/base/input_file.h"
#include "convert/base/names.h"
#include "convert/base/text_scan.h"
#include "raw_set.h"

#define COLUMNS_MAX 256u
#define DAY_S 86400.0
#define GAP_S 0.1             /* without a row: worth a warning */
#define FRAMES_FREE 10000.0   /* what a file may become, whatever its rows; */
#define FRAMES_OF_A_ROW 100.0 /* and for each row, so that a wrong time does not cost minutes */

typedef enum time_kind { TIME_NONE, TIME_SECONDS, TIME_CODE } time_kind;

typedef struct row_time {
    double seconds, frame; /* frame: of a timecode, to be divided by its rate */
} row_time;

typedef struct face_csv {
    text_scan text;
    char separator;
    time_kind timing;
    uint32_t column_count, time_column, shape_count;
    int shape_of[COLUMNS_MAX]; /* -1: not read */
    char names[COLUMNS_MAX][NOH_NAME_BYTES_MAX];
    byte_buffer times, values; /* row_time, float[shape_count] of each row */
    uint32_t row_count;
    uint32_t unread_count, empty_count, damaged_count, damaged_line;
    char unread[TEXT_SHOWN]; /* the first column that is not read */
    double rate_hz, gap_s;
} face_csv;

static int out_of_memory(face_csv *f)
{
    return text_fail(&f->text, f->text.line, "out of memory");
}

/* ---- a line ---- */

/* The next field, without blanks and quotes around it. 0 at the end of the line. */
static int take_field(face_csv *f, text_word *out)
{
    return text_field(&f->text, f->separator, " \t\r\"", out);
}

/* ---- the first line ---- */

static int is_time(face_csv *f, text_word name, uint32_t column)
{
    static const char *const seconds[] = { "time", "timestamp", "seconds", "time_s" };
    time_kind kind = text_is(name, "timecode") ? TIME_CODE : TIME_NONE;
    for (int i = 0; i < 4; i++) kind = text_is(name, seconds[i]) ? TIME_SECONDS : kind;
    if (kind == TIME_NONE || f->timing != TIME_NONE) return kind != TIME_NONE;
    f->timing = kind;
    f->time_column = column;
    return 1;
}

static int has_shape(const face_csv *f, const char *name)
{
    for (uint32_t i = 0; i < f->shape_count; i++) {
        if (strcmp(f->names[i], name) == 0) return 1;
    }
    return 0;
}

static int add_column(face_csv *f, text_word field)
{
    char *name, *means = f->names[f->shape_count];
    const uint32_t column = f->column_count++;
    if (column == COLUMNS_MAX) return text_fail(&f->text, field.line, "more than %u columns", COLUMNS_MAX);
    f->shape_of[column] = -1;
    if (is_time(f, field, column) || text_is(field, "BlendShapeCount") || !field.size) return 0;
    name = text_copy(field);
    if (!name) return out_of_memory(f);
    if (names_find(NAME_TARGET, name, means, NULL) && !has_shape(f, means)) {
        f->shape_of[column] = (int)f->shape_count++;
    } else if (!f->unread_count++) {
        (void)text_show(field, f->unread);
    }
    free(name);
    return 0;
}

static int read_columns(face_csv *f)
{
    text_word field = { NULL, 0, 0 };
    const char *end;
    (void)text_next_line(&f->text);
    end = memchr(f->text.at, '\n', (size_t)(f->text.end - f->text.at));
    f->separator = memchr(f->text.at, ',', (size_t)((end ? end : f->text.end) - f->text.at)) ? ',' : ';';
    while (take_field(f, &field)) {
        if (add_column(f, field)) return 1;
    }
    if (!f->shape_count) {
        return text_fail(&f->text, 1,
                         "no column is named as a shape of ARKit, such as EyeBlinkLeft: this is no facial "
                         "capture (noh help FORMATS)");
    }
    return f->timing == TIME_NONE
               ? text_fail(&f->text, 1, "no column is named Timecode or Time: add one with the seconds of each row")
               : 0;
}

/* ---- rows ---- */

/* HOURS:MINUTES:SECONDS:FRAME, the frame with a fraction; ';' or '.' may stand before it. */
static int to_timecode(text_word word, row_time *out)
{
    double part[4] = { 0.0 };
    for (int i = 0; i < 4; i++) {
        text_word number = { word.text, 0, word.line };
        while (number.size < word.size && (i == 3 || !strchr(":;", word.text[number.size]))) number.size++;
        if (text_to_number(number, &part[i]) || part[i] < 0.0 || (i < 3 && number.size == word.size)) return 1;
        word.text += number.size + (i < 3);
        word.size -= number.size + (i < 3);
    }
    out->seconds = (part[0] * 60.0 + part[1]) * 60.0 + part[2];
    out->frame = part[3];
    return 0;
}

static int to_time(const face_csv *f, text_word word, row_time *out)
{
    out->frame = 0.0;
    return f->timing == TIME_CODE ? to_timecode(word, out) : text_to_number(word, &out->seconds);
}

static void damaged(face_csv *f, uint32_t line)
{
    if (!f->damaged_count++) f->damaged_line = line;
}

/* One row; a row without a face has a time and no weights. */
static int read_row(face_csv *f)
{
    row_time time = { 0.0, 0.0 };
    float values[COLUMNS_MAX] = { 0.0f };
    const uint32_t line = f->text.line;
    uint32_t column = 0, empty = 0, read = 0;
    int wrong = 0, has_time = 0;
    text_word field = { NULL, 0, 0 };
    for (; take_field(f, &field); column++) {
        const int shape = column < f->column_count ? f->shape_of[column] : -1;
        double value = 0.0;
        if (column == f->time_column) {
            has_time = !to_time(f, field, &time);
        } else if (shape >= 0 && !field.size) {
            empty++;
        } else if (shape >= 0) {
            wrong |= text_to_number(field, &value) || fabs(value) > (double)NOH_NUMBER_MAX;
            values[shape] = wrong ? 0.0f : (float)value;
            read++;
        }
    }
    if (has_time && !read && !wrong) {
        f->empty_count++;
        return 0;
    }
    if (!has_time || wrong || empty || read < f->shape_count) {
        damaged(f, line);
        return 0;
    }
    f->row_count++;
    return buffer_append(&f->times, &time, sizeof time) &&
                   buffer_append(&f->values, values, f->shape_count * sizeof *values)
               ? 0
               : out_of_memory(f);
}

static int read_rows(face_csv *f)
{
    while (text_next_line(&f->text)) {
        if (read_row(f)) return 1;
    }
    return f->row_count ? 0 : text_fail(&f->text, f->text.line, "no row has a time and a weight for each shape");
}

/* ---- time ---- */

static row_time *times_of(const face_csv *f)
{
    return (row_time *)(void *)f->times.bytes;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The usual rate above all frames of a timecode. */
static double rate_of_frames(const face_csv *f)
{
    static const double rates[] = { 24.0, 25.0, 30.0, 60.0, 100.0, 120.0, 240.0 };
    double most = 0.0;
    for (uint32_t i = 0; i < f->row_count; i++) most = fmax(most, times_of(f)[i].frame);
    for (size_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        if (most < rates[i]) return rates[i];
    }
    return floor(most) + 1.0;
}

/* The median step between rows, as a rate; a whole one if it is within a hundredth. */
static int rate_of_steps(face_csv *f)
{
    double *steps = malloc((f->row_count + 1u) * sizeof *steps), rate;
    if (!steps) return out_of_memory(f);
    for (uint32_t i = 1; i < f->row_count; i++) steps[i - 1] = times_of(f)[i].seconds - times_of(f)[i - 1].seconds;
    qsort(steps, f->row_count - 1u, sizeof *steps, by_size);
    rate = f->row_count > 1u ? 1.0 / steps[(f->row_count - 1u) / 2u] : 30.0;
    free(steps);
    f->rate_hz = fabs(rate - floor(rate + 0.5)) < 0.01 * rate && rate > 1.0 ? floor(rate + 0.5) : rate;
    return 0;
}

/* Rows at rising times: a timecode starts again at midnight, and of rows at one time the first stays. */
static int put_in_time(face_csv *f)
{
    float *values = (float *)(void *)f->values.bytes;
    double day = 0.0, last = 0.0;
    uint32_t kept = 0;
    if (f->timing == TIME_CODE) f->rate_hz = rate_of_frames(f);
    for (uint32_t i = 0; i < f->row_count; i++) {
        row_time *t = times_of(f);
        double seconds = t[i].seconds + day + (f->timing == TIME_CODE ? t[i].frame / f->rate_hz : 0.0);
        if (kept && f->timing == TIME_CODE && seconds < last - 0.5 * DAY_S) {
            day += DAY_S;
            seconds += DAY_S;
        }
        if (kept && !(seconds > last)) {
            damaged(f, 0);
            continue;
        }
        f->gap_s = kept ? fmax(f->gap_s, seconds - last) : 0.0;
        last = t[kept].seconds = seconds;
        memmove(values + (size_t)kept++ * f->shape_count, values + (size_t)i * f->shape_count,
                f->shape_count * sizeof *values);
    }
    f->row_count = kept;
    return f->timing == TIME_SECONDS ? rate_of_steps(f) : 0;
}

/* ---- frames ---- */

static void fill_frames(const face_csv *f, raw_clip *clip)
{
    const row_time *t = times_of(f);
    const float *values = (const float *)(const void *)f->values.bytes;
    uint32_t row = 0;
    for (uint32_t k = 0; k < clip->frame_count; k++) {
        const double at = t[0].seconds + (double)k / f->rate_hz;
        double part = 0.0;
        while (row + 2u < f->row_count && t[row + 1u].seconds <= at) row++;
        if (f->row_count > 1u) part = (at - t[row].seconds) / (t[row + 1u].seconds - t[row].seconds);
        part = fmin(fmax(part, 0.0), 1.0);
        for (uint32_t i = 0; i < f->shape_count; i++) {
            const float *a = values + (size_t)row * f->shape_count + i, *b = part > 0.0 ? a + f->shape_count : a;
            clip->floats[i].values[k] = (float)((double)*a + part * ((double)*b - (double)*a));
        }
    }
}

static int make_clip(face_csv *f, const char *path, raw_set *set)
{
    raw_clip *clip = set->clips;
    const double frames = floor((times_of(f)[f->row_count - 1u].seconds - times_of(f)[0].seconds) * f->rate_hz + 1.5);
    if (!(frames <= (double)RAW_FRAMES_MAX && frames * f->shape_count * sizeof(float) <= (double)RAW_BYTES_MAX)) {
        return text_fail(&f->text, f->text.line, "it lasts %.0f frames at %g Hz, and the limit is %u: cut it", frames,
                         f->rate_hz, RAW_FRAMES_MAX);
    }
    if (frames > FRAMES_FREE + FRAMES_OF_A_ROW * (double)f->row_count) {
        return text_fail(&f->text, f->text.line, "%u rows last %.0f frames at %g Hz: correct a wrong time, or cut it",
                         f->row_count, frames, f->rate_hz);
    }
    if (!(f->rate_hz >= 1e-3 && f->rate_hz <= 1e6)) {
        return text_fail(&f->text, 1, "%g rows a second: the times have to be in seconds", f->rate_hz);
    }
    set->skeleton.unit_cm = 100.0;
    clip->name = input_stem(path);
    clip->sample_rate_hz = f->rate_hz;
    clip->floats = model_zeros(f->shape_count, sizeof *clip->floats);
    if (!clip->name || !clip->floats || raw_clip_alloc(clip, (uint32_t)frames, 0)) return out_of_memory(f);
    for (uint32_t i = 0; i < f->shape_count; i++) {
        raw_floats *floats = &clip->floats[clip->float_count++];
        if (raw_floats_alloc(floats, clip->frame_count, 1)) return out_of_memory(f);
        floats->node = MODEL_NONE;
        floats->name = model_string(f->names[i]);
        if (!floats->name) return out_of_memory(f);
    }
    fill_frames(f, clip);
    return 0;
}

/* What was lost, in one sentence. */
static int set_warning(const face_csv *f, raw_set *set)
{
    byte_buffer text = { NULL, 0, 0, 0 };
    if (f->unread_count) {
        buffer_print(&text, "; column %s%s left out: no shape of ARKit has that name", f->unread,
                     f->unread_count > 1 ? " and others were" : " was");
    }
    if (f->damaged_count) {
        buffer_print(&text, "; %u rows were left out: a number is missing or damaged, or the time does not rise",
                     f->damaged_count);
        if (f->damaged_line) buffer_print(&text, " (line %u)", f->damaged_line);
    }
    if (f->empty_count || f->gap_s > fmax(GAP_S, 2.0 / f->rate_hz)) {
        buffer_print(&text, "; for up to %.2g s there is no face, and weights are interpolated", f->gap_s);
    }
    buffer_append(&text, "", 1);
    if (!text.failed && text.count > 1u) set->warning = model_string((const char *)text.bytes + 2);
    text.failed |= text.count > 1u && !set->warning;
    buffer_free(&text);
    return text.failed;
}

int face_csv_read(const char *path, raw_set **out, model_error *error)
{
    face_csv *f = calloc(1, sizeof *f);
    size_t size = 0;
    char *bytes = f ? input_read_text(path, &size, error) : NULL;
    int failed = !bytes;
    *out = NULL;
    if (!f) return model_fail_memory(error);
    if (!failed) {
        text_start(&f->text, bytes, size, error);
        failed = read_columns(f);
        for (size_t i = 0; f->separator == ';' && i < size; i++) { /* such files write 0,5 */
            if (bytes[i] == ',') bytes[i] = '.';
        }
        failed = failed || read_rows(f) || put_in_time(f);
        if (!failed && !(*out = raw_set_new(0, 1))) failed = out_of_memory(f);
        failed = failed || make_clip(f, path, *out) || (set_warning(f, *out) && out_of_memory(f));
    }
    if (failed) {
        raw_set_free(*out);
        *out = NULL;
    }
    buffer_free(&f->times);
    buffer_free(&f->values);
    free(f);
    free(bytes);
    return failed;
}
