/* controller_pose.c: the pose and the root motion of a controller.
 *
 * A pose is made in four steps: the low group's tracks are blended, and cover the bind pose by noh_track_cover; the
 * high group's result covers the low one; additive tracks are added in index order; the remaining offset of an inertial
 * transition is added last, since it is the difference between two such results. A single track with full weight skips
 * the blend, which would not change it. */
#include "core/base/math_internal.h"
#include "core/base/assert_internal.h"
#include "motion/anim/controller_internal.h"
#include "motion/anim/controller_pose_internal.h"
#include "motion/anim/root_motion_internal.h"
#include "motion/anim/tracks_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

#include <string.h>

#include "motion/anim/clip_set_internal.h"
#include "motion/anim/clock_internal.h"
#include "motion/pose/inertial_internal.h"
#include "motion/pose/blend_internal.h"

/* ---- scratch ---- */

static float *carve_floats(noh_arena *arena, uint32_t count)
{
    return (float *)noh_arena_carve(arena, count * sizeof(float), 4);
}

static noh_transform *carve_pose(noh_arena *arena, uint32_t count)
{
    return (noh_transform *)noh_arena_carve(arena, count * sizeof(noh_transform), 4);
}

static void carve(noh_arena *arena, const noh_clip_set *set, int inertial, noh_pose_scratch *s)
{
    memset(s, 0, sizeof *s);
    s->blend.sum = carve_pose(arena, set->joint_count);
    s->sample = carve_pose(arena, set->joint_count);
    s->blend.weights = carve_floats(arena, set->joint_count);
    s->below = carve_floats(arena, set->joint_count);
    s->blend.float_sum = carve_floats(arena, set->float_count);
    s->blend.float_weights = carve_floats(arena, set->float_count);
    s->float_sample = carve_floats(arena, set->float_count);
    s->float_below = carve_floats(arena, set->float_count);
    for (int i = 0; inertial && i < 4; i++) {
        s->captured[i] = carve_pose(arena, set->joint_count);
        s->float_captured[i] = carve_floats(arena, set->float_count);
    }
}

size_t noh_pose_scratch_size(const noh_clip_set *set, int inertial)
{
    noh_arena arena = noh_arena_measure();
    noh_pose_scratch s;
    NOH_ASSERT(set);
    if (noh_clip_set_excess(set)) {
        return 0;
    }
    carve(&arena, set, inertial, &s);
    return arena.used;
}

noh_result noh_pose_scratch_init(void *memory, size_t bytes, const noh_clip_set *set, int inertial,
                                 noh_pose_scratch *scratch, noh_error *error)
{
    NOH_ASSERT(set && scratch);
    const char *what = noh_clip_set_excess(set);
    noh_arena arena;
    noh_result result = what ? noh_fail(error, NOH_ERR_ARG, what, 0, 0)
                             : noh_arena_open(&arena, memory, bytes, noh_pose_scratch_size(set, inertial), error);
    if (result == NOH_OK) {
        carve(&arena, set, inertial, scratch);
    }
    return result;
}

/* ---- the pose ---- */

/* A controller as it was some ticks ago. */
typedef struct view {
    const noh_controller *c;
    const noh_clip_set *set;
    noh_pose_scratch *scratch;
    int64_t ago; /* ticks: tracks are where they were then, assuming their present speeds */
} view;

static int is_sampled(const noh_controller *c, const noh_track *t)
{
    int near_enough = t->lod_levels == 0 || c->lod < t->lod_levels;
    return t->mode == NOH_TRACK_ON && t->weight > 0.0f && near_enough;
}

static uint32_t clip_tick(const view *v, const noh_track *t)
{
    return noh_track_clip_tick(t, &v->set->clips[t->clip], v->ago);
}

static float full_weight(const noh_controller *c)
{
    return c->flags & NOH_CONTROLLER_COVERS ? 1.0f : 0.0f;
}

