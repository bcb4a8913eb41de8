/* Simplification that keeps targets (tools/convert/lod/), on sheets made here. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/lod/lod.h"
#include "convert/lod/lod_frames.h"
#include "convert/model/model_build.h"

/* ---- sheets ---- */

/* side x side vertices, 1 cm apart, in one submesh, or in two that meet at half the width, each with vertices of its
 * own there. */
typedef struct sheet {
    model_mesh mesh;
    uint32_t side;
} sheet;

static uint32_t vertex_at(const sheet *s, uint32_t x, uint32_t y)
{
    return y * s->side + x;
}

static void place(sheet *s, uint32_t v, uint32_t x, uint32_t y)
{
    float *p = s->mesh.position + v * 3u;
    p[0] = 0.01f * (float)x;
    p[1] = 0.01f * (float)y;
    s->mesh.normal[v * 3u + 2u] = 1.0f;
    s->mesh.uv[v * 2u] = (float)x / (float)s->side;
    s->mesh.uv[v * 2u + 1u] = (float)y / (float)s->side;
}

/* The vertex that a submesh uses: the second one has its own along the border. */
static uint32_t used_vertex(const sheet *s, uint32_t submesh, uint32_t x, uint32_t y)
{
    return submesh == 1u && x == s->side / 2u ? s->side * s->side + y : vertex_at(s, x, y);
}

static void fill_submesh(sheet *s, uint32_t index, uint32_t first_x, uint32_t last_x)
{
    model_submesh *sub = &s->mesh.submeshes[index];
    sub->first_index = s->mesh.index_count;
    sub->material = MODEL_NONE;
    for (uint32_t y = 0; y + 1u < s->side; y++) {
        for (uint32_t x = first_x; x < last_x; x++) {
            uint32_t a = used_vertex(s, index, x, y), b = used_vertex(s, index, x + 1u, y),
                     c = used_vertex(s, index, x, y + 1u);
            uint32_t d = used_vertex(s, index, x + 1u, y + 1u), *to = s->mesh.indices + s->mesh.index_count;
            to[0] = a;
            to[1] = b;
            to[2] = d;
            to[3] = a;
            to[4] = d;
            to[5] = c;
            s->mesh.index_count += 6u;
        }
    }
    sub->index_count = s->mesh.index_count - sub->first_index;
}

static sheet sheet_new(uint32_t side, uint32_t submeshes, uint32_t targets)
{
    sheet s = { { 0 }, side };
    uint32_t vertices = side * side + (submeshes > 1u ? side : 0u);
    s.mesh.vertex_count = vertices;
    s.mesh.submesh_count = submeshes;
    s.mesh.target_count = targets;
    s.mesh.position = test_zeros(vertices * 3u * sizeof(float));
    s.mesh.normal = test_zeros(vertices * 3u * sizeof(float));
    s.mesh.uv = test_zeros(vertices * 2u * sizeof(float));
    s.mesh.indices = test_zeros((side - 1u) * (side - 1u) * 6u * sizeof(uint32_t));
    s.mesh.submeshes = test_zeros(submeshes * sizeof *s.mesh.submeshes);
    s.mesh.targets = test_zeros((targets + 1u) * sizeof *s.mesh.targets);
    for (uint32_t t = 0; t < targets; t++) {
        s.mesh.targets[t].position = test_zeros(vertices * 3u * sizeof(float));
    }
    for (uint32_t v = 0; v < side * side; v++) {
        place(&s, v, v % side, v / side);
    }
    for (uint32_t y = 0; submeshes > 1u && y < side; y++) {
        place(&s, side * side + y, side / 2u, y);
    }
    fill_submesh(&s, 0, 0, submeshes > 1u ? side / 2u : side - 1u);
    if (submeshes > 1u) {
        fill_submesh(&s, 1, side / 2u, side - 1u);
    }
    return s;
}

/* Move a target's vertices near a place along z: the whole bump at its centre, nothing from `radius` on. */
static void bump(sheet *s, uint32_t target, float x, float y, float radius, float height)
{
    for (uint32_t v = 0; v < s->mesh.vertex_count; v++) {
        const float *p = s->mesh.position + v * 3u;
        float d = ((p[0] - x) * (p[0] - x) + (p[1] - y) * (p[1] - y)) / (radius * radius);
        s->mesh.targets[target].position[v * 3u + 2u] = d < 1.0f ? height * (1.0f - d) * (1.0f - d) : 0.0f;
    }
}

static void wrinkle(sheet *s, uint32_t seed)
{
    test_random r = test_random_from(seed);
    for (uint32_t v = 0; v < s->side * s->side; v++) {
        s->mesh.position[v * 3u + 2u] = test_random_float(&r, 0.0f, 0.004f);
    }
    for (uint32_t v = s->side * s->side; v < s->mesh.vertex_count; v++) {
        memcpy(s->mesh.position + v * 3u, s->mesh.position + vertex_at(s, s->side / 2u, v - s->side * s->side) * 3u,
               3u * sizeof(float));
    }
}

