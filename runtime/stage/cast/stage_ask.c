/* stage_ask.c: where joints and actors are, and how finely they are shown. */
#include <string.h>

#include "core/base/math_internal.h"
#include "stage/character/character_internal.h"
#include "core/base/assert_internal.h"
#include "stage/character/time_lod_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "stage/cast/stage_internal.h"
#include "stage/character/lod_internal.h"

/* A joint in model space, as shown. */
static void joint_matrix(const noh_character *ch, uint32_t joint, float matrix[12])
{
    const uint32_t to = ch->time.to_pose;
    const float part = noh_time_lod_fraction(&ch->time);
    const float *target = noh_character_pose_palette(ch, to) + 12u * (size_t)joint;
    if (part >= 1.0f) {
        memcpy(matrix, target, 12u * sizeof *matrix);
    } else {
        noh_mix_fours(noh_character_pose_palette(ch, to ^ 1u) + 12u * (size_t)joint, target, part, 3, matrix);
    }
}

void noh_stage_own_matrix(const noh_stage *s, const noh_stage_kind *k, const noh_stage_actor *a, float matrix[12])
{
    noh_place place, turned;
    float own[12];
    noh_stage_shown_place(s, a, s->origin, &place);
    noh_place_matrix(&place, matrix);
    turned.scale = 1.0f;
    if (!noh_stage_turn(k, noh_stage_index(k, a), turned.rotation, turned.position)) return;
    noh_place_matrix(&turned, own);
    noh_matrix_multiply(matrix, own, matrix);
}

void noh_stage_world(const noh_stage *s, uint32_t index, float matrix[12])
{
    const noh_stage_actor *a = &s->actors[index];
    noh_stage_own_matrix(s, noh_stage_kind_of(s, index), a, matrix);
    noh_stage_carry(s, a, matrix);
}

void noh_stage_carry(const noh_stage *s, const noh_stage_actor *a, float matrix[12])
{
    const noh_stage_actor *on;
    noh_stage_kind *k = NULL;
    for (; (on = noh_stage_parent_of(s, a, &k)) != NULL; a = on) {
        const noh_character *ch = noh_stage_character(k, noh_stage_index(k, on));
        float joint[12], world[12];
        noh_stage_own_matrix(s, k, on, world);
        if (ch->time.posed && a->joint < k->skeleton.joint_count) {
            joint_matrix(ch, a->joint, joint);
            noh_matrix_multiply(world, joint, world);
        }
        noh_matrix_multiply(world, matrix, matrix);
    }
}

/* Back from the stage's origin. */
static void to_world(const noh_stage *s, float matrix[12])
{
    for (int i = 0; i < 3; i++) matrix[4 * i + 3] += s->origin[i];
}

noh_result noh_actor_joint(const noh_stage *stage, noh_actor actor, uint32_t joint, float matrix[12], noh_error *error)
{
    const noh_result result = noh_stage_joint(stage, actor, joint, matrix, error);
    if (result == NOH_OK) to_world(stage, matrix);
    return result;
}

noh_result noh_stage_joint(const noh_stage *stage, noh_actor actor, uint32_t joint, float matrix[12], noh_error *error)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    const noh_character *ch;
    float world[12];
    NOH_ASSERT(matrix);
    if (!a) {
        return noh_stage_gone(error, actor);
    }
    ch = noh_stage_character(k, noh_stage_index(k, a));
    if (joint >= k->skeleton.joint_count || !ch->time.posed) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "no such joint, or the actor was never posed", joint,
                        k->skeleton.joint_count);
    }
    noh_stage_world(stage, (uint32_t)(a - stage->actors), world);
    joint_matrix(ch, joint, matrix);
    noh_matrix_multiply(world, matrix, matrix);
    return NOH_OK;
}

noh_result noh_actor_root(const noh_stage *stage, noh_actor actor, noh_root_pose *moved, noh_error *error)
{
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, NULL);
    NOH_ASSERT(moved);
    if (!a) {
        return noh_stage_gone(error, actor);
    }
    *moved = a->moved;
    return NOH_OK;
}

noh_result noh_actor_sphere(const noh_stage *stage, noh_actor actor, float sphere[4], noh_error *error)
{
    const noh_result result = noh_stage_actor_sphere(stage, actor, sphere, error);
    for (int i = 0; i < 3 && result == NOH_OK; i++) sphere[i] += stage->origin[i];
    return result;
}

