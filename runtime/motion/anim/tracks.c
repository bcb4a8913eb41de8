/* tracks.c: playing one clip.
 *
 * A track's position is in 1/65,536 ticks and grows beyond the clip's end. It is folded into the clip only when it is
 * read, so that passes can be counted, and reduced by whole cycles after each move, so that it never overflows. A track
 * that was just placed has not passed the keys at its position yet: `placed` is 1 until it moves. */
#include "core/base/assert_internal.h"
#include "motion/anim/clip_set_internal.h"
#include "motion/anim/events_internal.h"
#include "motion/anim/time_internal.h"
#include "motion/anim/tracks_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

static const char *bad_desc(const noh_clip_set *set, const noh_track_desc *d)
{
    if (d->clip >= set->clip_count) return "clip is not a clip of the set";
    if (d->position_ticks > ((int64_t)1 << 44) || d->position_ticks < -((int64_t)1 << 44))
        return "position_ticks is beyond 2^44";
    if (d->speed > NOH_SPEED_MAX || d->speed < -NOH_SPEED_MAX) return "speed is above NOH_SPEED_MAX";
    if (!(d->weight >= 0.0f && d->weight <= NOH_WEIGHT_MAX)) return "weight must be 0 to NOH_WEIGHT_MAX";
    if ((unsigned)d->loop > NOH_LOOP_PING_PONG) return "loop is not a noh_loop";
    if ((unsigned)d->mode > NOH_TRACK_ON) return "mode is not a noh_track_mode";
    if ((unsigned)d->group > NOH_GROUP_HIGH) return "group is not a noh_track_group";
    if (d->mask > set->mask_count) return "mask is above mask_count of the set";
    if (d->lod_levels > 255u) return "lod_levels is above 255";
    if (d->sync_group > NOH_SYNC_GROUPS_MAX) return "sync_group is above NOH_SYNC_GROUPS_MAX";
    if (d->reference > set->clip_count) return "reference is above clip_count of the set";
    if (d->flags & ~NOH_TRACK_FLAGS) return "flags must be bits of NOH_TRACK_FLAGS";
    return NULL;
}

/* Only a repeating clip has a phase, and it must be long enough to be steered. */
static const char *bad_sync(const noh_clip_set *set, const noh_track_desc *d)
{
    const noh_clip_entry *m = &set->clips[d->clip];
    uint32_t loop = d->loop ? (uint32_t)d->loop : m->loop;
    int fits = m->duration_ticks >= NOH_SYNC_DURATION_MIN && m->duration_ticks <= NOH_SYNC_DURATION_MAX;
    return d->sync_group && (loop != NOH_LOOP_REPEAT || !fits)
               ? "sync_group: the clip must repeat, with a duration of NOH_SYNC_DURATION_MIN to _MAX"
               : NULL;
}

static uint32_t turns(const noh_track *track, const noh_clip_entry *clip)
{
    return track->loop == NOH_LOOP_PING_PONG && clip->loop != NOH_LOOP_PING_PONG ? NOH_TRACK_TURNS : 0;
}

noh_result noh_track_start(noh_track *track, const noh_clip_set *set, const noh_track_desc *desc, noh_error *error)
{
    NOH_ASSERT(track && set && desc);
    const char *what = bad_desc(set, desc);
    const noh_clip_entry *m;
    what = what ? what : bad_sync(set, desc);
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, 0, 0);
    }
    if (noh_clip_is_absent(set, desc->clip) || (desc->reference && noh_clip_is_absent(set, desc->reference - 1u))) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "the clip is not in memory: load it into clip_reserve first",
                        desc->clip, set->clip_count);
    }
    m = &set->clips[desc->clip];
    track->clip = (uint16_t)desc->clip;
    track->speed = desc->flags & NOH_TRACK_PAUSED ? 0 : desc->speed ? desc->speed : NOH_SPEED_ONE;
    track->speed_now = track->speed;
    track->weight = desc->flags & NOH_TRACK_SILENT ? 0.0f : desc->weight > 0.0f ? desc->weight : 1.0f;
    track->loop = (uint8_t)(desc->loop ? (uint32_t)desc->loop : m->loop);
    track->mode = (uint8_t)(desc->mode ? desc->mode : NOH_TRACK_ON);
    track->group = (uint8_t)desc->group;
    track->mask = (uint8_t)desc->mask;
    track->lod_levels = (uint8_t)desc->lod_levels;
    track->sync_group = (uint8_t)desc->sync_group;
    track->flags = (uint8_t)((desc->flags & (NOH_TRACK_ADDITIVE | NOH_TRACK_REFERENCE_START)) | turns(track, m));
    track->reference = (uint16_t)desc->reference;
    noh_track_place(track, m, noh_position_of(desc->position_ticks));
    return NOH_OK;
}

