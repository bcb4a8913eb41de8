/* identity.c: groups and bounds identity targets, and draws people from them. */
#include "life/face/identity_internal.h"
#include "noh/base.h"
#include "noh/face.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"
#include "core/base/name_internal.h"
#include "life/face/face_internal.h"

/* ---- memory ---- */

static size_t carve(noh_arena *arena, const noh_mesh *mesh, noh_identity_scratch *s)
{
    const uint32_t targets = mesh->header->target_count, vertices = mesh->header->vertex_count;
    const size_t floats = ((size_t)mesh->header->morph_height << mesh->header->morph_width_log2) * 3u;
    memset(s, 0, sizeof *s);
    s->mesh = mesh;
    s->names = (const char **)noh_arena_carve(arena, targets * sizeof *s->names, 16u);
    s->field.position = (float *)noh_arena_carve(arena, floats * sizeof(float), 16u);
    s->other.position = (float *)noh_arena_carve(arena, floats * sizeof(float), 16u);
    s->moments = (noh_identity_moments *)noh_arena_carve(arena, targets * sizeof *s->moments, 4u);
    s->variance = (float *)noh_arena_carve(arena, vertices * sizeof *s->variance, 4u);
    s->strain = (float *)noh_arena_carve(arena, vertices * sizeof *s->strain, 4u);
    s->partner = (uint32_t *)noh_arena_carve(arena, vertices * sizeof *s->partner, 4u);
    s->next = (uint32_t *)noh_arena_carve(arena, vertices * sizeof *s->next, 4u);
    s->facing = (uint32_t *)noh_arena_carve(arena, vertices * sizeof *s->facing, 4u);
    return arena->used;
}

size_t noh_identity_size(const noh_mesh *mesh)
{
    NOH_ASSERT(mesh && mesh->header);
    return mesh->header->target_count * sizeof(noh_identity_target);
}

size_t noh_identity_scratch_size(const noh_mesh *mesh)
{
    noh_arena arena = noh_arena_measure();
    noh_identity_scratch s;
    NOH_ASSERT(mesh && mesh->header);
    return carve(&arena, mesh, &s);
}

static void open_scratch(noh_identity_scratch *s, noh_arena *arena, const noh_mesh *mesh)
{
    const noh_mesh_header *h = mesh->header;
    float diagonal[3];
    (void)carve(arena, mesh, s);
    for (int c = 0; c < 3; c++) diagonal[c] = h->bounds_max[c] - h->bounds_min[c];
    s->size = noh_sqrt(noh_dot3(diagonal, diagonal));
    if (!(s->size > 0.0f)) s->size = 1.0f; /* all vertices in one point: nothing can be stretched */
    s->middle = 0.5f * (h->bounds_min[0] + h->bounds_max[0]);
    for (uint32_t t = 0; t < h->target_count; t++) s->names[t] = noh_pack_string(mesh->pack, mesh->targets[t].name);
}

/* ---- identity targets ---- */

static int any_recipe_names(const noh_identity_desc *desc, const char *name)
{
    const noh_face_recipe *const built_in[3] = { &noh_face_recipe_arkit, &noh_face_recipe_vrm, &noh_face_recipe_units };
    const noh_face_recipe *const *recipes = desc->recipes ? desc->recipes : built_in;
    const uint32_t count = desc->recipes ? desc->recipe_count : 3u;
    for (uint32_t r = 0; r < count; r++) {
        for (uint32_t i = 0; i < recipes[r]->row_count; i++) {
            if (noh_names_equal(recipes[r]->rows[i].target, name)) return 1;
        }
    }
    return 0;
}

