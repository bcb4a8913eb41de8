/* pack_round.c: copies chunk by chunk; meshes array by array, rounded.
 *
 * Positions go to the nearest point of a grid, so that no vertex moves farther than the bound, and vertices at one
 * place stay together. Normals and texture coordinates become fractions of fewer steps, differences of normals
 * multiples of a coarser step, the weights of joints after the first are rounded down, and the rest goes to the first
 * one. The pack's stated errors grow by the rounding. */
#include "pack_round.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"
#include "pack_copy.h"

typedef struct rounder {
    const noh_pack *pack;
    const round_desc *desc;
    round_mesh *meshes; /* [meshes of the pack], what became of each */
    byte_buffer *out;
    size_t base; /* of the chunk in out */
    noh_mesh from;
    noh_mesh_header *h; /* [level_count], as they become */
    uint32_t level_count;
    int drop;
    round_mesh *report; /* of this mesh */
} rounder;

/* ---- tangents ---- */

/* A normal map turns normals in the frame that tangents give. */
static int wants_tangents(const noh_pack *pack, const noh_mesh *mesh)
{
    for (uint32_t k = 0; k < mesh->header->level_count - mesh->header->level_first; k++) {
        const noh_mesh level = noh_mesh_at_lod(mesh, mesh->header->level_first + k);
        for (uint32_t s = 0; s < level.header->submesh_count; s++) {
            const uint32_t m = level.submeshes[s].material;
            if (m != NOH_NONE &&
                (pack->materials[m].normal_texture != NOH_NONE || pack->materials[m].wrinkle_texture != NOH_NONE)) {
                return 1;
            }
        }
    }
    return 0;
}

/* ---- arrays ---- */

static uint32_t append(rounder *r, const void *bytes, size_t count)
{
    const size_t at = (buffer_align(r->out, 16), r->out->count - r->base);
    buffer_append(r->out, bytes ? bytes : "", count);
    return (uint32_t)at;
}

/* Levels' parts of an array follow each other as they did. */
static void move_offsets(rounder *r, size_t field, uint32_t to)
{
    uint32_t first;
    memcpy(&first, (const uint8_t *)r->from.header + field, 4);
    for (uint32_t k = 0; k < r->level_count; k++) {
        uint32_t at;
        memcpy(&at, (uint8_t *)&r->h[k] + field, 4);
        at = at - first + to;
        memcpy((uint8_t *)&r->h[k] + field, &at, 4);
    }
}

static void copy_array(rounder *r, size_t field, const void *bytes, size_t count)
{
    move_offsets(r, field, append(r, bytes, count));
}

/* ---- positions ---- */

/* The steps from the origin, and the place that a reader makes of them; 0 if it would not find the same steps again. */
static int on_grid(const wire_grid *g, unsigned axis, float x, float *place)
{
    const float q = floorf((x - g->origin[axis]) / g->step + 0.5f);
    const float at = g->origin[axis] + g->step * q;
    const float again = (at - g->origin[axis]) / g->step + 0.5f;
    *place = at;
    return q >= 0.0f && q < 4194304.0f && again >= q && again < q + 1.0f;
}

static int grid_holds(const noh_mesh *mesh, const wire_grid *g)
{
    for (uint32_t i = 0; i < 3u * mesh->header->vertex_count; i++) {
        float place;
        if (!on_grid(g, i % 3u, mesh->positions[i], &place)) return 0;
    }
    return 1;
}

