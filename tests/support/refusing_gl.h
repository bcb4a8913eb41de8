/* refusing_gl.h: a real driver that fails at a call of our choice: the functions of an API are replaced by ones that
 * call the driver's, except one call, which it never sees and after which glGetError says so. What makes names makes
 * none, what links or compiles does not. The platform "null" does the same without a driver (platform/null.h). */
#ifndef NOH_TESTS_SUPPORT_REFUSING_GL_H
#define NOH_TESTS_SUPPORT_REFUSING_GL_H

#include "noh/gl_device.h"

/* Every function that can be refused. Vertex arrays are bound whatever comes: what is drawn without one is read from
 * the address 0, by some drivers. */
#define REFUSING_GL_FUNCTIONS(X)                                                                                  \
    X(GenBuffers)                                                                                                 \
    X(BufferData)                                                                                                 \
    X(BufferSubData)                                                                                              \
    X(GenVertexArrays) X(VertexAttribPointer) X(GenTextures) X(TexStorage2D) X(TexStorage3D) X(TexSubImage2D)     \
        X(TexSubImage3D) X(CompressedTexSubImage2D) X(GenFramebuffers) X(FramebufferTexture2D)                    \
            X(FramebufferTextureLayer) X(GenRenderbuffers) X(RenderbufferStorageMultisample) X(CreateShader)      \
                X(CompileShader) X(CreateProgram) X(LinkProgram) X(BindFramebuffer) X(UseProgram) X(DrawElements) \
                    X(DrawElementsInstanced) X(DrawArraysInstanced)

enum {
#define NAME(name) REFUSING_##name,
    REFUSING_GL_FUNCTIONS(NAME)
#undef NAME
        REFUSING_GL_COUNT
};
extern const char *const refusing_gl_names[REFUSING_GL_COUNT];

/* Replace the functions of an API that was loaded, and put them back. One at a time for the whole process. */
void refusing_gl_install(noh_gl_api *gl);
void refusing_gl_remove(noh_gl_api *gl);

/* Count calls from 0 again, and refuse the k-th (from 0) of a function; REFUSING_GL_COUNT: none. */
void refusing_gl_at(uint32_t function, uint32_t k);
int refusing_gl_happened(void);
uint32_t refusing_gl_calls(uint32_t function);

#endif
