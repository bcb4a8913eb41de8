/* test_obj_read.c: .obj files and folders of targets, written here. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "convert/obj/obj_polygon.h"
#include "convert/obj/obj_read.h"
#include "noh/format.h"

static void save(const char *name, const char *text)
{
    test_write_file(test_path(name), text, strlen(text));
}

static model *load_with(const char *text, const obj_options *options)
{
    model *m = NULL;
    model_error error = { "", "" };
    save("face.obj", text);
    if (obj_read(test_path("face.obj"), options, &m, &error)) fail_msg("refused: %s (%s)", error.what, error.where);
    return m;
}

static model *load(const char *text)
{
    const obj_options plain = { 0.0, NULL };
    return load_with(text, &plain);
}

static void refused(const char *text, const char *what, const char *where)
{
    const obj_options plain = { 0.0, NULL };
    model *m = (model *)1;
    model_error error = { "", "" };
    save("face.obj", text);
    assert_int_equal(obj_read(test_path("face.obj"), &plain, &m, &error), 1);
    assert_null(m);
    if (!strstr(error.what, what) || strcmp(error.where, where) != 0)
        fail_msg("expected '%s' at '%s', got '%s' at '%s'", what, where, error.what, error.where);
}

static int has_warning(const model *m, const char *text)
{
    for (uint32_t i = 0; i < m->warning_count; i++)
        if (strstr(m->warnings[i], text)) return 1;
    return 0;
}

/* ---- the model ---- */

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

/* The areas of a polygon's triangles, seen along z: added up with their signs, and without. */
static void areas_of(const char *text, double *sum, double *sizes)
{
    model *m = load(text);
    const model_mesh *mesh = m->meshes;
    *sum = *sizes = 0.0;
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        const float *a = mesh->position + 3 * mesh->indices[i], *b = mesh->position + 3 * mesh->indices[i + 1],
                    *c = mesh->position + 3 * mesh->indices[i + 2];
        const double area = 0.5 * ((double)(b[0] - a[0]) * (double)(c[1] - a[1]) -
                                   (double)(b[1] - a[1]) * (double)(c[0] - a[0]));
        *sum += area;
        *sizes += fabs(area);
    }
    model_free(m);
}

/* A polygon's text: its corners in a plane, first corner `from`, backwards or not, tilted. */
static void write_polygon(const double (*at)[2], uint32_t count, uint32_t from, int backwards, char *text, size_t room)
{
    size_t used = 0;
    for (uint32_t i = 0; i < count; i++) {
        used += (size_t)snprintf(text + used, room - used, "v %.9g %.9g %.9g\n", at[i][0], at[i][1],
                                 0.7 * at[i][0] - 0.4 * at[i][1]);
    }
    used += (size_t)snprintf(text + used, room - used, "f");
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t k = (from + (backwards ? count - i : i)) % count;
        used += (size_t)snprintf(text + used, room - used, " %u", (unsigned)k + 1u);
    }
    snprintf(text + used, room - used, "\n");
}

static void expect_cut(const double (*at)[2], uint32_t count)
{
    double area = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const double *a = at[i], *b = at[(i + 1) % count];
        area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
    for (uint32_t from = 0; from < 2 * count; from++) {
        static char text[65536];
        double sum, sizes;
        write_polygon(at, count, from % count, from >= count, text, sizeof text);
        areas_of(text, &sum, &sizes);
        if (!(fabs(sum - (from >= count ? -area : area)) < 1e-4 * area && sizes < area * 1.0001))
            fail_msg("first corner %u: %g and %g, not %g", (unsigned)from, sum, sizes, area);
    }
}

