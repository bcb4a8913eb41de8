/* bench_crowd_pose.c: rows crowd/pose: what 1,000 characters on the first skeleton of a pack cost the CPU, from
 * clocks to palettes, posed at the update rate that pixels need, and in every frame. None where a pack has no
 * clips. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "stage/character/time_lod_internal.h"
#include "stage/character/character_internal.h"

#define SAMPLE_NS 2e7
#define CROWD 1000u
#define CLIPS_MAX 32u
#define FRAME_TICKS 800u /* 60 frames a second */
#define FIELD_M 100.0f   /* radius of the disc over which they are spread evenly */
#define VIEW_RAD 1.0472f /* 60 degrees */
#define VIEW_LINES 720u
#define FLESH_M 0.06f /* radius around bones, since there is no mesh to measure */

typedef struct crowd {
    noh_skeleton skeleton;
    noh_clip_set set;
    noh_clip_entry entries[CLIPS_MAX];
    const noh_clip *opened_clips[CLIPS_MAX];
    void *clip_memory[CLIPS_MAX];
    void *cache_memory, *scratch_memory;
    noh_clip_cache *cache;
    noh_character_scratch scratch;
    float *radius_m, *rate_errors;
    size_t bytes;               /* of one character */
    uint8_t *characters;        /* [CROWD][bytes] */
    float *palette, *expected;  /* [joint_count][12] */
    const void *volatile shown; /* keeps the results alive */
    float scales[CROWD];
} crowd;

typedef struct crowd_work {
    crowd *crowd;
    noh_lod_table table;
    noh_lod_settings settings;
    int seen;
} crowd_work;

static noh_character *character_of(const crowd *c, uint32_t i)
{
    return (noh_character *)(void *)(c->characters + i * c->bytes);
}

/* ---- timed code ---- */

/* Step and pose all in every frame. */
static void run_full(void *self, uint32_t frame)
{
    crowd *c = ((const crowd_work *)self)->crowd;
    (void)frame;
    noh_clip_cache_begin_frame(c->cache);
    for (uint32_t i = 0; i < CROWD; i++) {
        noh_controller *controller = noh_character_controller(character_of(c, i));
        noh_controller_step(controller, &c->set, FRAME_TICKS, NULL, NULL);
        noh_controller_pose(controller, &c->set, &c->scratch.pose, c->scratch.local, c->scratch.floats);
        noh_local_to_model(&c->skeleton, c->scratch.local, c->skeleton.joint_count, c->scratch.model);
        noh_model_to_palette(&c->skeleton, c->scratch.model, c->skeleton.joint_count, c->palette);
        c->shown = c->palette;
    }
}

/* Step all; pose the visible ones at the update rate that their pixels need. */
static void run_lod(void *self, uint32_t frame)
{
    const crowd_work *w = (const crowd_work *)self;
    crowd *c = w->crowd;
    (void)frame;
    noh_clip_cache_begin_frame(c->cache);
    for (uint32_t i = 0; i < CROWD; i++) {
        noh_character *ch = character_of(c, i);
        noh_character_step(ch, &c->set, FRAME_TICKS, NULL, NULL);
        if (!w->seen) {
            continue;
        }
        if (noh_character_select_lod(ch, &w->table, &w->settings, c->scales[i]) != NOH_DUE_NOT) {
            noh_character_update(ch, &c->set, &c->skeleton, NULL, &c->scratch);
        }
        c->shown = noh_character_palette(ch, c->palette, c->skeleton.joint_count);
    }
}

/* ---- making ---- */

static void sample_clip(void *user, uint32_t clip, uint32_t tick, uint32_t joints, noh_transform *pose, uint32_t floats,
                        float *values)
{
    (void)floats;
    (void)values;
    noh_clip_sample(((crowd *)user)->cache, clip, tick, joints, pose, NULL);
}

static int open_clip(crowd *c, const pack_file *file, uint32_t index)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    uint32_t skeleton, at = c->set.clip_count;
    noh_pack_clip clip;
    noh_clip_desc desc;
    noh_clip_info info;
    noh_skeleton bound;
    noh_clip *opened;
    size_t bytes;
    noh_pack_clip_at(&file->pack, index, &clip, NULL);
    if (noh_pack_bind_clip(&file->pack, &clip, &bound, &skeleton, NULL) || skeleton != 0) {
        return 0;
    }
    memset(&desc, 0, sizeof desc);
    desc.bytes = clip.bytes;
    desc.byte_count = clip.header->clip_bytes;
    desc.bind = bound.bind_pose;
    desc.joint_count = bound.joint_count;
    bytes = noh_clip_size(&desc, &error);
    c->clip_memory[at] = bytes ? malloc(bytes) : NULL;
    if (!c->clip_memory[at] || noh_clip_init(c->clip_memory[at], bytes, &desc, &opened, &error)) {
        return tool_fail(file->path, "clip '%s': %s", clip.name, error.result ? error.what : "out of memory");
    }
    noh_clip_info_of(opened, &info);
    c->opened_clips[at] = opened;
    c->entries[at].duration_ticks = (uint32_t)info.duration_ticks;
    c->entries[at].loop = NOH_LOOP_PING_PONG; /* no seam, whatever the clip */
    c->set.clip_count++;
    return 0;
}

