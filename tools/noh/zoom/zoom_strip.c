/* zoom_strip.c: frames of a zoom side by side: with levels, full, and in the colours of the levels. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "zoom.h"
#include "gpu/canvas.h"
#include "draw/label.h"
#include "cli/message.h"
#include "file/png_file.h"

#define GAP 4u
#define LABEL 14u /* pixels above the pictures */
#define WIDE 60u  /* enough for the whole label */

int zoom_strip_open(zoom_strip *s, const zoom *z)
{
    static const noh_gl_shader_desc desc = { .view = NOH_VIEW_LOD };
    const size_t bytes = noh_stage_shader_size(z->kept.stage);
    char log[4096] = "";
    noh_error error = { NOH_OK, "", 0, 0 };
    memset(s, 0, sizeof *s);
    s->shader_memory = malloc(bytes);
    if (!s->shader_memory) {
        return tool_fail("zoom", "out of memory");
    }
    if (noh_stage_shader_create(z->kept.stage, s->shader_memory, bytes, &desc, log, sizeof log, &s->shader, &error)) {
        fputs(log, stderr);
        s->shader = NULL;
        return tool_fail_error("zoom", &error);
    }
    return 0;
}

void zoom_strip_close(zoom_strip *s)
{
    for (uint32_t i = 0; i < 3u * ZOOM_STRIP; i++) {
        free(s->pictures[i / ZOOM_STRIP][i % ZOOM_STRIP].rgba);
    }
    if (s->shader) noh_stage_shader_delete(s->shader);
    free(s->shader_memory);
    memset(s, 0, sizeof *s);
}

static int copy(zoom_picture *to, const zoom_picture *from)
{
    const size_t bytes = (size_t)from->size * from->size * 4;
    to->size = from->size;
    to->rgba = malloc(bytes);
    if (!to->rgba) {
        return tool_fail("zoom", "out of memory");
    }
    memcpy(to->rgba, from->rgba, bytes);
    return 0;
}

static int draw_colors(zoom_strip *s, zoom *z)
{
    zoom_picture *p = &s->pictures[2][s->count];
    p->rgba = malloc((size_t)z->seen.size * z->seen.size * 4);
    return p->rgba ? zoom_target_draw(&z->seen, &z->kept, 0, s->shader, p) : tool_fail("zoom", "out of memory");
}

int zoom_strip_take(zoom_strip *s, zoom *z, uint32_t frame)
{
    const noh_actor_detail *d = &z->details[0];
    int status;
    if (s->count == ZOOM_STRIP || frame < s->count * (z->path.frames / 2u) / (ZOOM_STRIP - 1u)) {
        return 0;
    }
    status = draw_colors(s, z);
    if (!status) status = copy(&s->pictures[0][s->count], &z->seen_kept[frame % 2u]);
    if (!status) status = copy(&s->pictures[1][s->count], &z->seen_full[frame % 2u]);
    snprintf(s->labels[s->count], sizeof s->labels[0], "level %u", d->level);
    if (d->level != d->level_before) {
        snprintf(s->labels[s->count], sizeof s->labels[0], "level %u-%u", d->level_before, d->level);
    }
    s->count += !status;
    return status;
}

/* Flipped upright, and opaque. */
static void place(const zoom_picture *p, uint8_t *rgba, uint32_t width, uint32_t left, uint32_t top)
{
    for (uint32_t y = 0; y < p->size; y++) {
        uint8_t *row = rgba + 4 * ((size_t)(top + y) * width + left);
        memcpy(row, p->rgba + 4 * (size_t)(p->size - 1u - y) * p->size, 4 * (size_t)p->size);
        for (uint32_t x = 0; x < p->size; x++) {
            row[4 * x + 3] = 255;
        }
    }
}

static uint8_t *background(uint32_t width, uint32_t height)
{
    static const uint8_t color[4] = { CANVAS_BACKGROUND_SRGB, 255 };
    uint8_t *rgba = malloc((size_t)width * height * 4);
    for (size_t i = 0; rgba && i < (size_t)width * height; i++) {
        memcpy(rgba + 4 * i, color, 4);
    }
    return rgba;
}

int zoom_strip_write(const zoom_strip *s, const char *path)
{
    const uint32_t row = s->pictures[0][0].size + GAP, height = LABEL + 3u * row;
    uint32_t width = GAP, left = GAP;
    uint8_t *rgba;
    int status;
    for (uint32_t i = 0; i < s->count; i++) {
        width += s->pictures[0][i].size + GAP;
    }
    rgba = background(width, height);
    for (uint32_t i = 0; rgba && i < s->count; i++) {
        const uint32_t size = s->pictures[0][i].size;
        for (uint32_t kind = 0; kind < 3; kind++) {
            place(&s->pictures[kind][i], rgba, width, left, LABEL + kind * row + (row - size) / 2u);
        }
        draw_text(rgba, width, height, (int)left, 2, 1, s->labels[i] + (size < WIDE ? strlen("level ") : 0));
        left += size + GAP;
    }
    status = rgba ? tool_write_png(path, width, height, rgba) : tool_fail(path, "out of memory");
    free(rgba);
    return status;
}
