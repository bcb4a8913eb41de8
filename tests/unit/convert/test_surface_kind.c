/* Tests of tools/convert/model/surface_kind.c and surface_shape.c: which materials are skin, eyes, teeth and hair, by name
 * and by option; where irises and lids are found. */
#include "convert/model/surface_kind.h"
#include "convert/model/tint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "convert/model/strands.h"
#include "convert/model/surface_shape.h"
#include "noh/format.h"
#include "support/support.h"

static void names_tell_surfaces(void **state)
{
    static const struct {
        const char *name;
        uint32_t kind;
    } names[] = { { "skin", NOH_SURFACE_SKIN },
                  { "head_skin.001", NOH_SURFACE_SKIN },
                  { "N00_000_00_Body_00_SKIN (Instance)", NOH_SURFACE_SKIN },
                  { "Std_Skin_Head", NOH_SURFACE_SKIN },
                  { "Wolf3D_Skin", NOH_SURFACE_SKIN },
                  { "Haut", NOH_SURFACE_SKIN },
                  { "Кожа", NOH_SURFACE_SKIN },
                  { "КОЖА", NOH_SURFACE_SKIN },
                  { "顔肌", NOH_SURFACE_SKIN },
                  { "skinned", NOH_SURFACE_PLAIN },
                  { "snakeskin", NOH_SURFACE_PLAIN },
                  { "eyes", NOH_SURFACE_EYE },
                  { "EyeLeft", NOH_SURFACE_EYE },
                  { "Wolf3D_Eye", NOH_SURFACE_EYE },
                  { "F00_000_00_EyeIris_00_EYE", NOH_SURFACE_EYE },
                  { "Std_Cornea_L", NOH_SURFACE_EYE },
                  { "Cube Material (Eyes)", NOH_SURFACE_EYE },
                  { "Œil", NOH_SURFACE_PLAIN }, /* capital and small ligature are not of Latin-1 */
                  { "œil", NOH_SURFACE_EYE },
                  { "OJOS", NOH_SURFACE_EYE },
                  { "глаза", NOH_SURFACE_EYE },
                  { "瞳", NOH_SURFACE_EYE },
                  { "eyelashes", NOH_SURFACE_PLAIN },
                  { "Eye_Lash", NOH_SURFACE_PLAIN },
                  { "Std_Eye_Occlusion_L", NOH_SURFACE_PLAIN },
                  { "M_EyeBlend", NOH_SURFACE_PLAIN },
                  { "eyeshell_shader", NOH_SURFACE_PLAIN },
                  { "MI_EyeEdge", NOH_SURFACE_PLAIN },
                  { "eyebrows", NOH_SURFACE_PLAIN },
                  { "eye shadow", NOH_SURFACE_PLAIN },
                  { "睫毛", NOH_SURFACE_PLAIN },
                  { "teeth", NOH_SURFACE_TEETH },
                  { "Std_Tongue", NOH_SURFACE_TEETH },
                  { "Mouth", NOH_SURFACE_TEETH },
                  { "Zähne", NOH_SURFACE_TEETH },
                  { "ZÄHNE", NOH_SURFACE_TEETH },
                  { "зубы", NOH_SURFACE_TEETH },
                  { "舌", NOH_SURFACE_TEETH },
                  { "hair", NOH_SURFACE_HAIR },
                  { "Std_Hair", NOH_SURFACE_HAIR },
                  { "Wolf3D_Beard", NOH_SURFACE_HAIR },
                  { "N00_000_00_HairBack_00_HAIR", NOH_SURFACE_HAIR },
                  { "Haare", NOH_SURFACE_HAIR },
                  { "волосы", NOH_SURFACE_HAIR },
                  { "前髪", NOH_SURFACE_HAIR },
                  { "hairbrush", NOH_SURFACE_PLAIN },
                  { "hair_blend", NOH_SURFACE_HAIR },
                  { "eyebrow hair", NOH_SURFACE_PLAIN },
                  { "", NOH_SURFACE_PLAIN },
                  { "\xff\xc3", NOH_SURFACE_PLAIN } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(names); i++) {
        if (surface_kind_of_name(names[i].name) != names[i].kind) {
            fail_msg("'%s' is %u", names[i].name, surface_kind_of_name(names[i].name));
        }
    }
}

