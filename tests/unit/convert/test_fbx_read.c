/* test_fbx_read.c: .fbx files, written here as ASCII and turned into every binary form. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "convert/fbx/fbx_read.h"
#include "support/fbx_binary.h"

#define SECOND "46186158000"
#define HALF "23093079000"

/* ---- files ---- */

static char text[1 << 16];

static void add(const char *format, ...)
{
    va_list arguments;
    const size_t length = strlen(text);
    va_start(arguments, format);
    (void)vsnprintf(text + length, sizeof text - length, format, arguments);
    va_end(arguments);
}

/* Metres, 24 frames a second; objects follow. */
static void begin(void)
{
    text[0] = '\0';
    add("; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXVersion: 7400\n}\n"
        "GlobalSettings:  {\n\tProperties70:  {\n"
        "\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\",100\n"
        "\t\tP: \"TimeMode\", \"enum\", \"\", \"\",11\n\t}\n}\nObjects:  {\n");
}

#define P3(name, x, y, z) "\t\tP: \"" name "\", \"Vector\", \"\", \"A\"," x "," y "," z "\n"
#define P1(name, x) "\t\tP: \"" name "\", \"Number\", \"\", \"A\"," x "\n"

static void add_object(const char *kind, int id, const char *name, const char *sub, const char *properties,
                       const char *members)
{
    add("\t%s: %d, \"%s::%s\", \"%s\" {\n\t\tProperties70:  {\n%s\t\t}\n%s\t}\n", kind, id, kind, name, sub, properties,
        members);
}

/* A triangle of 0,0,0, 1,0,0 and 0,1,0 as object `id`, with these layer elements. */
static void add_triangle(int id, const char *members)
{
    add("\tGeometry: %d, \"Geometry::t\", \"Mesh\" {\n\t\tVertices: *9 {\n\t\t\ta: 0,0,0,1,0,0,0,1,0\n\t\t}\n"
        "\t\tPolygonVertexIndex: *3 {\n\t\t\ta: 0,1,-3\n\t\t}\n%s\t}\n",
        id, members);
}

static void add_curve(int id, const char *times, const char *values, const char *flags, const char *data,
                      const char *more)
{
    add("\tAnimationCurve: %d, \"AnimCurve::\", \"\" {\n\t\tKeyTime: *2 {\n\t\t\ta: %s\n\t\t}\n"
        "\t\tKeyValueFloat: *2 {\n"
        "\t\t\ta: %s\n\t\t}\n\t\tKeyAttrFlags: *1 {\n\t\t\ta: %s\n\t\t}\n"
        "\t\tKeyAttrDataFloat: *4 {\n\t\t\ta: %s\n\t\t}\n"
        "\t\tKeyAttrRefCount: *1 {\n\t\t\ta: 2\n\t\t}\n%s\t}\n",
        id, times, values, flags, data, more);
}

static void add_take(int stack, const char *name, const char *stop)
{
    add("\tAnimationStack: %d, \"AnimStack::%s\", \"\" {\n\t\tProperties70:  {\n"
        "\t\t\tP: \"LocalStop\", \"KTime\", \"Time\", \"\",%s\n\t\t}\n\t}\n",
        stack, name, stop);
}

static void links(const char *lines)
{
    add("}\nConnections:  {\n%s}\n", lines);
}

#define OO(a, b) "\tC: \"OO\"," #a "," #b "\n"
#define OP(a, b, property) "\tC: \"OP\"," #a "," #b ", \"" property "\"\n"

static model *load_bytes(const void *bytes, size_t count)
{
    const fbx_options plain = { 0.0, NULL };
    model *m = NULL;
    model_error error = { "", "" };
    test_write_file(test_path("a.fbx"), bytes, count);
    if (fbx_read(test_path("a.fbx"), &plain, &m, &error)) fail_msg("refused: %s (%s)", error.what, error.where);
    return m;
}

static model *load(void)
{
    return load_bytes(text, strlen(text));
}

static int has_warning(const model *m, const char *part)
{
    for (uint32_t i = 0; i < m->warning_count; i++)
        if (strstr(m->warnings[i], part)) return 1;
    return 0;
}

static void warns(const char *part)
{
    model *m = load();
    if (!has_warning(m, part)) fail_msg("no warning of '%s'", part);
    model_free(m);
}

static const model_node *node_of(const model *m, const char *name)
{
    for (uint32_t i = 0; i < m->node_count; i++)
        if (strcmp(m->nodes[i].name, name) == 0) return m->nodes + i;
    fail_msg("no node '%s'", name);
    return NULL;
}

static void assert_near(double a, double b)
{
    if (!(fabs(a - b) < 1e-6 * (1.0 + fabs(b)))) fail_msg("%.9g is not %.9g", a, b);
}

/* Where a node has a point of it. */
static void stands(const model *m, const char *name, double px, double py, double pz, double x, double y, double z)
{
    const double *w = node_of(m, name)->world;
    assert_near(w[0] * px + w[4] * py + w[8] * pz + w[12], x);
    assert_near(w[1] * px + w[5] * py + w[9] * pz + w[13], y);
    assert_near(w[2] * px + w[6] * py + w[10] * pz + w[14], z);
}

/* The values of a clip's channel at a frame of the 24 in a second. */
static const float *value_at(const model *m, uint32_t clip, const char *node, model_path path, uint32_t frame)
{
    const model_clip *c = m->clips + clip;
    for (uint32_t i = 0; i < c->channel_count; i++)
        if (c->channels[i].path == path && m->nodes + c->channels[i].node == node_of(m, node)) {
            const model_channel *of = c->channels + i;
            if (of->key_count == 2) return of->values;
            assert_true(frame < of->key_count);
            assert_near((double)of->times[frame], frame / 24.0);
            return of->values + (size_t)frame * of->width;
        }
    fail_msg("clip %u does not move '%s'", (unsigned)clip, node);
    return NULL;
}

/* ---- forms of one file ---- */

