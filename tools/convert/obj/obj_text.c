#include "obj_internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/input_file.h"
#include "obj_polygon.h"

/* The state of reading. */
typedef struct reader {
    text_scan scan;
    obj_text *out;
    obj_part *part; /* that faces go to; NULL: none yet */
    char *material; /* for the next part; NULL: none */
    int positions_only;
    byte_buffer face, points, triangles; /* of one polygon: obj_corner, float [3], uint32_t [3] */
    uint64_t steps;                      /* left to cut polygons */
} reader;

uint32_t obj_position_count(const obj_text *o)
{
    return (uint32_t)(o->positions.count / (3 * sizeof(float)));
}

uint32_t obj_part_count(const obj_text *o)
{
    return (uint32_t)(o->parts.count / sizeof(obj_part));
}

const obj_part *obj_part_at(const obj_text *o, uint32_t i)
{
    return (const obj_part *)(const void *)o->parts.bytes + i;
}

void obj_text_free(obj_text *o)
{
    for (uint32_t i = 0; i < obj_part_count(o); i++) {
        obj_part *part = (obj_part *)(void *)o->parts.bytes + i;
        free(part->material);
        buffer_free(&part->corners);
    }
    buffer_free(&o->parts);
    buffer_free(&o->positions);
    buffer_free(&o->uvs);
    buffer_free(&o->normals);
    buffer_free(&o->colors);
    free(o->library);
    memset(o, 0, sizeof *o);
}

static int out_of_memory(reader *r)
{
    return model_fail_memory(r->scan.error);
}

/* ---- numbers ---- */

static int read_values(reader *r, uint32_t count, double *out)
{
    for (uint32_t i = 0; i < count; i++) {
        const text_word word = text_next_on_line(&r->scan);
        if (word.size == 0) {
            return text_fail(&r->scan, word.line, "%u numbers are needed here, and there are %u", count, i);
        }
        if (text_number(&r->scan, word, &out[i])) return 1;
        if (!(out[i] > -1e9 && out[i] < 1e9)) {
            return text_fail(&r->scan, word.line, "the number %g is too large", out[i]);
        }
    }
    return 0;
}

/* Three numbers of a line. */
static int read_vector(reader *r, byte_buffer *to)
{
    double values[3];
    float narrow[3];
    if (read_values(r, 3, values)) return 1;
    for (int k = 0; k < 3; k++) narrow[k] = (float)values[k];
    return buffer_append(to, narrow, sizeof narrow) ? 0 : out_of_memory(r);
}

/* OBJ counts v from the bottom of the picture, glTF from its top. Turned over before it is rounded, it is the number
 * that a glTF file of the same face has. */
static int read_uv(reader *r)
{
    double values[2];
    float uv[2];
    if (read_values(r, 2, values)) return 1;
    uv[0] = (float)values[0];
    uv[1] = (float)(1.0 - values[1]);
    return buffer_append(&r->out->uvs, uv, sizeof uv) ? 0 : out_of_memory(r);
}

/* A position; behind it three more numbers are a colour, and one a weight, which only curves need. */
static int read_position(reader *r)
{
    float color[3] = { 1.0f, 1.0f, 1.0f };
    double values[3];
    uint32_t count = 0;
    if (read_vector(r, &r->out->positions)) return 1;
    if (r->positions_only) return 0;
    for (; count < 3; count++) {
        const text_word word = text_next_on_line(&r->scan);
        if (word.size == 0) break;
        if (text_number(&r->scan, word, &values[count])) return 1;
    }
    for (uint32_t k = 0; k < 3 && count == 3; k++) {
        color[k] = values[k] < 0.0 ? 0.0f : values[k] > 1.0 ? 1.0f : (float)values[k];
        r->out->has_colors = 1;
    }
    return buffer_append(&r->out->colors, color, sizeof color) ? 0 : out_of_memory(r);
}

/* ---- faces ---- */

/* One number of a corner: from 1, or from the end where it is negative. */
static int read_place(reader *r, text_word word, size_t count, const char *what, uint32_t *out)
{
    const int negative = word.size > 0 && word.text[0] == '-';
    uint32_t number;
    if (negative) {
        word.text++;
        word.size--;
    }
    if (text_count(&r->scan, word, 0x7fffffffu, &number)) return 1;
    if (number == 0 || number > count) {
        return text_fail(&r->scan, word.line, "%s %s%u does not exist: the file has %zu before this line", what,
                         negative ? "-" : "", number, count);
    }
    *out = negative ? (uint32_t)count - number : number - 1u;
    return 0;
}

/* Up to the next slash; `word` becomes what follows it. */
static text_word cut_at_slash(text_word *word)
{
    text_word first = *word;
    const char *slash = memchr(word->text, '/', word->size);
    if (slash) first.size = (size_t)(slash - word->text);
    word->text += first.size + (slash ? 1u : 0u);
    word->size -= first.size + (slash ? 1u : 0u);
    return first;
}

