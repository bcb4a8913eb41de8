/* cmd_sheet.c: a contact sheet. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sheet_data.h"
#include "sheet_lods.h"
#include "sheet_tiles.h"
#include "draw/facing.h"
#include "draw/picture.h"
#include "gpu/gpu_args.h"
#include "draw/label.h"
#include "cli/message.h"
#include "file/png_file.h"
#include "cli/options.h"
#include "cli/verbs.h"

#define SHEET_PIXELS_MAX 16384u /* high */

typedef struct sheet {
    sheet_tiles tiles;
    uint32_t tile_count, columns, rows, tile; /* tile: pixels */
    int show_bones, lods, data;
    bounds box; /* of all tiles, relative to the anchor */
    uint8_t *rgba;
    const char *pack, *output, *driver, *camera;
    figure_desc figure;
    body_options body_wants;
    figure_body body;
    light_options light;
    lighting lit;
} sheet;

typedef struct sheet_args {
    const char *path, *accumulate, *transition, *face, *springs, *hair, *decal_kind;
    option_list decals;
    figure_mark marks[NOH_DECALS_MAX];
    double tile, tiles, columns, faces, seed, time_s;
    sheet s;
} sheet_args;

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

/* The camera follows the figure over the ground, so that a walk stays in its tile. */
static bounds move_box(bounds box, const double by[3], double sign)
{
    for (int c = 0; c < 3; c++) {
        box.low[c] += sign * by[c];
        box.high[c] += sign * by[c];
    }
    return box;
}

/* One box for all tiles, relative to the anchor, from at most 40 of the poses. */
/* The camera follows a figure that walks, but not one that falls. */
static void find_anchor(const sheet *s, const picture *p, double anchor[3])
{
    figure_anchor(&p->figure, anchor);
    if (s->tiles.push) memset(anchor, 0, 3 * sizeof *anchor);
}

static int measure_tiles(sheet *s, picture *p, view_frame frame)
{
    double lowest = INFINITY;
    int status = 0;
    for (uint32_t tile = 0; tile < s->tile_count && !status; tile += 1 + s->tile_count / 40) {
        double anchor[3];
        bounds box;
        status = sheet_tiles_pose(&s->tiles, &p->figure, tile);
        if (status) break;
        find_anchor(s, p, anchor);
        box = picture_bounds(p, frame);
        lowest = fmin(lowest, box.low[1]);
        box = move_box(box, anchor, -1.0);
        s->box = tile ? bounds_union(s->box, box) : box;
    }
    if (frame == FRAME_FULL || frame == FRAME_AUTO) figure_fit_floor(&p->figure, lowest);
    return status;
}

static int tile_camera(const sheet *s, const picture *p, noh_gl_camera *camera)
{
    const view_options o = { s->camera, s->tile, s->tile, s->body.has_ground, s->light.facing };
    double anchor[3];
    bounds box;
    find_anchor(s, p, anchor);
    box = move_box(s->box, anchor, 1.0);
    return view_camera(&o, &box, camera);
}

/* On the figure at rest, as the camera of all tiles would see it. */
static int strike(const sheet *s, picture *p)
{
    noh_gl_camera camera;
    int status = s->figure.mark_count ? figure_reset(&p->figure) : 0;
    if (status || !s->figure.mark_count) return status;
    status = figure_pose(&p->figure);
    if (!status) status = tile_camera(s, p, &camera);
    return status ? status : figure_strike(&p->figure, &camera, s->tile, s->tile);
}

static int draw_tiles(sheet *s, picture *p)
{
    uint8_t *rgba = malloc((size_t)s->tile * s->tile * 4);
    int status = rgba ? 0 : tool_fail(s->pack, "out of memory");
    for (uint32_t tile = 0; tile < s->tile_count && !status; tile++) {
        noh_gl_camera camera;
        status = sheet_tiles_pose(&s->tiles, &p->figure, tile);
        if (!status) status = tile_camera(s, p, &camera);
        if (!status) status = picture_read(p, &camera, rgba);
        if (!status) place_tile(s, tile, rgba);
    }
    free(rgba);
    return status;
}