/* A triangle on a bone that turns in a second, with a shape. */
static void make_all(void)
{
    begin();
    add_triangle(1,
                 "\t\tLayerElementNormal: 0 {\n\t\t\tMappingInformationType: \"ByPolygonVertex\"\n"
                 "\t\t\tReferenceInformationType: \"Direct\"\n\t\t\tNormals: *9 {\n"
                 "\t\t\t\ta: 0,0,1,0,0,1,0,0.6,0.8\n\t\t\t}\n\t\t}\n"
                 "\t\tLayerElementUV: 0 {\n\t\t\tMappingInformationType: \"ByPolygonVertex\"\n"
                 "\t\t\tReferenceInformationType: \"IndexToDirect\"\n\t\t\tUV: *4 {\n\t\t\t\ta: 0,0.25,1,0.5\n\t\t\t}\n"
                 "\t\t\tUVIndex: *3 {\n\t\t\t\ta: 0,1,0\n\t\t\t}\n\t\t}\n"
                 "\t\tLayerElementColor: 0 {\n\t\t\tMappingInformationType: \"ByVertice\"\n"
                 "\t\t\tReferenceInformationType: \"Direct\"\n\t\t\tColors: *12 {\n"
                 "\t\t\t\ta: 1,0,0,1,0,1,0,1,0,0,1,0.5\n\t\t\t}\n\t\t}\n");
    add_object("Model", 2, "skin", "Mesh", "", "");
    add_object("Model", 3, "bone", "LimbNode", P3("Lcl Translation", "0", "1", "0"), "");
    add_object("Deformer", 4, "", "Skin", "", "");
    add_object("Deformer", 5, "", "Cluster", "",
               "\t\tIndexes: *3 {\n\t\t\ta: 0,1,2\n\t\t}\n\t\tWeights: *3 {\n\t\t\ta: 1,0.5,0.25\n\t\t}\n"
               "\t\tTransform: *16 {\n\t\t\ta: 1,0,0,0,0,1,0,0,0,0,1,0,0,-1,0,1\n\t\t}\n");
    add("\tGeometry: 6, \"Geometry::up\", \"Shape\" {\n\t\tIndexes: *1 {\n\t\t\ta: 2\n\t\t}\n\t\tVertices: *3 {\n"
        "\t\t\ta: 0,0,2\n\t\t}\n\t}\n");
    add_object("Deformer", 7, "shapes", "BlendShape", "", "");
    add_object("Deformer", 8, "shapes.up", "BlendShapeChannel", P1("DeformPercent", "25"),
               "\t\tFullWeights: *1 {\n\t\t\ta: 100\n\t\t}\n");
    add_take(10, "turn", SECOND);
    add("\tAnimationLayer: 11, \"AnimLayer::base\", \"\" {\n\t}\n");
    add_object("AnimationCurveNode", 12, "R", "", P3("d|X", "0", "0", "0"), "");
    add_curve(13, "0," SECOND, "0,90", "1032", "0.0,270.0,0.0,0.0", "");
    links(OO(2, 0) OO(3, 0) OO(1, 2) OO(4, 1) OO(5, 4) OO(3, 5) OO(7, 1) OO(8, 7) OO(6, 8) OO(11, 10) OO(12, 11)
              OP(12, 3, "Lcl Rotation") OP(13, 12, "d|Z"));
}

static void is_all(const model *m)
{
    const model_mesh *mesh = m->meshes;
    assert_int_equal(m->mesh_count, 1);
    assert_int_equal(mesh->vertex_count, 3);
    assert_string_equal(mesh->name, "skin");
    assert_near((double)mesh->normal[7], 0.6);
    assert_near((double)mesh->uv[1], 0.75);
    assert_near((double)mesh->uv[2], 1.0);
    assert_near((double)mesh->color[11], 0.5);
    assert_near((double)mesh->joint_weights[0], 1.0);
    assert_int_equal(mesh->target_count, 1);
    assert_string_equal(mesh->targets[0].name, "up");
    assert_near((double)mesh->targets[0].position[8], 2.0);
    assert_near((double)mesh->weights[0], 0.25);
    assert_int_equal(m->clip_count, 1);
    assert_string_equal(m->clips[0].name, "turn");
    /* the slopes are 0 and 270 degrees a second: 3 x^2 (1 - x) 0 + x^3 90 at a half is 11.25 degrees */
    assert_near((double)value_at(m, 0, "bone", MODEL_PATH_ROTATION, 12)[2],
                sin(11.25 / 2.0 / 180.0 * 3.14159265358979));
}

static void every_form_is_the_same_model(void **state)
{
    static uint8_t bytes[1 << 17];
    static const uint32_t versions[] = { 7100, 7400, 7500, 7700 };
    model *m;
    (void)state;
    make_all();
    m = load();
    is_all(m);
    assert_int_equal(m->warning_count, 0);
    model_free(m);
    for (uint32_t i = 0; i < 16; i++) {
        const fbx_form form = { versions[i / 4], (int)(i & 1), (int)(i >> 1 & 1) };
        m = load_bytes(bytes, fbx_binary_write(text, &form, bytes, sizeof bytes));
        is_all(m);
        assert_int_equal(m->warning_count, 0);
        model_free(m);
    }
}

