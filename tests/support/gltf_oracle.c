#include "gltf_oracle.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

/* ---- JSON: values in one array, children linked by index; 0 is "not there" ---- */

typedef struct value {
    char type; /* { [ s n t f 0 */
    char *key; /* inside objects */
    char *text;
    double number;
    uint32_t first, next;
} value;

typedef struct decoded_accessor {
    double *values; /* [count][components]; NULL until it is asked for */
    uint32_t components, count;
} decoded_accessor;

struct oracle {
    char *path;
    uint8_t *file; /* the whole file */
    const uint8_t *bin;
    size_t bin_bytes;
    value *values;
    uint32_t value_count;
    uint8_t **buffers; /* decoded or read; NULL: the .glb's chunk */
    uint32_t buffer_count;
    decoded_accessor *decoded; /* [accessor_count] */
    uint32_t accessor_count;
};

typedef struct reader {
    oracle *o;
    const char *at;
} reader;

static void skip_space(reader *r)
{
    while (*r->at == ' ' || *r->at == '\n' || *r->at == '\r' || *r->at == '\t') {
        r->at++;
    }
}

/* Escapes are kept as they are: no name that is looked up has any. */
static char *read_text(reader *r)
{
    const char *start = ++r->at;
    char *text;
    while (*r->at && *r->at != '"') {
        r->at += *r->at == '\\' ? 2 : 1;
    }
    text = test_zeros((size_t)(r->at - start) + 1);
    memcpy(text, start, (size_t)(r->at - start));
    r->at++;
    return text;
}

static uint32_t new_value(oracle *o, char type)
{
    if ((o->value_count & (o->value_count - 1)) == 0) {
        o->values = realloc(o->values, sizeof *o->values * 2 * (o->value_count ? o->value_count : 1));
        assert_non_null(o->values);
    }
    memset(&o->values[o->value_count], 0, sizeof *o->values);
    o->values[o->value_count].type = type;
    return o->value_count++;
}

static uint32_t read_value(reader *r);

static void read_children(reader *r, uint32_t parent, char close)
{
    uint32_t last = 0;
    r->at++;
    skip_space(r);
    while (*r->at && *r->at != close) {
        char *key = NULL;
        uint32_t child;
        if (close == '}') {
            key = read_text(r);
            skip_space(r);
            r->at++; /* : */
        }
        child = read_value(r);
        r->o->values[child].key = key;
        if (last) {
            r->o->values[last].next = child;
        } else {
            r->o->values[parent].first = child;
        }
        last = child;
        skip_space(r);
        if (*r->at == ',') {
            r->at++;
            skip_space(r);
        }
    }
    r->at++;
}

static uint32_t read_value(reader *r)
{
    uint32_t v;
    skip_space(r);
    if (*r->at == '{' || *r->at == '[') {
        char open = *r->at;
        v = new_value(r->o, open);
        read_children(r, v, open == '{' ? '}' : ']');
    } else if (*r->at == '"') {
        v = new_value(r->o, 's');
        r->o->values[v].text = read_text(r);
    } else if (*r->at == 't' || *r->at == 'f' || *r->at == 'n') {
        v = new_value(r->o, *r->at == 'n' ? '0' : *r->at);
        r->at += *r->at == 'f' ? 5 : 4;
    } else {
        char *end;
        v = new_value(r->o, 'n');
        r->o->values[v].number = strtod(r->at, &end);
        if (end == r->at) {
            fail_msg("%s: not JSON at '%.20s'", r->o->path, r->at);
        }
        r->at = end;
    }
    return v;
}

static uint32_t member(const oracle *o, uint32_t object, const char *key)
{
    for (uint32_t c = object ? o->values[object].first : 0; c; c = o->values[c].next) {
        if (o->values[c].key && strcmp(o->values[c].key, key) == 0) {
            return c;
        }
    }
    return 0;
}

static uint32_t element(const oracle *o, uint32_t array, uint32_t index)
{
    uint32_t c = array ? o->values[array].first : 0;
    while (c && index--) {
        c = o->values[c].next;
    }
    return c;
}

