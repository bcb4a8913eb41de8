#include "source_pose.h"

#include <math.h>
#include <string.h>

#include "convert/base/quat.h"
#include "convert/clips/channel_sample.h"
#include "convert/clips/raw_set.h"

void source_rest(const raw_skeleton *skeleton, double *locals)
{
    for (uint32_t j = 0; j < skeleton->joint_count; j++) {
        const raw_joint *joint = &skeleton->joints[j];
        double *l = locals + SOURCE_LOCAL * (size_t)j;
        for (int i = 0; i < 4; i++) l[i] = (double)joint->rotation[i];
        for (int i = 0; i < 3; i++) {
            l[4 + i] = (double)joint->translation[i];
            l[7 + i] = (double)joint->scale[i];
        }
        (void)quat_normalize(l);
    }
}

void source_channel(const model_channel *channel, uint32_t joint, double time_s, double snap_s, double *locals)
{
    static const uint32_t places[4] = { 0, 4, 0, 7 }; /* by model_path; weights belong to meshes */
    (void)channel_sample(channel, time_s, snap_s, locals + SOURCE_LOCAL * (size_t)joint + places[channel->path]);
}

void source_joints(const raw_skeleton *skeleton, const model_clip *clip, uint32_t *out)
{
    for (uint32_t i = 0; i < clip->channel_count; i++) {
        uint32_t j = 0;
        while (j < skeleton->joint_count && skeleton->joints[j].node != clip->channels[i].node) j++;
        out[i] = j < skeleton->joint_count && clip->channels[i].path != MODEL_PATH_WEIGHTS ? j : MODEL_NONE;
    }
}

static void frame_locals(const raw_clip *clip, uint32_t frame, uint32_t joint, double *l)
{
    const size_t at = (size_t)frame * clip->joint_count + joint;
    for (size_t i = 0; i < 4; i++) l[i] = (double)clip->rotations[at * 4u + i];
    for (size_t i = 0; i < 3; i++) {
        l[4 + i] = (double)clip->translations[at * 3u + i];
        l[7 + i] = (double)clip->scales[at * 3u + i];
    }
    (void)quat_normalize(l);
}

static void played_locals(const raw_clip *clip, double time_s, double *locals)
{
    const double last = (double)(clip->frame_count - 1u), at = fmin(fmax(time_s * clip->sample_rate_hz, 0.0), last);
    const uint32_t frame = (uint32_t)at, next = frame + 1u < clip->frame_count ? frame + 1u : frame;
    for (uint32_t j = 0; j < clip->joint_count; j++) {
        double a[SOURCE_LOCAL], b[SOURCE_LOCAL];
        frame_locals(clip, frame, j, a);
        frame_locals(clip, next, j, b);
        source_blend(1, a, b, at - (double)frame, locals + SOURCE_LOCAL * (size_t)j);
    }
}

void source_locals(const raw_clip *clip, const uint32_t *joints, double time_s, double *locals)
{
    if (!clip->source) {
        played_locals(clip, time_s, locals);
        return;
    }
    for (uint32_t i = 0; i < clip->source->channel_count; i++) {
        if (joints[i] != MODEL_NONE) source_channel(&clip->source->channels[i], joints[i], time_s, 0.0, locals);
    }
}

void source_blend(uint32_t joint_count, const double *a, const double *b, double at, double *out)
{
    for (size_t j = 0; j < joint_count; j++) {
        const double *x = a + SOURCE_LOCAL * j, *y = b + SOURCE_LOCAL * j;
        double *o = out + SOURCE_LOCAL * j;
        quat_nlerp(x, y, at, o);
        for (uint32_t i = 4; i < SOURCE_LOCAL; i++) o[i] = x[i] + (y[i] - x[i]) * at;
    }
}

void source_object(const raw_skeleton *skeleton, const double *locals, double *pose)
{
    for (uint32_t j = 0; j < skeleton->joint_count; j++) {
        const double *l = locals + SOURCE_LOCAL * (size_t)j;
        double matrix[12];
        quat_columns(l, matrix);
        for (int i = 0; i < 9; i++) matrix[i] *= l[7 + i / 3];
        memcpy(matrix + 9, l + 4, 3 * sizeof *matrix);
        raw_pose_below(skeleton->joints[j].parent, matrix, j, pose);
    }
}
