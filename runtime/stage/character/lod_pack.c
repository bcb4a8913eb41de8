#include "core/base/assert_internal.h"
#include "motion/clip/clip_cache_internal.h"
#include "stage/character/bounds_internal.h"
#include "motion/bank/clip_bank_internal.h"
#include "stage/character/lod_pack_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/deform.h"
#include "noh/low_stage.h"
#include "noh/pack.h"

NOH_STATIC_ASSERT(NOH_CLIP_UPDATE_RATES == NOH_UPDATE_RATE_COUNT, clip_rates);

/* The resolved desc. */
typedef struct source {
    const noh_pack *const *packs; /* of clips */
    const noh_pack *pack;
    const uint32_t *levels; /* [level_count] joints */
    uint32_t level_count, skeleton, clip_count, joint_count;
    uint32_t mesh_level_count, target_count;
    int skinned; /* the mesh exists and is skinned */
} source;

/* The carved arrays; NULL while measuring. */
typedef struct parts {
    noh_lod_mesh *meshes;
    noh_lod_joints *joints;
    noh_lod_influences *influences; /* [INFLUENCE_LEVELS] */
    float *update_errors, *joint_radii, *target_radii;
} parts;

#define INFLUENCE_LEVELS 4u /* all, 4, 2, 1 */

/* ---- the desc ---- */

static int is_of_skeleton(const source *s, const noh_mesh *mesh)
{
    noh_skin skin;
    return mesh->pack->bytes == s->pack->bytes &&
           noh_pack_skin_at(s->pack, mesh->header->skin, &skin, NULL) == NOH_OK && skin.header->skeleton == s->skeleton;
}

/* The error message of the desc; NULL: valid. */
static const char *resolve(const noh_lod_pack_desc *desc, source *s)
{
    if (!desc->set) return "set is NULL";
    if (!desc->set_desc || (!desc->set_desc->clips && !(desc->set_desc->clip_packs && desc->set_desc->clip_pack_count)))
        return "set_desc is NULL, has no clips, or is not the desc of the set";
    s->packs = desc->set_desc->clips ? &desc->set_desc->clips : desc->set_desc->clip_packs;
    s->pack = desc->set_desc->mesh ? desc->set_desc->mesh : s->packs[0];
    s->skeleton = desc->set_desc->skeleton;
    s->clip_count = desc->set->clips.clip_count;
    s->joint_count = desc->set->skeleton.joint_count;
    s->levels = NULL;
    s->level_count = 0;
    if (s->joint_count) {
        s->levels = noh_pack_joint_levels(s->pack, s->skeleton, &s->level_count);
        if (!s->levels || s->levels[0] != s->joint_count)
            return "set_desc is NULL, has no clips, or is not the desc of the set";
    }
    s->mesh_level_count = desc->mesh ? desc->mesh->header->level_count : 0;
    s->target_count = desc->mesh ? desc->mesh->header->target_count : 0;
    s->skinned = desc->mesh && desc->mesh->header->skin != NOH_NONE;
    return s->skinned && !(s->joint_count && is_of_skeleton(s, desc->mesh))
               ? "the skeleton of the set does not move the mesh"
               : NULL;
}

static void carve(noh_arena *arena, const source *s, parts *p)
{
    p->meshes = (noh_lod_mesh *)noh_arena_carve(arena, s->mesh_level_count * sizeof *p->meshes, 4);
    p->influences = (noh_lod_influences *)noh_arena_carve(arena,
                                                          s->skinned ? INFLUENCE_LEVELS * sizeof *p->influences : 0, 4);
    p->joints = (noh_lod_joints *)noh_arena_carve(arena, s->level_count * sizeof *p->joints, 4);
    p->update_errors = (float *)noh_arena_carve(arena, s->clip_count * (size_t)NOH_UPDATE_RATE_COUNT * sizeof(float),
                                                4);
    p->joint_radii = (float *)noh_arena_carve(arena, s->skinned ? s->joint_count * sizeof(float) : 0, 4);
    p->target_radii = (float *)noh_arena_carve(arena, s->target_count * sizeof(float), 4);
}

size_t noh_lod_pack_size(const noh_lod_pack_desc *desc)
{
    noh_arena arena = noh_arena_measure();
    source s;
    parts p;
    NOH_ASSERT(desc);
    if (resolve(desc, &s)) {
        return 0;
    }
    carve(&arena, &s, &p);
    return arena.used;
}

