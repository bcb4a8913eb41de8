/* seam_mend.c: gives both sides of a seam the same places, normals, weights and targets. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/affine.h"
#include "convert/model/model_build.h"
#include "seam_internal.h"

/* A share of a vertex. */
typedef struct part {
    int side;
    uint32_t vertex;
    double share;
} part;

/* The sum of several parts, in the world. */
typedef struct blend {
    double position[3], normal[3];
    int is_crease; /* 1: each keeps its own normal */
    node_weight weights[MODEL_INFLUENCES_MAX];
    uint32_t weight_count;
    double *deltas; /* [shared_count][6] of targets that both sides have: how far, and the normal there */
} blend;

typedef struct mender {
    model *m;
    const seam_pair *seam;
    uint32_t *first[2], *next[2]; /* [points], [vertices] the vertices of a point, a chain that MODEL_NONE ends */
    uint32_t *shared[2];          /* [target_count of a side] the place in `deltas`; MODEL_NONE: not shared */
    uint32_t shared_count;
    double *deltas;
} mender;

/* ---- blending ---- */

static int heavier(const void *a, const void *b)
{
    const node_weight *x = a, *y = b;
    if (x->weight != y->weight) return x->weight > y->weight ? -1 : 1;
    return (x->node > y->node) - (x->node < y->node);
}

/* The strongest of all joints of the parts; their weights sum to 1. */
static void blend_weights(const mender *me, const part *parts, uint32_t count, blend *out)
{
    node_weight all[2 * MODEL_INFLUENCES_MAX], own[MODEL_INFLUENCES_MAX];
    uint32_t found = 0;
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t own_count = node_weights_of(me->m, me->seam->side[parts[i].side], parts[i].vertex, own);
        for (uint32_t w = 0; w < own_count; w++) {
            uint32_t at = 0;
            while (at < found && all[at].node != own[w].node) at++;
            if (at == found) all[found++] = (node_weight){ own[w].node, 0.0 };
            all[at].weight += parts[i].share * own[w].weight;
        }
    }
    qsort(all, found, sizeof *all, heavier);
    out->weight_count = 0;
    for (uint32_t i = 0; i < found && i < MODEL_INFLUENCES_MAX; i++) {
        if (!(all[i].weight > 1e-6)) continue;
        sum += all[i].weight;
        out->weights[out->weight_count++] = all[i];
    }
    for (uint32_t i = 0; i < out->weight_count; i++) out->weights[i].weight /= sum;
}

static void blend_targets(const mender *me, const part *p, blend *out)
{
    const border *b = me->seam->side[p->side];
    const model_mesh *mesh = &me->m->meshes[b->mesh];
    for (uint32_t t = 0; t < mesh->target_count; t++) {
        double delta[3], normal[3], *sum;
        if (me->shared[p->side][t] == MODEL_NONE) continue;
        sum = out->deltas + 6 * (size_t)me->shared[p->side][t];
        seam_delta(me->m, b, p->vertex, mesh->targets[t].position, delta);
        seam_normal(me->m, b, p->vertex, mesh->targets[t].normal, normal);
        for (int i = 0; i < 3; i++) {
            sum[i] += p->share * delta[i];
            sum[3 + i] += p->share * normal[i];
        }
    }
}

static void blend_parts(const mender *me, const part *parts, uint32_t count, blend *out)
{
    memset(out, 0, sizeof *out);
    out->deltas = me->deltas;
    memset(out->deltas, 0, me->shared_count * 6u * sizeof *out->deltas);
    for (uint32_t i = 0; i < count; i++) {
        const border *b = me->seam->side[parts[i].side];
        double matrix[16], p[3], normal[3];
        seam_matrix(me->m, b, parts[i].vertex, matrix);
        vec_posed(me->m->meshes[b->mesh].position, NULL, parts[i].vertex, p);
        seam_normal(me->m, b, parts[i].vertex, NULL, normal);
        for (int k = 0; k < 3; k++) {
            out->position[k] += parts[i].share *
                                (matrix[k] * p[0] + matrix[4 + k] * p[1] + matrix[8 + k] * p[2] + matrix[12 + k]);
            out->normal[k] += parts[i].share * normal[k];
        }
        blend_targets(me, &parts[i], out);
    }
    (void)vec_normalize(out->normal);
    blend_weights(me, parts, count, out);
}

