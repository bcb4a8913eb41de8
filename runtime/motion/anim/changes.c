/* changes.c: fades and other changes over time.
 *
 * A change waits in a table until its tick, then stores its start value and runs. A weight is a function of the clock
 * alone and can be evaluated at the end of a step. A speed cannot: it moves tracks by its integral. So speeds are
 * constant over slices of whole ticks, NOH_CHANGE_SLICES per change, and noh_changes_speeds returns the tick up to
 * which they hold. The integral is then a product of integers, however time is split into steps. */
#include "core/base/assert_internal.h"
#include "motion/anim/changes_internal.h"
#include "motion/anim/time_internal.h"
#include "motion/anim/tracks_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

#include <string.h>

#include "motion/anim/clock_internal.h"

#define CURVE_ONE 2097152 /* 128^3: value 1 of the curves in integers, at whole and half slices */
#define HALVES (2 * NOH_CHANGE_SLICES)

NOH_STATIC_ASSERT(HALVES == 128, curve_one_is_a_cube);

float noh_curve_at(noh_curve curve, float t)
{
    float s = t > 0.0f ? (t < 1.0f ? t : 1.0f) : 0.0f;
    return curve == NOH_CURVE_SMOOTHSTEP ? s * s * (3.0f - 2.0f * s) : s;
}

/* The curve after `halves` half slices, 0..CURVE_ONE. */
static int64_t curve_fixed(uint32_t curve, int64_t halves)
{
    return curve == NOH_CURVE_SMOOTHSTEP ? halves * halves * (3 * HALVES - 2 * halves) : halves * (CURVE_ONE / HALVES);
}

/* Compute difference * factor / CURVE_ONE; the product itself would overflow. */
static int64_t scaled(int64_t difference, int64_t factor)
{
    return difference / CURVE_ONE * factor + difference % CURVE_ONE * factor / CURVE_ONE;
}

static int64_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return (int64_t)bits;
}

static float float_of(int64_t bits)
{
    uint32_t word = (uint32_t)bits;
    float value;
    memcpy(&value, &word, sizeof value);
    return value;
}

/* ---- adding ---- */

static const char *bad_value(const noh_change_desc *d)
{
    float weight_max = d->kind == NOH_CHANGE_PRIORITY ? 1.0f : NOH_WEIGHT_MAX;
    if (d->speed > NOH_SPEED_MAX || d->speed < -NOH_SPEED_MAX) return "speed is above NOH_SPEED_MAX";
    if (!(d->weight >= 0.0f && d->weight <= weight_max))
        return "weight must be 0 to NOH_WEIGHT_MAX, or 0 to 1 for PRIORITY";
    if (d->position_ticks > ((int64_t)1 << 44) || d->position_ticks < -((int64_t)1 << 44))
        return "position_ticks is beyond 2^44";
    if ((unsigned)d->mode > NOH_TRACK_ON) return "mode is not a noh_track_mode";
    return NULL;
}

static const char *bad_change(const noh_change_target *target, uint32_t track_count, const noh_change_desc *d)
{
    if ((unsigned)d->kind > NOH_CHANGE_PRIORITY) return "kind is not a noh_change_kind";
    if (d->kind != NOH_CHANGE_PRIORITY && d->track >= track_count) return "track must be below track_count";
    if (d->kind == NOH_CHANGE_POSITION && target->tracks[d->track].sync_group)
        return "track is synchronised: its group moves it";
    if ((unsigned)d->curve > NOH_CURVE_SMOOTHSTEP) return "curve is not a noh_curve";
    if (d->kind == NOH_CHANGE_MODE && d->duration_ticks) return "duration_ticks must be 0 for MODE";
    return bad_value(d);
}

static int64_t wanted(const noh_change_desc *d)
{
    switch (d->kind) {
    case NOH_CHANGE_SPEED: return d->speed;
    case NOH_CHANGE_POSITION: return noh_position_of(d->position_ticks);
    case NOH_CHANGE_MODE: return d->mode;
    default: return bits_of(d->weight);
    }
}

