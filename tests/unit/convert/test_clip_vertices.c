/* What `noh build` says of vertices, against the file's own curves: read by a second reader (gltf_oracle.c) in double
 * precision, posed as the specification writes it, and compared with the pack as the runtime plays it at whole ticks.
 * Both poses move the same vertices. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/convert.h"
#include "noh/low_motion.h"
#include "support/gltf_oracle.h"

/* ---- a figure: a body, and a head that only its own vertices tell the size of ---- */

typedef struct nod {
    const char *interpolation;
    uint32_t keys;
    double step_s, degrees, size, scale, rate; /* size 1: 1.9 m; scale: of the body's node; rate 0: chosen */
} nod;

static size_t put(float *to, size_t at, const float *from, size_t count)
{
    memcpy(to + at, from, count * sizeof *to);
    return at + count;
}

static const char *write_nod(const nod *n)
{
    const float s = (float)n->size, base[9] = { 0, 0, 0, 0.2f * s, 1.6f * s, 0, 0, 1.9f * s, 0.1f * s };
    const float ones[12] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
    const unsigned char of[12] = { 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0 };
    const uint32_t cubic = strcmp(n->interpolation, "CUBICSPLINE") == 0, values = n->keys * (cubic ? 3u : 1u);
    const char *path = test_path("nod.gltf"), *bin = test_path("nod.bin");
    static float numbers[4096], keys[2048], times[64];
    float binds[32] = { 0 };
    size_t at = 0;
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    for (int i = 0; i < 8; ++i) binds[(i / 4) * 16 + i % 4 * 5] = 1.0f;
    binds[16 + 13] = -1.6f * s;
    memset(keys, 0, sizeof keys);
    for (uint32_t k = 0; k < n->keys; ++k) {
        float *q = keys + (cubic ? k * 3u + 1u : k) * 4u;
        const double half = (k % 2 ? n->degrees : -0.3 * n->degrees) * 0.00872664626;
        times[k] = (float)(k * n->step_s);
        q[0] = (float)(0.8 * sin(half));
        q[2] = (float)(0.6 * sin(half));
        q[3] = (float)cos(half);
    }
    at = put(numbers, at, base, 9);
    memcpy(numbers + at, of, sizeof of);
    at = put(numbers, at + 3, ones, 12);
    at = put(numbers, at, binds, 32);
    at = put(numbers, at, times, n->keys);
    at = put(numbers, at, keys, values * 4u);
    test_write_file(bin, numbers, at * sizeof *numbers);
    fprintf(out, "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"nod.bin\",\"byteLength\":%zu}],", at * 4);
    fprintf(out,
            "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":12},"
            "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":96,\"byteLength\":128},"
            "{\"buffer\":0,\"byteOffset\":224,\"byteLength\":%u},{\"buffer\":0,\"byteOffset\":%u,\"byteLength\":%u}],",
            n->keys * 4, 224 + n->keys * 4, values * 16);
    fprintf(out,
            "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},{\"bufferView\":1,"
            "\"componentType\":5121,\"count\":3,\"type\":\"VEC4\"},{\"bufferView\":2,\"componentType\":5126,\"count\":"
            "3,\"type\":\"VEC4\"},{\"bufferView\":3,\"componentType\":5126,\"count\":2,\"type\":\"MAT4\"},{"
            "\"bufferView\":4,\"componentType\":5126,\"count\":%u,\"type\":\"SCALAR\"},{\"bufferView\":5,"
            "\"componentType\":5126,\"count\":%u,\"type\":\"VEC4\"}],",
            n->keys, values);
    fprintf(
        out,
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":2}}]}],"
        "\"nodes\":[{\"name\":\"n\",\"mesh\":0,\"skin\":0},{\"name\":\"body\",\"children\":[2],\"scale\":[%.9g,%.9g,"
        "%.9g]},{\"name\":\"head\",\"translation\":[0,%.9g,0]}],\"skins\":[{\"joints\":[1,2],"
        "\"inverseBindMatrices\":3}],",
        n->scale, n->scale, n->scale, 1.6 * n->size);
    fprintf(out,
            "\"animations\":[{\"name\":\"go\",\"samplers\":[{\"input\":4,\"output\":5,\"interpolation\":\"%s\"},{"
            "\"input\":4,\"output\":5,\"interpolation\":\"%s\"}],\"channels\":[{\"sampler\":0,\"target\":{\"node\":2,"
            "\"path\":\"rotation\"}},{\"sampler\":1,\"target\":{\"node\":1,\"path\":\"rotation\"}}]}]}",
            n->interpolation, n->interpolation);
    fclose(out);
    return path;
}

