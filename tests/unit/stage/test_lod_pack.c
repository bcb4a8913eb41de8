/* Tests of lod_pack.c: LOD tables and joint radii out of packs: exact bytes, metres, safe values
 * where little is known, and radii that contain every vertex. The pack is made from $NOH_BUILD/demo/arm.glb, which
 * `make check` makes. */
#include "support/level_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/clip_bank_fixture.h"
#include "support/pack_walk.h"
#include "support/skin_asset.h"
#include "stage/character/bounds_internal.h"
#include "stage/character/lod_internal.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

#define FOUR 1u /* the skeleton and the mesh of the arm that four joints hold */

static uint8_t *good;
static size_t good_count;

static int set_up(void **state)
{
    char path[4096];
    const char *build = getenv("NOH_BUILD"), *input = path;
    (void)state;
    snprintf(path, sizeof path, "%s/demo/arm.glb", build ? build : "build");
    good = clip_pack(&input, 1, NULL, &good_count);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    free(good);
    return 0;
}

/* ---- a set, and two packs that it is made of ---- */

typedef struct table {
    uint8_t *clips_bytes;
    noh_pack clips, pack;
    noh_clip_bank_desc set_desc;
    noh_clip_bank *set;
    noh_mesh mesh;
    noh_lod_pack_desc desc;
    noh_lod_pack made;
    void *set_memory;
    uint8_t *memory;
    size_t bytes;
} table;

typedef void (*forge)(noh_skeleton_header *skeleton, uint32_t *levels, noh_clip_header *clip);

static noh_clip_header *first_clip_of(uint8_t *bytes, const noh_pack *pack, uint32_t skeleton)
{
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_CLIP].count; i++) {
        noh_clip_header *h = (noh_clip_header *)(void *)(bytes +
                                                         pack->chunks[pack->runs[NOH_CHUNK_CLIP].first + i].offset);
        if (h->skeleton == skeleton) return h;
    }
    fail_msg("no clip moves skeleton %u", skeleton);
    return NULL;
}

/* The clips come from a copy of the pack that `change` has changed. */
static void open_table(table *t, forge change)
{
    memset(t, 0, sizeof *t);
    t->clips_bytes = test_aligned(good, good_count);
    t->pack = test_open(good, good_count);
    if (change) {
        uint8_t *chunk = t->clips_bytes + t->pack.chunks[t->pack.runs[NOH_CHUNK_SKELETON].first + FOUR].offset;
        noh_skeleton_header *skeleton = (noh_skeleton_header *)(void *)chunk;
        change(skeleton, (uint32_t *)(void *)(chunk + skeleton->levels_offset),
               first_clip_of(t->clips_bytes, &t->pack, FOUR));
        pack_repair(t->clips_bytes, good_count);
    }
    t->clips = test_open(t->clips_bytes, good_count);
    t->set_desc.clips = &t->clips;
    t->set_desc.mesh = &t->pack;
    t->set_desc.skeleton = FOUR;
    t->bytes = noh_clip_bank_size(&t->set_desc, NULL);
    t->set_memory = test_aligned(NULL, t->bytes);
    assert_int_equal(noh_clip_bank_init(t->set_memory, t->bytes, &t->set_desc, &t->set, NULL), NOH_OK);
    assert_int_equal(noh_pack_mesh_at(&t->pack, FOUR, &t->mesh, NULL), NOH_OK);
    assert_string_equal(t->mesh.name, "four");
    t->desc.set = t->set;
    t->desc.set_desc = &t->set_desc;
    t->desc.mesh = &t->mesh;
}

static void fill_table(table *t)
{
    t->bytes = noh_lod_pack_size(&t->desc);
    t->memory = test_aligned(NULL, t->bytes);
    assert_int_equal(noh_lod_pack_init(t->memory, t->bytes, &t->desc, &t->made, NULL), NOH_OK);
    assert_int_equal(noh_lod_table_check(&t->made.table, NULL), NOH_OK);
}

