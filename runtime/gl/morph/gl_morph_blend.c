/* gl_morph_blend.c: the paths layered, mrt and per-layer, which add by GPU blending.
 *
 * Each rectangle of an active target is drawn over its place in the instance's tile, with blending ONE, ONE: in strips,
 * its part in one row of blocks of 4 x 4 texels, each a quad of one indexed draw. The fragment decodes the delta texel
 * under it and multiplies it by weight and scale. Alpha plays no part, so weights below 0 and above 1 work. All quads
 * of all instances are one draw, or one for each NOH_BATCH_QUADS of them.
 *
 * A software rasteriser shades whole blocks, and blocks on a quad's diagonal twice, once for each triangle. There each
 * block is a point of size 4, if the probe found that such a point covers its sixteen texels once and no other
 * (noh_gl_caps.block_points). Outside the rectangle the deltas of a block are zeros. llvmpipe keeps the setup of
 * points, about 400 bytes each, until a flush, so draws are flushed before this data outgrows the processor's cache
 * (measured on 290 targets, 13,000 points: 1.6 times slower without). Only llvmpipe itself is flushed: zink (Mesa
 * 22.3.6) loses sums at a flush.
 *
 * Why the bits equal the CPU's: blending happens in the order in which primitives are submitted (OpenGL ES 3.2, 2.1),
 * and they are submitted target by target in index order, the order in which deform.h adds. Each sum therefore has the
 * same terms in the same order, and the same bits wherever the blender adds in float32; sums begin at +0, and adding a
 * zero of either sign changes none of them.
 *
 * Microsoft's SparseMorphTargets sample (DirectX SDK) draws targets additively, each cut to what it changes, through a
 * geometry shader that sends a triangle to three render targets. It blends by source alpha and starts from the base
 * mesh. Here only deltas are summed, so a half-float accumulator never rounds the base. */
#include <string.h>

#include "gl/device/gl_api_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "gl/morph/gl_morph_internal.h"
#include "gl/device/gl_state_internal.h"
#include "gl/device/gl_debug_internal.h"
#include "shaders.gen.h"

/* ---- making ---- */

/* Defines for the layers drawn in a pass, for two layers, and for occlusion. */
#define DEFINES_OF(pass)                                                                \
    {                                                                                   \
        { pass, pass "#define OCCLUSION\n" },                                           \
        {                                                                               \
            pass "#define TWO_LAYERS\n", pass "#define TWO_LAYERS\n#define OCCLUSION\n" \
        }                                                                               \
    }

noh_result noh_gl_morph_compile_blend(noh_gl_morph *m, char *log, size_t log_bytes, noh_error *error)
{
    static const char *const samplers[] = { "u_deltas", "u_records" };
    static const char *const defines[5][2][2] = { DEFINES_OF(""), DEFINES_OF("#define MORPH_MRT\n"),
                                                  DEFINES_OF("#define MORPH_POINTS\n"),
                                                  DEFINES_OF("#define MORPH_MRT\n#define MORPH_POINTS\n"),
                                                  DEFINES_OF("#define MORPH_LAYERED\n") };
    const int pass = m->plan.path == NOH_MORPH_LAYERED ? 4 : (m->plan.path == NOH_MORPH_MRT) + 2 * (int)m->plan.points;
    noh_gl_program_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.name = noh_morph_path_name(m->plan.path);
    desc.vertex = &noh_shader_morph_block_vert;
    desc.fragment = &noh_shader_morph_one_frag;
    desc.samplers = samplers;
    desc.sampler_count = 2;
    desc.ledger = m->ledger;
    desc.defines = defines[pass][m->plan.layer_count == 2u][m->plan.occlusion];
    if (m->plan.path == NOH_MORPH_MRT) {
        desc.fragment = &noh_shader_morph_mrt_frag;
    } else if (m->plan.path == NOH_MORPH_LAYERED) {
        desc.geometry = &noh_shader_morph_layered_geom;
        desc.version = noh_gl_geometry_version(m->gl);
        desc.geometry_defines = noh_gl_geometry_defines(m->gl);
    }
    return noh_gl_program_create(m->gl, &desc, &m->program, log, log_bytes, error);
}