/* Sample one track's pose into the scratch, without its root motion. */
static void sample_at(const view *v, uint32_t clip, uint32_t tick, noh_transform *pose, float *floats)
{
    noh_root_sample_rest(v->set, clip, tick, v->c->lod_joint_count, pose, floats);
}

/* Add the poses of a group's tracks to the sum. Returns their number. */
static uint32_t sum_group(const view *v, noh_track_group group)
{
    noh_pose_scratch *s = v->scratch;
    uint32_t count = 0;
    for (uint32_t i = 0; i < v->c->track_count; i++) {
        const noh_track *t = noh_controller_track(v->c, i);
        if (t->group == group && !(t->flags & NOH_TRACK_ADDITIVE) && is_sampled(v->c, t)) {
            const uint32_t flags = v->set->clips[t->clip].flags;
            sample_at(v, t->clip, clip_tick(v, t), s->sample, s->float_sample);
            noh_blend_add(&s->blend, flags & NOH_CLIP_FLOATS_ONLY ? NULL : s->sample,
                          flags & NOH_CLIP_JOINTS_ONLY ? NULL : s->float_sample, t->weight,
                          noh_clip_set_mask(v->set, t->mask));
            count++;
        }
    }
    return count;
}

static int is_low(const view *v, const noh_track *t)
{
    return t->group == NOH_GROUP_LOW && !(t->flags & NOH_TRACK_ADDITIVE) && is_sampled(v->c, t);
}

/* Whether any low track covers the bind pose only partly. */
static int some_shine_through(const view *v)
{
    for (uint32_t i = 0; i < v->c->track_count; i++) {
        const noh_track *t = noh_controller_track(v->c, i);
        if (t->full != 0.0f && is_low(v, t) && noh_track_cover(t) < 1.0f) return 1;
    }
    return 0;
}

static void cover_more(float *covers, uint32_t count, const uint8_t *mask, float cover, int rises)
{
    for (uint32_t i = 0; i < count; i++) {
        if (mask && !mask[i]) continue;
        if (rises) covers[i] += (1.0f - covers[i]) * cover;
        if (!rises && cover > covers[i]) covers[i] = cover;
    }
}

/* Largest cover of each joint and float by any low track; then the share of the rest that rising tracks cover. */
static void find_covers(const view *v, float *joints, float *floats)
{
    memset(joints, 0, v->c->lod_joint_count * sizeof *joints);
    if (v->set->float_count) memset(floats, 0, v->set->float_count * sizeof *floats);
    for (uint32_t i = 0; i < 2u * v->c->track_count; i++) {
        const noh_track *t = noh_controller_track(v->c, i % v->c->track_count);
        const noh_mask_view mask = noh_clip_set_mask(v->set, t->mask);
        const uint32_t flags = v->set->clips[t->clip].flags;
        const int rises = (t->flags & NOH_TRACK_RISES) != 0;
        if (!is_low(v, t) || rises != (i >= v->c->track_count)) continue;
        if (!(flags & NOH_CLIP_FLOATS_ONLY))
            cover_more(joints, v->c->lod_joint_count, mask.joints, noh_track_cover(t), rises);
        if (!(flags & NOH_CLIP_JOINTS_ONLY))
            cover_more(floats, v->set->float_count, mask.floats, noh_track_cover(t), rises);
    }
}

/* Let the bind pose and the floats' defaults show through the low group's result. Floats with a sum of weights below
 * the blend's `full` already show part of their defaults. */
static void lay_over_bind(const view *v, noh_transform *pose, float *floats)
{
    const noh_blend *b = &v->scratch->blend;
    find_covers(v, v->scratch->below, v->scratch->float_below);
    for (uint32_t j = 0; j < v->c->lod_joint_count; j++) {
        const float cover = v->scratch->below[j];
        if (cover < 1.0f) noh_pose_mix(1, &v->set->bind_pose[j], &pose[j], cover, NULL, &pose[j]);
    }
    for (uint32_t f = 0; f < v->set->float_count; f++) {
        const float rest = v->set->float_defaults ? v->set->float_defaults[f] : 0.0f, sum = b->float_weights[f];
        const float shown = sum < b->full ? sum : 1.0f, cover = v->scratch->float_below[f];
        if (cover < shown) floats[f] = rest + (floats[f] - rest) * (cover / shown);
    }
}

