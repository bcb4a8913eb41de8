/* face_only.c: replaces cast_body.c, hair.c, check_hair.c and check_springs.c in face.wasm: bodies keep the bind
 * pose and face +z, and hair and springs of a pack are not read. */
#include <emscripten.h>

#include "core/pack/check_internal.h"
#include "web.h"

noh_result noh_check_hair(noh_check *check)
{
    (void)check;
    return NOH_OK;
}

noh_result noh_check_springs(noh_check *check)
{
    (void)check;
    return NOH_OK;
}

void web_cast_add_springs(noh_kind_desc *kind)
{
    (void)kind;
}

void web_cast_add_stand(web_cast *cast, const noh_pack *pack)
{
    (void)cast;
    (void)pack;
}

float web_cast_facing(const noh_pack *pack)
{
    (void)pack;
    return 0.0f;
}

noh_result web_cast_add_hair(web_cast *cast, const noh_pack *pack, noh_error *error)
{
    (void)cast;
    (void)pack;
    (void)error;
    return NOH_OK;
}

/* ---- hair.c ---- */

noh_result web_hair_open(void)
{
    return NOH_OK;
}

void web_hair_close(void) {}

noh_result web_hair_restore(void)
{
    return NOH_OK;
}

void web_hair_update(void) {}

void web_hair_shadow(void) {}

noh_result web_hair_draw(void)
{
    return noh_stage_draw(web.stage, NOH_PASS_COLOR, 0, NULL, &web.error);
}

void web_hair_shake(double seconds)
{
    (void)seconds;
}

EMSCRIPTEN_KEEPALIVE int web_has_hair(void)
{
    return 0;
}

EMSCRIPTEN_KEEPALIVE void web_set_hair(int shows, float wind)
{
    (void)shows;
    (void)wind;
}

EMSCRIPTEN_KEEPALIVE void web_shake(void) {}

EMSCRIPTEN_KEEPALIVE int web_shakes(void)
{
    return 0;
}
