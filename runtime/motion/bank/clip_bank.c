#include "core/base/arena_internal.h"
#include "core/base/assert_internal.h"
#include "motion/anim/root_motion_internal.h"
#include "motion/anim/clip_set_internal.h"
#include "motion/bank/clip_bank_internal.h"
#include "motion/clip/clip_cache_internal.h"
#include "motion/clip/clip_codec_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/pack.h"

#include <string.h>

#include "motion/bank/clip_bank_bind_internal.h"
#include "motion/clip/clip_view_internal.h"

typedef struct noh_bank_clip bank_clip;

#define TRACKS 2u /* per instance at the same time, if the desc does not set it */

/* A bank is made in two passes over the packs. The first counts (clips that fit, their keys, markers and floats, the
 * size of the cache) without memory, from the packs' bytes alone; the second carves exactly that and fills it in the
 * same order. */

/* Results of the first pass. */
typedef struct counts {
    noh_clip_set shape;
    uint32_t groups, runs, sampled, foreign, replaced, unknown;
    size_t clip_bytes;
    noh_clip_cache_needs cache;
    uint32_t cached_segments;
    size_t cache_bytes;
    int roots;
    uint32_t reserve_bytes; /* 0: none */
    size_t clip_max;        /* bytes of the largest clip in its pack */
    uint32_t mapped;        /* joints in memory for the map; 0: no clip needs it */
} counts;

/* The layout. NULL while measuring. */
typedef struct parts {
    noh_clip_bank *bank;
    noh_clip_entry *clips;
    noh_event_key *events;
    noh_marker *markers;
    bank_clip *bound;
    noh_bank_floats *runs;
    noh_clip_group *groups;
    float *defaults, *sampled;
    noh_root_track *roots;
    const noh_root_ends **root_ends;
    uint32_t *packs, *pack_clips;
    const noh_clip **opened;
    uint8_t *clip_memory, *cache_memory;
    noh_clip_reserve *reserve;
    noh_reserved_clip *reserved;
    uint32_t *event_names;
    uint8_t *reserve_memory;
    noh_transform *mapped;
} parts;

/* ---- counting ---- */

/* The bank's floats begin with the weights of every node that has targets. */
static void count_nodes(const noh_bank_binding *b, counts *c)
{
    noh_clip_group group;
    uint32_t node = 0;
    while (noh_bank_next_node(b, &node, &c->shape.float_count, &group)) {
        c->groups++;
    }
}

/* Count a clip's groups: named floats become floats of the bank, weights belong to the node of the mesh pack with that
 * name, if any. */
static void count_groups(const noh_bank_binding *b, const noh_bank_found *found, counts *c)
{
    noh_clip_group_reader reader = noh_clip_groups_of(&found->clip);
    noh_clip_group group, node;
    while (noh_clip_next_group(&reader, &group)) {
        if (noh_bank_is_named(&group) || noh_bank_find_node(b, &group, &node)) {
            c->runs++;
        } else {
            c->unknown++;
        }
    }
}

static noh_result count_clip(const noh_bank_binding *b, const noh_bank_found *found, counts *c, noh_error *error)
{
    noh_clip_info info;
    size_t bytes;
    noh_error why = { NOH_OK, "", 0, 0 };
    if (noh_clip_measure(&found->clip, &info, &bytes, &why)) {
        return noh_fail(error, why.result == NOH_ERR_ARG ? NOH_ERR_DATA : why.result, why.what,
                        noh_bank_where(found->at), why.need);
    }
    if (info.duration_ticks > NOH_DURATION_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "a clip of a clip bank is longer than NOH_DURATION_MAX",
                        noh_bank_where(found->at), info.duration_ticks);
    }
    if (c->shape.clip_count == NOH_CLIP_CACHE_CLIPS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "the packs of a clip bank have more clips than NOH_CLIP_CACHE_CLIPS_MAX",
                        noh_bank_where(found->at), (uint64_t)c->shape.clip_count + 1u);
    }
    c->shape.clip_count++;
    if (!NOH_PAGE && found->is_mapped) c->mapped = noh_bank_map_joints(b->map);
    if (!NOH_PAGE && found->clip.byte_count > c->clip_max) c->clip_max = found->clip.byte_count;
    c->shape.event_count += found->packed.header->event_count;
    c->shape.marker_count += found->packed.header->marker_count;
    c->sampled = info.float_count > c->sampled ? info.float_count : c->sampled;
    c->clip_bytes = noh_aligned(bytes) > SIZE_MAX - c->clip_bytes ? SIZE_MAX : c->clip_bytes + noh_aligned(bytes);
    noh_clip_cache_needs_add(&c->cache, &info);
    count_groups(b, found, c);
    return NOH_OK;
}

