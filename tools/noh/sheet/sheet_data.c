#include "sheet_data.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "draw/data_page.h"
#include "draw/label.h"
#include "file/png_file.h"

#define LINE_PIXELS 14u
#define LABEL_PIXELS (2u * LINE_PIXELS + 6u) /* above each layer */
#define GAP_PIXELS 4u
#define SIDE_PIXELS_MAX 16384u
#define FILL 48u /* grey */

typedef struct data_sheet {
    const sheet_data *o;
    uint32_t cell[2];       /* of one layer with its label, pixels */
    uint32_t columns, rows; /* of pages */
    uint32_t pages;         /* placed so far */
    uint32_t size[2];       /* of the picture */
    uint8_t *rgba;
} data_sheet;

/* How many of the targets that are shown a mesh has. */
static uint32_t count_targets(const sheet_tiles *t, const noh_mesh *mesh)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < t->target_count; i++) count += noh_mesh_find_target(mesh, t->targets[i].name) != NOH_NONE;
    return count;
}

static uint32_t scale_of(const data_sheet *d, const noh_mesh *mesh)
{
    const uint32_t width = 1u << mesh->header->morph_width_log2, height = mesh->header->morph_height;
    const uint32_t scale = d->o->tile / (width > height ? width : height);
    return scale ? scale : 1u;
}

/* A page for the base, one for each target, and one for the sums, of every mesh that has any of them. */
static uint32_t measure(data_sheet *d)
{
    const sheet_tiles *t = d->o->tiles;
    uint32_t pages = 0;
    noh_mesh mesh;
    for (uint32_t m = 0; noh_pack_mesh_at(&t->file->pack, m, &mesh, NULL) == NOH_OK; m++) {
        const uint32_t count = mesh.header->touched_count ? count_targets(t, &mesh) : 0, scale = scale_of(d, &mesh);
        const uint32_t width = scale << mesh.header->morph_width_log2, height = scale * mesh.header->morph_height;
        if (!count) continue;
        pages += count + 2u;
        if (width > d->cell[0]) d->cell[0] = width;
        if (height > d->cell[1]) d->cell[1] = height;
    }
    d->cell[0] += GAP_PIXELS;
    d->cell[1] += GAP_PIXELS + LABEL_PIXELS;
    return pages;
}

static int lay_out(data_sheet *d)
{
    const char *path = d->o->tiles->file->path;
    const uint32_t pages = measure(d);
    uint64_t width, height;
    if (!pages) return tool_fail(path, "no mesh has data textures: no target moves a vertex");
    d->columns = d->o->columns;
    if (!d->columns) {
        d->columns = (uint32_t)ceil(sqrt((double)pages * d->cell[1] / (DATA_LAYERS * (double)d->cell[0])));
    }
    d->columns = d->columns < pages ? d->columns : pages;
    d->rows = (pages + d->columns - 1u) / d->columns;
    width = (uint64_t)d->columns * DATA_LAYERS * d->cell[0];
    height = (uint64_t)d->rows * d->cell[1];
    if (width > SIDE_PIXELS_MAX || height > SIDE_PIXELS_MAX) {
        return tool_fail(
            path, "the picture would be %llu by %llu pixels, above the limit of %u: choose fewer targets with --target",
            (unsigned long long)width, (unsigned long long)height, SIDE_PIXELS_MAX);
    }
    d->size[0] = (uint32_t)width;
    d->size[1] = (uint32_t)height;
    d->rgba = malloc((size_t)width * height * 4u);
    if (!d->rgba) return tool_fail(path, "out of memory");
    for (size_t i = 0; i < (size_t)width * height; i++) {
        memset(d->rgba + 4u * i, FILL, 3);
        d->rgba[4u * i + 3u] = 255;
    }
    return 0;
}

/* Texels that belong to no vertex stay as they are. */
static void place_layer(data_sheet *d, const data_page *p, uint32_t layer, uint32_t scale, uint32_t x, uint32_t y)
{
    const uint8_t *from = p->rgba + 4u * (size_t)layer * p->width * p->height;
    for (uint32_t row = 0; row < p->height * scale; row++) {
        for (uint32_t column = 0; column < p->width * scale; column++) {
            const uint8_t *texel = from + 4u * ((size_t)(row / scale) * p->width + column / scale);
            if (texel[3]) memcpy(d->rgba + 4u * ((size_t)(y + row) * d->size[0] + x + column), texel, 4);
        }
    }
}

static void place(data_sheet *d, const data_page *p, uint32_t scale, const char *name)
{
    const uint32_t at = d->pages++;
    for (uint32_t layer = 0; layer < DATA_LAYERS; layer++) {
        const uint32_t x = (at % d->columns * DATA_LAYERS + layer) * d->cell[0], y = at / d->columns * d->cell[1];
        char label[64];
        place_layer(d, p, layer, scale, x, y + LABEL_PIXELS);
        if (p->most[layer] > 0.0f) {
            snprintf(label, sizeof label, "%s +-%.3g", data_layer_names[layer], (double)p->most[layer]);
        } else {
            snprintf(label, sizeof label, "%s", data_layer_names[layer]);
        }
        if (!layer) draw_text(d->rgba, d->size[0], d->size[1], (int)x + 6, (int)y + 4, 1, name);
        draw_text(d->rgba, d->size[0], d->size[1], (int)x + 6, (int)(y + 4u + LINE_PIXELS), 1, label);
    }
}

static void place_mesh(data_sheet *d, data_page *p, const noh_mesh *mesh)
{
    static float weights[NOH_TARGETS_MAX];
    const sheet_tiles *t = d->o->tiles;
    const uint32_t scale = scale_of(d, mesh);
    memset(weights, 0, sizeof weights);
    data_page_base(p, mesh);
    place(d, p, scale, mesh->name);
    for (uint32_t i = 0; i < t->target_count; i++) {
        const uint32_t target = noh_mesh_find_target(mesh, t->targets[i].name);
        if (target == NOH_NONE) continue;
        data_page_delta(p, mesh, target, 1.0f);
        place(d, p, scale, t->targets[i].name);
        weights[target] = (float)t->targets[i].weight;
    }
    data_page_sums(p, mesh, weights, 1.0f);
    place(d, p, scale, "sum");
}

int sheet_data_write(const sheet_data *s)
{
    data_sheet d = { s, { 0, 0 }, 0, 0, 0, { 0, 0 }, NULL };
    noh_mesh mesh;
    int status = lay_out(&d);
    for (uint32_t m = 0; !status && noh_pack_mesh_at(&s->tiles->file->pack, m, &mesh, NULL) == NOH_OK; m++) {
        data_page page;
        if (!mesh.header->touched_count || !count_targets(s->tiles, &mesh)) continue;
        status = data_page_open(&page, &mesh);
        if (!status) place_mesh(&d, &page, &mesh);
        data_page_close(&page);
    }
    if (!status) status = tool_write_png(s->output, d.size[0], d.size[1], d.rgba);
    free(d.rgba);
    return status;
}
