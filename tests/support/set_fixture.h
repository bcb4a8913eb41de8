/* set_fixture.h: a clip bank from a pack that is made here, without files or C++: a chain of joints swings while its
 * root walks, and each clip has two named floats, one of them shared by all clips. */
#ifndef TESTS_SET_FIXTURE_H
#define TESTS_SET_FIXTURE_H

#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "convert/clips/raw_set.h"
#include "convert/graph/graph_text.h"
#include "convert/pack/pack_clips.h"
#include "noh/pack.h"

typedef struct set_fixture {
    uint8_t *bytes;
    noh_pack pack;
} set_fixture;

static inline void set_fixture_joints(raw_skeleton *s)
{
    s->unit_cm = 1.0;
    for (uint32_t j = 0; j < s->joint_count; j++) {
        char name[16];
        snprintf(name, sizeof name, "joint%u", (unsigned)j);
        s->joints[j].name = model_string(name);
        s->joints[j].parent = j ? j - 1u : MODEL_NONE;
        s->joints[j].translation[1] = j ? 8.0f : 90.0f;
    }
}

static inline void set_fixture_floats(raw_clip *c, uint32_t which, const char *name)
{
    raw_floats *floats = &c->floats[which];
    assert_int_equal(raw_floats_alloc(floats, c->frame_count, 1), 0);
    floats->name = model_string(name);
    for (uint32_t f = 0; f < c->frame_count; f++) {
        floats->values[f] = (float)(0.5 + 0.5 * sin(0.11 * (double)f + (double)which));
    }
}

static inline void set_fixture_clip(const raw_skeleton *s, raw_clip *c, uint32_t index, uint32_t frames)
{
    char name[16];
    snprintf(name, sizeof name, "clip%u", (unsigned)index);
    c->name = model_string(name);
    c->sample_rate_hz = 30.0;
    c->loop = 1;
    assert_int_equal(raw_clip_alloc(c, frames, s->joint_count), 0);
    for (uint32_t f = 0; f < frames; f++) {
        for (uint32_t j = 0; j < s->joint_count; j++) {
            const size_t at = (size_t)f * s->joint_count + j;
            const double angle = 0.4 * sin(0.05 * (double)(f * (1u + j % 3u)) + (double)(j + 7u * index));
            c->rotations[4u * at + j % 3u] = (float)sin(angle);
            c->rotations[4u * at + 3u] = (float)cos(angle);
            memcpy(c->translations + 3u * at, s->joints[j].translation, 3u * sizeof(float));
            c->scales[3u * at] = c->scales[3u * at + 1u] = c->scales[3u * at + 2u] = 1.0f;
        }
        c->translations[3u * (size_t)f * s->joint_count + 2u] = (float)f * (1.0f + (float)index);
    }
    c->floats = test_zeros(2u * sizeof *c->floats);
    c->float_count = 2;
    set_fixture_floats(c, 0, "glow");
    set_fixture_floats(c, 1, name);
}

/* The pack of raw sets, which are freed, and of graphs (NULL: none). */
static inline set_fixture set_fixture_of_sets(raw_set **raws, uint32_t count, graph_file *graphs)
{
    set_fixture x;
    model *empty = model_new();
    clips_settings settings;
    encoded_clips made;
    void *chunks[NOH_CHUNK_TYPES] = { NULL };
    model_error error;
    byte_buffer out = { NULL, 0, 0, 0 };
    memset(&settings, 0, sizeof settings);
    if (clips_encode(raws, count, &settings, &made, &error)) {
        fail_msg("%s", error.what);
    }
    chunks[NOH_CHUNK_GRAPH] = graphs;
    made.chunks = chunks;
    if (pack_write(empty, NULL, NULL, &made, &out, &error)) {
        fail_msg("%s", error.what);
    }
    x.bytes = test_aligned(out.bytes, out.count);
    x.pack = test_open(x.bytes, out.count);
    buffer_free(&out);
    clips_free(&made);
    model_free(empty);
    for (uint32_t i = 0; i < count; i++) raw_set_free(raws[i]);
    return x;
}

static inline set_fixture set_fixture_of_graphs(raw_set *raw, graph_file *graphs)
{
    return set_fixture_of_sets(&raw, 1, graphs);
}

static inline set_fixture set_fixture_of(raw_set *raw)
{
    return set_fixture_of_graphs(raw, NULL);
}

/* Clips "clip0", "clip1", ... of frames[i] frames each, at 30 Hz; and graphs (NULL: none). */
static inline set_fixture set_fixture_make_graphs(uint32_t joints, uint32_t clips, const uint32_t *frames,
                                                  graph_file *graphs)
{
    raw_set *raw = raw_set_new(joints, clips);
    set_fixture_joints(&raw->skeleton);
    for (uint32_t c = 0; c < clips; c++) {
        set_fixture_clip(&raw->skeleton, &raw->clips[c], c, frames[c]);
    }
    return set_fixture_of_graphs(raw, graphs);
}

static inline set_fixture set_fixture_make(uint32_t joints, uint32_t clips, const uint32_t *frames)
{
    return set_fixture_make_graphs(joints, clips, frames, NULL);
}

#endif