/* ---- the pack ---- */

static byte_buffer build(const char *path, double rate, char **said)
{
    byte_buffer out = { NULL, 0, 0, 0 };
    convert_options options = { 0 };
    convert_failure failure = { 0 };
    size_t bytes;
    options.source.sample_rate_hz = rate;
    options.clip.clip.effort = 1;
    options.report = tmpfile();
    assert_non_null(options.report);
    if (convert_files(&path, 1, &options, &out, &failure)) fail_msg("%s: %s", path, failure.error.what);
    bytes = (size_t)ftell(options.report);
    *said = test_zeros(bytes + 1u);
    rewind(options.report);
    assert_int_equal(fread(*said, 1, bytes, options.report), bytes);
    (void)fclose(options.report);
    return out;
}

static void said_of(const char *said, const char *clip, double *certified, double *frames, double *between)
{
    char start[80];
    const char *at;
    (void)snprintf(start, sizeof start, "clip '%s': ", clip);
    at = strstr(said, start);
    assert_non_null(at);
    assert_int_equal(sscanf(strstr(at, ", error "), ", error %lf cm", certified), 1);
    assert_int_equal(sscanf(strstr(at, "  vertices at most "),
                            "  vertices at most %lf cm off the source at frames, %lf cm between them", frames, between),
                     2);
}

static void matrix_of(const noh_transform *t, double *m)
{
    const double x = t->rotation[0], y = t->rotation[1], z = t->rotation[2], w = t->rotation[3];
    const double n = 2.0 / (x * x + y * y + z * z + w * w);
    const double r[9] = { 1 - n * (y * y + z * z), n * (x * y + z * w),     n * (x * z - y * w),
                          n * (x * y - z * w),     1 - n * (x * x + z * z), n * (y * z + x * w),
                          n * (x * z + y * w),     n * (y * z - x * w),     1 - n * (x * x + y * y) };
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < 3; i++) m[c * 4 + i] = r[c * 3 + i] * (double)t->scale[c];
        m[c * 4 + 3] = 0.0;
        m[12 + c] = (double)t->translation[c];
    }
    m[15] = 1.0;
}

static uint32_t joint_named(const noh_pack *pack, uint32_t count, const char *name)
{
    uint32_t j = 0;
    while (j < count && (!name || strcmp(noh_pack_joint_name(pack, 0, j), name) != 0)) j++;
    return j;
}

/* The worlds of nodes: joints as the pack has them, others as the file has them. */
static void pack_worlds(const oracle *o, const noh_pack *pack, const noh_skeleton *s, const noh_transform *pose,
                        double *worlds)
{
    double *object = test_zeros((size_t)s->joint_count * 16 * sizeof *object);
    for (uint32_t j = 0; j < s->joint_count; j++) {
        double local[16], *out = object + (size_t)j * 16;
        matrix_of(&pose[j], local);
        memcpy(out, local, sizeof local);
        for (int i = 0; s->parents[j] != NOH_JOINT_ROOT && i < 16; i++) {
            const double *up = object + (size_t)s->parents[j] * 16;
            out[i] = 0.0;
            for (int k = 0; k < 4; k++) out[i] += up[k * 4 + i % 4] * local[i / 4 * 4 + k];
        }
    }
    for (uint32_t n = 0; n < oracle_node_count(o); n++) {
        const uint32_t j = joint_named(pack, s->joint_count, oracle_node_name(o, n));
        if (j < s->joint_count) memcpy(worlds + (size_t)n * 16, object + (size_t)j * 16, 16 * sizeof *worlds);
    }
    free(object);
}

