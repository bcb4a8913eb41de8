/* view_first.c: what plays by itself: when a model is opened, and in a film. */
#include <string.h>

#include "cli/message.h"
#include "view/view_app.h"

void view_play_first(view_app *a)
{
    const view_model *m = a->model;
    uint32_t first = m->clip_count, idle = m->clip_count;
    for (uint32_t i = m->clip_count; i-- > 0;) {
        const noh_clip_set *set;
        for (uint32_t k = 0; k < m->figure->stage_desc.kind_count; k++) {
            (void)view_controller(m, k, &set);
            if (m->clips[i].clips[k] == NOH_NONE || set->clips[m->clips[i].clips[k]].flags & NOH_CLIP_FLOATS_ONLY)
                continue;
            first = i;
            if (strncmp(m->clips[i].name, "idle", 4) == 0) idle = i;
        }
    }
    if (m->clip_count) view_play(a, idle < m->clip_count ? idle : first < m->clip_count ? first : 0, 0);
}

/* The track whose clip is the longest; its length, 0: none plays. */
static double longest_track(const view_model *m, uint32_t *kind, uint32_t *track)
{
    double longest = 0.0;
    for (uint32_t k = 0; k < m->figure->stage_desc.kind_count; k++) {
        const noh_clip_set *set;
        const noh_controller *c = view_controller(m, k, &set);
        for (uint32_t t = 0; t < c->track_count; t++) {
            const noh_track *at = noh_controller_track(c, t);
            if (at->mode == NOH_TRACK_OFF || !view_clip_of(m, k, at)) continue;
            const double seconds = (double)set->clips[at->clip].duration_ticks / (double)NOH_TICKS_PER_SECOND;
            if (seconds <= longest) continue;
            longest = seconds;
            *kind = k;
            *track = t;
        }
    }
    return longest;
}

void view_export_begin(view_app *a)
{
    uint32_t kind = 0, track = 0;
    double seconds = VIEW_EXPORT_TURN_S;
    int status = 0;
    if (!a->film.turns) {
        seconds = longest_track(a->model, &kind, &track);
        if (!(seconds > 0.0)) status = tool_fail("export", "no clip plays: play one, or export a turn");
    }
    if (!status) {
        status = view_export_start(&a->film.job, &a->model->canvas, a->film.path, (uint32_t)a->film.hz, seconds,
                                   a->film.turns);
    }
    view_keep(a, status);
    if (status || a->film.turns) return;
    view_seek(a->model, kind, track, 0.0);
    a->playing = 1;
}
