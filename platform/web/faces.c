/* faces.c: the figures' faces: blinks, breath, gaze at the pointer, emotions, and mouth shapes of speech. */
#include <emscripten.h>
#include <math.h>
#include <string.h>

#include "web.h"

#define LINKS_MAX 1024u
#define REACH 0.4f /* position of the pointer in space, as a share of the distance from the camera to a face */

static int has_face(uint32_t figure)
{
    return (int)(web.cast.faces_found >> web.figures[figure].kind & 1u);
}

static uint32_t find(const void *user, const char *name, uint32_t nth)
{
    return nth ? NOH_NONE : noh_stage_find(web.stage, *(const uint32_t *)user, NOH_NAME_FLOAT, name);
}

/* Whether a face has a target for any of these channels, by the pack's and the built-in recipes, as bound by the
 * stage. */
static int shows(uint32_t first, uint32_t count)
{
    static noh_face_link links[LINKS_MAX];
    const noh_face_recipe own = noh_face_recipe_in_pack(&web.pack);
    const noh_face_recipe *const recipes[] = { &own, &noh_face_recipe_arkit, &noh_face_recipe_vrm,
                                               &noh_face_recipe_units };
    for (uint32_t k = 0; k < web.cast.desc.kind_count; k++) {
        uint32_t bound;
        if (!(web.cast.faces_found >> k & 1u)) continue;
        bound = noh_face_recipe_bind_by(recipes, sizeof recipes / sizeof *recipes, find, &k, links, LINKS_MAX);
        for (uint32_t i = 0; i < bound && i < LINKS_MAX; i++) {
            if (links[i].channel - first < count) return 1;
        }
    }
    return 0;
}

/* 1: some figure stands without a clip. */
EMSCRIPTEN_KEEPALIVE int web_stands(void)
{
    return web.cast.stand_count != 0;
}
/* 1: some figure has an animated face. */
EMSCRIPTEN_KEEPALIVE int web_alive(void)
{
    return web.cast.faces_found != 0;
}
/* Bits of the channels with targets: 1 emotions, 2 mouth shapes of speech. */
EMSCRIPTEN_KEEPALIVE int web_face_shows(void)
{
    return shows(NOH_CHANNEL_UPPER, 2u * NOH_EMOTION_COUNT) + 2 * shows(NOH_CHANNEL_VISEMES, NOH_VISEME_COUNT);
}

EMSCRIPTEN_KEEPALIVE const char *web_emotion_name(uint32_t i) /* NULL past the last */
{
    return noh_emotion_name((noh_emotion)i);
}

/* Set an emotion in place of the previous one. */
EMSCRIPTEN_KEEPALIVE void web_feel(int emotion, float amount)
{
    for (uint32_t i = 0; i < web.figure_count; i++) {
        noh_face_pose now;
        if (!has_face(i) || noh_actor_face(web.stage, web.figures[i].actor, &now, NULL)) continue;
        for (int e = 0; e < NOH_EMOTION_COUNT; e++) {
            const float wanted = e == emotion ? amount : 0.0f;
            if (e != emotion && now.emotions[e] == 0.0f) continue;
            (void)noh_actor_set_emotion(web.stage, web.figures[i].actor, noh_emotion_name((noh_emotion)e), wanted, 0, 0,
                                        0, NULL);
        }
    }
}

/* 1: nothing moves by itself. */
EMSCRIPTEN_KEEPALIVE void web_set_calm(int calm)
{
    web.calm = calm;
    for (uint32_t i = 0; i < web.figure_count; i++) {
        if (has_face(i)) {
            (void)noh_actor_set_face_flags(web.stage, web.figures[i].actor, calm ? NOH_FACE_CALM : 0u, NULL);
        }
    }
}

/* on 1: look at a pixel of the canvas, taken as a point in space before the figure; 0: look ahead. */
EMSCRIPTEN_KEEPALIVE void web_look(float x, float y, int on)
{
    float origin[3], way[3];
    uint32_t width, height;
    noh_platform_web.size(web.context, &width, &height);
    on = on && noh_view_ray(&web.view, x, y, width, height, origin, way);
    for (uint32_t i = 0; i < web.figure_count; i++) {
        float sphere[4], point[3], square = 0.0f;
        if (!has_face(i)) continue;
        if (!on || noh_actor_sphere(web.stage, web.figures[i].actor, sphere, NULL)) {
            (void)noh_actor_look_at(web.stage, web.figures[i].actor, NULL, NULL);
            continue;
        }
        for (int k = 0; k < 3; k++) square += (sphere[k] - web.view.eye[k]) * (sphere[k] - web.view.eye[k]);
        for (int k = 0; k < 3; k++) point[k] = web.view.eye[k] + way[k] * REACH * sqrtf(square);
        (void)noh_actor_look_at(web.stage, web.figures[i].actor, point, NULL);
    }
}

void web_say(const float *visemes)
{
    for (uint32_t i = 0; i < web.figure_count; i++) {
        if (has_face(i)) (void)noh_actor_set_visemes(web.stage, web.figures[i].actor, visemes, NULL);
    }
}

/* 1: talking; 0: resting. */
EMSCRIPTEN_KEEPALIVE void web_set_talking(int talks)
{
    for (uint32_t i = 0; i < web.figure_count; i++) {
        if (has_face(i)) {
            (void)noh_actor_set_activity(web.stage, web.figures[i].actor, talks ? NOH_ACTIVITY_TALK : NOH_ACTIVITY_REST,
                                         NULL);
        }
    }
}
