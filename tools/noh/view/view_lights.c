#include "view/view_lights.h"

#include <stdio.h>
#include <string.h>

#include "cli/message.h"
#include "view/view_app.h"

const char *const view_light_names[VIEW_LIGHT_COUNT] = { "none", "studio", "room", "sky", "white" };

static int is_built_in(const char *name)
{
    int found = 0;
    for (uint32_t i = 0; i < VIEW_LIGHT_COUNT; i++) found |= strcmp(name, view_light_names[i]) == 0;
    return found;
}

void view_lights_open(view_lights *l, lighting *first)
{
    const char *name = first ? first->name : view_light_names[0];
    l->first = first;
    snprintf(l->name, sizeof l->name, "%s", is_built_in(name) ? name : "");
}

const char *view_lights_file(const view_lights *l)
{
    const char *name = l->first ? l->first->name : view_light_names[0], *slash = strrchr(name, '/');
    return is_built_in(name) ? NULL : slash ? slash + 1 : name;
}

const char *view_lights_shown(const view_lights *l)
{
    return l->name[0] ? l->name : view_lights_file(l);
}

/* As the light before it, except for its name. */
static int open_as(lighting *l, const char *name, const lighting *before)
{
    static const char *const backgrounds[] = { "plain", "gradient", "light" };
    static const char *const tonemaps[] = { "none", "filmic", "neutral" };
    light_options o = { .light = name };
    if (before) {
        o.rotate = before->degrees;
        o.background = backgrounds[before->background];
        o.tonemap = tonemaps[before->told.tonemap];
        o.shadow = before->has_shadow ? "on" : before->has_blobs ? "blob" : "off";
        o.transfer = before->without_transfer ? "off" : "on";
    }
    return lighting_open(l, &o);
}

void view_light_choose(view_app *a, const char *name)
{
    view_lights *lights = &a->lights;
    const int slot = a->desc.light == &lights->slots[0];
    lighting *chosen = lights->first;
    if (strcmp(name, "none") == 0) {
        chosen = NULL;
    } else if (name[0]) {
        if (lights->opened[slot]) lighting_close(&lights->slots[slot]);
        lights->opened[slot] = open_as(&lights->slots[slot], name, a->desc.light) == 0;
        if (!lights->opened[slot]) {
            view_tell(a);
            return;
        }
        chosen = &lights->slots[slot];
    }
    if (chosen) lighting_turn(chosen, chosen->degrees, a->camera.facing);
    snprintf(lights->name, sizeof lights->name, "%s", name);
    a->request.desc.light = chosen;
    a->request.reload = 1;
}

void view_lights_close(view_lights *l)
{
    for (int i = 0; i < 2; i++) {
        if (l->opened[i]) lighting_close(&l->slots[i]);
    }
    memset(l, 0, sizeof *l);
}