static void close_table(table *t)
{
    free(t->memory);
    free(t->set_memory);
    free(t->clips_bytes);
}

static noh_pack_clip clip_of(const table *t, uint32_t index)
{
    noh_pack_clip clip;
    assert_int_equal(noh_pack_clip_at(&t->clips, t->set->pack_clips[index], &clip, NULL), NOH_OK);
    return clip;
}

/* ---- what is in it ---- */

static void levels_have_the_worst_error_of_all_clips(void **state)
{
    table t;
    float worst[3] = { 0.0f, 0.0f, 0.0f };
    uint32_t moves = 0;
    (void)state;
    open_table(&t, NULL);
    fill_table(&t);
    assert_int_equal(t.made.table.joint_level_count, 3);
    assert_int_equal(t.made.table.joints[0].joint_count, 4);
    assert_int_equal(t.made.table.joints[1].joint_count, 3);
    assert_int_equal(t.made.table.joints[2].joint_count, 1);
    for (uint32_t m = 0; m < t.set->clips.clip_count; m++) {
        const noh_pack_clip clip = clip_of(&t, m);
        for (uint32_t r = 0; r < NOH_UPDATE_RATE_COUNT; r++) {
            assert_true(fabsf(t.made.table.update_error_m[NOH_UPDATE_RATE_COUNT * m + r] -
                              clip.header->update_rate_error[r]) < 1e-6f); /* in metres already */
        }
        for (uint32_t i = 0; i < clip.header->joint_error_count; i++) worst[i] = fmaxf(worst[i], clip.joint_errors[i]);
        moves += clip.header->joint_count != 0;
    }
    assert_true(moves >= 1);
    for (uint32_t i = 0; i < 3; i++) assert_true(fabsf(t.made.table.joints[i].error_m - worst[i]) < 1e-6f);
    assert_true(worst[1] > 0.0f && worst[2] > worst[1]);
    assert_true(t.made.table.clip_error_m > 0.0f && t.made.table.clip_error_m <= 0.000101f); /* built for 0.01 cm */
    close_table(&t);
}

/* With growing distance, fewer joints and fewer updates are chosen. */
static void lod_is_chosen_by_the_table(void **state)
{
    const noh_lod_settings settings = { 1.0f, { 0.0f, 0.0f, 0.0f, 0.0f, 0.0f }, 0.0f, 0.0f, 1 };
    table t;
    noh_lod d;
    uint32_t before = 4;
    (void)state;
    open_table(&t, NULL);
    fill_table(&t);
    memset(&d, 0, sizeof d);
    for (int step = 0; step < 60; step++) {
        const float scale = 2000.0f * powf(0.7f, (float)step);
        uint32_t joints;
        noh_lod_choose(&d, &t.made.table, &settings, scale, t.made.table.update_error_m, step);
        joints = noh_lod_joint_count(&d, &t.made.table);
        assert_true(joints <= before);
        assert_true(step || (joints == 4 && d.update_rate == NOH_UPDATE_RATE_FULL));
        before = joints;
    }
    assert_int_equal(before, 1);
    assert_int_equal(d.update_rate, NOH_UPDATE_RATE_8);
    close_table(&t);
}