/* The entry to fill: a change of the same kind and track that waits for the same tick, else a free one, else NULL. */
static noh_change *entry_for(noh_change *table, uint32_t count, const noh_change *c)
{
    noh_change *free_one = NULL;
    for (uint32_t i = 0; i < count; i++) {
        noh_change *t = &table[i];
        if (t->state == NOH_CHANGE_WAITING && t->kind == c->kind && t->track == c->track && t->start == c->start) {
            return t;
        }
        if (t->state == NOH_CHANGE_FREE && !free_one) {
            free_one = t;
        }
    }
    return free_one;
}

static noh_result add(noh_change *table, uint32_t count, noh_change_target *target, const noh_change *c,
                      noh_error *error)
{
    noh_change *entry = entry_for(table, count, c);
    if (!entry) {
        return noh_fail(error, NOH_ERR_LIMIT, "the table of changes is full: raise change_count", count,
                        (uint64_t)count + 1u);
    }
    *entry = *c;
    if (c->start == target->clock) {
        noh_changes_update(table, count, target);
    }
    return NOH_OK;
}

noh_result noh_changes_add(noh_change *table, uint32_t count, noh_change_target *target, uint32_t track_count,
                           const noh_change_desc *desc, noh_error *error)
{
    NOH_ASSERT(table && target && desc && target->set && target->tracks && target->priority_blend);
    const char *what = bad_change(target, track_count, desc);
    noh_change c;
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, desc->track, 0);
    }
    memset(&c, 0, sizeof c);
    c.start = noh_clock_add(target->clock, desc->delay_ticks);
    c.to = wanted(desc);
    c.duration = desc->duration_ticks;
    c.state = NOH_CHANGE_WAITING;
    c.kind = (uint8_t)desc->kind;
    c.curve = (uint8_t)desc->curve;
    c.track = desc->kind == NOH_CHANGE_PRIORITY ? (uint8_t)0 : (uint8_t)desc->track;
    return add(table, count, target, &c, error);
}

noh_result noh_changes_jump(noh_change *table, uint32_t count, noh_change_target *target, uint32_t track,
                            int64_t position, noh_error *error)
{
    noh_change c;
    NOH_ASSERT(table && target && target->tracks);
    memset(&c, 0, sizeof c);
    c.start = target->clock;
    c.to = position;
    c.duration = 1;
    c.state = NOH_CHANGE_WAITING;
    c.kind = NOH_CHANGE_POSITION;
    c.curve = NOH_CURVE_JUMP;
    c.track = (uint8_t)track;
    return add(table, count, target, &c, error);
}

void noh_changes_cancel(noh_change *table, uint32_t count, noh_change_kind kind, uint32_t track)
{
    NOH_ASSERT(table || !count);
    for (uint32_t i = 0; i < count; i++) {
        if (table[i].state == NOH_CHANGE_RUNNING && table[i].kind == kind && table[i].track == track) {
            table[i].state = NOH_CHANGE_FREE;
        }
    }
}

void noh_changes_drop(noh_change *table, uint32_t count, uint32_t track)
{
    NOH_ASSERT(table || !count);
    for (uint32_t i = 0; i < count; i++) {
        if (table[i].kind != NOH_CHANGE_PRIORITY && table[i].track == track) {
            table[i].state = NOH_CHANGE_FREE;
        }
    }
}

/* ---- following ---- */

static noh_track *track_of(const noh_change *c, noh_change_target *t)
{
    return &t->tracks[c->track];
}

static const noh_clip_entry *clip_of(const noh_change *c, const noh_change_target *t)
{
    return &t->set->clips[t->tracks[c->track].clip];
}

static int64_t present(const noh_change *c, noh_change_target *t)
{
    switch (c->kind) {
    case NOH_CHANGE_SPEED: return track_of(c, t)->speed;
    case NOH_CHANGE_WEIGHT: return bits_of(track_of(c, t)->weight);
    case NOH_CHANGE_POSITION: return track_of(c, t)->position;
    case NOH_CHANGE_MODE: return track_of(c, t)->mode;
    default: return bits_of(*t->priority_blend);
    }
}

