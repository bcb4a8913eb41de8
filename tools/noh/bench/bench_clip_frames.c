/* bench_clip_frames.c: row clip/worst-frame: a minute of a hundred instances at 60 Hz.
 *
 * The instances of a clip loop a tenth of a second apart; the cache holds the segments that they cover and few more, so
 * that decoding never ends. Each frame requests the segments needed next and decodes as much as a fixed budget allows.
 * A frame's time is the least of several passes over the same minute, which removes what else the machine did. */
#include <stdlib.h>

#include "bench_clip.h"
#include "cli/message.h"

#define MINUTE 3600u
#define STAGGER_TICKS 4800u
#define SPARE_SLOTS 3u   /* of a clip: decoded ahead, and a sample between two segments */
#define BUDGET_PART 1.25 /* times the average decoding, as room to catch up */
#define EVERYTHING 0xffffffffu

typedef struct minute {
    const bench_clip_set *set;
    bench_cache cache;
    noh_transform *poses;            /* [BENCH_INSTANCES][joints_max] */
    double *best, *times;            /* [MINUTE] nanoseconds; times: a copy to be sorted */
    uint32_t ahead[BENCH_CLIPS_MAX]; /* frames of the game */
    uint32_t budget;                 /* track-frames per frame */
} minute;

static uint64_t segment_ticks(const bench_clip *c)
{
    return c->info.duration_ticks / c->info.segment_count + 1u;
}

static uint32_t followers(const bench_clip_set *set)
{
    return (BENCH_INSTANCES + set->count - 1u) / set->count;
}

static uint32_t slots_of(const bench_clip_set *set)
{
    uint32_t slots = 0;
    for (uint32_t i = 0; i < set->count; i++) {
        const uint64_t covered = (uint64_t)followers(set) * STAGGER_TICKS / segment_ticks(&set->clips[i]) + SPARE_SLOTS;
        slots += covered < set->clips[i].info.segment_count ? (uint32_t)covered : set->clips[i].info.segment_count;
    }
    return slots;
}

static int open_minute(minute *m, const bench_clip_set *set)
{
    double budget = 0.0;
    int status = bench_cache_open(&m->cache, set, set->count, slots_of(set));
    m->set = set;
    m->poses = calloc((size_t)BENCH_INSTANCES * set->joints_max, sizeof *m->poses);
    m->best = malloc(MINUTE * sizeof *m->best);
    m->times = malloc(MINUTE * sizeof *m->times);
    for (uint32_t i = 0; i < set->count; i++) {
        const bench_clip *c = &set->clips[i];
        m->ahead[i] = (uint32_t)(segment_ticks(c) / BENCH_FRAME_TICKS) + 1u;
        budget += (double)c->info.track_count * c->info.frame_count * BENCH_FRAME_TICKS /
                  (double)(c->info.duration_ticks + 1u);
    }
    m->budget = (uint32_t)(BUDGET_PART * budget) + 1u;
    return status || (m->poses && m->best && m->times) ? status : tool_fail("bench", "out of memory");
}

static void close_minute(minute *m)
{
    bench_cache_close(&m->cache);
    free(m->poses);
    free(m->best);
    free(m->times);
}

static void want_all(minute *m, uint32_t frame, int ahead)
{
    for (uint32_t i = 0; i < BENCH_INSTANCES; i++) {
        const uint32_t k = i % m->set->count;
        const bench_clip *c = &m->set->clips[k];
        const uint64_t phase = (uint64_t)(i / m->set->count) * STAGGER_TICKS;
        noh_clip_cache_want(m->cache.cache, k, bench_clip_time(c, frame + (ahead ? m->ahead[k] : 0u), phase),
                            c->info.joint_count);
    }
}

static void play_frame(minute *m, uint32_t frame)
{
    noh_clip_cache_begin_frame(m->cache.cache);
    want_all(m, frame, 1);
    noh_clip_cache_work(m->cache.cache, m->budget);
    for (uint32_t i = 0; i < BENCH_INSTANCES; i++) {
        const uint32_t k = i % m->set->count;
        const bench_clip *c = &m->set->clips[k];
        const uint64_t phase = (uint64_t)(i / m->set->count) * STAGGER_TICKS;
        noh_clip_sample(m->cache.cache, k, bench_clip_time(c, frame, phase), c->info.joint_count,
                        m->poses + (size_t)i * m->set->joints_max, NULL);
    }
}

/* One pass, from a cache with the first frame's segments. */
static void play_minute(minute *m, int first)
{
    noh_clip_cache_init(m->cache.memory, m->cache.bytes, &m->cache.desc, &m->cache.cache, NULL);
    want_all(m, 0, 0);
    want_all(m, 0, 1);
    noh_clip_cache_work(m->cache.cache, EVERYTHING);
    for (uint32_t f = 0; f < MINUTE; f++) {
        const uint64_t from = noh_cpu_clock_ns();
        double elapsed;
        play_frame(m, f);
        elapsed = (double)(noh_cpu_clock_ns() - from);
        m->best[f] = first || elapsed < m->best[f] ? elapsed : m->best[f];
    }
}

int bench_clip_frames(bench_job *job, const bench_clip_set *set)
{
    minute m = { NULL, { { NULL }, NULL, 0, { NULL, 0, 0 }, NULL }, NULL, NULL, NULL, { 0 }, 0 };
    int status = open_minute(&m, set);
    double worst = 0.0;
    for (uint32_t r = 0; r < job->rounds && !status; r++) {
        play_minute(&m, r == 0);
    }
    for (uint32_t f = 0; f < MINUTE && !status; f++) {
        worst = m.best[f] > worst ? m.best[f] : worst;
        m.times[f] = m.best[f];
    }
    if (!status) {
        const double median = bench_median_of(m.times, MINUTE);
        bench_add_row(&job->rows, "clip/worst-frame", "median-frame", 1e-3 * median, 1e-3 * worst, "us", job->rounds);
    }
    close_minute(&m);
    return status;
}
