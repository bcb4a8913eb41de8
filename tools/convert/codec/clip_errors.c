#include "clip_errors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stage/character/joint_lod_internal.h"
#include "stage/character/time_lod_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "convert/base/quat.h"
#include "convert/clips/joint_order.h"
#include "convert/clips/source_pose.h"
#include "convert/model/model_build.h"

#define CACHED_SEGMENTS 4u /* an eighth of a second lies in two or three segments */

/* A skeleton and its one clip in the runtime's form. */
typedef struct player {
    noh_skeleton skeleton;
    uint16_t *parents;
    noh_transform *bind;
    float *joint_radius, *scalar_radius;
    void *clip_memory, *cache_memory, *work;
    size_t work_bytes;
    noh_clip *clip;
    noh_clip_cache *cache;
    noh_clip_entry entry;
    noh_clip_set set;
    noh_time_probe probe;
} player;

static void sample(void *user, uint32_t entry, uint32_t tick, uint32_t joint_count, noh_transform *pose,
                   uint32_t float_count, float *floats)
{
    player *p = user;
    noh_clip_sample(p->cache, entry, tick, joint_count, pose, float_count ? floats : NULL);
}

static int open_clip(const byte_buffer *bytes, player *p)
{
    noh_clip_desc desc = {
        .bytes = bytes->bytes, .byte_count = bytes->count, .bind = p->bind, .joint_count = p->skeleton.joint_count
    };
    const noh_clip *clips[1];
    noh_clip_cache_desc cache = { clips, 1, CACHED_SEGMENTS };
    size_t clip_size = noh_clip_size(&desc, NULL), cache_size;
    p->clip_memory = malloc(clip_size + 1u);
    if (!p->clip_memory || noh_clip_init(p->clip_memory, clip_size, &desc, &p->clip, NULL)) {
        return 1;
    }
    clips[0] = p->clip;
    cache_size = noh_clip_cache_size(&cache, NULL);
    p->cache_memory = malloc(cache_size + 1u);
    return !p->cache_memory || noh_clip_cache_init(p->cache_memory, cache_size, &cache, &p->cache, NULL) != NOH_OK;
}

static void fill_skeleton(const raw_skeleton *s, const float *joint_radius, double shell, player *p)
{
    p->skeleton.joint_count = s->joint_count;
    p->skeleton.parents = p->parents;
    p->skeleton.bind_pose = p->bind;
    for (uint32_t j = 0; j < s->joint_count; j++) {
        const raw_joint *joint = &s->joints[j];
        p->parents[j] = joint->parent == MODEL_NONE ? (uint16_t)NOH_JOINT_ROOT : (uint16_t)joint->parent;
        memcpy(p->bind[j].rotation, joint->rotation, sizeof joint->rotation);
        memcpy(p->bind[j].translation, joint->translation, sizeof joint->translation);
        memcpy(p->bind[j].scale, joint->scale, sizeof joint->scale);
        p->joint_radius[j] = joint_radius ? joint_radius[j] : (float)shell;
    }
}

static void fill_set(const raw_clip *raw, double unit_cm, player *p)
{
    noh_clip_info info;
    uint32_t count = 0;
    noh_clip_info_of(p->clip, &info);
    p->entry.duration_ticks = (uint32_t)info.duration_ticks;
    p->entry.loop = info.flags & NOH_CLIP_FLAG_LOOP ? NOH_LOOP_REPEAT : NOH_LOOP_ONCE;
    for (uint32_t g = 0; g < raw->float_count; g++) {
        for (uint32_t i = 0; i < raw->floats[g].width; i++) {
            p->scalar_radius[count++] = raw->floats[g].radius ? (float)((double)raw->floats[g].radius[i] / unit_cm)
                                                              : 0.0f;
        }
    }
    p->set.clip_count = 1;
    p->set.joint_count = p->skeleton.joint_count;
    p->set.float_count = info.float_count;
    p->set.clips = &p->entry;
    p->set.bind_pose = p->bind;
    p->set.sample = sample;
    p->set.user = p;
    p->probe.set = &p->set;
    p->probe.skeleton = &p->skeleton;
    p->probe.joint_radius_m = p->joint_radius;
    p->probe.float_radius_m = p->scalar_radius;
    p->probe.travels = 1;
}

