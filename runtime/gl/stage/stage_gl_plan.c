/* stage_gl_plan.c: memory of a stage on the GPU, and on the CPU for it; which kinds share a mesh. */
#include <string.h>

#include "gl/stage/stage_gl_internal.h"
#include "core/base/assert_internal.h"
#include "gl/morph/gl_morph_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/low_gl.h"

/* ---- sites ---- */

int noh_gl_next_site(const noh_stage_plan *plan, uint32_t kind_count, noh_gl_site *site)
{
    if (site->kind == UINT32_MAX) {
        site->kind = site->item = 0;
    } else {
        site->item++;
    }
    while (site->kind < kind_count && site->item >= plan->kinds[site->kind].mesh_count) { /* empty slots have none */
        site->item = 0;
        site->kind++;
    }
    return site->kind < kind_count;
}

static uint32_t mesh_of(const noh_stage_plan *plan, noh_gl_site site)
{
    return plan->kinds[site.kind].meshes[site.item];
}

static uint32_t finest_of(const noh_stage_plan *plan, noh_gl_site site)
{
    const noh_kind_plan *k = &plan->kinds[site.kind];
    return k->levels[k->finest_level].mesh_levels[site.item];
}

noh_mesh noh_gl_as_lit(const noh_stage_desc *desc, const noh_mesh *mesh, uint32_t level)
{
    noh_mesh at = noh_mesh_at_lod(mesh, level);
    if (!desc->light || desc->without_transfer) at.transfer = NULL;
    return at;
}

noh_mesh noh_gl_site_mesh(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_gl_site site)
{
    const noh_mesh mesh = noh_stage_whole_mesh(&desc->kinds[site.kind], mesh_of(plan, site));
    return noh_gl_as_lit(desc, &mesh, finest_of(plan, site));
}

int noh_gl_site_coarse(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_gl_site site, noh_mesh *coarse)
{
    noh_mesh mesh;
    (void)noh_pack_mesh_at(desc->kinds[site.kind].mesh, mesh_of(plan, site), &mesh, NULL);
    *coarse = noh_gl_as_lit(desc, &mesh, finest_of(plan, site));
    return coarse->header->level > finest_of(plan, site) && desc->kinds[site.kind].finer;
}

static int same_mesh(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_gl_site a, noh_gl_site b)
{
    if (a.kind != b.kind && (desc->kinds[a.kind].changes || desc->kinds[b.kind].changes)) return 0;
    return desc->kinds[a.kind].mesh->bytes == desc->kinds[b.kind].mesh->bytes &&
           noh_stage_load_kind(desc, a.kind) == noh_stage_load_kind(desc, b.kind) &&
           mesh_of(plan, a) == mesh_of(plan, b) && finest_of(plan, a) == finest_of(plan, b);
}

static uint32_t pool_count(const noh_stage_plan *plan, uint32_t kind)
{
    uint32_t levels[NOH_LOD_LEVELS_MAX], slots[NOH_LOD_LEVELS_MAX];
    return noh_stage_pools(&plan->kinds[kind], levels, slots);
}

/* Whether the sites that draw a mesh share its model: unless they have too many pools. */
static int is_shared(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_gl_site of)
{
    noh_gl_site site = { UINT32_MAX, UINT32_MAX };
    uint32_t pools = 0;
    while (noh_gl_next_site(plan, desc->kind_count, &site)) {
        if (same_mesh(desc, plan, site, of)) pools += pool_count(plan, site.kind);
    }
    return pools <= NOH_MODEL_POOLS_MAX;
}

noh_gl_site noh_gl_owner(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_gl_site site)
{
    noh_gl_site other = { UINT32_MAX, UINT32_MAX };
    if (!is_shared(desc, plan, site)) {
        return site;
    }
    while (noh_gl_next_site(plan, desc->kind_count, &other) && !same_mesh(desc, plan, other, site)) {}
    return other;
}

static int is_same(noh_gl_site a, noh_gl_site b)
{
    return a.kind == b.kind && a.item == b.item;
}

/* ---- accumulators ---- */

static void add_tiles(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_gl_site site, noh_gl_tiles *out)
{
    const noh_kind_plan *k = &plan->kinds[site.kind];
    uint32_t levels[NOH_LOD_LEVELS_MAX], slots[NOH_LOD_LEVELS_MAX];
    const uint32_t count = noh_stage_pools(k, levels, slots);
    const noh_mesh mesh = noh_gl_site_mesh(desc, plan, site);
    for (uint32_t i = 0; i < count; i++) {
        NOH_ASSERT(out->count < NOH_MODEL_POOLS_MAX);
        out->meshes[out->count] = noh_mesh_at_lod(&mesh, k->levels[levels[i]].mesh_levels[site.item]);
        out->counts[out->count++] = desc->motion ? 2u * slots[i] : slots[i]; /* stage_motion.c */
    }
}

