/* Tests of the morph encoder (tools/convert/morph/) on meshes made here.
 * cross: slow, encodes meshes */
#include "support/support.h"

#include <math.h>
#include <string.h>

#include "convert/morph/morph_encode.h"

#define AXES 3u
#define ERROR_UM 10.0f

/* ---- meshes ---- */

typedef struct rng {
    uint32_t state;
} rng;

static uint32_t next(rng *r)
{
    r->state = r->state * 1664525u + 1013904223u;
    return r->state >> 8;
}

static float uniform(rng *r, float low, float high)
{
    return low + (high - low) * (float)next(r) / 16777216.0f;
}

static float *zeros(uint32_t count)
{
    float *p = calloc(count ? count : 1u, sizeof *p);
    assert_non_null(p);
    return p;
}

static model_mesh *mesh_new(uint32_t vertices, uint32_t targets, int tangents)
{
    model_mesh *m = calloc(1, sizeof *m);
    assert_non_null(m);
    m->vertex_count = vertices;
    m->target_count = targets;
    m->position = zeros(vertices * AXES);
    m->normal = zeros(vertices * AXES);
    m->targets = calloc(targets ? targets : 1u, sizeof *m->targets);
    assert_non_null(m->targets);
    for (uint32_t t = 0; t < targets; t++) {
        m->targets[t].position = zeros(vertices * AXES);
        m->targets[t].normal = zeros(vertices * AXES);
        if (tangents) m->targets[t].tangent = zeros(vertices * AXES);
    }
    return m;
}

static void mesh_free(model_mesh *m)
{
    for (uint32_t t = 0; t < m->target_count; t++) {
        free(m->targets[t].position);
        free(m->targets[t].normal);
        free(m->targets[t].tangent);
    }
    free(m->targets);
    free(m->position);
    free(m->normal);
    free(m);
}

/* A sheet of 0.2 m with bumps: discs of random centre and radius, deltas that fade to their rims. */
static model_mesh *bumpy_sheet(uint32_t side, uint32_t targets, int tangents, float size, uint32_t seed)
{
    model_mesh *m = mesh_new(side * side, targets, tangents);
    rng r = { seed };
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        m->position[v * AXES] = 0.2f * (float)(v % side) / (float)side;
        m->position[v * AXES + 1u] = 0.2f * (float)(v / side) / (float)side;
    }
    for (uint32_t t = 0; t < targets; t++) {
        const float cx = uniform(&r, 0.0f, 0.2f), cy = uniform(&r, 0.0f, 0.2f), radius = uniform(&r, 0.02f, 0.08f);
        for (uint32_t v = 0; v < m->vertex_count; v++) {
            const float x = m->position[v * AXES] - cx, y = m->position[v * AXES + 1u] - cy;
            const float d = 1.0f - (x * x + y * y) / (radius * radius);
            if (d <= 0.0f) continue;
            for (uint32_t a = 0; a < AXES; a++) {
                m->targets[t].position[v * AXES + a] = size * d * uniform(&r, -1.0f, 1.0f);
                m->targets[t].normal[v * AXES + a] = d * uniform(&r, -1.0f, 1.0f);
                if (tangents) m->targets[t].tangent[v * AXES + a] = d * uniform(&r, -1.0f, 1.0f);
            }
        }
    }
    return m;
}

static morph_encoding *encode(const model_mesh *m, const morph_options *options)
{
    morph_encoding *e = NULL;
    model_error error;
    assert_int_equal(morph_encode(m, options, &e, &error), 0);
    assert_non_null(e);
    return e;
}

/* ---- what every encoding must be ---- */

static int32_t sign_extend(uint32_t word, uint32_t shift, uint32_t bits)
{
    const int64_t value = (int64_t)(word >> shift & (((uint64_t)1 << bits) - 1u));
    return (int32_t)(value >= (int64_t)1 << (bits - 1u) ? value - ((int64_t)1 << bits) : value);
}