static void opaque_hair_is_plain(void **state)
{
    (void)state;
    assert_int_equal(surface_kind_by_name("hair", MODEL_ALPHA_OPAQUE), NOH_SURFACE_PLAIN);
    assert_int_equal(surface_kind_by_name("hair", MODEL_ALPHA_MASK), NOH_SURFACE_HAIR);
    assert_int_equal(surface_kind_by_name("hair", MODEL_ALPHA_BLEND), NOH_SURFACE_HAIR);
    assert_int_equal(surface_kind_by_name("skin", MODEL_ALPHA_OPAQUE), NOH_SURFACE_SKIN);
}

/* Stripes in a texture, twice as wide as high, tell where strands run; a chequered one does not. */
static void strands_run_along_stripes(void **state)
{
    static const float steps[][2] = { { 1.0f, 0.0f }, { 0.0f, 1.0f }, { 1.0f, 1.0f }, { 1.0f, -1.0f } };
    static uint8_t rgba[64 * 32 * 4];
    model_texture picture = { .width = 64, .height = 32, .rgba = rgba };
    model_material hair = model_material_default();
    model m = { .materials = &hair, .material_count = 1, .textures = &picture, .texture_count = 1 };
    (void)state;
    hair.surface = NOH_SURFACE_HAIR;
    hair.base_color_texture = 0;
    for (size_t i = 0; i <= TEST_COUNT(steps); i++) {
        double should[2] = { 0.0, 1.0 };
        for (uint32_t p = 0; p < 64u * 32u; p++) {
            const float x = (float)(p % 64u), y = (float)(p / 64u);
            const float wave = i < TEST_COUNT(steps) ? sinf(0.9f * (steps[i][0] * x + steps[i][1] * y))
                                                     : sinf(0.9f * x) * sinf(0.9f * y);
            memset(rgba + 4 * p, (int)(128.0f + 100.0f * wave), 3);
            rgba[4 * p + 3] = 255;
        }
        if (i < TEST_COUNT(steps)) { /* in texels, then in shares of the picture */
            const double along[2] = { -(double)steps[i][1] / 64.0, (double)steps[i][0] / 32.0 };
            const double length = hypot(along[0], along[1]);
            const double sign = (fabs(along[1]) >= fabs(along[0]) ? along[1] : along[0]) < 0.0 ? -1.0 : 1.0;
            for (int k = 0; k < 2; k++) should[k] = sign * along[k] / length;
        }
        strands_find(&m, NULL);
        for (int k = 0; k < 2; k++) assert_true(fabs((double)hair.surface_values[k] - should[k]) < 0.01);
    }
    hair.base_color_texture = MODEL_NONE;
    strands_find(&m, NULL);
    assert_true(hair.surface_values[0] == 0.0f && hair.surface_values[1] == 1.0f);
}

/* Each word has to belong to a bare part of the body. */
static void parts_of_a_body_are_bare(void **state)
{
    static const char *const bare[] = {
        "Head",  "head.001", "Wolf3D_Head", "M_Face_L",        "HeadLeft",     "Std_Neck 2", "顔",
        "顔_01", "Gesicht",  "FemaleHead",  "face (Instance)", "Std_Skin_Leg", "Haut",       "肌"
    };
    static const char *const others[] = { "",          "M",         "head_scarf",  "HeadLight",
                                          "Neck.Ring", "headlight", "face_mask",   "head hair",
                                          "頭巾",      "lid_face",  "Zombie_Skin", "snake skin",
                                          "hands" };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(bare); i++) {
        if (!surface_is_bare(bare[i])) fail_msg("'%s' is not bare", bare[i]);
    }
    for (size_t i = 0; i < TEST_COUNT(others); i++) {
        if (surface_is_bare(others[i])) fail_msg("'%s' is bare", others[i]);
    }
}

static void vroid_draws_toons(void **state)
{
    static const char *const names[] = { "N00_000_00_Body_00_SKIN (Instance)", "F00_000_00_EyeIris_00_EYE",
                                         "N00_000_Hair_00_HAIR", "N00_010_01_Onepiece_00_CLOTH_01 (Instance)" };
    static const char *const others[] = { "",
                                          "N00",
                                          "N00_000_",
                                          "N00_000_Lamp",
                                          "head_skin.001",
                                          "n00_000_00_Body_00_SKIN",
                                          "NN0_000_00_Body_00_SKIN",
                                          "Wolf3D_SKIN" };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(names); i++) assert_true(surface_is_of_vroid(names[i]));
    for (size_t i = 0; i < TEST_COUNT(others); i++) assert_false(surface_is_of_vroid(others[i]));
}

