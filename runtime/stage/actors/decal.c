#include "core/base/assert_internal.h"
#include "stage/actors/decal_internal.h"
#include "noh/base.h"
#include "noh/low_core.h"
#include "noh/marks.h"
#include "noh/noh.h"
#include "noh/pack.h"

#include <string.h>

#include "core/base/math_internal.h"
#include "core/base/trig_internal.h"
#include "stage/cast/stage_internal.h"

#define MERGE 0.25f /* of a size: a decal replaces another one that close */
#define STEEP 0.98f /* square of y from which a normal is vertical */

/* ---- the ring ---- */

void noh_decals_init(noh_decals *decals, uint32_t capacity, uint32_t hold_ticks, uint32_t fade_ticks)
{
    NOH_ASSERT(decals && capacity <= NOH_DECALS_MAX);
    memset(decals, 0, sizeof *decals);
    for (uint32_t i = 0; i < NOH_DECALS_MAX; i++) decals->decals[i].mesh = NOH_NONE;
    decals->capacity = capacity ? capacity : NOH_DECALS_MAX;
    decals->hold_ticks = hold_ticks;
    decals->fade_ticks = fade_ticks;
}

static int is_unit(const float v[3])
{
    const float square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    return square > 0.99f && square < 1.01f;
}

static int is_within(const float *values, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (!(values[i] >= -NOH_NUMBER_MAX && values[i] <= NOH_NUMBER_MAX)) return 0;
    }
    return 1;
}

const char *noh_decals_check(const noh_decals *decals)
{
    if (!decals->capacity || decals->capacity > NOH_DECALS_MAX || decals->next >= decals->capacity) {
        return "a ring of decals has no room, too much of it, or its next place is outside";
    }
    for (uint32_t i = 0; i < NOH_DECALS_MAX; i++) {
        const noh_decal *d = &decals->decals[i];
        if (d->mesh == NOH_NONE) continue;
        if (!is_within(d->centre, 3) || !is_unit(d->normal) || !is_unit(d->right)) {
            return "a decal's place is not finite, or its directions are not unit";
        }
        if (!(d->size > 0.0f && d->size <= NOH_NUMBER_MAX && d->roughness >= 0.0f && d->roughness <= 1.0f)) {
            return "a decal's size or roughness is out of range";
        }
    }
    return NULL;
}

void noh_decals_step(noh_decals *decals, uint32_t ticks)
{
    NOH_ASSERT(decals);
    for (uint32_t i = 0; i < decals->capacity; i++) {
        noh_decal *d = &decals->decals[i];
        if (d->mesh == NOH_NONE) continue;
        d->age_ticks = ticks > UINT32_MAX - d->age_ticks ? UINT32_MAX : d->age_ticks + ticks;
        if (decals->hold_ticks && noh_decal_alpha(decals, i) <= 0.0f) d->mesh = NOH_NONE;
    }
}

float noh_decal_alpha(const noh_decals *decals, uint32_t index)
{
    NOH_ASSERT(index < decals->capacity);
    const noh_decal *d = &decals->decals[index];
    if (d->mesh == NOH_NONE) return 0.0f;
    if (!decals->hold_ticks || d->age_ticks <= decals->hold_ticks) return 1.0f;
    if (d->age_ticks - decals->hold_ticks >= decals->fade_ticks) return 0.0f;
    return 1.0f - (float)(d->age_ticks - decals->hold_ticks) / (float)decals->fade_ticks;
}

/* ---- striking ---- */

