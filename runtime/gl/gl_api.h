/* gl_api.h: the table of OpenGL ES functions that noh uses.
 *
 *   noh_gl_api_load       fill the table through the caller's lookup function
 *   noh_gl_has_extension  whether the context lists an extension
 *   noh_gl_error_take     return the oldest GL error and clear them all
 *   noh_gl_error_check    the same as a noh_result
 *
 * The library links no GL: the application makes a context current and passes a lookup function. The table is a plain
 * struct in the caller's memory and belongs to that context. Call through it: `gl->DrawArrays(GL_TRIANGLES, 0, 3)`.
 *
 * Threads: the context's own thread, for every function. */
#ifndef NOH_GL_GL_API_H
#define NOH_GL_GL_API_H

#ifndef GL_GLES_PROTOTYPES
#define GL_GLES_PROTOTYPES 0 /* types only: calls go through the table */
#endif
#include <GLES3/gl32.h>
#include <GLES2/gl2ext.h>

#include "base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Of desktop OpenGL: the vertex shader says how large points are. In OpenGL ES it always does. */
#define NOH_GL_PROGRAM_POINT_SIZE 0x8642u

/* What the library itself calls: all of it is OpenGL ES 3.0 core, and noh_gl_api_load refuses a context that lacks any.
 * tests/check_gl_calls.sh compares the list with the calls in runtime/; platform/README.md prints it for porters.
 * X(field, the name as Khronos spells it in the type PFNGL...PROC) */
