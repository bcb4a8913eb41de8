/* picture.h: reads a file, and draws a character without a GPU for the examples: triangles with a depth buffer, saved
 * as .ppm. It keeps the examples short; it is not part of the library. */
#ifndef NOH_EXAMPLES_PICTURE_H
#define NOH_EXAMPLES_PICTURE_H

#include <stdio.h>

#define ALIGNED_16 __attribute__((aligned(16))) /* required of every block for noh */

#define PICTURE_WIDTH 480
#define PICTURE_HEIGHT 540

typedef struct picture {
    float centre[3], height; /* the view along -z: a centre, and the height of the view around it */
    float corners[3][3], colors[3][3];
    float depth[PICTURE_HEIGHT][PICTURE_WIDTH];
    unsigned char rgb[PICTURE_HEIGHT][PICTURE_WIDTH][3];
} picture;

static const float picture_white[4] = { 1.0f, 1.0f, 1.0f, 1.0f };

/* Read a file; returns its size, 0 if it cannot be read or is too large. */
static size_t picture_read(const char *path, void *bytes, size_t bytes_max)
{
    FILE *in = fopen(path, "rb");
    size_t count = in ? fread(bytes, 1, bytes_max, in) : 0;
    if (!in) fprintf(stderr, "%s: cannot open\n", path);
    if (in && (fgetc(in) != EOF || fclose(in) != 0)) count = 0;
    return count;
}

static void picture_clear(picture *p, const float centre[3], float height)
{
    p->height = height;
    for (int i = 0; i < 3; i++) p->centre[i] = centre[i];
    for (int y = 0; y < PICTURE_HEIGHT; y++) {
        for (int x = 0; x < PICTURE_WIDTH; x++) {
            p->depth[y][x] = -1e30f;
            p->rgb[y][x][0] = p->rgb[y][x][1] = p->rgb[y][x][2] = 40;
        }
    }
}

static int picture_bound(float value, int limit)
{
    return value < 0.0f ? 0 : value > (float)limit ? limit : (int)value;
}

/* Linear light as a byte, by its square root, which is close to sRGB's curve: four steps of Newton's method. */
static unsigned char picture_encode(float light)
{
    float root = 0.5f + 0.5f * light;
    for (int i = 0; i < 4; i++) root = 0.5f * (root + light / root);
    return (unsigned char)picture_bound(255.0f * root + 0.5f, 255);
}

/* Twice the signed area of a, b and (x, y). */
static float picture_edge(const float a[3], const float b[3], float x, float y)
{
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

static void picture_pixel(picture *p, int x, int y, float area)
{
    float(*v)[3] = p->corners;
    const float px = (float)x + 0.5f, py = (float)y + 0.5f;
    const float b0 = picture_edge(v[1], v[2], px, py) / area, b1 = picture_edge(v[2], v[0], px, py) / area;
    const float b2 = 1.0f - b0 - b1, z = b0 * v[0][2] + b1 * v[1][2] + b2 * v[2][2];
    if (b0 < 0.0f || b1 < 0.0f || b2 < 0.0f || z <= p->depth[y][x]) return;
    p->depth[y][x] = z;
    for (int c = 0; c < 3; c++) {
        p->rgb[y][x][c] = picture_encode(b0 * p->colors[0][c] + b1 * p->colors[1][c] + b2 * p->colors[2][c]);
    }
}

static void picture_triangle(picture *p)
{
    float(*v)[3] = p->corners;
    const float area = picture_edge(v[0], v[1], v[2][0], v[2][1]);
    int x0 = PICTURE_WIDTH, y0 = PICTURE_HEIGHT, x1 = 0, y1 = 0;
    for (int i = 0; i < 3; i++) {
        const int x = picture_bound(v[i][0], PICTURE_WIDTH - 1), y = picture_bound(v[i][1], PICTURE_HEIGHT - 1);
        x0 = x < x0 ? x : x0, x1 = x > x1 ? x : x1;
        y0 = y < y0 ? y : y0, y1 = y > y1 ? y : y1;
    }
    for (int y = y0; y <= y1 && area != 0.0f; y++) {
        for (int x = x0; x <= x1; x++) picture_pixel(p, x, y, area);
    }
}

/* Set the k-th corner of a triangle, lit from the upper left; the third corner draws the triangle, from both sides. */
static void picture_corner(picture *p, unsigned k, const float at[3], const float normal[3], const float *color,
                           const float *tint)
{
    const float scale = (float)PICTURE_HEIGHT / p->height;
    const float facing = -0.4f * normal[0] + 0.4f * normal[1] + 0.82f * normal[2];
    const float light = 0.2f + 0.8f * (facing > 0.0f ? facing : 0.0f);
    p->corners[k][0] = 0.5f * (float)PICTURE_WIDTH + (at[0] - p->centre[0]) * scale;
    p->corners[k][1] = 0.5f * (float)PICTURE_HEIGHT - (at[1] - p->centre[1]) * scale;
    p->corners[k][2] = (at[2] - p->centre[2]) * scale;
    for (int c = 0; c < 3; c++) p->colors[k][c] = light * color[c] * tint[c];
    if (k == 2) picture_triangle(p);
}

static int picture_save(const picture *p, const char *path)
{
    FILE *out = fopen(path, "wb");
    size_t written = 0;
    if (out) {
        fprintf(out, "P6\n%d %d\n255\n", PICTURE_WIDTH, PICTURE_HEIGHT);
        written = fwrite(p->rgb, sizeof p->rgb, 1, out);
        if (fclose(out) != 0) written = 0;
    }
    if (!written) fprintf(stderr, "%s: cannot write\n", path);
    return written ? 0 : 1;
}

#endif
