/* Skins in packs: what is written, what a reader refuses, and how the converter treats odd input. */
#include "support/skin_asset.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "support/pack_walk.h"
#include "noh/low_core.h"

static const skin_cylinder small = { 4, 7, 6, 4, 1, 1, 2.0f, 0.5f };

static uint8_t *split_pack(size_t *count)
{
    skin_options options;
    model *m = skin_cylinder_model(&small);
    uint8_t *bytes;
    memset(&options, 0, sizeof options);
    options.palette = 5;
    bytes = skin_pack_of(m, &options, 1.0f, count, NULL);
    model_free(m);
    return bytes;
}

/* ---- lies ---- */

/* What a lie may reach for. */
typedef struct forged {
    noh_mesh_header *mesh;
    noh_skin_header *skin;
    uint8_t *mesh_bytes, *skin_bytes;
    uint32_t *influences, *texels; /* texels: the last word of vertex 0's record */
    noh_submesh *submeshes;
    noh_palette *palettes;
    uint16_t *palette_joints, *joints;
    float *inverse_bind, *joint_boxes, *target_boxes;
    float *bind_pose; /* of the skeleton, which is a chain */
    uint32_t words, stride;
} forged;

static void first_chunk(uint8_t *bytes, uint32_t type, uint8_t **chunk)
{
    const noh_pack_header *h = (const noh_pack_header *)(const void *)bytes;
    const noh_pack_chunk *chunks = (const noh_pack_chunk *)(const void *)(bytes + sizeof *h);
    for (uint32_t i = 0; i < h->chunk_count; i++) {
        if (chunks[i].type == type) {
            *chunk = bytes + chunks[i].offset;
            return;
        }
    }
    fail_msg("no such chunk");
}

static forged reach(uint8_t *bytes)
{
    forged f;
    uint8_t *skeleton = NULL;
    first_chunk(bytes, NOH_TAG_MESH, &f.mesh_bytes);
    first_chunk(bytes, NOH_TAG_SKIN, &f.skin_bytes);
    first_chunk(bytes, NOH_TAG_SKELETON, &skeleton);
    f.bind_pose = (float *)(void *)(skeleton + ((const noh_skeleton_header *)(const void *)skeleton)->bind_offset);
    f.mesh = (noh_mesh_header *)(void *)f.mesh_bytes;
    f.skin = (noh_skin_header *)(void *)f.skin_bytes;
    f.words = NOH_INFLUENCE_WORDS(f.mesh->influence_count);
    f.stride = f.mesh->attribute_stride;
    f.influences = (uint32_t *)(void *)(f.mesh_bytes + f.mesh->influences_offset);
    f.texels = (uint32_t *)(void *)(f.mesh_bytes + f.mesh->attributes_offset + f.stride - 4);
    f.submeshes = (noh_submesh *)(void *)(f.mesh_bytes + f.mesh->submeshes_offset);
    f.palettes = (noh_palette *)(void *)(f.mesh_bytes + f.mesh->palettes_offset);
    f.palette_joints = (uint16_t *)(void *)(f.mesh_bytes + f.mesh->palette_joints_offset);
    f.joint_boxes = (float *)(void *)(f.mesh_bytes + f.mesh->joint_boxes_offset);
    f.target_boxes = (float *)(void *)(f.mesh_bytes + f.mesh->target_boxes_offset);
    f.joints = (uint16_t *)(void *)(f.skin_bytes + f.skin->joints_offset);
    f.inverse_bind = (float *)(void *)(f.skin_bytes + f.skin->inverse_bind_offset);
    return f;
}