static void sheet_free(sheet *s)
{
    for (uint32_t t = 0; t < s->mesh.target_count; t++) {
        free(s->mesh.targets[t].position);
    }
    free(s->mesh.targets);
    free(s->mesh.submeshes);
    free(s->mesh.indices);
    free(s->mesh.uv);
    free(s->mesh.normal);
    free(s->mesh.position);
    free(s->mesh.color);
}

static lod *build(const model_mesh *mesh, const lod_options *o)
{
    model_error error = { "", "" };
    lod *l = NULL;
    if (lod_build(mesh, o, &l, &error)) {
        fail_msg("%s", error.what);
    }
    assert_non_null(l);
    return l;
}

static lod *build_to(const model_mesh *mesh, lod_mode mode, float ratio)
{
    lod_options o = { 0 };
    o.mode = mode;
    o.level_count = 1;
    o.ratios = &ratio;
    return build(mesh, &o);
}

/* Vertices used within a distance of a place. */
static uint32_t used_near(const model_mesh *mesh, const lod_level *level, float x, float y, float radius)
{
    uint8_t *seen = test_zeros(mesh->vertex_count);
    uint32_t count = 0;
    for (uint32_t i = 0; i < level->index_count; i++) {
        uint32_t v = level->indices[i];
        float dx = mesh->position[v * 3u] - x, dy = mesh->position[v * 3u + 1u] - y;
        count += !seen[v] && dx * dx + dy * dy < radius * radius;
        seen[v] = 1;
    }
    free(seen);
    return count;
}

static double doubled_area(const float *data, uint32_t width, const uint32_t *corner)
{
    const float *a = data + corner[0] * width, *b = data + corner[1] * width, *c = data + corner[2] * width;
    return ((double)b[0] - a[0]) * ((double)c[1] - a[1]) - ((double)b[1] - a[1]) * ((double)c[0] - a[0]);
}

/* ---- what is kept ---- */

static void flat_collapses_for_nothing(void **state)
{
    (void)state;
    for (lod_mode mode = LOD_QUALITY; mode <= LOD_FAST; mode++) {
        sheet s = sheet_new(17, 1, 0);
        lod *l = build_to(&s.mesh, mode, 0.05f);
        lod_distance d;
        model_error error;
        assert_true(l->levels[0].index_count / 3u <= 26u);
        assert_true(l->levels[0].cost < 1e-6f);
        assert_int_equal(lod_certify(&s.mesh, &l->levels[0], NULL, 0, &d, &error), 0);
        assert_true(d.max < 1e-6f);
        lod_free(l);
        sheet_free(&s);
    }
}

static void bump_of_a_target_stays(void **state)
{
    (void)state;
    for (lod_mode mode = LOD_QUALITY; mode <= LOD_FAST; mode++) {
        sheet s = sheet_new(25, 1, 1);
        bump(&s, 0, 0.06f, 0.06f, 0.05f, 0.02f);
        lod *l = build_to(&s.mesh, mode, 0.1f);
        lod_distance d[2];
        model_error error;
        /* flat at rest: without the target nothing would tell the bump's corner from the one across */
        assert_true(used_near(&s.mesh, &l->levels[0], 0.06f, 0.06f, 0.05f) > 20u);
        assert_true(used_near(&s.mesh, &l->levels[0], 0.18f, 0.18f, 0.05f) < 6u);
        assert_int_equal(lod_certify(&s.mesh, &l->levels[0], NULL, 0, d, &error), 0);
        assert_true(d[0].max < 1e-6f);
        assert_true(d[1].max > 0.0f && d[1].max < 0.0025f);
        lod_free(l);
        sheet_free(&s);
    }
}

static void pose_given_stays(void **state)
{
    (void)state;
    sheet s = sheet_new(25, 1, 1);
    bump(&s, 0, 0.06f, 0.06f, 0.05f, 0.02f);
    float *pose = test_zeros(s.mesh.vertex_count * 3u * sizeof *pose);
    const float *const poses[1] = { pose };
    float ratio = 0.1f;
    lod_options o = { 0 };
    for (uint32_t i = 0; i < s.mesh.vertex_count * 3u; i++) {
        pose[i] = s.mesh.position[i] + s.mesh.targets[0].position[i];
    }
    s.mesh.target_count = 0;
    o.level_count = 1;
    o.ratios = &ratio;
    o.poses = poses;
    o.pose_count = 1;
    lod *l = build(&s.mesh, &o);
    assert_true(used_near(&s.mesh, &l->levels[0], 0.06f, 0.06f, 0.05f) > 20u);
    lod_free(l);
    s.mesh.target_count = 1;
    free(pose);
    sheet_free(&s);
}