#define NOH_GL_REQUIRED(X)                                            \
    /* state */                                                       \
    X(Enable, ENABLE)                                                 \
    X(Disable, DISABLE)                                               \
    X(BlendFunc, BLENDFUNC)                                           \
    X(BlendFuncSeparate, BLENDFUNCSEPARATE)                           \
    X(BlendEquation, BLENDEQUATION)                                   \
    X(Viewport, VIEWPORT)                                             \
    X(Scissor, SCISSOR)                                               \
    X(DepthFunc, DEPTHFUNC)                                           \
    X(DepthMask, DEPTHMASK)                                           \
    X(ColorMask, COLORMASK)                                           \
    X(FrontFace, FRONTFACE)                                           \
    X(ClearBufferfv, CLEARBUFFERFV)                                   \
    X(Flush, FLUSH)                                                   \
    /* questions */                                                   \
    X(GetError, GETERROR)                                             \
    X(GetString, GETSTRING)                                           \
    X(GetStringi, GETSTRINGI)                                         \
    X(GetIntegerv, GETINTEGERV)                                       \
    /* shaders and programs */                                        \
    X(CreateShader, CREATESHADER)                                     \
    X(ShaderSource, SHADERSOURCE)                                     \
    X(CompileShader, COMPILESHADER)                                   \
    X(GetShaderiv, GETSHADERIV)                                       \
    X(GetShaderInfoLog, GETSHADERINFOLOG)                             \
    X(DeleteShader, DELETESHADER)                                     \
    X(CreateProgram, CREATEPROGRAM)                                   \
    X(AttachShader, ATTACHSHADER)                                     \
    X(LinkProgram, LINKPROGRAM)                                       \
    X(GetProgramiv, GETPROGRAMIV)                                     \
    X(GetProgramInfoLog, GETPROGRAMINFOLOG)                           \
    X(UseProgram, USEPROGRAM)                                         \
    X(DeleteProgram, DELETEPROGRAM)                                   \
    X(GetActiveAttrib, GETACTIVEATTRIB)                               \
    X(GetAttribLocation, GETATTRIBLOCATION)                           \
    X(GetUniformLocation, GETUNIFORMLOCATION)                         \
    X(GetUniformBlockIndex, GETUNIFORMBLOCKINDEX)                     \
    X(UniformBlockBinding, UNIFORMBLOCKBINDING)                       \
    X(Uniform1i, UNIFORM1I)                                           \
    X(Uniform2i, UNIFORM2I)                                           \
    X(Uniform3i, UNIFORM3I)                                           \
    X(Uniform4i, UNIFORM4I)                                           \
    X(Uniform2f, UNIFORM2F)                                           \
    X(Uniform3f, UNIFORM3F)                                           \
    X(Uniform4f, UNIFORM4F)                                           \
    X(Uniform3fv, UNIFORM3FV)                                         \
    X(Uniform4fv, UNIFORM4FV)                                         \
    X(UniformMatrix4fv, UNIFORMMATRIX4FV)                             \
    /* buffers */                                                     \
    X(GenBuffers, GENBUFFERS)                                         \
    X(DeleteBuffers, DELETEBUFFERS)                                   \
    X(BindBuffer, BINDBUFFER)                                         \
    X(BindBufferBase, BINDBUFFERBASE)                                 \
    X(BindBufferRange, BINDBUFFERRANGE)                               \
    X(BufferData, BUFFERDATA)                                         \
    X(BufferSubData, BUFFERSUBDATA)                                   \
    /* vertices */                                                    \
    X(GenVertexArrays, GENVERTEXARRAYS)                               \
    X(DeleteVertexArrays, DELETEVERTEXARRAYS)                         \
    X(BindVertexArray, BINDVERTEXARRAY)                               \
    X(EnableVertexAttribArray, ENABLEVERTEXATTRIBARRAY)               \
    X(VertexAttribPointer, VERTEXATTRIBPOINTER)                       \
    X(VertexAttribIPointer, VERTEXATTRIBIPOINTER)                     \
    X(VertexAttribDivisor, VERTEXATTRIBDIVISOR)                       \
    X(VertexAttrib4f, VERTEXATTRIB4F)                                 \
    X(VertexAttribI4i, VERTEXATTRIBI4I)                               \
    /* textures */                                                    \
    X(GenTextures, GENTEXTURES)                                       \
    X(DeleteTextures, DELETETEXTURES)                                 \
    X(ActiveTexture, ACTIVETEXTURE)                                   \
    X(BindTexture, BINDTEXTURE)                                       \
    X(TexStorage2D, TEXSTORAGE2D)                                     \
    X(TexStorage3D, TEXSTORAGE3D)                                     \
    X(TexSubImage2D, TEXSUBIMAGE2D)                                   \
    X(TexSubImage3D, TEXSUBIMAGE3D)                                   \
    X(CompressedTexSubImage2D, COMPRESSEDTEXSUBIMAGE2D)               \
    X(TexParameteri, TEXPARAMETERI)                                   \
    X(PixelStorei, PIXELSTOREI)                                       \
    /* framebuffers */                                                \
    X(GenFramebuffers, GENFRAMEBUFFERS)                               \
    X(DeleteFramebuffers, DELETEFRAMEBUFFERS)                         \
    X(BindFramebuffer, BINDFRAMEBUFFER)                               \
    X(FramebufferTexture2D, FRAMEBUFFERTEXTURE2D)                     \
    X(FramebufferTextureLayer, FRAMEBUFFERTEXTURELAYER)               \
    X(CheckFramebufferStatus, CHECKFRAMEBUFFERSTATUS)                 \
    X(DrawBuffers, DRAWBUFFERS)                                       \
    X(ReadBuffer, READBUFFER)                                         \
    X(ReadPixels, READPIXELS)                                         \
    X(GenRenderbuffers, GENRENDERBUFFERS)                             \
    X(DeleteRenderbuffers, DELETERENDERBUFFERS)                       \
    X(BindRenderbuffer, BINDRENDERBUFFER)                             \
    X(RenderbufferStorageMultisample, RENDERBUFFERSTORAGEMULTISAMPLE) \
    /* draws */                                                       \
    X(DrawElements, DRAWELEMENTS)                                     \
    X(DrawElementsInstanced, DRAWELEMENTSINSTANCED)                   \
    X(DrawArraysInstanced, DRAWARRAYSINSTANCED)                       \
    /* transform feedback */                                          \
    X(TransformFeedbackVaryings, TRANSFORMFEEDBACKVARYINGS)

