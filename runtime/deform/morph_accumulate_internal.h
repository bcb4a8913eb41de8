/* morph_accumulate_internal.h (private to deform/): the loops over targets, rectangles and rows, around a kernel that
 * adds one run of texels. They are inlined into one function for each kernel: called through a pointer for each row, a
 * kernel takes up to twice as long. */
#ifndef NOH_DEFORM_MORPH_ACCUMULATE_INTERNAL_H
#define NOH_DEFORM_MORPH_ACCUMULATE_INTERNAL_H

#include "deform/morph.h"
#include "deform/morph_kernel_internal.h"

static inline morph_field noh_make_field(unsigned before, unsigned bits, float weight)
{
    morph_field f = { before, 32u - bits, weight };
    return f;
}

/* A delta texel is three words, one for each axis; each word holds the position, the normal and the tangent difference
 * of that axis as two's complement integers, from the top bit down. Shifted left to the top and then right
 * arithmetically, a field is its integer; scale and weight make one factor, as on the GPU, so that CPU and GPU round
 * the same products. */
static inline void noh_target_fields(const noh_target *t, float weight, morph_field f[3])
{
    f[0] = noh_make_field(0, t->position_bits, t->position_scale * weight);
    f[1] = noh_make_field(t->position_bits, t->normal_bits, t->normal_scale * weight);
    f[2] = noh_make_field((unsigned)t->position_bits + t->normal_bits, t->tangent_bits, t->tangent_scale * weight);
}

/* lead: morph_run_template.h */
typedef void (*noh_run_function)(const uint32_t *words, size_t count, size_t lead, const morph_field f[3],
                                 float *const layers[3]);

/* Whether any of the groups of NOH_MORPH_GROUP texels that a run lies in is wanted. groups NULL: all are */
static inline int noh_is_wanted(const uint8_t *groups, size_t texel, size_t count)
{
    int wanted = !groups;
    for (size_t g = texel / NOH_MORPH_GROUP; !wanted && g <= (texel + count - 1u) / NOH_MORPH_GROUP; g++) {
        wanted = groups[g];
    }
    return wanted;
}

/* Every row of every rectangle of one target. The delta texels of a target lie in the order of its rectangles, row by
 * row, so that a row is one run of words in the pack and one run of floats in each layer: the inner loop only streams.
 */
NOH_ALWAYS_INLINE void noh_accumulate_target(const noh_mesh *mesh, const noh_target *t, const morph_field f[3],
                                             const noh_morph_layers *layers, const uint8_t *groups,
                                             noh_run_function run)
{
    const noh_mesh_header *h = mesh->header;
    const noh_rect *rect = mesh->rects + t->first_rect;
    const size_t stride = (size_t)3u << h->morph_width_log2, floats = h->morph_height * stride;
    const noh_target *last = mesh->targets + h->target_count - 1u;
    const size_t end = 3u * ((size_t)last->first_texel + last->texel_count);
    size_t word = 3u * (size_t)t->first_texel;
    for (uint32_t i = 0; i < t->rect_count; i++, rect++) {
        size_t row = rect->y * stride + 3u * (size_t)rect->x;
        const size_t count = 3u * (size_t)rect->w;
        for (unsigned y = 0; y < rect->h; y++) {
            float *at[3] = { layers->position + row, layers->normal + row,
                             layers->tangent ? layers->tangent + row : NULL };
            size_t lead = (size_t)(uintptr_t)at[0] / sizeof(float) % NOH_MORPH_LANES;
            if (lead > row || lead > word || row + count + NOH_MORPH_LANES > floats ||
                word + count + NOH_MORPH_LANES > end) {
                lead = NOH_MORPH_ALONE;
            }
            if (noh_is_wanted(groups, row / 3u, rect->w)) run(mesh->texels + word, count, lead, f, at);
            word += count;
            row += stride;
        }
    }
}

#if NOH_ASSERT_LEVEL >= 2
static inline int noh_all_finite(const float *values, uint32_t count)
{
    uint32_t finite = 0;
    for (uint32_t i = 0; i < count; i++) {
        finite += values[i] - values[i] == 0.0f;
    }
    return finite == count;
}
#endif

NOH_ALWAYS_INLINE void noh_accumulate_targets(const noh_mesh *mesh, const float *weights,
                                              const noh_morph_layers *layers, const uint8_t *groups,
                                              noh_run_function run)
{
    NOH_ASSERT(mesh && weights && layers);
    NOH_ASSERT(layers->position || !mesh->header->touched_count);
    NOH_VALIDATE(noh_all_finite(weights, mesh->header->target_count));
    for (uint32_t i = 0; i < mesh->header->target_count; i++) {
        morph_field f[3];
        if (weights[i] != 0.0f) {
            noh_target_fields(&mesh->targets[i], weights[i], f);
            noh_accumulate_target(mesh, &mesh->targets[i], f, layers, groups, run);
        }
    }
}

#ifdef NOH_AVX2_AT_RUN_TIME
/* noh_morph_accumulate with AVX2, for processors that have it. */
void noh_morph_accumulate_wide(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers);
void noh_morph_accumulate_some_wide(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers,
                                    const uint8_t *groups);
#endif

#endif
