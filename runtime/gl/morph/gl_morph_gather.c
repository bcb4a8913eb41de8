/* gl_morph_gather.c: the path gather, which sums without blending.
 *
 * One fragment per vertex walks its block's list of active targets (gl_morph_lists.c) and writes the three layers once.
 * An update sends the lists of the changed instances, at most NOH_BATCH_ENTRIES entries at once unless one instance has
 * more. */
#include <string.h>

#include "gl/morph/gl_morph_internal.h"
#include "gl/device/gl_state_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/pack.h"
#include "shaders.gen.h"

/* ---- making ---- */

noh_result noh_gl_morph_compile_gather(noh_gl_morph *m, char *log, size_t log_bytes, noh_error *error)
{
    static const char *const samplers[] = { "noh_deltas", "noh_lists", "noh_starts" };
    static const char *const defines[2][2][2] = {
        { { NULL, "#define NOH_OCCLUSION\n" },
          { "#define LAYERS_UINT\n", "#define LAYERS_UINT\n#define NOH_OCCLUSION\n" } },
        { { "#define NOH_TWO_LAYERS\n", "#define NOH_TWO_LAYERS\n#define NOH_OCCLUSION\n" },
          { "#define LAYERS_UINT\n#define NOH_TWO_LAYERS\n",
            "#define LAYERS_UINT\n#define NOH_TWO_LAYERS\n#define NOH_OCCLUSION\n" } }
    };
    noh_gl_program_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.name = "gather";
    desc.vertex = &noh_shader_morph_gather_vert;
    desc.fragment = &noh_shader_morph_gather_frag;
    desc.samplers = samplers;
    desc.sampler_count = 3;
    desc.defines = defines[m->plan.layer_count == 2u][m->plan.layer_format == GL_RGBA32UI][m->plan.occlusion];
    desc.ledger = m->ledger;
    return noh_gl_program_create(m->gl, &desc, &m->program, log, log_bytes, error);
}

noh_result noh_gl_morph_init_gather(noh_gl_morph *m, char *log, size_t log_bytes, noh_error *error)
{
    noh_result result = m->program ? NOH_OK : noh_gl_morph_compile_gather(m, log, log_bytes, error);
    if (!result) result = noh_gl_morph_framebuffer(m, NOH_LAYERS_ALL, &m->framebuffers[0], error);
    if (!result) {
        result = noh_gl_table_create(m->gl, m->ledger, GL_RGBA32UI, m->batch.entries, &m->record_table, error);
    }
    if (!result) result = noh_gl_table_create(m->gl, m->ledger, GL_R32UI, m->batch.positions, &m->starts, error);
    if (!result) result = noh_gl_morph_stream(m, "a_tile", 4, 16u * (uint64_t)m->batch.instances, 1, error);
    if (!result) noh_gl_morph_constants(m);
    return result;
}

/* ---- updating ---- */

static void draw_lists(noh_gl_morph *m, noh_gl_lists *l, noh_gl_morph_stats *stats)
{
    noh_gl_offscreen kept;
    if (!l->tile_count) return;
    noh_gl_table_upload(m->gl, &m->record_table, 0, l->entry_count, l->entries);
    noh_gl_table_upload(m->gl, &m->starts, 0, l->start_count, l->starts);
    m->gl->BindBuffer(GL_ARRAY_BUFFER, m->stream.name);
    m->gl->BufferSubData(GL_ARRAY_BUFFER, 0, (GLsizeiptr)(16u * (size_t)l->tile_count), l->tiles);
    m->gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    noh_gl_morph_begin(m, &kept);
    m->gl->BindFramebuffer(GL_FRAMEBUFFER, m->framebuffers[0]);
    m->gl->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, (GLsizei)l->tile_count);
    noh_gl_morph_end(m, &kept);
    stats->draws += 1;
    l->entry_count = 1u; /* the empty list stays */
    l->start_count = l->tile_count = 0;
}

static void list_instance(noh_gl_morph *m, uint32_t instance, noh_gl_lists *l, noh_gl_morph_stats *stats)
{
    const noh_mesh mesh = noh_gl_morph_view(m, instance);
    const uint32_t positions = noh_gl_morph_positions(mesh.header);
    const uint32_t entries = noh_gl_morph_count_lists(&mesh, m->weights + noh_gl_morph_first_weight(m, instance), l);
    uint32_t *tile, x, y;
    if (l->entry_count + entries > m->batch.entries || l->start_count + positions > m->batch.positions ||
        l->tile_count == m->batch.instances) {
        draw_lists(m, l, stats);
    }
    noh_gl_morph_tile(m, instance, &x, &y);
    tile = l->tiles[l->tile_count++];
    tile[0] = x | y << 16;
    tile[1] = l->start_count;
    tile[2] = positions >> (mesh.header->morph_width_log2 - 2u);
    tile[3] = mesh.header->morph_width_log2 - 2u;
    noh_gl_morph_put_lists(m, instance, l, stats);
}

void noh_gl_morph_update_gather(noh_gl_morph *m, noh_gl_morph_stats *stats)
{
    noh_gl_lists l = noh_gl_morph_lists_of(m);
    noh_gl_morph_put_empty(l.entries[0]);
    l.entry_count = 1u;
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        if (m->dirty[i] && noh_gl_morph_view(m, i).header->touched_count) list_instance(m, i, &l, stats);
    }
    draw_lists(m, &l, stats);
}
