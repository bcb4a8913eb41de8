/* gl_morph_tiles.c: the delta texels of the GPU's paths, in blocks of 4 x 4.
 *
 * Rasterisers shade in blocks of 2 x 2 to 4 x 4 pixels, and the converter cuts rectangles along blocks of 4 x 4. So
 * each block of the accumulator that a rectangle touches has a tile of 4 x 4 delta texels, zeros outside the rectangle,
 * aligned in its texture like the block in the accumulator: a fragment adds one offset to its own coordinate and
 * fetches. A pack stores rectangles without gaps, row by row; tiles are made from them at load, through a chunk of the
 * staging memory. On faces they take 1.02 to 1.14 times the texels of the pack.
 *
 * The blended paths need tiles in the order of targets, in which they draw. gather and direct read all targets of a
 * block in turn, so they need them by block, and within a block by target: `slots` has the position of each tile.
 * (gather in the order of targets, measured with 290 targets: 2.8 times slower on llvmpipe.) */
#include <string.h>

#include "gl/morph/gl_morph_internal.h"
#include "gl/device/gl_state_internal.h"
#include "gl/light/transfer_internal.h"
#include "core/base/assert_internal.h"
#include "gl/device/gl_api_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"
#include "noh/gl_device.h"
#include "noh/noh_gl.h"
#include "noh/low_gl.h"

/* ---- counting ---- */

noh_gl_blocks noh_gl_blocks_of(const noh_rect *rect)
{
    noh_gl_blocks b;
    b.x0 = rect->x / 4u;
    b.y0 = rect->y / 4u;
    b.x1 = ((uint32_t)rect->x + rect->w + 3u) / 4u;
    b.y1 = ((uint32_t)rect->y + rect->h + 3u) / 4u;
    return b;
}

static uint32_t count_of(noh_gl_blocks b)
{
    return (b.x1 - b.x0) * (b.y1 - b.y0);
}

uint32_t noh_gl_morph_blocks(const noh_mesh *mesh)
{
    uint64_t count = 0;
    NOH_ASSERT(mesh);
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        const noh_rect *rect = mesh->rects + mesh->targets[t].first_rect;
        for (uint32_t r = 0; r < mesh->targets[t].rect_count; r++) count += count_of(noh_gl_blocks_of(&rect[r]));
    }
    return count < UINT32_MAX ? (uint32_t)count : UINT32_MAX;
}

uint32_t noh_gl_morph_strips(const noh_mesh *mesh)
{
    uint32_t count = 0;
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        for (uint32_t r = 0; r < mesh->targets[t].rect_count; r++) {
            const noh_gl_blocks b = noh_gl_blocks_of(&mesh->rects[mesh->targets[t].first_rect + r]);
            count += b.y1 - b.y0;
        }
    }
    return count;
}

uint32_t noh_gl_morph_positions(const noh_mesh_header *h)
{
    return noh_gl_morph_pitch(h) / 4u << (h->morph_width_log2 - 2u);
}

/* ---- the texture ---- */

noh_gl_texture_desc noh_gl_morph_tiles_desc(const noh_gl_morph_plan *plan, uint32_t *across_log2)
{
    noh_gl_texture_desc desc = { 0, 0, 0, 0, 0, 0, 0 };
    uint32_t width_log2, height;
    noh_gl_table_shape(plan->block_count * 16u, &width_log2, &height);
    *across_log2 = width_log2 - 2u;
    desc.format = plan->wide ? GL_RGBA32UI : GL_RGB32UI;
    desc.width = 1u << width_log2;
    desc.height = ((plan->block_count >> *across_log2) + ((plan->block_count & ((1u << *across_log2) - 1u)) != 0)) * 4u;
    if (!desc.height) desc.height = 4;
    return desc;
}

/* ---- filling ---- */

/* The position of a tile in the texture, in tiles, x | y << 9, and back. */
static uint32_t place_of(const noh_gl_morph *m, uint32_t tile)
{
    return (tile & ((1u << m->tiles_across_log2) - 1u)) | tile >> m->tiles_across_log2 << 9;
}

static uint32_t tile_at(uint32_t place, uint32_t across_log2)
{
    return (place & 511u) | place >> 9 << across_log2;
}

/* Tiles first..first+count-1 of an owner, side by side as in a row of tiles of the texture. */
typedef struct tile_chunk {
    uint32_t *texels; /* [4][4 * count][words] */
    uint32_t words;   /* per texel: 3, or 4 with occlusion */
    uint32_t first, count;
    const uint32_t *slots; /* position of the n-th tile in the order of targets; NULL: position n */
    uint32_t first_tile, tile_count, across_log2;
    uint32_t row_first, row_end; /* rows of blocks that contain all these tiles, with slots */
} tile_chunk;

