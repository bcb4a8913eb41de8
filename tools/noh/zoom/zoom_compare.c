/* zoom_compare.c: how far two pictures of a zoom differ. */
#include <math.h>
#include <stdlib.h>

#include "zoom.h"
#include "gpu/canvas.h"

#define PATCH 1024u /* pixels: about one degree of view, the extent of sharp vision */

static int covered(const zoom_picture *p, int x, int y)
{
    const int size = (int)p->size;
    return x >= 0 && y >= 0 && x < size && y < size && p->rgba[4 * ((size_t)y * p->size + (size_t)x) + 3];
}

/* ---- silhouettes ---- */

/* The least squared distance below `best` to a pixel of that kind on the border of a square. */
static int nearest_on_ring(const zoom_picture *p, int x, int y, int kind, int ring, int best)
{
    for (int d = -ring; d <= ring; d++) {
        const int squared = d * d + ring * ring;
        const int hit = covered(p, x + d, y - ring) == kind || covered(p, x + d, y + ring) == kind ||
                        covered(p, x - ring, y + d) == kind || covered(p, x + ring, y + d) == kind;
        best = hit && squared < best ? squared : best;
    }
    return best;
}

static double nearest(const zoom_picture *p, int x, int y, int kind)
{
    int best = ZOOM_FAR * ZOOM_FAR;
    for (int ring = 1; ring * ring < best; ring++) {
        best = nearest_on_ring(p, x, y, kind, ring, best);
    }
    return sqrt(best);
}

zoom_shift zoom_compare_silhouettes(const zoom_picture *a, const zoom_picture *b)
{
    zoom_shift shift = { 0.0, 0.0 };
    for (size_t i = 0; i < (size_t)a->size * a->size; i++) {
        const int in_a = a->rgba[4 * i + 3] != 0, in_b = b->rgba[4 * i + 3] != 0;
        if (in_a != in_b) {
            const int x = (int)(i % a->size), y = (int)(i / a->size);
            shift.covered = fmax(shift.covered, nearest(in_a ? b : a, x, y, 1));
            shift.uncovered = fmax(shift.uncovered, nearest(in_a ? a : b, x, y, 0));
        }
    }
    return shift;
}

/* ---- colours ---- */

/* A pixel, addressed in a larger picture with the same centre. */
static const uint8_t *pixel(const zoom_picture *p, uint32_t size, uint32_t x, uint32_t y)
{
    static const uint8_t nothing[4] = { CANVAS_BACKGROUND_SRGB, 0 };
    const uint32_t border = (size - p->size) / 2u, left = x - border, low = y - border; /* below 0: very large */
    return left < p->size && low < p->size ? p->rgba + 4 * ((size_t)low * p->size + left) : nothing;
}

double zoom_compare_colors(const zoom_picture *a, const zoom_picture *b)
{
    const uint32_t size = a->size > b->size ? a->size : b->size;
    uint64_t sum = 0, pixels = 0;
    for (uint32_t y = 0; y < size; y++) {
        for (uint32_t x = 0; x < size; x++) {
            const uint8_t *p = pixel(a, size, x, y), *q = pixel(b, size, x, y);
            if (p[3] || q[3]) {
                sum += (uint64_t)(abs(p[0] - q[0]) + abs(p[1] - q[1]) + abs(p[2] - q[2]));
                pixels++;
            }
        }
    }
    return (double)sum / (3.0 * (double)(pixels > PATCH ? pixels : PATCH));
}
