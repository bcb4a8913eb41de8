#include "core/base/assert_internal.h"
#include "stage/character/lod_internal.h"
#include "noh/base.h"
#include "noh/low_core.h"
#include "noh/low_stage.h"
#include "noh/noh.h"

#include "motion/anim/clock_internal.h"
#include "core/base/math_internal.h"
#include "core/base/trig_internal.h"

#define NEAREST_M 1e-3f

/* ---- settings ---- */

static const float default_shares[NOH_LOD_KIND_COUNT] = { 0.3f, 0.1f, 0.05f, 0.1f, 0.45f };

static int has_shares(const noh_lod_settings *s)
{
    int any = 0;
    for (int i = 0; i < NOH_LOD_KIND_COUNT; i++) {
        any |= s->shares[i] != 0.0f;
    }
    return any;
}

static double share_of(const noh_lod_settings *s, noh_lod_kind kind)
{
    return (double)(has_shares(s) ? s->shares : default_shares)[kind];
}

static double hysteresis_of(const noh_lod_settings *s)
{
    return s->hysteresis > 0.0f ? (double)s->hysteresis : 0.3;
}

static double lead_of(const noh_lod_settings *s)
{
    return s->lead > 0.0f ? (double)s->lead : 0.5 * hysteresis_of(s);
}

noh_result noh_lod_settings_check(const noh_lod_settings *s, noh_error *error)
{
    double sum = 0.0;
    NOH_ASSERT(s);
    if (!(s->pixels >= 0.0f && s->pixels <= NOH_PIXELS_MAX))
        return noh_fail(error, NOH_ERR_ARG, "pixels must be 0 to 1e6", 0, 0);
    for (uint32_t i = 0; i < NOH_LOD_KIND_COUNT; i++) {
        if (!(s->shares[i] >= 0.0f && s->shares[i] <= 1.0f))
            return noh_fail(error, NOH_ERR_ARG, "shares must each be 0 to 1", i, 0);
        sum += (double)s->shares[i];
    }
    if (sum > 1.0 + 1e-6) return noh_fail(error, NOH_ERR_ARG, "shares must sum to at most 1", 0, 0);
    if (!(s->hysteresis >= 0.0f && s->hysteresis < 1.0f))
        return noh_fail(error, NOH_ERR_ARG, "hysteresis must be at least 0 and below 1", 0, 0);
    if (!(s->lead >= 0.0f && lead_of(s) < hysteresis_of(s)))
        return noh_fail(error, NOH_ERR_ARG, "lead must be at least 0 and below hysteresis", 0, 0);
    return NOH_OK;
}

/* ---- the table ---- */

/* The errors of one kind's levels. */
typedef struct errors {
    float error_m[NOH_LOD_LEVELS_MAX];
    uint32_t count;
    uint32_t first; /* the finest selectable level */
} errors;

static errors errors_of(const noh_lod_table *t, noh_lod_kind kind)
{
    errors e = { { 0.0f }, 0, 0 };
    e.first = kind == NOH_LOD_MESH ? t->mesh_level_first : 0;
    e.count = kind == NOH_LOD_MESH     ? t->mesh_level_count
              : kind == NOH_LOD_JOINTS ? t->joint_level_count
                                       : t->influence_level_count;
    for (uint32_t i = 0; i < e.count; i++) {
        e.error_m[i] = kind == NOH_LOD_MESH     ? t->meshes[i].error_m
                       : kind == NOH_LOD_JOINTS ? t->joints[i].error_m
                                                : t->influences[i].error_m;
    }
    return e;
}

static int is_list(const void *levels, uint32_t count)
{
    return count <= NOH_LOD_LEVELS_MAX && (levels || !count);
}

static const char *bad_counts(const noh_lod_table *t)
{
    if (!is_list(t->meshes, t->mesh_level_count))
        return "meshes is NULL, or mesh_level_count is above NOH_LOD_LEVELS_MAX";
    if (t->mesh_level_first && t->mesh_level_first >= t->mesh_level_count)
        return "mesh_level_first must be below mesh_level_count";
    if (!is_list(t->joints, t->joint_level_count))
        return "joints is NULL, or joint_level_count is above NOH_LOD_LEVELS_MAX";
    if (!is_list(t->influences, t->influence_level_count))
        return "influences is NULL, or influence_level_count is above NOH_LOD_LEVELS_MAX";
    return NULL;
}