typedef struct decoded {
    float *position, *normal, *tangent; /* [vertex_count][3], old vertex order */
    uint8_t *covered, *moves;           /* [vertex_count] */
} decoded;

static decoded decoded_new(uint32_t vertices)
{
    decoded d = { zeros(vertices * AXES), zeros(vertices * AXES), zeros(vertices * AXES), NULL, NULL };
    d.covered = calloc(vertices ? vertices : 1u, 1);
    d.moves = calloc(vertices ? vertices : 1u, 1);
    assert_true(d.covered && d.moves);
    return d;
}

static void decoded_free(decoded *d)
{
    free(d->position);
    free(d->normal);
    free(d->tangent);
    free(d->covered);
    free(d->moves);
}

static void decode_texel(const morph_target *q, const uint32_t words[3], uint32_t vertex, decoded *d)
{
    const uint32_t p = q->position_bits, n = q->normal_bits, t = q->tangent_bits;
    for (uint32_t a = 0; a < AXES; a++) {
        const size_t i = (size_t)vertex * AXES + a;
        d->position[i] = (float)sign_extend(words[a], 32u - p, p) * q->position_scale;
        d->normal[i] = (float)sign_extend(words[a], 32u - p - n, n) * q->normal_scale;
        d->tangent[i] = (float)sign_extend(words[a], 32u - p - n - t, t) * q->tangent_scale;
        if (p + n + t < 32u) assert_int_equal(words[a] << (p + n + t), 0);
        if (words[a]) d->moves[vertex] = 1;
    }
}

static void decode_target(const morph_encoding *e, uint32_t t, decoded *d)
{
    const morph_target *q = &e->targets[t];
    const uint32_t width = 1u << e->width_log2;
    uint32_t at = q->first_texel;
    for (uint32_t r = q->first_rect; r < q->first_rect + q->rect_count; r++) {
        const morph_rect *b = &e->rects[r];
        assert_true(b->w > 0 && b->h > 0);
        assert_true((uint32_t)b->x + b->w <= width && (uint32_t)b->y + b->h <= e->height);
        for (uint32_t y = b->y; y < (uint32_t)b->y + b->h; y++)
            for (uint32_t x = b->x; x < (uint32_t)b->x + b->w; x++, at++) {
                const uint32_t v = y * width + x, *words = e->texels + (size_t)at * AXES;
                if (v >= e->touched_count) {
                    assert_true(!words[0] && !words[1] && !words[2]);
                    continue;
                }
                assert_int_equal(d->covered[e->order[v]], 0); /* disjoint */
                d->covered[e->order[v]] = 1;
                decode_texel(q, words, e->order[v], d);
            }
    }
    assert_int_equal(at, q->first_texel + q->texel_count);
}

static double source_value(const float *p, size_t i)
{
    return p ? (double)p[i] : 0.0;
}

static void check_errors(const model_mesh *m, const morph_target *q, const model_target *s, const decoded *d)
{
    double position = 0.0, normal = 0.0, tangent = 0.0, farthest = 0.0;
    uint32_t moves = 0;
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        double sum = 0.0, moved = 0.0;
        for (uint32_t a = 0; a < AXES; a++) {
            const size_t i = (size_t)v * AXES + a;
            const double e = (double)d->position[i] - source_value(s->position, i);
            sum += e * e;
            moved += source_value(s->position, i) * source_value(s->position, i);
            normal = fmax(normal, fabs((double)d->normal[i] - source_value(s->normal, i)));
            tangent = fmax(tangent, fabs((double)d->tangent[i] - source_value(s->tangent, i)));
        }
        position = fmax(position, sqrt(sum));
        farthest = fmax(farthest, sqrt(moved));
        moves += d->moves[v];
    }
    assert_int_equal(moves, q->pair_count);
    assert_true(position <= (double)q->position_error && (double)q->position_error <= position * 1.000001 + 1e-40);
    assert_true(farthest <= (double)q->radius && (double)q->radius <= farthest * 1.000001 + 1e-40);
    assert_true(normal <= (double)q->normal_error && (double)q->normal_error <= normal * 1.000001 + 1e-40);
    assert_true(tangent <= (double)q->tangent_error && (double)q->tangent_error <= tangent * 1.000001 + 1e-40);
}

