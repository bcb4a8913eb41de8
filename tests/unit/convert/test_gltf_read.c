/* test_gltf_read.c: the converter's glTF reader.
 *
 * Every file is written by the test itself: a `scene` collects bytes, buffer
 * views and accessors, and is saved as .gltf (data URI) or .glb. */
#define _POSIX_C_SOURCE 200809L

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>
#include <meshoptimizer.h>

#include "convert/base/file_kind.h"
#include "convert/base/input_file.h"
#include "convert/model/model.h"
#include "support/support.h"
#include "noh/format.h"

enum { I8 = 5120, U8 = 5121, I16 = 5122, U16 = 5123, U32 = 5125, F32 = 5126 };

typedef struct scene {
    unsigned char bytes[16384];
    size_t size;
    char views[8192], accessors[8192], primitives[8192], mesh_rest[2048], rest[8192];
    char buffer_rest[1024]; /* more buffers */
    int view_count, accessor_count, quantized;
} scene;

static char folder[64];
static char file_path[128];

/* --- writing files --- */

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
static void
append(char *text, size_t capacity, const char *format, ...)
{
    size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    int written = vsnprintf(text + used, capacity - used, format, arguments);
    va_end(arguments);
    assert_true(written >= 0 && (size_t)written < capacity - used);
}
#define APPEND(text, ...) append(text, sizeof(text), __VA_ARGS__)

static scene *scene_new(void)
{
    scene *s = calloc(1, sizeof *s);
    assert_non_null(s);
    return s;
}

static size_t add_bytes(scene *s, const void *data, size_t bytes)
{
    size_t offset = (s->size + 3) / 4 * 4;
    assert_true(offset + bytes <= sizeof s->bytes);
    if (bytes) memcpy(s->bytes + offset, data, bytes);
    s->size = offset + bytes;
    return offset;
}

/* stride 0 = tightly packed */
static int add_view(scene *s, const void *data, size_t bytes, int stride)
{
    size_t offset = add_bytes(s, data, bytes);
    APPEND(s->views, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu", s->view_count ? "," : "", offset, bytes);
    if (stride) APPEND(s->views, ",\"byteStride\":%d", stride);
    APPEND(s->views, "}");
    return s->view_count++;
}

/* rest: more JSON members, from their comma on */
static int add_accessor(scene *s, int component, int count, const char *type, const char *rest)
{
    APPEND(s->accessors, "%s{\"componentType\":%d,\"count\":%d,\"type\":\"%s\"%s}", s->accessor_count ? "," : "",
           component, count, type, rest);
    return s->accessor_count++;
}

static int add_array(scene *s, const void *data, size_t bytes, int component, int count, const char *type)
{
    char rest[64];
    snprintf(rest, sizeof rest, ",\"bufferView\":%d", add_view(s, data, bytes, 0));
    return add_accessor(s, component, count, type, rest);
}

static const char base64_digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

static void write_base64(FILE *out, const unsigned char *bytes, size_t count)
{
    for (size_t i = 0; i < count; i += 3) {
        unsigned long word = (unsigned long)bytes[i] << 16;
        word |= i + 1 < count ? (unsigned long)bytes[i + 1] << 8 : 0;
        word |= i + 2 < count ? (unsigned long)bytes[i + 2] : 0;
        for (size_t k = 0; k < 4; ++k) fputc(i + k > count ? '=' : base64_digits[(word >> (18 - 6 * k)) & 63], out);
    }
}

static void write_json(const scene *s, FILE *out, int embed)
{
    fprintf(out, "{\"asset\":{\"version\":\"2.0\"}");
    if (s->quantized) fprintf(out, ",\"extensionsUsed\":[\"KHR_mesh_quantization\"]");
    if (s->size) {
        fprintf(out, ",\"buffers\":[{\"byteLength\":%zu", s->size);
        if (embed) {
            fprintf(out, ",\"uri\":\"data:application/octet-stream;base64,");
            write_base64(out, s->bytes, s->size);
            fprintf(out, "\"");
        }
        fprintf(out, "}%s]", s->buffer_rest);
    }
    if (s->view_count) fprintf(out, ",\"bufferViews\":[%s]", s->views);
    if (s->accessor_count) fprintf(out, ",\"accessors\":[%s]", s->accessors);
    if (s->primitives[0])
        fprintf(out, ",\"meshes\":[{\"name\":\"m\",\"primitives\":[%s]%s}]", s->primitives, s->mesh_rest);
    fprintf(out, "%s}", s->rest);
}

static void write_text(const char *name, const char *text)
{
    snprintf(file_path, sizeof file_path, "%s/%s", folder, name);
    FILE *out = fopen(file_path, "wb");
    assert_non_null(out);
    fputs(text, out);
    fclose(out);
}

static void save_gltf(const scene *s)
{
    static char json[32768];
    snprintf(file_path, sizeof file_path, "%s/test.gltf", folder);
    FILE *out = fopen(file_path, "wb+");
    assert_non_null(out);
    write_json(s, out, 0);
    rewind(out);
    json[fread(json, 1, sizeof json - 1, out)] = 0;
    test_keep_glb_seed(json, s->bytes, s->size);
    fclose(out);
    out = fopen(file_path, "wb");
    assert_non_null(out);
    write_json(s, out, 1);
    fclose(out);
}

static void write_u32(FILE *out, size_t value)
{
    for (int i = 0; i < 4; ++i) fputc((int)(value >> (8 * i) & 255), out);
}

static void pad(FILE *out, size_t bytes, int with)
{
    for (size_t i = bytes; i % 4; ++i) fputc(with, out);
}

/* The JSON is written to a file of its own first, to know its length. */
static void save_glb(const scene *s)
{
    char json_path[128];
    static char json[32768];
    snprintf(json_path, sizeof json_path, "%s/json", folder);
    FILE *text = fopen(json_path, "wb+");
    assert_non_null(text);
    write_json(s, text, 0);
    rewind(text);
    size_t bytes = fread(json, 1, sizeof json, text), padded = (bytes + 3) / 4 * 4, bin = (s->size + 3) / 4 * 4;
    fclose(text);
    snprintf(file_path, sizeof file_path, "%s/test.glb", folder);
    FILE *out = fopen(file_path, "wb");
    assert_non_null(out);
    fputs("glTF", out);
    write_u32(out, 2);
    write_u32(out, 12 + 8 + padded + 8 + bin);
    write_u32(out, padded);
    fputs("JSON", out);
    fwrite(json, 1, bytes, out);
    pad(out, bytes, ' ');
    write_u32(out, bin);
    fwrite("BIN", 1, 4, out);
    fwrite(s->bytes, 1, s->size, out);
    pad(out, s->size, 0);
    fclose(out);
}

/* --- loading, and what to expect --- */

static model *load_file(void)
{
    model *m = NULL;
    model_error error = { "", "" };
    if (model_read_gltf(file_path, &m, &error)) fail_msg("refused: %s (%s)", error.what, error.where);
    assert_non_null(m);
    return m;
}

/* Saves, frees the scene, and loads. */
static model *load(scene *s)
{
    save_gltf(s);
    free(s);
    return load_file();
}

static void file_refused(const char *what, const char *where)
{
    model *m = (model *)(void *)file_path;
    model_error error = { "", "" };
    assert_int_equal(model_read_gltf(file_path, &m, &error), 1);
    assert_null(m);
    if (!strstr(error.what, what) || !strstr(error.where, where))
        fail_msg("expected '%s' at '%s', got '%s' at '%s'", what, where, error.what, error.where);
}

static void refused(scene *s, const char *what, const char *where)
{
    save_gltf(s);
    free(s);
    file_refused(what, where);
}

static void assert_floats(const float *actual, const float *expected, size_t count)
{
    for (size_t i = 0; i < count; ++i)
        if (!(fabs((double)actual[i] - (double)expected[i]) <= 1e-6))
            fail_msg("element %zu is %g, not %g", i, (double)actual[i], (double)expected[i]);
}

static int has_warning(const model *m, const char *text)
{
    for (uint32_t i = 0; i < m->warning_count; ++i)
        if (strstr(m->warnings[i], text)) return 1;
    return 0;
}

/* --- scenes to start from --- */

static const float triangle_positions[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };

/* A triangle in the xy plane: accessor 0. `more` goes into the primitive, from its comma on. */
static scene *triangle(const char *more_attributes, const char *more)
{
    scene *s = scene_new();
    add_array(s, triangle_positions, sizeof triangle_positions, F32, 3, "VEC3");
    APPEND(s->primitives, "{\"attributes\":{\"POSITION\":0%s}%s}", more_attributes, more);
    return s;
}

/* A triangle that follows the first joint. */
static scene *skinned_triangle(void)
{
    static const uint8_t joints[12] = { 0 };
    static const float weights[12] = { 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0 };
    scene *s = triangle(",\"JOINTS_0\":1,\"WEIGHTS_0\":2", "");
    add_array(s, joints, sizeof joints, U8, 3, "VEC4");
    add_array(s, weights, sizeof weights, F32, 3, "VEC4");
    return s;
}

/* A triangle with one target whose deltas are accessor 1. */
static scene *morphing(const float *deltas, const char *more)
{
    scene *s = triangle("", more);
    add_array(s, deltas, 9 * sizeof *deltas, F32, 3, "VEC3");
    return s;
}

static const float up_deltas[9] = { 0, 0, 0, 0, 0, 1, 0, 0, 0 };
#define ONE_TARGET ",\"targets\":[{\"POSITION\":1}]"

/* --- encodings --- */

static void triangle_without_indices(void **state)
{
    (void)state;
    model *m = load(triangle("", ""));
    assert_int_equal(m->mesh_count, 1);
    assert_int_equal(m->meshes[0].vertex_count, 3);
    assert_int_equal(m->meshes[0].index_count, 3);
    assert_floats(m->meshes[0].position, triangle_positions, 9);
    for (uint32_t i = 0; i < 3; ++i) assert_int_equal(m->meshes[0].indices[i], i);
    assert_string_equal(m->meshes[0].name, "m");
    model_free(m);
}

static void check_indices(const void *data, size_t bytes, int component)
{
    scene *s = triangle("", ",\"indices\":1");
    add_array(s, data, bytes, component, 3, "SCALAR");
    model *m = load(s);
    const uint32_t expected[3] = { 2, 0, 1 };
    assert_memory_equal(m->meshes[0].indices, expected, sizeof expected);
    model_free(m);
}

static void indices_of_every_size(void **state)
{
    (void)state;
    const uint8_t u8[3] = { 2, 0, 1 };
    const uint16_t u16[3] = { 2, 0, 1 };
    const uint32_t u32[3] = { 2, 0, 1 };
    check_indices(u8, sizeof u8, U8);
    check_indices(u16, sizeof u16, U16);
    check_indices(u32, sizeof u32, U32);
}

static void binary_container(void **state)
{
    (void)state;
    scene *s = triangle("", "");
    save_glb(s);
    free(s);
    model *m = load_file();
    assert_floats(m->meshes[0].position, triangle_positions, 9);
    model_free(m);
}

static void write_positions(const char *name)
{
    snprintf(file_path, sizeof file_path, "%s/%s", folder, name);
    FILE *out = fopen(file_path, "wb");
    assert_non_null(out);
    fwrite(triangle_positions, 1, sizeof triangle_positions, out);
    fclose(out);
}

static void write_gltf_of(const char *uri)
{
    char text[8192];
    snprintf(text, sizeof text,
             "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,\"uri\":\"%s\"}],"
             "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
             "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}",
             uri);
    write_text("test.gltf", text);
}

static void buffer_in_a_file_beside(void **state)
{
    (void)state;
    snprintf(file_path, sizeof file_path, "%s/Parts", folder);
    mkdir(file_path, 0777);
    write_positions("a b.bin");
    write_positions("Parts/a.bin");
    write_positions("c%20d.bin");
    const char *const uris[] = { "a%20b.bin", "A%20b.Bin", "parts/A.BIN", "./Parts/../parts/a.bin", "c%20d.bin" };
    for (size_t i = 0; i < sizeof uris / sizeof *uris; ++i) {
        write_gltf_of(uris[i]);
        model *m = load_file();
        assert_floats(m->meshes[0].position, triangle_positions, 9);
        assert_string_equal(m->meshes[0].name, "mesh_0");
        model_free(m);
    }
}

/* Of several folders whose names differ in case, all are searched; a name that comes back to a folder is no endless
 * search. */
static void files_are_found_in_any_folder_of_a_name(void **state)
{
    (void)state;
    static const char *const folders[] = { "Kit", "kIt", "kit", "kit/Skin", "kit/skin" };
    char path[4096], found[4096];
    for (size_t i = 0; i < sizeof folders / sizeof folders[0]; i++) {
        snprintf(file_path, sizeof file_path, "%s/%s", folder, folders[i]);
        mkdir(file_path, 0777);
    }
    write_positions("kit/skin/a.bin");
    static const char *const uris[] = { "Kit/Skin/a.bin", "KIT/Skin/A.bin", "kit/SKIN/a.bin" };
    for (size_t i = 0; i < sizeof uris / sizeof uris[0]; i++) {
        write_gltf_of(uris[i]);
        model *m = load_file();
        assert_floats(m->meshes[0].position, triangle_positions, 9);
        model_free(m);
    }
    write_positions("Kit/A.bin");
    snprintf(path, sizeof path, "%s/kit/../KIT/a.bin", folder);
    assert_true(input_find_any_case(path, found, sizeof found));
    assert_true(strlen(found) == strlen(path) && strstr(found, "/kit/../Kit/A.bin"));
    int used = snprintf(path, sizeof path, "%s/", folder);
    while (used < 4000) used += snprintf(path + used, sizeof path - (size_t)used, "Kit/../");
    snprintf(path + used, sizeof path - (size_t)used, "none.bin");
    assert_false(input_find_any_case(path, found, sizeof found));
    const input_held files[] = { { "in/Tex/b.png", "", 0 }, { "in/tex/a.png", "", 0 }, { "in/tEx/A.png", "", 0 } };
    inputs_hold(files, 3);
    assert_true(input_find_any_case("in/Tex/a.png", found, sizeof found));
    assert_string_equal(found, "in/tEx/A.png");
    assert_true(input_find_any_case("in/tex/A.png", found, sizeof found));
    assert_string_equal(found, "in/tex/a.png");
    inputs_hold(NULL, 0);
}

/* Of files in memory: folders in any case, and names longer than a path. */
static void held_names_are_found_in_any_case(void **state)
{
    (void)state;
    static char longest[5008];
    const input_held files[] = { { "in/B/Textures/wood.png", "", 0 }, { "in/b/x.png", "", 0 }, { longest, "", 0 } };
    char found[64];
    memset(longest, 'a', 5000);
    memcpy(longest + 5000, "/b.bin", 7);
    inputs_hold(files, 3);
    assert_true(input_find_any_case("./in/B/textures/Wood.PNG", found, sizeof found));
    assert_string_equal(found, "./in/B/Textures/wood.png");
    assert_true(input_find_any_case("in/b/x.png", found, sizeof found));
    assert_true(input_find_any_case("IN/B/X.PNG", found, 11));
    assert_string_equal(found, "in/b/x.png");
    assert_false(input_find_any_case("in/b/X.PNG", found, 10));
    assert_false(input_find_any_case("in/b/wood.png", found, sizeof found));
    assert_false(input_find_any_case(longest, found, sizeof found));
    inputs_hold(NULL, 0);
}

/* No file is opened and nothing is written past a buffer. */
static void long_names_are_refused(void **state)
{
    (void)state;
    static char text[8192], uri[5008];
    memset(uri, 'a', 5000);
    memcpy(uri + 5000, "/b.bin", 7);
    write_gltf_of(uri);
    snprintf(file_path, sizeof file_path, "%s/test.gltf", folder);
    FILE *in = fopen(file_path, "rb");
    assert_non_null(in);
    const input_held file = { "test.gltf", text, fread(text, 1, sizeof text, in) };
    fclose(in);
    for (int held = 0; held < 2; ++held) {
        model *m = NULL;
        model_error error;
        if (held) inputs_hold(&file, 1);
        assert_int_equal(model_read_gltf(held ? "test.gltf" : file_path, &m, &error), 1);
        inputs_hold(NULL, 0);
    }
}

static void interleaved_attributes(void **state)
{
    (void)state;
    const float data[15] = { 0, 0, 0, 0.5f, 0.25f, 1, 0, 0, 1, 0.25f, 0, 1, 0, 0, 1 };
    scene *s = scene_new();
    add_view(s, data, sizeof data, 20);
    add_accessor(s, F32, 3, "VEC3", ",\"bufferView\":0");
    add_accessor(s, F32, 3, "VEC2", ",\"bufferView\":0,\"byteOffset\":12");
    APPEND(s->primitives, "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1}}");
    model *m = load(s);
    const float uv[6] = { 0.5f, 0.25f, 1, 0.25f, 0, 1 };
    assert_floats(m->meshes[0].position, triangle_positions, 9);
    assert_floats(m->meshes[0].uv, uv, 6);
    model_free(m);
}

/* Accessor 1 is sparse: element 1 becomes (0 0 1). base: JSON from its comma on, or empty */
static model *load_sparse(const char *base_of_target, const float *base)
{
    const uint16_t index[1] = { 1 };
    const float value[3] = { 0, 0, 1 };
    char rest[256];
    scene *s = triangle("", ONE_TARGET);
    int indices = add_view(s, index, sizeof index, 0), values = add_view(s, value, sizeof value, 0);
    if (base) add_view(s, base, 9 * sizeof *base, 0);
    snprintf(rest, sizeof rest,
             "%s,\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":%d,\"componentType\":5123},"
             "\"values\":{\"bufferView\":%d}}",
             base_of_target, indices, values);
    add_accessor(s, F32, 3, "VEC3", rest);
    return load(s);
}

static void sparse_with_a_base(void **state)
{
    (void)state;
    const float base[9] = { 1, 2, 3, 4, 5, 6, 7, 8, 9 }, expected[9] = { 1, 2, 3, 0, 0, 1, 7, 8, 9 };
    model *m = load_sparse(",\"bufferView\":3", base);
    assert_floats(m->meshes[0].targets[0].position, expected, 9);
    model_free(m);
}

static void sparse_without_a_base(void **state)
{
    (void)state;
    model *m = load_sparse("", NULL);
    assert_memory_equal(m->meshes[0].targets[0].position, up_deltas, sizeof up_deltas);
    model_free(m);
}

static void accessor_without_bytes_is_zero(void **state)
{
    (void)state;
    const float zeros[9] = { 0 };
    scene *s = triangle("", ONE_TARGET);
    add_accessor(s, F32, 3, "VEC3", "");
    model *m = load(s);
    assert_int_equal(m->meshes[0].target_count, 1);
    assert_memory_equal(m->meshes[0].targets[0].position, zeros, sizeof zeros);
    assert_memory_equal(m->meshes[0].targets[0].normal, zeros, sizeof zeros);
    model_free(m);
}

/* Three vertices (a b c) of one component type, four components apart. */
static void check_quantized(int component, int normalized, const void *data, size_t bytes, int stride,
                            const float *expected)
{
    scene *s = scene_new();
    s->quantized = 1;
    add_view(s, data, bytes, stride);
    add_accessor(s, component, 3, "VEC3", normalized ? ",\"normalized\":true,\"bufferView\":0" : ",\"bufferView\":0");
    APPEND(s->primitives, "{\"attributes\":{\"POSITION\":0}}");
    model *m = load(s);
    assert_floats(m->meshes[0].position, expected, 9);
    model_free(m);
}

static void quantized_positions(void **state)
{
    (void)state;
    const int8_t i8[12] = { -128, 0, 127, 0, 1, 0, 0, 0, 0, 2, 0, 0 };
    const uint8_t u8[12] = { 0, 51, 255, 0, 1, 0, 0, 0, 0, 2, 0, 0 };
    const int16_t i16[12] = { -32768, 0, 32767, 0, 1, 0, 0, 0, 0, 2, 0, 0 };
    const uint16_t u16[12] = { 0, 13107, 65535, 0, 1, 0, 0, 0, 0, 2, 0, 0 };
    const float plain_i8[9] = { -128, 0, 127, 1, 0, 0, 0, 2, 0 }, plain_u8[9] = { 0, 51, 255, 1, 0, 0, 0, 2, 0 };
    const float plain_i16[9] = { -32768, 0, 32767, 1, 0, 0, 0, 2, 0 },
                plain_u16[9] = { 0, 13107, 65535, 1, 0, 0, 0, 2, 0 };
    const float n_i8[9] = { -1, 0, 1, 1 / 127.0f, 0, 0, 0, 2 / 127.0f, 0 };
    const float n_u8[9] = { 0, 0.2f, 1, 1 / 255.0f, 0, 0, 0, 2 / 255.0f, 0 };
    const float n_i16[9] = { -1, 0, 1, 1 / 32767.0f, 0, 0, 0, 2 / 32767.0f, 0 };
    const float n_u16[9] = { 0, 0.2f, 1, 1 / 65535.0f, 0, 0, 0, 2 / 65535.0f, 0 };
    check_quantized(I8, 0, i8, sizeof i8, 4, plain_i8);
    check_quantized(I8, 1, i8, sizeof i8, 4, n_i8);
    check_quantized(U8, 0, u8, sizeof u8, 4, plain_u8);
    check_quantized(U8, 1, u8, sizeof u8, 4, n_u8);
    check_quantized(I16, 0, i16, sizeof i16, 8, plain_i16);
    check_quantized(I16, 1, i16, sizeof i16, 8, n_i16);
    check_quantized(U16, 0, u16, sizeof u16, 8, plain_u16);
    check_quantized(U16, 1, u16, sizeof u16, 8, n_u16);
}

static void quantized_attributes_and_deltas(void **state)
{
    (void)state;
    const int8_t normal[12] = { 0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0 },
                 tangent[12] = { 127, 0, 0, -127, 127, 0, 0, -127, 127, 0, 0, -127 };
    const int16_t delta[12] = { 0, 0, 0, 0, 0, 0, 32767, 0, 0, 0, 0, 0 };
    const uint16_t uv[6] = { 0, 0, 65535, 0, 0, 65535 };
    scene *s = triangle(",\"NORMAL\":1,\"TANGENT\":2,\"TEXCOORD_0\":3", ",\"targets\":[{\"POSITION\":4,\"NORMAL\":5}]");
    s->quantized = 1;
    char rest[64];
    snprintf(rest, sizeof rest, ",\"normalized\":true,\"bufferView\":%d", add_view(s, normal, sizeof normal, 4));
    add_accessor(s, I8, 3, "VEC3", rest);
    snprintf(rest, sizeof rest, ",\"normalized\":true,\"bufferView\":%d", add_view(s, tangent, sizeof tangent, 4));
    add_accessor(s, I8, 3, "VEC4", rest);
    snprintf(rest, sizeof rest, ",\"normalized\":true,\"bufferView\":%d", add_view(s, uv, sizeof uv, 0));
    add_accessor(s, U16, 3, "VEC2", rest);
    int view = add_view(s, delta, sizeof delta, 8);
    snprintf(rest, sizeof rest, ",\"normalized\":true,\"bufferView\":%d", view);
    add_accessor(s, I16, 3, "VEC3", rest);
    add_accessor(s, I16, 3, "VEC3", rest);
    model *m = load(s);
    const float normals[9] = { 0, 0, 1, 0, 0, 1, 0, 0, 1 }, tangents[12] = { 1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1 };
    const float uvs[6] = { 0, 0, 1, 0, 0, 1 };
    assert_floats(m->meshes[0].normal, normals, 9);
    assert_floats(m->meshes[0].tangent, tangents, 12);
    assert_floats(m->meshes[0].uv, uvs, 6);
    assert_floats(m->meshes[0].targets[0].position, up_deltas, 9);
    assert_floats(m->meshes[0].targets[0].normal, up_deltas, 9);
    model_free(m);
}

/* --- EXT_meshopt_compression --- */

/* A view whose bytes are compressed, over a fallback buffer that has no data. */
static int add_compressed_view(scene *s, const unsigned char *data, size_t bytes, size_t count, size_t stride,
                               const char *mode, const char *filter)
{
    size_t offset = add_bytes(s, data, bytes);
    snprintf(s->buffer_rest, sizeof s->buffer_rest,
             ",{\"byteLength\":4096,\"extensions\":{\"EXT_meshopt_compression\":{\"fallback\":true}}}");
    APPEND(s->views, "%s{\"buffer\":1,\"byteLength\":%zu,", s->view_count ? "," : "", count * stride);
    if (strcmp(mode, "ATTRIBUTES") == 0) APPEND(s->views, "\"byteStride\":%zu,", stride);
    APPEND(s->views,
           "\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,"
           "\"byteStride\":%zu,\"count\":%zu,\"mode\":\"%s\",\"filter\":\"%s\"}}}",
           offset, bytes, stride, count, mode, filter);
    return s->view_count++;
}

static int add_compressed(scene *s, const void *vertices, size_t count, size_t stride, const char *filter)
{
    unsigned char packed[1024];
    size_t bytes = meshopt_encodeVertexBuffer(packed, sizeof packed, vertices, count, stride);
    assert_true(bytes > 0);
    return add_compressed_view(s, packed, bytes, count, stride, "ATTRIBUTES", filter);
}

static scene *compressed_triangle(const char *more_attributes, const char *more)
{
    scene *s = scene_new();
    add_compressed(s, triangle_positions, 3, 12, "NONE");
    add_accessor(s, F32, 3, "VEC3", ",\"bufferView\":0");
    APPEND(s->primitives, "{\"attributes\":{\"POSITION\":0%s}%s}", more_attributes, more);
    APPEND(s->rest, ",\"extensionsRequired\":[\"EXT_meshopt_compression\"]");
    return s;
}

static void meshopt_attributes_and_triangles(void **state)
{
    (void)state;
    const unsigned int index[3] = { 0, 1, 2 };
    unsigned char packed[256];
    scene *s = compressed_triangle("", ",\"indices\":1");
    size_t bytes = meshopt_encodeIndexBuffer(packed, sizeof packed, index, 3);
    add_compressed_view(s, packed, bytes, 3, 2, "TRIANGLES", "NONE");
    add_accessor(s, U16, 3, "SCALAR", ",\"bufferView\":1");
    model *m = load(s);
    assert_floats(m->meshes[0].position, triangle_positions, 9);
    assert_int_equal(m->meshes[0].indices[0] + m->meshes[0].indices[1] + m->meshes[0].indices[2], 3);
    model_free(m);
}

static void meshopt_index_sequence(void **state)
{
    (void)state;
    const unsigned int index[3] = { 2, 0, 1 };
    unsigned char packed[256];
    scene *s = compressed_triangle("", ",\"indices\":1");
    size_t bytes = meshopt_encodeIndexSequence(packed, sizeof packed, index, 3);
    add_compressed_view(s, packed, bytes, 3, 4, "INDICES", "NONE");
    add_accessor(s, U32, 3, "SCALAR", ",\"bufferView\":1");
    model *m = load(s);
    assert_int_equal(m->meshes[0].indices[0], 2);
    model_free(m);
}

static void meshopt_octahedral_and_exponential(void **state)
{
    (void)state;
    const float normal[12] = { 0, 0, 1, 0, 0, 0.6f, 0.8f, 0, 1, 0, 0, 0 }, uv[6] = { 0.5f, 0.25f, 1, 0.25f, 0, 1 };
    const float expected[9] = { 0, 0, 1, 0, 0.6f, 0.8f, 1, 0, 0 };
    int16_t oct[12];
    uint32_t exponential[6];
    scene *s = compressed_triangle(",\"NORMAL\":1,\"TEXCOORD_0\":2", "");
    s->quantized = 1;
    meshopt_encodeFilterOct(oct, 3, 8, 16, normal);
    add_compressed(s, oct, 3, 8, "OCTAHEDRAL");
    add_accessor(s, I16, 3, "VEC3", ",\"normalized\":true,\"bufferView\":1");
    meshopt_encodeFilterExp(exponential, 3, 8, 15, uv);
    add_compressed(s, exponential, 3, 8, "EXPONENTIAL");
    add_accessor(s, F32, 3, "VEC2", ",\"bufferView\":2");
    model *m = load(s);
    for (size_t i = 0; i < 9; ++i) assert_true(fabs((double)m->meshes[0].normal[i] - (double)expected[i]) < 1e-4);
    assert_floats(m->meshes[0].uv, uv, 6);
    model_free(m);
}

static void meshopt_quaternion(void **state)
{
    (void)state;
    const float rotation[8] = { 0, 0, 0, 1, 0.6f, 0, 0, 0.8f }, times[2] = { 0, 1 };
    int16_t quat[8];
    scene *s = compressed_triangle("", "");
    add_array(s, times, sizeof times, F32, 2, "SCALAR");
    meshopt_encodeFilterQuat(quat, 2, 8, 16, rotation);
    add_compressed(s, quat, 2, 8, "QUATERNION");
    add_accessor(s, I16, 2, "VEC4", ",\"normalized\":true,\"bufferView\":2");
    APPEND(s->rest, ",\"nodes\":[{\"mesh\":0}],\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":"
                    "{\"node\":0,\"path\":\"rotation\"}}],\"samplers\":[{\"input\":1,\"output\":2}]}]");
    model *m = load(s);
    for (size_t i = 0; i < 8; ++i)
        assert_true(fabs((double)m->clips[0].channels[0].values[i] - (double)rotation[i]) < 1e-3);
    model_free(m);
}

static void meshopt_damage_is_refused(void **state)
{
    (void)state;
    const unsigned char junk[40] = { 0x55 };
    scene *s = triangle("", ",\"indices\":1");
    add_compressed_view(s, junk, sizeof junk, 3, 2, "TRIANGLES", "NONE");
    add_accessor(s, U16, 3, "SCALAR", ",\"bufferView\":1");
    refused(s, "compressed data is damaged", "mesh 'm' primitive 0 indices (accessor 1), buffer view 1");
}

static void meshopt_impossible_sizes_are_refused(void **state)
{
    (void)state;
    const unsigned char junk[40] = { 0xa0 };
    scene *s = triangle("", ",\"indices\":1");
    add_compressed_view(s, junk, sizeof junk, 30000, 2, "TRIANGLES", "NONE");
    add_accessor(s, U16, 3, "SCALAR", ",\"bufferView\":1");
    refused(s, "cannot hold 30000 elements", "buffer view 1");
    s = triangle("", ",\"indices\":1");
    add_compressed_view(s, junk, sizeof junk, 4, 2, "TRIANGLES", "NONE");
    add_accessor(s, U16, 3, "SCALAR", ",\"bufferView\":1");
    refused(s, "multiple of 3", "buffer view 1");
    s = triangle(",\"NORMAL\":1", "");
    add_compressed_view(s, junk, sizeof junk, 3, 12, "ATTRIBUTES", "OCTAHEDRAL");
    add_accessor(s, F32, 3, "VEC3", ",\"bufferView\":1");
    model *m = load(s);
    assert_true(has_warning(m, "'OCTAHEDRAL' is unknown or does not fit 'byteStride'; normals were computed"));
    model_free(m);
}

/* The ratified name, and its newer codec, which is named. */
static void meshopt_of_khronos(void **state)
{
    (void)state;
    scene *s = compressed_triangle("", "");
    char *at;
    for (char *text = s->views; (at = strstr(text, "EXT_meshopt")); text = at) memcpy(at, "KHR", 3);
    for (char *text = s->buffer_rest; (at = strstr(text, "EXT_meshopt")); text = at) memcpy(at, "KHR", 3);
    memcpy(strstr(s->rest, "EXT_meshopt"), "KHR", 3);
    model *m = load(s);
    assert_floats(m->meshes[0].position, triangle_positions, 9);
    assert_int_equal(m->warning_count, 0);
    model_free(m);
    s = compressed_triangle("", "");
    s->bytes[0] = 0xa1;
    refused(s, "codec version 1 is not read: compress the file with version 0", "buffer view 0");
}

/* --- primitives --- */

static void check_unrolled(int mode, const uint32_t *expected)
{
    const float square[12] = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0 };
    scene *s = scene_new();
    add_array(s, square, sizeof square, F32, 4, "VEC3");
    APPEND(s->primitives, "{\"attributes\":{\"POSITION\":0},\"mode\":%d}", mode);
    model *m = load(s);
    assert_int_equal(m->meshes[0].index_count, 6);
    assert_memory_equal(m->meshes[0].indices, expected, 6 * sizeof *expected);
    model_free(m);
}

