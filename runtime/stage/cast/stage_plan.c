/* stage_plan.c: every byte of a stage before there is one, and what is given up to keep a bound. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/compiler_internal.h"
#include "noh/base.h"
#include "noh/low_core.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "stage/cast/stage_internal.h"

/* ---- measuring ---- */

void noh_stage_desc_by_plan(noh_stage_desc *desc, const noh_stage_plan *plan)
{
    desc->halves = plan->halves ? 1 : desc->halves < 0 ? -1 : 0;
    desc->morph_sums |= plan->sums != 0;
    if (!desc->morph_path && noh_stage_has_slots(desc)) desc->morph_path = plan->morph_path;
}

typedef struct planner {
    const noh_stage_desc *desc; /* with its defaults filled in */
    const struct noh_gl_caps *caps;
    noh_stage_plan *plan;
} planner;

/* Read clips where another number of cached segments is asked for than they were read for, and tell those that share
 * them. */
static noh_result read_clips(const planner *p, noh_error *error)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < p->desc->kind_count && result == NOH_OK; i++) {
        noh_kind_plan *k = &p->plan->kinds[i];
        const uint32_t owner = noh_stage_bank_kind(p->desc, i);
        if (owner != i) {
            k->clips = p->plan->kinds[owner].clips;
        } else if (k->clips.asked != k->cached_segment_count) {
            result = noh_stage_measure_clips(p->desc, p->plan, i, &k->clips, error);
        }
    }
    return result;
}

static noh_result measure(const planner *p, noh_error *error)
{
    noh_stage_plan *plan = p->plan;
    noh_stage_blocks blocks;
    noh_arena arena = noh_arena_measure();
    uint64_t cpu_bytes = 0, gpu_bytes = 0;
    noh_stage_desc desc = *p->desc;
    noh_result result = read_clips(p, error);
    memset(&blocks, 0, sizeof blocks);
    noh_stage_desc_by_plan(&desc, plan);
    if (result == NOH_OK) result = noh_stage_carve(&arena, &desc, plan, &blocks, NULL, error);
    if (result == NOH_OK && desc.gpu) {
        result = desc.gpu->measure(&desc, p->caps, plan, &cpu_bytes, &gpu_bytes, error);
        if (result == NOH_OK && desc.morph_path != plan->morph_path && noh_stage_has_slots(&desc)) {
            noh_stage_desc_by_plan(&desc, plan); /* all meshes of such a stage take one path */
            result = desc.gpu->measure(&desc, p->caps, plan, &cpu_bytes, &gpu_bytes, error);
        }
        (void)noh_arena_carve(&arena, (size_t)cpu_bytes, 16);
    }
    plan->cpu_bytes = arena.used;
    plan->gpu_bytes = gpu_bytes;
    plan->state_bytes = blocks.state_bytes;
    return result;
}

uint32_t noh_stage_plan_parts(const noh_stage_desc *desc, const struct noh_gl_caps *caps, const noh_stage_plan *plan,
                              noh_stage_bytes *parts, uint32_t capacity)
{
    noh_stage_list list = { NULL, 0, 0, 0 };
    noh_stage_blocks blocks;
    noh_arena arena = noh_arena_measure();
    noh_stage_desc d = *desc;
    NOH_ASSERT(plan && (parts || !capacity));
    memset(&blocks, 0, sizeof blocks);
    list.parts = parts;
    list.capacity = capacity;
    noh_stage_desc_by_plan(&d, plan);
    if (noh_stage_carve(&arena, &d, plan, &blocks, &list, NULL) == NOH_OK && d.gpu) {
        d.gpu->parts(&d, caps, plan, &list);
    }
    noh_stage_add_part(&list, "alignment", NOH_NONE, plan->cpu_bytes - list.cpu_bytes, 0);
    return list.count;
}

static int fits(const noh_stage_desc *d, const noh_stage_plan *plan)
{
    return (!d->cpu_bytes_max || plan->cpu_bytes <= d->cpu_bytes_max) &&
           (!d->gpu_bytes_max || plan->gpu_bytes <= d->gpu_bytes_max) &&
           (!d->bytes_max || plan->cpu_bytes + plan->gpu_bytes <= d->bytes_max);
}

