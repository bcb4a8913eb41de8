#include "lod_joints.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "convert/model/vertex_copy.h"

#define OTHERS_MAX 2u      /* joints of the skeleton that a vertex keeps besides its strongest */
#define NORMAL_SHARE 0.02f /* of the box's diagonal: what a normal that is off by 1 counts as */
#define LEAST_WEIGHT 1e-6f

/* How many a skin has room for. */
static uint32_t room_of(const model_skin *skin)
{
    const uint32_t room = skin->joint_count < NOH_SKIN_JOINTS_MAX ? NOH_SKIN_JOINTS_MAX - skin->joint_count : 0;
    return room < LOD_JOINTS_MAX ? room : LOD_JOINTS_MAX;
}

int lod_joints_allowed(const model *m, uint32_t index)
{
    const model_mesh *mesh = &m->meshes[index];
    int allowed = mesh->target_count && mesh->bound && !mesh->dual_quaternion && room_of(&m->skins[mesh->skin]);
    for (uint32_t t = 0; allowed && t < mesh->target_count; t++) allowed = !mesh->targets[t].uv;
    return allowed;
}

/* ---- vertices of their own ---- */

static int is_moved(const model_mesh *mesh, size_t vertex)
{
    for (uint32_t t = 0; t < mesh->target_count; t++) {
        const model_target *target = &mesh->targets[t];
        for (size_t k = 3u * vertex; k < 3u * vertex + 3u; k++) {
            if (target->position[k] != 0.0f || target->normal[k] != 0.0f) return 1;
            if (target->tangent && target->tangent[k] != 0.0f) return 1;
        }
    }
    return 0;
}

static int copy_shared(model_mesh *mesh, uint32_t full_count, lod_level *level)
{
    uint32_t *copy_of = model_zeros(full_count, sizeof *copy_of), *sources = model_zeros(full_count, sizeof *sources);
    const uint32_t before = mesh->vertex_count;
    uint32_t count = 0;
    int failed = !copy_of || !sources;
    for (uint32_t i = 0; !failed && i < level->index_count; i++) {
        const uint32_t v = level->indices[i];
        if (v >= full_count || copy_of[v] || !is_moved(mesh, v)) continue;
        copy_of[v] = before + count;
        sources[count++] = v;
    }
    failed = failed || (count && model_copy_vertices(mesh, sources, count));
    for (uint32_t i = 0; !failed && i < level->index_count; i++) {
        const uint32_t v = level->indices[i];
        if (v < full_count && copy_of[v]) level->indices[i] = copy_of[v];
    }
    free(copy_of);
    free(sources);
    return failed;
}

static int list_vertices(const model_mesh *mesh, uint32_t full_count, lod_level *const *levels, uint32_t count,
                         lod_joints *out)
{
    const uint32_t own = mesh->vertex_count - full_count;
    uint8_t *used = model_zeros(own, 1);
    out->vertices = model_zeros(own, sizeof *out->vertices);
    for (uint32_t k = 0; used && k < count; k++) {
        for (uint32_t i = 0; i < levels[k]->index_count; i++) {
            if (levels[k]->indices[i] >= full_count) used[levels[k]->indices[i] - full_count] = 1;
        }
    }
    for (uint32_t v = 0; used && out->vertices && v < own; v++) {
        if (used[v] && is_moved(mesh, full_count + (size_t)v)) out->vertices[out->vertex_count++] = full_count + v;
    }
    free(used);
    return !used || !out->vertices;
}

/* ---- the fit ---- */

typedef struct point_arrays {
    float *place, *normal, *move, *turn, *share;
    uint16_t *parent;
    uint8_t *slots;
} point_arrays;

static void arrays_free(point_arrays *a)
{
    free(a->place);
    free(a->normal);
    free(a->move);
    free(a->turn);
    free(a->share);
    free(a->parent);
    free(a->slots);
}

static uint32_t others_of(const model_mesh *mesh, uint32_t vertex, float *sum)
{
    const float *weights = mesh->joint_weights + (size_t)vertex * MODEL_INFLUENCES_MAX;
    uint32_t others = 0;
    *sum = weights[0];
    while (others < OTHERS_MAX && weights[others + 1u] > 0.0f) *sum += weights[++others];
    return others;
}

