/* A coat for the puppet: a shell about its trunk, moved outwards, and a tail that hangs behind. Its skeleton has the
 * joints of the trunk, by the puppet's names and at the puppet's places, and its own: the tail's, and a tassel's, which
 * moves no vertex. It lacks the neck, between chest and head. */
#include "puppet_write.h"

#include "ambient.h"
#include "shared/grab.h"

#include <stdlib.h>

#define OUTWARDS 0.016 /* metres from the body to the coat */
#define TAIL_WIDE 0.11
enum { TAIL_ROWS = 13, TAIL_COLUMNS = 7, OWN_JOINTS = 3 };

static const double tail_top = 0.955, tail_joint = 0.74, tail_end = 0.50;

/* ---- joints ---- */

static int has_joint(int joint)
{
    int side = (joint - MIDDLE_JOINTS) % SIDE_JOINTS;
    return joint < MIDDLE_JOINTS ? joint <= HEAD && joint != NECK
                                 : side == SHOULDER || side == UPPER_ARM || side == THIGH;
}

/* The number of a joint in the coat. The tail's follow. */
static int own_number(int joint)
{
    int number = 0;
    for (int i = 0; i < joint; i++) {
        number += has_joint(i);
    }
    return number;
}

/* The two of the tail, and the tassel. */
static V3 own_place(int joint)
{
    return joint == 2 ? v3(0, 1.60, -0.15) : v3(0, joint ? tail_joint : tail_top, -0.175);
}

static int own_parent(int joint)
{
    do {
        joint = joint_parent(joint);
    } while (joint >= 0 && !has_joint(joint));
    return joint;
}

static void write_node(Buffer *json, const char *name, V3 at)
{
    buffer_print(json, "{\"name\":\"%s\",\"translation\":[%.9g,%.9g,%.9g]", name, at.x, at.y, at.z);
}

static void write_joint(Buffer *json, int joint)
{
    int parent = own_parent(joint), children = 0;
    V3 place = joint_place(joint);
    write_node(json, joint_name(joint), parent < 0 ? place : v3_sub(place, joint_place(parent)));
    for (int child = joint + 1; child < JOINT_COUNT; child++) {
        if (has_joint(child) && own_parent(child) == joint) {
            buffer_print(json, children++ ? ",%d" : ",\"children\":[%d", own_number(child));
        }
    }
    if (joint == HIPS || joint == HEAD) {
        buffer_print(json, children++ ? ",%d" : ",\"children\":[%d", own_number(JOINT_COUNT) + (joint == HEAD ? 2 : 0));
    }
    buffer_print(json, children ? "]},\n" : "},\n");
}

static void write_nodes(Buffer *json)
{
    int count = own_number(JOINT_COUNT);
    buffer_print(json, "\"scene\":0,\"scenes\":[{\"nodes\":[0,%d]}],\n\"nodes\":[\n", count + OWN_JOINTS);
    for (int joint = 0; joint < JOINT_COUNT; joint++) {
        if (has_joint(joint)) {
            write_joint(json, joint);
        }
    }
    write_node(json, "tail.1", v3_sub(own_place(0), joint_place(HIPS)));
    buffer_print(json, ",\"children\":[%d]},\n", count + 1);
    write_node(json, "tail.2", v3_sub(own_place(1), own_place(0)));
    buffer_print(json, "},\n");
    write_node(json, "tassel", v3_sub(own_place(2), joint_place(HEAD)));
    buffer_print(json, "},\n{\"name\":\"coat\",\"mesh\":0,\"skin\":0}],\n");
}

static void write_skin(Writer *w, Buffer *json)
{
    int count = own_number(JOINT_COUNT) + OWN_JOINTS;
    double *matrices = grab(NULL, 16 * count, (int)sizeof *matrices);
    for (int i = 0, joint = 0; i < count; i++) {
        V3 place;
        while (joint < JOINT_COUNT && !has_joint(joint)) {
            joint++;
        }
        place = joint < JOINT_COUNT ? joint_place(joint++) : own_place(i - (count - OWN_JOINTS));
        for (int k = 0; k < 16; k++) {
            matrices[16 * i + k] = k % 5 == 0;
        }
        matrices[16 * i + 12] = -place.x;
        matrices[16 * i + 13] = -place.y;
        matrices[16 * i + 14] = -place.z;
    }
    int accessor = write_floats(w, matrices, count, "MAT4", 16, TARGET_NONE);
    buffer_print(json, "\"skins\":[{\"name\":\"coat\",\"skeleton\":0,\"inverseBindMatrices\":%d,\"joints\":[",
                 accessor);
    for (int i = 0; i < count; i++) {
        buffer_print(json, i ? ",%d" : "%d", i);
    }
    buffer_print(json, "]}],\n");
    free(matrices);
}

/* ---- the shell ---- */

/* A joint that the coat lacks gives its share to the nearest one above. */
static Hold own_hold(const Hold *hold)
{
    Hold own = { { 0 } };
    for (int joint = 0; joint < JOINT_COUNT; joint++) {
        int to = joint;
        while (!has_joint(to)) {
            to = joint_parent(to);
        }
        own.by[to] += hold->by[joint];
    }
    return own;
}

