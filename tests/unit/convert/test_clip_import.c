/* test_clip_import.c: glTF skins and animations as skeletons and sampled clips.
 *
 * Small files are written by the test; real ones are compared, in object space, with an
 * oracle that poses all of the file's nodes in double precision with libm. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/clips/model_clips.h"
#include "convert/clips/raw_set.h"
#include "convert/clips/rcl.h"

/* --- writing files --- */

typedef struct scene {
    float numbers[8192];
    size_t count;
    int accessor_count;
    char views[8192], accessors[8192], samplers[4096], channels[4096];
    const char *nodes, *skins, *meshes, *animation_rest, *rest; /* contents of the JSON arrays */
    int sampler_count;
} scene;

static char file_path[4096];

static scene *scene_new(const char *nodes)
{
    scene *s = test_zeros(sizeof *s);
    s->nodes = nodes;
    return s;
}

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
static void
append(char *text, size_t capacity, const char *format, ...)
{
    size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    int written = vsnprintf(text + used, capacity - used, format, arguments);
    va_end(arguments);
    assert_true(written >= 0 && (size_t)written < capacity - used);
}
#define APPEND(text, ...) append(text, sizeof(text), __VA_ARGS__)

static int add_floats(scene *s, const float *values, size_t count, const char *type, size_t width)
{
    const char *comma = s->accessor_count ? "," : "";
    assert_true(s->count + count <= TEST_COUNT(s->numbers));
    APPEND(s->views, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", comma, s->count * 4, count * 4);
    APPEND(s->accessors, "%s{\"bufferView\":%d,\"componentType\":5126,\"count\":%zu,\"type\":\"%s\"}", comma,
           s->accessor_count, count / width, type);
    memcpy(s->numbers + s->count, values, count * sizeof *values);
    s->count += count;
    return s->accessor_count++;
}

/* width 1 (weights), 3 or 4; values: floats in all */
static void add_channel(scene *s, int node, const char *path, const char *interpolation, const float *times,
                        size_t keys, const float *values, size_t value_count, size_t width)
{
    static const char *const types[5] = { "", "SCALAR", "", "VEC3", "VEC4" };
    int input = add_floats(s, times, keys, "SCALAR", 1),
        output = add_floats(s, values, value_count, types[width], width);
    const char *comma = s->sampler_count ? "," : "";
    APPEND(s->samplers, "%s{\"input\":%d,\"output\":%d,\"interpolation\":\"%s\"}", comma, input, output, interpolation);
    APPEND(s->channels, "%s{\"sampler\":%d,\"target\":{\"node\":%d,\"path\":\"%s\"}}", comma, s->sampler_count, node,
           path);
    ++s->sampler_count;
}

static void add_turn(scene *s, int node, const char *interpolation, const float *times, size_t keys,
                     const float *values, size_t count)
{
    add_channel(s, node, "rotation", interpolation, times, keys, values, count, 4);
}

static void add_move(scene *s, int node, const char *interpolation, const float *times, size_t keys,
                     const float *values, size_t count)
{
    add_channel(s, node, "translation", interpolation, times, keys, values, count, 3);
}

static void write_array(FILE *out, const char *name, const char *contents)
{
    if (contents && contents[0]) fprintf(out, ",\"%s\":[%s]", name, contents);
}

static void save(scene *s)
{
    test_write_file(test_path("scene.bin"), s->numbers, s->count * 4);
    snprintf(file_path, sizeof file_path, "%s", test_path("scene.gltf"));
    FILE *out = fopen(file_path, "wb");
    assert_non_null(out);
    fprintf(out, "{\"asset\":{\"version\":\"2.0\"}");
    if (s->count) fprintf(out, ",\"buffers\":[{\"uri\":\"scene.bin\",\"byteLength\":%zu}]", s->count * 4);
    write_array(out, "bufferViews", s->views);
    write_array(out, "accessors", s->accessors);
    write_array(out, "nodes", s->nodes);
    write_array(out, "skins", s->skins);
    write_array(out, "meshes", s->meshes);
    if (s->channels[0])
        fprintf(out, ",\"animations\":[{\"name\":\"act\",\"samplers\":[%s],\"channels\":[%s]%s}]", s->samplers,
                s->channels, s->animation_rest ? s->animation_rest : "");
    fprintf(out, "%s}", s->rest ? s->rest : "");
    fclose(out);
    free(s);
}

/* --- loading --- */

typedef struct loaded {
    model *m;
    model_clips *made;
} loaded;

static loaded load_file(double sample_rate_hz)
{
    loaded l = { NULL, NULL };
    model_error error = { "", "" };
    const sample_options options = { sample_rate_hz };
    if (model_read_gltf(file_path, &l.m, &error) || clips_from_model(l.m, &options, &l.made, &error))
        fail_msg("refused: %s (%s)", error.what, error.where);
    return l;
}

static loaded load(scene *s, double sample_rate_hz)
{
    save(s);
    return load_file(sample_rate_hz);
}

static void loaded_free(loaded *l)
{
    model_clips_free(l->made);
    model_free(l->m);
}

static void refused(scene *s, double sample_rate_hz, const char *what, const char *where)
{
    loaded l = { NULL, NULL };
    model_error error = { "", "" };
    const sample_options options = { sample_rate_hz };
    save(s);
    int failed = model_read_gltf(file_path, &l.m, &error) || clips_from_model(l.m, &options, &l.made, &error);
    assert_int_equal(failed, 1);
    assert_null(l.made);
    if (!strstr(error.what, what) || !strstr(error.where, where))
        fail_msg("expected '%s' at '%s', got '%s' at '%s'", what, where, error.what, error.where);
    model_free(l.m);
}

static const raw_clip *only_clip(const loaded *l)
{
    assert_int_equal(l->made->set_count, 1);
    assert_int_equal(l->made->sets[0]->clip_count, 1);
    return &l->made->sets[0]->clips[0];
}

static int has_warning(const model *m, const char *text)
{
    for (uint32_t i = 0; i < m->warning_count; ++i)
        if (strstr(m->warnings[i], text)) return 1;
    return 0;
}

/* --- the oracle --- */

typedef struct node_pose {
    double rotation[4], translation[3], scale[3];
} node_pose;

static void unit(double *q)
{
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; ++i) q[i] /= length;
}

static void slerp(const double *a, const double *b, double t, double *out)
{
    double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3], sign = dot < 0.0 ? -1.0 : 1.0;
    double angle = acos(fmin(fabs(dot), 1.0));
    double wa = angle < 1e-6 ? 1.0 - t : sin(angle * (1.0 - t)) / sin(angle);
    double wb = angle < 1e-6 ? t : sin(angle * t) / sin(angle);
    for (int i = 0; i < 4; ++i) out[i] = wa * a[i] + sign * wb * b[i];
    unit(out);
}

/* As appendix C of the specification writes it. */
static void oracle_channel(const model_channel *c, double t, double *out)
{
    uint32_t k = 0, w = c->width, cubic = c->interpolation == MODEL_CUBICSPLINE;
    while (k + 1 < c->key_count && (double)c->times[k + 1] <= t) ++k;
    const float *v = c->values + (size_t)k * w * (cubic ? 3 : 1) + (cubic ? w : 0);
    const float *next = v + (cubic ? 3 * w : w);
    double td = k + 1 < c->key_count ? (double)c->times[k + 1] - (double)c->times[k] : 1.0;
    double u = k + 1 < c->key_count ? (t - (double)c->times[k]) / td : 0.0;
    u = u < 0.0 || c->interpolation == MODEL_STEP ? 0.0 : u;
    for (uint32_t i = 0; i < w; ++i) {
        double a = (double)v[i], b = u > 0.0 ? (double)next[i] : a;
        out[i] = a + (b - a) * u;
        if (cubic && u > 0.0)
            out[i] = (2 * u * u * u - 3 * u * u + 1) * a + td * (u * u * u - 2 * u * u + u) * (double)v[w + i] +
                     (3 * u * u - 2 * u * u * u) * b + td * (u * u * u - u * u) * (double)(next - w)[i];
    }
    if (c->path != MODEL_PATH_ROTATION) return;
    if (!cubic && u > 0.0) {
        double a[4], b[4];
        for (int i = 0; i < 4; ++i) {
            a[i] = (double)v[i];
            b[i] = (double)next[i];
        }
        unit(a);
        unit(b);
        slerp(a, b, u, out);
    }
    unit(out);
}

