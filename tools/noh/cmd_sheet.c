/* cmd_sheet.c: a contact sheet. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sheet_lods.h"
#include "sheet_tiles.h"
#include "stage.h"

#define SHEET_PIXELS_MAX 16384u /* high */

typedef struct sheet {
    sheet_tiles tiles;
    uint32_t tile_count, columns, rows, tile; /* tile: pixels */
    int show_bones, lods;
    bounds box; /* of all tiles, about what the camera follows */
    uint8_t *rgba;
    const char *pack, *output, *driver, *camera;
    load_options load;
} sheet;

static void place_tile(sheet *s, uint32_t tile, const uint8_t *rgba)
{
    char label[128];
    size_t row = (size_t)s->columns * s->tile * 4;
    uint8_t *to = s->rgba + (size_t)(tile / s->columns) * s->tile * row + (size_t)(tile % s->columns) * s->tile * 4;
    for (uint32_t y = 0; y < s->tile; y++) {
        memcpy(to + y * row, rgba + (size_t)y * s->tile * 4, (size_t)s->tile * 4);
    }
    sheet_tiles_label(&s->tiles, tile, label, sizeof label);
    draw_text(s->rgba, s->columns * s->tile, s->rows * s->tile, (int)(tile % s->columns * s->tile) + 6,
              (int)(tile / s->columns * s->tile) + 6, 1, label);
}

/* Where on the ground the scene stands, so that a walk stays in its tile: the first joint. */
static void anchor_of(const scene *s, double anchor[3])
{
    anchor[0] = s->skeleton.joint_count ? (double)s->joint_matrices[3] : 0.0;
    anchor[1] = 0.0;
    anchor[2] = s->skeleton.joint_count ? (double)s->joint_matrices[11] : 0.0;
}

static bounds move_box(bounds box, const double by[3], double sign)
{
    for (int c = 0; c < 3; c++) {
        box.low[c] += sign * by[c];
        box.high[c] += sign * by[c];
    }
    return box;
}

/* One box for all tiles, about the anchor: it holds every pose. */
static int measure_tiles(sheet *s, int face)
{
    const scene *posed = &s->tiles.posed;
    int status = 0;
    for (uint32_t tile = 0; tile < s->tile_count && !status; tile += 1 + s->tile_count / 40) {
        double anchor[3];
        bounds box;
        status = sheet_tiles_pose(&s->tiles, tile);
        anchor_of(posed, anchor);
        box = move_box(stage_bounds(posed, s->tiles.file, face, s->show_bones), anchor, -1.0);
        s->box = tile ? bounds_union(s->box, box) : box;
    }
    return status;
}

static int tile_camera(const sheet *s, noh_gl_camera *camera)
{
    const view_options o = { s->camera, s->tile, s->tile };
    double anchor[3];
    bounds box;
    anchor_of(&s->tiles.posed, anchor);
    box = move_box(s->box, anchor, 1.0);
    return view_camera(&o, &box, camera);
}

static int draw_tiles(sheet *s, stage *st)
{
    uint8_t *rgba = malloc((size_t)s->tile * s->tile * 4);
    int status = rgba ? 0 : tool_fail(s->pack, "out of memory");
    for (uint32_t tile = 0; tile < s->tile_count && !status; tile++) {
        noh_gl_camera camera;
        status = sheet_tiles_pose(&s->tiles, tile);
        if (!status) status = tile_camera(s, &camera);
        if (!status) status = stage_draw(st, &camera, rgba);
        if (!status) place_tile(s, tile, rgba);
    }
    free(rgba);
    return status;
}

static int draw_sheet(sheet *s)
{
    gpu g;
    stage st;
    const view_options o = { s->camera, s->tile, s->tile };
    int status = measure_tiles(s, view_wants_face(&o));
    if (!status) status = gpu_open(&g, s->driver);
    if (status) {
        return status;
    }
    status = stage_open(&st, &g, s->tiles.file, &s->tiles.posed, &s->load, s->show_bones, s->tile, s->tile);
    if (!status) {
        status = draw_tiles(s, &st);
        stage_close(&st);
    }
    gpu_close(&g);
    return status;
}

/* Tiles that stay empty look like the others' background. */
static int make_picture(sheet *s)
{
    static const uint8_t background[4] = { CANVAS_BACKGROUND_SRGB, 255 };
    size_t pixels = (size_t)s->columns * s->tile * s->rows * s->tile;
    s->rgba = malloc(pixels * 4);
    for (size_t i = 0; s->rgba && i < pixels; i++) {
        memcpy(s->rgba + 4 * i, background, 4);
    }
    return s->rgba ? 0 : tool_fail(s->pack, "out of memory");
}