/* Blend the low tracks, blend the high tracks, cover the low result by the high one. */
static void blend_groups(const view *v, noh_transform *pose, float *floats)
{
    noh_pose_scratch *s = v->scratch;
    noh_blend_begin(&s->blend);
    (void)sum_group(v, NOH_GROUP_LOW);
    noh_blend_finish(&s->blend, v->set->bind_pose, v->set->float_defaults, pose, floats);
    if (some_shine_through(v)) lay_over_bind(v, pose, floats);
    noh_blend_begin_over(&s->blend);
    if (sum_group(v, NOH_GROUP_HIGH)) {
        noh_blend_cover(&s->blend, v->c->priority_blend, pose, floats);
    }
}

/* The only track in the blend, if it has no mask and full weight: its clip needs no sum. */
static const noh_track *only_track(const view *v)
{
    const noh_track *only = NULL;
    for (uint32_t i = 0; i < v->c->track_count; i++) {
        const noh_track *t = noh_controller_track(v->c, i);
        if (!(t->flags & NOH_TRACK_ADDITIVE) && is_sampled(v->c, t)) {
            if (only || t->mask || t->weight < full_weight(v->c) || (is_low(v, t) && noh_track_cover(t) < 1.0f)) {
                return NULL;
            }
            only = t;
        }
    }
    return only;
}

static void bind_pose_for(const noh_clip_set *set, uint32_t clip, uint32_t joint_count, noh_transform *pose)
{
    if (!NOH_PAGE && (set->clips[clip].flags & NOH_CLIP_MAPPED)) {
        set->sample(set->user, clip, NOH_NONE, joint_count, pose, 0, NULL);
    } else {
        memcpy(pose, set->bind_pose, joint_count * sizeof *pose);
    }
}

void noh_reference_pose(const noh_clip_set *set, uint32_t clip, uint32_t reference, uint32_t joint_count,
                        noh_transform *pose, float *floats)
{
    const uint32_t flags = reference ? set->clips[reference - 1u].flags : NOH_CLIP_FLOATS_ONLY | NOH_CLIP_JOINTS_ONLY;
    if (reference) noh_root_sample_rest(set, reference - 1u, 0, joint_count, pose, floats);
    if ((flags & NOH_CLIP_FLOATS_ONLY) && joint_count) bind_pose_for(set, clip, joint_count, pose);
    for (uint32_t i = 0; i < set->float_count && (flags & NOH_CLIP_JOINTS_ONLY); i++) {
        floats[i] = set->float_defaults ? set->float_defaults[i] : 0.0f;
    }
}

/* The reference of an additive track. 0: the bind pose; else 1 + index of a clip. */
static uint32_t reference_of(const noh_track *t)
{
    return t->reference || !(t->flags & NOH_TRACK_REFERENCE_START) ? t->reference : t->clip + 1u;
}

static void add_track(const view *v, const noh_track *t, noh_transform *pose, float *floats)
{
    noh_pose_scratch *s = v->scratch;
    noh_mask_view mask = noh_clip_set_mask(v->set, t->mask);
    uint32_t joints = v->c->lod_joint_count, count = v->set->float_count, flags = v->set->clips[t->clip].flags;
    sample_at(v, t->clip, clip_tick(v, t), s->sample, s->float_sample);
    if (!(flags & NOH_CLIP_ADDITIVE)) {
        /* into the blend's sums, which are unused by now */
        noh_reference_pose(v->set, t->clip, reference_of(t), joints, s->blend.sum, s->blend.float_sum);
        noh_pose_difference(joints, s->blend.sum, s->sample, s->sample);
        for (uint32_t i = 0; i < count; i++) {
            s->float_sample[i] -= s->blend.float_sum[i];
        }
    }
    if (!(flags & NOH_CLIP_FLOATS_ONLY)) {
        noh_pose_add(joints, s->sample, t->weight, mask.joints, pose);
    }
    if (!(flags & NOH_CLIP_JOINTS_ONLY)) {
        noh_floats_add(count, s->float_sample, t->weight, mask.floats, floats);
    }
}