/* A painted disc on a flat sheet: only its colour keeps it. */
static void colours_stay(void **state)
{
    (void)state;
    sheet s = sheet_new(25, 1, 0);
    s.mesh.color = test_zeros(s.mesh.vertex_count * 4u * sizeof(float));
    for (uint32_t v = 0; v < s.mesh.vertex_count; v++) {
        float dx = s.mesh.position[v * 3u] - 0.06f, dy = s.mesh.position[v * 3u + 1u] - 0.06f;
        s.mesh.color[v * 4u] = dx * dx + dy * dy < 0.03f * 0.03f ? 1.0f : 0.0f;
        s.mesh.color[v * 4u + 3u] = 1.0f;
    }
    lod *l = build_to(&s.mesh, LOD_QUALITY, 0.1f);
    assert_true(used_near(&s.mesh, &l->levels[0], 0.06f, 0.06f, 0.05f) > 15u);
    assert_true(used_near(&s.mesh, &l->levels[0], 0.18f, 0.18f, 0.05f) < 8u);
    lod_free(l);
    sheet_free(&s);
}

/* ---- the order ---- */

static void levels_nest(void **state)
{
    (void)state;
    sheet s = sheet_new(21, 2, 2);
    lod_options o = { 0 };
    wrinkle(&s, 5);
    bump(&s, 0, 0.1f, 0.1f, 0.06f, 0.02f);
    bump(&s, 1, 0.05f, 0.15f, 0.04f, 0.01f);
    lod *l = build(&s.mesh, &o);
    uint8_t *gone = test_zeros(s.mesh.vertex_count);
    assert_int_equal(l->level_count, 4);
    assert_int_equal(l->levels[0].index_count, s.mesh.index_count);
    for (uint32_t k = 0, at = 0; k < l->level_count; k++) {
        const lod_level *level = &l->levels[k];
        for (; at < level->collapse_count; at++) {
            const lod_collapse *c = &l->collapses[at];
            assert_false(gone[c->from]);
            assert_false(gone[c->to]);
            assert_true(at == 0 || (c->step >= c[-1].step && c->step <= c[-1].step + 1u && c->cost >= c[-1].cost));
            gone[c->from] = 1;
        }
        for (uint32_t i = 0; i < level->index_count; i++) {
            assert_false(gone[level->indices[i]]);
        }
        assert_int_equal(level->vertex_count, s.mesh.vertex_count - at);
    }
    assert_true(l->levels[3].index_count <= s.mesh.index_count / 10u + 6u);
    free(gone);
    lod_free(l);
    sheet_free(&s);
}

/* What the collapses do to the mesh's triangles is the level's index list. */
static void collapses_give_the_level(void **state)
{
    (void)state;
    sheet s = sheet_new(15, 2, 1);
    wrinkle(&s, 6);
    bump(&s, 0, 0.07f, 0.07f, 0.05f, 0.02f);
    lod *l = build_to(&s.mesh, LOD_QUALITY, 0.3f);
    const lod_level *level = &l->levels[0];
    uint32_t *to = test_zeros(s.mesh.vertex_count * sizeof *to), *weld = test_zeros(s.mesh.vertex_count * sizeof *weld),
             at = 0;
    assert_int_equal(weld_vertices(&s.mesh, weld), 0);
    for (uint32_t v = 0; v < s.mesh.vertex_count; v++) {
        to[v] = v;
    }
    for (uint32_t i = 0; i < level->collapse_count; i++) {
        for (uint32_t v = 0; v < s.mesh.vertex_count; v++) {
            to[v] = to[v] == l->collapses[i].from ? l->collapses[i].to : to[v];
        }
    }
    for (uint32_t i = 0; i < s.mesh.index_count; i += 3u) {
        uint32_t a = to[s.mesh.indices[i]], b = to[s.mesh.indices[i + 1u]], c = to[s.mesh.indices[i + 2u]];
        if (weld[a] != weld[b] && weld[b] != weld[c] && weld[c] != weld[a]) {
            assert_true(at < level->index_count && level->indices[at] == a && level->indices[at + 1u] == b &&
                        level->indices[at + 2u] == c);
            at += 3u;
        }
    }
    assert_int_equal(at, level->index_count);
    free(to);
    free(weld);
    lod_free(l);
    sheet_free(&s);
}

