/* without_falls.c: replaces cast_fall.c, push.c and vertices.c in face.wasm and body.wasm, which are smaller than
 * noh.wasm: figures do not fall, and no other renderer draws them. */
#include <emscripten.h>

#include "web.h"

void web_cast_add_fall(web_cast *cast)
{
    (void)noh_fail(&cast->cannot_fall, NOH_ERR_UNSUPPORTED, "this program has no falls: use noh.wasm", 0, 0);
}

/* ---- push.c ---- */

EMSCRIPTEN_KEEPALIVE const char *web_cannot_fall(void)
{
    return web.cast.cannot_fall.what;
}

EMSCRIPTEN_KEEPALIVE int web_push(float strength)
{
    (void)strength;
    web.error = web.cast.cannot_fall;
    return (int)web.error.result;
}

EMSCRIPTEN_KEEPALIVE int web_push_at(float x, float y, float strength)
{
    return web_pick(x, y) ? web_push(strength) : 0;
}

EMSCRIPTEN_KEEPALIVE uint32_t web_fallen(void)
{
    return 0;
}

noh_result web_rise(uint32_t ticks)
{
    (void)ticks;
    return NOH_OK;
}
