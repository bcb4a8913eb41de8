/* test_skin_mirror.c: what joints mirror faces outward, with the tangent frames that the file's own matrices give; what
 * joints shrink has a warning. */
#include "support/octahedra.h"

#include "convert/model/affine.h"
#include "convert/sources.h"

#define SKIN                                                                                                  \
    ",\"skins\":[{\"joints\":[1,2],\"inverseBindMatrices\":6}],\"scenes\":[{\"nodes\":[0]}],\"scene\":0,"     \
    "\"meshes\":[{\"name\":\"m\",\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TANGENT\":2," \
    "\"JOINTS_0\":3,\"WEIGHTS_0\":4},\"indices\":5,\"targets\":[{\"POSITION\":7}]}]}]"

typedef struct rig {
    const char *nodes;
    float binds[OCTAHEDRA_MAX]; /* x scales of the inverse bind matrices */
    int warns;
} rig;

static source read_rig(const rig *r, octahedra *o)
{
    const source_options options = { .unit_cm = 1.0 };
    model_error error;
    char json[2048];
    source s;
    octahedra_make(o, r->binds);
    snprintf(json, sizeof json, "%s" SKIN, r->nodes);
    if (source_read(octahedra_write(o, OCTAHEDRA_MAX, "rig", json), &options, &s, &error)) fail_msg("%s", error.what);
    return s;
}

static void multiply(const double m[16], const float *v, double w, double out[3])
{
    for (int r = 0; r < 3; r++) out[r] = m[r] * v[0] + m[4 + r] * v[1] + m[8 + r] * v[2] + m[12 + r] * w;
}

static void skin_matrix(const model *m, const float *bind, uint32_t node, double out[16])
{
    double b[16];
    affine_of_floats(bind, b);
    affine_multiply(m->nodes[node].world, b, out);
}

/* As deform.h says: the bitangent's direction after skinning. */
static void skinned_bitangent(const double m[16], const float *normal, const float *tangent, double out[3])
{
    const double side = affine_determinant(m) < 0.0 ? -1.0 : 1.0;
    double cofactors[9], n[3], t[3];
    affine_cofactors(m, cofactors);
    multiply(m, tangent, 0.0, t);
    for (int r = 0; r < 3; r++) {
        n[r] = side * (cofactors[r] * normal[0] + cofactors[3 + r] * normal[1] + cofactors[6 + r] * normal[2]);
    }
    for (int r = 0; r < 3; r++) {
        const int a = (r + 1) % 3, b = (r + 2) % 3;
        out[r] = side * (double)tangent[3] * (n[a] * t[b] - n[b] * t[a]);
    }
}

static void expect_near(const double *got, const double *want, double scale)
{
    for (int i = 0; i < 3; i++) {
        if (!(fabs(got[i] - want[i]) <= 1e-5 * scale)) {
            fail_msg("component %d is %g, not %g", i, got[i], want[i]);
        }
    }
}

/* Vertices keep their order: each is posed where the file poses it, moved by the target as there, with its bitangent
 * where the file's matrix takes it. */
static void expect_vertices(const model *m, const octahedra *o)
{
    const model_mesh *mesh = &m->meshes[0];
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const uint32_t k = v / OCTAHEDRON_VERTICES;
        const float *n = o->normal[v], *t = o->tangent[v];
        const float bitangent[3] = { n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0] };
        double file[16], made[16], got[3], want[3], length = 0.0, wanted = 0.0;
        skin_matrix(m, o->binds[k], 1u + k, file);
        skin_matrix(m, m->skins[0].inverse_bind + 16u * k, 1u + k, made);
        multiply(file, o->position[v], 1.0, want);
        multiply(made, mesh->position + 3u * v, 1.0, got);
        expect_near(got, want, 10.0);
        multiply(file, o->moved[v], 0.0, want);
        multiply(made, mesh->targets[0].position + 3u * v, 0.0, got);
        expect_near(got, want, 10.0);
        multiply(file, bitangent, 0.0, want);
        skinned_bitangent(made, mesh->normal + 3u * v, mesh->tangent + 4u * v, got);
        for (int i = 0; i < 3; i++) length += got[i] * got[i], wanted += got[i] * want[i];
        assert_true(length > 0.0 && wanted > 0.0);
    }
}

