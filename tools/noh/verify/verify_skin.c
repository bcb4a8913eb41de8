#include "verify_skin.h"

#include <math.h>
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
#include "noh/low_motion.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "cli/message.h"
#include "gpu/readback.h"

typedef struct job {
    gpu *g;
    const pack_file *file;
    const noh_mesh *meshes;
    gpu_morph morph;
    noh_gl_skin *skin;
    readback back;
    uint64_t *state;
    verify_skin *out;
} job;

/* The cases in which a mesh is compared. */
typedef struct mesh_job {
    job *j;
    const noh_mesh *mesh;
    const noh_gl_mesh *gl_mesh;
    uint32_t index;
    noh_skin skin;
    noh_skeleton skeleton;
    noh_transform *pose;
    float *model, *matrices, *weights, *positions, *normals;
    noh_dual_quaternion *dual;
    void *layers;
    readback_vertex *got;
} mesh_job;

/* xorshift64*: 0..1. */
static float random_unit(uint64_t *state)
{
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    return (float)((double)((*state * 2685821657736338717ull) >> 40) / 16777216.0);
}

/* ---- one pose ---- */

static void reference(mesh_job *m, const noh_morph_layers *layers)
{
    uint32_t count = m->mesh->header->vertex_count;
    if (m->mesh->header->flags & NOH_MESH_DUAL_QUATERNION) {
        noh_skin_dual_quaternions(m->matrices, m->skin.header->joint_count, m->dual);
        noh_skin_vertices_dual(m->mesh, m->dual, layers, 0, count, m->positions, m->normals, NULL);
    } else {
        noh_skin_vertices(m->mesh, m->matrices, layers, 0, count, m->positions, m->normals, NULL);
    }
}

/* The largest number that the skinning of this pose rounds: the diagonal of the box, or an absolute coordinate. */
static double magnitude(const mesh_job *m)
{
    const noh_mesh_header *h = m->mesh->header;
    double square = 0.0, largest = 0.0;
    for (int i = 0; i < 3; i++) {
        square += pow((double)h->bounds_max[i] - (double)h->bounds_min[i], 2.0);
        largest = fmax(largest, fmax(fabs((double)h->bounds_max[i]), fabs((double)h->bounds_min[i])));
    }
    for (size_t i = 0; i < 3u * (size_t)h->vertex_count; i++) {
        largest = fmax(largest, fabs((double)m->positions[i]));
    }
    return fmax(largest, sqrt(square));
}

static void compare(mesh_job *m)
{
    const noh_mesh_header *h = m->mesh->header;
    verify_skin *out = m->j->out;
    double square = 0.0, error = 0.0;
    const double bound = out->bound_scale * 1e6 * VERIFY_SKIN_SHARE * (double)h->world_scale * magnitude(m);
    for (size_t v = 0; v < h->vertex_count; v++) {
        square = 0.0;
        for (size_t c = 0; c < 3; c++) {
            square += pow((double)m->got[v].position[c] - (double)m->positions[3 * v + c], 2.0);
            out->normal_error = fmax(out->normal_error,
                                     fabs((double)m->got[v].normal[c] - (double)m->normals[3 * v + c]));
        }
        error = fmax(error, isnan(square) ? HUGE_VAL : 1e6 * sqrt(square));
    }
    if (error * out->bound_um >= out->error_um * bound) {
        out->error_um = error;
        out->bound_um = bound;
    }
    out->values += 3u * (uint64_t)h->vertex_count;
}

/* Draw the pose that m->pose holds, with random weights. */
static int check_pose(mesh_job *m)
{
    job *j = m->j;
    uint32_t instance = noh_gl_skin_instance(j->skin, m->index, 0);
    noh_gl_morph_binding morph = noh_gl_morph_binding_of(j->morph.morph, instance);
    noh_gl_skin_binding skin = noh_gl_skin_binding_of(j->skin, instance);
    noh_morph_layers layers;
    int status;
    for (uint32_t i = 0; i < m->mesh->header->target_count; i++) {
        float skip = random_unit(j->state);
        m->weights[i] = random_unit(j->state) * 3.0f - 1.0f;
        m->weights[i] = skip < 0.6f ? 0.0f : m->weights[i];
    }
    noh_local_to_model(&m->skeleton, m->pose, m->skeleton.joint_count, m->model);
    noh_skin_matrices(&m->skin, m->model, m->matrices);
    noh_mesh_move_far_joints(m->mesh, m->weights, m->matrices);
    noh_morph_layers_init(m->layers, noh_morph_layers_size(m->mesh) + 16u, m->mesh, &layers, NULL);
    noh_morph_accumulate_scalar(m->mesh, m->weights, &layers);
    reference(m, &layers);
    noh_gl_morph_set_weights(j->morph.morph, instance, m->weights, NULL);
    noh_gl_morph_update(j->morph.morph, NULL);
    noh_gl_skin_set_matrices(j->skin, instance, m->matrices);
    noh_gl_skin_update(j->skin);
    status = readback_skinned(&j->back, m->gl_mesh, &morph, &skin, 0, m->got);
    if (!status) {
        compare(m);
    }
    return status;
}