static void long_names_have_words_too(void **state)
{
    char name[4096];
    (void)state;
    memset(name, 'x', sizeof name - 1u);
    name[sizeof name - 1u] = 0;
    assert_int_equal(surface_kind_of_name(name), NOH_SURFACE_PLAIN);
    memcpy(name + sizeof name - 6u, " skin", 5);
    assert_int_equal(surface_kind_of_name(name), NOH_SURFACE_SKIN);
}

static model *model_of(const char *const *names, uint32_t count)
{
    model *m = model_new();
    m->materials = test_zeros(count * sizeof *m->materials);
    m->material_count = count;
    for (uint32_t i = 0; i < count; i++) {
        m->materials[i] = model_material_default();
        m->materials[i].name = model_string(names[i]);
    }
    return m;
}

/* What an author says of a shell counts more than its name. */
static void a_given_surface_keeps_a_shell(void **state)
{
    static const char *const names[] = { "Std_Tearline_R", "Std_Tearline_L" };
    model *m = model_of(names, 2);
    model_error error;
    (void)state;
    assert_int_equal(surface_kind_assign(m, "Std_Tearline_R=plain", &error), 0);
    assert_int_equal(surface_shells_set(m), 0);
    assert_int_equal(m->materials[0].alpha, MODEL_ALPHA_OPAQUE);
    assert_int_equal(m->materials[1].alpha, MODEL_ALPHA_BLEND);
    model_free(m);
}

static void options_name_a_material_and_a_surface(void **state)
{
    static const char *const names[] = { "face", "a=b", "face" };
    static const char *const refused[] = { "face", "face=leather", "faces=skin", "=skin", "face=", "" };
    model *m = model_of(names, 3);
    model_error error;
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(refused); i++) {
        memset(&error, 0, sizeof error);
        assert_int_equal(surface_kind_assign(m, refused[i], &error), 1);
        assert_non_null(strstr(error.what, "--surface"));
    }
    assert_int_equal(surface_kind_assign(m, "face=skin", &error), 0);
    assert_int_equal(surface_kind_assign(m, "a=b=eye", &error), 0);
    assert_int_equal(m->materials[0].surface, NOH_SURFACE_SKIN);
    assert_int_equal(m->materials[2].surface, NOH_SURFACE_SKIN);
    assert_int_equal(m->materials[1].surface, NOH_SURFACE_EYE);
    model_free(m);
}

/* A toon's numbers and textures mean something else on another surface. */
static void another_surface_forgets_the_toon(void **state)
{
    static const char *const names[] = { "cel" };
    model *m = model_of(names, 1);
    model_material *cel = &m->materials[0];
    (void)state;
    surface_kind_set(cel, NOH_SURFACE_TOON);
    assert_true(cel->surface_values[0] > 0.0f && cel->surface_more[0] > 0.0f);
    cel->toon_shade = cel->outline_lit = 1;
    cel->more_textures[NOH_TOON_MATCAP] = 0;
    surface_kind_set(cel, NOH_SURFACE_SKIN);
    assert_true(cel->surface_values[0] == 0.0f && cel->surface_more[0] == 0.0f);
    assert_true(!cel->toon_shade && !cel->outline_lit && cel->more_textures[NOH_TOON_MATCAP] == MODEL_NONE);
    model_free(m);
}