static uint32_t mark_used(const noh_identity_scratch *s, const noh_identity_desc *desc, noh_identity_target *targets)
{
    const uint32_t count = s->mesh->header->target_count;
    uint32_t marked = 0, used = 0;
    for (uint32_t t = 0; t < count; t++) marked += (s->mesh->targets[t].flags & NOH_TARGET_IDENTITY) != 0;
    for (uint32_t t = 0; t < count; t++) {
        noh_identity_target *to = &targets[t];
        memset(to, 0, sizeof *to);
        to->opposite = to->mirror = to->leader = NOH_IDENTITY_NONE;
        to->used = desc->is_identity ? desc->is_identity[t] != 0
                   : marked          ? (s->mesh->targets[t].flags & NOH_TARGET_IDENTITY) != 0
                                     : !any_recipe_names(desc, s->names[t]);
        used += to->used;
    }
    return used;
}

static void measure_moments(noh_identity_scratch *s, const noh_identity_target *targets)
{
    for (uint32_t t = 0; t < s->mesh->header->target_count; t++) {
        memset(&s->moments[t], 0, sizeof s->moments[t]);
        if (!targets[t].used) continue;
        noh_identity_field(s, t, &s->field);
        s->moments[t] = noh_identity_moments_of(s);
    }
}

/* ---- opposite and mirrored targets ---- */

#define OPPOSED (-0.2f) /* cosine; unrelated targets have about 0 */

/* The target most opposed to this one among those whose names differ in one word. */
static uint32_t most_opposed(noh_identity_scratch *s, const noh_identity_target *targets, uint32_t target)
{
    float least = OPPOSED;
    uint32_t found = NOH_IDENTITY_NONE;
    noh_identity_field(s, target, &s->field);
    for (uint32_t u = 0; u < s->mesh->header->target_count; u++) {
        float cosine;
        if (u == target || !targets[u].used || !noh_identity_one_word_apart(s->names[target], s->names[u])) continue;
        noh_identity_field(s, u, &s->other);
        cosine = noh_identity_cosine(s, 0);
        if (cosine < least) {
            least = cosine;
            found = u;
        }
    }
    return found;
}

/* Two targets are opposite if each is most opposed to the other. */
static void find_opposites(noh_identity_scratch *s, noh_identity_target *targets)
{
    const uint32_t count = s->mesh->header->target_count;
    for (uint32_t t = 0; t < count; t++) {
        if (targets[t].used) targets[t].opposite = (uint16_t)most_opposed(s, targets, t);
    }
    for (uint32_t t = 0; t < count; t++) {
        const uint32_t u = targets[t].opposite;
        if (u != NOH_IDENTITY_NONE && u < t && targets[u].opposite != t) targets[t].opposite = NOH_IDENTITY_NONE;
    }
    for (uint32_t t = count; t-- > 0;) {
        const uint32_t u = targets[t].opposite;
        if (u != NOH_IDENTITY_NONE && targets[u].opposite != t) targets[t].opposite = NOH_IDENTITY_NONE;
        targets[t].negative = targets[t].opposite < t;
    }
}

static int near(float a, float b, float within)
{
    return a - b <= within && b - a <= within;
}

/* Off the middle, on opposite sides, with equal size of motion and mirrored direction. */
static int are_mirrored(const noh_identity_scratch *s, uint32_t a, uint32_t b)
{
    const noh_identity_moments *m = &s->moments[a], *n = &s->moments[b];
    const float off = m->centre[0] - s->middle, other = n->centre[0] - s->middle, within = 0.02f * s->size;
    const float length = 0.15f * (m->length + n->length);
    return (off > within || off < -within) && near(off, -other, within) && near(m->centre[1], n->centre[1], within) &&
           near(m->centre[2], n->centre[2], within) && near(m->length, n->length, length) &&
           near(m->sum[0], -n->sum[0], length) && near(m->sum[1], n->sum[1], length) &&
           near(m->sum[2], n->sum[2], length);
}

/* The first of two mirrored targets determines the negative direction. */
static void find_mirrors(noh_identity_scratch *s, noh_identity_target *targets)
{
    const uint32_t count = s->mesh->header->target_count;
    for (uint32_t t = 0; t < count; t++) {
        for (uint32_t u = t + 1u; u < count && targets[t].used && targets[t].mirror == NOH_IDENTITY_NONE; u++) {
            if (!targets[u].used || targets[u].mirror != NOH_IDENTITY_NONE || !are_mirrored(s, t, u) ||
                !noh_identity_one_word_apart(s->names[t], s->names[u])) {
                continue;
            }
            targets[t].mirror = (uint16_t)u;
            targets[u].mirror = (uint16_t)t;
            targets[u].negative = targets[t].negative;
        }
    }
}

