/* morph_accumulate_internal.h (private to deform/): the loops over targets, rectangles and rows, around a kernel that
 * adds one run of texels. They are inlined into one function per kernel: a call through a pointer for each row takes up
 * to twice as long. */
#ifndef NOH_DEFORM_MORPH_ACCUMULATE_INTERNAL_H
#define NOH_DEFORM_MORPH_ACCUMULATE_INTERNAL_H

#include "core/base/assert_internal.h"
#include "core/base/compiler_internal.h"
#include "deform/morph/morph_internal.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/pack.h"
#include "deform/morph/morph_kernel_internal.h"

static inline morph_field noh_make_field(unsigned before, unsigned bits, float weight)
{
    morph_field f = { before, 32u - bits, weight };
    return f;
}

/* A delta texel is three words, one for each axis; each word holds the position, the normal and the tangent difference
 * of that axis as two's complement integers, from the top bit down. A left shift to the top and an arithmetic right
 * shift extract a field's integer. Scale and weight are multiplied first, as on the GPU, so that CPU and GPU round the
 * same products. */
static inline void noh_target_fields(const noh_target *t, float weight, morph_field f[3])
{
    f[0] = noh_make_field(0, t->position_bits, t->position_scale * weight);
    f[1] = noh_make_field(t->position_bits, t->normal_bits, t->normal_scale * weight);
    f[2] = noh_make_field((unsigned)t->position_bits + t->normal_bits, t->tangent_bits, t->tangent_scale * weight);
}

typedef void (*noh_rows_function)(const noh_morph_rows *rows, const morph_field f[3], float *const layers[3]);

/* Whether any group of NOH_MORPH_GROUP texels that a run overlaps is wanted. groups NULL: all are */
static inline int noh_is_wanted(const uint8_t *groups, size_t texel, size_t count)
{
    int wanted = !groups;
    for (size_t g = texel / NOH_MORPH_GROUP; !wanted && g <= (texel + count - 1u) / NOH_MORPH_GROUP; g++) {
        wanted = groups[g];
    }
    return wanted;
}

/* Input and output of an accumulation. */
typedef struct noh_morph_job {
    const noh_mesh *mesh;
    const noh_morph_layers *layers;
    const uint8_t *groups; /* NULL: all */
    size_t stride, floats; /* floats per row, floats per layer */
    size_t words;          /* least number of words from mesh->texels on */
} noh_morph_job;

static inline noh_morph_job noh_morph_job_of(const noh_mesh *mesh, const noh_morph_layers *layers,
                                             const uint8_t *groups)
{
    const noh_mesh_header *h = mesh->header;
    noh_morph_job j = { mesh, layers, groups, (size_t)3u << h->morph_width_log2, 0, 0 };
    j.floats = h->morph_height * j.stride;
    if (h->target_count) {
        const noh_target *last = mesh->targets + h->target_count - 1u;
        j.words = 3u * ((size_t)last->first_texel + last->texel_count);
    }
    return j;
}

/* Rows of `count` floats needed to raise `have` to at least `need`: three at most. */
static inline size_t noh_rows_short(size_t have, size_t need, size_t count)
{
    size_t rows = 0;
    for (; have < need; have += count) rows++;
    return rows;
}

/* Add `rows` rows of a rectangle; the first row begins at float `at` of each layer and at `word`. Rows are added with
 * NOH_MORPH_ALONE if a vector would begin or end outside the layers or the words. */
NOH_ALWAYS_INLINE void noh_accumulate_rows(const noh_morph_job *j, const noh_rect *rect, size_t at, size_t word,
                                           size_t rows, const morph_field f[3], noh_rows_function add)
{
    const size_t count = 3u * (size_t)rect->w, words_end = word + rows * count;
    const size_t lead = (size_t)(uintptr_t)(j->layers->position + at) / sizeof(float) % NOH_MORPH_LANES;
    const size_t behind = (NOH_MORPH_LANES - (lead + count) % NOH_MORPH_LANES) % NOH_MORPH_LANES;
    size_t first = noh_rows_short(word, lead, count), y = 0;
    size_t last = noh_rows_short(j->words > words_end ? j->words - words_end : 0, behind, count);
    if (!first && at < lead) first = 1;
    if (!last && at + (rows - 1u) * j->stride + count + behind > j->floats) last = 1;
    while (y < rows) {
        const size_t row = at + y * j->stride;
        float *const to[3] = { j->layers->position + row, j->layers->normal + row,
                               j->layers->tangent ? j->layers->tangent + row : NULL };
        noh_morph_rows r = { j->mesh->texels + word + y * count, count, 1, j->stride, NOH_MORPH_ALONE };
        if (y >= first && y + last < rows) {
            r.rows = rows - last - y;
            r.lead = lead;
        }
        add(&r, f, to);
        y += r.rows;
    }
}

/* Add every rectangle of one target. Its delta texels are stored in the order of its rectangles, row by row, so a row
 * is one run of words in the pack and one run of floats in each layer: the inner loop only streams. */
NOH_ALWAYS_INLINE void noh_accumulate_target(const noh_morph_job *j, const noh_target *t, const morph_field f[3],
                                             noh_rows_function add)
{
    const noh_rect *rect = j->mesh->rects + t->first_rect;
    size_t word = 3u * (size_t)t->first_texel;
    for (uint32_t i = 0; i < t->rect_count; i++, rect++) {
        const size_t at = rect->y * j->stride + 3u * (size_t)rect->x, count = 3u * (size_t)rect->w;
        const size_t rows = j->groups ? 1 : rect->h;
        for (size_t y = 0; y < rect->h; y += rows) {
            const size_t row = at + y * j->stride;
            if (noh_is_wanted(j->groups, row / 3u, rect->w)) {
                noh_accumulate_rows(j, rect, row, word + y * count, rows, f, add);
            }
        }
        word += count * rect->h;
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
                                              noh_rows_function add)
{
    noh_morph_job j;
    NOH_ASSERT(mesh && weights && layers);
    NOH_ASSERT(layers->position || !mesh->header->touched_count);
    NOH_VALIDATE(noh_all_finite(weights, mesh->header->target_count));
    j = noh_morph_job_of(mesh, layers, groups);
    for (uint32_t i = 0; i < mesh->header->target_count; i++) {
        morph_field f[3];
        if (weights[i] != 0.0f) {
            noh_target_fields(&mesh->targets[i], weights[i], f);
            noh_accumulate_target(&j, &mesh->targets[i], f, add);
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
