/* stage_levels.c: the levels of an actor. Each selects a level of every mesh.
 *
 * Meshes of one figure need different numbers of triangles for the same error: a head has small features, but a body
 * bends. Drawing all of them at the same level number spends triangles where they show least. So the errors of all
 * levels of all meshes are sorted, and for each of them every mesh takes its coarsest level within that error. */
#include "stage/cast/stage_internal.h"
#include "stage/character/lod_pack_internal.h"
#include "noh/base.h"
#include "noh/pack.h"
#include "noh/noh.h"
#include "noh/low_stage.h"

#define ERRORS_MAX (NOH_STAGE_MESHES_MAX * NOH_LOD_LEVELS_MAX)
#define SPREAD_M 100.0f /* actors are thought to be spread evenly within this distance */
#define RESERVE 1.3f    /* for actors that crowd together */
#define FINEST_MIN 16u  /* least slots of the finest level for large kinds: a small cast stands close together */
#define MESH_SHARE 0.3f /* of the error, as low_stage.h has it by default */

float noh_stage_mesh_error(const noh_mesh *mesh, uint32_t level)
{
    noh_lod_mesh levels[NOH_LOD_LEVELS_MAX];
    noh_lod_table table;
    noh_lod_mesh_levels(mesh, levels, &table);
    return levels[level < table.mesh_level_count ? level : table.mesh_level_count - 1u].error_m;
}

typedef struct finder {
    const noh_kind_desc *kind;
    noh_stage_item items[NOH_STAGE_MESHES_MAX];
    uint32_t item_count;
    float errors[ERRORS_MAX];       /* rising */
    uint32_t triangles[ERRORS_MAX]; /* of the figure that is off by no more than that */
    uint32_t count;
} finder;

static noh_mesh mesh_of(const finder *f, uint32_t item)
{
    return noh_stage_whole_mesh(f->kind, f->items[item].mesh);
}

/* The coarsest level of a mesh that is off by no more than this; the finest where none is. */
static uint32_t coarsest(const noh_mesh *mesh, float error_m)
{
    uint32_t level = mesh->header->level_count - 1u;
    while (level && noh_stage_mesh_error(mesh, level) > error_m) {
        level--;
    }
    return level;
}

static void insert(finder *f, float error_m)
{
    uint32_t i = f->count;
    for (uint32_t k = 0; k < f->count; k++) {
        if (f->errors[k] >= error_m && f->errors[k] <= error_m) return;
    }
    f->errors[f->count++] = error_m;
    for (; i && f->errors[i - 1u] > error_m; i--) {
        f->errors[i] = f->errors[i - 1u];
        f->errors[i - 1u] = error_m;
    }
}

static void drop(finder *f, uint32_t i)
{
    const float error_m = f->errors[i];
    f->count--;
    for (; i < f->count; i++) { /* exchanged, not shifted: compilers make a call of memmove out of that */
        f->errors[i] = f->errors[i + 1u];
        f->errors[i + 1u] = error_m;
        f->triangles[i] = f->triangles[i + 1u];
        f->triangles[i + 1u] = 0;
    }
}

/* All errors that lie between what the finest levels have anyway and what the coarsest have. */
static void collect(finder *f)
{
    float least = 0.0f;
    for (uint32_t i = 0; i < f->item_count; i++) {
        const noh_mesh mesh = mesh_of(f, i);
        const float error_m = noh_stage_mesh_error(&mesh, 0);
        least = error_m > least ? error_m : least;
    }
    insert(f, least);
    for (uint32_t i = 0; i < f->item_count; i++) {
        const noh_mesh mesh = mesh_of(f, i);
        for (uint32_t k = 1; k < mesh.header->level_count; k++) {
            const float error_m = noh_stage_mesh_error(&mesh, k);
            if (error_m > least) insert(f, error_m);
        }
    }
}

/* By number: level e of each mesh, or its coarsest. An error is at least the previous level's error. */
static void collect_by_number(finder *f)
{
    for (uint32_t e = 0; e < NOH_LOD_LEVELS_MAX; e++) {
        float most = e ? f->errors[e - 1u] : 0.0f;
        int is_there = e == 0;
        for (uint32_t i = 0; i < f->item_count; i++) {
            const noh_mesh mesh = mesh_of(f, i);
            const float error_m = noh_stage_mesh_error(&mesh, e);
            is_there |= e < mesh.header->level_count;
            most = error_m > most ? error_m : most;
        }
        if (!is_there) return;
        f->errors[f->count++] = most;
    }
}

/* The level of a mesh in level e of the actor. */
static uint32_t level_of(const finder *f, const noh_mesh *mesh, uint32_t e)
{
    const uint32_t last = mesh->header->level_count - 1u;
    return !f->kind->levels_by_number ? coarsest(mesh, f->errors[e]) : e < last ? e : last;
}