static uint32_t length(const oracle *o, uint32_t array)
{
    uint32_t count = 0;
    for (uint32_t c = array ? o->values[array].first : 0; c; c = o->values[c].next) {
        count++;
    }
    return count;
}

static double number(const oracle *o, uint32_t object, const char *key, double otherwise)
{
    uint32_t v = member(o, object, key);
    return v ? o->values[v].number : otherwise;
}

static const char *text(const oracle *o, uint32_t object, const char *key)
{
    uint32_t v = member(o, object, key);
    return v ? o->values[v].text : NULL;
}

/* The root is value 1: value 0 stands for "not there". */
static uint32_t top(const oracle *o, const char *array, uint32_t index)
{
    return element(o, member(o, 1, array), index);
}

/* ---- files and buffers ---- */

static uint8_t *read_file(const char *path, size_t *count)
{
    FILE *f = fopen(path, "rb");
    uint8_t *bytes;
    long size;
    if (!f) {
        fail_msg("cannot read %s", path);
    }
    fseek(f, 0, SEEK_END);
    size = ftell(f);
    fseek(f, 0, SEEK_SET);
    bytes = test_zeros((size_t)size + 1); /* so that the JSON ends with a zero */
    assert_int_equal(fread(bytes, 1, (size_t)size, f), size);
    fclose(f);
    *count = (size_t)size;
    return bytes;
}

static uint32_t word_at(const uint8_t *bytes)
{
    uint32_t word;
    memcpy(&word, bytes, 4);
    return word;
}

static uint8_t *decode_base64(const char *from)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    uint8_t *out = test_zeros(strlen(from)), *to = out;
    uint32_t bits = 0, count = 0;
    for (; *from && *from != '='; from++) {
        const char *digit = strchr(digits, *from);
        assert_non_null(digit);
        bits = bits << 6 | (uint32_t)(digit - digits);
        count += 6;
        if (count >= 8) {
            count -= 8;
            *to++ = (uint8_t)(bits >> count);
        }
    }
    return out;
}

static uint8_t *load_buffer(const oracle *o, uint32_t index)
{
    const char *uri = text(o, top(o, "buffers", index), "uri"), *comma, *slash = strrchr(o->path, '/');
    char path[4096];
    size_t count;
    if (!uri) {
        assert_int_equal(index, 0);
        assert_non_null(o->bin);
        return NULL;
    }
    comma = strstr(uri, ";base64,");
    if (strncmp(uri, "data:", 5) == 0 && comma) {
        return decode_base64(comma + 8);
    }
    snprintf(path, sizeof path, "%.*s%s", slash ? (int)(slash - o->path) + 1 : 0, o->path, uri);
    return read_file(path, &count);
}

/* The JSON of a .gltf, or of a .glb's first chunk; its second is the binary one. */
static const char *open_container(oracle *o, size_t count)
{
    uint32_t bytes;
    if (count < 20 || memcmp(o->file, "glTF", 4) != 0) {
        return (const char *)o->file;
    }
    bytes = word_at(o->file + 12);
    if (20u + (size_t)bytes + 8u <= count) {
        o->bin = o->file + 20 + bytes + 8;
        o->bin_bytes = word_at(o->file + 20 + bytes);
        o->file[20 + bytes] = 0; /* ends the JSON; the length is read */
    }
    return (const char *)o->file + 20;
}

oracle *oracle_read(const char *path)
{
    oracle *o = test_zeros(sizeof *o);
    reader r = { o, NULL };
    size_t count;
    o->path = test_zeros(strlen(path) + 1);
    memcpy(o->path, path, strlen(path));
    o->file = read_file(path, &count);
    r.at = open_container(o, count);
    new_value(o, '0');
    read_value(&r);
    o->buffer_count = length(o, member(o, 1, "buffers"));
    o->buffers = test_zeros(sizeof *o->buffers * o->buffer_count);
    for (uint32_t i = 0; i < o->buffer_count; i++) {
        o->buffers[i] = load_buffer(o, i);
    }
    o->accessor_count = length(o, member(o, 1, "accessors"));
    o->decoded = test_zeros(sizeof *o->decoded * (o->accessor_count + 1u));
    return o;
}

