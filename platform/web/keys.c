/* keys.c: the callback keys passed in the last step. */
#include <emscripten.h>

#include "web.h"

static const noh_stage_event *key(uint32_t i)
{
    uint32_t count;
    const noh_stage_event *keys = noh_stage_events(web.stage, &count);
    return i < count ? &keys[i] : NULL;
}

EMSCRIPTEN_KEEPALIVE uint32_t web_key_count(void)
{
    uint32_t count = 0;
    (void)noh_stage_events(web.stage, &count);
    return count;
}
EMSCRIPTEN_KEEPALIVE const char *web_key_name(uint32_t i)
{
    return key(i)->name;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_key_layer(uint32_t i)
{
    return key(i)->layer;
}
/* The weight of the key's track. */
EMSCRIPTEN_KEEPALIVE float web_key_weight(uint32_t i)
{
    return key(i)->weight;
}
/* The figure of a key: its character and skeleton. */
static const web_figure *figure_of(uint32_t i)
{
    for (uint32_t f = 0; f < web.figure_count; f++) {
        if (web.figures[f].actor.id == key(i)->actor.id) return &web.figures[f];
    }
    return &web.figures[0];
}
EMSCRIPTEN_KEEPALIVE uint32_t web_key_character(uint32_t i)
{
    return figure_of(i)->character;
}
EMSCRIPTEN_KEEPALIVE const char *web_key_clip(uint32_t i)
{
    return noh_stage_name(web.stage, figure_of(i)->kind, NOH_NAME_CLIP, key(i)->clip);
}
