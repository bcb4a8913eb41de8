/* wig.c: control hairs as a part of the stage. They move in metres and from the model's scale, as springs do. */
#include "life/hair/hair.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/pack.h"

#include "core/base/assert.h"
#include "core/base/name_internal.h"
#include "life/hair/hair_internal.h"
#include "life/physics/vector_internal.h"
#include "stage/cast/stage_internal.h"

/* Behind it a noh_hair. */
typedef struct wig_state {
    uint32_t begun; /* 0: there is no hair yet */
    uint32_t reserved[3];
} wig_state;

noh_result noh_wig_make(const noh_haircut *cut, const noh_pack *pack, uint32_t skeleton, noh_wig *out, noh_error *error)
{
    noh_skeleton s;
    const noh_skeleton_header *header;
    NOH_ASSERT(cut && pack && out);
    memset(out, 0, sizeof *out);
    out->cut = cut;
    out->joint = NOH_NONE;
    if (!cut->joint[0]) return NOH_OK;
    const noh_result result = noh_pack_skeleton_at(pack, skeleton, &s, &header, error);
    if (result) return result;
    for (uint32_t i = 0; i < s.joint_count && out->joint == NOH_NONE; i++) {
        if (noh_names_equal(noh_pack_joint_name(pack, skeleton, i), cut->joint)) out->joint = i;
    }
    return out->joint == NOH_NONE
               ? noh_fail(error, NOH_ERR_NOT_FOUND, "the skeleton has no joint of the name that the haircut wants",
                          skeleton, 0)
               : NOH_OK;
}

/* What the joint has turned and moved the model's bind pose by, in metres; the actor's place on top. */
static noh_hair_carrier carrier_of(const noh_part_work *w, const noh_wig *wig)
{
    const noh_stage_kind *kind = w->kind;
    const float metres = wig->cut->header->metres;
    noh_hair_carrier c;
    float at[3] = { 0.0f, 0.0f, 0.0f }, bind_at[3], bind[4];
    memset(&c, 0, sizeof c);
    c.rotation[3] = 1.0f;
    if (wig->joint < w->skeleton->joint_count) {
        noh_stage_joint_at(kind, w->local, wig->joint, c.rotation, at);
        noh_stage_joint_at(kind, w->skeleton->bind_pose, wig->joint, bind, bind_at);
        noh_quat_conjugate(bind, bind);
        noh_quat_mul(c.rotation, bind, c.rotation);
        noh_quat_rotate(c.rotation, bind_at, bind_at);
        noh_sub3(at, bind_at, at);
    }
    noh_quat_rotate(w->place.rotation, at, at);
    noh_madd3(at, 1.0f / w->place.scale, w->near_place, at);
    noh_quat_mul(w->place.rotation, c.rotation, c.rotation);
    noh_quat_normalize(c.rotation);
    noh_madd3(c.position, metres, at, c.position);
    memcpy(c.wind, wig->wind, sizeof c.wind);
    return c;
}

static void modify(noh_part_work *w)
{
    const noh_wig *wig = w->user;
    const noh_hair_desc *desc = &wig->cut->desc;
    wig_state *state = w->state;
    noh_hair *hair = (noh_hair *)(void *)(state + 1);
    const noh_hair_carrier carrier = carrier_of(w, wig);
    if (state->begun && noh_part_home_moved(w)) {
        float by[3];
        for (int i = 0; i < 3; i++) by[i] = w->home_moved[i] * wig->cut->header->metres / w->place.scale;
        noh_hair_shift(hair, by);
    }
    if (!state->begun) {
        state->begun = noh_hair_init(hair, noh_hair_size(desc), desc, &carrier, &hair, NULL) == NOH_OK;
    } else if (w->cut) {
        noh_hair_reset(hair, desc, &carrier);
    } else {
        (void)noh_hair_step(hair, desc, &carrier, w->ticks);
    }
}

static const char *check(const void *user, const void *state)
{
    const noh_wig *wig = user;
    const wig_state *s = state;
    if (s->begun > 1u) return "state: hair is neither there nor not";
    return s->begun ? noh_hair_check((const noh_hair *)(const void *)(s + 1), &wig->cut->desc) : NULL;
}

noh_stage_part noh_wig_part(const noh_wig *wig)
{
    noh_stage_part part;
    NOH_ASSERT(wig && wig->cut);
    memset(&part, 0, sizeof part);
    part.name = "hair";
    part.modify = modify;
    part.check = check;
    part.user = wig;
    part.state_bytes = (uint32_t)(sizeof(wig_state) + noh_hair_size(&wig->cut->desc));
    return part;
}

void noh_wig_points(const noh_wig *wig, const void *state, float *points)
{
    NOH_ASSERT(wig && points);
    const noh_hair_desc *d = &wig->cut->desc;
    const wig_state *s = state;
    if (s && s->begun) {
        noh_hair_points((const noh_hair *)(const void *)(s + 1), d, points);
    } else {
        memcpy(points, d->rest, (size_t)d->hair_count * d->point_count * 3u * sizeof(float));
    }
}

int noh_wig_seen(const noh_wig *wig, const noh_stage *stage, noh_actor actor, float world[12], float *pixels_per_metre,
                 uint32_t *views)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    NOH_ASSERT(wig && world && pixels_per_metre && views);
    if (!a || stage->shown[a - stage->actors].frame != stage->frame) return 0;
    const noh_stage_shown *shown = &stage->shown[a - stage->actors];
    const float units = 1.0f / wig->cut->header->metres;
    float to_joint[12] = { units, 0.0f, 0.0f, 0.0f, 0.0f, units, 0.0f, 0.0f, 0.0f, 0.0f, units, 0.0f };
    float joint[12], rotation[4], at[3];
    memcpy(joint, shown->world, sizeof joint);
    if (wig->joint < k->skeleton.joint_count && noh_stage_joint(stage, actor, wig->joint, joint, NULL) == NOH_OK) {
        noh_stage_joint_at(k, k->skeleton.bind_pose, wig->joint, rotation, at);
        noh_quat_conjugate(rotation, rotation);
        for (int i = 0; i < 3; i++) {
            float axis[3] = { i == 0 ? units : 0.0f, i == 1 ? units : 0.0f, i == 2 ? units : 0.0f };
            noh_quat_rotate(rotation, axis, axis);
            for (int r = 0; r < 3; r++) to_joint[4 * r + i] = axis[r];
        }
        noh_quat_rotate(rotation, at, at);
        for (int r = 0; r < 3; r++) to_joint[4 * r + 3] = -at[r];
    }
    noh_matrix_multiply(joint, to_joint, world);
    *pixels_per_metre = shown->scale / wig->cut->header->metres * noh_stage_size(stage, a);
    *views = shown->views;
    return 1;
}
