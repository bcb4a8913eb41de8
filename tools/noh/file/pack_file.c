#define _POSIX_C_SOURCE 200809L /* isatty, opendir */

#include "pack_file.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "build/build_options.h"
#include "cli/message.h"
#include "convert/base/file_kind.h"
#include "convert/base/nearest.h"
#include "file/model_pack.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"
#include "noh/pack.h"

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
    file->made = smaller ? smaller : desc.block;
    if (!result) result = noh_pack_open(file->made, info.pack_bytes, &file->pack, &error);
    if (result) {
        free(file->made);
        file->made = NULL;
        return tool_fail_error(subject, &error);
    }
    return 0;
}

static int build(pack_file *file, const char *subject, int draft)
{
    const model_pack_desc desc = { .path = file->path,
                                   .draft = draft,
                                   .progress = isatty(STDERR_FILENO) ? stderr : NULL };
    noh_error error = { NOH_OK, "", 0, 0 };
    convert_failure failure;
    byte_buffer pack;
    if (model_pack_make(&desc, &pack, &failure)) {
        failure.file = subject;
        return build_fail(&failure);
    }
    file->made = pack.bytes;
    return noh_pack_open(pack.bytes, pack.count, &file->pack, &error) ? tool_fail_error(subject, &error) : 0;
}

/* The pack or model in a folder whose name is nearest; name NULL: the first. */
static int find_in_folder(const char *folder, const char *name, char found[256])
{
    const struct dirent *entry;
    DIR *open = opendir(folder);
    found[0] = '\0';
    while (open && (entry = readdir(open)) != NULL) {
        const char *both[2] = { found, entry->d_name };
        char path[1024];
        const file_kind *kind;
        (void)snprintf(path, sizeof path, "%.700s/%.256s", folder, entry->d_name);
        kind = entry->d_name[0] == '.' ? NULL : file_kind_of(path);
        if (!kind || kind->reader == READER_NONE) continue;
        if (name ? nearest_name(name, both, 2) == entry->d_name : !found[0] || strcmp(entry->d_name, found) < 0) {
            (void)snprintf(found, 256, "%s", entry->d_name);
        }
    }
    if (open) closedir(open);
    return found[0] != '\0';
}

/* The file cannot be opened: what else is in its folder, or in it where it is one. */
static int fail_missing(const char *path, const char *subject, const noh_error *error)
{
    const char *slash = strrchr(path, '/');
    const int is_folder = error->result == NOH_ERR_ARG && error->where == EISDIR;
    char folder[1024], found[256];
    (void)snprintf(folder, sizeof folder, "%.*s", is_folder || !slash ? 1000 : (int)(slash - path + 1),
                   is_folder || slash ? path : ".");
    if (!find_in_folder(folder, is_folder ? NULL : slash ? slash + 1 : path, found)) {
        return tool_fail(subject, "%s", is_folder ? "this is a folder: name a pack or a model" : error->what);
    }
    return is_folder ? tool_fail(subject, "this is a folder: name a file in it, such as %s", found)
                     : tool_fail(subject, "%s (did you mean %s?)", error->what, found);
}

static int open_file(pack_file *file, const char *path, const char *subject, int draft)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    const file_kind *kind;
    memset(file, 0, sizeof *file);
    file->path = path;
    if (noh_file_map(path, &file->file, &error)) return fail_missing(path, subject, &error);
    if (file->file.bytes == 0) {
        return tool_fail(subject, "the file is empty");
    }
    kind = file_kind_of(path);
    if (file_kind_is_built(kind) || is_wire(&file->file)) {
        const int status = is_wire(&file->file) ? unpack(file, subject) : build(file, subject, draft);
        noh_file_unmap(&file->file);
        if (status) pack_file_close(file);
        return status;
    }
    if (!kind || kind->reader == READER_NONE) {
        pack_file_close(file);
        return kind ? tool_fail(subject, "this is %s, neither a pack nor a model: %s", kind->what, kind->instead)
                    : tool_fail(subject, "this is neither a pack nor a model: noh help lists what is read");
    }
    if (noh_pack_open(file->file.data, file->file.bytes, &file->pack, &error)) {
        pack_file_close(file);
        return tool_fail_error(subject, &error);
    }
    return 0;
}

int pack_file_open(pack_file *file, const char *path)
{
    return open_file(file, path, path, 0);
}

int pack_file_open_draft(pack_file *file, const char *path)
{
    return open_file(file, path, path, 1);
}

int pack_file_open_as(pack_file *file, const char *path, const char *subject)
{
    return open_file(file, path, subject, 0);
}

void pack_file_close(pack_file *file)
{
    free(file->made);
    file->made = NULL;
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
