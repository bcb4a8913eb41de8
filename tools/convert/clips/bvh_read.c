#include "bvh_read.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "bvh_internal.h"
#include "convert/base/input_file.h"
#include "convert/model/model_build.h"
#include "raw_set.h"

static int expect(bvh_file *f, const char *keyword, const char *after)
{
    char shown[TEXT_SHOWN];
    text_word word = text_next(&f->text);
    if (text_is(word, keyword)) return 0;
    return text_fail(&f->text, word.line, "expected %s after %s, got '%s'", keyword, after, text_show(word, shown));
}

/* --- growing tables --- */

static void *grown(void *array, uint32_t count, uint32_t *capacity, size_t element_size)
{
    if (count < *capacity) return array;
    uint32_t wanted = *capacity ? *capacity * 2 : 64;
    void *larger = realloc(array, wanted * element_size);
    if (larger) *capacity = wanted;
    return larger;
}

static int add_joint(bvh_file *f, uint32_t parent, uint32_t line)
{
    if (f->joint_count == RAW_JOINTS_MAX)
        return text_fail(&f->text, line, "the skeleton has more than %u joints, which is the limit", RAW_JOINTS_MAX);
    bvh_joint *larger = grown(f->joints, f->joint_count, &f->joint_capacity, sizeof *f->joints);
    if (!larger) return bvh_out_of_memory(f);
    f->joints = larger;
    memset(&f->joints[f->joint_count], 0, sizeof *f->joints);
    f->joints[f->joint_count].parent = parent;
    f->joints[f->joint_count].line = line;
    ++f->joint_count;
    return 0;
}

static int add_channel(bvh_file *f, uint32_t joint, uint8_t kind)
{
    bvh_channel *larger = grown(f->channels, f->channel_count, &f->channel_capacity, sizeof *f->channels);
    if (!larger) return bvh_out_of_memory(f);
    f->channels = larger;
    f->channels[f->channel_count].joint = joint;
    f->channels[f->channel_count].kind = kind;
    ++f->channel_count;
    return 0;
}

/* --- one joint --- */

static int is_blank(char c)
{
    return c == ' ' || c == '\t';
}

/* The rest of the line, which may hold blanks, or up to an opening brace after a blank. */
static text_word take_name(bvh_file *f)
{
    text_word name = text_rest_of_line(&f->text);
    size_t size = 0;
    while (size < name.size && !(name.text[size] == '{' && (size == 0 || is_blank(name.text[size - 1])))) ++size;
    if (size < name.size) f->text.at = name.text + size; /* the brace is still to be read */
    while (size > 0 && is_blank(name.text[size - 1])) --size;
    name.size = size;
    return name;
}

static int read_vector(bvh_file *f, double *out)
{
    for (int i = 0; i < 3; ++i) {
        text_word word = text_next(&f->text);
        if (text_number(&f->text, word, &out[i])) return 1;
        if (fabs(out[i]) > (double)NOH_NUMBER_MAX)
            return text_fail(&f->text, word.line, "the number %g is too large", out[i]);
    }
    return 0;
}

static int read_offset(bvh_file *f, uint32_t j, uint32_t line)
{
    if (f->joints[j].has_offset) return text_fail(&f->text, line, "joint '%.48s' has two OFFSETs", f->joints[j].name);
    f->joints[j].has_offset = 1;
    return read_vector(f, f->joints[j].offset);
}

static int channel_kind(text_word word, uint8_t *out)
{
    static const char *const names[6] = {
        "Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation"
    };
    for (uint8_t kind = 0; kind < 6; ++kind)
        if (text_is(word, names[kind])) {
            *out = kind;
            return 1;
        }
    return 0;
}

static int read_channel(bvh_file *f, uint32_t j, uint32_t *seen)
{
    char shown[TEXT_SHOWN];
    uint8_t kind = 0;
    text_word word = text_next(&f->text);
    if (!channel_kind(word, &kind))
        return text_fail(&f->text, word.line, "'%s' is not a channel: joint '%.48s' has too few or unknown ones",
                         text_show(word, shown), f->joints[j].name);
    if (*seen & 1u << kind)
        return text_fail(&f->text, word.line, "joint '%.48s' has the channel %s twice", f->joints[j].name,
                         text_show(word, shown));
    *seen |= 1u << kind;
    return add_channel(f, j, kind);
}

static int read_channels(bvh_file *f, uint32_t j, uint32_t line)
{
    uint32_t seen = 0;
    bvh_joint *joint = &f->joints[j];
    if (joint->has_channels) return text_fail(&f->text, line, "joint '%.48s' has two lists of CHANNELS", joint->name);
    joint->has_channels = 1;
    joint->first_channel = f->channel_count;
    if (text_count(&f->text, text_next(&f->text), 6, &joint->channel_count)) return 1;
    for (uint32_t i = 0; i < joint->channel_count; ++i)
        if (read_channel(f, j, &seen)) return 1;
    return 0;
}

