/* gl_api.h: the table of OpenGL ES functions used by noh.
 *
 *   noh_gl_api_load       fill the table through the caller's lookup function
 *   noh_gl_has_extension  whether the context lists an extension
 *   noh_gl_error_take     return the oldest GL error and clear all
 *   noh_gl_error_check    return pending GL errors as a noh_result
 *
 * The library links no GL: the application makes a context current and passes a lookup function. The table is a plain
 * struct in the caller's memory and belongs to the context. Call through it: `gl->DrawArrays(GL_TRIANGLES, 0, 3)`.
 *
 * noh's headers include no GL header, define no GL_ names and declare no GL types, so noh works with any GL header and
 * loader, in any order. Include your own for names such as GL_TRIANGLES. In noh's headers GLenum and GLuint are
 * unsigned, GLint and GLsizei int, GLsizeiptr ptrdiff_t, as in all GL headers.
 *
 * Threads: the context's own thread, for every function. */
#ifndef NOH_GL_GL_API_H
#define NOH_GL_GL_API_H

#include <stddef.h>

#include "core/base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The calling convention of GL functions; GL_APIENTRY in GL headers. */
#if defined(_WIN32) && !defined(_WIN64)
#define NOH_GL_CALL __stdcall
#else
#define NOH_GL_CALL
#endif

struct __GLsync; /* GLsync points to it */

/* GLDEBUGPROC: source, type, id, severity, length, message, user */
typedef void(NOH_GL_CALL *noh_gl_debug_callback)(unsigned, unsigned, unsigned, unsigned, int, const char *,
                                                 const void *);

/* Desktop OpenGL: vertex shaders set the point size, as they always do in OpenGL ES. */
#define NOH_GL_PROGRAM_POINT_SIZE 0x8642u

/* The functions that the library calls. All are OpenGL ES 3.0 core, and noh_gl_api_load fails if one is missing.
 * X(field, result, parameters) */