/* Their triangles cover them once, whichever corner comes first. */
static void concave_polygons_are_cut(void **state)
{
    static const double arrow[4][2] = { { 0, 0 }, { 2, 1 }, { 0, 2 }, { 0.5, 1 } };
    static const double comb[11][2] = { { 0, 0 }, { 5, 0 }, { 5, 2 }, { 4, 2 }, { 4, 1 }, { 3, 1 },
                                        { 3, 2 }, { 2, 2 }, { 2, 1 }, { 1, 1 }, { 0, 2 } };
    static const double ring[10][2] = { { 0, 0 }, { 4, 0 }, { 4, 4 }, { 0, 4 }, { 0, 0 },
                                        { 1, 1 }, { 1, 3 }, { 3, 3 }, { 3, 1 }, { 1, 1 } };
    double spiral[120][2], star[40][2];
    (void)state;
    for (int i = 0; i < 60; i++) {
        const double angle = 0.3 * i, radius = 1.0 + 0.1 * i;
        for (int side = 0; side < 2; side++) {
            double *p = spiral[side ? 119 - i : i];
            p[0] = (radius + (side ? 0.0 : 0.8)) * cos(angle);
            p[1] = (radius + (side ? 0.0 : 0.8)) * sin(angle);
        }
    }
    for (int i = 0; i < 40; i++) {
        star[i][0] = (i % 2 ? 1.0 : 4.0) * cos(0.157079632679 * i);
        star[i][1] = (i % 2 ? 1.0 : 4.0) * sin(0.157079632679 * i);
    }
    expect_cut(arrow, 4);
    expect_cut(comb, 11);
    expect_cut(ring, 10);
    expect_cut((const double(*)[2])spiral, 120);
    expect_cut((const double(*)[2])star, 40);
}

/* Corners in one line but one: no triangle has an area, but each step that looks for an ear counts. */
static void search_for_ears_is_counted(void **state)
{
    enum { CORNERS = 1000 };
    static float points[CORNERS][3];
    static uint32_t triangles[CORNERS - 2][3];
    uint64_t steps = OBJ_CUT_STEPS;
    (void)state;
    for (uint32_t i = 0; i < CORNERS; i++) points[i][0] = (float)(i * 7u % 11u);
    points[0][1] = points[2][1] = 1.0f;
    assert_int_equal(obj_polygon_cut(points[0], CORNERS, triangles[0], &steps), 0);
    assert_true(OBJ_CUT_STEPS - steps > CORNERS * CORNERS / 2);
}

/* The time that a file's concave polygons may take is limited: more have a fan, and a file of such a face alone is
 * refused. */
static void time_to_cut_polygons_is_limited(void **state)
{
    enum { CORNERS = 66000 };
    static const float arrow[12] = { 0, 0, 0, 0, 2, 0, 2, 1, 0, 0.5f, 1, 0 };
    uint32_t triangles[6], fan[6] = { 0, 1, 2, 0, 2, 3 };
    uint64_t steps = 16;
    char *text = malloc(CORNERS * 24u), *end = text;
    (void)state;
    assert_non_null(text);
    assert_int_equal(obj_polygon_cut(arrow, 4, triangles, &steps), 0);
    assert_memory_not_equal(triangles, fan, sizeof fan);
    assert_int_equal(obj_polygon_cut(arrow, 4, triangles, &steps), 2);
    assert_memory_equal(triangles, fan, sizeof fan);
    for (int i = 0; i < CORNERS; i++) end += sprintf(end, "v %d %d 0\n", i, i % 7 * (i % 7) % 5);
    end += sprintf(end, "f");
    for (int i = 0; i < CORNERS; i++) end += sprintf(end, " %d", i + 1);
    refused(text, "the concave faces up to this one, which has 66000 corners, take too long to cut", "line 66001");
    free(text);
}

/* What crosses itself, or has no area, has as many triangles as any other. */
static void broken_polygons_are_cut_somehow(void **state)
{
    static const char *const faces[] = { "f 1 3 2 4", "f 1 1 1 1 1", "f 1 2 1 2 3", "f 1 3 5 2 4", "f 4 3 2 1 1 2 3" };
    static const uint32_t triangles[] = { 2, 3, 3, 3, 5 };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(faces); i++) {
        char text[256];
        model *m;
        snprintf(text, sizeof text, SQUARE "v 0.5 1.6 0\n%s\n", faces[i]);
        m = load(text);
        assert_int_equal(m->meshes[0].index_count, 3 * triangles[i]);
        model_free(m);
    }
}

