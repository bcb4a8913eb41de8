#include "gl_skin_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "deform/morph/morph_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

/* ---- packs ---- */

#define KEPT_MAX 24

typedef struct kept_pack {
    char asset[64];
    skin_options options;
    uint8_t *bytes;
    noh_pack pack;
} kept_pack;

static kept_pack kept[KEPT_MAX];
static unsigned kept_count;

static void free_kept(void)
{
    for (unsigned i = 0; i < kept_count; i++) {
        free(kept[i].bytes);
    }
}

const noh_pack *fixture_skinned_pack(const char *asset, const skin_options *options)
{
    const char *path = test_asset(asset);
    convert_options convert;
    convert_failure failure;
    byte_buffer out = { NULL, 0, 0, 0 };
    kept_pack *k;
    for (unsigned i = 0; i < kept_count; i++) {
        if (strcmp(kept[i].asset, asset) == 0 && memcmp(&kept[i].options, options, sizeof *options) == 0) {
            return &kept[i].pack;
        }
    }
    assert_true(kept_count < KEPT_MAX);
    memset(&convert, 0, sizeof convert);
    convert.source.skin = *options;
    convert.only = CONVERT_MESH;
    if (convert_files(&path, 1, &convert, &out, &failure)) {
        fail_msg("%s: %s (%s)", asset, failure.error.what, failure.error.where);
    }
    if (!kept_count) {
        atexit(free_kept);
    }
    k = &kept[kept_count++];
    snprintf(k->asset, sizeof k->asset, "%s", asset);
    k->options = *options;
    k->bytes = test_aligned(out.bytes, out.count);
    k->pack = test_open(k->bytes, out.count);
    buffer_free(&out);
    return &k->pack;
}

/* ---- objects ---- */

static void open_morph(fixture_skin *f)
{
    memset(&f->morph_desc, 0, sizeof f->morph_desc);
    f->morph_desc.meshes = f->meshes;
    f->morph_desc.mesh_count = f->mesh_count;
    f->morph_desc.instance_counts = f->counts;
    f->morph_desc.path = NOH_MORPH_CPU; /* its sums are the reference's on every driver */
    fixture_morph_open(&f->morph, &f->morph_desc, NULL);
}

static void open_skin(fixture_skin *f, noh_palette_mode mode)
{
    gpu *g = fixture_gpu();
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_gl_skin_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.meshes = f->meshes;
    desc.mesh_count = f->mesh_count;
    desc.instance_counts = f->counts;
    desc.mode = mode;
    if (noh_gl_skin_plan_make(&desc, &g->caps, &f->plan, &error)) {
        fail_msg("plan: %s", error.what);
    }
    f->memory = test_aligned(NULL, (size_t)f->plan.cpu_bytes);
    if (noh_gl_skin_init(f->memory, (size_t)f->plan.cpu_bytes,
                         &(noh_gl_device){ &g->gl, &g->caps, &f->ledger, NULL, 0 }, &desc, &f->skin, &error)) {
        fail_msg("init: %s", error.what);
    }
}

void fixture_skin_open(fixture_skin *f, const fixture_skin_desc *desc)
{
    gpu *g = fixture_gpu();
    memset(f, 0, sizeof *f);
    f->pack = fixture_skinned_pack(desc->asset, &desc->options);
    f->mesh_count = f->pack->runs[NOH_CHUNK_MESH].count;
    f->copies = desc->copies ? desc->copies : 1u;
    f->meshes = test_zeros(sizeof *f->meshes * f->mesh_count);
    f->gl_meshes = test_zeros(sizeof *f->gl_meshes * f->mesh_count);
    f->counts = test_zeros(sizeof *f->counts * f->mesh_count);
    for (uint32_t i = 0; i < f->mesh_count; i++) {
        f->meshes[i] = test_mesh(f->pack, i);
        f->counts[i] = f->copies;
        assert_int_equal(noh_gl_mesh_create(&g->gl, &f->ledger, &f->meshes[i], &f->gl_meshes[i], NULL), NOH_OK);
    }
    open_morph(f);
    open_skin(f, desc->mode);
    f->matrices = test_zeros(sizeof *f->matrices * f->plan.instance_count);
}

void fixture_skin_close(fixture_skin *f)
{
    gpu *g = fixture_gpu();
    noh_gl_skin_delete(f->skin);
    for (uint32_t i = 0; i < f->mesh_count; i++) {
        noh_gl_mesh_delete(&g->gl, &f->ledger, &f->gl_meshes[i]);
    }
    for (uint32_t i = 0; i < f->plan.instance_count; i++) {
        free(f->matrices[i]);
    }
    fixture_morph_close(&f->morph);
    free(f->matrices);
    free(f->memory);
    free(f->counts);
    free(f->gl_meshes);
    free(f->meshes);
    assert_true(noh_gl_ledger_bytes(&f->ledger) == 0);
    assert_int_equal(f->ledger.buffers + f->ledger.textures + f->ledger.programs, 0);
}

/* ---- poses ---- */

static void turn_joint(noh_transform *joint, test_random *r)
{
    float turn[3], q[4];
    for (int i = 0; i < 3; i++) {
        turn[i] = test_random_float(r, -0.5f, 0.5f);
        joint->scale[i] *= test_random_float(r, 0.85f, 1.15f);
    }
    noh_quat_from_rotation(turn, q);
    noh_quat_mul(joint->rotation, q, joint->rotation);
}

