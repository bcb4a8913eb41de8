/* skin_kernel_internal.h (private to deform/): a block of NOH_LANES vertices, moved side by side.
 *
 * Each vertex has joints of its own, so matrices are gathered and blended vertex by vertex, with the rows of a matrix
 * in the vector. Everything else is the same for every vertex and runs with one vertex per lane: the block's matrices,
 * positions and directions are transposed (lanes_columns), moved, and transposed back (lanes_rows). The operations are
 * the same, in the same order, as in noh_mesh_directions, noh_morph_vertex and noh_skin_apply, and lanes never mix, so
 * the bits are the same. */
#ifndef NOH_DEFORM_SKIN_KERNEL_INTERNAL_H
#define NOH_DEFORM_SKIN_KERNEL_INTERNAL_H

#include <string.h>

#include "core/base/simd_internal.h"
#include "core/base/compiler_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/pack.h"

/* The arguments of a call. joints: for meshes with one palette, the matrix of each palette entry. */
typedef struct skin_job {
    const noh_mesh *mesh;
    const float *matrices;
    const noh_morph_layers *layers;        /* or NULL */
    float *positions, *normals, *tangents; /* or NULL */
    int has_tangents;
    int split;  /* the mesh has several palettes */
    int texels; /* its vertices have texel references */
    const float *joints[NOH_PALETTE_JOINTS_MAX];
} skin_job;

/* ---- one matrix per vertex ---- */

#if NOH_LANES == 8
/* Two rows in one register, the third in half a register. */
static inline void blend_rows(const float *const *from, const float *weights, uint32_t count, float m[12])
{
    noh_v8 w = noh_v8_set(weights[0]), ab = noh_v8_mul(w, noh_v8_load(from[0]));
    noh_v4 c = noh_v4_mul(noh_v8_low(w), noh_v4_load(from[0] + 8));
    NOH_UNROLL
    for (uint32_t i = 1; i < count; i++) {
        w = noh_v8_set(weights[i]);
        ab = noh_v8_add(ab, noh_v8_mul(w, noh_v8_load(from[i])));
        c = noh_v4_add(c, noh_v4_mul(noh_v8_low(w), noh_v4_load(from[i] + 8)));
    }
    noh_v8_store(m, ab);
    noh_v4_store(m + 8, c);
}
#else
static inline void blend_rows(const float *const *from, const float *weights, uint32_t count, float m[12])
{
    noh_v4 w = noh_v4_set(weights[0]), a = noh_v4_mul(w, noh_v4_load(from[0]));
    noh_v4 b = noh_v4_mul(w, noh_v4_load(from[0] + 4)), c = noh_v4_mul(w, noh_v4_load(from[0] + 8));
    NOH_UNROLL
    for (uint32_t i = 1; i < count; i++) {
        w = noh_v4_set(weights[i]);
        a = noh_v4_add(a, noh_v4_mul(w, noh_v4_load(from[i])));
        b = noh_v4_add(b, noh_v4_mul(w, noh_v4_load(from[i] + 4)));
        c = noh_v4_add(c, noh_v4_mul(w, noh_v4_load(from[i] + 8)));
    }
    noh_v4_store(m, a);
    noh_v4_store(m + 4, b);
    noh_v4_store(m + 8, c);
}
#endif

/* The weights of noh_mesh_influences, for a count known at compile time: the loop is unrolled, and all bit positions
 * are constants. The first weight is not stored: it is 1 minus the others. */
static inline void unpack_weights(const uint32_t *bits, uint32_t count, float *weights)
{
    const float unit = 1.0f / (float)NOH_WEIGHT_ONE;
    uint32_t rest = NOH_WEIGHT_ONE;
    NOH_UNROLL
    for (uint32_t i = 1; i < count; i++) {
        uint32_t bit = i == 1 ? 0 : 22u + 21u * (i - 2u), size = i == 1 ? 22u : 21u,
                 weight = bits[bit / 32u] >> bit % 32u;
        if (bit % 32u + size > 32u) {
            weight |= bits[bit / 32u + 1u] << (32u - bit % 32u);
        }
        weight &= (1u << size) - 1u;
        weights[i] = (float)(int32_t)weight * unit;
        rest -= weight;
    }
    weights[0] = (float)(int32_t)rest * unit;
}

/* A vertex's texel reference and palette, for a mesh with texel references. */
static inline uint32_t texel_word(const skin_job *job, uint32_t vertex)
{
    const size_t stride = job->mesh->header->attribute_stride;
    uint32_t word;
    memcpy(&word, job->mesh->attributes + (vertex + (size_t)1) * stride - 4, sizeof word);
    return word;
}

