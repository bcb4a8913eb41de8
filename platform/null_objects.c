/* null_objects.c: objects of the GL that does nothing: names, bindings, storage. */
#include "null_internal.h"

#include "gl/device/gl_memory_internal.h"
#include "noh/low_gl.h"

#include <string.h>

/* --- names --- */

static const char *const kind_names[NOH_NULL_KINDS] = { "buffer",       "texture", "renderbuffer", "framebuffer",
                                                        "vertex array", "program", "shader" };

null_object *noh_null_object(int call, noh_null_kind kind, GLuint name)
{
    noh_platform_context *c = noh_null_current;
    if (name == 0 || name >= c->next[kind]) {
        noh_null_wrong(call, "%s %u was never created", kind_names[kind], (unsigned)name);
        return NULL;
    }
    if (!c->objects[kind][name].alive) {
        noh_null_wrong(call, "%s %u was deleted", kind_names[kind], (unsigned)name);
        return NULL;
    }
    return &c->objects[kind][name];
}

GLuint noh_null_make(int call, noh_null_kind kind)
{
    noh_platform_context *c = noh_null_current;
    c->allocations++;
    if (c->refusing) return 0;
    if (c->next[kind] >= NULL_OBJECTS_MAX) {
        noh_null_wrong(call, "more objects than the limit of the null platform");
        return 0;
    }
    GLuint name = c->next[kind]++;
    c->objects[kind][name].alive = 1;
    return name;
}

static void generate(int call, noh_null_kind kind, GLsizei count, GLuint *names)
{
    noh_null_count(call);
    for (GLsizei i = 0; i < count; i++) names[i] = noh_null_make(call, kind);
}

/* GL ignores a name that was already deleted; here it is a violation. 0 is allowed. */
void noh_null_delete(int call, noh_null_kind kind, GLsizei count, const GLuint *names)
{
    noh_null_count(call);
    for (GLsizei i = 0; i < count; i++) {
        null_object *object = names[i] ? noh_null_object(call, kind, names[i]) : NULL;
        if (object) object->alive = 0;
    }
}

static void forget(GLuint *binding, GLsizei count, const GLuint *names)
{
    for (GLsizei i = 0; i < count; i++) {
        if (*binding == names[i]) *binding = 0;
    }
}

