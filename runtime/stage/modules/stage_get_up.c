/* stage_get_up.c: actors that get up: the clip, the place under the ragdoll, and what is left of the ragdoll's pose.
 *
 * What is left is taken when the next pose is made, after all that changes poses, so that nothing leaps whatever plays:
 * for each body's joint the rotation between the two poses, as a vector, and its speed. It ends by a quintic whose
 * position, speed and acceleration are 0 in the end, and whose first two are what the ragdoll has to begin with. */
#include <string.h>

#include "motion/anim/clock_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/low_stage.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "core/base/assert_internal.h"
#include "core/base/name_internal.h"
#include "core/base/vector_internal.h"
#include "life/physics/world_internal.h"
#include "stage/modules/stage_ragdoll_internal.h"
#include "life/physics/ragdoll_internal.h"

#define BLEND_TICKS 19200u
#define SPEED_SECONDS 0.005f /* speeds are differences over this time */
#define PI 3.14159265f

/* ---- which clip ---- */

/* Its bodies as a pose of the clip's begins, or as what plays now has them, from where b's count. */
static noh_result bodies_of(noh_stage *s, noh_stage_kind *k, const noh_stage_actor *a, const noh_stage_body *b,
                            uint32_t clip, noh_ragdoll_pose *bodies, noh_error *error)
{
    const noh_character_desc desc = noh_stage_character_desc(k, 0);
    const noh_ragdoll_frame frame = noh_stage_ragdoll_frame(k, &a->place, b->origin);
    const noh_module_type *type = k->modules[NOH_SLOT_SOURCE].type;
    noh_character_scratch scratch;
    noh_clip_set set = k->set;
    noh_stage_sampler sampler;
    const noh_result result = noh_character_scratch_init(s->jobs[0].scratch, s->scratch_bytes, &desc, &scratch, error);
    if (result != NOH_OK) return result;
    if (clip != NOH_NONE) {
        set.sample(set.user, clip, 0, set.joint_count, scratch.local, set.float_count, scratch.floats);
    } else {
        const uint32_t index = noh_stage_index(k, a);
        if (type) type->source->sample(s, &s->jobs[0], k, index, 0, 0, &set, &sampler);
        noh_controller_pose(noh_character_controller(noh_stage_character(k, index)), &set, &scratch.pose, scratch.local,
                            scratch.floats);
    }
    noh_ragdoll_from_pose(&noh_stage_ragdoll_kind_of(k)->fit, &k->skeleton, scratch.local, &frame, bodies);
    return NOH_OK;
}

/* The clip whose first pose is most like the ragdoll, and its bodies then. */
typedef struct likeness {
    uint32_t clip; /* NOH_NONE: none was compared */
    float like;
    noh_ragdoll_pose bodies[NOH_RAGDOLL_BODIES_MAX];
} likeness;

static noh_result compare_clip(noh_stage *s, noh_stage_kind *k, const noh_stage_actor *a, const noh_stage_body *b,
                               uint32_t clip, likeness *best, noh_error *error)
{
    noh_ragdoll_pose tried[NOH_RAGDOLL_BODIES_MAX];
    memset(tried, 0, sizeof tried);
    const noh_result result = bodies_of(s, k, a, b, clip, tried, error);
    if (result != NOH_OK) return result;
    const float like = noh_ragdoll_similarity(tried, b->bodies[0]);
    if (best->clip != NOH_NONE && !(like > best->like)) return NOH_OK;
    best->clip = clip;
    best->like = like;
    memcpy(best->bodies, tried, sizeof tried);
    return NOH_OK;
}

/* Among the named clips, or those that begin with NOH_GET_UP_CLIPS. Without any the bodies are posed by the clips that
 * play. */
static noh_result choose_clip(noh_stage *s, noh_stage_kind *k, const noh_stage_actor *a, const noh_stage_body *b,
                              const noh_get_up *how, likeness *best, noh_error *error)
{
    const uint32_t kind = (uint32_t)(k - s->kinds);
    const char *name;
    noh_result result = NOH_OK;
    memset(best, 0, sizeof *best);
    best->clip = NOH_NONE;
    for (uint32_t i = 0; how->clips && i < how->clip_count && result == NOH_OK; i++) {
        const uint32_t clip = noh_stage_find(s, kind, NOH_NAME_CLIP, how->clips[i]);
        if (clip == NOH_NONE)
            return noh_fail(error, NOH_ERR_NOT_FOUND, "the kind has no clip of that name to get up by", i, 0);
        result = NOH_PAGE ? NOH_OK : noh_stage_check_there(s, k, &clip, 1, error);
        if (result == NOH_OK) result = compare_clip(s, k, a, b, clip, best, error);
    }
    for (uint32_t i = 0; !how->clips && result == NOH_OK; i++) {
        name = noh_stage_name(s, kind, NOH_NAME_CLIP, i);
        if (!name) break;
        if (!noh_name_begins(name, NOH_GET_UP_CLIPS)) continue;
        if (NOH_PAGE || noh_stage_check_there(s, k, &i, 1, NULL) == NOH_OK)
            result = compare_clip(s, k, a, b, i, best, error);
    }
    return result == NOH_OK && best->clip == NOH_NONE ? bodies_of(s, k, a, b, NOH_NONE, best->bodies, error) : result;
}

