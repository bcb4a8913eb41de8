#include "bvh_internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "convert/base/angle.h"
#include "convert/model/model_build.h"
#include "convert/base/quat.h"
#include "raw_set.h"

static int warn(bvh_file *f, const char *text)
{
    char both[1024];
    (void)snprintf(both, sizeof both, "%s%s%s", f->set->warning ? f->set->warning : "", f->set->warning ? "; " : "",
                   text);
    free(f->set->warning);
    f->set->warning = model_string(both);
    return f->set->warning ? 0 : bvh_out_of_memory(f);
}

/* "Frames:" or "Frame Time:"; blanks may stand before the colon and after it. */
static int expect_label(bvh_file *f, const char *label)
{
    text_scan *s = &f->text;
    (void)text_next_line(s);
    const uint32_t line = s->line;
    for (const char *c = label; *c; ++c) {
        while (*c == ' ' && s->at < s->end && (*s->at == ' ' || *s->at == '\t')) ++s->at;
        if (*c == ' ') continue;
        if (s->at == s->end || (*s->at | 0x20) != (*c | 0x20)) return text_fail(s, line, "expected '%s:'", label);
        ++s->at;
    }
    while (s->at < s->end && (*s->at == ' ' || *s->at == '\t')) ++s->at;
    if (s->at == s->end || *s->at != ':') return text_fail(s, line, "expected '%s:'", label);
    ++s->at;
    return 0;
}

/* Nothing but blanks may follow on the line. */
static int expect_line_end(bvh_file *f)
{
    char shown[TEXT_SHOWN];
    text_word word = text_next_on_line(&f->text);
    return word.size == 0 ? 0 : text_fail(&f->text, word.line, "'%s' is unexpected here", text_show(word, shown));
}

/* The unit of the last digit printed: how precisely the time is known. */
static double last_digit_of(text_word word)
{
    double unit = 1.0;
    const char *point = memchr(word.text, '.', word.size);
    for (const char *c = point ? point + 1 : word.text + word.size; c < word.text + word.size && *c >= '0' && *c <= '9';
         ++c)
        unit *= 0.1;
    return unit;
}

/* 0.0333333 means 30 Hz: a whole number of Hz is taken if its period agrees with the printed one to the last digit. */
static double sample_rate_of(double period_s, double last_digit_s)
{
    double sample_rate_hz = 1.0 / period_s, whole_hz = floor(sample_rate_hz + 0.5);
    if (whole_hz >= 1.0 && fabs(1.0 / whole_hz - period_s) <= fmin(last_digit_s, 0.002 * period_s)) return whole_hz;
    return sample_rate_hz;
}

/* The error of a value that the clip can do without becomes a warning, with what was done instead. */
static int warn_of_error(bvh_file *f, const char *instead)
{
    model_error *reason = f->text.error;
    char text[sizeof reason->what + sizeof reason->where + 160];
    if (!reason->where[0]) return 1; /* out of memory */
    (void)snprintf(text, sizeof text, "%s: %s; %s", reason->where, reason->what, instead);
    reason->what[0] = reason->where[0] = '\0';
    return warn(f, text);
}

static int read_sample_rate(bvh_file *f, double *sample_rate_hz)
{
    double period_s = 0.0;
    text_word word = text_next_on_line(&f->text);
    if (text_number(&f->text, word, &period_s) || expect_line_end(f)) {
        *sample_rate_hz = 30.0;
        (void)text_rest_of_line(&f->text);
        return warn_of_error(f, "the clip was read at 30 Hz");
    }
    if (!(period_s >= 1e-6 && period_s <= 1e3)) {
        char text[96];
        (void)snprintf(text, sizeof text, "the frame time of %g s is impossible; the clip was read at 30 Hz", period_s);
        *sample_rate_hz = 30.0;
        return warn(f, text);
    }
    *sample_rate_hz = sample_rate_of(period_s, last_digit_of(word));
    return 0;
}

/* A number that cannot be read, and 0: as many as there are. */
static int read_frame_count(bvh_file *f, uint32_t *out)
{
    const uint64_t most = RAW_BYTES_MAX / ((uint64_t)f->joint_count * RAW_JOINT_BYTES);
    text_word word = text_next_on_line(&f->text);
    if (f->channel_count == 0)
        return text_fail(&f->text, word.line, "no joint has a channel: there is nothing to animate");
    f->any_count = text_count(&f->text, word, RAW_FRAMES_MAX, out) || expect_line_end(f);
    if (f->any_count) {
        (void)text_rest_of_line(&f->text);
        if (warn_of_error(f, "all frames that follow were read")) return 1;
    } else if (!*out) {
        f->any_count = 1;
        if (warn(f, "the header gives no frames; all that follow were read")) return 1;
    }
    if (f->any_count) {
        *out = (uint32_t)(most < RAW_FRAMES_MAX ? most : RAW_FRAMES_MAX);
        return 0;
    }
    if (*out > most)
        return text_fail(&f->text, word.line, "%u frames of %u joints are more than the limit of %u MiB", *out,
                         f->joint_count, (uint32_t)(RAW_BYTES_MAX >> 20));
    return 0;
}

