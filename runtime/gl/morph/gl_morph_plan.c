/* gl_morph_plan.c: chooses the path, the layout of the data and its exact bytes, before anything is created.
 *
 * The atlas is the texture array whose layers take the sums. Each mesh of the desc has a band of it, and each instance
 * a tile in its mesh's band. The tables hold constant data, the delta texels and their destinations, once per mesh for
 * any number of instances. The stream and the staging memory hold the data sent by one update. They are large enough
 * for every target of every instance to be active at once, so an update never runs out of memory. */
#include <string.h>

#include "gl/morph/gl_morph_internal.h"
#include "gl/device/gl_names_internal.h"
#include "core/base/assert_internal.h"
#include "deform/morph/morph_internal.h"
#include "gl/device/gl_quirks_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

static const char *const path_names[NOH_MORPH_PATH_COUNT] = { "auto", "layered", "mrt",     "per-layer", "gather",
                                                              "cpu",  "blend",   "streams", "direct" };

const char *noh_morph_path_name(noh_morph_path path)
{
    return path_names[(unsigned)path < NOH_MORPH_PATH_COUNT ? path : 0];
}

const char *noh_accumulate_name(noh_accumulate accumulate)
{
    return accumulate == NOH_ACCUMULATE_F32 ? "f32" : accumulate == NOH_ACCUMULATE_F16 ? "f16" : "auto";
}

/* ---- choosing the path ---- */

static int blends(noh_morph_path path)
{
    return path == NOH_MORPH_LAYERED || path == NOH_MORPH_MRT || path == NOH_MORPH_PER_LAYER;
}

/* NULL if the path runs on this GPU, otherwise the missing capability. */
static const char *missing(noh_morph_path path, noh_accumulate accumulate, const noh_gl_caps *caps)
{
    int half = accumulate == NOH_ACCUMULATE_F16;
    if (path == NOH_MORPH_CPU) {
        return NULL;
    }
    if (path == NOH_MORPH_STREAMS || path == NOH_MORPH_DIRECT) {
        return half ? "the paths streams and direct sum in f32 in the vertex shader: they do not support f16" : NULL;
    }
    if (path == NOH_MORPH_GATHER) {
        if (!caps->mrt3) {
            return "gather needs three draw buffers into one texture array";
        }
        if (half) {
            return caps->render_f16
                       ? NULL
                       : "gather in f16 needs renderable RGBA16F (EXT_color_buffer_half_float or EXT_color_buffer_float)";
        }
        return caps->render_f32 || caps->render_u32 ? NULL : "gather needs renderable RGBA32F or RGBA32UI";
    }
    if (!(half ? caps->blend_f16 : caps->blend_f32)) {
        return half ? "cannot blend into RGBA16F on this GPU (EXT_color_buffer_half_float or EXT_color_buffer_float)"
                    : "cannot blend into RGBA32F on this GPU (EXT_color_buffer_float and EXT_float_blend)";
    }
    if (path == NOH_MORPH_LAYERED && !caps->layered) {
        return "no layered drawing on this GPU (geometry shader with gl_Layer: ES 3.2 or EXT_geometry_shader)";
    }
    if (path == NOH_MORPH_MRT && !caps->mrt3) {
        return "mrt needs three draw buffers into one texture array";
    }
    return NULL;
}

/* The cheapest path on a GPU by the model of gl_morph_cost.c. layered and per-layer do more work than mrt, so they are
 * never cheaper. */
static noh_morph_path cheapest_on_gpu(const noh_gl_morph_plan *plan, const noh_gl_caps *caps, const char **reason)
{
    const noh_accumulate accumulate = plan->accumulate;
    const int can_mrt = !missing(NOH_MORPH_MRT, accumulate, caps);
    const int can_gather = !missing(NOH_MORPH_GATHER, accumulate, caps);
    const noh_gl_quirk *dear = noh_gl_quirk_find(caps->renderer, NOH_QUIRK_BLEND_DEAR);
    if (can_gather && dear) {
        *reason = dear->reason;
        return NOH_MORPH_GATHER;
    }
    if (can_gather && (!can_mrt || plan->costs.gather <= plan->costs.mrt)) {
        *reason = can_mrt ? "gather: cheaper than blending for the expected targets"
                          : "gather: this GPU cannot blend into this format";
        return NOH_MORPH_GATHER;
    }
    if (can_mrt) {
        *reason = can_gather ? "mrt: cheaper than summing whole blocks, because rectangles are small"
                             : "mrt: this format can only be blended on this GPU";
        return NOH_MORPH_MRT;
    }
    if (!missing(NOH_MORPH_PER_LAYER, accumulate, caps)) {
        *reason = "per-layer: this GPU can blend, but not into three draw buffers";
        return NOH_MORPH_PER_LAYER;
    }
    *reason = "cpu: this GPU cannot render to this format";
    return NOH_MORPH_CPU;
}

