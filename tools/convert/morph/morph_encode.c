/* morph_encode.c: drives the encoder: chooses the pairs that stay, the order of the vertices, the rectangles that cover
 * each target, and fills their texels. */
#include "morph_internal.h"

#include "noh/base.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH_LOG2_MAX 10u
#define RECT_LIMIT 65535u /* morph_rect is 16-bit */
#define DELTA_LIMIT NOH_NUMBER_MAX

typedef struct encoder {
    const model_mesh *mesh;
    morph_uv uv; /* of it, where targets move texture coordinates: `mesh` is then the one in here */
    morph_options options;
    morph_encoding *e;
    morph_bits vertices;     /* all vertices x targets: kept pairs */
    morph_bits touched;      /* rows of touched vertices, source order */
    uint32_t *touched_index; /* [touched] vertex in the source's order */
    model_error *error;
} encoder;

static int fail(encoder *c, const char *what, const char *where)
{
    snprintf(c->error->what, sizeof c->error->what, "%s", what);
    snprintf(c->error->where, sizeof c->error->where, "%s", where);
    return 1;
}

static int no_memory(encoder *c)
{
    return fail(c, "out of memory", "encoding morph targets");
}

/* ---- what comes in ---- */

static int check_deltas(encoder *c, const float *delta, uint32_t width, uint32_t t, const char *part)
{
    char where[128];
    if (!delta) return 0;
    for (size_t i = 0; i < (size_t)c->mesh->vertex_count * width; i++) {
        if (fabsf(delta[i]) <= DELTA_LIMIT) continue; /* false for a NaN */
        snprintf(where, sizeof where, "target %u, %s delta of vertex %u", (unsigned)t, part, (unsigned)(i / width));
        return fail(c, "morph delta is not finite or larger than 10^12", where);
    }
    return 0;
}

static int check_input(encoder *c)
{
    const uint64_t most = (uint64_t)RECT_LIMIT << WIDTH_LOG2_MAX;
    if (c->mesh->vertex_count > most)
        return fail(c, "too many vertices for the morph texture (limit 67107840)", "mesh");
    if (!(c->options.error_um > 0.0f) || !(c->options.error_um <= DELTA_LIMIT))
        return fail(c, "the position error must be above zero", "options");
    if (!(c->options.rect_cost_texels > 0.0f) || !(c->options.rect_cost_texels <= DELTA_LIMIT))
        return fail(c, "the cost of a rectangle must be above zero", "options");
    for (uint32_t t = 0; t < c->mesh->target_count; t++) {
        const model_target *s = &c->mesh->targets[t];
        if (check_deltas(c, s->position, MORPH_AXES, t, "position") ||
            check_deltas(c, s->normal, MORPH_AXES, t, "normal") ||
            check_deltas(c, s->tangent, MORPH_AXES, t, "tangent") || check_deltas(c, s->uv, 2, t, "UV"))
            return 1;
    }
    return 0;
}

/* ---- which pairs stay ---- */

static int find_pairs(encoder *c)
{
    morph_encoding *e = c->e;
    const uint32_t targets = c->mesh->target_count;
    uint32_t words[3];
    c->vertices.rows = c->mesh->vertex_count;
    c->vertices.words = (targets + 63u) / 64u;
    c->vertices.bits = morph_alloc((size_t)c->vertices.rows * c->vertices.words, sizeof *c->vertices.bits);
    if (!c->vertices.bits) return no_memory(c);
    for (uint32_t t = 0; t < targets; t++) {
        morph_target *q = &e->targets[t];
        morph_quantise_choose(c->mesh, t, c->options.error_um, q);
        for (uint32_t v = 0; v < c->mesh->vertex_count; v++)
            if (morph_quantise_pack(q, &c->mesh->targets[t], v, words)) morph_set_bit(&c->vertices, v, t);
        e->pair_count += q->pair_count;
        e->source_pairs += q->source_pairs;
    }
    return 0;
}

static int is_touched(const morph_bits *b, uint32_t row)
{
    for (uint32_t w = 0; w < b->words; w++)
        if (morph_row(b, row)[w]) return 1;
    return 0;
}

static uint32_t rank_of(const encoder *c, uint32_t vertex)
{
    return c->options.rank ? c->options.rank[vertex] : 0u;
}

static void take_touched(encoder *c, uint32_t vertex)
{
    c->touched_index[c->touched.rows] = vertex;
    memcpy(c->touched.bits + (size_t)c->touched.rows * c->touched.words, morph_row(&c->vertices, vertex),
           c->touched.words * sizeof(uint64_t));
    c->touched.rows++;
}

