/* file_write.c: writing whole files.
 *
 * Replacing a file by rename is atomic, but it replaces the directory entry: a symbolic link would become a file, and a
 * device node would be lost. So links are resolved first, and a file that is not regular is written in place. */
#define _POSIX_C_SOURCE 200809L

#include "platform.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define PATH_BYTES 4096
#define LINKS_MAX 40 /* as many as Linux follows */
#define ATTEMPTS 100 /* different names for the temporary file */

/* Returns 0 or the errno of a failure, as all functions below. */
static int write_all(int descriptor, const void *data, size_t bytes)
{
    const char *p = data;
    while (bytes) {
        ssize_t written = write(descriptor, p, bytes);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        p += written;
        bytes -= (size_t)written;
    }
    return 0;
}

static char *name_in(char *path)
{
    char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Replace the last component of `path`, a link, by the link's target. */
static int follow(char path[PATH_BYTES], const char *link, size_t length)
{
    char *at = link[0] == '/' ? path : name_in(path);
    if ((size_t)(at - path) + length >= PATH_BYTES) return ENAMETOOLONG;
    memcpy(at, link, length);
    at[length] = 0;
    return 0;
}

/* Resolve the symbolic links of a path; the resulting file need not exist. */
static int resolve(char path[PATH_BYTES])
{
    char link[PATH_BYTES];
    for (int i = 0; i < LINKS_MAX; i++) {
        ssize_t length = readlink(path, link, sizeof link);
        if (length < 0) return errno == EINVAL || errno == ENOENT ? 0 : errno;
        if (length == 0 || (size_t)length >= sizeof link) return ENAMETOOLONG;
        int code = follow(path, link, (size_t)length);
        if (code) return code;
    }
    return ELOOP;
}

/* The descriptor if the path is this process's standard output or error, else -1. */
static int own_stream(const struct stat *file)
{
    for (int descriptor = STDOUT_FILENO; descriptor <= STDERR_FILENO; descriptor++) {
        struct stat own;
        if (fstat(descriptor, &own) == 0 && own.st_dev == file->st_dev && own.st_ino == file->st_ino) return descriptor;
    }
    return -1;
}

static int write_in_place(const char *path, const void *data, size_t bytes)
{
    int descriptor = open(path, O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (descriptor < 0) return errno;
    int code = write_all(descriptor, data, bytes);
    if (close(descriptor) != 0 && code == 0) code = errno;
    return code;
}

/* Create a temporary file in the folder. Its name does not contain the final name, which may already have the maximum
 * length. */
static int open_temporary(int folder, char name[64], int *descriptor)
{
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        snprintf(name, 64, ".noh-%ld-%d.tmp", (long)getpid(), attempt);
        *descriptor = openat(folder, name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (*descriptor >= 0) return 0;
        if (errno != EEXIST) break;
    }
    return errno;
}

/* mode: permissions of the replaced file; 0: there is none. */
static int replace_in(int folder, const char *name, mode_t mode, const void *data, size_t bytes)
{
    char temporary[64];
    int descriptor;
    int code = open_temporary(folder, temporary, &descriptor);
    if (code) return code;
    code = write_all(descriptor, data, bytes);
    if (code == 0 && mode && fchmod(descriptor, mode) != 0) code = errno;
    /* First the bytes are on the disk, then the name: after a power cut it has the old file or the whole new one. */
    if (code == 0 && fsync(descriptor) != 0 && errno != EINVAL) code = errno;
    if (close(descriptor) != 0 && code == 0) code = errno;
    if (code == 0 && renameat(folder, temporary, folder, name) != 0) code = errno;
    if (code) unlinkat(folder, temporary, 0);
    return code;
}

static int replace_file(char path[PATH_BYTES], mode_t mode, const void *data, size_t bytes)
{
    char *name = name_in(path);
    char folder_path[PATH_BYTES] = ".";
    if (!*name) return EISDIR;
    if (name > path) {
        size_t length = (size_t)(name - path);
        memcpy(folder_path, path, length);
        folder_path[length] = 0;
    }
    int folder = open(folder_path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return errno;
    int code = replace_in(folder, name, mode, data, bytes);
    close(folder);
    return code;
}

static int write_file(const char *path, const void *data, size_t bytes)
{
    char resolved[PATH_BYTES];
    struct stat file;
    mode_t mode = 0;
    if (!*path) return ENOENT;
    if (strlen(path) >= sizeof resolved) return ENAMETOOLONG;
    if (stat(path, &file) == 0) {
        int own = own_stream(&file);
        if (S_ISDIR(file.st_mode)) return EISDIR;
        if (own >= 0) return write_all(own, data, bytes);
        if (!S_ISREG(file.st_mode)) return write_in_place(path, data, bytes);
        mode = file.st_mode & 0777;
    }
    strcpy(resolved, path);
    int code = resolve(resolved);
    return code ? code : replace_file(resolved, mode, data, bytes);
}

static const char *reason(const char *path, int code)
{
    if (code == ENOENT && *path) return "its folder does not exist: make the folder first";
    if (code == EISDIR) return "it is a folder: give the name of a file";
    return strerror(code);
}

noh_result noh_file_write(const char *path, const void *data, size_t bytes, noh_error *error)
{
    int code = write_file(path, data, bytes);
    return code ? noh_fail(error, NOH_ERR_DATA, reason(path, code), (uint64_t)code, 0) : NOH_OK;
}