static void check_order(const morph_encoding *e, const uint8_t *touched)
{
    uint8_t *seen = calloc(e->vertex_count ? e->vertex_count : 1u, 1);
    const uint64_t width = (uint64_t)1 << e->width_log2;
    assert_non_null(seen);
    for (uint32_t v = 0; v < e->vertex_count; v++) {
        assert_true(e->order[v] < e->vertex_count);
        assert_int_equal(seen[e->order[v]], 0);
        seen[e->order[v]] = 1;
        assert_int_equal(touched[e->order[v]], v < e->touched_count);
        if (v > e->touched_count) assert_true(e->order[v - 1u] < e->order[v]);
    }
    assert_in_range(e->width_log2, 4, 10);
    assert_int_equal(e->height, (e->touched_count + width - 1u) / width);
    free(seen);
}

/* Decodes everything and holds it against the source. */
static void check(const model_mesh *m, const morph_encoding *e)
{
    uint8_t *touched = calloc(m->vertex_count ? m->vertex_count : 1u, 1);
    uint32_t rects = 0, texels = 0, pairs = 0, source = 0;
    assert_non_null(touched);
    assert_int_equal(e->vertex_count, m->vertex_count);
    assert_int_equal(e->target_count, m->target_count);
    for (uint32_t t = 0; t < m->target_count; t++) {
        const morph_target *q = &e->targets[t];
        decoded d = decoded_new(m->vertex_count);
        assert_int_equal(q->first_rect, rects);
        assert_int_equal(q->first_texel, texels);
        assert_true(q->position_bits + q->normal_bits + q->tangent_bits <= 32);
        assert_in_range(q->position_bits, 1, 24);
        assert_in_range(q->normal_bits, 1, 24);
        assert_in_range(q->tangent_bits, 1, 24);
        decode_target(e, t, &d);
        check_errors(m, q, &m->targets[t], &d);
        for (uint32_t v = 0; v < m->vertex_count; v++) touched[v] |= d.moves[v];
        rects += q->rect_count;
        texels += q->texel_count;
        pairs += q->pair_count;
        source += q->source_pairs;
        decoded_free(&d);
    }
    assert_int_equal(rects, e->rect_count);
    assert_int_equal(texels, e->texel_count);
    assert_int_equal(pairs, e->pair_count);
    assert_int_equal(source, e->source_pairs);
    check_order(e, touched);
    free(touched);
}

static int same(const morph_encoding *a, const morph_encoding *b)
{
    return a->touched_count == b->touched_count && a->rect_count == b->rect_count && a->texel_count == b->texel_count &&
           !memcmp(a->order, b->order, a->vertex_count * sizeof *a->order) &&
           !memcmp(a->rects, b->rects, a->rect_count * sizeof *a->rects) &&
           !memcmp(a->texels, b->texels, a->texel_count * AXES * sizeof *a->texels) &&
           !memcmp(a->targets, b->targets, a->target_count * sizeof *a->targets);
}

/* ---- tests ---- */

static void a_sheet_is_few_rectangles(void **state)
{
    (void)state;
    for (int tangents = 0; tangents < 2; tangents++) {
        model_mesh *m = bumpy_sheet(40, 70, tangents, 0.01f, 7); /* 70: more than one word of bits */
        morph_encoding *e = encode(m, NULL);
        check(m, e);
        for (uint32_t t = 0; t < e->target_count; t++) {
            assert_true(e->targets[t].position_error <= ERROR_UM * 1e-6f);
            assert_true(e->targets[t].normal_bits >= 8);
            if (tangents)
                assert_true(e->targets[t].tangent_bits >= 6);
            else
                assert_true(e->targets[t].tangent_bits == 1 && e->targets[t].tangent_scale == 0.0f);
        }
        assert_true(e->texel_count * 4u <= e->pair_count * 5u);
        assert_true(e->texels_one_rect >= e->pair_count);
        morph_encoding_free(e);
        mesh_free(m);
    }
}