/* Whether frames are wrapped over lines, or share them: most lines then have other counts than the channels, and the
 * counts fit frames if lines mean nothing. Else a line that is too short or too long is a damaged frame. */
static int find_wrapped(const bvh_file *f)
{
    text_scan s = f->text;
    const uint64_t channels = f->channel_count, frames = f->any_count ? 0 : f->frame_count;
    uint64_t lines = 0, whole = 0, all = 0;
    while (text_next_line(&s)) {
        uint64_t count = 0;
        while (text_next_on_line(&s).size) count++;
        whole += count == channels;
        all += count;
        lines++;
    }
    if (2u * whole >= lines || lines == frames) return 0;
    if (!frames) return all % channels == 0;
    return all == frames * channels || (lines > frames && all < lines * channels);
}

static int is_at_frame(bvh_file *f)
{
    text_scan ahead = f->text;
    return f->is_wrapped ? text_next(&ahead).size != 0 : text_next_line(&f->text);
}

static text_word next_value(bvh_file *f)
{
    return f->is_wrapped ? text_next(&f->text) : text_next_on_line(&f->text);
}

static int read_value(bvh_file *f, uint32_t frame, uint32_t channel, double *value)
{
    text_word word = next_value(f);
    if (word.size == 0)
        return text_fail(&f->text, word.line, "frame %u has %u numbers; the channels need %u", frame, channel,
                         f->channel_count);
    if (text_number(&f->text, word, value)) return 1;
    return fabs(*value) > (double)NOH_NUMBER_MAX ? text_fail(&f->text, word.line, "the number %g is too large", *value)
                                                 : 0;
}

/* To the end of the frame, though a value of it is damaged. */
static int read_values(bvh_file *f, uint32_t frame, double *values)
{
    for (uint32_t c = 0; c < f->channel_count; ++c) {
        if (!read_value(f, frame, c, &values[c])) continue;
        for (; f->is_wrapped && c + 1u < f->channel_count; ++c) (void)text_next(&f->text);
        if (!f->is_wrapped) (void)text_rest_of_line(&f->text);
        return 1;
    }
    text_word word = f->is_wrapped ? (text_word){ NULL, 0, 0 } : text_rest_of_line(&f->text);
    return word.size == 0 ? 0
                          : text_fail(&f->text, word.line, "frame %u has more numbers than the %u channels", frame,
                                      f->channel_count);
}

/* q = q * (a turn about one axis) */
static void turn(double *q, int axis, double degrees)
{
    double about[4] = { 0.0, 0.0, 0.0, 0.0 }, product[4];
    angle_sin_cos_degrees(0.5 * degrees, &about[axis], &about[3]);
    quat_multiply(q, about, product);
    memcpy(q, product, sizeof product);
}

static void pose_joint(const bvh_file *f, const bvh_joint *joint, const double *values, double *q, double *t)
{
    memcpy(t, joint->offset, 3 * sizeof *t);
    for (uint32_t c = joint->first_channel; c < joint->first_channel + joint->channel_count; ++c) {
        if (f->channels[c].kind < 3)
            t[f->channels[c].kind] = values[c];
        else
            turn(q, f->channels[c].kind - 3, values[c]);
    }
}

static void store_joint(raw_clip *clip, uint32_t frame, uint32_t j, double *q, const double *t)
{
    const size_t at = (size_t)frame * clip->joint_count + j;
    double before[4] = { 0.0, 0.0, 0.0, 1.0 };
    for (int i = 0; frame > 0 && i < 4; ++i)
        before[i] = (double)clip->rotations[(at - clip->joint_count) * 4 + (size_t)i];
    (void)quat_normalize(q);
    quat_align(q, before);
    for (int i = 0; i < 4; ++i) clip->rotations[at * 4 + (size_t)i] = (float)q[i];
    for (int i = 0; i < 3; ++i) {
        clip->translations[at * 3 + (size_t)i] = (float)t[i];
        clip->scales[at * 3 + (size_t)i] = 1.0f;
    }
}