noh_result noh_stage_actor_sphere(const noh_stage *stage, noh_actor actor, float sphere[4], noh_error *error)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    float world[12], own[4];
    NOH_ASSERT(sphere);
    if (!a) {
        return noh_stage_gone(error, actor);
    }
    noh_stage_sphere(k, noh_stage_index(k, a), own);
    if (!noh_stage_character(k, noh_stage_index(k, a))->time.posed) {
        float shown[4];
        memcpy(shown, own, sizeof shown);
        noh_stage_reach(k, shown, own);
    }
    noh_stage_world(stage, (uint32_t)(a - stage->actors), world);
    noh_stage_sphere_in_world(world, own, sphere);
    return NOH_OK;
}

const float *noh_actor_floats(const noh_stage *stage, noh_actor actor)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    if (!a || stage->shown[a - stage->actors].frame != stage->frame || !stage->frame) {
        return NULL;
    }
    return k->floats + (size_t)noh_stage_index(k, a) * k->float_count;
}

/* ---- meshes ---- */

noh_result noh_actor_mesh_at(const noh_stage *stage, noh_actor actor, uint32_t index, noh_actor_mesh *out,
                             float *matrices, noh_error *error)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    const noh_stage_mesh *mesh;
    const noh_stage_shown *shown;
    NOH_ASSERT(out);
    if (!a) {
        return noh_stage_gone(error, actor);
    }
    shown = &stage->shown[a - stage->actors];
    if (index >= k->plan->mesh_count || shown->frame != stage->frame || !stage->frame) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "an actor has no such mesh, or was not shown in the last frame",
                        index, k->plan->mesh_count);
    }
    mesh = &k->meshes[index];
    out->node = mesh->item.node;
    out->mesh = mesh->item.mesh;
    out->level = k->plan->levels[noh_stage_character(k, noh_stage_index(k, a))->lod.mesh].mesh_levels[index];
    out->joint_count = mesh->skinned ? mesh->skin.header->joint_count : 0;
    out->weights = k->weights + (size_t)noh_stage_index(k, a) * k->weight_count + mesh->first_weight;
    memcpy(out->world, shown->world, sizeof out->world);
    if (!mesh->skinned && mesh->node_world) noh_matrix_multiply(shown->world, mesh->node_world, out->world);
    to_world(stage, out->world);
    if (matrices && mesh->skinned) {
        noh_character_skin(noh_stage_character(k, noh_stage_index(k, a)), &mesh->skin, matrices);
        noh_stage_move_far_joints(k, noh_stage_index(k, a), index,
                                  noh_stage_character(k, noh_stage_index(k, a))->lod.mesh, matrices);
    }
    return NOH_OK;
}

/* ---- detail ---- */

/* Levels and fade as they are drawn; without anything that draws, as they were chosen. */
static void take_levels(const noh_stage_kind *k, const noh_stage_shown *shown, const noh_character *ch,
                        noh_actor_detail *out)
{
    const int has_slot = k->pools && shown->views;
    out->level = has_slot ? shown->level : ch->lod.mesh;
    out->level_before = has_slot ? shown->level_before : ch->lod.mesh_before;
    out->fade = out->level == out->level_before ? 1.0f : noh_lod_fade(&ch->lod, ch->time.clock);
    if (out->fade >= 1.0f) out->level_before = out->level;
}

noh_result noh_actor_detail_of(const noh_stage *stage, noh_actor actor, noh_actor_detail *out, noh_error *error)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    const noh_stage_shown *shown;
    const noh_character *ch;
    uint32_t joints;
    NOH_ASSERT(out);
    if (!a) {
        return noh_stage_gone(error, actor);
    }
    shown = &stage->shown[a - stage->actors];
    if (shown->frame != stage->frame || !stage->frame) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "an actor was not shown in the last frame", actor.id, 0);
    }
    ch = noh_stage_character(k, noh_stage_index(k, a));
    take_levels(k, shown, ch, out);
    joints = noh_lod_joint_count(&ch->lod, &k->table);
    out->joint_count = joints && joints < k->skeleton.joint_count ? joints : k->skeleton.joint_count;
    out->influence_count = noh_lod_influence_count(&ch->lod, &k->table);
    out->error_m = ch->lod.error_m + ch->lod.skipped_m;
    out->pixels_per_metre = shown->views ? shown->scale * noh_stage_size(stage, a) : 0.0f;
    return NOH_OK;
}
