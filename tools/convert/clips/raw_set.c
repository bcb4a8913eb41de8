#include "raw_set.h"

#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"

int raw_skeleton_alloc(raw_skeleton *skeleton, uint32_t joint_count)
{
    skeleton->joints = model_zeros(joint_count, sizeof *skeleton->joints);
    if (!skeleton->joints) return 1;
    skeleton->joint_count = joint_count;
    for (uint32_t j = 0; j < joint_count; ++j) {
        raw_joint *joint = &skeleton->joints[j];
        joint->parent = joint->node = MODEL_NONE;
        joint->rotation[3] = 1.0f;
        joint->scale[0] = joint->scale[1] = joint->scale[2] = 1.0f;
    }
    return 0;
}

raw_set *raw_set_new(uint32_t joint_count, uint32_t clip_count)
{
    raw_set *set = model_zeros(1, sizeof *set);
    if (!set) return NULL;
    set->skeleton.unit_cm = 1.0;
    set->clips = model_zeros(clip_count, sizeof *set->clips);
    if (!set->clips || raw_skeleton_alloc(&set->skeleton, joint_count)) {
        raw_set_free(set);
        return NULL;
    }
    set->clip_count = clip_count;
    return set;
}

int raw_clip_alloc(raw_clip *clip, uint32_t frame_count, uint32_t joint_count)
{
    size_t joints = (size_t)frame_count * joint_count;
    clip->frame_count = frame_count;
    clip->joint_count = joint_count;
    clip->rotations = model_zeros(joints, 4 * sizeof(float));
    clip->translations = model_zeros(joints, 3 * sizeof(float));
    clip->scales = model_zeros(joints, 3 * sizeof(float));
    return !clip->rotations || !clip->translations || !clip->scales;
}

int raw_floats_alloc(raw_floats *floats, uint32_t frame_count, uint32_t width)
{
    floats->width = width;
    floats->node = MODEL_NONE;
    floats->values = model_zeros((size_t)frame_count * width, sizeof(float));
    return !floats->values;
}

void raw_floats_clear(raw_floats *floats)
{
    free(floats->name);
    free(floats->values);
    free(floats->radius);
}

void raw_clip_clear(raw_clip *clip)
{
    for (uint32_t i = 0; clip->floats && i < clip->float_count; ++i) {
        raw_floats_clear(&clip->floats[i]);
    }
    for (uint32_t i = 0; clip->events && i < clip->event_count; ++i) free(clip->events[i].name);
    free(clip->name);
    free(clip->rotations);
    free(clip->translations);
    free(clip->scales);
    free(clip->floats);
    free(clip->events);
    memset(clip, 0, sizeof *clip);
}

void raw_set_clear(raw_set *set)
{
    for (uint32_t j = 0; set->skeleton.joints && j < set->skeleton.joint_count; ++j) free(set->skeleton.joints[j].name);
    for (uint32_t i = 0; set->clips && i < set->clip_count; ++i) raw_clip_clear(&set->clips[i]);
    free(set->skeleton.joints);
    free(set->skeleton.name);
    free(set->clips);
    free(set->warning);
    memset(set, 0, sizeof *set);
}

void raw_set_free(raw_set *set)
{
    if (!set) return;
    raw_set_clear(set);
    free(set);
}

/* The array grows to powers of two, so its capacity need not be stored. */
static int events_grow(raw_clip *clip)
{
    uint32_t count = clip->event_count;
    if (count != 0 && (count & (count - 1)) != 0) return 0;
    raw_event *grown = realloc(clip->events, (count ? (size_t)count * 2 : 1) * sizeof *grown);
    if (!grown) return 1;
    clip->events = grown;
    return 0;
}

int raw_clip_add_event(raw_clip *clip, const raw_event *event)
{
    raw_event copy = *event;
    copy.name = model_string(event->name);
    if (!copy.name || events_grow(clip)) {
        free(copy.name);
        return 1;
    }
    uint32_t at = clip->event_count++;
    for (; at > 0 && clip->events[at - 1].time_s > copy.time_s; --at) clip->events[at] = clip->events[at - 1];
    clip->events[at] = copy;
    return 0;
}

double raw_clip_duration_s(const raw_clip *clip)
{
    return clip->frame_count > 1 ? (double)(clip->frame_count - 1) / clip->sample_rate_hz : 0.0;
}

static uint32_t hash_byte(uint32_t hash, uint32_t byte)
{
    return (hash ^ (byte & 255u)) * 16777619u;
}

static uint32_t hash_word(uint32_t hash, uint32_t word)
{
    for (uint32_t i = 0; i < 4; ++i) hash = hash_byte(hash, word >> (8 * i));
    return hash;
}

/* The terminating zero is hashed too: "ab", "c" and "a", "bc" are different names. */
static uint32_t hash_string(uint32_t hash, const char *text)
{
    const char *c = text ? text : "";
    for (; *c; ++c) hash = hash_byte(hash, (uint8_t)*c);
    return hash_byte(hash, 0);
}

uint32_t raw_skeleton_hash(const raw_skeleton *skeleton)
{
    uint32_t hash = hash_word(2166136261u, skeleton->joint_count);
    for (uint32_t j = 0; j < skeleton->joint_count; ++j)
        hash = hash_word(hash_string(hash, skeleton->joints[j].name), skeleton->joints[j].parent);
    return hash;
}

static char *copy_name(const char *name)
{
    char *copy = malloc(strlen(name) + 1u);
    return copy ? strcpy(copy, name) : NULL;
}

int raw_skeleton_take(raw_skeleton *skeleton, const raw_skeleton *from)
{
    raw_set copy, old;
    memset(&copy, 0, sizeof copy);
    memset(&old, 0, sizeof old);
    copy.skeleton.unit_cm = skeleton->unit_cm;
    if (raw_skeleton_alloc(&copy.skeleton, from->joint_count)) return 1;
    for (uint32_t j = 0; j < from->joint_count; j++) {
        raw_joint *joint = &copy.skeleton.joints[j];
        *joint = from->joints[j];
        joint->name = from->joints[j].name ? copy_name(from->joints[j].name) : NULL;
        for (int i = 0; i < 3; i++) {
            joint->translation[i] = (float)((double)joint->translation[i] * from->unit_cm / copy.skeleton.unit_cm);
        }
        if (from->joints[j].name && !joint->name) {
            raw_set_clear(&copy);
            return 1;
        }
    }
    old.skeleton = *skeleton;
    *skeleton = copy.skeleton;
    raw_set_clear(&old);
    return 0;
}
