#define _POSIX_C_SOURCE 200809L

#include "platform.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static noh_result fail_errno(noh_error *error, noh_result result, int code)
{
    return noh_fail(error, result, strerror(code), (uint64_t)code, 0);
}

static noh_result map_open_file(int descriptor, noh_file *out, noh_error *error)
{
    struct stat status;
    if (fstat(descriptor, &status) != 0) return fail_errno(error, NOH_ERR_NOT_FOUND, errno);
    if (S_ISDIR(status.st_mode)) return fail_errno(error, NOH_ERR_ARG, EISDIR);
    if (!S_ISREG(status.st_mode)) return noh_fail(error, NOH_ERR_ARG, "not a regular file", 0, 0);
    if ((uint64_t)status.st_size > (uint64_t)SIZE_MAX / 2) return fail_errno(error, NOH_ERR_MEMORY, EFBIG);
    size_t bytes = (size_t)status.st_size;
    void *data = NULL;
    if (bytes) {
        data = mmap(NULL, bytes, PROT_READ, MAP_PRIVATE, descriptor, 0);
        if (data == MAP_FAILED) return fail_errno(error, NOH_ERR_MEMORY, errno);
    }
    out->data = data;
    out->bytes = bytes;
    return NOH_OK;
}

noh_result noh_file_map(const char *path, noh_file *out, noh_error *error)
{
    /* O_NONBLOCK: opening a pipe without a writer must not wait. */
    int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) return fail_errno(error, NOH_ERR_NOT_FOUND, errno);
    noh_result result = map_open_file(descriptor, out, error);
    close(descriptor);
    return result;
}

void noh_file_unmap(noh_file *file)
{
    if (file->data) {
        /* munmap takes a plain pointer; nothing is written through it. */
        void *data;
        memcpy(&data, &file->data, sizeof data);
        munmap(data, file->bytes);
    }
    file->data = NULL;
    file->bytes = 0;
}

static uint64_t read_clock(clockid_t clock)
{
    struct timespec now;
    if (clock_gettime(clock, &now) != 0) return 0;
    return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

uint64_t noh_clock_ns(void)
{
    return read_clock(CLOCK_MONOTONIC);
}

uint64_t noh_cpu_clock_ns(void)
{
    return read_clock(CLOCK_PROCESS_CPUTIME_ID);
}

uint64_t noh_thread_clock_ns(void)
{
    return read_clock(CLOCK_THREAD_CPUTIME_ID);
}