/* Every segment stays decoded, so that decoding is not timed. */
static int open_cache(crowd *c)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_clip_cache_desc desc = { c->opened_clips, c->set.clip_count, 0 };
    size_t bytes;
    for (uint32_t i = 0; i < c->set.clip_count; i++) {
        noh_clip_info info;
        noh_clip_info_of(c->opened_clips[i], &info);
        desc.cached_segment_count += info.segment_count;
    }
    desc.cached_segment_count = desc.cached_segment_count < NOH_CLIP_CACHE_SEGMENTS_MIN ? NOH_CLIP_CACHE_SEGMENTS_MIN
                                                                                        : desc.cached_segment_count;
    bytes = noh_clip_cache_size(&desc, &error);
    c->cache_memory = bytes ? malloc(bytes) : NULL;
    if (!c->cache_memory || noh_clip_cache_init(c->cache_memory, bytes, &desc, &c->cache, &error)) {
        return tool_fail("bench", "%s", error.result ? error.what : "out of memory");
    }
    return 0;
}

/* A radius for each joint: its longest bone. */
static void set_reaches(crowd *c, float unit_m)
{
    const noh_skeleton *s = &c->skeleton;
    for (uint32_t j = 0; j < s->joint_count; j++) {
        c->radius_m[j] = FLESH_M / unit_m;
    }
    for (uint32_t j = 0; j < s->joint_count; j++) {
        const float *t = s->bind_pose[j].translation;
        float bone = sqrtf(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]) + FLESH_M / unit_m;
        if (s->parents[j] != NOH_JOINT_ROOT && bone > c->radius_m[s->parents[j]]) {
            c->radius_m[s->parents[j]] = bone;
        }
    }
}

static int measure_rates(crowd *c)
{
    noh_time_probe probe = { &c->set, &c->skeleton, c->radius_m, NULL, 0 };
    size_t bytes = noh_time_lod_measure_size(&probe);
    noh_error error = { NOH_OK, "", 0, 0 };
    void *memory = malloc(bytes);
    int status = memory ? 0 : tool_fail("bench", "out of memory");
    for (uint32_t m = 0; m < c->set.clip_count && !status; m++) {
        float *errors = c->rate_errors + NOH_UPDATE_RATE_COUNT * (size_t)m;
        status = noh_time_lod_measure(memory, bytes, &probe, m, errors, &error) ? tool_fail_error("bench", &error) : 0;
    }
    free(memory);
    return status;
}

/* Half of them blend two clips. Phases and places are from a low-discrepancy sequence. */
static void populate(crowd *c, float unit_m)
{
    for (uint32_t i = 0; i < CROWD; i++) {
        float part = (float)((i * 2654435769u) >> 8) / 16777216.0f, distance_m = FIELD_M * sqrtf(part);
        noh_controller *controller = noh_character_controller(character_of(c, i));
        for (uint32_t track = 0; track <= i % 2u; track++) {
            noh_track_desc d;
            memset(&d, 0, sizeof d);
            d.clip = (i / 2u + track) % c->set.clip_count;
            d.position_ticks = (int64_t)(part * 1e6f);
            d.weight = 1.0f;
            noh_controller_start(controller, &c->set, track, &d, NULL);
        }
        c->scales[i] = noh_lod_scale(distance_m, VIEW_RAD, VIEW_LINES) * unit_m;
    }
}

static int make_characters(crowd *c)
{
    noh_character_desc desc;
    noh_character *made;
    noh_error error = { NOH_OK, "", 0, 0 };
    size_t scratch_bytes;
    memset(&desc, 0, sizeof desc);
    desc.controller.set = &c->set;
    c->bytes = noh_character_size(&desc);
    scratch_bytes = noh_character_scratch_size(&desc);
    c->characters = malloc(CROWD * c->bytes);
    c->scratch_memory = malloc(scratch_bytes);
    if (!c->characters || !c->scratch_memory) {
        return tool_fail("bench", "out of memory");
    }
    for (uint32_t i = 0; i < CROWD; i++) {
        desc.instance = i;
        if (noh_character_init(c->characters + i * c->bytes, c->bytes, &desc, &made, &error)) {
            return tool_fail_error("bench", &error);
        }
    }
    return noh_character_scratch_init(c->scratch_memory, scratch_bytes, &desc, &c->scratch, &error)
               ? tool_fail_error("bench", &error)
               : 0;
}

