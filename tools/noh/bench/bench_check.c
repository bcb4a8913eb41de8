/* bench_check.c: a method is timed only after its vertices matched the CPU reference, so that like is compared with
 * like. Vertices come back through transform feedback. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "deform/morph/morph_internal.h"

typedef struct check {
    bench_stage *stage;
    const bench_method *method;
    uint32_t vertex_count;
    float *weights;
    void *layers;
    float *got; /* [vertex_count][6]: position, normal */
} check;

static double length3(const float v[3])
{
    return sqrt((double)v[0] * v[0] + (double)v[1] * v[1] + (double)v[2] * v[2]);
}

/* Draw every vertex once into a buffer, and read it. 0 on success. */
static int capture(check *c)
{
    const noh_gl_api *gl = &c->stage->g->gl;
    GLsizeiptr bytes = (GLsizeiptr)c->vertex_count * 24;
    const void *mapped;
    GLuint buffer;
    if (c->method->prepare) {
        c->method->prepare(c->method->self, c->weights);
    }
    gl->GenBuffers(1, &buffer);
    gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
    gl->BufferData(GL_TRANSFORM_FEEDBACK_BUFFER, bytes, NULL, GL_STREAM_READ);
    gl->BindFramebuffer(GL_FRAMEBUFFER, c->stage->framebuffer);
    gl->VertexAttribI4i(NOH_ATTRIBUTE_TANGENT, 0, 0, 0, 1);
    gl->BindVertexArray(c->method->mesh->vertex_array);
    gl->UseProgram(c->method->programs[BENCH_CHECK]);
    if (c->method->bind) {
        c->method->bind(c->method->self, BENCH_CHECK);
    }
    noh_gl_mesh_bind(gl, c->method->mesh, c->method->binding);
    gl->Enable(GL_RASTERIZER_DISCARD);
    gl->BeginTransformFeedback(GL_POINTS);
    gl->DrawArrays(GL_POINTS, 0, (GLsizei)c->vertex_count);
    gl->EndTransformFeedback();
    gl->Disable(GL_RASTERIZER_DISCARD);
    noh_gl_mesh_unbind(gl, c->method->mesh, c->method->binding);
    gl->Finish();
    mapped = gl->MapBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, bytes, GL_MAP_READ_BIT);
    if (mapped) {
        memcpy(c->got, mapped, (size_t)bytes);
        gl->UnmapBuffer(GL_TRANSFORM_FEEDBACK_BUFFER);
    }
    gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    gl->DeleteBuffers(1, &buffer);
    gl->BindVertexArray(0);
    gl->UseProgram(0);
    return !mapped || gl->GetError() != GL_NO_ERROR;
}

/* The largest errors of positions and normals against the reference. */
static void measure(check *c, double *position_error, double *normal_error)
{
    noh_morph_layers layers;
    noh_morph_layers_init(c->layers, noh_morph_layers_size(c->stage->mesh), c->stage->mesh, &layers, NULL);
    noh_morph_accumulate_scalar(c->stage->mesh, c->weights, &layers);
    *position_error = *normal_error = 0.0;
    for (uint32_t v = 0; v < c->vertex_count; v++) {
        const float *got = c->got + 6 * (size_t)v;
        noh_vertex expected;
        float p[3], n[3];
        noh_morph_vertex(c->stage->mesh, &layers, c->method->order ? c->method->order[v] : v, &expected);
        for (int i = 0; i < 3; i++) {
            p[i] = got[i] - expected.position[i];
            n[i] = got[3 + i] - expected.normal[i];
        }
        *position_error = fmax(*position_error, length3(p));
        *normal_error = fmax(*normal_error, length3(n));
    }
}

static int check_pose(check *c, const char *pose, int with_normals, const char *subject)
{
    const noh_mesh_header *h = c->stage->mesh->header;
    double position_error, normal_error, position_limit, normal_limit;
    float size[3];
    for (int i = 0; i < 3; i++) {
        size[i] = h->bounds_max[i] - h->bounds_min[i];
    }
    position_limit = 1e-4 * length3(size) + c->method->slack;
    normal_limit = 1e-3 + c->method->normal_slack;
    if (capture(c)) {
        return tool_fail(subject, "%s: the driver cannot read vertices back", c->method->name);
    }
    measure(c, &position_error, &normal_error);
    if (!(position_error <= position_limit)) {
        return tool_fail(subject, "%s draws another result: %s, a vertex is off by %g (allowed: %g)", c->method->name,
                         pose, position_error, position_limit);
    }
    if (with_normals && !(normal_error <= normal_limit)) {
        return tool_fail(subject, "%s draws another result: %s, a normal is off by %g (allowed: %g)", c->method->name,
                         pose, normal_error, normal_limit);
    }
    return 0;
}

static void set_all(check *c)
{
    const uint32_t targets = c->stage->mesh->header->target_count, most = c->method->most_targets;
    const uint32_t step = most && most < targets ? (targets + most - 1u) / most : 1u;
    for (uint32_t t = 0; t < targets; t += step) {
        c->weights[t] = 0.1f + 0.5f * (float)(t * 11u % 17u) / 16.0f;
    }
}

static void set_largest(check *c)
{
    uint32_t largest = 0;
    for (uint32_t t = 0; t < c->stage->mesh->header->target_count; t++) {
        c->weights[t] = 0.0f;
        if (c->stage->mesh->targets[t].pair_count > c->stage->mesh->targets[largest].pair_count) {
            largest = t;
        }
    }
    c->weights[largest] = 1.0f;
}

int bench_check(bench_stage *s, const bench_method *m, const char *subject)
{
    check c;
    int status;
    memset(&c, 0, sizeof c);
    c.stage = s;
    c.method = m;
    c.vertex_count = s->mesh->header->vertex_count;
    c.weights = calloc(s->mesh->header->target_count + 1u, sizeof *c.weights);
    c.layers = malloc(noh_morph_layers_size(s->mesh) + 16u);
    c.got = malloc((size_t)c.vertex_count * 24u);
    status = c.weights && c.layers && c.got ? 0 : tool_fail(subject, "out of memory");
    if (!status) {
        set_all(&c);
        status = check_pose(&c, "all targets active", !m->normals_of_one_only, subject);
    }
    if (!status) {
        set_largest(&c);
        status = check_pose(&c, "one target at full weight", 1, subject);
    }
    free(c.weights);
    free(c.layers);
    free(c.got);
    return status;
}