static void centimetres_become_metres(void **state)
{
    const char *input = clip_bvh("chain", "abcd", CLIP_PASS_FRAMES);
    size_t count, bytes;
    uint8_t *built = clip_pack(&input, 1, NULL, &count), *memory;
    noh_pack pack = test_open(built, count);
    noh_clip_bank_desc set_desc;
    noh_lod_pack_desc desc;
    noh_lod_pack made;
    noh_pack_clip clip;
    noh_clip_bank *set;
    void *set_memory;
    (void)state;
    memset(&set_desc, 0, sizeof set_desc);
    memset(&desc, 0, sizeof desc);
    set_desc.clips = &pack;
    bytes = noh_clip_bank_size(&set_desc, NULL);
    set_memory = test_aligned(NULL, bytes);
    assert_int_equal(noh_clip_bank_init(set_memory, bytes, &set_desc, &set, NULL), NOH_OK);
    desc.set = set;
    desc.set_desc = &set_desc;
    bytes = noh_lod_pack_size(&desc);
    memory = test_aligned(NULL, bytes);
    assert_int_equal(noh_lod_pack_init(memory, bytes, &desc, &made, NULL), NOH_OK);
    assert_int_equal(noh_pack_clip_at(&pack, 0, &clip, NULL), NOH_OK);
    assert_null(made.joint_radius_m);
    assert_true(made.table.joint_level_count >= 2);
    assert_true(clip.joint_errors[1] > 0.1f); /* centimetres */
    assert_true(fabsf(made.table.joints[1].error_m / clip.joint_errors[1] - 0.01f) < 1e-6f);
    assert_true(fabsf(made.table.update_error_m[3] / clip.header->update_rate_error[3] - 0.01f) < 1e-6f);
    free(memory);
    free(set_memory);
    free(built);
}

/* ---- where little is known ---- */

static void forge_shell(noh_skeleton_header *skeleton, uint32_t *levels, noh_clip_header *clip)
{
    (void)skeleton, (void)levels;
    clip->error_shell = 0.03f;
}

/* The errors of a clip that was built without the mesh are scaled up for vertices farther out than its shell. */
static void errors_of_a_shell_grow_with_the_mesh(void **state)
{
    table seen, unseen, no_mesh;
    float radius = 0.0f;
    (void)state;
    open_table(&seen, NULL);
    fill_table(&seen);
    open_table(&unseen, forge_shell);
    fill_table(&unseen);
    open_table(&no_mesh, forge_shell);
    no_mesh.desc.mesh = NULL;
    fill_table(&no_mesh);
    for (uint32_t j = 0; j < 4; j++) radius = fmaxf(radius, seen.made.joint_radius_m[j]);
    assert_true(radius > 0.06f);
    for (uint32_t i = 0; i < 3; i++) {
        const float error = seen.made.table.joints[i].error_m;
        assert_true(fabsf(unseen.made.table.joints[i].error_m - error * radius / 0.03f) <=
                    1e-5f * error * radius / 0.03f);
        assert_true(no_mesh.made.table.joints[i].error_m == error);
    }
    close_table(&seen);
    close_table(&unseen);
    close_table(&no_mesh);
}

static void forge_coarser(noh_skeleton_header *skeleton, uint32_t *levels, noh_clip_header *clip)
{
    (void)skeleton, (void)clip;
    levels[1] = 2;
}

static void forge_finer(noh_skeleton_header *skeleton, uint32_t *levels, noh_clip_header *clip)
{
    (void)skeleton, (void)clip;
    levels[2] = 2;
}

/* A clip of a skeleton with other proportions has other levels: the error of its next coarser one is taken, or there is
 * none and the level is left out. */
static void levels_without_an_error_in_some_clip_are_left_out(void **state)
{
    table t;
    (void)state;
    open_table(&t, forge_coarser); /* 4, 2, 1 for 4, 3, 1 */
    fill_table(&t);
    assert_int_equal(t.made.table.joint_level_count, 3);
    assert_true(t.made.table.joints[1].error_m >= clip_of(&t, 0).joint_errors[1] * 0.999999f);
    close_table(&t);
    open_table(&t, forge_finer); /* 4, 3, 2 for 4, 3, 1 */
    fill_table(&t);
    assert_int_equal(t.made.table.joint_level_count, 2);
    close_table(&t);
}

/* ---- meshes ---- */

static noh_mesh_header *header_of(fixture_levels *f, uint32_t mesh)
{
    return (noh_mesh_header *)(void *)(f->bytes + f->pack.chunks[f->pack.runs[NOH_CHUNK_MESH].first + mesh].offset);
}

