/* gl_morph_vertices.c: the path cpu with finished vertices. The changed vertices of an instance are accumulated,
 * finished (deform.h) and written into vertex buffers, which replace the mesh's own buffers in a vertex array.
 *
 * There is a ring of two or three buffers, each with a slot for every instance, so that the GPU may still draw from one
 * slot while the next is written. Each slot stores the weights it was written with: groups of texels that no changed
 * target moves are not rewritten, and vertices that no target moves are written once, at init.
 *
 * Buffers are mapped without synchronisation. An instance reuses a slot `ring` of its updates after the slot was
 * written. All draws from the slot were therefore issued before the update that lies ring - 1 updates back: each update
 * inserts a fence, and waits for the fence of that update. If buffers cannot be mapped, as in WebGL, or the driver
 * refuses, glBufferSubData is used, which the driver orders after the draws. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "deform/morph/morph_internal.h"
#include "gl/device/gl_api_internal.h"
#include "gl/morph/gl_morph_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "gl/device/gl_names_internal.h"
#include "gl/device/gl_debug_internal.h"

/* A refused glBufferSubData goes unnoticed (glGetError would wait for the GPU in some browsers), so every 64th update
 * writes slots completely. */
#define WHOLE_EVERY 64u

#define FEW_GROUPS 8u /* finishing 128 vertices takes less time than a GL call in a browser */

#define WAIT_NS 1000000000u /* longest wait for a GPU frame: after a second the context is lost */

/* The data written to one slot. */
typedef struct slot_job {
    noh_gl_morph *m;
    noh_mesh mesh; /* at the accumulated level */
    noh_morph_layers layers;
    const float *weights;
    uint32_t instance, slot, stride;
    uint64_t offset; /* of the slot in its buffer */
    int whole;       /* 1: all vertices moved by targets; 0: vertices of m->groups */
    uint8_t *mapped; /* NULL: sent in chunks */
} slot_job;

static uint64_t offset_of(const noh_gl_morph *m, uint32_t instance)
{
    const noh_gl_morph_mesh *own = &m->meshes[m->instance_mesh[instance]];
    const uint64_t bytes = (uint64_t)own->mesh.header->vertex_count * noh_morph_finished_stride(&own->mesh);
    return own->first_byte + (instance - own->first_instance) * bytes;
}

static uint8_t *level_of(const noh_gl_morph *m, uint32_t instance, uint32_t slot)
{
    return m->slot_levels + (size_t)slot * m->plan.instance_count + instance;
}

static float *weights_of(const noh_gl_morph *m, uint32_t instance, uint32_t slot)
{
    return m->slot_weights + (size_t)slot * m->plan.weight_count + noh_gl_morph_first_weight(m, instance);
}

static GLuint *array_of(const noh_gl_morph *m, uint32_t instance, uint32_t slot)
{
    return m->vertex_arrays + (size_t)slot * m->plan.instance_count + instance;
}

/* ---- writing ---- */

/* Finish the vertices first to first + count - 1. layers NULL: the bind pose */
static void write_vertices(const slot_job *j, const noh_morph_layers *layers, uint32_t first, uint32_t count)
{
    const noh_gl_morph *m = j->m;
    if (j->mapped) {
        m->kernel.finish(&j->mesh, layers, first, count, j->mapped + (size_t)first * j->stride);
        return;
    }
    for (uint32_t done = 0; done < count; done += NOH_VERTEX_CHUNK) {
        const uint32_t left = count - done, now = left < NOH_VERTEX_CHUNK ? left : NOH_VERTEX_CHUNK;
        m->kernel.finish(&j->mesh, layers, first + done, now, m->finished);
        m->gl->BufferSubData(GL_ARRAY_BUFFER, (GLintptr)(j->offset + (uint64_t)(first + done) * j->stride),
                             (GLsizeiptr)((size_t)now * j->stride), m->finished);
    }
}