static node_pose oracle_node(const model *m, const model_clip *clip, uint32_t node, double t)
{
    const model_node *n = &m->nodes[node];
    node_pose pose;
    for (int i = 0; i < 4; ++i) pose.rotation[i] = (double)n->rotation[i];
    for (int i = 0; i < 3; ++i) {
        pose.translation[i] = (double)n->translation[i];
        pose.scale[i] = (double)n->scale[i];
    }
    for (uint32_t i = 0; i < clip->channel_count; ++i) {
        const model_channel *c = &clip->channels[i];
        if (c->node == node && c->path != MODEL_PATH_WEIGHTS)
            oracle_channel(c, t,
                           c->path == MODEL_PATH_ROTATION      ? pose.rotation
                           : c->path == MODEL_PATH_TRANSLATION ? pose.translation
                                                               : pose.scale);
    }
    return pose;
}

/* World matrices [nodes][12], columns and translation, by rotating each column. */
static void oracle_pose(const model *m, const model_clip *clip, double t, double *out)
{
    for (uint32_t n = 0; n < m->node_count; ++n) {
        node_pose p = oracle_node(m, clip, n, t);
        const double *q = p.rotation;
        double local[12];
        for (int c = 0; c < 3; ++c) {
            double v[3] = { 0, 0, 0 }, u[3], w[3];
            v[c] = p.scale[c];
            for (int i = 0; i < 3; ++i) u[i] = 2 * (q[(i + 1) % 3] * v[(i + 2) % 3] - q[(i + 2) % 3] * v[(i + 1) % 3]);
            for (int i = 0; i < 3; ++i)
                w[i] = v[i] + q[3] * u[i] + q[(i + 1) % 3] * u[(i + 2) % 3] - q[(i + 2) % 3] * u[(i + 1) % 3];
            memcpy(local + c * 3, w, sizeof w);
        }
        memcpy(local + 9, p.translation, sizeof p.translation);
        double *world = out + (size_t)n * 12;
        memcpy(world, local, sizeof local);
        for (int i = 0; m->nodes[n].parent != MODEL_NONE && i < 12; ++i) {
            const double *up = out + (size_t)m->nodes[n].parent * 12, *column = local + i / 3 * 3;
            world[i] = up[i % 3] * column[0] + up[3 + i % 3] * column[1] + up[6 + i % 3] * column[2] +
                       (i >= 9 ? up[9 + i % 3] : 0.0);
        }
    }
}

static const model_clip *source_of(const model *m, const raw_clip *clip)
{
    for (uint32_t i = 0; i < m->clip_count; ++i)
        if (strcmp(m->clips[i].name, clip->name) == 0) return &m->clips[i];
    fail_msg("clip '%s' has no source", clip->name);
    return NULL;
}

/* The largest difference in object space of all joints at all frames, relative to the pose's size. */
static double frames_against_oracle(const model *m, const raw_set *set, const raw_clip *clip)
{
    const model_clip *source = source_of(m, clip);
    double *world = test_zeros((size_t)m->node_count * 12 * sizeof *world), worst = 0.0, size = 1e-9;
    double *pose = test_zeros((size_t)set->skeleton.joint_count * 12 * sizeof *pose + 8);
    for (uint32_t f = 0; f < clip->frame_count; ++f) {
        oracle_pose(m, source, (double)f / clip->sample_rate_hz, world);
        raw_pose_object(&set->skeleton, clip, f, pose);
        for (size_t i = 0; i < (size_t)set->skeleton.joint_count * 12; ++i) {
            double expected = world[(size_t)set->skeleton.joints[i / 12].node * 12 + i % 12];
            size = fmax(size, fabs(expected));
            worst = fmax(worst, fabs(pose[i] - expected));
        }
    }
    free(world);
    free(pose);
    return worst / size;
}

static double weights_against_oracle(const model *m, const raw_clip *clip)
{
    const model_clip *source = source_of(m, clip);
    double worst = 0.0, expected[512];
    for (uint32_t g = 0; g < clip->float_count; ++g)
        for (uint32_t i = 0; i < source->channel_count; ++i) {
            const model_channel *c = &source->channels[i];
            if (c->path != MODEL_PATH_WEIGHTS || c->node != clip->floats[g].node) continue;
            assert_int_equal(clip->floats[g].width, c->width);
            for (uint32_t f = 0; f < clip->frame_count; ++f) {
                oracle_channel(c, (double)f / clip->sample_rate_hz, expected);
                for (uint32_t k = 0; k < c->width; ++k)
                    worst = fmax(worst, fabs((double)clip->floats[g].values[(size_t)f * c->width + k] - expected[k]));
            }
        }
    return worst;
}

/* --- which nodes are joints --- */

static const float two_times[2] = { 0, 1 };
static const float two_moves[6] = { 0, 0, 0, 1, 0, 0 };

/* 0 turned > 1 identity > 2 joint > 3 identity > 4 joint > 5 bare; 6 apart */
#define TREE                                                                                                   \
    "{\"name\":\"turned\",\"children\":[1],\"rotation\":[0,0,0.6,0.8]},{\"name\":\"plain\",\"children\":[2]}," \
    "{\"name\":\"hip\",\"children\":[3],\"translation\":[0,1,0]},{\"name\":\"between\",\"children\":[4]},"     \
    "{\"name\":\"knee\",\"children\":[5],\"translation\":[0,-1,0],\"scale\":[1,2,1]},{\"name\":\"bare\"},{\"name\":\"apart\"}"

static void only_what_moves_or_transforms_is_a_joint(void **state)
{
    (void)state;
    scene *s = scene_new(TREE);
    s->skins = "{\"name\":\"rig\",\"joints\":[4,2]}";
    add_move(s, 2, "LINEAR", two_times, 2, two_moves, 6);
    loaded l = load(s, 0.0);
    const raw_skeleton *k = &l.made->sets[0]->skeleton;
    assert_int_equal(l.made->set_count, 1);
    assert_string_equal(k->name, "rig");
    assert_true(k->unit_cm == 100.0);
    assert_int_equal(k->joint_count, 3);
    assert_string_equal(k->joints[0].name, "turned");
    assert_string_equal(k->joints[1].name, "hip");
    assert_string_equal(k->joints[2].name, "knee");
    assert_int_equal(k->joints[0].parent, MODEL_NONE);
    assert_int_equal(k->joints[1].parent, 0);
    assert_int_equal(k->joints[2].parent, 1);
    assert_true(k->joints[2].scale[1] == 2.0f && k->joints[2].translation[1] == -1.0f &&
                k->joints[0].rotation[2] == 0.6f);
    assert_int_equal(l.made->skins[0].set, 0);
    assert_int_equal(l.made->skins[0].joints[0], 2);
    assert_int_equal(l.made->skins[0].joints[1], 1);
    /* the joint that moves each node */
    static const uint32_t movers[7] = { 0, 0, 1, 1, 2, 2, MODEL_NONE };
    for (uint32_t n = 0; n < 7; ++n) assert_int_equal(l.made->nodes[n].joint, movers[n]);
    assert_int_equal(l.made->nodes[6].set, MODEL_NONE);
    assert_true(frames_against_oracle(l.m, l.made->sets[0], only_clip(&l)) < 1e-7);
    loaded_free(&l);
}

static void animated_nodes_around_joints_are_joints(void **state)
{
    (void)state;
    scene *s = scene_new(TREE);
    s->skins = "{\"joints\":[2]}";
    add_move(s, 1, "LINEAR", two_times, 2, two_moves, 6); /* above, of no transform itself */
    add_move(s, 5, "LINEAR", two_times, 2, two_moves, 6); /* below: needs the knee's transform too */
    add_move(s, 6, "LINEAR", two_times, 2, two_moves, 6); /* apart: a skeleton of its own */
    loaded l = load(s, 0.0);
    assert_int_equal(l.made->set_count, 2);
    const raw_skeleton *k = &l.made->sets[0]->skeleton;
    static const char *const names[5] = { "turned", "plain", "hip", "knee", "bare" };
    assert_int_equal(k->joint_count, 5);
    for (int i = 0; i < 5; ++i) assert_string_equal(k->joints[i].name, names[i]);
    assert_int_equal(l.made->sets[1]->skeleton.joint_count, 1);
    assert_string_equal(l.made->sets[1]->skeleton.joints[0].name, "apart");
    assert_int_equal(l.made->nodes[6].set, 1);
    for (uint32_t i = 0; i < 2; ++i) {
        assert_int_equal(l.made->sets[i]->clip_count, 1);
        assert_true(frames_against_oracle(l.m, l.made->sets[i], &l.made->sets[i]->clips[0]) < 1e-7);
    }
    loaded_free(&l);
}