/* ---- where it stands ---- */

/* Under its ragdoll, headed as that lies: on the ground, or where its first bodies meet. */
static void stand_under(const noh_stage_kind *k, noh_stage_actor *a, const noh_stage_body *b,
                        const noh_ragdoll_pose *bodies)
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    noh_ragdoll_frame frame = noh_stage_ragdoll_frame(k, &a->place, b->origin);
    const noh_ragdoll_pose *first = &b->bodies[0][0];
    const noh_world *world = shared->world;
    float ground;
    noh_ragdoll_place_under(bodies, b->bodies[0], shared->rig.body_count, &frame);
    if (!world ||
        !noh_world_ground_below(world, b->origin, first->position,
                                first->position[1] + a->place.scale * shared->rig.bodies[0].radius, &ground)) {
        ground = frame.position[1] + first->position[1] - bodies[0].position[1];
    }
    frame.position[1] = ground;
    for (int i = 0; i < 3; i++) {
        a->place.position[i] = (float)(((double)b->origin[i] + (double)frame.position[i]) / (double)shared->metres);
    }
    if (!NOH_PAGE) noh_stage_keep_within(&a->place, a->rest);
    memcpy(a->place.rotation, frame.rotation, sizeof frame.rotation);
    a->before = a->place;
    a->on_its_way = 0;
}

/* ---- what is left of the ragdoll's pose ---- */

/* The bodies after some seconds more, as they move. */
static void advanced(const noh_stage_body *b, uint32_t count, float seconds, noh_ragdoll_pose *out)
{
    for (uint32_t i = 0; i < count; i++) {
        float turn[3], q[4];
        out[i] = b->bodies[0][i];
        noh_madd3(out[i].position, seconds, b->of.motions[i].velocity, out[i].position);
        for (int n = 0; n < 3; n++) turn[n] = b->of.motions[i].spin[n] * seconds;
        noh_quat_from_rotation(turn, q);
        noh_quat_mul(q, out[i].rotation, out[i].rotation);
        noh_quat_normalize(out[i].rotation);
    }
}

/* What the ragdoll's pose differs by from the work's, which becomes the ragdoll's. */
typedef struct differences {
    float turns[NOH_RAGDOLL_BODIES_MAX][3], offset[3];
} differences;

static void differ(const noh_stage_kind *k, const noh_stage_body *b, const noh_modifier_work *w, float seconds,
                   differences *d)
{
    const noh_ragdoll_fit *fit = &noh_stage_ragdoll_kind_of(k)->fit;
    const noh_ragdoll_frame frame = noh_stage_ragdoll_frame(k, &w->place, b->origin);
    noh_ragdoll_pose bodies[NOH_RAGDOLL_BODIES_MAX];
    float weights[NOH_RAGDOLL_BODIES_MAX], before[NOH_RAGDOLL_BODIES_MAX][4], from[3];
    advanced(b, fit->body_count, seconds, bodies);
    noh_stage_ragdoll_weights(k, b, weights);
    for (uint32_t i = 0; i < fit->body_count; i++) {
        noh_quat_conjugate(w->local[fit->joints[i]].rotation, before[i]);
    }
    memcpy(from, w->local[fit->joints[0]].translation, sizeof from);
    noh_ragdoll_to_pose(fit, w->skeleton, &frame, bodies, weights, w->local);
    for (uint32_t i = 0; i < fit->body_count; i++) {
        float turn[4];
        noh_quat_mul(w->local[fit->joints[i]].rotation, before[i], turn);
        noh_quat_to_rotation(turn, d->turns[i]);
    }
    noh_sub3(w->local[fit->joints[0]].translation, from, d->offset);
}

/* A rotation's vector next to another one: there are two within a turn. */
static void unwrap(const float near[3], float v[3])
{
    const float length = noh_sqrt(noh_dot3(v, v));
    if (noh_dot3(near, v) < 0.0f && length > 0.5f * PI) noh_madd3(v, -2.0f * PI / length, v, v);
}

static void keep_joints(const noh_ragdoll_fit *fit, const noh_transform *local, noh_transform *kept)
{
    for (uint32_t i = 0; i < fit->body_count; i++) kept[i] = local[fit->joints[i]];
}

static void begin(const noh_stage_kind *k, noh_stage_body *b, const noh_modifier_work *w, float seconds)
{
    const noh_ragdoll_fit *fit = &noh_stage_ragdoll_kind_of(k)->fit;
    noh_transform kept[NOH_RAGDOLL_BODIES_MAX];
    differences now, then;
    keep_joints(fit, w->local, kept);
    differ(k, b, w, seconds + SPEED_SECONDS, &then);
    for (uint32_t i = 0; i < fit->body_count; i++) w->local[fit->joints[i]] = kept[i];
    differ(k, b, w, seconds, &now);
    for (uint32_t i = 0; i < fit->body_count; i++) {
        noh_ragdoll_motion *m = &b->of.motions[i];
        unwrap(now.turns[i], then.turns[i]);
        memcpy(m->velocity, now.turns[i], sizeof m->velocity);
        for (int n = 0; n < 3; n++) m->spin[n] = (then.turns[i][n] - now.turns[i][n]) / SPEED_SECONDS;
    }
    memcpy(b->offset, now.offset, sizeof b->offset);
    for (int n = 0; n < 3; n++) b->speed[n] = (then.offset[n] - now.offset[n]) / SPEED_SECONDS;
}

