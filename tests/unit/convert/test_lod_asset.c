/* LOD levels of models as people bring them: facets with split normals, hair cards, materials side by side, several
 * meshes (tools/convert/lod/).
 * cross: slow, makes levels */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/lod/lod_levels.h"
#include "convert/model/model_build.h"

#define RINGS 12u
#define SEGMENTS 24u

/* ---- meshes made here ---- */

static model_mesh mesh_new(uint32_t vertices, uint32_t indices, uint32_t submeshes)
{
    model_mesh m = { 0 };
    m.vertex_count = vertices;
    m.index_count = indices;
    m.submesh_count = submeshes;
    m.name = test_zeros(8);
    m.position = test_zeros(vertices * 3u * sizeof(float));
    m.normal = test_zeros(vertices * 3u * sizeof(float));
    m.indices = test_zeros(indices * sizeof(uint32_t));
    m.submeshes = test_zeros(submeshes * sizeof *m.submeshes);
    for (uint32_t i = 0; i < submeshes; i++) {
        m.submeshes[i].material = MODEL_NONE;
    }
    m.submeshes[0].index_count = indices;
    return m;
}

static void mesh_free(model_mesh *m)
{
    free(m->name);
    free(m->position);
    free(m->normal);
    free(m->indices);
    free(m->submeshes);
}

static void sphere_point(uint32_t ring, uint32_t segment, float radius, float *out)
{
    const double a = 3.14159265358979 * ring / RINGS, b = 6.28318530717959 * (segment % SEGMENTS) / SEGMENTS;
    const double around = ring % RINGS ? radius * sin(a) : 0.0; /* one place at each pole */
    out[0] = (float)(around * cos(b));
    out[1] = (float)(radius * cos(a));
    out[2] = (float)(around * sin(b));
}

/* A sphere of triangles that share no vertex: every facet has its own normal. */
static model_mesh faceted_sphere(float radius)
{
    const uint32_t count = 2u * SEGMENTS * (RINGS - 1u);
    model_mesh m = mesh_new(count * 3u, count * 3u, 1);
    uint32_t at = 0;
    for (uint32_t r = 0; r < RINGS; r++) {
        for (uint32_t s = 0; s < SEGMENTS; s++) {
            const uint32_t quad[4][2] = { { r, s }, { r, s + 1u }, { r + 1u, s + 1u }, { r + 1u, s } };
            for (uint32_t half = 0; half < 2u; half++) {
                if ((r == 0 && half == 0) || (r + 1u == RINGS && half == 1)) {
                    continue; /* two corners in one pole */
                }
                for (uint32_t k = 0; k < 3u; k++) {
                    const uint32_t *corner = quad[k == 0 ? 0 : half + (k == 1u ? 1u : 2u)];
                    m.indices[at] = at;
                    sphere_point(corner[0], corner[1], radius, m.position + at * 3u);
                    at++;
                }
            }
        }
    }
    assert_int_equal(at, m.index_count);
    for (uint32_t t = 0; t < at; t += 3u) {
        double a[3], b[3], n[3];
        for (uint32_t k = 0; k < 3u; k++) {
            a[k] = (double)m.position[(t + 1u) * 3u + k] - m.position[t * 3u + k];
            b[k] = (double)m.position[(t + 2u) * 3u + k] - m.position[t * 3u + k];
        }
        vec_cross(a, b, n);
        const double length = sqrt(vec_dot(n, n));
        for (uint32_t k = 0; k < 9u; k++) {
            m.normal[t * 3u + k] = (float)(n[k % 3u] / length);
        }
    }
    return m;
}

static lod *build_ratio(const model_mesh *mesh, float ratio)
{
    model_error error = { "", "" };
    lod_options o = { 0 };
    lod *l = NULL;
    o.level_count = 1;
    o.ratios = &ratio;
    if (lod_build(mesh, &o, &l, &error)) {
        fail_msg("%s", error.what);
    }
    return l;
}

static double area_of(const model_mesh *m, const uint32_t *corner)
{
    double a[3], b[3], n[3];
    for (uint32_t k = 0; k < 3u; k++) {
        a[k] = (double)m->position[corner[1] * 3u + k] - m->position[corner[0] * 3u + k];
        b[k] = (double)m->position[corner[2] * 3u + k] - m->position[corner[0] * 3u + k];
    }
    vec_cross(a, b, n);
    return 0.5 * sqrt(vec_dot(n, n));
}

