/* support.h: what the tests share; linked into every one of them.
 *
 *   TEST_MAIN            run a table of tests; argument 1 is a filter, and so is NOH_FUNCTION in the environment
 *   test_skip            say why, then skip
 *   test_skip_emulated   skip on an emulated processor
 *   test_zeros, test_aligned, test_folder, test_asset
 *   test_random_*        a seeded generator, the same on every machine
 *   test_model           a model made in code: grids that bulge, with all that a pack can hold
 *   test_pack            the bytes of its pack, made by the converter */
#ifndef NOH_TESTS_SUPPORT_SUPPORT_H
#define NOH_TESTS_SUPPORT_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdlib.h>

#include "convert/pack/pack_write.h"
#include "noh/clip.h"
#include "noh/deform.h"
#include "noh/pack.h"

#define TEST_MAIN(tests, set_up, tear_down)                            \
    int main(int argument_count, char **arguments)                     \
    {                                                                  \
        if (argument_count > 1) {                                      \
            cmocka_set_test_filter(arguments[1]);                      \
        }                                                              \
        return cmocka_run_group_tests((tests), (set_up), (tear_down)); \
    }

/* Print "SKIP: reason" and leave the test. */
#define test_skip(...)              \
    do {                            \
        print_message("SKIP: ");    \
        print_message(__VA_ARGS__); \
        print_message("\n");        \
        skip();                     \
    } while (0)

/* What takes minutes on an emulated processor (tests/cross.sh sets NOH_EMULATED), and tells no more there than on this
 * one, whose bits are the same. */
#define test_skip_emulated(what)                                                              \
    do {                                                                                      \
        if (getenv("NOH_EMULATED")) test_skip("%s: too slow on an emulated processor", what); \
    } while (0)

/* Whether steps take several times as long: a sanitizer watches (tests/run.sh sets NOH_SAN). Long runs are shorter
 * then. */
int test_is_sanitized(void);

/* How many rounds of `all` a test goes that takes long: all of them with NOH_LONG set, else a half, and an eighth under
 * sanitizers and on an emulated processor; at least one. */
int test_rounds(int all);

#define TEST_COUNT(array) (sizeof(array) / sizeof(array)[0])

/* ---- memory, files ---- */

/* Zeroed; never NULL. Free it with free(), as all below. */
void *test_zeros(size_t bytes);

/* A copy at a multiple of 64, exactly `count` bytes long. */
uint8_t *test_aligned(const void *bytes, size_t count);

/* $NOH_ASSETS/NAME in a static buffer, or skips the test where that file is not there. */
const char *test_asset(const char *name);

/* A new folder in $TMPDIR, removed when the program ends (with the files directly in it). */
const char *test_folder(void);

/* NAME in that folder; static buffers, the last 4 stay valid. */
const char *test_path(const char *name);

/* Models, recordings and texts are kept as seeds, too. */
void test_write_file(const char *path, const void *bytes, size_t count);

/* Keeps a file for the fuzzer of the importers: $NOH_SEEDS/HASH, where that is set. */
void test_keep_seed(const void *bytes, size_t count);

/* The same of a .gltf text whose one buffer is a file in the same folder: as a .glb. */
void test_keep_glb_seed(const char *json, const void *bin, size_t count);

/* ---- random numbers: xorshift64* ---- */

typedef struct test_random {
    uint64_t state;
} test_random;

/* Prints the seed, so that a failure can be repeated. */
test_random test_random_from(uint64_t seed);
uint32_t test_random_u32(test_random *r);
uint32_t test_random_below(test_random *r, uint32_t limit);
float test_random_float(test_random *r, float low, float high);

/* Weights from -1 to 2; about a third is zero. */
void test_random_weights(test_random *r, float *weights, uint32_t count);

/* ---- models and packs ---- */

#define TEST_TANGENTS 1u
#define TEST_UVS 2u
#define TEST_COLORS 4u
#define TEST_SCENE 8u /* two materials, a texture, a node tree, three clips; and two submeshes per mesh */

typedef struct test_model_desc {
    uint32_t meshes;  /* 0: 1 */
    uint32_t side;    /* vertices per side of each grid; 0: 5. The n-th mesh has `side + 6 n` */
    uint32_t targets; /* per mesh; NAMES "smile", "blink", "target_2"... */
    uint32_t flags;   /* TEST_* */
    uint64_t seed;
} test_model_desc;

/* To be freed with model_free. Vertex v of a grid lies at x = v % side, y = v / side. */
model *test_model(const test_model_desc *desc);

/* Encode and write it with its clips; the bytes are aligned. Warnings go to the model. orders: NULL, or
 * [mesh_count] to receive each mesh's new-to-old vertex order (to be freed). */
uint8_t *test_pack_of(model *m, size_t *count, uint32_t **orders);

/* test_model and test_pack_of in one call. */
uint8_t *test_pack(const test_model_desc *desc, size_t *count);

/* Open a pack; fails the test where it does not open. */
noh_pack test_open(const uint8_t *bytes, size_t count);

/* A clip bank in memory of the exact size; free() it. Fails the test where it cannot be made. */
noh_clip_bank *test_clip_bank(const noh_clip_bank_desc *desc);

/* The index-th mesh of an opened pack. */
noh_mesh test_mesh(const noh_pack *pack, uint32_t index);

/* Layers in malloc'ed memory of the exact size; layers->position is the block to free. */
noh_morph_layers test_layers(const noh_mesh *mesh);

/* A hash of bytes (FNV-1a, 64 bits), continued from `hash`; start with TEST_HASH. For files that hold a CRC of their
 * own bytes, whose CRC is the same whatever they say. */
#define TEST_HASH 0xcbf29ce484222325ull
uint64_t test_hash(uint64_t hash, const void *bytes, size_t count);

/* Bits, not values: -0 and 0 differ, a NaN equals itself. Names the first difference. */
void test_same_floats(const float *got, const float *expected, size_t count, const char *what);

#endif
