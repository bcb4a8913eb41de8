/* figure_names.c: clips and floats of a figure by name; messages for unknown names. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "stage/modules/springs_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "convert/base/nearest.h"
#include "figure.h"

#define SWING_S 2.0 /* springs have settled by then */

/* "no clip 'simle' (did you mean 'smile'?)", or how many there are when nothing is near. */
int figure_fail_unknown(const char *subject, const char *kind, const char *name, const char *const *names, size_t count)
{
    const char *near = nearest_name(name, names, count);
    if (near) {
        return tool_fail(subject, "no %s named '%s' (did you mean '%s'?)", kind, name, near);
    }
    return tool_fail(subject, "no %s named '%s' (the pack has %zu; `noh info` lists them)", kind, name, count);
}

/* ---- clips ---- */

int figure_open_clips(pack_file *opened, const char *path, const pack_file *file, const pack_file **clips)
{
    int status;
    *clips = file;
    if (!path) {
        return 0;
    }
    status = pack_file_open_draft(opened, path);
    if (status) {
        return status;
    }
    *clips = opened;
    return opened->pack.runs[NOH_CHUNK_CLIP].count ? 0 : tool_fail(path, "the pack has no clips for %s", file->path);
}

void figure_close_clips(pack_file *opened, const pack_file *clips)
{
    if (clips == opened) pack_file_close(opened);
}

int figure_open_anims(figure_anims *a, const option_list *paths, const pack_file *file, figure_desc *desc)
{
    a->count = 0;
    desc->clips = file;
    if (paths->count > (int)FIGURE_ANIM_MAX) {
        return tool_usage("--anim may be given at most %u times", FIGURE_ANIM_MAX);
    }
    for (int i = 0; i < paths->count; i++) {
        const int status = pack_file_open_draft(&a->files[a->count], paths->items[i]);
        if (status) return status;
        if (!a->files[a->count++].pack.runs[NOH_CHUNK_CLIP].count) {
            return tool_fail(paths->items[i], "the pack has no clips for %s", file->path);
        }
    }
    if (a->count) desc->clips = &a->files[0];
    desc->more_clips = a->files + 1;
    desc->more_clip_count = a->count ? a->count - 1u : 0;
    return 0;
}

void figure_close_anims(figure_anims *a)
{
    while (a->count) pack_file_close(&a->files[--a->count]);
}

int figure_rests(const figure_desc *desc, const option_list *clips)
{
    for (uint32_t n = 0; n <= desc->more_clip_count; n++) {
        const pack_file *file = n ? &desc->more_clips[n - 1u] : desc->clips;
        noh_pack_clip clip;
        for (uint32_t i = 0; file && noh_pack_clip_at(&file->pack, i, &clip, NULL) == NOH_OK; i++) {
            int plays = !clips;
            for (int k = 0; clips && k < clips->count; k++) plays |= strcmp(clips->items[k], clip.name) == 0;
            if (plays && clip.header->joint_count) return 0;
        }
    }
    return 1;
}

/* The n-th pack that clips are taken from; NULL past the last. */
static const pack_file *clips_of(const figure *f, uint32_t n)
{
    const pack_file *first = f->desc.clips ? f->desc.clips : f->desc.file;
    return !n ? first : n <= f->desc.more_clip_count ? &f->desc.more_clips[n - 1u] : NULL;
}

/* The layer of a clip: a face's plays over a body's. */
static uint32_t layer_of(const figure *f, uint32_t kind, const char *name)
{
    uint32_t layer = 0;
    if (!f->desc.face_layer || !f->plan.kinds[kind].joint_count) return 0;
    for (uint32_t n = 0; clips_of(f, n); n++) {
        noh_pack_clip clip;
        for (uint32_t i = 0; noh_pack_clip_at(&clips_of(f, n)->pack, i, &clip, NULL) == NOH_OK; i++) {
            if (strcmp(clip.name, name) == 0) layer = clip.header->joint_count == 0;
        }
    }
    return layer;
}

static int fail_clip(const figure *f, const char *name)
{
    const pack_file *from = clips_of(f, 0);
    uint32_t count = 0, total = 0;
    const char **names;
    int status = 0;
    for (uint32_t n = 0; clips_of(f, n); n++) total += clips_of(f, n)->pack.runs[NOH_CHUNK_CLIP].count;
    names = calloc(total + 1u, sizeof *names);
    for (uint32_t n = 0; names && clips_of(f, n); n++) {
        noh_pack_clip clip;
        for (uint32_t i = 0; !status && noh_pack_clip_at(&clips_of(f, n)->pack, i, &clip, NULL) == NOH_OK; i++) {
            names[count++] = clip.name;
            if (strcmp(clip.name, name) != 0) continue;
            status = tool_fail(clips_of(f, n)->path,
                               "clip '%s' does not fit the skeleton of %s: names or parents of joints differ", name,
                               f->desc.file->path);
        }
    }
    if (!status) {
        status = names ? figure_fail_unknown(from->path, "clip", name, names, count)
                       : tool_fail(from->path, "out of memory");
    }
    free(names);
    return status;
}