/* ---- giving ---- */

/* The inverse bind matrix of a joint that a skin has not yet: it takes vertices to where the other side's skin has
 * them, by the joint of both that is given, or at rest where there is none. */
static int inverse_bind_for(const mender *me, int side, uint32_t node, uint32_t common, float out[16])
{
    const model_skin *own = &me->m->skins[me->m->nodes[me->seam->side[side]->node].skin];
    const model_skin *other = &me->m->skins[me->m->nodes[me->seam->side[1 - side]->node].skin];
    const float *here = NULL, *there = NULL, *wanted = NULL;
    double a[16], b[16], c[16], inverse[16], product[16];
    for (uint32_t j = 0; j < own->joint_count; j++) {
        if (own->joints[j] == common) here = own->inverse_bind + 16 * (size_t)j;
    }
    for (uint32_t j = 0; j < other->joint_count; j++) {
        if (other->joints[j] == common) there = other->inverse_bind + 16 * (size_t)j;
        if (other->joints[j] == node) wanted = other->inverse_bind + 16 * (size_t)j;
    }
    if (here && there && wanted) {
        affine_of_floats(here, a);
        affine_of_floats(there, b);
        affine_of_floats(wanted, c);
        if (memcmp(here, there, 16 * sizeof *here) == 0) {
            memcpy(out, wanted, 16 * sizeof *out); /* to the bit */
            return 0;
        }
        if (affine_invert(b, inverse)) return 1;
        affine_multiply(inverse, a, product);
        affine_multiply(c, product, b);
    } else {
        affine_of_floats(own->inverse_bind, a);
        affine_multiply(me->m->nodes[own->joints[0]].world, a, product);
        if (affine_invert(me->m->nodes[node].world, inverse)) return 1;
        affine_multiply(inverse, product, b);
    }
    for (int i = 0; i < 16; i++) out[i] = (float)b[i];
    return 0;
}

/* The place of a node among a side's joints; it becomes one if it is none. MODEL_NONE: out of memory. */
static uint32_t joint_place(const mender *me, int side, uint32_t node, uint32_t common)
{
    model_skin *skin = &me->m->skins[me->m->nodes[me->seam->side[side]->node].skin];
    uint32_t *joints;
    float *inverse;
    for (uint32_t j = 0; j < skin->joint_count; j++) {
        if (skin->joints[j] == node) return j;
    }
    joints = realloc(skin->joints, ((size_t)skin->joint_count + 1u) * sizeof *joints);
    if (!joints) return MODEL_NONE;
    skin->joints = joints;
    inverse = realloc(skin->inverse_bind, ((size_t)skin->joint_count + 1u) * 16u * sizeof *inverse);
    if (!inverse) return MODEL_NONE;
    skin->inverse_bind = inverse;
    if (inverse_bind_for(me, side, node, common, inverse + 16 * (size_t)skin->joint_count)) return 0;
    joints[skin->joint_count] = node;
    return skin->joint_count++;
}

/* The joint of both skins with the most weight. */
static uint32_t common_joint(const mender *me, const blend *b)
{
    for (uint32_t i = 0; i < b->weight_count; i++) {
        uint32_t skins = 0;
        for (int k = 0; k < 2; k++) {
            const model_skin *skin = &me->m->skins[me->m->nodes[me->seam->side[k]->node].skin];
            for (uint32_t j = 0; j < skin->joint_count; j++)
                skins |= skin->joints[j] == b->weights[i].node ? 1u << k : 0;
        }
        if (skins == 3u) return b->weights[i].node;
    }
    return MODEL_NONE;
}

