#include "sheet_lods.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/label.h"
#include "cli/message.h"
#include "file/png_file.h"

#define USE_PIXELS 1.0 /* of error, at the size at which a level is used */

typedef struct grid {
    const sheet_lods *o;
    picture *picture; /* of the column that is being drawn */
    gpu gpu;
    uint32_t first;         /* the first column's level */
    uint32_t columns, rows; /* rows: rest, faces, size of use */
    noh_gl_camera camera;
    double tile_pixels_per_unit;
    uint8_t *rgba, *cell;
} grid;

/* ---- faces ---- */

static int hold_part(figure *f, const char *part, size_t length)
{
    static option_list one;
    char text[NOH_NAME_BYTES_MAX + 32];
    if (length >= sizeof text - 3) {
        return tool_usage("--target must be NAME[=V][,NAME[=V]]...");
    }
    snprintf(text, sizeof text, "%.*s%s", (int)length, part, memchr(part, '=', length) ? "" : "=1");
    one.count = 1;
    one.items[0] = text;
    return figure_hold_options(f, &one);
}

int sheet_hold_face(figure *f, const char *face)
{
    int status = 0;
    while (*face && !status) {
        const size_t length = strcspn(face, ",");
        status = hold_part(f, face, length);
        face += length + (face[length] == ',');
    }
    return status;
}

static int apply_smile(grid *g)
{
    const noh_pack *pack = &g->o->file->pack;
    noh_mesh mesh;
    int status = 0;
    for (uint32_t m = 0; noh_pack_mesh_at(pack, m, &mesh, NULL) == NOH_OK; m++) {
        for (uint32_t t = 0; t < mesh.header->target_count && !status; t++) {
            const char *name = noh_pack_string(pack, mesh.targets[t].name);
            if (strstr(name, "smile") || strstr(name, "Smile")) status = figure_hold(&g->picture->figure, name, 1.0);
        }
    }
    return status;
}

static uint32_t face_count(const sheet_lods *o)
{
    return o->faces->count ? (uint32_t)o->faces->count : 1u;
}

/* Set the weights of a row, and clear the weights of the row before. */
static int apply_row(grid *g, uint32_t row)
{
    const int status = figure_hold_all(&g->picture->figure, 0.0);
    if (status || row == 0 || row + 1 == g->rows) {
        return status;
    }
    return g->o->faces->count ? sheet_hold_face(&g->picture->figure, g->o->faces->items[row - 1]) : apply_smile(g);
}

/* ---- sizes ---- */

/* Pixels of a tile per unit of length, at the centre of the view. */
static double pixels_per_unit(const noh_gl_camera *camera, const bounds *box, uint32_t tile)
{
    const float *m = camera->view_projection;
    double c[3], w = (double)m[15], up = 0.0;
    for (int i = 0; i < 3; i++) {
        c[i] = (box->low[i] + box->high[i]) / 2.0;
        w += (double)m[4 * i + 3] * c[i];
        up += (double)m[4 * i + 1] * (double)m[4 * i + 1];
    }
    return sqrt(up) / w * tile / 2.0;
}

/* The largest error of any mesh, world units. */
static double level_error(const grid *g, uint32_t level)
{
    double worst = 0.0;
    noh_mesh full;
    for (uint32_t i = 0; noh_pack_mesh_at(&g->o->file->pack, i, &full, NULL) == NOH_OK; i++) {
        const noh_mesh mesh = noh_mesh_at_lod(&full, level);
        const noh_mesh_header *h = mesh.header;
        const float errors[4] = { h->level_error_rest, h->level_error_targets, h->level_error_pairs,
                                  h->level_error_clip };
        for (int k = 0; k < 4; k++) {
            worst = fmax(worst, (double)errors[k] * (double)h->world_scale);
        }
    }
    return worst;
}

static uint32_t size_of_use(const grid *g, uint32_t level)
{
    const double error = level_error(g, level) * g->tile_pixels_per_unit, tile = g->o->tile;
    const double size = error > 0.0 ? tile * USE_PIXELS / error : tile;
    return (uint32_t)fmax(4.0, fmin(tile, size));
}

/* ---- cells ---- */

static void place(grid *g, uint32_t column, uint32_t row, uint32_t size, const char *label)
{
    const uint32_t tile = g->o->tile, width = g->columns * tile, left = column * tile + (tile - size) / 2,
                   top = row * tile + (tile - size) / 2;
    for (uint32_t y = 0; y < size; y++) {
        memcpy(g->rgba + 4 * ((size_t)(top + y) * width + left), g->cell + 4 * (size_t)y * size, 4 * (size_t)size);
    }
    draw_text(g->rgba, width, g->rows * tile, (int)(column * tile) + 6, (int)(row * tile) + 6, 1, label);
}

