/* own_renderer.c: a stage without a GPU, drawn by a renderer of the game's own from the list of draws. It uses nothing
 * of noh's renderer: the same list serves Vulkan, Metal or Direct3D, whose calls would stand where GL's do. Vertices are
 * morphed and skinned on the CPU here; a renderer with skinning of its own uploads matrices and weights instead.
 *
 *   own_renderer PACK [-o OUT.png]
 *
 * Six figures walk for a second. Prints how much was drawn, and saves the last frame. Links EGL. */
#include <string.h>

#include "noh/deform.h"
#include "noh/noh.h"
#include "plain.h"
#include "start.h"
#include "target.h"

#define ACTORS 6u
#define WIDTH 960
#define HEIGHT 540
#define DRAWS_MAX 256u

static noh_gl gl; /* its table of GL functions; nothing else of it is used */
static noh_pack pack;
static noh_stage *stage;
static noh_vertex *vertices;
static void *layers_memory;
static uint32_t draw_count, triangle_count;

/* Deform a mesh of an actor, and upload its vertices. */
static void upload(const noh_mesh *mesh, const noh_actor_mesh *of, const float *matrices)
{
    noh_morph_layers layers;
    (void)noh_morph_layers_init(layers_memory, noh_morph_layers_size(mesh), mesh, &layers, NULL);
    noh_morph_accumulate(mesh, of->weights, &layers);
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        if (of->joint_count) {
            noh_skin_vertex(mesh, matrices, &layers, v, &vertices[v]);
        } else {
            noh_morph_vertex(mesh, &layers, v, &vertices[v]);
        }
    }
    gl.api.BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(mesh->header->vertex_count * sizeof *vertices), vertices,
                      GL_STREAM_DRAW);
}

static void draw_one(const noh_draw *d, const noh_mesh *mesh, noh_actor actor)
{
    static float matrices[12 * 256];
    const noh_submesh *s = d->submesh;
    const size_t bytes = mesh->header->index_bytes;
    noh_actor_mesh of;
    if (noh_actor_mesh_at(stage, actor, d->index, &of, matrices, NULL)) return;
    upload(mesh, &of, matrices); /* one that remembers what it uploaded last saves this for the next submesh */
    gl.api.BufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(s->index_count * bytes),
                      (const uint8_t *)mesh->indices + s->first_index * bytes, GL_STREAM_DRAW);
    gl.api.Uniform4fv(plain_at(&gl.api, "u_world"), 3, of.world);
    gl.api.DrawElements(GL_TRIANGLES, (GLsizei)s->index_count, bytes == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT, NULL);
    draw_count++;
    triangle_count += s->index_count / 3u;
}

/* What blends comes after what does not, in the order of the list: from far to near. */
static void draw_pass(int blended)
{
    static noh_draw draws[DRAWS_MAX];
    const uint32_t all = noh_stage_list_draws(stage, 0, blended, draws, DRAWS_MAX);
    (blended ? gl.api.Enable : gl.api.Disable)(GL_BLEND);
    gl.api.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    gl.api.DepthMask((GLboolean)!blended);
    for (uint32_t i = 0; i < all && i < DRAWS_MAX; i++) {
        const noh_draw *d = &draws[i];
        noh_mesh mesh;
        (void)noh_pack_mesh_at(&pack, d->mesh, &mesh, NULL);
        mesh = noh_mesh_at_lod(&mesh, d->level);
        gl.api.Uniform4fv(plain_at(&gl.api, "u_color"), 1, d->material->base_color);
        gl.api.Uniform3f(plain_at(&gl.api, "u_pixels"), d->from, d->to, d->alpha_cutoff);
        gl.api.FrontFace(d->mirrored ? GL_CW : GL_CCW);
        (d->material->flags & NOH_MATERIAL_DOUBLE_SIDED ? gl.api.Disable : gl.api.Enable)(GL_CULL_FACE);
        for (uint32_t a = 0; a < d->actor_count; a++)
            draw_one(d, &mesh, noh_stage_actor_at(stage, d->first_actor + d->actors[a]));
    }
}

static int open_stage(void)
{
    const noh_kind_desc kind = {
        .name = "figures", .mesh = &pack, .actor_count = ACTORS, .root_axes = NOH_ROOT_GROUND
    };
    const noh_stage_desc desc = { .kinds = &kind, .kind_count = 1, .height_px = HEIGHT, .sort_blended = 1 };
    static noh_stage_plan plan;
    size_t most = 1, layers = 1; /* of all meshes */
    noh_error e = { NOH_ERR_MEMORY, "malloc", 0, 0 };
    noh_mesh mesh;
    void *memory;
    for (uint32_t m = 0; noh_pack_mesh_at(&pack, m, &mesh, NULL) == NOH_OK; m++) {
        if (mesh.header->vertex_count > most) most = mesh.header->vertex_count;
        if (noh_morph_layers_size(&mesh) > layers) layers = noh_morph_layers_size(&mesh);
    }
    vertices = malloc(most * sizeof *vertices);
    layers_memory = malloc(layers);
    if (noh_stage_plan_make(&desc, NULL, &plan, &e)) return start_fail(&gl, "plan", &e);
    memory = malloc((size_t)plan.cpu_bytes);
    if (!memory || !vertices || !layers_memory ||
        noh_stage_init(memory, (size_t)plan.cpu_bytes, NULL, &desc, &plan, &stage, &e))
        return start_fail(&gl, "stage", &e);
    return 0;
}

static int enter(void)
{
    noh_error e;
    for (uint32_t i = 0; i < ACTORS; i++) {
        const noh_place place = { { 0.9f * (float)i - 2.2f, 0.0f, -0.8f * (float)(i % 2u) }, { 0 }, 1.0f };
        const noh_play play = { .start_ticks = 9000 * (int64_t)i };
        noh_actor actor;
        if (noh_stage_spawn(stage, 0, &place, &actor, &e)) return start_fail(&gl, "actor", &e);
        (void)noh_actor_play(stage, actor, 0, "walk", &play, NULL); /* if the pack has it */
    }
    return 0;
}

int main(int argc, char **argv)
{
    static const float middle[3] = { 0.0f, 0.8f, 0.5f };
    const char *out = argc > 3 && !strcmp(argv[2], "-o") ? argv[3] : NULL;
    noh_stage_view view;
    target picture;
    noh_error e;
    if (argc < 2 || start_pack(&gl, argv[1], &pack) || start_gl(&gl)) return 2;
    if (open_stage() || enter() || !plain_make(&gl.api)) return 1;
    target_make(&gl.api, WIDTH, HEIGHT, 0, &picture);
    noh_view_orbit(&view, middle, 0.5f, 0.2f, 5.0f, WIDTH, HEIGHT);
    for (int f = 0; f < 60; f++) {
        if (noh_stage_frame(stage, NOH_TICKS_PER_SECOND / 60u, &view, NULL, NULL, &e))
            return start_fail(&gl, "frame", &e);
    }
    target_clear(&gl.api, &picture);
    gl.api.Enable(GL_DEPTH_TEST);
    gl.api.UniformMatrix4fv(plain_at(&gl.api, "u_view_projection"), 1, GL_FALSE, view.view_projection);
    gl.api.Uniform3fv(plain_at(&gl.api, "u_light"), 1, view.light);
    draw_pass(0);
    draw_pass(1);
    printf("%u draws, %u triangles\n", draw_count, triangle_count);
    return gl.api.GetError() != GL_NO_ERROR || (out && target_save(&gl.api, &picture, out));
}
