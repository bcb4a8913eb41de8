#include "bank/clip_bank.h"

#include <string.h>

#include "bank/clip_bank_bind_internal.h"
#include "bank/clip_bank_internal.h"
#include "base/arena.h"
#include "base/hash.h"
#include "mesh/mesh.h"

typedef struct noh_bank_clip bank_clip;

#define TRACKS 2u /* of an instance that play at once, where the desc does not say */

/* A bank is made in two passes over the pack. The first counts (clips that fit, their keys, markers and floats, the
 * cache's needs) without memory, out of the packs' bytes alone; the second carves exactly that and fills it in the same
 * order. */

/* What the first pass finds. */
typedef struct counts {
    noh_clip_set shape;
    uint32_t groups, runs, sampled, foreign, unknown;
    size_t clip_bytes;
    noh_clip_cache_needs cache;
    uint32_t cached_segments;
    size_t cache_bytes;
    int roots;
} counts;

/* Where it all lies. NULL while measuring. */
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
    uint32_t *pack_clips;
    const noh_clip **opened;
    uint8_t *clip_memory, *cache_memory;
} parts;

/* ---- counting ---- */

static size_t align_up(size_t bytes)
{
    return (bytes + 15u) & ~(size_t)15u;
}

/* The bank's floats begin with the weights of every node that has targets. */
static void count_nodes(const noh_bank_binding *b, counts *c)
{
    noh_clip_group group;
    uint32_t node = 0;
    while (noh_bank_next_node(b, &node, &c->shape.float_count, &group)) {
        c->groups++;
    }
}

/* A clip's groups: a named float that no clip before had is appended to the bank's floats; weights go to a node of the
 * mesh pack, if it has one of their name. */
static void count_groups(const noh_bank_binding *b, uint32_t index, const noh_clip_desc *clip, counts *c)
{
    noh_clip_group_reader reader = noh_clip_groups_of(clip);
    noh_clip_group group, found;
    while (noh_clip_next_group(&reader, &group)) {
        if (noh_bank_is_new(b, index, clip, &group)) {
            c->groups++;
            c->shape.float_count += group.width;
        }
        if (noh_bank_is_named(&group) || noh_bank_find_node(b, &group, &found)) {
            c->runs++;
        } else {
            c->unknown++;
        }
    }
}

static noh_result count_clip(const noh_bank_binding *b, uint32_t index, counts *c, noh_error *error)
{
    noh_pack_clip packed;
    noh_clip_desc clip;
    noh_clip_info info;
    size_t bytes;
    noh_error why = { NOH_OK, "", 0, 0 };
    if (!noh_bank_fits(b, index, &packed, &clip)) {
        c->foreign++;
        return NOH_OK;
    }
    if (noh_clip_measure(&clip, &info, &bytes, &why)) {
        return noh_fail(error, why.result == NOH_ERR_ARG ? NOH_ERR_DATA : why.result, why.what, index, why.need);
    }
    if (info.duration_ticks > NOH_DURATION_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "a clip of a clip bank is longer than NOH_DURATION_MAX", index,
                        info.duration_ticks);
    }
    c->shape.clip_count++;
    c->shape.event_count += packed.header->event_count;
    c->shape.marker_count += packed.header->marker_count;
    c->sampled = info.float_count > c->sampled ? info.float_count : c->sampled;
    c->clip_bytes += align_up(bytes);
    noh_clip_cache_needs_add(&c->cache, &info);
    count_groups(b, index, &clip, c);
    return NOH_OK;
}

/* How many segments the cache holds: enough for what plays at once, unless the desc says how many; no more than there
 * are, but at least 2. A desc that asks for 1 is passed on, for the cache to refuse. */
static uint32_t cached_segments_of(const noh_clip_bank_desc *desc, uint32_t segments)
{
    const uint64_t instances = desc->instance_count ? desc->instance_count : 1u,
                   tracks = desc->track_count ? desc->track_count : TRACKS, most = NOH_CLIP_CACHE_SEGMENTS_MAX;
    const uint64_t plays = NOH_CLIP_CACHE_SEGMENTS_PER_TRACK * (instances < most ? instances : most) *
                           (tracks < most ? tracks : most); /* of the full numbers, 64 bits might overflow */
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
    memset(c, 0, sizeof *c);
    c->shape.joint_count = b->skeleton.joint_count;
    c->roots = desc->root_axes != 0 && c->shape.joint_count != 0;
    count_nodes(b, c);
    for (uint32_t i = 0; i < b->clips->clip_count; i++) {
        const noh_result r = count_clip(b, i, c, error);
        if (r) return r;
    }
    if (c->shape.clip_count == 0) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        c->foreign ? "no clip fits: all move another skeleton (names or parents of joints differ); "
                                     "build mesh and clips from one skeleton"
                                   : "the pack has no clips",
                        0, c->foreign);
    }
    if (c->shape.float_count > NOH_FLOATS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT,
                        "a clip bank has more floats (morph weights of all nodes, and named ones) than NOH_FLOATS_MAX",
                        0, c->shape.float_count);
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
    p->clips = noh_arena_carve(arena, n->clip_count * sizeof *p->clips, 4u);
    p->events = noh_arena_carve(arena, n->event_count * sizeof *p->events, 4u);
    p->markers = noh_arena_carve(arena, n->marker_count * sizeof *p->markers, 4u);
    p->groups = noh_arena_carve(arena, c->groups * sizeof *p->groups, 4u);
    p->defaults = noh_arena_carve(arena, n->float_count * sizeof *p->defaults, 4u);
    p->sampled = noh_arena_carve(arena, c->sampled * sizeof *p->sampled, 4u);
    p->pack_clips = noh_arena_carve(arena, n->clip_count * sizeof *p->pack_clips, 4u);
    p->runs = noh_arena_carve(arena, c->runs * sizeof *p->runs, 2u);
    p->clip_memory = noh_arena_carve(arena, c->clip_bytes, 16u);
    p->cache_memory = noh_arena_carve(arena, c->cache_bytes, 16u);
    return arena->used;
}