static int draw_sheet(sheet *s, const pack_file *file)
{
    const view_options o = { s->camera, s->tile, s->tile, s->body.has_ground, s->light.facing };
    gpu g;
    picture p;
    int status = gpu_open_drawing(&g, s->driver);
    if (status) {
        return status;
    }
    sheet_tiles_want(&s->tiles, &s->figure);
    s->figure.file = file;
    status = picture_open(&p, &g, &s->figure, s->show_bones, s->tile, s->tile);
    if (!status) {
        status = sheet_tiles_measure(&s->tiles, &p.figure);
        if (!status) status = measure_tiles(s, &p, figure_framed(&p.figure, view_frame_of(&o), &s->tiles.clips));
        if (!status) status = strike(s, &p);
        if (!status) status = draw_tiles(s, &p);
        picture_close(&p);
    }
    gpu_close(&g);
    return status;
}

/* Empty tiles have the canvas's background colour. */
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
    figure_anims anims = { .count = 0 };
    int status = sheet_tiles_open(&s->tiles, file);
    if (!status) {
        s->show_bones = picture_shows_bones(file, s->show_bones);
        status = s->show_bones < 0 ? EXIT_FAILED : lay_out(s);
    }
    if (!status && s->tiles.clip) {
        status = figure_open_anims(&anims, &s->tiles.anims, file, &s->figure);
    }
    s->figure.stands = !s->show_bones && figure_rests(&s->figure, &s->tiles.clips);
    if (!status) status = draw_sheet(s, file);
    if (!status) status = tool_write_png(s->output, s->columns * s->tile, s->rows * s->tile, s->rgba);
    figure_close_anims(&anims);
    free(s->rgba);
    sheet_tiles_close(&s->tiles);
    return status;
}

static int check_clips(const sheet_tiles *t, const char *transition)
{
    if (strcmp(transition, "fade") != 0 && strcmp(transition, "inertia") != 0) {
        return tool_usage("--transition must be fade or inertia, not '%s'", transition);
    }
    if (t->clips.count > (int)NOH_LAYER_TRACKS_MAX) {
        return tool_usage("--clip may be given at most %u times", NOH_LAYER_TRACKS_MAX);
    }
    return t->over_s > 0.0 && t->over_s <= 60.0 ? 0
                                                : tool_usage("--over must be a number of seconds above 0, at most 60");
}

static int check_body(sheet *s)
{
    int wanted;
    const int status = figure_body_parse(&s->body_wants, &s->body, &wanted);
    s->figure.body = wanted ? &s->body : NULL;
    if (!status && s->body.has_ground && (s->tiles.push || s->tiles.to || s->tiles.blend)) {
        return tool_usage("--ground has no effect with --push, --to or --blend");
    }
    return status;
}

/* Whether there is nothing to show but a live face. */
static int lives_alone(const sheet_args *a)
{
    const sheet_tiles *t = &a->s.tiles;
    return a->s.figure.alive && !t->clips.count && !t->only.count && !a->faces && !t->wrinkled && !a->s.lods &&
           !a->s.data && !a->s.show_bones;
}