/* ---- tests ---- */

static void facets_get_levels(void **state)
{
    (void)state;
    model_mesh m = faceted_sphere(0.1f);
    lod *l = build_ratio(&m, 0.25f);
    lod_distance d;
    model_error error;
    assert_true(l->levels[0].index_count <= m.index_count / 4u + 6u);
    assert_int_equal(lod_certify(&m, &l->levels[0], NULL, 0, &d, &error), 0);
    assert_true(d.max < 0.02f); /* of a radius of 0.1; with shared vertices as well as without */
    for (uint32_t i = 0; i < l->levels[0].index_count; i += 3u) { /* facets keep normals that face outwards */
        const uint32_t *c = l->levels[0].indices + i;
        for (uint32_t k = 0; k < 3u; k++) {
            const float *n = m.normal + c[k] * 3u, *p = m.position + c[0] * 3u;
            assert_true(n[0] * p[0] + n[1] * p[1] + n[2] * p[2] > 0.0f);
        }
    }
    lod_free(l);
    mesh_free(&m);
}

#define CARDS 24u
#define ROWS 9u

/* Cards of two columns, bent a little, side by side. */
static model_mesh hair_cards(void)
{
    model_mesh m = mesh_new(CARDS * ROWS * 2u, CARDS * (ROWS - 1u) * 6u, 1);
    uint32_t at = 0;
    for (uint32_t c = 0; c < CARDS; c++) {
        for (uint32_t r = 0; r < ROWS; r++) {
            for (uint32_t side = 0; side < 2u; side++) {
                const uint32_t v = (c * ROWS + r) * 2u + side;
                const float along = (float)r / (ROWS - 1u);
                m.position[v * 3u] = 0.02f * (float)c + 0.012f * (float)side;
                m.position[v * 3u + 1u] = -0.1f * along;
                m.position[v * 3u + 2u] = 0.02f * along * along;
                m.normal[v * 3u + 2u] = 1.0f;
            }
        }
        for (uint32_t r = 0; r + 1u < ROWS; r++) {
            const uint32_t a = (c * ROWS + r) * 2u, quad[6] = { a, a + 2u, a + 3u, a, a + 3u, a + 1u };
            memcpy(m.indices + at, quad, sizeof quad);
            at += 6u;
        }
    }
    return m;
}

static void cards_keep_their_area(void **state)
{
    (void)state;
    model_mesh m = hair_cards();
    lod *l = build_ratio(&m, 0.05f);
    const lod_level *level = &l->levels[0];
    double full[CARDS] = { 0 }, left[CARDS] = { 0 };
    assert_int_equal(l->least, 2u * CARDS);
    assert_true(level->index_count < m.index_count / 3u);
    for (uint32_t i = 0; i < m.index_count; i += 3u) {
        full[m.indices[i] / (2u * ROWS)] += area_of(&m, m.indices + i);
    }
    for (uint32_t i = 0; i < level->index_count; i += 3u) {
        left[level->indices[i] / (2u * ROWS)] += area_of(&m, level->indices + i);
    }
    for (uint32_t c = 0; c < CARDS; c++) {
        assert_true(left[c] >= 0.87 * full[c]);
    }
    lod_free(l);
    mesh_free(&m);
}

/* Two small squares of another material in a flat sheet: its surface stays where it is without them. */
static void materials_keep_their_place(void **state)
{
    (void)state;
    enum { SIDE = 25 };
    model_mesh m = mesh_new(SIDE * SIDE, (SIDE - 1) * (SIDE - 1) * 6u, 2);
    uint32_t at = 0;
    for (uint32_t v = 0; v < SIDE * SIDE; v++) {
        m.position[v * 3u] = 0.01f * (float)(v % SIDE);
        m.position[v * 3u + 1u] = 0.01f * (float)(v / SIDE);
        m.normal[v * 3u + 2u] = 1.0f;
    }
    for (uint32_t pass = 0; pass < 2u; pass++) {
        m.submeshes[pass].first_index = at;
        for (uint32_t q = 0; q < (SIDE - 1) * (SIDE - 1); q++) {
            const uint32_t x = q % (SIDE - 1), y = q / (SIDE - 1), a = y * SIDE + x;
            const uint32_t eye = y >= 10u && y < 13u && ((x >= 4u && x < 7u) || (x >= 17u && x < 20u));
            const uint32_t quad[6] = { a, a + 1u, a + SIDE + 1u, a, a + SIDE + 1u, a + SIDE };
            if (eye == pass) {
                memcpy(m.indices + at, quad, sizeof quad);
                at += 6u;
            }
        }
        m.submeshes[pass].index_count = at - m.submeshes[pass].first_index;
    }
    lod *l = build_ratio(&m, 0.1f);
    lod_distance d[2];
    model_error error;
    assert_true(l->levels[0].index_count <= m.index_count / 10u + 6u);
    assert_int_equal(lod_certify(&m, &l->levels[0], NULL, 0, d, &error), 0);
    assert_true(d[1].max < 0.011f); /* an edge; where one square vanishes, it is 13 */
    lod_free(l);
    mesh_free(&m);
}

