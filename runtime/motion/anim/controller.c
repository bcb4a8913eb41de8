/* controller.c: tracks, changes and callback keys on one clock.
 *
 * A controller is one block: header, tracks, table of changes, then the inertial offsets if there is room for them.
 * Arrays are found by offset and clips by index in the set, so the block has no pointers and can be copied. */
#include "core/base/assert_internal.h"
#include "motion/anim/changes_internal.h"
#include "motion/anim/controller_internal.h"
#include "motion/anim/events_internal.h"
#include "motion/anim/time_internal.h"
#include "motion/anim/tracks_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

#include <string.h>

#include "motion/anim/clock_internal.h"
#include "motion/pose/inertial_internal.h"
#include "motion/anim/sync_internal.h"

/* Whether a controller was made for a set like this one; for asserts. */
#define IS_SET_OF(c, set) ((set) && (set)->clip_count == (c)->clip_count && (set)->joint_count == (c)->joint_count)

/* private flags, above the public ones */
#define STEPPING 64u      /* inside noh_controller_step */
#define SYNC_TOUCHED 128u /* sync groups need new speeds before the next multiple of NOH_SYNC_TICKS */

/* ---- memory ---- */

typedef struct layout {
    size_t tracks, changes, inertia, inertia_floats, bytes;
} layout;

static uint32_t track_count_of(const noh_controller_desc *d)
{
    return d->track_count ? d->track_count : 4u;
}

static uint32_t change_count_of(const noh_controller_desc *d)
{
    return d->change_count ? d->change_count : track_count_of(d) + 2u;
}

static const char *bad_desc(const noh_controller_desc *d)
{
    if (!d->set || d->set->joint_count > NOH_JOINTS_MAX || d->set->float_count > NOH_FLOATS_MAX)
        return "set is NULL, has neither joints nor floats, or exceeds NOH_JOINTS_MAX or NOH_FLOATS_MAX";
    if (d->set->joint_count == 0 && d->set->float_count == 0)
        return "set is NULL, has neither joints nor floats, or exceeds NOH_JOINTS_MAX or NOH_FLOATS_MAX";
    if (d->track_count > NOH_TRACKS_MAX) return "track_count is above NOH_TRACKS_MAX";
    if (d->change_count > NOH_CHANGES_MAX) return "change_count is above NOH_CHANGES_MAX";
    if (d->flags & ~(NOH_CONTROLLER_INERTIAL | NOH_CONTROLLER_COVERS))
        return "flags must be NOH_CONTROLLER_INERTIAL and NOH_CONTROLLER_COVERS only";
    return NULL;
}

static size_t place(noh_arena *arena, size_t bytes)
{
    (void)noh_arena_carve(arena, bytes, 8);
    return arena->used - bytes;
}

/* In order of decreasing alignment: 8 bytes for the head and the tables, 4 for the offsets. */
static layout layout_of(const noh_controller_desc *d)
{
    noh_arena arena = noh_arena_measure();
    layout l = { 0, 0, 0, 0, 0 };
    (void)place(&arena, sizeof(noh_controller));
    l.tracks = place(&arena, track_count_of(d) * sizeof(noh_track));
    l.changes = place(&arena, change_count_of(d) * sizeof(noh_change));
    if (d->flags & NOH_CONTROLLER_INERTIAL) {
        l.inertia = place(&arena, d->set->joint_count * sizeof(noh_inertia_joint));
        l.inertia_floats = place(&arena, d->set->float_count * sizeof(noh_inertia_float));
    }
    l.bytes = arena.used;
    return l;
}

size_t noh_controller_size(const noh_controller_desc *desc)
{
    NOH_ASSERT(desc);
    return bad_desc(desc) ? 0 : layout_of(desc).bytes;
}

static void fill_head(noh_controller *c, const noh_controller_desc *d, layout l)
{
    c->bytes = (uint32_t)l.bytes;
    c->clip_count = d->set->clip_count;
    c->joint_count = c->lod_joint_count = d->set->joint_count;
    c->float_count = d->set->float_count;
    c->mask_count = d->set->mask_count;
    c->track_count = track_count_of(d);
    c->change_count = change_count_of(d);
    c->tracks_offset = (uint32_t)l.tracks;
    c->changes_offset = (uint32_t)l.changes;
    c->inertia_offset = (uint32_t)l.inertia;
    c->inertia_floats_offset = (uint32_t)l.inertia_floats;
    c->priority_blend = 1.0f;
    c->flags = (uint8_t)d->flags;
}