/* More of ES 3.0, for renderers: NULL where the lookup does not know a function. The library never calls these. */
#define NOH_GL_EXTRA(X)                                   \
    /* state */                                           \
    X(IsEnabled, ISENABLED)                               \
    X(PolygonOffset, POLYGONOFFSET)                       \
    X(CullFace, CULLFACE)                                 \
    X(ClearColor, CLEARCOLOR)                             \
    X(ClearDepthf, CLEARDEPTHF)                           \
    X(Clear, CLEAR)                                       \
    X(ClearBufferuiv, CLEARBUFFERUIV)                     \
    X(ClearBufferiv, CLEARBUFFERIV)                       \
    X(ClearBufferfi, CLEARBUFFERFI)                       \
    X(Finish, FINISH)                                     \
    /* questions */                                       \
    X(GetInteger64v, GETINTEGER64V)                       \
    X(GetFloatv, GETFLOATV)                               \
    /* shaders and programs */                            \
    X(DetachShader, DETACHSHADER)                         \
    X(BindAttribLocation, BINDATTRIBLOCATION)             \
    X(GetActiveUniformBlockiv, GETACTIVEUNIFORMBLOCKIV)   \
    X(Uniform1iv, UNIFORM1IV)                             \
    X(Uniform4iv, UNIFORM4IV)                             \
    X(Uniform1ui, UNIFORM1UI)                             \
    X(Uniform2ui, UNIFORM2UI)                             \
    X(Uniform4ui, UNIFORM4UI)                             \
    X(Uniform1uiv, UNIFORM1UIV)                           \
    X(Uniform4uiv, UNIFORM4UIV)                           \
    X(Uniform1f, UNIFORM1F)                               \
    X(Uniform1fv, UNIFORM1FV)                             \
    X(UniformMatrix3fv, UNIFORMMATRIX3FV)                 \
    /* buffers */                                         \
    X(CopyBufferSubData, COPYBUFFERSUBDATA)               \
    X(FlushMappedBufferRange, FLUSHMAPPEDBUFFERRANGE)     \
    /* vertices */                                        \
    X(DisableVertexAttribArray, DISABLEVERTEXATTRIBARRAY) \
    X(VertexAttrib4fv, VERTEXATTRIB4FV)                   \
    /* textures */                                        \
    X(CopyTexSubImage3D, COPYTEXSUBIMAGE3D)               \
    X(GenSamplers, GENSAMPLERS)                           \
    X(DeleteSamplers, DELETESAMPLERS)                     \
    X(BindSampler, BINDSAMPLER)                           \
    X(SamplerParameteri, SAMPLERPARAMETERI)               \
    /* framebuffers */                                    \
    X(FramebufferRenderbuffer, FRAMEBUFFERRENDERBUFFER)   \
    X(BlitFramebuffer, BLITFRAMEBUFFER)                   \
    X(InvalidateFramebuffer, INVALIDATEFRAMEBUFFER)       \
    X(RenderbufferStorage, RENDERBUFFERSTORAGE)           \
    X(GetInternalformativ, GETINTERNALFORMATIV)           \
    /* draws */                                           \
    X(DrawArrays, DRAWARRAYS)                             \
    X(DrawRangeElements, DRAWRANGEELEMENTS)               \
    /* transform feedback */                              \
    X(BeginTransformFeedback, BEGINTRANSFORMFEEDBACK)     \
    X(EndTransformFeedback, ENDTRANSFORMFEEDBACK)         \
    /* queries */                                         \
    X(GenQueries, GENQUERIES)                             \
    X(DeleteQueries, DELETEQUERIES)                       \
    X(BeginQuery, BEGINQUERY)                             \
    X(EndQuery, ENDQUERY)                                 \
    X(GetQueryObjectuiv, GETQUERYOBJECTUIV)

/* Functions that a context may lack: NULL if so. The loader goes by the version and the extension strings, because most
 * lookups return a stub for any name. A field may hold the core function or its KHR, EXT or OES form.
 * X(field, type, name without suffix, group) */