/* ---- errors of clips ---- */

/* The factor that converts a clip's errors to metres, for vertices up to `radius` from their joints. A rotation error
 * grows with the distance and a translation error does not, so scaling by the ratio of distances bounds both. */
static float to_metres(const noh_pack *pack, const noh_clip_header *h, float radius)
{
    noh_skeleton skeleton;
    const noh_skeleton_header *of;
    float unit_m = 1.0f;
    if (noh_pack_skeleton_at(pack, h->skeleton, &skeleton, &of, NULL) == NOH_OK) {
        unit_m = of->unit_cm * 0.01f;
    }
    return h->error_shell > 0.0f && radius > h->error_shell ? unit_m * (radius / h->error_shell) : unit_m;
}

/* The error of a clip with this many joints: the error of its finest level with at most this many. -1: none. */
static float joint_error(const noh_pack *pack, const noh_pack_clip *clip, uint32_t joint_count)
{
    uint32_t level_count;
    const uint32_t *levels = noh_pack_joint_levels(pack, clip->header->skeleton, &level_count);
    for (uint32_t i = 0; levels && i < level_count; i++) {
        if (levels[i] <= joint_count) {
            return clip->joint_errors[i];
        }
    }
    return -1.0f;
}

/* Raise the errors of the levels to the clip's errors; drop levels for which the clip has no error. */
static void add_joint_errors(const noh_pack *pack, const noh_pack_clip *clip, float metres, noh_lod_joints *levels,
                             uint32_t *level_count)
{
    for (uint32_t i = 0; i < *level_count; i++) {
        const float error = joint_error(pack, clip, levels[i].joint_count) * metres;
        if (error < 0.0f) {
            *level_count = i;
        } else if (error > levels[i].error_m) {
            levels[i].error_m = error;
        }
    }
}

#define UNKNOWN_M 1e6f

/* How many times as large the skeleton is as the one of a clip that plays through the bank's map. */
static float size_by_map(const noh_clip_bank *bank, const source *s, const noh_pack *pack, const noh_clip_header *h)
{
    noh_skeleton skeleton;
    const noh_skeleton_header *own, *other;
    if (noh_pack_skeleton_at(s->pack, s->skeleton, &skeleton, &own, NULL) ||
        noh_pack_skeleton_at(pack, h->skeleton, &skeleton, &other, NULL))
        return 1.0f;
    return bank->map->ratio * (float)(own->unit_cm / other->unit_cm);
}

/* The update errors of each clip, the joint errors of all clips, and the largest error of their compression. radius:
 * the largest joint radius of the mesh. */
static void fill_clips(const noh_lod_pack_desc *desc, const source *s, float radius, parts *p, noh_lod_table *table)
{
    for (uint32_t m = 0; m < s->clip_count; m++) {
        const noh_pack *pack = s->packs[desc->set->packs[m]];
        noh_pack_clip clip;
        noh_clip_info info;
        float metres, clip_error_m;
        (void)noh_pack_clip_at(pack, desc->set->pack_clips[m], &clip, NULL);
        metres = to_metres(pack, clip.header, radius);
        const int is_mapped = !NOH_PAGE && desc->set->bound[m].is_mapped;
        for (uint32_t r = 0; r < NOH_UPDATE_RATE_COUNT; r++) {
            /* what a map makes of poses between frames is not known */
            p->update_errors[m * (uint32_t)NOH_UPDATE_RATE_COUNT + r] = is_mapped ? r ? UNKNOWN_M : 0.0f
                                                                                  : clip.header->update_rate_error[r] *
                                                                                        metres;
        }
        if (is_mapped) {
            if (table->joint_level_count > 1u) table->joint_level_count = 1;
        } else if (clip.header->joint_count) {
            add_joint_errors(pack, &clip, metres, p->joints, &table->joint_level_count);
        }
        noh_clip_info_of(noh_clip_cache_clip(desc->set->cache, m), &info);
        clip_error_m = (float)info.max_error_cm * 0.01f *
                       (is_mapped ? size_by_map(desc->set, s, pack, clip.header) : 1.0f);
        table->clip_error_m = clip_error_m > table->clip_error_m ? clip_error_m : table->clip_error_m;
    }
}

/* ---- meshes ---- */