static int give_weights(const mender *me, int side, uint32_t vertex, const blend *from)
{
    model_mesh *mesh = &me->m->meshes[me->seam->side[side]->mesh];
    const size_t at = (size_t)vertex * MODEL_INFLUENCES_MAX;
    const uint32_t common = common_joint(me, from);
    for (uint32_t i = 0; i < MODEL_INFLUENCES_MAX; i++) {
        const uint32_t joint = i < from->weight_count ? joint_place(me, side, from->weights[i].node, common) : 0;
        if (joint == MODEL_NONE || joint > UINT16_MAX) return 1;
        mesh->joints[at + i] = (uint16_t)joint;
        mesh->joint_weights[at + i] = i < from->weight_count ? (float)from->weights[i].weight : 0.0f;
        if (joint >= mesh->joint_limit) mesh->joint_limit = joint + 1u;
    }
    if (from->weight_count > mesh->influence_max) mesh->influence_max = from->weight_count;
    return 0;
}

/* A unit normal of the world, in the space of a mesh. */
static void into_mesh(const double matrix[16], const double normal[3], double out[3])
{
    const double sign = affine_determinant(matrix) < 0.0 ? -1.0 : 1.0;
    for (int i = 0; i < 3; i++) {
        out[i] = sign * (matrix[4 * i] * normal[0] + matrix[4 * i + 1] * normal[1] + matrix[4 * i + 2] * normal[2]);
    }
    (void)vec_normalize(out);
}

static void give_target(const mender *me, int side, uint32_t vertex, uint32_t t, const double matrix[16],
                        const double inverse[16], const blend *from)
{
    const model_mesh *mesh = &me->m->meshes[me->seam->side[side]->mesh];
    const model_target *target = &mesh->targets[t];
    const size_t at = 3 * (size_t)vertex;
    const double *delta;
    double normal[3];
    if (me->shared[side][t] == MODEL_NONE) {
        memset(target->position + at, 0, 3 * sizeof(float));
        if (target->normal) memset(target->normal + at, 0, 3 * sizeof(float));
        if (target->tangent) memset(target->tangent + at, 0, 3 * sizeof(float));
        return;
    }
    delta = from->deltas + 6 * (size_t)me->shared[side][t];
    into_mesh(matrix, delta + 3, normal);
    for (int i = 0; i < 3; i++) {
        target->position[at + (size_t)i] = (float)(inverse[i] * delta[0] + inverse[4 + i] * delta[1] +
                                                   inverse[8 + i] * delta[2]);
        if (target->normal && !from->is_crease) {
            target->normal[at + (size_t)i] = (float)(normal[i] - (double)mesh->normal[at + (size_t)i]);
        }
    }
}

static void give_normal(model_mesh *mesh, uint32_t vertex, const double matrix[16], const double normal[3])
{
    double n[3], t[3];
    into_mesh(matrix, normal, n);
    for (int i = 0; i < 3; i++) mesh->normal[3 * (size_t)vertex + (size_t)i] = (float)n[i];
    if (mesh->tangent) {
        float *tangent = mesh->tangent + 4 * (size_t)vertex;
        for (int i = 0; i < 3; i++) t[i] = (double)tangent[i];
        vec_reject(t, n);
        if (!vec_normalize(t)) vec_any_perpendicular(n, t);
        for (int i = 0; i < 3; i++) tangent[i] = (float)t[i];
    }
}

static int give(const mender *me, int side, uint32_t vertex, const blend *from)
{
    const border *b = me->seam->side[side];
    model_mesh *mesh = &me->m->meshes[b->mesh];
    double matrix[16], inverse[16];
    if (give_weights(me, side, vertex, from)) return 1;
    seam_matrix(me->m, b, vertex, matrix);
    if (affine_invert(matrix, inverse)) return 0; /* it has no place of its own there */
    for (int i = 0; i < 3; i++) {
        mesh->position[3 * (size_t)vertex + (size_t)i] = (float)(inverse[i] * from->position[0] +
                                                                 inverse[4 + i] * from->position[1] +
                                                                 inverse[8 + i] * from->position[2] + inverse[12 + i]);
    }
    if (!from->is_crease) give_normal(mesh, vertex, matrix, from->normal);
    for (uint32_t i = 0; i < mesh->target_count; i++) give_target(me, side, vertex, i, matrix, inverse, from);
    return 0;
}

