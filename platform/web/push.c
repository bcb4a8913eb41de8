/* push.c: a push makes a figure fall, and it gets up. face.wasm and body.wasm have without_falls.c instead. */
#include <emscripten.h>

#include "web.h"

/* NULL: figures of the first skeleton can fall; else the reason why not. */
EMSCRIPTEN_KEEPALIVE const char *web_cannot_fall(void)
{
    return web.cast.cannot_fall.result ? web.cast.cannot_fall.what : NULL;
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
