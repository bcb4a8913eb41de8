/* gl_morph_streams.c: the path streams: deltas as vertex attributes, added in the vertex shader of the draw itself.
 *
 * Each target has a stream of three words per vertex, in the format of delta texels, also for vertices that it does not
 * move: a target always takes 12 bytes per vertex on the GPU. In return there is no render target and no texture fetch,
 * and changed weights cost only uniforms. Granberg, Character Animation with Direct3D, 2009, chapter 8, binds four
 * targets as whole meshes, with texture coordinates that nothing reads. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "gl/morph/gl_morph_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "gl/device/gl_names_internal.h"
#include "gl/device/gl_debug_internal.h"

#define STREAM_CHUNK (NOH_STREAM_CHUNK / NOH_STREAM_STRIDE) /* vertices sent at once at load */

/* ---- making ---- */

/* A target's delta texel for an accumulation texel; zeros if it has none. Rectangles of a target may overlap: a vertex
 * that the target moves has its delta in one of them, and zeros in the others. */
static void find_delta(const noh_mesh *mesh, const noh_target *target, uint32_t texel, uint32_t words[3])
{
    const uint32_t x = texel & ((1u << mesh->header->morph_width_log2) - 1u);
    const uint32_t y = texel >> mesh->header->morph_width_log2;
    const uint32_t *of_rect = mesh->texels + 3u * (size_t)target->first_texel;
    const noh_rect *rect = mesh->rects + target->first_rect;
    memset(words, 0, 12);
    for (uint32_t r = 0; r < target->rect_count && !(words[0] | words[1] | words[2]); r++, rect++) {
        if (x - rect->x < rect->w && y - rect->y < rect->h) { /* unsigned: wraps to a large number below the corner */
            memcpy(words, of_rect + 3u * (size_t)((y - rect->y) * rect->w + (x - rect->x)), 12);
        }
        of_rect += 3u * (size_t)rect->w * rect->h;
    }
}

static void upload_stream(noh_gl_morph *m, const noh_mesh *mesh, uint32_t target, uint64_t at)
{
    const uint32_t count = mesh->header->vertex_count;
    uint32_t *words = (uint32_t *)m->staging;
    for (uint32_t first = 0; first < count; first += STREAM_CHUNK) {
        const uint32_t now = count - first < STREAM_CHUNK ? count - first : STREAM_CHUNK;
        for (uint32_t i = 0; i < now; i++) {
            const uint32_t texel = noh_mesh_accumulation_texel(mesh, first + i);
            if (texel < mesh->header->touched_count) {
                find_delta(mesh, &mesh->targets[target], texel, words + 3u * i);
            } else {
                memset(words + 3u * i, 0, 12);
            }
        }
        m->gl->BufferSubData(GL_ARRAY_BUFFER, (GLintptr)(at + NOH_STREAM_STRIDE * (uint64_t)first),
                             (GLsizeiptr)(NOH_STREAM_STRIDE * now), words);
    }
}

/* Byte offset of a mesh's streams. */
static uint64_t first_byte(const noh_gl_morph *m, uint32_t owner)
{
    uint64_t at = 0;
    for (uint32_t i = 0; i < owner; i++) {
        if (m->meshes[i].owner == i) at += noh_gl_morph_stream_bytes(m->meshes[i].mesh.header);
    }
    return at;
}

uint64_t noh_gl_morph_stream_bytes(const noh_mesh_header *h)
{
    return NOH_STREAM_STRIDE * (uint64_t)h->vertex_count * h->target_count;
}

noh_result noh_gl_morph_init_streams(noh_gl_morph *m, noh_error *error)
{
    noh_result result = noh_gl_buffer_create(m->gl, m->ledger, GL_ARRAY_BUFFER, m->plan.delta_bytes, NULL,
                                             GL_STATIC_DRAW, &m->stream, error);
    if (result) return result;
    noh_gl_label(m->gl, GL_BUFFER, m->stream.name, "morph streams", NULL);
    m->gl->BindBuffer(GL_ARRAY_BUFFER, m->stream.name);
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const noh_mesh *mesh = &m->meshes[i].mesh;
        if (m->meshes[i].owner != i) continue;
        for (uint32_t t = 0; t < mesh->header->target_count; t++) {
            upload_stream(m, mesh, t, first_byte(m, i) + NOH_STREAM_STRIDE * (uint64_t)mesh->header->vertex_count * t);
        }
    }
    m->gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    return NOH_OK;
}

