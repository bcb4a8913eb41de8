/* gl_morph.c: making and deleting accumulators, and the code common to all paths: weights, LOD levels, changed
 * instances.
 *
 * Setting weights only marks an instance as changed. noh_gl_morph_update accumulates all changed instances together, so
 * that a crowd costs a few draws. An unchanged instance keeps the sums of its tile. */
#include "core/base/assert_internal.h"
#include "deform/morph/morph_internal.h"
#include "gl/device/gl_api_internal.h"
#include "gl/morph/gl_morph_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#include <string.h>

#include "gl/device/gl_names_internal.h"
#include "gl/device/gl_debug_internal.h"
#include "gl/device/gl_memory_internal.h"

/* ---- making ---- */

static noh_result create_layers(noh_gl_morph *m, noh_error *error)
{
    noh_gl_texture_desc desc = { 0, 0, 0, 0, 0, 0, 0 };
    desc.format = m->plan.layer_format;
    desc.width = m->plan.atlas_width;
    desc.height = m->plan.atlas_height;
    desc.layers = m->plan.layer_count;
    return noh_gl_texture_create(m->gl, m->ledger, &desc, &m->layers, error);
}

/* Label the textures. Vertex array, program and framebuffers are labelled where they are made. */
static void label_objects(const noh_gl_morph *m)
{
    const struct {
        GLuint name;
        const char *what;
    } textures[] = { { m->layers.name, "morph layers" },
                     { m->tiles.name, "morph deltas" },
                     { m->starts.texture.name, "morph starts" },
                     { m->record_table.texture.name, "morph records" } };
    for (unsigned i = 0; i < sizeof textures / sizeof textures[0]; i++) {
        if (textures[i].name) {
            noh_gl_label(m->gl, GL_TEXTURE, textures[i].name, textures[i].what, NULL);
        }
    }
}

static noh_result make_gl_objects(noh_gl_morph *m, char *log, size_t log_bytes, noh_error *error)
{
    const int streams = m->plan.path == NOH_MORPH_STREAMS, direct = m->plan.path == NOH_MORPH_DIRECT;
    m->program = m->programs ? m->programs[m->plan.occlusion] : 0;
    if (m->programs && !m->program && noh_gl_morph_has_program(m->plan.path)) {
        return noh_fail(error, NOH_ERR_UNSUPPORTED,
                        "the targets of a kind need a program that no kind of the plan needs", 0, 0);
    }
    noh_result result = streams               ? noh_gl_morph_init_streams(m, error)
                        : m->plan.vertex_ring ? noh_gl_morph_init_vertices(m, error)
                        : direct              ? noh_gl_morph_init_direct(m, error)
                                              : create_layers(m, error);
    if (!result && m->plan.path != NOH_MORPH_CPU && !streams) {
        result = noh_gl_morph_make_tiles(m, error);
        if (!result && m->plan.path == NOH_MORPH_GATHER) {
            result = noh_gl_morph_init_gather(m, log, log_bytes, error);
        } else if (!result && !direct) {
            result = noh_gl_morph_init_blend(m, log, log_bytes, error);
        }
    }
    if (!result) {
        label_objects(m);
        result = noh_gl_error_check(m->gl, "the driver refused a call while making the accumulator", m->plan.gpu_bytes,
                                    error);
    }
    return result;
}

#if NOH_ASSERT_LEVEL >= 2
/* Check that every instance has a mesh of the desc, a level of this mesh, finite weights, and a tile inside the atlas,
 * and that the count of changed instances is right. */
static int is_valid(const noh_gl_morph *m)
{
    uint32_t dirty = 0;
    int valid = 1;
    for (uint32_t i = 0; i < m->plan.instance_count && valid; i++) {
        const noh_gl_morph_mesh *mesh = &m->meshes[m->instance_mesh[i] < m->mesh_count ? m->instance_mesh[i] : 0];
        const noh_mesh_header *h = mesh->mesh.header;
        uint32_t x, y;
        dirty += m->dirty[i] != 0;
        noh_gl_morph_tile(m, i, &x, &y);
        valid = m->instance_mesh[i] < m->mesh_count && i - mesh->first_instance < mesh->instance_count;
        valid = valid && m->levels[i] >= h->level && m->levels[i] < h->level_count;
        valid = valid && (!h->touched_count || (x + (1u << h->morph_width_log2) <= m->plan.atlas_width &&
                                                y + h->morph_height <= m->plan.atlas_height));
    }
    for (uint32_t i = 0; i < m->plan.weight_count && valid; i++) {
        valid = m->weights[i] - m->weights[i] == 0.0f;
    }
    return valid && dirty == m->dirty_count;
}
#endif

