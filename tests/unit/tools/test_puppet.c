/* The puppet that demo_assets --puppet writes, read back through the converter: a closed body, sound weights, loops
 * that close, and feet that do not slide.
 *
 * The file is $NOH_BUILD/demo/puppet.glb, which `make check` makes. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/clips/model_clips.h"
#include "convert/clips/raw_set.h"

#define JOINTS 47u

static model *puppet;
static model_clips *moves;

static int set_up(void **state)
{
    char path[4096];
    const char *build = getenv("NOH_BUILD");
    model_error error;
    sample_options options = { 0 };
    (void)state;
    snprintf(path, sizeof path, "%s/demo/puppet.glb", build ? build : "build");
    if (model_read_gltf(path, &puppet, &error) || clips_from_model(puppet, &options, &moves, &error)) {
        print_message("%s: %s (%s)\n", path, error.what, error.where);
        return 1;
    }
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    model_clips_free(moves);
    model_free(puppet);
    return 0;
}

/* ---- finding things ---- */

static const model_mesh *mesh_named(const char *name)
{
    for (uint32_t i = 0; i < puppet->mesh_count; i++) {
        if (!strcmp(puppet->meshes[i].name, name)) {
            return &puppet->meshes[i];
        }
    }
    fail_msg("there is no mesh '%s'", name);
    return NULL;
}

static uint32_t joint_named(const char *name)
{
    const raw_skeleton *skeleton = &moves->sets[0]->skeleton;
    for (uint32_t i = 0; i < skeleton->joint_count; i++) {
        if (!strcmp(skeleton->joints[i].name, name)) {
            return i;
        }
    }
    fail_msg("there is no joint '%s'", name);
    return 0;
}

static const raw_clip *clip_named(const char *name)
{
    for (uint32_t i = 0; i < moves->sets[0]->clip_count; i++) {
        if (!strcmp(moves->sets[0]->clips[i].name, name)) {
            return &moves->sets[0]->clips[i];
        }
    }
    fail_msg("there is no clip '%s'", name);
    return NULL;
}

static const char *const clip_names[] = { "idle", "walk", "bow", "look_round", "dance" };

/* ---- skeleton and mesh ---- */

static void joints_are_those_of_a_body(void **state)
{
    static const char *const names[] = { "root", "hips", "spine", "chest", "neck", "head", "jaw" };
    static const char *const pairs[] = { "shoulder", "upper_arm", "forearm", "hand",       "thumb",  "thumb_tip",
                                         "index",    "index_tip", "little",  "little_tip", "sleeve", "thigh",
                                         "shin",     "foot",      "toes",    "skirt" };
    (void)state;
    assert_int_equal(puppet->warning_count, 0);
    assert_int_equal(puppet->skin_count, 1);
    assert_int_equal(moves->set_count, 1);
    assert_int_equal(puppet->skins[0].joint_count, JOINTS);
    for (size_t i = 0; i < TEST_COUNT(names); i++) {
        joint_named(names[i]);
    }
    for (size_t i = 0; i < TEST_COUNT(pairs); i++) {
        char left[32], right[32];
        snprintf(left, sizeof left, "%s.L", pairs[i]);
        snprintf(right, sizeof right, "%s.R", pairs[i]);
        const raw_joint *joints = moves->sets[0]->skeleton.joints;
        const raw_joint *a = &joints[joint_named(left)], *b = &joints[joint_named(right)];
        assert_float_equal(a->translation[0], -b->translation[0], 1e-6f);
        assert_float_equal(a->translation[1], b->translation[1], 1e-6f);
    }
}

typedef struct {
    float at[3];
    uint32_t vertex;
} placed;

static int placed_order(const void *left, const void *right)
{
    const placed *a = left, *b = right;
    int order = memcmp(a->at, b->at, sizeof a->at);
    return order ? order : (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

/* For each vertex the first one at the same place, in every bit; *distinct: how many places there are. */
static uint32_t *weld(const model_mesh *mesh, uint32_t *distinct)
{
    placed *sorted = test_zeros(mesh->vertex_count * sizeof *sorted);
    uint32_t *first = test_zeros(mesh->vertex_count * sizeof *first);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        memcpy(sorted[i].at, mesh->position + (size_t)i * 3, sizeof sorted[i].at);
        sorted[i].vertex = i;
    }
    qsort(sorted, mesh->vertex_count, sizeof *sorted, placed_order);
    *distinct = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        int same = i > 0 && !memcmp(sorted[i].at, sorted[i - 1].at, sizeof sorted[i].at);
        first[sorted[i].vertex] = same ? first[sorted[i - 1].vertex] : sorted[i].vertex;
        *distinct += !same;
    }
    free(sorted);
    return first;
}

