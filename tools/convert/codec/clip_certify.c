/* clip_certify.c: decodes what was written, with the runtime's own code, and measures it against the raw clip. By the
 * same measure it is decided which segments are split. */
#include <stdlib.h>

#include "motion/clip/clip_decode_internal.h"
#include "motion/clip/clip_sample_internal.h"
#include "clip_encoder.h"

typedef struct certifier {
    encoder *e;
    noh_clip *clip;
    uint8_t *memory, *frames[2]; /* two segments: this one and the one before */
    noh_transform *pose;
    float *floats;
    space_global *raw, *lossy;
    double max_error, worst_part, square, max_float;
    double shares; /* the sum of all squares, as shares of bounds */
    uint64_t samples;
    uint32_t joint, time_parts;
} certifier;

static int open_blob(certifier *c, const byte_buffer *blob, size_t begin)
{
    encoder *e = c->e;
    noh_clip_desc desc;
    size_t size;
    memset(&desc, 0, sizeof desc);
    desc.bytes = blob->bytes + begin;
    desc.byte_count = blob->count - begin;
    desc.bind = e->bind;
    desc.joint_count = e->joint_count;
    size = noh_clip_size(&desc, NULL);
    c->memory = size ? enc_alloc(e, size, 1) : NULL;
    c->pose = enc_alloc(e, e->joint_count, sizeof *c->pose);
    c->floats = enc_alloc(e, e->float_count, sizeof *c->floats);
    c->raw = enc_alloc(e, e->joint_count, sizeof *c->raw);
    c->lossy = enc_alloc(e, e->joint_count, sizeof *c->lossy);
    if (!c->memory || !c->pose || !c->floats || !c->raw || !c->lossy) return 1;
    if (noh_clip_init(c->memory, size, &desc, &c->clip, NULL) != NOH_OK)
        return enc_fail(e, "the decoder rejects the encoded clip");
    for (int i = 0; i < 2; i++) {
        c->frames[i] = enc_alloc(e, c->clip->info.segment_bytes_max, 1);
        if (!c->frames[i]) return 1;
    }
    return 0;
}

static void measure_joints(certifier *c, uint32_t frame, double fraction, uint32_t time_parts)
{
    const encoder *e = c->e;
    for (uint32_t j = 0; j < e->joint_count; j++) {
        const uint32_t parent = e->joints[j].parent;
        const noh_transform *t = &c->pose[j];
        space_local raw, l;
        double d;
        space_between(enc_local(e, frame, j), enc_local(e, fraction > 0.0 ? frame + 1u : frame, j), fraction, &raw);
        for (int i = 0; i < 4; i++) l.q[i] = (double)t->rotation[i];
        for (int i = 0; i < 3; i++) l.t[i] = (double)t->translation[i];
        for (int i = 0; i < 3; i++) l.s[i] = (double)t->scale[i];
        space_unit(l.q);
        space_compose(enc_parent(c->raw, parent), &raw, &c->raw[j]);
        space_compose(enc_parent(c->lossy, parent), &l, &c->lossy[j]);
        d = enc_error(e, j, &c->raw[j], &c->lossy[j]);
        c->square += d * d;
        c->shares += d * d / (e->joints[j].bound * e->joints[j].bound);
        c->samples++;
        if (!(d * e->tight / e->joints[j].bound <= c->worst_part)) c->worst_part = d * e->tight / e->joints[j].bound;
        if (!(d <= c->max_error)) {
            c->max_error = d;
            c->joint = j;
            c->time_parts = time_parts;
        }
    }
}

static void measure_floats(certifier *c, uint32_t frame, double fraction)
{
    const encoder *e = c->e;
    for (uint32_t i = 0; i < e->float_count; i++) {
        const double a = (double)e->floats[(size_t)frame * e->float_count + i];
        const double b = fraction > 0.0 ? (double)e->floats[(size_t)(frame + 1u) * e->float_count + i] : a;
        const double d = fabs(a + (b - a) * fraction - (double)c->floats[i]) / e->float_bounds[i];
        c->shares += d * d;
        if (!(d <= c->max_float)) c->max_float = d;
    }
}