int figure_play(figure *f, const char *clip, const noh_play *play)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_play how = *play;
    int found = 0;
    if (!how.fade_ticks) how.fade_ticks = 1;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        if (noh_stage_find(f->stage, k, NOH_NAME_CLIP, clip) == NOH_NONE) continue;
        if (noh_actor_play(f->stage, f->actors[k], layer_of(f, k, clip), clip, &how, &error)) {
            return tool_fail_error(f->desc.clips->path, &error);
        }
        found = 1;
    }
    return found ? 0 : fail_clip(f, clip);
}

static int figure_swings(const figure *f)
{
    noh_springs_desc springs;
    if (f->hair.is_there) return 1;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        if (!f->desc.without_springs && noh_springs_of_pack(f->kinds[k].mesh, f->kinds[k].skeleton, &springs)) return 1;
    }
    return 0;
}

int figure_play_options(figure *f, const option_list *clips, double time_s)
{
    const double limit_s = 1e8; /* a track's position cannot be larger */
    const double at_s = time_s > limit_s ? limit_s : time_s < -limit_s ? -limit_s : time_s;
    const double lead_s = clips->count && figure_swings(f) && at_s > 0.0 ? fmin(at_s, SWING_S) : 0.0;
    const noh_play play = { .start_ticks = noh_ticks_from_seconds(at_s - lead_s), .flags = NOH_PLAY_BESIDE };
    int status = 0;
    for (int i = 0; i < clips->count && !status; i++) status = figure_play(f, clips->items[i], &play);
    return status || !(lead_s > 0.0) ? status : figure_live(f, lead_s, 0.0);
}

void figure_pause(figure *f)
{
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        noh_controller *c = noh_actor_controller(f->stage, f->actors[k], NULL);
        for (uint32_t t = 0; c && t < c->track_count; t++) (void)noh_controller_set_speed(c, t, 0);
    }
}

int figure_clip_seconds(const figure *f, const char *clip, double *seconds)
{
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        const uint32_t index = noh_stage_find(f->stage, k, NOH_NAME_CLIP, clip);
        const noh_clip_set *set;
        if (index != NOH_NONE && noh_actor_controller(f->stage, f->actors[k], &set)) {
            *seconds = (double)set->clips[index].duration_ticks / (double)NOH_TICKS_PER_SECOND;
            return 0;
        }
    }
    return fail_clip(f, clip);
}

/* ---- floats ---- */

static int fail_target(const pack_file *file, const char *name)
{
    size_t total = 0, count = 0;
    const char **names;
    noh_mesh mesh;
    int status;
    for (uint32_t m = 0; noh_pack_mesh_at(&file->pack, m, &mesh, NULL) == NOH_OK; m++) {
        total += mesh.header->target_count;
    }
    names = calloc(total + 1, sizeof *names);
    if (!names) {
        return tool_fail(file->path, "out of memory");
    }
    for (uint32_t m = 0; noh_pack_mesh_at(&file->pack, m, &mesh, NULL) == NOH_OK; m++) {
        for (uint32_t t = 0; t < mesh.header->target_count; t++) {
            names[count++] = noh_pack_string(&file->pack, mesh.targets[t].name);
        }
    }
    status = figure_fail_unknown(file->path, "target", name, names, count);
    free(names);
    return status;
}

int figure_check_target(const pack_file *file, const char *name)
{
    noh_mesh mesh;
    for (uint32_t m = 0; noh_pack_mesh_at(&file->pack, m, &mesh, NULL) == NOH_OK; m++) {
        if (noh_mesh_find_target(&mesh, name) < mesh.header->target_count) {
            return 0;
        }
    }
    return fail_target(file, name);
}

int figure_hold(figure *f, const char *name, double value)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    int found = 0;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        const uint32_t index = noh_stage_find(f->stage, k, NOH_NAME_FLOAT, name);
        if (index == NOH_NONE) continue;
        if (noh_actor_hold_float(f->stage, f->actors[k], index, (float)value, 1.0f, &error)) {
            return tool_fail_error(f->desc.file->path, &error);
        }
        found = 1;
    }
    return found ? 0 : fail_target(f->desc.file, name);
}

/* Each name once: holding a float holds all of its name. */
int figure_hold_all(figure *f, double value)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        const char *name;
        for (uint32_t i = 0; (name = noh_stage_name(f->stage, k, NOH_NAME_FLOAT, i)) != NULL; i++) {
            if (!name[0] || noh_stage_find(f->stage, k, NOH_NAME_FLOAT, name) != i) continue;
            if (noh_actor_hold_float(f->stage, f->actors[k], i, (float)value, 1.0f, &error)) {
                return tool_fail_error(f->desc.file->path, &error);
            }
        }
    }
    return 0;
}

static int hold_option(figure *f, const char *assignment)
{
    const char *equals = strrchr(assignment, '=');
    char name[NOH_NAME_BYTES_MAX];
    double value;
    if (!equals || equals == assignment || (size_t)(equals - assignment) >= sizeof name ||
        tool_number(equals + 1, &value)) {
        return tool_usage("--weight must be NAME=NUMBER, not '%s'", assignment);
    }
    memcpy(name, assignment, (size_t)(equals - assignment));
    name[equals - assignment] = 0;
    return figure_hold(f, name, value);
}

int figure_hold_options(figure *f, const option_list *assignments)
{
    int status = 0;
    for (int i = 0; i < assignments->count && !status; i++) {
        status = hold_option(f, assignments->items[i]);
    }
    return status;
}
