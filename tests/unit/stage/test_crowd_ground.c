/* Tests of agents on a height field (crowd_ground.c): slopes slow them, what is too steep they leave
 * alone, and flow fields lead around it. */
#include "noh/base.h"
#include "noh/body.h"
#include "noh/crowd.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

#define SIDE 65u
#define SPACING 0.5f /* 32 m from edge to edge */

static uint16_t heights[SIDE * SIDE];

static noh_field field_of(float (*height)(float x, float z))
{
    const noh_field f = { heights, SIDE, SIDE, { -16.0f, 0.0f, -16.0f }, SPACING, 0.001f };
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const float x = -16.0f + SPACING * (float)(i % SIDE), z = -16.0f + SPACING * (float)(i / SIDE);
        heights[i] = (uint16_t)(height(x, z) * 1000.0f + 0.5f);
    }
    return f;
}

static noh_crowd *made(const noh_field *ground, uint32_t agents, uint32_t fields)
{
    noh_crowd_desc desc;
    noh_crowd *crowd = NULL;
    memset(&desc, 0, sizeof desc);
    desc.agent_max = agents;
    desc.origin[0] = desc.origin[1] = -16.0f;
    desc.extent[0] = desc.extent[1] = 32.0f;
    desc.ground = ground;
    desc.field_count = fields;
    const size_t bytes = noh_crowd_size(&desc);
    void *memory = malloc(bytes ? bytes : 1);
    assert_int_equal(noh_crowd_init(memory, bytes, &desc, &crowd, NULL), NOH_OK);
    return crowd;
}

static void put(noh_crowd *crowd, uint32_t index, float x, float z, float to_x, float to_z)
{
    const noh_crowd_agent a = { { x, z }, { 0.0f, 0.0f }, { to_x, to_z }, 0.25f, 1.3f, 0, index };
    assert_int_equal(noh_crowd_add(crowd, index, &a, NULL), NOH_OK);
}

static noh_crowd_agent after(noh_crowd *crowd, uint32_t index, float seconds)
{
    noh_crowd_agent a;
    for (uint32_t i = 0; i < (uint32_t)(seconds * 30.0f); i++) noh_crowd_step(crowd, NOH_CROWD_STEP_TICKS);
    assert_true(noh_crowd_agent_stepped(crowd, index, &a));
    return a;
}

static float slope;

static float ramp(float x, float z)
{
    (void)z;
    return 30.0f + slope * x;
}

/* Up, down and across slopes, against the formula in double precision; grades are kept in 64ths. */
static void slopes_slow_agents(void **state)
{
    static const float slopes[5] = { 0.0f, 0.05f, 0.1f, 0.25f, 0.5f };
    (void)state;
    for (uint32_t i = 0; i < 5u; i++) {
        slope = slopes[i];
        const noh_field f = field_of(ramp);
        noh_crowd *crowd = made(&f, 3, 0);
        put(crowd, 0, -10.0f, -8.0f, 15.0f, -8.0f);
        put(crowd, 1, 10.0f, 0.0f, -15.0f, 0.0f);
        put(crowd, 2, 0.0f, 5.0f, 0.0f, 15.0f);
        const double up = (double)after(crowd, 0, 3.0f).velocity[0], down = -(double)after(crowd, 1, 0.0f).velocity[0];
        const double across = (double)after(crowd, 2, 0.0f).velocity[1], s = (double)slope;
        print_message("slope %.2f: up %.3f, down %.3f, across %.3f m/s\n", s, up, down, across);
        assert_true(fabs(up - 1.3 * exp(3.5 * (0.05 - fabs(s + 0.05)))) < 0.04);
        assert_true(fabs(down - 1.3 * exp(3.5 * (0.05 - fabs(0.05 - s)))) < 0.04);
        assert_true(fabs(across - 1.3) < 1e-3);
        free(crowd);
    }
}

