/* stage_face.c: an actor's face in a job: time, where it looks, joints and targets.
 *
 * The space of a neck has its origin in the joint that turns the head, and at rest the axes of the model, turned so
 * that the face looks along +z. It goes along with what clips do to that joint. What the face turns is added to that:
 * part of it in the neck, so that it bends, and the rest in the head, whose eyes are then aimed from where the neck has
 * taken them. */
#include "life/face/face_internal.h"
#include "life/face/recipe_internal.h"
#include "noh/base.h"
#include "noh/face.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/modules.h"
#include "noh/noh.h"

#include <string.h>

#include "core/base/math_internal.h"
#include "core/base/trig_internal.h"
#include "motion/anim/clock_internal.h"
#include "stage/character/character_internal.h"
#include "stage/modules/stage_face_internal.h"
#include "stage/character/time_lod_internal.h"

#define SKIP_TICKS 96000 /* longer than 2 s unseen: skipped, not lived through */
#define NECK_SHARE 0.4f
/* Of live shapes */
#define OPEN_S 0.12f
#define MEAN_S 1.5f
#define STRESS 2.5f
#define PAUSE_S 0.18f

#define LIDS_SHUT 0.6f   /* by a clip: counts as a blink */
#define LIDS_FOLLOW 0.4f /* of a blink, at the lowest look */
#define CHEST_RAD 0.012f /* of a breath */
#define CHEST_RISE 0.05f /* likewise, of the distance of the eyes */
#define REACH_MAX 1e5f   /* model units: what is further off is looked at as if it were there */
#define NEAREST_M 0.06f

/* ---- where it looks ---- */

/* A point, counted from the actor's home, in its model space. */
static void to_model(const noh_modifier_work *w, const float point[3], float out[3])
{
    float back[4];
    for (int i = 0; i < 3; i++) out[i] = point[i] - w->near_place[i];
    noh_quat_conjugate(w->place.rotation, back);
    noh_quat_rotate(back, out, out);
    for (int i = 0; i < 3; i++) out[i] /= w->place.scale;
}

/* The point to look at on another actor or on an actor attached to it, relative to `home`. */
static void eyes_of(const noh_stage_kind *k, const noh_stage_actor *on, const double home[3], float out[3])
{
    const noh_stage_face_kind *shared = noh_stage_face_kind_of(k);
    const float *rest = shared ? shared->middle : k->reach;
    for (int i = 0; i < 3; i++) out[i] = rest[i] * on->place.scale;
    noh_quat_rotate(on->place.rotation, out, out);
    for (int i = 0; i < 3; i++) out[i] += (float)((double)on->place.position[i] - home[i] + (double)on->rest[i]);
}

/* Counted from `home`. 0: it looks at nothing, but ahead. */
static int target_of(const noh_stage *s, const noh_stage_face *f, const double home[3], float point[3])
{
    noh_stage_kind *of;
    const noh_stage_actor *other;
    for (int i = 0; i < 3; i++) point[i] = (float)((double)f->point[i] - home[i]);
    if (f->looks != NOH_LOOKS_AT_ACTOR) return f->looks == NOH_LOOKS_AT_POINT;
    other = noh_stage_actor_of(s, (noh_actor){ f->target }, &of);
    if (other) {
        eyes_of(of, noh_stage_root_of(s, other), home, point);
    }
    return other != NULL;
}

/* As far as it can be looked at: not within the head, not at infinity. */
static void hold_point(const noh_face_desc *desc, float point[3])
{
    float middle[3], way[3], length;
    for (int i = 0; i < 3; i++) middle[i] = 0.5f * (desc->eyes[0][i] + desc->eyes[1][i]);
    for (int i = 0; i < 3; i++) way[i] = point[i] - middle[i];
    for (int i = 0; i < 3; i++) way[i] = way[i] > REACH_MAX ? REACH_MAX : way[i] < -REACH_MAX ? -REACH_MAX : way[i];
    length = noh_sqrt(noh_dot3(way, way));
    if (!(length > 1e-6f)) way[0] = way[1] = 0.0f, way[2] = length = NEAREST_M;
    for (int i = 0; i < 3; i++) point[i] = middle[i] + way[i] * (length < NEAREST_M ? NEAREST_M / length : 1.0f);
}

