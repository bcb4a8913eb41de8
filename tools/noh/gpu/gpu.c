#include "gpu.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "noh/low_core.h"

/* For tests and debuggers: NOH_GL_DEBUG=1 ends the program at the first GL error. */
static void GL_APIENTRY stop_at_error(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                      const GLchar *message, const void *user)
{
    (void)id;
    (void)severity;
    (void)length;
    (void)user;
    if (type == GL_DEBUG_TYPE_ERROR && source == GL_DEBUG_SOURCE_API) {
        exit(tool_fail("GL", "%s", message));
    }
}

/* Called after the probe, which provokes errors on purpose. */
static void watch_errors(const noh_gl_api *gl)
{
    const char *wish = getenv("NOH_GL_DEBUG");
    if (wish && wish[0] && gl->DebugMessageCallback) {
        gl->Enable(GL_DEBUG_OUTPUT);
        gl->Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        gl->DebugMessageCallback(stop_at_error, NULL);
    }
}

int gpu_open(gpu *g, const char *driver)
{
    char message[2048] = "";
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_platform_desc desc;
    const char *name = driver ? driver : "egl";
    memset(&desc, 0, sizeof desc);
    memset(g, 0, sizeof *g);
    g->platform = noh_platform_find(name);
    if (!g->platform) {
        return tool_usage("no driver '%s' (there are: %s)", name, noh_platform_names());
    }
    if (g->platform->create(&desc, &g->context, message, sizeof message)) {
        return tool_fail(name, "no GL context\n%s", message);
    }
    if (noh_gl_api_load(&g->gl, g->platform->get_proc, g->context, &error) ||
        noh_gl_caps_probe(&g->gl, &g->caps, &error)) {
        g->platform->destroy(g->context);
        return tool_fail_error(name, &error);
    }
    g->gl.decode = noh_etc2_decode;
    watch_errors(&g->gl);
    return 0;
}

int gpu_gives_vertices(const noh_gl_api *gl)
{
    return gl->BeginTransformFeedback && gl->EndTransformFeedback && gl->MapBufferRange && gl->UnmapBuffer;
}

int gpu_open_drawing(gpu *g, const char *driver)
{
    int status = gpu_open(g, driver);
    if (!status && !gpu_gives_vertices(&g->gl)) {
        status = tool_fail(g->platform->name, "this driver's pictures cannot be read back");
        gpu_close(g);
    }
    return status;
}

void gpu_close(gpu *g)
{
    if (g->platform) {
        g->platform->destroy(g->context);
    }
    memset(g, 0, sizeof *g);
}

int gpu_morph_open(gpu_morph *m, gpu *g, const noh_gl_morph_desc *desc, const char *subject)
{
    noh_gl_morph_plan plan;
    noh_error error = { NOH_OK, "", 0, 0 };
    char log[4096] = "";
    memset(m, 0, sizeof *m);
    if (noh_gl_morph_plan_make(desc, &g->caps, &plan, &error)) {
        return tool_fail_error(subject, &error);
    }
    m->bytes = (size_t)plan.cpu_bytes;
    m->memory = malloc(m->bytes);
    if (!m->memory) {
        return tool_fail(subject, "out of memory");
    }
    if (noh_gl_morph_init(m->memory, m->bytes, &(noh_gl_device){ &g->gl, &g->caps, &g->ledger, log, sizeof log }, desc,
                          &m->morph, &error)) {
        free(m->memory);
        memset(m, 0, sizeof *m);
        if (log[0]) {
            fputs(log, stderr);
        }
        return tool_fail_error(subject, &error);
    }
    return 0;
}

void gpu_morph_close(gpu_morph *m)
{
    if (m->morph) {
        noh_gl_morph_delete(m->morph);
    }
    free(m->memory);
    memset(m, 0, sizeof *m);
}
