#include "refusing_gl.h"

#include <GLES3/gl32.h>

#include <string.h>

static noh_gl_api real;
static uint32_t calls[REFUSING_GL_COUNT], refused_function = REFUSING_GL_COUNT, refused_call;
static int happened;
static GLenum pending;

const char *const refusing_gl_names[REFUSING_GL_COUNT] = {
#define NAME(name) "gl" #name,
    REFUSING_GL_FUNCTIONS(NAME)
#undef NAME
};

/* Whether this call of the function is the one. */
static int refuses(uint32_t function)
{
    const uint32_t call = calls[function]++;
    if (function != refused_function || call != refused_call || happened) return 0;
    happened = 1;
    pending = GL_OUT_OF_MEMORY;
    return 1;
}

static GLenum GL_APIENTRY get_error(void)
{
    const GLenum code = pending;
    pending = GL_NO_ERROR;
    return code ? code : real.GetError();
}

#define PASS(name, parameters, arguments)                   \
    static void GL_APIENTRY pass_##name parameters          \
    {                                                       \
        if (!refuses(REFUSING_##name)) real.name arguments; \
    }
#define PASS_NAMES(name)                                          \
    static void GL_APIENTRY pass_##name(GLsizei n, GLuint *names) \
    {                                                             \
        if (refuses(REFUSING_##name))                             \
            memset(names, 0, (size_t)n * 4u);                     \
        else                                                      \
            real.name(n, names);                                  \
    }
PASS_NAMES(GenBuffers)
PASS_NAMES(GenVertexArrays)
PASS_NAMES(GenTextures)
PASS_NAMES(GenFramebuffers)
PASS_NAMES(GenRenderbuffers)
PASS(BufferData, (GLenum t, GLsizeiptr n, const void *d, GLenum u), (t, n, d, u))
PASS(BufferSubData, (GLenum t, GLintptr at, GLsizeiptr n, const void *d), (t, at, n, d))
PASS(VertexAttribPointer, (GLuint i, GLint n, GLenum t, GLboolean z, GLsizei s, const void *p), (i, n, t, z, s, p))
PASS(TexStorage2D, (GLenum t, GLsizei l, GLenum f, GLsizei w, GLsizei h), (t, l, f, w, h))
PASS(TexStorage3D, (GLenum t, GLsizei l, GLenum f, GLsizei w, GLsizei h, GLsizei d), (t, l, f, w, h, d))
PASS(TexSubImage2D, (GLenum t, GLint l, GLint x, GLint y, GLsizei w, GLsizei h, GLenum f, GLenum k, const void *p),
     (t, l, x, y, w, h, f, k, p))
PASS(TexSubImage3D,
     (GLenum t, GLint l, GLint x, GLint y, GLint z, GLsizei w, GLsizei h, GLsizei d, GLenum f, GLenum k, const void *p),
     (t, l, x, y, z, w, h, d, f, k, p))
PASS(CompressedTexSubImage2D,
     (GLenum t, GLint l, GLint x, GLint y, GLsizei w, GLsizei h, GLenum f, GLsizei n, const void *p),
     (t, l, x, y, w, h, f, n, p))
PASS(FramebufferTexture2D, (GLenum t, GLenum a, GLenum k, GLuint n, GLint l), (t, a, k, n, l))
PASS(FramebufferTextureLayer, (GLenum t, GLenum a, GLuint n, GLint l, GLint z), (t, a, n, l, z))
PASS(RenderbufferStorageMultisample, (GLenum t, GLsizei s, GLenum f, GLsizei w, GLsizei h), (t, s, f, w, h))
PASS(CompileShader, (GLuint s), (s))
PASS(LinkProgram, (GLuint p), (p))
PASS(BindFramebuffer, (GLenum t, GLuint n), (t, n))
PASS(UseProgram, (GLuint n), (n))
PASS(DrawElements, (GLenum m, GLsizei n, GLenum t, const void *i), (m, n, t, i))
PASS(DrawElementsInstanced, (GLenum m, GLsizei n, GLenum t, const void *i, GLsizei c), (m, n, t, i, c))
PASS(DrawArraysInstanced, (GLenum m, GLint f, GLsizei n, GLsizei c), (m, f, n, c))

static GLuint GL_APIENTRY pass_CreateShader(GLenum kind)
{
    return refuses(REFUSING_CreateShader) ? 0u : real.CreateShader(kind);
}

static GLuint GL_APIENTRY pass_CreateProgram(void)
{
    return refuses(REFUSING_CreateProgram) ? 0u : real.CreateProgram();
}

void refusing_gl_install(noh_gl_api *gl)
{
    real = *gl;
#define REPLACE(name) \
    if (gl->name) gl->name = pass_##name;
    REFUSING_GL_FUNCTIONS(REPLACE)
#undef REPLACE
    gl->GetError = get_error;
    refusing_gl_at(REFUSING_GL_COUNT, 0);
}

void refusing_gl_remove(noh_gl_api *gl)
{
    *gl = real;
}

void refusing_gl_at(uint32_t function, uint32_t k)
{
    memset(calls, 0, sizeof calls);
    refused_function = function;
    refused_call = k;
    happened = 0;
    pending = GL_NO_ERROR;
}

int refusing_gl_happened(void)
{
    return happened;
}

uint32_t refusing_gl_calls(uint32_t function)
{
    return calls[function];
}