/* Version 6: names in place of numbers, meshes and shapes in their nodes, takes of channels. */
static void make_six(void)
{
    text[0] = '\0';
    add("FBXHeaderExtension:  {\n\tFBXVersion: 6100\n}\nObjects:  {\n"
        "\tModel: \"Model::face\", \"Mesh\" {\n\t\tProperties60:  {\n"
        "\t\t\tProperty: \"Lcl Translation\", \"\", \"A+\",0,0,1\n"
        "\t\t\tProperty: \"up\", \"\", \"AN\",50\n\t\t}\n\t\tVertices: 0,0,0,100,0,0\n\t\t,0,100,0\n"
        "\t\tPolygonVertexIndex: 0,1,-3\n\t\tShape: \"up\" {\n\t\t\tIndexes: 1\n\t\t\tVertices: 0,0,200\n\t\t}\n\t}\n"
        "\tModel: \"Model::head\", \"Limb\" {\n\t\tProperties60:  {\n"
        "\t\t\tProperty: \"Lcl Translation\", \"\", \"A+\",0,200,0\n\t\t}\n\t}\n"
        "\tGlobalSettings:  {\n\t\tProperties60:  {\n"
        "\t\t\tProperty: \"UnitScaleFactor\", \"double\", \"\",1\n\t\t}\n\t}\n}\n"
        "Connections:  {\n\tConnect: \"OO\", \"Model::head\", \"Model::Scene\"\n"
        "\tConnect: \"OO\", \"Model::face\", \"Model::head\"\n}\n"
        "Takes:  {\n\tTake: \"nod\" {\n\t\tLocalTime: 0," SECOND "\n\t\tModel: \"Model::face\" {\n"
        "\t\t\tChannel: \"Transform\" {\n\t\t\t\tChannel: \"T\" {\n\t\t\t\t\tChannel: \"X\" {\n"
        "\t\t\t\t\t\tDefault: 0.0\n\t\t\t\t\t\tKey: 0,0,C,s," HALF ",100,L," SECOND
        ",200,L\n\t\t\t\t\t}\n\t\t\t\t}\n\t\t\t}\n"
        "\t\t\tChannel: \"up\" {\n\t\t\t\tKey: 0,0,U,s,0,0,n," SECOND ",100,L\n\t\t\t}\n\t\t}\n\t}\n}\n");
}

static void is_six(const model *m)
{
    assert_int_equal(m->mesh_count, 1);
    stands(m, "face", 0, 0, 0, 0, 2, 0.01);
    assert_near((double)m->meshes[0].position[7], 1.0);
    assert_near((double)m->meshes[0].targets[0].position[5], 2.0);
    assert_near((double)m->meshes[0].weights[0], 0.5);
    assert_string_equal(m->clips[0].name, "nod");
    assert_near((double)value_at(m, 0, "face", MODEL_PATH_TRANSLATION, 11)[0], 0.0);
    assert_near((double)value_at(m, 0, "face", MODEL_PATH_TRANSLATION, 18)[0], 1.5);
    assert_near((double)value_at(m, 0, "face", MODEL_PATH_WEIGHTS, 12)[0], 0.5);
}

static void version_six_is_read(void **state)
{
    static uint8_t bytes[1 << 16];
    model *m;
    (void)state;
    make_six();
    m = load();
    is_six(m);
    model_free(m);
    for (int big = 0; big < 2; big++) {
        const fbx_form form = { 6100, big, 0 };
        m = load_bytes(bytes, fbx_binary_write(text, &form, bytes, sizeof bytes));
        is_six(m);
        model_free(m);
    }
}

/* ---- nodes ---- */

static void pivots_and_orders(void **state)
{
    model *m;
    (void)state;
    begin();
    add_triangle(1, "");
    add_object("Model", 2, "t", "Mesh",
               P3("Lcl Translation", "1", "2", "3") P3("Lcl Rotation", "0", "0", "90") P3("Lcl Scaling", "2", "1", "1")
                   P3("RotationPivot", "1", "0", "0") P3("ScalingPivot", "0", "1", "0")
                       P3("ScalingOffset", "0", "0", "5") P3("RotationOffset", "0", "10", "0"),
               "");
    add_object("Model", 3, "yxz", "Null",
               P1("RotationActive", "1") P1("RotationOrder", "3") P3("Lcl Rotation", "90", "90", "0")
                   P3("PreRotation", "0", "0", "90"),
               "");
    add_object("Model", 4, "ignored", "Null", P1("RotationOrder", "3") P3("PreRotation", "0", "0", "90"), "");
    links(OO(2, 0) OO(3, 0) OO(4, 0) OO(1, 2));
    m = load();
    /* from its scaling pivot by 2, 1, 1; then from its rotation pivot by a quarter about z */
    stands(m, "t", 0, 0, 0, 2, 11, 8);
    stands(m, "t", 1, 0, 0, 2, 13, 8);
    stands(m, "t", 0, 1, 0, 1, 11, 8);
    /* z: about y to x, about x stays, about z (before) to y */
    stands(m, "yxz", 0, 0, 1, 0, 1, 0);
    stands(m, "yxz", 0, 1, 0, 0, 0, 1);
    stands(m, "ignored", 1, 0, 0, 1, 0, 0);
    model_free(m);
}

/* A parent of scale 1, 3, 1 turned by 30 degrees, and children turned by 45 degrees. */
static void inherit_types(void **state)
{
    static const char *const names[3] = { "rrss", "rsrs", "rrs" };
    const double a = 75.0 / 57.29577951308232, p = 30.0 / 57.29577951308232, c = 45.0 / 57.29577951308232;
    model *m;
    (void)state;
    begin();
    add_triangle(1, "");
    add_object("Model", 2, "parent", "Mesh", P3("Lcl Rotation", "0", "0", "30") P3("Lcl Scaling", "1", "3", "1"), "");
    for (int i = 0; i < 3; i++) {
        char properties[256];
        (void)snprintf(properties, sizeof properties, P3("Lcl Rotation", "0", "0", "45") P1("InheritType", "%d"), i);
        add_object("Model", 3 + i, names[i], "Null", properties, "");
    }
    links(OO(2, 0) OO(1, 2) OO(3, 2) OO(4, 2) OO(5, 2));
    m = load();
    stands(m, "rrss", 0, 1, 0, -3 * sin(a), 3 * cos(a), 0); /* its own turn, then the scale along its axes */
    stands(m, "rrs", 0, 1, 0, -sin(a), cos(a), 0);          /* without the parent's scale */
    assert_true(has_warning(m, "'rsrs' is sheared") || m->warning_count == 0);
    stands(m, "rsrs", 1, 0, 0, cos(p) * cos(c) - 3 * sin(p) * sin(c), sin(p) * cos(c) + 3 * cos(p) * sin(c), 0);
    assert_true(node_of(m, "rrss")->parent == MODEL_NONE && node_of(m, "rsrs")->parent != MODEL_NONE);
    model_free(m);
}