/* ---- giving up ---- */

/* Note what was given up; the same thing again only changes the row. */
static void concede(noh_stage_plan *plan, const char *what, uint32_t kind, uint32_t value, uint64_t cpu_before,
                    uint64_t gpu_before, float loss_pixels)
{
    noh_concession *row = NULL;
    for (uint32_t i = 0; i < plan->concession_count && !row; i++) {
        if (plan->concessions[i].what == what && plan->concessions[i].kind == kind) row = &plan->concessions[i];
    }
    if (!row) {
        row = &plan->concessions[plan->concession_count < NOH_CONCESSIONS_MAX ? plan->concession_count++
                                                                              : NOH_CONCESSIONS_MAX - 1u];
        memset(row, 0, sizeof *row);
    }
    row->what = what;
    row->kind = kind;
    row->value = value;
    row->loss_pixels = loss_pixels > row->loss_pixels ? loss_pixels : row->loss_pixels;
    row->cpu_bytes += cpu_before > plan->cpu_bytes ? cpu_before - plan->cpu_bytes : 0;
    row->gpu_bytes += gpu_before > plan->gpu_bytes ? gpu_before - plan->gpu_bytes : 0;
}

static const char *const sums_text = "finished vertices", *const halves_text = "half-float accumulators",
                         *const segments_text = "cached segments", *const slots_text = "slots",
                         *const finest_text = "finest level";

/* Measure again, and note what this change of one thing has won. */
static noh_result changed(const planner *p, const char *what, uint32_t kind, uint32_t value, float loss_pixels,
                          noh_error *error)
{
    const uint64_t cpu = p->plan->cpu_bytes, gpu = p->plan->gpu_bytes;
    const noh_result result = measure(p, error);
    if (result == NOH_OK) {
        concede(p->plan, what, kind, value, cpu, gpu, loss_pixels);
    }
    return result;
}

/* Sums in their place are smaller. Where there are no finished vertices, that changes nothing. */
static noh_result give_up_vertices(const planner *p, noh_error *error)
{
    const uint64_t cpu = p->plan->cpu_bytes, gpu = p->plan->gpu_bytes;
    noh_result result;
    if (!p->desc->gpu || p->desc->morph_sums || fits(p->desc, p->plan)) {
        return NOH_OK;
    }
    p->plan->sums = 1;
    result = measure(p, error);
    if (result == NOH_OK && p->plan->cpu_bytes + p->plan->gpu_bytes >= cpu + gpu) {
        p->plan->sums = 0;
        return measure(p, error);
    }
    if (result == NOH_OK) concede(p->plan, sums_text, NOH_NONE, 1, cpu, gpu, 0.0f);
    return result;
}

/* Where there are no sums, halves win nothing, and a chosen path may not have them. */
static noh_result give_up_halves(const planner *p, noh_error *error)
{
    const uint64_t cpu = p->plan->cpu_bytes, gpu = p->plan->gpu_bytes;
    if (!p->desc->gpu || p->desc->halves || p->plan->halves || noh_stage_has_slots(p->desc) || fits(p->desc, p->plan)) {
        return NOH_OK;
    }
    p->plan->halves = 1;
    if (measure(p, NULL) != NOH_OK || p->plan->cpu_bytes + p->plan->gpu_bytes >= cpu + gpu) {
        p->plan->halves = 0;
        return measure(p, error);
    }
    concede(p->plan, halves_text, NOH_NONE, 1, cpu, gpu, 0.0f);
    return NOH_OK;
}

