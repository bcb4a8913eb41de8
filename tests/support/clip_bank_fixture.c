#include "clip_bank_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "support.h"
#include "noh/low_motion.h"

#define TWO_PI 6.283185307179586

/* ---- .bvh ---- */

static void put_skeleton(FILE *f, const char *names)
{
    const size_t count = strlen(names);
    fprintf(
        f,
        "HIERARCHY\nROOT %c\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n",
        names[0]);
    for (size_t j = 1; j < count; j++) {
        fprintf(f, "JOINT %c\n{\nOFFSET 0 10 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n", names[j]);
    }
    fprintf(f, "End Site\n{\nOFFSET 0 10 0\n}\n");
    for (size_t j = 0; j < count; j++) {
        fprintf(f, "}\n");
    }
}

static void put_frame(FILE *f, const char *names, uint32_t frame)
{
    const double phase = TWO_PI * (double)frame / (double)(CLIP_PASS_FRAMES - 1u);
    fprintf(f, "%.6f %.6f %.6f", 2.0 * sin(phase), 90.0 + sin(2.0 * phase), 4.0 * (double)frame);
    for (size_t j = 0; j < strlen(names); j++) {
        const double at = phase * (double)(1u + j % 3u) + (double)names[j];
        fprintf(f, " %.6f %.6f %.6f", 30.0 * sin(at), 20.0 * cos(at), 10.0 * sin(2.0 * at));
    }
    fprintf(f, "\n");
}

const char *clip_bvh(const char *name, const char *names, uint32_t frames)
{
    char file[64];
    const char *path;
    FILE *f;
    snprintf(file, sizeof file, "%s.bvh", name);
    path = test_path(file);
    f = fopen(path, "w");
    assert_non_null(f);
    put_skeleton(f, names);
    fprintf(f, "MOTION\nFrames: %u\nFrame Time: 0.0333333\n", (unsigned)frames);
    for (uint32_t i = 0; i < frames; i++) {
        put_frame(f, names, i);
    }
    assert_int_equal(fclose(f), 0);
    return path;
}

uint8_t *clip_pack(const char *const *inputs, int count, const convert_options *options, size_t *bytes)
{
    convert_options defaults;
    convert_failure failure;
    byte_buffer out = { NULL, 0, 0, 0 };
    uint8_t *copy;
    memset(&defaults, 0, sizeof defaults);
    if (convert_files(inputs, count, options ? options : &defaults, &out, &failure)) {
        fail_msg("%s: %s (%s)", failure.file, failure.error.what, failure.error.where);
    }
    copy = test_aligned(out.bytes, out.count);
    *bytes = out.count;
    buffer_free(&out);
    return copy;
}

/* ---- a model ---- */

static void fill_event(model_event *e, const char *name, double time_s, int is_marker)
{
    e->name = model_string(name);
    e->time_s = time_s;
    e->is_marker = (uint8_t)is_marker;
    e->payload[0] = is_marker ? 0 : 42;
}

/* Node 0 goes up and down. */
static void fill_translation(model_channel *c, float duration_s)
{
    memset(c, 0, sizeof *c);
    c->path = MODEL_PATH_TRANSLATION;
    c->key_count = 3;
    c->width = 3;
    c->times = test_zeros(3 * sizeof(float));
    c->values = test_zeros(9 * sizeof(float));
    c->times[1] = duration_s * 0.5f;
    c->times[2] = duration_s;
    c->values[4] = 0.5f;
}

model *clip_model(uint32_t targets)
{
    const test_model_desc desc = { 1, 4, targets, TEST_SCENE, 11 };
    model *m = test_model(&desc);
    model_clip *clip = &m->clips[0];
    model_channel *channels = test_zeros(2 * sizeof *channels);
    channels[0] = clip->channels[0];
    fill_translation(&channels[1], clip->duration_s);
    free(clip->channels);
    clip->channels = channels;
    clip->channel_count = 2;
    clip->events = test_zeros(3 * sizeof *clip->events);
    clip->event_count = 3;
    fill_event(&clip->events[0], "left", 0.1, 1);
    fill_event(&clip->events[1], "ring", 0.25, 0);
    fill_event(&clip->events[2], "right", 0.3, 1);
    return m;
}

/* ---- playing ---- */

void clip_player_open(clip_player *p, noh_clip_bank *set)
{
    noh_controller_desc desc;
    size_t bytes, scratch_bytes = noh_pose_scratch_size(&set->clips, 0);
    memset(&desc, 0, sizeof desc);
    memset(p, 0, sizeof *p);
    desc.set = &set->clips;
    bytes = noh_controller_size(&desc);
    p->set = set;
    p->memory = test_aligned(NULL, bytes);
    p->scratch_memory = test_aligned(NULL, scratch_bytes);
    p->pose = test_zeros(sizeof *p->pose * set->clips.joint_count);
    p->floats = test_zeros(sizeof *p->floats * set->clips.float_count);
    assert_int_equal(noh_controller_init(p->memory, bytes, &desc, &p->c, NULL), NOH_OK);
    assert_int_equal(noh_pose_scratch_init(p->scratch_memory, scratch_bytes, &set->clips, 0, &p->scratch, NULL),
                     NOH_OK);
}

void clip_player_close(clip_player *p)
{
    free(p->memory);
    free(p->scratch_memory);
    free(p->pose);
    free(p->floats);
    memset(p, 0, sizeof *p);
}

void clip_start(clip_player *p, uint32_t clip, noh_loop loop, int32_t speed, int64_t tick)
{
    noh_track_desc track;
    memset(&track, 0, sizeof track);
    track.clip = clip;
    track.loop = loop;
    track.speed = speed;
    track.position_ticks = tick;
    assert_int_equal(noh_controller_start(p->c, &p->set->clips, 0, &track, NULL), NOH_OK);
}

void clip_frame(clip_player *p, uint32_t ticks, uint32_t ahead_ticks, uint32_t budget)
{
    noh_clip_cache_begin_frame(p->set->cache);
    noh_controller_step(p->c, &p->set->clips, ticks, NULL, NULL);
    if (ahead_ticks) {
        noh_clip_bank_prefetch(p->set, p->c, ahead_ticks);
        noh_clip_cache_work(p->set->cache, budget);
    }
    noh_controller_pose(p->c, &p->set->clips, &p->scratch, p->pose, p->floats);
}