/* A level has one number everywhere. Loaded from level 1 on, the coarsest is still 2, and the finest chosen is 1. */
static void loaded_from_level_1(table *t, const noh_mesh_header *h)
{
    noh_lod_settings settings;
    noh_lod d;
    memset(&settings, 0, sizeof settings);
    t->mesh = noh_mesh_at_lod(&t->mesh, 1);
    fill_table(t);
    assert_int_equal(t->made.table.mesh_level_count, 3);
    assert_int_equal(t->made.table.mesh_level_first, 1);
    for (uint32_t k = 0; k < 3; k++) assert_int_equal(t->made.table.meshes[k].vertex_count, h[k].vertex_count);
    for (int far = 0; far < 2; far++) {
        memset(&d, 0, sizeof d);
        noh_lod_choose(&d, &t->made.table, &settings, far ? 1e-3f : 1e6f, NULL, 0);
        assert_int_equal(d.mesh, far ? 2 : 1);
        assert_int_equal(d.mesh_before, d.mesh);
        assert_int_equal(d.fade_ticks, 0);
        assert_true(d.error_m >= t->made.table.meshes[d.mesh].error_m);
        assert_int_equal(noh_lod_finest(&d), d.mesh);
        noh_lod_set_mesh(&d, &t->made.table, far ? 9 : 0, 1.0f);
        assert_int_equal(d.mesh, far ? 2 : 1);
    }
    t->made.table.mesh_level_first = 3;
    assert_int_equal(noh_lod_table_check(&t->made.table, NULL), NOH_ERR_ARG);
    t->made.table.mesh_level_first = 1;
}

/* Every level has the worst of its errors, and what it skips, in metres; fewer influences have theirs. */
static void levels_come_from_the_mesh(void **state)
{
    table t;
    fixture_levels f;
    noh_mesh_header *h;
    (void)state;
    open_table(&t, NULL);
    fixture_levels_open(&f, &t.pack, 3, 0.02f);
    h = header_of(&f, FOUR);
    for (uint32_t k = 0; k < 3; k++) {
        memset(&h[k].level_error_rest, 0, 6 * sizeof(float));
        h[k].world_scale = 2.0f;
        h[k].influence_errors[2] = 0.25f;
    }
    h[1].level_error_rest = h[2].level_error_rest = 0.001f;
    h[1].level_error_clip = 0.003f;
    h[2].level_error_targets = 0.004f;
    h[2].level_error_clip = 0.003f;
    h[2].level_skipped = 0.0005f;
    t.set_desc.mesh = &f.pack;
    assert_int_equal(noh_pack_mesh_at(&f.pack, FOUR, &t.mesh, NULL), NOH_OK);
    fill_table(&t);
    assert_int_equal(t.made.table.mesh_level_count, 3);
    for (uint32_t k = 0; k < 3; k++) {
        const noh_lod_mesh *level = &t.made.table.meshes[k];
        assert_int_equal(level->vertex_count, h[k].vertex_count);
        assert_int_equal(level->triangle_count, h[k].index_count / 3);
        assert_int_equal(level->influence_count, h[k].influence_count);
        assert_true(level->error_m == (k == 0 ? 0.0f : k == 1 ? 0.006f : 2.0f * (0.004f + 0.0005f)));
    }
    for (uint32_t i = 0; i < h->target_count; i++) {
        assert_true(t.made.radius_m[i] == 2.0f * t.mesh.targets[i].radius);
    }
    assert_int_equal(t.made.table.influences[0].influence_count, h->influence_count);
    assert_true(t.made.table.influences[0].error_m == 0.0f);
    for (uint32_t i = 1; i < t.made.table.influence_level_count; i++) {
        const noh_lod_influences *level = &t.made.table.influences[i];
        assert_int_equal(level->influence_count, t.made.table.influences[i - 1].influence_count / 2);
        assert_true(level->error_m == (level->influence_count == 1 ? 0.5f : 0.0f));
    }
    assert_int_equal(t.made.table.influences[t.made.table.influence_level_count - 1].influence_count, 1);
    free(t.memory);
    loaded_from_level_1(&t, h);
    fixture_levels_close(&f);
    close_table(&t);
}