/* ---- joints ---- */

/* The neck's space as clips have posed it: its rotation and origin in model space. */
typedef struct neck_space {
    float rotation[4], origin[3];
} neck_space;

static int turns(const noh_modifier_work *w, const noh_stage_face_joint *j)
{
    return j->joint != NOH_NONE && j->joint < w->joint_count;
}

static void neck_space_of(const noh_stage_kind *k, const noh_modifier_work *w, neck_space *n)
{
    const noh_stage_face_joint *head = &noh_stage_face_kind_of(k)->head;
    memset(n, 0, sizeof *n);
    n->rotation[3] = 1.0f;
    memcpy(n->origin, head->at, sizeof n->origin);
    if (head->joint != NOH_NONE) {
        noh_stage_joint_at(k, w->local, head->joint, n->rotation, n->origin);
        noh_quat_mul(n->rotation, head->axes, n->rotation);
    }
}

/* Turn a joint by a rotation along axes that it knows: local * axes * turn * axes^-1. */
static void turn(noh_modifier_work *w, const noh_stage_face_joint *j, const float rotation[4])
{
    float *own = w->local[j->joint].rotation, back[4], by[4];
    noh_quat_conjugate(j->axes, back);
    noh_quat_mul(j->axes, rotation, by);
    noh_quat_mul(by, back, by);
    noh_quat_mul(own, by, own);
    noh_quat_normalize(own);
}

/* Move a joint, and what is on it, by a vector in model space. */
static void move(const noh_stage_kind *k, noh_modifier_work *w, uint32_t joint, const float by[3])
{
    const uint32_t parent = w->skeleton->parents[joint];
    float carrier[4], way[3], at[3];
    memcpy(way, by, sizeof way);
    if (parent != NOH_JOINT_ROOT) {
        noh_stage_joint_at(k, w->local, parent, carrier, at);
        noh_quat_conjugate(carrier, carrier);
        noh_quat_rotate(carrier, way, way);
    }
    for (uint32_t on = parent; on != NOH_JOINT_ROOT; on = w->skeleton->parents[on]) {
        if (w->local[on].scale[0] == 0.0f) return; /* a point, which does not show */
        for (int i = 0; i < 3; i++) way[i] /= w->local[on].scale[0];
    }
    for (int i = 0; i < 3; i++) w->local[joint].translation[i] += way[i];
}

