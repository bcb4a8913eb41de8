/* stage_match.c: motion matching, a module of the stage: where an actor is to go, and the moment of a clip that goes
 * there (motion/match/match.c).
 *
 * A goal is approached by critically damped springs, one for the velocity on the ground and one for the heading. What
 * these will do within a second is compared with what the actor does within a second after each row of the table. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"
#include "core/base/name_internal.h"
#include "core/base/trig_internal.h"
#include "motion/anim/root_internal.h"
#include "motion/bank/clip_bank_internal.h"
#include "motion/match/match_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "stage/cast/stage_internal.h"

#define SEARCH_TICKS 4800u
#define BLEND_TICKS 14400u
#define NEAR_TICKS 8000u /* a row so near to what plays is no other moment */
#define RESPONSE_S 0.27f
#define STEER 0.5f
#define STEER_S 0.2f /* half of what is left of a turn */
#define SPEED_MAX 1e6f
#define PI 3.14159265f
#define POSE_FEATURES 15u /* of the present pose; the features of the path follow */

typedef struct match_state {
    float wanted[2], wanted_heading; /* of the goal: x, z; radians about y, 0: +z, -pi..pi */
    float velocity[2], change[2];    /* of the spring, and its rate */
    float heading, turn;             /* the same */
    uint32_t since;                  /* ticks since the last search */
    uint32_t tags;
    uint32_t has_goal;
} match_state;

NOH_STATIC_ASSERT(sizeof(match_state) == 48, stage_match_state);

/* What a kind's actors share. */
typedef struct match_kind {
    noh_match_table table;
    const noh_pack *pack; /* that has it */
    noh_kind_match desc;  /* defaults filled in */
    uint32_t *clips;      /* [table's clip_count] in the kind's set */
    uint16_t *table_clip; /* [the set's clip_count] 1 + in the table; 0: not there */
    uint16_t *places;     /* [row_count] of each number, in the table's order */
} match_kind;

static match_state *state_of(const noh_stage_kind *k, uint32_t index)
{
    const noh_stage_module *m = &k->modules[NOH_SLOT_MATCH];
    return (match_state *)(void *)(m->states + index * m->stride);
}

/* ---- the desc ---- */

/* The table of the last pack that has one, as clips of a later pack replace clips of an earlier one. */
static const noh_pack *find_table(const noh_kind_desc *d, noh_match_table *table)
{
    const uint32_t count = d->clip_packs ? d->clip_pack_count : 1u;
    for (uint32_t i = count; i-- > 0;) {
        const noh_pack *pack = d->clip_packs ? d->clip_packs[i] : d->clips;
        if (pack && noh_match_table_of(pack, table)) return pack;
    }
    return NULL;
}

static noh_kind_match filled(const void *desc)
{
    noh_kind_match m;
    memset(&m, 0, sizeof m);
    if (desc) m = *(const noh_kind_match *)desc;
    if (!m.search_ticks) m.search_ticks = SEARCH_TICKS;
    if (!m.blend_ticks) m.blend_ticks = BLEND_TICKS;
    if (m.response_s == 0.0f) m.response_s = RESPONSE_S;
    if (m.bias == 0.0f) m.bias = 1.0f;
    if (m.steer == 0.0f) m.steer = STEER;
    return m;
}

static const char *bad(const noh_kind_desc *d, const void *desc)
{
    const noh_kind_match m = filled(desc);
    noh_match_table table;
    if (!find_table(d, &table)) return "match of a kind: none of its packs has a table: use noh build --match";
    if (!d->inertia) return "match of a kind needs room for inertia: set noh_kind_desc.inertia";
    if (noh_stage_root_axes(d) != table.header->root_axes || table.header->root_up != NOH_STAGE_UP)
        return "match of a kind: its table is for other root motion: set root_axes to NOH_ROOT_GROUND";
    if (m.layer >= d->layer_count) return "match of a kind: layer is not below layer_count";
    if (!(m.response_s >= 0.02f && m.response_s <= 10.0f)) return "match of a kind: response_s must be 0.02 to 10";
    if (!(m.bias >= 0.01f && m.bias <= 1000.0f)) return "match of a kind: bias must be 0.01 to 1000";
    return m.steer <= 1.0f ? NULL : "match of a kind: steer must be at most 1";
}