void oracle_free(oracle *o)
{
    for (uint32_t i = 0; i < o->accessor_count; i++) {
        free(o->decoded[i].values);
    }
    free(o->decoded);
    for (uint32_t i = 0; i < o->buffer_count; i++) {
        free(o->buffers[i]);
    }
    for (uint32_t i = 0; i < o->value_count; i++) {
        free(o->values[i].key);
        free(o->values[i].text);
    }
    free(o->buffers);
    free(o->values);
    free(o->file);
    free(o->path);
    free(o);
}

/* ---- accessors ---- */

static const uint8_t *view_at(const oracle *o, uint32_t object, const char *key, size_t *stride)
{
    uint32_t view = top(o, "bufferViews", (uint32_t)number(o, object, key, 0));
    uint32_t buffer = (uint32_t)number(o, view, "buffer", 0);
    const uint8_t *bytes = o->buffers[buffer] ? o->buffers[buffer] : o->bin;
    if (number(o, view, "byteStride", 0) > 0) {
        *stride = (size_t)number(o, view, "byteStride", 0);
    }
    return bytes + (size_t)number(o, view, "byteOffset", 0) + (size_t)number(o, object, "byteOffset", 0);
}

static uint32_t index_at(const uint8_t *bytes, size_t i, int component)
{
    uint16_t narrow;
    uint32_t wide;
    if (component == 5121) {
        return bytes[i];
    }
    memcpy(&narrow, bytes + 2 * i, 2);
    if (component == 5123) {
        return narrow;
    }
    memcpy(&wide, bytes + 4 * i, 4);
    return wide;
}

static int is_true(const oracle *o, uint32_t object, const char *key)
{
    uint32_t v = member(o, object, key);
    return v && o->values[v].type == 't';
}

static size_t component_bytes(int component)
{
    return component == 5126 || component == 5125 ? 4 : component == 5122 || component == 5123 ? 2 : 1;
}

/* One number; integers as they are, or normalised as the specification says (3.11). */
static double component_at(const uint8_t *at, int component, int normalized)
{
    int32_t i = component == 5120 ? (int8_t)at[0] : (int32_t)at[0];
    float f;
    if (component == 5126) {
        memcpy(&f, at, 4);
        return (double)f;
    }
    if (component == 5122 || component == 5123) {
        uint16_t u;
        memcpy(&u, at, 2);
        i = component == 5122 ? (int16_t)u : (int32_t)u;
    }
    if (!normalized) {
        return (double)i;
    }
    return component == 5120   ? fmax(i / 127.0, -1.0)
           : component == 5121 ? i / 255.0
           : component == 5122 ? fmax(i / 32767.0, -1.0)
                               : i / 65535.0;
}

static void read_sparse(const oracle *o, uint32_t accessor, uint32_t components, double *out)
{
    uint32_t sparse = member(o, accessor, "sparse"), indices = member(o, sparse, "indices"),
             values = member(o, sparse, "values");
    int component = (int)number(o, accessor, "componentType", 0), normalized = is_true(o, accessor, "normalized");
    size_t size = component_bytes(component), stride = size * components, unused = 0,
           count = (size_t)number(o, sparse, "count", 0);
    const uint8_t *index = view_at(o, indices, "bufferView", &unused),
                  *from = view_at(o, values, "bufferView", &stride);
    for (size_t i = 0; i < count; i++) {
        uint32_t at = index_at(index, i, (int)number(o, indices, "componentType", 0));
        for (uint32_t c = 0; c < components; c++) {
            out[(size_t)at * components + c] = component_at(from + i * stride + size * c, component, normalized);
        }
    }
}

/* out[count][components]; to be freed. */
static double *decode_accessor(const oracle *o, uint32_t index, uint32_t components, uint32_t *count)
{
    uint32_t a = top(o, "accessors", index);
    int component = (int)number(o, a, "componentType", 0), normalized = is_true(o, a, "normalized");
    size_t size = component_bytes(component), stride = size * components;
    double *out;
    assert_int_not_equal(a, 0);
    *count = (uint32_t)number(o, a, "count", 0);
    out = test_zeros(sizeof *out * (size_t)*count * components);
    if (member(o, a, "bufferView")) {
        const uint8_t *from = view_at(o, a, "bufferView", &stride);
        for (size_t i = 0; i < (size_t)*count * components; i++) {
            out[i] = component_at(from + i / components * stride + i % components * size, component, normalized);
        }
    }
    if (member(o, a, "sparse")) {
        read_sparse(o, a, components, out);
    }
    return out;
}

