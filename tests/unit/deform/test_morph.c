/* Accumulation on the CPU: every instruction set gives the scalar bits; half floats follow their definition; vertices
 * agree with an evaluation in double precision. */
#include "support/support.h"
#include "deform/morph/morph_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef void (*accumulate_function)(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers);

/* ---- meshes of rectangles, made without the converter: any width, any bits ---- */

#define RECTS_MAX 12u
#define TARGETS 9u

typedef struct loose_mesh {
    noh_mesh mesh;
    noh_mesh_header header;
    noh_target targets[TARGETS];
    noh_rect rects[TARGETS * RECTS_MAX];
    uint32_t *texels;
} loose_mesh;

static uint32_t random_bits(test_random *r, uint32_t most)
{
    return 1u + test_random_below(r, most);
}

/* The largest delta is up to 1 then: sums stay within what a half can hold. */
static float random_scale(test_random *r, uint8_t bits)
{
    return test_random_float(r, 0.001f, 1.0f) / (float)(1u << (bits - 1u));
}

static void random_target(loose_mesh *m, noh_target *t, test_random *r)
{
    uint32_t left = 32;
    t->position_bits = (uint8_t)random_bits(r, 24);
    left -= t->position_bits;
    t->normal_bits = (uint8_t)random_bits(r, left - 1 < 24 ? left - 1 : 24);
    left -= t->normal_bits;
    t->tangent_bits = (uint8_t)random_bits(r, left < 24 ? left : 24);
    t->position_scale = random_scale(r, t->position_bits);
    t->normal_scale = random_scale(r, t->normal_bits);
    t->tangent_scale = random_scale(r, t->tangent_bits);
    t->first_rect = m->header.rect_count;
    t->first_texel = m->header.texel_count;
    t->rect_count = 1 + test_random_below(r, RECTS_MAX);
    for (uint32_t i = 0; i < t->rect_count; i++) {
        noh_rect *rect = &m->rects[m->header.rect_count++];
        rect->w = (uint16_t)(1 + test_random_below(r, 19)); /* runs of every length about a SIMD step */
        rect->h = (uint16_t)(1 + test_random_below(r, 3));
        rect->x = (uint16_t)test_random_below(r, (1u << m->header.morph_width_log2) - rect->w + 1u);
        rect->y = (uint16_t)test_random_below(r, m->header.morph_height - rect->h + 1u);
        t->texel_count += (uint32_t)rect->w * rect->h;
    }
    m->header.texel_count += t->texel_count;
}

static void random_loose(loose_mesh *m, test_random *r)
{
    memset(m, 0, sizeof *m);
    m->header.morph_width_log2 = 5;
    m->header.morph_height = 7;
    m->header.target_count = TARGETS;
    for (uint32_t t = 0; t < TARGETS; t++) {
        random_target(m, &m->targets[t], r);
    }
    m->texels = test_zeros(12u * (size_t)m->header.texel_count); /* exact: SIMD must not read past it */
    for (uint32_t i = 0; i < 3u * m->header.texel_count; i++) {
        m->texels[i] = test_random_u32(r);
    }
    m->mesh.header = &m->header;
    m->mesh.targets = m->targets;
    m->mesh.rects = m->rects;
    m->mesh.texels = m->texels;
}

static void random_loose_weights(test_random *r, float weights[TARGETS])
{
    test_random_weights(r, weights, TARGETS);
    weights[test_random_below(r, TARGETS)] = test_random_float(r, -40.0f, 40.0f);
}

/* Two layers have the bits of the first two of three, and the third is left alone. */
static void expect_two_layers(const noh_mesh *mesh, const float *weights, accumulate_function accumulate,
                              const noh_morph_layers *three)
{
    const size_t floats = noh_morph_layers_size(mesh) / 12u;
    noh_morph_layers two = test_layers(mesh);
    const float *third = two.tangent;
    two.tangent = NULL;
    accumulate(mesh, weights, &two);
    test_same_floats(two.position, three->position, 2u * floats, "two layers");
    for (size_t i = 0; i < floats; i++) {
        assert_true(third[i] == 0.0f);
    }
    free(two.position);
}

