/* cmd_clip.c: the compressed clips of a pack: bytes, certified errors, decoded frames. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/clips/raw_set.h"
#include "convert/clips/rcl.h"
#include "cli/args.h"
#include "cli/json.h"
#include "cli/message.h"
#include "convert/base/nearest.h"
#include "file/pack_file.h"
#include "info/info_joints.h"
#include "cli/options.h"
#include "cli/verbs.h"

/* An open clip with a cache of its own. */
typedef struct opened {
    noh_pack_clip packed;
    noh_skeleton skeleton; /* joint_count 0: the clip has floats only */
    void *memory, *cache_memory;
    noh_clip *clip;
    noh_clip_cache *cache;
    noh_clip_info info;
    size_t cache_bytes;
} opened;

static void close_clip(opened *o)
{
    free(o->memory);
    free(o->cache_memory);
    memset(o, 0, sizeof *o);
}

static int open_cache(opened *o, const char *path, noh_error *error)
{
    const noh_clip *clips[1];
    noh_clip_cache_desc desc = { clips, 1, 0 };
    clips[0] = o->clip;
    o->cache_bytes = noh_clip_cache_size(&desc, error);
    o->cache_memory = o->cache_bytes ? malloc(o->cache_bytes) : NULL;
    if (!o->cache_memory) {
        return tool_fail(path, "%s", o->cache_bytes ? "out of memory" : error->what);
    }
    return noh_clip_cache_init(o->cache_memory, o->cache_bytes, &desc, &o->cache, error) ? tool_fail_error(path, error)
                                                                                         : 0;
}

static int open_clip(opened *o, const pack_file *file, uint32_t index)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_clip_desc desc;
    size_t bytes;
    memset(o, 0, sizeof *o);
    noh_pack_clip_at(&file->pack, index, &o->packed, NULL);
    (void)noh_pack_skeleton_at(&file->pack, o->packed.header->skeleton, &o->skeleton, NULL, NULL);
    memset(&desc, 0, sizeof desc);
    desc.bytes = o->packed.bytes;
    desc.byte_count = o->packed.header->clip_bytes;
    desc.bind = o->skeleton.bind_pose;
    desc.joint_count = o->skeleton.joint_count;
    bytes = noh_clip_size(&desc, &error);
    o->memory = bytes ? malloc(bytes) : NULL;
    if (!o->memory) {
        return bytes ? tool_fail(file->path, "out of memory") : tool_fail_error(file->path, &error);
    }
    if (noh_clip_init(o->memory, bytes, &desc, &o->clip, &error)) {
        close_clip(o);
        return tool_fail_error(file->path, &error);
    }
    noh_clip_info_of(o->clip, &o->info);
    return open_cache(o, file->path, &error);
}

static void print_clip(const pack_file *file, const opened *o)
{
    printf("clip '%s': %u joints, %u floats, %.3f s at %.4g Hz, %u of %u bytes (%.1f:1)\n", o->packed.name,
           o->info.joint_count, o->info.float_count, tool_clip_seconds(&o->info), o->info.sample_rate_uhz / 1e6,
           o->packed.header->clip_bytes, o->packed.header->raw_bytes,
           (double)o->packed.header->raw_bytes / (double)o->packed.header->clip_bytes);
    if (o->info.joint_count) {
        printf("  certified %s %.3g cm from each joint: largest error %.5f cm (joint %u, %.3f s), rms %.5f cm\n",
               o->info.flags & NOH_CLIP_FLAG_SPHERE ? "all round," : "on the axes,", o->info.shell_cm,
               o->info.max_error_cm, o->info.max_error_joint, o->info.max_error_time_s, o->info.rms_error_cm);
    }
    if (o->info.float_count) {
        printf("  weights certified to %.4g cm of the vertices they move\n", o->info.error_cm);
    }
    printf("  %u segment%s%s, cache of %zu bytes; %u callback key%s, %u sync marker%s\n", o->info.segment_count,
           plural(o->info.segment_count), o->info.flags & NOH_CLIP_FLAG_SPLIT ? ", split" : "", o->cache_bytes,
           o->packed.header->event_count, plural(o->packed.header->event_count), o->packed.header->marker_count,
           plural(o->packed.header->marker_count));
    info_print_keys(&file->pack, &o->packed);
}

