#include "joint_points.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"

#define AXES 6u
#define DIRECTIONS 14u
#define KINDS (AXES + 1u) /* of a joint: its distance, and along its axes */
#define NO_VERTEX UINT32_MAX

static const float directions[DIRECTIONS][3] = { { 1, 0, 0 },   { -1, 0, 0 },  { 0, 1, 0 },  { 0, -1, 0 },
                                                 { 0, 0, 1 },   { 0, 0, -1 },  { 1, 1, 1 },  { 1, 1, -1 },
                                                 { 1, -1, 1 },  { 1, -1, -1 }, { -1, 1, 1 }, { -1, 1, -1 },
                                                 { -1, -1, 1 }, { -1, -1, -1 } };

typedef struct vertex {
    const model_mesh *mesh;
    uint32_t index;
    float way; /* squared distance to the nearest chosen vertex; 0: this one, or one at the same place, is chosen */
} vertex;

typedef struct extreme {
    float score;
    uint32_t vertex;
} extreme;

typedef struct chooser {
    const model *m;
    vertex *vertices;
    uint32_t vertex_count, joint_count;
    extreme *joints; /* [joint_count][KINDS] */
    extreme box[DIRECTIONS];
    uint32_t *chosen;
    uint32_t count, limit, hold_count;
} chooser;

static const float *position(const vertex *v)
{
    return v->mesh->position + 3u * (size_t)v->index;
}

/* ---- candidates ---- */

static int is_of(const model *m, const model_mesh *mesh, uint32_t set)
{
    return mesh->bound && mesh->joints && m->skins[mesh->skin].skeleton_joints && m->skins[mesh->skin].set == set;
}

static void list_vertices(chooser *c, uint32_t set)
{
    for (uint32_t i = 0; i < c->m->mesh_count; i++) {
        const model_mesh *mesh = &c->m->meshes[i];
        for (uint32_t v = 0; v < mesh->vertex_count && is_of(c->m, mesh, set); v++) {
            const vertex one = { mesh, v, FLT_MAX };
            c->vertices[c->vertex_count++] = one;
        }
    }
}

static uint32_t count_vertices(const model *m, uint32_t set)
{
    uint32_t count = 0;
    for (uint32_t i = 0; m && i < m->mesh_count; i++) {
        count += is_of(m, &m->meshes[i], set) ? m->meshes[i].vertex_count : 0;
    }
    return count;
}

static noh_time_hold hold_of(const model *m, const vertex *v, uint32_t k)
{
    const model_skin *skin = &m->skins[v->mesh->skin];
    const size_t at = (size_t)v->index * MODEL_INFLUENCES_MAX + k;
    const float *bind = skin->inverse_bind + 16u * (size_t)v->mesh->joints[at], *p = position(v);
    noh_time_hold h = { 0, v->mesh->joint_weights[at], { 0.0f, 0.0f, 0.0f } };
    if (h.weight > 0.0f) {
        h.joint = skin->skeleton_joints[v->mesh->joints[at]];
        for (int r = 0; r < 3; r++) {
            h.place[r] = bind[r] * p[0] + bind[4 + r] * p[1] + bind[8 + r] * p[2] + bind[12 + r];
        }
    }
    return h;
}

/* ---- extremes ---- */

static float along(const float *direction, const float *p)
{
    return direction[0] * p[0] + direction[1] * p[1] + direction[2] * p[2];
}

static void note(extreme *e, float score, uint32_t v)
{
    if (e->vertex == NO_VERTEX || score > e->score) {
        e->score = score;
        e->vertex = v;
    }
}

static void note_vertex(chooser *c, uint32_t v)
{
    for (uint32_t d = 0; d < DIRECTIONS; d++) {
        note(&c->box[d], along(directions[d], position(&c->vertices[v])), v);
    }
    for (uint32_t k = 0; k < MODEL_INFLUENCES_MAX; k++) {
        const noh_time_hold h = hold_of(c->m, &c->vertices[v], k);
        extreme *of = c->joints + KINDS * (size_t)h.joint;
        if (h.weight <= 0.0f) {
            break; /* zeros are last */
        }
        c->hold_count = k + 1u > c->hold_count ? k + 1u : c->hold_count;
        note(&of[0], h.weight * h.weight * along(h.place, h.place), v);
        for (uint32_t d = 0; d < AXES; d++) {
            note(&of[1u + d], h.weight * along(directions[d], h.place), v);
        }
    }
}