static void label_cell(const grid *g, uint32_t column, uint32_t row, uint32_t size, char *label, size_t bytes)
{
    const uint32_t level = g->first + column, triangles = figure_triangles(&g->picture->figure, level);
    if (row == 0) {
        snprintf(label, bytes, "level %u: %u triangles, %.2f mm", level, triangles, 1e3 * level_error(g, level));
    } else if (row + 1 == g->rows) {
        snprintf(label, bytes, "used up to %u pixels", size);
    } else {
        snprintf(label, bytes, "%s", g->o->faces->count ? g->o->faces->items[row - 1] : "smile");
    }
}

static int draw_cell(grid *g, uint32_t column, uint32_t row, uint32_t size)
{
    char label[160];
    int status = apply_row(g, row);
    if (!status) status = picture_read(g->picture, &g->camera, g->cell);
    if (!status) {
        label_cell(g, column, row, size, label, sizeof label);
        place(g, column, row, size, label);
    }
    return status;
}

/* Several rows of a level, drawn at one size. */
static int draw_rows(grid *g, uint32_t column, uint32_t first, uint32_t end, uint32_t size)
{
    figure_desc desc = g->o->figure;
    picture p;
    int status;
    desc.level = g->first + column;
    status = picture_open(&p, &g->gpu, &desc, 0, size, size);
    if (status) {
        return status;
    }
    g->picture = &p;
    status = figure_pose(&p.figure); /* what casts a shadow has a size only when it is posed */
    for (uint32_t row = first; row < end && !status; row++) {
        status = draw_cell(g, column, row, size);
    }
    picture_close(&p);
    g->picture = NULL;
    return status;
}

static int draw_level(grid *g, uint32_t column)
{
    const int status = draw_rows(g, column, 0, g->rows - 1, g->o->tile);
    return status ? status : draw_rows(g, column, g->rows - 1, g->rows, size_of_use(g, g->first + column));
}

/* ---- all of it ---- */

static int make_picture(grid *g)
{
    static const uint8_t background[4] = { CANVAS_BACKGROUND_SRGB, 255 };
    const size_t cell = (size_t)g->o->tile * g->o->tile, pixels = cell * g->columns * g->rows;
    g->rgba = malloc(pixels * 4);
    g->cell = malloc(cell * 4);
    for (size_t i = 0; g->rgba && i < pixels; i++) {
        memcpy(g->rgba + 4 * i, background, 4);
    }
    return g->rgba && g->cell ? 0 : tool_fail(g->o->output, "out of memory");
}

/* A figure that nothing draws, at rest. */
static int place_camera(grid *g)
{
    const sheet_lods *o = g->o;
    view_options view = { o->camera, o->tile, o->tile, 0, 0.0 };
    figure f;
    int status = figure_open(&f, &o->figure, NULL);
    if (status) {
        return status;
    }
    view.facing = f.facing;
    status = figure_pose(&f);
    if (!status) {
        const bounds box = figure_bounds(&f, view_frame_of(&view));
        status = view_camera(&view, &box, &g->camera);
        g->tile_pixels_per_unit = pixels_per_unit(&g->camera, &box, o->tile);
    }
    figure_close(&f);
    return status;
}

static int draw_all(grid *g)
{
    const sheet_lods *o = g->o;
    int status = place_camera(g);
    g->first = figure_level_first(&o->file->pack);
    g->columns = figure_level_count(&o->file->pack) - g->first;
    g->rows = 2 + face_count(o);
    if (!status) status = make_picture(g);
    for (uint32_t column = 0; column < g->columns && !status; column++) {
        status = draw_level(g, column);
    }
    return status ? status : tool_write_png(o->output, g->columns * o->tile, g->rows * o->tile, g->rgba);
}

int sheet_lods_write(const sheet_lods *s)
{
    grid g;
    int status;
    memset(&g, 0, sizeof g);
    g.o = s;
    if (picture_shows_bones(s->file, 0)) {
        return tool_fail(s->file->path, "the pack has nothing to draw");
    }
    status = gpu_open_drawing(&g.gpu, s->driver);
    if (!status) {
        status = draw_all(&g);
        gpu_close(&g.gpu);
    }
    free(g.rgba);
    free(g.cell);
    return status;
}
