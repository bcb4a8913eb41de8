#include "resample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "convert/base/quat.h"
#include "raw_set.h"

/* Between two frames of the source: frame + part. */
typedef struct place {
    size_t frame, next;
    double part;
} place;

static void mix(const float *values, size_t stride, const place *at, float *out, size_t count)
{
    const float *a = values + at->frame * stride, *b = values + at->next * stride;
    if (at->part == 0.0) {
        memcpy(out, a, count * sizeof *out);
        return;
    }
    for (size_t i = 0; i < count; ++i) out[i] = (float)((double)a[i] + ((double)b[i] - (double)a[i]) * at->part);
}

static void mix_rotation(const float *a, const float *b, double part, float *out)
{
    double from[4], to[4], between[4];
    for (int i = 0; i < 4; ++i) {
        from[i] = (double)a[i];
        to[i] = (double)b[i];
    }
    quat_nlerp(from, to, part, between);
    for (int i = 0; i < 4; ++i) out[i] = (float)between[i];
}

static void mix_rotations(const raw_clip *clip, const place *at, float *out)
{
    const size_t count = (size_t)clip->joint_count * 4;
    const float *a = clip->rotations + at->frame * count, *b = clip->rotations + at->next * count;
    if (at->part == 0.0) memcpy(out, a, count * sizeof *out);
    for (size_t i = 0; at->part != 0.0 && i < count; i += 4) mix_rotation(a + i, b + i, at->part, out + i);
}

/* Jumps of sign in the source's quaternions are not passed on. */
static void align_rotations(raw_clip *clip)
{
    const size_t count = (size_t)clip->joint_count * 4;
    for (size_t i = count; i < count * clip->frame_count; i += 4) {
        float *q = clip->rotations + i;
        const float *before = q - count;
        if (q[0] * before[0] + q[1] * before[1] + q[2] * before[2] + q[3] * before[3] < 0.0f)
            for (int k = 0; k < 4; ++k) q[k] = -q[k];
    }
}

static void fill_frame(const raw_clip *clip, const place *at, size_t frame, raw_clip *out)
{
    const size_t joints = clip->joint_count;
    mix_rotations(clip, at, out->rotations + frame * joints * 4);
    mix(clip->translations, joints * 3, at, out->translations + frame * joints * 3, joints * 3);
    mix(clip->scales, joints * 3, at, out->scales + frame * joints * 3, joints * 3);
    for (uint32_t i = 0; i < clip->float_count; ++i) {
        const size_t width = clip->floats[i].width;
        mix(clip->floats[i].values, width, at, out->floats[i].values + frame * width, width);
    }
}

static int copy_floats_shape(const raw_floats *from, uint32_t frame_count, raw_floats *out)
{
    if (raw_floats_alloc(out, frame_count, from->width)) return 1;
    out->node = from->node;
    out->name = model_string(from->name ? from->name : "");
    if (from->radius) {
        out->radius = model_zeros(from->width, sizeof(float));
        if (!out->radius) return 1;
        memcpy(out->radius, from->radius, from->width * sizeof(float));
    }
    return !out->name;
}

static int copy_events(const raw_clip *clip, raw_clip *out)
{
    for (uint32_t i = 0; i < clip->event_count; ++i) {
        raw_event event = clip->events[i];
        event.time_s = fmin(event.time_s, raw_clip_duration_s(out));
        if (raw_clip_add_event(out, &event)) return 1;
    }
    return 0;
}

/* All but the frames' values. */
static int copy_shape(const raw_clip *clip, uint32_t frame_count, double sample_rate_hz, raw_clip *out)
{
    memset(out, 0, sizeof *out);
    out->sample_rate_hz = sample_rate_hz;
    out->loop = clip->loop;
    out->source_error_cm = clip->source_error_cm;
    out->name = model_string(clip->name ? clip->name : "");
    out->floats = model_zeros(clip->float_count, sizeof *out->floats);
    if (!out->name || !out->floats || raw_clip_alloc(out, frame_count, clip->joint_count)) return 1;
    for (uint32_t i = 0; i < clip->float_count; ++i) {
        out->float_count = i + 1;
        if (copy_floats_shape(&clip->floats[i], frame_count, &out->floats[i])) return 1;
    }
    return copy_events(clip, out);
}

/* Frame i of the copy lies at i * steps_from / steps_to frames of the source; integer quotient and remainder are exact.
 */
static int copy_frames(const raw_clip *clip, uint32_t frame_count, double sample_rate_hz, uint64_t steps_from,
                       uint64_t steps_to, raw_clip *out, model_error *error)
{
    if (copy_shape(clip, frame_count, sample_rate_hz, out)) {
        raw_clip_clear(out);
        return model_fail(error, "", "there is not enough memory to resample this clip");
    }
    for (uint64_t i = 0; i < frame_count; ++i) {
        place at;
        at.frame = (size_t)(i * steps_from / steps_to);
        at.part = (double)(i * steps_from % steps_to) / (double)steps_to;
        at.next = at.part > 0.0 ? at.frame + 1 : at.frame;
        fill_frame(clip, &at, (size_t)i, out);
    }
    align_rotations(out);
    return 0;
}

static uint64_t bytes_per_frame(const raw_clip *clip)
{
    uint64_t bytes = (uint64_t)clip->joint_count * RAW_JOINT_BYTES + 1;
    for (uint32_t i = 0; i < clip->float_count; ++i) bytes += (uint64_t)clip->floats[i].width * sizeof(float);
    return bytes;
}

int raw_clip_resample(const raw_clip *clip, double sample_rate_hz, raw_clip *out, model_error *error)
{
    const double duration_s = raw_clip_duration_s(clip), steps = fmax(floor(duration_s * sample_rate_hz + 0.5), 1.0);
    memset(out, 0, sizeof *out);
    if (!(sample_rate_hz > 0.0 && sample_rate_hz <= 1e6))
        return model_fail(error, "", "the sample rate must be above 0 and at most 1000000 Hz, not %g", sample_rate_hz);
    if (duration_s == 0.0) return copy_frames(clip, 1, sample_rate_hz, 0, 1, out, error);
    if (steps + 1.0 > (double)RAW_FRAMES_MAX || steps * (double)bytes_per_frame(clip) > (double)RAW_BYTES_MAX)
        return model_fail(error, "",
                          "at %g Hz the clip's %g s are more frames than the limit; ask for a lower sample rate",
                          sample_rate_hz, duration_s);
    return copy_frames(clip, (uint32_t)steps + 1, steps / duration_s, clip->frame_count - 1, (uint64_t)steps, out,
                       error);
}

int raw_clip_decimate(const raw_clip *clip, uint32_t step, raw_clip *out, model_error *error)
{
    memset(out, 0, sizeof *out);
    if (step == 0) return model_fail(error, "", "the step between frames must be 1 or more");
    return copy_frames(clip, (clip->frame_count - 1) / step + 1, clip->sample_rate_hz / (double)step, step, 1, out,
                       error);
}
