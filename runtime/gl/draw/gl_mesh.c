/* gl_mesh.c: a pack's meshes as GL objects.
 *
 * All LOD levels of a mesh share its buffers. The vertices of a coarser level are the first ones of the finer level,
 * and its indices follow the finer level's. A draw therefore chooses a level by an offset into the index buffer, and a
 * vertex keeps its number, which selects its accumulation texel, at every level. */
#include "core/base/assert_internal.h"
#include "core/mesh/mesh_internal.h"
#include "gl/device/gl_api_internal.h"
#include "gl/draw/gl_draw_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#include "gl/morph/gl_morph_internal.h"
#include "gl/device/gl_names_internal.h"
#include "gl/device/gl_debug_internal.h"
#include "gl/draw/gl_renderer_internal.h"

static uint64_t position_bytes(const noh_mesh *mesh)
{
    return (uint64_t)mesh->header->vertex_count * 12u;
}

static uint64_t attribute_bytes(const noh_mesh *mesh)
{
    return (uint64_t)mesh->header->vertex_count * mesh->header->attribute_stride;
}

/* Indices of this LOD level and of all coarser ones, whose headers and indices follow in the pack. */
static uint64_t index_count(const noh_mesh *mesh)
{
    const noh_mesh_header *h = mesh->header;
    uint64_t count = h->index_count;
    for (uint32_t k = h->level + 1u; k < h->level_count; k++) {
        count += h[k - h->level].index_count;
    }
    return count;
}

/* A mesh without triangles gets 4 bytes: GL has no empty buffers. */
static uint64_t index_bytes(const noh_mesh *mesh)
{
    uint64_t bytes = index_count(mesh) * mesh->header->index_bytes;
    return bytes ? bytes : 4u;
}

static uint64_t influence_bytes(const noh_mesh *mesh)
{
    return (uint64_t)mesh->header->vertex_count * NOH_INFLUENCE_WORDS(mesh->header->influence_count) * 4u;
}

static uint32_t record_bytes(const noh_mesh *mesh)
{
    const noh_transfer_header *h = mesh->transfer;
    return h ? NOH_TRANSFER_RECORD_BYTES(h->order, h->flags) : 0;
}

static uint64_t transfer_bytes(const noh_mesh *mesh)
{
    return (uint64_t)mesh->header->vertex_count * record_bytes(mesh);
}

static const uint8_t *records_of(const noh_mesh *mesh)
{
    return mesh->transfer ? (const uint8_t *)mesh->transfer + mesh->transfer->records_offset : NULL;
}

uint64_t noh_gl_mesh_bytes(const noh_mesh *mesh)
{
    NOH_ASSERT(mesh && mesh->header);
    return position_bytes(mesh) + attribute_bytes(mesh) + influence_bytes(mesh) + transfer_bytes(mesh) +
           index_bytes(mesh);
}

static void set_attribute(const noh_gl_api *gl, GLuint location, GLint size, GLenum type, GLboolean normalized,
                          uint32_t stride, int offset)
{
    if (offset >= 0) {
        gl->EnableVertexAttribArray(location);
        gl->VertexAttribPointer(location, size, type, normalized, (GLsizei)stride, (const void *)(uintptr_t)offset);
    }
}

/* Directions are integer attributes, because drivers differ in how they convert normalised ones to floats. */
static void set_pair(const noh_gl_api *gl, GLuint location, uint32_t stride, int offset)
{
    if (offset >= 0) {
        gl->EnableVertexAttribArray(location);
        gl->VertexAttribIPointer(location, 2, GL_SHORT, (GLsizei)stride, (const void *)(uintptr_t)offset);
    }
}

/* type: as the shader declares them, signed or not */
static void set_words(const noh_gl_api *gl, GLuint location, uint32_t words, GLenum type, uint32_t stride,
                      uint32_t offset)
{
    gl->EnableVertexAttribArray(location);
    gl->VertexAttribIPointer(location, (GLint)words, type, (GLsizei)stride, (const void *)(uintptr_t)offset);
}

/* The words of a vertex's influences, as common_skin.glsl reads them. Seven words take two attributes, of four and
 * three words. */