/* The same, decoded once and kept by the oracle: the tests read the same accessors in every pose. */
static const double *read_accessor(const oracle *o, uint32_t index, uint32_t components, uint32_t *count)
{
    decoded_accessor *a = &o->decoded[index];
    assert_true(index < o->accessor_count);
    if (!a->values || a->components != components) {
        free(a->values);
        a->values = decode_accessor(o, index, components, &a->count);
        a->components = components;
    }
    *count = a->count;
    return a->values;
}

/* ---- meshes ---- */

static uint32_t primitive_at(const oracle *o, uint32_t mesh, uint32_t primitive)
{
    return element(o, member(o, top(o, "meshes", mesh), "primitives"), primitive);
}

uint32_t oracle_mesh_count(const oracle *o)
{
    return length(o, member(o, 1, "meshes"));
}

uint32_t oracle_primitive_count(const oracle *o, uint32_t mesh)
{
    return length(o, member(o, top(o, "meshes", mesh), "primitives"));
}

uint32_t oracle_target_count(const oracle *o, uint32_t mesh)
{
    return length(o, member(o, primitive_at(o, mesh, 0), "targets"));
}

uint32_t oracle_vertex_count(const oracle *o, uint32_t mesh, uint32_t primitive)
{
    uint32_t attributes = member(o, primitive_at(o, mesh, primitive), "attributes");
    return (uint32_t)number(o, top(o, "accessors", (uint32_t)number(o, attributes, "POSITION", 0)), "count", 0);
}

void oracle_positions(const oracle *o, uint32_t mesh, uint32_t primitive, const double *weights, double *out)
{
    uint32_t p = primitive_at(o, mesh, primitive), targets = member(o, p, "targets"), count, same;
    const double *base = read_accessor(o, (uint32_t)number(o, member(o, p, "attributes"), "POSITION", 0), 3, &count);
    memcpy(out, base, sizeof *out * 3u * count);
    for (uint32_t t = 0; t < length(o, targets); t++) {
        uint32_t target = element(o, targets, t);
        const double *delta;
        if (!member(o, target, "POSITION") || weights[t] == 0.0) {
            continue;
        }
        delta = read_accessor(o, (uint32_t)number(o, target, "POSITION", 0), 3, &same);
        assert_int_equal(same, count);
        for (size_t i = 0; i < 3u * (size_t)count; i++) {
            out[i] += weights[t] * delta[i];
        }
    }
}

/* ---- nodes ---- */

uint32_t oracle_node_count(const oracle *o)
{
    return length(o, member(o, 1, "nodes"));
}

int oracle_node_mesh(const oracle *o, uint32_t node)
{
    return (int)number(o, top(o, "nodes", node), "mesh", -1);
}

const char *oracle_node_name(const oracle *o, uint32_t node)
{
    return text(o, top(o, "nodes", node), "name");
}

void oracle_default_weights(const oracle *o, uint32_t node, double *weights)
{
    uint32_t mesh = (uint32_t)oracle_node_mesh(o, node), from = member(o, top(o, "nodes", node), "weights");
    if (!from) {
        from = member(o, top(o, "meshes", mesh), "weights");
    }
    for (uint32_t t = 0; t < oracle_target_count(o, mesh); t++) {
        uint32_t v = element(o, from, t);
        weights[t] = v ? o->values[v].number : 0.0;
    }
}

/* ---- animations ---- */

static uint32_t channel_at(const oracle *o, uint32_t animation, uint32_t channel)
{
    return element(o, member(o, top(o, "animations", animation), "channels"), channel);
}