static void strips_and_fans(void **state)
{
    (void)state;
    const uint32_t strip[6] = { 0, 1, 2, 1, 3, 2 }, fan[6] = { 1, 2, 0, 2, 3, 0 };
    check_unrolled(5, strip);
    check_unrolled(6, fan);
}

static void points_and_lines_are_skipped(void **state)
{
    (void)state;
    scene *s = triangle("", ",\"mode\":0");
    APPEND(s->primitives, ",{\"attributes\":{\"POSITION\":0},\"mode\":1},{\"attributes\":{\"POSITION\":0}}");
    model *m = load(s);
    assert_int_equal(m->meshes[0].submesh_count, 1);
    assert_true(has_warning(
        m, "mesh 'm' primitive 0 was skipped: it holds points or lines, not triangles (and 1 more like it)"));
    model_free(m);
}

static void primitives_are_concatenated(void **state)
{
    (void)state;
    const float uv[6] = { 0, 0, 1, 0, 0, 1 };
    const uint8_t color[12] = { 255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 51 };
    scene *s = triangle("", ",\"material\":1");
    add_array(s, uv, sizeof uv, F32, 3, "VEC2");
    char rest[64];
    snprintf(rest, sizeof rest, ",\"normalized\":true,\"bufferView\":%d", add_view(s, color, sizeof color, 0));
    add_accessor(s, U8, 3, "VEC4", rest);
    APPEND(s->primitives, ",{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1,\"COLOR_0\":2},\"material\":0}");
    APPEND(s->rest, ",\"materials\":[{\"name\":\"a\"},{\"name\":\"b\"}]");
    model *m = load(s);
    const model_mesh *mesh = &m->meshes[0];
    const float white[4] = { 1, 1, 1, 1 }, zero[2] = { 0, 0 }, blue[4] = { 0, 0, 1, 0.2f };
    assert_int_equal(mesh->vertex_count, 6);
    assert_int_equal(mesh->submeshes[0].material, 1);
    assert_int_equal(mesh->submeshes[1].material, 0);
    assert_int_equal(mesh->submeshes[1].first_index, 3);
    assert_int_equal(mesh->submeshes[1].first_vertex, 3);
    assert_int_equal(mesh->indices[3], 3);
    assert_floats(mesh->color, white, 4);
    assert_floats(mesh->color + 20, blue, 4);
    assert_floats(mesh->uv + 2, zero, 2);
    assert_floats(mesh->uv + 8, uv + 2, 2);
    model_free(m);
}

/* Six vertices and their deltas, which two primitives share; no triangle uses the last one. */
static scene *shared_vertices(void)
{
    const float positions[18] = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0, 9, 9, 9 };
    const float deltas[6] = { 0, 0, 3, 0, 0, 4 };
    const uint16_t first[3] = { 0, 1, 2 }, second[6] = { 3, 2, 1, 3, 1, 4 }, moved[2] = { 3, 5 };
    char rest[256];
    scene *s = scene_new();
    add_array(s, positions, sizeof positions, F32, 6, "VEC3");
    snprintf(
        rest, sizeof rest,
        ",\"sparse\":{\"count\":2,\"indices\":{\"bufferView\":%d,\"componentType\":5123},\"values\":{\"bufferView\":"
        "%d}}",
        add_view(s, moved, sizeof moved, 0), add_view(s, deltas, sizeof deltas, 0));
    add_accessor(s, F32, 6, "VEC3", rest);
    add_array(s, first, sizeof first, U16, 3, "SCALAR");
    add_array(s, second, sizeof second, U16, 6, "SCALAR");
    for (int i = 2; i < 4; ++i)
        APPEND(s->primitives, "%s{\"attributes\":{\"POSITION\":0},\"indices\":%d,\"targets\":[{\"POSITION\":1}]}",
               i > 2 ? "," : "", i);
    return s;
}

/* Each primitive has the vertices that its triangles use, in their order, and no others. */
static void shared_vertices_are_dealt_out(void **state)
{
    (void)state;
    model *m = load(shared_vertices());
    const model_mesh *mesh = &m->meshes[0];
    const float second[12] = { 1, 1, 0, 0, 1, 0, 1, 0, 0, 2, 1, 0 }; /* as its triangles use them */
    const uint32_t indices[9] = { 0, 1, 2, 3, 4, 5, 3, 5, 6 };
    const float up[3] = { 0, 0, 3 };
    assert_int_equal(mesh->vertex_count, 7);
    assert_int_equal(mesh->submeshes[1].first_vertex, 3);
    assert_int_equal(mesh->submeshes[1].vertex_count, 4);
    assert_floats(mesh->position, triangle_positions, 9);
    assert_floats(mesh->position + 9, second, 12);
    assert_memory_equal(mesh->indices, indices, sizeof indices);
    for (size_t v = 0; v < 7; ++v)
        if (v != 3) assert_true(mesh->targets[0].position[v * 3 + 2] == 0.0f);
    assert_floats(mesh->targets[0].position + 9, up, 3);
    model_free(m);
}

/* A number of a vertex that is not used is not read. */
static void unused_vertices_may_hold_anything(void **state)
{
    (void)state;
    const float nan = (float)NAN;
    scene *s = shared_vertices();
    memcpy(s->bytes + 17 * sizeof nan, &nan, sizeof nan);
    model_free(load(s));
    s = shared_vertices();
    memcpy(s->bytes + 14 * sizeof nan, &nan, sizeof nan);
    model *m = load(s);
    assert_true(has_warning(m, "primitive 1 POSITION (accessor 0), element 4: the value is NaN"));
    model_free(m);
}

/* An index that ends a strip elsewhere cuts it, and names no vertex of a triangle. */
static void restart_indices_cut_strips(void **state)
{
    (void)state;
    const uint16_t index[7] = { 0, 1, 2, 65535, 2, 1, 0 };
    scene *s = triangle("", ",\"indices\":1");
    add_array(s, index + 1, 3 * sizeof *index, U16, 3, "SCALAR");
    refused(s, "the primitive has no such vertex", "mesh 'm' primitive 0 triangle 0");
    for (int mode = 5; mode <= 6; mode++) {
        s = triangle("", mode == 5 ? ",\"mode\":5,\"indices\":1" : ",\"mode\":6,\"indices\":1");
        add_array(s, index, sizeof index, U16, 7, "SCALAR");
        model *m = load(s);
        assert_int_equal(m->meshes[0].index_count, 6);
        assert_true(has_warning(m, "mesh 'm' primitive 0: an index ends a strip, which glTF does not allow"));
        model_free(m);
    }
}

static void other_signs_of_tangents_are_rounded(void **state)
{
    (void)state;
    const float normals[9] = { 0, 0, 1, 0, 0, 1, 0, 0, 1 };
    const float tangents[12] = { 1, 0, 0, 1, 1, 0, 0, 0.5f, 1, 0, 0, -2 };
    scene *s = triangle(",\"NORMAL\":1,\"TANGENT\":2", "");
    add_array(s, normals, sizeof normals, F32, 3, "VEC3");
    add_array(s, tangents, sizeof tangents, F32, 3, "VEC4");
    model *m = load(s);
    assert_true(m->meshes[0].tangent[7] == 1.0f && m->meshes[0].tangent[11] == -1.0f);
    assert_true(has_warning(m, "mesh 'm' primitive 0: its tangents have signs that are neither 1 nor -1"));
    model_free(m);
}

static void target_names_are_made_unique(void **state)
{
    (void)state;
    scene *s = morphing(up_deltas,
                        ",\"targets\":[{\"POSITION\":1},{\"POSITION\":1},{\"POSITION\":1},{\"POSITION\":1}]");
    APPEND(s->mesh_rest, ",\"extras\":{\"targetNames\":[\"smile\",\"\",\"smile\"]},\"weights\":[0,0.5,0,1]");
    model *m = load(s);
    const float weights[4] = { 0, 0.5f, 0, 1 };
    assert_string_equal(m->meshes[0].targets[0].name, "smile");
    assert_string_equal(m->meshes[0].targets[1].name, "target_1");
    assert_string_equal(m->meshes[0].targets[2].name, "smile_2");
    assert_string_equal(m->meshes[0].targets[3].name, "target_3");
    assert_true(has_warning(m, "two targets are named 'smile'"));
    assert_true(has_warning(m, "3 target names for 4 targets"));
    assert_floats(m->meshes[0].weights, weights, 4);
    model_free(m);
}

static void target_names_of_a_primitive(void **state)
{
    (void)state;
    model *m = load(morphing(up_deltas, ONE_TARGET ",\"extras\":{\"targetNames\":[\"blink\"]}"));
    assert_string_equal(m->meshes[0].targets[0].name, "blink");
    model_free(m);
}

static void recipes_in_extras(void **state)
{
    (void)state;
    scene *s = morphing(up_deltas, ONE_TARGET);
    APPEND(s->mesh_rest, ",\"extras\":{\"targetNames\":[\"blink\"],\"recipe\":[\"blink blink\",\"aa blink 0.5\"]}");
    model *m = load(s);
    assert_string_equal(m->meshes[0].recipe, "blink blink\naa blink 0.5\n");
    model_free(m);
    s = morphing(up_deltas, ONE_TARGET);
    APPEND(s->mesh_rest, ",\"extras\":{\"recipe\":\"aa blink; PP blink\"}");
    m = load(s);
    assert_string_equal(m->meshes[0].recipe, "aa blink; PP blink");
    model_free(m);
    s = morphing(up_deltas, ONE_TARGET);
    APPEND(s->mesh_rest, ",\"extras\":{\"recipe\":{\"aa\":1}}");
    m = load(s);
    assert_null(m->meshes[0].recipe);
    assert_true(has_warning(m, "the recipe in its extras was skipped"));
    model_free(m);
}

/* --- normals --- */

static void check_unit(const float *v)
{
    double length = sqrt((double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] + (double)v[2] * (double)v[2]);
    assert_true(fabs(length - 1.0) < 1e-6);
}

static void normals_of_a_triangle(void **state)
{
    (void)state;
    const float up[9] = { 0, 0, 1, 0, 0, 1, 0, 0, 1 };
    model *m = load(triangle("", ""));
    assert_floats(m->meshes[0].normal, up, 9);
    model_free(m);
}

/* Two triangles with no common vertex that meet at the y axis, the second bent by (x z). */
static model *load_fold(float x, float z)
{
    const float positions[18] = { 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 1, 0, 0, 0, 0, x, 0, z };
    scene *s = scene_new();
    add_array(s, positions, sizeof positions, F32, 6, "VEC3");
    APPEND(s->primitives, "{\"attributes\":{\"POSITION\":0}}");
    return load(s);
}

static void normals_below_the_crease_angle_are_smooth(void **state)
{
    (void)state;
    model *m = load_fold(0.8f, -0.6f);
    const float *n = m->meshes[0].normal;
    assert_floats(n, n + 12, 3); /* both ends of the edge are shared */
    assert_floats(n + 3, n + 9, 3);
    assert_true(n[0] > 0.1f && n[2] > 0.5f);
    assert_true(n[6] == 0.0f && n[8] == 1.0f); /* the far corners keep their own */
    for (size_t v = 0; v < 6; ++v) check_unit(n + v * 3);
    model_free(m);
}

static void normals_above_the_crease_angle_are_hard(void **state)
{
    (void)state;
    model *m = load_fold(0.0f, -1.0f);
    const float first[3] = { 0, 0, 1 }, second[3] = { 1, 0, 0 };
    assert_floats(m->meshes[0].normal, first, 3);
    assert_floats(m->meshes[0].normal + 9, second, 3);
    model_free(m);
}

static void normals_of_an_indexed_edge_are_shared(void **state)
{
    (void)state;
    const float positions[12] = { 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 0, -1 };
    const uint16_t index[6] = { 0, 1, 2, 1, 0, 3 };
    scene *s = scene_new();
    add_array(s, positions, sizeof positions, F32, 4, "VEC3");
    add_array(s, index, sizeof index, U16, 6, "SCALAR");
    APPEND(s->primitives, "{\"attributes\":{\"POSITION\":0},\"indices\":1}");
    model *m = load(s);
    assert_int_equal(m->meshes[0].vertex_count, 4); /* never split */
    assert_true(fabs((double)m->meshes[0].normal[0] - sqrt(0.5)) < 1e-6);
    model_free(m);
}