static void geometric_transforms_stay_with_the_mesh(void **state)
{
    model *m;
    (void)state;
    begin();
    add_triangle(1, "");
    add_object("Model", 2, "parent", "Mesh",
               P3("GeometricTranslation", "0", "2", "0") P3("GeometricScaling", "-2", "1", "1"), "");
    add_object("Model", 3, "child", "Mesh", P3("Lcl Translation", "3", "0", "0"), "");
    links(OO(2, 0) OO(3, 2) OO(1, 2) OO(1, 3));
    m = load();
    stands(m, "child", 0, 0, 0, 3, 0, 0);
    assert_int_equal(m->mesh_count, 2);
    /* mirrored: turned over, so that it faces the same way */
    assert_near((double)m->meshes[0].position[7], 2.0);
    assert_near((double)m->meshes[0].position[3], -2.0);
    assert_near((double)m->meshes[0].normal[2], 1.0);
    assert_near((double)m->meshes[1].normal[2], 1.0);
    model_free(m);
}

static void a_bone_may_have_the_mesh_s_name(void **state)
{
    model *m;
    (void)state;
    begin();
    add_triangle(1, "");
    add_object("Model", 2, "head", "Mesh", "", "");
    add_object("Model", 3, "head", "LimbNode", P3("Lcl Translation", "0", "5", "0"), "");
    add_object("Deformer", 4, "", "Skin", "", "");
    add_object("Deformer", 5, "", "Cluster", "",
               "\t\tIndexes: *3 {\n\t\t\ta: 0,1,2\n\t\t}\n\t\tWeights: *3 {\n\t\t\ta: 1,1,1\n\t\t}\n");
    links(OO(2, 0) OO(3, 0) OO(1, 2) OO(4, 1) OO(5, 4) OO(3, 5));
    m = load();
    assert_near(m->nodes[m->skins[0].joints[0]].world[13], 5.0);
    model_free(m);
}

/* ---- curves ---- */

/* Frames 6, 12 and 36 (a half second behind the last key) of x in a take of two seconds. */
static void curve_gives(const char *values, const char *flags, const char *data, const char *more, double quarter,
                        double half, double behind)
{
    model *m;
    begin();
    add_triangle(1, "");
    add_object("Model", 2, "t", "Mesh", P3("Lcl Translation", "1", "2", "3"), "");
    add_take(10, "go", "92372316000");
    add("\tAnimationLayer: 11, \"AnimLayer::base\", \"\" {\n\t}\n");
    add_object("AnimationCurveNode", 12, "T", "", P1("d|X", "0") P1("d|Y", "7"), "");
    add_curve(13, "0," SECOND, values, flags, data, more);
    links(OO(2, 0) OO(1, 2) OO(11, 10) OO(12, 11) OP(12, 2, "Lcl Translation") OP(13, 12, "d|X"));
    m = load();
    assert_near((double)value_at(m, 0, "t", MODEL_PATH_TRANSLATION, 6)[0], quarter);
    assert_near((double)value_at(m, 0, "t", MODEL_PATH_TRANSLATION, 12)[0], half);
    assert_near((double)value_at(m, 0, "t", MODEL_PATH_TRANSLATION, 36)[0], behind);
    assert_near((double)value_at(m, 0, "t", MODEL_PATH_TRANSLATION, 36)[1], 7.0);
    assert_near((double)value_at(m, 0, "t", MODEL_PATH_TRANSLATION, 36)[2], 3.0); /* its own: the take says nothing */
    model_free(m);
}

#define BEHIND(how) "\t\tPost-Extrapolation:  {\n\t\t\tType: \"" how "\"\n\t\t\tRepetition: -1\n\t\t}\n"

static void curves_of_all_kinds(void **state)
{
    (void)state;
    curve_gives("0,8", "4", "0,0,0,0", "", 2, 4, 8);                      /* linear */
    curve_gives("1,8", "2", "0,0,0,0", "", 1, 1, 8);                      /* constant */
    curve_gives("1,8", "258", "0,0,0,0", "", 8, 8, 8);                    /* the next key's value */
    curve_gives("0,8", "1032", "0.0,0.0,0.0,0.0", "", 1.25, 4, 8);        /* flat at both ends */
    curve_gives("0,8", "1032", "8.0,8.0,0.0,0.0", "", 2, 4, 8);           /* slopes of the line */
    curve_gives("0,8", "264", "0.0,0.0,0.0,0.0", "", 2, 4, 8);            /* automatic: the chord */
    curve_gives("0,8", "16648", "0.0,0.0,0.0,0.0", "", 1.25, 4, 8);       /* automatic, clamped: flat at ends */
    curve_gives("0,8", "4", "0,0,0,0", BEHIND("R"), 2, 4, 4);             /* repeated */
    curve_gives("0,8", "4", "0,0,0,0", BEHIND("M"), 2, 4, 4);             /* mirrored */
    curve_gives("0,6", "4", "0,0,0,0", BEHIND("A"), 1.5, 3, 9);           /* repeated and added */
    curve_gives("0,6", "4", "0,0,0,0", BEHIND("K"), 1.5, 3, 9);           /* by its slope */
    curve_gives("0,8", "1032", "1090519040,1090519040,0,0", "", 2, 4, 8); /* slopes as bits: two floats of 8 */
}

/* A handle of weight w reaches w of the span: x(u) = 3 w u (1 - u)^2 + 3 (1 - w) u^2 (1 - u) + u^3. Slopes are 0. */
static void weighted_tangents(void **state)
{
    const double w = 9000 / 9999.0;
    double low = 0.0, high = 1.0, u;
    char data[64];
    (void)state;
    for (int i = 0; i < 60; i++) {
        u = (low + high) / 2.0;
        if (3 * w * u * (1 - u) * (1 - u) + 3 * (1 - w) * u * u * (1 - u) + u * u * u < 0.25)
            low = u;
        else
            high = u;
    }
    (void)snprintf(data, sizeof data, "0,0,%u,0", 9000u << 16 | 9000u);
    curve_gives("0,8", "50332680", data, "", 8 * (3 * low * low * (1 - low) + low * low * low), 4, 8);
}

