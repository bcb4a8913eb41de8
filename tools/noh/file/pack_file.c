#include "pack_file.h"

#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"
#include "noh/pack.h"

int pack_file_open(pack_file *file, const char *path)
{
    return pack_file_open_as(file, path, path);
}

static int is_wire(const noh_file *file)
{
    return file->bytes >= 4 && memcmp(file->data, "NOHZ", 4) == 0;
}

/* The whole pack of a wire form, in memory of its own: what was only needed to make it is given back. */
static int unpack(pack_file *file, const char *subject)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    void *memory = malloc(noh_wire_size()), *smaller;
    noh_wire_info info;
    noh_wire_desc desc;
    noh_wire *wire;
    noh_result result = noh_wire_info_read(file->file.data, file->file.bytes, &info, &error);
    desc.block_bytes = result ? 0 : info.block_bytes;
    desc.block = malloc(desc.block_bytes + 1u);
    if (!result && (!memory || !desc.block)) {
        free(memory);
        free(desc.block);
        return tool_fail(subject, "out of memory");
    }
    if (!result) result = noh_wire_init(memory, noh_wire_size(), &desc, &wire, &error);
    if (!result) result = noh_wire_push(wire, file->file.data, file->file.bytes, &error);
    if (!result && !noh_wire_is_complete(wire)) {
        result = noh_fail(&error, NOH_ERR_DATA, "the wire form was cut short", file->file.bytes, info.file_bytes);
    }
    free(memory);
    smaller = result ? NULL : realloc(desc.block, info.pack_bytes);
    file->unpacked = smaller ? smaller : desc.block;
    if (!result) result = noh_pack_open(file->unpacked, info.pack_bytes, &file->pack, &error);
    if (result) {
        free(file->unpacked);
        file->unpacked = NULL;
        return tool_fail_error(subject, &error);
    }
    return 0;
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
    if (is_wire(&file->file)) {
        const int status = unpack(file, subject);
        noh_file_unmap(&file->file);
        memset(&file->file, 0, sizeof file->file);
        return status;
    }
    if (noh_pack_open(file->file.data, file->file.bytes, &file->pack, &error)) {
        pack_file_close(file);
        return tool_fail_error(subject, &error);
    }
    return 0;
}

void pack_file_close(pack_file *file)
{
    free(file->unpacked);
    file->unpacked = NULL;
    if (file->file.data) noh_file_unmap(&file->file);
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
    memset(&desc, 0, sizeof desc);
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
