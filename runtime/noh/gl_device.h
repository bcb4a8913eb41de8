/* gl_device.h: the driver: functions, capabilities, state, lost contexts, time, GLSL for shaders of your own.
 * Included by noh_gl.h. */

#ifndef NOH_GL_DEVICE_H
#define NOH_GL_DEVICE_H

#include <stddef.h>
#include <stdint.h>

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== functions of GL ========
 * The table of OpenGL ES functions used by noh.
 *
 *   noh_gl_api_load       fill the table through the caller's lookup function
 *   noh_gl_error_take     return the oldest GL error and clear all
 *
 * The library links no GL: the application makes a context current and passes a lookup function. The table is a plain
 * struct in the caller's memory and belongs to the context. Call through it: `gl->DrawArrays(GL_TRIANGLES, 0, 3)`.
 *
 * noh's headers include no GL header, define no GL_ names and declare no GL types, so noh works with any GL header and
 * loader, in any order. Include your own for names such as GL_TRIANGLES. In noh's headers GLenum and GLuint are
 * unsigned, GLint and GLsizei int, GLsizeiptr ptrdiff_t, as in all GL headers.
 *
 * Threads: the context's own thread, for every function. */

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
    int astc;         /* 1: the context supports LDR ASTC textures, as OpenGL ES 3.2 does, others with
                       * GL_KHR_texture_compression_astc_ldr, and WebGL 2 with WEBGL_compressed_texture_astc */

    /* Decoder for contexts without ETC2. NULL after noh_gl_api_load: set it to noh_etc2_decode (low_core.h) before
     * making textures; otherwise the decoder is not linked. */
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

/* Return the oldest pending GL error, or GL_NO_ERROR, and clear the rest. Calls glGetError at most 16 times, because a
 * lost context may report errors forever. */
unsigned noh_gl_error_take(const noh_gl_api *api);

/* ======== what a GPU can do ========
 * Capabilities of a context.
 *
 *   noh_gl_caps_probe  read the limits and test each capability: draw and read back
 *
 * Extension strings can be wrong either way: OSMesa blends floats without listing the extension, and some drivers list
 * formats that they cannot render. So each capability is tested once, on 16 texels. The struct is plain data: a test,
 * or a game that knows of a driver bug, may clear any field after the probe.
 *
 * Threads: the context's own thread, for every function. */

typedef struct noh_gl_caps {
    int version;     /* major * 100 + minor * 10 */
    int is_es;       /* 0: desktop GL */
    char vendor[64]; /* GL_VENDOR, GL_RENDERER and GL_VERSION, cut to fit */
    char renderer[128];
    char version_text[128];
    uint64_t renderer_hash; /* FNV-1a 64 of the three uncut texts, as a key for per-driver measurements */

    uint32_t texture_size_max;
    uint32_t array_layers_max;
    uint32_t draw_buffers_max;
    uint32_t color_attachments_max;
    uint32_t samples_max;
    uint32_t vertex_textures_max;
    uint32_t vertex_attributes_max;
    uint32_t uniform_block_bytes_max;
    uint32_t uniform_offset_align; /* bytes, for glBindBufferRange */

    /* 1 or 0. Each is tested with three layers of one array texture as the draw buffers, `layered` with gl_Layer. */
    int mrt3;            /* three draw buffers work in at least one format */
    int render_f32;      /* RGBA32F stores written values bit for bit */
    int render_f16;      /* RGBA16F stores them within the precision of a half */
    int render_u32;      /* RGBA32UI stores them, which ES 3.0 guarantees */
    int blend_f32;       /* blending ONE, ONE into RGBA32F adds */
    int blend_f16;       /* blending ONE, ONE into RGBA16F adds */
    int blend_f32_exact; /* blend_f32, with the bits of C's float addition */
    int layered;         /* a geometry shader can draw to all three layers by gl_Layer */
    int block_points;    /* a point of size 4 covers exactly the 4 x 4 texels around its centre, once each */
    int timer_query;     /* EXT_disjoint_timer_query, or desktop GL's */
    int etc2, astc;      /* not tested: of noh_gl_api, for plans of textures */

    /* How this GPU rounds a float to a half. UNKNOWN: like none of the models, so results are known only within a
     * bound. */
    noh_half_mode f16_store_mode; /* half(source) */
    noh_half_mode f16_blend_mode; /* half(stored + source), the sum in fp32 */
} noh_gl_caps;

