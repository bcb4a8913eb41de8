#include "hair_read.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/input_file.h"
#include "convert/base/text_scan.h"
#include "noh/base.h"

/* A setting: its numbers, their range and defaults. */
typedef struct setting {
    const char *name;
    size_t at;
    uint32_t count;
    double low, high;
    float initial[6];
} setting;

#define AT(member) offsetof(hair_text, member)

static const setting settings[] = {
    { "skull", AT(skull), 6, -100.0, 100.0, { 0 } },
    { "hairline", AT(hairline), 3, 5.0, 175.0, { 40.0f, 80.0f, 110.0f } },
    { "comb", AT(comb), 3, -1.0, 1.0, { 0.0f, -0.5f, -0.85f } },
    { "length", AT(length), 2, 0.01, 10.0, { 0.3f, 0.3f } },
    { "lift", AT(lift), 1, 0.0, 1.0, { 0.012f } },
    { "around", AT(around), 1, 3.0, NOH_HAIRS_MAX, { 20.0f } },
    { "rows", AT(rows), 1, 2.0, 32.0, { 4.0f } },
    { "points", AT(points), 1, 2.0, NOH_HAIR_POINTS_MAX, { 14.0f } },
    { "strips", AT(strips), 1, 1.0, NOH_HAIR_STRIPS_MAX, { 2000.0f } },
    { "segments", AT(segments), 1, 1.0, NOH_HAIR_SEGMENTS_MAX, { 24.0f } },
    { "seed", AT(seed), 1, 0.0, 16777215.0, { 1.0f } },
    { "width", AT(width), 2, 1e-5, 1.0, { 0.004f, 0.003f } },
    { "curl", AT(curl), 2, 0.0, 100.0, { 0.0f, 0.0f } },
    { "scatter", AT(scatter), 1, 0.0, 1.0, { 0.006f } },
    { "root", AT(root), 3, 0.0, 1.0, { 0.12f, 0.10f, 0.10f } },
    { "tip", AT(tip), 3, 0.0, 1.0, { 0.17f, 0.14f, 0.13f } },
    { "gloss", AT(gloss), 1, 0.0, 4.0, { 1.0f } },
    { "pull", AT(pull), 2, 0.0, 1.0, { 0.05f, 0.01f } },
    { "damping", AT(damping), 1, 0.0, 100.0, { 3.0f } },
    { "gravity", AT(gravity), 1, 0.0, 100.0, { 2.0f } },
};

static int read_numbers(text_scan *s, text_word name, uint32_t count, double low, double high, float *out)
{
    char shown[TEXT_SHOWN];
    for (uint32_t i = 0; i < count; i++) {
        const text_word word = text_next_on_line(s);
        double value = 0.0;
        if (!word.size) {
            return text_fail(s, name.line, "'%s' needs %u numbers", text_show(name, shown), count);
        }
        if (text_number(s, word, &value)) return 1;
        if (!(value >= low && value <= high)) {
            return text_fail(s, word.line, "%s must be %g to %g", text_show(word, shown), low, high);
        }
        out[i] = (float)value;
    }
    return 0;
}

static int read_joint(text_scan *s, hair_text *hair)
{
    text_word word;
    if (text_take_on_line(s, &word)) return 1;
    if (!word.size || hair->joint) return text_fail(s, word.line, "`joint` must be given once, with one name");
    if (word.size >= NOH_NAME_BYTES_MAX) {
        return text_fail(s, word.line, "the joint's name is longer than %u bytes", NOH_NAME_BYTES_MAX - 1u);
    }
    hair->joint = text_copy(word);
    return hair->joint ? 0 : text_fail(s, word.line, "out of memory");
}

static int read_sphere(text_scan *s, text_word name, hair_text *hair)
{
    if (hair->sphere_count == HAIR_SPHERES_MAX) {
        return text_fail(s, name.line, "too many spheres: the limit is %u", HAIR_SPHERES_MAX);
    }
    float *sphere = hair->spheres[hair->sphere_count++];
    if (read_numbers(s, name, 4, -100.0, 100.0, sphere)) return 1;
    return sphere[3] > 0.0f ? 0 : text_fail(s, name.line, "a sphere's radius must be above 0");
}

