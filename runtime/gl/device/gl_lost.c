/* gl_lost.c: a table for objects of a lost context. Their names are invalid, or belong to other objects now. */
#include "noh/gl_device.h"
#include "gl/device/gl_names_internal.h"

static void GL_APIENTRY ignore_names(GLsizei count, const GLuint *names)
{
    (void)count;
    (void)names;
}

static void GL_APIENTRY ignore_name(GLuint name)
{
    (void)name;
}

static const noh_gl_api lost = { .DeleteBuffers = ignore_names,
                                 .DeleteTextures = ignore_names,
                                 .DeleteRenderbuffers = ignore_names,
                                 .DeleteFramebuffers = ignore_names,
                                 .DeleteVertexArrays = ignore_names,
                                 .DeleteShader = ignore_name,
                                 .DeleteProgram = ignore_name };

const noh_gl_api *noh_gl_lost_api(void)
{
    return &lost;
}