static uint32_t hash(const noh_kind_desc *d, const void *desc)
{
    noh_match_table table;
    (void)desc;
    return find_table(d, &table) ? table.header->row_count : 0;
}

/* ---- bytes ---- */

static match_kind *carve(noh_arena *arena, const noh_pack_match_header *h, uint32_t clip_count)
{
    match_kind unused, *shared = noh_arena_carve(arena, sizeof *shared, 16), *m = shared ? shared : &unused;
    m->clips = noh_arena_carve(arena, h->clip_count * sizeof *m->clips, 16);
    m->table_clip = noh_arena_carve(arena, clip_count * sizeof *m->table_clip, 16);
    m->places = noh_arena_carve(arena, h->row_count * sizeof *m->places, 16);
    return shared;
}

static noh_result measure(const noh_kind_desc *d, const void *desc, const noh_stage_needs *n, noh_module_needs *needs,
                          noh_error *error)
{
    noh_arena arena = noh_arena_measure();
    noh_match_table table;
    (void)desc, (void)error;
    if (!find_table(d, &table)) return NOH_OK;
    (void)carve(&arena, table.header, n->shape.clip_count);
    needs->kind_bytes = (arena.used + 15u) & ~(size_t)15u;
    needs->actor_bytes = sizeof(match_state);
    return NOH_OK;
}

/* A clip of a pack, and the skeleton that it was built with: joint_count 0 without one. */
static noh_pack_clip clip_of(const noh_pack *pack, uint32_t index, noh_skeleton *skeleton)
{
    noh_pack_clip c;
    memset(skeleton, 0, sizeof *skeleton);
    (void)noh_pack_clip_at(pack, index, &c, NULL);
    (void)noh_pack_skeleton_at(pack, c.header->skeleton, skeleton, NULL, NULL);
    return c;
}

/* Whether two clips move joints alike: the same compressed clip over the same bind pose, with the same ends for root
 * motion. Keys do not matter, and hold offsets into the strings of their pack. */
static int is_like(const noh_pack *pack, uint32_t index, const noh_pack *other, uint32_t other_index)
{
    noh_skeleton s, t;
    const noh_pack_clip a = clip_of(pack, index, &s), b = clip_of(other, other_index, &t);
    return a.header->skeleton_hash == b.header->skeleton_hash && a.header->clip_bytes == b.header->clip_bytes &&
           memcmp(a.header->root_ends, b.header->root_ends, sizeof a.header->root_ends) == 0 &&
           memcmp(a.bytes, b.bytes, a.header->clip_bytes) == 0 &&
           (s.joint_count ? noh_bank_same_skeletons(&s, &t) : !t.joint_count);
}

/* Whether the table's own pack has clips of this name, and a clip of another pack plays that is like none of them. */
static int is_replaced(const noh_stage_kind *k, const noh_pack *own, uint32_t name_hash, uint32_t clip)
{
    const noh_pack *pack = noh_stage_clip_pack(k, clip);
    const noh_chunk_run run = own->runs[NOH_CHUNK_CLIP];
    int is_there = 0;
    if (pack == own) return 0;
    for (uint32_t i = 0; i < run.count; i++) {
        if (own->chunks[run.first + i].name_hash != name_hash) continue;
        if (is_like(own, i, pack, k->bank->pack_clips[clip])) return 0;
        is_there = 1;
    }
    return is_there;
}

