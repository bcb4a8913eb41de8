/* test_tangents.c: tangents against MikkTSpace's rules, written down again in double precision and without regard for
 * speed: what is one vertex, which edges meet, which corners share a tangent, and what it is.
 *
 * source  Mikkelsen, Simulation of Wrinkled Surfaces Revisited, 2008, chapter 3 */
#include "support/support.h"

#include <math.h>
#include <string.h>

#include "convert/model/model_build.h"

#define SIDE 6u
#define VERTICES (SIDE * SIDE)
#define TRIANGLES_MAX (2u * (SIDE - 1u) * (SIDE - 1u))
#define CORNERS_MAX (3u * TRIANGLES_MAX)
#define NONE 0xffffffffu

/* ---- the oracle ---- */

typedef struct corner {
    double position[3], normal[3], uv[2];
} corner;

typedef struct oracle {
    corner base[CORNERS_MAX];
    uint32_t count, group[CORNERS_MAX], groups;
    int meets[CORNERS_MAX]; /* of the edge from a corner to the next: the edge that it meets, or -1 */
    int side[TRIANGLES_MAX], any[TRIANGLES_MAX], none[TRIANGLES_MAX];
} oracle;

static int same(const corner *a, const corner *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

static uint32_t after(uint32_t c)
{
    return c / 3 * 3 + (c + 1) % 3;
}

static double uv_area(const corner *c)
{
    return (c[1].uv[0] - c[0].uv[0]) * (c[2].uv[1] - c[0].uv[1]) -
           (c[2].uv[0] - c[0].uv[0]) * (c[1].uv[1] - c[0].uv[1]);
}

static void assign(oracle *o, int edge, uint32_t seed)
{
    uint32_t t, at = NONE;
    if (edge < 0) return;
    t = (uint32_t)edge / 3;
    for (uint32_t k = 0; k < 3; k++) at = same(&o->base[3 * t + k], &o->base[seed]) ? 3 * t + k : at;
    assert_true(at != NONE);
    if (o->group[at] != NONE) return;
    if (o->any[t] && o->group[3 * t] == NONE && o->group[3 * t + 1] == NONE && o->group[3 * t + 2] == NONE) {
        o->side[t] = o->side[seed / 3];
    }
    if (o->side[t] != o->side[seed / 3]) return;
    o->group[at] = o->group[seed];
    assign(o, o->meets[at], seed);
    assign(o, o->meets[after(after(at))], seed);
}

static void find_groups(oracle *o)
{
    for (uint32_t c = 0; c < o->count; c++) {
        o->meets[c] = -1;
        o->group[c] = NONE;
    }
    for (uint32_t t = 0; t < o->count / 3; t++) {
        const corner *c = o->base + 3 * t;
        o->any[t] = uv_area(c) == 0.0;
        o->side[t] = uv_area(c) > 0.0 ? 1 : -1;
        o->none[t] = !memcmp(c[0].position, c[1].position, 24) || !memcmp(c[1].position, c[2].position, 24) ||
                     !memcmp(c[2].position, c[0].position, 24);
    }
    for (uint32_t a = 0; a < o->count; a++) {
        for (uint32_t b = a + 1; b < o->count && o->meets[a] < 0; b++) {
            if (o->none[a / 3] || o->none[b / 3] || o->meets[b] >= 0) continue;
            if (same(&o->base[a], &o->base[after(b)]) && same(&o->base[after(a)], &o->base[b])) {
                o->meets[a] = (int)b;
                o->meets[b] = (int)a;
            }
        }
    }
    for (uint32_t c = 0; c < o->count; c++) {
        if (o->any[c / 3] || o->none[c / 3] || o->group[c] != NONE) continue;
        o->group[c] = o->groups++;
        assign(o, o->meets[c], c);
        assign(o, o->meets[after(after(c))], c);
    }
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void onto_plane(const double *v, const double *n, double *out)
{
    const double along = dot(v, n);
    double length;
    for (int i = 0; i < 3; i++) out[i] = v[i] - along * n[i];
    length = sqrt(dot(out, out));
    for (int i = 0; i < 3 && length > 0.0; i++) out[i] /= length;
}

/* The tangents of all groups in a pose; 0 where there is none. */
static void evaluate(const oracle *o, const corner *posed, double tangents[CORNERS_MAX][3])
{
    memset(tangents, 0, sizeof(double[CORNERS_MAX][3]));
    for (uint32_t c = 0; c < o->count; c++) {
        const corner *t = posed + c / 3 * 3, *at = posed + c;
        const corner *next = posed + after(c), *last = posed + after(after(c));
        const double v1 = t[1].uv[1] - t[0].uv[1], v2 = t[2].uv[1] - t[0].uv[1];
        double along[3], first[3], second[3], raw[3], angle;
        if (o->group[c] == NONE || o->any[c / 3]) continue;
        for (int i = 0; i < 3; i++) {
            raw[i] = o->side[c / 3] *
                     (v2 * (t[1].position[i] - t[0].position[i]) - v1 * (t[2].position[i] - t[0].position[i]));
            first[i] = next->position[i] - at->position[i];
            second[i] = last->position[i] - at->position[i];
        }
        onto_plane(raw, at->normal, along);
        onto_plane(first, at->normal, first);
        onto_plane(second, at->normal, second);
        angle = acos(fmax(-1.0, fmin(1.0, dot(first, second))));
        for (int i = 0; i < 3; i++) tangents[o->group[c]][i] += angle * along[i];
    }
    for (uint32_t g = 0; g < o->groups; g++) {
        const double length = sqrt(dot(tangents[g], tangents[g]));
        for (int i = 0; i < 3 && length > 0.0; i++) tangents[g][i] /= length;
    }
}

static void take_corner(const model_mesh *mesh, uint32_t v, const model_target *target, corner *out)
{
    double length;
    for (int i = 0; i < 3; i++) {
        out->position[i] = (double)mesh->position[3 * v + (uint32_t)i] + 0.0;
        out->normal[i] = (double)mesh->normal[3 * v + (uint32_t)i] + 0.0;
        if (target) out->position[i] += (double)target->position[3 * v + (uint32_t)i];
        if (target) out->normal[i] += (double)target->normal[3 * v + (uint32_t)i];
    }
    for (int i = 0; i < 2; i++) out->uv[i] = (double)mesh->uv[2 * v + (uint32_t)i] + 0.0;
    length = sqrt(dot(out->normal, out->normal));
    for (int i = 0; i < 3 && target; i++) out->normal[i] /= length;
}

/* ---- meshes ---- */

enum { FOLD_U = 1, FOLD_V = 2, HOLES = 4, FLAT_UVS = 8, SHUFFLED = 16, SPLIT_ROWS = 32 };

static float fold(int folds, uint32_t at)
{
    return folds ? fabsf((float)at - (float)(SIDE / 2u)) / SIDE : (float)at / SIDE;
}

static void set_vertices(model_mesh *mesh, uint32_t flags)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const uint32_t at = v < VERTICES ? v : v - VERTICES + SIDE * (SIDE / 2u); /* a row twice: a seam of vertices */
        const uint32_t x = at % SIDE, y = at / SIDE;
        float *p = mesh->position + 3 * v;
        p[0] = (float)x;
        p[1] = (float)y;
        p[2] = 0.3f * sinf((float)(x * 3 + y));
        mesh->targets[0].position[3 * v] = 0.1f * (float)y;
        mesh->targets[0].position[3 * v + 2] = 0.2f * (float)(x * y % 5);
        mesh->uv[2 * v] = fold(flags & FOLD_U, flags & FLAT_UVS && x == 2 ? 3 : x);
        mesh->uv[2 * v + 1] = fold(flags & FOLD_V, y);
    }
}

