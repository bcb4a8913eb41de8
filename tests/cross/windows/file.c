/* file.c: platform/file.c, file_write.c, memory and mkdtemp for Windows, as far as tests need them: files are read and
 * written whole. */
#include <direct.h>
#include <errno.h>
#include <stdio.h>
#include <time.h>

#include "platform.h"

static noh_result fail_errno(noh_error *error, noh_result result)
{
    return noh_fail(error, result, strerror(errno), (uint64_t)errno, 0);
}

noh_result noh_file_map(const char *path, noh_file *out, noh_error *error)
{
    FILE *file = fopen(path, "rb");
    char *data = NULL;
    size_t bytes = 0, room = 0;
    if (!file) return fail_errno(error, NOH_ERR_NOT_FOUND);
    do {
        if (bytes == room) data = realloc(data, room = room * 2u + 65536u);
        if (!data) abort();
        bytes += fread(data + bytes, 1, room - bytes, file);
    } while (bytes == room);
    (void)fclose(file);
    out->data = data;
    out->bytes = bytes;
    return NOH_OK;
}

void noh_file_unmap(noh_file *file)
{
    void *data;
    memcpy(&data, &file->data, sizeof data);
    free(data);
    memset(file, 0, sizeof *file);
}

noh_result noh_file_write(const char *path, const void *data, size_t bytes, noh_error *error)
{
    FILE *file = fopen(path, "wb");
    if (!file) return fail_errno(error, NOH_ERR_DATA);
    const int wrong = fwrite(data, 1, bytes, file) != bytes;
    return fclose(file) != 0 || wrong ? fail_errno(error, NOH_ERR_DATA) : NOH_OK;
}

uint64_t noh_clock_ns(void)
{
    return (uint64_t)clock() * (1000000000u / CLOCKS_PER_SEC);
}

uint64_t noh_cpu_clock_ns(void)
{
    return noh_clock_ns();
}

uint64_t noh_thread_clock_ns(void)
{
    return noh_clock_ns();
}

#define HEADER 64u /* of a block, with its size */

void windows_free(void *block)
{
    if (block) _aligned_free((char *)block - HEADER);
}

void *windows_realloc(void *block, size_t bytes)
{
    char *grown = _aligned_malloc(bytes + HEADER, HEADER);
    size_t before = 0;
    if (!grown) return NULL;
    memcpy(grown, &bytes, sizeof bytes);
    if (block) memcpy(&before, (char *)block - HEADER, sizeof before);
    if (block) memcpy(grown + HEADER, block, before < bytes ? before : bytes);
    windows_free(block);
    return grown + HEADER;
}

void *windows_calloc(size_t count, size_t bytes)
{
    void *block = bytes && count > SIZE_MAX / bytes ? NULL : malloc(count * bytes);
    if (block) memset(block, 0, count * bytes);
    return block;
}

char *windows_mkdtemp(char *name)
{
    char *end = name + strlen(name) - 6;
    for (unsigned i = 0; i < 1000000u; i++) {
        (void)sprintf(end, "%06u", (i + (unsigned)clock()) % 1000000u);
        if (_mkdir(name) == 0) return name;
        if (errno != EEXIST) return NULL;
    }
    return NULL;
}
