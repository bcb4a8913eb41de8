/* corrective.c: turns rows of a pack's recipe whose channel is '+' and a driver's name into terms and weights. The
 * row's weight is the peak; rows of one corrective are consecutive. */
#include "noh/base.h"
#include "noh/low_life.h"
#include "noh/pack.h"

#include "core/base/assert_internal.h"
#include "core/base/name_internal.h"

/* The rows of one corrective. */
typedef struct group {
    uint32_t first, end;
} group;

static const char *driver_of(const noh_pack *pack, uint32_t row)
{
    const char *channel = noh_pack_string(pack, pack->recipe_rows[row].channel);
    return channel[0] == '+' ? channel + 1 : NULL;
}

/* The next group from a row on; first = end if there is none. */
static group group_from(const noh_pack *pack, uint32_t row)
{
    group g;
    while (row < pack->recipe_row_count && !driver_of(pack, row)) row++;
    g.first = g.end = row;
    while (g.end < pack->recipe_row_count && driver_of(pack, g.end) &&
           pack->recipe_rows[g.end].target == pack->recipe_rows[g.first].target)
        g.end++;
    return g;
}

static uint32_t row_of(const noh_pack *pack, const group *g, uint32_t channel_hash)
{
    uint32_t row = g->first;
    while (row < g->end && pack->recipe_rows[row].channel_hash != channel_hash) row++;
    return row;
}

/* Whether two correctives have the same drivers. */
static int are_siblings(const noh_pack *pack, const group *a, const group *b)
{
    if (a->end - a->first != b->end - b->first) return 0;
    for (uint32_t row = a->first; row < a->end; row++) {
        if (row_of(pack, b, pack->recipe_rows[row].channel_hash) == b->end) return 0;
    }
    return 1;
}

/* Find the peaks of siblings on both sides of a row's peak. */
static void set_range(const noh_pack *pack, const group *g, uint32_t row, noh_corrective_term *term)
{
    const float peak = pack->recipe_rows[row].weight;
    term->peak = peak;
    term->from = 0.0f;
    term->to = peak < 1.0f ? 1.0f : peak;
    if (peak >= 1.0f) return;
    for (group other = group_from(pack, 0); other.first < other.end; other = group_from(pack, other.end)) {
        float at;
        if (!are_siblings(pack, g, &other)) continue;
        at = pack->recipe_rows[row_of(pack, &other, pack->recipe_rows[row].channel_hash)].weight;
        if (at < peak && at > term->from) term->from = at;
        if (at > peak && at < term->to) term->to = at;
    }
}

static int is_whole(const noh_mesh *mesh, const group *g)
{
    if (g->end - g->first > NOH_CORRECTIVE_DRIVERS_MAX) return 0;
    for (uint32_t row = g->first; row < g->end; row++) {
        const float peak = mesh->pack->recipe_rows[row].weight;
        if (noh_mesh_find_target(mesh, driver_of(mesh->pack, row)) == NOH_NONE || !(peak > 0.0f && peak <= 1.0f))
            return 0;
    }
    return noh_mesh_find_target(mesh, noh_pack_string(mesh->pack, mesh->pack->recipe_rows[g->first].target)) !=
           NOH_NONE;
}

uint32_t noh_correctives_bind(const noh_mesh *mesh, noh_corrective_term *terms, uint32_t term_max)
{
    NOH_ASSERT(mesh && (terms || !term_max));
    const noh_pack *pack = mesh->pack;
    uint32_t count = 0;
    for (group g = group_from(pack, 0); g.first < g.end; g = group_from(pack, g.end)) {
        if (!is_whole(mesh, &g)) continue;
        for (uint32_t row = g.first; row < g.end; row++, count++) {
            if (count >= term_max) continue;
            terms[count].target = (uint16_t)noh_mesh_find_target(mesh,
                                                                 noh_pack_string(pack, pack->recipe_rows[row].target));
            terms[count].driver = (uint16_t)noh_mesh_find_target(mesh, driver_of(pack, row));
            set_range(pack, &g, row, &terms[count]);
        }
    }
    return count;
}

/* Exact at 0, at the peak and at the neighbouring peaks: x / x is 1, 0 / x is 0. */
static float factor(const noh_corrective_term *t, float weight)
{
    if (!(weight > t->from)) return 0.0f;
    if (weight < t->peak) return (weight - t->from) / (t->peak - t->from);
    if (t->to <= t->peak) return 1.0f;
    return weight < t->to ? (t->to - weight) / (t->to - t->peak) : 0.0f;
}

void noh_correctives_apply(const noh_corrective_term *terms, uint32_t term_count, float *weights)
{
    float product = 1.0f;
    NOH_ASSERT((terms || !term_count) && (weights || !term_count));
    for (uint32_t i = 0; i < term_count; i++) {
        product *= factor(&terms[i], weights[terms[i].driver]);
        if (i + 1u < term_count && terms[i + 1u].target == terms[i].target) continue;
        weights[terms[i].target] = product;
        product = 1.0f;
    }
}