/* ---- choosing ---- */

static void choose(chooser *c, uint32_t v)
{
    const float *p;
    if (v == NO_VERTEX || c->vertices[v].way <= 0.0f || c->count == c->limit) {
        return;
    }
    c->chosen[c->count++] = v;
    p = position(&c->vertices[v]);
    for (uint32_t i = 0; i < c->vertex_count; i++) {
        const float *q = position(&c->vertices[i]), way[3] = { q[0] - p[0], q[1] - p[1], q[2] - p[2] };
        const float square = along(way, way);
        c->vertices[i].way = square < c->vertices[i].way ? square : c->vertices[i].way;
    }
}

static void choose_all(chooser *c)
{
    uint32_t before;
    for (uint32_t v = 0; v < c->vertex_count; v++) {
        note_vertex(c, v);
    }
    for (uint32_t j = 0; j < c->joint_count; j++) {
        choose(c, c->joints[KINDS * (size_t)j].vertex);
    }
    for (uint32_t d = 0; d < DIRECTIONS; d++) {
        choose(c, c->box[d].vertex);
    }
    for (uint32_t i = 0; i < KINDS * c->joint_count; i++) {
        choose(c, c->joints[i].vertex);
    }
    do {
        uint32_t farthest = 0;
        for (uint32_t v = 1; v < c->vertex_count; v++) {
            farthest = c->vertices[v].way > c->vertices[farthest].way ? v : farthest;
        }
        before = c->count;
        choose(c, farthest);
    } while (c->count > before);
}

static void fill_points(const chooser *c, joint_points *out)
{
    for (uint32_t i = 0; i < c->count; i++) {
        for (uint32_t k = 0; k < c->hold_count; k++) {
            out->holds[(size_t)i * c->hold_count + k] = hold_of(c->m, &c->vertices[c->chosen[i]], k);
        }
    }
    out->points.holds = out->holds;
    out->points.point_count = c->count;
    out->points.holds_per_point = c->hold_count;
}

static int open_chooser(chooser *c, const model *m, uint32_t set, uint32_t joint_count, uint32_t vertex_count)
{
    memset(c, 0, sizeof *c);
    c->m = m;
    c->joint_count = joint_count;
    c->limit = JOINT_POINTS + joint_count;
    c->vertices = malloc(vertex_count * sizeof *c->vertices);
    c->joints = malloc((size_t)joint_count * KINDS * sizeof *c->joints);
    c->chosen = malloc(c->limit * sizeof *c->chosen);
    if (!c->vertices || !c->joints || !c->chosen) {
        return 1;
    }
    list_vertices(c, set);
    for (uint32_t i = 0; i < KINDS * joint_count; i++) {
        c->joints[i].vertex = NO_VERTEX;
    }
    for (uint32_t d = 0; d < DIRECTIONS; d++) {
        c->box[d].vertex = NO_VERTEX;
    }
    return 0;
}

int joint_points_choose(const model *m, uint32_t set, uint32_t joint_count, joint_points *out)
{
    const uint32_t vertex_count = joint_count ? count_vertices(m, set) : 0;
    chooser c;
    int failed;
    memset(out, 0, sizeof *out);
    if (!vertex_count) {
        return 0;
    }
    failed = open_chooser(&c, m, set, joint_count, vertex_count);
    if (!failed) {
        choose_all(&c);
        out->holds = model_zeros((size_t)c.count * c.hold_count, sizeof *out->holds);
        failed = !out->holds;
    }
    if (!failed) {
        fill_points(&c, out);
    }
    free(c.vertices);
    free(c.joints);
    free(c.chosen);
    return failed;
}

void joint_points_free(joint_points *p)
{
    free(p->holds);
}
