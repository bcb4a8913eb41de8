#include "pack_clips.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "convert/clips/joint_order.h"
#include "convert/skin/joint_points.h"
#include "convert/skin/joint_radius.h"
#include "convert/clips/loop_check.h"
#include "convert/clips/raw_set.h"
#include "convert/model/model_build.h"

static uint32_t float_count(const raw_clip *clip)
{
    uint32_t count = 0;
    for (uint32_t g = 0; g < clip->float_count; g++) {
        count += clip->floats[g].width;
    }
    return count;
}

static double shell_cm(const clips_settings *s)
{
    return s->clip.shell_cm > 0.0 ? s->clip.shell_cm : 3.0;
}

#define CLOSED_CM 0.1 /* ends nearer than this look alike */

/* How a loop closes, or that a clip might be one. */
static int report_loop(const raw_set *set, const raw_clip *clip, const clips_settings *s, model_error *error)
{
    raw_loop_check loop;
    if (raw_clip_check_loop(&set->skeleton, clip, shell_cm(s), &loop)) {
        snprintf(error->what, sizeof error->what, "out of memory");
        return 1;
    }
    if (clip->loop) {
        fprintf(s->report, "  loop: first and last frame differ by %.3f cm, %.3f cm in place\n", loop.difference_cm,
                loop.in_place_cm);
    } else if (loop.in_place_cm < CLOSED_CM && loop.float_cm < CLOSED_CM) {
        fprintf(s->report, "  plays once, and ends as it begins (%.3f cm in place): --loop makes it a loop\n",
                loop.in_place_cm);
    }
    return 0;
}

static void report_clip(const clips_settings *s, const raw_set *set, const encoded_clip *c)
{
    const clip_report *r = &c->report;
    fprintf(s->report, "clip '%s': %u frames at %.4g Hz, %u joints, %u floats: %zu bytes of %zu (%.1f:1), ",
            c->raw->name, c->raw->frame_count, c->raw->sample_rate_hz, c->raw->joint_count, float_count(c->raw),
            r->bytes, r->raw_bytes, (double)r->raw_bytes / (double)(r->bytes ? r->bytes : 1));
    if (c->raw->joint_count) {
        fprintf(s->report, "error %.4f cm at '%s', %.2f s\n", r->max_error_cm,
                set->skeleton.joints[r->max_error_joint].name, r->max_error_time_s);
        if (c->errors.frame_error_cm >= 0.0) {
            fprintf(s->report, "  vertices at most %.4g cm off the source at frames, %.4g cm between them\n",
                    c->errors.frame_error_cm, c->errors.between_error_cm);
        }
    } else {
        fprintf(s->report, "error at most %.4f of the bound\n", r->max_float_error);
    }
}

/* ---- time ---- */

/* The clip's length as its decoder has it. */
static uint64_t duration_ticks(const raw_clip *clip)
{
    uint64_t sample_rate_uhz = (uint64_t)floor(clip->sample_rate_hz * 1e6 + 0.5);
    return (uint64_t)(clip->frame_count - 1u) * NOH_TICKS_PER_SECOND * 1000000u /
           (sample_rate_uhz ? sample_rate_uhz : 1u);
}

static uint32_t event_tick(const raw_clip *clip, const raw_event *event)
{
    uint64_t tick = (uint64_t)floor(event->time_s * NOH_TICKS_PER_SECOND + 0.5), end = duration_ticks(clip);
    return (uint32_t)(tick < end ? tick : end);
}

static int check_length(const raw_clip *clip, model_error *error)
{
    if (duration_ticks(clip) <= NOH_DURATION_MAX) {
        return 0;
    }
    snprintf(error->what, sizeof error->what, "it lasts %.0f s: a clip holds up to %u s", raw_clip_duration_s(clip),
             NOH_DURATION_MAX / NOH_TICKS_PER_SECOND);
    snprintf(error->where, sizeof error->where, "clip '%.100s'", clip->name);
    return 1;
}

static int fail_marker(const raw_clip *clip, const raw_event *event, const char *why, model_error *error)
{
    snprintf(error->what, sizeof error->what, "sync marker '%.60s' at %g s %s", event->name, event->time_s, why);
    snprintf(error->where, sizeof error->where, "clip '%.100s'", clip->name);
    return 1;
}