#define LIES(X)                                                                                                     \
    X(skin_without_joints, f->skin->joint_count = 0, "no joints")                                                   \
    X(skin_of_too_many_joints, f->skin->joint_count = 70000, "too many")                                            \
    X(skin_of_no_skeleton, f->skin->skeleton = 1, "missing skeleton")                                               \
    X(skin_joint_outside, f->joints[1] = 6, "joint that its skeleton does not have")                                \
    X(skin_bind_nan, f->inverse_bind[17] = NAN, "inverse bind matrix is not finite")                                \
    X(skin_bind_infinite, f->inverse_bind[0] = INFINITY, "inverse bind matrix is not finite")                       \
    X(skin_bind_beyond, f->inverse_bind[0] = -3e38f, "larger than 10^12")                                           \
    X(bind_pose_beyond, f->bind_pose[24] = 2.0f * NOH_NUMBER_MAX, "larger than 10^12")                              \
    X(scales_beyond, f->bind_pose[7] = f->bind_pose[17] = f->bind_pose[27] = 1e5f, "joint and its ancestors")       \
    X(reach_beyond, (f->bind_pose[7] = 1e5f, f->bind_pose[15] = 1e8f), "joint and its ancestors")                   \
    X(joint_box_beyond, f->joint_boxes[3] = 3e38f, "larger than 10^12")                                             \
    X(mesh_of_no_skin, f->mesh->skin = 1, "missing skin")                                                           \
    X(rigid_with_influences, f->mesh->skin = NOH_NONE, "rigid mesh has influences")                                 \
    X(three_influences, f->mesh->influence_count = 3, "neither 1, 2, 4 nor 8")                                      \
    X(no_influences, f->mesh->influence_count = 0, "neither 1, 2, 4 nor 8")                                         \
    X(no_palettes, f->mesh->palette_count = 0, "palette count is zero")                                             \
    X(too_many_palettes, f->mesh->palette_count = 300, "palette count is zero or over")                             \
    X(too_many_palette_joints, f->mesh->palette_joint_count = 4096, "too many joints")                              \
    X(split_without_texels, f->mesh->flags &= ~NOH_MESH_TEXELS, "texel references")                                 \
    X(palette_empty, f->palettes[0].joint_count = 0, "palette is empty")                                            \
    X(palette_too_long, f->palettes[1].joint_count += 1, "palette is empty, too large")                             \
    X(palettes_apart, f->palettes[1].first_joint += 1, "does not follow the previous palette")                      \
    X(palettes_short, f->palettes[f->mesh->palette_count - 1].joint_count -= 1, "do not add up")                    \
    X(palette_joint_outside, f->palette_joints[0] = 6, "joint that its skin does not have")                         \
    X(place_outside, f->influences[0] |= 0xff, "outside its palette")                                               \
    X(second_place_outside, f->influences[0] |= 0xff00, "outside its palette")                                      \
    X(weightless_joint, f->influences[1] = f->influences[2] = 0, "without a weight")                                \
    X(weights_above_one, (f->influences[1] = 0xffffffffu, f->influences[2] = 0xffffffffu), "above 1")               \
    X(later_texel, *f->texels += 1, "texel of a later vertex")                                                      \
    X(no_such_palette, *f->texels |= 0xff400000u, "of another palette")                                             \
    X(another_palette, *f->texels ^= 0x00400000u, "")                                                               \
    X(submesh_without_palette, f->submeshes[0].palette = 40, "missing palette")                                     \
    X(submesh_of_another_palette, f->submeshes[0].palette = 1, "vertex of another palette")                         \
    X(submeshes_overlap, f->submeshes[1].first_index -= 3, "overlap")                                               \
    X(joint_box_nan, f->joint_boxes[2] = NAN, "box is not finite")                                                  \
    X(joint_box_inside_out, f->joint_boxes[0] = f->joint_boxes[3] + 1.0f, "above its maximum")                      \
    X(joint_box_empty_in_x_y, (f->joint_boxes[0] = f->joint_boxes[1] = 9.0f), "above its maximum")                  \
    X(joint_box_empty_in_y_z, (f->joint_boxes[1] = f->joint_boxes[2] = 9.0f), "above its maximum")                  \
    X(joint_box_empty_in_x_z, (f->joint_boxes[0] = f->joint_boxes[2] = 9.0f), "above its maximum")                  \
    X(target_box_inside_out, f->target_boxes[0] = 9.0f, "above its maximum")                                        \
    X(target_box_empty, (f->target_boxes[0] = f->target_boxes[1] = f->target_boxes[2] = 9.0f), "above its maximum") \
    X(reserved_field, f->mesh->reserved[1] = 1, "reserved")

#define X(name, lie, message)                                                       \
    static void forged_##name(void **state)                                         \
    {                                                                               \
        size_t count;                                                               \
        uint8_t *bytes = split_pack(&count);                                        \
        forged all = reach(bytes), *f = &all;                                       \
        noh_pack pack;                                                              \
        noh_error error = { NOH_OK, "", 0, 0 };                                     \
        (void)state;                                                                \
        test_open(bytes, count);                                                    \
        lie;                                                                        \
        pack_repair(bytes, count);                                                  \
        assert_int_equal(noh_pack_open(bytes, count, &pack, &error), NOH_ERR_DATA); \
        if (!strstr(error.what, message)) {                                         \
            fail_msg("said: %s", error.what);                                       \
        }                                                                           \
        free(bytes);                                                                \
    }