static void mark_all_dirty(noh_gl_morph *m)
{
    /* the content of a new texture is undefined: the first update clears every tile */
    memset(m->dirty, 1, m->plan.instance_count);
    m->dirty_count = m->plan.instance_count;
}

/* Initialise everything except the GL objects. */
static noh_gl_morph *build(noh_arena arena, const noh_gl_device *device, const noh_gl_morph_desc *desc,
                           noh_gl_morph_plan plan)
{
    noh_gl_morph *m = (noh_gl_morph *)noh_arena_carve(&arena, sizeof *m, 16);
    memset(m, 0, sizeof *m);
    m->gl = device->api;
    m->ledger = device->ledger;
    m->plan = plan;
    m->flushes = plan.points && memcmp(device->caps->renderer, "llvmpipe", 8) == 0;
    m->mesh_count = desc->mesh_count;
    if (!desc->simd || noh_morph_kernel_find(desc->simd, &m->kernel, NULL) != NOH_OK) {
        (void)noh_morph_kernel_find(NULL, &m->kernel, NULL);
    }
    noh_gl_morph_carve(&arena, desc, &plan, m);
    memset(m->meshes, 0, sizeof *m->meshes * m->table_count);
    memset(m->weights, 0, sizeof *m->weights * plan.weight_count);
    noh_gl_morph_layout(desc, device->caps->texture_size_max, m->meshes, &plan, NULL);
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        for (uint32_t k = 0; k < m->meshes[i].instance_count; k++) {
            m->instance_mesh[m->meshes[i].first_instance + k] = i;
            m->levels[m->meshes[i].first_instance + k] = (uint8_t)m->meshes[i].mesh.header->level;
        }
    }
    if (desc->coarse) noh_gl_morph_use(m, desc->coarse);
    mark_all_dirty(m);
    return m;
}

noh_result noh_gl_morph_init_empty(void *memory, size_t bytes, const noh_gl_device *device,
                                   const noh_gl_morph_desc *desc, const GLuint *programs, const noh_gl_texture *tiles,
                                   noh_gl_morph **morph, noh_error *error)
{
    noh_gl_morph_plan plan;
    noh_gl_morph *m;
    noh_arena arena;
    noh_result result;
    NOH_ASSERT(desc && morph);
    result = noh_gl_device_check(device, 1, error);
    if (!result) result = noh_gl_morph_plan_make(desc, device->caps, &plan, error);
    if (!result && plan.cpu_bytes > SIZE_MAX) {
        result = noh_fail(error, NOH_ERR_LIMIT, "the accumulator needs more memory than this processor can address", 0,
                          plan.cpu_bytes);
    }
    if (!result) result = noh_arena_open(&arena, memory, bytes, (size_t)plan.cpu_bytes, error);
    if (result) {
        return result;
    }
    m = build(arena, device, desc, plan);
    m->programs = programs;
    result = noh_gl_morph_remake(m, tiles, device->log, device->log_bytes, error);
    if (result) {
        return result;
    }
    *morph = m;
    return NOH_OK;
}

noh_result noh_gl_morph_init(void *memory, size_t bytes, const noh_gl_device *device, const noh_gl_morph_desc *desc,
                             noh_gl_morph **morph, noh_error *error)
{
    return noh_gl_morph_init_empty(memory, bytes, device, desc, NULL, NULL, morph, error);
}