static void polygons_are_fans(void **state)
{
    (void)state;
    const uint32_t expected[9] = { 0, 1, 2, 0, 2, 3, 0, 3, 4 };
    model *m = load("# five corners\n" SQUARE "v -0.5 0.5 0\ng any\ns off\nf 1 2 3 4 5\n");
    const float up[3] = { 0, 0, 1 };
    assert_int_equal(m->mesh_count, 1);
    assert_string_equal(m->meshes[0].name, "face");
    assert_int_equal(m->meshes[0].vertex_count, 5);
    assert_int_equal(m->meshes[0].index_count, 9);
    assert_memory_equal(m->meshes[0].indices, expected, sizeof expected);
    assert_memory_equal(m->meshes[0].normal, up, sizeof up);
    assert_null(m->meshes[0].uv);
    assert_null(m->meshes[0].color);
    assert_int_equal(m->warning_count, 0);
    model_free(m);
}

/* A corner is a vertex of its own where UV or normal differ. V counts from the bottom. */
static void corners_become_vertices(void **state)
{
    (void)state;
    model *m = load(SQUARE "vt 0 0\nvt 1 0.25\nvn 0 0 1\nvn 0 0 2\n"
                           "f 1/1/1 2/2/1 3/2/1\nf 1/1/1 3/2/1 4/1/1\nf -4/-2/-2 -2/-1/-1 -1/-2/-2\n");
    const model_mesh *mesh = &m->meshes[0];
    assert_int_equal(mesh->vertex_count, 5); /* position 3 has two normals */
    assert_true(mesh->uv[0] == 0.0f && mesh->uv[1] == 1.0f && mesh->uv[3] == 0.75f);
    assert_true(mesh->normal[14] == 1.0f); /* made unit */
    assert_int_equal(mesh->indices[6], 0);
    assert_int_equal(mesh->indices[7], 4);
    assert_non_null(mesh->tangent);
    model_free(m);
}

static void materials_are_submeshes(void **state)
{
    (void)state;
    save("face.mtl",
         "newmtl skin\nKd 0.5 0.25 1\nNs 6\nmap_Kd -bm 1 nowhere.png\nnewmtl unused\nKd 1 0 0\nnewmtl glass\n"
         "Tr 0.75\n");
    model *m = load("mtllib face.mtl\n" SQUARE
                    "f 1 2 3\nusemtl glass\nf 1 2 3\nusemtl skin\nf 1 3 4\nusemtl glass\nf 1 3 4\n");
    const model_mesh *mesh = &m->meshes[0];
    assert_int_equal(mesh->submesh_count, 3);
    assert_int_equal(mesh->submeshes[0].material, MODEL_NONE);
    assert_int_equal(mesh->submeshes[1].index_count, 6);
    assert_int_equal(mesh->submeshes[1].first_vertex, 3);
    assert_int_equal(m->material_count, 2);
    const model_material *glass = &m->materials[0], *skin = &m->materials[1];
    assert_string_equal(glass->name, "glass");
    assert_true(glass->alpha == MODEL_ALPHA_BLEND && glass->base_color[3] == 0.25f);
    assert_true(skin->base_color[1] == 0.25f && skin->metallic == 0.0f && skin->surface == NOH_SURFACE_SKIN);
    assert_true(fabs((double)skin->roughness - sqrt(0.5)) < 1e-6);
    assert_true(has_warning(m, "material 'skin': the texture nowhere.png was left out"));
    model_free(m);
}

/* What would be invisible was written by an exporter that takes Tr for the opacity. */
static void nothing_is_invisible(void **state)
{
    (void)state;
    save("face.mtl", "newmtl a\nTr 1\nnewmtl b\nd 1\nTr 1\n");
    model *m = load("mtllib face.mtl\n" SQUARE "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n");
    for (uint32_t i = 0; i < 2; i++) {
        assert_true(m->materials[i].base_color[3] == 1.0f && m->materials[i].alpha == MODEL_ALPHA_OPAQUE);
    }
    assert_true(has_warning(m, "material 'a': its opacity is 0 (d 0 or Tr 1), and it was taken as opaque"));
    model_free(m);
}