static noh_result bind_clips(const noh_stage_kind *k, match_kind *m, noh_error *error)
{
    const noh_pack_match_header *h = m->table.header;
    memset(m->table_clip, 0, k->set.clip_count * sizeof *m->table_clip);
    for (uint32_t i = 0; i < h->clip_count; i++) {
        const noh_pack_match_clip *c = &m->table.clips[i];
        const uint32_t clip = noh_clip_bank_find(k->bank, noh_pack_string(m->pack, c->name));
        if (clip == NOH_NONE) {
            return noh_fail(error, NOH_ERR_NOT_FOUND,
                            "match of a kind: its packs lack a clip of the table: add the pack that has it", i, 0);
        }
        if (is_replaced(k, m->pack, c->name_hash, clip)) {
            return noh_fail(error, NOH_ERR_DATA,
                            "match of a kind: a later pack replaces a clip of the table: build a table with that clip "
                            "into the later pack",
                            i, 0);
        }
        if ((uint64_t)(c->row_count - 1u) * h->row_ticks > k->set.clips[clip].duration_ticks) {
            return noh_fail(error, NOH_ERR_DATA,
                            "match of a kind: a clip is shorter than its rows: build the table with these clips", i, 0);
        }
        m->clips[i] = clip;
        m->table_clip[clip] = (uint16_t)(i + 1u);
    }
    return NOH_OK;
}

static noh_result init(noh_stage_kind *k, const void *desc, noh_error *error)
{
    noh_arena arena = noh_arena_over(k->modules[NOH_SLOT_MATCH].shared, SIZE_MAX);
    noh_match_table table;
    const noh_pack *pack = find_table(k->desc, &table);
    match_kind *m;
    if (!pack || !k->bank) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        "match of a kind: its packs have no clips for it: set clips or clip_packs", 0, 0);
    }
    m = carve(&arena, table.header, k->bank->clips.clip_count);
    m->table = table;
    m->pack = pack;
    m->desc = filled(desc);
    memset(m->places, 0, table.header->row_count * sizeof *m->places);
    for (uint32_t i = 0; i < table.header->row_count; i++) m->places[table.order[i]] = (uint16_t)i;
    return bind_clips(k, m, error);
}

/* ---- springs ---- */

/* Bring a value that changes at a rate nearer to its goal, after a time. */
typedef struct spring {
    float rate, left; /* of the decay: per second; what is left of it after the time */
    float seconds;
} spring;

static spring spring_for(float half_life_s, float seconds)
{
    /* A critically damped spring is half way after this many of its time constants: (1 + x) / e^x = 1 / 2. */
    const float rate = 1.67834699f / half_life_s;
    const spring s = { rate, noh_exp2(-1.44269504f * rate * seconds), seconds };
    return s;
}

static void move(const spring *s, float goal, float *value, float *rate)
{
    const float off = *value - goal, along = *rate + off * s->rate;
    *value = goal + s->left * (off + along * s->seconds);
    *rate = s->left * (*rate - along * s->rate * s->seconds);
}

/* How far a point comes whose velocity moves like this. */
static float way(const spring *s, float goal, float value, float rate)
{
    const float off = value - goal, along = rate + off * s->rate, by_rate = 1.0f / s->rate;
    return goal * s->seconds + by_rate * (off + along * by_rate - s->left * (off + along * (by_rate + s->seconds)));
}

static float wrapped(float radians)
{
    return noh_radians_from_turn(noh_turn_from_radians(radians));
}

static float heading_of(const float rotation[4])
{
    float twist[4];
    noh_quat_twist(rotation, 1u, twist);
    return wrapped(2.0f * noh_atan2(twist[1], twist[3]));
}

/* ---- which moment ---- */

/* The row that plays, by its number; NOH_NONE: what plays is not in the table. track: NULL: nothing plays on the layer.
 * *ends: 1 past the clip's last row. */
static uint32_t playing_row(const noh_stage_kind *k, const match_kind *m, const noh_track *track, int *ends)
{
    const noh_pack_match_clip *c;
    uint32_t n;
    *ends = 0;
    if (!track || track->clip >= k->bank->clips.clip_count || !m->table_clip[track->clip]) return NOH_NONE;
    c = &m->table.clips[m->table_clip[track->clip] - 1u];
    n = (noh_track_clip_tick(track, &k->set.clips[track->clip], 0) + m->table.header->row_ticks / 2u) /
        m->table.header->row_ticks;
    if (n < c->row_count) return c->first_row + n;
    if (track->loop == NOH_LOOP_REPEAT) return c->first_row;
    *ends = 1;
    return c->first_row + c->row_count - 1u;
}

