/* cmd_dump.c: the deformed mesh as an OBJ file: by default the CPU reference, which needs no GL; with --path the
 * vertices of the GPU's vertex shader. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/byte_buffer.h"
#include "convert/base/nearest.h"
#include "draw/figure.h"
#include "dump_graph.h"
#include "gpu/gpu_args.h"
#include "cli/message.h"
#include "gpu/readback.h"
#include "cli/options.h"
#include "cli/verbs.h"

typedef struct dump_args {
    const char *pack, *output, *anim, *path, *accumulate, *driver, *graph;
    double time_s, lod;
    option_list weights, clips;
    figure_desc figure;
} dump_args;

/* A node that mirrors turns triangles and cofactors over. */
static int mirrors(const float w[12])
{
    return ((double)w[0] * w[5] - (double)w[1] * w[4]) * w[10] + ((double)w[1] * w[6] - (double)w[2] * w[5]) * w[8] +
               ((double)w[2] * w[4] - (double)w[0] * w[6]) * w[9] <
           0.0;
}

/* A normal by the inverse transpose, which is the cofactor matrix up to a factor; unlike the inverse it exists for
 * every matrix. Transforming it by the matrix itself would tilt it under unequal scales. */
static void transform_normal(const float w[12], const float n[3], double out[3])
{
    const double side = mirrors(w) ? -1.0 : 1.0;
    double length = 0.0;
    for (int i = 0; i < 3; i++) {
        const float *a = w + 4 * ((i + 1) % 3), *b = w + 4 * ((i + 2) % 3);
        out[i] = ((double)a[1] * b[2] - (double)a[2] * b[1]) * n[0] +
                 ((double)a[2] * b[0] - (double)a[0] * b[2]) * n[1] +
                 ((double)a[0] * b[1] - (double)a[1] * b[0]) * n[2];
        length += out[i] * out[i];
    }
    length = side * (length > 0.0 ? sqrt(length) : 1.0);
    for (int i = 0; i < 3; i++) {
        out[i] /= length;
    }
}

static void dump_vertex(byte_buffer *out, const noh_vertex *v, const float world[12])
{
    double n[3];
    buffer_print(out, "v");
    for (int r = 0; r < 3; r++) {
        const float *row = world + 4 * r;
        buffer_print(out, " %.9g",
                     (double)row[0] * v->position[0] + (double)row[1] * v->position[1] +
                         (double)row[2] * v->position[2] + (double)row[3]);
    }
    buffer_print(out, " %.4f %.4f %.4f\n", (double)v->color[0], (double)v->color[1], (double)v->color[2]);
    transform_normal(world, v->normal, n);
    buffer_print(out, "vn %.6f %.6f %.6f\nvt %.7g %.7g\n", n[0], n[1], n[2], (double)v->uv[0], 1.0 - (double)v->uv[1]);
}

static void dump_faces(byte_buffer *out, const noh_mesh *mesh, uint32_t first, int turned)
{
    for (uint32_t s = 0; s < mesh->header->submesh_count; s++) {
        const noh_submesh *sub = &mesh->submeshes[s];
        if (sub->material != NOH_NONE) {
            buffer_print(out, "usemtl %s\n", noh_pack_string(mesh->pack, mesh->pack->materials[sub->material].name));
        }
        for (uint32_t i = 0; i < sub->index_count; i += 3) {
            buffer_print(out, "f");
            for (uint32_t k = 0; k < 3; k++) {
                uint32_t v = first + noh_mesh_index(mesh, sub->first_index + i + (turned ? (3 - k) % 3 : k));
                buffer_print(out, " %u/%u/%u", v, v, v);
            }
            buffer_print(out, "\n");
        }
    }
}

static void dump_mesh(byte_buffer *out, const noh_mesh *mesh, const noh_vertex *vertices, const float world[12],
                      uint32_t *first)
{
    buffer_print(out, "o %s\n", mesh->name);
    if (mesh->header->level) {
        buffer_print(out, "# LOD level %u of 0 to %u\n", mesh->header->level, mesh->header->level_count - 1u);
    }
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        dump_vertex(out, &vertices[v], world);
    }
    dump_faces(out, mesh, *first, mirrors(world));
    *first += mesh->header->vertex_count;
}