static int is_written(const slot_job *j, uint32_t vertex)
{
    const noh_mesh_header *h = j->mesh.header;
    uint32_t texel;
    memcpy(&texel, j->mesh.attributes + ((size_t)vertex + 1u) * h->attribute_stride - 4u, sizeof texel);
    texel &= (1u << NOH_TEXEL_VERTEX_BITS) - 1u;
    return texel < h->touched_count && j->m->groups[texel / NOH_MORPH_GROUP];
}

/* A mesh with a texel number per vertex: write runs of vertices whose texels are written. */
static void write_referring(const slot_job *j)
{
    const uint32_t end = j->mesh.header->vertex_count;
    uint32_t v = 0;
    while (v < end) {
        uint32_t first;
        while (v < end && !is_written(j, v)) v++;
        first = v;
        while (v < end && is_written(j, v)) v++;
        if (v > first) write_vertices(j, &j->layers, first, v - first);
    }
}

uint32_t noh_gl_morph_vertex_end(const noh_mesh_header *h)
{
    return h->flags & NOH_MESH_TEXELS ? h->vertex_count : h->touched_count;
}

/* Write all vertices of the marked groups, in runs. */
static void write_slot(const slot_job *j)
{
    const uint32_t end = noh_gl_morph_vertex_end(j->mesh.header),
                   groups = (end + NOH_MORPH_GROUP - 1u) / NOH_MORPH_GROUP;
    uint32_t g = 0;
    if (j->whole) {
        write_vertices(j, &j->layers, 0, end);
        return;
    }
    if (j->mesh.header->flags & NOH_MESH_TEXELS) {
        write_referring(j);
        return;
    }
    while (g < groups) {
        uint32_t first, last;
        while (g < groups && !j->m->groups[g]) g++;
        first = g * NOH_MORPH_GROUP;
        while (g < groups && j->m->groups[g]) g++;
        last = g * NOH_MORPH_GROUP < end ? g * NOH_MORPH_GROUP : end;
        if (last > first) write_vertices(j, &j->layers, first, last - first);
    }
}

/* ---- changes ---- */

static void mark_target(const noh_gl_morph *m, const noh_mesh *mesh, const noh_target *t)
{
    const noh_rect *rect = mesh->rects + t->first_rect;
    for (uint32_t i = 0; i < t->rect_count; i++, rect++) {
        for (uint32_t y = rect->y; y < (uint32_t)rect->y + rect->h; y++) {
            const uint32_t texel = (y << mesh->header->morph_width_log2) + rect->x;
            for (uint32_t g = texel / NOH_MORPH_GROUP; g <= (texel + rect->w - 1u) / NOH_MORPH_GROUP; g++) {
                m->groups[g] = 1;
            }
        }
    }
}

/* Each run is one call, so a few unchanged groups between two written ones are written too. */
static void close_gaps(uint8_t *groups, uint32_t count)
{
    uint32_t last = UINT32_MAX;
    for (uint32_t g = 0; g < count; g++) {
        if (!groups[g]) continue;
        if (last != UINT32_MAX && g - last <= FEW_GROUPS) memset(groups + last, 1, g - last);
        last = g;
    }
}

/* Mark the groups moved by targets whose weights differ from the slot's. */
static void find_changes(slot_job *j, int may_map)
{
    const noh_gl_morph *m = j->m;
    const float *now = j->weights, *then = weights_of(m, j->instance, j->slot);
    const noh_mesh_header *h = j->mesh.header;
    const uint32_t groups = (h->touched_count + NOH_MORPH_GROUP - 1u) / NOH_MORPH_GROUP;
    uint64_t texels = 0;
    j->whole = *level_of(m, j->instance, j->slot) != m->levels[j->instance] || m->update_count % WHOLE_EVERY == 0;
    for (uint32_t t = 0; t < h->target_count && !j->whole; t++) {
        if (now[t] != then[t]) texels += j->mesh.targets[t].texel_count;
    }
    j->whole |= texels / 4u >= h->touched_count; /* hardly any vertex would be skipped */
    if (j->whole) return;
    memset(m->groups, 0, groups);
    for (uint32_t t = 0; t < h->target_count; t++) {
        if (now[t] != then[t]) mark_target(m, &j->mesh, &j->mesh.targets[t]);
    }
    if (!may_map) close_gaps(m->groups, groups);
}