noh_result noh_controller_init(void *memory, size_t bytes, const noh_controller_desc *desc, noh_controller **controller,
                               noh_error *error)
{
    NOH_ASSERT(desc && controller);
    const char *what = bad_desc(desc);
    noh_arena arena;
    noh_result result;
    layout l;
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, 0, 0);
    }
    l = layout_of(desc);
    result = noh_arena_open(&arena, memory, bytes, l.bytes, error);
    if (result != NOH_OK) {
        return result;
    }
    memset(memory, 0, l.bytes);
    fill_head((noh_controller *)memory, desc, l);
    *controller = (noh_controller *)memory;
    return NOH_OK;
}

noh_track *noh_controller_tracks(noh_controller *c)
{
    NOH_ASSERT(c);
    return (noh_track *)(void *)((uint8_t *)c + c->tracks_offset);
}

const noh_track *noh_controller_track(const noh_controller *c, uint32_t track)
{
    NOH_ASSERT(track < c->track_count);
    return (const noh_track *)(const void *)((const uint8_t *)c + c->tracks_offset) + track;
}

static noh_change *changes_of(noh_controller *c)
{
    return (noh_change *)(void *)((uint8_t *)c + c->changes_offset);
}

static noh_change_target target_of(noh_controller *c, const noh_clip_set *set)
{
    noh_change_target t = { NULL, NULL, NULL, 0, 0 };
    t.set = set;
    t.tracks = noh_controller_tracks(c);
    t.priority_blend = &c->priority_blend;
    t.clock = c->clock;
    return t;
}

/* After the table of changes was modified: update its high-water mark and the sync groups. */
static void settle(noh_controller *c, const noh_change_target *t)
{
    const noh_change *changes = changes_of(c);
    uint16_t used = 0;
    for (uint32_t i = 0; i < c->change_count; i++) {
        used = (uint16_t)(used + (changes[i].state != NOH_CHANGE_FREE));
    }
    c->changes_high_water = used > c->changes_high_water ? used : c->changes_high_water;
    c->flags = (uint8_t)(c->flags | (t->sync_touched ? SYNC_TOUCHED : 0u));
}

/* ---- tracks ---- */

/* Whether the markers of a joining track match its sync group's. */
static int sync_fits(const noh_controller *c, const noh_clip_set *set, uint32_t track, const noh_track *joining)
{
    for (uint32_t i = 0; i < c->track_count; i++) {
        const noh_track *other = noh_controller_track(c, i);
        if (i != track && other->sync_group == joining->sync_group && other->mode != NOH_TRACK_OFF &&
            !noh_sync_fits(set, &set->clips[other->clip], &set->clips[joining->clip])) {
            return 0;
        }
    }
    return 1;
}

noh_result noh_controller_start(noh_controller *c, const noh_clip_set *set, uint32_t track, const noh_track_desc *desc,
                                noh_error *error)
{
    NOH_ASSERT(c && desc && IS_SET_OF(c, set));
    noh_track started;
    noh_track *tracks = noh_controller_tracks(c);
    noh_result result;
    memset(&started, 0, sizeof started);
    if (track >= c->track_count) {
        return noh_fail(error, NOH_ERR_ARG, "track must be below track_count", track, c->track_count);
    }
    result = noh_track_start(&started, set, desc, error);
    if (result != NOH_OK) {
        return result;
    }
    if (started.sync_group && !sync_fits(c, set, track, &started)) {
        return noh_fail(error, NOH_ERR_ARG, "the clip's sync markers differ from its sync group's", track, 0);
    }
    noh_changes_drop(changes_of(c), c->change_count, track);
    tracks[track].mode = NOH_TRACK_OFF; /* it may have led the group that it joins */
    if (started.sync_group) {
        uint32_t leader = noh_sync_leader(tracks, c->track_count, started.sync_group);
        if (leader < c->track_count) {
            noh_sync_join(set, &started, &tracks[leader]);
        }
    }
    tracks[track] = started;
    c->flags |= SYNC_TOUCHED;
    return NOH_OK;
}

/* Move the other tracks of a sync group to the phase of one track. */
static void gather_group(noh_controller *c, const noh_clip_set *set, uint32_t track)
{
    noh_track *tracks = noh_controller_tracks(c);
    for (uint32_t i = 0; i < c->track_count; i++) {
        if (i != track && tracks[i].sync_group == tracks[track].sync_group && tracks[i].mode != NOH_TRACK_OFF) {
            noh_sync_join(set, &tracks[i], &tracks[track]);
        }
    }
    c->flags |= SYNC_TOUCHED;
}