/* ---- memory ---- */

static void a_byte_too_few_is_refused(void **state)
{
    table t;
    noh_error error = { NOH_OK, "", 0, 0 };
    uint8_t *block;
    noh_clip_bank counts;
    (void)state;
    open_table(&t, NULL);
    t.bytes = noh_lod_pack_size(&t.desc);
    memset(&counts, 0, sizeof counts); /* before there is a set */
    counts.clips.clip_count = t.set->clips.clip_count;
    counts.skeleton.joint_count = t.set->skeleton.joint_count;
    t.desc.set = &counts;
    assert_int_equal(noh_lod_pack_size(&t.desc), t.bytes);
    t.desc.set = t.set;
    assert_int_equal(t.bytes, sizeof(noh_lod_mesh) + 4 * sizeof(noh_lod_influences) + 3 * sizeof(noh_lod_joints) +
                                  t.set->clips.clip_count * NOH_UPDATE_RATE_COUNT * sizeof(float) +
                                  (4 + t.mesh.header->target_count) * sizeof(float));
    block = test_aligned(NULL, t.bytes + 64);
    memset(block, 0xa5, t.bytes + 64);
    assert_int_equal(noh_lod_pack_init(block, t.bytes - 1, &t.desc, &t.made, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, t.bytes);
    assert_int_equal(noh_lod_pack_init(block + 4, t.bytes, &t.desc, &t.made, &error), NOH_ERR_ARG);
    assert_int_equal(noh_lod_pack_init(NULL, t.bytes, &t.desc, &t.made, &error), NOH_ERR_ARG);
    assert_int_equal(block[0], 0xa5);
    assert_int_equal(noh_lod_pack_init(block, t.bytes, &t.desc, &t.made, &error), NOH_OK);
    for (size_t i = t.bytes; i < t.bytes + 64; i++) assert_int_equal(block[i], 0xa5);
    free(block);
    close_table(&t);
}

static void expect_bad(const noh_lod_pack_desc *desc, const char *field)
{
    static uint64_t memory[64];
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_lod_pack made;
    assert_int_equal(noh_lod_pack_size(desc), 0);
    assert_int_equal(noh_lod_pack_init(memory, sizeof memory, desc, &made, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, field, strlen(field)), 0);
}

static void bad_descs_are_named(void **state)
{
    table t;
    noh_mesh other;
    noh_lod_pack_desc desc;
    noh_clip_bank_desc set_desc;
    (void)state;
    open_table(&t, NULL);
    desc = t.desc;
    desc.set = NULL;
    expect_bad(&desc, "set");
    desc = t.desc;
    desc.set_desc = NULL;
    expect_bad(&desc, "set_desc");
    set_desc = t.set_desc;
    set_desc.skeleton = 0; /* of two joints: not what the set was made by */
    desc = t.desc;
    desc.set_desc = &set_desc;
    expect_bad(&desc, "set_desc");
    assert_int_equal(noh_pack_mesh_at(&t.pack, 0, &other, NULL), NOH_OK); /* another skeleton moves it */
    desc = t.desc;
    desc.mesh = &other;
    expect_bad(&desc, "the skeleton of the set");
    assert_int_equal(noh_pack_mesh_at(&t.clips, FOUR, &other, NULL), NOH_OK); /* of another pack */
    expect_bad(&desc, "the skeleton of the set");
    close_table(&t);
}

/* ---- radii ---- */

/* The distance of a vertex from a joint that moves it. */
static double distance(const noh_skin *skin, uint32_t joint, const float *at)
{
    const float *m = skin->inverse_bind + 12u * (size_t)joint;
    double square = 0.0;
    for (int r = 0; r < 3; r++) {
        double x = (double)m[4 * r + 3];
        for (int c = 0; c < 3; c++) x += (double)m[4 * r + c] * (double)at[c];
        square += x * x;
    }
    return sqrt(square);
}

/* The largest distance of a vertex to each joint of the skeleton at these weights; -1: none. */
static void distances(const noh_mesh *mesh, const float *weights, double *out, uint32_t joint_count)
{
    noh_morph_layers layers;
    uint8_t *memory = test_aligned(NULL, noh_morph_layers_size(mesh));
    noh_skin skin;
    assert_int_equal(noh_morph_layers_init(memory, noh_morph_layers_size(mesh), mesh, &layers, NULL), NOH_OK);
    assert_int_equal(noh_pack_skin_at(mesh->pack, mesh->header->skin, &skin, NULL), NOH_OK);
    noh_morph_accumulate(mesh, weights, &layers);
    for (uint32_t j = 0; j < joint_count; j++) out[j] = -1.0;
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        uint32_t joints[NOH_INFLUENCES_MAX], count;
        float shares[NOH_INFLUENCES_MAX];
        noh_vertex vertex;
        noh_morph_vertex(mesh, &layers, v, &vertex);
        count = noh_mesh_influences(mesh, v, joints, shares);
        for (uint32_t i = 0; i < count; i++) {
            double *most = &out[skin.joints[joints[i]]];
            if (shares[i] > 0.0f) *most = fmax(*most, distance(&skin, joints[i], vertex.position));
        }
    }
    free(memory);
}