static void degenerate_triangles_are_kept(void **state)
{
    (void)state;
    const uint16_t index[6] = { 0, 1, 2, 1, 1, 2 };
    const float up[3] = { 0, 0, 1 };
    scene *s = triangle("", ",\"indices\":1");
    add_array(s, index, sizeof index, U16, 6, "SCALAR");
    model *m = load(s);
    assert_int_equal(m->meshes[0].index_count, 6);
    assert_floats(m->meshes[0].normal + 3, up, 3);
    model_free(m);
}

static void normals_of_all_degenerate_triangles_are_unit(void **state)
{
    (void)state;
    const uint16_t index[3] = { 1, 1, 2 };
    scene *s = triangle("", ",\"indices\":1");
    add_array(s, index, sizeof index, U16, 3, "SCALAR");
    model *m = load(s);
    assert_int_equal(m->meshes[0].vertex_count, 2);
    for (size_t v = 0; v < 2; ++v) check_unit(m->meshes[0].normal + v * 3);
    model_free(m);
}

static void file_normals_of_other_length(void **state)
{
    (void)state;
    const float normals[9] = { 0, 0, 4, 0, 0, 0, 0, 0.001f, 0.9999f }, delta[9] = { 2, 0, 0, 0, 0, 0, 0, 0, 0 };
    const float scaled[3] = { 0, 0, 1 }, scaled_delta[3] = { 0.5f, 0, 0 };
    scene *s = triangle(",\"NORMAL\":1", ",\"targets\":[{\"NORMAL\":2}]");
    add_array(s, normals, sizeof normals, F32, 3, "VEC3");
    add_array(s, delta, sizeof delta, F32, 3, "VEC3");
    model *m = load(s);
    const model_mesh *mesh = &m->meshes[0];
    assert_floats(mesh->normal, scaled, 3);
    assert_floats(mesh->targets[0].normal, scaled_delta, 3); /* the blend keeps its direction */
    assert_floats(mesh->normal + 3, scaled, 3);              /* no length: computed */
    assert_true(has_warning(m, "1 normals have no length"));
    assert_memory_equal(mesh->normal + 6, normals + 6, 3 * sizeof(float)); /* near enough: the file's bits */
    model_free(m);
}

/* --- targets --- */

static void target_normals_from_the_morphed_mesh(void **state)
{
    (void)state;
    /* the triangle becomes (0 0 0) (1 0 1) (0 1 0): its normal (-1 0 1) / sqrt 2 */
    const double half = sqrt(0.5);
    model *m = load(morphing(up_deltas, ONE_TARGET));
    const model_target *t = &m->meshes[0].targets[0];
    for (size_t v = 0; v < 3; ++v) {
        assert_true(fabs((double)t->normal[v * 3] + half) < 1e-6);
        assert_true(t->normal[v * 3 + 1] == 0.0f);
        assert_true(fabs((double)t->normal[v * 3 + 2] - (half - 1.0)) < 1e-6);
    }
    assert_true(t->has_position && !t->has_normal && !t->has_tangent);
    model_free(m);
}

static void target_normals_are_zero_where_nothing_changes(void **state)
{
    (void)state;
    const float positions[18] = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 0, 0.3f, 6, 0.1f, 0, 5, 1, 0 };
    const float deltas[18] = { 0, 0, 0, 0, 0, 1 };
    const float zeros[9] = { 0 };
    scene *s = scene_new();
    add_array(s, positions, sizeof positions, F32, 6, "VEC3");
    add_array(s, deltas, sizeof deltas, F32, 6, "VEC3");
    APPEND(s->primitives, "{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":1}]}");
    model *m = load(s);
    assert_memory_equal(m->meshes[0].targets[0].normal + 9, zeros, sizeof zeros);
    assert_true(m->meshes[0].targets[0].normal[0] != 0.0f);
    model_free(m);
}

static void target_normals_of_a_moved_triangle_are_snapped_to_zero(void **state)
{
    (void)state;
    const float deltas[9] = { 0.1f, 0.2f, 0.3f, 0.1f, 0.2f, 0.3f, 0.1f, 0.2f, 0.3f }, zeros[9] = { 0 };
    model *m = load(morphing(deltas, ONE_TARGET));
    assert_memory_equal(m->meshes[0].targets[0].normal, zeros, sizeof zeros);
    model_free(m);
}

static void target_normals_of_the_file_are_kept(void **state)
{
    (void)state;
    const float normals[9] = { 0, 0, 1, 0, 0, 1, 0, 0, 1 }, delta[9] = { 0.125f, 0, 0, 0, 0, 0, 0, 0, -0.5f };
    scene *s = triangle(",\"NORMAL\":1", ",\"targets\":[{\"POSITION\":0,\"NORMAL\":2}]");
    add_array(s, normals, sizeof normals, F32, 3, "VEC3");
    add_array(s, delta, sizeof delta, F32, 3, "VEC3");
    model *m = load(s);
    assert_memory_equal(m->meshes[0].targets[0].normal, delta, sizeof delta);
    assert_true(m->meshes[0].targets[0].has_normal);
    model_free(m);
}

static void target_normals_without_a_base_are_ignored(void **state)
{
    (void)state;
    const float zeros[9] = { 0 };
    model *m = load(morphing(up_deltas, ",\"targets\":[{\"NORMAL\":1}]"));
    assert_memory_equal(m->meshes[0].targets[0].normal, zeros, sizeof zeros);
    assert_false(m->meshes[0].targets[0].has_normal);
    assert_true(has_warning(m, "mesh 'm' primitive 0 target 0: the deltas of NORMAL were ignored"));
    model_free(m);
}

static void targets_of_each_primitive(void **state)
{
    (void)state;
    /* the first primitive gives POSITION, the second NORMAL only */
    const float normals[9] = { 0, 0, 1, 0, 0, 1, 0, 0, 1 };
    scene *s = triangle("", ",\"targets\":[{\"POSITION\":2}]");
    add_array(s, normals, sizeof normals, F32, 3, "VEC3");
    add_array(s, up_deltas, sizeof up_deltas, F32, 3, "VEC3");
    APPEND(s->primitives, ",{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"targets\":[{\"NORMAL\":2}]}");
    model *m = load(s);
    const model_target *t = &m->meshes[0].targets[0];
    const float zeros[9] = { 0 };
    assert_memory_equal(t->position, up_deltas, sizeof up_deltas);
    assert_memory_equal(t->position + 9, zeros, sizeof zeros);
    assert_true(t->normal[0] < -0.1f);
    assert_memory_equal(t->normal + 9, up_deltas, sizeof up_deltas);
    assert_true(t->has_position && t->has_normal);
    model_free(m);
}

static void negative_zero_deltas_become_zero(void **state)
{
    (void)state;
    const float deltas[9] = { -0.0f, 0, 0, 0, -0.0f, 1, 0, 0, 0 };
    model *m = load(morphing(deltas, ONE_TARGET));
    assert_memory_equal(m->meshes[0].targets[0].position, up_deltas, sizeof up_deltas);
    model_free(m);
}

/* --- tangents --- */

static model *load_with_uvs(const float *uv, const char *more)
{
    scene *s = triangle(",\"TEXCOORD_0\":1", more);
    add_array(s, uv, 6 * sizeof *uv, F32, 3, "VEC2");
    add_array(s, up_deltas, sizeof up_deltas, F32, 3, "VEC3");
    return load(s);
}

static void tangents_follow_u(void **state)
{
    (void)state;
    /* in glTF v runs down: with v along y the bitangent is -y, so w is -1 */
    const float along[6] = { 0, 0, 1, 0, 0, 1 }, mirrored[6] = { 1, 0, 0, 0, 1, 1 };
    const float expected[4] = { 1, 0, 0, -1 }, expected_mirrored[4] = { -1, 0, 0, 1 };
    model *m = load_with_uvs(along, "");
    for (size_t v = 0; v < 3; ++v) assert_floats(m->meshes[0].tangent + v * 4, expected, 4);
    model_free(m);
    m = load_with_uvs(mirrored, "");
    for (size_t v = 0; v < 3; ++v) assert_floats(m->meshes[0].tangent + v * 4, expected_mirrored, 4);
    model_free(m);
}

static void check_right_angles(const model_mesh *mesh)
{
    for (size_t v = 0; v < mesh->vertex_count; ++v) {
        const float *t = mesh->tangent + v * 4, *n = mesh->normal + v * 3;
        check_unit(t);
        assert_true(fabs((double)t[0] * (double)n[0] + (double)t[1] * (double)n[1] + (double)t[2] * (double)n[2]) <
                    1e-6);
        assert_true(t[3] == 1.0f || t[3] == -1.0f);
    }
}

static void tangents_without_usable_uvs(void **state)
{
    (void)state;
    const float flat[6] = { 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f };
    model *m = load_with_uvs(flat, ",\"targets\":[{\"POSITION\":2}]");
    check_right_angles(&m->meshes[0]);
    for (size_t i = 0; i < 9; ++i) assert_true(isfinite(m->meshes[0].targets[0].tangent[i]));
    model_free(m);
}

static void tangents_where_uvs_are_mirrored(void **state)
{
    (void)state;
    /* two triangles share vertices 0 and 1; v is mirrored at the shared edge */
    const float positions[12] = { 0, 0, 0, 0, 1, 0, -2, 0, 0, 0.2f, 0, 0 }, uv[8] = { 0, 0, 0, 1, -2, 0, -0.2f, 0 };
    const uint16_t index[6] = { 0, 1, 2, 1, 0, 3 };
    scene *s = scene_new();
    add_array(s, positions, sizeof positions, F32, 4, "VEC3");
    add_array(s, index, sizeof index, U16, 6, "SCALAR");
    add_array(s, uv, sizeof uv, F32, 4, "VEC2");
    APPEND(s->primitives, "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":2},\"indices\":1}");
    model *m = load(s);
    const float wide[4] = { 1, 0, 0, -1 }, narrow[4] = { -1, 0, 0, 1 };
    check_right_angles(&m->meshes[0]);
    assert_int_equal(m->meshes[0].vertex_count, 6); /* the shared two are split */
    for (size_t c = 0; c < 6; ++c)
        assert_floats(m->meshes[0].tangent + (size_t)m->meshes[0].indices[c] * 4, c < 3 ? wide : narrow, 4);
    model_free(m);
}

static void target_tangents_from_the_morphed_mesh(void **state)
{
    (void)state;
    const float along[6] = { 0, 0, 1, 0, 0, 1 };
    const double half = sqrt(0.5);
    model *m = load_with_uvs(along, ",\"targets\":[{\"POSITION\":2}]");
    const model_target *t = &m->meshes[0].targets[0];
    for (size_t v = 0; v < 3; ++v) { /* u now grows along (1 0 1) */
        assert_true(fabs((double)t->tangent[v * 3] - (half - 1.0)) < 1e-6);
        assert_true(fabs((double)t->tangent[v * 3 + 2] - half) < 1e-6);
    }
    model_free(m);
}

static void no_uvs_no_tangents(void **state)
{
    (void)state;
    model *m = load(morphing(up_deltas, ONE_TARGET));
    assert_null(m->meshes[0].tangent);
    assert_null(m->meshes[0].uv);
    assert_null(m->meshes[0].targets[0].tangent);
    model_free(m);
}

/* --- nodes --- */

static void nodes_parents_first(void **state)
{
    (void)state;
    scene *s = triangle("", "");
    APPEND(
        s->rest,
        ",\"scene\":0,\"scenes\":[{\"nodes\":[2]}],\"nodes\":["
        "{\"name\":\"child\",\"mesh\":0,\"translation\":[1,0,0]},{\"name\":\"elsewhere\"},"
        "{\"name\":\"root\",\"children\":[0],\"scale\":[2,2,2],\"rotation\":[0,0,0.7071067811865476,0.7071067811865476]}]");
    model *m = load(s);
    assert_int_equal(m->node_count, 2);
    assert_string_equal(m->nodes[0].name, "root");
    assert_int_equal(m->nodes[0].parent, MODEL_NONE);
    assert_int_equal(m->nodes[0].mesh, MODEL_NONE);
    assert_string_equal(m->nodes[1].name, "child");
    assert_int_equal(m->nodes[1].parent, 0);
    assert_int_equal(m->nodes[1].mesh, 0);
    assert_true(fabs(m->nodes[1].world[12]) < 1e-7 && fabs(m->nodes[1].world[13] - 2.0) < 1e-7);
    model_free(m);
}

/* glTF 2.0, 3.7.3: the node of a skinned mesh does not place it; so its size in the world is its joints'. */
static void skinned_mesh_is_as_large_as_its_joints_make_it(void **state)
{
    (void)state;
    const char *rest =
        ",\"nodes\":[{\"mesh\":0,\"skin\":0,\"scale\":[9,9,9]},{\"translation\":[0,2,0],\"scale\":[3,3,3]},"
        "{\"scale\":[50,50,50]}],\"skins\":[{\"joints\":[1,2]}]";
    scene *s = triangle("", "");
    APPEND(s->rest, "%s", rest);
    model *m = load(s);
    assert_true(m->nodes[0].skin == MODEL_NONE &&
                m->warning_count == 1); /* a skin has nothing to move in a rigid mesh */
    assert_non_null(strstr(m->warnings[0], "node_0"));
    assert_true(fabsf(model_mesh_scale(m, 0) - 9.0f) < 1e-6f);
    model_free(m);
    s = skinned_triangle();
    APPEND(s->rest, "%s", rest);
    m = load(s);
    assert_true(m->nodes[0].skin == 0 && m->nodes[1].skin == MODEL_NONE);
    assert_true(fabsf(model_mesh_scale(m, 0) - 3.0f) < 1e-6f); /* the second joint moves nothing */
    model_free(m);
}

static void bad_skins_are_left_out(void **state)
{
    (void)state;
    static const char *const rests[][2] = {
        { ",\"nodes\":[{\"mesh\":0,\"skin\":0}]", "node 'node_0': its skin does not exist" },
        { ",\"nodes\":[{\"mesh\":0,\"skin\":0}],\"skins\":[{\"joints\":[]}]", "skin 0: the skin has no joints" },
        { ",\"nodes\":[{\"mesh\":0,\"skin\":0}],\"skins\":[{\"joints\":[7]}]", "skin 0: joint node 7 does not exist" }
    };
    for (size_t i = 0; i < sizeof rests / sizeof rests[0]; i++) {
        scene *s = skinned_triangle();
        APPEND(s->rest, "%s", rests[i][0]);
        model *m = load(s);
        assert_true(m->skin_count == 0 && m->nodes[0].mesh == 0 && m->nodes[0].skin == MODEL_NONE);
        assert_true(has_warning(m, rests[i][1]));
        model_free(m);
    }
}

static model *with_binds(const float *binds, int count, const char *hip)
{
    scene *s = skinned_triangle();
    add_array(s, binds, (size_t)count * 64, F32, count, "MAT4");
    APPEND(s->rest,
           ",\"nodes\":[{\"mesh\":0,\"skin\":0},{\"name\":\"hip\",%s},{}],"
           "\"skins\":[{\"joints\":[1,2],\"inverseBindMatrices\":3}]",
           hip);
    return load(s);
}