static void append_positions(rounder *r)
{
    const noh_mesh *m = &r->from;
    wire_grid *g = &r->report->grid;
    const uint32_t at = append(r, NULL, 0);
    double moved = 0.0;
    for (unsigned i = 0; i < 3; i++) {
        g->origin[i] = INFINITY;
        for (uint32_t v = 0; v < m->header->vertex_count; v++)
            g->origin[i] = fminf(g->origin[i], m->positions[3u * v + i]);
    }
    g->step = m->header->world_scale > 0.0f
                  ? (float)(2.0 * r->desc->bound_m / sqrt(3.0) / (double)m->header->world_scale)
                  : 0.0f;
    if (!(g->step > 0.0f) || !grid_holds(m, g)) g->step = 0.0f;
    for (uint32_t v = 0; v < m->header->vertex_count; v++) {
        float place[3];
        double square = 0.0;
        memcpy(place, m->positions + 3u * (size_t)v, sizeof place);
        for (unsigned i = 0; i < 3 && g->step > 0.0f; i++) {
            (void)on_grid(g, i, m->positions[3u * (size_t)v + i], &place[i]);
            square += pow((double)place[i] - (double)m->positions[3u * (size_t)v + i], 2.0);
        }
        moved = fmax(moved, square);
        buffer_append(r->out, place, sizeof place);
    }
    r->report->moved_m = sqrt(moved) * (double)m->header->world_scale;
    move_offsets(r, offsetof(noh_mesh_header, positions_offset), at);
}

/* ---- attributes ---- */

static int32_t to_steps(int32_t value, int32_t whole, int32_t steps)
{
    const int64_t scaled = (int64_t)value * steps * 2;
    return (int32_t)((scaled + (scaled < 0 ? -whole : whole)) / (2 * (int64_t)whole));
}

static uint32_t round_half(uint32_t word, uint32_t shift, int32_t whole, int32_t steps, int is_signed)
{
    const int32_t value = is_signed ? (int32_t)(int16_t)(uint16_t)(word >> shift) : (int32_t)(word >> shift & 0xffffu);
    return ((uint32_t)to_steps(to_steps(value, whole, steps), steps, whole) & 0xffffu) << shift;
}

static void unfold(uint32_t word, double n[3])
{
    const double x = (double)(int16_t)(uint16_t)word / 32767.0, y = (double)(int16_t)(uint16_t)(word >> 16) / 32767.0;
    const double z = 1.0 - fabs(x) - fabs(y), fold = z < 0.0 ? -z : 0.0;
    double length;
    n[0] = x + (x >= 0.0 ? -fold : fold);
    n[1] = y + (y >= 0.0 ? -fold : fold);
    n[2] = z;
    length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (unsigned i = 0; i < 3; i++) n[i] /= length;
}

static uint32_t round_normal(rounder *r, uint32_t word)
{
    const int32_t steps = (int32_t)ROUND_NORMAL_STEPS;
    const uint32_t rounded = round_half(word, 0, 32767, steps, 1) | round_half(word, 16, 32767, steps, 1);
    double a[3], b[3], chord = 0.0;
    unfold(word, a);
    unfold(rounded, b);
    for (unsigned i = 0; i < 3; i++) chord += (a[i] - b[i]) * (a[i] - b[i]);
    r->report->turned = fmax(r->report->turned, 2.0 * asin(0.5 * sqrt(chord)) * 57.29577951308232);
    return rounded;
}

static void append_attributes(rounder *r)
{
    const noh_mesh *m = &r->from;
    const uint32_t words = m->header->attribute_stride / 4u, at = append(r, NULL, 0);
    const int rounds = r->desc->bound_m > 0.0, tangent = noh_mesh_tangent_offset(m), uv = noh_mesh_uv_offset(m);
    const int32_t steps = (int32_t)ROUND_UV_STEPS;
    for (uint32_t v = 0; v < m->header->vertex_count; v++) {
        for (uint32_t i = 0; i < words; i++) {
            uint32_t word;
            memcpy(&word, m->attributes + (size_t)v * 4u * words + 4u * (size_t)i, 4);
            if (r->drop && 4 * (int)i == tangent) continue;
            if (rounds && i == 0) word = round_normal(r, word);
            if (rounds && 4 * (int)i == uv) {
                word = round_half(word, 0, 65535, steps, 0) | round_half(word, 16, 65535, steps, 0);
            }
            buffer_append(r->out, &word, 4);
        }
    }
    move_offsets(r, offsetof(noh_mesh_header, attributes_offset), at);
}

/* ---- deltas ---- */

static int32_t field(uint32_t word, uint32_t bits, uint32_t shift)
{
    return bits ? (int32_t)(word << (32u - bits - shift)) >> (32u - bits) : 0;
}