/* The worst error of a level in any pose, including the targets that the level drops; metres. */
static float level_error(const noh_mesh_header *h)
{
    const float errors[4] = { h->level_error_rest, h->level_error_targets, h->level_error_pairs, h->level_error_clip };
    float worst = 0.0f;
    for (unsigned i = 0; i < 4; i++) {
        worst = errors[i] > worst ? errors[i] : worst;
    }
    return (worst + h->level_skipped) * h->world_scale;
}

/* Errors are distances to the full mesh, whichever level is the finest loaded. */
void noh_lod_mesh_levels(const noh_mesh *mesh, noh_lod_mesh *levels, noh_lod_table *table)
{
    NOH_ASSERT(mesh && levels && table && mesh->header->level_count <= NOH_LOD_LEVELS_MAX);
    for (uint32_t k = 0; k < mesh->header->level_count; k++) {
        const noh_mesh level = noh_mesh_at_lod(mesh, k);
        levels[k].vertex_count = level.header->vertex_count;
        levels[k].triangle_count = level.header->index_count / 3u;
        levels[k].influence_count = level.header->influence_count;
        levels[k].error_m = level_error(level.header);
    }
    table->meshes = levels;
    table->mesh_level_count = mesh->header->level_count;
    table->mesh_level_first = mesh->header->level;
}

void noh_lod_target_radii(const noh_mesh *mesh, float *radius_m)
{
    NOH_ASSERT(mesh && (radius_m || !mesh->header->target_count));
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        radius_m[t] = mesh->targets[t].radius * mesh->header->world_scale;
    }
}

/* A mesh that was built without levels has no errors for fewer influences, so all are always used. */
static uint32_t fill_influences(const noh_mesh_header *h, noh_lod_influences *levels)
{
    uint32_t count = 0;
    levels[count].influence_count = h->influence_count;
    levels[count++].error_m = 0.0f;
    for (uint32_t i = 0; i < INFLUENCE_LEVELS - 1u && h->level_count > 1u; i++) {
        if (4u >> i < h->influence_count) {
            levels[count].influence_count = 4u >> i;
            levels[count++].error_m = h->influence_errors[i] * h->world_scale;
        }
    }
    return count;
}

/* ---- filling ---- */

/* The joint radii of the mesh. Returns the largest, 0 without a skinned mesh. */
static float fill_joint_radii(const noh_lod_pack_desc *desc, const source *s, float *radii)
{
    float largest = 0.0f;
    for (uint32_t j = 0; s->skinned && j < s->joint_count; j++) {
        radii[j] = -1.0f;
    }
    if (s->skinned) {
        noh_mesh_add_joint_radii(desc->mesh, desc->weights, radii);
    }
    for (uint32_t j = 0; s->skinned && j < s->joint_count; j++) {
        largest = radii[j] > largest ? radii[j] : largest;
    }
    return largest;
}

static void fill(const noh_lod_pack_desc *desc, const source *s, parts *p, noh_lod_pack *lod)
{
    static const noh_lod_pack empty;
    *lod = empty;
    for (uint32_t i = 0; i < s->level_count; i++) {
        p->joints[i].joint_count = s->levels[i];
        p->joints[i].error_m = 0.0f;
    }
    if (desc->mesh) {
        lod->radius_m = p->target_radii;
        noh_lod_target_radii(desc->mesh, p->target_radii);
        noh_lod_mesh_levels(desc->mesh, p->meshes, &lod->table);
    }
    if (s->skinned) {
        lod->table.influences = p->influences;
        lod->table.influence_level_count = fill_influences(desc->mesh->header, p->influences);
    }
    lod->joint_radius_m = s->skinned ? p->joint_radii : NULL;
    lod->table.joints = p->joints;
    lod->table.joint_level_count = s->level_count;
    lod->table.update_error_m = p->update_errors;
    fill_clips(desc, s, fill_joint_radii(desc, s, p->joint_radii), p, &lod->table);
}

noh_result noh_lod_pack_init(void *memory, size_t bytes, const noh_lod_pack_desc *desc, noh_lod_pack *lod,
                             noh_error *error)
{
    NOH_ASSERT(desc && lod);
    noh_arena arena;
    noh_result result;
    source s;
    parts p;
    const char *what = resolve(desc, &s);
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, 0, 0);
    }
    result = noh_arena_open(&arena, memory, bytes, noh_lod_pack_size(desc), error);
    if (result != NOH_OK) {
        return result;
    }
    carve(&arena, &s, &p);
    fill(desc, &s, &p, lod);
    return NOH_OK;
}
