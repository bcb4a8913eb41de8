/* gl_morph_gather.c: the path gather, which sums without blending.
 *
 * Each block of 4 x 4 accumulation texels has a list of the active targets that move any of its texels, in target
 * order. One fragment per vertex reads its block's list, adds delta * weight in registers, and writes the three layers
 * once. The CPU adds in the same order, so the bits are the same; a target that does not move a vertex has a delta of
 * 0, and adding a zero changes no sum that began at +0.
 *
 * The lists are rebuilt for each update, by a counting sort of the blocks of the active targets, so the cost depends
 * only on active targets, and each entry contains its weights. An update sends the lists: 16 bytes for each block of
 * each active target and 4 for each block, at most NOH_BATCH_ENTRIES entries at once unless one instance has more. */
#include <string.h>

#include "gl/morph/gl_morph_internal.h"
#include "gl/device/gl_state_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/pack.h"
#include "shaders.gen.h"

#define LAST 0x80000000u /* in an entry's fourth word: the list ends here */

/* ---- making ---- */

static noh_result create_program(noh_gl_morph *m, char *log, size_t log_bytes, noh_error *error)
{
    static const char *const samplers[] = { "u_deltas", "u_lists", "u_starts" };
    static const char *const defines[2][2][2] = {
        { { NULL, "#define OCCLUSION\n" }, { "#define LAYERS_UINT\n", "#define LAYERS_UINT\n#define OCCLUSION\n" } },
        { { "#define TWO_LAYERS\n", "#define TWO_LAYERS\n#define OCCLUSION\n" },
          { "#define LAYERS_UINT\n#define TWO_LAYERS\n",
            "#define LAYERS_UINT\n#define TWO_LAYERS\n#define OCCLUSION\n" } }
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
    noh_result result = create_program(m, log, log_bytes, error);
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

/* The data of one upload, in the staging memory. */
typedef struct lists {
    uint32_t (*entries)[4], (*tiles)[4], *starts, *cursors;
    uint32_t entry_count, start_count, tile_count;
} lists;

static lists lists_of(const noh_gl_morph *m)
{
    lists l;
    memset(&l, 0, sizeof l);
    l.entries = (uint32_t(*)[4])m->staging;
    l.tiles = l.entries + m->batch.entries;
    l.starts = (uint32_t *)(void *)(l.tiles + m->batch.instances);
    l.cursors = l.starts + m->batch.positions;
    return l;
}

static void draw_lists(noh_gl_morph *m, lists *l, noh_gl_morph_stats *stats)
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
    l->entry_count = l->start_count = l->tile_count = 0;
}

/* Count the active targets of each block in the cursors. */
static void count_targets(const noh_mesh *mesh, const float *weights, uint32_t *cursors)
{
    const uint32_t across_log2 = mesh->header->morph_width_log2 - 2u;
    memset(cursors, 0, sizeof *cursors * noh_gl_morph_positions(mesh->header));
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        const noh_target *target = &mesh->targets[t];
        for (uint32_t r = 0; r < target->rect_count && weights[t] != 0.0f; r++) {
            const noh_gl_blocks b = noh_gl_blocks_of(&mesh->rects[target->first_rect + r]);
            for (uint32_t y = b.y0; y < b.y1; y++) {
                for (uint32_t x = b.x0; x < b.x1; x++) cursors[(y << across_log2) + x]++;
            }
        }
    }
}

/* Append a target's entries to the lists of its blocks. */
static void put_target(lists *l, const noh_mesh *mesh, const noh_target *target, const uint32_t record[4],
                       const uint32_t *slots)
{
    const uint32_t across_log2 = mesh->header->morph_width_log2 - 2u;
    const noh_rect *rect = mesh->rects + target->first_rect;
    for (uint32_t r = 0; r < target->rect_count; r++, rect++) {
        const noh_gl_blocks b = noh_gl_blocks_of(rect);
        for (uint32_t y = b.y0; y < b.y1; y++) {
            for (uint32_t x = b.x0; x < b.x1; x++) {
                uint32_t *entry = l->entries[l->cursors[(y << across_log2) + x]++];
                memcpy(entry, record, 12);
                entry[3] = record[3] | *slots++;
            }
        }
    }
}

