/* bench_clip_set.c: the clips that are measured, their raw keys and caches; the baseline raw-keys. */
#include "bench_clip.h"
#include "cli/message.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TICKS_PER_SECOND 48000.0
#define HALVED_RATE_MIN 100u

/* ---- clips ---- */

/* Opens c->desc. */
static int open_clip(bench_clip *c, const char *path)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    const size_t bytes = noh_clip_size(&c->desc, &error);
    c->memory = bytes ? malloc(bytes) : NULL;
    if (!c->memory) return bytes ? tool_fail(path, "out of memory") : tool_fail_error(path, &error);
    if (noh_clip_init(c->memory, bytes, &c->desc, &c->clip, &error)) return tool_fail_error(path, &error);
    noh_clip_info_of(c->clip, &c->info);
    return 0;
}

static int init_clip(bench_clip *c, const pack_file *file, uint32_t index)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_pack_clip clip;
    noh_skeleton skeleton;
    memset(c, 0, sizeof *c);
    noh_pack_clip_at(&file->pack, index, &clip, NULL);
    if (clip.header->joint_count == 0u) {
        return 0; /* floats only */
    }
    if (noh_pack_bind_clip(&file->pack, &clip, &skeleton, NULL, &error)) {
        return tool_fail(file->path, "clip '%s': %s", clip.name, error.what);
    }
    c->name = clip.name;
    c->desc.bytes = clip.bytes;
    c->desc.byte_count = clip.header->clip_bytes;
    c->desc.bind = skeleton.bind_pose;
    c->desc.joint_count = skeleton.joint_count;
    return open_clip(c, file->path);
}

static void free_clip(bench_clip *c)
{
    free(c->memory);
    free(c->keys);
    memset(c, 0, sizeof *c);
}

static uint64_t weight_of(const bench_clip *c)
{
    return (uint64_t)c->info.joint_count * c->info.frame_count;
}

/* Insert a clip by size; the one pushed out at the end is freed. */
static void keep_largest(bench_clip_set *set, bench_clip *c)
{
    uint32_t at = set->count;
    while (at > 0 && weight_of(&set->clips[at - 1u]) < weight_of(c)) {
        at--;
    }
    if (at == BENCH_CLIPS_MAX) {
        free_clip(c);
        return;
    }
    if (set->count == BENCH_CLIPS_MAX) {
        free_clip(&set->clips[--set->count]);
    }
    memmove(&set->clips[at + 1u], &set->clips[at], (set->count - at) * sizeof *set->clips);
    set->clips[at] = *c;
    set->count++;
}

/* The keys are the clip, decoded at its frames. */
static int decode_keys(bench_clip_set *set, uint32_t index)
{
    bench_clip *c = &set->clips[index];
    const uint32_t joints = c->info.joint_count, frames = c->info.frame_count;
    bench_cache cache;
    int status = bench_cache_open(&cache, set, set->count, set->count + 1u);
    c->keys = malloc(sizeof *c->keys * joints * frames);
    if (!status && !c->keys) {
        status = tool_fail("bench", "out of memory");
    }
    for (uint32_t f = 0; f < frames && !status; f++) {
        const uint64_t ticks = frames > 1u ? (c->info.duration_ticks * f + frames - 2u) / (frames - 1u) : 0u;
        noh_clip_sample(cache.cache, index, (int64_t)ticks, joints, c->keys + (size_t)f * joints, NULL);
    }
    bench_cache_close(&cache);
    return status;
}

int bench_clip_set_open(bench_clip_set *set, const bench_job *job)
{
    int status = 0;
    memset(set, 0, sizeof *set);
    for (uint32_t f = 0; f < job->file_count; f++) {
        for (uint32_t i = 0; i < job->files[f].pack.runs[NOH_CHUNK_CLIP].count && !status; i++) {
            bench_clip c;
            status = init_clip(&c, &job->files[f], i);
            if (status || c.info.joint_count == 0u) {
                free_clip(&c);
            } else {
                keep_largest(set, &c);
            }
        }
    }
    for (uint32_t i = 0; i < set->count && !status; i++) {
        set->joints_max = set->clips[i].info.joint_count > set->joints_max ? set->clips[i].info.joint_count
                                                                           : set->joints_max;
        status = decode_keys(set, i);
    }
    return status;
}

