/* null_draw.c: framebuffers, vertex arrays and draws of the GL that does nothing. */
#include "null_internal.h"

#include <string.h>

/* --- framebuffers --- */

static const null_object *attached(const noh_platform_context *c, const null_attachment *a)
{
    const null_object *object = &c->objects[a->is_texture ? NOH_NULL_TEXTURE : NOH_NULL_RENDERBUFFER][a->name];
    return a->name && object->alive && object->ready ? object : NULL;
}

/* Whether there is an attachment, and all attachments are live, have storage and have the same size. */
int noh_null_complete(const noh_platform_context *c, GLuint framebuffer)
{
    const null_object *f = &c->objects[NOH_NULL_FRAMEBUFFER][framebuffer];
    const null_object *first = NULL;
    if (framebuffer == 0) return 1;
    for (int i = 0; i < NULL_ATTACHMENTS; i++) {
        if (!f->attachments[i].name) continue;
        const null_object *object = attached(c, &f->attachments[i]);
        if (!object) return 0;
        if (first && (first->width != object->width || first->height != object->height)) return 0;
        first = object;
    }
    return first != NULL;
}

static void GL_APIENTRY null_BindFramebuffer(GLenum target, GLuint name)
{
    noh_platform_context *c = noh_null_count(NULL_BindFramebuffer);
    null_object *object = name ? noh_null_object(NULL_BindFramebuffer, NOH_NULL_FRAMEBUFFER, name) : NULL;
    if (object) object->bound = 1;
    if (target != GL_READ_FRAMEBUFFER) c->draw_framebuffer = name;
    if (target != GL_DRAW_FRAMEBUFFER) c->read_framebuffer = name;
}

static void attach(int call, GLenum target, GLenum at, GLuint name, int is_texture, GLint layer)
{
    noh_platform_context *c = noh_null_count(call);
    GLuint framebuffer = target == GL_READ_FRAMEBUFFER ? c->read_framebuffer : c->draw_framebuffer;
    null_object *f = noh_null_object(call, NOH_NULL_FRAMEBUFFER, framebuffer);
    unsigned index = at == GL_DEPTH_ATTACHMENT ? 4u : (unsigned)(at - GL_COLOR_ATTACHMENT0);
    const null_object *object = NULL;
    if (name) object = noh_null_object(call, is_texture ? NOH_NULL_TEXTURE : NOH_NULL_RENDERBUFFER, name);
    if (object && !object->ready) noh_null_wrong(call, "the attachment has no storage");
    if (object && is_texture && layer >= (object->layers ? object->layers : 1))
        noh_null_wrong(call, "no layer %d", layer);
    if (index >= NULL_ATTACHMENTS) {
        noh_null_wrong(call, "the null platform has no attachment 0x%x", (unsigned)at);
    } else if (f) {
        f->attachments[index].name = name;
        f->attachments[index].is_texture = is_texture;
    }
}

static void GL_APIENTRY null_FramebufferTexture2D(GLenum target, GLenum at, GLenum face, GLuint texture, GLint level)
{
    (void)face;
    (void)level;
    attach(NULL_FramebufferTexture2D, target, at, texture, 1, 0);
}

static void GL_APIENTRY null_FramebufferTextureLayer(GLenum target, GLenum at, GLuint texture, GLint level, GLint layer)
{
    (void)level;
    attach(NULL_FramebufferTextureLayer, target, at, texture, 1, layer);
}

static void GL_APIENTRY null_FramebufferTexture(GLenum target, GLenum at, GLuint texture, GLint level)
{
    (void)level;
    attach(NULL_FramebufferTexture, target, at, texture, 1, 0);
}

static void GL_APIENTRY null_FramebufferRenderbuffer(GLenum target, GLenum at, GLenum kind, GLuint renderbuffer)
{
    (void)kind;
    attach(NULL_FramebufferRenderbuffer, target, at, renderbuffer, 0, 0);
}

static GLenum GL_APIENTRY null_CheckFramebufferStatus(GLenum target)
{
    const noh_platform_context *c = noh_null_count(NULL_CheckFramebufferStatus);
    GLuint name = target == GL_READ_FRAMEBUFFER ? c->read_framebuffer : c->draw_framebuffer;
    return noh_null_complete(c, name) ? GL_FRAMEBUFFER_COMPLETE : GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT;
}

static void GL_APIENTRY null_DrawBuffers(GLsizei count, const GLenum *buffers)
{
    const noh_platform_context *c = noh_null_count(NULL_DrawBuffers);
    for (GLsizei i = 0; i < count && c->draw_framebuffer; i++) {
        if (buffers[i] != GL_NONE && buffers[i] != GL_COLOR_ATTACHMENT0 + (GLenum)i) {
            noh_null_wrong(NULL_DrawBuffers, "buffer %d is attachment 0x%x", i, (unsigned)buffers[i]);
        }
    }
}

static void GL_APIENTRY null_ReadBuffer(GLenum buffer)
{
    (void)buffer;
    noh_null_count(NULL_ReadBuffer);
}

