/* bench_clip.c: rows clip/: poses out of compressed clips, against raw keys and memcpy.
 *
 *   warm     one instance, every segment decoded before
 *   alone    one instance at 60 Hz with a cache of its own, decoding included; of clips with 100 frames a second and
 *            more also halved
 *   shared   a hundred instances at random phases of all clips, one cache that holds them; with
 *            the requests and frame begins of a game
 *   seek     random times, a cache of two segments: nearly every sample of a long clip decodes */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_clip.h"
#include "cli/message.h"

#define SAMPLE_NS 2e6
#define CHECK_TIMES 200u
#define TOLERANCE 1e-3f
#define TOLERANCE_LENGTH 1e-2f /* keys of odd sample rates lie up to a tick, 1/48,000 s, off their frames */
#define SEEK_JOINTS 31.0       /* a seek is reported for a skeleton of this size */
#define EVERYTHING 0xffffffffu

typedef struct clip_bench {
    const bench_clip_set *set;
    bench_clip_set halved;       /* the longest clip, if it has frames to spare */
    bench_cache all, alone, two; /* all segments of all clips; a player's needs; the minimum */
    bench_cache alone_halved;
    noh_transform *poses, *other; /* [BENCH_INSTANCES][joints_max] */
    uint32_t clip_of[BENCH_INSTANCES];
    uint64_t phases[BENCH_INSTANCES];
    const void *volatile seen; /* keeps the results alive */
} clip_bench;

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

/* ---- one instance: the longest clip ---- */

static void run_warm(void *self, uint32_t frame)
{
    clip_bench *b = self;
    const bench_clip *c = &b->set->clips[0];
    noh_clip_sample(b->all.cache, 0, bench_clip_time(c, frame, 0), c->info.joint_count, b->poses, NULL);
    b->seen = b->poses;
}

static void run_warm_keys(void *self, uint32_t frame)
{
    clip_bench *b = self;
    const bench_clip *c = &b->set->clips[0];
    bench_sample_keys(c, bench_clip_time(c, frame, 0), b->poses);
    b->seen = b->poses;
}

static void run_warm_copy(void *self, uint32_t frame)
{
    clip_bench *b = self;
    const bench_clip *c = &b->set->clips[0];
    memcpy(b->poses, c->keys + (size_t)(frame % c->info.frame_count) * c->info.joint_count,
           c->info.joint_count * sizeof *b->poses);
    b->seen = b->poses;
}

static void play_alone(clip_bench *b, noh_clip_cache *cache, uint32_t frame)
{
    const bench_clip *c = &b->set->clips[0];
    noh_clip_cache_begin_frame(cache);
    noh_clip_sample(cache, 0, bench_clip_time(c, frame, 0), c->info.joint_count, b->poses, NULL);
    b->seen = b->poses;
}

static void run_alone(void *self, uint32_t frame)
{
    clip_bench *b = self;
    play_alone(b, b->alone.cache, frame);
}

static void run_alone_halved(void *self, uint32_t frame)
{
    clip_bench *b = self;
    play_alone(b, b->alone_halved.cache, frame);
}

/* Times that are independent of one another (murmur3's finaliser): which two segments a cache keeps then makes no
 * difference, where an even sequence would favour a cache that never evicts its first segment. */
static int64_t seek_time(const bench_clip *c, uint32_t frame)
{
    uint32_t h = frame + 1u;
    h = (h ^ h >> 16) * 0x85ebca6bu;
    h = (h ^ h >> 13) * 0xc2b2ae35u;
    h ^= h >> 16;
    return (int64_t)(((uint64_t)h * (c->info.duration_ticks + 1u)) >> 32);
}

static void run_seek(void *self, uint32_t frame)
{
    clip_bench *b = self;
    const bench_clip *c = &b->set->clips[0];
    noh_clip_sample(b->two.cache, 0, seek_time(c, frame), c->info.joint_count, b->poses, NULL);
    b->seen = b->poses;
}

static void run_seek_keys(void *self, uint32_t frame)
{
    clip_bench *b = self;
    const bench_clip *c = &b->set->clips[0];
    bench_sample_keys(c, seek_time(c, frame), b->poses);
    b->seen = b->poses;
}

/* ---- a hundred instances ---- */