/* ---- all poses ---- */

static int check_random_poses(mesh_job *m)
{
    int status = 0;
    for (uint32_t n = 0; n < VERIFY_SKIN_TIMES && !status; n++) {
        for (uint32_t i = 0; i < m->skeleton.joint_count; i++) {
            float turn[3], q[4];
            for (int c = 0; c < 3; c++) {
                turn[c] = random_unit(m->j->state) - 0.5f;
            }
            noh_quat_from_rotation(turn, q);
            m->pose[i] = m->skeleton.bind_pose[i];
            noh_quat_mul(m->pose[i].rotation, q, m->pose[i].rotation);
        }
        status = check_pose(m);
    }
    return status;
}

static int check_times(mesh_job *m, noh_clip_cache *cache, const noh_clip *clip)
{
    noh_clip_info info;
    int status = 0;
    noh_clip_info_of(clip, &info);
    for (uint32_t n = 0; n < VERIFY_SKIN_TIMES && !status; n++) {
        int64_t ticks = (int64_t)((double)random_unit(m->j->state) * (double)info.duration_ticks);
        noh_clip_sample(cache, 0, ticks, m->skeleton.joint_count, m->pose, NULL);
        status = check_pose(m);
    }
    return status;
}

static int check_clip(mesh_job *m, const noh_pack_clip *chosen)
{
    noh_clip_desc desc = { .bytes = chosen->bytes,
                           .byte_count = chosen->header->clip_bytes,
                           .bind = m->skeleton.bind_pose,
                           .joint_count = m->skeleton.joint_count };
    size_t bytes = noh_clip_size(&desc, NULL), cache_bytes;
    noh_clip_cache_desc cache_desc = { NULL, 1, 2 };
    const noh_clip *clips[1];
    noh_clip *clip = NULL;
    noh_clip_cache *cache = NULL;
    noh_error error = { NOH_OK, "", 0, 0 };
    void *memory = malloc(bytes), *cache_memory = NULL;
    int status = !memory || noh_clip_init(memory, bytes, &desc, &clip, &error) != NOH_OK;
    if (!status) {
        clips[0] = clip;
        cache_desc.clips = clips;
        cache_bytes = noh_clip_cache_size(&cache_desc, &error);
        cache_memory = malloc(cache_bytes);
        status = !cache_memory || noh_clip_cache_init(cache_memory, cache_bytes, &cache_desc, &cache, &error);
    }
    status = status ? tool_fail_error(m->j->file->path, &error) : check_times(m, cache, clip);
    free(cache_memory);
    free(memory);
    return status;
}

static int check_clips(mesh_job *m)
{
    const noh_pack *pack = &m->j->file->pack;
    uint32_t checked = 0;
    int status = 0;
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_CLIP].count && !status; i++) {
        noh_pack_clip chosen;
        noh_skeleton skeleton;
        uint32_t index;
        noh_pack_clip_at(pack, i, &chosen, NULL);
        if (!noh_pack_bind_clip(pack, &chosen, &skeleton, &index, NULL) && index == m->skin.header->skeleton) {
            status = check_clip(m, &chosen);
            checked++;
        }
    }
    return status || checked ? status : check_random_poses(m);
}

static void close_mesh(mesh_job *m)
{
    free(m->pose);
    free(m->model);
    free(m->matrices);
    free(m->weights);
    free(m->positions);
    free(m->normals);
    free(m->dual);
    free(m->layers);
    free(m->got);
}

