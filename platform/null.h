/* null.h: the calls that the platform "null" has counted and checked.
 *
 *   noh_null_report_of    counts, live objects, the first violation
 *   noh_null_calls_of     how often one function was called
 *   noh_null_count_anew   begin counting calls again: at the start of a frame
 *   noh_null_refuse       let one call of a function fail, as a driver that runs out of memory would
 *   noh_null_refused      whether that call has been made
 *
 * The platform "null" has no GL. Every function counts its calls and checks that GL would accept them: live names,
 * storage before content, updates within their buffer, uniforms with a program in use, complete framebuffers, and no
 * texture that is read and drawn to at once. Whatever GL would refuse is a violation: the first one is kept as text,
 * and glGetError gives GL_INVALID_OPERATION. Nothing is drawn: pixels read as zeros, so noh_gl_caps_probe finds no
 * abilities; set those that you want to test.
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
    uint32_t allocations;          /* calls that make an object or its storage; a steady frame has none */
    uint32_t violations;           /* since the context was made */
    char first[160];               /* the first violation: "glDrawElements: no program in use"; "" for none */
    uint32_t live[NOH_NULL_KINDS]; /* objects made and not yet deleted */
    uint32_t unlabelled;           /* of them, those without a debug label */
    uint64_t bytes;                /* storage of live buffers, textures and renderbuffers */
    uint32_t groups;               /* debug groups that are open */
} noh_null_report;

void noh_null_report_of(const noh_platform_context *context, noh_null_report *report);

/* name as in "glDrawElements"; 0 for names that the platform does not have. */
uint32_t noh_null_calls_of(const noh_platform_context *context, const char *name);

void noh_null_count_anew(noh_platform_context *context);

/* The k-th call (from 0) of the function from now on raises a GL error, once; where it makes names, it makes none. This
 * is not a violation. name NULL: no call is refused any more. Returns 0 for names that the platform does not have. */
int noh_null_refuse(noh_platform_context *context, const char *name, uint32_t k, GLenum error);
int noh_null_refused(const noh_platform_context *context);

#endif