/* The policy `blend`: one draw if a geometry shader can send a triangle to each of the three layers, else a pass for
 * each. If the GPU cannot blend into the format, the check of per-layer reports it. */
static noh_morph_path blending_path(noh_accumulate accumulate, const noh_gl_caps *caps, const char **reason)
{
    if (!missing(NOH_MORPH_LAYERED, accumulate, caps)) {
        *reason = "layered: one additive draw into all three layers";
        return NOH_MORPH_LAYERED;
    }
    *reason = "per-layer: three additive passes, because this GPU cannot draw layered";
    return NOH_MORPH_PER_LAYER;
}

static uint32_t has_occlusion(const noh_gl_morph_desc *desc);
static int lists_fit(const noh_gl_morph_desc *desc);

static int has_uv_targets(const noh_gl_morph_desc *desc)
{
    int has = 0;
    for (uint32_t i = 0; i < desc->mesh_count; i++) has |= (desc->meshes[i].header->flags & NOH_MESH_UV_TARGETS) != 0;
    return has;
}

static const char *missing_of_streams(const noh_gl_morph_desc *desc)
{
    if (desc->coarse) return "the path streams cannot load levels later: pass all levels";
    if (has_uv_targets(desc)) return "the path streams does not support targets that move texture coordinates";
    return has_occlusion(desc) ? "the path streams does not support changes of occlusion (transfer)" : NULL;
}

/* Whether the draws themselves should sum, in place of the cheapest path with sums. */
static int direct_is_cheaper(const noh_gl_morph_desc *desc, const noh_gl_morph_plan *plan)
{
    const noh_gl_morph_costs *c = &plan->costs;
    const float other = plan->path == NOH_MORPH_GATHER ? c->gather
                        : plan->path == NOH_MORPH_MRT  ? c->mrt
                        : plan->path == NOH_MORPH_CPU  ? c->cpu
                                                       : c->per_layer;
    return !desc->without_direct && !missing(NOH_MORPH_DIRECT, plan->accumulate, NULL) && lists_fit(desc) &&
           c->direct < other;
}

static noh_result choose_path(const noh_gl_morph_desc *desc, const noh_gl_caps *caps, noh_gl_morph_plan *plan,
                              noh_error *error)
{
    const char *lacking;
    plan->accumulate = desc->accumulate == NOH_ACCUMULATE_F16 ? NOH_ACCUMULATE_F16 : NOH_ACCUMULATE_F32;
    plan->layer_count = desc->without_tangents ? 2u : 3u;
    noh_gl_morph_weigh(desc, caps, plan);
    plan->path = desc->path;
    plan->reason = "chosen by the desc";
    if (desc->path == NOH_MORPH_AUTO) {
        const noh_gl_quirk *software = noh_gl_quirk_find(caps->renderer, NOH_QUIRK_SOFTWARE);
        if (plan->pair_count == 0) {
            plan->path = NOH_MORPH_CPU;
            plan->reason = "cpu: no target moves a vertex";
        } else if (software) {
            plan->path = NOH_MORPH_CPU;
            plan->reason = software->reason;
        } else {
            plan->path = cheapest_on_gpu(plan, caps, &plan->reason);
            if (direct_is_cheaper(desc, plan)) {
                plan->path = NOH_MORPH_DIRECT;
                plan->reason = "direct: cheaper to add the expected targets in each draw than in a pass";
            }
        }
    } else if (desc->path == NOH_MORPH_BLEND) {
        plan->path = blending_path(plan->accumulate, caps, &plan->reason);
    }
    lacking = missing(plan->path, plan->accumulate, caps);
    if (!lacking && plan->path == NOH_MORPH_STREAMS) lacking = missing_of_streams(desc);
    if (lacking) {
        return noh_fail(error, NOH_ERR_UNSUPPORTED, lacking, 0, 0);
    }
    return NOH_OK;
}