/* Widen the tangent's field of a delta word to all bits that the other two leave: the values stay, and shaders need not
 * know the field's width. */
static uint32_t widened(uint32_t word, const noh_target *target)
{
    const uint32_t before = (uint32_t)target->position_bits + target->normal_bits;
    const uint32_t field = word << before >> (32u - target->tangent_bits), sign = 1u << (target->tangent_bits - 1u);
    const uint32_t mask = UINT32_MAX >> before;
    return (word & ~mask) | (((field ^ sign) - sign) & mask);
}

static void put_texel(const noh_mesh *mesh, uint32_t target, uint32_t texel, uint32_t words, uint32_t *to)
{
    const uint32_t *from = mesh->texels + 3u * (size_t)texel;
    for (uint32_t i = 0; i < 3u; i++) to[i] = widened(from[i], &mesh->targets[target]);
    if (words == 4u) {
        const float change = (float)noh_transfer_delta(mesh, texel) * noh_transfer_ratio(mesh, target);
        memcpy(&to[3], &change, 4);
    }
}

/* One tile of a rectangle whose delta texels begin at `texel`. The chunk is zero before. */
static void put_tile(const tile_chunk *c, const noh_mesh *mesh, uint32_t target, const noh_rect *rect, uint32_t texel,
                     const uint32_t block[2], uint32_t slot)
{
    for (uint32_t y = 0; y < 4u; y++) {
        const uint32_t row = 4u * block[1] + y - rect->y; /* wraps to a large number above the rectangle */
        uint32_t *to = c->texels + c->words * (4u * c->count * (size_t)y + 4u * (size_t)slot);
        for (uint32_t x = 0; x < 4u && row < rect->h; x++) {
            const uint32_t column = 4u * block[0] + x - rect->x;
            if (column < rect->w) put_texel(mesh, target, texel + row * rect->w + column, c->words, to + c->words * x);
        }
    }
}

static void put_rect(const tile_chunk *c, const noh_mesh *mesh, uint32_t target, const noh_rect *rect, uint32_t texel,
                     uint32_t index)
{
    const noh_gl_blocks b = noh_gl_blocks_of(rect);
    uint32_t at[2];
    for (at[1] = b.y0; at[1] < b.y1; at[1]++) {
        for (at[0] = b.x0; at[0] < b.x1 && index < c->tile_count; at[0]++, index++) {
            const uint32_t tile = c->slots ? tile_at(c->slots[index], c->across_log2) : c->first_tile + index;
            const uint32_t slot = tile - c->first_tile - c->first;
            if (slot < c->count) put_tile(c, mesh, target, rect, texel, at, slot);
        }
    }
}

/* Write every tile of the chunk. Rectangles without tiles in it are skipped, so all chunks together take little more
 * than one pass over all tiles. */
static void put_chunk(const tile_chunk *c, const noh_mesh *mesh)
{
    uint32_t index = 0;
    memset(c->texels, 0, 4u * c->words * 16u * (size_t)c->count);
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        const noh_rect *rect = mesh->rects + mesh->targets[t].first_rect;
        uint32_t texel = mesh->targets[t].first_texel;
        for (uint32_t r = 0; r < mesh->targets[t].rect_count; r++, rect++) {
            const noh_gl_blocks b = noh_gl_blocks_of(rect);
            const int some = c->slots ? b.y0 < c->row_end && b.y1 > c->row_first
                                      : index < c->first + c->count && index + count_of(b) > c->first;
            if (some) put_rect(c, mesh, t, rect, texel, index);
            index += count_of(b);
            texel += (uint32_t)rect->w * rect->h;
        }
    }
}

/* Find each target's first tile, in the order of targets. */
static void find_targets(const noh_mesh *mesh, uint32_t *first)
{
    uint32_t index = 0;
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        const noh_rect *rect = mesh->rects + mesh->targets[t].first_rect;
        first[t] = index;
        for (uint32_t r = 0; r < mesh->targets[t].rect_count; r++) index += count_of(noh_gl_blocks_of(&rect[r]));
    }
}

/* A counting sort of the tiles by block. It is stable, so the tiles of a block stay in the order of targets. ends:
 * where the tiles of each block end, by position. */
