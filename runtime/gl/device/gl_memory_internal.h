/* gl_memory_internal.h: renderbuffers and framebuffers with counted bytes. */
#ifndef NOH_DEVICE_GL_MEMORY_INTERNAL_H
#define NOH_DEVICE_GL_MEMORY_INTERNAL_H

#include "noh/low_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The bytes of a renderbuffer; 0 for invalid arguments. samples 0 and 1 are equal. */
uint64_t noh_gl_renderbuffer_bytes(unsigned format, uint32_t width, uint32_t height, uint32_t samples);

typedef struct noh_gl_renderbuffer {
    unsigned name; /* 0: none */
    uint64_t bytes;
} noh_gl_renderbuffer;

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
