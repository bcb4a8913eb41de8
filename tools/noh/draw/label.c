/* label.c: labels in pictures, from stb_easy_font's quads. */
#include <string.h>

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#endif
#include <stb/stb_easy_font.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#include "label.h"

typedef struct font_vertex {
    float x, y, z;
    uint8_t color[4];
} font_vertex;

static void fill(uint8_t *rgba, uint32_t width, uint32_t height, int x0, int y0, int x1, int y1, uint8_t value)
{
    for (int y = y0 < 0 ? 0 : y0; y < y1 && y < (int)height; y++) {
        for (int x = x0 < 0 ? 0 : x0; x < x1 && x < (int)width; x++) {
            memset(rgba + 4 * ((size_t)y * width + (size_t)x), value, 3);
        }
    }
}

void draw_text(uint8_t *rgba, uint32_t width, uint32_t height, int x, int y, int scale, const char *text)
{
    static font_vertex vertices[16384];
    char copy[256];
    int quads;
    strncpy(copy, text, sizeof copy - 1);
    copy[sizeof copy - 1] = 0;
    for (char *c = copy; *c; c++) {
        *c = (unsigned char)*c > 126 ? '?' : *c; /* the font has ASCII only */
    }
    quads = stb_easy_font_print(0.0f, 0.0f, copy, NULL, vertices, sizeof vertices);
    fill(rgba, width, height, x - 2, y - 2, x + scale * stb_easy_font_width(copy) + 2, y + scale * 10, 20);
    for (int q = 0; q < quads; q++) {
        const font_vertex *a = &vertices[4 * q], *b = &vertices[4 * q + 2];
        fill(rgba, width, height, x + scale * (int)a->x, y + scale * (int)a->y, x + scale * (int)b->x,
             y + scale * (int)b->y, 235);
    }
}
