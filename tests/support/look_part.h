/* look_part.h: a part for the tests of parts: a head that turns to a target, in a second, and gives up at a right angle
 * and a half. */
#ifndef NOH_TESTS_SUPPORT_LOOK_PART_H
#define NOH_TESTS_SUPPORT_LOOK_PART_H

#include <math.h>
#include <string.h>

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/modules.h"
#include "noh/pack.h"

/* The state and the inputs of the part. */
typedef struct look_state {
    float target[3]; /* world */
    float wanted;    /* 0..1: how far to turn */
    float turned;    /* 0..1, so far */
    uint32_t calls, cuts;
    uint32_t ticks;
} look_state;

typedef struct look_joint {
    uint32_t head;
    float forward[3]; /* of the head, in its own space */
} look_joint;

/* The head faces +z in the bind pose. */
static inline look_joint look_joint_of(const noh_pack *pack, const char *name)
{
    static float model_space[12u * NOH_JOINTS_MAX];
    look_joint j;
    noh_skeleton skeleton;
    memset(&j, 0, sizeof j);
    (void)noh_pack_skeleton_at(pack, 0, &skeleton, NULL, NULL);
    while (j.head + 1u < skeleton.joint_count && strcmp(noh_pack_joint_name(pack, 0, j.head), name) != 0) j.head++;
    noh_local_to_model(&skeleton, skeleton.bind_pose, skeleton.joint_count, model_space);
    for (int i = 0; i < 3; i++) j.forward[i] = model_space[12u * j.head + 8u + (uint32_t)i];
    return j;
}

/* Where the target is from the head, a unit vector in the space of the head's parent. */
static inline void look_direction(const noh_modifier_work *w, const float *models, uint32_t head, float out[3])
{
    const look_state *g = w->state;
    const float back[4] = { -w->place.rotation[0], -w->place.rotation[1], -w->place.rotation[2], w->place.rotation[3] };
    const float *m = models + 12u * head, *p = models + 12u * w->skeleton->parents[head];
    float d[3], length = 0.0f;
    for (int i = 0; i < 3; i++) d[i] = g->target[i] - w->place.position[i];
    noh_quat_rotate(back, d, d);
    for (int i = 0; i < 3; i++) d[i] = d[i] / w->place.scale - m[4 * i + 3];
    for (int i = 0; i < 3; i++) {
        out[i] = p[i] * d[0] + p[4 + i] * d[1] + p[8 + i] * d[2];
        length += out[i] * out[i];
    }
    for (int i = 0; i < 3; i++) out[i] = length > 0.0f ? out[i] / sqrtf(length) : 0.0f;
}

static inline void look_modify(noh_modifier_work *w)
{
    const look_joint *j = w->user;
    look_state *g = w->state;
    float *r = w->local[j->head].rotation, f[3], d[3], dot, q[4];
    const float step = w->cut ? 1.0f : (float)w->ticks / (float)NOH_TICKS_PER_SECOND;
    g->calls++;
    g->cuts += w->cut;
    g->ticks += w->ticks;
    g->turned += (g->wanted - g->turned) * (step < 1.0f ? step : 1.0f);
    look_direction(w, noh_modifier_model(w), j->head, d);
    noh_quat_rotate(r, j->forward, f);
    dot = f[0] * d[0] + f[1] * d[1] + f[2] * d[2];
    if (dot < -0.7f) return;
    q[0] = (f[1] * d[2] - f[2] * d[1]) * g->turned;
    q[1] = (f[2] * d[0] - f[0] * d[2]) * g->turned;
    q[2] = (f[0] * d[1] - f[1] * d[0]) * g->turned;
    q[3] = 1.0f + dot * g->turned + (1.0f - g->turned);
    noh_quat_normalize(q);
    noh_quat_mul(q, r, r);
}

static inline const char *look_check(const void *user, const void *state)
{
    const look_state *g = state;
    (void)user;
    return g->turned >= 0.0f && g->turned <= 1.0f && g->wanted >= 0.0f && g->wanted <= 1.0f &&
                   g->target[0] - g->target[0] == 0.0f && g->target[1] - g->target[1] == 0.0f &&
                   g->target[2] - g->target[2] == 0.0f
               ? NULL
               : "state: a gaze is not finite";
}

#endif
