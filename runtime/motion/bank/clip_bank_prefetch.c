/* clip_bank_prefetch.c: the segments that a controller will need soon.
 *
 * A track plays in legs: passes of its clip, forwards or (every other one of a ping-pong clip) backwards. The stretch
 * of play from its position to where it will be after `ahead_ticks` is cut at the ends of legs; each piece covers one
 * run of frames, and all segments with those frames are requested. Three pieces are enough: the rest of this leg and
 * one whole leg cover the whole clip, and anything later needs no other segment. */
#include "motion/bank/clip_bank_internal.h"
#include "motion/clip/clip_internal.h"
#include "core/base/assert_internal.h"
#include "motion/anim/clip_set_internal.h"
#include "motion/anim/time_internal.h"
#include "motion/clip/clip_cache_internal.h"
#include "motion/clip/clip_codec_internal.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

#define LEGS_MAX 3

/* The part of a clip played in one leg: ticks, in the order of play. */
typedef struct stretch {
    int64_t from, to;
} stretch;

static uint32_t want_stretch(const noh_clip_bank *bank, uint32_t index, stretch s, uint32_t joint_count)
{
    if (!NOH_PAGE && bank->bound[index].is_mapped) joint_count = bank->map->source->joint_count;
    const noh_clip *clip = noh_clip_cache_clip(bank->cache, index);
    float fraction;
    uint32_t first = noh_clip_frame_at(clip, s.from, &fraction), last = noh_clip_frame_at(clip, s.to, &fraction);
    uint32_t *later = s.to >= s.from ? &last : &first;
    if (*later + 1u < clip->info.frame_count) {
        ++*later; /* a sample needs the frames on both sides */
    }
    return noh_clip_cache_want_frames(bank->cache, index, first, last, joint_count);
}

/* Positions inside one leg, as clip ticks. */
static stretch fold(const noh_clip_entry *m, noh_loop loop, int64_t leg, int64_t from, int64_t to)
{
    const int64_t duration = noh_position_of(m->duration_ticks), start = leg * duration;
    const int back = loop == NOH_LOOP_PING_PONG && (leg & 1);
    stretch s;
    s.from = (back ? duration - (from - start) : from - start) / 65536;
    s.to = (back ? duration - (to - start) : to - start) / 65536;
    return s;
}

static uint32_t want_track(const noh_clip_bank *bank, const noh_track *t, uint32_t ahead_ticks, uint32_t joint_count)
{
    const noh_clip_entry *m = &bank->clips.clips[t->clip];
    const noh_loop loop = (noh_loop)t->loop;
    const int64_t duration = noh_position_of(m->duration_ticks);
    const int64_t end = noh_time_advance(t->position, t->speed_now, ahead_ticks, m->duration_ticks, loop);
    const int64_t step = end < t->position ? -1 : 1;
    int64_t at = t->position, leg = noh_time_legs(at, m->duration_ticks, loop);
    uint32_t missing = 0;
    for (int i = 0; i < LEGS_MAX; i++, leg += step) {
        const int64_t edge = (leg + (step > 0)) * duration; /* the end of this leg in the direction of play */
        const int last = loop == NOH_LOOP_ONCE || duration == 0 || (step > 0 ? end <= edge : end >= edge);
        missing += want_stretch(bank, t->clip, fold(m, loop, leg, at, last ? end : edge), joint_count);
        if (last) break;
        at = edge;
    }
    return missing;
}

uint32_t noh_clip_bank_prefetch(noh_clip_bank *bank, const noh_controller *controller, uint32_t ahead_ticks)
{
    uint32_t missing = 0;
    NOH_ASSERT(controller->clip_count >= bank->clips.clip_count && controller->joint_count == bank->clips.joint_count);
    for (uint32_t i = 0; i < controller->track_count; i++) {
        const noh_track *t = noh_controller_track(controller, i);
        const noh_clip_entry *m;
        if (t->clip >= bank->clips.clip_count || t->mode != NOH_TRACK_ON ||
            (t->lod_levels && controller->lod >= t->lod_levels) || noh_clip_is_absent(&bank->clips, t->clip)) {
            continue; /* clips past the bank's are the caller's own */
        }
        m = &bank->clips.clips[t->clip];
        if (bank->clips.roots) { /* root motion starts from the position of its last call */
            const int64_t tick = noh_time_clip(t->root_position, m->duration_ticks, (noh_loop)t->loop) / 65536;
            const stretch before = { tick, tick };
            missing += want_stretch(bank, t->clip, before, 1);
        }
        missing += want_track(bank, t, ahead_ticks, controller->lod_joint_count);
    }
    return missing;
}
