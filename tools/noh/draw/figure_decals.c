/* figure_decals.c: marks on a figure (--decal). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/args.h"
#include "cli/message.h"
#include "figure.h"

#define SIZE_OF_HEIGHT 0.03 /* half a side, where none is given */
#define FAR_AWAY 1e6f
#define TRIANGLES 65536u /* of all grown marks: pictures have time for large ones */

/* X,Y[,SIZE[,RRGGBB]] */
static int parse(const char *text, figure_mark *mark)
{
    char end;
    unsigned color = 0x1a0505;
    const int count = sscanf(text, "%lf,%lf,%lf,%6x%c", &mark->x, &mark->y, &mark->size, &color, &end);
    int fields = 1;
    for (const char *at = text; *at; at++) fields += *at == ',';
    if (count < 3) mark->size = 0.0;
    for (int i = 0; i < 3; i++) mark->color[i] = (uint8_t)(color >> (16 - 8 * i));
    mark->color[3] = 255;
    if (count == fields && fields >= 2 && fields <= 4 && mark->x >= 0.0 && mark->x <= 1.0 && mark->y >= 0.0 &&
        mark->y <= 1.0 && mark->size >= 0.0 && mark->size <= 1e6) {
        return 0;
    }
    return tool_usage(
        "--decal must be X,Y[,SIZE[,RRGGBB]]: X and Y from 0 to 1 from the upper left corner, SIZE a length; not '%s'",
        text);
}

int figure_read_marks(const option_list *texts, const char *kind, figure_mark *marks, figure_desc *desc)
{
    int status = texts->count > (int)NOH_DECALS_MAX
                     ? tool_usage("--decal may be given at most %u times", NOH_DECALS_MAX)
                     : 0;
    for (int i = 0; i < texts->count && !status; i++) status = parse(texts->items[i], &marks[i]);
    desc->grown = strcmp(kind, "grown") == 0;
    if (!status && !desc->grown && strcmp(kind, "rest") != 0) {
        status = tool_usage("--decal-kind must be rest or grown, not '%s'", kind);
    }
    desc->marks = texts->count ? marks : NULL;
    desc->mark_count = (uint32_t)texts->count;
    return status;
}

static int open_patches(figure *f)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    for (uint32_t k = 0; k < f->stage_desc.kind_count && f->desc.grown; k++) {
        const size_t bytes = noh_stage_patches_size(f->desc.mark_count, TRIANGLES);
        f->patch_memory[k] = malloc(bytes);
        if (!f->patch_memory[k]) return tool_fail("--decal", "out of memory");
        if (noh_stage_patches_create(&f->decals, f->desc.mark_count, TRIANGLES, f->patch_memory[k], bytes,
                                     &f->patches[k], &error)) {
            f->patches[k].decals = NULL;
            return tool_fail_error("--decal", &error);
        }
    }
    return 0;
}

int figure_open_decals(figure *f)
{
    char log[4096] = "";
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_gl_device device;
    size_t bytes;
    if (!f->g || !f->desc.marks) return 0;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        noh_decals_init(&f->rings[k], f->desc.mark_count, 0, 0);
    }
    bytes = noh_stage_decals_size(f->stage);
    f->decal_memory = malloc(bytes);
    device = (noh_gl_device){ &f->g->gl, &f->g->caps, &f->g->ledger, log, sizeof log };
    if (!f->decal_memory) return tool_fail("--decal", "out of memory");
    if (noh_stage_decals_create(f->stage, &device, f->decal_memory, bytes, NULL, &f->decals, &error)) {
        fputs(log, stderr);
        return tool_fail_error("--decal", &error);
    }
    return open_patches(f);
}

void figure_close_decals(figure *f)
{
    for (uint32_t k = 0; k < NOH_STAGE_KINDS_MAX; k++) {
        noh_stage_patches_delete(&f->patches[k]);
        free(f->patch_memory[k]);
    }
    noh_stage_decals_delete(&f->decals);
    free(f->decal_memory);
}

noh_result figure_restore_decals(figure *f, char *log, size_t log_bytes, noh_error *error)
{
    noh_result result = noh_stage_decals_restore(&f->decals, NULL, log, log_bytes, error);
    for (uint32_t k = 0; k < f->stage_desc.kind_count && !result && f->desc.grown; k++) {
        result = noh_stage_patches_restore(&f->patches[k], error);
    }
    return result;
}

static int strike(figure *f, const figure_mark *mark, const noh_stage_view *view, uint32_t width, uint32_t height,
                  double size)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_decal_desc desc = { .size = (float)(mark->size > 0.0 ? mark->size : size) };
    float origin[3], direction[3];
    noh_stage_hit hit;
    for (int i = 0; i < 4; i++) desc.color[i] = mark->color[i];
    if (!noh_view_ray(view, (float)(mark->x * width - 0.5), (float)(mark->y * height - 0.5), width, height, origin,
                      direction) ||
        noh_stage_pick(f->stage, origin, direction, FAR_AWAY, &hit, NULL)) {
        return tool_fail("--decal", "the figure at rest is not at %g,%g in the picture", mark->x, mark->y);
    }
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        if (f->actors[k].id == hit.actor.id && noh_decals_strike(&f->rings[k], f->stage, &hit, &desc, NULL, &error)) {
            return tool_fail_error("--decal", &error);
        }
    }
    return 0;
}

int figure_strike(figure *f, const noh_gl_camera *camera, uint32_t width, uint32_t height)
{
    const bounds box = figure_bounds(f, FRAME_FULL);
    const noh_stage_view view = figure_view(camera, height);
    int status = figure_frame(f, &view, 1);
    for (uint32_t i = 0; i < f->desc.mark_count && !status; i++) {
        status = strike(f, &f->desc.marks[i], &view, width, height, SIZE_OF_HEIGHT * (box.high[1] - box.low[1]));
    }
    return status;
}

int figure_draw_decals(figure *f)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    for (uint32_t k = 0; k < f->stage_desc.kind_count && f->decals.drawable.gl && !f->shader; k++) {
        const noh_result result = f->desc.grown
                                      ? noh_stage_patches_draw(&f->patches[k], 0, f->actors[k], &f->rings[k], &error)
                                      : noh_stage_decals_draw(&f->decals, 0, f->actors[k], &f->rings[k], &error);
        if (result && result != NOH_ERR_NOT_FOUND) return tool_fail_error("--decal", &error);
    }
    return 0;
}