/* The finest level that a pack of coarser levels alone still has. */
static uint32_t first_of(const finder *f)
{
    uint32_t first = f->item_count ? NOH_LOD_LEVELS_MAX : 0;
    for (uint32_t i = 0; i < f->item_count; i++) {
        const noh_mesh mesh = mesh_of(f, i);
        if (mesh.header->level_first < first) first = mesh.header->level_first;
    }
    return first;
}

static void count_triangles(finder *f)
{
    for (uint32_t e = 0; e < f->count; e++) {
        f->triangles[e] = 0;
        for (uint32_t i = 0; i < f->item_count; i++) {
            const noh_mesh mesh = mesh_of(f, i);
            const noh_mesh level = noh_mesh_at_lod(&mesh, level_of(f, &mesh, e));
            f->triangles[e] += level.header->index_count / 3u;
        }
    }
}

/* Leave out what saves no triangle against the level before, then what saves the fewest, until the rest fits. */
static void thin_out(finder *f)
{
    for (;;) {
        uint32_t worst = 0, least = UINT32_MAX;
        for (uint32_t e = 1; e < f->count; e++) {
            const uint32_t saved = f->triangles[e - 1u] - f->triangles[e];
            if (saved < least) {
                least = saved;
                worst = e;
            }
        }
        if (!worst || (least && f->count <= NOH_LOD_LEVELS_MAX)) {
            return;
        }
        drop(f, worst);
    }
}

static void write_level(const finder *f, uint32_t e, noh_actor_level *level)
{
    level->error_m = f->errors[e];
    level->triangle_count = f->triangles[e];
    for (uint32_t i = 0; i < f->item_count; i++) {
        const noh_mesh mesh = mesh_of(f, i);
        level->mesh_levels[i] = (uint8_t)level_of(f, &mesh, e);
    }
}

noh_result noh_stage_find_levels(const noh_stage_desc *desc, uint32_t kind, noh_kind_plan *plan, noh_error *error)
{
    const noh_kind_desc d = noh_stage_kind_desc(desc, kind);
    uint32_t finest = d.finest_level;
    finder f;
    f.kind = &d;
    f.count = 0;
    f.item_count = noh_stage_items(&d, f.items);
    if (f.item_count == 0 && desc->gpu) {
        return noh_fail(error, NOH_ERR_ARG, "a kind draws nothing: its mesh pack has no mesh of that skeleton", kind,
                        0);
    }
    if (d.levels_by_number) {
        collect_by_number(&f);
        finest = finest > first_of(&f) ? finest : first_of(&f);
    } else {
        collect(&f);
    }
    count_triangles(&f);
    if (!d.levels_by_number) thin_out(&f);
    plan->mesh_count = f.item_count;
    for (uint32_t i = 0; i < f.item_count; i++) plan->meshes[i] = f.items[i].mesh;
    plan->level_count = f.count;
    plan->finest_level = finest < f.count ? finest : f.count - 1u;
    for (uint32_t e = 0; e < f.count; e++) {
        write_level(&f, e, &plan->levels[e]);
    }
    return NOH_OK;
}

/* ---- slots ---- */

/* desc: with its defaults filled in. Of actors that are spread evenly, how many are nearer than where a level begins to
 * be good enough. */
static uint32_t count_within(const noh_stage_desc *desc, uint32_t actors, float error_m)
{
    const float pixels = desc->lod.pixels * MESH_SHARE;
    const float distance_m = error_m * noh_lod_scale(1.0f, NOH_STAGE_VIEW_RAD, desc->height_px) / pixels;
    const float share = distance_m / SPREAD_M;
    const float count = RESERVE * (float)actors * share * share + 1.0f;
    return share < 1.0f && count < (float)actors ? (uint32_t)count : actors;
}

/* Each level from the finest on gets slots until every actor that is seen has one; the coarsest takes the rest. */
void noh_stage_share_slots(const noh_stage_desc *desc, uint32_t kind, noh_kind_plan *plan)
{
    const noh_kind_desc d = noh_stage_kind_desc(desc, kind);
    const int promised = d.near_count || d.middle_count;
    uint32_t left = d.visible_max, taken = 0;
    for (uint32_t l = 0; l < plan->level_count; l++) {
        noh_actor_level *level = &plan->levels[l];
        uint32_t wanted = 0;
        if (l + 1u >= plan->level_count) {
            wanted = left;
        } else if (l >= plan->finest_level) {
            const uint32_t within = count_within(desc, d.actor_count, plan->levels[l + 1u].error_m);
            wanted = within > taken ? within - taken : 0;
            if (l == plan->finest_level && wanted < FINEST_MIN) wanted = FINEST_MIN;
            if (promised && l == plan->finest_level) wanted = d.near_count;
            if (promised && l == plan->finest_level + 1u) wanted = d.middle_count;
        }
        level->slot_count = wanted < left ? wanted : left;
        left -= level->slot_count;
        taken += level->slot_count;
    }
}
