/* character.c: a controller with levels of detail and two poses.
 *
 * A distant character is not posed in every frame. It is posed ahead of time, for the tick of its next update. Until
 * then the character shows a mix of this pose and the previous one, linear in the matrices and far cheaper than a pose.
 * The two palettes, weights and spheres take turns as source and target of the mix. */
#include "core/base/assert_internal.h"
#include "motion/anim/controller_internal.h"
#include "stage/character/bounds_internal.h"
#include "stage/character/character_internal.h"
#include "stage/character/time_lod_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/noh.h"

#include <string.h>

#include "motion/anim/clock_internal.h"
#include "stage/character/lod_internal.h"

/* ---- memory ---- */

typedef struct layout {
    size_t controller, palettes[2], floats[2], bytes;
} layout;

/* Carve and return the offset, not the address: a character holds no pointers, so it can be copied byte by byte. */
static size_t place(noh_arena *arena, size_t bytes)
{
    (void)noh_arena_carve(arena, bytes, 16);
    return arena->used - bytes;
}

static layout layout_of(const noh_character_desc *d, size_t controller_bytes)
{
    noh_arena arena = noh_arena_measure();
    layout l;
    (void)place(&arena, sizeof(noh_character));
    l.controller = place(&arena, controller_bytes);
    for (int i = 0; i < 2; i++) {
        l.palettes[i] = place(&arena, 12u * sizeof(float) * (size_t)d->controller.set->joint_count);
        l.floats[i] = place(&arena, d->controller.set->float_count * sizeof(float));
    }
    (void)noh_arena_carve(&arena, 0, 16); /* a multiple of the alignment, for arrays of characters */
    l.bytes = arena.used;
    return l;
}

size_t noh_character_size(const noh_character_desc *desc)
{
    NOH_ASSERT(desc);
    size_t controller_bytes = noh_controller_size(&desc->controller);
    return controller_bytes ? layout_of(desc, controller_bytes).bytes : 0;
}

static void fill_head(noh_character *ch, const noh_character_desc *d, const layout *l)
{
    ch->start_clock = d->start_clock;
    ch->bytes = (uint32_t)l->bytes;
    ch->joint_count = d->controller.set->joint_count;
    ch->float_count = d->controller.set->float_count;
    ch->controller_offset = (uint32_t)l->controller;
    for (int i = 0; i < 2; i++) {
        ch->palette_offsets[i] = (uint32_t)l->palettes[i];
        NOH_ASSERT(l->floats[i] == l->palettes[i] + 12u * sizeof(float) * (size_t)ch->joint_count);
    }
    noh_time_lod_init(&ch->time, d->instance);
    ch->time.clock = d->start_clock;
}

noh_result noh_character_init(void *memory, size_t bytes, const noh_character_desc *desc, noh_character **character,
                              noh_error *error)
{
    NOH_ASSERT(desc && character);
    size_t controller_bytes = noh_controller_size(&desc->controller);
    noh_controller *controller;
    noh_character *ch = (noh_character *)memory;
    noh_arena arena;
    noh_result result;
    layout l;
    if (controller_bytes == 0) {
        return noh_controller_init(NULL, 0, &desc->controller, &controller, error); /* reports the field */
    }
    l = layout_of(desc, controller_bytes);
    result = noh_arena_open(&arena, memory, bytes, l.bytes, error);
    if (result != NOH_OK) {
        return result;
    }
    memset(memory, 0, l.bytes);
    result = noh_controller_init((uint8_t *)memory + l.controller, controller_bytes, &desc->controller, &controller,
                                 error);
    if (result == NOH_OK) {
        fill_head(ch, desc, &l);
        *character = ch;
    }
    return result;
}

static size_t carve_scratch(noh_arena *arena, const noh_character_desc *d, noh_character_scratch *s, void **pose_memory)
{
    const noh_clip_set *set = d->controller.set;
    size_t pose_bytes = noh_pose_scratch_size(set, 0);
    memset(s, 0, sizeof *s);
    s->ahead_bytes = noh_controller_size(&d->controller);
    s->ahead = (noh_controller *)noh_arena_carve(arena, s->ahead_bytes, 16);
    *pose_memory = noh_arena_carve(arena, pose_bytes, 16);
    s->model = (float *)noh_arena_carve(arena, 12u * sizeof(float) * (size_t)set->joint_count, 16);
    s->local = (noh_transform *)noh_arena_carve(arena, set->joint_count * sizeof(noh_transform), 4);
    s->floats = (float *)noh_arena_carve(arena, set->float_count * sizeof(float), 4);
    return pose_bytes;
}