/* Features 0 to 11 are the feet's positions and velocities; standing still on the ground is a velocity of 0. */
static uint32_t stands(const noh_stage *s, const noh_stage_kind *k, uint32_t index, float slow)
{
    const match_kind *m = k->modules[NOH_SLOT_MATCH].shared;
    const noh_match_table *t = &m->table;
    const noh_track *track = noh_actor_track(s, noh_stage_actor_at(s, k->first_actor + index), m->desc.layer);
    const uint32_t second_is_first = t->means[0] < t->means[3];
    int16_t row[NOH_MATCH_FEATURES];
    uint32_t bits = 0;
    int ends;
    const uint32_t playing = state_of(k, index)->has_goal ? playing_row(k, m, track, &ends) : NOH_NONE;
    if (playing == NOH_NONE) return 0;
    noh_match_row(t, m->places[playing], row);
    for (uint32_t foot = 0; foot < 2; foot++) {
        float square = 0.0f;
        for (uint32_t f = 6u + 3u * foot; f < 9u + 3u * foot; f++) {
            const float v = t->scales[f] > 0.0f ? t->means[f] + (float)row[f] / t->scales[f] : t->means[f];
            square += v * v;
        }
        if (square < slow * slow) bits |= 1u << (foot ^ second_is_first);
    }
    return bits;
}

/* An actor in a step. */
typedef struct matcher {
    noh_stage_player player;
    const match_kind *m;
    match_state *state;
    const noh_track *track; /* NULL: nothing plays on the layer */
    float heading;          /* of the actor */
} matcher;

static void make_query(const matcher *w, uint32_t row, int16_t query[NOH_MATCH_FEATURES])
{
    const match_state *g = w->state;
    const float scale = w->player.a->place.scale;
    float sine, cosine;
    memset(query, 0, NOH_MATCH_FEATURES * sizeof *query);
    if (row != NOH_NONE) noh_match_row(&w->m->table, w->m->places[row], query);
    noh_sin_cos(w->heading, &sine, &cosine);
    for (uint32_t i = 0; i < 3; i++) {
        const spring s = spring_for(w->m->desc.response_s, (float)(i + 1u) / 3.0f);
        const float x = way(&s, g->wanted[0], g->velocity[0], g->change[0]) / scale;
        const float z = way(&s, g->wanted[1], g->velocity[1], g->change[1]) / scale;
        float heading = g->heading, turn = g->turn, ahead[2];
        move(&s, g->heading + wrapped(g->wanted_heading - g->heading), &heading, &turn);
        noh_sin_cos(wrapped(heading - w->heading), &ahead[0], &ahead[1]);
        const float features[4] = { cosine * x - sine * z, sine * x + cosine * z, ahead[0], ahead[1] };
        for (uint32_t n = 0; n < 4; n++) {
            const uint32_t k = POSE_FEATURES + (n < 2u ? 0u : 6u) + 2u * i + n % 2u;
            query[k] = noh_match_number(&w->m->table, k, features[n]);
        }
    }
}

/* Whether a row is the moment that plays, or next to it. */
static int is_near(const matcher *w, uint32_t row, uint32_t playing)
{
    const uint32_t apart = row > playing ? row - playing : playing - row;
    return noh_match_clip_of(&w->m->table, row) == noh_match_clip_of(&w->m->table, playing) &&
           apart * w->m->table.header->row_ticks <= NEAR_TICKS;
}

