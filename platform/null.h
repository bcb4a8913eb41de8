/* null.h: the counted and checked calls of the platform "null".
 *
 *   noh_null_report_of    counts, live objects, the first violation
 *   noh_null_calls_of     how often one function was called
 *   noh_null_count_anew   reset the counts of calls, for example at the start of a frame
 *   noh_null_refuse       let one call of a function fail, like a driver out of memory
 *   noh_null_refused      whether this call has been made
 *
 * The platform "null" has no GL. Every function counts its calls and checks that GL would accept them: live names,
 * storage before content, updates within their buffer, uniforms with a program in use, complete framebuffers, and no
 * texture both read and drawn to. A call that GL would refuse is a violation: the first one is kept as text, and
 * glGetError returns GL_INVALID_OPERATION. Nothing is drawn: pixels read as zeros, so noh_gl_caps_probe finds no
 * abilities; set the ones to test.
 *
 * One context is current at a time for the whole process. */
#ifndef NOH_PLATFORM_NULL_H
#define NOH_PLATFORM_NULL_H

#include "platform.h"

typedef enum noh_null_kind {
    NOH_NULL_BUFFER,
    NOH_NULL_TEXTURE,
    NOH_NULL_RENDERBUFFER,
    NOH_NULL_FRAMEBUFFER,
    NOH_NULL_VERTEX_ARRAY,
    NOH_NULL_PROGRAM,
    NOH_NULL_SHADER
} noh_null_kind;
#define NOH_NULL_KINDS 7

typedef struct noh_null_report {
    uint64_t calls;                /* since noh_null_count_anew, like the next three */
    uint32_t draws;                /* glDraw* */
    uint32_t outside;              /* draws and clears outside every debug group */
    uint32_t allocations;          /* calls that create an object or its storage; none in a steady frame */
    uint32_t violations;           /* since the context was created */
    char first[160];               /* the first violation: "glDrawElements: no program in use"; "" for none */
    uint32_t live[NOH_NULL_KINDS]; /* live objects */
    uint32_t unlabelled;           /* live objects without a debug label */
    uint64_t bytes;                /* storage of live buffers, textures and renderbuffers */
    uint32_t groups;               /* open debug groups */
} noh_null_report;

void noh_null_report_of(const noh_platform_context *context, noh_null_report *report);

/* name as in "glDrawElements". Returns 0 for unknown names. */
uint32_t noh_null_calls_of(const noh_platform_context *context, const char *name);

void noh_null_count_anew(noh_platform_context *context);

/* Let the k-th call (from 0) of the function from now on raise a GL error, once; a function that returns names returns
 * none. This is not a violation. name NULL: refuse no call. Returns 0 for unknown names. */
int noh_null_refuse(noh_platform_context *context, const char *name, uint32_t k, GLenum error);
int noh_null_refused(const noh_platform_context *context);

#endif
