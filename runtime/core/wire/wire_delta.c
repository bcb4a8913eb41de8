/* wire_delta.c: the delta texels of a mesh's targets, one target after the other.
 *
 * The deltas of a target vary over the surface as positions do, so they are predicted likewise; where another target is
 * like this one, what is predicted is the difference from it. Vertices at one place move alike. Differences of normals
 * are predicted from the triangles, moved and not: of a smooth surface they say nearly all.
 */
#include "core/wire/wire_internal.h"

#include <string.h>

#include "core/base/math_internal.h"
#include "noh/base.h"
#include "noh/format.h"

#define KINDS 3u /* positions, normals, tangents */
#define CODED 1u /* of a slot above its number: which kinds are coded */
#define SLOT_SHIFT 3u
#define ALL_CODED 7u
#define MODEL_KIND 96u /* models of a kind */

/* cursor: the n-th target of the plan, vertex of the order or slot, phase (2 * kind, or that and 1 for the rest),
 * 1 + target now */

typedef struct target {
    noh_target t;
    uint32_t index;
    uint32_t shift[KINDS], bits[KINDS]; /* of each kind in a word */
    float scale[KINDS];
} target;

static target target_at(const noh_wire_filter *f, uint32_t index)
{
    const noh_mesh_header *h = &f->mesh.header;
    target r;
    memset(&r, 0, sizeof r);
    memcpy(&r.t, f->image + f->mesh.chunk + h->targets_offset + (size_t)index * sizeof r.t, sizeof r.t);
    r.index = index;
    r.bits[0] = r.t.position_bits;
    r.bits[1] = r.t.normal_bits;
    r.bits[2] = r.t.tangent_bits;
    for (uint32_t k = 0, top = 32u; k < KINDS; k++) {
        r.bits[k] = r.bits[k] > 24u ? 24u : r.bits[k];
        r.bits[k] = r.bits[k] > top ? top : r.bits[k];
        top -= r.bits[k];
        r.shift[k] = top;
    }
    r.scale[0] = r.t.position_scale;
    r.scale[1] = r.t.normal_scale;
    r.scale[2] = r.t.tangent_scale;
    return r;
}

static int32_t signed_bits(uint32_t value, uint32_t bits)
{
    return bits ? (int32_t)(value << (32u - bits)) >> (32u - bits) : 0;
}

static uint64_t word_at(const noh_wire_filter *f, uint32_t slot, uint32_t axis)
{
    return (uint64_t)f->mesh.chunk + f->mesh.header.texels_offset + 12u * (uint64_t)slot + 4u * axis;
}

static int32_t value_at(const noh_wire_filter *f, const target *t, uint32_t slot, uint32_t kind, uint32_t axis)
{
    return signed_bits(noh_wire_load(f, word_at(f, slot, axis)) >> t->shift[kind], t->bits[kind]);
}

/* ---- slots ---- */

/* Number the accumulation texels that a target moves by its delta texels. Where rectangles overlap, by the first. */
static void number_slots(const noh_wire_filter *f, const target *t, uint32_t *slots)
{
    const noh_mesh_header *h = &f->mesh.header;
    uint32_t slot = t->t.first_texel;
    for (uint32_t i = 0; i < t->t.rect_count && t->t.first_rect + i < h->rect_count; i++) {
        noh_rect r;
        memcpy(&r, f->image + f->mesh.chunk + h->rects_offset + ((size_t)t->t.first_rect + i) * sizeof r, sizeof r);
        for (uint32_t n = 0; n < (uint32_t)r.w * r.h && slot < h->texel_count; n++, slot++) {
            const uint32_t texel = ((r.y + n / r.w) << h->morph_width_log2) + r.x + n % r.w;
            if (texel < h->touched_count && !slots[texel]) slots[texel] = (slot + 1u) << SLOT_SHIFT;
        }
    }
}

/* The delta texel of a vertex, NOH_NONE where it is not moved. */
static uint32_t slot_of(const noh_wire_filter *f, const uint32_t *slots, uint32_t vertex)
{
    const uint32_t texel = vertex == NOH_NONE ? NOH_NONE : noh_wire_texel(f, vertex);
    return texel == NOH_NONE ? NOH_NONE : (slots[texel] >> SLOT_SHIFT) - 1u;
}