/* A glTF file in the folder of the text. */
static int read_curves(text_scan *s, text_word name, const char *folder, hair_text *hair)
{
    text_word word;
    model_error reason = { "", "" };
    char path[1024];
    if (text_take_on_line(s, &word)) return 1;
    if (!word.size || hair->curves.count) return text_fail(s, name.line, "`curves` must be given once, with one file");
    if ((size_t)snprintf(path, sizeof path, "%s%.*s", word.text[0] == '/' ? "" : folder, (int)word.size, word.text) >=
        sizeof path) {
        return text_fail(s, name.line, "the path is too long");
    }
    return curves_read(path, &hair->curves, &reason) ? text_fail(s, name.line, "%.200s: %.300s", path, reason.what) : 0;
}

static int read_setting(text_scan *s, text_word word, const char *folder, hair_text *hair)
{
    char shown[TEXT_SHOWN];
    if (text_is(word, "curves")) return read_curves(s, word, folder, hair);
    if (text_is(word, "joint")) return read_joint(s, hair);
    if (text_is(word, "sphere")) return read_sphere(s, word, hair);
    for (size_t i = 0; i < sizeof settings / sizeof settings[0]; i++) {
        const setting *k = &settings[i];
        if (!text_is(word, k->name)) continue;
        return read_numbers(s, word, k->count, k->low, k->high, (float *)(void *)((char *)hair + k->at));
    }
    return text_fail(s, word.line, "a haircut has no setting '%s' (noh help FORMATS lists them)",
                     text_show(word, shown));
}

static int read_line(text_scan *s, const char *folder, hair_text *hair)
{
    char shown[TEXT_SHOWN];
    text_word word;
    if (text_take_on_line(s, &word)) return 1;
    if (!word.size) return 0; /* a comment */
    if (read_setting(s, word, folder, hair) || text_take_on_line(s, &word)) return 1;
    return word.size ? text_fail(s, word.line, "'%s' is one word too many", text_show(word, shown)) : 0;
}

static int check_whole(text_scan *s, const hair_text *h)
{
    const float *comb = h->comb;
    if (!(h->skull[3] > 1e-3f && h->skull[4] > 1e-3f && h->skull[5] > 1e-3f)) {
        return text_fail(s, s->line,
                         "the skull is missing, or one of its radii is below a millimetre: add `skull X Y Z RX RY RZ`");
    }
    if (h->around * h->rows > (float)NOH_HAIRS_MAX || h->around * (h->rows - 1.0f) > (float)NOH_HAIR_PATCHES_MAX) {
        return text_fail(s, s->line, "around times rows is more than %u control hairs, which is the limit",
                         NOH_HAIRS_MAX);
    }
    if (!(comb[0] * comb[0] + comb[1] * comb[1] + comb[2] * comb[2] > 1e-6f)) {
        return text_fail(s, s->line, "`comb` is 0 0 0: give it a direction");
    }
    return 0;
}

static hair_text *with_defaults(void)
{
    hair_text *hair = calloc(1, sizeof *hair);
    for (size_t i = 0; hair && i < sizeof settings / sizeof settings[0]; i++) {
        memcpy((char *)hair + settings[i].at, settings[i].initial, settings[i].count * sizeof(float));
    }
    return hair;
}

int hair_read(const char *path, hair_text **out, uint32_t *line, model_error *error)
{
    text_scan s;
    size_t size = 0;
    const char *slash = strrchr(path, '/');
    char folder[1024] = "";
    char *text = input_read_text(path, &size, error);
    int failed = 0;
    *out = text ? with_defaults() : NULL;
    if (!*out) {
        free(text);
        return 1;
    }
    if (slash && (size_t)(slash + 1 - path) < sizeof folder) memcpy(folder, path, (size_t)(slash + 1 - path));
    text_start(&s, text, size, error);
    while (!failed && text_next_line(&s)) {
        *line = s.line;
        failed = read_line(&s, folder, *out);
    }
    failed = failed || check_whole(&s, *out);
    if (failed) error->where[0] = 0; /* *line has the line */
    free(text);
    return failed;
}

void hair_free(hair_text *hair)
{
    if (!hair) return;
    free(hair->joint);
    curves_free(&hair->curves);
    free(hair);
}