/* ---- ranges ---- */

/* A shift of the whole mesh changes no shape; a sideways shift of a central part is an asymmetry. */
static float first_range(const noh_identity_scratch *s, const noh_identity_target *target, uint32_t index,
                         const noh_identity_desc *desc)
{
    const noh_identity_moments *m = &s->moments[index];
    const float sum = noh_dot3(m->sum, m->sum), range = desc->range > 0.0f ? desc->range : 0.6f;
    const float aside = m->sum[0] < 0.0f ? -m->sum[0] : m->sum[0];
    if (!target->used || m->length <= 0.0f) return 0.0f;
    if (m->moved * 2u > s->mesh->header->vertex_count && sum > 0.8f * (float)m->moved * m->square) {
        return 0.0f; /* all vertices move by nearly the same amount */
    }
    if (target->mirror == NOH_IDENTITY_NONE && near(m->centre[0], s->middle, 0.02f * s->size) &&
        aside > 0.4f * m->length) {
        return range * desc->asymmetry;
    }
    return range;
}

static void add_variance(noh_identity_scratch *s, const noh_identity_target *targets)
{
    memset(s->variance, 0, s->mesh->header->vertex_count * sizeof *s->variance);
    for (uint32_t t = 0; t < s->mesh->header->target_count; t++) {
        const float square = 0.5f * targets[t].range * targets[t].range; /* half of all people use it */
        if (square <= 0.0f) continue;
        noh_identity_field(s, t, &s->field);
        noh_identity_strain(s);
        for (uint32_t v = 0; v < s->mesh->header->vertex_count; v++) {
            s->variance[v] += square * s->strain[v] * s->strain[v];
        }
    }
}

/* The share of a target's range that keeps every place within the stretch bound. */
static float share_left(noh_identity_scratch *s, uint32_t target, float bound)
{
    float all = 0.0f, left = 0.0f;
    noh_identity_field(s, target, &s->field);
    noh_identity_strain(s);
    for (uint32_t v = 0; v < s->mesh->header->vertex_count; v++) {
        const float square = s->strain[v] * s->strain[v], most = bound * bound;
        all += square;
        left += s->variance[v] > most ? square * most / s->variance[v] : square;
    }
    return all > 0.0f ? noh_sqrt(left / all) : 0.0f;
}

/* Targets that stretch the same place reduce each other; the ranges converge in a few rounds. */
static void bound_ranges(noh_identity_scratch *s, noh_identity_target *targets, const noh_identity_desc *desc)
{
    const float bound = desc->strain > 0.0f ? desc->strain : 0.18f;
    for (uint32_t t = 0; t < s->mesh->header->target_count; t++) {
        targets[t].range = first_range(s, &targets[t], t, desc);
    }
    for (int round = 0; round < 3; round++) {
        add_variance(s, targets);
        for (uint32_t t = 0; t < s->mesh->header->target_count; t++) {
            if (targets[t].range > 0.0f) targets[t].range *= share_left(s, t, bound);
        }
    }
}

/* ---- correlations ---- */

/* A leader moves much of the face; the correlation of a target is measured only where that target moves vertices. */
static void follow(noh_identity_scratch *s, noh_identity_target *targets, uint32_t leader)
{
    noh_identity_field(s, leader, &s->other);
    for (uint32_t t = 0; t < s->mesh->header->target_count; t++) {
        float cosine, best = targets[t].along < 0.0f ? -targets[t].along : targets[t].along;
        if (targets[t].range <= 0.0f || noh_identity_name_leads(s->names[t])) continue;
        noh_identity_field(s, t, &s->field);
        cosine = noh_identity_cosine(s, 1);
        if (cosine > best || -cosine > best) {
            targets[t].leader = (uint16_t)leader;
            targets[t].along = cosine;
        }
    }
}