/* How a target's fields change: a factor from old to new integers, and the width of the new ones. */
typedef struct narrowing {
    double factor;
    uint32_t bits;
    float scale;
} narrowing;

static narrowing narrow(const noh_mesh *m, const noh_target *t, uint32_t bits, uint32_t shift, float scale, int rounds)
{
    narrowing n = { 1.0, bits, scale };
    int32_t most = 0;
    if (!rounds || !(scale > 0.0f) || scale >= ROUND_DELTA_STEP) return n;
    n.factor = (double)scale / (double)ROUND_DELTA_STEP;
    n.scale = ROUND_DELTA_STEP;
    for (uint32_t i = 0; i < 3u * t->texel_count; i++) {
        const int32_t v = abs((int)lrint(n.factor * field(m->texels[3u * (size_t)t->first_texel + i], bits, shift)));
        most = v > most ? v : most;
    }
    for (n.bits = 1; most > (1 << (n.bits - 1u)) - 1; n.bits++) {}
    return n;
}

static uint32_t put_field(int32_t value, uint32_t bits, uint32_t shift)
{
    return ((uint32_t)value & (0xffffffffu >> (32u - bits))) << shift;
}

static void append_texels_of(rounder *r, noh_target *t)
{
    const noh_mesh *m = &r->from;
    const int rounds = r->desc->bound_m > 0.0;
    const uint32_t p = t->position_bits, n = t->normal_bits, g = t->tangent_bits;
    const narrowing normal = narrow(m, t, n, 32u - p - n, t->normal_scale, rounds);
    narrowing tangent = narrow(m, t, g, 32u - p - n - g, t->tangent_scale, rounds);
    if (r->drop) {
        tangent.factor = 0.0;
        tangent.bits = 1;
        tangent.scale = 0.0f;
    }
    for (uint32_t i = 0; i < 3u * t->texel_count; i++) {
        const uint32_t word = m->texels[3u * (size_t)t->first_texel + i];
        const int32_t vn = field(word, n, 32u - p - n), vg = field(word, g, 32u - p - n - g);
        const int32_t wn = (int32_t)lrint(normal.factor * vn), wg = (int32_t)lrint(tangent.factor * vg);
        const uint32_t out = put_field(field(word, p, 32u - p), p, 32u - p) |
                             put_field(wn, normal.bits, 32u - p - normal.bits) |
                             put_field(wg, tangent.bits, 32u - p - normal.bits - tangent.bits);
        buffer_append(r->out, &out, 4);
    }
    if (normal.factor < 1.0) {
        t->normal_error += 0.5f * ROUND_DELTA_STEP;
        r->report->delta_off = fmax(r->report->delta_off, (double)t->normal_error);
    }
    if (r->drop)
        t->tangent_error = 0.0f;
    else if (tangent.factor < 1.0)
        t->tangent_error += 0.5f * ROUND_DELTA_STEP;
    t->normal_bits = (uint8_t)normal.bits;
    t->tangent_bits = (uint8_t)tangent.bits;
    t->normal_scale = normal.scale;
    t->tangent_scale = tangent.scale;
}

/* Pairs are delta texels that are not zero: some have become it. */
static uint32_t count_pairs(const uint8_t *texels, const noh_target *t)
{
    uint32_t pairs = 0;
    for (uint32_t i = 0; i < t->texel_count; i++) {
        uint32_t word[3];
        memcpy(word, texels + 12u * ((size_t)t->first_texel + i), sizeof word);
        pairs += (word[0] | word[1] | word[2]) != 0;
    }
    return pairs;
}