/* Sums of the written vertices, in the staging memory. */
static void accumulate(slot_job *j)
{
    const noh_gl_morph *m = j->m;
    const noh_mesh_header *h = j->mesh.header;
    const size_t floats = noh_morph_layers_size(&j->mesh) / 12u; /* of a layer */
    float *layers = (float *)m->staging;
    j->layers.position = layers;
    j->layers.normal = layers + floats;
    j->layers.tangent = m->plan.layer_count == 3u ? layers + 2u * floats : NULL;
    for (size_t l = 0; l < m->plan.layer_count; l++) {
        if (j->whole) memset(layers + l * floats, 0, 12u * (size_t)h->touched_count);
        for (size_t g = 0; !j->whole && g * NOH_MORPH_GROUP < h->touched_count; g++) {
            const size_t left = h->touched_count - g * NOH_MORPH_GROUP;
            const size_t count = left < NOH_MORPH_GROUP ? left : NOH_MORPH_GROUP;
            if (m->groups[g]) memset(layers + l * floats + 3u * NOH_MORPH_GROUP * g, 0, 12u * count);
        }
    }
    if (j->whole) {
        m->kernel.accumulate(&j->mesh, j->weights, &j->layers);
    } else {
        m->kernel.accumulate_some(&j->mesh, j->weights, &j->layers, m->groups);
    }
}

/* ---- slots ---- */

static slot_job job_of(noh_gl_morph *m, uint32_t instance, uint32_t slot)
{
    slot_job j;
    memset(&j, 0, sizeof j);
    j.m = m;
    j.mesh = noh_gl_morph_view(m, instance);
    j.instance = instance;
    j.slot = slot;
    j.weights = m->weights + noh_gl_morph_first_weight(m, instance);
    j.stride = noh_morph_finished_stride(&j.mesh);
    j.offset = offset_of(m, instance);
    return j;
}

typedef enum map_result { HAS_MAPPED, CANNOT_MAP, HAS_LOST } map_result;

/* Write a slot through a mapping, if the context can map and the driver does not refuse. */
static map_result write_mapped(slot_job *j)
{
    const noh_gl_api *gl = j->m->gl;
    const GLbitfield whole = j->whole ? GL_MAP_INVALIDATE_RANGE_BIT : 0u;
    const size_t bytes = (size_t)noh_gl_morph_vertex_end(j->mesh.header) * j->stride;
    if (!gl->MapBufferRange || !gl->UnmapBuffer) return CANNOT_MAP;
    j->mapped = (uint8_t *)gl->MapBufferRange(GL_ARRAY_BUFFER, (GLintptr)j->offset, (GLsizeiptr)bytes,
                                              GL_MAP_WRITE_BIT | GL_MAP_UNSYNCHRONIZED_BIT | whole);
    if (!j->mapped) return CANNOT_MAP;
    write_slot(j);
    j->mapped = NULL;
    return gl->UnmapBuffer(GL_ARRAY_BUFFER) == GL_TRUE ? HAS_MAPPED : HAS_LOST;
}

/* Write an instance's part of a buffer completely, including vertices that no target moves. */
static void write_bind_pose(noh_gl_morph *m, uint32_t instance, uint32_t slot)
{
    slot_job j = job_of(m, instance, slot);
    j.mesh = m->meshes[m->instance_mesh[instance]].mesh;
    write_vertices(&j, NULL, 0, j.mesh.header->vertex_count);
}

/* A driver that lost a mapping has lost the whole buffer, with the slots of all instances: rewrite each slot with the
 * weights that it last had. */
