/* cmd_dump.c: the deformed mesh as an OBJ file: by default the CPU reference, which needs no GL; with --path the
 * vertices of the GPU's vertex shader. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/byte_buffer.h"
#include "convert/base/nearest.h"
#include "draw/load.h"
#include "dump_graph.h"
#include "gpu/gpu_args.h"
#include "cli/message.h"
#include "gpu/readback.h"
#include "cli/options.h"
#include "cli/verbs.h"

typedef struct dump_args {
    const char *pack, *output, *anim, *path, *accumulate, *driver, *graph;
    double time_s, lod;
    uint32_t level;
    option_list weights, clips;
    load_options load;
} dump_args;

static void print_to(byte_buffer *out, const char *format, ...)
{
    char line[512];
    va_list args;
    int count;
    va_start(args, format);
    count = vsnprintf(line, sizeof line, format, args);
    va_end(args);
    buffer_append(out, line, count < (int)sizeof line ? (size_t)count : sizeof line - 1);
}

/* A normal by the inverse transpose, which is the cofactor matrix up to a factor; unlike the inverse it exists for
 * every matrix. Transforming it by the matrix itself would tilt it under unequal scales. */
static void transform_normal(const float w[12], const float n[3], double out[3])
{
    double length = 0.0;
    for (int i = 0; i < 3; i++) {
        const float *a = w + 4 * ((i + 1) % 3), *b = w + 4 * ((i + 2) % 3);
        out[i] = ((double)a[1] * b[2] - (double)a[2] * b[1]) * n[0] +
                 ((double)a[2] * b[0] - (double)a[0] * b[2]) * n[1] +
                 ((double)a[0] * b[1] - (double)a[1] * b[0]) * n[2];
        length += out[i] * out[i];
    }
    length = length > 0.0 ? sqrt(length) : 1.0;
    for (int i = 0; i < 3; i++) {
        out[i] /= length;
    }
}

static void dump_vertex(byte_buffer *out, const noh_vertex *v, const float world[12])
{
    double n[3];
    print_to(out, "v");
    for (int r = 0; r < 3; r++) {
        const float *row = world + 4 * r;
        print_to(out, " %.9g",
                 (double)row[0] * v->position[0] + (double)row[1] * v->position[1] + (double)row[2] * v->position[2] +
                     (double)row[3]);
    }
    print_to(out, " %.4f %.4f %.4f\n", (double)v->color[0], (double)v->color[1], (double)v->color[2]);
    transform_normal(world, v->normal, n);
    print_to(out, "vn %.6f %.6f %.6f\nvt %.7g %.7g\n", n[0], n[1], n[2], (double)v->uv[0], 1.0 - (double)v->uv[1]);
}

static void dump_faces(byte_buffer *out, const noh_mesh *mesh, uint32_t first)
{
    for (uint32_t s = 0; s < mesh->header->submesh_count; s++) {
        const noh_submesh *sub = &mesh->submeshes[s];
        if (sub->material != NOH_NONE) {
            print_to(out, "usemtl %s\n", noh_pack_string(mesh->pack, mesh->pack->materials[sub->material].name));
        }
        for (uint32_t i = 0; i < sub->index_count; i += 3) {
            print_to(out, "f");
            for (uint32_t k = 0; k < 3; k++) {
                uint32_t v = first + noh_mesh_index(mesh, sub->first_index + i + k);
                print_to(out, " %u/%u/%u", v, v, v);
            }
            print_to(out, "\n");
        }
    }
}

static void dump_item(byte_buffer *out, const pack_file *file, const scene *s, uint32_t item,
                      const noh_vertex *vertices, uint32_t *first)
{
    const noh_mesh *mesh = &s->meshes[s->items[item].mesh];
    print_to(out, "o %s\n", mesh->name);
    if (mesh->header->level) {
        print_to(out, "# LOD level %u of 0 to %u\n", mesh->header->level, mesh->header->level_count - 1u);
    }
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        dump_vertex(out, &vertices[v], scene_world(s, file, item));
    }
    dump_faces(out, mesh, *first);
    *first += mesh->header->vertex_count;
}

/* Positions and normals as the vertex shader leaves them. */
static int fetch_item(load *l, readback *r, uint32_t item, noh_vertex *vertices)
{
    const noh_gl_mesh *mesh = &l->meshes[l->scene->items[item].mesh];
    noh_gl_morph_binding morph = noh_gl_morph_binding_of(l->morph.morph, l->item_instances[item]);
    noh_gl_skin_binding skin;
    uint32_t count = mesh->mesh.header->vertex_count;
    readback_vertex *read = malloc(sizeof *read * (count + 1u));
    int status = read ? 0 : tool_fail(l->file->path, "out of memory");
    if (!status) {
        status = readback_skinned(r, mesh, &morph, load_skin_binding(l, item, &skin), 0, read);
    }
    for (uint32_t v = 0; v < count && !status; v++) {
        memcpy(vertices[v].position, read[v].position, sizeof vertices[v].position);
        memcpy(vertices[v].normal, read[v].normal, sizeof vertices[v].normal);
    }
    free(read);
    return status;
}