/* A bind matrix that cannot be one: the joint is bound where it rests, and named. */
static void bad_bind_matrices_are_replaced(void **state)
{
    (void)state;
    static const char rest[] = "\"translation\":[0,2,0],\"scale\":[2,2,2]";
    static const struct {
        float binds[16];
        const char *fault;
    } cases[] = {
        { { 0 }, "is all zeros" },
        { { 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 }, "is singular" },
        { { 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 }, "is singular" },
        { { 1, 0, 0, 0.5f, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 }, "is not affine" },
        { { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, NAN, 0, 0, 1 }, "has a number that is NaN" },
        { { 1, 0, 0, 0, 0, INFINITY, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 }, "has a number that is NaN" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[128];
        float binds[32] = { 0 };
        memcpy(binds, cases[i].binds, sizeof cases[i].binds);
        for (int k = 0; k < 4; k++) binds[16 + k * 5] = 1.0f;
        model *m = with_binds(binds, 2, rest);
        snprintf(text, sizeof text, "skin 0: the inverse bind matrix of joint 'hip' %s", cases[i].fault);
        assert_true(m->skins[0].inverse_bind[0] == 0.5f && m->skins[0].inverse_bind[13] == -1.0f);
        assert_true(m->skins[0].inverse_bind[16] == 1.0f && m->warning_count == 1);
        assert_true(has_warning(m, text));
        model_free(m);
    }
    const float one[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 3, 0, 1 };
    model *m = with_binds(one, 1, rest);
    assert_true(m->skins[0].inverse_bind[13] == 3.0f && m->skins[0].inverse_bind[21] == 1.0f);
    assert_true(has_warning(m, "skin 0: 2 joints but 1 inverse bind matrices"));
    model_free(m);
    float none[32] = { 0 };
    m = with_binds(none, 2, "\"translation\":[0,3,0],\"scale\":[2,0,2]"); /* the place alone */
    assert_true(m->skins[0].inverse_bind[0] == 1.0f && m->skins[0].inverse_bind[13] == -3.0f);
    model_free(m);
}

static void matrices_are_decomposed(void **state)
{
    (void)state;
    /* 120 degrees about (1 1 1), scale 2 3 -4 */
    const float translation[3] = { 5, 6, 7 }, rotation[4] = { 0.5f, 0.5f, 0.5f, 0.5f };
    scene *s = triangle("", "");
    APPEND(s->rest, ",\"nodes\":[{\"matrix\":[0,2,0,0,0,0,3,0,4,0,0,0,5,6,7,1]}]");
    model *m = load(s);
    const float scale[3] = { 2, 3, 4 };
    assert_floats(m->nodes[0].translation, translation, 3);
    assert_floats(m->nodes[0].rotation, rotation, 4);
    assert_floats(m->nodes[0].scale, scale, 3);
    assert_true(m->nodes[0].world[1] == 2.0 && m->nodes[0].world[12] == 5.0);
    assert_int_equal(m->warning_count, 0);
    model_free(m);
}

static void skewed_and_mirrored_matrices(void **state)
{
    (void)state;
    scene *s = triangle("", "");
    APPEND(s->rest, ",\"nodes\":[{\"name\":\"mirror\",\"matrix\":[-2,0,0,0,0,2,0,0,0,0,2,0,0,0,0,1]},"
                    "{\"name\":\"skew\",\"matrix\":[1,0,0,0,1,1,0,0,0,0,1,0,0,0,0,1]}]");
    model *m = load(s);
    const float scale[3] = { -2, 2, 2 };
    assert_floats(m->nodes[0].scale, scale, 3);
    assert_false(has_warning(m, "node 'mirror'"));
    assert_true(has_warning(m, "node 'skew': the matrix is skewed"));
    model_free(m);
}

static void node_weights(void **state)
{
    (void)state;
    scene *s = morphing(up_deltas, ONE_TARGET);
    APPEND(s->rest, ",\"nodes\":[{\"mesh\":0,\"weights\":[0.25]},{\"mesh\":0}]");
    model *m = load(s);
    assert_true(m->nodes[0].weights[0] == 0.25f);
    assert_null(m->nodes[1].weights);
    model_free(m);
}

/* --- VRM --- */

/* A triangle with two targets on the node "face", below "Armature" and "J_Bip_C_Hips". */
static scene *vrm_scene(const char *extensions)
{
    scene *s = triangle("", ",\"targets\":[{\"POSITION\":1},{\"POSITION\":1}]");
    add_array(s, up_deltas, sizeof up_deltas, F32, 3, "VEC3");
    APPEND(s->mesh_rest, ",\"extras\":{\"targetNames\":[\"Fcl Joy\",\"lids\"]}");
    APPEND(s->rest,
           ",\"nodes\":[{\"name\":\"Armature\",\"children\":[1],\"translation\":[1,2,3]},{\"name\":\"J_Bip_C_Hips\","
           "\"children\":[2],\"translation\":[0,1,0]},{\"name\":\"face\",\"mesh\":0,\"translation\":[0,0,0.5]}],"
           "\"extensions\":{%s}",
           extensions);
    return s;
}

static void vrm_expressions_are_recipes(void **state)
{
    (void)state;
    model *m = load(vrm_scene(
        "\"VRMC_vrm\":{\"specVersion\":\"1.0\",\"humanoid\":{\"humanBones\":{\"hips\":{\"node\":1},\"head\":{\"node\":9},"
        "\"spine\":{\"node\":0},\"neck\":{\"node\":-1},\"Armature\":{\"node\":2}}},"
        "\"expressions\":{\"preset\":{\"happy\":{\"morphTargetBinds\":[{\"node\":2,\"index\":0,\"weight\":0.5},"
        "{\"node\":2,\"index\":7,\"weight\":1}],\"materialColorBinds\":[{\"material\":0}]},\"blinkLeft\":{\"morphTargetBinds\":[{"
        "\"node\":2,\"index\":1,\"weight\":1}]},\"blinkRight\":{\"morphTargetBinds\":[{\"node\":2,\"index\":1,\"weight\":0.25}]},\"blink\":{\"morphTargetBinds\":[{\"node\":2,"
        "\"index\":1,\"weight\":1}]},\"relaxed\":{\"morphTargetBinds\":[{\"node\":2,\"index\":1,\"weight\":1}]}}}}"));
    assert_string_equal(m->nodes[1].name, "hips");
    assert_string_equal(m->nodes[0].name, "spine");
    assert_true(has_warning(m, "VRM bone 'head': its node does not exist"));
    assert_true(has_warning(m, "VRM bone 'Armature': its node 'face' keeps its name: another node has the bone's"));
    assert_string_equal(m->meshes[0].recipe,
                        "blink-left \"lids\" 1\nblink-right \"lids\" 0.25\njoy-upper \"Fcl Joy\" 0.5\n"
                        "expression \"relaxed\" \"lids\" 1\n");
    assert_true(has_warning(m, "VRM expression 'happy': its changes to materials were left out"));
    assert_true(has_warning(m, "VRM expression 'happy': a bind was left out: its mesh or target does not exist"));
    assert_int_equal(m->meshes[0].target_count, 3); /* a game calls it by this name */
    assert_string_equal(m->meshes[0].targets[2].name, "relaxed");
    for (uint32_t i = 0; i < 3u * m->meshes[0].vertex_count; i++)
        assert_true(m->meshes[0].targets[2].position[i] == 0.0f);
    assert_true(m->nodes[2].world[14] == 3.5);
    model_free(m);
}

/* Rules of emotions are lines of the recipe; a warning for each that a pack has no place for. */
static void vrm_rules_are_told(void **state)
{
    (void)state;
    model *m = load(vrm_scene(
        "\"VRMC_vrm\":{\"expressions\":{\"preset\":{\"happy\":{\"isBinary\":true,\"overrideBlink\":\"block\","
        "\"overrideLookAt\":\"blend\",\"overrideMouth\":\"block\"},\"aa\":{\"isBinary\":false,\"overrideBlink\":\"none\"},"
        "\"blink\":{\"isBinary\":true,\"overrideMouth\":\"block\"},\"sad\":{\"overrideBlink\":\"often\"}},"
        "\"custom\":{\"wink\":{\"isBinary\":true,\"overrideMouth\":\"blend\",\"morphTargetBinds\":[{\"node\":2,"
        "\"index\":0,\"weight\":0.5},{\"node\":2,\"index\":1,\"weight\":1}]},\"empty\":{\"isBinary\":true},\"lids\":{"
        "\"morphTargetBinds\":[{\"node\":2,\"index\":1,\"weight\":0.5}]},\"a;b\":{\"morphTargetBinds\":[{\"node\":2,"
        "\"index\":1,\"weight\":1}]}}}}"));
    assert_int_equal(m->warning_count, 5); /* 'empty' is counted with 'blink' */
    assert_true(has_warning(m, "VRM expression 'blink': isBinary was left out: it shows by degrees"));
    assert_true(has_warning(m, "VRM expression 'blink': overrideMouth 'block' was left out"));
    assert_true(has_warning(m, "VRM expression 'sad': overrideBlink 'often' was left out"));
    assert_string_equal(m->meshes[0].recipe,
                        "binary joy-upper\noverride joy-upper lids block\noverride joy-upper eyes blend\n"
                        "override joy-upper speech block\nexpression \"lids\" \"lids\" 0.5\n"
                        "expression \"wink\" \"Fcl Joy\" 0.5\nexpression \"wink\" \"lids\" 1\nbinary \"wink\"\n"
                        "override \"wink\" speech blend\n");
    assert_true(has_warning(m, "VRM expression 'lids': its target of the same name moves by all of its weight"));
    assert_true(has_warning(m, "VRM expression 'a;b' was left out: a game cannot call it by this name"));
    assert_int_equal(m->meshes[0].target_count, 3);
    model_free(m);
    m = load(
        vrm_scene("\"VRM\":{\"blendShapeMaster\":{\"blendShapeGroups\":[{\"name\":\"wink\",\"presetName\":"
                  "\"unknown\",\"isBinary\":true,\"binds\":[{\"mesh\":0,\"index\":1,\"weight\":50}]},{\"name\":"
                  "\"Surprised\",\"presetName\":\"unknown\",\"binds\":[{\"mesh\":0,\"index\":0,\"weight\":100}]}]}}"));
    assert_string_equal(m->meshes[0].recipe,
                        "expression \"wink\" \"lids\" 0.5\nbinary \"wink\"\nsurprise-upper \"Fcl Joy\" 1\n");
    assert_int_equal(m->warning_count, 0);
    model_free(m);
}

/* A VRM animation: bones have VRM's names, and its clips are for any body. */
static void vrm_animations_are_for_any_body(void **state)
{
    (void)state;
    model *m = load(vrm_scene("\"VRMC_vrm_animation\":{\"specVersion\":\"1.0\",\"humanoid\":{\"humanBones\":{\"hips\":{"
                              "\"node\":1}}},\"expressions\":{\"preset\":{\"happy\":{\"node\":2},\"aa\":{\"node\":9}}},"
                              "\"lookAt\":{\"node\":2}}"));
    assert_true(m->for_any_body);
    assert_string_equal(m->nodes[1].name, "hips");
    assert_string_equal(m->nodes[2].expression, "joy-upper");
    assert_true(has_warning(m, "VRM expression 'aa': its animation was left out: its node does not exist"));
    assert_true(has_warning(m, "VRM lookAt: its animation was left out"));
    model_free(m);
}

/* Before 1.0 weights go to 100, binds name meshes, and figures face -z. */
static void old_vrm_turns_round(void **state)
{
    (void)state;
    model *m = load(vrm_scene(
        "\"VRM\":{\"humanoid\":{\"humanBones\":[{\"bone\":\"hips\",\"node\":1},{\"bone\":\"spine\",\"node\":1}]},"
        "\"blendShapeMaster\":{\"blendShapeGroups\":[{\"presetName\":\"Joy\",\"binds\":[{\"mesh\":0,\"index\":0,"
        "\"weight\":100}]},{\"presetName\":\"blink\",\"binds\":[{\"mesh\":0,\"index\":1,\"weight\":50}]},"
        "{\"presetName\":\"unknown\",\"binds\":[{\"mesh\":0,\"index\":1,\"weight\":50}]}]}}"));
    const model_node *face = &m->nodes[2], *root = &m->nodes[0];
    assert_string_equal(m->nodes[1].name, "hips");
    assert_true(has_warning(m, "VRM bone 'spine': its node is another bone, too"));
    assert_string_equal(m->meshes[0].recipe, "joy-upper \"Fcl Joy\" 1\nblink \"lids\" 0.5\n");
    assert_true(face->world[12] == -1.0 && face->world[13] == 3.0 && face->world[14] == -3.5 && face->world[0] == -1.0);
    assert_true(root->rotation[1] == 1.0f && root->rotation[3] == 0.0f && root->translation[0] == -1.0f);
    model_free(m);
}

/* No part has the type that it should have: the reader ignores it. */
static void damaged_vrm_is_ignored(void **state)
{
    (void)state;
    static const char *const all[] = {
        "\"VRMC_vrm\":[]",
        "\"VRM\":7",
        "\"VRMC_vrm\":{\"humanoid\":[],\"expressions\":{\"preset\":[1]}}",
        "\"VRM\":{\"humanoid\":{\"humanBones\":[1,{\"bone\":2,\"node\":\"x\"}]},\"blendShapeMaster\":{"
        "\"blendShapeGroups\":[3,{\"presetName\":\"joy\",\"binds\":[{\"mesh\":-1},{\"mesh\":0,\"index\":0},7]}]}}",
        "\"VRMC_vrm\":{\"expressions\":{\"preset\":{\"happy\":{\"morphTargetBinds\":[{\"node\":2,\"index\":0,"
        "\"weight\":1e9}]}}}}",
        "\"VRMC_vrm\":{\"expressions\":{\"preset\":{\"happy\":{\"morphTargetBinds\":[{\"node\":2,\"index\":0,"
        "\"weight\":0},{\"node\":2,\"index\":1,\"weight\":0}]}}}}"
    };
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        model *m = load(vrm_scene(all[i]));
        assert_null(m->meshes[0].recipe);
        assert_string_equal(m->nodes[1].name, "J_Bip_C_Hips");
        if (i >= 4) assert_true(has_warning(m, "left out of it: its weight is 0, or beyond 4"));
        if (i == 5) assert_true(has_warning(m, "beyond 4 (and 1 more like it)")); /* one warning for all targets */
        model_free(m);
    }
}

/* No guess may change a surface that the file names; a word that names none is no surface. */
static void extras_give_a_surface(void **state)
{
    scene *s = vrm_scene("\"VRMC_vrm\":{}");
    (void)state;
    APPEND(s->rest, "%s",
           ",\"materials\":[{\"name\":\"skin\",\"extras\":{\"surface\":\"plain\"}},"
           "{\"name\":\"face\",\"extras\":{\"surface\":\"wood\"}},{\"name\":\"head\",\"extras\":{\"tint\":false}}]");
    model *m = load(s);
    assert_int_equal(m->materials[0].surface, NOH_SURFACE_PLAIN);
    assert_true(m->materials[0].surface_given && !m->materials[1].surface_given && !m->materials[2].surface_given);
    model_free(m);
}

/* Tones, rim, outline and textures; the unlit material next to it is for readers that know no MToon. */
static void mtoon_is_a_toon(void **state)
{
    static const char materials[] =
        ",\"materials\":[{\"name\":\"skin\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,1,0,1]},\"extensions\":{"
        "\"KHR_materials_unlit\":{},\"VRMC_materials_mtoon\":{\"shadeColorFactor\":[0.25,0.75,0.5],"
        "\"shadingShiftFactor\":-0.25,\"shadingToonyFactor\":0.75,\"parametricRimColorFactor\":[1,0,0.25],"
        "\"parametricRimFresnelPowerFactor\":3,\"parametricRimLiftFactor\":0.5,\"outlineWidthMode\":\"worldCoordinates\","
        "\"outlineWidthFactor\":0.002,\"outlineColorFactor\":[0,1,0],\"outlineLightingMixFactor\":0}}},"
        "{\"name\":\"hair\",\"extensions\":{\"KHR_materials_unlit\":{},\"VRMC_materials_mtoon\":{\"shadeColorFactor\":7}}},"
        "{\"name\":\"hat\",\"extensions\":{\"KHR_materials_unlit\":{}}},{\"name\":\"N00_000_00_Face_00_SKIN\"}]";
    scene *s = vrm_scene("\"VRMC_vrm\":{}");
    (void)state;
    APPEND(s->rest, "%s", materials);
    model *m = load(s);
    const model_material *skin = &m->materials[0], *hair = &m->materials[1];
    assert_int_equal(skin->surface, NOH_SURFACE_TOON);
    assert_false(skin->unlit);
    assert_true(skin->surface_values[0] == 0.5f && skin->surface_values[1] == 0.75f && skin->surface_values[2] == 1.0f);
    assert_true(skin->surface_values[3] == -0.25f && skin->surface_more[0] == 0.75f);
    assert_int_equal(hair->surface, NOH_SURFACE_TOON);
    assert_true(hair->surface_values[0] == 0.0f && hair->surface_more[0] == 0.9f);
    assert_true(m->materials[2].unlit && m->materials[2].surface == NOH_SURFACE_PLAIN);
    assert_int_equal(m->materials[3].surface, NOH_SURFACE_TOON); /* VRoid's, without its MToon */
    assert_true(skin->surface_more[1] == 255.0f + 65536.0f * 128.0f && skin->surface_more[2] == 3.0f);
    assert_true(skin->surface_more[3] == 0.5f && skin->surface_more[4] == 0.002f && skin->surface_more[5] == 65280.0f);
    assert_true(!skin->toon_shade && !skin->outline_lit && skin->more_textures[NOH_TOON_MATCAP] == MODEL_NONE);
    assert_true(hair->surface_more[1] == 0.0f && hair->surface_more[2] == 5.0f && hair->surface_more[4] == 0.0f);
    model_free(m);
}

/* Before 1.0 materials have a second list, the tones begin and end at cosines. */
static void old_mtoon_is_a_toon(void **state)
{
    scene *s = vrm_scene(
        "\"VRM\":{\"materialProperties\":[{\"shader\":\"VRM/MToon\",\"floatProperties\":{\"_ShadeShift\":-0.5,"
        "\"_ShadeToony\":0.5,\"_OutlineWidthMode\":2,\"_OutlineWidth\":2,\"_OutlineColorMode\":1,"
        "\"_RimFresnelPower\":4},\"vectorProperties\":{\"_ShadeColor\":[1,0,1,1],\"_RimColor\":[0,1,0,1]}},{\"shader\":\"VRM_USE_GLTFSHADER\"},4]}");
    (void)state;
    APPEND(s->rest, "%s", ",\"materials\":[{\"name\":\"a\"},{\"name\":\"b\"},{\"name\":\"c\"}]");
    model *m = load(s);
    const model_material *a = &m->materials[0]; /* from -0.5 to 0.25 */
    assert_int_equal(a->surface, NOH_SURFACE_TOON);
    assert_true(a->surface_values[0] == 1.0f && a->surface_values[1] == 0.0f && a->surface_values[3] == 0.125f);
    assert_true(a->surface_more[0] == 0.625f && a->surface_more[1] == 65280.0f && a->surface_more[2] == 4.0f);
    assert_true(fabsf(a->surface_more[4] + 0.01f) < 1e-6f && a->outline_lit);
    assert_int_equal(m->materials[1].surface, NOH_SURFACE_PLAIN);
    assert_int_equal(m->materials[2].surface, NOH_SURFACE_PLAIN);
    model_free(m);
}

/* A warning for each kind names the node; the extension itself is known. */
static void constraints_give_warnings(void **state)
{
    scene *s = triangle("", "");
    (void)state;
#define FOLLOWS(name, rest) \
    "{\"name\":\"" name     \
    "\",\"mesh\":0,\"extensions\":{\"VRMC_node_constraint\":{\"specVersion\":\"1.0\",\"constraint\":" rest "}}}"
    APPEND(s->rest, ",\"extensionsUsed\":[\"VRMC_node_constraint\"],\"nodes\":[%s,%s,%s,%s,%s]",
           FOLLOWS("wrist", "{\"roll\":{\"source\":1,\"rollAxis\":\"X\",\"weight\":0.5}}"),
           FOLLOWS("elbow", "{\"roll\":{\"source\":0,\"rollAxis\":\"X\"}}"),
           FOLLOWS("eye", "{\"aim\":{\"source\":0,\"aimAxis\":\"PositiveZ\"}}"),
           FOLLOWS("hip", "{\"rotation\":{\"source\":0}}"), FOLLOWS("none", "7"));
#undef FOLLOWS
    model *m = load(s);
    assert_true(
        has_warning(m, "node 'wrist': its VRM constraint (roll) was left out, so it moves with its parent alone"));
    assert_true(has_warning(m, "(and 1 more like it)"));
    assert_true(has_warning(m, "node 'eye': its VRM constraint (aim)"));
    assert_true(has_warning(m, "node 'hip': its VRM constraint (rotation)"));
    assert_false(has_warning(m, "not supported"));
    model_free(m);
}

/* --- animations --- */

/* A morphing triangle with two keys of weights: accessors 2 (times) and 3 (values). */
static scene *animated(const float *times, const void *values, size_t value_bytes, const char *value_accessor,
                       int value_component, int value_count, const char *sampler_rest, const char *target)
{
    char rest[128];
    scene *s = morphing(up_deltas, ONE_TARGET);
    add_array(s, times, 2 * sizeof *times, F32, 2, "SCALAR");
    snprintf(rest, sizeof rest, ",\"bufferView\":%d%s", add_view(s, values, value_bytes, 0), value_accessor);
    add_accessor(s, value_component, value_count, "SCALAR", rest);
    APPEND(s->rest,
           ",\"nodes\":[{\"name\":\"n\",\"mesh\":0},{\"name\":\"bare\"}],\"animations\":[{\"name\":\"a\",\"channels\":"
           "[{\"sampler\":0,\"target\":{%s}}],\"samplers\":[{\"input\":2,\"output\":3%s}]}]",
           target, sampler_rest);
    return s;
}

/* The same with any keys. */
static scene *keyed(const float *times, int count, const float *values, int value_count, const char *sampler_rest,
                    const char *target)
{
    scene *s = morphing(up_deltas, ONE_TARGET);
    add_array(s, times, (size_t)count * sizeof *times, F32, count, "SCALAR");
    add_array(s, values, (size_t)value_count * sizeof *values, F32, value_count, "SCALAR");
    APPEND(s->rest,
           ",\"nodes\":[{\"mesh\":0},{\"name\":\"bare\"}],\"animations\":[{\"name\":\"a\",\"channels\":"
           "[{\"sampler\":0,\"target\":{%s}}],\"samplers\":[{\"input\":2,\"output\":3%s}]}]",
           target, sampler_rest);
    return s;
}

static const float two_times[2] = { 0.5f, 2.0f }, two_values[2] = { 0, 1 };
#define WEIGHTS_OF_N "\"node\":0,\"path\":\"weights\""

static void animation_linear(void **state)
{
    (void)state;
    model *m = load(animated(two_times, two_values, sizeof two_values, "", F32, 2, "", WEIGHTS_OF_N));
    const model_channel *c = &m->clips[0].channels[0];
    assert_int_equal(m->clip_count, 1);
    assert_string_equal(m->clips[0].name, "a");
    assert_true(m->clips[0].duration_s == 2.0f);
    assert_int_equal(c->path, MODEL_PATH_WEIGHTS);
    assert_int_equal(c->interpolation, MODEL_LINEAR);
    assert_int_equal(c->key_count, 2);
    assert_int_equal(c->width, 1);
    assert_floats(c->times, two_times, 2);
    assert_floats(c->values, two_values, 2);
    model_free(m);
}

static void animation_of_normalised_bytes(void **state)
{
    (void)state;
    const uint8_t bytes[2] = { 0, 255 };
    model *m = load(animated(two_times, bytes, sizeof bytes, ",\"normalized\":true", U8, 2,
                             ",\"interpolation\":\"STEP\"", WEIGHTS_OF_N));
    assert_int_equal(m->clips[0].channels[0].interpolation, MODEL_STEP);
    assert_floats(m->clips[0].channels[0].values, two_values, 2);
    model_free(m);
}

static void animation_cubic(void **state)
{
    (void)state;
    const float values[6] = { 0, 0.5f, 1, -1, 2, 0 };
    model *m = load(
        animated(two_times, values, sizeof values, "", F32, 6, ",\"interpolation\":\"CUBICSPLINE\"", WEIGHTS_OF_N));
    assert_int_equal(m->clips[0].channels[0].interpolation, MODEL_CUBICSPLINE);
    assert_floats(m->clips[0].channels[0].values, values, 6);
    model_free(m);
}

/* The file's name for an animation that has none. */
static void animations_without_names(void **state)
{
    (void)state;
    scene *s = animated(two_times, two_values, sizeof two_values, "", F32, 2, "", WEIGHTS_OF_N);
    char *rest = strstr(s->rest, "\"name\":\"a\",");
    assert_non_null(rest);
    memmove(rest, rest + 11, strlen(rest + 11) + 1);
    s->rest[strlen(s->rest) - 1] = 0;
    APPEND(s->rest, ",{\"channels\":[{\"sampler\":0,\"target\":{" WEIGHTS_OF_N
                    "}}],\"samplers\":[{\"input\":2,\"output\":3}]}]");
    model *m = load(s);
    assert_string_equal(m->clips[0].name, "test");
    assert_string_equal(m->clips[1].name, "test_1");
    model_free(m);
}

/* Three of one name, and one that has the number already. */
static void animations_of_one_name_are_numbered(void **state)
{
    (void)state;
    static const char *const names[4] = { "a_2", "a", "a", "b" };
    static const char *const expected[5] = { "a", "a_2", "a_3", "a_4", "b" };
    scene *s = animated(two_times, two_values, sizeof two_values, "", F32, 2, "", WEIGHTS_OF_N);
    s->rest[strlen(s->rest) - 1] = 0;
    for (int i = 0; i < 4; ++i)
        APPEND(s->rest,
               ",{\"name\":\"%s\",\"channels\":[{\"sampler\":0,\"target\":{" WEIGHTS_OF_N
               "}}],\"samplers\":[{\"input\":2,\"output\":3}]}",
               names[i]);
    APPEND(s->rest, "]");
    model *m = load(s);
    assert_int_equal(m->clip_count, 5);
    for (int i = 0; i < 5; ++i) assert_string_equal(m->clips[i].name, expected[i]);
    assert_true(has_warning(m, "two animations are named 'a': the second is clip 'a_3'"));
    model_free(m);
}

static void an_animated_matrix_is_told(void **state)
{
    (void)state;
    const float moves[6] = { 0, 0, 0, 1, 0, 0 };
    scene *s = triangle("", "");
    add_array(s, two_times, sizeof two_times, F32, 2, "SCALAR");
    add_array(s, moves, sizeof moves, F32, 2, "VEC3");
    APPEND(s->rest, ",\"nodes\":[{\"name\":\"n\",\"mesh\":0,\"matrix\":[2,0,0,0,0,2,0,0,0,0,2,0,0,0,0,1]}],"
                    "\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":"
                    "\"translation\"}}],\"samplers\":[{\"input\":1,\"output\":2}]}]");
    model *m = load(s);
    assert_true(has_warning(m, "node 'n': it has a matrix and is animated"));
    assert_true(m->nodes[0].scale[0] == 2.0f);
    model_free(m);
}

static void animation_without_a_target_is_skipped(void **state)
{
    (void)state;
    model *m = load(animated(two_times, two_values, sizeof two_values, "", F32, 2, "", "\"path\":\"weights\""));
    assert_int_equal(m->clip_count, 0);
    assert_true(has_warning(m, "animation 'a' channel 0 was skipped: it has no target node"));
    model_free(m);
}

static void animation_without_meshes(void **state)
{
    (void)state;
    const float times[2] = { 0, 1 }, moves[6] = { 0, 0, 0, 1, 2, 3 };
    scene *s = scene_new();
    add_array(s, times, sizeof times, F32, 2, "SCALAR");
    add_array(s, moves, sizeof moves, F32, 2, "VEC3");
    APPEND(s->rest, ",\"nodes\":[{}],\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":"
                    "\"translation\"}}],\"samplers\":[{\"input\":0,\"output\":1}]}]");
    model *m = load(s);
    assert_int_equal(m->mesh_count, 0);
    assert_int_equal(m->clips[0].channels[0].width, 3);
    assert_floats(m->clips[0].channels[0].values, moves, 6);
    model_free(m);
}