static const char *bad_level(const noh_lod_table *t, noh_lod_kind kind, uint32_t level)
{
    static const char *const what[] = {
        "error of a mesh level is negative, not finite, or below a finer level's",
        "error of a joint level is negative, not finite, or below a finer level's",
        "error of an influence level is negative, not finite, or below a finer level's"
    };
    const errors e = errors_of(t, kind);
    if (!(e.error_m[level] >= (level ? e.error_m[level - 1u] : 0.0f) && e.error_m[level] <= 1e30f)) return what[kind];
    if (kind == NOH_LOD_JOINTS && t->joints[level].joint_count == 0) return "joint_count of a joint level is 0";
    if (kind == NOH_LOD_INFLUENCES && t->influences[level].influence_count == 0) {
        return "influence_count of an influence level is 0";
    }
    return NULL;
}

noh_result noh_lod_table_check(const noh_lod_table *t, noh_error *error)
{
    const char *what;
    NOH_ASSERT(t);
    what = bad_counts(t);
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, 0, 0);
    }
    for (int kind = 0; kind <= NOH_LOD_INFLUENCES; kind++) {
        const uint32_t count = errors_of(t, (noh_lod_kind)kind).count;
        for (uint32_t i = 0; i < count; i++) {
            what = bad_level(t, (noh_lod_kind)kind, i);
            if (what) return noh_fail(error, NOH_ERR_DATA, what, i, 0);
        }
    }
    if (!(t->clip_error_m >= 0.0f && t->clip_error_m <= 1e30f)) {
        return noh_fail(error, NOH_ERR_DATA, "clip_error_m is negative or not finite", 0, 0);
    }
    return NOH_OK;
}

/* ---- choosing ---- */

float noh_lod_scale(float distance_m, float field_of_view_rad, uint32_t viewport_height)
{
    float sine, cosine, distance = distance_m > NEAREST_M ? distance_m : NEAREST_M;
    NOH_ASSERT(field_of_view_rad > 0.0f && field_of_view_rad < 3.1415927f);
    noh_sin_cos(0.5f * field_of_view_rad, &sine, &cosine);
    return (float)viewport_height * cosine / (2.0f * distance * sine);
}

/* The quality setting in metres, at a scale. */
static double quality_metres(const noh_lod_settings *s, float pixels_per_metre)
{
    double pixels = s->pixels > 0.0f ? (double)s->pixels : 1.0;
    return pixels_per_metre > 0.0f ? pixels / (double)pixels_per_metre : 1e300;
}

/* The thresholds of one kind, in metres: a level is left when its error is above `refine`, and entered when its error
 * is at most `coarsen`. Mesh levels are left early, by the lead, because the error keeps growing while they fade. */
typedef struct limits {
    double refine, coarsen;
} limits;

static limits limits_of(const noh_lod_settings *s, noh_lod_kind kind, double quality_m)
{
    limits l;
    double share_m = quality_m * share_of(s, kind);
    l.refine = share_m * (kind == NOH_LOD_MESH ? 1.0 - lead_of(s) : 1.0);
    l.coarsen = share_m * (1.0 - hysteresis_of(s));
    return l;
}

/* One step of the hysteresis: go to finer levels while the error is above `refine`, then to coarser levels while their
 * error is at most `coarsen`. Errors rise with the level and coarsen < refine, so the second loop never returns to a
 * level that the first loop left, and an error that varies between the two thresholds changes nothing. */
static uint8_t choose_level(const errors *e, uint32_t level, limits l)
{
    level = level < e->count ? level : e->count ? e->count - 1u : 0;
    level = level < e->first ? e->first : level;
    while (level > e->first && (double)e->error_m[level] > l.refine) {
        level--;
    }
    while (level + 1u < e->count && (double)e->error_m[level + 1u] <= l.coarsen) {
        level++;
    }
    return (uint8_t)level;
}

/* The mesh level changes only after the previous fade. It becomes the level within the share, or the limit if no finer
 * level has memory. */
static void choose_mesh(noh_lod *d, const errors *e, const noh_lod_settings *s, limits l, int64_t clock)
{
    uint8_t next;
    if (d->fade_ticks && noh_clock_since(clock, d->fade_start) < (int64_t)d->fade_ticks) {
        return;
    }
    d->fade_ticks = 0;
    d->mesh_before = d->mesh;
    next = d->mesh_wanted = choose_level(e, d->mesh, l);
    if (next < d->mesh_limit) {
        next = d->mesh_limit < e->count ? d->mesh_limit : (uint8_t)(e->count ? e->count - 1u : 0);
    }
    if (next != d->mesh) {
        d->mesh = next;
        d->fade_start = clock;
        d->fade_ticks = s->fade_ticks ? s->fade_ticks : 12000u;
    }
}

/* The errors of the update rates, in the form of level errors. Measured errors may decrease by chance from one rate to
 * a lower one; they are raised to be monotonic. The clips' own error is present at every rate and counts in the same
 * share. */
