/* gl_morph_lists.c: the lists of active targets that the paths gather and direct read (shaders_es/common_walk.glsl).
 *
 * Each block of 4 x 4 accumulation texels has a list of the active targets that move any of its texels, in target
 * order. A shader reads the list of a vertex's block and adds delta * weight in registers. The CPU adds in the same
 * order, so the bits are the same; a target that does not move a vertex has a delta of 0, and adding a zero changes no
 * sum that began at +0. Blocks without an active target share the first list of the table, which adds nothing.
 *
 * The lists are rebuilt for each update, by a counting sort of the blocks of the active targets, so the cost depends
 * only on active targets, and each entry contains its weights: 16 bytes for each block of each active target and 4 for
 * each block. */
#include <string.h>

#include "gl/morph/gl_morph_internal.h"
#include "noh/format.h"
#include "noh/low_gl.h"
#include "noh/pack.h"

#define LAST 0x80000000u /* in an entry's fourth word: the list ends here */

noh_gl_lists noh_gl_morph_lists_of(const noh_gl_morph *m)
{
    noh_gl_lists l;
    memset(&l, 0, sizeof l);
    l.entries = (uint32_t(*)[4])m->staging;
    l.tiles = l.entries + m->batch.entries;
    l.starts = (uint32_t *)(void *)(l.tiles + m->batch.instances);
    l.cursors = l.starts + m->batch.positions;
    return l;
}

void noh_gl_morph_put_empty(uint32_t entry[4])
{
    memset(entry, 0, 12);
    entry[3] = NOH_ENTRY_WIDTHS(8u, 8u) | LAST;
}

uint32_t noh_gl_morph_count_lists(const noh_mesh *mesh, const float *weights, noh_gl_lists *l)
{
    const uint32_t across_log2 = mesh->header->morph_width_log2 - 2u;
    uint32_t entries = 0;
    memset(l->cursors, 0, sizeof *l->cursors * noh_gl_morph_positions(mesh->header));
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        const noh_target *target = &mesh->targets[t];
        for (uint32_t r = 0; r < target->rect_count && weights[t] != 0.0f; r++) {
            const noh_gl_blocks b = noh_gl_blocks_of(&mesh->rects[target->first_rect + r]);
            entries += (b.x1 - b.x0) * (b.y1 - b.y0);
            for (uint32_t y = b.y0; y < b.y1; y++) {
                for (uint32_t x = b.x0; x < b.x1; x++) l->cursors[(y << across_log2) + x]++;
            }
        }
    }
    return entries;
}

/* Append a target's entries to the lists of its blocks. */
static void put_target(noh_gl_lists *l, const noh_mesh *mesh, const noh_target *target, const uint32_t record[4],
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

/* Write where each block's list begins to starts and cursors. */
static void begin_lists(noh_gl_lists *l, uint32_t positions)
{
    uint32_t *starts = l->starts + l->start_count;
    for (uint32_t p = 0; p < positions; p++) {
        const uint32_t count = l->cursors[p];
        starts[p] = count ? l->first_entry + l->entry_count : 0;
        l->cursors[p] = l->entry_count;
        l->entry_count += count;
    }
}

static void end_lists(noh_gl_lists *l, uint32_t positions)
{
    const uint32_t *starts = l->starts + l->start_count;
    for (uint32_t p = 0; p < positions; p++) {
        if (starts[p]) l->entries[l->cursors[p] - 1u][3] |= LAST;
    }
    l->start_count += positions;
}

void noh_gl_morph_put_lists(noh_gl_morph *m, uint32_t instance, noh_gl_lists *l, noh_gl_morph_stats *stats)
{
    const noh_mesh mesh = noh_gl_morph_view(m, instance);
    const noh_gl_morph_mesh *tables = noh_gl_morph_tables(m, instance);
    const float *weights = m->weights + noh_gl_morph_first_weight(m, instance);
    const uint32_t positions = noh_gl_morph_positions(mesh.header);
    begin_lists(l, positions);
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
    end_lists(l, positions);
}
