#include "light_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <stb/stb_image.h>

#include "cli/message.h"
#include "convert/base/image_file.h"
#include "convert/base/input_file.h"
#include "noh/low_gl.h"

#define PI 3.14159265358979323846
#define WIDTH_MAX 1024u /* wider ones are averaged: a texel of a reflection sees 4 of them in a row */
#define PIXELS_MAX ((uint64_t)64u << 20)

/* ---- reading ---- */

static int is_radiance(const char *bytes, size_t count)
{
    return count > 10 && (memcmp(bytes, "#?RADIANCE", 10) == 0 || memcmp(bytes, "#?RGBE", 6) == 0);
}

static int decode_radiance(light_file *file, const char *path, const char *bytes, size_t count)
{
    const stbi_uc *data = (const stbi_uc *)bytes;
    int width = 0, height = 0, channels = 0;
    if (count > 0x7fffffffu || !stbi_info_from_memory(data, (int)count, &width, &height, &channels) || width < 1 ||
        height < 1) {
        return tool_fail(path, "the Radiance picture is damaged");
    }
    if ((uint64_t)width * (uint64_t)height > PIXELS_MAX) {
        return tool_fail(path, "the picture has %d x %d pixels; the limit is %llu", width, height,
                         (unsigned long long)PIXELS_MAX);
    }
    file->rgb = stbi_loadf_from_memory(data, (int)count, &width, &height, &channels, 3);
    file->width = (uint32_t)width;
    file->height = (uint32_t)height;
    return file->rgb ? 0 : tool_fail(path, "the Radiance picture is damaged, or there is not enough memory");
}

static float linear_of(uint8_t byte)
{
    const double c = byte / 255.0;
    return (float)(c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4));
}

static int decode_picture(light_file *file, const char *path)
{
    model_error error;
    image_file image;
    if (image_read(path, &image, &error)) {
        return tool_fail(path, "neither a Radiance file nor another picture that is read: %s", error.what);
    }
    file->width = image.width;
    file->height = image.height;
    file->rgb = malloc((size_t)image.width * image.height * 3 * sizeof *file->rgb);
    for (size_t i = 0; file->rgb && i < (size_t)image.width * image.height * 3; i++) {
        file->rgb[i] = linear_of(image.rgba[i / 3 * 4 + i % 3]);
    }
    free(image.rgba);
    return file->rgb ? 0 : tool_fail(path, "out of memory");
}

/* Average blocks of texels, so that small lamps are not passed over. */
static void shrink(light_file *file)
{
    const uint32_t by = (file->width + WIDTH_MAX - 1u) / WIDTH_MAX;
    const uint32_t width = file->width / by, height = file->height / by;
    if (by < 2u || !height) {
        return;
    }
    for (size_t i = 0; i < (size_t)width * height; i++) {
        double sum[3] = { 0.0, 0.0, 0.0 };
        for (uint32_t k = 0; k < by * by; k++) {
            const size_t x = i % width * by + k % by, y = i / width * by + k / by;
            for (int c = 0; c < 3; c++) sum[c] += (double)file->rgb[3 * (y * file->width + x) + (size_t)c];
        }
        for (int c = 0; c < 3; c++) file->rgb[3 * i + (size_t)c] = (float)(sum[c] / (by * by)); /* read already */
    }
    file->width = width;
    file->height = height;
}

int light_file_open(light_file *file, const char *path)
{
    model_error error;
    size_t count = 0;
    char *bytes;
    int status;
    memset(file, 0, sizeof *file);
    bytes = input_read(path, &count, &error);
    if (!bytes) {
        return tool_fail(path, "%s", error.what);
    }
    status = is_radiance(bytes, count) ? decode_radiance(file, path, bytes, count) : decode_picture(file, path);
    free(bytes);
    for (size_t i = 0; !status && i < (size_t)file->width * file->height * 3; i++) {
        if (!(file->rgb[i] >= 0.0f) || !(file->rgb[i] <= 65408.0f)) {
            file->rgb[i] = file->rgb[i] > 0.0f ? 65408.0f : 0.0f;
        }
    }
    if (!status) shrink(file);
    return status;
}

void light_file_close(light_file *file)
{
    free(file->rgb);
    memset(file, 0, sizeof *file);
}

/* ---- light ---- */

static const float *texel(const light_file *file, int64_t x, int64_t y)
{
    const int64_t width = file->width, height = file->height;
    x = ((x % width) + width) % width;
    y = y < 0 ? 0 : y >= height ? height - 1 : y;
    return file->rgb + 3 * (y * width + x);
}

void light_file_radiance(const void *user, const float direction[3], float rgb[3])
{
    const light_file *file = user;
    const double azimuth = atan2((double)direction[0], -(double)direction[2]);
    const double height = acos(fmax(-1.0, fmin(1.0, (double)direction[1])));
    const double x = (azimuth / (2.0 * PI) + 0.5) * file->width - 0.5, y = height / PI * file->height - 0.5;
    const int64_t left = (int64_t)floor(x), top = (int64_t)floor(y);
    const double u = x - (double)left, v = y - (double)top;
    for (int c = 0; c < 3; c++) {
        const double above = texel(file, left, top)[c] * (1.0 - u) + texel(file, left + 1, top)[c] * u;
        const double below = texel(file, left, top + 1)[c] * (1.0 - u) + texel(file, left + 1, top + 1)[c] * u;
        rgb[c] = (float)(above * (1.0 - v) + below * v);
    }
}

void light_file_project(const light_file *file, uint32_t order, noh_light *light)
{
    memset(light, 0, sizeof *light);
    light->order = order;
    for (uint32_t y = 0; y < file->height; y++) {
        const double top = cos(PI * y / file->height), bottom = cos(PI * (y + 1.0) / file->height);
        const double z = 0.5 * (top + bottom), across = sqrt(1.0 - z * z);
        const double solid = 2.0 * PI * (top - bottom) / file->width;
        for (uint32_t x = 0; x < file->width; x++) {
            const double azimuth = 2.0 * PI * ((x + 0.5) / file->width - 0.5);
            const float d[3] = { (float)(across * sin(azimuth)), (float)z, (float)(-across * cos(azimuth)) };
            const float *rgb = file->rgb + 3 * ((size_t)y * file->width + x);
            float basis[NOH_SH_COUNT_MAX];
            noh_sh_basis(order, d, basis);
            for (uint32_t k = 0; k < 3u * NOH_SH_COUNT(order); k++) {
                light->coefs[k / 3u][k % 3u] += (float)(solid * (double)(rgb[k % 3u] * basis[k / 3u]));
            }
        }
    }
}