static void animations_without_skins(void **state)
{
    (void)state;
    scene *s = scene_new(
        "{\"name\":\"base\",\"children\":[1],\"scale\":[2,2,2]},{\"name\":\"crane\",\"children\":[2]},"
        "{\"name\":\"hook\",\"matrix\":[0,1,0,0,-1,0,0,0,0,0,1,0,1,2,3,1],\"children\":[3]},{\"name\":\"load\"}");
    const float turns[8] = { 0, 0, 0, 1, 0, 0, 0.6f, 0.8f };
    add_turn(s, 1, "LINEAR", two_times, 2, turns, 8);
    add_channel(s, 3, "scale", "LINEAR", two_times, 2, (const float[6]){ 1, 1, 1, 1, 3, 0.5f }, 6, 3);
    loaded l = load(s, 0.0);
    assert_int_equal(l.made->sets[0]->skeleton.joint_count, 4);
    assert_true(frames_against_oracle(l.m, l.made->sets[0], only_clip(&l)) < 1e-6);
    loaded_free(&l);
}

static uint32_t sets_of(const char *skins)
{
    scene *s = scene_new(
        "{\"children\":[1,2]},{\"children\":[3],\"translation\":[1,0,0]},{\"translation\":[1,0,0]},{\"translation\":[1,0,0]}");
    s->skins = skins;
    add_move(s, 0, "LINEAR", two_times, 2, two_moves, 6);
    loaded l = load(s, 0.0);
    uint32_t count = l.made->set_count;
    for (uint32_t i = 0; i < l.m->skin_count; ++i)
        for (uint32_t j = 0; j < l.m->skins[i].joint_count; ++j)
            assert_int_equal(l.made->sets[l.made->skins[i].set]->skeleton.joints[l.made->skins[i].joints[j]].node,
                             l.m->skins[i].joints[j]);
    loaded_free(&l);
    return count;
}

static void skins_share_skeletons(void **state)
{
    (void)state;
    assert_int_equal(sets_of("{\"joints\":[1,2]},{\"joints\":[2,3]}"), 1); /* a node in both */
    assert_int_equal(sets_of("{\"joints\":[3]},{\"joints\":[1]}"), 1);     /* one below the other */
    assert_int_equal(sets_of("{\"joints\":[1,3]},{\"joints\":[2]}"), 2); /* only a node above in common: both hold it */
    assert_int_equal(sets_of("{\"joints\":[1]},{\"joints\":[2]},{\"joints\":[3,2]}"), 1);
}

static scene *with_binds(const float *matrices, size_t count)
{
    scene *s = scene_new("{\"children\":[1],\"name\":\"a\"},{\"name\":\"b\"}");
    add_move(s, 0, "LINEAR", two_times, 2, two_moves, 6);
    add_floats(s, matrices, count * 16, "MAT4", 16);
    s->skins = "{\"joints\":[0,1],\"inverseBindMatrices\":2}";
    return s;
}

static void inverse_bind_matrices(void **state)
{
    (void)state;
    float binds[32] = { 0.01f, 0, 0, 0, 0, 0.01f, 0, 0, 0, 0, -0.01f, 0, 4, 5, 6, 1.00001f,
                        1,     0, 0, 0, 0, 1,     0, 0, 0, 0, 1,      0, 0, 0, 0, 1 };
    loaded l = load(with_binds(binds, 2), 0.0);
    assert_int_equal(l.m->skin_count, 1);
    assert_true(l.m->skins[0].inverse_bind[12] == 4.0f && l.m->skins[0].inverse_bind[15] == 1.0f &&
                l.m->skins[0].inverse_bind[16] == 1.0f);
    loaded_free(&l);
    scene *s = with_binds(binds, 0);
    s->skins = "{\"joints\":[0,1]}";
    s->accessor_count = 2;
    free(s);
    s = scene_new("{\"children\":[1]},{}");
    add_move(s, 0, "LINEAR", two_times, 2, two_moves, 6);
    s->skins = "{\"joints\":[0,1]}";
    l = load(s, 0.0);
    for (size_t i = 0; i < 32; ++i) assert_true(l.m->skins[0].inverse_bind[i] == (i % 16 % 5 == 0 ? 1.0f : 0.0f));
    loaded_free(&l);
}

static void joints_outside_the_scene_are_a_warning(void **state)
{
    (void)state;
    scene *s = scene_new("{\"name\":\"in\"},{\"name\":\"out\"}");
    s->skins = "{\"joints\":[0,1]}";
    s->rest = ",\"scene\":0,\"scenes\":[{\"nodes\":[0]}]";
    add_move(s, 0, "LINEAR", two_times, 2, two_moves, 6);
    loaded l = load(s, 0.0);
    assert_int_equal(l.m->skin_count, 0);
    assert_true(has_warning(l.m, "skin 0 was skipped"));
    assert_int_equal(l.made->set_count, 1);
    loaded_free(&l);
}

/* Joints that the scene forgot are read where a mesh of the scene follows them; meshes there are not. */
static void forgotten_joints_are_read(void **state)
{
    (void)state;
    const float base[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 }, joints[12] = { 0 }, ones[12] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
    scene *s = scene_new("{\"mesh\":0,\"skin\":0},{\"name\":\"root\",\"translation\":[0,1,0],\"mesh\":0,\"children\":"
                         "[2]},{\"name\":\"tip\",\"translation\":[0,1,0]},{\"name\":\"far\"}");
    unsigned char zero_joints[16] = { 0 };
    add_floats(s, base, 9, "VEC3", 3);
    add_floats(s, joints, 12, "VEC4", 4);
    add_floats(s, ones, 12, "VEC4", 4);
    memcpy(s->numbers + 9, zero_joints, 12);
    memcpy(strstr(strstr(s->accessors, "},{"), "5126"), "5121", 4);
    s->meshes = "{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":2}}]}";
    s->skins = "{\"joints\":[2]}";
    s->rest = ",\"scene\":0,\"scenes\":[{\"nodes\":[0]}]";
    add_move(s, 2, "LINEAR", two_times, 2, two_moves, 6);
    loaded l = load(s, 0.0);
    assert_int_equal(l.m->node_count, 3);
    assert_true(l.m->skin_count == 1 && l.m->nodes[l.m->skins[0].joints[0]].world[13] == 2.0);
    assert_true(l.m->nodes[1].mesh == MODEL_NONE && l.m->clip_count == 1);
    assert_true(has_warning(l.m, "node 'root' holds joints of a skin but is not in the default scene"));
    assert_true(has_warning(l.m, "node 'far' was left out: it is not in the default scene"));
    loaded_free(&l);
}

static char *flat_nodes(uint32_t count, char **skin)
{
    char *nodes = test_zeros((size_t)count * 48), *at = nodes;
    *skin = test_zeros((size_t)count * 8 + 64);
    char *joint = *skin + sprintf(*skin, "{\"joints\":[");
    for (uint32_t i = 0; i < count; ++i) {
        at += sprintf(at, "%s{\"translation\":[%u,0,0]}", i ? "," : "", i);
        joint += sprintf(joint, "%s%u", i ? "," : "", i);
    }
    sprintf(joint, "]}");
    return nodes;
}

static void joint_limit(void **state)
{
    (void)state;
    for (uint32_t count = 4096; count <= 4097; ++count) {
        char *skin, *nodes = flat_nodes(count, &skin);
        scene *s = scene_new(nodes);
        s->skins = skin;
        add_move(s, 0, "LINEAR", two_times, 2, two_moves, 6);
        if (count == 4096) {
            loaded l = load(s, 0.0);
            assert_int_equal(l.made->sets[0]->skeleton.joint_count, 4096);
            loaded_free(&l);
        } else {
            refused(s, 0.0, "4097 joints, with the nodes above them that move; the limit is 4096", "skeleton 'skin_0'");
        }
        free(nodes);
        free(skin);
    }
}

/* --- sampling --- */

/* Keys that need normalising, a change of sign, and a half turn. */
static const float turn_times[4] = { 0, 0.25f, 0.5f, 1.5f };
static const float turn_keys[16] = { 0, 0, 0, 2, 0, 0, -0.6f, -0.8f, 0.7f, 0, 0.1f, 0.7f, 0, 1, 0, 1e-3f };

static void linear_turns_are_spherical(void **state)
{
    (void)state;
    scene *s = scene_new("{}");
    add_turn(s, 0, "LINEAR", turn_times, 4, turn_keys, 16);
    loaded l = load(s, 100.0);
    const raw_clip *clip = only_clip(&l);
    assert_int_equal(clip->frame_count, 151);
    assert_true(frames_against_oracle(l.m, l.made->sets[0], clip) < 2e-7);
    for (size_t f = 0; f < 151; ++f) {
        const float *q = clip->rotations + f * 4;
        assert_true(fabsf(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1.0f) < 3e-7f);
        if (f > 0) assert_true(q[0] * q[-4] + q[1] * q[-3] + q[2] * q[-2] + q[3] * q[-1] > 0.9f);
    }
    loaded_free(&l);
}