/* Probe the capabilities of the current context. A missing capability is a 0 in its field, not an error.
 * memory  none; about 5 KiB of stack. All GL objects it makes are deleted
 * errors  ARG api or out is NULL; GL the driver cannot run the probe's programs */
noh_result noh_gl_caps_probe(const noh_gl_api *api, noh_gl_caps *out, noh_error *error);

/* Get capabilities for planning without a context, such as on a build machine: an OpenGL ES 3.2 device with every
 * feature, and limits and texture sizes as guaranteed by ES 3.0. The player's GPU may lead to another plan; make stages
 * with a plan of probed capabilities. */
void noh_gl_caps_nominal(noh_gl_caps *out);

/* ======== a lost context ========
 * Recovery after a lost context.
 *
 * All GL objects of a lost context are gone; packs, weights and poses in your memory stay valid. Make a new context,
 * fill the same noh_gl_api with noh_gl_api_load (objects point to this table), and restore each object before you draw
 * (drivers may crash on the old names):
 *
 *   noh_gl_mesh_restore, noh_gl_picture_restore, noh_gl_renderer_restore  low_gl.h
 *   noh_gl_morph_restore                                                  low_gl.h
 *   noh_gl_skin_restore                                                   low_gl.h
 *
 * Each removes the old names from the ledger without calling GL, because in the new context these names may belong to
 * other objects, and makes new objects from the pack. The ledger then has the same bytes as before. The new context
 * must have the same capabilities as the old one: probe it with noh_gl_caps_probe. If they differ, or if there is no
 * new context, release the objects without calling GL and plan again: copy the table below over your own, then delete
 * the objects, or the stage (noh_stage_delete).
 *
 *   noh_gl_lost_api  a table whose delete functions do nothing
 *
 * Threads: any; the table's functions do nothing. */

/* A table whose delete functions do nothing; all other functions are NULL. */
const noh_gl_api *noh_gl_lost_api(void);

/* ======== GL objects ======== */

/* Counts and bytes of the existing GL objects. Start with zeros. */
typedef struct noh_gl_ledger {
    uint64_t buffer_bytes, texture_bytes, renderbuffer_bytes;
    uint32_t buffers, textures, renderbuffers, framebuffers, programs;
    /* With stages that share (noh_stage_desc.share): the number of the context. After a lost context add 1 before you
     * make or restore objects in the new one */
    uint32_t contexts;
    struct noh_gl_sharing *sharing; /* private: these stages */
} noh_gl_ledger;

typedef struct noh_gl_buffer {
    unsigned name; /* 0: none */
    uint64_t bytes;
} noh_gl_buffer;

/* A texture with immutable storage. */
typedef struct noh_gl_texture {
    unsigned name; /* 0: none */
    unsigned target : 31;
    unsigned premultiplied : 1; /* colours are multiplied by alpha, as in NOH_TEXTURE_ETC2_RGBA1 */
    uint64_t bytes;
} noh_gl_texture;

/* The context for making objects. The struct is not kept; the table and the ledger must outlive the objects. */
typedef struct noh_gl_device {
    const noh_gl_api *api;
    /* The same for all that is drawn together: render_f16 decides whether shadows are soft. NULL: they are hard, and
     * the device is of no use to noh_gl_morph_init, noh_gl_skin_init and noh_stage_init */
    const noh_gl_caps *caps;
    noh_gl_ledger *ledger;
    char *log; /* [log_bytes] receives compile errors of shaders, as in noh_gl_program_create; NULL: no log */
    size_t log_bytes;
} noh_gl_device;

/* The bytes of all existing objects. */
uint64_t noh_gl_ledger_bytes(const noh_gl_ledger *ledger);

/* ======== GL for a program ========
 * GL as a program needs it, in one object: functions, capabilities, a ledger of bytes, a log of shaders.
 *
 *     static noh_gl gl;
 *     noh_gl_open(&gl, get_proc, NULL, &error)            with a context of OpenGL ES 3 current
 *     noh_stage_init(memory, bytes, &gl.device, ...)
 *
 * Threads: the thread of the GL context. */

#define NOH_GL_LOG_BYTES 4096u

typedef struct noh_gl {
    noh_gl_api api;
    noh_gl_caps caps;
    noh_gl_ledger ledger;
    noh_gl_device device;       /* points to the other members: for each call that makes GL objects */
    char log[NOH_GL_LOG_BYTES]; /* why the last shader was refused; "" if none was */
} noh_gl;

