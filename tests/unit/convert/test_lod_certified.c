/* The errors that a pack certifies for its levels, against distances measured here: in double precision, from the
 * pack's own vertices, by looking at every triangle for each of many random points of both surfaces. */
#include "support/lod_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "deform/morph/morph_internal.h"
#include "noh/low_core.h"

#define POINTS 2500u /* random ones on each surface, besides all corners */

/* What random points may find above the certified value, which was measured on a grid of half an edge (lod_certify.c):
 * between its points the distance can be larger, in these meshes by 5 percent, with 40,000 points a surface. Deltas of
 * targets in the pack are quantised besides: their error, twice, is allowed as well. */
#define ABOVE 1.08
/* How much less they may find: points come close to a correct value, so finding less than half shows a wrong one. */
#define BELOW 0.5
/* The same for the value that 99 % of the area is below: 25 of POINTS are above it, give or take a third by chance. */
#define P99_ABOVE 1.3
#define P99_BELOW 0.7

/* ---- distances ---- */

typedef double point[3];

static void minus(const point a, const point b, point out)
{
    for (int i = 0; i < 3; i++) {
        out[i] = a[i] - b[i];
    }
}

static double dot(const point a, const point b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double segment_distance(const point p, const point a, const point b)
{
    point ab, ap, off;
    double along, length;
    minus(b, a, ab);
    minus(p, a, ap);
    length = dot(ab, ab);
    along = length > 0.0 ? fmin(fmax(dot(ap, ab) / length, 0.0), 1.0) : 0.0;
    for (int i = 0; i < 3; i++) {
        off[i] = ap[i] - along * ab[i];
    }
    return sqrt(dot(off, off));
}

/* Inside its edges the distance to the plane, else that to the nearest edge. */
static double triangle_distance(const point p, const point a, const point b, const point c)
{
    point u, v, w;
    double uu, uv, vv, wu, wv, area, s, t;
    minus(b, a, u);
    minus(c, a, v);
    minus(p, a, w);
    uu = dot(u, u);
    uv = dot(u, v);
    vv = dot(v, v);
    wu = dot(w, u);
    wv = dot(w, v);
    area = uu * vv - uv * uv;
    s = area > 0.0 ? (vv * wu - uv * wv) / area : -1.0;
    t = area > 0.0 ? (uu * wv - uv * wu) / area : -1.0;
    if (s >= 0.0 && t >= 0.0 && s + t <= 1.0) {
        for (int i = 0; i < 3; i++) {
            w[i] -= s * u[i] + t * v[i];
        }
        return sqrt(dot(w, w));
    }
    return fmin(segment_distance(p, a, b), fmin(segment_distance(p, b, c), segment_distance(p, c, a)));
}

/* ---- surfaces ---- */

typedef struct face {
    point corner[3], middle;
    double radius; /* about its centre */
} face;

/* The triangles of one material in one pose: a submesh of the model. */
typedef struct surface {
    uint32_t count;
    face *faces;
    double *areas; /* [count] summed up to each triangle */
} surface;

static void close_face(face *f)
{
    for (int i = 0; i < 3; i++) {
        f->middle[i] = (f->corner[0][i] + f->corner[1][i] + f->corner[2][i]) / 3.0;
    }
    f->radius = 0.0;
    for (int c = 0; c < 3; c++) {
        point off;
        minus(f->corner[c], f->middle, off);
        f->radius = fmax(f->radius, sqrt(dot(off, off)));
    }
}

static double area_of(const face *f)
{
    point u, v;
    minus(f->corner[1], f->corner[0], u);
    minus(f->corner[2], f->corner[0], v);
    return 0.5 * sqrt(fmax(dot(u, u) * dot(v, v) - dot(u, v) * dot(u, v), 0.0));
}

static surface surface_make(const noh_mesh *level, const point *positions, uint32_t material)
{
    surface s = { 0, test_zeros(sizeof *s.faces * level->header->index_count),
                  test_zeros(sizeof *s.areas * level->header->index_count) };
    for (uint32_t n = 0; n < level->header->submesh_count; n++) {
        const noh_submesh *sub = &level->submeshes[n];
        for (uint32_t i = 0; i < sub->index_count && sub->material == material; i += 3u) {
            face *f = &s.faces[s.count];
            for (uint32_t c = 0; c < 3u; c++) {
                memcpy(f->corner[c], positions[noh_mesh_index(level, sub->first_index + i + c)], sizeof f->corner[c]);
            }
            close_face(f);
            s.areas[s.count] = area_of(f) + (s.count ? s.areas[s.count - 1u] : 0.0);
            s.count++;
        }
    }
    return s;
}

static void surface_free(surface *s)
{
    free(s->faces);
    free(s->areas);
}

/* Every triangle is looked at; those wholly farther than the nearest so far are not measured. */
static double nearest(const surface *s, const point p)
{
    double best = HUGE_VAL;
    for (uint32_t i = 0; i < s->count; i++) {
        const face *f = &s->faces[i];
        point off;
        double reach = best + f->radius;
        minus(p, f->middle, off);
        if (dot(off, off) < reach * reach) {
            best = fmin(best, triangle_distance(p, f->corner[0], f->corner[1], f->corner[2]));
        }
    }
    return best;
}

static void random_point(const surface *s, test_random *r, point out)
{
    const double at = (double)test_random_float(r, 0.0f, 1.0f) * s->areas[s->count - 1u];
    double u = (double)test_random_float(r, 0.0f, 1.0f), v = (double)test_random_float(r, 0.0f, 1.0f);
    uint32_t low = 0, high = s->count - 1u;
    while (low < high) {
        const uint32_t middle = (low + high) / 2u;
        low = s->areas[middle] < at ? middle + 1u : low;
        high = s->areas[middle] < at ? high : middle;
    }
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    for (int i = 0; i < 3; i++) {
        const face *f = &s->faces[low];
        out[i] = f->corner[0][i] + u * (f->corner[1][i] - f->corner[0][i]) + v * (f->corner[2][i] - f->corner[0][i]);
    }
}

typedef struct measured {
    double max, p99;
} measured;

static int by_value(const void *a, const void *b)
{
    const double *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

static measured one_way(const surface *from, const surface *to, test_random *r)
{
    double *found = test_zeros(sizeof *found * POINTS);
    measured m = { 0.0, 0.0 };
    for (uint32_t i = 0; i < POINTS; i++) {
        point p;
        random_point(from, r, p);
        found[i] = nearest(to, p);
    }
    qsort(found, POINTS, sizeof *found, by_value);
    m.max = found[POINTS - 1u];
    m.p99 = found[POINTS / 100u * 99u];
    for (uint32_t i = 0; i < from->count * 3u; i++) {
        m.max = fmax(m.max, nearest(to, from->faces[i / 3u].corner[i % 3u]));
    }
    free(found);
    return m;
}

/* Each material against itself, in both directions: the larger distance. */
static measured apart(const noh_mesh *full, const noh_mesh *level, const point *positions, uint32_t material_count,
                      test_random *r)
{
    measured worst = { 0.0, 0.0 };
    for (uint32_t material = 0; material < material_count; material++) {
        surface a = surface_make(full, positions, material_count > 1u ? material : NOH_NONE);
        surface b = surface_make(level, positions, material_count > 1u ? material : NOH_NONE);
        const measured ways[2] = { one_way(&a, &b, r), one_way(&b, &a, r) };
        for (int i = 0; i < 2; i++) {
            worst.max = fmax(worst.max, ways[i].max);
            worst.p99 = fmax(worst.p99, ways[i].p99);
        }
        surface_free(&a);
        surface_free(&b);
    }
    return worst;
}

/* ---- poses ---- */

/* The skin's matrices of joints at rest, with virtual ones moved; NULL for a mesh that has none of these. */
static float *far_matrices(const noh_mesh *mesh, const float *weights)
{
    const noh_mesh coarsest = noh_mesh_at_lod(mesh, mesh->header->level_count - 1u);
    noh_skin skin;
    float *matrices;
    if (!mesh->far_joints) return NULL;
    assert_int_equal(noh_pack_skin_at(mesh->pack, mesh->header->skin, &skin, NULL), NOH_OK);
    matrices = test_zeros(48u * (size_t)skin.header->joint_count);
    for (uint32_t i = 0; i < 3u * skin.header->joint_count; i++) matrices[4u * i + i % 3u] = 1.0f;
    noh_mesh_move_far_joints(&coarsest, weights, matrices);
    return matrices;
}

/* All vertices at weights of targets, as the pack has them: vertices with texels by these, others by virtual joints. */
static void morph_by(const noh_mesh *mesh, const float *weights, point *out)
{
    noh_morph_layers layers = test_layers(mesh);
    float *matrices = far_matrices(mesh, weights);
    noh_morph_accumulate(mesh, weights, &layers);
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        float p[3];
        if (matrices) {
            noh_skin_position(mesh, matrices, &layers, v, p);
        } else {
            noh_morph_position(mesh, &layers, v, p);
        }
        for (int i = 0; i < 3; i++) {
            out[v][i] = (double)p[i];
        }
    }
    free(matrices);
    free(layers.position);
}

/* Rest and some targets at full weight. */
static void morph(const noh_mesh *mesh, const uint32_t *targets, uint32_t count, point *out)
{
    float weights[LOD_FACE_TARGETS] = { 0.0f };
    for (uint32_t i = 0; i < count; i++) weights[targets[i]] = 1.0f;
    morph_by(mesh, weights, out);
}

/* A frame of the tube's clip: a chain of joints along y, each turned about x, in double precision. */
static void bend(const noh_mesh *mesh, const skin_cylinder *tube, uint32_t frame, point *out)
{
    double turn[16], y[16], z[16]; /* of each joint: the angle about x, and where it is */
    const double step = (double)tube->length / (tube->joints - 1u);
    assert_true(tube->joints <= TEST_COUNT(turn));
    for (uint32_t j = 0; j < tube->joints; j++) {
        turn[j] = (j ? turn[j - 1u] : 0.0) + 2.0 * lod_tube_half_angle(j, frame);
        y[j] = j ? y[j - 1u] + step * cos(turn[j - 1u]) : 0.0;
        z[j] = j ? z[j - 1u] + step * sin(turn[j - 1u]) : 0.0;
    }
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        uint32_t joints[NOH_INFLUENCES_MAX], count;
        float weights[NOH_INFLUENCES_MAX];
        const float *p = mesh->positions + 3u * (size_t)v;
        count = noh_mesh_influences(mesh, v, joints, weights);
        out[v][0] = (double)p[0];
        out[v][1] = out[v][2] = 0.0;
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t j = joints[i]; /* the skin's joints are the nodes, in order */
            const double up = (double)p[1] - step * j, c = cos(turn[j]), s = sin(turn[j]);
            out[v][1] += (double)weights[i] * (y[j] + c * up - s * (double)p[2]);
            out[v][2] += (double)weights[i] * (z[j] + s * up + c * (double)p[2]);
        }
    }
}