static void splines_are_normalised(void **state)
{
    (void)state;
    const float times[3] = { 0.5f, 1.0f, 2.0f };
    const float turns[36] = { 0,      0, 0,  0, 0, 0,    0,    1,    0.5f, 1, 0, 0,
                              /**/ 0, 2, 0,  0, 0, 0.7f, 0,    0.7f, 1,    0, 0, 0,
                              /**/ 0, 0, -1, 0, 0, 0.7f, 0.7f, 0,    0,    0, 0, 0 };
    const float moves[27] = { 0, 0, 0, 1, 2, 3, 4, 0, 0, 0, 5, 0, 0, 2, 0, 0, -5, 0, 1, 1, 1, 3, 3, 3, 0, 0, 0 };
    scene *s = scene_new("{}");
    add_turn(s, 0, "CUBICSPLINE", times, 3, turns, 36);
    add_move(s, 0, "CUBICSPLINE", times, 3, moves, 27);
    loaded l = load(s, 60.0);
    const raw_clip *clip = only_clip(&l);
    assert_int_equal(clip->frame_count, 121);
    assert_true(frames_against_oracle(l.m, l.made->sets[0], clip) < 2e-7);
    assert_true(clip->translations[0] == 1.0f && clip->translations[1] == 2.0f); /* before the first key it holds */
    loaded_free(&l);
}

static void steps_hold(void **state)
{
    (void)state;
    const float times[3] = { 0, 0.5f, 1 };
    const float moves[9] = { 0, 0, 0, 1, 0, 0, 3, 0, 0 };
    scene *s = scene_new("{}");
    add_move(s, 0, "STEP", times, 3, moves, 9);
    loaded l = load(s, 20.0);
    const raw_clip *clip = only_clip(&l);
    assert_int_equal(clip->frame_count, 21);
    for (size_t f = 0; f < 21; ++f) assert_true(clip->translations[f * 3] == (f < 10 ? 0.0f : f < 20 ? 1.0f : 3.0f));
    loaded_free(&l);
}

/* A spline through zero has no direction there: the key before stays. */
static void rotations_without_length_hold(void **state)
{
    (void)state;
    const float spline[24] = { 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1, 0, 0, 0, 0 };
    scene *s = scene_new("{\"name\":\"n\"}");
    add_turn(s, 0, "CUBICSPLINE", two_times, 2, spline, 24);
    loaded l = load(s, 2.0);
    const raw_clip *clip = only_clip(&l);
    assert_true(clip->frame_count == 3 && fabsf(clip->rotations[4 + 3]) == 1.0f);
    assert_true(l.m->warning_count == 1 && strstr(l.m->warnings[0], "passes through zero at 0.5 s"));
    loaded_free(&l);
}

/* Keys before 0 move the clip: all of its channels by the same time. */
static void keys_before_zero_are_shifted(void **state)
{
    (void)state;
    const float early[2] = { -0.5f, 0.5f }, late[2] = { 0.25f, 1.0f };
    scene *s = scene_new("{},{}");
    add_move(s, 0, "LINEAR", early, 2, two_moves, 6);
    add_move(s, 1, "LINEAR", late, 2, two_moves, 6);
    loaded l = load(s, 4.0);
    const raw_clip *clip = only_clip(&l);
    assert_int_equal(clip->frame_count, 7);
    assert_true(l.m->clips[0].channels[0].times[0] == 0.0f && l.m->clips[0].channels[1].times[0] == 0.75f);
    assert_true(l.m->warning_count == 1 && strstr(l.m->warnings[0], "its first key is at -0.5 s; the clip begins"));
    loaded_free(&l);
    const float past[2] = { -3.0f, -2.5f };
    s = scene_new("{},{}");
    add_move(s, 0, "LINEAR", past, 2, two_moves, 6);
    l = load(s, 4.0);
    assert_int_equal(only_clip(&l)->frame_count, 3);
    loaded_free(&l);
}

static void missing_targets_are_a_warning(void **state)
{
    (void)state;
    scene *s = scene_new("{}");
    add_move(s, 0, "LINEAR", two_times, 2, two_moves, 6);
    add_move(s, 0, "LINEAR", two_times, 2, two_moves, 6);
    memcpy(strstr(strstr(s->channels, "},{"), "\"node\":0"), "\"nodf\":0", 8);
    loaded l = load(s, 0.0);
    assert_true(has_warning(l.m, "has no target node"));
    loaded_free(&l);
    s = scene_new("{}");
    add_move(s, 7, "LINEAR", two_times, 2, two_moves, 6);
    refused(s, 0.0, "nothing to convert; a part was skipped: its target node does not exist",
            "animation 'act' channel 0");
}

/* --- rates --- */

/* A turn about z with keys at i / rate, a little each. */
static scene *turning(size_t keys, double sample_rate_hz, double degrees_per_key, double offset_s)
{
    float times[256], values[1024] = { 0 };
    assert_true(keys <= 256);
    for (size_t i = 0; i < keys; ++i) {
        times[i] = (float)((double)i / sample_rate_hz + (i ? offset_s : 0.0));
        values[i * 4 + 2] = (float)sin((double)i * degrees_per_key * 0.00872664626);
        values[i * 4 + 3] = (float)cos((double)i * degrees_per_key * 0.00872664626);
    }
    scene *s = scene_new("{}");
    add_turn(s, 0, "LINEAR", times, keys, values, keys * 4);
    return s;
}

static void rate_is(scene *s, double asked_hz, double sample_rate_hz, uint32_t frames)
{
    loaded l = load(s, asked_hz);
    const raw_clip *clip = only_clip(&l);
    if (fabs(clip->sample_rate_hz - sample_rate_hz) > 1e-6 * sample_rate_hz || clip->frame_count != frames)
        fail_msg("%u frames at %.9g Hz, not %u at %.9g", clip->frame_count, clip->sample_rate_hz, frames,
                 sample_rate_hz);
    assert_true(fabs(raw_clip_duration_s(clip) - (double)l.m->clips[0].duration_s) <= 2e-6 * raw_clip_duration_s(clip));
    assert_true(frames_against_oracle(l.m, l.made->sets[0], clip) < 1e-5); /* snapped to keys whose times are floats */
    loaded_free(&l);
}

static void key_rates_are_found(void **state)
{
    (void)state;
    static const double rates[] = {
        15.0, 24.0, 25.0, 30.0, 60.0, 90.0, 120.0, 23.976023976, 29.97002997, 20.71, 240.0
    };
    for (size_t i = 0; i < TEST_COUNT(rates); ++i) rate_is(turning(200, rates[i], 10.0, 0.0), 0.0, rates[i], 200);
    rate_is(turning(1, 30.0, 10.0, 0.0), 0.0, 30.0, 1);
    rate_is(turning(2, 0.5, 0.0, 0.0), 0.0, 1.0, 3); /* nothing turns: the lowest */
}

/* Keys that lie closer than a rate can say: the first is the clip. */
static void a_moment_is_one_frame(void **state)
{
    (void)state;
    const float times[2] = { 0.0f, 1e-40f }, moves[6] = { 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f };
    scene *s = scene_new("{}");
    add_move(s, 0, "LINEAR", times, 2, moves, 6);
    loaded l = load(s, 0.0);
    const raw_clip *clip = only_clip(&l);
    assert_int_equal(clip->frame_count, 1);
    assert_true(clip->sample_rate_hz == 30.0 && clip->translations[0] == 0.0f);
    loaded_free(&l);
}

static void keys_are_taken_as_they_are(void **state)
{
    (void)state;
    loaded l = load(turning(100, 30.0, 7.0, 0.0), 0.0);
    const raw_clip *clip = only_clip(&l);
    const model_channel *c = &l.m->clips[0].channels[0];
    for (size_t i = 0; i < 400; ++i) assert_true(fabsf(fabsf(clip->rotations[i]) - fabsf(c->values[i])) <= 6e-8f);
    loaded_free(&l);
}