static void set_influences(const noh_gl_api *gl, const noh_gl_mesh *m)
{
    uint32_t words = NOH_INFLUENCE_WORDS(m->mesh.header->influence_count);
    gl->BindBuffer(GL_ARRAY_BUFFER, m->influences.name);
    set_words(gl, NOH_ATTRIBUTE_INFLUENCES, words > 4u ? 4u : words, GL_UNSIGNED_INT, 4u * words, 0);
    if (words > 4u) {
        set_words(gl, NOH_ATTRIBUTE_MORE_INFLUENCES, words - 4u, GL_UNSIGNED_INT, 4u * words, 16);
    }
}

/* The bytes of a record as common_transfer.glsl reads them. */
static void set_lobe(const noh_gl_api *gl, const noh_gl_mesh *m)
{
    const GLint bytes = (GLint)record_bytes(&m->mesh);
    gl->BindBuffer(GL_ARRAY_BUFFER, m->transfer.name);
    gl->EnableVertexAttribArray(NOH_ATTRIBUTE_LOBE);
    gl->VertexAttribIPointer(NOH_ATTRIBUTE_LOBE, 4, GL_BYTE, bytes, NULL);
    if (bytes > 4) {
        gl->EnableVertexAttribArray(NOH_ATTRIBUTE_MORE_LOBE);
        gl->VertexAttribIPointer(NOH_ATTRIBUTE_MORE_LOBE, bytes - 4, GL_BYTE, bytes, (const void *)(uintptr_t)4u);
    }
}

/* The words of extra attributes, in front of a record's texels; as integers, which drivers do not convert. */
static void set_extras(const noh_gl_api *gl, const noh_mesh_header *h)
{
    const uint32_t words = h->extra_words, stride = h->attribute_stride, at = noh_mesh_extra_offset(h);
    if (words) set_words(gl, NOH_ATTRIBUTE_EXTRA, words > 4u ? 4u : words, GL_INT, stride, at);
    if (words > 4u) set_words(gl, NOH_ATTRIBUTE_MORE_EXTRA, words - 4u, GL_INT, stride, at + 16u);
}

static void label_mesh(const noh_gl_api *gl, const noh_gl_mesh *m)
{
    noh_gl_label(gl, GL_BUFFER, m->positions.name, "positions of", m->mesh.name);
    noh_gl_label(gl, GL_BUFFER, m->attributes.name, "attributes of", m->mesh.name);
    if (m->influences.name) {
        noh_gl_label(gl, GL_BUFFER, m->influences.name, "influences of", m->mesh.name);
    }
    if (m->transfer.name) {
        noh_gl_label(gl, GL_BUFFER, m->transfer.name, "transfer of", m->mesh.name);
    }
    noh_gl_label(gl, GL_BUFFER, m->indices.name, "indices of", m->mesh.name);
    noh_gl_label(gl, GL_VERTEX_ARRAY, m->vertex_array, "mesh", m->mesh.name);
}

/* Attributes replaced by finished vertices. */
static void point_to_bind_pose(const noh_gl_api *gl, const noh_gl_mesh *m)
{
    const uint32_t stride = m->mesh.header->attribute_stride;
    gl->BindBuffer(GL_ARRAY_BUFFER, m->positions.name);
    set_attribute(gl, NOH_ATTRIBUTE_POSITION, 3, GL_FLOAT, GL_FALSE, 12, 0);
    gl->BindBuffer(GL_ARRAY_BUFFER, m->attributes.name);
    set_pair(gl, NOH_ATTRIBUTE_NORMAL, stride, 0);
    set_pair(gl, NOH_ATTRIBUTE_TANGENT, stride, noh_mesh_tangent_offset(&m->mesh));
}

static void point_to_rest(const noh_gl_api *gl, const noh_gl_mesh *m)
{
    gl->BindBuffer(GL_ARRAY_BUFFER, m->positions.name);
    set_attribute(gl, NOH_ATTRIBUTE_REST, 3, GL_FLOAT, GL_FALSE, 12, 0);
    gl->BindBuffer(GL_ARRAY_BUFFER, m->attributes.name);
    set_pair(gl, NOH_ATTRIBUTE_REST_NORMAL, m->mesh.header->attribute_stride, 0);
}