/* One bit less must not have met the error: the bits are the smallest. */
static void bits_are_as_few_as_suffice(void **state)
{
    model_mesh *m = bumpy_sheet(24, 6, 1, 0.01f, 3);
    float last = 0.0f;
    uint32_t last_bits = 32;
    (void)state;
    for (float um = 1.0f; um < 2000.0f; um *= 3.0f) {
        const morph_options options = { .error_um = um };
        morph_encoding *e = encode(m, &options);
        check(m, e);
        assert_true(e->targets[0].position_error <= um * 1e-6f);
        assert_true(e->targets[0].position_bits <= last_bits && e->targets[0].position_error >= last);
        /* halving the step halves the error, so one bit less would be beyond half of what is asked */
        if (e->targets[0].position_bits > 2) assert_true(e->targets[0].position_error > um * 0.3e-6f);
        last_bits = e->targets[0].position_bits;
        last = e->targets[0].position_error;
        morph_encoding_free(e);
    }
    mesh_free(m);
}

static void an_error_too_small_takes_all_bits(void **state)
{
    const morph_options options = { .error_um = 0.001f };
    model_mesh *m = bumpy_sheet(24, 6, 1, 10.0f, 3);
    morph_encoding *e = encode(m, &options);
    (void)state;
    check(m, e); /* the certified error tells the truth */
    assert_int_equal(e->targets[0].position_bits, 18);
    assert_int_equal(e->targets[0].normal_bits, 8);
    assert_int_equal(e->targets[0].tangent_bits, 6);
    assert_true(e->targets[0].position_error > 1e-9f);
    morph_encoding_free(e);
    mesh_free(m);
}

static void rectangles_stay_below_their_limit(void **state)
{
    static const uint32_t limits[] = { 1, 2, 3, 8, 100 };
    model_mesh *m = bumpy_sheet(40, 20, 0, 0.01f, 11);
    (void)state;
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
        const morph_options options = { .rects = limits[i] };
        morph_encoding *e = encode(m, &options);
        check(m, e);
        for (uint32_t t = 0; t < e->target_count; t++) assert_true(e->targets[t].rect_count <= limits[i]);
        if (limits[i] == 1)
            for (uint32_t t = 0; t < e->target_count; t++)
                assert_int_equal(e->targets[t].rect_count, e->targets[t].pair_count > 0);
        morph_encoding_free(e);
    }
    mesh_free(m);
}

/* Noise needs thousands of rectangles; a limit still holds. */
static void noise_is_encoded_within_its_limits(void **state)
{
    static const uint32_t limits[] = { 0, 5 };
    model_mesh *m;
    rng r = { 5 };
    (void)state;
    test_skip_emulated("the encoder");
    m = mesh_new(20000, 3, 0);
    for (uint32_t t = 0; t < 3u; t++)
        for (uint32_t v = 0; v < m->vertex_count; v++)
            if (next(&r) % 2u) m->targets[t].position[v * AXES + next(&r) % AXES] = uniform(&r, -0.1f, 0.1f);
    for (size_t i = 0; i < 2u; i++) {
        const morph_options options = { .rects = limits[i] };
        morph_encoding *e = encode(m, &options);
        check(m, e);
        for (uint32_t t = 0; t < 3u && limits[i]; t++) assert_true(e->targets[t].rect_count <= limits[i]);
        morph_encoding_free(e);
    }
    mesh_free(m);
}

static void empty_meshes_and_targets_are_encoded(void **state)
{
    static const uint32_t sizes[][2] = { { 0, 0 }, { 0, 3 }, { 10, 0 }, { 10, 4 }, { 1, 1 } };
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        model_mesh *m = mesh_new(sizes[i][0], sizes[i][1], 1);
        morph_encoding *e = encode(m, NULL);
        check(m, e);
        assert_int_equal(e->touched_count, 0);
        assert_int_equal(e->texel_count, 0);
        assert_int_equal(e->rect_count, 0);
        assert_int_equal(e->source_pairs, 0);
        for (uint32_t t = 0; t < e->target_count; t++) {
            assert_true(e->targets[t].position_scale == 0.0f && e->targets[t].normal_scale == 0.0f);
            assert_true(e->targets[t].radius == 0.0f);
        }
        morph_encoding_free(e);
        mesh_free(m);
    }
}