size_t noh_character_scratch_size(const noh_character_desc *desc)
{
    noh_arena arena = noh_arena_measure();
    noh_character_scratch s;
    void *pose_memory;
    NOH_ASSERT(desc);
    if (noh_controller_size(&desc->controller) == 0) {
        return 0;
    }
    (void)carve_scratch(&arena, desc, &s, &pose_memory);
    return arena.used;
}

noh_result noh_character_scratch_init(void *memory, size_t bytes, const noh_character_desc *desc,
                                      noh_character_scratch *scratch, noh_error *error)
{
    NOH_ASSERT(desc && scratch);
    size_t need = noh_character_scratch_size(desc), pose_bytes;
    noh_arena arena;
    noh_result result;
    noh_controller *controller;
    void *pose_memory;
    if (need == 0) {
        return noh_controller_init(NULL, 0, &desc->controller, &controller, error);
    }
    result = noh_arena_open(&arena, memory, bytes, need, error);
    if (result != NOH_OK) {
        return result;
    }
    pose_bytes = carve_scratch(&arena, desc, scratch, &pose_memory);
    return noh_pose_scratch_init(pose_memory, pose_bytes, desc->controller.set, 0, &scratch->pose, error);
}

void noh_character_set_behind(noh_character *ch, uint32_t ticks)
{
    NOH_ASSERT(ch);
    ch->time.behind_ticks = ticks;
}

/* ---- parts ---- */

noh_controller *noh_character_controller(noh_character *ch)
{
    NOH_ASSERT(ch);
    return (noh_controller *)(void *)((uint8_t *)ch + ch->controller_offset);
}

static const noh_controller *controller_of(const noh_character *ch)
{
    return (const noh_controller *)(const void *)((const uint8_t *)ch + ch->controller_offset);
}

static float *palette_of(noh_character *ch, uint32_t pose)
{
    return (float *)(void *)((uint8_t *)ch + ch->palette_offsets[pose]);
}

static float *floats_of(noh_character *ch, uint32_t pose)
{
    return palette_of(ch, pose) + 12u * (size_t)ch->joint_count;
}

static const float *at(const noh_character *ch, uint32_t offset)
{
    return (const float *)(const void *)((const uint8_t *)ch + offset);
}

static const float *pose_floats(const noh_character *ch, uint32_t pose)
{
    return noh_character_pose_palette(ch, pose) + 12u * (size_t)ch->joint_count;
}

const float *noh_character_pose_palette(const noh_character *ch, uint32_t pose)
{
    return at(ch, ch->palette_offsets[pose]);
}

int64_t noh_character_clock(const noh_character *ch)
{
    return noh_clock_add(ch->start_clock, controller_of(ch)->clock);
}

/* ---- a frame ---- */

uint32_t noh_character_step(noh_character *ch, const noh_clip_set *set, uint32_t ticks, noh_event_fn fn, void *user)
{
    NOH_ASSERT(ch && set);
    return noh_controller_step(noh_character_controller(ch), set, ticks, fn, user);
}

noh_due noh_character_select_lod(noh_character *ch, const noh_lod_table *table, const noh_lod_settings *settings,
                                 float pixels_per_metre)
{
    float update_error_m[NOH_UPDATE_RATE_COUNT];
    NOH_ASSERT(ch && table && settings);
    if (table->update_error_m) {
        noh_time_lod_error(noh_character_controller(ch), table->update_error_m, update_error_m);
    }
    return noh_character_select_lod_for(ch, table, settings, pixels_per_metre,
                                        table->update_error_m ? update_error_m : NULL);
}

noh_due noh_character_select_lod_for(noh_character *ch, const noh_lod_table *table, const noh_lod_settings *settings,
                                     float pixels_per_metre, const float *update_error_m)
{
    NOH_ASSERT(ch && table && settings);
    noh_controller *c = noh_character_controller(ch);
    const int64_t clock = noh_character_clock(ch);
    uint32_t joints;
    noh_lod_choose(&ch->lod, table, settings, pixels_per_metre, update_error_m,
                   noh_clock_add(clock, -(int64_t)ch->time.behind_ticks));
    joints = noh_lod_joint_count(&ch->lod, table);
    (void)noh_controller_set_lod(c, ch->lod.mesh, joints < ch->joint_count ? joints : 0);
    noh_time_lod_frame(&ch->time, clock, (noh_update_rate)ch->lod.update_rate);
    return noh_time_lod_due(&ch->time);
}

uint32_t noh_character_late(const noh_character *ch)
{
    NOH_ASSERT(ch);
    return noh_time_lod_late(&ch->time);
}

