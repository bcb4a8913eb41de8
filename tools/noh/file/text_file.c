#include "file/text_file.h"

#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "platform.h"

int text_file_read(const char *path, int may_miss, size_t bytes_max, char **text)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_file file;
    const noh_result result = noh_file_map(path, &file, &error);
    int status = 0;
    if (may_miss && result == NOH_ERR_NOT_FOUND) return 0;
    if (result) return tool_fail(path, "cannot be read: %s", error.what);
    if (file.bytes > bytes_max) {
        status = tool_fail(path, "is longer than %zu bytes: split it", bytes_max);
    } else if (file.bytes && memchr(file.data, 0, file.bytes)) {
        status = tool_fail(path, "is not a text: it contains zero bytes");
    } else if (!(*text = malloc(file.bytes + 1u))) {
        status = tool_fail(path, "out of memory");
    } else {
        if (file.bytes) memcpy(*text, file.data, file.bytes);
        (*text)[file.bytes] = 0;
    }
    noh_file_unmap(&file);
    return status;
}