static void same_bytes_twice(void **state)
{
    (void)state;
    for (lod_mode mode = LOD_QUALITY; mode <= LOD_FAST; mode++) {
        sheet s = sheet_new(21, 1, 3);
        lod_options o = { 0 };
        o.mode = mode;
        wrinkle(&s, 7);
        for (uint32_t t = 0; t < 3u; t++) {
            bump(&s, t, 0.05f * (float)(t + 1u), 0.1f, 0.05f, 0.02f);
        }
        lod *a = build(&s.mesh, &o), *b = build(&s.mesh, &o);
        assert_int_equal(a->collapse_count, b->collapse_count);
        assert_memory_equal(a->collapses, b->collapses, a->collapse_count * sizeof *a->collapses);
        for (uint32_t k = 0; k < a->level_count; k++) {
            assert_int_equal(a->levels[k].index_count, b->levels[k].index_count);
            assert_memory_equal(a->levels[k].indices, b->levels[k].indices,
                                a->levels[k].index_count * sizeof(uint32_t));
        }
        lod_free(a);
        lod_free(b);
        sheet_free(&s);
    }
}

static void levels_by_error(void **state)
{
    (void)state;
    sheet s = sheet_new(21, 1, 1);
    const float errors[3] = { 0.0005f, 0.001f, 0.002f };
    lod_options o = { 0 };
    wrinkle(&s, 8);
    bump(&s, 0, 0.1f, 0.1f, 0.08f, 0.03f);
    o.level_count = 3;
    o.errors = errors;
    lod *l = build(&s.mesh, &o);
    for (uint32_t k = 0; k < 3u; k++) {
        assert_true(l->levels[k].cost <= errors[k]);
        assert_true(k == 0 || l->levels[k].index_count < l->levels[k - 1u].index_count);
    }
    lod_free(l);
    sheet_free(&s);
}

/* ---- seams, borders, orientation ---- */

/* The border between two submeshes: each vertex of the one still has its twin in the other. */
static void seams_stay_shut(void **state)
{
    (void)state;
    sheet s = sheet_new(21, 2, 1);
    wrinkle(&s, 9);
    bump(&s, 0, 0.1f, 0.1f, 0.06f, 0.02f);
    lod *l = build_to(&s.mesh, LOD_QUALITY, 0.15f);
    const lod_level *level = &l->levels[0];
    uint8_t *used = test_zeros(s.mesh.vertex_count);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < level->index_count; i++) {
        used[level->indices[i]] = 1;
    }
    for (uint32_t y = 0; y < s.side; y++) {
        assert_int_equal(used[vertex_at(&s, s.side / 2u, y)], used[s.side * s.side + y]);
        kept += used[s.side * s.side + y];
    }
    assert_true(kept < s.side); /* it was simplified at all */
    assert_true(used[vertex_at(&s, s.side / 2u, 0)] && used[vertex_at(&s, s.side / 2u, s.side - 1u)]); /* its ends */
    free(used);
    lod_free(l);
    sheet_free(&s);
}

/* Points that touch at rest and that a target parts go in pairs: at rest no gap opens between them. */
static uint32_t count_pairs(const sheet *s, const lod *l, uint32_t first, uint32_t end)
{
    uint8_t *used = test_zeros(s->mesh.vertex_count);
    uint32_t count = 0;
    for (uint32_t i = 0; i < l->levels[0].index_count; i++) {
        used[l->levels[0].indices[i]] = 1;
    }
    for (uint32_t y = first; y < end; y++) {
        assert_int_equal(used[vertex_at(s, s->side / 2u, y)], used[s->side * s->side + y]);
        count += used[s->side * s->side + y];
    }
    free(used);
    return count;
}

static void parting_borders_stay_shut(void **state)
{
    (void)state;
    sheet s = sheet_new(21, 2, 1);
    wrinkle(&s, 10);
    for (uint32_t y = 0; y < s.side; y++) {
        s.mesh.targets[0].position[(s.side * s.side + y) * 3u + 2u] = 0.01f;
    }
    lod *l = build_to(&s.mesh, LOD_QUALITY, 0.15f);
    const uint32_t kept = count_pairs(&s, l, 0, s.side);
    assert_true(kept >= 2u && kept < s.side);
    lod_free(l);
    sheet_free(&s);
}

#define SLIT_FROM 4u /* rows of the sheet */
#define SLIT_END 17u

/* A closed mouth: a slit in the middle of a sheet, and a pocket behind it, so that no lip is a border. Where the slit
 * ends, both lips are one surface. */