static float level_error(const mesh_levels *levels, uint32_t triangles_over)
{
    float least = 1e9f;
    for (uint32_t k = 1; k < levels->count; k++) {
        if (levels->built->levels[levels->which[k]].index_count / 3u > triangles_over) {
            least = levels->errors[k].rest;
        }
    }
    return least;
}

/* A large sphere and a small one of as many triangles: the same share of both would be five times as far off in the
 * large one. */
static void meshes_get_like_errors(void **state)
{
    (void)state;
    const lod_settings settings = { 3, 0, LOD_QUALITY, 0.0f, 0.0f, NULL, 0 };
    model *m = model_new();
    mesh_levels levels[2];
    model_error error = { "", "" };
    uint32_t full, got = 0;
    assert_non_null(m);
    m->meshes = test_zeros(2u * sizeof *m->meshes);
    m->mesh_count = 2;
    m->meshes[0] = faceted_sphere(0.5f);
    m->meshes[1] = faceted_sphere(0.1f);
    full = 2u * m->meshes[0].index_count / 3u;
    memset(levels, 0, sizeof levels);
    if (model_levels_make(m, &settings, levels, &error)) {
        fail_msg("%s", error.what);
    }
    assert_int_equal(levels[0].count, 3);
    assert_true(levels[1].count > 1u);
    for (uint32_t i = 0; i < 2u; i++) {
        got += levels[i].built->levels[0].index_count / 3u;
    }
    assert_true(got <= full / 2u + 2u && got > full / 2u - 24u);
    assert_true(levels[1].built->levels[0].index_count * 2u < levels[0].built->levels[0].index_count);
    assert_true(level_error(&levels[1], 0) < 3.0f * levels[0].errors[2].rest);
    for (uint32_t i = 0; i < 2u; i++) {
        mesh_levels_free(&levels[i]);
        mesh_free(&m->meshes[i]);
    }
    free(m->meshes);
    m->meshes = NULL;
    m->mesh_count = 0;
    model_free(m);
}

/* Levels cut from the list of collapses are those that were built. */
static void cuts_are_the_levels(void **state)
{
    (void)state;
    model_mesh m = faceted_sphere(0.1f);
    const float ratios[2] = { 0.6f, 0.3f };
    model_error error = { "", "" };
    lod_options o = { 0 };
    lod *l = NULL;
    lod_level built[2];
    uint32_t counts[2], *copies[2];
    o.level_count = 2;
    o.ratios = ratios;
    assert_int_equal(lod_build(&m, &o, &l, &error), 0);
    for (uint32_t k = 0; k < 2u; k++) {
        built[k] = l->levels[k];
        counts[k] = built[k].collapse_count;
        copies[k] = test_zeros(built[k].index_count * sizeof(uint32_t));
        memcpy(copies[k], built[k].indices, built[k].index_count * sizeof(uint32_t));
    }
    assert_int_equal(lod_cut(&m, l, counts, 2), 0);
    for (uint32_t k = 0; k < 2u; k++) {
        assert_int_equal(l->levels[k].index_count, built[k].index_count);
        assert_int_equal(l->levels[k].vertex_count, built[k].vertex_count);
        assert_memory_equal(l->levels[k].indices, copies[k], built[k].index_count * sizeof(uint32_t));
        free(copies[k]);
    }
    lod_free(l);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(facets_get_levels),          cmocka_unit_test(cards_keep_their_area),
        cmocka_unit_test(materials_keep_their_place), cmocka_unit_test(meshes_get_like_errors),
        cmocka_unit_test(cuts_are_the_levels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