static uint32_t sampler_at(const oracle *o, uint32_t animation, uint32_t channel)
{
    uint32_t index = (uint32_t)number(o, channel_at(o, animation, channel), "sampler", 0);
    return element(o, member(o, top(o, "animations", animation), "samplers"), index);
}

uint32_t oracle_animation_count(const oracle *o)
{
    return length(o, member(o, 1, "animations"));
}

const char *oracle_animation_name(const oracle *o, uint32_t animation)
{
    return text(o, top(o, "animations", animation), "name");
}

uint32_t oracle_channel_count(const oracle *o, uint32_t animation)
{
    return length(o, member(o, top(o, "animations", animation), "channels"));
}

int oracle_channel_node(const oracle *o, uint32_t animation, uint32_t channel)
{
    uint32_t target = member(o, channel_at(o, animation, channel), "target");
    const char *path = text(o, target, "path");
    return path && strcmp(path, "weights") == 0 ? (int)number(o, target, "node", -1) : -1;
}

double oracle_channel_end(const oracle *o, uint32_t animation, uint32_t channel)
{
    uint32_t count;
    const double *times = read_accessor(o, (uint32_t)number(o, sampler_at(o, animation, channel), "input", 0), 1,
                                        &count);
    return times[count - 1];
}

/* Keys k and k + 1 around the time, s between them; values[key][3][width] for splines. */
static double interpolate(const double *values, uint32_t width, uint32_t i, uint32_t k, double s, double span,
                          char kind)
{
    uint32_t stride = kind == 'C' ? 3 * width : width;
    const double *a = values + k * stride + i, *b = a + stride;
    if (kind != 'C') {
        return kind == 'S' || s <= 0.0 ? a[0] : (1.0 - s) * a[0] + s * b[0];
    }
    if (s <= 0.0) {
        return a[width];
    }
    return (2 * s * s * s - 3 * s * s + 1) * a[width] + span * (s * s * s - 2 * s * s + s) * a[2 * width] +
           (-2 * s * s * s + 3 * s * s) * b[width] + span * (s * s * s - s * s) * b[0];
}

void oracle_sample(const oracle *o, uint32_t animation, uint32_t channel, double time, double *weights)
{
    uint32_t sampler = sampler_at(o, animation, channel), keys, values, k = 0;
    uint32_t width = oracle_target_count(
        o, (uint32_t)oracle_node_mesh(o, (uint32_t)oracle_channel_node(o, animation, channel)));
    const char *kind = text(o, sampler, "interpolation");
    const double *times = read_accessor(o, (uint32_t)number(o, sampler, "input", 0), 1, &keys);
    const double *data = read_accessor(o, (uint32_t)number(o, sampler, "output", 0), 1, &values);
    double span, s;
    assert_int_equal(values, keys * width * (kind && kind[0] == 'C' ? 3u : 1u));
    while (k + 1 < keys && times[k + 1] <= time) {
        k++;
    }
    span = k + 1 < keys ? times[k + 1] - times[k] : 1.0;
    s = k + 1 < keys && time > times[0] ? (time - times[k]) / span : 0.0;
    for (uint32_t i = 0; i < width; i++) {
        weights[i] = interpolate(data, width, i, k, s, span, kind ? kind[0] : 'L');
    }
}

/* ---- poses ---- */

static void read_numbers(const oracle *o, uint32_t node, const char *key, uint32_t count, double *out)
{
    for (uint32_t i = 0; member(o, node, key) && i < count; i++) {
        out[i] = o->values[element(o, member(o, node, key), i)].number;
    }
}

static void slerp(const double *a, const double *b, double s, double *out)
{
    double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3], sign = dot < 0.0 ? -1.0 : 1.0;
    double angle = acos(fmin(fabs(dot), 1.0)), wa = 1.0 - s, wb = s;
    if (angle > 1e-6) {
        wa = sin((1.0 - s) * angle) / sin(angle);
        wb = sin(s * angle) / sin(angle);
    }
    for (int i = 0; i < 4; i++) {
        out[i] = wa * a[i] + sign * wb * b[i];
    }
}

static void normalize4(double *q)
{
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++) {
        q[i] /= length;
    }
}