static void radii_contain_all_vertices_of_all_weights(void **state)
{
    const skin_cylinder tube = { 24, 30, 6, 4, 3, 0, 2.0f, 0.3f };
    model *m = skin_cylinder_model(&tube);
    size_t count;
    uint8_t *bytes;
    noh_pack pack;
    test_random r = test_random_from(74);
    float radii[16], none[3] = { 0.0f, 0.0f, 0.0f }, most[3] = { 1.5f, -0.5f, 1.0f };
    double rest[16], found[16];
    uint32_t n;
    noh_skeleton skeleton;
    noh_mesh mesh;
    (void)state;
    for (uint32_t v = 0; v < m->meshes[0].vertex_count; v++)
        m->meshes[0].targets[0].position[3 * v] = 0.05f; /* all to one side */
    bytes = skin_pack_of(m, NULL, 10.0f, &count, NULL);
    pack = test_open(bytes, count);
    assert_int_equal(noh_pack_mesh_at(&pack, 0, &mesh, NULL), NOH_OK);
    assert_int_equal(noh_pack_skeleton_at(&pack, 0, &skeleton, NULL, NULL), NOH_OK);
    n = skeleton.joint_count;
    assert_true(n <= 16 && mesh.header->target_count == 3);
    distances(&mesh, none, rest, n);
    for (uint32_t j = 0; j < n; j++) radii[j] = -1.0f;
    noh_mesh_add_joint_radii(&mesh, none, radii);
    for (uint32_t j = 0; j < n; j++) {
        assert_true((radii[j] < 0.0f) == (rest[j] < 0.0));
        assert_true((double)radii[j] >= rest[j] &&
                    (rest[j] < 0.0 || (double)radii[j] <= 1.8 * rest[j])); /* a corner of a box */
    }
    noh_mesh_add_joint_radii(&mesh, most, radii);
    for (int round = 0; round < 50; round++) {
        float weights[3];
        for (int t = 0; t < 3; t++) weights[t] = round ? test_random_float(&r, 0.0f, 1.0f) * most[t] : most[t];
        distances(&mesh, weights, found, n);
        for (uint32_t j = 0; j < n; j++) assert_true(found[j] <= (double)radii[j]);
    }
    for (int t = 0; t < 3; t++) {
        float far[3] = { 0.0f, 0.0f, 0.0f };
        far[t] = -100.0f; /* against the target */
        for (uint32_t j = 0; j < n; j++) radii[j] = -1.0f;
        noh_mesh_add_joint_radii(&mesh, far, radii);
        distances(&mesh, far, found, n);
        for (uint32_t j = 0; j < n; j++) assert_true(found[j] <= (double)radii[j]);
    }
    free(bytes);
    model_free(m);
}