/* Positions and normals as the vertex shader leaves them. */
static int fetch_mesh(const figure *f, readback *r, uint32_t kind, uint32_t index, noh_vertex *vertices)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_stage_drawn drawn;
    readback_vertex *read;
    int status;
    if (noh_actor_on_gl(f->stage, f->actors[kind], index, &drawn, &error)) {
        return tool_fail_error(f->desc.file->path, &error);
    }
    read = malloc(sizeof *read * (drawn.mesh->mesh.header->vertex_count + 1u));
    status = read ? readback_skinned(r, drawn.mesh, drawn.is_morphed ? &drawn.morph : NULL,
                                     drawn.is_skinned ? &drawn.skin : NULL, 0, read)
                  : tool_fail(f->desc.file->path, "out of memory");
    for (uint32_t v = 0; v < drawn.mesh->mesh.header->vertex_count && !status; v++) {
        memcpy(vertices[v].position, read[v].position, sizeof vertices[v].position);
        memcpy(vertices[v].normal, read[v].normal, sizeof vertices[v].normal);
    }
    free(read);
    return status;
}

/* r NULL: the vertices of the CPU. */
static int dump_meshes(byte_buffer *out, const figure *f, readback *r)
{
    uint32_t first = 1;
    int status = 0;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        for (uint32_t i = 0; i < f->plan.kinds[k].mesh_count && !status; i++) {
            noh_mesh mesh;
            noh_actor_mesh shown;
            noh_vertex *vertices = figure_deform(f, k, i, f->desc.level, &mesh, &shown);
            status = !vertices ? EXIT_FAILED : r ? fetch_mesh(f, r, k, i, vertices) : 0;
            if (!status) dump_mesh(out, &mesh, vertices, shown.world, &first);
            free(vertices);
        }
    }
    return status;
}

/* Actors that no view sees are not sent to the GPU. */
static int look_at_all(figure *f)
{
    const bounds box = figure_bounds(f, FRAME_FULL);
    const orbit at = orbit_fit(&box, 1.0, 0.0);
    noh_gl_camera camera;
    orbit_camera(&at, &camera);
    return figure_look(f, &camera, 512);
}

static int dump_by_gpu(byte_buffer *out, figure *f)
{
    noh_gl_morph_plan plan;
    readback r;
    int status = look_at_all(f);
    (void)noh_stage_morph_plan(&f->stage_desc, &f->g->caps, &f->plan, &plan, NULL);
    if (!status) status = readback_open(&r, f->g, plan.layer_format == GL_RGBA32UI);
    if (!status) {
        status = dump_meshes(out, f, &r);
        readback_close(&r);
    }
    return status;
}

static int dump_figure(byte_buffer *out, const dump_args *a, gpu *g)
{
    figure f;
    int status = figure_open(&f, &a->figure, g);
    if (status) {
        return status;
    }
    status = figure_play_options(&f, &a->clips, a->time_s);
    if (!status) status = figure_hold_options(&f, &a->weights);
    if (!status) status = figure_pose(&f);
    if (!status) {
        buffer_print(out, "# baked by noh: positions in world space, vertex colours linear\n");
        status = g ? dump_by_gpu(out, &f) : dump_meshes(out, &f, NULL);
    }
    figure_close(&f);
    return status;
}

static int write_out(const dump_args *a, byte_buffer *out)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    if (out->failed || noh_file_write(a->output, out->bytes, out->count, &error)) {
        return tool_fail(a->output, "cannot write: %s", out->failed ? "out of memory" : error.what);
    }
    return 0;
}

static int dump_pack(const pack_file *file, dump_args *a)
{
    byte_buffer out = { NULL, 0, 0, 0 };
    const int by_gpu = a->path && a->figure.path != NOH_MORPH_CPU;
    const pack_file *clips;
    pack_file anim;
    gpu g;
    int status = figure_open_clips(&anim, a->anim, file, &clips);
    a->figure.file = file;
    a->figure.clips = a->clips.count ? clips : NULL;
    a->figure.track_count = (uint32_t)a->clips.count;
    a->figure.held_float_count = (uint32_t)a->weights.count;
    if (!status && by_gpu) status = gpu_open_drawing(&g, a->driver);
    if (!status) {
        status = dump_figure(&out, a, by_gpu ? &g : NULL);
        if (by_gpu) gpu_close(&g);
    }
    if (!status) status = write_out(a, &out);
    figure_close_clips(&anim, clips);
    buffer_free(&out);
    return status;
}