/* ---- what is certified ---- */

/* The largest of a kind of poses, by level. Certified ones never fall from level to level, so these may not either. */
typedef struct kind {
    const char *name;
    double found[NOH_LOD_LEVELS_MAX], certified[NOH_LOD_LEVELS_MAX];
} kind;

static void check_kind(kind *k, uint32_t levels, double slack, double above, double below)
{
    for (uint32_t i = 1; i < levels; i++) {
        k->found[i] = fmax(k->found[i], k->found[i - 1u]);
        print_message("# level %u, %s: certified %.6g, found %.6g (%.3f of it)\n", i, k->name, k->certified[i],
                      k->found[i], k->found[i] / k->certified[i]);
        if (k->found[i] > above * k->certified[i] + slack || k->found[i] < below * k->certified[i] - slack) {
            fail_msg("level %u, %s: certified %g, found %g", i, k->name, k->certified[i], k->found[i]);
        }
    }
}

enum { REST, P99, TARGETS, PAIRS, CLIP, KINDS };

static void begin(kind *kinds, const noh_mesh *mesh)
{
    static const char *const names[KINDS] = { "at rest", "at rest, 99 %", "with a target", "with a pair", "in motion" };
    memset(kinds, 0, sizeof *kinds * KINDS);
    for (uint32_t i = 0; i < KINDS; i++) {
        kinds[i].name = names[i];
        for (uint32_t k = 0; k < mesh->header->level_count; k++) {
            kinds[i].certified[k] = (double)(&noh_mesh_at_lod(mesh, k).header->level_error_rest)[i];
        }
    }
}

