/* stage_wear.c: garments: actors whose joints follow the joints of the same names of their wearers.
 *
 * A garment is posed in its wearer's job, right after it, and at the same times: both update together, and while they
 * update below frame rate both blend the same two poses. A joint that follows has the wearer's matrix, bit by bit. What
 * the wearer lacks, such as the joints of a skirt, keeps the garment's own pose, which its springs then change. Which
 * joint follows which is found by name at init, once for each pair of kinds. */
#include <string.h>

#include "core/base/name_internal.h"
#include "motion/pose/skeleton_internal.h"
#include "stage/character/character_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "stage/cast/stage_internal.h"

/* ---- kinds ---- */

const char *noh_stage_bad_worn(const noh_stage_desc *desc, const noh_kind_desc *kind)
{
    const uint32_t worn_by = kind->worn_by;
    if (worn_by >> desc->kind_count) return "worn_by of a kind has a bit of a kind that does not exist";
    for (uint32_t i = 0; i < desc->kind_count; i++) {
        if (worn_by >> i & 1u && desc->kinds[i].worn_by)
            return "worn_by of a kind has the bit of a kind that is worn itself: clear one of both";
    }
    return NULL;
}

/* The number of bits below `end`. */
static uint32_t bits_below(uint32_t bits, uint32_t end)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < end; i++) count += bits >> i & 1u;
    return count;
}

size_t noh_stage_worn_maps(const noh_kind_desc *kind)
{
    return bits_below(kind->worn_by, NOH_STAGE_KINDS_MAX);
}

int noh_stage_can_wear(const noh_stage_kind *garment, uint32_t wearer_kind)
{
    return (int)(garment->desc->worn_by >> wearer_kind & 1u);
}

/* ---- maps ---- */

/* [joints, then floats] */
static uint16_t *map_of(const noh_stage *s, const noh_stage_kind *k, const noh_stage_kind *wearer)
{
    const uint32_t map = bits_below(k->desc->worn_by, (uint32_t)(wearer - s->kinds));
    return k->worn_maps + map * ((size_t)k->skeleton.joint_count + k->float_count);
}

static uint16_t find_joint(const noh_stage_kind *k, const char *name)
{
    for (uint32_t j = 0; name && name[0] && j < k->skeleton.joint_count; j++) {
        const char *own = noh_pack_joint_name(k->desc->mesh, k->desc->skeleton, j);
        if (own && noh_names_equal(own, name)) return (uint16_t)j;
    }
    return NOH_JOINT_ROOT;
}

/* The nearest joint above one that follows; NOH_JOINT_ROOT: none. */
static uint32_t following_above(const noh_stage_kind *k, const uint16_t *map, uint32_t joint)
{
    uint32_t up = k->skeleton.parents[joint];
    while (up != NOH_JOINT_ROOT && map[up] == NOH_JOINT_ROOT) up = k->skeleton.parents[up];
    return up;
}

/* A joint follows if what it is below in the garment is above it in the wearer, too. */
static void map_joints(const noh_stage_kind *k, const noh_stage_kind *wearer, uint16_t *map)
{
    for (uint32_t j = 0; j < k->skeleton.joint_count; j++) {
        const uint32_t up = following_above(k, map, j);
        map[j] = find_joint(wearer, noh_pack_joint_name(k->desc->mesh, k->desc->skeleton, j));
        if (map[j] != NOH_JOINT_ROOT && up != NOH_JOINT_ROOT && !noh_joint_is_below(&wearer->skeleton, map[j], map[up]))
            map[j] = NOH_JOINT_ROOT;
    }
}

static void map_floats(const noh_stage_kind *k, const noh_stage_kind *wearer, uint16_t *map)
{
    for (uint32_t f = 0; f < k->float_count; f++) {
        const uint32_t hash = k->named.name_hashes[f];
        map[f] = NOH_JOINT_ROOT;
        for (uint32_t g = 0; hash && g < wearer->float_count && map[f] == NOH_JOINT_ROOT; g++) {
            if (wearer->named.name_hashes[g] == hash) map[f] = (uint16_t)g;
        }
    }
}

