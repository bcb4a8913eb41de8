/* touch.c: clicks and taps pick a figure. */
#include <emscripten.h>

#include "web.h"

#define PICK_M 1e6f

/* ---- picking ---- */

/* The nearest figure under a pixel of the canvas; x to the right, y down. Returns 0 for none. */
EMSCRIPTEN_KEEPALIVE int web_pick(float x, float y)
{
    float origin[3], direction[3];
    uint32_t width, height;
    noh_platform_web.size(web.context, &width, &height);
    return noh_view_ray(&web.view, x, y, width, height, origin, direction) &&
           noh_stage_pick(web.stage, origin, direction, PICK_M, &web.hit, NULL) == NOH_OK;
}
/* The mesh of the last pick. */
EMSCRIPTEN_KEEPALIVE const char *web_picked_mesh(void)
{
    noh_mesh mesh;
    return noh_pack_mesh_at(&web.pack, web.hit.mesh, &mesh, NULL) == NOH_OK ? mesh.name : "";
}
/* The joint of the last pick; "" for a mesh that no joint moves. */
EMSCRIPTEN_KEEPALIVE const char *web_picked_joint(void)
{
    for (uint32_t i = 0; i < web.figure_count && web.hit.joint != NOH_NONE; i++) {
        const web_figure *f = &web.figures[i];
        if (f->actor.id == web.hit.actor.id) return noh_stage_name(web.stage, f->kind, NOH_NAME_JOINT, web.hit.joint);
    }
    return "";
}
