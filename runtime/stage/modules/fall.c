/* fall.c: pushes, and when an actor that lies gets up. */
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/modules.h"
#include "noh/noh.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"
#include "stage/modules/stage_ragdoll_internal.h"

#define CHEST 0.75f /* of the way up */

void noh_push_away(const float eye[3], const float point[3], float strength, float impulse[3])
{
    const float x = point[0] - eye[0], z = point[2] - eye[2], length = noh_sqrt(x * x + z * z);
    const float along = length > 1e-6f ? strength / length : 0.0f;
    impulse[0] = along * x;
    impulse[1] = 0.0f;
    impulse[2] = along * z;
}

static noh_result find_chest(const noh_stage *stage, noh_actor actor, const noh_stage_kind *k, float point[3],
                             noh_error *error)
{
    noh_place place;
    float top = 0.0f;
    noh_result result = noh_actor_place(stage, actor, &place, error);
    for (uint32_t i = 0; i < k->plan->joint_count && result == NOH_OK; i++) {
        float matrix[12];
        result = noh_actor_joint(stage, actor, i, matrix, error);
        if (result == NOH_OK && matrix[7] - place.position[1] > top) top = matrix[7] - place.position[1];
    }
    if (result != NOH_OK) return result;
    memcpy(point, place.position, sizeof place.position);
    point[1] += CHEST * top;
    return NOH_OK;
}

noh_result noh_actor_push(noh_stage *stage, noh_actor actor, const float point[3], const float impulse[3],
                          noh_error *error)
{
    noh_stage_actor *a;
    noh_stage_kind *k;
    noh_stage_body *b = NULL;
    noh_result result = noh_stage_open_body(stage, actor, &a, &k, &b, error);
    float at[3] = { 0.0f, 0.0f, 0.0f };
    NOH_ASSERT(impulse);
    if (!b) return result;
    if (point) memcpy(at, point, sizeof at);
    if (!point) result = find_chest(stage, actor, k, at, error);
    if (result != NOH_OK) return result;
    for (int i = 0; i < 3; i++) at[i] *= noh_stage_ragdoll_kind_of(k)->metres;
    return noh_actor_hit(stage, actor, at, impulse, error);
}

/* Large actors fall for longer: times grow by the square root of the scale. */
static uint32_t wait_ticks(const noh_stage *stage, noh_actor actor)
{
    noh_place place;
    if (noh_actor_place(stage, actor, &place, NULL) != NOH_OK || !(place.scale > 1.0f)) return NOH_FALL_WAIT_TICKS;
    return (uint32_t)((float)NOH_FALL_WAIT_TICKS * noh_sqrt(place.scale < 100.0f ? place.scale : 100.0f));
}

noh_result noh_fall_step(noh_fall *fall, noh_stage *stage, noh_actor actor, uint32_t layer, uint32_t ticks,
                         noh_error *error)
{
    const noh_body_state body = noh_actor_body(stage, actor);
    if (body != NOH_BODY_FALLS && body != NOH_BODY_LIES) {
        fall->down_ticks = fall->still_ticks = 0;
        fall->rise_ticks -= fall->rise_ticks < ticks ? fall->rise_ticks : ticks;
        return NOH_OK;
    }
    fall->rise_ticks = 0;
    fall->down_ticks += ticks;
    fall->still_ticks = body == NOH_BODY_LIES ? fall->still_ticks + ticks : 0;
    if (fall->still_ticks < NOH_FALL_STAY_TICKS && fall->down_ticks < wait_ticks(stage, actor)) return NOH_OK;
    fall->down_ticks = fall->still_ticks = 0;
    return noh_actor_get_up(stage, actor, &(noh_get_up){ .layer = layer }, &fall->rise_ticks, error);
}

int noh_fall_lasts(const noh_fall *fall, const noh_stage *stage, noh_actor actor)
{
    return fall->rise_ticks || noh_actor_body(stage, actor) != NOH_BODY_STANDS;
}
