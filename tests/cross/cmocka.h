/* cmocka.h: as much of cmocka as the CPU tests use, for processors that have no package of it (tests/cross.sh). A
 * failed assertion ends its test, and the program continues with the next one. Results are printed as TAP. */
#ifndef NOH_TESTS_CROSS_CMOCKA_H
#define NOH_TESTS_CROSS_CMOCKA_H

typedef int (*cross_fixture)(void **state);

struct CMUnitTest {
    const char *name;
    void (*run)(void **state);
    cross_fixture set_up, tear_down; /* of one test; unused */
    void *initial_state;
};

#define cmocka_unit_test(function)            \
    {                                         \
#function, function, NULL, NULL, NULL \
    }
#define cmocka_run_group_tests(tests, set_up, tear_down) \
    cross_run((tests), sizeof(tests) / sizeof(tests)[0], (set_up), (tear_down))
#define cmocka_run_group_tests_name(name, tests, set_up, tear_down) cmocka_run_group_tests(tests, set_up, tear_down)

int cross_run(const struct CMUnitTest *tests, size_t count, cross_fixture set_up, cross_fixture tear_down);
void cmocka_set_test_filter(const char *filter);

void print_message(const char *format, ...);
void print_error(const char *format, ...);

/* These leave the test. */
void cross_skip(void);
void cross_fail(const char *file, int line, const char *format, ...);

void cross_same(int same, const char *what, const char *file, int line);
void cross_integers(uint64_t a, uint64_t b, int want_equal, const char *what, const char *file, int line);
void cross_texts(const char *a, const char *b, const char *file, int line);
void cross_memory(const void *a, const void *b, size_t bytes, const char *file, int line);

#define skip() cross_skip()
#define fail() cross_fail(__FILE__, __LINE__, "fail()")
#define fail_msg(...) cross_fail(__FILE__, __LINE__, __VA_ARGS__)
#define assert_true(x) cross_same((x) ? 1 : 0, #x, __FILE__, __LINE__)
#define assert_false(x) cross_same((x) ? 0 : 1, "not " #x, __FILE__, __LINE__)
#define assert_null(x) cross_same((x) == NULL, #x " is NULL", __FILE__, __LINE__)
#define assert_non_null(x) cross_same((x) != NULL, #x " is not NULL", __FILE__, __LINE__)
#define assert_ptr_equal(a, b) cross_same((const void *)(a) == (const void *)(b), #a " is " #b, __FILE__, __LINE__)
#define assert_int_equal(a, b) cross_integers((uint64_t)(a), (uint64_t)(b), 1, #a " is " #b, __FILE__, __LINE__)
#define assert_int_not_equal(a, b) cross_integers((uint64_t)(a), (uint64_t)(b), 0, #a " is not " #b, __FILE__, __LINE__)
#define assert_in_range(x, low, high)                                                                           \
    cross_same((uint64_t)(x) >= (uint64_t)(low) && (uint64_t)(x) <= (uint64_t)(high), #x " in range", __FILE__, \
               __LINE__)
#define assert_string_equal(a, b) cross_texts((a), (b), __FILE__, __LINE__)
#define assert_string_not_equal(a, b) cross_same(strcmp((a), (b)) != 0, #a " is not " #b, __FILE__, __LINE__)
#define assert_memory_equal(a, b, bytes) cross_memory((a), (b), (bytes), __FILE__, __LINE__)
#define assert_memory_not_equal(a, b, bytes) \
    cross_same(memcmp((a), (b), (bytes)) != 0, #a " is not " #b, __FILE__, __LINE__)
#define assert_float_equal(a, b, epsilon) \
    cross_same(fabs((double)(a) - (double)(b)) <= (double)(epsilon), #a " is " #b, __FILE__, __LINE__)

#endif
