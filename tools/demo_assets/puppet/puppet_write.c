#include "puppet_write.h"

#include "body.h"
#include "clip_write.h"
#include "shared/grab.h"
#include "mask/mask.h"
#include "mask/mask_write.h"
#include "mask/targets.h"

#include <stdlib.h>

/* Nodes: the joints, the body, the mask. */
enum { BODY_NODE = JOINT_COUNT, MASK_NODE };

static void write_joint(Buffer *json, int joint, const char *end)
{
    int parent = joint_parent(joint), children = 0;
    V3 place = joint_place(joint);
    V3 bone = parent < 0 ? place : v3_sub(place, joint_place(parent));
    buffer_print(json, "{\"name\":\"%s\",\"translation\":[%.9g,%.9g,%.9g]", joint_name(joint), bone.x, bone.y, bone.z);
    for (int child = joint + 1; child < JOINT_COUNT; child++) {
        if (joint_parent(child) == joint) {
            buffer_print(json, children++ ? ",%d" : ",\"children\":[%d", child);
        }
    }
    buffer_print(json, children ? "]}%s" : "}%s", end);
}

static void write_nodes(Buffer *json)
{
    buffer_print(json, "\"scene\":0,\"scenes\":[{\"nodes\":[0,%d,%d]}],\n\"nodes\":[\n", BODY_NODE, MASK_NODE);
    for (int joint = 0; joint < JOINT_COUNT; joint++) {
        write_joint(json, joint, ",\n");
    }
    buffer_print(json, "{\"name\":\"body\",\"mesh\":0,\"skin\":0},\n{\"name\":\"mask\",\"mesh\":1,\"skin\":0}],\n");
}

/* No joint is turned in the bind pose. */
static void write_skin(Writer *w, Buffer *json)
{
    double matrices[JOINT_COUNT * 16] = { 0 };
    for (int joint = 0; joint < JOINT_COUNT; joint++) {
        double *m = &matrices[16 * joint];
        V3 place = joint_place(joint);
        m[0] = m[5] = m[10] = m[15] = 1;
        m[12] = -place.x;
        m[13] = -place.y;
        m[14] = -place.z;
    }
    int accessor = write_floats(w, matrices, JOINT_COUNT, "MAT4", 16, TARGET_NONE);
    buffer_print(json, "\"skins\":[{\"name\":\"puppet\",\"skeleton\":0,\"inverseBindMatrices\":%d,\"joints\":[",
                 accessor);
    for (int joint = 0; joint < JOINT_COUNT; joint++) {
        buffer_print(json, joint ? ",%d" : "%d", joint);
    }
    buffer_print(json, "]}],\n");
}

static void write_materials(Buffer *json, const Figure *mask)
{
    buffer_print(json, "\"materials\":[");
    materials_write(json, mask->materials, mask->model.part_count);
    material_write(json, 0, "cloth", 0.85, 1);
    material_write(json, 0, "skin", 0.55, 0);
    material_write(json, 0, "hair", 0.45, 0);
    buffer_print(json, "],\n");
}

static void write_grips(Writer *w, Buffer *json, const Piece *piece)
{
    int *joints = grab(NULL, HELD_BY * piece->count, (int)sizeof *joints);
    double *weights = grab(NULL, HELD_BY * piece->count, (int)sizeof *weights);
    for (int i = 0; i < HELD_BY * piece->count; i++) {
        joints[i] = piece->grip[i / HELD_BY].joint[i % HELD_BY];
        weights[i] = piece->grip[i / HELD_BY].weight[i % HELD_BY];
    }
    int joint_accessor = write_joints(w, joints, piece->count);
    int weight_accessor = write_floats(w, weights, piece->count, "VEC4", HELD_BY, TARGET_ARRAY);
    buffer_print(json, ",\"JOINTS_0\":%d,\"WEIGHTS_0\":%d}", joint_accessor, weight_accessor);
    free(joints);
    free(weights);
}