/* The normal of a triangle. Returns 0 if there is no such triangle, or it has no area. */
static int triangle_normal(const noh_mesh *mesh, uint32_t triangle, float normal[3])
{
    float a[3], b[3], square;
    const float *p[3];
    if (triangle >= mesh->header->index_count / 3u) return 0;
    for (uint32_t i = 0; i < 3; i++) p[i] = mesh->positions + 3u * (size_t)noh_mesh_index(mesh, 3u * triangle + i);
    for (int i = 0; i < 3; i++) a[i] = p[1][i] - p[0][i], b[i] = p[2][i] - p[0][i];
    for (int i = 0; i < 3; i++) normal[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    square = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
    if (!(square > 0.0f)) return 0;
    for (int i = 0; i < 3; i++) normal[i] /= noh_sqrt(square);
    return 1;
}

/* Set `right` so that up is nearest to +Y, or to -Z on horizontal surfaces; then roll. */
static void set_right(noh_decal *d, float roll)
{
    const float *n = d->normal;
    const float towards[3] = { 0.0f, n[1] * n[1] < STEEP ? 1.0f : 0.0f, n[1] * n[1] < STEEP ? 0.0f : -1.0f };
    float right[3], up[3], length = 0.0f, s, c;
    for (int i = 0; i < 3; i++)
        right[i] = towards[(i + 1) % 3] * n[(i + 2) % 3] - towards[(i + 2) % 3] * n[(i + 1) % 3];
    for (int i = 0; i < 3; i++) length += right[i] * right[i];
    length = noh_sqrt(length);
    for (int i = 0; i < 3; i++) right[i] /= length;
    for (int i = 0; i < 3; i++) up[i] = n[(i + 1) % 3] * right[(i + 2) % 3] - n[(i + 2) % 3] * right[(i + 1) % 3];
    noh_sin_cos(roll, &s, &c);
    for (int i = 0; i < 3; i++) d->right[i] = c * right[i] + s * up[i];
}

/* The entry for a new decal: a close one, or the oldest. */
static uint32_t place_of(noh_decals *decals, const noh_decal *mark)
{
    uint32_t at;
    for (uint32_t i = 0; i < decals->capacity; i++) {
        const noh_decal *d = &decals->decals[i];
        float square = 0.0f;
        if (d->mesh != mark->mesh || d->tile != mark->tile) continue;
        for (int k = 0; k < 3; k++) square += (d->centre[k] - mark->centre[k]) * (d->centre[k] - mark->centre[k]);
        if (square <= MERGE * MERGE * mark->size * mark->size) return i;
    }
    at = decals->next;
    decals->next = at + 1u < decals->capacity ? at + 1u : 0u;
    return at;
}

/* A mesh of the pack at the LOD level that was shown. Returns 0 if it was not shown. */
static int shown_mesh(const noh_stage *s, noh_actor actor, uint32_t pack_mesh, noh_mesh *out)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(s, actor, &k);
    const noh_stage_shown *shown = a ? &s->shown[a - s->actors] : NULL;
    if (!a || shown->frame != s->frame || !s->frame) return 0;
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        if (k->meshes[m].item.mesh != pack_mesh) continue;
        *out = noh_mesh_at_lod(&k->meshes[m].mesh, k->plan->levels[shown->level].mesh_levels[m]);
        return 1;
    }
    return 0;
}

noh_result noh_decals_strike(noh_decals *decals, const noh_stage *stage, const noh_stage_hit *hit,
                             const noh_decal_desc *desc, uint32_t *index, noh_error *error)
{
    noh_decal mark;
    noh_mesh mesh;
    uint32_t at;
    NOH_ASSERT(decals && stage && hit && desc);
    if (!(desc->size > 0.0f && desc->size <= NOH_NUMBER_MAX) || !(desc->roughness >= 0.0f && desc->roughness <= 1.0f) ||
        desc->roll_rad - desc->roll_rad != 0.0f) {
        return noh_fail(error, NOH_ERR_ARG, "decal: size, roughness or roll of the desc is out of range", 0, 0);
    }
    memset(&mark, 0, sizeof mark);
    if (!shown_mesh(stage, hit->actor, hit->mesh, &mesh) || !triangle_normal(&mesh, hit->triangle, mark.normal)) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        "decal: the hit actor is gone or was not shown in the last frame, or has no such triangle",
                        hit->triangle, 0);
    }
    mark.mesh = hit->mesh;
    mark.size = desc->size;
    mark.roughness = desc->roughness > 0.0f ? desc->roughness : 0.5f;
    mark.tile = desc->tile;
    memcpy(mark.centre, hit->bind_point, sizeof mark.centre);
    memcpy(mark.color, desc->color, sizeof mark.color);
    if (!(mark.color[0] | mark.color[1] | mark.color[2] | mark.color[3])) mark.color[3] = 255;
    set_right(&mark, desc->roll_rad);
    at = place_of(decals, &mark);
    decals->decals[at] = mark;
    if (index) *index = at;
    return NOH_OK;
}
