/* clip_bank_view.c: how a set's clips are sampled: through the set's own cache, or through one thread's view of it. */
#include <string.h>

#include "bank/clip_bank_internal.h"
#include "base/arena.h"

/* What a clip was sampled into, completed. Joints that the clip does not have, and floats that it does not move, are at
 * rest; its floats go to their places among the set's. */
static void complete(const noh_clip_bank *set, const struct noh_bank_clip *clip, const float *sampled,
                     uint32_t joint_count, noh_transform *pose, uint32_t float_count, float *floats)
{
    if (!clip->joint_count && joint_count) {
        memcpy(pose, set->skeleton.bind_pose, joint_count * sizeof *pose);
    }
    if (float_count) {
        memcpy(floats, set->clips.float_defaults, float_count * sizeof *floats);
    }
    for (uint32_t i = 0; float_count && i < clip->float_runs; i++) {
        const noh_bank_floats *run = &clip->floats[i];
        memcpy(floats + run->to, sampled + run->from, run->width * sizeof *floats);
    }
}

static void check_request(const noh_clip_bank *set, uint32_t index, uint32_t joint_count, uint32_t float_count)
{
    NOH_ASSERT(index < set->clips.clip_count);
    NOH_ASSERT(joint_count <= set->clips.joint_count);
    NOH_ASSERT(float_count == 0u || float_count == set->clips.float_count);
    (void)set, (void)index, (void)joint_count, (void)float_count;
}

static void sample_cache(void *user, uint32_t index, uint32_t clip_tick, uint32_t joint_count, noh_transform *pose,
                         uint32_t float_count, float *floats)
{
    const noh_clip_bank *set = user;
    const struct noh_bank_clip *clip = &set->bound[index];
    const int moves_floats = float_count && clip->float_runs;
    check_request(set, index, joint_count, float_count);
    if (clip->joint_count || moves_floats) {
        noh_clip_sample(set->cache, index, clip_tick, clip->joint_count ? joint_count : 0u, pose,
                        moves_floats ? set->sampled : NULL);
    }
    complete(set, clip, set->sampled, joint_count, pose, float_count, floats);
}

static void sample_view(void *user, uint32_t index, uint32_t clip_tick, uint32_t joint_count, noh_transform *pose,
                        uint32_t float_count, float *floats)
{
    const noh_clip_bank_view *view = user;
    const struct noh_bank_clip *clip = &view->set->bound[index];
    const int moves_floats = float_count && clip->float_runs;
    check_request(view->set, index, joint_count, float_count);
    if (clip->joint_count || moves_floats) {
        noh_clip_view_sample(view->samples, index, clip_tick, clip->joint_count ? joint_count : 0u, pose,
                             moves_floats ? view->sampled : NULL);
    }
    complete(view->set, clip, view->sampled, joint_count, pose, float_count, floats);
}

void noh_clip_bank_sample_cache(noh_clip_bank *set)
{
    set->clips.sample = sample_cache;
    set->clips.user = set;
}

/* ---- views ---- */

static size_t carve(noh_arena *arena, const noh_clip_bank *set, noh_clip_bank_view **view, void **clips,
                    float **sampled)
{
    *view = noh_arena_carve(arena, sizeof **view, 16u);
    *clips = noh_arena_carve(arena, noh_clip_view_size(set->cache), 16u);
    *sampled = noh_arena_carve(arena, set->sampled_count * sizeof **sampled, 4u);
    return arena->used;
}

size_t noh_clip_bank_view_size(const noh_clip_bank *set)
{
    noh_arena arena = noh_arena_measure();
    noh_clip_bank_view *view;
    void *clips;
    float *sampled;
    return carve(&arena, set, &view, &clips, &sampled);
}

noh_result noh_clip_bank_view_init(void *memory, size_t bytes, const noh_clip_bank *set, noh_clip_bank_view **view,
                                   noh_error *error)
{
    noh_arena arena;
    noh_clip_bank_view *made;
    void *clips;
    float *sampled;
    noh_result r = noh_arena_open(&arena, memory, bytes, noh_clip_bank_view_size(set), error);
    if (r) return r;
    (void)carve(&arena, set, &made, &clips, &sampled);
    r = noh_clip_view_init(clips, noh_clip_view_size(set->cache), set->cache, &made->samples, error);
    if (r) return r;
    made->clips = set->clips;
    made->clips.sample = sample_view;
    made->clips.user = made;
    made->set = set;
    made->sampled = sampled;
    *view = made;
    return NOH_OK;
}