/* Who wears another robe keeps his face: skin, eyes and teeth take no tint, unless the author says so. */
static void faces_take_no_tint(void **state)
{
    static const char *const names[] = { "robe", "skin", "Auge", "N00_000_Face_00_SKIN", "eyelashes", "paint" };
    static const int by_name[] = { 1, 0, 0, 0, 1, 1 };
    static const char *const refused[] = { "robe", "robe=", "robe=yes", "robes=on", "=off", "" };
    model *m = model_of(names, 6);
    model_error error;
    (void)state;
    for (uint32_t i = 0; i < 6; i++) assert_int_equal(tint_is_taken(&m->materials[i]), by_name[i]);
    surface_kind_set(&m->materials[5], NOH_SURFACE_SKIN);
    assert_false(tint_is_taken(&m->materials[5])); /* by surface */
    surface_kind_set(&m->materials[3], NOH_SURFACE_TOON);
    assert_false(tint_is_taken(&m->materials[3])); /* a toon's face by its name */
    assert_int_equal(tint_assign(m, "skin=on", &error), 0);
    assert_int_equal(tint_assign(m, "robe=off", &error), 0);
    assert_true(tint_is_taken(&m->materials[1]));
    assert_false(tint_is_taken(&m->materials[0]));
    for (size_t i = 0; i < TEST_COUNT(refused); i++) {
        memset(&error, 0, sizeof error);
        assert_int_equal(tint_assign(m, refused[i], &error), 1);
        assert_non_null(strstr(error.what, "--tint"));
    }
    model_free(m);
}

/* What reflects as any plastic reflects as the surface; what was given stays. */
static void reflectance_follows_the_surface(void **state)
{
    model_material m = model_material_default();
    (void)state;
    surface_kind_set(&m, NOH_SURFACE_EYE);
    assert_true(fabsf(m.f0[1] - 0.025f) < 1e-6f);
    surface_kind_set(&m, NOH_SURFACE_SKIN);
    assert_true(fabsf(m.f0[1] - 0.028f) < 1e-6f);
    m.f0[1] = 0.06f;
    surface_kind_set(&m, NOH_SURFACE_PLAIN);
    assert_true(fabsf(m.f0[0] - 0.04f) < 1e-6f && m.f0[1] == 0.06f);
    m.unlit = 1;
    surface_kind_set(&m, NOH_SURFACE_EYE);
    assert_int_equal(m.surface, NOH_SURFACE_PLAIN);
}

/* ---- eyes ---- */

#define RINGS 48u
#define SIDES 48u
#define BALL ((RINGS + 1u) * SIDES)
#define IRIS 0.47 /* sine; between two rings */

typedef struct eye_spec {
    double x, turn; /* of the ball; of the gaze to the left, radians */
    double dark;    /* of the iris, over the white */
} eye_spec;

/* A ball about its gaze, whose vertex colours paint an iris. */
static void add_ball(model_mesh *mesh, const eye_spec *e)
{
    const uint32_t first = mesh->vertex_count;
    for (uint32_t i = 0; i < BALL; i++) {
        const double a = 3.14159265 * (i / SIDES + 0.001) / (RINGS + 0.002), b = 6.2831853 * (i % SIDES) / SIDES;
        const double n[3] = { sin(a) * cos(b), sin(a) * sin(b), cos(a) };
        const float luma = (float)(a < asin(IRIS) ? e->dark : 0.8);
        float *p = mesh->position + 3 * (size_t)mesh->vertex_count, *c = mesh->color + 4 * (size_t)mesh->vertex_count;
        p[0] = (float)(e->x + 0.012 * (n[0] * cos(e->turn) + n[2] * sin(e->turn)));
        p[1] = (float)(0.1 + 0.012 * n[1]);
        p[2] = (float)(0.012 * (n[2] * cos(e->turn) - n[0] * sin(e->turn)));
        c[0] = c[1] = c[2] = luma;
        c[3] = 1.0f;
        mesh->vertex_count++;
    }
    for (uint32_t i = 0; i < RINGS * SIDES; i++) {
        const uint32_t a = first + i, b = first + i / SIDES * SIDES + (i + 1u) % SIDES;
        const uint32_t quad[6] = { a, a + SIDES, b, b, a + SIDES, b + SIDES };
        memcpy(mesh->indices + mesh->index_count, quad, sizeof quad);
        mesh->index_count += 6;
    }
}

/* The opening's edge at a distance outwards from the middle. */
static double lid_at(int upper, double a)
{
    return upper ? 0.45 + 0.1 * a - 0.6 * a * a : -0.5 + 0.05 * a + 0.4 * a * a;
}

