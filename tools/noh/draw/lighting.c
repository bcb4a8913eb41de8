#include "lighting.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "file/light_file.h"

#define PI 3.14159265358979323846

/* Skin shows its depth by a window, toons need a low sun, because the edge of a high lamp's shade crosses their faces;
 * everything else is in soft boxes. */
static const char *light_of(const noh_pack *pack)
{
    const char *light = "studio";
    for (uint32_t i = 0; pack && i < pack->material_count; i++) {
        if (pack->materials[i].surface == NOH_SURFACE_SKIN) return "room";
        if (pack->materials[i].surface == NOH_SURFACE_TOON) light = "sky";
    }
    return light;
}

int lighting_wanted(light_options *o, const noh_pack *pack, int shows_surfaces)
{
    if (o->light && strcmp(o->light, "auto") == 0) {
        o->light = shows_surfaces ? light_of(pack) : NULL;
    }
    return o->light && strcmp(o->light, "none") != 0;
}

/* One of two words; NULL: the first. */
static int choose(const char *option, const char *text, const char *const words[], int count, int *chosen)
{
    *chosen = 0;
    for (int i = 0; text && i < count; i++) {
        if (strcmp(text, words[i]) == 0) {
            *chosen = i;
            return 0;
        }
    }
    if (!text) {
        return 0;
    }
    return count == 3 ? tool_usage("%s must be %s, %s or %s, not '%s'", option, words[0], words[1], words[2], text)
                      : tool_usage("%s must be %s or %s, not '%s'", option, words[0], words[1], text);
}

static int bake(lighting *l, noh_radiance radiance, const void *user)
{
    const noh_reflection_desc desc = { 0, radiance, user };
    const size_t bytes = noh_reflection_size(0), scratch_bytes = noh_reflection_scratch_size(0);
    void *scratch = malloc(scratch_bytes);
    noh_error error = { NOH_ERR_MEMORY, "out of memory", 0, 0 };
    l->texels = malloc(bytes);
    if (!l->texels || !scratch ||
        noh_reflection_init(l->texels, bytes, scratch, scratch_bytes, &desc, &l->reflection, &error)) {
        free(scratch);
        return tool_fail_error("light", &error);
    }
    free(scratch);
    return 0;
}

static int read_light(lighting *l, const char *name)
{
    const uint32_t index = noh_environment_find(name);
    light_file file;
    int status;
    if (index != NOH_NONE) {
        noh_light_from_environment(noh_environment_at(index), NOH_SH_ORDER_MAX, &l->light);
        return bake(l, noh_reflection_of_environment, noh_environment_at(index));
    }
    if (!strchr(name, '.') && !strchr(name, '/')) {
        return tool_usage("--light must be auto, none, white, studio, room, sky or a file (.hdr, .png), not '%s'",
                          name);
    }
    status = light_file_open(&file, name);
    if (!status) {
        light_file_project(&file, NOH_SH_ORDER_MAX, &l->light);
        status = bake(l, light_file_radiance, &file);
        light_file_close(&file);
    }
    return status;
}

int lighting_open(lighting *l, const light_options *o)
{
    static const char *const tonemaps[] = { "neutral", "filmic", "none" }, *const switches[] = { "on", "off", "blob" };
    static const char *const backgrounds[] = { "light", "gradient", "plain" };
    int tonemap, shadow, transfer, background;
    int status;
    memset(l, 0, sizeof *l);
    l->name = o->light;
    status = choose("--tonemap", o->tonemap, tonemaps, 3, &tonemap);
    if (!status) status = choose("--shadow", o->shadow, switches, 3, &shadow);
    if (!status) status = choose("--transfer", o->transfer, switches, 2, &transfer);
    if (!status) status = choose("--background", o->background, backgrounds, 3, &background);
    if (!status) status = read_light(l, o->light);
    if (status) {
        lighting_close(l);
        return status;
    }
    l->has_shadow = shadow == 0;
    l->has_blobs = shadow == 2;
    l->without_transfer = transfer;
    l->background = background == 0 ? BACKGROUND_LIGHT : background == 1 ? BACKGROUND_GRADIENT : BACKGROUND_PLAIN;
    l->told.tonemap = tonemap == 0 ? NOH_TONEMAP_NEUTRAL : tonemap == 1 ? NOH_TONEMAP_FILMIC : NOH_TONEMAP_NONE;
    l->desc.reflection = &l->reflection;
    l->desc.shadow_px = l->has_shadow ? LIGHTING_SHADOW_PX : 0;
    lighting_turn(l, o->rotate, o->facing);
    return 0;
}

void lighting_close(lighting *l)
{
    free(l->texels);
    memset(l, 0, sizeof *l);
}

static void rotate(double degrees, float rotation[9])
{
    const float s = (float)sin(degrees * PI / 180.0), c = (float)cos(degrees * PI / 180.0);
    const float turn[9] = { c, 0.0f, s, 0.0f, 1.0f, 0.0f, -s, 0.0f, c };
    memcpy(rotation, turn, sizeof turn);
}

void lighting_turn(lighting *l, double degrees, double facing)
{
    float rotation[9];
    const noh_tonemap tonemap = l->told.tonemap;
    l->degrees = degrees;
    rotate(degrees + facing, rotation);
    noh_lighting_make(&l->light, rotation, l->has_shadow, &l->told);
    l->told.tonemap = tonemap;
    rotate(degrees, rotation);
    l->told.exposure = noh_light_exposure(&l->light, rotation);
}

noh_stage_view lighting_shadow_view(lighting *l, const bounds *box)
{
    noh_stage_view view;
    float *sphere = l->sphere;
    double square = 0.0;
    for (int i = 0; i < 3; i++) {
        const double half = 0.5 * (box->high[i] - box->low[i]);
        sphere[i] = (float)(0.5 * (box->high[i] + box->low[i]));
        square += half * half;
    }
    sphere[3] = (float)fmax(1.02 * sqrt(square), 1e-6);
    noh_view_shadow(&view, sphere, l->told.key_direction);
    noh_lighting_shadow(&l->told, view.view_projection, sphere[3], l->desc.shadow_px);
    return view;
}