/* Editors count frames from 1: what begins a frame late begins at 0, its events with it; who waits longer, waits. */
static void a_first_frame_late_is_cut_off(void **state)
{
    (void)state;
    static const struct {
        float first_s;
        uint32_t frames;
        const char *warning;
    } starts[] = { { 1.0f / 30.0f, 31, "its first key is at 0.0333 s; the clip begins there" },
                   { 1.0f / 24.0f, 31, "its first key is at 0.0417 s" },
                   { 0.0f, 31, NULL },
                   { 0.5f, 46, NULL } };
    for (size_t i = 0; i < TEST_COUNT(starts); ++i) {
        float times[31], moves[93] = { 0 };
        for (size_t k = 0; k < 31; ++k) {
            times[k] = starts[i].first_s + (float)k / 30.0f;
            moves[3 * k] = 0.01f * (float)k;
        }
        scene *s = scene_new("{},{}");
        s->animation_rest = ",\"extras\":{\"events\":[{\"time\":0,\"name\":\"a\"},{\"time\":1,\"name\":\"b\"}]}";
        add_move(s, 0, "LINEAR", times, 31, moves, 93);
        add_move(s, 1, "LINEAR", times, 31, moves, 93);
        loaded l = load(s, 0.0);
        const raw_clip *clip = only_clip(&l);
        const double cut = starts[i].warning ? (double)starts[i].first_s : 0.0;
        assert_int_equal(has_warning(l.m, "the clip begins there"), starts[i].warning != NULL);
        assert_true(!starts[i].warning || has_warning(l.m, starts[i].warning));
        assert_int_equal(clip->frame_count, starts[i].frames);
        assert_true(clip->events[0].time_s == 0.0 && fabs(clip->events[1].time_s - (1.0 - cut)) < 1e-6);
        for (uint32_t f = 0; f < 31; ++f) /* of both nodes */
            for (uint32_t j = 0; j < 2 && starts[i].frames == 31; ++j)
                assert_true(fabsf(clip->translations[(f * 2 + j) * 3] - 0.01f * (float)f) < 1e-5f);
        loaded_free(&l);
    }
}

static void rates_rise_where_playing_strays(void **state)
{
    (void)state;
    loaded l = load(turning(9, 2.0, 80.0, 0.0), 0.0); /* 2 keys a second, far apart */
    const raw_clip *clip = only_clip(&l);
    assert_true(clip->sample_rate_hz > 4.0 && clip->sample_rate_hz <= 40.0 &&
                fabs(fmod(clip->sample_rate_hz, 2.0)) < 1e-9);
    assert_true(clip->source_error_cm > 0.0 && clip->source_error_cm <= 3.0 * 1e-3);
    loaded_free(&l);
    const float moves[6] = { 0, 0, 0, 1, 0, 0 };
    scene *s = scene_new("{}");
    add_move(s, 0, "STEP", two_times, 2, moves, 6);
    l = load(s, 0.0); /* no rate makes a step of a ramp: the highest is taken, and said */
    assert_true(only_clip(&l)->sample_rate_hz == 120.0);
    assert_true(has_warning(l.m, "cm off its curves between frames"));
    loaded_free(&l);
}

/* What holds still is no curve, whatever its interpolation is called, and fast turns between linear keys, played a
 * little nearer to a line than spherical ones go, are frames beside any curve. Exporters write both. */
static void held_steps_and_fast_turns_keep_the_rate(void **state)
{
    const float times[2] = { 0, 1.0f / 30.0f }, still[6] = { 1, 2, 3, 1, 2, 3 }, jump[6] = { 1, 2, 3, 2, 2, 3 };
    loaded l;
    scene *s = turning(40, 30.0, 50.0, 0.0);
    (void)state;
    add_move(s, 0, "STEP", times, 2, still, 6);
    l = load(s, 0.0);
    assert_true(only_clip(&l)->sample_rate_hz == 30.0 && !has_warning(l.m, "--rate"));
    loaded_free(&l);
    s = turning(40, 30.0, 50.0, 0.0);
    add_move(s, 0, "STEP", times, 2, jump, 6);
    l = load(s, 0.0);
    assert_true(only_clip(&l)->sample_rate_hz > 30.0 && has_warning(l.m, "--rate 30 keeps only the keys"));
    loaded_free(&l);
}

static void keys_off_any_grid(void **state)
{
    (void)state;
    const float times[5] = { 0, 0.1003f, 0.2719f, 0.5551f, 0.9137f };
    const float moves[15] = { 0, 0, 0, 0, 0.0002f, 0, 0, 0.001f, 0, 0, 0.0015f, 0, 1, 0.0015f, 0 };
    scene *s = scene_new("{}");
    add_move(s, 0, "LINEAR", times, 5, moves, 15);
    loaded l = load(s, 0.0);
    const raw_clip *clip = only_clip(&l);
    assert_true(fabs(raw_clip_duration_s(clip) - 0.9137) < 1e-6);
    assert_true(clip->translations[(size_t)(clip->frame_count - 1) * 3] == 1.0f); /* the last key, exactly */
    assert_true(frames_against_oracle(l.m, l.made->sets[0], clip) < 3e-3);
    assert_true(clip->sample_rate_hz > 29.0 && clip->sample_rate_hz < 121.0);
    loaded_free(&l);
}

static void asked_rates_keep_the_length(void **state)
{
    (void)state;
    rate_is(turning(18, 24.0, 5.0, 0.0), 30.0, 21.0 / (17.0 / 24.0), 22); /* 21.25 steps become 21 */
    rate_is(turning(18, 24.0, 5.0, 0.0), 48.0, 48.0, 35);
    rate_is(turning(18, 24.0, 5.0, 0.0), 0.1, 1.0 / (17.0 / 24.0), 2);
    rate_is(turning(18, 24.0, 5.0, 1.0), 10.0, 17.0 / (17.0 / 24.0 + 1.0), 18);
}

static void impossible_rates_are_refused(void **state)
{
    (void)state;
    refused(turning(2, 1.0, 5.0, 0.0), -1.0, "not -1 Hz", "");
    refused(turning(2, 1.0, 5.0, 0.0), (double)NAN, "the sample rate must be above 0", "");
    for (int i = 0; i < 2; ++i) {
        loaded l = load(turning(2, i ? 1e-11 : 1e-7, 5.0, 0.0), i ? 1000.0 : 0.0);
        assert_int_equal(l.made->sets[0]->clip_count, 0);
        assert_true(has_warning(l.m, "animation 'act' was left out: it lasts"));
        assert_true(has_warning(l.m, "which is the limit; ask for a lower sample rate"));
        loaded_free(&l);
    }
}

/* --- weights --- */

#define MORPHED "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":1},{\"POSITION\":2}]}]}"

static scene *morphing(const char *nodes)
{
    const float base[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 }, up[9] = { 0, 0, 0, 0, 0, 0.02f, 0.03f, 0, 0.04f },
                none[9] = { 0 };
    scene *s = scene_new(nodes);
    add_floats(s, base, 9, "VEC3", 3);
    add_floats(s, up, 9, "VEC3", 3);
    add_floats(s, none, 9, "VEC3", 3);
    s->meshes = MORPHED;
    return s;
}

#define SKINNED \
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":3,\"WEIGHTS_0\":4},\"targets\":[{\"POSITION\":1},{\"POSITION\":2}]}]}"

/* The same, following the first joint of a skin. */
static scene *skinned_morphing(const char *nodes)
{
    const float weights[12] = { 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0 };
    scene *s = morphing(nodes);
    APPEND(s->views, ",{\"buffer\":0,\"byteOffset\":72,\"byteLength\":12}"); /* zeros of the second target */
    APPEND(s->accessors, ",{\"bufferView\":%d,\"componentType\":5121,\"count\":3,\"type\":\"VEC4\"}",
           s->accessor_count++);
    add_floats(s, weights, 12, "VEC4", 4);
    s->meshes = SKINNED;
    return s;
}

static const float weight_times[3] = { 0, 0.5f, 1 };
static const float weight_values[6] = { 0, 1, 0.5f, 0, 1, 0.25f };

static const raw_floats *only_floats(const loaded *l)
{
    const raw_clip *clip = only_clip(l);
    assert_int_equal(clip->float_count, 1);
    return &clip->floats[0];
}

static void weights_alone_make_clips_without_joints(void **state)
{
    (void)state;
    scene *s = morphing("{\"name\":\"face\",\"mesh\":0,\"scale\":[1,3,1]}");
    add_channel(s, 0, "weights", "LINEAR", weight_times, 3, weight_values, 6, 1);
    loaded l = load(s, 4.0);
    const raw_floats *f = only_floats(&l);
    assert_int_equal(only_clip(&l)->joint_count, 0);
    assert_int_equal(l.made->sets[0]->skeleton.joint_count, 0);
    assert_string_equal(f->name, "face");
    assert_int_equal(f->node, 0);
    assert_int_equal(f->width, 2);
    const float expected[10] = { 0, 1, 0.25f, 0.5f, 0.5f, 0, 0.75f, 0.125f, 1, 0.25f };
    assert_memory_equal(f->values, expected, sizeof expected);
    assert_true(fabsf(f->radius[0] - 15.0f) < 1e-5f && f->radius[1] == 0.0f); /* 5 cm, three times as large */
    loaded_free(&l);
}