/* l and r NULL: the vertices of the CPU. */
static int dump_items(byte_buffer *out, const pack_file *file, const scene *s, load *l, readback *r)
{
    uint32_t first = 1;
    int status = 0;
    for (uint32_t i = 0; i < s->item_count && !status; i++) {
        uint32_t count = s->meshes[s->items[i].mesh].header->vertex_count;
        noh_vertex *vertices = malloc(sizeof *vertices * (count + 1u));
        status = vertices ? scene_deform(s, i, count, vertices) : tool_fail(file->path, "out of memory");
        if (!status && l) status = fetch_item(l, r, i, vertices);
        if (!status) dump_item(out, file, s, i, vertices, &first);
        free(vertices);
    }
    return status;
}

static int dump_gpu(byte_buffer *out, const pack_file *file, const scene *s, const dump_args *a)
{
    gpu g;
    load l;
    readback r;
    int status = gpu_open_drawing(&g, a->driver);
    if (status) {
        return status;
    }
    status = load_open(&l, &g, file, s, &a->load);
    if (!status) {
        status = load_update(&l, NULL);
        if (!status) status = readback_open(&r, &g, noh_gl_morph_plan_of(l.morph.morph)->layer_format == GL_RGBA32UI);
        if (!status) {
            status = dump_items(out, file, s, &l, &r);
            readback_close(&r);
        }
        load_close(&l);
    }
    gpu_close(&g);
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

static int dump_scene(const pack_file *file, scene *s, const dump_args *a)
{
    byte_buffer out = { NULL, 0, 0, 0 };
    int status = scene_set_level(s, file, a->level);
    if (!status) status = scene_open_anim(s, file, a->anim);
    if (!status && a->clips.count) status = scene_set_clips(s, file, &a->clips, a->time_s);
    if (!status) status = scene_set_weights(s, file, &a->weights);
    if (!status) {
        print_to(&out, "# baked by noh: positions in world space, vertex colours linear\n");
        status = a->path && a->load.path != NOH_MORPH_CPU ? dump_gpu(&out, file, s, a)
                                                          : dump_items(&out, file, s, NULL, NULL);
    }
    if (!status) status = write_out(a, &out);
    buffer_free(&out);
    return status;
}

static int fail_graph(const pack_file *file, const char *name)
{
    const char *names[64], *near;
    size_t count = 0;
    for (; count < file->pack.graph_count && count < sizeof names / sizeof names[0]; count++) {
        names[count] = noh_pack_chunk_name(&file->pack, file->pack.first_graph + (uint32_t)count);
    }
    if (!count) return tool_fail(file->path, "holds no animation graph");
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
    int status = found < file->pack.graph_count ? 0 : fail_graph(file, a->graph);
    for (uint32_t i = found; !status && i < (all ? file->pack.graph_count : found + 1u); i++) {
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
    int status = parse_path(a->path, &a->load.path);
    if (!status) status = parse_accumulate(a->accumulate, &a->load.accumulate);
    if (!status) status = parse_level(a->lod, &a->level);
    return status;
}

static int run(void *args)
{
    dump_args *a = args;
    pack_file file;
    scene s;
    int status = check_args(a);
    if (!status) status = pack_file_open(&file, a->pack);
    if (status) {
        return status;
    }
    if (a->graph) {
        status = dump_graphs(&file, a);
        pack_file_close(&file);
        return status;
    }
    status = scene_init(&s, &file);
    if (!status) {
        status = dump_scene(&file, &s, a);
        scene_free(&s);
    }
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
      .what = "the mesh: positions in world space, linear vertex colours; or the text of --graph",
      .example = "face.obj" },
    { .name = "--graph",
      .kind = OPTION_TEXT,
      .at = offsetof(dump_args, graph),
      .value = "NAME|all",
      .what = "write an animation graph instead, as the text that noh build --graph reads",
      .example = "hero",
      .excludes = "--weight --clip --anim --lod --path" },
    OPTION_WEIGHT(dump_args, weights, .needs = NULL),
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
    .files = "PACK",
    .what = "write the deformed mesh, as drawn, to an OBJ file; or an animation graph as text",
    .more =
        "Without --path, and with --path cpu, the CPU computes the mesh and no GL is needed. With any other path the vertices are those of the vertex shader.",
    .example =
        "face.noh -o face.obj --weight smile=1\nbody.noh -o walk.obj --clip walk --time 0.5 --path mrt\nbody.noh -o hero.graph --graph hero",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(dump_args, pack),
    .args = &arguments,
    .run = run,
};