LIES(X)
#undef X

/* What is read with a vertex's record lies in its palette, and what that names in its skin. */
static void expect_limits(const noh_pack *pack)
{
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_MESH].count; i++) {
        const noh_mesh mesh = test_mesh(pack, i);
        const noh_mesh_header *h = mesh.header;
        noh_skin skin;
        if (h->skin == NOH_NONE) continue;
        assert_int_equal(noh_pack_skin_at(pack, h->skin, &skin, NULL), NOH_OK);
        for (uint32_t j = 0; j < h->palette_joint_count; j++) {
            assert_true(mesh.palette_joints[j] < skin.header->joint_count);
        }
        for (uint32_t v = 0; v < h->vertex_count; v++) {
            const uint32_t *words = mesh.influences + (size_t)v * NOH_INFLUENCE_WORDS(h->influence_count);
            const noh_palette *palette = &mesh.palettes[noh_mesh_palette(&mesh, v)];
            for (uint32_t k = 0; k < h->influence_count; k++) {
                assert_true((words[k / 4u] >> 8u * (k % 4u) & 255u) < palette->joint_count);
            }
        }
    }
}

/* With repaired checksums every flip is refused, or the pack that opens is read without a step out of bounds. */
static void repaired_flips_stay_in_bounds(void **state)
{
    size_t count;
    uint8_t *good = split_pack(&count);
    uint32_t opened = 0;
    (void)state;
    for (size_t bit = 0; bit < count * 8; bit++) {
        uint8_t *bytes = test_aligned(good, count);
        noh_pack pack;
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        pack_repair(bytes, count);
        if (noh_pack_open(bytes, count, &pack, NULL) == NOH_OK) {
            opened += 1;
            expect_limits(&pack);
            if (opened % 16 == 0) {
                (void)pack_walk(&pack, (uint32_t)bit);
            }
        }
        free(bytes);
    }
    assert_true(opened > 0);
    free(good);
}