static void find_leaders(noh_identity_scratch *s, noh_identity_target *targets)
{
    for (uint32_t t = 0; t < s->mesh->header->target_count; t++) {
        if (targets[t].range > 0.0f && !targets[t].negative && noh_identity_name_leads(s->names[t])) {
            follow(s, targets, t);
        }
    }
    /* a target, its opposite and its mirror follow together */
    for (uint32_t t = 0; t < s->mesh->header->target_count; t++) {
        const uint32_t first = targets[t].mirror < t ? targets[t].mirror : t;
        if (first != t) {
            targets[t].leader = targets[first].leader;
            targets[t].along = targets[first].along;
        }
    }
}

/* ---- init ---- */

static void find_closings(noh_identity_scratch *s, const noh_identity_desc *desc, noh_identity_target *targets,
                          noh_identity *identity)
{
    noh_face_link links[128];
    uint32_t count = noh_face_recipe_bind(desc->recipes, desc->recipe_count, s->names, s->mesh->header->target_count,
                                          links, 128u);
    count = count < 128u ? count : 128u;
    for (uint32_t i = 0; i < count && identity->closing_count < NOH_IDENTITY_CLOSINGS; i++) {
        const uint32_t index = identity->closing_count;
        if (links[i].channel > NOH_CHANNEL_BLINK_RIGHT || targets[links[i].target].used) continue;
        identity->closings[index] = links[i].target;
        identity->closing_count += noh_identity_closing(s, targets, links[i].target, index) > 0u;
    }
}

static noh_result check(const noh_identity_desc *desc, noh_error *error)
{
    const float values[3] = { desc->range, desc->strain, desc->asymmetry };
    for (uint32_t i = 0; i < 3u; i++) {
        if (!(values[i] >= 0.0f && values[i] <= 1.0f)) {
            return noh_fail(error, NOH_ERR_ARG, "range, strain and asymmetry of an identity desc must be 0 to 1", i, 0);
        }
    }
    return NOH_OK;
}

static noh_result open_all(void *memory, size_t bytes, void *scratch, size_t scratch_bytes, const noh_mesh *mesh,
                           noh_identity_scratch *s, noh_error *error)
{
    noh_arena arena, working;
    noh_result result = noh_arena_open(&arena, memory, bytes, noh_identity_size(mesh), error);
    if (!result) {
        result = noh_arena_open(&working, scratch, scratch_bytes, noh_identity_scratch_size(mesh), error);
    }
    if (!result) open_scratch(s, &working, mesh);
    return result;
}

noh_result noh_identity_init(void *memory, size_t bytes, void *scratch, size_t scratch_bytes, const noh_mesh *mesh,
                             const noh_identity_desc *desc, noh_identity *identity, noh_error *error)
{
    noh_identity_desc settings = { NULL, NULL, 0, 0.0f, 0.0f, 0.0f };
    noh_identity_target *targets = (noh_identity_target *)memory;
    noh_identity_scratch s;
    noh_identity made;
    noh_result result;
    NOH_ASSERT(mesh && identity);
    if (desc) settings = *desc;
    result = check(&settings, error);
    settings.asymmetry = settings.asymmetry > 0.0f ? settings.asymmetry : 0.12f;
    if (!result) result = open_all(memory, bytes, scratch, scratch_bytes, mesh, &s, error);
    if (result) return result;
    memset(&made, 0, sizeof made);
    made.targets = targets;
    made.target_count = mesh->header->target_count;
    made.asymmetry = settings.asymmetry;
    made.used_count = mark_used(&s, &settings, targets);
    if (!made.used_count) return noh_fail(error, NOH_ERR_ARG, "the mesh has no identity target", 0, 1);
    measure_moments(&s, targets);
    find_opposites(&s, targets);
    find_mirrors(&s, targets);
    noh_identity_facing(&s);
    bound_ranges(&s, targets, &settings);
    find_leaders(&s, targets);
    find_closings(&s, &settings, targets, &made);
    *identity = made;
    return NOH_OK;
}