/* Write where each block's list begins to starts and cursors. A block without an active target has one entry that adds
 * nothing. Return the number of entries. */
static uint32_t begin_lists(lists *l, uint32_t positions)
{
    uint32_t *starts = l->starts + l->start_count, at = l->entry_count;
    for (uint32_t p = 0; p < positions; p++) {
        const uint32_t count = l->cursors[p];
        starts[p] = l->cursors[p] = at;
        if (!count) {
            memset(l->entries[at], 0, 12);
            l->entries[at][3] = NOH_ENTRY_WIDTHS(8u, 8u);
        }
        at += count ? count : 1u;
    }
    return at - l->entry_count;
}

static void end_lists(lists *l, uint32_t positions, uint32_t entries)
{
    const uint32_t *starts = l->starts + l->start_count;
    l->entry_count += entries;
    for (uint32_t p = 1; p < positions; p++) l->entries[starts[p] - 1u][3] |= LAST;
    l->entries[l->entry_count - 1u][3] |= LAST;
    l->start_count += positions;
}

static uint32_t entries_of(const uint32_t *cursors, uint32_t positions)
{
    uint32_t entries = 0;
    for (uint32_t p = 0; p < positions; p++) entries += cursors[p] ? cursors[p] : 1u;
    return entries;
}

/* The lists of an instance. Its tiles may belong to a finer LOD level: a target's rectangles at a coarser level are its
 * first ones at a finer level. */
static void list_instance(noh_gl_morph *m, uint32_t instance, lists *l, noh_gl_morph_stats *stats)
{
    const noh_mesh mesh = noh_gl_morph_view(m, instance);
    const noh_gl_morph_mesh *tables = noh_gl_morph_tables(m, instance);
    const float *weights = m->weights + noh_gl_morph_first_weight(m, instance);
    const uint32_t positions = noh_gl_morph_positions(mesh.header);
    uint32_t *tile, x, y, entries;
    count_targets(&mesh, weights, l->cursors);
    if (l->entry_count + entries_of(l->cursors, positions) > m->batch.entries ||
        l->start_count + positions > m->batch.positions || l->tile_count == m->batch.instances) {
        draw_lists(m, l, stats);
    }
    noh_gl_morph_tile(m, instance, &x, &y);
    tile = l->tiles[l->tile_count++];
    tile[0] = x | y << 16;
    tile[1] = l->start_count;
    tile[2] = positions >> (mesh.header->morph_width_log2 - 2u);
    tile[3] = mesh.header->morph_width_log2 - 2u;
    entries = begin_lists(l, positions);
    for (uint32_t t = 0; t < mesh.header->target_count; t++) {
        const noh_target *target = &mesh.targets[t];
        uint32_t record[4];
        if (weights[t] == 0.0f || !target->rect_count) continue;
        noh_gl_morph_put_record(record, target, weights[t],
                                NOH_ENTRY_WIDTHS(target->position_bits, target->normal_bits));
        put_target(l, &mesh, target, record, m->slots + tables->first_tile + m->target_tiles[tables->first_target + t]);
        stats->targets += 1;
        stats->rects += target->rect_count;
        stats->texels += target->texel_count;
        stats->pairs += target->pair_count;
    }
    end_lists(l, positions, entries);
}

void noh_gl_morph_update_gather(noh_gl_morph *m, noh_gl_morph_stats *stats)
{
    lists l = lists_of(m);
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        if (m->dirty[i] && noh_gl_morph_view(m, i).header->touched_count) list_instance(m, i, &l, stats);
    }
    draw_lists(m, &l, stats);
}