noh_result noh_gl_morph_compile(const noh_gl_device *device, noh_morph_path path, const noh_gl_morph_desc *desc,
                                int occlusion, GLuint *program, noh_error *error)
{
    noh_gl_morph m;
    noh_result result;
    memset(&m, 0, sizeof m);
    m.gl = device->api;
    m.ledger = device->ledger;
    m.plan.path = path;
    m.plan.accumulate = desc->accumulate == NOH_ACCUMULATE_F16 ? NOH_ACCUMULATE_F16 : NOH_ACCUMULATE_F32;
    m.plan.layer_count = desc->without_tangents ? 2u : 3u;
    m.plan.occlusion = (uint32_t)occlusion;
    noh_gl_morph_set_formats(device->caps, &m.plan);
    result = path == NOH_MORPH_GATHER ? noh_gl_morph_compile_gather(&m, device->log, device->log_bytes, error)
                                      : noh_gl_morph_compile_blend(&m, device->log, device->log_bytes, error);
    *program = m.program;
    return result;
}

static void delete_objects(noh_gl_morph *m, const noh_gl_api *gl)
{
    for (int i = 0; i < 3; i++) {
        noh_gl_framebuffer_delete(gl, m->ledger, &m->framebuffers[i]);
    }
    if (!m->programs) noh_gl_program_delete(gl, m->ledger, &m->program);
    m->program = 0;
    if (m->vertex_array) {
        gl->DeleteVertexArrays(1, &m->vertex_array);
        m->vertex_array = 0;
    }
    noh_gl_morph_delete_vertices(m, gl);
    noh_gl_buffer_delete(gl, m->ledger, &m->stream);
    noh_gl_buffer_delete(gl, m->ledger, &m->indices);
    noh_gl_texture_delete(gl, m->ledger, &m->record_table.texture);
    noh_gl_texture_delete(gl, m->ledger, &m->starts.texture);
    noh_gl_texture_delete(gl, m->ledger, &m->tiles);
    noh_gl_texture_delete(gl, m->ledger, &m->layers);
}

void noh_gl_morph_delete(noh_gl_morph *m)
{
    NOH_ASSERT(m && m->gl && m->ledger);
    delete_objects(m, m->gl);
}

void noh_gl_morph_forget(noh_gl_morph *m)
{
    NOH_ASSERT(m && m->gl && m->ledger);
    delete_objects(m, noh_gl_lost_api());
}

noh_result noh_gl_morph_remake(noh_gl_morph *m, const noh_gl_texture *tiles, char *log, size_t log_bytes,
                               noh_error *error)
{
    noh_result result;
    mark_all_dirty(m);
    m->tiles_taken = tiles != NULL;
    if (tiles) m->tiles = *tiles;
    result = make_gl_objects(m, log, log_bytes, error);
    if (result) {
        if (tiles) memset(&m->tiles, 0, sizeof m->tiles);
        noh_gl_morph_delete(m);
    }
    return result;
}

noh_result noh_gl_morph_restore(noh_gl_morph *m, char *log, size_t log_bytes, noh_error *error)
{
    noh_gl_morph_forget(m);
    return noh_gl_morph_remake(m, NULL, log, log_bytes, error);
}

/* ---- delta tiles of others ---- */

noh_gl_tiles_key noh_gl_morph_key(const noh_mesh *meshes, uint32_t count, const noh_gl_morph_plan *plan)
{
    noh_gl_tiles_key key;
    const noh_mesh *finest = meshes;
    int one = count && plan->path != NOH_MORPH_CPU && plan->path != NOH_MORPH_STREAMS; /* those have no tiles */
    memset(&key, 0, sizeof key);
    for (uint32_t i = 0; i < count; i++) {
        one &= meshes[i].rects == meshes->rects && meshes[i].texels == meshes->texels;
        if (meshes[i].header->level < finest->header->level) finest = &meshes[i];
    }
    if (!one) return key;
    key.mesh = finest->header;
    key.transfer = finest->transfer;
    key.block_count = plan->block_count;
    key.wide = (uint16_t)plan->wide;
    key.by_block = (uint16_t)noh_gl_morph_has_lists(plan->path);
    return key;
}