static void check_read(int call)
{
    const noh_platform_context *c = noh_null_count(call);
    if (!noh_null_complete(c, c->read_framebuffer)) noh_null_wrong(call, "the read framebuffer is not complete");
}

static void GL_APIENTRY null_ReadPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type,
                                        void *pixels)
{
    (void)x;
    (void)y;
    (void)format;
    size_t texel = 4u * (type == GL_UNSIGNED_BYTE ? 1u : 4u);
    check_read(NULL_ReadPixels);
    memset(pixels, 0, texel * (size_t)width * (size_t)height);
}

static void check_target(int call)
{
    noh_platform_context *c = noh_null_count(call);
    if (!noh_null_complete(c, c->draw_framebuffer)) noh_null_wrong(call, "the framebuffer is not complete");
    c->outside += c->groups == 0;
}

static void GL_APIENTRY null_BlitFramebuffer(GLint x0, GLint y0, GLint x1, GLint y1, GLint u0, GLint v0, GLint u1,
                                             GLint v1, GLbitfield mask, GLenum filter)
{
    (void)x0, (void)y0, (void)x1, (void)y1, (void)u0, (void)v0, (void)u1, (void)v1, (void)mask, (void)filter;
    check_read(NULL_BlitFramebuffer);
    check_target(NULL_BlitFramebuffer);
}

static void GL_APIENTRY null_Clear(GLbitfield mask)
{
    (void)mask;
    check_target(NULL_Clear);
}

static void GL_APIENTRY null_ClearBufferfv(GLenum buffer, GLint index, const GLfloat *value)
{
    (void)buffer;
    (void)index;
    (void)value;
    check_target(NULL_ClearBufferfv);
}

/* --- vertex arrays --- */

static void GL_APIENTRY null_BindVertexArray(GLuint name)
{
    noh_platform_context *c = noh_null_count(NULL_BindVertexArray);
    null_object *object = name ? noh_null_object(NULL_BindVertexArray, NOH_NULL_VERTEX_ARRAY, name) : NULL;
    if (object) object->bound = 1;
    c->vertex_array = name;
}

static null_attribute *attribute_at(int call, GLuint index)
{
    noh_platform_context *c = noh_null_count(call);
    null_object *array = noh_null_object(call, NOH_NULL_VERTEX_ARRAY, c->vertex_array);
    if (index >= NULL_ATTRIBUTES) noh_null_wrong(call, "attribute %u", (unsigned)index);
    return array && index < NULL_ATTRIBUTES ? &array->attributes[index] : NULL;
}

static void GL_APIENTRY null_EnableVertexAttribArray(GLuint index)
{
    null_attribute *a = attribute_at(NULL_EnableVertexAttribArray, index);
    if (a) a->enabled = 1;
}

static void GL_APIENTRY null_DisableVertexAttribArray(GLuint index)
{
    null_attribute *a = attribute_at(NULL_DisableVertexAttribArray, index);
    if (a) a->enabled = 0;
}

static void GL_APIENTRY null_VertexAttribDivisor(GLuint index, GLuint divisor)
{
    null_attribute *a = attribute_at(NULL_VertexAttribDivisor, index);
    if (a) a->divisor = divisor;
}

static unsigned type_bytes(GLenum type)
{
    if (type == GL_BYTE || type == GL_UNSIGNED_BYTE) return 1;
    return type == GL_SHORT || type == GL_UNSIGNED_SHORT || type == GL_HALF_FLOAT ? 2 : 4;
}

static void set_pointer(int call, GLuint index, GLint components, GLenum type, GLsizei stride, const void *offset)
{
    null_attribute *a = attribute_at(call, index);
    if (!noh_null_buffer_at(call, GL_ARRAY_BUFFER) || !a) return;
    a->buffer = noh_null_current->buffers[NULL_ARRAY];
    a->bytes = (uint64_t)components * type_bytes(type);
    a->stride = stride ? (uint64_t)stride : a->bytes;
    a->offset = (uint64_t)(uintptr_t)offset;
}

static void GL_APIENTRY null_VertexAttribPointer(GLuint index, GLint components, GLenum type, GLboolean normalized,
                                                 GLsizei stride, const void *offset)
{
    (void)normalized;
    set_pointer(NULL_VertexAttribPointer, index, components, type, stride, offset);
}

static void GL_APIENTRY null_VertexAttribIPointer(GLuint index, GLint components, GLenum type, GLsizei stride,
                                                  const void *offset)
{
    set_pointer(NULL_VertexAttribIPointer, index, components, type, stride, offset);
}

/* --- draws --- */

/* Check that each attribute's buffer is live and has all elements that the draw reads: the number of instances is
 * always known, the number of vertices only without indices (vertices 0: unknown). */