static int check_mesh(job *j, uint32_t index, const noh_gl_mesh *gl_mesh)
{
    mesh_job m;
    size_t vertices, joints;
    int status;
    memset(&m, 0, sizeof m);
    m.j = j;
    m.mesh = &j->meshes[index];
    m.gl_mesh = gl_mesh;
    m.index = index;
    noh_pack_skin_at(&j->file->pack, m.mesh->header->skin, &m.skin, NULL);
    noh_pack_skeleton_at(&j->file->pack, m.skin.header->skeleton, &m.skeleton, NULL, NULL);
    vertices = m.mesh->header->vertex_count;
    joints = m.skin.header->joint_count;
    m.pose = calloc(m.skeleton.joint_count, sizeof *m.pose);
    m.model = calloc(m.skeleton.joint_count, 48);
    m.matrices = calloc(joints, 48);
    m.dual = calloc(joints, sizeof *m.dual);
    m.weights = calloc(m.mesh->header->target_count + 1u, sizeof *m.weights);
    m.positions = calloc(vertices, 12);
    m.normals = calloc(vertices, 12);
    m.got = calloc(vertices, sizeof *m.got);
    m.layers = malloc(noh_morph_layers_size(m.mesh) + 16u);
    status = m.pose && m.model && m.matrices && m.dual && m.weights && m.positions && m.normals && m.got && m.layers
                 ? check_clips(&m)
                 : tool_fail(j->file->path, "out of memory");
    close_mesh(&m);
    return status;
}

/* ---- the whole pack ---- */

int verify_skin_wanted(const noh_mesh *meshes, const noh_pack *pack)
{
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_MESH].count; i++) {
        if (meshes[i].header->influence_count) {
            return 1;
        }
    }
    return 0;
}

static int check_meshes(job *j, const noh_gl_mesh *gl_meshes)
{
    noh_gl_morph_desc desc;
    int status;
    memset(&desc, 0, sizeof desc);
    desc.meshes = j->meshes;
    desc.mesh_count = j->file->pack.runs[NOH_CHUNK_MESH].count;
    desc.path = NOH_MORPH_CPU; /* its sums are the reference's on every driver: what differs is the skin */
    status = gpu_morph_open(&j->morph, j->g, &desc, j->file->path);
    if (status) {
        return status;
    }
    status = readback_open(&j->back, j->g, 0);
    for (uint32_t i = 0; i < j->file->pack.runs[NOH_CHUNK_MESH].count && !status; i++) {
        if (j->meshes[i].header->influence_count) {
            status = check_mesh(j, i, &gl_meshes[i]);
        }
    }
    readback_close(&j->back);
    gpu_morph_close(&j->morph);
    return status;
}

int verify_skin_run(gpu *g, const pack_file *file, const noh_mesh *meshes, const noh_gl_mesh *gl_meshes,
                    noh_palette_mode mode, uint64_t *state, verify_skin *out)
{
    noh_gl_skin_desc desc = { meshes, file->pack.runs[NOH_CHUNK_MESH].count, NULL, NOH_PALETTE_AUTO, 0, 0 };
    noh_gl_skin_plan plan;
    noh_error error = { NOH_OK, "", 0, 0 };
    uint64_t before = noh_gl_ledger_bytes(&g->ledger);
    job j;
    const double bound_scale = out->bound_scale;
    void *memory;
    int status;
    memset(out, 0, sizeof *out);
    out->bound_scale = bound_scale;
    memset(&j, 0, sizeof j);
    j.g = g;
    j.file = file;
    j.meshes = meshes;
    j.state = state;
    j.out = out;
    desc.mode = mode;
    if (noh_gl_skin_plan_make(&desc, &g->caps, &plan, &error)) {
        return tool_fail_error(file->path, &error);
    }
    memory = malloc((size_t)plan.cpu_bytes);
    if (!memory) {
        return tool_fail(file->path, "out of memory");
    }
    if (noh_gl_skin_init(memory, (size_t)plan.cpu_bytes, &(noh_gl_device){ &g->gl, &g->caps, &g->ledger, NULL, 0 },
                         &desc, &j.skin, &error)) {
        free(memory);
        return tool_fail_error(file->path, &error);
    }
    out->cpu_predicted = plan.cpu_bytes;
    out->gpu_predicted = plan.gpu_bytes;
    out->gpu_used = noh_gl_ledger_bytes(&g->ledger) - before;
    status = check_meshes(&j, gl_meshes);
    noh_gl_skin_delete(j.skin);
    free(memory);
    return status;
}