/* How much of an offset and of its speed is left. */
static void shares(float seconds, float duration, float share[2])
{
    const float s = seconds / duration, s3 = s * s * s;
    share[0] = 1.0f - s3 * (10.0f - s * (15.0f - 6.0f * s));
    share[1] = duration * (s - s3 * (6.0f - s * (8.0f - 3.0f * s)));
}

static void go_on(const noh_stage_kind *k, const noh_stage_body *b, const noh_modifier_work *w, float seconds)
{
    const noh_ragdoll_fit *fit = &noh_stage_ragdoll_kind_of(k)->fit;
    float share[2];
    shares(seconds, (float)b->rise_ticks / (float)NOH_TICKS_PER_SECOND, share);
    for (uint32_t i = 0; i < fit->body_count; i++) {
        noh_transform *t = &w->local[fit->joints[i]];
        float turn[3], q[4];
        for (int n = 0; n < 3; n++)
            turn[n] = share[0] * b->of.motions[i].velocity[n] + share[1] * b->of.motions[i].spin[n];
        noh_quat_from_rotation(turn, q);
        noh_quat_mul(q, t->rotation, t->rotation);
        for (int n = 0; n < 3 && !i; n++) t->translation[n] += share[0] * b->offset[n] + share[1] * b->speed[n];
    }
}

void noh_stage_run_get_up(const noh_stage_kind *k, noh_stage_body *b, noh_modifier_work *w)
{
    int64_t since = noh_clock_since(w->clock, b->rise_clock);
    if (since < 0) since = 0;
    if (w->cut || since >= (int64_t)b->rise_ticks) {
        b->moves = NOH_MOVES_BY_CLIPS;
        return;
    }
    const float seconds = (float)since / (float)NOH_TICKS_PER_SECOND;
    if (b->moves == NOH_MOVES_UP) {
        go_on(k, b, w, seconds);
        return;
    }
    begin(k, b, w, seconds);
    b->moves = NOH_MOVES_UP;
    b->rise_ticks -= (uint32_t)since;
    b->rise_clock = w->clock;
}

/* ---- the call ---- */

/* From its doll, or from where it lies without one. */
static void leave_doll(const noh_stage *s, const noh_stage_kind *k, noh_stage_body *b, uint32_t ticks)
{
    memset(b->of.motions, 0, sizeof b->of.motions);
    if (b->doll) noh_ragdoll_motions(noh_stage_ragdoll_kind_of(k)->dolls, b->doll - 1u, b->of.motions);
    b->goals = noh_stage_breath_left(b, s->head->clock);
    noh_stage_give_doll(k, b);
    b->state = NOH_BODY_STANDS;
    b->moves = NOH_MOVES_UP_BEGINS;
    b->rise_ticks = ticks;
    b->rise_clock = b->clocks[0] = s->head->clock;
    b->poses = 1;
}

noh_result noh_actor_get_up(noh_stage *stage, noh_actor actor, const noh_get_up *how, uint32_t *ticks, noh_error *error)
{
    static const noh_get_up plain;
    likeness best;
    noh_stage_actor *a;
    noh_stage_kind *k;
    noh_stage_body *b = NULL;
    uint32_t lasts;
    noh_result result = noh_stage_open_body(stage, actor, &a, &k, &b, error);
    if (!how) how = &plain;
    if (ticks) *ticks = 0;
    if (!b || b->state == NOH_BODY_STANDS) return result;
    if (b->dead) return noh_fail(error, NOH_ERR_ARG, "the actor is dead: noh_actor_revive lets it get up", 0, 0);
    const uint32_t blend = lasts = how->blend_ticks ? how->blend_ticks : BLEND_TICKS;
    result = choose_clip(stage, k, a, b, how, &best, error);
    if (result == NOH_OK && best.clip != NOH_NONE) {
        const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
        const noh_clip_set *set;
        result = noh_stage_leap_to(stage, actor, how->layer, best.clip, blend, shared->fit.joints,
                                   shared->fit.body_count, error);
        if (noh_actor_controller(stage, actor, &set) && set->clips[best.clip].duration_ticks > lasts) {
            lasts = set->clips[best.clip].duration_ticks;
        }
    }
    if (result != NOH_OK) return result;
    if (noh_stage_falls_free(b)) stand_under(k, a, b, best.bodies);
    leave_doll(stage, k, b, blend);
    if (ticks) *ticks = lasts;
    noh_character_wake(noh_stage_character(k, noh_stage_index(k, a)));
    return NOH_OK;
}