/* ---- people ---- */

#define STREAM_COMMON 101u /* separate from the streams of face_internal.h */
#define STREAM_SIDE 102u
#define MOST 2.0f /* standard deviations: one in twenty draws is beyond */

/* A normal number, drawn again if it is too large. */
static float draw(uint32_t seed, uint32_t stream, uint32_t index)
{
    float value = MOST + 1.0f;
    for (uint32_t i = 0; i < 8u && (value > MOST || value < -MOST); i++) {
        value = noh_face_normal(noh_face_uniform(seed, stream + 16u * i, index));
    }
    return value > MOST ? MOST : value < -MOST ? -MOST : value;
}

/* The target that represents a group: the first of a target, its mirror and the opposites of both. */
static uint32_t first_of(const noh_identity *identity, uint32_t target)
{
    uint32_t first = target;
    const uint32_t around[3] = { identity->targets[target].opposite, identity->targets[target].mirror,
                                 identity->targets[target].mirror == NOH_IDENTITY_NONE
                                     ? NOH_IDENTITY_NONE
                                     : identity->targets[identity->targets[target].mirror].opposite };
    for (int i = 0; i < 3; i++) first = around[i] < first ? around[i] : first;
    return first;
}

/* Standard deviations for a target's group, before its sides differ. */
static float draw_group(const noh_identity *identity, uint32_t seed, uint32_t first)
{
    const noh_identity_target *target = &identity->targets[first];
    const float own = draw(seed, STREAM_COMMON, first), along = target->along;
    if (target->leader == NOH_IDENTITY_NONE) return own;
    return along * draw(seed, STREAM_COMMON, first_of(identity, target->leader)) +
           noh_sqrt(1.0f - along * along > 0.0f ? 1.0f - along * along : 0.0f) * own;
}

void noh_identity_random(const noh_identity *identity, uint32_t seed, float amount, float *weights)
{
    NOH_ASSERT(identity && weights && amount >= 0.0f);
    for (uint32_t t = 0; t < identity->target_count; t++) {
        const noh_identity_target *target = &identity->targets[t];
        const uint32_t pair = target->opposite < t ? target->opposite : t;
        float value;
        if (!target->used) continue;
        value = draw_group(identity, seed, first_of(identity, t));
        if (target->mirror != NOH_IDENTITY_NONE) value += identity->asymmetry * draw(seed, STREAM_SIDE, pair);
        value = (target->negative ? -value : value) * target->range * amount;
        /* targets without an opposite are used rarely: a face is not square and oval at the same time */
        if (target->opposite == NOH_IDENTITY_NONE) value -= target->range * amount;
        weights[t] = value > 1.0f ? 1.0f : value > 0.0f ? value : 0.0f;
    }
}

float noh_identity_shut(const noh_identity *identity, const float *weights, uint32_t i)
{
    float shut = 1.0f;
    NOH_ASSERT(identity && weights && i < identity->closing_count);
    for (uint32_t t = 0; t < identity->target_count; t++) {
        if (identity->targets[t].used) shut += identity->targets[t].closing[i] * weights[t];
    }
    return shut < 0.5f ? 0.5f : shut > 2.0f ? 2.0f : shut;
}

void noh_identity_bind(const noh_identity *identity, const float *weights, noh_face_link *links, uint32_t link_count)
{
    float shut[NOH_IDENTITY_CLOSINGS];
    NOH_ASSERT(identity && weights && (links || !link_count));
    for (uint32_t i = 0; i < identity->closing_count; i++) shut[i] = noh_identity_shut(identity, weights, i);
    for (uint32_t l = 0; l < link_count; l++) {
        for (uint32_t i = 0; i < identity->closing_count; i++) {
            const int blinks = links[l].channel <= NOH_CHANNEL_BLINK_RIGHT;
            if (blinks && links[l].target == identity->closings[i]) links[l].weight *= shut[i];
        }
    }
}