static void rewrite_buffer(noh_gl_morph *m, uint32_t slot)
{
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        const noh_mesh *mesh = &m->meshes[m->instance_mesh[i]].mesh;
        const uint8_t level = *level_of(m, i, slot);
        slot_job j = job_of(m, i, slot);
        if (!mesh->header->touched_count) continue;
        write_bind_pose(m, i, slot);
        if (level == NOH_SLOT_STALE) continue;
        j.mesh = noh_mesh_at_lod(mesh, level);
        j.weights = weights_of(m, i, slot);
        j.whole = 1;
        accumulate(&j);
        write_slot(&j);
    }
}

static void update_instance(noh_gl_morph *m, uint32_t instance, int may_map, noh_gl_morph_stats *stats)
{
    const uint32_t slot = (m->slot_drawn[instance] + 1u) % m->plan.vertex_ring;
    slot_job j = job_of(m, instance, slot);
    const noh_morph_cost cost = noh_morph_cost_of(&j.mesh, j.weights);
    map_result mapped = CANNOT_MAP;
    find_changes(&j, may_map);
    accumulate(&j);
    m->gl->BindBuffer(GL_ARRAY_BUFFER, m->ring[slot].name);
    if (may_map) mapped = write_mapped(&j);
    if (mapped == CANNOT_MAP) write_slot(&j);
    memcpy(weights_of(m, instance, slot), j.weights, sizeof *j.weights * j.mesh.header->target_count);
    *level_of(m, instance, slot) = m->levels[instance];
    m->slot_drawn[instance] = (uint8_t)slot;
    if (mapped == HAS_LOST) rewrite_buffer(m, slot);
    stats->targets += cost.targets;
    stats->rects += cost.rects;
    stats->texels += cost.texels;
    stats->pairs += cost.pairs;
}

/* Wait until the GPU no longer draws from the slots that this update writes, and insert a fence for a later update.
 * Return 0 if there are no fences or the wait failed: then do not map. */
static int wait_for_slots(noh_gl_morph *m)
{
    const noh_gl_api *gl = m->gl;
    GLsync *fence = &m->fences[m->update_count % (m->plan.vertex_ring - 1u)];
    int done = 1;
    if (!gl->FenceSync || !gl->ClientWaitSync || !gl->DeleteSync) return 0;
    if (*fence) {
        const GLenum answer = gl->ClientWaitSync(*fence, GL_SYNC_FLUSH_COMMANDS_BIT, WAIT_NS);
        done = answer == GL_ALREADY_SIGNALED || answer == GL_CONDITION_SATISFIED;
        gl->DeleteSync(*fence);
    } else {
        done = m->update_count + 1u < m->plan.vertex_ring; /* else it was refused */
    }
    *fence = gl->FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    return done;
}

void noh_gl_morph_update_vertices(noh_gl_morph *m, noh_gl_morph_stats *stats)
{
    const int may_map = wait_for_slots(m);
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        if (m->dirty[i] && noh_gl_morph_view(m, i).header->touched_count) update_instance(m, i, may_map, stats);
    }
    m->update_count += 1u;
    noh_gl_morph_end(m, NULL);
}

void noh_gl_morph_set_vertices(const noh_gl_morph *m, uint32_t instance, noh_gl_morph_binding *binding)
{
    const noh_mesh *mesh = &m->meshes[m->instance_mesh[instance]].mesh;
    binding->is_uint = NOH_LAYERS_VERTICES;
    binding->tile_x = binding->tile_y = binding->width_log2 = binding->touched = 0;
    if (!mesh->header->touched_count) return;
    binding->vertex_buffer = m->ring[m->slot_drawn[instance]].name;
    binding->vertex_offset = (uint32_t)offset_of(m, instance);
    binding->vertex_stride = noh_morph_finished_stride(mesh);
    binding->vertex_array = *array_of(m, instance, m->slot_drawn[instance]);
}

/* ---- making ---- */