/* Count all clips: clips of the bank, clips replaced by a later pack, clips of another skeleton. */
static noh_result count_clips(const noh_bank_binding *b, counts *c, noh_error *error)
{
    const uint32_t fitting = noh_bank_count_fitting(b);
    noh_bank_place next = { 0, 0 };
    noh_bank_found found;
    while (noh_bank_next_clip(b, &next, &found)) {
        const noh_result r = count_clip(b, &found, c, error);
        if (r) return r;
    }
    for (uint32_t i = 0; i < b->pack_count; i++) {
        c->foreign += b->packs[i]->runs[NOH_CHUNK_CLIP].count;
    }
    c->foreign -= fitting;
    c->replaced = fitting - c->shape.clip_count;
    noh_bank_count_names(b, &c->groups, &c->shape.float_count); /* they follow the nodes' floats */
    return NOH_OK;
}

/* The number of segments that the cache holds: enough for everything that plays at the same time, unless the desc sets
 * it; no more than exist, but at least 2. A desc with 1 is passed on, for the cache to reject. */
static uint32_t cached_segments_of(const noh_clip_bank_desc *desc, uint32_t segments)
{
    const uint64_t instances = desc->instance_count ? desc->instance_count : 1u,
                   tracks = desc->track_count ? desc->track_count : TRACKS, most = NOH_CLIP_CACHE_SEGMENTS_MAX;
    const uint64_t plays = NOH_CLIP_CACHE_SEGMENTS_PER_TRACK * (instances < most ? instances : most) *
                           (tracks < most ? tracks : most); /* the product of the full numbers might overflow 64 bits */
    const uint64_t wanted = desc->cached_segment_count            ? desc->cached_segment_count
                            : plays < NOH_CLIP_CACHE_SEGMENTS_MAX ? plays
                                                                  : NOH_CLIP_CACHE_SEGMENTS_MAX;
    return wanted < segments || desc->cached_segment_count == 1u ? (uint32_t)wanted
           : segments > 1u                                       ? segments
                                                                 : NOH_CLIP_CACHE_SEGMENTS_MIN;
}

static noh_result count(const noh_clip_bank_desc *desc, const noh_bank_binding *b, counts *c, noh_error *error)
{
    noh_error why = { NOH_OK, "", 0, 0 };
    noh_result r;
    memset(c, 0, sizeof *c);
    c->shape.joint_count = b->skeleton.joint_count;
    c->roots = desc->root_axes != 0 && c->shape.joint_count != 0;
    count_nodes(b, c);
    r = count_clips(b, c, error);
    if (r) return r;
    if (c->shape.clip_count == 0) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        c->foreign ? "no clip fits: all are for another skeleton (joint names or parents differ); "
                                     "build mesh and clips from one skeleton"
                                   : "the packs of a clip bank have no clips",
                        0, c->foreign);
    }
    if (c->shape.float_count > NOH_FLOATS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT,
                        "a clip bank has more floats (morph weights of all nodes, and named ones) than NOH_FLOATS_MAX",
                        0, c->shape.float_count);
    }
    c->reserve_bytes = (uint32_t)noh_aligned(desc->reserve_bytes);
    if (!NOH_PAGE && c->reserve_bytes && c->reserve_bytes < noh_aligned(c->clip_max)) {
        return noh_fail(error, NOH_ERR_ARG,
                        "clip_reserve is smaller than the largest clip: raise it to `need` bytes or more", 0,
                        noh_aligned(c->clip_max));
    }
    c->cached_segments = cached_segments_of(desc, c->cache.segment_count);
    c->cache_bytes = noh_clip_cache_needs_size(&c->cache, c->cached_segments, &why);
    return c->cache_bytes ? NOH_OK : noh_fail(error, why.result, why.what, why.where, why.need);
}