static int lay_out(sheet *s)
{
    s->tile_count = sheet_tiles_count(&s->tiles);
    if (sheet_tiles_columns(&s->tiles)) {
        s->columns = sheet_tiles_columns(&s->tiles);
    } else if (!s->columns) {
        s->columns = (uint32_t)ceil(sqrt((double)s->tile_count * 1.4));
    }
    s->columns = s->columns > s->tile_count ? s->tile_count : s->columns;
    s->rows = (s->tile_count + s->columns - 1) / s->columns;
    if ((uint64_t)s->tile * s->rows > SHEET_PIXELS_MAX) {
        s->tile = 96; /* hundreds of targets */
    }
    return make_picture(s);
}

static int make_sheet(sheet *s, const pack_file *file)
{
    int status = sheet_tiles_open(&s->tiles, file);
    if (!status) {
        s->show_bones = stage_shows_bones(&s->tiles.rest, file, s->show_bones);
        status = s->show_bones < 0 ? EXIT_FAILED : lay_out(s);
    }
    if (!status) status = draw_sheet(s);
    if (!status) status = tool_write_png(s->output, s->columns * s->tile, s->rows * s->tile, s->rgba);
    free(s->rgba);
    sheet_tiles_close(&s->tiles);
    return status;
}

static int check_clips(const sheet_tiles *t, const char *transition)
{
    if ((t->blend || t->to || t->anim) && !t->clips.count) {
        return tool_usage("sheet wants --clip NAME with --blend, --to and --anim");
    }
    if (t->blend && t->to) {
        return tool_usage("sheet shows a --blend or a transition --to, not both");
    }
    if (transition && strcmp(transition, "fade") != 0 && strcmp(transition, "inertia") != 0) {
        return tool_usage("--transition wants fade or inertia, not '%s'", transition);
    }
    return t->over_s > 0.0 && t->over_s <= 60.0 ? 0 : tool_usage("--over wants up to 60 seconds");
}

static int read_args(int argc, char **argv, sheet *s)
{
    const char *path = NULL, *accumulate = NULL, *transition = NULL;
    double tile = 192.0, tiles = 24.0, columns = 0.0;
    sheet_tiles *t = &s->tiles;
    const option options[] = {
        { "-o", OPTION_TEXT, &s->output },       { "--clip", OPTION_LIST, &t->clips },     { "--driver", OPTION_TEXT, &s->driver },
        { "--camera", OPTION_TEXT, &s->camera }, { "--path", OPTION_TEXT, &path },        { "--accumulate", OPTION_TEXT, &accumulate },
        { "--tile", OPTION_NUMBER, &tile },      { "--tiles", OPTION_NUMBER, &tiles },    { "--columns", OPTION_NUMBER, &columns },
        { "--target", OPTION_LIST, &t->only },   { "--anim", OPTION_TEXT, &t->anim },     { "--bones", OPTION_FLAG, &s->show_bones },
        { "--blend", OPTION_TEXT, &t->blend },   { "--to", OPTION_TEXT, &t->to },         { "--transition", OPTION_TEXT, &transition },
        { "--over", OPTION_NUMBER, &t->over_s }, { "--lods", OPTION_FLAG, &s->lods }
    };
    int count, status = tool_options(argc, argv, options, sizeof options / sizeof options[0], &s->pack, 1, &count);
    if (!status) status = parse_path(path, &s->load.path);
    if (!status) status = parse_accumulate(accumulate, &s->load.accumulate);
    if (!status && (!s->pack || !s->output)) {
        status = tool_usage("sheet wants a pack and -o OUT.png");
    }
    if (!status && !(tile >= 16.0 && tile <= 1024.0 && tiles >= 1.0 && tiles <= 1024.0 && columns >= 0.0 && columns <= 64.0)) {
        status = tool_usage("sheet wants a --tile of 16 to 1024 pixels, 1 to 1024 --tiles and up to 64 --columns");
    }
    if (!status) status = check_clips(t, transition);
    if (!status && s->lods && (t->clips.count || s->show_bones)) {
        status = tool_usage("sheet shows --lods at rest and with targets, without --clip and --bones");
    }
    t->inertia = transition && strcmp(transition, "inertia") == 0;
    s->tile = (uint32_t)tile;
    t->clip_tiles = (uint32_t)tiles;
    s->columns = (uint32_t)columns;
    return status;
}

static int make_lods(const sheet *s, const pack_file *file)
{
    const sheet_lods o = { file, s->output, s->camera, s->driver, s->load, &s->tiles.only, s->tile };
    return sheet_lods_write(&o);
}

int verb_sheet(int argc, char **argv)
{
    static sheet s;
    pack_file file;
    int status;
    memset(&s, 0, sizeof s);
    s.camera = "face";
    s.tiles.over_s = 0.3;
    status = read_args(argc, argv, &s);
    if (!status) {
        status = pack_file_open(&file, s.pack);
        if (!status) {
            status = s.lods ? make_lods(&s, &file) : make_sheet(&s, &file);
            pack_file_close(&file);
        }
    }
    return status;
}