static int check_args(sheet_args *a)
{
    int springs = 1;
    sheet *s = &a->s;
    int status = parse_path(a->path, &s->figure.path);
    if (!status) status = parse_accumulate(a->accumulate, &s->figure.accumulate);
    if (!status && !(a->tile >= 16.0 && a->tile <= 1024.0 && a->tiles >= 1.0 && a->tiles <= 1024.0 &&
                     a->columns >= 0.0 && a->columns <= 64.0)) {
        status = tool_usage("--tile must be 16 to 1024 pixels, --tiles 1 to 1024, --columns at most 64");
    }
    if (!status && !(a->faces >= 0.0 && a->faces <= 1024.0 && a->seed >= 0.0 && a->seed < 4294966000.0 &&
                     a->faces == (double)(uint32_t)a->faces && a->seed == (double)(uint32_t)a->seed)) {
        status = tool_usage("--faces must be a whole number from 1 to 1024, --seed one from 0 to 4294965999");
    }
    if (!status && !(s->tiles.half_s >= 0.0 && s->tiles.half_s <= 60.0)) {
        status = tool_usage("--ping-pong must be a number of seconds above 0, at most 60");
    }
    if (!status) status = check_clips(&s->tiles, a->transition);
    if (!status && s->tiles.push) status = figure_read_push(s->tiles.push, s->tiles.impulse);
    if (!status && !(a->time_s > 0.0 && a->time_s <= 600.0)) {
        status = tool_usage("--time must be a number of seconds above 0, at most 600");
    }
    if (!status) status = tool_switch("--face", a->face, &s->figure.alive);
    if (!status) status = tool_switch("--springs", a->springs, &springs);
    s->figure.without_springs = !springs;
    if (!status) status = check_body(s);
    s->tiles.lives = s->figure.alive || s->body.has_ground;
    if (!status) status = tool_switch("--hair", a->hair, &s->figure.hair);
    if (!status) status = figure_read_marks(&a->decals, a->decal_kind, a->marks, &s->figure);
    /* Targets are shown from the front. */
    if (!s->tiles.clips.count && strcmp(s->camera, "auto") == 0) s->camera = "face";
    s->tiles.alive = s->figure.alive;
    s->tiles.life_s = lives_alone(a) ? a->time_s : 0.0;
    s->tiles.face_count = (uint32_t)a->faces;
    s->tiles.seed = (uint32_t)a->seed;
    s->tiles.inertia = strcmp(a->transition, "inertia") == 0;
    s->tile = (uint32_t)a->tile;
    s->tiles.clip_tiles = (uint32_t)a->tiles;
    s->columns = (uint32_t)a->columns;
    return status;
}

static int make_lods(sheet *s, const pack_file *file)
{
    s->figure.file = file;
    s->figure.held_float_count = FIGURE_HELD_ALL;
    s->figure.stands = 1;
    const sheet_lods o = { file, s->output, s->camera, s->driver, s->figure, &s->tiles.only, s->tile };
    return sheet_lods_write(&o);
}

static int make_data(sheet *s, const pack_file *file)
{
    const sheet_data o = { &s->tiles, s->output, s->tile, s->columns };
    int status = sheet_tiles_open(&s->tiles, file);
    if (!status) status = sheet_data_write(&o);
    sheet_tiles_close(&s->tiles);
    return status;
}

static int make(sheet *s, const pack_file *file)
{
    if (s->data) return make_data(s, file);
    return s->lods ? make_lods(s, file) : make_sheet(s, file);
}

static int run(void *args)
{
    sheet_args *a = args;
    pack_file file;
    int status = check_args(a);
    if (!status) status = pack_file_open_draft(&file, a->s.pack);
    if (!status) {
        const view_options o = { .camera = a->s.camera };
        if (view_frames(&o)) a->s.light.facing = pack_facing(&file.pack);
        if (lighting_wanted(&a->s.light, &file.pack, !a->s.show_bones)) {
            status = lighting_open(&a->s.lit, &a->s.light);
            if (!status) a->s.figure.light = &a->s.lit;
        }
        if (!status) status = make(&a->s, &file);
        pack_file_close(&file);
    }
    if (a->s.figure.light) lighting_close(&a->s.lit);
    figure_body_free(&a->s.body);
    return status;
}

static sheet_args arguments;

