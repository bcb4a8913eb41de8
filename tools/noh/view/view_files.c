/* view_files.c: which file is shown: another one, the same again when it has changed, a model while it is converted. */
#include <stdio.h>
#include <string.h>

#include "cli/message.h"
#include "view/view_app.h"

/* Presets, camera and first clip of a model that is shown. */
void view_begin_model(view_app *a)
{
    const int status = view_presets_read(&a->presets, a->model, a->files.presets_path);
    if (status) view_keep(a, status);
    a->over.joint = overlay_main_joint(a->model->figure);
    view_watch_begin(&a->files.watch, a->model->path);
    view_forget_frames(a);
    view_undo_forget(&a->undo);
    view_frame_all(a);
    if (a->autoplay) view_play_first(a);
}

/* The held weights of the old model, by name. */
static void carry_weights(const view_model *from, view_model *to)
{
    for (uint32_t i = 0; i < from->target_count; i++) {
        for (uint32_t t = 0; t < to->target_count && from->targets[i].held; t++) {
            if (strcmp(from->targets[i].name, to->targets[t].name) == 0)
                view_target_hold(&to->targets[t], from->targets[i].value);
        }
    }
}

/* Clips of the same name play on, from where they were, each on its layer. */
static void carry_clips(const view_model *from, view_model *to)
{
    for (uint32_t k = 0; k < from->figure->stage_desc.kind_count && k < to->figure->stage_desc.kind_count; k++) {
        const noh_controller *c = view_controller(from, k, NULL);
        for (uint32_t t = 0; t < c->track_count; t++) {
            const noh_track *track = noh_controller_track(c, t);
            view_how how = { .layer = 1u + view_layer_of(t), .weight = 1.0f, .speed = 1.0f };
            if (track->mode == NOH_TRACK_OFF || !view_clip_of(from, k, track)) continue;
            how.weight = track->weight > 0.01f ? track->weight : 0.01f;
            how.speed = (float)track->speed_now / (float)NOH_SPEED_ONE;
            how.loop = (noh_loop)track->loop;
            how.sync_group = track->sync_group;
            for (uint32_t i = 0; i < to->clip_count; i++) {
                if (strcmp(to->clips[i].name, view_clip_name(from, k, track->clip)) != 0) continue;
                if (view_start(to, i, &how, 1)) continue;
                view_seek_newest(to, k, how.layer - 1u, view_position(from, k, t));
            }
        }
    }
}

static void forget_model(view_app *a)
{
    memset(&a->log, 0, sizeof a->log);
    memset(&a->pad, 0, sizeof a->pad);
    memset(&a->pick, 0, sizeof a->pick);
    memset(&a->fall, 0, sizeof a->fall);
    memset(&a->ground.walked, 0, sizeof a->ground.walked);
    a->part[0] = 0;
    a->lod.level = 0;
    a->camera.by_hand = 0;
}

int view_app_show(view_app *a, const char *path, byte_buffer *converted)
{
    const int again = strcmp(path, a->model->path) == 0;
    const orbit seen = a->camera.orbit;
    const int by_hand = a->camera.by_hand, autoplay = a->autoplay;
    view_model_desc desc = a->desc;
    view_model *shown;
    int status;
    desc.path = path;
    desc.converted = converted;
    if (!again) desc.anim = NULL; /* another pack's clips belonged to the old model */
    desc.part = NULL;
    view_capture_forget(&a->capture);
    status = view_model_open(&a->gpu, &desc, &shown);
    view_keep(a, status);
    if (status) {
        return status;
    }
    view_export_stop(&a->film.job);
    view_compare_close(&a->compare);
    view_forget_frames(a);
    forget_model(a);
    if (again) {
        carry_weights(a->model, shown);
        carry_clips(a->model, shown);
        a->autoplay = 0;
    }
    view_model_close(a->model);
    a->model = shown;
    a->desc = a->request.desc = desc;
    a->desc.converted = a->request.desc.converted = NULL;
    a->desc.path = a->request.desc.path = shown->path;
    a->cut = 1;
    view_begin_model(a);
    a->autoplay = autoplay;
    if (again) {
        a->camera.orbit = seen;
        a->camera.by_hand = by_hand;
        a->files.reloads++;
    }
    return 0;
}

int view_app_load(view_app *a, const char *path)
{
    int status;
    if (!view_is_model(path)) {
        view_load_cancel(&a->files.load);
        return view_app_show(a, path, NULL);
    }
    status = view_load_start(&a->files.load, path, a->desc.levels);
    view_keep(a, status);
    return status;
}

void view_app_poll(view_app *a)
{
    byte_buffer converted;
    char path[1024];
    if (a->files.load.state == VIEW_LOAD_NONE && view_watch_changed(&a->files.watch, a->model->path)) {
        snprintf(path, sizeof path, "%s", a->model->path);
        (void)view_app_load(a, path);
    }
    switch (view_load_poll(&a->files.load)) {
    case VIEW_LOAD_FAILED:
        view_tell(a);
        view_load_cancel(&a->files.load);
        break;
    case VIEW_LOAD_DONE:
        snprintf(path, sizeof path, "%s", a->files.load.path);
        if (view_load_take(&a->files.load, &converted))
            view_tell(a);
        else if (view_app_show(a, path, &converted))
            buffer_free(&converted);
        break;
    default: break;
    }
}
