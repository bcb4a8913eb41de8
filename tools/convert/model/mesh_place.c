#include "mesh_place.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/affine.h"
#include "convert/model/model_build.h"

#define TILT_MAX 0.94 /* cosine of 20 degrees: hips at rest lean less from the axes of their program */

/* Row r of the turn that leaves right angles alone is sign[r] times the unit vector of axis[r]. */
typedef struct right_turn {
    int axis[3];
    double sign[3];
} right_turn;

/* The turn that is nearest to a matrix's: no two rows have one axis. */
static right_turn turn_of(const double world[16])
{
    static const uint8_t orders[6][3] = {
        { 0, 1, 2 }, { 0, 2, 1 }, { 1, 0, 2 }, { 1, 2, 0 }, { 2, 0, 1 }, { 2, 1, 0 }
    };
    right_turn t = { .axis = { 0, 1, 2 } };
    double most = -1.0;
    for (int i = 0; i < 6; i++) {
        double sum = 0.0;
        for (int r = 0; r < 3; r++) sum += fabs(world[4 * orders[i][r] + r]);
        if (!(sum > most)) continue;
        most = sum;
        for (int r = 0; r < 3; r++) t.axis[r] = orders[i][r];
    }
    for (int r = 0; r < 3; r++) t.sign[r] = world[4 * t.axis[r] + r] < 0.0 ? -1.0 : 1.0;
    return t;
}

static void place_of_joint(const model *m, const model_skin *skin, uint32_t joint, double out[16])
{
    double bind[16];
    affine_of_floats(skin->inverse_bind + 16 * (size_t)joint, bind);
    affine_multiply(m->nodes[skin->joints[joint]].world, bind, out);
}

/* The same of a node that is a joint of the skin, or else of another one. 0: it is no joint. */
static int place_of_node(const model *m, const model_skin *own, uint32_t node, double out[16])
{
    for (uint32_t s = 0; s <= m->skin_count; s++) {
        const model_skin *skin = s ? &m->skins[s - 1u] : own;
        for (uint32_t j = 0; j < skin->joint_count; j++) {
            if (skin->joints[j] != node) continue;
            place_of_joint(m, skin, j, out);
            return 1;
        }
    }
    return 0;
}

/* The turn, without a shift, after which only the right angles of `place` are left. */
static void untilting(const double place[16], double out[16])
{
    const right_turn t = turn_of(place);
    double upright[16], linear[16], back[16];
    affine_identity(upright);
    memcpy(linear, place, sizeof linear);
    for (int r = 0; r < 3; r++) {
        const double row[3] = { place[r], place[4 + r], place[8 + r] };
        for (int c = 0; c < 3; c++) upright[4 * c + r] = c == t.axis[r] ? t.sign[r] * sqrt(vec_dot(row, row)) : 0.0;
        linear[12 + r] = 0.0;
    }
    affine_identity(out);
    if (!affine_invert(linear, back)) affine_multiply(upright, back, out);
}

/* Where a joint is when its ancestors are not tilted. */
static void untilted_joint(const model *m, const model_skin *skin, uint32_t node, double out[3])
{
    const double *at = m->nodes[node].world + 12;
    memset(out, 0, 3 * sizeof *out);
    for (uint32_t p = m->nodes[node].parent; p != MODEL_NONE; p = m->nodes[p].parent) {
        const double *from = m->nodes[p].world + 12, way[3] = { at[0] - from[0], at[1] - from[1], at[2] - from[2] };
        double place[16], turn[16], turned[3];
        if (!place_of_node(m, skin, p, place)) continue;
        untilting(place, turn);
        affine_point(turn, way, turned);
        for (int c = 0; c < 3; c++) out[c] += turned[c];
        at = from;
    }
    for (int c = 0; c < 3; c++) out[c] += at[c];
}

/* About the joint: meshes may have origins of their own. */
static void untilt(const model *m, const model_skin *skin, uint32_t node, double place[16])
{
    double turn[16], turned[16], before[3], after[3];
    untilting(place, turn);
    affine_multiply(turn, place, turned);
    affine_point(turn, m->nodes[node].world + 12, before);
    untilted_joint(m, skin, node, after);
    for (int c = 0; c < 3; c++) turned[12 + c] += after[c] - before[c];
    memcpy(place, turned, sizeof turned);
}

static void place(const model *m, const model_mesh *mesh, const model_node *node, uint32_t vertex, double out[16])
{
    const model_skin *skin = node->skin < m->skin_count && mesh->joints ? &m->skins[node->skin] : NULL;
    const uint32_t joint = skin ? mesh->joints[(size_t)vertex * MODEL_INFLUENCES_MAX] : 0u;
    if (skin && joint < skin->joint_count) {
        place_of_joint(m, skin, joint, out);
        untilt(m, skin, skin->joints[joint], out);
    } else {
        memcpy(out, node->world, sizeof node->world);
    }
}

uint32_t mesh_places(const model *m, uint32_t mesh, uint32_t vertex, double out[MESH_PLACES_MAX][16])
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < m->node_count && count < MESH_PLACES_MAX; i++) {
        if (m->nodes[i].mesh == mesh) place(m, &m->meshes[mesh], &m->nodes[i], vertex, out[count++]);
    }
    if (count == 0) affine_identity(out[count++]);
    return count;
}

