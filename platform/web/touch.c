/* touch.c: what a click or a tap does: it tells what is there, or pushes it, so that it falls and gets up. */
#include <emscripten.h>
#include <math.h>
#include <string.h>

#include "web.h"

#define PICK_M 1e6f
#define PUSH_HEIGHT 0.75f /* of the figure's */
#define WAIT_S 4.0        /* for one that does not come to rest */
#define STAY_S 0.2        /* it lies so long */
#define RISES_MAX 16u     /* clips to get up by */

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
/* Of what was picked last. */
EMSCRIPTEN_KEEPALIVE const char *web_picked_mesh(void)
{
    noh_mesh mesh;
    return noh_pack_mesh_at(&web.pack, web.hit.mesh, &mesh, NULL) == NOH_OK ? mesh.name : "";
}
/* "" for a mesh that no joint moves. */
EMSCRIPTEN_KEEPALIVE const char *web_picked_joint(void)
{
    for (uint32_t i = 0; i < web.figure_count && web.hit.joint != NOH_NONE; i++) {
        const web_figure *f = &web.figures[i];
        if (f->actor.id == web.hit.actor.id) return noh_stage_name(web.stage, f->kind, NOH_NAME_JOINT, web.hit.joint);
    }
    return "";
}

/* ---- pushing ---- */

/* "": the first characters can fall; else why not. */
EMSCRIPTEN_KEEPALIVE const char *web_cannot_fall(void)
{
    return web.cast.cannot_fall.result ? web.cast.cannot_fall.what : "";
}

static noh_result push(const web_figure *f, const float point[3], const float way[3], float strength)
{
    const float length = hypotf(way[0], way[2]), along = length > 1e-6f ? strength / length : 0.0f;
    const float impulse[3] = { along * way[0], 0.0f, along * way[2] };
    if (web.cast.cannot_fall.result) {
        web.error = web.cast.cannot_fall;
        return web.error.result;
    }
    if (f->kind) return noh_fail(&web.error, NOH_ERR_ARG, "only the pack's first skeleton can fall", f->kind, 0);
    return noh_actor_hit(web.stage, f->actor, point, impulse, &web.error);
}

/* Push what is under a pixel away from the camera, level, by so many newton seconds. Nothing there is no error. */
EMSCRIPTEN_KEEPALIVE int web_push_at(float x, float y, float strength)
{
    float way[3];
    if (!web_pick(x, y)) return 0;
    for (int i = 0; i < 3; i++) way[i] = web.hit.point[i] - web.view.eye[i];
    for (uint32_t i = 0; i < web.figure_count; i++) {
        if (web.figures[i].actor.id == web.hit.actor.id) {
            return (int)push(&web.figures[i], web.hit.point, way, strength);
        }
    }
    return 0;
}

/* The first character, at its chest. */
EMSCRIPTEN_KEEPALIVE int web_push(float strength)
{
    float way[3];
    noh_place place;
    (void)noh_actor_place(web.stage, web.figures[0].actor, &place, NULL);
    for (int i = 0; i < 3; i++) way[i] = place.position[i] - web.view.eye[i];
    place.position[1] += PUSH_HEIGHT * web.height;
    return (int)push(&web.figures[0], place.position, way, strength);
}

/* How many figures fall, lie or get up. */
EMSCRIPTEN_KEEPALIVE uint32_t web_fallen(void)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < web.figure_count; i++) {
        count += noh_actor_body(web.stage, web.figures[i].actor) != NOH_BODY_STANDS;
    }
    return count;
}

/* By the clips whose names say so; without any it goes back to what plays. */
static noh_result get_up(const web_figure *f)
{
    const char *clips[RISES_MAX], *name;
    noh_get_up how = { .clips = clips, .layer = WEB_BODY };
    for (uint32_t i = 0; (name = noh_stage_name(web.stage, f->kind, NOH_NAME_CLIP, i)) != NULL; i++) {
        if (strncmp(name, "get_up", 6) == 0 && how.clip_count < RISES_MAX) clips[how.clip_count++] = name;
    }
    return noh_actor_get_up(web.stage, f->actor, how.clip_count ? &how : NULL, NULL, &web.error);
}

noh_result web_rise(double seconds)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < web.figure_count && !result; i++) {
        const noh_body_state body = noh_actor_body(web.stage, web.figures[i].actor);
        const int down = body == NOH_BODY_FALLS || body == NOH_BODY_LIES;
        web.falls_s[i] = down ? web.falls_s[i] + seconds : 0.0;
        web.lies_s[i] = body == NOH_BODY_LIES ? web.lies_s[i] + seconds : 0.0;
        if (web.lies_s[i] >= STAY_S || web.falls_s[i] >= WAIT_S) {
            web.falls_s[i] = web.lies_s[i] = 0.0;
            result = get_up(&web.figures[i]);
        }
    }
    return result;
}
