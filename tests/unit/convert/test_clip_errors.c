/* test_clip_errors.c: the errors that a pack states for its clips with fewer joints and at lower update rates, against
 * poses computed in double precision, and against what the library measures on the opened pack. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/convert.h"
#include "convert/clips/model_clips.h"
#include "convert/skin/joint_points.h"
#include "convert/skin/joint_radius.h"
#include "convert/skin/skins.h"
#include "support/clip_bank_fixture.h"
#include "stage/character/joint_lod_internal.h"
#include "stage/character/time_lod_internal.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

/* ---- a pack and its set ---- */

typedef struct opened {
    uint8_t *bytes;
    noh_pack pack;
    noh_clip_bank *set;
    void *memory;
} opened;

static opened open_skeleton(const char *input, convert_only only, uint32_t skeleton)
{
    opened o;
    convert_options options;
    noh_clip_bank_desc desc;
    size_t bytes;
    memset(&options, 0, sizeof options);
    memset(&desc, 0, sizeof desc);
    memset(&o, 0, sizeof o);
    options.only = only;
    o.bytes = clip_pack(&input, 1, &options, &bytes);
    o.pack = test_open(o.bytes, bytes);
    desc.clips = &o.pack;
    desc.skeleton = skeleton;
    bytes = noh_clip_bank_size(&desc, NULL);
    o.memory = test_aligned(NULL, bytes);
    assert_int_equal(noh_clip_bank_init(o.memory, bytes, &desc, &o.set, NULL), NOH_OK);
    return o;
}

static opened open_clip(const char *input, convert_only only)
{
    return open_skeleton(input, only, 0);
}

static void close_clip(opened *o)
{
    free(o->memory);
    free(o->bytes);
}

/* ---- the oracle ---- */

/* out = a * translation * rotation * scale of t; 3 rows of 4. */
static void append(const double *a, const noh_transform *t, double *out)
{
    const double x = (double)t->rotation[0], y = (double)t->rotation[1], z = (double)t->rotation[2],
                 w = (double)t->rotation[3];
    const double n = 2.0 / (x * x + y * y + z * z + w * w);
    const double turn[3][3] = { { 1 - n * (y * y + z * z), n * (x * y - w * z), n * (x * z + w * y) },
                                { n * (x * y + w * z), 1 - n * (x * x + z * z), n * (y * z - w * x) },
                                { n * (x * z - w * y), n * (y * z + w * x), 1 - n * (x * x + y * y) } };
    for (int r = 0; r < 3; r++) {
        out[4 * r + 3] = a[4 * r + 3];
        for (int c = 0; c < 3; c++) {
            out[4 * r + c] = 0.0;
            for (int k = 0; k < 3; k++) out[4 * r + c] += a[4 * r + k] * turn[k][c] * (double)t->scale[c];
            out[4 * r + 3] += a[4 * r + c] * (double)t->translation[c];
        }
    }
}

/* Joints from `count` on are in the bind pose's place below their parents. */
static void model_of(const noh_skeleton *s, const noh_transform *pose, uint32_t count, double *out)
{
    static const double identity[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
    for (uint32_t j = 0; j < s->joint_count; j++) {
        const double *above = s->parents[j] == NOH_JOINT_ROOT ? identity : out + 12u * (size_t)s->parents[j];
        append(above, j < count ? &pose[j] : &s->bind_pose[j], out + 12u * (size_t)j);
    }
}

/* The farthest of points around a joint, `reach` away in many directions. */
static double farthest(const double *a, const double *b, double reach)
{
    double worst = 0.0;
    for (int i = 0; i < 27; i++) {
        double p[3] = { i % 3 - 1.0, i / 3 % 3 - 1.0, i / 9 - 1.0 },
               length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]), square = 0.0;
        for (int r = 0; r < 3; r++) {
            double off = a[4 * r + 3] - b[4 * r + 3];
            for (int c = 0; c < 3; c++) off += (a[4 * r + c] - b[4 * r + c]) * p[c] / fmax(length, 1.0) * reach;
            square += off * off;
        }
        worst = fmax(worst, square);
    }
    return sqrt(worst);
}