/* Keys that a clip cannot have: the others stay. */
static void bad_keys_are_left_out(void **state)
{
    (void)state;
    static const struct {
        float times[4], values[4], kept[4], kept_values[4];
        uint32_t count;
        float duration;
        const char *told;
    } cases[] = {
        { { 2, 0.5f, 1, 3 }, { 1, 2, 3, 4 }, { 0.5f, 1, 2, 3 }, { 2, 3, 1, 4 }, 4, 3.0f, "they were sorted" },
        { { 0, 1, 1, 2 }, { 1, 2, 3, 4 }, { 0, 1, 2 }, { 1, 3, 4 }, 3, 2.0f, "key 2 at 1 s has the time of the key" },
        { { 1, 1, 1, 1 }, { 1, 2, 3, 4 }, { 1 }, { 4 }, 1, 1.0f, "(and 2 more like it)" },
        { { 0, 0, 1, 1 }, { 1, 2, 3, 4 }, { 0, 1 }, { 2, 4 }, 2, 1.0f, "the later one was kept" },
        { { 0, INFINITY, 1, 2 }, { 1, 2, 3, 4 }, { 0, 1, 2 }, { 1, 3, 4 }, 3, 2.0f, "key 1: a key with a number" },
        { { NAN, 0, 1, 2 }, { 1, 2, 3, 4 }, { 0, 1, 2 }, { 2, 3, 4 }, 3, 2.0f, "key 0: a key with a number" },
        { { 0, 1, 2, 3 }, { 1, 2, 3, -INFINITY }, { 0, 1, 2 }, { 1, 2, 3 }, 3, 2.0f, "key 3: a key with a number" },
        { { 0, 1, 2, 1e20f }, { 1, 2, 3, 4 }, { 0, 1, 2 }, { 1, 2, 3 }, 3, 2.0f, "key 3: a key with a number" },
        { { -2, -1, 0, 1 }, { 1, 2, 3, 4 }, { -2, -1, 0, 1 }, { 1, 2, 3, 4 }, 4, 1.0f, NULL },
        { { -4, -3, -2, -1 }, { 1, 2, 3, 4 }, { -4, -3, -2, -1 }, { 1, 2, 3, 4 }, 4, -1.0f, NULL },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        model *m = load(keyed(cases[i].times, 4, cases[i].values, 4, "", WEIGHTS_OF_N));
        const model_channel *c = &m->clips[0].channels[0];
        assert_int_equal(c->key_count, cases[i].count);
        assert_floats(c->times, cases[i].kept, cases[i].count);
        assert_floats(c->values, cases[i].kept_values, cases[i].count);
        assert_true(m->clips[0].duration_s == cases[i].duration);
        assert_int_equal(m->warning_count, cases[i].told ? 1 : 0);
        if (cases[i].told) assert_true(has_warning(m, cases[i].told));
        model_free(m);
    }
}

/* A channel that cannot be read is left out; the mesh stays. */
static void bad_channels_are_left_out(void **state)
{
    (void)state;
    const float times[2] = { 0, 1 }, nans[2] = { NAN, NAN }, values[2] = { 0.25f, 1 };
    static const char bare[] = "\"node\":1,\"path\":\"weights\"", far[] = "\"node\":9,\"path\":\"weights\"";
    const struct {
        scene *s;
        uint32_t keys;
        const char *told;
    } cases[] = {
        { keyed(times, 2, values, 1, "", WEIGHTS_OF_N), 1, "does not fit the number of keys" },
        { keyed(times, 2, values, 2, ",\"interpolation\":\"CUBICSPLINE\"", WEIGHTS_OF_N), 0,
          "no key that can be used" },
        { keyed(times, 2, values, 2, ",\"interpolation\":\"BEZIER\"", WEIGHTS_OF_N), 2, "'BEZIER' is unknown" },
        { keyed(nans, 2, values, 2, "", WEIGHTS_OF_N), 0, "it has no key that can be used; the channel was left out" },
        { keyed(times, 0, values, 0, "", WEIGHTS_OF_N), 0, "the accessor has no elements; the channel was left out" },
        { keyed(times, 2, values, 2, "", bare), 0, "it animates weights of a node without a mesh" },
        { keyed(times, 2, values, 2, "", far), 0, "its target node does not exist" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        model *m = load(cases[i].s);
        assert_int_equal(m->mesh_count, 1);
        assert_int_equal(m->clip_count, cases[i].keys > 0);
        if (cases[i].keys) assert_int_equal(m->clips[0].channels[0].key_count, cases[i].keys);
        if (!has_warning(m, cases[i].told)) fail_msg("case %zu: %s", i, m->warnings[0]);
        model_free(m);
    }
}

/* KHR_animation_pointer: what a channel can say without it. */
static void pointers_to_nodes(void **state)
{
    (void)state;
#define POINTER(to) "\"path\":\"pointer\",\"extensions\":{\"KHR_animation_pointer\":{\"pointer\":\"" to "\"}}"
    static const struct {
        const char *target;
        int kept;
    } cases[] = { { POINTER("/nodes/0/weights"), 1 },   { POINTER("/meshes/0/weights"), 1 },
                  { POINTER("/nodes/0/weightsx"), 0 },  { POINTER("/nodes/0/weights/0"), 0 },
                  { POINTER("/materials/0/alpha"), 0 }, { POINTER("/nodes/99/weights"), 0 },
                  { "\"path\":\"pointer\"", 0 } };
    const float times[2] = { 0, 1 }, values[2] = { 0.25f, 1 };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        model *m = load(keyed(times, 2, values, 2, "", cases[i].target));
        assert_int_equal(m->clip_count, cases[i].kept);
        if (cases[i].kept) {
            assert_true(m->clips[0].channels[0].path == MODEL_PATH_WEIGHTS && m->clips[0].channels[0].node == 0);
            assert_floats(m->clips[0].channels[0].values, values, 2);
        }
        assert_true(cases[i].kept ? m->warning_count == 0 : has_warning(m, "animation 'a' channel 0 was skipped: its"));
        model_free(m);
    }
    const float moves[6] = { 0, 0, 0, 1, 2, 3 };
    scene *s = triangle("", "");
    add_array(s, times, sizeof times, F32, 2, "SCALAR");
    add_array(s, moves, sizeof moves, F32, 2, "VEC3");
    APPEND(s->rest, ",\"nodes\":[{},{\"mesh\":0}],\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{" POINTER(
                        "/nodes/1/scale") "}}],\"samplers\":[{\"input\":1,\"output\":2}]}]");
    model *m = load(s);
    assert_true(m->clips[0].channels[0].path == MODEL_PATH_SCALE && m->clips[0].channels[0].node == 1);
    model_free(m);
}

static void weights_of_a_mesh_without_targets_are_skipped(void **state)
{
    (void)state;
    scene *s = triangle("", "");
    add_array(s, two_times, sizeof two_times, F32, 2, "SCALAR");
    add_array(s, two_values, sizeof two_values, F32, 2, "SCALAR");
    APPEND(s->rest, ",\"nodes\":[{\"mesh\":0}],\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{" WEIGHTS_OF_N
                    "}}],\"samplers\":[{\"input\":1,\"output\":2}]}]");
    model *m = load(s);
    assert_true(m->clip_count == 0 && has_warning(m, "it animates weights of a mesh without morph targets"));
    model_free(m);
}

/* --- materials --- */

static const char png_2x1[] = "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAEUlEQVR42mP4z8Dwn6HhvwMAELoDvjp5v74AAAAA"
                              "SUVORK5CYII="; /* red, and a blue of alpha 64 */

static void materials_and_textures(void **state)
{
    (void)state;
    scene *s = triangle("", ",\"material\":0");
    APPEND(s->rest,
           ",\"materials\":[{\"name\":\"skin\",\"alphaMode\":\"MASK\",\"alphaCutoff\":0.25,\"doubleSided\":true,"
           "\"extensions\":{\"KHR_materials_unlit\":{}},\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0.5,0.25,1],"
           "\"metallicFactor\":0,\"baseColorTexture\":{\"index\":0}}},{}],\"textures\":[{\"source\":0,\"sampler\":0}],"
           "\"samplers\":[{\"wrapS\":33071,\"minFilter\":9987}],\"images\":[{\"name\":\"i\",\"uri\":"
           "\"data:image/png;base64,%s\"}]",
           png_2x1);
    model *m = load(s);
    const uint8_t pixels[8] = { 255, 0, 0, 255, 0, 128, 255, 64 };
    const float factor[4] = { 1, 0.5f, 0.25f, 1 };
    const model_material *a = &m->materials[0], *b = &m->materials[1];
    assert_string_equal(a->name, "skin");
    assert_floats(a->base_color, factor, 4);
    assert_true(a->alpha == MODEL_ALPHA_MASK && a->alpha_cutoff == 0.25f && a->double_sided && a->unlit);
    assert_true(a->metallic == 0.0f && a->roughness == 1.0f && a->base_color_texture == 0);
    assert_true(b->alpha == MODEL_ALPHA_OPAQUE && !b->unlit && b->base_color_texture == MODEL_NONE);
    assert_int_equal(m->texture_count, 1);
    assert_true(m->textures[0].width == 2 && m->textures[0].height == 1);
    assert_memory_equal(m->textures[0].rgba, pixels, sizeof pixels);
    assert_int_equal(m->textures[0].wrap_s, 33071);
    assert_int_equal(m->textures[0].wrap_t, 10497);
    assert_int_equal(m->textures[0].min_filter, 9987);
    assert_int_equal(m->textures[0].mag_filter, 0);
    model_free(m);
}

/* What an image would take is counted before it is decoded: a few bytes cannot take minutes, not even by many textures. */
static void large_images_are_counted_first(void **state)
{
    (void)state;
    scene *s = triangle("", ",\"material\":0");
    APPEND(
        s->rest,
        ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}},"
        "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":1}}}],\"textures\":[{\"source\":0},{\"source\":0}],"
        "\"images\":[{\"uri\":\"data:image/png;base64,%s\"}]",
        "iVBORw0KGgoAAAANSUhEUgAAIAAAACAAAQAAAAAAAAAAAAAAAElFTkQAAAAA"); /* 8192 x 8192, without a pixel */
    model *m = load(s);
    assert_true(has_warning(m, "the PNG file has no pixels, only a header: save or copy it again (texture 0 image 0)"));
    assert_true(has_warning(m, "8192 x 8192 pixels; the limit is"));
    model_free(m);
}

/* A shade of the base colour's image needs no texture of its own; a matcap takes its factor. */
static void mtoon_has_textures(void **state)
{
    scene *s = vrm_scene("\"VRMC_vrm\":{}");
    (void)state;
#define TOON(rest)                                                                                              \
    "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}},\"extensions\":{\"VRMC_materials_mtoon\":{" \
    "\"shadeColorFactor\":[0.5,0.5,1]" rest "}}}"
    APPEND(s->rest, "%s", ",\"materials\":[");
    APPEND(s->rest, "%s,",
           TOON(",\"shadeMultiplyTexture\":{\"index\":1},\"matcapTexture\":{\"index\":0},"
                "\"matcapFactor\":[0,1,1],\"outlineWidthMode\":\"screenCoordinates\","
                "\"outlineWidthFactor\":0.004,\"outlineWidthMultiplyTexture\":{\"index\":1}"));
    APPEND(s->rest, "%s,", TOON(",\"shadeMultiplyTexture\":{\"index\":0}"));
    APPEND(s->rest, "%s]", TOON(",\"rimMultiplyTexture\":{\"index\":0}"));
    APPEND(s->rest,
           ",\"textures\":[{\"source\":0},{\"source\":1}],\"images\":[{\"uri\":\"data:image/png;base64,%s\"},"
           "{\"uri\":\"data:image/png;base64,%s\"}]",
           png_2x1, png_2x1);
#undef TOON
    model *m = load(s);
    const uint8_t matcap[8] = { 0, 0, 0, 255, 0, 128, 255, 64 };
    const model_material *own = &m->materials[0], *same = &m->materials[1], *white = &m->materials[2];
    assert_true(own->toon_shade && own->more_textures[NOH_TOON_SHADE] != MODEL_NONE);
    assert_true(own->surface_values[0] == 0.5f && own->surface_more[4] == -0.004f && own->outline_lit);
    assert_memory_equal(m->textures[own->more_textures[NOH_TOON_MATCAP]].rgba, matcap, sizeof matcap);
    assert_int_equal(m->textures[own->more_textures[NOH_TOON_WIDTH]].use, MODEL_TEXTURE_DATA);
    assert_true(!same->toon_shade && same->more_textures[NOH_TOON_SHADE] == MODEL_NONE);
    assert_true(white->toon_shade && white->more_textures[NOH_TOON_SHADE] == MODEL_NONE);
    assert_true(white->more_textures[NOH_TOON_WIDTH] == MODEL_NONE && !white->toon_masks); /* it has no rim */
    model_free(m);
}

/* Images of the edge's shift, the outline's width and the rim are the channels of one texture, in bytes of light; an
 * image that changes nothing has none. */
static void mtoon_has_masks(void **state)
{
    scene *s = vrm_scene("\"VRMC_vrm\":{}");
    (void)state;
#define TOON(rest) "{\"extensions\":{\"VRMC_materials_mtoon\":{\"parametricRimColorFactor\":[1,1,1]," rest "}}}"
    APPEND(s->rest, "%s", ",\"materials\":[");
    APPEND(s->rest, "%s,",
           TOON("\"rimMultiplyTexture\":{\"index\":0},\"shadingShiftTexture\":{\"index\":0,\"scale\":-0.5}"));
    APPEND(s->rest, "%s,", TOON("\"shadingShiftTexture\":{\"index\":0,\"scale\":0}"));
    APPEND(s->rest, "%s]",
           TOON("\"shadingShiftTexture\":{\"index\":0},\"outlineWidthMode\":\"worldCoordinates\","
                "\"outlineWidthFactor\":0.1,\"outlineWidthMultiplyTexture\":{\"index\":0}"));
    APPEND(s->rest, ",\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"data:image/png;base64,%s\"}]", png_2x1);
#undef TOON
    model *m = load(s);
    const uint8_t rim[8] = { 65, 255, 54, 255, 128, 255, 58, 255 }, width[8] = { 255, 0, 255, 255, 128, 128, 255, 255 };
    const model_material *own = &m->materials[0], *none = &m->materials[1], *line = &m->materials[2];
    assert_true(own->toon_masks && !none->toon_masks && line->toon_masks);
    assert_int_equal(m->textures[own->more_textures[NOH_TOON_WIDTH]].use, MODEL_TEXTURE_DATA);
    assert_memory_equal(m->textures[own->more_textures[NOH_TOON_WIDTH]].rgba, rim, sizeof rim);
    assert_memory_equal(m->textures[line->more_textures[NOH_TOON_WIDTH]].rgba, width, sizeof width);
    assert_int_equal(none->more_textures[NOH_TOON_WIDTH], MODEL_NONE);
    assert_true(has_warning(m, "the hue of rimMultiplyTexture of its MToon shading was left out"));
    model_free(m);
}

/* Each property without a place in a pack has a warning, in both versions; what blends keeps its order. */
static void mtoon_is_not_lost_in_silence(void **state)
{
    static const char *const told[] = { "giEqualizationFactor of its MToon shading was taken as 1",
                                        "rimLightingMixFactor of its MToon shading was taken as 1",
                                        "outlineLightingMixFactor of its MToon shading was taken as 1",
                                        "uvAnimationScrollXSpeedFactor of its MToon shading was left out" };
    scene *s = vrm_scene("\"VRMC_vrm\":{}");
    (void)state;
    APPEND(
        s->rest, "%s",
        ",\"materials\":[{\"alphaMode\":\"BLEND\",\"extensions\":{\"VRMC_materials_mtoon\":{\"giEqualizationFactor\":0.5,"
        "\"parametricRimColorFactor\":[1,1,1],\"rimLightingMixFactor\":0,\"outlineWidthMode\":\"screenCoordinates\","
        "\"outlineWidthFactor\":0.01,\"outlineLightingMixFactor\":0.6,\"uvAnimationScrollXSpeedFactor\":0.1,"
        "\"renderQueueOffsetNumber\":-3}}},{\"alphaMode\":\"BLEND\",\"extensions\":{\"VRMC_materials_mtoon\":"
        "{\"transparentWithZWrite\":true,\"renderQueueOffsetNumber\":9}}}]");
    model *m = load(s);
    for (size_t i = 0; i < sizeof told / sizeof told[0]; i++) assert_true(has_warning(m, told[i]));
    assert_int_equal(m->materials[0].priority, -3);
    assert_int_equal(m->materials[1].priority, -91);
    model_free(m);
    s = vrm_scene("\"VRM\":{\"materialProperties\":[{\"shader\":\"VRM/MToon\",\"renderQueue\":2998,\"floatProperties\":"
                  "{\"_UvAnimRotation\":1},\"textureProperties\":{\"_ShadingGradeTexture\":0,\"_RimTexture\":0},"
                  "\"vectorProperties\":{\"_RimColor\":[1,1,1,1]}},{\"shader\":\"VRM/MToon\",\"renderQueue\":2502,"
                  "\"floatProperties\":{\"_BlendMode\":3}}]}");
    APPEND(s->rest,
           ",\"materials\":[{\"alphaMode\":\"BLEND\"},{\"alphaMode\":\"BLEND\"}],\"textures\":[{\"source\":0}],"
           "\"images\":[{\"uri\":\"data:image/png;base64,%s\"}]",
           png_2x1);
    m = load(s);
    assert_true(has_warning(m, "_UvAnimRotation of its MToon shading was left out"));
    assert_true(has_warning(m, "_ShadingGradeTexture of its MToon shading was left out"));
    assert_true(m->materials[0].toon_masks && m->materials[0].priority == -2 && m->materials[1].priority == -99);
    model_free(m);
}

/* The spec bounds them; below 0 or above 1 a surface would make light, or take more than there is. */
static void factors_stay_within_0_and_1(void **state)
{
    (void)state;
    scene *s = triangle("", ",\"material\":0");
    APPEND(s->rest,
           ",\"materials\":[{\"name\":\"neon\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[9,-1,0.5,1.00001],"
           "\"metallicFactor\":-4,\"roughnessFactor\":5}}]");
    model *m = load(s);
    const model_material *a = &m->materials[0];
    const float color[4] = { 1.0f, 0.0f, 0.5f, 1.0f };
    assert_floats(a->base_color, color, 4);
    assert_true(a->metallic == 0.0f && a->roughness == 1.0f);
    assert_true(has_warning(m, "material 'neon': its baseColorFactor of 9 became 1"));
    assert_true(has_warning(m, "material 'neon': its metallicFactor of -4 became 0"));
    assert_true(has_warning(m, "material 'neon': its roughnessFactor of 5 became 1"));
    model_free(m);
}

/* Diffuse becomes base colour, specular what reflects straight on, by texel, glossiness the roughness in its alpha. */
static void specular_and_glossiness(void **state)
{
    (void)state;
    scene *s = triangle("", ",\"material\":0");
    APPEND(s->rest,
           ",\"materials\":[{\"name\":\"brass\",\"pbrMetallicRoughness\":{\"metallicFactor\":0.3},\"extensions\":{"
           "\"KHR_materials_pbrSpecularGlossiness\":{\"diffuseFactor\":[0.5,0.25,0.125,0.75],\"specularFactor\":"
           "[1,0.5,0.25],\"glossinessFactor\":0.5,\"diffuseTexture\":{\"index\":0},"
           "\"specularGlossinessTexture\":{\"index\":0}}}},{\"extensions\":{\"KHR_materials_pbrSpecularGlossiness\":"
           "{\"glossinessFactor\":0.25}}}],\"extensionsRequired\":[\"KHR_materials_pbrSpecularGlossiness\"],"
           "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"data:image/png;base64,%s\"}]",
           png_2x1);
    model *m = load(s);
    const model_material *a = &m->materials[0], *b = &m->materials[1];
    const float diffuse[4] = { 0.5f, 0.25f, 0.125f, 0.75f }, white[4] = { 1, 1, 1, 1 };
    const uint8_t map[8] = { 255, 0, 0, 128, 0, 128, 255, 223 }; /* of glossiness 1 and 64 / 255, halved */
    assert_floats(a->base_color, diffuse, 4);
    assert_true(a->metallic == 0.0f && a->roughness == 1.0f && a->base_color_texture != MODEL_NONE);
    assert_true(a->f0[0] == 1.0f && a->f0[1] == 0.5f && a->f0[2] == 0.25f);
    assert_true(a->surface_texture == MODEL_NONE && a->specular_roughness == 1 && a->f90_loss == 0.0f);
    assert_true(a->specular_texture != MODEL_NONE && a->specular_texture != a->base_color_texture);
    assert_memory_equal(m->textures[a->specular_texture].rgba, map, sizeof map);
    assert_int_equal(m->textures[a->specular_texture].use, MODEL_TEXTURE_COLOR);
    assert_int_equal(m->textures[a->specular_texture].alpha_is_data, 1);
    assert_floats(b->base_color, white, 4);
    assert_floats(b->f0, white, 3);
    assert_true(b->metallic == 0.0f && b->roughness == 0.75f && b->surface_texture == MODEL_NONE);
    assert_int_equal(m->warning_count, 0);
    model_free(m);
}

/* KHR_materials_specular by texel: the weight goes into the alpha of the surface map, or of the colours where there are
 * any, so that each material reads one texture more at most. */
