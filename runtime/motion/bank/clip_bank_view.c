/* clip_bank_view.c: sampling a bank's clips, through the bank's own cache or through a thread's view of it. */
#include <string.h>

#include "motion/anim/clip_set_internal.h"
#include "motion/bank/clip_bank_internal.h"
#include "core/base/assert_internal.h"
#include "motion/clip/clip_view_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

/* Complete a sample: a clip without joints gives the bind pose, floats that it does not move get their defaults, and
 * the others are copied to their places in the bank. */
static void complete(const noh_clip_bank *bank, const struct noh_bank_clip *clip, const float *sampled,
                     uint32_t joint_count, noh_transform *pose, uint32_t float_count, float *floats)
{
    if (!clip->joint_count && joint_count) {
        memcpy(pose, bank->skeleton.bind_pose, joint_count * sizeof *pose);
    }
    if (float_count) {
        memcpy(floats, bank->clips.float_defaults, float_count * sizeof *floats);
    }
    for (uint32_t i = 0; float_count && i < clip->float_runs; i++) {
        const noh_bank_floats *run = &clip->floats[i];
        memcpy(floats + run->to, sampled + run->from, run->width * sizeof *floats);
    }
}

static void check_request(const noh_clip_bank *bank, uint32_t index, uint32_t joint_count, uint32_t float_count)
{
    NOH_ASSERT(index < bank->clips.clip_count);
    NOH_ASSERT(joint_count <= bank->clips.joint_count);
    NOH_ASSERT(float_count == 0u || float_count == bank->clips.float_count);
    (void)bank, (void)index, (void)joint_count, (void)float_count;
}

/* What to sample: of a clip that is not in memory nothing, so that it is the bind pose. */
static const struct noh_bank_clip *bound_clip(const noh_clip_bank *bank, uint32_t index)
{
    static const struct noh_bank_clip nothing;
    return noh_clip_is_absent(&bank->clips, index) ? &nothing : &bank->bound[index];
}

/* How many joints of a clip are read for the first joint_count of the skeleton. A map takes a whole pose. */
static uint32_t joints_of(const noh_clip_bank *bank, const struct noh_bank_clip *clip, uint32_t joint_count)
{
    if (!NOH_PAGE && clip->is_mapped && joint_count) return bank->map->source->joint_count;
    return clip->joint_count ? joint_count : 0u;
}

static noh_transform *pose_of(const struct noh_bank_clip *clip, noh_transform *mapped, noh_transform *pose)
{
    return !NOH_PAGE && clip->is_mapped ? mapped : pose;
}

/* Whether the bind pose is asked for that a mapped clip's poses are relative to: NOH_CLIP_MAPPED. */
static int is_bind(uint32_t clip_tick)
{
    return !NOH_PAGE && clip_tick == NOH_NONE;
}

/* The first joints of a pose may depend on later ones: root motion takes one joint, which has to be as in the whole
 * pose. */
static void take_mapped(const noh_clip_bank *bank, const struct noh_bank_clip *clip, uint32_t clip_tick,
                        noh_transform *mapped, uint32_t joint_count, noh_transform *pose)
{
    if (NOH_PAGE || !clip->is_mapped || !joint_count) return;
    const noh_clip_map *map = bank->map;
    noh_transform *whole = joint_count < map->least ? mapped + map->source->joint_count : pose;
    map->pose(map, is_bind(clip_tick) ? map->source->bind_pose : mapped,
              joint_count < map->least ? map->least : joint_count, whole);
    if (whole != pose) memcpy(pose, whole, joint_count * sizeof *pose);
}

static void sample_cache(void *user, uint32_t index, uint32_t clip_tick, uint32_t joint_count, noh_transform *pose,
                         uint32_t float_count, float *floats)
{
    const noh_clip_bank *bank = user;
    const struct noh_bank_clip *clip = bound_clip(bank, index);
    const int moves_floats = float_count && clip->float_runs;
    check_request(bank, index, joint_count, float_count);
    if ((clip->joint_count || moves_floats) && !is_bind(clip_tick)) {
        noh_clip_sample(bank->cache, index, clip_tick, joints_of(bank, clip, joint_count),
                        pose_of(clip, bank->mapped, pose), moves_floats ? bank->sampled : NULL);
    }
    take_mapped(bank, clip, clip_tick, bank->mapped, joint_count, pose);
    complete(bank, clip, bank->sampled, joint_count, pose, float_count, floats);
}

static void sample_view(void *user, uint32_t index, uint32_t clip_tick, uint32_t joint_count, noh_transform *pose,
                        uint32_t float_count, float *floats)
{
    const noh_clip_bank_view *view = user;
    const struct noh_bank_clip *clip = bound_clip(view->bank, index);
    const int moves_floats = float_count && clip->float_runs;
    check_request(view->bank, index, joint_count, float_count);
    if ((clip->joint_count || moves_floats) && !is_bind(clip_tick)) {
        noh_clip_view_sample(view->samples, index, clip_tick, joints_of(view->bank, clip, joint_count),
                             pose_of(clip, view->mapped, pose), moves_floats ? view->sampled : NULL);
    }
    take_mapped(view->bank, clip, clip_tick, view->mapped, joint_count, pose);
    complete(view->bank, clip, view->sampled, joint_count, pose, float_count, floats);
}

void noh_clip_bank_sample_cache(noh_clip_bank *bank)
{
    bank->clips.sample = sample_cache;
    bank->clips.user = bank;
}

/* ---- views ----
 *
 * A view holds a copy of the set with its own `sample` and `user`. So calls that take a set need not know about views,
 * and threads share everything else. */

static size_t carve(noh_arena *arena, const noh_clip_bank *bank, noh_clip_bank_view **view, void **clips,
                    float **sampled, noh_transform **mapped)
{
    *view = noh_arena_carve(arena, sizeof **view, 16u);
    *clips = noh_arena_carve(arena, noh_clip_view_size(bank->cache), 16u);
    *sampled = noh_arena_carve(arena, bank->sampled_count * sizeof **sampled, 4u);
    *mapped = !NOH_PAGE && bank->map ? noh_arena_carve(arena, noh_bank_map_joints(bank->map) * sizeof **mapped, 4u)
                                     : NULL;
    return arena->used;
}

size_t noh_clip_bank_view_size(const noh_clip_bank *bank)
{
    noh_arena arena = noh_arena_measure();
    noh_clip_bank_view *view;
    void *clips;
    float *sampled;
    noh_transform *mapped;
    return carve(&arena, bank, &view, &clips, &sampled, &mapped);
}

noh_result noh_clip_bank_view_init(void *memory, size_t bytes, const noh_clip_bank *bank, noh_clip_bank_view **view,
                                   noh_error *error)
{
    noh_arena arena;
    noh_clip_bank_view *made;
    void *clips;
    float *sampled;
    noh_transform *mapped;
    noh_result r = noh_arena_open(&arena, memory, bytes, noh_clip_bank_view_size(bank), error);
    if (r) return r;
    (void)carve(&arena, bank, &made, &clips, &sampled, &mapped);
    r = noh_clip_view_init(clips, noh_clip_view_size(bank->cache), bank->cache, &made->samples, error);
    if (r) return r;
    made->clips = bank->clips;
    made->clips.sample = sample_view;
    made->clips.user = made;
    made->bank = bank;
    made->sampled = sampled;
    made->mapped = mapped;
    *view = made;
    return NOH_OK;
}
