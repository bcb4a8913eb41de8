/* bench_skin_gpu.c: rows skin/gpu: a hundred instances, each in a pose of its own, in one draw per submesh against a
 * hundred draws; and what joints cost per vertex above the same mesh in its bind pose. Rasterisation is discarded. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/deform.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "bench_job.h"
#include "cli/message.h"

#define SAMPLE_NS 1e7
#define INSTANCES 100u

/* A renderer with palettes of one kind. */
typedef struct skin_set {
    noh_gl_skin *skin;
    void *memory;
    noh_gl_renderer renderer;
    void *variants;
} skin_set;

typedef struct skin_bench {
    bench_job *job;
    noh_mesh mesh;
    noh_gl_mesh gl_mesh;
    noh_gl_texture *pictures; /* no texture is read: nothing is rasterised */
    float *matrices;          /* [INSTANCES][the skin's joint_count][12] */
    uint32_t joint_count;
    skin_set uniform, texture;
} skin_bench;

typedef struct skin_work {
    skin_bench *bench;
    skin_set *set;
    uint32_t instances;
    uint32_t influences; /* 0: all; NOH_NONE: the bind pose */
    int crowd;
} skin_work;

/* ---- poses ---- */

static int largest_skinned_mesh(const noh_pack *pack, noh_mesh *out)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh mesh;
        noh_pack_mesh_at(pack, i, &mesh, NULL);
        if (mesh.header->influence_count && mesh.header->vertex_count > most) {
            most = mesh.header->vertex_count;
            *out = mesh;
        }
    }
    return most != 0;
}

static void pose_instance(const noh_skeleton *skeleton, uint32_t instance, noh_transform *pose)
{
    for (uint32_t i = 0; i < skeleton->joint_count; i++) {
        const uint32_t n = i * 7u + instance * 13u;
        const float turn[3] = { 0.01f * (float)(n % 41u), 0.01f * (float)(n % 37u), -0.01f * (float)(n % 31u) };
        float q[4];
        pose[i] = skeleton->bind_pose[i];
        noh_quat_from_rotation(turn, q);
        noh_quat_mul(pose[i].rotation, q, pose[i].rotation);
    }
}

static int make_matrices(skin_bench *b)
{
    noh_skin skin;
    noh_skeleton skeleton;
    noh_transform *pose;
    float *model;
    noh_pack_skin_at(b->mesh.pack, b->mesh.header->skin, &skin, NULL);
    noh_pack_skeleton_at(b->mesh.pack, skin.header->skeleton, &skeleton, NULL, NULL);
    b->joint_count = skin.header->joint_count;
    pose = calloc(skeleton.joint_count, sizeof *pose);
    model = calloc(skeleton.joint_count, 48);
    b->matrices = calloc((size_t)INSTANCES * b->joint_count, 48);
    for (uint32_t k = 0; pose && model && b->matrices && k < INSTANCES; k++) {
        pose_instance(&skeleton, k, pose);
        noh_local_to_model(&skeleton, pose, skeleton.joint_count, model);
        noh_skin_matrices(&skin, model, b->matrices + 12u * (size_t)k * b->joint_count);
    }
    free(pose);
    free(model);
    return pose && model && b->matrices ? 0 : tool_fail("bench", "out of memory");
}

/* ---- objects ---- */

static int open_renderer(skin_bench *b, skin_set *s, noh_palette_mode mode)
{
    gpu *g = &b->job->g;
    noh_gl_renderer_desc desc;
    noh_error error = { NOH_OK, "", 0, 0 };
    char log[4096] = "";
    memset(&desc, 0, sizeof desc);
    desc.meshes = &b->mesh;
    desc.mesh_count = 1;
    desc.palettes = mode;
    desc.crowds = mode == NOH_PALETTE_TEXTURE;
    desc.fewer_influences = 1;
    s->variants = malloc(noh_gl_renderer_size(&desc));
    if (!s->variants || noh_gl_renderer_create(&(noh_gl_device){ &g->gl, NULL, &g->ledger, log, sizeof log }, &desc,
                                               s->variants, noh_gl_renderer_size(&desc), &s->renderer, &error)) {
        fputs(log, stderr);
        return tool_fail_error("bench", &error);
    }
    return 0;
}