/* Files from Windows name their materials, pictures and folders in another case, and with other slashes. */
static void names_differ_in_case(void **state)
{
    static const unsigned char tga[] = { 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 24, 0, 30, 20, 10 };
    (void)state;
    test_write_file(test_path("skin_case.TGA"), tga, sizeof tga);
    (void)mkdir(test_path("Maps"), 0777);
    test_write_file(test_path("Maps/wood.tga"), tga, sizeof tga);
    save("face.mtl", "newmtl a\nmap_Kd C:\\art\\Skin_Case.tga\nnewmtl b\nmap_Kd SKIN_CASE.tga\nnewmtl c\nmap_Kd "
                     "maps/Wood.TGA\nnewmtl d\nmap_Kd maps\\wood.tga\n");
    save("Maps/deep.mtl", "newmtl a\nmap_Kd Maps/wood.tga\n");
    model *m = load("mtllib Face.MTL\n" SQUARE
                    "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\nusemtl c\nf 1 3 4\nusemtl d\nf 1 3 4\n");
    assert_int_equal(m->texture_count, 4);
    for (uint32_t i = 0; i < 4; i++) assert_true(m->textures[i].rgba[0] == 10);
    model_free(m);
    m = load("mtllib maps\\Deep.mtl\n" SQUARE "usemtl a\nf 1 2 3\n");
    assert_int_equal(m->texture_count, 1);
    model_free(m);
    test_write_file(test_path("art\\Flat.tga"), tga, sizeof tga); /* one name, as some programs unpack an archive */
    save("face.mtl", "newmtl a\nmap_Kd Art\\flat.tga\n");
    m = load("mtllib face.mtl\n" SQUARE "usemtl a\nf 1 2 3\n");
    assert_int_equal(m->texture_count, 1);
    model_free(m);
}

/* A path that does not fit is not cut to another one. */
static void long_names_are_left_out(void **state)
{
    static char text[16384];
    static char name[5001];
    (void)state;
    memset(name, 'a', sizeof name - 1);
    (void)snprintf(text, sizeof text, "newmtl a\nmap_Kd %s\n", name);
    save("face.mtl", text);
    model *m = load("mtllib face.mtl\n" SQUARE "usemtl a\nf 1 2 3\n");
    assert_true(has_warning(m, "was left out: its name is longer than the 4095 bytes of a path"));
    model_free(m);
    (void)snprintf(text, sizeof text, "mtllib %s\n" SQUARE "usemtl a\nf 1 2 3\n", name);
    m = load(text);
    assert_true(has_warning(m, "were left out: its name is longer than the 4095 bytes of a path"));
    model_free(m);
}

/* What an image would take is counted before it is decoded: a few bytes cannot take gigabytes by many names. */
static void large_images_are_counted_first(void **state)
{
    static const char png[] = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x20\0\0\0\x20\0\1\0\0\0\0\0\0\0\0\0\0\0\0IEND\0\0\0";
    (void)state;
    test_write_file(test_path("face.png"), png, sizeof png);
    save("face.mtl", "newmtl a\nmap_Kd face.png\nnewmtl b\nmap_Kd ./face.png\n");
    model *m = load("mtllib face.mtl\n" SQUARE "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n");
    assert_true(has_warning(m, "the texture face.png was left out: the PNG file has no pixels"));
    assert_true(has_warning(m, "the texture ./face.png was left out: the image has 8192 x 8192 pixels; the limit is"));
    model_free(m);
}

