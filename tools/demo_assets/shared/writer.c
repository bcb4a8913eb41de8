#include "writer.h"

#include "grab.h"

#include <stdlib.h>

F3 f3(V3 v)
{
    F3 f = { (float)v.x, (float)v.y, (float)v.z };
    return f;
}

void put_f3(Buffer *data, F3 f)
{
    buffer_float(data, f.x);
    buffer_float(data, f.y);
    buffer_float(data, f.z);
}

int view_open(Writer *w)
{
    buffer_pad(&w->data, 4, 0);
    return w->data.count;
}

int view_close(Writer *w, int start, int target)
{
    buffer_print(&w->views, "%s{\"buffer\":0,\"byteOffset\":%d,\"byteLength\":%d", w->view_count ? ",\n" : "", start,
                 w->data.count - start);
    if (target != TARGET_NONE) {
        buffer_print(&w->views, ",\"target\":%d", target);
    }
    buffer_print(&w->views, "}");
    return w->view_count++;
}

void accessor_begin(Writer *w, int component, int count, const char *type)
{
    buffer_print(&w->accessors, "%s{\"componentType\":%d,\"count\":%d,\"type\":\"%s\"", w->accessor_count ? ",\n" : "",
                 component, count, type);
}

int accessor_end(Writer *w)
{
    buffer_print(&w->accessors, "}");
    return w->accessor_count++;
}

void print_range(Writer *w, const F3 *values, int count, F3 low, F3 high)
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
    buffer_print(&w->accessors, ",\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]", (double)low.x, (double)low.y,
                 (double)low.z, (double)high.x, (double)high.y, (double)high.z);
}

int write_vectors(Writer *w, const V3 *values, int count, int with_range)
{
    F3 *rounded = grab(NULL, count, (int)sizeof *rounded);
    int start = view_open(w);
    for (int i = 0; i < count; i++) {
        put_f3(&w->data, rounded[i] = f3(values[i]));
    }
    int view = view_close(w, start, TARGET_ARRAY);
    accessor_begin(w, TYPE_FLOAT, count, "VEC3");
    buffer_print(&w->accessors, ",\"bufferView\":%d", view);
    if (with_range) {
        print_range(w, rounded, count, rounded[0], rounded[0]);
    }
    free(rounded);
    return accessor_end(w);
}

int write_floats(Writer *w, const double *values, int count, const char *type, int width, int target)
{
    int start = view_open(w);
    for (int i = 0; i < count * width; i++) {
        buffer_float(&w->data, (float)values[i]);
    }
    int view = view_close(w, start, target);
    accessor_begin(w, TYPE_FLOAT, count, type);
    buffer_print(&w->accessors, ",\"bufferView\":%d", view);
    return accessor_end(w);
}

int write_joints(Writer *w, const int *joints, int count)
{
    int start = view_open(w);
    for (int i = 0; i < 4 * count; i++) {
        buffer_u8(&w->data, (uint32_t)joints[i]);
    }
    int view = view_close(w, start, TARGET_ARRAY);
    accessor_begin(w, TYPE_U8, count, "VEC4");
    buffer_print(&w->accessors, ",\"bufferView\":%d", view);
    return accessor_end(w);
}

int write_indices(Writer *w, const uint32_t *indices, int count)
{
    int start = view_open(w);
    for (int i = 0; i < count; i++) {
        buffer_u16(&w->data, indices[i]);
    }
    int view = view_close(w, start, TARGET_ELEMENTS);
    accessor_begin(w, TYPE_U16, count, "SCALAR");
    buffer_print(&w->accessors, ",\"bufferView\":%d", view);
    return accessor_end(w);
}

int write_scalars(Writer *w, const double *values, int count, int with_range)
{
    int start = view_open(w);
    for (int i = 0; i < count; i++) {
        buffer_float(&w->data, (float)values[i]);
    }
    int view = view_close(w, start, TARGET_NONE);
    accessor_begin(w, TYPE_FLOAT, count, "SCALAR");
    buffer_print(&w->accessors, ",\"bufferView\":%d", view);
    if (with_range) {
        buffer_print(&w->accessors, ",\"min\":[%.9g],\"max\":[%.9g]", (double)(float)values[0],
                     (double)(float)values[count - 1]);
    }
    return accessor_end(w);
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

void writer_finish(Writer *w, Buffer *json, Buffer *file)
{
    buffer_print(json, "\"accessors\":[\n");
    buffer_append(json, &w->accessors);
    buffer_print(json, "],\n\"bufferViews\":[\n");
    buffer_append(json, &w->views);
    buffer_pad(&w->data, 4, 0);
    buffer_print(json, "],\n\"buffers\":[{\"byteLength\":%d}]}", w->data.count);
    write_container(file, json, &w->data);
    buffer_free(&w->views);
    buffer_free(&w->accessors);
    buffer_free(&w->data);
}

void material_write(Buffer *json, int is_first, const char *name, double roughness, int tint)
{
    buffer_print(json,
                 "%s{\"name\":\"%s\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,1],"
                 "\"metallicFactor\":0,\"roughnessFactor\":%.2f}%s}",
                 is_first ? "" : ",\n", name, roughness, tint ? "" : ",\"extras\":{\"tint\":false}");
}
