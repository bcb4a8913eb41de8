#include "gltf_write.h"

#include "animate.h"
#include "targets.h"

#include <math.h>
#include <stdlib.h>

enum { FLOAT = 5126, U16 = 5123, U32 = 5125, ARRAY = 34962, ELEMENT_ARRAY = 34963, NO_TARGET = 0 };

typedef struct {
    Buffer views, accessors, data;
    int view_count, accessor_count;
} Writer;

typedef struct {
    float x, y, z;
} F3;

static F3 f3(V3 v)
{
    F3 f = { (float)v.x, (float)v.y, (float)v.z };
    return f;
}

static void put_f3(Buffer *data, F3 f)
{
    buffer_float(data, f.x);
    buffer_float(data, f.y);
    buffer_float(data, f.z);
}

/* Views: each begins on a multiple of four bytes and covers what is written
 * between open and close. */
static int view_open(Writer *w)
{
    buffer_pad(&w->data, 4, 0);
    return w->data.count;
}

static int view_close(Writer *w, int start, int target)
{
    buffer_print(&w->views, "%s{\"buffer\":0,\"byteOffset\":%d,\"byteLength\":%d",
                 w->view_count ? ",\n" : "", start, w->data.count - start);
    if (target != NO_TARGET) {
        buffer_print(&w->views, ",\"target\":%d", target);
    }
    buffer_print(&w->views, "}");
    return w->view_count++;
}

static void accessor_begin(Writer *w, int component, int count, const char *type)
{
    buffer_print(&w->accessors, "%s{\"componentType\":%d,\"count\":%d,\"type\":\"%s\"",
                 w->accessor_count ? ",\n" : "", component, count, type);
}

static int accessor_end(Writer *w)
{
    buffer_print(&w->accessors, "}");
    return w->accessor_count++;
}

static void print_range(Writer *w, const F3 *values, int count, F3 low, F3 high)
{
    for (int i = 0; i < count; i++) {
        F3 v = values[i];
        if (v.x < low.x) {
            low.x = v.x;
        }
        if (v.y < low.y) {
            low.y = v.y;
        }
        if (v.z < low.z) {
            low.z = v.z;
        }
        if (v.x > high.x) {
            high.x = v.x;
        }
        if (v.y > high.y) {
            high.y = v.y;
        }
        if (v.z > high.z) {
            high.z = v.z;
        }
    }
    buffer_print(&w->accessors, ",\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]", (double)low.x,
                 (double)low.y, (double)low.z, (double)high.x, (double)high.y, (double)high.z);
}

static int write_vectors(Writer *w, const V3 *values, int count, int with_range)
{
    F3 *rounded = grab(NULL, count, (int)sizeof *rounded);
    int start = view_open(w);
    for (int i = 0; i < count; i++) {
        put_f3(&w->data, rounded[i] = f3(values[i]));
    }
    int view = view_close(w, start, ARRAY);
    accessor_begin(w, FLOAT, count, "VEC3");
    buffer_print(&w->accessors, ",\"bufferView\":%d", view);
    if (with_range) {
        print_range(w, rounded, count, rounded[0], rounded[0]);
    }
    free(rounded);
    return accessor_end(w);
}

static int write_tangents(Writer *w, const Frame *frame)
{
    int start = view_open(w);
    for (int i = 0; i < frame->count; i++) {
        put_f3(&w->data, f3(frame->tangent[i]));
        buffer_float(&w->data, (float)frame->handedness[i]);
    }
    int view = view_close(w, start, ARRAY);
    accessor_begin(w, FLOAT, frame->count, "VEC4");
    buffer_print(&w->accessors, ",\"bufferView\":%d", view);
    return accessor_end(w);
}

static int write_texture(Writer *w, const Part *part)
{
    int start = view_open(w);
    for (int i = 0; i < part->seed_count; i++) {
        buffer_float(&w->data, (float)part->seeds[i].u);
        buffer_float(&w->data, (float)part->seeds[i].v);
    }
    int view = view_close(w, start, ARRAY);
    accessor_begin(w, FLOAT, part->seed_count, "VEC2");
    buffer_print(&w->accessors, ",\"bufferView\":%d", view);
    return accessor_end(w);
}

static int write_indices(Writer *w, const Part *part)
{
    int start = view_open(w);
    for (int i = 0; i < part->index_count; i++) {
        buffer_u16(&w->data, part->indices[i]);
    }
    int view = view_close(w, start, ELEMENT_ARRAY);
    accessor_begin(w, U16, part->index_count, "SCALAR");
    buffer_print(&w->accessors, ",\"bufferView\":%d", view);
    return accessor_end(w);
}