int noh_gl_morph_finishes(const noh_gl_morph_desc *desc, noh_accumulate accumulate)
{
    return desc->vertices && accumulate != NOH_ACCUMULATE_F16 && !has_occlusion(desc) && !desc->coarse &&
           !has_uv_targets(desc);
}

/* Buffers in the ring of finished vertices. A software rasteriser is at most one frame behind, and two buffers stay in
 * its caches; a GPU may be two frames behind. */
static uint32_t vertex_ring(const noh_gl_morph_desc *desc, const noh_gl_caps *caps, const noh_gl_morph_plan *plan)
{
    if (plan->path != NOH_MORPH_CPU || !plan->pair_count || !noh_gl_morph_finishes(desc, plan->accumulate)) return 0;
    return noh_gl_quirk_find(caps->renderer, NOH_QUIRK_SOFTWARE) ? 2u : NOH_VERTEX_RING_MAX;
}

static GLenum layer_format(const noh_gl_morph_plan *plan, const noh_gl_caps *caps)
{
    int half = plan->accumulate == NOH_ACCUMULATE_F16;
    if (plan->path == NOH_MORPH_STREAMS || plan->path == NOH_MORPH_DIRECT || plan->vertex_ring) return 0;
    if (plan->path == NOH_MORPH_CPU) {
        if (plan->occlusion) return half ? GL_RGBA16F : GL_RGBA32F;
        return half ? GL_RGB16F : GL_RGB32F; /* never rendered to, so three components are enough */
    }
    if (half) {
        return GL_RGBA16F;
    }
    return caps->render_f32 ? GL_RGBA32F : GL_RGBA32UI;
}

void noh_gl_morph_set_formats(const noh_gl_caps *caps, noh_gl_morph_plan *plan)
{
    const int software = noh_gl_quirk_find(caps->renderer, NOH_QUIRK_SOFTWARE) != NULL;
    plan->layer_format = layer_format(plan, caps);
    plan->wide = plan->occlusion || software;
    plan->points = plan->path != NOH_MORPH_LAYERED && blends(plan->path) && caps->block_points && software;
}

int noh_gl_morph_has_program(noh_morph_path path)
{
    return blends(path) || path == NOH_MORPH_GATHER;
}

/* ---- sizes ---- */

static noh_result check_desc(const noh_gl_morph_desc *desc, noh_error *error)
{
    uint64_t instances = 0;
    if (!desc->meshes || !desc->mesh_count) {
        return noh_fail(error, NOH_ERR_ARG, "morph desc: meshes is NULL, or mesh_count is 0", 0, 0);
    }
    if ((unsigned)desc->path >= NOH_MORPH_PATH_COUNT || (unsigned)desc->accumulate > NOH_ACCUMULATE_F16 ||
        !(desc->expected_active >= 0.0f && desc->expected_active <= 1.0f)) {
        return noh_fail(error, NOH_ERR_ARG, "morph desc: unknown path or accumulate, or expected_active is not in 0..1",
                        0, 0);
    }
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        instances += desc->instance_counts ? desc->instance_counts[i] : 1u;
    }
    if (desc->coarse && (!desc->later_blocks || !desc->later_strips) && desc->meshes[0].header->rect_count) {
        return noh_fail(error, NOH_ERR_ARG, "morph desc: with coarse, set later_blocks and later_strips", 0, 0);
    }
    if (!instances || instances > NOH_MORPH_INSTANCES_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "morph desc: instances must be 1 to NOH_MORPH_INSTANCES_MAX in all", 0,
                        instances);
    }
    return NOH_OK;
}

uint32_t noh_gl_morph_pitch(const noh_mesh_header *header)
{
    return (header->morph_height + 3u) & ~3u;
}

/* Stack the meshes' bands in an atlas of this width. A tile is as wide as its mesh's grid of accumulation texels, a
 * power of two, and a band has as many tiles per row as fit. Returns the height, which may exceed the limit of
 * textures. */
static uint64_t stack_bands(const noh_gl_morph_desc *desc, uint32_t atlas_width, noh_gl_morph_mesh *meshes)
{
    uint64_t y = 0;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        const noh_mesh_header *h = desc->meshes[i].header;
        uint32_t count = desc->instance_counts ? desc->instance_counts[i] : 1u;
        uint32_t columns = atlas_width >> h->morph_width_log2;
        columns = columns ? columns : 1u; /* a mesh that no target moves may be wider than the atlas; it has no rows */
        if (meshes) {
            meshes[i].columns = columns;
            meshes[i].band_y = (uint32_t)y;
        }
        y += ((uint64_t)count + columns - 1) / columns * noh_gl_morph_pitch(h);
    }
    return y;
}