static void point_to_finished(const noh_gl_api *gl, const noh_gl_morph_binding *morph)
{
    const uint32_t stride = morph->vertex_stride;
    const uintptr_t at = morph->vertex_offset;
    gl->BindBuffer(GL_ARRAY_BUFFER, morph->vertex_buffer);
    gl->VertexAttribPointer(NOH_ATTRIBUTE_POSITION, 3, GL_FLOAT, GL_FALSE, (GLsizei)stride, (const void *)at);
    gl->VertexAttribIPointer(NOH_ATTRIBUTE_NORMAL, 2, GL_SHORT, (GLsizei)stride, (const void *)(at + 12u));
    if (stride == 20u) {
        gl->VertexAttribIPointer(NOH_ATTRIBUTE_TANGENT, 2, GL_SHORT, (GLsizei)stride, (const void *)(at + 16u));
    }
}

void noh_gl_mesh_bind(const noh_gl_api *api, const noh_gl_mesh *mesh, const noh_gl_morph_binding *morph)
{
    NOH_ASSERT(api && mesh && mesh->vertex_array);
    api->BindVertexArray(morph && morph->vertex_array ? morph->vertex_array : mesh->vertex_array);
    if (!morph || !morph->vertex_buffer || morph->vertex_array) return;
    point_to_finished(api, morph);
    api->BindBuffer(GL_ARRAY_BUFFER, 0);
}

void noh_gl_mesh_unbind(const noh_gl_api *api, const noh_gl_mesh *mesh, const noh_gl_morph_binding *morph)
{
    NOH_ASSERT(api && mesh && mesh->vertex_array);
    if (morph && !morph->vertex_array && (morph->vertex_buffer || morph->stream_buffer)) {
        api->BindVertexArray(mesh->vertex_array);
        if (morph->vertex_buffer) {
            point_to_bind_pose(api, mesh);
        } else {
            point_to_rest(api, mesh); /* replaced by streams */
        }
        api->BindBuffer(GL_ARRAY_BUFFER, 0);
    }
    api->BindVertexArray(0);
}

GLuint noh_gl_mesh_make_array(const noh_gl_api *gl, const noh_gl_mesh *m, const noh_gl_morph_binding *morph)
{
    const uint32_t stride = m->mesh.header->attribute_stride;
    GLuint array = 0;
    gl->GenVertexArrays(1, &array);
    if (!array) return 0;
    gl->BindVertexArray(array);
    point_to_bind_pose(gl, m);
    if (morph) point_to_finished(gl, morph);
    point_to_rest(gl, m);
    set_attribute(gl, NOH_ATTRIBUTE_UV, 2, GL_UNSIGNED_SHORT, GL_TRUE, stride, noh_mesh_uv_offset(&m->mesh));
    set_attribute(gl, NOH_ATTRIBUTE_COLOR, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride, noh_mesh_color_offset(&m->mesh));
    if (m->mesh.header->flags & NOH_MESH_TEXELS) {
        set_words(gl, NOH_ATTRIBUTE_TEXEL, 1, GL_UNSIGNED_INT, stride, stride - 4u);
    }
    if (m->mesh.header->flags & NOH_MESH_UV_TARGETS) {
        set_words(gl, NOH_ATTRIBUTE_UV_TEXEL, 1, GL_INT, stride, stride - 8u);
    }
    set_extras(gl, m->mesh.header);
    if (m->influences.name) {
        set_influences(gl, m);
    }
    if (m->transfer.name) {
        set_lobe(gl, m);
    }
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, m->indices.name);
    gl->BindVertexArray(0);
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    return array;
}

static noh_result make_array(const noh_gl_api *api, noh_gl_mesh *m, noh_error *error)
{
    m->vertex_array = noh_gl_mesh_make_array(api, m, NULL);
    label_mesh(api, m);
    return noh_gl_error_check(api, "the driver refused the vertex array of a mesh", 0, error);
}