static void set_weight(const noh_change *c, noh_change_target *t, float weight)
{
    if (c->kind == NOH_CHANGE_PRIORITY) {
        *t->priority_blend = weight;
    } else {
        track_of(c, t)->weight = weight;
    }
}

/* At its full weight a track becomes an ordinary one. */
static void settle_full(noh_track *track)
{
    if (track->full > 0.0f && track->weight >= track->full) {
        track->full = 0.0f;
        track->flags = (uint8_t)(track->flags & ~NOH_TRACK_RISES);
    }
}

/* End a change: set its end value exactly. A position has arrived already. */
static void finish(noh_change *c, noh_change_target *t)
{
    noh_track *track = track_of(c, t);
    c->state = NOH_CHANGE_FREE;
    t->sync_touched |= c->kind != NOH_CHANGE_PRIORITY && track->sync_group;
    switch (c->kind) {
    case NOH_CHANGE_SPEED: track->speed = (int32_t)c->to; break;
    case NOH_CHANGE_MODE: track->mode = (uint8_t)c->to; break;
    case NOH_CHANGE_POSITION:
        if (c->duration == 0) {
            noh_track_place(track, clip_of(c, t), c->to);
        } else if (c->curve == NOH_CURVE_JUMP) {
            track->root_position = track->position;
        }
        break;
    case NOH_CHANGE_WEIGHT:
        set_weight(c, t, float_of(c->to));
        settle_full(track);
        break;
    default: set_weight(c, t, float_of(c->to)); break;
    }
}

static void begin(noh_change *table, uint32_t count, noh_change *c, noh_change_target *t)
{
    noh_changes_cancel(table, count, (noh_change_kind)c->kind, c->track);
    c->from = present(c, t);
    if (c->kind == NOH_CHANGE_POSITION) {
        const noh_clip_entry *m = clip_of(c, t);
        c->to = noh_time_advance(c->to, 0, 0, m->duration_ticks, (noh_loop)track_of(c, t)->loop);
    }
    c->state = NOH_CHANGE_RUNNING;
}

static void follow(const noh_change *c, noh_change_target *t)
{
    if (c->kind == NOH_CHANGE_WEIGHT || c->kind == NOH_CHANGE_PRIORITY) {
        float from = float_of(c->from), to = float_of(c->to);
        float s = noh_curve_at((noh_curve)c->curve, (float)(t->clock - c->start) / (float)c->duration);
        set_weight(c, t, from + (to - from) * s);
    }
}