static inline void blend_vertex(const skin_job *job, uint32_t vertex, uint32_t count, float m[12])
{
    const uint32_t *words = job->mesh->influences + (size_t)vertex * NOH_INFLUENCE_WORDS(count);
    const uint8_t *places = (const uint8_t *)words;
    const float *from[NOH_INFLUENCES_MAX] = { NULL };
    float weights[NOH_INFLUENCES_MAX] = { 0.0f };
    unpack_weights(words + (count == 8u ? 2 : 1), count, weights);
    if (job->split) {
        const uint32_t palette = texel_word(job, vertex) >> NOH_TEXEL_VERTEX_BITS;
        const uint16_t *joints = job->mesh->palette_joints + job->mesh->palettes[palette].first_joint;
        NOH_UNROLL
        for (uint32_t i = 0; i < count; i++) {
            from[i] = job->matrices + 12u * (size_t)joints[places[i]];
        }
    } else {
        NOH_UNROLL
        for (uint32_t i = 0; i < count; i++) {
            from[i] = job->joints[places[i]];
        }
    }
    blend_rows(from, weights, count, m);
}

/* The matrices of a block. Lanes past `count` repeat the last vertex: this costs nothing, and no lane is undefined. */
static inline void blend_block_of(const skin_job *job, uint32_t first, uint32_t count, uint32_t influences,
                                  float m[NOH_LANES][12])
{
    for (uint32_t i = 0; i < NOH_LANES; i++) {
        blend_vertex(job, first + (i < count ? i : count - 1u), influences, m[i]);
    }
}

static inline void blend_block(const skin_job *job, uint32_t first, uint32_t count, float m[NOH_LANES][12])
{
    switch (job->mesh->header->influence_count) {
    case 1: blend_block_of(job, first, count, 1, m); break;
    case 2: blend_block_of(job, first, count, 2, m); break;
    case 4: blend_block_of(job, first, count, 4, m); break;
    default: blend_block_of(job, first, count, 8, m); break;
    }
}

/* ---- a block ---- */

/* Positions, and the first four words of the attribute records. A load of four words reads beyond the three words of a
 * position and beyond short records, but not beyond the pack: other arrays follow both. Incomplete blocks are copied
 * first. */
static inline void load_block(const skin_job *job, uint32_t first, uint32_t count, lanes p[4], lanes words[4])
{
    const size_t stride = job->mesh->header->attribute_stride;
    const float *positions = job->mesh->positions + 3u * (size_t)first;
    const uint8_t *records = job->mesh->attributes + stride * first;
    if (count == NOH_LANES) {
        lanes_columns(positions, 3, p);
        lanes_columns((const float *)(const void *)records, stride / 4u, words);
    } else {
        float copies[2][NOH_LANES][4];
        memset(copies, 0, sizeof copies);
        for (uint32_t i = 0; i < NOH_LANES; i++) {
            size_t from = i < count ? i : count - 1u;
            memcpy(copies[0][i], positions + 3u * from, 12);
            memcpy(copies[1][i], records + stride * from, job->has_tangents ? 8 : 4);
        }
        lanes_columns(copies[0][0], 4, p);
        lanes_columns(copies[1][0], 4, words);
    }
}

/* Octahedral directions, unnormalised: z = 1 - |x| - |y|; where z is negative, x and y are folded over the diagonal.
 * (Q. Meyer et al., "On floating-point normal vectors", 2010) */
static inline void unfold_lanes(lanes x, lanes y, lanes out[3])
{
    const lanes zero = lanes_set(0.0f);
    lanes z = lanes_sub(lanes_sub(lanes_set(1.0f), lanes_abs(x)), lanes_abs(y));
    lanes fold = lanes_choose(lanes_less(z, zero), lanes_negate(z), zero);
    out[0] = lanes_add(x, lanes_choose(lanes_less(x, zero), fold, lanes_negate(fold)));
    out[1] = lanes_add(y, lanes_choose(lanes_less(y, zero), fold, lanes_negate(fold)));
    out[2] = z;
}

/* noh_normalize3, lane by lane */
static inline void lanes_normalize3(lanes v[3], const lanes fallback[3])
{
    lanes square = lanes_dot3(v, v), long_enough = lanes_less(lanes_set(1e-30f), square);
    lanes inverse = lanes_div(lanes_set(1.0f), lanes_sqrt(square));
    NOH_UNROLL
    for (int i = 0; i < 3; i++) {
        v[i] = lanes_choose(long_enough, lanes_mul(v[i], inverse), fallback[i]);
    }
}

