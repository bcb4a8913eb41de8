/* touch.c: clicks and taps: they pick a figure, or push it so that it falls and gets up. */
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

/* ---- pushing ---- */

/* "": figures of the first skeleton can fall; else the reason why not. */
EMSCRIPTEN_KEEPALIVE const char *web_cannot_fall(void)
{
    return web.cast.cannot_fall.result ? web.cast.cannot_fall.what : "";
}

/* point: where the figure is hit; NULL: at its chest, with a direction computed from its place */
static noh_result push(const web_figure *f, const float point[3], float strength)
{
    float impulse[3];
    noh_place place;
    if (web.cast.cannot_fall.result) {
        web.error = web.cast.cannot_fall;
        return web.error.result;
    }
    if (f->kind) return noh_fail(&web.error, NOH_ERR_ARG, "only the pack's first skeleton can fall", f->kind, 0);
    (void)noh_actor_place(web.stage, f->actor, &place, NULL);
    noh_push_away(web.view.eye, point ? point : place.position, strength, impulse);
    return noh_actor_push(web.stage, f->actor, point, impulse, &web.error);
}

/* Push the figure under a pixel horizontally away from the camera. strength: newton seconds. Returns 0 if there is
 * none. */
EMSCRIPTEN_KEEPALIVE int web_push_at(float x, float y, float strength)
{
    if (!web_pick(x, y)) return 0;
    for (uint32_t i = 0; i < web.figure_count; i++) {
        if (web.figures[i].actor.id == web.hit.actor.id) {
            return (int)push(&web.figures[i], web.hit.point, strength);
        }
    }
    return 0;
}

/* Push the first character at its chest. */
EMSCRIPTEN_KEEPALIVE int web_push(float strength)
{
    return (int)push(&web.figures[0], NULL, strength);
}

/* The number of figures that fall, lie or get up. */
EMSCRIPTEN_KEEPALIVE uint32_t web_fallen(void)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < web.figure_count; i++) {
        count += (uint32_t)noh_fall_lasts(&web.falls[i], web.stage, web.figures[i].actor);
    }
    return count;
}

noh_result web_rise(uint32_t ticks)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < web.figure_count && !result; i++) {
        result = noh_fall_step(&web.falls[i], web.stage, web.figures[i].actor, WEB_BODY, ticks, &web.error);
    }
    return result;
}
