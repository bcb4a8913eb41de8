#include "platforms.h"

#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void noh_message_add(char *message, size_t message_bytes, const char *format, ...)
{
    if (message_bytes == 0) return;
    size_t length = strlen(message);
    if (length + 1 >= message_bytes) return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message + length, message_bytes - length, format, arguments);
    va_end(arguments);
}

void *noh_library_open(const char *path, char *message, size_t message_bytes)
{
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        const char *reason = dlerror();
        noh_message_add(message, message_bytes, "%s\n", reason ? reason : path);
    }
    return library;
}

noh_gl_proc noh_library_proc(void *library, const char *name)
{
    /* ISO C does not convert an object pointer to a function pointer; POSIX guarantees the same representation for
     * both. */
    void *symbol = dlsym(library, name);
    noh_gl_proc proc = NULL;
    if (symbol) memcpy(&proc, &symbol, sizeof proc);
    return proc;
}