/* A layer that begins `offset` floats behind an alignment and ends with its memory, with something in it: what no target
 * moves keeps its bits, -0 too. */
static float *layer_at(size_t offset, size_t floats)
{
    float *memory = test_zeros((offset + floats) * sizeof *memory);
    for (size_t i = 0; i < offset + floats; i++) memory[i] = i % 3u ? 0.25f * (float)(i % 7u) : -0.0f;
    return memory;
}

static void expect_scalar_bits_at(const noh_mesh *mesh, const float *weights, accumulate_function accumulate,
                                  size_t offset)
{
    const size_t floats = noh_morph_layers_size(mesh) / 12u;
    float *expected[3], *got[3];
    for (size_t l = 0; l < 3; l++) {
        expected[l] = layer_at(offset, floats);
        got[l] = layer_at(offset, floats);
    }
    noh_morph_accumulate_scalar(
        mesh, weights, &(noh_morph_layers){ expected[0] + offset, expected[1] + offset, expected[2] + offset });
    accumulate(mesh, weights, &(noh_morph_layers){ got[0] + offset, got[1] + offset, got[2] + offset });
    for (size_t l = 0; l < 3; l++) {
        assert_memory_equal(got[l], expected[l], (offset + floats) * sizeof(float));
        free(expected[l]);
        free(got[l]);
    }
}

static void compare_with_scalar(accumulate_function accumulate, const char *name)
{
    test_random r = test_random_from(21);
    for (int round = 0; round < 300; round++) {
        loose_mesh m;
        float weights[TARGETS];
        noh_morph_layers expected, got;
        random_loose(&m, &r);
        random_loose_weights(&r, weights);
        expected = test_layers(&m.mesh);
        got = test_layers(&m.mesh);
        noh_morph_accumulate_scalar(&m.mesh, weights, &expected);
        accumulate(&m.mesh, weights, &got);
        test_same_floats(got.position, expected.position, noh_morph_layers_size(&m.mesh) / 4, name);
        expect_two_layers(&m.mesh, weights, accumulate, &expected);
        expect_scalar_bits_at(&m.mesh, weights, accumulate, (size_t)round % 8u);
        free(expected.position);
        free(got.position);
        free(m.texels);
    }
}

static void compiled_in_equals_scalar(void **state)
{
    (void)state;
    print_message("# compiled in: %s\n", noh_morph_simd());
    compare_with_scalar(noh_morph_accumulate, noh_morph_simd());
}

/* A kernel by its name; a test skips where there is none. */
static void named_equals_scalar(const char *name)
{
    noh_morph_kernel kernel;
    if (noh_morph_kernel_find(name, &kernel, NULL) != NOH_OK) {
        test_skip("this processor, or this build, has no such kernel");
    }
    assert_string_equal(kernel.name, name);
    compare_with_scalar(kernel.accumulate, name);
}

static void sse2_equals_scalar(void **state)
{
    (void)state;
    named_equals_scalar("sse2");
}

static void avx2_equals_scalar(void **state)
{
    (void)state;
    named_equals_scalar("avx2");
}

/* Of groups of texels that are asked for each has the bits of all. */
static void some_groups_equal_all(void **state)
{
    static const char *const names[] = { "scalar", "sse2", "avx2", "neon" };
    test_random r = test_random_from(27);
    (void)state;
    for (uint32_t round = 0; round < 200; round++) {
        const uint32_t texels = 7u << 5, group_count = texels / NOH_MORPH_GROUP;
        noh_morph_kernel kernel;
        uint8_t groups[(7u << 5) / NOH_MORPH_GROUP];
        loose_mesh m;
        float weights[TARGETS];
        noh_morph_layers all, some;
        if (noh_morph_kernel_find(names[round % 4u], &kernel, NULL) != NOH_OK) continue;
        random_loose(&m, &r);
        random_loose_weights(&r, weights);
        all = test_layers(&m.mesh);
        some = test_layers(&m.mesh);
        for (uint32_t g = 0; g < group_count; g++) groups[g] = test_random_below(&r, 4) == 0;
        noh_morph_accumulate_scalar(&m.mesh, weights, &all);
        kernel.accumulate_some(&m.mesh, weights, &some, groups);
        for (size_t l = 0; l < 3; l++) {
            for (size_t g = 0; g < group_count; g++) {
                const size_t at = 3u * (l * texels + g * NOH_MORPH_GROUP);
                if (groups[g])
                    test_same_floats(some.position + at, all.position + at, 3u * NOH_MORPH_GROUP, kernel.name);
            }
        }
        free(all.position);
        free(some.position);
        free(m.texels);
    }
}