static void add_pose(kind *k, const noh_mesh *mesh, const point *positions, uint32_t material_count, test_random *r,
                     kind *p99)
{
    for (uint32_t i = 1; i < mesh->header->level_count; i++) {
        const noh_mesh level = noh_mesh_at_lod(mesh, i);
        const measured m = apart(mesh, &level, positions, material_count, r);
        k->found[i] = fmax(k->found[i], m.max);
        if (p99) {
            p99->found[i] = m.p99;
        }
    }
}

static double target_error(const noh_mesh *mesh)
{
    double worst = 0.0;
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        worst = fmax(worst, (double)mesh->targets[t].position_error);
    }
    return worst;
}

/* Both surfaces are linear in the weights: in mixes they are no farther apart than at rest, and by each weight as much
 * more as its target alone may take them. */
static void check_mixes(const noh_mesh *mesh, point *pose, test_random *r)
{
    const noh_mesh level = noh_mesh_at_lod(mesh, mesh->header->level_count - 1u);
    const double rest = (double)level.header->level_error_rest, target = (double)level.header->level_error_targets;
    assert_non_null(mesh->far_joints);
    assert_int_equal(level.header->touched_count, 0);
    for (int i = 0; i < 12; i++) {
        float weights[LOD_FACE_TARGETS];
        double sum = 0.0, found;
        surface full, far;
        for (uint32_t t = 0; t < LOD_FACE_TARGETS; t++) {
            weights[t] = test_random_float(r, -1.0f, 1.0f);
            sum += fabs((double)weights[t]);
        }
        morph_by(mesh, weights, pose);
        full = surface_make(mesh, (const point *)pose, 0); /* the eye, which no target moves, is farther off */
        far = surface_make(&level, (const point *)pose, 0);
        found = fmax(one_way(&full, &far, r).max, one_way(&far, &full, r).max);
        surface_free(&full);
        surface_free(&far);
        print_message("# mix %d: found %.6g, certified at most %.6g\n", i, found, rest + sum * target);
        assert_true(found <= ABOVE * (rest + sum * target));
        assert_true(found > 0.1 * rest);
    }
}

