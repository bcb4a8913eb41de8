#include "core/base/assert_internal.h"
#include "deform/pick/bounds_internal.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/pack.h"

#include <string.h>

#include "core/base/math_internal.h"

/* The rounding error of a moved vertex is below this share of the largest summed terms: eight products and sums that
 * blend the matrices, four that move the vertex, each within 2^-24. */
#define ROUNDING 4e-6f
/* How far an arc of dual quaternions leaves the hull of the joints' positions of a vertex, as a share of the largest
 * distance between two of these. All of them, and the arc, lie on a sphere about the joints' common centre. By Jung's
 * theorem points at most d apart fit into a ball of radius sqrt(3/8) d = 0.612 d, and the cap of the sphere over them,
 * which contains the arc, is no higher than that radius. The rest is for rounding. */
#define ARC 0.62f

void noh_box_empty(float box[6])
{
    for (int i = 0; i < 6; i++) {
        box[i] = i < 3 ? 3.402823466e38f : -3.402823466e38f;
    }
}

void noh_box_unite(const float a[6], const float b[6], float out[6])
{
    for (int i = 0; i < 3; i++) {
        out[i] = a[i] < b[i] ? a[i] : b[i];
        out[i + 3] = a[i + 3] > b[i + 3] ? a[i + 3] : b[i + 3];
    }
}

/* The box of the sum of weighted differences: interval arithmetic per axis, since each target's difference lies in its
 * box for every vertex. A negative weight swaps the ends of an interval. */
void noh_mesh_target_box(const noh_mesh *mesh, const float *weights, float box[6])
{
    NOH_ASSERT(mesh && box);
    memset(box, 0, 6 * sizeof *box);
    for (uint32_t t = 0; weights && t < mesh->header->target_count; t++) {
        const float *b = mesh->target_boxes + 6u * (size_t)t;
        for (int i = 0; i < 3 && !(weights[t] >= 0.0f && weights[t] <= 0.0f); i++) {
            float low = weights[t] * b[i], high = weights[t] * b[i + 3];
            box[i] += low < high ? low : high;
            box[i + 3] += low < high ? high : low;
        }
    }
    for (int i = 0; i < 3; i++) {
        float slack = ROUNDING * (noh_abs(box[i]) + noh_abs(box[i + 3]));
        box[i] -= slack;
        box[i + 3] += slack;
    }
}

/* The box of a moved box (Arvo, Graphics Gems, 1990): its centre moves as a point, its half size by the absolute values
 * of the matrix, because each axis of the result is largest in the corner where all terms are. */
static void move_box(const float m[12], const float box[6], float out[6])
{
    for (int r = 0; r < 3; r++) {
        float centre = m[4 * r + 3], half = 0.0f, slack = noh_abs(m[4 * r + 3]);
        for (int c = 0; c < 3; c++) {
            float element = m[4 * r + c], middle = 0.5f * (box[c] + box[c + 3]), extent = 0.5f * (box[c + 3] - box[c]);
            centre += element * middle;
            half += noh_abs(element) * extent;
            slack += noh_abs(element) * (noh_abs(middle) + extent);
        }
        half += ROUNDING * slack;
        out[r] = centre - half;
        out[r + 3] = centre + half;
    }
}

static void grow(const float box[6], const float deltas[6], float out[6])
{
    for (int i = 0; i < 6; i++) {
        out[i] = box[i] + deltas[i];
    }
}

void noh_mesh_moved_box(const noh_mesh *mesh, const float *world, const float deltas[6], float box[6])
{
    static const float identity[12] = { 1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f };
    float rest[6];
    NOH_ASSERT(mesh && deltas && box);
    memcpy(rest, mesh->header->bounds_min, 3 * sizeof *rest);
    memcpy(rest + 3, mesh->header->bounds_max, 3 * sizeof *rest);
    grow(rest, deltas, rest);
    move_box(world ? world : identity, rest, box);
}

void noh_mesh_box(const noh_mesh *mesh, const float *world, const float *weights, float box[6])
{
    float deltas[6];
    noh_mesh_target_box(mesh, weights, deltas);
    noh_mesh_moved_box(mesh, world, deltas, box);
}