/* Choose the atlas: the smallest width, a power of two, at which the bands fit the height of a texture. Widths up to
 * 2048 are tried with heights up to 2048, which ES 3.0 guarantees, and only then the larger sizes of this GPU. */
static noh_result place_tiles(const noh_gl_morph_desc *desc, uint32_t texture_size_max, noh_gl_morph_mesh *meshes,
                              noh_gl_morph_plan *plan, noh_error *error)
{
    uint32_t least = 1, width;
    uint64_t height = 0;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        uint32_t w = 1u << desc->meshes[i].header->morph_width_log2;
        if (desc->meshes[i].header->touched_count && w > least) {
            least = w;
        }
    }
    if (least == 1) { /* no targets: one texel, so that there is a texture to bind */
        plan->atlas_width = plan->atlas_height = 1;
        for (uint32_t i = 0; meshes && i < desc->mesh_count; i++) {
            meshes[i].columns = 1;
        }
        return NOH_OK;
    }
    for (width = least; width <= texture_size_max; width *= 2) {
        uint32_t limit = width <= 2048u && texture_size_max > 2048u ? 2048u : texture_size_max;
        height = stack_bands(desc, width, NULL);
        if (height <= limit) {
            break;
        }
    }
    if (width > texture_size_max || height > 0xffffu) {
        return noh_fail(error, NOH_ERR_LIMIT,
                        "the tiles of the instances do not fit a texture of this GPU: use fewer instances",
                        texture_size_max, height);
    }
    stack_bands(desc, width, meshes);
    plan->atlas_width = width;
    plan->atlas_height = (uint32_t)height;
    return NOH_OK;
}

/* The mesh of the desc whose tables a mesh uses: the finest LOD level of the same mesh, the first of equals. One table
 * serves all levels, because a level's rectangles per target and its lists per vertex are prefixes of the same data at
 * every finer level. */
static uint32_t owner_of(const noh_gl_morph_desc *desc, uint32_t index)
{
    uint32_t owner = index;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        const noh_mesh *a = &desc->meshes[i], *b = &desc->meshes[owner];
        const int same = a->rects == b->rects && a->texels == b->texels;
        if (same && (a->header->level < b->header->level || (a->header->level == b->header->level && i < owner))) {
            owner = i;
        }
    }
    return owner;
}

/* Sums over the owners. */
typedef struct table_sums {
    uint64_t rects, texels, pairs, tiles, targets;
} table_sums;

static uint32_t has_occlusion(const noh_gl_morph_desc *desc)
{
    uint32_t has = 0;
    for (uint32_t i = 0; i < desc->mesh_count; i++) has |= desc->meshes[i].transfer != NULL;
    return has;
}

/* Place an owner of tiles after the previous owners. `to` may be NULL. */
static void add_owner(const noh_mesh *mesh, uint32_t tiles, noh_gl_morph_mesh *to, table_sums *sums)
{
    if (to) {
        to->first_tile = (uint32_t)sums->tiles;
        to->tile_count = tiles;
        to->first_target = (uint32_t)sums->targets;
    }
    sums->rects += mesh->header->rect_count;
    sums->texels += mesh->header->texel_count;
    sums->pairs += mesh->header->pair_count;
    sums->tiles += tiles;
    sums->targets += mesh->header->target_count;
}

/* Blocks of a mesh of the desc; before its rectangles are loaded, blocks of the finest level. */
static uint32_t blocks_of(const noh_gl_morph_desc *desc, uint32_t mesh)
{
    return desc->coarse ? desc->later_blocks : noh_gl_morph_blocks(&desc->meshes[mesh]);
}

/* Place each mesh's tables. `meshes` may be NULL. The tables of a level in its own pack come last. They are not part of
 * a finer level's tables, because targets dropped by the level have no entries. */