static inline void make_unit(lanes v[3])
{
    const lanes zero = lanes_set(0.0f), up[3] = { zero, zero, lanes_set(1.0f) };
    lanes_normalize3(v, up);
}

/* Normalise a moved direction; one of length 0 becomes the rest direction. */
static inline void make_unit_or_rest(lanes v[3], const lanes rest[3])
{
    lanes short_ones = lanes_less(lanes_dot3(v, v), lanes_set(2e-30f));
    if (lanes_any(short_ones)) {
        lanes unit[3] = { rest[0], rest[1], rest[2] };
        make_unit(unit);
        lanes_normalize3(v, unit);
    } else {
        lanes_normalize3(v, rest); /* all have a length: `rest` is never chosen */
    }
}

/* Deltas of a block's vertices. */
typedef struct skin_deltas {
    float of[3][NOH_LANES][4]; /* position, normal, tangent; the fourth float is unused */
    float touched[NOH_LANES];  /* 1, or 0 */
} skin_deltas;

/* Returns whether there is any. */
static inline int gather_deltas(const skin_job *job, uint32_t first, uint32_t count, skin_deltas *d)
{
    const noh_morph_layers *layers = job->layers;
    int any = 0;
    if (!layers || (!job->texels && first >= job->mesh->header->touched_count)) {
        return 0;
    }
    for (uint32_t i = 0; i < count; i++) {
        size_t texel = job->texels ? texel_word(job, first + i) & NOH_TEXEL_NONE : first + i;
        if (texel < job->mesh->header->touched_count) {
            if (!any) {
                memset(d, 0, sizeof *d);
                any = 1;
            }
            d->touched[i] = 1.0f;
            memcpy(d->of[0][i], layers->position + 3u * texel, 12);
            memcpy(d->of[1][i], layers->normal + 3u * texel, 12);
            if (layers->tangent) memcpy(d->of[2][i], layers->tangent + 3u * texel, 12);
        }
    }
    return any;
}

static inline void add_delta(const lanes base[3], float deltas[NOH_LANES][4], lanes out[3])
{
    lanes delta[4];
    lanes_columns(deltas[0], 4, delta);
    NOH_UNROLL
    for (int i = 0; i < 3; i++) {
        out[i] = lanes_add(base[i], delta[i]);
    }
}

static inline void choose3(lanes mask, const lanes yes[3], lanes v[3])
{
    NOH_UNROLL
    for (int i = 0; i < 3; i++) {
        v[i] = lanes_choose(mask, yes[i], v[i]);
    }
}

/* noh_morph_vertex for a block; vertices that no target moves stay unchanged and are not normalised. */
static inline void morph_block(skin_deltas *d, int tangents, lanes p[3], lanes n[3], lanes t[3])
{
    lanes mask, moved[3], normal[3], unit[3] = { n[0], n[1], n[2] };
    memcpy(&mask, d->touched, sizeof mask);
    mask = lanes_less(lanes_set(0.0f), mask);
    add_delta(p, d->of[0], moved);
    choose3(mask, moved, p);
    make_unit(unit);
    add_delta(unit, d->of[1], normal);
    lanes_normalize3(normal, unit);
    if (tangents) {
        lanes along, unit_tangent[3] = { t[0], t[1], t[2] };
        make_unit(unit_tangent);
        add_delta(unit_tangent, d->of[2], moved);
        along = lanes_dot3(moved, normal);
        NOH_UNROLL
        for (int i = 0; i < 3; i++) {
            moved[i] = lanes_sub(moved[i], lanes_mul(along, normal[i]));
        }
        lanes_normalize3(moved, unit_tangent);
        choose3(mask, moved, t);
    }
    choose3(mask, normal, n);
}

/* a * b - c * d */
static inline lanes cross_term(lanes a, lanes b, lanes c, lanes d)
{
    return lanes_sub(lanes_mul(a, b), lanes_mul(c, d));
}