/* ---- drawing ---- */

uint32_t noh_gl_morph_streamed(const noh_mesh *mesh, const float *weights, uint32_t targets[NOH_MORPH_STREAMS_MAX])
{
    float moves[NOH_MORPH_STREAMS_MAX] = { 0.0f };
    uint32_t count = 0;
    NOH_ASSERT(mesh && (weights || !mesh->header->target_count) && targets);
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        const float own = (weights[t] < 0.0f ? -weights[t] : weights[t]) * mesh->targets[t].radius;
        uint32_t least = 0;
        if (weights[t] == 0.0f || !mesh->targets[t].rect_count) continue;
        for (uint32_t i = 1; i < count; i++) least = moves[i] < moves[least] ? i : least;
        if (count == NOH_MORPH_STREAMS_MAX && own <= moves[least]) continue;
        least = count < NOH_MORPH_STREAMS_MAX ? count++ : least;
        targets[least] = t;
        moves[least] = own;
    }
    for (uint32_t i = 0; i < count; i++) { /* sums are in index order */
        for (uint32_t k = i + 1u; k < count; k++) {
            const uint32_t low = targets[i] < targets[k] ? targets[i] : targets[k];
            targets[k] = targets[i] + targets[k] - low;
            targets[i] = low;
        }
    }
    return count;
}

void noh_gl_morph_set_streams(const noh_gl_morph *m, uint32_t instance, noh_gl_morph_binding *binding)
{
    const noh_mesh mesh = noh_gl_morph_view(m, instance);
    const noh_gl_morph_mesh *own = &m->meshes[m->instance_mesh[instance]];
    const noh_mesh_header *owner = m->meshes[own->owner].mesh.header;
    const float *weights = m->weights + noh_gl_morph_first_weight(m, instance);
    const uint64_t first = first_byte(m, own->owner);
    uint32_t targets[NOH_MORPH_STREAMS_MAX];
    const uint32_t count = noh_gl_morph_streamed(&mesh, weights, targets);
    binding->is_uint = NOH_LAYERS_STREAMS;
    binding->stream_buffer = m->stream.name;
    for (uint32_t i = 0; i < NOH_MORPH_STREAMS_MAX; i++) {
        float *stream = binding->streams[i];
        binding->stream_offsets[i] = (uint32_t)first; /* unused: any stream, with weight 0 */
        stream[0] = stream[1] = stream[2] = 0.0f;
        stream[3] = 8.0f * (1u + (1u << 8) + (1u << 16));
        if (i < count) {
            const noh_target *target = &mesh.targets[targets[i]];
            uint32_t record[4];
            noh_gl_morph_put_record(record, target, weights[targets[i]], 0);
            memcpy(stream, record, 12);
            stream[3] = (float)noh_gl_morph_target_bits(target); /* below 2^24: exact */
            binding->stream_offsets[i] += NOH_STREAM_STRIDE * owner->vertex_count * targets[i];
        }
    }
}

void noh_gl_morph_bind_streams(const noh_gl_api *gl, GLint u_streams, const noh_gl_morph_binding *binding)
{
    NOH_ASSERT(gl && binding);
    if (!binding->stream_buffer) return;
    gl->BindBuffer(GL_ARRAY_BUFFER, binding->stream_buffer);
    for (GLuint i = 0; i < NOH_MORPH_STREAMS_MAX; i++) {
        gl->EnableVertexAttribArray(NOH_ATTRIBUTE_STREAMS + i);
        gl->VertexAttribIPointer(NOH_ATTRIBUTE_STREAMS + i, 3, GL_UNSIGNED_INT, NOH_STREAM_STRIDE,
                                 (const void *)(uintptr_t)binding->stream_offsets[i]);
    }
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    gl->Uniform4fv(u_streams, NOH_MORPH_STREAMS_MAX, binding->streams[0]);
}

void noh_gl_morph_update_streams(const noh_gl_morph *m, noh_gl_morph_stats *stats)
{
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        const noh_mesh mesh = noh_gl_morph_view(m, i);
        uint32_t targets[NOH_MORPH_STREAMS_MAX];
        if (!m->dirty[i]) continue;
        stats->targets += noh_gl_morph_streamed(&mesh, m->weights + noh_gl_morph_first_weight(m, i), targets);
    }
}