static void set_triangles(model_mesh *mesh, uint32_t flags, test_random *r)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < (SIDE - 1u) * (SIDE - 1u); i++) {
        const uint32_t x = i % (SIDE - 1u), y = i / (SIDE - 1u), a = y * SIDE + x;
        const uint32_t up = flags & SPLIT_ROWS && y == SIDE / 2u ? VERTICES + x : a;
        const uint32_t quad[6] = { up, up + 1, a + SIDE, a + SIDE, up + 1, a + SIDE + 1 };
        for (uint32_t k = 0; k < 6; k += 3) {
            if (flags & HOLES && test_random_below(r, 3) == 0) continue;
            for (uint32_t c = 0; c < 3; c++) mesh->indices[n + c] = quad[k + c];
            n += 3;
        }
    }
    mesh->index_count = n;
    for (uint32_t t = n / 3; flags & SHUFFLED && t > 1; t--) {
        const uint32_t other = test_random_below(r, t);
        for (uint32_t c = 0; c < 3; c++) {
            const uint32_t kept = mesh->indices[3 * other + c];
            mesh->indices[3 * other + c] = mesh->indices[3 * (t - 1) + c];
            mesh->indices[3 * (t - 1) + c] = kept;
        }
    }
}

static model *make_model(uint32_t flags, test_random *r)
{
    const uint32_t count = VERTICES + (flags & SPLIT_ROWS ? SIDE : 0u);
    model *m = model_new();
    model_mesh *mesh;
    m->meshes = test_zeros(sizeof *m->meshes);
    m->mesh_count = 1;
    mesh = m->meshes;
    mesh->name = model_string("m");
    mesh->vertex_count = count;
    mesh->position = test_zeros(count * 12);
    mesh->uv = test_zeros(count * 8);
    mesh->indices = test_zeros(CORNERS_MAX * sizeof *mesh->indices);
    mesh->targets = test_zeros(sizeof *mesh->targets);
    mesh->weights = test_zeros(sizeof *mesh->weights);
    mesh->target_count = 1;
    mesh->targets[0].name = model_string("t");
    mesh->targets[0].position = test_zeros(count * 12);
    set_vertices(mesh, flags);
    set_triangles(mesh, flags, r);
    mesh->submeshes = test_zeros(sizeof *mesh->submeshes);
    mesh->submesh_count = 1;
    mesh->submeshes[0] = (model_submesh){ 0, mesh->index_count, MODEL_NONE, 0, count, 0 };
    return m;
}

