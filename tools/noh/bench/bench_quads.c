/* bench_quads.c: the baseline `quad-per-target`, the way of the DirectX 10 sample
 * SparseMorphTargets: a texel for every vertex; each target keeps the smallest rectangle
 * that holds all its differences in three RGBA16F maps; a quad is drawn for each active
 * target, blended additively, and a geometry shader sends it to the three layers.
 *
 * Faster than the sample in one respect: differences are summed and the base is added at
 * fetch, so that the base pose need not be copied into the layers first. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "tool_shaders.gen.h"
#include "cli/message.h"
#include "gl/device/gl_api_internal.h"
#include "core/base/half_internal.h"
#include "noh/low_core.h"

typedef struct quad_target {
    GLint rect[4]; /* x, y, width, height; no width: it moves nothing */
    GLuint maps[3];
} quad_target;

typedef struct quads_method {
    bench_stage *stage;
    noh_gl_mesh drawn; /* in the asset's order */
    uint32_t *order;   /* [vertex_count] drawn vertex -> pack vertex */
    uint32_t width, height;
    quad_target *targets; /* [target_count] */
    uint32_t target_count;
    noh_gl_texture sums;
    GLuint framebuffer, program, vertex_array;
    GLint u_rect, u_weight;
} quads_method;

/* ---- the mesh in its own order ---- */

static uint32_t *invert(const uint32_t *artist, uint32_t count)
{
    uint32_t *order = malloc(sizeof *order * (count + 1u));
    for (uint32_t v = 0; order && v < count; v++) {
        order[artist ? artist[v] : v] = v;
    }
    return order;
}

/* The pack's mesh in the asset's vertex order; the caller frees `arrays`. */
static int put_back(const quads_method *q, const uint32_t *artist, noh_mesh *out, void *arrays[3])
{
    const noh_mesh *mesh = q->stage->mesh;
    const noh_mesh_header *h = mesh->header;
    float *positions = malloc(12u * (size_t)h->vertex_count);
    uint8_t *attributes = malloc((size_t)h->attribute_stride * h->vertex_count);
    uint8_t *indices = malloc((size_t)h->index_bytes * h->index_count + 4u);
    arrays[0] = positions;
    arrays[1] = attributes;
    arrays[2] = indices;
    if (!positions || !attributes || !indices) {
        return 1;
    }
    for (uint32_t v = 0; v < h->vertex_count; v++) {
        memcpy(positions + 3 * (size_t)v, mesh->positions + 3 * (size_t)q->order[v], 12);
        memcpy(attributes + (size_t)h->attribute_stride * v,
               mesh->attributes + (size_t)h->attribute_stride * q->order[v], h->attribute_stride);
    }
    for (uint32_t i = 0; i < h->index_count; i++) {
        uint32_t index = noh_mesh_index(mesh, i), moved = artist ? artist[index] : index;
        uint16_t narrow = (uint16_t)moved;
        memcpy(indices + (size_t)h->index_bytes * i, h->index_bytes == 2 ? (const void *)&narrow : (const void *)&moved,
               h->index_bytes);
    }
    *out = *mesh;
    out->positions = positions;
    out->attributes = attributes;
    out->indices = indices;
    return 0;
}

static int create_mesh(quads_method *q, const uint32_t *artist)
{
    gpu *g = q->stage->g;
    noh_error error = { NOH_OK, "", 0, 0 };
    void *arrays[3] = { NULL, NULL, NULL };
    noh_mesh mesh;
    int status;
    q->order = invert(artist, q->stage->mesh->header->vertex_count);
    status = !q->order || put_back(q, artist, &mesh, arrays) ? tool_fail("bench", "out of memory") : 0;
    if (!status && noh_gl_mesh_create(&g->gl, &g->ledger, &mesh, &q->drawn, &error)) {
        status = tool_fail_error("bench", &error);
    }
    q->drawn.mesh = *q->stage->mesh; /* only its counts are used from here on */
    for (int i = 0; i < 3; i++) {
        free(arrays[i]);
    }
    return status;
}

/* ---- the targets' maps ---- */

static int is_moved(const noh_morph_layers *l, uint32_t v)
{
    for (size_t i = 3 * (size_t)v; i < 3 * (size_t)v + 3; i++) {
        if (l->position[i] != 0.0f || l->normal[i] != 0.0f || l->tangent[i] != 0.0f) {
            return 1;
        }
    }
    return 0;
}

/* The vertex at a texel, in the pack's order; its vertex count where there is none or it is never moved. */
static uint32_t vertex_at(const quads_method *q, uint32_t x, uint32_t y)
{
    const noh_mesh_header *h = q->stage->mesh->header;
    uint32_t drawn = y * q->width + x, vertex = drawn < h->vertex_count ? q->order[drawn] : h->vertex_count;
    return vertex < h->touched_count ? vertex : h->vertex_count;
}

