/* stage_share.c: between the phases, on one thread: slots are shared out, updates chosen, segments decoded, and the
 * seen actors put into the order in which they are drawn. */
#include <string.h>

#include "stage/cast/stage_internal.h"
#include "motion/clip/clip_cache_internal.h"
#include "stage/character/character_internal.h"
#include "stage/character/lod_pools_internal.h"
#include "stage/character/scheduler_internal.h"
#include "stage/character/time_lod_internal.h"
#include "stage/character/lod_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"
#include "noh/noh.h"
#include "noh/low_stage.h"

#define AHEAD_TICKS 12000u      /* looked ahead for clips: a quarter of a second */
#define AHEAD_TRACK_FRAMES 512u /* decoded in a frame for what is not needed yet */

static const noh_cost_weights costs = { 500.0f, 40.0f, 0.0f, 0.0f }; /* as `noh bench` measures them, roughly */

/* ---- slots ---- */

static void ask(noh_stage *s, noh_stage_kind *k)
{
    noh_lod_pools_begin(k->pools);
    for (uint32_t i = 0; i < k->desc->actor_count; i++) {
        const noh_stage_shown *shown = &s->shown[k->first_actor + i];
        const noh_stage_actor *a = &k->actors[i];
        if (shown->views) {
            const uint32_t level = noh_lod_finest(&noh_stage_character(k, i)->lod), first = k->table.mesh_level_first;
            noh_lod_pools_ask_at(k->pools, i, level > first ? level : first, shown->scale * noh_stage_size(s, a),
                                 shown->distance, s->cut || a->was_seen < 3u);
        }
    }
    noh_lod_pools_share_some(k->pools, s->cut ? UINT32_MAX : s->desc.slot_moves);
}

/* More are in view than may be drawn: as if it were out of view. */
static void leave_out(noh_stage *s, noh_stage_shown *shown, uint32_t index)
{
    shown->views = 0;
    s->actors[index].was_seen = 0;
    if (!s->actors[index].look.posed && !(shown->updates & NOH_STAGE_CARRIES)) shown->due = NOH_DUE_NOT;
}

/* A pool may be short of fine slots: the actor is then drawn no finer than its slot, and chooses no finer from now on.
 */
static void take_slot(noh_stage *s, noh_stage_kind *k, uint32_t i)
{
    noh_stage_shown *shown = &s->shown[k->first_actor + i];
    noh_lod *d = &noh_stage_character(k, i)->lod;
    shown->slot = noh_lod_pools_slot(k->pools, i);
    if (shown->slot.left_out) {
        leave_out(s, shown, k->first_actor + i);
        return;
    }
    shown->level = (uint8_t)(d->mesh > shown->slot.level ? d->mesh : shown->slot.level);
    shown->level_before = (uint8_t)(d->mesh_before > shown->slot.level ? d->mesh_before : shown->slot.level);
    noh_lod_set_limit(d, shown->slot.level);
}

/* What is worn by an actor that is left out, or attached to it, is left out with it. */
static void leave_out_attached(noh_stage *s)
{
    for (uint32_t i = 0; i < s->actor_count; i++) {
        const noh_stage_actor *on = &s->actors[i];
        while (s->shown[i].views && (on = noh_stage_parent_of(s, on, NULL)) != NULL) {
            if (s->shown[on - s->actors].slot.left_out) leave_out(s, &s->shown[i], i);
        }
    }
}

/* ---- order ---- */

uint32_t noh_stage_influence_levels(const noh_stage_kind *k)
{
    return k->table.influence_level_count ? k->table.influence_level_count : 1u;
}

uint32_t noh_stage_run_count(const noh_stage_kind *k)
{
    return k->plan->level_count * noh_stage_influence_levels(k);
}

uint32_t noh_stage_seen(const noh_stage_kind *k)
{
    return k->runs[noh_stage_run_count(k) + 1u];
}

static uint32_t run_of(const noh_stage *s, const noh_stage_kind *k, uint32_t i)
{
    const noh_stage_shown *shown = &s->shown[k->first_actor + i];
    return shown->level != shown->level_before
               ? noh_stage_run_count(k)
               : shown->level * noh_stage_influence_levels(k) + noh_stage_character(k, i)->lod.influences;
}

