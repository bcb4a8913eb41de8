/* gl_morph_plan.c: which path, where everything lies, and every byte of it, before anything is made.
 *
 * The atlas is the texture array whose layers take the sums. Each mesh of the desc has a band of it, and each instance
 * a tile in its mesh's band. The tables hold what does not change, the delta texels and where they go, once per mesh
 * however many instances it has. The stream and the staging memory hold what one update sends. They are large enough
 * for every target of every instance to be active at once, so an update cannot run out of room, and never fails. */
#include <string.h>

#include "gl/gl_morph_internal.h"
#include "gl/gl_quirks.h"

static const char *const path_names[NOH_MORPH_PATH_COUNT] = { "auto",   "layered", "mrt",   "per-layer",
                                                              "gather", "cpu",     "blend", "streams" };

const char *noh_morph_path_name(noh_morph_path path)
{
    return path_names[(unsigned)path < NOH_MORPH_PATH_COUNT ? path : 0];
}

const char *noh_accumulate_name(noh_accumulate accumulate)
{
    return accumulate == NOH_ACCUMULATE_F32 ? "f32" : accumulate == NOH_ACCUMULATE_F16 ? "f16" : "auto";
}

/* ---- which path ---- */

/* NULL if the path runs here, else what is missing. */
static const char *missing(noh_morph_path path, noh_accumulate accumulate, const noh_gl_caps *caps)
{
    int half = accumulate == NOH_ACCUMULATE_F16;
    if (path == NOH_MORPH_CPU) {
        return NULL;
    }
    if (path == NOH_MORPH_STREAMS) {
        return half ? "streams are summed in the vertex shader, in f32: there is nothing to keep in f16" : NULL;
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
        return half ? "no blending into RGBA16F here (EXT_color_buffer_half_float or EXT_color_buffer_float)"
                    : "no blending into RGBA32F here (EXT_color_buffer_float and EXT_float_blend)";
    }
    if (path == NOH_MORPH_LAYERED && !caps->layered) {
        return "no layered drawing here (geometry shader with gl_Layer: ES 3.2 or EXT_geometry_shader)";
    }
    if (path == NOH_MORPH_MRT && !caps->mrt3) {
        return "mrt needs three draw buffers into one texture array";
    }
    return NULL;
}

/* The cheapest path on a GPU, by a model whose unit is one blended texel. mrt blends every texel of the active targets,
 * and the vertex work of a rectangle costs as much as 4 texels; gather reads all entries, active or not, with two
 * dependent fetches each, at 1.25. The factors were measured by `noh bench` (runtime/README.md). layered and per-layer
 * do the work of mrt and more, so they are never cheaper. */
static noh_morph_path cheapest_on_gpu(const noh_gl_morph_plan *plan, float active, noh_accumulate accumulate,
                                      const noh_gl_caps *caps, const char **reason)
{
    float mrt = active * ((float)plan->texel_count + 4.0f * (float)plan->rect_count);
    float gather = 1.25f * (float)plan->pair_count;
    int can_mrt = !missing(NOH_MORPH_MRT, accumulate, caps), can_gather = !missing(NOH_MORPH_GATHER, accumulate, caps);
    const noh_gl_quirk *dear = noh_gl_quirk_find(caps->renderer, NOH_QUIRK_BLEND_DEAR);
    if (can_gather && dear) {
        *reason = dear->reason;
        return NOH_MORPH_GATHER;
    }
    if (can_mrt && (mrt <= gather || !can_gather)) {
        *reason = "mrt: float blending works here, and blending the expected targets is the least work";
        return NOH_MORPH_MRT;
    }
    if (can_gather) {
        *reason = can_mrt ? "gather: so many targets are expected that summing lists is less work than blending"
                          : "gather: no blending into this format here; sums in registers need none";
        return NOH_MORPH_GATHER;
    }
    if (!missing(NOH_MORPH_PER_LAYER, accumulate, caps)) {
        *reason = "per-layer: blending works here, three draw buffers do not";
        return NOH_MORPH_PER_LAYER;
    }
    *reason = "cpu: this format cannot be rendered here";
    return NOH_MORPH_CPU;
}

/* The policy `blend`: one draw where a geometry shader can send a triangle to each of the three layers, else a pass for
 * each. Where the format cannot be blended into, the check of per-layer says so. */
static noh_morph_path blending_path(noh_accumulate accumulate, const noh_gl_caps *caps, const char **reason)
{
    if (!missing(NOH_MORPH_LAYERED, accumulate, caps)) {
        *reason = "layered: one additive draw into all three layers";
        return NOH_MORPH_LAYERED;
    }
    *reason = "per-layer: three additive passes, layered drawing is not supported here";
    return NOH_MORPH_PER_LAYER;
}