static size_t carve(noh_arena *arena, const counts *c, parts *p)
{
    const noh_clip_set *n = &c->shape;
    p->bank = noh_arena_carve(arena, sizeof *p->bank, 16u);
    p->opened = noh_arena_carve(arena, n->clip_count * sizeof *p->opened, 8u);
    p->bound = noh_arena_carve(arena, n->clip_count * sizeof *p->bound, 8u);
    p->roots = noh_arena_carve(arena, c->roots ? n->clip_count * sizeof *p->roots : 0u, 8u);
    p->root_ends = c->roots ? noh_arena_carve(arena, n->clip_count * sizeof *p->root_ends, 8u) : NULL;
    p->clips = noh_arena_carve(arena, n->clip_count * sizeof *p->clips, 4u);
    p->events = noh_arena_carve(arena, n->event_count * sizeof *p->events, 4u);
    p->markers = noh_arena_carve(arena, n->marker_count * sizeof *p->markers, 4u);
    p->groups = noh_arena_carve(arena, c->groups * sizeof *p->groups, 4u);
    p->defaults = noh_arena_carve(arena, n->float_count * sizeof *p->defaults, 4u);
    p->sampled = noh_arena_carve(arena, c->sampled * sizeof *p->sampled, 4u);
    p->packs = noh_arena_carve(arena, n->clip_count * sizeof *p->packs, 4u);
    p->pack_clips = noh_arena_carve(arena, n->clip_count * sizeof *p->pack_clips, 4u);
    p->runs = noh_arena_carve(arena, c->runs * sizeof *p->runs, 2u);
    p->clip_memory = noh_arena_carve(arena, c->clip_bytes, 16u);
    p->cache_memory = noh_arena_carve(arena, c->cache_bytes, 16u);
    p->mapped = c->mapped ? noh_arena_carve(arena, c->mapped * sizeof *p->mapped, 4u) : NULL;
    if (!NOH_PAGE && c->reserve_bytes) {
        p->reserve = noh_arena_carve(arena, sizeof *p->reserve, 16u);
        p->reserved = noh_arena_carve(arena, n->clip_count * sizeof *p->reserved, 4u);
        p->event_names = noh_arena_carve(arena, n->event_count * sizeof *p->event_names, 4u);
        p->reserve_memory = noh_arena_carve(arena, c->reserve_bytes, 16u);
    }
    return arena->used;
}

static noh_result check_packs(const noh_clip_bank_desc *desc, noh_error *error)
{
    const char *what = desc->clips ? (desc->clip_packs || desc->clip_pack_count
                                          ? "clips and clip_packs of a clip bank are both set: set clips for one pack, "
                                            "clip_packs for several"
                                          : NULL)
                       : !desc->clip_packs || !desc->clip_pack_count
                           ? "a clip bank needs clips, or clip_packs with clip_pack_count above 0"
                           : NULL;
    if (what) return noh_fail(error, NOH_ERR_ARG, what, 0, 0);
    for (uint32_t i = 0; i < desc->clip_pack_count; i++) {
        if (!desc->clip_packs[i])
            return noh_fail(error, NOH_ERR_ARG, "an entry of clip_packs of a clip bank is NULL", i, 0);
    }
    return NOH_OK;
}

static noh_result check_desc(const noh_clip_bank_desc *desc, noh_error *error)
{
    const noh_result r = check_packs(desc, error);
    if (r) return r;
    if (desc->root_axes > (NOH_ROOT_GROUND | NOH_ROOT_Y)) {
        return noh_fail(error, NOH_ERR_ARG, "root_axes of a clip bank must be bits of NOH_ROOT_GROUND and NOH_ROOT_Y",
                        desc->root_axes, 0);
    }
    if (desc->root_axes && desc->root_up > 2u)
        return noh_fail(error, NOH_ERR_ARG, "root_up of a clip bank must be 0, 1 or 2", desc->root_up, 0);
    return NOH_OK;
}

static noh_result measure(const noh_clip_bank_desc *desc, noh_bank_binding *b, counts *c, size_t *bytes,
                          noh_error *error)
{
    noh_arena arena = noh_arena_measure();
    parts p;
    noh_result r = check_desc(desc, error);
    if (!r) r = noh_bank_bind(desc, b, error);
    if (!r) r = count(desc, b, c, error);
    if (r) return r;
    *bytes = carve(&arena, c, &p);
    return *bytes < SIZE_MAX ? NOH_OK
                             : noh_fail(error, NOH_ERR_LIMIT,
                                        "the clips of a clip bank need more memory than size_t can count", 0, SIZE_MAX);
}