void piece_write(Writer *w, Buffer *json, const Piece *piece, int material)
{
    int position = write_vectors(w, piece->position, piece->count, 1);
    int normal = write_vectors(w, piece->normal, piece->count, 0);
    int texture = write_floats(w, piece->texture, piece->count, "VEC2", 2, TARGET_ARRAY);
    int colour = write_vectors(w, piece->colour, piece->count, 0);
    int indices = write_indices(w, piece->indices, piece->index_count);
    buffer_print(json, "{\"attributes\":{\"POSITION\":%d,\"NORMAL\":%d,\"TEXCOORD_0\":%d,\"COLOR_0\":%d", position,
                 normal, texture, colour);
    write_grips(w, json, piece);
    buffer_print(json, ",\"indices\":%d,\"material\":%d}", indices, material);
}

static void write_body(Writer *w, Buffer *json, const Body *body)
{
    buffer_print(json, "{\"name\":\"body\",\"primitives\":[\n");
    for (int i = 0; i < MATERIAL_COUNT; i++) {
        buffer_print(json, i ? ",\n" : "");
        piece_write(w, json, &body->pieces[i], PART_COUNT + i);
    }
    buffer_print(json, "]}");
}

static PuppetCensus take_census(const Body *body, const Figure *mask)
{
    PuppetCensus census = { .joints = JOINT_COUNT, .animations = CLIP_COUNT };
    for (int i = 0; i < MATERIAL_COUNT; i++) {
        census.body_vertices += body->pieces[i].count;
        census.triangles += body->pieces[i].index_count / 3;
    }
    for (int i = 0; i < PART_COUNT; i++) {
        census.mask_vertices += mask->model.parts[i].seed_count;
        census.triangles += mask->model.parts[i].index_count / 3;
    }
    return census;
}

/* Clips without a mesh. */
static PuppetCensus clips_write(Buffer *file, const Clip *(*number)(int), int count)
{
    PuppetCensus census = { .joints = JOINT_COUNT, .animations = count };
    Writer w = { 0 };
    Buffer json = { 0 };
    buffer_print(&json, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"noh demo_assets\"},\n");
    buffer_print(&json, "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\n\"nodes\":[\n");
    for (int joint = 0; joint < JOINT_COUNT; joint++) {
        write_joint(&json, joint, joint + 1 == JOINT_COUNT ? "\n" : ",\n");
    }
    buffer_print(&json, "],\n");
    write_skin(&w, &json);
    buffer_print(&json, "\"animations\":[\n");
    for (int i = 0; i < count; i++) {
        buffer_print(&json, i ? ",\n" : "");
        clip_write(&w, &json, number(i), -1);
    }
    buffer_print(&json, "],\n");
    writer_finish(&w, &json, file);
    buffer_free(&json);
    return census;
}

PuppetCensus get_up_write(Buffer *file)
{
    return clips_write(file, get_up_number, GET_UP_COUNT);
}

PuppetCensus roam_write(Buffer *file)
{
    return clips_write(file, roam_number, ROAM_COUNT);
}

PuppetCensus roam_all_write(Buffer *file)
{
    return clips_write(file, roam_number, ROAM_ALL);
}

PuppetCensus puppet_write(Buffer *file)
{
    const MaskWearer wearer = { mask_origin(), HEAD, JAW };
    Writer w = { 0 };
    Buffer json = { 0 };
    Body body = body_build();
    Figure mask = mask_build();
    buffer_print(&json, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"noh demo_assets\"},\n");
    write_nodes(&json);
    write_skin(&w, &json);
    write_materials(&json, &mask);
    buffer_print(&json, "\"meshes\":[");
    write_body(&w, &json, &body);
    buffer_print(&json, ",\n");
    mask_mesh_write(&w, &json, &mask, &wearer);
    buffer_print(&json, "],\n\"animations\":[\n");
    for (int i = 0; i < CLIP_COUNT; i++) {
        buffer_print(&json, i ? ",\n" : "");
        clip_write(&w, &json, clip_number(i), MASK_NODE);
    }
    buffer_print(&json, "],\n");
    writer_finish(&w, &json, file);
    PuppetCensus census = take_census(&body, &mask);
    buffer_free(&json);
    body_free(&body);
    figure_free(&mask);
    return census;
}