static int number_order(const void *left, const void *right)
{
    uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return (a > b) - (a < b);
}

/* Directed edges, as from << 32 | to, in ascending order. */
static uint64_t *sorted_edges(const model_mesh *mesh, const uint32_t *first)
{
    uint64_t *edges = test_zeros(mesh->index_count * sizeof *edges);
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        uint32_t next = i % 3 == 2 ? i - 2 : i + 1;
        edges[i] = (uint64_t)first[mesh->indices[i]] << 32 | first[mesh->indices[next]];
    }
    qsort(edges, mesh->index_count, sizeof *edges, number_order);
    return edges;
}

static uint32_t root_of(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) {
        i = parent[i] = parent[parent[i]];
    }
    return i;
}

/* How many connected pieces there are. */
static uint32_t count_pieces(const model_mesh *mesh, const uint32_t *first)
{
    uint32_t *parent = test_zeros(mesh->vertex_count * sizeof *parent), pieces = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        parent[i] = first[i];
    }
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        uint32_t next = i % 3 == 2 ? i - 2 : i + 1;
        parent[root_of(parent, mesh->indices[i])] = root_of(parent, mesh->indices[next]);
    }
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        pieces += parent[i] == i;
    }
    free(parent);
    return pieces;
}

/* Each edge once in each direction, in one piece, without a hole through it. */
static void the_surface_is_closed(void **state)
{
    const model_mesh *body = mesh_named("body");
    uint32_t distinct, *first = weld(body, &distinct);
    uint64_t *edges = sorted_edges(body, first);
    (void)state;
    for (uint32_t i = 0; i < body->index_count; i++) {
        uint64_t back = edges[i] << 32 | edges[i] >> 32;
        assert_true(edges[i] >> 32 != (edges[i] & 0xffffffffu));
        assert_true(i == 0 || edges[i] != edges[i - 1]);
        assert_non_null(bsearch(&back, edges, body->index_count, sizeof *edges, number_order));
    }
    assert_int_equal(count_pieces(body, first), 1);
    assert_int_equal((int64_t)distinct - body->index_count / 2 + body->index_count / 3, 2);
    free(first);
    free(edges);
}

/* Counts that a game can afford, and a texture to paint on. */
static void vertices_have_texture_coordinates(void **state)
{
    const model_mesh *body = mesh_named("body");
    (void)state;
    assert_in_range(body->vertex_count, 8000, 24000);
    for (uint32_t i = 0; i < body->vertex_count * 2; i++) {
        assert_true(body->uv[i] >= 0.0f && body->uv[i] <= 1.0f);
    }
}

static void weights_sum_to_one(void **state)
{
    static const char *const names[] = { "body", "mask" };
    (void)state;
    for (size_t m = 0; m < TEST_COUNT(names); m++) {
        const model_mesh *mesh = mesh_named(names[m]);
        assert_true(mesh->influence_max >= 2 && mesh->influence_max <= 4);
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            const float *weights = mesh->joint_weights + (size_t)v * MODEL_INFLUENCES_MAX;
            float sum = 0.0f;
            for (uint32_t i = 0; i < mesh->influence_max; i++) {
                sum += weights[i];
            }
            assert_true(sum == 1.0f);
        }
    }
}

/* Weights of neighbours do not jump. */
static void weights_are_smooth(void **state)
{
    const model_mesh *body = mesh_named("body");
    float *all = test_zeros((size_t)body->vertex_count * JOINTS * sizeof *all), largest = 0.0f;
    (void)state;
    for (uint32_t i = 0; i < body->vertex_count * MODEL_INFLUENCES_MAX; i++) {
        all[(size_t)(i / MODEL_INFLUENCES_MAX) * JOINTS + body->joints[i]] += body->joint_weights[i];
    }
    for (uint32_t i = 0; i < body->index_count; i++) {
        uint32_t a = body->indices[i], b = body->indices[i % 3 == 2 ? i - 2 : i + 1];
        for (size_t j = 0; j < JOINTS; j++) {
            largest = fmaxf(largest, fabsf(all[(size_t)a * JOINTS + j] - all[(size_t)b * JOINTS + j]));
        }
    }
    print_message("# largest step of a weight along an edge: %.3f\n", (double)largest);
    assert_true(largest < 0.35f);
    free(all);
}