/* Targets of all levels come before the texels that they describe: their room is filled afterwards. */
static void append_deltas(rounder *r)
{
    const noh_mesh *m = &r->from;
    const uint32_t count = m->header->target_count, targets = append(r, NULL, 0);
    uint32_t texels;
    buffer_append(r->out, NULL, (size_t)count * r->level_count * sizeof(noh_target));
    move_offsets(r, offsetof(noh_mesh_header, targets_offset), targets);
    copy_array(r, offsetof(noh_mesh_header, weights_offset), m->weights, 4u * (size_t)count);
    copy_array(r, offsetof(noh_mesh_header, rects_offset), m->rects, m->header->rect_count * sizeof *m->rects);
    texels = append(r, NULL, 0);
    move_offsets(r, offsetof(noh_mesh_header, texels_offset), texels);
    for (uint32_t k = 0; k < r->level_count; k++) r->h[k].pair_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        noh_target changed = m->targets[i];
        append_texels_of(r, &changed);
        for (uint32_t k = 0; k < r->level_count && !r->out->failed; k++) {
            const noh_mesh level = noh_mesh_at_lod(m, m->header->level_first + k);
            noh_target now = changed;
            now.rect_count = level.targets[i].rect_count;
            now.texel_count = level.targets[i].texel_count;
            now.pair_count = count_pairs(r->out->bytes + r->base + texels, &now);
            r->h[k].pair_count += now.pair_count;
            memcpy(r->out->bytes + r->base + targets + ((size_t)k * count + i) * sizeof now, &now, sizeof now);
        }
    }
}

/* ---- influences ---- */

static void round_weights(uint32_t *words, uint32_t count)
{
    const uint32_t first = count == 8u ? 64u : 32u;
    for (uint32_t i = 1; i < count; i++) {
        const uint32_t bit = first + (i == 1u ? 0u : 22u + 21u * (i - 2u)), size = i == 1u ? 22u : 21u;
        uint32_t any = 0;
        for (uint32_t b = 0; b < size; b++) {
            uint32_t *word = &words[(bit + b) / 32u];
            const uint32_t mask = 1u << (bit + b) % 32u;
            if (b < ROUND_WEIGHT_SHIFT) *word &= ~mask;
            any |= *word & mask;
        }
        if (!any) { /* a joint without a weight repeats the first */
            words[i / 4u] = (words[i / 4u] & ~(255u << 8u * (i % 4u))) | (words[0] & 255u) << 8u * (i % 4u);
        }
    }
}

static void append_skin(rounder *r)
{
    const noh_mesh *m = &r->from;
    const noh_mesh_header *h = m->header;
    const uint32_t words = NOH_INFLUENCE_WORDS(h->influence_count), at = append(r, NULL, 0);
    noh_skin skin;
    const uint32_t joints = noh_pack_skin_at(r->pack, h->skin, &skin, NULL) ? 0u : skin.header->joint_count;
    for (uint32_t v = 0; h->influence_count && v < h->vertex_count; v++) {
        uint32_t record[8];
        memcpy(record, m->influences + (size_t)v * words, 4u * words);
        if (r->desc->bound_m > 0.0) round_weights(record, h->influence_count);
        buffer_append(r->out, record, 4u * words);
    }
    move_offsets(r, offsetof(noh_mesh_header, influences_offset), at);
    copy_array(r, offsetof(noh_mesh_header, palettes_offset), m->palettes, h->palette_count * sizeof *m->palettes);
    copy_array(r, offsetof(noh_mesh_header, palette_joints_offset), m->palette_joints,
               2u * (size_t)h->palette_joint_count);
    copy_array(r, offsetof(noh_mesh_header, joint_boxes_offset), m->joint_boxes, 24u * (size_t)joints);
    if (!r->out->failed) { /* boxes hold the vertices where they now are */
        uint8_t *boxes = r->out->bytes + r->base + r->h->joint_boxes_offset;
        const float by = 0.5f * r->report->grid.step;
        for (uint32_t i = 0; i < 6u * joints; i++) {
            float x;
            const float *box = m->joint_boxes + i / 6u * 6u;
            memcpy(&x, boxes + 4u * (size_t)i, 4);
            x += box[0] > box[3] ? 0.0f : i % 6u < 3u ? -by : by;
            memcpy(boxes + 4u * (size_t)i, &x, 4);
        }
    }
}

/* ---- a mesh ---- */

