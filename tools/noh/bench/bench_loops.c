/* bench_loops.c: the baselines that sum all targets in the vertex shader, again in every
 * pass. The layouts follow the peers' sources:
 *
 *   dense-vertex-loop   three.js: one RGBA32F array texture, a layer for each target, position
 *                       and normal texels of every vertex side by side, weights in a uniform array;
 *                       the texel index is divided by the width inside the loop
 *   dense-hoisted       the same with that division done once per vertex: faster than three.js
 *   dense-active-loop   the same again over a list of the active targets alone: the cheapest naive loop
 *   filament-layout     Filament: RGBA32F positions, and the morphed frames as quaternions in
 *                       RGBA16I; rows of 2048 texels, weights in a uniform block
 *
 * The peers skip a target whose weight is zero. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"

#define FILAMENT_WIDTH 2048u
#define FILAMENT_TARGETS 256u
#define UNIFORM_FLOATS 256u /* fits every ES 3.0 along with the other uniforms, even badly packed */

typedef struct loop_method {
    bench_stage *stage;
    noh_gl_texture first, second; /* texture units 0 and 1 */
    noh_gl_buffer block;          /* Filament's weights */
    const float *weights;
    float *padded; /* [targets][4] */
    GLint u_weights[BENCH_PASS_COUNT], u_count[BENCH_PASS_COUNT];
    uint32_t active;
    uint32_t target_count;
} loop_method;

/* ---- filling ---- */

/* Visits each target's deltas: dense[target] from the pack's sparse ones. */
typedef struct filler {
    const noh_mesh *mesh;
    noh_morph_layers layers;
    float *weights;
    void *texels; /* of one layer */
    void *memory;
} filler;

static int filler_open(filler *f, const noh_mesh *mesh, size_t layer_bytes)
{
    size_t bytes = noh_morph_layers_size(mesh);
    memset(f, 0, sizeof *f);
    f->mesh = mesh;
    f->memory = malloc(bytes + 16u);
    f->weights = calloc(mesh->header->target_count + 1u, sizeof *f->weights);
    f->texels = calloc(1, layer_bytes + 16u);
    if (!f->memory || !f->weights || !f->texels) {
        return tool_fail("bench", "out of memory");
    }
    noh_morph_layers_init(f->memory, bytes, mesh, &f->layers, NULL);
    return 0;
}

static void filler_close(filler *f)
{
    free(f->memory);
    free(f->weights);
    free(f->texels);
}

static int create_array(bench_stage *s, GLenum format, uint32_t width, uint32_t height, noh_gl_texture *out)
{
    noh_gl_texture_desc desc = { 0, 0, 0, 0, 0, 0, 0 };
    noh_error error = { NOH_OK, "", 0, 0 };
    desc.format = format;
    desc.width = width;
    desc.height = height;
    desc.layers = s->mesh->header->target_count;
    return noh_gl_texture_create(&s->g->gl, &s->g->ledger, &desc, out, &error) ? tool_fail_error("bench", &error) : 0;
}

static void upload_layer(bench_stage *s, const noh_gl_texture *t, uint32_t width, uint32_t height, uint32_t layer,
                         GLenum format, GLenum type, const void *texels)
{
    const noh_gl_api *gl = &s->g->gl;
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, t->name);
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl->TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, (GLint)layer, (GLsizei)width, (GLsizei)height, 1, format, type,
                      texels);
}

/* ---- three.js ---- */

static void put_dense(const filler *f)
{
    float *texels = (float *)f->texels;
    for (uint32_t v = 0; v < f->mesh->header->touched_count; v++) {
        memcpy(texels + 8 * (size_t)v, f->layers.position + 3 * (size_t)v, 12);
        memcpy(texels + 8 * (size_t)v + 4, f->layers.normal + 3 * (size_t)v, 12);
    }
}

static int fill_dense(loop_method *l, uint32_t width, uint32_t height)
{
    filler f;
    int status = create_array(l->stage, GL_RGBA32F, width, height, &l->first);
    if (status) {
        return status;
    }
    status = filler_open(&f, l->stage->mesh, (size_t)width * height * 16u);
    for (uint32_t t = 0; t < l->target_count && !status; t++) {
        bench_target_deltas(f.mesh, t, f.weights, &f.layers);
        put_dense(&f);
        upload_layer(l->stage, &l->first, width, height, t, GL_RGBA, GL_FLOAT, f.texels);
    }
    filler_close(&f);
    return status;
}

static void prepare_dense(void *self, const float *weights)
{
    ((loop_method *)self)->weights = weights;
}

static void bind_dense(void *self, bench_pass pass)
{
    const loop_method *l = (const loop_method *)self;
    const noh_gl_api *gl = &l->stage->g->gl;
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, l->first.name);
    gl->Uniform1fv(l->u_weights[pass], (GLsizei)l->target_count, l->weights);
}

