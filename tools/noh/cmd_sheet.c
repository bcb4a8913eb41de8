/* cmd_sheet.c: a contact sheet: every target at full weight, or a clip in time. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "view.h"

typedef struct sheet {
    const pack_file *file;
    const char *clip_name, *anim;
    double clip_seconds;
    const char **names; /* targets, each name once */
    uint32_t name_count, clip_tiles, tile_count, columns, tile;
    uint8_t *rgba;      /* the whole sheet */
    scene rest, posed;
    option_list only; /* --target: these instead of all */
} sheet;

/* The targets that were asked for; each has to be there. */
static int list_only(sheet *s)
{
    int status = 0;
    s->names = calloc((size_t)s->only.count, sizeof *s->names);
    if (!s->names) {
        return tool_fail(s->file->path, "out of memory");
    }
    for (int i = 0; i < s->only.count && !status; i++) {
        status = scene_check_target(&s->rest, s->file, s->only.items[i]);
        s->names[s->name_count++] = s->only.items[i];
    }
    return status;
}

/* Every target name of every mesh, once. */
static int list_names(sheet *s)
{
    size_t total = 0;
    if (s->only.count) {
        return list_only(s);
    }
    for (uint32_t m = 0; m < s->file->pack.mesh_count; m++) {
        total += s->rest.meshes[m].header->target_count;
    }
    s->names = calloc(total + 1, sizeof *s->names);
    if (!s->names) {
        return tool_fail(s->file->path, "out of memory");
    }
    for (uint32_t m = 0; m < s->file->pack.mesh_count; m++) {
        for (uint32_t t = 0; t < s->rest.meshes[m].header->target_count; t++) {
            const char *name = noh_pack_string(&s->file->pack, s->rest.meshes[m].targets[t].name);
            uint32_t i = 0;
            while (i < s->name_count && strcmp(s->names[i], name) != 0) {
                i++;
            }
            if (i == s->name_count) {
                s->names[s->name_count++] = name;
            }
        }
    }
    return 0;
}

static void copy_weights(const scene *from, scene *to)
{
    for (uint32_t i = 0; i < from->item_count; i++) {
        memcpy(to->items[i].weights, from->items[i].weights,
               sizeof(float) * from->meshes[from->items[i].mesh].header->target_count);
    }
}

static double tile_time(const sheet *s, uint32_t tile)
{
    return s->clip_seconds * tile / (s->tile_count > 1 ? s->tile_count - 1 : 1);
}

/* Tile 0 of a target sheet is the rest pose. */
static void pose_tile(sheet *s, uint32_t tile)
{
    copy_weights(&s->rest, &s->posed);
    if (s->clip_name) {
        scene_set_clip(&s->posed, s->file, s->clip_name, tile_time(s, tile));
        return;
    }
    for (uint32_t i = 0; tile && i < s->posed.item_count; i++) {
        const noh_mesh *mesh = &s->posed.meshes[s->posed.items[i].mesh];
        uint32_t target = noh_mesh_find_target(mesh, s->names[tile - 1]);
        if (target < mesh->header->target_count) {
            s->posed.items[i].weights[target] = 1.0f;
        }
    }
}

static void label_tile(sheet *s, uint32_t tile)
{
    char label[128];
    if (s->clip_name) {
        snprintf(label, sizeof label, "%s %.2f s", s->clip_name, tile_time(s, tile));
    } else {
        snprintf(label, sizeof label, "%s", tile ? s->names[tile - 1] : "(rest)");
    }
    draw_text(s->rgba, s->columns * s->tile, (s->tile_count + s->columns - 1) / s->columns * s->tile,
              (int)(tile % s->columns * s->tile) + 6, (int)(tile / s->columns * s->tile) + 6, 1, label);
}

static void place_tile(sheet *s, uint32_t tile, const uint8_t *rgba)
{
    size_t row = (size_t)s->columns * s->tile * 4;
    uint8_t *to = s->rgba + (size_t)(tile / s->columns) * s->tile * row + (size_t)(tile % s->columns) * s->tile * 4;
    for (uint32_t y = 0; y < s->tile; y++) {
        memcpy(to + y * row, rgba + (size_t)y * s->tile * 4, (size_t)s->tile * 4);
    }
}

static int draw_tiles(sheet *s, load *l, canvas *c, const noh_gl_camera *camera)
{
    uint8_t *rgba = malloc((size_t)s->tile * s->tile * 4);
    int status = rgba ? 0 : tool_fail(s->file->path, "out of memory");
    for (uint32_t tile = 0; tile < s->tile_count && !status; tile++) {
        pose_tile(s, tile);
        status = load_update(l, NULL);
        if (!status) {
            canvas_begin(c);
            load_draw(l, camera);
            status = canvas_read(c, rgba);
            place_tile(s, tile, rgba);
            label_tile(s, tile);
        }
    }
    free(rgba);
    return status;
}