noh_gl_tiles_key noh_gl_morph_key_of(const noh_gl_morph *m)
{
    const noh_gl_morph_mesh *owner = &m->meshes[m->meshes[0].owner];
    int one = m->table_count == m->mesh_count;
    for (uint32_t i = 1; i < m->mesh_count; i++) one &= m->meshes[i].owner == m->meshes[0].owner;
    return noh_gl_morph_key(&owner->mesh, one ? 1u : 0u, &m->plan);
}

/* ---- asking ---- */

const noh_gl_morph_plan *noh_gl_morph_plan_of(const noh_gl_morph *morph)
{
    NOH_ASSERT(morph);
    return &morph->plan;
}

uint32_t noh_gl_morph_instance(const noh_gl_morph *morph, uint32_t mesh, uint32_t i)
{
    NOH_ASSERT(morph && mesh < morph->mesh_count && i < morph->meshes[mesh].instance_count);
    return morph->meshes[mesh].first_instance + i;
}

/* noh_gl_morph_binding.lips, in steps that a crowd's row holds, and below 1.5: half of it, after the largest count, is
 * not rounded to 1 there (gl_skin.c). */
static float lips_of(const noh_gl_morph *m, uint32_t instance)
{
    const noh_mesh mesh = noh_gl_morph_view(m, instance); /* a level that is there: finer ones may come later */
    const float *weights = m->weights + noh_gl_morph_first_weight(m, instance);
    float sum = 0.0f;
    for (uint32_t t = 0; t < mesh.header->target_count; t++) {
        if (weights[t] != 0.0f) sum += weights[t] * (float)mesh.targets[t].lips;
    }
    sum /= 4096.0f;
    return sum > 0.0f ? (float)(int)((sum < 1.49f ? sum : 1.49f) * 128.0f) / 128.0f : 0.0f;
}

noh_gl_morph_binding noh_gl_morph_binding_of(const noh_gl_morph *morph, uint32_t instance)
{
    const noh_mesh_header *h;
    noh_gl_morph_binding binding;
    uint32_t x, y;
    NOH_ASSERT(morph && instance < morph->plan.instance_count);
    h = morph->meshes[morph->instance_mesh[instance]].mesh.header;
    noh_gl_morph_tile(morph, instance, &x, &y);
    memset(&binding, 0, sizeof binding);
    binding.texture = morph->layers.name;
    binding.is_uint = morph->plan.layer_format == GL_RGBA32UI;
    binding.layer_count = (int)morph->plan.layer_count;
    binding.tile_x = (int32_t)x;
    binding.tile_y = (int32_t)y;
    binding.width_log2 = (int32_t)h->morph_width_log2;
    binding.touched = (int32_t)h->touched_count;
    binding.lips = lips_of(morph, instance);
    if (morph->plan.path == NOH_MORPH_STREAMS) noh_gl_morph_set_streams(morph, instance, &binding);
    if (morph->plan.path == NOH_MORPH_DIRECT) noh_gl_morph_set_direct(morph, instance, &binding);
    if (morph->plan.vertex_ring) noh_gl_morph_set_vertices(morph, instance, &binding);
    return binding;
}

/* ---- setting and accumulating ---- */

noh_result noh_gl_morph_set_weights(noh_gl_morph *morph, uint32_t instance, const float *weights, noh_error *error)
{
    uint32_t count;
    float *own;
    NOH_ASSERT(morph && instance < morph->plan.instance_count);
    count = morph->meshes[morph->instance_mesh[instance]].mesh.header->target_count;
    own = morph->weights + noh_gl_morph_first_weight(morph, instance);
    NOH_ASSERT(weights || !count);
    for (uint32_t i = 0; i < count; i++) {
        if (weights[i] - weights[i] != 0.0f) { /* NaN for infinities and NaN */
            return noh_fail(error, NOH_ERR_ARG, "a weight is not finite", i, 0);
        }
    }
    if (memcmp(own, weights, sizeof *own * count) != 0) {
        memcpy(own, weights, sizeof *own * count);
        morph->dirty_count += !morph->dirty[instance];
        morph->dirty[instance] = 1;
    }
    return NOH_OK;
}

