/* stage_frame.c: a frame: look, share, pose, hand over. */
#include <string.h>

#include "stage/cast/stage_internal.h"
#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"
#include "noh/base.h"
#include "noh/noh.h"

NOH_STATIC_ASSERT((uint64_t)NOH_VIEW_NUMBER_MAX == (uint64_t)NOH_SOUND_MAX, views_are_sound);

/* *where: the view */
static const char *bad_views(const noh_stage *s, const noh_stage_view *views, uint32_t count, uint64_t *where)
{
    if (s->phase != NOH_STAGE_IDLE) return "cannot begin a frame during a step or a frame";
    if (count > NOH_STAGE_VIEWS_MAX) return "view_count is above NOH_STAGE_VIEWS_MAX";
    for (uint32_t v = 0; v < count; v++) {
        const noh_stage_view *view = &views[v];
        *where = v;
        if (!noh_are_sound(view->view_projection, 16)) return "view_projection of a view: not finite, or too large";
        if (!noh_are_sound(view->eye, 3) || !noh_are_sound(view->light, 3) || !noh_are_sound(view->column_rest, 4) ||
            !noh_are_sound(view->eye_rest, 3))
            return "eye, light or a rest of a view: not finite, or too large";
    }
    return NULL;
}

uint32_t noh_stage_behind(const noh_stage *s, float alpha)
{
    return (uint32_t)((1.0 - (double)alpha) * (double)s->head->step_ticks + 0.5);
}

/* Use the first camera's origin, or without a camera the first light's. */
static void choose_origin(noh_stage *s, const noh_stage_view *views, uint32_t count)
{
    uint32_t v = 0;
    while (v < count && !views[v].height_px) v++;
    if (count) {
        noh_view_origin(&views[v < count ? v : 0u], s->origin);
    } else {
        memset(s->origin, 0, sizeof s->origin);
    }
}

void noh_stage_origin(const noh_stage *stage, float origin[3])
{
    NOH_ASSERT(stage && origin);
    memcpy(origin, stage->origin, sizeof stage->origin);
}

noh_result noh_stage_frame_begin(noh_stage *stage, const noh_stage_view *views, uint32_t view_count, noh_error *error)
{
    return noh_stage_frame_between(stage, views, view_count, 1.0f, error);
}

/* Who carries something is posed where that is seen, seen itself or not. */
static void mark_carriers(noh_stage *s)
{
    for (uint32_t i = 0; i < s->actor_count; i++) s->shown[i].updates = 0;
    for (uint32_t i = 0; i < s->actor_count; i++) {
        const noh_stage_actor *a = &s->actors[i];
        if (!a->alive || a->look.hidden) continue;
        while ((a = noh_stage_parent_of(s, a, NULL)) != NULL) s->shown[a - s->actors].updates = NOH_STAGE_CARRIES;
    }
}

noh_result noh_stage_frame_between(noh_stage *stage, const noh_stage_view *views, uint32_t view_count, float alpha,
                                   noh_error *error)
{
    uint64_t where = 0;
    const char *what = bad_views(stage, views, view_count, &where);
    NOH_ASSERT(stage && (views || !view_count));
    if (!what && !(alpha >= 0.0f && alpha <= 1.0f)) what = "alpha is outside of 0..1";
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, where, 0);
    }
    stage->cut = 0;
    choose_origin(stage, views, view_count);
    for (uint32_t v = 0; v < view_count; v++) {
        noh_view_less(&views[v], stage->origin, &stage->views[v]);
        noh_view_planes_of(&stage->views[v], &stage->planes[v]);
        stage->cut |= views[v].cut != 0;
    }
    stage->view_count = view_count;
    stage->head->behind_ticks = noh_stage_behind(stage, alpha);
    stage->frame++;
    if (!stage->frame) stage->frame = 1;
    mark_carriers(stage);
    stage->phase = NOH_STAGE_BEGUN;
    return NOH_OK;
}

/* Items per job, rounded up. */
static uint32_t cut_of(const noh_stage *s, uint32_t count)
{
    return (count + s->desc.job_count - 1u) / s->desc.job_count;
}