/* A base layer holds 30 degrees about z; a second one of this mode and weight has 60. */
static double layered(const char *properties)
{
    double angle;
    model *m;
    begin();
    add_triangle(1, "");
    add_object("Model", 2, "t", "Mesh", "", "");
    add_take(10, "go", SECOND);
    add_object("AnimationLayer", 11, "base", "", "", "");
    add_object("AnimationLayer", 21, "over", "", properties, "");
    add_object("AnimationCurveNode", 12, "R", "", P1("d|X", "0") P1("d|Y", "0") P1("d|Z", "0"), "");
    add_object("AnimationCurveNode", 22, "R", "", P1("d|X", "0") P1("d|Y", "0") P1("d|Z", "0"), "");
    add_curve(13, "0," SECOND, "30,30", "4", "0,0,0,0", "");
    add_curve(23, "0," SECOND, "60,60", "4", "0,0,0,0", "");
    links(OO(2, 0) OO(1, 2) OO(11, 10) OO(21, 10) OO(12, 11) OO(22, 21) OP(12, 2, "Lcl Rotation") OP(13, 12, "d|Z")
              OP(22, 2, "Lcl Rotation") OP(23, 22, "d|Z"));
    m = load();
    angle = 2.0 * asin((double)value_at(m, 0, "t", MODEL_PATH_ROTATION, 0)[2]) * 57.29577951308232;
    model_free(m);
    return angle;
}

static void layers_are_blended(void **state)
{
    (void)state;
    assert_near(layered(P1("BlendMode", "0")), 90.0);
    assert_near(layered(P1("BlendMode", "0") P1("Weight", "50")), 60.0);
    assert_near(layered(P1("BlendMode", "1")), 60.0);
    assert_near(layered(P1("BlendMode", "2") P1("Weight", "50")), 45.0);
    assert_near(layered(P1("BlendMode", "0") P1("Mute", "1")), 30.0);
}

/* A take is read over its span, whatever keys are outside; a take without keys is none. */
static void takes_have_their_span(void **state)
{
    model *m;
    (void)state;
    begin();
    add_triangle(1, "");
    add_object("Model", 2, "t", "Mesh", "", "");
    add_take(9, "empty", SECOND);
    add_take(10, "go", HALF);
    add("\tAnimationLayer: 11, \"AnimLayer::base\", \"\" {\n\t}\n");
    add_object("AnimationCurveNode", 12, "T", "", P1("d|X", "0") P1("d|Y", "0") P1("d|Z", "0"), "");
    add_curve(13, "-" SECOND "," SECOND, "0,8", "4", "0,0,0,0", "");
    links(OO(2, 0) OO(1, 2) OO(11, 10) OO(12, 11) OP(12, 2, "Lcl Translation") OP(13, 12, "d|X"));
    m = load();
    assert_int_equal(m->clip_count, 1);
    assert_near((double)m->clips[0].duration_s, 0.5);
    assert_near((double)value_at(m, 0, "t", MODEL_PATH_TRANSLATION, 0)[0], 4.0);
    model_free(m);
}

/* What stands still in a take of two frames has both. */
static void a_take_of_two_frames_is_whole(void **state)
{
    model *m;
    (void)state;
    begin();
    add_triangle(1, "");
    add_object("Model", 2, "t", "Mesh", "", "");
    add_take(10, "go", "1924423250");
    add("\tAnimationLayer: 11, \"AnimLayer::base\", \"\" {\n\t}\n");
    add_object("AnimationCurveNode", 12, "T", "", P1("d|X", "0") P1("d|Y", "0") P1("d|Z", "0"), "");
    add_curve(13, "0," SECOND, "4,4", "4", "0,0,0,0", "");
    links(OO(2, 0) OO(1, 2) OO(11, 10) OO(12, 11) OP(12, 2, "Lcl Translation") OP(13, 12, "d|X"));
    m = load();
    assert_int_equal(m->warning_count, 0);
    assert_int_equal(m->clip_count, 1);
    assert_near((double)m->clips[0].duration_s, 1.0 / 24.0);
    assert_int_equal(m->clips[0].channels[0].key_count, 2);
    assert_near((double)m->clips[0].channels[0].values[0], 4.0);
    assert_near((double)m->clips[0].channels[0].values[3], 4.0);
    model_free(m);
}

/* ---- shapes ---- */

/* full: percentages of FullWeights; two: whether there is a second shape. */
static void make_shapes(const char *full, int two)
{
    char members[128];
    begin();
    add_triangle(1, "");
    add_object("Model", 2, "t", "Mesh", "", "");
    (void)snprintf(members, sizeof members, "\t\tFullWeights: *2 {\n\t\t\ta: %s\n\t\t}\n", full);
    for (int i = 0; i < 2; i++)
        add("\tGeometry: %d, \"Geometry::s%d\", \"Shape\" {\n\t\tIndexes: *2 {\n\t\t\ta: 1,2\n"
            "\t\t}\n\t\tVertices: *6 {\n"
            "\t\t\ta: 0,0,%d,0,0,%d\n\t\t}\n\t}\n",
            3 + i, i, 10 - 8 * i, 10 - 8 * i);
    add_object("Deformer", 5, "b", "BlendShape", "", "");
    add_object("Deformer", 6, "c", "BlendShapeChannel", P1("DeformPercent", "75"), members);
    links(two ? OO(2, 0) OO(1, 2) OO(5, 1) OO(6, 5) OO(3, 6) OO(4, 6) : OO(2, 0) OO(1, 2) OO(5, 1) OO(6, 5) OO(3, 6));
}

static void masks_and_in_betweens(void **state)
{
    model *m;
    (void)state;
    make_shapes("100,40", 0);
    m = load();
    assert_near((double)m->meshes[0].targets[0].position[5], 10.0);
    assert_near((double)m->meshes[0].targets[0].position[8], 4.0);
    model_free(m);
    make_shapes("50,100", 1); /* at 75 half of either */
    m = load();
    assert_int_equal(m->meshes[0].target_count, 2);
    assert_string_equal(m->meshes[0].targets[0].name, "c_50");
    assert_string_equal(m->meshes[0].targets[1].name, "c");
    assert_near((double)m->meshes[0].weights[0], 0.5);
    assert_near((double)m->meshes[0].weights[1], 0.5);
    assert_true(has_warning(m, "in-betweens"));
    model_free(m);
}

/* ---- materials ---- */

#define PNG "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="