static void specular_maps_are_packed(void **state)
{
    (void)state;
    scene *s = triangle("", ",\"material\":0");
#define SPECULAR(members) "{\"extensions\":{\"KHR_materials_specular\":{" members "}}"
    APPEND(s->rest, "%s", ",\"materials\":[");
    APPEND(s->rest, "%s},", SPECULAR("\"specularFactor\":0.5,\"specularTexture\":{\"index\":0}"));
    APPEND(s->rest, "%s},", SPECULAR("\"specularColorTexture\":{\"index\":0},\"specularColorFactor\":[2,1,30]"));
    APPEND(s->rest, "%s},", SPECULAR("\"specularColorTexture\":{\"index\":0},\"specularTexture\":{\"index\":0}"));
    APPEND(
        s->rest, "%s,",
        SPECULAR(
            "\"specularTexture\":{\"index\":0}") ",\"occlusionTexture\":{\"index\":0},"
                                                 "\"pbrMetallicRoughness\":{\"metallicRoughnessTexture\":{\"index\":0}}}");
    APPEND(s->rest, "%s},", SPECULAR("\"specularFactor\":0.5,\"specularColorFactor\":[1,1,100]"));
    APPEND(s->rest, "%s}]", SPECULAR("\"specularColorTexture\":{\"index\":0},\"specularTexture\":{\"index\":1}"));
    APPEND(s->rest,
           ",\"textures\":[{\"source\":0},{\"source\":1}],\"images\":[{\"uri\":\"data:image/png;base64,%s\"},"
           "{\"uri\":\"nowhere.png\"}]",
           png_2x1);
#undef SPECULAR
    model *m = load(s);
    const model_material *a = m->materials;
    const uint8_t weight[8] = { 255, 255, 255, 255, 255, 255, 255, 64 }, all[8] = { 255, 0, 0, 255, 0, 128, 255, 64 };
    const uint8_t colors[8] = { 255, 0, 0, 255, 0, 128, 255, 255 };
    assert_true(a[0].specular_texture == MODEL_NONE && a[0].f90_loss == 0.5f && fabsf(a[0].f0[0] - 0.02f) < 1e-6f);
    assert_memory_equal(m->textures[a[0].surface_texture].rgba, weight, sizeof weight);
    assert_true(a[1].surface_texture == MODEL_NONE && !a[1].specular_roughness);
    assert_memory_equal(m->textures[a[1].specular_texture].rgba, colors, sizeof colors);
    assert_true(fabsf(a[1].f0[0] - 0.08f) < 1e-6f &&
                fabsf(a[1].f0[2] - 1.2f) < 1e-5f); /* the map may bring it below 1 */
    assert_memory_equal(m->textures[a[2].specular_texture].rgba, all, sizeof all);
    assert_true(a[2].surface_texture == MODEL_NONE && m->textures[a[2].specular_texture].with_alpha);
    assert_memory_equal(m->textures[a[3].surface_texture].rgba, all, sizeof all);
    assert_true(a[4].f0[2] == 0.5f && a[4].f90_loss == 0.5f); /* at most the weight */
    assert_memory_equal(m->textures[a[5].specular_texture].rgba, colors, sizeof colors);
    assert_int_equal(m->warning_count, 1);
    model_free(m);
}

static void check_left_out_texture(const char *image, const char *reason)
{
    scene *s = triangle("", ",\"material\":0");
    APPEND(s->rest,
           ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],"
           "\"textures\":[{\"source\":0}],\"images\":[%s]",
           image);
    model *m = load(s);
    assert_int_equal(m->materials[0].base_color_texture, MODEL_NONE);
    assert_int_equal(m->texture_count, 0);
    if (!has_warning(m, reason)) fail_msg("no warning about '%s'", reason);
    model_free(m);
}

static void bad_images_are_warnings(void **state)
{
    (void)state;
    check_left_out_texture("{\"uri\":\"nowhere.png\"}", "does not exist");
    check_left_out_texture("{\"uri\":\"data:image/png;base64,AAAA\"}", "of an unknown kind, not a PNG");
    check_left_out_texture(
        "{\"uri\":\"data:image/png;base64,dmVyc2lvbiBodHRwczovL2dpdC1sZnMuZ2l0aHViLmNvbS9zcGVjL3YxCg==\"}",
        "it is a Git LFS pointer in place of the file: run git lfs pull");
    check_left_out_texture("{\"uri\":\"data:image/png;base64,PCFkb2N0eXBlIGh0bWw+PGh0bWw+PC9odG1sPg==\"}",
                           "it is a web page in place of the file");
    check_left_out_texture("{\"uri\":\"data:image/png;base64,AAAAIGZ0eXBhdmlmAAAAAA==\"}",
                           "it is an AVIF picture, not a PNG");
    check_left_out_texture("{\"uri\":\"data:image/png;base64,iVBORw0KGgoAAAAAAAAA\"}", "damaged");
    check_left_out_texture("{\"bufferView\":99}", "buffer view 99 does not exist");
    check_left_out_texture("{\"uri\":\"/etc/hostname\"}", "not a relative path");
    check_left_out_texture("{}", "neither a 'uri' nor a 'bufferView'");
}

/* Red, and a blue that lets four fifths through: lossless WebP. */
static const char webp_2x1[] = "UklGRiAAAABXRUJQVlA4TBQAAAAvAQAAEA8wgPs//6f5Dy1UIKL/AQ==";

static scene *webp_scene(const char *texture, size_t length)
{
    scene *s = triangle("", ",\"material\":0");
    APPEND(s->rest,
           ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],\"textures\":[%s],"
           "\"images\":[{\"uri\":\"data:image/webp;base64,%.*s\"}]",
           texture, (int)length, webp_2x1);
    return s;
}

static void webp_textures(void **state)
{
    (void)state;
    static const char texture[] = "{\"extensions\":{\"EXT_texture_webp\":{\"source\":0}}}";
    const uint8_t pixels[8] = { 255, 0, 0, 255, 0, 128, 255, 51 };
    model *m = load(webp_scene(texture, sizeof webp_2x1 - 1));
    if (has_warning(m, "libwebp, which is not installed")) {
        model_free(m);
        printf("libwebp is missing\n");
        skip();
    }
    assert_int_equal(m->texture_count, 1);
    assert_true(m->textures[0].width == 2 && m->textures[0].height == 1);
    assert_memory_equal(m->textures[0].rgba, pixels, sizeof pixels);
    model_free(m);
    for (size_t length = 24; length < sizeof webp_2x1 - 4; length += 4) {
        m = load(webp_scene(texture, length));
        assert_int_equal(m->texture_count, 0);
        assert_true(m->warning_count > 0);
        model_free(m);
    }
    m = load(webp_scene("{\"extensions\":{\"EXT_texture_webp\":{\"source\":7}}}", sizeof webp_2x1 - 1));
    assert_true(has_warning(m, "image 7 does not exist"));
    model_free(m);
    m = load(webp_scene("{\"extensions\":{\"KHR_texture_basisu\":{\"source\":0}}}", sizeof webp_2x1 - 1));
    assert_true(has_warning(m, "KHR_texture_basisu (KTX2), which is not supported"));
    model_free(m);
}

static void texture_transform_is_baked(void **state)
{
    (void)state;
    /* scaled, then turned by a right angle, then moved: u' = 3 v + 0.5, v' = -2 u + 0.25 */
    const float uv[6] = { 0, 0, 1, 0, 0, 1 }, expected[6] = { 0.5f, 0.25f, 0.5f, -1.75f, 3.5f, 0.25f };
    scene *s = triangle(",\"TEXCOORD_0\":1", ",\"material\":0");
    add_array(s, uv, sizeof uv, F32, 3, "VEC2");
    APPEND(s->rest,
           ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,\"extensions\":{"
           "\"KHR_texture_transform\":{\"offset\":[0.5,0.25],\"scale\":[2,3],\"rotation\":1.5707963267948966}}}}}],"
           "\"textures\":[{}]");
    model *m = load(s);
    assert_floats(m->meshes[0].uv, expected, 6);
    assert_false(has_warning(m, "KHR_texture_transform"));
    model_free(m);
}

/* Deltas of texture coordinates are scaled and turned as those are, but not moved; of another UV set they are left
 * out. */
static void targets_move_texture_coordinates(void **state)
{
    (void)state;
    const float uv[6] = { 0, 0, 1, 0, 0, 1 }, deltas[6] = { 0.1f, 0, 0, 0.2f, 0, 0 };
    const float expected[6] = { 0, -0.2f, 0.6f, 0, 0, 0 }, zeros[9] = { 0 };
    scene *s = triangle(",\"TEXCOORD_0\":1,\"TEXCOORD_1\":1",
                        ",\"material\":0,\"targets\":[{\"TEXCOORD_0\":2},{\"POSITION\":0},{\"TEXCOORD_1\":2}]");
    add_array(s, uv, sizeof uv, F32, 3, "VEC2");
    add_array(s, deltas, sizeof deltas, F32, 3, "VEC2");
    APPEND(s->rest,
           ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,\"extensions\":{"
           "\"KHR_texture_transform\":{\"offset\":[0.5,0.25],\"scale\":[2,3],\"rotation\":1.5707963267948966}}}}}],"
           "\"textures\":[{}]");
    model *m = load(s);
    const model_target *t = m->meshes[0].targets;
    assert_floats(t[0].uv, expected, 6);
    assert_memory_equal(t[0].position, zeros, sizeof zeros);
    assert_memory_equal(t[0].normal, zeros, sizeof zeros);
    assert_null(t[1].uv);
    assert_null(t[2].uv);
    assert_true(has_warning(m, "the deltas of TEXCOORD_1 were ignored"));
    model_free(m);
}

/* --- bad input --- */

static void not_gltf_is_refused(void **state)
{
    (void)state;
    write_text("test.gltf", "solid cube\nfacet normal 0 0 1\n");
    file_refused("not a glTF file", "byte 0");
    write_text("test.gltf", "");
    file_refused("not a glTF file", "");
    write_text("test.gltf", "{\"asset\":{\"version\":\"2.0\"},\"meshes\":[}");
    file_refused("the JSON is broken", "glTF JSON");
    write_text("test.gltf", "{\"hello\":1}");
    file_refused("there is nothing to convert; there is no 'asset' object", "glTF JSON");
    write_text("test.gltf", "{\"asset\":{\"version\":\"1.0\"}}");
    file_refused("glTF version '1.0', and only version 2 is read: convert version 1 with gltf-pipeline", "asset");
    snprintf(file_path, sizeof file_path, "%s/nothing.glb", folder);
    file_refused("does not exist", "");
    snprintf(file_path, sizeof file_path, "%s", folder);
    file_refused("not a file", "");
}

static void nothing_to_convert_is_refused(void **state)
{
    (void)state;
    write_text("test.gltf", "{\"asset\":{\"version\":\"2.0\"}}");
    file_refused("no triangle meshes and no animations", "");
    /* Nodes outside the scene are no reason. */
    write_text("test.gltf",
               "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{},{}],\"scene\":0,\"scenes\":[{\"nodes\":[0]}]}");
    file_refused("there is nothing to convert", "glTF JSON");
}

static void deep_json_is_refused(void **state)
{
    (void)state;
    char json[3000] = "{\"asset\":{\"version\":\"2.0\"},\"extras\":";
    for (int i = 0; i < 1000; ++i) APPEND(json, "[");
    write_text("test.gltf", json);
    file_refused("nested deeper", "JSON byte");
}

/* Where nothing else is in the file, a missing required part is why there is nothing to convert. */
static void missing_members_are_refused_by_name(void **state)
{
    (void)state;
    static const char *const all[][3] = {
        { "\"accessors\":[{\"componentType\":5126,\"count\":3}]", "'type' is missing", "glTF JSON/accessors/0" },
        { "\"accessors\":[{\"componentType\":5126,\"count\":3,\"type\":\"VEC9\"}]", "the type 'VEC9' must be",
          "glTF JSON/accessors/0" },
        { "\"accessors\":[{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{\"count\":1,\"indices\":{"
          "\"bufferView\":0},\"values\":{\"bufferView\":0}}}]",
          "'sparse/indices/componentType' is missing", "glTF JSON/accessors/0" },
        { "\"bufferViews\":[{\"buffer\":0,\"byteLength\":8,\"byteStride\":6}]", "'byteStride' is 6",
          "glTF JSON/bufferViews/0" },
        { "\"meshes\":[{\"primitives\":[{\"mode\":4}]}]", "'attributes' is missing",
          "glTF JSON/meshes/0/primitives/0" },
        { "\"meshes\":[{\"primitives\":[7]}]", "this must be an object", "glTF JSON/meshes/0/primitives/0" },
        { "\"animations\":[{\"samplers\":[],\"channels\":[{\"sampler\":0,\"target\":{\"node\":0}}]}]",
          "'target/path' is missing", "glTF JSON/animations/0/channels/0" },
        { "\"skins\":[{}]", "'joints' is missing", "glTF JSON/skins/0" },
        { "\"skins\":[{\"joints\":3}]", "'joints' must be an array", "glTF JSON/skins/0" },
    };
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        char text[512];
        (void)snprintf(text, sizeof text, "{\"asset\":{\"version\":\"2.0\"},%s}", all[i][0]);
        write_text("test.gltf", text);
        file_refused(all[i][1], all[i][2]);
    }
}

static void required_extensions_are_warnings(void **state)
{
    (void)state;
    scene *s = triangle("", "");
    APPEND(s->rest, ",\"extensionsRequired\":[\"KHR_texture_basisu\"]");
    model *m = load(s);
    assert_true(has_warning(m, "extensionsRequired: the file needs the extension KHR_texture_basisu, which is not "
                               "supported: what depends on it was left out (PNG"));
    model_free(m);
}

static void unknown_extensions_are_warnings(void **state)
{
    (void)state;
    scene *s = triangle("", "");
    APPEND(s->rest, ",\"extensionsUsed\":[\"KHR_lights_punctual\"]");
    model *m = load(s);
    assert_true(has_warning(m, "KHR_lights_punctual is not supported and was ignored"));
    model_free(m);
}

/* What is not in a truncated file is left out; where that is too much, it is refused. */
static void every_truncation_of_a_glb_is_told(void **state)
{
    (void)state;
    static unsigned char bytes[8192];
    scene *s = morphing(up_deltas, ONE_TARGET);
    save_glb(s);
    free(s);
    FILE *in = fopen(file_path, "rb");
    assert_non_null(in);
    size_t size = fread(bytes, 1, sizeof bytes, in);
    fclose(in);
    for (size_t cut = 0; cut < size; ++cut) {
        FILE *out = fopen(file_path, "wb");
        assert_non_null(out);
        fwrite(bytes, 1, cut, out);
        fclose(out);
        model *m = NULL;
        model_error error = { "", "" };
        const int failed = model_read_gltf(file_path, &m, &error);
        if (failed && !strstr(error.what, cut < 4 ? "not a glTF" : "truncated")) fail_msg("%s", error.what);
        if (!failed && !has_warning(m, "is truncated, export or copy it again")) fail_msg("%zu: no warning", cut);
        model_free(m);
    }
}

static void triangles_of_missing_vertices_are_left_out(void **state)
{
    (void)state;
    const uint16_t index[9] = { 0, 1, 3, 2, 1, 0, 7, 8, 9 };
    scene *s = triangle("", ",\"indices\":1");
    add_array(s, index, sizeof index, U16, 9, "SCALAR");
    model *m = load(s);
    assert_true(m->meshes[0].index_count == 3 && m->meshes[0].indices[0] == 2);
    assert_true(has_warning(m, "mesh 'm' primitive 0 triangle 0 was left out: the primitive has no such vertex (and 1 "
                               "more like it)"));
    model_free(m);
    s = triangle("", ",\"indices\":1");
    add_array(s, index, 6, U16, 3, "SCALAR");
    refused(s, "nothing to convert; a part was left out: the primitive has no such vertex",
            "mesh 'm' primitive 0 triangle 0");
}

static void half_a_triangle_is_left_out(void **state)
{
    (void)state;
    const uint16_t index[4] = { 0, 1, 2, 0 };
    scene *s = triangle("", ",\"indices\":1");
    add_array(s, index, sizeof index, U16, 4, "SCALAR");
    model *m = load(s);
    assert_int_equal(m->meshes[0].index_count, 3);
    assert_true(has_warning(m, "mesh 'm' primitive 0: its last corners are no whole triangle"));
    model_free(m);
}

/* Of an attribute that the surface can do without: what was done instead. */
static void check_lost(scene *s, const char *what)
{
    model *m = load(s);
    if (!has_warning(m, what)) fail_msg("%s", m->warning_count ? m->warnings[0] : "no warning");
    assert_true(m->meshes[0].vertex_count == 3 && m->meshes[0].normal[2] == 1.0f);
    model_free(m);
}