static void every_truncation_and_flip_is_refused(void **state)
{
    size_t count;
    uint8_t *bytes = split_pack(&count);
    noh_pack pack;
    (void)state;
    for (size_t length = 0; length < count; length++) {
        assert_int_not_equal(noh_pack_open(bytes, length, &pack, NULL), NOH_OK);
    }
    for (size_t bit = 0; bit < count * 8; bit++) {
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        assert_int_not_equal(noh_pack_open(bytes, count, &pack, NULL), NOH_OK);
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
    free(bytes);
}

/* ---- one mesh, several skins ---- */

static void a_mesh_of_two_skins_is_copied(void **state)
{
    model *m = skin_cylinder_model(&small);
    noh_pack pack;
    noh_mesh a, b;
    size_t count;
    uint8_t *bytes;
    (void)state;
    m->skins = realloc(m->skins, 2 * sizeof *m->skins);
    m->skins[1] = m->skins[0];
    m->skins[1].name = model_string("others");
    m->skins[1].joints = test_zeros(4 * 6);
    m->skins[1].inverse_bind = test_zeros(64 * 6);
    memcpy(m->skins[1].joints, m->skins[0].joints, 4 * 6);
    memcpy(m->skins[1].inverse_bind, m->skins[0].inverse_bind, 64 * 6);
    m->skins[1].inverse_bind[12] = 5.0f;
    m->skin_count = 2;
    m->nodes[7] = m->nodes[6];
    m->nodes[7].name = model_string("twin");
    m->nodes[7].skin = 1;
    m->nodes[8] = m->nodes[6];
    m->nodes[8].name = model_string("statue"); /* drawn without a skin */
    m->nodes[8].skin = MODEL_NONE;
    m->nodes = realloc(m->nodes, sizeof *m->nodes * 9);
    m->node_count = 9;
    bytes = skin_pack_of(m, NULL, 1.0f, &count, NULL);
    pack = test_open(bytes, count);
    assert_int_equal(pack.runs[NOH_CHUNK_MESH].count, 3);
    assert_int_equal(pack.runs[NOH_CHUNK_SKIN].count, 2);
    a = test_mesh(&pack, pack.nodes[6].mesh);
    b = test_mesh(&pack, pack.nodes[7].mesh);
    assert_int_equal(a.header->skin, 0);
    assert_int_equal(b.header->skin, 1);
    assert_int_equal(test_mesh(&pack, pack.nodes[8].mesh).header->skin, NOH_NONE);
    assert_memory_equal(a.positions, b.positions, 12u * (size_t)a.header->vertex_count);
    assert_int_equal(a.header->target_count, b.header->target_count);
    free(bytes);
    model_free(m);
}

/* ---- rigid meshes below joints ---- */

/* A box-less triangle mesh, one material, hung under a joint. */
static void hang_triangle(model *m, uint32_t node, uint32_t parent, float x_scale, uint32_t material)
{
    const float position[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };
    model_mesh *mesh;
    model_node *n = &m->nodes[node];
    m->meshes = realloc(m->meshes, sizeof *m->meshes * (m->mesh_count + 1u));
    mesh = &m->meshes[m->mesh_count];
    memset(mesh, 0, sizeof *mesh);
    mesh->name = model_string("plate");
    mesh->vertex_count = mesh->index_count = 3;
    mesh->position = test_zeros(36);
    mesh->normal = test_zeros(36);
    mesh->indices = test_zeros(12);
    mesh->submesh_count = 1;
    mesh->submeshes = test_zeros(sizeof *mesh->submeshes);
    mesh->submeshes[0].index_count = mesh->submeshes[0].vertex_count = 3;
    mesh->submeshes[0].material = material;
    mesh->targets = test_zeros(sizeof *mesh->targets);
    mesh->weights = test_zeros(4);
    for (uint32_t i = 0; i < 3; i++) {
        mesh->indices[i] = i;
        mesh->normal[3 * i + 2] = 1.0f;
    }
    memcpy(mesh->position, position, sizeof position);
    memset(n, 0, sizeof *n);
    n->name = model_string("plate");
    n->parent = parent;
    n->mesh = m->mesh_count++;
    n->skin = MODEL_NONE;
    n->rotation[3] = 1.0f;
    n->scale[0] = x_scale;
    n->scale[1] = n->scale[2] = 1.0f;
    memcpy(n->world, m->nodes[parent].world, sizeof n->world);
    for (int i = 0; i < 3; i++) {
        n->world[i] *= (double)x_scale;
    }
}

static model *with_plates(float x_scale, int material_count)
{
    const skin_cylinder c = { 4, 7, 3, 1, 0, 0, 2.0f, 0.5f };
    model *m = skin_cylinder_model(&c);
    m->material_count = (uint32_t)material_count;
    m->materials = test_zeros(sizeof *m->materials * (size_t)material_count);
    for (int i = 0; i < material_count; i++) {
        m->materials[i] = model_material_default();
        m->materials[i].name = model_string("paint");
        m->materials[i].base_color_texture = MODEL_NONE;
    }
    hang_triangle(m, 4, 1, 1.0f, 0);
    hang_triangle(m, 5, 2, x_scale, (uint32_t)material_count - 1u);
    m->node_count = 6;
    return m;
}

/* The plates of the joined mesh face the way they did. */
static void check_plates(const noh_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->header->index_count; i += 3) {
        float p[3][3], a[3], b[3];
        noh_vertex vertex;
        for (uint32_t c = 0; c < 3; c++) {
            memcpy(p[c], mesh->positions + 3u * (size_t)noh_mesh_index(mesh, i + c), 12);
        }
        for (int k = 0; k < 3; k++) {
            a[k] = p[1][k] - p[0][k];
            b[k] = p[2][k] - p[0][k];
        }
        assert_true(a[0] * b[1] - a[1] * b[0] > 0.0f); /* counter-clockwise as before: a mirror is turned round */
        noh_mesh_vertex(mesh, noh_mesh_index(mesh, i), &vertex);
        assert_true(vertex.normal[2] > 0.999f);
    }
}

