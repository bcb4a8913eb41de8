#include "region_mask.h"

#include <stdlib.h>
#include <string.h>

#include "convert/base/image_file.h"

#define WEIGHT_STEP 0.014f /* full from a remainder of 72 on, so damage of three codes at the top does no harm */

float region_weight(uint8_t code)
{
    const uint32_t offset = code % REGION_STEP;
    const float ramp = (float)offset * WEIGHT_STEP;
    return region_is_guard(code) ? 0.0f : ramp < 1.0f ? ramp : 1.0f;
}

uint8_t region_weight_byte(uint8_t code)
{
    return (uint8_t)(region_weight(code) * 255.0f + 0.5f);
}

float region_texel_weight(const uint8_t rgba[4], const float *weights)
{
    float largest = 0.0f;
    for (uint32_t c = 0; c < 4; c++) {
        const float weight = region_weight(rgba[c]) * weights[3 * c + region_of_code(rgba[c])];
        largest = weight > largest ? weight : largest;
    }
    return largest;
}

static void decode_maps(const region_mask *mask, uint8_t *const maps[REGION_MAP_COUNT])
{
    const size_t count = (size_t)mask->width * mask->height * 4;
    for (size_t i = 0; i < count; i++) {
        maps[region_of_code(mask->rgba[i])][i] = region_weight_byte(mask->rgba[i]);
    }
}

int region_maps_make(const region_mask *mask, uint8_t *maps[REGION_MAP_COUNT])
{
    int failed = 0;
    for (uint32_t k = 0; k < REGION_MAP_COUNT; k++) {
        maps[k] = model_zeros((size_t)mask->width * mask->height, 4);
        failed |= !maps[k];
    }
    if (!failed) {
        decode_maps(mask, maps);
        return 0;
    }
    for (uint32_t k = 0; k < REGION_MAP_COUNT; k++) {
        free(maps[k]);
        maps[k] = NULL;
    }
    return 1;
}

/* 0 has one code in each channel, which means no region. */
static uint8_t code_of(uint32_t map, uint8_t weight)
{
    const uint32_t offset = weight == 255u ? REGION_LAST : (uint32_t)((float)weight / (255.0f * WEIGHT_STEP) + 0.5f);
    return (uint8_t)(offset ? map * REGION_STEP + offset : 0u);
}

int region_mask_make(uint8_t *const maps[REGION_MAP_COUNT], uint32_t width, uint32_t height, region_mask *mask)
{
    *mask = (region_mask){ width, height, model_zeros((size_t)width * height, 4) };
    for (size_t i = 0; i < (size_t)width * height * 4 && mask->rgba; i++) {
        uint32_t map = 0;
        for (uint32_t k = 1; k < REGION_MAP_COUNT; k++) map = maps[k][i] > maps[map][i] ? k : map;
        mask->rgba[i] = code_of(map, maps[map][i]);
    }
    return !mask->rgba;
}

float region_maps_weight(const uint8_t *const texels[REGION_MAP_COUNT], const float *weights)
{
    float largest = 0.0f;
    for (uint32_t i = 0; i < REGION_COUNT; i++) {
        const uint32_t map = i % 3, channel = i / 3;
        const float weight = (float)texels[map][channel] * (1.0f / 255.0f) * weights[i];
        largest = weight > largest ? weight : largest;
    }
    return largest;
}

static void clear_alpha(region_mask *mask)
{
    for (size_t i = 0; i < (size_t)mask->width * mask->height; i++) {
        mask->rgba[4 * i + 3] = 0;
    }
}

int region_mask_read(const char *path, region_mask *mask, model_error *error)
{
    image_file image;
    memset(mask, 0, sizeof *mask);
    if (image_read(path, &image, error)) {
        return 1;
    }
    if (image.bits != 8) {
        free(image.rgba);
        return model_fail(error, "", "the region mask has %u bits a channel: save it with 8", image.bits);
    }
    *mask = (region_mask){ image.width, image.height, image.rgba };
    if (image.channels == 1 || image.channels == 3) {
        clear_alpha(mask);
    }
    return 0;
}

void region_mask_free(region_mask *mask)
{
    free(mask->rgba);
    memset(mask, 0, sizeof *mask);
}