/* A square of two triangles with a material each: one of Phong, and one physical with a picture in the file. */
static void materials_and_pictures(void **state)
{
    const model_material *a, *b;
    model *m;
    (void)state;
    begin();
    add("\tGeometry: 1, \"Geometry::t\", \"Mesh\" {\n\t\tVertices: *12 {\n\t\t\ta: 0,0,0,1,0,0,1,1,0,0,1,0\n\t\t}\n"
        "\t\tPolygonVertexIndex: *6 {\n\t\t\ta: 0,1,-3,0,2,-4\n\t\t}\n\t\tLayerElementMaterial: 0 {\n"
        "\t\t\tMappingInformationType: \"ByPolygon\"\n\t\t\tReferenceInformationType: \"IndexToDirect\"\n"
        "\t\t\tMaterials: *2 {\n\t\t\t\ta: 1,0\n\t\t\t}\n\t\t}\n\t}\n");
    add_object("Model", 2, "t", "Mesh", "", "");
    add_object("Material", 3, "phong", "",
               P3("DiffuseColor", "1", "0.5", "0") P1("TransparencyFactor", "0.25")
                   P3("TransparentColor", "1", "1", "1") P1("ShininessExponent", "30"),
               "");
    add_object("Material", 4, "physical", "",
               "\t\tP: \"3dsMax|main|basecolor\", \"ColorAndAlpha\", \"\", \"A\",0,1,1,1\n" P1(
                   "3dsMax|main|metalness", "0.75") P1("3dsMax|main|roughness", "0.5"),
               "");
    add_object("Texture", 5, "inside", "", "", "\t\tRelativeFilename: \"..\\away\\in.png\"\n");
    add_object("Texture", 6, "outside", "", "", "\t\tRelativeFilename: \"away.png\"\n");
    add_object("Video", 7, "clip", "Clip", "", "\t\tContent: ,\n\t\t\"" PNG "\"\n");
    links(OO(2, 0) OO(1, 2) OO(3, 2) OO(4, 2) OO(7, 5) OP(5, 4, "3dsMax|main|base_color_map") OP(6, 3, "NormalMap")
              OP(6, 4, "3dsMax|main|roughness_map"));
    m = load();
    assert_int_equal(m->meshes[0].submesh_count, 2);
    a = m->materials + m->meshes[0].submeshes[0].material;
    b = m->materials + m->meshes[0].submeshes[1].material;
    assert_string_equal(a->name, "phong");
    assert_near((double)a->base_color[1], pow((0.5 + 0.055) / 1.055, 2.4));
    assert_near((double)a->base_color[3], 0.75);
    assert_int_equal(a->alpha, MODEL_ALPHA_BLEND);
    assert_near((double)a->roughness, pow(2.0 / 32.0, 0.25));
    assert_near((double)a->metallic, 0.0);
    assert_int_equal(m->meshes[0].indices[0], 0);
    assert_string_equal(b->name, "physical");
    assert_near((double)b->metallic, 0.75);
    assert_near((double)b->roughness, 0.5);
    assert_near((double)b->base_color[0], 1.0); /* the picture is in its place */
    assert_int_equal(m->texture_count, 1);
    assert_int_equal(b->base_color_texture, 0);
    assert_true(has_warning(m, "the picture 'away.png' is neither"));
    assert_true(has_warning(m, "material 'physical' 3dsMax|main|roughness_map: a picture of this kind"));
    model_free(m);
}

/* A picture is known by its bytes: its name may end in anything. Its case, and its folder's, need not match. */
static void pictures_have_any_name(void **state)
{
    static const unsigned char tga[] = { 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 24, 0, 30, 20, 10 };
    static const char *const named[] = { "a.tga", "A.PNG", "picture", "Other.TGA", "maps\\Deep.tga", "art\\Flat.tga" };
    static const char *const files[] = { "a.tga", "A.PNG", "picture", "oTHER.tga", "Maps/deep.TGA", "art\\flat.tga" };
    (void)state;
    (void)mkdir(test_path("Maps"), 0777);
    for (size_t i = 0; i < sizeof named / sizeof named[0]; i++) {
        char line[64];
        begin();
        add_triangle(1, "");
        add_object("Model", 2, "t", "Mesh", "", "");
        add_object("Material", 3, "a", "", "", "");
        (void)snprintf(line, sizeof line, "\t\tRelativeFilename: \"%s\"\n", named[i]);
        add_object("Texture", 4, "outside", "", "", line);
        links(OO(2, 0) OO(1, 2) OO(3, 2) OP(4, 3, "DiffuseColor"));
        test_write_file(test_path(files[i]), tga, sizeof tga);
        model *m = load();
        assert_true(m->texture_count == 1 && m->textures[0].width == 1);
        assert_true(m->textures[0].rgba[0] == 10 && m->textures[0].rgba[2] == 30);
        model_free(m);
    }
}

/* Where a picture gives the colour, the material's own is often black: without the picture it is white. */
static void a_missing_picture_leaves_white(void **state)
{
    model *m;
    (void)state;
    begin();
    add_triangle(1, "");
    add_object("Model", 2, "t", "Mesh", "", "");
    add_object("Material", 3, "a", "", P3("DiffuseColor", "0", "0", "0") P1("DiffuseFactor", "0.2"), "");
    add_object("Texture", 4, "outside", "", "", "\t\tRelativeFilename: \"away.png\"\n");
    links(OO(2, 0) OO(1, 2) OO(3, 2) OP(4, 3, "DiffuseColor"));
    m = load();
    assert_int_equal(m->materials[0].base_color_texture, MODEL_NONE);
    for (int i = 0; i < 3; i++) assert_near((double)m->materials[0].base_color[i], 1.0);
    model_free(m);
}

/* ---- what is left out, and what is refused ---- */