/* ---- normals ---- */

static void position_of(const noh_wire_filter *f, const target *t, uint32_t v, float rest[3], float moved[3])
{
    const uint32_t slot = slot_of(f, f->mesh.slots, v);
    noh_wire_position(f, v, rest);
    for (uint32_t i = 0; i < 3u; i++) {
        moved[i] = rest[i] + (slot == NOH_NONE ? 0.0f : t->scale[0] * (float)value_at(f, t, slot, 0, i));
    }
}

static void cross(float p[3][3], float out[3])
{
    const float u[3] = { p[1][0] - p[0][0], p[1][1] - p[0][1], p[1][2] - p[0][2] };
    const float v[3] = { p[2][0] - p[0][0], p[2][1] - p[0][1], p[2][2] - p[0][2] };
    out[0] = u[1] * v[2] - u[2] * v[1];
    out[1] = u[2] * v[0] - u[0] * v[2];
    out[2] = u[0] * v[1] - u[1] * v[0];
}

static void move_triangle(noh_wire_filter *f, const target *t, const uint32_t v[3])
{
    float rest[3][3], moved[3][3], before[3], after[3];
    for (uint32_t i = 0; i < 3u; i++) position_of(f, t, v[i], rest[i], moved[i]);
    cross(rest, before);
    cross(moved, after);
    for (uint32_t k = 0; k < 3u; k++) {
        float *sum = f->mesh.moved + 3u * (size_t)(f->mesh.summed == 2 ? f->mesh.twins[v[k]] : v[k]);
        for (uint32_t i = 0; i < 3u; i++) sum[i] += after[i] - before[i];
    }
}

/* What a target adds to the sums of the triangles' normals. */
static void move_triangles(noh_wire_filter *f, const target *t)
{
    const uint32_t triangles = f->mesh.header.index_count / 3u;
    if (f->mesh.summed != f->section.mode) noh_wire_sum_normals(f, f->section.mode == 2);
    memset(f->mesh.moved, 0, 12u * (size_t)f->mesh.header.vertex_count);
    for (uint32_t i = 0; i < triangles; i++) {
        uint32_t v[3], any = 0;
        for (uint32_t k = 0; k < 3u; k++) {
            v[k] = noh_wire_index(f, 3u * i + k);
            any |= slot_of(f, f->mesh.slots, v[k]) != NOH_NONE;
        }
        if (any) move_triangle(f, t, v);
    }
}

static int32_t to_int(float x, float limit)
{
    if (!(x > -limit && x < limit)) return 0;
    return x >= 0.0f ? (int32_t)(x + 0.5f) : -(int32_t)(0.5f - x);
}

static void guess_normal(const noh_wire_filter *f, const target *t, uint32_t v, int32_t guess[3])
{
    static const float none[3] = { 0, 0, 0 };
    float rest[3], moved[3];
    memcpy(rest, f->mesh.directions + 3u * (size_t)v, sizeof rest);
    memcpy(moved, f->mesh.moved + 3u * (size_t)(f->mesh.summed == 2 ? f->mesh.twins[v] : v), sizeof moved);
    for (uint32_t i = 0; i < 3u; i++) moved[i] += rest[i];
    noh_normalize3(rest, none);
    noh_normalize3(moved, none);
    for (uint32_t i = 0; i < 3u; i++) {
        guess[i] = t->scale[1] > 0.0f ? to_int((moved[i] - rest[i]) / t->scale[1], 8388608.0f) : 0;
    }
}

/* ---- a delta texel ---- */

typedef struct around {
    noh_wire_near near;
    uint32_t slots[NOH_WIRE_TERMS], references[NOH_WIRE_TERMS]; /* of what it is predicted from */
    uint32_t slot, reference, twin; /* of the vertex; of one at its place that came before */
    int still;                      /* nothing near by is moved */
} around;