/* Strips around each eye, from the edges of its opening to half a radius beyond. */
static void add_lids(model_mesh *mesh, double x)
{
    enum { COLUMNS = 33 };
    for (int upper = 0; upper < 2; upper++) {
        const uint32_t first = mesh->vertex_count;
        for (int i = 0; i < COLUMNS * 2; i++) {
            const double a = -0.9 + 1.8 * (i / 2) / (COLUMNS - 1);
            const double e = lid_at(upper, a) + (i % 2 ? (upper ? 0.3 : -0.3) : 0.0);
            float *p = mesh->position + 3 * (size_t)mesh->vertex_count++;
            p[0] = (float)(x + 0.012 * (x < 0.0 ? -a : a));
            p[1] = (float)(0.1 + 0.012 * e);
            p[2] = (float)(0.012 * sqrt(fmax(1.21 - a * a - e * e, 0.2)));
        }
        for (uint32_t i = 0; i < COLUMNS * 2 - 2; i++) {
            const uint32_t triangle[3] = { first + i, first + i + 1u, first + i + 2u };
            memcpy(mesh->indices + mesh->index_count, triangle, sizeof triangle);
            mesh->index_count += 3;
        }
    }
}

static void end_part(model_mesh *mesh, uint32_t part)
{
    model_submesh *s = &mesh->submeshes[part];
    s->material = part;
    s->first_index = part ? mesh->submeshes[part - 1].first_index + mesh->submeshes[part - 1].index_count : 0u;
    s->first_vertex = part ? mesh->submeshes[part - 1].first_vertex + mesh->submeshes[part - 1].vertex_count : 0u;
    s->index_count = mesh->index_count - s->first_index;
    s->vertex_count = mesh->vertex_count - s->first_vertex;
}

static model *face_of(const eye_spec *eyes, uint32_t count, int lids)
{
    static const char *const names[] = { "eyes", "skin" };
    model *m = model_of(names, 2);
    model_mesh *mesh = m->meshes = test_zeros(sizeof *m->meshes);
    m->mesh_count = 1;
    mesh->name = model_string("face");
    mesh->position = test_zeros(3u * 8192u * sizeof *mesh->position);
    mesh->normal = test_zeros(3u * 8192u * sizeof *mesh->normal);
    mesh->color = test_zeros(4u * 8192u * sizeof *mesh->color);
    mesh->indices = test_zeros(6u * 8192u * sizeof *mesh->indices);
    mesh->submeshes = test_zeros(2u * sizeof *mesh->submeshes);
    mesh->submesh_count = 2;
    m->materials[0].surface = NOH_SURFACE_EYE;
    m->materials[1].surface = NOH_SURFACE_SKIN;
    for (uint32_t i = 0; i < count; i++) add_ball(mesh, &eyes[i]);
    end_part(mesh, 0);
    for (uint32_t i = 0; i < count && lids; i++) add_lids(mesh, eyes[i].x);
    end_part(mesh, 1);
    return m;
}

/* A node turns a mesh whose z is up. */
static void put_z_up(model *m)
{
    static const double world[16] = { 1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1 };
    m->nodes = test_zeros(sizeof *m->nodes);
    m->node_count = 1;
    m->nodes->parent = m->nodes->skin = MODEL_NONE;
    memcpy(m->nodes->world, world, sizeof world);
    for (uint32_t v = 0; v < m->meshes->vertex_count; v++) {
        float *p = m->meshes->position + 3u * v, y = p[1];
        p[1] = -p[2];
        p[2] = y;
    }
}

static void check_irises_and_lids(model *m, int front)
{
    const float *values = m->materials[0].surface_values, *more = m->materials[0].surface_more;
    model_error error;
    assert_int_equal(surface_shapes_find(m, 0, NULL, &error), 0);
    print_message("an iris of %.3f, %.3f is right\n", (double)values[3], IRIS);
    assert_true(fabs((double)values[3] - IRIS) <= 0.03);
    assert_true(fabs(fabs((double)values[front]) - 0.012 * IRIS) < 0.0004);
    assert_true(fabsf(values[0]) < 0.0002f && fabsf(values[3 - front]) < 0.0002f);
    for (int upper = 0; upper < 2; upper++) {
        const float *fit = more + (upper ? 0 : 3);
        for (int i = -5; i <= 5; i++) {
            const double a = 0.1 * i, found = (double)fit[0] + (double)fit[1] * a + (double)fit[2] * a * a;
            assert_true(fabs(found - lid_at(upper, a)) < 0.06);
        }
    }
    model_free(m);
}