/* The largest found of one clip in one level, over poses every `step` ticks. */
static double level_off(const opened *o, uint32_t clip, uint32_t count, const float *reach, uint32_t step)
{
    const noh_skeleton *s = &o->set->skeleton;
    noh_transform *pose = test_zeros(s->joint_count * sizeof *pose);
    float *floats = test_zeros((o->set->clips.float_count + 1u) * sizeof *floats);
    double *whole = test_zeros(12u * s->joint_count * sizeof *whole),
           *less = test_zeros(12u * s->joint_count * sizeof *less), worst = 0.0;
    for (uint32_t tick = 0; tick <= o->set->clips.clips[clip].duration_ticks; tick += step) {
        o->set->clips.sample(o->set->clips.user, clip, tick, s->joint_count, pose, o->set->clips.float_count, floats);
        model_of(s, pose, s->joint_count, whole);
        model_of(s, pose, count, less);
        for (uint32_t j = 0; j < s->joint_count; j++) {
            if (reach[j] >= 0.0f) {
                worst = fmax(worst, farthest(whole + 12u * (size_t)j, less + 12u * (size_t)j, (double)reach[j]));
            }
        }
    }
    free(pose);
    free(floats);
    free(whole);
    free(less);
    return worst;
}

/* The farthest vertex on each joint of the pack's skeleton, out of the file's own meshes and matrices. */
static float *reach_of(const model *m, const model_clips *made, const noh_pack *pack, uint32_t joint_count)
{
    float *reach = test_zeros(joint_count * sizeof *reach);
    for (uint32_t j = 0; j < joint_count; j++) reach[j] = -1.0f;
    for (uint32_t n = 0; n < m->node_count; n++) {
        const model_mesh *mesh = m->nodes[n].mesh == MODEL_NONE ? NULL : &m->meshes[m->nodes[n].mesh];
        const model_skin *skin = m->nodes[n].skin == MODEL_NONE ? NULL : &m->skins[m->nodes[n].skin];
        for (size_t i = 0; mesh && skin && i < (size_t)mesh->vertex_count * MODEL_INFLUENCES_MAX; i++) {
            const uint32_t place = mesh->joints[i];
            const float *bind = skin->inverse_bind + 16u * (size_t)place,
                        *at = mesh->position + 3 * (i / MODEL_INFLUENCES_MAX);
            const char *name = made->sets[0]->skeleton.joints[made->skins[m->nodes[n].skin].joints[place]].name;
            double square = 0.0;
            uint32_t j = 0;
            if (mesh->joint_weights[i] < 0.05f) continue;
            while (strcmp(noh_pack_joint_name(pack, 0, j), name) != 0) j++;
            for (int r = 0; r < 3; r++) {
                double x = (double)(bind[r] * at[0]) + (double)(bind[4 + r] * at[1]) + (double)(bind[8 + r] * at[2]) +
                           (double)bind[12 + r];
                square += x * x;
            }
            reach[j] = fmaxf(reach[j], (float)sqrt(square));
        }
    }
    return reach;
}

/* ---- with vertices ---- */