/* What keeps actors of a run from being drawn together, the most telling first. */
typedef struct look_key {
    uint32_t texture_set, garments, hidden_meshes, wrinkles;
} look_key;

#define LOOKS_MAX 80u /* above NOH_TEXTURE_SETS_MAX */

/* whole: with all fields; otherwise all but the textures are zero, the least look with these textures. */
static look_key key_of(const noh_stage *s, const noh_stage_kind *k, uint32_t i, int whole)
{
    const noh_appearance *look = &k->actors[i].look;
    look_key key = { look->texture_set, 0, 0, 0 };
    if (!whole) return key;
    if (k->desc->cover_count) key.garments = noh_stage_garments_on(s, k->first_actor + i);
    key.hidden_meshes = look->hidden_meshes;
    key.wrinkles = (uint32_t)look->wrinkle_models << 8 | look->smoothed;
    return key;
}

static int compare_looks(const look_key *a, const look_key *b)
{
    if (a->texture_set != b->texture_set) return a->texture_set < b->texture_set ? -1 : 1;
    if (a->garments != b->garments) return a->garments < b->garments ? -1 : 1;
    if (a->hidden_meshes != b->hidden_meshes) return a->hidden_meshes < b->hidden_meshes ? -1 : 1;
    return a->wrinkles < b->wrinkles ? -1 : a->wrinkles > b->wrinkles;
}

/* The place of a look among sorted ones, or where it would be. */
static uint32_t find_look(const look_key *looks, uint32_t count, const look_key *key)
{
    uint32_t first = 0;
    while (count) {
        const uint32_t half = count / 2u;
        if (compare_looks(&looks[first + half], key) < 0) {
            first += half + 1u;
            count -= half + 1u;
        } else {
            count = half;
        }
    }
    return first;
}

static int is_at(const look_key *looks, uint32_t count, uint32_t at, const look_key *key)
{
    return at < count && !compare_looks(&looks[at], key);
}

/* Sort the looks of seen actors into what is there. Returns 0: more than fit; the first are there. */
static int sort_looks(const noh_stage *s, const noh_stage_kind *k, int whole, look_key *looks, uint32_t *count)
{
    uint32_t last = 0;
    for (uint32_t i = 0; i < k->desc->actor_count; i++) {
        if (!s->shown[k->first_actor + i].views) continue;
        const look_key key = key_of(s, k, i, whole);
        if (is_at(looks, *count, last, &key)) continue;
        last = find_look(looks, *count, &key);
        if (is_at(looks, *count, last, &key)) continue;
        if (*count == LOOKS_MAX) return 0;
        looks[*count] = key;
        for (uint32_t at = (*count)++; at > last; at--) { /* exchanged, as in stage_levels.c */
            const look_key moved = looks[at];
            looks[at] = looks[at - 1u];
            looks[at - 1u] = moved;
        }
    }
    return 1;
}

/* Number the looks of seen actors. If there are too many, those that do not fit have the number of the one before them,
 * which has the same textures: only they are drawn one by one. */
NOH_NEVER_INLINE static void number_looks(noh_stage *s, const noh_stage_kind *k)
{
    look_key looks[LOOKS_MAX];
    uint32_t count = 0;
    if (!sort_looks(s, k, 1, looks, &count)) {
        count = 0;
        (void)sort_looks(s, k, 0, looks, &count);
        (void)sort_looks(s, k, 1, looks, &count);
    }
    for (uint32_t i = 0; i < k->desc->actor_count; i++) {
        noh_stage_shown *shown = &s->shown[k->first_actor + i];
        if (!shown->views) continue;
        const look_key key = key_of(s, k, i, 1);
        const uint32_t at = find_look(looks, count, &key);
        shown->look = (uint8_t)(is_at(looks, count, at, &key) ? at : at - 1u);
    }
}

/* The next place in its run for each seen actor, look by look. Until it has a place, an actor has 1 + the next actor of
 * its look there; 0: none. */
static void take_places(noh_stage *s, noh_stage_kind *k, uint32_t *next)
{
    uint16_t firsts[LOOKS_MAX] = { 0 };
    for (uint32_t i = k->desc->actor_count; i--;) {
        noh_stage_shown *shown = &s->shown[k->first_actor + i];
        const uint32_t look = NOH_PAGE ? k->actors[i].look.texture_set : shown->look;
        if (!shown->views) continue;
        shown->place = firsts[look];
        firsts[look] = (uint16_t)(i + 1u);
    }
    for (uint32_t look = 0; look < LOOKS_MAX; look++) {
        for (uint32_t after = firsts[look]; after;) {
            const uint32_t i = after - 1u;
            noh_stage_shown *shown = &s->shown[k->first_actor + i];
            after = shown->place;
            shown->place = (uint16_t)next[run_of(s, k, i)]++;
            k->order[shown->place] = i;
        }
    }
}

