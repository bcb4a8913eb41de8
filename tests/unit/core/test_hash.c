/* Checksums and name hashes against published values. */
#include "support/support.h"

#include <stdlib.h>
#include <string.h>
#include "noh/low_core.h"

static void crc32c_of_the_check_string(void **state)
{
    (void)state;
    assert_int_equal(noh_crc32c(0, "123456789", 9), 0xe3069283u);
}

/* RFC 3720, appendix B.4. */
static void crc32c_of_the_iscsi_examples(void **state)
{
    uint8_t bytes[32];
    (void)state;
    memset(bytes, 0, sizeof bytes);
    assert_int_equal(noh_crc32c(0, bytes, 32), 0x8a9136aau);
    memset(bytes, 0xff, sizeof bytes);
    assert_int_equal(noh_crc32c(0, bytes, 32), 0x62a8ab43u);
    for (int i = 0; i < 32; i++) {
        bytes[i] = (uint8_t)i;
    }
    assert_int_equal(noh_crc32c(0, bytes, 32), 0x46dd794eu);
    for (int i = 0; i < 32; i++) {
        bytes[i] = (uint8_t)(31 - i);
    }
    assert_int_equal(noh_crc32c(0, bytes, 32), 0x113fdb5cu);
}

/* Against the definition, a bit at a time: every length and alignment around the words that the library takes at once.
 */
static void crc32c_of_every_length_and_alignment(void **state)
{
    uint8_t bytes[80];
    (void)state;
    for (uint32_t i = 0; i < sizeof bytes; i++) {
        bytes[i] = (uint8_t)(i * 167u + (i >> 2) * 29u + 5u);
    }
    for (size_t first = 0; first < 4; first++) {
        for (size_t count = 0; first + count <= sizeof bytes; count++) {
            uint32_t crc = 0xffffffffu;
            for (size_t i = 0; i < 8 * count; i++) {
                const uint32_t bit = (crc ^ (uint32_t)bytes[first + i / 8] >> i % 8) & 1u;
                crc = crc >> 1 ^ (bit ? 0x82f63b78u : 0u);
            }
            assert_int_equal(noh_crc32c(0, bytes + first, count), ~crc);
        }
    }
}

static void crc32c_of_nothing_changes_nothing(void **state)
{
    (void)state;
    assert_int_equal(noh_crc32c(0, "", 0), 0);
    assert_int_equal(noh_crc32c(0xe3069283u, "", 0), 0xe3069283u);
}

static void crc32c_continues(void **state)
{
    test_random r = test_random_from(1);
    uint8_t bytes[257];
    (void)state;
    for (size_t i = 0; i < sizeof bytes; i++) {
        bytes[i] = (uint8_t)test_random_u32(&r);
    }
    for (size_t cut = 0; cut <= sizeof bytes; cut++) {
        uint32_t first = noh_crc32c(0, bytes, cut);
        assert_int_equal(noh_crc32c(first, bytes + cut, sizeof bytes - cut), noh_crc32c(0, bytes, sizeof bytes));
    }
}

/* From the authors' test vectors (draft-eastlake-fnv). */
static void names_hash_as_fnv1a(void **state)
{
    (void)state;
    assert_int_equal(noh_hash_name(""), 0x811c9dc5u);
    assert_int_equal(noh_hash_name("a"), 0xe40c292cu);
    assert_int_equal(noh_hash_name("foobar"), 0xbf9cf968u);
}

static void names_hash_bytes_above_127_as_unsigned(void **state)
{
    (void)state;
    assert_int_equal(noh_hash_name("\xff"), (0x811c9dc5u ^ 0xffu) * 0x01000193u);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(crc32c_of_the_check_string),
    cmocka_unit_test(crc32c_of_the_iscsi_examples),
    cmocka_unit_test(crc32c_of_every_length_and_alignment),
    cmocka_unit_test(crc32c_of_nothing_changes_nothing),
    cmocka_unit_test(crc32c_continues),
    cmocka_unit_test(names_hash_as_fnv1a),
    cmocka_unit_test(names_hash_bytes_above_127_as_unsigned),
};

TEST_MAIN(tests, NULL, NULL)
