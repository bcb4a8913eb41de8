#include "seam_border.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/affine.h"
#include "convert/model/islands.h"
#include "convert/model/model_build.h"

void skin_rest_matrix(const model *m, const model_skin *skin, const uint16_t *joints, const float *weights,
                      double out[16])
{
    memset(out, 0, 16 * sizeof *out);
    for (uint32_t i = 0; i < MODEL_INFLUENCES_MAX && weights[i] > 0.0f; i++) {
        double inverse[16], product[16];
        affine_of_floats(skin->inverse_bind + 16 * (size_t)joints[i], inverse);
        affine_multiply(m->nodes[skin->joints[joints[i]]].world, inverse, product);
        for (int k = 0; k < 16; k++) out[k] += (double)weights[i] * product[k];
    }
}

/* ---- edges ---- */

typedef struct edge_slot {
    uint32_t a, b;        /* welded, a < b; a == b: free */
    uint32_t from, count; /* from: the corner at which the edge began, when it was found first */
} edge_slot;

typedef struct edge_table {
    edge_slot *slots;
    size_t mask;
} edge_table;

static edge_slot *slot_of(const edge_table *t, uint32_t a, uint32_t b)
{
    size_t at = (((size_t)a * 0x9e3779b1u) ^ ((size_t)b * 0x85ebca6bu)) & t->mask;
    while (t->slots[at].a != t->slots[at].b && (t->slots[at].a != a || t->slots[at].b != b)) at = (at + 1) & t->mask;
    return &t->slots[at];
}

static uint32_t next_corner(uint32_t corner)
{
    return corner % 3u == 2u ? corner - 2u : corner + 1u;
}

static int edges_find(const model_mesh *mesh, const uint32_t *weld, edge_table *t)
{
    size_t slots = 16;
    while (slots < (size_t)mesh->index_count * 2) slots *= 2;
    t->mask = slots - 1;
    t->slots = model_zeros(slots, sizeof *t->slots);
    if (!t->slots) return 1;
    for (uint32_t c = 0; c < mesh->index_count; c++) {
        const uint32_t a = weld[mesh->indices[c]], b = weld[mesh->indices[next_corner(c)]];
        edge_slot *slot;
        if (a == b) continue;
        slot = slot_of(t, a < b ? a : b, a < b ? b : a);
        if (!slot->count++) slot->a = a < b ? a : b, slot->b = a < b ? b : a, slot->from = c;
    }
    return 0;
}

/* ---- borders ---- */

typedef struct finder {
    const model *m;
    const model_mesh *mesh;
    uint32_t mesh_index, node;
    const uint32_t *weld;
    edge_table table;
    uint32_t *parent;         /* [vertex_count] of a union-find over welded vertices */
    uint32_t *point, *border; /* [vertex_count] the place of a welded vertex among its border's points; of a root: its
                               * border */
} finder;

static void world_of(const finder *f, uint32_t vertex, double out[3])
{
    const size_t at = (size_t)vertex * MODEL_INFLUENCES_MAX;
    const float *p = f->mesh->position + 3 * (size_t)vertex;
    double matrix[16];
    skin_rest_matrix(f->m, &f->m->skins[f->m->nodes[f->node].skin], f->mesh->joints + at, f->mesh->joint_weights + at,
                     matrix);
    for (int i = 0; i < 3; i++) {
        out[i] = matrix[i] * (double)p[0] + matrix[4 + i] * (double)p[1] + matrix[8 + i] * (double)p[2] +
                 matrix[12 + i];
    }
}

static uint32_t add_point(finder *f, border *b, uint32_t vertex)
{
    if (f->point[vertex] == MODEL_NONE) {
        border_point *p = &b->points[b->point_count];
        p->vertex = vertex;
        world_of(f, vertex, p->position);
        for (int i = 0; i < 3; i++) {
            if (!b->point_count || p->position[i] < b->low[i]) b->low[i] = p->position[i];
            if (!b->point_count || p->position[i] > b->high[i]) b->high[i] = p->position[i];
        }
        f->point[vertex] = b->point_count++;
    }
    return f->point[vertex];
}

static void add_edge(finder *f, border *b, const edge_slot *slot)
{
    border_edge *e = &b->edges[b->edge_count++];
    const uint32_t to = next_corner(slot->from), third = next_corner(to);
    double along[3], apex[3];
    e->from = add_point(f, b, f->weld[f->mesh->indices[slot->from]]);
    e->to = add_point(f, b, f->weld[f->mesh->indices[to]]);
    world_of(f, f->mesh->indices[third], apex);
    for (int i = 0; i < 3; i++) {
        along[i] = b->points[e->to].position[i] - b->points[e->from].position[i];
        e->inward[i] = apex[i] - b->points[e->from].position[i];
    }
    if (vec_normalize(along)) vec_reject(e->inward, along);
    if (!vec_normalize(e->inward)) memset(e->inward, 0, sizeof e->inward);
    for (int i = 0; i < 3; i++) {
        b->points[e->from].inward[i] += e->inward[i] / 2.0;
        b->points[e->to].inward[i] += e->inward[i] / 2.0;
    }
}

static int is_border(const edge_slot *slot)
{
    return slot->a != slot->b && slot->count == 1;
}