/* A counting sort by run, in a run by look; stable, so that neighbours in memory stay neighbours. */
static void put_in_order(noh_stage *s, noh_stage_kind *k)
{
    const uint32_t runs = noh_stage_run_count(k);
    uint32_t next[NOH_LOD_LEVELS_MAX * 4u + 1u] = { 0 }, count = 0;
    if (!NOH_PAGE) number_looks(s, k);
    for (uint32_t i = 0; i < k->desc->actor_count; i++) {
        if (s->shown[k->first_actor + i].views) next[run_of(s, k, i)]++;
    }
    for (uint32_t r = 0; r <= runs; r++) {
        k->runs[r] = count;
        count += next[r];
        next[r] = k->runs[r];
    }
    k->runs[runs + 1u] = count;
    take_places(s, k, next);
}

/* ---- updates ---- */

/* Joints times clips in the pose of the graph that an actor plays. */
static uint32_t inner_work(const noh_stage_kind *k, uint32_t index)
{
    const noh_controller *c = noh_stage_inner(k, index);
    uint32_t tracks = 0;
    for (uint32_t i = 0; c && i < c->track_count; i++) tracks += noh_controller_track(c, i)->mode == NOH_TRACK_ON;
    return c ? tracks * c->lod_joint_count : 0;
}

/* Without a budget all that are due are posed: nothing is put in order, and no cost is asked for. */
static void offer(noh_stage *s, noh_stage_kind *k, uint32_t i)
{
    noh_stage_shown *shown = &s->shown[k->first_actor + i];
    const noh_character *ch = noh_stage_character(k, i);
    uint32_t cost;
    shown->updates = 0;
    if (shown->due == NOH_DUE_NOT || s->desc.update_budget_ns == UINT64_MAX) {
        shown->updates = shown->due != NOH_DUE_NOT;
        return;
    }
    cost = noh_cost_ns(&costs, noh_character_joint_work(ch) + inner_work(k, i), 0, 0);
    if (shown->due >= NOH_DUE_AT_ONCE) {
        noh_schedule_spend(&s->schedule, cost);
        shown->updates = 1;
    } else {
        noh_schedule_offer(&s->schedule, k->first_actor + i, noh_character_late(ch), 0.01f * shown->scale, cost);
    }
}

static void choose_updates(noh_stage *s)
{
    uint32_t index;
    noh_schedule_begin(&s->schedule, s->head->step_ticks, s->desc.update_budget_ns);
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        const noh_stage_kind *k = &s->kinds[i];
        for (uint32_t a = 0; a < k->desc->actor_count; a++) {
            if (!noh_stage_wearer_of(s, &k->actors[a], NULL)) offer(s, &s->kinds[i], a);
        }
    }
    while (noh_schedule_next(&s->schedule, &index)) s->shown[index].updates = 1;
    noh_stage_update_worn(s);
    s->todo_count = 0;
    for (uint32_t i = 0; i < s->actor_count; i++) {
        const noh_stage_actor *at = &s->actors[i];
        if (noh_stage_wearer_of(s, at, NULL)) continue; /* it is posed with its wearer */
        if (s->shown[i].views || s->shown[i].updates || s->shown[i].worn || (at->alive && at->look.posed))
            s->todo[s->todo_count++] = i;
    }
}

/* ---- decoding ---- */

/* How far ahead an update poses: until the next one. */
static uint32_t ahead_of(const noh_stage *s, const noh_character *ch)
{
    return noh_update_period((noh_update_rate)ch->lod.update_rate) + s->head->step_ticks;
}

static void want_clips(noh_stage *s, const noh_stage_kind *k, uint32_t i, int now)
{
    noh_character *ch = noh_stage_character(k, i);
    const uint32_t ahead = now ? ahead_of(s, ch) : AHEAD_TICKS;
    const noh_controller *inner = noh_stage_inner(k, i);
    (void)noh_clip_bank_prefetch(k->bank, noh_character_controller(ch), ahead);
    if (inner) (void)noh_clip_bank_prefetch(k->bank, inner, ahead);
}