#define NOH_GL_REQUIRED(X)                                                                                  \
    /* state */                                                                                             \
    X(Enable, void, (unsigned))                                                                             \
    X(Disable, void, (unsigned))                                                                            \
    X(BlendFunc, void, (unsigned, unsigned))                                                                \
    X(BlendFuncSeparate, void, (unsigned, unsigned, unsigned, unsigned))                                    \
    X(BlendEquation, void, (unsigned))                                                                      \
    X(BlendEquationSeparate, void, (unsigned, unsigned))                                                    \
    X(Viewport, void, (int, int, int, int))                                                                 \
    X(Scissor, void, (int, int, int, int))                                                                  \
    X(DepthFunc, void, (unsigned))                                                                          \
    X(DepthMask, void, (unsigned char))                                                                     \
    X(ColorMask, void, (unsigned char, unsigned char, unsigned char, unsigned char))                        \
    X(FrontFace, void, (unsigned))                                                                          \
    X(DepthRangef, void, (float, float))                                                                    \
    X(ClearBufferfv, void, (unsigned, int, const float *))                                                  \
    X(Flush, void, (void))                                                                                  \
    /* questions */                                                                                         \
    X(GetError, unsigned, (void))                                                                           \
    X(GetString, const unsigned char *, (unsigned))                                                         \
    X(GetStringi, const unsigned char *, (unsigned, unsigned))                                              \
    X(GetIntegerv, void, (unsigned, int *))                                                                 \
    X(GetIntegeri_v, void, (unsigned, unsigned, int *))                                                     \
    X(GetFloatv, void, (unsigned, float *))                                                                 \
    X(IsEnabled, unsigned char, (unsigned))                                                                 \
    /* shaders and programs */                                                                              \
    X(CreateShader, unsigned, (unsigned))                                                                   \
    X(ShaderSource, void, (unsigned, int, const char *const *, const int *))                                \
    X(CompileShader, void, (unsigned))                                                                      \
    X(GetShaderiv, void, (unsigned, unsigned, int *))                                                       \
    X(GetShaderInfoLog, void, (unsigned, int, int *, char *))                                               \
    X(DeleteShader, void, (unsigned))                                                                       \
    X(CreateProgram, unsigned, (void))                                                                      \
    X(AttachShader, void, (unsigned, unsigned))                                                             \
    X(LinkProgram, void, (unsigned))                                                                        \
    X(GetProgramiv, void, (unsigned, unsigned, int *))                                                      \
    X(GetProgramInfoLog, void, (unsigned, int, int *, char *))                                              \
    X(UseProgram, void, (unsigned))                                                                         \
    X(DeleteProgram, void, (unsigned))                                                                      \
    X(GetActiveAttrib, void, (unsigned, unsigned, int, int *, int *, unsigned *, char *))                   \
    X(GetAttribLocation, int, (unsigned, const char *))                                                     \
    X(GetUniformLocation, int, (unsigned, const char *))                                                    \
    X(GetUniformBlockIndex, unsigned, (unsigned, const char *))                                             \
    X(UniformBlockBinding, void, (unsigned, unsigned, unsigned))                                            \
    X(Uniform1i, void, (int, int))                                                                          \
    X(Uniform1f, void, (int, float))                                                                        \
    X(Uniform2i, void, (int, int, int))                                                                     \
    X(Uniform3i, void, (int, int, int, int))                                                                \
    X(Uniform4i, void, (int, int, int, int, int))                                                           \
    X(Uniform2f, void, (int, float, float))                                                                 \
    X(Uniform3f, void, (int, float, float, float))                                                          \
    X(Uniform4f, void, (int, float, float, float, float))                                                   \
    X(Uniform3fv, void, (int, int, const float *))                                                          \
    X(Uniform4fv, void, (int, int, const float *))                                                          \
    X(UniformMatrix4fv, void, (int, int, unsigned char, const float *))                                     \
    /* buffers */                                                                                           \
    X(GenBuffers, void, (int, unsigned *))                                                                  \
    X(DeleteBuffers, void, (int, const unsigned *))                                                         \
    X(BindBuffer, void, (unsigned, unsigned))                                                               \
    X(BindBufferBase, void, (unsigned, unsigned, unsigned))                                                 \
    X(BindBufferRange, void, (unsigned, unsigned, unsigned, ptrdiff_t, ptrdiff_t))                          \
    X(BufferData, void, (unsigned, ptrdiff_t, const void *, unsigned))                                      \
    X(BufferSubData, void, (unsigned, ptrdiff_t, ptrdiff_t, const void *))                                  \
    /* vertices */                                                                                          \
    X(GenVertexArrays, void, (int, unsigned *))                                                             \
    X(DeleteVertexArrays, void, (int, const unsigned *))                                                    \
    X(BindVertexArray, void, (unsigned))                                                                    \
    X(EnableVertexAttribArray, void, (unsigned))                                                            \
    X(VertexAttribPointer, void, (unsigned, int, unsigned, unsigned char, int, const void *))               \
    X(VertexAttribIPointer, void, (unsigned, int, unsigned, int, const void *))                             \
    X(VertexAttribDivisor, void, (unsigned, unsigned))                                                      \
    X(VertexAttrib4f, void, (unsigned, float, float, float, float))                                         \
    X(VertexAttribI4i, void, (unsigned, int, int, int, int))                                                \
    /* textures */                                                                                          \
    X(GenTextures, void, (int, unsigned *))                                                                 \
    X(DeleteTextures, void, (int, const unsigned *))                                                        \
    X(ActiveTexture, void, (unsigned))                                                                      \
    X(BindTexture, void, (unsigned, unsigned))                                                              \
    X(BindSampler, void, (unsigned, unsigned))                                                              \
    X(TexStorage2D, void, (unsigned, int, unsigned, int, int))                                              \
    X(TexStorage3D, void, (unsigned, int, unsigned, int, int, int))                                         \
    X(TexSubImage2D, void, (unsigned, int, int, int, int, int, unsigned, unsigned, const void *))           \
    X(TexSubImage3D, void, (unsigned, int, int, int, int, int, int, int, unsigned, unsigned, const void *)) \
    X(CompressedTexSubImage2D, void, (unsigned, int, int, int, int, int, unsigned, int, const void *))      \
    X(TexParameteri, void, (unsigned, unsigned, int))                                                       \
    X(PixelStorei, void, (unsigned, int))                                                                   \
    /* framebuffers */                                                                                      \
    X(GenFramebuffers, void, (int, unsigned *))                                                             \
    X(DeleteFramebuffers, void, (int, const unsigned *))                                                    \
    X(BindFramebuffer, void, (unsigned, unsigned))                                                          \
    X(FramebufferTexture2D, void, (unsigned, unsigned, unsigned, unsigned, int))                            \
    X(FramebufferTextureLayer, void, (unsigned, unsigned, unsigned, int, int))                              \
    X(CheckFramebufferStatus, unsigned, (unsigned))                                                         \
    X(DrawBuffers, void, (int, const unsigned *))                                                           \
    X(ReadBuffer, void, (unsigned))                                                                         \
    X(ReadPixels, void, (int, int, int, int, unsigned, unsigned, void *))                                   \
    X(GenRenderbuffers, void, (int, unsigned *))                                                            \
    X(DeleteRenderbuffers, void, (int, const unsigned *))                                                   \
    X(BindRenderbuffer, void, (unsigned, unsigned))                                                         \
    X(RenderbufferStorageMultisample, void, (unsigned, int, unsigned, int, int))                            \
    /* draws */                                                                                             \
    X(DrawElements, void, (unsigned, int, unsigned, const void *))                                          \
    X(DrawElementsInstanced, void, (unsigned, int, unsigned, const void *, int))                            \
    X(DrawArraysInstanced, void, (unsigned, int, int, int))                                                 \
    /* transform feedback */                                                                                \
    X(TransformFeedbackVaryings, void, (unsigned, int, const char *const *, unsigned))

