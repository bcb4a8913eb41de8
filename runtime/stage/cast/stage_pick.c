/* stage_pick.c: a ray against the actors as they were shown last. */
#include <string.h>

#include "core/base/math_internal.h"
#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "stage/cast/stage_internal.h"

typedef struct ray {
    float origin[3], direction[3];
    float distance; /* of the nearest hit so far */
} ray;

/* The inverse of a matrix, applied to a point (w 1) or a direction (w 0): the joint of an attached actor may have a
 * scale for each axis. Cramer's rule; 0: the matrix is singular, so the ray misses. */
static int into(const float m[12], const float v[3], float w, float out[3])
{
    float cross[3][3], d[3], determinant;
    for (int c = 0; c < 3; c++) {
        const float *a = m + (c + 1) % 3, *b = m + (c + 2) % 3;
        for (int r = 0; r < 3; r++) {
            const int y = 4 * ((r + 1) % 3), z = 4 * ((r + 2) % 3);
            cross[c][r] = a[y] * b[z] - a[z] * b[y];
        }
    }
    determinant = m[0] * cross[0][0] + m[4] * cross[0][1] + m[8] * cross[0][2];
    for (int i = 0; i < 3; i++) d[i] = v[i] - w * m[4 * i + 3];
    for (int i = 0; i < 3; i++) out[i] = noh_dot3(cross[i], d) / determinant;
    return determinant < 0.0f || determinant > 0.0f;
}

static int meets(const ray *r, const float sphere[4])
{
    float to[3], along = 0.0f, square = 0.0f, length = 0.0f, apart;
    for (int i = 0; i < 3; i++) {
        to[i] = sphere[i] - r->origin[i];
        along += to[i] * r->direction[i];
        square += to[i] * to[i];
        length += r->direction[i] * r->direction[i];
    }
    apart = square - along * along / length;
    return apart <= sphere[3] * sphere[3] && (along >= 0.0f || square <= sphere[3] * sphere[3]);
}

static void tell(noh_stage *s, uint32_t index, const noh_stage_mesh *mesh, const noh_pick_hit *from, noh_stage_hit *hit)
{
    hit->actor = noh_stage_actor_at(s, index);
    hit->mesh = mesh->item.mesh;
    hit->submesh = from->submesh;
    hit->triangle = from->triangle;
    hit->joint = mesh->skinned && from->joint != NOH_NONE ? mesh->skin.joints[from->joint] : NOH_NONE;
    hit->distance = from->distance;
    memcpy(hit->bind_point, from->bind_point, sizeof hit->bind_point);
    memcpy(hit->barycentric, from->barycentric, sizeof hit->barycentric);
}

size_t noh_stage_pick_bytes(const noh_mesh *mesh, size_t *behind)
{
    const size_t bytes = (noh_pick_scratch_size(mesh) + 15u) & ~(size_t)15;
    noh_skin skin;
    if (behind) *behind = bytes;
    if (!(mesh->header->flags & NOH_MESH_DUAL_QUATERNION) ||
        noh_pack_skin_at(mesh->pack, mesh->header->skin, &skin, NULL))
        return noh_pick_scratch_size(mesh);
    return bytes + skin.header->joint_count * sizeof(noh_dual_quaternion);
}

/* A skinned mesh's matrices, and dual quaternions where they draw it. */
static void set_joints(noh_stage *s, const noh_stage_kind *k, uint32_t index, uint32_t m, noh_pick_surface *surface)
{
    const noh_stage_mesh *mesh = &k->meshes[m];
    size_t behind;
    noh_character_skin(noh_stage_character(k, index), &mesh->skin, s->jobs[0].matrices);
    noh_stage_move_far_joints(k, index, m, s->shown[k->first_actor + index].level, s->jobs[0].matrices);
    surface->matrices = s->jobs[0].matrices;
    if (mesh->mesh.header->flags & NOH_MESH_DUAL_QUATERNION) {
        noh_dual_quaternion *joints;
        (void)noh_stage_pick_bytes(&mesh->mesh, &behind);
        joints = (noh_dual_quaternion *)(void *)((uint8_t *)s->pick_scratch + behind);
        noh_skin_dual_quaternions(s->jobs[0].matrices, mesh->skin.header->joint_count, joints);
        surface->dual_quaternions = joints;
    }
}

/* The meshes of one actor, at the level that was drawn, with its targets where it has a slot for them. */
static void pick_actor(noh_stage *s, noh_stage_kind *k, uint32_t index, ray *r, noh_stage_hit *hit, int *found)
{
    const noh_character *ch = noh_stage_character(k, index - k->first_actor);
    const noh_stage_shown *shown = &s->shown[index];
    const float *weights = k->weights + (size_t)(index - k->first_actor) * k->weight_count;
    float origin[3], direction[3];
    if (!into(shown->world, r->origin, 1.0f, origin) || !into(shown->world, r->direction, 0.0f, direction)) return;
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        const noh_stage_mesh *mesh = &k->meshes[m];
        const noh_mesh level = noh_mesh_at_lod(&mesh->mesh, k->plan->levels[shown->level].mesh_levels[m]);
        noh_pick_surface surface;
        noh_pick_hit own;
        if (s->actors[index].look.hidden_meshes >> m & 1u) continue;
        if (mesh->skinned && !ch->time.posed) continue; /* it was cut since that frame */
        memset(&surface, 0, sizeof surface);
        surface.mesh = &level;
        surface.tint = noh_stage_tint_of(&s->actors[index]);
        surface.world = mesh->skinned ? NULL : mesh->node_world;
        if (shown->slot.pool != NOH_NONE) surface.weights = weights + mesh->first_weight;
        if (mesh->skinned) set_joints(s, k, index - k->first_actor, m, &surface);
        if (noh_pick(&surface, origin, direction, r->distance, s->pick_scratch, s->pick_bytes, &own, NULL) == NOH_OK) {
            r->distance = own.distance;
            tell(s, index, mesh, &own, hit);
            *found = 1;
        }
    }
}

noh_result noh_stage_pick(noh_stage *stage, const float origin[3], const float direction[3], float distance_max,
                          noh_stage_hit *hit, noh_error *error)
{
    ray r;
    int found = 0;
    float square = 0.0f;
    NOH_ASSERT(stage && origin && direction && hit);
    for (int i = 0; i < 3; i++) square += direction[i] * direction[i];
    if (!(square > 0.0f) || square - square != 0.0f || !(distance_max > 0.0f)) {
        return noh_fail(error, NOH_ERR_ARG, "the direction of a ray has no length, or its distance_max is not above 0",
                        0, 0);
    }
    for (int i = 0; i < 3; i++) r.origin[i] = origin[i] - stage->origin[i];
    memcpy(r.direction, direction, sizeof r.direction);
    r.distance = distance_max;
    for (uint32_t i = 0; i < stage->actor_count; i++) {
        noh_stage_kind *k = noh_stage_kind_of(stage, i);
        float sphere[4];
        if (!stage->actors[i].alive || k->desc->unpickable || stage->actors[i].look.hidden || !stage->shown[i].views ||
            stage->shown[i].frame != stage->frame)
            continue;
        if (noh_stage_actor_sphere(stage, noh_stage_actor_at(stage, i), sphere, NULL) == NOH_OK && meets(&r, sphere)) {
            pick_actor(stage, k, i, &r, hit, &found);
        }
    }
    if (!found) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "the ray hits no actor", 0, 0);
    }
    for (int i = 0; i < 3; i++) hit->point[i] = origin[i] + hit->distance * direction[i];
    return NOH_OK;
}