/* The position of a tick in the present pass (in a ping-pong clip, the present cycle): the durations passed so far,
 * plus the tick. */
static int64_t seek_position(const noh_track *t, const noh_clip_entry *m, int64_t tick)
{
    int64_t legs = noh_time_legs(t->position, m->duration_ticks, (noh_loop)t->loop);
    if (t->loop == NOH_LOOP_PING_PONG) {
        legs = noh_floor_div(legs, 2) * 2;
    }
    return noh_position_of(legs * (int64_t)m->duration_ticks + tick);
}

noh_result noh_controller_seek(noh_controller *c, const noh_clip_set *set, uint32_t track, int64_t tick,
                               noh_seek policy, noh_error *error)
{
    noh_track *t;
    const noh_clip_entry *m;
    int64_t position;
    NOH_ASSERT(c && IS_SET_OF(c, set));
    if (track >= c->track_count)
        return noh_fail(error, NOH_ERR_ARG, "track must be below track_count", track, c->track_count);
    if (tick > (int64_t)1 << 43 || tick < -((int64_t)1 << 43))
        return noh_fail(error, NOH_ERR_ARG, "tick is beyond 2^43", track, 0);
    if ((unsigned)policy > NOH_SEEK_FIRE) return noh_fail(error, NOH_ERR_ARG, "policy is not a noh_seek", track, 0);
    t = &noh_controller_tracks(c)[track];
    m = &set->clips[t->clip];
    position = seek_position(t, m, tick);
    if (policy == NOH_SEEK_FIRE) {
        noh_change_target target = target_of(c, set);
        noh_result result;
        if (t->sync_group) return noh_fail(error, NOH_ERR_ARG, "track is synchronised: its group moves it", track, 0);
        result = noh_changes_jump(changes_of(c), c->change_count, &target, track, position, error);
        settle(c, &target);
        return result;
    }
    noh_changes_cancel(changes_of(c), c->change_count, NOH_CHANGE_POSITION, track);
    noh_track_place(t, m, position);
    if (t->sync_group) {
        gather_group(c, set, track);
    }
    return NOH_OK;
}

noh_result noh_controller_set_speed(noh_controller *c, uint32_t track, int32_t speed)
{
    NOH_ASSERT(c);
    if (track >= c->track_count || speed > NOH_SPEED_MAX || speed < -NOH_SPEED_MAX) {
        return NOH_ERR_ARG;
    }
    noh_changes_cancel(changes_of(c), c->change_count, NOH_CHANGE_SPEED, track);
    noh_controller_tracks(c)[track].speed = speed;
    c->flags |= SYNC_TOUCHED;
    return NOH_OK;
}

noh_result noh_controller_set_weight(noh_controller *c, uint32_t track, float weight)
{
    NOH_ASSERT(c);
    if (track >= c->track_count || !(weight >= 0.0f && weight <= NOH_WEIGHT_MAX)) {
        return NOH_ERR_ARG;
    }
    noh_changes_cancel(changes_of(c), c->change_count, NOH_CHANGE_WEIGHT, track);
    noh_controller_tracks(c)[track].weight = weight;
    c->flags |= SYNC_TOUCHED;
    return NOH_OK;
}

noh_result noh_controller_set_mode(noh_controller *c, uint32_t track, noh_track_mode mode)
{
    NOH_ASSERT(c);
    if (track >= c->track_count || (unsigned)mode > NOH_TRACK_ON) {
        return NOH_ERR_ARG;
    }
    noh_changes_cancel(changes_of(c), c->change_count, NOH_CHANGE_MODE, track);
    noh_controller_tracks(c)[track].mode = (uint8_t)mode;
    c->flags |= SYNC_TOUCHED;
    return NOH_OK;
}

noh_result noh_controller_set_priority_blend(noh_controller *c, float blend)
{
    NOH_ASSERT(c);
    if (!(blend >= 0.0f && blend <= 1.0f)) {
        return NOH_ERR_ARG;
    }
    noh_changes_cancel(changes_of(c), c->change_count, NOH_CHANGE_PRIORITY, 0);
    c->priority_blend = blend;
    return NOH_OK;
}

noh_result noh_controller_set_lod(noh_controller *c, uint32_t lod, uint32_t joint_count)
{
    NOH_ASSERT(c);
    if (lod > 255u || joint_count > c->joint_count) {
        return NOH_ERR_ARG;
    }
    c->lod = (uint8_t)lod;
    c->lod_joint_count = joint_count ? joint_count : c->joint_count;
    return NOH_OK;
}

/* ---- changes ---- */