/* Halve the segments of the bank that holds the most, again and again, while they are above a share of all. */
static noh_result give_up_segments(const planner *p, uint32_t share, noh_error *error)
{
    noh_result result = NOH_OK;
    while (result == NOH_OK && !fits(p->desc, p->plan)) {
        noh_kind_plan *most = NULL;
        uint32_t kind = 0;
        for (uint32_t i = 0; i < p->desc->kind_count; i++) {
            noh_kind_plan *k = &p->plan->kinds[i];
            const uint32_t least = share ? k->segment_count / share : NOH_CLIP_CACHE_SEGMENTS_MIN;
            if (noh_stage_bank_kind(p->desc, i) == i && !p->desc->kinds[i].changes && k->cached_segment_count > least &&
                k->cached_segment_count > NOH_CLIP_CACHE_SEGMENTS_MIN &&
                (!most || k->cached_segment_count > most->cached_segment_count)) {
                most = k;
                kind = i;
            }
        }
        if (!most) {
            return NOH_OK;
        }
        most->cached_segment_count -= (most->cached_segment_count + 7u) / 8u;
        if (most->cached_segment_count < NOH_CLIP_CACHE_SEGMENTS_MIN)
            most->cached_segment_count = NOH_CLIP_CACHE_SEGMENTS_MIN;
        result = changed(p, segments_text, kind, most->cached_segment_count, 0.0f, error);
    }
    return result;
}

/* The error in pixels of the next level, at the distance where the spread has the last actor that keeps a slot. */
static float slot_loss(const planner *p, const noh_kind_plan *k, uint32_t level)
{
    const float now = k->levels[level + 1u].error_m, was = k->levels[level].error_m;
    return was > 0.0f && now / was < 1e6f ? p->desc->lod.pixels * 0.3f * now / was : p->desc->lod.pixels;
}

static uint32_t promised(const noh_kind_desc *d, const noh_kind_plan *k, uint32_t level)
{
    return level == k->finest_level ? d->near_count : level == k->finest_level + 1u ? d->middle_count : 0;
}

/* One step: a third of the slots of the finest level that has more than it was promised move on to the next. Returns 0
 * when there is none left. */
static int drop_slots(const planner *p, uint32_t kind, uint32_t *level_out)
{
    const noh_kind_desc d = noh_stage_kind_desc(p->desc, kind);
    noh_kind_plan *k = &p->plan->kinds[kind];
    for (uint32_t l = k->finest_level; l + 1u < k->level_count && !d.changes; l++) {
        const uint32_t keep = promised(&d, k, l), have = k->levels[l].slot_count;
        uint32_t move = have > keep ? (have - keep + 2u) / 3u : 0;
        if (move == have && move && l == k->finest_level && !keep) move--; /* one stays: somebody is always near */
        if (move) {
            k->levels[l].slot_count -= move;
            k->levels[l + 1u].slot_count += move;
            *level_out = l;
            return 1;
        }
    }
    return 0;
}

static noh_result give_up_slots(const planner *p, noh_error *error)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < p->desc->kind_count && result == NOH_OK; i++) {
        noh_kind_plan *k = &p->plan->kinds[i];
        uint32_t level = 0;
        while (result == NOH_OK && !fits(p->desc, p->plan) && drop_slots(p, i, &level)) {
            result = changed(p, slots_text, i, k->levels[k->finest_level].slot_count, slot_loss(p, k, level), error);
        }
    }
    return result;
}

/* The slots of the finest level go to the next. */
static void drop_finest(noh_kind_plan *k)
{
    k->levels[k->finest_level + 1u].slot_count += k->levels[k->finest_level].slot_count;
    k->levels[k->finest_level].slot_count = 0;
    k->finest_level++;
}

/* Kinds of one pack share its meshes on the GPU: nothing is won until all of them have left a level out. */
static void drop_with_others(const planner *p, uint32_t kind)
{
    const uint32_t level = p->plan->kinds[kind].finest_level;
    for (uint32_t i = 0; i < p->desc->kind_count; i++) {
        noh_kind_plan *k = &p->plan->kinds[i];
        if (!p->desc->kinds[i].changes && p->desc->kinds[i].mesh->bytes == p->desc->kinds[kind].mesh->bytes &&
            k->finest_level <= level && k->finest_level + 1u < k->level_count) {
            drop_finest(k);
        }
    }
}

