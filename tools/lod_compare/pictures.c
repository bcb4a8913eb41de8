/* pictures.c: the levels side by side, at the sizes at which they are used. */
#include <stb/stb_image_write.h>
#include <stdlib.h>
#include <string.h>

#include "compare.h"

#define SAMPLES 3u /* a pixel is the mean of 3 x 3 */
#define LEAST_PIXEL 0.0006f
#define GAP 4u

static void no_weights(const model_mesh *mesh, float *weights)
{
    memset(weights, 0, mesh->target_count * sizeof *weights);
}

static void face_weights(const model_mesh *mesh, uint32_t face, float *weights)
{
    no_weights(mesh, weights);
    if (face == 1u) {
        shapes_eyes_shut(mesh, weights);
    } else if (face == 2u) {
        shapes_mouth_open(mesh, weights);
    }
}

/* The head around the eyes, or the whole mesh if it has none. */
static void picture_box(const model *m, const model_mesh *mesh, float *box)
{
    uint32_t eyes = find_submesh(m, mesh, "eyes");
    box_of(mesh, eyes == MODEL_NONE ? 0u : eyes, mesh->position, eyes == MODEL_NONE ? 0.0f : 0.055f, box);
    box[1] -= eyes == MODEL_NONE ? 0.0f : 0.07f;
    box[3] += eyes == MODEL_NONE ? 0.0f : 0.07f;
}

static uint32_t pixels(float length, float pixel)
{
    return (uint32_t)(length / pixel) + GAP;
}

static void put(const model *m, const model_mesh *mesh, const lod_level *level, uint32_t face, float pixel,
                uint8_t *sheet, uint32_t width, uint32_t x, uint32_t y)
{
    float *weights = compare_zeros(mesh->target_count, sizeof *weights), box[4];
    float *position = compare_zeros((size_t)mesh->vertex_count * 3u, sizeof *position);
    float *normal = compare_zeros((size_t)mesh->vertex_count * 3u, sizeof *normal);
    canvas c;
    face_weights(mesh, face, weights);
    shapes_mixed(mesh, weights, position, normal);
    picture_box(m, mesh, box);
    c = canvas_new(box[0], box[1], box[2], box[3], pixel / (float)SAMPLES);
    canvas_draw(&c, m, mesh, level, position, normal);
    canvas_paste(&c, SAMPLES, sheet, width, x, y);
    canvas_free(&c);
    free(normal);
    free(position);
    free(weights);
}

int pictures_write(const model *m, const model_mesh *mesh, const lod *ours, const lod *peer, const float *pixel_mm,
                   const char *path)
{
    float box[4], pixel[LOD_LEVELS_MAX];
    uint32_t width = 0, height, x = 0;
    uint8_t *sheet;
    int written;
    picture_box(m, mesh, box);
    for (uint32_t i = 0; i < ours->level_count; i++) {
        pixel[i] = pixel_mm[i] * 0.001f > LEAST_PIXEL ? pixel_mm[i] * 0.001f : LEAST_PIXEL;
        width += pixels(box[2] - box[0], pixel[i]) * 3u;
    }
    height = pixels(box[3] - box[1], LEAST_PIXEL);
    sheet = compare_zeros((size_t)width * height * 2u, 3);
    for (uint32_t i = 0; i < ours->level_count; i++) {
        for (uint32_t face = 0; face < 3u; face++) {
            put(m, mesh, &ours->levels[i], face, pixel[i], sheet, width, x, 0);
            put(m, mesh, &peer->levels[i], face, pixel[i], sheet, width, x, height);
            x += pixels(box[2] - box[0], pixel[i]);
        }
    }
    written = stbi_write_png(path, (int)width, (int)(height * 2u), 3, sheet, (int)(width * 3u));
    free(sheet);
    return written;
}
