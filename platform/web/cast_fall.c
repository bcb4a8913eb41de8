/* cast_fall.c: the part of a stage that falls need. face.wasm and body.wasm have without_falls.c instead. */
#include "cast.h"

void web_cast_add_fall(web_cast *cast)
{
    static const noh_plane floor_plane = { { 0.0f, 1.0f, 0.0f }, 0.0f };
    static const noh_world ground = { .planes = &floor_plane, .plane_count = 1, .friction = 0.6f };
    static const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    static noh_ragdoll_rig rig;
    (void)noh_kind_can_fall(&cast->kinds[0], &rig, &cast->cannot_fall);
    if (!cast->cannot_fall.result) cast->kinds[0].ragdoll = noh_ragdoll_module(&ragdoll);
}