static uint32_t jobs_for(const noh_stage *s, uint32_t count)
{
    const uint32_t each = cut_of(s, count);
    return each ? (count + each - 1u) / each : 0;
}

static void count_poses(noh_stage *s)
{
    noh_stage_stats *stats = &s->stats;
    stats->updated = 0;
    stats->decoded_late = 0;
    stats->error_pixels = 0.0f;
    for (uint32_t j = 0; j < jobs_for(s, s->todo_count); j++) {
        stats->updated += s->jobs[j].updated;
        stats->decoded_late += s->jobs[j].decoded_late;
        if (s->jobs[j].error_pixels > stats->error_pixels) stats->error_pixels = s->jobs[j].error_pixels;
    }
}

uint32_t noh_stage_jobs(noh_stage *stage)
{
    NOH_ASSERT(stage);
    switch (stage->phase) {
    case NOH_STAGE_BEGUN: stage->phase = NOH_STAGE_LOOKING; return jobs_for(stage, stage->actor_count);
    case NOH_STAGE_LOOKING:
        noh_stage_share(stage);
        stage->phase = NOH_STAGE_POSING;
        if (stage->todo_count) return jobs_for(stage, stage->todo_count);
        stage->phase = NOH_STAGE_POSED;
        count_poses(stage);
        return 0;
    case NOH_STAGE_POSING:
        count_poses(stage);
        stage->phase = NOH_STAGE_POSED;
        return 0;
    default: return 0;
    }
}

void noh_stage_job(noh_stage *stage, uint32_t job)
{
    NOH_ASSERT(stage && (stage->phase == NOH_STAGE_LOOKING || stage->phase == NOH_STAGE_POSING));
    const uint32_t count = stage->phase == NOH_STAGE_LOOKING ? stage->actor_count : stage->todo_count;
    const uint32_t each = cut_of(stage, count), first = job * each;
    const uint32_t end = first + each < count ? first + each : count;
    NOH_ASSERT(job < jobs_for(stage, count));
    if (stage->phase == NOH_STAGE_LOOKING) {
        noh_stage_look_at(stage, job, first, end);
    } else {
        noh_stage_pose_todo(stage, job, first, end);
    }
}

static void run_jobs(noh_stage *s)
{
    uint32_t count;
    while ((count = noh_stage_jobs(s)) > 0) {
        for (uint32_t i = 0; i < count; i++) noh_stage_job(s, i);
    }
}

/* Set the matrices of attached actors. Their parents have just been posed. */
static void place_attached(noh_stage *s)
{
    for (uint32_t i = 0; i < s->actor_count; i++) {
        const noh_stage_kind *k = noh_stage_kind_of(s, i);
        float error_pixels;
        if (!s->actors[i].parent || s->shown[i].frame != s->frame) continue;
        noh_stage_world(s, i, s->shown[i].world);
        noh_stage_measure_shown(s, k, i - k->first_actor, s->jobs[0].matrices);
        error_pixels = noh_stage_error_pixels(s, k, i - k->first_actor);
        if (error_pixels > s->stats.error_pixels) s->stats.error_pixels = error_pixels;
    }
}

noh_result noh_stage_frame_end(noh_stage *stage, noh_error *error)
{
    NOH_ASSERT(stage);
    if (stage->phase < NOH_STAGE_BEGUN) {
        return noh_fail(error, NOH_ERR_ARG, "no frame has begun", 0, 0);
    }
    run_jobs(stage);
    place_attached(stage);
    if (stage->gpu) {
        stage->desc.gpu->upload(stage);
    }
    noh_stage_load_piece(stage);
    stage->phase = NOH_STAGE_IDLE;
    return NOH_OK;
}

noh_result noh_stage_frame(noh_stage *stage, uint32_t ticks, const noh_stage_view *view, noh_stage_event_fn on_key,
                           void *user, noh_error *error)
{
    noh_result result = noh_stage_step(stage, ticks, on_key, user, error);
    if (result == NOH_OK) result = noh_stage_frame_begin(stage, view, view ? 1u : 0u, error);
    if (result == NOH_OK) result = noh_stage_frame_end(stage, error);
    return result;
}