static void irises_and_lids_are_found(void **state)
{
    static const eye_spec pair[2] = { { 0.03, 0.0, 0.1 }, { -0.03, 0.0, 0.1 } };
    model *m = face_of(pair, 2, 1);
    (void)state;
    check_irises_and_lids(m, 2);
    m = face_of(pair, 2, 1);
    put_z_up(m);
    check_irises_and_lids(m, 1);
}

/* An eye that looks aside has its iris there; two that squint have one between. */
static void irises_are_found_where_eyes_look(void **state)
{
    static const eye_spec aside[1] = { { 0.03, 0.3, 0.2 } };
    static const eye_spec squint[2] = { { 0.03, -0.1, 0.1 }, { -0.03, 0.1, 0.1 } };
    model *m = face_of(aside, 1, 0);
    const float *values = m->materials[0].surface_values;
    model_error error;
    (void)state;
    assert_int_equal(surface_shapes_find(m, 0, NULL, &error), 0);
    assert_true(fabs(atan2((double)values[0], (double)values[2]) - 0.3) < 0.03);
    for (int k = 0; k < 6; k++) assert_true(m->materials[0].surface_more[k] == 0.0f);
    model_free(m);
    m = face_of(squint, 2, 0);
    assert_int_equal(surface_shapes_find(m, 0, NULL, &error), 0);
    assert_true(fabsf(m->materials[0].surface_values[0]) < 0.0002f);
    model_free(m);
}

/* A white spot of 24 degrees, on the right of both irises, or on the white: of vertices that have been painted. */
static void paint_spot(model_mesh *mesh, double right)
{
    for (uint32_t v = 0; v < 2u * BALL; v++) {
        const float *p = mesh->position + 3 * (size_t)v;
        const double x = (double)p[0] - (v < BALL ? 0.03 : -0.03) - 0.012 * right, y = (double)p[1] - 0.1,
                     z = (double)p[2];
        for (size_t c = 0; c < 3 && z > 0.0 && sqrt(x * x + y * y) < 0.0025; c++) mesh->color[4 * (size_t)v + c] = 1.0f;
    }
}

/* An eye with a painted highlight mirrors no second one, unless its surface is given or looks are kept. A spot on the
 * white, or on an iris that is pale, is no highlight. */
static void a_painted_highlight_is_the_only_one(void **state)
{
    static const struct {
        double right, dark;
        int keep_looks, given, dull;
    } cases[] = { { 0.2, 0.1, 0, 0, 1 },
                  { 0.2, 0.1, 1, 0, 0 },
                  { 0.2, 0.1, 0, 1, 0 },
                  { 0.75, 0.1, 0, 0, 0 },
                  { 0.2, 0.4, 0, 0, 0 } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        const eye_spec pair[2] = { { 0.03, 0.0, cases[i].dark }, { -0.03, 0.0, cases[i].dark } };
        model *m = face_of(pair, 2, 0);
        model_error error;
        paint_spot(m->meshes, cases[i].right);
        m->materials[0].surface_given = (uint8_t)cases[i].given;
        for (int c = 0; c < 3; c++) m->materials[0].f0[c] = 0.04f;
        assert_int_equal(surface_shapes_find(m, cases[i].keep_looks, NULL, &error), 0);
        assert_true((m->materials[0].f0[0] == 0.0f) == cases[i].dull);
        assert_int_equal(m->warning_count, cases[i].dull);
        model_free(m);
    }
}

/* The normals of an eye at x = 0.03: a bulge of 1 bends them as a cornea does. Returns the farthest from the ball's. */
static double bend_normals(model_mesh *mesh, double bulge, int set)
{
    double farthest = 0.0;
    for (uint32_t v = 0; v < BALL; v++) {
        const float *p = mesh->position + 3 * (size_t)v;
        float *n = mesh->normal + 3 * (size_t)v;
        const double way[3] = { ((double)p[0] - 0.03) / 0.012, ((double)p[1] - 0.1) / 0.012, (double)p[2] / 0.012 };
        const double bend = way[2] > cos(0.6) ? 1.0 + 0.8 * bulge : 1.0;
        const double bent[3] = { bend * way[0], bend * way[1], way[2] };
        const double length = sqrt(bent[0] * bent[0] + bent[1] * bent[1] + bent[2] * bent[2]);
        for (int c = 0; c < 3; c++) {
            if (set) n[c] = (float)(bent[c] / length);
            if (way[2] > 0.6) farthest = fmax(farthest, fabs((double)n[c] - way[c]));
        }
    }
    return farthest;
}

