/* null_programs.c: shaders, programs and uniforms of the GL that does nothing. */
#include "null_internal.h"

#include <string.h>

/* --- shaders and programs --- */

static GLuint GL_APIENTRY null_CreateShader(GLenum type)
{
    noh_platform_context *c = noh_null_count(NULL_CreateShader);
    GLuint name = noh_null_make(NULL_CreateShader, NOH_NULL_SHADER);
    c->objects[NOH_NULL_SHADER][name].type = type;
    c->objects[NOH_NULL_SHADER][name].bound = 1;
    return name;
}

static GLuint GL_APIENTRY null_CreateProgram(void)
{
    noh_platform_context *c = noh_null_count(NULL_CreateProgram);
    GLuint name = noh_null_make(NULL_CreateProgram, NOH_NULL_PROGRAM);
    c->objects[NOH_NULL_PROGRAM][name].bound = 1;
    return name;
}

static void GL_APIENTRY null_ShaderSource(GLuint shader, GLsizei count, const GLchar *const *texts,
                                          const GLint *lengths)
{
    (void)lengths;
    noh_null_count(NULL_ShaderSource);
    null_object *object = noh_null_object(NULL_ShaderSource, NOH_NULL_SHADER, shader);
    if (count < 1 || !texts[0] || memcmp(texts[0], "#version", 8) != 0) {
        noh_null_wrong(NULL_ShaderSource, "the text does not begin with #version");
    } else if (object) {
        object->bytes = 0;
        object->levels = count; /* has a source */
    }
}

static void GL_APIENTRY null_CompileShader(GLuint shader)
{
    noh_null_count(NULL_CompileShader);
    null_object *object = noh_null_object(NULL_CompileShader, NOH_NULL_SHADER, shader);
    if (object && !object->levels) noh_null_wrong(NULL_CompileShader, "the shader has no text");
    if (object) object->ready = 1;
}

static void GL_APIENTRY null_AttachShader(GLuint program, GLuint shader)
{
    noh_null_count(NULL_AttachShader);
    null_object *p = noh_null_object(NULL_AttachShader, NOH_NULL_PROGRAM, program);
    const null_object *s = noh_null_object(NULL_AttachShader, NOH_NULL_SHADER, shader);
    if (!p || !s) return;
    if (!s->ready) noh_null_wrong(NULL_AttachShader, "the shader is not compiled");
    p->stages |= s->type == GL_VERTEX_SHADER ? 1u : s->type == GL_FRAGMENT_SHADER ? 2u : 4u;
}

static void GL_APIENTRY null_LinkProgram(GLuint program)
{
    noh_null_count(NULL_LinkProgram);
    null_object *object = noh_null_object(NULL_LinkProgram, NOH_NULL_PROGRAM, program);
    if (object && (object->stages & 3u) != 3u)
        noh_null_wrong(NULL_LinkProgram, "a vertex or fragment shader is missing");
    if (object) object->ready = 1;
}

static void GL_APIENTRY null_UseProgram(GLuint program)
{
    noh_platform_context *c = noh_null_count(NULL_UseProgram);
    const null_object *object = program ? noh_null_object(NULL_UseProgram, NOH_NULL_PROGRAM, program) : NULL;
    if (object && !object->ready) noh_null_wrong(NULL_UseProgram, "the program is not linked");
    c->program = program;
}

static void GL_APIENTRY null_DeleteShader(GLuint shader)
{
    noh_null_delete(NULL_DeleteShader, NOH_NULL_SHADER, 1, &shader);
}

static void GL_APIENTRY null_DeleteProgram(GLuint program)
{
    noh_null_delete(NULL_DeleteProgram, NOH_NULL_PROGRAM, 1, &program);
}

static void GL_APIENTRY null_GetShaderiv(GLuint shader, GLenum what, GLint *value)
{
    noh_null_count(NULL_GetShaderiv);
    const null_object *object = noh_null_object(NULL_GetShaderiv, NOH_NULL_SHADER, shader);
    *value = object && what == GL_COMPILE_STATUS ? object->ready : 0;
}

