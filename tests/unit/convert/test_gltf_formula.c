/* Real morph assets against the formula of glTF 2.0 (3.7.2.2), evaluated in double precision
 * by a reader that shares nothing with the converter's (gltf_oracle.c): base + sum of
 * weight * delta, for static weights and for every weight animation over time, first on the
 * model as read, then on the pack, within the error that it certifies. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "convert/clips/model_clips.h"
#include "support/gltf_oracle.h"
#include "motion/bank/clip_bank_internal.h"

#define TIMES 24

typedef struct asset {
    oracle *o;
    model *m;
    uint8_t *bytes;
    uint32_t **orders; /* per mesh of the pack */
    noh_pack pack;
    model_clips *made;    /* the clips' frames before they were encoded */
    noh_clip_bank **sets; /* [set_count] one for each skeleton of the pack, at least one; NULL where nothing fits */
    uint32_t set_count;
    uint64_t compared; /* vertices */
    char stem[64];     /* of the file: the name of its first animation without one */
} asset;

static void open_sets(asset *a)
{
    a->set_count = a->pack.runs[NOH_CHUNK_SKELETON].count ? a->pack.runs[NOH_CHUNK_SKELETON].count : 1;
    a->sets = test_zeros(sizeof *a->sets * a->set_count);
    for (uint32_t i = 0; i < a->set_count && a->pack.runs[NOH_CHUNK_CLIP].count; i++) {
        noh_clip_bank_desc desc;
        memset(&desc, 0, sizeof desc);
        desc.clips = &a->pack;
        desc.skeleton = i;
        a->sets[i] = noh_clip_bank_size(&desc, NULL) ? test_clip_bank(&desc) : NULL;
    }
}

static void open_asset(asset *a, const char *name, const char *path)
{
    model_error error;
    size_t count;
    const char *file = strrchr(path, '/');
    memset(a, 0, sizeof *a);
    (void)snprintf(a->stem, sizeof a->stem, "%s", file ? file + 1 : path);
    if (strrchr(a->stem, '.')) *strrchr(a->stem, '.') = 0;
    a->o = oracle_read(path);
    if (model_read_gltf(path, &a->m, &error)) {
        fail_msg("%s: %s (%s)", name, error.what, error.where);
    }
    a->orders = test_zeros(sizeof *a->orders * a->m->mesh_count);
    a->bytes = test_pack_of(a->m, &count, a->orders);
    a->pack = test_open(a->bytes, count);
    assert_int_equal(clips_from_model(a->m, NULL, &a->made, &error), 0);
    open_sets(a);
}

static void close_asset(asset *a)
{
    for (uint32_t i = 0; i < a->m->mesh_count; i++) {
        free(a->orders[i]);
    }
    for (uint32_t i = 0; i < a->set_count; i++) {
        free(a->sets[i]);
    }
    free(a->sets);
    model_clips_free(a->made);
    free(a->orders);
    free(a->bytes);
    model_free(a->m);
    oracle_free(a->o);
}

/* The model's node for a node of the file, by name; MODEL_NONE where the scene leaves it out. */
static uint32_t model_node_of(const asset *a, uint32_t node)
{
    const char *name = oracle_node_name(a->o, node);
    char made[32];
    if (!name) {
        snprintf(made, sizeof made, "node_%u", (unsigned)node);
        name = made;
    }
    for (uint32_t i = 0; i < a->m->node_count; i++) {
        if (strcasecmp(a->m->nodes[i].name, name) == 0) { /* of VRM's bones: "Hips" is "hips" */
            return i;
        }
    }
    return MODEL_NONE;
}

/* All primitives one after another, as the model has them. */
static double *expected_positions(const asset *a, uint32_t mesh, const double *weights, uint32_t *count)
{
    double *out;
    uint32_t total = 0;
    for (uint32_t p = 0; p < oracle_primitive_count(a->o, mesh); p++) {
        total += oracle_vertex_count(a->o, mesh, p);
    }
    out = test_zeros(sizeof *out * 3u * total);
    *count = total;
    total = 0;
    for (uint32_t p = 0; p < oracle_primitive_count(a->o, mesh); p++) {
        oracle_positions(a->o, mesh, p, weights, out + 3u * total);
        total += oracle_vertex_count(a->o, mesh, p);
    }
    return out;
}