void noh_stage_open_worn(noh_stage *s, uint32_t kind)
{
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        const noh_stage_kind *k = &s->kinds[i];
        for (uint32_t w = 0; w < s->desc.kind_count; w++) {
            uint16_t *map;
            if (!noh_stage_can_wear(k, w) || (kind != NOH_NONE && kind != i && kind != w)) continue;
            map = map_of(s, k, &s->kinds[w]);
            map_joints(k, &s->kinds[w], map);
            map_floats(k, &s->kinds[w], map + k->skeleton.joint_count);
        }
    }
}

int noh_stage_fits(const noh_stage *s, const noh_stage_kind *garment, const noh_stage_kind *wearer)
{
    const uint16_t *map = map_of(s, garment, wearer);
    for (uint32_t j = 0; j < garment->skeleton.joint_count; j++) {
        if (map[j] != NOH_JOINT_ROOT) return 1;
    }
    return 0;
}

/* ---- what it hides ---- */

const noh_pack_cover_header *noh_stage_cover_of(const noh_pack *garment, const noh_mesh *mesh)
{
    const noh_mesh_header *h = mesh->header;
    size_t count = 0;
    for (uint32_t k = h->level; k < h->level_count; k++) count += h[k - h->level].index_count;
    for (uint32_t i = 0; i < garment->runs[NOH_CHUNK_COVER].count; i++) {
        const noh_pack_cover_header *c = noh_pack_chunk_at(garment, NOH_CHUNK_COVER, i);
        if (c->mesh_hash == noh_hash_name(mesh->name) && c->triangle_count == count / 3u &&
            c->indices_crc == noh_crc32c(0, mesh->indices, count * h->index_bytes))
            return c;
    }
    return NULL;
}

/* ---- a frame ---- */

noh_stage_actor *noh_stage_wearer_of(const noh_stage *s, const noh_stage_actor *a, noh_stage_kind **kind)
{
    return a->joint == NOH_STAGE_WORN ? noh_stage_parent_of(s, a, kind) : NULL;
}

static noh_character *character_at(const noh_stage *s, uint32_t index)
{
    const noh_stage_kind *k = noh_stage_kind_of(s, index);
    return noh_stage_character(k, index - k->first_actor);
}

/* A garment that was not posed with its wearer last time is posed with it in this frame. */
static void link(noh_stage *s, uint32_t index, uint32_t wearer)
{
    noh_stage_shown *shown = &s->shown[index], *on = &s->shown[wearer];
    const noh_character *ch = character_at(s, index), *of = character_at(s, wearer);
    const int fresh = !ch->time.posed || !of->time.posed || ch->updates != of->updates;
    shown->next_worn = on->worn;
    on->worn = (uint16_t)(index + 1u);
    shown->due = fresh ? NOH_DUE_AT_ONCE : NOH_DUE_NOT;
    if (fresh && on->due < NOH_DUE_AT_ONCE) on->due = NOH_STAGE_DUE_LONG;
}

void noh_stage_link_worn(noh_stage *s)
{
    for (uint32_t i = 0; s->wearer_joints && i < s->actor_count; i++) s->shown[i].worn = 0;
    for (uint32_t i = s->wearer_joints ? s->actor_count : 0; i-- > 0;) {
        const noh_stage_actor *a = &s->actors[i];
        const noh_stage_actor *wearer = a->alive ? noh_stage_wearer_of(s, a, NULL) : NULL;
        if (wearer && (s->shown[i].views || a->look.posed)) link(s, i, (uint32_t)(wearer - s->actors));
    }
}

void noh_stage_update_worn(noh_stage *s)
{
    for (uint32_t i = 0; s->wearer_joints && i < s->actor_count; i++) {
        for (uint32_t g = s->shown[i].worn; g; g = s->shown[g - 1u].next_worn) {
            s->shown[g - 1u].updates = s->shown[i].updates;
            if (s->shown[g - 1u].due == NOH_DUE_NOT) s->shown[g - 1u].due = s->shown[i].due;
        }
    }
}

uint32_t noh_stage_garments_on(const noh_stage *s, uint32_t index)
{
    uint32_t garments = 0;
    for (uint32_t g = s->shown[index].worn; g; g = s->shown[g - 1u].next_worn) {
        const noh_stage_kind *k = noh_stage_kind_of(s, g - 1u);
        if (s->shown[g - 1u].views && !k->finer.hidden && k->desc->mesh->runs[NOH_CHUNK_COVER].count)
            garments |= 1u << (uint32_t)(k - s->kinds);
    }
    return garments;
}

