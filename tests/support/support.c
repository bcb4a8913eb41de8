#define _XOPEN_SOURCE 700

#include "support.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "convert/clips/model_clips.h"
#include "convert/model/model_build.h"
#include "convert/pack/pack_clips.h"

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

/* ---- models ---- */

static void unit3(float v[3])
{
    float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) {
        v[i] /= length;
    }
}

static void fill_vertex(model_mesh *m, uint32_t v, uint32_t side, test_random *r)
{
    float n[3] = { test_random_float(r, -1.0f, 1.0f), test_random_float(r, -1.0f, 1.0f),
                   test_random_float(r, 0.1f, 1.0f) };
    unit3(n);
    m->position[3 * v] = (float)(v % side);
    m->position[3 * v + 1] = (float)(v / side);
    m->position[3 * v + 2] = test_random_float(r, -0.2f, 0.2f);
    memcpy(m->normal + 3 * v, n, sizeof n);
    if (m->tangent) {
        float t[3] = { n[2], 0.0f, -n[0] }; /* at a right angle to the normal */
        unit3(t);
        memcpy(m->tangent + 4 * v, t, sizeof t);
        m->tangent[4 * v + 3] = v % 3 ? 1.0f : -1.0f;
    }
    for (uint32_t i = 0; m->uv && i < 2; i++) {
        m->uv[2 * v + i] = test_random_float(r, -0.5f, 1.5f);
    }
    for (uint32_t i = 0; m->color && i < 4; i++) {
        m->color[4 * v + i] = test_random_float(r, 0.0f, 1.0f);
    }
}

/* A bump that fades to its rim, of a random place and size; the last corner always moves, so
 * that every mesh has its highest touched texel in use. */
static void fill_target(model_mesh *m, model_target *t, uint32_t side, test_random *r)
{
    float cx = test_random_float(r, 0.0f, (float)side), cy = test_random_float(r, 0.0f, (float)side);
    float radius = test_random_float(r, 0.2f, 0.6f) * (float)side + 1.0f;
    t->has_position = t->has_normal = 1;
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        float x = m->position[3 * v] - cx, y = m->position[3 * v + 1] - cy;
        float d = 1.0f - (x * x + y * y) / (radius * radius);
        for (uint32_t i = 0; i < 3 && d > 0.0f; i++) {
            t->position[3 * v + i] = 0.1f * d * test_random_float(r, -1.0f, 1.0f);
            t->normal[3 * v + i] = 0.2f * d * test_random_float(r, -1.0f, 1.0f);
            if (t->tangent) {
                t->tangent[3 * v + i] = 0.2f * d * test_random_float(r, -1.0f, 1.0f);
            }
        }
    }
}

static void fill_targets(model_mesh *m, uint32_t side, test_random *r)
{
    static const char *const names[] = { "smile", "blink" };
    m->targets = test_zeros(sizeof *m->targets * m->target_count);
    m->weights = test_zeros(sizeof *m->weights * m->target_count);
    for (uint32_t t = 0; t < m->target_count; t++) {
        model_target *target = &m->targets[t];
        char name[32];
        snprintf(name, sizeof name, "target_%u", (unsigned)t);
        target->name = model_string(t < 2 ? names[t] : name);
        target->position = test_zeros(12u * (size_t)m->vertex_count);
        target->normal = test_zeros(12u * (size_t)m->vertex_count);
        target->tangent = m->tangent ? test_zeros(12u * (size_t)m->vertex_count) : NULL;
        m->weights[t] = t % 2 ? 0.25f : 0.0f;
        fill_target(m, target, side, r);
    }
}

static void fill_indices(model_mesh *m, uint32_t side)
{
    uint32_t *to;
    m->index_count = 6u * (side - 1u) * (side - 1u);
    to = m->indices = test_zeros(4u * (size_t)m->index_count);
    for (uint32_t y = 0; y + 1 < side; y++) {
        for (uint32_t x = 0; x + 1 < side; x++) {
            uint32_t v = y * side + x;
            const uint32_t quad[6] = { v, v + 1, v + side, v + side, v + 1, v + side + 1 };
            memcpy(to, quad, sizeof quad);
            to += 6;
        }
    }
}

