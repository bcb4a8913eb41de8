/* result.h: how the library reports errors.
 *
 * Bad data, too little memory, missing capabilities and driver errors are reported as a noh_result; outputs are then
 * untouched. A caller's bug (a NULL that is not allowed, an index past a count) is an assert: assert.h.
 * Threads: no state; any thread. */
#ifndef NOH_BASE_RESULT_H
#define NOH_BASE_RESULT_H

#include <stddef.h>
#include <stdint.h>

#include "core/base/assert.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A check at compile time that works in C99. */
#define NOH_STATIC_ASSERT(condition, name) typedef char noh_static_assert_##name[(condition) ? 1 : -1]

typedef enum noh_result {
    NOH_OK = 0,
    NOH_ERR_ARG,         /* an argument or a field of a desc is out of range: `what` names it */
    NOH_ERR_MEMORY,      /* memory is too small: `need` is the bytes needed */
    NOH_ERR_DATA,        /* a pack, clip or table is damaged: `where` is the byte offset, or the index at fault */
    NOH_ERR_VERSION,     /* the pack has another format version: `need` is the version of this library */
    NOH_ERR_LIMIT,       /* more than the format or this GPU can hold: `need` is the number requested */
    NOH_ERR_NOT_FOUND,   /* no object has this name or index: `where` is the index, `need` the count */
    NOH_ERR_UNSUPPORTED, /* the GPU or driver lacks a capability: `what` names it */
    NOH_ERR_GL           /* the driver refused a call: `where` is the GL error */
} noh_result;

/* An error, without formatting: the library has no stdio. Only a failing call writes it.
 * what   a sentence: a string constant, or text in the caller's memory (a shader's log); never NULL after a failure
 * where  the byte or index at fault, or 0
 * need   the size or count required, or 0 */
typedef struct noh_error {
    noh_result result;
    const char *what;
    uint64_t where;
    uint64_t need;
} noh_error;

/* The result in words: "too little memory". Never NULL. */
const char *noh_result_text(noh_result result);

/* Fill `error` (which may be NULL) and return its result. */
noh_result noh_fail(noh_error *error, noh_result result, const char *what, uint64_t where, uint64_t need);

#ifdef __cplusplus
}
#endif

#endif