static int open_player(const raw_skeleton *s, const raw_clip *raw, const byte_buffer *bytes, const float *joint_radius,
                       double shell, player *p)
{
    const uint32_t joints = raw->joint_count;
    const raw_skeleton none = { NULL, 0, NULL, s->unit_cm };
    uint32_t floats = 0;
    size_t rates, points, levels;
    for (uint32_t g = 0; g < raw->float_count; g++) {
        floats += raw->floats[g].width;
    }
    memset(p, 0, sizeof *p);
    p->parents = model_zeros(joints + 1u, sizeof *p->parents);
    p->bind = model_zeros(joints + 1u, sizeof *p->bind);
    p->joint_radius = model_zeros(joints + 1u, sizeof *p->joint_radius);
    p->scalar_radius = model_zeros(floats + 1u, sizeof *p->scalar_radius);
    if (!p->parents || !p->bind || !p->joint_radius || !p->scalar_radius) {
        return 1;
    }
    fill_skeleton(joints ? s : &none, joint_radius, shell, p);
    if (open_clip(bytes, p)) {
        return 1;
    }
    fill_set(raw, s->unit_cm, p);
    rates = noh_time_lod_measure_size(&p->probe);
    levels = noh_joint_lod_measure_size(&p->probe);
    points = noh_time_lod_points_size(&p->probe);
    p->work_bytes = rates > levels ? rates : levels;
    p->work_bytes = points > p->work_bytes ? points : p->work_bytes;
    p->work = malloc(p->work_bytes + 1u);
    return !p->work;
}

static void close_player(player *p)
{
    free(p->parents);
    free(p->bind);
    free(p->joint_radius);
    free(p->scalar_radius);
    free(p->clip_memory);
    free(p->cache_memory);
    free(p->work);
}

/* ---- vertices against the source ---- */

#define PARTS 8u /* of a frame */

typedef struct comparison {
    const raw_skeleton *skeleton;
    const raw_clip *raw;
    const moved_vertices *vertices;
    uint32_t *joints;
    noh_transform *shown;
    double *locals, *source, *lossy, *scratch;
} comparison;

static int open_comparison(const raw_skeleton *s, const raw_clip *raw, const moved_vertices *v, comparison *c)
{
    const size_t count = s->joint_count, channels = raw->source ? raw->source->channel_count : 0u;
    c->skeleton = s;
    c->raw = raw;
    c->vertices = v;
    c->joints = model_zeros(channels + 1u, sizeof *c->joints);
    c->shown = model_zeros(count, sizeof *c->shown);
    c->locals = model_zeros(count * SOURCE_LOCAL, sizeof *c->locals);
    c->source = model_zeros(count * 12u, sizeof *c->source);
    c->lossy = model_zeros(count * 12u, sizeof *c->lossy);
    c->scratch = model_zeros(count, sizeof *c->scratch);
    if (!c->joints || !c->shown || !c->locals || !c->source || !c->lossy || !c->scratch) return 1;
    if (raw->source) source_joints(s, raw->source, c->joints);
    return 0;
}

static void close_comparison(comparison *c)
{
    free(c->joints);
    free(c->shown);
    free(c->locals);
    free(c->source);
    free(c->lossy);
    free(c->scratch);
}

