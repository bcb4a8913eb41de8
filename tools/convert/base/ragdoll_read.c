#include "ragdoll_read.h"

#include <stdlib.h>
#include <string.h>

#include "convert/base/input_file.h"
#include "convert/base/text_scan.h"

#define FRICTION_MAX 10000.0
#define ROW "JOINT [hinge] [forward|backward|upward] [bend MIN MAX] [side ANGLE] [twist ANGLE] [friction NM]"

/* A number within its range. what: for the message */
static int read_number(text_scan *s, const char *what, double low, double high, double *value)
{
    const text_word word = text_next_on_line(s);
    char shown[TEXT_SHOWN];
    if (!word.size) return text_fail(s, s->line, "%s: the number is missing", what);
    if (text_number(s, word, value)) return 1;
    if (*value >= low && *value <= high) return 0;
    return text_fail(s, word.line, "%s: %s must be %g to %g", what, text_show(word, shown), low, high);
}

/* Degrees, as radians; 180 is no more than half a turn in floats. */
static int read_angle(text_scan *s, const char *what, double low, double high, float *angle)
{
    double degrees = 0.0;
    if (read_number(s, what, low, high, &degrees)) return 1;
    *angle = (float)(degrees * (3.1415925 / 180.0));
    return 0;
}

static int read_toward(text_word word, uint32_t *toward)
{
    static const char *const names[] = { "forward", "backward", "upward" };
    for (uint32_t i = 0; i < 3; i++) {
        if (!text_is(word, names[i])) continue;
        *toward = i;
        return 1;
    }
    return 0;
}

static int read_setting(text_scan *s, text_word word, ragdoll_line *row)
{
    char shown[TEXT_SHOWN];
    double friction = 0.0;
    if (text_is(word, "hinge")) {
        row->hinge = 1;
        return 0;
    }
    if (read_toward(word, &row->toward)) return 0;
    if (text_is(word, "bend")) {
        return read_angle(s, "bend, the least angle", -180.0, 0.0, &row->bend_min) ||
               read_angle(s, "bend, the largest angle", 0.0, 180.0, &row->bend_max);
    }
    if (text_is(word, "side")) return read_angle(s, "side", 0.0, 180.0, &row->side);
    if (text_is(word, "twist")) return read_angle(s, "twist", 0.0, 180.0, &row->twist);
    if (text_is(word, "friction")) {
        if (read_number(s, "friction", 0.0, FRICTION_MAX, &friction)) return 1;
        row->friction = (float)friction;
        return 0;
    }
    return text_fail(s, word.line, "a body has no setting '%s': a row is " ROW, text_show(word, shown));
}

/* Settings that a hinge cannot have are errors, not ignored. */
static int check_row(text_scan *s, const ragdoll_text *ragdoll, const ragdoll_line *row)
{
    for (uint32_t i = 0; i < ragdoll->count; i++) {
        if (strcmp(ragdoll->rows[i].joint, row->joint) == 0) {
            return text_fail(s, row->line, "this joint is given twice; the first row is in line %u",
                             ragdoll->rows[i].line);
        }
    }
    if (row->hinge && (row->side > 0.0f || row->twist > 0.0f)) {
        return text_fail(s, row->line, "a hinge only bends: remove side and twist");
    }
    return 0;
}

static int read_line(text_scan *s, ragdoll_text *ragdoll)
{
    ragdoll_line row;
    text_word word;
    int failed = text_take_on_line(s, &word);
    if (failed || !word.size) return failed; /* a comment */
    if (ragdoll->count == NOH_RAGDOLL_BODIES_MAX) {
        return text_fail(s, word.line, "too many bodies: the limit is %u", NOH_RAGDOLL_BODIES_MAX);
    }
    if (word.size >= NOH_NAME_BYTES_MAX) {
        return text_fail(s, word.line, "the joint's name is longer than %u bytes", NOH_NAME_BYTES_MAX - 1u);
    }
    memset(&row, 0, sizeof row);
    row.line = word.line;
    row.joint = text_copy(word);
    if (!row.joint) return text_fail(s, row.line, "out of memory");
    for (failed = text_take_on_line(s, &word); !failed && word.size; failed = failed || text_take_on_line(s, &word)) {
        failed = read_setting(s, word, &row);
    }
    failed = failed || check_row(s, ragdoll, &row);
    if (failed) {
        free(row.joint);
        return 1;
    }
    ragdoll->rows[ragdoll->count++] = row;
    return 0;
}

int ragdoll_read(const char *path, ragdoll_text **out, uint32_t *line, model_error *error)
{
    text_scan s;
    size_t size = 0;
    char *text = input_read_text(path, &size, error);
    int failed = 0;
    *out = text ? calloc(1, sizeof **out) : NULL;
    if (!*out) {
        free(text);
        return 1;
    }
    text_start(&s, text, size, error);
    while (!failed && text_next_line(&s)) {
        *line = s.line;
        failed = read_line(&s, *out);
    }
    if (!failed && !(*out)->count) {
        *line = 1;
        failed = text_fail(&s, 1, "the ragdoll has no body: add a row " ROW);
    }
    if (failed) error->where[0] = 0; /* *line has the line */
    free(text);
    return failed;
}

void ragdoll_free(ragdoll_text *ragdoll)
{
    for (uint32_t i = 0; ragdoll && i < ragdoll->count; i++) free(ragdoll->rows[i].joint);
    free(ragdoll);
}