/* A picture of opacity that is the colours' own cuts by its alpha; others, and other pictures, are warnings. */
static void other_pictures_cut_or_are_told(void **state)
{
    static const unsigned char tga[] = { 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 32, 8, 30, 20, 10, 9 };
    (void)state;
    test_write_file(test_path("leaf.tga"), tga, sizeof tga);
    save("face.mtl", "newmtl a\nmap_Kd leaf.tga\nmap_d -imfchan m leaf.tga\nbump -bm 1 x.png\nmap_Ka leaf.tga\n"
                     "newmtl b\nmap_Kd leaf.tga\nmap_d y.png\nbump x.png\n"
                     "newmtl c\nmap_d leaf.tga\nmap_Kd leaf.tga\nnewmtl d\nd 0.5\nmap_d leaf.tga\nmap_Kd leaf.tga\n"
                     "newmtl e\nmap_Kd lost.png\nmap_d lost.png\n");
    model *m = load("mtllib face.mtl\n" SQUARE "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n"
                    "usemtl c\nf 1 2 3\nusemtl d\nf 1 2 3\nusemtl e\nf 1 2 3\n");
    assert_int_equal(m->materials[0].alpha, MODEL_ALPHA_MASK);
    assert_int_equal(m->materials[1].alpha, MODEL_ALPHA_OPAQUE);
    assert_int_equal(m->materials[2].alpha, MODEL_ALPHA_MASK);
    assert_int_equal(m->materials[3].alpha, MODEL_ALPHA_BLEND);
    assert_true(has_warning(m, "material 'a': its bump was left out, and in all materials after it"));
    assert_true(has_warning(m, "material 'b': its picture of opacity (map_d) was left out: put it into the alpha"));
    assert_true(has_warning(m, "material 'e': the texture lost.png was left out: "));
    assert_int_equal(m->warning_count, 3);
    model_free(m);
}

static void missing_materials_are_told(void **state)
{
    (void)state;
    model *m = load("mtllib nowhere.mtl\n" SQUARE "usemtl a\nf 1 2 3\n");
    assert_true(has_warning(m, "the materials of nowhere.mtl were left out"));
    assert_string_equal(m->materials[0].name, "a");
    model_free(m);
}

static void colours_of_positions(void **state)
{
    (void)state;
    const float expected[8] = { 1, 0.5f, 0, 1, 1, 1, 1, 1 };
    model *m = load("v 0 0 0 1 0.5 -3\nv 1 0 0 1\nv 1 1 0\nf 1 2 3\n");
    assert_memory_equal(m->meshes[0].color, expected, sizeof expected);
    model_free(m);
}

static void units_and_sizes(void **state)
{
    (void)state;
    const obj_options cm = { 1.0, NULL };
    model *m = load_with("v 0 0 0\nv 25 0 0\nv 0 25 0\nf 1 2 3\n", &cm);
    assert_true(fabsf(m->meshes[0].position[3] - 0.25f) < 1e-7f);
    assert_int_equal(m->warning_count, 0);
    model_free(m);
    m = load("v 0 0 0\nv 25 0 0\nv 0 25 0\nf 1 2 3\n");
    assert_true(m->meshes[0].position[3] == 25.0f);
    assert_true(has_warning(m, "the model is 25 m large"));
    model_free(m);
}

static void what_has_no_triangles_is_told(void **state)
{
    (void)state;
    model *m = load(SQUARE "l 1 2\np 1\nf 1 2 \\\n 3\n");
    assert_int_equal(m->meshes[0].index_count, 3);
    assert_true(has_warning(m, "line 5: 'l' was left out, and 1 more lines"));
    model_free(m);
}

/* ---- targets ---- */

/* An empty folder; the path stays, where test_path's is used again. */
static const char *make_folder(void)
{
    static char path[256];
    (void)snprintf(path, sizeof path, "%s", test_path("targets"));
    (void)mkdir(path, 0777);
    return path;
}

#define MOVED "v 0 0 0\nv 1 0 0.5\nv 1 1 0\nv 0 1 -0.25\n"

/* Two vertices of one position move alike; what the folder holds beside .obj files, and the model itself, is no target.
 */