static double drawn_apart(const oracle *o, const double *a, const double *b)
{
    double worst = 0.0, weights[512] = { 0 };
    for (uint32_t n = 0; n < oracle_node_count(o); n++) {
        const int mesh = oracle_node_mesh(o, n);
        for (uint32_t p = 0; mesh >= 0 && oracle_node_skin(o, n) >= 0 && p < oracle_primitive_count(o, (uint32_t)mesh);
             p++) {
            const uint32_t count = oracle_vertex_count(o, (uint32_t)mesh, p);
            double *x = test_zeros((size_t)count * 3 * sizeof *x), *y = test_zeros((size_t)count * 3 * sizeof *y);
            oracle_drawn(o, n, p, a, weights, x);
            oracle_drawn(o, n, p, b, weights, y);
            for (size_t v = 0; v < count; v++) {
                double square = 0.0;
                for (size_t k = 0; k < 3; k++) square += (x[v * 3 + k] - y[v * 3 + k]) * (x[v * 3 + k] - y[v * 3 + k]);
                worst = fmax(worst, sqrt(square) * 100.0);
            }
            free(x);
            free(y);
        }
    }
    return worst;
}

/* The largest distance of a vertex at ticks nearest to frames (parts 1) or to parts between. */
static double measured(const oracle *o, int animation, const noh_pack *pack, const char *clip, uint32_t parts,
                       uint32_t skip)
{
    noh_clip_bank_desc desc;
    noh_clip_bank *bank;
    noh_skeleton s;
    const size_t nodes = oracle_node_count(o);
    double *locals = test_zeros(nodes * 10 * sizeof *locals), *a = test_zeros(nodes * 16 * sizeof *a);
    double *b = test_zeros(nodes * 16 * sizeof *b), worst = 0.0, rate;
    noh_transform *pose;
    noh_pack_clip packed;
    noh_clip_desc decoder = { 0 };
    noh_clip_info info;
    size_t size;
    uint32_t index;
    memset(&desc, 0, sizeof desc);
    desc.clips = pack;
    bank = test_clip_bank(&desc);
    index = noh_clip_bank_find(bank, clip);
    assert_true(index < bank->clips.clip_count);
    assert_int_equal(noh_pack_skeleton_at(pack, 0, &s, NULL, NULL), NOH_OK);
    pose = test_zeros(s.joint_count * sizeof *pose);
    assert_int_equal(noh_pack_clip_at(pack, bank->pack_clips[index], &packed, NULL), NOH_OK);
    decoder.bytes = packed.bytes;
    decoder.byte_count = packed.header->clip_bytes;
    decoder.bind = s.bind_pose;
    decoder.joint_count = s.joint_count;
    assert_int_equal(noh_clip_measure(&decoder, &info, &size, NULL), NOH_OK);
    rate = info.sample_rate_uhz * 1e-6;
    for (uint32_t part = 0; part <= parts * (info.frame_count - 1u); part += 1u + skip) {
        const double tick = fmin(floor(part * 48000.0 / (rate * parts) + 0.5), (double)info.duration_ticks);
        if (parts > 1 && part % parts == 0) continue;
        oracle_pose(o, animation, tick / 48000.0, locals);
        oracle_worlds(o, locals, a);
        memcpy(b, a, nodes * 16 * sizeof *b);
        bank->clips.sample(bank->clips.user, index, (uint32_t)tick, s.joint_count, pose, 0, NULL);
        pack_worlds(o, pack, &s, pose, b);
        worst = fmax(worst, drawn_apart(o, a, b));
    }
    free(pose);
    free(locals);
    free(a);
    free(b);
    free(bank);
    return worst;
}