noh_result noh_controller_change(noh_controller *c, const noh_clip_set *set, const noh_change_desc *desc,
                                 noh_error *error)
{
    noh_change_target target = target_of(c, set);
    noh_result result = noh_changes_add(changes_of(c), c->change_count, &target, c->track_count, desc, error);
    NOH_ASSERT(c && desc && IS_SET_OF(c, set));
    settle(c, &target);
    return result;
}

static uint32_t free_changes(noh_controller *c)
{
    const noh_change *changes = changes_of(c);
    uint32_t count = 0;
    for (uint32_t i = 0; i < c->change_count; i++) {
        count += changes[i].state == NOH_CHANGE_FREE;
    }
    return count;
}

noh_result noh_controller_cross_fade(noh_controller *c, const noh_clip_set *set, uint32_t from, uint32_t to,
                                     float weight, uint32_t duration_ticks, noh_curve curve, noh_error *error)
{
    noh_change_desc d;
    NOH_ASSERT(c && IS_SET_OF(c, set));
    if (from >= c->track_count || to >= c->track_count || from == to)
        return noh_fail(error, NOH_ERR_ARG, "from and to must be two different tracks below track_count", from,
                        c->track_count);
    if (!(weight >= 0.0f && weight <= NOH_WEIGHT_MAX))
        return noh_fail(error, NOH_ERR_ARG, "weight must be 0 to NOH_WEIGHT_MAX", to, 0);
    if ((unsigned)curve > NOH_CURVE_SMOOTHSTEP) return noh_fail(error, NOH_ERR_ARG, "curve is not a noh_curve", to, 0);
    if (free_changes(c) < 3)
        return noh_fail(error, NOH_ERR_LIMIT, "the table of changes is full: raise change_count", c->change_count, 3);
    memset(&d, 0, sizeof d);
    d.kind = NOH_CHANGE_WEIGHT;
    d.duration_ticks = duration_ticks;
    d.curve = curve;
    d.track = to;
    d.weight = weight;
    (void)noh_controller_change(c, set, &d, NULL);
    d.track = from;
    d.weight = 0.0f;
    (void)noh_controller_change(c, set, &d, NULL);
    d.kind = NOH_CHANGE_MODE;
    d.delay_ticks = duration_ticks;
    d.duration_ticks = 0;
    d.mode = NOH_TRACK_OFF;
    return noh_controller_change(c, set, &d, error);
}

/* ---- time ---- */

/* A track's passage up to the present tick, stored separately because the callback may change the track. */
typedef struct passed {
    noh_passage passage;
    float weight;
    uint16_t clip;
    uint8_t track;
} passed;

typedef struct delivery {
    const noh_clip_set *set;
    const passed *from;
    noh_event_fn fn;
    void *user;
    int64_t clock;
    uint32_t count, passed; /* passed: including those not delivered */
} delivery;

static void deliver_key(void *user, uint32_t index, int64_t position_tick)
{
    delivery *d = (delivery *)user;
    const noh_clip_entry *m = &d->set->clips[d->from->clip];
    noh_event e;
    e.key = &d->set->events[m->first_event + index];
    if (d->from->weight < e.key->weight_min) {
        return;
    }
    e.clock = d->clock;
    e.position_tick = position_tick;
    e.track = d->from->track;
    e.clip = d->from->clip;
    e.index = index;
    e.weight = d->from->weight;
    e.backward = d->from->passage.backward;
    d->count++;
    if (d->fn) {
        d->fn(d->user, &e);
    }
}

/* Advance one track by `ticks`. */
static void move_track(noh_track *t, const noh_clip_entry *m, const noh_passage *p)
{
    int64_t rebase = noh_time_rebase(p->to, m->duration_ticks, (noh_loop)t->loop);
    t->position = p->to - rebase;
    t->root_position = noh_clock_add(t->root_position, -rebase);
    t->placed = (uint8_t)(t->placed && t->speed_now == 0);
}

/* Advance all tracks; returns the number that may have passed keys. */
static uint32_t move_tracks(noh_controller *c, const noh_clip_set *set, int64_t ticks, passed *out)
{
    noh_track *tracks = noh_controller_tracks(c);
    uint32_t count = 0;
    for (uint32_t i = 0; i < c->track_count; i++) {
        noh_track *t = &tracks[i];
        const noh_clip_entry *m = &set->clips[t->clip];
        if (t->mode == NOH_TRACK_OFF) {
            continue;
        }
        out[count].passage = noh_track_passage(t, m, ticks);
        out[count].clip = t->clip;
        out[count].track = (uint8_t)i;
        move_track(t, m, &out[count].passage);
        count += m->event_count != 0 && t->speed_now != 0;
    }
    return count;
}