/* The size of noh_clip_bank_view_size, before the bank is made. */
static size_t view_bytes(const counts *c)
{
    noh_arena arena = noh_arena_measure();
    (void)noh_arena_carve(&arena, sizeof(noh_clip_bank_view), 16u);
    (void)noh_arena_carve(&arena, noh_clip_view_needs_size(&c->cache), 16u);
    (void)noh_arena_carve(&arena, c->sampled * sizeof(float), 4u);
    if (c->mapped) (void)noh_arena_carve(&arena, c->mapped * sizeof(noh_transform), 4u);
    return arena.used;
}

noh_result noh_clip_bank_measure(const noh_clip_bank_desc *desc, noh_clip_bank_needs *needs, noh_error *error)
{
    noh_bank_binding b;
    counts c;
    size_t bytes = 0;
    const noh_result r = measure(desc, &b, &c, &bytes, error);
    if (!r) {
        needs->bytes = bytes;
        needs->view_bytes = view_bytes(&c);
        needs->shape = c.shape;
        needs->cached_segment_count = c.cached_segments < c.cache.segment_count ? c.cached_segments
                                                                                : c.cache.segment_count;
        needs->segment_count = c.cache.segment_count;
        needs->foreign_count = c.foreign;
        needs->replaced_count = c.replaced;
    }
    return r;
}

size_t noh_clip_bank_size(const noh_clip_bank_desc *desc, noh_error *error)
{
    noh_clip_bank_needs needs;
    return noh_clip_bank_measure(desc, &needs, error) ? 0u : needs.bytes;
}

/* ---- filling ---- */

static void fill_nodes(const noh_bank_binding *b, parts *p)
{
    noh_clip_bank *bank = p->bank;
    uint32_t node = 0, first = 0;
    while (noh_bank_next_node(b, &node, &first, &p->groups[bank->group_count])) {
        const noh_clip_group *group = &p->groups[bank->group_count++];
        const noh_node *n = &b->mesh->nodes[group->node];
        noh_mesh mesh;
        (void)noh_pack_mesh_at(b->mesh, n->mesh, &mesh, NULL);
        memcpy(p->defaults + group->first,
               n->first_weight == NOH_NONE ? mesh.weights : b->mesh->node_weights + n->first_weight,
               group->width * sizeof *p->defaults);
        bank->clips.float_count = first;
    }
}

/* The bank's group of a named float; appended if it is new. */
static const noh_clip_group *name_group(parts *p, const noh_clip_group *wanted)
{
    noh_clip_bank *bank = p->bank;
    noh_clip_group *group;
    for (uint32_t i = 0; i < bank->group_count; i++) {
        if (noh_bank_is_named(&p->groups[i]) && noh_bank_same_group(&p->groups[i], wanted)) {
            return &p->groups[i];
        }
    }
    group = &p->groups[bank->group_count++];
    *group = *wanted;
    group->first = bank->clips.float_count;
    bank->clips.float_count += group->width;
    memset(p->defaults + group->first, 0, group->width * sizeof *p->defaults);
    return group;
}

/* Where the clip's floats go in the bank: one run for each of its groups that is played. */
static void fill_runs(const noh_bank_binding *b, const noh_clip *opened, parts *p, bank_clip *clip)
{
    noh_bank_floats *run = p->runs;
    clip->floats = run;
    for (uint32_t g = 0; g < opened->info.group_count; g++) {
        const noh_clip_group group = noh_clip_group_at(opened, g);
        noh_clip_group found;
        if (group.width == 0) {
            continue;
        }
        if (noh_bank_is_named(&group)) {
            found = *name_group(p, &group);
        } else if (!noh_bank_find_node(b, &group, &found)) {
            continue;
        }
        run->from = (uint16_t)group.first;
        run->to = (uint16_t)found.first;
        run->width = (uint16_t)group.width;
        run++;
    }
    clip->float_runs = (uint32_t)(run - p->runs);
    p->runs = run;
}

