/* hair.c: the hair of the page's characters, with wind, and with swing when heads are shaken. */
#include <emscripten.h>
#include <math.h>
#include <string.h>

#include "web.h"

#define SHAKE_S 1.6  /* duration of a head shake */
#define SHAKE_HZ 1.5 /* its frequency */
#define SHAKE_RAD 0.6
#define TURN 6.283185307179586

/* ---- create and delete ---- */

static int is_worn(void)
{
    return web.cast.hair_kind != NOH_NONE;
}

/* The figure of a character that has the hair. */
static const web_figure *figure_of(uint32_t character)
{
    for (uint32_t i = 0; i < web.figure_count; i++) {
        if (web.figures[i].kind == web.cast.hair_kind && web.figures[i].character == character) return &web.figures[i];
    }
    return NULL;
}

noh_result web_hair_open(void)
{
    const noh_gl_device device = { &web.gl, &web.caps, &web.ledger, NULL, 0 };
    noh_result result = NOH_OK;
    if (!is_worn()) return NOH_OK;
    memcpy(web.cast.wig.wind, web.hair.wind, sizeof web.hair.wind);
    for (uint32_t i = 0; i < web.cast.wants.actors && !result; i++) {
        result = noh_stage_hair_create(&device, &web.cast.wig, web_block(web.cast.hair_at + i * web.cast.hair_bytes),
                                       web.cast.hair_bytes, web.cast.wants.lit, web.cast.desc.encode_srgb,
                                       &web.hair.drawn[i], &web.error);
    }
    return result;
}

void web_hair_close(void)
{
    for (uint32_t i = 0; i < WEB_CHARACTERS_MAX; i++) {
        if (web.hair.drawn[i].gl) noh_stage_hair_delete(&web.hair.drawn[i]);
        memset(&web.hair.drawn[i], 0, sizeof web.hair.drawn[i]);
    }
}

noh_result web_hair_restore(void)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; is_worn() && i < web.cast.wants.actors && !result; i++) {
        result = noh_stage_hair_restore(&web.hair.drawn[i], NULL, 0, &web.error);
    }
    return result;
}

/* ---- a frame ---- */

/* The hair of a character; NULL: none, or hidden. */
static noh_stage_hair *shown(uint32_t character)
{
    return is_worn() && !web.hair.off && figure_of(character) ? &web.hair.drawn[character] : NULL;
}

noh_result web_hair_update(void)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < web.cast.wants.actors && !result; i++) {
        if (shown(i)) result = noh_stage_hair_update(shown(i), web.stage, figure_of(i)->actor, 0, &web.error);
    }
    return result;
}

void web_hair_shadow(void)
{
    for (uint32_t i = 0; i < web.cast.wants.actors; i++) {
        if (shown(i)) noh_stage_hair_draw_shadow(shown(i), web.stage, 1);
    }
}

static void draw_half(noh_pass pass)
{
    for (uint32_t i = 0; i < web.cast.wants.actors; i++) {
        if (shown(i)) noh_stage_hair_draw(shown(i), web.stage, 0, pass);
    }
}

/* Draw opaque surfaces, opaque hair, blended surfaces, blended hair. */
noh_result web_hair_draw(void)
{
    noh_result result;
    if (!is_worn()) return noh_stage_draw(web.stage, NOH_PASS_COLOR, 0, NULL, &web.error);
    result = noh_stage_draw(web.stage, NOH_PASS_OPAQUE, 0, NULL, &web.error);
    if (!result) draw_half(NOH_PASS_OPAQUE);
    if (!result) result = noh_stage_draw(web.stage, NOH_PASS_BLENDED, 0, NULL, &web.error);
    if (!result) draw_half(NOH_PASS_BLENDED);
    return result;
}

/* ---- calls from the page ---- */

EMSCRIPTEN_KEEPALIVE int web_has_hair(void)
{
    return is_worn();
}

/* shows: 0 or 1; wind: metres per second, from the right. */
EMSCRIPTEN_KEEPALIVE void web_set_hair(int shows, float wind)
{
    web.hair.off = !shows;
    web.hair.wind[0] = -wind;
    memcpy(web.cast.wig.wind, web.hair.wind, sizeof web.hair.wind);
}

/* Shake the heads: characters turn left and right for SHAKE_S seconds. */
EMSCRIPTEN_KEEPALIVE void web_shake(void)
{
    if (web.hair.shake_s <= 0.0) web.hair.shake_s = SHAKE_S;
}
EMSCRIPTEN_KEEPALIVE int web_shakes(void)
{
    return web.hair.shake_s > 0.0;
}
/* The turn of the first character: sine of half the angle. */
EMSCRIPTEN_KEEPALIVE float web_shaken(void)
{
    noh_place place;
    (void)noh_actor_place(web.stage, web.figures[0].actor, &place, NULL);
    return place.rotation[1];
}

/* The angle at a remaining time of the shake: 0 at both ends. */
static double angle_at(double left_s)
{
    const double gone = SHAKE_S - left_s;
    return SHAKE_RAD * sin(TURN * SHAKE_HZ * gone) * sin(0.5 * TURN * gone / SHAKE_S);
}

/* Turn a place about the vertical axis. */
static void turn(noh_place *place, double angle)
{
    const float s = (float)sin(0.5 * angle), c = (float)cos(0.5 * angle);
    float *q = place->rotation;
    const int none = q[0] == 0.0f && q[1] == 0.0f && q[2] == 0.0f && q[3] == 0.0f;
    const float x = q[0], y = q[1], z = q[2], w = none ? 1.0f : q[3];
    q[0] = c * x + s * z;
    q[1] = c * y + s * w;
    q[2] = c * z - s * x;
    q[3] = c * w - s * y;
}

void web_hair_shake(double seconds)
{
    const double before = web.hair.shake_s, after = before > seconds ? before - seconds : 0.0;
    if (before <= 0.0) return;
    web.hair.shake_s = after;
    for (uint32_t i = 0; i < web.figure_count; i++) {
        noh_place place;
        if (noh_actor_place(web.stage, web.figures[i].actor, &place, NULL)) continue;
        turn(&place, (after > 0.0 ? angle_at(after) : 0.0) - angle_at(before));
        (void)noh_actor_set_place(web.stage, web.figures[i].actor, &place, NULL);
    }
}