static void breathe(const noh_stage_kind *k, noh_modifier_work *w, float breath)
{
    const noh_stage_face_kind *f = noh_stage_face_kind_of(k);
    const float rise[3] = { 0.0f, CHEST_RISE * breath * (f->desc.eyes[0][0] - f->desc.eyes[1][0]), 0.0f };
    float rotation[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
    if (!turns(w, &f->chest)) return;
    noh_sin_cos(-0.5f * CHEST_RAD * breath, &rotation[0], &rotation[3]);
    turn(w, &f->chest, rotation);
    move(k, w, f->chest.joint, rise);
}

/* A head drifts and rises on a breath, whether it has joints or not: the lowest that turns it moves a little. */
static void drift(const noh_stage_kind *k, noh_modifier_work *w, const neck_space *n, const float by[3])
{
    const noh_stage_face_kind *shared = noh_stage_face_kind_of(k);
    float way[3];
    noh_quat_rotate(n->rotation, by, way);
    move(k, w, turns(w, &shared->neck) ? shared->neck.joint : shared->head.joint, way);
}

/* The neck's share, about its own joint, and what that moves the head by, in the neck's space. */
static void turn_neck(const noh_stage_kind *k, noh_modifier_work *w, const neck_space *n, const float share[4],
                      float moved[3])
{
    const uint32_t joint = noh_stage_face_kind_of(k)->neck.joint;
    float own[4], at[3], in_model[4], back[4], way[3];
    noh_stage_joint_at(k, w->local, joint, own, at);
    noh_quat_conjugate(n->rotation, back);
    noh_quat_mul(n->rotation, share, in_model);
    noh_quat_mul(in_model, back, in_model);
    for (int i = 0; i < 3; i++) way[i] = n->origin[i] - at[i];
    noh_quat_rotate(in_model, way, moved);
    for (int i = 0; i < 3; i++) moved[i] -= way[i];
    noh_quat_rotate(back, moved, moved);
    noh_quat_conjugate(own, back);
    noh_quat_mul(back, in_model, in_model);
    noh_quat_mul(in_model, own, in_model);
    noh_quat_mul(w->local[joint].rotation, in_model, w->local[joint].rotation);
    noh_quat_normalize(w->local[joint].rotation);
}

static void turn_head(const noh_stage_kind *k, noh_modifier_work *w, const neck_space *n, const float head[4],
                      float moved[3])
{
    const noh_stage_face_kind *shared = noh_stage_face_kind_of(k);
    static const float none[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
    float share[4], rest[4];
    memset(moved, 0, 3 * sizeof *moved);
    memcpy(rest, head, sizeof rest);
    if (turns(w, &shared->neck)) {
        noh_quat_nlerp(none, head, NECK_SHARE, share);
        turn_neck(k, w, n, share, moved);
        noh_quat_conjugate(share, rest);
        noh_quat_mul(rest, head, rest);
    }
    turn(w, &shared->head, rest);
}

/* Eyes are the face's: what clips do to them is not kept. */
static void turn_eyes(const noh_stage_kind *k, noh_modifier_work *w, const noh_face_pose *pose)
{
    for (int e = 0; e < 2; e++) {
        const noh_stage_face_joint *j = &noh_stage_face_kind_of(k)->eyes[e];
        float yaw[4] = { 0.0f, 0.0f, 0.0f, 1.0f }, pitch[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
        if (!turns(w, j)) continue;
        noh_sin_cos(0.5f * pose->eyes[e][0], &yaw[1], &yaw[3]);
        noh_sin_cos(-0.5f * pose->eyes[e][1], &pitch[0], &pitch[3]);
        noh_quat_mul(yaw, pitch, yaw);
        memcpy(w->local[j->joint].rotation, k->skeleton.bind_pose[j->joint].rotation, sizeof yaw);
        turn(w, j, yaw);
    }
}

/* A head without joints turns as a whole, about the base of its skull. The pose may be ahead of what is shown. */
void noh_stage_turn_head(const noh_stage_kind *k, uint32_t index, float rotation[4], float at[3])
{
    const noh_stage_face_kind *shared = noh_stage_face_kind_of(k);
    const noh_time_lod *time = &noh_stage_character(k, index)->time;
    const int64_t ahead = time->posed ? noh_clock_since(time->to_clock, time->clock) : 0;
    float turned[3];
    noh_face_whole(&noh_stage_face_of(k, index)->face, &shared->desc, ahead > 0 ? (uint32_t)ahead : 0, rotation, at);
    noh_quat_rotate(rotation, shared->head.at, turned);
    for (int i = 0; i < 3; i++) at[i] += shared->head.at[i] - turned[i];
}

/* ---- targets ---- */

static float float_of(const noh_modifier_work *w, uint32_t at)
{
    const float value = at == NOH_NONE ? 0.0f : w->floats[at];
    return value < 0.0f ? 0.0f : value > 1.0f ? 1.0f : value;
}

/* A person's lids are shut at more or less than others'. */
static void shut_lids(const noh_stage_face_kind *k, const noh_stage_face *f, const float *channels, float *floats)
{
    for (uint32_t i = 0; i < NOH_IDENTITY_CLOSINGS; i++) {
        const float more = f->shut[i] ? (float)(f->shut[i] - 1) / NOH_STAGE_SHUT - 1.0f : 0.0f;
        if (more == 0.0f) continue;
        for (uint32_t l = 0; l < k->link_count; l++) {
            const noh_face_link *link = &k->links[l];
            if (link->channel <= NOH_CHANNEL_BLINK_RIGHT && link->target == k->lids[i])
                floats[link->target] += more * link->weight * channels[link->channel];
        }
    }
}

/* Lids have one owner: where clips shut them, a face adds only what they leave open, and its own blinks wait. */
static void share_lids(const noh_stage_face_kind *k, noh_stage_face *f, const noh_modifier_work *w, float *channels)
{
    float shut = 0.0f;
    for (uint32_t i = 0; i < NOH_IDENTITY_CLOSINGS; i++) {
        const float lid = float_of(w, k->lids[i]), both = i < 2u ? float_of(w, k->shuts[i]) : 0.0f;
        shut = lid > shut ? lid : shut;
        shut = both > shut ? both : shut;
    }
    channels[NOH_CHANNEL_BLINK_LEFT] *= 1.0f - shut;
    channels[NOH_CHANNEL_BLINK_RIGHT] *= 1.0f - shut;
    if (shut > LIDS_SHUT) noh_face_blink_seen(&f->face, shut);
}

/* Expressions that clips or the game show, over blinks, looks and speech. */
static void override_by_expressions(const noh_stage_kind *k, const noh_stage_face_kind *shared, const noh_stage_face *f,
                                    const noh_modifier_work *w, float *channels)
{
    const noh_stage_module *m = &k->modules[NOH_SLOT_FACE];
    const size_t index = (size_t)((const uint8_t *)f - m->states) / m->stride;
    for (uint32_t i = 0; i < shared->override_count; i++) {
        const noh_face_link *o = &shared->links[shared->link_count + i];
        const float value = noh_stage_keep_held(k, (uint32_t)index, o->target, w->floats[o->target]);
        const float shows = value < 1.0f ? value : 1.0f, least = o->weight == NOH_STAGE_WHOLE ? 0.5f : 0.0f;
        if (!(shows > least)) continue;
        noh_face_scale_user(o->channel, o->weight == (float)NOH_OVERRIDE_BLEND ? 1.0f - shows : 0.0f, channels);
    }
}

/* Upper lids follow eyes that look down. Where no target is for that, or targets of looks are left out because joints
 * turn the eyes, a blink in part does it. */
static void follow_with_lids(const noh_stage_face_kind *k, int joints, const noh_face_pose *pose, float *channels)
{
    const float shut = LIDS_FOLLOW * pose->lids_down;
    if (k->lids_follow || (k->looks_down && !joints)) return;
    for (uint32_t c = NOH_CHANNEL_BLINK_LEFT; c <= NOH_CHANNEL_BLINK_RIGHT; c++) {
        channels[c] += shut * (1.0f - channels[c]);
    }
}

static void move_targets(const noh_stage_kind *k, noh_stage_face *f, noh_modifier_work *w, const noh_face_pose *pose)
{
    const noh_stage_face_kind *shared = noh_stage_face_kind_of(k);
    float channels[NOH_CHANNEL_COUNT], two[NOH_VISEME_COUNT];
    const float *says = f->says ? f->visemes : NULL;
    if (says && f->face.flags & NOH_FACE_FOUR) {
        noh_face_four four;
        noh_face_four_of(pose, says, &four);
        noh_face_four_visemes(&four, two);
        says = two;
    }
    noh_face_channels(pose, says, NOH_MOUTH_NONE, channels);
    const int joints = turns(w, &shared->eyes[0]);
    if (joints) memset(channels + NOH_CHANNEL_EYES, 0, 8 * sizeof *channels);
    follow_with_lids(shared, joints, pose, channels);
    override_by_expressions(k, shared, f, w, channels);
    noh_face_share(&shared->rules, float_of(w, shared->speech), float_of(w, shared->lips_shut), channels);
    share_lids(shared, f, w, channels);
    noh_face_apply(shared->links, shared->link_count, channels, w->floats);
    shut_lids(shared, f, channels, w->floats);
}

/* What live shapes ask: a mouth that opens farther than lately stresses, a pause blinks, a long one looks aside. */
static void hear(noh_stage_face *f, uint32_t ticks, noh_face_speech *asked)
{
    const float *v = f->visemes, seconds = (float)ticks / (float)NOH_TICKS_PER_SECOND;
    const float open = v[NOH_VISEME_AA] + 0.7f * v[NOH_VISEME_OH] + 0.6f * v[NOH_VISEME_E] + 0.3f * v[NOH_VISEME_IH];
    float over;
    if (!f->says) {
        f->open = f->mean = f->quiet = f->said = 0.0f;
        return;
    }
    f->open += (open - f->open) * (seconds < OPEN_S ? seconds / OPEN_S : 1.0f);
    f->mean += (open - f->mean) * (seconds < MEAN_S ? seconds / MEAN_S : 1.0f);
    f->quiet = v[NOH_VISEME_SIL] > 0.8f ? f->quiet + seconds : 0.0f;
    if (open > 0.1f) f->said = 1.0f;
    over = STRESS * (f->open - f->mean);
    over = over < 0.0f ? 0.0f : over > 1.0f ? 1.0f : over;
    asked->brows = noh_larger(asked->brows, over);
    asked->nod = noh_larger(asked->nod, over);
    if (f->said > 0.0f && f->quiet > PAUSE_S) asked->blink = 1.0f;
    if (f->said > 0.0f && f->quiet > 2.0f * PAUSE_S && f->quiet < 6.0f * PAUSE_S) asked->away = 1.0f;
}

/* What the floats of speech clips ask, and live shapes. */
static void speak(const noh_stage_face_kind *k, noh_stage_face *f, const noh_modifier_work *w)
{
    noh_face_speech asked = { float_of(w, k->speaks[0]), float_of(w, k->speaks[1]), float_of(w, k->speaks[2]),
                              float_of(w, k->speaks[3]) };
    hear(f, w->ticks, &asked);
    (void)noh_face_speak(&f->face, &k->desc, &asked, NULL);
}

/* ---- all of it ---- */

static void live(const noh_stage_kind *k, noh_stage_face *f, int64_t clock)
{
    const noh_stage_face_kind *shared = noh_stage_face_kind_of(k);
    const int64_t ticks = clock - f->clock;
    if (ticks <= 0) return;
    f->clock = clock;
    if (ticks > SKIP_TICKS) {
        noh_face_skip(&f->face, &shared->desc, ticks);
    } else {
        noh_face_step(&f->face, &shared->desc, (uint32_t)ticks);
    }
}

static void look(const noh_stage *s, const noh_stage_kind *k, noh_stage_face *f, const noh_modifier_work *w,
                 const neck_space *n)
{
    const noh_stage_face_kind *shared = noh_stage_face_kind_of(k);
    float point[3], back[4];
    if (!target_of(s, f, w->home, point)) {
        if (f->fresh || f->looks) (void)noh_face_look_at(&f->face, &shared->desc, NULL, NULL);
        f->looks = NOH_LOOKS_AHEAD; /* the other actor may be gone */
        f->fresh = 0;
        return;
    }
    to_model(w, point, point);
    for (int i = 0; i < 3; i++) point[i] -= n->origin[i];
    noh_quat_conjugate(n->rotation, back);
    noh_quat_rotate(back, point, point);
    hold_point(&shared->desc, point);
    if (f->fresh) {
        (void)noh_face_look_at(&f->face, &shared->desc, point, NULL);
    } else {
        (void)noh_face_follow(&f->face, &shared->desc, point, NULL);
    }
    f->fresh = 0;
}

void noh_stage_run_face(noh_modifier_work *w)
{
    const noh_stage_kind *k = w->kind;
    noh_stage_face *f = w->state;
    noh_face_pose pose;
    neck_space n;
    float moved[3], turned[3] = { 0.0f, 0.0f, 0.0f };
    live(k, f, w->clock);
    breathe(k, w, noh_face_breath(&f->face));
    neck_space_of(k, w, &n);
    look(w->stage, k, f, w, &n);
    speak(noh_stage_face_kind_of(k), f, w);
    noh_face_pose_of(&f->face, &noh_stage_face_kind_of(k)->desc, &pose);
    if (noh_stage_turns(k) || turns(w, &noh_stage_face_kind_of(k)->head)) {
        noh_face aimed = f->face;
        noh_face_drift(&f->face, &noh_stage_face_kind_of(k)->desc, moved);
        if (!noh_stage_turns(k)) {
            turn_head(k, w, &n, pose.head, turned);
            drift(k, w, &n, moved);
        }
        for (int i = 0; i < 3; i++) aimed.target[i] -= moved[i] + turned[i];
        noh_face_pose_of(&aimed, &noh_stage_face_kind_of(k)->desc, &pose);
    }
    turn_eyes(k, w, &pose);
    move_targets(k, f, w, &pose);
}