static sheet mouth_new(void)
{
    sheet s = sheet_new(21, 2, 1);
    const uint32_t inner = s.mesh.vertex_count, rows = SLIT_END - SLIT_FROM, own = s.side * s.side;
    const size_t floats = (size_t)(inner + rows) * 3u * sizeof(float);
    wrinkle(&s, 11);
    s.mesh.position = realloc(s.mesh.position, floats);
    s.mesh.normal = realloc(s.mesh.normal, floats);
    s.mesh.uv = realloc(s.mesh.uv, floats);
    s.mesh.targets[0].position = realloc(s.mesh.targets[0].position, floats);
    s.mesh.indices = realloc(s.mesh.indices, (s.mesh.index_count + 12u * rows) * sizeof(uint32_t));
    assert_true(s.mesh.position && s.mesh.normal && s.mesh.uv && s.mesh.targets[0].position && s.mesh.indices);
    for (uint32_t i = 0; i < rows; i++) {
        const uint32_t y = SLIT_FROM + i, v = inner + i;
        place(&s, v, s.side / 2u, y);
        s.mesh.position[v * 3u + 2u] = -0.01f;
        memset(s.mesh.targets[0].position + v * 3u, 0, 3u * sizeof(float));
        if (i > 0 && i + 1u < rows) {
            s.mesh.targets[0].position[(own + y) * 3u] = 0.006f * sinf(3.1416f * (float)i / (float)(rows - 1u));
        }
    }
    for (uint32_t i = 0; i + 1u < rows; i++) {
        const uint32_t y = SLIT_FROM + i, a = vertex_at(&s, s.side / 2u, y), b = a + s.side, c = own + y, d = c + 1u;
        const uint32_t v = inner + i, quads[12] = { a, v, v + 1u, a, v + 1u, b, c, d, v + 1u, c, v + 1u, v };
        memcpy(s.mesh.indices + s.mesh.index_count, quads, sizeof quads);
        s.mesh.index_count += 12u;
        s.mesh.submeshes[1].index_count += 12u;
    }
    s.mesh.vertex_count += rows;
    return s;
}

static void shut_lips_stay_shut(void **state)
{
    (void)state;
    for (lod_mode mode = LOD_QUALITY; mode <= LOD_FAST; mode++) {
        sheet s = mouth_new();
        lod *l = build_to(&s.mesh, mode, 0.1f);
        const uint32_t kept = count_pairs(&s, l, SLIT_FROM + 1u, SLIT_END - 1u);
        assert_true(kept >= 1u && kept < SLIT_END - SLIT_FROM - 2u);
        lod_free(l);
        sheet_free(&s);
    }
}

static void nothing_turns_over(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed < 6u; seed++) {
        sheet s = sheet_new(21, 1, 0);
        test_random r = test_random_from(seed);
        for (uint32_t v = 0; v < s.mesh.vertex_count * 2u; v++) { /* UVs of their own, crooked */
            s.mesh.uv[v] += test_random_float(&r, -0.012f, 0.012f);
        }
        lod *l = build_to(&s.mesh, LOD_QUALITY, 0.1f);
        for (uint32_t i = 0; i < l->levels[0].index_count; i += 3u) {
            assert_true(doubled_area(s.mesh.position, 3, l->levels[0].indices + i) > 0.0);
            assert_true(doubled_area(s.mesh.uv, 2, l->levels[0].indices + i) > 0.0);
        }
        lod_free(l);
        sheet_free(&s);
    }
}

static void outline_stays(void **state)
{
    (void)state;
    sheet s = sheet_new(17, 1, 0);
    lod *l = build_to(&s.mesh, LOD_QUALITY, 0.1f);
    double area = 0.0;
    for (uint32_t i = 0; i < l->levels[0].index_count; i += 3u) {
        area += 0.5 * doubled_area(s.mesh.position, 3, l->levels[0].indices + i);
    }
    assert_true(fabs(area - 0.16 * 0.16) < 1e-6);
    lod_free(l);
    sheet_free(&s);
}

/* ---- odd meshes ---- */

static void no_new_edges_of_three(const model_mesh *mesh, const lod_level *level, uint32_t limit)
{
    uint32_t worst = 0;
    for (uint32_t i = 0; i < level->index_count; i++) {
        uint32_t a = level->indices[i], b = level->indices[i % 3u == 2u ? i - 2u : i + 1u], count = 0;
        for (uint32_t k = 0; k < level->index_count; k++) {
            uint32_t c = level->indices[k], d = level->indices[k % 3u == 2u ? k - 2u : k + 1u];
            count += (a == c && b == d) || (a == d && b == c);
        }
        worst = count > worst ? count : worst;
    }
    assert_true(worst <= limit);
    (void)mesh;
}