static double diagonal(const double *positions, uint32_t count)
{
    double square = 0.0;
    for (int c = 0; c < 3; c++) {
        double low = positions[c], high = positions[c];
        for (uint32_t v = 0; v < count; v++) {
            low = fmin(low, positions[3 * v + (uint32_t)c]);
            high = fmax(high, positions[3 * v + (uint32_t)c]);
        }
        square += (high - low) * (high - low);
    }
    return sqrt(square);
}

static double distance(const double *a, const double *b)
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

/* The model before quantisation: within 1e-5 of the bounding box. */
static void check_model(asset *a, const model_mesh *mesh, const double *weights, const double *expected, double size)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        double p[3];
        for (uint32_t c = 0; c < 3; c++) {
            p[c] = (double)mesh->position[3 * v + c];
            for (uint32_t t = 0; t < mesh->target_count; t++) {
                p[c] += weights[t] * (double)mesh->targets[t].position[3 * v + c];
            }
        }
        if (!(distance(p, expected + 3 * v) <= 1e-5 * size)) {
            fail_msg("model: vertex %u is off by %g of the box", v, distance(p, expected + 3 * v) / size);
        }
    }
    a->compared += mesh->vertex_count;
}

/* The pack: within the certified errors, and what adding floats of this size may round. */
static void check_pack(const asset *a, uint32_t index, const float *weights, const double *expected, double slack)
{
    noh_mesh mesh = test_mesh(&a->pack, index);
    noh_morph_layers layers = test_layers(&mesh);
    double bound = slack;
    noh_morph_accumulate(&mesh, weights, &layers);
    for (uint32_t t = 0; t < mesh.header->target_count; t++) {
        bound += fabs((double)weights[t]) * (double)mesh.targets[t].position_error;
    }
    for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
        noh_vertex vertex;
        double p[3];
        noh_morph_vertex(&mesh, &layers, v, &vertex);
        for (uint32_t c = 0; c < 3; c++) {
            p[c] = (double)vertex.position[c];
        }
        if (!(distance(p, expected + 3u * (size_t)a->orders[index][v]) <= bound)) {
            fail_msg("pack: vertex %u is off by %g, bound %g", v,
                     distance(p, expected + 3u * (size_t)a->orders[index][v]), bound);
        }
    }
    free(layers.position);
}

/* What the float sums may round: the sizes of all summands, 2^-23 of them for each operation. */
static double float_slack(const noh_mesh *mesh, const double *expected, uint32_t count, const float *weights)
{
    double most = 0.0, sum = 0.0;
    for (uint32_t i = 0; i < 3u * count; i++) {
        most = fmax(most, fabs(expected[i]));
    }
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        sum += fabs((double)weights[t]) * (double)mesh->targets[t].radius;
    }
    return 0x1p-23 * (most + (double)(mesh->header->target_count + 2) * sum);
}

static void check_node(asset *a, uint32_t node, const double *weights, const float *pack_weights)
{
    uint32_t mesh = (uint32_t)oracle_node_mesh(a->o, node), made = model_node_of(a, node), count, index;
    double *expected = expected_positions(a, mesh, weights, &count);
    noh_mesh packed;
    assert_int_not_equal(made, MODEL_NONE);
    index = a->m->nodes[made].mesh;
    assert_int_equal(a->m->meshes[index].vertex_count, count);
    assert_int_equal(a->m->meshes[index].target_count, oracle_target_count(a->o, mesh));
    packed = test_mesh(&a->pack, index);
    check_model(a, &a->m->meshes[index], weights, expected, diagonal(expected, count));
    check_pack(a, index, pack_weights, expected, float_slack(&packed, expected, count, pack_weights));
    free(expected);
}

static void narrow(const double *from, float *to, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        to[i] = (float)from[i];
    }
}

/* ---- static weights ---- */

static const float *pack_defaults(const asset *a, uint32_t node)
{
    const noh_node *n = &a->pack.nodes[model_node_of(a, node)];
    return n->first_weight != NOH_NONE ? a->pack.node_weights + n->first_weight : test_mesh(&a->pack, n->mesh).weights;
}