/* The accumulation texels of a coarser level are the first texels of a finer level. So a coarser level needs no new
 * accumulation; only a finer one does. */
void noh_gl_morph_set_lod(noh_gl_morph *morph, uint32_t instance, uint32_t level)
{
    const noh_mesh_header *h;
    uint32_t before;
    NOH_ASSERT(morph && instance < morph->plan.instance_count);
    h = morph->meshes[morph->instance_mesh[instance]].mesh.header;
    before = morph->levels[instance];
    level = level < h->level_count ? level : h->level_count - 1u;
    level = level > h->level ? level : h->level;
    morph->levels[instance] = (uint8_t)level;
    if (level < before) {
        morph->dirty_count += !morph->dirty[instance];
        morph->dirty[instance] = 1;
    }
}

/* ---- levels loaded later ---- */

int noh_gl_morph_fill(noh_gl_morph *morph, const noh_mesh *from, uint32_t *at, uint32_t *bytes)
{
    noh_mesh finest;
    int done = 1;
    NOH_ASSERT(morph && (morph->programs || morph->table_count > morph->mesh_count) && from && at && bytes);
    finest = noh_mesh_at_lod(from, morph->meshes[morph->meshes[0].owner].mesh.header->level);
    if (morph->tiles_taken) *at = morph->meshes[morph->meshes[0].owner].tile_count;
    if (morph->plan.path != NOH_MORPH_CPU) {
        done = noh_gl_morph_fill_tiles(morph, &morph->meshes[morph->meshes[0].owner], &finest, at, bytes);
    }
    morph->gl->ActiveTexture(GL_TEXTURE0);
    morph->gl->BindTexture(GL_TEXTURE_2D, 0);
    return done;
}

void noh_gl_morph_use(noh_gl_morph *morph, const noh_mesh *mesh)
{
    NOH_ASSERT(morph->table_count > morph->mesh_count);
    const uint32_t of_tables = morph->meshes[morph->meshes[0].owner].mesh.header->level;
    const uint32_t finest = mesh->header->level > of_tables ? mesh->header->level : of_tables;
    morph->source = noh_mesh_at_lod(mesh, finest);
    for (uint32_t i = 0; i < morph->mesh_count; i++) {
        noh_gl_morph_mesh *own = &morph->meshes[i];
        const uint32_t of_pool = own->mesh.header->level;
        const uint8_t level = (uint8_t)(of_pool > finest ? of_pool : finest);
        for (uint32_t k = own->first_instance; k < own->first_instance + own->instance_count; k++) {
            if (morph->levels[k] == level) continue;
            morph->levels[k] = level;
            morph->dirty_count += !morph->dirty[k];
            morph->dirty[k] = 1;
        }
    }
}

void noh_gl_morph_update(noh_gl_morph *morph, noh_gl_morph_stats *stats)
{
    noh_gl_morph_stats local;
    noh_gl_morph_stats *s = stats ? stats : &local;
    NOH_ASSERT(morph && morph->dirty_count <= morph->plan.instance_count);
    NOH_VALIDATE(is_valid(morph));
    memset(s, 0, sizeof *s);
    if (!morph->dirty_count) {
        return;
    }
    s->instances = morph->dirty_count;
    noh_gl_group_begin(morph->gl, "noh morph", noh_morph_path_name(morph->plan.path));
    if (morph->plan.vertex_ring) {
        noh_gl_morph_update_vertices(morph, s);
    } else if (morph->plan.path == NOH_MORPH_CPU) {
        noh_gl_morph_update_cpu(morph, s);
    } else if (morph->plan.path == NOH_MORPH_GATHER) {
        noh_gl_morph_update_gather(morph, s);
    } else if (morph->plan.path == NOH_MORPH_DIRECT) {
        noh_gl_morph_update_direct(morph, s);
    } else if (morph->plan.path == NOH_MORPH_STREAMS) {
        noh_gl_morph_update_streams(morph, s);
    } else {
        noh_gl_morph_update_blend(morph, s);
    }
    noh_gl_group_end(morph->gl);
    memset(morph->dirty, 0, morph->plan.instance_count);
    morph->dirty_count = 0;
}