/* Wrong types and missing members, each in a file that has all else: it is read, with one warning that names it. */
static void damaged_members_are_left_out(void **state)
{
    static const char *const cases[][2] = {
        { "\"materials\":[{\"name\":3}]", "materials/0: 'name' must be a text" },
        { "\"materials\":[7]", "materials/0: this must be an object" },
        { "\"materials\":{}", "'materials' must be an array" },
        { "\"materials\":[{\"alphaMode\":1}]", "materials/0: 'alphaMode' must be a text" },
        { "\"materials\":[{\"alphaCutoff\":\"0.5\"}]", "materials/0: 'alphaCutoff' must be a number" },
        { "\"materials\":[{\"doubleSided\":1}]", "materials/0: 'doubleSided' must be true or false" },
        { "\"materials\":[{\"emissiveFactor\":[1,1]}]", "materials/0: 'emissiveFactor' must be 3 numbers" },
        { "\"materials\":[{\"emissiveFactor\":[1,1e30,1]}]", "'emissiveFactor' must be 3 numbers up to 1e12" },
        { "\"materials\":[{\"pbrMetallicRoughness\":[]}]", "'pbrMetallicRoughness' must be an object" },
        { "\"materials\":[{\"pbrMetallicRoughness\":{\"metallicFactor\":\"x\"}}]",
          "materials/0/pbrMetallicRoughness: 'metallicFactor' must be a number" },
        { "\"materials\":[{\"pbrMetallicRoughness\":{\"roughnessFactor\":[1]}}]",
          "'roughnessFactor' must be a number" },
        { "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1]}}]",
          "'baseColorFactor' must be 4 numbers" },
        { "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{}}}]", "'baseColorTexture' has no 'index'" },
        { "\"materials\":[{\"normalTexture\":{\"index\":\"0\"}}]", "normalTexture: 'index' must be a whole" },
        { "\"materials\":[{\"normalTexture\":4}]", "materials/0: 'normalTexture' must be an object" },
        { "\"materials\":[{\"occlusionTexture\":{\"strength\":1}}]", "'occlusionTexture' has no 'index'" },
        { "\"materials\":[{\"extensions\":{\"KHR_materials_ior\":{\"ior\":\"1.5\"}}}]",
          "materials/0/extensions/KHR_materials_ior: 'ior' must be a number" },
        { "\"materials\":[{\"extensions\":{\"KHR_materials_specular\":{\"specularColorFactor\":1}}}]",
          "'specularColorFactor' must be 3 numbers" },
        { "\"materials\":[{\"extensions\":3}]", "materials/0: 'extensions' must be an object" },
        { "\"textures\":[null]", "textures/0: this must be an object" },
        { "\"textures\":[{\"sampler\":[]}]", "textures/0: 'sampler' must be a whole number" },
        { "\"images\":[{\"uri\":5}]", "images/0: 'uri' must be a text" },
        { "\"samplers\":[{\"wrapS\":-1}]", "samplers/0: 'wrapS' is out of range" },
        { "\"cameras\":[{\"name\":\"c\"}]", "camera 'c': cameras are not kept" },
        { "\"cameras\":[3]", "camera 'camera_0': cameras are not kept" },
        { "\"nodes\":[{\"mesh\":0},{\"children\":3}]", "nodes/1: 'children' must be an array" },
        { "\"nodes\":[{\"mesh\":0},{\"children\":[\"x\"]}]", "nodes/1/children/0: 'node' must be a whole number" },
        { "\"nodes\":[{\"mesh\":0},{\"rotation\":\"x\"}]", "nodes/1: 'rotation' must be numbers" },
        { "\"nodes\":[{\"mesh\":0},{\"scale\":[1,\"1\",1]}]", "nodes/1: 'scale' must be numbers" },
        { "\"nodes\":[{\"mesh\":0},{\"weights\":1}]", "nodes/1: 'weights' must be numbers" },
        { "\"nodes\":[{\"mesh\":0},false]", "nodes/1: this must be an object" },
        { "\"nodes\":[{\"mesh\":0,\"skin\":0}],\"skins\":[{}]", "skins/0: 'joints' is missing" },
        { "\"scenes\":[{\"nodes\":0}]", "scenes/0: 'nodes' must be an array" },
        { "\"scene\":\"x\"", "glTF JSON: 'scene' must be a whole number" },
        { "\"animations\":[{\"channels\":[]}]", "animations/0: 'samplers' is missing" },
        { "\"animations\":[{\"channels\":[1],\"samplers\":[]}]", "animations/0/channels/0: this must be an object" },
        { "\"animations\":[{\"channels\":[{\"sampler\":0}],\"samplers\":[]}]", "channels/0: 'target' is missing" },
        { "\"animations\":[{\"channels\":[],\"samplers\":[{\"input\":0}]}]", "samplers/0: 'output' is missing" },
        { "\"animations\":7", "'animations' must be an array" },
        { "\"extensionsUsed\":\"KHR_x\"", "'extensionsUsed' must be an array" },
        { "\"extensionsRequired\":{}", "'extensionsRequired' must be an array" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        scene *s = triangle("", "");
        APPEND(s->rest, ",%s", cases[i][0]);
        check_lost(s, cases[i][1]);
    }
    check_lost(triangle(",\"NORMAL\":\"x\"", ""), "primitives/0/attributes/NORMAL: 'attribute' must be a whole number");
    check_lost(triangle("", ",\"targets\":3"), "meshes/0/primitives/0: 'targets' must be an array");
    check_lost(triangle("", ",\"material\":{}"), "meshes/0/primitives/0: 'material' must be a whole number");
}

/* What the file says of itself counts less than what is in it. */
static void wrong_headers_are_warnings(void **state)
{
    static unsigned char bytes[8192];
    static const struct {
        size_t at;
        int32_t by;
        const char *warning;
    } cases[] = {
        { 4, 1, "GLB header: this is glTF version 3; it was read as version 2" },
        { 4, -2, "GLB header: this is glTF version 0" },
        { 8, 1000, "GLB header: it says" },
    };
    (void)state;
    scene *s = triangle("", "");
    save_glb(s);
    free(s);
    FILE *in = fopen(file_path, "rb");
    assert_non_null(in);
    const size_t size = fread(bytes, 1, sizeof bytes, in);
    fclose(in);
    for (size_t i = 0; i <= sizeof cases / sizeof cases[0]; ++i) {
        unsigned char copy[sizeof bytes];
        memcpy(copy, bytes, size);
        if (i < sizeof cases / sizeof cases[0])
            copy[cases[i].at] = (unsigned char)(copy[cases[i].at] + cases[i].by),
            copy[cases[i].at + 1] = (unsigned char)(copy[cases[i].at + 1] + cases[i].by / 256);
        else
            memset(copy + 8, 0, 4); /* a length of 0: all chunks are there */
        FILE *out = fopen(file_path, "wb");
        assert_non_null(out);
        fwrite(copy, 1, size, out);
        fclose(out);
        model *m = load_file();
        assert_true(m->mesh_count == 1 && m->meshes[0].vertex_count == 3);
        if (i < sizeof cases / sizeof cases[0] && !has_warning(m, cases[i].warning)) fail_msg("case %zu", i);
        model_free(m);
    }
}

static void versions_are_warnings(void **state)
{
    static const char *const assets[][2] = {
        { "\"extras\":0", "there is no 'asset' object; the file was read as glTF version 2" },
        { "\"asset\":3", "there is no 'asset' object" },
        { "\"asset\":{}", "this is glTF version ''; it was read as version 2" },
        { "\"asset\":{\"version\":\"3.0\"}", "this is glTF version '3.0'; it was read as version 2" },
        { "\"asset\":{\"version\":\"2.1\",\"minVersion\":\"2.1\"}",
          "needs a reader of glTF version '2.1'; it was read" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof assets / sizeof assets[0]; ++i) {
        char json[1024];
        (void)snprintf(json, sizeof json,
                       "{%s,\"buffers\":[{\"uri\":\"data:application/octet-stream;base64,"
                       "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],"
                       "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,"
                       "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
                       "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}",
                       assets[i][0]);
        write_text("test.gltf", json);
        model *m = load_file();
        assert_true(m->meshes[0].vertex_count == 3 && m->meshes[0].position[3] == 1.0f);
        if (!has_warning(m, assets[i][1])) fail_msg("%s", m->warnings[0]);
        assert_true(has_warning(m, "buffer 0: 'byteLength' is missing; all of its bytes were taken"));
        model_free(m);
    }
}

static void wrong_types_are_left_out(void **state)
{
    (void)state;
    const float values[12] = { 0 };
    scene *s = triangle(",\"NORMAL\":1", "");
    add_array(s, values, 24, F32, 3, "VEC2");
    check_lost(s, "NORMAL (accessor 1): the accessor's type is VEC2, but this needs VEC3; normals were computed");
    s = triangle(",\"NORMAL\":1", "");
    add_array(s, values, 36, U32, 3, "VEC3");
    check_lost(s, "component type UNSIGNED_INT is not allowed");
    s = triangle(",\"TEXCOORD_0\":1", "");
    add_array(s, values, 12, U16, 3, "VEC2");
    check_lost(s, "KHR_mesh_quantization missing");
    s = triangle(",\"COLOR_0\":1", "");
    add_array(s, values, 12, F32, 3, "SCALAR");
    check_lost(s, "COLOR_0 (accessor 1): the accessor's type is SCALAR, but this needs VEC3; colours are white");
    s = triangle("", ",\"targets\":[{\"POSITION\":1}]");
    add_array(s, values, 48, F32, 3, "VEC4");
    check_lost(s,
               "mesh 'm' primitive 0 target 0 POSITION (accessor 1): the accessor's type is VEC4, but this needs VEC3");
    s = triangle("", ",\"indices\":1");
    add_array(s, values, 12, F32, 3, "SCALAR");
    refused(s, "component type FLOAT is not allowed", "mesh 'm' primitive 0 indices (accessor 1)");
}

static void accessors_outside_their_bytes_are_left_out(void **state)
{
    (void)state;
    const float values[9] = { 0 };
    scene *s = triangle(",\"NORMAL\":1", "");
    add_array(s, values, 35, F32, 3, "VEC3");
    check_lost(s, "NORMAL (accessor 1): it needs 36 bytes of its buffer view, which has 35");
    s = triangle(",\"NORMAL\":1", "");
    APPEND(s->views, ",{\"buffer\":0,\"byteOffset\":4,\"byteLength\":36}");
    ++s->view_count;
    add_accessor(s, F32, 3, "VEC3", ",\"bufferView\":1");
    check_lost(s, "NORMAL (accessor 1), buffer view 1: bytes 4 to 40 are out of range: buffer 0 has 36");
    s = triangle(",\"NORMAL\":1", "");
    add_accessor(s, F32, 3, "VEC3", ",\"bufferView\":7");
    check_lost(s, "buffer view 7 does not exist");
    check_lost(triangle(",\"NORMAL\":7", ""), "mesh 'm' primitive 0 NORMAL: accessor 7 does not exist");
    s = triangle(",\"NORMAL\":1", "");
    add_array(s, values, 24, F32, 2, "VEC3");
    check_lost(s, "has 2 elements, but 3 are needed");
}

/* A program that adds data to a .glb may leave its buffer's length as it was. */
static void bytes_behind_a_wrong_length_are_read(void **state)
{
    (void)state;
    write_text("test.gltf",
               "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":12,\"uri\":"
               "\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],"
               "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,"
               "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
               "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}");
    model *m = load_file();
    assert_true(m->meshes[0].vertex_count == 3 && m->meshes[0].position[3] == 1.0f);
    assert_true(has_warning(m, "buffer 0: 'byteLength' says 12, but it has 36 bytes, and later ones are needed"));
    model_free(m);
}

static void giant_counts_are_refused(void **state)
{
    (void)state;
    scene *s = scene_new();
    add_accessor(s, F32, 2000000000, "VEC3", "");
    APPEND(s->primitives, "{\"attributes\":{\"POSITION\":0}}");
    refused(s, "would need more than 256 MiB", "mesh 'm' primitive 0");
    s = triangle("", "");
    APPEND(s->accessors, ",{\"componentType\":5126,\"count\":18446744073709551615,\"type\":\"VEC3\",\"bufferView\":0}");
    check_lost(s, "glTF JSON/accessors/1: 'count' is out of range (0 to 4294967295); it was left out");
    s = triangle("", ",\"indices\":1");
    add_view(s, triangle_positions, 4, 0);
    add_accessor(s, U8, 2000000000, "SCALAR", ",\"bufferView\":1");
    refused(s, "it needs 2000000000 bytes", "indices (accessor 1)");
    s = triangle("", ",\"indices\":1");
    add_accessor(s, U8, 20000000, "SCALAR",
                 ",\"bufferView\":-1,\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":0,"
                 "\"componentType\":5121},\"values\":{\"bufferView\":0}}");
    refused(s, "", "");
}

static void missing_buffers_are_refused(void **state)
{
    (void)state;
    static const char format[] =
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":%s}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
        "\"count\":3,\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}";
    char json[1024];
    snprintf(json, sizeof json, format, "36,\"uri\":\"gone.bin\"");
    write_text("test.gltf", json);
    file_refused("does not exist", "buffer 0");
    snprintf(json, sizeof json, format, "36");
    write_text("test.gltf", json);
    file_refused("buffer 0 has no data", "mesh 'mesh_0' primitive 0 POSITION (accessor 0), buffer view 0");
    snprintf(json, sizeof json, format, "36,\"uri\":\"data:application/octet-stream;base64,AAAA\"");
    write_text("test.gltf", json);
    file_refused("3 bytes, but 'byteLength' says 36", "buffer 0");
    snprintf(json, sizeof json, format, "36,\"uri\":\"/etc/hostname\"");
    write_text("test.gltf", json);
    file_refused("not a relative path", "buffer 0");
    write_text("test.bin", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n");
    snprintf(json, sizeof json, format, "36,\"uri\":\"test.bin\"");
    write_text("test.gltf", json);
    file_refused("'test.bin' is a Git LFS pointer in place of the file: run git lfs pull", "buffer 0");
    snprintf(file_path, sizeof file_path, "%s/test.bin", folder);
    assert_int_equal(remove(file_path), 0);
}

/* The bytes say what came in place of a file, whatever its ending is. */
static void bytes_say_what_came_in_place_of_a_file(void **state)
{
    static const char *const endings[] = { "test.glb", "test.fbx", "test.png", "test.zip" };
    (void)state;
    for (size_t i = 0; i < sizeof endings / sizeof endings[0]; i++) {
        write_text(endings[i], "version https://git-lfs.github.com/spec/v1\n");
        const file_kind *kind = file_kind_of(file_path);
        assert_non_null(kind);
        assert_int_equal(kind->reader, READER_NONE);
        assert_string_equal(kind->what, "a Git LFS pointer in place of the file");
        write_text(endings[i], "<!DOCTYPE html>\n<html>");
        assert_string_equal(file_kind_of(file_path)->what, "a web page in place of the file");
        write_text(endings[i], i & 1u ? "\xef\xbb\xbf<HTML>" : "\n\n\r\n<!doctype HTML>");
        assert_string_equal(file_kind_of(file_path)->what, "a web page in place of the file");
        assert_int_equal(remove(file_path), 0);
    }
}

/* Bad numbers of any attribute are read as 0, with the first place and a count. */
static void check_zeroed(scene *s, const char *place, int others)
{
    char text[256], more[32] = "";
    model *m = load(s);
    if (others) snprintf(more, sizeof more, " (and %d more like it)", others);
    snprintf(text, sizeof text, "mesh 'm' primitive 0 %s: the value is NaN, infinite or above 1e12; it was read as 0%s",
             place, more);
    if (!has_warning(m, text)) fail_msg("%s", m->warning_count ? m->warnings[0] : "no warning");
    for (size_t i = 0; i < 9; i++) {
        assert_true(fabsf(m->meshes[0].position[i]) <= 1.0f && fabsf(m->meshes[0].normal[i]) <= 1.0f);
        assert_true(!m->meshes[0].target_count || fabsf(m->meshes[0].targets[0].position[i]) <= 1.0f);
        assert_true(!m->meshes[0].uv || i > 5 || fabsf(m->meshes[0].uv[i]) <= 1.0f);
    }
    model_free(m);
}

static void numbers_that_are_not_finite_are_zeros(void **state)
{
    (void)state;
    const float bad[4] = { NAN, INFINITY, -INFINITY, 2e12f };
    for (int i = 0; i < 4; i++) {
        float values[12] = { 1, 0, 0, 0, bad[i], 0, 0, 1, 0, 0, 0, 1 };
        scene *s = scene_new();
        add_array(s, values, 36, F32, 3, "VEC3");
        APPEND(s->primitives, "{\"attributes\":{\"POSITION\":0}}");
        check_zeroed(s, "POSITION (accessor 0), element 1", 0);
        check_zeroed(morphing(values, ONE_TARGET), "target 0 POSITION (accessor 1), element 1", 0);
        s = triangle(",\"NORMAL\":1", "");
        values[3] = bad[i];
        add_array(s, values, 36, F32, 3, "VEC3");
        check_zeroed(s, "NORMAL (accessor 1), element 1", 1);
        s = triangle(",\"TEXCOORD_0\":1", "");
        add_array(s, values, 24, F32, 3, "VEC2");
        check_zeroed(s, "TEXCOORD_0 (accessor 1), element 1", 1);
        s = triangle(",\"COLOR_0\":1", "");
        add_array(s, values, 36, F32, 3, "VEC3");
        check_zeroed(s, "COLOR_0 (accessor 1), element 1", 1);
        s = triangle(",\"TANGENT\":1", "");
        add_array(s, values, 48, F32, 3, "VEC4");
        check_zeroed(s, "TANGENT (accessor 1), element 0", 1);
    }
}

static void worlds_beyond_the_limit_are_refused(void **state)
{
    (void)state;
    scene *s = triangle("", "");
    APPEND(s->rest, ",\"nodes\":[{\"scale\":[1e7,1,1],\"children\":[1]},{\"name\":\"b\",\"scale\":[1e7,1,1]}]");
    refused(s, "scales of its ancestors", "node 'b'");
}

/* A primitive with fewer targets than others of its mesh stays in place where it has none. */
static void primitives_may_have_fewer_targets(void **state)
{
    (void)state;
    const float zeros[9] = { 0 };
    scene *s = triangle("", "");
    add_array(s, up_deltas, sizeof up_deltas, F32, 3, "VEC3");
    APPEND(s->primitives, ",{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":1},{\"POSITION\":1}]}");
    APPEND(s->primitives, ",{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":1}]}");
    model *m = load(s);
    assert_int_equal(m->meshes[0].target_count, 2);
    for (uint32_t t = 0; t < 2; ++t) {
        const model_target *target = &m->meshes[0].targets[t];
        for (uint32_t p = 0; p < 3; ++p) {
            const int moves = p == 1 || (p == 2 && t == 0);
            assert_memory_equal(target->position + 9 * p, moves ? up_deltas : zeros, sizeof zeros);
        }
    }
    assert_true(has_warning(m, "mesh 'm' primitive 0 has 0 morph targets and primitive 1 has 2: the others do not"));
    model_free(m);
}

static void targets_of_another_size_are_refused(void **state)
{
    (void)state;
    scene *s = triangle("", ",\"targets\":[{\"POSITION\":1}]");
    add_array(s, up_deltas, 24, F32, 2, "VEC3");
    refused(s, "the accessor has 2 elements, but 3 are needed here",
            "mesh 'm' primitive 0 target 0 POSITION (accessor 1)");
}

/* A target that cannot be read is there, and moves nothing. */
static void targets_that_cannot_be_read_are_empty(void **state)
{
    (void)state;
    scene *s = triangle("", ",\"targets\":[{\"POSITION\":1},{\"POSITION\":9}]");
    add_array(s, up_deltas, sizeof up_deltas, F32, 3, "VEC3");
    model *m = load(s);
    assert_int_equal(m->meshes[0].target_count, 2);
    assert_floats(m->meshes[0].targets[0].position, up_deltas, 9);
    for (int i = 0; i < 9; i++) assert_true(m->meshes[0].targets[1].position[i] == 0.0f);
    assert_true(has_warning(m,
                            "primitive 0 target 1 POSITION: accessor 9 does not exist: the file has 2; the deltas were "
                            "left out"));
    model_free(m);
}

/* What a short buffer holds is read, and its other primitives are left out. */
static void short_buffers_cost_what_they_lack(void **state)
{
    (void)state;
    write_text("test.gltf",
               "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":144,\"uri\":"
               "\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"},{"
               "\"byteLength\":9,\"uri\":\"gone.bin\"}],"
               "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,"
               "\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
               "\"type\":\"VEC3\"},{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
               "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}},{\"attributes\":{\"POSITION\":"
               "1}}]},{\"primitives\":[{\"attributes\":{\"POSITION\":1}}]}]}");
    model *m = NULL;
    model_error error;
    assert_int_equal(model_read_gltf(file_path, &m, &error), 0);
    assert_true(m->mesh_count == 1 && m->meshes[0].vertex_count == 3 && m->meshes[0].position[3] == 1.0f);
    assert_true(has_warning(m, "buffer 0: the buffer has 36 bytes, but 'byteLength' says 144"));
    assert_true(has_warning(m, "buffer 1: the file does not exist"));
    assert_true(has_warning(m,
                            "mesh 'mesh_0' primitive 1 POSITION (accessor 1), buffer view 1: bytes 36 to 72 are out of "
                            "range: buffer 0 has 36; the primitive was left out"));
    model_free(m);
}

static void weights_of_the_wrong_length_are_cut(void **state)
{
    (void)state;
    scene *s = morphing(up_deltas, ONE_TARGET);
    APPEND(s->mesh_rest, ",\"weights\":[0.5,1]");
    model *m = load(s);
    assert_true(m->meshes[0].weights[0] == 0.5f && has_warning(m, "mesh 'm' has another number of weights"));
    model_free(m);
    s = morphing(up_deltas, ONE_TARGET);
    APPEND(s->rest, ",\"nodes\":[{\"name\":\"n\",\"mesh\":0,\"weights\":[0.25,1]}]");
    m = load(s);
    assert_true(m->nodes[0].weights[0] == 0.25f && has_warning(m, "node 'n' has another number of weights"));
    model_free(m);
}

static void zero_vertices_are_refused(void **state)
{
    (void)state;
    scene *s = scene_new();
    add_accessor(s, F32, 0, "VEC3", "");
    APPEND(s->primitives, "{\"attributes\":{\"POSITION\":0}}");
    refused(s, "nothing to convert; a part was skipped: it has no vertices", "mesh 'm' primitive 0");
}

static void check_sparse_indices(uint16_t first, uint16_t second, const char *what)
{
    const uint16_t index[2] = { first, second };
    const float value[6] = { 0, 0, 1, 0, 0, 2 };
    char rest[256];
    scene *s = triangle("", ONE_TARGET);
    int indices = add_view(s, index, sizeof index, 0), values = add_view(s, value, sizeof value, 0);
    snprintf(rest, sizeof rest,
             ",\"sparse\":{\"count\":2,\"indices\":{\"bufferView\":%d,\"componentType\":5123},"
             "\"values\":{\"bufferView\":%d}}",
             indices, values);
    add_accessor(s, F32, 3, "VEC3", rest);
    model *m = load(s);
    if (!has_warning(m, what)) fail_msg("%s", m->warning_count ? m->warnings[0] : "no warning");
    assert_true(m->meshes[0].targets[0].position[5] == (second == 1 ? 2.0f : 1.0f));
    model_free(m);
}

static void values_of_bad_sparse_indices_are_left_out(void **state)
{
    (void)state;
    check_sparse_indices(1, 3,
                         "target 0 POSITION (accessor 1) sparse indices, element 1: its value was left out: the "
                         "accessor has 3 elements");
    check_sparse_indices(1, 1, "sparse indices, element 1: the index does not increase");
}

static void bad_nodes_are_left_out(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        { "{\"children\":[1]},{\"children\":[0]}", "nodes: 2 nodes are their own ancestors and were left out" },
        { "{\"children\":[2]},{\"children\":[2]},{\"name\":\"c\"}", "node 'c': the node has two parents" },
        { "{\"name\":\"p\",\"children\":[5]}", "node 'p' children: node 5 was left out: it does not exist" },
        { "{\"name\":\"p\",\"mesh\":4}", "node 'p': its mesh was left out: mesh 4 does not exist" },
        { "{}],\"scene\":3,\"scenes\":[{\"nodes\":[0,7]}",
          "scene 3 does not exist: the file has 1; the first was read" },
        { "{}],\"scenes\":[{\"nodes\":[0,7]}", "scene 0: node 7 was left out" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        scene *s = triangle("", "");
        APPEND(s->rest, ",\"nodes\":[%s]", cases[i][0]);
        check_lost(s, cases[i][1]);
    }
    scene *s = triangle("", "");
    APPEND(s->rest, ",\"nodes\":[{\"mesh\":\"x\"}]");
    check_lost(s, "glTF JSON/nodes/0: 'mesh' must be a whole number; it was left out");
}

/* Transforms that a node cannot have are ignored. */
static void bad_transforms_are_ignored(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        { "\"rotation\":[0,1]", "node 'p': 'rotation' has 2 numbers; it needs 4; it was ignored" },
        { "\"matrix\":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]", "node 'p': the matrix is not affine" },
        { "\"matrix\":[2,0,0]", "node 'p': 'matrix' has 3 numbers; it needs 16; it was ignored" },
        { "\"translation\":[1e300,0,0]",
          "glTF JSON/nodes/0: 'translation' must be numbers up to 1e12; it was left out" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        scene *s = triangle("", "");
        APPEND(s->rest, ",\"nodes\":[{\"name\":\"p\",\"mesh\":0,%s}]", cases[i][0]);
        model *m = load(s);
        for (int k = 0; k < 16; k++) assert_true(m->nodes[0].world[k] == (k % 5 == 0 ? 1.0 : 0.0));
        if (!has_warning(m, cases[i][1])) fail_msg("%s", m->warnings[0]);
        model_free(m);
    }
}

/* A scene that lists all of its nodes, some twice: each is there once, below its parent. */
static void nodes_are_in_the_scene_once(void **state)
{
    (void)state;
    scene *s = triangle("", "");
    APPEND(s->rest,
           ",\"scenes\":[{\"nodes\":[1,0,0]}],\"nodes\":[{\"name\":\"up\",\"children\":[1],\"translation\":[0,2,0]},"
           "{\"name\":\"low\",\"mesh\":0}]");
    model *m = load(s);
    assert_true(m->node_count == 2 && m->nodes[1].parent == 0 && m->nodes[1].world[13] == 2.0);
    assert_true(has_warning(m, "is listed in the scene, and there already (and 1 more like it)"));
    model_free(m);
}

static void bad_references(void **state)
{
    (void)state;
    check_lost(triangle("", ",\"material\":3"), "mesh 'm' primitive 0: its material does not exist");
    scene *s = triangle("", "");
    APPEND(s->rest, ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":2}}}]");
    check_lost(s, "material 'material_0': it does not exist: the file has 0 (texture 2); the texture was left out");
    refused(triangle("", ",\"mode\":9"), "; a part was skipped: its mode is unknown", "mesh 'm' primitive 0");
    s = triangle("", "");
    APPEND(s->rest, ",\"scenes\":[{\"nodes\":[0]}]");
    check_lost(s, "scene 0: node 0 was left out: it does not exist");
}

/* EXT_mesh_gpu_instancing: a node for each instance, below its node. */
static void instances_are_nodes(void **state)
{
    (void)state;
    const float moves[6] = { 1, 0, 0, 0, 2, NAN };
    const signed char turns[8] = { 0, 0, 0, 127, 0, 127, 0, 0 };
    scene *s = triangle("", "");
    add_array(s, moves, sizeof moves, F32, 2, "VEC3");
    add_array(s, turns, sizeof turns, I8, 2, "VEC4");
    s->accessors[strlen(s->accessors) - 1] = 0;
    APPEND(s->accessors, ",\"normalized\":true}");
    APPEND(s->rest,
           ",\"nodes\":[{\"name\":\"p\",\"children\":[1],\"scale\":[2,2,2]},{\"name\":\"n\",\"mesh\":0,\"extensions\":{"
           "\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":1,\"ROTATION\":2}}}}]");
    model *m = load(s);
    assert_true(m->node_count == 4 && m->nodes[1].mesh == MODEL_NONE);
    assert_string_equal(m->nodes[2].name, "n_0");
    assert_true(m->nodes[2].mesh == 0 && m->nodes[3].mesh == 0 && m->nodes[3].parent == 1);
    assert_true(m->nodes[2].world[12] == 2.0 && m->nodes[3].world[13] == 4.0 && m->nodes[3].world[14] == 0.0);
    assert_true(fabs(m->nodes[2].world[0] - 2.0) < 1e-6 && fabs(m->nodes[3].world[0] + 2.0) < 1e-6);
    assert_true(has_warning(m, "node 'n' EXT_mesh_gpu_instancing TRANSLATION (accessor 1), element 1: the value is"));
    model_free(m);
    s = triangle("", "");
    add_array(s, moves, 12, F32, 1, "VEC3");
    add_array(s, turns, sizeof turns, I8, 2, "VEC4");
    APPEND(s->rest, ",\"nodes\":[{\"name\":\"n\",\"mesh\":0,\"extensions\":{\"EXT_mesh_gpu_instancing\":{"
                    "\"attributes\":{\"TRANSLATION\":1,\"ROTATION\":2}}}}]");
    m = load(s);
    assert_true(m->node_count == 1 && m->nodes[0].mesh == 0);
    assert_true(has_warning(m, "EXT_mesh_gpu_instancing: its attributes differ in their counts; the node was drawn"));
    model_free(m);
}

/* KHR_node_visibility hides a node and what is below it, unless nothing would be left. */
static void hidden_nodes_are_not_drawn(void **state)
{
    (void)state;
    scene *s = triangle("", "");
    APPEND(s->rest, ",\"nodes\":[{\"name\":\"p\",\"children\":[1],\"extensions\":{\"KHR_node_visibility\":{"
                    "\"visible\":false}}},{\"name\":\"n\",\"mesh\":0},{\"name\":\"o\",\"mesh\":0,"
                    "\"extensions\":{\"KHR_node_visibility\":{\"visible\":true}}}]");
    model *m = load(s);
    assert_true(m->node_count == 3 && m->nodes[1].mesh == MODEL_NONE && m->nodes[2].mesh == 0);
    assert_true(has_warning(m, "node 'n' is hidden in the file and is not drawn"));
    assert_int_equal(m->warning_count, 1);
    model_free(m);
    s = triangle("", "");
    APPEND(s->rest, ",\"nodes\":[{\"name\":\"n\",\"mesh\":0,\"extensions\":{\"KHR_node_visibility\":{"
                    "\"visible\":false}}}]");
    m = load(s);
    assert_int_equal(m->nodes[0].mesh, 0);
    assert_true(has_warning(m, "node 'n' is hidden in the file, as are all that have a mesh: they are drawn"));
    model_free(m);
}

/* What an animation shows is kept; a mesh that only hidden nodes have is not, and the others' numbers follow. */
static void hidden_meshes_are_not_kept(void **state)
{
    (void)state;
    scene *s = triangle("", "");
    const float times[2] = { 0, 1 };
    add_array(s, times, sizeof times, F32, 2, "SCALAR");
    APPEND(s->rest,
           ",\"nodes\":[{\"name\":\"n\",\"mesh\":0,\"extensions\":{\"KHR_node_visibility\":{\"visible\":false}}},"
           "{\"name\":\"o\",\"mesh\":0,\"extensions\":{\"KHR_node_visibility\":{\"visible\":false}}},"
           "{\"name\":\"p\",\"mesh\":0}],\"animations\":[{\"samplers\":[{\"input\":1,\"output\":1}],\"channels\":[{"
           "\"sampler\":0,\"target\":{\"path\":\"pointer\",\"extensions\":{\"KHR_animation_pointer\":{\"pointer\":"
           "\"/nodes/0/extensions/KHR_node_visibility/visible\"}}}}]}]");
    model *m = load(s);
    assert_true(m->nodes[0].mesh == 0 && m->nodes[1].mesh == MODEL_NONE && m->nodes[2].mesh == 0);
    model_free(m);
    write_positions("a b.bin");
    write_text("test.gltf",
               "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,\"uri\":\"a%20b.bin\"}],"
               "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
               "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
               "\"meshes\":[{\"name\":\"free\",\"primitives\":[{\"attributes\":{\"POSITION\":0}}]},"
               "{\"name\":\"hidden\",\"primitives\":[{\"attributes\":{\"POSITION\":0}}]},"
               "{\"name\":\"shown\",\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
               "\"nodes\":[{\"mesh\":1,\"extensions\":{\"KHR_node_visibility\":{\"visible\":false}}},{\"mesh\":2}]}");
    m = load_file();
    assert_true(m->mesh_count == 2 && m->nodes[0].mesh == MODEL_NONE && m->nodes[1].mesh == 1);
    assert_string_equal(m->meshes[1].name, "shown");
    model_free(m);
}

/* Nor are textures that only such meshes have, other than replacements by a suffix; materials keep their numbers. */
static void textures_of_hidden_meshes_are_not_kept(void **state)
{
    (void)state;
    for (int suffix = 0; suffix < 2; suffix++) {
        char text[2048];
        write_positions("a b.bin");
        snprintf(
            text, sizeof text,
            "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,\"uri\":\"a%%20b.bin\"}],"
            "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
            "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
            "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]},"
            "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":1}]}],"
            "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}},\"normalTexture\":{\"index\":2}},"
            "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":1}},\"normalTexture\":{\"index\":2}}],"
            "\"textures\":[{\"source\":0,\"name\":\"%s\"},{\"source\":0,\"name\":\"skin\"},{\"source\":0,\"name\":\"fine\"}],"
            "\"images\":[{\"uri\":\"data:image/png;base64,%s\"}],"
            "\"nodes\":[{\"mesh\":0,\"extensions\":{\"KHR_node_visibility\":{\"visible\":false}}},{\"mesh\":1}]}",
            suffix ? "skin_red" : "red_skin", png_2x1);
        write_text("test.gltf", text);
        model *m = load_file();
        const model_material *hidden = &m->materials[0], *shown = &m->materials[1];
        assert_true(m->mesh_count == 1 && m->material_count == 2 && m->texture_count == (suffix ? 3 : 2));
        assert_true((hidden->base_color_texture != MODEL_NONE) == suffix && hidden->normal_texture == MODEL_NONE);
        assert_true(m->textures[shown->normal_texture].use == MODEL_TEXTURE_NORMAL);
        assert_true(m->textures[shown->base_color_texture].use == MODEL_TEXTURE_COLOR);
        model_free(m);
    }
}

