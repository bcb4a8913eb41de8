#include "rcl.h"

#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "convert/base/byte_buffer.h"
#include "platform.h"

static void put_u32(byte_buffer *b, uint32_t value)
{
    const uint8_t bytes[4] = { (uint8_t)value, (uint8_t)(value >> 8), (uint8_t)(value >> 16), (uint8_t)(value >> 24) };
    buffer_append(b, bytes, sizeof bytes);
}

static void put_floats(byte_buffer *b, const float *values, size_t count, double factor)
{
    for (size_t i = 0; i < count; ++i) {
        float scaled = (float)((double)values[i] * factor); /* by 1: the same bits */
        uint32_t bits;
        memcpy(&bits, &scaled, sizeof bits);
        put_u32(b, bits);
    }
}

static void put_string(byte_buffer *b, const char *text)
{
    const size_t length = text ? strlen(text) : 0;
    put_u32(b, (uint32_t)length);
    if (length) buffer_append(b, text, length);
}

/* One kind of track of one joint over all frames. */
static uint32_t moves(const raw_clip *clip, const float *values, size_t width, uint32_t joint)
{
    const float *first = values + joint * width;
    for (size_t frame = 1; frame < clip->frame_count; ++frame)
        if (memcmp(first, first + frame * clip->joint_count * width, width * sizeof(float)) != 0) return 1;
    return 0;
}

static uint32_t flags_of(const raw_clip *clip, uint32_t joint)
{
    return moves(clip, clip->rotations, 4, joint) | moves(clip, clip->translations, 3, joint) << 1 |
           moves(clip, clip->scales, 3, joint) << 2;
}

static void put_joint(byte_buffer *b, const raw_skeleton *skeleton, const raw_clip *clip, uint32_t j, uint32_t flags)
{
    const raw_joint *joint = &skeleton->joints[j];
    put_u32(b, joint->parent);
    put_u32(b, flags);
    put_string(b, joint->name);
    put_floats(b, joint->rotation, 4, 1.0);
    put_floats(b, joint->translation, 3, skeleton->unit_cm);
    put_floats(b, joint->scale, 3, 1.0);
    put_floats(b, clip->rotations + (size_t)j * 4, 4, 1.0);
    put_floats(b, clip->translations + (size_t)j * 3, 3, skeleton->unit_cm);
    put_floats(b, clip->scales + (size_t)j * 3, 3, 1.0);
}

static void put_frames(byte_buffer *b, const raw_skeleton *skeleton, const raw_clip *clip, const uint8_t *flags)
{
    const size_t joints = clip->joint_count;
    for (size_t i = 0; i < joints * clip->frame_count; ++i) {
        const uint8_t f = flags[i % joints];
        if (f & 1) put_floats(b, clip->rotations + i * 4, 4, 1.0);
        if (f & 2) put_floats(b, clip->translations + i * 3, 3, skeleton->unit_cm);
        if (f & 4) put_floats(b, clip->scales + i * 3, 3, 1.0);
    }
}

static void put_clip(byte_buffer *b, const raw_skeleton *skeleton, const raw_clip *clip, uint8_t *flags)
{
    const float sample_rate_hz = (float)clip->sample_rate_hz;
    buffer_append(b, "RCL1", 4);
    put_u32(b, clip->joint_count);
    put_u32(b, clip->frame_count);
    put_floats(b, &sample_rate_hz, 1, 1.0);
    put_string(b, clip->name);
    for (uint32_t j = 0; j < clip->joint_count; ++j) {
        flags[j] = (uint8_t)flags_of(clip, j);
        put_joint(b, skeleton, clip, j, flags[j]);
    }
    put_frames(b, skeleton, clip, flags);
}

static int write_bytes(const char *path, const byte_buffer *b, model_error *error)
{
    noh_error reason;
    if (b->failed) return model_fail(error, "", "there is not enough memory to write this clip");
    if (noh_file_write(path, b->bytes, b->count, &reason) != NOH_OK)
        return model_fail(error, "", "the file cannot be written: %s", reason.what);
    return 0;
}

int rcl_write(const char *path, const raw_skeleton *skeleton, const raw_clip *clip, model_error *error)
{
    byte_buffer b = { 0 };
    if (clip->joint_count == 0 || clip->joint_count != skeleton->joint_count)
        return model_fail(error, "", "the clip moves no joints, and .rcl files hold only joints");
    uint8_t *flags = model_zeros(clip->joint_count, 1);
    if (!flags) return model_fail(error, "", "there is not enough memory to write this clip");
    put_clip(&b, skeleton, clip, flags);
    int failed = write_bytes(path, &b, error);
    buffer_free(&b);
    free(flags);
    return failed;
}
