/* null_state.c: state, queries and debug groups of the GL that does nothing. */
#include "null_internal.h"

#include <string.h>

/* --- state without effect here --- */

#define STATE1(Name, T)                      \
    static void GL_APIENTRY null_##Name(T a) \
    {                                        \
        (void)a;                             \
        noh_null_count(NULL_##Name);         \
    }
#define STATE2(Name, T)                           \
    static void GL_APIENTRY null_##Name(T a, T b) \
    {                                             \
        (void)a, (void)b;                         \
        noh_null_count(NULL_##Name);              \
    }
STATE1(Enable, GLenum)
STATE1(Disable, GLenum)
STATE1(BlendEquation, GLenum)
STATE1(DepthFunc, GLenum)
STATE1(DepthMask, GLboolean)
STATE1(CullFace, GLenum)
STATE1(FrontFace, GLenum)
STATE2(BlendFunc, GLenum)
STATE2(BlendEquationSeparate, GLenum)
STATE2(DepthRangef, GLfloat)
STATE2(BindSampler, GLuint)
STATE2(PolygonOffset, GLfloat)

static void GL_APIENTRY null_BlendFuncSeparate(GLenum a, GLenum b, GLenum c, GLenum d)
{
    (void)a, (void)b, (void)c, (void)d;
    noh_null_count(NULL_BlendFuncSeparate);
}

static void GL_APIENTRY null_ColorMask(GLboolean r, GLboolean g, GLboolean b, GLboolean a)
{
    (void)r, (void)g, (void)b, (void)a;
    noh_null_count(NULL_ColorMask);
}

static void GL_APIENTRY null_ClearColor(GLfloat r, GLfloat g, GLfloat b, GLfloat a)
{
    (void)r, (void)g, (void)b, (void)a;
    noh_null_count(NULL_ClearColor);
}

static void GL_APIENTRY null_PixelStorei(GLenum what, GLint value)
{
    (void)what, (void)value;
    noh_null_count(NULL_PixelStorei);
}

static void GL_APIENTRY null_VertexAttrib4f(GLuint index, GLfloat x, GLfloat y, GLfloat z, GLfloat w)
{
    (void)index, (void)x, (void)y, (void)z, (void)w;
    noh_null_count(NULL_VertexAttrib4f);
}

static void GL_APIENTRY null_VertexAttribI4i(GLuint index, GLint x, GLint y, GLint z, GLint w)
{
    (void)index, (void)x, (void)y, (void)z, (void)w;
    noh_null_count(NULL_VertexAttribI4i);
}

static void GL_APIENTRY null_Viewport(GLint x, GLint y, GLsizei width, GLsizei height)
{
    noh_platform_context *c = noh_null_count(NULL_Viewport);
    const GLint viewport[4] = { x, y, width, height };
    if (width < 0 || height < 0) noh_null_wrong(NULL_Viewport, "%d x %d", width, height);
    memcpy(c->viewport, viewport, sizeof viewport);
}

static void GL_APIENTRY null_Scissor(GLint x, GLint y, GLsizei width, GLsizei height)
{
    (void)x;
    (void)y;
    noh_null_count(NULL_Scissor);
    if (width < 0 || height < 0) noh_null_wrong(NULL_Scissor, "%d x %d", width, height);
}

static void GL_APIENTRY null_Flush(void)
{
    noh_null_count(NULL_Flush);
}

static void GL_APIENTRY null_Finish(void)
{
    noh_null_count(NULL_Finish);
}

/* --- queries --- */

static GLenum GL_APIENTRY null_GetError(void)
{
    noh_platform_context *c = noh_null_count(NULL_GetError);
    GLenum error = c->error;
    c->error = GL_NO_ERROR;
    return error;
}

static const GLubyte *GL_APIENTRY null_GetString(GLenum what)
{
    noh_null_count(NULL_GetString);
    const char *text = what == GL_VERSION ? "OpenGL ES 3.2 null" : what == GL_RENDERER ? "null" : "noh";
    return (const GLubyte *)text;
}

static const GLubyte *GL_APIENTRY null_GetStringi(GLenum what, GLuint index)
{
    (void)what;
    noh_null_count(NULL_GetStringi);
    noh_null_wrong(NULL_GetStringi, "there is no extension %u", (unsigned)index);
    return NULL;
}

/* Queries return the state of a new context, whatever was set. */
static GLboolean GL_APIENTRY null_IsEnabled(GLenum what)
{
    (void)what;
    noh_null_count(NULL_IsEnabled);
    return GL_FALSE;
}

static void GL_APIENTRY null_GetFloatv(GLenum what, GLfloat *value)
{
    noh_null_count(NULL_GetFloatv);
    if (what != GL_DEPTH_RANGE) {
        noh_null_wrong(NULL_GetFloatv, "the null platform does not know 0x%x", (unsigned)what);
        return;
    }
    value[0] = 0.0f;
    value[1] = 1.0f;
}

static void GL_APIENTRY null_GetIntegeri_v(GLenum what, GLuint index, GLint *value)
{
    (void)what, (void)index;
    noh_null_count(NULL_GetIntegeri_v);
    *value = 0;
}

static int is_vector(GLenum what, GLint *value)
{
    if (what != GL_COLOR_WRITEMASK && what != GL_SCISSOR_BOX) return 0;
    for (int i = 0; i < 4; i++) value[i] = what == GL_COLOR_WRITEMASK;
    return 1;
}

/* The minimum limits of ES 3.0; 2,048 if they exceed what the tests need. */
static void GL_APIENTRY null_GetIntegerv(GLenum what, GLint *value)
{
    static const struct {
        GLenum what;
        GLint value;
    } answers[] = { { GL_MAJOR_VERSION, 3 },
                    { GL_MINOR_VERSION, 2 },
                    { GL_NUM_EXTENSIONS, 0 },
                    { GL_MAX_TEXTURE_SIZE, 2048 },
                    { GL_MAX_ARRAY_TEXTURE_LAYERS, 256 },
                    { GL_MAX_DRAW_BUFFERS, 4 },
                    { GL_MAX_COLOR_ATTACHMENTS, 4 },
                    { GL_MAX_SAMPLES, 4 },
                    { GL_SAMPLES, 0 },
                    { GL_MAX_VERTEX_TEXTURE_IMAGE_UNITS, 16 },
                    { GL_MAX_VERTEX_ATTRIBS, NULL_ATTRIBUTES },
                    { GL_MAX_UNIFORM_BLOCK_SIZE, 16384 },
                    { GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, 256 },
                    { GL_DEPTH_FUNC, GL_LESS },
                    { GL_FRONT_FACE, GL_CCW },
                    { GL_DEPTH_WRITEMASK, 1 },
                    { GL_BLEND_SRC_RGB, GL_ONE },
                    { GL_BLEND_SRC_ALPHA, GL_ONE },
                    { GL_BLEND_DST_RGB, GL_ZERO },
                    { GL_BLEND_DST_ALPHA, GL_ZERO },
                    { GL_BLEND_EQUATION_RGB, GL_FUNC_ADD },
                    { GL_BLEND_EQUATION_ALPHA, GL_FUNC_ADD },
                    { GL_UNPACK_ALIGNMENT, 4 },
                    { GL_UNPACK_ROW_LENGTH, 0 },
                    { GL_UNPACK_SKIP_ROWS, 0 },
                    { GL_UNPACK_SKIP_PIXELS, 0 },
                    { GL_UNPACK_IMAGE_HEIGHT, 0 },
                    { GL_UNPACK_SKIP_IMAGES, 0 },
                    { GL_PACK_ALIGNMENT, 4 },
                    { GL_PACK_ROW_LENGTH, 0 },
                    { GL_PACK_SKIP_ROWS, 0 },
                    { GL_PACK_SKIP_PIXELS, 0 },
                    { GL_PIXEL_UNPACK_BUFFER_BINDING, 0 },
                    { GL_PIXEL_PACK_BUFFER_BINDING, 0 },
                    { GL_DRAW_FRAMEBUFFER_BINDING, 0 },
                    { GL_READ_FRAMEBUFFER_BINDING, 0 } };
    const noh_platform_context *c = noh_null_count(NULL_GetIntegerv);
    if (is_vector(what, value)) return;
    if (what == GL_VIEWPORT) {
        memcpy(value, c->viewport, sizeof c->viewport);
        return;
    }
    for (size_t i = 0; i < sizeof answers / sizeof *answers; i++) {
        if (answers[i].what == what) {
            *value = answers[i].value;
            return;
        }
    }
    noh_null_wrong(NULL_GetIntegerv, "the null platform does not know 0x%x", (unsigned)what);
}

/* --- debug groups --- */

static void GL_APIENTRY null_PushDebugGroup(GLenum source, GLuint id, GLsizei length, const GLchar *text)
{
    (void)source, (void)id, (void)length;
    noh_platform_context *c = noh_null_count(NULL_PushDebugGroup);
    c->groups++;
    if (!text || !text[0]) noh_null_wrong(NULL_PushDebugGroup, "no text");
}

static void GL_APIENTRY null_PopDebugGroup(void)
{
    noh_platform_context *c = noh_null_count(NULL_PopDebugGroup);
    if (c->groups == 0)
        noh_null_wrong(NULL_PopDebugGroup, "no group is open");
    else
        c->groups--;
}

static void GL_APIENTRY null_DebugMessageCallback(GLDEBUGPROC callback, const void *user)
{
    (void)callback, (void)user;
    noh_null_count(NULL_DebugMessageCallback);
}

static void GL_APIENTRY null_DebugMessageControl(GLenum source, GLenum type, GLenum severity, GLsizei count,
                                                 const GLuint *ids, GLboolean enabled)
{
    (void)source, (void)type, (void)severity, (void)count, (void)ids, (void)enabled;
    noh_null_count(NULL_DebugMessageControl);
}

const null_entry noh_null_state_functions[] = { NULL_ENTRY(Enable),
                                                NULL_ENTRY(Disable),
                                                NULL_ENTRY(BlendEquation),
                                                NULL_ENTRY(DepthFunc),
                                                NULL_ENTRY(DepthMask),
                                                NULL_ENTRY(CullFace),
                                                NULL_ENTRY(FrontFace),
                                                NULL_ENTRY(BlendFunc),
                                                NULL_ENTRY(BlendEquationSeparate),
                                                NULL_ENTRY(DepthRangef),
                                                NULL_ENTRY(BindSampler),
                                                NULL_ENTRY(IsEnabled),
                                                NULL_ENTRY(GetFloatv),
                                                NULL_ENTRY(GetIntegeri_v),
                                                NULL_ENTRY(PolygonOffset),
                                                NULL_ENTRY(BlendFuncSeparate),
                                                NULL_ENTRY(ColorMask),
                                                NULL_ENTRY(ClearColor),
                                                NULL_ENTRY(PixelStorei),
                                                NULL_ENTRY(VertexAttrib4f),
                                                NULL_ENTRY(VertexAttribI4i),
                                                NULL_ENTRY(Viewport),
                                                NULL_ENTRY(Scissor),
                                                NULL_ENTRY(Flush),
                                                NULL_ENTRY(Finish),
                                                NULL_ENTRY(GetError),
                                                NULL_ENTRY(GetString),
                                                NULL_ENTRY(GetStringi),
                                                NULL_ENTRY(GetIntegerv),
                                                NULL_ENTRY(PushDebugGroup),
                                                NULL_ENTRY(PopDebugGroup),
                                                NULL_ENTRY(DebugMessageCallback),
                                                NULL_ENTRY(DebugMessageControl),
                                                { NULL, NULL } };