/* Load GL's functions through `get`, find out what the GPU can do, and set up `device` with an empty ledger. *gl must
 * stay where it is: `device` and all objects that are made with it point into it. No object stays on the
 * GPU. After a lost context call only noh_gl_api_load for `api`: the ledger keeps its counts.
 * errors  as noh_gl_api_load and noh_gl_caps_probe: *gl is then undefined, except for an empty log */
noh_result noh_gl_open(noh_gl *gl, noh_gl_get_proc get, void *user, noh_error *error);

/* ======== GL programs ======== */

/* An attribute of a vertex array, as a vertex shader declares it. */
typedef struct noh_gl_input {
    unsigned location;
    unsigned type; /* type of the declaration: GL_FLOAT_VEC3, GL_INT_VEC2, GL_UNSIGNED_INT and so on */
} noh_gl_input;

/* ======== GLSL for shaders of your own ========
 * The library's GLSL files as text.
 *
 *   noh_gl_shader_text      the text of a file of shaders_es/
 *
 * For your own shaders use noh_gl_shader_prefix (low_gl.h), which has all files in order, with the defines for a
 * key. Use single files for what does not fit a noh_gl_mesh: your own vertex formats, or other uses of delta tiles. The
 * text is in the library; nothing is read at run time. Pass the source of a shader to GL in one call:
 *
 *   char defines[NOH_GL_DEFINES_BYTES];
 *   noh_gl_variant_defines(key, defines);
 *   const char *parts[] = { "#version 300 es\n", defines, "precision highp float;\nprecision highp int;\n",
 *                           noh_gl_shader_text("common_delta.glsl"), noh_gl_shader_text("common_walk.glsl"),
 *                           noh_gl_shader_text("common_layers.glsl"), noh_gl_shader_text("common_attributes.glsl"),
 *                           noh_gl_shader_text("common_skin.glsl"), your_text };
 *   glShaderSource(shader, 9, parts, NULL);
 *
 * Threads: any; no GL is called. */

/* The text of a file: GLSL ES 3.00 without a #version line and without comments, a zero-terminated string constant.
 * name    "common_delta.glsl"       delta texels and entries of lists, for the path direct
 *         "common_walk.glsl"        sums by lists, for the path direct; after common_delta.glsl
 *         "common_layers.glsl"      noh_morph_fetch adds an instance's deltas; for the path direct after these two
 *         "common_attributes.glsl"  normals and tangents from the pack's integers
 *         "common_skin.glsl"        noh_skin_vertex moves a vertex by its joints; after common_layers.glsl
 *         "common_face.glsl"        vertex outputs for skin, eyes and teeth; after common_skin.glsl
 *         "common_vertex.glsl"      noh_fetch, the whole vertex of a noh_gl_mesh; after these four
 *         "common_fade.glsl"        noh_fade_noise, the fade pattern of LOD levels
 *         "common_fragment.glsl"    noh_fade, noh_cut, noh_base, noh_encode; after common_fade.glsl
 *         "common_wrinkle.glsl"     wrinkle weights of a pixel; after common_fragment.glsl
 *         "common_environment.glsl" noh_ambient, noh_mirror, noh_key_shadow, noh_expose: the light if NOH_LIT is
 *                                   defined; after common_fragment.glsl
 *         "common_material.glsl"    noh_surface_of, a material's maps; after common_wrinkle.glsl
 *         "common_scatter.glsl"     light scattered in skin; after common_environment.glsl
 *         "common_eye.glsl"         light on eyes and teeth; after common_environment.glsl
 *         "common_light.glsl"       noh_light, the light on a surface; after all of these
 * errors  NULL for any other name */
const char *noh_gl_shader_text(const char *name);

