#include "mask/mask_export.h"

#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "convert/model/recipe_make.h"
#include "convert/sources.h"
#include "convert/wrinkle/wrinkle_make.h"
#include "file/pack_file.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"

static int ends_in(const char *path, const char *const *endings, size_t count)
{
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < count; i++) {
        if (strcmp(dot, endings[i]) == 0) return 1;
    }
    return 0;
}

static int is_picture(const char *path)
{
    static const char *const endings[] = { ".png", ".PNG", ".jpg", ".jpeg" };
    return ends_in(path, endings, sizeof endings / sizeof endings[0]);
}

static int is_model(const char *path)
{
    static const char *const endings[] = { ".gltf", ".glb", ".vrm", ".fbx", ".obj" };
    return ends_in(path, endings, sizeof endings / sizeof endings[0]);
}

int mask_is_exported(const char *path)
{
    return !is_picture(path);
}

/* ---- of a model ---- */

static int of_model(const char *path, uint32_t size, region_mask *mask)
{
    const source_options reading = { .sample_rate_hz = 0.0 };
    recipe_text *recipe = recipe_new();
    const wrinkle_settings settings = { .automatic = 1, .mask_size = size, .kept = mask, .recipe = recipe };
    model_error error = { "", "" };
    source s;
    uint32_t known;
    memset(&s, 0, sizeof s);
    int failed = source_read(path, &reading, &s, &error);
    if (!failed && (!recipe || recipe_add_extras(recipe, s.m) || recipe_add_known(recipe, s.m, &known))) {
        failed = recipe_fail(recipe, &error);
    }
    failed = failed || wrinkles_make(s.m, &settings, &error);
    source_free(&s);
    recipe_free(recipe);
    return failed ? tool_fail(path, "%s", error.what) : 0;
}

/* ---- of a pack ---- */

/* The first level of a texture, to be freed. NULL: out of memory. */
static uint8_t *texels_of(const noh_texture *t)
{
    const noh_texture_level level = noh_texture_level_at(t, 0);
    const uint32_t columns = (level.width + 3u) / 4u, rows = (level.height + 3u) / 4u;
    uint8_t *rgba = malloc((size_t)16u * columns * rows * 4u);
    uint8_t *row = malloc((size_t)16u * columns * 4u);
    for (uint32_t y = 0; y < rows && rgba && row && t->header->format; y++) {
        const uint32_t bytes = noh_texture_block_bytes(t->header->format) * columns;
        noh_etc2_decode(t->header->format, level.pixels + (size_t)y * bytes, columns, row);
        for (uint32_t k = 0; k < 4u && 4u * y + k < level.height; k++) {
            memcpy(rgba + (size_t)(4u * y + k) * level.width * 4u, row + (size_t)k * columns * 16u, level.width * 4u);
        }
    }
    if (rgba && row && !t->header->format) memcpy(rgba, level.pixels, level.bytes);
    if (!row) {
        free(rgba);
        rgba = NULL;
    }
    free(row);
    return rgba;
}

static int of_material(const char *path, const noh_pack *pack, const noh_material *m, region_mask *mask)
{
    const int is_mask = (m->flags & NOH_MATERIAL_WRINKLE_CODES) != 0;
    uint8_t *maps[REGION_MAP_COUNT] = { NULL };
    noh_texture t;
    int failed = 0;
    for (uint32_t k = 0; k < (is_mask ? 1u : REGION_MAP_COUNT) && !failed; k++) {
        (void)noh_pack_texture_at(pack, m->more_textures[k], &t, NULL);
        if (t.header->trim) {
            return tool_fail(
                path, "its textures were trimmed, so a painted mask would not fit the model: build the pack with "
                      "--whole-textures, or give the model itself");
        }
        if (t.header->format >= NOH_TEXTURE_ASTC_4X4) {
            return tool_fail(path, "its textures are ASTC, which cannot be read here: build the pack with --textures "
                                   "etc2, or give the model itself");
        }
        maps[k] = texels_of(&t);
        failed = !maps[k];
    }
    if (!failed && is_mask) {
        *mask = (region_mask){ t.header->width, t.header->height, maps[0] };
        maps[0] = NULL;
    } else if (!failed) {
        failed = region_mask_make(maps, t.header->width, t.header->height, mask);
    }
    for (uint32_t k = 0; k < REGION_MAP_COUNT; k++) free(maps[k]);
    return failed ? tool_fail(path, "out of memory") : 0;
}

static int of_pack(const char *path, region_mask *mask)
{
    pack_file file;
    int status = pack_file_open(&file, path);
    if (status) return status;
    const noh_material *found = NULL;
    for (uint32_t i = 0; i < file.pack.material_count && !found; i++) {
        const noh_material *m = &file.pack.materials[i];
        const int all = m->flags & NOH_MATERIAL_WRINKLE_CODES ||
                        (m->more_textures[1] != NOH_NONE && m->more_textures[2] != NOH_NONE);
        if (m->more_textures[0] != NOH_NONE && all) found = m;
    }
    status = found ? of_material(path, &file.pack, found, mask)
                   : tool_fail(path, "it has no wrinkle regions: build it with --wrinkles auto or --region-mask");
    pack_file_close(&file);
    return status;
}

int mask_export(const char *path, uint32_t size, region_mask *mask)
{
    memset(mask, 0, sizeof *mask);
    return is_model(path) ? of_model(path, size, mask) : of_pack(path, mask);
}