static uint32_t has_occlusion(const noh_gl_morph_desc *desc);

static const char *missing_of_streams(const noh_gl_morph_desc *desc)
{
    if (desc->coarse) return "streams are not loaded later: give the accumulator all levels";
    return has_occlusion(desc) ? "streams do not carry what targets change of a transfer's occlusion" : NULL;
}

static noh_result choose_path(const noh_gl_morph_desc *desc, const noh_gl_caps *caps, noh_gl_morph_plan *plan,
                              noh_error *error)
{
    const char *lacking;
    plan->accumulate = desc->accumulate == NOH_ACCUMULATE_F16 ? NOH_ACCUMULATE_F16 : NOH_ACCUMULATE_F32;
    plan->path = desc->path;
    plan->reason = "forced by the caller";
    if (desc->path == NOH_MORPH_AUTO) {
        const noh_gl_quirk *software = noh_gl_quirk_find(caps->renderer, NOH_QUIRK_SOFTWARE);
        float active = desc->expected_active > 0.0f ? desc->expected_active : 0.5f;
        if (plan->pair_count == 0) {
            plan->path = NOH_MORPH_CPU;
            plan->reason = "cpu: no target moves anything, there is nothing to accumulate";
        } else if (software) {
            plan->path = NOH_MORPH_CPU;
            plan->reason = software->reason;
        } else {
            plan->path = cheapest_on_gpu(plan, active, plan->accumulate, caps, &plan->reason);
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

static GLenum layer_format(const noh_gl_morph_plan *plan, const noh_gl_caps *caps)
{
    int half = plan->accumulate == NOH_ACCUMULATE_F16;
    if (plan->path == NOH_MORPH_STREAMS) return 0;
    if (plan->path == NOH_MORPH_CPU) {
        if (plan->occlusion) return half ? GL_RGBA16F : GL_RGBA32F;
        return half ? GL_RGB16F : GL_RGB32F; /* never rendered to, so three components are enough */
    }
    if (half) {
        return GL_RGBA16F;
    }
    return caps->render_f32 ? GL_RGBA32F : GL_RGBA32UI;
}

/* ---- sizes ---- */

static noh_result check_desc(const noh_gl_morph_desc *desc, noh_error *error)
{
    uint64_t instances = 0;
    if (!desc->meshes || !desc->mesh_count) {
        return noh_fail(error, NOH_ERR_ARG, "morph desc has no meshes", 0, 0);
    }
    if ((unsigned)desc->path >= NOH_MORPH_PATH_COUNT || (unsigned)desc->accumulate > NOH_ACCUMULATE_F16 ||
        !(desc->expected_active >= 0.0f && desc->expected_active <= 1.0f)) {
        return noh_fail(error, NOH_ERR_ARG,
                        "morph desc has an unknown path or accumulate, or expected_active outside 0..1", 0, 0);
    }
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        instances += desc->instance_counts ? desc->instance_counts[i] : 1u;
    }
    if (!instances || instances > NOH_MORPH_INSTANCES_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "morph desc asks for no instances, or more than the limit", 0, instances);
    }
    return NOH_OK;
}

uint32_t noh_gl_morph_pitch(const noh_mesh_header *header)
{
    return (header->morph_height + 3u) & ~3u;
}

/* Stack the meshes' bands in an atlas of this width. A tile is as wide as its mesh's grid of accumulation texels, a
 * power of two, and a band has as many tiles side by side as fit. Returns the height, which may be more than a texture
 * has. */
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

/* Choose the atlas: the least width, a power of two, at which the bands are no higher than a texture may be. Widths up
 * to 2048 are tried with heights up to 2048, which every ES 3.0 has, and only then the larger ones of this GPU. */
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
    if (least == 1) { /* no target anywhere: one texel, so that there is a texture to bind */
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
        return noh_fail(error, NOH_ERR_LIMIT, "the instances' tiles do not fit a texture of this GPU", texture_size_max,
                        height);
    }
    stack_bands(desc, width, meshes);
    plan->atlas_width = width;
    plan->atlas_height = (uint32_t)height;
    return NOH_OK;
}

/* The mesh of the desc whose tables a mesh uses: the finest LOD level of the same mesh, the first of equals. One table
 * serves all levels because a level's rectangles, target by target, and its lists, vertex by vertex, are a prefix of
 * those of every finer level. */
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

typedef struct table_sums {
    uint64_t rects, texels, pairs, starts;
} table_sums;