/* More ES 3.0 functions for renderers, which the library never calls; NULL if the lookup does not find them. */
#define NOH_GL_EXTRA(X)                                                                     \
    /* state */                                                                             \
    X(PolygonOffset, void, (float, float))                                                  \
    X(CullFace, void, (unsigned))                                                           \
    X(ClearColor, void, (float, float, float, float))                                       \
    X(ClearDepthf, void, (float))                                                           \
    X(Clear, void, (unsigned))                                                              \
    X(ClearBufferuiv, void, (unsigned, int, const unsigned *))                              \
    X(ClearBufferiv, void, (unsigned, int, const int *))                                    \
    X(ClearBufferfi, void, (unsigned, int, float, int))                                     \
    X(Finish, void, (void))                                                                 \
    /* questions */                                                                         \
    X(GetInteger64v, void, (unsigned, int64_t *))                                           \
    /* shaders and programs */                                                              \
    X(DetachShader, void, (unsigned, unsigned))                                             \
    X(BindAttribLocation, void, (unsigned, unsigned, const char *))                         \
    X(GetActiveUniformBlockiv, void, (unsigned, unsigned, unsigned, int *))                 \
    X(Uniform1iv, void, (int, int, const int *))                                            \
    X(Uniform4iv, void, (int, int, const int *))                                            \
    X(Uniform1ui, void, (int, unsigned))                                                    \
    X(Uniform2ui, void, (int, unsigned, unsigned))                                          \
    X(Uniform4ui, void, (int, unsigned, unsigned, unsigned, unsigned))                      \
    X(Uniform1uiv, void, (int, int, const unsigned *))                                      \
    X(Uniform4uiv, void, (int, int, const unsigned *))                                      \
    X(Uniform1fv, void, (int, int, const float *))                                          \
    X(UniformMatrix3fv, void, (int, int, unsigned char, const float *))                     \
    /* buffers */                                                                           \
    X(CopyBufferSubData, void, (unsigned, unsigned, ptrdiff_t, ptrdiff_t, ptrdiff_t))       \
    X(FlushMappedBufferRange, void, (unsigned, ptrdiff_t, ptrdiff_t))                       \
    /* vertices */                                                                          \
    X(DisableVertexAttribArray, void, (unsigned))                                           \
    X(VertexAttrib4fv, void, (unsigned, const float *))                                     \
    /* textures */                                                                          \
    X(CopyTexSubImage3D, void, (unsigned, int, int, int, int, int, int, int, int))          \
    X(GenSamplers, void, (int, unsigned *))                                                 \
    X(DeleteSamplers, void, (int, const unsigned *))                                        \
    X(SamplerParameteri, void, (unsigned, unsigned, int))                                   \
    /* framebuffers */                                                                      \
    X(FramebufferRenderbuffer, void, (unsigned, unsigned, unsigned, unsigned))              \
    X(BlitFramebuffer, void, (int, int, int, int, int, int, int, int, unsigned, unsigned))  \
    X(InvalidateFramebuffer, void, (unsigned, int, const unsigned *))                       \
    X(RenderbufferStorage, void, (unsigned, unsigned, int, int))                            \
    X(GetInternalformativ, void, (unsigned, unsigned, unsigned, int, int *))                \
    /* draws */                                                                             \
    X(DrawArrays, void, (unsigned, int, int))                                               \
    X(DrawRangeElements, void, (unsigned, unsigned, unsigned, int, unsigned, const void *)) \
    /* transform feedback */                                                                \
    X(BeginTransformFeedback, void, (unsigned))                                             \
    X(EndTransformFeedback, void, (void))                                                   \
    /* queries */                                                                           \
    X(GenQueries, void, (int, unsigned *))                                                  \
    X(DeleteQueries, void, (int, const unsigned *))                                         \
    X(BeginQuery, void, (unsigned, unsigned))                                               \
    X(EndQuery, void, (unsigned))                                                           \
    X(GetQueryObjectuiv, void, (unsigned, unsigned, unsigned *))

