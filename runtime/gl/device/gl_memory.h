/* gl_memory.h: GL objects with counted bytes.
 *
 *   noh_gl_texel_bytes          bytes of one texel of an internal format
 *   noh_gl_texture_bytes        bytes of a texture with its mip levels
 *   noh_gl_renderbuffer_bytes   bytes of a renderbuffer with its samples
 *   noh_gl_ledger_bytes         bytes of all existing objects
 *   noh_gl_buffer_create / noh_gl_buffer_delete
 *   noh_gl_texture_create / noh_gl_texture_delete
 *   noh_gl_renderbuffer_create / noh_gl_renderbuffer_delete
 *   noh_gl_framebuffer_create / noh_gl_framebuffer_delete
 *
 * Sizes are the requested sizes: OpenGL ES does not report what a driver adds for alignment or metadata. The same
 * functions plan a budget and count its use, so both agree to the byte.
 *
 * Every create clears pending GL errors first and leaves nothing bound to its target; on error it deletes what it made,
 * and the ledger is unchanged. Deleting an object twice does nothing.
 *
 * Threads: the context's own thread; any thread for the functions that only return bytes. */
#ifndef NOH_GL_GL_MEMORY_H
#define NOH_GL_GL_MEMORY_H

#include "gl/device/gl_api.h"
#include "gl/device/gl_caps.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Counts and bytes of the existing GL objects. Start with zeros. */
typedef struct noh_gl_ledger {
    uint64_t buffer_bytes, texture_bytes, renderbuffer_bytes;
    uint32_t buffers, textures, renderbuffers, framebuffers, programs;
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

typedef struct noh_gl_renderbuffer {
    unsigned name; /* 0: none */
    uint64_t bytes;
} noh_gl_renderbuffer;

#define NOH_GL_CUBE UINT32_MAX

typedef struct noh_gl_texture_desc {
    unsigned format; /* a sized internal format known to noh_gl_texel_bytes, an ETC2 format, or RG11_EAC */
    uint32_t width;  /* texels, 1..65536 */
    uint32_t height; /* texels, 1..65536 */
    uint32_t layers; /* 0: GL_TEXTURE_2D; NOH_GL_CUBE: GL_TEXTURE_CUBE_MAP with six square faces; 1..65536:
                      * GL_TEXTURE_2D_ARRAY with this many layers */
    uint32_t levels; /* mip levels, at most 1 + log2 of the longer side; 0: one */
    unsigned filter; /* for minification and magnification; 0: GL_NEAREST. GL_LINEAR with mip levels is trilinear */
    unsigned wrap;   /* 0: GL_CLAMP_TO_EDGE */
} noh_gl_texture_desc;

/* The bytes of one texel of an internal format; 0 for a block format, or one that noh does not use. */
uint32_t noh_gl_texel_bytes(unsigned format);

/* The bytes of a texture; 0 for an invalid desc. */
uint64_t noh_gl_texture_bytes(const noh_gl_texture_desc *desc);

/* The bytes of a renderbuffer; 0 for invalid arguments. samples 0 and 1 are equal. */
uint64_t noh_gl_renderbuffer_bytes(unsigned format, uint32_t width, uint32_t height, uint32_t samples);

/* The bytes of all existing objects. */
uint64_t noh_gl_ledger_bytes(const noh_gl_ledger *ledger);

/* The context for making objects. The struct is not kept; the table and the ledger must outlive the objects. */
typedef struct noh_gl_device {
    const noh_gl_api *api;
    const noh_gl_caps *caps; /* read by noh_gl_morph_init and noh_gl_skin_init; may be NULL for the renderer */
    noh_gl_ledger *ledger;
    char *log; /* [log_bytes] receives compile errors of shaders, as in noh_gl_program_create; NULL: no log */
    size_t log_bytes;
} noh_gl_device;

/* Make a buffer of `bytes` bytes, filled from `data` (NULL: contents undefined). A GL_ELEMENT_ARRAY_BUFFER becomes part
 * of the bound vertex array: bind vertex array 0 first.
 * errors  ARG bytes is 0; LIMIT bytes does not fit a GLsizeiptr; MEMORY GL_OUT_OF_MEMORY (need: `bytes`); GL the driver
 *         refused the buffer */
noh_result noh_gl_buffer_create(const noh_gl_api *api, noh_gl_ledger *ledger, unsigned target, uint64_t bytes,
                                const void *data, unsigned usage, noh_gl_buffer *out, noh_error *error);
void noh_gl_buffer_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_buffer *buffer);

/* Make a texture with undefined contents. Leaves texture unit 0 active. Compare the size with the limits of noh_gl_caps
 * first: for a texture that is too large the result is only GL.
 * errors  ARG an invalid desc; MEMORY, GL as noh_gl_buffer_create */
noh_result noh_gl_texture_create(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_gl_texture_desc *desc,
                                 noh_gl_texture *out, noh_error *error);
void noh_gl_texture_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_texture *texture);

/* Make a renderbuffer. samples: 0 or 1 for none. The driver may use more samples than requested; the ledger counts the
 * requested ones.
 * errors  ARG an unknown format, a size of 0, or more than 64 samples; MEMORY, GL as noh_gl_buffer_create */
noh_result noh_gl_renderbuffer_create(const noh_gl_api *api, noh_gl_ledger *ledger, unsigned format, uint32_t width,
                                      uint32_t height, uint32_t samples, noh_gl_renderbuffer *out, noh_error *error);
void noh_gl_renderbuffer_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_renderbuffer *renderbuffer);

/* Make a framebuffer; it has no bytes of its own.
 * errors  MEMORY, GL as noh_gl_buffer_create */
noh_result noh_gl_framebuffer_create(const noh_gl_api *api, noh_gl_ledger *ledger, unsigned *out, noh_error *error);
void noh_gl_framebuffer_delete(const noh_gl_api *api, noh_gl_ledger *ledger, unsigned *framebuffer);

#ifdef __cplusplus
}
#endif

#endif