static int check_markers(const raw_clip *clip, model_error *error)
{
    const raw_event *before = NULL;
    for (uint32_t i = 0; i < clip->event_count; i++) {
        const raw_event *event = &clip->events[i];
        if (!event->is_marker) {
            continue;
        }
        if (event_tick(clip, event) >= duration_ticks(clip)) {
            return fail_marker(clip, event,
                               "lies at the end of its clip, where a loop begins again: put it at 0, or before the end",
                               error);
        }
        if (before && event_tick(clip, before) == event_tick(clip, event)) {
            return fail_marker(clip, event, "has the time of another marker", error);
        }
        before = event;
    }
    return 0;
}

/* ---- encoding ---- */

typedef struct progress {
    FILE *out;
    const char *name;
    uint32_t percent;
} progress;

static void show_progress(void *user, uint32_t done, uint32_t of)
{
    progress *p = user;
    const uint32_t percent = (uint32_t)((uint64_t)done * 100u / (of ? of : 1u));
    if (percent == p->percent) return;
    p->percent = percent;
    fprintf(p->out, "\rencoding clip %s %u%%\033[K", p->name, percent);
    fflush(p->out);
}

#define ERROR_USUAL_CM 0.01
#define ERROR_RAISED_CM 40.0 /* ten times this is about what a clip can say */

static int encode_bounded(const raw_set *set, const raw_clip *clip, const clips_settings *s, encoded_clip *out,
                          model_error *error)
{
    clip_options options = s->clip;
    progress shown = { s->progress, clip->name, 101 };
    const double own = named_error(&s->clip_errors, clip->name);
    int failed = 0;
    double *joints = named_joint_errors(&s->joint_errors, &set->skeleton, &failed);
    if (failed) {
        snprintf(error->what, sizeof error->what, "out of memory");
        return 1;
    }
    options.error_cm = own > 0.0 ? own : options.error_cm;
    options.joint_error_cm = joints;
    if (s->progress) {
        options.progress = show_progress;
        options.user = &shown;
    }
    do {
        options.error_cm = failed ? options.error_cm * 10.0 : options.error_cm;
        failed = clip_encode(&set->skeleton, clip, &options, &out->bytes, &out->report, error);
    } while (failed == CLIP_TOO_FINE && s->raises && !(own > 0.0) && options.error_cm <= ERROR_RAISED_CM);
    free(joints);
    if (!failed && s->warnings && options.error_cm > s->clip.error_cm && !(own > 0.0)) {
        fprintf(s->warnings,
                "warning: clip '%s' is too large, or too far from the origin, for --error-cm %g: %g was used\n",
                clip->name, s->clip.error_cm, options.error_cm);
    }
    return failed;
}

static int encode_clip(const raw_set *set, raw_clip *clip, const error_points *at, const clips_settings *s,
                       encoded_clip *out, model_error *error)
{
    clip->loop = (uint8_t)(clip->loop || s->check_loops);
    if (s->progress) {
        fprintf(s->progress, "\rencoding clip %s \033[K", clip->name);
        fflush(s->progress);
    }
    if (check_length(clip, error) || check_markers(clip, error) || encode_bounded(set, clip, s, out, error) ||
        clip_errors_measure(&set->skeleton, clip, &out->bytes, at, &out->errors, error)) {
        return 1;
    }
    if (!s->report) return 0;
    report_clip(s, set, out);
    return clip->joint_count ? report_loop(set, clip, s, error) : 0;
}

/* What a set's clips move, and where their errors are measured. */
typedef struct set_points {
    float *radius;
    double *reach_cm, *pose;
    joint_points points;
    moved_vertices vertices;
    error_points at;
} set_points;

static int open_points(const clips_settings *s, const raw_skeleton *skeleton, uint32_t index, set_points *p)
{
    const uint32_t count = skeleton->joint_count;
    memset(p, 0, sizeof *p);
    p->radius = model_zeros(count + 1u, sizeof *p->radius);
    p->reach_cm = model_zeros(count + 1u, sizeof *p->reach_cm);
    p->pose = model_zeros(count + 1u, 12u * sizeof *p->pose);
    if (!p->radius || !p->reach_cm || !p->pose || moved_vertices_add_bound(&p->vertices, s->m, index) ||
        moved_vertices_close(&p->vertices, count)) {
        return 1;
    }
    raw_pose_object(skeleton, NULL, 0, p->pose);
    moved_vertices_reach(&p->vertices, skeleton, p->pose, 1, p->reach_cm);
    p->at.shell_cm = shell_cm(s);
    p->at.joint_radius = joint_radius(s->m, index, count, p->radius) ? p->radius : NULL;
    p->at.points = p->at.joint_radius ? &p->points.points : NULL;
    p->at.vertices = &p->vertices;
    return p->at.joint_radius && joint_points_choose(s->m, index, count, &p->points);
}

