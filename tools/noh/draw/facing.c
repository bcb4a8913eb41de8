#include "facing.h"

#include "life/reach/feet_internal.h"

double pack_facing(const noh_pack *pack)
{
    noh_ragdoll_source source = { .pack = pack };
    if (noh_pack_skeleton_at(pack, 0, &source.joints, NULL, NULL)) return 0.0;
    const uint32_t front = noh_front_of(&source);
    return front == 3u ? -90.0 : 90.0 * front;
}