/* Whether the line of a number was left out. */
static int is_unread(const byte_buffer *numbers, size_t at)
{
    return isnan(((const float *)(const void *)numbers->bytes)[at]);
}

/* position, position/uv, position//normal or position/uv/normal */
static int read_corner(reader *r, text_word word, obj_corner *out)
{
    const obj_text *o = r->out;
    const text_word position = cut_at_slash(&word), uv = cut_at_slash(&word), normal = cut_at_slash(&word);
    char shown[TEXT_SHOWN];
    out->uv = out->normal = MODEL_NONE;
    if (word.size > 0) {
        return text_fail(&r->scan, position.line, "'%s' is one number too many in a corner", text_show(word, shown));
    }
    if (read_place(r, position, o->positions.count / 12u, "position", &out->position) ||
        (uv.size > 0 && read_place(r, uv, o->uvs.count / 8u, "UV", &out->uv)) ||
        (normal.size > 0 && read_place(r, normal, o->normals.count / 12u, "normal", &out->normal)))
        return 1;
    if (is_unread(&o->positions, 3u * out->position))
        return text_fail(&r->scan, position.line, "position %u could not be read", out->position + 1u);
    if (out->uv != MODEL_NONE && is_unread(&o->uvs, 2u * out->uv)) out->uv = MODEL_NONE;
    if (out->normal != MODEL_NONE && is_unread(&o->normals, 3u * out->normal)) out->normal = MODEL_NONE;
    return 0;
}

static int same_name(const char *a, const char *b)
{
    return a == b || (a && b && strcmp(a, b) == 0);
}

/* The part of the material that was named last; the same again where a material comes back. */
static int find_part(reader *r)
{
    const obj_part empty = { NULL, { NULL, 0, 0, 0 } };
    for (uint32_t i = 0; i < obj_part_count(r->out); i++) {
        obj_part *part = (obj_part *)(void *)r->out->parts.bytes + i;
        if (same_name(part->material, r->material)) {
            r->part = part;
            return 0;
        }
    }
    if (obj_part_count(r->out) >= 4096u) {
        return text_fail(&r->scan, r->scan.line, "the file has more than 4096 materials, which is the limit");
    }
    r->part = buffer_append(&r->out->parts, &empty, sizeof empty);
    if (!r->part) return out_of_memory(r);
    r->part->material = r->material ? model_string(r->material) : NULL;
    return r->material && !r->part->material ? out_of_memory(r) : 0;
}

static int add_triangles(reader *r, uint32_t count, uint32_t line)
{
    const obj_corner *corners = (const obj_corner *)(const void *)r->face.bytes;
    const size_t words = 3u * ((size_t)count - 2u);
    const uint32_t *place;
    int failed;
    r->triangles.count = 0;
    if (!buffer_append(&r->triangles, NULL, words * sizeof *place)) return out_of_memory(r);
    failed = obj_polygon_cut((const float *)(const void *)r->points.bytes, count,
                             (uint32_t *)(void *)r->triangles.bytes, &r->steps);
    if (failed == 2) {
        return text_fail(&r->scan, line,
                         "the concave faces up to this one, which has %u corners, take too long to cut into triangles: "
                         "triangulate them",
                         count);
    }
    if (!failed && !r->part && find_part(r)) return 1;
    place = (const uint32_t *)(const void *)r->triangles.bytes;
    for (size_t i = 0; i < words && !failed; i++) {
        failed = !buffer_append(&r->part->corners, &corners[place[i]], sizeof *corners);
    }
    return failed ? out_of_memory(r) : 0;
}

static int read_face(reader *r)
{
    uint32_t count = 0;
    const uint32_t line = r->scan.line;
    r->face.count = r->points.count = 0;
    for (;; count++) {
        const text_word word = text_next_on_line(&r->scan);
        obj_corner corner;
        if (word.size == 0) break;
        if (read_corner(r, word, &corner)) return 1;
        if (!buffer_append(&r->face, &corner, sizeof corner) ||
            !buffer_append(&r->points, r->out->positions.bytes + 12 * (size_t)corner.position, 12)) {
            return out_of_memory(r);
        }
    }
    if (count < 3) {
        return text_fail(&r->scan, line, "a face needs at least three corners, and this one has %u", count);
    }
    return add_triangles(r, count, line);
}

static int read_name(reader *r, char **out)
{
    const text_word name = text_rest_of_line(&r->scan);
    free(*out);
    *out = name.size > 0 ? text_copy(name) : NULL;
    return name.size > 0 && !*out ? out_of_memory(r) : 0;
}

