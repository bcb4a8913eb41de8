#define _XOPEN_SOURCE 700

#include "support.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Before main: NOH_FUNCTION is the one test to run, of whichever program (tests/mutants.sh). */
__attribute__((constructor)) static void filter_by_environment(void)
{
    const char *function = getenv("NOH_FUNCTION");
    if (function && *function) cmocka_set_test_filter(function);
}

/* ---- memory, files ---- */

void *test_zeros(size_t bytes)
{
    void *p = calloc(bytes ? bytes : 1, 1);
    assert_non_null(p);
    return p;
}

uint8_t *test_aligned(const void *bytes, size_t count)
{
    void *p = NULL;
    assert_int_equal(posix_memalign(&p, 64, count ? count : 1), 0);
    if (bytes) {
        memcpy(p, bytes, count);
    }
    return p;
}

int test_is_sanitized(void)
{
    const char *san = getenv("NOH_SAN");
    return san && *san;
}

int test_rounds(int all)
{
    const int fewer = getenv("NOH_LONG") ? 1 : test_is_sanitized() || getenv("NOH_EMULATED") ? 8 : 2;
    return all / fewer > 0 ? all / fewer : 1;
}

const char *test_asset(const char *name)
{
    static char path[4096];
    const char *base = getenv("NOH_ASSETS");
    struct stat s;
    if (!base) {
        test_skip("NOH_ASSETS does not name a folder of models");
    }
    snprintf(path, sizeof path, "%s/%s", base, name);
    if (stat(path, &s) != 0) {
        test_skip("no %s in NOH_ASSETS", name);
    }
    return path;
}

static char folder[1024];

static void remove_folder(void)
{
    DIR *d = opendir(folder);
    for (struct dirent *e = d ? readdir(d) : NULL; e; e = readdir(d)) {
        char path[2048];
        snprintf(path, sizeof path, "%s/%.512s", folder, e->d_name);
        unlink(path);
    }
    if (d) {
        closedir(d);
    }
    rmdir(folder);
}

const char *test_folder(void)
{
    if (!folder[0]) {
        const char *base = getenv("TMPDIR");
        snprintf(folder, sizeof folder, "%s/noh_test_XXXXXX", base ? base : "/tmp");
        assert_non_null(mkdtemp(folder));
        atexit(remove_folder);
    }
    return folder;
}

const char *test_path(const char *name)
{
    static char paths[4][2048];
    static unsigned next;
    char *path = paths[next++ % 4u];
    snprintf(path, sizeof paths[0], "%s/%s", test_folder(), name);
    return path;
}

/* A file that is truncated and written again goes to the disk when it is closed (ext4's auto_da_alloc); a new one that
 * is soon removed never does. Tests that write twenty thousand files wait for the disk otherwise. */
void test_keep_seed(const void *bytes, size_t count)
{
    const char *seeds = getenv("NOH_SEEDS");
    const uint8_t *b = bytes;
    uint32_t hash = 2166136261u;
    char path[4096];
    FILE *f;
    if (!seeds || count > 65536) return;
    for (size_t i = 0; i < count; i++) hash = (hash ^ b[i]) * 16777619u;
    (void)snprintf(path, sizeof path, "%s/%08x", seeds, hash);
    f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, count, f), count);
    assert_int_equal(fclose(f), 0);
}

void test_keep_glb_seed(const char *json, const void *bin, size_t count)
{
    const uint32_t text = (uint32_t)(strlen(json) + 3u) / 4u * 4u, rest = (uint32_t)(count + 3u) / 4u * 4u;
    const uint32_t words[8] = { 0x46546c67u, 2u, 28u + text + rest, text, 0x4e4f534au, rest, 0x004e4942u, 0 };
    uint8_t *glb = test_zeros(words[2]);
    char *uri;
    memcpy(glb, words, 20);
    memset(glb + 20, ' ', text);
    memcpy(glb + 20, json, strlen(json));
    memcpy(glb + 20 + text, words + 5, 8);
    memcpy(glb + 28 + text, bin, count);
    uri = strstr((char *)glb + 20, "\"uri\"");
    if (uri) memcpy(uri, "\"was\"", 5); /* the first buffer of a .glb is its second chunk */
    test_keep_seed(glb, words[2]);
    free(glb);
}