static void a_puppets_joint_errors_are_those_of_its_vertices(void **state)
{
    char path[4096];
    const char *build = getenv("NOH_BUILD");
    model *m;
    model_clips *made;
    model_error error;
    sample_options rate = { 0.0 };
    float *reach;
    uint32_t level_count;
    const uint32_t *levels;
    opened o;
    (void)state;
    snprintf(path, sizeof path, "%s/demo/puppet.glb", build ? build : "build");
    assert_int_equal(model_read_gltf(path, &m, &error), 0);
    assert_int_equal(clips_from_model(m, &rate, &made, &error), 0);
    o = open_clip(path, CONVERT_CLIPS);
    levels = noh_pack_joint_levels(&o.pack, 0, &level_count);
    assert_true(level_count >= 4);
    reach = reach_of(m, made, &o.pack, o.set->skeleton.joint_count);
    for (uint32_t clip = 0; clip < o.set->clips.clip_count; clip++) {
        noh_pack_clip from;
        assert_int_equal(noh_pack_clip_at(&o.pack, o.set->pack_clips[clip], &from, NULL), NOH_OK);
        assert_true(from.header->error_shell == 0.0f);
        assert_true(from.header->update_rate_error[1] > 0.0f &&
                    from.header->update_rate_error[1] < 0.05f); /* no walk's leap back among them */
        for (uint32_t i = 1; i < level_count; i++) {
            const double stored = (double)from.joint_errors[i], coarse = level_off(&o, clip, levels[i], reach, 800);
            print_message("%s, %u joints: %.4f m stored, %.4f found\n", from.name, levels[i], stored, coarse);
            assert_true(coarse <= stored * 1.0001 + 1e-6);
            assert_true(coarse >= 0.8 * stored);
        }
        assert_true(level_off(&o, clip, levels[level_count - 1], reach, 1234) <=
                    1.001 * (double)from.joint_errors[level_count - 1] + 1e-4);
    }
    free(reach);
    close_clip(&o);
    model_clips_free(made);
    model_free(m);
}

/* ---- rates, with vertices ---- */

#define GRID 200u /* ticks */

/* The matrices of all joints every GRID ticks, to the end of a clip and one longest period further:
 * [count][joint_count][12]. Each pass of a loop begins where the one before it ended. */
static double *course_of(const opened *o, uint32_t clip, uint32_t *count)
{
    const noh_skeleton *s = &o->set->skeleton;
    const noh_clip_entry *m = &o->set->clips.clips[clip];
    noh_transform *pose = test_zeros(s->joint_count * sizeof *pose);
    float *floats = test_zeros((o->set->clips.float_count + 1u) * sizeof *floats), ends[2][3];
    double *course;
    *count = (m->duration_ticks + 400u + 6000u) / GRID + 1u;
    course = test_zeros((size_t)*count * s->joint_count * 12u * sizeof *course);
    for (uint32_t i = 0; i < 2; i++) {
        o->set->clips.sample(o->set->clips.user, clip, i * m->duration_ticks, s->joint_count, pose,
                             o->set->clips.float_count, floats);
        memcpy(ends[i], pose[0].translation, sizeof ends[i]);
    }
    for (uint32_t i = 0; i < *count; i++) {
        const uint32_t tick = i * GRID, passes = m->loop == NOH_LOOP_REPEAT ? tick / m->duration_ticks : 0;
        const uint32_t at = m->loop == NOH_LOOP_REPEAT ? tick % m->duration_ticks
                            : tick < m->duration_ticks ? tick
                                                       : m->duration_ticks;
        double *models = course + (size_t)i * s->joint_count * 12u;
        o->set->clips.sample(o->set->clips.user, clip, at, s->joint_count, pose, o->set->clips.float_count, floats);
        model_of(s, pose, s->joint_count, models);
        for (uint32_t k = 0; k < 3u * s->joint_count; k++)
            models[4u * k + 3u] += passes * (double)(ends[1][k % 3u] - ends[0][k % 3u]);
    }
    free(pose);
    free(floats);
    return course;
}

/* A vertex's path: its place at each of these times, way[count][3]. `reach` of the joints whose weight on it is 0.05 or
 * more becomes at least its distance from them. */