static void run_shared(void *self, uint32_t frame)
{
    clip_bench *b = self;
    noh_clip_cache_begin_frame(b->all.cache);
    for (uint32_t i = 0; i < BENCH_INSTANCES; i++) {
        const bench_clip *c = &b->set->clips[b->clip_of[i]];
        noh_clip_cache_want(b->all.cache, b->clip_of[i], bench_clip_time(c, frame + 1u, b->phases[i]),
                            c->info.joint_count);
    }
    noh_clip_cache_work(b->all.cache, EVERYTHING);
    for (uint32_t i = 0; i < BENCH_INSTANCES; i++) {
        const bench_clip *c = &b->set->clips[b->clip_of[i]];
        noh_clip_sample(b->all.cache, b->clip_of[i], bench_clip_time(c, frame, b->phases[i]), c->info.joint_count,
                        b->poses + (size_t)i * b->set->joints_max, NULL);
    }
    b->seen = b->poses;
}

static void run_shared_keys(void *self, uint32_t frame)
{
    clip_bench *b = self;
    for (uint32_t i = 0; i < BENCH_INSTANCES; i++) {
        const bench_clip *c = &b->set->clips[b->clip_of[i]];
        bench_sample_keys(c, bench_clip_time(c, frame, b->phases[i]), b->poses + (size_t)i * b->set->joints_max);
    }
    b->seen = b->poses;
}

static double shared_joints(const clip_bench *b)
{
    double joints = 0.0;
    for (uint32_t i = 0; i < BENCH_INSTANCES; i++) {
        joints += b->set->clips[b->clip_of[i]].info.joint_count;
    }
    return joints;
}

/* ---- before anything is timed ---- */

static float distance(float a, float b)
{
    return a > b ? a - b : b - a;
}

/* Rotations either way round; lengths to a part of the largest. */
static int same_pose(const noh_transform *a, const noh_transform *b, uint32_t joints)
{
    for (uint32_t j = 0; j < joints; j++) {
        float dot = 0.0f;
        for (uint32_t i = 0; i < 4u; i++) {
            dot += a[j].rotation[i] * b[j].rotation[i];
        }
        for (uint32_t i = 0; i < 3u; i++) {
            const float t = b[j].translation[i], size = t < 0.0f ? -t : t;
            if (!(distance(a[j].translation[i], t) <= TOLERANCE_LENGTH * (1.0f + size)) ||
                !(distance(a[j].scale[i], b[j].scale[i]) <= TOLERANCE)) {
                return 0;
            }
        }
        if (!(distance(dot < 0.0f ? -dot : dot, 1.0f) <= TOLERANCE)) {
            return 0;
        }
    }
    return 1;
}

/* All caches give the raw keys' poses; this also decodes every segment of `all`. */
static int check_caches(clip_bench *b)
{
    for (uint32_t k = 0; k < b->set->count; k++) {
        const bench_clip *c = &b->set->clips[k];
        const uint32_t joints = c->info.joint_count;
        for (uint32_t f = 0; f < c->info.frame_count; f++) {
            const int64_t ticks = (int64_t)(c->info.duration_ticks * f / c->info.frame_count) + 1;
            noh_clip_sample(b->all.cache, k, ticks, joints, b->poses, NULL);
            bench_sample_keys(c, ticks, b->other);
            if (!same_pose(b->poses, b->other, joints)) {
                return tool_fail("bench", "clip '%s' differs from its raw keys at %.4f s", c->name,
                                 (double)ticks / 48000.0);
            }
            if (k == 0 && f < CHECK_TIMES) {
                const int64_t there = seek_time(c, f);
                noh_clip_sample(b->two.cache, 0, there, joints, b->poses, NULL);
                noh_clip_sample(b->all.cache, 0, there, joints, b->other, NULL);
                if (memcmp(b->poses, b->other, joints * sizeof *b->poses) != 0) {
                    return tool_fail("bench", "clip '%s' differs after a seek to %.4f s", c->name,
                                     (double)there / 48000.0);
                }
            }
        }
    }
    return 0;
}

/* ---- rows ---- */