static void GL_APIENTRY null_GetProgramiv(GLuint program, GLenum what, GLint *value)
{
    noh_null_count(NULL_GetProgramiv);
    const null_object *object = noh_null_object(NULL_GetProgramiv, NOH_NULL_PROGRAM, program);
    *value = object && what == GL_LINK_STATUS ? object->ready : 0;
}

static void empty_log(GLsizei room, GLsizei *length, GLchar *log)
{
    if (length) *length = 0;
    if (room > 0) log[0] = 0;
}

static void GL_APIENTRY null_GetShaderInfoLog(GLuint shader, GLsizei room, GLsizei *length, GLchar *log)
{
    noh_null_count(NULL_GetShaderInfoLog);
    noh_null_object(NULL_GetShaderInfoLog, NOH_NULL_SHADER, shader);
    empty_log(room, length, log);
}

static void GL_APIENTRY null_GetProgramInfoLog(GLuint program, GLsizei room, GLsizei *length, GLchar *log)
{
    noh_null_count(NULL_GetProgramInfoLog);
    noh_null_object(NULL_GetProgramInfoLog, NOH_NULL_PROGRAM, program);
    empty_log(room, length, log);
}

static void GL_APIENTRY null_TransformFeedbackVaryings(GLuint program, GLsizei count, const GLchar *const *names,
                                                       GLenum mode)
{
    (void)count;
    (void)names;
    (void)mode;
    noh_null_count(NULL_TransformFeedbackVaryings);
    const null_object *object = noh_null_object(NULL_TransformFeedbackVaryings, NOH_NULL_PROGRAM, program);
    if (object && object->ready) noh_null_wrong(NULL_TransformFeedbackVaryings, "the program is already linked");
}

static void GL_APIENTRY null_GetActiveAttrib(GLuint program, GLuint index, GLsizei room, GLsizei *length, GLint *size,
                                             GLenum *type, GLchar *name)
{
    (void)index;
    (void)size;
    (void)type;
    noh_null_count(NULL_GetActiveAttrib);
    noh_null_object(NULL_GetActiveAttrib, NOH_NULL_PROGRAM, program);
    noh_null_wrong(NULL_GetActiveAttrib, "the null platform does not parse shaders and has no active attributes");
    empty_log(room, length, name);
}

/* Every name has a location, because the null platform does not parse shaders. */
static GLint find(int call, GLuint program)
{
    noh_null_count(call);
    const null_object *object = noh_null_object(call, NOH_NULL_PROGRAM, program);
    if (object && !object->ready) noh_null_wrong(call, "the program is not linked");
    return 0;
}

static GLint GL_APIENTRY null_GetUniformLocation(GLuint program, const GLchar *name)
{
    (void)name;
    return find(NULL_GetUniformLocation, program);
}

static GLint GL_APIENTRY null_GetAttribLocation(GLuint program, const GLchar *name)
{
    (void)name;
    return find(NULL_GetAttribLocation, program);
}

static GLuint GL_APIENTRY null_GetUniformBlockIndex(GLuint program, const GLchar *name)
{
    (void)name;
    return (GLuint)find(NULL_GetUniformBlockIndex, program);
}

static void GL_APIENTRY null_UniformBlockBinding(GLuint program, GLuint block, GLuint binding)
{
    (void)block;
    (void)binding;
    find(NULL_UniformBlockBinding, program);
}

/* --- uniforms --- */

static void uniform(int call, GLint location)
{
    const noh_platform_context *c = noh_null_count(call);
    if (!c->program) noh_null_wrong(call, "no program in use");
    if (location < -1) noh_null_wrong(call, "location %d", location);
}