/* Whether the path cpu may finish vertices. One renderer draws the whole stage, so it applies to all meshes or none. */
static int takes_vertices(const noh_stage_desc *desc, const noh_stage_plan *plan)
{
    noh_gl_site site = { UINT32_MAX, UINT32_MAX };
    int takes = !desc->morph_sums && !desc->motion && desc->halves <= 0 && !noh_stage_has_slots(desc);
    while (takes && noh_gl_next_site(plan, desc->kind_count, &site)) {
        const noh_mesh mesh = noh_gl_site_mesh(desc, plan, site);
        noh_mesh coarse;
        if (!mesh.header->touched_count) continue;
        takes = !mesh.transfer && !(mesh.header->flags & NOH_MESH_UV_TARGETS) &&
                desc->kinds[site.kind].actor_count == 1u && !noh_gl_site_coarse(desc, plan, site, &coarse);
    }
    return takes;
}

void noh_gl_tiles_of(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_gl_site owner, noh_gl_tiles *out)
{
    noh_gl_site site = { UINT32_MAX, UINT32_MAX };
    const int shared = is_shared(desc, plan, owner);
    out->count = 0;
    out->vertices = takes_vertices(desc, plan);
    out->comes_later = noh_gl_site_coarse(desc, plan, owner, &out->coarse);
    while (noh_gl_next_site(plan, desc->kind_count, &site)) {
        if (shared ? same_mesh(desc, plan, site, owner) : is_same(site, owner)) add_tiles(desc, plan, site, out);
    }
}

uint32_t noh_gl_first_pool(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_gl_site site)
{
    noh_gl_site other = { UINT32_MAX, UINT32_MAX };
    uint32_t first = 0;
    if (!is_shared(desc, plan, site)) {
        return 0;
    }
    while (noh_gl_next_site(plan, desc->kind_count, &other) && !is_same(other, site)) {
        if (same_mesh(desc, plan, other, site)) first += pool_count(plan, other.kind);
    }
    return first;
}

noh_gl_morph_desc noh_gl_site_morph(const noh_stage_desc *desc, const noh_gl_tiles *tiles)
{
    noh_gl_morph_desc d;
    memset(&d, 0, sizeof d);
    d.meshes = tiles->meshes;
    d.mesh_count = tiles->count;
    d.instance_counts = tiles->counts;
    d.coarse = tiles->comes_later ? &tiles->coarse : NULL;
    if (tiles->comes_later) {
        uint32_t finest = 0;
        for (uint32_t i = 1; i < tiles->count; i++) {
            if (tiles->meshes[i].header->level < tiles->meshes[finest].header->level) finest = i;
        }
        d.later_blocks = noh_gl_morph_blocks(&tiles->meshes[finest]);
        d.later_strips = noh_gl_morph_strips(&tiles->meshes[finest]);
    }
    d.path = (noh_morph_path)desc->morph_path;
    d.draws = desc->light && desc->light->shadow_px ? 2u : 1u;
    d.without_tangents = !desc->tangents;
    d.vertices = tiles->vertices;
    d.accumulate = desc->halves > 0 ? NOH_ACCUMULATE_F16 : desc->halves < 0 ? NOH_ACCUMULATE_F32 : NOH_ACCUMULATE_AUTO;
    return d;
}

noh_result noh_gl_site_plan(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_gl_site owner,
                            const noh_gl_caps *caps, int without_direct, noh_gl_morph_plan *out, noh_error *error)
{
    noh_gl_tiles tiles;
    noh_gl_morph_desc d;
    noh_gl_tiles_of(desc, plan, owner, &tiles);
    d = noh_gl_site_morph(desc, &tiles);
    d.without_direct = without_direct;
    return noh_gl_morph_plan_make(&d, caps, out, error);
}

int noh_gl_sums_in_draws(const noh_stage_desc *desc, const noh_stage_plan *plan, const noh_gl_caps *caps)
{
    noh_gl_site site = { UINT32_MAX, UINT32_MAX };
    int any = 0;
    if (desc->morph_path || plan->morph_path) {
        return (desc->morph_path ? desc->morph_path : plan->morph_path) == NOH_MORPH_DIRECT;
    }
    while (noh_gl_next_site(plan, desc->kind_count, &site)) {
        noh_gl_morph_plan p;
        if (!is_same(noh_gl_owner(desc, plan, site), site) ||
            !noh_gl_site_mesh(desc, plan, site).header->touched_count) {
            continue;
        }
        if (noh_gl_site_plan(desc, plan, site, caps, 0, &p, NULL) || p.path != NOH_MORPH_DIRECT) return 0;
        any = 1;
    }
    return any;
}
