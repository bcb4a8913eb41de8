#include "clip_write.h"

#include "shared/grab.h"
#include "mask/targets.h"

#include <stdlib.h>

typedef struct {
    Writer *w;
    Buffer samplers, channels;
    int count, frames, times;
} Animation;

static void add_channel(Animation *animation, const double *values, const char *type, int width, int node,
                        const char *path)
{
    int scalars = width > 4, n = animation->count++;
    int output = write_floats(animation->w, values, scalars ? animation->frames * width : animation->frames, type,
                              scalars ? 1 : width, TARGET_NONE);
    buffer_print(&animation->samplers, "%s{\"input\":%d,\"output\":%d}", n ? ",\n" : "", animation->times, output);
    buffer_print(&animation->channels, "%s{\"sampler\":%d,\"target\":{\"node\":%d,\"path\":\"%s\"}}", n ? ",\n" : "", n,
                 node, path);
}

/* Signs are chosen so that neighbouring keys are in one hemisphere. */
static void add_turns(Animation *animation, const Posed *frames, int joint)
{
    double *values = grab(NULL, 4 * animation->frames, (int)sizeof *values);
    double last[4] = { 0, 0, 0, 1 };
    int turns = 0;
    for (int i = 0; i < animation->frames; i++) {
        Quat q = frames[i].turn[joint];
        double sign = q.x * last[0] + q.y * last[1] + q.z * last[2] + q.w * last[3] < 0 ? -1 : 1;
        double members[4] = { sign * q.x, sign * q.y, sign * q.z, sign * q.w };
        for (int k = 0; k < 4; k++) {
            values[4 * i + k] = last[k] = members[k];
        }
        turns |= members[0] != 0 || members[1] != 0 || members[2] != 0;
    }
    if (turns) {
        add_channel(animation, values, "VEC4", 4, joint, "rotation");
    }
    free(values);
}

static void add_places(Animation *animation, const Posed *frames, int joint)
{
    double *values = grab(NULL, 3 * animation->frames, (int)sizeof *values);
    for (int i = 0; i < animation->frames; i++) {
        V3 place = joint == ROOT ? frames[i].root : frames[i].hips;
        values[3 * i] = place.x;
        values[3 * i + 1] = place.y;
        values[3 * i + 2] = place.z;
    }
    add_channel(animation, values, "VEC3", 3, joint, "translation");
    free(values);
}

/* As with the joints, the last frame is the first one. */
static void add_face(Animation *animation, const Clip *clip, int node)
{
    int targets = MASK_TARGETS;
    double *values = grab(NULL, targets * animation->frames, (int)sizeof *values);
    for (int i = 0; i < targets * animation->frames; i++) {
        values[i] = 0;
    }
    for (int i = 0; i < animation->frames; i++) {
        clip->face((double)(i % clip->steps) / CLIP_RATE_HZ, &values[i * targets]);
    }
    add_channel(animation, values, "SCALAR", targets, node, "weights");
    free(values);
}

static int write_times(Writer *w, int frames)
{
    double *times = grab(NULL, frames, (int)sizeof *times);
    for (int i = 0; i < frames; i++) {
        times[i] = (double)i / CLIP_RATE_HZ;
    }
    int accessor = write_scalars(w, times, frames, 1);
    free(times);
    return accessor;
}

/* The syntax is the converter's. */
static void write_cues(Buffer *json, const Clip *clip)
{
    Cue cues[CUES_MAX];
    int count = clip->cues ? clip->cues(cues) : 0;
    buffer_print(json, ",\"extras\":{\"loop\":%s", clip->once ? "false" : "true");
    for (int i = 0; i < count; i++) {
        buffer_print(json, "%s{\"time\":%.6g,\"name\":\"%s\"", i ? ",\n" : ",\"events\":[", cues[i].time_s,
                     cues[i].name);
        if (cues[i].payload >= 0) {
            buffer_print(json, ",\"payload\":%d", cues[i].payload);
        }
        buffer_print(json, "}");
    }
    buffer_print(json, count ? "]}" : "}");
}

void clip_write(Writer *w, Buffer *json, const Clip *clip, int mask_node)
{
    Animation animation = { .w = w, .frames = clip->steps + 1 };
    Posed *frames = grab(NULL, animation.frames, (int)sizeof *frames);
    for (int i = 0; i < animation.frames; i++) {
        frames[i] = clip_frame(clip, i);
    }
    animation.times = write_times(w, animation.frames);
    add_places(&animation, frames, ROOT);
    add_places(&animation, frames, HIPS);
    for (int joint = 0; joint < JOINT_COUNT; joint++) {
        add_turns(&animation, frames, joint);
    }
    if (clip->face) {
        add_face(&animation, clip, mask_node);
    }
    buffer_print(json, "{\"name\":\"%s\",\"samplers\":[", clip->name);
    buffer_append(json, &animation.samplers);
    buffer_print(json, "],\n\"channels\":[");
    buffer_append(json, &animation.channels);
    buffer_print(json, "]");
    write_cues(json, clip);
    buffer_print(json, "}");
    buffer_free(&animation.samplers);
    buffer_free(&animation.channels);
    free(frames);
}
