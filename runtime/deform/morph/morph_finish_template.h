/* morph_finish_template.h (private to deform/): the kernel that finishes vertices, for any number of lanes; included
 * once per width. LANES() gives names and LANES_TYPE the type of simd_internal.h, LANES_COUNT the number of lanes,
 * LANES_INLINE the attributes of functions.
 *
 * Each lane has one vertex. Four words are loaded per record, which may be more than it has, so plain C finishes the
 * last vertices of a mesh. It also finishes blocks in which a direction vanishes or overflows. */
#include <string.h>

#include "deform/morph/morph_finish_internal.h"
#include "core/base/assert_internal.h"
#include "core/base/compiler_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"
#include "noh/low_core.h"
#include "noh/deform.h"

#ifndef LANES
#define LANES(name) lanes_##name
#define LANES_TYPE lanes
#define LANES_COUNT NOH_LANES
#define LANES_INLINE NOH_ALWAYS_INLINE
#endif

LANES_INLINE void LANES(unfold)(LANES_TYPE word, int is_tangent, LANES_TYPE out[3])
{
    const LANES_TYPE zero = LANES(set)(0.0f);
    const LANES_TYPE x = LANES(mul)(LANES(field)(word, 16, 16), LANES(set)(1.0f / 32767.0f));
    const LANES_TYPE y = is_tangent ? LANES(mul)(LANES(field)(word, 0, 17), LANES(set)(1.0f / 16383.0f))
                                    : LANES(mul)(LANES(field)(word, 0, 16), LANES(set)(1.0f / 32767.0f));
    const LANES_TYPE z = LANES(sub)(LANES(sub)(LANES(set)(1.0f), LANES(abs)(x)), LANES(abs)(y));
    const LANES_TYPE fold = LANES(max)(zero, LANES(negate)(z));
    out[0] = LANES(sub)(x, LANES(with_sign)(fold, x));
    out[1] = LANES(sub)(y, LANES(with_sign)(fold, y));
    out[2] = z;
}

LANES_INLINE void LANES(fold)(const LANES_TYPE v[3], LANES_TYPE pair[2])
{
    const LANES_TYPE one = LANES(set)(1.0f), below = LANES(less)(v[2], LANES(set)(0.0f));
    const LANES_TYPE sum = LANES(add)(LANES(add)(LANES(abs)(v[0]), LANES(abs)(v[1])), LANES(abs)(v[2]));
    const LANES_TYPE inverse = LANES(div)(one, sum), x = LANES(mul)(v[0], inverse), y = LANES(mul)(v[1], inverse);
    pair[0] = LANES(choose)(below, LANES(with_sign)(LANES(sub)(one, LANES(abs)(y)), x), x);
    pair[1] = LANES(choose)(below, LANES(with_sign)(LANES(sub)(one, LANES(abs)(x)), y), y);
}

LANES_INLINE LANES_TYPE LANES(rounded)(LANES_TYPE x, float steps)
{
    return LANES(add)(LANES(mul)(x, LANES(set)(steps)), LANES(set)(NOH_ROUNDER));
}

LANES_INLINE LANES_TYPE LANES(normal_words)(const LANES_TYPE v[3])
{
    LANES_TYPE pair[2];
    LANES(fold)(v, pair);
    return LANES(halves)(LANES(rounded)(pair[0], 32767.0f), LANES(rounded)(pair[1], 32767.0f));
}

/* The second number is twice the steps, plus 1 if the handedness bit is set. */
LANES_INLINE LANES_TYPE LANES(tangent_words)(const LANES_TYPE v[3], LANES_TYPE word)
{
    const LANES_TYPE rounder = LANES(set)(NOH_ROUNDER);
    LANES_TYPE pair[2], y;
    LANES(fold)(v, pair);
    y = LANES(sub)(LANES(rounded)(pair[1], 16383.0f), rounder);
    y = LANES(sub)(LANES(add)(y, y), LANES(field)(word, 15, 31)); /* -1 if the bit is set */
    return LANES(halves)(LANES(rounded)(pair[0], 32767.0f), LANES(add)(y, rounder));
}

/* Add deltas to a direction of the pack, scaled by the direction's length. */
LANES_INLINE void LANES(move)(LANES_TYPE out[3], const float *deltas)
{
    const LANES_TYPE length = LANES(sqrt)(LANES(dot3)(out, out));
    LANES_TYPE delta[3];
    if (!deltas) {
        NOH_UNROLL
        for (int i = 0; i < 3; i++) delta[i] = LANES(set)(0.0f);
    } else {
        LANES(triples)(deltas, delta);
    }
    NOH_UNROLL
    for (int i = 0; i < 3; i++) out[i] = LANES(add)(out[i], LANES(mul)(delta[i], length));
}

/* Whether all lanes are squares of directions. NaN is not. */
LANES_INLINE int LANES(are_directions)(LANES_TYPE square)
{
    const LANES_TYPE no = LANES(set)(-1.0f); /* a set sign bit, as in a mask */
    const LANES_TYPE small = LANES(choose)(LANES(less)(square, LANES(set)(NOH_OVERFLOWS)), LANES(set)(0.0f), no);
    return !LANES(any)(LANES(choose)(LANES(less)(LANES(set)(NOH_VANISHES), square), small, no));
}