/* The trunk, as far as shoulders and hips, without the neck. */
static int covers(const Cage *surface, const CageFace *face)
{
    for (int i = 0; i < 4; i++) {
        const CageVertex *v = &surface->vertices[face->corner[i]];
        double arms = 0;
        for (int side = 0; side < SIDES; side++) {
            arms += v->hold.by[side_joint(side, UPPER_ARM)] + v->hold.by[side_joint(side, FOREARM)];
        }
        if (v->at.y < 0.86 || v->at.y > 1.33 || arms > 0.4) {
            return 0;
        }
    }
    return paint_material(face->paint) == MATERIAL_CLOTH;
}

static Piece build_shell(void)
{
    Cage surface = body_surface();
    V3 *normals = surface_normals(&surface);
    double *open = ambient_bake(&surface, normals);
    int kept = 0;
    for (int f = 0; f < surface.face_count; f++) {
        if (covers(&surface, &surface.faces[f])) {
            surface.faces[kept] = surface.faces[f];
            surface.faces[kept++].paint = PAINT_COAT;
        }
    }
    surface.face_count = kept;
    for (int i = 0; i < surface.vertex_count; i++) {
        CageVertex *v = &surface.vertices[i];
        v->at = v3_add(v->at, v3_scale(normals[i], OUTWARDS));
        v->hold = own_hold(&v->hold);
    }
    Piece shell = piece_build(&surface, normals, open, MATERIAL_CLOTH);
    for (int i = 0; i < shell.count; i++) {
        for (int h = 0; h < HELD_BY; h++) {
            shell.grip[i].joint[h] = own_number(shell.grip[i].joint[h]);
        }
    }
    free(normals);
    free(open);
    cage_free(&surface);
    return shell;
}

/* ---- the tail ---- */

static void tail_vertex(Piece *tail, int row, int column)
{
    double y = mix(tail_top + 0.03, tail_end, row / (TAIL_ROWS - 1.0)),
           x = TAIL_WIDE * (2.0 * column / (TAIL_COLUMNS - 1) - 1);
    double lower = smooth(tail_joint + 0.08, tail_joint - 0.08, y), upper = smooth(tail_top + 0.03, tail_top - 0.03, y);
    int n = tail->count++, first = own_number(JOINT_COUNT);
    double steps[3] = { 0, 0, 0 };
    steps[2] = (double)(int)(65536 * lower);
    steps[1] = (double)(int)(65536 * upper) - steps[2];
    steps[1] = steps[1] < 0 ? 0 : steps[1];
    steps[0] = 65536 - steps[1] - steps[2];
    tail->position[n] = v3(x, y, -0.178 - 0.03 * (tail_top - y) + 0.25 * x * x);
    tail->normal[n] = v3_unit(v3(0.5 * x, 0, -1));
    tail->colour[n] = paint_colour(PAINT_COAT, tail->position[n], 1);
    tail->texture[2 * n] = column / (TAIL_COLUMNS - 1.0);
    tail->texture[2 * n + 1] = row / (TAIL_ROWS - 1.0);
    for (int h = 0; h < HELD_BY; h++) {
        tail->grip[n].joint[h] = h == 0 ? own_number(HIPS) : h < 3 && steps[h] > 0 ? first + h - 1 : 0;
        tail->grip[n].weight[h] = h < 3 ? steps[h] / 65536 : 0;
    }
}

/* Seen from behind, and again from the front. */
static Piece build_tail(void)
{
    Piece tail = { 0 };
    piece_grab(&tail, 8 * TAIL_ROWS * TAIL_COLUMNS);
    for (int face = 0; face < 2; face++) {
        uint32_t first = (uint32_t)tail.count;
        for (int i = 0; i < TAIL_ROWS * TAIL_COLUMNS; i++) {
            tail_vertex(&tail, i / TAIL_COLUMNS, i % TAIL_COLUMNS);
            if (face) {
                tail.normal[tail.count - 1] = v3_scale(tail.normal[tail.count - 1], -1);
            }
        }
        for (int i = 0; i < TAIL_ROWS * (TAIL_COLUMNS - 1) - (TAIL_COLUMNS - 1); i++) {
            uint32_t a = first + (uint32_t)(i / (TAIL_COLUMNS - 1) * TAIL_COLUMNS + i % (TAIL_COLUMNS - 1));
            uint32_t corners[6] = { a, a + 1, a + TAIL_COLUMNS + 1, a, a + TAIL_COLUMNS + 1, a + TAIL_COLUMNS };
            for (int k = 0; k < 6; k++) {
                tail.indices[tail.index_count++] = corners[face ? 5 - k : k];
            }
        }
    }
    return tail;
}

PuppetCensus coat_write(Buffer *file)
{
    Writer w = { 0 };
    Buffer json = { 0 };
    Piece shell = build_shell(), tail = build_tail();
    PuppetCensus census = { .joints = own_number(JOINT_COUNT) + OWN_JOINTS };
    census.body_vertices = shell.count + tail.count;
    buffer_print(&json, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"noh demo_assets\"},\n");
    write_nodes(&json);
    write_skin(&w, &json);
    buffer_print(&json, "\"materials\":[");
    material_write(&json, 1, "coat", 0.8, 1);
    buffer_print(&json, "],\n\"meshes\":[{\"name\":\"coat\",\"primitives\":[\n");
    piece_write(&w, &json, &shell, 0);
    buffer_print(&json, ",\n");
    piece_write(&w, &json, &tail, 0);
    buffer_print(&json, "]}],\n");
    writer_finish(&w, &json, file);
    buffer_free(&json);
    piece_free(&shell);
    piece_free(&tail);
    return census;
}