void bench_clip_set_close(bench_clip_set *set)
{
    for (uint32_t i = 0; i < set->count; i++) {
        free_clip(&set->clips[i]);
    }
    set->count = 0;
}

int bench_clip_set_halve(const bench_clip_set *set, bench_clip_set *halved)
{
    const uint32_t rate = set->clips[0].info.sample_rate_uhz / NOH_CLIP_MICRO;
    bench_clip *c = &halved->clips[0];
    memset(halved, 0, sizeof *halved);
    if (rate < HALVED_RATE_MIN) return 0;
    c->name = set->clips[0].name;
    c->desc = set->clips[0].desc;
    c->desc.sample_rate_needed = rate / 2u;
    halved->count = 1;
    halved->joints_max = set->clips[0].info.joint_count;
    return open_clip(c, c->name);
}

/* ---- caches ---- */

int bench_cache_open(bench_cache *c, const bench_clip_set *set, uint32_t clip_count, uint32_t slots)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    uint32_t segments = 0;
    memset(c, 0, sizeof *c);
    for (uint32_t i = 0; i < clip_count; i++) {
        c->clips[i] = set->clips[i].clip;
        segments += set->clips[i].info.segment_count;
    }
    slots = slots && slots < segments ? slots : segments;
    c->desc.clips = c->clips;
    c->desc.clip_count = clip_count;
    c->desc.cached_segment_count = slots < NOH_CLIP_CACHE_SEGMENTS_MIN ? NOH_CLIP_CACHE_SEGMENTS_MIN : slots;
    c->bytes = noh_clip_cache_size(&c->desc, &error);
    c->memory = c->bytes ? malloc(c->bytes) : NULL;
    if (!c->memory) {
        return c->bytes ? tool_fail("bench", "out of memory") : tool_fail_error("bench", &error);
    }
    return noh_clip_cache_init(c->memory, c->bytes, &c->desc, &c->cache, &error) ? tool_fail_error("bench", &error) : 0;
}

void bench_cache_close(bench_cache *c)
{
    free(c->memory);
    memset(c, 0, sizeof *c);
}

/* ---- time, and the baseline ---- */

int64_t bench_clip_time(const bench_clip *c, uint32_t frame, uint64_t phase)
{
    return (int64_t)(((uint64_t)frame * BENCH_FRAME_TICKS + phase) % (c->info.duration_ticks + 1u));
}

/* As good as plain C gets: no aliases, one division, no branch. */
static inline void blend_key(const noh_transform *restrict a, const noh_transform *restrict b, float fraction,
                             noh_transform *restrict out)
{
    const float *p = a->rotation, *q = b->rotation;
    const float dot = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
    const float to_a = 1.0f - fraction, to_b = dot < 0.0f ? -fraction : fraction;
    const float x = p[0] * to_a + q[0] * to_b, y = p[1] * to_a + q[1] * to_b;
    const float z = p[2] * to_a + q[2] * to_b, w = p[3] * to_a + q[3] * to_b;
    const float scale = 1.0f / sqrtf(x * x + y * y + z * z + w * w);
    out->rotation[0] = x * scale;
    out->rotation[1] = y * scale;
    out->rotation[2] = z * scale;
    out->rotation[3] = w * scale;
    for (uint32_t i = 0; i < 3u; i++) {
        out->translation[i] = a->translation[i] + (b->translation[i] - a->translation[i]) * fraction;
        out->scale[i] = a->scale[i] + (b->scale[i] - a->scale[i]) * fraction;
    }
}

void bench_sample_keys(const bench_clip *c, int64_t ticks, noh_transform *out)
{
    const uint32_t last = c->info.frame_count - 1u, joints = c->info.joint_count;
    const double position = (double)ticks * ((double)c->info.sample_rate_uhz * 1e-6 / TICKS_PER_SECOND);
    const uint32_t frame = position < (double)last ? (uint32_t)position : last, next = frame < last ? frame + 1u : last;
    const float fraction = frame < last ? (float)(position - (double)frame) : 0.0f;
    const noh_transform *a = c->keys + (size_t)frame * joints, *b = c->keys + (size_t)next * joints;
    for (uint32_t j = 0; j < joints; j++) {
        blend_key(&a[j], &b[j], fraction, &out[j]);
    }
}