/* room: determines the sizes; mesh: the mesh to draw; contents: `mesh`, or NULL for none. */
static noh_result make(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_mesh *room, const noh_mesh *mesh,
                       const noh_mesh *contents, noh_gl_mesh *out, noh_error *error)
{
    noh_gl_mesh m = { *mesh, room->header, 0, { 0, 0 }, { 0, 0 }, { 0, 0 }, { 0, 0 }, { 0, 0 }, 0 };
    static const uint32_t no_indices = 0;
    const void *indices = !contents ? NULL : index_count(mesh) ? mesh->indices : &no_indices;
    noh_result result;
    NOH_ASSERT(api && ledger && out);
    m.index_type = room->header->index_bytes == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;
    noh_gl_error_take(api);
    api->BindVertexArray(0);
    result = noh_gl_error_check(api, "the driver refused to unbind a vertex array", 0, error);
    if (!result) {
        result = noh_gl_buffer_create(api, ledger, GL_ARRAY_BUFFER, position_bytes(room),
                                      contents ? contents->positions : NULL, GL_STATIC_DRAW, &m.positions, error);
    }
    if (!result) {
        result = noh_gl_buffer_create(api, ledger, GL_ARRAY_BUFFER, attribute_bytes(room),
                                      contents ? contents->attributes : NULL, GL_STATIC_DRAW, &m.attributes, error);
    }
    if (!result && influence_bytes(room)) {
        result = noh_gl_buffer_create(api, ledger, GL_ARRAY_BUFFER, influence_bytes(room),
                                      contents ? contents->influences : NULL, GL_STATIC_DRAW, &m.influences, error);
    }
    if (!result && transfer_bytes(room)) {
        result = noh_gl_buffer_create(api, ledger, GL_ARRAY_BUFFER, transfer_bytes(room),
                                      contents ? records_of(contents) : NULL, GL_STATIC_DRAW, &m.transfer, error);
    }
    if (!result) {
        result = noh_gl_buffer_create(api, ledger, GL_ELEMENT_ARRAY_BUFFER, index_bytes(room), indices, GL_STATIC_DRAW,
                                      &m.indices, error);
    }
    if (result) {
        noh_gl_mesh_delete(api, ledger, &m);
        return result;
    }
    result = make_array(api, &m, error);
    if (result) {
        noh_gl_mesh_delete(api, ledger, &m);
        return result;
    }
    *out = m;
    return NOH_OK;
}

noh_result noh_gl_mesh_create_on(const noh_gl_api *api, const noh_mesh *mesh, const noh_gl_mesh *of, noh_gl_mesh *out,
                                 noh_error *error)
{
    noh_gl_mesh m = *of;
    noh_result result;
    m.mesh = *mesh;
    noh_gl_error_take(api);
    result = make_array(api, &m, error);
    if (result) {
        if (m.vertex_array) api->DeleteVertexArrays(1, &m.vertex_array);
        return result;
    }
    *out = m;
    return NOH_OK;
}

noh_result noh_gl_mesh_create(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_mesh *mesh, noh_gl_mesh *out,
                              noh_error *error)
{
    return make(api, ledger, mesh, mesh, mesh, out, error);
}

noh_result noh_gl_mesh_create_empty(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_mesh *room,
                                    const noh_mesh *mesh, noh_gl_mesh *out, noh_error *error)
{
    return make(api, ledger, room, mesh, NULL, out, error);
}

/* ---- filling ---- */

#define FILL_INDICES 256u /* converted at once, if pack and buffer have different index widths */

/* Byte offset of a level's indices in the buffer. */
static size_t first_index_byte(const noh_gl_mesh *m, uint32_t level)
{
    size_t count = 0;
    for (uint32_t k = m->room->level; k < level; k++) count += m->room[k - m->room->level].index_count;
    return count * m->room->index_bytes;
}

typedef struct filler {
    const noh_gl_api *gl;
    uint64_t *at; /* bytes filled, over all arrays in order */
    uint64_t begin;
    uint32_t *bytes;
} filler;

/* The number of bytes to fill next in an array of `count` bytes, from offset *from. */
static uint32_t next_bytes(const filler *f, uint64_t count, uint64_t *from)
{
    uint64_t left = 0;
    *from = 0;
    if (*f->at >= f->begin) { /* otherwise an earlier array is not complete yet */
        *from = *f->at - f->begin;
        left = *from < count ? count - *from : 0;
    }
    return left < *f->bytes ? (uint32_t)left : *f->bytes;
}

static void sent(const filler *f, uint32_t bytes)
{
    *f->at += bytes;
    *f->bytes -= bytes;
}