static void add_layers(const view *v, noh_transform *pose, float *floats)
{
    for (uint32_t i = 0; i < v->c->track_count; i++) {
        const noh_track *t = noh_controller_track(v->c, i);
        if ((t->flags & NOH_TRACK_ADDITIVE) && is_sampled(v->c, t)) {
            add_track(v, t, pose, floats);
        }
    }
}

static const void *at(const noh_controller *c, uint32_t offset)
{
    return (const uint8_t *)c + offset;
}

void noh_controller_inertia_add(const noh_controller *c, int64_t ago, noh_transform *pose, float *floats)
{
    NOH_ASSERT(c && (!c->inertia_ticks || c->inertia_offset));
    int64_t elapsed = noh_clock_since(noh_clock_add(c->clock, -ago), c->inertia_start);
    float elapsed_s = (float)(elapsed < 0 ? 0 : elapsed) / (float)NOH_TICKS_PER_SECOND;
    float duration_s = (float)c->inertia_ticks / (float)NOH_TICKS_PER_SECOND;
    if (c->inertia_ticks && elapsed < (int64_t)c->inertia_ticks) {
        noh_inertia_apply(c->lod_joint_count, (const noh_inertia_joint *)at(c, c->inertia_offset), elapsed_s,
                          duration_s, pose);
        noh_inertia_apply_floats(c->float_count, (const noh_inertia_float *)at(c, c->inertia_floats_offset), elapsed_s,
                                 duration_s, floats);
    }
}

/* Compute the pose some ticks ago, with or without the remaining offset of a transition. */
static void evaluate(const noh_controller *c, const noh_clip_set *set, noh_pose_scratch *scratch, int64_t ago,
                     int inertia, noh_transform *pose, float *floats)
{
    view v = { NULL, NULL, NULL, 0 };
    const noh_track *only;
    NOH_ASSERT(set->joint_count == c->joint_count && set->float_count == c->float_count);
    v.c = c;
    v.set = set;
    v.scratch = scratch;
    v.ago = ago;
    scratch->blend.joint_count = c->lod_joint_count;
    scratch->blend.float_count = c->float_count;
    scratch->blend.full = full_weight(c);
    scratch->blend.totals = scratch->below;
    scratch->blend.float_totals = scratch->float_below;
    only = only_track(&v);
    if (only) {
        sample_at(&v, only->clip, clip_tick(&v, only), pose, floats);
    } else {
        blend_groups(&v, pose, floats);
    }
    add_layers(&v, pose, floats);
    if (inertia) {
        noh_controller_inertia_add(c, ago, pose, floats);
    }
    for (uint32_t i = c->lod_joint_count; i < c->joint_count; i++) {
        pose[i] = set->bind_pose[i];
    }
}

void noh_controller_pose(const noh_controller *c, const noh_clip_set *set, noh_pose_scratch *scratch,
                         noh_transform *pose, float *floats)
{
    NOH_ASSERT(c && set && scratch && (!set->joint_count || pose) && (!set->float_count || floats));
    NOH_VALIDATE(noh_controller_check(c, c->bytes, set, NULL) == NOH_OK);
    evaluate(c, set, scratch, 0, 1, pose, floats);
}

/* ---- transitions ---- */

/* Speeds of a transition are differences between the pose now and the pose NOH_INERTIA_BEFORE_TICKS ago: for what
 * played before the switch (captured, including a running transition's offsets) and for what plays after it (without
 * them). */
static const char *bad_transition(const noh_controller *c, const noh_pose_scratch *scratch)
{
    if (!(c->flags & NOH_CONTROLLER_INERTIAL))
        return "the controller has no room for inertia: set NOH_CONTROLLER_INERTIAL";
    if (!scratch->captured[0]) return "the scratch has no room for inertia: make it with inertial 1";
    return NULL;
}