/* Where a frame lies between two ticks, it is shown at the nearer one, at which the raw clip has moved on. The bound is
 * for the frame's own time; the certificate includes this. */
static void measure_tick(certifier *c, uint32_t frame)
{
    const encoder *e = c->e;
    const double rate = e->clip->sample_rate_hz, last = (double)c->clip->info.duration_ticks;
    const double tick = fmin(floor((double)frame * NOH_CLIP_TICKS_PER_SECOND / rate + 0.5), last);
    const double offset = tick * rate / NOH_CLIP_TICKS_PER_SECOND - (double)frame;
    const uint32_t from = offset < 0.0 ? frame - 1u : frame;
    if (fabs(offset) < 1e-9 || from + 1u >= e->frame_count) return;
    for (uint32_t j = 0; j < e->joint_count; j++) {
        space_local raw;
        double d;
        space_between(enc_local(e, from, j), enc_local(e, from + 1u, j), offset < 0.0 ? 1.0 + offset : offset, &raw);
        space_compose(enc_parent(c->raw, e->joints[j].parent), &raw, &c->raw[j]);
        d = enc_error(e, j, &c->raw[j], &c->lossy[j]);
        if (d > c->max_error) {
            c->max_error = d;
            c->joint = j;
            c->time_parts = frame * ENC_PARTS;
        }
    }
}

static void measure(certifier *c, const uint8_t *a, const uint8_t *b, uint32_t frame, uint32_t part)
{
    const double fraction = (double)part / ENC_PARTS;
    noh_clip_blend_frames(c->clip, a, b, (float)fraction, c->e->joint_count, c->pose, c->floats);
    measure_joints(c, frame, fraction, frame * ENC_PARTS + part);
    measure_floats(c, frame, fraction);
    if (!part) measure_tick(c, frame);
}

static void measure_segment(certifier *c, uint32_t s)
{
    const encoder *e = c->e;
    const enc_segment *segment = &e->segments[s];
    const size_t stride = c->clip->frame_bytes;
    uint8_t *frames = c->frames[s % 2u];
    const uint8_t *before = s ? c->frames[(s + 1u) % 2u] + (e->segments[s - 1u].count - 1u) * stride : NULL;
    noh_clip_cursor cursor = noh_clip_cursor_at(c->clip, s);
    noh_clip_decode(c->clip, &e->bases[segment->count], &cursor, c->clip->info.track_count, frames);
    for (uint32_t f = 0; f < segment->count; f++) {
        const uint8_t *here = frames + f * stride;
        for (uint32_t part = 1; before && part < ENC_PARTS; part++)
            measure(c, before, here, segment->first + f - 1u, part);
        measure(c, here, here, segment->first + f, 0);
        before = here;
    }
}

static void free_certifier(certifier *c)
{
    free(c->memory);
    free(c->frames[0]);
    free(c->frames[1]);
    free(c->pose);
    free(c->floats);
    free(c->raw);
    free(c->lossy);
}

int enc_certify(encoder *e, const byte_buffer *blob, size_t begin, double *worst_part, double *max_error,
                double *rms_error, uint32_t *joint, uint32_t *time_parts)
{
    certifier c;
    memset(&c, 0, sizeof c);
    c.e = e;
    if (open_blob(&c, blob, begin)) {
        free_certifier(&c);
        return 1;
    }
    for (uint32_t s = 0; s < e->segment_count; s++) measure_segment(&c, s);
    *worst_part = c.worst_part > c.max_float ? c.worst_part : c.max_float;
    *max_error = c.max_error * e->unit_cm;
    *rms_error = c.samples ? sqrt(c.square / (double)c.samples) * e->unit_cm : 0.0;
    *joint = c.joint;
    *time_parts = c.time_parts;
    e->report.max_float_error = c.max_float;
    e->report.track_count = c.clip->info.track_count;
    free_certifier(&c);
    return 0;
}