static void fill_keys(const noh_pack_clip *from, parts *p, noh_clip_entry *to)
{
    noh_clip_bank *bank = p->bank;
    to->first_event = bank->clips.event_count;
    to->event_count = from->header->event_count;
    to->first_marker = bank->clips.marker_count;
    to->marker_count = from->header->marker_count;
    for (uint32_t i = 0; i < to->event_count; i++) {
        noh_event_key *key = &p->events[bank->clips.event_count];
        if (!NOH_PAGE && p->event_names) p->event_names[bank->clips.event_count] = from->events[i].name;
        bank->clips.event_count++;
        key->tick = from->events[i].tick;
        key->name_hash = from->events[i].name_hash;
        memcpy(key->payload, from->events[i].payload, sizeof key->payload);
        key->weight_min = from->events[i].weight_min;
    }
    for (uint32_t i = 0; i < to->marker_count; i++) {
        noh_marker *marker = &p->markers[bank->clips.marker_count++];
        marker->tick = from->markers[i].tick;
        marker->id = from->markers[i].name_hash;
    }
}

/* Open a clip and add it to the set. It was measured, so opening succeeds. */
static void fill_clip(const noh_bank_binding *b, const noh_bank_found *from, parts *p)
{
    const uint32_t m = p->bank->clips.clip_count++;
    const size_t bytes = noh_aligned(noh_clip_size(&from->clip, NULL));
    noh_clip_entry *to = &p->clips[m];
    noh_clip *clip = NULL;
    (void)noh_clip_init(p->clip_memory, bytes, &from->clip, &clip, NULL);
    p->clip_memory += bytes;
    p->opened[m] = clip;
    p->packs[m] = from->at.pack;
    p->pack_clips[m] = from->at.index;
    p->bound[m].joint_count = (uint16_t)clip->info.joint_count;
    p->bound[m].is_mapped = (uint16_t)from->is_mapped;
    if (p->root_ends) {
        p->root_ends[m] = clip->info.joint_count && !from->is_mapped ? &from->packed.header->root_ends : NULL;
    }
    memset(to, 0, sizeof *to);
    to->name_hash = noh_hash_name(from->packed.name);
    to->duration_ticks = (uint32_t)clip->info.duration_ticks;
    to->loop = clip->info.flags & NOH_CLIP_FLAG_LOOP ? NOH_LOOP_REPEAT : NOH_LOOP_ONCE;
    fill_keys(&from->packed, p, to);
    fill_runs(b, clip, p, &p->bound[m]);
    to->flags = (p->bound[m].joint_count ? 0u : NOH_CLIP_FLOATS_ONLY) |
                (p->bound[m].float_runs ? 0u : NOH_CLIP_JOINTS_ONLY) |
                (!NOH_PAGE && from->is_mapped ? NOH_CLIP_MAPPED : 0u);
}

static void fill(const noh_bank_binding *b, parts *p)
{
    noh_bank_place next = { 0, 0 };
    noh_bank_found found;
    fill_nodes(b, p);
    while (noh_bank_next_clip(b, &next, &found)) {
        fill_clip(b, &found, p);
    }
}

/* ---- joining ---- */

static void join(const noh_bank_binding *b, const counts *c, parts *p)
{
    noh_clip_bank *bank = p->bank;
    bank->skeleton = b->skeleton;
    bank->groups = p->groups;
    bank->packs = p->packs;
    bank->pack_clips = p->pack_clips;
    bank->foreign_count = c->foreign;
    bank->replaced_count = c->replaced;
    bank->unknown_count = c->unknown;
    bank->bound = p->bound;
    bank->sampled = p->sampled;
    bank->sampled_count = c->sampled;
    bank->nodes = b->mesh->nodes;
    bank->clips.joint_count = b->skeleton.joint_count;
    bank->clips.clips = p->clips;
    bank->clips.events = p->events;
    bank->clips.markers = p->markers;
    bank->clips.root_ends = p->root_ends;
    bank->map = c->mapped ? b->map : NULL;
    bank->mapped = p->mapped;
    bank->clips.bind_pose = b->header ? b->skeleton.bind_pose
                                      /* not NULL, although there are no joints */
                                      : (const noh_transform *)(const void *)p->clips;
    bank->clips.float_defaults = p->defaults;
    noh_clip_bank_sample_cache(bank);
}