static void fill_submeshes(model_mesh *m, uint32_t flags)
{
    uint32_t half = m->index_count / 6u * 3u;
    m->submesh_count = flags & TEST_SCENE ? 2 : 1;
    m->submeshes = test_zeros(sizeof *m->submeshes * m->submesh_count);
    for (uint32_t s = 0; s < m->submesh_count; s++) {
        model_submesh *sub = &m->submeshes[s];
        sub->first_index = s ? half : 0;
        sub->index_count = m->submesh_count == 1 ? m->index_count : s ? m->index_count - half : half;
        sub->material = flags & TEST_SCENE ? s : MODEL_NONE;
        sub->vertex_count = s ? 0 : m->vertex_count; /* the second shares the first one's */
    }
}

static void fill_mesh(model_mesh *m, const test_model_desc *desc, uint32_t index, test_random *r)
{
    uint32_t side = (desc->side ? desc->side : 5u) + 6u * index;
    char name[32];
    snprintf(name, sizeof name, "grid_%u", (unsigned)index);
    m->name = model_string(name);
    m->vertex_count = side * side;
    m->target_count = desc->targets;
    m->position = test_zeros(12u * (size_t)m->vertex_count);
    m->normal = test_zeros(12u * (size_t)m->vertex_count);
    m->tangent = desc->flags & TEST_TANGENTS ? test_zeros(16u * (size_t)m->vertex_count) : NULL;
    m->uv = desc->flags & TEST_UVS ? test_zeros(8u * (size_t)m->vertex_count) : NULL;
    m->color = desc->flags & TEST_COLORS ? test_zeros(16u * (size_t)m->vertex_count) : NULL;
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        fill_vertex(m, v, side, r);
    }
    fill_indices(m, side);
    fill_submeshes(m, desc->flags);
    fill_targets(m, side, r);
}

static void fill_materials(model *m)
{
    m->texture_count = 1;
    m->textures = test_zeros(sizeof *m->textures);
    m->textures[0].name = model_string("checks");
    m->textures[0].width = m->textures[0].height = 2;
    m->textures[0].rgba = test_zeros(16);
    memset(m->textures[0].rgba, 0xc3, 8);
    m->textures[0].wrap_s = 33071;
    m->material_count = 2;
    m->materials = test_zeros(sizeof *m->materials * 2);
    for (uint32_t i = 0; i < 2; i++) {
        model_material *to = &m->materials[i];
        *to = model_material_default();
        to->name = model_string(i ? "glass" : "skin");
        to->base_color[0] = to->base_color[3] = 1.0f;
        to->base_color_texture = i ? MODEL_NONE : 0;
        to->alpha = i ? MODEL_ALPHA_BLEND : MODEL_ALPHA_OPAQUE;
        to->roughness = 0.5f;
    }
}

static void fill_identity(model_node *n, uint32_t parent, uint32_t mesh, const char *name)
{
    n->name = model_string(name);
    n->parent = parent;
    n->mesh = mesh;
    n->skin = MODEL_NONE;
    n->rotation[3] = 1.0f;
    for (int i = 0; i < 4; i++) {
        n->world[5 * i] = 1.0;
        if (i < 3) {
            n->scale[i] = 1.0f;
        }
    }
}

/* A root, then a node for each mesh; the first of those has weights of its own. */
static void fill_nodes(model *m)
{
    m->node_count = 1 + m->mesh_count;
    m->nodes = test_zeros(sizeof *m->nodes * m->node_count);
    fill_identity(&m->nodes[0], MODEL_NONE, MODEL_NONE, "root");
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        fill_identity(&m->nodes[1 + i], 0, i, m->meshes[i].name);
        if (i == 0 && m->meshes[0].target_count) {
            m->nodes[1].weights = test_zeros(4u * (size_t)m->meshes[0].target_count);
            m->nodes[1].weights[0] = 0.5f;
        }
    }
}

