/* bench_before.c: the path cpu against its form in version 0.1, before its kernel was compiled once for each caller
 * and vertices were finished: SSE2 or NEON behind a pointer that is called for each row of a rectangle, vectors that
 * begin where a row does, and sums in a texture. The result is the lowest tenth of many short samples of four cells.
 * The predecessors of mrt, per-layer and gather are not kept: they had tables and shaders of their own. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "deform/morph/morph_accumulate_internal.h"
#include "core/base/compiler_internal.h"

typedef struct before {
    bench_stage *stage;
    const bench_method *method;
    float *memory;
    size_t bytes;
    noh_gl_texture layers;
    GLint u_morph[BENCH_PASS_COUNT];
} before;

#if defined(NOH_SSE2)
/* The last one to three words of a run in one register, by a branch for each count. */
static __m128i load_tail(const void *from, size_t count)
{
    __m128i low = count >= 2 ? _mm_loadl_epi64((const __m128i *)from) : _mm_setzero_si128();
    int32_t last;
    if (count == 2) return low;
    memcpy(&last, (const uint8_t *)from + 4 * (count - 1), 4);
    return count == 3 ? _mm_unpacklo_epi64(low, _mm_cvtsi32_si128(last)) : _mm_cvtsi32_si128(last);
}

static void add_tail(const uint32_t *words, size_t count, morph_field f, float *layer)
{
    const __m128 sum = noh_v4_with_field(_mm_castsi128_ps(load_tail(words, count)), f,
                                         _mm_castsi128_ps(load_tail(layer, count)));
    if (count == 1) {
        _mm_store_ss(layer, sum);
    } else {
        _mm_storel_epi64((__m128i *)(void *)layer, _mm_castps_si128(sum));
        if (count == 3) _mm_store_ss(layer + 2, _mm_movehl_ps(sum, sum));
    }
}
#endif

NOH_NEVER_INLINE static void add_row(const uint32_t *words, size_t count, const morph_field f[3],
                                     float *const layers[3])
{
    size_t i = 0;
#if defined(NOH_SSE2) || defined(NOH_NEON)
    for (; i + 4u <= count; i += 4u) {
        noh_v4_add_field(noh_v4_words(words + i), f[0], layers[0] + i);
        noh_v4_add_field(noh_v4_words(words + i), f[1], layers[1] + i);
        noh_v4_add_field(noh_v4_words(words + i), f[2], layers[2] + i);
    }
#endif
    for (int l = 0; l < 3 && i < count; l++) {
#if defined(NOH_SSE2)
        add_tail(words + i, count - i, f[l], layers[l] + i);
#else
        noh_add_run_scalar(words + i, count - i, f[l], layers[l] + i);
#endif
    }
}

static void add_each_row(const noh_morph_rows *rows, const morph_field f[3], float *const layers[3])
{
    noh_each_row(rows, f, layers, add_row);
}

NOH_NEVER_INLINE static void add_target(const noh_morph_job *j, const noh_target *t, const morph_field f[3],
                                        noh_rows_function function)
{
    noh_accumulate_target(j, t, f, function);
}

static void prepare(void *self, const float *weights)
{
    const before *b = (const before *)self;
    const noh_gl_api *gl = &b->stage->g->gl;
    const noh_mesh *mesh = b->stage->mesh;
    const noh_mesh_header *h = mesh->header;
    const size_t floats = b->bytes / 12u;
    const noh_morph_layers layers = { b->memory, b->memory + floats, b->memory + 2u * floats };
    const noh_morph_job job = noh_morph_job_of(mesh, &layers, NULL);
    memset(b->memory, 0, b->bytes);
    for (uint32_t t = 0; t < h->target_count; t++) {
        morph_field f[3];
        if (weights[t] == 0.0f) continue;
        noh_target_fields(&mesh->targets[t], weights[t], f);
        add_target(&job, &mesh->targets[t], f, add_each_row);
    }
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, b->layers.name);
    gl->TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, 1 << h->morph_width_log2, (GLsizei)h->morph_height, 3, GL_RGB,
                      GL_FLOAT, b->memory);
}

static void bind(void *self, bench_pass pass)
{
    const before *b = (const before *)self;
    const noh_gl_api *gl = &b->stage->g->gl;
    const noh_mesh_header *h = b->stage->mesh->header;
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, b->layers.name);
    gl->Uniform4i(b->u_morph[pass], 0, 0, (GLint)h->morph_width_log2, (GLint)h->touched_count);
}

static void close_before(void *self)
{
    before *b = (before *)self;
    noh_gl_texture_delete(&b->stage->g->gl, &b->stage->g->ledger, &b->layers);
    free(b->memory);
    free(b);
}