noh_result noh_controller_inertia_capture(const noh_controller *c, const noh_clip_set *set, noh_pose_scratch *scratch,
                                          noh_error *error)
{
    NOH_ASSERT(c && set && scratch);
    const char *what = bad_transition(c, scratch);
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, 0, 0);
    }
    evaluate(c, set, scratch, 0, 1, scratch->captured[0], scratch->float_captured[0]);
    evaluate(c, set, scratch, NOH_INERTIA_BEFORE_TICKS, 1, scratch->captured[1], scratch->float_captured[1]);
    return NOH_OK;
}

void noh_controller_inertia_store(noh_controller *c, const noh_pose_scratch *scratch, uint32_t duration_ticks)
{
    uint8_t *base = (uint8_t *)c;
    float before_s = (float)NOH_INERTIA_BEFORE_TICKS / (float)NOH_TICKS_PER_SECOND;
    NOH_ASSERT(c && scratch && c->inertia_offset && scratch->captured[0] && duration_ticks);
    noh_inertia_begin(c->joint_count, scratch->captured[0], scratch->captured[1], scratch->captured[2],
                      scratch->captured[3], before_s, (noh_inertia_joint *)(void *)(base + c->inertia_offset));
    noh_inertia_begin_floats(c->float_count, scratch->float_captured[0], scratch->float_captured[1],
                             scratch->float_captured[2], scratch->float_captured[3], before_s,
                             (noh_inertia_float *)(void *)(base + c->inertia_floats_offset));
    noh_keep_sound((float *)(void *)(base + c->inertia_offset), 12u * (size_t)c->joint_count + 2u * c->float_count);
    c->inertia_start = c->clock;
    c->inertia_ticks = duration_ticks;
}

noh_result noh_controller_inertia_begin(noh_controller *c, const noh_clip_set *set, noh_pose_scratch *scratch,
                                        uint32_t duration_ticks, noh_error *error)
{
    NOH_ASSERT(c && set && scratch);
    const char *what = bad_transition(c, scratch);
    what = what ? what : duration_ticks == 0 ? "duration_ticks must be above 0" : NULL;
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, 0, 0);
    }
    evaluate(c, set, scratch, 0, 0, scratch->captured[2], scratch->float_captured[2]);
    evaluate(c, set, scratch, NOH_INERTIA_BEFORE_TICKS, 0, scratch->captured[3], scratch->float_captured[3]);
    noh_controller_inertia_store(c, scratch, duration_ticks);
    return NOH_OK;
}

/* ---- root motion ---- */

/* A weighted sum of displacements. Turns count as angles of -1/2 to 1/2 turn. `total` is the sum of unmasked weights:
 * `weight` / `total` is the mean mask, by which a high group covers the low one. `cover` is how much the tracks cover
 * the bind pose, which does not move; `bare` is what rising tracks leave of the rest. */
typedef struct root_sum {
    double translation[3], turn, weight, total, cover, bare;
} root_sum;

static void add_root(root_sum *sum, const noh_root_pose *move, double weight, double part)
{
    double w = weight * part;
    for (int i = 0; i < 3; i++) {
        sum->translation[i] += w * move->translation[i];
    }
    sum->turn += w * (double)(int32_t)move->turn;
    sum->weight += w;
    sum->total += weight;
}

/* A track's share in moving the root: 0 if its clip animates no joints or its mask excludes joint 0. */
static double root_part(const noh_clip_set *set, const noh_track *t)
{
    noh_mask_view mask = noh_clip_set_mask(set, t->mask);
    if (set->clips[t->clip].flags & NOH_CLIP_FLOATS_ONLY) {
        return 0.0;
    }
    return mask.joints ? (double)mask.joints[0] / 255.0 : 1.0;
}