static int fill_points(const model_mesh *mesh, const lod_joints *of, point_arrays *a)
{
    const size_t count = of->vertex_count, targets = mesh->target_count;
    a->place = model_zeros(count, 12u);
    a->normal = model_zeros(count, 12u);
    a->move = model_zeros(count * targets, 12u);
    a->turn = model_zeros(count * targets, 12u);
    a->share = model_zeros(count, sizeof *a->share);
    a->parent = model_zeros(count, sizeof *a->parent);
    a->slots = model_zeros(count, 1);
    if (!a->place || !a->normal || !a->move || !a->turn || !a->share || !a->parent || !a->slots) return 1;
    for (size_t i = 0; i < count; i++) {
        const uint32_t v = of->vertices[i];
        const float *n = mesh->normal + 3u * (size_t)v;
        float sum;
        a->slots[i] = (uint8_t)(JOINTS_PER_VERTEX - others_of(mesh, v, &sum));
        a->share[i] = mesh->joint_weights[(size_t)v * MODEL_INFLUENCES_MAX] / sum;
        a->parent[i] = mesh->joints[(size_t)v * MODEL_INFLUENCES_MAX];
        memcpy(a->place + 3u * i, mesh->position + 3u * (size_t)v, 12u);
        memcpy(a->normal + 3u * i, n, 12u);
        for (size_t t = 0; t < targets; t++) {
            const float *d = mesh->targets[t].normal + 3u * (size_t)v;
            const float along = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
            memcpy(a->move + 3u * (i * targets + t), mesh->targets[t].position + 3u * (size_t)v, 12u);
            for (size_t k = 0; k < 3u; k++) a->turn[3u * (i * targets + t) + k] = d[k] - along * n[k];
        }
    }
    return 0;
}

static float diagonal(const model_mesh *mesh, const lod_joints *of)
{
    float square = 0.0f;
    for (uint32_t k = 0; k < 3u; k++) {
        float low = HUGE_VALF, high = -HUGE_VALF;
        for (uint32_t i = 0; i < of->vertex_count; i++) {
            const float p = mesh->position[3u * (size_t)of->vertices[i] + k];
            low = p < low ? p : low;
            high = p > high ? p : high;
        }
        square += (high - low) * (high - low);
    }
    return sqrtf(square);
}

/* ---- the results ---- */

static int grow_skin(model_skin *skin, const joint_fit *f)
{
    const size_t before = skin->joint_count, count = before + f->joint_count;
    uint32_t *joints = realloc(skin->joints, count * sizeof *joints), *of_skeleton = NULL;
    float *inverse_bind;
    if (!joints) return 1;
    skin->joints = joints;
    of_skeleton = realloc(skin->skeleton_joints, count * sizeof *of_skeleton);
    if (!of_skeleton) return 1;
    skin->skeleton_joints = of_skeleton;
    inverse_bind = realloc(skin->inverse_bind, count * 16u * sizeof *inverse_bind);
    if (!inverse_bind) return 1;
    skin->inverse_bind = inverse_bind;
    for (size_t j = 0; j < f->joint_count; j++) {
        const size_t parent = f->parent[j];
        joints[before + j] = joints[parent];
        of_skeleton[before + j] = of_skeleton[parent];
        memcpy(inverse_bind + 16u * (before + j), inverse_bind + 16u * parent, 16u * sizeof *inverse_bind);
    }
    skin->joint_count = (uint32_t)count;
    return 0;
}

static void put_influence(uint16_t *joints, float *weights, uint32_t *count, uint32_t joint, float weight)
{
    uint32_t at = (*count)++;
    while (at && weights[at - 1u] < weight) {
        weights[at] = weights[at - 1u];
        joints[at] = joints[at - 1u];
        at--;
    }
    weights[at] = weight;
    joints[at] = (uint16_t)joint;
}

/* The virtual joints' weights, then the joints of the skeleton that the vertex keeps. */
static void write_influences(model_mesh *mesh, const lod_joints *of, const point_arrays *a, uint32_t i)
{
    uint16_t *joints = mesh->joints + of->vertices[i] * (size_t)MODEL_INFLUENCES_MAX,
             made[MODEL_INFLUENCES_MAX] = { 0 };
    float *weights = mesh->joint_weights + of->vertices[i] * (size_t)MODEL_INFLUENCES_MAX, sum;
    float by[MODEL_INFLUENCES_MAX] = { 0.0f }, left = a->share[i];
    const uint32_t others = others_of(mesh, of->vertices[i], &sum);
    uint32_t count = 0, taken = 0;
    for (uint32_t k = 1; k <= others; k++) put_influence(made, by, &count, joints[k], weights[k] / sum);
    for (size_t k = 0; k < JOINTS_PER_VERTEX; k++) {
        const size_t at = i * (size_t)JOINTS_PER_VERTEX + k;
        if (!(of->fit.weight[at] > LEAST_WEIGHT)) continue;
        put_influence(made, by, &count, of->first_joint + of->fit.joint[at], of->fit.weight[at]);
        left -= of->fit.weight[at];
        taken++;
    }
    if (taken < a->slots[i] && left > LEAST_WEIGHT) put_influence(made, by, &count, joints[0], left);
    memcpy(joints, made, sizeof made);
    memcpy(weights, by, sizeof by);
    mesh->influence_max = count > mesh->influence_max ? count : mesh->influence_max;
}

/* The angle between a normal as a target has it and as skinning does: with I + [w] in front of positions, normals take
 * its cofactors, which make n + w x n + w (w n) of n. */