static void check_attributes(int call, const null_object *array, uint64_t vertices, uint64_t instances)
{
    for (unsigned i = 0; i < NULL_ATTRIBUTES; i++) {
        const null_attribute *a = &array->attributes[i];
        if (!a->enabled) continue;
        const null_object *buffer = noh_null_object(call, NOH_NULL_BUFFER, a->buffer);
        uint64_t elements = a->divisor ? (instances + a->divisor - 1) / a->divisor : vertices;
        if (buffer && elements && a->offset + (elements - 1) * a->stride + a->bytes > buffer->bytes) {
            noh_null_wrong(call, "attribute %u reads past its buffer of %lu bytes", i, (unsigned long)buffer->bytes);
        }
    }
}

/* A render target must not be bound to a unit that a shader could read. */
static void check_feedback(int call, const noh_platform_context *c)
{
    const null_object *f = &c->objects[NOH_NULL_FRAMEBUFFER][c->draw_framebuffer];
    for (int i = 0; i < NULL_ATTACHMENTS && c->draw_framebuffer; i++) {
        for (int unit = 0; unit < NULL_UNITS && f->attachments[i].is_texture && f->attachments[i].name; unit++) {
            GLuint name = f->attachments[i].name;
            if (c->units[unit].flat == name || c->units[unit].array == name) {
                noh_null_wrong(call, "texture %u is drawn to and bound to unit %d", (unsigned)name, unit);
            }
        }
    }
}

static const null_object *check_draw(int call, GLsizei vertices, GLsizei instances)
{
    noh_platform_context *c = noh_null_current;
    check_target(call);
    c->draws++;
    if (vertices < 0 || instances < 1) noh_null_wrong(call, "%d vertices, %d instances", vertices, instances);
    if (c->program == 0)
        noh_null_wrong(call, "no program in use");
    else
        noh_null_object(call, NOH_NULL_PROGRAM, c->program);
    check_feedback(call, c);
    if (c->vertex_array == 0) {
        noh_null_wrong(call, "no vertex array is bound");
        return NULL;
    }
    return noh_null_object(call, NOH_NULL_VERTEX_ARRAY, c->vertex_array);
}

static void draw_arrays(int call, GLint first, GLsizei count, GLsizei instances)
{
    const null_object *array = check_draw(call, count, instances);
    if (array) check_attributes(call, array, (uint64_t)first + (uint64_t)count, (uint64_t)instances);
}

static void draw_elements(int call, GLsizei count, GLenum type, const void *offset, GLsizei instances)
{
    const null_object *array = check_draw(call, count, instances);
    if (!array) return;
    check_attributes(call, array, 0, (uint64_t)instances);
    const null_object *elements = noh_null_object(call, NOH_NULL_BUFFER, array->elements);
    uint64_t end = (uint64_t)(uintptr_t)offset + (uint64_t)count * type_bytes(type);
    if (elements && end > elements->bytes) {
        noh_null_wrong(call, "indices up to byte %lu of %lu", (unsigned long)end, (unsigned long)elements->bytes);
    }
}

static void GL_APIENTRY null_DrawArrays(GLenum mode, GLint first, GLsizei count)
{
    (void)mode;
    draw_arrays(NULL_DrawArrays, first, count, 1);
}

static void GL_APIENTRY null_DrawArraysInstanced(GLenum mode, GLint first, GLsizei count, GLsizei instances)
{
    (void)mode;
    draw_arrays(NULL_DrawArraysInstanced, first, count, instances);
}

static void GL_APIENTRY null_DrawElements(GLenum mode, GLsizei count, GLenum type, const void *offset)
{
    (void)mode;
    draw_elements(NULL_DrawElements, count, type, offset, 1);
}

static void GL_APIENTRY null_DrawElementsInstanced(GLenum mode, GLsizei count, GLenum type, const void *offset,
                                                   GLsizei instances)
{
    (void)mode;
    draw_elements(NULL_DrawElementsInstanced, count, type, offset, instances);
}

const null_entry noh_null_draw_functions[] = { NULL_ENTRY(BindFramebuffer),
                                               NULL_ENTRY(FramebufferTexture2D),
                                               NULL_ENTRY(FramebufferTextureLayer),
                                               NULL_ENTRY(FramebufferTexture),
                                               NULL_ENTRY(FramebufferRenderbuffer),
                                               NULL_ENTRY(CheckFramebufferStatus),
                                               NULL_ENTRY(DrawBuffers),
                                               NULL_ENTRY(ReadBuffer),
                                               NULL_ENTRY(ReadPixels),
                                               NULL_ENTRY(BlitFramebuffer),
                                               NULL_ENTRY(Clear),
                                               NULL_ENTRY(ClearBufferfv),
                                               NULL_ENTRY(BindVertexArray),
                                               NULL_ENTRY(EnableVertexAttribArray),
                                               NULL_ENTRY(DisableVertexAttribArray),
                                               NULL_ENTRY(VertexAttribDivisor),
                                               NULL_ENTRY(VertexAttribPointer),
                                               NULL_ENTRY(VertexAttribIPointer),
                                               NULL_ENTRY(DrawArrays),
                                               NULL_ENTRY(DrawArraysInstanced),
                                               NULL_ENTRY(DrawElements),
                                               NULL_ENTRY(DrawElementsInstanced),
                                               { NULL, NULL } };