static table_sums place_tables(const noh_gl_morph_desc *desc, noh_gl_morph_mesh *meshes)
{
    table_sums sums = { 0, 0, 0, 0, 0 };
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        const uint32_t owner = owner_of(desc, i);
        if (meshes) meshes[i].owner = owner;
        if (owner == i) add_owner(&desc->meshes[i], blocks_of(desc, i), meshes ? &meshes[i] : NULL, &sums);
    }
    if (desc->coarse) {
        noh_gl_morph_mesh *to = meshes ? &meshes[desc->mesh_count] : NULL;
        if (to) {
            to->mesh = *desc->coarse;
            to->owner = desc->mesh_count;
        }
        add_owner(desc->coarse, noh_gl_morph_blocks(desc->coarse), to, &sums);
    }
    return sums;
}

/* Bytes of one buffer of the ring. Meshes that no target moves have no vertices in it. */
static uint64_t place_vertices(const noh_gl_morph_desc *desc, noh_gl_morph_mesh *meshes)
{
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        const noh_mesh_header *h = desc->meshes[i].header;
        const uint64_t count = desc->instance_counts ? desc->instance_counts[i] : 1u;
        if (meshes) meshes[i].first_byte = (uint32_t)bytes;
        if (h->touched_count) bytes += count * h->vertex_count * noh_morph_finished_stride(&desc->meshes[i]);
    }
    return bytes;
}

noh_result noh_gl_morph_layout(const noh_gl_morph_desc *desc, uint32_t texture_size_max, noh_gl_morph_mesh *meshes,
                               noh_gl_morph_plan *plan, noh_error *error)
{
    const table_sums sums = place_tables(desc, meshes);
    uint64_t weights = 0, lists = 1, starts = 0; /* the first list is empty */
    plan->instance_count = 0;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        const noh_mesh_header *h = desc->meshes[i].header;
        uint32_t count = desc->instance_counts ? desc->instance_counts[i] : 1u;
        if (meshes) {
            noh_gl_morph_mesh *m = &meshes[i];
            m->mesh = desc->meshes[i];
            m->instance_count = count;
            m->first_instance = plan->instance_count;
            m->first_weight = (uint32_t)weights;
            m->list_count = h->touched_count ? blocks_of(desc, i) : 0;
            m->first_list = (uint32_t)lists;
            m->first_start = (uint32_t)starts;
            lists += (uint64_t)count * m->list_count;
            starts += h->touched_count ? (uint64_t)count * noh_gl_morph_positions(h) : 0;
        }
        plan->instance_count += count;
        weights += (uint64_t)count * h->target_count;
    }
    if (weights > NOH_GL_TABLE_TEXELS_MAX || sums.tiles * 16u >= NOH_GL_TABLE_TEXELS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "more weights or delta texels than a texture of this GPU can hold",
                        NOH_GL_TABLE_TEXELS_MAX, weights > sums.tiles * 16u ? weights : sums.tiles * 16u);
    }
    plan->weight_count = (uint32_t)weights;
    plan->rect_count = (uint32_t)sums.rects;
    plan->texel_count = (uint32_t)sums.texels;
    plan->pair_count = (uint32_t)sums.pairs;
    plan->block_count = (uint32_t)sums.tiles;
    if (meshes) (void)place_vertices(desc, meshes);
    return place_tiles(desc, texture_size_max, meshes, plan, error);
}

static uint32_t instances_of(const noh_gl_morph_desc *desc, uint32_t mesh)
{
    return desc->instance_counts ? desc->instance_counts[mesh] : 1u;
}

/* Points or quads for every target of every instance: a strip is cut only at the end of a row of tiles. */
static uint64_t primitives_of(const noh_gl_morph_desc *desc, const noh_gl_morph_plan *plan)
{
    uint32_t across_log2;
    const uint32_t rows = noh_gl_morph_tiles_desc(plan, &across_log2).height / 4u;
    uint64_t count = 0;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        const uint32_t strips = desc->coarse ? desc->later_strips : noh_gl_morph_strips(&desc->meshes[i]);
        count += (uint64_t)instances_of(desc, i) * (plan->points ? blocks_of(desc, i) : strips + rows);
    }
    return count;
}

/* Entries and starts of the lists of all instances, with all targets active. */
typedef struct list_sums {
    uint64_t entries, starts;
} list_sums;

static list_sums sum_lists(const noh_gl_morph_desc *desc)
{
    list_sums sums = { 1, 0 }; /* the empty list */
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        if (!desc->meshes[i].header->touched_count) continue;
        sums.entries += (uint64_t)instances_of(desc, i) * blocks_of(desc, i);
        sums.starts += (uint64_t)instances_of(desc, i) * noh_gl_morph_positions(desc->meshes[i].header);
    }
    sums.starts += !sums.starts;
    return sums;
}