static int read_joint_name(bvh_file *f, uint32_t j, const char *kind)
{
    text_word name = take_name(f);
    bvh_joint *joint = &f->joints[j];
    if (name.size == 0) return text_fail(&f->text, name.line, "a %s has no name", kind);
    joint->name = text_copy(name);
    return joint->name ? expect(f, "{", "the name") : bvh_out_of_memory(f);
}

/* --- end sites --- */

static char *end_name(const char *parent)
{
    size_t size = strlen(parent);
    char *name = malloc(size + 5);
    if (name) {
        memcpy(name, parent, size);
        memcpy(name + size, "_end", 5);
    }
    return name;
}

static int add_end_joint(bvh_file *f, uint32_t parent, const double *offset, uint32_t line)
{
    if (add_joint(f, parent, line)) return 1;
    bvh_joint *joint = &f->joints[f->joint_count - 1];
    memcpy(joint->offset, offset, sizeof joint->offset);
    joint->is_end = joint->has_offset = joint->has_channels = 1;
    joint->name = end_name(f->joints[parent].name);
    return joint->name ? 0 : bvh_out_of_memory(f);
}

static double square(const double *v)
{
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

static int read_end_site(bvh_file *f, uint32_t parent, uint32_t line)
{
    double offset[3];
    (void)take_name(f); /* "Site" */
    if (expect(f, "{", "End Site") || expect(f, "OFFSET", "End Site {") || read_vector(f, offset)) return 1;
    text_word word = text_next(&f->text);
    uint32_t none;
    if (text_is(word, "CHANNELS")) {
        if (text_count(&f->text, text_next(&f->text), 0, &none)) return 1;
        word = text_next(&f->text);
    }
    if (!text_is(word, "}")) return text_fail(&f->text, word.line, "expected } after an end site's offset");
    if (square(offset) > square(f->joints[parent].end)) memcpy(f->joints[parent].end, offset, sizeof offset);
    return f->end_joints ? add_end_joint(f, parent, offset, line) : 0;
}

/* --- the hierarchy --- */

static int open_joint(bvh_file *f, uint32_t *open, uint32_t line, const char *kind)
{
    if (add_joint(f, *open, line)) return 1;
    *open = f->joint_count - 1;
    return read_joint_name(f, *open, kind);
}

static int close_joint(bvh_file *f, uint32_t *open, uint32_t line)
{
    const bvh_joint *joint = &f->joints[*open];
    if (!joint->has_offset) return text_fail(&f->text, line, "joint '%.48s' has no OFFSET", joint->name);
    if (!joint->has_channels) return text_fail(&f->text, line, "joint '%.48s' has no CHANNELS", joint->name);
    *open = joint->parent;
    return 0;
}

static int read_member(bvh_file *f, uint32_t *open, text_word word)
{
    char shown[TEXT_SHOWN];
    if (text_is(word, "OFFSET")) return read_offset(f, *open, word.line);
    if (text_is(word, "CHANNELS")) return read_channels(f, *open, word.line);
    if (text_is(word, "JOINT")) return open_joint(f, open, word.line, "joint");
    if (text_is(word, "End")) return read_end_site(f, *open, word.line);
    if (text_is(word, "}")) return close_joint(f, open, word.line);
    if (word.size == 0)
        return text_fail(&f->text, word.line, "the file ends inside joint '%.48s'", f->joints[*open].name);
    return text_fail(&f->text, word.line, "'%s' is not allowed inside a joint", text_show(word, shown));
}

/* Up to the word MOTION, and past it. */
static int read_hierarchy(bvh_file *f)
{
    char shown[TEXT_SHOWN];
    uint32_t open = MODEL_NONE;
    text_word word = text_next(&f->text);
    if (!text_is(word, "HIERARCHY"))
        return text_fail(&f->text, word.line, "this is not a .bvh file: it does not start with HIERARCHY");
    for (;;) {
        word = text_next(&f->text);
        if (open != MODEL_NONE) {
            if (read_member(f, &open, word)) return 1;
        } else if (text_is(word, "ROOT")) {
            if (open_joint(f, &open, word.line, "root")) return 1;
        } else if (text_is(word, "MOTION")) {
            return f->joint_count ? 0 : text_fail(&f->text, word.line, "there is no ROOT before MOTION");
        } else {
            return text_fail(&f->text, word.line, "expected ROOT or MOTION, got '%s'", text_show(word, shown));
        }
    }
}

static int build_set(bvh_file *f, const char *path, double unit_cm)
{
    f->set = raw_set_new(f->joint_count, 1);
    if (!f->set) return bvh_out_of_memory(f);
    raw_skeleton *skeleton = &f->set->skeleton;
    skeleton->unit_cm = unit_cm;
    skeleton->name = model_string(f->joints[0].name);
    f->set->clips[0].name = input_stem(path);
    for (uint32_t j = 0; j < f->joint_count; ++j) {
        raw_joint *joint = &skeleton->joints[j];
        joint->parent = f->joints[j].parent;
        joint->name = f->joints[j].name;
        f->joints[j].name = NULL; /* the set's now */
        for (int i = 0; i < 3; ++i) {
            joint->translation[i] = (float)f->joints[j].offset[i];
            joint->end[i] = f->end_joints ? 0.0f : (float)f->joints[j].end[i];
        }
    }
    return skeleton->name && f->set->clips[0].name ? 0 : bvh_out_of_memory(f);
}

/* Whether a joint only leads to the body: it and all above it have one child. Some recorders put a root on the ground
 * above the hips, and the hips' offset is then where the person stood. */
static int leads(const bvh_file *f, uint32_t joint)
{
    for (uint32_t j = joint; j != MODEL_NONE; j = f->joints[j].parent) {
        uint32_t children = 0;
        for (uint32_t i = j + 1u; i < f->joint_count; ++i) children += f->joints[i].parent == j;
        if (children != 1u) return 0;
    }
    return 1;
}

/* The largest side of a box round the joints as they rest, in the file's unit: of the body, where some joint has
 * several children. */
static double rest_size(const bvh_file *f)
{
    double low[3] = { 0.0, 0.0, 0.0 }, high[3] = { 0.0, 0.0, 0.0 }, size = 0.0;
    double *places = model_zeros(f->joint_count, 3 * sizeof *places);
    int branches = 0;
    if (!places) return 0.0;
    for (uint32_t j = 2; j < f->joint_count; ++j)
        branches |= f->joints[j].parent != MODEL_NONE && f->joints[j].parent + 1u < j;
    for (uint32_t j = 0; j < f->joint_count; ++j) {
        const bvh_joint *joint = &f->joints[j];
        const int first = joint->parent == MODEL_NONE || (branches && leads(f, joint->parent));
        for (uint32_t k = 0; k < 3; ++k) {
            const double from = first ? 0.0 : places[joint->parent * 3 + k] + joint->offset[k];
            const double tip = from + joint->end[k];
            places[j * 3 + k] = from;
            low[k] = fmin(low[k], fmin(from, tip));
            high[k] = fmax(high[k], fmax(from, tip));
        }
    }
    for (uint32_t k = 0; k < 3; ++k) size = fmax(size, high[k] - low[k]);
    free(places);
    return size;
}

/* The unit in which a person would be so large: the metre or the millimetre, or what makes 1.7 m of it. */
static double unit_of_person(double size)
{
    if (size >= 0.8 && size <= 2.5) return 100.0;
    return size >= 800.0 && size <= 2500.0 ? 0.1 : 170.0 / size;
}

/* The format has no unit, and a person of 2 cm is one in metres. */
static int warn_of_size(bvh_file *f, double unit_cm)
{
    const double size = rest_size(f), cm = size * unit_cm;
    char text[256];
    if (!(size > 0.0) || (cm >= 40.0 && cm <= 400.0) || f->set->warning) return 0;
    (void)snprintf(text, sizeof text,
                   "the skeleton is %.3g cm large with a unit of %g cm; if it is a person, try --unit-cm %.3g", cm,
                   unit_cm, unit_of_person(size));
    f->set->warning = model_string(text);
    return f->set->warning ? 0 : bvh_out_of_memory(f);
}

static void close_file(bvh_file *f)
{
    for (uint32_t j = 0; j < f->joint_count; ++j) free(f->joints[j].name);
    free(f->joints);
    free(f->channels);
}

int bvh_read(const char *path, const bvh_options *options, raw_set **out, model_error *error)
{
    bvh_file f = { 0 };
    size_t size = 0;
    double unit_cm = options && options->unit_cm != 0.0 ? options->unit_cm : 1.0;
    *out = NULL;
    if (!(unit_cm > 0.0 && unit_cm <= 1e9))
        return model_fail(error, "", "the unit must be above 0, not %g cm", unit_cm);
    char *text = input_read_text(path, &size, error);
    if (!text) return 1;
    text_start(&f.text, text, size, error);
    f.end_joints = options && options->end_joints;
    int failed = read_hierarchy(&f) || build_set(&f, path, unit_cm) || bvh_read_frames(&f) || warn_of_size(&f, unit_cm);
    if (failed)
        raw_set_free(f.set);
    else
        *out = f.set;
    close_file(&f);
    free(text);
    return failed;
}