static uint32_t has_occlusion(const noh_gl_morph_desc *desc)
{
    uint32_t has = 0;
    for (uint32_t i = 0; i < desc->mesh_count; i++) has |= desc->meshes[i].transfer != NULL;
    return has;
}

uint32_t noh_gl_morph_ratio_count(const noh_mesh_header *h, uint32_t occlusion)
{
    return occlusion ? h->target_count : 0u;
}

/* The tables of a level in a pack of its own come last. They are not a part of those of a finer level: targets that the
 * level leaves out have no entries in them. */
static void add_coarse(const noh_gl_morph_desc *desc, noh_gl_morph_mesh *meshes, table_sums *sums)
{
    const noh_mesh_header *h = desc->coarse->header;
    const uint32_t ratios = noh_gl_morph_ratio_count(h, has_occlusion(desc));
    if (meshes) {
        noh_gl_morph_mesh *to = &meshes[desc->mesh_count];
        to->mesh = *desc->coarse;
        to->owner = desc->mesh_count;
        to->first_rect = (uint32_t)sums->rects;
        to->first_texel = (uint32_t)sums->texels;
        to->first_start = (uint32_t)sums->starts + ratios;
        to->first_pair = (uint32_t)sums->pairs;
    }
    sums->rects += h->rect_count;
    sums->texels += h->texel_count;
    sums->pairs += h->pair_count;
    sums->starts += (uint64_t)ratios + h->touched_count + 1u;
}

/* Where each mesh's part of the tables begins. `meshes` may be NULL. */
static table_sums place_tables(const noh_gl_morph_desc *desc, noh_gl_morph_mesh *meshes)
{
    table_sums sums = { 0, 0, 0, 0 };
    const uint32_t occlusion = has_occlusion(desc);
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        const noh_mesh_header *h = desc->meshes[i].header;
        const uint32_t owner = owner_of(desc, i), ratios = noh_gl_morph_ratio_count(h, occlusion);
        if (meshes) {
            meshes[i].owner = owner;
            meshes[i].first_rect = (uint32_t)sums.rects;
            meshes[i].first_texel = (uint32_t)sums.texels;
            meshes[i].first_start = (uint32_t)sums.starts + ratios;
            meshes[i].first_pair = (uint32_t)sums.pairs;
        }
        if (owner == i) {
            sums.rects += h->rect_count;
            sums.texels += h->texel_count;
            sums.pairs += h->pair_count;
            sums.starts += (uint64_t)ratios + h->touched_count + 1u;
        }
    }
    if (desc->coarse) add_coarse(desc, meshes, &sums);
    return sums;
}

noh_result noh_gl_morph_layout(const noh_gl_morph_desc *desc, uint32_t texture_size_max, noh_gl_morph_mesh *meshes,
                               noh_gl_morph_plan *plan, noh_error *error)
{
    const table_sums sums = place_tables(desc, meshes);
    uint64_t weights = 0;
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
        }
        plan->instance_count += count;
        weights += (uint64_t)count * h->target_count;
    }
    if (weights > NOH_GL_TABLE_TEXELS_MAX || sums.rects > NOH_GL_TABLE_TEXELS_MAX ||
        sums.texels > NOH_GL_TABLE_TEXELS_MAX || sums.starts > NOH_GL_TABLE_TEXELS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "more weights, rectangles or delta texels than a table texture holds",
                        NOH_GL_TABLE_TEXELS_MAX, weights > sums.texels ? weights : sums.texels);
    }
    plan->weight_count = (uint32_t)weights;
    plan->rect_count = (uint32_t)sums.rects;
    plan->texel_count = (uint32_t)sums.texels;
    plan->pair_count = (uint32_t)sums.pairs;
    return place_tiles(desc, texture_size_max, meshes, plan, error);
}

int noh_gl_morph_wide(const noh_gl_morph_plan *plan)
{
    return plan->rect_count > 65536u || plan->weight_count > 65536u;
}

/* For the most that one update can draw: every rectangle of every instance. */
static uint64_t rect_record_bytes(const noh_gl_morph_desc *desc, const noh_gl_morph_plan *plan)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        count += (uint64_t)(desc->instance_counts ? desc->instance_counts[i] : 1u) * desc->meshes[i].header->rect_count;
    }
    return (count ? count : 1u) * (noh_gl_morph_wide(plan) ? 8u : 4u);
}

