#include "depfile.h"

#include <string.h>

#include "cli/message.h"
#include "convert/base/byte_buffer.h"
#include "platform.h"

/* Make and Ninja read these escapes alike. */
static void add_name(byte_buffer *b, const char *name)
{
    for (; *name; name++) {
        if (*name == '$') buffer_append(b, "$", 1);
        if (*name == ' ' || *name == '#' || *name == ':') buffer_append(b, "\\", 1);
        buffer_append(b, name, 1);
    }
}

int depfile_write(const char *path, const char *output, const input_list *inputs)
{
    byte_buffer b = { NULL, 0, 0, 0 };
    noh_error error = { NOH_OK, "", 0, 0 };
    int status = 0;
    add_name(&b, output);
    buffer_append(&b, ":", 1);
    for (uint32_t i = 0; i < inputs->count; i++) {
        if (!inputs->entries[i].is_there) continue;
        buffer_append(&b, " \\\n  ", 5);
        add_name(&b, inputs->entries[i].path);
    }
    for (uint32_t i = 0; i < inputs->count; i++) {
        if (!inputs->entries[i].is_there) continue;
        buffer_append(&b, "\n", 1);
        add_name(&b, inputs->entries[i].path);
        buffer_append(&b, ":", 1);
    }
    buffer_append(&b, "\n", 1);
    if (b.failed || inputs->failed) {
        status = tool_fail(path, "out of memory");
    } else if (noh_file_write(path, b.bytes, b.count, &error)) {
        status = tool_fail(path, "cannot write: %s", error.what);
    }
    buffer_free(&b);
    return status;
}
