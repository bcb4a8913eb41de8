/* readback.c: accumulated layers as bits, through RGBA32UI targets, which core ES 3.0 can always
 * render and read: no format conversion changes a value on its way to the test. */
#include "readback.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "gpu.h"
#include "tool_shaders.gen.h"
#include "cli/message.h"

typedef struct bit_target {
    GLuint framebuffer, renderbuffers[3];
    uint32_t width, height;
} bit_target;

static int target_open(const noh_gl_api *gl, bit_target *t, uint32_t width, uint32_t height)
{
    static const GLenum attachments[3] = { GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2 };
    t->width = width;
    t->height = height;
    gl->GenFramebuffers(1, &t->framebuffer);
    gl->GenRenderbuffers(3, t->renderbuffers);
    gl->BindFramebuffer(GL_FRAMEBUFFER, t->framebuffer);
    for (unsigned i = 0; i < 3; i++) {
        gl->BindRenderbuffer(GL_RENDERBUFFER, t->renderbuffers[i]);
        gl->RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32UI, (GLsizei)width, (GLsizei)height);
        gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, attachments[i], GL_RENDERBUFFER, t->renderbuffers[i]);
    }
    gl->DrawBuffers(3, attachments);
    gl->Viewport(0, 0, (GLsizei)width, (GLsizei)height);
    gl->Disable(GL_DEPTH_TEST);
    gl->Disable(GL_CULL_FACE);
    gl->Disable(GL_BLEND);
    return gl->CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE;
}

/* Read the i-th attachment's rgb of the first `count` pixels into out[count][3]. */
static int target_read(const noh_gl_api *gl, const bit_target *t, unsigned i, size_t count, float *out)
{
    uint32_t *pixels = malloc((size_t)t->width * t->height * 16u);
    if (!pixels) {
        return 1;
    }
    gl->ReadBuffer(GL_COLOR_ATTACHMENT0 + i);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl->ReadPixels(0, 0, (GLsizei)t->width, (GLsizei)t->height, GL_RGBA_INTEGER, GL_UNSIGNED_INT, pixels);
    for (size_t p = 0; p < count; p++) {
        memcpy(out + 3 * p, pixels + 4 * p, 12);
    }
    free(pixels);
    return 0;
}

static void target_close(const noh_gl_api *gl, bit_target *t)
{
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl->BindRenderbuffer(GL_RENDERBUFFER, 0);
    gl->DeleteFramebuffers(1, &t->framebuffer);
    gl->DeleteRenderbuffers(3, t->renderbuffers);
}

static int create_program(gpu *g, int is_uint, int two_layers, GLuint *program)
{
    static const char *const defines[2][3] = { { NULL, "#define NOH_LAYERS_UINT\n", "#define NOH_DIRECT\n" },
                                               { "#define NOH_TWO_LAYERS\n",
                                                 "#define NOH_LAYERS_UINT\n#define NOH_TWO_LAYERS\n",
                                                 "#define NOH_DIRECT\n#define NOH_TWO_LAYERS\n" } };
    const char *samplers[NOH_UNIT_USER] = { NULL };
    noh_gl_program_desc desc;
    noh_error error = { NOH_OK, "", 0, 0 };
    char log[4096] = "";
    memset(&desc, 0, sizeof desc);
    desc.name = "readback";
    desc.vertex = &noh_shader_read_layers_vert;
    desc.fragment = &noh_shader_read_layers_frag;
    desc.defines = defines[two_layers][is_uint == NOH_LAYERS_DIRECT ? 2 : is_uint != 0];
    for (uint32_t i = 0; i < NOH_UNIT_USER; i++) samplers[i] = "";
    samplers[NOH_UNIT_LAYERS] = is_uint == NOH_LAYERS_DIRECT ? "noh_deltas" : "noh_layers";
    samplers[NOH_UNIT_LISTS] = "noh_lists";
    samplers[NOH_UNIT_LISTS + 1u] = "noh_starts";
    desc.samplers = samplers;
    desc.sampler_count = NOH_UNIT_USER;
    if (noh_gl_program_create(&g->gl, &desc, program, log, sizeof log, &error)) {
        fputs(log, stderr);
        return tool_fail_error("readback", &error);
    }
    return 0;
}