/* A vertex as its joints move it. */
static void skinned_vertex(const noh_mesh *mesh, const noh_skin *skin, const float *joint_matrices, uint32_t vertex,
                           double out[3])
{
    const float *p = mesh->positions + 3u * (size_t)vertex;
    uint32_t joints[NOH_INFLUENCES_MAX], count;
    float weights[NOH_INFLUENCES_MAX], matrix[12];
    count = noh_mesh_influences(mesh, vertex, joints, weights);
    out[0] = out[1] = out[2] = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        noh_matrix_multiply(joint_matrices + 12u * (size_t)skin->joints[joints[i]],
                            skin->inverse_bind + 12u * (size_t)joints[i], matrix);
        for (int r = 0; r < 3; r++) {
            double at = (double)matrix[4 * r + 3];
            for (int c = 0; c < 3; c++) at += (double)matrix[4 * r + c] * (double)p[c];
            out[r] += (double)weights[i] * at;
        }
    }
}

/* Real clips: every skinned vertex is in the sphere, with all joints posed or some. */
static void a_posed_arm_is_in_its_sphere(void **state)
{
    table t;
    noh_skin skin;
    (void)state;
    open_table(&t, NULL);
    fill_table(&t);
    assert_int_equal(noh_pack_skin_at(&t.pack, t.mesh.header->skin, &skin, NULL), NOH_OK);
    for (uint32_t tick = 0; tick <= t.set->clips.clips[0].duration_ticks; tick += 4800) {
        noh_transform pose[4];
        float matrices[48];
        noh_bounds bounds[3];
        t.set->clips.sample(t.set->clips.user, 0, tick, 4, pose, 0, NULL);
        noh_local_to_model(&t.set->skeleton, pose, 4, matrices);
        for (uint32_t i = 0; i < 3; i++) {
            noh_joint_bounds(&t.set->skeleton, matrices, t.made.joint_radius_m, t.made.table.joints[i].joint_count,
                             &bounds[i]);
        }
        for (uint32_t v = 0; v < t.mesh.header->vertex_count; v++) {
            double at[3];
            skinned_vertex(&t.mesh, &skin, matrices, v, at);
            for (uint32_t i = 0; i < 3; i++) {
                double square = 0.0;
                for (int k = 0; k < 3; k++)
                    square += (at[k] - (double)bounds[i].centre[k]) * (at[k] - (double)bounds[i].centre[k]);
                assert_true(sqrt(square) <= (double)bounds[i].radius);
            }
        }
    }
    close_table(&t);
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(levels_have_the_worst_error_of_all_clips),
                                        cmocka_unit_test(lod_is_chosen_by_the_table),
                                        cmocka_unit_test(centimetres_become_metres),
                                        cmocka_unit_test(errors_of_a_shell_grow_with_the_mesh),
                                        cmocka_unit_test(levels_without_an_error_in_some_clip_are_left_out),
                                        cmocka_unit_test(levels_come_from_the_mesh),
                                        cmocka_unit_test(a_byte_too_few_is_refused),
                                        cmocka_unit_test(bad_descs_are_named),
                                        cmocka_unit_test(radii_contain_all_vertices_of_all_weights),
                                        cmocka_unit_test(a_posed_arm_is_in_its_sphere) };
    if (argument_count > 1) {
        cmocka_set_test_filter(arguments[1]);
    }
    return cmocka_run_group_tests_name("lod_pack", tests, set_up, tear_down);
}