static void way_of(const noh_mesh *mesh, const noh_skin *skin, uint32_t vertex, const double *course, uint32_t count,
                   uint32_t joint_count, double *way, float *reach)
{
    uint32_t joints[NOH_INFLUENCES_MAX];
    float weights[NOH_INFLUENCES_MAX];
    const uint32_t used = noh_mesh_influences(mesh, vertex, joints, weights);
    const float *at = mesh->positions + 3u * (size_t)vertex;
    memset(way, 0, 3u * (size_t)count * sizeof *way);
    for (uint32_t k = 0; k < used; k++) {
        const float *bind = skin->inverse_bind + 12u * (size_t)joints[k];
        double place[3];
        for (int r = 0; r < 3; r++) {
            place[r] = (double)bind[4 * r + 3];
            for (int i = 0; i < 3; i++) place[r] += (double)bind[4 * r + i] * (double)at[i];
        }
        if (weights[k] >= 0.05f) {
            float *of = &reach[skin->joints[joints[k]]];
            *of = fmaxf(*of, (float)sqrt(place[0] * place[0] + place[1] * place[1] + place[2] * place[2]));
        }
        for (size_t i = 0; i < count; i++) {
            const double *m = course + 12u * (i * joint_count + skin->joints[joints[k]]);
            for (size_t r = 0; r < 3; r++) {
                const double x = m[4 * r] * place[0] + m[4 * r + 1] * place[1] + m[4 * r + 2] * place[2] + m[4 * r + 3];
                way[3 * i + r] += (double)weights[k] * x;
            }
        }
    }
}

/* The farthest that the path is from the straight lines between its places one period apart. */
static double way_off(const double *way, uint32_t duration, uint32_t period)
{
    const uint32_t steps = period / GRID;
    double worst = 0.0;
    for (uint32_t start = 0; start < duration; start += 400) {
        const double *from = way + 3u * (size_t)(start / GRID), *to = from + 3u * (size_t)steps;
        for (uint32_t i = 1; i < steps; i++) {
            double square = 0.0;
            for (size_t k = 0; k < 3; k++) {
                const double off = from[k] + (to[k] - from[k]) * i / steps - from[3u * i + k];
                square += off * off;
            }
            worst = fmax(worst, square);
        }
    }
    return sqrt(worst);
}

/* The worst of all vertices that the set's skeleton moves, and the reach of its joints. */
static void worst_of_all(const opened *o, uint32_t skeleton, uint32_t clip, double worst[NOH_UPDATE_RATE_COUNT],
                         float *reach)
{
    const uint32_t joint_count = o->set->skeleton.joint_count;
    uint32_t count;
    double *course = course_of(o, clip, &count), *way = test_zeros(3u * (size_t)count * sizeof *way);
    for (uint32_t j = 0; j < joint_count; j++) reach[j] = -1.0f;
    memset(worst, 0, NOH_UPDATE_RATE_COUNT * sizeof *worst);
    for (uint32_t i = 0; i < o->pack.runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh mesh;
        noh_skin skin;
        noh_pack_mesh_at(&o->pack, i, &mesh, NULL);
        if (noh_pack_skin_at(&o->pack, mesh.header->skin, &skin, NULL) != NOH_OK || skin.header->skeleton != skeleton)
            continue;
        for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
            way_of(&mesh, &skin, v, course, count, joint_count, way, reach);
            for (int r = 1; r < NOH_UPDATE_RATE_COUNT; r++) {
                worst[r] = fmax(worst[r], way_off(way, o->set->clips.clips[clip].duration_ticks,
                                                  noh_update_period((noh_update_rate)r)));
            }
        }
    }
    free(course);
    free(way);
}

/* The stated error is not much less than the worst vertex's, and never more than the bound for all points that
 * the joints reach. */
