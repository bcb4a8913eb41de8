#include "input_file.h"

#include <stdlib.h>
#include <string.h>

#include "platform.h"

char *input_read(const char *path, size_t *bytes, model_error *error)
{
    noh_file file;
    noh_error reason;
    if (noh_file_map(path, &file, &reason) != NOH_OK) {
        model_fail(error, "", "the file cannot be read: %s", reason.what);
        return NULL;
    }
    char *copy = malloc(file.bytes + 1);
    if (copy) {
        if (file.bytes) memcpy(copy, file.data, file.bytes);
        copy[file.bytes] = '\0';
        *bytes = file.bytes;
    } else {
        model_fail(error, "", "there is not enough memory to read this file");
    }
    noh_file_unmap(&file);
    return copy;
}

char *input_stem(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    char *stem = model_string(name);
    if (stem && dot && dot != name) stem[dot - name] = '\0';
    return stem;
}