#define TEST_KEYS 4u

static void fill_channel(model_channel *c, model_interpolation interpolation, uint32_t width, test_random *r)
{
    uint32_t values = width * (interpolation == MODEL_CUBICSPLINE ? 3u : 1u);
    c->node = 1;
    c->path = MODEL_PATH_WEIGHTS;
    c->interpolation = interpolation;
    c->key_count = TEST_KEYS;
    c->width = width;
    c->times = test_zeros(4u * TEST_KEYS);
    c->values = test_zeros(4u * (size_t)TEST_KEYS * values);
    for (uint32_t k = 0; k < TEST_KEYS; k++) {
        c->times[k] = (k ? c->times[k - 1] : 0.0f) + test_random_float(r, 0.1f, 0.8f);
    }
    for (uint32_t i = 0; i < TEST_KEYS * values; i++) {
        c->values[i] = test_random_float(r, -1.0f, 2.0f);
    }
}

static void fill_clips(model *m, test_random *r)
{
    static const char *const names[] = { "linear", "step", "cubic" };
    m->clip_count = m->meshes[0].target_count ? 3 : 0;
    m->clips = test_zeros(sizeof *m->clips * 3);
    for (uint32_t i = 0; i < m->clip_count; i++) {
        model_clip *c = &m->clips[i];
        c->name = model_string(names[i]);
        c->channel_count = 1;
        c->channels = test_zeros(sizeof *c->channels);
        fill_channel(c->channels, (model_interpolation)i, m->meshes[0].target_count, r);
        c->duration_s = c->channels->times[TEST_KEYS - 1];
    }
}

model *test_model(const test_model_desc *desc)
{
    test_random r = { desc->seed * 0x9e3779b97f4a7c15ull + 1 };
    model *m = model_new();
    assert_non_null(m);
    m->mesh_count = desc->meshes ? desc->meshes : 1;
    m->meshes = test_zeros(sizeof *m->meshes * m->mesh_count);
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        fill_mesh(&m->meshes[i], desc, i, &r);
    }
    if (desc->flags & TEST_SCENE) {
        fill_materials(m);
        fill_nodes(m);
        fill_clips(m, &r);
    }
    return m;
}

/* ---- packs ---- */

static void encode_clip(model *m, model_clips **made, encoded_clips *encoded)
{
    model_error error;
    clips_settings settings;
    memset(&settings, 0, sizeof settings);
    if (clips_from_model(m, NULL, made, &error) ||
        clips_encode((*made)->sets, (*made)->set_count, &settings, encoded, &error)) {
        fail_msg("%s (%s)", error.what, error.where);
    }
}

uint8_t *test_pack_of(model *m, size_t *count, uint32_t **orders)
{
    morph_encoding **encodings = test_zeros(sizeof *encodings * m->mesh_count);
    morph_options options = { 0 };
    byte_buffer out = { NULL, 0, 0, 0 };
    model_clips *made = NULL;
    encoded_clips encoded;
    model_error error;
    uint8_t *bytes;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        assert_int_equal(morph_encode(&m->meshes[i], &options, &encodings[i], &error), 0);
        if (orders) {
            orders[i] = test_zeros(4u * (size_t)m->meshes[i].vertex_count);
            memcpy(orders[i], encodings[i]->order, 4u * (size_t)m->meshes[i].vertex_count);
        }
    }
    encode_clip(m, &made, &encoded);
    if (pack_write(m, NULL, encodings, &encoded, &out, &error)) {
        fail_msg("pack_write: %s", error.what);
    }
    clips_free(&encoded);
    model_clips_free(made);
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        morph_encoding_free(encodings[i]);
    }
    free(encodings);
    bytes = test_aligned(out.bytes, out.count);
    *count = out.count;
    buffer_free(&out);
    return bytes;
}

uint8_t *test_pack(const test_model_desc *desc, size_t *count)
{
    model *m = test_model(desc);
    uint8_t *bytes = test_pack_of(m, count, NULL);
    model_free(m);
    return bytes;
}

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