/* Leave out the finest level of the kind that loses the least. */
static noh_result give_up_finest(const planner *p, noh_error *error)
{
    noh_result result = NOH_OK;
    while (result == NOH_OK && !fits(p->desc, p->plan)) {
        noh_kind_plan *best = NULL;
        uint32_t kind = 0;
        for (uint32_t i = 0; i < p->desc->kind_count; i++) {
            noh_kind_plan *k = &p->plan->kinds[i];
            if (!p->desc->kinds[i].changes && k->finest_level + 1u < k->level_count &&
                (!best || k->levels[k->finest_level + 1u].error_m < best->levels[best->finest_level + 1u].error_m)) {
                best = k;
                kind = i;
            }
        }
        if (!best) {
            return NOH_OK;
        }
        drop_with_others(p, kind);
        result = changed(p, finest_text, kind, best->finest_level, 0.0f, error);
    }
    return result;
}

/* ---- giving back ---- */

/* Take a concession out of the list, or state what it is now. */
static void taken_back(noh_stage_plan *plan, const char *what, uint32_t kind, uint32_t value, int whole, uint64_t cpu,
                       uint64_t gpu)
{
    for (uint32_t i = 0; i < plan->concession_count; i++) {
        noh_concession *row = &plan->concessions[i];
        if (row->what != what || row->kind != kind) continue;
        row->value = value;
        row->cpu_bytes -= cpu < row->cpu_bytes ? cpu : row->cpu_bytes;
        row->gpu_bytes -= gpu < row->gpu_bytes ? gpu : row->gpu_bytes;
        if (whole) {
            plan->concession_count--;
            for (uint32_t k = i; k < plan->concession_count; k++) { /* exchanged: see drop in stage_levels.c */
                const noh_concession gone = plan->concessions[k];
                plan->concessions[k] = plan->concessions[k + 1u];
                plan->concessions[k + 1u] = gone;
            }
            memset(&plan->concessions[plan->concession_count], 0, sizeof *row);
        }
        return;
    }
}

/* Whether a number of cached segments fits; the plan then has it. */
static noh_result try_segments(const planner *p, uint32_t kind, uint32_t count, int *does, noh_error *error)
{
    noh_result result;
    p->plan->kinds[kind].cached_segment_count = count;
    result = measure(p, error);
    *does = result == NOH_OK && fits(p->desc, p->plan);
    return result;
}