/* Touched vertices first, the coarsest level's before the others; else in the source's order. */
static int compact(encoder *c)
{
    morph_encoding *e = c->e;
    uint32_t rest;
    for (uint32_t v = 0; v < e->vertex_count; v++) e->touched_count += (uint32_t)is_touched(&c->vertices, v);
    c->touched.words = c->vertices.words;
    c->touched.bits = morph_alloc((size_t)e->touched_count * c->touched.words, sizeof *c->touched.bits);
    c->touched_index = morph_alloc(e->touched_count, sizeof *c->touched_index);
    if (!c->touched.bits || !c->touched_index) return no_memory(c);
    rest = e->touched_count;
    for (uint32_t v = 0; v < e->vertex_count; v++)
        if (!is_touched(&c->vertices, v)) e->order[rest++] = v;
    for (uint32_t level = e->level_count; level-- > 0u;) {
        for (uint32_t v = 0; v < e->vertex_count; v++)
            if (rank_of(c, v) == level && is_touched(&c->vertices, v)) take_touched(c, v);
        e->level_touched[level] = c->touched.rows;
    }
    return 0;
}

/* ---- where they lie ---- */

/* The texels that a level adds to the coarser level. */
static morph_region block_of(const morph_encoding *e, uint32_t level)
{
    morph_region r = { e->width_log2, 0, 0 };
    if (level + 1u < e->level_count) r.first = e->level_touched[level + 1u];
    r.count = e->level_touched[level] - r.first;
    return r;
}

/* The patterns' members, one pattern after another. */
static int make_line(const morph_bits *vertices, float rect_cost, uint32_t *line)
{
    morph_patterns patterns;
    uint32_t *path, place = 0;
    int failed;
    if (morph_patterns_init(&patterns, vertices)) return 1;
    path = morph_alloc(patterns.count, sizeof *path);
    failed = !path || morph_order_path(&patterns, rect_cost, path);
    for (uint32_t i = 0; !failed && i < patterns.count; i++)
        for (uint32_t m = patterns.first[path[i]]; m < patterns.first[path[i] + 1u]; m++)
            line[place++] = patterns.members[m];
    free(path);
    morph_patterns_free(&patterns);
    return failed;
}

static int order_block(encoder *c, const morph_region *region)
{
    const float rect_cost = c->options.rect_cost_texels;
    const morph_bits vertices = { region->count, c->touched.words,
                                  c->touched.bits + (size_t)region->first * c->touched.words };
    uint32_t *line = morph_alloc(region->count, sizeof *line), *order = c->e->order + region->first;
    const int failed = !line || make_line(&vertices, rect_cost, line) ||
                       morph_fold_settle(&vertices, region, rect_cost, line);
    if (!failed) {
        morph_fold_order(line, region, order);
        for (uint32_t i = 0; i < region->count; i++) order[i] = c->touched_index[region->first + order[i]];
    }
    free(line);
    return failed ? no_memory(c) : 0;
}

static int order_vertices(encoder *c)
{
    morph_encoding *e = c->e;
    int failed = 0;
    morph_fold_size(e->touched_count, &e->width_log2, &e->height);
    for (uint32_t level = 0; level < e->level_count && !failed; level++) {
        const morph_region region = block_of(e, level);
        failed = order_block(c, &region);
    }
    return failed;
}

/* ---- rectangles and texels ---- */

/* The indices, ascending, of what target t moves among the `count` from `first` on; order NULL: the source's order. */
static uint32_t list_texels(const encoder *c, uint32_t t, const uint32_t *order, uint32_t first, uint32_t count,
                            uint32_t *texels)
{
    uint32_t n = 0;
    for (uint32_t i = first; i < first + count; i++)
        if (morph_bit(&c->vertices, order ? order[i] : i, t)) texels[n++] = i;
    return n;
}

/* The rectangles of a target in one level's block: a rectangle never reaches from one level into another. */
static int cover_block(encoder *c, uint32_t t, uint32_t level, uint32_t *texels, morph_rect_list *rects, uint64_t *area)
{
    morph_encoding *e = c->e;
    morph_part *part = &e->parts[(size_t)level * e->target_count + t];
    const morph_region region = block_of(e, level);
    const uint32_t first = rects->count, count = list_texels(c, t, e->order, region.first, region.count, texels);
    const morph_cover_options options = { e->width_log2, c->options.rect_cost_texels, c->options.rects };
    if (morph_cover(texels, count, &options, rects)) return no_memory(c);
    for (uint32_t r = first; r < rects->count; r++) {
        *area += (uint64_t)rects->items[r].w * rects->items[r].h;
        part->texel_count += (uint32_t)rects->items[r].w * rects->items[r].h;
    }
    if (*area > UINT32_MAX / MORPH_AXES) return fail(c, "too many morph texels (limit 1431655765)", "mesh");
    part->rect_count = rects->count - first;
    part->pair_count = count;
    return 0;
}

