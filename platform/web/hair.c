/* hair.c: the hair of the page's characters, with wind, and with swing when heads are shaken. */
#include <emscripten.h>
#include <string.h>

#include "web.h"

#define SHAKE_S 1.6       /* how long a head is shaken */
#define SHAKE_HZ 1.5      /* how often per second */
#define SHAKE_TURNS 0.095 /* of a full circle */

/* ---- life cycle ---- */

noh_result web_hair_open(void)
{
    const noh_gl_device device = { &web.gl, &web.caps, &web.ledger, NULL, 0 };
    noh_actor_hair_desc *desc = &web.cast.hair;
    noh_result result;
    if (!web.cast.has_hair) return NOH_OK;
    memcpy(desc->wind, web.hair.wind, sizeof desc->wind);
    result = noh_actor_hair_init(web_block(web.cast.hair_at), web.cast.heads_bytes, desc, &web.hair.heads, &web.error);
    if (result) return result;
    return noh_stage_hair_create(&device, web.hair.heads, web_block(web.cast.hair_at + web.cast.heads_bytes),
                                 noh_stage_hair_size(desc), web.cast.wants.lit, web.cast.desc.encode_srgb,
                                 &web.hair.drawn, &web.error);
}

void web_hair_close(void)
{
    noh_stage_hair_delete(&web.hair.drawn);
    memset(&web.hair.drawn, 0, sizeof web.hair.drawn);
    web.hair.heads = NULL;
}

noh_result web_hair_restore(void)
{
    return web.hair.heads ? noh_stage_hair_restore(&web.hair.drawn, NULL, 0, &web.error) : NOH_OK;
}

/* ---- a frame ---- */

static int is_shown(void)
{
    return web.hair.heads && !web.hair.off;
}

void web_hair_update(void)
{
    if (!is_shown()) return;
    noh_actor_hair_frame(web.hair.heads, web.stage, 0);
    noh_stage_hair_update(&web.hair.drawn);
}

void web_hair_shadow(void)
{
    if (is_shown()) noh_stage_hair_draw_shadow(&web.hair.drawn, web.stage, 1);
}

/* Opaque surfaces and hair on them, then what blends in front of them. */
noh_result web_hair_draw(void)
{
    noh_result result;
    if (!web.hair.heads) return noh_stage_draw(web.stage, NOH_PASS_COLOR, 0, NULL, &web.error);
    result = noh_stage_draw(web.stage, NOH_PASS_OPAQUE, 0, NULL, &web.error);
    if (!result && is_shown()) noh_stage_hair_draw(&web.hair.drawn, web.stage, 0, NOH_PASS_OPAQUE);
    if (!result) result = noh_stage_draw(web.stage, NOH_PASS_BLENDED, 0, NULL, &web.error);
    if (!result && is_shown()) noh_stage_hair_draw(&web.hair.drawn, web.stage, 0, NOH_PASS_BLENDED);
    return result;
}

/* ---- calls from the page ---- */

EMSCRIPTEN_KEEPALIVE int web_has_hair(void)
{
    return web.hair.heads != NULL;
}

/* shows: 0 or 1; wind: metres per second, from the right. */
EMSCRIPTEN_KEEPALIVE void web_set_hair(int shows, float wind)
{
    web.hair.off = !shows;
    web.hair.wind[0] = -wind;
    memcpy(web.cast.hair.wind, web.hair.wind, sizeof web.hair.wind);
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

/* The angle, in turns, at a remaining time of the shake: 0 at both ends. */
static double angle_at(double left_s)
{
    const double gone = SHAKE_S - left_s;
    float swing, share, cosine;
    noh_sin_cos_turn(web_turn(SHAKE_HZ * gone), &swing, &cosine);
    noh_sin_cos_turn(web_turn(0.5 * gone / SHAKE_S), &share, &cosine);
    return SHAKE_TURNS * (double)(swing * share);
}

/* Turn a place about the vertical axis, by an angle in turns. */
static void turn(noh_place *place, double angle)
{
    float s, c;
    noh_sin_cos_turn(web_turn(0.5 * angle), &s, &c);
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