static void check_static(asset *a)
{
    test_random r = test_random_from(41);
    for (uint32_t node = 0; node < oracle_node_count(a->o); node++) {
        int mesh = oracle_node_mesh(a->o, node);
        uint32_t count = mesh < 0 ? 0 : oracle_target_count(a->o, (uint32_t)mesh);
        double *weights = test_zeros(sizeof *weights * count);
        float *narrowed = test_zeros(sizeof *narrowed * count);
        if (mesh >= 0) {
            oracle_default_weights(a->o, node, weights);
            narrow(weights, narrowed, count);
            test_same_floats(pack_defaults(a, node), narrowed, count, "default weight");
            check_node(a, node, weights, narrowed);
            for (uint32_t round = 0; round < 4 && count; round++) {
                test_random_weights(&r, narrowed, count);
                for (uint32_t t = 0; t < count; t++) {
                    weights[t] = (double)narrowed[t];
                }
                check_node(a, node, weights, narrowed);
            }
        }
        free(weights);
        free(narrowed);
    }
}

/* ---- animations ---- */

/* The source's channel, sampled in double: keys are floats in both, so only the formula counts. */
static const model_channel *model_channel_of(const asset *a, const char *clip, uint32_t node)
{
    for (uint32_t i = 0; i < a->m->clip_count; i++) {
        for (uint32_t c = 0; c < a->m->clips[i].channel_count; c++) {
            const model_channel *channel = &a->m->clips[i].channels[c];
            if (strcmp(a->m->clips[i].name, clip) == 0 && channel->path == MODEL_PATH_WEIGHTS &&
                channel->node == node) {
                return channel;
            }
        }
    }
    fail_msg("the model has no weights for node %u in '%s'", node, clip);
    return NULL;
}

static double hermite(const float *a, const float *b, uint32_t width, double s, double span)
{
    double s2 = s * s, s3 = s2 * s;
    return (2 * s3 - 3 * s2 + 1) * (double)a[width] + span * (s3 - 2 * s2 + s) * (double)a[2 * width] +
           (3 * s2 - 2 * s3) * (double)b[width] + span * (s3 - s2) * (double)b[0];
}

static void sample_model(const model_channel *c, double time, double *weights)
{
    uint32_t k = 0, cubic = c->interpolation == MODEL_CUBICSPLINE, stride = c->width * (cubic ? 3u : 1u);
    double s = 0.0, span = 1.0;
    while (k + 1 < c->key_count && (double)c->times[k + 1] <= time) {
        k++;
    }
    if (k + 1 < c->key_count && time > (double)c->times[k] && c->interpolation != MODEL_STEP) {
        span = (double)c->times[k + 1] - (double)c->times[k];
        s = (time - (double)c->times[k]) / span;
    }
    for (uint32_t i = 0; i < c->width; i++) {
        const float *a = c->values + k * stride + i, *b = s > 0.0 ? a + stride : a;
        weights[i] = cubic ? hermite(a, b, c->width, s, span) : (1.0 - s) * (double)a[0] + s * (double)b[0];
    }
}

/* ---- through the pack: the frames that were made of the curves, encoded, bound and played ---- */

static int sample_set(noh_clip_bank *set, const char *clip, uint32_t node, double time, float *weights)
{
    const uint32_t clip_index = set ? noh_clip_bank_find(set, clip) : 0;
    for (uint32_t g = 0; set && clip_index < set->clips.clip_count && g < set->group_count; g++) {
        if (set->groups[g].node == node && noh_clip_bank_moves(set, clip_index, g)) {
            noh_transform *pose = test_zeros(sizeof *pose * set->clips.joint_count);
            float *floats = test_zeros(sizeof *floats * set->clips.float_count);
            const int64_t tick = noh_ticks_from_seconds(time), end = set->clips.clips[clip_index].duration_ticks;
            set->clips.sample(set->clips.user, clip_index,
                              (uint32_t)(tick < 0     ? 0
                                         : tick > end ? end
                                                      : tick),
                              set->clips.joint_count, pose, set->clips.float_count, floats);
            memcpy(weights, floats + set->groups[g].first, set->groups[g].width * sizeof *weights);
            free(pose);
            free(floats);
            return 1;
        }
    }
    return 0;
}