static int write_scalars(Writer *w, const double *values, int count, int with_range)
{
    int start = view_open(w);
    for (int i = 0; i < count; i++) {
        buffer_float(&w->data, (float)values[i]);
    }
    int view = view_close(w, start, NO_TARGET);
    accessor_begin(w, FLOAT, count, "SCALAR");
    buffer_print(&w->accessors, ",\"bufferView\":%d", view);
    if (with_range) {
        buffer_print(&w->accessors, ",\"min\":[%.9g],\"max\":[%.9g]", (double)(float)values[0],
                     (double)(float)values[count - 1]);
    }
    return accessor_end(w);
}

/* All zeros, for a part that a target leaves alone. */
static int write_zeros(Writer *w, int count)
{
    accessor_begin(w, FLOAT, count, "VEC3");
    buffer_print(&w->accessors, ",\"min\":[0,0,0],\"max\":[0,0,0]");
    return accessor_end(w);
}

/* Differences below these are noise. */
static const double place_step = 5e-7, direction_step = 2e-4;

static F3 difference(V3 now, V3 rest, double step)
{
    V3 d = v3_sub(now, rest);
    if (fabs(d.x) < step && fabs(d.y) < step && fabs(d.z) < step) {
        d = v3(0, 0, 0);
    }
    return f3(d);
}

static int is_zero(F3 f)
{
    return f.x == 0 && f.y == 0 && f.z == 0;
}

typedef struct {
    int count, *vertex;
    F3 *position, *normal, *tangent;
} Deltas;

static Deltas find_deltas(const Frame *rest, const Frame *now)
{
    Deltas d = { 0 };
    int vector = (int)sizeof(F3);
    d.vertex = grab(NULL, rest->count, (int)sizeof(int));
    d.position = grab(NULL, rest->count, vector);
    d.normal = grab(NULL, rest->count, vector);
    d.tangent = grab(NULL, rest->count, vector);
    for (int i = 0; i < rest->count; i++) {
        F3 position = difference(now->position[i], rest->position[i], place_step);
        F3 normal = difference(now->normal[i], rest->normal[i], direction_step);
        F3 tangent = difference(now->tangent[i], rest->tangent[i], direction_step);
        if (is_zero(position) && is_zero(normal) && is_zero(tangent)) {
            continue;
        }
        d.vertex[d.count] = i;
        d.position[d.count] = position;
        d.normal[d.count] = normal;
        d.tangent[d.count++] = tangent;
    }
    return d;
}

static int write_sparse(Writer *w, int vertices, const Deltas *d, const F3 *values, int index_view,
                        int with_range)
{
    int start = view_open(w);
    for (int i = 0; i < d->count; i++) {
        put_f3(&w->data, values[i]);
    }
    int view = view_close(w, start, NO_TARGET);
    accessor_begin(w, FLOAT, vertices, "VEC3");
    F3 zero = { 0, 0, 0 };
    if (with_range && d->count < vertices) {
        print_range(w, values, d->count, zero, zero);
    }
    if (with_range && d->count == vertices) {
        print_range(w, values, d->count, values[0], values[0]);
    }
    buffer_print(&w->accessors,
                 ",\"sparse\":{\"count\":%d,\"indices\":{\"bufferView\":%d,\"componentType\":%d},"
                 "\"values\":{\"bufferView\":%d}}",
                 d->count, index_view, U16, view);
    return accessor_end(w);
}

static void write_deltas(Writer *w, Buffer *json, const Deltas *d, int vertices, int zeros)
{
    int position = zeros, normal = zeros, tangent = zeros;
    if (d->count > 0) {
        int start = view_open(w);
        for (int i = 0; i < d->count; i++) {
            buffer_u16(&w->data, (uint32_t)d->vertex[i]);
        }
        int view = view_close(w, start, NO_TARGET);
        position = write_sparse(w, vertices, d, d->position, view, 1);
        normal = write_sparse(w, vertices, d, d->normal, view, 0);
        tangent = write_sparse(w, vertices, d, d->tangent, view, 0);
    }
    buffer_print(json, "{\"POSITION\":%d,\"NORMAL\":%d,\"TANGENT\":%d}", position, normal, tangent);
}

static void write_targets(Writer *w, Buffer *json, const Part *part, const Frame *rest,
                          const int *weld)
{
    int zeros = write_zeros(w, rest->count);
    for (int target = 0; target < target_count(); target++) {
        Pose pose = target_pose(target);
        Frame now = mesh_frame(part, weld, &pose);
        Deltas deltas = find_deltas(rest, &now);
        buffer_print(json, target ? ",\n" : "");
        write_deltas(w, json, &deltas, rest->count, zeros);
        free(deltas.vertex);
        free(deltas.position);
        free(deltas.normal);
        free(deltas.tangent);
        mesh_free(&now);
    }
}