/* ---- skins ---- */

static uint32_t joint_count(const noh_mesh *mesh)
{
    noh_skin skin = { NULL, NULL, NULL, NULL };
    return noh_pack_skin_at(mesh->pack, mesh->header->skin, &skin, NULL) ? 0 : skin.header->joint_count;
}

/* The intersection of two boxes. Returns 0 if there is none. */
static int meet(const float a[6], const float b[6], float out[6])
{
    for (int i = 0; i < 3; i++) {
        out[i] = a[i] > b[i] ? a[i] : b[i];
        out[i + 3] = a[i + 3] < b[i + 3] ? a[i + 3] : b[i + 3];
        if (out[i] > out[i + 3]) {
            return 0;
        }
    }
    return 1;
}

/* The largest squared distance between a vertex moved by one joint and by another, over a box: the difference of two
 * matrices maps a point to the difference of its images. */
static float distance_apart(const float a[12], const float b[12], const float box[6])
{
    float difference[12], moved[6], square = 0.0f;
    for (int i = 0; i < 12; i++) {
        difference[i] = a[i] - b[i];
    }
    move_box(difference, box, moved);
    for (int r = 0; r < 3; r++) {
        float far = noh_abs(moved[r]) > noh_abs(moved[r + 3]) ? moved[r] : moved[r + 3];
        square += far * far;
    }
    return square;
}

/* How far beyond the joints' boxes dual quaternions may move a vertex. Only joints whose boxes overlap in the bind pose
 * can share a vertex, and only within both boxes. */
static float arc_radius(const noh_mesh *mesh, const float *matrices, const float deltas[6], uint32_t count)
{
    float most = 0.0f;
    for (size_t i = 0; i < count; i++) {
        for (size_t j = i + 1; j < count; j++) {
            float shared[6], square;
            if (meet(mesh->joint_boxes + 6u * i, mesh->joint_boxes + 6u * j, shared)) {
                grow(shared, deltas, shared);
                square = distance_apart(matrices + 12u * i, matrices + 12u * j, shared);
                most = square > most ? square : most;
            }
        }
    }
    return ARC * noh_sqrt(most);
}

/* Growth of all joints' boxes: the targets' differences before they are moved, the arcs afterwards. */
typedef struct growth {
    float deltas[6], radius;
} growth;

static growth growth_of(const noh_mesh *mesh, const float *matrices, const float *weights, uint32_t count)
{
    growth g;
    NOH_ASSERT(matrices || !count);
    noh_mesh_target_box(mesh, weights, g.deltas);
    g.radius = (mesh->header->flags & NOH_MESH_DUAL_QUATERNION) ? arc_radius(mesh, matrices, g.deltas, count) : 0.0f;
    return g;
}

static void joint_box(const noh_mesh *mesh, const float *matrices, const growth *g, size_t joint, float box[6])
{
    const float *rest = mesh->joint_boxes + 6u * joint;
    float grown[6];
    noh_box_empty(box);
    if (!noh_box_is_empty(rest)) {
        grow(rest, g->deltas, grown);
        move_box(matrices + 12u * joint, grown, box);
        for (int i = 0; i < 6; i++) {
            box[i] += i < 3 ? -g->radius : g->radius;
        }
    }
}

void noh_skin_joint_boxes(const noh_mesh *mesh, const float *matrices, const float *weights, float *boxes)
{
    uint32_t count = joint_count(mesh);
    growth g = growth_of(mesh, matrices, weights, count);
    NOH_ASSERT(boxes);
    for (size_t j = 0; j < count; j++) {
        joint_box(mesh, matrices, &g, j, boxes + 6u * j);
    }
}

void noh_skin_box(const noh_mesh *mesh, const float *matrices, const float *weights, float box[6])
{
    uint32_t count = joint_count(mesh);
    growth g = growth_of(mesh, matrices, weights, count);
    noh_box_empty(box);
    for (size_t j = 0; j < count; j++) {
        float one[6];
        joint_box(mesh, matrices, &g, j, one);
        noh_box_unite(box, one, box);
    }
}