static errors rate_errors(const noh_lod_table *t, const float *update_error_m)
{
    errors e = { { 0.0f }, 1, 0 };
    e.error_m[0] = t->clip_error_m;
    for (uint32_t r = 1; update_error_m && r < NOH_UPDATE_RATE_COUNT; r++) {
        float error_m = update_error_m[r] + t->clip_error_m;
        e.error_m[r] = error_m > e.error_m[r - 1u] ? error_m : e.error_m[r - 1u];
        e.count = r + 1u;
    }
    return e;
}

/* Restart from the finest levels. */
static void forget_levels(noh_lod *d)
{
    d->fade_ticks = 0;
    d->mesh = d->mesh_before = d->joints = d->influences = d->update_rate = 0;
}

void noh_lod_choose(noh_lod *d, const noh_lod_table *t, const noh_lod_settings *s, float pixels_per_metre,
                    const float *update_error_m, int64_t clock)
{
    NOH_ASSERT(d && t && s && pixels_per_metre >= 0.0f);
    double quality_m = quality_metres(s, pixels_per_metre);
    errors mesh = errors_of(t, NOH_LOD_MESH), joints = errors_of(t, NOH_LOD_JOINTS);
    errors influences = errors_of(t, NOH_LOD_INFLUENCES), rates = rate_errors(t, update_error_m);
    float coarser;
    NOH_VALIDATE(noh_lod_table_check(t, NULL) == NOH_OK);
    NOH_VALIDATE(noh_lod_settings_check(s, NULL) == NOH_OK);
    if (!d->started) {
        forget_levels(d);
    }
    d->pixels_per_metre = pixels_per_metre;
    d->mesh = d->mesh < mesh.first ? (uint8_t)mesh.first : d->mesh;
    d->mesh_before = d->mesh_before < mesh.first ? (uint8_t)mesh.first : d->mesh_before;
    choose_mesh(d, &mesh, s, limits_of(s, NOH_LOD_MESH, quality_m), clock);
    d->joints = choose_level(&joints, d->joints, limits_of(s, NOH_LOD_JOINTS, quality_m));
    d->influences = choose_level(&influences, d->influences, limits_of(s, NOH_LOD_INFLUENCES, quality_m));
    d->update_rate = choose_level(&rates, d->update_rate, limits_of(s, NOH_LOD_UPDATES, quality_m));
    if (!d->started) {
        d->started = 1;
        d->fade_ticks = 0;
        d->mesh_before = d->mesh;
    }
    coarser = mesh.error_m[d->mesh > d->mesh_before ? d->mesh : d->mesh_before];
    d->error_m = coarser + joints.error_m[d->joints] + influences.error_m[d->influences] +
                 rates.error_m[d->update_rate];
}

void noh_lod_set_limit(noh_lod *d, uint32_t level)
{
    NOH_ASSERT(d);
    d->mesh_limit = (uint8_t)(level < NOH_LOD_LEVELS_MAX ? level : NOH_LOD_LEVELS_MAX - 1u);
}

uint32_t noh_lod_finest(const noh_lod *d)
{
    NOH_ASSERT(d);
    uint8_t finest = d->mesh < d->mesh_before ? d->mesh : d->mesh_before;
    return d->mesh_wanted < finest ? d->mesh_wanted : finest;
}

void noh_lod_cut(noh_lod *d)
{
    NOH_ASSERT(d);
    d->started = 0;
    d->mesh_limit = d->mesh_wanted = 0;
    forget_levels(d);
}

void noh_lod_set_mesh(noh_lod *d, const noh_lod_table *t, uint32_t level, float pixels_per_metre)
{
    NOH_ASSERT(d && t);
    static const noh_lod none;
    const uint32_t last = t->mesh_level_count ? t->mesh_level_count - 1u : 0;
    const uint32_t first = t->mesh_level_first < last ? t->mesh_level_first : last;
    *d = none;
    d->mesh = d->mesh_before = (uint8_t)(level < first ? first : level < last ? level : last);
    d->error_m = t->mesh_level_count ? t->meshes[d->mesh].error_m : 0.0f;
    d->pixels_per_metre = pixels_per_metre;
}

float noh_lod_fade(const noh_lod *d, int64_t clock)
{
    NOH_ASSERT(d);
    int64_t since = noh_clock_since(clock, d->fade_start);
    float x;
    if (since >= (int64_t)d->fade_ticks) {
        return 1.0f;
    }
    x = since > 0 ? (float)since / (float)d->fade_ticks : 0.0f;
    return x * x * (3.0f - 2.0f * x);
}

float noh_lod_error_pixels(const noh_lod *d)
{
    NOH_ASSERT(d);
    return (d->error_m + d->skipped_m) * d->pixels_per_metre;
}