/* As many cached segments as still fit, by halving the distance. */
static noh_result give_back_segments(const planner *p, uint32_t kind, uint32_t most, noh_error *error)
{
    noh_kind_plan *k = &p->plan->kinds[kind];
    const uint64_t cpu = p->plan->cpu_bytes, gpu = p->plan->gpu_bytes;
    uint32_t good = k->cached_segment_count, bad = most + 1u;
    noh_result result = NOH_OK;
    int does;
    while (result == NOH_OK && bad - good > 1u) {
        const uint32_t middle = bad == most + 1u ? most : good + (bad - good) / 2u;
        result = try_segments(p, kind, middle, &does, error);
        if (does) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    if (result == NOH_OK) result = try_segments(p, kind, good, &does, error);
    if (result == NOH_OK) {
        taken_back(p->plan, segments_text, kind, good, good == most, p->plan->cpu_bytes - cpu,
                   p->plan->gpu_bytes - gpu);
    }
    return result;
}

static noh_result give_back_halves(const planner *p, noh_error *error)
{
    const uint64_t cpu = p->plan->cpu_bytes, gpu = p->plan->gpu_bytes;
    noh_result result;
    if (!p->plan->halves || p->desc->halves) {
        return NOH_OK;
    }
    p->plan->halves = 0;
    result = measure(p, error);
    if (result == NOH_OK && !fits(p->desc, p->plan)) {
        p->plan->halves = 1;
        return measure(p, error);
    }
    if (result == NOH_OK) {
        taken_back(p->plan, halves_text, NOH_NONE, 0, 1, p->plan->cpu_bytes - cpu, p->plan->gpu_bytes - gpu);
    }
    return result;
}

static noh_result give_back_vertices(const planner *p, noh_error *error)
{
    const uint64_t cpu = p->plan->cpu_bytes, gpu = p->plan->gpu_bytes;
    noh_result result;
    if (!p->plan->sums || p->plan->halves) {
        return NOH_OK;
    }
    p->plan->sums = 0;
    result = measure(p, error);
    if (result == NOH_OK && !fits(p->desc, p->plan)) {
        p->plan->sums = 1;
        return measure(p, error);
    }
    if (result == NOH_OK) {
        taken_back(p->plan, sums_text, NOH_NONE, 0, 1, p->plan->cpu_bytes - cpu, p->plan->gpu_bytes - gpu);
    }
    return result;
}

/* What was given up first may fit again, once more was won than was needed. */
static noh_result give_back(const planner *p, noh_error *error)
{
    noh_result result = give_back_halves(p, error);
    for (uint32_t i = 0; i < p->desc->kind_count && result == NOH_OK; i++) {
        noh_kind_plan *k = &p->plan->kinds[i];
        const uint32_t now = k->cached_segment_count;
        noh_kind_clips most;
        if (noh_stage_bank_kind(p->desc, i) != i || p->desc->kinds[i].changes) continue;
        k->cached_segment_count = 0;
        result = noh_stage_measure_clips(p->desc, p->plan, i, &most, error);
        k->cached_segment_count = now;
        if (result == NOH_OK && most.cached_segment_count > now) {
            result = give_back_segments(p, i, most.cached_segment_count, error);
        }
    }
    if (result == NOH_OK) result = give_back_vertices(p, error);
    return result;
}

/* A finest level with an error above 0 is visibly coarser up close. State the error in pixels at three metres, where a
 * figure of two metres fills the picture. */
static void state_losses(const planner *p)
{
    for (uint32_t i = 0; i < p->plan->concession_count; i++) {
        noh_concession *c = &p->plan->concessions[i];
        if (c->what == finest_text && c->kind < p->desc->kind_count) {
            const noh_kind_plan *k = &p->plan->kinds[c->kind];
            c->loss_pixels = k->levels[k->finest_level].error_m *
                             noh_lod_scale(3.0f, NOH_STAGE_VIEW_RAD, p->desc->height_px);
        }
    }
}

/* ---- making a plan ---- */

noh_result noh_stage_plan_kind(const noh_stage_desc *desc, uint32_t kind, noh_stage_plan *plan, noh_stage_needs *needs,
                               noh_error *error)
{
    noh_kind_plan *k = &plan->kinds[kind];
    const noh_kind_desc d = noh_stage_kind_desc(desc, kind);
    const uint32_t owner = noh_stage_bank_kind(desc, kind);
    noh_result result = noh_stage_find_levels(desc, kind, k, error);
    if (result != NOH_OK) {
        return result;
    }
    noh_stage_share_slots(desc, kind, k);
    k->clips = plan->kinds[owner].clips;
    if (owner == kind) result = noh_stage_measure_clips(desc, plan, kind, &k->clips, error);
    if (result == NOH_OK) result = noh_stage_measure_kind(desc, plan, kind, needs, error);
    if (result == NOH_OK) {
        k->track_count = noh_stage_track_count(&d);
        k->joint_count = needs->shape.joint_count;
        k->float_count = needs->float_count;
        k->segment_count = needs->segment_count;
        k->cached_segment_count = needs->cached_segment_count;
    }
    return result;
}

NOH_NEVER_INLINE static noh_result begin(const planner *p, uint32_t kind, noh_error *error)
{
    noh_stage_needs needs;
    return noh_stage_plan_kind(p->desc, kind, p->plan, &needs, error);
}

/* Kinds of the same clips have one bank, whose number is kept with the first of them. */
static void state_segments(const planner *p)
{
    for (uint32_t i = 0; i < p->desc->kind_count; i++) {
        const uint32_t owner = noh_stage_bank_kind(p->desc, i);
        p->plan->kinds[i].cached_segment_count = p->plan->kinds[owner].cached_segment_count;
    }
}

/* Packs of a kind: its mesh, its clips, its texture sets (of its own textures: its mesh). NULL: past the last. */
static const noh_pack *pack_at(const noh_kind_desc *d, uint32_t index)
{
    const uint32_t clip_count = d->clip_packs ? d->clip_pack_count : 1u;
    if (index == 0) return d->mesh;
    if (index <= clip_count) return d->clip_packs ? d->clip_packs[index - 1u] : d->clips;
    index -= 1u + clip_count;
    if (index >= d->texture_set_count) return NULL;
    return d->texture_sets[index].pack ? d->texture_sets[index].pack : d->mesh;
}

static int plays_from(const noh_kind_desc *d, const noh_pack *pack)
{
    int plays = 0;
    for (uint32_t i = 1; i <= (d->clip_packs ? d->clip_pack_count : 1u); i++)
        plays |= pack_at(d, i)->bytes == pack->bytes;
    return plays;
}

/* Without its clips, if only kinds with a reserve play them. */
static uint64_t pack_bytes(const noh_stage_desc *desc, const noh_pack *pack)
{
    const noh_chunk_run run = pack->runs[NOH_CHUNK_CLIP];
    uint64_t bytes = pack->byte_count;
    int in_place = NOH_PAGE, reserved = 0;
    for (uint32_t i = 0; !NOH_PAGE && i < desc->kind_count; i++) {
        const noh_kind_desc d = noh_stage_kind_desc(desc, i);
        if (!plays_from(&d, pack)) continue;
        in_place |= !d.clip_reserve;
        reserved |= d.clip_reserve != 0;
    }
    for (uint32_t i = 0; reserved && !in_place && i < run.count; i++) {
        bytes -= pack->chunks[run.first + i].bytes;
    }
    return bytes;
}

/* Whether a kind before this one, or this one before `index`, has the pack. */
static int is_counted(const noh_stage_desc *desc, uint32_t kind, uint32_t index, const noh_pack *pack)
{
    for (uint32_t i = 0; i <= kind; i++) {
        const noh_kind_desc d = noh_stage_kind_desc(desc, i);
        const noh_pack *other = pack_at(&d, 0);
        for (uint32_t k = 0; other && (i < kind || k < index); other = pack_at(&d, ++k)) {
            if (other->bytes == pack->bytes) return 1;
        }
    }
    return 0;
}

static uint64_t count_packs(const noh_stage_desc *desc)
{
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < desc->kind_count; i++) {
        const noh_kind_desc d = noh_stage_kind_desc(desc, i);
        const noh_pack *pack = pack_at(&d, 0);
        for (uint32_t k = 0; pack; pack = pack_at(&d, ++k)) {
            if (!is_counted(desc, i, k, pack)) bytes += pack_bytes(desc, pack);
        }
    }
    return bytes;
}