static void json_one(json *j, const opened *o)
{
    json_open(j, NULL, '{');
    json_text(j, "name", o->packed.name);
    json_integer(j, "joints", o->info.joint_count);
    json_integer(j, "floats", o->info.float_count);
    json_number(j, "seconds", tool_clip_seconds(&o->info));
    json_number(j, "rate_hz", o->info.sample_rate_uhz / 1e6);
    json_integer(j, "raw_bytes", o->packed.header->raw_bytes);
    json_integer(j, "bytes", o->packed.header->clip_bytes);
    json_number(j, "max_error_cm", o->info.max_error_cm);
    json_number(j, "rms_error_cm", o->info.rms_error_cm);
    json_number(j, "shell_cm", o->info.shell_cm);
    json_text(j, "bound", o->info.flags & NOH_CLIP_FLAG_SPHERE ? "sphere" : "axes");
    json_bool(j, "split", (o->info.flags & NOH_CLIP_FLAG_SPLIT) != 0);
    json_integer(j, "events", o->packed.header->event_count);
    json_integer(j, "markers", o->packed.header->marker_count);
    json_integer(j, "cache_bytes", o->cache_bytes);
    json_close(j, '}');
}

/* ---- the decoded samples ---- */

static char *copy_text(const char *text)
{
    char *copy = malloc(strlen(text) + 1);
    return copy ? strcpy(copy, text) : NULL;
}

static void fill_skeleton(raw_skeleton *to, const pack_file *file, const opened *o)
{
    const noh_skeleton_header *h;
    noh_skeleton s;
    noh_pack_skeleton_at(&file->pack, o->packed.header->skeleton, &s, &h, NULL);
    to->unit_cm = (double)h->unit_cm;
    for (uint32_t j = 0; j < s.joint_count; j++) {
        raw_joint *joint = &to->joints[j];
        free(joint->name);
        joint->name = copy_text(noh_pack_joint_name(&file->pack, o->packed.header->skeleton, j));
        joint->parent = s.parents[j] == NOH_JOINT_ROOT ? MODEL_NONE : s.parents[j];
        memcpy(joint->rotation, s.bind_pose[j].rotation, sizeof joint->rotation);
        memcpy(joint->translation, s.bind_pose[j].translation, sizeof joint->translation);
        memcpy(joint->scale, s.bind_pose[j].scale, sizeof joint->scale);
    }
}

static int fill_frames(raw_clip *to, const opened *o)
{
    uint32_t joints = o->info.joint_count;
    noh_transform *pose = malloc(sizeof *pose * joints);
    if (!pose) {
        return 1;
    }
    for (uint32_t f = 0; f < to->frame_count; f++) {
        const double tick = floor(f * NOH_TICKS_PER_SECOND / to->sample_rate_hz + 0.5); /* there the frame shows */
        noh_clip_sample(o->cache, 0, (int64_t)tick, joints, pose, NULL);
        for (uint32_t j = 0; j < joints; j++) {
            size_t at = (size_t)f * joints + j;
            memcpy(to->rotations + 4 * at, pose[j].rotation, 16);
            memcpy(to->translations + 3 * at, pose[j].translation, 12);
            memcpy(to->scales + 3 * at, pose[j].scale, 12);
        }
    }
    free(pose);
    return 0;
}

static int dump_clip(const pack_file *file, const opened *o, const char *path)
{
    raw_set *set = raw_set_new(o->info.joint_count, 1);
    model_error error = { "", "" };
    int failed = !set || raw_clip_alloc(&set->clips[0], o->info.frame_count, o->info.joint_count);
    if (!failed) {
        set->clips[0].name = copy_text(o->packed.name);
        set->clips[0].sample_rate_hz = o->info.sample_rate_uhz / 1e6;
        fill_skeleton(&set->skeleton, file, o);
        failed = !set->clips[0].name || fill_frames(&set->clips[0], o);
    }
    if (failed) {
        snprintf(error.what, sizeof error.what, "out of memory");
    } else {
        failed = rcl_write(path, &set->skeleton, &set->clips[0], &error);
    }
    raw_set_free(set);
    return failed ? tool_fail(path, "%s", error.what) : 0;
}

