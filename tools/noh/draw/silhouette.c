#include "silhouette.h"

#include <math.h>
#include <stdlib.h>

#include "cli/message.h"

#define CELLS 320    /* of the raster's side */
#define PICTURES 5.0 /* the raster's side, in pictures */

typedef struct raster {
    uint8_t cells[CELLS][CELLS];
    int behind; /* 1: a corner is behind the camera */
} raster;

/* The cells of a range, of the raster's. */
static void span(float a, float b, float c, int range[2])
{
    range[0] = (int)fminf(fmaxf(floorf(fminf(a, fminf(b, c))), 0.0f), CELLS - 1.0f);
    range[1] = (int)fmaxf(fminf(ceilf(fmaxf(a, fmaxf(b, c))), CELLS - 1.0f), 0.0f);
}

/* Cells whose middle is on the same side of all three edges, whichever way round the triangle goes. */
static void cover(raster *r, float corners[3][2])
{
    const float *a = corners[0], *b = corners[1], *c = corners[2];
    int columns[2], rows[2];
    span(a[0], b[0], c[0], columns);
    span(a[1], b[1], c[1], rows);
    for (int y = rows[0]; y <= rows[1]; y++) {
        for (int x = columns[0]; x <= columns[1]; x++) {
            const float px = (float)x + 0.5f, py = (float)y + 0.5f;
            const float u = (b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0]);
            const float v = (c[0] - b[0]) * (py - b[1]) - (c[1] - b[1]) * (px - b[0]);
            const float w = (a[0] - c[0]) * (py - c[1]) - (a[1] - c[1]) * (px - c[0]);
            if ((u >= 0.0f && v >= 0.0f && w >= 0.0f) || (u <= 0.0f && v <= 0.0f && w <= 0.0f)) r->cells[y][x] = 1;
        }
    }
}

/* Where a vertex is in the raster. Returns 0 where it is behind the camera. */
static int project(const float m[16], const float world[12], const float p[3], float out[2])
{
    float at[3], clip[4];
    for (int r = 0; r < 3; r++) {
        at[r] = world[4 * r] * p[0] + world[4 * r + 1] * p[1] + world[4 * r + 2] * p[2] + world[4 * r + 3];
    }
    for (int r = 0; r < 4; r++) clip[r] = m[r] * at[0] + m[4 + r] * at[1] + m[8 + r] * at[2] + m[12 + r];
    if (clip[3] <= 0.0f) return 0;
    for (int i = 0; i < 2; i++) out[i] = (float)(CELLS / 2.0 * (1.0 + (double)clip[i] / (double)clip[3] / PICTURES));
    return 1;
}

static void rasterise(raster *r, const noh_mesh *mesh, const noh_vertex *vertices, const float world[12],
                      const noh_gl_camera *camera)
{
    for (uint32_t i = 0; i + 2 < mesh->header->index_count; i += 3) {
        float corners[3][2];
        int before = 1;
        for (uint32_t c = 0; c < 3; c++) {
            const float *p = vertices[noh_mesh_index(mesh, i + c)].position;
            before &= project(camera->view_projection, world, p, corners[c]);
        }
        if (before) {
            cover(r, corners);
        } else {
            r->behind = 1;
        }
    }
}

static void sum_up(const raster *r, silhouette *out)
{
    const int margin = (int)(CELLS * (0.5 - 0.5 / PICTURES));
    uint32_t all = 0, inside = 0;
    int low = CELLS, high = -1;
    for (int y = 0; y < CELLS; y++) {
        for (int x = 0; x < CELLS; x++) {
            if (!r->cells[y][x]) continue;
            all++;
            inside += x >= margin && x < CELLS - margin && y >= margin && y < CELLS - margin;
            low = y < low ? y : low;
            high = y;
        }
    }
    out->inside = all && !r->behind ? (double)inside / (double)all : 0.0;
    out->height = all ? (high - low + 1.0) / (CELLS / PICTURES) : 0.0;
}

int silhouette_measure(const figure *f, const noh_gl_camera *camera, uint32_t level, silhouette *out)
{
    raster *r = calloc(1, sizeof *r);
    if (!r) return tool_fail("figure", "out of memory");
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        for (uint32_t i = 0; i < f->plan.kinds[k].mesh_count; i++) {
            noh_mesh mesh;
            noh_actor_mesh shown;
            noh_vertex *vertices = figure_deform(f, k, i, level, &mesh, &shown);
            if (!vertices) {
                free(r);
                return EXIT_FAILED;
            }
            rasterise(r, &mesh, vertices, shown.world, camera);
            free(vertices);
        }
    }
    sum_up(r, out);
    free(r);
    return 0;
}
