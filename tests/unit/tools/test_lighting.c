/* Tests of lighting.c: light that turns with a figure's front; boxes that do. */
#include <math.h>

#include "draw/lighting.h"
#include "support/support.h"

static void open_light(lighting *l, double rotate, double facing)
{
    const light_options o = { .light = "room", .rotate = rotate, .facing = facing };
    assert_int_equal(lighting_open(l, &o), 0);
}

/* A figure that faces elsewhere is as bright as one that faces +z. */
static void light_turns_with_the_front(void **state)
{
    (void)state;
    for (int turn = 0; turn < 2; turn++) {
        lighting ahead, behind;
        open_light(&ahead, 40.0 * turn, 0.0);
        open_light(&behind, 40.0 * turn, 180.0);
        assert_float_equal(ahead.told.exposure, behind.told.exposure, 1e-6f);
        assert_float_equal(ahead.told.key_direction[0], -behind.told.key_direction[0], 1e-4f);
        assert_float_equal(ahead.told.key_direction[2], -behind.told.key_direction[2], 1e-4f);
        lighting_turn(&ahead, ahead.degrees, 180.0);
        assert_float_equal(ahead.told.key_direction[0], behind.told.key_direction[0], 1e-4f);
        lighting_close(&ahead);
        lighting_close(&behind);
    }
}

static void boxes_turn_from_z_towards_x(void **state)
{
    const bounds box = { { -1.0, 0.0, 2.0 }, { 3.0, 5.0, 4.0 } };
    const bounds quarter = bounds_turned(box, 90.0), half = bounds_turned(box, -180.0),
                 back = bounds_turned(quarter, -90.0);
    (void)state;
    assert_true(quarter.low[0] == 2.0 && quarter.high[0] == 4.0 && quarter.low[2] == -3.0 && quarter.high[2] == 1.0);
    assert_true(half.low[0] == -3.0 && half.high[0] == 1.0 && half.low[2] == -4.0 && half.high[2] == -2.0);
    assert_memory_equal(&back, &box, sizeof box);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(light_turns_with_the_front),
                                        cmocka_unit_test(boxes_turn_from_z_towards_x) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