static void change_headers(rounder *r)
{
    const float by = r->report->grid.step, off = by * 0.8660255f; /* half the diagonal of a cell */
    for (uint32_t k = 0; k < r->level_count; k++) {
        noh_mesh_header *h = &r->h[k];
        if (r->drop) {
            h->flags &= ~NOH_MESH_TANGENTS;
            h->attribute_stride -= 4u;
        }
        if (r->desc->bound_m > 0.0) h->f16_direction_bound += ROUND_DELTA_STEP * (float)h->target_count / 1024.0f;
        for (unsigned i = 0; i < 3; i++) {
            h->bounds_min[i] -= 0.5f * by;
            h->bounds_max[i] += 0.5f * by;
        }
        if (h->level) { /* both surfaces may have moved */
            h->level_error_rest += 2.0f * off;
            h->level_error_rest_p99 += 2.0f * off;
            h->level_error_targets += 2.0f * off;
            h->level_error_pairs += 2.0f * off;
            h->level_error_clip += 2.0f * off;
        }
    }
}

static void append_mesh(rounder *r)
{
    const noh_mesh_header *of = r->from.header;
    noh_mesh_header headers[NOH_LOD_LEVELS_MAX];
    const noh_mesh coarsest = noh_mesh_at_lod(&r->from, of->level_count - 1u);
    r->level_count = of->level_count - of->level_first;
    r->h = headers;
    for (uint32_t k = 0; k < r->level_count; k++) headers[k] = *noh_mesh_at_lod(&r->from, of->level_first + k).header;
    buffer_append(r->out, NULL, r->level_count * sizeof *headers);
    if (r->desc->bound_m > 0.0)
        append_positions(r);
    else
        copy_array(r, offsetof(noh_mesh_header, positions_offset), r->from.positions, 12u * (size_t)of->vertex_count);
    append_attributes(r);
    copy_array(r, offsetof(noh_mesh_header, indices_offset), r->from.indices,
               (size_t)coarsest.header->indices_offset - of->indices_offset +
                   (size_t)coarsest.header->index_count * of->index_bytes);
    copy_array(r, offsetof(noh_mesh_header, submeshes_offset), r->from.submeshes,
               (size_t)coarsest.header->submeshes_offset - of->submeshes_offset +
                   coarsest.header->submesh_count * sizeof(noh_submesh));
    append_deltas(r);
    copy_array(r, offsetof(noh_mesh_header, target_boxes_offset), r->from.target_boxes, 24u * (size_t)of->target_count);
    append_skin(r);
    change_headers(r);
    if (!r->out->failed) memcpy(r->out->bytes + r->base, headers, r->level_count * sizeof *headers);
    r->h = NULL;
}

/* ---- the pack ---- */

static void append_chunk(void *context, uint32_t index, byte_buffer *out)
{
    rounder *r = context;
    const uint32_t mesh = index - r->pack->runs[NOH_CHUNK_MESH].first;
    int change = 0;
    r->out = out;
    r->base = out->count;
    if (index >= r->pack->runs[NOH_CHUNK_MESH].first && mesh < r->pack->runs[NOH_CHUNK_MESH].count) {
        (void)noh_pack_mesh_at(r->pack, mesh, &r->from, NULL);
        r->report = &r->meshes[mesh];
        memset(r->report, 0, sizeof *r->report);
        r->report->had_tangents = (r->from.header->flags & NOH_MESH_TANGENTS) != 0;
        r->drop = r->report->had_tangents && !r->desc->keep_tangents && !wants_tangents(r->pack, &r->from);
        r->report->dropped_tangents = r->drop;
        change = r->drop || r->desc->bound_m > 0.0;
    }
    if (change)
        append_mesh(r);
    else
        pack_copy_as_is(r->pack, index, out);
}

int pack_round(const noh_pack *pack, const round_desc *desc, byte_buffer *out, round_mesh *meshes, model_error *error)
{
    rounder r;
    memset(&r, 0, sizeof r);
    r.pack = pack;
    r.desc = desc;
    r.meshes = meshes;
    return pack_copy(pack, append_chunk, &r, out, error);
}