/* ---- which segments are split ---- */

#define SPLIT_FRAMES_MIN 16u
/* How much more a halved clip may be off for a split, and how many bounds on top. Segments without jumps are at 2.4 and
 * less, those with one at 9 and more. */
#define SPLIT_WORSE 3.0
#define SPLIT_BOUNDS 2.0

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Half of a segment's frames at `frames` (slots_only: the buffer holds only these), with blends between them, against
 * the raw frames. Returns the error of a frame, rms of joints and floats, in bounds, at the upper quartile: a few
 * frames near a jump always have large errors, which would hide the errors of the others. */
static double halved_error(certifier *c, const enc_segment *s, const uint8_t *frames, int slots_only)
{
    const encoder *e = c->e;
    const size_t stride = c->clip->frame_bytes;
    const uint32_t slots = noh_clip_slots(s->count, 1);
    double errors[ENC_FRAMES_MAX];
    for (uint32_t f = 0; f < s->count; f++) {
        const uint32_t slot = noh_clip_slot_of(f, s->count, 1), next = slot + 1u < slots ? slot + 1u : slot;
        const uint32_t a = noh_clip_slot_frame(slot, s->count, 1), b = noh_clip_slot_frame(next, s->count, 1);
        const float fraction = b > a ? (float)(f - a) / (float)(b - a) : 0.0f;
        noh_clip_blend_frames(c->clip, frames + (slots_only ? slot : a) * stride,
                              frames + (slots_only ? next : b) * stride, fraction, e->joint_count, c->pose, c->floats);
        c->shares = 0.0;
        measure_joints(c, s->first + f, 0.0, 0);
        measure_floats(c, s->first + f, 0.0);
        errors[f] = sqrt(c->shares / (double)(e->joint_count + e->float_count));
    }
    qsort(errors, s->count, sizeof *errors, by_size);
    return errors[s->count * 3u / 4u];
}

/* Who plays half of the frames blends those between, and hardly loses more by leaving out the high frequencies, too: on
 * captured motion joints are off by 0.8 to 1.15 times as much (rms), and move more smoothly. About a jump it would ring
 * through the whole segment, so there they stay. */
static void choose_split(certifier *c, uint32_t index)
{
    enc_segment *s = &c->e->segments[index];
    noh_clip_basis basis = c->e->bases[s->count];
    noh_clip_cursor cursor = noh_clip_cursor_at(c->clip, index);
    double with, without;
    if (!s->split) return;
    noh_clip_decode(c->clip, &basis, &cursor, c->clip->info.track_count, c->frames[0]);
    basis.halved = 1;
    cursor = noh_clip_cursor_at(c->clip, index);
    noh_clip_decode(c->clip, &basis, &cursor, c->clip->info.track_count, c->frames[1]);
    with = halved_error(c, s, c->frames[0], 0);
    without = halved_error(c, s, c->frames[1], 1);
    s->split = without <= SPLIT_WORSE * with + SPLIT_BOUNDS;
}

int enc_choose_splits(encoder *e)
{
    certifier c;
    byte_buffer all;
    int failed;
    memset(&c, 0, sizeof c);
    memset(&all, 0, sizeof all);
    c.e = e;
    if (e->clip->sample_rate_hz < e->options.split_hz) return 0;
    for (uint32_t s = 0; s < e->segment_count; s++) e->segments[s].split = e->segments[s].count >= SPLIT_FRAMES_MIN;
    e->splits = 1;
    failed = enc_write(e, 0.0, 0.0, 0, 0, &all) || open_blob(&c, &all, 0);
    e->splits = 0;
    for (uint32_t s = 0; s < e->segment_count && !failed; s++) {
        choose_split(&c, s);
        e->splits |= e->segments[s].split;
    }
    free_certifier(&c);
    buffer_free(&all);
    return failed;
}