static void weights_below_a_growing_joint(void **state)
{
    (void)state;
    const float sizes[6] = { 1, 1, 1, 4, 4, 4 };
    scene *s = morphing(
        "{\"name\":\"root\",\"children\":[1]},{\"name\":\"still\",\"scale\":[2,2,2],\"rotation\":[0,0,0.6,0.8],\"children\":[2]},{\"name\":\"face\",\"mesh\":0}");
    add_channel(s, 2, "weights", "LINEAR", weight_times, 3, weight_values, 6, 1);
    add_channel(s, 0, "scale", "LINEAR", two_times, 2, sizes, 6, 3);
    loaded l = load(s, 4.0);
    assert_int_equal(l.made->sets[0]->skeleton.joint_count, 1);
    assert_true(fabsf(only_floats(&l)->radius[0] - 40.0f) < 1e-4f); /* 5 cm x 2 x 4 */
    loaded_free(&l);
}

static void weights_of_a_skinned_mesh(void **state)
{
    (void)state;
    const float binds[16] = { 0.5f, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 1 };
    scene *s = skinned_morphing(
        "{\"name\":\"face\",\"mesh\":0,\"skin\":0,\"scale\":[100,100,100]},{\"name\":\"joint\",\"scale\":[6,6,6]}");
    s->skins = "{\"joints\":[1],\"inverseBindMatrices\":5}";
    add_floats(s, binds, 16, "MAT4", 16);
    add_channel(s, 0, "weights", "LINEAR", weight_times, 3, weight_values, 6, 1);
    add_move(s, 0, "LINEAR", two_times, 2, two_moves, 6); /* the node of a skinned mesh places nothing */
    loaded l = load(s, 0.0);
    assert_int_equal(l.made->sets[0]->skeleton.joint_count, 1);
    assert_string_equal(l.made->sets[0]->skeleton.joints[0].name, "joint");
    assert_true(fabsf(only_floats(&l)->radius[0] - 15.0f) < 1e-4f); /* 5 cm x 6 x 1/2 */
    loaded_free(&l);
}

/* A node that a file leaves at rest stays there, though the weights of another node with the same mesh, or with targets
 * of the same made names, move: nodes 1 (its own weights) and 2 (its mesh's). Node 3 has names of the file. */
static void weights_of_other_nodes_stay(void **state)
{
    (void)state;
    scene *s = morphing("{\"mesh\":0},{\"mesh\":0,\"weights\":[0.75,0.5]},{\"mesh\":1},{\"mesh\":2}");
    s->meshes = MORPHED
        ",{\"weights\":[0,0.25],\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":1},"
        "{\"POSITION\":2}]}]},{\"extras\":{\"targetNames\":[\"a\",\"b\"]},\"primitives\":[{\"attributes\":"
        "{\"POSITION\":0},\"targets\":[{\"POSITION\":1},{\"POSITION\":2}]}]}";
    add_channel(s, 0, "weights", "LINEAR", weight_times, 3, weight_values, 6, 1);
    loaded l = load(s, 4.0);
    const raw_clip *clip = only_clip(&l);
    const float rests[2][2] = { { 0.75f, 0.5f }, { 0, 0.25f } };
    assert_int_equal(clip->float_count, 3);
    assert_int_equal(clip->frame_count, 5);
    assert_true(clip->floats[0].node == 0 && clip->floats[0].values[8] == 1.0f);
    for (uint32_t n = 1; n < 3; ++n) {
        assert_int_equal(clip->floats[n].node, n);
        for (uint32_t k = 0; k < 5; ++k) assert_memory_equal(clip->floats[n].values + 2 * k, rests[n - 1], 8);
    }
    loaded_free(&l);
}

/* More nodes at rest than a clip can hold: the file is read, and the warning says what happens to them. */
static void too_many_weights_that_stay_are_told(void **state)
{
    static char nodes[16384] = "{\"mesh\":0}";
    (void)state;
    for (uint32_t n = 0; n < 513; ++n) APPEND(nodes, ",{\"mesh\":0}");
    scene *s = morphing(nodes);
    add_channel(s, 0, "weights", "LINEAR", weight_times, 3, weight_values, 6, 1);
    loaded l = load(s, 4.0);
    assert_int_equal(only_clip(&l)->float_count, 1);
    assert_true(has_warning(l.m, "too many others have the same targets for a clip to hold"));
    loaded_free(&l);
}

static void what_moves_nothing_is_a_warning(void **state)
{
    (void)state;
    scene *s = skinned_morphing("{\"name\":\"face\",\"mesh\":0,\"skin\":0},{\"name\":\"joint\"}");
    s->skins = "{\"joints\":[1]}";
    add_move(s, 0, "LINEAR", two_times, 2, two_moves, 6);
    loaded l = load(s, 0.0);
    assert_int_equal(l.made->sets[0]->clip_count, 0);
    assert_true(has_warning(l.m, "animates nothing that the pack holds"));
    loaded_free(&l);
}

/* --- keys --- */

static void keys_in_extras(void **state)
{
    (void)state;
    scene *s = scene_new(TREE);
    s->animation_rest =
        ",\"extras\":{\"fps\":30,\"loop\":true,\"events\":[{\"time\":0.75,\"name\":\"late\",\"payload\":-2,\"weightMin\":0.5},"
        "{\"time\":0,\"name\":\"early\",\"payload\":\"0x1122334455667788\"},{\"time\":1.00001,\"name\":\"end\",\"payload\":2.5},"
        "{\"time\":0.5},{\"name\":\"when\"},{\"time\":3,\"name\":\"x\"},{\"time\":0,\"name\":\"y\",\"payload\":\"z\"},7,"
        "{\"time\":0,\"name\":\"w\",\"weightMin\":-1}]}";
    add_move(s, 2, "LINEAR", two_times, 2, two_moves, 6);
    loaded l = load(s, 0.0);
    const raw_clip *clip = only_clip(&l);
    assert_int_equal(clip->loop, 1);
    assert_int_equal(clip->event_count, 3);
    assert_string_equal(clip->events[0].name, "early");
    assert_string_equal(clip->events[1].name, "late");
    assert_string_equal(clip->events[2].name, "end");
    const uint8_t early[8] = { 0x88, 0x77, 0x66, 0x55, 0x44, 0x33, 0x22, 0x11 },
                  late[8] = { 0xfe, 255, 255, 255, 255, 255, 255, 255 };
    assert_memory_equal(clip->events[0].payload, early, 8);
    assert_memory_equal(clip->events[1].payload, late, 8);
    assert_true(clip->events[1].weight_min == 0.5f && clip->events[1].time_s == 0.75 && clip->events[2].time_s == 1.0);
    double real;
    memcpy(&real, clip->events[2].payload, 8);
    assert_true(real == 2.5);
    static const char *const reasons[6] = {
        "event 3 was skipped: it has no name", "event 4 was skipped: it has no time",
        "event 5 was skipped: its time",       "event 6 was skipped: its payload",
        "it has no name (and 1 more like it)", "event 8 was skipped: its weightMin"
    };
    for (int i = 0; i < 6; ++i) assert_true(has_warning(l.m, reasons[i]));
    loaded_free(&l);
}

static void markers_in_extras(void **state)
{
    (void)state;
    scene *s = scene_new(TREE);
    s->animation_rest =
        ",\"extras\":{\"events\":[{\"time\":0.75,\"name\":\"left\",\"marker\":true},{\"time\":0.25,\"name\":\"step\",\"marker\":false},"
        "{\"time\":0,\"name\":\"x\",\"marker\":1},{\"time\":0,\"name\":\"y\",\"marker\":true,\"payload\":1}]}";
    add_move(s, 2, "LINEAR", two_times, 2, two_moves, 6);
    loaded l = load(s, 0.0);
    const raw_clip *clip = only_clip(&l);
    assert_int_equal(clip->event_count, 2);
    assert_int_equal(clip->events[0].is_marker, 0);
    assert_string_equal(clip->events[1].name, "left");
    assert_int_equal(clip->events[1].is_marker, 1);
    assert_int_equal(clip->loop, 0);
    assert_true(has_warning(l.m, "event 2 was skipped: its marker"));
    assert_true(has_warning(l.m, "event 3 was skipped: a sync marker has no payload"));
    loaded_free(&l);
}