static void check_face(const lod_face shape, lod_mode mode, uint32_t face_joints)
{
    const lod_settings settings = { 4, 0, mode, 0.0f, 0.0f, NULL, face_joints };
    const skin_options skin = { .rigid_faces = face_joints > 0 };
    model *m = face_joints ? lod_drawn_face_model(&shape) : lod_face_model(&shape);
    test_random r = test_random_from(31);
    kind kinds[KINDS];
    lod_pack p;
    point *pose;
    lod_pack_make_skinned(m, &settings, &skin, &p);
    begin(kinds, &p.mesh);
    pose = test_zeros(sizeof *pose * p.mesh.header->vertex_count);
    morph(&p.mesh, NULL, 0, pose);
    add_pose(&kinds[REST], &p.mesh, (const point *)pose, 2, &r, &kinds[P99]);
    for (uint32_t t = 0; t < LOD_FACE_TARGETS; t++) {
        morph(&p.mesh, &t, 1, pose);
        add_pose(&kinds[TARGETS], &p.mesh, (const point *)pose, 2, &r, NULL);
    }
    for (uint32_t i = 0; i < LOD_FACE_PAIRS; i++) {
        morph(&p.mesh, lod_face_pairs[i], 2, pose);
        add_pose(&kinds[PAIRS], &p.mesh, (const point *)pose, 2, &r, NULL);
    }
    check_kind(&kinds[REST], 4, 1e-7, ABOVE, BELOW);
    check_kind(&kinds[P99], 4, 1e-7, P99_ABOVE, P99_BELOW);
    check_kind(&kinds[TARGETS], 4, 1e-7 + 2.0 * target_error(&p.mesh), ABOVE, BELOW);
    check_kind(&kinds[PAIRS], 4, 1e-7 + 4.0 * target_error(&p.mesh), ABOVE, BELOW);
    assert_true(kinds[CLIP].certified[3] == 0.0); /* no clips */
    if (face_joints) check_mixes(&p.mesh, pose, &r);
    free(pose);
    lod_pack_free(&p);
    model_free(m);
}

static void a_face_is_as_near_as_certified(void **state)
{
    (void)state;
    check_face((lod_face){ 22, 16, LOD_FACE_TARGETS, 1, 0 }, LOD_FAST, 0);
}

/* With vertices of its own in the coarsest level. */
static void a_fitted_face_is_as_near_as_certified(void **state)
{
    (void)state;
    check_face((lod_face){ 30, 22, LOD_FACE_TARGETS, 1, 0 }, LOD_QUALITY, 0);
}