static int is_ignored(text_word keyword)
{
    static const char *const silent[] = { "g",   "o",      "s",      "vp",         "mg",
                                          "lod", "usemap", "maplib", "shadow_obj", "trace_obj" };
    if (keyword.text[0] == '#') return 1;
    for (size_t i = 0; i < sizeof silent / sizeof silent[0]; i++) {
        if (text_is(keyword, silent[i])) return 1;
    }
    return 0;
}

/* Points, lines, curves: one warning, with the first line. */
static int leave_out(reader *r, text_word keyword)
{
    static const char *const known[] = { "p",     "l",        "cstype",   "deg",   "bmat",  "step", "curv", "curv2",
                                         "surf",  "parm",     "trim",     "hole",  "scrv",  "sp",   "end",  "con",
                                         "bevel", "c_interp", "d_interp", "ctech", "stech", "call", "csh" };
    char shown[TEXT_SHOWN];
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        if (!text_is(keyword, known[i])) continue;
        if (!r->out->left_out) {
            r->out->left_out = known[i];
            r->out->left_out_line = keyword.line;
        }
        r->out->left_out_count++;
        return 0;
    }
    return text_fail(&r->scan, keyword.line, "an OBJ file has no line '%s'", text_show(keyword, shown));
}

static int read_line(reader *r, text_word keyword)
{
    if (text_is(keyword, "v")) return read_position(r);
    if (r->positions_only) return 0;
    if (text_is(keyword, "vt")) return read_uv(r);
    if (text_is(keyword, "vn")) return read_vector(r, &r->out->normals);
    if (text_is(keyword, "f")) return read_face(r);
    if (text_is(keyword, "mtllib")) return r->out->library ? 0 : read_name(r, &r->out->library);
    if (text_is(keyword, "usemtl")) {
        r->part = NULL;
        return read_name(r, &r->material);
    }
    return is_ignored(keyword) ? 0 : leave_out(r, keyword);
}

/* A line that cannot be read is left out; a number of a position that cannot be read is NaN, and others keep their
 * numbers. */
static int try_line(reader *r, text_word keyword)
{
    static const float unread[3] = { NAN, NAN, NAN }, white[3] = { 1.0f, 1.0f, 1.0f };
    obj_text *o = r->out;
    model_error *error = r->scan.error;
    const size_t positions = o->positions.count, colors = o->colors.count;
    int kept = 1;
    if (!read_line(r, keyword)) return 0;
    if (!error->where[0] || r->positions_only) return 1; /* where: "" if out of memory */
    if (!o->bad_line_count++) o->bad_line = *error;
    error->what[0] = error->where[0] = '\0';
    if (text_is(keyword, "v")) { /* of one whose colour alone is wrong the position stays */
        kept = (o->positions.count > positions || buffer_append(&o->positions, unread, sizeof unread)) &&
               (o->colors.count > colors || buffer_append(&o->colors, white, sizeof white));
    } else if (text_is(keyword, "vt")) {
        kept = buffer_append(&o->uvs, unread, 2 * sizeof *unread) != NULL;
    } else if (text_is(keyword, "vn")) {
        kept = buffer_append(&o->normals, unread, sizeof unread) != NULL;
    }
    return kept ? 0 : out_of_memory(r);
}

static void skip_rest(text_scan *s)
{
    (void)text_rest_of_line(s);
}

static int read_lines(reader *r)
{
    while (text_next_line(&r->scan)) {
        const text_word keyword = text_next_on_line(&r->scan);
        if (try_line(r, keyword)) return 1;
        skip_rest(&r->scan);
    }
    return 0;
}

/* A backslash at the end of a line joins the next one to it. */
static void join_lines(char *text, size_t size)
{
    for (size_t i = 0; i + 1 < size; i++) {
        const size_t end = text[i + 1] == '\r' && i + 2 < size ? i + 2 : i + 1;
        if (text[i] == '\\' && text[end] == '\n') text[i] = text[end] = ' ';
    }
}

int obj_text_read(const char *path, int positions_only, obj_text *out, model_error *error)
{
    size_t bytes = 0;
    char *text = input_read_text(path, &bytes, error);
    reader r = { .out = out, .positions_only = positions_only, .steps = OBJ_CUT_STEPS };
    int failed;
    memset(out, 0, sizeof *out);
    if (!text) return 1;
    join_lines(text, bytes);
    text_start(&r.scan, text, bytes, error);
    failed = read_lines(&r);
    if (!failed && (obj_position_count(out) == 0 || (!positions_only && obj_part_count(out) == 0))) {
        failed = model_fail(error, "", "%s",
                            obj_position_count(out) ? "it has no face ('f A B C'), and so nothing to convert"
                                                    : "it has no position ('v X Y Z'), and may not be an OBJ file");
        if (out->bad_line_count) *error = out->bad_line;
    }
    free(r.material);
    buffer_free(&r.face);
    buffer_free(&r.points);
    buffer_free(&r.triangles);
    free(text);
    return failed;
}