/* Running changes first, so that a change that begins starts from the value at this tick. */
void noh_changes_update(noh_change *table, uint32_t count, noh_change_target *target)
{
    NOH_ASSERT(target && (table || !count));
    for (uint32_t i = 0; i < count; i++) {
        if (table[i].state != NOH_CHANGE_RUNNING) {
            continue;
        }
        if (target->clock - table[i].start >= table[i].duration) {
            finish(&table[i], target);
        } else {
            follow(&table[i], target);
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        if (table[i].state == NOH_CHANGE_WAITING && table[i].start <= target->clock) {
            begin(table, count, &table[i], target);
            if (table[i].duration == 0) {
                finish(&table[i], target);
            }
        }
    }
}

/* ---- speeds ---- */

/* A stretch of whole ticks with constant speed. A change shorter than NOH_CHANGE_SLICES ticks has empty slices; their
 * part of the curve moves to the next slice that is not empty. */
typedef struct slice {
    int64_t begin, end;   /* ticks after the change's start */
    int64_t first, after; /* the part of the curve, in slices */
} slice;

/* The last slice that begins at or before a tick. */
static int64_t slice_number(int64_t duration, int64_t elapsed)
{
    return noh_ceil_div((elapsed + 1) * NOH_CHANGE_SLICES, duration) - 1;
}

static slice slice_at(const noh_change *c, int64_t elapsed)
{
    int64_t duration = c->duration, number = slice_number(duration, elapsed);
    slice s;
    s.begin = duration * number / NOH_CHANGE_SLICES;
    s.end = duration * (number + 1) / NOH_CHANGE_SLICES;
    s.first = slice_number(duration, s.begin - 1) + 1;
    s.after = number + 1;
    return s;
}

/* The speed of one slice: the curve's value at its middle. For a linear curve this is the mean over the slice, for
 * smoothstep within 1/64^2 of it. Returns the tick, after the start, up to which it holds. */
static int64_t slice_speed(const noh_change *c, int64_t elapsed, int32_t *speed)
{
    slice s = slice_at(c, elapsed);
    int64_t middle = curve_fixed(c->curve, s.first + s.after);
    *speed = (int32_t)(c->from + noh_floor_div((c->to - c->from) * middle + CURVE_ONE / 2, CURVE_ONE));
    return s.end;
}

/* The speed of a move to a position. The distance of each slice is split into steps of one tick with two lengths that
 * differ by one, the longer ones last (Bresenham's line in two runs), so that each slice ends exactly on the curve.
 * Returns the tick, after the start, up to which the speed holds. */
static int64_t travel_speed(const noh_change *c, int64_t elapsed, int64_t *speed)
{
    slice s = slice_at(c, elapsed);
    int64_t way = c->to - c->from, ticks = s.end - s.begin;
    int64_t slice_way = scaled(way, curve_fixed(c->curve, 2 * s.after)) -
                        scaled(way, curve_fixed(c->curve, 2 * s.first));
    int64_t step = noh_floor_div(slice_way, ticks), rest = slice_way - step * ticks;
    int64_t turn = s.end - rest; /* from here on, one more per tick */
    *speed = elapsed < turn ? step : step + 1;
    return elapsed < turn ? turn : s.end;
}

static int runs(const noh_change *c, noh_change_kind kind)
{
    return c->state == NOH_CHANGE_RUNNING && c->kind == kind;
}

static int64_t sooner(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static int64_t apply_speeds(const noh_change *table, uint32_t count, const noh_change_target *target, int64_t end)
{
    for (uint32_t i = 0; i < count; i++) {
        if (runs(&table[i], NOH_CHANGE_SPEED)) {
            int64_t held = slice_speed(&table[i], target->clock - table[i].start,
                                       &target->tracks[table[i].track].speed);
            end = sooner(end, noh_clock_add(table[i].start, held));
        }
    }
    return end;
}

static int64_t apply_travels(const noh_change *table, uint32_t count, const noh_change_target *target, int64_t end)
{
    for (uint32_t i = 0; i < count; i++) {
        if (runs(&table[i], NOH_CHANGE_POSITION)) {
            int64_t held = travel_speed(&table[i], target->clock - table[i].start,
                                        &target->tracks[table[i].track].speed_now);
            end = sooner(end, noh_clock_add(table[i].start, held));
        }
    }
    return end;
}

/* The tick of the next change that begins or ends. */
static int64_t next_change(const noh_change *table, uint32_t count, int64_t end)
{
    for (uint32_t i = 0; i < count; i++) {
        if (table[i].state == NOH_CHANGE_WAITING) {
            end = sooner(end, table[i].start);
        } else if (table[i].state == NOH_CHANGE_RUNNING) {
            end = sooner(end, noh_clock_add(table[i].start, table[i].duration));
        }
    }
    return end;
}

int64_t noh_changes_speeds(const noh_change *table, uint32_t count, const noh_change_target *target,
                           uint32_t track_count, int64_t end)
{
    NOH_ASSERT(target && (table || !count) && end >= target->clock);
    end = apply_speeds(table, count, target, next_change(table, count, end));
    for (uint32_t i = 0; i < track_count; i++) {
        noh_track *track = &target->tracks[i];
        if (!track->sync_group) {
            track->speed_now = track->speed;
        }
    }
    return apply_travels(table, count, target, end);
}
