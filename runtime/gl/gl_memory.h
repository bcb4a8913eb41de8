/* gl_memory.h: GL objects whose bytes are counted.
 *
 *   noh_gl_texel_bytes          bytes of one texel of an internal format
 *   noh_gl_texture_bytes        bytes of a texture, its mip levels summed
 *   noh_gl_renderbuffer_bytes   bytes of a renderbuffer, its samples counted
 *   noh_gl_buffer_create / noh_gl_buffer_delete
 *   noh_gl_texture_create / noh_gl_texture_delete
 *   noh_gl_renderbuffer_create / noh_gl_renderbuffer_delete
 *   noh_gl_framebuffer_create / noh_gl_framebuffer_delete
 *
 * The sizes are those that were requested: OpenGL ES does not tell what a driver adds
 * in alignment or metadata. The same three functions predict a budget and count the
 * use, so the two agree to the byte.
 *
 * Every create leaves nothing bound at the target it used, checks glGetError, and on
 * error deletes what it made: the ledger is then as before. Errors pending
 * before the call are cleared. Deleting an object twice does nothing.
 *
 * Threads: the context's own thread; the functions that only give bytes, any. */
#ifndef NOH_GL_GL_MEMORY_H
#define NOH_GL_GL_MEMORY_H

#include "gl/gl_api.h"
#include "gl/gl_caps.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The GL objects that exist now, and their bytes. Start with zeros. */
typedef struct noh_gl_ledger {
    uint64_t buffer_bytes, texture_bytes, renderbuffer_bytes;
    uint32_t buffers, textures, renderbuffers, framebuffers, programs;
} noh_gl_ledger;

typedef struct noh_gl_buffer {
    GLuint name; /* 0: none */
    uint64_t bytes;
} noh_gl_buffer;

/* A texture with immutable storage. */
typedef struct noh_gl_texture {
    GLuint name; /* 0: none */
    GLenum target;
    uint64_t bytes;
} noh_gl_texture;

typedef struct noh_gl_renderbuffer {
    GLuint name; /* 0: none */
    uint64_t bytes;
} noh_gl_renderbuffer;

typedef struct noh_gl_texture_desc {
    GLenum format;   /* a sized internal format that noh_gl_texel_bytes knows */
    uint32_t width;  /* texels, 1..65536 */
    uint32_t height; /* texels, 1..65536 */
    uint32_t layers; /* 0: a GL_TEXTURE_2D; else a GL_TEXTURE_2D_ARRAY of 1..65536 layers */
    uint32_t levels; /* mip levels; 0: one; at most 1 + log2 of the longer side */
    GLenum filter;   /* both filters; 0: GL_NEAREST. With GL_LINEAR and levels: trilinear */
    GLenum wrap;     /* 0: GL_CLAMP_TO_EDGE */
} noh_gl_texture_desc;

/* 0 for a format that noh does not use. */
uint32_t noh_gl_texel_bytes(GLenum format);

/* 0 for an impossible desc. */
uint64_t noh_gl_texture_bytes(const noh_gl_texture_desc *desc);

/* samples 0 and 1 are the same. 0 for impossible arguments. */
uint64_t noh_gl_renderbuffer_bytes(GLenum format, uint32_t width, uint32_t height, uint32_t samples);

uint64_t noh_gl_ledger_bytes(const noh_gl_ledger *ledger);

/* What objects are created with. The struct is not kept; the table and the ledger that it points to must outlive the
 * object. */
typedef struct noh_gl_device {
    const noh_gl_api *api;
    const noh_gl_caps *caps; /* noh_gl_morph_init and noh_gl_skin_init read it; NULL elsewhere */
    noh_gl_ledger *ledger;
    char *log; /* [log_bytes], as in noh_gl_program_create: why a shader does not compile; NULL: not kept */
    size_t log_bytes;
} noh_gl_device;

/* A buffer of `bytes` bytes, filled from `data` (NULL: content undefined).
 * A GL_ELEMENT_ARRAY_BUFFER is a state of the bound vertex array: bind vertex
 * array 0 before creating one.
 * errors  NOH_ERR_ARG bytes is 0; NOH_ERR_LIMIT does not fit GLsizeiptr;
 *         NOH_ERR_MEMORY GL_OUT_OF_MEMORY, `need` is bytes; NOH_ERR_GL otherwise */
noh_result noh_gl_buffer_create(const noh_gl_api *api, noh_gl_ledger *ledger, GLenum target, uint64_t bytes,
                                const void *data, GLenum usage, noh_gl_buffer *out, noh_error *error);
void noh_gl_buffer_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_buffer *buffer);

/* A texture without content. Leaves texture unit 0 active.
 * errors  NOH_ERR_ARG an impossible desc; NOH_ERR_MEMORY, NOH_ERR_GL as above.
 *         The caller compares with noh_gl_caps limits first: a driver's answer to
 *         a texture that is too large is only an NOH_ERR_GL */
noh_result noh_gl_texture_create(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_gl_texture_desc *desc,
                                 noh_gl_texture *out, noh_error *error);
void noh_gl_texture_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_texture *texture);

/* samples: 0 or 1 for none; the driver may take more than asked, the ledger counts what was asked. */
noh_result noh_gl_renderbuffer_create(const noh_gl_api *api, noh_gl_ledger *ledger, GLenum format, uint32_t width,
                                      uint32_t height, uint32_t samples, noh_gl_renderbuffer *out, noh_error *error);
void noh_gl_renderbuffer_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_renderbuffer *renderbuffer);

/* A framebuffer name; holds no bytes of its own. Never 0 on success. */
noh_result noh_gl_framebuffer_create(const noh_gl_api *api, noh_gl_ledger *ledger, GLuint *out, noh_error *error);
void noh_gl_framebuffer_delete(const noh_gl_api *api, noh_gl_ledger *ledger, GLuint *framebuffer);

#ifdef __cplusplus
}
#endif

#endif