/* ---- the verb ---- */

static int find_clip(const pack_file *file, const char *name, uint32_t *index)
{
    const char **names = calloc(file->pack.runs[NOH_CHUNK_CLIP].count + 1u, sizeof *names);
    const char *near;
    for (uint32_t i = 0; names && i < file->pack.runs[NOH_CHUNK_CLIP].count; i++) {
        noh_pack_clip packed;
        noh_pack_clip_at(&file->pack, i, &packed, NULL);
        names[i] = packed.name;
        if (strcmp(packed.name, name) == 0) {
            *index = i;
            free(names);
            return 0;
        }
    }
    near = names ? nearest_name(name, names, file->pack.runs[NOH_CHUNK_CLIP].count) : NULL;
    free(names);
    return near ? tool_fail(file->path, "no clip named '%s' (did you mean '%s'?)", name, near)
                : tool_fail(file->path, "no clip named '%s' (`noh clip` lists them)", name);
}

static int dump_named(const pack_file *file, const char *name, const char *path)
{
    opened o;
    uint32_t index = 0;
    int status;
    if (file->pack.runs[NOH_CHUNK_CLIP].count == 0 || (!name && file->pack.runs[NOH_CHUNK_CLIP].count > 1)) {
        return tool_fail(file->path, "--dump writes one clip and this pack has %u: name it with --clip",
                         file->pack.runs[NOH_CHUNK_CLIP].count);
    }
    status = name ? find_clip(file, name, &index) : 0;
    if (!status) status = open_clip(&o, file, index);
    if (!status) {
        status = o.info.joint_count
                     ? dump_clip(file, &o, path)
                     : tool_fail(file->path,
                                 "clip '%s' animates only floats, and .rcl files hold joints: choose another clip",
                                 o.packed.name);
        close_clip(&o);
    }
    return status;
}

static int list_clips(const pack_file *file)
{
    int status = 0;
    for (uint32_t i = 0; i < file->pack.runs[NOH_CHUNK_CLIP].count && !status; i++) {
        opened o;
        status = open_clip(&o, file, i);
        if (!status) {
            print_clip(file, &o);
            close_clip(&o);
        }
    }
    return status;
}

static int json_clips(const pack_file *file)
{
    json j = json_begin();
    int status = 0;
    json_open(&j, "clips", '[');
    for (uint32_t i = 0; i < file->pack.runs[NOH_CHUNK_CLIP].count && !status; i++) {
        opened o;
        status = open_clip(&o, file, i);
        if (!status) {
            json_one(&j, &o);
            close_clip(&o);
        }
    }
    json_close(&j, ']');
    if (status) {
        json_drop(&j);
    }
    return status ? status : json_end(&j);
}

typedef struct clip_args {
    const char *pack, *dump, *name;
    int as_json;
} clip_args;

/* With --dump the list is printed only as JSON, and only after the file is written. */
static int run(void *args)
{
    const clip_args *a = args;
    pack_file file;
    int status = pack_file_open(&file, a->pack);
    if (status) {
        return status;
    }
    if (a->dump) status = dump_named(&file, a->name, a->dump);
    if (!status && a->as_json) {
        status = json_clips(&file);
    } else if (!status && !a->dump) {
        status = list_clips(&file);
    }
    pack_file_close(&file);
    return status;
}

static clip_args arguments;

static const option options[] = {
    { .name = "--dump",
      .kind = OPTION_OUTPUT,
      .at = offsetof(clip_args, dump),
      .value = "OUT.rcl",
      .what = "write the decoded frames of one clip, joints only, instead of the list",
      .example = "walk.rcl" },
    { .name = "--clip",
      .kind = OPTION_TEXT,
      .at = offsetof(clip_args, name),
      .value = "NAME",
      .what = "the clip to write; optional if the pack has only one",
      .example = "walk",
      .needs = "--dump" },
    OPTION_JSON(clip_args, as_json),
};

const verb verb_clip = {
    .name = "clip",
    .files = "PACK|MODEL",
    .what = "list compressed clips with their bytes and certified errors, or write one decoded",
    .example = "body.noh\nbody.noh --dump walk.rcl --clip walk --json",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(clip_args, pack),
    .args = &arguments,
    .run = run,
};