/* A hidden node hides those below that inherit it, and no others. What a take moves is not hidden. */
static void hidden_nodes_are_not_drawn(void **state)
{
    model *m;
    (void)state;
    begin();
    add_triangle(1, "");
    add_object("Model", 2, "shown", "Mesh", P1("Visibility", "1"), "");
    add_object("Model", 3, "hidden", "Mesh", P1("Visibility", "0"), "");
    add_object("Model", 4, "below", "Mesh", "", "");
    add_object("Model", 5, "own", "Mesh", P1("Visibility Inheritance", "0"), "");
    add_object("Model", 7, "lower", "Mesh", "", "");
    add_object("Model", 6, "blinks", "Mesh", P1("Visibility", "0"), "");
    add_take(10, "take", "46186158000");
    add("\tAnimationLayer: 11, \"AnimLayer::a\", \"\" {\n\t}\n\tAnimationCurveNode: 12, \"AnimCurveNode::v\", \"\" {\n"
        "\t\tProperties70:  {\n" P1("d|Visibility", "0") "\t\t}\n\t}\n");
    links(OO(2, 0) OO(3, 0) OO(4, 3) OO(5, 3) OO(6, 0) OO(7, 5) OO(1, 7) OO(1, 2) OO(1, 3) OO(1, 4) OO(1, 5) OO(1, 6)
              OO(11, 10) OO(12, 11) OP(12, 6, "Visibility"));
    m = load();
    assert_true(node_of(m, "shown")->mesh != MODEL_NONE && node_of(m, "hidden")->mesh == MODEL_NONE);
    assert_true(node_of(m, "below")->mesh == MODEL_NONE && node_of(m, "own")->mesh != MODEL_NONE);
    assert_true(node_of(m, "lower")->mesh != MODEL_NONE && node_of(m, "blinks")->mesh != MODEL_NONE);
    assert_true(has_warning(m, "node 'hidden' is hidden in the file and is not drawn"));
    model_free(m);
}

static void losses_are_warned_of(void **state)
{
    (void)state;
    begin();
    add_triangle(1, "\t\tSmoothness: 2\n");
    add_object("Model", 2, "\223\252", "Mesh", "", "");
    add_object("Model", 3, "bone", "LimbNode", "", "");
    add_object("Model", 30, "sheet", "NurbsSurface", P3("Lcl Translation", "1e300", "0", "0"), "");
    add_object("Geometry", 31, "sheet", "NurbsSurface", "", "");
    add_object("Deformer", 32, "", "VertexCacheDeformer", "", "");
    add_object("Constraint", 9, "aim", "Aim", "", "");
    add("\tDeformer: 4, \"Deformer::\", \"Skin\" {\n\t\tSkinningType: \"DualQuaternion\"\n\t}\n");
    add("\tDeformer: 5, \"SubDeformer::c\", \"Cluster\" {\n\t\tMode: \"Additive\"\n"
        "\t\tIndexes: *1 {\n\t\t\ta: 0\n\t\t}\n"
        "\t\tWeights: *1 {\n\t\t\ta: 1\n\t\t}\n\t}\n\tDeformer: 6, \"Deformer::\", \"Skin\" {\n\t}\n");
    links(OO(2, 0) OO(3, 0) OO(1, 2) OO(4, 1) OO(6, 1) OO(5, 4) OO(3, 5) OO(30, 0) OO(31, 30) OO(32, 1));
    warns("'_93_AA' had bytes that are not UTF-8");
    warns("constraint 'aim' is a constraint");
    warns("is a subdivision surface");
    warns("more than one skin");
    warns("dual quaternion");
    warns("is additive");
    warns("'sheet' is a surface or a curve");
    warns("moved by a point cache");
    warns("node 'sheet' has a transform that is not finite");
}

/* A byte order mark is skipped; an impossible unit is a centimetre, and a number that comes twice is warned of. */
static void marks_units_and_numbers(void **state)
{
    static const char usual[] = "\"\",100\n";
    static char marked[sizeof text + 3] = "\xef\xbb\xbf";
    model *m;
    char *unit;
    (void)state;
    begin();
    unit = strstr(text, usual);
    assert_non_null(unit);
    memcpy(unit, "\"\",  0\n", sizeof usual - 1u);
    add_triangle(1, "");
    add_object("Model", 2, "sheet", "Mesh", "", "");
    add_object("Model", 2, "again", "Null", "", "");
    links(OO(2, 0) OO(1, 2));
    strcpy(marked + 3, text);
    m = load_bytes(marked, strlen(marked));
    assert_true(has_warning(m, "the file's unit is impossible, and 1 cm was taken"));
    assert_true(has_warning(m, "the object 'again' has the number of another one"));
    assert_int_equal(m->mesh_count, 1);
    model_free(m);
}

/* As C libraries spell them; a comma may begin a line. */
#define UV_LAYER(number, name, values)                                                                                \
    "\t\tLayerElementUV: " number " {\n\t\t\tName: \"" name "\"\n\t\t\tMappingInformationType: \"ByPolygonVertex\"\n" \
    "\t\t\tReferenceInformationType: \"Direct\"\n\t\t\tUV: *6 {\n\t\t\t\ta: " values "\n\t\t\t}\n\t\t}\n"

/* A picture names its set of texture coordinates; a build may keep others. */
static void each_picture_has_its_texture_coordinates(void **state)
{
    extra_list second = { 1, { "TEXCOORD_1" }, { 0 } };
    const fbx_options keep = { 0.0, &second };
    model_error error = { "", "" };
    model *m;
    (void)state;
    begin();
    add_triangle(1, UV_LAYER("0", "atlas", "0,0,1,0,0,1") UV_LAYER("1", "light", "0.5,0.25,0.5,0.25,0.5,0.5"));
    add_object("Model", 2, "t", "Mesh", "", "");
    add_object("Material", 3, "lit", "", "", "");
    add_object("Texture", 4, "map", "", "\t\tP: \"UVSet\", \"KString\", \"\", \"\", \"light\"\n",
               "\t\tRelativeFilename: \"none.png\"\n");
    links(OO(2, 0) OO(1, 2) OO(3, 2) OP(4, 3, "DiffuseColor"));
    m = load();
    assert_near((double)m->meshes[0].uv[0], 0.5);
    assert_near((double)m->meshes[0].uv[1], 0.75);
    assert_true(has_warning(m, "has 2 sets of texture coordinates"));
    model_free(m);
    if (fbx_read(test_path("a.fbx"), &keep, &m, &error)) fail_msg("refused: %s", error.what);
    assert_near((double)m->meshes[0].uv[1], 0.75);
    assert_near((double)m->meshes[0].extra[NOH_EXTRAS_MAX * 4], 1.0); /* the other set */
    model_free(m);
    memcpy(strstr(text, "\"\", \"light\""), "\"\", \"atlas\"", 11);
    test_write_file(test_path("a.fbx"), text, strlen(text));
    if (fbx_read(test_path("a.fbx"), &keep, &m, &error)) fail_msg("refused: %s", error.what);
    assert_near((double)m->meshes[0].uv[2], 1.0);
    assert_int_equal(m->meshes[0].extras[0].width, 2);
    assert_near((double)m->meshes[0].extra[0], 0.5);
    assert_near((double)m->meshes[0].extra[1], 0.75);
    assert_near((double)m->meshes[0].extra[2 * NOH_EXTRAS_MAX * 4 + 1], 0.5);
    assert_false(has_warning(m, "sets of texture coordinates"));
    assert_false(has_warning(m, "TEXCOORD_1"));
    model_free(m);
}

