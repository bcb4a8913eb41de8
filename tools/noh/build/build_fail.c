#include <stdio.h>

#include "build/build_options.h"
#include "cli/message.h"

int build_fail(const convert_failure *f)
{
    char place[512];
    if (f->line) {
        (void)snprintf(place, sizeof place, "%s:%u", f->file, f->line);
        return tool_fail(place, "%s", f->error.what);
    }
    return f->error.where[0] ? tool_fail(f->file, "%s (%s)", f->error.what, f->error.where)
                             : tool_fail(f->file, "%s", f->error.what);
}