static size_t largest_touched(const noh_gl_morph_desc *desc)
{
    size_t most = desc->coarse ? desc->coarse->header->touched_count : 0;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        size_t touched = desc->meshes[i].header->touched_count;
        most = touched > most ? touched : most;
    }
    return most;
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
    } else if (plan->path == NOH_MORPH_GATHER) {
        size_t load = 2u * 4u * (largest_touched(desc) + 1u) + 16u * (size_t)NOH_GATHER_CHUNK;
        bytes = 16u * (size_t)plan->instance_count;
        bytes = load > bytes ? load : bytes;
    } else {
        size_t load = 16u * (size_t)NOH_RECT_CHUNK;
        const uint64_t records = rect_record_bytes(desc, plan);
        bytes = records < SIZE_MAX ? (size_t)records : SIZE_MAX; /* which no memory has */
        bytes = bytes > load ? bytes : load;
    }
    return bytes;
}

void noh_gl_morph_carve(noh_arena *arena, const noh_gl_morph_desc *desc, const noh_gl_morph_plan *plan, noh_gl_morph *m)
{
    noh_gl_morph dummy;
    noh_gl_morph *to = m ? m : &dummy;
    memset(&dummy, 0, sizeof dummy);
    to->table_count = desc->mesh_count + (desc->coarse != NULL);
    to->meshes = (noh_gl_morph_mesh *)noh_arena_carve(arena, sizeof *to->meshes * to->table_count, 16);
    to->records = plan->path == NOH_MORPH_CPU || plan->path == NOH_MORPH_STREAMS
                      ? NULL
                      : (uint32_t *)noh_arena_carve(arena, 16u * (size_t)plan->weight_count, 16);
    to->staging_bytes = staging_size(desc, plan);
    to->staging = noh_arena_carve(arena, to->staging_bytes, 16);
    to->weights = (float *)noh_arena_carve(arena, 4u * (size_t)plan->weight_count, 4);
    to->instance_mesh = (uint32_t *)noh_arena_carve(arena, 4u * (size_t)plan->instance_count, 4);
    to->dirty = (uint8_t *)noh_arena_carve(arena, plan->instance_count, 1);
    to->levels = (uint8_t *)noh_arena_carve(arena, plan->instance_count, 1);
}

static void set_gpu_bytes(const noh_gl_morph_desc *desc, noh_gl_morph_plan *plan)
{
    noh_gl_texture_desc layers = { 0, 0, 0, 0, 0, 0, 0 };
    layers.format = plan->layer_format;
    layers.width = plan->atlas_width;
    layers.height = plan->atlas_height;
    layers.layers = plan->layer_count;
    plan->layer_bytes = plan->path == NOH_MORPH_STREAMS ? 0 : noh_gl_texture_bytes(&layers);
    if (plan->path == NOH_MORPH_STREAMS) {
        for (uint32_t i = 0; i < desc->mesh_count; i++) {
            if (owner_of(desc, i) == i) plan->delta_bytes += noh_gl_morph_stream_bytes(desc->meshes[i].header);
        }
        plan->delta_bytes += plan->delta_bytes ? 0 : NOH_STREAM_STRIDE; /* GL has no empty buffers */
    } else if (plan->path == NOH_MORPH_GATHER) {
        plan->delta_bytes = noh_gl_table_bytes(GL_RGBA32UI, plan->pair_count);
        plan->table_bytes = noh_gl_table_bytes(GL_R32UI, (uint32_t)place_tables(desc, NULL).starts);
        plan->stream_bytes = 16u * (uint64_t)plan->instance_count + noh_gl_table_bytes(GL_RGBA32UI, plan->weight_count);
    } else if (plan->path != NOH_MORPH_CPU) {
        plan->delta_bytes = noh_gl_table_bytes(plan->occlusion ? GL_RGBA32UI : GL_RGB32UI, plan->texel_count);
        plan->table_bytes = noh_gl_table_bytes(GL_RGBA32UI, plan->rect_count);
        plan->stream_bytes = rect_record_bytes(desc, plan) + noh_gl_table_bytes(GL_RGBA32UI, plan->weight_count);
    }
    plan->gpu_bytes = plan->delta_bytes + plan->table_bytes + plan->stream_bytes + plan->layer_bytes;
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
    p.layer_format = layer_format(&p, caps);
    p.layer_count = desc->without_tangents ? 2u : 3u;
    set_gpu_bytes(desc, &p);
    if (p.path == NOH_MORPH_STREAMS && p.delta_bytes > UINT32_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "the streams of all targets take more than 4 GiB", UINT32_MAX,
                        p.delta_bytes);
    }
    noh_arena_carve(&arena, sizeof(noh_gl_morph), 16);
    noh_gl_morph_carve(&arena, desc, &p, NULL);
    p.cpu_bytes = arena.used;
    *plan = p;
    return NOH_OK;
}