static uint32_t target_named(const model_mesh *mesh, const char *name)
{
    for (uint32_t i = 0; i < mesh->target_count; i++) {
        if (!strcmp(mesh->targets[i].name, name)) {
            return i;
        }
    }
    fail_msg("there is no target '%s'", name);
    return 0;
}

/* Skin and morph meet on one vertex: two joints hold it, and a smile moves it. */
static void the_smile_moves_vertices_of_several_joints(void **state)
{
    const model_mesh *mask = mesh_named("mask");
    const float *smile;
    uint32_t both = 0;
    (void)state;
    assert_int_equal(mask->target_count, 57);
    smile = mask->targets[target_named(mask, "smile")].position;
    for (uint32_t v = 0; v < mask->vertex_count; v++) {
        const float *d = smile + (size_t)v * 3;
        int moved = d[0] * d[0] + d[1] * d[1] + d[2] * d[2] > 1e-6f;
        both += moved && mask->joint_weights[(size_t)v * MODEL_INFLUENCES_MAX + 1] > 0.05f;
    }
    assert_true(both > 500);
}

/* ---- clips ---- */

static void loops_close(void **state)
{
    uint32_t root = joint_named("root");
    (void)state;
    assert_int_equal(moves->sets[0]->clip_count, TEST_COUNT(clip_names));
    for (size_t c = 0; c < TEST_COUNT(clip_names); c++) {
        const raw_clip *clip = clip_named(clip_names[c]);
        size_t joints = clip->joint_count, last = clip->frame_count - 1;
        assert_float_equal(clip->sample_rate_hz, 30.0, 1e-4);
        for (size_t i = 0; i < joints * 4; i++) {
            assert_true(clip->rotations[i] == clip->rotations[last * joints * 4 + i]);
        }
        for (size_t i = 0; i < joints * 3; i++) {
            int goes = i / 3 == root && !strcmp(clip->name, "walk");
            assert_true(goes || clip->translations[i] == clip->translations[last * joints * 3 + i]);
        }
        for (uint32_t f = 0; f < clip->float_count; f++) {
            const raw_floats *floats = &clip->floats[f];
            assert_memory_equal(floats->values, floats->values + last * floats->width, floats->width * sizeof(float));
        }
    }
}

static void mix_into(float *out, const float *a, const float *b, size_t count, int is_turn)
{
    float length = 0.0f, sign = 0.0f;
    for (size_t i = 0; i < count; i++) {
        sign += a[i] * b[i];
    }
    for (size_t i = 0; i < count; i++) {
        out[i] = 0.5f * (a[i] + (is_turn && sign < 0.0f ? -b[i] : b[i]));
        length += out[i] * out[i];
    }
    for (size_t i = 0; i < count && is_turn; i++) {
        out[i] /= sqrtf(length);
    }
}

/* Object space, [joint_count][12], half way between two frames, or (odd = 0) at the first. */
static void pose_at(const raw_clip *clip, uint32_t frame, int odd, double *out)
{
    raw_clip half = { 0 };
    size_t joints = clip->joint_count;
    if (!odd) {
        raw_pose_object(&moves->sets[0]->skeleton, clip, frame, out);
        return;
    }
    assert_int_equal(raw_clip_alloc(&half, 1, clip->joint_count), 0);
    half.joint_count = clip->joint_count;
    half.frame_count = 1;
    for (size_t j = 0; j < joints; j++) {
        size_t at = frame * joints + j, next = at + joints;
        mix_into(half.rotations + j * 4, clip->rotations + at * 4, clip->rotations + next * 4, 4, 1);
        mix_into(half.translations + j * 3, clip->translations + at * 3, clip->translations + next * 3, 3, 0);
        mix_into(half.scales + j * 3, clip->scales + at * 3, clip->scales + next * 3, 3, 0);
    }
    raw_pose_object(&moves->sets[0]->skeleton, &half, 0, out);
    raw_clip_clear(&half);
}

