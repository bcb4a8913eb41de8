/* bench_paths.c: our seven paths, and the unmorphed mesh. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "gl/morph/gl_morph_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"

typedef struct path_method {
    bench_stage *stage;
    gpu_morph morph;
    noh_gl_morph_binding binding;
    GLint u_morph[BENCH_PASS_COUNT], u_streams[BENCH_PASS_COUNT];
} path_method;

static void prepare(void *self, const float *weights)
{
    path_method *p = (path_method *)self;
    noh_gl_morph_set_weights(p->morph.morph, 0, weights, NULL);
    noh_gl_morph_update(p->morph.morph, NULL);
    p->binding = noh_gl_morph_binding_of(p->morph.morph, 0);
}

static void bind(void *self, bench_pass pass)
{
    const path_method *p = (const path_method *)self;
    const noh_gl_api *gl = &p->stage->g->gl;
    const noh_gl_morph_binding *b = &p->binding;
    noh_gl_morph_bind(gl, b);
    gl->Uniform4i(p->u_morph[pass], b->tile_x, b->tile_y, b->width_log2, b->touched);
    noh_gl_morph_bind_streams(gl, p->u_streams[pass], b);
}

static void close_path(void *self)
{
    path_method *p = (path_method *)self;
    gpu_morph_close(&p->morph);
    free(p);
}

/* Half floats are allowed the error that the pack states. */
static void set_slack(bench_method *m, const noh_mesh_header *h, noh_accumulate accumulate)
{
    if (accumulate == NOH_ACCUMULATE_F16) {
        m->slack = (double)h->f16_position_bound;
        m->normal_slack = 2.0 * (double)h->f16_direction_bound;
    }
}

int bench_open_path(bench_method *m, bench_stage *s, noh_morph_path path, noh_accumulate accumulate, int vertices)
{
    static const char *const defines[] = { "#define BENCH_LAYERS\n", "#define BENCH_LAYERS\n#define NOH_LAYERS_UINT\n",
                                           "#define BENCH_LAYERS\n#define NOH_STREAMS\n",
                                           "#define BENCH_LAYERS\n#define NOH_VERTICES\n",
                                           "#define BENCH_LAYERS\n#define NOH_DIRECT\n" };
    noh_gl_morph_desc desc;
    noh_gl_morph_plan plan;
    path_method *p;
    int status;
    memset(m, 0, sizeof *m);
    memset(&desc, 0, sizeof desc);
    desc.meshes = s->mesh;
    desc.mesh_count = 1;
    desc.path = path;
    desc.accumulate = accumulate;
    desc.vertices = vertices;
    if (noh_gl_morph_plan_make(&desc, &s->g->caps, &plan, NULL) || (vertices && !plan.vertex_ring)) {
        return -1;
    }
    p = calloc(1, sizeof *p);
    if (!p) {
        return tool_fail("bench", "out of memory");
    }
    snprintf(m->name, sizeof m->name, "%s%s-%s", noh_morph_path_name(path),
             path == NOH_MORPH_CPU && accumulate != NOH_ACCUMULATE_F16 && !vertices ? "-sums" : "",
             noh_accumulate_name(accumulate));
    p->stage = s;
    m->self = p;
    m->most_targets = path == NOH_MORPH_STREAMS ? NOH_MORPH_STREAMS_MAX : 0;
    m->mesh = &s->gl_mesh;
    m->prepare = prepare;
    m->binding = &p->binding;
    m->bind = bind;
    m->close = close_path;
    if (vertices) m->normal_slack = (double)NOH_FINISHED_NORMAL_ERROR;
    set_slack(m, s->mesh->header, accumulate);
    status = gpu_morph_open(&p->morph, s->g, &desc, "bench");
    if (!status && noh_gl_morph_set_mesh(p->morph.morph, 0, &s->gl_mesh, NULL)) {
        status = tool_fail("bench", "the driver refuses vertex arrays");
    }
    if (!status) {
        p->binding = noh_gl_morph_binding_of(p->morph.morph, 0);
        status = bench_programs(s, m, defines[p->binding.is_uint]);
    }
    for (int pass = 0; pass < BENCH_PASS_COUNT; pass++) {
        p->u_morph[pass] = s->g->gl.GetUniformLocation(m->programs[pass], "noh_morph");
        p->u_streams[pass] = s->g->gl.GetUniformLocation(m->programs[pass], "noh_streams");
    }
    return status;
}

int bench_open_unmorphed(bench_method *m, bench_stage *s)
{
    memset(m, 0, sizeof *m);
    snprintf(m->name, sizeof m->name, "unmorphed");
    m->mesh = &s->gl_mesh;
    m->is_baseline = 1;
    return bench_programs(s, m, "");
}