static int lists_fit(const noh_gl_morph_desc *desc)
{
    const list_sums sums = sum_lists(desc);
    return sums.entries <= NOH_GL_TABLE_TEXELS_MAX && sums.starts <= NOH_GL_TABLE_TEXELS_MAX;
}

/* gather draws many instances at once; direct sends the lists of one after the other. */
static noh_gl_batch lists_batch(const noh_gl_morph_desc *desc, const noh_gl_morph_plan *plan)
{
    const uint64_t least = plan->path == NOH_MORPH_GATHER ? NOH_BATCH_ENTRIES : 0;
    const list_sums sums = sum_lists(desc);
    uint64_t entries = sums.entries < least ? sums.entries : least;
    uint64_t positions = sums.starts < least ? sums.starts : least, instances = 0;
    noh_gl_batch batch;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        const uint64_t own = noh_gl_morph_positions(desc->meshes[i].header), all = 1u + (uint64_t)blocks_of(desc, i);
        if (!instances_of(desc, i) || !desc->meshes[i].header->touched_count) continue;
        instances += instances_of(desc, i);
        entries = all > entries ? all : entries;
        positions = own > positions ? own : positions;
    }
    instances = instances < positions ? instances : positions;
    batch.entries = (uint32_t)(entries ? entries : 1u);
    batch.positions = (uint32_t)(positions ? positions : 1u);
    batch.instances = plan->path == NOH_MORPH_GATHER ? (uint32_t)(instances ? instances : 1u) : 0;
    batch.bytes = 0;
    return batch;
}

noh_gl_batch noh_gl_morph_batch(const noh_gl_morph_desc *desc, const noh_gl_morph_plan *plan)
{
    const uint64_t most = plan->points ? NOH_BATCH_POINTS : NOH_BATCH_QUADS;
    noh_gl_batch batch = { 0, 0, 0, 0 };
    uint64_t all;
    if (noh_gl_morph_has_lists(plan->path)) return lists_batch(desc, plan);
    if (plan->path == NOH_MORPH_CPU || plan->path == NOH_MORPH_STREAMS) return batch;
    all = primitives_of(desc, plan);
    all += !all; /* GL has no empty buffers */
    batch.entries = (uint32_t)(all < most ? all : most);
    batch.bytes = all * (plan->points ? 12u : 48u);
    return batch;
}

static size_t most_positions(const noh_gl_morph_desc *desc)
{
    size_t most = desc->coarse ? noh_gl_morph_positions(desc->coarse->header) : 0;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        const size_t own = noh_gl_morph_positions(desc->meshes[i].header);
        most = own > most ? own : most;
    }
    return most;
}

static size_t largest_touched(const noh_gl_morph_desc *desc)
{
    size_t most = 0;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        const size_t touched = desc->meshes[i].header->touched_count;
        most = touched > most ? touched : most;
    }
    return most;
}

static size_t largest_vertices(const noh_gl_morph_desc *desc)
{
    size_t most = 0;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        const size_t count = desc->meshes[i].header->vertex_count;
        const size_t bytes = (count < NOH_VERTEX_CHUNK ? count : NOH_VERTEX_CHUNK) *
                             noh_morph_finished_stride(&desc->meshes[i]);
        most = bytes > most ? bytes : most;
    }
    return most;
}

static void carve_vertices(noh_arena *arena, const noh_gl_morph_desc *desc, const noh_gl_morph_plan *plan,
                           noh_gl_morph *to)
{
    const size_t ring = plan->vertex_ring;
    const size_t groups = (largest_touched(desc) + NOH_MORPH_GROUP - 1u) / NOH_MORPH_GROUP;
    to->finished = noh_arena_carve(arena, largest_vertices(desc), 16);
    to->vertex_arrays = (GLuint *)noh_arena_carve(arena, sizeof(GLuint) * ring * plan->instance_count, 4);
    to->slot_weights = (float *)noh_arena_carve(arena, 4u * ring * plan->weight_count, 4);
    to->slot_levels = (uint8_t *)noh_arena_carve(arena, ring * plan->instance_count, 1);
    to->slot_drawn = (uint8_t *)noh_arena_carve(arena, plan->instance_count, 1);
    to->groups = (uint8_t *)noh_arena_carve(arena, groups, 1);
}

