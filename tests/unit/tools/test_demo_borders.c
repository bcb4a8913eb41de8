/* The surfaces of the demo models: no corner of a border lies on another edge of a border without being a corner of it
 * (a T-junction: pixels fall through it), and no two points are all but the same.
 *
 * The files are in $NOH_BUILD, where `make check` makes them. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"

#define NEAR 2e-5 /* metres */

typedef struct edge {
    uint32_t from, to;
} edge;

/* The points and edges where a surface ends. */
typedef struct border {
    const model_mesh *mesh;
    uint32_t *point; /* [vertex_count] */
    uint32_t count;
    edge *edges; /* first all, sorted; then the edges of one triangle alone, [count] */
} border;

static int edge_order(const void *left, const void *right)
{
    const edge *a = left, *b = right;
    if (a->from != b->from) return a->from < b->from ? -1 : 1;
    return (a->to > b->to) - (a->to < b->to);
}

static void border_make(const model_mesh *mesh, border *b)
{
    uint32_t all = 0;
    b->mesh = mesh;
    b->point = calloc(mesh->vertex_count, sizeof *b->point);
    b->edges = calloc(mesh->index_count, sizeof *b->edges);
    assert_true(b->point && b->edges && !weld_vertices(mesh, b->point));
    for (uint32_t i = 0; i < mesh->index_count; ++i) {
        const uint32_t a = b->point[mesh->indices[i]], c = b->point[mesh->indices[i % 3 == 2 ? i - 2 : i + 1]];
        if (a != c) b->edges[all++] = (edge){ a < c ? a : c, a < c ? c : a };
    }
    qsort(b->edges, all, sizeof *b->edges, edge_order);
    b->count = 0;
    for (uint32_t i = 0, next; i < all; i = next) {
        for (next = i + 1; next < all && !edge_order(&b->edges[i], &b->edges[next]); ++next) continue;
        if (next == i + 1) b->edges[b->count++] = b->edges[i];
    }
}

static void border_free(border *b)
{
    free(b->point);
    free(b->edges);
}

/* How far a point is from the inside of an edge; far where its foot is beyond the ends. */
static double distance_to(const border *b, edge e, uint32_t v)
{
    double along[3], from[3], length2, share;
    const float *p = b->mesh->position;
    for (size_t i = 0; i < 3; ++i) {
        along[i] = (double)p[3 * (size_t)e.to + i] - (double)p[3 * (size_t)e.from + i];
        from[i] = (double)p[3 * (size_t)v + i] - (double)p[3 * (size_t)e.from + i];
    }
    length2 = vec_dot(along, along);
    share = length2 > 0.0 ? vec_dot(from, along) / length2 : 0.0;
    if (share <= 0.0 || share >= 1.0) return 1.0;
    for (int i = 0; i < 3; ++i) from[i] -= share * along[i];
    return sqrt(vec_dot(from, from));
}

static uint32_t junctions_of(const border *b)
{
    uint32_t found = 0;
    for (uint32_t i = 0; i < b->count; ++i) {
        for (uint32_t k = 0; k < 2 * b->count; ++k) {
            const uint32_t v = k % 2 ? b->edges[k / 2].to : b->edges[k / 2].from;
            if (v != b->edges[i].from && v != b->edges[i].to) found += distance_to(b, b->edges[i], v) < NEAR;
        }
    }
    return found / 2; /* each point is an end of two edges */
}

/* Points of one border within NEAR of each other, which welding should have made one. */
static uint32_t duplicates_of(const border *b)
{
    uint32_t found = 0;
    for (uint32_t i = 0; i < 2 * b->count; ++i) {
        const uint32_t v = i % 2 ? b->edges[i / 2].to : b->edges[i / 2].from;
        for (uint32_t k = 0; k < i; ++k) {
            const uint32_t w = k % 2 ? b->edges[k / 2].to : b->edges[k / 2].from;
            double d[3];
            for (size_t c = 0; c < 3; ++c) {
                d[c] = (double)b->mesh->position[3 * (size_t)v + c] - (double)b->mesh->position[3 * (size_t)w + c];
            }
            found += v != w && vec_dot(d, d) < NEAR * NEAR;
        }
    }
    return found / 4;
}

/* What the test finds, it finds: a quad whose left edge has a corner more on its other side, and a point not welded. */
static void a_planted_junction_is_found(void **state)
{
    (void)state;
    float position[][3] = { { 0, 0, 0 }, { 1, 0, 0 },    { 0, 1, 0 },     { -1, 0, 0 },
                            { 0, 0, 0 }, { 0, 0.5f, 0 }, { -1, 0.5f, 0 }, { 1, 1e-6f, 0 } };
    uint32_t indices[] = { 0, 1, 2, 3, 4, 5, 3, 5, 6, 7, 6, 2 };
    model_mesh mesh = { .vertex_count = 8, .index_count = 9, .position = position[0], .indices = indices };
    border b;
    border_make(&mesh, &b);
    assert_int_equal(junctions_of(&b), 1);
    assert_int_equal(duplicates_of(&b), 0);
    border_free(&b);
    mesh.index_count = 12; /* with the last triangle */
    border_make(&mesh, &b);
    assert_int_equal(duplicates_of(&b), 1);
    border_free(&b);
}

static void check_model(const char *name)
{
    char path[4096];
    model *m;
    model_error error;
    snprintf(path, sizeof path, "%s/%s", getenv("NOH_BUILD") ? getenv("NOH_BUILD") : "build", name);
    assert_int_equal(model_read_gltf(path, &m, &error), 0);
    for (uint32_t i = 0; i < m->mesh_count; ++i) {
        border b;
        border_make(&m->meshes[i], &b);
        const uint32_t junctions = junctions_of(&b), duplicates = duplicates_of(&b);
        if (junctions || duplicates) {
            fail_msg("%s: mesh '%s' has %u T-junctions and %u points that are all but the same", name,
                     m->meshes[i].name, junctions, duplicates);
        }
        border_free(&b);
    }
    model_free(m);
}

static void mask_puppet_and_arm_have_clean_borders(void **state)
{
    (void)state;
    check_model("mask.glb");
    check_model("demo/puppet.glb");
    check_model("demo/arm.glb");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_planted_junction_is_found),
        cmocka_unit_test(mask_puppet_and_arm_have_clean_borders),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