static double apart_at(comparison *c, player *p, uint64_t tick, double floor)
{
    const uint32_t count = c->skeleton->joint_count;
    source_rest(c->skeleton, c->locals);
    source_locals(c->raw, c->joints, (double)tick / NOH_TICKS_PER_SECOND, c->locals);
    source_object(c->skeleton, c->locals, c->source);
    noh_clip_sample(p->cache, 0, (int64_t)tick, count, c->shown, NULL);
    for (uint32_t j = 0; j < count; j++) {
        double *l = c->locals + SOURCE_LOCAL * (size_t)j;
        for (int i = 0; i < 4; i++) l[i] = (double)c->shown[j].rotation[i];
        for (int i = 0; i < 3; i++) {
            l[4 + i] = (double)c->shown[j].translation[i];
            l[7 + i] = (double)c->shown[j].scale[i];
        }
        (void)quat_normalize(l);
    }
    source_object(c->skeleton, c->locals, c->lossy);
    return moved_vertices_apart(c->vertices, c->source, c->lossy, floor, c->scratch);
}

/* Where frames lie between ticks, the runtime shows them at the tick nearest to them: they are compared there. */
static int measure_vertices(const raw_skeleton *s, const raw_clip *raw, const moved_vertices *v, player *p,
                            clip_errors *out)
{
    comparison c;
    const uint64_t last = p->entry.duration_ticks;
    double worst[2] = { 0.0, 0.0 };
    int failed;
    out->frame_error_cm = out->between_error_cm = -1.0;
    if (!v || !v->vertex_count || !raw->joint_count) return 0;
    failed = open_comparison(s, raw, v, &c);
    for (uint32_t part = 0; !failed && part <= PARTS * (raw->frame_count - 1u); part++) {
        const uint64_t tick = (uint64_t)(part * (double)NOH_TICKS_PER_SECOND / (PARTS * raw->sample_rate_hz) + 0.5);
        double *of = &worst[part % PARTS != 0];
        *of = apart_at(&c, p, tick < last ? tick : last, *of);
    }
    close_comparison(&c);
    out->frame_error_cm = worst[0] * s->unit_cm;
    out->between_error_cm = worst[1] * s->unit_cm;
    return failed;
}

/* Raise each error to the one before it: a lower update rate, or fewer joints, never counts as better. Returns 0 if an
 * error is not finite. */
static int settle(float *errors, uint32_t count)
{
    int fine = 1;
    for (uint32_t i = 0; i < count; i++) {
        fine = fine && isfinite(errors[i]);
        errors[i] = i && errors[i] < errors[i - 1] ? errors[i - 1] : errors[i];
    }
    return fine;
}

/* points NULL: measured by the joints' radii. */
static int measure_update_rates(player *p, const noh_time_lod_points *points, float *out)
{
    return points ? noh_time_lod_points_measure(p->work, p->work_bytes, &p->probe, points, 0, out, NULL) != NOH_OK
                  : noh_time_lod_measure(p->work, p->work_bytes, &p->probe, 0, out, NULL) != NOH_OK;
}

int clip_errors_measure(const raw_skeleton *skeleton, const raw_clip *raw, const byte_buffer *clip,
                        const error_points *at, clip_errors *out, model_error *error)
{
    const double shell = at->shell_cm / skeleton->unit_cm;
    uint32_t counts[NOH_LOD_LEVELS_MAX];
    player p;
    int failed = open_player(skeleton, raw, clip, at->joint_radius, shell, &p);
    memset(out, 0, sizeof *out);
    if (!failed && raw->joint_count) {
        out->shell = at->joint_radius ? 0.0f : (float)shell;
        out->level_count = joint_levels(skeleton, counts);
        failed = !out->level_count ||
                 noh_joint_lod_measure(p.work, p.work_bytes, &p.probe, 0, counts, out->level_count, out->joint, NULL);
    }
    failed = failed || measure_vertices(skeleton, raw, at->vertices, &p, out) ||
             measure_update_rates(&p, raw->joint_count && at->joint_radius ? at->points : NULL, out->update_rate);
    close_player(&p);
    if (failed) {
        return model_fail_memory(error);
    }
    if (!settle(out->joint, out->level_count) || !settle(out->update_rate, NOH_CLIP_UPDATE_RATES)) {
        return model_fail(error, "", "clip '%.80s': its joints move farther than a float can hold", raw->name);
    }
    return 0;
}
