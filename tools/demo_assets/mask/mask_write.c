#include "mask_write.h"

#include "shared/grab.h"
#include "hold.h"
#include "targets.h"

#include <math.h>
#include <stdlib.h>

/* All zeros, for a part that a target does not move. */
static int write_zeros(Writer *w, int count)
{
    accessor_begin(w, TYPE_FLOAT, count, "VEC3");
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

static int write_sparse(Writer *w, int vertices, const Deltas *d, const F3 *values, int index_view, int with_range)
{
    int start = view_open(w);
    for (int i = 0; i < d->count; i++) {
        put_f3(&w->data, values[i]);
    }
    int view = view_close(w, start, TARGET_NONE);
    accessor_begin(w, TYPE_FLOAT, vertices, "VEC3");
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
                 d->count, index_view, TYPE_U16, view);
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
        int view = view_close(w, start, TARGET_NONE);
        position = write_sparse(w, vertices, d, d->position, view, 1);
        normal = write_sparse(w, vertices, d, d->normal, view, 0);
        tangent = write_sparse(w, vertices, d, d->tangent, view, 0);
    }
    buffer_print(json, "{\"POSITION\":%d,\"NORMAL\":%d,\"TANGENT\":%d}", position, normal, tangent);
}

/* What a target's pose is measured from: lips that are shut were parted by the same grin, and in mouthClose by an open
 * jaw (closed at rest, they cannot come closer). */
static Pose target_base(Pose *pose)
{
    Pose base = { 0 };
    if (pose->mouth_close > 0) {
        pose->jaw_open = pose->grin > 0 ? 0 : 1;
        base = *pose;
        base.mouth_close = 0;
    }
    return base;
}

static void write_targets(Writer *w, Buffer *json, const Figure *figure, int number)
{
    const Part *part = &figure->model.parts[number];
    const Frame *rest = &figure->frames[number];
    int zeros = write_zeros(w, rest->count);
    for (int target = 0; target < figure->target_count; target++) {
        Pose pose = target_pose(target), base = target_base(&pose);
        Frame from = mesh_frame(part, figure->weld[number], &base);
        Frame now = mesh_frame(part, figure->weld[number], &pose);
        Deltas deltas = find_deltas(&from, &now);
        buffer_print(json, target ? ",\n" : "");
        write_deltas(w, json, &deltas, rest->count, zeros);
        free(deltas.vertex);
        free(deltas.position);
        free(deltas.normal);
        free(deltas.tangent);
        mesh_free(&from);
        mesh_free(&now);
    }
}

static int write_tangents(Writer *w, const Frame *frame)
{
    double *values = grab(NULL, 4 * frame->count, (int)sizeof *values);
    for (int i = 0; i < frame->count; i++) {
        values[4 * i] = frame->tangent[i].x;
        values[4 * i + 1] = frame->tangent[i].y;
        values[4 * i + 2] = frame->tangent[i].z;
        values[4 * i + 3] = frame->handedness[i];
    }
    int accessor = write_floats(w, values, frame->count, "VEC4", 4, TARGET_ARRAY);
    free(values);
    return accessor;
}

static int write_texture(Writer *w, const Part *part)
{
    double *values = grab(NULL, 2 * part->seed_count, (int)sizeof *values);
    for (int i = 0; i < part->seed_count; i++) {
        values[2 * i] = part->seeds[i].u;
        values[2 * i + 1] = part->seeds[i].v;
    }
    int accessor = write_floats(w, values, part->seed_count, "VEC2", 2, TARGET_ARRAY);
    free(values);
    return accessor;
}

static int write_positions(Writer *w, const Frame *rest, const MaskWearer *wearer)
{
    if (!wearer) {
        return write_vectors(w, rest->position, rest->count, 1);
    }
    V3 *moved = grab(NULL, rest->count, (int)sizeof *moved);
    for (int i = 0; i < rest->count; i++) {
        moved[i] = v3_add(rest->position[i], wearer->origin);
    }
    int accessor = write_vectors(w, moved, rest->count, 1);
    free(moved);
    return accessor;
}

/* Two joints hold each vertex. Their shares are whole multiples of 1/65536, so that they sum to
 * exactly 1 as floats too. */
static void write_holds(Writer *w, Buffer *json, const Part *part, const MaskWearer *wearer)
{
    int *joints = grab(NULL, 4 * part->seed_count, (int)sizeof *joints);
    double *weights = grab(NULL, 4 * part->seed_count, (int)sizeof *weights);
    for (int i = 0; i < part->seed_count; i++) {
        double jaw = floor(jaw_hold(&part->seeds[i]) * 65536 + 0.5) / 65536;
        joints[4 * i] = jaw < 1 ? wearer->head : 0;
        joints[4 * i + 1] = jaw > 0 ? wearer->jaw : 0;
        joints[4 * i + 2] = joints[4 * i + 3] = 0;
        weights[4 * i] = 1 - jaw;
        weights[4 * i + 1] = jaw;
        weights[4 * i + 2] = weights[4 * i + 3] = 0;
    }
    int joint_accessor = write_joints(w, joints, part->seed_count);
    int weight_accessor = write_floats(w, weights, part->seed_count, "VEC4", 4, TARGET_ARRAY);
    buffer_print(json, ",\"JOINTS_0\":%d,\"WEIGHTS_0\":%d", joint_accessor, weight_accessor);
    free(joints);
    free(weights);
}

static void write_primitive(Writer *w, Buffer *json, const Figure *mask, int number, const MaskWearer *wearer)
{
    const Part *part = &mask->model.parts[number];
    const Frame *rest = &mask->frames[number];
    int position = write_positions(w, rest, wearer);
    int normal = write_vectors(w, rest->normal, rest->count, 0);
    int tangent = write_tangents(w, rest);
    int texture = write_texture(w, part);
    int colour = write_vectors(w, part->colours, rest->count, 0);
    int indices = write_indices(w, part->indices, part->index_count);
    buffer_print(json,
                 "%s{\"attributes\":{\"POSITION\":%d,\"NORMAL\":%d,\"TANGENT\":%d,"
                 "\"TEXCOORD_0\":%d,\"COLOR_0\":%d",
                 number ? ",\n" : "", position, normal, tangent, texture, colour);
    if (wearer) {
        write_holds(w, json, part, wearer);
    }
    buffer_print(json, "},\"indices\":%d,\"material\":%d,\n\"targets\":[", indices, number);
    write_targets(w, json, mask, number);
    buffer_print(json, "]}");
}

void mask_mesh_write(Writer *w, Buffer *json, const Figure *mask, const MaskWearer *wearer)
{
    buffer_print(json, "{\"name\":\"%s\",\"primitives\":[\n", mask->name);
    for (int i = 0; i < mask->model.part_count; i++) {
        write_primitive(w, json, mask, i, wearer);
    }
    buffer_print(json, "],\n\"weights\":[");
    for (int i = 0; i < mask->target_count; i++) {
        buffer_print(json, i ? ",0" : "0");
    }
    buffer_print(json, "],\n\"extras\":{\"targetNames\":[");
    for (int i = 0; i < mask->target_count; i++) {
        buffer_print(json, "%s\"%s\"", i ? "," : "", target_name(i));
    }
    buffer_print(json, "]}}");
}

void materials_write(Buffer *json, const FigureMaterial *materials, int count)
{
    for (int i = 0; i < count; i++) {
        material_write(json, i == 0, materials[i].name, materials[i].roughness, 0);
    }
}
