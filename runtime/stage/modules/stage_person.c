/* stage_person.c: an actor as a person: held floats, and lids that shut. */
#include "stage/modules/stage_face_internal.h"
#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"
#include "life/face/identity_internal.h"
#include "noh/base.h"
#include "noh/pack.h"
#include "noh/face.h"
#include "noh/noh.h"
#include "noh/modules.h"

/* The float of a target of the identity's mesh. */
static uint32_t float_of(const noh_stage *s, noh_actor actor, const noh_mesh *mesh, uint32_t target)
{
    noh_stage_kind *k;
    (void)noh_stage_actor_of(s, actor, &k);
    return noh_stage_find(s, (uint32_t)(k - s->kinds), NOH_NAME_FLOAT,
                          noh_pack_string(mesh->pack, mesh->targets[target].name));
}

static const noh_stage_held *held_at(const noh_stage_kind *k, const noh_stage_held *held, uint32_t index)
{
    for (uint32_t h = 0; h < k->desc->held_float_count; h++) {
        if (held[h].amount > 0.0f && held[h].index == index) return &held[h];
    }
    return NULL;
}

/* Check that all floats exist, and that enough held floats are free. */
static noh_result check(const noh_stage *s, noh_actor actor, const noh_identity *identity, const noh_mesh *mesh,
                        const float *weights, noh_error *error)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(s, actor, &k);
    const noh_stage_held *held = k->held + (size_t)noh_stage_index(k, a) * k->desc->held_float_count;
    uint32_t needed = 0;
    for (uint32_t h = 0; h < k->desc->held_float_count; h++) needed += held[h].amount > 0.0f;
    for (uint32_t t = 0; t < identity->target_count; t++) {
        uint32_t at;
        int was_held;
        if (!identity->targets[t].used) continue;
        at = float_of(s, actor, mesh, t);
        if (at == NOH_NONE)
            return noh_fail(error, NOH_ERR_NOT_FOUND, "the kind has no float of an identity target", t, 0);
        if (weights && !noh_is_number(weights[t]))
            return noh_fail(error, NOH_ERR_ARG, "a weight of a person is not finite, or beyond NOH_NUMBER_MAX", t, 0);
        was_held = held_at(k, held, at) != NULL;
        needed += weights && weights[t] != 0.0f;
        needed -= was_held ? 1u : 0u;
    }
    return needed <= k->desc->held_float_count
               ? NOH_OK
               : noh_fail(error, NOH_ERR_LIMIT, "a person holds more floats than held_float_count", 0, needed);
}

static void set_lids(const noh_stage *s, noh_actor actor, const noh_identity *identity, const noh_mesh *mesh,
                     const float *weights)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(s, actor, &k);
    noh_stage_face *f = noh_stage_face_of(k, noh_stage_index(k, a));
    for (uint32_t i = 0; i < NOH_IDENTITY_CLOSINGS; i++) f->shut[i] = 0;
    for (uint32_t c = 0; weights && c < identity->closing_count; c++) {
        const uint32_t at = float_of(s, actor, mesh, identity->closings[c]);
        for (uint32_t i = 0; i < NOH_IDENTITY_CLOSINGS; i++) {
            if (noh_stage_face_kind_of(k)->lids[i] != at || at == NOH_NONE) continue;
            f->shut[i] = (uint16_t)(1.5f + noh_identity_shut(identity, weights, c) * NOH_STAGE_SHUT);
        }
    }
}

noh_result noh_actor_set_identity(noh_stage *stage, noh_actor actor, const noh_identity *identity, const noh_mesh *mesh,
                                  const float *weights, noh_error *error)
{
    noh_stage_kind *k;
    noh_result result;
    (void)noh_stage_change_face(stage, actor, &k, &result, error);
    NOH_ASSERT(identity && mesh);
    if (result == NOH_OK && identity->target_count > mesh->header->target_count) {
        result = noh_fail(error, NOH_ERR_ARG, "the identity is of another mesh", 0, 0);
    }
    if (result == NOH_OK) result = check(stage, actor, identity, mesh, weights, error);
    for (int pass = 0; pass < 2; pass++) { /* let go first, so that there is room */
        for (uint32_t t = 0; result == NOH_OK && t < identity->target_count; t++) {
            const int holds = weights && weights[t] != 0.0f;
            if (!identity->targets[t].used || holds != pass) continue;
            result = noh_actor_hold_float(stage, actor, float_of(stage, actor, mesh, t), holds ? weights[t] : 0.0f,
                                          holds ? 1.0f : 0.0f, error);
        }
    }
    if (result == NOH_OK) set_lids(stage, actor, identity, mesh, weights);
    return result;
}