static void bound_target(const quads_method *q, const noh_morph_layers *layers, GLint rect[4])
{
    uint32_t low[2] = { q->width, q->height }, high[2] = { 0, 0 };
    for (uint32_t y = 0; y < q->height; y++) {
        for (uint32_t x = 0; x < q->width; x++) {
            uint32_t v = vertex_at(q, x, y);
            if (v < q->stage->mesh->header->vertex_count && is_moved(layers, v)) {
                low[0] = x < low[0] ? x : low[0];
                low[1] = y < low[1] ? y : low[1];
                high[0] = x + 1u > high[0] ? x + 1u : high[0];
                high[1] = y + 1u > high[1] ? y + 1u : high[1];
            }
        }
    }
    memset(rect, 0, 4 * sizeof *rect);
    for (int i = 0; i < 2 && high[0]; i++) {
        rect[i] = (GLint)low[i];
        rect[2 + i] = (GLint)(high[i] - low[i]);
    }
}

/* One of the three maps of a target; `texels` has room for its rectangle. */
static void upload_map(const quads_method *q, const quad_target *t, const float *layer, int map, uint16_t *texels)
{
    const noh_gl_api *gl = &q->stage->g->gl;
    uint16_t *to = texels;
    for (GLint y = t->rect[1]; y < t->rect[1] + t->rect[3]; y++) {
        for (GLint x = t->rect[0]; x < t->rect[0] + t->rect[2]; x++, to += 4) {
            uint32_t v = vertex_at(q, (uint32_t)x, (uint32_t)y);
            memset(to, 0, 8);
            for (uint32_t c = 0; c < 3 && v < q->stage->mesh->header->vertex_count; c++) {
                to[c] = noh_half_from_float(layer[3 * (size_t)v + c], NOH_HALF_RNE);
            }
        }
    }
    gl->BindTexture(GL_TEXTURE_2D, t->maps[map]);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA16F, t->rect[2], t->rect[3]);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, t->rect[2], t->rect[3], GL_RGBA, GL_HALF_FLOAT, texels);
    gl->BindTexture(GL_TEXTURE_2D, 0);
}

static int create_targets(quads_method *q)
{
    const noh_mesh *mesh = q->stage->mesh;
    size_t bytes = noh_morph_layers_size(mesh);
    void *memory = malloc(bytes + 16u);
    float *weights = calloc(q->target_count + 1u, sizeof *weights);
    uint16_t *texels = malloc(8u * (size_t)q->width * q->height);
    noh_morph_layers layers;
    int failed = !memory || !weights || !texels;
    q->targets = calloc(q->target_count + 1u, sizeof *q->targets);
    failed |= !q->targets;
    if (!failed) {
        noh_morph_layers_init(memory, bytes, mesh, &layers, NULL);
        q->stage->g->gl.ActiveTexture(GL_TEXTURE0);
    }
    for (uint32_t t = 0; t < q->target_count && !failed; t++) {
        const float *from[3] = { layers.position, layers.normal, layers.tangent };
        bench_target_deltas(mesh, t, weights, &layers);
        bound_target(q, &layers, q->targets[t].rect);
        q->stage->g->gl.GenTextures(3, q->targets[t].maps);
        for (int map = 0; map < 3 && q->targets[t].rect[2]; map++) {
            upload_map(q, &q->targets[t], from[map], map, texels);
        }
    }
    free(memory);
    free(weights);
    free(texels);
    return failed ? tool_fail("bench", "out of memory") : 0;
}

/* ---- the layers and the program ---- */

static int create_sums(quads_method *q)
{
    gpu *g = q->stage->g;
    noh_gl_texture_desc desc = { GL_RGBA32F, 0, 0, 3, 0, 0, 0 };
    noh_error error = { NOH_OK, "", 0, 0 };
    desc.width = q->width;
    desc.height = q->height;
    if (noh_gl_texture_create(&g->gl, &g->ledger, &desc, &q->sums, &error) ||
        noh_gl_framebuffer_create(&g->gl, &g->ledger, &q->framebuffer, &error)) {
        return tool_fail_error("bench", &error);
    }
    g->gl.BindFramebuffer(GL_FRAMEBUFFER, q->framebuffer);
    g->gl.FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, q->sums.name, 0);
    if (g->gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        return tool_fail("bench", "quad-per-target: the driver refuses a layered framebuffer");
    }
    g->gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    g->gl.GenVertexArrays(1, &q->vertex_array);
    return 0;
}

static int create_program(quads_method *q)
{
    static const char *const samplers[] = { "u_positions", "u_normals", "u_tangents" };
    const noh_gl_api *gl = &q->stage->g->gl;
    noh_gl_program_desc desc;
    noh_error error = { NOH_OK, "", 0, 0 };
    char log[4096] = "";
    memset(&desc, 0, sizeof desc);
    desc.name = "quad-per-target";
    desc.vertex = &noh_shader_bench_quad_vert;
    desc.geometry = &noh_shader_bench_quad_geom;
    desc.fragment = &noh_shader_bench_quad_frag;
    desc.version = noh_gl_geometry_version(gl);
    desc.geometry_defines = noh_gl_geometry_defines(gl);
    desc.samplers = samplers;
    desc.sampler_count = 3;
    if (noh_gl_program_create(gl, &desc, &q->program, log, sizeof log, &error)) {
        fputs(log, stderr);
        return tool_fail_error("bench", &error);
    }
    gl->UseProgram(q->program);
    gl->Uniform2f(gl->GetUniformLocation(q->program, "u_atlas"), 2.0f / (float)q->width, 2.0f / (float)q->height);
    q->u_rect = gl->GetUniformLocation(q->program, "u_rect");
    q->u_weight = gl->GetUniformLocation(q->program, "u_weight");
    gl->UseProgram(0);
    return 0;
}

