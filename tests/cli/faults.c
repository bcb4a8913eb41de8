/* faults.c: a library to preload into a program (LD_PRELOAD), which makes the N-th call of a kind fail.
 *
 *   NOH_FAULT=kill:N    the process is killed in the N-th call that changes a file (open for writing, write, fsync,
 *                       rename, unlink): the call is not made; of a write, half of the bytes are written
 *   NOH_FAULT=full:N    the N-th such call and all later ones fail with ENOSPC; of a write, half is written first
 *   NOH_FAULT=memory:N  the N-th allocation fails
 *   NOH_FAULT_COUNT=FILE  at the end, write to FILE how many calls there were: "files F, allocations A" */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

extern void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t);
extern void *__libc_memalign(size_t, size_t);

static enum { NONE, KILL, FULL, MEMORY } kind;
static long at, files, allocations;

__attribute__((constructor)) static void begin(void)
{
    const char *fault = getenv("NOH_FAULT");
    const char *colon = fault ? strchr(fault, ':') : NULL;
    if (!colon) return;
    kind = *fault == 'k' ? KILL : *fault == 'f' ? FULL : MEMORY;
    at = atol(colon + 1);
    allocations = files = 0; /* what ran before this is not the program's */
}

__attribute__((destructor)) static void end(void)
{
    const char *path = getenv("NOH_FAULT_COUNT");
    FILE *out;
    const long f = files, a = allocations;
    kind = NONE;
    if (!path || !(out = fopen(path, "w"))) return;
    fprintf(out, "%ld %ld\n", f, a);
    fclose(out);
}

/* 1: the call fails; it does not return where the process is killed */
static int fails_file(int descriptor, const void *data, size_t bytes)
{
    static ssize_t (*real)(int, const void *, size_t);
    const long n = __atomic_add_fetch(&files, 1, __ATOMIC_SEQ_CST);
    if (!((kind == KILL && n == at) || (kind == FULL && n >= at))) return 0;
    if (bytes > 1 && n == at) {
        if (!real) *(void **)&real = dlsym(RTLD_NEXT, "write");
        (void)!real(descriptor, data, bytes / 2u);
    }
    if (kind == KILL) raise(SIGKILL);
    errno = ENOSPC;
    return 1;
}

static int fails_memory(void)
{
    return __atomic_add_fetch(&allocations, 1, __ATOMIC_SEQ_CST) == at && kind == MEMORY;
}

/* ---- files ---- */

#define REAL(type, name, ...)                                                                                          \
    static type (*real)(__VA_ARGS__);                                                                                  \
    if (!real) *(void **)&real = dlsym(RTLD_NEXT, name)

ssize_t write(int descriptor, const void *data, size_t bytes)
{
    REAL(ssize_t, "write", int, const void *, size_t);
    if (descriptor > STDERR_FILENO && fails_file(descriptor, data, bytes)) return -1;
    return real(descriptor, data, bytes);
}

int fsync(int descriptor)
{
    REAL(int, "fsync", int);
    return fails_file(-1, NULL, 0) ? -1 : real(descriptor);
}

int renameat(int from_folder, const char *from, int to_folder, const char *to)
{
    REAL(int, "renameat", int, const char *, int, const char *);
    return fails_file(-1, NULL, 0) ? -1 : real(from_folder, from, to_folder, to);
}

int rename(const char *from, const char *to)
{
    REAL(int, "rename", const char *, const char *);
    return fails_file(-1, NULL, 0) ? -1 : real(from, to);
}

/* A full disk does not refuse to delete. */
int unlinkat(int folder, const char *path, int flags)
{
    REAL(int, "unlinkat", int, const char *, int);
    return kind == KILL && fails_file(-1, NULL, 0) ? -1 : real(folder, path, flags);
}

int openat(int folder, const char *path, int flags, ...)
{
    mode_t mode;
    va_list more;
    REAL(int, "openat", int, const char *, int, ...);
    va_start(more, flags);
    mode = flags & O_CREAT ? (mode_t)va_arg(more, int) : 0;
    va_end(more);
    return flags & O_CREAT && fails_file(-1, NULL, 0) ? -1 : real(folder, path, flags, mode);
}

/* ---- memory ---- */

void *malloc(size_t bytes)
{
    return fails_memory() ? NULL : __libc_malloc(bytes);
}

void *calloc(size_t count, size_t bytes)
{
    return fails_memory() ? NULL : __libc_calloc(count, bytes);
}

void *realloc(void *block, size_t bytes)
{
    return fails_memory() ? NULL : __libc_realloc(block, bytes);
}

void *aligned_alloc(size_t alignment, size_t bytes)
{
    return fails_memory() ? NULL : __libc_memalign(alignment, bytes);
}

int posix_memalign(void **block, size_t alignment, size_t bytes)
{
    *block = fails_memory() ? NULL : __libc_memalign(alignment, bytes);
    return *block ? 0 : ENOMEM;
}