/* From the coarsest level to the finest, so that each level's rectangles are a prefix of the finer level's. */
static int cover_target(encoder *c, uint32_t t, uint32_t *texels, morph_rect_list *rects, uint64_t *area)
{
    morph_encoding *e = c->e;
    morph_target *q = &e->targets[t];
    q->first_rect = rects->count;
    q->first_texel = (uint32_t)*area;
    for (uint32_t level = e->level_count; level-- > 0u;) {
        morph_part *part = &e->parts[(size_t)level * e->target_count + t];
        if (cover_block(c, t, level, texels, rects, area)) return 1;
        if (level + 1u < e->level_count) {
            part->rect_count += part[e->target_count].rect_count;
            part->texel_count += part[e->target_count].texel_count;
            part->pair_count += part[e->target_count].pair_count;
        }
    }
    q->rect_count = rects->count - q->first_rect;
    q->texel_count = (uint32_t)*area - q->first_texel;
    return 0;
}

static int cover_all(encoder *c, uint32_t *texels)
{
    morph_encoding *e = c->e;
    morph_rect_list rects = { NULL, 0, 0 };
    uint64_t area = 0;
    int failed = 0;
    for (uint32_t t = 0; !failed && t < e->target_count; t++) failed = cover_target(c, t, texels, &rects, &area);
    e->rects = rects.items;
    e->rect_count = rects.count;
    e->texel_count = (uint32_t)area;
    return failed;
}

/* The texels of a rectangle in a level's block. Vertices of other blocks inside it are left zero: rectangles of their
 * own levels hold them. */
static uint32_t *fill_rect(const encoder *c, uint32_t t, const morph_rect *rect, const morph_region *block,
                           uint32_t *out)
{
    const morph_encoding *e = c->e;
    for (uint32_t i = 0; i < (uint32_t)rect->w * rect->h; i++, out += MORPH_AXES) {
        const uint32_t x = rect->x + i % rect->w, y = rect->y + i / rect->w, texel = (y << e->width_log2) + x;
        if (texel >= block->first && texel - block->first < block->count)
            morph_quantise_pack(&e->targets[t], &c->mesh->targets[t], e->order[texel], out);
    }
    return out;
}

/* ---- targets that a level leaves out ---- */

/* The target of the next larger radius after `after`; after = target_count: the smallest. */
static uint32_t next_smallest(const morph_encoding *e, uint32_t after)
{
    uint32_t best = e->target_count;
    for (uint32_t t = 0; t < e->target_count; t++) {
        const float radius = e->targets[t].radius;
        if (after < e->target_count) {
            const float last = e->targets[after].radius;
            if (radius < last || (radius == last && t <= after)) continue;
        }
        if (best == e->target_count || radius < e->targets[best].radius) best = t;
    }
    return best;
}

static void leave_out(encoder *c, uint32_t level, float most)
{
    morph_encoding *e = c->e;
    float sum = 0.0f;
    for (uint32_t t = next_smallest(e, e->target_count); t < e->target_count; t = next_smallest(e, t)) {
        sum += e->targets[t].radius;
        if (!(sum <= most)) break;
        memset(&e->parts[(size_t)level * e->target_count + t], 0, sizeof *e->parts);
    }
}

static int fill_texels(encoder *c)
{
    morph_encoding *e = c->e;
    uint32_t *out, rect = 0;
    e->texels = morph_alloc((size_t)e->texel_count * MORPH_AXES, sizeof *e->texels);
    if (!e->texels) return no_memory(c);
    out = e->texels;
    for (uint32_t t = 0; t < e->target_count; t++)
        for (uint32_t level = e->level_count; level-- > 0u;) {
            const uint32_t end = e->targets[t].first_rect + e->parts[(size_t)level * e->target_count + t].rect_count;
            const morph_region block = block_of(e, level);
            while (rect < end) out = fill_rect(c, t, &e->rects[rect++], &block, out);
        }
    return 0;
}

