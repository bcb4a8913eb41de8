#include "markers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/byte_buffer.h"
#include "convert/base/input_file.h"
#include "convert/model/model_build.h"
#include "raw_set.h"

int markers_alloc(markers *m, model_error *error)
{
    const uint64_t joints = (uint64_t)m->count + 1u;
    if (!m->count || !m->frame_count) return model_fail(error, "", "the file has no markers, or no frames");
    if (joints > RAW_JOINTS_MAX || m->frame_count > RAW_FRAMES_MAX ||
        joints * m->frame_count * RAW_JOINT_BYTES > RAW_BYTES_MAX) {
        return model_fail(error, "", "%u frames of %u markers are more than the limit of %u MiB: cut the recording",
                          m->frame_count, m->count, (unsigned)(RAW_BYTES_MAX >> 20));
    }
    m->names = model_zeros(m->count, sizeof *m->names);
    m->places = model_zeros((size_t)m->count * m->frame_count, 3 * sizeof *m->places);
    return m->names && m->places ? 0 : model_fail_memory(error);
}

void markers_free(markers *m)
{
    for (uint32_t i = 0; m->names && i < m->count; i++) free(m->names[i]);
    free(m->names);
    free(m->places);
    free(m->warning);
    memset(m, 0, sizeof *m);
}

double markers_unit_cm(const char *name, size_t size)
{
    static const struct {
        const char *name;
        double cm;
    } units[] = { { "mm", 0.1 }, { "cm", 1.0 }, { "m", 100.0 }, { "in", 2.54 }, { "meters", 100.0 } };
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
        if (strlen(units[i].name) == size && memcmp(units[i].name, name, size) == 0) return units[i].cm;
    }
    return 0.0;
}

/* ---- gaps ---- */

static float *place_of(const markers *m, uint32_t frame, uint32_t marker)
{
    return m->places + 3 * ((size_t)frame * m->count + marker);
}

static int is_seen(const float *place)
{
    return isfinite(place[0]);
}

/* The next frame from `frame` on that has the marker; frame_count: none. */
static uint32_t next_seen(const markers *m, uint32_t marker, uint32_t frame)
{
    while (frame < m->frame_count && !is_seen(place_of(m, frame, marker))) frame++;
    return frame;
}

/* Between two frames in a straight line; before the first and after the last, where it is then. Returns the frames that
 * were missing; all: nowhere. */
static uint32_t fill_gaps(const markers *m, uint32_t marker)
{
    uint32_t before = m->frame_count, missing = 0;
    for (uint32_t f = 0; f < m->frame_count; f++) {
        float *at = place_of(m, f, marker);
        const uint32_t after = next_seen(m, marker, f);
        if (after == f) {
            before = f;
            continue;
        }
        missing++;
        if (after == m->frame_count && before == m->frame_count) return m->frame_count;
        for (int i = 0; i < 3; i++) {
            const uint32_t a = before == m->frame_count ? after : before, b = after == m->frame_count ? before : after;
            const double from = (double)place_of(m, a, marker)[i], to = (double)place_of(m, b, marker)[i];
            at[i] = (float)(a == b ? from : from + (to - from) * (f - a) / (b - a));
        }
        before = f; /* on the line */
    }
    return missing;
}

/* ---- a set ---- */

static void set_joint(const markers *m, uint32_t marker, uint32_t joint, raw_set *set)
{
    raw_clip *clip = set->clips;
    set->skeleton.joints[joint].parent = 0;
    memcpy(set->skeleton.joints[joint].translation, place_of(m, 0, marker), 3 * sizeof(float));
    for (size_t f = 0; f < clip->frame_count; f++) {
        memcpy(clip->translations + 3 * (f * clip->joint_count + joint), place_of(m, (uint32_t)f, marker),
               3 * sizeof(float));
    }
}

static int fill_set(markers *m, const uint32_t *kept, uint32_t count, const char *path, raw_set *set)
{
    raw_clip *clip = set->clips;
    set->skeleton.unit_cm = m->unit_cm;
    set->skeleton.name = model_string("markers");
    set->skeleton.joints[0].name = model_string("markers");
    clip->name = input_stem(path);
    clip->sample_rate_hz = m->rate_hz;
    if (!set->skeleton.name || !set->skeleton.joints[0].name || !clip->name ||
        raw_clip_alloc(clip, m->frame_count, count + 1u)) {
        return 1;
    }
    for (size_t i = 0; i < (size_t)clip->frame_count * clip->joint_count; i++) {
        clip->rotations[4 * i + 3] = 1.0f;
        for (size_t k = 0; k < 3; k++) clip->scales[3 * i + k] = 1.0f;
    }
    for (uint32_t i = 0; i < count; i++) {
        set_joint(m, kept[i], i + 1u, set);
        set->skeleton.joints[i + 1u].name = m->names[kept[i]];
        m->names[kept[i]] = NULL; /* the set's now */
    }
    return 0;
}

static void say_missing(const markers *m, uint32_t missing, uint32_t lost, const char *first, byte_buffer *text)
{
    if (m->warning) buffer_print(text, "; %s", m->warning);
    if (lost) {
        buffer_print(text, "; marker '%.40s'%s in no frame: left out", first, lost > 1 ? " and others are" : " is");
    }
    if (missing) {
        buffer_print(text, "; places of markers were interpolated where no camera saw them: %.2g %% of all",
                     100.0 * missing / ((double)m->frame_count * m->count));
    }
    buffer_append(text, "", 1);
}

static int set_of(markers *m, const char *path, uint32_t *kept, byte_buffer *text, raw_set **out)
{
    uint32_t count = 0, missing = 0, lost = 0;
    const char *first = "";
    for (uint32_t i = 0; i < m->count; i++) {
        const uint32_t gone = fill_gaps(m, i);
        if (gone < m->frame_count) {
            kept[count++] = i;
            missing += gone;
        } else if (!lost++) {
            first = m->names[i];
        }
    }
    say_missing(m, missing, lost, first, text);
    *out = raw_set_new(count + 1u, 1);
    if (!*out || text->failed || fill_set(m, kept, count, path, *out)) return 1;
    (*out)->warning = text->count > 1u ? model_string((const char *)text->bytes + 2) : NULL;
    return text->count > 1u && !(*out)->warning;
}

int markers_set(markers *m, const char *path, raw_set **out, model_error *error)
{
    byte_buffer text = { NULL, 0, 0, 0 };
    uint32_t *kept = model_zeros(m->count, sizeof *kept);
    int failed;
    *out = NULL;
    if (!(m->rate_hz >= 1e-3 && m->rate_hz <= 1e6)) {
        failed = model_fail(error, "", "a rate of %g frames a second: it must be 0.001 to 1000000", m->rate_hz);
    } else {
        failed = (!kept || set_of(m, path, kept, &text, out)) && model_fail_memory(error);
    }
    if (failed) {
        raw_set_free(*out);
        *out = NULL;
    }
    buffer_free(&text);
    free(kept);
    markers_free(m);
    return failed;
}