static void keys_of_several_sets_come_once(void **state)
{
    (void)state;
    scene *s = scene_new(TREE);
    s->skins = "{\"joints\":[2]}";
    s->animation_rest = ",\"extras\":{\"events\":[{\"time\":0,\"name\":\"once\"}]}";
    add_move(s, 2, "LINEAR", two_times, 2, two_moves, 6);
    add_move(s, 6, "LINEAR", two_times, 2, two_moves, 6);
    loaded l = load(s, 0.0);
    assert_int_equal(l.made->set_count, 2);
    assert_int_equal(l.made->sets[0]->clips[0].event_count, 1);
    assert_int_equal(l.made->sets[1]->clips[0].event_count, 0);
    loaded_free(&l);
}

/* --- real files --- */

static void asset_against_oracle(const char *name, uint32_t joints)
{
    snprintf(file_path, sizeof file_path, "%s", test_asset(name));
    static const double rates[3] = { 0.0, 60.0, 37.0 };
    for (size_t r = 0; r < TEST_COUNT(rates); ++r) {
        loaded l = load_file(rates[r]);
        double pose = 0.0, weights = 0.0;
        uint32_t frames = 0;
        assert_int_equal(l.made->set_count, 1);
        const raw_set *set = l.made->sets[0];
        assert_int_equal(set->skeleton.joint_count, joints);
        assert_int_equal(set->clip_count, l.m->clip_count);
        for (uint32_t c = 0; c < set->clip_count; ++c) {
            if (set->clips[c].joint_count > 0) pose = fmax(pose, frames_against_oracle(l.m, set, &set->clips[c]));
            weights = fmax(weights, weights_against_oracle(l.m, &set->clips[c]));
            frames += set->clips[c].frame_count;
        }
        print_message(
            "%s at %g Hz: %u clips, %u frames; poses within %.2g of the skeleton's size, weights within %.2g\n", name,
            rates[r], set->clip_count, frames, pose, weights);
        assert_true(pose < 1e-5 && weights < 1e-4);
        loaded_free(&l);
    }
}

static void real_fox(void **state)
{
    (void)state;
    asset_against_oracle("khronos/Fox.glb", 24);
}

static void real_robot(void **state)
{
    (void)state;
    asset_against_oracle("khronos/RobotExpressive.glb", 44);
}

static void real_simple_skin(void **state)
{
    (void)state;
    asset_against_oracle("khronos/SimpleSkin.gltf", 2);
}

static void real_body(void **state)
{
    (void)state;
    asset_against_oracle("hero/body.glb", 31);
}

/* --- vertices --- */

static void blend_frames(const raw_clip *clip, uint32_t frame, double part, raw_clip *out)
{
    const size_t at = (size_t)frame * clip->joint_count;
    const uint32_t next = frame + 1 < clip->frame_count ? clip->joint_count : 0;
    for (uint32_t j = 0; j < clip->joint_count; ++j) {
        double q[4], dot = 0.0;
        const float *a = clip->rotations + (at + j) * 4, *b = a + (size_t)next * 4;
        for (int k = 0; k < 4; ++k) dot += (double)a[k] * (double)b[k];
        for (int k = 0; k < 4; ++k) q[k] = (double)a[k] * (1.0 - part) + (dot < 0.0 ? -1.0 : 1.0) * (double)b[k] * part;
        unit(q);
        for (int k = 0; k < 4; ++k) out->rotations[j * 4 + (size_t)k] = (float)q[k];
        for (size_t k = 0; k < 3; ++k) {
            const size_t i = (at + j) * 3 + k, to = (at + j + next) * 3 + k;
            out->translations[j * 3 + k] = (float)((double)clip->translations[i] * (1.0 - part) +
                                                   (double)clip->translations[to] * part);
            out->scales[j * 3 + k] = (float)((double)clip->scales[i] * (1.0 - part) + (double)clip->scales[to] * part);
        }
    }
}

static void add_held(const double *matrix, const float *bind, const float *p, double weight, double *out)
{
    double at[3];
    for (int r = 0; r < 3; ++r)
        at[r] = (double)bind[r] * (double)p[0] + (double)bind[4 + r] * (double)p[1] +
                (double)bind[8 + r] * (double)p[2] + (double)bind[12 + r];
    for (int r = 0; r < 3; ++r)
        out[r] += weight * (matrix[r] * at[0] + matrix[3 + r] * at[1] + matrix[6 + r] * at[2] + matrix[9 + r]);
}

/* The largest distance in centimetres of a skinned vertex between the file's curves, as the specification writes them,
 * and the clip's frames as they are played, at a time of the clip. */
static double vertices_stray(const loaded *l, const raw_set *set, const raw_clip *clip, uint32_t frame, double part,
                             double *world, double *pose, raw_clip *one)
{
    double worst = 0.0;
    oracle_pose(l->m, source_of(l->m, clip), ((double)frame + part) / clip->sample_rate_hz, world);
    blend_frames(clip, frame, part, one);
    raw_pose_object(&set->skeleton, one, 0, pose);
    for (uint32_t n = 0; n < l->m->node_count; ++n) {
        const model_node *node = &l->m->nodes[n];
        if (node->mesh == MODEL_NONE || node->skin == MODEL_NONE) continue;
        const model_mesh *mesh = &l->m->meshes[node->mesh];
        const model_skin *skin = &l->m->skins[node->skin];
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
            double expected[3] = { 0, 0, 0 }, got[3] = { 0, 0, 0 }, square = 0.0;
            for (uint32_t k = 0; k < MODEL_INFLUENCES_MAX; ++k) {
                const size_t at = (size_t)v * MODEL_INFLUENCES_MAX + k, j = mesh->joints[at];
                const double weight = (double)mesh->joint_weights[at];
                const float *bind = skin->inverse_bind + j * 16, *p = mesh->position + (size_t)v * 3;
                add_held(world + (size_t)skin->joints[j] * 12, bind, p, weight, expected);
                add_held(pose + (size_t)l->made->skins[node->skin].joints[j] * 12, bind, p, weight, got);
            }
            for (int k = 0; k < 3; ++k) square += (expected[k] - got[k]) * (expected[k] - got[k]);
            worst = fmax(worst, sqrt(square) * 100.0);
        }
    }
    return worst;
}

/* The largest distance at `parts` places of every frame, which has to be what the clip says. */
static double clip_strays(const loaded *l, const raw_clip *clip, uint32_t parts)
{
    const raw_set *set = l->made->sets[0];
    double *world = test_zeros((size_t)l->m->node_count * 12 * sizeof *world), worst = 0.0;
    double *pose = test_zeros((size_t)set->skeleton.joint_count * 12 * sizeof *pose);
    raw_clip one = { 0 };
    assert_int_equal(raw_clip_alloc(&one, 1, clip->joint_count), 0);
    for (uint32_t f = 0; f + 1 < clip->frame_count; ++f)
        for (uint32_t p = 0; p < parts; ++p)
            worst = fmax(worst, vertices_stray(l, set, clip, f, (double)p / parts, world, pose, &one));
    if (worst > clip->source_error_cm * 1.1 + 1e-4 || worst < clip->source_error_cm * 0.8 - 1e-4)
        fail_msg("clip '%s' strays by %g cm, but says %g", clip->name, worst, clip->source_error_cm);
    raw_clip_clear(&one);
    free(world);
    free(pose);
    return worst;
}

/* A body of 160 cm and a head, a leaf joint, whose top is `head` metres above it. */
static scene *nodding(float head, double size)
{
    const float s = (float)size, base[9] = { 0, 0, 0, 0.2f * s, 1.6f * s, 0, 0, 1.6f * s + head, 0 };
    const float joints[12] = { 0 }, ones[12] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
    float binds[32] = { 0 };
    const unsigned char of[12] = { 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0 };
    static char nodes[256];
    snprintf(
        nodes, sizeof nodes,
        "{\"mesh\":0,\"skin\":0},{\"name\":\"body\",\"children\":[2]},{\"name\":\"head\",\"translation\":[0,%g,0]}",
        1.6 * size);
    for (int i = 0; i < 8; ++i) binds[(i / 4) * 16 + i % 4 * 5] = 1.0f;
    binds[16 + 13] = -1.6f * s;
    scene *made = scene_new(nodes);
    add_floats(made, base, 9, "VEC3", 3);
    add_floats(made, joints, 12, "VEC4", 4);
    add_floats(made, ones, 12, "VEC4", 4);
    memcpy(made->numbers + 9, of, sizeof of);
    memcpy(strstr(strstr(made->accessors, "},{"), "5126"), "5121", 4);
    add_floats(made, binds, 32, "MAT4", 16);
    made->meshes = "{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":2}}]}";
    made->skins = "{\"joints\":[1,2],\"inverseBindMatrices\":3}";
    return made;
}