static int crowd_open(crowd *c, const pack_file *file)
{
    const noh_skeleton_header *header;
    int status = 0;
    noh_pack_skeleton_at(&file->pack, 0, &c->skeleton, &header, NULL);
    c->set.joint_count = c->skeleton.joint_count;
    c->set.clips = c->entries;
    c->set.bind_pose = c->skeleton.bind_pose;
    c->set.sample = sample_clip;
    c->set.user = c;
    for (uint32_t i = 0; i < file->pack.runs[NOH_CHUNK_CLIP].count && c->set.clip_count < CLIPS_MAX && !status; i++) {
        status = open_clip(c, file, i);
    }
    if (status || c->set.clip_count == 0) {
        return status;
    }
    c->radius_m = malloc(c->skeleton.joint_count * sizeof(float));
    c->rate_errors = malloc(c->set.clip_count * NOH_UPDATE_RATE_COUNT * sizeof(float));
    c->palette = malloc(c->skeleton.joint_count * 48u);
    c->expected = malloc(c->skeleton.joint_count * 48u);
    if (!c->radius_m || !c->rate_errors || !c->palette || !c->expected) {
        return tool_fail("bench", "out of memory");
    }
    set_reaches(c, header->unit_cm * 0.01f);
    status = open_cache(c);
    if (!status) status = make_characters(c);
    if (!status) status = measure_rates(c);
    if (!status) populate(c, header->unit_cm * 0.01f);
    return status;
}

static void crowd_close(crowd *c)
{
    for (uint32_t i = 0; i < CLIPS_MAX; i++) {
        free(c->clip_memory[i]);
    }
    free(c->cache_memory);
    free(c->scratch_memory);
    free(c->radius_m);
    free(c->rate_errors);
    free(c->characters);
    free(c->palette);
    free(c->expected);
}

/* ---- rows ---- */

/* A character near enough to be posed in every frame equals the baseline bit for bit. */
static int check(crowd_work *w)
{
    crowd *c = w->crowd;
    size_t bytes = 48u * (size_t)c->skeleton.joint_count;
    for (uint32_t i = 0; i < CROWD; i++) {
        noh_character *ch = character_of(c, i);
        noh_controller_pose(noh_character_controller(ch), &c->set, &c->scratch.pose, c->scratch.local,
                            c->scratch.floats);
        noh_local_to_model(&c->skeleton, c->scratch.local, c->skeleton.joint_count, c->scratch.model);
        noh_model_to_palette(&c->skeleton, c->scratch.model, c->skeleton.joint_count, c->expected);
        noh_character_select_lod(ch, &w->table, &w->settings, 1e9f);
        noh_character_update(ch, &c->set, &c->skeleton, NULL, &c->scratch);
        if (memcmp(noh_character_palette(ch, c->palette, c->skeleton.joint_count), c->expected, bytes) != 0) {
            return tool_fail("bench", "crowd/pose and full-rate give different poses");
        }
    }
    return 0;
}

typedef struct variant {
    const char *name;
    float pixels;
    int seen;
} variant;

static const variant variants[] = {
    { "full-rate", 1.0f, 1 }, /* the baseline */
    { "crowd/pose/1-pixel", 1.0f, 1 }, { "crowd/pose/4-pixels", 4.0f, 1 }, { "crowd/pose/16-pixels", 16.0f, 1 },
    { "crowd/pose/unseen", 1.0f, 0 },
};
#define VARIANTS (sizeof variants / sizeof variants[0])

static int measure(bench_job *job, crowd *c)
{
    crowd_work works[VARIANTS];
    bench_cells cells;
    int status;
    memset(&cells, 0, sizeof cells);
    memset(works, 0, sizeof works);
    for (uint32_t i = 0; i < VARIANTS; i++) {
        works[i].crowd = c;
        works[i].table.update_error_m = c->rate_errors;
        works[i].settings.pixels = variants[i].pixels;
        works[i].seen = variants[i].seen;
        bench_add_cell(&cells, i ? run_lod : run_full, &works[i]);
    }
    status = check(&works[0]);
    if (!status) {
        status = bench_run_cells(&cells, &job->cpu_clock, job->rounds, SAMPLE_NS, "crowd/pose");
    }
    for (uint32_t i = 1; i < VARIANTS && !status; i++) {
        double full = bench_median(&cells, 0) / CROWD, own = bench_median(&cells, i) / CROWD;
        bench_add_row(&job->rows, variants[i].name, variants[0].name, full, own, "ns/char", cells.rounds);
    }
    bench_free_cells(&cells);
    return status;
}

int bench_crowd_pose(bench_job *job)
{
    crowd c;
    int status;
    if (job->files[0].pack.runs[NOH_CHUNK_SKELETON].count == 0) {
        return 0;
    }
    memset(&c, 0, sizeof c);
    status = crowd_open(&c, &job->files[0]);
    if (!status && c.set.clip_count) {
        status = measure(job, &c);
    }
    crowd_close(&c);
    return status;
}