/* Optional functions; NULL if the context lacks them. The loader decides by the version and the extension strings,
 * because most lookups return a stub for any name. A field may hold the core function or its KHR, EXT or OES form.
 * X(field, result, parameters, name without suffix, group) */
#define NOH_GL_OPTIONAL(X)                                                                                             \
    X(MapBufferRange, void *, (unsigned, ptrdiff_t, ptrdiff_t, unsigned), "glMapBufferRange", NOH_GL_GROUP_MAP)        \
    X(UnmapBuffer, unsigned char, (unsigned), "glUnmapBuffer", NOH_GL_GROUP_MAP)                                       \
    X(FenceSync, struct __GLsync *, (unsigned, unsigned), "glFenceSync", NOH_GL_GROUP_MAP)                             \
    X(ClientWaitSync, unsigned, (struct __GLsync *, unsigned, uint64_t), "glClientWaitSync", NOH_GL_GROUP_MAP)         \
    X(DeleteSync, void, (struct __GLsync *), "glDeleteSync", NOH_GL_GROUP_MAP)                                         \
    X(FramebufferTexture, void, (unsigned, unsigned, unsigned, int), "glFramebufferTexture", NOH_GL_GROUP_GEOMETRY)    \
    X(ClipControl, void, (unsigned, unsigned), "glClipControl", NOH_GL_GROUP_CLIP)                                     \
    X(ObjectLabel, void, (unsigned, unsigned, int, const char *), "glObjectLabel", NOH_GL_GROUP_DEBUG)                 \
    X(PushDebugGroup, void, (unsigned, unsigned, int, const char *), "glPushDebugGroup", NOH_GL_GROUP_DEBUG)           \
    X(PopDebugGroup, void, (void), "glPopDebugGroup", NOH_GL_GROUP_DEBUG)                                              \
    X(DebugMessageCallback, void, (noh_gl_debug_callback, const void *), "glDebugMessageCallback", NOH_GL_GROUP_DEBUG) \
    X(DebugMessageControl, void, (unsigned, unsigned, unsigned, int, const unsigned *, unsigned char),                 \
      "glDebugMessageControl", NOH_GL_GROUP_DEBUG)                                                                     \
    X(TimeGenQueries, void, (int, unsigned *), "glGenQueries", NOH_GL_GROUP_TIMER)                                     \
    X(TimeDeleteQueries, void, (int, const unsigned *), "glDeleteQueries", NOH_GL_GROUP_TIMER)                         \
    X(TimeBeginQuery, void, (unsigned, unsigned), "glBeginQuery", NOH_GL_GROUP_TIMER)                                  \
    X(TimeEndQuery, void, (unsigned), "glEndQuery", NOH_GL_GROUP_TIMER)                                                \
    X(TimeGetQueryiv, void, (unsigned, unsigned, int *), "glGetQueryiv", NOH_GL_GROUP_TIMER)                           \
    X(TimeGetQueryObjectuiv, void, (unsigned, unsigned, unsigned *), "glGetQueryObjectuiv", NOH_GL_GROUP_TIMER)        \
    X(TimeGetQueryObjectui64v, void, (unsigned, unsigned, uint64_t *), "glGetQueryObjectui64v", NOH_GL_GROUP_TIMER)

