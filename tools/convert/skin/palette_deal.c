#include "palette_deal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "influence_pack.h"
#include "convert/model/model_build.h"
#include "noh/base.h"

int palette_deal_begin(palette_deal *deal, uint32_t joint_count, uint32_t limit)
{
    memset(deal, 0, sizeof *deal);
    deal->joint_count = joint_count;
    deal->limit = limit;
    deal->words = joint_count / 64u + 1u;
    deal->sets = model_zeros((size_t)NOH_SUBMESHES_MAX * deal->words, sizeof *deal->sets);
    deal->sizes = model_zeros(NOH_SUBMESHES_MAX, sizeof *deal->sizes);
    return !deal->sets || !deal->sizes;
}

void palette_deal_free(palette_deal *deal)
{
    free(deal->sets);
    free(deal->sizes);
}

int palette_deal_has(const palette_deal *deal, uint32_t palette, uint32_t joint)
{
    return (int)(deal->sets[(size_t)palette * deal->words + joint / 64u] >> joint % 64u & 1u);
}

/* The joints of three vertices, each once. */
static uint32_t triangle_joints(const model_mesh *mesh, const uint32_t vertices[3], uint32_t *joints)
{
    uint32_t count = 0;
    for (int corner = 0; corner < 3; corner++) {
        influence_list list;
        influence_quantise(mesh, vertices[corner], &list);
        for (uint32_t i = 0; i < list.count; i++) {
            uint32_t k = 0;
            while (k < count && joints[k] != list.joints[i]) {
                k++;
            }
            joints[k] = list.joints[i];
            count += k == count;
        }
    }
    return count;
}

static uint32_t count_missing(const palette_deal *deal, uint32_t palette, const uint32_t *joints, uint32_t count)
{
    uint32_t missing = 0;
    for (uint32_t i = 0; i < count; i++) {
        missing += !palette_deal_has(deal, palette, joints[i]);
    }
    return missing;
}

static void add_joints(palette_deal *deal, uint32_t palette, const uint32_t *joints, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        deal->sizes[palette] += !palette_deal_has(deal, palette, joints[i]);
        deal->sets[(size_t)palette * deal->words + joints[i] / 64u] |= (uint64_t)1 << joints[i] % 64u;
    }
}

int palette_deal_triangle(palette_deal *deal, const model_mesh *mesh, const uint32_t vertices[3], uint32_t first,
                          uint32_t *palette, model_error *error)
{
    uint32_t joints[3 * NOH_INFLUENCES_MAX], best = MODEL_NONE;
    uint32_t count = triangle_joints(mesh, vertices, joints), fewest = MODEL_NONE;
    char where[64];
    for (uint32_t p = first; p < deal->palette_count && fewest; p++) {
        uint32_t missing = count_missing(deal, p, joints, count);
        if (missing < fewest && deal->sizes[p] + missing <= deal->limit) {
            best = p;
            fewest = missing;
        }
    }
    if (best == MODEL_NONE) {
        snprintf(where, sizeof where, "mesh '%.40s'", mesh->name);
        if (count > deal->limit) {
            return model_fail(error, where,
                              "a triangle follows %u joints, but a palette holds %u: raise --palette to at least %u",
                              count, deal->limit, count);
        }
        if (deal->palette_count == NOH_SUBMESHES_MAX) {
            return model_fail(error, where, "palettes of %u joints cut it into more than %u parts: raise --palette",
                              deal->limit, NOH_SUBMESHES_MAX);
        }
        best = deal->palette_count++;
    }
    add_joints(deal, best, joints, count);
    *palette = best;
    return 0;
}