/* ---- a pose ---- */

/* b within a, without shear. */
static void compose(const noh_transform *a, const noh_transform *b, noh_transform *out)
{
    noh_transform t;
    for (int i = 0; i < 3; i++)
        t.translation[i] = a->scale[i] * b->translation[i], t.scale[i] = a->scale[i] * b->scale[i];
    noh_quat_rotate(a->rotation, t.translation, t.translation);
    for (int i = 0; i < 3; i++) t.translation[i] += a->translation[i];
    noh_quat_mul(a->rotation, b->rotation, t.rotation);
    *out = t;
}

/* What composed with `a` is `b`. */
static void take_out(const noh_transform *a, noh_transform *b)
{
    float back[4], at[3];
    noh_quat_conjugate(a->rotation, back);
    for (int i = 0; i < 3; i++) at[i] = b->translation[i] - a->translation[i];
    noh_quat_rotate(back, at, at);
    noh_quat_mul(back, b->rotation, b->rotation);
    for (int i = 0; i < 3; i++) {
        const float scale = a->scale[i] == 0.0f ? 1.0f : a->scale[i];
        b->translation[i] = at[i] / scale;
        b->scale[i] /= scale;
    }
}

void noh_stage_wear_pose(const noh_stage *s, const noh_stage_job_part *job, const noh_stage_kind *k, uint32_t index,
                         noh_transform *local)
{
    noh_stage_kind *wearer = NULL;
    const noh_transform *on = job->wearer;
    const uint16_t *map, *parents;
    if (!noh_stage_wearer_of(s, &k->actors[index], &wearer)) return;
    map = map_of(s, k, wearer);
    parents = wearer->skeleton.parents;
    for (uint32_t j = 0; j < k->skeleton.joint_count; j++) {
        const uint32_t above = map[j] == NOH_JOINT_ROOT ? NOH_JOINT_ROOT : following_above(k, map, j);
        const uint32_t end = above == NOH_JOINT_ROOT ? NOH_JOINT_ROOT : map[above];
        uint32_t up = k->skeleton.parents[j];
        noh_transform between;
        if (map[j] == NOH_JOINT_ROOT) continue;
        local[j] = on[map[j]];
        for (uint32_t p = parents[map[j]]; p != end; p = parents[p]) compose(&on[p], &local[j], &local[j]);
        if (up == above) continue;
        between = local[up]; /* of joints that do not follow */
        while ((up = k->skeleton.parents[up]) != above) compose(&local[up], &between, &between);
        take_out(&between, &local[j]);
    }
}

void noh_stage_wear_palette(const noh_stage *s, const noh_stage_kind *k, uint32_t index)
{
    noh_stage_kind *wearer = NULL;
    const noh_stage_actor *on = noh_stage_wearer_of(s, &k->actors[index], &wearer);
    if (!on) return;
    noh_character_follow(noh_stage_character(k, index), noh_stage_character(wearer, noh_stage_index(wearer, on)),
                         map_of(s, k, wearer), s->shown[k->first_actor + index].due == NOH_DUE_AT_ONCE);
}

static int is_held(const noh_stage_kind *k, uint32_t index, uint32_t name_hash)
{
    const noh_stage_held *held = k->held + (size_t)index * k->desc->held_float_count;
    for (uint32_t h = 0; h < k->desc->held_float_count; h++) {
        if (held[h].amount > 0.0f && k->named.name_hashes[held[h].index] == name_hash) return 1;
    }
    return 0;
}

void noh_stage_wear_floats(const noh_stage *s, const noh_stage_kind *k, uint32_t index)
{
    noh_stage_kind *wearer = NULL;
    const noh_stage_actor *on = noh_stage_wearer_of(s, &k->actors[index], &wearer);
    float *floats = k->floats + (size_t)index * k->float_count;
    const float *from;
    const uint16_t *map;
    if (!on) return;
    from = wearer->floats + (size_t)noh_stage_index(wearer, on) * wearer->float_count;
    map = map_of(s, k, wearer) + k->skeleton.joint_count;
    for (uint32_t f = 0; f < k->float_count; f++) {
        if (map[f] != NOH_JOINT_ROOT && !is_held(k, index, k->named.name_hashes[f])) floats[f] = from[map[f]];
    }
}