/* Layers and weights of the active targets, as the shader reads them. */
static void prepare_active(void *self, const float *weights)
{
    loop_method *l = (loop_method *)self;
    l->active = 0;
    for (uint32_t t = 0; t < l->target_count; t++) {
        if (weights[t] == 0.0f) continue;
        l->padded[2u * l->active] = (float)t;
        l->padded[2u * l->active++ + 1u] = weights[t];
    }
}

static void bind_active(void *self, bench_pass pass)
{
    const loop_method *l = (const loop_method *)self;
    const noh_gl_api *gl = &l->stage->g->gl;
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, l->first.name);
    gl->Uniform4fv(l->u_weights[pass], (GLsizei)((l->target_count + 1u) / 2u), l->padded);
    gl->Uniform1i(l->u_count[pass], (GLint)l->active);
}

static void close_loop(void *self)
{
    loop_method *l = (loop_method *)self;
    gpu *g = l->stage->g;
    noh_gl_texture_delete(&g->gl, &g->ledger, &l->first);
    noh_gl_texture_delete(&g->gl, &g->ledger, &l->second);
    noh_gl_buffer_delete(&g->gl, &g->ledger, &l->block);
    free(l->padded);
    free(l);
}

/* The start of both baselines; NULL when out of memory. */
static loop_method *begin_loop(bench_method *m, bench_stage *s, const char *name)
{
    loop_method *l = calloc(1, sizeof *l);
    memset(m, 0, sizeof *m);
    if (!l) {
        tool_fail("bench", "out of memory");
        return NULL;
    }
    snprintf(m->name, sizeof m->name, "%s", name);
    l->stage = s;
    l->target_count = s->mesh->header->target_count;
    m->self = l;
    m->mesh = &s->gl_mesh;
    m->is_baseline = 1;
    m->close = close_loop;
    return l;
}

static void set_dense_constants(loop_method *l, const bench_method *m, uint32_t width)
{
    const noh_gl_api *gl = &l->stage->g->gl;
    for (int pass = 0; pass < BENCH_PASS_COUNT; pass++) {
        gl->UseProgram(m->programs[pass]);
        gl->Uniform1i(gl->GetUniformLocation(m->programs[pass], "u_targets_width"), (GLint)width);
        l->u_weights[pass] = gl->GetUniformLocation(m->programs[pass], "u_weights");
        l->u_count[pass] = gl->GetUniformLocation(m->programs[pass], "u_count");
    }
    gl->UseProgram(0);
}

int bench_open_dense(bench_method *m, bench_stage *s, bench_loop loop)
{
    static const char *const names[] = { "dense-vertex-loop", "dense-hoisted", "dense-active-loop" };
    static const char *const lines[] = { "", "#define BENCH_HOISTED\n", "#define BENCH_ACTIVE\n" };
    const noh_mesh_header *h = s->mesh->header;
    uint32_t texels = 2u * h->vertex_count, most = s->g->caps.texture_size_max;
    uint32_t width = texels < most ? texels : most, height = (texels + width - 1u) / width;
    char defines[96];
    loop_method *l;
    int status;
    memset(m, 0, sizeof *m);
    if (h->target_count > s->g->caps.array_layers_max || h->target_count > UNIFORM_FLOATS) {
        return -1;
    }
    l = begin_loop(m, s, names[loop]);
    if (!l) {
        return EXIT_FAILED;
    }
    m->prepare = loop == BENCH_LOOP_ACTIVE ? prepare_active : prepare_dense;
    m->bind = loop == BENCH_LOOP_ACTIVE ? bind_active : bind_dense;
    l->padded = calloc(h->target_count + 1u, 2u * sizeof *l->padded);
    status = l->padded ? fill_dense(l, width, height) : tool_fail("bench", "out of memory");
    if (!status) {
        snprintf(defines, sizeof defines, "#define BENCH_DENSE\n%s#define TARGETS %u\n", lines[loop], h->target_count);
        status = bench_programs(s, m, defines);
    }
    if (!status) {
        set_dense_constants(l, m, width);
    }
    return status;
}

/* ---- Filament ---- */

/* The shortest turn from +z to a unit vector: a frame with that normal. */
static void put_frame(const float n[3], int16_t out[4])
{
    double q[4] = { -(double)n[1], (double)n[0], 0.0, 1.0 + (double)n[2] }, length;
    if (q[3] < 1e-9) { /* opposite: half a turn about x */
        q[0] = 1.0;
        q[1] = q[3] = 0.0;
    }
    length = sqrt(q[0] * q[0] + q[1] * q[1] + q[3] * q[3]);
    for (int i = 0; i < 4; i++) {
        out[i] = (int16_t)lrint(q[i] / length * 32767.0);
    }
}