static void want_one(noh_stage *s, uint32_t index, int now)
{
    const noh_stage_kind *k = noh_stage_kind_of(s, index);
    if (k->bank && !s->kinds[k->bank_kind].holds_all && (s->shown[index].updates || !now)) {
        want_clips(s, k, index - k->first_actor, now);
    }
}

static void want(noh_stage *s, int now)
{
    for (uint32_t t = 0; t < s->todo_count; t++) {
        want_one(s, s->todo[t], now);
        for (uint32_t g = s->shown[s->todo[t]].worn; g; g = s->shown[g - 1u].next_worn) want_one(s, g - 1u, now);
    }
}

static uint64_t decoded_so_far(const noh_stage *s)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        if (s->kinds[i].bank && s->kinds[i].bank_kind == i) {
            sum += noh_clip_cache_stats_of(s->kinds[i].bank->cache).decoded;
        }
    }
    return sum;
}

/* Whether a bank still has something to decode. Once its cache holds all, it always will. */
static int any_missing(noh_stage *s)
{
    int missing = 0;
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        noh_stage_kind *k = &s->kinds[i];
        if (!k->bank || k->bank_kind != i) continue;
        noh_clip_cache_begin_frame(k->bank->cache);
        if (!k->holds_all) k->holds_all = noh_clip_cache_holds_all(k->bank->cache);
        missing |= !k->holds_all;
    }
    return missing;
}

/* First all that this frame needs, then a little of what the next ones will. */
static void decode(noh_stage *s)
{
    const uint64_t before = decoded_so_far(s);
    s->stats.decoded = 0;
    if (!any_missing(s)) {
        return;
    }
    for (int now = 1; now >= 0; now--) {
        want(s, now);
        for (uint32_t i = 0; i < s->desc.kind_count; i++) {
            if (s->kinds[i].bank && s->kinds[i].bank_kind == i) {
                (void)noh_clip_cache_work(s->kinds[i].bank->cache, now ? UINT32_MAX : AHEAD_TRACK_FRAMES);
            }
        }
    }
    s->stats.decoded = decoded_so_far(s) - before;
}

/* ---- all of it ---- */

static void add_slots(noh_stage_stats *stats, const noh_lod_pools_stats *from)
{
    stats->coarser += from->coarser;
    stats->moved += from->moved;
    stats->waiting += from->waiting;
    stats->resting += from->resting;
    stats->left_out += from->left_out;
}

static void count_levels(noh_stage *s)
{
    noh_stage_stats *stats = &s->stats;
    stats->actors = stats->seen = stats->fading = stats->coarser = 0;
    stats->moved = stats->waiting = stats->resting = stats->left_out = 0;
    memset(stats->at_level, 0, sizeof stats->at_level);
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        const noh_stage_kind *k = &s->kinds[i];
        const uint32_t runs = noh_stage_run_count(k);
        stats->actors += s->head->kinds[i].count;
        stats->seen += k->runs[runs + 1u];
        stats->fading += k->runs[runs + 1u] - k->runs[runs];
        if (k->pools) add_slots(stats, noh_lod_pools_stats_of(k->pools));
        for (uint32_t p = 0; p < k->runs[runs + 1u]; p++) {
            stats->at_level[s->shown[k->first_actor + k->order[p]].level]++;
        }
    }
    if (stats->actors > stats->actors_high) stats->actors_high = stats->actors;
    if (stats->coarser > stats->coarser_high) stats->coarser_high = stats->coarser;
}

void noh_stage_share(noh_stage *s)
{
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        noh_stage_kind *k = &s->kinds[i];
        if (!k->pools) continue; /* an empty slot */
        ask(s, k);
        for (uint32_t a = 0; a < k->desc->actor_count; a++) {
            s->shown[k->first_actor + a].slot.left_out = 0;
            if (s->shown[k->first_actor + a].views) take_slot(s, k, a);
        }
    }
    leave_out_attached(s);
    noh_stage_link_worn(s);
    for (uint32_t i = 0; i < s->desc.kind_count; i++) put_in_order(s, &s->kinds[i]);
    count_levels(s);
    choose_updates(s);
    decode(s);
}