/* A fin stands on the sheet: edges of three triangles, which must not become more, or of four. */
static void fins_are_left(void **state)
{
    (void)state;
    sheet s = sheet_new(11, 1, 0);
    uint32_t fins = 4, first = s.mesh.index_count;
    s.mesh.position = realloc(s.mesh.position, (s.mesh.vertex_count + fins) * 3u * sizeof(float));
    s.mesh.normal = realloc(s.mesh.normal, (s.mesh.vertex_count + fins) * 3u * sizeof(float));
    s.mesh.uv = realloc(s.mesh.uv, (s.mesh.vertex_count + fins) * 2u * sizeof(float));
    s.mesh.indices = realloc(s.mesh.indices, (first + fins * 3u) * sizeof(uint32_t));
    for (uint32_t i = 0; i < fins; i++) {
        uint32_t v = s.mesh.vertex_count++, *to = s.mesh.indices + first + i * 3u;
        memset(s.mesh.uv + v * 2u, 0, 2u * sizeof(float));
        memset(s.mesh.normal + v * 3u, 0, 3u * sizeof(float));
        memcpy(s.mesh.position + v * 3u, s.mesh.position + vertex_at(&s, 3u + i, 5) * 3u, 3u * sizeof(float));
        s.mesh.position[v * 3u + 2u] = 0.02f;
        to[0] = vertex_at(&s, 3u + i, 5);
        to[1] = vertex_at(&s, 4u + i, 5);
        to[2] = v;
    }
    s.mesh.index_count += fins * 3u;
    s.mesh.submeshes[0].index_count = s.mesh.index_count;
    lod *l = build_to(&s.mesh, LOD_QUALITY, 0.1f);
    assert_true(l->levels[0].index_count < s.mesh.index_count);
    no_new_edges_of_three(&s.mesh, &l->levels[0], 3);
    lod_free(l);
    sheet_free(&s);
}

static void degenerate_triangles_go(void **state)
{
    (void)state;
    sheet s = sheet_new(9, 1, 0);
    uint32_t *last = s.mesh.indices + s.mesh.index_count - 3u;
    last[2] = last[1]; /* the other triangle of the square still uses its vertex */
    lod *l = build_to(&s.mesh, LOD_QUALITY, 1.0f);
    assert_int_equal(l->levels[0].index_count, s.mesh.index_count - 3u);
    assert_int_equal(l->collapse_count, 0);
    lod_free(l);
    sheet_free(&s);
}

static void isolated_vertices_are_ignored(void **state)
{
    (void)state;
    sheet s = sheet_new(9, 2, 0);
    s.mesh.index_count = s.mesh.submeshes[0].index_count;
    s.mesh.submeshes[1].index_count = 0;
    lod *l = build_to(&s.mesh, LOD_QUALITY, 0.25f);
    assert_int_equal(l->levels[0].submesh_count[1], 0);
    for (uint32_t i = 0; i < l->collapse_count; i++) {
        assert_true(l->collapses[i].from % 9u <= 4u && l->collapses[i].from < 81u);
    }
    lod_distance d[2];
    model_error error;
    assert_int_equal(lod_certify(&s.mesh, &l->levels[0], NULL, 0, d, &error), 0);
    assert_true(d[0].max < 1e-6f && d[1].max == 0.0f);
    lod_free(l);
    sheet_free(&s);
}

static void one_triangle_stays(void **state)
{
    (void)state;
    sheet s = sheet_new(2, 1, 0);
    s.mesh.index_count = s.mesh.submeshes[0].index_count = 3;
    lod *l = build_to(&s.mesh, LOD_QUALITY, 0.0f);
    assert_int_equal(l->levels[0].index_count, 3);
    assert_int_equal(l->collapse_count, 0);
    lod_free(l);
    sheet_free(&s);
}

/* A closed body comes down to no less than four triangles. */
static void closed_body_stays_closed(void **state)
{
    (void)state;
    static const uint32_t faces[24] = { 0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5 };
    sheet s = sheet_new(5, 1, 0);
    for (uint32_t v = 0; v < 6u; v++) { /* an octahedron */
        memset(s.mesh.position + v * 3u, 0, 3u * sizeof(float));
        s.mesh.position[v * 3u + v / 2u] = v % 2u ? -1.0f : 1.0f;
    }
    memset(s.mesh.uv, 0, s.mesh.vertex_count * 2u * sizeof(float));
    memcpy(s.mesh.indices, faces, sizeof faces);
    s.mesh.index_count = s.mesh.submeshes[0].index_count = 24;
    lod *l = build_to(&s.mesh, LOD_FAST, 0.0f);
    assert_true(l->levels[0].index_count >= 12u);
    no_new_edges_of_three(&s.mesh, &l->levels[0], 2);
    lod_free(l);
    sheet_free(&s);
}

