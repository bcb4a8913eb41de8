/* Sampling of weight clips against glTF's formulas in double precision. */
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model_build.h"

#define WIDTH 5u
#define KEYS 4u

/* One pack for all tests: clips "linear", "step", "cubic" with random keys (support.c). */
static model *source;
static uint8_t *bytes;
static noh_pack pack;

static int set_up(void **state)
{
    const test_model_desc desc = { 1, 5, WIDTH, TEST_SCENE, 3 };
    size_t count;
    (void)state;
    source = test_model(&desc);
    bytes = test_pack_of(source, &count, NULL);
    pack = test_open(bytes, count);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    model_free(source);
    free(bytes);
    return 0;
}

static noh_weight_clip clip_at(uint32_t index)
{
    noh_weight_clip clip;
    assert_int_equal(noh_pack_weight_clip(&pack, index, &clip), NOH_OK);
    return clip;
}

/* glTF 2.0, appendix C, written down once more in double precision, from the source's keys. */
static double oracle(const model_channel *c, double time, uint32_t i)
{
    uint32_t k = 0, cubic = c->interpolation == MODEL_CUBICSPLINE, stride = c->width * (cubic ? 3u : 1u);
    const float *a, *b;
    double span, t;
    while (k + 1 < c->key_count && (double)c->times[k + 1] <= time) {
        k++;
    }
    a = c->values + k * stride;
    b = a + stride;
    if (time <= (double)c->times[0] || k + 1 == c->key_count || c->interpolation == MODEL_STEP) {
        return (double)a[i + (cubic ? c->width : 0u)];
    }
    span = (double)c->times[k + 1] - (double)c->times[k];
    t = (time - (double)c->times[k]) / span;
    if (!cubic) {
        return (double)a[i] + ((double)b[i] - (double)a[i]) * t;
    }
    return (2 * t * t * t - 3 * t * t + 1) * (double)a[c->width + i] + span * (t * t * t - 2 * t * t + t) * (double)a[2 * c->width + i] +
           (3 * t * t - 2 * t * t * t) * (double)b[c->width + i] + span * (t * t * t - t * t) * (double)b[i];
}

static void compare_over_time(uint32_t index)
{
    const model_channel *c = &source->clips[index].channels[0];
    noh_weight_clip clip = clip_at(index);
    float duration = clip.header->duration_s;
    for (int step = -50; step <= 1050; step++) {
        float time = duration * (float)step / 1000.0f, weights[WIDTH];
        noh_weight_clip_sample(&clip, 0, time, weights);
        for (uint32_t i = 0; i < WIDTH; i++) {
            double expected = oracle(c, (double)time, i);
            if (!(fabs((double)weights[i] - expected) <= 4e-6)) { /* values up to 2, tangents up to 2 per second */
                fail_msg("clip %u at %g s, weight %u: %.9g, not %.9g", index, (double)time, i, (double)weights[i], expected);
            }
        }
    }
}

static void linear_keys(void **state)
{
    (void)state;
    compare_over_time(0);
}

static void step_keys(void **state)
{
    (void)state;
    compare_over_time(1);
}

static void cubic_keys(void **state)
{
    (void)state;
    compare_over_time(2);
}

static const float *key_values(const model_channel *c, uint32_t key)
{
    uint32_t cubic = c->interpolation == MODEL_CUBICSPLINE;
    return c->values + key * c->width * (cubic ? 3u : 1u) + (cubic ? c->width : 0u);
}

/* Bit for bit: a pose that an artist keyed comes out as keyed. */
static void keys_are_met_exactly(void **state)
{
    (void)state;
    for (uint32_t index = 0; index < 3; index++) {
        const model_channel *c = &source->clips[index].channels[0];
        noh_weight_clip clip = clip_at(index);
        for (uint32_t k = 0; k < KEYS; k++) {
            float weights[WIDTH];
            noh_weight_clip_sample(&clip, 0, c->times[k], weights);
            test_same_floats(weights, key_values(c, k), WIDTH, source->clips[index].name);
        }
    }
}

static void ends_hold(void **state)
{
    (void)state;
    for (uint32_t index = 0; index < 3; index++) {
        const model_channel *c = &source->clips[index].channels[0];
        noh_weight_clip clip = clip_at(index);
        const float before[] = { -1e30f, -1.0f, 0.0f, c->times[0] * 0.5f };
        const float after[] = { c->times[KEYS - 1], c->times[KEYS - 1] + 1.0f, 1e30f };
        float weights[WIDTH];
        for (size_t i = 0; i < TEST_COUNT(before); i++) {
            noh_weight_clip_sample(&clip, 0, before[i], weights);
            test_same_floats(weights, key_values(c, 0), WIDTH, "before the first key");
        }
        for (size_t i = 0; i < TEST_COUNT(after); i++) {
            noh_weight_clip_sample(&clip, 0, after[i], weights);
            test_same_floats(weights, key_values(c, KEYS - 1), WIDTH, "after the last key");
        }
    }
}

static void step_holds_until_just_before_the_next_key(void **state)
{
    const model_channel *c = &source->clips[1].channels[0];
    noh_weight_clip clip = clip_at(1);
    float weights[WIDTH];
    (void)state;
    noh_weight_clip_sample(&clip, 0, nextafterf(c->times[2], 0.0f), weights);
    test_same_floats(weights, key_values(c, 1), WIDTH, "just before a key");
}

static void one_key_holds_always(void **state)
{
    const test_model_desc desc = { 1, 4, 2, TEST_SCENE, 5 };
    model *m = test_model(&desc);
    size_t count;
    uint8_t *one;
    noh_pack p;
    noh_weight_clip clip;
    (void)state;
    for (uint32_t i = 0; i < 3; i++) {
        m->clips[i].channels[0].key_count = 1;
        m->clips[i].duration_s = m->clips[i].channels[0].times[0];
    }
    one = test_pack_of(m, &count, NULL);
    p = test_open(one, count);
    for (uint32_t i = 0; i < 3; i++) {
        assert_int_equal(noh_pack_weight_clip(&p, i, &clip), NOH_OK);
        for (float time = -1.0f; time < 3.0f; time += 0.25f) {
            float weights[2];
            noh_weight_clip_sample(&clip, 0, time, weights);
            test_same_floats(weights, key_values(&m->clips[i].channels[0], 0), 2, m->clips[i].name);
        }
    }
    free(one);
    model_free(m);
}

static void names_and_durations_are_kept(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 3; i++) {
        noh_weight_clip clip = clip_at(i);
        assert_string_equal(clip.name, source->clips[i].name);
        assert_true(clip.header->duration_s == source->clips[i].duration_s);
        assert_int_equal(clip.channels[0].width, WIDTH);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(linear_keys),
    cmocka_unit_test(step_keys),
    cmocka_unit_test(cubic_keys),
    cmocka_unit_test(keys_are_met_exactly),
    cmocka_unit_test(ends_hold),
    cmocka_unit_test(step_holds_until_just_before_the_next_key),
    cmocka_unit_test(one_key_holds_always),
    cmocka_unit_test(names_and_durations_are_kept),
};

TEST_MAIN(tests, set_up, tear_down)