/* The skin matrices of a mesh in a random pose, to be freed. */
static float *random_matrices(const noh_pack *pack, uint32_t skin_index, test_random *r)
{
    noh_skin skin;
    noh_skeleton skeleton;
    noh_transform *pose;
    float *world, *matrices;
    assert_int_equal(noh_pack_skin_at(pack, skin_index, &skin, NULL), NOH_OK);
    assert_int_equal(noh_pack_skeleton_at(pack, skin.header->skeleton, &skeleton, NULL, NULL), NOH_OK);
    pose = test_zeros(sizeof *pose * skeleton.joint_count);
    world = test_zeros(48u * (size_t)skeleton.joint_count);
    matrices = test_zeros(48u * (size_t)skin.header->joint_count);
    memcpy(pose, skeleton.bind_pose, sizeof *pose * skeleton.joint_count);
    for (uint32_t i = 0; i < skeleton.joint_count; i++) {
        turn_joint(&pose[i], r);
    }
    noh_local_to_model(&skeleton, pose, skeleton.joint_count, world);
    noh_skin_matrices(&skin, world, matrices);
    free(world);
    free(pose);
    return matrices;
}

void fixture_skin_pose(fixture_skin *f, test_random *r)
{
    for (uint32_t i = 0; i < f->plan.instance_count; i++) {
        const noh_mesh *mesh = fixture_mesh_of(&f->morph, i);
        fixture_set_random(&f->morph, i, r);
        free(f->matrices[i]);
        f->matrices[i] = NULL;
        if (mesh->header->skin != NOH_NONE) {
            f->matrices[i] = random_matrices(f->pack, mesh->header->skin, r);
            noh_gl_skin_set_matrices(f->skin, i, f->matrices[i]);
        }
    }
    noh_gl_morph_update(f->morph.morph, NULL);
    noh_gl_skin_update(f->skin);
}

/* ---- results ---- */

noh_vertex *fixture_skin_reference(const fixture_skin *f, uint32_t instance)
{
    const noh_mesh *mesh = fixture_mesh_of(&f->morph, instance);
    noh_vertex *vertices = test_zeros(sizeof *vertices * mesh->header->vertex_count);
    noh_morph_layers layers = test_layers(mesh);
    noh_dual_quaternion *joints = NULL;
    noh_skin skin;
    noh_morph_accumulate_scalar(mesh, f->morph.weights[instance], &layers);
    if (mesh->header->flags & NOH_MESH_DUAL_QUATERNION) {
        assert_int_equal(noh_pack_skin_at(f->pack, mesh->header->skin, &skin, NULL), NOH_OK);
        joints = test_zeros(sizeof *joints * skin.header->joint_count);
        noh_skin_dual_quaternions(f->matrices[instance], skin.header->joint_count, joints);
    }
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        if (joints) {
            noh_skin_vertex_dual(mesh, joints, &layers, v, &vertices[v]);
        } else if (f->matrices[instance]) {
            noh_skin_vertex(mesh, f->matrices[instance], &layers, v, &vertices[v]);
        } else {
            noh_morph_vertex(mesh, &layers, v, &vertices[v]);
        }
    }
    free(joints);
    free(layers.position);
    return vertices;
}

readback_vertex *fixture_skin_read(const fixture_skin *f, uint32_t mesh, uint32_t copy, uint32_t influences,
                                   uint32_t crowd)
{
    uint32_t instance = noh_gl_skin_instance(f->skin, mesh, copy);
    noh_gl_morph_binding morph = noh_gl_morph_binding_of(f->morph.morph, instance);
    noh_gl_skin_binding skin = noh_gl_skin_binding_of(f->skin, instance);
    size_t count = (size_t)f->meshes[mesh].header->vertex_count * (crowd ? crowd : 1u);
    readback_vertex *out = test_zeros(sizeof *out * count);
    readback back;
    skin.influences = influences;
    assert_int_equal(readback_open(&back, fixture_gpu(), morph.is_uint), 0);
    assert_int_equal(readback_skinned(&back, &f->gl_meshes[mesh], &morph, &skin, crowd, out), 0);
    readback_close(&back);
    return out;
}

static double distance(const float a[3], const float b[3])
{
    double square = 0.0;
    for (int i = 0; i < 3; i++) {
        square += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]);
    }
    return sqrt(square);
}

/* A NaN counts as infinitely far. */
static double farther(double most, double d)
{
    return d <= most ? most : isnan(d) ? HUGE_VAL : d;
}

fixture_error fixture_skin_compare(const readback_vertex *got, const noh_vertex *expected, uint32_t count)
{
    fixture_error e = { 0.0, 0.0, 0.0, 0.0, 0 };
    float low[3], high[3];
    for (uint32_t v = 0; v < count; v++) {
        for (int i = 0; i < 3; i++) {
            float x = expected[v].position[i];
            low[i] = v && low[i] < x ? low[i] : x;
            high[i] = v && high[i] > x ? high[i] : x;
        }
        e.position = farther(e.position, distance(got[v].position, expected[v].position));
        e.normal = farther(e.normal, distance(got[v].normal, expected[v].normal));
        if (expected[v].tangent[3] != 0.0f) { /* the mesh has tangents */
            e.tangent = farther(e.tangent, distance(got[v].tangent, expected[v].tangent));
            e.handedness += got[v].tangent[3] != expected[v].tangent[3];
        }
    }
    e.box = distance(low, high);
    return e;
}

void fixture_expect_close(const fixture_error *e, const char *what)
{
    if (!(e->box > 0.0 && e->position <= 2e-6 * e->box && e->normal <= 2e-5 && e->tangent <= 2e-5 && !e->handedness)) {
        fail_msg("%s: positions are off by %g of a box of %g, normals by %g, tangents by %g, %u hands differ", what,
                 e->position / e->box, e->box, e->normal, e->tangent, e->handedness);
    }
}
