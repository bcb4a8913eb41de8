/* gl_program.h: shaders into programs.
 *
 *   noh_gl_program_create   compile up to three stages, link, bind units and blocks
 *   noh_gl_program_delete
 *
 * Sources come as tools/embed wrote them: the #version line apart from the rest,
 * the rest in pieces that glShaderSource takes as they are. Nothing is copied.
 *
 * Threads: the context's own thread, for every function. */
#ifndef NOH_GL_GL_PROGRAM_H
#define NOH_GL_GL_PROGRAM_H

#include "base/limits.h"
#include "gl/gl_api.h"
#include "gl/gl_memory.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One shader stage's text. tools/embed makes these. */
typedef struct noh_gl_source {
    const char *version;       /* "#version 300 es\n" */
    const char *const *pieces; /* what follows it */
    uint32_t piece_count;      /* 1..NOH_GL_PIECES_MAX */
} noh_gl_source;

typedef struct noh_gl_program_desc {
    const char *name;              /* debug label and head of the log; NULL: none */
    const noh_gl_source *vertex;   /* required */
    const noh_gl_source *geometry; /* NULL: none */
    const noh_gl_source *fragment; /* required */
    const char *version;           /* instead of each source's own #version line, with its newline; NULL: its own.
                                    * ES wants the same version in all stages of a program */
    const char *defines; /* whole lines put right after #version in every stage: #extension, #define; NULL: none */
    const char *geometry_defines; /* more such lines, in the geometry stage only; NULL: none */

    const char *const *samplers; /* sampler i reads texture unit i. A name that the linker dropped is skipped */
    uint32_t sampler_count;      /* default 0 */
    const char *const *blocks;   /* uniform block i is fed from binding i; dropped names are skipped */
    uint32_t block_count;        /* default 0 */

    const char *const *varyings; /* transform feedback outputs of the vertex stage */
    uint32_t varying_count;      /* default 0: no transform feedback */
    GLenum varying_mode;         /* 0: GL_INTERLEAVED_ATTRIBS */

    noh_gl_ledger *ledger; /* counts the program; NULL: not counted */
} noh_gl_program_desc;

/* Compile, link and label one program. Leaves program 0 in use.
 * memory  none; log_bytes of `log` (NULL with 0: no log): empty on success, else
 *         "NAME: STAGE: " and the driver's words, cut to fit, always ended by a zero.
 *         Its source numbers are those named in the comments of the embedded file
 * errors  NOH_ERR_ARG a stage is missing or has too many pieces; NOH_ERR_DATA it does
 *         not compile or link, `what` says which, `where` is the GL stage (0 for link);
 *         NOH_ERR_GL the driver made no object. `program` is untouched on error */
noh_result noh_gl_program_create(const noh_gl_api *api, const noh_gl_program_desc *desc, GLuint *program, char *log,
                                 size_t log_bytes, noh_error *error);

/* ledger NULL: not counted. A program that is 0 already is left alone. */
void noh_gl_program_delete(const noh_gl_api *api, noh_gl_ledger *ledger, GLuint *program);

#ifdef __cplusplus
}
#endif

#endif
