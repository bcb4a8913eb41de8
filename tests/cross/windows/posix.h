/* posix.h: what the tests and the converter use of POSIX, for Windows; every file of theirs begins with it
 * (tools/mk/checks.mk). The library itself is built without it. */
#ifndef NOH_TESTS_CROSS_WINDOWS_POSIX_H
#define NOH_TESTS_CROSS_WINDOWS_POSIX_H

#define __USE_MINGW_ANSI_STDIO 1 /* printf as in C99 */

#include <malloc.h>
#include <stdlib.h>
#include <string.h>

/* What posix_memalign gives has to be freed by free(): all memory is at multiples of 64. */
void *windows_realloc(void *block, size_t bytes);
void windows_free(void *block);
void *windows_calloc(size_t count, size_t bytes);
char *windows_mkdtemp(char *name);

#define malloc(bytes) windows_realloc(NULL, bytes)
#define realloc windows_realloc
#define calloc windows_calloc
#define free windows_free /* not a macro with arguments: a field of that name is renamed wherever it is named */
#define posix_memalign(out, alignment, bytes) ((*(out) = windows_realloc(NULL, bytes)) ? 0 : 1)
#define setenv(name, value, overwrite) _putenv_s(name, value)
#define mkdtemp windows_mkdtemp

#endif
