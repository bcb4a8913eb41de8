/* Weights as text (tools/noh/file/weights_text.h): what is written is read again to the bit; what people paste from
 * shells, notes and JSON is understood; an error names its line. */
#include "file/weights_text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

static void expect(weights_reader *r, weights_kind kind, const char *name, double value, unsigned line)
{
    weights_item item;
    assert_int_equal(weights_next(r, &item), kind);
    assert_string_equal(item.name, name);
    assert_true(item.value == value);
    assert_int_equal(item.line, line);
}

static void presets_and_their_weights(void **state)
{
    weights_reader r = { "# mine\n[ a grin ]\nsmile = 0.8\n\n  cheek puff=0.2 # little\n[]\n[sad\nfrown=1", 0 };
    (void)state;
    expect(&r, WEIGHTS_PRESET, "a grin", 0.0, 2);
    expect(&r, WEIGHTS_VALUE, "smile", 0.8, 3);
    expect(&r, WEIGHTS_VALUE, "cheek puff", 0.2, 5);
    expect(&r, WEIGHTS_BAD, "", 0.0, 6);
    expect(&r, WEIGHTS_BAD, "sad", 0.0, 7);
    expect(&r, WEIGHTS_VALUE, "frown", 1.0, 8);
    expect(&r, WEIGHTS_END, "", 0.0, 8);
    expect(&r, WEIGHTS_END, "", 0.0, 8);
}

static void what_is_pasted_from_elsewhere(void **state)
{
    static const char *const texts[] = {
        "smile = 0.5\njawOpen = -1e-3\n",
        "--weight smile=0.5 --weight jawOpen=-1e-3",
        "--weight=smile=.5 \\\r\n --weight=jawOpen=-0.001\r\n",
        "smile: 0.5, jawOpen: -1e-3",
        "{\"smile\": 0.5, \"jawOpen\": -1e-3}",
        "{ 'smile' : '0.5';\n  'jawOpen' : '-1e-3' }",
    };
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        weights_reader r = { texts[i], 0 };
        weights_item item;
        assert_int_equal(weights_next(&r, &item), WEIGHTS_VALUE);
        assert_string_equal(item.name, "smile");
        assert_true(item.value == 0.5);
        assert_int_equal(weights_next(&r, &item), WEIGHTS_VALUE);
        assert_string_equal(item.name, "jawOpen");
        assert_true(item.value == -1e-3);
        assert_int_equal(weights_next(&r, &item), WEIGHTS_END);
    }
}

static void what_is_no_weight_is_told(void **state)
{
    static const char *const bad[] = { "hello", "smile =", "smile = much", "smile = nan", "smile = inf",
                                       "= 0.5", "[",       "smile\n= 1" };
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        weights_reader r = { bad[i], 0 };
        weights_item item;
        assert_int_equal(weights_next(&r, &item), WEIGHTS_BAD);
        for (int n = 0; n < 8 && weights_next(&r, &item) != WEIGHTS_END; n++) {}
        assert_int_equal(weights_next(&r, &item), WEIGHTS_END);
    }
}

static void long_names_are_cut(void **state)
{
    char text[2048];
    weights_item item;
    weights_reader r = { text, 0 };
    (void)state;
    memset(text, 'a', 1000);
    strcpy(text + 1000, " = 1");
    assert_int_equal(weights_next(&r, &item), WEIGHTS_VALUE);
    assert_int_equal(strlen(item.name), NOH_NAME_BYTES_MAX - 1u);
    assert_true(item.value == 1.0);
}

static void every_float_survives(void **state)
{
    uint32_t random = 1;
    (void)state;
    for (int i = 0; i < 20000; i++) {
        char text[128];
        float value;
        random = random * 1664525u + 1013904223u;
        memcpy(&value, &random, sizeof value);
        if (!isfinite(value)) continue;
        const size_t length = weights_line(text, sizeof text, "x", value);
        weights_reader r = { text, 0 };
        weights_item item;
        assert_true(length == strlen(text) && length > 0);
        assert_int_equal(weights_next(&r, &item), WEIGHTS_VALUE);
        assert_true((float)item.value == value);
    }
}

static void a_line_that_does_not_fit(void **state)
{
    char text[16] = "as it was";
    (void)state;
    assert_int_equal(weights_line(text, 12, "smile", 0.25f), 0);
    assert_string_equal(text, "as it was");
    assert_int_equal(weights_line(text, 14, "smile", 0.25f), 13);
    assert_string_equal(text, "smile = 0.25\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(presets_and_their_weights), cmocka_unit_test(what_is_pasted_from_elsewhere),
        cmocka_unit_test(what_is_no_weight_is_told), cmocka_unit_test(long_names_are_cut),
        cmocka_unit_test(every_float_survives),      cmocka_unit_test(a_line_that_does_not_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