static void write_primitive(Writer *w, Buffer *json, const Model *model, int number,
                            const Frame *rest, const int *weld)
{
    const Part *part = &model->parts[number];
    int position = write_vectors(w, rest->position, rest->count, 1);
    int normal = write_vectors(w, rest->normal, rest->count, 0);
    int tangent = write_tangents(w, rest);
    int texture = write_texture(w, part);
    int colour = write_vectors(w, part->colours, rest->count, 0);
    int indices = write_indices(w, part);
    buffer_print(json,
                 "%s{\"attributes\":{\"POSITION\":%d,\"NORMAL\":%d,\"TANGENT\":%d,"
                 "\"TEXCOORD_0\":%d,\"COLOR_0\":%d},\"indices\":%d,\"material\":%d,\n\"targets\":[",
                 number ? ",\n" : "", position, normal, tangent, texture, colour, indices, number);
    write_targets(w, json, part, rest, weld);
    buffer_print(json, "]}");
}

static void write_mesh(Writer *w, Buffer *json, const Model *model, const Frame *rest,
                       int *const *weld)
{
    buffer_print(json, "\"meshes\":[{\"name\":\"mask\",\"primitives\":[\n");
    for (int i = 0; i < PART_COUNT; i++) {
        write_primitive(w, json, model, i, &rest[i], weld[i]);
    }
    buffer_print(json, "],\n\"weights\":[");
    for (int i = 0; i < target_count(); i++) {
        buffer_print(json, i ? ",0" : "0");
    }
    buffer_print(json, "],\n\"extras\":{\"targetNames\":[");
    for (int i = 0; i < target_count(); i++) {
        buffer_print(json, "%s\"%s\"", i ? "," : "", target_name(i));
    }
    buffer_print(json, "]}}],\n");
}

static void write_materials(Buffer *json)
{
    static const struct {
        const char *name;
        double roughness;
    } materials[PART_COUNT] = {
        { "paint", 0.55 }, { "wood", 0.75 }, { "eyes", 0.12 }, { "teeth", 0.25 }, { "mouth", 0.60 }
    };
    buffer_print(json, "\"materials\":[");
    for (int i = 0; i < PART_COUNT; i++) {
        buffer_print(json,
                     "%s{\"name\":\"%s\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,1],"
                     "\"metallicFactor\":0,\"roughnessFactor\":%.2f}}",
                     i ? ",\n" : "", materials[i].name, materials[i].roughness);
    }
    buffer_print(json, "],\n");
}

static void write_animations(Writer *w, Buffer *json)
{
    buffer_print(json, "\"animations\":[\n");
    for (int i = 0; i < ANIMATION_COUNT; i++) {
        Animation animation = animation_make(i);
        int times = write_scalars(w, animation.times, animation.key_count, 1);
        int values = write_scalars(w, animation.values, animation.value_count, 0);
        buffer_print(json,
                     "%s{\"name\":\"%s\",\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,"
                     "\"path\":\"weights\"}}],\"samplers\":[{\"input\":%d,\"output\":%d,"
                     "\"interpolation\":\"%s\"}]}",
                     i ? ",\n" : "", animation.name, times, values, animation.interpolation);
        animation_free(&animation);
    }
    buffer_print(json, "],\n");
}

static void write_container(Buffer *file, Buffer *json, Buffer *data)
{
    buffer_pad(json, 4, ' ');
    buffer_pad(data, 4, 0);
    buffer_u32(file, 0x46546c67u); /* glTF */
    buffer_u32(file, 2);
    buffer_u32(file, (uint32_t)(12 + 8 + json->count + 8 + data->count));
    buffer_u32(file, (uint32_t)json->count);
    buffer_u32(file, 0x4e4f534au); /* JSON */
    buffer_append(file, json);
    buffer_u32(file, (uint32_t)data->count);
    buffer_u32(file, 0x004e4942u); /* BIN */
    buffer_append(file, data);
}

Census gltf_write(Buffer *file, const Model *model, const Frame *rest, int *const *weld)
{
    Writer w = { 0 };
    Buffer json = { 0 };
    buffer_print(&json, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"noh make_mask\"},\n"
                        "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\n"
                        "\"nodes\":[{\"name\":\"mask\",\"mesh\":0}],\n");
    write_materials(&json);
    write_mesh(&w, &json, model, rest, weld);
    write_animations(&w, &json);
    buffer_print(&json, "\"accessors\":[\n");
    buffer_append(&json, &w.accessors);
    buffer_print(&json, "],\n\"bufferViews\":[\n");
    buffer_append(&json, &w.views);
    buffer_pad(&w.data, 4, 0);
    buffer_print(&json, "],\n\"buffers\":[{\"byteLength\":%d}]}", w.data.count);
    write_container(file, &json, &w.data);
    Census census = { .targets = target_count(), .animations = ANIMATION_COUNT };
    for (int i = 0; i < PART_COUNT; i++) {
        census.vertices += model->parts[i].seed_count;
        census.triangles += model->parts[i].index_count / 3;
    }
    buffer_free(&w.views);
    buffer_free(&w.accessors);
    buffer_free(&w.data);
    buffer_free(&json);
    return census;
}