/* Keys of a nod `degrees` to and fro; CUBICSPLINE with tangents of 0. */
static void add_nod(scene *s, const char *interpolation, uint32_t keys, double step_s, double degrees)
{
    float times[64], values[64 * 12] = { 0 };
    const uint32_t per_key = strcmp(interpolation, "CUBICSPLINE") == 0 ? 3 : 1;
    for (uint32_t k = 0; k < keys; ++k) {
        float *q = values + (k * per_key + per_key / 2) * 4;
        const double half = (k % 2 ? degrees : 0.0) * 0.00872664626;
        times[k] = (float)(k * step_s);
        q[0] = (float)sin(half);
        q[3] = (float)cos(half);
    }
    add_turn(s, 2, interpolation, times, keys, values, (size_t)keys * per_key * 4);
}

/* Curves of every kind: the rate is one at which vertices are within a thousandth of the size. */
static void vertices_play_within_the_tolerance(void **state)
{
    (void)state;
    static const struct {
        const char *interpolation;
        uint32_t keys;
        double step_s, degrees;
    } cases[] = { { "CUBICSPLINE", 5, 0.5, 40.0 },         { "LINEAR", 5, 0.5, 60.0 },
                  { "LINEAR", 60, 1.0 / 24.0, 124.0 },     { "LINEAR", 60, 1.0 / 30.0, 20.0 },
                  { "CUBICSPLINE", 20, 1.0 / 30.0, 10.0 }, { "LINEAR", 7, 0.0613, 70.0 } };
    for (size_t i = 0; i < TEST_COUNT(cases); ++i)
        for (int k = 0; k < 2; ++k) { /* of usual size, and off by a unit */
            const double size = k ? 0.01 : 1.0;
            scene *s = nodding((float)(0.3 * size), size);
            add_nod(s, cases[i].interpolation, cases[i].keys, cases[i].step_s, cases[i].degrees);
            loaded l = load(s, 0.0);
            const raw_clip *clip = only_clip(&l);
            const double strays = clip_strays(&l, clip, 16), tolerance = 190.0 * size * 1e-3;
            if (strays > tolerance * 1.1) fail_msg("case %zu: %g cm at %g Hz", i, strays, clip->sample_rate_hz);
            if (i == 0) assert_true(clip->sample_rate_hz > 8.0);
            if (i == 2) assert_true(clip->sample_rate_hz > 24.0 && has_warning(l.m, "--rate 24 keeps only the keys"));
            if (i == 3) assert_true(clip->sample_rate_hz == 30.0);
            loaded_free(&l);
        }
    scene *s = nodding(0.3f, 1.0); /* a rate that is asked for: what it costs is said */
    add_nod(s, "CUBICSPLINE", 5, 0.5, 40.0);
    loaded l = load(s, 8.0);
    assert_true(clip_strays(&l, only_clip(&l), 16) > 0.5);
    loaded_free(&l);
}

/* What is played differs from the curves by what the clip states. */
static void real_body_plays_as_promised(void **state)
{
    (void)state;
    snprintf(file_path, sizeof file_path, "%s", test_asset("hero/body.glb"));
    loaded l = load_file(0.0);
    const raw_set *set = l.made->sets[0];
    uint32_t left = test_is_sanitized() ? 1 : set->clip_count;
    for (uint32_t c = 0; c < set->clip_count && left; ++c)
        if (set->clips[c].joint_count > 0 && set->clips[c].frame_count < 40) {
            const double strays = clip_strays(&l, &set->clips[c], 5);
            print_message("hero/body.glb: '%s' strays by %.3g cm\n", set->clips[c].name, strays);
            left--;
        }
    loaded_free(&l);
}

/* The same animations as .rcl, which another program made (of those that are the same in both files). */
static void compare_with_rcl(const char *gltf, const char *clip_name, const char *rcl)
{
    raw_set *other = NULL;
    model_error error = { "", "" };
    snprintf(file_path, sizeof file_path, "%s", test_asset(gltf));
    assert_int_equal(rcl_read(test_asset(rcl), &other, &error), 0);
    loaded l = load_file(other->clips[0].sample_rate_hz);
    const raw_set *set = l.made->sets[0];
    const raw_clip *a = NULL, *b = &other->clips[0];
    for (uint32_t c = 0; c < set->clip_count; ++c)
        if (strcmp(set->clips[c].name, clip_name) == 0) a = &set->clips[c];
    assert_non_null(a);
    assert_int_equal(a->frame_count, b->frame_count);
    assert_int_equal(a->joint_count + 1,
                     b->joint_count); /* it kept a root that is an identity; the order is the same */
    double worst_turn = 0.0;
    for (uint32_t j = 0; j < a->joint_count; ++j) {
        const uint32_t k = j + 1, parent = set->skeleton.joints[j].parent;
        assert_int_equal(other->skeleton.joints[k].parent, parent == MODEL_NONE ? 0 : parent + 1);
        for (size_t f = 0; f < a->frame_count; ++f) {
            const float *p = a->rotations + (f * a->joint_count + j) * 4,
                        *q = b->rotations + (f * b->joint_count + k) * 4;
            double dot = 0.0, apart = 0.0;
            for (int i = 0; i < 4; ++i) dot += (double)p[i] * (double)q[i];
            for (int i = 0; i < 4; ++i) apart = fmax(apart, fabs((double)p[i] - copysign(1.0, dot) * (double)q[i]));
            worst_turn = fmax(worst_turn, apart);
        }
    }
    print_message("%s: %u joints, %u frames, quaternions within %.2g\n", rcl, a->joint_count, a->frame_count,
                  worst_turn);
    assert_true(worst_turn < 2e-5);
    raw_set_free(other);
    loaded_free(&l);
}

static void real_clips_as_another_program_saw_them(void **state)
{
    (void)state;
    compare_with_rcl("khronos/Fox.glb", "Survey", "clips/Fox__Survey.rcl");
    compare_with_rcl("khronos/Fox.glb", "Walk", "clips/Fox__Walk.rcl");
    compare_with_rcl("khronos/RobotExpressive.glb", "Dance", "clips/RobotExpressive__Dance.rcl");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(only_what_moves_or_transforms_is_a_joint),
    cmocka_unit_test(animated_nodes_around_joints_are_joints),
    cmocka_unit_test(animations_without_skins),
    cmocka_unit_test(skins_share_skeletons),
    cmocka_unit_test(inverse_bind_matrices),
    cmocka_unit_test(joints_outside_the_scene_are_a_warning),
    cmocka_unit_test(forgotten_joints_are_read),
    cmocka_unit_test(joint_limit),
    cmocka_unit_test(linear_turns_are_spherical),
    cmocka_unit_test(splines_are_normalised),
    cmocka_unit_test(steps_hold),
    cmocka_unit_test(rotations_without_length_hold),
    cmocka_unit_test(keys_before_zero_are_shifted),
    cmocka_unit_test(missing_targets_are_a_warning),
    cmocka_unit_test(key_rates_are_found),
    cmocka_unit_test(a_moment_is_one_frame),
    cmocka_unit_test(keys_are_taken_as_they_are),
    cmocka_unit_test(a_first_frame_late_is_cut_off),
    cmocka_unit_test(rates_rise_where_playing_strays),
    cmocka_unit_test(held_steps_and_fast_turns_keep_the_rate),
    cmocka_unit_test(keys_off_any_grid),
    cmocka_unit_test(asked_rates_keep_the_length),
    cmocka_unit_test(impossible_rates_are_refused),
    cmocka_unit_test(weights_alone_make_clips_without_joints),
    cmocka_unit_test(weights_below_a_growing_joint),
    cmocka_unit_test(weights_of_a_skinned_mesh),
    cmocka_unit_test(weights_of_other_nodes_stay),
    cmocka_unit_test(too_many_weights_that_stay_are_told),
    cmocka_unit_test(what_moves_nothing_is_a_warning),
    cmocka_unit_test(keys_in_extras),
    cmocka_unit_test(markers_in_extras),
    cmocka_unit_test(keys_of_several_sets_come_once),
    cmocka_unit_test(real_fox),
    cmocka_unit_test(real_robot),
    cmocka_unit_test(real_simple_skin),
    cmocka_unit_test(real_body),
    cmocka_unit_test(vertices_play_within_the_tolerance),
    cmocka_unit_test(real_body_plays_as_promised),
    cmocka_unit_test(real_clips_as_another_program_saw_them),
};

TEST_MAIN(tests, NULL, NULL)
