#define _POSIX_C_SOURCE 200809L /* stat */

#include "report_stream.h"

#include <sys/stat.h>
#include <unistd.h>

FILE *report_stream(const char *output)
{
    struct stat own, file;
    if (output && fstat(STDOUT_FILENO, &own) == 0 && stat(output, &file) == 0 && !S_ISCHR(file.st_mode) &&
        own.st_dev == file.st_dev && own.st_ino == file.st_ino) {
        return stderr;
    }
    return stdout;
}