#define UNIFORM1(Name, T)                                     \
    static void GL_APIENTRY null_Uniform##Name(GLint at, T x) \
    {                                                         \
        (void)x;                                              \
        uniform(NULL_Uniform##Name, at);                      \
    }
#define UNIFORM2(Name, T)                                          \
    static void GL_APIENTRY null_Uniform##Name(GLint at, T x, T y) \
    {                                                              \
        (void)x, (void)y;                                          \
        uniform(NULL_Uniform##Name, at);                           \
    }
#define UNIFORM3(Name, T)                                               \
    static void GL_APIENTRY null_Uniform##Name(GLint at, T x, T y, T z) \
    {                                                                   \
        (void)x, (void)y, (void)z;                                      \
        uniform(NULL_Uniform##Name, at);                                \
    }
#define UNIFORM4(Name, T)                                                    \
    static void GL_APIENTRY null_Uniform##Name(GLint at, T x, T y, T z, T w) \
    {                                                                        \
        (void)x, (void)y, (void)z, (void)w;                                  \
        uniform(NULL_Uniform##Name, at);                                     \
    }
#define UNIFORMV(Name, T)                                                              \
    static void GL_APIENTRY null_Uniform##Name(GLint at, GLsizei count, const T *data) \
    {                                                                                  \
        (void)data;                                                                    \
        uniform(NULL_Uniform##Name, at);                                               \
        if (count < 1) noh_null_wrong(NULL_Uniform##Name, "count %d", count);          \
    }
#define UNIFORM_MATRIX(Name)                                                                                      \
    static void GL_APIENTRY null_UniformMatrix##Name(GLint at, GLsizei count, GLboolean turned, const GLfloat *m) \
    {                                                                                                             \
        (void)count, (void)turned, (void)m;                                                                       \
        uniform(NULL_UniformMatrix##Name, at);                                                                    \
    }
UNIFORM1(1i, GLint)
UNIFORM1(1ui, GLuint)
UNIFORM1(1f, GLfloat)
UNIFORM2(2i, GLint)
UNIFORM2(2ui, GLuint)
UNIFORM2(2f, GLfloat)
UNIFORM3(3i, GLint)
UNIFORM3(3f, GLfloat)
UNIFORM4(4i, GLint)
UNIFORM4(4ui, GLuint)
UNIFORM4(4f, GLfloat)
UNIFORMV(1iv, GLint)
UNIFORMV(1uiv, GLuint)
UNIFORMV(1fv, GLfloat)
UNIFORMV(3fv, GLfloat)
UNIFORMV(4iv, GLint)
UNIFORMV(4uiv, GLuint)
UNIFORMV(4fv, GLfloat)
UNIFORM_MATRIX(3fv)
UNIFORM_MATRIX(4fv)

const null_entry noh_null_program_functions[] = {
    NULL_ENTRY(CreateShader),        NULL_ENTRY(CreateProgram),
    NULL_ENTRY(ShaderSource),        NULL_ENTRY(CompileShader),
    NULL_ENTRY(AttachShader),        NULL_ENTRY(LinkProgram),
    NULL_ENTRY(UseProgram),          NULL_ENTRY(DeleteShader),
    NULL_ENTRY(DeleteProgram),       NULL_ENTRY(GetShaderiv),
    NULL_ENTRY(GetProgramiv),        NULL_ENTRY(GetShaderInfoLog),
    NULL_ENTRY(GetProgramInfoLog),   NULL_ENTRY(TransformFeedbackVaryings),
    NULL_ENTRY(GetUniformLocation),  NULL_ENTRY(GetActiveAttrib),
    NULL_ENTRY(GetAttribLocation),   NULL_ENTRY(GetUniformBlockIndex),
    NULL_ENTRY(UniformBlockBinding), NULL_ENTRY(Uniform1i),
    NULL_ENTRY(Uniform1ui),          NULL_ENTRY(Uniform1f),
    NULL_ENTRY(Uniform2i),           NULL_ENTRY(Uniform2ui),
    NULL_ENTRY(Uniform2f),           NULL_ENTRY(Uniform3i),
    NULL_ENTRY(Uniform3f),           NULL_ENTRY(Uniform4i),
    NULL_ENTRY(Uniform4ui),          NULL_ENTRY(Uniform4f),
    NULL_ENTRY(Uniform1iv),          NULL_ENTRY(Uniform1uiv),
    NULL_ENTRY(Uniform1fv),          NULL_ENTRY(Uniform3fv),
    NULL_ENTRY(Uniform4iv),          NULL_ENTRY(Uniform4uiv),
    NULL_ENTRY(Uniform4fv),          NULL_ENTRY(UniformMatrix3fv),
    NULL_ENTRY(UniformMatrix4fv),    { NULL, NULL }
};