/* ======== GL state ========
 * The GL state that noh needs and leaves, and saving and restoring it.
 *
 *   noh_gl_state_save     save the state that noh's calls may change
 *   noh_gl_state_restore  restore it
 *
 * Render state is yours. Each call sets the state it needs and restores it; it reads only the state it changes, a dozen
 * glGet per frame. Bindings that noh used are left at 0. On entry only the state in the column "uses yours" matters:
 *
 *   call                          uses yours                      sets and puts back            leaves
 *   noh_stage_draw,               draw framebuffer, viewport,     depth test (on), culling,     (1)
 *   noh_gl_draw_begin to _end,    depth function (2), depth       primitive restart;
 *   noh_stage_decals_draw,        mask, depth range, clip         front face, where an
 *   noh_stage_patches_draw,       control, front face, cull       instance is mirrored;
 *   noh_stage_hair_draw,          mode, colour mask, scissor,     in a depth pass the colour
 *   noh_stage_terrain_draw        stencil, polygon offset,        mask; in a blended pass the
 *                                 sRGB write, sample state        depth mask and, where
 *                                 (4), blending (3)               GL_BLEND is off, blending
 *   noh_stage_blob_draw,          the same, except blending     the same, and blending        (1)
 *   noh_stage_floor_draw,         and the depth mask
 *   noh_backdrop_draw
 *   noh_stage_draw_shadow,        cull mode, polygon offset       all else, framebuffers and    (1)
 *   noh_stage_hair_draw_shadow,                                   viewport too
 *   noh_stage_terrain_draw_shadow
 *   noh_stage_frame_end,          nothing                         all, framebuffers and         (1)
 *   noh_gl_morph_update,                                          viewport too; pixel store
 *   noh_gl_skin_update,
 *   noh_gl_caps_probe
 *   _init, _create, _restore,     nothing                         pixel store                   (1), and texture unit 0
 *   _upload                                                                                     or the last used active
 *   noh_gl_mesh_bind, _unbind,    the program                     nothing                       what they bind
 *   noh_gl_morph_bind,
 *   noh_gl_morph_bind_streams
 *   all others                    nothing                         nothing                       what was there
 *
 * (1) None bound: program, vertex array, renderbuffer, uniform buffer 0, the array, uniform, pixel and copy buffers
 *     that were used, and textures and samplers of the used units (below NOH_UNIT_USER, and units that your shader
 *     shares with noh). Undefined: the active unit and the current values of vertex attributes.
 * (2) GL_LESS and GL_GREATER are drawn as GL_LEQUAL and GL_GEQUAL, so that colours can follow a depth pass. For
 *     reversed depth use your own projection, a clear to 0 and GL_GREATER. With GL_EQUAL draw only NOH_PASS_OPAQUE,
 *     after NOH_PASS_DEPTH, which has the same depths to the bit, and NOH_PASS_BLENDED with another function.
 * (3) If GL_BLEND is on, its functions and equations are yours, for each draw buffer. If it is off, blended passes
 *     blend straight alpha, and restore the state of draw buffer 0 for all.
 * (4) With GL_SAMPLE_ALPHA_TO_COVERAGE on, edges of alpha-cut materials are as smooth as the target's samples, and
 *     dithered in a target of one sample; all but opaque passes turn it off. The alpha of smooth edges is written, too:
 *     where a page is seen through the target's alpha, turn off alpha's colour mask, or leave this off. Leave it off
 *     after NOH_PASS_DEPTH: the depth of such an edge is written already, and the background would show through it.
 *
 * No transform feedback may be active. On desktop GL, polygons must be filled (glPolygonMode).
 *
 * Threads: the context's own thread. */

/* Render state that draws change; only the fields in `kept` are valid. */
typedef struct noh_gl_raster {
    uint16_t kept, enabled; /* private bits */
    uint16_t depth_func, front_face;
    uint16_t blend[6];              /* source and destination of colour, of alpha; equation of both */
    uint8_t color_mask, depth_mask; /* bit c: channel c */
} noh_gl_raster;

/* Render state that draws into textures change. */
typedef struct noh_gl_offscreen {
    noh_gl_raster raster;
    int framebuffers[2]; /* draw, read */
    int viewport[4], scissor[4];
    int clip[2]; /* origin and depth mode; 0 without glClipControl */
    float depth_range[2];
} noh_gl_offscreen;

/* Pixel store state. */
typedef struct noh_gl_pixels {
    int unpack[6], unpack_buffer, pack[4], pack_buffer;
} noh_gl_pixels;

#define NOH_GL_STATE_UNITS 16u

typedef struct noh_gl_state {
    noh_gl_offscreen offscreen;
    noh_gl_pixels pixels;
    int program, vertex_array, array_buffer, uniform_buffer, copy_buffers[2], renderbuffer;
    int uniform_range[3]; /* of binding 0: buffer, first byte, bytes (0: all) */
    int active_unit;
    struct {
        int texture_2d, texture_array, texture_cube, sampler;
    } units[NOH_GL_STATE_UNITS];
} noh_gl_state;

/* Save and restore the state that noh's calls may change, except the current values of vertex attributes. Saving takes
 * about a hundred glGet: save once around many calls. Do not restore bindings of objects deleted in between. */
void noh_gl_state_save(const noh_gl_api *api, noh_gl_state *state);
void noh_gl_state_restore(const noh_gl_api *api, const noh_gl_state *state);

#ifdef __cplusplus
}
#endif

#endif