/* ---- upright ---- */

/* The skin that all nodes which draw the mesh give it; MODEL_NONE: there is no such skin. */
static uint32_t skin_of(const model *m, uint32_t mesh)
{
    uint32_t skin = MODEL_NONE;
    for (uint32_t i = 0; i < m->node_count; i++) {
        const model_node *node = &m->nodes[i];
        if (node->mesh != mesh) continue;
        if (node->skin >= m->skin_count || (skin != MODEL_NONE && skin != node->skin)) return MODEL_NONE;
        skin = node->skin;
    }
    return m->meshes[mesh].joints ? skin : MODEL_NONE;
}

static int is_shared(const model *m, uint32_t skin)
{
    for (uint32_t i = 0; i < m->node_count; i++) {
        const model_node *node = &m->nodes[i];
        if (node->skin == skin && node->mesh < m->mesh_count && skin_of(m, node->mesh) != skin) return 1;
    }
    return 0;
}

/* Of the ancestors of a skin's first joint that are joints, too, the topmost: parents come first. */
static uint32_t top_of(const model *m, const model_skin *skin)
{
    uint32_t top = MODEL_NONE;
    double place[16];
    for (uint32_t j = 0; j < skin->joint_count; j++) top = skin->joints[j] < top ? skin->joints[j] : top;
    for (uint32_t p = top == MODEL_NONE ? top : m->nodes[top].parent; p != MODEL_NONE; p = m->nodes[p].parent) {
        if (place_of_node(m, skin, p, place)) top = p;
    }
    return top;
}

/* The turn by which the topmost joint of the skeleton places a skin's meshes, so that all skins of a figure take one:
 * other joints turn limbs. 0: it is tilted, or it mirrors. */
static int find_turn(const model *m, const model_skin *skin, right_turn *out)
{
    const uint32_t top = top_of(m, skin);
    double place[16];
    if (top == MODEL_NONE || !place_of_node(m, skin, top, place)) return 0;
    *out = turn_of(place);
    for (int r = 0; r < 3; r++) {
        const double row[3] = { place[r], place[4 + r], place[8 + r] };
        if (!(fabs(row[out->axis[r]]) > TILT_MAX * sqrt(vec_dot(row, row)))) return 0;
    }
    const double sign = out->sign[0] * out->sign[1] * out->sign[2];
    return sign * ((out->axis[1] - out->axis[0] + 3) % 3 == 1 ? 1.0 : -1.0) > 0.0;
}

static void turn_vectors(const right_turn *t, float *vectors, size_t count, size_t stride)
{
    for (size_t i = 0; vectors && i < count; i++, vectors += stride) {
        const float v[3] = { vectors[0], vectors[1], vectors[2] };
        for (int r = 0; r < 3; r++) vectors[r] = (float)t->sign[r] * v[t->axis[r]];
    }
}

static void turn_mesh(const right_turn *t, model_mesh *mesh)
{
    turn_vectors(t, mesh->position, mesh->vertex_count, 3);
    turn_vectors(t, mesh->normal, mesh->vertex_count, 3);
    turn_vectors(t, mesh->tangent, mesh->vertex_count, 4);
    for (uint32_t i = 0; i < mesh->target_count; i++) {
        turn_vectors(t, mesh->targets[i].position, mesh->vertex_count, 3);
        turn_vectors(t, mesh->targets[i].normal, mesh->vertex_count, 3);
        turn_vectors(t, mesh->targets[i].tangent, mesh->vertex_count, 3);
    }
}

/* A matrix of what the turn has turned. */
static void turn_back(const right_turn *t, float matrix[16])
{
    float before[16];
    memcpy(before, matrix, sizeof before);
    for (int r = 0; r < 3; r++) {
        for (int i = 0; i < 4; i++) matrix[4 * r + i] = (float)t->sign[r] * before[4 * t->axis[r] + i];
    }
}

static int is_upright(const right_turn *t)
{
    return t->axis[0] == 0 && t->axis[1] == 1 && t->sign[0] > 0.0 && t->sign[1] > 0.0;
}

int meshes_upright(model *m)
{
    static const right_turn none = { { 0, 1, 2 }, { 1.0, 1.0, 1.0 } };
    right_turn *turns = model_zeros(m->skin_count, sizeof *turns);
    if (!turns) return 1;
    for (uint32_t s = 0; s < m->skin_count; s++) { /* all before any: skins look at each other's joints */
        if (is_shared(m, s) || !find_turn(m, &m->skins[s], &turns[s])) turns[s] = none;
    }
    for (uint32_t s = 0; s < m->skin_count; s++) {
        const right_turn *t = &turns[s];
        if (is_upright(t)) continue;
        for (uint32_t i = 0; i < m->mesh_count; i++) {
            if (skin_of(m, i) == s) turn_mesh(t, &m->meshes[i]);
        }
        for (uint32_t j = 0; j < m->skins[s].joint_count; j++) turn_back(t, m->skins[s].inverse_bind + 16 * (size_t)j);
    }
    free(turns);
    return 0;
}