static int open_bench(clip_bench *b, const bench_clip_set *set)
{
    uint32_t state = 7;
    int status;
    memset(b, 0, sizeof *b);
    b->set = set;
    status = bench_cache_open(&b->all, set, set->count, 0);
    if (!status) status = bench_cache_open(&b->alone, set, 1, NOH_CLIP_CACHE_SEGMENTS_MIN);
    if (!status) status = bench_cache_open(&b->two, set, 1, NOH_CLIP_CACHE_SEGMENTS_MIN);
    if (!status) status = bench_clip_set_halve(set, &b->halved);
    if (!status && b->halved.count) {
        status = bench_cache_open(&b->alone_halved, &b->halved, 1, NOH_CLIP_CACHE_SEGMENTS_MIN);
    }
    b->poses = calloc((size_t)BENCH_INSTANCES * set->joints_max, sizeof *b->poses);
    b->other = calloc((size_t)set->joints_max, sizeof *b->other);
    if (!status && (!b->poses || !b->other)) {
        status = tool_fail("bench", "out of memory");
    }
    for (uint32_t i = 0; i < BENCH_INSTANCES; i++) {
        b->clip_of[i] = i % set->count;
        b->phases[i] = next_random(&state) % (set->clips[b->clip_of[i]].info.duration_ticks + 1u);
    }
    return status;
}

static void close_bench(clip_bench *b)
{
    bench_cache_close(&b->all);
    bench_cache_close(&b->alone);
    bench_cache_close(&b->two);
    bench_cache_close(&b->alone_halved);
    bench_clip_set_close(&b->halved);
    free(b->poses);
    free(b->other);
}

/* ALONE_HALVED comes last: it is left out of clips without frames to spare. */
enum { WARM, WARM_KEYS, WARM_COPY, ALONE, SHARED, SHARED_KEYS, SEEK, SEEK_KEYS, ALONE_HALVED, CELLS };

static void add_rows(bench_job *job, const clip_bench *b, const bench_cells *cells)
{
    const double joints = b->set->clips[0].info.joint_count, crowd = shared_joints(b),
                 seek = 1e-3 * SEEK_JOINTS / joints;
    double cost[CELLS];
    char name[64];
    for (uint32_t i = 0; i < cells->count; i++) {
        cost[i] = bench_median(cells, i);
    }
    bench_add_row(&job->rows, "clip/warm", "raw-keys", cost[WARM_KEYS] / joints, cost[WARM] / joints, "ns/joint",
                  cells->rounds);
    bench_add_row(&job->rows, "clip/warm", "memcpy", cost[WARM_COPY] / joints, cost[WARM] / joints, "ns/joint",
                  cells->rounds);
    bench_add_row(&job->rows, "clip/alone", "raw-keys", cost[WARM_KEYS] / joints, cost[ALONE] / joints, "ns/joint",
                  cells->rounds);
    if (b->halved.count) {
        bench_add_row(&job->rows, "clip/alone-halved", "clip/alone", cost[ALONE] / joints, cost[ALONE_HALVED] / joints,
                      "ns/joint", cells->rounds);
    }
    snprintf(name, sizeof name, "clip/shared-%ux%u", (unsigned)BENCH_INSTANCES, (unsigned)b->set->count);
    bench_add_row(&job->rows, name, "raw-keys", cost[SHARED_KEYS] / crowd, cost[SHARED] / crowd, "ns/joint",
                  cells->rounds);
    bench_add_row(&job->rows, "clip/seek", "raw-keys", seek * cost[SEEK_KEYS], seek * cost[SEEK], "us/31",
                  cells->rounds);
}

static int measure(bench_job *job, clip_bench *b)
{
    static void (*const works[CELLS])(void *self, uint32_t frame) = { run_warm,  run_warm_keys, run_warm_copy,
                                                                      run_alone, run_shared,    run_shared_keys,
                                                                      run_seek,  run_seek_keys, run_alone_halved };
    const uint32_t count = b->halved.count ? CELLS : ALONE_HALVED;
    bench_cells cells;
    int status = check_caches(b);
    memset(&cells, 0, sizeof cells);
    for (uint32_t i = 0; i < count && !status; i++) {
        bench_add_cell(&cells, works[i], b);
    }
    if (!status) status = bench_run_cells(&cells, &job->cpu_clock, job->rounds, SAMPLE_NS, "clip");
    if (!status) add_rows(job, b, &cells);
    bench_free_cells(&cells);
    return status;
}

int bench_clip_rows(bench_job *job)
{
    bench_clip_set set;
    clip_bench b;
    int status = bench_clip_set_open(&set, job);
    if (!status && set.count) {
        status = open_bench(&b, &set);
        if (!status) status = measure(job, &b);
        if (!status) status = bench_clip_frames(job, &set);
        close_bench(&b);
    }
    bench_clip_set_close(&set);
    return status ? status : bench_match(job);
}