static void words_in_place_of_numbers_are_zero(void **state)
{
    model *m;
    (void)state;
    begin();
    add("\tGeometry: 1, \"Geometry::t\", \"Mesh\" {\n\t\tVertices: *9 {\n\t\t\ta: 1.#IND,-nan(ind),snan\n"
        "\t\t\t,1,infty,-1.#INF,2,1,nan\n\t\t}\n\t\tPolygonVertexIndex: *3 {\n\t\t\ta: 0,1,-3\n\t\t}\n\t}\n");
    add_object("Model", 2, "sheet", "Mesh", "", "");
    links(OO(2, 0) OO(1, 2));
    m = load();
    assert_true(has_warning(m, "numbers that are not finite"));
    for (uint32_t i = 0; i < 9; i++) {
        static const float wanted[9] = { 0, 0, 0, 1, 0, 0, 2, 1, 0 };
        assert_true(m->meshes[0].position[i] == wanted[i]);
    }
    model_free(m);
}

static void refused(const void *bytes, size_t count, const char *what, const char *where)
{
    const fbx_options plain = { 0.0, NULL };
    model *m = (model *)1;
    model_error error = { "", "" };
    test_write_file(test_path("a.fbx"), bytes, count);
    assert_int_equal(fbx_read(test_path("a.fbx"), &plain, &m, &error), 1);
    assert_null(m);
    if (!strstr(error.what, what) || !strstr(error.where, where))
        fail_msg("expected '%s' at '%s', got '%s' at '%s'", what, where, error.what, error.where);
}

static void damaged_files_are_refused(void **state)
{
    static uint8_t bytes[1 << 16];
    const fbx_form form = { 7400, 0, 1 };
    const fbx_form old = { 5800, 0, 0 };
    size_t count;
    (void)state;
    make_all();
    count = fbx_binary_write(text, &form, bytes, sizeof bytes);
    refused(bytes, count / 2, "truncated", "byte ");
    refused(text, strlen(text) / 2, "truncated", "line ");
    refused("Kaydara FBX Binary     \x1a", 24, "copied as text", "byte 0");
    refused("no FBX", 6, "not an FBX file", "byte 0");
    count = fbx_binary_write(text, &old, bytes, sizeof bytes);
    refused(bytes, count, "version 5800", "FBX header");
    begin();
    links("");
    refused(text, strlen(text), "nothing to convert", "");
}

/* Changed bytes and cut ends give a model or an error. */
static void mutations_never_crash(void **state)
{
    static uint8_t bytes[1 << 16];
    const fbx_options plain = { 0.0, NULL };
    test_random r = test_random_from(11);
    const int rounds = test_rounds(3000);
    int accepted = 0;
    (void)state;
    for (int i = 0; i < rounds; i++) {
        const fbx_form form = { i % 2 ? 7400 : 7500, i / 2 % 2, i / 4 % 2 };
        const int is_text = i % 3 == 0;
        model *m = NULL;
        model_error error = { "", "" };
        size_t count;
        if (i % 5 == 0)
            make_six();
        else
            make_all();
        count = is_text ? strlen(text) : fbx_binary_write(text, &form, bytes, sizeof bytes);
        if (is_text) memcpy(bytes, text, count);
        for (uint32_t n = 1 + test_random_below(&r, 4); n > 0; --n)
            bytes[test_random_below(&r, (uint32_t)count)] = (uint8_t)test_random_below(&r, 256);
        if (test_random_below(&r, 8) == 0) count = test_random_below(&r, (uint32_t)count);
        test_write_file(test_path("mutated.fbx"), bytes, count);
        if (fbx_read(test_path("mutated.fbx"), &plain, &m, &error))
            assert_true(error.what[0] != '\0');
        else
            ++accepted;
        model_free(m);
    }
    assert_true(accepted > 0 && accepted < rounds);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_form_is_the_same_model),
    cmocka_unit_test(version_six_is_read),
    cmocka_unit_test(pivots_and_orders),
    cmocka_unit_test(inherit_types),
    cmocka_unit_test(geometric_transforms_stay_with_the_mesh),
    cmocka_unit_test(a_bone_may_have_the_mesh_s_name),
    cmocka_unit_test(curves_of_all_kinds),
    cmocka_unit_test(weighted_tangents),
    cmocka_unit_test(layers_are_blended),
    cmocka_unit_test(takes_have_their_span),
    cmocka_unit_test(a_take_of_two_frames_is_whole),
    cmocka_unit_test(masks_and_in_betweens),
    cmocka_unit_test(materials_and_pictures),
    cmocka_unit_test(pictures_have_any_name),
    cmocka_unit_test(a_missing_picture_leaves_white),
    cmocka_unit_test(hidden_nodes_are_not_drawn),
    cmocka_unit_test(losses_are_warned_of),
    cmocka_unit_test(marks_units_and_numbers),
    cmocka_unit_test(each_picture_has_its_texture_coordinates),
    cmocka_unit_test(words_in_place_of_numbers_are_zero),
    cmocka_unit_test(damaged_files_are_refused),
    cmocka_unit_test(mutations_never_crash),
};

TEST_MAIN(tests, NULL, NULL)