static void choose(matcher *w)
{
    const noh_match_table *t = &w->m->table;
    int16_t query[NOH_MATCH_FEATURES], now[NOH_MATCH_FEATURES];
    noh_match_hit hit = { INT32_MAX, NOH_NONE, 0 };
    noh_play play;
    int ends;
    uint32_t clip;
    const uint32_t playing = playing_row(w->player.k, w->m, w->track, &ends);
    make_query(w, playing, query);
    if (playing != NOH_NONE && !ends &&
        (t->clips[noh_match_clip_of(t, playing)].tags & w->state->tags) == w->state->tags) {
        noh_match_row(t, w->m->places[playing], now);
        hit.cost = noh_match_cost(query, now) - (int32_t)(w->m->desc.bias * NOH_MATCH_UNIT * NOH_MATCH_UNIT);
        if (hit.cost < 0) return;
    }
    noh_match_search(t, query, w->state->tags, &hit);
    if (hit.row == NOH_NONE || (playing != NOH_NONE && !ends && is_near(w, hit.row, playing))) return;
    clip = noh_match_clip_of(t, hit.row);
    memset(&play, 0, sizeof play);
    play.flags = NOH_PLAY_INERTIA;
    play.fade_ticks = w->m->desc.blend_ticks;
    play.start_ticks = (hit.row - t->clips[clip].first_row) * t->header->row_ticks;
    /* always room: a leap ends what else plays on the layer */
    (void)noh_stage_play_clip(&w->player, w->m->clips[clip], &play, NULL);
}

/* ---- a step ---- */

/* Let the turn that clips have made in this step be faster or slower. */
static void turn_actor(matcher *w, float seconds)
{
    noh_stage_actor *a = w->player.a;
    const float left = wrapped(w->state->heading - w->heading);
    const float made = noh_radians_from_turn(a->moved.turn), most = w->m->desc.steer * (made < 0.0f ? -made : made);
    float by = left * (1.0f - noh_exp2(-seconds / STEER_S));
    noh_root_pose turn;
    double position[3], rotation[4];
    by = by > most ? most : by < -most ? -most : by;
    if (!(by > 0.0f || by < 0.0f)) return;
    memset(&turn, 0, sizeof turn);
    turn.turn = noh_turn_from_radians(by);
    for (int i = 0; i < 3; i++) position[i] = 0.0;
    for (int i = 0; i < 4; i++) rotation[i] = (double)a->place.rotation[i] + (double)a->rotation_rest[i];
    noh_root_drive(NOH_STAGE_UP, &turn, 1.0, position, rotation);
    for (int i = 0; i < 4; i++) noh_split(rotation[i], &a->place.rotation[i], &a->rotation_rest[i]);
    w->heading = heading_of(a->place.rotation);
}

static void steer(noh_stage *s, noh_stage_kind *k, uint32_t index, uint32_t ticks)
{
    const match_kind *m = k->modules[NOH_SLOT_MATCH].shared;
    match_state *g = state_of(k, index);
    noh_stage_actor *a = &k->actors[index];
    const float seconds = (float)ticks / (float)NOH_TICKS_PER_SECOND;
    const spring response = spring_for(m->desc.response_s, seconds);
    matcher w;
    if (!g->has_goal || a->parent || noh_stage_is_carried(k, index)) return;
    memset(&w, 0, sizeof w);
    w.player.s = s;
    w.player.k = k;
    w.player.a = a;
    w.player.layer = &k->layers[m->desc.layer];
    w.player.layer_index = m->desc.layer;
    w.player.c = noh_character_controller(noh_stage_character(k, index));
    w.m = m;
    w.state = g;
    w.track = noh_actor_track(s, noh_stage_actor_at(s, k->first_actor + index), m->desc.layer);
    w.heading = heading_of(a->place.rotation);
    for (int i = 0; i < 2; i++) move(&response, g->wanted[i], &g->velocity[i], &g->change[i]);
    move(&response, g->heading + wrapped(g->wanted_heading - g->heading), &g->heading, &g->turn);
    g->heading = wrapped(g->heading);
    if (m->desc.steer > 0.0f && !(k->desc->root_axes & NOH_ROOT_BY_GAME)) turn_actor(&w, seconds);
    g->since = ticks < UINT32_MAX - g->since ? g->since + ticks : UINT32_MAX;
    if (g->since < m->desc.search_ticks) return;
    g->since = 0;
    choose(&w);
}

/* ---- goals ---- */

