#include "pack_file.h"

#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

int pack_file_open(pack_file *file, const char *path)
{
    return pack_file_open_as(file, path, path);
}

int pack_file_open_as(pack_file *file, const char *path, const char *subject)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    memset(file, 0, sizeof *file);
    file->path = path;
    if (noh_file_map(path, &file->file, &error)) {
        return tool_fail(subject, "%s", error.what);
    }
    if (file->file.bytes == 0) {
        return tool_fail(subject, "the file is empty");
    }
    if (noh_pack_open(file->file.data, file->file.bytes, &file->pack, &error)) {
        pack_file_close(file);
        return tool_fail_error(subject, &error);
    }
    return 0;
}

void pack_file_close(pack_file *file)
{
    noh_file_unmap(&file->file);
}

int tool_clip_info(const pack_file *file, uint32_t index, noh_pack_clip *clip, noh_clip_info *info)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_skeleton skeleton;
    noh_clip_desc desc;
    size_t bytes;
    memset(&skeleton, 0, sizeof skeleton);
    noh_pack_clip_at(&file->pack, index, clip, NULL);
    (void)noh_pack_skeleton_at(&file->pack, clip->header->skeleton, &skeleton, NULL, NULL);
    desc.bytes = clip->bytes;
    desc.byte_count = clip->header->clip_bytes;
    desc.bind = skeleton.bind_pose;
    desc.joint_count = clip->header->joint_count;
    return noh_clip_measure(&desc, info, &bytes, &error)
               ? tool_fail(file->path, "clip '%s': %s", clip->name, error.what)
               : 0;
}

double tool_clip_seconds(const noh_clip_info *info)
{
    return (double)info->duration_ticks / (double)NOH_TICKS_PER_SECOND;
}