static size_t staging_size(const noh_gl_morph_desc *desc, const noh_gl_morph_plan *plan)
{
    size_t bytes = 0;
    if (plan->path == NOH_MORPH_STREAMS) {
        bytes = NOH_STREAM_CHUNK;
    } else if (plan->path == NOH_MORPH_CPU) {
        for (uint32_t i = 0; i < desc->mesh_count; i++) {
            size_t layers = noh_morph_layers_size(&desc->meshes[i]) / 3u * plan->layer_count;
            if (plan->occlusion) layers = noh_morph_layers_size(&desc->meshes[i]) / 9u * (4u * plan->layer_count + 1u);
            bytes = layers > bytes ? layers : bytes;
        }
    } else {
        const noh_gl_batch batch = noh_gl_morph_batch(desc, plan);
        const int lists = noh_gl_morph_has_lists(plan->path);
        const size_t positions = lists ? 4u * most_positions(desc) : 0;
        const size_t load = positions + 256u * (size_t)NOH_TILE_CHUNK;
        bytes = batch.entries * (size_t)(lists ? 16u : plan->points ? 12u : 48u);
        if (lists) bytes += 16u * (size_t)batch.instances + 4u * (size_t)batch.positions + positions;
        bytes = load > bytes ? load : bytes;
    }
    return bytes;
}

void noh_gl_morph_carve(noh_arena *arena, const noh_gl_morph_desc *desc, const noh_gl_morph_plan *plan, noh_gl_morph *m)
{
    noh_gl_morph dummy;
    noh_gl_morph *to = m ? m : &dummy;
    const int lists = noh_gl_morph_has_lists(plan->path);
    memset(&dummy, 0, sizeof dummy);
    to->table_count = desc->mesh_count + (desc->coarse != NULL);
    to->meshes = (noh_gl_morph_mesh *)noh_arena_carve(arena, sizeof *to->meshes * to->table_count, 16);
    to->batch = noh_gl_morph_batch(desc, plan);
    to->records = blends(plan->path) ? (uint32_t *)noh_arena_carve(arena, 16u * (size_t)plan->weight_count, 16) : NULL;
    to->target_tiles = (uint32_t *)noh_arena_carve(
        arena, blends(plan->path) || lists ? 4u * (size_t)place_tables(desc, NULL).targets : 0, 4);
    to->slots = (uint32_t *)noh_arena_carve(arena, lists ? 4u * (size_t)plan->block_count : 0, 4);
    to->staging_bytes = staging_size(desc, plan);
    to->staging = noh_arena_carve(arena, to->staging_bytes, 16);
    if (plan->vertex_ring) carve_vertices(arena, desc, plan, to);
    to->weights = (float *)noh_arena_carve(arena, 4u * (size_t)plan->weight_count, 4);
    to->instance_mesh = (uint32_t *)noh_arena_carve(arena, 4u * (size_t)plan->instance_count, 4);
    to->dirty = (uint8_t *)noh_arena_carve(arena, plan->instance_count, 1);
    to->levels = (uint8_t *)noh_arena_carve(arena, plan->instance_count, 1);
}

/* With all targets of all instances active. */
static uint64_t update_bytes(const noh_gl_morph_desc *desc, const noh_gl_morph_plan *plan)
{
    const uint64_t texel = 4u * plan->layer_count * (plan->occlusion ? 4u : 3u);
    uint64_t bytes = 0;
    if (blends(plan->path)) bytes = 16u * (uint64_t)plan->weight_count + noh_gl_morph_batch(desc, plan).bytes;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        const noh_mesh_header *h = desc->meshes[i].header;
        const uint64_t count = instances_of(desc, i), positions = noh_gl_morph_positions(h);
        if (noh_gl_morph_has_lists(plan->path) && h->touched_count) {
            const uint64_t own = plan->path == NOH_MORPH_GATHER ? 32u : 0; /* a tile, at most an empty list */
            bytes += count * (own + 4u * positions + 16u * (uint64_t)blocks_of(desc, i));
        }
        if (plan->vertex_ring) {
            bytes += count * noh_gl_morph_vertex_end(h) * noh_morph_finished_stride(&desc->meshes[i]);
        } else if (plan->path == NOH_MORPH_CPU) {
            bytes += count * ((uint64_t)h->morph_height << h->morph_width_log2) * texel /
                     (plan->accumulate == NOH_ACCUMULATE_F16 ? 2u : 1u);
        }
    }
    return bytes;
}

