/* An upper bound on the events of a step: clip.h, noh_controller_events_max.
 *
 * Per track: the farthest it can travel, and the number of stretches of one direction, since each change of direction
 * can pass the keys around it again. noh_events_max turns both into a number of keys. */
#include "core/base/assert_internal.h"
#include "motion/anim/changes_internal.h"
#include "motion/anim/events_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "motion/anim/sync_internal.h"

/* Limits of a track's motion in a step. */
typedef struct play_bound {
    uint64_t travel; /* total movement, 1/65,536 ticks */
    uint64_t runs;   /* stretches of one direction */
} play_bound;

static uint64_t plus(uint64_t a, uint64_t b)
{
    return a > UINT64_MAX - b ? UINT64_MAX : a + b;
}

static uint64_t magnitude(int64_t a)
{
    return a < 0 ? (uint64_t)0 - (uint64_t)a : (uint64_t)a;
}

static const noh_change *changes_of(const noh_controller *c)
{
    return (const noh_change *)(const void *)((const uint8_t *)c + c->changes_offset);
}

static int concerns(const noh_change *change, uint32_t track, noh_change_kind kind)
{
    return change->state != NOH_CHANGE_FREE && change->kind == kind && change->track == track;
}

/* The highest speed of a track: its present one, or one set by a waiting or running change. */
static uint64_t speed_reached(const noh_controller *c, uint32_t track)
{
    const noh_change *changes = changes_of(c);
    uint64_t most = magnitude(noh_controller_track(c, track)->speed);
    for (uint32_t i = 0; i < c->change_count; i++) {
        if (concerns(&changes[i], track, NOH_CHANGE_SPEED)) {
            uint64_t to = magnitude(changes[i].to), from = magnitude(changes[i].from);
            most = to > most ? to : most;
            most = changes[i].state == NOH_CHANGE_RUNNING && from > most ? from : most;
        }
    }
    return most;
}

/* The shortest and the longest marker interval, in ticks. */
static void interval_range(const noh_clip_set *set, const noh_clip_entry *m, uint32_t *shortest, uint32_t *longest)
{
    const noh_marker *markers = set->markers + m->first_marker;
    *shortest = *longest = m->duration_ticks;
    for (uint32_t i = 0; i < m->marker_count; i++) {
        uint32_t next = i + 1 < m->marker_count ? markers[i + 1].tick : markers[0].tick + m->duration_ticks;
        uint32_t length = next - markers[i].tick;
        *shortest = length < *shortest ? length : *shortest;
        *longest = i == 0 || length > *longest ? length : *longest;
    }
}

/* A synchronised track moves at most at the phase speed of its group's fastest member, through its own longest
 * interval; the group may reverse whenever it gets new speeds. */
static play_bound sync_bound(const noh_controller *c, const noh_clip_set *set, uint32_t track, uint32_t ticks)
{
    const noh_track *t = noh_controller_track(c, track);
    uint32_t shortest, longest;
    uint64_t fastest = 0;
    play_bound r;
    for (uint32_t i = 0; i < c->track_count; i++) {
        const noh_track *other = noh_controller_track(c, i);
        if (other->sync_group == t->sync_group) {
            uint64_t speed;
            interval_range(set, &set->clips[other->clip], &shortest, &longest);
            speed = speed_reached(c, i) / shortest + 1u; /* intervals per 65,536 ticks */
            fastest = speed > fastest ? speed : fastest;
        }
    }
    interval_range(set, &set->clips[t->clip], &shortest, &longest);
    r.runs = (uint64_t)ticks / NOH_SYNC_TICKS + c->change_count + 2u;
    r.travel = plus(fastest * longest > UINT64_MAX / ((uint64_t)ticks + 1u) ? UINT64_MAX : fastest * longest * ticks,
                    2u * 65536u);
    return r;
}

/* A track without a sync group: its highest speed all the time; a change of speed may reverse it, and a change of
 * position may take it to its target, from where it plays on. */
static play_bound free_bound(const noh_controller *c, uint32_t track, uint32_t ticks)
{
    const noh_change *changes = changes_of(c);
    play_bound r = { 0, 1 };
    uint64_t way = speed_reached(c, track) * ticks;
    r.travel = way;
    for (uint32_t i = 0; i < c->change_count; i++) {
        if (concerns(&changes[i], track, NOH_CHANGE_SPEED)) {
            r.runs += 2;
        } else if (concerns(&changes[i], track, NOH_CHANGE_POSITION)) {
            uint64_t there = plus(magnitude(changes[i].to - noh_controller_track(c, track)->position), way);
            r.runs += 3;
            r.travel = plus(r.travel, plus(there, there)); /* to the target, and possibly from there to the next one */
        }
    }
    return r;
}

/* Off, with no change waiting that could switch it on. */
static int stays_off(const noh_controller *c, uint32_t track)
{
    const noh_change *changes = changes_of(c);
    int off = noh_controller_track(c, track)->mode == NOH_TRACK_OFF;
    for (uint32_t i = 0; i < c->change_count; i++) {
        off = off && !concerns(&changes[i], track, NOH_CHANGE_MODE);
    }
    return off;
}

uint32_t noh_controller_events_max(const noh_controller *c, const noh_clip_set *set, uint32_t ticks)
{
    uint64_t most = 0;
    NOH_ASSERT(c && set && set->clip_count == c->clip_count);
    for (uint32_t i = 0; ticks && i < c->track_count; i++) {
        const noh_track *t = noh_controller_track(c, i);
        const noh_clip_entry *m = &set->clips[t->clip];
        if (m->event_count && !stays_off(c, i)) {
            play_bound r = t->sync_group ? sync_bound(c, set, i, ticks) : free_bound(c, i, ticks);
            uint32_t runs = r.runs > UINT32_MAX ? UINT32_MAX : (uint32_t)r.runs;
            most += noh_events_max(m->event_count, m->duration_ticks, (noh_loop)t->loop, r.travel, runs);
        }
    }
    return most > NOH_STEP_EVENTS_MAX ? NOH_STEP_EVENTS_MAX : (uint32_t)most;
}