static noh_result check_desc(const noh_clip_bank_desc *desc, noh_error *error)
{
    if (!desc->clips) return noh_fail(error, NOH_ERR_ARG, "clips of a clip bank is NULL", 0, 0);
    if (desc->root_axes > (NOH_ROOT_GROUND | NOH_ROOT_Y)) {
        return noh_fail(error, NOH_ERR_ARG, "root_axes of a clip bank hold unknown bits", desc->root_axes, 0);
    }
    if (desc->root_axes && desc->root_up > 2u)
        return noh_fail(error, NOH_ERR_ARG, "root_up of a clip bank is no axis", desc->root_up, 0);
    return NOH_OK;
}

static noh_result measure(const noh_clip_bank_desc *desc, noh_bank_binding *b, counts *c, size_t *bytes,
                          noh_error *error)
{
    noh_arena arena = noh_arena_measure();
    parts p;
    noh_result r = check_desc(desc, error);
    if (!r) r = noh_bank_bind(desc->clips, desc->mesh ? desc->mesh : desc->clips, desc->skeleton, b, error);
    if (!r) r = count(desc, b, c, error);
    if (!r) *bytes = carve(&arena, c, &p);
    return r;
}

/* As noh_clip_bank_view_size, before there is a bank. */
static size_t view_bytes(const counts *c)
{
    noh_arena arena = noh_arena_measure();
    (void)noh_arena_carve(&arena, sizeof(noh_clip_bank_view), 16u);
    (void)noh_arena_carve(&arena, noh_clip_view_needs_size(&c->cache), 16u);
    (void)noh_arena_carve(&arena, c->sampled * sizeof(float), 4u);
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

/* The bank's group of a named float; a new one is appended. */
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

/* Where the clip's floats go among the bank's: one run for each of its groups that is played. */
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
        noh_event_key *key = &p->events[bank->clips.event_count++];
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

/* Open a clip and enter it in the set. It was measured, so opening succeeds. */
static void fill_clip(const noh_bank_binding *b, uint32_t index, const noh_pack_clip *from, const noh_clip_desc *desc,
                      parts *p)
{
    const uint32_t m = p->bank->clips.clip_count++;
    const size_t bytes = align_up(noh_clip_size(desc, NULL));
    noh_clip_entry *to = &p->clips[m];
    noh_clip *clip = NULL;
    (void)noh_clip_init(p->clip_memory, bytes, desc, &clip, NULL);
    p->clip_memory += bytes;
    p->opened[m] = clip;
    p->pack_clips[m] = index;
    p->bound[m].joint_count = clip->info.joint_count;
    memset(to, 0, sizeof *to);
    to->name_hash = noh_hash_name(from->name);
    to->duration_ticks = (uint32_t)clip->info.duration_ticks;
    to->loop = clip->info.flags & NOH_CLIP_FLAG_LOOP ? NOH_LOOP_REPEAT : NOH_LOOP_ONCE;
    fill_keys(from, p, to);
    fill_runs(b, clip, p, &p->bound[m]);
    to->flags = (p->bound[m].joint_count ? 0u : NOH_CLIP_FLOATS_ONLY) |
                (p->bound[m].float_runs ? 0u : NOH_CLIP_JOINTS_ONLY);
}

static void fill(const noh_bank_binding *b, parts *p)
{
    fill_nodes(b, p);
    for (uint32_t i = 0; i < b->clips->clip_count; i++) {
        noh_pack_clip packed;
        noh_clip_desc desc;
        if (noh_bank_fits(b, i, &packed, &desc)) {
            fill_clip(b, i, &packed, &desc, p);
        }
    }
}

/* ---- joining ---- */

static void join(const noh_bank_binding *b, const counts *c, parts *p)
{
    noh_clip_bank *bank = p->bank;
    bank->skeleton = b->skeleton;
    bank->groups = p->groups;
    bank->pack_clips = p->pack_clips;
    bank->foreign_count = c->foreign;
    bank->unknown_count = c->unknown;
    bank->bound = p->bound;
    bank->sampled = p->sampled;
    bank->sampled_count = c->sampled;
    bank->nodes = b->mesh->nodes;
    bank->clips.joint_count = b->skeleton.joint_count;
    bank->clips.clips = p->clips;
    bank->clips.events = p->events;
    bank->clips.markers = p->markers;
    bank->clips.bind_pose = b->header ? b->skeleton.bind_pose
                                      : (const noh_transform *)(const void *)p->clips; /* not NULL; of no joints */
    bank->clips.float_defaults = p->defaults;
    noh_clip_bank_sample_cache(bank);
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
    (void)carve(&arena, &c, &p);
    memset(p.bank, 0, sizeof *p.bank);
    fill(&b, &p);
    join(&b, &c, &p);
    r = open_cache(&c, &p, error);
    if (r) return r;
    if (noh_clip_set_check(&p.bank->clips, &why)) {
        return noh_fail(error, why.result, why.what, p.pack_clips[why.where], 0);
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
    const bank_clip *clip = &bank->bound[index];
    NOH_ASSERT(index < bank->clips.clip_count && group < bank->group_count);
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