static around around_of(const noh_wire_filter *f, uint32_t v)
{
    around r;
    r.near = noh_wire_near_of(f, v);
    r.still = 1;
    for (uint32_t k = 0; k < r.near.count; k++) {
        r.slots[k] = slot_of(f, f->mesh.slots, r.near.vertex[k]);
        r.references[k] = slot_of(f, f->mesh.reference, r.near.vertex[k]);
        r.still &= r.slots[k] == NOH_NONE;
    }
    r.slot = slot_of(f, f->mesh.slots, v);
    r.reference = slot_of(f, f->mesh.reference, v);
    r.twin = f->mesh.twins[v] == v ? NOH_NONE : slot_of(f, f->mesh.slots, f->mesh.twins[v]);
    return r;
}

static int32_t reference_value(const noh_wire_filter *f, const target *t, const target *like, uint32_t slot,
                               uint32_t kind, uint32_t axis)
{
    if (slot == NOH_NONE || like->index == t->index || !(t->scale[kind] > 0.0f)) return 0;
    return to_int((float)value_at(f, like, slot, kind, axis) * (like->scale[kind] / t->scale[kind]), 8388608.0f);
}

static int32_t difference(const noh_wire_filter *f, const target *t, const target *like, const around *r, uint32_t i,
                          uint32_t kind, uint32_t axis)
{
    const int32_t value = r->slots[i] == NOH_NONE ? 0 : value_at(f, t, r->slots[i], kind, axis);
    return value - reference_value(f, t, like, r->references[i], kind, axis);
}

/* Context of a texel: 0 next to moved texels, 1 next to unmoved texels, 2 with a twin at the same place. */
static uint32_t context_of(const around *r)
{
    if (r->twin != NOH_NONE) return 2u;
    return r->still ? 1u : 0u;
}

static void guess_values(const noh_wire_filter *f, const target *t, const target *like, const around *r, uint32_t v,
                         uint32_t kind, int32_t guess[3])
{
    const int has_reference = like->index != t->index && r->reference != NOH_NONE;
    if (r->twin != NOH_NONE) {
        for (uint32_t i = 0; i < 3u; i++) guess[i] = value_at(f, t, r->twin, kind, i);
        return;
    }
    if (kind == 1u && !has_reference && f->section.mode) {
        guess_normal(f, t, v, guess);
        return;
    }
    for (uint32_t i = 0; i < 3u; i++) {
        int64_t sum = 0;
        for (uint32_t k = 0; k < r->near.count; k++) {
            sum += (int64_t)r->near.sign[k] * difference(f, t, like, r, k, kind, i);
        }
        guess[i] = noh_wire_mean(&r->near, sum) + reference_value(f, t, like, r->reference, kind, i);
    }
}

static void code_texel(noh_wire_filter *f, const target *t, uint32_t slot, uint32_t kind, uint32_t context,
                       const int32_t guess[3])
{
    const uint32_t mask = t->bits[kind] ? 0xffffffffu >> (32u - t->bits[kind]) : 0u;
    uint32_t before = 0;
    for (uint32_t i = 0; i < 3u && t->bits[kind]; i++) {
        const uint32_t word = noh_wire_load(f, word_at(f, slot, i));
        const int32_t value = signed_bits(word >> t->shift[kind], t->bits[kind]);
        const uint32_t model = MODEL_KIND * kind + 32u * i + (context ? 8u + 8u * context : before > 2u ? 8u : 0u);
        const int32_t residual = noh_wire_residual(f, model, noh_wire_activity(f, 3u * kind + i),
                                                   signed_bits((uint32_t)value - (uint32_t)guess[i], t->bits[kind]));
        if (context != 2u) noh_wire_note(f, 3u * kind + i, residual);
        before = noh_wire_magnitude(residual);
        noh_wire_store(f, word_at(f, slot, i),
                       (word & ~(mask << t->shift[kind])) | (((uint32_t)guess[i] + (uint32_t)residual) & mask)
                                                                << t->shift[kind]);
    }
}

/* ---- a target ---- */

/* The vertices that the target moves, in the order of the triangles. A texel that several share is coded once. */
static int code_vertices(noh_wire_filter *f, const target *t, const target *like, uint32_t kind)
{
    for (; f->cursor[1] < f->mesh.order_count; f->cursor[1]++) {
        const uint32_t v = f->mesh.order[f->cursor[1]], texel = noh_wire_texel(f, v);
        uint32_t *slot = texel == NOH_NONE ? NULL : &f->mesh.slots[texel];
        around r;
        int32_t guess[3];
        if (!slot || !*slot || (*slot & (CODED << kind))) continue;
        if (!noh_wire_item(&f->coder)) return 0;
        r = around_of(f, v);
        guess_values(f, t, like, &r, v, kind, guess);
        code_texel(f, t, r.slot, kind, context_of(&r), guess);
        *slot |= CODED << kind;
    }
    f->cursor[1] = 0;
    return 1;
}