/* For the report: texels with one bounding rectangle per target, vertices in the source's order, a square texture. */
static void count_one_rect(encoder *c, uint32_t *texels)
{
    morph_encoding *e = c->e;
    uint64_t sum = 0, width = 1;
    while (width * width < e->vertex_count) width++;
    for (uint32_t t = 0; t < e->target_count; t++) {
        const uint32_t count = list_texels(c, t, NULL, 0, e->vertex_count, texels);
        uint64_t low = width, high = 0;
        if (count == 0u) continue;
        for (uint32_t i = 0; i < count; i++) {
            const uint64_t x = texels[i] % width;
            if (x < low) low = x;
            if (x > high) high = x;
        }
        sum += (high - low + 1u) * (texels[count - 1u] / width - texels[0] / width + 1u);
    }
    e->texels_one_rect = sum > UINT32_MAX ? UINT32_MAX : (uint32_t)sum;
}

/* Where the order has put what replaces texture coordinates. */
static int find_uv_texels(encoder *c, uint32_t count)
{
    morph_encoding *e = c->e;
    const morph_uv *uv = &c->uv;
    uint32_t *place = morph_alloc(e->vertex_count, sizeof *place);
    e->uv_texel = morph_alloc(count, sizeof *e->uv_texel);
    e->uv_per_unit = uv->uv_per_unit;
    if (place && e->uv_texel) {
        for (uint32_t i = 0; i < e->vertex_count; i++) place[e->order[i]] = i;
        for (uint32_t v = 0; v < count; v++) {
            const uint32_t texel = uv->stand_in[v] == MODEL_NONE ? MODEL_NONE : place[uv->stand_in[v]];
            e->uv_texel[v] = texel < e->touched_count ? texel : MODEL_NONE;
        }
    }
    free(place);
    return place && e->uv_texel ? 0 : no_memory(c);
}

static int encode(encoder *c)
{
    uint32_t *texels;
    int failed;
    if (find_pairs(c) || compact(c) || order_vertices(c)) return 1;
    texels = morph_alloc(c->e->vertex_count, sizeof *texels);
    if (!texels) return no_memory(c);
    count_one_rect(c, texels);
    failed = cover_all(c, texels) || fill_texels(c);
    free(texels);
    for (uint32_t level = 1; !failed && c->options.skip_radius && level < c->e->level_count; level++)
        leave_out(c, level, c->options.skip_radius[level]);
    return failed;
}

static int start(encoder *c)
{
    morph_encoding *e = c->e = morph_alloc(1, sizeof *c->e);
    if (!e) return no_memory(c);
    e->vertex_count = c->mesh->vertex_count;
    e->target_count = c->mesh->target_count;
    e->order = morph_alloc(e->vertex_count, sizeof *e->order);
    e->targets = morph_alloc(e->target_count, sizeof *e->targets);
    e->level_count = c->options.level_count;
    e->level_touched = morph_alloc(e->level_count, sizeof *e->level_touched);
    e->parts = morph_alloc((size_t)e->level_count * e->target_count, sizeof *e->parts);
    return e->order && e->targets && e->level_touched && e->parts ? 0 : no_memory(c);
}

/* The mesh with what replaces its texture coordinates. */
static int encode_with_uvs(encoder *c)
{
    const uint32_t count = c->mesh->vertex_count;
    int failed = morph_uv_extend(c->mesh, &c->options, &c->uv) ? no_memory(c) : 0;
    c->mesh = &c->uv.mesh;
    if (c->options.rank) c->options.rank = c->uv.rank;
    failed = failed || start(c) || encode(c) || find_uv_texels(c, count);
    morph_uv_free(&c->uv);
    return failed;
}

int morph_encode(const model_mesh *mesh, const morph_options *options, morph_encoding **out, model_error *error)
{
    encoder c;
    int failed;
    memset(&c, 0, sizeof c);
    c.mesh = mesh;
    c.error = error;
    if (options) c.options = *options;
    if (c.options.error_um == 0.0f) c.options.error_um = MORPH_DEFAULT_ERROR_UM;
    if (c.options.rect_cost_texels == 0.0f) c.options.rect_cost_texels = MORPH_DEFAULT_RECT_COST;
    if (c.options.level_count == 0u || !c.options.rank) c.options.level_count = 1;
    failed = check_input(&c);
    if (!failed) failed = morph_uv_needed(mesh) ? encode_with_uvs(&c) : start(&c) || encode(&c);
    free(c.vertices.bits);
    free(c.touched.bits);
    free(c.touched_index);
    if (failed) {
        morph_encoding_free(c.e);
        c.e = NULL;
    }
    *out = c.e;
    return failed;
}

void morph_encoding_free(morph_encoding *e)
{
    if (!e) return;
    free(e->order);
    free(e->uv_texel);
    free(e->targets);
    free(e->level_touched);
    free(e->parts);
    free(e->rects);
    free(e->texels);
    free(e);
}