uint32_t noh_stage_mix(uint32_t hash, uint64_t value)
{
    for (int i = 0; i < 8; i++) {
        hash = (hash ^ (uint32_t)(value >> 8 * i & 255u)) * 16777619u;
    }
    return hash;
}

/* Of what places and root motion that a map gives depend on. */
static uint32_t mix_map(uint32_t hash, const noh_clip_map *map)
{
    uint32_t ratio;
    memcpy(&ratio, &map->ratio, sizeof ratio);
    return noh_stage_mix(noh_stage_mix(hash, ratio), (uint64_t)map->source->joint_count << 32 | 3u);
}

uint32_t noh_stage_hash_kind(uint32_t hash, const noh_stage_desc *desc, const noh_stage_plan *plan, uint32_t kind)
{
    const noh_kind_plan *k = &plan->kinds[kind];
    const noh_kind_desc d = noh_stage_kind_desc(desc, kind);
    const uint64_t values[] = { d.actor_count,
                                d.visible_max,
                                d.held_float_count,
                                d.mesh->byte_count,
                                d.texture_set_count,
                                k->level_count,
                                k->finest_level,
                                k->track_count,
                                k->joint_count,
                                k->float_count,
                                k->segment_count,
                                noh_stage_hash_module(&d, NOH_SLOT_SOURCE),
                                d.modifier_count,
                                noh_stage_hash_module(&d, NOH_SLOT_FACE),
                                noh_stage_hash_module(&d, NOH_SLOT_BODY) };
    for (uint32_t i = 0; i < sizeof values / sizeof *values; i++) hash = noh_stage_mix(hash, values[i]);
    if (d.springs.type) hash = noh_stage_mix(hash, noh_stage_hash_module(&d, NOH_SLOT_SPRINGS));
    if (d.match.type) hash = noh_stage_mix(hash, noh_stage_hash_module(&d, NOH_SLOT_MATCH));
    if (d.weight_rules) hash = noh_stage_mix(hash, 2);
    if (!NOH_PAGE && d.map) hash = mix_map(hash, d.map);
    if (d.worn_by) hash = noh_stage_mix(hash, (uint64_t)d.worn_by << 32);
    for (uint32_t p = 0; p < d.modifier_count; p++) hash = noh_stage_mix(hash, d.modifiers[p].state_bytes);
    for (uint32_t l = 0; l < k->level_count; l++) hash = noh_stage_mix(hash, k->levels[l].slot_count);
    return hash;
}

