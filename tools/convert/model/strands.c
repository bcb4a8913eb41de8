#include "strands.h"

#include <math.h>

#include "noh/format.h"

#define CONTRAST_MIN 0.1 /* of the squared changes along and across strands: the difference as a share of the sum */

static double shade_at(const model_texture *t, uint32_t x, uint32_t y)
{
    const uint8_t *p = t->rgba + 4 * ((size_t)y * t->width + x);
    return p[3] * (64.0 + 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]);
}

/* The structure tensor of a picture: xx, xy and yy of its changes. */
static void changes_of(const model_texture *t, double sums[3])
{
    sums[0] = sums[1] = sums[2] = 0.0;
    for (uint32_t y = 1; y + 1u < t->height; y++) {
        for (uint32_t x = 1; x + 1u < t->width; x++) {
            const double dx = shade_at(t, x + 1u, y) - shade_at(t, x - 1u, y);
            const double dy = shade_at(t, x, y + 1u) - shade_at(t, x, y - 1u);
            sums[0] += dx * dx;
            sums[1] += dx * dy;
            sums[2] += dy * dy;
        }
    }
}

/* Along the least change, in texture coordinates. 0: there is no such direction. */
static int direction_of(const model_texture *t, double out[2])
{
    double s[3], apart, angle, length;
    changes_of(t, s);
    apart = sqrt((s[0] - s[2]) * (s[0] - s[2]) + 4.0 * s[1] * s[1]);
    if (!(apart > CONTRAST_MIN * (s[0] + s[2]))) return 0;
    angle = 0.5 * atan2(2.0 * s[1], s[0] - s[2]); /* of the most */
    out[0] = -sin(angle) / t->width;
    out[1] = cos(angle) / t->height;
    length = sqrt(out[0] * out[0] + out[1] * out[1]);
    if (fabs(out[1]) >= fabs(out[0]) ? out[1] < 0.0 : out[0] < 0.0) length = -length;
    out[0] /= length;
    out[1] /= length;
    return 1;
}

void strands_find(model *m, FILE *report)
{
    for (uint32_t i = 0; i < m->material_count; i++) {
        model_material *hair = &m->materials[i];
        double along[2] = { 0.0, 1.0 };
        if (hair->surface != NOH_SURFACE_HAIR) continue;
        if (hair->base_color_texture != MODEL_NONE) (void)direction_of(&m->textures[hair->base_color_texture], along);
        for (int c = 0; c < 2; c++) hair->surface_values[c] = (float)(floor(along[c] * 4096.0 + 0.5) / 4096.0);
        if (report) {
            fprintf(report, "material '%s': hair, its strands run along %.2f, %.2f of the texture\n", hair->name,
                    along[0], along[1]);
        }
    }
}