typedef struct {
    double slide, contact, travel; /* metres, part of the time, metres */
    uint32_t lifts;
} tread;

/* Down: ankle and ball of the foot as high as in the bind pose, to a millimetre. */
static tread follow_foot(const raw_clip *clip, const char *ankle_name, const char *ball_name)
{
    uint32_t ankle = joint_named(ankle_name), ball = joint_named(ball_name), down = 0;
    uint32_t count = 2 * (clip->frame_count - 1) + 1;
    double *pose = test_zeros((size_t)clip->joint_count * 12 * sizeof *pose), from[2] = { 0, 0 }, last[2] = { 0, 0 };
    double rest[2];
    int was_down = 0;
    tread result = { 0 };
    raw_pose_object(&moves->sets[0]->skeleton, NULL, 0, pose);
    rest[0] = pose[ankle * 12 + 10];
    rest[1] = pose[ball * 12 + 10];
    for (uint32_t i = 0; i < count; i++) {
        pose_at(clip, i / 2, (int)(i % 2), pose);
        const double *at = pose + ankle * 12 + 9;
        int is_down = fabs(at[1] - rest[0]) < 1e-3 && fabs(pose[ball * 12 + 10] - rest[1]) < 1e-3;
        result.travel += i ? hypot(at[0] - last[0], at[2] - last[1]) : 0.0;
        last[0] = at[0];
        last[1] = at[2];
        if (is_down && !was_down) {
            from[0] = at[0];
            from[1] = at[2];
        }
        if (is_down) {
            result.slide = fmax(result.slide, hypot(at[0] - from[0], at[2] - from[1]));
        }
        down += (uint32_t)is_down;
        result.lifts += was_down && !is_down;
        was_down = is_down;
    }
    result.contact = (double)down / count;
    free(pose);
    return result;
}

static void feet_do_not_slide(void **state)
{
    static const char *const feet[2][2] = { { "foot.L", "toes.L" }, { "foot.R", "toes.R" } };
    static const struct {
        const char *clip;
        double travel_min;
        uint32_t lifts_min;
    } clips[] = { { "idle", 0, 0 }, { "walk", 0.6, 1 }, { "bow", 0, 0 }, { "look_round", 0, 0 }, { "dance", 3, 17 } };
    (void)state;
    for (size_t c = 0; c < TEST_COUNT(clips); c++) {
        for (size_t side = 0; side < 2; side++) {
            tread t = follow_foot(clip_named(clips[c].clip), feet[side][0], feet[side][1]);
            print_message("# %s %s: slides %.2f mm, down %.0f %% of the time, %u lifts, goes %.2f m\n", clips[c].clip,
                          feet[side][0], 1e3 * t.slide, 100 * t.contact, t.lifts, t.travel);
            assert_true(t.slide < 0.005);
            assert_true(t.contact > 0.4 && t.travel >= clips[c].travel_min && t.lifts >= clips[c].lifts_min);
        }
    }
}

/* The callback keys lie where a foot comes down: it is up shortly before. */
static void keys_lie_at_footfalls(void **state)
{
    static const char *const names[] = { "walk", "dance" };
    double *pose = test_zeros(JOINTS * 12 * sizeof *pose), rest;
    uint32_t stamps = 0, falls = 0;
    (void)state;
    raw_pose_object(&moves->sets[0]->skeleton, NULL, 0, pose);
    rest = pose[joint_named("foot.L") * 12 + 10];
    for (size_t c = 0; c < TEST_COUNT(names); c++) {
        const raw_clip *clip = clip_named(names[c]);
        for (uint32_t e = 0; e < clip->event_count; e++) {
            const raw_event *event = &clip->events[e];
            int stamp = !strcmp(event->name, "stamp");
            int left = stamp ? event->payload[0] == 0 : !strcmp(event->name, "foot_left");
            uint32_t foot = joint_named(left ? "foot.L" : "foot.R"),
                     frame = (uint32_t)ceil(event->time_s * 30.0 - 1e-6);
            pose_at(clip, frame, 0, pose);
            assert_true(pose[foot * 12 + 10] < rest + 1e-3);
            pose_at(clip, frame - 5, 0, pose);
            assert_true(pose[foot * 12 + 10] > rest + 1e-3);
            stamps += (uint32_t)stamp;
            falls += (uint32_t)!stamp;
        }
    }
    assert_int_equal(stamps, 2);
    assert_int_equal(falls, 2 + 32);
    free(pose);
}