/* One block, between the two halves of the kernel. */
typedef struct LANES(moved) {
    LANES_TYPE n[3], t[3]; /* with deltas */
    LANES_TYPE tangent;    /* the pack's words */
    uint32_t v, texel;     /* of the first lane */
} LANES(moved);

/* First half: the directions of the vertices from b->v on, with the deltas of the texels from b->texel on. */
LANES_INLINE void LANES(move_block)(const noh_mesh *mesh, const noh_morph_layers *layers, int has_tangents,
                                    LANES(moved) * b)
{
    const size_t stride = mesh->header->attribute_stride / 4u, at = 3u * (size_t)b->texel;
    LANES_TYPE words[4];
    LANES(columns)((const float *)(const void *)mesh->attributes + (size_t)b->v * stride, stride, words);
    LANES(unfold)(words[0], 0, b->n);
    LANES(move)(b->n, layers->normal + at);
    if (!has_tangents) return;
    b->tangent = words[1];
    LANES(unfold)(words[1], 1, b->t);
    LANES(move)(b->t, layers->tangent ? layers->tangent + at : NULL);
}

/* Second half: fold the directions and write them with the positions. Returns 0 and writes nothing if a lane has no
 * direction. */
LANES_INLINE int LANES(write_block)(const noh_mesh *mesh, const noh_morph_layers *layers, int has_tangents,
                                    const LANES(moved) * b, float *out)
{
    const size_t at = 3u * (size_t)b->texel;
    const LANES_TYPE square = LANES(dot3)(b->n, b->n);
    LANES_TYPE p[4], d[3];
    float tangents[LANES_COUNT];
    if (!LANES(are_directions)(square)) return 0;
    if (has_tangents) {
        LANES_TYPE along = LANES(div)(LANES(dot3)(b->t, b->n), square), t[3];
        NOH_UNROLL
        for (int i = 0; i < 3; i++) t[i] = LANES(sub)(b->t[i], LANES(mul)(b->n[i], along));
        if (!LANES(are_directions)(LANES(dot3)(t, t))) return 0;
        LANES(store)(tangents, LANES(tangent_words)(t, b->tangent));
    }
    LANES(triples)(mesh->positions + 3u * (size_t)b->v, p);
    LANES(triples)(layers->position + at, d);
    NOH_UNROLL
    for (int i = 0; i < 3; i++) p[i] = LANES(add)(p[i], d[i]);
    p[3] = LANES(normal_words)(b->n);
    LANES(rows)(p, out, has_tangents ? 5 : 4);
    for (size_t i = 0; has_tangents && i < LANES_COUNT; i++) memcpy(out + 5u * i + 4u, tangents + i, 4);
    return 1;
}

/* The first texel of a block whose texels are consecutive and all have deltas. NOH_NONE: they are not, or a lane would
 * read past the last layer or the last record (loads extend up to three words beyond a record). */
LANES_INLINE uint32_t LANES(texel_of_block)(const noh_mesh *mesh, uint32_t v)
{
    const noh_mesh_header *h = mesh->header;
    const uint32_t first = h->flags & NOH_MESH_TEXELS ? noh_mesh_accumulation_texel(mesh, v) : v;
    if (first + LANES_COUNT > h->touched_count || first + LANES_COUNT >= h->morph_height << h->morph_width_log2 ||
        v + LANES_COUNT + 3u > h->vertex_count) {
        return NOH_NONE;
    }
    for (uint32_t i = 1; i < LANES_COUNT && h->flags & NOH_MESH_TEXELS; i++) {
        if (noh_mesh_accumulation_texel(mesh, v + i) != first + i) return NOH_NONE;
    }
    return first;
}

LANES_INLINE void LANES(finish)(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count,
                                void *out)
{
    const uint32_t stride = noh_morph_finished_stride(mesh);
    const int has_tangents = (mesh->header->flags & NOH_MESH_TANGENTS) != 0;
    uint32_t i = 0;
    NOH_ASSERT(first <= mesh->header->vertex_count && count <= mesh->header->vertex_count - first && (out || !count));
    while (layers && i + LANES_COUNT <= count) {
        LANES(moved) blocks[NOH_FINISH_BLOCKS];
        uint32_t n = 0;
        for (; n < NOH_FINISH_BLOCKS && i + (n + 1u) * LANES_COUNT <= count; n++) {
            blocks[n].v = first + i + n * LANES_COUNT;
            blocks[n].texel = LANES(texel_of_block)(mesh, blocks[n].v);
            if (blocks[n].texel != NOH_NONE) LANES(move_block)(mesh, layers, has_tangents, &blocks[n]);
        }
        for (uint32_t k = 0; k < n; k++, i += LANES_COUNT) {
            const LANES(moved) *b = &blocks[k];
            uint8_t *to = (uint8_t *)out + (size_t)i * stride;
            if (b->texel == NOH_NONE || !LANES(write_block)(mesh, layers, has_tangents, b, (float *)(void *)to)) {
                noh_morph_finish_scalar(mesh, layers, b->v, LANES_COUNT, to);
            }
        }
    }
    noh_morph_finish_scalar(mesh, layers, first + i, count - i, (uint8_t *)out + (size_t)i * stride);
}

#undef LANES
#undef LANES_TYPE
#undef LANES_COUNT
#undef LANES_INLINE