static int open_set(skin_bench *b, skin_set *s, noh_palette_mode mode)
{
    static const float world[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
    const uint32_t instances = INSTANCES;
    gpu *g = &b->job->g;
    noh_gl_skin_desc desc = { &b->mesh, 1, &instances, NOH_PALETTE_AUTO, 0, 0 };
    noh_gl_skin_plan plan;
    noh_error error = { NOH_OK, "", 0, 0 };
    desc.mode = mode;
    if (noh_gl_skin_plan_make(&desc, &g->caps, &plan, &error)) {
        return tool_fail_error("bench", &error);
    }
    s->memory = malloc((size_t)plan.cpu_bytes);
    if (noh_gl_skin_init(s->memory, (size_t)plan.cpu_bytes, &(noh_gl_device){ &g->gl, &g->caps, &g->ledger, NULL, 0 },
                         &desc, &s->skin, &error)) {
        return tool_fail_error("bench", &error);
    }
    for (uint32_t k = 0; k < INSTANCES; k++) {
        noh_gl_skin_set_matrices(s->skin, k, b->matrices + 12u * (size_t)k * b->joint_count);
        if (mode == NOH_PALETTE_TEXTURE) {
            noh_gl_skin_set_place(s->skin, k, world, NULL, NULL);
        }
    }
    noh_gl_skin_update(s->skin);
    return open_renderer(b, s, mode);
}

static void close_set(skin_set *s)
{
    if (s->renderer.gl) {
        noh_gl_renderer_delete(&s->renderer);
    }
    if (s->skin) {
        noh_gl_skin_delete(s->skin);
    }
    free(s->memory);
    free(s->variants);
}

static int skin_open(skin_bench *b)
{
    gpu *g = &b->job->g;
    noh_error error = { NOH_OK, "", 0, 0 };
    int status = make_matrices(b);
    b->pictures = calloc(b->mesh.pack->runs[NOH_CHUNK_TEXTURE].count + 1u, sizeof *b->pictures);
    if (!status && !b->pictures) {
        status = tool_fail("bench", "out of memory");
    }
    if (!status && noh_gl_mesh_create(&g->gl, &g->ledger, &b->mesh, &b->gl_mesh, &error)) {
        status = tool_fail_error("bench", &error);
    }
    if (!status) status = open_set(b, &b->uniform, NOH_PALETTE_UNIFORM);
    if (!status) status = open_set(b, &b->texture, NOH_PALETTE_TEXTURE);
    return status;
}

static void skin_close(skin_bench *b)
{
    close_set(&b->uniform);
    close_set(&b->texture);
    noh_gl_mesh_delete(&b->job->g.gl, &b->job->g.ledger, &b->gl_mesh);
    free(b->pictures);
    free(b->matrices);
}

/* ---- drawing ---- */

static void draw_pass(const skin_work *w, int pass)
{
    static const float world[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
    const skin_bench *b = w->bench;
    for (uint32_t k = 0; k < (w->crowd ? 1u : w->instances); k++) {
        noh_gl_skin_binding skin = noh_gl_skin_binding_of(w->set->skin, k);
        skin.influences = w->influences == NOH_NONE ? 0 : w->influences;
        if (w->crowd) {
            noh_gl_draw_crowd(&w->set->renderer, &b->gl_mesh, NULL, &skin, w->instances, NULL, b->pictures, pass);
        } else {
            noh_gl_draw_mesh(&w->set->renderer, &b->gl_mesh, world, NULL, w->influences == NOH_NONE ? NULL : &skin,
                             NULL, b->pictures, pass);
        }
    }
}

static void run_draws(void *self, uint32_t frame)
{
    static const noh_gl_camera camera = { { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 },
                                          { 0, 0, 4 },
                                          { 0, 0, 1 } };
    const skin_work *w = (const skin_work *)self;
    const noh_gl_api *gl = &w->bench->job->g.gl;
    (void)frame;
    gl->Enable(GL_RASTERIZER_DISCARD);
    noh_gl_draw_begin(&w->set->renderer, &camera);
    draw_pass(w, NOH_DRAW_OPAQUE);
    draw_pass(w, NOH_DRAW_BLENDED);
    noh_gl_draw_end(&w->set->renderer);
    gl->Disable(GL_RASTERIZER_DISCARD);
}

/* ---- rows ---- */

static int measure_crowd(skin_bench *b)
{
    skin_work works[3] = { { b, &b->texture, INSTANCES, 0, 1 },
                           { b, &b->uniform, INSTANCES, 0, 0 },
                           { b, &b->texture, INSTANCES, 0, 0 } };
    static const char *const baselines[3] = { "", "100-draws, uniform blocks", "100-draws, texture" };
    bench_cells cells;
    int status;
    memset(&cells, 0, sizeof cells);
    for (uint32_t i = 0; i < 3; i++) {
        bench_add_cell(&cells, run_draws, &works[i]);
    }
    status = bench_run_cells(&cells, &b->job->gl_clock, b->job->rounds, SAMPLE_NS, "skin/gpu/100-one-draw");
    for (uint32_t i = 1; i < 3 && !status; i++) {
        double one = 1e-3 * bench_median(&cells, 0) / INSTANCES, many = 1e-3 * bench_median(&cells, i) / INSTANCES;
        bench_add_row(&b->job->rows, "skin/gpu/100-one-draw", baselines[i], many, one, "us/body", cells.rounds);
    }
    bench_free_cells(&cells);
    return status;
}

/* Cell 0 is the bind pose; then each number of influences from a uniform block and from a texture. */
static int measure_influences(skin_bench *b)
{
    skin_work works[9];
    uint32_t count = 0, vertices = b->mesh.header->vertex_count;
    bench_cells cells;
    int status;
    memset(&cells, 0, sizeof cells);
    works[count++] = (skin_work){ b, &b->uniform, 1, NOH_NONE, 0 };
    for (uint32_t n = 1; n <= b->mesh.header->influence_count; n *= 2u) {
        works[count++] = (skin_work){ b, &b->uniform, 1, n, 0 };
        works[count++] = (skin_work){ b, &b->texture, 1, n, 0 };
    }
    for (uint32_t i = 0; i < count; i++) {
        bench_add_cell(&cells, run_draws, &works[i]);
    }
    status = bench_run_cells(&cells, &b->job->gl_clock, b->job->rounds, SAMPLE_NS, "skin/gpu/influences");
    for (uint32_t i = 1; i < count && !status; i++) {
        char name[64];
        snprintf(name, sizeof name, "skin/gpu/%u-influences/%s", works[i].influences,
                 works[i].set == &b->uniform ? "uniform" : "texture");
        bench_add_row(&b->job->rows, name, "unskinned", bench_median(&cells, 0) / vertices,
                      bench_median(&cells, i) / vertices, "ns/vertex", cells.rounds);
    }
    bench_free_cells(&cells);
    return status;
}

int bench_skin_gpu(bench_job *job)
{
    skin_bench b;
    int status;
    memset(&b, 0, sizeof b);
    b.job = job;
    if (!largest_skinned_mesh(&job->files[0].pack, &b.mesh)) {
        return 0;
    }
    status = skin_open(&b);
    if (!status) status = measure_crowd(&b);
    if (!status) status = measure_influences(&b);
    skin_close(&b);
    return status;
}