/* Each octahedron's volume, by its triangles: above 0 where they face outward. */
static void expect_outward(const model *m)
{
    const model_mesh *mesh = &m->meshes[0];
    double volumes[OCTAHEDRA_MAX] = { 0.0 };
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        double p[3][3];
        uint32_t k = mesh->indices[i] / OCTAHEDRON_VERTICES;
        for (uint32_t c = 0; c < 3; c++) {
            double made[16];
            skin_matrix(m, m->skins[0].inverse_bind + 16u * k, 1u + k, made);
            multiply(made, mesh->position + 3u * mesh->indices[i + c], 1.0, p[c]);
        }
        for (int c = 0; c < 3; c++) {
            const int a = (c + 1) % 3, b = (c + 2) % 3;
            volumes[k] += p[0][c] * (p[1][a] * p[2][b] - p[1][b] * p[2][a]) / 6.0;
        }
    }
    for (uint32_t k = 0; k < OCTAHEDRA_MAX; k++) {
        if (!(volumes[k] > 0.1)) fail_msg("octahedron %u has a volume of %g", (unsigned)k, volumes[k]);
    }
}

#define NODES(root, a, b)                                                                                  \
    ",\"nodes\":[{\"name\":\"root\"" root ",\"children\":[1,2,3]},{\"name\":\"a\"" a "},{\"name\":\"b\"" b \
    "},{\"name\":\"m\",\"mesh\":0,\"skin\":0}]"

static const rig rigs[] = {
    { NODES("", "", ""), { 1, 1 }, 0 },
    { NODES(",\"scale\":[-1,1,1]", "", ""), { 1, 1 }, 0 },
    { NODES(",\"scale\":[2,-0.5,3],\"rotation\":[0.6,0,0,0.8]", "", ""), { 1, 1 }, 0 },
    { NODES(",\"matrix\":[0,0,-1,0,0,-1,0,0,-1,0,0,0,1,2,3,1]", "", ""), { 1, 1 }, 0 },
    { NODES("", "", ""), { -1, -1 }, 0 },
    { NODES(",\"scale\":[-1,-1,-1]", "", ""), { -1, -1 }, 0 },
    { NODES("", ",\"scale\":[-1,1,1]", ",\"scale\":[1,1,-1]"), { 1, 1 }, 0 },
    { NODES("", ",\"scale\":[1,1,-1]", ""), { -1, 1 }, 0 },
    { NODES("", "", ",\"scale\":[1,-1,1]"), { 1, 1 }, 1 },
    { NODES("", "", ""), { -1, 1 }, 1 },
    { NODES(",\"scale\":[-1,1,1]", "", ""), { 1, -2 }, 1 },
};

static void what_joints_mirror_faces_outward(void **state)
{
    static octahedra o;
    (void)state;
    for (uint32_t i = 0; i < TEST_COUNT(rigs); i++) {
        source s = read_rig(&rigs[i], &o);
        int warned = 0;
        for (uint32_t w = 0; w < s.m->warning_count; w++) warned |= strstr(s.m->warnings[w], "joints mirror") != NULL;
        print_message("# rig %u\n", (unsigned)i);
        expect_vertices(s.m, &o);
        expect_outward(s.m);
        assert_int_equal(warned, rigs[i].warns);
        source_free(&s);
    }
}

/* A joint that shrinks what it was bound to has a warning; one of another size from the start is not, nor a hidden one. */
static void joints_that_shrink_have_a_warning(void **state)
{
    static const rig sizes[] = {
        { NODES("", ",\"scale\":[0.01,0.01,0.01]", ""), { 1, 1 }, 1 },
        { NODES("", "", ",\"scale\":[1e-9,1e-9,1e-9]"), { 1, 1 }, 0 },
        { NODES("", "", ",\"scale\":[0,0,0]"), { 1, 1 }, 0 },
        { NODES(",\"scale\":[0.01,0.01,0.01]", "", ""), { 1, 1 }, 0 },
        { NODES(",\"scale\":[0,0,0]", "", ""), { 1, 1 }, 0 },
        { NODES("", ",\"scale\":[0.1,0.1,0.1]", ""), { 1, 1 }, 0 },
    };
    static octahedra o;
    (void)state;
    for (uint32_t i = 0; i < TEST_COUNT(sizes); i++) {
        source s = read_rig(&sizes[i], &o);
        int warned = 0;
        for (uint32_t w = 0; w < s.m->warning_count; w++) {
            const char *text = strstr(s.m->warnings[w], "at rest joint ");
            if (!text) continue;
            warned = 1;
            assert_non_null(strstr(text, "joint 'a' and 0 more show what follows them 100 times"));
        }
        print_message("# rig %u\n", (unsigned)i);
        assert_int_equal(warned, sizes[i].warns);
        source_free(&s);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(what_joints_mirror_faces_outward),
    cmocka_unit_test(joints_that_shrink_have_a_warning),
};

TEST_MAIN(tests, NULL, NULL)