static void a_folder_of_targets(void **state)
{
    (void)state;
    const obj_options options = { 10.0, make_folder() };
    save("targets/smile.obj", MOVED "f 1 2 3\n");
    save("targets/frown.OBJ", SQUARE);
    save("targets/face.obj", MOVED);
    save("targets/notes.txt", "none");
    model *m = load_with(SQUARE "vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/1 2/2 4/2\n", &options);
    const model_mesh *mesh = &m->meshes[0];
    assert_int_equal(mesh->target_count, 2);
    assert_string_equal(mesh->targets[0].name, "frown");
    assert_string_equal(mesh->targets[1].name, "smile");
    assert_int_equal(mesh->vertex_count, 5);
    assert_true(fabsf(mesh->targets[1].position[5] - 0.05f) < 1e-8f);
    assert_true(mesh->targets[1].position[5] == mesh->targets[1].position[11]);
    assert_true(fabsf(mesh->targets[1].position[14] + 0.025f) < 1e-8f);
    for (size_t i = 0; i < 15; i++) assert_true(mesh->targets[0].position[i] == 0.0f);
    assert_true(mesh->targets[1].normal[3] != 0.0f); /* of the morphed surface */
    assert_true(mesh->weights[0] == 0.0f && mesh->weights[1] == 0.0f);
    model_free(m);
    (void)remove(test_path("targets/smile.obj"));
    (void)remove(test_path("targets/frown.OBJ"));
    (void)remove(test_path("targets/face.obj"));
}

/* Not of the names of the files: '-' comes before '.'. */
static void targets_come_in_order_of_their_names(void **state)
{
    (void)state;
    const obj_options options = { 0.0, make_folder() };
    save("targets/mouth.obj", MOVED);
    save("targets/mouth-open.obj", MOVED);
    model *m = load_with(SQUARE "f 1 2 3\n", &options);
    assert_string_equal(m->meshes[0].targets[0].name, "mouth");
    assert_string_equal(m->meshes[0].targets[1].name, "mouth-open");
    model_free(m);
    (void)remove(test_path("targets/mouth.obj"));
    (void)remove(test_path("targets/mouth-open.obj"));
}

static void refused_targets(const char *folder, const char *what, const char *where)
{
    const obj_options options = { 0.0, folder };
    model *m = NULL;
    model_error error = { "", "" };
    save("face.obj", SQUARE "f 1 2 3\n");
    assert_int_equal(obj_read(test_path("face.obj"), &options, &m, &error), 1);
    if (!strstr(error.what, what) || strcmp(error.where, where) != 0)
        fail_msg("expected '%s' at '%s', got '%s' at '%s'", what, where, error.what, error.where);
}

static void bad_targets_are_refused(void **state)
{
    (void)state;
    const char *folder = make_folder();
    refused_targets("nowhere/at/all", "cannot be read", "");
    refused_targets(folder, "there is no other .obj file", "");
    save("targets/a.obj", SQUARE "v 0 0 0\n");
    refused_targets(folder, "it has 5 positions, and the model has 4", "target a.obj");
    save("targets/a.obj", "v 0 0 0\nv 0 zero 0\n");
    refused_targets(folder, "'zero' is not a number", "target a.obj, line 2");
    (void)remove(test_path("targets/a.obj"));
}

/* ---- bad input ---- */

static void bad_lines_are_refused(void **state)
{
    (void)state;
    refused("", "it has no position", "");
    refused(SQUARE, "it has no face", "");
    refused("v 1 2\n", "3 numbers are needed here, and there are 2", "line 1");
    refused("v 1 2 nan\n", "not finite", "line 1");
    refused("v 1 2 1e30\n", "too large", "line 1");
    refused(SQUARE "f 1 2\n", "a face needs at least three corners, and this one has 2", "line 5");
    refused(SQUARE "f 1 2 5\n", "position 5 does not exist: the file has 4", "line 5");
    refused(SQUARE "f 1 2 0\n", "position 0 does not exist", "line 5");
    refused(SQUARE "f 1 2 -5\n", "position -5 does not exist", "line 5");
    refused(SQUARE "f 1/1 2/1 3/1\n", "UV 1 does not exist", "line 5");
    refused(SQUARE "f 1//1 2//1 3//1\n", "normal 1 does not exist", "line 5");
    refused(SQUARE "f 1/1/1/1 2 3\n", "one number too many", "line 5");
    refused(SQUARE "f 1 2 x\n", "'x' is not a whole number", "line 5");
    refused("solid cube\n", "an OBJ file has no line 'solid'", "line 1");
}

