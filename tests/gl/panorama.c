/* panorama LIGHT FOLDER: a built-in light for other renderers: FOLDER/LIGHT.hdr, all of it, FOLDER/LIGHT_rest.hdr,
 * without its brightest lamp or window, and on stdout that one as JSON: the direction towards it, and the irradiance of
 * a surface that faces it. Panoramas are equirectangular, the top row up, the middle +X and a quarter to the right +Z, as three.js reads
 * them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/light.h"

#define WIDTH 1024u
#define HEIGHT 512u
#define PI 3.14159265358979323846
#define SAMPLES 2u /* along each side of a texel */

static float luminance(const float rgb[3])
{
    return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}

/* The environment without its brightest part. Its direction: zeros where there is none. */
static noh_environment dim_key(noh_environment e, float direction[3])
{
    float most = 0.0f, *key = NULL;
    for (uint32_t i = 0; i < e.lamp_count; i++) {
        if (luminance(e.lamps[i].color) > most) {
            key = e.lamps[i].color;
            most = luminance(key);
            memcpy(direction, e.lamps[i].direction, 3 * sizeof *direction);
        }
    }
    for (uint32_t i = 0; i < e.window_count; i++) {
        if (luminance(e.windows[i].color) > most) {
            key = e.windows[i].color;
            most = luminance(key);
            memcpy(direction, e.windows[i].direction, 3 * sizeof *direction);
        }
    }
    if (key) memset(key, 0, 3 * sizeof *key);
    return e;
}

/* Adds what comes from a texel to the irradiance of a surface that faces `towards`, and gives the texel's mean. */
static void sample(const noh_environment *e, uint32_t x, uint32_t y, const float towards[3], double irradiance[3],
                   float mean[3])
{
    memset(mean, 0, 3 * sizeof *mean);
    for (uint32_t k = 0; k < SAMPLES * SAMPLES; k++) {
        const double u = (x + (k % SAMPLES + 0.5) / SAMPLES) / WIDTH, v = (y + (k / SAMPLES + 0.5) / SAMPLES) / HEIGHT;
        const double up = 0.5 * PI - PI * v, around = 2.0 * PI * (u - 0.5);
        const float d[3] = { (float)(cos(up) * cos(around)), (float)sin(up), (float)(cos(up) * sin(around)) };
        const double facing = (double)(d[0] * towards[0] + d[1] * towards[1] + d[2] * towards[2]);
        const double angle = fmax(facing, 0.0) * cos(up) * 2.0 * PI * PI / (WIDTH * HEIGHT * SAMPLES * SAMPLES);
        float rgb[3];
        noh_reflection_of_environment(e, d, rgb);
        for (int c = 0; c < 3; c++) {
            mean[c] += rgb[c] / (SAMPLES * SAMPLES);
            irradiance[c] += (double)rgb[c] * angle;
        }
    }
}

/* Radiance's RGBE, without runs. 0 on success. */
static int write_panorama(const char *folder, const char *name, const char *suffix, const noh_environment *e,
                          const float towards[3], double irradiance[3])
{
    char path[1024];
    FILE *file;
    snprintf(path, sizeof path, "%s/%s%s.hdr", folder, name, suffix);
    file = fopen(path, "wb");
    if (!file) return 1;
    fprintf(file, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %u +X %u\n", HEIGHT, WIDTH);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        unsigned char texel[4] = { 0, 0, 0, 0 };
        float rgb[3];
        int exponent;
        sample(e, i % WIDTH, i / WIDTH, towards, irradiance, rgb);
        const float most = fmaxf(fmaxf(rgb[0], rgb[1]), fmaxf(rgb[2], 1e-30f));
        (void)frexpf(most, &exponent);
        for (int c = 0; c < 3; c++) texel[c] = (unsigned char)fmaxf(ldexpf(rgb[c], 8 - exponent), 0.0f);
        texel[3] = (unsigned char)(exponent + 128);
        fwrite(texel, 1, 4, file);
    }
    return fclose(file);
}

int main(int argument_count, char **arguments)
{
    const uint32_t index = argument_count == 3 ? noh_environment_find(arguments[1]) : NOH_NONE;
    double all[3] = { 0 }, rest[3] = { 0 };
    float towards[3] = { 0 };
    if (index == NOH_NONE) return 2;
    const noh_environment *whole = noh_environment_at(index);
    const noh_environment without = dim_key(*whole, towards);
    if (write_panorama(arguments[2], arguments[1], "", whole, towards, all)) return 1;
    if (write_panorama(arguments[2], arguments[1], "_rest", &without, towards, rest)) return 1;
    printf("{ \"direction\": [%.6f, %.6f, %.6f], \"irradiance\": [%.6f, %.6f, %.6f] }\n", (double)towards[0],
           (double)towards[1], (double)towards[2], all[0] - rest[0], all[1] - rest[1], all[2] - rest[2]);
    return 0;
}