#define NAMES(Kind, KIND)                                                \
    static void GL_APIENTRY null_Gen##Kind(GLsizei count, GLuint *names) \
    {                                                                    \
        generate(NULL_Gen##Kind, KIND, count, names);                    \
    }
NAMES(Buffers, NOH_NULL_BUFFER)
NAMES(Textures, NOH_NULL_TEXTURE)
NAMES(Renderbuffers, NOH_NULL_RENDERBUFFER)
NAMES(Framebuffers, NOH_NULL_FRAMEBUFFER)
NAMES(VertexArrays, NOH_NULL_VERTEX_ARRAY)

static void GL_APIENTRY null_DeleteBuffers(GLsizei count, const GLuint *names)
{
    noh_null_delete(NULL_DeleteBuffers, NOH_NULL_BUFFER, count, names);
    for (int slot = 0; slot < NULL_BUFFER_SLOTS; slot++) forget(&noh_null_current->buffers[slot], count, names);
}

static void GL_APIENTRY null_DeleteTextures(GLsizei count, const GLuint *names)
{
    noh_null_delete(NULL_DeleteTextures, NOH_NULL_TEXTURE, count, names);
    for (int unit = 0; unit < NULL_UNITS; unit++) {
        forget(&noh_null_current->units[unit].flat, count, names);
        forget(&noh_null_current->units[unit].array, count, names);
        forget(&noh_null_current->units[unit].cube, count, names);
    }
}

static void GL_APIENTRY null_DeleteRenderbuffers(GLsizei count, const GLuint *names)
{
    noh_null_delete(NULL_DeleteRenderbuffers, NOH_NULL_RENDERBUFFER, count, names);
    forget(&noh_null_current->renderbuffer, count, names);
}

static void GL_APIENTRY null_DeleteFramebuffers(GLsizei count, const GLuint *names)
{
    noh_null_delete(NULL_DeleteFramebuffers, NOH_NULL_FRAMEBUFFER, count, names);
    forget(&noh_null_current->draw_framebuffer, count, names);
    forget(&noh_null_current->read_framebuffer, count, names);
}

static void GL_APIENTRY null_DeleteVertexArrays(GLsizei count, const GLuint *names)
{
    noh_null_delete(NULL_DeleteVertexArrays, NOH_NULL_VERTEX_ARRAY, count, names);
    forget(&noh_null_current->vertex_array, count, names);
}

static void GL_APIENTRY null_ObjectLabel(GLenum identifier, GLuint name, GLsizei length, const GLchar *label)
{
    static const GLenum identifiers[NOH_NULL_KINDS] = { GL_BUFFER,       GL_TEXTURE, GL_RENDERBUFFER, GL_FRAMEBUFFER,
                                                        GL_VERTEX_ARRAY, GL_PROGRAM, GL_SHADER };
    (void)length;
    noh_null_count(NULL_ObjectLabel);
    for (int kind = 0; kind < NOH_NULL_KINDS; kind++) {
        if (identifiers[kind] != identifier) continue;
        null_object *object = noh_null_object(NULL_ObjectLabel, (noh_null_kind)kind, name);
        if (object && !object->bound)
            noh_null_wrong(NULL_ObjectLabel, "%s %u is not bound yet", kind_names[kind], (unsigned)name);
        if (object) object->labelled = label && label[0];
        return;
    }
    noh_null_wrong(NULL_ObjectLabel, "unknown identifier 0x%x", (unsigned)identifier);
}

/* --- buffers --- */

static GLuint *buffer_binding(int call, GLenum target)
{
    noh_platform_context *c = noh_null_current;
    switch (target) {
    case GL_ARRAY_BUFFER: return &c->buffers[NULL_ARRAY];
    case GL_UNIFORM_BUFFER: return &c->buffers[NULL_UNIFORM];
    case GL_TRANSFORM_FEEDBACK_BUFFER: return &c->buffers[NULL_FEEDBACK];
    case GL_ELEMENT_ARRAY_BUFFER: return &c->objects[NOH_NULL_VERTEX_ARRAY][c->vertex_array].elements;
    default: noh_null_wrong(call, "the null platform has no buffer target 0x%x", (unsigned)target); return NULL;
    }
}

null_object *noh_null_buffer_at(int call, GLenum target)
{
    GLuint *binding = buffer_binding(call, target);
    if (!binding) return NULL;
    if (*binding == 0) {
        noh_null_wrong(call, "no buffer is bound");
        return NULL;
    }
    return noh_null_object(call, NOH_NULL_BUFFER, *binding);
}

static void bind_buffer(int call, GLenum target, GLuint name)
{
    noh_null_count(call);
    GLuint *binding = buffer_binding(call, target);
    null_object *object = name ? noh_null_object(call, NOH_NULL_BUFFER, name) : NULL;
    if (object) object->bound = 1;
    if (binding) *binding = name;
}

static void GL_APIENTRY null_BindBuffer(GLenum target, GLuint name)
{
    bind_buffer(NULL_BindBuffer, target, name);
}

static void GL_APIENTRY null_BindBufferBase(GLenum target, GLuint index, GLuint name)
{
    (void)index;
    bind_buffer(NULL_BindBufferBase, target, name);
}

static void GL_APIENTRY null_BindBufferRange(GLenum target, GLuint index, GLuint name, GLintptr offset,
                                             GLsizeiptr bytes)
{
    (void)index;
    bind_buffer(NULL_BindBufferRange, target, name);
    const null_object *object = name ? noh_null_buffer_at(NULL_BindBufferRange, target) : NULL;
    if (object && (offset < 0 || bytes <= 0 || (uint64_t)offset + (uint64_t)bytes > object->bytes)) {
        noh_null_wrong(NULL_BindBufferRange, "bytes %ld to %ld of a buffer of %lu", (long)offset,
                       (long)(offset + bytes), (unsigned long)object->bytes);
    }
}

static void GL_APIENTRY null_BufferData(GLenum target, GLsizeiptr bytes, const void *data, GLenum usage)
{
    (void)data;
    (void)usage;
    noh_null_count(NULL_BufferData)->allocations++;
    null_object *object = noh_null_buffer_at(NULL_BufferData, target);
    if (!object) return;
    object->ready = 1;
    object->bytes = (uint64_t)bytes;
}

static void GL_APIENTRY null_BufferSubData(GLenum target, GLintptr offset, GLsizeiptr bytes, const void *data)
{
    (void)data;
    noh_null_count(NULL_BufferSubData);
    const null_object *object = noh_null_buffer_at(NULL_BufferSubData, target);
    if (!object) return;
    if (!object->ready) noh_null_wrong(NULL_BufferSubData, "the buffer has no storage");
    if (offset < 0 || bytes < 0 || (uint64_t)offset + (uint64_t)bytes > object->bytes) {
        noh_null_wrong(NULL_BufferSubData, "bytes %ld to %ld of a buffer of %lu", (long)offset, (long)(offset + bytes),
                       (unsigned long)object->bytes);
    }
}

/* --- textures and renderbuffers --- */

static GLuint *texture_binding(int call, GLenum target)
{
    noh_platform_context *c = noh_null_current;
    if (target == GL_TEXTURE_2D) return &c->units[c->unit].flat;
    if (target == GL_TEXTURE_2D_ARRAY) return &c->units[c->unit].array;
    if (target == GL_TEXTURE_CUBE_MAP) return &c->units[c->unit].cube;
    noh_null_wrong(call, "the null platform has no texture target 0x%x", (unsigned)target);
    return NULL;
}

null_object *noh_null_texture_at(int call, GLenum target)
{
    GLuint *binding = texture_binding(call, target);
    if (!binding) return NULL;
    if (*binding == 0) {
        noh_null_wrong(call, "no texture is bound");
        return NULL;
    }
    return noh_null_object(call, NOH_NULL_TEXTURE, *binding);
}

static void GL_APIENTRY null_ActiveTexture(GLenum unit)
{
    noh_platform_context *c = noh_null_count(NULL_ActiveTexture);
    if (unit < GL_TEXTURE0 || unit >= GL_TEXTURE0 + NULL_UNITS)
        noh_null_wrong(NULL_ActiveTexture, "no such unit");
    else
        c->unit = unit - GL_TEXTURE0;
}

static void GL_APIENTRY null_BindTexture(GLenum target, GLuint name)
{
    noh_null_count(NULL_BindTexture);
    GLuint *binding = texture_binding(NULL_BindTexture, target);
    null_object *object = name ? noh_null_object(NULL_BindTexture, NOH_NULL_TEXTURE, name) : NULL;
    if (object && object->bound && object->type != target)
        noh_null_wrong(NULL_BindTexture, "the texture has another target");
    if (object) {
        object->bound = 1;
        object->type = target;
    }
    if (binding) *binding = name;
}

static void set_storage(int call, GLenum target, GLenum format, const GLsizei size[3], GLsizei levels)
{
    noh_null_count(call)->allocations++;
    null_object *object = noh_null_texture_at(call, target);
    noh_gl_texture_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.format = format;
    desc.width = (uint32_t)size[0];
    desc.height = (uint32_t)size[1];
    desc.layers = target == GL_TEXTURE_CUBE_MAP ? NOH_GL_CUBE : (uint32_t)size[2];
    desc.levels = (uint32_t)levels;
    if (!object) return;
    if (object->ready) noh_null_wrong(call, "the texture already has storage");
    object->ready = 1;
    object->width = size[0];
    object->height = size[1];
    object->layers = size[2];
    object->levels = levels;
    object->bytes = noh_gl_texture_bytes(&desc);
    if (!object->bytes) noh_null_wrong(call, "impossible size or format 0x%x", (unsigned)format);
}

static void GL_APIENTRY null_TexStorage2D(GLenum target, GLsizei levels, GLenum format, GLsizei width, GLsizei height)
{
    const GLsizei size[3] = { width, height, 0 };
    set_storage(NULL_TexStorage2D, target, format, size, levels);
}

static void GL_APIENTRY null_TexStorage3D(GLenum target, GLsizei levels, GLenum format, GLsizei width, GLsizei height,
                                          GLsizei depth)
{
    const GLsizei size[3] = { width, height, depth };
    set_storage(NULL_TexStorage3D, target, format, size, levels);
}

static int outside(GLint at, GLsizei count, GLsizei side)
{
    return at < 0 || count < 0 || (int64_t)at + count > side;
}

static void check_update(int call, GLenum target, GLint level, const GLint at[3], const GLsizei count[3])
{
    noh_null_count(call);
    const null_object *o = noh_null_texture_at(call, target);
    if (!o) return;
    if (!o->ready) {
        noh_null_wrong(call, "the texture has no storage");
    } else if (level < 0 || level >= o->levels) {
        noh_null_wrong(call, "level %d of %d", level, o->levels);
    } else {
        GLsizei width = o->width >> level ? o->width >> level : 1, height = o->height >> level ? o->height >> level : 1;
        if (outside(at[0], count[0], width) || outside(at[1], count[1], height) ||
            outside(at[2], count[2], o->layers ? o->layers : 1)) {
            noh_null_wrong(call, "outside the texture");
        }
    }
}

static void GL_APIENTRY null_TexSubImage2D(GLenum target, GLint level, GLint x, GLint y, GLsizei width, GLsizei height,
                                           GLenum format, GLenum type, const void *pixels)
{
    const GLint at[3] = { x, y, 0 };
    const GLsizei count[3] = { width, height, 1 };
    (void)format;
    (void)type;
    (void)pixels;
    const int is_face = target >= GL_TEXTURE_CUBE_MAP_POSITIVE_X && target <= GL_TEXTURE_CUBE_MAP_NEGATIVE_Z;
    check_update(NULL_TexSubImage2D, is_face ? GL_TEXTURE_CUBE_MAP : target, level, at, count);
}

static void GL_APIENTRY null_CompressedTexSubImage2D(GLenum target, GLint level, GLint x, GLint y, GLsizei width,
                                                     GLsizei height, GLenum format, GLsizei bytes, const void *data)
{
    const GLint at[3] = { x, y, 0 };
    const GLsizei count[3] = { width, height, 1 };
    const noh_gl_texture_desc desc = { .format = format, .width = (uint32_t)width, .height = (uint32_t)height };
    (void)data;
    check_update(NULL_CompressedTexSubImage2D, target, level, at, count);
    if ((x | y) & 3)
        noh_null_wrong(NULL_CompressedTexSubImage2D, "the origin of compressed blocks is not a multiple of 4");
    if ((uint64_t)bytes != noh_gl_texture_bytes(&desc)) {
        noh_null_wrong(NULL_CompressedTexSubImage2D, "%d bytes do not match the size of the blocks", (int)bytes);
    }
}

static void GL_APIENTRY null_TexSubImage3D(GLenum target, GLint level, GLint x, GLint y, GLint z, GLsizei width,
                                           GLsizei height, GLsizei depth, GLenum format, GLenum type,
                                           const void *pixels)
{
    const GLint at[3] = { x, y, z };
    const GLsizei count[3] = { width, height, depth };
    (void)format;
    (void)type;
    (void)pixels;
    check_update(NULL_TexSubImage3D, target, level, at, count);
}

static void GL_APIENTRY null_TexParameteri(GLenum target, GLenum parameter, GLint value)
{
    (void)parameter;
    (void)value;
    noh_null_count(NULL_TexParameteri);
    noh_null_texture_at(NULL_TexParameteri, target);
}

static void GL_APIENTRY null_BindRenderbuffer(GLenum target, GLuint name)
{
    (void)target;
    noh_platform_context *c = noh_null_count(NULL_BindRenderbuffer);
    null_object *object = name ? noh_null_object(NULL_BindRenderbuffer, NOH_NULL_RENDERBUFFER, name) : NULL;
    if (object) object->bound = 1;
    c->renderbuffer = name;
}

static void set_renderbuffer(int call, GLsizei samples, GLenum format, GLsizei width, GLsizei height)
{
    noh_platform_context *c = noh_null_count(call);
    null_object *object = noh_null_object(call, NOH_NULL_RENDERBUFFER, c->renderbuffer);
    c->allocations++;
    if (!object) return;
    object->ready = 1;
    object->width = width;
    object->height = height;
    object->bytes = noh_gl_renderbuffer_bytes(format, (uint32_t)width, (uint32_t)height, (uint32_t)samples);
}

static void GL_APIENTRY null_RenderbufferStorage(GLenum target, GLenum format, GLsizei width, GLsizei height)
{
    (void)target;
    set_renderbuffer(NULL_RenderbufferStorage, 0, format, width, height);
}

static void GL_APIENTRY null_RenderbufferStorageMultisample(GLenum target, GLsizei samples, GLenum format,
                                                            GLsizei width, GLsizei height)
{
    (void)target;
    set_renderbuffer(NULL_RenderbufferStorageMultisample, samples, format, width, height);
}

const null_entry noh_null_object_functions[] = { NULL_ENTRY(GenBuffers),
                                                 NULL_ENTRY(GenTextures),
                                                 NULL_ENTRY(GenRenderbuffers),
                                                 NULL_ENTRY(GenFramebuffers),
                                                 NULL_ENTRY(GenVertexArrays),
                                                 NULL_ENTRY(DeleteBuffers),
                                                 NULL_ENTRY(DeleteTextures),
                                                 NULL_ENTRY(DeleteRenderbuffers),
                                                 NULL_ENTRY(DeleteFramebuffers),
                                                 NULL_ENTRY(DeleteVertexArrays),
                                                 NULL_ENTRY(ObjectLabel),
                                                 NULL_ENTRY(BindBuffer),
                                                 NULL_ENTRY(BindBufferBase),
                                                 NULL_ENTRY(BindBufferRange),
                                                 NULL_ENTRY(BufferData),
                                                 NULL_ENTRY(BufferSubData),
                                                 NULL_ENTRY(ActiveTexture),
                                                 NULL_ENTRY(BindTexture),
                                                 NULL_ENTRY(TexStorage2D),
                                                 NULL_ENTRY(TexStorage3D),
                                                 NULL_ENTRY(TexSubImage2D),
                                                 NULL_ENTRY(TexSubImage3D),
                                                 NULL_ENTRY(CompressedTexSubImage2D),
                                                 NULL_ENTRY(TexParameteri),
                                                 NULL_ENTRY(BindRenderbuffer),
                                                 NULL_ENTRY(RenderbufferStorage),
                                                 NULL_ENTRY(RenderbufferStorageMultisample),
                                                 { NULL, NULL } };