static void find_slots(const noh_gl_morph *m, const noh_gl_morph_mesh *to, const noh_mesh *mesh, uint32_t *ends)
{
    const uint32_t across_log2 = mesh->header->morph_width_log2 - 2u, positions = noh_gl_morph_positions(mesh->header);
    uint32_t *slots = m->slots + to->first_tile, sum = 0, index = 0;
    memset(ends, 0, sizeof *ends * positions);
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t t = 0; t < mesh->header->target_count; t++) {
            for (uint32_t r = 0; r < mesh->targets[t].rect_count; r++) {
                const noh_gl_blocks b = noh_gl_blocks_of(&mesh->rects[mesh->targets[t].first_rect + r]);
                for (uint32_t y = b.y0; y < b.y1; y++) {
                    for (uint32_t x = b.x0; x < b.x1; x++) {
                        const uint32_t before = ends[(y << across_log2) + x]++;
                        if (pass && index < to->tile_count) slots[index++] = place_of(m, to->first_tile + before);
                    }
                }
            }
        }
        for (uint32_t p = 0; p < positions && !pass; p++) {
            const uint32_t count = ends[p];
            ends[p] = sum;
            sum += count;
        }
    }
}

/* Find the rows of blocks that contain the tiles of a chunk. */
static void find_rows(tile_chunk *c, const noh_mesh_header *h, const uint32_t *ends)
{
    const uint32_t across_log2 = h->morph_width_log2 - 2u, positions = noh_gl_morph_positions(h);
    uint32_t p = 0;
    while (p + 1u < positions && ends[p] <= c->first) p++;
    c->row_first = p >> across_log2;
    while (p + 1u < positions && ends[p] < c->first + c->count) p++;
    c->row_end = (p >> across_log2) + 1u;
}

static void upload_chunk(const noh_gl_morph *m, const tile_chunk *c, uint32_t tile)
{
    const uint32_t across_log2 = m->tiles_across_log2;
    noh_gl_pixels kept;
    m->gl->ActiveTexture(GL_TEXTURE0);
    m->gl->BindTexture(GL_TEXTURE_2D, m->tiles.name);
    noh_gl_unpack_begin(m->gl, &kept);
    m->gl->TexSubImage2D(GL_TEXTURE_2D, 0, (GLint)((tile & ((1u << across_log2) - 1u)) * 4u),
                         (GLint)((tile >> across_log2) * 4u), (GLsizei)(4u * c->count), 4,
                         c->words == 4u ? GL_RGBA_INTEGER : GL_RGB_INTEGER, GL_UNSIGNED_INT, c->texels);
    noh_gl_unpack_end(m->gl, &kept);
}

int noh_gl_morph_fill_tiles(noh_gl_morph *m, const noh_gl_morph_mesh *to, const noh_mesh *mesh, uint32_t *at,
                            uint32_t *bytes)
{
    const uint32_t across = 1u << m->tiles_across_log2;
    const int by_block = noh_gl_morph_has_lists(m->plan.path);
    uint32_t *ends = (uint32_t *)m->staging;
    tile_chunk c;
    memset(&c, 0, sizeof c);
    c.texels = by_block ? ends + noh_gl_morph_positions(mesh->header) : ends;
    c.words = m->plan.wide ? 4u : 3u;
    c.first_tile = to->first_tile;
    c.tile_count = to->tile_count;
    c.across_log2 = m->tiles_across_log2;
    find_targets(mesh, m->target_tiles + to->first_target);
    if (by_block && to->tile_count) {
        find_slots(m, to, mesh, ends);
        c.slots = m->slots + to->first_tile;
    }
    while (*at < to->tile_count && *bytes >= 64u * c.words) {
        const uint32_t row = across - ((to->first_tile + *at) & (across - 1u)), left = to->tile_count - *at;
        const uint32_t fit = *bytes / (64u * c.words);
        c.first = *at;
        c.count = row < left ? row : left;
        c.count = c.count < fit ? c.count : fit;
        c.count = c.count < NOH_TILE_CHUNK ? c.count : NOH_TILE_CHUNK;
        if (by_block) find_rows(&c, mesh->header, ends);
        put_chunk(&c, mesh);
        upload_chunk(m, &c, to->first_tile + c.first);
        *at += c.count;
        *bytes -= 64u * c.words * c.count;
    }
    return *at == to->tile_count;
}

noh_result noh_gl_morph_make_tiles(noh_gl_morph *m, noh_error *error)
{
    const noh_gl_texture_desc desc = noh_gl_morph_tiles_desc(&m->plan, &m->tiles_across_log2);
    noh_result result = m->tiles_taken ? NOH_OK : noh_gl_texture_create(m->gl, m->ledger, &desc, &m->tiles, error);
    for (uint32_t i = 0; !result && i < m->table_count; i++) {
        const noh_gl_morph_mesh *mesh = &m->meshes[i];
        uint32_t at = m->tiles_taken ? mesh->tile_count : 0, bytes = UINT32_MAX;
        while (noh_gl_morph_is_there(m, i) && !noh_gl_morph_fill_tiles(m, mesh, &mesh->mesh, &at, &bytes)) {
            bytes = UINT32_MAX;
        }
    }
    return result ? result
                  : noh_gl_error_check(m->gl, "the driver refused the delta texels", m->plan.delta_bytes, error);
}