/* Rigid parts of one skeleton become one mesh of one influence, one draw per material. */
static void rigid_parts_become_one_mesh(void **state)
{
    (void)state;
    for (int materials = 1; materials <= 2; materials++) {
        for (int mirrored = 0; mirrored < 2; mirrored++) {
            model *m = with_plates(mirrored ? -2.0f : 2.0f, materials);
            size_t count;
            uint8_t *bytes = skin_pack_of(m, NULL, 1.0f, &count, NULL);
            noh_pack pack = test_open(bytes, count);
            noh_mesh mesh = test_mesh(&pack, pack.nodes[4].mesh);
            noh_skin skin;
            assert_int_equal(pack.runs[NOH_CHUNK_MESH].count,
                             2); /* the tube has no material of theirs, so it stays apart */
            assert_int_equal(pack.nodes[5].mesh, NOH_NONE);
            assert_int_equal(mesh.header->influence_count, 1);
            assert_int_equal(mesh.header->vertex_count, 6);
            assert_int_equal(mesh.header->submesh_count, materials);
            assert_int_equal(noh_pack_skin_at(&pack, mesh.header->skin, &skin, NULL), NOH_OK);
            assert_int_equal(skin.header->joint_count, 2);
            assert_true(pack.nodes[4].world[0] == 1.0f && pack.nodes[4].world[7] == 0.0f);
            check_plates(&mesh);
            free(bytes);
            model_free(m);
        }
    }
}

static void parts_are_kept_where_asked(void **state)
{
    model *m = with_plates(2.0f, 1);
    skin_options options;
    size_t count;
    uint8_t *bytes;
    noh_pack pack;
    (void)state;
    memset(&options, 0, sizeof options);
    options.keep_parts = 1;
    bytes = skin_pack_of(m, &options, 1.0f, &count, NULL);
    pack = test_open(bytes, count);
    assert_int_equal(pack.runs[NOH_CHUNK_MESH].count, 3);
    for (uint32_t i = 0; i < 3; i++) {
        assert_int_not_equal(test_mesh(&pack, i).header->skin, NOH_NONE);
    }
    free(bytes);
    model_free(m);
}

/* A part hidden at rest by a scale of zero keeps its own space, and its shape when the joint grows. */
static void parts_hidden_at_rest_are_kept(void **state)
{
    model *m = with_plates(2.0f, 1);
    float model_space[36], matrices[12];
    size_t count;
    uint8_t *bytes;
    noh_pack pack;
    noh_mesh mesh;
    noh_skin skin;
    noh_skeleton skeleton;
    noh_transform pose[3];
    (void)state;
    m->nodes[2].scale[0] = m->nodes[2].scale[1] = m->nodes[2].scale[2] = 0.0f;
    for (int i = 0; i < 12; i++) {
        m->nodes[2].world[i] = m->nodes[5].world[i] = 0.0;
    }
    bytes = skin_pack_of(m, NULL, 1.0f, &count, NULL);
    pack = test_open(bytes, count);
    mesh = test_mesh(&pack, pack.nodes[5].mesh);
    assert_int_equal(noh_pack_skin_at(&pack, mesh.header->skin, &skin, NULL), NOH_OK);
    assert_int_equal(skin.header->joint_count, 1);
    assert_int_equal(noh_pack_skeleton_at(&pack, skin.header->skeleton, &skeleton, NULL, NULL), NOH_OK);
    memcpy(pose, skeleton.bind_pose, sizeof pose);
    pose[2].scale[0] = pose[2].scale[1] = pose[2].scale[2] = 3.0f;
    noh_local_to_model(&skeleton, pose, 3, model_space);
    noh_skin_matrices(&skin, model_space, matrices);
    for (uint32_t v = 0; v < 3; v++) { /* 3 of the joint times 2 of the node, two units up */
        float p[3];
        const float *rest = mesh.positions + 3 * (size_t)v;
        noh_skin_position(&mesh, matrices, NULL, v, p);
        assert_true(fabsf(p[0] - 6.0f * rest[0]) < 1e-5f && fabsf(p[1] - (2.0f + 3.0f * rest[1])) < 1e-5f);
    }
    free(bytes);
    model_free(m);
}

static const struct CMUnitTest tests[] = {
#define X(name, lie, message) cmocka_unit_test(forged_##name),
    LIES(X)
#undef X
        cmocka_unit_test(every_truncation_and_flip_is_refused),
    cmocka_unit_test(repaired_flips_stay_in_bounds),
    cmocka_unit_test(a_mesh_of_two_skins_is_copied),
    cmocka_unit_test(rigid_parts_become_one_mesh),
    cmocka_unit_test(parts_are_kept_where_asked),
    cmocka_unit_test(parts_hidden_at_rest_are_kept),
};

TEST_MAIN(tests, NULL, NULL)