/* The lowest vertex of the body in a frame. Only heights are skinned: one row of each joint's matrix. */
static double lowest(const model_mesh *body, const raw_clip *clip, uint32_t frame, double *pose, double *palette)
{
    const model_skin *skin = &puppet->skins[0];
    double low = 1e9;
    pose_at(clip, frame, 0, pose);
    for (uint32_t j = 0; j < skin->joint_count; j++) {
        const double *world = pose + (size_t)moves->skins[0].joints[j] * 12;
        for (int c = 0; c < 4; c++) {
            const float *column = skin->inverse_bind + (size_t)j * 16 + (size_t)c * 4;
            palette[j * 4 + (uint32_t)c] = c == 3 ? world[10] : 0.0;
            for (int k = 0; k < 3; k++) {
                palette[j * 4 + (uint32_t)c] += world[k * 3 + 1] * (double)column[k];
            }
        }
    }
    for (uint32_t v = 0; v < body->vertex_count; v++) {
        const float *p = body->position + (size_t)v * 3;
        double y = 0.0;
        for (uint32_t i = 0; i < body->influence_max; i++) {
            size_t at = (size_t)v * MODEL_INFLUENCES_MAX + i;
            const double *row = palette + (size_t)body->joints[at] * 4;
            double moved = row[0] * (double)p[0] + row[1] * (double)p[1] + row[2] * (double)p[2] + row[3];
            y += (double)body->joint_weights[at] * moved;
        }
        low = fmin(low, y);
    }
    return low;
}

static void the_body_stays_above_the_floor(void **state)
{
    const model_mesh *body = mesh_named("body");
    double *pose = test_zeros(JOINTS * 12 * sizeof *pose), *palette = test_zeros(JOINTS * 4 * sizeof *palette);
    (void)state;
    for (size_t c = 0; c < TEST_COUNT(clip_names); c++) {
        const raw_clip *clip = clip_named(clip_names[c]);
        double low = 1e9;
        for (uint32_t frame = 0; frame < clip->frame_count; frame += 2) {
            low = fmin(low, lowest(body, clip, frame, pose, palette));
        }
        print_message("# %s: lowest at %.1f mm\n", clip->name, 1e3 * low);
        assert_true(low > -0.003);
    }
    free(pose);
    free(palette);
}

static float most_of(const char *clip_name, const char *target)
{
    const raw_clip *clip = clip_named(clip_name);
    uint32_t t = target_named(mesh_named("mask"), target);
    float most = 0.0f;
    assert_int_equal(clip->float_count, 1);
    for (uint32_t frame = 0; frame < clip->frame_count; frame++) {
        most = fmaxf(most, clip->floats[0].values[(size_t)frame * clip->floats[0].width + t]);
    }
    return most;
}

static void clips_move_the_face(void **state)
{
    (void)state;
    assert_true(most_of("dance", "smile") > 0.95f);
    assert_true(most_of("dance", "anger") > 0.7f);
    assert_true(most_of("look_round", "blink") > 0.95f);
    assert_true(most_of("look_round", "eyeLookOutLeft") > 0.5f);
    assert_true(most_of("idle", "blink") > 0.9f);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(joints_are_those_of_a_body),
    cmocka_unit_test(the_surface_is_closed),
    cmocka_unit_test(vertices_have_texture_coordinates),
    cmocka_unit_test(weights_sum_to_one),
    cmocka_unit_test(weights_are_smooth),
    cmocka_unit_test(the_smile_moves_vertices_of_several_joints),
    cmocka_unit_test(loops_close),
    cmocka_unit_test(feet_do_not_slide),
    cmocka_unit_test(keys_lie_at_footfalls),
    cmocka_unit_test(the_body_stays_above_the_floor),
    cmocka_unit_test(clips_move_the_face),
};

TEST_MAIN(tests, set_up, tear_down)
