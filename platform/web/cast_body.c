/* cast_body.c: the parts of a stage that bodies and hair need. face.wasm has face_only.c instead. */
#include "cast.h"
#include "draw/facing.h"
#include "noh/clip.h"
#include "noh/low_life.h"

void web_cast_add_springs(noh_kind_desc *kind)
{
    kind->springs = noh_springs_module(NULL);
}

static const noh_modifier *add_modifier(web_cast *cast, uint32_t kind, noh_modifier modifier)
{
    noh_kind_desc *k = &cast->kinds[kind];
    k->modifiers = cast->modifiers[kind];
    cast->modifiers[kind][k->modifier_count] = modifier;
    return &cast->modifiers[kind][k->modifier_count++];
}

/* The library's modifier, by a clock that does not go on while the figure is held still. */
static void stand(noh_modifier_work *w)
{
    const web_stand *s = w->user;
    noh_modifier_work held = *w;
    held.clock -= s->wants->held_ticks;
    held.user = &s->rig;
    noh_stand_modifier(&s->rig).modify(&held);
}

static int clips_move_joints(const noh_pack *pack)
{
    noh_pack_clip clip;
    for (uint32_t i = 0; noh_pack_clip_at(pack, i, &clip, NULL) == NOH_OK; i++) {
        if (clip.header->joint_count) return 1;
    }
    return 0;
}

void web_cast_add_stand(web_cast *cast, const noh_pack *pack)
{
    if (clips_move_joints(pack)) return;
    for (uint32_t k = 0; k < cast->desc.kind_count; k++) {
        web_stand *s = &cast->stands[k];
        if (noh_kind_stand_make(&cast->kinds[k], &s->rig, NULL)) continue; /* it is no humanoid */
        s->wants = &cast->wants;
        (void)add_modifier(cast, k, (noh_modifier){ .name = "stand", .modify = stand, .user = s });
        cast->stand_count++;
    }
}

float web_cast_facing(const noh_pack *pack)
{
    return (float)pack_facing(pack);
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
    cast->hair_part = add_modifier(cast, hair->kind, noh_actor_hair_modifier(hair));
    cast->heads_bytes = (noh_actor_hair_size(hair) + 15u) / 16u * 16u;
    cast->has_hair = 1;
    return NOH_OK;
}