uint32_t noh_lod_joint_count(const noh_lod *d, const noh_lod_table *t)
{
    NOH_ASSERT(d && t && (!t->joint_level_count || d->joints < t->joint_level_count));
    return t->joint_level_count ? t->joints[d->joints].joint_count : 0;
}

uint32_t noh_lod_influence_count(const noh_lod *d, const noh_lod_table *t)
{
    NOH_ASSERT(d && t && (!t->influence_level_count || d->influences < t->influence_level_count));
    uint32_t used = t->influence_level_count ? t->influences[d->influences].influence_count : 0;
    uint32_t stored = t->mesh_level_count ? t->meshes[d->mesh].influence_count : 0;
    return used == 0 || (stored != 0 && stored < used) ? stored : used;
}

/* ---- targets ---- */

/* The error of dropping one target, metres. NaN compares above every limit, so such a target is kept. */
static float cost_of(const float *weights, const float *radius_m, uint32_t i)
{
    float product = weights[i] * radius_m[i];
    return product < 0.0f ? -product : product;
}

/* Floats of one sign have the order of their bits. */
static float float_of(uint32_t bits)
{
    union {
        uint32_t bits;
        float value;
    } u;
    u.bits = bits;
    return u.value;
}

static uint32_t bits_of(float value)
{
    union {
        uint32_t bits;
        float value;
    } u;
    u.value = value;
    return u.bits;
}

#define LARGEST_BITS 0x7f7fffffu /* the largest finite float */

/* The sum of the costs up to a limit, and the costs next to the limit on both sides. */
typedef struct cut {
    double sum;
    float below, above; /* the largest up to the limit; the smallest above it, infinity if there is none */
} cut;

static cut cut_at(const float *weights, const float *radius_m, uint32_t count, float limit)
{
    cut c = { 0.0, 0.0f, float_of(LARGEST_BITS + 1u) };
    for (uint32_t i = 0; i < count; i++) {
        float cost = cost_of(weights, radius_m, i);
        int fits = cost <= limit;
        c.sum += fits ? (double)cost : 0.0;
        c.below = fits && cost > c.below ? cost : c.below;
        c.above = cost > limit && cost < c.above ? cost : c.above;
    }
    return c;
}

/* Find the largest limit such that all costs up to it fit into the room together, and return its bits. This greedy
 * choice, the smallest costs first, gives the largest number of targets that fit. Sorting the costs would need memory;
 * instead this bisects over the limit. Floats that are not negative have the order of their bits, so at most 31
 * halvings separate any two, and each pass finds the nearest costs on both sides, which lets the search step from cost
 * to cost. Costs equal to the next float above the result do not all fit: noh_lod_targets takes these by index. The
 * search starts between room / (count + 1), which always fits, and the room itself. *sum: sum of the costs that fit. */
static uint32_t largest_limit(const float *weights, const float *radius_m, uint32_t count, double room, double *sum)
{
    const float most = room < (double)float_of(LARGEST_BITS) ? (float)room : float_of(LARGEST_BITS);
    uint32_t fits = bits_of(most / (float)(count + 1u)), over = LARGEST_BITS + 1u, middle = bits_of(most);
    *sum = -1.0;
    while (over - fits > 1u) {
        cut c = cut_at(weights, radius_m, count, float_of(middle));
        if (c.sum <= room) {
            *sum = c.sum;
            fits = bits_of(c.above) - 1u;
            over = middle == bits_of(most) ? fits + 1u : over; /* any other cost exceeds the room */
        } else {
            over = bits_of(c.below);
        }
        middle = fits + (over - fits) / 2u;
    }
    *sum = *sum < 0.0 ? cut_at(weights, radius_m, count, float_of(fits)).sum : *sum;
    return fits;
}

uint32_t noh_lod_targets(noh_lod *d, const noh_lod_settings *settings, const float *weights, const float *radius_m,
                         uint32_t count, float *kept)
{
    double room = quality_metres(settings, d->pixels_per_metre) * share_of(settings, NOH_LOD_TARGETS);
    double skipped;
    uint32_t bits = largest_limit(weights, radius_m, count, room, &skipped), left = 0;
    float limit = float_of(bits), next = float_of(bits + 1u);
    NOH_ASSERT(d && settings && (!count || (weights && radius_m && kept)));
    for (uint32_t i = 0; i < count; i++) {
        float cost = cost_of(weights, radius_m, i);
        int skip = cost <= limit;
        if (!skip && cost <= next && skipped + (double)cost <= room) { /* first by index among equal costs */
            skip = 1;
            skipped += (double)cost;
        }
        kept[i] = skip ? 0.0f : weights[i];
        left += kept[i] != 0.0f;
    }
    d->skipped_m = (float)skipped;
    return left;
}