/* Advance time to a tick and deliver the keys passed by then. All tracks move, changes take effect, and the weights are
 * stored before the first key is delivered: the callback may change anything, and later keys of the tick still see the
 * state before. */
static void advance(noh_controller *c, const noh_clip_set *set, int64_t clock, delivery *d)
{
    passed list[NOH_TRACKS_MAX];
    noh_change_target target;
    uint32_t count = move_tracks(c, set, clock - c->clock, list);
    c->clock = clock;
    target = target_of(c, set);
    noh_changes_update(changes_of(c), c->change_count, &target);
    settle(c, &target);
    for (uint32_t i = 0; i < count; i++) {
        list[i].weight = noh_controller_track(c, list[i].track)->weight;
    }
    d->clock = clock;
    for (uint32_t i = 0; i < count; i++) {
        const noh_clip_entry *m = &set->clips[list[i].clip];
        d->from = &list[i];
        d->passed += noh_events_pass(set->events + m->first_event, m->event_count, &list[i].passage,
                                     NOH_STEP_EVENTS_MAX - d->passed, deliver_key, d);
    }
}

static int has_sync(const noh_controller *c)
{
    int any = 0;
    for (uint32_t i = 0; i < c->track_count; i++) {
        const noh_track *t = noh_controller_track(c, i);
        any |= t->sync_group && t->mode != NOH_TRACK_OFF;
    }
    return any;
}

/* Update the speeds of sync groups at every multiple of NOH_SYNC_TICKS, and after changes. Returns the tick up to which
 * the speeds hold. */
static int64_t sync_speeds(noh_controller *c, const noh_clip_set *set, int64_t end)
{
    int64_t next = noh_clock_add(c->clock, NOH_SYNC_TICKS - c->clock % NOH_SYNC_TICKS);
    if (!has_sync(c)) {
        return end;
    }
    if (c->clock % NOH_SYNC_TICKS == 0 || (c->flags & SYNC_TOUCHED)) {
        noh_sync_speeds(set, noh_controller_tracks(c), c->track_count, next - c->clock);
        c->flags = (uint8_t)(c->flags & ~SYNC_TOUCHED);
    }
    return next < end ? next : end;
}

/* The first tick, up to `end`, by which a key is passed; else `end`. */
static int64_t next_event(const noh_controller *c, const noh_clip_set *set, int64_t end)
{
    for (uint32_t i = 0; i < c->track_count; i++) {
        int64_t ticks = noh_track_next_event(noh_controller_track(c, i), set, end - c->clock);
        if (ticks && c->clock + ticks < end) {
            end = c->clock + ticks;
        }
    }
    return end;
}

/* A step advances from one tick with an event to the next: a change begins, ends or enters a new slice, a sync group
 * gets new speeds, a key is passed. Between them every track has constant speed, so its position is one exact integer
 * multiplication. These ticks depend only on the clock, never on where a step ends, so events and state are the same
 * however time is split into steps. */
uint32_t noh_controller_step(noh_controller *c, const noh_clip_set *set, uint32_t ticks, noh_event_fn fn, void *user)
{
    NOH_ASSERT(c && IS_SET_OF(c, set));
    int64_t end = noh_clock_add(c->clock, ticks);
    delivery d = { NULL, NULL, NULL, NULL, 0, 0, 0 };
    NOH_VALIDATE((c->flags & STEPPING) || noh_controller_check(c, c->bytes, set, NULL) == NOH_OK);
    if (c->flags & STEPPING) {
        return 0; /* called by its own callback */
    }
    c->flags = (uint8_t)((c->flags & ~NOH_CONTROLLER_EVENTS_CUT) | STEPPING);
    d.set = set;
    d.fn = fn;
    d.user = user;
    while (c->clock < end) {
        noh_change_target target = target_of(c, set);
        int64_t until = noh_changes_speeds(changes_of(c), c->change_count, &target, c->track_count, end);
        until = sync_speeds(c, set, until);
        until = d.passed < NOH_STEP_EVENTS_MAX ? next_event(c, set, until) : until;
        advance(c, set, until, &d);
    }
    c->flags = (uint8_t)((c->flags & ~STEPPING) | (d.passed == NOH_STEP_EVENTS_MAX ? NOH_CONTROLLER_EVENTS_CUT : 0u));
    c->events_high_water = d.count > c->events_high_water ? d.count : c->events_high_water;
    return d.count;
}