static void set_gpu_bytes(const noh_gl_morph_desc *desc, noh_gl_morph_plan *plan)
{
    noh_gl_texture_desc layers = { 0, 0, 0, 0, 0, 0, 0 };
    layers.format = plan->layer_format;
    layers.width = plan->atlas_width;
    layers.height = plan->atlas_height;
    layers.layers = plan->layer_count;
    plan->layer_bytes = plan->layer_format ? noh_gl_texture_bytes(&layers) : 0;
    plan->vertex_bytes = plan->vertex_ring * place_vertices(desc, NULL);
    if (plan->path == NOH_MORPH_STREAMS) {
        for (uint32_t i = 0; i < desc->mesh_count; i++) {
            if (owner_of(desc, i) == i) plan->delta_bytes += noh_gl_morph_stream_bytes(desc->meshes[i].header);
        }
        plan->delta_bytes += plan->delta_bytes ? 0 : NOH_STREAM_STRIDE; /* GL has no empty buffers */
    } else if (plan->path != NOH_MORPH_CPU) {
        const noh_gl_batch batch = noh_gl_morph_batch(desc, plan);
        uint32_t across_log2;
        const noh_gl_texture_desc tiles = noh_gl_morph_tiles_desc(plan, &across_log2);
        plan->delta_bytes = noh_gl_texture_bytes(&tiles);
        if (plan->path == NOH_MORPH_GATHER) {
            plan->stream_bytes = 16u * (uint64_t)batch.instances + noh_gl_table_bytes(GL_RGBA32UI, batch.entries) +
                                 noh_gl_table_bytes(GL_R32UI, batch.positions);
        } else if (plan->path == NOH_MORPH_DIRECT) {
            const list_sums sums = sum_lists(desc);
            plan->stream_bytes = noh_gl_table_bytes(GL_RGBA32UI, (uint32_t)sums.entries) +
                                 noh_gl_table_bytes(GL_R32UI, (uint32_t)sums.starts);
        } else {
            plan->stream_bytes = noh_gl_table_bytes(GL_RGBA32UI, plan->weight_count) + batch.bytes +
                                 (plan->points ? 0u : 12u) * (uint64_t)batch.entries;
        }
    }
    plan->update_bytes = update_bytes(desc, plan);
    plan->gpu_bytes = plan->delta_bytes + plan->table_bytes + plan->stream_bytes + plan->layer_bytes +
                      plan->vertex_bytes;
}

noh_result noh_gl_morph_plan_make(const noh_gl_morph_desc *desc, const noh_gl_caps *caps, noh_gl_morph_plan *plan,
                                  noh_error *error)
{
    noh_gl_morph_plan p;
    noh_arena arena = noh_arena_measure();
    noh_result result;
    NOH_ASSERT(desc && caps && plan);
    result = check_desc(desc, error);
    memset(&p, 0, sizeof p);
    if (!result) result = noh_gl_morph_layout(desc, caps->texture_size_max, NULL, &p, error);
    if (!result) result = choose_path(desc, caps, &p, error);
    if (result) {
        return result;
    }
    p.occlusion = has_occlusion(desc);
    p.vertex_ring = vertex_ring(desc, caps, &p);
    noh_gl_morph_set_formats(caps, &p);
    if (p.path == NOH_MORPH_DIRECT && !lists_fit(desc)) {
        return noh_fail(error, NOH_ERR_LIMIT,
                        "the lists of the path direct do not fit a texture: use fewer instances, or another path",
                        NOH_GL_TABLE_TEXELS_MAX, sum_lists(desc).entries);
    }
    set_gpu_bytes(desc, &p);
    if (p.path == NOH_MORPH_STREAMS && p.delta_bytes > UINT32_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "the streams of all targets take more than 4 GiB", UINT32_MAX,
                        p.delta_bytes);
    }
    if (p.stream_bytes > INT32_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "one update of all instances needs more than 2 GiB", INT32_MAX,
                        p.stream_bytes);
    }
    if (p.vertex_bytes / (p.vertex_ring ? p.vertex_ring : 1u) > UINT32_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "the finished vertices of all instances take more than 4 GiB", UINT32_MAX,
                        p.vertex_bytes / p.vertex_ring);
    }
    noh_arena_carve(&arena, sizeof(noh_gl_morph), 16);
    noh_gl_morph_carve(&arena, desc, &p, NULL);
    p.cpu_bytes = arena.used;
    *plan = p;
    return NOH_OK;
}
