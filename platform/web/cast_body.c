/* cast_body.c: the parts of a stage that bodies and hair need. The program of faces has face_only.c instead. */
#include "cast.h"
#include "noh/low_life.h"

void web_cast_add_springs(noh_kind_desc *kind)
{
    kind->springs = noh_springs_module();
}

noh_result web_cast_add_hair(web_cast *cast, const noh_pack *pack, noh_error *error)
{
    noh_actor_hair_desc *hair = &cast->hair;
    noh_result result = NOH_ERR_NOT_FOUND;
    uint32_t k = 0;
    if (cast->wants.elsewhere || noh_haircut_open(pack, &cast->cut, NULL)) return NOH_OK;
    while (k < cast->desc.kind_count && result) {
        result = noh_actor_hair_desc_make(&cast->cut, pack, cast->kinds[k++].skeleton, hair, error);
    }
    if (result) return result;
    hair->kind = k - 1u;
    hair->head_max = hair->near_max = cast->wants.actors;
    hair->in_state = 1;
    cast->hair_part = noh_actor_hair_modifier(hair);
    cast->kinds[hair->kind].modifiers = &cast->hair_part;
    cast->kinds[hair->kind].modifier_count = 1;
    cast->heads_bytes = (noh_actor_hair_size(hair) + 15u) / 16u * 16u;
    cast->has_hair = 1;
    return NOH_OK;
}

void web_cast_add_fall(web_cast *cast)
{
    static const noh_plane floor_plane = { { 0.0f, 1.0f, 0.0f }, 0.0f };
    static const noh_world ground = { .planes = &floor_plane, .plane_count = 1, .friction = 0.6f };
    static const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    static noh_ragdoll_rig rig;
    (void)noh_kind_can_fall(&cast->kinds[0], &rig, &cast->cannot_fall);
    if (!cast->cannot_fall.result) cast->kinds[0].ragdoll = noh_ragdoll_module(&ragdoll);
}