uint32_t noh_character_joint_work(const noh_character *ch)
{
    const noh_controller *c = controller_of(ch);
    uint32_t tracks = 0;
    for (uint32_t i = 0; i < c->track_count; i++) {
        const noh_track *t = noh_controller_track(c, i);
        tracks += t->mode == NOH_TRACK_ON && t->weight > 0.0f;
    }
    return tracks * c->lod_joint_count;
}

void noh_mix_fours(const float *a, const float *b, float part, size_t fours, float *out)
{
    for (size_t i = 0; i < 4u * fours; i += 4u) {
        float mixed[4];
        for (size_t k = 0; k < 4; k++) {
            mixed[k] = a[i + k] + (b[i + k] - a[i + k]) * part;
        }
        memcpy(out + i, mixed, sizeof mixed);
    }
}

static void mix_floats(const float *a, const float *b, float part, uint32_t count, float *out)
{
    for (uint32_t i = 0; i < count; i++) {
        out[i] = a[i] + (b[i] - a[i]) * part;
    }
}

/* The current mix becomes the source pose. Spheres are mixed likewise: the mix of two spheres contains the mix of their
 * contents. */
static void keep_shown(noh_character *ch, uint32_t from, float part)
{
    uint32_t to = from ^ 1u;
    noh_mix_fours(palette_of(ch, from), palette_of(ch, to), part, 3u * (size_t)ch->joint_count, palette_of(ch, from));
    mix_floats(floats_of(ch, from), floats_of(ch, to), part, ch->float_count, floats_of(ch, from));
    mix_floats(ch->spheres[from], ch->spheres[to], part, 4, ch->spheres[from]);
    mix_floats(&ch->stretches[from], &ch->stretches[to], part, 1, &ch->stretches[from]);
}

int64_t noh_character_pose_clock(const noh_character *ch)
{
    noh_time_lod t;
    NOH_ASSERT(ch);
    t = ch->time;
    return noh_time_lod_update(&t).pose_clock;
}

void noh_character_update_begin(noh_character *ch, const noh_clip_set *set, noh_character_scratch *scratch)
{
    NOH_ASSERT(ch && set && scratch && set->joint_count == ch->joint_count && set->float_count == ch->float_count);
    const noh_controller *c = controller_of(ch);
    /* The pose of the next update is found by playing a copy of the controller to that tick, without firing callbacks.
     */
    noh_time_update u = noh_time_lod_update(&ch->time);
    int64_t ahead = noh_clock_since(u.pose_clock, noh_character_clock(ch));
    if (u.keep < 1.0f) {
        keep_shown(ch, u.pose ^ 1u, u.keep);
    }
    if (ahead > 0) {
        NOH_ASSERT(c->bytes <= scratch->ahead_bytes);
        memcpy(scratch->ahead, c, c->bytes);
        (void)noh_controller_step(scratch->ahead, set, (uint32_t)ahead, NULL, NULL);
        c = scratch->ahead;
    }
    noh_controller_pose(c, set, &scratch->pose, scratch->local, scratch->floats);
    scratch->joint_count = c->lod_joint_count;
    scratch->pose_index = u.pose;
    ch->updates++;
}

/* Matrices of all joints. A joint that was not sampled keeps its bind pose relative to its parent. With inverse bind
 * matrices its skinning matrix is then equal to its parent's: model[parent] * bind * inverse bind of the joint, where
 * bind * inverse bind of the joint = inverse bind of the parent. A copy is cheaper than a product. Without inverse bind
 * matrices the joint's model matrix is computed from the bind pose, which noh_controller_pose left in
 * scratch->local. */
static void make_palette(const noh_skeleton *skeleton, const noh_character_scratch *s, uint32_t joint_count,
                         float *palette)
{
    uint32_t count = skeleton->inverse_bind ? s->joint_count : joint_count;
    noh_local_to_model(skeleton, s->local, count, s->model);
    noh_model_to_palette(skeleton, s->model, count, palette);
    for (uint32_t i = count; i < joint_count; i++) {
        NOH_ASSERT(skeleton->parents[i] != NOH_JOINT_ROOT);
        memcpy(palette + 12u * (size_t)i, palette + 12u * (size_t)skeleton->parents[i], 12u * sizeof(float));
    }
}

