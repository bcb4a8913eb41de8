/* wire_like.c: for each target the one before it from which it differs least: "smile" and its left half, two visemes.
 *
 * Targets that move more vertices come first, so that halves follow what they are halves of. The measure is the sum of
 * the bits that the differences' second differences take, about as the coder will see them. */
#include "wire_like.h"

#include <stdlib.h>
#include <string.h>

typedef struct likeness {
    const noh_wire_filter *f;
    const noh_target *targets;
    uint32_t texel_count;
    float *deltas; /* [target_count][touched_count][3] in units of the coarsest scale */
} likeness;

static int32_t top_bits(uint32_t word, uint32_t bits)
{
    return bits ? (int32_t)word >> (32u - bits) : 0;
}

/* The deltas of a target at every accumulation texel, model units. */
static void unpack(const likeness *l, uint32_t target, float *out)
{
    const noh_mesh_header *h = &l->f->mesh.header;
    const uint8_t *chunk = l->f->image + l->f->mesh.chunk;
    const noh_target *t = &l->targets[target];
    const noh_rect *rects = (const noh_rect *)(const void *)(chunk + h->rects_offset) + t->first_rect;
    const uint32_t *texel = (const uint32_t *)(const void *)(chunk + h->texels_offset) + 3u * (size_t)t->first_texel;
    for (uint32_t i = 0; i < t->rect_count; i++) {
        for (uint32_t n = 0; n < (uint32_t)rects[i].w * rects[i].h; n++, texel += 3) {
            const uint32_t at = ((rects[i].y + n / rects[i].w) << h->morph_width_log2) + rects[i].x + n % rects[i].w;
            for (uint32_t k = 0; at < h->touched_count && k < 3u; k++) {
                out[3u * (size_t)at + k] = (float)top_bits(texel[k], t->position_bits) * t->position_scale;
            }
        }
    }
}

static float bits_of(float x)
{
    float bits = 0.3f;
    x = x < 0.0f ? -x : x;
    for (; x > 0.5f && bits < 20.0f; x *= 0.5f) bits += 1.0f;
    return bits;
}

/* Bits of `target` as a difference from `like` (NOH_NONE: as it is); given up above `most`. */
static float cost(const likeness *l, uint32_t target, uint32_t like, float most)
{
    const noh_wire_mesh *m = &l->f->mesh;
    const float unit = l->targets[target].position_scale > 0.0f ? 1.0f / l->targets[target].position_scale : 0.0f;
    const size_t size = 3u * (size_t)m->header.touched_count;
    const float *d = l->deltas + target * size, *r = like == NOH_NONE ? NULL : l->deltas + like * size;
    float sum = 0.0f;
    for (uint32_t i = 0; i < m->order_count && sum < most; i++) {
        const uint32_t v = m->order[i], *around = m->around + 3u * (size_t)v;
        const uint32_t at[4] = { noh_wire_texel(l->f, v),
                                 around[0] == NOH_NONE ? NOH_NONE : noh_wire_texel(l->f, around[0]),
                                 around[1] == NOH_NONE ? NOH_NONE : noh_wire_texel(l->f, around[1]),
                                 around[2] == NOH_NONE ? NOH_NONE : noh_wire_texel(l->f, around[2]) };
        if (at[0] == NOH_NONE) continue;
        for (uint32_t k = 0; k < 3u; k++) {
            float e[4];
            if (d[3u * (size_t)at[0] + k] == 0.0f) continue;
            for (uint32_t j = 0; j < 4u; j++) {
                const size_t x = 3u * (size_t)at[j] + k;
                e[j] = at[j] == NOH_NONE ? 0.0f : d[x] - (r ? r[x] : 0.0f);
            }
            if (around[2] == NOH_NONE) e[3] = e[2] = 0.0f;
            sum += bits_of((e[0] - e[1] - e[2] + e[3]) * unit);
        }
    }
    return sum;
}