/* Appendix C of the specification, for width 3 or 4. */
static void sample_transform(const oracle *o, uint32_t animation, uint32_t channel, double time, uint32_t width,
                             double *out)
{
    uint32_t sampler = sampler_at(o, animation, channel), keys, values, k = 0;
    const char *kind = text(o, sampler, "interpolation");
    const double *times = read_accessor(o, (uint32_t)number(o, sampler, "input", 0), 1, &keys);
    const double *data = read_accessor(o, (uint32_t)number(o, sampler, "output", 0), width, &values);
    double span, s;
    while (k + 1 < keys && times[k + 1] <= time) {
        k++;
    }
    span = k + 1 < keys ? times[k + 1] - times[k] : 1.0;
    s = k + 1 < keys && time > times[0] ? (time - times[k]) / span : 0.0;
    if (width == 4 && s > 0.0 && (!kind || kind[0] == 'L')) {
        slerp(data + 4 * k, data + 4 * (k + 1), s, out);
    } else {
        for (uint32_t i = 0; i < width; i++) {
            out[i] = interpolate(data, width, i, k, s, span, kind ? kind[0] : 'L');
        }
    }
    if (width == 4) {
        normalize4(out);
    }
}

double oracle_animation_end(const oracle *o, uint32_t animation)
{
    double end = 0.0;
    for (uint32_t c = 0; c < oracle_channel_count(o, animation); c++) {
        end = fmax(end, oracle_channel_end(o, animation, c));
    }
    return end;
}

void oracle_pose(const oracle *o, int animation, double time, double *locals)
{
    for (uint32_t n = 0; n < oracle_node_count(o); n++) {
        const double rest[10] = { 0, 0, 0, 1, 0, 0, 0, 1, 1, 1 };
        uint32_t node = top(o, "nodes", n);
        double *to = locals + 10 * (size_t)n;
        assert_int_equal(member(o, node, "matrix"), 0);
        memcpy(to, rest, sizeof rest);
        read_numbers(o, node, "rotation", 4, to);
        read_numbers(o, node, "translation", 3, to + 4);
        read_numbers(o, node, "scale", 3, to + 7);
        normalize4(to);
    }
    for (uint32_t c = 0; animation >= 0 && c < oracle_channel_count(o, (uint32_t)animation); c++) {
        uint32_t target = member(o, channel_at(o, (uint32_t)animation, c), "target");
        const char *path = text(o, target, "path");
        double *to = locals + 10 * (size_t)number(o, target, "node", 0);
        if (path[0] != 'w') {
            sample_transform(o, (uint32_t)animation, c, time, path[0] == 'r' ? 4 : 3,
                             to + (path[0] == 'r'   ? 0
                                   : path[0] == 't' ? 4
                                                    : 7));
        }
    }
}

static void local_matrix(const double *l, double *m)
{
    double x = l[0], y = l[1], z = l[2], w = l[3];
    const double r[9] = { 1 - 2 * (y * y + z * z), 2 * (x * y + z * w),     2 * (x * z - y * w),
                          2 * (x * y - z * w),     1 - 2 * (x * x + z * z), 2 * (y * z + x * w),
                          2 * (x * z + y * w),     2 * (y * z - x * w),     1 - 2 * (x * x + y * y) };
    for (int i = 0; i < 16; i++) {
        m[i] = i % 4 == 3 ? (i == 15) : i < 12 ? r[i / 4 * 3 + i % 4] * l[7 + i / 4] : l[4 + i - 12];
    }
}

static void multiply(const double *a, const double *b, double *out)
{
    double m[16];
    for (int i = 0; i < 16; i++) {
        m[i] = a[i % 4] * b[i / 4 * 4] + a[4 + i % 4] * b[i / 4 * 4 + 1] + a[8 + i % 4] * b[i / 4 * 4 + 2] +
               a[12 + i % 4] * b[i / 4 * 4 + 3];
    }
    memcpy(out, m, sizeof m);
}

