/* null_internal.h (private to null*.c): the state of a GL that does nothing. */
#ifndef NOH_PLATFORM_NULL_INTERNAL_H
#define NOH_PLATFORM_NULL_INTERNAL_H

#include "null.h"
#include "noh/gl_device.h"

#define NULL_OBJECTS_MAX 4096 /* per kind; names are never reused, so that stale ones are detected */
#define NULL_UNITS 32
#define NULL_ATTRIBUTES 16
#define NULL_ATTACHMENTS 5 /* four colours, depth */

typedef struct null_attribute {
    GLuint buffer;
    int enabled;
    uint64_t offset, stride, bytes; /* bytes of one element */
    GLuint divisor;
} null_attribute;

typedef struct null_attachment {
    GLuint name; /* 0: nothing is attached */
    int is_texture;
} null_attachment;

/* An object of any kind. Fields that a kind does not use stay zero. */
typedef struct null_object {
    int alive, labelled;
    int bound;   /* bound at least once; before, the name has no object */
    int ready;   /* has storage; compiled; linked */
    GLenum type; /* texture target or shader stage */
    uint64_t bytes;
    GLsizei width, height, layers, levels;
    GLuint elements; /* vertex array */
    null_attribute attributes[NULL_ATTRIBUTES];
    null_attachment attachments[NULL_ATTACHMENTS]; /* framebuffer */
    unsigned stages;                               /* program: 1 vertex, 2 fragment, 4 geometry */
} null_object;

typedef enum null_buffer_slot { NULL_ARRAY, NULL_UNIFORM, NULL_FEEDBACK, NULL_BUFFER_SLOTS } null_buffer_slot;

typedef struct null_unit {
    GLuint flat, array, cube; /* GL_TEXTURE_2D, GL_TEXTURE_2D_ARRAY, GL_TEXTURE_CUBE_MAP */
} null_unit;

/* Every function of the platform; calls are counted by these. */
#define NULL_CALLS(X) NOH_GL_REQUIRED(X) NOH_GL_EXTRA(X)
enum {
#define NULL_CALL(field, result, parameters) NULL_##field,
    NULL_CALLS(NULL_CALL)
#undef NULL_CALL
        NULL_FramebufferTexture,
    NULL_ObjectLabel,
    NULL_PushDebugGroup,
    NULL_PopDebugGroup,
    NULL_DebugMessageCallback,
    NULL_DebugMessageControl,
    NULL_CALL_COUNT
};

struct noh_platform_context {
    uint32_t width, height;
    uint32_t counts[NULL_CALL_COUNT];
    uint32_t draws, outside, allocations, violations;
    char first[160];
    int refused_call;    /* -1: none */
    uint32_t refused_in; /* calls before the one that fails */
    GLenum refused_error;
    int refusing, refused; /* the current call fails; the failing call was made */
    GLenum error;
    uint32_t groups;
    GLint viewport[4];
    GLuint next[NOH_NULL_KINDS]; /* the next name */
    null_object objects[NOH_NULL_KINDS][NULL_OBJECTS_MAX];
    GLuint buffers[NULL_BUFFER_SLOTS];
    GLuint unit;
    null_unit units[NULL_UNITS];
    GLuint program, vertex_array, renderbuffer, draw_framebuffer, read_framebuffer;
};

/* The current context; NULL: none, and no function may be called. */
extern noh_platform_context *noh_null_current;

/* ---- null.c: counts and violations ---- */

/* Count a call of the current context. */
noh_platform_context *noh_null_count(int call);

/* Report a violation; format: the text after the function's name. */
void noh_null_wrong(int call, const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 2, 3)))
#endif
    ;

/* ---- null_objects.c: names and their objects ---- */

/* The live object of a name; a violation and NULL if there is none. */
null_object *noh_null_object(int call, noh_null_kind kind, GLuint name);

/* Create a name of a kind; delete it. */
GLuint noh_null_make(int call, noh_null_kind kind);
void noh_null_delete(int call, noh_null_kind kind, GLsizei count, const GLuint *names);

/* The object bound to a target; a violation and NULL if there is none. */
null_object *noh_null_texture_at(int call, GLenum target);
null_object *noh_null_buffer_at(int call, GLenum target);

/* ---- null_draw.c ---- */

/* 1 if the framebuffer is complete; framebuffer 0 is the default one. */
int noh_null_complete(const noh_platform_context *c, GLuint framebuffer);

/* ---- the tables of functions, one per file, each ended by {NULL, NULL} ---- */

typedef struct null_entry {
    const char *name; /* "glBindBuffer" */
    noh_gl_proc proc;
} null_entry;
extern const null_entry noh_null_object_functions[], noh_null_program_functions[], noh_null_draw_functions[],
    noh_null_state_functions[];

#define NULL_ENTRY(field)                      \
    {                                          \
        "gl" #field, (noh_gl_proc)null_##field \
    }

#endif