/* One camera for all tiles: it holds every pose. */
static int sheet_camera(sheet *s, const char *camera_text, noh_gl_camera *camera)
{
    view_options o = { camera_text, s->tile, s->tile };
    bounds box = scene_bounds(&s->rest, s->file, view_wants_face(&o));
    for (uint32_t tile = 0; tile < s->tile_count; tile += 1 + s->tile_count / 40) {
        pose_tile(s, tile);
        box = bounds_union(box, scene_bounds(&s->posed, s->file, view_wants_face(&o)));
    }
    return view_camera(&o, &box, camera);
}

static int draw_sheet(sheet *s, const char *driver, const char *camera_text, const load_options *o)
{
    gpu g;
    load l;
    canvas c;
    noh_gl_camera camera;
    int status = sheet_camera(s, camera_text, &camera);
    if (!status) status = gpu_open(&g, driver);
    if (status) {
        return status;
    }
    status = load_open(&l, &g, s->file, &s->posed, o);
    if (!status) {
        status = canvas_open(&c, &g, s->tile, s->tile);
        if (!status) {
            status = draw_tiles(s, &l, &c, &camera);
            canvas_close(&c);
        }
        load_close(&l);
    }
    gpu_close(&g);
    return status;
}

/* Tiles that stay empty look like the others' background. */
static void fill_background(uint8_t *rgba, size_t pixels)
{
    static const uint8_t background[4] = { CANVAS_BACKGROUND_SRGB, 255 };
    for (size_t i = 0; i < pixels; i++) {
        memcpy(rgba + 4 * i, background, 4);
    }
}

static int prepare(sheet *s)
{
    int status = scene_init(&s->rest, s->file);
    if (!status) status = scene_init(&s->posed, s->file);
    if (!status) status = list_names(s);
    if (!status) status = scene_open_anim(&s->posed, s->file, s->anim);
    if (!status && s->clip_name) status = scene_clip_seconds(&s->posed, s->file, s->clip_name, &s->clip_seconds);
    if (status) {
        return status;
    }
    s->tile_count = s->clip_name ? s->clip_tiles : s->name_count + 1;
    s->columns = s->columns ? s->columns : (uint32_t)ceil(sqrt((double)s->tile_count * 1.4));
    s->columns = s->columns > s->tile_count ? s->tile_count : s->columns;
    if ((uint64_t)s->tile * ((s->tile_count + s->columns - 1) / s->columns) > 16384) {
        s->tile = 96; /* hundreds of targets */
    }
    s->rgba = calloc((size_t)s->columns * s->tile * ((s->tile_count + s->columns - 1) / s->columns) * s->tile, 4);
    if (!s->rgba) {
        return tool_fail(s->file->path, "out of memory");
    }
    fill_background(s->rgba, (size_t)s->columns * s->tile * ((s->tile_count + s->columns - 1) / s->columns) * s->tile);
    return 0;
}

int verb_sheet(int argc, char **argv)
{
    const char *pack = NULL, *output = NULL, *driver = NULL, *camera = "face", *path = NULL, *accumulate = NULL;
    double tile = 192.0, tiles = 24.0, columns = 0.0;
    load_options o;
    pack_file file;
    static sheet s;
    int count, status;
    memset(&s, 0, sizeof s);
    memset(&o, 0, sizeof o);
    const option options[] = {
        { "-o", OPTION_TEXT, &output },       { "--clip", OPTION_TEXT, &s.clip_name }, { "--driver", OPTION_TEXT, &driver },
        { "--camera", OPTION_TEXT, &camera }, { "--path", OPTION_TEXT, &path },        { "--accumulate", OPTION_TEXT, &accumulate },
        { "--tile", OPTION_NUMBER, &tile },   { "--tiles", OPTION_NUMBER, &tiles },     { "--columns", OPTION_NUMBER, &columns },
        { "--target", OPTION_LIST, &s.only },   { "--anim", OPTION_TEXT, &s.anim }
    };
    status = tool_options(argc, argv, options, sizeof options / sizeof options[0], &pack, 1, &count);
    if (!status) status = parse_path(path, &o.path);
    if (!status) status = parse_accumulate(accumulate, &o.accumulate);
    if (!status && (!pack || !output)) {
        status = tool_usage("sheet wants a pack and -o OUT.png");
    }
    if (!status && !(tile >= 16.0 && tile <= 1024.0 && tiles >= 1.0 && tiles <= 1024.0 && columns >= 0.0 && columns <= 64.0)) {
        status = tool_usage("sheet wants a --tile of 16 to 1024 pixels, 1 to 1024 --tiles and up to 64 --columns");
    }
    if (!status) status = pack_file_open(&file, pack);
    if (status) {
        return status;
    }
    s.file = &file;
    s.tile = (uint32_t)tile;
    s.clip_tiles = (uint32_t)tiles;
    s.columns = (uint32_t)columns;
    status = prepare(&s);
    if (!status) status = draw_sheet(&s, driver, camera, &o);
    if (!status) {
        status = tool_write_png(output, s.columns * s.tile, (s.tile_count + s.columns - 1) / s.columns * s.tile, s.rgba);
    }
    free(s.rgba);
    free(s.names);
    scene_free(&s.rest);
    scene_free(&s.posed);
    pack_file_close(&file);
    return status;
}
