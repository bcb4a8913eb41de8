#include "ground_file.h"

#include <string.h>

#include "cli/message.h"
#include "convert/base/file_kind.h"

static int open_pack(ground_file *file, const char *path)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    const int status = pack_file_open(&file->pack, path);
    if (status) {
        file->pack.path = NULL;
        return status;
    }
    return noh_terrain_of(&file->pack.pack, &file->field, &error) ? tool_fail_error(path, &error) : 0;
}

int ground_file_open(ground_file *file, const char *path)
{
    const terrain_options options = { 0.0, 0.0, 0 };
    model_error error = { "", "" };
    memset(file, 0, sizeof *file);
    if (file_has_ending(path, ".noh") || file_has_ending(path, ".nohz")) return open_pack(file, path);
    if (terrain_read(path, &options, &file->land, &error)) {
        return tool_fail(path, *error.where ? "%s (%s)" : "%s", error.what, error.where);
    }
    file->field = terrain_field(&file->land);
    return 0;
}

void ground_file_close(ground_file *file)
{
    if (file->pack.path) pack_file_close(&file->pack);
    terrain_free(&file->land);
    memset(file, 0, sizeof *file);
}