static noh_result create_framebuffers(noh_gl_morph *m, noh_error *error)
{
    noh_result result = NOH_OK;
    if (m->plan.path == NOH_MORPH_MRT) {
        return noh_gl_morph_framebuffer(m, NOH_LAYERS_ALL, &m->framebuffers[0], error);
    }
    if (m->plan.path == NOH_MORPH_LAYERED) {
        return noh_gl_morph_framebuffer(m, NOH_LAYERS_LAYERED, &m->framebuffers[0], error);
    }
    for (int layer = 0; layer < (int)m->plan.layer_count && !result; layer++) {
        result = noh_gl_morph_framebuffer(m, layer, &m->framebuffers[layer], error);
    }
    return result;
}

/* Two triangles for every four vertices, in the order of a strip. */
static noh_result create_indices(noh_gl_morph *m, noh_error *error)
{
    static const uint8_t corners[6] = { 0, 1, 2, 2, 1, 3 };
    const uint32_t count = 6u * m->batch.entries;
    const uint32_t most = NOH_TILE_CHUNK * 64u; /* 8 KiB, which the staging memory has */
    uint16_t *indices = (uint16_t *)m->staging;
    noh_result result = noh_gl_buffer_create(m->gl, m->ledger, GL_ELEMENT_ARRAY_BUFFER, 2u * (uint64_t)count, NULL,
                                             GL_STATIC_DRAW, &m->indices, error);
    if (result) return result;
    noh_gl_label(m->gl, GL_BUFFER, m->indices.name, "morph quads", NULL);
    m->gl->BindVertexArray(m->vertex_array);
    m->gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, m->indices.name);
    for (uint32_t at = 0; at < count; at += most) {
        const uint32_t now = count - at < most ? count - at : most;
        for (uint32_t i = 0; i < now; i++) indices[i] = (uint16_t)((at + i) / 6u * 4u + corners[(at + i) % 6u]);
        m->gl->BufferSubData(GL_ELEMENT_ARRAY_BUFFER, (GLintptr)(2u * at), (GLsizeiptr)(2u * now), indices);
    }
    m->gl->BindVertexArray(0);
    return noh_gl_error_check(m->gl, "the driver refused the indices of the accumulator", 0, error);
}

noh_result noh_gl_morph_init_blend(noh_gl_morph *m, char *log, size_t log_bytes, noh_error *error)
{
    noh_result result = noh_gl_table_create(m->gl, m->ledger, GL_RGBA32UI, m->plan.weight_count, &m->record_table,
                                            error);
    if (!result && !m->program) result = noh_gl_morph_compile_blend(m, log, log_bytes, error);
    if (!result) result = create_framebuffers(m, error);
    if (!result) result = noh_gl_morph_stream(m, "a_block", 3, m->batch.bytes, 0, error);
    if (!result && !m->plan.points) result = create_indices(m, error);
    if (!result) {
        noh_gl_morph_constants(m);
        m->u_layer = m->gl->GetUniformLocation(m->program, "u_layer");
    }
    return result;
}

/* ---- updating ---- */

/* Vertices of blocks. All are sent to the buffer before the first draw, so the driver need not order uploads and draws:
 * zink (Mesa 22.3.6) lost draws when batches were sent in between. */
typedef struct batch {
    noh_gl_morph *m;
    uint32_t (*vertices)[3];  /* texel of the atlas x | y << 16, texel of the tiles likewise, record of the target */
    uint32_t count, capacity; /* points, or quads of four vertices */
    uint32_t at;              /* vertices or quads already in the buffer */
    uint32_t draws;
} batch;

static size_t bytes_of(const noh_gl_morph *m, uint32_t count)
{
    return (m->plan.points ? 12u : 48u) * (size_t)count;
}

/* Draw `count` points or quads from `at` on. Indices have 16 bits, so quads move the start of the attribute instead. */
static void draw(batch *b, uint32_t at, uint32_t count)
{
    const noh_gl_api *gl = b->m->gl;
    if (b->draws++ && b->m->flushes) gl->Flush();
    if (b->m->plan.points) {
        gl->DrawArraysInstanced(GL_POINTS, (GLint)at, (GLsizei)count, 1);
        return;
    }
    gl->BindBuffer(GL_ARRAY_BUFFER, b->m->stream.name);
    gl->VertexAttribIPointer(b->m->a_stream, 3, GL_UNSIGNED_INT, 0, (const void *)bytes_of(b->m, at));
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    gl->DrawElements(GL_TRIANGLES, (GLsizei)(6u * count), GL_UNSIGNED_SHORT, NULL);
}