/* In any unit a mesh is the same: up to the largest size that is not refused. */
static void size_does_not_matter(void **state)
{
    (void)state;
    for (lod_mode mode = LOD_QUALITY; mode <= LOD_FAST; mode++) {
        sheet small = sheet_new(9, 1, 1), large = sheet_new(9, 1, 1);
        wrinkle(&small, 12);
        wrinkle(&large, 12);
        bump(&small, 0, 0.04f, 0.04f, 0.03f, 0.02f);
        bump(&large, 0, 0.04f, 0.04f, 0.03f, 0.02f);
        for (uint32_t i = 0; i < large.mesh.vertex_count * 3u; i++) {
            large.mesh.position[i] *= 0x1p20f; /* a power of 2 leaves mantissas as they are */
            large.mesh.targets[0].position[i] *= 0x1p20f;
        }
        lod *a = build_to(&small.mesh, mode, 0.25f), *b = build_to(&large.mesh, mode, 0.25f);
        assert_int_equal(a->levels[0].index_count, b->levels[0].index_count);
        assert_true(a->levels[0].index_count < small.mesh.index_count / 3u);
        assert_memory_equal(a->levels[0].indices, b->levels[0].indices, sizeof(uint32_t) * a->levels[0].index_count);
        lod_free(a);
        lod_free(b);
        sheet_free(&small);
        sheet_free(&large);
    }
}

/* What is measured before the limit is chosen as without one; the rest still reaches the level. */
static void work_has_a_limit(void **state)
{
    (void)state;
    sheet s = sheet_new(24, 1, 1);
    const float ratio = 0.1f;
    lod_options o = { .level_count = 1, .ratios = &ratio };
    wrinkle(&s, 5);
    lod *whole = build(&s.mesh, &o);
    o.work_max = 250000;
    lod *part = build(&s.mesh, &o);
    assert_int_equal(whole->measured, whole->collapse_count);
    assert_in_range(part->measured, 1, part->collapse_count - 1u);
    assert_memory_equal(part->collapses, whole->collapses, part->measured * sizeof *part->collapses);
    assert_true(part->levels[0].index_count <= s.mesh.index_count / 10u + 6u);
    lod_free(whole);
    lod_free(part);
    sheet_free(&s);
}

static void refuse(const model_mesh *mesh, const lod_options *o, const char *word)
{
    model_error error = { "", "" };
    lod *l = NULL;
    assert_int_equal(lod_build(mesh, o, &l, &error), 1);
    assert_null(l);
    if (!strstr(error.what, word)) {
        fail_msg("\"%s\" does not say %s", error.what, word);
    }
}

static void memory_has_a_limit(void **state)
{
    (void)state;
    enum { VERTICES = 1000000, TARGETS = 20 };
    float *position = test_zeros(3u * VERTICES * sizeof *position);
    uint32_t indices[3] = { 0, 1, 2 };
    model_submesh part = { .index_count = 3 };
    model_target targets[TARGETS] = { { .position = position } };
    const lod_options o = { 0 };
    const model_mesh mesh = { .vertex_count = VERTICES,
                              .position = position,
                              .index_count = 3,
                              .indices = indices,
                              .submesh_count = 1,
                              .submeshes = &part,
                              .target_count = TARGETS,
                              .targets = targets };
    for (uint32_t t = 0; t < TARGETS; t++) {
        targets[t] = targets[0];
    }
    for (uint32_t i = 0; i < 3u * VERTICES; i++) {
        position[i] = 1.0f;
    }
    refuse(&mesh, &o, "would take 4.5 GB of memory");
    free(position);
}

static void bad_input_is_refused(void **state)
{
    (void)state;
    sheet s = sheet_new(5, 1, 1);
    lod_options o = { 0 };
    const float rising[2] = { 0.1f, 0.5f }, above[1] = { 1.5f }, falling[2] = { 0.2f, 0.1f };
    const float *const poses[1] = { s.mesh.position };
    s.mesh.position[7] = NAN;
    refuse(&s.mesh, &o, "vertex 2 is not a finite");
    s.mesh.position[7] = -1e9f;
    refuse(&s.mesh, &o, "vertex 2 is -1e+09: LOD levels are made of meshes within 1e+06");
    s.mesh.position[7] = 0.0f;
    s.mesh.targets[0].position[3] = INFINITY;
    refuse(&s.mesh, &o, "target");
    s.mesh.targets[0].position[3] = 0.0f;
    s.mesh.indices[4] = 25;
    refuse(&s.mesh, &o, "vertex 25 of 25");
    s.mesh.indices[4] = 6;
    o.level_count = 2;
    refuse(&s.mesh, &o, "LOD levels");
    o.ratios = rising;
    refuse(&s.mesh, &o, "fine to coarse");
    o.ratios = above;
    o.level_count = 1;
    refuse(&s.mesh, &o, "1.5");
    o.errors = falling;
    o.level_count = 2;
    refuse(&s.mesh, &o, "fine to coarse");
    memset(&o, 0, sizeof o);
    o.poses = poses;
    o.pose_count = LOD_POSES_MAX;
    refuse(&s.mesh, &o, "poses are more than");
    sheet_free(&s);
}