/* Of what the layout and the meaning of a state depend on. What is in slots is in the hash of the state. */
static uint32_t hash_plan(const noh_stage_desc *desc, const noh_stage_plan *plan)
{
    uint32_t hash = noh_stage_mix(2166136261u, plan->state_bytes);
    for (uint32_t i = 0; i < desc->kind_count; i++) {
        const noh_kind_room *room = &plan->kinds[i].room;
        hash = desc->kinds[i].changes ? noh_stage_mix(noh_stage_mix(hash, room->actor_count), room->state_bytes)
                                      : noh_stage_hash_kind(hash, desc, plan, i);
    }
    return hash;
}

static noh_result find_fit(const planner *p, noh_error *error)
{
    noh_result result = give_up_vertices(p, error);
    if (result == NOH_OK) result = give_up_halves(p, error);
    if (result == NOH_OK) result = give_up_segments(p, 2, error);
    if (result == NOH_OK) result = give_up_slots(p, error);
    if (result == NOH_OK) result = give_up_finest(p, error);
    if (result == NOH_OK) result = give_up_segments(p, 0, error);
    if (result == NOH_OK && fits(p->desc, p->plan)) result = give_back(p, error);
    if (result == NOH_OK && !fits(p->desc, p->plan)) {
        return noh_fail(error, NOH_ERR_MEMORY,
                        "no choice of levels, slots and cached segments keeps the bounds of a stage: raise them, "
                        "lower actor_count or visible_max of its kinds, or build their packs with --lod",
                        0, p->plan->cpu_bytes + p->plan->gpu_bytes);
    }
    return result;
}

noh_result noh_stage_plan_make(const noh_stage_desc *desc, const struct noh_gl_caps *caps, noh_stage_plan *plan,
                               noh_error *error)
{
    noh_stage_desc filled;
    planner p = { &filled, caps, plan };
    noh_result result;
    NOH_ASSERT(desc && plan);
    result = noh_stage_check_desc(desc, error);
    if (result != NOH_OK) {
        return result;
    }
    if (desc->gpu && !caps) {
        return noh_fail(error, NOH_ERR_ARG, "a stage that draws needs the capabilities of a GPU", 0, 0);
    }
    for (uint32_t i = 0; !NOH_PAGE && desc->share && i < desc->share->peer_count; i++) {
        const noh_stage_peer *peer = desc->share->peers ? &desc->share->peers[i] : NULL;
        if (!peer || !peer->desc || !peer->plan || !peer->desc->share || peer->desc->gpu != desc->gpu) {
            return noh_fail(error, NOH_ERR_ARG,
                            "a peer of a stage that shares is wrong: give it a desc with `share` and the same `gpu`, "
                            "and the plan of that desc",
                            i, 0);
        }
    }
    filled = noh_stage_desc_filled(desc);
    memset(plan, 0, sizeof *plan);
    plan->halves = desc->halves > 0;
    result = noh_stage_plan_rooms(&filled, caps, plan, error);
    for (uint32_t i = 0; i < desc->kind_count && result == NOH_OK; i++) {
        result = begin(&p, i, error);
    }
    if (result == NOH_OK) result = measure(&p, error);
    if (result == NOH_OK) result = find_fit(&p, error);
    if (result == NOH_OK) {
        state_losses(&p);
        state_segments(&p);
        plan->pack_bytes = count_packs(desc);
        plan->hash = hash_plan(desc, plan);
    }
    return result;
}