static inline void cofactor_lanes(lanes m[3][4], lanes c[3][3])
{
    c[0][0] = cross_term(m[1][1], m[2][2], m[1][2], m[2][1]);
    c[0][1] = cross_term(m[1][2], m[2][0], m[1][0], m[2][2]);
    c[0][2] = cross_term(m[1][0], m[2][1], m[1][1], m[2][0]);
    c[1][0] = cross_term(m[0][2], m[2][1], m[0][1], m[2][2]);
    c[1][1] = cross_term(m[0][0], m[2][2], m[0][2], m[2][0]);
    c[1][2] = cross_term(m[0][1], m[2][0], m[0][0], m[2][1]);
    c[2][0] = cross_term(m[0][1], m[1][2], m[0][2], m[1][1]);
    c[2][1] = cross_term(m[0][2], m[1][0], m[0][0], m[1][2]);
    c[2][2] = cross_term(m[0][0], m[1][1], m[0][1], m[1][0]);
}

/* direct 1: rows of four floats are stored directly; for three floats, the next vertex overwrites the fourth. The last
 * block has no next vertex, so only the vertices' own floats are written (direct 0). */
static inline void store_block(const lanes v[3], lanes last, uint32_t floats, uint32_t count, int direct, float *out)
{
    const lanes columns[4] = { v[0], v[1], v[2], last };
    float rows[NOH_LANES][4];
    if (direct) {
        lanes_rows(columns, out, floats);
        return;
    }
    lanes_rows(columns, rows[0], 4);
    for (uint32_t i = 0; i < count; i++) {
        memcpy(out + floats * (size_t)i, rows[i], floats * sizeof(float));
    }
}

/* Move a block as noh_skin_apply does, to elements at..at+count-1 of the outputs. */
static inline void move_block(const skin_job *job, float matrices[NOH_LANES][12], lanes p[3], lanes n[3], lanes t[3],
                              lanes hand, uint32_t at, uint32_t count, int direct)
{
    lanes m[3][4], c[3][3], moved[3], sign;
    NOH_UNROLL
    for (int r = 0; r < 3; r++) {
        lanes_columns(matrices[0] + 4 * r, 12, m[r]);
    }
    cofactor_lanes(m, c);
    sign = lanes_choose(lanes_less(lanes_dot3(m[0], c[0]), lanes_set(0.0f)), lanes_set(-1.0f), lanes_set(1.0f));
    if (job->positions) {
        NOH_UNROLL
        for (int r = 0; r < 3; r++) {
            moved[r] = lanes_add(lanes_dot3(m[r], p), m[r][3]);
        }
        store_block(moved, sign, 3, count, direct, job->positions + 3u * (size_t)at);
    }
    if (job->normals) {
        NOH_UNROLL
        for (int r = 0; r < 3; r++) {
            moved[r] = lanes_mul(sign, lanes_dot3(c[r], n));
        }
        make_unit_or_rest(moved, n);
        store_block(moved, sign, 3, count, direct, job->normals + 3u * (size_t)at);
    }
    if (job->tangents && job->has_tangents) {
        NOH_UNROLL
        for (int r = 0; r < 3; r++) {
            moved[r] = lanes_dot3(m[r], t);
        }
        make_unit_or_rest(moved, t);
        store_block(moved, lanes_mul(sign, hand), 4, count, direct, job->tangents + 4u * (size_t)at);
    }
}

/* Move vertices first..first+count-1 to elements at..at+count-1 of the outputs; count is at most NOH_LANES. last: the
 * outputs end there. */
static inline void skin_block(const skin_job *job, uint32_t first, uint32_t count, uint32_t at, int last)
{
    float matrices[NOH_LANES][12];
    skin_deltas deltas;
    lanes p[4], words[4], n[3], t[3], hand = lanes_set(0.0f);
    blend_block(job, first, count, matrices);
    load_block(job, first, count, p, words);
    unfold_lanes(lanes_mul(lanes_field(words[0], 16, 16), lanes_set(1.0f / 32767.0f)),
                 lanes_mul(lanes_field(words[0], 0, 16), lanes_set(1.0f / 32767.0f)), n);
    memcpy(t, n, sizeof t);
    if (job->has_tangents) {
        unfold_lanes(lanes_mul(lanes_field(words[1], 16, 16), lanes_set(1.0f / 32767.0f)),
                     lanes_mul(lanes_field(words[1], 0, 17), lanes_set(1.0f / 16383.0f)), t);
        hand = lanes_add(lanes_set(1.0f), lanes_mul(lanes_set(2.0f), lanes_field(words[1], 15, 31)));
    }
    if (gather_deltas(job, first, count, &deltas)) {
        morph_block(&deltas, job->has_tangents, p, n, t);
    }
    move_block(job, matrices, p, n, t, hand, at, count, count == NOH_LANES && !last);
}

#endif