static void send(batch *b)
{
    const noh_gl_api *gl = b->m->gl;
    if (!b->count) return;
    gl->BindBuffer(GL_ARRAY_BUFFER, b->m->stream.name);
    gl->BufferSubData(GL_ARRAY_BUFFER, (GLintptr)bytes_of(b->m, b->at), (GLsizeiptr)bytes_of(b->m, b->count),
                      b->vertices);
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    b->at += b->count;
    b->count = 0;
}

static uint32_t texel_of_tile(const noh_gl_morph *m, uint32_t tile)
{
    const uint32_t across_log2 = m->tiles_across_log2;
    return (tile & ((1u << across_log2) - 1u)) << 2 | (tile >> across_log2) << 18;
}

/* A row of `count` blocks as points; their tiles follow each other. */
static void put_points(batch *b, uint32_t texel, uint32_t tile, uint32_t count, uint32_t record)
{
    uint32_t(*to)[3];
    if (b->count + count > b->capacity) send(b);
    to = b->vertices + b->count;
    for (uint32_t i = 0; i < count; i++) {
        to[i][0] = texel + 4u * i;
        to[i][1] = texel_of_tile(b->m, tile + i);
        to[i][2] = record;
    }
    b->count += count;
}

/* Blocks x0..x1-1 of a row of a rectangle as a quad, cut to the rectangle. Their tiles lie side by side. */
static void put_quad(batch *b, const noh_rect *rect, const uint32_t block[3], uint32_t place, uint32_t tile,
                     uint32_t record)
{
    const uint32_t x0 = 4u * block[0], y0 = 4u * block[2], x1 = 4u * block[1], y1 = y0 + 4u;
    const uint32_t right = (uint32_t)rect->x + rect->w, below = (uint32_t)rect->y + rect->h;
    const uint32_t x[2] = { x0 > rect->x ? x0 : rect->x, x1 < right ? x1 : right };
    const uint32_t y[2] = { y0 > rect->y ? y0 : rect->y, y1 < below ? y1 : below };
    const uint32_t from = texel_of_tile(b->m, tile);
    uint32_t(*to)[3];
    if (b->count == b->capacity) send(b);
    to = b->vertices + 4u * (size_t)b->count++;
    for (uint32_t i = 0; i < 4u; i++) {
        to[i][0] = place + x[i & 1u] + (y[i >> 1] << 16);
        to[i][1] = from + (x[i & 1u] - x0) + ((y[i >> 1] - y0) << 16);
        to[i][2] = record;
    }
}

static void put_strip(batch *b, const noh_rect *rect, noh_gl_blocks blocks, uint32_t row, uint32_t place, uint32_t tile,
                      uint32_t record)
{
    const uint32_t across = 1u << b->m->tiles_across_log2;
    for (uint32_t x = blocks.x0; x < blocks.x1;) { /* a new quad starts at the end of a row of tiles */
        const uint32_t left = blocks.x1 - x, fit = across - (tile & (across - 1u)), count = left < fit ? left : fit;
        const uint32_t block[3] = { x, x + count, row };
        put_quad(b, rect, block, place, tile, record);
        x += count;
        tile += count;
    }
}

/* place: the first texel of the instance's tile in the atlas, x | y << 16; tile: the target's first. */
static void put_target(batch *b, const noh_mesh *mesh, const noh_target *target, uint32_t place, uint32_t tile,
                       uint32_t record)
{
    const noh_rect *rect = mesh->rects + target->first_rect;
    for (uint32_t r = 0; r < target->rect_count; r++, rect++) {
        const noh_gl_blocks blocks = noh_gl_blocks_of(rect);
        for (uint32_t y = blocks.y0; y < blocks.y1; y++, tile += blocks.x1 - blocks.x0) {
            if (b->m->plan.points) {
                put_points(b, place + 4u * blocks.x0 + (y << 18), tile, blocks.x1 - blocks.x0, record);
            } else {
                put_strip(b, rect, blocks, y, place, tile, record);
            }
        }
    }
}

/* The active targets of all changed instances, in index order: the order of a sum decides its last bit. The tiles may
 * belong to a finer LOD level: a target's rectangles at a coarser level are its first ones at a finer level. */
static void put_targets(batch *b)
{
    noh_gl_morph *m = b->m;
    uint32_t record = 0;
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        const noh_mesh mesh = noh_gl_morph_view(m, i);
        const noh_gl_morph_mesh *tables = noh_gl_morph_tables(m, i);
        const float *weights = m->weights + noh_gl_morph_first_weight(m, i);
        uint32_t x, y;
        if (!m->dirty[i]) continue;
        noh_gl_morph_tile(m, i, &x, &y);
        for (uint32_t t = 0; t < mesh.header->target_count; t++) {
            const noh_target *target = &mesh.targets[t];
            if (weights[t] == 0.0f || !target->rect_count) continue;
            put_target(b, &mesh, target, x | y << 16, tables->first_tile + m->target_tiles[tables->first_target + t],
                       record++);
        }
    }
}

