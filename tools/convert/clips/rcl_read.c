#include "rcl.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "convert/base/byte_buffer.h"
#include "convert/base/input_file.h"
#include "convert/model/model_build.h"
#include "raw_set.h"

typedef struct rcl_reader {
    const uint8_t *bytes;
    size_t size, at;
    raw_set *set;
    uint8_t *flags; /* [joint_count] */
    float *first;   /* [joint_count][10] */
    model_error *error;
} rcl_reader;

static int refuse(rcl_reader *r, size_t at, const char *what)
{
    char where[32];
    (void)snprintf(where, sizeof where, "byte %zu", at);
    return model_fail(r->error, where, "%s", what);
}

static int out_of_memory(rcl_reader *r)
{
    return refuse(r, r->at, "there is not enough memory to read this clip");
}

/* The next bytes, or NULL past the end. */
static const uint8_t *take(rcl_reader *r, size_t count)
{
    const uint8_t *bytes = r->bytes + r->at;
    if (count > r->size - r->at) {
        refuse(r, r->at, "the file ends too early");
        return NULL;
    }
    r->at += count;
    return bytes;
}

static int take_u32(rcl_reader *r, uint32_t *out)
{
    const uint8_t *b = take(r, 4);
    if (!b) return 1;
    *out = byte_word(b);
    return 0;
}

static int take_floats(rcl_reader *r, size_t count, float *out)
{
    for (size_t i = 0; i < count; ++i) {
        uint32_t bits;
        if (take_u32(r, &bits)) return 1;
        memcpy(out + i, &bits, sizeof bits);
        if (!isfinite(out[i])) return refuse(r, r->at - 4, "the number is not finite");
        if (fabsf(out[i]) > NOH_NUMBER_MAX) return refuse(r, r->at - 4, "the number is larger than 1e12");
    }
    return 0;
}

/* Kept as stored, to the last bit; what cannot be a rotation is refused. */
static int take_rotation(rcl_reader *r, float *q)
{
    size_t at = r->at;
    if (take_floats(r, 4, q)) return 1;
    double square = 0.0;
    for (int i = 0; i < 4; ++i) square += (double)q[i] * (double)q[i];
    return fabs(square - 1.0) <= 1e-3 ? 0 : refuse(r, at, "the rotation is not a unit quaternion");
}

static int take_string(rcl_reader *r, char **out)
{
    uint32_t length;
    if (take_u32(r, &length)) return 1;
    const uint8_t *b = take(r, length);
    if (!b) return 1;
    if (memchr(b, 0, length)) return refuse(r, r->at - length, "the name holds a zero byte");
    *out = malloc((size_t)length + 1);
    if (!*out) return out_of_memory(r);
    memcpy(*out, b, length);
    (*out)[length] = '\0';
    return 0;
}

static int check_counts(rcl_reader *r, uint32_t joints, uint32_t frames, double sample_rate_hz)
{
    char what[128];
    if (joints == 0 || joints > RAW_JOINTS_MAX) {
        (void)snprintf(what, sizeof what, "the file has %u joints: it must have 1 to %u", joints, RAW_JOINTS_MAX);
        return refuse(r, 4, what);
    }
    if (frames == 0 || frames > RAW_FRAMES_MAX || (uint64_t)frames * joints * RAW_JOINT_BYTES > RAW_BYTES_MAX) {
        (void)snprintf(what, sizeof what,
                       "%u frames of %u joints are too many, or none: the limits are 1 to %u frames and %u MiB in all",
                       frames, joints, RAW_FRAMES_MAX, (uint32_t)(RAW_BYTES_MAX >> 20));
        return refuse(r, 8, what);
    }
    return sample_rate_hz >= 1e-3 && sample_rate_hz <= 1e6 ? 0 : refuse(r, 12, "the rate must be 0.001 to 1000000 Hz");
}