static int open_before(bench_method *m, bench_stage *s)
{
    const noh_mesh_header *h = s->mesh->header;
    noh_gl_texture_desc desc = { GL_RGB32F, 1u << h->morph_width_log2, h->morph_height, 3, 0, 0, 0 };
    noh_error error;
    before *b = calloc(1, sizeof *b);
    int status;
    memset(m, 0, sizeof *m);
    if (!b) return tool_fail("bench", "out of memory");
    snprintf(m->name, sizeof m->name, "cpu-before");
    b->stage = s;
    b->bytes = noh_morph_layers_size(s->mesh);
    b->memory = malloc(b->bytes + 16u);
    m->self = b;
    m->mesh = &s->gl_mesh;
    m->prepare = prepare;
    m->bind = bind;
    m->close = close_before;
    if (!b->memory) return tool_fail("bench", "out of memory");
    if (noh_gl_texture_create(&s->g->gl, &s->g->ledger, &desc, &b->layers, &error)) {
        return tool_fail_error("bench", &error);
    }
    status = bench_programs(s, m, "#define BENCH_LAYERS\n");
    for (int pass = 0; pass < BENCH_PASS_COUNT; pass++) {
        b->u_morph[pass] = s->g->gl.GetUniformLocation(m->programs[pass], "noh_morph");
    }
    return status;
}

/* ---- rows ---- */

#define SAMPLE_NS 1e6
#define ROUNDS 400u

enum { FLOOR, BEFORE, FINISHED, SUMS, METHODS };

typedef struct before_job {
    bench_job *job;
    bench_stage stage;
    bench_method methods[METHODS];
    uint32_t count; /* that are open */
} before_job;

typedef struct before_work {
    before_job *job;
    bench_method *method;
    const bench_weights *weights;
    int passes; /* 0: a whole frame; -1: none, the update alone */
} before_work;

static void run_frame(void *self, uint32_t frame)
{
    const before_work *w = (const before_work *)self;
    if (w->method->prepare) w->method->prepare(w->method->self, bench_weights_of(w->weights, frame));
    if (w->passes > 0) {
        bench_draw_discarded(&w->job->stage, w->method, w->passes == 3);
    } else if (!w->passes) {
        bench_draw_frame(&w->job->stage, w->method);
    }
}

/* Passes as cost above the unmorphed mesh; whole frames are also compared with it directly. */
static void add_rows(before_job *j, const bench_cells *cells, const char *prefix, int passes)
{
    const double floor = passes ? bench_low_tenth(cells, FLOOR) : 0.0;
    for (uint32_t i = FINISHED; i < METHODS; i++) {
        const double cost = 1e-3 * (bench_low_tenth(cells, i) - floor);
        char name[64];
        snprintf(name, sizeof name, "%s/%s", prefix, j->methods[i].name);
        if (!passes) {
            bench_add_row(&j->job->rows, name, "unmorphed", 1e-3 * bench_low_tenth(cells, FLOOR), cost, "us",
                          cells->rounds);
        }
        bench_add_row(&j->job->rows, name, j->methods[BEFORE].name, 1e-3 * (bench_low_tenth(cells, BEFORE) - floor),
                      cost, "us", cells->rounds);
    }
}

static int measure(before_job *j, uint32_t active, int passes, const char *prefix)
{
    before_work works[METHODS];
    bench_weights weights;
    bench_cells cells;
    int status = bench_weights_open(&weights, j->stage.mesh, active);
    if (status) return status;
    memset(&cells, 0, sizeof cells);
    for (uint32_t i = 0; i < METHODS; i++) {
        works[i] = (before_work){ j, &j->methods[i], &weights, passes };
        bench_add_cell(&cells, run_frame, &works[i]);
    }
    status = bench_run_cells(&cells, &j->job->gl_clock, j->job->quick ? 1u : ROUNDS, SAMPLE_NS, prefix);
    if (!status) add_rows(j, &cells, prefix, passes);
    bench_free_cells(&cells);
    bench_weights_close(&weights);
    return status;
}

static int open_methods(before_job *j)
{
    int status = bench_open_unmorphed(&j->methods[FLOOR], &j->stage);
    j->count = 1;
    for (uint32_t i = BEFORE; i < METHODS && !status; i++) {
        status = i == BEFORE
                     ? open_before(&j->methods[i], &j->stage)
                     : bench_open_path(&j->methods[i], &j->stage, NOH_MORPH_CPU, NOH_ACCUMULATE_F32, i == FINISHED);
        if (status >= 0) j->count++;
        if (!status) status = bench_check(&j->stage, &j->methods[i], j->job->files[0].path);
    }
    return status;
}

/* No rows where meshes have no finished vertices. */
int bench_before(bench_job *job)
{
    const uint32_t targets = job->mesh.header->target_count;
    before_job j;
    int status;
    memset(&j, 0, sizeof j);
    j.job = job;
    status = bench_stage_open(&j.stage, &job->g, &job->mesh);
    if (status) return status;
    status = open_methods(&j);
    if (!status) status = measure(&j, targets, -1, "morph-before/update");
    if (!status) status = measure(&j, targets, 1, "morph-before/one-pass");
    if (!status) status = measure(&j, targets, 3, "morph-before/three-pass");
    if (!status) status = measure(&j, targets, 0, "frame-before");
    if (!status && targets > 4u) status = measure(&j, 4, -1, "morph-before/4-active/update");
    if (!status && targets > 4u) status = measure(&j, 4, 1, "morph-before/4-active/one-pass");
    if (!status && targets > 4u) status = measure(&j, 4, 3, "morph-before/4-active/three-pass");
    for (uint32_t i = 0; i < j.count; i++) bench_method_close(&j.stage, &j.methods[i]);
    bench_stage_close(&j.stage);
    return status < 0 ? 0 : status;
}