int readback_open(readback *r, gpu *g, int is_uint)
{
    int status;
    memset(r, 0, sizeof *r);
    r->g = g;
    r->is_uint = is_uint;
    status = create_program(g, is_uint, 0, &r->layers_programs[0]);
    g->gl.GenVertexArrays(1, &r->vertex_array);
    return status;
}

void readback_close(readback *r)
{
    noh_gl_program_delete(&r->g->gl, NULL, &r->layers_programs[0]);
    noh_gl_program_delete(&r->g->gl, NULL, &r->layers_programs[1]);
    noh_gl_variant_delete(&r->g->gl, NULL, &r->variant);
    r->g->gl.DeleteVertexArrays(1, &r->vertex_array);
}

static void use(readback *r, GLuint program, const noh_gl_morph_binding *b, const bit_target *t)
{
    const noh_gl_api *gl = &r->g->gl;
    gl->UseProgram(program);
    gl->Uniform2i(gl->GetUniformLocation(program, "u_size"), (GLint)t->width, (GLint)t->height);
    gl->Uniform4i(gl->GetUniformLocation(program, "noh_morph"), b->tile_x, b->tile_y, b->width_log2, b->touched);
    noh_gl_morph_bind(gl, b);
}

static int finish(readback *r, bit_target *t, const char *failed)
{
    const noh_gl_api *gl = &r->g->gl;
    GLenum error = gl->GetError();
    gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_LAYERS);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, 0);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    gl->BindVertexArray(0);
    gl->UseProgram(0);
    target_close(gl, t);
    if (failed) return tool_fail("readback", "%s", failed);
    return error ? tool_fail("readback", "GL error 0x%x", error) : 0;
}

int readback_layers(readback *r, const noh_mesh *mesh, const noh_gl_morph_binding *binding, float *out)
{
    uint32_t width = 1u << mesh->header->morph_width_log2, height = mesh->header->morph_height;
    size_t texels = (size_t)width * height;
    const int two = binding->layer_count == 2;
    const char *failed = NULL;
    bit_target t;
    int status = 0;
    if (!texels) {
        return 0;
    }
    if (!r->layers_programs[two]) {
        status = create_program(r->g, r->is_uint, two, &r->layers_programs[two]);
    }
    if (status) {
        return status;
    }
    if (target_open(&r->g->gl, &t, width, height)) {
        failed = "the driver cannot draw to an RGBA32UI buffer";
    } else {
        use(r, r->layers_programs[two], binding, &t);
        r->g->gl.BindVertexArray(r->vertex_array);
        r->g->gl.DrawArraysInstanced(GL_POINTS, 0, (GLsizei)texels, 1);
        for (unsigned i = 0; i < 3 && !failed; i++) {
            if (target_read(&r->g->gl, &t, i, texels, out + 3 * texels * i)) failed = "out of memory";
        }
    }
    return finish(r, &t, failed);
}

int readback_buffer(readback *r, GLuint buffer, size_t offset, size_t bytes, void *out)
{
    const noh_gl_api *gl = &r->g->gl;
    const void *mapped;
    gl->BindBuffer(GL_COPY_READ_BUFFER, buffer);
    mapped = gl->MapBufferRange(GL_COPY_READ_BUFFER, (GLintptr)offset, (GLsizeiptr)bytes, GL_MAP_READ_BIT);
    if (mapped) memcpy(out, mapped, bytes);
    if (!mapped || !gl->UnmapBuffer(GL_COPY_READ_BUFFER)) {
        return tool_fail("readback", "the driver cannot read a buffer back (GL error 0x%x)", gl->GetError());
    }
    gl->BindBuffer(GL_COPY_READ_BUFFER, 0);
    return 0;
}