static int read_header(rcl_reader *r)
{
    uint32_t joints, frames;
    float sample_rate_hz;
    char *name = NULL;
    const uint8_t *magic = take(r, 4);
    if (!magic) return 1;
    if (memcmp(magic, "RCL1", 4) != 0) return refuse(r, 0, "this is not a .rcl file: it does not start with 'RCL1'");
    if (take_u32(r, &joints) || take_u32(r, &frames) || take_floats(r, 1, &sample_rate_hz) ||
        check_counts(r, joints, frames, (double)sample_rate_hz) || take_string(r, &name))
        return 1;
    r->set = raw_set_new(joints, 1);
    r->flags = model_zeros(joints, 1);
    r->first = model_zeros(joints, RAW_JOINT_BYTES);
    if (!r->set || !r->flags || !r->first) {
        free(name);
        return out_of_memory(r);
    }
    r->set->clips[0].name = name;
    r->set->clips[0].sample_rate_hz = (double)sample_rate_hz;
    r->set->clips[0].frame_count = frames;
    r->set->skeleton.name = model_string("skeleton");
    return r->set->skeleton.name ? 0 : out_of_memory(r);
}

static int take_transform(rcl_reader *r, float *q, float *t, float *s)
{
    return take_rotation(r, q) || take_floats(r, 3, t) || take_floats(r, 3, s);
}

static int read_joint(rcl_reader *r, uint32_t j)
{
    raw_joint *joint = &r->set->skeleton.joints[j];
    float *first = r->first + (size_t)j * 10;
    uint32_t flags;
    if (take_u32(r, &joint->parent)) return 1;
    if (joint->parent != MODEL_NONE && joint->parent >= j)
        return refuse(r, r->at - 4, "the parent is not an earlier joint");
    if (take_u32(r, &flags)) return 1;
    if (flags > 7) return refuse(r, r->at - 4, "the flags are unknown");
    r->flags[j] = (uint8_t)flags;
    return take_string(r, &joint->name) || take_transform(r, joint->rotation, joint->translation, joint->scale) ||
           take_transform(r, first, first + 4, first + 7);
}

static int read_sample(rcl_reader *r, uint32_t j, float *q, float *t, float *s)
{
    const float *first = r->first + (size_t)j * 10;
    memcpy(q, first, 4 * sizeof *q);
    memcpy(t, first + 4, 3 * sizeof *t);
    memcpy(s, first + 7, 3 * sizeof *s);
    return (r->flags[j] & 1 && take_rotation(r, q)) || (r->flags[j] & 2 && take_floats(r, 3, t)) ||
           (r->flags[j] & 4 && take_floats(r, 3, s));
}

/* Checked before frames are allocated: a short file must not claim much memory. */
static int check_frame_bytes(rcl_reader *r)
{
    const uint64_t frames = r->set->clips[0].frame_count;
    uint64_t per_frame = 0, left = r->size - r->at;
    for (uint32_t j = 0; j < r->set->skeleton.joint_count; ++j)
        per_frame += (r->flags[j] & 1 ? 16u : 0u) + (r->flags[j] & 2 ? 12u : 0u) + (r->flags[j] & 4 ? 12u : 0u);
    if (left < frames * per_frame) return refuse(r, r->size, "the file ends before the end of its last frame");
    return left == frames * per_frame ? 0
                                      : refuse(r, r->at + (size_t)(frames * per_frame), "bytes follow the last frame");
}

static int read_frames(rcl_reader *r)
{
    raw_clip *clip = &r->set->clips[0];
    const size_t joints = r->set->skeleton.joint_count;
    if (check_frame_bytes(r)) return 1;
    if (raw_clip_alloc(clip, clip->frame_count, (uint32_t)joints)) return out_of_memory(r);
    for (size_t i = 0; i < joints * clip->frame_count; ++i)
        if (read_sample(r, (uint32_t)(i % joints), clip->rotations + i * 4, clip->translations + i * 3,
                        clip->scales + i * 3))
            return 1;
    return 0;
}

static int read_all(rcl_reader *r)
{
    if (read_header(r)) return 1;
    for (uint32_t j = 0; j < r->set->skeleton.joint_count; ++j)
        if (read_joint(r, j)) return 1;
    return read_frames(r);
}

int rcl_read(const char *path, raw_set **out, model_error *error)
{
    rcl_reader r = { 0 };
    *out = NULL;
    r.error = error;
    char *bytes = input_read(path, &r.size, error);
    if (!bytes) return 1;
    r.bytes = (const uint8_t *)bytes;
    int failed = read_all(&r);
    if (failed)
        raw_set_free(r.set);
    else
        *out = r.set;
    free(r.flags);
    free(r.first);
    free(bytes);
    return failed;
}