void oracle_worlds(const oracle *o, const double *locals, double *worlds)
{
    uint32_t count = oracle_node_count(o), *parents = test_zeros(sizeof *parents * count);
    for (uint32_t n = 0; n < count; n++) {
        uint32_t children = member(o, top(o, "nodes", n), "children");
        for (uint32_t i = 0; i < length(o, children); i++) {
            parents[(uint32_t)o->values[element(o, children, i)].number] = n + 1;
        }
    }
    for (uint32_t n = 0; n < count; n++) {
        double m[16], local[16];
        local_matrix(locals + 10 * (size_t)n, m);
        for (uint32_t p = parents[n]; p; p = parents[p - 1]) {
            local_matrix(locals + 10 * (size_t)(p - 1), local);
            multiply(local, m, m);
        }
        memcpy(worlds + 16 * (size_t)n, m, sizeof m);
    }
    free(parents);
}

/* ---- skins ---- */

int oracle_node_skin(const oracle *o, uint32_t node)
{
    return (int)number(o, top(o, "nodes", node), "skin", -1);
}

/* [joints][16] world * inverse bind; to be freed */
static double *joint_matrices(const oracle *o, uint32_t skin, const double *worlds)
{
    uint32_t s = top(o, "skins", skin), joints = member(o, s, "joints"), count = length(o, joints), unused;
    const double *binds = member(o, s, "inverseBindMatrices")
                              ? read_accessor(o, (uint32_t)number(o, s, "inverseBindMatrices", 0), 16, &unused)
                              : NULL;
    double *out = test_zeros(sizeof *out * 16 * count);
    for (uint32_t j = 0; j < count; j++) {
        const double *world = worlds + 16 * (size_t)o->values[element(o, joints, j)].number;
        if (binds) {
            multiply(world, binds + 16 * (size_t)j, out + 16 * (size_t)j);
        } else {
            memcpy(out + 16 * (size_t)j, world, 16 * sizeof *out);
        }
    }
    return out;
}

static void move_point(const double *m, const double *p, double factor, double *sum)
{
    for (int r = 0; r < 3; r++) {
        sum[r] += factor * (m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]);
    }
}

static void skin_points(const oracle *o, uint32_t attributes, uint32_t count, const double *matrices, double *points)
{
    double *sums = test_zeros(sizeof *sums * 4 * count);
    for (int set = 0; set < 2; set++) {
        char joints_name[24], weights_name[24];
        const double *joints, *weights;
        uint32_t same;
        snprintf(joints_name, sizeof joints_name, "JOINTS_%d", set);
        snprintf(weights_name, sizeof weights_name, "WEIGHTS_%d", set);
        if (!member(o, attributes, joints_name)) {
            continue;
        }
        joints = read_accessor(o, (uint32_t)number(o, attributes, joints_name, 0), 4, &same);
        weights = read_accessor(o, (uint32_t)number(o, attributes, weights_name, 0), 4, &same);
        for (size_t i = 0; i < 4 * (size_t)count; i++) {
            move_point(matrices + 16 * (size_t)joints[i], points + i / 4 * 3, weights[i], sums + i / 4 * 4);
            sums[i / 4 * 4 + 3] += weights[i];
        }
    }
    for (size_t i = 0; i < 3 * (size_t)count; i++) {
        points[i] = sums[i / 3 * 4 + i % 3] / sums[i / 3 * 4 + 3];
    }
    free(sums);
}

void oracle_drawn(const oracle *o, uint32_t node, uint32_t primitive, const double *worlds, const double *weights,
                  double *out)
{
    uint32_t mesh = (uint32_t)oracle_node_mesh(o, node), count = oracle_vertex_count(o, mesh, primitive);
    int skin = oracle_node_skin(o, node);
    oracle_positions(o, mesh, primitive, weights, out);
    if (skin >= 0) {
        double *matrices = joint_matrices(o, (uint32_t)skin, worlds);
        skin_points(o, member(o, primitive_at(o, mesh, primitive), "attributes"), count, matrices, out);
        free(matrices);
        return;
    }
    for (uint32_t v = 0; v < count; v++) {
        double moved[3] = { 0, 0, 0 };
        move_point(worlds + 16 * (size_t)node, out + 3 * (size_t)v, 1.0, moved);
        memcpy(out + 3 * (size_t)v, moved, sizeof moved);
    }
}