static void sample_pack(const asset *a, const char *clip, uint32_t node, double time, float *weights)
{
    for (uint32_t i = 0; i < a->set_count; i++) {
        if (sample_set(a->sets[i], clip, node, time, weights)) {
            return;
        }
    }
    fail_msg("the pack has no weights for node %u in '%s'", node, clip);
}

/* What the encoder was given. */
static const raw_floats *frames_of(const asset *a, const char *clip, uint32_t node, const raw_clip **of)
{
    for (uint32_t i = 0; i < a->made->set_count; i++) {
        for (uint32_t c = 0; c < a->made->sets[i]->clip_count; c++) {
            *of = &a->made->sets[i]->clips[c];
            for (uint32_t g = 0; strcmp((*of)->name, clip) == 0 && g < (*of)->float_count; g++) {
                if ((*of)->floats[g].node == node) {
                    return &(*of)->floats[g];
                }
            }
        }
    }
    fail_msg("no frames for node %u in '%s'", node, clip);
    return NULL;
}

static double play_frames(const raw_clip *clip, const raw_floats *frames, double time, uint32_t i)
{
    const double at = fmin(fmax(time * clip->sample_rate_hz, 0.0), (double)(clip->frame_count - 1)), first = floor(at);
    const size_t k = (size_t)first, next = k + 1 < clip->frame_count ? k + 1 : k;
    const double a = (double)frames->values[k * frames->width + i],
                 b = (double)frames->values[next * frames->width + i];
    return a + (b - a) * (at - first);
}

/* Whether a key that jumps lies within a frame of this time: there playing frames is a ramp. */
static int near_a_step(const model_channel *c, const raw_clip *clip, double time)
{
    for (uint32_t k = 0; c->interpolation == MODEL_STEP && k < c->key_count; k++) {
        if (fabs((double)c->times[k] - time) <= 1.01 / clip->sample_rate_hz) {
            return 1;
        }
    }
    return 0;
}

#define BOUND_CM 0.01
#define TICK_S (0.5 / 48000.0) /* times are whole ticks */

/* The pack within the bound of its frames, and the frames within what they say of the curves. */
static void check_weights(const asset *a, const char *clip, const model_channel *channel, double time,
                          const float *packed, const double *curve)
{
    const raw_clip *made = NULL;
    const raw_floats *frames = frames_of(a, clip, channel->node, &made);
    double strays = 0.0;
    for (uint32_t t = 0; t < frames->width; t++) {
        const double played = play_frames(made, frames, time, t), reach = (double)frames->radius[t];
        const double speed = fabs(play_frames(made, frames, time + TICK_S, t) -
                                  play_frames(made, frames, time - TICK_S, t));
        if (!(fabs((double)packed[t] - played) <= fmin(1.0, BOUND_CM / fmax(reach, 1e-6)) + speed + 1e-6)) {
            fail_msg("'%s' at %g s, weight %u: %.9g, not %.9g, reach %g cm", clip, time, t, (double)packed[t], played,
                     reach);
        }
        strays += fabs(played - curve[t]) * reach;
    }
    if (!near_a_step(channel, made, time)) {
        const double limit = channel->interpolation == MODEL_STEP ? 0.0 : made->source_error_cm;
        if (!(strays <= limit * 1.05 + 1e-3)) { /* the error is looked for at quarters of a frame */
            fail_msg("'%s' at %g s: frames stray %g cm from the curves, stated: %g cm", clip, time, strays, limit);
        }
    }
}