static void copy_frame(raw_clip *clip, uint32_t from, uint32_t to)
{
    const size_t joints = clip->joint_count;
    memcpy(clip->rotations + 4 * joints * to, clip->rotations + 4 * joints * from, 4 * joints * sizeof(float));
    memcpy(clip->translations + 3 * joints * to, clip->translations + 3 * joints * from, 3 * joints * sizeof(float));
    memcpy(clip->scales + 3 * joints * to, clip->scales + 3 * joints * from, 3 * joints * sizeof(float));
}

static void pose_frame(bvh_file *f, uint32_t frame, const double *values)
{
    for (uint32_t j = 0; j < f->joint_count; ++j) {
        double q[4] = { 0.0, 0.0, 0.0, 1.0 }, t[3];
        pose_joint(f, &f->joints[j], values, q, t);
        store_joint(&f->set->clips[0], frame, j, q, t);
    }
}

/* The clip ends behind the last frame that can be read. Of those before it that cannot, the first is reported. */
static int end_clip(bvh_file *f, uint32_t frame, uint32_t end, uint32_t held, const model_error *bad)
{
    char text[sizeof bad->what + sizeof bad->where + 160];
    f->set->clips[0].frame_count = end;
    if (held) {
        (void)snprintf(text, sizeof text, "%s: %s; %u frame%s that cannot be read repeat%s the nearest one", bad->where,
                       bad->what, held, held == 1u ? "" : "s", held == 1u ? "s" : "");
        if (warn(f, text)) return 1;
    }
    if (end < frame) {
        if (held)
            (void)snprintf(text, sizeof text, "the clip ends before the last frames, which cannot be read (%u of them)",
                           frame - end);
        else
            (void)snprintf(text, sizeof text, "%s: %s; the clip ends before it", bad->where, bad->what);
        return warn(f, text);
    }
    if (!f->any_count && frame < f->frame_count) {
        (void)snprintf(text, sizeof text, "line %u: the file ends after %u of %u frames; the clip ends before it",
                       f->text.line, frame, f->frame_count);
        return warn(f, text);
    }
    return 0;
}

/* A frame that cannot be read repeats the one before it, and those at the start the first that can. Some writers count
 * the steps between frames and so announce one frame less than they write. */
static int read_frames(bvh_file *f, double *values, uint32_t room)
{
    model_error *reason = f->text.error, bad = { "", "" };
    uint32_t frame = 0, end = 0, wrong = 0, held = 0;
    for (; frame < f->frame_count && frame < room && is_at_frame(f); ++frame) {
        if (read_values(f, frame, values)) {
            if (!wrong++) bad = *reason;
            reason->what[0] = reason->where[0] = '\0';
            if (end) copy_frame(&f->set->clips[0], frame - 1u, frame);
            continue;
        }
        pose_frame(f, frame, values);
        for (uint32_t first = 0; !end && first < frame; ++first) copy_frame(&f->set->clips[0], frame, first);
        end = frame + 1u;
        held = wrong;
    }
    if (!end) {
        *reason = bad;
        if (wrong) return 1;
        return f->any_count ? text_fail(&f->text, f->text.line, "there are no frames")
                            : text_fail(&f->text, f->text.line, "the file ends after 0 of %u frames", f->frame_count);
    }
    if (end_clip(f, frame, end, held, &bad)) return 1;
    return is_at_frame(f) ? warn(f, "the file has more frames than its header gives; they were left out") : 0;
}

/* As many frames as were announced, but no more than the rest of the file can hold: a number takes at least two bytes
 * with the blank after it. */
static uint32_t frames_to_hold(const bvh_file *f)
{
    size_t room = (size_t)(f->text.end - f->text.at) / (2u * f->channel_count) + 1;
    return room < f->frame_count ? (uint32_t)room : f->frame_count;
}

int bvh_read_frames(bvh_file *f)
{
    raw_clip *clip = &f->set->clips[0];
    if (expect_label(f, "Frames") || read_frame_count(f, &f->frame_count) || expect_label(f, "Frame Time") ||
        read_sample_rate(f, &clip->sample_rate_hz))
        return 1;
    f->is_wrapped = find_wrapped(f);
    double *values = model_zeros(f->channel_count, sizeof *values);
    const uint32_t room = frames_to_hold(f);
    int failed = !values || raw_clip_alloc(clip, room, f->joint_count) ? bvh_out_of_memory(f)
                                                                       : read_frames(f, values, room);
    free(values);
    return failed;
}