static void open_reserve(const counts *c, const parts *p)
{
    noh_clip_reserve *r = p->reserve;
    if (NOH_PAGE || !c->reserve_bytes) return;
    memset(r, 0, sizeof *r);
    memset(p->reserved, 0, c->shape.clip_count * sizeof *p->reserved);
    r->clips = p->reserved;
    r->clip_count = c->shape.clip_count;
    r->event_names = p->event_names;
    r->bytes = p->reserve_memory;
    r->room = c->reserve_bytes;
    p->bank->clips.reserve = r;
}

static noh_result open_cache(const counts *c, parts *p, noh_error *error)
{
    noh_clip_cache_desc cache;
    cache.clips = p->opened;
    cache.clip_count = c->shape.clip_count;
    cache.cached_segment_count = c->cached_segments;
    return noh_clip_cache_init(p->cache_memory, c->cache_bytes, &cache, &p->bank->cache, error);
}

/* Root tracks sample the ends of every clip, which needs the cache: so they come last. */
static noh_result measure_roots(const noh_clip_bank_desc *desc, parts *p, noh_error *error)
{
    noh_clip_bank *bank = p->bank;
    for (uint32_t m = 0; m < bank->clips.clip_count; m++) {
        const noh_result r = noh_root_track_measure(&bank->clips, m, desc->root_axes, desc->root_up, &p->roots[m],
                                                    error);
        if (r) return r;
    }
    bank->clips.roots = p->roots;
    return NOH_OK;
}

noh_result noh_clip_bank_init(void *memory, size_t bytes, const noh_clip_bank_desc *desc, noh_clip_bank **bank,
                              noh_error *error)
{
    noh_arena arena;
    noh_error why = { NOH_OK, "", 0, 0 };
    noh_bank_binding b;
    counts c;
    parts p;
    size_t need = 0;
    noh_result r = measure(desc, &b, &c, &need, error);
    if (!r) r = noh_arena_open(&arena, memory, bytes, need, error);
    if (r) return r;
    p.event_names = NULL;
    (void)carve(&arena, &c, &p);
    memset(p.bank, 0, sizeof *p.bank);
    fill(&b, &p);
    join(&b, &c, &p);
    open_reserve(&c, &p);
    r = open_cache(&c, &p, error);
    if (r) return r;
    if (noh_clip_set_check(&p.bank->clips, &why)) {
        const noh_bank_place at = { p.packs[why.where], p.pack_clips[why.where] };
        return noh_fail(error, why.result, why.what, noh_bank_where(at), 0);
    }
    if (c.roots) r = measure_roots(desc, &p, error);
    if (!r) *bank = p.bank;
    return r;
}

/* ---- looking ---- */

uint32_t noh_clip_bank_find(const noh_clip_bank *bank, const char *name)
{
    return noh_clip_set_find(&bank->clips, noh_hash_name(name));
}

int noh_clip_bank_moves(const noh_clip_bank *bank, uint32_t index, uint32_t group)
{
    NOH_ASSERT(index < bank->clips.clip_count && group < bank->group_count);
    const bank_clip *clip = &bank->bound[index];
    for (uint32_t i = 0; i < clip->float_runs; i++) {
        if (clip->floats[i].to == bank->groups[group].first && clip->floats[i].width == bank->groups[group].width) {
            return 1;
        }
    }
    return 0;
}

uint32_t noh_clip_bank_node_group(const noh_clip_bank *bank, uint32_t node)
{
    for (uint32_t g = 0; node != NOH_NONE && g < bank->group_count; g++) {
        if (bank->groups[g].node == node) return g;
    }
    return NOH_NONE;
}

uint32_t noh_clip_bank_mesh_group(const noh_clip_bank *bank, uint32_t mesh)
{
    for (uint32_t g = 0; mesh != NOH_NONE && g < bank->group_count; g++) {
        if (bank->groups[g].node != NOH_NONE && bank->nodes[bank->groups[g].node].mesh == mesh) return g;
    }
    return NOH_NONE;
}

const float *noh_clip_bank_mesh_weights(const noh_clip_bank *bank, const float *floats, uint32_t mesh)
{
    const uint32_t group = noh_clip_bank_mesh_group(bank, mesh);
    return group == NOH_NONE ? NULL : floats + bank->groups[group].first;
}