#define NOH_GL_OPTIONAL(X)                                                                      \
    X(MapBufferRange, MAPBUFFERRANGE, "glMapBufferRange", NOH_GL_GROUP_MAP)                     \
    X(UnmapBuffer, UNMAPBUFFER, "glUnmapBuffer", NOH_GL_GROUP_MAP)                              \
    X(FenceSync, FENCESYNC, "glFenceSync", NOH_GL_GROUP_MAP)                                    \
    X(ClientWaitSync, CLIENTWAITSYNC, "glClientWaitSync", NOH_GL_GROUP_MAP)                     \
    X(DeleteSync, DELETESYNC, "glDeleteSync", NOH_GL_GROUP_MAP)                                 \
    X(FramebufferTexture, FRAMEBUFFERTEXTURE, "glFramebufferTexture", NOH_GL_GROUP_GEOMETRY)    \
    X(ObjectLabel, OBJECTLABEL, "glObjectLabel", NOH_GL_GROUP_DEBUG)                            \
    X(PushDebugGroup, PUSHDEBUGGROUP, "glPushDebugGroup", NOH_GL_GROUP_DEBUG)                   \
    X(PopDebugGroup, POPDEBUGGROUP, "glPopDebugGroup", NOH_GL_GROUP_DEBUG)                      \
    X(DebugMessageCallback, DEBUGMESSAGECALLBACK, "glDebugMessageCallback", NOH_GL_GROUP_DEBUG) \
    X(DebugMessageControl, DEBUGMESSAGECONTROL, "glDebugMessageControl", NOH_GL_GROUP_DEBUG)    \
    X(TimeGenQueries, GENQUERIESEXT, "glGenQueries", NOH_GL_GROUP_TIMER)                        \
    X(TimeDeleteQueries, DELETEQUERIESEXT, "glDeleteQueries", NOH_GL_GROUP_TIMER)               \
    X(TimeBeginQuery, BEGINQUERYEXT, "glBeginQuery", NOH_GL_GROUP_TIMER)                        \
    X(TimeEndQuery, ENDQUERYEXT, "glEndQuery", NOH_GL_GROUP_TIMER)                              \
    X(TimeGetQueryiv, GETQUERYIVEXT, "glGetQueryiv", NOH_GL_GROUP_TIMER)                        \
    X(TimeGetQueryObjectuiv, GETQUERYOBJECTUIVEXT, "glGetQueryObjectuiv", NOH_GL_GROUP_TIMER)   \
    X(TimeGetQueryObjectui64v, GETQUERYOBJECTUI64VEXT, "glGetQueryObjectui64v", NOH_GL_GROUP_TIMER)

typedef struct noh_gl_api {
#define NOH_GL_FIELD(field, TYPE) PFNGL##TYPE##PROC field;
    NOH_GL_REQUIRED(NOH_GL_FIELD)
    NOH_GL_EXTRA(NOH_GL_FIELD)
#undef NOH_GL_FIELD
#define NOH_GL_FIELD(field, TYPE, name, group) PFNGL##TYPE##PROC field;
    NOH_GL_OPTIONAL(NOH_GL_FIELD)
#undef NOH_GL_FIELD

    int version;      /* major * 100 + minor * 10: ES 3.2 is 320, desktop 4.5 is 450 */
    int is_es;        /* 0 on a desktop GL that also compiles ES shaders (OSMesa) */
    int geometry_ext; /* geometry shaders need "#extension GL_EXT_geometry_shader" (1) or
                       * "GL_OES_geometry_shader" (2); 0 where core or where absent */
    int etc2;         /* the context reads ETC2 and EAC textures: OpenGL ES does, desktop GL from 4.3 or with
                       * GL_ARB_ES3_compatibility, WebGL 2 with WEBGL_compressed_texture_etc */

    /* Decodes them where it does not. NULL after noh_gl_api_load: set it to noh_etc2_decode (pack/etc2.h), which is not
     * linked otherwise, before textures are made. */
    void (*decode)(uint32_t format, const uint8_t *blocks, uint32_t count, uint8_t *texels);
} noh_gl_api;

/* Any GL function; cast it to its own type before the call. */
typedef void (*noh_gl_proc)(void);

/* The caller's lookup, for instance a wrapper of eglGetProcAddress. Returns NULL for an unknown name. */
typedef noh_gl_proc (*noh_gl_get_proc)(void *user, const char *name);

/* Fill the table for the context that is current on this thread. `user` is passed to `get`.
 * memory  none; `api` is untouched on error
 * errors  ARG api or get is NULL; UNSUPPORTED the context is below ES 3.0, or lacks a function of NOH_GL_REQUIRED,
 *         which `what` names; GL no context is current */
noh_result noh_gl_api_load(noh_gl_api *api, noh_gl_get_proc get, void *user, noh_error *error);

/* 1 if the context lists the extension, else 0. `name` in full: "GL_EXT_...". */
int noh_gl_has_extension(const noh_gl_api *api, const char *name);

/* Return the oldest pending GL error, or GL_NO_ERROR, and clear the rest. Calls glGetError at most 16 times, because a
 * lost context may report an error for ever. */
GLenum noh_gl_error_take(const noh_gl_api *api);

/* The same as a result. Every create clears pending errors first and calls this last, so it never returns NOH_OK after
 * the driver refused one of its calls.
 * errors  MEMORY GL_OUT_OF_MEMORY; GL any other. `where` is the GL error; `what` and `need` are the arguments */
noh_result noh_gl_error_check(const noh_gl_api *api, const char *what, uint64_t need, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