/* Which kinds of a target's deltas are not 0 everywhere. */
static uint32_t kinds_of(const likeness *l, uint32_t target)
{
    const noh_mesh_header *h = &l->f->mesh.header;
    const noh_target *t = &l->targets[target];
    const uint32_t *words = (const uint32_t *)(const void *)(l->f->image + l->f->mesh.chunk + h->texels_offset) +
                            3u * (size_t)t->first_texel;
    const uint32_t below = 32u - t->position_bits, last = below - t->normal_bits;
    uint32_t any = 0;
    for (uint32_t i = 0; i < 3u * t->texel_count; i++) any |= words[i];
    return (any >> below ? 1u : 0u) | ((any & ((1u << below) - 1u)) >> last ? 2u : 0u) |
           (any & ((1u << last) - 1u) ? 4u : 0u);
}

static void plan_targets(likeness *l, uint32_t *order, uint32_t *plan)
{
    const uint32_t count = l->f->mesh.header.target_count;
    for (uint32_t i = 0; i < count; i++) order[i] = i;
    for (uint32_t i = 1; i < count; i++) { /* more pairs first, and equal ones as they are */
        const uint32_t now = order[i];
        uint32_t k = i;
        for (; k && l->targets[order[k - 1u]].pair_count < l->targets[now].pair_count; k--) order[k] = order[k - 1u];
        order[k] = now;
    }
    for (uint32_t i = 0; i < count; i++) {
        float least = cost(l, order[i], NOH_NONE, 1e30f);
        uint32_t like = NOH_NONE;
        for (uint32_t k = 0; k < i; k++) {
            const float bits = cost(l, order[i], order[k], 0.95f * least);
            if (bits < 0.95f * least) {
                least = bits;
                like = order[k];
            }
        }
        plan[i] = NOH_WIRE_PLAN(order[i], like == NOH_NONE ? 0u : like + 1u, kinds_of(l, order[i]));
    }
}

int wire_plan_targets(const noh_wire_filter *f, uint32_t *plan)
{
    const noh_mesh_header *h = &f->mesh.header;
    likeness l;
    uint32_t *order = malloc(((size_t)h->target_count + 1u) * sizeof *order);
    memset(&l, 0, sizeof l);
    l.f = f;
    l.targets = (const noh_target *)(const void *)(f->image + f->mesh.chunk + h->targets_offset);
    l.deltas = calloc((size_t)h->target_count * h->touched_count * 3u + 1u, sizeof *l.deltas);
    if (l.deltas && order) {
        for (uint32_t i = 0; i < h->target_count; i++) unpack(&l, i, l.deltas + 3u * (size_t)i * h->touched_count);
        plan_targets(&l, order, plan);
    }
    free(order);
    free(l.deltas);
    return !l.deltas || !order;
}

/* ---- positions ---- */

static uint32_t hash_position(const uint32_t p[3])
{
    uint32_t h = p[0] * 0x9e3779b1u ^ p[1] * 0x85ebca6bu ^ p[2] * 0xc2b2ae35u;
    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    return h ^ h >> 13;
}

int wire_plan_positions(const noh_wire_filter *f, uint32_t *plan)
{
    const uint32_t *order = f->mesh.order;
    uint32_t size = 16, *table;
    while (size < 2u * f->mesh.order_count) size *= 2u;
    table = calloc(size, sizeof *table);
    if (!table) return 1;
    for (uint32_t i = 0; i < f->mesh.order_count; i++) {
        uint32_t place[3], other[3], at;
        noh_wire_position(f, order[i], (float *)(void *)place);
        at = hash_position(place) & (size - 1u);
        for (; table[at]; at = (at + 1u) & (size - 1u)) {
            noh_wire_position(f, order[table[at] - 1u], (float *)(void *)other);
            if (memcmp(place, other, sizeof place) == 0) break;
        }
        plan[i] = table[at];
        if (!table[at]) table[at] = i + 1u;
    }
    free(table);
    return 0;
}