/* A cornea that the mesh itself has is levelled, because shaders bend the ball's normals; small bumps stay. */
static void a_cornea_does_not_mirror_twice(void **state)
{
    static const eye_spec one[1] = { { 0.03, 0.0, 0.1 } };
    (void)state;
    for (int i = 0; i < 2; i++) {
        model *m = face_of(one, 1, 0);
        model_error error;
        const double bent = bend_normals(m->meshes, i ? 1.0 : 0.1, 1);
        assert_int_equal(surface_shapes_find(m, 0, NULL, &error), 0);
        const double left = bend_normals(m->meshes, 0.0, 0);
        print_message("normals bent by %.3f: %.3f is left\n", bent, left);
        assert_true(i ? bent > 0.2 && left < 0.01 : left == bent);
        model_free(m);
    }
}

/* A ball of one colour is wet, and no more. */
static void a_ball_without_an_iris_has_none(void **state)
{
    static const eye_spec blank[2] = { { 0.03, 0.0, 0.8 }, { -0.03, 0.0, 0.8 } };
    model *m = face_of(blank, 2, 1);
    model_error error;
    (void)state;
    assert_int_equal(surface_shapes_find(m, 0, NULL, &error), 0);
    for (int k = 0; k < 4; k++) assert_true(m->materials[0].surface_values[k] == 0.0f);
    model_free(m);
}

/* What stands in front of eyes and is opaque would blind them; what its author blends stays. */
static void shells_of_eyes_do_not_hide_them(void **state)
{
    static const struct {
        const char *name;
        model_alpha alpha, then;
        float opacity;
    } cases[] = { { "Std_Eye_Occlusion_L", MODEL_ALPHA_OPAQUE, MODEL_ALPHA_BLEND, 0.2f },
                  { "M_EyeOcclusion", MODEL_ALPHA_OPAQUE, MODEL_ALPHA_BLEND, 0.2f },
                  { "eyeocclusion", MODEL_ALPHA_OPAQUE, MODEL_ALPHA_BLEND, 0.2f },
                  { "Std_Tearline_R", MODEL_ALPHA_OPAQUE, MODEL_ALPHA_BLEND, 0.0f },
                  { "eyeshell_shader", MODEL_ALPHA_OPAQUE, MODEL_ALPHA_BLEND, 0.2f },
                  { "Lacrimal fluid", MODEL_ALPHA_OPAQUE, MODEL_ALPHA_BLEND, 0.0f },
                  { "M_EyeBlend", MODEL_ALPHA_OPAQUE, MODEL_ALPHA_BLEND, 0.0f },
                  { "eyeEdge_shader", MODEL_ALPHA_OPAQUE, MODEL_ALPHA_BLEND, 0.0f },
                  { "saliva_shader", MODEL_ALPHA_OPAQUE, MODEL_ALPHA_BLEND, 0.0f },
                  { "Std_Eye_Occlusion_L", MODEL_ALPHA_BLEND, MODEL_ALPHA_BLEND, 1.0f },
                  { "blade_edge", MODEL_ALPHA_OPAQUE, MODEL_ALPHA_OPAQUE, 1.0f },
                  { "Material_Blend", MODEL_ALPHA_OPAQUE, MODEL_ALPHA_OPAQUE, 1.0f },
                  { "occlusion", MODEL_ALPHA_OPAQUE, MODEL_ALPHA_OPAQUE, 1.0f },
                  { "eyes", MODEL_ALPHA_OPAQUE, MODEL_ALPHA_OPAQUE, 1.0f },
                  { "eyelashes", MODEL_ALPHA_OPAQUE, MODEL_ALPHA_OPAQUE, 1.0f } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        model_material material = model_material_default();
        model m = { .material_count = 1, .materials = &material };
        material.name = (char *)(uintptr_t)cases[i].name;
        material.alpha = cases[i].alpha;
        const int changes = cases[i].alpha != cases[i].then;
        assert_int_equal(surface_shells_set(&m), 0);
        assert_int_equal(material.alpha, cases[i].then);
        assert_true(material.base_color[3] == cases[i].opacity && (material.base_color[0] == 0.0f) == changes);
        assert_int_equal(m.warning_count, changes);
        for (uint32_t k = 0; k < m.warning_count; k++) free(m.warnings[k]);
        free(m.warnings);
    }
}