static void close_points(set_points *p)
{
    free(p->radius);
    free(p->reach_cm);
    free(p->pose);
    joint_points_free(&p->points);
    moved_vertices_free(&p->vertices);
}

static int encode_set(encoded_clips *m, uint32_t index, const clips_settings *s, model_error *error)
{
    raw_set *set = m->sets[index];
    clips_settings own = *s;
    set_points points;
    int failed;
    own.raises = !(s->clip.error_cm > 0.0);
    if (own.raises) {
        own.clip.error_cm = set->error_cm > 0.0 ? set->error_cm : ERROR_USUAL_CM;
        own.clip.shell_cm = set->shell_cm > 0.0 ? fmin(shell_cm(s), set->shell_cm) : shell_cm(s);
    }
    failed = open_points(&own, &set->skeleton, index, &points);
    if (failed) {
        snprintf(error->what, sizeof error->what, "out of memory");
    }
    own.clip.reach_cm = points.reach_cm;
    for (uint32_t c = 0; c < set->clip_count && !failed; c++) {
        encoded_clip *to = &m->clips[m->clip_count++];
        to->set = index;
        to->raw = &set->clips[c];
        failed = encode_clip(set, &set->clips[c], &points.at, &own, to, error);
    }
    close_points(&points);
    return failed;
}

/* Frames of a joint in all clips: beyond WORK_USUAL, which take a processor 70 s of mocap with the usual effort, they
 * are encoded with the least effort, in a third of the time. */
#define WORK_USUAL (UINT64_C(1) << 20)
#define WORK_MAX (UINT64_C(1) << 22)

static int choose_effort(raw_set **sets, uint32_t set_count, clips_settings *s, model_error *error)
{
    const raw_clip *longest = NULL;
    uint64_t sum = 0, most = 0;
    for (uint32_t i = 0; i < set_count; i++) {
        for (uint32_t c = 0; c < sets[i]->clip_count; c++) {
            const raw_clip *clip = &sets[i]->clips[c];
            const uint64_t work = (uint64_t)clip->frame_count * clip->joint_count;
            sum += work;
            longest = work > most ? clip : longest;
            most = work > most ? work : most;
        }
    }
    if (sum <= WORK_USUAL || !longest) return 0;
    if (sum > WORK_MAX) {
        (void)model_fail(error, "",
                         "all clips have %llu frames of a joint, this one %u of %u joints: too many to encode, the "
                         "limit is %llu: lower --rate, cut them, or build %llu or more packs of clips (--only anim; "
                         "--anim takes several)",
                         (unsigned long long)sum, longest->frame_count, longest->joint_count,
                         (unsigned long long)WORK_MAX, (unsigned long long)((sum + WORK_MAX - 1u) / WORK_MAX));
        snprintf(error->where, sizeof error->where, "clip '%.100s'", longest->name);
        return 1;
    }
    if (s->clip.effort == 1) return 0;
    s->clip.effort = 1;
    if (s->warnings) {
        fprintf(
            s->warnings,
            "warning: all clips have %llu frames of a joint, so they are encoded with --effort 1, which may take more "
            "bytes: build some as another pack (--only anim) for more effort\n",
            (unsigned long long)sum);
    }
    return 0;
}

int clips_encode(raw_set **sets, uint32_t set_count, const clips_settings *settings, encoded_clips *out,
                 model_error *error)
{
    clips_settings own = *settings;
    const clips_settings *s = &own;
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
    failed = named_errors_check(&s->clip_errors, &s->joint_errors, sets, set_count, error) ||
             (!s->skeletons_only && choose_effort(sets, set_count, &own, error));
    for (uint32_t i = 0; i < set_count && !s->skeletons_only && !failed; i++) {
        failed = encode_set(out, i, s, error);
    }
    if (s->progress && total) {
        fputs("\r\033[K", s->progress);
    }
    return failed;
}