static const option options[] = {
    { .name = "-o",
      .kind = OPTION_OUTPUT,
      .at = offsetof(sheet_args, s.output),
      .required = 1,
      .value = "OUT.png",
      .what = "the picture",
      .example = "sheet.png" },
    { .name = "--target",
      .kind = OPTION_LIST,
      .at = offsetof(sheet_args, s.tiles.only),
      .value = "NAME[=V]",
      .what =
          "show this target alone, at weight V (default 1); may repeat; with --lods it adds a row, with --wrinkles a column, of one or several targets, NAME[=V],NAME[=V]...",
      .example = "smile=0.5",
      .excludes = "--clip --bones" },
    { .name = "--ping-pong",
      .kind = OPTION_NUMBER,
      .at = offsetof(sheet_args, s.tiles.half_s),
      .value = "S",
      .what = "show the only --target over time: up to its weight in S seconds and back in S, above 0, at most 60",
      .example = "0.5",
      .needs = "--target",
      .excludes = "--clip --lods --wrinkles --faces --data" },
    { .name = "--clip",
      .kind = OPTION_LIST,
      .at = offsetof(sheet_args, s.tiles.clips),
      .value = "NAME",
      .what = "show this clip over time; may repeat: the others play along with the first",
      .example = "walk",
      .excludes = "--lods" },
    OPTION_ANIMS(sheet_args, s.tiles.anims, .needs = "--clip"),
    OPTION_FACE(sheet_args, face, "off"),
    OPTION_SPRINGS(sheet_args, springs),
    OPTION_WEIGHT_RULES(sheet_args, s.figure.weight_rules),
    OPTION_HAIR(sheet_args, hair, "on"),
    OPTION_FEEL(sheet_args, s.tiles.emotions, .needs = "--face"),
    { .name = "--tiles",
      .kind = OPTION_NUMBER,
      .at = offsetof(sheet_args, tiles),
      .value = "N",
      .initial = "24",
      .what = "number of moments of the clip, the ping-pong or the live face to show, 1 to 1024",
      .example = "12",
      .needs = "--clip --ping-pong --face" },
    { .name = "--time",
      .kind = OPTION_NUMBER,
      .at = offsetof(sheet_args, time_s),
      .value = "S",
      .initial = "10",
      .what = "how long a face lives that is shown without a clip, seconds, above 0, at most 600",
      .example = "3",
      .needs = "--face",
      .excludes = "--clip --target --lods --wrinkles --faces --data" },
    { .name = "--blend",
      .kind = OPTION_TEXT,
      .at = offsetof(sheet_args, s.tiles.blend),
      .value = "CLIP",
      .what = "blend the clip with this one, synchronised: five rows of weights from 0 to 1",
      .example = "run",
      .needs = "--clip",
      .excludes = "--to" },
    { .name = "--to",
      .kind = OPTION_TEXT,
      .at = offsetof(sheet_args, s.tiles.to),
      .value = "CLIP",
      .what = "show a transition from the clip to this one",
      .example = "bow",
      .needs = "--clip" },
    { .name = "--transition",
      .kind = OPTION_TEXT,
      .at = offsetof(sheet_args, transition),
      .value = "fade|inertia",
      .initial = "fade",
      .what = "kind of transition: a cross-fade, or inertialization",
      .needs = "--to" },
    { .name = "--over",
      .kind = OPTION_NUMBER,
      .at = offsetof(sheet_args, s.tiles.over_s),
      .value = "S",
      .initial = "0.3",
      .what = "duration of the transition, seconds, above 0, at most 60",
      .example = "0.5",
      .needs = "--to" },
    { .name = "--push",
      .kind = OPTION_TEXT,
      .at = offsetof(sheet_args, s.tiles.push),
      .value = "X,Y,Z",
      .what =
          "push the character by this impulse, newton seconds, half a second into the clip: it sways, steps to keep its feet, or falls, and gets up by clips whose names begin with get_up",
      .example = "0,0,-150",
      .needs = "--clip",
      .excludes = "--blend --to" },
    { .name = "--lods",
      .kind = OPTION_FLAG,
      .at = offsetof(sheet_args, s.lods),
      .what =
          "a column per LOD level: at rest, with each --target (default: all smiles), and at the size at which the level is used",
      .excludes = "--bones" },
    { .name = "--faces",
      .kind = OPTION_NUMBER,
      .at = offsetof(sheet_args, faces),
      .value = "N",
      .what =
          "show N people, 1 to 1024, each from a seed: colours of skin, hair and eyes, and the mesh's identity targets (noh build --identity)",
      .example = "64",
      .excludes = "--clip --target --lods --bones" },
    { .name = "--seed",
      .kind = OPTION_NUMBER,
      .at = offsetof(sheet_args, seed),
      .value = "N",
      .initial = "1",
      .what = "seed of the first person; the others count up from it",
      .example = "100",
      .needs = "--faces" },
    { .name = "--expressions",
      .kind = OPTION_FLAG,
      .at = offsetof(sheet_args, s.tiles.expressions),
      .what = "show each person at rest, with eyes shut, and with four expressions",
      .needs = "--faces",
      .excludes = "--columns" },
    { .name = "--wrinkles",
      .kind = OPTION_FLAG,
      .at = offsetof(sheet_args, s.tiles.wrinkled),
      .what =
          "rows without wrinkles and with each wrinkle model: by area, region, channel, and as built; a column for each --target, NAME[=V],NAME[=V]..., or for five emotions",
      .excludes = "--clip --lods --faces --bones --columns" },
    { .name = "--data",
      .kind = OPTION_FLAG,
      .at = offsetof(sheet_args, s.data),
      .what =
          "the data textures of each mesh, one pixel per vertex: the base, each target's deltas (default: all; or each --target), and their sum, for positions, normals and tangents",
      .excludes = "--clip --lods --faces --wrinkles --bones" },
    { .name = "--bones",
      .kind = OPTION_FLAG,
      .at = offsetof(sheet_args, s.show_bones),
      .what = "draw the skeletons instead of the meshes" },
    { .name = "--tile",
      .kind = OPTION_NUMBER,
      .at = offsetof(sheet_args, tile),
      .value = "N",
      .initial = "192",
      .what = "side of a tile, pixels, 16 to 1024",
      .example = "256" },
    { .name = "--columns",
      .kind = OPTION_NUMBER,
      .at = offsetof(sheet_args, columns),
      .value = "N",
      .what = "tiles per row, 1 to 64; default: nearly square",
      .example = "8",
      .excludes = "--lods --blend" },
    OPTIONS_DECALS(sheet_args, decals, decal_kind, "--lods --data --bones"),
    OPTIONS_BODY(sheet_args, s.body_wants),
    OPTION_CAMERA(sheet_args, s.camera, "auto"),
    OPTIONS_LIGHT(sheet_args, s.light, "auto", .excludes = "--bones"),
    OPTION_PATH(sheet_args, path, .initial = "auto", .excludes = "--bones"),
    OPTION_ACCUMULATE(sheet_args, accumulate, .initial = "auto", .excludes = "--bones"),
    OPTION_DRIVER(sheet_args, s.driver, .initial = "egl"),
};

const verb verb_sheet = {
    .name = "sheet",
    .files = "PACK|MODEL",
    .what =
        "draw a contact sheet: every target at full weight, a clip or a live face over time, people by seed, wrinkle models, LOD levels, or data textures",
    .example =
        "face.noh -o targets.png\nbody.noh -o walk.png --clip walk --tiles 12 --camera body\nbody.noh -o bow.png --clip walk --to bow --transition inertia\npuppet.noh -o fall.png --clip walk --push 0,0,-150 --tiles 12\nface.noh -o idle.png --face on --time 3 --tiles 12\nface.noh -o people.png --faces 64 --seed 7\nface.noh -o wrinkles.png --wrinkles --light room\nface.noh -o lods.png --lods --target smile --target jawOpen=0.6,smile\nface.noh -o data.png --data --target smile --target jawOpen=0.6",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(sheet_args, s.pack),
    .args = &arguments,
    .run = run,
};
