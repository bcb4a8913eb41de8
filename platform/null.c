/* null.c: no GL: the library's logic runs, and every call is counted and checked. */
#include "null_internal.h"

#include "platforms.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

noh_platform_context *noh_null_current;

static const char *const call_names[NULL_CALL_COUNT] = {
#define NULL_NAME(field, result, parameters) "gl" #field,
    NULL_CALLS(NULL_NAME)
#undef NULL_NAME
        "glFramebufferTexture",
    "glObjectLabel",
    "glPushDebugGroup",
    "glPopDebugGroup",
    "glDebugMessageCallback",
    "glDebugMessageControl"
};

/* --- counts and violations --- */

noh_platform_context *noh_null_count(int call)
{
    noh_platform_context *c = noh_null_current;
    c->counts[call]++;
    c->refusing = c->refused_call == call && c->refused_in-- == 0;
    if (c->refusing) {
        c->refused_call = -1;
        c->refused = 1;
        if (c->error == GL_NO_ERROR) c->error = c->refused_error;
    }
    return c;
}

int noh_null_refuse(noh_platform_context *context, const char *name, uint32_t k, GLenum error)
{
    context->refused_call = -1;
    context->refused_in = k;
    context->refused_error = error;
    context->refused = 0;
    for (int call = 0; name && call < NULL_CALL_COUNT; call++) {
        if (strcmp(call_names[call], name) == 0) context->refused_call = call;
    }
    return !name || context->refused_call >= 0;
}

int noh_null_refused(const noh_platform_context *context)
{
    return context->refused;
}

void noh_null_wrong(int call, const char *format, ...)
{
    noh_platform_context *c = noh_null_current;
    c->violations++;
    if (c->error == GL_NO_ERROR) c->error = GL_INVALID_OPERATION;
    if (c->first[0]) return;
    noh_message_add(c->first, sizeof c->first, "%s: ", call_names[call]);
    size_t length = strlen(c->first);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(c->first + length, sizeof c->first - length, format, arguments);
    va_end(arguments);
}

void noh_null_report_of(const noh_platform_context *context, noh_null_report *report)
{
    memset(report, 0, sizeof *report);
    for (int call = 0; call < NULL_CALL_COUNT; call++) report->calls += context->counts[call];
    report->draws = context->draws;
    report->outside = context->outside;
    report->allocations = context->allocations;
    report->violations = context->violations;
    memcpy(report->first, context->first, sizeof report->first);
    report->groups = context->groups;
    for (int kind = 0; kind < NOH_NULL_KINDS; kind++) {
        for (GLuint name = 1; name < context->next[kind]; name++) {
            const null_object *object = &context->objects[kind][name];
            report->live[kind] += object->alive != 0;
            report->unlabelled += object->alive && !object->labelled;
            report->bytes += object->alive ? object->bytes : 0;
        }
    }
}

uint32_t noh_null_calls_of(const noh_platform_context *context, const char *name)
{
    for (int call = 0; call < NULL_CALL_COUNT; call++) {
        if (strcmp(call_names[call], name) == 0) return context->counts[call];
    }
    return 0;
}

void noh_null_count_anew(noh_platform_context *context)
{
    memset(context->counts, 0, sizeof context->counts);
    context->draws = context->outside = context->allocations = 0;
}

/* --- the interface --- */

static noh_result create(const noh_platform_desc *desc, noh_platform_context **out, char *message, size_t message_bytes)
{
    if (message_bytes) message[0] = 0;
    noh_platform_context *context = calloc(1, sizeof *context);
    if (!context) return NOH_ERR_MEMORY;
    context->width = desc && desc->width ? desc->width : 1;
    context->height = desc && desc->height ? desc->height : 1;
    for (int kind = 0; kind < NOH_NULL_KINDS; kind++) context->next[kind] = 1;
    context->refused_call = -1;
    context->viewport[2] = (GLint)context->width;
    context->viewport[3] = (GLint)context->height;
    noh_null_current = context;
    *out = context;
    return NOH_OK;
}

static noh_result make_current(noh_platform_context *context)
{
    noh_null_current = context;
    return NOH_OK;
}

static noh_gl_proc find(const null_entry *entries, const char *name)
{
    for (; entries->name; entries++) {
        if (strcmp(entries->name, name) == 0) return entries->proc;
    }
    return NULL;
}

static noh_gl_proc get_proc(void *user, const char *name)
{
    (void)user;
    static const null_entry *const tables[] = { noh_null_object_functions, noh_null_program_functions,
                                                noh_null_draw_functions, noh_null_state_functions };
    noh_gl_proc proc = NULL;
    for (size_t i = 0; i < sizeof tables / sizeof *tables && !proc; i++) proc = find(tables[i], name);
    return proc;
}

static noh_result present(noh_platform_context *context)
{
    (void)context;
    return NOH_OK;
}

static void size(noh_platform_context *context, uint32_t *width, uint32_t *height)
{
    *width = context->width;
    *height = context->height;
}

static void destroy(noh_platform_context *context)
{
    if (noh_null_current == context) noh_null_current = NULL;
    free(context);
}

const noh_platform noh_platform_null = { "null",   "no GL: calls are counted and checked, nothing is drawn",
                                         create,   make_current,
                                         get_proc, present,
                                         size,     destroy };