static noh_result find_tags(const match_kind *m, const char *tags, uint32_t *out, noh_error *error)
{
    const char *at = tags;
    noh_stage_word word;
    *out = 0;
    while (tags && noh_stage_next_word(&at, &word)) {
        uint32_t i = 0;
        while (i < m->table.header->tag_count &&
               !noh_stage_word_matches(&word, noh_pack_string(m->pack, m->table.tags[i].name)))
            i++;
        if (i == m->table.header->tag_count) {
            return noh_fail(error, NOH_ERR_NOT_FOUND, "the table of the kind has no such tag: noh info lists them",
                            (uint64_t)(word.text - tags), i);
        }
        *out |= 1u << i;
    }
    return NOH_OK;
}

static int is_speed(const float v[3])
{
    return v[0] >= -SPEED_MAX && v[0] <= SPEED_MAX && v[2] >= -SPEED_MAX && v[2] <= SPEED_MAX;
}

static int is_below(float v, float limit)
{
    return v > -limit && v < limit;
}

/* The direction of a vector on the ground, if it has one. */
static void take_heading(const float v[3], float *heading)
{
    if (!is_below(v[0], 1e-6f) || !is_below(v[2], 1e-6f)) *heading = noh_atan2(v[0], v[2]);
}

noh_result noh_actor_match(noh_stage *stage, noh_actor actor, const noh_match_goal *goal, noh_error *error)
{
    noh_stage_actor *a;
    noh_stage_kind *k;
    const match_kind *m;
    match_state *g;
    uint32_t tags = 0;
    noh_result result = noh_stage_change(stage, actor, &a, &k, error);
    if (result != NOH_OK) return result;
    if (!k->modules[NOH_SLOT_MATCH].type) {
        return noh_fail(error, NOH_ERR_ARG, "the kind has no motion matching: set noh_kind_desc.match",
                        (uint64_t)(k - stage->kinds), 0);
    }
    m = k->modules[NOH_SLOT_MATCH].shared;
    g = state_of(k, noh_stage_index(k, a));
    if (!goal) {
        memset(g, 0, sizeof *g);
        return NOH_OK;
    }
    if (!is_speed(goal->velocity) || !is_speed(goal->facing)) {
        return noh_fail(error, NOH_ERR_ARG, "velocity or facing of a goal is not a number, or out of its range",
                        actor.id & 0xffffu, 0);
    }
    result = find_tags(m, goal->tags, &tags, error);
    if (result != NOH_OK) return result;
    if (!g->has_goal) {
        g->has_goal = 1;
        g->since = m->desc.search_ticks;
        g->heading = g->wanted_heading = heading_of(a->place.rotation);
    }
    g->tags = tags;
    g->wanted[0] = goal->velocity[0];
    g->wanted[1] = goal->velocity[2];
    take_heading(goal->velocity, &g->wanted_heading);
    take_heading(goal->facing, &g->wanted_heading);
    return NOH_OK;
}

/* ---- the module ---- */

static noh_result check(const noh_stage_kind *k, const void *state, noh_error *error)
{
    const match_state *g = state;
    int is_bad = g->has_goal > 1u || !is_below(g->wanted_heading, 4.0f) || !is_below(g->heading, 4.0f) ||
                 !is_below(g->turn, 1e5f);
    (void)k;
    for (int i = 0; i < 2; i++) {
        is_bad |= !is_below(g->wanted[i], 2.0f * SPEED_MAX) || !is_below(g->velocity[i], 10.0f * SPEED_MAX) ||
                  !is_below(g->change[i], 1e10f);
    }
    return is_bad ? noh_fail(error, NOH_ERR_DATA, "state: motion matching of an actor is out of its range", 0, 0)
                  : NOH_OK;
}

noh_module noh_match_module(const noh_kind_match *match)
{
    static const noh_module_type matching = {
        .slot = NOH_SLOT_MATCH,
        .kind_name = "motion matching",
        .hash = hash,
        .bad = bad,
        .measure = measure,
        .init = init,
        .check = check,
        .steer = steer,
        .stands = stands,
    };
    return (noh_module){ &matching, match };
}