/* With virtual joints in the coarsest level. */
static void a_face_with_virtual_joints_is_as_near_as_certified(void **state)
{
    (void)state;
    check_face((lod_face){ 30, 22, LOD_FACE_TARGETS, 1, 0 }, LOD_QUALITY, NOH_LOD_LEVELS_MAX);
}

/* All frames of the clip that are looked at are different, and fewer than are certified: each one is. */
static void a_tube_is_as_near_as_certified(void **state)
{
    const skin_cylinder tube = { 14, 30, 6, 4, 2, 1, 2.0f, 0.5f };
    const lod_settings settings = { 4, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    model *m = lod_tube_model(&tube);
    test_random r = test_random_from(32);
    kind kinds[KINDS];
    lod_pack p;
    point *pose;
    (void)state;
    lod_pack_make(m, &settings, 0, &p);
    begin(kinds, &p.mesh);
    pose = test_zeros(sizeof *pose * p.mesh.header->vertex_count);
    morph(&p.mesh, NULL, 0, pose);
    add_pose(&kinds[REST], &p.mesh, (const point *)pose, 1, &r, NULL);
    for (uint32_t t = 0; t < tube.targets; t++) {
        morph(&p.mesh, &t, 1, pose);
        add_pose(&kinds[TARGETS], &p.mesh, (const point *)pose, 1, &r, NULL);
    }
    for (uint32_t frame = 1; frame < LOD_TUBE_KEYS; frame++) {
        bend(&p.mesh, &tube, frame, pose);
        add_pose(&kinds[CLIP], &p.mesh, (const point *)pose, 1, &r, NULL);
    }
    check_kind(&kinds[REST], 4, 1e-6, ABOVE, BELOW);
    check_kind(&kinds[TARGETS], 4, 1e-6 + 2.0 * target_error(&p.mesh), ABOVE, BELOW);
    check_kind(&kinds[CLIP], 4, 1e-5, ABOVE, BELOW); /* weights of 2^-22, floats of metres */
    assert_true(kinds[PAIRS].certified[3] == 0.0);
    free(pose);
    lod_pack_free(&p);
    model_free(m);
}

/* Two targets of these names: are they certified together? */
static void check_names(const char *left, const char *right, int expected)
{
    const lod_face shape = { 10, 8, 2, 0, 0 };
    const lod_settings settings = { 2, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    model *m = lod_face_model(&shape);
    lod_pack p;
    for (int i = 0; i < 2; i++) {
        free(m->meshes[0].targets[i].name);
        m->meshes[0].targets[i].name = model_string(i ? right : left);
    }
    lod_pack_make(m, &settings, 0, &p);
    if ((noh_mesh_at_lod(&p.mesh, 1).header->level_error_pairs > 0.0f) != expected) {
        fail_msg("'%s' and '%s' %s", left, right, expected ? "are a pair" : "are none");
    }
    lod_pack_free(&p);
    model_free(m);
}

static void pairs_are_told_by_name(void **state)
{
    static const char *const pairs[][2] = {
        { "smileLeft", "smileRight" },   { "eyebrows-left-up", "eyebrows-right-up" },
        { "LEFT_EYE", "RIGHT_EYE" },     { "blink_L", "blink_R" },
        { "sneerL", "sneerR" },          { "blink.l", "blink.r" },
        { "cheek.left", "cheek.right" }, { "leftward eyeLeft", "leftward eyeRight" }
    };
    static const char *const others[][2] = { { "smileLeft", "frownRight" },
                                             { "smileLeft", "smileRightUp" },
                                             { "smileLeft", "smile" },
                                             { "wheel", "wheer" },
                                             { "L", "R" },
                                             { "l", "r" },
                                             { "", "" },
                                             { "jaw", "jaw" },
                                             { "blink_L", "blink_r" } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(pairs); i++) {
        check_names(pairs[i][0], pairs[i][1], 1);
        check_names(pairs[i][1], pairs[i][0], 1);
    }
    for (size_t i = 0; i < TEST_COUNT(others); i++) {
        check_names(others[i][0], others[i][1], 0);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(pairs_are_told_by_name),
    cmocka_unit_test(a_face_is_as_near_as_certified),
    cmocka_unit_test(a_fitted_face_is_as_near_as_certified),
    cmocka_unit_test(a_face_with_virtual_joints_is_as_near_as_certified),
    cmocka_unit_test(a_tube_is_as_near_as_certified),
};

TEST_MAIN(tests, NULL, NULL)