void noh_character_update_end(noh_character *ch, const noh_skeleton *skeleton, const float *joint_radius_m,
                              noh_character_scratch *scratch)
{
    const uint32_t pose = scratch->pose_index;
    NOH_ASSERT(ch && skeleton && scratch && pose < 2u);
    NOH_ASSERT(skeleton->joint_count == ch->joint_count);
    make_palette(skeleton, scratch, ch->joint_count, palette_of(ch, pose));
    ch->multiplied = (ch->multiplied & ~(1u << pose)) | (skeleton->inverse_bind ? 1u << pose : 0u);
    memcpy(floats_of(ch, pose), scratch->floats, ch->float_count * sizeof(float));
    if (joint_radius_m) {
        noh_bounds bounds;
        noh_joint_bounds(skeleton, scratch->model, joint_radius_m, scratch->joint_count, &bounds);
        memcpy(ch->spheres[pose], bounds.centre, sizeof bounds.centre);
        ch->spheres[pose][3] = bounds.radius;
        ch->stretches[pose] = bounds.stretch;
    }
}

void noh_character_update(noh_character *ch, const noh_clip_set *set, const noh_skeleton *skeleton,
                          const float *joint_radius_m, noh_character_scratch *scratch)
{
    noh_character_update_begin(ch, set, scratch);
    noh_character_update_end(ch, skeleton, joint_radius_m, scratch);
}

void noh_character_keep_time(noh_character *ch, const noh_character *on)
{
    NOH_ASSERT(ch && on);
    ch->time = on->time;
}

void noh_character_follow(noh_character *ch, const noh_character *on, const uint16_t *joints, int fresh)
{
    NOH_ASSERT(ch && on && joints && !ch->multiplied && !on->multiplied);
    const uint32_t to = ch->time.to_pose, from = to ^ 1u;
    if (fresh) { /* what does not follow is at rest until the next update */
        memcpy(palette_of(ch, from), palette_of(ch, to), 12u * sizeof(float) * (size_t)ch->joint_count);
        memcpy(floats_of(ch, from), floats_of(ch, to), ch->float_count * sizeof(float));
        memcpy(ch->spheres[from], ch->spheres[to], sizeof ch->spheres[to]);
        ch->stretches[from] = ch->stretches[to];
    }
    for (size_t j = 0; j < ch->joint_count; j++) {
        if (joints[j] == NOH_JOINT_ROOT) continue;
        NOH_ASSERT(joints[j] < on->joint_count);
        for (uint32_t pose = 0; pose < 2u; pose++) {
            memcpy(palette_of(ch, pose) + 12u * j, noh_character_pose_palette(on, pose) + 12u * (size_t)joints[j],
                   12u * sizeof(float));
        }
    }
    ch->updates = on->updates;
}

const float *noh_character_palette(const noh_character *ch, float *mixed, uint32_t joint_count)
{
    NOH_ASSERT(ch->time.posed && joint_count <= ch->joint_count);
    uint32_t to = ch->time.to_pose;
    const float *last = at(ch, ch->palette_offsets[to]);
    float part = noh_time_lod_fraction(&ch->time);
    NOH_ASSERT(mixed || part >= 1.0f);
    if (part >= 1.0f) {
        return last;
    }
    noh_mix_fours(at(ch, ch->palette_offsets[to ^ 1u]), last, part, 3u * (size_t)joint_count, mixed);
    return mixed;
}

const float *noh_character_floats(const noh_character *ch, float *mixed)
{
    NOH_ASSERT(ch->time.posed);
    uint32_t to = ch->time.to_pose;
    const float *last = pose_floats(ch, to);
    float part = noh_time_lod_fraction(&ch->time);
    NOH_ASSERT(mixed || part >= 1.0f || !ch->float_count);
    if (part >= 1.0f) {
        return last;
    }
    mix_floats(pose_floats(ch, to ^ 1u), last, part, ch->float_count, mixed);
    return mixed;
}

void noh_character_sphere(const noh_character *ch, float sphere[4])
{
    NOH_ASSERT(sphere);
    NOH_ASSERT(ch->time.posed);
    uint32_t to = ch->time.to_pose;
    float part = noh_time_lod_fraction(&ch->time);
    mix_floats(ch->spheres[to ^ 1u], ch->spheres[to], part, 4, sphere);
}

float noh_character_stretch(const noh_character *ch)
{
    NOH_ASSERT(ch->time.posed);
    uint32_t to = ch->time.to_pose;
    float part = noh_time_lod_fraction(&ch->time), stretch;
    mix_floats(&ch->stretches[to ^ 1u], &ch->stretches[to], part, 1, &stretch);
    return stretch;
}

void noh_character_wake(noh_character *ch)
{
    NOH_ASSERT(ch);
    noh_time_lod_wake(&ch->time);
}

void noh_character_cut(noh_character *ch)
{
    NOH_ASSERT(ch);
    noh_lod_cut(&ch->lod);
    ch->time.posed = 0;
}