static void fill_array(filler *f, const noh_gl_buffer *to, const void *data, uint64_t count)
{
    uint64_t from;
    uint32_t bytes = next_bytes(f, count, &from);
    if (from + bytes < count) bytes &= ~3u; /* whole words, except at the end of the array */
    if (bytes) {
        f->gl->BindBuffer(GL_ARRAY_BUFFER, to->name);
        f->gl->BufferSubData(GL_ARRAY_BUFFER, (GLintptr)from, (GLsizeiptr)bytes, (const uint8_t *)data + from);
        f->gl->BindBuffer(GL_ARRAY_BUFFER, 0);
        sent(f, bytes);
    }
    f->begin += count;
}

static void convert_indices(const noh_mesh *mesh, size_t first, uint32_t count, uint32_t to_bytes, void *to)
{
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t index = mesh->header->index_bytes == 2 ? ((const uint16_t *)mesh->indices)[first + i]
                                                              : ((const uint32_t *)mesh->indices)[first + i];
        if (to_bytes == 2) {
            ((uint16_t *)to)[i] = (uint16_t)index;
        } else {
            ((uint32_t *)to)[i] = index;
        }
    }
}

static void fill_indices(filler *f, const noh_gl_mesh *m, const noh_mesh *mesh)
{
    const uint32_t each = m->room->index_bytes, own = mesh->header->index_bytes;
    const uint64_t count = index_count(mesh) * each;
    const size_t to = first_index_byte(m, mesh->header->level);
    uint32_t converted[FILL_INDICES];
    uint64_t from;
    uint32_t bytes;
    f->gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, m->indices.name);
    while ((bytes = next_bytes(f, count, &from) / each * each) > 0) {
        const uint8_t *data = (const uint8_t *)mesh->indices + from;
        if (own != each) {
            bytes = bytes < FILL_INDICES * each ? bytes : FILL_INDICES * each;
            convert_indices(mesh, (size_t)(from / each), bytes / each, each, converted);
            data = (const uint8_t *)converted;
        }
        f->gl->BufferSubData(GL_ELEMENT_ARRAY_BUFFER, (GLintptr)(to + from), (GLsizeiptr)bytes, data);
        sent(f, bytes);
    }
    f->gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    f->begin += count;
}

int noh_gl_mesh_fill(const noh_gl_api *api, const noh_gl_mesh *mesh, const noh_mesh *from, uint64_t *at,
                     uint32_t *bytes)
{
    filler f = { api, at, 0, bytes };
    NOH_ASSERT(api && mesh && mesh->vertex_array && from->header->level >= mesh->room->level);
    api->BindVertexArray(0);
    fill_array(&f, &mesh->positions, from->positions, position_bytes(from));
    fill_array(&f, &mesh->attributes, from->attributes, attribute_bytes(from));
    fill_array(&f, &mesh->influences, from->influences, influence_bytes(from));
    if (record_bytes(from) == record_bytes(&mesh->mesh)) {
        fill_array(&f, &mesh->transfer, records_of(from), transfer_bytes(from));
    }
    fill_indices(&f, mesh, from);
    return *at >= f.begin;
}

noh_result noh_gl_mesh_restore(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_mesh *mesh, noh_error *error)
{
    NOH_ASSERT(mesh && mesh->mesh.header);
    noh_mesh view = mesh->mesh;
    noh_gl_mesh_delete(noh_gl_lost_api(), ledger, mesh);
    return noh_gl_mesh_create(api, ledger, &view, mesh, error);
}

noh_mesh noh_gl_mesh_lod(const noh_gl_mesh *mesh, uint32_t level, size_t *first)
{
    NOH_ASSERT(mesh && mesh->mesh.header && first);
    const noh_mesh view = level > mesh->mesh.header->level ? noh_mesh_at_lod(&mesh->mesh, level) : mesh->mesh;
    *first = first_index_byte(mesh, view.header->level);
    return view;
}

void noh_gl_mesh_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_mesh *mesh)
{
    NOH_ASSERT(api && ledger && mesh);
    if (mesh->vertex_array) {
        api->DeleteVertexArrays(1, &mesh->vertex_array);
        mesh->vertex_array = 0;
    }
    noh_gl_buffer_delete(api, ledger, &mesh->positions);
    noh_gl_buffer_delete(api, ledger, &mesh->attributes);
    noh_gl_buffer_delete(api, ledger, &mesh->influences);
    noh_gl_buffer_delete(api, ledger, &mesh->transfer);
    noh_gl_buffer_delete(api, ledger, &mesh->indices);
}