typedef struct noh_gl_api {
#define NOH_GL_FIELD(field, result, parameters) result(NOH_GL_CALL *field) parameters;
    NOH_GL_REQUIRED(NOH_GL_FIELD)
    NOH_GL_EXTRA(NOH_GL_FIELD)
#undef NOH_GL_FIELD
#define NOH_GL_FIELD(field, result, parameters, name, group) result(NOH_GL_CALL *field) parameters;
    NOH_GL_OPTIONAL(NOH_GL_FIELD)
#undef NOH_GL_FIELD

    int version;      /* major * 100 + minor * 10: ES 3.2 is 320, desktop 4.5 is 450 */
    int is_es;        /* 0 on a desktop GL that also compiles ES shaders (OSMesa) */
    int geometry_ext; /* geometry shaders need "#extension GL_EXT_geometry_shader" (1) or "GL_OES_geometry_shader" (2);
                       * 0 if core or absent */
    int etc2;         /* 1: the context supports ETC2 and EAC textures, as OpenGL ES does, desktop GL from 4.3 or with
                       * GL_ARB_ES3_compatibility, and WebGL 2 with WEBGL_compressed_texture_etc */

    /* Decoder for contexts without ETC2. NULL after noh_gl_api_load: set it to noh_etc2_decode (etc2.h) before making
     * textures; otherwise the decoder is not linked. */
    void (*decode)(uint32_t format, const uint8_t *blocks, uint32_t count, uint8_t *texels);
} noh_gl_api;

/* Any GL function; cast it to its own type before the call. */
typedef void (*noh_gl_proc)(void);

/* The caller's lookup function, such as a wrapper of eglGetProcAddress. Returns NULL for an unknown name. */
typedef noh_gl_proc (*noh_gl_get_proc)(void *user, const char *name);

/* Fill the table for the current context of this thread. `user` is passed to `get`.
 * memory  none; `api` is untouched on error
 * errors  ARG api or get is NULL; UNSUPPORTED the context is below ES 3.0, or lacks a function of NOH_GL_REQUIRED
 *         (named by `what`); GL no context is current */
noh_result noh_gl_api_load(noh_gl_api *api, noh_gl_get_proc get, void *user, noh_error *error);

/* 1 if the context lists the extension, otherwise 0. name: in full, "GL_EXT_...". */
int noh_gl_has_extension(const noh_gl_api *api, const char *name);

/* Return the oldest pending GL error, or GL_NO_ERROR, and clear the rest. Calls glGetError at most 16 times, because a
 * lost context may report errors forever. */
unsigned noh_gl_error_take(const noh_gl_api *api);

/* Return pending GL errors as a noh_result and clear them. Every create function clears pending errors first and calls
 * this last, so it never returns NOH_OK after the driver refused a call.
 * errors  MEMORY GL_OUT_OF_MEMORY; GL any other error. `where` is the GL error; `what` and `need` are the arguments */
noh_result noh_gl_error_check(const noh_gl_api *api, const char *what, uint64_t need, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