/* A ridge along z, as steep as 2, with a gap at z from 10 to 13. */
static float ridge(float x, float z)
{
    const float high = 4.0f - 2.0f * fabsf(x);
    return z > 10.0f && z < 13.0f ? 0.0f : high > 0.0f ? high : 0.0f;
}

static void none_climbs_what_is_too_steep(void **state)
{
    static const float goal[2] = { 10.0f, 0.0f };
    const noh_field f = field_of(ridge);
    noh_crowd *crowd = made(&f, 2, 1);
    (void)state;
    put(crowd, 0, -10.0f, 0.0f, 10.0f, 0.0f);
    put(crowd, 1, -10.0f, -3.0f, 10.0f, 0.0f);
    noh_crowd_field_aim(crowd, 0, goal);
    noh_crowd_follow(crowd, 1, 0);
    assert_int_equal(noh_crowd_field_build(crowd, 1000000), 0);
    const noh_crowd_agent straight = after(crowd, 0, 40.0f), led = after(crowd, 1, 0.0f);
    assert_true(straight.position[0] < -1.0f && straight.position[0] > -3.0f);
    assert_float_equal(led.position[0], goal[0], 0.1f);
    assert_float_equal(led.position[1], goal[1], 0.1f);
    free(crowd);
}

/* An agent on ground that is too steep walks down; ground that ends is level beyond. */
static void from_steep_ground_they_come_down(void **state)
{
    const noh_field f = field_of(ridge);
    noh_crowd *crowd = made(&f, 1, 0);
    (void)state;
    put(crowd, 0, 0.8f, 0.0f, 25.0f, 0.0f);
    assert_float_equal(after(crowd, 0, 40.0f).position[0], 25.0f, 0.1f);
    free(crowd);
}

static void bits_are_those_of_every_processor(void **state)
{
    const noh_field f = field_of(ridge);
    noh_crowd *crowd = made(&f, 60, 1);
    (void)state;
    for (uint32_t i = 0; i < 60u; i++) {
        put(crowd, i, -14.0f + 0.8f * (float)(i % 12u), -12.0f + (float)(i / 12u), 12.0f, 0.3f * (float)(i % 7u));
        if (i % 2u) noh_crowd_follow(crowd, i, 0);
    }
    noh_crowd_field_aim(crowd, 0, (float[2]){ 12.0f, -12.0f });
    (void)after(crowd, 0, 30.0f);
    assert_int_equal(noh_crowd_hash(crowd), 0xf87d6c09u);
    free(crowd);
}

static void bad_ground_is_refused(void **state)
{
    slope = 0.1f;
    noh_field f = field_of(ramp);
    noh_crowd_desc desc;
    noh_error error;
    noh_crowd *crowd;
    (void)state;
    memset(&desc, 0, sizeof desc);
    desc.agent_max = 1;
    desc.extent[0] = desc.extent[1] = 8.0f;
    const size_t flat = noh_crowd_size(&desc);
    desc.ground = &f;
    assert_true(noh_crowd_size(&desc) + 16u - flat - (28u + 2u * 16u * 16u) < 36u); /* both rounded up */
    desc.slope_max = -1.0f;
    assert_int_equal(noh_crowd_init(&desc, 8, &desc, &crowd, &error), NOH_ERR_ARG);
    desc.slope_max = 0.0f;
    f.spacing = 0.0f;
    assert_int_equal(noh_crowd_init(&desc, 8, &desc, &crowd, &error), NOH_ERR_ARG);
    f.spacing = SPACING;
    desc.field_cell = 0.001f;
    assert_int_equal(noh_crowd_init(&desc, 8, &desc, &crowd, &error), NOH_ERR_LIMIT);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(slopes_slow_agents),
        cmocka_unit_test(none_climbs_what_is_too_steep),
        cmocka_unit_test(from_steep_ground_they_come_down),
        cmocka_unit_test(bits_are_those_of_every_processor),
        cmocka_unit_test(bad_ground_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