static void check_clip(const oracle *o, int animation, const noh_pack *pack, const char *said, const char *clip,
                       uint32_t skip, double *between)
{
    double certified, frames, at, inside;
    said_of(said, clip, &certified, &frames, between);
    at = measured(o, animation, pack, clip, 1, skip);
    inside = measured(o, animation, pack, clip, 16, skip);
    print_message("'%s': %.3g cm at frames (said %.3g, certified %.3g), %.3g between (said %.3g)\n", clip, at, frames,
                  certified, inside, *between);
    assert_true(at <= frames * 1.001 + 1e-6 && at <= certified + 1e-4);
    assert_true(skip || at >= frames * 0.99 - 1e-6);
    assert_true(inside <= *between * 1.1 + 1e-6); /* it was looked for at eighths */
    assert_true(skip || inside >= *between * 0.9 - 1e-6);
}

/* ---- tests ---- */

static void what_is_said_of_vertices_is_true(void **state)
{
    static const nod cases[] = { { "CUBICSPLINE", 5, 0.5, 40, 1, 1, 0 },     { "LINEAR", 5, 0.5, 60, 1, 1, 0 },
                                 { "LINEAR", 30, 1.0 / 24, 124, 1, 1, 0 },   { "LINEAR", 7, 0.0613, 70, 1, 1, 0 },
                                 { "CUBICSPLINE", 5, 0.5, 40, 0.01, 1, 0 },  { "LINEAR", 5, 0.5, 60, 0.01, 1, 0 },
                                 { "CUBICSPLINE", 5, 0.5, 40, 1, 1, 29.97 }, { "LINEAR", 9, 0.11, 90, 1, 1, 90 },
                                 { "LINEAR", 9, 0.1, 90, 1, 1.00002, 60 },   { "LINEAR", 9, 0.11, 90, 1, 1.00002, 90 },
                                 { "CUBICSPLINE", 5, 0.5, 40, 300, 1, 0 } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        const char *path = write_nod(&cases[i]);
        oracle *o = oracle_read(path);
        char *said;
        byte_buffer out = build(path, cases[i].rate, &said);
        uint8_t *bytes = test_aligned(out.bytes, out.count);
        noh_pack pack = test_open(bytes, out.count);
        double between, certified, frames;
        check_clip(o, 0, &pack, said, "go", 0, &between);
        said_of(said, "go", &certified, &frames, &between);
        if (!(cases[i].rate > 0.0)) {
            assert_true(between <= 190.0 * cases[i].size * 2.2e-3);
            assert_true(certified <= 0.01 + 1e-6 || i == 3); /* whose frames lie between ticks */
            assert_true(cases[i].size >= 1.0 || frames <= 1e-4);
        }
        oracle_free(o);
        buffer_free(&out);
        free(bytes);
        free(said);
    }
}

static void real_characters(void **state)
{
    static const struct {
        const char *file, *clip;
    } cases[] = { { "khronos/Fox.glb", "Survey" },
                  { "khronos/Fox.glb", "Walk" },
                  { "khronos/RobotExpressive.glb", "Punch" } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        const char *path = test_asset(cases[i].file);
        oracle *o = oracle_read(path);
        char *said;
        byte_buffer out = build(path, 0.0, &said);
        uint8_t *bytes = test_aligned(out.bytes, out.count);
        noh_pack pack = test_open(bytes, out.count);
        double between;
        int animation = 0;
        while (strcmp(oracle_animation_name(o, (uint32_t)animation), cases[i].clip) != 0) animation++;
        if (!strstr(said, "the clip begins there")) /* the oracle knows of no shift */
            check_clip(o, animation, &pack, said, cases[i].clip, 6, &between);
        oracle_free(o);
        buffer_free(&out);
        free(bytes);
        free(said);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(what_is_said_of_vertices_is_true),
    cmocka_unit_test(real_characters),
};

TEST_MAIN(tests, NULL, NULL)