/* What the processor has is found, and nothing else. */
static void the_fastest_kernel_is_found(void **state)
{
    noh_morph_kernel kernel = { "untouched", NULL, NULL, NULL };
    noh_error error;
    (void)state;
    assert_int_equal(noh_morph_kernel_find("no such", &kernel, &error), NOH_ERR_UNSUPPORTED);
    assert_string_equal(kernel.name, "untouched");
    assert_int_equal(noh_morph_kernel_find("scalar", &kernel, NULL), NOH_OK);
    assert_string_equal(kernel.name, "scalar");
    /* without SIMD the ordinary function is a scalar one too, and is found first */
    assert_true(kernel.accumulate == noh_morph_accumulate_scalar || strcmp(noh_morph_simd(), "scalar") == 0);
    assert_int_equal(noh_morph_kernel_find(NULL, &kernel, NULL), NOH_OK);
    print_message("# the fastest: %s\n", kernel.name);
    compare_with_scalar(kernel.accumulate, kernel.name);
#if defined(__x86_64__) && defined(__GNUC__) && !defined(NOH_PLAIN_C)
    assert_string_equal(kernel.name, __builtin_cpu_supports("avx2") ? "avx2" : "sse2");
#endif
}

/* ---- sums by definition ---- */

/* A field by arithmetic instead of shifts. */
static double field(uint32_t word, uint32_t before, uint32_t bits)
{
    double value = fmod(floor((double)word / ldexp(1.0, (int)(32u - before - bits))), ldexp(1.0, (int)bits));
    return value >= ldexp(1.0, (int)bits - 1) ? value - ldexp(1.0, (int)bits) : value;
}

typedef float (*rounding)(float);

static float keep_float(float value)
{
    return value;
}

/* To half by its definition: exact in double precision. */
static float to_half(float value, int toward_zero)
{
    int exponent;
    double place, steps;
    frexp(fabs((double)value), &exponent);
    place = ldexp(1.0, exponent - 11 > -24 ? exponent - 11 : -24);
    steps = fabs((double)value) / place;
    return (float)copysign(place * (toward_zero ? floor(steps) : rint(steps)), (double)value);
}

static float half_nearest(float value)
{
    return to_half(value, 0);
}

static float half_toward_zero(float value)
{
    return to_half(value, 1);
}

/* The reference's reference: texel by texel, target by target, one product and one sum, rounded as told. */
static void accumulate_plainly(const loose_mesh *m, const float *weights, float *layers, rounding round_added,
                               rounding round_sum)
{
    size_t texels = (size_t)m->header.morph_height << m->header.morph_width_log2;
    for (uint32_t t = 0; t < TARGETS; t++) {
        const noh_target *target = &m->targets[t];
        const uint8_t bits[3] = { target->position_bits, target->normal_bits, target->tangent_bits };
        const float scales[3] = { target->position_scale, target->normal_scale, target->tangent_scale };
        const uint32_t *word = m->texels + 3u * (size_t)target->first_texel;
        for (uint32_t i = 0; i < target->rect_count; i++) {
            const noh_rect *rect = &m->rects[target->first_rect + i];
            for (uint32_t texel = 0; texel < (uint32_t)rect->w * rect->h; texel++) {
                size_t at = (size_t)(rect->y + texel / rect->w) * 32u + rect->x + texel % rect->w;
                for (uint32_t axis = 0; axis < 3; axis++, word++) {
                    for (uint32_t l = 0, before = 0; l < 3 && weights[t] != 0.0f; before += bits[l++]) {
                        float *sum = &layers[(l * texels + at) * 3u + axis];
                        float factor = scales[l] * weights[t];
                        float delta = (float)field(*word, before, bits[l]) * factor;
                        *sum = round_sum(*sum + round_added(delta));
                    }
                }
            }
        }
    }
}