static void check_time(asset *a, uint32_t animation, uint32_t channel, const char *clip, double time)
{
    uint32_t node = (uint32_t)oracle_channel_node(a->o, animation, channel), made = model_node_of(a, node);
    uint32_t count = oracle_target_count(a->o, (uint32_t)oracle_node_mesh(a->o, node));
    double *expected = test_zeros(sizeof *expected * count), *got = test_zeros(sizeof *got * count);
    float *packed = test_zeros(sizeof *packed * count);
    const model_channel *from = model_channel_of(a, clip, made);
    /* What lies before the first key is left out; times are then rounded once more. */
    const double trimmed = oracle_channel_end(a->o, animation, channel) - (double)from->times[from->key_count - 1u];
    oracle_sample(a->o, animation, channel, time + trimmed, expected);
    sample_model(from, time, got);
    sample_pack(a, clip, made, time, packed);
    check_weights(a, clip, from, time, packed, expected);
    for (uint32_t t = 0; t < count; t++) {
        assert_true(fabs(got[t] - expected[t]) <= (trimmed == 0.0 ? 1e-12 : 1e-5));
        expected[t] = (double)packed[t]; /* from here on only the deltas count */
    }
    check_node(a, node, expected, packed);
    free(expected);
    free(got);
    free(packed);
}

static uint32_t check_animations(asset *a)
{
    uint32_t channels = 0, unnamed = 0;
    for (uint32_t i = 0; i < oracle_animation_count(a->o); i++) {
        const char *name = oracle_animation_name(a->o, i);
        char made[80];
        (void)snprintf(made, sizeof made, unnamed ? "%s_%u" : "%s", a->stem, unnamed);
        unnamed += !name;
        for (uint32_t c = 0; c < oracle_channel_count(a->o, i); c++) {
            if (oracle_channel_node(a->o, i, c) < 0) {
                continue;
            }
            const int times = test_rounds(TIMES);
            for (int step = -1; step <= times; step++) {
                check_time(a, i, c, name ? name : made, oracle_channel_end(a->o, i, c) * 1.03 * (double)step / times);
            }
            channels++;
        }
    }
    return channels;
}

/* ---- the assets ---- */

static void check_file(const char *name, const char *path, uint32_t weight_channels)
{
    asset a;
    open_asset(&a, name, path);
    check_static(&a);
    assert_int_equal(check_animations(&a), weight_channels);
    print_message("# %s: %llu vertices compared\n", name, (unsigned long long)a.compared);
    assert_true(a.compared > 0);
    close_asset(&a);
}

static void check_asset(const char *name, uint32_t weight_channels)
{
    check_file(name, test_asset(name), weight_channels);
}

/* The demo's own, which the build has made. */
static void the_mask(void **state)
{
    const char *build = getenv("NOH_BUILD");
    char path[4096];
    (void)state;
    snprintf(path, sizeof path, "%s/mask.glb", build ? build : "build");
    check_file("mask.glb", path, 6);
}

#define ASSETS(X)                                                                            \
    X(animated_morph_cube, "khronos/AnimatedMorphCube/glTF/AnimatedMorphCube.gltf", 1)       \
    X(animated_morph_sphere, "khronos/AnimatedMorphSphere/glTF/AnimatedMorphSphere.gltf", 1) \
    X(morph_primitives_test, "khronos/MorphPrimitivesTest/glTF/MorphPrimitivesTest.gltf", 0) \
    X(morph_stress_test, "khronos/MorphStressTest.glb", 3)                                   \
    X(simple_morph, "khronos/SimpleMorph/glTF/SimpleMorph.gltf", 1)                          \
    X(simple_sparse_accessor, "khronos/SimpleSparseAccessor.gltf", 0)                        \
    X(three_vrm_cube, "khronos/three-vrm-cube/cube.gltf", 0)                                 \
    X(robot_expressive, "khronos/RobotExpressive.glb", 42)                                   \
    X(head_with_sparse_targets, "hero/head_sparse.glb", 5)                                   \
    X(head, "hero/head.glb", 5)                                                              \
    X(body, "hero/body.glb", 3)

#define X(name, path, channels)      \
    static void name(void **state)   \
    {                                \
        (void)state;                 \
        check_asset(path, channels); \
    }
ASSETS(X)
#undef X

static const struct CMUnitTest tests[] = { cmocka_unit_test(the_mask),
#define X(name, path, channels) cmocka_unit_test(name),
                                           ASSETS(X)
#undef X
};

TEST_MAIN(tests, NULL, NULL)