static float normal_off(const float *n, const float *delta, const float *w)
{
    const float along = w[0] * n[0] + w[1] * n[1] + w[2] * n[2];
    double both = 0.0, aa = 0.0, bb = 0.0, cosine;
    for (uint32_t k = 0; k < 3u; k++) {
        const uint32_t x = (k + 1u) % 3u, y = (k + 2u) % 3u;
        const double a = (double)(n[k] + delta[k]), b = (double)(n[k] + w[x] * n[y] - w[y] * n[x] + w[k] * along);
        both += a * b;
        aa += a * a;
        bb += b * b;
    }
    cosine = aa > 0.0 && bb > 0.0 ? both / sqrt(aa * bb) : 1.0;
    return (float)acos(cosine < 1.0 ? cosine : 1.0);
}

static int by_size(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* The deltas become what the joints do, and normals are compared with what they were. */
static int write_deltas(model_mesh *mesh, const joint_fit_points *points, lod_joints *of)
{
    const size_t count = (size_t)of->vertex_count * mesh->target_count;
    float *off = model_zeros(count, sizeof *off);
    if (!off) return 1;
    for (uint32_t i = 0; i < of->vertex_count; i++) {
        const size_t v = 3u * (size_t)of->vertices[i];
        for (uint32_t t = 0; t < mesh->target_count; t++) {
            float turn[3];
            joint_fit_motion(points, &of->fit, i, t, mesh->targets[t].position + v, turn);
            off[i * (size_t)mesh->target_count + t] = normal_off(mesh->normal + v, mesh->targets[t].normal + v, turn);
        }
    }
    qsort(off, count, sizeof *off, by_size);
    of->normal_most = off[count - 1u];
    of->normal_p99 = off[count * 99u / 100u];
    free(off);
    return 0;
}

static int fit(model *m, model_mesh *mesh, lod_joints *out)
{
    point_arrays a = { NULL, NULL, NULL, NULL, NULL, NULL, NULL };
    int failed = fill_points(mesh, out, &a);
    const joint_fit_points points = { out->vertex_count,
                                      mesh->target_count,
                                      a.place,
                                      a.normal,
                                      a.move,
                                      a.turn,
                                      a.parent,
                                      a.share,
                                      a.slots,
                                      NORMAL_SHARE * diagonal(mesh, out) };
    failed = failed || joint_fit_make(&points, room_of(&m->skins[mesh->skin]), &out->fit);
    out->first_joint = m->skins[mesh->skin].joint_count;
    failed = failed || grow_skin(&m->skins[mesh->skin], &out->fit) || write_deltas(mesh, &points, out);
    for (uint32_t i = 0; !failed && i < out->vertex_count; i++) write_influences(mesh, out, &a, i);
    mesh->joint_limit = out->first_joint + out->fit.joint_count;
    arrays_free(&a);
    return failed;
}

int lod_joints_make(model *m, uint32_t index, uint32_t full_count, lod_level *const *levels, uint32_t count,
                    lod_joints *out, model_error *error)
{
    model_mesh *mesh = &m->meshes[index];
    int failed = 0;
    memset(out, 0, sizeof *out);
    for (uint32_t k = 0; k < count && !failed; k++) failed = copy_shared(mesh, full_count, levels[k]);
    failed = failed || list_vertices(mesh, full_count, levels, count, out) || (out->vertex_count && fit(m, mesh, out));
    if (failed || !out->vertex_count || !out->fit.joint_count) lod_joints_free(out);
    return failed ? model_fail(error, mesh->name, "out of memory for the virtual joints of LOD levels") : 0;
}

int lod_joints_bake(model_mesh *mesh, lod_joints *joints, model_error *error)
{
    joints->boxes = model_zeros(mesh->target_count, 6u * sizeof *joints->boxes);
    if (!joints->boxes) return model_fail(error, mesh->name, "out of memory for the virtual joints of LOD levels");
    for (uint32_t t = 0; t < mesh->target_count; t++) {
        const model_target *target = &mesh->targets[t];
        float *box = joints->boxes + 6u * (size_t)t;
        for (uint32_t i = 0; i < joints->vertex_count; i++) {
            const size_t v = 3u * (size_t)joints->vertices[i];
            for (uint32_t k = 0; k < 3u; k++) {
                const float d = target->position[v + k];
                box[k] = d < box[k] ? d : box[k];
                box[3u + k] = d > box[3u + k] ? d : box[3u + k];
            }
            memset(target->position + v, 0, 12u);
            memset(target->normal + v, 0, 12u);
            if (target->tangent) memset(target->tangent + v, 0, 12u);
        }
    }
    return 0;
}

void lod_joints_free(lod_joints *joints)
{
    joint_fit_free(&joints->fit);
    free(joints->vertices);
    free(joints->boxes);
    memset(joints, 0, sizeof *joints);
}
