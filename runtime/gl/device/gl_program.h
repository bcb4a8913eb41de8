/* gl_program.h: compiling and linking shaders.
 *
 *   noh_gl_program_create  compile up to three stages, link, bind samplers and blocks
 *   noh_gl_program_delete
 *
 * A source is a #version line and the rest of the text in pieces, passed to glShaderSource without copying.
 *
 * Threads: the context's own thread, for every function. */
#ifndef NOH_GL_GL_PROGRAM_H
#define NOH_GL_GL_PROGRAM_H

#include "core/base/limits.h"
#include "gl/device/gl_api.h"
#include "gl/device/gl_memory.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The text of one shader stage. */
typedef struct noh_gl_source {
    const char *version;       /* "#version 300 es\n" */
    const char *const *pieces; /* the text after it */
    uint32_t piece_count;      /* 1..NOH_GL_PIECES_MAX */
} noh_gl_source;

/* An attribute of a vertex array, as a vertex shader declares it. */
typedef struct noh_gl_input {
    unsigned location;
    unsigned type; /* type of the declaration: GL_FLOAT_VEC3, GL_INT_VEC2, GL_UNSIGNED_INT and so on */
} noh_gl_input;

typedef struct noh_gl_program_desc {
    const char *name;              /* for the debug label and the log; NULL: none */
    const noh_gl_source *vertex;   /* required */
    const noh_gl_source *geometry; /* NULL: none */
    const noh_gl_source *fragment; /* required */
    const char *version;           /* a #version line with its newline for all stages, which must be equal in ES; NULL:
                                    * the sources' own */
    const char *defines; /* whole lines directly after #version in every stage: #extension, #define; NULL: none */
    const char *geometry_defines; /* more such lines for the geometry stage only; NULL: none */

    const char *const *samplers; /* sampler i reads texture unit i; names removed by the linker are skipped */
    uint32_t sampler_count;      /* default 0 */
    const char *const *blocks;   /* uniform block i reads binding i; names removed by the linker are skipped */
    uint32_t block_count;        /* default 0 */

    const char *const *varyings; /* outputs of the vertex stage for transform feedback */
    uint32_t varying_count;      /* default 0: no transform feedback */
    unsigned varying_mode;       /* 0: GL_INTERLEAVED_ATTRIBS */

    /* All attributes of the vertex arrays that the program will draw. Reading an integer as a float, or a missing
     * attribute, is undefined and no GL error, so each active input is checked: it must be at one of these locations,
     * of the same kind (float, integer, unsigned), with no more components, except a vec4 whose w is then 1 */
    const noh_gl_input *inputs;
    uint32_t input_count; /* default 0: not checked */

    noh_gl_ledger *ledger; /* counts the program; NULL: not counted */
} noh_gl_program_desc;

/* Compile, link and label a program. Leaves program 0 in use; `program` is untouched on error.
 * log     [log_bytes], NULL with 0: no log. Empty on success, otherwise "NAME: STAGE: " and the driver's log, cut to
 *         fit and always zero-terminated. For the library's shaders, comments in shaders.gen.c explain its source
 *         numbers
 * memory  none
 * errors  ARG a stage is missing or has too many pieces; DATA a stage does not compile or link (`what` names it; where:
 *         the GL stage, 0: linking), or it reads an input that is not in `inputs` (where: the location); GL, MEMORY the
 *         driver refused a call */
noh_result noh_gl_program_create(const noh_gl_api *api, const noh_gl_program_desc *desc, unsigned *program, char *log,
                                 size_t log_bytes, noh_error *error);

/* Delete a program and set it to 0; does nothing for 0. ledger NULL: the program was not counted. */
void noh_gl_program_delete(const noh_gl_api *api, noh_gl_ledger *ledger, unsigned *program);

#ifdef __cplusplus
}
#endif

#endif