/* ---- comparison ---- */

static void expect_tangent(const float *got, const double *want, const char *what, uint32_t c)
{
    double off = 0.0;
    for (int i = 0; i < 3; i++) off = fmax(off, fabs((double)got[i] - want[i]));
    if (!(off < 2e-6)) fail_msg("%s of corner %u is off by %g", what, (unsigned)c, off);
}

static uint32_t compare(uint32_t flags, test_random *r)
{
    static oracle o;
    static corner posed[CORNERS_MAX];
    static double base[CORNERS_MAX][3], moved[CORNERS_MAX][3];
    model *m = make_model(flags, r);
    const model_mesh *mesh = m->meshes;
    const uint32_t before = mesh->vertex_count;
    uint32_t copies;
    model_error error;
    assert_int_equal(model_complete(m, &error), 0);
    copies = mesh->vertex_count - before;
    memset(&o, 0, sizeof o);
    o.count = mesh->index_count;
    for (uint32_t c = 0; c < o.count; c++) {
        take_corner(mesh, mesh->indices[c], NULL, &o.base[c]);
        take_corner(mesh, mesh->indices[c], mesh->targets, &posed[c]);
    }
    find_groups(&o);
    evaluate(&o, o.base, base);
    evaluate(&o, posed, moved);
    for (uint32_t c = 0; c < o.count; c++) {
        const float *t = mesh->tangent + 4 * mesh->indices[c];
        double delta[3];
        if (o.group[c] == NONE) continue;
        for (int i = 0; i < 3; i++) delta[i] = moved[o.group[c]][i] - base[o.group[c]][i];
        expect_tangent(t, base[o.group[c]], "the tangent", c);
        expect_tangent(mesh->targets[0].tangent + 3 * mesh->indices[c], delta, "the target's tangent", c);
        assert_true(t[3] == (float)-o.side[c / 3]); /* v runs down in glTF */
    }
    model_free(m);
    return copies;
}

static void tangents_are_those_of_mikktspace(void **state)
{
    test_random r = test_random_from(37);
    uint32_t with = 0;
    (void)state;
    for (uint32_t flags = 0; flags < 64; flags++) {
        for (int round = 0; round < 4; round++) {
            const uint32_t copies = compare(flags, &r);
            if (!(flags & (FOLD_U | FOLD_V | HOLES))) assert_int_equal(copies, 0);
            if (flags == FOLD_U) assert_int_equal(copies, SIDE);
            if (flags == (FOLD_U | FOLD_V)) assert_int_equal(copies, 2 * SIDE + 1); /* four where the seams cross */
            with += copies > 0;
        }
    }
    assert_true(with > 100);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(tangents_are_those_of_mikktspace),
};

TEST_MAIN(tests, NULL, NULL)
