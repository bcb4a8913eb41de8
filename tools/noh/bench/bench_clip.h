/* bench_clip.h (private to `noh bench`): shared by the clip rows.
 *
 *   bench_clip_set.c     the clips of the packs, their raw keys, caches
 *   bench_clip.c         rows clip/warm, clip/alone, clip/shared, clip/seek
 *   bench_clip_frames.c  row clip/worst-frame */
#ifndef NOH_NOH_BENCH_BENCH_CLIP_H
#define NOH_NOH_BENCH_BENCH_CLIP_H

#include "bench_job.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

#define BENCH_CLIPS_MAX 5u
#define BENCH_INSTANCES 100u
#define BENCH_FRAME_TICKS 800 /* of a game at 60 Hz */

/* A clip, and the raw keys that the baseline plays. */
typedef struct bench_clip {
    const char *name;
    noh_clip_desc desc;
    void *memory;
    noh_clip *clip;
    noh_clip_info info;
    noh_transform *keys; /* [frame_count][joint_count], decoded */
} bench_clip;

/* The longest clips first. */
typedef struct bench_clip_set {
    bench_clip clips[BENCH_CLIPS_MAX];
    uint32_t count, joints_max;
} bench_clip_set;

/* A cache in a block of its own. */
typedef struct bench_cache {
    const noh_clip *clips[BENCH_CLIPS_MAX];
    void *memory;
    size_t bytes;
    noh_clip_cache_desc desc; /* of `clips`: to build the cache again, in the same block */
    noh_clip_cache *cache;
} bench_cache;

/* The clips with the most joints x frames of all packs; count 0 where there are none. */
int bench_clip_set_open(bench_clip_set *set, const bench_job *job);
void bench_clip_set_close(bench_clip_set *set);

/* Another set, of the first clip alone, halved (low_motion.h) and without keys; count 0 where the clip has less
 * than 100 frames a second. */
int bench_clip_set_halve(const bench_clip_set *set, bench_clip_set *halved);

/* A cache for the first `clip_count` clips; slots 0: one for every segment. */
int bench_cache_open(bench_cache *c, const bench_clip_set *set, uint32_t clip_count, uint32_t slots);
void bench_cache_close(bench_cache *c);

/* The time of a game's frame in a clip that loops; phase: ticks. */
int64_t bench_clip_time(const bench_clip *c, uint32_t frame, uint64_t phase);

/* The baseline `raw-keys`: uncompressed floats, lerped; rotations in one hemisphere and normalised. */
void bench_sample_keys(const bench_clip *c, int64_t ticks, noh_transform *out);

/* The row clip/worst-frame. */
int bench_clip_frames(bench_job *job, const bench_clip_set *set);

#endif