noh_result noh_gl_morph_init_vertices(noh_gl_morph *m, noh_error *error)
{
    const uint64_t bytes = m->plan.vertex_bytes / m->plan.vertex_ring;
    noh_result result = NOH_OK;
    memset(m->slot_levels, NOH_SLOT_STALE, (size_t)m->plan.vertex_ring * m->plan.instance_count);
    memset(m->slot_drawn, 0, m->plan.instance_count);
    memset(m->vertex_arrays, 0, sizeof(GLuint) * m->plan.vertex_ring * m->plan.instance_count);
    m->update_count = 0;
    for (uint32_t slot = 0; slot < m->plan.vertex_ring && result == NOH_OK; slot++) {
        result = noh_gl_buffer_create(m->gl, m->ledger, GL_ARRAY_BUFFER, bytes, NULL, GL_STREAM_DRAW, &m->ring[slot],
                                      error);
        if (result != NOH_OK) break;
        noh_gl_label(m->gl, GL_BUFFER, m->ring[slot].name, "morphed vertices", NULL);
        m->gl->BindBuffer(GL_ARRAY_BUFFER, m->ring[slot].name);
        for (uint32_t i = 0; i < m->plan.instance_count; i++) {
            if (m->meshes[m->instance_mesh[i]].mesh.header->touched_count) write_bind_pose(m, i, slot);
        }
    }
    m->gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    return result;
}

static void delete_arrays(noh_gl_morph *m, const noh_gl_api *gl, uint32_t first, uint32_t count)
{
    for (uint32_t i = 0; i < m->plan.vertex_ring * count; i++) {
        GLuint *array = array_of(m, first + i % count, i / count);
        if (*array) gl->DeleteVertexArrays(1, array);
        *array = 0;
    }
}

noh_result noh_gl_morph_set_mesh(noh_gl_morph *morph, uint32_t mesh, const noh_gl_mesh *drawn, noh_error *error)
{
    const noh_gl_morph_mesh *own;
    noh_result result;
    NOH_ASSERT(morph && mesh < morph->mesh_count && drawn);
    own = &morph->meshes[mesh];
    if (!morph->plan.vertex_ring || !own->mesh.header->touched_count) return NOH_OK;
    noh_gl_error_take(morph->gl);
    delete_arrays(morph, morph->gl, own->first_instance, own->instance_count);
    for (uint32_t i = 0; i < morph->plan.vertex_ring * own->instance_count; i++) {
        const uint32_t instance = own->first_instance + i % own->instance_count, slot = i / own->instance_count;
        GLuint *array = array_of(morph, instance, slot);
        noh_gl_morph_binding at;
        memset(&at, 0, sizeof at);
        at.vertex_buffer = morph->ring[slot].name;
        at.vertex_offset = (uint32_t)offset_of(morph, instance);
        at.vertex_stride = noh_morph_finished_stride(&own->mesh);
        *array = noh_gl_mesh_make_array(morph->gl, drawn, &at);
        if (*array) noh_gl_label(morph->gl, GL_VERTEX_ARRAY, *array, "morphed", own->mesh.name);
    }
    result = noh_gl_error_check(morph->gl, "the driver refused vertex arrays of morphed vertices", 0, error);
    if (result) delete_arrays(morph, morph->gl, own->first_instance, own->instance_count);
    return result;
}

void noh_gl_morph_delete_vertices(noh_gl_morph *m, const noh_gl_api *gl)
{
    for (uint32_t i = 0; i + 1u < NOH_VERTEX_RING_MAX; i++) {
        if (m->fences[i] && gl->DeleteSync) gl->DeleteSync(m->fences[i]);
        m->fences[i] = NULL;
    }
    if (m->plan.vertex_ring) delete_arrays(m, gl, 0, m->plan.instance_count);
    for (uint32_t i = 0; i < NOH_VERTEX_RING_MAX; i++) noh_gl_buffer_delete(gl, m->ledger, &m->ring[i]);
}