/* ---- the certificate ---- */

/* A square with a roof over its middle line against its two flat halves. */
static void distances_are_known_ones(void **state)
{
    (void)state;
    sheet s = sheet_new(3, 1, 1);
    uint32_t flat[6], first = 0, count = 6;
    lod_level level = { 0 };
    lod_distance d[3];
    model_error error;
    const float *const poses[1] = { s.mesh.position };
    s.mesh.targets[0].position[4u * 3u + 2u] = 0.003f; /* the middle vertex rises */
    flat[0] = flat[3] = 0;
    flat[1] = 2;
    flat[2] = flat[4] = 8;
    flat[5] = 6;
    level.indices = flat;
    level.index_count = 6;
    level.submesh_first = &first;
    level.submesh_count = &count;
    assert_int_equal(lod_certify(&s.mesh, &level, poses, 1, d, &error), 0);
    assert_true(d[0].max < 1e-7f && d[2].max < 1e-7f);
    assert_true(fabsf(d[1].max - 0.003f) < 1e-6f);
    s.mesh.position[4u * 3u + 2u] = 0.003f; /* the same at rest */
    assert_int_equal(lod_certify(&s.mesh, &level, NULL, 0, d, &error), 0);
    assert_true(fabsf(d[0].max - 0.003f) < 1e-6f && fabsf(d[1].max - 0.006f) < 1e-6f);
    assert_true(d[0].p99 > 0.0015f && d[0].p99 < 0.003f);
    s.mesh.position[4u * 3u + 2u] = 0.0f;
    flat[0] = 1; /* half of the square is missing now: its corner is farther from the rest than its middle rises */
    assert_int_equal(lod_certify(&s.mesh, &level, NULL, 0, d, &error), 0);
    assert_true(d[0].max > 0.003f);
    sheet_free(&s);
}

/* ---- frames ---- */

static void frames_bend_a_tube(void **state)
{
    (void)state;
    model *m = NULL;
    model_error error;
    lod_frames frames;
    assert_int_equal(model_read_gltf(test_asset("khronos/SimpleSkin.gltf"), &m, &error), 0);
    uint32_t node = lod_skinned_node(m, 0);
    const model_mesh *mesh = &m->meshes[0];
    float *rest = test_zeros(mesh->vertex_count * 3u * sizeof *rest),
          *bent = test_zeros(mesh->vertex_count * 3u * sizeof *bent);
    assert_int_not_equal(node, MODEL_NONE);
    assert_int_equal(lod_frame_pose(m, node, 0, 0.0, rest), 0);
    assert_int_equal(lod_frame_pose(m, node, 0, 1.0, bent), 0); /* the upper joint has turned by 90 degrees */
    float moved = 0.0f;
    for (uint32_t i = 0; i < mesh->vertex_count * 3u; i++) {
        assert_true(fabsf(rest[i] - mesh->position[i]) < 1e-5f);
        moved = fmaxf(moved, fabsf(bent[i] - rest[i]));
    }
    assert_true(moved > 0.5f);
    assert_int_equal(lod_frames_choose(m, node, 3, &frames), 0);
    assert_int_equal(frames.count, 3);
    assert_memory_not_equal(frames.poses[0], frames.poses[1], mesh->vertex_count * 3u * sizeof(float));
    lod_frames_free(&frames);
    free(rest);
    free(bent);
    model_free(m);
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_collapses_for_nothing),
        cmocka_unit_test(bump_of_a_target_stays),
        cmocka_unit_test(pose_given_stays),
        cmocka_unit_test(colours_stay),
        cmocka_unit_test(levels_nest),
        cmocka_unit_test(collapses_give_the_level),
        cmocka_unit_test(same_bytes_twice),
        cmocka_unit_test(levels_by_error),
        cmocka_unit_test(seams_stay_shut),
        cmocka_unit_test(parting_borders_stay_shut),
        cmocka_unit_test(shut_lips_stay_shut),
        cmocka_unit_test(nothing_turns_over),
        cmocka_unit_test(outline_stays),
        cmocka_unit_test(fins_are_left),
        cmocka_unit_test(degenerate_triangles_go),
        cmocka_unit_test(isolated_vertices_are_ignored),
        cmocka_unit_test(one_triangle_stays),
        cmocka_unit_test(closed_body_stays_closed),
        cmocka_unit_test(size_does_not_matter),
        cmocka_unit_test(work_has_a_limit),
        cmocka_unit_test(memory_has_a_limit),
        cmocka_unit_test(bad_input_is_refused),
        cmocka_unit_test(distances_are_known_ones),
        cmocka_unit_test(frames_bend_a_tube),
    };
    if (argument_count > 1) {
        cmocka_set_test_filter(arguments[1]);
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