/* Every size around the strip's and the row's ends. */
static void a_target_may_move_every_vertex(void **state)
{
    (void)state;
    for (uint32_t vertices = 1; vertices < 300u; vertices += vertices < 70u ? 1u : 37u) {
        model_mesh *m = mesh_new(vertices, 2, 1);
        morph_encoding *e;
        for (uint32_t v = 0; v < vertices; v++) m->targets[1].position[v * AXES + 2u] = 0.001f * (float)(v + 1u);
        e = encode(m, NULL);
        check(m, e);
        assert_int_equal(e->touched_count, vertices);
        assert_int_equal(e->targets[0].rect_count, 0);
        assert_int_equal(e->targets[1].pair_count, vertices);
        assert_true(e->texel_count < vertices + 16u);
        morph_encoding_free(e);
        mesh_free(m);
    }
}

static void scales_of_any_size_are_kept(void **state)
{
    static const float sizes[] = { 1e-42f, 1e-37f, 1e-20f, 1e-7f, 1.0f, 1e6f, 1e11f };
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        model_mesh *m = bumpy_sheet(16, 4, 1, sizes[i], 9);
        morph_encoding *e = encode(m, NULL);
        check(m, e);
        for (uint32_t t = 0; t < 4u; t++) assert_true(isfinite(e->targets[t].position_scale));
        morph_encoding_free(e);
        mesh_free(m);
    }
}

/* Random targets on few vertices: shapes that no sheet gives. */
static void small_random_meshes_are_encoded(void **state)
{
    (void)state;
    for (uint32_t seed = 0; seed < 60u; seed++) {
        rng r = { seed * 7919u + 1u };
        const uint32_t vertices = 1u + next(&r) % 120u, targets = 1u + next(&r) % 9u, share = 2u + next(&r) % 12u;
        const morph_options options = {
            uniform(&r, 1.0f, 500.0f), next(&r) % 4u, uniform(&r, 0.5f, 20.0f), NULL, 0, NULL
        };
        model_mesh *m = mesh_new(vertices, targets, (int)(seed & 1u));
        morph_encoding *e;
        for (uint32_t t = 0; t < targets; t++)
            for (uint32_t i = 0; i < vertices * AXES; i++) {
                if (next(&r) % share == 0u) m->targets[t].position[i] = uniform(&r, -0.02f, 0.02f);
                if (next(&r) % share == 0u) m->targets[t].normal[i] = uniform(&r, -0.01f, 0.01f);
                if (m->targets[t].tangent && next(&r) % share == 0u)
                    m->targets[t].tangent[i] = uniform(&r, -2.0f, 2.0f);
            }
        e = encode(m, &options);
        check(m, e);
        morph_encoding_free(e);
        mesh_free(m);
    }
}

static void encoding_is_deterministic(void **state)
{
    model_mesh *m = bumpy_sheet(32, 30, 1, 0.01f, 21);
    morph_encoding *a = encode(m, NULL), *b = encode(m, NULL);
    (void)state;
    assert_true(same(a, b));
    morph_encoding_free(a);
    morph_encoding_free(b);
    mesh_free(m);
}