/* A clip moves the weights of the first instance, which the others follow; another node with the mesh keeps its own. */
static void weights_of_instances_are_animated(void **state)
{
    (void)state;
    const float times[2] = { 0, 1 }, values[2] = { 0.25f, 1 }, moves[6] = { 1, 0, 0, 0, 2, 0 };
    scene *s = morphing(up_deltas, ONE_TARGET);
    add_array(s, times, sizeof times, F32, 2, "SCALAR");
    add_array(s, values, sizeof values, F32, 2, "SCALAR");
    add_array(s, moves, sizeof moves, F32, 2, "VEC3");
    APPEND(s->rest, ",\"nodes\":[{\"name\":\"n\",\"mesh\":0,\"extensions\":{\"EXT_mesh_gpu_instancing\":{"
                    "\"attributes\":{\"TRANSLATION\":4}}}},{\"name\":\"other\",\"mesh\":0}],\"animations\":[{"
                    "\"channels\":[{\"sampler\":0,\"target\":{" WEIGHTS_OF_N "}}],\"samplers\":[{\"input\":2,"
                    "\"output\":3}]}]");
    model *m = load(s);
    assert_true(m->node_count == 4 && m->clip_count == 1 && m->clips[0].channel_count == 2);
    const model_channel *c = m->clips[0].channels;
    assert_true(c[0].path == MODEL_PATH_WEIGHTS && c[0].node == 2 && c[0].width == 1 && c[0].key_count == 2);
    assert_floats(c[0].values, values, 2);
    assert_true(c[1].path == MODEL_PATH_WEIGHTS && c[1].node == 1 && c[1].key_count == 1 && c[1].values[0] == 0.0f);
    assert_int_equal(m->warning_count, 0);
    model_free(m);
}

/* The weights of a mesh are animated at a node that draws it, wherever a hidden one stands. */
static void weights_of_hidden_nodes_are_not_animated(void **state)
{
    (void)state;
#define HIDDEN "{\"mesh\":0,\"extensions\":{\"KHR_node_visibility\":{\"visible\":false}}}"
#define SHOWN "{\"mesh\":0}"
    static const struct {
        const char *nodes, *target;
        uint32_t node; /* MODEL_NONE: there is no clip */
    } cases[] = { { HIDDEN "," SHOWN, POINTER("/meshes/0/weights"), 1 },
                  { SHOWN "," HIDDEN, POINTER("/meshes/0/weights"), 0 },
                  { HIDDEN "," SHOWN, WEIGHTS_OF_N, MODEL_NONE },
                  { HIDDEN ",{\"mesh\":1}", POINTER("/meshes/0/weights"), MODEL_NONE } };
    const float times[2] = { 0, 1 }, values[2] = { 0.25f, 1 };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        scene *s = morphing(up_deltas, ONE_TARGET "}]},{\"primitives\":[{\"attributes\":{\"POSITION\":0}");
        add_array(s, times, sizeof times, F32, 2, "SCALAR");
        add_array(s, values, sizeof values, F32, 2, "SCALAR");
        APPEND(s->rest,
               ",\"nodes\":[%s],\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{%s}}],"
               "\"samplers\":[{\"input\":2,\"output\":3}]}]",
               cases[i].nodes, cases[i].target);
        model *m = load(s);
        assert_int_equal(m->clip_count, cases[i].node != MODEL_NONE);
        if (m->clip_count) assert_int_equal(m->clips[0].channels[0].node, cases[i].node);
        assert_int_equal(has_warning(m, "channel 0 was skipped: its mesh is not drawn"), !m->clip_count);
        model_free(m);
    }
}

/* --- real files --- */

/* Where the example assets lie, or a skipped test. */
static void use_asset(const char *name)
{
    const char *base = getenv("NOH_ASSETS");
    snprintf(file_path, sizeof file_path, "%s/%s", base ? base : "../shared/assets", name);
    if (access(file_path, R_OK) != 0) {
        print_message("skipped: %s is not there (set NOH_ASSETS to the assets' folder)\n", file_path);
        skip();
    }
}

static void assert_same_mesh(const model_mesh *a, const model_mesh *b)
{
    size_t floats = (size_t)a->vertex_count * 3 * sizeof(float);
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->target_count, b->target_count);
    assert_memory_equal(a->position, b->position, floats);
    assert_memory_equal(a->normal, b->normal, floats);
    assert_memory_equal(a->tangent, b->tangent, floats / 3 * 4);
    assert_memory_equal(a->indices, b->indices, a->index_count * sizeof *a->indices);
    for (uint32_t t = 0; t < a->target_count; ++t) {
        assert_string_equal(a->targets[t].name, b->targets[t].name);
        assert_memory_equal(a->targets[t].position, b->targets[t].position, floats);
        assert_memory_equal(a->targets[t].normal, b->targets[t].normal, floats);
        assert_memory_equal(a->targets[t].tangent, b->targets[t].tangent, floats);
    }
}

static void dense_and_sparse_heads_are_the_same(void **state)
{
    (void)state;
    use_asset("hero/head_sparse.glb");
    model *sparse = load_file();
    use_asset("hero/head.glb");
    model *dense = load_file();
    assert_same_mesh(&dense->meshes[0], &sparse->meshes[0]);
    assert_int_equal(dense->meshes[0].vertex_count, 5465);
    assert_int_equal(dense->meshes[0].target_count, 34);
    assert_int_equal(dense->clip_count, 5);
    model_free(sparse);
    model_free(dense);
}

static void compressed_head_has_the_same_shape(void **state)
{
    (void)state;
    use_asset("hero/head_meshopt.glb");
    model *m = load_file();
    assert_int_equal(m->meshes[0].vertex_count, 5465);
    assert_int_equal(m->meshes[0].index_count, 3 * 10120);
    double low = 1e9, high = -1e9;
    for (uint32_t v = 0; v < m->meshes[0].vertex_count; ++v) { /* the node's matrix undoes the quantisation */
        double y = m->nodes[0].world[5] * (double)m->meshes[0].position[v * 3 + 1] + m->nodes[0].world[13];
        low = y < low ? y : low;
        high = y > high ? y : high;
    }
    model_free(m);
    use_asset("hero/head.glb");
    m = load_file();
    for (uint32_t v = 0; v < m->meshes[0].vertex_count; ++v) {
        double y = (double)m->meshes[0].position[v * 3 + 1];
        assert_true(y > low - 2e-4 && y < high + 2e-4);
    }
    model_free(m);
}

static void all_assets_load(void **state)
{
    (void)state;
    static const char *const names[] = { "hero/body.glb",
                                         "hero/body_8inf.glb",
                                         "hero/body_quantized.glb",
                                         "hero/identity.glb",
                                         "khronos/Fox.glb",
                                         "khronos/MorphStressTest.glb",
                                         "khronos/RobotExpressive.glb",
                                         "khronos/SimpleSkin.gltf",
                                         "khronos/SimpleSparseAccessor.gltf",
                                         "khronos/AnimatedMorphCube/glTF/AnimatedMorphCube.gltf",
                                         "khronos/AnimatedMorphSphere/glTF/AnimatedMorphSphere.gltf",
                                         "khronos/MorphPrimitivesTest/glTF/MorphPrimitivesTest.gltf",
                                         "khronos/SimpleMorph/glTF/SimpleMorph.gltf",
                                         "khronos/three-vrm-cube/cube.gltf" };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        use_asset(names[i]);
        model *m = load_file();
        assert_true(m->mesh_count > 0);
        for (uint32_t k = 0; k < m->mesh_count; ++k)
            for (uint32_t v = 0; v < m->meshes[k].vertex_count; ++v) assert_true(isfinite(m->meshes[k].normal[v * 3]));
        model_free(m);
    }
}

/* --- the run --- */

static int make_folder(void **state)
{
    (void)state;
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/noh_gltf_XXXXXX", base && strlen(base) < 40 ? base : "/tmp");
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    static const char *const names[] = { "test.gltf", "test.glb",    "json",      "a b.bin",
                                         "c%20d.bin", "Parts/a.bin", "Kit/A.bin", "kit/skin/a.bin",
                                         "kit/skin",  "kit/Skin",    "kit",       "kIt",
                                         "Kit",       "Parts" };
    char path[128];
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        (void)remove(path);
    }
    return rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(triangle_without_indices),
        cmocka_unit_test(indices_of_every_size),
        cmocka_unit_test(binary_container),
        cmocka_unit_test(buffer_in_a_file_beside),
        cmocka_unit_test(files_are_found_in_any_folder_of_a_name),
        cmocka_unit_test(held_names_are_found_in_any_case),
        cmocka_unit_test(long_names_are_refused),
        cmocka_unit_test(interleaved_attributes),
        cmocka_unit_test(sparse_with_a_base),
        cmocka_unit_test(sparse_without_a_base),
        cmocka_unit_test(accessor_without_bytes_is_zero),
        cmocka_unit_test(quantized_positions),
        cmocka_unit_test(quantized_attributes_and_deltas),
        cmocka_unit_test(meshopt_attributes_and_triangles),
        cmocka_unit_test(meshopt_index_sequence),
        cmocka_unit_test(meshopt_octahedral_and_exponential),
        cmocka_unit_test(meshopt_quaternion),
        cmocka_unit_test(meshopt_damage_is_refused),
        cmocka_unit_test(meshopt_impossible_sizes_are_refused),
        cmocka_unit_test(meshopt_of_khronos),
        cmocka_unit_test(strips_and_fans),
        cmocka_unit_test(points_and_lines_are_skipped),
        cmocka_unit_test(primitives_are_concatenated),
        cmocka_unit_test(shared_vertices_are_dealt_out),
        cmocka_unit_test(unused_vertices_may_hold_anything),
        cmocka_unit_test(restart_indices_cut_strips),
        cmocka_unit_test(other_signs_of_tangents_are_rounded),
        cmocka_unit_test(target_names_are_made_unique),
        cmocka_unit_test(target_names_of_a_primitive),
        cmocka_unit_test(recipes_in_extras),
        cmocka_unit_test(normals_of_a_triangle),
        cmocka_unit_test(normals_below_the_crease_angle_are_smooth),
        cmocka_unit_test(normals_above_the_crease_angle_are_hard),
        cmocka_unit_test(normals_of_an_indexed_edge_are_shared),
        cmocka_unit_test(degenerate_triangles_are_kept),
        cmocka_unit_test(normals_of_all_degenerate_triangles_are_unit),
        cmocka_unit_test(file_normals_of_other_length),
        cmocka_unit_test(target_normals_from_the_morphed_mesh),
        cmocka_unit_test(target_normals_are_zero_where_nothing_changes),
        cmocka_unit_test(target_normals_of_a_moved_triangle_are_snapped_to_zero),
        cmocka_unit_test(target_normals_of_the_file_are_kept),
        cmocka_unit_test(target_normals_without_a_base_are_ignored),
        cmocka_unit_test(targets_of_each_primitive),
        cmocka_unit_test(negative_zero_deltas_become_zero),
        cmocka_unit_test(tangents_follow_u),
        cmocka_unit_test(tangents_without_usable_uvs),
        cmocka_unit_test(tangents_where_uvs_are_mirrored),
        cmocka_unit_test(target_tangents_from_the_morphed_mesh),
        cmocka_unit_test(no_uvs_no_tangents),
        cmocka_unit_test(nodes_parents_first),
        cmocka_unit_test(skinned_mesh_is_as_large_as_its_joints_make_it),
        cmocka_unit_test(bad_skins_are_left_out),
        cmocka_unit_test(bad_bind_matrices_are_replaced),
        cmocka_unit_test(matrices_are_decomposed),
        cmocka_unit_test(skewed_and_mirrored_matrices),
        cmocka_unit_test(node_weights),
        cmocka_unit_test(vrm_expressions_are_recipes),
        cmocka_unit_test(vrm_rules_are_told),
        cmocka_unit_test(vrm_animations_are_for_any_body),
        cmocka_unit_test(old_vrm_turns_round),
        cmocka_unit_test(damaged_vrm_is_ignored),
        cmocka_unit_test(factors_stay_within_0_and_1),
        cmocka_unit_test(extras_give_a_surface),
        cmocka_unit_test(mtoon_is_a_toon),
        cmocka_unit_test(old_mtoon_is_a_toon),
        cmocka_unit_test(large_images_are_counted_first),
        cmocka_unit_test(constraints_give_warnings),
        cmocka_unit_test(mtoon_has_textures),
        cmocka_unit_test(mtoon_has_masks),
        cmocka_unit_test(mtoon_is_not_lost_in_silence),
        cmocka_unit_test(animation_linear),
        cmocka_unit_test(animation_of_normalised_bytes),
        cmocka_unit_test(animation_cubic),
        cmocka_unit_test(animations_without_names),
        cmocka_unit_test(animations_of_one_name_are_numbered),
        cmocka_unit_test(an_animated_matrix_is_told),
        cmocka_unit_test(animation_without_a_target_is_skipped),
        cmocka_unit_test(animation_without_meshes),
        cmocka_unit_test(bad_keys_are_left_out),
        cmocka_unit_test(bad_channels_are_left_out),
        cmocka_unit_test(pointers_to_nodes),
        cmocka_unit_test(weights_of_a_mesh_without_targets_are_skipped),
        cmocka_unit_test(materials_and_textures),
        cmocka_unit_test(specular_and_glossiness),
        cmocka_unit_test(specular_maps_are_packed),
        cmocka_unit_test(bad_images_are_warnings),
        cmocka_unit_test(webp_textures),
        cmocka_unit_test(texture_transform_is_baked),
        cmocka_unit_test(targets_move_texture_coordinates),
        cmocka_unit_test(not_gltf_is_refused),
        cmocka_unit_test(nothing_to_convert_is_refused),
        cmocka_unit_test(deep_json_is_refused),
        cmocka_unit_test(missing_members_are_refused_by_name),
        cmocka_unit_test(damaged_members_are_left_out),
        cmocka_unit_test(wrong_headers_are_warnings),
        cmocka_unit_test(versions_are_warnings),
        cmocka_unit_test(required_extensions_are_warnings),
        cmocka_unit_test(unknown_extensions_are_warnings),
        cmocka_unit_test(every_truncation_of_a_glb_is_told),
        cmocka_unit_test(triangles_of_missing_vertices_are_left_out),
        cmocka_unit_test(half_a_triangle_is_left_out),
        cmocka_unit_test(wrong_types_are_left_out),
        cmocka_unit_test(accessors_outside_their_bytes_are_left_out),
        cmocka_unit_test(bytes_behind_a_wrong_length_are_read),
        cmocka_unit_test(giant_counts_are_refused),
        cmocka_unit_test(missing_buffers_are_refused),
        cmocka_unit_test(bytes_say_what_came_in_place_of_a_file),
        cmocka_unit_test(numbers_that_are_not_finite_are_zeros),
        cmocka_unit_test(worlds_beyond_the_limit_are_refused),
        cmocka_unit_test(primitives_may_have_fewer_targets),
        cmocka_unit_test(targets_of_another_size_are_refused),
        cmocka_unit_test(targets_that_cannot_be_read_are_empty),
        cmocka_unit_test(short_buffers_cost_what_they_lack),
        cmocka_unit_test(weights_of_the_wrong_length_are_cut),
        cmocka_unit_test(zero_vertices_are_refused),
        cmocka_unit_test(values_of_bad_sparse_indices_are_left_out),
        cmocka_unit_test(bad_nodes_are_left_out),
        cmocka_unit_test(bad_transforms_are_ignored),
        cmocka_unit_test(nodes_are_in_the_scene_once),
        cmocka_unit_test(bad_references),
        cmocka_unit_test(instances_are_nodes),
        cmocka_unit_test(hidden_nodes_are_not_drawn),
        cmocka_unit_test(hidden_meshes_are_not_kept),
        cmocka_unit_test(textures_of_hidden_meshes_are_not_kept),
        cmocka_unit_test(weights_of_instances_are_animated),
        cmocka_unit_test(weights_of_hidden_nodes_are_not_animated),
        cmocka_unit_test(dense_and_sparse_heads_are_the_same),
        cmocka_unit_test(compressed_head_has_the_same_shape),
        cmocka_unit_test(all_assets_load),
    };
    return cmocka_run_group_tests_name("gltf_read", tests, make_folder, remove_folder);
}