static int give_point(const mender *me, int side, uint32_t point, const blend *from)
{
    for (uint32_t v = me->first[side][point]; v != MODEL_NONE; v = me->next[side][v]) {
        if (give(me, side, v, from)) return 1;
    }
    return 0;
}

/* ---- a seam ---- */

/* The vertices of each point. */
static int chain(mender *me, int side, const uint32_t *weld)
{
    const border *b = me->seam->side[side];
    const uint32_t count = me->m->meshes[b->mesh].vertex_count;
    uint32_t *point = model_zeros(count, sizeof *point);
    me->first[side] = model_zeros(b->point_count, sizeof(uint32_t));
    me->next[side] = model_zeros(count, sizeof(uint32_t));
    if (!point || !me->first[side] || !me->next[side]) {
        free(point);
        return 1;
    }
    for (uint32_t p = 0; p < b->point_count; p++) {
        point[b->points[p].vertex] = p + 1u;
        me->first[side][p] = MODEL_NONE;
    }
    for (uint32_t v = count; v-- > 0;) {
        const uint32_t p = point[weld[v]];
        if (!p) continue;
        me->next[side][v] = me->first[side][p - 1u];
        me->first[side][p - 1u] = v;
    }
    free(point);
    return 0;
}

static int share_targets(mender *me)
{
    const model_mesh *a = &me->m->meshes[me->seam->side[0]->mesh], *b = &me->m->meshes[me->seam->side[1]->mesh];
    me->shared[0] = model_zeros(a->target_count, sizeof(uint32_t));
    me->shared[1] = model_zeros(b->target_count, sizeof(uint32_t));
    if (!me->shared[0] || !me->shared[1]) return 1;
    for (uint32_t t = 0; t < b->target_count; t++) me->shared[1][t] = MODEL_NONE;
    for (uint32_t t = 0; t < a->target_count; t++) {
        const uint32_t same = model_find_target(b, a->targets[t].name);
        me->shared[0][t] = MODEL_NONE;
        if (same == MODEL_NONE || me->shared[1][same] != MODEL_NONE) continue;
        me->shared[0][t] = me->shared[1][same] = me->shared_count++;
    }
    me->deltas = model_zeros((size_t)me->shared_count + 1u, 6 * sizeof *me->deltas);
    return !me->deltas;
}

static int mend_points(mender *me)
{
    const seam_pair *s = me->seam;
    blend mean;
    for (uint32_t p = 0; p < s->side[0]->point_count; p++) {
        const uint32_t q = s->mate[0][p];
        if (q == MODEL_NONE) continue;
        const part parts[2] = { { 0, s->side[0]->points[p].vertex, 0.5 }, { 1, s->side[1]->points[q].vertex, 0.5 } };
        blend_parts(me, parts, 2, &mean);
        mean.is_crease = seam_is_crease(&s->side[0]->points[p], &s->side[1]->points[q]);
        if (give_point(me, 0, p, &mean) || give_point(me, 1, q, &mean)) return 1;
    }
    for (int k = 0; k < 2; k++) {
        for (uint32_t p = 0; p < s->side[k]->point_count; p++) {
            const border *across = s->side[1 - k];
            uint32_t edge = 0;
            double t = 0.0;
            if (s->mate[k][p] != MODEL_NONE) continue;
            (void)border_nearest(across, s->side[k]->points[p].position, &edge, &t);
            const part parts[2] = { { 1 - k, across->points[across->edges[edge].from].vertex, 1.0 - t },
                                    { 1 - k, across->points[across->edges[edge].to].vertex, t } };
            blend_parts(me, parts, 2, &mean);
            if (give_point(me, k, p, &mean)) return 1;
        }
    }
    return 0;
}

int seam_mend(model *m, const seam_pair *seam, uint32_t *const weld[2])
{
    mender me;
    int failed;
    memset(&me, 0, sizeof me);
    me.m = m;
    me.seam = seam;
    failed = chain(&me, 0, weld[0]) || chain(&me, 1, weld[1]) || share_targets(&me) || mend_points(&me);
    for (int k = 0; k < 2; k++) {
        free(me.first[k]);
        free(me.next[k]);
        free(me.shared[k]);
    }
    free(me.deltas);
    return failed;
}