void clips_free(encoded_clips *m)
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
    uint32_t counts[NOH_LOD_LEVELS_MAX];
    noh_skeleton_header h;
    memset(&h, 0, sizeof h);
    h.joint_count = skeleton->joint_count;
    h.level_count = joint_levels(skeleton, counts);
    out->failed = out->failed || !h.level_count;
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
    begin_array(out, base, &h.levels_offset);
    buffer_append(out, counts, h.level_count * sizeof *counts);
    if (!out->failed) {
        memcpy(out->bytes + base, &h, sizeof h);
    }
}

static void append_event(const raw_clip *clip, const raw_event *from, string_table *strings, byte_buffer *out)
{
    noh_clip_event to;
    memset(&to, 0, sizeof to);
    to.tick = event_tick(clip, from);
    to.name = string_offset(strings, from->name);
    to.name_hash = string_hash(from->name);
    memcpy(to.payload, from->payload, sizeof to.payload);
    to.weight_min = from->weight_min;
    buffer_append(out, &to, sizeof to);
}

static void append_marker(const raw_clip *clip, const raw_event *from, string_table *strings, byte_buffer *out)
{
    noh_clip_marker to;
    to.tick = event_tick(clip, from);
    to.name = string_offset(strings, from->name);
    to.name_hash = string_hash(from->name);
    buffer_append(out, &to, sizeof to);
}

/* The index of a set's skeleton among the pack's: sets without joints have none. */
static uint32_t skeleton_index(const encoded_clips *m, uint32_t set)
{
    uint32_t index = 0;
    for (uint32_t i = 0; i < set; i++) {
        index += m->sets[i]->skeleton.joint_count != 0;
    }
    return index;
}

/* The root joint as the source has it in the first and the last frame. */
static void root_ends(const raw_clip *clip, float ends[2][7])
{
    for (uint32_t i = 0; i < 2 && clip->joint_count; i++) {
        const size_t at = i ? (size_t)(clip->frame_count - 1u) * clip->joint_count : 0u;
        memcpy(ends[i], clip->rotations + 4u * at, 16);
        memcpy(ends[i] + 4, clip->translations + 3u * at, 12);
    }
}

static noh_clip_header clip_header(const encoded_clips *m, const encoded_clip *clip)
{
    noh_clip_header h;
    memset(&h, 0, sizeof h);
    h.joint_count = clip->raw->joint_count;
    h.skeleton = h.joint_count ? skeleton_index(m, clip->set) : NOH_NONE;
    h.skeleton_hash = h.joint_count ? raw_skeleton_hash(&m->sets[clip->set]->skeleton) : 0;
    h.raw_bytes = clip->report.raw_bytes < NOH_NONE ? (uint32_t)clip->report.raw_bytes : NOH_NONE;
    h.clip_bytes = (uint32_t)clip->bytes.count;
    h.joint_error_count = clip->errors.level_count;
    memcpy(h.update_rate_error, clip->errors.update_rate, sizeof h.update_rate_error);
    h.error_shell = clip->errors.shell;
    root_ends(clip->raw, h.root_ends);
    for (uint32_t i = 0; i < clip->raw->event_count; i++) {
        *(clip->raw->events[i].is_marker ? &h.marker_count : &h.event_count) += 1;
    }
    return h;
}

void pack_clip(const encoded_clips *m, const encoded_clip *clip, string_table *strings, byte_buffer *out)
{
    const raw_clip *raw = clip->raw;
    size_t base = out->count;
    noh_clip_header h = clip_header(m, clip);
    buffer_append(out, &h, sizeof h);
    begin_array(out, base, &h.events_offset);
    for (uint32_t i = 0; i < raw->event_count; i++) {
        if (!raw->events[i].is_marker) append_event(raw, &raw->events[i], strings, out);
    }
    begin_array(out, base, &h.markers_offset);
    for (uint32_t i = 0; i < raw->event_count; i++) {
        if (raw->events[i].is_marker) append_marker(raw, &raw->events[i], strings, out);
    }
    begin_array(out, base, &h.joint_errors_offset);
    buffer_append(out, clip->errors.joint, h.joint_error_count * sizeof *clip->errors.joint);
    begin_array(out, base, &h.clip_offset);
    buffer_append(out, clip->bytes.bytes, clip->bytes.count);
    if (!out->failed) {
        memcpy(out->bytes + base, &h, sizeof h);
    }
}