static void put_positions(const filler *f)
{
    float *texels = (float *)f->texels;
    for (uint32_t v = 0; v < f->mesh->header->touched_count; v++) {
        memcpy(texels + 4 * (size_t)v, f->layers.position + 3 * (size_t)v, 12);
    }
}

static void put_frames(const filler *f)
{
    int16_t *texels = (int16_t *)f->texels;
    for (uint32_t v = 0; v < f->mesh->header->vertex_count; v++) {
        noh_vertex vertex;
        noh_morph_vertex(f->mesh, &f->layers, v, &vertex);
        put_frame(vertex.normal, texels + 4 * (size_t)v);
    }
}

static int fill_filament(loop_method *l)
{
    uint32_t height = (l->stage->mesh->header->vertex_count + FILAMENT_WIDTH - 1u) / FILAMENT_WIDTH;
    filler f;
    int status = create_array(l->stage, GL_RGBA32F, FILAMENT_WIDTH, height, &l->first);
    if (!status) {
        status = create_array(l->stage, GL_RGBA16I, FILAMENT_WIDTH, height, &l->second);
    }
    if (status) {
        return status;
    }
    status = filler_open(&f, l->stage->mesh, (size_t)FILAMENT_WIDTH * height * 16u);
    for (uint32_t t = 0; t < l->target_count && !status; t++) {
        bench_target_deltas(f.mesh, t, f.weights, &f.layers);
        put_positions(&f);
        upload_layer(l->stage, &l->first, FILAMENT_WIDTH, height, t, GL_RGBA, GL_FLOAT, f.texels);
        put_frames(&f);
        upload_layer(l->stage, &l->second, FILAMENT_WIDTH, height, t, GL_RGBA_INTEGER, GL_SHORT, f.texels);
        memset(f.texels, 0, (size_t)FILAMENT_WIDTH * height * 16u);
    }
    filler_close(&f);
    return status;
}

static void prepare_filament(void *self, const float *weights)
{
    loop_method *l = (loop_method *)self;
    const noh_gl_api *gl = &l->stage->g->gl;
    for (uint32_t t = 0; t < l->target_count; t++) {
        l->padded[4 * t] = weights[t];
    }
    gl->BindBuffer(GL_UNIFORM_BUFFER, l->block.name);
    gl->BufferSubData(GL_UNIFORM_BUFFER, 0, (GLsizeiptr)(16u * (size_t)l->target_count), l->padded);
    gl->BindBuffer(GL_UNIFORM_BUFFER, 0);
}

static void bind_filament(void *self, bench_pass pass)
{
    const loop_method *l = (const loop_method *)self;
    const noh_gl_api *gl = &l->stage->g->gl;
    (void)pass;
    gl->ActiveTexture(GL_TEXTURE1);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, l->second.name);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, l->first.name);
    gl->BindBufferBase(GL_UNIFORM_BUFFER, 0, l->block.name);
}

static void set_filament_constants(const loop_method *l, const bench_method *m)
{
    const noh_gl_api *gl = &l->stage->g->gl;
    for (int pass = 0; pass < BENCH_PASS_COUNT; pass++) {
        gl->UseProgram(m->programs[pass]);
        gl->Uniform1i(gl->GetUniformLocation(m->programs[pass], "u_targets"), (GLint)l->target_count);
        gl->UniformBlockBinding(m->programs[pass], gl->GetUniformBlockIndex(m->programs[pass], "weights_block"), 0);
    }
    gl->UseProgram(0);
}

int bench_open_filament(bench_method *m, bench_stage *s)
{
    const noh_mesh_header *h = s->mesh->header;
    noh_error error = { NOH_OK, "", 0, 0 };
    loop_method *l;
    int status;
    memset(m, 0, sizeof *m);
    if (h->target_count > s->g->caps.array_layers_max || h->target_count > FILAMENT_TARGETS) {
        return -1;
    }
    l = begin_loop(m, s, "filament-layout");
    if (!l) {
        return EXIT_FAILED;
    }
    m->prepare = prepare_filament;
    m->bind = bind_filament;
    m->normals_of_one_only = 1; /* it blends unit normals, not their differences */
    l->padded = calloc(4u * (size_t)h->target_count + 4u, sizeof *l->padded);
    status = l->padded ? fill_filament(l) : tool_fail("bench", "out of memory");
    if (!status && noh_gl_buffer_create(&s->g->gl, &s->g->ledger, GL_UNIFORM_BUFFER, 16u * FILAMENT_TARGETS, NULL,
                                        GL_DYNAMIC_DRAW, &l->block, &error)) {
        status = tool_fail_error("bench", &error);
    }
    if (!status) {
        status = bench_programs(s, m, "#define BENCH_FILAMENT\n");
    }
    if (!status) {
        set_filament_constants(l, m);
    }
    return status;
}