/* Position 0.0635 m in steps of 0.5 mm takes 8 bits; 24 are left, 12 for the normal, 12 for the tangent. */
static void bits_are_laid_out_as_documented(void **state)
{
    const morph_options options = { .error_um = 433.1f }; /* half of the diagonal of a 0.5 mm step, a little more */
    model_mesh *m = mesh_new(3, 1, 1);
    model_target *t = &m->targets[0];
    morph_encoding *e;
    (void)state;
    t->position[0] = 0.0635f;                                             /* 127 */
    t->position[1] = -0.0635f;                                            /* -127 */
    t->position[2] = -0.0005f;                                            /* -1 */
    t->position[3] = t->position[4] = t->position[5] = 0.00025f * 0.999f; /* all but half a step on all axes */
    t->normal[3] = 1.0f;
    t->normal[0] = -1.0f;  /* -2047 */
    t->tangent[1] = 0.5f;  /* 2047 */
    t->tangent[2] = -0.5f; /* -2047 */
    e = encode(m, &options);
    check(m, e);
    assert_int_equal(e->targets[0].position_bits, 8);
    assert_int_equal(e->targets[0].normal_bits, 12);
    assert_int_equal(e->targets[0].tangent_bits, 12);
    assert_int_equal(e->touched_count, 2);
    for (uint32_t v = 0; v < 2u; v++) {
        const uint32_t *w = e->texels + (size_t)v * AXES;
        if (e->order[v] != 0u) continue;
        assert_int_equal(w[0], 0x7f801000u);
        assert_int_equal(w[1], 0x810007ffu);
        assert_int_equal(w[2], 0xff000801u);
    }
    morph_encoding_free(e);
    mesh_free(m);
}

/* Dropped: position below half a step and directions below 1/512. The source's pairs count them. */
static void negligible_pairs_are_dropped(void **state)
{
    model_mesh *m = mesh_new(5, 1, 1);
    model_target *t = &m->targets[0];
    morph_encoding *e;
    (void)state;
    m->position[0] = 1.0f;
    t->position[0] = 0.02f;
    t->normal[1] = 1.0f;
    t->position[1u * AXES] = 0.000002f; /* above 1e-6 of the diagonal, under half a step */
    t->normal[2u * AXES] = 0.0019f;     /* under 1/512 */
    t->normal[3u * AXES] = 0.0030f;     /* above */
    t->tangent[4u * AXES] = 0.9f;
    e = encode(m, NULL);
    check(m, e);
    assert_int_equal(e->source_pairs, 5);
    assert_int_equal(e->pair_count, 3);
    assert_true(e->targets[0].normal_error >= 0.0019f && e->targets[0].normal_error < 1.0f / 512.0f);
    morph_encoding_free(e);
    mesh_free(m);
}

static void bad_input_is_refused(void **state)
{
    static const float bad[] = { INFINITY, -INFINITY, NAN, 2e30f };
    model_mesh *m = mesh_new(4, 2, 1);
    morph_encoding *e;
    model_error error;
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        m->targets[1].normal[2u * AXES + 1u] = bad[i];
        assert_int_equal(morph_encode(m, NULL, &e, &error), 1);
        assert_null(e);
        assert_non_null(strstr(error.where, "target 1"));
        assert_non_null(strstr(error.where, "vertex 2"));
    }
    m->targets[1].normal[2u * AXES + 1u] = 0.0f;
    for (size_t i = 0; i < 2u; i++) {
        const morph_options options = { i ? 1.0f : -1.0f, 0, i ? NAN : 1.0f, NULL, 0, NULL };
        assert_int_equal(morph_encode(m, &options, &e, &error), 1);
        assert_null(e);
    }
    mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sheet_is_few_rectangles),
        cmocka_unit_test(bits_are_as_few_as_suffice),
        cmocka_unit_test(an_error_too_small_takes_all_bits),
        cmocka_unit_test(rectangles_stay_below_their_limit),
        cmocka_unit_test(noise_is_encoded_within_its_limits),
        cmocka_unit_test(empty_meshes_and_targets_are_encoded),
        cmocka_unit_test(a_target_may_move_every_vertex),
        cmocka_unit_test(scales_of_any_size_are_kept),
        cmocka_unit_test(small_random_meshes_are_encoded),
        cmocka_unit_test(encoding_is_deterministic),
        cmocka_unit_test(bits_are_laid_out_as_documented),
        cmocka_unit_test(negligible_pairs_are_dropped),
        cmocka_unit_test(bad_input_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