static void add_cover(root_sum *sum, const noh_track *t)
{
    const double cover = (double)noh_track_cover(t);
    if (t->flags & NOH_TRACK_RISES) {
        sum->bare *= 1.0 - cover;
    } else if (cover > sum->cover) {
        sum->cover = cover;
    }
}

static root_sum group_root(noh_controller *c, const noh_clip_set *set, noh_track_group group,
                           const noh_given_root *given)
{
    root_sum sum;
    memset(&sum, 0, sizeof sum);
    sum.bare = 1.0;
    for (uint32_t i = 0; i < c->track_count; i++) {
        noh_track *t = &noh_controller_tracks(c)[i];
        const noh_root_track *root = &set->roots[t->clip];
        double part;
        if (t->group != group || t->mode == NOH_TRACK_OFF) {
            continue;
        }
        part = root_part(set, t);
        if (part > 0.0 && is_sampled(c, t) && !(t->flags & NOH_TRACK_ADDITIVE)) {
            noh_root_pose move = { { 0.0, 0.0, 0.0 }, 0, 0 };
            if (given && t->clip >= given->first_clip) {
                move = given->moved;
            } else if (root->axes) {
                move = noh_root_between(set, root, t->clip, (noh_loop)t->loop, t->root_position, t->position);
            }
            add_root(&sum, &move, (double)t->weight, part);
            add_cover(&sum, t);
        }
        t->root_position = t->position;
    }
    return sum;
}

static noh_root_pose mean_root(const root_sum *sum)
{
    noh_root_pose out = { { 0.0, 0.0, 0.0 }, 0, 0 };
    double turn = sum->weight > 0.0 ? sum->turn / sum->weight : 0.0;
    for (int i = 0; sum->weight > 0.0 && i < 3; i++) {
        out.translation[i] = sum->translation[i] / sum->weight;
    }
    out.turn = (uint32_t)(uint64_t)(int64_t)(turn < 0.0 ? turn - 0.5 : turn + 0.5);
    return out;
}

static void scale_root(noh_root_pose *move, double part)
{
    const double turn = (double)(int32_t)move->turn * part;
    for (int i = 0; i < 3; i++) {
        move->translation[i] *= part;
    }
    move->turn = (uint32_t)(uint64_t)(int64_t)(turn < 0.0 ? turn - 0.5 : turn + 0.5);
}

/* Each group's displacement is the weighted mean of its tracks' displacements; the high group covers the low one by the
 * priority blend times its mean mask, exactly as noh_blend_cover does for the pose of joint 0. */
noh_root_pose noh_controller_root_motion_given(noh_controller *c, const noh_clip_set *set, const noh_given_root *given)
{
    noh_root_pose out = { { 0.0, 0.0, 0.0 }, 0, 0 }, low, high;
    root_sum low_sum, high_sum, both;
    double cover;
    NOH_ASSERT(c && set && set->clip_count == c->clip_count);
    if (!set->roots) {
        return out;
    }
    low_sum = group_root(c, set, NOH_GROUP_LOW, given);
    high_sum = group_root(c, set, NOH_GROUP_HIGH, given);
    low = mean_root(&low_sum);
    if (low_sum.cover < 1.0) scale_root(&low, 1.0 - (1.0 - low_sum.cover) * low_sum.bare);
    high = mean_root(&high_sum);
    if (high_sum.total < (double)full_weight(c)) high_sum.total = (double)full_weight(c);
    cover = high_sum.weight > 0.0 ? (double)c->priority_blend * high_sum.weight / high_sum.total : 0.0;
    cover = low_sum.weight > 0.0 || full_weight(c) > 0.0f ? cover : 1.0;
    memset(&both, 0, sizeof both);
    add_root(&both, &low, 1.0 - cover, 1.0);
    add_root(&both, &high, cover, 1.0);
    return cover >= 1.0 ? high : cover <= 0.0 ? low : mean_root(&both);
}

noh_root_pose noh_controller_root_motion(noh_controller *c, const noh_clip_set *set)
{
    return noh_controller_root_motion_given(c, set, NULL);
}