/* What is left of its rectangles: texels that no triangle comes to, and what lies under another rectangle. */
static int code_rest(noh_wire_filter *f, const target *t, uint32_t kind)
{
    static const int32_t zeros[3] = { 0, 0, 0 };
    const noh_mesh_header *h = &f->mesh.header;
    uint32_t slot = t->t.first_texel, n = 0;
    for (uint32_t i = 0; i < t->t.rect_count && t->t.first_rect + i < h->rect_count; i++) {
        noh_rect r;
        memcpy(&r, f->image + f->mesh.chunk + h->rects_offset + ((size_t)t->t.first_rect + i) * sizeof r, sizeof r);
        for (uint32_t k = 0; k < (uint32_t)r.w * r.h && slot < h->texel_count; k++, slot++, n++) {
            const uint32_t texel = ((r.y + k / r.w) << h->morph_width_log2) + r.x + k % r.w;
            if (n < f->cursor[1]) continue;
            if (texel >= h->touched_count ||
                (f->mesh.slots[texel] | ALL_CODED) != ((slot + 1u) << SLOT_SHIFT | ALL_CODED) ||
                !(f->mesh.slots[texel] & (CODED << kind))) {
                if (!noh_wire_item(&f->coder)) return 0;
                code_texel(f, t, slot, kind, 1u, zeros);
            }
            f->cursor[1]++;
        }
    }
    f->cursor[1] = 0;
    return 1;
}

/* The next target of the plan: its number, and the number of the target that it is like. */
static int begin_target(noh_wire_filter *f)
{
    const uint32_t count = f->mesh.header.target_count;
    uint32_t plan = f->plan ? f->plan[f->cursor[0]] : 0u, now, like;
    if (!noh_wire_item(&f->coder)) return 0;
    now = noh_wire_bits(&f->coder, NOH_WIRE_PLAN_TARGET(plan), 10u);
    like = noh_wire_bits(&f->coder, NOH_WIRE_PLAN_LIKE(plan), 11u);
    f->mesh.kinds = noh_wire_bits(&f->coder, NOH_WIRE_PLAN_KINDS(plan), KINDS);
    now = now < count ? now : count - 1u;
    like = like && like <= count ? like - 1u : now;
    f->cursor[3] = now | like << 16;
    f->cursor[2] = 1u;
    f->cursor[1] = 0;
    {
        const target t = target_at(f, now), l = target_at(f, like);
        memset(f->mesh.slots, 0, 4u * (size_t)f->mesh.header.touched_count);
        memset(f->mesh.reference, 0, 4u * (size_t)f->mesh.header.touched_count);
        number_slots(f, &t, f->mesh.slots);
        if (like != now) number_slots(f, &l, f->mesh.reference);
    }
    return 1;
}

static int code_target(noh_wire_filter *f)
{
    const target t = target_at(f, f->cursor[3] & 0xffffu), like = target_at(f, f->cursor[3] >> 16);
    while (f->cursor[2] <= 2u * KINDS) {
        const uint32_t kind = (f->cursor[2] - 1u) / 2u, rest = (f->cursor[2] - 1u) % 2u;
        if (f->mesh.kinds >> kind & 1u) {
            if (kind == 1u && !rest && !f->cursor[1] && f->section.mode) move_triangles(f, &t);
            if (!(rest ? code_rest(f, &t, kind) : code_vertices(f, &t, &like, kind))) return 0;
        }
        f->cursor[2]++;
    }
    f->cursor[2] = 0;
    return 1;
}

/* mode 0: normals as positions; 1, 2: relative to the triangles' normals, summed by vertex or by place */
int noh_wire_run_deltas(noh_wire_filter *f)
{
    while (f->cursor[0] < f->mesh.header.target_count) {
        if (!f->cursor[2] && !begin_target(f)) return 0;
        if (!code_target(f)) return 0;
        f->cursor[0]++;
    }
    return 1;
}