static void expect_rates(const opened *o, uint32_t skeleton)
{
    float *reach = test_zeros(o->set->skeleton.joint_count * sizeof *reach);
    for (uint32_t clip = 0; clip < o->set->clips.clip_count; clip++) {
        noh_time_probe probe;
        double worst[NOH_UPDATE_RATE_COUNT];
        float bound[NOH_UPDATE_RATE_COUNT];
        noh_pack_clip from;
        uint8_t *memory;
        assert_int_equal(noh_pack_clip_at(&o->pack, o->set->pack_clips[clip], &from, NULL), NOH_OK);
        if (from.header->joint_count == 0) continue;
        worst_of_all(o, skeleton, clip, worst, reach);
        memset(&probe, 0, sizeof probe);
        probe.set = &o->set->clips, probe.skeleton = &o->set->skeleton, probe.joint_radius_m = reach, probe.travels = 1;
        memory = test_aligned(NULL, noh_time_lod_measure_size(&probe));
        assert_int_equal(noh_time_lod_measure(memory, noh_time_lod_measure_size(&probe), &probe, clip, bound, NULL),
                         NOH_OK);
        free(memory);
        for (int r = 1; r < NOH_UPDATE_RATE_COUNT; r++) {
            const double stored = (double)from.header->update_rate_error[r];
            print_message("%s, rate %d: %.5f m stored, %.5f the worst vertex, %.5f the bound\n", from.name, r, stored,
                          worst[r], (double)bound[r]);
            assert_true(worst[r] > 0.0 && stored >= 0.9 * worst[r]);
            assert_true(stored <= worst[r] * 1.001 + 1e-6 && stored <= (double)bound[r]);
        }
    }
    free(reach);
}

static void rates_are_those_of_the_worst_vertex(void **state)
{
    char path[4096];
    const char *build = getenv("NOH_BUILD");
    (void)state;
    snprintf(path, sizeof path, "%s/demo/arm.glb", build ? build : "build");
    for (uint32_t skeleton = 0; skeleton < 2; skeleton++) {
        opened o = open_skeleton(path, CONVERT_ALL, skeleton);
        assert_true(o.set->clips.clip_count > 0);
        expect_rates(&o, skeleton);
        close_clip(&o);
    }
}

/* Two joints a metre apart, three vertices; the farthest has too small a weight on the second to count. */
static void only_what_a_joint_moves_counts(void **state)
{
    float positions[9] = { 0.0f, 0.5f, 0.0f, 0.0f, 1.25f, 0.0f, 0.0f, 4.0f, 0.0f },
          weights[3 * MODEL_INFLUENCES_MAX] = { 0.0f }, reach[3];
    float binds[32] = {
        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1
    };
    uint16_t joints[3 * MODEL_INFLUENCES_MAX] = { 0 };
    uint32_t places[2] = { 0, 2 };
    model_skin skin;
    model_mesh mesh;
    model m;
    joint_points chosen;
    (void)state;
    memset(&skin, 0, sizeof skin);
    memset(&mesh, 0, sizeof mesh);
    memset(&m, 0, sizeof m);
    skin.joint_count = 2, skin.inverse_bind = binds, skin.skeleton_joints = places;
    mesh.vertex_count = 3, mesh.position = positions, mesh.joints = joints, mesh.joint_weights = weights,
    mesh.bound = 1;
    m.mesh_count = m.skin_count = 1, m.meshes = &mesh, m.skins = &skin;
    weights[0] = 1.0f;
    uint16_t *j = joints + MODEL_INFLUENCES_MAX;
    float *w = weights + MODEL_INFLUENCES_MAX;
    j[0] = 0, w[0] = 0.95f, j[1] = 1, w[1] = 0.05f;
    j += MODEL_INFLUENCES_MAX, w += MODEL_INFLUENCES_MAX;
    j[0] = 0, w[0] = 0.96f, j[1] = 1, w[1] = 0.04f;
    assert_int_equal(joint_radius(&m, 0, 3, reach), 1);
    assert_true(reach[0] == 4.0f && reach[1] == -1.0f && reach[2] == 0.25f);
    assert_int_equal(joint_radius(&m, 1, 3, reach), 0); /* no mesh of that skeleton */
    assert_true(reach[0] == -1.0f);
    assert_int_equal(joint_radius(NULL, 0, 3, reach), 0);
    assert_int_equal(joint_points_choose(&m, 0, 3, &chosen), 0);
    assert_true(chosen.points.point_count == 3 && chosen.points.holds_per_point == 2);
    assert_true(chosen.holds[0].joint == 0 && chosen.holds[0].weight == 0.96f &&
                chosen.holds[0].place[1] == 4.0f); /* the farthest of the first */
    assert_true(chosen.holds[1].joint == 2 && chosen.holds[1].weight == 0.04f && chosen.holds[1].place[1] == 3.0f);
    joint_points_free(&chosen);
    assert_int_equal(joint_points_choose(&m, 1, 3, &chosen), 0);
    assert_int_equal(chosen.points.point_count, 0);
    joint_points_free(&chosen);
    assert_int_equal(joint_points_choose(NULL, 0, 3, &chosen), 0);
    assert_int_equal(chosen.points.point_count, 0);
    joint_points_free(&chosen);
}