/* Count the edges of each border, and make room for borders of three or more. */
static int make_room(finder *f, border_list *out)
{
    for (size_t i = 0; i <= f->table.mask; i++) {
        const edge_slot *slot = &f->table.slots[i];
        if (!is_border(slot)) continue;
        const uint32_t a = islands_root(f->parent, slot->a), b = islands_root(f->parent, slot->b);
        f->parent[a > b ? a : b] = a > b ? b : a;
    }
    for (size_t i = 0; i <= f->table.mask; i++) { /* point holds the count until the borders are there */
        if (is_border(&f->table.slots[i])) f->point[islands_root(f->parent, f->table.slots[i].a)]++;
    }
    for (uint32_t v = 0; v < f->mesh->vertex_count; v++) {
        border *grown, *b;
        const uint32_t edges = f->point[v];
        f->point[v] = MODEL_NONE;
        if (edges < 3) continue;
        grown = realloc(out->all, ((size_t)out->count + 1u) * sizeof *grown);
        if (!grown) return 1;
        out->all = grown;
        b = memset(&grown[out->count++], 0, sizeof *b);
        b->mesh = f->mesh_index;
        b->node = f->node;
        b->points = model_zeros((size_t)edges * 2u, sizeof *b->points);
        b->edges = model_zeros(edges, sizeof *b->edges);
        if (!b->points || !b->edges) return 1;
        f->border[v] = out->count; /* one more than its place */
    }
    return 0;
}

/* Points at which hard edges end. */
static void mark_hard(const finder *f, border_list *out)
{
    for (uint32_t v = 0; v < f->mesh->vertex_count; v++) {
        const uint32_t point = f->point[f->weld[v]], at = f->border[islands_root(f->parent, f->weld[v])];
        double own[3], first[3];
        if (!at || point == MODEL_NONE) continue;
        vec_posed(f->mesh->normal, NULL, v, own);
        vec_posed(f->mesh->normal, NULL, f->weld[v], first);
        if (vec_dot(own, first) < 0.5) out->all[at - 1u].points[point].is_hard = 1;
    }
}

static int find_in_mesh(finder *f, border_list *out)
{
    const uint32_t first = out->count;
    if (edges_find(f->mesh, f->weld, &f->table) || make_room(f, out)) return 1;
    for (uint32_t c = 0; c < f->mesh->index_count; c++) { /* in the file's order, whatever the table's is */
        const uint32_t a = f->weld[f->mesh->indices[c]], b = f->weld[f->mesh->indices[next_corner(c)]];
        const edge_slot *slot = a == b ? NULL : slot_of(&f->table, a < b ? a : b, a < b ? b : a);
        if (!slot || !is_border(slot)) continue;
        const uint32_t at = f->border[islands_root(f->parent, slot->a)];
        if (at) add_edge(f, &out->all[at - 1u], slot);
    }
    mark_hard(f, out);
    for (uint32_t i = first; i < out->count; i++) {
        double square = 0.0;
        border *b = &out->all[i];
        for (int k = 0; k < 3; k++) square += (b->high[k] - b->low[k]) * (b->high[k] - b->low[k]);
        b->size = sqrt(square);
    }
    return 0;
}

static int add_mesh(const model *m, uint32_t node, border_list *out)
{
    finder f;
    int failed;
    memset(&f, 0, sizeof f);
    f.m = m;
    f.node = node;
    f.mesh_index = m->nodes[node].mesh;
    f.mesh = &m->meshes[f.mesh_index];
    const uint32_t count = f.mesh->vertex_count;
    out->weld[f.mesh_index] = model_zeros(count, sizeof(uint32_t));
    f.weld = out->weld[f.mesh_index];
    f.parent = model_zeros(count, sizeof *f.parent);
    f.point = model_zeros(count, sizeof *f.point);
    f.border = model_zeros(count, sizeof *f.border);
    failed = !f.weld || !f.parent || !f.point || !f.border || weld_vertices(f.mesh, out->weld[f.mesh_index]);
    for (uint32_t v = 0; !failed && v < count; v++) f.parent[v] = v;
    failed = failed || find_in_mesh(&f, out);
    free(f.table.slots);
    free(f.parent);
    free(f.point);
    free(f.border);
    return failed;
}

int borders_find(const model *m, border_list *out)
{
    memset(out, 0, sizeof *out);
    out->weld = model_zeros(m->mesh_count, sizeof *out->weld);
    if (!out->weld) return 1;
    out->mesh_count = m->mesh_count;
    for (uint32_t n = 0; n < m->node_count; n++) {
        const model_node *node = &m->nodes[n];
        if (node->mesh == MODEL_NONE || node->skin == MODEL_NONE || out->weld[node->mesh] ||
            !m->meshes[node->mesh].joints) {
            continue;
        }
        if (add_mesh(m, n, out)) return 1;
    }
    return 0;
}

void borders_free(border_list *list)
{
    for (uint32_t i = 0; i < list->count; i++) {
        free(list->all[i].points);
        free(list->all[i].edges);
    }
    for (uint32_t i = 0; list->weld && i < list->mesh_count; i++) free(list->weld[i]);
    free(list->all);
    free(list->weld);
    memset(list, 0, sizeof *list);
}