/* What has no beginning of its own gets one: the fuzzer tells files by their first bytes. */
static void keep_if_read(const char *path, const void *bytes, size_t count)
{
    static const struct {
        const char *ending, *before;
    } kinds[] = { { ".bvh", "" }, { ".fbx", "" }, { ".obj", "" }, { ".rcl", "" }, { ".txt", "text" } };
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < TEST_COUNT(kinds); i++) {
        const size_t before = strlen(kinds[i].before);
        uint8_t *file;
        if (strcmp(dot, kinds[i].ending) != 0 || strstr(path, "mutated")) continue;
        file = test_zeros(before + count + 1u);
        memcpy(file, kinds[i].before, before);
        memcpy(file + before, bytes, count);
        test_keep_seed(file, before + count);
        free(file);
    }
}

void test_write_file(const char *path, const void *bytes, size_t count)
{
    FILE *f;
    keep_if_read(path, bytes, count);
    (void)remove(path);
    f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, count, f), count);
    assert_int_equal(fclose(f), 0);
}

/* ---- random numbers ---- */

test_random test_random_from(uint64_t seed)
{
    test_random r = { seed * 0x9e3779b97f4a7c15ull + 0x6e6f68ull };
    print_message("# seed %llu\n", (unsigned long long)seed);
    return r;
}

uint32_t test_random_u32(test_random *r)
{
    r->state ^= r->state >> 12;
    r->state ^= r->state << 25;
    r->state ^= r->state >> 27;
    return (uint32_t)((r->state * 2685821657736338717ull) >> 32);
}

uint32_t test_random_below(test_random *r, uint32_t limit)
{
    return (uint32_t)(((uint64_t)test_random_u32(r) * limit) >> 32);
}

float test_random_float(test_random *r, float low, float high)
{
    return low + (high - low) * ((float)(test_random_u32(r) >> 8) / 16777216.0f);
}

void test_random_weights(test_random *r, float *weights, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t skip_it = test_random_below(r, 3) == 0;
        float value = test_random_float(r, -1.0f, 2.0f);
        weights[i] = skip_it ? 0.0f : value;
    }
}

/* ---- packs ---- */

noh_pack test_open(const uint8_t *bytes, size_t count)
{
    noh_pack pack;
    noh_error error = { NOH_OK, "", 0, 0 };
    if (noh_pack_open(bytes, count, &pack, &error) != NOH_OK) {
        fail_msg("the pack does not open: %s (byte %llu)", error.what, (unsigned long long)error.where);
    }
    return pack;
}

noh_clip_bank *test_clip_bank(const noh_clip_bank_desc *desc)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_clip_bank *set = NULL;
    size_t bytes = noh_clip_bank_size(desc, &error);
    void *memory = test_aligned(NULL, bytes);
    if (!bytes || noh_clip_bank_init(memory, bytes, desc, &set, &error)) {
        fail_msg("no clip bank: %s (%llu)", error.what, (unsigned long long)error.where);
    }
    assert_ptr_equal(set, memory); /* so that it can be freed by this name */
    return set;
}

noh_mesh test_mesh(const noh_pack *pack, uint32_t index)
{
    noh_mesh mesh;
    assert_int_equal(noh_pack_mesh_at(pack, index, &mesh, NULL), NOH_OK);
    return mesh;
}

noh_morph_layers test_layers(const noh_mesh *mesh)
{
    size_t bytes = noh_morph_layers_size(mesh);
    void *memory = test_zeros(bytes);
    noh_morph_layers layers = { NULL, NULL, NULL };
    assert_int_equal(noh_morph_layers_init(memory, bytes, mesh, &layers, NULL), NOH_OK);
    layers.position = memory; /* NULL for no texels; it is what the caller frees */
    return layers;
}

uint64_t test_hash(uint64_t hash, const void *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++) hash = (hash ^ ((const uint8_t *)bytes)[i]) * 0x100000001b3ull;
    return hash;
}

void test_same_floats(const float *got, const float *expected, size_t count, const char *what)
{
    for (size_t i = 0; i < count; i++) {
        if (memcmp(got + i, expected + i, sizeof *got) != 0) {
            fail_msg("%s: value %zu is %a, not %a", what, i, (double)got[i], (double)expected[i]);
        }
    }
}