/* ---- without: a shell ---- */

static noh_time_probe probe_of(const opened *o, float *reach, float distance)
{
    noh_time_probe probe;
    memset(&probe, 0, sizeof probe);
    for (uint32_t j = 0; j < o->set->skeleton.joint_count; j++) reach[j] = distance;
    probe.set = &o->set->clips;
    probe.skeleton = &o->set->skeleton;
    probe.joint_radius_m = reach;
    return probe;
}

/* The stored errors equal, to the bit, what the library measures on the opened pack: same decoder, same method. */
static void a_chains_errors_are_what_the_library_measures(void **state)
{
    const char *path = clip_bvh("chain", "abcdefghijklmnopqrst", 2 * CLIP_PASS_FRAMES);
    opened o = open_clip(path, CONVERT_ALL);
    float reach[20], rates[NOH_UPDATE_RATE_COUNT], joints[NOH_LOD_LEVELS_MAX];
    noh_time_probe probe = probe_of(&o, reach, 3.0f);
    uint32_t level_count;
    const uint32_t *levels = noh_pack_joint_levels(&o.pack, 0, &level_count);
    size_t bytes = noh_time_lod_measure_size(&probe), joint_bytes = noh_joint_lod_measure_size(&probe);
    uint8_t *memory = test_aligned(NULL, bytes > joint_bytes ? bytes : joint_bytes);
    noh_pack_clip from;
    (void)state;
    assert_int_equal(noh_pack_clip_at(&o.pack, 0, &from, NULL), NOH_OK);
    assert_true(from.header->error_shell == 3.0f);
    assert_int_equal(noh_time_lod_measure(memory, bytes, &probe, 0, rates, NULL), NOH_OK);
    assert_memory_equal(rates, from.header->update_rate_error, sizeof rates);
    assert_true(rates[1] > 0.0f && rates[1] < rates[2] && rates[2] < rates[3]);
    assert_int_equal(noh_joint_lod_measure(memory, joint_bytes, &probe, 0, levels, level_count, joints, NULL), NOH_OK);
    assert_memory_equal(joints, from.joint_errors, level_count * sizeof *joints);
    for (uint32_t i = 1; i < level_count; i++) {
        const double found = level_off(&o, 0, levels[i], reach, 400);
        assert_true(found <= (double)joints[i] * 1.0001);
        assert_true(joints[i] == joints[i - 1] ||
                    found >= 0.8 * (double)joints[i]); /* equal: it is not said to be better */
    }
    free(memory);
    close_clip(&o);
}