void noh_track_place(noh_track *track, const noh_clip_entry *clip, int64_t position)
{
    NOH_ASSERT(track && clip);
    position = noh_time_advance(position, 0, 0, clip->duration_ticks, (noh_loop)track->loop);
    track->position = position - noh_time_rebase(position, clip->duration_ticks, (noh_loop)track->loop);
    track->root_position = track->position;
    track->placed = 1;
}

noh_passage noh_track_passage(const noh_track *track, const noh_clip_entry *clip, int64_t ticks)
{
    noh_passage p;
    NOH_ASSERT(track && clip && ticks >= 0);
    p.from = track->position;
    p.to = noh_time_advance(track->position, track->speed_now, ticks, clip->duration_ticks, (noh_loop)track->loop);
    p.duration_ticks = clip->duration_ticks;
    p.loop = track->loop;
    p.backward = track->speed_now < 0;
    p.placed = track->placed;
    return p;
}

int64_t noh_track_next_event(const noh_track *track, const noh_clip_set *set, int64_t ticks)
{
    NOH_ASSERT(track && set && track->clip < set->clip_count && ticks >= 0);
    const noh_clip_entry *m = &set->clips[track->clip];
    noh_passage p;
    int64_t at, way, speed = track->speed_now < 0 ? -track->speed_now : track->speed_now;
    if (track->mode == NOH_TRACK_OFF || speed == 0 || m->event_count == 0 || ticks == 0) {
        return 0;
    }
    p = noh_track_passage(track, m, ticks);
    if (!noh_events_first(set->events + m->first_event, m->event_count, &p, &at)) {
        return 0;
    }
    way = noh_position_of(at) - track->position;
    way = way < 0 ? -way : way;
    /* Rounded up: the first tick by which the key is passed. The first move of a placed track passes a key exactly at
     * its position. */
    return way == 0 ? 1 : noh_ceil_div(way, speed);
}

int noh_track_ended(const noh_track *track, const noh_clip_entry *clip)
{
    NOH_ASSERT(track && clip);
    int64_t end = track->speed_now < 0 ? 0 : noh_position_of(clip->duration_ticks);
    return track->loop == NOH_LOOP_ONCE && track->position == end && !track->placed;
}

float noh_track_cover(const noh_track *track)
{
    NOH_ASSERT(track);
    if (track->full < 0.0f) return -track->full;
    return track->weight < track->full ? track->weight / track->full : 1.0f;
}

uint32_t noh_track_clip_tick(const noh_track *track, const noh_clip_entry *clip, int64_t ago)
{
    NOH_ASSERT(track && clip);
    noh_loop loop = (noh_loop)track->loop;
    /* a seek that fires keys may travel billions of passes within one tick: keep the product in range */
    const int64_t most = ((int64_t)1 << 61) / (ago > 0 ? ago : 1);
    int64_t speed = track->speed_now > most ? most : track->speed_now < -most ? -most : track->speed_now;
    int64_t position = noh_time_advance(track->position, -speed, ago, clip->duration_ticks, loop);
    return (uint32_t)(noh_time_clip(position, clip->duration_ticks, loop) / 65536);
}