static void compare_with_definition(accumulate_function accumulate, rounding round_added, rounding round_sum,
                                    const char *name)
{
    test_random r = test_random_from(22);
    for (int round = 0; round < 60; round++) {
        loose_mesh m;
        float weights[TARGETS], *expected;
        noh_morph_layers got;
        random_loose(&m, &r);
        random_loose_weights(&r, weights);
        got = test_layers(&m.mesh);
        expected = test_zeros(noh_morph_layers_size(&m.mesh));
        accumulate(&m.mesh, weights, &got);
        accumulate_plainly(&m, weights, expected, round_added, round_sum);
        test_same_floats(got.position, expected, noh_morph_layers_size(&m.mesh) / 4, name);
        free(expected);
        free(got.position);
        free(m.texels);
    }
}

static void f16_nearest(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers)
{
    noh_morph_accumulate_f16(mesh, weights, NOH_HALF_RNE, layers);
}

static void f16_toward_zero(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers)
{
    noh_morph_accumulate_f16(mesh, weights, NOH_HALF_RTZ, layers);
}

static void f16_both(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers)
{
    noh_morph_accumulate_f16(mesh, weights, NOH_HALF_RTZ_RNE, layers);
}

static void scalar_follows_the_definition(void **state)
{
    (void)state;
    compare_with_definition(noh_morph_accumulate_scalar, keep_float, keep_float, "f32");
}

static void half_floats_to_nearest_follow_the_definition(void **state)
{
    (void)state;
    compare_with_definition(f16_nearest, keep_float, half_nearest, "f16 to nearest");
}

static void half_floats_toward_zero_follow_the_definition(void **state)
{
    (void)state;
    compare_with_definition(f16_toward_zero, keep_float, half_toward_zero, "f16 toward zero");
}

static void half_floats_rounded_twice_follow_the_definition(void **state)
{
    (void)state;
    compare_with_definition(f16_both, half_toward_zero, half_nearest, "f16 toward zero, then to nearest");
}

static void rounding_finished_layers_rounds_once(void **state)
{
    test_random r = test_random_from(23);
    loose_mesh m;
    float weights[TARGETS];
    noh_morph_layers exact, rounded;
    size_t count;
    (void)state;
    random_loose(&m, &r);
    random_loose_weights(&r, weights);
    count = noh_morph_layers_size(&m.mesh) / 4;
    exact = test_layers(&m.mesh);
    rounded = test_layers(&m.mesh);
    noh_morph_accumulate_scalar(&m.mesh, weights, &exact);
    noh_morph_accumulate_scalar(&m.mesh, weights, &rounded);
    noh_morph_round_f16(&m.mesh, NOH_HALF_RTZ, &rounded);
    for (size_t i = 0; i < count; i++) {
        exact.position[i] = half_toward_zero(exact.position[i]);
    }
    test_same_floats(rounded.position, exact.position, count, "rounded once");
    free(exact.position);
    free(rounded.position);
    free(m.texels);
}

/* 1e8 and 1 and -1e8: in floats only one order of these sums is 0. */
static void targets_are_summed_in_index_order(void **state)
{
    static const float values[3][3] = { { 1e8f, 1.0f, -1e8f }, { 1e8f, -1e8f, 1.0f }, { 1.0f, 1e8f, -1e8f } };
    static const float sums[3] = { 0.0f, 1.0f, 0.0f };
    (void)state;
    for (int order = 0; order < 3; order++) {
        test_random r = test_random_from(1);
        loose_mesh m;
        float weights[TARGETS] = { 0 };
        noh_morph_layers layers;
        random_loose(&m, &r);
        for (uint32_t t = 0; t < 3; t++) {
            noh_rect one = { 4, 3, 1, 1 };
            m.targets[t].rect_count = 1;
            m.targets[t].texel_count = 1;
            m.targets[t].position_bits = 4;
            m.targets[t].position_scale = 1.0f;
            m.rects[m.targets[t].first_rect] = one;
            m.texels[3u * (size_t)m.targets[t].first_texel] = 1u << 28; /* the integer 1 */
            weights[t] = values[order][t];
        }
        layers = test_layers(&m.mesh);
        noh_morph_accumulate(&m.mesh, weights, &layers);
        assert_true(layers.position[3 * (3 * 32 + 4)] == sums[order]);
        free(layers.position);
        free(m.texels);
    }
}

