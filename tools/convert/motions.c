#include "motions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "loop_check.h"
#include "pack/format.h"
#include "raw_set.h"

#define TICKS_PER_SECOND 48000.0

static int report_loop(const raw_set *set, const raw_clip *clip, const motion_settings *s, model_error *error)
{
    raw_loop_check loop;
    if (raw_clip_check_loop(&set->skeleton, clip, s->clip.shell_cm > 0.0 ? s->clip.shell_cm : 3.0, &loop)) {
        snprintf(error->what, sizeof error->what, "out of memory");
        return 1;
    }
    if (s->report) {
        fprintf(s->report, "  loop: first and last frame differ by %.3f cm, %.3f cm in place\n", loop.difference_cm, loop.in_place_cm);
    }
    return 0;
}

static void report_clip(const motion_settings *s, const raw_set *set, const motion_clip *c)
{
    const clip_report *r = &c->report;
    fprintf(s->report, "clip '%s': %u frames at %.4g Hz, %u joints: %zu bytes of %zu (%.1f:1), error %.4f cm at '%s', %.2f s\n",
            c->raw->name, c->raw->frame_count, c->raw->rate_hz, c->raw->joint_count, r->bytes, r->raw_bytes,
            (double)r->raw_bytes / (double)(r->bytes ? r->bytes : 1), r->max_error_cm,
            set->skeleton.joints[r->max_error_joint < set->skeleton.joint_count ? r->max_error_joint : 0].name, r->max_error_time_s);
}

/* Weights are in the weight clips: only what moves joints is encoded here. */
static int encode_clip(const raw_set *set, raw_clip *clip, const motion_settings *s, motion_clip *out, model_error *error)
{
    raw_clip joints = *clip;
    joints.float_count = 0;
    joints.floats = NULL;
    joints.loop = (uint8_t)(clip->loop || s->check_loops);
    if (s->progress) {
        fprintf(s->progress, "\rencoding clip %s \033[K", clip->name);
        fflush(s->progress);
    }
    if (clip_encode(&set->skeleton, &joints, &s->clip, &out->bytes, &out->report, error)) {
        return 1;
    }
    if (s->report) {
        report_clip(s, set, out);
    }
    return s->check_loops ? report_loop(set, clip, s, error) : 0;
}

int motions_encode(raw_set **sets, uint32_t set_count, const motion_settings *s, motions *out, model_error *error)
{
    uint32_t total = 0;
    int failed = 0;
    memset(out, 0, sizeof *out);
    for (uint32_t i = 0; i < set_count; i++) {
        total += sets[i]->clip_count;
    }
    out->sets = sets;
    out->set_count = set_count;
    out->clips = calloc(total + 1u, sizeof *out->clips);
    if (!out->clips) {
        snprintf(error->what, sizeof error->what, "out of memory");
        return 1;
    }
    for (uint32_t i = 0; i < set_count && !failed; i++) {
        for (uint32_t c = 0; c < sets[i]->clip_count && !failed; c++) {
            if (sets[i]->clips[c].joint_count) {
                motion_clip *to = &out->clips[out->clip_count++];
                to->set = i;
                to->raw = &sets[i]->clips[c];
                failed = encode_clip(sets[i], &sets[i]->clips[c], s, to, error);
            }
        }
    }
    if (s->progress && total) {
        fputs("\r\033[K", s->progress);
    }
    return failed;
}

void motions_free(motions *m)
{
    for (uint32_t i = 0; i < m->clip_count; i++) {
        buffer_free(&m->clips[i].bytes);
    }
    free(m->clips);
    memset(m, 0, sizeof *m);
}

/* ---- chunks ---- */

static void begin_array(byte_buffer *out, size_t base, uint32_t *offset)
{
    buffer_align(out, 16);
    *offset = (uint32_t)(out->count - base);
}

void pack_skeleton(const raw_skeleton *skeleton, string_table *strings, byte_buffer *out)
{
    size_t base = out->count;
    noh_skeleton_header h;
    memset(&h, 0, sizeof h);
    h.joint_count = skeleton->joint_count;
    h.hash = raw_skeleton_hash(skeleton);
    h.unit_cm = (float)skeleton->unit_cm;
    buffer_append(out, &h, sizeof h);
    begin_array(out, base, &h.parents_offset);
    for (uint32_t j = 0; j < h.joint_count; j++) {
        uint32_t parent = skeleton->joints[j].parent;
        uint16_t narrow = parent == MODEL_NONE ? (uint16_t)NOH_PACK_JOINT_ROOT : (uint16_t)parent;
        buffer_append(out, &narrow, sizeof narrow);
    }
    begin_array(out, base, &h.bind_offset);
    for (uint32_t j = 0; j < h.joint_count; j++) {
        buffer_append(out, skeleton->joints[j].rotation, 16);
        buffer_append(out, skeleton->joints[j].translation, 12);
        buffer_append(out, skeleton->joints[j].scale, 12);
    }
    begin_array(out, base, &h.names_offset);
    for (uint32_t j = 0; j < h.joint_count; j++) {
        uint32_t name = string_offset(strings, skeleton->joints[j].name);
        buffer_append(out, &name, sizeof name);
    }
    if (!out->failed) {
        memcpy(out->bytes + base, &h, sizeof h);
    }
}

static void append_event(const raw_event *from, string_table *strings, byte_buffer *out)
{
    noh_motion_event to;
    memset(&to, 0, sizeof to);
    to.tick = (uint32_t)floor(from->time_s * TICKS_PER_SECOND + 0.5);
    to.name = string_offset(strings, from->name);
    to.name_hash = noh_hash_name((const char *)strings->bytes.bytes + to.name);
    memcpy(to.payload, from->payload, sizeof to.payload);
    to.weight_min = from->weight_min;
    buffer_append(out, &to, sizeof to);
}

void pack_motion(const motions *m, const motion_clip *clip, string_table *strings, byte_buffer *out)
{
    size_t base = out->count;
    noh_motion_header h;
    memset(&h, 0, sizeof h);
    h.skeleton_hash = raw_skeleton_hash(&m->sets[clip->set]->skeleton);
    h.joint_count = clip->raw->joint_count;
    h.raw_bytes = (uint32_t)clip->report.raw_bytes;
    h.event_count = clip->raw->event_count;
    h.clip_bytes = (uint32_t)clip->bytes.count;
    buffer_append(out, &h, sizeof h);
    begin_array(out, base, &h.events_offset);
    for (uint32_t i = 0; i < h.event_count; i++) {
        append_event(&clip->raw->events[i], strings, out);
    }
    begin_array(out, base, &h.clip_offset);
    buffer_append(out, clip->bytes.bytes, clip->bytes.count);
    if (!out->failed) {
        memcpy(out->bytes + base, &h, sizeof h);
    }
}