/* A material of eyes alone is theirs; what others have, too, and what is seen through, stays. */
static void objects_name_eyes(void **state)
{
    static const struct {
        const char *nodes[2], *mesh;
        model_alpha alpha;
        uint32_t given, kind;
        const char *material; /* NULL: Material.003 */
        float metallic;
    } cases[] = { { { "Eye.L", "Eye.R" }, "Sphere", MODEL_ALPHA_OPAQUE, 0, NOH_SURFACE_EYE, NULL, 0.0f },
                  { { "Object", "Object.001" }, "eyeball", MODEL_ALPHA_OPAQUE, 0, NOH_SURFACE_EYE, NULL, 0.0f },
                  { { "Eye.L", "Button" }, "Sphere", MODEL_ALPHA_OPAQUE, 0, NOH_SURFACE_PLAIN, NULL, 0.0f },
                  { { "Eye.L", "Eye.R" }, "Sphere", MODEL_ALPHA_BLEND, 0, NOH_SURFACE_PLAIN, NULL, 0.0f },
                  { { "Eye.L", "Eye.R" }, "Sphere", MODEL_ALPHA_OPAQUE, 1, NOH_SURFACE_PLAIN, NULL, 0.0f },
                  { { "Eyelid.L", "Eyelid.R" }, "Sphere", MODEL_ALPHA_OPAQUE, 0, NOH_SURFACE_PLAIN, NULL, 0.0f },
                  { { "Eye.L", "Eye.R" }, "Sphere", MODEL_ALPHA_OPAQUE, 0, NOH_SURFACE_PLAIN, "Eyelashes", 0.0f },
                  { { "Eye.L", "Eye.R" }, "Sphere", MODEL_ALPHA_OPAQUE, 0, NOH_SURFACE_PLAIN, "hair", 0.0f },
                  { { "Eye.L", "Eye.R" }, "Sphere", MODEL_ALPHA_OPAQUE, 0, NOH_SURFACE_PLAIN, NULL, 1.0f } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        model_material material = model_material_default();
        model_submesh part = { .material = 0 };
        model_mesh mesh = { .name = (char *)(uintptr_t)cases[i].mesh, .submesh_count = 1, .submeshes = &part };
        model_node nodes[2] = { { .mesh = 0 }, { .mesh = 0 } };
        model m = { .material_count = 1, .materials = &material, .mesh_count = 1, .meshes = &mesh, .node_count = 2 };
        m.nodes = nodes;
        for (int n = 0; n < 2; n++) nodes[n].name = (char *)(uintptr_t)cases[i].nodes[n];
        material.name = (char *)(uintptr_t)(cases[i].material ? cases[i].material : "Material.003");
        material.metallic = cases[i].metallic;
        material.alpha = cases[i].alpha;
        material.surface_given = (uint8_t)cases[i].given;
        assert_int_equal(surface_kinds_of_objects(&m), 0);
        assert_int_equal(material.surface, cases[i].kind);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_tell_surfaces),
        cmocka_unit_test(opaque_hair_is_plain),
        cmocka_unit_test(strands_run_along_stripes),
        cmocka_unit_test(long_names_have_words_too),
        cmocka_unit_test(options_name_a_material_and_a_surface),
        cmocka_unit_test(parts_of_a_body_are_bare),
        cmocka_unit_test(a_given_surface_keeps_a_shell),
        cmocka_unit_test(vroid_draws_toons),
        cmocka_unit_test(another_surface_forgets_the_toon),
        cmocka_unit_test(faces_take_no_tint),
        cmocka_unit_test(reflectance_follows_the_surface),
        cmocka_unit_test(irises_and_lids_are_found),
        cmocka_unit_test(irises_are_found_where_eyes_look),
        cmocka_unit_test(a_painted_highlight_is_the_only_one),
        cmocka_unit_test(a_ball_without_an_iris_has_none),
        cmocka_unit_test(a_cornea_does_not_mirror_twice),
        cmocka_unit_test(shells_of_eyes_do_not_hide_them),
        cmocka_unit_test(objects_name_eyes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