static void zero_weights_do_nothing(void **state)
{
    test_random r = test_random_from(2);
    const float zeros[TARGETS] = { 0.0f, -0.0f, 0.0f, -0.0f };
    loose_mesh m;
    noh_morph_layers layers;
    noh_morph_cost cost;
    (void)state;
    random_loose(&m, &r);
    layers = test_layers(&m.mesh);
    noh_morph_accumulate(&m.mesh, zeros, &layers);
    for (size_t i = 0; i < noh_morph_layers_size(&m.mesh) / 4; i++) {
        uint32_t bits;
        memcpy(&bits, layers.position + i, 4);
        assert_int_equal(bits, 0);
    }
    cost = noh_morph_cost_of(&m.mesh, zeros);
    assert_int_equal(cost.targets + cost.rects + cost.texels + cost.pairs, 0);
    free(layers.position);
    free(m.texels);
}

static void costs_are_those_of_the_active_targets(void **state)
{
    test_random r = test_random_from(3);
    float weights[TARGETS] = { 0.0f, 1.0f, 0.0f, -0.5f };
    loose_mesh m;
    noh_morph_cost cost;
    (void)state;
    random_loose(&m, &r);
    cost = noh_morph_cost_of(&m.mesh, weights);
    assert_int_equal(cost.targets, 2);
    assert_int_equal(cost.rects, m.targets[1].rect_count + m.targets[3].rect_count);
    assert_int_equal(cost.texels, m.targets[1].texel_count + m.targets[3].texel_count);
    free(m.texels);
}

/* C leaves the right shift of a negative word to the compiler; ours must keep the sign. */
static void shifts_of_negative_words_are_arithmetic(void **state)
{
    volatile int32_t minus = -1024;
    (void)state;
    assert_int_equal(minus >> 4, -64);
}

/* ---- whole vertices, through the converter ---- */

typedef struct packed {
    model *m;
    uint8_t *bytes;
    uint32_t *order;
    noh_pack pack;
    noh_mesh mesh;
} packed;

static void open_packed(packed *p, uint64_t seed)
{
    const test_model_desc desc = { 1, 12, 8, TEST_TANGENTS | TEST_UVS, seed };
    size_t count;
    p->m = test_model(&desc);
    p->bytes = test_pack_of(p->m, &count, &p->order);
    p->pack = test_open(p->bytes, count);
    p->mesh = test_mesh(&p->pack, 0);
}

static void close_packed(packed *p)
{
    model_free(p->m);
    free(p->bytes);
    free(p->order);
}