static int fail_graph(const pack_file *file, const char *name)
{
    const char *names[64], *near;
    size_t count = 0;
    for (; count < file->pack.runs[NOH_CHUNK_GRAPH].count && count < sizeof names / sizeof names[0]; count++) {
        names[count] = noh_pack_chunk_name(&file->pack, file->pack.runs[NOH_CHUNK_GRAPH].first + (uint32_t)count);
    }
    if (!count) return tool_fail(file->path, "has no animation graph");
    near = nearest_name(name, names, count);
    return near ? tool_fail(file->path, "no graph '%s'; did you mean '%s'?", name, near)
                : tool_fail(file->path, "no graph '%s'; it has %zu", name, count);
}

/* One graph, or all of them. */
static int dump_graphs(const pack_file *file, const dump_args *a)
{
    byte_buffer out = { NULL, 0, 0, 0 };
    const int all = strcmp(a->graph, "all") == 0;
    const uint32_t found = all ? 0 : noh_pack_graph_find(&file->pack, a->graph);
    int status = found < file->pack.runs[NOH_CHUNK_GRAPH].count ? 0 : fail_graph(file, a->graph);
    for (uint32_t i = found; !status && i < (all ? file->pack.runs[NOH_CHUNK_GRAPH].count : found + 1u); i++) {
        noh_pack_graph g;
        noh_error error = { NOH_OK, "", 0, 0 };
        status = noh_pack_graph_at(&file->pack, i, &g, &error) ? tool_fail_error(file->path, &error) : 0;
        if (!status) dump_graph(&out, &g);
    }
    if (!status) status = write_out(a, &out);
    buffer_free(&out);
    return status;
}

static int check_args(dump_args *a)
{
    int status = parse_path(a->path, &a->figure.path);
    if (!status) status = parse_accumulate(a->accumulate, &a->figure.accumulate);
    if (!status) status = parse_level(a->lod, &a->figure.level);
    return status;
}

static int run(void *args)
{
    dump_args *a = args;
    pack_file file;
    int status = check_args(a);
    if (!status) status = pack_file_open(&file, a->pack);
    if (status) {
        return status;
    }
    status = a->graph ? dump_graphs(&file, a) : dump_pack(&file, a);
    pack_file_close(&file);
    return status;
}

static dump_args arguments;

static const option options[] = {
    { .name = "-o",
      .kind = OPTION_OUTPUT,
      .at = offsetof(dump_args, output),
      .required = 1,
      .value = "OUT.obj",
      .what = "the mesh, with positions in world space and linear vertex colours; or the text of --graph",
      .example = "face.obj" },
    { .name = "--graph",
      .kind = OPTION_TEXT,
      .at = offsetof(dump_args, graph),
      .value = "NAME|all",
      .what = "write an animation graph instead, as the text that noh build --graph reads",
      .example = "hero",
      .excludes = "--weight --clip --anim --lod --path" },
    OPTION_WEIGHT(dump_args, weights, .needs = NULL),
    OPTION_WEIGHT_RULES(dump_args, figure.weight_rules),
    OPTION_CLIP(dump_args, clips, .needs = NULL),
    OPTION_TIME(dump_args, time_s, .needs = "--clip"),
    OPTION_ANIM(dump_args, anim, .needs = NULL),
    OPTION_LOD(dump_args, lod, .needs = NULL),
    OPTION_PATH(dump_args, path, .initial = NULL),
    OPTION_ACCUMULATE(dump_args, accumulate, .needs = "--path", .excludes = "--path=cpu"),
    OPTION_DRIVER(dump_args, driver, .needs = "--path", .excludes = "--path=cpu"),
};

const verb verb_dump = {
    .name = "dump",
    .files = "PACK|MODEL",
    .what = "write the deformed mesh, as drawn, as an OBJ file, or an animation graph as text",
    .more =
        "Without --path, and with --path cpu, the CPU computes the mesh and no GL is needed. With any other path the vertices come from the vertex shader.",
    .example =
        "face.noh -o face.obj --weight smile=1\nbody.noh -o walk.obj --clip walk --time 0.5 --path mrt\nbody.noh -o hero.graph --graph hero",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(dump_args, pack),
    .args = &arguments,
    .run = run,
};