/* ---- a frame ---- */

static void draw_target(const quads_method *q, const quad_target *t, float weight)
{
    const noh_gl_api *gl = &q->stage->g->gl;
    for (unsigned map = 0; map < 3; map++) {
        gl->ActiveTexture(GL_TEXTURE0 + map);
        gl->BindTexture(GL_TEXTURE_2D, t->maps[map]);
    }
    gl->Uniform4i(q->u_rect, t->rect[0], t->rect[1], t->rect[2], t->rect[3]);
    gl->Uniform1f(q->u_weight, weight);
    gl->DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

static void prepare(void *self, const float *weights)
{
    static const float zero[4] = { 0.0f, 0.0f, 0.0f, 0.0f };
    const quads_method *q = (const quads_method *)self;
    const noh_gl_api *gl = &q->stage->g->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, q->framebuffer);
    gl->Viewport(0, 0, (GLsizei)q->width, (GLsizei)q->height);
    gl->ClearBufferfv(GL_COLOR, 0, zero);
    gl->UseProgram(q->program);
    gl->BindVertexArray(q->vertex_array);
    gl->BlendEquation(GL_FUNC_ADD);
    gl->BlendFunc(GL_ONE, GL_ONE);
    gl->Enable(GL_BLEND);
    for (uint32_t t = 0; t < q->target_count; t++) {
        if (weights[t] != 0.0f && q->targets[t].rect[2]) {
            draw_target(q, &q->targets[t], weights[t]);
        }
    }
    gl->Disable(GL_BLEND);
    gl->BindVertexArray(0);
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    for (unsigned map = 0; map < 3; map++) {
        gl->ActiveTexture(GL_TEXTURE0 + map);
        gl->BindTexture(GL_TEXTURE_2D, 0);
    }
}

static void bind(void *self, bench_pass pass)
{
    const quads_method *q = (const quads_method *)self;
    const noh_gl_api *gl = &q->stage->g->gl;
    (void)pass;
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, q->sums.name);
}

static void close_quads(void *self)
{
    quads_method *q = (quads_method *)self;
    gpu *g = q->stage->g;
    noh_gl_mesh_delete(&g->gl, &g->ledger, &q->drawn);
    noh_gl_framebuffer_delete(&g->gl, &g->ledger, &q->framebuffer);
    noh_gl_texture_delete(&g->gl, &g->ledger, &q->sums);
    noh_gl_program_delete(&g->gl, NULL, &q->program);
    if (q->vertex_array) {
        g->gl.DeleteVertexArrays(1, &q->vertex_array);
    }
    for (uint32_t t = 0; q->targets && t < q->target_count; t++) {
        g->gl.DeleteTextures(3, q->targets[t].maps);
    }
    free(q->targets);
    free(q->order);
    free(q);
}

static void set_width(const bench_method *m, const quads_method *q)
{
    const noh_gl_api *gl = &q->stage->g->gl;
    for (int pass = 0; pass < BENCH_PASS_COUNT; pass++) {
        gl->UseProgram(m->programs[pass]);
        gl->Uniform1i(gl->GetUniformLocation(m->programs[pass], "u_width"), (GLint)q->width);
    }
    gl->UseProgram(0);
}

int bench_open_quads(bench_method *m, bench_stage *s, const uint32_t *artist)
{
    quads_method *q;
    int status;
    memset(m, 0, sizeof *m);
    if (!s->g->caps.layered || !s->g->caps.blend_f32) {
        return -1;
    }
    q = calloc(1, sizeof *q);
    if (!q) {
        return tool_fail("bench", "out of memory");
    }
    snprintf(m->name, sizeof m->name, "quad-per-target");
    q->stage = s;
    q->target_count = s->mesh->header->target_count;
    q->width = (uint32_t)ceil(sqrt((double)s->mesh->header->vertex_count));
    q->height = (s->mesh->header->vertex_count + q->width - 1u) / q->width;
    m->self = q;
    m->is_baseline = 1;
    m->prepare = prepare;
    m->bind = bind;
    m->close = close_quads;
    m->normal_slack = 3e-2; /* its differences are half floats, and a sum of many may have a small length */
    status = create_mesh(q, artist);
    m->mesh = &q->drawn;
    m->order = q->order;
    if (!status) status = create_targets(q);
    if (!status) status = create_sums(q);
    if (!status) status = create_program(q);
    if (!status) status = bench_programs(s, m, "#define BENCH_QUADS\n");
    if (!status) set_width(m, q);
    return status;
}