static double length3(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* What noh_morph_vertex must give, in double precision: base plus layers, made unit and orthogonal again. */
static void check_vertex(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t v)
{
    noh_vertex rest, got;
    double p[3], n[3], t[3], along = 0.0, n_length, t_length;
    noh_mesh_vertex(mesh, v, &rest);
    noh_morph_vertex(mesh, layers, v, &got);
    for (int i = 0; i < 3; i++) {
        int touched = v < mesh->header->touched_count;
        p[i] = (double)rest.position[i] + (touched ? (double)layers->position[3 * v + (uint32_t)i] : 0.0);
        n[i] = (double)rest.normal[i] + (touched ? (double)layers->normal[3 * v + (uint32_t)i] : 0.0);
        t[i] = (double)rest.tangent[i] + (touched ? (double)layers->tangent[3 * v + (uint32_t)i] : 0.0);
    }
    n_length = length3(n);
    for (int i = 0; i < 3; i++) {
        n[i] /= n_length;
        along += n[i] * t[i];
    }
    for (int i = 0; i < 3 && v < mesh->header->touched_count; i++) {
        t[i] -= along * n[i];
    }
    t_length = length3(t);
    for (int i = 0; i < 3; i++) {
        assert_true(fabs((double)got.position[i] - p[i]) <= 1e-6 * fmax(1.0, fabs(p[i])));
        assert_true(fabs((double)got.normal[i] - n[i]) <= 1e-6 / fmin(1.0, n_length));
        assert_true(fabs((double)got.tangent[i] - t[i] / t_length) <= 2e-6 / fmin(1.0, fmin(t_length, n_length)));
    }
    assert_true(got.tangent[3] == rest.tangent[3]);
}

static void accumulate_rne(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers)
{
    noh_morph_accumulate_f16(mesh, weights, NOH_HALF_RNE, layers);
}

static void accumulate_and_round(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers)
{
    noh_morph_accumulate(mesh, weights, layers);
    noh_morph_round_f16(mesh, NOH_HALF_RTZ, layers);
}

/* Without a layer of tangents: the same positions and normals in every format, and the bind pose's tangent made
 * perpendicular to the normal, as if no target moved it. */
static void tangents_can_be_left_out(void **state)
{
    test_random r = test_random_from(37);
    packed p;
    (void)state;
    open_packed(&p, 37);
    for (int round = 0; round < 10; round++) {
        noh_morph_layers three = test_layers(&p.mesh), two;
        const size_t floats = noh_morph_layers_size(&p.mesh) / 12u;
        float weights[8];
        for (uint32_t t = 0; t < 8; t++) {
            weights[t] = test_random_float(&r, -1.0f, 1.0f);
        }
        noh_morph_accumulate_scalar(&p.mesh, weights, &three);
        expect_two_layers(&p.mesh, weights, noh_morph_accumulate_scalar, &three);
        memset(three.position, 0, 12u * floats);
        accumulate_rne(&p.mesh, weights, &three);
        expect_two_layers(&p.mesh, weights, accumulate_rne, &three);
        memset(three.position, 0, 12u * floats);
        accumulate_and_round(&p.mesh, weights, &three);
        expect_two_layers(&p.mesh, weights, accumulate_and_round, &three);
        two = three;
        two.tangent = NULL;
        memset(three.tangent, 0, 4u * floats);
        for (uint32_t v = 0; v < p.mesh.header->vertex_count; v++) {
            noh_vertex got, want;
            noh_morph_vertex(&p.mesh, &two, v, &got);
            noh_morph_vertex(&p.mesh, &three, v, &want);
            assert_memory_equal(&got, &want, sizeof got);
        }
        free(three.position);
    }
    close_packed(&p);
}

static void vertices_agree_with_double_precision(void **state)
{
    test_random r = test_random_from(31);
    packed p;
    (void)state;
    open_packed(&p, 31);
    for (int round = 0; round < 40; round++) {
        noh_morph_layers layers = test_layers(&p.mesh);
        float weights[8];
        test_random_weights(&r, weights, 8);
        weights[round % 8] = round % 2 ? -3.0f : 5.0f;
        noh_morph_accumulate(&p.mesh, weights, &layers);
        for (uint32_t v = 0; v < p.mesh.header->vertex_count; v++) {
            check_vertex(&p.mesh, &layers, v);
        }
        free(layers.position);
    }
    close_packed(&p);
}

/* Against the source model itself, with the errors that the converter certified. */
static void positions_stay_within_the_certified_error(void **state)
{
    test_random r = test_random_from(32);
    packed p;
    double worst = 0.0;
    (void)state;
    open_packed(&p, 32);
    for (int round = 0; round < 40; round++) {
        noh_morph_layers layers = test_layers(&p.mesh);
        float weights[8];
        double bound = 1e-6; /* for the rounding of floats up to 12 */
        test_random_weights(&r, weights, 8);
        noh_morph_accumulate(&p.mesh, weights, &layers);
        for (uint32_t t = 0; t < 8; t++) {
            bound += fabs((double)weights[t]) * (double)p.mesh.targets[t].position_error;
        }
        for (uint32_t v = 0; v < p.mesh.header->vertex_count; v++) {
            noh_vertex got;
            double error[3];
            noh_morph_vertex(&p.mesh, &layers, v, &got);
            for (uint32_t i = 0; i < 3; i++) {
                size_t at = 3 * (size_t)p.order[v] + i;
                double exact = (double)p.m->meshes[0].position[at];
                for (uint32_t t = 0; t < 8; t++) {
                    exact += (double)weights[t] * (double)p.m->meshes[0].targets[t].position[at];
                }
                error[i] = (double)got.position[i] - exact;
            }
            assert_true(length3(error) <= bound);
            worst = fmax(worst, length3(error) / bound);
        }
        free(layers.position);
    }
    assert_true(worst > 0.05); /* the bound is approached: the test can fail */
    close_packed(&p);
}

static void certified_errors_are_within_the_error_asked_for(void **state)
{
    packed p;
    (void)state;
    open_packed(&p, 33);
    for (uint32_t t = 0; t < 8; t++) {
        assert_true(p.mesh.targets[t].position_error > 0.0f);
        assert_true(p.mesh.targets[t].position_error <= 10e-6f);
    }
    close_packed(&p);
}

/* A half accumulator stays within what the pack promises for weights up to 2. */
static void half_floats_stay_within_the_bound_of_the_pack(void **state)
{
    test_random r = test_random_from(34);
    packed p;
    (void)state;
    open_packed(&p, 34);
    assert_true(p.mesh.header->f16_position_bound > 0.0f && p.mesh.header->f16_position_bound < 0.01f);
    for (int round = 0; round < 60; round++) {
        static const noh_half_mode modes[] = { NOH_HALF_RTZ, NOH_HALF_RNE, NOH_HALF_RTZ_RNE };
        const noh_half_mode mode = modes[round % 3];
        const double more = mode == NOH_HALF_RTZ_RNE ? 1.5 : 1.0;
        noh_morph_layers exact = test_layers(&p.mesh), half = test_layers(&p.mesh);
        float weights[8];
        for (uint32_t t = 0; t < 8; t++) {
            weights[t] = round % 4 ? test_random_float(&r, -2.0f, 2.0f) : (test_random_u32(&r) & 1u ? 2.0f : -2.0f);
        }
        noh_morph_accumulate_scalar(&p.mesh, weights, &exact);
        noh_morph_accumulate_f16(&p.mesh, weights, mode, &half);
        for (uint32_t v = 0; v < p.mesh.header->touched_count; v++) {
            double error[3];
            for (uint32_t i = 0; i < 3; i++) {
                error[i] = (double)half.position[3 * v + i] - (double)exact.position[3 * v + i];
                assert_true(fabs((double)half.normal[3 * v + i] - (double)exact.normal[3 * v + i]) <=
                            more * (double)p.mesh.header->f16_direction_bound);
                assert_true(fabs((double)half.tangent[3 * v + i] - (double)exact.tangent[3 * v + i]) <=
                            more * (double)p.mesh.header->f16_direction_bound);
            }
            assert_true(length3(error) <= more * (double)p.mesh.header->f16_position_bound);
        }
        free(exact.position);
        free(half.position);
    }
    close_packed(&p);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(compiled_in_equals_scalar),
    cmocka_unit_test(sse2_equals_scalar),
    cmocka_unit_test(avx2_equals_scalar),
    cmocka_unit_test(some_groups_equal_all),
    cmocka_unit_test(the_fastest_kernel_is_found),
    cmocka_unit_test(scalar_follows_the_definition),
    cmocka_unit_test(half_floats_to_nearest_follow_the_definition),
    cmocka_unit_test(half_floats_toward_zero_follow_the_definition),
    cmocka_unit_test(half_floats_rounded_twice_follow_the_definition),
    cmocka_unit_test(rounding_finished_layers_rounds_once),
    cmocka_unit_test(targets_are_summed_in_index_order),
    cmocka_unit_test(zero_weights_do_nothing),
    cmocka_unit_test(costs_are_those_of_the_active_targets),
    cmocka_unit_test(shifts_of_negative_words_are_arithmetic),
    cmocka_unit_test(vertices_agree_with_double_precision),
    cmocka_unit_test(tangents_can_be_left_out),
    cmocka_unit_test(positions_stay_within_the_certified_error),
    cmocka_unit_test(certified_errors_are_within_the_error_asked_for),
    cmocka_unit_test(half_floats_stay_within_the_bound_of_the_pack),
};

TEST_MAIN(tests, NULL, NULL)