/* A loop that travels goes on from where it ends, as with root motion, when the probe says so; else it leaps back. */
static void a_travelling_loop_has_the_errors_of_its_pass(void **state)
{
    const char *path = clip_bvh("chain", "abcd", CLIP_PASS_FRAMES);
    opened o = open_clip(path, CONVERT_ALL);
    float reach[4], once[NOH_UPDATE_RATE_COUNT], loop[NOH_UPDATE_RATE_COUNT], leap[NOH_UPDATE_RATE_COUNT];
    noh_time_probe probe = probe_of(&o, reach, 3.0f);
    noh_clip_entry played = o.set->clips.clips[0];
    noh_clip_set set = o.set->clips;
    size_t bytes;
    uint8_t *memory;
    (void)state;
    probe.set = &set;
    set.clips = &played;
    bytes = noh_time_lod_measure_size(&probe);
    memory = test_aligned(NULL, bytes);
    played.loop = NOH_LOOP_ONCE;
    assert_int_equal(noh_time_lod_measure(memory, bytes, &probe, 0, once, NULL), NOH_OK);
    played.loop = NOH_LOOP_REPEAT;
    assert_int_equal(noh_time_lod_measure(memory, bytes, &probe, 0, leap, NULL), NOH_OK);
    probe.travels = 1;
    assert_int_equal(noh_time_lod_measure(memory, bytes, &probe, 0, loop, NULL), NOH_OK);
    print_message("8 Hz: once %.3f cm, looped %.3f cm, its way 240 cm\n", (double)once[3], (double)loop[3]);
    for (int r = 1; r < NOH_UPDATE_RATE_COUNT; r++) {
        assert_true(loop[r] > 0.0f && loop[r] <= once[r] * 1.001f); /* played once it stops short at its end */
        assert_true(leap[r] > 100.0f);
    }
    free(memory);
    close_clip(&o);
}

/* ---- what is refused ---- */

static void bad_arguments_are_named(void **state)
{
    opened o = open_clip(clip_bvh("chain", "abcd", 4), CONVERT_ALL);
    float reach[4], errors[4] = { 7.0f, 7.0f, 7.0f, 7.0f };
    noh_time_probe probe = probe_of(&o, reach, 3.0f);
    const uint32_t fine[2] = { 4, 1 }, more[1] = { 5 }, rising[2] = { 2, 3 }, rootless[2] = { 4, 0 };
    size_t bytes = noh_joint_lod_measure_size(&probe);
    uint8_t *memory = test_aligned(NULL, bytes + 16);
    noh_error error = { NOH_OK, "", 0, 0 };
    (void)state;
    assert_int_equal(noh_joint_lod_measure(memory, bytes - 1, &probe, 0, fine, 2, errors, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, bytes);
    assert_int_equal(noh_joint_lod_measure(memory + 4, bytes, &probe, 0, fine, 2, errors, &error), NOH_ERR_ARG);
    assert_int_equal(noh_joint_lod_measure(memory, bytes, &probe, 1, fine, 2, errors, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, "clip", strlen("clip")), 0);
    assert_int_equal(noh_joint_lod_measure(memory, bytes, &probe, 0, more, 1, errors, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, "counts", strlen("counts")), 0);
    assert_int_equal(noh_joint_lod_measure(memory, bytes, &probe, 0, rising, 2, errors, &error), NOH_ERR_ARG);
    assert_int_equal(noh_joint_lod_measure(memory, bytes, &probe, 0, rootless, 2, errors, &error), NOH_ERR_ARG);
    assert_true(errors[0] == 7.0f && errors[1] == 7.0f);
    probe.joint_radius_m = NULL;
    assert_int_equal(noh_joint_lod_measure(memory, bytes, &probe, 0, fine, 2, errors, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, "probe", strlen("probe")), 0);
    probe.joint_radius_m = reach;
    assert_int_equal(noh_joint_lod_measure(memory, bytes, &probe, 0, fine, 2, errors, &error), NOH_OK);
    assert_true(errors[0] == 0.0f && errors[1] > 0.0f && errors[2] == 7.0f);
    free(memory);
    close_clip(&o);
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(a_puppets_joint_errors_are_those_of_its_vertices),
                                        cmocka_unit_test(rates_are_those_of_the_worst_vertex),
                                        cmocka_unit_test(only_what_a_joint_moves_counts),
                                        cmocka_unit_test(a_chains_errors_are_what_the_library_measures),
                                        cmocka_unit_test(a_travelling_loop_has_the_errors_of_its_pass),
                                        cmocka_unit_test(bad_arguments_are_named) };
    if (argument_count > 1) {
        cmocka_set_test_filter(arguments[1]);
    }
    return cmocka_run_group_tests_name("clip_errors", tests, NULL, NULL);
}