/* Lines that cannot be read are left out, with the faces that need them; the others stay, and count as in the file. */
static void bad_lines_are_left_out(void **state)
{
    static const char *const texts[] = {
        "v nan 0 0\n" SQUARE "f 2 3 4\nf 1 2 3\n",
        "v 1 2\nstray words\n" SQUARE "f 1 2 3\nf 2 3 4\n",
        "v 0 0 0 1 1 x\nv 1 0 0\nv 1 1 0\nf 1 2 3\n",
        "vt x 0\nvn 0 0\nv 9 9 9\n" SQUARE "f 2/1/1 3/1/1 4/1/1\n",
    };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(texts); i++) {
        model *m = load(texts[i]), *plain = load(SQUARE "f 1 2 3\n");
        assert_int_equal(m->meshes[0].vertex_count, 3);
        assert_memory_equal(m->meshes[0].position, plain->meshes[0].position, 9 * sizeof(float));
        assert_memory_equal(m->meshes[0].normal, plain->meshes[0].normal, 9 * sizeof(float));
        assert_true(has_warning(m, "left out"));
        model_free(plain);
        model_free(m);
    }
}

static void bad_faces_are_left_out(void **state)
{
    (void)state;
    model *m = load(SQUARE "usemtl a\nf 1 2 9\nusemtl b\nf 1 2\nf 1 2 3\nf 0 1 2\n");
    assert_true(m->meshes[0].submesh_count == 1 && m->meshes[0].index_count == 3);
    assert_true(has_warning(m, "line 6: position 9 does not exist: the file has 4 before this line; 3 lines were left "
                               "out"));
    model_free(m);
}

static void mutations_never_crash(void **state)
{
    (void)state;
    const char *text = "mtllib m\n" SQUARE "vt 0 0\nvn 0 0 1\nusemtl a\nf 1/1/1 2/1/1 3//1 -1\n";
    const char bytes[] = " \n0123456789-+.e/vtnfusml#\\\t\0\xff";
    const obj_options plain = { 0.0, NULL };
    test_random r = test_random_from(7);
    uint32_t accepted = 0, rounds = 5000;
    for (uint32_t i = 0; i < rounds; ++i) {
        char changed[256];
        const size_t length = strlen(text);
        model *m = NULL;
        model_error error = { "", "" };
        memcpy(changed, text, length);
        for (uint32_t n = 1 + test_random_below(&r, 4); n > 0; --n)
            changed[test_random_below(&r, (uint32_t)length)] = bytes[test_random_below(&r, sizeof bytes - 1)];
        test_write_file(test_path("mutated.obj"), changed, length);
        if (!obj_read(test_path("mutated.obj"), &plain, &m, &error)) ++accepted;
        model_free(m);
    }
    assert_true(accepted > 0 && accepted < rounds);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(polygons_are_fans),
    cmocka_unit_test(concave_polygons_are_cut),
    cmocka_unit_test(search_for_ears_is_counted),
    cmocka_unit_test(time_to_cut_polygons_is_limited),
    cmocka_unit_test(broken_polygons_are_cut_somehow),
    cmocka_unit_test(corners_become_vertices),
    cmocka_unit_test(materials_are_submeshes),
    cmocka_unit_test(nothing_is_invisible),
    cmocka_unit_test(names_differ_in_case),
    cmocka_unit_test(long_names_are_left_out),
    cmocka_unit_test(large_images_are_counted_first),
    cmocka_unit_test(other_pictures_cut_or_are_told),
    cmocka_unit_test(missing_materials_are_told),
    cmocka_unit_test(colours_of_positions),
    cmocka_unit_test(units_and_sizes),
    cmocka_unit_test(what_has_no_triangles_is_told),
    cmocka_unit_test(a_folder_of_targets),
    cmocka_unit_test(targets_come_in_order_of_their_names),
    cmocka_unit_test(bad_targets_are_refused),
    cmocka_unit_test(bad_lines_are_refused),
    cmocka_unit_test(bad_lines_are_left_out),
    cmocka_unit_test(bad_faces_are_left_out),
    cmocka_unit_test(mutations_never_crash),
};

TEST_MAIN(tests, NULL, NULL)