/* Return the number of vertices. */
static uint32_t put_records(noh_gl_morph *m, noh_gl_morph_stats *stats)
{
    uint32_t records = 0;
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        const noh_mesh mesh = noh_gl_morph_view(m, i);
        const float *weights = m->weights + noh_gl_morph_first_weight(m, i);
        for (uint32_t t = 0; t < mesh.header->target_count && m->dirty[i]; t++) {
            const noh_target *target = &mesh.targets[t];
            if (weights[t] == 0.0f || !target->rect_count) continue;
            noh_gl_morph_put_record(m->records + 4u * (size_t)records++, target, weights[t],
                                    NOH_ENTRY_WIDTHS(target->position_bits, target->normal_bits));
            stats->rects += target->rect_count;
            stats->texels += target->texel_count;
            stats->pairs += target->pair_count;
        }
    }
    stats->targets += records;
    return records;
}

static void clear_bound(noh_gl_morph *m)
{
    static const float zero[4] = { 0.0f, 0.0f, 0.0f, 0.0f };
    GLint buffers = m->plan.path == NOH_MORPH_MRT ? (GLint)m->plan.layer_count
                                                  : 1; /* clearing a layered framebuffer clears all layers */
    for (GLint i = 0; i < buffers; i++) {
        m->gl->ClearBufferfv(GL_COLOR, i, zero);
    }
}

/* Clear the tiles of changed instances; the others keep their sums. */
static void clear_tiles(noh_gl_morph *m)
{
    if (m->dirty_count == m->plan.instance_count) {
        clear_bound(m);
        return;
    }
    m->gl->Enable(GL_SCISSOR_TEST);
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        const noh_mesh_header *h = m->dirty[i] ? noh_gl_morph_view(m, i).header : NULL;
        if (h && h->morph_height) {
            uint32_t x, y;
            noh_gl_morph_tile(m, i, &x, &y);
            m->gl->Scissor((GLint)x, (GLint)y, (GLsizei)(1u << h->morph_width_log2), (GLsizei)h->morph_height);
            clear_bound(m);
        }
    }
    m->gl->Disable(GL_SCISSOR_TEST);
}

static void draw_all(batch *b)
{
    b->m->gl->Enable(GL_BLEND);
    for (uint32_t at = 0; at < b->at; at += b->capacity) {
        draw(b, at, b->at - at < b->capacity ? b->at - at : b->capacity);
    }
    b->m->gl->Disable(GL_BLEND);
}

void noh_gl_morph_update_blend(noh_gl_morph *m, noh_gl_morph_stats *stats)
{
    static const char *const pass_names[3] = { "position", "normal", "tangent" };
    const int passes = m->plan.path == NOH_MORPH_PER_LAYER ? (int)m->plan.layer_count : 1;
    const int point_size = m->plan.points && !m->gl->is_es; /* OpenGL ES always takes the point size from the shader */
    const uint32_t records = put_records(m, stats);
    noh_gl_offscreen kept;
    batch b = { m, (uint32_t(*)[3])m->staging, 0, m->batch.entries, 0, 0 };
    if (records) noh_gl_table_upload(m->gl, &m->record_table, 0, records, m->records);
    put_targets(&b);
    send(&b);
    noh_gl_morph_begin(m, &kept);
    if (point_size) m->gl->Enable(NOH_GL_PROGRAM_POINT_SIZE);
    m->gl->BlendEquation(GL_FUNC_ADD);
    m->gl->BlendFunc(GL_ONE, GL_ONE);
    for (int pass = 0; pass < passes; pass++) {
        noh_gl_group_begin(m->gl, "pass", passes > 1 ? pass_names[pass] : "all layers");
        m->gl->BindFramebuffer(GL_FRAMEBUFFER, m->framebuffers[pass]);
        clear_tiles(m);
        if (records) {
            m->gl->Uniform1i(m->u_layer, pass);
            draw_all(&b);
        }
        noh_gl_group_end(m->gl);
    }
    stats->draws += b.draws;
    noh_gl_morph_end(m, &kept);
}
