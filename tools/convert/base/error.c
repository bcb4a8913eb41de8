#include "error.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int model_fail(model_error *error, const char *where, const char *format, ...)
{
    if (!error) return 1;
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(error->what, sizeof error->what, format, arguments);
    va_end(arguments);
    (void)snprintf(error->where, sizeof error->where, "%s", where);
    return 1;
}

int model_fail_memory(model_error *error)
{
    return model_fail(error, "", "out of memory");
}

void *model_zeros(size_t count, size_t element_size)
{
    if (element_size == 0 || count > SIZE_MAX / element_size) return NULL;
    return calloc(count ? count : 1, element_size);
}

char *model_string_of(const char *text, size_t bytes)
{
    char *copy = malloc(bytes + 1);
    if (copy) {
        memcpy(copy, text, bytes);
        copy[bytes] = 0;
    }
    return copy;
}

char *model_string(const char *text)
{
    return model_string_of(text, strlen(text));
}
